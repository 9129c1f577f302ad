"""A workbook from outside, opened with care: sizes first, then cells as plain values or what is wrong."""

from __future__ import annotations

import math
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from openpyxl import load_workbook
from openpyxl.utils import get_column_letter
from openpyxl.utils.exceptions import InvalidFileException
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.errors import InputError
from conveyor.files.archive import Limits, look_through
from conveyor.files.content import file_content
from conveyor.template.values import Value

LARGEST_FILE: Final = 3_000_000
"""Bytes; a template of a thousand sections has a twentieth of it."""
LARGEST_CONTENT: Final = 10_000_000
"""Bytes of all parts together, unpacked, as the file states them (no more is ever unpacked); a template of a
thousand sections has a tenth of it, and so much takes some seconds to parse."""
MOST_PARTS: Final = 2_000
MOST_CELLS: Final = 300_000
"""Rows times columns of one sheet; a template of a thousand sections has a tenth of it."""

MOST_ELEMENTS: Final = 150_000
LIMITS: Final = Limits(
    content=LARGEST_CONTENT, parts=MOST_PARTS, elements=MOST_ELEMENTS, expected="input workbook"
)
"""Looked for before anything is built of a workbook; a template of a thousand sections has 40,000 elements."""

_OLE: Final = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ENCRYPTED: Final = "EncryptedPackage".encode("utf-16-le")
# What zipfile, expat and openpyxl raise on damaged files
_DAMAGED: Final = (
    zipfile.BadZipFile, zlib.error, InvalidFileException, SyntaxError, EOFError, OSError, KeyError, ValueError,
    TypeError, IndexError, AttributeError, ArithmeticError, NotImplementedError, RuntimeError,
)  # fmt: skip


@dataclass(frozen=True)
class CellValue:
    """A cell that is not empty: its value, or why it has none."""

    value: Value
    problem: str = ""
    percent: bool = False
    """Whether the cell shows its number as a percentage."""


@dataclass(frozen=True)
class CellGrid:
    """The cells of a sheet that are not empty, by row and column (both from 1), and its merged ranges."""

    name: str
    cells: dict[tuple[int, int], CellValue]
    merged: tuple[tuple[int, int, int, int], ...]
    """First row, first column, last row, last column."""

    def text(self, row: int, column: int) -> str:
        """Return a cell's text, "" without one."""
        found = self.cells.get((row, column))
        return str(found.value).strip() if found is not None and not found.problem else ""

    def rows(self) -> list[int]:
        """Return the rows that hold anything."""
        return sorted({row for row, _ in self.cells})


def address(sheet: str, row: int, column: int) -> str:
    """Write the place of a cell as spreadsheets do.

    Examples
    --------
    >>> address("Belt", 4, 3), address("Rubber compound 1", 4, 3)
    ('Belt!C4', "'Rubber compound 1'!C4")
    """
    quoted = sheet if sheet.isidentifier() else "'" + sheet.replace("'", "''") + "'"
    return f"{quoted}!{get_column_letter(column)}{row}"


def read_workbook(path: Path) -> dict[str, CellGrid]:
    """Read every sheet of a workbook.

    Raises
    ------
    InputError
        The file cannot be read, is no workbook, is damaged, protected by a password, larger than a filled-in
        template can be, or declares XML entities.
    """
    return grids(path, _content(path))


def grids(path: Path, content: bytes) -> dict[str, CellGrid]:
    """Read every sheet of a workbook whose bytes are given; the path is for messages.

    Raises
    ------
    InputError
        As `read_workbook`.
    """
    look_through(content, str(path), LIMITS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # openpyxl names the parts it does not keep; none is read here
            formulas, results = (
                load_workbook(BytesIO(content), data_only=only, keep_links=False) for only in (False, True)
            )
            return {grid.name: grid for grid in _grids(path, formulas, results)}
    except InputError:
        raise
    except _DAMAGED:
        raise InputError(f"{path}: the workbook is damaged or incomplete; save or copy it again") from None


def _content(path: Path) -> bytes:
    if path.suffix.lower() != ".xlsx":
        raise InputError(f'{path}: expected a workbook that ends in .xlsx, got "{path.name}"')
    content = file_content(path, largest=LARGEST_FILE, expected="input workbook")
    if content.startswith(_OLE):
        if _ENCRYPTED in content:
            raise InputError(f"{path}: protected by a password; save it without one")
        raise InputError(f"{path}: not a workbook of the .xlsx format; save it as .xlsx")
    if not content.startswith(b"PK"):
        found = "empty" if not content else "not a workbook (.xlsx)"
        raise InputError(f"{path}: {found}; write one with: conveyor template input.xlsx")
    return content


def _grids(path: Path, formulas: Workbook, results: Workbook) -> Iterator[CellGrid]:
    for sheet in formulas.worksheets:
        rows, columns = sheet.max_row, sheet.max_column
        if rows * columns > MOST_CELLS:
            raise InputError(
                f'{path}: sheet "{sheet.title}" reaches to {get_column_letter(columns)}{rows}; '
                "delete the empty rows and columns beyond the table"
            )
        shown = results[sheet.title]
        merged = tuple((r.min_row, r.min_col, r.max_row, r.max_col) for r in sheet.merged_cells.ranges)
        yield CellGrid(sheet.title, dict(_found(sheet, shown)), merged)


def _found(formulas: Worksheet, results: Worksheet) -> Iterator[tuple[tuple[int, int], CellValue]]:
    for row in formulas.iter_rows():
        for cell in row:
            if cell.value is not None:
                where = (cell.row, cell.column)
                found = _one(cell, results.cell(*where))
                if found.problem or found.value is not None:
                    yield where, found


def _one(cell: Any, result: Any) -> CellValue:
    value = result.value
    if cell.data_type == "f" and value is None:
        return CellValue(
            None,
            "holds a formula without a result; open the workbook in a spreadsheet program, let it calculate "
            "and save it, or type the value",
        )
    if result.data_type == "e":
        return CellValue(None, f"holds the error {value}; correct its formula or type the value")
    if isinstance(value, float) and not math.isfinite(value):
        return CellValue(None, "holds a number that is not finite")
    if isinstance(value, str):
        return CellValue(value if value.strip() else None)
    if isinstance(value, bool | int | float):
        return CellValue(value, percent="%" in str(result.number_format))
    return CellValue(
        None,
        f"holds a date or time ({value}): the spreadsheet program took the number for one; "
        "format the cell as a number and type it again",
    )
