"""Points of a study that one core calculates in a second: overland belt, speed, spacing, temperature and compound.

    python benchmarks/study_rate.py [WORKERS]

Time is that of the processor, beside ten dense solves of 200 equations in the same minute (2 ms on an idle core of
2024), so that a busy machine says the same. With WORKERS, wall time of processes against one, by turns.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
import tempfile
from multiprocessing import forkserver
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

import conveyor
from conveyor import shelf
from conveyor.cli.worker_processes import open_executor, preload_workers
from conveyor.models.study import StudyPlan
from conveyor.studies import parametric_study as running
from conveyor.studies import points

SPEC = Path(__file__).parent.parent / "examples" / "specs" / "overland.yaml"
AXES = {
    "belt.bottom_cover.compound": ["standard-cover", "low-rolling-resistance-cover"],
    "ambient.temperature": "-10:25:5 degC",
    "belt.speed": "5:6.4:0.2 m/s",
    "idlers.carry.spacing": "1.2:2.2:0.2 m",
}


def study(**axes: object) -> running.ParametricStudy:
    data = {"name": "rate", "base": SPEC.name, "axes": AXES | axes, "outputs": ["energy_per_tonne_km"]}
    return running.ParametricStudy.of(StudyPlan.from_data(data), conveyor.load(SPEC), shelf.compound)


def reference() -> float:
    """Least processor time of ten dense solves of 200 equations [s]."""
    rng = np.random.default_rng(0)
    matrix, right = rng.standard_normal((200, 200)) + 20.0 * np.eye(200), rng.standard_normal(200)
    times = []
    for _ in range(51):
        began = process_time()
        for _ in range(10):
            np.linalg.solve(matrix, right)
        times.append(process_time() - began)
    return min(times)


def rate(campaign: running.ParametricStudy) -> None:
    """Batches of one process, the least of three goes at each: whatever else runs makes them longer only."""
    with tempfile.TemporaryDirectory() as folder, running.ResultStore(Path(folder) / "a") as none:
        listed, count = campaign.require_list_plan().points(), campaign.require_list_plan().count
        every = [list(batch.new.values()) for batch in running.point_batches(campaign, none, listed, count)]
    unit, least = reference(), [float("inf")] * len(every)
    for _ in range(3):
        points._unpack_job.cache_clear()  # noqa: SLF001 each go makes its strands anew
        for k, batch in enumerate(every):
            began = process_time()
            points.evaluate_points(campaign.job, batch)
            least[k], unit = min(least[k], process_time() - began), min(unit, reference())
    spent = sum(least)
    print(
        f"{count} points, {count / spent:.0f} a second of the processor, {1e3 * spent / count:.1f} ms each; "
        f"reference {1e3 * unit:.2f} ms, {spent / count / unit:.2f} of it a point",
        flush=True,
    )


def scaled(campaign: running.ParametricStudy, workers: int) -> None:
    """Wall and processor time of a whole run, processes against one, by turns; start-up of the processes is in it."""
    print(f"{campaign.require_list_plan().count} points", flush=True)
    for turn in range(3):
        wall, processor = [], []
        for many in (1, workers):
            begun, before = perf_counter(), sum(os.times()[:4])
            with tempfile.TemporaryDirectory() as folder, running.ResultStore(Path(folder) / "a") as known:
                preload_workers(None, many)
                with open_executor(None, many) as executor:
                    running.run_study(campaign, known, executor=executor, workers=many)
            wall.append(perf_counter() - begun)
            forkserver._forkserver._stop()  # noqa: SLF001 its processes' time is told when it ends
            processor.append(sum(os.times()[:4]) - before)
        print(
            f"turn {turn + 1}: {wall[0]:.1f} s, {workers} processes {wall[1]:.1f} s: {wall[0] / wall[1]:.2f}; "
            f"of the processor {processor[0]:.1f} s, {processor[1]:.1f} s",
            flush=True,
        )


if __name__ == "__main__":
    rate(study())
    if len(sys.argv) > 1:
        scaled(study(**{"idlers.carry.spacing": "1.2:2.2:0.02 m"}), int(sys.argv[1]))
