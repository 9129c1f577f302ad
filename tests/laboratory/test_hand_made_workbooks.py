"""Workbooks that no spreadsheet wrote: what they state about their size is not believed, and nothing hangs."""

from __future__ import annotations

import re
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest

from conveyor import laboratory
from conveyor.errors import InputError
from conveyor.laboratory import read_dma

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
SPREADSHEET = "application/vnd.openxmlformats-officedocument.spreadsheetml"
PARTS = {
    "[Content_Types].xml": (
        f'<Types xmlns="{PACKAGE}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{SPREADSHEET}.sheet.main+xml"/>'
        f'<Override PartName="/xl/sheet.xml" ContentType="{SPREADSHEET}.worksheet+xml"/></Types>'
    ),
    "_rels/.rels": (
        f'<Relationships xmlns="{PACKAGE}/relationships">'
        f'<Relationship Id="r1" Type="{OFFICE}/officeDocument" Target="xl/workbook.xml"/></Relationships>'
    ),
    "xl/workbook.xml": (
        f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}">'
        '<sheets><sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>'
    ),
    "xl/_rels/workbook.xml.rels": (
        f'<Relationships xmlns="{PACKAGE}/relationships">'
        f'<Relationship Id="r1" Type="{OFFICE}/worksheet" Target="sheet.xml"/></Relationships>'
    ),
}
COUNT = 13


def row(number: int, *values: float | str) -> str:
    cells = [
        f'<c r="{c}{number}" t="inlineStr"><is><t>{v}</t></is></c>'
        if isinstance(v, str)
        else f'<c r="{c}{number}"><v>{v}</v></c>'
        for c, v in zip("ABC", values, strict=True)
    ]
    return f'<row r="{number}">{"".join(cells)}</row>'


HEADER = row(1, "frequency [Hz]", "E' [MPa]", "E'' [MPa]")
TABLE = HEADER + "".join(row(i + 2, 10.0 ** (0.5 * i), 2.0 + 0.1 * i, 0.1 + 0.05 * i) for i in range(COUNT))


def workbook(folder: Path, rows: str, *, before: str = "", after: str = "") -> Path:
    path = folder / "made.xlsx"
    sheet = f'<worksheet xmlns="{MAIN}">{before}<sheetData>{rows}</sheetData>{after}</worksheet>'
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in {**PARTS, "xl/sheet.xml": sheet}.items():
            archive.writestr(name, text)
    return path


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('<dimension ref="A1:C8"/>', ""),
        ('<dimension ref="A1:XFD1048576"/>', ""),
        ("", ""),
        ("", '<mergeCells count="1"><mergeCell ref="A40:XFD1048576"/></mergeCells>'),
        ("", '<hyperlinks><hyperlink ref="B40:XFD1048576" location="x"/></hyperlinks>'),
    ],
    ids=["dimension too small", "dimension too large", "no dimension", "merged", "hyperlink"],
)
def test_every_row_of_the_sheet_is_read(tmp_path: Path, before: str, after: str) -> None:
    found = read_dma(workbook(tmp_path, TABLE, before=before, after=after))
    assert found.frequency is not None
    assert found.frequency.size == COUNT


def test_a_gap_of_a_million_rows_costs_nothing(tmp_path: Path) -> None:
    found = read_dma(workbook(tmp_path, TABLE + row(1_048_576, 1e8, 4.0, 1.0)))
    assert found.row_numbers[-1] == 1_048_576


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (TABLE + row(99_999_999_999, 1.0, 2.0, 0.3), "cell or row 99999999999, beyond the last of a sheet"),
        (row(3, 1.0, 2.0, 0.3) + TABLE, "sheet 'S' has cell A3 twice; open and save the workbook again"),
        (
            TABLE + '<row r="20"><c r="ZZZ20"><v>1</v></c></row>',
            "cell or row ZZZ20, beyond the last of a sheet",
        ),
        (
            TABLE + "<a>" * 101 + "</a>" * 101,
            "nested deeper than 100 levels; this is no table of a laboratory",
        ),
    ],
    ids=["row far away", "row twice", "column far away", "nested"],
)
def test_rows_that_cannot_be_are_refused(tmp_path: Path, rows: str, message: str) -> None:
    with pytest.raises(InputError, match=r"made.xlsx:1: column A: .*" + re.escape(message)):
        read_dma(workbook(tmp_path, rows))


def test_more_cells_than_are_read_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = replace(laboratory.sheet_grids.LIMITS, elements=100)
    monkeypatch.setattr(laboratory.sheet_grids, "LIMITS", few)
    with pytest.raises(InputError, match=r"holds more than 100 cells and other elements; .* export it as CSV"):
        read_dma(workbook(tmp_path, TABLE + '<row r="20">' + "<c/>" * 100 + "</row>"))


def test_rows_in_any_order_are_read_by_their_numbers(tmp_path: Path) -> None:
    found = read_dma(workbook(tmp_path, row(20, 1e-3, 1.0, 0.05) + TABLE))
    assert found.row_numbers[0] == 20
