"""Costs of a conveyor: parts at their prices over their lives, energy and upkeep; for numbers or arrays."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.belt_strength import RATED_SAFETY
from conveyor.laws.preliminary_sizing import annuity
from conveyor.line.roll_lives import shortest_set_life
from conveyor.line.stretches import STRANDS
from conveyor.models import Conveyor

Value: TypeAlias = "float | NDArray[np.float64]"
_NO_LIFE: Final = 1e12  # [s], for rolls without load or bearings: their seals wear out sooner


@dataclass(frozen=True, eq=False)
class Parts:
    """Quantities of parts and power of a conveyor; each a number, or an array over candidates.

    `width`, `length` [m], `strength` [N/m], `cover` and `special_cover` thickness [m], `steel_cord` 1 or 0, number of
    idler `sets` and `rolls`, rotating mass of all rolls `roll_mass` [kg], `roll_life` of bearings [s], number of
    `drives` and their `power` [W], `pulley_mass` [kg], `take_up` tension [N].
    """

    width: Value
    length: float
    strength: Value
    steel_cord: Value
    cover: Value
    special_cover: Value
    sets: Value
    rolls: Value
    roll_mass: Value
    roll_life: Value
    drives: Value
    power: Value
    pulley_mass: Value
    take_up: Value


@dataclass(frozen=True, eq=False)
class Costs:
    """Capital by part, and yearly costs by part, energy and upkeep [currency, currency/a]."""

    capital: Mapping[str, Value]
    yearly: Mapping[str, Value]

    @property
    def whole_capital(self) -> Value:
        """Capital of all parts [currency]."""
        return sum(self.capital.values(), 0.0)

    @property
    def year(self) -> Value:
        """Total cost of a year [currency/a]."""
        return sum(self.yearly.values(), 0.0)

    @property
    def parts_year(self) -> Value:
        """Cost of a year without energy [currency/a]."""
        return sum((value for name, value in self.yearly.items() if name != "energy"), 0.0)


def conveyor_costs(parts: Parts, prices: Mapping[str, float], *, seconds: float, energy: Value | None) -> Costs:
    """Capital and yearly costs of a conveyor.

    Parameters
    ----------
    parts : Parts
        Quantities of its parts.
    prices : mapping of str to float
        `Prices.amounts`.
    seconds : float
        Running time in a year [s].
    energy : float, ndarray or None
        Cost of a year's energy [currency/a].

    Returns
    -------
    Costs
        Of each part, at an annuity over its life: worn parts are renewed for ever.
    """
    p, area = prices, 2.0 * parts.length * parts.width
    steel = parts.steel_cord
    belt = area * (
        steel * (p["steel_cord"] + p["steel_cord_strength"] * parts.strength)
        + (1.0 - steel) * (p["textile"] + p["textile_strength"] * parts.strength)
        + p["cover"] * parts.cover
        + p["special_cover"] * parts.special_cover
    )
    splices = np.ceil(2.0 * parts.length / p["roll_of_belt"]) * p["splice"] * parts.width
    capital: dict[str, Value] = {
        "belt": belt + splices,
        "rolls": p["roll"] * parts.rolls + p["roll_mass"] * parts.roll_mass,
        "idler frames": p["set"] * parts.width * parts.sets,
        "structure": parts.length * (p["structure"] + p["structure_width"] * parts.width),
        "drives": p["drive"] * parts.drives + p["drive_power"] * parts.power,
        "pulleys": p["pulley_mass"] * parts.pulley_mass,
        "take-up": p["take_up"] + p["take_up_force"] * parts.take_up,
    }
    interest = p["interest"]
    over = annuity(p["years"], interest=interest)
    yearly: dict[str, Value] = {name: over * value for name, value in capital.items()}
    textile, steel_cord = annuity([p["textile_life"], p["steel_cord_life"]], interest=interest)
    yearly["belt"] = (textile + steel * (steel_cord - textile)) * capital["belt"]
    worn = np.minimum(parts.roll_life, p["roll_life"]) / seconds
    yearly["rolls"] = annuity(worn, interest=interest) * capital["rolls"]
    yearly["upkeep"] = p["upkeep"] * sum(capital.values(), 0.0)
    if energy is not None:
        yearly["energy"] = energy
    return Costs(capital, yearly)


def missing_price_fields(line: Conveyor) -> Iterator[str]:
    """Fields missing in a spec for pricing its parts."""
    if line.belt.carcass.strength is None and line.belt.carcass.rating is None:
        yield "belt.carcass.strength"
    if line.drive.installed_power is None:
        yield "drive.installed_power"
    for drive in line.drive.further_drives:
        if drive.installed_power is None:
            yield f"drive.further_drives.{drive.name}.installed_power"


def roll_life(one: CalculatedConveyor) -> float:
    """Shortest L10 of the bearings of any set [s]."""
    lives = [shortest_set_life(one.line.stretches, strand, one.line.speed) for strand in STRANDS]
    return min((3600.0 * life.hours for life in lives if life is not None), default=_NO_LIFE)


def conveyor_parts(one: CalculatedConveyor) -> Parts | None:
    """Parts of a calculated conveyor as its spec lists them; None if `missing_price_fields` names a field.

    The bottom cover is a special one if its compound is not that of the top cover; a belt sold by its rated tension is
    taken to break at a usual multiple of it.
    """
    if any(missing_price_fields(one.conveyor)):
        return None
    line, belt = one.line, one.line.belt
    (top, bottom), rubber = belt.cover_thicknesses, one.conveyor.belt.top_cover.compound
    special = rubber is not None and rubber != one.conveyor.belt.bottom_cover.compound
    return Parts(
        width=belt.width,
        length=line.length,
        strength=belt.strength or RATED_SAFETY["steel cord" if belt.steel_cord else "textile"] * (belt.rating or 0.0),
        steel_cord=float(belt.steel_cord),
        cover=top if special else top + bottom,
        special_cover=bottom if special else 0.0,
        sets=math.fsum(stretch.sets for stretch in line.stretches),
        rolls=math.fsum(stretch.sets * stretch.idlers.rolls for stretch in line.stretches),
        roll_mass=math.fsum(stretch.sets * stretch.set_mass for stretch in line.stretches),
        roll_life=roll_life(one),
        drives=float(len(line.drives)),
        power=math.fsum(drive.power or 0.0 for drive in line.drives),
        pulley_mass=math.fsum(pulley.mass for pulley in line.pulleys),
        take_up=one.balance.equilibrium.setting,
    )
