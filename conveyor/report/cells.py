"""Cells and tables of the workbook: text stays text, numbers stay numbers, formats follow the kinds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from copy import copy
from dataclasses import dataclass
from datetime import date
from textwrap import wrap
from types import MappingProxyType
from typing import Any

from openpyxl.cell.cell import Cell, MergedCell
from openpyxl.styles import Alignment, Border, Font, PatternFill, Protection, Side
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report.table_model import FIGURE_NAME, ROW_KIND, Table
from conveyor.text.printable import escape_controls, text_width
from conveyor.units import System
from conveyor.units.presentation import NEVER, display_unit

ACCENT = "1F4E79"
TITLE = Font(name="Calibri", size=16, bold=True, color=ACCENT)
HEADING = Font(name="Calibri", size=12, bold=True, color=ACCENT)
FIGURE = Font(name="Calibri", size=16, bold=True, color=ACCENT)
BOLD = Font(name="Calibri", bold=True)
GREY = Font(name="Calibri", italic=True, color="666666")
LINK = Font(name="Calibri", underline="single", color=ACCENT)
PALE = PatternFill("solid", fgColor="E8EEF5")
TOTAL = Border(top=Side(style="thin", color=ACCENT))
INPUT_FILL = PatternFill("solid", fgColor="FFF9DB")
_LINE = Side(style="thin", color="B5A55A")
_BOX = Border(left=_LINE, right=_LINE, top=_LINE, bottom=_LINE)
_HEADER = Font(name="Calibri", bold=True, color="FFFFFF")
_FILL = PatternFill("solid", fgColor=ACCENT)
_HEADER_GAP = Border(left=Side(style="thin", color="FFFFFF"), right=Side(style="thin", color="FFFFFF"))
_LEFT = Alignment(horizontal="left", indent=1)
_CENTRE = Alignment(horizontal="center")


@dataclass(frozen=True)
class CellStyle:
    """Font and fill of a verdict."""

    font: Font
    fill: PatternFill


_GOOD = CellStyle(Font(name="Calibri", color="1E6B34"), PatternFill("solid", fgColor="E2F0E5"))
_BAD = CellStyle(Font(name="Calibri", bold=True, color="FFFFFF"), PatternFill("solid", fgColor="B3261E"))
_OPEN = CellStyle(Font(name="Calibri", italic=True, color="7A5200"), PatternFill("solid", fgColor="FFF3D6"))
VERDICT_STYLES = {"pass": _GOOD, "yes": _GOOD, "FAIL": _BAD, "NO": _BAD, "not checked": _OPEN}
"""Bold on dark is a failure without colours, too."""
INFINITY_SIGN = "∞"
"""A cell cannot hold infinity as a number."""

_UNSAFE = ("=", "+", "-", "@", "\t", "\r", "\n")
CELL_CHARACTERS = 32_767
"""Characters a cell can hold (Excel specifications and limits)."""
_NARROWEST, _WIDEST = 10, 60
_ALL_ALIKE = MappingProxyType[str, int]({})
_LETTERS_PER_DIGIT = 1.1  # characters of text on the width of one digit
_BOLD_WIDTH = 1.1  # of the width of plain text
_ROW_HEIGHT_LIMIT = 409.0
"""Height of a row at most [pt] (Excel specifications and limits)."""


def cell_text(words: str) -> str:
    r"""Return text that a cell can hold: printable, cut to the length Excel allows.

    Examples
    --------
    >>> cell_text("bell\x07")
    'bell\\x07'
    """
    shown = escape_controls(words)
    if len(shown) <= CELL_CHARACTERS:
        return shown
    mark = f" ... (cut here: {len(words)} characters)"
    return shown[: CELL_CHARACTERS - len(mark)] + mark


def write_value(cell: Cell | MergedCell, value: Any, font: Font | None = None, shown: str | None = None) -> None:
    """Write one value: text always as text, numbers as numbers, nothing for None."""
    if isinstance(cell, MergedCell) or value is None or (isinstance(value, float) and math.isnan(value)):
        return  # pandas writes a missing number of a mixed column as NaN
    if isinstance(value, str):
        cell.value = cell_text(value)
        cell.data_type = "s"
        if value.startswith(_UNSAFE):
            cell.quotePrefix = True
    else:
        cell.value = value.item() if hasattr(value, "item") else value
        if isinstance(value, date):
            cell.number_format = "yyyy-mm-dd"
    if shown is not None:
        cell.number_format = shown
    if font is not None:
        cell.font = font


def write_table(
    sheet: Worksheet,
    shown: Table,
    system: System,
    row: int,
    column: int = 1,
    *,
    widest: int = _WIDEST,
    wider: Mapping[str, int] = _ALL_ALIKE,
    words: Callable[[str], str] = str,
) -> int:
    """Write a table with its header at (row, column); returns its last row.

    Parameters
    ----------
    sheet, shown, system, row, column
        What, in which units, and where its first header cell goes.
    widest : int
        Width at which a column of long text stops growing [characters].
    wider : mapping of str to int
        The same of single columns, by their keys.
    words : callable
        Translates verdicts and what stands for yes, no and infinity; the texts of the table are written as they are.
    """
    names = [shown.head(each, system) for each in shown.columns]
    for j, (each, name) in enumerate(zip(shown.columns, names, strict=True), start=column):
        cells = shown.names(system) if each.kind == FIGURE_NAME else shown.cells(each, system)
        infinite = words(NEVER) if each.kind == "years" else INFINITY_SIGN
        values = [_cell_value(value, infinite) for value in cells]
        number = each.kind == ROW_KIND or (
            each.kind != FIGURE_NAME and display_unit(each.kind, system).label is not None
        )
        text = not number and all(v is None or isinstance(v, str) for v in values)
        _header_cell(sheet.cell(row, j), name, right=not text)
        at = row + 1, j
        patterns = [shown.unit(each, item, system).pattern for item in shown.rows]
        most = wider.get(each.key, widest)
        verdicts = values if each.kind == "verdict" else []
        values = [words(value) for value in verdicts] or values
        longest = _text_column(sheet, at, values, most) if text else _number_column(sheet, at, values, patterns)
        _colour_verdicts(sheet, at, verdicts)
        if each.asked:
            _mark_inputs(sheet, at, len(values))
        letter = get_column_letter(j)
        known = sheet.column_dimensions[letter].width if letter in sheet.column_dimensions else 0.0
        wanted = min(most, max(_NARROWEST, longest, round(_BOLD_WIDTH * _two_line_width(name)) + 3))
        sheet.column_dimensions[letter].width = max(known, wanted)
    _align_tops(sheet, (row + 1, row + len(shown.rows)), (column, column + len(names) - 1))
    wrapped = any(text_width(name) + 2 > _column_width(sheet, j) for j, name in enumerate(names, start=column))
    known_height = sheet.row_dimensions[row].height or 0.0
    sheet.row_dimensions[row].height = max(known_height, 31.0 if wrapped else 16.0)
    return row + len(shown.rows)


def _align_tops(sheet: Worksheet, rows: tuple[int, int], columns: tuple[int, int]) -> None:
    """Align the cells of rows of several lines to the top."""
    for i in range(rows[0], rows[1] + 1):
        if (sheet.row_dimensions[i].height if i in sheet.row_dimensions else None) is None:
            continue
        for j in range(columns[0], columns[1] + 1):
            cell = sheet.cell(i, j)
            kept = cell.alignment
            cell.alignment = Alignment(
                horizontal=kept.horizontal, indent=kept.indent, wrap_text=kept.wrap_text, vertical="top"
            )


def _text_column(sheet: Worksheet, at: tuple[int, int], values: list[Any], widest: int) -> int:
    """Write a column of text from (row, column) downward; return the width it needs."""
    longest, model = 0, None
    for i, value in enumerate(values, start=at[0]):
        if value is None:
            continue
        cell = sheet.cell(i, at[1])
        lines = line_count(value, widest - 2)
        if lines > 1:
            cell.alignment = Alignment(horizontal="left", indent=1, wrap_text=True, vertical="top")
            known = sheet.row_dimensions[i].height if i in sheet.row_dimensions else None
            sheet.row_dimensions[i].height = min(_ROW_HEIGHT_LIMIT, max(15.0 * lines, known or 0.0))
        elif model is None:
            cell.alignment, model = _LEFT, cell
        else:
            _copy_style(cell, model)
        write_value(cell, value)
        longest = max(longest, text_width(value) + 3)
    return longest


def _number_column(sheet: Worksheet, at: tuple[int, int], values: list[Any], formats: list[str]) -> int:
    """Write a column of numbers from (row, column) downward, each in its format; return the width it needs."""
    longest = 0
    models: dict[str, Cell | MergedCell] = {}
    for i, (value, shown) in enumerate(zip(values, formats, strict=True), start=at[0]):
        cell = sheet.cell(i, at[1])
        if shown in models:
            _copy_style(cell, models[shown])
        else:
            cell.number_format, models[shown] = shown, cell
        write_value(cell, value)
        if isinstance(value, str):
            cell.alignment = Alignment(horizontal="right")
        longest = max(longest, _number_width(cell.value, shown))
    return longest


def line_count(words: str, width: float) -> int:
    """Number of lines of a text at a column width [digits]."""
    room = int(_LETTERS_PER_DIGIT * width)
    letters = text_width(words)
    return max(1, len(wrap(words, room)) if letters == len(words) else math.ceil(letters / room))


def _copy_style(cell: Any, model: Any) -> None:
    """Copy the style of a cell: ten times as fast as setting its parts."""
    cell._style = copy(model._style)  # noqa: SLF001 openpyxl's own way to copy a look


def _colour_verdicts(sheet: Worksheet, at: tuple[int, int], values: list[Any]) -> None:
    """Colour the verdicts of a column."""
    for i, value in enumerate(values, start=at[0]):
        if value in VERDICT_STYLES:
            look = VERDICT_STYLES[value]
            cell = sheet.cell(i, at[1])
            cell.font, cell.fill, cell.alignment = look.font, look.fill, _CENTRE


def _mark_inputs(sheet: Worksheet, at: tuple[int, int], count: int) -> None:
    """Mark a column of cells for the reader to fill in."""
    for i in range(at[0], at[0] + count):
        mark_input(sheet.cell(i, at[1]))


def mark_input(cell: Cell | MergedCell) -> None:
    """Mark a cell that the reader may fill in or change."""
    cell.fill, cell.border, cell.protection = INPUT_FILL, _BOX, Protection(locked=False)


def _cell_value(value: Any, infinite: str) -> Any:
    """Yes/no as text, infinity as a symbol, NaN as empty."""
    if isinstance(value, bool):
        return "yes" if value else "NO"
    if isinstance(value, float):
        return None if math.isnan(value) else value if math.isfinite(value) else infinite
    return value


def _header_cell(cell: Cell | MergedCell, name: str, *, right: bool) -> None:
    write_value(cell, name, _HEADER)
    cell.fill = _FILL
    if name:
        cell.border = _HEADER_GAP
    side, indent = ("right", 0) if right else ("left", 1)
    cell.alignment = Alignment(wrap_text=True, vertical="center", horizontal=side, indent=indent)


def header_row(sheet: Worksheet, row: int, column: int, names: Iterable[str]) -> None:
    """Write the header of a table of text from a cell to the right."""
    for j, name in enumerate(names, start=column):
        _header_cell(sheet.cell(row, j), name, right=False)


def _two_line_width(name: str) -> int:
    """Smallest width at which a name takes at most two lines [characters]."""
    words = name.split()
    breaks = [(" ".join(words[:i]), " ".join(words[i:])) for i in range(len(words))]
    return min(max(map(text_width, lines)) for lines in breaks)


def _number_width(value: Any, shown: str) -> int:
    """Characters a number takes, with a margin."""
    if not isinstance(value, int | float):
        return 0
    if shown.startswith("#,##0"):
        return len(f"{value:,.{max(0, len(shown) - 6)}f}") + 2
    return 13 if shown == "General" else 10


def _column_width(sheet: Worksheet, column: int) -> float:
    return float(sheet.column_dimensions[get_column_letter(column)].width)


def write_totals(sheet: Worksheet, row: int, shown: Table, system: System, first: int) -> None:
    """Write a table's line of totals from a first column, a rule above it."""
    for j, (column, value) in enumerate(zip(shown.columns, shown.totals(), strict=True), start=first):
        cell = sheet.cell(row, j)
        if isinstance(value, str):
            write_value(cell, value, BOLD)
            cell.alignment = Alignment(horizontal="left", indent=1)
        else:
            written = display_unit(column.kind, system)
            write_value(cell, written.shown(value), BOLD, written.pattern)
        cell.border = TOTAL
