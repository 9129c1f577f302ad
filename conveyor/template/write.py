"""The input template: a workbook of every field, filled in from a conveyor."""

from __future__ import annotations

from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import Final

from conveyor import shelf, spec
from conveyor.arguments import checked
from conveyor.errors import InputError
from conveyor.files import marks
from conveyor.files.saving import naming, save, writable
from conveyor.forms.read import read_filled
from conveyor.models import Conveyor
from conveyor.report.cells import legible
from conveyor.starter.values import in_units, values
from conveyor.template.draw import Book
from conveyor.template.fill import filled
from conveyor.units import System

_MADE: Final = Path("template.xlsx")
_SECTION: Final = {"name": "tail to head", "length": "4000 m | 13500 ft", "lift": "45 m | 150 ft"}
"""Section of the example template."""


def example(units: System = "SI") -> Conveyor:
    """Example conveyor of the template: the overland starter on one straight section."""
    data = values("overland", units)
    data["route"]["sections"] = [{key: in_units(value, units) for key, value in _SECTION.items()}]
    return spec.from_data(data)


@checked
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
    writable(where)
    with naming(where):  # openpyxl writes temporary files
        made = template(conveyor, shelves=shelves, units=units)
    save({where: made})
    return where


def template(
    conveyor: Conveyor | None = None, *, shelves: Iterable[str | Path] = (), units: System = "SI"
) -> bytes:
    """Input workbook as bytes, read back and compared; as `write_template`.

    Raises
    ------
    InputError
        A workbook cannot hold the conveyor without loss.
    """
    given, folders = example(units) if conveyor is None else conveyor, tuple(shelves)
    content = _content(given, folders)
    _compare(content, given, folders)
    return content


def _content(conveyor: Conveyor, shelves: tuple[str | Path, ...]) -> bytes:
    drawn = Book(conveyor.name, shelf.names(shelves), conveyor.report.units).draw(filled(conveyor, shelves))
    drawn.properties.title = legible(conveyor.name)
    drawn.properties.creator = marks.maker()
    content = BytesIO()
    drawn.save(content)
    return content.getvalue()


def _compare(content: bytes, conveyor: Conveyor, shelves: tuple[str | Path, ...]) -> None:
    """Refuse a workbook that does not read back to the same conveyor."""
    try:
        filled = read_filled(_MADE, Conveyor, content)
        same = spec.from_data(filled.data, shelves=shelves).as_data() == conveyor.as_data()
    except InputError as error:
        lines = str(error).replace(f"{_MADE}:", "")
        raise InputError(f"a workbook cannot hold this conveyor; write it as YAML:\n{lines}") from None
    if not same:
        raise InputError(
            "a workbook cannot hold every text of this conveyor (control characters, line ends of other systems, "
            "more than 32767 characters); write it as YAML or change the text"
        )
