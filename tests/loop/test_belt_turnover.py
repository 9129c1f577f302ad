"""Turnovers of the return strand: their length."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor.checks.belt_checks import belt_turnover
from conveyor.errors import InputError
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from conveyor.spec import load
from conveyor.units import si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
TURNED = {"route.turned_over": True}


@pytest.fixture(scope="module")
def textile():
    return load(SPECS / "in_plant_us.yaml")  # 48 in, rated


def turnover(line, **changes):
    (check,) = belt_turnover(calculate(with_fields(line, TURNED | changes)))
    return check


@pytest.mark.parametrize(("length", "verdict"), [("48.1 ft", "pass"), ("47.9 ft", "FAIL")])
def test_a_foot_an_inch_of_width(textile, length, verdict):
    check = turnover(textile, **{"route.turnover_length": length})
    assert check.verdict == verdict
    assert check.required == pytest.approx(48 * 0.3048, rel=1e-12)
    assert "ask the belt's maker" in check.why.text()


def test_without_a_length_it_is_not_checked(textile):
    check = turnover(textile)
    assert (check.verdict, check.found.text()) == ("not checked", "turnover_length not given")
    assert check.required == pytest.approx(48 * 0.3048, rel=1e-12)


def test_no_rule_is_known_for_steel_cord():
    steel = load(SPECS / "weighed.yaml")
    check = turnover(steel)
    assert (check.verdict, check.calculated) == ("not checked", 26.0)
    assert check.asked.text() == "no rule for steel cord, ask the belt's maker"
    short = turnover(steel, **{"route.turnover_length": "2 m"})
    assert (short.verdict, short.required) == ("FAIL", pytest.approx(12 * si(steel.belt.width), rel=1e-12))
    bare = with_fields(steel, {"route.turnover_length": None})
    (check,) = belt_turnover(calculate(bare))
    assert check.asked.text() == "that of the belt's maker"


def test_a_belt_that_is_not_turned_over_has_none(textile):
    assert list(belt_turnover(calculate(textile))) == []
    with pytest.raises(InputError, match=r"route\.turnover_length: goes with turned_over: true"):
        with_fields(textile, {"route.turnover_length": "20 m"})
