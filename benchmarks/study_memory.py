"""Memory of the process that runs a study, at 10,000 and 100,000 points, with a stand-in for the calculation.

The stand-in answers at once, so that only what the driver does itself is measured: points, their keys, the file of
answers, the table (in parts while it runs, then whole) and the designs. Each size runs in a process of its own; the
peak is that of the process.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time

SPEC = Path(__file__).parent.parent / "examples" / "specs" / "overland.yaml"
SIZES = (100, 10_000, 100_000)


def run(count: int) -> None:
    import conveyor
    from conveyor import shelf
    from conveyor.models.study import StudyPlan
    from conveyor.report.point_tables import PartedTable, point_table
    from conveyor.studies import parametric_study as running
    from conveyor.studies.evaluation import summarise_study

    running.evaluate_points = lambda _, points: [[1e6, 1e5, 8.0] for _ in points]
    fields = {
        "belt.speed": {"low": "4 m/s", "high": "6 m/s"},
        "idlers.carry.spacing": {"low": "1 m", "high": "2 m"},
    }
    plan = StudyPlan.from_data(
        {
            "name": "memory",
            "base": "overland.yaml",
            "samples": {"count": count, "fields": fields},
            "outputs": ["motor_power", "indentation", "belt_safety"],
        }
    )
    study = running.ParametricStudy.of(plan, conveyor.load(SPEC), shelf.compound)
    with tempfile.TemporaryDirectory() as folder, running.ResultStore(Path(folder) / "a") as known:

        def row(number: int, keyed: running.KeyedPoint) -> running.Point:
            return running.point_result(study, known, number, keyed)

        table = point_table(study, "SI")
        parts = PartedTable(table, Path(folder) / "parts", count, row)
        begun = process_time()
        running.run_study(study, known, answered=parts.take)
        ran = process_time() - begun
        table.write(Path(folder) / "t.csv", running.point_results(study, known))
        wrote = process_time() - begun - ran
        plain = peak()
        summarise_study(study, running.design_results(study, known))
    memory = f"peak {plain:.0f} MB, with designs {peak():.0f} MB"
    print(
        f"{count:,} points: {memory}; run with parts {ran:.1f} s, table {wrote:.1f} s of the processor",
        flush=True,
    )


def peak() -> float:
    """Of this process [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run(int(sys.argv[1]))
    else:
        for size in SIZES:
            subprocess.run([sys.executable, __file__, str(size)], check=True)
