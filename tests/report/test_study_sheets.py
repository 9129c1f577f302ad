"""The workbook's sheets on the loop and on the studies a spec asks for."""

from __future__ import annotations

import openpyxl
import pytest

import conveyor
from conveyor.results.analysis import Studies, analyse_studies


@pytest.fixture(scope="module")
def asked(studied):
    return studied("overland_10km")[1]


@pytest.fixture(scope="module")
def result(studied):
    return studied("overland_10km")[0]


@pytest.fixture(scope="module")
def book(result, asked, tmp_path_factory):
    return openpyxl.load_workbook(result.to_excel(tmp_path_factory.mktemp("b") / "b.xlsx", asked))


def column(sheet, heading, name):
    """Values under a header of the table below a heading."""
    first = next(cell for row in sheet for cell in row if cell.value == heading)
    top = first.row + 1
    at = next(cell.column for cell in sheet[top][first.column - 1 :] if cell.value == name)
    values = []
    for row in range(top + 1, sheet.max_row + 1):
        if sheet.cell(row, first.column).value is None:
            break
        values.append(sheet.cell(row, at).value)
    return values


def test_sheets_follow_the_spec(book, result, tmp_path):
    assert {"States", "Loop", "Load cases", "Duty", "Uncertainty"} <= set(book.sheetnames)
    assert book.sheetnames[-1] == "Checks and notes"
    plain = openpyxl.load_workbook(result.to_excel(tmp_path / "plain.xlsx", Studies()))
    assert not {"Load cases", "Duty", "Uncertainty"} & set(plain.sheetnames)


def test_figures_are_the_tables(book, result, asked):
    motors = column(book["Load cases"], "Load cases", "motor power [kW]")
    assert motors == pytest.approx(asked.cases.table["motor power [kW]"].tolist())
    energy = column(book["Duty"], "Hours at load, temperature and speed", "energy [MWh]")
    assert energy == pytest.approx(asked.duty.table["energy [MWh]"].tolist())
    swings = column(book["Uncertainty"], "Sensitivity ranking", "swing [kW]")
    assert swings == sorted(swings, reverse=True)
    forces = column(book["Loop"], "Drives in every state of motion", "force [N]")
    assert forces == pytest.approx(result.tables["drives"].frame()["force [N]"].tolist())


def test_yes_and_no_are_words(book):
    assert set(column(book["Pulleys"], "Pulleys", "large enough")) <= {"yes", "NO"}


def test_spec_without_studies_studies_nothing():
    none = analyse_studies(conveyor.load("examples/specs/downhill.yaml"))
    assert (none.cases, none.duty, none.uncertainty) == (None, None, None)
    assert set(none.to_dict()) == {"states", "worst_states", "flooded", "take_up"}


def test_json_holds_what_was_asked(asked):
    found = asked.to_dict()
    assert set(found) == {"states", "worst_states", "flooded", "take_up", "load_cases", "duty", "uncertainty"}
