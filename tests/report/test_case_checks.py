"""Checks of the load cases against the cases themselves: the governing one is named and judged."""

from __future__ import annotations

from pathlib import Path

import pytest

import conveyor
from conveyor.analysis import CaseStudy, Studies, analyse_cases
from conveyor.units import display
from tests.report.checking import Told, case_checks, checks

SPEC = Path(__file__).parents[2] / "examples" / "specs" / "overland.yaml"
CASES = [{"name": "full", "temperatures": ["-20 degC", "20 degC"]}]


def study(**changes: object) -> CaseStudy:
    line = conveyor.load(SPEC)
    drive = line.drive.as_data() | {key: changes.pop(key) for key in ("installed_power",) if key in changes}
    return analyse_cases(line.replace(cases=CASES, drive=drive, **changes), rtol=1e-4)


def only(found: list[Told], words: str) -> Told:
    (one,) = [check for check in found if words in check.subject]
    return one


@pytest.fixture(scope="module")
def plain() -> CaseStudy:
    return study()


def test_the_coldest_case_is_named(plain: CaseStudy) -> None:
    most = max(plain.results, key=lambda result: result.motors[1])
    motor = only(list(case_checks(plain, "SI")), "motor power")
    assert display(most.temperature, "temperature").removesuffix(" degC") in motor.subject
    assert motor.found == f"{most.motors[1] / 1e3:,.0f} kW" or motor.found.startswith(
        f"{most.motors[1] / 1e3:,.4g}"[:3]
    )


def test_motors_between_the_cases_fail_only_with_the_cases(plain: CaseStudy) -> None:
    """Installed: more than the spec's own state needs, less than the coldest case."""
    needed = max(result.motors[1] for result in plain.results)
    own = conveyor.analyse(plain.conveyor).balance.power.motor
    assert own < needed
    short = study(installed_power=f"{0.5 * (own + needed) / 1e3:.3f} kW")
    result = conveyor.analyse(short.conveyor)
    assert only(list(checks(result)), "motor power").verdict == "pass"
    with_cases = [c for c in checks(result, "SI", Studies(cases=short)) if "motor power" in c.subject]
    assert [check.verdict for check in with_cases] == ["pass", "FAIL"]
    enough = study(installed_power=f"{1.001 * needed / 1e3:.3f} kW")
    assert only(list(case_checks(enough, "SI")), "motor power").verdict == "pass"


def test_a_weight_for_one_temperature_fails_at_another(plain: CaseStudy) -> None:
    least, most = sorted(result.found.balance.settled.needed for result in plain.results)
    assert least < most
    for tension, verdict in ((0.5 * (least + most), "FAIL"), (1.001 * most, "pass")):
        route = plain.conveyor.route.as_data()
        route["take_up"] = {"kind": "gravity", "tension": f"{tension:.1f} N"}
        assert only(list(case_checks(study(route=route), "SI")), "take-up").verdict == verdict


def test_a_take_up_set_anew_in_each_case_is_not_a_pass(plain: CaseStudy) -> None:
    assert only(list(case_checks(plain, "SI")), "take-up").verdict == "not checked"


def test_safety_is_the_least_of_all_cases(plain: CaseStudy) -> None:
    line = plain.conveyor
    strength = line.belt.carcass.strength.to("N/m").magnitude * line.belt.width.to("m").magnitude
    least = min(
        strength / max(point.tension for point in result.found.balance.points) for result in plain.results
    )
    assert only(list(case_checks(plain, "SI")), "safety").found == f"{least:.2f}"


def test_refused_cases_are_told() -> None:
    line = conveyor.load(SPEC)
    cold = [{"name": "full", "temperatures": ["20 degC"]}, {"name": "arctic", "temperatures": ["-90 degC"]}]
    found = list(case_checks(analyse_cases(line.replace(cases=cold), rtol=1e-4), "US"))
    answers = only(found, "answers")
    assert (answers.found, answers.verdict) == ("1 of 2", "FAIL")
    assert any("68 °F" in check.subject for check in found)
