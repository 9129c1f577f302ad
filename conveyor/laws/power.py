"""From the total force to power, energy and cost; the older empirical power formula.

Sources: DIN 22101, ISO 5048 (power); a worked example of the empirical route (c_B, c_L, k_f).
Sign: positive power is drawn by the motor, negative power is fed back by a belt that runs downhill.
"""

from __future__ import annotations

from typing import Final

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_positive

JOULE_PER_KWH: Final = 3.6e6  # [J/kWh]
WATT_PER_KW: Final = 1e3  # [W/kW]
TONNE_KM: Final = 1e6  # [kg m/(t km)]
TONNE_PER_HOUR: Final = 1.0 / 3.6  # [kg/s per t/h]
LIFT_DIVISOR: Final = 367.0  # [t m/(h kW)], empirical route: 3600/9.81 rounded


def belt_power(force: float, *, belt_speed: float) -> float:
    """Power at the belt, P = F_U v (ISO 5048).

    Parameters
    ----------
    force : float
        F_U [N]; negative when the belt drives the motor.
    belt_speed : float
        v [m/s], positive.

    Returns
    -------
    float
        P [W].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(belt_power(13232.32, belt_speed=4.8))
    63515
    """
    require_finite(force=force)
    require_positive(belt_speed=belt_speed)
    return force * belt_speed


def motor_power(belt_power: float, *, efficiency: float) -> float:
    """Power at the motor, P/η driving, P η when the belt feeds back (ISO 5048).

    Parameters
    ----------
    belt_power : float
        P at the belt [W], of either sign.
    efficiency : float
        η of the drive train [-], above 0, at most 1.

    Returns
    -------
    float
        Motor power [W], negative when fed back.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(motor_power(63515.14, efficiency=0.95 * 0.97)), motor_power(-100e3, efficiency=0.9)
    (68926, -90000.0)
    """
    require_finite(belt_power=belt_power)
    require(0.0 < efficiency <= 1.0, "efficiency", efficiency, "> 0 and <= 1")
    return belt_power / efficiency if belt_power >= 0.0 else belt_power * efficiency


def specific_energy(power: float, *, mass_flow: float, length: float) -> float:
    """Energy per mass and distance conveyed, P/(Q L).

    Parameters
    ----------
    power : float
        P [W], of either sign.
    mass_flow : float
        Q [kg/s], positive.
    length : float
        L [m], positive.

    Returns
    -------
    float
        Energy [kWh/(t km)].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(specific_energy(100e3, mass_flow=1000 / 3.6, length=1000.0), 9)
    0.1
    """
    require_finite(power=power)
    require_positive(mass_flow=mass_flow, length=length)
    return power / (mass_flow * length) * TONNE_KM / JOULE_PER_KWH


def empirical_level_power(
    mass_flow: float,
    *,
    belt_speed: float,
    width_coefficient: float,
    length_coefficient: float,
    friction_coefficient: float,
) -> float:
    """Power of the level conveyor by the empirical route, P1 = (c_B v + Q)/(c_L k_f) [kW].

    Parameters
    ----------
    mass_flow : float
        Q [kg/s], at least 0; the formula itself takes t/h.
    belt_speed : float
        v [m/s], positive.
    width_coefficient : float
        c_B, from a table over the belt width [t s/(h m)], at least 0.
    length_coefficient : float
        c_L, from a table over the length [t/(h kW)], positive.
    friction_coefficient : float
        k_f, from a table over the running conditions [-], positive.

    Returns
    -------
    float
        P1 [W].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(
    ...     empirical_level_power(
    ...         1000 / 3.6,
    ...         belt_speed=1.68,
    ...         width_coefficient=277.0,
    ...         length_coefficient=52.0,
    ...         friction_coefficient=1.0,
    ...     )
    ... )
    28180
    """
    require_not_negative(mass_flow=mass_flow, width_coefficient=width_coefficient)
    require_positive(belt_speed=belt_speed, length_coefficient=length_coefficient)
    require_positive(friction_coefficient=friction_coefficient)
    tonnes_per_hour = width_coefficient * belt_speed + mass_flow / TONNE_PER_HOUR
    return tonnes_per_hour / (length_coefficient * friction_coefficient) * WATT_PER_KW


def empirical_lift_power(mass_flow: float, *, lift: float) -> float:
    """Power of the lift by the empirical route, P2 = H Q/367 [kW].

    Parameters
    ----------
    mass_flow : float
        Q [kg/s], at least 0; the formula itself takes t/h.
    lift : float
        H [m], negative downhill.

    Returns
    -------
    float
        P2 [W], negative downhill.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(empirical_lift_power(1000 / 3.6, lift=17.9))
    48774
    """
    require_not_negative(mass_flow=mass_flow)
    require_finite(lift=lift)
    return lift * (mass_flow / TONNE_PER_HOUR) / LIFT_DIVISOR * WATT_PER_KW
