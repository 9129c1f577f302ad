"""Every force stands at its true place: the loop walked by hand, with arithmetic of this file only."""

from __future__ import annotations

import copy
import math
from typing import Any

import pytest

from conveyor.loop.balance import Balance
from conveyor.loop.tensions import MotionState
from conveyor.spec import from_data
from tests.loop.loop_lines import BOOSTER, DATA, TAIL_DRIVE, along, closed, line

ROUTE = DATA["route"]
CLOSED = 1e-9  # of the largest tension; rounding alone leaves about 1e-14

# what the belt meets from the head round to it: sections, drives, what else stands there, where the take-up holds it
RETURN = ["return d", "return c", "snub", "return b", "return a"]
CARRY = ["carry a", "carry b", "carry c", "carry d"]
TAKE_UP_HEAD = {"kind": "gravity", "position": "head"}
WALKS: dict[str, tuple[dict[str, Any], list[str]]] = {
    "head drive": (
        {"route": {"take_up": TAKE_UP_HEAD}},
        ["cleaner", "bend", "held", *RETURN, "tail", "feeding", *CARRY, "head", "drive"],
    ),
    "tail drive, weight at the head": (
        {"drive": {"position": "tail"}, "route": {"take_up": TAKE_UP_HEAD}},
        ["cleaner", "bend", "held", *RETURN, "tail", "drive", "feeding", *CARRY, "head"],
    ),
    "tail drive, its own slack side": (
        {"drive": {"position": "tail"}},
        ["cleaner", *RETURN, "tail", "drive", "held", "bend", "feeding", *CARRY, "head"],
    ),
    "head drive, weight at the tail": (
        {"route": {"take_up": {"kind": "gravity", "position": "tail"}}},
        ["cleaner", *RETURN, "tail", "bend", "held", "feeding", *CARRY, "head", "drive"],
    ),
    "head and tail": (
        {"drive": {"further_drives": [TAIL_DRIVE]}, "route": {"take_up": TAKE_UP_HEAD}},
        ["cleaner", "bend", "held", *RETURN, "tail", "tail drive", "feeding", *CARRY, "head", "drive"],
    ),
    "booster, bulk lands right behind it": (
        {
            "drive": {"further_drives": [BOOSTER]},
            "route": {"take_up": TAKE_UP_HEAD, "feeding": ROUTE["feeding"] | {"section": "c"}},
        },
        ["cleaner", "bend", "held", *RETURN, "tail", *CARRY[:2], "booster", "feeding", *CARRY[2:], "head", "drive"],
    ),
    "plough before the booster, take-up behind it": (
        {
            "drive": {"further_drives": [BOOSTER]},
            "route": {
                "take_up": {"kind": "winch", "position": "carry", "section": "b"},
                "feeding": ROUTE["feeding"] | {"section": "c"},
                "ploughs": [{"width": "800 mm", "position": "carry", "section": "b"}],
            },
        },
        [
            "cleaner", *RETURN, "tail", *CARRY[:2], "plough", "booster", "bend", "held", "feeding", *CARRY[2:], "head",
            "drive",
        ],
    ),
    "drive on the return strand right before the tail": (
        {"drive": {"position": "return", "section": "a"}, "route": {"take_up": TAKE_UP_HEAD}},
        ["cleaner", "bend", "held", *RETURN, "drive", "tail", "feeding", *CARRY, "head"],
    ),
    "plough and drive before the head, drive at the head": (
        {
            "drive": {"further_drives": [BOOSTER | {"section": "d"}]},
            "route": {"take_up": TAKE_UP_HEAD, "ploughs": [{"width": "800 mm"}]},
        },
        [
            "cleaner", "bend", "held", *RETURN, "tail", "feeding", *CARRY, "booster", "plough", "head", "drive",
        ],
    ),
}  # fmt: skip
NAMES = {
    "cleaner": ("cleaner",),
    "feeding": ("acceleration of the bulk", "skirts"),
    "plough": ("plough",),
    "bend": ("wrap, bend", "bearings, bend"),
    "head": ("wrap, head", "bearings, head"),
    "tail": ("wrap, tail", "bearings, tail"),
    "snub": ("wrap, snub", "bearings, snub"),
}


