"""Bootstrap replicas: coverage of a known truth, determinism, invariances, limits, messages."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.rubber import PronyFit, PronySeries, fit_prony
from conveyor.rubber import band as module
from conveyor.rubber.band import ReplicaBand, bootstrap
from conveyor.rubber.master_curve import Isotherm, Superposition
from conveyor.rubber.time_temperature import superpose

TRUTH = PronySeries(3e6, 10 ** np.linspace(8.6, 5.5, 25) / 2, np.logspace(-10, 2, 25))
FREQUENCY = np.logspace(-3, 10.5, 84)
OMEGA = 2 * np.pi * FREQUENCY


def fitted(storage_noise: float, loss_noise: float, seed: int) -> PronyFit:
    rng = np.random.default_rng(seed)
    a, b = (np.exp(s * rng.standard_normal(84) - s * s / 2) for s in (storage_noise, loss_noise))
    return fit_prony(FREQUENCY, TRUTH.storage(OMEGA) * a, TRUTH.loss(OMEGA) * b)


@pytest.mark.parametrize("noise", [(0.01, 0.01), (0.02, 0.05), (0.05, 0.28)])
def test_ninety_per_cent_band_covers_the_truth(noise: tuple[float, float]) -> None:
    inside = []
    for seed in range(12):
        band = bootstrap(fitted(*noise, seed), replicas=100)
        for (low, high), truth in (
            (band.between(lambda s: s.storage(OMEGA)), TRUTH.storage(OMEGA)),
            (band.between(lambda s: s.loss(OMEGA)), TRUTH.loss(OMEGA)),
        ):
            inside.append(np.mean((low < truth) & (truth < high)))
    # 24 curves of about 10 independent stretches: 90 % to within 2 %; measured 86 to 95 %; four of them
    assert 0.80 < np.mean(inside) < 0.99


def test_band_is_as_wide_as_the_noise() -> None:
    widths = []
    for noise in (0.01, 0.02, 0.04):
        low, high = bootstrap(fitted(noise, noise, 1), replicas=100).between(lambda s: s.loss(OMEGA))
        widths.append(float(np.mean((high - low) / TRUTH.loss(OMEGA))))
    # proportional, but for the number of terms that the noise allows
    assert widths[1] / widths[0] == pytest.approx(2.0, rel=0.4)
    assert widths[2] / widths[1] == pytest.approx(2.0, rel=0.4)


def test_exact_data_leave_no_band() -> None:
    fit = fit_prony(FREQUENCY, TRUTH.storage(OMEGA), TRUTH.loss(OMEGA), times=TRUTH.times)
    band = bootstrap(fit, replicas=5)
    np.testing.assert_allclose(band.moduli, np.tile(TRUTH.moduli, (5, 1)), rtol=1e-7)
    np.testing.assert_allclose(band.equilibrium, 3e6, rtol=1e-9)


def test_one_seed_one_band() -> None:
    fit = fitted(0.02, 0.05, 2)
    a, b, c = (
        bootstrap(fit, replicas=8, seed=4),
        bootstrap(fit, replicas=8, seed=4),
        bootstrap(fit, replicas=8),
    )
    rounding = 1e-9 * a.moduli.max()  # a fit's condition of 1e6
    assert b.moduli == pytest.approx(a.moduli, rel=1e-9, abs=rounding)
    assert np.abs(c.moduli - a.moduli).max() > 1e-3 * a.moduli.max()
    assert bootstrap(fit, replicas=3, seed=4).moduli == pytest.approx(a.moduli[:3], rel=1e-9, abs=rounding)
    assert a.times == pytest.approx(fit.series.times, rel=1e-15)


def test_units_scale_out() -> None:
    fit = fitted(0.02, 0.05, 3)
    rows = fit.rows
    other = fit_prony(rows.frequency * 1e3, rows.storage * 7.0, rows.loss * 7.0)
    a, b = bootstrap(fit, replicas=4), bootstrap(other, replicas=4)
    np.testing.assert_allclose(b.equilibrium, 7.0 * a.equilibrium, rtol=1e-7)
    np.testing.assert_allclose(b.moduli, 7.0 * a.moduli, rtol=1e-6, atol=1.0)


def test_a_held_equilibrium_stays_held() -> None:
    f, e1, e2 = FREQUENCY, TRUTH.storage(OMEGA), TRUTH.loss(OMEGA)
    noise = np.exp(0.03 * np.random.default_rng(0).standard_normal(84))
    band = bootstrap(fit_prony(f, e1, e2 * noise, equilibrium=2.9e6), replicas=6)
    np.testing.assert_array_equal(band.equilibrium, 2.9e6)


def test_series_are_the_replicas() -> None:
    band = ReplicaBand([1e-3, 1.0], [1e6, 2e6], [[1e6, 0.0], [2e6, 1e6]])
    one, two = band.series()
    assert (one.equilibrium, one.moduli.tolist(), one.times.tolist()) == (1e6, [1e6], [1e-3])
    assert two.moduli.tolist() == [2e6, 1e6]
    for name in ("storage", "loss", "tan_delta"):
        low, high = band.between(lambda s, name=name: getattr(s, name)([10.0, 1e3]), level=0.5)
        both = np.array([getattr(s, name)([10.0, 1e3]) for s in (one, two)])
        # a third draw lies between two with a chance of a third: the half between their outermost ones
        np.testing.assert_allclose(low, both.min(axis=0), rtol=1e-12)
        np.testing.assert_allclose(high, both.max(axis=0), rtol=1e-12)


def test_draws_that_are_fluids_are_refused_or_drawn_again() -> None:
    x = np.logspace(-1, 3, 30) * 2 * np.pi * 1e-2
    rng = np.random.default_rng(5)
    noise = np.exp(0.2 * rng.standard_normal((2, 30)))
    weak = PronySeries(3e2, [1e6], [1e-2])
    fit = fit_prony(
        x / (2 * np.pi * 1e-2),
        weak.storage(x / 1e-2) * noise[0],
        weak.loss(x / 1e-2) * noise[1],
        times=[1e-2],
    )
    assert (bootstrap(fit, replicas=50).equilibrium > 0.0).all()


def test_refusals() -> None:
    with pytest.raises(InputError, match=r"replicas: got 0, allowed: a whole number >= 1"):
        bootstrap(fitted(0.02, 0.02, 1), replicas=0)
    with pytest.raises(InputError, match=r"shape \(1, 2\); got \(1, 1\)"):
        ReplicaBand([1.0, 2.0], [1e6], [[1.0]])
    with pytest.raises(InputError, match=r"moduli\[0\]\[1\]: got -1 Pa, allowed: >= 0 Pa"):
        ReplicaBand([1.0, 2.0], [1e6], [[1.0, -1.0]])
    with pytest.raises(InputError, match=r"times of a band must ascend"):
        ReplicaBand([2.0, 1.0], [1e6], [[1.0, 1.0]])
    with pytest.raises(InputError, match=r"equilibrium\[0\]: got 0 Pa, allowed: > 0 Pa"):
        ReplicaBand([1.0, 2.0], [0.0], [[1.0, 1.0]])
    with pytest.raises(InputError, match=r"level: got 1\.0, allowed: > 0 and < 1"):
        ReplicaBand([1.0], [1e6], [[1.0]]).between(lambda s: s.loss([1.0]), level=1.0)


def isotherms(seed: int) -> Superposition:
    rng = np.random.default_rng(seed)
    f, found = np.logspace(-1, 2, 10), []
    for t, shift in ((283.0, 1.2), (293.0, 0.0), (303.0, -1.0)):
        omega = 2 * np.pi * f * 10.0**shift
        noise = np.exp(0.02 * rng.standard_normal((2, 10)))
        found.append(Isotherm(t, f, TRUTH.storage(omega) * noise[0], TRUTH.loss(omega) * noise[1]))
    return superpose(found, 293.0)


def test_replicas_of_isotherms_carry_their_shifts() -> None:
    shifted = isotherms(1)
    fit = fit_prony(shifted.frequency, shifted.storage, shifted.loss)
    band = bootstrap(fit, shifted, replicas=200)
    assert band.log10_a_T is not None
    assert band.log10_b_T is None
    np.testing.assert_array_equal(band.log10_a_T[:, 1], 0.0)
    assert np.all(np.diff(band.log10_a_T, axis=1) < 0.0)
    # 200 draws tell a standard deviation to 5 %, a mean to 7 % of one; four of them
    spread = band.log10_a_T.std(axis=0)
    np.testing.assert_allclose(spread, shifted.log10_a_T_error, rtol=0.2)
    np.testing.assert_allclose(
        band.log10_a_T.mean(axis=0), shifted.log10_a_T, atol=0.28 * float(shifted.log10_a_T_error.max())
    )
    with pytest.raises(InputError, match=r"the superposition has 30 rows, the fit 84: fit its master curve"):
        bootstrap(fitted(0.02, 0.02, 1), shifted)


def test_a_contradiction_is_in_the_band() -> None:
    """E'' measured 30 % too high: a fit that believes E' passes 23 % below it, one that believes E'' does not."""
    e1, e2 = TRUTH.storage(OMEGA), TRUTH.loss(OMEGA)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal((2, 84)))
    widths = []
    for factor in (1.0, 1.3):
        band = bootstrap(fit_prony(FREQUENCY, e1 * noise[0], factor * e2 * noise[1]))
        low, high = band.between(lambda s: s.loss(OMEGA))
        widths.append(float(np.mean((high - low) / e2)))
    assert widths[0] < 0.05
    assert widths[1] > 0.1


