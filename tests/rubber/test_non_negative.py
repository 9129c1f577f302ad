"""Non-negative least squares: the minimum by its own conditions, on columns that are nearly dependent too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.laboratory import read_dma
from conveyor.rubber import PronySeries, fit_prony
from conveyor.rubber.fit_rows import debye_kernel
from conveyor.rubber.non_negative import active_set, largest_slope, non_negative_least_squares

FITS = Path(__file__).parents[1] / "laboratory" / "files" / "fits"


@pytest.mark.parametrize("solver", [non_negative_least_squares, active_set])
def test_by_hand(solver) -> None:  # type: ignore[no-untyped-def]
    # the second column alone gives 1/2, the first 2 and -1 remains; a column of zeros takes nothing
    matrix = np.array([[1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    assert solver(matrix, np.array([2.0, -1.0])) == pytest.approx([2.0, 0.0, 0.0], abs=1e-15)
    assert solver(matrix, np.array([3.0, 1.0])) == pytest.approx([2.0, 1.0, 0.0], rel=1e-14)
    assert solver(matrix, np.array([-1.0, -1.0])) == pytest.approx([0.0, 0.0, 0.0], abs=0.0)


def test_what_is_no_minimum_is_told() -> None:
    matrix, target = np.eye(2), np.array([1.0, 1.0])
    assert largest_slope(matrix, target, np.array([1.0, 1.0])) == 0.0
    # the error along the second column is 1, |target| + weights sqrt(2) + 1
    assert largest_slope(matrix, target, np.array([1.0, 0.0])) == pytest.approx(1.0 / (np.sqrt(2.0) + 1.0), rel=1e-14)
    assert largest_slope(matrix, target, np.array([2.0, 1.0])) == pytest.approx(1.0 / (np.sqrt(2.0) + 3.0), rel=1e-14)


def test_an_answer_that_is_no_minimum_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("scipy.optimize.nnls", lambda matrix, _: (np.zeros(matrix.shape[1]), 0.0))
    assert non_negative_least_squares(np.eye(2), np.array([1.0, 2.0])) == pytest.approx([1.0, 2.0], rel=1e-14)


@pytest.mark.parametrize("seed", range(12))
def test_dense_spectra_reach_their_minimum(seed: int) -> None:
    """Ten lines a decade: condition numbers of 1e16 and more, half of them free of noise."""
    rng = np.random.default_rng(seed)
    omega = np.logspace(0.0, rng.uniform(4.0, 10.0), 40)
    tau = np.logspace(3.0, -13.0, 161)
    weights = tau ** -rng.uniform(0.05, 0.5) * rng.uniform(0.5, 2.0, tau.size)
    data = debye_kernel(omega, tau) @ np.concatenate([[1.0], weights])
    scatter = 1.0 + 0.01 * (seed % 2) * rng.standard_normal(data.size)
    matrix = debye_kernel(omega, tau) / data[:, None]
    for solver in (non_negative_least_squares, active_set):
        found = solver(matrix, scatter)
        assert np.all(found >= 0.0)
        assert largest_slope(matrix, scatter, found) <= 1e-12
        if not seed % 2:  # the truth lies on the grid: what is left is a thousandth of the printed digits
            assert np.sqrt(np.mean((matrix @ found - scatter) ** 2)) < 1e-6


@pytest.mark.parametrize(
    ("name", "floor"),
    # ten digits printed; 1 % of noise
    [("noise_free_power_law.csv", 1e-7), ("stretched_exponential.csv", 0.012)],
)
def test_clean_files_are_fitted(name: str, floor: float) -> None:
    read = read_dma(FITS / name)
    fit = fit_prony(read.frequency, read.storage, read.loss)
    assert fit.consistency_floor < floor
    assert fit.residual < 0.012


def test_a_clean_workbook_becomes_a_compound() -> None:
    request = Request(name="stretched", reference_temperature="20 degC", reading={"letter": "E"})
    assert fit_file(FITS / "stretched_exponential.xlsx", request).fit.residual < 0.05


def test_data_without_noise_fit_to_rounding() -> None:
    truth = PronySeries(2e6, np.logspace(7.0, 5.0, 9), np.logspace(-6.0, 2.0, 9))
    f = np.logspace(-3.5, 6.5, 60)
    omega = 2.0 * np.pi * f
    fit = fit_prony(f, truth.storage(omega), truth.loss(omega), times=truth.times)
    assert fit.residual < 1e-13
    assert fit.series.moduli == pytest.approx(truth.moduli, rel=1e-11)
