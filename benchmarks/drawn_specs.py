"""Specs drawn at random from the examples (tests/robustness/drawn.py): how they end, and what does not hold of them.

    python -m benchmarks.drawn_specs [N] [FIRST]

N specs of the seeds FIRST, FIRST + 1, …: values, units and compounds changed, parts left out or exchanged between
examples, -50 to 60 °C. The seeds 0 … 149 are a test; exit code 1 where something does not hold.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once

import sys
import time
from collections import Counter

from tests.robustness.drawn import FAULT, run

SLOW = 10.0  # s of processor time


def main(count: int = 2000, first: int = 0) -> int:
    """Draw specs and print those that end badly, then how many ended how."""
    endings: Counter[str] = Counter()
    begun = time.process_time()
    for seed in range(first, first + count):
        started = time.process_time()
        said, ending = run(seed)
        spent = time.process_time() - started
        endings[FAULT if ending.startswith(FAULT) else ending] += 1
        if ending.startswith(FAULT) or spent > SLOW:
            print(f"{seed}: {said}\n    {ending} ({spent:.1f} s)", flush=True)
    print(dict(endings), f"{time.process_time() - begun:.0f} s")
    return int(endings[FAULT] > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
