"""Friction to design for: the upper end of the band decides motors, belt, grip and take-up."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.calculated_conveyor import Variant
from conveyor.checks import run_checks
from conveyor.default_bands import friction_band, power_range
from conveyor.errors import InputError
from conveyor.loop.balance import OpenLoop, close_loops
from conveyor.loop.equilibrium import DESIGN, DESIGN_START, LEAST
from conveyor.loop.load_superposition import SectionLoadings
from conveyor.pipeline import calculate, calculate_many

SPECS = Path(__file__).parents[2] / "examples" / "specs"
ROUNDING = 1e-9


def designed(stem, friction):
    line = conveyor.load(SPECS / f"{stem}.yaml")
    return calculate(line.replace(drive=line.drive.replace(design_friction=f"{100.0 * friction} %")))


def rubbed_more(balance, factor):
    """The same loop with every friction force multiplied, the take-up at its setting."""

    def more(force):
        at_sag_limit = None if force.at_sag_limit is None else force.at_sag_limit * factor
        return force if force.certain else replace(force, newtons=force.newtons * factor, at_sag_limit=at_sag_limit)

    layout = balance.layout.scaled(more).designed_for(1.0)
    along = tuple(map(more, balance.along))
    (made,) = close_loops([OpenLoop.of(layout, along, balance.unit_main, balance.equilibrium.take_up)])
    return made


@pytest.mark.parametrize("stem", ["overland", "in_plant_us", "downhill_brakes", "transfer"])
def test_tensions_are_those_of_a_belt_with_more_friction(stem):
    """Wraps and flexure follow the tension instead of the friction: 2 % of what it adds, as for the band."""
    balance = designed(stem, 1.3).balance
    rubbed, states = rubbed_more(balance, 1.3), balance.equilibrium.states
    added = rubbed.equilibrium.force - balance.equilibrium.force
    assert added > 0.0
    assert balance.equilibrium.design_force - balance.equilibrium.force == pytest.approx(added, rel=0.02)
    steady = rubbed.equilibrium.steady
    for mine, other in ((states[DESIGN].starts, steady.starts), (states[DESIGN].ends, steady.ends)):
        assert np.allclose(mine, other, rtol=0.0, atol=0.02 * added)
    if rubbed.equilibrium.force > 0.0:
        start = rubbed.equilibrium.unsteady
        assert states[DESIGN_START].force == pytest.approx(start.force, abs=0.03 * added)
        assert states[DESIGN_START].largest == pytest.approx(start.largest, abs=0.03 * added)


def test_the_take_up_serves_the_expected_and_the_design_friction():
    plain, more = designed("overland", 1.0).balance.equilibrium, designed("overland", 1.4).balance.equilibrium
    assert set(more.states) - set(plain.states) == {DESIGN, DESIGN_START}
    assert more.needed > plain.needed
    assert more.needed == pytest.approx(max(more.conditions.values()), rel=ROUNDING)
    assert "design friction" in more.governing
    # Eytelwein at the start: slack side over drive force, 210 deg at 0.35
    start = more.states[DESIGN_START].drives[0]
    assert start.slack == pytest.approx(start.force / math.expm1(0.35 * math.radians(210.0)), rel=1e-9)


def test_without_a_given_one_it_is_the_upper_end_of_the_band():
    result = calculate(conveyor.load(SPECS / "overland.yaml"))
    wraps = 1e-3  # the band is that of the loop before its take-up was raised for it
    assert result.line.design_friction == pytest.approx(friction_band(result)[1], rel=wraps)
    left = power_range(result)
    assert left.design == pytest.approx(left.high, rel=wraps)
    (check,) = (check for check in run_checks(result) if check.key == "motor_power")
    assert check.calculated == pytest.approx(left.design, rel=ROUNDING)
    assert check.where == DESIGN
    (expected,) = calculate_many([Variant(result.conveyor, design_friction=1.0)])
    assert expected.line.design_friction == 1.0
    assert DESIGN not in expected.balance.equilibrium.states


def test_a_belt_that_drives_its_motors_is_held_with_the_least_friction():
    result = designed("downhill_brakes", 1.3)
    powers = [check for check in run_checks(result) if check.key == "motor_power"]
    assert {check.where for check in powers} == {LEAST}
    held = abs(result.balance.layout.motor(result.balance.equilibrium.least_force))
    assert sum(check.calculated for check in powers) == pytest.approx(held, rel=ROUNDING)


def test_belt_safety_is_that_of_the_highest_steady_tension():
    plain, more = designed("overland", 1.0), designed("overland", 1.3)
    width, strength = 1.2, 2.5e6
    assert more.belt_duty.safety_steady == pytest.approx(
        strength * width / more.balance.equilibrium.states[DESIGN].largest, rel=ROUNDING
    )
    assert more.belt_duty.safety_steady < plain.belt_duty.safety_steady


def test_the_start_is_judged_with_it():
    """A motor that starts the expected belt but not the one with more friction."""
    line = conveyor.load(SPECS / "overland.yaml")

    def start(friction, torque):
        drive = line.drive.replace(design_friction=f"{friction} %", torque_factor=torque)
        return next(one for one in run_checks(calculate(line.replace(drive=drive))) if one.key == "starting_force")

    torques = [1.0 + 0.02 * k for k in range(60)]
    enough = next(torque for torque in torques if not start(100, torque).failed)
    assert start(130, enough).failed
    assert start(130, enough).where == DESIGN


def test_a_superposed_loading_has_it_too():
    full = calculate(conveyor.load(SPECS / "overland.yaml"))
    case = conveyor.LoadCase(name="empty", loading="empty")
    from conveyor.models.variants import with_case

    friction = full.line.design_friction
    (empty,) = calculate_many(
        [Variant(with_case(full.conveyor, case), take_up=full.balance.equilibrium.take_up, design_friction=friction)]
    )
    loadings = SectionLoadings(full.balance, empty.balance)
    (whole,) = loadings.loaded([np.ones(full.line.count, bool)])
    assert whole.equilibrium.states[DESIGN].largest == pytest.approx(
        full.balance.equilibrium.states[DESIGN].largest, rel=1e-6
    )
    worst = loadings.worst()["drive force"]
    (found,) = loadings.loaded([worst])
    others = loadings.loaded([np.arange(full.line.count) != k for k in range(full.line.count)])
    assert found.equilibrium.design_force >= max(one.equilibrium.design_force for one in others) - 1e-6


@pytest.mark.parametrize("value", ["90 %", "0", "600 %"])
def test_less_than_expected_is_refused(value):
    line = conveyor.load(SPECS / "overland.yaml")
    with pytest.raises(InputError, match="design_friction"):
        line.drive.replace(design_friction=value)
