"""Sheets of an .xlsx workbook to grids of text cells."""

from __future__ import annotations

import datetime as dt
import io
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.laboratory.cells import TextGrid, TextLine, refusal
from conveyor.laboratory.decimals import DATE_MARK, PERCENT_MARK

MAGIC = b"PK\x03\x04"
"""First bytes of a zip archive, which an .xlsx file is."""
LARGEST_CONTENT: Final = 100_000_000
"""Bytes of all parts together; a sheet of a million rows unpacks to about as many."""
MOST_CELLS: Final = 1_000_000
"""Cells of a sheet that hold something."""
LAST_ROW: Final = 1_048_576
LAST_COLUMN: Final = 16_384
"""Of a sheet of .xlsx, ECMA-376."""


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


def workbook_grids(data: bytes, name: str) -> tuple[TextGrid, ...]:
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
        except InputError:
            raise
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


def _grid(sheet: Any, name: str) -> TextGrid:
    with sheet._get_source() as source:  # noqa: SLF001
        if source.read().count(b"<c") > MOST_CELLS:
            raise refusal(
                name, 1, 0, f"more than {MOST_CELLS:,} cells; save the one table as CSV", lettered=True
            )
    lines: list[TextLine] = []
    for number, found in _rows(sheet):
        if not (lines[-1].number if lines else 0) < number <= LAST_ROW:
            raise refusal(
                name,
                lines[-1].number if lines else 1,
                0,
                f"row {number} follows, out of order or beyond {LAST_ROW:,}; open and save the workbook again",
                lettered=True,
            )
        texts = {cell.column: text for cell in found if (text := _text(cell))}
        if not texts:
            continue
        if max(texts) > LAST_COLUMN:
            raise refusal(
                name,
                number,
                max(texts) - 1,
                f"a cell beyond column {LAST_COLUMN:,}; open and save the workbook again",
                lettered=True,
            )
        cells = [texts.get(column, "") for column in range(1, max(texts) + 1)]
        comment = cells[0].startswith("#")
        if comment:
            cells[0] = cells[0].lstrip("# ")
        lines.append(TextLine(number, tuple(cells), " ".join(filter(None, cells)), comment))
    return TextGrid(
        name, tuple(lines), (f"workbook, sheet '{sheet.title}'",), lettered=True, sheet=sheet.title
    )


def _rows(sheet: Any) -> Iterator[tuple[int, list[Any]]]:
    """Numbers and cells of the rows that are in the file: `iter_rows` trusts a stated size, and fills every gap."""
    from openpyxl.cell.read_only import ReadOnlyCell
    from openpyxl.worksheet._reader import WorkSheetParser

    book = sheet.parent
    with sheet._get_source() as source:  # noqa: SLF001
        parser = WorkSheetParser(
            source,
            sheet._shared_strings,  # noqa: SLF001
            data_only=True,
            epoch=book.epoch,
            date_formats=book._date_formats,  # noqa: SLF001
            timedelta_formats=book._timedelta_formats,  # noqa: SLF001
        )
        for number, cells in parser.parse():
            yield number, [ReadOnlyCell(sheet, **cell) for cell in cells if cell["value"] is not None]


def _text(cell: Any) -> str:
    value = cell.value
    if value is None:
        return ""
    if isinstance(value, float | int) and not isinstance(value, bool):
        return PERCENT_MARK + repr(value) if "%" in cell.number_format else repr(value)
    if isinstance(value, dt.datetime | dt.date | dt.time | dt.timedelta):
        return f"{DATE_MARK}{value}"
    return " ".join(str(value).split())
