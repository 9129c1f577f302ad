"""Vertical curves: lift-off on concave ones, stress of edges and middle on both.

Sources: statics of a belt on a curve, and plane sections of the troughed belt; see also DIN 22101, and Pitcher,
Calculation of correct radii for vertical curves in troughed belt conveyors, Beltcon 17.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import (
    require,
    require_angle,
    require_not_negative,
    require_positive,
    require_slope,
)
from conveyor.laws.loading import NO_WING, Wing, wing_pieces
from conveyor.laws.resistance.cema import INCH, POUND_FORCE


@dataclass(frozen=True, slots=True)
class TroughSection:
    """Heights of the troughed belt against its own centre.

    Parameters
    ----------
    edge_above : float
        Height of the edges above the centre [m].
    middle_below : float
        Depth of the middle below the centre [m].
    """

    edge_above: float
    middle_below: float


def trough_section(
    belt_width: float, *, middle_roll_length: float, trough_angle: float, inner_wing: Wing = NO_WING
) -> TroughSection:
    """Heights of the troughed belt, edges w sin λ - z, middle z = w² sin λ/B, with w = (B - l_M)/2.

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    middle_roll_length : float
        l_M, belt on the middle roll [m], from 0 (two or four rolls) to B (flat).
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`.

    Returns
    -------
    TroughSection
        Heights against the belt's centre [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Straight pieces of a thin belt of even stiffness across; its centre is the mean of its heights.

    Examples
    --------
    >>> s = trough_section(1.2, middle_roll_length=0.4, trough_angle=math.radians(30))
    >>> round(s.edge_above, 4), round(s.middle_below, 4)
    (0.1333, 0.0667)
    """
    edge = moment = 0.0
    for length, angle in wing_pieces(
        belt_width, middle_roll_length=middle_roll_length, trough_angle=trough_angle, inner_wing=inner_wing
    ):
        rise = length * math.sin(angle)
        moment += (2.0 * edge + rise) * length
        edge += rise
    centre = moment / belt_width
    return TroughSection(edge_above=edge - centre, middle_below=centre)


def lift_off_radius(
    tension: float, *, belt_mass: float, inclination: float, gravity: float, uplift: float = 0.0
) -> float:
    """Least radius of a concave curve without lift-off of the empty belt, r = T/(m'_belt g cos δ - F'_wind).

    Parameters
    ----------
    tension : float
        T in the curve [N], at least 0: the largest with no bulk on the curve, the start included.
    belt_mass : float
        m'_belt [kg/m], positive.
    inclination : float
        δ of the belt, at its steepest in the curve [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.
    uplift : float
        F'_wind, uplift per length [N/m], at least 0, see `wind.wind_force`.

    Returns
    -------
    float
        r [m]; infinite where the wind alone lifts it.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Moving belt: T - m' v² lifts it; T alone is on the safe side.

    Examples
    --------
    >>> round(lift_off_radius(60e3, belt_mass=20.0, inclination=0.0, gravity=9.81), 1)
    305.8
    """
    require_not_negative(tension=tension, uplift=uplift)
    require_positive(belt_mass=belt_mass, gravity=gravity)
    require_slope(inclination=inclination)
    held = belt_mass * gravity * math.cos(inclination) - uplift
    return tension / held if held > 0.0 else math.inf


CEMA_LIFT_OFF: Final = 1.11
"""Of CEMA's least radius of a concave curve, r = 1.11 T/w_belt [-]: it covers slopes up to 25.7 deg, whose cosine is
1/1.11 (CEMA, Belt Conveyors for Bulk Materials, vertical curves; as commonly reproduced)."""

CEMA_LEAST_TENSION: Final = 30.0 * POUND_FORCE / INCH
"""That CEMA keeps in the middle of a convex curve, 30 lbf/in, in r = b sin β E/(9 (T_c - 30)) of equal rolls [N/m]
(CEMA, Belt Conveyors for Bulk Materials, vertical curves; as commonly reproduced)."""


def cema_lift_off_radius(tension: float, *, belt_mass: float, gravity: float) -> float:
    """Least radius of a concave curve by CEMA, r = 1.11 T/(m'_belt g).

    Parameters
    ----------
    tension : float
        T in the curve [N], at least 0.
    belt_mass : float
        m'_belt [kg/m], positive.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        r [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(cema_lift_off_radius(60e3, belt_mass=20.0, gravity=9.81), 1)
    339.4
    """
    return CEMA_LIFT_OFF * lift_off_radius(tension, belt_mass=belt_mass, inclination=0.0, gravity=gravity)


def overstress_radius(
    tension_per_width: float, *, distance: float, stiffness_per_width: float, allowed_per_width: float
) -> float:
    """Least radius that keeps the stretched strip below its limit, r = E d/(k_max - k).

    Parameters
    ----------
    tension_per_width : float
        k, mean of the belt in the curve [N/m], at least 0.
    distance : float
        d of the strip from the belt's centre [m], at least 0: `edge_above` on a convex curve, `middle_below` on
        a concave one.
    stiffness_per_width : float
        E of the belt per width [N/m], positive.
    allowed_per_width : float
        k_max [N/m], more than k.

    Returns
    -------
    float
        r [m].

    Raises
    ------
    InputError
        An argument is outside its range; no radius helps a belt that is overstressed on the straight.

    Notes
    -----
    Plane sections: the strip is longer by d/r than the centre.

    Examples
    --------
    >>> overstress_radius(100e3, distance=0.125, stiffness_per_width=72 * 1e6, allowed_per_width=150e3)
    180.0
    """
    require_not_negative(tension_per_width=tension_per_width, distance=distance)
    require_positive(stiffness_per_width=stiffness_per_width)
    ok = tension_per_width < allowed_per_width < math.inf
    require(
        ok,
        "allowed_per_width",
        allowed_per_width,
        f"> {tension_per_width:.6g} N/m, the mean",
    )
    return stiffness_per_width * distance / (allowed_per_width - tension_per_width)


def cema_middle_below(belt_width: float, *, trough_angle: float) -> float:
    """Distance of the middle of a belt below its centre by CEMA, B sin(λ)/9.

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    trough_angle : float
        λ of three rolls [rad], from 0 to below pi/2.

    Returns
    -------
    float
        d [m], for CEMA's radius of a convex curve, r = B sin(λ) E/(9 (T/B - 30 lbf/in)), as commonly reproduced.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Exact where the three rolls bear a third of the belt each: wings of B/3 have their middle B sin(λ)/6 above the
    middle roll, two thirds of which is the mean. Rolls longer than a third bear shorter wings, `trough_section`.

    Examples
    --------
    >>> round(cema_middle_below(1.2, trough_angle=math.radians(35.0)), 4)
    0.0765
    """
    require_positive(belt_width=belt_width)
    require_angle(0.0, trough_angle=trough_angle)
    return belt_width * math.sin(trough_angle) / 9.0


def buckling_radius(
    tension_per_width: float, *, distance: float, stiffness_per_width: float, least_per_width: float
) -> float:
    """Least radius that keeps the slackened strip taut, r = E d/(k - k_min).

    Parameters
    ----------
    tension_per_width : float
        k, mean of the belt in the curve, the lowest that occurs [N/m], more than k_min.
    distance : float
        d of the strip from the belt's centre [m], at least 0: `middle_below` on a convex curve, `edge_above` on
        a concave one.
    stiffness_per_width : float
        E of the belt per width [N/m], positive.
    least_per_width : float
        k_min left in the strip [N/m], at least 0.

    Returns
    -------
    float
        r [m].

    Raises
    ------
    InputError
        An argument is outside its range; no radius helps a belt that is too slack on the straight.

    Examples
    --------
    >>> buckling_radius(40e3, distance=0.05, stiffness_per_width=36e6, least_per_width=4e3)
    50.0
    """
    require_not_negative(least_per_width=least_per_width, distance=distance)
    require_positive(stiffness_per_width=stiffness_per_width)
    ok = least_per_width < tension_per_width < math.inf
    require(ok, "tension_per_width", tension_per_width, f"> {least_per_width:.6g} N/m, the least")
    return stiffness_per_width * distance / (tension_per_width - least_per_width)
