"""The sheet for a belt maker: our figures are those of single contacts, theirs are empty, a gap has its reason."""

from __future__ import annotations

import math
import re
from pathlib import Path

import openpyxl
import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError
from conveyor.indentation import RollContact, indentation_resistance
from conveyor.languages import TRANSLATED
from conveyor.measured.rolling_test_table import read_rolling_tests
from conveyor.report import excel, html
from conveyor.report.cells import INPUT_FILL
from conveyor.studies.verification import SPACING
from conveyor.units import si
from tests.loop.loop_lines import line

ONE = {"temperatures": ["20 degC"], "roll_diameters": ["219 mm"], "speeds": ["5 m/s"], "covers": ["7 mm"]}


def test_figures_are_those_of_a_single_contact():
    found = conveyor.verify_sheet(["s100"], line_loads=["1 N/mm", "8 N/mm"], **ONE)
    (row,) = found.rows
    compound = shelf.compound("s100")
    roll = RollContact(0.1095, SPACING, 0.007, 5.0, compound.series(293.15), compound.poisson_ratio)
    for load, resistance in zip((1e3, 8e3), row.resistances, strict=True):
        # a load curve is good to its rtol of 1e-6, the single contact to its own
        assert resistance == pytest.approx(float(indentation_resistance(roll, load).resistance), rel=3e-6)


def test_a_softened_figure_lies_below_where_the_rubber_softens():
    """Strain sweeps of S100 lower E" at 3 % strain to 0.76 and E' to 0.68: f of rubber goes with E"/E'^(4/3)."""
    linear, softened = (
        conveyor.verify_sheet(["s100"], line_loads=["8 N/mm"], softened=yes, **ONE).rows[0].resistances[0]
        for yes in (False, True)
    )
    assert linear is not None
    assert softened is not None
    assert softened / linear == pytest.approx(0.76 / 0.685 ** (4.0 / 3.0), rel=0.1)


def test_a_temperature_without_data_has_its_reason_and_no_figure():
    found = conveyor.verify_sheet(["s100"], line_loads=["2 N/mm"], **ONE | {"temperatures": ["20 degC", "150 degC"]})
    known, unknown = found.rows
    assert known.reason == ""
    assert unknown.resistances == (None,)
    assert "150 degC" in unknown.reason
    frame = found.table
    assert frame["no figure because"].tolist()[1] == unknown.reason


def test_without_temperatures_each_compound_is_asked_where_it_is_known():
    found = conveyor.verify_sheet(
        ["s100"], line_loads=["2 N/mm"], **{k: v for k, v in ONE.items() if k != "temperatures"}
    )
    assert all(row.reason == "" for row in found.rows)
    assert {round(row.temperature - 273.15) for row in found.rows} <= set(range(-20, 41, 10))


def test_the_set_is_the_most_loaded_one_of_the_conveyor():
    given = line(calculation={"strain": "off"})
    found = conveyor.verify_sheet(["s100"], line_loads=["2 N/mm"], conveyor=given, **ONE)
    (row,) = found.sets
    carry = [s for s in conveyor.analyse(given).stretches if s.stretch.strand == "carry"]
    loads = [math.fsum(roll.load.force for roll in s.rolls) for s in carry]
    heaviest = carry[loads.index(max(loads))]
    assert row.load == pytest.approx(max(loads), rel=1e-12)
    # the bottom cover is of S100 and the covers are at 20 degC as in the spec; contacts to the rtol of 1e-6
    assert row.resistance == pytest.approx(math.fsum(roll.resistance for roll in heaviest.rolls), rel=1e-6)


def test_the_makers_columns_are_empty_and_marked(tmp_path: Path):
    found = conveyor.verify_sheet(["s100", "standard-cover"], line_loads=["1 N/mm", "2 N/mm"], **ONE)
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(excel.workbook_files(found.contents(), path)[path])
    book = openpyxl.load_workbook(path)
    assert book.sheetnames == ["About", "N per width"]
    sheet = book["N per width"]
    heads = [cell.value for cell in sheet[2]]
    assert heads[5:9] == ["at 1 N/mm, ours [N/m]", "maker [N/m]", "at 2 N/mm, ours [N/m]", "maker [N/m]"]
    for row in sheet.iter_rows(min_row=3, max_row=4, min_col=6, max_col=9):
        ours, theirs = row[0::2], row[1::2]
        assert all(isinstance(cell.value, float) for cell in ours)
        assert all(cell.value is None and cell.fill.fgColor.rgb == f"00{INPUT_FILL.fgColor.rgb[2:]}" for cell in theirs)
        assert not any(cell.protection.locked for cell in theirs)
    assert sheet.freeze_panes == "F3"
    assert sheet.print_title_rows == "$1:$2"
    assert str(sheet.page_setup.paperSize) == sheet.PAPERSIZE_A4


