"""Wind on an empty belt: force across the belt and upward, lifting speed.

Source: EN 1991-1-4 for the dynamic pressure; the coefficients of a belt are general knowledge.
"""

from __future__ import annotations

import math
from typing import Final

from conveyor.arguments.limits import require_not_negative, require_positive, require_slope
from conveyor.laws.resistance.resistance_defaults import Default

WIND_DRAG: Final = Default(1.3, 1.0, 2.0, "drag coefficient of the belt's trough across the wind", True)
"""[-]"""
WIND_LIFT: Final = Default(
    0.5,
    0.2,
    1.3,
    "lift coefficient of a belt: of a level roof on posts, open or dammed below (EN 1991-1-4, 7.3)",
    True,
)
"""[-]"""
AIR_DENSITY: Final = 1.25
"""EN 1991-1-4, recommended value [kg/m³]."""


def wind_force(speed: float, *, height: float, length: float, drag: float, air_density: float) -> float:
    """Force of the wind across a belt or upward, c ρ v²/2 h a.

    Parameters
    ----------
    speed : float
        v of the wind [m/s], at least 0.
    height : float
        h that the trough shows to it; for the lift the belt's width [m], at least 0.
    length : float
        a of belt [m], positive.
    drag : float
        c [-], positive, see `WIND_DRAG` and `WIND_LIFT`.
    air_density : float
        ρ [kg/m³], positive.

    Returns
    -------
    float
        Force [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Dynamic pressure as of EN 1991-1-4, without gusts: take the speed of the gust.

    Examples
    --------
    >>> wind_force(20.0, height=0.2, length=2.0, drag=1.0, air_density=1.25)
    100.0
    """
    require_not_negative(speed=speed, height=height)
    require_positive(length=length, drag=drag, air_density=air_density)
    return drag * 0.5 * air_density * speed**2 * height * length


def lifting_speed(
    belt_mass: float, *, width: float, lift: float, inclination: float, gravity: float, air_density: float
) -> float:
    """Speed of the wind that lifts the empty belt off its sets, sqrt(2 m'_belt g cos δ/(c ρ B)).

    Parameters
    ----------
    belt_mass : float
        m'_belt [kg/m], at least 0.
    width : float
        B [m], positive.
    lift : float
        c [-], positive, see `WIND_LIFT`.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.
    air_density : float
        ρ [kg/m³], positive.

    Returns
    -------
    float
        v [m/s], of the gust.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    `wind_force` against the weight: a belt without tension on a curve. The wing that the wind blows under lifts before
    the whole belt does: on the unsafe side for deep troughs.

    Examples
    --------
    >>> round(lifting_speed(20.0, width=1.0, lift=1.0, inclination=0.0, gravity=10.0, air_density=1.25), 3)
    17.889
    """
    require_not_negative(belt_mass=belt_mass)
    require_positive(width=width, lift=lift, gravity=gravity, air_density=air_density)
    require_slope(inclination=inclination)
    return math.sqrt(2.0 * belt_mass * gravity * math.cos(inclination) / (lift * air_density * width))
