"""The workbook: values, formulas only where a reader changes figures; native charts; what a user typed stays text."""

from __future__ import annotations

import gc
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Final, TypeAlias
from zipfile import ZIP_DEFLATED, ZipFile

from openpyxl import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.files.atomic_write import check_writable, save_files
from conveyor.files.workbook_bytes import workbook_bytes
from conveyor.report import sheets, summary_sheet
from conveyor.report.cells import cell_text
from conveyor.report.sheet_paper import set_up_print
from conveyor.report.sheet_writer import MOST_ROWS, SheetWriter, TablePlace, long_table_file
from conveyor.report.table_files import csv_bytes
from conveyor.report.table_model import CHECKS_AND_NOTES, Contents

SUMMARY_SHEET: Final = "Summary"
"""The first sheet of the workbook of a conveyor."""
SheetFillers: TypeAlias = Mapping[str, Callable[[SheetWriter], None]]
SHEETS: Final[SheetFillers] = {
    "Results": sheets.figures_sheet,
    "Given": partial(sheets.stacked_sheet, widest=110),
    "Inputs": sheets.single_table_sheet,
    "Sections": sheets.wide_table_sheet,
    "Resistances": sheets.stacked_sheet,
    "Rolls": sheets.wide_table_sheet,
    "Tension diagram": sheets.tension_sheet,
    "Tensions": sheets.single_table_sheet,
    "States": sheets.stacked_sheet,
    "Loop": sheets.figures_sheet,
    "Pulleys": sheets.narrow_sheet,
    "Curves": sheets.narrow_sheet,
    "Transfer": sheets.transfer_sheet,
    "Load cases": partial(sheets.stacked_sheet, widest=40),
    "Case checks": sheets.single_table_sheet,
    "Duty": sheets.figures_sheet,
    "Scenarios": sheets.stacked_sheet,
    "Histories": sheets.single_table_sheet,
    "Uncertainty": sheets.uncertainty_sheet,
    "Indentation": sheets.stacked_sheet,
    "Rubber": sheets.rubber_sheet,
    CHECKS_AND_NOTES: sheets.notes_sheet,
}
"""Functions that fill the sheets, in order; on all other sheets tables are stacked."""
COMPARISON_SHEETS: Final[SheetFillers] = {
    "Ranking": sheets.ranking_sheet,
    "Power": sheets.power_sheet,
    "Scenes": sheets.scenes_sheet,
    "Coverage": sheets.coverage_sheet,
    "Notes": sheets.compounds_sheet,
}
VERIFICATION_SHEETS: Final[SheetFillers] = {
    "About": sheets.about_sheet,
    "N per width": sheets.fill_in_sheet,
    "Idler set": sheets.fill_in_sheet,
}
_LAYOUTS: Final[Mapping[str, SheetFillers]] = {
    "conveyor": SHEETS,
    "comparison": COMPARISON_SHEETS,
    "verification": VERIFICATION_SHEETS,
}
"""By the layout of a report; in others the tables of a sheet are stacked."""
_OPTIONAL_SHEETS: Final = (
    *VERIFICATION_SHEETS,
    "Pulleys",
    "Curves",
    "Transfer",
    "Load cases",
    "Case checks",
    "Duty",
    "Scenarios",
    "Histories",
    "Uncertainty",
)
"""Sheets that are left out where they have no table."""


def write_workbook(contents: Contents, path: Path) -> Path:
    """Write the workbook of a report, under a temporary name first.

    Parameters
    ----------
    contents : Contents
        Its tables, in their unit system.
    path : Path
        Name of the workbook, ending in ``.xlsx``; an older workbook there is replaced. Tables too long for a sheet go
        to ``<name of the workbook>_<name of the table>.csv`` in its folder.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        The path does not end in .xlsx, is a folder, lies in none, or cannot be written; an older workbook is then
        untouched.
    """
    if path.suffix.lower() != ".xlsx":
        raise InputError(f'{path}: a workbook\'s name ends in .xlsx, got "{path.suffix}"')
    check_writable(path)
    save_files(workbook_files(contents, path))
    return path


