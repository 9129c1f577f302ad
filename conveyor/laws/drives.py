"""Parts of a drive: gear, backstops, brake discs, flywheel, motor starts per hour, load sharing of unequal drives.

Sources: NEMA MG 10 table 2-3 (starts), as the EASA handbook prints it; ISO 3 (preferred numbers); the rest is derived.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, Literal

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_positive
from conveyor.errors import RangeError
from conveyor.laws.resistance.resistance_defaults import Default

Poles = Literal[2, 4, 6]

HORSEPOWER: Final = 745.69987158227022  # [W]
_POUND_FOOT: Final = 0.45359237 * 0.3048**2  # lb ft² [kg m²]
BACKSTOP_SHARE_FACTOR: Final = Default(
    1.4, 1.2, 2.0, "load of one of several backstops over an even share: 70 % of two", True
)  # [-]
GEAR_SERVICE: Final = Default(1.5, 1.25, 1.75, "rated torque of a conveyor's gear over that of its motor", True)  # [-]
DISC_HEAT: Final = Default(460.0, 450.0, 500.0, "specific heat of a steel brake disc", True)  # [J/(kg K)]
DRIVE_SPEED_TOLERANCE: Final = 0.05
"""By which motor, gear and pulley may miss the belt speed, over it; gear series step by 12 % (ISO 3, R20), so that the
next ratio is at most 6 % off (general knowledge) [-]."""
_R10: Final = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)  # ISO 3
_R20: Final = (*_R10, 1.12, 1.4, 1.8, 2.24, 2.8, 3.55, 4.5, 5.6, 7.1, 9.0)  # ISO 3
# NEMA MG 10, table 2-3, designs A and B: hp; starts an hour, starts an hour times load Wk² [lb ft²] at 2, 4, 6 poles
_STARTS: Final = (
    (1, (15, 1.2), (30, 5.8), (34, 15)), (1.5, (12.9, 1.8), (25.7, 8.6), (29.1, 23)),
    (2, (11.5, 2.4), (23, 11), (26.1, 30)), (3, (9.9, 3.5), (19.8, 17), (22.4, 44)),
    (5, (8.1, 5.7), (16.3, 27), (18.4, 71)), (7.5, (7.0, 8.3), (13.9, 39), (15.8, 104)),
    (10, (6.2, 11), (12.5, 51), (14.2, 137)), (15, (5.4, 16), (10.7, 75), (12.1, 200)),
    (20, (4.8, 21), (9.6, 99), (10.9, 262)), (25, (4.4, 26), (8.8, 122), (10, 324)),
    (30, (4.1, 31), (8.2, 144), (9.3, 384)), (40, (3.7, 40), (7.4, 189), (8.4, 503)),
    (50, (3.4, 49), (6.8, 232), (7.7, 620)), (60, (3.2, 58), (6.3, 275), (7.2, 735)),
    (75, (2.9, 71), (5.8, 338), (6.6, 904)), (100, (2.6, 92), (5.2, 441), (5.9, 1181)),
    (125, (2.4, 113), (4.8, 542), (5.4, 1452)), (150, (2.2, 133), (4.5, 640), (5.1, 1719)),
    (200, (2.0, 172), (4.0, 831), (4.5, 2238)), (250, (1.8, 210), (3.7, 1017), (4.2, 2744)),
)  # fmt: skip
_SHARE_TOLERANCE: Final = 1e-6  # of a power: 25 hp written in kW


def allowed_starts(rated_power: float, *, poles: Poles, load_inertia: float) -> float:
    """Starts per hour allowed for a motor started direct on line, the lesser of A and B/Wk² (NEMA MG 10, table 2-3).

    Parameters
    ----------
    rated_power : float
        P of one motor [W], 1 to 250 hp; between two sizes the less favourable figures.
    poles : {2, 4, 6}
        Of the motor [-].
    load_inertia : float
        Wk², of all it accelerates besides itself, at its shaft [kg m²], positive.

    Returns
    -------
    float
        [1/h]; less than 1 where the table allows no start of such a load.

    Raises
    ------
    InputError
        An argument is outside its range.
    RangeError
        The power is outside the table.

    Notes
    -----
    Designs A and B, load torque at most as the square of the speed: a belt asks for more torque, ask the maker beyond
    light loads.

    Examples
    --------
    >>> round(allowed_starts(25 * HORSEPOWER, poles=4, load_inertia=50 * 0.04214011), 2)
    2.44
    """
    require_positive(rated_power=rated_power, load_inertia=load_inertia)
    require(poles in {2, 4, 6}, "poles", poles, "2, 4, 6")
    size = rated_power / HORSEPOWER
    above = [row for row in _STARTS if row[0] >= size * (1.0 - _SHARE_TOLERANCE)]
    below = [row for row in _STARTS if row[0] <= size * (1.0 + _SHARE_TOLERANCE)]
    if not above or not below:
        raise RangeError(f"{size:.4g} hp is outside NEMA's table of starts, 1 to 250 hp: ask the motor's maker")
    column = poles // 2
    most, product = above[0][column][0], below[-1][column][1]  # type: ignore[index]
    return min(most, product * _POUND_FOOT / load_inertia)


def backstop_torque(force: float, *, radius: float, count: int) -> float:
    """Torque of one of n backstops at its pulley, 1.4 F r/n; of a single one F r (general knowledge).

    Parameters
    ----------
    force : float
        F that holds the loaded belt [N], at least 0.
    radius : float
        r of the pulley [m], positive.
    count : int
        n of the backstops [-], at least 1.

    Returns
    -------
    float
        [N m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Play and wind-up differ, so that two bear up to 70 % each; none bears more than all.

    Examples
    --------
    >>> backstop_torque(100e3, radius=0.5, count=1), backstop_torque(100e3, radius=0.5, count=2)
    (50000.0, 35000.0)
    """
    require_not_negative(force=force)
    require_positive(radius=radius)
    require(count >= 1, "count", count, ">= 1")
    return force * radius * min(1.0, BACKSTOP_SHARE_FACTOR.value / count)


def disc_temperature_rise(heat: float, *, mass: float) -> float:
    """Temperature rise of a brake disc in a stop, Q/(m c), without cooling (derived).

    Parameters
    ----------
    heat : float
        Q of one stop [J], at least 0.
    mass : float
        m of the disc or drum [kg], positive.

    Returns
    -------
    float
        [K], c 460 J/(kg K) of steel.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> disc_temperature_rise(4.6e6, mass=100.0)
    100.0
    """
    require_not_negative(heat=heat)
    require_positive(mass=mass)
    return heat / (mass * DISC_HEAT.value)


def flywheel_inertia(
    time: float, *, retarding_force: float, moving_mass: float, belt_speed: float, radius: float, ratio: float
) -> float:
    """Flywheel that lengthens coasting to a time, J = (F t/v - m) r²/i² (derived: Newton).

    Parameters
    ----------
    time : float
        t wanted from full speed to rest [s], positive.
    retarding_force : float
        F, resistances with the lift [N], positive.
    moving_mass : float
        m, everything reduced to the belt without it [kg], positive.
    belt_speed : float
        v [m/s], positive.
    radius : float
        r of the drive pulley [m], positive.
    ratio : float
        i, speed of the flywheel over that of the pulley [-], positive.

    Returns
    -------
    float
        J [kg m²]; 0 where it coasts as long by itself.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> flywheel_inertia(20.0, retarding_force=25e3, moving_mass=50e3, belt_speed=5.0, radius=0.5, ratio=16.0)
    48.828125
    """
    require_positive(time=time, retarding_force=retarding_force, moving_mass=moving_mass, belt_speed=belt_speed)
    require_positive(radius=radius, ratio=ratio)
    missing = retarding_force * time / belt_speed - moving_mass
    return max(0.0, missing) * (radius / ratio) ** 2


def gear_torque(rated_power: float, *, rotation: float, service: float = GEAR_SERVICE.value) -> float:
    """Rated torque of a gear or coupling at a shaft, k P/(2 π n), k = 1.5 general knowledge.

    Parameters
    ----------
    rated_power : float
        P of its motor [W], positive.
    rotation : float
        n of the shaft, a gear's slow one [1/s], positive.
    service : float
        k, rated torque over that of the motor [-], positive.

    Returns
    -------
    float
        [N m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(gear_torque(200e3, rotation=1.5))
    31831
    """
    require_positive(rated_power=rated_power, rotation=rotation, service=service)
    return service * rated_power / (2.0 * math.pi * rotation)


def next_preferred_number(value: float) -> float:
    """Next larger preferred number of the series R10 (ISO 3): sizes of gears, backstops and brakes.

    Parameters
    ----------
    value : float
        In any decimal unit [-], positive.

    Returns
    -------
    float
        Of the same unit [-].

    Raises
    ------
    InputError
        The value is not positive.

    Examples
    --------
    >>> next_preferred_number(31831.0), next_preferred_number(950.0)
    (40000.0, 1000.0)
    """
    require_positive(value=value)
    return next(size for size in _decade_numbers(value, _R10) if size >= value * (1.0 - _SHARE_TOLERANCE))


def nearest_ratio(ratio: float) -> float:
    """Preferred ratio of gears nearest to a wanted one, series R20 (ISO 3).

    Parameters
    ----------
    ratio : float
        Speed of the motor over that of the pulley [-], positive.

    Returns
    -------
    float
        [-].

    Raises
    ------
    InputError
        The ratio is not positive.

    Examples
    --------
    >>> nearest_ratio(15.6), nearest_ratio(24.0)
    (16.0, 25.0)
    """
    require_positive(ratio=ratio)
    return min(_decade_numbers(ratio, _R20), key=lambda size: abs(math.log(size / ratio)))


def _decade_numbers(value: float, series: Sequence[float]) -> tuple[float, ...]:
    """Preferred numbers of a value's decade, and the first of the next."""
    decade = 10.0 ** math.floor(math.log10(value))
    return (*(decade * step for step in series), 10.0 * decade)


def shared_forces(
    force: float,
    *,
    rated: Sequence[float],
    slips: Sequence[float],
    diameters: Sequence[float],
    strains: Sequence[float],
) -> tuple[float, ...]:
    """Forces of drives coupled by the belt alone, F_i = R_i (1 - v (1 + ε_i)/V_i)/s_i with Σ F_i = F.

    Parameters
    ----------
    force : float
        F of all drives [N].
    rated : sequence of float
        R_i, force of each at its rated torque [N], positive, shape (n,).
    slips : sequence of float
        s_i of motor and coupling at rated torque [-], above 0, below 1, shape (n,).
    diameters : sequence of float
        V_i, of each pulley over its nominal one [-], positive, shape (n,): speed without load, all nominal ones alike.
    strains : sequence of float
        ε_i of the belt where it runs onto each pulley over that at the first [-], shape (n,).

    Returns
    -------
    tuple of float
        F_i [N], shape (n,); negative: the drive brakes.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived: motors are linear about their rated point; belt creeps over a pulley at the speed it arrives with. Between
    drives nothing is lost to the strain's change in `force`.

    Examples
    --------
    >>> [
    ...     round(f)
    ...     for f in shared_forces(80e3, rated=[50e3] * 2, slips=[0.02] * 2, diameters=[1.0] * 2, strains=[0.0] * 2)
    ... ]
    [40000, 40000]
    >>> [
    ...     round(f)
    ...     for f in shared_forces(80e3, rated=[50e3] * 2, slips=[0.02] * 2, diameters=[1.0, 0.99], strains=[0.0] * 2)
    ... ]
    [52362, 27638]
    """
    require_finite(force=force)
    count = len(rated)
    alike = count > 0 and count == len(slips) == len(diameters) == len(strains)
    require(alike, "rated", list(rated), "as many as slips, diameters and strains, one at least")
    for each, slip, diameter, strain in zip(rated, slips, diameters, strains, strict=True):
        require_positive(rated=each, diameters=diameter)
        require(0.0 < slip < 1.0, "slips", slip, "> 0 and < 1")
        require_finite(strains=strain)
    stiff = [each / slip for each, slip in zip(rated, slips, strict=True)]
    over = [(1.0 + strain) / diameter for strain, diameter in zip(strains, diameters, strict=True)]
    speed = (math.fsum(stiff) - force) / math.fsum(k * o for k, o in zip(stiff, over, strict=True))
    return tuple(k * (1.0 - speed * o) for k, o in zip(stiff, over, strict=True))
