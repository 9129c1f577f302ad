"""The workbook: values, not formulas; native charts; nothing a user typed can become a formula."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Final

from openpyxl import Workbook

from conveyor.display import chosen
from conveyor.errors import InputError
from conveyor.files.saving import save, writable
from conveyor.report import cover, sheets
from conveyor.report.cells import legible, print_set_up
from conveyor.report.columns import CHECKS_AND_NOTES, Contents
from conveyor.report.comparing import of_comparison
from conveyor.report.files import csv
from conveyor.report.places import MOST_ROWS, Page, file_name
from conveyor.report.tables import of_analysis

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Studies
    from conveyor.studies.comparison import Comparison
    from conveyor.units import System

SHEETS: Final = {
    "Summary": cover.summary,
    "Results": sheets.single,
    "Inputs": sheets.single,
    "Sections": sheets.wide,
    "Resistances": sheets.resistances,
    "Rolls": sheets.wide,
    "Tensions": sheets.tensions,
    "States": sheets.states,
    "Loop": sheets.stacked,
    "Load cases": sheets.stacked,
    "Duty": sheets.stacked,
    "Uncertainty": sheets.uncertainty,
    "Indentation": sheets.indentation,
    "Rubber": sheets.rubber,
    CHECKS_AND_NOTES: sheets.notes,
}
"""What fills each sheet, in their order; a sheet that only a table names holds its tables under one another."""
COMPARISON_SHEETS: Final = {
    "Ranking": sheets.ranking,
    "Power": sheets.power,
    "Scenes": sheets.scenes,
    "Coverage": sheets.coverage,
    "Notes": sheets.compounds,
}
_WHERE_ASKED: Final = ("Load cases", "Duty", "Uncertainty")
"""Sheets of a workbook only where the spec asks for them."""
_PORTRAIT: Final = ("Summary", "Resistances", "States", "Loop", "Indentation", "Rubber", CHECKS_AND_NOTES)


def write(
    analysis: Analysis, path: Path, studies: Studies | None = None, *, system: System | None = None
) -> Path:
    """Write the workbook of an analysis: under a temporary name beside it first, then renamed.

    Parameters
    ----------
    analysis : Analysis
        What to report.
    studies : Studies, optional
        Load cases, duty and uncertainty, one sheet each.
    path : Path
        Name of the workbook, ending in ``.xlsx``; an older workbook there is replaced. Tables too long for a sheet go
        to ``<name of the workbook>_<name of the table>.csv`` beside it.
    system : {"SI", "US"}, optional
        Units of the tables; without it those of the spec's report.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        The path does not end in .xlsx, is a folder, lies in none, or cannot be written; nothing half-written
        is left, and an older workbook is untouched.
    """
    shown = analysis.in_units(chosen(analysis.conveyor.report.units, system))
    _ready(path)
    with _uncollected():
        found = of_analysis(shown, studies)
        return _saved(path, found, build(found, path.stem))


def write_comparison(comparison: Comparison, path: Path, *, system: System | None = None) -> Path:
    """Write the workbook of a comparison of compounds; as `write`.

    Raises
    ------
    InputError
        As `write`.
    """
    units = chosen(comparison.conveyor.report.units, system)
    _ready(path)
    with _uncollected():
        found = of_comparison(comparison, units)
        return _saved(path, found, build_comparison(found, path.stem))


@contextmanager
def _uncollected() -> Iterator[None]:
    """No search for cycles of objects meanwhile: it takes a third of the time, and there is little to find."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def _ready(path: Path) -> None:
    """Refuse a path that no workbook can stand at, before any time is spent on one."""
    if path.suffix.lower() != ".xlsx":
        raise InputError(f'{path}: a workbook\'s name ends in .xlsx, got "{path.suffix}"')
    writable(path)


def _saved(path: Path, found: Contents, book: Workbook) -> Path:
    """Write a workbook, and beside it the tables too long for it."""
    content = BytesIO()
    try:
        book.save(content)  # by way of temporary files
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None
    long = [part for part in found.tables if len(part.rows) > MOST_ROWS]
    save(
        {path.with_name(file_name(path.stem, part)): csv(part.frame(found.system)) for part in long}
        | {path: content.getbuffer()}
    )
    return path


def build(contents: Contents, stem: str = "") -> Workbook:
    """Workbook of an analysis whose tables are given, not yet saved; `stem` names files beside it."""
    return _book(contents, SHEETS, stem)


def build_comparison(contents: Contents, stem: str = "") -> Workbook:
    """Workbook of a comparison whose tables are given, not yet saved."""
    return _book(contents, COMPARISON_SHEETS, stem)


def _book(contents: Contents, fills: Mapping[str, Callable[[Page], None]], stem: str) -> Workbook:
    about = contents.document
    book = Workbook()
    book.remove(book.worksheets[0])
    book.properties.title = legible(about.title)
    book.properties.creator = f"conveyor {version('conveyor')}"
    header = ", ".join(filter(None, (about.said.get("project"), about.title)))
    for title in dict.fromkeys((*fills, *contents.sheets)):
        if title in contents.sheets or title not in _WHERE_ASKED:
            sheet = book.create_sheet(title)
            fills.get(title, sheets.stacked)(Page(sheet, contents, stem))
            print_set_up(sheet, header, paper=about.paper, portrait=title in _PORTRAIT)
    return book
