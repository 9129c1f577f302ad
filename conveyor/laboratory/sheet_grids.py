"""Sheets of an .xlsx workbook to grids of text cells."""

from __future__ import annotations

from typing import Final

from conveyor.files.workbook_cells import ArchiveLimits, Sheet, SheetCell, read_sheets
from conveyor.laboratory.cell_grid import TextGrid, TextLine
from conveyor.laboratory.numbers import DATE_MARK, PERCENT_MARK, half_width

LIMITS: Final = ArchiveLimits(
    content=100_000_000, parts=2_000, elements=3_000_000, expected="table of a laboratory; export it as CSV"
)
"""A sheet of a million cells has about as many bytes, and an element for each cell and each value."""


def workbook_grids(data: bytes, name: str) -> tuple[TextGrid, ...]:
    """Every worksheet, named `file[sheet]`.

    Notes
    -----
    A formula is read as its stored value, else as an empty cell. Dates and numbers shown as a percentage are
    marked, so that they are refused where a number is expected.
    """
    return tuple(
        TextGrid(
            f"{name}[{sheet.name}]",
            tuple(_sheet_lines(sheet)),
            (f"workbook, sheet '{sheet.name}'",),
            sheet.name,
        )
        for sheet in read_sheets(data, f"{name}:1: column A", LIMITS)
    )


def _sheet_lines(sheet: Sheet) -> list[TextLine]:
    rows: dict[int, dict[int, str]] = {}
    for (row, column), cell in sheet.cells.items():
        if text := _cell_text(cell):
            rows.setdefault(row, {})[column] = text
    lines = []
    for number in sorted(rows):
        cells = [rows[number].get(column, "") for column in range(1, max(rows[number]) + 1)]
        comment = cells[0].startswith("#")
        if comment:
            cells[0] = cells[0].lstrip("# ")
        lines.append(TextLine(number, tuple(cells), " ".join(filter(None, cells)), comment))
    return lines


def _cell_text(cell: SheetCell) -> str:
    if cell.kind == "no result":
        return ""
    if cell.kind == "date":
        return f"{DATE_MARK}{cell.value}"
    if isinstance(cell.value, float | int) and not isinstance(cell.value, bool):
        return PERCENT_MARK * cell.percent + repr(cell.value)
    return half_width(" ".join(str(cell.value).split()))
