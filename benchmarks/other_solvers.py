"""Run time against error of the half width beside tamaas and ContactMechanics: an elastic half-space on periodic rolls.

    pip install tamaas ContactMechanics
    python benchmarks/other_solvers.py [OUTDIR]

Neither knows a viscoelastic layer that rolls, so the scene is what all of them solve: elastic, half-space, load given,
the true circle. Their half width is where p² of the last two nodes in contact, straight on, vanishes. Errors are
relative, against `solve` at rtol 1e-12; times the least processor time of several runs, beside ten 200 x 200 solves.
Solvers that are not installed are left out. Writes other_solvers.csv and draws other_solvers.png from it.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import csv
import math
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.contact.solvers.grid_solver import solve_grid

SCENES = {"wide: R/λ 0.4, p̃ 0.05": (0.4, 0.05), "narrow: R/λ 0.05, p̃ 0.01": (0.05, 0.01)}
NODES = tuple(2**k for k in range(7, 14))
RTOLS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-9)
PERIOD, PASSES, RUNS, LONG = 2.0 * math.pi, 4, 8, 0.3
SOLVED = 1e-10  # their own tolerance


def seconds(work: Callable[[], object]) -> float:
    """Least processor time of some runs [s]."""
    times = []
    for _ in range(RUNS):
        if sum(times) > LONG:
            break
        began = time.process_time()
        work()
        times.append(time.process_time() - began)
    return min(times)


def least(works: Sequence[Callable[[], object]]) -> list[float]:
    """Least processor time of each in some passes over all: a busy moment of the machine spoils none of them alone."""
    passes = [[seconds(work) for work in works] for _ in range(PASSES)]
    return [min(times) for times in zip(*passes, strict=True)]


def reference() -> Callable[[], object]:
    """Ten dense solves of 200 equations."""
    rng = np.random.default_rng(0)
    matrix, right = rng.standard_normal((200, 200)) + 20.0 * np.eye(200), rng.standard_normal(200)
    return lambda: [np.linalg.solve(matrix, right) for _ in range(10)]


def roll(rho: float, nodes: int) -> np.ndarray:
    """Height of the roll's lower side over one period, its crown at zero; flat beyond it."""
    x = (np.arange(nodes) - nodes // 2) * (PERIOD / nodes)
    return np.sqrt(np.maximum(rho * rho - x * x, 0.0)) - rho


def half_width(p: np.ndarray) -> float:
    """Half the distance of the places where p², straight on from the last two nodes in contact, vanishes."""
    step = PERIOD / p.size
    inside = np.flatnonzero(p > 0.0)
    width = (inside[-1] - inside[0]) * step
    for edge, inner in ((inside[0], inside[0] + 1), (inside[-1], inside[-1] - 1)):
        width += step * min(1.0, p[edge] ** 2 / (p[inner] ** 2 - p[edge] ** 2))
    return 0.5 * float(width)


def by_tamaas(rho: float, pressure: float, nodes: int) -> float:
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_1d, [PERIOD], [nodes])
    model.E, model.nu = 1.0, 0.0
    tamaas.PolonskyKeerRey(model, roll(rho, nodes), SOLVED).solve(pressure)
    return half_width(np.array(model.traction).ravel())


def by_contact_mechanics(rho: float, pressure: float, nodes: int) -> float:
    from ContactMechanics import PeriodicFFTElasticHalfSpace, make_system
    from SurfaceTopography import UniformLineScan

    surface = UniformLineScan(roll(rho, nodes), PERIOD, periodic=True)
    system = make_system(
        interaction="hardwall",
        substrate=PeriodicFFTElasticHalfSpace((nodes,), 1.0, (PERIOD,)),
        surface=surface,
    )
    system.minimize_proxy(external_force=pressure * PERIOD, pentol=SOLVED)
    return half_width(np.abs(np.asarray(system.substrate.force)).ravel())


def runs(problem: ContactProblem) -> Iterator[tuple[str, str, Callable[[], float]]]:
    rho = problem.rho
    mean = 0.5 * problem.pressure * rho  # p_m of E/(1-ν²) = 1, k = 1: p̃_m = 2 p_m/ρ
    for rtol in RTOLS:
        yield "conveyor, solve", f"rtol {rtol:g}", lambda r=rtol: solve(problem, rtol=r).half_width * rho
    for n in NODES:
        yield "conveyor, grid", f"{n} nodes", lambda n=n: 0.5 * float(np.ptp(solve_grid(problem, n).strips))
        yield "tamaas", f"{n} nodes", lambda n=n: by_tamaas(rho, mean, n)
        yield "ContactMechanics", f"{n} nodes", lambda n=n: by_contact_mechanics(rho, mean, n)


def measured() -> list[dict[str, str]]:
    works, found, missing = [reference()], [], set()
    for scene, (radius, pressure) in SCENES.items():
        problem = ContactProblem("half-space", radius, pressure, CreepSpectrum(1.0))
        exact = solve(problem, rtol=1e-12).half_width * problem.rho
        for solver, size, work in runs(problem):
            if solver in missing:
                continue
            try:
                found.append((scene, solver, size, f"{abs(work() / exact - 1.0):.2e}"))
                works.append(work)
            except ImportError as absent:
                print(f"{solver} left out: {absent}")
                missing.add(solver)
    unit, *times = least(works)
    rows = []
    for known, took in zip(found, times, strict=True):
        row = [*known, f"{1e3 * took:.3g}", f"{took / unit:.3g}"]
        rows.append(dict(zip(("scene", "solver", "size", "error", "ms", "references"), row, strict=True)))
        print(*row, sep="  ", flush=True)
    return rows


def draw(rows: list[dict[str, str]], path: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(1, len(SCENES), figsize=(9.0, 4.0), sharey=True, layout="constrained")
    for axis, scene in zip(axes, SCENES, strict=True):
        for solver, style in zip(dict.fromkeys(r["solver"] for r in rows), ("s-", "^-", "o--", "x:"), strict=False):
            at = [r for r in rows if (r["scene"], r["solver"]) == (scene, solver)]
            errors = [max(float(r["error"]), 1e-14) for r in at]
            axis.loglog([float(r["references"]) for r in at], errors, style, ms=4, lw=1.2, label=solver)
        axis.set(title=scene, xlabel="time over ten 200×200 solves [-]")
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("relative error of the half width [-]")
    axes[0].legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main(out: Path) -> None:
    rows = measured()
    out.mkdir(parents=True, exist_ok=True)
    with (out / "other_solvers.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(rows)
    draw(rows, out / "other_solvers.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out"))
