"""A year's duty: sums, invariance under splitting, agreement with the single law, motors, refusals."""

from __future__ import annotations

from itertools import pairwise

import pytest

from conveyor.errors import InputError, RangeError
from conveyor.laws import energy, power

ROUNDING = 1e-13
HOUR = 3600.0
STEPS = [
    energy.DutyStep(time=3000 * HOUR, power=100e3, mass_flow=250.0),
    energy.DutyStep(time=1500 * HOUR, power=60e3, mass_flow=100.0),
    energy.DutyStep(time=500 * HOUR, power=-30e3, mass_flow=300.0),
]


def test_one_step_is_the_single_law():
    duty = energy.duty_sums(STEPS[:1])
    assert duty.net_kwh == pytest.approx(3000 * 100.0, rel=ROUNDING)
    assert energy.duty_specific_energy(duty, length=800.0) == pytest.approx(
        power.specific_energy(100e3, mass_flow=250.0, length=800.0), rel=ROUNDING
    )


def test_drawn_and_fed_back_stay_apart():
    duty = energy.duty_sums(STEPS)
    assert duty.drawn_kwh == pytest.approx(3000 * 100 + 1500 * 60, rel=ROUNDING)
    assert duty.fed_back_kwh == pytest.approx(500 * 30, rel=ROUNDING)
    assert duty.time == 5000 * HOUR
    assert duty.mass == pytest.approx(HOUR * (3000 * 250 + 1500 * 100 + 500 * 300), rel=ROUNDING)


def test_splitting_and_reordering_steps_changes_nothing():
    first = STEPS[0]
    halves = [energy.DutyStep(time=first.time / 2, power=first.power, mass_flow=first.mass_flow)] * 2
    assert energy.duty_sums([*reversed(STEPS[1:]), *halves]) == energy.duty_sums(STEPS)


def test_cost_and_carbon_of_the_net_at_equal_rates():
    duty = energy.duty_sums(STEPS)
    assert energy.duty_cost(duty, price=0.2, credit=0.2) == pytest.approx(0.2 * duty.net_kwh, rel=ROUNDING)
    assert energy.duty_cost(duty, price=0.2, credit=0.0) == pytest.approx(0.2 * duty.drawn_kwh, rel=ROUNDING)
    gone = energy.duty_emission(duty, factor=0.4, credit_factor=0.4)
    assert gone == pytest.approx(0.4 * duty.net_kwh, rel=ROUNDING)


def test_a_conveyor_that_only_feeds_back_earns():
    duty = energy.duty_sums(STEPS[2:])
    assert duty.drawn_kwh == 0
    assert energy.duty_cost(duty, price=0.2, credit=0.1) == pytest.approx(-1500.0, rel=ROUNDING)


def test_a_leap_year_is_the_longest():
    whole = energy.DutyStep(time=8784 * HOUR, power=1.0, mass_flow=0.0)
    assert energy.duty_sums([whole]).drawn_kwh == pytest.approx(8.784, rel=ROUNDING)
    with pytest.raises(InputError, match=r"allowed: <= 8784 h, a year; these are 8785 h"):
        energy.duty_sums([whole, energy.DutyStep(time=HOUR, power=1.0, mass_flow=0.0)])


def test_motor_is_the_next_of_the_series():
    for series in (energy.MOTOR_SERIES, energy.NEMA_MOTORS):
        for small, large in pairwise(series):
            assert small < large
            assert energy.next_motor(large, series=series) == large
            assert energy.next_motor(small + 1.0, series=series) == large
    # 100 kW · 1.1 is 110.00000000000001 in binary
    assert energy.next_motor(100e3, reserve=1.1) == 110e3
    assert energy.next_motor(0.0) == energy.MOTOR_SERIES[0]


def test_too_much_for_one_motor():
    with pytest.raises(RangeError, match=r"1100 kW is more than the largest motor of the series, 1000 kW: share"):
        energy.next_motor(1e6, reserve=1.1)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: energy.DutyStep(time=-1.0, power=1.0, mass_flow=0.0), r"time: got -1\.0"),
        (lambda: energy.DutyStep(time=1.0, power=float("nan"), mass_flow=0.0), r"power: got nan"),
        (lambda: energy.DutyStep(time=1.0, power=1.0, mass_flow=-1.0), r"mass_flow: got -1\.0"),
        (lambda: energy.duty_sums([]), r"steps: got \[\], .*at least one step"),
        (lambda: energy.duty_cost(energy.duty_sums(STEPS), price=-0.1, credit=0.0), r"price: got -0\.1"),
        (
            lambda: energy.duty_emission(energy.duty_sums(STEPS), factor=0.1, credit_factor=-1.0),
            r"credit_factor",
        ),
        (lambda: energy.duty_specific_energy(energy.duty_sums(STEPS), length=0.0), r"length: got 0\.0"),
        (
            lambda: energy.duty_specific_energy(
                energy.duty_sums([energy.DutyStep(time=1.0, power=1.0, mass_flow=0.0)]), length=1.0
            ),
            r"duty\.mass: got 0\.0, .* some mass conveyed",
        ),
        (lambda: energy.next_motor(1.0, reserve=0.9), r"reserve: got 0\.9, allowed: >= 1"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
