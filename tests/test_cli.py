"""The command line as its user meets it: what it prints, where, and with which exit code."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import run

ROOT = Path(__file__).parent.parent
OVERLAND = ROOT / "examples" / "specs" / "overland.yaml"


def broken(tmp_path: Path, old: str, new: str) -> Path:
    text = OVERLAND.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "spec.yaml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return path


def test_power_json_is_clean_and_complete() -> None:
    done = run("power", OVERLAND, "--json")
    assert done.returncode == 0
    assert done.stderr == ""
    found = json.loads(done.stdout)
    forces = found["forces_N"]
    assert set(forces) == {
        "indentation", "idler_rotation", "flexure", "misalignment", "secondary", "special", "lift", "total",
    }  # fmt: skip
    assert forces["total"] == pytest.approx(math.fsum(v for k, v in forces.items() if k != "total"), rel=1e-12)
    assert found["power_kW"]["belt"] == pytest.approx(forces["total"] * 5.0 / 1e3, rel=1e-12)
    assert found["power_kW"]["motor"] == pytest.approx(found["power_kW"]["belt"] / 0.94, rel=1e-12)
    # no part between mains and motor shaft given
    assert found["power_kW"]["mains"] == pytest.approx(found["power_kW"]["motor"], rel=1e-14)
    assert {"friction_factor", "tensions_N", "sections", "warnings"} <= set(found)
    assert len(found["sections"]) == 20


def test_power_prints_a_summary_and_writes_the_workbook(tmp_path: Path) -> None:
    book = tmp_path / "overland.xlsx"
    done = run("power", OVERLAND, "-o", book)
    assert done.returncode == 0
    assert "motor power" in done.stdout
    assert "indentation" in done.stdout
    assert book.stat().st_size > 10_000


def test_quiet_prints_nothing() -> None:
    done = run("power", OVERLAND, "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("width: 1200 mm", "width: 1200", "belt.width"),
        ("width: 1200 mm", "width: 1200 kg", "belt.width"),
        ("speed: 5 m/s", "sped: 5 m/s", "belt.sped"),
        ("flow: 2400 t/h", "flow: 24000 t/h", "material.flow"),
        ("lift: 1.5 m", "lift: 1500 m", "lift"),
        ("compound: standard-cover", "compound: standart-cover", "standard-cover"),
        ("temperature: 20 degC", "temperature: -90 degC", "ambient.temperature"),
    ],
)
def test_wrong_input_names_the_place(tmp_path: Path, old: str, new: str, expected: str) -> None:
    path = broken(tmp_path, old, new)
    done = run("power", path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    line = next(text for text in done.stderr.splitlines() if expected in text)
    place = line.split(" ")[0]
    number = place.removeprefix(str(path)).split(":")[1]
    assert path.read_text(encoding="utf-8").splitlines()[int(number) - 1].strip() != ""


def test_all_errors_at_once(tmp_path: Path) -> None:
    path = broken(tmp_path, "width: 1200 mm", "width: 1200")
    path.write_text(path.read_text(encoding="utf-8").replace("speed: 5 m/s", "speed: fast"), encoding="utf-8")
    done = run("power", path)
    assert done.returncode == 2
    assert "belt.width" in done.stderr
    assert "belt.speed" in done.stderr


def test_no_answer_is_exit_one(tmp_path: Path) -> None:
    path = broken(tmp_path, "ambient:", "calculation: {support: free}\n\nambient:")
    done = run("power", path)
    assert done.returncode == 1, done.stdout
    assert "Traceback" not in done.stderr
    assert "confined" in done.stderr


@pytest.mark.parametrize("name", ["missing.yaml", "."])
def test_unreadable_specs(name: str, tmp_path: Path) -> None:
    done = run("power", tmp_path / name)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.strip()


@pytest.mark.parametrize("target", ["nowhere/report.xlsx", "report.doc", "."])
def test_unwritable_workbooks(target: str, tmp_path: Path) -> None:
    done = run("power", OVERLAND, "-o", tmp_path / target)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.strip()
    assert not any(tmp_path.iterdir())


def test_contact_prints_the_reference_case() -> None:
    arguments = "--support free --radius 0.4 --thickness 1 --pressure 0.05 --weight 0.9 --time 1 --rtol 1e-9 --json"
    done = run("contact", *arguments.split())
    found = json.loads(done.stdout)
    assert found["friction"] == pytest.approx(0.285055390817, rel=1e-9)
    assert found["status"] == "OK"


SPLIT = "--support free --radius 0.4 --thickness 1 --weight 0.9 --time 3".split()


def test_contact_that_splits_shows_its_strips() -> None:
    done = run("contact", *SPLIT, "--pressure", "0.13", "--json")
    assert done.returncode == 0
    found = json.loads(done.stdout)
    assert found["friction"] == pytest.approx(0.35799886592, rel=1e-6)
    assert found["patches"] == [
        pytest.approx([-0.57405087749, 0.11803574191], abs=1e-6),
        pytest.approx([0.32586797997, 0.74153527656], abs=1e-6),
    ]
    assert "-0.574051 to 0.118036, 0.325868 to 0.741535" in run("contact", *SPLIT, "--pressure", "0.13").stdout


def test_contact_of_given_penetration() -> None:
    done = run("contact", *SPLIT, "--penetration", "0.24626956256", "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["pressure"] == pytest.approx(0.13, rel=1e-6)


@pytest.mark.parametrize("given", [[], ["--pressure", "0.1", "--penetration", "0.1"]])
def test_contact_wants_a_load_or_a_penetration(given: list[str]) -> None:
    done = run("contact", *SPLIT, *given)
    assert done.returncode == 2
    assert "give --pressure or --penetration" in done.stderr


def test_contact_beyond_the_wrap_limit_is_exit_one_with_advice() -> None:
    done = run("contact", *"--support free --radius 0.1 --thickness 0.05 --pressure 0.5".split())
    assert done.returncode == 1
    assert "lower the load, or enlarge the radius" in done.stderr


def test_contact_refuses_overlapping_rolls() -> None:
    done = run("contact", "--radius", "0.7", "--pressure", "0.01")
    assert done.returncode == 2
    assert "radius: got" in done.stderr


def test_fit_writes_a_compound_that_the_shelf_reads(tmp_path: Path) -> None:
    target = tmp_path / "s120.yaml"
    done = run(
        "fit", ROOT / "materials" / "s120.dma.csv", "--at", "39.9639 degC",
        "--shift", ROOT / "materials" / "s120.shift.csv", "-o", target, "--name", "mine",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "rms 8.4 %" in done.stdout
    shown = run("shelf", target)
    assert shown.returncode == 0, shown.stderr
    assert "mine" in shown.stdout


def test_fit_refuses_a_file_that_is_no_master_curve(tmp_path: Path) -> None:
    data = tmp_path / "x.csv"
    data.write_text("a,b\n1,2\n", encoding="utf-8")
    done = run("fit", data, "--at", "20 degC")
    assert done.returncode == 2
    assert "x.csv" in done.stderr


def test_shelf_lists_every_compound() -> None:
    done = run("shelf")
    assert done.returncode == 0
    for name in ("s100", "s120", "standard-cover", "low-rolling-resistance-cover", "cold-resistant-cover"):
        assert name in done.stdout


def test_shelf_unknown_name_suggests() -> None:
    done = run("shelf", "standart-cover")
    assert done.returncode == 2
    assert 'did you mean "standard-cover"' in done.stderr


def test_schema_is_json() -> None:
    found = json.loads(run("schema").stdout)
    assert "belt" in found["properties"]


def test_validate_agrees() -> None:
    done = run("validate")
    assert done.returncode == 0, done.stdout
    assert "FAILED" not in done.stdout


def test_help_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'scipy', 'pandas', 'pint', 'openpyxl'}"
    code = f"import sys, conveyor.cli; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_power_of_a_spec_without_scenarios_does_not_import_dynamics() -> None:
    heavy = "('conveyor.dynamics', 'pandas', 'matplotlib', 'openpyxl', 'scipy.optimize')"
    code = f"""import sys, conveyor.cli
