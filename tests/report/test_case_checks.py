"""Every criterion in every load case: the very functions that check a conveyor, and the case that governs."""

from __future__ import annotations

import math
from itertools import groupby
from pathlib import Path

import pytest

import conveyor
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import Check, check_against_limit, governing_by_criterion, governing_by_subject, run_checks
from conveyor.models.fields import with_fields
from conveyor.models.variants import with_case, with_temperature
from conveyor.pipeline import calculate
from conveyor.report.tables.design_verdict import verdict_sentence
from conveyor.results.analysis import Analysis, CaseStudy, Studies, analyse_cases
from conveyor.studies.loads import every_load
from conveyor.units import quantity
from conveyor.units.sentences import message, percent

SPEC = Path(__file__).parents[2] / "examples" / "specs" / "overland.yaml"
CASES = [
    {"name": "full", "temperatures": ["-20 degC", "20 degC"]},
    {"name": "empty", "loading": "empty", "temperatures": ["-20 degC"]},
]


def study(**changes: object) -> CaseStudy:
    line = conveyor.load(SPEC)
    drive = line.drive.as_data() | {key: changes.pop(key) for key in ("installed_power",) if key in changes}
    return analyse_cases(line.replace(cases=CASES, drive=drive, **changes), rtol=1e-4)


@pytest.fixture(scope="module")
def plain() -> CaseStudy:
    return study()


def told(result: CalculatedConveyor) -> tuple[str, float]:
    """The sentence about what passes, and the least margin of that."""
    passed = [check for check in run_checks(result) if check.verdict == "pass"]
    return verdict_sentence(passed, "SI"), min(check.margin for check in passed if check.margin is not None)


def governing(found: CaseStudy, key: str, subject: str = "") -> Check:
    (one,) = [
        check for check in governing_by_subject(found.checks) if check.key == key and subject in check.subject.text()
    ]
    return one


def case_of(check: Check) -> str:
    assert check.case is not None
    return check.case.words


def test_a_case_is_checked_as_its_conveyor_alone(plain: CaseStudy) -> None:
    """Calculated by itself, loaded and at the temperature of the case, the take-up given: the same figures."""
    route = plain.conveyor.route.as_data() | {"take_up": {"kind": "gravity", "tension": "80 kN"}}
    given = study(route=route)
    result = next(r for r in given.results if r.case.loading == "empty")
    alone = calculate(with_temperature(with_case(given.conveyor, result.case), quantity("-20 degC")))
    expected = run_checks(alone)
    assert [(c.key, c.subject, c.verdict) for c in result.checks] == [(c.key, c.subject, c.verdict) for c in expected]
    for mine, other in zip(result.checks, expected, strict=True):
        assert mine.case is not None
        assert mine.case.text() == "empty, -20 °C"
        assert other.case is None
        if other.calculated is not None:  # rtol of both contacts, of tensions that cancel to some part
            assert mine.calculated == pytest.approx(other.calculated, rel=1e-2)


def test_every_case_has_every_criterion(plain: CaseStudy) -> None:
    own = {check.key for check in run_checks(calculate(plain.conveyor))}
    of_bulk = {"filling", "bulk_slope", "holding_brake", "bulk_slip_start", "bulk_slip_stopping"}
    for case, of in groupby(plain.checks, key=case_of):
        assert {check.key for check in of} == (own - of_bulk if case.startswith("empty") else own)


@pytest.mark.parametrize(
    ("calculated", "relation", "required", "margin", "use"),
    [
        (120.0, "at least", 100.0, 0.2, 100.0 / 120.0),
        (90.0, "at least", 100.0, -0.1, 100.0 / 90.0),
        (90.0, "at most", 100.0, 0.1, 0.9),
        (150.0, "at most", 100.0, -0.5, 1.5),
        (-5.0, "at least", -10.0, 0.5, 2.0),
        (0.0, "at least", 100.0, -1.0, None),
        (5.0, "at least", 0.0, None, None),
        (5.0, "at least", None, None, None),
        (None, "at least", 5.0, None, None),
    ],
)
def test_the_margin_is_what_is_left_over_the_limit(calculated, relation, required, margin, use) -> None:
    one = Check("k", message("s"), calculated, required, "force", message(""), message(""), "pass", None, relation)
    assert one.margin == (None if margin is None else pytest.approx(margin, rel=1e-12))
    assert one.use == (None if use is None else pytest.approx(use, rel=1e-12))