def workbook_files(contents: Contents, path: Path) -> dict[Path, bytes]:
    """Contents of the files of a report, by path: the workbook, and the tables too long for it."""
    live: dict[tuple[str, str], float | str] = {}
    with _pause_collector():
        book = build_workbook(contents, path.stem, live)
        book.properties.modified = datetime.now(UTC).replace(tzinfo=None)
        content = workbook_bytes(book)
    long = [part for part in contents.tables if len(part.rows) > MOST_ROWS]
    beside = {path.with_name(long_table_file(path.stem, part)): csv_bytes(part.frame(contents.system)) for part in long}
    values = {(book.sheetnames.index(sheet) + 1, cell): value for (sheet, cell), value in live.items()}
    return beside | {path: add_formula_values(content, values)}


@contextmanager
def _pause_collector() -> Iterator[None]:
    """Pause the cyclic garbage collector, which would take a third of the time."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def build_workbook(
    contents: Contents, stem: str = "", live: dict[tuple[str, str], float | str] | None = None
) -> Workbook:
    """Build the workbook of a report; `stem` names further files, `live` receives the values of its formulas."""
    about, fills = contents.document, _LAYOUTS.get(contents.layout, {})
    translator = contents.make_translator()
    sheet_name = str if translator is None else translator.heading
    book = Workbook()
    book.remove(book.worksheets[0])
    book.properties.title = cell_text(about.title)
    book.properties.creator, book.properties.category = output_marks.program_version(), output_marks.CATEGORY
    header = ", ".join(filter(None, (about.said.get("project"), about.title)))
    placed: dict[str, tuple[Worksheet, TablePlace]] = {}
    front = "governing_figures" in contents
    if front:
        first = book.create_sheet(sheet_name(SUMMARY_SHEET))
    for title in dict.fromkeys((*fills, *contents.sheets)):
        if title in contents.sheets or title not in _OPTIONAL_SHEETS:
            values = {} if live is None else live
            sheet = book.create_sheet(sheet_name(title))
            page = SheetWriter(sheet, contents, stem, placed, values, name=title, translator=translator)
            fills.get(title, sheets.stacked_sheet)(page)
            starts, blocks = page.print_only()
            set_up_print(page.sheet, header, paper=about.paper, starts=starts, blocks=blocks)
    if front:  # its charts refer to tables of the other sheets
        summary_sheet.write_summary(SheetWriter(first, contents, stem, translator=translator), placed)
        set_up_print(first, header, paper=about.paper, fitted=True)
    return book


FormulaValues = Mapping[tuple[int, str], float | str]
"""Values of formulas, by the number of their sheet, from 1, and their cell."""

_SHEET_PATH: Final = "xl/worksheets/sheet{}.xml"


def add_formula_values(workbook: bytes, values: FormulaValues) -> bytes:
    """Return a workbook whose formulas have cached values, as a spreadsheet saves them.

    Parameters
    ----------
    workbook : bytes
        As openpyxl saves it: formulas without values.
    values : mapping
        Value of every formula.
    """
    if not values:
        return workbook
    made = BytesIO()
    with ZipFile(BytesIO(workbook)) as old, ZipFile(made, "w", ZIP_DEFLATED) as new:
        for part in old.infolist():
            content = old.read(part)
            for (number, cell), value in values.items():
                if part.filename == _SHEET_PATH.format(number):
                    content = _insert_value(content, cell, value)
            new.writestr(part, content)
    return made.getvalue()


def _insert_value(sheet: bytes, cell: str, value: float | str) -> bytes:
    pattern = rf'(<c r="{cell}"[^>]*)(><f>[^<]*</f>)<v\s*/?>(?:</v>)?'.encode()
    kind, shown = (' t="str"', value) if isinstance(value, str) else ("", repr(value))
    written, count = re.subn(pattern, rf"\g<1>{kind}\g<2><v>{shown}</v>".encode(), sheet)
    if count != 1:
        raise ValueError(f"{cell}: no formula without a value")
    return written
