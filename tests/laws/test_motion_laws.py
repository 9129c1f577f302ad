"""Starting and stopping: energy, momentum, limits, what has no answer."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError, NoSolutionError
from conveyor.laws import motion

ROUNDING = 1e-13


def test_reduced_mass_keeps_the_kinetic_energy():
    mass = motion.reduced_mass(1.5, radius=0.4, ratio=25.0)
    belt_speed = 3.0
    assert mass * belt_speed**2 == pytest.approx(1.5 * (25.0 * belt_speed / 0.4) ** 2, rel=ROUNDING)


def test_start_power_is_the_limited_motor_power():
    force = motion.start_force(90e3, torque_factor=1.4, efficiency=0.92, rated_belt_speed=4.8)
    assert force * 4.8 == pytest.approx(1.4 * 0.92 * 90e3, rel=ROUNDING)


def test_stop_turns_the_kinetic_energy_into_work():
    stop = motion.constant_force_stop(4.0, retarding_force=30e3, moving_mass=45e3)
    assert 30e3 * stop.distance == pytest.approx(45e3 * 4.0**2 / 2, rel=ROUNDING)
    assert 30e3 * stop.time == pytest.approx(45e3 * 4.0, rel=ROUNDING)


def test_brake_gives_the_deceleration_asked_for():
    brake = motion.brake_force(0.3, resistance=-12e3, moving_mass=45e3)
    stop = motion.constant_force_stop(4.0, retarding_force=brake - 12e3, moving_mass=45e3)
    assert stop.deceleration == pytest.approx(0.3, rel=ROUNDING)
    assert motion.brake_force(0.0, resistance=-12e3, moving_mass=45e3) == 12e3
    assert motion.brake_force(0.1, resistance=12e3, moving_mass=45e3) == -7500.0


def test_bulk_slips_symmetrically_on_the_level_and_mirrors_with_the_slope():
    level = motion.bulk_slip_limits(0.5, inclination=0.0, gravity=9.81)
    assert level == (-0.5 * 9.81, 0.5 * 9.81)
    up = motion.bulk_slip_limits(0.5, inclination=0.2, gravity=9.81)
    down = motion.bulk_slip_limits(0.5, inclination=-0.2, gravity=9.81)
    assert up[0] == pytest.approx(-down[1], rel=ROUNDING)
    assert up[1] == pytest.approx(-down[0], rel=ROUNDING)
    # at the limit friction is used up: a + g sin δ = μ g cos δ
    assert up[1] + 9.81 * math.sin(0.2) == pytest.approx(0.5 * 9.81 * math.cos(0.2), rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: motion.constant_force_stop(4.0, retarding_force=-5e3, moving_mass=1.0),
            r"retarding force of -5000 N does not stop the belt: a brake of more than 5000 N",
        ),
        (
            lambda: motion.constant_force_stop(4.0, retarding_force=0.0, moving_mass=1.0),
            r"retarding force of 0 N does not stop the belt: a brake of more than 0 N",
        ),
        (
            lambda: motion.bulk_slip_limits(0.3, inclination=0.3, gravity=9.81),
            r"the bulk slides at a slope of 17\.2 deg with friction 0\.3",
        ),
    ],
)
def test_no_answer(call, message):
    with pytest.raises(NoSolutionError, match=message):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: motion.reduced_mass(1.0, radius=0.0), r"radius: got 0\.0"),
        (
            lambda: motion.start_force(1.0, torque_factor=1.0, efficiency=1.1, rated_belt_speed=1.0),
            r"efficiency: got 1\.1, allowed: > 0 and <= 1",
        ),
        (
            lambda: motion.constant_force_stop(1.0, retarding_force=1.0, moving_mass=0.0),
            r"moving_mass: got 0\.0",
        ),
        (lambda: motion.brake_force(-0.1, resistance=0.0, moving_mass=1.0), r"deceleration: got -0\.1"),
        (
            lambda: motion.bulk_slip_limits(0.5, inclination=15.0, gravity=9.81),
            r"inclination: got 15\.0, allowed: .* pi/2 rad",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
