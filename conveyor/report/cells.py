"""Cells and tables of the workbook: text stays text, numbers stay numbers, formats follow the units."""

from __future__ import annotations

import math
import re
from datetime import date
from typing import Any

import pandas as pd
from openpyxl.cell.cell import Cell, MergedCell
from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.header_footer import HeaderFooterItem, _HeaderFooterPart
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

ACCENT = "1F4E79"
TITLE = Font(name="Calibri", size=16, bold=True, color=ACCENT)
HEADING = Font(name="Calibri", size=12, bold=True, color=ACCENT)
FIGURE = Font(name="Calibri", size=16, bold=True, color=ACCENT)
BOLD = Font(name="Calibri", bold=True)
GREY = Font(name="Calibri", italic=True, color="666666")
LINK = Font(name="Calibri", underline="single", color=ACCENT)
PALE = PatternFill("solid", fgColor="E8EEF5")
TOTAL = Border(top=Side(style="thin", color=ACCENT))
_HEADER = Font(name="Calibri", bold=True, color="FFFFFF")
_FILL = PatternFill("solid", fgColor=ACCENT)

_UNSAFE = ("=", "+", "-", "@", "\t", "\r", "\n")
_UNPRINTABLE = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
LONGEST = 32_767
"""Characters a cell can hold (Excel specifications and limits)."""
_NARROWEST, _WIDEST = 10, 60
_PAGE_ROWS = 60  # that a landscape page still shows legibly
_HIGHEST = 409.0
"""Height of a row at most [pt] (Excel specifications and limits)."""

# Number format by unit; the first pattern that the column's name matches
_FORMATS = (
    (r"error", "0.0E+00"),
    (r"^transit", "#,##0"),
    (r"^(time|stopping time).*\[s\]", "#,##0.0"),
    (r"\[(s|Hz)\]", "0.00E+00"),
    (r"\[(kg|t)\]", "#,##0"),
    (r"\[m/s²\]", "0.000"),
    (r"^value$", "#,##0.0"),
    (r"share|penetration of cover|against base|working strain", "0.0%"),
    (r"^payback", "0.0"),
    (r"factor of strain", "0.000"),
    (r"\bf \[-\]|^classical f", "0.0000"),
    (r"friction \[-\]|tan delta|energy \[kWh", "0.0000"),
    (r"^(order|matrices|nodes|retardation)", "#,##0"),
    (r"^(diameter|roll|cover) \[mm\]", "0.0"),
    (r"\[N/m\]", "#,##0.00"),
    (r"\[kg/m\]|\[deg\]|\[-\]|\[m/s\]|spacing", "0.00"),
    (r"\[mm\]|\[MPa\]", "#,##0.000"),
    (r"\[(m|N|kW|MWh|t/h|[A-Z]{3})\]", "#,##0.0"),
)


def legible(words: str) -> str:
    r"""Return text as a cell can hold it: what XML cannot hold spelled out.

    Examples
    --------
    >>> legible("bell\x07")
    'bell\\x07'
    """
    shown = _UNPRINTABLE.sub(lambda found: ascii(found[0])[1:-1], words)
    if len(shown) <= LONGEST:
        return shown
    mark = f" ... (cut here: {len(words)} characters)"
    return shown[: LONGEST - len(mark)] + mark


def put(cell: Cell | MergedCell, value: Any, font: Font | None = None, shown: str | None = None) -> None:
    """Write one value: text as text whatever it begins with, numbers as numbers, nothing for None."""
    if isinstance(cell, MergedCell) or value is None or (isinstance(value, float) and math.isnan(value)):
        return  # pandas writes a missing number of a mixed column as NaN
    if isinstance(value, str):
        cell.value = legible(value)
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


def number_format(column: str) -> str:
    """Return the number format of a column or figure from the unit in its name.

    Examples
    --------
    >>> number_format("tension [N]"), number_format("error estimate [-]")
    ('#,##0.0', '0.0E+00')
    """
    return next((shown for pattern, shown in _FORMATS if re.search(pattern, column)), "General")


