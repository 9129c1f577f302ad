"""A conveyor that runs the other way is the one that is written from its other end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.models import LoadCase
from conveyor.models.reversal import with_direction_reversed
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate
from conveyor.results.analysis import analyse_studies
from conveyor.units import si
from tests.loop.loop_lines import BOOSTER, data

SPEC = Path(__file__).parents[2] / "examples" / "specs" / "reversible.yaml"
BACK = LoadCase(name="back", reversed=True)
SAME = 1e-9
"""Sums of forces in another order."""
PULLEY = {"diameter": "630 mm", "shaft_diameter": "120 mm", "mass": "0.5 t", "wrap_angle": "20 deg"}


def parts(**changes: Any) -> dict[str, dict[str, Any]]:
    """Route and drive of a line of four sections with everything that reverses, written from the tail."""
    route = {
        "feeding": {"section": "c", "skirt_length": "4 m", "skirt_width": "600 mm"},
        "take_up": {"kind": "gravity", "position": "return", "section": "b", "tension": "60 kN"},
        "pulleys": [
            {"name": "head", "position": "head"} | PULLEY | {"wrap_angle": "180 deg"},
            {"name": "snub", "position": "return", "section": "c"} | PULLEY,
            {"name": "tail", "position": "tail"} | PULLEY | {"wrap_angle": "170 deg"},
            {"name": "hold-down", "position": "carry", "section": "b"} | PULLEY,
        ],
        "head_transition": {"length": "4 m"},
    }
    return {"route": route | changes, "drive": {"further_drives": [BOOSTER], "brake_force": "30 kN"}}


def mirrored() -> dict[str, dict[str, Any]]:
    """The same by hand: behind b is now behind c on the carry strand, behind a on the return strand."""
    sections = [
        {"name": "d", "length": "180 m", "lift": "-6 m"}, {"name": "c", "length": "300 m", "lift": "8 m"},
        {"name": "b", "length": "400 m", "lift": "-25 m"}, {"name": "a", "length": "120 m"},
    ]  # fmt: skip
    given = parts(sections=sections)
    route = given["route"] | {
        "feeding": given["route"]["feeding"] | {"section": "b"},
        "take_up": given["route"]["take_up"] | {"section": "a"},
        "tail_transition": {"length": "4 m"},
    }
    del route["head_transition"]
    head, snub, tail, down = route["pulleys"]
    route["pulleys"] = [down | {"section": "c"}, tail | {"position": "head"}, snub | {"section": "b"},
                        head | {"position": "tail"}]  # fmt: skip
    drive = given["drive"] | {"position": "tail", "further_drives": [BOOSTER | {"section": "c"}]}
    return {"route": route, "drive": drive}


def test_it_is_the_one_written_from_the_other_end():
    given = conveyor.spec.from_data(data(**parts()))
    by_hand, turned = conveyor.spec.from_data(data(**mirrored())), with_direction_reversed(given)
    assert turned.route == by_hand.route
    assert turned.drive == by_hand.drive


def test_twice_is_the_spec():
    given = conveyor.load(SPEC)
    assert with_direction_reversed(with_direction_reversed(given)) == given
    curved = given.replace(
        route=given.route.replace(
            sections=[
                given.route.sections[0].replace(horizontal_curve="left", horizontal_radius="400 m"),
                given.route.sections[1].replace(lift=None, slope="1 deg", curve="concave", curve_radius="300 m"),
            ]
        )
    )
    turned = with_direction_reversed(curved)
    assert [section.rise for section in turned.route.sections] == pytest.approx(
        [-section.rise for section in reversed(curved.route.sections)]
    )
    assert turned.route.sections[1].horizontal_curve == "right"
    assert with_direction_reversed(turned) == curved


def test_lift_and_bulk_by_hand():
    """Fed in the middle, the bulk rises by 0.6 m either way; what it costs is that of its own section."""
    given = conveyor.load(SPEC)
    back = calculate(with_case(given, BACK))
    forth = calculate(given)
    line_mass = si(given.material.flow) / si(given.belt.speed)
    for one in (forth, back):
        assert one.balance.forces.lift == pytest.approx(line_mass * 9.81 * 0.6, rel=SAME)
    assert [stretch.section for stretch in back.line.stretches[:2]] == ["east", "west"]
    assert [stretch.bulk_mass > 0.0 for stretch in back.line.stretches[:2]] == [False, True]
    (drive,) = back.balance.equilibrium.steady.drives
    # the drive is at the tail now: it pulls the return strand and the take-up stands at the slack carry strand's end
    assert back.line.drives[0].spot.boundary != forth.line.drives[0].spot.boundary
    assert drive.force == pytest.approx(back.balance.equilibrium.force, rel=SAME)


def test_cases_are_checked_both_ways_at_one_take_up():
    given = conveyor.load(SPEC)
    found = conveyor.analyse(given)
    made = found.to_dict(analyse_studies(given, found))
    rows = {row["case"]: row for row in made["load_cases"]["cases"]}
    assert rows["to the west"]["loading"] == "as given, reversed"
    governs = {check["key"]: check["case"] for check in made["checks"] if check["governs"]}
    assert governs["take_up_tension"].startswith("to the west")
    assert all(check["verdict"] != "fail" for check in made["checks"])
    # states are those of the spec's direction, not what runs the other way
    assert made["states"]["full"]["power_kW"]["motor"] == pytest.approx(made["power_kW"]["motor"], rel=1e-6)


@pytest.mark.parametrize(
    ("route", "drive", "idlers", "says"),
    [
        ({"feeding": {"skirt_length": "2 m", "skirt_width": "600 mm"}}, {}, {}, "at the tail the bulk would leave"),
        ({"take_up": {"kind": "gravity"}}, {}, {}, "say where the take-up stands"),
        ({"ploughs": [{"width": "800 mm"}]}, {}, {}, "sweeps in one direction only"),
        ({}, {"backstop": True}, {}, "give a brake"),
        ({}, {"backstop_torque": "20 kN*m"}, {}, "drive.backstop_torque"),
        ({}, {"further_drives": [{"name": "second", "wrap_angle": "180 deg", "friction": 0.3,
                                  "installed_power": "100 kW"}]}, {}, "give both as one drive"),
        ({}, {}, {"tilt_angle": "2 deg"}, "idlers.carry.tilt_angle"),
    ],
)  # fmt: skip
def test_what_works_one_way_only_is_refused(route, drive, idlers, says):
    given = data(**parts(**route))
    given["drive"] |= drive
    given["idlers"]["carry"] |= idlers
    one_way = conveyor.spec.from_data(given)
    with pytest.raises(InputError, match=says.replace(".", r"\.")):
        with_direction_reversed(one_way)
    with pytest.raises(InputError, match=r"cases\[0\] is reversed"):
        conveyor.spec.from_data(given | {"cases": [{"name": "back", "reversed": True}]})
