"""Flexure of the belt and of the bulk between the idler sets: over load and sag; two derived laws.

Literature: Spaans, The calculation of the main resistance of belt conveyors, Bulk Solids Handling 11 (1991) 809-826
(flexure as hysteresis of the sagging belt and as Rankine's active and passive states of the bulk). The equations
here are derived in the notes of each function; none is copied.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_angle, require_not_negative, require_positive
from conveyor.laws.resistance.resistance_defaults import FLEXURE_SHARE, Default

Array = NDArray[np.float64]

_SMALL_RISE: Final = 1e-6  # ln(1 + x)/x = 1 - x/2 + x²/3: the series is right to 1e-12 below it

_SITE_SOURCE: Final = (
    "The CEMA Horsepower Equation, Bulk Solids Handling 34 (2014) 7: 4860 t/h, 7.5 m/s, sets 2 m apart"
)
SITE_LOSS: Final = 61.7  # [N a set], all losses measured there but those of the idlers' seals
SITE_LOAD: Final = 4302.0  # [N a set], belt and bulk there
SITE_SAG: Final = Default(
    0.004, 0.002, 0.01,
    "tension there is not published: an ST 1600 belt of its width runs between 55 kN (1 % sag) and 380 kN "
    "(safety 6.7), 0.4 % in the middle",
    True,
)  # [-]  # fmt: skip


def _site_coefficient(sag: float) -> float:
    """Coefficient c that gives the site its share of flexure, at a sag over the spacing [-]."""
    return FLEXURE_SHARE.value * SITE_LOSS / (SITE_LOAD * sag)


FLEXURE_COEFFICIENT: Final = Default(
    _site_coefficient(SITE_SAG.value), _site_coefficient(SITE_SAG.high), _site_coefficient(SITE_SAG.low),
    f"{100.0 * FLEXURE_SHARE.value:.0f} % of {SITE_LOSS:g} N a set under {SITE_LOAD:g} N ({_SITE_SOURCE}) "
    f"at {100.0 * SITE_SAG.value:.1f} % sag",
    True,
)  # [-]  # fmt: skip

HARMONICS: Final = np.arange(1.0, 128.0)  # summed one by one; the rest is then right to 1e-10 of the sum


def _series_remainder(ratio: float, first: int) -> float:
    """Remainder of Σ n/(1 + (r n)²)² from n = first: Euler-Maclaurin to the first derivative."""
    square = (ratio * first) ** 2
    integral = 1.0 / (2.0 * ratio**2 * (1.0 + square))
    value = first / (1.0 + square) ** 2
    slope = (1.0 - 3.0 * square) / (1.0 + square) ** 3
    return integral + value / 2.0 - slope / 12.0


def sag_flexure_resistance(line_load: float, *, spacing: float, relative_sag: float, coefficient: float) -> float:
    """Flexure of belt and bulk over one span, F = c (q a) (h/a) (form derived, c measured).

    Parameters
    ----------
    line_load : float
        q of belt and bulk normal to the belt [N/m], at least 0.
    spacing : float
        a of the idler sets [m], positive.
    relative_sag : float
        h/a, sag over spacing, q a/(8 T) at a tension T [-], from 0 to 0.1.
    coefficient : float
        c [-], at least 0; default of the craft `FLEXURE_COEFFICIENT`, from one measured site.

    Returns
    -------
    float
        F of one span [N]; divide by a for the line resistance [N/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The form is that of `belt_flexure_resistance` without stiffness, c = (4/π) tan δ; the measured c holds what the
    bulk loses too (trampling). Rubber under the rolls is not in it. One site, its sag not published: c is known to a
    factor of 2 to 2.5 either way.

    Examples
    --------
    >>> round(sag_flexure_resistance(2151.0, spacing=2.0, relative_sag=0.01, coefficient=0.158), 2)
    6.8
    """
    require_not_negative(line_load=line_load, coefficient=coefficient)
    require_positive(spacing=spacing)
    require(0.0 <= relative_sag <= 0.1, "relative_sag", relative_sag, ">= 0 and <= 0.1")
    return coefficient * line_load * spacing * relative_sag


def mean_sag_ratio(start: Array, end: Array, *, limit: Array) -> Array:
    """Mean sag along stretches over that at a tension limit, (1/L) ∫ T_0/max(T, T_0) ds (h/a = q a/(8 T), DIN 22101).

    Parameters
    ----------
    start, end : ndarray, shape (...)
        T at both ends, or T - m' v² at high speed [N]; linear between them, of any sign.
    limit : ndarray, shape (...)
        T_0 of the largest sag [N], at least 0; at 0, of a belt that is carried everywhere, the limit is taken.

    Returns
    -------
    ndarray, shape (...)
        Ratio [-]; 1 where the tension is nowhere above T_0: more sag than the limit is not counted. At T_0 = 0 the
        share of the stretch that is not taut.

    Raises
    ------
    InputError
        A limit is negative.

    Examples
    --------
    >>> mean_sag_ratio(np.array([20e3, 10e3, 0.0]), np.array([20e3, 20e3, 8e3]), limit=np.full(3, 10e3)).round(6)
    array([0.5     , 0.693147, 1.      ])
    """
    require(bool(np.all(limit >= 0.0)), "limit", float(np.min(limit)), ">= 0")
    low, high = np.minimum(start, end), np.maximum(start, end)
    taut = np.maximum(low, limit)
    span = np.where(high > low, high - low, 1.0)
    above = np.where(high > low, np.clip((high - taut) / span, 0.0, 1.0), high > limit)
    scale = np.where(taut > 0.0, taut, 1.0)  # T_0 ln(T/T_0) vanishes with T_0
    rise = np.maximum(high - taut, 0.0) / scale
    flat = rise < _SMALL_RISE
    mean = np.where(flat, 1.0 - 0.5 * rise, np.log1p(rise) / np.where(flat, 1.0, rise))
    return np.asarray(1.0 - above * (1.0 - limit / scale * mean))


def belt_flexure_resistance(
    line_load: float, *, tension: float, spacing: float, bending_stiffness: float, loss_tangent: float
) -> float:
    """Flexure of the belt over one span, F = 4 π tan δ D (q/T)² Σ n/(1 + (n 2π l/a)²)², l² = D/T (derived).

    Parameters
    ----------
    line_load : float
        q of belt and bulk normal to the belt [N/m], at least 0.
    tension : float
        T, or T - m' v² at high speed [N], positive.
    spacing : float
        a of the idler sets [m], positive.
    bending_stiffness : float
        D of the whole belt as it lies, lengthwise [N m²], at least 0. At 0 the limit tan δ q² a²/(2 π T).
    loss_tangent : float
        tan δ of the belt in bending at the frequency v/a and its first multiples [-], from 0 to 1.

    Returns
    -------
    float
        F of one span [N]; divide by a for the line resistance [N/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A tensioned beam on point supports a distance a apart: D w'''' - T w'' = q (a Σδ - 1). Its curvature has the
    harmonics κ_n = 2q/(T + D (2πn/a)²). A moment that lags by tan δ loses π tan δ D n κ_n² per span and length
    of belt, and a span loses just that force. When l = sqrt(D/T) is far below a, D drops out and
    F/(q a) = (4/π) tan δ (h/a) with the relative sag h/a = q a/(8 T): the loss needs no stiffness to be known.
    Small sag; tan δ constant over the harmonics; no flattening of the trough. Not to be added to an indentation
    solved with a tensioned belt as support, which holds the same loss.

    Examples
    --------
    >>> span = {"tension": 50e3, "spacing": 1.2, "loss_tangent": 0.1}
    >>> round(belt_flexure_resistance(1500.0, bending_stiffness=0.0, **span), 3)
    1.031
    >>> round(belt_flexure_resistance(1500.0, bending_stiffness=30.0, **span), 3)
    1.028
    """
    require_not_negative(line_load=line_load, bending_stiffness=bending_stiffness)
    require_positive(tension=tension, spacing=spacing)
    require(0.0 <= loss_tangent <= 1.0, "loss_tangent", loss_tangent, ">= 0 and <= 1")
    if bending_stiffness == 0.0:
        return loss_tangent * (line_load * spacing) ** 2 / (2.0 * math.pi * tension)
    ratio = 2.0 * math.pi * math.sqrt(bending_stiffness / tension) / spacing
    head = float(np.sum(HARMONICS / (1.0 + (ratio * HARMONICS) ** 2) ** 2))
    amplitude = 4.0 * math.pi * loss_tangent * bending_stiffness * (line_load / tension) ** 2
    return amplitude * (head + _series_remainder(ratio, HARMONICS.size + 1))


def rankine_coefficients(friction_angle: float) -> tuple[float, float]:
    """Pressure coefficients of a cohesionless bulk, (1 ∓ sin φ)/(1 ± sin φ) (Rankine 1857).

    Parameters
    ----------
    friction_angle : float
        φ, inner friction of the bulk [rad], from 0 to below pi/2.

    Returns
    -------
    active : float
        K_a, the bulk yields outward [-].
    passive : float
        K_p = 1/K_a, the bulk is pushed together [-].

    Raises
    ------
    InputError
        The angle is outside its range.

    Examples
    --------
    >>> [round(k, 6) for k in rankine_coefficients(math.radians(30))]
    [0.333333, 3.0]
    """
    require_angle(0.0, friction_angle=friction_angle)
    sine = math.sin(friction_angle)
    return (1.0 - sine) / (1.0 + sine), (1.0 + sine) / (1.0 - sine)


def bulk_flexure_bound(
    opening_angle: float,
    *,
    bulk_density: float,
    friction_angle: float,
    wing_contact: float,
    trough_angle: float,
    gravity: float,
) -> float:
    """Flexure of the bulk by both wings over one span, at most 2 (K_p - K_a) ρ g sin λ b³ Δφ/6 (derived).

    Parameters
    ----------
    opening_angle : float
        Δφ by which each wing of the belt opens between the sets [rad], at least 0, measured or computed.
    bulk_density : float
        ρ [kg/m³], positive.
    friction_angle : float
        φ, inner friction of the bulk [rad], from 0 to below pi/2.
    wing_contact : float
        b, width of each wing covered by the bulk [m], at least 0.
    trough_angle : float
        λ of the wings [rad], from 0 to below pi/2.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        Force of one span [N], an upper bound; divide by the spacing for the line resistance [N/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The pressure on a wing grows with the depth below the upper edge of the bulk, (b - s) sin λ; its moment about
    the junction is K ρ g sin λ b³/6 per length. The wing opens against K_a and closes against K_p, so one span
    loses the difference times the angle. Heap above the edge, and lengthwise bending of the bulk, left out; both
    states reached at once, though the passive one needs strains of some per cent: hence a bound, to be compared
    with the measured share `FLEXURE_SHARE`, not a prediction.

    Examples
    --------
    >>> force = bulk_flexure_bound(
    ...     math.radians(1.0),
    ...     bulk_density=850.0,
    ...     friction_angle=math.radians(37),
    ...     wing_contact=0.3,
    ...     trough_angle=math.radians(35),
    ...     gravity=9.81,
    ... )
    >>> round(force, 2)
    2.84
    """
    require_not_negative(opening_angle=opening_angle, wing_contact=wing_contact)
    require_positive(bulk_density=bulk_density, gravity=gravity)
    require_angle(0.0, opening_angle=opening_angle, trough_angle=trough_angle)
    active, passive = rankine_coefficients(friction_angle)
    moment = bulk_density * gravity * math.sin(trough_angle) * wing_contact**3 / 6.0
    return 2.0 * (passive - active) * moment * opening_angle
