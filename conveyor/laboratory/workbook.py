"""Sheets of an .xlsx workbook to grids of text cells."""

from __future__ import annotations

import datetime as dt
import io
import warnings
import zipfile
import zlib
from typing import Any, Final

from conveyor.laboratory.cells import Grid, Line, refusal
from conveyor.laboratory.decimals import DATE_MARK, PERCENT_MARK

MAGIC = b"PK\x03\x04"
"""First bytes of a zip archive, which an .xlsx file is."""
LARGEST_CONTENT: Final = 100_000_000
"""Bytes of all parts together; a sheet of a million rows unpacks to about as many."""


_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    SyntaxError,
    LookupError,
    ValueError,
    OSError,
    EOFError,
    RuntimeError,
    AttributeError,
    TypeError,
)
"""What openpyxl raises for archives that are cut, encrypted or not a workbook; XML errors are SyntaxErrors."""


def workbook_grids(data: bytes, name: str) -> tuple[Grid, ...]:
    """Read every worksheet.

    Parameters
    ----------
    data : bytes
        The file [-].
    name : str
        Its name in messages [-].

    Returns
    -------
    tuple of Grid
        One for each worksheet, hidden ones included, named `file[sheet]` [-].

    Raises
    ------
    InputError
        If the archive is not a readable workbook.

    Notes
    -----
    Of a formula the value stored in the file is read; without one the cell is empty. Dates and numbers shown
    as a percentage are marked, so that they are refused where a number is expected.
    """
    import openpyxl

    if _unpacked(data) > LARGEST_CONTENT:
        raise refusal(
            name,
            1,
            0,
            f"unpacks to more than {LARGEST_CONTENT:,} bytes; export the one table as CSV",
            lettered=True,
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
            try:
                return tuple(_grid(sheet, f"{name}[{sheet.title}]") for sheet in book.worksheets)
            finally:
                book.close()
        except _DAMAGE:
            raise refusal(
                name,
                1,
                0,
                "not a readable .xlsx workbook; save it again as .xlsx, or export CSV",
                lettered=True,
            ) from None


def _unpacked(data: bytes) -> int:
    """Bytes of all parts as the archive states them; what states too few is cut there and refused as damaged."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return sum(part.file_size for part in archive.infolist())
    except _DAMAGE:
        return 0


def _grid(sheet: Any, name: str) -> Grid:
    lines = []
    for number, row in enumerate(sheet.iter_rows(), start=1):
        cells = [_text(cell) for cell in row]
        while cells and not cells[-1]:
            cells.pop()
        if cells:
            comment = cells[0].startswith("#")
            if comment:
                cells[0] = cells[0].lstrip("# ")
            lines.append(Line(number, tuple(cells), " ".join(filter(None, cells)), comment))
    return Grid(name, tuple(lines), (f"workbook, sheet '{sheet.title}'",), lettered=True, sheet=sheet.title)


def _text(cell: Any) -> str:
    value = cell.value
    if value is None:
        return ""
    if isinstance(value, float | int) and not isinstance(value, bool):
        return PERCENT_MARK + repr(value) if "%" in cell.number_format else repr(value)
    if isinstance(value, dt.datetime | dt.date | dt.time | dt.timedelta):
        return f"{DATE_MARK}{value}"
    return " ".join(str(value).split())
