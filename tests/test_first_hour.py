"""What a stranger does wrong in the first hour, and the line that tells what to do instead."""

from __future__ import annotations

from pathlib import Path

import openpyxl
import pytest

from conveyor import spec
from conveyor.errors import InputError
from conveyor.files.output_marks import CATEGORY
from conveyor.laboratory.dma_file import read_dma
from conveyor.studies.study_file import read_duty, read_plan, read_search
from tests.command_line import run

ROOT = Path(__file__).parent.parent
SPECS, DUTIES, STUDIES = (ROOT / "examples" / name for name in ("specs", "duties", "studies"))
GOOD = (SPECS / "overland.yaml").read_text(encoding="utf-8")


def changed(folder: Path, old: str, new: str) -> str:
    """Message on the overland example with one text changed."""
    assert GOOD.count(old) >= 1
    path = folder / "mine.yaml"
    path.write_text(GOOD.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError) as refused:
        spec.load(path)
    return str(refused.value)


@pytest.mark.parametrize(
    ("reader", "path", "noun", "command"),
    [
        (spec.load, next(DUTIES.glob("*.yaml")), "a duty to size a conveyor from", "conveyor size"),
        (spec.load, next(STUDIES.glob("spacing*.yaml")), "a study", "conveyor study"),
        (spec.load, ROOT / "materials" / "s120.yaml", "a rubber compound", 'a spec, as "compound: '),
        (read_duty, SPECS / "curved.yaml", "the spec of a conveyor", "conveyor power"),
        (read_plan, SPECS / "feeder.yaml", "the spec of a conveyor", "conveyor power"),
        (read_search, SPECS / "overland.yaml", "the spec of a conveyor", "conveyor power"),
    ],
)
def test_a_file_of_another_kind_is_named_with_its_reader(reader, path: Path, noun: str, command: str) -> None:
    with pytest.raises(InputError) as refused:
        reader(path)
    said = str(refused.value)
    assert f"{path}: is {noun}, expected " in said
    assert f"it is read by {command}" in said
    assert "\n" not in said


def test_a_spec_with_faults_stays_a_spec(tmp_path: Path) -> None:
    assert 'belt.wdth: unknown key "wdth"; did you mean "width"?' in changed(tmp_path, "  width:", "  wdth:")


@pytest.mark.parametrize(
    ("written", "meant"), [("2,300 ft", '"2.300 ft" or "2300 ft"'), ("2,5 km", '"2.5 km"'), ("1,50 km", '"1.50 km"')]
)
def test_a_comma_in_braces_tears_no_number_apart(tmp_path: Path, written: str, meant: str) -> None:
    first = GOOD[GOOD.index("sections:") :].split("length: ")[1].split(",")[0]
    said = changed(tmp_path, f"length: {first}", f"length: {written}")
    assert f'route.sections[0].length: got "{written}": a comma is ambiguous' in said
    assert meant in said
    assert "unknown key" not in said


def test_a_comma_that_tears_a_text_is_not_repaired(tmp_path: Path) -> None:
    name = GOOD[GOOD.index("sections:") :].split("name: ")[1].split(",")[0]
    assert 'unknown key "5 m"' in changed(tmp_path, f"name: {name}", "name: 2,5 m")


@pytest.mark.parametrize(("written", "number"), [("EP 1000/4", "1000"), ("ST1600", "1600"), ("st 2000", "2000")])
def test_a_designation_is_no_strength(tmp_path: Path, written: str, number: str) -> None:
    strength = GOOD.split("strength: ")[1].split("/mm")[0] + "/mm"
    said = changed(tmp_path, f"strength: {strength}", f"strength: {written}")
    assert (
        f'got "{written}": of a belt\'s designation write the number, "{number} N/mm"; its kind is a field of its own'
        in said
    )


@pytest.mark.parametrize(
    ("written", "meant"), [("ST", "steel cord"), ("nylon", "polyamide"), ("polyester", "EP"), ("Steel", "steel cord")]
)
def test_the_carcass_by_its_makers_name(tmp_path: Path, written: str, meant: str) -> None:
    assert f'did you mean "{meant}"?' in changed(tmp_path, "kind: steel cord", f"kind: {written}")


