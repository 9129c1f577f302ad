"""Studies: points of a plan, answers as a single analysis gives them, runs that stop and go on."""

from __future__ import annotations

import csv
import errno
import json
import math
import os
import random
import re
import signal
import sqlite3
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import closing
from multiprocessing import get_context
from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.cli.worker_processes import open_executor
from conveyor.errors import ConveyorError, InputError, ValidityWarning
from conveyor.line.known_test_factors import TEST_FACTORS
from conveyor.models.fields import with_fields
from conveyor.models.study import StudyPlan
from conveyor.pipeline import calculate
from conveyor.report.point_tables import PartedTable, StudyTable, point_table
from conveyor.reuse import ReuseCache
from conveyor.studies.parametric_study import (
    BATCH_SIZE,
    ParametricStudy,
    ResultStore,
    point_result,
    point_results,
    run_study,
)
from conveyor.studies.points import OUTPUTS, _unpack_job, _UnpackedJob, evaluate_points
from tests.command_line import run as command

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
PLAN = {
    "name": "speeds",
    "base": "shuttle.yaml",
    "axes": {"belt.speed": "1:1.4:0.2 m/s", "ambient.temperature": ["0 degC", "68 degF"]},
    "outputs": ["motor_power", "belt_safety", "failed"],
}


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "shuttle.yaml")


def campaign(line, **changes):
    return ParametricStudy.of(StudyPlan.from_data(PLAN | changes), line, shelf.compound)


def answered(study, path, **options):
    with ResultStore(path) as known:
        run_study(study, known, **options)
        return list(point_results(study, known))


def same(found, expected):
    """The same points in the same order; answers, kept to ten digits, as other batches round them."""
    assert [(number, values) for number, values, _ in found] == [(n, v) for n, v, _ in expected]
    for (*_, one), (*_, other) in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=1.1e-9)


def test_points_are_every_value_with_every_other_and_the_last_changes_fastest():
    plan = StudyPlan.from_data(
        {
            "name": "n",
            "base": "b.yaml",
            "axes": {"a": [1, 2], "b": "0:10:5 degC"},
            "together": [{"c": "x", "d": 1}, {"c": "y", "d": 2}],
        }
    )
    points = list(plan.points())
    assert len(points) == plan.count == 2 * 3 * 2
    assert points[0] == {"c": "x", "d": 1, "a": 1, "b": "0 degC"}
    assert points[1] == {"c": "x", "d": 1, "a": 1, "b": "5 degC"}
    assert points[-1] == {"c": "y", "d": 2, "a": 2, "b": "10 degC"}


@pytest.mark.parametrize("method", ["sobol", "latin hypercube"])
def test_samples_lie_in_their_ranges_one_in_every_stratum(method):
    fields = {"t": {"low": "-10 degC", "high": "86 degF"}, "x": {"low": 1.0, "high": 3.0}}
    plan = StudyPlan.from_data(
        {"name": "n", "base": "b", "samples": {"method": method, "count": 16, "seed": 1, "fields": fields}}
    )
    points = list(plan.points())
    shares = [(float(p["t"].removesuffix(" degC")) + 10.0) / 40.0 for p in points]
    assert sorted(int(16.0 * share) for share in shares) == list(range(16))
    assert sorted(int(16.0 * (p["x"] - 1.0) / 2.0) for p in points) == list(range(16))
    assert points == list(plan.points())


def test_answers_are_those_of_single_analyses(line, tmp_path):
    study = campaign(line)
    found = answered(study, tmp_path / "a")
    assert [number for number, *_ in found] == list(range(1, 7))
    for _, values, answer in found:
        alone = calculate(with_fields(line, dict(zip(study.plan.paths, values, strict=True))))
        assert answer[0] == pytest.approx(alone.balance.power.motor, rel=2e-4)
        assert answer[1] == pytest.approx(alone.belt_duty.safety, rel=2e-4)


