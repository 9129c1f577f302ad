"""Whether a finer tolerance ever makes an answer worse: scenes solved to rtol 1e-2, 1e-3 … 1e-12.

    python benchmarks/tolerances.py [N]

N scenes, of stress.py (seed 606), loose.py (seed 5) and the paper's sweep in turn. The true error of each is that
against the answer of the smallest estimate. Printed: how often it exceeds its estimate, how often it rises by more
than that as the tolerance falls, statuses, and processor time.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
import time
from collections import Counter
from itertools import product

import loose
import numpy as np
import stress

from conveyor.contact import ContactProblem, ContactSolution, CreepSpectrum, Status, solve, solve_many
from conveyor.errors import NoSolutionError

COUNT = 500
TOLERANCES = [10.0**-k for k in range(2, 13)]


def paper_sweep() -> list[ContactProblem]:
    """336 scenes of the paper's figures: four radii, three thicknesses, four loads, seven speeds; E∞/E0 10."""
    every = product((0.1, 0.2, 0.3, 0.4), (0.8, 1.0, 2.0), (0.01, 0.05, 0.1, 0.13), np.geomspace(0.01, 30.0, 7))
    return [ContactProblem("free", r, p, CreepSpectrum(0.1, [0.9], [zeta]), kh) for r, kh, p, zeta in every]


def scenes(count: int) -> list[ContactProblem]:
    """The first of each kind, in turn."""
    sharp, paper = loose.scenes(5), paper_sweep()
    found: list[ContactProblem] = []
    for i in range(-(-count // 3)):
        extreme = stress.random_problem(np.random.default_rng([606, i]))
        found += [extreme, sharp[i % len(sharp)], paper[(5 * i) % len(paper)]]
    return found[:count]


def answer(found: ContactSolution) -> tuple[float, float] | None:
    """Friction and its estimate; None where there is no contact."""
    try:
        return found.friction, found.error_estimate
    except NoSolutionError:
        return None


def rises(problem: ContactProblem) -> tuple[int, int, int, list[Status], list[float]]:
    """Answers above their estimate, rises by more than it, answers; statuses and processor times by tolerance."""
    found, seconds = [], []
    for rtol in TOLERANCES:
        began = time.process_time()
        found.append(solve(problem, rtol, throw=False))
        seconds.append(time.process_time() - began)
    told = [figures for one in found if (figures := answer(one)) is not None]
    if not told:
        return 0, 0, 0, [one.status for one in found], seconds
    friction, estimate = np.array(told).T
    best = int(estimate.argmin())
    off = np.abs(friction - friction[best]) / (abs(friction[best]) or 1.0)
    allowed = estimate + estimate[best]
    above, risen = int((off > allowed).sum()), int((np.diff(off) > allowed[1:]).sum())
    return above, risen, off.size, [one.status for one in found], seconds


def sweep_time(rtol: float, runs: int = 5) -> float:
    """Median processor time of the paper's sweep in one call [s]."""
    problems, times = paper_sweep(), []
    for _ in range(runs):
        began = time.process_time()
        solve_many(problems, rtol)
        times.append(time.process_time() - began)
    return float(np.median(times))


def main(count: int) -> None:
    judged = [rises(problem) for problem in scenes(count)]
    print(f"{count} scenes, {sum(one[2] for one in judged)} answers")
    print(f"above their estimate: {sum(one[0] for one in judged)}")
    print(f"worse by more than their estimate than at a coarser tolerance: {sum(one[1] for one in judged)}")
    for k, rtol in enumerate(TOLERANCES):
        statuses = Counter(one[3][k].name for one in judged)
        print(f"rtol {rtol:g}: {sum(one[4][k] for one in judged):.1f} s, {dict(statuses)}")
    for rtol in (1e-3, 1e-6):
        print(f"paper's sweep at {rtol:g}: {sweep_time(rtol):.2f} s")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else COUNT)
