"""Median run times beside a fixed NumPy reference on the same core, so that figures of two machines can be compared.

    python benchmarks/speed.py

The reference is ten dense solves of 200 equations (LAPACK, one thread). Times in milliseconds and in references.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from conveyor.contact import ContactProblem, CreepSpectrum, solve, solve_loads, solve_many, solve_penetration
from conveyor.contact.solvers.grid_solver import solve_grid
from conveyor.validation.contact_cases import reference_cases

RUNS = 15
ROOT = Path(__file__).resolve().parents[1]
CONVEYOR_CASE = "confined 15 terms conveyor"


def median(work: Callable[[], object], runs: int = RUNS) -> float:
    """Median wall time of `runs` calls after one to warm up [s]."""
    work()
    times = []
    for _ in range(runs):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return statistics.median(times)


def reference() -> float:
    rng = np.random.default_rng(0)
    matrix, right = rng.standard_normal((200, 200)) + 20.0 * np.eye(200), rng.standard_normal(200)

    def ten() -> None:
        for _ in range(10):
            np.linalg.solve(matrix, right)

    return median(ten, 51)


def import_time(module: str) -> float:
    """Median time of a fresh interpreter that imports `module`, less that of an empty one [s]."""

    def fresh(code: str) -> float:
        return median(lambda: subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT), 5)

    return fresh(f"import {module}") - fresh("pass")


def contacts(row: Callable[[str, float], None]) -> None:
    case = next(c for c in reference_cases() if c.name == CONVEYOR_CASE).problem
    paper = ContactProblem("free", 0.4, 0.05, CreepSpectrum(0.1, [0.9], [1.0]), 1.0)
    for rtol in (1e-3, 1e-6, 1e-9):
        row(f"conveyor contact, load given, rtol {rtol:g}", median(lambda r=rtol: solve(case, rtol=r)))
    for rtol in (1e-3, 1e-6):
        row(f"paper contact, load given, rtol {rtol:g}", median(lambda r=rtol: solve(paper, rtol=r)))
    loads = np.geomspace(0.1, 1.0, 200) * case.pressure
    row("200 loads of the conveyor contact, rtol 1e-6", median(lambda: solve_loads(case, loads, rtol=1e-6), 5))
    row("200 loads of the conveyor contact, rtol 1e-3", median(lambda: solve_loads(case, loads, rtol=1e-3), 5))
    rng = np.random.default_rng(1)
    scenes = [
        replace(
            case,
            radius=case.radius * rng.uniform(0.7, 1.4),
            thickness=case.thickness * rng.uniform(0.5, 2.0),
            pressure=case.pressure * rng.uniform(0.1, 3.0),
            creep=CreepSpectrum(
                case.creep.instantaneous,
                case.creep.weights,
                case.creep.times * 10.0 ** rng.uniform(-1.0, 1.0),
            ),
        )
        for _ in range(1000)
    ]
    row("each of 1,000 different conveyor contacts, rtol 1e-6", median(lambda: solve_many(scenes), 5) / 1000.0)
    split = ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
    row("split contact (two strips), rtol 1e-6", median(lambda: solve(split)))
    row("paper contact, penetration given, rtol 1e-6", median(lambda: solve_penetration(paper, 0.1)))
    row("grid of 4,096 nodes, split contact", median(lambda: solve_grid(split, 4096)))
    row(
        "all reference contacts, rtol 1e-6",
        median(lambda: [solve(c.problem, rtol=1e-6, throw=False) for c in reference_cases()], 3),
    )


def conveyors(row: Callable[[str, float], None]) -> None:
    """Whole conveyors; overland.yaml has ten sections."""
    import conveyor
    from conveyor.dynamics.simulation import prepare_setups, simulate_to_error

    for path in sorted((ROOT / "examples" / "specs").glob("*.yaml")):
        row(f"read {path.name}", median(lambda p=path: conveyor.load(p), 5))
        line = conveyor.load(path)
        row(f"analyse {path.name}", median(lambda given=line: conveyor.analyse(given), 3))
    line = conveyor.load(ROOT / "examples" / "dynamics" / "overland_15km.yaml")
    setups, _ = prepare_setups(line, line.scenarios)
    row("ten starts and stops of overland_15km.yaml to 1 %", median(lambda: simulate_to_error(setups), 3))


def main() -> None:
    unit = reference()
    print(f"{'':<52} {'ms':>10} {'references':>11}")

    def row(name: str, seconds: float) -> None:
        print(f"{name:<52} {1e3 * seconds:10.2f} {seconds / unit:11.2f}", flush=True)

    row("reference: ten 200x200 solves", unit)
    contacts(row)
    row("import conveyor.contact", import_time("conveyor.contact"))
    row("import conveyor", import_time("conveyor"))
    row("import conveyor.cli", import_time("conveyor.cli"))
    conveyors(row)


if __name__ == "__main__":
    main()
