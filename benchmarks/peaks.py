"""How far the largest pressure of solved contacts is off, over `peak_error`.

    python benchmarks/peaks.py

Of three kinds, against rtol 1e-10: the shelf's covers under rolls (-30 to 40 °C, 2 and 6 m/s, 4 and 10 mm, light and
heavy; solved, and read from load curves), scenes of loose.py (one to three sharp times; solved, and read from load
curves), scenes of stress.py. Left out are those that the finer solution does not know by far better, and errors below
1e-9.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

from collections.abc import Iterable, Iterator

import numpy as np
from loose import scenes
from stress import random_problem

from conveyor import shelf
from conveyor.contact import (
    ContactProblem,
    ContactSolution,
    LoadCurve,
    Status,
    load_curves,
    solve,
    solve_many,
)
from conveyor.errors import ConveyorError
from conveyor.indentation import RollContact, to_problem

RTOLS, FINE = (1e-2, 1e-4, 1e-6), 1e-10
KNOWN, LEAST = 0.3, 1e-9  # error told of the finer solution over the error seen; errors that are rounding
LIGHTER = 0.1  # lightest load of a curve over the heaviest


def covers() -> list[ContactProblem]:
    """Covers of the shelf under one roll, as far as their data reach."""
    found = []
    for name in shelf.names():
        for celsius in (-30.0, -10.0, 5.0, 20.0, 40.0):
            try:
                rubber = shelf.compound(name).series(273.15 + celsius)
            except ConveyorError:
                continue
            for thickness, speed in ((0.004, 2.0), (0.004, 6.0), (0.01, 2.0), (0.01, 6.0)):
                roll = RollContact(radius=0.0795, spacing=1.2, cover_thickness=thickness, speed=speed, series=rubber)
                found += [to_problem(roll, load) for load in (250.0, 4500.0)]
    return found


def exact(problem: ContactProblem) -> ContactSolution | None:
    """The finer solution, which need not have reached its tolerance; None where there is none."""
    try:
        found = solve(problem, FINE, throw=False)
        known = found.status in (Status.OK, Status.NOT_CONVERGED) and found.strips is not None
    except ConveyorError:
        return None
    return found if known else None


def report(name: str, pairs: Iterable[tuple[float, float, ContactSolution | None]]) -> None:
    """Print how far values are off over what is told; pairs of value, told, and the finer solution."""
    seen = []
    for value, told, best in pairs:
        if best is not None:
            off = max(abs(value / best.peak_pressure - 1.0), abs(best.peak_pressure / value - 1.0))
            if off > LEAST and best.peak_error < KNOWN * off:
                seen.append((off, told))
    off, told = np.array(seen).T
    print(
        f"{name}: {off.size} contacts, off by {np.median(off):.1e} in the middle, {np.quantile(off, 0.9):.1e} in nine "
        f"tenths, {off.max():.1e} at most; told {np.median(told):.1e}, {np.quantile(told, 0.9):.1e}, {told.max():.1e}, "
        f"{np.median(told / off):.1f} times that in the middle; {int((off > told).sum())} off by more, at worst by "
        f"{np.max(off / told):.2f} times",
        flush=True,
    )


def main() -> None:
    kinds = {
        "covers": covers(),
        "sharp": scenes(5),
        "extreme": [random_problem(np.random.default_rng([606, k])) for k in range(200)],
    }
    for kind, problems in kinds.items():
        best = [exact(problem) for problem in problems]
        for rtol in RTOLS:
            solved = zip(solve_many(problems, rtol), best, strict=True)
            report(
                f"{kind}, rtol {rtol:g}",
                (
                    (s.peak_pressure, s.peak_error, true)
                    for s, true in solved
                    if s.status is Status.OK and true and len(s.patches) == len(true.patches)
                ),
            )
        if kind != "extreme":
            for rtol in RTOLS:
                report(f"curves, {kind}, rtol {rtol:g}", read(problems, best, rtol))


def read(
    problems: list[ContactProblem], best: list[ContactSolution | None], rtol: float
) -> Iterator[tuple[float, float, ContactSolution | None]]:
    """Largest pressures on curves that end in each scene's load, what is told, and the finer solutions."""
    loads = [problem.pressure for problem in problems]
    curves = load_curves(problems, [LIGHTER * load for load in loads], loads, rtol)
    for curve, load, true in zip(curves, loads, best, strict=True):
        if isinstance(curve, LoadCurve):
            at = curve.at(load)
            yield float(at.peak_pressure), float(at.peak_error), true


if __name__ == "__main__":
    main()
