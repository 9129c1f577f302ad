"""How far the largest pressure of solved contacts is off, over `peak_error`.

    python benchmarks/peaks.py

Of three kinds, against order 512 at the solved half width: the shelf's covers under rolls (-30 to 40 °C, 2 and 6 m/s,
4 and 10 mm, light and heavy; solved, and read from load curves), scenes of loose.py (one to three sharp times), scenes
of stress.py. Left out are those that order 512 does not know by far better, and errors below 1e-9.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import math
from collections.abc import Iterable, Iterator

import numpy as np
from loose import scenes
from stress import random_problem

from conveyor import shelf
from conveyor.contact import ContactProblem, LoadCurve, Status, load_curves, solve_many
from conveyor.contact.pressure import growth, peak, peak_error
from conveyor.contact.scene import Scene
from conveyor.contact.spectral import equilibrium
from conveyor.errors import ConveyorError
from conveyor.indentation import RollContact, to_problem

RTOLS, BEST = (1e-2, 1e-4, 1e-6), 512
KNOWN, LEAST = 0.3, 1e-9  # error of the best order over what is told; errors that are rounding


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
                roll = RollContact(
                    radius=0.0795, spacing=1.2, cover_thickness=thickness, speed=speed, rubber=rubber
                )
                found += [to_problem(roll, load) for load in (250.0, 4500.0)]
    return found


def exact(problem: ContactProblem) -> tuple[float, float] | None:
    """Largest pressure at the problem's load and what is told of it, by the best order; None without such a contact."""
    (found,) = solve_many([problem], 1e-6)
    if found.status is not Status.OK or len(found.patches) > 1:
        return None
    scene, alpha = Scene.of(problem), found.half_width * problem.rho
    contact = equilibrium(scene.system(alpha, BEST, BEST).matrix, np.array([alpha]), problem.rho)
    if not (contact.inside[0] and contact.pressure[0] > 0.0):
        return None
    grown = np.array([growth(scene.creep, alpha, BEST)])
    # p̂ goes like the square root of a load that differs by a little
    carried = math.sqrt(problem.pressure / contact.pressure[0])
    return float(peak(contact.c)[0]) * carried, float(peak_error(contact.c, grown)[0])


def report(name: str, pairs: Iterable[tuple[float, float, tuple[float, float] | None]]) -> None:
    """Print how far values are off over what is told; pairs of value, told, and the exact one with its error."""
    seen = [(abs(value / best[0] - 1.0), told, best[1]) for value, told, best in pairs if best is not None]
    off, told = np.array([one[:2] for one in seen if one[0] > LEAST and one[2] < KNOWN * one[1]]).T
    print(
        f"{name}: {off.size} contacts, off by {np.median(off):.1e} in the middle, {np.quantile(off, 0.9):.1e} in nine "
        f"tenths, {off.max():.1e} at most; told {np.median(told):.1e}, {np.quantile(told, 0.9):.1e}, {told.max():.1e}, "
        f"{np.median(told / off):.0f} times that in the middle; {int((off > told).sum())} off by more, at worst by "
        f"{np.max(off / told):.2f} times",
        flush=True,
    )


def main() -> None:
    kinds = {
        "covers": covers(),
        "sharp": scenes(5),
        "extreme": [random_problem(np.random.default_rng([606, k])) for k in range(500)],
    }
    for kind, problems in kinds.items():
        best = [exact(problem) for problem in problems]
        for rtol in RTOLS:
            solved = zip(solve_many(problems, rtol), best, strict=True)
            usable = ((one, true) for one, true in solved if one.status is Status.OK)
            report(f"{kind}, rtol {rtol:g}", ((s.peak_pressure, s.peak_error, true) for s, true in usable))
        if kind == "covers":
            for rtol in RTOLS[1:]:
                report(f"curves of covers, rtol {rtol:g}", read(problems, best, rtol))


def read(
    problems: list[ContactProblem], best: list[tuple[float, float] | None], rtol: float
) -> Iterator[tuple[float, float, tuple[float, float] | None]]:
    """Largest pressures at both ends of curves between pairs of loads, what is told, and the exact ones."""
    light, heavy = problems[::2], problems[1::2]
    curves = load_curves(heavy, [p.pressure for p in light], [p.pressure for p in heavy], rtol)
    for k, curve in enumerate(curves):
        if isinstance(curve, LoadCurve):
            loads = curve.at([light[k].pressure, heavy[k].pressure])
            for peaks, told, true in zip(
                loads.peak_pressure, loads.peak_error, best[2 * k : 2 * k + 2], strict=True
            ):
                yield float(peaks), float(told), true


if __name__ == "__main__":
    main()
