"""Run time against error: spectral orders, the solver by tolerance, the grid, the paper's route; same scenes.

    python benchmarks/accuracy_vs_time.py [OUTDIR]

Each method finds the contact of a given load from nothing. Errors are relative, of friction, against the solver at its
tightest; where that stops short (the peaked scene) its own estimate is the floor shown. Times are the least processor
time of several runs on one thread, beside ten 200 x 200 solves. Writes accuracy_time.png and scaling.png.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from boundary_elements import solve_boundary_elements
from other_solvers import least, reference

from conveyor.contact import ContactProblem, CreepSpectrum, solve, solve_loads, solve_many
from conveyor.contact.galerkin.quadrature import build_rule
from conveyor.contact.galerkin.spectral import assemble_matrix, solve_equilibrium
from conveyor.contact.solvers.grid_solver import solve_grid
from conveyor.contact.solvers.load_control import LoadSearch, contact_at_load, guess_half_width
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.errors import NoSolutionError
from conveyor.validation.contact_cases import reference_cases

ORDERS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
RTOLS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
GRIDS = tuple(2**k for k in range(9, 17))
ELEMENTS = (16, 32, 64, 128, 256, 512)
METHODS = ("spectral, fixed order", "solve, by rtol", "grid", "boundary elements")
STYLES = ("o-", "s-", "^-", "x--")


@dataclass(frozen=True)
class Point:
    """One run of a method."""

    method: str
    size: str
    error: float
    seconds: float


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


def by_order(problem: ContactProblem, n: int) -> float:
    """Friction at one order under the given load."""
    scene = SolverState.of(problem)
    state = contact_at_load(scene, LoadSearch(scene.target, *guess_half_width(scene)), n, 1e-10)
    if state is None:
        raise NoSolutionError(f"no contact at order {n}")
    return float(state.contact.friction[0])


def by_grids(problem: ContactProblem, points: int) -> float:
    """Friction on a grid whose first active set comes from coarser ones, as the solver itself does it."""
    grid = None
    for nodes in [n for n in GRIDS if n <= points]:
        grid = solve_grid(problem, nodes, grid)
    return grid.friction


def runs(problem: ContactProblem) -> list[tuple[str, str, Callable[[], float]]]:
    """Every method at every size."""
    return [
        *((METHODS[0], f"n {n}", lambda n=n: by_order(problem, n)) for n in ORDERS),
        *((METHODS[1], f"rtol {r:g}", lambda r=r: solve(problem, rtol=r, throw=False).friction) for r in RTOLS),
        *((METHODS[2], f"{n} nodes", lambda n=n: by_grids(problem, n)) for n in GRIDS),
        *((METHODS[3], f"{n} elements", lambda n=n: solve_boundary_elements(problem, n).friction) for n in ELEMENTS),
    ]


def measured(problem: ContactProblem) -> tuple[list[Point], float]:
    """Points of all methods and the floor below which errors mean nothing."""
    best = solve(problem, rtol=1e-12, throw=False)
    found = []
    for method, size, work in runs(problem):
        try:
            found.append((method, size, abs(work() / best.friction - 1.0), work))
        except NoSolutionError as refused:
            print(f"  {method:<22} {size:<14} {refused}")
    times = least([work for *_, work in found])
    points = [Point(*known, took) for (*known, _), took in zip(found, times, strict=True)]
    for point in points:
        print(f"  {point.method:<22} {point.size:<14} {1e3 * point.seconds:9.2f} ms {point.error:9.1e}")
    return points, best.error_estimate


def batch(problem: ContactProblem, count: int) -> list[ContactProblem]:
    """Scenes of one kind that differ in everything."""
    rng = np.random.default_rng(1)
    creep = problem.creep
    return [
        replace(
            problem,
            radius=problem.radius * rng.uniform(0.7, 1.4),
            thickness=problem.thickness * rng.uniform(0.5, 2.0),
            pressure=problem.pressure * rng.uniform(0.1, 3.0),
            creep=CreepSpectrum(creep.instantaneous, creep.weights, creep.times * 10.0 ** rng.uniform(-1.0, 1.0)),
        )
        for _ in range(count)
    ]


def scaling(problem: ContactProblem) -> dict[str, tuple[list[int], list[float]]]:
    """Milliseconds against order, terms, loads of one scene and scenes of a batch."""
    alpha = np.array([solve(problem).half_width * problem.rho])
    rule = build_rule(problem.layer, problem.creep, float(alpha[0]))

    def contact(n: int) -> object:
        return solve_equilibrium(assemble_matrix(rule, problem.creep, alpha, n), alpha, problem.rho)

    def with_terms(count: int) -> ContactProblem:
        weights = np.full(count, 0.99 / count)
        return replace(problem, creep=CreepSpectrum(0.01, weights, np.geomspace(1e-8, 1e4, count)))

    orders, terms, batches = (
        [8, 16, 32, 64, 128, 256, 512],
        [1, 2, 5, 10, 20, 40, 60],
        [1, 3, 10, 30, 100, 300, 1000],
    )
    many = batch(problem, max(batches))
    loads = np.geomspace(0.1, 1.0, max(batches)) * problem.pressure
    wanted: dict[str, tuple[list[int], Callable[[int], object]]] = {
        "order of one matrix and its solve": (orders, contact),
        "retardation terms of one solve (rtol 1e-3)": (terms, lambda n: solve(with_terms(n), 1e-3)),
        "loads of one scene (rtol 1e-6)": (batches, lambda n: solve_loads(problem, loads[:n])),
        "scenes of a batch (rtol 1e-6)": (batches, lambda n: solve_many(many[:n])),
    }
    return {
        name: (sizes, [1e3 * took for took in least([partial(work, size) for size in sizes])])
        for name, (sizes, work) in wanted.items()
    }


def draw(
    results: dict[str, tuple[list[Point], float]], scales: dict[str, tuple[list[int], list[float]]], out: Path
) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(1, len(results), figsize=(13.0, 4.4), sharey=True, layout="constrained")
    for axis, (name, (points, floor)) in zip(axes, results.items(), strict=True):
        for method, style in zip(METHODS, STYLES, strict=True):
            chosen = [p for p in points if p.method == method]
            axis.loglog(
                [1e3 * p.seconds for p in chosen],
                [max(p.error, 1e-14) for p in chosen],
                style,
                ms=4,
                lw=1.2,
                label=method,
            )
        if floor > 1e-12:
            axis.axhspan(1e-14, floor, color="0.9")
        axis.set(title=name.replace(": ", "\n", 1), xlabel="time for one load [ms]")
        axis.title.set_fontsize(9)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("relative error of friction [-]")
    axes[0].legend(fontsize=8)
    figure.savefig(out / "accuracy_time.png", dpi=110)
    figure, axes = plt.subplots(1, len(scales), figsize=(13.0, 3.2), sharey=True, layout="constrained")
    for axis, (name, (sizes, times)) in zip(axes, scales.items(), strict=True):
        axis.loglog(sizes, times, "o-", ms=4)
        axis.set(xlabel=name)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("time [ms]")
    figure.savefig(out / "scaling.png", dpi=110)


def main(out: Path) -> None:
    print(f"reference: ten 200x200 solves {1e3 * least([reference()])[0]:.2f} ms")
    results = {}
    for name, problem in scenes().items():
        print(name)
        results[name] = measured(problem)
    scales = scaling(scenes()["conveyor: confined, kh 0.03, 15 times over 12 decades"])
    for name, (sizes, times) in scales.items():
        print(name, ", ".join(f"{size}: {ms:.3g} ms" for size, ms in zip(sizes, times, strict=True)))
    out.mkdir(parents=True, exist_ok=True)
    draw(results, scales, out)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out"))