def table(
    sheet: Worksheet,
    frame: pd.DataFrame,
    row: int,
    column: int = 1,
    *,
    widest: int = _WIDEST,
    by_row: str = "",
) -> int:
    """Write a table with its header at (row, column); returns its last row.

    Parameters
    ----------
    sheet, frame, row, column
        What, and where its first header cell goes.
    widest : int
        Width at which a column of long text stops growing [characters].
    by_row : str
        Name of a column of figures' names: each row's numbers are formatted by its own unit.
    """
    names = [str(name) for name in frame.columns]
    formats = [number_format(str(name)) for name in frame[by_row]] if by_row else []
    for j, name in enumerate(names, start=column):
        values = [_worded(value) for value in frame[name].tolist()]
        _head(sheet.cell(row, j), name, right=not all(v is None or isinstance(v, str) for v in values))
        longest = _two_lines(name) + 3
        for i, value in enumerate(values):
            cell = sheet.cell(row + 1 + i, j)
            if isinstance(value, str):
                put(cell, value)
                lines = -(-(len(value) + 3) // widest)
                cell.alignment = Alignment(horizontal="left", indent=1, wrap_text=lines > 1)
                if lines > 1:
                    sheet.row_dimensions[row + 1 + i].height = min(_HIGHEST, 15.0 * lines)
                longest = max(longest, len(value) + 3)
            else:
                put(cell, value, shown=formats[i] if by_row else number_format(name))
                longest = max(longest, _length(value, cell.number_format))
        letter = get_column_letter(j)
        known = sheet.column_dimensions[letter].width if letter in sheet.column_dimensions else 0.0
        sheet.column_dimensions[letter].width = max(known, min(widest, max(_NARROWEST, longest)))
    wrapped = any(len(name) + 2 > _width(sheet, j) for j, name in enumerate(names, start=column))
    known_height = sheet.row_dimensions[row].height or 0.0
    sheet.row_dimensions[row].height = max(known_height, 31.0 if wrapped else 16.0)
    return row + len(frame)


def _worded(value: Any) -> Any:
    """Yes and no in words, all else as it is."""
    return {True: "yes", False: "NO"}[value] if isinstance(value, bool) else value


def _head(cell: Cell | MergedCell, name: str, *, right: bool) -> None:
    put(cell, name, _HEADER)
    cell.fill = _FILL
    side, indent = ("right", 0) if right else ("left", 1)
    cell.alignment = Alignment(wrap_text=True, vertical="center", horizontal=side, indent=indent)


def _two_lines(name: str) -> int:
    """Least width in which a name takes at most two lines [characters]."""
    words = name.split()
    breaks = [(" ".join(words[:i]), " ".join(words[i:])) for i in range(len(words))]
    return min(max(map(len, lines)) for lines in breaks)


def _length(value: Any, shown: str) -> int:
    """Characters a number takes, with room beside it."""
    if value is None:
        return 0
    if shown.startswith("#,##0"):
        return len(f"{value:,.{max(0, len(shown) - 6)}f}") + 2
    return 13 if shown == "General" else 10


def _width(sheet: Worksheet, column: int) -> float:
    return float(sheet.column_dimensions[get_column_letter(column)].width)


def total(sheet: Worksheet, row: int, columns: int, values: dict[int, Any]) -> None:
    """Write a line of totals: values by column, a rule above all `columns`."""
    for j in range(1, columns + 1):
        cell = sheet.cell(row, j)
        put(
            cell,
            values.get(j),
            BOLD,
            None if isinstance(values.get(j), str) else sheet.cell(row - 1, j).number_format,
        )
        cell.border = TOTAL
        if isinstance(values.get(j), str):
            cell.alignment = Alignment(horizontal="left", indent=1)


def print_set_up(sheet: Worksheet, name: str) -> None:
    """Landscape, fitted to the width, and to one page where it stays legible; the project's name above."""
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.paperSize = sheet.PAPERSIZE_A4
    sheet.page_setup.fitToWidth = 1
    if sheet.page_setup.fitToHeight is None:
        sheet.page_setup.fitToHeight = int(sheet.max_row <= _PAGE_ROWS)  # 0: as many as it takes
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    margins = sheet.page_margins
    margins.left = margins.right = 0.5
    margins.top, margins.bottom = 0.9, 0.75
    left = _HeaderFooterPart(text=legible(name).replace("&", "&&"))
    sheet.oddHeader = HeaderFooterItem(left=left, right=_HeaderFooterPart(text="&A"))
    sheet.oddFooter = HeaderFooterItem(right=_HeaderFooterPart(text="&P / &N"))
    sheet.sheet_view.showGridLines = False
