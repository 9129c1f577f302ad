"""The factor that rolling-resistance tests put on calculated indentation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.rubber.rolling_test_factor import (
    BAND_PER_KELVIN,
    BAND_PER_LOAD,
    DEVIATIONS_OF_90_PERCENT,
    fit_test_factor,
)

LOADS = np.array([1e3, 2e3, 4e3, 8e3])


def test_a_law_in_load_and_temperature_comes_back():
    # ratio 2 (w/2000)^-0.1 at 0 degC, 1.5 of the same at 20 degC
    w = np.tile(LOADS, 2)
    at = np.repeat([273.15, 293.15], 4)
    ratio = np.repeat([2.0, 1.5], 4) * (w / 2e3) ** -0.1
    anchor = fit_test_factor(w, at, ratio, uncertainty=0.08)
    assert anchor.slope == pytest.approx(-0.1)
    assert anchor.points == 8
    assert anchor.half_width == pytest.approx(0.08)
    assert anchor.factor([2e3, 8e3], 273.15) == pytest.approx([2.0, 2.0 * 4.0**-0.1])
    # half way between the temperatures the geometric mean
    assert anchor.factor(2e3, 283.15) == pytest.approx(math.sqrt(2.0 * 1.5))
    # held beyond temperatures and loads
    assert anchor.factor(16e3, 330.0) == pytest.approx(anchor.factor(8e3, 293.15))
    assert anchor.factor(100.0, 250.0) == pytest.approx(anchor.factor(1e3, 273.15))


def test_the_band_widens_beyond_the_tests():
    anchor = fit_test_factor(LOADS, np.full(4, 293.15), np.full(4, 2.0), uncertainty=0.1)
    assert anchor.band(2e3, 293.15) == pytest.approx(0.1)
    assert anchor.band(2e3, 273.15) == pytest.approx(math.hypot(0.1, 20.0 * BAND_PER_KELVIN))
    assert anchor.band(16e3, 293.15) == pytest.approx(math.hypot(0.1, BAND_PER_LOAD * math.log(2.0)))
    assert anchor.band(500.0, 293.15) == pytest.approx(anchor.band(16e3, 293.15))
    assert anchor.tested_at(294.0)
    assert not anchor.tested_at(280.0)


def test_residuals_are_in_the_band():
    # four tests at one load and temperature: level and scatter of a sample, three degrees of freedom
    y = np.array([0.5, 0.7, 0.6, 0.8])
    anchor = fit_test_factor(np.full(4, 2e3), np.full(4, 293.15), np.exp(y), uncertainty=0.0)
    assert anchor.slope == 0.0
    assert anchor.factor(2e3, 293.15) == pytest.approx(math.exp(y.mean()))
    assert anchor.half_width == pytest.approx(DEVIATIONS_OF_90_PERCENT * y.std(ddof=1))


def test_near_loads_have_no_slope_and_near_temperatures_are_one():
    anchor = fit_test_factor([2e3, 2.5e3], [292.5, 293.5], [2.0, 3.0], uncertainty=0.1)
    assert anchor.slope == 0.0
    assert anchor.temperatures == pytest.approx([293.0])
    assert anchor.factor(2.2e3, 293.0) == pytest.approx(math.sqrt(6.0))


def test_one_load_at_each_temperature_tells_levels_only():
    anchor = fit_test_factor([1e3, 4e3], [273.15, 293.15], [2.0, 3.0], uncertainty=0.1)
    assert anchor.slope == 0.0
    assert anchor.factor(2e3, 273.15) == pytest.approx(2.0)
    # three rows, two levels, loads bound to levels but for one: a slope can be told
    sloped = fit_test_factor([1e3, 4e3, 4e3], [273.15, 273.15, 293.15], [2.0, 1.0, 3.0], uncertainty=0.1)
    assert sloped.slope == pytest.approx(-0.5)


def test_order_of_the_tests_does_not_matter():
    rng = np.random.default_rng(5)
    w, at = rng.uniform(1e3, 8e3, 12), np.repeat([263.15, 283.15, 303.15], 4)
    ratio = rng.uniform(1.5, 2.5, 12)
    mixed = rng.permutation(12)
    one = fit_test_factor(w, at, ratio, uncertainty=0.1)
    other = fit_test_factor(w[mixed], at[mixed], ratio[mixed], uncertainty=0.1)
    assert one.factor(3e3, 270.0) == pytest.approx(other.factor(3e3, 270.0))
    assert one.half_width == pytest.approx(other.half_width)


def test_what_belts_tested_alike_share_is_not_their_own():
    """Parts of an error that are independent add as squares: 0.13^2 = 0.05^2 + 0.12^2."""
    given = [1e3, 2e3, 4e3], [293.15] * 3, [2.0] * 3
    anchor = fit_test_factor(*given, uncertainty=0.13, shared=0.12)
    assert anchor.own_half_width == pytest.approx(0.05, rel=1e-12)
    assert anchor.half_width == pytest.approx(0.13, rel=1e-12)
    assert fit_test_factor(*given, uncertainty=0.13).own_half_width == pytest.approx(0.13, rel=1e-12)
    assert fit_test_factor(*given, uncertainty=0.13, shared=0.13).own_half_width == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize(
    ("given", "match"),
    [
        (([1e3, -1.0], [293.0, 293.0], [2.0, 2.0]), "line_load"),
        (([1e3], [0.0], [2.0]), "temperature"),
        (([1e3], [293.0], [math.inf]), "ratio"),
        (([1e3, 2e3], [293.0], [2.0, 2.0]), "one length"),
        (([], [], []), "one length"),
    ],
)
def test_bad_tests_are_refused(given, match):
    with pytest.raises(InputError, match=match):
        fit_test_factor(*given, uncertainty=0.1)
    with pytest.raises(InputError, match="uncertainty"):
        fit_test_factor([1e3], [293.0], [2.0], uncertainty=-0.1)
    with pytest.raises(InputError, match=r"shared: got 0\.2, allowed: >= 0 and <= uncertainty = 0\.1"):
        fit_test_factor([1e3], [293.0], [2.0], uncertainty=0.1, shared=0.2)
