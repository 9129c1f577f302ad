"""Error against time: what a tighter tolerance and a higher order cost, for an easy, a usual and a peaked contact.

    python benchmarks/accuracy.py

The reference of each scene is its solution at rtol 1e-12, or the highest order where that is not reached.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import statistics
import time
from collections.abc import Callable

import numpy as np

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve
from conveyor.contact.quadrature import build_rule
from conveyor.contact.spectral import Contact, assemble, equilibrium
from conveyor.validation import reference_cases

RUNS = 9
RTOLS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12)
ORDERS = (8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384)


def scenes() -> dict[str, ContactProblem]:
    conveyor = next(c.problem for c in reference_cases() if c.name == "confined 15 terms conveyor")
    return {
        "paper: free, R/λ 0.4, kh 1, p̃ 0.05, ζ 1": ContactProblem(
            "free", 0.4, 0.05, CreepSpectrum(0.1, [0.9], [1.0]), 1.0
        ),
        "conveyor: confined, kh 0.03, 15 times over 12 decades": conveyor,
        "peaked: half-space, E∞/E0 1000, one time near the transit time": ContactProblem(
            "half-space", 0.1, 0.01, CreepSpectrum(1e-3, [0.999], [0.01])
        ),
    }


def timed(work: Callable[[], object]) -> float:
    """Median wall time [ms]."""
    work()
    times = []
    for _ in range(RUNS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return 1e3 * statistics.median(times)


def by_tolerance(problem: ContactProblem) -> None:
    best = solve(problem, rtol=1e-12, throw=False)
    print(
        f"  {'rtol':>8} {'n':>4} {'matrices':>8} {'ms':>8} {'true error':>11} {'estimate':>9} {'energy':>9}  status"
    )
    for rtol in RTOLS:
        found = solve(problem, rtol=rtol, throw=False)
        if found.status not in {Status.OK, Status.NOT_CONVERGED}:
            print(
                f"  {rtol:8.0e} {found.stats.order:4d} {found.stats.matrices:8d} {'':>41} {found.status.name}"
            )
            continue
        off = abs(found.friction / best.friction - 1.0)
        print(
            f"  {rtol:8.0e} {found.stats.order:4d} {found.stats.matrices:8d} "
            f"{timed(lambda r=rtol: solve(problem, rtol=r, throw=False)):8.2f} {off:11.1e} "
            f"{found.error_estimate:9.1e} {found.energy_error:9.1e}  {found.status.name}"
        )


def by_order(problem: ContactProblem) -> None:
    """One matrix and its solve at the half width of the load: friction and load against order 512."""
    alpha = np.array([solve(problem, rtol=1e-12, throw=False).half_width * problem.rho])
    rule = build_rule(problem.layer, problem.creep, float(alpha[0]))

    def contact(n: int) -> Contact:
        return equilibrium(assemble(rule, problem.creep, alpha, n), alpha, problem.rho)

    best = contact(512)
    print(
        f"  {'n':>4} {'ms':>8} {'friction off':>13} {'load off':>9} {'condition':>10}   nodes {rule.nodes.size}"
    )
    for n in ORDERS:
        found = contact(n)
        matrix = assemble(rule, problem.creep, alpha, n)[0, 1:]
        print(
            f"  {n:4d} {timed(lambda n=n: contact(n)):8.2f} "
            f"{abs(found.friction[0] / best.friction[0] - 1.0):13.1e} "
            f"{abs(found.pressure[0] / best.pressure[0] - 1.0):9.1e} {np.linalg.cond(matrix):10.1f}"
        )


def main() -> None:
    for name, problem in scenes().items():
        print(f"\n{name}")
        by_tolerance(problem)
        by_order(problem)


if __name__ == "__main__":
    main()