def test_what_the_data_do_not_reach_is_less_certain() -> None:
    fit = fitted(0.02, 0.02, 1)
    # the fast end is no example: this truth has no line beyond it, and the data say so
    at = 2 * np.pi * np.array([FREQUENCY[0] / 5.0, 1e3])
    low, high = bootstrap(fit).between(lambda s: s.loss(at))
    width = (high - low) / fit.series.loss(at)
    assert width[0] > 2.0 * width[1]


def test_blocks_are_as_long_as_errors_hang_together():
    # runs of 10 of one sign: of 79 neighbours 72 agree, 65/80 = 0.8125, and (1 + 0.8125)/(1 - 0.8125) = 9.7
    runs = np.tile(np.repeat([0.01, -0.01], 10), 4)
    _, block = module._resampling_ratios(1.0 + np.concatenate([runs, runs]), np.zeros(160))
    assert block == 10


def test_what_the_fit_took_of_an_error_is_given_back():
    # a row that the fit follows by half leaves errors of sqrt(1 - 1/2) of their size
    signs = np.tile([0.01, -0.01], 20)
    drawn, block = module._resampling_ratios(np.exp(np.concatenate([signs, signs])), np.full(80, 0.5))
    assert block == 1
    spread = np.log(drawn[:, 0] / drawn[:, 1])
    assert spread == pytest.approx(np.full(2, 0.02 * module.RESIDUAL_WIDENING / np.sqrt(0.5)), rel=1e-9)
