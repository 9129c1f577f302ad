"""Random scenes over the widest ranges: how they end, how true the error estimates are, what the slowest cost.

    python benchmarks/stress.py [N] [SEED] [PROCESSES] [FIRST]

E∞/E0 1 … 1e6, ζ 0 and 1e-12 … 1e12, k h 1e-3 … 1e3, R/λ 1e-4 … 0.5, p̃_m 1e-12 … 1, 0 … 60 retardation terms, ν 0 … 0.5.
Each scene is solved to `RTOL` and, where that succeeds, once more to `FINE`: the difference is the true error. Contacts
that a grid of 16,384 nodes can see are also solved there, where nothing is assumed of their strips.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import math
import sys
import time
import warnings
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from conveyor.contact import ContactProblem, ContactSolution, CreepSpectrum, Status, solve
from conveyor.contact.solvers.grid_solver import solve_grid
from conveyor.errors import ConveyorError, NoSolutionError

RTOL, FINE = 1e-6, 1e-10
GRID, SEEN = 1 << 14, 40  # nodes in a period; nodes in the narrowest strip that make the grid worth asking
STEEPEST = 0.01  # E0/E∞ below which the edge layers are thinner than any grid
SHOWN = 8
USUAL, QUICK = 1000.0, 100  # E∞/E0 that reaches any tolerance; references that a refusal may take


@dataclass(frozen=True)
class Outcome:
    """One scene: how it ended, what it cost, how far off it was."""

    index: int
    scene: str
    ending: str
    seconds: float
    order: int = 0
    estimate: float = 0.0
    true_error: float = 0.0
    energy: float = 0.0
    grid_off: float = math.nan
    strips: int = 0
    edge: float = math.nan  # how far the edges and the largest pressure are off, over their estimates
    peak: float = math.nan
    stiffening: float = 1.0  # E∞/E0


def random_problem(rng: np.random.Generator) -> ContactProblem:
    """A scene; lengths, loads and times spread evenly over decades."""

    def decades(low: float, high: float) -> float:
        return float(10.0 ** rng.uniform(low, high))

    terms = int(rng.choice([0, 1, 1, 2, 5, 15, 60]))
    instantaneous = decades(-6.0, 0.0) if terms else 1.0
    shares = rng.dirichlet(np.ones(terms)) if terms else np.empty(0)
    centre, spread = rng.uniform(-12.0, 12.0), rng.uniform(0.0, 15.0)
    times = 10.0 ** np.clip(centre + rng.uniform(-spread, spread, terms), -12.0, 12.0)
    times[rng.random(terms) < 0.02] = 0.0
    support = str(rng.choice(["free", "confined", "half-space"]))
    return ContactProblem(
        support,
        radius=min(decades(-4.0, -0.3), 0.5),
        thickness=decades(-3.0, 3.0),
        pressure=decades(-12.0, 0.0),
        creep=CreepSpectrum(instantaneous, (1.0 - instantaneous) * shares, times),
        poisson=float(rng.uniform(0.0, 0.5)),
    )


def describe(problem: ContactProblem) -> str:
    """Scene in one line, enough to build it again by eye; the index gives it exactly."""
    creep = problem.creep
    return (
        f"{problem.support} R/λ {problem.radius:.3g} kh {problem.thickness:.3g} p {problem.pressure:.3g} "
        f"ν {problem.poisson:.2f} j∞ {creep.instantaneous:.2g} "
        f"ζ {np.array2string(creep.times, precision=2, threshold=4)}"
    )


def run(index: int, problem: ContactProblem) -> Outcome:
    """Solve one scene; anything but a status or a ConveyorError is a fault of the solver and ends as its name."""
    began = time.process_time()
    scene, stiffening = describe(problem), 1.0 / problem.creep.instantaneous
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = solve(problem, rtol=RTOL, throw=False)
    except ConveyorError as refused:
        return Outcome(index, scene, f"raised: {refused}", time.process_time() - began)
    except (ArithmeticError, ValueError, RuntimeError, MemoryError, Warning) as fault:
        return Outcome(index, scene, f"FAULT {type(fault).__name__}: {fault}", time.process_time() - began)
    seconds = time.process_time() - began
    if found.status is not Status.OK:
        return Outcome(index, scene, found.status.name, seconds, found.stats.order, stiffening=stiffening)
    if not all(math.isfinite(v) for v in (found.friction, found.half_width, found.penetration, found.peak_pressure)):
        return Outcome(index, scene, "FAULT not finite", seconds, found.stats.order)
    fine = solve(problem, rtol=FINE, throw=False)
    lossy = bool((problem.creep.times > 0.0).any())
    scale = abs(found.friction) if lossy and found.friction else 1.0
    off = abs(fine.friction - found.friction) / scale if fine.status is Status.OK else math.nan
    return Outcome(
        index,
        scene,
        "OK",
        seconds,
        found.stats.order,
        found.error_estimate,
        off,
        found.energy_error,
        against_grid(found),
        len(found.patches),
        *fields_off(found, fine),
        stiffening,
    )


def fields_off(found: ContactSolution, fine: ContactSolution) -> tuple[float, float]:
    """How far edges and largest pressure differ, over both solutions' estimates; NaN without a finer solution.

    Friction to a finer tolerance may need a lower order: the largest pressure is then the worse of the two.
    """
    if fine.status is not Status.OK or len(fine.patches) != len(found.patches):
        return math.nan, math.nan
    edge = float(np.abs(fine.patches - found.patches).max())
    peak = abs(fine.peak_pressure / found.peak_pressure - 1.0)
    return edge / (found.edge_error + fine.edge_error), peak / (found.peak_error + fine.peak_error)


def against_grid(found: ContactSolution) -> float:
    """Relative difference of Δ on the grid; infinite for another number of strips, NaN if the grid cannot see them."""
    strips = found.patches * found.problem.rho
    unresolved = found.problem.creep.instantaneous < STEEPEST
    if unresolved or float(np.diff(strips, axis=1).min()) < SEEN * 2.0 * math.pi / GRID:
        return math.nan
    try:
        grid = solve_grid(found.problem, GRID)
    except NoSolutionError:
        return math.nan
    if len(grid.strips) != len(strips):
        return math.inf
    return abs(grid.depth / found.penetration - 1.0)


def reference() -> float:
    """CPU time of ten dense solves of 200 equations, the least of many [s]."""
    rng = np.random.default_rng(0)
    matrix, right = rng.standard_normal((200, 200)) + 20.0 * np.eye(200), rng.standard_normal(200)
    times = []
    for _ in range(31):
        began = time.process_time()
        for _ in range(10):
            np.linalg.solve(matrix, right)
        times.append(time.process_time() - began)
    return min(times)


def one(order: tuple[int, int]) -> Outcome:
    seed, index = order
    return run(index, random_problem(np.random.default_rng([seed, index])))


def table(title: str, outcomes: list[Outcome]) -> None:
    print(f"\n{title}")
    print(f"{'#':>6} {'ms':>8} {'n':>4} {'estimate':>9} {'true':>9} {'energy':>9} {'grid':>8}  ending, scene")
    for o in outcomes[:SHOWN]:
        print(
            f"{o.index:6d} {1e3 * o.seconds:8.1f} {o.order:4d} {o.estimate:9.1e} {o.true_error:9.1e} "
            f"{o.energy:9.1e} {o.grid_off:8.1e}  {o.ending[:60]} | {o.scene}"
        )


def main(count: int, seed: int, processes: int, first: int) -> int:
    with ProcessPoolExecutor(processes) as pool:
        outcomes = list(pool.map(one, [(seed, i) for i in range(first, first + count)], chunksize=16))
    unit = reference()
    print(f"{count} scenes from {first}, seed {seed}, rtol {RTOL:g}, true error against rtol {FINE:g}")
    print(f"CPU time; reference: ten 200x200 solves {1e3 * unit:.2f} ms")
    print(
        f"{'ending':<16} {'count':>7} {'share':>7} {'p50 ms':>8} {'p99 ms':>8} {'max ms':>8} {'max in references':>18}"
    )
    endings = Counter(o.ending.split(":")[0] for o in outcomes)
    for ending, number in endings.most_common():
        times = [1e3 * o.seconds for o in outcomes if o.ending.split(":")[0] == ending]
        p50, p99 = np.percentile(times, (50.0, 99.0))
        print(f"{ending:<16} {number:7d} {number / count:7.1%} {p50:8.2f} {p99:8.1f} {max(times):8.1f} "
              f"{1e-3 * max(times) / unit:18.0f}")  # fmt: skip
    solved = [o for o in outcomes if o.ending == "OK"]
    known = [o for o in solved if math.isfinite(o.true_error)]
    print(f"\nsolved {len(solved)}, with a finer solution {len(known)}")
    beyond = sum(o.true_error > RTOL for o in known)
    above = sum(o.true_error > o.estimate for o in known)
    worst = max((o.true_error / o.estimate for o in known), default=0.0)
    print(f"true error above rtol: {beyond}; above the estimate: {above} ({above / max(len(known), 1):.2%}), "
          f"at most {worst:.2g} of it")  # fmt: skip
    for name in ("edge", "peak"):
        over = [getattr(o, name) for o in known]
        print(f"{name} off, over its estimate: median {np.nanmedian(over):.2g}, worst {np.nanmax(over):.2g}; "
              f"above it {sum(x > 1.0 for x in over)}")  # fmt: skip
    usual = [o for o in outcomes if o.stiffening <= USUAL]
    ways = Counter(o.ending.split(":")[0] for o in usual)
    rough = sum(o.ending == "OK" and math.isnan(o.true_error) for o in usual)
    print(f"E∞/E0 up to {USUAL:g}: {len(usual)}, {dict(ways)}; solved but not to {FINE:g}: {rough}")
    refused = [o for o in outcomes if o.ending in ("WRAP_LIMIT", "TOO_THIN", "NOT_CONVERGED")]
    print(f"refused {len(refused)}, in more than {QUICK} references {sum(o.seconds > QUICK * unit for o in refused)}")
    split = [o for o in solved if o.strips > 1]
    gridded = [o for o in solved if not math.isnan(o.grid_off)]
    print(f"split {len(split)}; seen by the grid {len(gridded)}, there with other strips "
          f"{sum(math.isinf(o.grid_off) for o in gridded)}, depth off by 1e-3 or more "
          f"{sum(o.grid_off >= 1e-3 for o in gridded)}")  # fmt: skip
    table("farthest from the grid", sorted(gridded, key=lambda o: -o.grid_off))
    table("largest true errors", sorted(known, key=lambda o: -o.true_error))
    table("true error over estimate", sorted(known, key=lambda o: -o.true_error / max(o.estimate, 1e-12)))
    table("edges or peaks beyond their estimates", [o for o in known if o.edge > 1.0 or o.peak > 1.0])
    table("no finer solution", [o for o in solved if not math.isfinite(o.true_error)])
    table("slowest", sorted(outcomes, key=lambda o: -o.seconds))
    table("not solved", [o for o in outcomes if o.ending == "NOT_CONVERGED"])
    table("raised", [o for o in outcomes if o.ending.startswith("raised")])
    faults = [o for o in outcomes if o.ending.startswith("FAULT")]
    table("faults", faults)
    return 1 if faults else 0


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:]]
    sys.exit(main(*given, *(300, 1, os.cpu_count() or 1, 0)[len(given) :]))
