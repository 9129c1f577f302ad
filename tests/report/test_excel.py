"""The workbook read back: numbers as numbers, text as text, charts, refusals."""

from __future__ import annotations

from pathlib import Path

import openpyxl
import pandas as pd
import pytest

import conveyor
from conveyor.errors import InputError

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
DIGITS = 1e-15  # openpyxl writes 16 significant digits
SHEETS = [
    "Summary", "Inputs", "Sections", "Resistances", "Rolls", "Tensions", "Indentation", "Rubber", "Checks and notes",
]  # fmt: skip


@pytest.fixture(scope="module")
def overland():
    return conveyor.analyse(conveyor.load(SPECS / "overland.yaml"))


@pytest.fixture(scope="module")
def book(overland, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "overland.xlsx"
    assert overland.to_excel(path) == path
    return path


def test_sheets_and_charts(book):
    read = openpyxl.load_workbook(book)
    assert read.sheetnames == SHEETS
    charts = {sheet.title: len(sheet._charts) for sheet in read}
    assert charts["Summary"] == charts["Tensions"] == charts["Indentation"] == 1
    assert charts["Rubber"] == 2


def test_no_formula_and_no_error_cell(book):
    for sheet in openpyxl.load_workbook(book):
        for row in sheet.iter_rows():
            for cell in row:
                assert cell.data_type not in {"f", "e"}, (sheet.title, cell.coordinate, cell.value)


@pytest.mark.parametrize(
    ("sheet", "name"), [("Sections", "sections"), ("Rolls", "rolls"), ("Resistances", "resistances")]
)
def test_tables_are_the_analysis_to_the_last_digit(book, overland, sheet, name):
    expected = getattr(overland, name)
    read = pd.read_excel(book, sheet_name=sheet, header=1).iloc[: len(expected)]
    assert list(read.columns) == list(expected.columns)
    for column in expected:
        if expected[column].dtype.kind == "f":
            assert read[column].astype(float).tolist() == pytest.approx(
                expected[column].tolist(), rel=DIGITS
            ), column
        else:
            assert read[column].tolist() == expected[column].tolist(), column


def test_summary_holds_every_figure(book, overland):
    sheet = openpyxl.load_workbook(book)["Summary"]
    found = {sheet.cell(i, 1).value: sheet.cell(i, 2).value for i in range(6, 6 + len(overland.summary))}
    assert found == pytest.approx(dict(overland.summary.items()), rel=DIGITS)


def test_inputs_as_entered_and_in_si(book):
    read = pd.read_excel(book, sheet_name="Inputs", header=1).set_index("field")
    assert read.loc["belt.width", "as entered"] == "1200 mm"
    assert read.loc["belt.width", "SI value"] == 1.2
    assert read.loc["belt.width", "SI unit"] == "m"
    assert read.loc["ambient.temperature", "SI value"] == 293.15
    assert read.loc["belt.carcass.strength", "SI unit"] == "N/m"
    assert read.loc["belt.bottom_cover.compound", "as entered"] == "low-rolling-resistance-cover"


def test_warnings_and_provenance_are_in_it(book, overland):
    sheet = openpyxl.load_workbook(book)["Checks and notes"]
    cells = [cell.value for row in sheet.iter_rows() for cell in row if cell.value is not None]
    for line in (*overland.warnings, *overland.assumptions):
        assert line in cells
    assert conveyor.__version__ in cells
    assert any(isinstance(value, str) and len(value) == 64 for value in cells)


@pytest.mark.parametrize("name", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)"])
def test_what_a_user_types_stays_text(overland, tmp_path, name):
    sections = [overland.conveyor.route.sections[0].replace(name=name), *overland.conveyor.route.sections[1:]]
    line = overland.conveyor
    line = line.replace(name=name, notes=name, route=line.route.replace(sections=sections))
    path = conveyor.analyse(line).to_excel(tmp_path / "typed.xlsx")
    read = openpyxl.load_workbook(path)
    hits = [cell for sheet in read for row in sheet.iter_rows() for cell in row if cell.value == name]
    assert len(hits) >= 4
    for cell in hits:
        assert cell.data_type == "s"
        assert cell.quotePrefix


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ("report.pdf", "ends in .xlsx"),
        ("nowhere/report.xlsx", "does not exist"),
        ("folder.xlsx", "is a folder"),
    ],
)
def test_refused_paths_leave_nothing_behind(overland, tmp_path, target, message):
    (tmp_path / "folder.xlsx").mkdir()
    with pytest.raises(InputError, match=message):
        overland.to_excel(tmp_path / target)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.xlsx"]


def test_an_older_workbook_survives_a_failed_write(overland, tmp_path, monkeypatch):
    path = tmp_path / "report.xlsx"
    path.write_bytes(b"old")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(openpyxl.Workbook, "save", full)
    with pytest.raises(InputError, match="No space left"):
        overland.to_excel(path)
    assert path.read_bytes() == b"old"
    assert [item.name for item in tmp_path.iterdir()] == ["report.xlsx"]
