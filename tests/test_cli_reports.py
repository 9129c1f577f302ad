"""What the commands write and show: pages, tables, figures, units; nothing is spent on what cannot be written."""

from __future__ import annotations

import json
import re
import sys
from contextlib import nullcontext
from pathlib import Path
from unittest.mock import MagicMock

import pytest

import conveyor
from conveyor.cli.application import parse_values, progress_bar
from conveyor.errors import InputError
from tests.command_line import run

ROOT = Path(__file__).parent.parent
SPECS = ROOT / "examples" / "specs"
HORSE = 745.69987158227022  # [W], 550 ft lbf/s


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reports")
    options = ("-o", "a.html", "--tables", "t", "--plots", "p", "--plot-kind", "svg", "--units", "us")
    return run("power", SPECS / "in_plant_us.yaml", *options, cwd=folder, columns=120), folder


def test_everything_is_written_and_said(written):
    done, folder = written
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "page: a.html" in done.stdout
    tables, figures = sorted((folder / "t").iterdir()), sorted((folder / "p").iterdir())
    assert f"tables: {len(tables)} in t" in done.stdout
    assert f"figures: {len(figures)} in p" in done.stdout
    assert {path.suffix for path in tables} == {".csv"}
    names = {path.stem for path in figures}
    asked = {
        "resistances",
        "tensions",
        "profile",
        "pressure",
        "rubber-carry",
        "power-temperature",
        "power-speed",
    }
    assert asked <= names
    assert {path.suffix for path in figures} == {".svg"}
    assert "[hp]" in (folder / "a.html").read_text(encoding="utf-8")


def at_the_take_up(spec):
    """The analysis with the take-up that serves the load states too, as `power` shows it."""
    found = conveyor.analyse(conveyor.load(spec))
    return found.at_common_take_up(conveyor.studies.calculate_studies(found.conveyor, found))


def test_units_of_the_terminal(written):
    done, _ = written
    found = at_the_take_up(SPECS / "in_plant_us.yaml").balance
    assert f"{found.power.motor / HORSE:,.1f} hp" in done.stdout
    assert f"{found.forces.total / 4.4482216152605:,.0f} lbf" in done.stdout
    assert not re.search(r"\d (kN|kW|N|°C|m/s)\b", done.stdout)


def test_units_of_the_spec_are_the_default(tmp_path):
    spec = tmp_path / "own.yaml"
    text = (SPECS / "in_plant_us.yaml").read_text(encoding="utf-8")
    text = re.sub(r"(?ms)^report:.*?(?=^\S|\Z)", "", text)
    spec.write_text(text + "\nreport: {units: US, project: Plant 7, revision: C}\n", encoding="utf-8")
    shown = run("power", spec).stdout
    assert " hp" in shown
    assert "Plant 7, revision C" in shown
    assert " kW" in run("power", spec, "--units", "SI").stdout
    assert json.loads(run("power", spec, "--json").stdout)["power_kW"]["motor"] == pytest.approx(
        at_the_take_up(spec).balance.power.motor / 1e3
    )


@pytest.fixture(scope="module")
def busy(tmp_path_factory):
    """A spec with something of everything to show."""
    spec = tmp_path_factory.mktemp("busy") / "busy.yaml"
    line = conveyor.load(SPECS / "in_plant_us.yaml").replace(
        cases=[{"name": "a case with a name that is rather long", "loading": "full"}],
        uncertainty={"roll_drag": "30 %", "flow": "10 %", "cover_thickness": "5 %"},
        operation={"price": "0.1 USD/kWh", "duty": [{"hours": "3000 h", "share": "100 %"}]},
        report={
            "project": "A project whose name takes a line of its own, and then some",
            "client": "[b]Me[/b]",
        },
    )
    spec.write_text(json.dumps(line.as_data()), encoding="utf-8")
    return spec


@pytest.mark.parametrize("columns", [80, 120])
@pytest.mark.parametrize("command", [("power",), ("compare", "-c", "standard-cover", "-c", "s100")])
def test_nothing_is_wider_than_the_terminal(command, columns, busy):
    shown = run(command[0], busy, *command[1:], "--units", "us", columns=columns).stdout
    assert max(map(len, shown.splitlines())) <= columns
    assert "…" not in shown
    if command[0] == "power":
        assert "for [b]Me[/b]" in shown  # markup of a name is text
        assert "governing load cases" in shown