def made(case: str, verdict: str, calculated: float | None, subject: str = "s", key: str = "k") -> Check:
    return Check(key, message(subject), calculated, 1.0, "force", message(""), message(""), verdict, case=message(case))


def test_a_margin_of_many_times_the_limit_is_told_as_more_than_all_of_it() -> None:
    """49 times more strength than asked: beyond 100 % a margin says no more than that it is large."""
    large = check_against_limit("belt_safety", "belt safety", 50.0, "at least", 1.0, "safety")
    assert large.margin == pytest.approx(49.0)
    assert "; least margin > 100 %, belt safety" in verdict_sentence([large], "SI")
    small = check_against_limit("belt_safety", "belt safety", 1.046, "at least", 1.0, "safety")
    assert "; least margin 4.6 %, belt safety" in verdict_sentence([large, small], "SI")


def test_a_failure_governs_then_the_least_margin_then_the_first() -> None:
    every = [
        made("a", "pass", 1.2), made("b", "pass", 1.1), made("c", "pass", 1.1), made("d", "not checked", 0.1),
    ]  # fmt: skip
    assert [case_of(one) for one in governing_by_subject(every)] == ["b"]
    assert [case_of(one) for one in governing_by_subject([*every, made("e", "FAIL", 0.9)])] == ["e"]
    assert [
        case_of(one) for one in governing_by_subject([*every, made("e", "FAIL", 0.9), made("f", "FAIL", None)])
    ] == ["f"]


def test_of_a_limit_at_zero_the_lowest_governs() -> None:
    slack = [
        Check("k", message("s"), tension, 0.0, "force", message(""), message(""), "FAIL", case=message(name))
        for name, tension in (("a", -10.0), ("b", -30.0), ("c", -20.0))
    ]
    assert [case_of(one) for one in governing_by_subject(slack)] == ["b"]


def test_a_limit_of_zero_that_any_figure_meets_does_not_govern() -> None:
    """Skirtboards of 2.5 m: 0.64 m are asked of the loaded belt, nothing of a state without bulk there."""
    boards = [
        Check("k", message("s"), 2.5, required, "length", message(""), message(""), "pass", case=message(name))
        for name, required in (("empty", 0.0), ("full", 0.637))
    ]
    assert [case_of(one) for one in governing_by_subject(boards)] == ["full"]


def test_subjects_govern_one_by_one_criteria_by_the_worst_of_them() -> None:
    every = [
        made("a", "pass", 1.5, "left"), made("a", "pass", 1.4, "right"), made("a", "pass", 3.0, key="other"),
        made("b", "pass", 1.3, "left"), made("b", "pass", 1.6, "right"),
    ]  # fmt: skip
    governs = governing_by_subject(every)
    assert [(one.subject.words, case_of(one)) for one in governs] == [
        ("left", "b"),
        ("right", "a"),
        ("s", "a"),
    ]
    assert [one.subject.words for one in governing_by_criterion(governs)] == ["left", "s"]


def test_motors_between_the_cases_fail_only_with_the_cases(plain: CaseStudy) -> None:
    """Installed: more than the spec's own state needs, less than the coldest case."""
    needed = max(result.motors[1] for result in plain.results)
    own = conveyor.analyse(plain.conveyor).balance.power.motor
    assert own < needed
    short = study(installed_power=f"{0.5 * (own + needed) / 1e3:.3f} kW")
    assert next(c for c in run_checks(calculate(short.conveyor)) if c.key == "motor_power").verdict == "pass"
    failed = governing(short, "motor_power")
    assert (failed.verdict, failed.case.text()) == ("FAIL", "full, -20 °C")
    assert failed.calculated == pytest.approx(needed, rel=1e-9)
    enough = study(installed_power=f"{1.001 * needed / 1e3:.6f} kW")
    assert governing(enough, "motor_power").verdict == "pass"
    assert governing(enough, "motor_power").margin == pytest.approx(1.0 - 1.0 / 1.001, rel=1e-3)


