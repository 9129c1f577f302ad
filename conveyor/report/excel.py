"""The workbook: values, not formulas; native charts; nothing a user typed can become a formula."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING
from uuid import uuid4

from openpyxl import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.errors import InputError
from conveyor.report import comparing_sheets, sheets, study_sheets
from conveyor.report.cells import legible, print_set_up
from conveyor.report.unit_systems import chosen

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.comparison import Comparison
    from conveyor.studies import Studies
    from conveyor.units import System

SHEETS = {
    "Summary": sheets.summary,
    "Inputs": sheets.inputs,
    "Sections": sheets.sections,
    "Resistances": sheets.resistances,
    "Rolls": sheets.rolls,
    "Tensions": sheets.tensions,
    "States": study_sheets.states,
    "Loop": study_sheets.loop,
    "Indentation": sheets.indentation,
    "Rubber": sheets.rubber,
    "Checks and notes": sheets.notes,
}
"""What fills each sheet, in their order."""
COMPARISON_SHEETS = {
    "Ranking": comparing_sheets.ranking,
    "Power": comparing_sheets.power,
    "Scenes": comparing_sheets.scenes,
    "Coverage": comparing_sheets.coverage,
    "Notes": comparing_sheets.notes,
}


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
        Name of the workbook, ending in ``.xlsx``; an older workbook there is replaced.

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
    return _saved(path, lambda: build(analysis, studies, system=system))


def write_comparison(comparison: Comparison, path: Path, *, system: System | None = None) -> Path:
    """Write the workbook of a comparison of compounds; as `write`.

    Raises
    ------
    InputError
        As `write`.
    """
    return _saved(path, lambda: build_comparison(comparison, system=system))


def _saved(path: Path, made: Callable[[], Workbook]) -> Path:
    """Write a workbook under a temporary name beside its own, then rename."""
    if path.suffix.lower() != ".xlsx":
        raise InputError(f'{path}: a workbook\'s name ends in .xlsx, got "{path.suffix}"')
    partial = path.with_name(f".{uuid4().hex}.part")
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder; give the name of a workbook in it")
        if not path.absolute().parent.is_dir():
            raise InputError(f"{path}: its folder does not exist; create it or choose another")
        content = BytesIO()
        made().save(content)
        partial.write_bytes(content.getbuffer())
        partial.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None
    finally:
        with suppress(OSError):  # no such file after the rename; a folder that went away has nothing to clean
            partial.unlink(missing_ok=True)
    return path


def build(analysis: Analysis, studies: Studies | None = None, *, system: System | None = None) -> Workbook:
    """Workbook of an analysis and of the studies its spec asks for, not yet saved."""
    analysis = analysis.in_units(chosen(analysis.conveyor, system))
    fills: dict[str, Callable[[Worksheet], None]] = {
        title: partial(fill, analysis=analysis) for title, fill in SHEETS.items()
    }
    last = fills.popitem()
    if studies is not None and studies.cases is not None:
        fills["Load cases"] = partial(study_sheets.cases, study=studies.cases)
    if studies is not None and studies.duty is not None:
        fills["Duty"] = partial(study_sheets.duty, study=studies.duty)
    if studies is not None and studies.uncertainty is not None:
        fills["Uncertainty"] = partial(study_sheets.uncertainty, study=studies.uncertainty)
    return _book(analysis.conveyor.name, fills | dict([last]))


def _book(name: str, fills: Mapping[str, Callable[[Worksheet], None]]) -> Workbook:
    book = Workbook()
    book.remove(book.worksheets[0])
    book.properties.title = legible(name)
    book.properties.creator = f"conveyor {version('conveyor')}"
    for title, fill in fills.items():
        sheet = book.create_sheet(title)
        fill(sheet)
        print_set_up(sheet, name)
    return book


def build_comparison(comparison: Comparison, *, system: System | None = None) -> Workbook:
    """Workbook of a comparison, not yet saved."""
    chosen(comparison.conveyor, system)
    fills = {title: partial(fill, comparison=comparison) for title, fill in COMPARISON_SHEETS.items()}
    return _book(comparison.conveyor.name, fills)
