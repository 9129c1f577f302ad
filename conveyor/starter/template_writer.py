"""The input template: a workbook of every field, filled in from a conveyor."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from conveyor import shelf, spec
from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.files.atomic_write import check_writable, save_files
from conveyor.files.workbook_bytes import workbook_bytes
from conveyor.forms.form_reader import read_form
from conveyor.models import Conveyor
from conveyor.report.cells import cell_text
from conveyor.starter.filled_cells import fill_sheets
from conveyor.starter.starter_data import in_units, starter_values
from conveyor.starter.template_sheets import TemplateBook
from conveyor.units import System

_TEMPLATE_NAME: Final = Path("template.xlsx")
_EXAMPLE_SECTION: Final = {"name": "tail to head", "length": "4000 m | 13500 ft", "lift": "45 m | 150 ft"}
"""Section of the example template."""


def example_conveyor(units: System) -> Conveyor:
    """Example conveyor of the template: the overland starter on one straight section."""
    data = starter_values("overland", units)
    data["route"]["sections"] = [{key: in_units(value, units) for key, value in _EXAMPLE_SECTION.items()}]
    return spec.from_data(data)


@check_arguments
def write_template(
    path: str | Path,
    conveyor: Conveyor | None = None,
    *,
    shelves: Iterable[str | Path] = (),
    units: System = "SI",
) -> Path:
    """Write an input workbook: made, read back and compared, then written.

    Parameters
    ----------
    path : str or Path
        Name of the workbook, ending in ``.xlsx``; an older workbook there is replaced.
    conveyor : Conveyor, optional
        Conveyor to fill in: values and units as written, defaults left open, shelf compounds by name, others
        written out. Without it an example.
    shelves : iterable of path
        Further folders of compounds, as in `conveyor.spec.load`.
    units : {"SI", "US"}
        System of the example; a conveyor has that of its report.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        The path does not end in .xlsx, is a folder, lies in none or cannot be written; or a workbook cannot
        hold the conveyor without loss (characters that XML does not have, texts beyond 32767 characters).
    """
    where = Path(path)
    if where.suffix.lower() != ".xlsx":
        raise InputError(f'{where}: a workbook\'s name ends in .xlsx, got "{where.suffix}"')
    check_writable(where)
    save_files({where: template_bytes(conveyor, shelves=shelves, units=units)})
    return where


def template_bytes(conveyor: Conveyor | None, *, shelves: Iterable[str | Path], units: System) -> bytes:
    """Input workbook as bytes, read back and compared; as `write_template`.

    Raises
    ------
    InputError
        A workbook cannot hold the conveyor without loss.
    """
    given, folders = example_conveyor(units) if conveyor is None else conveyor, tuple(shelves)
    content = _workbook_bytes(given, folders)
    _check_round_trip(content, given, folders)
    return content


def _workbook_bytes(conveyor: Conveyor, shelves: tuple[str | Path, ...]) -> bytes:
    drawn = TemplateBook(conveyor.name, shelf.names(shelves), conveyor.report.units).draw(
        fill_sheets(conveyor, shelves)
    )
    drawn.properties.title = cell_text(conveyor.name)
    drawn.properties.creator = output_marks.program_version()
    return workbook_bytes(drawn)


def _check_round_trip(content: bytes, conveyor: Conveyor, shelves: tuple[str | Path, ...]) -> None:
    """Refuse a workbook that does not read back to the same conveyor."""
    try:
        filled = read_form(_TEMPLATE_NAME, Conveyor, content)
        same = spec.from_data(filled.data, shelves=shelves).as_data() == conveyor.as_data()
    except InputError as error:
        lines = str(error).replace(f"{_TEMPLATE_NAME}:", "")
        raise InputError(f"a workbook cannot hold this conveyor; write it as YAML:\n{lines}") from None
    if not same:
        raise InputError(
            "a workbook cannot hold every text of this conveyor (control characters, line ends of other systems, "
            "more than 32767 characters); write it as YAML or change the text"
        )
