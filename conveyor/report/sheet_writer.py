"""Writing the tables of a sheet: placement, headings, defined names, formulas, print area."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any, Final

from openpyxl.cell.cell import Cell, MergedCell
from openpyxl.styles import Alignment, Font
from openpyxl.utils import absolute_coordinate, get_column_letter, quote_sheetname
from openpyxl.utils.cell import coordinate_to_tuple
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.languages.translator import Translator
from conveyor.report.cells import GREY, HEADING, line_count, mark_input, write_table, write_totals, write_value
from conveyor.report.sheet_paper import CHART_ROWS, TEXT_WIDTH, columns_of_text, columns_width
from conveyor.report.table_model import Contents, Figure, Table
from conveyor.report.translated_workbook import translate_table

MOST_ROWS: Final = 10_000
"""Maximum rows of a table on a sheet: longer ones take seconds to write and to open."""
SHOWN_ROWS: Final = 100
"""Rows shown of a table that is too long."""
_FILTERED_ROWS: Final = 20
"""Rows beyond which a table has filter buttons."""
_CHART_SPAN: Final = 7
"""Columns that a chart takes on paper."""
_GUTTER: Final = 3.0  # between tables side by side [characters]
_NAME_CHARACTERS: Final = 56  # characters of a name on one line


def long_table_file(stem: str, part: Table) -> str:
    """Name of the CSV file of a table that is too long for the workbook."""
    return f"{stem}_{part.key}.csv"


def define_name(sheet: Worksheet, name: str, cells: str) -> None:
    """Define a workbook-wide name for a cell or range."""
    book = sheet.parent
    if book is not None:
        reference = f"{quote_sheetname(sheet.title)}!{absolute_coordinate(cells)}"
        book.defined_names[name] = DefinedName(name, attr_text=reference)


@dataclass(frozen=True)
class TablePlace:
    """Place of a table on a sheet: header row, last row, columns by key; `whole` if no row is left out."""

    header: int
    last: int
    first_column: int
    keys: tuple[str, ...]
    whole: bool = True

    @property
    def last_column(self) -> int:
        """Index of the last column."""
        return self.first_column + len(self.keys) - 1

    def column(self, key: str) -> int:
        """Column index of a key."""
        return self.first_column + self.keys.index(key)

    @property
    def cells(self) -> str:
        """Cell range of the table with its header."""
        first, last = get_column_letter(self.first_column), get_column_letter(self.last_column)
        return f"{first}{self.header}:{last}{self.last}"


def _centre_vertically(kept: Any) -> Alignment:
    """Copy of an alignment, vertically centred."""
    return Alignment(horizontal=kept.horizontal, indent=kept.indent, wrap_text=kept.wrap_text, vertical="center")


@dataclass(frozen=True)
class SheetWriter:
    """A sheet being written.

    Attributes
    ----------
    sheet : Worksheet
        The sheet.
    contents : Contents
        Tables of the report.
    stem : str
        Name of the workbook without its ending, for further files.
    placed : dict
        Sheet and place of every table of the workbook.
    live : dict
        Values of formulas, by sheet and cell.
    name : str
        Its name in English.
    translator : Translator or None
        Of the report's language; None in English.
    """

    sheet: Worksheet
    contents: Contents
    stem: str
    placed: dict[str, tuple[Worksheet, TablePlace]] = field(default_factory=dict)
    live: dict[tuple[str, str], float | str] = field(default_factory=dict)
    name: str = ""
    translator: Translator | None = None

    def said(self, words: str) -> str:
        """Return an English text of the report in its language."""
        return words if self.translator is None else self.translator.text(words)

    def headed(self, words: str) -> str:
        """Return a heading or the name of a figure in the language, also where a name is spelled so."""
        return words if self.translator is None else self.translator.heading(words)

    def table(self, key: str) -> Table:
        """Return a table as the sheets have it, in the language."""
        part = self.contents[key].on_sheet()
        return part if self.translator is None else translate_table(part, self.translator)

    def write(self, row: int, column: int, words: str, font: Font | None = None) -> None:
        """Write an English text of the report in its language."""
        write_value(self.sheet.cell(row, column), self.said(words), font)

    def place(self, key: str, row: int, column: int = 1, *, widest: int = _NAME_CHARACTERS, **wider: int) -> TablePlace:
        """Write a table, its heading at (row, column) and its header below; define names for it and its figures.

        Text wraps at `widest` [characters], that of single columns at those in `wider`.
        """
        part = self.table(key)
        write_value(self.sheet.cell(row, column), part.heading, HEADING)
        top = row + 1
        shown, whole = part, len(part.rows) <= MOST_ROWS
        if not whole:
            where = long_table_file(self.stem, part)
            words = f"{len(part.rows):,} rows, the first {SHOWN_ROWS} here; all of them: {where}"
            self.write(row, column + 2, words, GREY)
            shown = replace(part, rows=part.rows[:SHOWN_ROWS])
        system = self.contents.system
        last = write_table(self.sheet, shown, system, top, column, widest=widest, wider=wider, words=self.said)
        place = TablePlace(top, last, column, tuple(each.key for each in part.columns), whole)
        self.placed[key] = self.sheet, place
        if whole:
            define_name(self.sheet, f"table_{key}", place.cells)
            if part.links:
                letter = get_column_letter(place.column("value"))
                for i, figure in enumerate(part.rows, start=top + 1):
                    define_name(self.sheet, figure.key, f"{letter}{i}")
                    self._write_changeable(self.sheet[f"{letter}{i}"], figure)
            self._live_columns(part, place)
            if part.foot:
                write_totals(self.sheet, last + 1, part, system, column)
        return place

    def _write_changeable(self, cell: Cell, figure: Figure) -> None:
        """Mark a cell that the reader may change, or write its formula."""
        if "input" in figure.on.split():
            mark_input(cell)
        if figure.formula:
            self._write_formula(cell, figure.formula)

    def _live_columns(self, part: Table, place: TablePlace) -> None:
        """Write the formulas of a table's columns, with cell references for column keys."""
        for column in part.columns:
            for i, row in enumerate(part.rows if column.formula else ()):
                formula = column.formula(row) if column.formula else ""

                def cell(named: re.Match[str], own: int = i) -> str:
                    at = own if named[2] is None else int(named[2])
                    return f"{get_column_letter(place.column(named[1]))}{place.header + 1 + at}"

                if formula:
                    here = self.sheet.cell(place.header + 1 + i, place.column(column.key))
                    self._write_formula(here, re.sub(r"\[(\w+)(?::(\d+))?\]", cell, formula))

    def _write_formula(self, cell: Cell | MergedCell, formula: str) -> None:
        """Write a formula; keep the cell's value for saving."""
        value = "" if cell.value is None else cell.value
        self.live[self.sheet.title, cell.coordinate] = value if isinstance(value, str) else float(str(value))
        cell.value, cell.data_type = f"={formula}", "f"

    def place_single(self, key: str, *, frozen: str = "B3", widest: int = 60) -> TablePlace:
        """Write the main table of a sheet; its header stays in view and repeats on each page."""
        place = self.place(key, 1, widest=widest)
        self.sheet.freeze_panes = frozen
        self.sheet.print_title_rows = "1:2"
        if place.last - place.header > _FILTERED_ROWS:
            self.sheet.auto_filter.ref = place.cells
        return place

    def stacked(
        self,
        keys: Iterable[str],
        row: int = 1,
        column: int = 1,
        *,
        widest: int = _NAME_CHARACTERS,
        least: float = TEXT_WIDTH,
    ) -> dict[str, TablePlace]:
        """Write the existing tables under one another, each with its note; return their places.

        Those that are not printed come last. Notes are as wide as the printed part of their table, at least `least`.
        """
        places = {}
        there = [key for key in keys if key in self.contents]
        for key in sorted(there, key=lambda key: not self.contents[key].printed):
            places[key] = self.place(key, row, column, widest=widest)
            row = places[key].last + (2 if self.contents[key].foot else 1)
            if self.contents[key].note:
                row += 1 + self._write_note(row + 1, key, least)
            row += 2
        self.sheet.freeze_panes = self.sheet.freeze_panes or "B1"
        return places

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the tables of this sheet."""
        return self.contents.keys_on(self.name)

    def rest(self, row: int = 1, *, widest: int = _NAME_CHARACTERS, but: Sequence[str] = ()) -> None:
        """Write the remaining tables of the sheet under one another."""
        self.stacked([key for key in self.keys if key not in {*self.placed, *but}], row, widest=widest)

    def beside(self, *stacks: Iterable[str]) -> None:
        """Write stacks of tables side by side, so that tables of different shapes share no column widths."""
        keys = [[key for key in stack if key in self.contents] for stack in stacks]
        column, places = 1, list[TablePlace]()
        for stack in keys:
            printed = [key for key in stack if self.contents[key].printed]
            if printed:
                places += self.stacked(printed, column=column, least=0.0).values()
                column = max(place.last_column for place in places) + 2
                self.sheet.column_dimensions[get_column_letter(column - 1)].width = _GUTTER
        for i, line in self.sheet.row_dimensions.items():
            for cell in self.sheet[i] if line.height is not None else ():
                if cell.alignment.vertical is None:
                    cell.alignment = _centre_vertically(cell.alignment)
        rest = [key for stack in keys for key in stack if not self.contents[key].printed]
        self.stacked(rest, max((place.last for place in places), default=-3) + 5)

    def _write_note(self, row: int, key: str, least: float) -> int:
        """Write the note of a table; return its number of rows."""
        place, note = self.placed[key][1], self.said(self.contents[key].note)
        cell = self.sheet.cell(row, place.first_column)
        write_value(cell, note, GREY)
        columns = self._columns_of_width(least, range(place.first_column, self._last_printed(key, place) + 1))
        columns = columns_of_text(self.sheet, columns)
        rows = line_count(note, columns_width(self.sheet, columns))
        self.sheet.merge_cells(None, row, columns[0], row + rows - 1, columns[-1])
        cell.alignment = Alignment(wrap_text=True, vertical="top")
        return rows

    def print_only(self) -> tuple[tuple[int, ...], list[range]]:
        """Set the print area, or hide a sheet with nothing to print.

        Returns the first columns of its tables, and the rows of each table of the first stack with its note.
        """
        here = {key: place for key, (sheet, place) in self.placed.items() if sheet is self.sheet}
        corners = [coordinate_to_tuple(chart.anchor) for chart in vars(self.sheet)["_charts"]]
        printed = {key: place for key, place in here.items() if self.contents[key].printed}
        if here and not printed and not corners:
            self.sheet.sheet_state = "hidden"
            return (1,), []
        if len(printed) == 1 and not self.sheet.print_title_rows:  # a long table has its head on every page
            (place,) = printed.values()
            self.sheet.print_title_rows = f"{place.header - 1}:{place.header}"
        rows = [self.sheet.max_row, *(row + CHART_ROWS for row, _ in corners)]
        last = min([max(rows), *(here[key].header - 3 for key in here.keys() - printed.keys())])
        columns = [self._last_printed(key, place) for key, place in printed.items()]
        columns += [column + _CHART_SPAN for _, column in corners]
        columns += [cells.max_col for cells in self.sheet.merged_cells.ranges if cells.min_row <= last]
        if len(printed) < len(here) or columns:
            span = self._columns_of_width(TEXT_WIDTH, range(1, max([*columns, 1]) + 1))
            self.sheet.print_area = f"A1:{get_column_letter(span[-1])}{max(1, last)}"
        tops = sorted(place.header - 1 for place in printed.values() if place.first_column == 1)
        blocks = [range(max(1, row), end - 1) for row, end in pairwise((*tops, last + 2))]
        return tuple(sorted({place.first_column for place in printed.values()})), blocks

    def _columns_of_width(self, width: float, columns: range) -> range:
        """Columns extended to the right until they have a width [characters]."""
        while columns_width(self.sheet, columns) < width:
            columns = range(columns.start, columns.stop + 1)
        return columns

    def _last_printed(self, key: str, place: TablePlace) -> int:
        """Last printed column of a table; a table that is not on the page is printed whole."""
        shown = sum(column.page is not None for column in self.contents[key].on_sheet().columns)
        return place.first_column + shown - 1 if self.contents[key].page else place.last_column
