"""The steepest loaded section against what the bulk is carried on; starts on plates of unknown friction at rest."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from conveyor.checks.bulk_checks import belt_filling, bulk_slope
from conveyor.checks.drive_checks import starting_force
from conveyor.errors import NoSolutionError
from conveyor.pipeline import calculate
from conveyor.sizing.design_search import size_conveyor
from conveyor.spec import load
from conveyor.studies.study_file import read_duty
from tests.command_line import ROOT
from tests.loop.loop_lines import DATA
from tests.loop.test_pulley_duty import calculated

SPECS = ROOT / "examples" / "specs"


def climbing(degrees, *, loaded=True, material=None):
    length, last = 200.0, {"name": "top", "length": "100 m"}
    steep = {"name": "steep", "length": f"{length} m", "lift": f"{length * math.sin(math.radians(degrees))} m",
             "loaded": loaded}  # fmt: skip
    route = DATA["route"] | {"sections": [steep, last], "pulleys": DATA["route"]["pulleys"][:3]}
    return calculated(route=route, material=DATA["material"] | (material or {}))


@pytest.mark.parametrize(("degrees", "verdict"), [(17.9, "pass"), (18.1, "FAIL"), (-18.1, "FAIL")])
def test_bulk_of_which_nothing_is_known_is_carried_on_eighteen_degrees(degrees, verdict):
    (check,) = bulk_slope(climbing(degrees))
    assert check.calculated == pytest.approx(math.radians(abs(degrees)), rel=1e-9)
    assert (check.verdict, check.where) == (verdict, "steep")


def test_what_the_spec_says_of_the_bulk_goes_before():
    (check,) = bulk_slope(climbing(19.5, material={"max_slope": "20 deg"}))
    assert (check.verdict, check.required) == ("pass", pytest.approx(math.radians(20.0), rel=1e-12))
    assert check.asked.text() == "at most 20° (material.max_slope)"
    (check,) = bulk_slope(climbing(15.0, material={"max_slope": "12 deg"}))
    assert check.failed


def test_a_steep_section_without_bulk_is_none_of_it():
    (check,) = bulk_slope(climbing(25.0, loaded=False))
    assert (check.calculated, check.where) == (0.0, "top")


def test_a_pipe_is_steeper():
    (check,) = bulk_slope(calculate(load(SPECS / "pipe_curved.yaml")))
    assert check.required == pytest.approx(math.radians(27.0), rel=1e-12)


def test_check_and_advice_tell_one_filling():
    """By hand: twice the flow that just fills the slope."""
    (full,) = belt_filling(climbing(10.0))
    share = 1.2 * full.required / full.calculated
    flow = f"{1200.0 * share} t/h"
    (check,) = belt_filling(climbing(10.0, material={"flow": flow}))
    assert "120 % of the cross-section on its slope" in check.found.text()
    assert "120 % of the" in check.why.text()


def test_sizing_refuses_a_route_too_steep_for_its_bulk():
    duty = read_duty(ROOT / "examples" / "duties" / "overland.yaml")
    given = duty.as_data()
    steep = type(duty).from_data(
        given | {"route": given["route"] | {"sections": [{"name": "steep", "length": "100 m", "lift": "33 m"}]}}
    )
    with pytest.raises(NoSolutionError, match=r"slopes by 19\.3°, the bulk is carried on 18° at most"):
        size_conveyor(steep)


def test_a_start_on_a_plate_is_not_checked():
    found = calculate(load(SPECS / "slider.yaml"))
    (check,) = (one for one in starting_force(found) if one.key == "breakaway")
    assert (check.verdict, check.why) == ("not checked", None)
    assert "at rest on the plate, which is not calculated" in check.asked.text()
    short = replace(found, start_of_motors=0.5 * check.calculated)
    (check,) = (one for one in starting_force(short) if one.key == "breakaway")
    assert check.failed
