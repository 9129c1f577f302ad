"""A study on a Dask cluster of two workers: a worker and the driver killed in the middle, and the same table."""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
import time
from contextlib import closing, suppress
from pathlib import Path

import pytest

from conveyor.studies.parametric_study import ResultStore
from tests.command_line import run as command

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
PLAN = {
    "name": "speeds",
    "base": str(SPECS / "shuttle.yaml"),
    "axes": {"belt.speed": "1:1.3:0.02 m/s", "ambient.temperature": ["0 degC", "20 degC"]},
    "outputs": ["motor_power", "indentation"],
}
PATIENCE = 300.0  # seconds


def answered(path: Path) -> int:
    """Points with an answer; none while another writes."""
    with suppress(sqlite3.Error), closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as file:
        return int(file.execute("SELECT count(*) FROM answers").fetchone()[0])
    return 0


@pytest.mark.filterwarnings("ignore")  # of the cluster's own packages, as its workers are killed
def test_killed_workers_and_drivers_leave_the_same_table(tmp_path):
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("pyarrow")
    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN), encoding="utf-8")
    undisturbed, killed = tmp_path / "whole.parquet", tmp_path / "killed.parquet"
    assert command("study", file, "-o", undisturbed, "--quiet").returncode == 0
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        asked = [sys.executable, "-m", "conveyor.cli", "study", str(file), "-o", str(killed), "--json"]
        asked += ["--scheduler", cluster.scheduler_address, "--workers", "2"]
        driver = subprocess.Popen(asked)
        answers, end = killed.with_name(f"{killed.name}.answers"), time.monotonic() + PATIENCE
        while not answered(answers) and time.monotonic() < end and driver.poll() is None:
            time.sleep(0.02)
        next(iter(cluster.workers.values())).process.process._process.kill()
        time.sleep(0.2)
        driver.kill()
        driver.wait()
        with ResultStore(answers) as known:
            kept = len(known)
        assert 0 < kept < 32
        assert not killed.exists()
        again = subprocess.run(asked, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert again.returncode == 0, again.stderr
    assert json.loads(again.stdout)["calculated"] == 32 - kept
    assert killed.read_bytes() == undisturbed.read_bytes()


_DRIVER = """
import os, time
from conveyor.cli.worker_processes import open_executor
if __name__ == "__main__":
    with open_executor(None, 2) as pool:
        print(*{pool.submit(os.getpid).result() for _ in range(4)}, flush=True)
        time.sleep(60)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a signal that cannot be caught")
def test_workers_end_with_a_killed_driver(tmp_path):
    script = tmp_path / "driver.py"
    script.write_text(_DRIVER, encoding="utf-8")
    driver = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True)
    assert driver.stdout is not None
    workers = [int(number) for number in driver.stdout.readline().split()]
    assert workers
    driver.kill()
    driver.communicate()
    end = time.monotonic() + PATIENCE
    while any(alive(worker) for worker in workers) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(alive(worker) for worker in workers)


def alive(process: int) -> bool:
    """Whether a process is there."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True
