"""The input template: a workbook of every field, filled in from a conveyor."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import Final
from uuid import uuid4

from conveyor import shelf, spec
from conveyor.errors import InputError
from conveyor.files.saving import writable
from conveyor.models import Conveyor
from conveyor.report.cells import legible
from conveyor.template.draw import Book
from conveyor.template.fill import filled
from conveyor.template.read import read_template

EXAMPLE: Final = Path(__file__).with_name("example.yaml")


def write_template(
    path: str | Path, conveyor: Conveyor | None = None, *, shelves: Iterable[str | Path] = ()
) -> Path:
    """Write an input workbook: under a temporary name beside it, read back and compared, then renamed.

    Parameters
    ----------
    path : str or Path
        Name of the workbook, ending in ``.xlsx``; an older workbook there is replaced.
    conveyor : Conveyor, optional
        What it is filled in with: values and units as written, defaults left open, compounds of the shelf by
        name and others written out. Without it an example.
    shelves : iterable of path
        Further folders of compounds, as in `conveyor.spec.load`.

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
    where, folders = Path(path), tuple(shelves)
    given = spec.load(EXAMPLE) if conveyor is None else conveyor
    if where.suffix.lower() != ".xlsx":
        raise InputError(f'{where}: a workbook\'s name ends in .xlsx, got "{where.suffix}"')
    writable(where)
    partial = where.with_name(f".{uuid4().hex}.xlsx")
    try:
        partial.write_bytes(_content(given, folders))
        _compare(partial, given, folders)
        partial.replace(where)
    except OSError as error:
        raise InputError(f"{where}: cannot be written ({error.strerror or error})") from None
    finally:
        with suppress(OSError):  # no such file after the rename
            partial.unlink(missing_ok=True)
    return where


def _content(conveyor: Conveyor, shelves: tuple[str | Path, ...]) -> bytes:
    drawn = Book(conveyor.name, shelf.names(shelves)).draw(filled(conveyor, shelves))
    drawn.properties.title = legible(conveyor.name)
    drawn.properties.creator = f"conveyor {version('conveyor')}"
    content = BytesIO()
    drawn.save(content)
    return content.getvalue()


def _compare(partial: Path, conveyor: Conveyor, shelves: tuple[str | Path, ...]) -> None:
    """Refuse to keep a workbook that does not read back to the same conveyor."""
    try:
        same = spec.from_data(read_template(partial).data, shelves=shelves).as_data() == conveyor.as_data()
    except InputError as error:
        lines = str(error).replace(f"{partial}:", "")
        raise InputError(f"a workbook cannot hold this conveyor; write it as YAML:\n{lines}") from None
    if not same:
        raise InputError(
            "a workbook cannot hold every text of this conveyor (control characters, line ends of other systems, "
            "more than 32767 characters); write it as YAML or change the text"
        )
