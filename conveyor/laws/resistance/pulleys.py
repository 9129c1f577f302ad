"""Resistances at the pulleys: bending of the belt round them, their bearings.

Source: ISO 5048.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require, require_not_negative, require_positive

FABRIC_WRAP: Final = (9.0, 140.0)  # [-], [N/m]: ISO 5048, in 9 B (140 + 0.01 F/B) d/D
STEEL_CORD_WRAP: Final = (12.0, 200.0)  # [-], [N/m]: general knowledge, a flagged default
WRAP_TENSION_FACTOR: Final = 0.01  # [-], ISO 5048
BEARING_FACTOR: Final = 0.005  # [-], ISO 5048: pulley bearings


def _wrap_resistance(
    wrap: tuple[float, float], belt_width: float, tension: float, belt_thickness: float, diameter: float
) -> float:
    require_positive(belt_width=belt_width, belt_thickness=belt_thickness, pulley_diameter=diameter)
    require_not_negative(tension=tension)
    width_factor, base = wrap
    per_width = base + WRAP_TENSION_FACTOR * tension / belt_width
    return width_factor * belt_width * per_width * belt_thickness / diameter


def fabric_wrap_resistance(
    *, belt_width: float, tension: float, belt_thickness: float, pulley_diameter: float
) -> float:
    """Bending resistance of a fabric belt round a pulley, 9 B (140 + 0.01 F/B) d/D (ISO 5048).

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    tension : float
        F, mean of the tensions of both sides [N], at least 0.
    belt_thickness : float
        d [m], positive.
    pulley_diameter : float
        D [m], positive.

    Returns
    -------
    float
        Resistance [N]. The factor 9 carries the unit that makes it one.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(fabric_wrap_resistance(belt_width=1.0, tension=2e4, belt_thickness=0.01, pulley_diameter=0.5), 1)
    61.2
    """
    return _wrap_resistance(FABRIC_WRAP, belt_width, tension, belt_thickness, pulley_diameter)


def steel_cord_wrap_resistance(
    *, belt_width: float, tension: float, belt_thickness: float, pulley_diameter: float
) -> float:
    """Bending resistance of a steel-cord belt round a pulley, 12 B (200 + 0.01 F/B) d/D (general knowledge).

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    tension : float
        F, mean of the tensions of both sides [N], at least 0.
    belt_thickness : float
        d [m], positive.
    pulley_diameter : float
        D [m], positive.

    Returns
    -------
    float
        Resistance [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The figures 12 and 200 were not read in a standard: an analysis that uses this law must say so.

    Examples
    --------
    >>> round(
    ...     steel_cord_wrap_resistance(belt_width=1.0, tension=2e4, belt_thickness=0.02, pulley_diameter=1.0),
    ...     1,
    ... )
    96.0
    """
    return _wrap_resistance(STEEL_CORD_WRAP, belt_width, tension, belt_thickness, pulley_diameter)


def pulley_load(
    *,
    tight_tension: ArrayLike,
    slack_tension: ArrayLike,
    pulley_mass: ArrayLike,
    gravity: ArrayLike,
    wrap_angle: ArrayLike = math.pi,
) -> NDArray[np.float64]:
    """Load on the bearings of a pulley, F_T = sqrt((T1 + T2)² + (g m_p)²) at half a turn (ISO 5048).

    Parameters
    ----------
    tight_tension : array_like
        T1 [N], at least 0.
    slack_tension : array_like
        T2 [N], at least 0.
    pulley_mass : array_like
        m_p [kg], at least 0.
    gravity : array_like
        g [m/s²], positive.
    wrap_angle : array_like
        Angle α over which the belt lies on it [rad], above 0, at most 2 pi.

    Returns
    -------
    ndarray
        F_T [N], of the arguments' common shape.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Vector sum of both tensions, sqrt(T1² + T2² - 2 T1 T2 cos α), with the weight square to it.

    Examples
    --------
    >>> float(pulley_load(tight_tension=200.0, slack_tension=100.0, pulley_mass=40.0, gravity=10.0))
    500.0
    """
    tight, slack, mass, wrap = map(np.asarray, (tight_tension, slack_tension, pulley_mass, wrap_angle))
    for name, values in (("tight_tension", tight), ("slack_tension", slack), ("pulley_mass", mass)):
        borne = bool(((values >= 0.0) & (values < math.inf)).all())
        require(borne, name, values.tolist(), ">= 0 and finite")
    require_positive(gravity=float(np.min(gravity)))
    turns = bool(((wrap > 0.0) & (wrap <= 2.0 * math.pi)).all())
    require(turns, "wrap_angle", wrap.tolist(), "> 0 and <= 2 pi rad")
    # sqrt(T1² + T2² - 2 T1 T2 cos α) without cancellation at small angles
    across = 2.0 * np.sqrt(tight) * np.sqrt(slack) * np.sin(0.5 * wrap)
    return np.asarray(np.hypot(np.hypot(tight - slack, across), gravity * mass))


def pulley_bearing_resistance(load: float, *, shaft_diameter: float, pulley_diameter: float) -> float:
    """Bearing resistance of a pulley, 0.005 (d0/D) F_T (ISO 5048).

    Parameters
    ----------
    load : float
        F_T [N], at least 0, see `pulley_load`.
    shaft_diameter : float
        d0 of the shaft in the bearing [m], positive.
    pulley_diameter : float
        D [m], positive.

    Returns
    -------
    float
        Resistance at the belt [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(pulley_bearing_resistance(50e3, shaft_diameter=0.1, pulley_diameter=0.5), 6)
    50.0
    """
    require_not_negative(load=load)
    require_positive(shaft_diameter=shaft_diameter, pulley_diameter=pulley_diameter)
    return BEARING_FACTOR * shaft_diameter / pulley_diameter * load
