"""Factors from measured power: known ones come back; what the runs do not tell apart is one factor."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import conveyor
from conveyor.calculated_conveyor import CalculatedConveyor, NoAnswer, Variant
from conveyor.errors import InputError
from conveyor.models import Calibration, Conveyor, MeasuredRun
from conveyor.models.variants import with_runs
from conveyor.pipeline import calculate, calculate_many
from conveyor.spec import dump, from_data
from conveyor.studies.factor_fit import Grouping, SolvedRuns, _Fit, free_factors, select_grouping
from conveyor.units import from_si
from tests.loop.loop_lines import DOWN, data, line

QUICK = {"rtol": 1e-4, "strain": "off", "flexure_share": "11 %"}
BY_LAW = {"rtol": 1e-4, "strain": "off", "flexure": {"belt": {"loss_tangent": 0.2}}}
EMPTY_AND_FULL = [(flow, warmth) for flow in (0, 600, 1200) for warmth in (0, 15, 30)]
TRAIN = [{"name": "gear", "efficiency": "94 %"}, {"name": "motor", "efficiency": "95 %", "side": "mains"}]


def with_factors(given: Conveyor, **factors: float) -> Conveyor:
    return given.replace(calculation=given.calculation.replace(calibration=Calibration(**factors)))


def states(*flow_and_warmth: tuple[float, float], at: str = "motor shaft") -> list[MeasuredRun]:
    return [
        MeasuredRun.from_data({"power": "1 kW", "at": at, "flow": f"{flow} t/h", "temperature": f"{warmth} degC"})
        for flow, warmth in flow_and_warmth
    ]


def measured(truth: Conveyor, runs: list[MeasuredRun], noise: float = 0.0, seed: int = 0) -> list[MeasuredRun]:
    """Runs with the power that a conveyor takes, and a share of noise."""
    rng = np.random.default_rng(seed)
    made = []
    for run, found in zip(runs, calculate_many(list(map(Variant, with_runs(truth, runs)))), strict=True):
        assert isinstance(found, CalculatedConveyor)
        power = found.balance.power
        watts = power.mains if run.at == "mains" else power.motor
        made.append(run.replace(power=from_si(watts * (1.0 + noise * rng.standard_normal()), "power")))
    return made


def test_a_factor_scales_its_force_and_no_other():
    plain = calculate(line(calculation=BY_LAW)).balance.forces.parts
    double = calculate(with_factors(line(calculation=BY_LAW), indentation=2.0, flexure=3.0)).balance.forces.parts
    factors = {"indentation": 2.0, "idler_rotation": 1.0, "flexure": 3.0, "lift": 1.0}
    for name, factor in factors.items():
        assert double[name] == pytest.approx(factor * plain[name], rel=1e-12)


def test_flexure_that_is_a_share_follows_the_others():
    found = calculate(with_factors(line(calculation=QUICK), indentation=2.0, idler_rotation=0.5)).balance.forces.parts
    plain = calculate(line(calculation=QUICK)).balance.forces.parts
    others = 2.0 * plain["indentation"] + 0.5 * plain["idler_rotation"]
    share = plain["flexure"] / (plain["indentation"] + plain["idler_rotation"])
    assert found["flexure"] == pytest.approx(share * others, rel=1e-12)


def test_every_report_says_that_it_is_calibrated():
    made = with_factors(line(calculation=QUICK), indentation=1.12)
    found = conveyor.analyse(made)
    said = next(text for text in found.warnings if text.startswith("calculation.calibration"))
    assert "indentation x 1.12, idler rotation x 1, flexure x 1, misalignment x 1 (no source given)" in said
    assert said in found.contents().lines("warning")
    ones = conveyor.analyse(with_factors(line(calculation=QUICK)))
    assert not any("calibration" in text for text in ones.warnings)


def test_factors_come_back_without_noise():
    """To the digits they are given with, six, times what a band would amplify."""
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, indentation=1.4, idler_rotation=0.7), states(*EMPTY_AND_FULL))
    found = conveyor.calibrate(given, runs, error=0.02)
    assert [factor.name for factor in found.factors] == ["indentation", "idler rotation"]
    assert [factor.value for factor in found.factors] == pytest.approx([1.4, 0.7], rel=1e-5)
    assert all(factor.low < factor.value < factor.high for factor in found.factors)
    assert found.held == ("flexure", "misalignment")
    assert any("flexure is a share of the main resistance" in note for note in found.notes)


def test_the_calibrated_spec_gives_the_calibrated_power():
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, indentation=1.4, idler_rotation=0.7), states(*EMPTY_AND_FULL), 0.02)
    found = conveyor.calibrate(given, runs)
    again = from_data(_yaml(dump(found.conveyor)))
    for run, made in zip(found.runs, with_runs(again, runs), strict=True):
        assert calculate(made).balance.power.motor == pytest.approx(run.after, rel=1e-4)  # the contacts' rtol
    fragment = _yaml(found.fragment)["calculation"]["calibration"]
    assert fragment == found.conveyor.calculation.calibration.as_data()
    pasted = from_data(data(calculation=QUICK | {"calibration": fragment}))
    assert pasted.calculation.calibration == again.calculation.calibration


def _yaml(text: str) -> dict[str, Any]:
    from ruamel.yaml import YAML

    read: dict[str, Any] = YAML(typ="safe").load(text)
    return read


def test_a_calibration_there_is_not_counted_twice():
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, indentation=1.4, idler_rotation=0.7), states(*EMPTY_AND_FULL))
    found = conveyor.calibrate(with_factors(given, indentation=3.0), runs, error=0.02)
    assert found.factors[0].value == pytest.approx(1.4, rel=1e-5)


def test_empty_runs_at_one_temperature_tell_one_factor():
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, indentation=1.2, idler_rotation=1.2), states((0, 15), (0, 15), (0, 15)))
    found = conveyor.calibrate(given, runs, error=0.02)
    assert [factor.forces for factor in found.factors] == [("indentation", "idler_rotation")]
    assert found.factors[0].value == pytest.approx(1.2, rel=1e-5)
    assert any(
        "empty runs only, at one temperature only: indentation and idler rotation cannot be told apart" in note
        for note in found.notes
    )
    with pytest.raises(InputError, match="indentation; idler rotation: the runs do not tell, a band wider"):
        conveyor.calibrate(given, runs, error=0.02, factors=["indentation", "idler_rotation"])


def test_a_wanted_factor_alone_holds_the_others():
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, idler_rotation=0.6), states((0, 15), (0, 0), (0, 30)))
    found = conveyor.calibrate(given, runs, error=0.02, factors=["idler_rotation"])
    assert found.factors[0].value == pytest.approx(0.6, rel=1e-5)
    assert found.held == ("indentation", "flexure", "misalignment")


def test_flexure_by_law_is_joined_where_it_acts_like_another():
    given = line(calculation=BY_LAW)
    runs = measured(
        with_factors(given, indentation=1.3, idler_rotation=0.8, flexure=1.3, misalignment=1.3),
        states(*EMPTY_AND_FULL),
    )
    found = conveyor.calibrate(given, runs, error=0.02)
    joined = next(factor for factor in found.factors if "flexure" in factor.forces)
    assert len(joined.forces) > 1
    assert found.calibration.flexure == pytest.approx(1.3, rel=1e-5)
    assert found.calibration.idler_rotation == pytest.approx(0.8, rel=1e-5)


def test_joined_factors_that_differ_are_in_the_bands_of_the_others(monkeypatch: pytest.MonkeyPatch):
    """What 0.2 up in one and 0.2 down in the other moves the third by is √2 of the deviation that its band takes in."""
    given, runs = line(calculation=BY_LAW), states(*EMPTY_AND_FULL)
    truth = with_factors(given, indentation=1.2, idler_rotation=1.1, flexure=0.8)
    powers = measured(truth, runs)
    found = conveyor.calibrate(given, powers, error=0.02).factors
    monkeypatch.setattr("conveyor.studies.factor_fit.JOINED_SPREAD", 0.0)
    errors_only = conveyor.calibrate(given, powers, error=0.02).factors
    assert [factor.forces for factor in found] == [
        ("indentation", "flexure", "misalignment"),
        ("idler_rotation",),
    ]
    assert found[0] == errors_only[0]
    moved = 1.1 - found[1].value
    taken_in = math.sqrt((found[1].high - 1.1 + moved) ** 2 - (errors_only[1].high - 1.1 + moved) ** 2)
    # weights are shares of the calculated power, which differs by a few per cent
    assert taken_in == pytest.approx(1.645 * moved / math.sqrt(2.0), rel=0.05)


def test_power_at_the_mains_is_that_of_the_shaft_over_the_train():
    given = line(calculation=QUICK, drive={"train": TRAIN})
    truth = with_factors(given, indentation=1.3, idler_rotation=0.8)
    runs = [*states(*EMPTY_AND_FULL[::2]), *states(*EMPTY_AND_FULL[1::2], at="mains")]
    found = conveyor.calibrate(given, measured(truth, runs), error=0.02)
    assert [factor.value for factor in found.factors] == pytest.approx([1.3, 0.8], rel=1e-5)


def test_vertical_curves_are_solved_until_factors_and_loads_agree():
    sections = [
        {"name": "a", "length": "300 m", "lift": "9 m"},
        {"name": "hill", "length": "250 m", "lift": "4 m", "curve": "convex", "curve_radius": "2500 m"},
        {"name": "b", "length": "400 m", "lift": "-2 m"},
    ]
    given = line(calculation=QUICK, route={"sections": sections, "pulleys": []})
    assert calculate(given).line.has_tension_coupling
    truth = with_factors(given, indentation=1.3, idler_rotation=0.8)
    found = conveyor.calibrate(given, measured(truth, states((0, 0), (0, 30), (1200, 0), (1200, 30))), error=0.02)
    # loads settle to the contacts' rtol of 1e-4, factors to as much
    assert [factor.value for factor in found.factors] == pytest.approx([1.3, 0.8], rel=2e-3)


def test_bands_hold_what_they_say():
    """Twenty conveyors with factors drawn and 2 % noise: the number of 40 bands that hold is binomial, n 40, p 0.9.

    Fewer than 30 come by chance in one of 300 tries; all 40 in one of 70, so no bound above.
    """
    rng = np.random.default_rng(20)
    held = 0
    for k in range(20):
        indentation, rotation = rng.uniform(0.7, 1.6, 2).tolist()
        sections = [{"name": "a", "length": f"{rng.uniform(600, 3000):.0f} m", "lift": f"{rng.uniform(0, 10):.1f} m"}]
        given = line(calculation=QUICK | {"rtol": 1e-3}, route={"sections": sections, "pulleys": []})
        truth = with_factors(given, indentation=indentation, idler_rotation=rotation)
        runs = measured(truth, states(*((0, 0), (0, 30), (1200, 0), (1200, 30)) * 2), 0.02, seed=k)
        found = conveyor.calibrate(given, runs)
        for factor, true in zip(found.factors, (indentation, rotation), strict=True):
            held += factor.low <= true <= factor.high
    assert held >= 30


THREE_LOADS = [(300, 15), (600, 15), (900, 15)]


def draws_of_three_loads(noise: float) -> Iterator[tuple[Grouping, _Fit]]:
    """Groupings and fits of three loads at one temperature, every true factor 1.2; contacts are solved once."""
    given = line(calculation=QUICK | {"rtol": 1e-3})
    scene = SolvedRuns.of(given, states(*THREE_LOADS), Calibration(), None, calculate_many_variants)
    free, _ = free_factors(scene, None)
    power, rng = scene.power(Calibration(indentation=1.2, idler_rotation=1.2)), np.random.default_rng(7)
    for _ in range(60):
        drawn = replace(scene, measured=power * (1.0 + noise * rng.standard_normal(3)))
        yield select_grouping(drawn, free, wanted=False)


def calculate_many_variants(variants: list[Variant]) -> list[CalculatedConveyor | NoAnswer]:
    return list(calculate_many(variants))


@pytest.mark.parametrize("noise", [0.02, 0.06])
def test_luck_of_the_noise_does_not_choose_the_grouping(noise: float):
    """Joined in all draws (was apart where the differences were small by luck, with bands that held 60 %).

    Of 60 bands of 90 % fewer than 48 hold by chance in one of 60 tries.
    """
    found = list(draws_of_three_loads(noise))
    assert {grouping for grouping, _ in found} == {(("indentation", "idler_rotation"),)}
    held = [fit.factors[0].low <= 1.2 <= fit.factors[0].high for _, fit in found]
    assert sum(held) >= 48


def test_runs_that_agree_have_the_band_of_a_usual_error():
    """Not of no width: meter and belt scale are off alike in all of them."""
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, indentation=1.2, idler_rotation=1.2), states((900, 15)) * 3)
    agreed, stated = conveyor.calibrate(given, runs), conveyor.calibrate(given, runs, error=0.02)
    assert agreed.factors[0].low == pytest.approx(stated.factors[0].low, rel=1e-9)
    assert agreed.factors[0].high == pytest.approx(stated.factors[0].high, rel=1e-9)
    assert any("the bands are those of a known error of 2 % of each power" in note for note in agreed.notes)


def test_bands_wider_than_expected_are_said():
    given = line(calculation=QUICK)
    truth = with_factors(given, indentation=1.4, idler_rotation=0.7)
    found = conveyor.calibrate(given, measured(truth, states(*EMPTY_AND_FULL), 0.15, seed=3))
    wide = [factor.name for factor in found.factors if factor.high - factor.value > 0.25]
    assert wide
    for name in wide:
        assert any(note.startswith(f"the band of {name} is wider than ±0.25") for note in found.notes)


def test_stated_errors_that_are_too_small_widen_the_bands():
    given = line(calculation=QUICK)
    truth = with_factors(given, indentation=1.4, idler_rotation=0.7)
    runs = measured(truth, states(*EMPTY_AND_FULL), 0.04, seed=5)
    stated = [run.replace(deviation=run.power * 0.005) for run in runs]
    found = conveyor.calibrate(given, stated)
    assert found.chi_square / found.freedom > 10.0
    assert any("times the errors stated" in note for note in found.notes)
    by_residuals = conveyor.calibrate(given, runs)
    widths = [[f.high - f.low for f in each.factors] for each in (found, by_residuals)]
    assert widths[0] == pytest.approx(widths[1], rel=0.15)  # absolute and relative weights differ a little


def test_what_cannot_be_calibrated_is_refused():
    given = line(calculation=QUICK)
    full, empty = states((1200, 15)), states((0, 15), (0, 30))
    with pytest.raises(InputError, match="1 runs for 2 factors: give as many runs as factors"):
        conveyor.calibrate(given, full, error=0.02, factors=["indentation", "idler_rotation"])
    with pytest.raises(InputError, match=r"idler rotation: 2 runs at least are needed; with a stated error one less"):
        conveyor.calibrate(given, full)
    with pytest.raises(InputError, match="factors: got rubber, allowed: indentation, idler_rotation, flexure"):
        conveyor.calibrate(given, full, factors=["rubber"])
    with pytest.raises(InputError, match=r"run 1: its power is that at the mains, and drive.train has no part"):
        conveyor.calibrate(given, states((1200, 15), at="mains"))
    with pytest.raises(InputError, match="comes out as -"):
        conveyor.calibrate(given, [run.replace(power="0.1 kW") for run in empty], error=0.02)
    with pytest.raises(InputError, match=r"run 2: no standard deviation, others have one"):
        conveyor.calibrate(given, [empty[0].replace(deviation="0.1 kW"), empty[1]])
    with pytest.raises(InputError, match=r"run 1: .*t/h"):
        conveyor.calibrate(given, states((20000, 15)))
    with pytest.raises(InputError, match=r"error = 2: a standard deviation over the power, between 0 and 1"):
        conveyor.calibrate(given, full, error=2.0)
    with pytest.raises(InputError, match=r"deviation: got 2 kW of a power of 1 kW, allowed: less than the power"):
        full[0].replace(deviation="2 kW")
    with pytest.raises(InputError, match="factors: indentation is given twice; each one once"):
        conveyor.calibrate(given, empty, error=0.02, factors=["indentation", "indentation"])


def test_runs_that_brake_need_their_efficiency_and_a_calculation_that_brakes():
    down = line(calculation=QUICK, route={"sections": DOWN})
    braking = [run.replace(power="-100 kW") for run in states((1200, 15), (0, 15))]
    with pytest.raises(InputError, match=r"run 1: the belt drives its motors, and drive.regeneration_efficiency"):
        conveyor.calibrate(down, braking)
    known = down.replace(drive=down.drive.replace(regeneration_efficiency="92 %"))
    with pytest.raises(
        InputError, match=r"run 2: measured -100 kW, as calculated [\d.]+ kW: one drives, the other brakes"
    ):
        conveyor.calibrate(known, braking)
    with pytest.raises(InputError, match=r"run 2: measured -134\.1 hp, as calculated [\d.]+ hp: one drives"):
        conveyor.calibrate(known.replace(report={"units": "US"}), braking)


def test_tables_hold_what_was_found():
    given = line(calculation=QUICK)
    runs = measured(with_factors(given, indentation=1.4, idler_rotation=0.7), states(*EMPTY_AND_FULL), 0.02)
    found = conveyor.calibrate(given, runs)
    assert found.table["value [-]"].tolist() == [factor.value for factor in found.factors]
    assert found.residuals["measured [kW]"].tolist() == pytest.approx([run.measured / 1e3 for run in found.runs])
    plain = found.to_dict()
    assert plain["degrees_of_freedom"] == len(runs) - 2
    # of errors estimated from the differences, chi square is the degrees of freedom
    squares = [((run.measured - run.after) / run.error) ** 2 for run in found.runs]
    assert math.fsum(squares) == pytest.approx(plain["degrees_of_freedom"], rel=1e-3)
