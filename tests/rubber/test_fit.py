"""Fitting: known truth with known noise, invariances, the figures of the shelf, messages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber import PronySeries, fit_prony, read_master_curve

SHELF = Path(__file__).parents[2] / "materials"
TRUTH = PronySeries(3e6, 10 ** np.linspace(8.6, 5.5, 13), np.logspace(-10, 2, 13))
FREQUENCY = np.logspace(-3, 10.5, 84)
"""Hz: 1/omega covers 5e-12 to 160 s, so every time of the truth lies inside the window."""


def data(series: PronySeries, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    omega = 2.0 * np.pi * frequency
    return frequency, series.storage(omega), series.loss(omega)


def noisy(sigma: float, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    f, e1, e2 = data(TRUTH, FREQUENCY)
    return f, e1 * (1 + sigma * rng.standard_normal(f.size)), e2 * (1 + sigma * rng.standard_normal(f.size))


def test_exact_data_give_back_the_series() -> None:
    fit = fit_prony(*data(TRUTH, FREQUENCY), times=TRUTH.times)
    np.testing.assert_allclose(fit.series.moduli, TRUTH.moduli, rtol=1e-10)
    assert fit.series.equilibrium == pytest.approx(TRUTH.equilibrium, rel=1e-10)
    assert (fit.active_terms, fit.grid_terms) == (13, 13)
    assert fit.storage.rms < 1e-12
    assert abs(fit.tan_delta.worst) < 1e-11
    # lines at most half a step, 0.115 in ln(tau), from the truth: two of them stand in for it to 0.115^2/10
    assert fit.consistency_floor < 1e-3


@pytest.mark.parametrize("seed", range(5))
def test_one_percent_noise_is_averaged_down(seed: int) -> None:
    sigma = 0.01
    f, e1, e2 = noisy(sigma, seed)
    fit = fit_prony(f, e1, e2, times=TRUTH.times)
    rows, unknowns = 2 * f.size, 14
    # least squares leaves sigma sqrt(1 - p/N); its scatter is sigma/sqrt(2N), five of them allowed
    spread = 5 * sigma / np.sqrt(2 * rows)
    assert fit.residual == pytest.approx(sigma * np.sqrt(1 - unknowns / rows), abs=spread)
    # against the truth: chi-square of 14 unknowns over N rows; 4 times its mean has a chance of 1e-6
    omega = 2 * np.pi * f
    _, true1, true2 = data(TRUTH, f)
    error = np.concatenate([fit.series.storage(omega) / true1, fit.series.loss(omega) / true2]) - 1
    assert np.sqrt(np.mean(error**2)) < 2 * sigma * np.sqrt(unknowns / rows)
    # E_e: some 10 rows on the plateau, so about sigma/sqrt(10); five of them allowed
    assert fit.series.equilibrium == pytest.approx(TRUTH.equilibrium, rel=5 * sigma / np.sqrt(10))
    # consistent data: the floor is the noise, less what up to 60 lines of the dense spectrum can absorb
    assert 0.7 * sigma < fit.consistency_floor < fit.residual + 1e-4


def test_contradicting_loss_shows_in_the_floor() -> None:
    f, e1, e2 = data(TRUTH, FREQUENCY)
    honest = fit_prony(f, e1, e2, times=TRUTH.times)
    wrong = fit_prony(f, e1, 1.3 * e2, times=TRUTH.times)
    # scaling E'' by 1.3 leaves at best a compromise: 0 % and 30 % cannot both be met
    assert honest.consistency_floor < 1e-3
    assert wrong.consistency_floor > 0.05


def test_order_of_rows_does_not_matter() -> None:
    f, e1, e2 = noisy(0.02, 3)
    order = np.random.default_rng(1).permutation(f.size)
    a, b = fit_prony(f, e1, e2), fit_prony(f[order], e1[order], e2[order])
    np.testing.assert_array_equal(a.series.moduli, b.series.moduli)


def test_repeated_rows_weigh_as_often_as_they_stand() -> None:
    f, e1, e2 = noisy(0.02, 4)
    once = fit_prony(f, e1, e2)
    twice = fit_prony(np.tile(f, 2), np.tile(e1, 2), np.tile(e2, 2))
    np.testing.assert_allclose(twice.series.moduli, once.series.moduli, rtol=1e-10)
    assert twice.storage.rms == pytest.approx(once.storage.rms, rel=1e-10)


def test_units_of_modulus_and_time_scale_out() -> None:
    f, e1, e2 = noisy(0.02, 5)
    base, scaled = fit_prony(f, e1, e2), fit_prony(f * 1e3, e1 * 7.0, e2 * 7.0)
    np.testing.assert_allclose(scaled.series.moduli, base.series.moduli * 7.0, rtol=1e-9)
    np.testing.assert_allclose(scaled.series.times, base.series.times / 1e3, rtol=1e-9)
    np.testing.assert_allclose(scaled.tan_delta.rms, base.tan_delta.rms, rtol=1e-9)


def test_frequency_is_cyclic() -> None:
    single = PronySeries(1e6, [1e6], [1e-2])
    fit = fit_prony(*data(single, np.logspace(-1, 4, 40)), times=[1e-2])
    # E'' peaks at f = 1/(2 pi tau) = 15.9 Hz, not at 100 Hz
    assert fit.series.times.tolist() == [1e-2]
    assert fit.series.moduli[0] == pytest.approx(1e6, rel=1e-12)


def test_default_times_stay_inside_the_window() -> None:
    fit = fit_prony(*noisy(0.01, 6))
    assert fit.series.times[0] >= 1 / (2 * np.pi * FREQUENCY[-1]) * (1 - 1e-12)
    assert fit.series.times[-1] <= 1 / (2 * np.pi * FREQUENCY[0]) * (1 + 1e-12)
    assert fit.grid_terms == round(13.5) + 1
    assert fit.window == (FREQUENCY[0], FREQUENCY[-1])


def test_held_equilibrium_allows_slow_times() -> None:
    f, e1, e2 = data(TRUTH, FREQUENCY)
    fit = fit_prony(f, e1, e2, times=np.append(TRUTH.times, 1e5), equilibrium=3e6)
    assert fit.series.equilibrium == 3e6
    np.testing.assert_allclose(fit.series.moduli[:13], TRUTH.moduli, rtol=1e-9)
    with pytest.raises(InputError, match=r"times: 100000 s is outside the window .* hold equilibrium=<Pa>"):
        fit_prony(f, e1, e2, times=[1.0, 1e5])


@pytest.mark.parametrize(
    ("name", "equilibrium", "storage", "loss"), [("s100", 4.01, 0.058, 0.28), ("s120", 3.03, 0.084, 0.071)]
)
def test_figures_of_the_shelf(name: str, equilibrium: float, storage: float, loss: float) -> None:
    """One term a decade inside the window: S120 8.4 / 7.1 %, S100 5.8 / 28 % rms of E' / E''."""
    curve = read_master_curve(SHELF / f"{name}.dma.csv")
    fit = fit_prony(curve.frequency_Hz, curve.storage_Pa, curve.loss_Pa)
    assert round(fit.series.equilibrium / 1e6, 2) == equilibrium
    assert float(f"{fit.storage.rms:.2g}") == storage
    assert float(f"{fit.loss.rms:.2g}") == loss
    # more terms hardly help: the floor of all positive spectra is close
    assert 0.85 * fit.residual < fit.consistency_floor < fit.residual


