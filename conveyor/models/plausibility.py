"""Implausible inputs: a figure in another unit, a slipped decimal point, a set of a wider belt.

Bounds lie well outside what is in use; where no source is named they are general knowledge.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from conveyor.errors import InputError
from conveyor.laws.preliminary_sizing import carcass_mass
from conveyor.laws.resistance import roll_rotation
from conveyor.models.conveyor import Conveyor
from conveyor.units import si, text, unit_system
from conveyor.units.sentences import Message, message, percent
from conveyor.units.unit_systems import trade_of

HEAVIEST_BULK: Final = 5000.0
"""Bulk density of what belts carry [kg/m³]; iron ore and concentrates have 2000 to 3500."""
FASTEST_ROLL: Final = roll_rotation(8.5, roll_diameter=0.178)
"""Fastest rolls of a published conveyor [1/s]: KPC, 8.5 m/s on 178 mm (tests/validation/conveyors/kpc.yaml)."""
WIDEST_SET: Final = 1.5
"""Rolls of a set side by side over the belt's width [-]; at most 1.25 in the lists after ISO 1537 and DIN 22107."""
POOREST_DRIVE: Final = 0.5
"""Efficiency from motor to belt [-]; that of a worm gear."""
HEAVIEST_ROLL: Final = 0.5
"""Rotating mass of a roll over that of a solid steel one of its size [-]; of shells in lists 0.15 to 0.3."""
_STEEL: Final = 7850.0  # [kg/m³]
CARCASS_MASS_RATIO: Final = (0.5, 1.4)
"""Mass of a carcass over that of `laws.sizing.carcass_mass` [-]; of belts in lists and examples 0.65 to 1.2."""


def implausible_inputs(conveyor: Conveyor) -> Iterator[Message]:
    """Notes on implausible inputs of a spec, and what may be meant."""
    yield from _check_flow(conveyor)
    yield from _check_density(conveyor)
    yield from _check_carcass(conveyor)
    yield from _check_sets(conveyor)
    efficiency = si(conveyor.drive.efficiency)
    if efficiency < POOREST_DRIVE:
        lost = percent(1.0 - efficiency)
        yield message(f"drive.efficiency {text(conveyor.drive.efficiency)}: {lost} of the power is lost; look again")


def _check_flow(conveyor: Conveyor) -> Iterator[Message]:
    flow = conveyor.material.flow
    us = "US" in {trade_of(conveyor.report.units), unit_system(conveyor.belt.width)}
    if us and text(flow).endswith(" tph"):
        yield message(
            f"material.flow {text(flow)}: tph are metric tonnes per hour, {{}}; short tons per hour are stph",
            (si(flow), "mass flow"),
        )


def _check_density(conveyor: Conveyor) -> Iterator[Message]:
    material = conveyor.material
    field = "density" if material.weight_density is None else "weight_density"
    if si(material.heaviest) > HEAVIEST_BULK:
        yield message(
            f"material.{field} {text(material.heaviest)}: no bulk that belts carry is heavier than {{}} (general "
            "knowledge); look again",
            (HEAVIEST_BULK, "density"),
        )


def _check_carcass(conveyor: Conveyor) -> Iterator[Message]:
    """Carcass mass that suggests a mixup of mass per length and per area."""
    belt, carcass = conveyor.belt, conveyor.belt.carcass
    steel = carcass.kind == "steel cord"
    if steel and carcass.strength is None:
        return
    strength = 1.0 if carcass.strength is None else si(carcass.strength)
    try:
        usual = carcass_mass(strength, thickness=si(carcass.thickness), steel_cord=steel)
    except InputError:
        yield message(f"belt.carcass.thickness {text(carcass.thickness)}: cords of this strength need more steel")
        return
    left = belt.line_mass / si(belt.width) - belt.top_cover.area_mass - belt.bottom_cover.area_mass
    if CARCASS_MASS_RATIO[0] * usual <= left <= CARCASS_MASS_RATIO[1] * usual:
        return
    thick = f"carcass of {text(carcass.thickness)}"
    yield message(
        f"belt.carcass.mass: {{}} for the {thick}, {{}} is usual (of listed belts): is it of the whole belt?"
        if belt.mass is None
        else f"belt.mass leaves {{}} for the {thick}, {{}} is usual (of listed belts): is it per area or per length, "
        "are the covers right?",
        (left, "area mass"),
        (usual, "area mass"),
    )


def _check_sets(conveyor: Conveyor) -> Iterator[Message]:
    width, speed = si(conveyor.belt.width), si(conveyor.belt.speed)
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        side_by_side = idlers.rolls * si(idlers.roll.length)
        if not idlers.shape.closed and side_by_side > WIDEST_SET * width:
            yield message(
                f"idlers.{strand}: {idlers.rolls} x {text(idlers.roll.length)} side by side are {{}} times as wide as "
                "the belt, listed sets at most 1.25 times (ISO 1537, DIN 22107): rolls of a wider belt?",
                (side_by_side / width, "safety"),
            )
        solid = _STEEL * 0.25 * math.pi * si(idlers.roll.diameter) ** 2 * si(idlers.roll.length)
        mass = idlers.roll.rotating_mass
        if mass is not None and si(mass) > HEAVIEST_ROLL * solid:
            yield message(
                f"idlers.{strand}.roll.rotating_mass {text(mass)}: a solid steel roll of its size has {{}}; look again",
                (solid, "mass"),
            )
        rotation = roll_rotation(speed, roll_diameter=si(idlers.roll.diameter))
        if rotation > 1.01 * FASTEST_ROLL:
            yield message(
                f"idlers.{strand}: its rolls turn at {{}}, the fastest of a published conveyor at {{}} (KPC, 8.5 m/s): "
                "take larger rolls",
                (rotation, "rotation"),
                (FASTEST_ROLL, "rotation"),
            )
