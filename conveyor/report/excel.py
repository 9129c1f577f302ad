"""The workbook: values, not formulas; native charts; nothing a user typed can become a formula."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from openpyxl import Workbook

from conveyor.errors import InputError
from conveyor.files import marks
from conveyor.files.saving import save, writable
from conveyor.report import comparing_sheets, cover, sheets, study_sheets
from conveyor.report.cells import legible, print_set_up
from conveyor.report.comparison_contents import of_comparison
from conveyor.report.contents import CHECKS_AND_NOTES, Contents, of_analysis
from conveyor.report.files import csv
from conveyor.report.places import MOST_ROWS, Page, file_name
from conveyor.report.unit_systems import chosen

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Studies
    from conveyor.studies.comparison import Comparison
    from conveyor.units import System

Subject = TypeVar("Subject", "Analysis", "Comparison")

SHEETS: Final = {
    "Summary": cover.summary,
    "Results": sheets.results,
    "Inputs": sheets.inputs,
    "Sections": sheets.sections,
    "Resistances": sheets.resistances,
    "Rolls": sheets.rolls,
    "Tensions": sheets.tensions,
    "States": study_sheets.states,
    "Loop": study_sheets.loop,
    "Load cases": study_sheets.cases,
    "Duty": study_sheets.duty,
    "Uncertainty": study_sheets.uncertainty,
    "Indentation": sheets.indentation,
    "Rubber": sheets.rubber,
    CHECKS_AND_NOTES: sheets.notes,
}
"""What fills each sheet, in their order."""
COMPARISON_SHEETS: Final = {
    "Ranking": comparing_sheets.ranking,
    "Power": comparing_sheets.power,
    "Scenes": comparing_sheets.scenes,
    "Coverage": comparing_sheets.coverage,
    "Notes": comparing_sheets.notes,
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
    _ready(path)
    save(files(analysis, path, studies, system=system))
    return path


def files(
    analysis: Analysis, path: Path, studies: Studies | None = None, *, system: System | None = None
) -> dict[Path, bytes]:
    """Workbook of an analysis and the tables too long for it, by the files they go to; as `write`."""
    shown = analysis.in_units(chosen(analysis.conveyor, system))
    with _uncollected():
        found = of_analysis(shown, studies)
        return _encoded(path, found, build(found, shown, path.stem))


def write_comparison(comparison: Comparison, path: Path, *, system: System | None = None) -> Path:
    """Write the workbook of a comparison of compounds; as `write`.

    Raises
    ------
    InputError
        As `write`.
    """
    _ready(path)
    save(comparison_files(comparison, path, system=system))
    return path


def comparison_files(
    comparison: Comparison, path: Path, *, system: System | None = None
) -> dict[Path, bytes]:
    """Workbook of a comparison and the tables too long for it, by the files they go to."""
    with _uncollected():
        found = of_comparison(comparison, chosen(comparison.conveyor, system))
        return _encoded(path, found, build_comparison(found, comparison, path.stem))


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


def _encoded(path: Path, found: Contents, book: Workbook) -> dict[Path, bytes]:
    """Bytes of a workbook, and of the tables too long for it, which go beside it."""
    content = BytesIO()
    try:
        book.save(content)  # by way of temporary files
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None
    long = [part for part in found.parts if len(part.frame) > MOST_ROWS]
    beside = {path.with_name(file_name(path.stem, part)): csv(part.frame) for part in long}
    return beside | {path: content.getvalue()}


def build(contents: Contents, analysis: Analysis, stem: str = "") -> Workbook:
    """Workbook of an analysis whose tables are given, not yet saved; `stem` names files beside it."""
    return _book(contents, SHEETS, analysis, stem)


def build_comparison(contents: Contents, comparison: Comparison, stem: str = "") -> Workbook:
    """Workbook of a comparison whose tables are given, not yet saved."""
    return _book(contents, COMPARISON_SHEETS, comparison, stem)


def _book(
    contents: Contents, fills: Mapping[str, Callable[[Page, Subject], None]], subject: Subject, stem: str
) -> Workbook:
    conveyor = subject.conveyor
    book = Workbook()
    book.remove(book.worksheets[0])
    book.properties.title = legible(conveyor.name)
    book.properties.creator, book.properties.category = marks.maker(), marks.CATEGORY
    paper = conveyor.report.sheet(contents.system)
    header = ", ".join(filter(None, (conveyor.report.project, conveyor.name)))
    for title, fill in fills.items():
        if title in contents.sheets or title not in _WHERE_ASKED:
            sheet = book.create_sheet(title)
            fill(Page(sheet, contents, stem), subject)
            print_set_up(sheet, header, paper=paper, portrait=title in _PORTRAIT)
    return book