try:
    conveyor.cli.main()
finally:
    print([name for name in sys.modules if name.startswith({heavy})])"""
    spec = ROOT / "examples" / "specs" / "overland.yaml"
    done = subprocess.run([sys.executable, "-c", code, "power", str(spec)], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_fit_takes_the_temperature_from_the_file() -> None:
    done = run("fit", ROOT / "materials" / "s100.dma.csv")
    assert done.returncode == 0, done.stderr
    assert "at 39.9615 degC" in done.stdout


def test_fit_asks_for_a_temperature_that_nobody_states(tmp_path: Path) -> None:
    lines = (ROOT / "materials" / "s100.dma.csv").read_text(encoding="utf-8").splitlines()
    data = tmp_path / "mine.csv"
    data.write_text("\n".join(text for text in lines if not text.startswith("#")), encoding="utf-8")
    done = run("fit", data)
    assert "--moduli E" in done.stderr
    done = run("fit", data, "--moduli", "E")
    assert done.returncode == 2
    assert "--at" in done.stderr


def test_compare_prints_one_json_object() -> None:
    done = run(
        "compare", OVERLAND, "-c", "standard-cover", "-c", "low-rolling-resistance-cover",
        "--temperature", "0,10", "--temperature", "68 degF", "--speed", "4.5,5",
        "--extra-cost", "low-rolling-resistance-cover=1000", "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    found = json.loads(done.stdout)
    assert len(found["scenes"]) == 2 * 3 * 2
    assert found["base"] == "standard-cover"
    assert {row["belt speed [m/s]"] for row in found["ranking"]} == {4.5, 5.0}
    assert sorted({row["temperature [degC]"] for row in found["scenes"]}) == pytest.approx([0.0, 10.0, 20.0])


def test_compare_writes_what_it_is_asked_for(tmp_path: Path) -> None:
    book, tables, figures = tmp_path / "c.xlsx", tmp_path / "tables", tmp_path / "figures"
    done = run(
        "compare", OVERLAND, "-c", "s100", "-c", "s120", "--temperature", "-25,20 degC", "-o", book,
        "--tables", tables, "--plots", figures, "--plot-kind", "svg", "--workers", 2,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "S100" in done.stdout
    assert "basis and limitations" in done.stdout
    assert book.stat().st_size > 10_000
    assert {path.name for path in figures.iterdir()} == {"differences.svg", "power-temperature.svg", "tangents.svg"}
    assert all(path.stat().st_size > 10_000 for path in figures.iterdir())
    assert len((tables / "scenes.csv").read_text(encoding="utf-8").splitlines()) == 1 + 2 * 2


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (("--temperature", "20:0:5"), 2, '--temperature: got "20:0:5", expected from:to:step'),
        (("--temperature", "0:1:0"), 2, "--temperature"),
        (("--temperature", "0:1e9:1e-3"), 2, "at most 1000 values"),
        (("--temperature", "warm"), 2, '--temperature: got "warm"'),
        (("--temperature", "nan"), 2, '--temperature: got "nan"'),
        (("--speed", "5 kn"), 2, '--speed: got "5 kn"'),
        (("--cover", "left"), 2, '--cover: got "left", allowed: bottom, top, both'),
        (("--extra-cost", "x"), 2, "expected NAME=AMOUNT"),
        (("--extra-cost", "standard-cover=nan"), 2, "expected NAME=AMOUNT"),
        (("--base", "s100"), 2, '"s100" is none of the compounds compared: standard-cover'),
        (("--temperature", "-90"), 1, "no scene has an answer"),
        (("--plots", "pyproject.toml"), 2, "pyproject.toml: is a file; give the name of a folder"),
    ],
)
def test_compare_refuses(options: tuple[str, ...], code: int, message: str) -> None:
    done = run("compare", OVERLAND, "-c", "standard-cover", *options)
    assert done.returncode == code
    assert message in done.stderr
    assert "Traceback" not in done.stderr


def test_template_goes_there_and_back(tmp_path: Path) -> None:
    book = tmp_path / "input.xlsx"
    assert run("template", book, "--from", OVERLAND).returncode == 0
    (by_book, by_spec) = (json.loads(run("power", path, "--json").stdout) for path in (book, OVERLAND))
    assert by_book["power_kW"] == pytest.approx(by_spec["power_kW"], rel=1e-11)
    assert run("power", tmp_path / "none.xlsx").returncode == 2


def test_fit_shifts_isotherms_and_says_what_it_read(tmp_path: Path) -> None:
    raw = ROOT / "tests" / "laboratory" / "files" / "real" / "pyvisco_freq_user_raw.csv"
    target, figure = tmp_path / "polymer.yaml", tmp_path / "polymer.svg"
    done = run("fit", raw, "--at", "20 degC", "-o", target, "--plot", figure)
    assert done.returncode == 0, done.stderr
    assert "shift of 21 isotherms to 20 degC" in done.stdout
    assert 'column 2 "E_stor": storage, in MPa by the unit row' in done.stdout
    assert "<svg" in figure.read_text(encoding="utf-8")
    assert run("shelf", target, "--at", "30 degC").returncode == 0


def test_fit_asks_for_what_is_doubtful() -> None:
    real = ROOT / "tests" / "laboratory" / "files" / "real"
    master, sweep = ROOT / "materials" / "s100.dma.csv", ROOT / "materials" / "s100.strain.csv"
    for arguments, message in (
        ((real / "S100_strain_sweep.txt",), "--modulus-unit"),
        ((master, "--strain", sweep), "--reference-strain"),
        ((sweep, "--at", "20 degC"), "holds a strain sweep; a master curve or isotherms"),
        ((master, "--shift", sweep), "holds strain sweep, shift factors are needed here"),
        ((master, "--vertical"), "give them with --shift"),
        ((master, "--at", "-300 degC"), "absolute zero"),
        ((master, "--at", "20"), '--at: got "20" without a unit'),
        ((master, "--reference-strain", "0,1 %"), "--reference-strain: got"),
        ((master, "--equilibrium", "3"), '--equilibrium: got "3" without a unit'),
    ):
        done = run("fit", *arguments)
        assert done.returncode == 2, done.stdout
        assert message in done.stderr
        assert "Traceback" not in done.stderr


def test_fit_counts_a_sweep_under_a_percent_sign_from_the_strain_given(tmp_path: Path) -> None:
    sweep, compound = tmp_path / "sweep.csv", tmp_path / "cover.yaml"
    rows = [f"{strain};{10 - k};2" for k, strain in enumerate((0.02, 0.1, 0.5, 2))]
    arguments = (ROOT / "materials" / "s120.dma.csv", "--strain", sweep, "--reference-strain", "0.1 %")
    sweep.write_text("\n".join(["Dehnung;E';E''", "%;MPa;MPa", *rows]), encoding="utf-8")
    done = run("fit", *arguments)
    assert done.returncode == 2
    assert 'temperature and frequency of the strain sweep not stated; give every row a column "temp' in done.stderr
    rows = [f"{row};20;10" for row in rows]
    sweep.write_text("\n".join(["Dehnung;E';E'';T;f", "%;MPa;MPa;degC;Hz", *rows]), encoding="utf-8")
    done = run("fit", *arguments, "-o", compound)
    assert done.returncode == 0, done.stderr
    assert f'"cover" with --shelf {tmp_path}' in done.stdout
    assert "\nstrain: 0.1 %\n" in compound.read_text(encoding="utf-8")


def test_shelf_draws(tmp_path: Path) -> None:
    one, every = tmp_path / "s100.png", tmp_path / "all.svg"
    assert run("shelf", "s100", "--plot", one).returncode == 0
    assert run("shelf", "--plot", every).returncode == 0
    assert one.read_bytes().startswith(b"\x89PNG")
    assert "S100" in every.read_text(encoding="utf-8") or every.stat().st_size > 10_000


def test_doctor_says_what_is_installed_and_calculates_published_figures() -> None:
    done = run("doctor")
    assert done.returncode == 0
    for word in ("conveyor ", "numpy ", "typst", "BLAS", "shelf", "1 hp = 745.6999 W", "nothing wrong"):
        assert word in done.stdout
    found = json.loads(run("doctor", "--json").stdout)
    assert found["wrong"] == []
    assert found["self test"]["contacts"] == "5 figures as published"


def test_doctor_ends_with_1_where_a_figure_is_not_the_published_one(monkeypatch: pytest.MonkeyPatch) -> None:
    from conveyor.validation import contact_cases
    from conveyor.validation.reference_check import relative_check

    off = relative_check("source", "friction", 1.0, 1.1, 1e-3)
    monkeypatch.setattr(contact_cases, "reference_contacts", lambda: iter([off]))
    done = run("doctor")
    assert done.returncode == 1
    assert "WRONG: friction: 1.1, published 1.0" in done.stdout
    assert "1 found wrong" in done.stdout


def test_the_package_runs_as_a_module(tmp_path: Path) -> None:
    said = subprocess.run(
        [sys.executable, "-m", "conveyor", "--version"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert said.stdout.startswith("conveyor ")
