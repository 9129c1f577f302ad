"""Paper of a sheet: upright or across, on as many pages as letters of 8 pt need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Final

from openpyxl.utils import get_column_letter, range_boundaries
from openpyxl.utils.cell import coordinate_to_tuple
from openpyxl.worksheet.header_footer import HeaderFooterItem, _HeaderFooterPart
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report.cells import cell_text

_SCALE: Final = 0.73
"""Least scale on paper [-]: letters of 11 pt become 8 pt."""
_SIZES: Final = {"A4": (8.27, 11.69), "Letter": (8.5, 11.0)}
"""Width and height of the paper [in]."""
_SIDE, _TOP, _BOTTOM = 0.4, 0.9, 0.75  # margins [in]
_CHARACTERS: Final = 96.0 / 7.4
"""Characters of a column's width on an inch of paper at full scale, a digit and its share of a column's borders.

In pixels of 1/96 in; Excel has 7 for Calibri 11, LibreOffice 7.4.
"""
_ROW_HEIGHT: Final = 15.75
"""Height of a row that has none of its own, of a heading in Calibri 12 [pt]."""
_POINTS: Final = 72.0 / 2.54
"""Points of a centimetre."""
CHART_ROWS: Final = 20
"""Rows that a chart takes."""
_SURE: Final = 0.95
"""Share of the width that is filled where the pages are parted here: another font may be wider."""
TEXT_WIDTH: Final = 90.0
"""Width of notes and paragraphs [characters]: no page is narrower."""


def page_room(paper: str, *, portrait: bool) -> tuple[float, float]:
    """Width [characters] and height [pt] of what a page holds at the least scale."""
    wide, high = _SIZES[paper] if portrait else _SIZES[paper][::-1]
    return _CHARACTERS * (wide - 2.0 * _SIDE) / _SCALE, 72.0 * (high - _TOP - _BOTTOM) / _SCALE


def columns_width(sheet: Worksheet, columns: Iterable[int]) -> float:
    """Width of columns [characters]; hidden ones have none."""
    looks = (sheet.column_dimensions[get_column_letter(column)] for column in columns)
    return sum(look.width for look in looks if not look.hidden)


def columns_of_text(sheet: Worksheet, columns: range, widest: float = TEXT_WIDTH) -> range:
    """First of the columns, as many as a paragraph may take; at least one."""
    while len(columns) > 1 and columns_width(sheet, columns) > widest:
        columns = columns[:-1]
    return columns


def paragraph_width(sheet: Worksheet, columns: range, paper: str) -> float:
    """Width of paragraphs [characters] below tables of these columns: that of a page across, if they take one."""
    upright, across = (page_room(paper, portrait=portrait)[0] for portrait in (True, False))
    return _SURE * across if upright < columns_width(sheet, columns) <= across else TEXT_WIDTH


def set_up_print(
    sheet: Worksheet,
    name: str,
    *,
    paper: str = "A4",
    starts: Sequence[int] = (1,),
    blocks: Sequence[range] = (),
    fitted: bool = False,
) -> None:
    """Set up printing with letters of at least 8 pt, with the project's name as header.

    A sheet is printed upright where its width allows it, else across, on one page where it fits. A wider one is parted
    between columns: before a table that stands beside another, else with its first column on every page.

    Parameters
    ----------
    sheet : Worksheet
        With its widths, heights and print area.
    name : str
        Words of the header.
    paper : {"A4", "Letter"}
        Size of the paper.
    starts : sequence of int
        First columns of the tables that stand beside each other.
    blocks : sequence of range
        Rows of the tables that stand below each other: none is cut by the end of a page that it fits on.
    fitted : bool
        Whether columns on one page stay on it in any font, even if a program then takes no notice of breaks.
    """
    _, _, last_column, last_row = range_boundaries(sheet.print_area.split("!")[-1] or sheet.dimensions)
    columns, rows = range(1, int(last_column or 1) + 1), range(1, int(last_row or 1) + 1)
    parts = {portrait: _page_ends(sheet, columns, paper, starts, portrait=portrait) for portrait in (True, False)}
    portrait = len(parts[True]) <= len(parts[False])
    sheet.page_setup.orientation = "portrait" if portrait else "landscape"
    sheet.page_setup.paperSize = sheet.PAPERSIZE_LETTER if paper == "Letter" else sheet.PAPERSIZE_A4
    height = page_room(paper, portrait=portrait)[1]
    for row in _cut_blocks(sheet, height, blocks):
        sheet.row_breaks.append(Break(id=row - 1))
    parted = bool(sheet.row_breaks.brk)
    if parts[portrait] or (parted and not fitted):  # Excel takes no notice of breaks where pages are fitted
        sheet.page_setup.scale = round(100.0 * _SCALE)
        for last in parts[portrait]:
            sheet.col_breaks.append(Break(id=last))
        if parts[portrait] and len(set(starts)) == 1 and sheet.print_title_cols is None:
            sheet.print_title_cols = "A:A"
    else:
        sheet.page_setup.fitToWidth = 1
        sheet.page_setup.fitToHeight = int(not parted and rows_height(sheet, rows) <= height)  # 0: as many as it takes
        sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    margins = sheet.page_margins
    margins.left = margins.right = _SIDE
    margins.top, margins.bottom = _TOP, _BOTTOM
    left = _HeaderFooterPart(text=cell_text(name).replace("&", "&&"))
    sheet.oddHeader = HeaderFooterItem(left=left, right=_HeaderFooterPart(text="&A"))
    sheet.oddFooter = HeaderFooterItem(right=_HeaderFooterPart(text="&P / &N"))
    sheet.sheet_view.showGridLines = False


def rows_height(sheet: Worksheet, rows: Iterable[int]) -> float:
    """Height of rows [pt]."""
    looks = (sheet.row_dimensions[row] for row in rows)
    return sum(_ROW_HEIGHT if look.height is None else look.height for look in looks if not look.hidden)


def _cut_blocks(sheet: Worksheet, height: float, blocks: Sequence[range]) -> Iterator[int]:
    """First rows of tables and charts that the end of a page of a height [pt] would cut."""
    heights = {rows.start: rows_height(sheet, rows) for rows in blocks}
    for chart in vars(sheet)["_charts"]:
        row = coordinate_to_tuple(chart.anchor)[0]
        heights[row] = max(heights.get(row, 0.0), chart.height * _POINTS)
    top = 1
    for row in sorted(heights):
        above = rows_height(sheet, range(top, row)) % height
        if above + heights[row] > height >= heights[row]:
            yield row
            top = row


def _page_ends(
    sheet: Worksheet, columns: range, paper: str, starts: Sequence[int], *, portrait: bool
) -> tuple[int, ...]:
    """Last column of every page but the last; none where the columns fit on one page."""
    room = page_room(paper, portrait=portrait)[0]
    if columns_width(sheet, columns) <= room:
        return ()
    firsts = [1, *sorted(set(starts) - {1}), columns.stop]
    if len(firsts) > 2 and all(columns_width(sheet, range(*pair)) <= _SURE * room for pair in pairwise(firsts)):
        return tuple(first - 1 for first in firsts[1:-1])
    named = int(range_boundaries(sheet.print_title_cols or "A:A")[2] or 1)
    names = columns_width(sheet, range(1, named + 1))
    room, least = _SURE * room - names, TEXT_WIDTH - names
    widths = [columns_width(sheet, [column]) for column in columns[named:]]
    count = len(_page_fills(widths, room))
    tried = (least + k / 100.0 * (room - least) for k in range(101))  # pages of one width, the last as well
    even = next(ends for part in tried if len(ends := _page_fills(widths, part)) == count)
    return tuple(named + last for last in even)


def _page_fills(widths: Sequence[float], room: float) -> list[int]:
    """Number of columns on all pages up to each but the last, filled one after the other."""
    ends, used = list[int](), 0.0
    for i, wide in enumerate(widths):
        if used and used + wide > room:
            ends.append(i)
            used = 0.0
        used += wide
    return ends
