"""Where tables and figures stand in the workbook: headings, names others link to, tables too long for a sheet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from openpyxl.utils import absolute_coordinate, get_column_letter, quote_sheetname
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report.cells import GREY, HEADING, put, table
from conveyor.report.contents import Contents, Part

MOST_ROWS: Final = 10_000
"""Rows of a table that a sheet takes: beyond them a workbook takes seconds to write and to open."""
SHOWN_ROWS: Final = 100
"""Rows that stand for a table too long."""
_FILTERED_ROWS: Final = 20
"""Rows beyond which a table has buttons to filter it."""
_NAMES: Final = 56  # characters of a name on one line


def file_name(stem: str, part: Part) -> str:
    """Name of the file beside a workbook that holds a table too long for it."""
    return f"{stem}_{part.key}.csv"


def define(sheet: Worksheet, name: str, cells: str) -> None:
    """Name a cell or a range of a sheet, for the whole workbook."""
    book = sheet.parent
    if book is not None:
        reference = f"{quote_sheetname(sheet.title)}!{absolute_coordinate(cells)}"
        book.defined_names[name] = DefinedName(name, attr_text=reference)


@dataclass(frozen=True)
class Place:
    """Rows of a table's header and of its last row, its columns; whole if no row is left out."""

    header: int
    last: int
    first_column: int
    last_column: int
    whole: bool = True

    @property
    def cells(self) -> str:
        """Range of the table with its header."""
        first, last = get_column_letter(self.first_column), get_column_letter(self.last_column)
        return f"{first}{self.header}:{last}{self.last}"


@dataclass(frozen=True)
class Page:
    """A sheet being written.

    Attributes
    ----------
    sheet : Worksheet
        The sheet.
    contents : Contents
        Tables of the report.
    stem : str
        Name of the workbook without its ending, for files beside it.
    """

    sheet: Worksheet
    contents: Contents
    stem: str

    def place(
        self, key: str, row: int, column: int = 1, *, heading: bool = True, widest: int = _NAMES
    ) -> Place:
        """Write a table, its heading at (row, column) and its header in the row below; name it and its figures."""
        part = self.contents[key]
        top = row
        if heading:
            put(self.sheet.cell(row, column), part.heading, HEADING)
            top = row + 1
        frame, whole = part.frame, len(part.frame) <= MOST_ROWS
        if not whole:
            words = (
                f"{len(frame):,} rows, the first {SHOWN_ROWS} here; all of them: {file_name(self.stem, part)}"
            )
            put(self.sheet.cell(row, column + 2), words, GREY)
            frame = frame.iloc[:SHOWN_ROWS]
        last = table(self.sheet, frame, top, column, widest=widest, by_row=part.by_row)
        place = Place(top, last, column, column + len(frame.columns) - 1, whole)
        if whole:
            define(self.sheet, f"table_{key}", place.cells)
            self._figures(part, place)
        return place

    def _figures(self, part: Part, place: Place) -> None:
        names = part.figures()
        if names:
            letter = get_column_letter(place.first_column + list(part.frame.columns).index("value"))
            for name, i in names.items():
                define(self.sheet, name, f"{letter}{place.header + 1 + i}")

    def headed(self, key: str, *, frozen: str = "B3", widest: int = 60) -> Place:
        """Write the one table of a sheet: its header stays in view and is printed on each page."""
        place = self.place(key, 1, widest=widest)
        self.sheet.freeze_panes = frozen
        self.sheet.print_title_rows = "1:2"
        if place.last - place.header > _FILTERED_ROWS:
            self.sheet.auto_filter.ref = place.cells
        return place

    def stacked(self, keys: tuple[str, ...], row: int = 1) -> dict[str, Place]:
        """Write tables under one another, those that there are; where each stands."""
        places = {}
        for key in keys:
            if key in self.contents.by_key:
                places[key] = self.place(key, row)
                row = places[key].last + 1
                note = self.contents[key].note
                if note:
                    put(self.sheet.cell(row + 1, 1), note, GREY)
                    row += 2
                row += 2
        self.sheet.freeze_panes = "B1"
        return places
