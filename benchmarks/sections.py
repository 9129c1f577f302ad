"""The whole calculation by number of sections, and the loop of tensions alone: forces along the belt are known.

    python benchmarks/sections.py

1,000 sections times 6 load cases times 3 temperatures are 18 such loops; the table's last column is that sum. Below it
1,000 sections under 20 load cases, and their load states with the worst loadings at 5 temperatures.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import time
from collections.abc import Callable
from pathlib import Path

import conveyor
from conveyor.loop.balance import Balance, close_loop
from conveyor.models import Conveyor, standard_cases
from conveyor.pipeline import calculate
from conveyor.studies.load_cases import analyse_cases
from conveyor.studies.states import load_states

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
            return close_loop(found.layout, found.along, unit_main).tensions.tight

        each = fastest(loop)
        print(f"{count:8d} {whole * 1e3:24.1f} {each * 1e3:17.3f} {CASES * each * 1e3:15.1f}")
    cases = standard_cases(["-10 degC", "0 degC", "10 degC", "20 degC", "30 degC"])
    study = analyse_cases(made, cases)
    under = fastest(lambda: analyse_cases(made, cases), runs=3)
    states = fastest(lambda: load_states(made, study.as_given, study), runs=3)
    print(f"{len(study.results)} load cases {under:.2f} s, load states {states:.2f} s")


if __name__ == "__main__":
    main()
