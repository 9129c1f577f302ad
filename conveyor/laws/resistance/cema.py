"""The classic form of the Conveyor Equipment Manufacturers Association: US units inside, SI at the border.

Source: CEMA, Belt Conveyors for Bulk Materials, 5th ed. 1997, chapter 6; the formulas as commonly reproduced.
The tables of Ky, Kt and Cs are not here: they come from the user's copy.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_positive
from conveyor.laws.resistance.resistance_defaults import Default

FOOT: Final = 0.3048  # [m], exact
POUND: Final = 0.45359237  # [kg], exact
POUND_FORCE: Final = 4.4482216152605  # [N], exact: one pound at 9.80665 m/s²
INCH: Final = 0.0254  # [m], exact
SHORT_TON_PER_HOUR: Final = 2000.0 * POUND / 3600.0  # [kg/s]
FOOT_PER_MINUTE: Final = FOOT / 60.0  # [m/s]

SLIDING_FACTOR: Final = 0.00068  # [-], CEMA eq. for Kx: idler sliding and indentation
RETURN_FACTOR: Final = 0.015  # [-], CEMA: Ky of the belt on the return strand
ACCELERATION_FACTOR: Final = 2.8755e-4  # [lbf per (short ton/h ft/min)], CEMA: Tam; 2000/(3600·60·32.2)

_SOURCE: Final = "CEMA 5th ed., as commonly reproduced"
# Idler friction A_i [lbf per set]
IDLER_FRICTION_4_IN: Final = Default(2.3, 2.3, 2.3, f"{_SOURCE}: 4 in rolls, series B and C", True)
IDLER_FRICTION_5_IN: Final = Default(1.8, 1.8, 1.8, f"{_SOURCE}: 5 in rolls, series B, C, D", True)
IDLER_FRICTION_6_IN: Final = Default(1.5, 1.5, 1.5, f"{_SOURCE}: 6 in rolls, series C and D", True)
IDLER_FRICTION_6_IN_HEAVY: Final = Default(2.8, 2.8, 2.8, f"{_SOURCE}: 6 in rolls, series E", True)
IDLER_FRICTION_7_IN: Final = Default(2.4, 2.4, 2.4, f"{_SOURCE}: 7 in rolls, series E", True)

# Accessories [lbf per inch of belt width]
CLEANER_PER_INCH: Final = Default(5.0, 5.0, 5.0, f"{_SOURCE}: per scraper", True)
PLOUGH_PER_INCH: Final = Default(5.0, 3.0, 5.0, f"{_SOURCE}: full plough; 3 for one that takes half", True)
SEALS_PER_FOOT: Final = Default(6.0, 6.0, 6.0, f"{_SOURCE}: rubber seals of both skirts", True)  # [lbf/ft]

Place = Literal["tight", "slack", "other"]
DRIVE_PULLEY_FRICTION: Final = 200.0 * POUND_FORCE  # [N], CEMA: bearings, in the motor power alone
PULLEY_FRICTION: Final[dict[Place, float]] = {"tight": 200.0, "slack": 150.0, "other": 100.0}  # [lbf], CEMA


def cema_idler_factor(belt_mass: float, *, bulk_mass: float, idler_friction: float, spacing: float) -> float:
    """Idler friction factor, Kx = 0.00068 (Wb + Wm) + A_i/S_i (CEMA).

    Parameters
    ----------
    belt_mass : float
        m'_belt, Wb [kg/m], at least 0.
    bulk_mass : float
        m'_bulk, Wm [kg/m], at least 0.
    idler_friction : float
        A_i of one idler set [N], at least 0; the book's figures are in lbf: 1.5 lbf is 6.67 N.
    spacing : float
        S_i of the carry sets [m], positive.

    Returns
    -------
    float
        Kx [N/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> kx = cema_idler_factor(15 * 1.48816, bulk_mass=0.0, idler_friction=1.5 * 4.44822, spacing=3 * 0.3048)
    >>> round(kx / 4.44822 * 0.3048, 4)
    0.5102
    """
    require_not_negative(belt_mass=belt_mass, bulk_mass=bulk_mass, idler_friction=idler_friction)
    require_positive(spacing=spacing)
    pounds_per_foot = (belt_mass + bulk_mass) / (POUND / FOOT)
    factor = SLIDING_FACTOR * pounds_per_foot + idler_friction / POUND_FORCE / (spacing / FOOT)
    return factor * POUND_FORCE / FOOT


def cema_acceleration(mass_flow: float, *, belt_speed: float, initial_speed: float) -> float:
    """Resistance of accelerating the bulk, Tam = 2.8755e-4 Q (V - V0) (CEMA).

    Parameters
    ----------
    mass_flow : float
        Q [kg/s], at least 0; short tons per hour in the formula.
    belt_speed : float
        V [m/s], positive; ft/min in the formula.
    initial_speed : float
        V0 along the belt [m/s], from 0 to V.

    Returns
    -------
    float
        Tam [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Momentum with g rounded to 32.2 ft/s²: 0.08 % below Q (V - V0).

    Examples
    --------
    >>> round(cema_acceleration(2300 / 3.6, belt_speed=4.8, initial_speed=0.0), 1)
    3064.1
    """
    require_not_negative(mass_flow=mass_flow)
    require_positive(belt_speed=belt_speed)
    ok = 0.0 <= initial_speed <= belt_speed
    require(ok, "initial_speed", initial_speed, f">= 0 and <= belt_speed = {belt_speed!r} m/s")
    tons = mass_flow / SHORT_TON_PER_HOUR
    return ACCELERATION_FACTOR * tons * (belt_speed - initial_speed) / FOOT_PER_MINUTE * POUND_FORCE


def cema_pulley_friction(places: Sequence[Place]) -> float:
    """Resistance of all non-driven pulleys, Tp: 200 lbf tight, 150 lbf slack, 100 lbf elsewhere, each (CEMA).

    Parameters
    ----------
    places : sequence of {"tight", "slack", "other"}
        One entry for each pulley [-]: tight or slack side with 150 to 240 deg of wrap, or other, less than 150 deg.

    Returns
    -------
    float
        Tp [N].

    Raises
    ------
    InputError
        A place is unknown.

    Notes
    -----
    As commonly reproduced from the book's table: an analysis that uses it must say so.

    Examples
    --------
    >>> round(cema_pulley_friction(["tight", "slack", "other"]), 1)
    2001.7
    """
    for place in places:
        require(place in PULLEY_FRICTION, "places", place, ", ".join(PULLEY_FRICTION))
    return math.fsum(PULLEY_FRICTION[place] for place in places) * POUND_FORCE


def cema_skirts(length: float, *, skirt_factor: float, depth: float, seals: float) -> float:
    """Resistance of skirtboards with rubber seals, Tsb = Lb (Cs hs² + 6) (CEMA).

    Parameters
    ----------
    length : float
        Lb of the skirts [m], at least 0.
    skirt_factor : float
        Cs of the material, from the book's table [-], at least 0: 0.1378 for dry bank sand; hs in inches, lbf/ft.
    depth : float
        hs, depth of the material that touches the skirts [m], at least 0.
    seals : float
        Friction of the seals of both sides along them [N/m], at least 0; 6 lbf/ft in the book.

    Returns
    -------
    float
        Tsb [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    A sheet of Rulmeca (Motorized Pulley Power Calculation Program, metric, 5.37) prints 269 N:

    >>> round(cema_skirts(3.0, skirt_factor=0.1378, depth=0.025, seals=6.0 * POUND_FORCE / FOOT))
    269
    """
    require_not_negative(length=length, skirt_factor=skirt_factor, depth=depth, seals=seals)
    return length * (skirt_factor * (depth / INCH) ** 2 * POUND_FORCE / FOOT + seals)


@dataclass(frozen=True, slots=True)
class CemaTension:
    """Effective tension of the classic form, by cause.

    Parameters
    ----------
    idlers : float
        L Kt Kx: idlers of both strands [N].
    belt_carry : float
        L Kt Ky Wb: flexure of belt on the carry strand [N].
    belt_return : float
        L Kt 0.015 Wb: the same on the return strand [N].
    bulk : float
        L Ky Wm: flexure of the bulk [N].
    lift : float
        H Wm [N], negative downhill.
    others : float
        Tp + Tam + Tac [N].
    """

    idlers: float
    belt_carry: float
    belt_return: float
    bulk: float
    lift: float
    others: float

    @property
    def effective(self) -> float:
        """Te [N]."""
        return math.fsum((self.idlers, self.belt_carry, self.belt_return, self.bulk, self.lift, self.others))


def cema_effective_tension(
    length: float,
    *,
    lift: float,
    belt_mass: float,
    bulk_mass: float,
    idler_factor: float,
    flexure_factor: float,
    temperature_factor: float = 1.0,
    other_forces: float = 0.0,
) -> CemaTension:
    """Effective tension, Te = L Kt (Kx + Ky Wb + 0.015 Wb) + Wm (L Ky ± H) + Tp + Tam + Tac (CEMA).

    Parameters
    ----------
    length : float
        L of the conveyor [m], at least 0.
    lift : float
        H [m], positive uphill.
    belt_mass : float
        Wb [kg/m], at least 0.
    bulk_mass : float
        Wm [kg/m], at least 0.
    idler_factor : float
        Kx [N/m], at least 0, see `cema_idler_factor`.
    flexure_factor : float
        Ky [-], from 0 to 0.1, from the book's table (0.016 to 0.035) over spacing, slope, length and load.
    temperature_factor : float
        Kt [-], at least 1: 1 above freezing, from the book's chart below.
    other_forces : float
        Tp + Tam + Tac, pulleys, acceleration, accessories [N], at least 0.

    Returns
    -------
    CemaTension
        Te and its parts [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Weights are pounds force for pounds mass: standard gravity, 9.80665 m/s², is in the formula. Kt does not touch
    the bulk's part, as in the book. Classic sizes: to about 900 m and moderate speeds [general knowledge].

    Examples
    --------
    >>> te = cema_effective_tension(
    ...     1000 * 0.3048,
    ...     lift=0.0,
    ...     belt_mass=15 * 1.48816,
    ...     bulk_mass=60 * 1.48816,
    ...     idler_factor=0.551 * 14.5939,
    ...     flexure_factor=0.02,
    ... )
    >>> round(te.effective / 4.44822)
    2276
    """
    require_not_negative(length=length, belt_mass=belt_mass, bulk_mass=bulk_mass)
    require_not_negative(idler_factor=idler_factor, other_forces=other_forces)
    require_finite(lift=lift, temperature_factor=temperature_factor)
    require(0.0 <= flexure_factor <= 0.1, "flexure_factor", flexure_factor, ">= 0 and <= 0.1")
    require(temperature_factor >= 1.0, "temperature_factor", temperature_factor, ">= 1")
    feet, rise = length / FOOT, lift / FOOT
    belt, bulk = (mass / (POUND / FOOT) for mass in (belt_mass, bulk_mass))
    kx = idler_factor / (POUND_FORCE / FOOT)
    warm = feet * temperature_factor
    return CemaTension(
        idlers=warm * kx * POUND_FORCE,
        belt_carry=warm * flexure_factor * belt * POUND_FORCE,
        belt_return=warm * RETURN_FACTOR * belt * POUND_FORCE,
        bulk=bulk * feet * flexure_factor * POUND_FORCE,
        lift=bulk * rise * POUND_FORCE,
        others=other_forces,
    )