def test_python_has_the_points_of_a_file_and_of_data(line, tmp_path):
    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN | {"base": str(SPECS / "shuttle.yaml")}), encoding="utf-8")
    found = conveyor.study(file, answers=tmp_path / "kept")
    same(found.points, answered(campaign(line), tmp_path / "a"))
    power = [answer[0] / 1e3 for *_, answer in found.points]
    assert found.table["motor power [kW]"].tolist() == pytest.approx(power, rel=1e-9)
    assert found.contents("US")["best"].rows
    same(conveyor.study(StudyPlan.from_data(PLAN), line).points, found.points)
    assert repr(found) == 'Study("speeds": 6 points, 0 without an answer; 6 designs, 6 keep the limits)'


def test_a_study_that_is_stopped_says_what_is_kept(tmp_path):
    def stop(*_, **__):
        raise KeyboardInterrupt

    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN | {"base": str(SPECS / "shuttle.yaml")}), encoding="utf-8")
    for kept in (
        "nothing was finished yet",
        f"6 points are kept in {tmp_path / 't.csv.answers'}: run it again to go on",
    ):
        done = command(
            "study",
            file,
            "-o",
            tmp_path / "t.csv",
            spoil=lambda patched: patched.setattr("conveyor.studies.parametric_study.run_study", stop),
        )
        assert done.returncode == 130
        assert done.stderr == f"conveyor: stopped by Ctrl-C; {kept}\n"
        assert command("study", file, "-o", tmp_path / "t.csv", "-q").returncode == 0


def test_a_point_without_an_answer_says_why(line, tmp_path):
    found = answered(campaign(line, axes={"belt.speed": ["0.01 m/s", "1 m/s"]}), tmp_path / "a")
    assert "belt.speed" in found[0][2]
    assert found[1][2][0] > 0.0


def test_a_stopped_run_goes_on_and_calculates_nothing_twice(line, tmp_path):
    path, study = tmp_path / "a", campaign(line)
    whole = answered(study, path)
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("DELETE FROM answers WHERE key IN (SELECT key FROM answers LIMIT 2)")
    done = []
    same(answered(study, path, progress=lambda *counts: done.append(counts)), whole)
    assert done[-1] == (6, 6, 0)
    more = campaign(line, axes=PLAN["axes"] | {"belt.speed": "1:1.6:0.2 m/s"})
    with ResultStore(path) as known:
        assert (
            len(known.among([more.key(point) for point in more.plan.points()])) == 6
        )  # of a longer axis just what is new
    other = campaign(line.replace(material=line.material.replace(flow="100 t/h")))
    assert all(other.key(point) != study.key(point) for point in study.plan.points())