def walk(met: list[str], found: Balance, taken: dict[str, float], state: MotionState) -> float:
    """Walk from the head back to it, held to the tensions reported on the way; returns what is left over [N]."""
    near = CLOSED * state.largest
    sides = {side.name: side for side in state.drives}
    stretches = [f"{s.strand} {s.section}" for s in found.line.loop.stretches]
    level = state.leaving
    for thing in met:
        if thing == "held":
            assert level == pytest.approx(state.held, abs=near), f"{state.name}: {thing}"
        elif thing in taken:
            assert level == pytest.approx(state.starts[stretches.index(thing)], abs=near), thing
            level += taken[thing]
            assert level == pytest.approx(state.ends[stretches.index(thing)], abs=near), thing
        elif thing in sides:
            assert level == pytest.approx(sides[thing].arriving, abs=near), thing
            level -= sides[thing].force
            assert level == pytest.approx(sides[thing].leaving, abs=near), thing
        else:
            level += math.fsum(s.total for s in found.singles if s.name.startswith(NAMES[thing]))
    return level - state.leaving


@pytest.mark.parametrize("name", list(WALKS))
def test_the_loop_walked_by_hand(name):
    changes, met = WALKS[name]
    conveyor = line(**changes)
    found = closed(conveyor)
    mass = {"carry": 12.0 / 1.2, "return": 9.0 / 3.0}  # of the rolls, per metre
    for state in (found.equilibrium.states["steady"], found.equilibrium.states["start"]):
        taken = {
            f"{s.strand} {s.section}": total + state.acceleration * s.length * (s.line_mass + mass[s.strand])
            for s, _, total in along(found)
        }
        assert walk(met, found, taken, state) == pytest.approx(0.0, abs=CLOSED * state.largest), state.name


# a short, level, heavily fed conveyor driven at its tail: nearly all its force is feeding
FED = copy.deepcopy(DATA) | {
    "belt": DATA["belt"] | {"width": "1200 mm", "speed": "5 m/s"},
    "material": DATA["material"] | {"flow": "3600 t/h"},
    "route": {
        "sections": [{"name": "all", "length": "60 m"}],
        "feeding": {"speed": "0 m/s", "skirt_length": "10 m", "skirt_width": "750 mm"},
    },
    "drive": {"position": "tail", "wrap_angle": "180 deg", "friction": 0.3, "efficiency": "94 %"},
}
for strand, width in (("carry", "465 mm"), ("return", "1400 mm")):
    FED["idlers"][strand] |= {"sag": "5 %", "roll": FED["idlers"][strand]["roll"] | {"length": width}}


def test_feeding_lies_behind_a_tail_drive():
    """14.3 kN behind the head look ample; the drive leaves the belt with a sixth of it, and slack at the start."""
    # 1000 kg/s to 5 m/s; skirts 0.7 Q_v² ρ g l/(v_m² b²) over the 2.55 m it takes at μ 0.5 and over 10 m beyond
    zone, beyond = (
        0.7 * 0.625**2 * 1600.0 * 9.81 * length / (speed**2 * 0.75**2)
        for length, speed in ((25.0 / (2 * 9.81 * 0.5), 2.5), (10.0, 5.0))
    )
    feeding = 5000.0 + zone + beyond
    assert feeding == pytest.approx(11.16e3, rel=1e-3)
    given = copy.deepcopy(FED)
    given["route"]["take_up"] = {"kind": "gravity", "position": "head", "tension": "14.3 kN"}
    given["calculation"] = {**given.get("calculation", {}), "not_given": "nothing"}
    conveyor = from_data(given)
    found = closed(conveyor, 0.003)
    carry, back = (r.total for r in along(found))
    whole = carry + back + feeding
    (steady,), (start,) = found.equilibrium.steady.drives, found.equilibrium.states["start"].drives
    assert steady.force == pytest.approx(whole, rel=1e-12)
    assert steady.arriving == pytest.approx(14.3e3 + back, rel=1e-12)
    assert steady.leaving == pytest.approx(14.3e3 + back - whole, rel=1e-12)
    assert steady.tight / steady.slack > math.exp(0.3 * math.pi)
    assert start.leaving < 0.0
    short = {name for name, asked in found.equilibrium.conditions.items() if asked > 14.3e3}
    assert short == {"grip, drive, steady", "grip, drive, start"}
    # carry starts with the feeding added
    assert found.equilibrium.steady.starts[1] == pytest.approx(steady.leaving + feeding, rel=1e-12)


