"""What a conveyor costs: parts by their prices, each over its life, energy and upkeep; numbers or arrays alike."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.sizing import annuity

Value: TypeAlias = "float | NDArray[np.float64]"


@dataclass(frozen=True, eq=False)
class Parts:
    """What a conveyor is built of and what it draws; every figure a number, or an array over candidates.

    `width`, `length` [m], `strength` [N/m], `cover` and `special_cover` thickness [m], `steel_cord` 1 or 0, number of
    idler `sets` and `rolls`, what of all rolls turns `roll_mass` [kg], `roll_life` of bearings [s], number of `drives`
    and their `power` [W], `pulley_mass` [kg], `take_up` tension [N].
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
    """Capital by part, and what a year costs by part and of energy and upkeep [currency, currency/a]."""

    capital: Mapping[str, Value]
    yearly: Mapping[str, Value]

    @property
    def whole_capital(self) -> Value:
        """Of all parts."""
        return sum(self.capital.values(), 0.0)

    @property
    def year(self) -> Value:
        """Of everything."""
        return sum(self.yearly.values(), 0.0)


def costs(parts: Parts, prices: Mapping[str, float], *, seconds: float, energy: Value) -> Costs:
    """Cost a conveyor.

    Parameters
    ----------
    parts : Parts
        What it is built of.
    prices : mapping of str to float
        `Prices.amounts`.
    seconds : float
        Of running in a year [s].
    energy : float or ndarray
        Cost of a year's energy [currency/a].

    Returns
    -------
    Costs
        Of each part, at an annuity over its life: what is worn is renewed for ever.
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
    yearly["energy"] = energy
    return Costs(capital, yearly)