def test_order_and_number_of_workers_change_nothing(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.BATCH_SIZE", 2)
    study = campaign(line)
    alone = answered(study, tmp_path / "alone")
    with ThreadPoolExecutor(3) as threads:
        assert answered(study, tmp_path / "threads", executor=threads, workers=3) == alone
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:
        assert answered(study, tmp_path / "processes", executor=processes, workers=2) == alone


def test_a_point_alone_is_as_among_others(line, monkeypatch):
    study = campaign(line)
    points = list(study.require_list_plan().points())
    together = evaluate_points(study.job, points)
    again = [
        evaluate_points(study.job, [point])[0] for point in points
    ]  # strands and lines are those of the batch before
    monkeypatch.setattr(ReuseCache, "MOST", 0)
    forgetful = [evaluate_points(study.job, [point])[0] for point in points]
    for one, other, third in zip(together, again, forgetful, strict=True):
        assert one == pytest.approx(other, rel=1e-9)  # figures are kept to ten digits
        assert one == pytest.approx(third, rel=1e-9)


def test_what_batches_before_made_changes_no_bit(monkeypatch):
    """A compound named by the plan as by the spec, strains and levels sought, every batch done twice by one process."""
    monkeypatch.setattr("conveyor.studies.points.round_for_storage", lambda value: value)  # all digits
    axes = {
        "belt.bottom_cover.compound": ["standard-cover", "low-rolling-resistance-cover"],
        "belt.speed": ["5 m/s", "5.5 m/s"],
        "idlers.carry.spacing": ["1.2 m", "1.5 m"],
    }
    long = conveyor.load(SPECS / "overland_10km.yaml")
    study = ParametricStudy.of(
        StudyPlan.from_data(
            {
                "name": "n",
                "base": "b",
                "axes": axes,
                "outputs": ["motor_power", "friction_factor", "error_estimate"],
            }
        ),
        long,
        shelf.compound,
    )
    points = list(study.require_list_plan().points())
    batches = [points[:2], points[2:4], points[4:6], points[6:]]
    forward = [evaluate_points(study.job, batch) for batch in batches]
    backward = [evaluate_points(study.job, batch) for batch in reversed(batches)][::-1]
    _unpack_job.cache_clear()
    anew = evaluate_points(study.job, batches[2])
    assert forward == backward
    assert anew == forward[2]


def test_loads_of_so_many_designs_are_remembered_and_no_more(line, monkeypatch):
    """Of a design once as long as no more than that many came since; never more than that many."""
    made = []
    monkeypatch.setattr(
        "conveyor.studies.points._all_loads_figures", lambda design, _: made.append(design) or len(made)
    )
    monkeypatch.setattr("conveyor.studies.points.ReuseCache.MOST", 3)
    opened = _UnpackedJob(campaign(line, axes={"belt.speed": "1:2:0.1 m/s"}).job)
    three = [{"belt.speed": f"{speed} m/s"} for speed in (1.1, 1.2, 1.3)]
    assert [opened.loads(point) for point in three + three] == [1, 2, 3, 1, 2, 3]
    assert opened.loads({"belt.speed": "1.4 m/s"}) == 4
    assert opened.loads({"belt.speed": "1.4 m/s"}) == 4
    assert opened.loads(three[0]) == 5  # the fourth took the place of the three
    assert len(made) == 5


def test_no_batch_finds_the_level_of_a_compound_anew(line, monkeypatch):
    study = campaign(line, axes={"belt.bottom_cover.compound": ["low-rolling-resistance-cover"]})
    opened = _unpack_job(study.job)
    every = (opened.base.carry_compound, opened.base.return_compound, *opened.compounds.values())
    monkeypatch.setattr("conveyor.line.known_test_factors.compound_test_factors", None)
    assert len([TEST_FACTORS.of(compound, softened=True) for compound in every]) == len(every)


def test_points_that_share_what_both_strands_feel_are_solved_side_by_side(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.BATCH_SIZE", 2)
    monkeypatch.setattr("conveyor.studies.parametric_study.SMALLEST_BATCH", 2)
    batches = []

    def instead(_, points):
        batches.append([tuple(point.values()) for point in points])
        return by_speed(_, points)

    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", instead)
    axes = {"idlers.carry.spacing": ["1 m", "1.2 m"], "belt.speed": ["1 m/s", "1.2 m/s", "1.4 m/s"]}
    found = answered(campaign(line, axes=axes), tmp_path / "a")
    assert batches == [[("1 m", v), ("1.2 m", v)] for v in axes["belt.speed"]]
    assert [values for _, values, _ in found] == [
        (s, v) for s in axes["idlers.carry.spacing"] for v in axes["belt.speed"]
    ]


def test_a_lost_worker_loses_nothing_that_was_done(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.BATCH_SIZE", 2)
    study = campaign(line)
    with ResultStore(tmp_path / "a") as known:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:

            def told(done, *_):
                if done == 2:
                    for process in processes._processes.values():
                        process.kill()

            with pytest.raises(ConveyorError, match="run it again to go on"):
                run_study(study, known, executor=processes, workers=1, progress=told)
        kept = len(known)
        assert 2 <= kept < 6
        run_study(study, known)
        assert list(point_results(study, known)) == answered(study, tmp_path / "whole")


def test_a_pipe_to_a_lost_worker_is_an_error_and_ends_nothing(line, tmp_path):
    class Broken(ThreadPoolExecutor):
        def submit(self, *_):
            raise BrokenPipeError

    with (
        ResultStore(tmp_path / "a") as known,
        pytest.raises(ConveyorError, match="a worker of the study was lost"),
    ):
        run_study(campaign(line), known, executor=Broken(1))
    if not hasattr(signal, "SIGPIPE"):
        return
    before = signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        with open_executor(None, 2):
            read, write = os.pipe()
            os.close(read)
            with pytest.raises(BrokenPipeError):
                os.write(write, b"work")
            os.close(write)
        assert signal.getsignal(signal.SIGPIPE) == signal.SIG_DFL
    finally:
        signal.signal(signal.SIGPIPE, before)


def test_a_folder_in_the_place_of_the_answers_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"cannot be written \(unable to open database file\)"):
        ResultStore(tmp_path)


@pytest.mark.parametrize("held", ["mine\n", "SQLite format 3\0 that is none" * 40])
def test_what_is_no_file_of_answers_is_refused(tmp_path, held):
    path = tmp_path / "a"
    path.write_text(held, encoding="utf-8")
    with pytest.raises(InputError, match="something else than answers"):
        ResultStore(path)
    assert path.read_text(encoding="utf-8") == held


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"axes": {"belt.speed": "1:2 m/s"}}, "expected a list, or from:to:step"),
        ({"axes": {"belt.speed": "5 m/s"}}, 'got "5 m/s", expected a list, or from:to:step with a unit, such'),
        ({"axes": {"belt.speed": "6:1:1 m/s"}}, 'got "6:1:1 m/s": it ends below where it begins$'),
        ({"axes": {"belt.speed": "1:6:0 m/s"}}, "the step has to be above 0$"),
        ({"axes": {"belt.speed": "1:6:1e-9 m/s"}}, "more than 1000 values; take a larger step$"),
        ({"axes": {"belt.speed": "1:x:1 m/s"}}, 'got "1:x:1 m/s": expected from:to:step'),
        ({"axes": {"belt.speed": ["1 m/s", math.nan]}}, "^axes.belt.speed: got nan among the values, expected"),
        ({"axes": {"belt.speed": ["1 m/s", math.inf]}}, "^axes.belt.speed: got inf among the values, expected"),
        ({"axes": {"belt.speed": ["1 m/s", None]}}, "^axes.belt.speed: got nothing among the values, expected"),
        ({"axes": {"belt.speed": ["1 m/s", ["2 m/s"]]}}, "^axes.belt.speed: got a list among the values"),
        ({"axes": {"belt..speed": ["1 m/s"]}}, "no path of a field"),
        ({"axes": {}}, "nothing varies"),
        ({"together": [{"belt.speed": "1 m/s"}]}, "belt.speed: varied twice"),
        ({"axes": {"belt.speed": ["1 m/s", "2 m/s", "1 m/s"]}}, 'axes.belt.speed: "1 m/s" is given twice'),
        ({"together": [{"a": 1}, {"a": 1}]}, "together: {a: 1} is given twice; leave one of both$"),
        (
            {"states": [{"a": 1, "hours": "1 h"}, {"a": 1, "hours": "2 h"}]},
            "states: {a: 1} is given twice; leave one of both; add its hours",
        ),
        ({"samples": {"count": 2, "fields": {"x": {"low": "1 m", "high": "100 cm"}}}}, "both ends are 1 m"),
        (
            {"samples": {"count": 2, "fields": {"x": {"low": "2 m", "high": "100 cm"}}}},
            "low is 2 m, above high, which is 1 m",
        ),
        (
            {"samples": {"count": 2, "fields": {"idlers.carry.rolls": {"low": 2, "high": 5}}}},
            "idlers.carry.rolls: has no values between two others; list its values under axes",
        ),
        ({"together": [{"a": 1}, {"b": 1}]}, "every row has to change the same fields"),
        ({"samples": {"count": 2, "fields": {"x": {"low": "1 m", "high": "1 kg"}}}}, "expected two of one kind"),
        ({"outputs": ["power"]}, 'no figure "power"; there are motor_power'),
        ({"axes": {"belt.sped": ["1 m/s"]}}, "did you mean speed"),
        ({"axes": {"belt.speed": ["1 m/s", "2 kg"]}}, r'belt.speed: got "2 kg" \(a mass\), expected a speed'),
        ({"axes": {"belt.speed": "1:2:0.5"}}, "belt.speed: got 1.0 without a unit"),
        ({"states": [{"material.flow": "1 m"}]}, r'material.flow: got "1 m" \(a length\)'),
        ({"axes": {x: f"1:2:0.001 {x}" for x in "abc"}}, "1,003,003,001 points, at most 10,000,000"),
        ({"axes": {"belt.top_cover.compound": ["no-such"]}}, 'unknown compound "no-such"'),
    ],
)  # fmt: skip
def test_a_plan_that_cannot_run_is_refused_before_it_begins(line, changes, said):
    with pytest.raises(InputError, match=said):
        campaign(line, **changes)