SNUB = {
    "name": "beside",
    "diameter": "630 mm",
    "shaft_diameter": "120 mm",
    "mass": "0.5 t",
    "wrap_angle": "30 deg",
}


@pytest.mark.parametrize(("position", "driven"), [("head", "head"), ("tail", "tail")])
def test_only_the_driven_pulley_leaves_its_bearings_to_the_drive(position, driven):
    """A snub beside it turns in bearings of its own, on the return strand."""
    route = {
        "pulleys": [SNUB | {"position": position}, *ROUTE["pulleys"][:3]],
        "take_up": {"kind": "gravity", "position": "return", "section": "c"},
    }
    conveyor = line(route=route, drive={"position": position})
    found = closed(conveyor)
    with_bearings = {s.name.removeprefix("bearings, ") for s in found.singles if s.name.startswith("bearings")}
    assert with_bearings == {"beside", "head", "bend", "tail"} - {driven}
    # 0.005 d0/D over the vector sum of the belt's tensions and the weight, where the return strand meets it
    (side,) = found.equilibrium.steady.drives
    tension = side.leaving if position == "head" else found.equilibrium.steady.ends[3]
    load = math.hypot(2.0 * tension * math.sin(math.radians(15.0)), 500.0 * 9.81)
    force = next(s.total for s in found.singles if s.name == "bearings, beside")
    assert force == pytest.approx(0.005 * 120.0 / 630.0 * load, rel=1e-9)


def test_a_drive_of_two_wraps_turns_two_pulleys_and_never_a_snub():
    twice = [SNUB | {"position": "head"}, ROUTE["pulleys"][0], ROUTE["pulleys"][0] | {"name": "second"}]
    conveyor = line(route={"pulleys": twice}, drive={"wrap_angle": "400 deg"})
    found = closed(conveyor)
    assert [s.name for s in found.singles if s.name.startswith("bearings")] == ["bearings, beside"]


def test_a_take_up_on_the_slack_side_stays_there_when_the_brake_is_on():
    """Behind a head drive the belt before it goes down by all the brake's force; the take-up does not change sides."""
    weight = {"take_up": {"kind": "gravity", "position": "drive", "tension": "60 kN"}}
    conveyor = line(route=weight, drive={"brake_force": "20 kN"})
    found = closed(conveyor)
    (side,) = found.equilibrium.states["brakes on"].drives
    assert side.leaving == pytest.approx(60e3, rel=1e-12)
    assert side.arriving == pytest.approx(40e3, rel=1e-12)
    grip = 20e3 / math.expm1(0.35 * math.radians(200.0))
    assert found.equilibrium.conditions["grip, drive, brakes on"] == pytest.approx(20e3 + grip, rel=1e-12)


def test_cleaners_are_said_to_stand_at_the_head():
    """They scrape behind it; which strand that is depends on the drives."""
    found = closed(line())
    assert {s.place for s in found.singles if s.name.startswith("cleaner")} == {"head"}
