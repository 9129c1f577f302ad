"""True errors at loose tolerances: scenes of one to three relaxation times whose edge layers no low order resolves.

    python benchmarks/loose.py [SEED]

400 scenes of every support, E∞/E0 2 to 10,000, against rtol 1e-6; for each tolerance how many friction errors exceed
their estimate and the tolerance, and the worst over either.
"""

from __future__ import annotations

import math
import sys

import numpy as np

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve_many

COUNT = 400


def scenes(seed: int) -> list[ContactProblem]:
    rng = np.random.default_rng(seed)
    found = []
    while len(found) < COUNT:
        ratio, terms = 10.0 ** rng.uniform(0.3, 4.0), rng.integers(1, 4)
        weights = rng.dirichlet(np.ones(terms)) * (1.0 - 1.0 / ratio)
        creep = CreepSpectrum(1.0 - weights.sum(), weights, 10.0 ** rng.uniform(-3.5, 0.5, terms))
        support = str(rng.choice(["half-space", "confined", "free"]))
        radius, pressure = rng.uniform(0.03, 0.4), 10.0 ** rng.uniform(-3.0, -1.2)
        thickness = math.inf if support == "half-space" else 10.0 ** rng.uniform(-1.5, 0.7)
        found.append(ContactProblem(support, radius, pressure, creep, thickness))
    return found


def main(seed: int) -> None:
    problems = scenes(seed)
    fine = solve_many(problems, 1e-6)
    for rtol in (1e-2, 3e-3, 1e-3, 1e-4):
        pairs = [
            (abs(one.friction / exact.friction - 1.0), one.error_estimate)
            for one, exact in zip(solve_many(problems, rtol), fine, strict=True)
            if one.status is Status.OK and exact.status is Status.OK and exact.friction > 0.0
        ]
        over_estimate, over_rtol = np.array([(true / told, true / rtol) for true, told in pairs]).T
        print(
            f"rtol {rtol:g}: {len(pairs)} scenes; above their estimate {int((over_estimate > 1.0).sum())}, "
            f"worst {over_estimate.max():.1f} times; above rtol {int((over_rtol > 1.0).sum())}, "
            f"worst {over_rtol.max():.1f} times"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
