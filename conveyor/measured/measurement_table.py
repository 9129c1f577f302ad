"""Tables of measurements, .csv or .xlsx: units in the headers, one row a measurement; doubtful cells are refused."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final, NamedTuple

from conveyor.errors import InputError
from conveyor.files.file_bytes import file_content
from conveyor.files.workbook_cells import MAGIC
from conveyor.laboratory.cell_grid import TextGrid, TextLine
from conveyor.laboratory.delimited_text import table_lines
from conveyor.laboratory.encoding import decode_text
from conveyor.laboratory.numbers import decimal_mark, is_number, why_not_a_number
from conveyor.laboratory.sheet_grids import workbook_grids
from conveyor.units import quantity

LARGEST_FILE: Final = 10_000_000
"""Bytes; a year of hourly means has a tenth."""
_HEADER: Final = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")


class ColumnMeaning(NamedTuple):
    """Meaning of a header: field, kind of quantity ("" for text), and the kind of "%", if allowed."""

    field: str
    kind: str
    share: str = ""


@dataclass(frozen=True)
class TableKind:
    """Description of a kind of table of measurements.

    Attributes
    ----------
    what : str
        "table of measured runs".
    one : str
        Noun of a row: "run".
    columns : mapping of str to ColumnMeaning
        Headers without their unit, in small letters; several may mean one field.
    needed : mapping of str to str
        Fields required in every row, and their names in messages.
    example : str
        A header.
    most_rows : int
        Largest number of rows.
    """

    what: str
    one: str
    columns: Mapping[str, ColumnMeaning]
    needed: Mapping[str, str]
    example: str
    most_rows: int = 1000


@dataclass(frozen=True)
class MeasuredRow:
    """A row: quantities and texts by field, and the column of each."""

    number: int
    given: Mapping[str, Any]
    heads: Mapping[str, _Column]
    grid: TextGrid

    def header(self, field: str) -> str:
        """Name of a field's column, without its unit."""
        return self.heads[field].name

    def refusal(self, message: str, field: str | None = None) -> InputError:
        """An error that names file and row, and the column of a field."""
        if field is None or field not in self.heads:
            return InputError(f"{self.grid.name}:{self.number}: {message}")
        head = self.heads[field]
        return self.grid.refusal(self.number, head.index, message, header=head.header)


class _Column:
    """A column: index, name, meaning, unit."""

    def __init__(self, index: int, header: str, kind: TableKind) -> None:
        match = _HEADER.fullmatch(header)
        self.index, self.header = index, header
        self.name = "" if match is None else " ".join(match[1].lower().replace("_", " ").split())
        self.unit = "" if match is None or match[2] is None else match[2]
        if self.name.startswith("note"):
            self.name = "note"
        self.meant = kind.columns.get(self.name)

    @property
    def field(self) -> str:
        return "" if self.meant is None else self.meant.field


def read_rows(path: str | Path, kind: TableKind) -> tuple[MeasuredRow, ...]:
    """Read a table of measurements from text or from a workbook with one filled sheet."""
    return measured_rows(read_grid(path, kind), kind)


def measured_rows(grid: TextGrid, kind: TableKind) -> tuple[MeasuredRow, ...]:
    """Rows of a grid below its header, the first line that names two columns."""
    lines = [line for line in grid.lines if not line.comment]
    lines = lines[next((k for k, line in enumerate(lines) if _is_header(line.cells, kind)), 0) :]
    if len(lines) < 2:
        raise InputError(
            f"{grid.name}: no {kind.one} in it; the first line names columns, as {kind.example}, one row a {kind.one} "
            "follows"
        )
    head, *rows = lines
    if len(rows) > kind.most_rows:
        raise InputError(
            f"{grid.name}: {len(rows)} rows, at most {kind.most_rows} are read; give means over longer times"
        )
    columns = _known_columns(grid, head, kind)
    mark = _decimal_mark(grid, columns, rows)
    return tuple(_measured_row(grid, columns, row, width=len(head.cells), mark=mark, kind=kind) for row in rows)


def read_grid(path: str | Path, kind: TableKind, *, form: Collection[str] = ()) -> TextGrid:
    """Grid of a text or of the one filled sheet of a workbook; of a form the sheet of one of its names."""
    path = Path(path)
    data = file_content(path, largest=LARGEST_FILE, expected=kind.what)
    if data.startswith(MAGIC):
        filled = [grid for grid in workbook_grids(data, path.name) if grid.lines]
        filled = [grid for grid in filled if grid.sheet in form] or filled
        if len(filled) != 1:
            raise InputError(f"{path}: {len(filled)} sheets hold cells; keep the {kind.one}s on one, and save it alone")
        return filled[0]
    text, _ = decode_text(data, path.name)
    return TextGrid(path.name, tuple(table_lines(text, partial(_is_header, kind=kind))), ())


