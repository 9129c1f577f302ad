"""The whole calculation by number of sections, and the loop of tensions alone: forces along the belt are known.

    python benchmarks/sections.py

1,000 sections times 6 load cases times 3 temperatures are 18 such loops; the table's last column is that sum.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import time
from collections.abc import Callable
from pathlib import Path

import conveyor
from conveyor.loop.balance import Balance, balance
from conveyor.models import Conveyor
from conveyor.pipeline import calculate

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (1, 10, 100, 1000)
CASES = 18  # 6 load cases at 3 temperatures
RUNS = 15


def with_sections(line: Conveyor, count: int) -> Conveyor:
    """The same length and lift in `count` sections that rise and fall."""
    length, rise = line.route.length / count, line.route.rise / count
    sections = [
        {
            "name": f"section {i + 1}",
            "length": f"{length!r} m",
            "lift": f"{rise + (0.01 if i % 2 else -0.01) * length * (count > 1)!r} m",
        }
        for i in range(count)
    ]
    return line.replace(route=line.route.replace(sections=sections))


def fastest(work: Callable[[], object], runs: int = RUNS) -> float:
    """Shortest wall time of several calls [s]."""
    times = []
    for _ in range(runs):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return min(times)


def main() -> None:
    line = conveyor.load(ROOT / "examples" / "specs" / "overland.yaml")
    print("sections   whole calculation [ms]   loop alone [ms]   18 loops [ms]")
    for count in COUNTS:
        made = with_sections(line, count)
        calculate(made)
        whole = fastest(lambda made=made: calculate(made), runs=5)
        found = calculate(made)

        def loop(found: Balance = found.balance, unit_main: float = found.balance.unit_main) -> float:
            return balance(found.frame, found.along, unit_main).tensions.tight

        each = fastest(loop)
        print(f"{count:8d} {whole * 1e3:24.1f} {each * 1e3:17.3f} {CASES * each * 1e3:15.1f}")


if __name__ == "__main__":
    main()
