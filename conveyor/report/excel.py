"""The workbook: values, formulas only where a reader changes figures; native charts; what a user typed stays text."""

from __future__ import annotations

import gc
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Final, TypeAlias
from zipfile import ZIP_DEFLATED, ZipFile

from openpyxl import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.errors import InputError
from conveyor.files import marks
from conveyor.files.saving import naming, save, writable
from conveyor.report import cover, sheets
from conveyor.report.cells import legible, print_set_up
from conveyor.report.columns import CHECKS_AND_NOTES, Contents
from conveyor.report.files import csv
from conveyor.report.places import MOST_ROWS, Page, TablePlace, file_name

FRONT: Final = "Summary"
"""The first sheet of the workbook of a conveyor."""
Fills: TypeAlias = Mapping[str, Callable[[Page], None]]
SHEETS: Final[Fills] = {
    "Results": sheets.beside,
    "Given": partial(sheets.stacked, widest=110),
    "Inputs": sheets.single,
    "Sections": sheets.wide,
    "Resistances": sheets.stacked,
    "Rolls": sheets.wide,
    "Tension diagram": sheets.tensions,
    "Tensions": sheets.single,
    "States": sheets.stacked,
    "Loop": sheets.beside,
    "Pulleys": sheets.noted,
    "Curves": sheets.noted,
    "Transfer": sheets.transfer,
    "Load cases": partial(sheets.stacked, widest=40),
    "Case checks": sheets.single,
    "Duty": sheets.beside,
    "Scenarios": sheets.stacked,
    "Histories": sheets.single,
    "Uncertainty": sheets.uncertainty,
    "Indentation": sheets.stacked,
    "Rubber": sheets.rubber,
    CHECKS_AND_NOTES: sheets.notes,
}
"""Functions that fill the sheets, in order; on all other sheets tables are stacked."""
COMPARISON_SHEETS: Final[Fills] = {
    "Ranking": sheets.ranking,
    "Power": sheets.power,
    "Scenes": sheets.scenes,
    "Coverage": sheets.coverage,
    "Notes": sheets.compounds,
}
VERIFICATION_SHEETS: Final[Fills] = {
    "About": sheets.about,
    "N per width": sheets.to_compare,
    "Idler set": sheets.to_compare,
}
_LAYOUTS: Final[Mapping[str, Fills]] = {
    "conveyor": SHEETS,
    "comparison": COMPARISON_SHEETS,
    "verification": VERIFICATION_SHEETS,
}
"""By the layout of a report; in others the tables of a sheet are stacked."""
_WHERE_ASKED: Final = (
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
_PORTRAIT: Final = (
    "Given",
    "Resistances",
    "Tension diagram",
    "Transfer",
    "Load cases",
    "Rubber",
    CHECKS_AND_NOTES,
    "About",
)


def write(contents: Contents, path: Path) -> Path:
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
    writable(path)
    save(files(contents, path))
    return path


def files(contents: Contents, path: Path) -> dict[Path, bytes]:
    """Contents of the files of a report, by path: the workbook, and the tables too long for it."""
    live: dict[tuple[str, str], float | str] = {}
    with _uncollected():
        book, content = build(contents, path.stem, live), BytesIO()
        with naming(path):
            book.save(content)  # by way of temporary files
    long = [part for part in contents.tables if len(part.rows) > MOST_ROWS]
    beside = {path.with_name(file_name(path.stem, part)): csv(part.frame(contents.system)) for part in long}
    values = {(book.sheetnames.index(sheet) + 1, cell): value for (sheet, cell), value in live.items()}
    return beside | {path: with_values(content.getvalue(), values)}


@contextmanager
def _uncollected() -> Iterator[None]:
    """Pause the cyclic garbage collector, which would take a third of the time."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def build(
    contents: Contents, stem: str = "", live: dict[tuple[str, str], float | str] | None = None
) -> Workbook:
    """Build the workbook of a report; `stem` names further files, `live` receives the values of its formulas."""
    about, fills = contents.document, _LAYOUTS.get(contents.layout, {})
    book = Workbook()
    book.remove(book.worksheets[0])
    book.properties.title = legible(about.title)
    book.properties.creator, book.properties.category = marks.maker(), marks.CATEGORY
    header = ", ".join(filter(None, (about.said.get("project"), about.title)))
    placed: dict[str, tuple[Worksheet, TablePlace]] = {}
    front = "governing_figures" in contents
    if front:
        book.create_sheet(FRONT)
    for title in dict.fromkeys((*fills, *contents.sheets)):
        if title in contents.sheets or title not in _WHERE_ASKED:
            page = Page(book.create_sheet(title), contents, stem, placed, {} if live is None else live)
            fills.get(title, sheets.stacked)(page)
            last = page.print_only()
            print_set_up(page.sheet, header, last, paper=about.paper, portrait=title in _PORTRAIT)
    if front:  # its charts refer to tables of the other sheets
        cover.summary(Page(book[FRONT], contents, stem), placed)
        print_set_up(book[FRONT], header, book[FRONT].max_row, paper=about.paper, portrait=True)
    return book


Values = Mapping[tuple[int, str], float | str]
"""Values of formulas, by the number of their sheet, from 1, and their cell."""

_SHEET: Final = "xl/worksheets/sheet{}.xml"


def with_values(workbook: bytes, values: Values) -> bytes:
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
                if part.filename == _SHEET.format(number):
                    content = _valued(content, cell, value)
            new.writestr(part, content)
    return made.getvalue()


def _valued(sheet: bytes, cell: str, value: float | str) -> bytes:
    pattern = rf'(<c r="{cell}"[^>]*)(><f>[^<]*</f>)<v\s*/?>(?:</v>)?'.encode()
    kind, shown = (' t="str"', value) if isinstance(value, str) else ("", repr(value))
    written, count = re.subn(pattern, rf"\g<1>{kind}\g<2><v>{shown}</v>".encode(), sheet)
    if count != 1:
        raise ValueError(f"{cell}: no formula without a value")
    return written