def test_a_weight_for_one_temperature_fails_at_another(plain: CaseStudy) -> None:
    least, *_, most = sorted(result.found.balance.equilibrium.needed for result in plain.results)
    assert least < most
    for tension, verdict in ((0.5 * (least + most), "FAIL"), (1.001 * most, "pass")):
        route = plain.conveyor.route.as_data()
        route["take_up"] = {"kind": "gravity", "tension": f"{tension:.1f} N"}
        assert governing(study(route=route), "take_up_tension").verdict == verdict


def test_safety_is_the_least_of_all_cases(plain: CaseStudy) -> None:
    line = plain.conveyor
    strength = line.belt.carcass.strength.to("N/m").magnitude * line.belt.width.to("m").magnitude
    running = [state for result in plain.results for state in result.found.balance.equilibrium.running]
    least = min(strength / state.largest for state in running)
    assert {state.name for state in running} == {"steady", "design friction"}
    assert governing(plain, "belt_safety", "steady").calculated == pytest.approx(least, rel=1e-12)


def test_grip_is_checked_on_every_drive_in_every_state(plain: CaseStudy) -> None:
    """By Eytelwein: T2 (e^(μα) - 1) is what the drive gives."""
    for result in plain.results:
        drive = result.found.line.drives[0]
        grown = math.expm1(drive.friction * drive.wrap_angle)
        for check in (check for check in result.checks if check.key == "drive_grip"):
            name = check.subject.text().removeprefix(f"grip of {drive.name}, ")
            states = result.found.balance.equilibrium.states | result.found.motions.states
            side = states[name].drives[0]
            assert check.calculated == pytest.approx(side.slack, rel=1e-12)
            assert check.required * grown == pytest.approx(abs(side.force), rel=1e-9, abs=1e-9)
    grips = [c.subject.text().removeprefix("grip of drive, ") for c in plain.results[0].checks if c.key == "drive_grip"]
    assert {"steady", "start", "design friction", "start, design friction", "drives off"} <= set(grips)
    assert len(grips) == len(set(grips))


def test_a_take_up_at_its_least_leaves_no_margin_to_what_governs(plain: CaseStudy) -> None:
    """The least setting is that at which one drive's grip or one section's sag is just met."""
    alone = run_checks(calculate(plain.conveyor))
    least = min(c.margin for c in alone if c.key in {"drive_grip", "sag"} and c.margin is not None)
    assert least == pytest.approx(0.0, abs=1e-8)
    assert not any(c.failed for c in alone if c.key in {"drive_grip", "sag", "take_up_tension"})


def test_the_least_margin_told_is_the_least_there_is_where_the_take_up_has_one(plain: CaseStudy) -> None:
    """A least setting is told as such; with more than that, grip, sag and setting count like any other criterion."""
    given = plain.conveyor.replace(cases=[])
    settled = calculate(given)
    assert "; the take-up holds the least that grip and sag ask for; otherwise least margin" in told(settled)[0]
    unit = {"kind": "gravity", "tension": f"{1.001 * settled.balance.equilibrium.needed:.9g} N"}
    words, least = told(calculate(with_fields(given, {"route.take_up": unit})))
    assert f"are met; least margin {percent(least, 1)}, " in words


# what the rubber's data do not cover --------------------------------------------------------------------------------

COLD = [{"name": "winter", "temperatures": ["-90 degC", "-25 degC", "-5 degC", "20 degC"]}]


@pytest.fixture(scope="module")
def cold() -> tuple[Analysis, CaseStudy]:
    """A measured compound whose data end at a few hundred hertz at -25 °C, and that is not known at -90 °C."""
    line = conveyor.load(SPEC)
    cover = line.belt.bottom_cover.replace(compound=conveyor.shelf.compound("s100"))
    drive = line.drive.replace(design_friction="100 %")  # the cold alone decides
    given = line.replace(belt=line.belt.replace(bottom_cover=cover), drive=drive, cases=COLD)
    return conveyor.analyse(given), analyse_cases(given, rtol=1e-4)


