"""A full factorial: 50 compounds x 15 temperatures x 10 speeds on one conveyor, in one process or several.

    python benchmarks/compare.py [COMPOUNDS] [WORKERS]

The compounds are the shelf's illustrative covers with other loss and stiffness: as different for the solver as fifty
measured ones. Printed beside ten 200x200 NumPy solves, as benchmarks/speed.py does.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import conveyor
from conveyor import shelf
from conveyor.cli.worker_processes import open_executor
from conveyor.models import RubberCompound
from conveyor.units import si

SPEC = Path(__file__).parent.parent / "examples" / "specs" / "overland.yaml"
COVERS = ("standard-cover", "low-rolling-resistance-cover", "cold-resistant-cover")


def varied(count: int) -> list[RubberCompound]:
    """Compounds with moduli scaled term by term, seeded."""
    rng = np.random.default_rng(1)
    found = []
    for k in range(count):
        base = shelf.compound(COVERS[k % len(COVERS)])
        terms = [
            {"modulus": f"{si(term.modulus) * factor:.9g} Pa", "time": term.time}
            for term, factor in zip(base.prony.terms, rng.uniform(0.6, 1.6, len(base.prony.terms)), strict=True)
        ]
        prony = base.prony.replace(terms=terms)
        found.append(base.replace(name=f"{base.name} {k}", prony=prony))
    return found


def reference() -> float:
    """Ten 200x200 solves, the best of five [s]."""
    a, b = np.random.default_rng(0).standard_normal((200, 200)), np.ones(200)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(10):
            np.linalg.solve(a, b)
        times.append(time.perf_counter() - start)
    return min(times)


def main(count: int, workers: int) -> None:
    line = conveyor.load(SPEC)
    compounds = varied(count)
    temperatures = [f"{t:g} degC" for t in np.linspace(-30, 40, 15)]
    speeds = [f"{v:g} m/s" for v in np.linspace(4.5, 7.2, 10)]
    conveyor.compare_compounds(line, compounds[:1], temperatures=temperatures[:2])
    with open_executor(None, workers) as executor:
        start, cpu = time.perf_counter(), time.process_time()
        found = conveyor.compare_compounds(
            line, compounds, temperatures=temperatures, speeds=speeds, executor=executor, workers=workers
        )
        wall, cpu = time.perf_counter() - start, time.process_time() - cpu
    scenes = len(found.scenes)
    print(f"{scenes} scenes ({count} compounds x 15 temperatures x 10 speeds), {len(found.refused)} refused")
    print(f"{wall:.1f} s, {1e3 * wall / scenes:.2f} ms a scene; {cpu:.1f} s of this process")
    print(
        f"largest error estimate {max(s.error for s in found.scenes):.1e}; "
        f"ten 200x200 solves {1e3 * reference():.2f} ms"
    )
    start = time.perf_counter()
    _ = found.table, found.ranking
    print(f"tables {time.perf_counter() - start:.1f} s")


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:]]
    main(*given, *(50, 1)[len(given) :])
