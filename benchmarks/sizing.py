"""Starters sized from their duties alone beside the hand-made specs: power, belt, cost of a year; run times.

    python benchmarks/sizing.py

Processor time, beside that of one exact calculation in the same run: other work on the machine slows both alike.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import conveyor
from conveyor.sizing import size_conveyor
from conveyor.spec import from_data
from conveyor.starter import starter_values
from conveyor.studies.study_file import read_duty

DUTIES = Path(__file__).resolve().parents[1] / "examples" / "duties"
HAND_MADE = {
    "overland": lambda: conveyor.load(DUTIES.parent / "specs" / "overland.yaml"),
    "in_plant": lambda: from_data(starter_values("in-plant")),
    "downhill": lambda: from_data(starter_values("downhill")),
    "in_plant_us": lambda: conveyor.load(DUTIES.parent / "specs" / "in_plant_us.yaml"),
}
T = TypeVar("T")


def timed(work: Callable[[], T]) -> tuple[T, float]:
    begun = time.process_time()
    return work(), time.process_time() - begun


def main() -> None:
    print(
        f"{'':<12} {'hand-made':>10} {'sized':>8} {'over':>7}   {'candidates':>10} {'exact':>6} {'s':>6} {'s/exact':>8}"
    )
    for name, spec in HAND_MADE.items():
        line = spec()
        hand, one = timed(lambda line=line: conveyor.analyse(line))
        found, seconds = timed(lambda name=name: size_conveyor(read_duty(DUTIES / f"{name}.yaml"), best=1))
        best = found.best
        powers = [each.balance.power.motor / 1e3 for each in (hand, best.found)]
        choice = best.choice
        print(
            f"{name:<12} {powers[0]:>7.1f} kW {powers[1]:>8.1f} {powers[1] / powers[0] - 1.0:>+7.1%}   "
            f"{found.candidates:>10,} {found.calculated:>6} {seconds:>6.1f} {seconds / one:>8.1f}\n"
            f"  {choice.trough.width.belt * 1e3:.0f} mm, {choice.speed:g} m/s, {best.chosen.carcass.name}, "
            f"rolls {choice.roll.diameter * 1e3:.0f} mm every "
            f"{choice.carry:g} and {choice.back:g} m, {choice.drives}"
        )


if __name__ == "__main__":
    main()
