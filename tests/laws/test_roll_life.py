"""Roll life: ISO 281 by hand, moments, linear damage, systems, refusals."""

from __future__ import annotations

import pytest

from conveyor.errors import InputError
from conveyor.laws import roll_life

ROUNDING = 1e-13
ROLL = {"dynamic_rating": 20e3, "rotation": 10.0}


def test_a_bearing_at_its_rating_runs_a_million_turns():
    hours = roll_life.rating_life_hours(20e3, **ROLL)
    assert hours * 3600 * 10.0 == pytest.approx(1e6, rel=ROUNDING)


@pytest.mark.parametrize("exponent", [roll_life.BALL_EXPONENT, roll_life.ROLLER_EXPONENT])
def test_half_the_load_lives_two_to_the_p_longer(exponent):
    full = roll_life.rating_life_hours(2e3, **ROLL, exponent=exponent)
    half = roll_life.rating_life_hours(1e3, **ROLL, exponent=exponent)
    assert half / full == pytest.approx(2**exponent, rel=ROUNDING)


def test_faster_is_shorter_in_hours():
    slow = roll_life.rating_life_hours(1e3, **ROLL)
    assert roll_life.rating_life_hours(1e3, **ROLL | {"rotation": 20.0}) == pytest.approx(slow / 2, rel=ROUNDING)


def test_even_load_over_the_whole_roll_halves():
    load = {"belt_force": 100.0, "loaded_length": 0.5, "bearing_distance": 0.5}
    assert roll_life.heavier_bearing_load(300.0, **load, triangular=False) == 200.0


def test_wing_by_moments():
    # bulk 300 N at 0.4/3 m, belt 100 N at 0.2 m from the inner bearing, outer bearing at 0.5 m
    load = roll_life.heavier_bearing_load(
        300.0, belt_force=100.0, loaded_length=0.4, bearing_distance=0.5, triangular=True
    )
    outer = (300.0 * 0.4 / 3 + 100.0 * 0.2) / 0.5
    assert load == pytest.approx(400.0 - outer, rel=ROUNDING)
    assert load > outer


BALL, ROLLER = roll_life.WEIBULL_SLOPE_BALL, roll_life.WEIBULL_SLOPE_ROLLER


@pytest.mark.parametrize(("slope", "power"), [(BALL, 0.9), (ROLLER, 8.0 / 9.0)])
def test_a_system_is_shorter_lived_than_its_weakest(slope, power):
    def life(*lives):
        return roll_life.system_life_hours(lives, weibull_slopes=[slope] * len(lives))

    assert life(3e4) == pytest.approx(3e4, rel=ROUNDING)
    assert life(3e4, 3e4) == pytest.approx(3e4 * 2**-power, rel=ROUNDING)
    assert life(3e4, 1e12) == pytest.approx(3e4, rel=1e-6)


@pytest.mark.parametrize("slopes", [(BALL, ROLLER, BALL), (0.5, 3.0, 1.0), (0.01, 100.0, 1.0)])
def test_a_system_of_several_slopes_survives_by_all(slopes):
    """Failures of a time add up: Σ (L/L_i)^e_i is 1 at the L10 of all."""
    lives = (3e4, 5e4, 8e4)
    together = roll_life.system_life_hours(lives, weibull_slopes=slopes)
    shares = [(together / life) ** slope for life, slope in zip(lives, slopes, strict=True)]
    # a life rounded by one part in 2^53 moves its share by the slope's multiple
    assert sum(shares) == pytest.approx(1.0, rel=max(1.0, *slopes) * ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: roll_life.rating_life_hours(0.0, **ROLL), r"load = 0\.0"),
        (lambda: roll_life.rating_life_hours(1.0, **ROLL, exponent=33.0), r"exponent = 33\.0 .* 3 \(ball\)"),
        (
            lambda: roll_life.heavier_bearing_load(
                1.0, belt_force=1.0, loaded_length=0.6, bearing_distance=0.5, triangular=True
            ),
            r"loaded_length = 0\.6 is not allowed: at most bearing_distance \+ 2 inset = 0\.5 m",
        ),
        (lambda: roll_life.system_life_hours([], weibull_slopes=[]), r"lives = \[\] .* at least one bearing"),
        (lambda: roll_life.system_life_hours([0.0], weibull_slopes=[BALL]), r"lives = 0\.0"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
