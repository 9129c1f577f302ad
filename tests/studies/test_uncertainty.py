"""Ranges of inputs: exact ends, linear toys with a closed form, bands, rubber replicas, refusals."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtri

from conveyor import shelf
from conveyor.effects import Effect, root_of_squares
from conveyor.errors import InputError
from conveyor.models import Conveyor, RubberCompound, Uncertainty
from conveyor.pipeline import calculate
from conveyor.rubber.rolling_test_factor import BAND_COVERAGE
from conveyor.spec import load
from conveyor.studies.input_ranges import SAMPLES, analyse_ranges, hypercube_band
from conveyor.units import quantity, si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-4
"""Of the contacts, for both sides of a comparison: load ranges differ, so that figures differ by up to twice it."""


@pytest.fixture(scope="module")
def line() -> Conveyor:
    given = load(SPECS / "overland.yaml")
    return given.replace(calculation=given.calculation.replace(rtol=RTOL, flexure_share="11 %"))


def without_replicas(compound: RubberCompound) -> RubberCompound:
    return compound.replace(prony=compound.prony.replace(band=None))


def on(conveyor: Conveyor, bottom: RubberCompound) -> Conveyor:
    """The conveyor with a compound under the carry rolls, and one without replicas and tests under the others."""
    plain = without_replicas(shelf.compound("standard-cover").replace(strain_dependence=None, tests=()))
    belt = conveyor.belt
    return conveyor.replace(
        belt=belt.replace(
            top_cover=belt.top_cover.replace(compound=plain),
            bottom_cover=belt.bottom_cover.replace(compound=bottom),
        )
    )


def ranges(**given: object) -> Uncertainty:
    return Uncertainty.from_data(given)


def effect(low: float, high: float) -> Effect:
    return Effect("toy", "", "", "", low, high)


# closed forms -----------------------------------------------------------------------------------------------------


def test_bands_of_a_linear_toy():
    # P = 10 + 3 a + 4 b, a and b between -1 and 1: root sum of squares 5; normal inputs make a normal power
    toy = [effect(7.0, 13.0), effect(14.0, 6.0)]
    assert root_of_squares(10.0, toy) == (5.0, 15.0)
    low, high = hypercube_band(10.0, toy, samples=SAMPLES, seed=1)
    # scatter of an empirical quantile, sqrt(p(1-p)/n)/density: 2.1/sqrt(n) standard deviations; 4 of them are taken
    scatter = 4.0 * 2.1 / math.sqrt(SAMPLES) * 5.0 / ndtri(0.95)
    assert low == pytest.approx(5.0, abs=scatter)
    assert high == pytest.approx(15.0, abs=scatter)


def test_the_hypercube_of_one_linear_input_is_stratified_to_its_quantiles():
    low, high = hypercube_band(10.0, [effect(7.0, 13.0)], samples=SAMPLES, seed=0)
    # each of n strata holds one point: a quantile is off by at most one stratum, 1/n over the density
    off = 2.0 * 3.0 / ndtri(0.95) / (SAMPLES * 0.10314)
    assert (low, high) == (pytest.approx(7.0, abs=off), pytest.approx(13.0, abs=off))


def test_the_seed_decides_and_nothing_else():
    toy = [effect(7.0, 13.0), effect(14.0, 6.0)]
    once, again, other = (hypercube_band(10.0, toy, samples=64, seed=seed) for seed in (3, 3, 4))
    assert again == pytest.approx(once, rel=1e-13)
    assert other != pytest.approx(once, rel=1e-6)


def test_one_sided_changes_stay_on_their_side():
    # both ends raise the power: nothing below
    assert root_of_squares(10.0, [effect(11.0, 13.0)]) == (10.0, 13.0)
    assert hypercube_band(10.0, [effect(11.0, 13.0)], samples=256, seed=0)[0] > 10.0


def test_no_input_no_band():
    assert root_of_squares(10.0, []) == (10.0, 10.0)
    assert hypercube_band(10.0, [], samples=2, seed=0) == (10.0, 10.0)
    with pytest.raises(InputError, match="samples = 1: at least 2"):
        hypercube_band(10.0, [], samples=1, seed=0)


# the conveyor -----------------------------------------------------------------------------------------------------


def test_roll_drag_without_pulleys_is_a_linear_input(line):
    # wraps and pulley bearings would follow the tension
    alone = line.calculation.replace(not_given="nothing")
    bare = line.replace(route=line.route.replace(pulleys=[]), calculation=alone)
    found = analyse_ranges(bare, ranges(roll_drag="30 %"))
    (one,) = found.effects
    balance = calculate(bare).balance
    change = 0.3 * balance.forces.parts["idler_rotation"] / 0.89  # flexure is 11 % of the main resistance
    watts = change * si(line.belt.speed) / si(line.drive.efficiency)
    assert one.motor_high - found.motor == pytest.approx(watts, rel=1e-11)
    assert found.motor - one.motor_low == pytest.approx(watts, rel=1e-11)
    assert found.motor == pytest.approx(balance.power.motor, rel=1e-14)  # drag changes no contact
    assert found.band == (pytest.approx(one.motor_low), pytest.approx(one.motor_high))
    assert found.shares == (1.0,)
    low, motor, high = (f"{power / 1e3:.1f}" for power in (found.band[0], found.motor, found.band[1]))
    assert f"motor power {motor} kW, 90 % interval of its ranges {low} to {high} kW" in repr(found)


@pytest.mark.parametrize(
    ("given", "change"),
    [
        ({"flow": "5 %"}, lambda c, s: {"material": c.material.replace(flow=c.material.flow * (1 + 0.05 * s))}),
        (
            {"temperature": "5 K"},
            lambda c, s: {"ambient": c.ambient.replace(temperature=quantity(f"{20 + 5 * s} degC"))},
        ),
        (
            {"flexure_share": ("8 %", "14 %")},
            lambda c, s: {"calculation": c.calculation.replace(flexure_share=f"{11 + 3 * s} %")},
        ),
        ({"belt_mass": "4 %"}, lambda c, s: {"belt": c.belt.replace(mass=quantity(f"{27 * (1 + 0.04 * s)!r} kg/m^2"))}),
        (
            {"cover_thickness": "10 %"},
            lambda c, s: {"belt": c.belt.replace(
                bottom_cover=c.belt.bottom_cover.replace(thickness=quantity(f"{4 * (1 + 0.1 * s)!r} mm")))},
        ),
        (
            {"cleaner_pressure": "50 %"},
            lambda c, s: {"route": c.route.replace(
                cleaners=[c.route.cleaners[0].replace(pressure=quantity(f"{30 * (1 + 0.5 * s)!r} kPa"))])},
        ),
        (
            {"skirt_friction": "20 %"},
            lambda c, s: {"route": c.route.replace(
                feeding=c.route.feeding.replace(skirt_friction=c.route.feeding.skirt_friction * (1 + 0.2 * s)))},
        ),
        (
            {"density": "5 %"},
            lambda c, s: {"material": c.material.replace(density=quantity(f"{850 * (1 + 0.05 * s)!r} kg/m^3"))},
        ),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)  # fmt: skip
def test_both_ends_are_analyses(line, given, change):
    (one,) = analyse_ranges(line, ranges(**given)).effects
    for sign, power in ((-1.0, one.motor_low), (1.0, one.motor_high)):
        alone = calculate(line.replace(**change(line, sign))).balance.power.motor
        assert power == pytest.approx(alone, rel=2.0 * RTOL)


def test_the_tornado_has_its_largest_swing_on_top(line):
    found = analyse_ranges(
        line, ranges(roll_drag="30 %", flow="5 %", cleaner_pressure="10 %", flexure_share=("8 %", "14 %"))
    )
    swings = [one.swing for one in found.effects]
    assert swings == sorted(swings, reverse=True)
    assert found.effects[-1].name == "cleaner pressure"
    assert sum(found.shares) == pytest.approx(1.0)
    changes = np.array([(e.motor_low - found.motor, e.motor_high - found.motor) for e in found.effects])
    assert found.band[1] - found.motor == pytest.approx(np.sqrt((changes.max(axis=1) ** 2).sum()))
    # nearly linear: both ways to combine agree to the scatter of the quantiles
    assert found.sampled == pytest.approx(found.band, abs=0.07 * (found.band[1] - found.band[0]))


def test_a_range_twice_as_wide_swings_twice_as_far(line):
    narrow, wide = (analyse_ranges(line, ranges(skirt_friction=f"{p} %")).effects[0].swing for p in (10, 20))
    assert wide == pytest.approx(2.0 * narrow, rel=1e-9)


def test_downhill_the_power_falls_with_the_drag():
    (one,) = analyse_ranges(load(SPECS / "downhill.yaml"), ranges(roll_drag="30 %"), rtol=RTOL).effects
    assert one.motor_low < one.motor_high < 0.0


def test_rubber_is_the_band_of_its_replicas(line):
    compound = shelf.compound("s100").replace(strain_dependence=None)
    given = on(line, compound)
    found = analyse_ranges(given, ranges(rubber=True))
    (one,) = found.effects
    assert one.name == 'rubber "S100"'
    assert any('"standard-cover" has no replicas and no tests' in note for note in found.notes)
    powers = []
    for replica in compound.replicas(si(compound.reference_temperature)):
        prony = compound.prony.replace(
            band=None,
            equilibrium=quantity(f"{replica.equilibrium!r} Pa"),
            terms=[
                {"modulus": f"{float(e)!r} Pa", "time": f"{float(t)!r} s"}
                for e, t in zip(replica.moduli, replica.times, strict=True)
            ],
        )
        powers.append(calculate(on(line, compound.replace(prony=prony))).balance.power.motor)
    expected = np.quantile(powers, [0.5 * (1.0 - BAND_COVERAGE), 0.5 * (1.0 + BAND_COVERAGE)], method="weibull")
    assert [one.motor_low, one.motor_high] == pytest.approx(expected, rel=2.0 * RTOL)


def test_ranges_of_the_spec(line):
    given = line.replace(uncertainty={"roll_drag": "30 %"})
    assert Conveyor.from_data(given.as_data()) == given
    assert [one.name for one in analyse_ranges(given).effects] == ["roll drag"]


def test_what_the_conveyor_has_none_of_is_noted(line):
    bare = line.replace(route=line.route.replace(cleaners=[]))
    found = analyse_ranges(bare, ranges(cleaner_pressure="50 %"))
    assert found.notes == ("uncertainty.cleaner_pressure: the conveyor has none of it",)
    assert found.effects[0].swing == 0.0
    assert found.shares == (0.0,)


# refusals ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"roll_drag": "100 %"}, "got 100 %, allowed: > 0 % and < 100 %"),
        (
            {"flexure_share": ["14 %", "8 %"]},
            "flexure_share: got 14 % to 8 %, expected the lower value first",
        ),
        ({"flexure_share": ["14 %"]}, "flexure_share"),
        ({"temperature": "5 degC"}, "temperature difference"),
        ({"roll_drags": "5 %"}, "roll_drags"),
    ],
)
def test_wrong_ranges_are_refused(data, message):
    with pytest.raises(InputError, match=message):
        ranges(**data)


def test_studies_without_an_answer_are_refused(line):
    with pytest.raises(InputError, match="uncertainty: missing; give the spec ranges, or pass them: nothing to vary"):
        analyse_ranges(line)
    cover = shelf.compound("low-rolling-resistance-cover").replace(strain_dependence=None, tests=())
    bare = on(line, without_replicas(cover))
    with pytest.raises(InputError, match=r"has no replicas.*nothing to vary"):
        analyse_ranges(bare, ranges(rubber=True))
    with pytest.raises(InputError, match=r"uncertainty.flow: an end of the range is refused: material.flow: got"):
        analyse_ranges(line, ranges(flow="90 %"))
    with pytest.raises(InputError, match=r"uncertainty.temperature: an end of the range is refused: ambient"):
        analyse_ranges(line, ranges(temperature="90 K"))
