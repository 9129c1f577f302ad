"""Random spectra, without noise and with it: that every fit ends, at its minimum, and how long it takes.

    python benchmarks/non_negative.py --spectra 2000

Each spectrum is fitted twice: by the package, and by `scipy.optimize.nnls` alone. Every least
squares problem on the way is judged by the conditions of its minimum, the slope of the error along each
column in units of rounding (2.2e-16).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from conveyor.errors import NoSolutionError
from conveyor.rubber import PronyFit, PronySeries, fit_prony, fit_rows, interconversion, term_count
from conveyor.rubber.non_negative import ROUNDING, largest_slope, non_negative_least_squares

Solver = Callable[[np.ndarray, np.ndarray], np.ndarray]
NOISES = (0.0, 0.0, 0.003, 0.02)


def spectrum(rng: np.random.Generator) -> tuple[PronySeries, np.ndarray]:
    """A series of lines, many or few, of one of four shapes, and frequencies over 4 to 14 decades [Hz]."""
    decades = rng.uniform(4.0, 14.0)
    low = rng.uniform(-8.0, 0.0)
    places = np.sort(rng.uniform(-low - decades - 2.0, -low + 1.0, int(rng.choice([1, 3, 12, 300]))))
    shape = rng.integers(4)
    weights = (
        10.0 ** (-rng.uniform(0.05, 0.9) * (places - places[0])),  # a power law
        10.0 ** -(((places - rng.uniform(places[0], places[-1] + 0.1)) / rng.uniform(0.3, 3.0)) ** 2),
        np.exp(rng.normal(0.0, 1.5, places.size)),
        np.ones_like(places),
    )[shape]
    floor = 10.0 ** rng.uniform(5.5, 7.0)
    moduli = np.maximum(weights / weights.sum(), 1e-30) * floor * 10.0 ** rng.uniform(0.3, 3.5)
    frequency = np.logspace(low, low + decades, int(decades * rng.uniform(3.0, 9.0)))
    return PronySeries(floor, moduli, 10.0**places), frequency


@contextmanager
def solver(used: Solver) -> Iterator[None]:
    """Put a solver in place of the package's."""
    places = (fit_rows, term_count, interconversion)
    for place in places:
        place.non_negative = used
    try:
        yield
    finally:
        for place in places:
            place.non_negative = non_negative_least_squares


def alone(matrix: np.ndarray, target: np.ndarray) -> np.ndarray:
    from scipy.optimize import nnls

    return nnls(matrix, target)[0]


def timed(frequency: np.ndarray, storage: np.ndarray, loss: np.ndarray) -> tuple[PronyFit, float]:
    """A fit, and its processor time [s]."""
    start = time.process_time()
    found = fit_prony(frequency, storage, loss)
    return found, time.process_time() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spectra", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    steepest: list[float] = []

    def judged(matrix: np.ndarray, target: np.ndarray) -> np.ndarray:
        found = non_negative_least_squares(matrix, target)
        steepest.append(largest_slope(matrix, target, found) / ROUNDING)
        if np.any(found < 0.0):
            raise AssertionError("a weight below 0")
        return found

    fit_prony(np.logspace(0, 3, 30), 1e6 + np.logspace(0, 6, 30), np.full(30, 1e5))  # scipy is imported now
    for noise in dict.fromkeys(NOISES):
        seeds = [s for s in range(asked.spectra) if NOISES[s % len(NOISES)] == noise]
        gave_up, fluids, apart, slowest, floors = 0, 0, 0.0, 0.0, []
        spent: list[tuple[float, float]] = []
        steepest.clear()
        for seed in seeds:
            rng = np.random.default_rng([asked.seed, seed])
            series, f = spectrum(rng)
            scatter = 1.0 + noise * rng.standard_normal((2, f.size))
            data = (
                f,
                series.storage(2 * np.pi * f) * scatter[0],
                series.loss(2 * np.pi * f) * scatter[1],
            )

            try:
                new, seconds = timed(*data)
            except NoSolutionError:
                fluids += 1
                continue
            floors.append(new.consistency_floor)
            slowest = max(slowest, seconds)
            try:
                with solver(alone):
                    old, before = timed(*data)
                apart = max(apart, abs(new.residual / old.residual - 1.0))
                spent.append((before, seconds))
            except RuntimeError:
                gave_up += 1
            with solver(judged):
                fit_prony(*data)
        nnls, package = 1e3 * np.mean(spent, axis=0)
        print(
            f"noise {noise:.1%}: {len(seeds)} spectra, {fluids} fluids (no answer, said so)\n"
            f"  nnls alone gives up on {gave_up}, the package on 0\n"
            f"  where both answer: {nnls:.1f} ms (nnls), {package:.1f} ms (package), residuals apart by {apart:.1e}\n"
            f"  slowest fit {1e3 * slowest:.0f} ms; steepest slope of {len(steepest)} minima {max(steepest):.1f}\n"
            f"  best positive spectrum leaves {np.median(floors):.1e} (median), {max(floors):.1e} (most)",
            flush=True,
        )


if __name__ == "__main__":
    main()