def test_the_command_writes_a_table_in_the_units_of_the_plan(tmp_path):
    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN | {"base": str(SPECS / "shuttle.yaml"), "outputs": []}), encoding="utf-8")
    asked = ("study", file, "-o", tmp_path / "t.csv", "--units", "us", "--set", "material.flow=100 t/h")
    done = command(*asked)
    assert done.returncode == 0, done.stderr
    told = r"6 points, 6 of them calculated now in \S+ s, \S+ a second; 0 without an answer"
    assert re.search(told, done.stdout), done.stdout
    with (tmp_path / "t.csv").open(encoding="utf-8-sig", newline="") as table:
        found = list(csv.DictReader(table))
    assert [row["belt.speed [m/s]"] for row in found] == ["1.0", "1.0", "1.2", "1.2", "1.4", "1.4"]
    assert [float(row["ambient.temperature [degC]"]) for row in found[:2]] == pytest.approx([0.0, 20.0])
    assert all(float(row["motor power [hp]"]) > 0.0 for row in found)
    again = command(
        "study", file, "-o", tmp_path / "t.csv", "--units", "us", "--json", "--set", "material.flow=100 t/h"
    )
    assert json.loads(again.stdout)["calculated"] == 0
    more = PLAN | {"base": str(SPECS / "shuttle.yaml"), "outputs": ["motor_power"]}
    file.write_text(json.dumps(more | {"axes": {"belt.speed": ["1 m/s"]}}), encoding="utf-8")
    replaced = command("study", file, "-o", tmp_path / "t.csv")  # the table of the study as it was
    assert replaced.returncode == 0, replaced.stderr
    (tmp_path / "mine.csv").write_text("\ufeffroll,force [N]\r\n", encoding="utf-8")
    refused = command("study", file, "-o", tmp_path / "mine.csv")
    assert "exists and is another output of conveyor" in refused.stderr
    (tmp_path / "mine.csv").write_text("mine", encoding="utf-8")
    refused = command("study", file, "-o", tmp_path / "mine.csv")
    assert refused.returncode == 2
    assert "exists and is no table that conveyor wrote" in refused.stderr