def test_misfits_are_what_they_say() -> None:
    f, e1, e2 = noisy(0.02, 8)
    fit = fit_prony(f, e1, e2)
    omega = 2 * np.pi * f
    error = fit.series.tan_delta(omega) / (e2 / e1) - 1
    k = int(np.argmax(np.abs(error)))
    assert fit.tan_delta.rms == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)
    assert fit.tan_delta.worst == pytest.approx(error[k], rel=1e-9)
    assert fit.tan_delta.worst_frequency == f[k]
    both = (fit.storage.rms**2 + fit.loss.rms**2) / 2
    assert fit.residual == pytest.approx(np.sqrt(both), rel=1e-12)
    assert fit.condition >= 1.0


def test_a_fluid_is_refused_with_advice() -> None:
    x = 2 * np.pi * np.logspace(-1, 3, 30) * 1e-2
    maxwell = 1e6 * x * x / (1 + x * x), 1e6 * x / (1 + x * x)
    with pytest.raises(
        NoSolutionError, match=r"equilibrium modulus is 0 \(a fluid\): .* hold it with equilibrium="
    ):
        fit_prony(np.logspace(-1, 3, 30), *maxwell, times=[1e-2])


GOOD = ([1.0, 10.0, 100.0], [1e6, 2e6, 3e6], [1e5, 2e5, 3e5])


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        (0, float("nan"), r"row 2: frequency = nan Hz must be finite and > 0"),
        (0, 0.0, r"row 2: frequency = 0 Hz"),
        (1, -1.0, r"row 2 \(frequency 10 Hz\): storage = -1 Pa must be finite and > 0"),
        (2, 0.0, r"row 2 \(frequency 10 Hz\): loss = 0 Pa"),
        (2, float("inf"), r"row 2 \(frequency 10 Hz\): loss = inf Pa"),
    ],
)
def test_bad_rows_are_named(column: int, value: float, message: str) -> None:
    columns = [list(c) for c in GOOD]
    columns[column][1] = value
    with pytest.raises(InputError, match=message):
        fit_prony(*columns)


def test_other_refusals() -> None:
    f, e1, e2 = GOOD
    with pytest.raises(
        InputError, match=r"one shape \(n,\); got frequency \(3,\), storage \(2,\), loss \(3,\)"
    ):
        fit_prony(f, e1[:2], e2)
    with pytest.raises(InputError, match=r"at least 2 distinct frequencies; got 1"):
        fit_prony([1.0, 1.0], [1e6, 1e6], [1e5, 1e5])
    with pytest.raises(InputError, match=r"terms_per_decade = 0 1/decade must be finite and > 0"):
        fit_prony(f, e1, e2, terms_per_decade=0.0)
    with pytest.raises(
        InputError, match=r"equilibrium = 1e\+06 Pa must be below the smallest storage modulus"
    ):
        fit_prony(f, e1, e2, equilibrium=1e6)
    with pytest.raises(InputError, match=r"times\[0\] = -1 s must be > 0"):
        fit_prony(f, e1, e2, times=[-1.0])