def test_a_density_mistaken_by_a_thousand_is_refused_at_its_field(tmp_path: Path) -> None:
    density = GOOD.split("density: ")[1].split(" kg/m^3")[0]
    said = changed(tmp_path, f"density: {density} kg/m^3", "density: 0.85 kg/m^3")
    assert "material.density: got 0.85 kg/m^3, allowed: >= 10 kg/m^3" in said


def test_a_density_too_small_for_the_flow_is_named_beside_it(tmp_path: Path) -> None:
    density = GOOD.split("density: ")[1].split(" kg/m^3")[0]
    said = changed(tmp_path, f"density: {density} kg/m^3", "density: 85 kg/m^3")
    assert "and 85 kg/m^3 (material.density) needs a cross-section of" in said


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("95", 'got 95, allowed: > 0 and <= 1; did you mean "95 %"?'),
        ("950", "got 950, allowed: > 0 and <= 1"),
        ("950 %", "got 950 %, allowed: > 0 % and <= 100 %"),
    ],
)
def test_percent_without_its_sign(tmp_path: Path, written: str, message: str) -> None:
    efficiency = GOOD.split("efficiency: ")[1].split(" %")[0]
    assert changed(tmp_path, f"efficiency: {efficiency} %", f"efficiency: {written}").endswith(message)


def test_a_name_without_its_ending_finds_its_neighbour(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(GOOD, encoding="utf-8")
    with pytest.raises(InputError, match=r'did you mean ".*mine\.yaml"\?'):
        spec.load(tmp_path / "mine")
    with pytest.raises(InputError, match=r'got "yours"$'):
        spec.load(tmp_path / "yours")


def test_a_report_is_no_workbook_to_fill_in(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    book.properties.category = CATEGORY
    book.save(tmp_path / "report.xlsx")
    with pytest.raises(InputError, match="is a report of conveyor, not a workbook to fill in"):
        spec.load(tmp_path / "report.xlsx")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("new", "mine"), 'a spec\'s name ends in .yaml, such as "mine.yaml"'),
        (("new", "mine.xlsx"), "a workbook to fill in: conveyor template mine.xlsx"),
        (("new", "mine.yaml", "--kind", "feeder", "--units", "us"), "conveyor power mine.yaml --units us"),
    ],
)
def test_the_message_holds_the_next_command(tmp_path: Path, words: tuple[str, ...], said: str) -> None:
    (tmp_path / "good.yaml").write_text(GOOD, encoding="utf-8")
    done = run(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr


def test_the_template_names_the_next_command(tmp_path: Path) -> None:
    done = run("template", "input.xlsx", cwd=tmp_path)
    assert "next: fill it in, then conveyor power input.xlsx" in done.stdout


def test_one_compound_is_no_comparison() -> None:
    alone = run("compare", str(SPECS / "shuttle.yaml"), "-c", "standard-cover")
    assert alone.returncode == 0
    assert "one compound has nothing to be compared with: name a second one with -c" in alone.stdout


def test_a_spec_is_no_table_of_a_laboratory() -> None:
    with pytest.raises(InputError, match=r"a \.yaml file is no table of a laboratory; give \.csv, \.txt or \.xlsx"):
        read_dma(SPECS / "overland.yaml")


def test_rows_pasted_twice_are_named(tmp_path: Path) -> None:
    rows = [f"{frequency},{1e6 * frequency**0.1:.0f},{1e5 * frequency**0.1:.0f}" for frequency in (1, 2, 4, 8, 16)]
    path = tmp_path / "twice.csv"
    path.write_text("\n".join(["frequency_Hz,E'_Pa,E''_Pa", *rows, *rows[:3]]), encoding="utf-8")
    with pytest.raises(InputError, match=r"3 row.s. repeat earlier ones digit for digit: delete them; else"):
        read_dma(path)


@pytest.mark.parametrize(("name", "unit"), [("feeder", " N "), ("overland", " kN ")])
def test_forces_of_a_short_belt_are_no_row_of_zeros(name: str, unit: str) -> None:
    lines = run("power", str(SPECS / f"{name}.yaml")).stdout.splitlines()
    indentation = next(line for line in lines if line.startswith("indentation"))
    assert unit in indentation
    assert float(indentation.split()[1]) > 1.0
