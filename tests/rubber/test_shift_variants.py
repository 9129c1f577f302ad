"""Isotherms whose E' and E'' ask for different shifts: the spread is in the error, and the cause is named."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.rubber import WLF, PronySeries, superpose
from conveyor.rubber.master_curve import Isotherm

FREQUENCY = np.geomspace(1.0, 50.0, 10)
TEMPERATURES = 273.15 + np.arange(-10.0, 47.0, 7.0)
LAW = WLF(6.0, 150.0, 293.15)
SERIES = PronySeries(5e6, np.geomspace(4e5, 4e6, 13), np.geomspace(1.0, 1e-8, 13))
TRUE_SHIFT = np.array([LAW.log10_a_T(t) for t in TEMPERATURES.tolist()])


def isotherms(*, phase: float = 0.0, clamps: float = 0.0, noise: float = 0.002, seed: int = 1) -> list[Isotherm]:
    """Sweeps of a known rubber: E'' grows by `phase` a decade, both moduli by `clamps` per 10 K of cold."""
    random = np.random.default_rng(seed)
    made = []
    for t, shift in zip(TEMPERATURES.tolist(), TRUE_SHIFT.tolist(), strict=True):
        omega = 2.0 * np.pi * FREQUENCY * 10.0**shift
        stiff = (1.0 + clamps) ** ((293.15 - t) / 10.0)
        scatter = random.normal(1.0, [[noise], [5.0 * noise]], (2, FREQUENCY.size))
        loss = SERIES.loss(omega) * (1.0 + phase) ** np.log10(FREQUENCY)
        made.append(Isotherm(t, FREQUENCY, stiff * SERIES.storage(omega) * scatter[0], stiff * loss * scatter[1]))
    return made


@pytest.mark.parametrize("seed", range(4))
def test_a_clean_rubber_has_no_contradiction(seed):
    """Its variants agree within chance, and its errors are those of scatter and overlap alone."""
    made = superpose(isotherms(seed=seed), 293.15)
    assert made.contradicting == ()
    for slope in (made.phase_slope, made.cold_slope):
        assert abs(slope.slope) < 4.0 * slope.error
    assert np.max(made.log10_a_T_error) < 0.05
    assert np.array_equal(made.joint_covariance, made.own_covariance)


def test_errors_of_the_slopes_are_true():
    """Of twenty clean rubbers the slopes over their errors scatter as a standard normal number does."""
    found = [superpose(isotherms(seed=seed, noise=0.004), 293.15) for seed in range(20)]
    for slopes in ([one.phase_slope for one in found], [one.cold_slope for one in found]):
        z = np.array([slope.slope / slope.error for slope in slopes])
        # chi squared of 20: 99.98 % lie within 4.9 and 49.6
        assert 4.9 < z @ z < 49.6
        assert not any(slope.found for slope in slopes) or np.mean(np.abs(z) > 2.576) <= 0.15


@pytest.mark.parametrize("phase", [0.05, 0.15])
def test_a_phase_error_is_named_with_its_slope(phase):
    """With the slope the shifts are true; without it they are others, and their error holds the difference."""
    made = superpose(isotherms(phase=phase), 293.15)
    slope = made.phase_slope
    assert slope.slope == pytest.approx(np.log1p(phase), abs=4.0 * slope.error)
    assert slope.found
    assert not made.cold_slope.found
    (freed,) = made.contradicting
    assert (freed.trends, freed.phase_slope) == (("phase",), slope.slope)
    assert freed.log10_a_T == pytest.approx(TRUE_SHIFT, abs=0.03)
    assert np.all(np.abs(made.log10_a_T - TRUE_SHIFT) <= 1.645 * made.log10_a_T_error + 0.01)


@pytest.mark.parametrize("clamps", [0.04, 0.08])
def test_clamps_that_stiffen_the_cold_are_in_the_error(clamps):
    made = superpose(isotherms(clamps=clamps), 293.15)
    slope = made.cold_slope
    assert slope.slope == pytest.approx(np.log1p(clamps), abs=4.0 * slope.error)
    assert not made.phase_slope.found
    (freed,) = made.contradicting
    assert freed.trends == ("cold",)
    assert freed.log10_b_T == pytest.approx(np.log10(1.0 + clamps) * (293.15 - TEMPERATURES) / 10.0, abs=0.01)
    assert np.all(np.abs(made.log10_a_T - TRUE_SHIFT) <= 1.645 * made.log10_a_T_error + 0.01)


def test_both_errors_are_told_apart():
    made = superpose(isotherms(phase=0.1, clamps=0.04), 293.15)
    for slope, true in ((made.phase_slope, 0.1), (made.cold_slope, 0.04)):
        assert slope.slope == pytest.approx(np.log1p(true), abs=4.0 * slope.error)
    (freed,) = made.contradicting
    assert freed.trends == ("phase", "cold")
    assert freed.log10_a_T == pytest.approx(TRUE_SHIFT, abs=0.03)


def test_draws_take_the_chosen_shifts_and_those_that_contradict_them():
    """Half each; a vertical shift is the rubber's in half of the latter."""
    made = superpose(isotherms(phase=0.1, clamps=0.04), 293.15)
    generator = np.random.default_rng(5)
    draws = [one for _ in range(400) for one in made.drawn(generator)]
    freed = [one for one in draws if one.phase_slope]
    # 400 pairs: three standard deviations of a binomial distribution are 7.5 %
    assert len(freed) / len(draws) == pytest.approx(0.5, abs=0.075)
    assert np.mean([one.vertical for one in freed]) == pytest.approx(0.5, abs=0.11)
    assert all(one.vertical for one in draws if not one.phase_slope)
    mean = np.mean([one.shifts[0] for one in freed], axis=0)
    assert mean == pytest.approx(made.contradicting[0].log10_a_T, abs=0.01)


def test_variants_are_the_other_moduli_and_vertical_shifts():
    made = superpose(isotherms(), 293.15, by="storage")
    placements = [(one.by, one.vertical) for one in made.variants]
    assert placements == [("both", False), ("loss", False), ("both", True)]


def test_vertical_shifts_leave_no_trend_with_cold():
    made = superpose(isotherms(phase=0.05, clamps=0.04), 293.15, vertical=True)
    assert made.cold_slope is None
    assert made.phase_slope.slope == pytest.approx(np.log1p(0.05), abs=4.0 * made.phase_slope.error)
