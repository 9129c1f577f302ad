"""Cells of an input workbook; the archive is scanned as a stream before openpyxl reads it."""

from __future__ import annotations

import re
import warnings
import zipfile
import zlib
from dataclasses import dataclass, replace
from io import BytesIO
from typing import IO, Any, Final, Literal
from xml.parsers import expat

from conveyor.errors import InputError

MAGIC: Final = b"PK"
"""First bytes of a zip archive, which an .xlsx file is."""
LAST_ROW: Final = 1_048_576
LAST_COLUMN: Final = 16_384
"""Limits of a sheet (ECMA-376)."""
DEEPEST: Final = 100
"""Levels of XML; a chart has twenty."""

_PIECE: Final = 1 << 16
_LONGEST_TAG: Final = 4 * _PIECE
_REFERENCE: Final = re.compile(r"\$?([A-Za-z]{1,4})\$?([0-9]{1,12})")
# raised by zipfile, expat and openpyxl for archives that are truncated, encrypted or no workbook
_DAMAGE_ERRORS: Final = (
    zipfile.BadZipFile, zlib.error, SyntaxError, EOFError, OSError, LookupError, ValueError, TypeError,
    AttributeError, ArithmeticError, NotImplementedError, RuntimeError,
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class ArchiveLimits:
    """Size limits of an archive, all parts together.

    Attributes
    ----------
    content : int
        Unpacked bytes as stated by the archive (no more is ever unpacked).
    parts : int
        Number of files.
    elements : int
        XML elements: cells, rows, comments, styles.
    expected : str
        Expected kind of file, for the message on a larger one ("input workbook").
    """

    content: int
    parts: int
    elements: int
    expected: str


@dataclass(frozen=True)
class SheetCell:
    """A non-empty cell: its value (of a formula the stored one) and kind.

    Attributes
    ----------
    value : object
        Text, number or boolean; for other kinds the raw content.
    kind : str
        A date or time, an error of a formula, a formula without a stored value, else a value.
    percent : bool
        True if the number is formatted as a percentage.
    formula : bool
        True if the value is that of a formula.
    """

    value: Any
    kind: Literal["value", "date", "error", "no result"] = "value"
    percent: bool = False
    formula: bool = False


@dataclass(frozen=True)
class Sheet:
    """Non-empty cells of a sheet by row and column (both from 1), and its merged ranges."""

    name: str
    cells: dict[tuple[int, int], SheetCell]
    merged: tuple[tuple[int, int, int, int], ...] = ()
    """First row, first column, last row, last column."""

    def text(self, row: int, column: int) -> str:
        """Text of a cell; "" where it has no value."""
        cell = self.cells.get((row, column))
        return str(cell.value).strip() if cell is not None and cell.kind == "value" else ""

    def rows(self) -> list[int]:
        """Numbers of the rows with content."""
        return sorted({row for row, _ in self.cells})


def cell_name(row: int, column: int) -> str:
    """Name of a cell, such as B4."""
    from openpyxl.utils import get_column_letter

    return f"{get_column_letter(column)}{row}"


def read_sheets(content: bytes, place: str, limits: ArchiveLimits) -> tuple[Sheet, ...]:
    """Read every worksheet of a workbook, hidden ones included.

    Parameters
    ----------
    content : bytes
        The file.
    place : str
        Beginning of messages.
    limits : ArchiveLimits
        Size limits.

    Raises
    ------
    InputError
        No archive, damaged, protected, more than the limits, a declared document type (entities), nested too deep, a
        cell beyond the last of a sheet, or given twice.
    """
    import openpyxl

    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            problem = _archive_problem(archive, limits)
    except _DAMAGE_ERRORS:
        raise InputError(f"{place}: damaged or cut short; save or copy it again") from None
    if problem:
        raise InputError(f"{place}: {problem}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # openpyxl warns about parts it does not keep; none is read here
            book = openpyxl.load_workbook(BytesIO(content), read_only=True, data_only=True, keep_links=False)
            try:
                return tuple(_read_sheet(sheet, place) for sheet in book.worksheets)
            finally:
                book.close()
    except InputError:
        raise
    except _DAMAGE_ERRORS:
        raise InputError(f"{place}: the workbook is damaged or incomplete; save or copy it again") from None


def _archive_problem(archive: zipfile.ZipFile, limits: ArchiveLimits) -> str:
    parts = archive.infolist()
    if len(parts) > limits.parts or sum(part.file_size for part in parts) > limits.content:
        return f"unpacks to more than {limits.content:,} bytes or {limits.parts:,} parts; this is no {limits.expected}"
    if any(part.flag_bits & 1 for part in parts):
        return "protected by a password; save it without one"
    seen = _ArchiveScan(limits)
    for part in parts:
        with archive.open(part) as stream:
            seen.part(stream, part.filename)
        if seen.problem:
            return seen.problem
    return ""


class _ArchiveScan:
    """Scan of an archive that stops at the first violation of its limits."""

    def __init__(self, limits: ArchiveLimits) -> None:
        self.problem = ""
        self._limits = limits
        self._elements = self._depth = 0

    def part(self, stream: IO[bytes], name: str) -> None:
        """Read a part to its end, including its checksum; parsed while it is valid XML."""
        self._depth = 0
        parser = expat.ParserCreate(namespace_separator="}")
        parser.StartDoctypeDeclHandler = self._doctype
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        # expat 2.6 and later may defer a tag until twice its length
        if hasattr(parser, "SetReparseDeferralEnabled"):
            parser.SetReparseDeferralEnabled(False)
        is_xml, read = True, 0
        while piece := stream.read(_PIECE):
            read += len(piece)
            if is_xml:
                try:
                    parser.Parse(piece)
                    # each piece of a tag is parsed again from its beginning
                    if read - parser.CurrentByteIndex > _LONGEST_TAG:
                        self._stop(f"has a tag of more than {_LONGEST_TAG:,} bytes")
                except expat.ExpatError:  # a picture, or damage that openpyxl will report
                    is_xml = False
            if self.problem:
                self.problem = f"{name} {self.problem}; this is no {self._limits.expected}"
                return

    def _doctype(self, *_: object) -> None:
        self._stop("declares a document type, which no workbook does")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._elements += 1 + attributes.get("sqref", "").count(" ")
        self._depth += 1
        if self._elements > self._limits.elements:
            self._stop(f"holds more than {self._limits.elements:,} cells and other elements")
        if self._depth > DEEPEST:
            self._stop(f"is nested deeper than {DEEPEST} levels")
        if tag.endswith(("}row", "}c")) and not _on_sheet(attributes.get("r", "")):
            self._stop(f"has a cell or row {attributes['r'][:40]}, beyond the last of a sheet")

    def _end(self, _: str) -> None:
        self._depth -= 1

    def _stop(self, problem: str) -> None:
        self.problem = problem
        raise expat.ExpatError


def _on_sheet(reference: str) -> bool:
    """True for a row number or cell name within the limits of a sheet, and for other text."""
    if reference.isdecimal():
        return len(reference) < 9 and int(reference) <= LAST_ROW
    match = _REFERENCE.fullmatch(reference)
    if match is None:
        return True
    column = 0
    for letter in match[1].upper():
        column = 26 * column + ord(letter) - ord("A") + 1
    return column <= LAST_COLUMN and int(match[2]) <= LAST_ROW


def _read_sheet(sheet: Any, place: str) -> Sheet:
    """Cells stored in the file: openpyxl's own reader trusts a stated size and fills gaps and merged ranges."""
    from openpyxl.cell.read_only import ReadOnlyCell
    from openpyxl.worksheet._reader import FORMULA_TAG, WorkSheetParser

    formulas: set[tuple[int, int]] = set()

    class Parser(WorkSheetParser):
        def parse_cell(self, element: Any) -> dict[str, Any]:
            cell: dict[str, Any] = super().parse_cell(element)
            if element.find(FORMULA_TAG) is not None:
                formulas.add((cell["row"], cell["column"]))
                if cell["value"] is None:
                    cell["data_type"] = "f"
            return cell

    book = sheet.parent
    cells: dict[tuple[int, int], SheetCell] = {}
    with sheet._get_source() as source:  # noqa: SLF001
        parser = Parser(
            source,
            sheet._shared_strings,  # noqa: SLF001
            data_only=True,
            epoch=book.epoch,
            date_formats=book._date_formats,  # noqa: SLF001
            timedelta_formats=book._timedelta_formats,  # noqa: SLF001
        )
        for _, row in parser.parse():
            for read in row:
                where = (read["row"], read["column"])
                values = _sheet_cell(ReadOnlyCell(sheet, **read))
                if values is not None and where in formulas:
                    values = replace(values, formula=True)
                if values is not None and cells.setdefault(where, values) is not values:
                    cell = cell_name(*where)
                    raise InputError(
                        f"{place}: sheet '{sheet.title}' has cell {cell} twice; open and save the workbook again"
                    )
        merged = () if parser.merged_cells is None else parser.merged_cells.mergeCell
        ranges = ((each.min_row, each.min_col, each.max_row, each.max_col) for each in merged)
        return Sheet(sheet.title, cells, tuple(ranges))


def _sheet_cell(cell: Any) -> SheetCell | None:
    value = cell.value
    if cell.data_type == "f":
        return SheetCell(None, "no result")
    if value is None or (isinstance(value, str) and not value.strip()):
        return None
    if cell.data_type == "e":
        return SheetCell(value, "error")
    if isinstance(value, str | bool):
        return SheetCell(value)
    if isinstance(value, int | float):
        return SheetCell(value, percent="%" in cell.number_format)
    return SheetCell(value, "date")
