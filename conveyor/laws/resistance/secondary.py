"""Itemised resistances at the loading point, the skirts and the cleaners.

Source: ISO 5048.
"""

from __future__ import annotations

import math

from conveyor.arguments.limits import require, require_not_negative, require_positive, require_slope
from conveyor.errors import NoSolutionError


def _require_speeds(belt_speed: float, initial_speed: float) -> None:
    require_positive(belt_speed=belt_speed)
    ok = 0.0 <= initial_speed <= belt_speed
    require(ok, "initial_speed", initial_speed, f">= 0 and <= belt_speed = {belt_speed!r} m/s")


def acceleration_resistance(mass_flow: float, *, belt_speed: float, initial_speed: float) -> float:
    """Resistance of the bulk at the loading point, F_bA = I_m (v - v0) (ISO 5048).

    Parameters
    ----------
    mass_flow : float
        I_m = Q_v ρ [kg/s], at least 0.
    belt_speed : float
        v [m/s], positive.
    initial_speed : float
        v0, speed of the bulk along the belt when it lands [m/s], from 0 to v.

    Returns
    -------
    float
        F_bA [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(acceleration_resistance(2300 / 3.6, belt_speed=4.8, initial_speed=0.0), 2)
    3066.67
    """
    require_not_negative(mass_flow=mass_flow)
    _require_speeds(belt_speed, initial_speed)
    return mass_flow * (belt_speed - initial_speed)


def acceleration_length(
    *, belt_speed: float, initial_speed: float, belt_friction: float, gravity: float, inclination: float = 0.0
) -> float:
    """Length over which the bulk reaches the belt speed, l_b = (v² - v0²)/(2 g (μ1 cos δ - sin δ)).

    ISO 5048 has it for a level belt (δ = 0); the slope is derived (Newton).

    Parameters
    ----------
    belt_speed : float
        v [m/s], positive.
    initial_speed : float
        v0 [m/s], from 0 to v.
    belt_friction : float
        μ1, bulk on belt [-], positive.
    gravity : float
        g [m/s²], positive.
    inclination : float
        δ of the belt there, positive uphill [rad], between -pi/2 and pi/2.

    Returns
    -------
    float
        l_b [m].

    Raises
    ------
    InputError
        An argument is outside its range.
    NoSolutionError
        The belt is so steep that the bulk never reaches its speed.

    Examples
    --------
    >>> round(acceleration_length(belt_speed=4.8, initial_speed=0.0, belt_friction=0.5, gravity=9.81), 3)
    2.349
    """
    _require_speeds(belt_speed, initial_speed)
    require_positive(belt_friction=belt_friction, gravity=gravity)
    require_slope(inclination=inclination)
    pull = belt_friction * math.cos(inclination) - math.sin(inclination)
    if pull <= 0.0:
        raise NoSolutionError("the belt is too steep for its friction: bulk that lands on it slides back")
    return (belt_speed**2 - initial_speed**2) / (2.0 * gravity * pull)


def skirt_resistance(
    *,
    volume_flow: float,
    bulk_density: float,
    length: float,
    bulk_speed: float,
    skirt_distance: float,
    skirt_friction: float,
    gravity: float,
) -> float:
    """Friction of the bulk on skirts, F_gL = μ2 Q_v² ρ g l/(v² b1²) (ISO 5048).

    Parameters
    ----------
    volume_flow : float
        Q_v [m³/s], at least 0.
    bulk_density : float
        ρ [kg/m³], positive.
    length : float
        l, skirted length [m], at least 0.
    bulk_speed : float
        v [m/s], positive: the belt speed behind the acceleration zone.
    skirt_distance : float
        b1, clear width between the skirts [m], positive.
    skirt_friction : float
        μ2, bulk on skirt [-], at least 0.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F_gL [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(
    ...     skirt_resistance(
    ...         volume_flow=2300 / 3.6 / 850,
    ...         bulk_density=850.0,
    ...         length=4.8,
    ...         bulk_speed=4.8,
    ...         skirt_distance=0.75,
    ...         skirt_friction=0.7,
    ...         gravity=9.81,
    ...     ),
    ...     2,
    ... )
    1221.34
    """
    require_not_negative(volume_flow=volume_flow, length=length, skirt_friction=skirt_friction)
    require_positive(bulk_density=bulk_density, bulk_speed=bulk_speed)
    require_positive(skirt_distance=skirt_distance, gravity=gravity)
    depth_rate = volume_flow / (bulk_speed * skirt_distance)
    return skirt_friction * depth_rate**2 * bulk_density * gravity * length


def acceleration_skirt_resistance(
    *,
    volume_flow: float,
    bulk_density: float,
    length: float,
    belt_speed: float,
    initial_speed: float,
    skirt_distance: float,
    skirt_friction: float,
    gravity: float,
    passing: float = 0.0,
) -> float:
    """Friction on skirts in the acceleration zone, F_f = μ2 Q_v² ρ g l_b/([(v + v0)/2]² b1²) (ISO 5048).

    Where bulk of an earlier feeding point passes at belt speed, the skirts bear the depth of both together,
    [2 Q_v/(v + v0) + Q_p/v]/b1 (derived).

    Parameters
    ----------
    volume_flow : float
        Q_v, of the bulk that lands [m³/s], at least 0.
    bulk_density : float
        ρ [kg/m³], positive.
    length : float
        l_b, see `acceleration_length`, or the skirted part of it [m], at least 0.
    belt_speed : float
        v [m/s], positive.
    initial_speed : float
        v0 [m/s], from 0 to v.
    skirt_distance : float
        b1 [m], positive.
    skirt_friction : float
        μ2 [-], at least 0.
    gravity : float
        g [m/s²], positive.
    passing : float
        Q_p, of the bulk that lies there already [m³/s], at least 0.

    Returns
    -------
    float
        F_f [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(
    ...     acceleration_skirt_resistance(
    ...         volume_flow=2300 / 3.6 / 850,
    ...         bulk_density=850.0,
    ...         length=4.8**2 / 9.81,
    ...         belt_speed=4.8,
    ...         initial_speed=0.0,
    ...         skirt_distance=0.75,
    ...         skirt_friction=0.7,
    ...         gravity=9.81,
    ...     ),
    ...     2,
    ... )
    2390.38
    """
    _require_speeds(belt_speed, initial_speed)
    require_not_negative(passing=passing)
    mean = (belt_speed + initial_speed) / 2.0
    return skirt_resistance(
        volume_flow=volume_flow + passing * mean / belt_speed,
        bulk_density=bulk_density,
        length=length,
        bulk_speed=mean,
        skirt_distance=skirt_distance,
        skirt_friction=skirt_friction,
        gravity=gravity,
    )


def cleaner_resistance(contact_area: float, *, pressure: float, friction: float) -> float:
    """Resistance of a belt cleaner, F_r = A p μ3 (ISO 5048).

    Parameters
    ----------
    contact_area : float
        A of blade on belt, of one cleaner or all [m²], at least 0.
    pressure : float
        p [N/m²], at least 0; default of the craft `CLEANER_PRESSURE`.
    friction : float
        μ3 [-], at least 0; default of the craft `CLEANER_FRICTION`.

    Returns
    -------
    float
        F_r [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(cleaner_resistance(4 * 1.2 * 0.008, pressure=3e4, friction=0.6), 1)
    691.2
    """
    require_not_negative(contact_area=contact_area, pressure=pressure, friction=friction)
    return contact_area * pressure * friction
