"""Conveyors for the tests of the loop: forces along the belt by f, without a contact, so that a case costs no time."""

from __future__ import annotations

import copy
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import run_checks
from conveyor.forces import forces_along_belt, rubber_free_forces
from conveyor.line.contacts import Contacts
from conveyor.line.line import Line
from conveyor.line.stretches import Stretch
from conveyor.loop.balance import Balance, close_loop
from conveyor.loop.loop_layout import LoopLayout
from conveyor.models import Conveyor
from conveyor.spec import from_data

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
FRICTION = 0.011  # of indentation over the load, of the size real belts have

DATA: dict[str, Any] = {
    "name": "loop",
    "belt": {
        "width": "1000 mm", "speed": "4 m/s", "mass": "20 kg/m^2",
        "top_cover": {"thickness": "6 mm"}, "bottom_cover": {"thickness": "4 mm", "compound": "s100"},
        "carcass": {"kind": "steel cord", "thickness": "5 mm", "strength": "2000 N/mm"},
    },
    "idlers": {
        "carry": {"rolls": 3, "spacing": "1.2 m", "trough_angle": "35 deg",
                  "roll": {"diameter": "133 mm", "length": "380 mm", "rotating_mass": "4 kg", "drag": "1.5 N"}},
        "return": {"rolls": 1, "spacing": "3 m",
                   "roll": {"diameter": "133 mm", "length": "1150 mm", "rotating_mass": "9 kg", "drag": "1.5 N"}},
    },
    "material": {"name": "ore", "density": "1.6 t/m^3", "flow": "1200 t/h", "surcharge_angle": "15 deg"},
    "route": {
        "sections": [
            {"name": "a", "length": "120 m"}, {"name": "b", "length": "400 m", "lift": "25 m"},
            {"name": "c", "length": "300 m", "lift": "-8 m"}, {"name": "d", "length": "180 m", "lift": "6 m"},
        ],
        "feeding": {"speed": "1 m/s", "skirt_length": "4 m", "skirt_width": "600 mm"},
        "cleaners": [{"count": 2, "width": "900 mm", "thickness": "8 mm"}],
        "pulleys": [
            {"name": "head", "position": "head", "diameter": "1000 mm", "shaft_diameter": "200 mm", "mass": "2 t"},
            {"name": "bend", "position": "take-up", "diameter": "800 mm", "shaft_diameter": "160 mm", "mass": "1 t"},
            {"name": "tail", "position": "tail", "diameter": "800 mm", "shaft_diameter": "160 mm", "mass": "1 t"},
            {"name": "snub", "position": "return", "section": "c", "diameter": "630 mm",
             "shaft_diameter": "120 mm", "mass": "0.5 t", "wrap_angle": "20 deg"},
        ],
    },
    "drive": {"wrap_angle": "200 deg", "friction": 0.35, "efficiency": "94 %", "installed_power": "400 kW",
              "reduced_mass": "0 kg"},
    "ambient": {"temperature": "20 degC"},
}  # fmt: skip

BOOSTER = {
    "name": "booster", "position": "carry", "section": "b", "wrap_angle": "190 deg", "friction": 0.3,
    "installed_power": "200 kW", "reduced_mass": "0 kg",
}  # fmt: skip
TAIL_DRIVE = {
    "name": "tail drive", "position": "tail", "wrap_angle": "180 deg", "friction": 0.3, "installed_power": "100 kW",
    "reduced_mass": "0 kg",
}  # fmt: skip
SECOND = {"name": "second", "wrap_angle": "180 deg", "friction": 0.3, "installed_power": "400 kW",
          "reduced_mass": "0 kg"}  # fmt: skip
DOWN = [{"name": "a", "length": "100 m"}, {"name": "b", "length": "900 m", "lift": "-110 m"},
        {"name": "c", "length": "80 m"}]  # fmt: skip


def data(**changes: dict[str, Any]) -> dict[str, Any]:
    """The plain data, with parts of each group replaced."""
    made = copy.deepcopy(DATA)
    for group, values in changes.items():
        made[group] = made.get(group, {}) | values
    return made


def line(**changes: dict[str, Any]) -> Conveyor:
    return from_data(data(**changes))


def closed(conveyor: Conveyor, friction: float = FRICTION, *, by_sag: bool = False) -> Balance:
    """The loop around forces along the belt with an indentation of `friction` times the load.

    Its flexure is a share of the load, so that no force along the belt depends on the tension, or that of the sag.
    """
    made = Line.of(conveyor)
    fixed = rubber_free_forces(made.strands)
    if not by_sag:
        made, fixed = replace(made, flexes_by_sag=False), replace(fixed, flexure=0.002 * fixed.unit_main)
    along = forces_along_belt(made, fixed, friction * fixed.unit_main)
    return close_loop(LoopLayout(made), along, float(fixed.unit_main.sum()))


def balanced(**changes: dict[str, Any]) -> Balance:
    return closed(line(**changes))


class OnStretch(NamedTuple):
    """A stretch, and of the forces along it [N] the lift and all together."""

    stretch: Stretch
    lift: float
    total: float


def along(found: Balance) -> tuple[OnStretch, ...]:
    """The forces along the belt, carry strand from the tail, return strand from the head."""
    (lift,) = (force.along for force in found.along if force.key == "lift")
    total = sum(force.along for force in found.along)
    return tuple(map(OnStretch, found.line.stretches, lift.tolist(), total.tolist()))


def told(conveyor: Conveyor, found: Balance) -> list[str]:
    """What every criterion that needs no contact says where it is not met."""
    given = CalculatedConveyor(
        conveyor=conveyor,
        temperature=conveyor.temperature,
        contacts=Contacts(found.line, {}, (), ()),
        balance=found,
        rubber_free=rubber_free_forces(found.line.strands),
    )
    checked = run_checks(given, contacts=False)
    return [check.why.text() for check in checked if check.verdict != "pass" and check.why is not None]