def _is_header(cells: Sequence[str], kind: TableKind) -> bool:
    """True if a line names two columns or more."""
    return sum(bool(_Column(*cell, kind).field) for cell in enumerate(cells)) >= 2


def _known_columns(grid: TextGrid, head: TextLine, kind: TableKind) -> list[_Column]:
    """Named columns; unknown and repeated ones are refused."""
    heads: dict[str, _Column] = {}
    named = [_Column(index, header, kind) for index, header in enumerate(head.cells) if header]
    unknown = [column for column in named if not column.field]
    if unknown:
        others = ", ".join(f'"{column.header}"' for column in unknown[1:])
        raise grid.refusal(
            head.number, unknown[0].index, f"not known{f', nor {others}' if others else ''}; allowed: "
            f"{', '.join(kind.columns)}, with a unit as in {kind.example}; begin a name with \"note\" to have it left "
            "alone", header=unknown[0].header,
        )  # fmt: skip
    for column in named:
        index, header = column.index, column.header
        if column.name != "note" and column.name in heads:
            raise grid.refusal(head.number, index, "is there twice; remove one of the two", header=header)
        heads.setdefault(column.name, column)
    there = {column.field for column in heads.values()}
    missing = [wanted for field, wanted in kind.needed.items() if field not in there]
    if missing:
        raise grid.refusal(head.number, 0, f"no column {' and none '.join(missing)}; name it as in {kind.example}")
    return list(heads.values())


def _filled_cells(row: TextLine, columns: list[_Column]) -> Iterator[tuple[_Column, str]]:
    for column in columns:
        cell = row.cells[column.index] if column.index < len(row.cells) else ""
        if cell:
            yield column, cell


def _decimal_mark(grid: TextGrid, columns: list[_Column], rows: list[TextLine]) -> str:
    """Decimal mark of all numbers together."""
    numbers = [
        (row, *each) for row in rows for each in _filled_cells(row, columns) if each[0].unit and is_number(each[1])
    ]
    mark, doubtful = decimal_mark(cell for *_, cell in numbers)
    if doubtful is not None:
        row, column = next((row, column) for row, column, cell in numbers if cell == doubtful)
        raise grid.refusal(
            row.number, column.index, f"'{doubtful}' may have a decimal comma or one between thousands; write decimal "
            "points and nothing between thousands", header=column.header,
        )  # fmt: skip
    return mark


def _measured_row(
    grid: TextGrid, columns: list[_Column], row: TextLine, *, width: int, mark: str, kind: TableKind
) -> MeasuredRow:
    extra = next((i for i, cell in enumerate(row.cells) if cell and i >= width), None)
    if extra is not None:
        raise grid.refusal(row.number, extra, "a cell beyond the last header; name its column or remove it")
    given: dict[str, Any] = {}
    heads: dict[str, _Column] = {}
    for column, cell in _filled_cells(row, columns):
        if column.field in given:
            raise grid.refusal(
                row.number, column.index, f"the row has a {heads[column.field].name} and a {column.name}; leave one of "
                "the two empty", header=column.header,
            )  # fmt: skip
        heads[column.field] = column
        try:
            given[column.field] = _cell_value(column, cell, mark)
        except InputError as error:
            raise grid.refusal(row.number, column.index, str(error), header=column.header) from None
    for field, wanted in kind.needed.items():
        if field not in given:
            index = next(column.index for column in columns if column.field == field)
            raise grid.refusal(row.number, index, f"{wanted} is missing in the row; complete or delete the row")
    return MeasuredRow(row.number, given, heads, grid)


def _cell_value(column: _Column, cell: str, mark: str) -> Any:
    """Value of a cell in the unit of its header or its own; text unchanged."""
    meant = column.meant
    if meant is None or not meant.kind:
        return cell
    if not column.unit:
        return quantity(cell, meant.kind)
    if not is_number(cell):
        raise InputError(why_not_a_number(cell))
    number = cell.replace(",", ".") if mark == "," else cell
    kind = meant.share if meant.share and column.unit == "%" else meant.kind
    return quantity(f"{number} {column.unit}", kind)