def test_comparison_writes_a_page_and_figures(tmp_path):
    options = ("-c", "standard-cover", "-c", "low-rolling-resistance-cover", "--temperature", "32:68:18 degF")
    files = ("-o", "c.html", "--tables", "t", "--plots", "p")
    spec = SPECS / "in_plant_us.yaml"
    shown = run("compare", spec, *options, *files, "--speed", "550,600 fpm", "--units", "us", cwd=tmp_path).stdout
    assert {path.name for path in tmp_path.iterdir()} == {"c.html", "t", "p"}
    assert (tmp_path / "p" / "power-speed.png").read_bytes().startswith(b"\x89PNG")
    assert f"tables: {len(list((tmp_path / 't').iterdir()))} in t" in shown
    head, first, *_ = (tmp_path / "t" / "scenes.csv").read_text(encoding="utf-8").splitlines()
    assert "temperature [degF]" in head
    assert "32.0" in first
    assert "[hp]" in shown


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("-o", "a.xls"), r'--output: a.xls: its name ends in .xlsx, .html, .htm or .pdf, got ".xls"'),
        (("-o", "a.xlsx", "-o", "./a.xlsx"), r"--output: a.xlsx: is the file of --output, too; give each its own"),
        (("-o", "none/a.html"), r"its folder does not exist"),
        (("--tables", "file"), r"--tables: file: is a file; give the name of a folder"),
        (("--tables", "none/t"), r"--tables: none/t: its folder does not exist"),
        (("--plots", "file"), r"--plots: file: is a file"),
        (("--parquet",), r"--parquet: says how tables are written; give --tables FOLDER, too"),
        (("--units", "uk"), r"invalid value for '--units'"),
        (("--table", "t"), r"no such option: --table; did you mean --tables\?"),
        (("--pdf", "a.pdf"), r"no such option: --pdf; give a name that ends so: -o report\.pdf"),
    ],
)
def test_outputs_are_refused_before_anything_is_spent(options, message, tmp_path):
    (tmp_path / "file").write_text("")
    done = run("power", tmp_path / "not-even-there.yaml", *options, cwd=tmp_path)
    assert done.returncode == 2
    assert re.search(message, done.stderr)
    assert len(done.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_quiet_writes_and_says_nothing(tmp_path):
    assert run("power", SPECS / "shuttle.yaml", "-o", tmp_path / "a.html", "-q").stdout == ""
    assert (tmp_path / "a.html").stat().st_size > 10_000


@pytest.mark.parametrize("command", ["power", "compare", "fit", "shelf", "new", "template", "contact"])
def test_help_has_examples(command):
    shown = run(command, "--help", columns=80).stdout
    examples = shown.partition("Examples:")[2].split("\n")
    assert f"conveyor {command}" in "\n".join(examples)


def test_values_with_and_without_a_unit():
    assert parse_values("-10:10:10", "--temperature", "degC", "degF") == ["-10 degC", "0 degC", "10 degC"]
    assert parse_values("32,50 degF", "--temperature", "degC", "degF") == ["32 degF", "50 degF"]
    with pytest.raises(InputError, match=r"--speed: got \"5 kn\", .* a,b,c in m/s or fpm"):
        parse_values("5 kn", "--speed", "m/s", "fpm")


def test_no_bar_where_output_is_piped():
    with progress_bar(silent=False) as told:
        assert told is None
    with progress_bar(silent=True) as told:
        assert told is None


def test_what_was_done_before_a_bar_appears_is_no_speed(monkeypatch):
    now, bar = [0.0], MagicMock()
    monkeypatch.setattr(sys.modules["conveyor.cli.application"], "perf_counter", lambda: now[0])
    monkeypatch.setattr(sys.modules["conveyor.cli.application"], "_rich_bar", lambda: nullcontext(bar))
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress_bar(silent=False) as told:
        now[0] = 1.5
        told("points", 500, 6000)
    assert bar.add_task.call_args.kwargs["completed"] == 500


def test_bar_appears_after_a_second_and_names_what_runs(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(sys.modules["conveyor.cli.application"], "perf_counter", lambda: now[0])
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    with progress_bar(silent=False) as told:
        told("load cases", 1, 10)
        assert capsys.readouterr().err == ""
        now[0] = 1.5
        told("load cases", 5, 10)
        told("duty", 1, 4)
    shown = capsys.readouterr().err
    assert "load cases" in shown
    assert "duty" in shown
