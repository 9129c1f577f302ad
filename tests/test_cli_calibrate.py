"""`conveyor calibrate` and `verify-sheet` as users run them: outputs, exit codes, messages."""

from __future__ import annotations

import json
from pathlib import Path

import openpyxl
import pytest
from ruamel.yaml import YAML

from tests.test_cli import OVERLAND, ROOT, run

RUNS = ROOT / "examples" / "measured" / "overland.csv"


def test_calibrate_prints_a_fragment_that_power_takes(tmp_path: Path) -> None:
    done = run("calibrate", OVERLAND, "--measured", RUNS, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    spec = YAML(typ="safe").load(OVERLAND.read_text(encoding="utf-8"))
    spec |= YAML(typ="safe").load(found["spec"])
    run_of = next(one for one in found["runs"] if one["flow_t_per_h"] == 1150 and "April" in one["note"])
    spec["material"]["flow"], spec["ambient"]["temperature"] = "1150 t/h", "9 degC"
    (tmp_path / "spec.json").write_text(json.dumps(spec), encoding="utf-8")
    power = run("power", tmp_path / "spec.json", "--json")
    assert power.returncode == 0, power.stderr
    told = json.loads(power.stdout)
    # the take-up of `power` serves the load states too; wraps and bearings follow its tension, less than a thousandth
    assert told["power_kW"]["motor"] == pytest.approx(run_of["calibrated_kW"], rel=1e-3)
    assert any("calculation.calibration" in text for text in told["warnings"])


def test_calibrate_shows_factors_runs_and_what_to_know(tmp_path: Path) -> None:
    done = run(
        "calibrate", OVERLAND, "--measured", RUNS, "--error", "2 %", "-o", "found.yaml", cwd=tmp_path
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    for words in (
        "Factors with their 90 % interval",
        "idler rotation",
        "January (empty)",
        "basis and limitations:",
        "chi square",
    ):
        assert words in done.stdout
    fragment = (tmp_path / "found.yaml").read_text(encoding="utf-8")
    mark, _, lines = fragment.partition("\n")
    assert mark.startswith("# Written by conveyor calibrate (")
    assert lines.rstrip() in done.stdout
    again = run("calibrate", OVERLAND, "--measured", RUNS, "-o", "found.yaml", "-q", cwd=tmp_path)
    assert again.returncode == 0, again.stderr  # as a report is
    (tmp_path / "found.yaml").write_text(fragment.replace("source", "# source"), encoding="utf-8")
    edited = run("calibrate", OVERLAND, "--measured", RUNS, "-o", "found.yaml", "-q", cwd=tmp_path)
    assert edited.returncode == 2
    assert "found.yaml: exists and is no unedited part of a spec that conveyor wrote; choose another" in edited.stderr


def test_calibrate_writes_every_table(tmp_path: Path) -> None:
    done = run("calibrate", OVERLAND, "--measured", RUNS, "-o", "found.xlsx", "-q", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "")
    book = openpyxl.load_workbook(tmp_path / "found.xlsx")
    assert book.sheetnames == ["Calibration"]
    assert {"table_factors", "table_runs", "table_notes"} <= set(book.defined_names)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--error", "two"], "--error: "),
        (["--factor", "rubber"], "factors: got rubber, allowed: indentation, idler_rotation, flexure"),
        (["-o", "found.doc"], "its name ends in .xlsx, .html, .htm, .pdf, .yaml or .yml"),
    ],
)
def test_calibrate_refuses_in_one_message(tmp_path: Path, options: list[str], said: str) -> None:
    done = run("calibrate", OVERLAND, "--measured", RUNS, *options, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_calibrate_names_the_place_in_the_table(tmp_path: Path) -> None:
    (tmp_path / "runs.csv").write_text("motor power [kW],flow [t/h]\n250,0\nn/a,1\n", encoding="utf-8")
    done = run("calibrate", OVERLAND, "--measured", "runs.csv", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith('runs.csv:3: column 1 "motor power [kW]": ')


def test_verify_sheet_writes_workbook_and_page(tmp_path: Path) -> None:
    axes = (
        "--load",
        "2,4 N/mm",
        "--roll",
        "194 mm",
        "--speed",
        "5",
        "--cover",
        "7",
        "--temperature",
        "20,150",
    )
    done = run("verify-sheet", "s100", *axes, "-o", "sheet.xlsx", "-o", "sheet.html", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("2 rows, 0 of an idler set; 1 without a figure")
    assert openpyxl.load_workbook(tmp_path / "sheet.xlsx").sheetnames == ["About", "N per width"]
    assert "no figure because" in (tmp_path / "sheet.html").read_text(encoding="utf-8")
    told = json.loads(run("verify-sheet", "s100", *axes, "--json").stdout)
    assert [len(row["resistance_N_per_m"]) for row in told["rows"]] == [2, 2]
    assert told["rows"][1]["resistance_N_per_m"] == [None, None]


def test_verify_sheet_asks_for_an_output() -> None:
    done = run("verify-sheet", "s100")
    assert done.returncode == 2
    assert "give -o SHEET.xlsx, -o SHEET.html, -o SHEET.pdf or --json" in done.stderr
    assert "unknown compound" in run("verify-sheet", "s1000", "--json").stderr
    assert "give --spec, too" in run("verify-sheet", "s100", "--set", "belt.speed=3 m/s", "--json").stderr