def test_parquet_is_the_same_table(tmp_path):
    pytest.importorskip("pyarrow")
    import pandas as pd

    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN | {"base": str(SPECS / "shuttle.yaml")}), encoding="utf-8")
    for name in ("t.csv", "t.parquet"):
        assert command("study", file, "-o", tmp_path / name).returncode == 0
    table = pd.read_csv(tmp_path / "t.csv")
    pd.testing.assert_frame_equal(
        pd.read_parquet(tmp_path / "t.parquet").iloc[:, :-1], table.iloc[:, :-1], check_dtype=False
    )


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_table_in_a_folder_grows_while_its_study_runs(line, tmp_path, monkeypatch, ending):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    else:
        monkeypatch.setattr("conveyor.report.point_tables.find_spec", lambda _: None)
    monkeypatch.setattr("conveyor.studies.parametric_study.BATCH_SIZE", 2)
    monkeypatch.setattr("conveyor.report.point_tables.PART_POINTS", 4)
    calls = []

    def instead(_, points):
        calls.extend(points)
        return by_speed(_, points)

    study, folder = campaign(line), tmp_path / "points"

    def run_into(folder, path, **options):
        with ResultStore(path) as known:

            def row(number, keyed):
                return point_result(study, known, number, keyed)

            parts = PartedTable(point_table(study, "SI"), folder, study.plan.count, row)
            run_study(study, known, answered=parts.take, **options)
        return {file.name: file.read_bytes() for file in folder.iterdir()}

    def stopping(done, *_):
        if done == 4:
            raise KeyboardInterrupt

    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", instead)
    with pytest.raises(KeyboardInterrupt):
        run_into(folder, tmp_path / "a", progress=stopping)
    assert [file.name for file in folder.iterdir()] == [f"part-00001.{ending}"]  # 4 of 6 points, whole
    (folder / f"part-00007.{ending}").write_bytes((folder / f"part-00001.{ending}").read_bytes())
    found = run_into(folder, tmp_path / "a")
    assert len(calls) <= 6 + 2  # what was under way is lost, no more
    assert found == run_into(tmp_path / "whole", tmp_path / "b")
    assert sorted(found) == [f"part-00001.{ending}", f"part-00002.{ending}"]
    whole = (folder / f"part-00001.{ending}").read_bytes()
    (folder / f"part-00001.{ending}").write_bytes(whole[:300] if ending == "parquet" else whole[:20])
    with pytest.raises(InputError, match="is damaged, or no table that conveyor wrote; remove it"):
        run_into(folder, tmp_path / "a")
    (folder / f"part-00001.{ending}").unlink()
    (folder / "mine.csv").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="is no part of such a table"):
        run_into(folder, tmp_path / "a")


