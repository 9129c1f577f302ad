"""Surveyed profiles of 20 km: processor time and memory of every step from the spec's file to the workbook.

    python benchmarks/long_routes.py [SECTIONS]

Each number of sections is a process of its own (the figure of memory is its largest); without a number 500, 2,000 and
20,000 of them.
"""

from __future__ import annotations

import math
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import conveyor
from conveyor.results.analysis import analyse_studies
from conveyor.spec import dump

ROOT = Path(__file__).resolve().parents[1]
COUNTS = (500, 2000, 20000)
LENGTH = 20e3  # [m]


def height(x: float) -> float:
    """Of the ground [m]: hills of two lengths on a slow climb."""
    return 40.0 * math.sin(x / 1500.0) + 6.0 * math.sin(x / 170.0) + 0.004 * x


def step(name: str, work: Callable[[], Any]) -> Any:
    """Do one step and say what it took."""
    began = time.process_time()
    made = work()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"  {name:10s} {time.process_time() - began:7.2f} s {memory:7.0f} MB", flush=True)
    return made


def main(count: int) -> None:
    line = conveyor.load(ROOT / "examples" / "specs" / "overland.yaml")
    each = LENGTH / count
    sections = [
        {
            "name": f"s{i}",
            "length": f"{each:.6g} m",
            "lift": f"{height((i + 1) * each) - height(i * each):.6g} m",
        }
        for i in range(count)
    ]
    long = line.replace(route={"sections": sections}, cases=[], drive=line.drive.replace(further_drives=[]))
    print(f"{count:,} sections")
    with tempfile.TemporaryDirectory() as folder:
        spec = Path(folder) / "long.yaml"
        spec.write_text(dump(long), encoding="utf-8")
        read = step("spec", lambda: conveyor.load(spec))
        found = step("analyse", lambda: conveyor.analyse(read))
        made = step("studies", lambda: analyse_studies(read, found))
        step("json", lambda: found.to_dict(made))
        step("workbook", lambda: found.to_excel(Path(folder) / "long.xlsx", made))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(int(sys.argv[1]))
    else:
        for number in COUNTS:
            subprocess.run([sys.executable, __file__, str(number)], check=True)