def test_a_case_the_data_do_not_cover_says_so_and_governs_nothing(cold: tuple[Analysis, CaseStudy]) -> None:
    _, found = cold
    beyond, *others = found.results
    assert [result.covered for result in found.results] == [False, True, True]
    told = [check for check in beyond.checks if check.key == "rubber_coverage"]
    assert told[0].failed
    band, data = (
        beyond.found.contacts.excited_band("carry"),
        found.conveyor.carry_compound.frequencies(248.15),
    )
    assert data[1] < band[1]
    assert (told[0].calculated, told[0].required) == (
        pytest.approx(band[1]),
        pytest.approx(data[1], rel=1e-9),
    )
    others_of_it = [check for check in beyond.checks if check.key != "rubber_coverage"]
    assert {check.verdict for check in others_of_it} == {"not checked"}
    assert all("do not cover the case" in check.why.text() for check in others_of_it)
    assert {row.result for row in found.governing} <= set(others)
    assert "-25 °C" not in found.motors()[0].case.text()
    assert governing(found, "rubber_coverage", "carry").case.text() == "winter, -25 °C"


def test_the_take_up_and_the_pulleys_are_sized_without_a_case_that_the_data_do_not_cover(
    cold: tuple[Analysis, CaseStudy],
) -> None:
    given, found = cold
    beyond, *others = found.results
    settled = beyond.found.balance.equilibrium
    assert settled.needed > 1.01 * settled.setting
    needed = max(one.found.balance.equilibrium.needed for one in others)
    assert settled.setting == pytest.approx(needed, rel=1e-9)
    assert found.take_up.needed == pytest.approx(needed, rel=1e-9)
    assert found.take_up.warmth == pytest.approx(45.0)  # its cold is no figure of the rubber
    both = every_load(found.conveyor)
    assert both.cases is not None
    assert both.take_up == pytest.approx(both.cases.results[0].found.balance.equilibrium.setting, rel=1e-12)
    asked = max(load.balance.equilibrium.needed for load in both.designing)  # by a load state at -5 °C
    assert needed < both.take_up == pytest.approx(asked, rel=1e-9)
    assert beyond.temperature not in {load.temperature for load in both.designing}
    contents = given.contents(Studies(cases=found)).by_key
    largest = max(row[2].largest.resultant for row in contents["pulley_loads"].rows)
    loads = [load.largest.resultant for one in others for load in one.found.pulley_duty]
    assert largest == pytest.approx(max(loads), rel=1e-9)
    assert {row[1] for row in contents["pulley_states"].rows} == {
        "as given",
        "winter, -5 °C",
        "winter, 20 °C",
    }


def test_a_case_without_an_answer_is_a_failure_that_says_why(cold: tuple[Analysis, CaseStudy]) -> None:
    failed = governing(cold[1], "case_answer")
    assert (failed.verdict, failed.case.text()) == ("FAIL", "winter, -90 °C")
    assert failed.found.text() == "1 of 4 cases could not be calculated"
    assert "is known from" in failed.why.text()


def test_reports_say_what_is_not_to_design_by(cold: tuple[Analysis, CaseStudy]) -> None:
    contents = cold[0].contents(Studies(cases=cold[1]))
    assert contents["load_cases"].frame()["covered"].tolist() == ["NO", "yes", "yes"]
    assert "winter, -25 °C" in contents["governing_cases"].note
    rows = {row.subject: row for row in contents["checks"].rows}
    assert rows["rubber data over the excitation band, carry"].case == "winter, -25 °C; other loadings not searched"
    assert any(line.startswith("winter, -90 °C: ") for line in contents.lines("warning"))
    kept = contents["case_checks"].frame()
    assert set(kept[kept["case"] == "winter, -25 °C"]["verdict"]) == {"FAIL", "not checked"}