def test_a_study_without_any_answer_says_why_and_draws_nothing(tmp_path):
    file, page = tmp_path / "study.json", tmp_path / "page.html"
    plan = PLAN | {"base": str(SPECS / "shuttle.yaml"), "axes": {"belt.speed": ["0.001 m/s", "0.002 m/s"]}}
    file.write_text(json.dumps(plan), encoding="utf-8")
    done = command("study", file, "-o", tmp_path / "t.csv", "-o", page, "--plots", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert "2 without an answer" in done.stdout
    assert "raise belt.speed" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("outputs", "said"),
    [
        (("page.html",), "--output: got 0 for the points, give one: .csv, .parquet or a folder"),
        (("a.csv", "b.parquet", "page.pdf"), "--output: got 2 for the points"),
        (("a.csv", "none/page.pdf"), "none/page.pdf: its folder does not exist"),
    ],
)
def test_one_output_of_a_study_has_the_points(tmp_path, outputs, said):
    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN | {"base": str(SPECS / "shuttle.yaml")}), encoding="utf-8")
    done = command("study", file, *(word for path in outputs for word in ("-o", tmp_path / path)))
    assert done.returncode == 2
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == [file]


def by_speed(_, points):
    """Figures of points at once, instead of their calculation."""
    return [[1e3 * float(point["belt.speed"].split()[0]), None, 1] for point in points]