def test_the_page_leaves_cells_empty_and_says_what_the_figures_are():
    found = conveyor.verify_sheet(["s100"], line_loads=["1 N/mm"], **ONE)
    written = str(html.build_page(found.contents("US")))
    assert re.search(r'<td class="asked"[^>]*></td>', written)
    assert "bonded to a carcass that does not give (confined)" in written
    assert "at 5.71 lbf/in, ours" in written
    assert "SHA-256" not in written


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"line_loads": ["4"]}, '"4"'),
        ({"covers": ["7 m"]}, "covers: got 7 m, allowed: >= 0.001 m and <= 0.1 m"),
        ({"speeds": []}, "speeds: give at least one"),
        ({"line_loads": [f"{1 + 0.0001 * k:.4f} N/mm" for k in range(100_001)]}, "at most 100,000 are calculated"),
    ],
)  # fmt: skip
def test_what_no_roll_has_is_refused(changed: dict[str, list[str]], said: str):
    with pytest.raises(InputError, match=said):
        conveyor.verify_sheet(["s100"], **ONE | changed)
    with pytest.raises(InputError, match="compounds: give at least one"):
        conveyor.verify_sheet([])


@pytest.mark.parametrize("language", TRANSLATED)
def test_a_sheet_in_any_language_is_read_as_tests(tmp_path: Path, language: str):
    asked = {**ONE, "line_loads": ["1.5 N/mm", "4 N/mm"]}
    contents = conveyor.verify_sheet(["s100"], **asked).contents("SI").in_language(language)
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(excel.workbook_files(contents, path)[path])
    book = openpyxl.load_workbook(path)
    cells = book.worksheets[1]
    assert cells.title != "N per width"
    cells.cell(3, 7).value = 21.5
    book.save(path)
    (test,) = read_rolling_tests(path)
    assert [si(load) for load in test.line_load] == pytest.approx([1.5e3])
    assert [si(force) for force in test.resistance] == pytest.approx([21.5])
    assert si(test.roll_diameter) == pytest.approx(0.219)


@pytest.mark.parametrize("system", ["SI", "US"])
def test_a_sheet_filled_in_is_read_as_tests(tmp_path: Path, system: str):
    asked = {**ONE, "temperatures": ["0 degC", "20 degC"], "line_loads": ["1 N/mm", "4 N/mm"]}
    found = conveyor.verify_sheet(["s100", "s120"], **asked)
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(excel.workbook_files(found.contents(system), path)[path])
    with pytest.raises(InputError, match=r"sheet\.xlsx\[N per width\]:2: column A: no figure of the maker in it"):
        read_rolling_tests(path)
    book = openpyxl.load_workbook(path)
    cells = book["N per width"]
    given = {(3, 7): 1.5, (3, 9): 1.6, (4, 9): 1.7}  # row, column: times our figure beside it
    for (row, column), factor in given.items():
        cells.cell(row, column).value = factor * cells.cell(row, column - 1).value
    book.save(path)
    cold, warm = read_rolling_tests(path, "report 7")
    ours = found.table[["at 1 N/mm, ours [N/m]", "at 4 N/mm, ours [N/m]"]].to_numpy()
    # loads stand in the headers with four digits, figures in the cells with all
    assert [si(load) for load in cold.line_load] == pytest.approx([1e3, 4e3], rel=5e-4)
    assert [si(force) for force in cold.resistance] == pytest.approx([1.5 * ours[0, 0], 1.6 * ours[0, 1]], rel=1e-6)
    assert [si(force) for force in warm.resistance] == pytest.approx([1.7 * ours[1, 1]], rel=1e-6)
    assert si(warm.roll_diameter) == pytest.approx(0.219)
    cells.cell(3, 7).value = "9 N"
    book.save(path)
    with pytest.raises(InputError, match=r"\[N per width\]:3: column G .*'9 N' holds a unit"):
        read_rolling_tests(path)
    cells.cell(3, 7).value, cells.cell(5, 7).value = None, 9.0
    book.save(path)
    with pytest.raises(InputError, match=r"\[N per width\]:5: column A: figures of the maker beside S100 and S120"):
        read_rolling_tests(path)


def test_columns_of_the_maker_belong_to_ours_before_them(tmp_path: Path):
    found = conveyor.verify_sheet(["s100"], **ONE | {"line_loads": ["1 N/mm", "4 N/mm"]})
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(excel.workbook_files(found.contents("SI"), path)[path])
    book = openpyxl.load_workbook(path)
    cells = book["N per width"]
    for column in (7, 9):
        cells.cell(3, column).value = 1.5 * cells.cell(3, column - 1).value
    cells.insert_cols(7)
    cells.cell(2, 7).value = "their remark"
    book.save(path)
    (test,) = read_rolling_tests(path)
    assert [si(load) for load in test.line_load] == pytest.approx([1e3, 4e3], rel=1e-12)
    cells.delete_cols(10)
    book.save(path)
    (test,) = read_rolling_tests(path)
    assert [si(load) for load in test.line_load] == pytest.approx([1e3], rel=1e-12)
    cells.delete_cols(6)
    book.save(path)
    with pytest.raises(InputError, match=r"2: column G \"maker \[N/m\]\": no column of ours before it"):
        read_rolling_tests(path)
