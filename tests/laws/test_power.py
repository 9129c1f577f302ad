"""Power, energy, cost: sign convention, exact unit factors, refusals."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws import power

ROUNDING = 1e-14


def test_losses_of_the_drive_always_cost():
    assert power.motor_power(1e5, efficiency=0.9) == pytest.approx(1e5 / 0.9, rel=ROUNDING)
    assert power.motor_power(-1e5, efficiency=0.9) == pytest.approx(-9e4, rel=ROUNDING)
    for belt in (1e5, -1e5):
        assert power.motor_power(belt, efficiency=0.9) > belt
        assert power.motor_power(belt, efficiency=1.0) == belt
    assert power.motor_power(0.0, efficiency=0.9) == 0


def test_specific_energy_of_a_conveyor_with_friction_only():
    # F = f m' g L at Q = m' v: P/(Q L) = f g per mass and metre, whatever the speed
    for speed in (1.0, 5.0):
        force = 0.02 * 100.0 * 9.81 * 1000.0
        belt = power.belt_power(force, belt_speed=speed)
        energy = power.specific_energy(belt, mass_flow=100.0 * speed, length=1000.0)
        assert energy == pytest.approx(0.02 * 9.81 / 3.6, rel=ROUNDING)  # 1 J/(kg m) = 1/3.6 kWh/(t km)


def test_empirical_lift_is_the_potential_energy_with_367_for_3600_over_g():
    law = power.empirical_lift_power(100.0, lift=10.0)
    assert law == pytest.approx(100.0 * 10.0 * 3600 / 367, rel=ROUNDING)
    assert power.empirical_lift_power(100.0, lift=-10.0) == pytest.approx(-law, rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: power.belt_power(1.0, belt_speed=0.0), r"belt_speed: got 0\.0, allowed"),
        (lambda: power.belt_power(1.0, belt_speed=math.inf), r"belt_speed: got inf, allowed"),
        (lambda: power.belt_power(math.nan, belt_speed=1.0), r"force: got nan, allowed: finite"),
        (
            lambda: power.motor_power(1.0, efficiency=1.01),
            r"efficiency: got 1\.01, allowed: > 0 and <= 1",
        ),
        (lambda: power.motor_power(1.0, efficiency=0.0), r"efficiency: got 0\.0"),
        (lambda: power.specific_energy(1.0, mass_flow=0.0, length=1.0), r"mass_flow: got 0\.0"),
        (lambda: power.empirical_lift_power(-1.0, lift=1.0), r"mass_flow: got -1\.0"),
        (
            lambda: power.empirical_level_power(
                1.0, belt_speed=1.0, width_coefficient=1.0, length_coefficient=0.0, friction_coefficient=1.0
            ),
            r"length_coefficient: got 0\.0",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