def test_a_full_disk_loses_nothing_and_the_run_goes_on(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", by_speed)
    path, study = tmp_path / "a", campaign(line, axes={"belt.speed": "1:3:0.002 m/s"})
    with ResultStore(path) as known:
        known._file.execute("PRAGMA max_page_count = 4")  # as a disk without room for a fifth page
        with pytest.raises(ConveyorError, match=r"disk is full; make room.*what is done is kept: run it again"):
            run_study(study, known)
        kept = len(known)
    assert 0 < kept < study.plan.count
    asked = []
    monkeypatch.setattr(
        "conveyor.studies.parametric_study.evaluate_points",
        lambda _, new: asked.extend(new) or by_speed(_, new),
    )
    assert answered(study, path) == answered(study, tmp_path / "whole")
    assert len(asked) == (study.plan.count - kept) + study.plan.count


def test_a_part_without_room_is_not_there_and_the_run_goes_on(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", by_speed)
    monkeypatch.setattr("conveyor.report.point_tables.PART_POINTS", 8)
    monkeypatch.setattr("conveyor.report.point_tables.find_spec", lambda _: None)
    study, folder = campaign(line, axes={"belt.speed": "1:1.31:0.01 m/s"}), tmp_path / "points"

    def run_into(folder):
        with ResultStore(tmp_path / "a") as known:

            def row(number, keyed):
                return point_result(study, known, number, keyed)

            run_study(
                study,
                known,
                answered=PartedTable(point_table(study, "SI"), folder, study.plan.count, row).take,
            )

    write, begun = StudyTable._csv, []

    def full(self, path, rows):
        begun.append(path)
        count = write(self, path, rows)
        if len(begun) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return count

    monkeypatch.setattr(StudyTable, "_csv", full)
    with pytest.raises(InputError, match=r"part-00003.csv: cannot be written \(No space left on device\)"):
        run_into(folder)
    assert sorted(file.name for file in folder.iterdir()) == ["part-00001.csv", "part-00002.csv"]
    run_into(folder)
    run_into(tmp_path / "whole")
    assert [file.read_bytes() for file in sorted(folder.iterdir())] == [
        file.read_bytes() for file in sorted((tmp_path / "whole").iterdir())
    ]


def test_a_file_of_answers_that_a_full_disk_left_without_a_table_is_begun_again(tmp_path):
    with ResultStore(tmp_path / "a"):
        pass
    with closing(sqlite3.connect(tmp_path / "a")) as file, file:
        file.execute("DROP TABLE answers")
    with ResultStore(tmp_path / "a") as known:
        assert len(known) == 0


def test_a_damaged_file_of_answers_says_so(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", by_speed)
    path, study = tmp_path / "a", campaign(line, axes={"belt.speed": "1:2:0.001 m/s"})
    answered(study, path)
    data = path.read_bytes()
    path.write_bytes(data[:8192] + b"x" * 8192 + data[16384:])
    with pytest.raises(InputError, match="or is damaged"):
        answered(study, path)


def test_an_answer_that_lost_a_bit_is_calculated_anew_with_a_line(line, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", by_speed)
    path, study = tmp_path / "a", campaign(line, axes={"belt.speed": "1:2:0.01 m/s"})
    whole = answered(study, path)
    data = bytearray(path.read_bytes())
    for figure in (b"1250.0", b"1750.0"):
        data[data.index(figure) + 1] ^= 0b100  # to 1650.0, 1350.0
    path.write_bytes(data)
    asked = []
    monkeypatch.setattr(
        "conveyor.studies.parametric_study.evaluate_points",
        lambda _, new: asked.extend(new) or by_speed(_, new),
    )
    with pytest.warns(ValidityWarning, match=r"a: answers .* checksum: 2; they are calculated anew"):
        assert answered(study, path) == whole
    assert len(asked) == 2
    assert answered(study, path) == whole  # and no line


@pytest.mark.parametrize("seed", range(8))
def test_no_lost_bit_changes_a_figure(line, tmp_path, monkeypatch, seed):
    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", by_speed)
    path, study = tmp_path / "a", campaign(line, axes={"belt.speed": "1:2:0.05 m/s"})
    whole, seeded = answered(study, path), random.Random(seed)  # noqa: S311 a repeatable test
    data = path.read_bytes()
    used = [at for at, byte in enumerate(data) if byte]
    for _ in range(12):
        damaged = bytearray(data)
        damaged[seeded.choice(used)] ^= 1 << seeded.randrange(8)
        path.write_bytes(damaged)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ValidityWarning)
            assert _or_refused(study, path) in (whole, None)


def _or_refused(study, path):
    """The answers, or nothing where the file is refused by its name."""
    try:
        return answered(study, path)
    except ConveyorError as error:
        if re.search(rf"^{re.escape(str(path))}: holds something else .*; remove it", str(error)):
            return None
        raise


def test_every_figure_can_be_asked_for(line, tmp_path):
    timed = line.replace(operation={"hours_per_year": "5000 h", "price": "0.1 EUR/kWh"})
    study = campaign(timed, axes={"belt.speed": ["1 m/s"]}, outputs=list(OUTPUTS))
    ((*_, answer),) = answered(study, tmp_path / "a")
    assert len(answer) == len(OUTPUTS)
    assert None not in answer
    assert BATCH_SIZE > 1


def test_the_contacts_have_the_tolerance_of_the_spec(line, tmp_path):
    calculation = line.calculation
    finer = campaign(line.replace(calculation=calculation.replace(rtol=1e-6)), outputs=["error_estimate"])
    coarse = campaign(line, outputs=["error_estimate"])
    told = [answered(one, tmp_path / "a")[0][-1][0] for one in (finer, coarse)]
    assert told[0] <= 1e-6 < told[1] <= calculation.rtol
