"""The workbook in the language of the report: its tables before they are laid out, then what sheets write."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from openpyxl import Workbook
from openpyxl.cell.cell import Cell
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.languages.translator import Translator
from conveyor.report.cells import line_count
from conveyor.report.sheet_paper import columns_width
from conveyor.report.table_model import FIGURE_NAME, ROW_KIND, Column, Contents, Figure, Table
from conveyor.units.presentation import display_unit

_LINE = 15.0  # height of a line of text [pt]


def translate_contents(contents: Contents, translator: Translator) -> Contents:
    """Return contents with the texts of their tables in a language; keys, sheets and verdicts stay."""
    return replace(contents, by_key={key: _translate_table(part, translator) for key, part in contents.by_key.items()})


def _translate_table(part: Table, translator: Translator) -> Table:
    if part.key == "remarks":  # merged where they are alike before they are written
        return part
    return replace(
        part,
        heading=translator.heading(part.heading),
        note=translator.text(part.note),
        foot=translator.heading(part.foot),
        columns=tuple(_translate_column(column, translator) for column in part.columns),
        rows=tuple(_translate_row(row, translator) for row in part.rows),
    )


def _translate_row(row: Any, translator: Translator) -> Any:
    if isinstance(row, Figure):
        value = translator.text(row.value) if isinstance(row.value, str) else row.value
        return replace(row, label=translator.heading(row.label), value=value)
    return row


def _translate_column(column: Column, translator: Translator) -> Column:
    label, get = translator.heading(column.label), column.get
    if column.kind in {ROW_KIND, FIGURE_NAME, "verdict"} or display_unit(column.kind).label is not None:
        return replace(column, label=label)
    words = translator.keep if column.verbatim else translator.text

    def translated(row: Any) -> Any:
        value = get(row)
        return words(value) if isinstance(value, str) else value

    return replace(column, label=label, get=translated)


def translate_sheets(book: Workbook, translator: Translator) -> None:
    """Translate what the sheets of a workbook write beside its tables; rows grow with their text."""
    for sheet in book.worksheets:
        merged = {cells.coord.partition(":")[0]: cells for cells in sheet.merged_cells.ranges}
        for row in sheet.iter_rows():
            for cell in row:
                if isinstance(cell, Cell) and isinstance(cell.value, str) and cell.data_type == "s":
                    translated = translator.text(cell.value)
                    if translated != cell.value:
                        cell.value = translated
                        _fit_row(sheet, cell, merged.get(cell.coordinate))
        for title in _chart_titles(sheet):
            title.t = translator.text(title.t)


def _fit_row(sheet: Worksheet, cell: Cell, over: Any) -> None:
    """Raise the row of a wrapped text to its lines."""
    height = sheet.row_dimensions[cell.row].height
    if not cell.alignment.wrap_text or height is None or (over is not None and over.max_row > over.min_row):
        return
    last = cell.column if over is None else over.max_col
    lines = line_count(str(cell.value), columns_width(sheet, range(cell.column, last + 1)) - 1.0)
    sheet.row_dimensions[cell.row].height = max(height, _LINE * lines)


def _chart_titles(sheet: Worksheet) -> Iterator[Any]:
    """Runs of text of the titles of charts and their axes."""
    for chart in vars(sheet)["_charts"]:
        for title in (chart.title, chart.x_axis.title, chart.y_axis.title):
            if title is not None and title.tx is not None and title.tx.rich is not None:
                for paragraph in title.tx.rich.p:
                    yield from paragraph.r or ()
