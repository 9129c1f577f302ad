"""A thousand sections, six load cases, three temperatures: median run times beside the NumPy reference of speed.py.

python benchmarks/cases.py
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

from pathlib import Path

from speed import median, reference

import conveyor
from conveyor.models import Conveyor, LoadCase
from conveyor.models.cases import STANDARD_LOADINGS

RUNS = 3
SECTIONS = 1000
TEMPERATURES = ("0 degC", "20 degC", "40 degC")
SPECS = Path(__file__).resolve().parents[1] / "examples" / "specs"


def long_line() -> Conveyor:
    """The sections of overland.yaml, again and again under new names; a belt as strong as its tension."""
    line = conveyor.load(SPECS / "overland.yaml")
    old = line.route.sections
    sections = [old[i % len(old)].replace(name=f"{old[i % len(old)].name} {i}") for i in range(SECTIONS)]
    return line.replace(route=line.route.replace(sections=sections))


def load_cases() -> list[LoadCase]:
    """Full, empty, inclines, declines, and two part loads, each at three temperatures."""
    loadings = [{"name": loading, "loading": loading} for loading in STANDARD_LOADINGS]
    parts = [{"name": f"{share} %", "loading": "part load", "share": f"{share} %"} for share in (40, 70)]
    return [LoadCase.from_data({**case, "temperatures": TEMPERATURES}) for case in (*loadings, *parts)]


def main() -> None:
    unit = reference()
    line, cases = long_line(), load_cases()
    print(f"{'':<64} {'ms':>10} {'references':>11}")

    def row(name: str, seconds: float) -> None:
        print(f"{name:<64} {1e3 * seconds:10.2f} {seconds / unit:11.2f}", flush=True)

    row("reference: ten 200x200 solves", unit)
    row(f"analyse, {SECTIONS} sections", median(lambda: conveyor.analyse(line), RUNS))
    for rtol in (1e-4, 1e-6):
        study = conveyor.analyse_cases(line, cases, rtol=rtol)
        name = f"{SECTIONS} sections x {len(cases)} load cases x {len(TEMPERATURES)} temperatures, rtol {rtol:g}"
        row(name, median(lambda r=rtol: conveyor.analyse_cases(line, cases, rtol=r), RUNS))
        assert len(study.results) == len(cases) * len(TEMPERATURES)  # noqa: S101
    small = conveyor.load(SPECS / "overland_10km.yaml")
    row("load cases of overland_10km.yaml", median(lambda: conveyor.analyse_cases(small), RUNS))
    row("duty of overland_10km.yaml", median(lambda: conveyor.analyse_duty(small), RUNS))
    row("uncertainty of overland_10km.yaml", median(lambda: conveyor.uncertainty.study(small), RUNS))


if __name__ == "__main__":
    main()
