"""Where the table is in a grid: header, unit row, body; preamble, remarks and blocks around it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress, pairwise, zip_longest
from typing import Final

import numpy as np

from conveyor.errors import InputError
from conveyor.laboratory.grid import TextGrid, TextLine
from conveyor.laboratory.names import Meaning, meaning
from conveyor.laboratory.numbers import is_number
from conveyor.laboratory.table import IntArray
from conveyor.laboratory.units import is_any_unit

EXCLUDE: Final = "or leave it out with exclude (--exclude)"
"""The cure of a row that needs not be read."""
_EXCLUDED: Final = re.compile(r"\d{1,9}(?:-\d{1,9})?(?:,\d{1,9}(?:-\d{1,9})?)*")
_LISTED: Final = re.compile(r"[A-Za-z]+ ?(\d{1,2})")
EXAMPLE: Final = "a header row such as 'frequency_Hz,storage_MPa,loss_MPa'"


@dataclass(frozen=True)
class DataColumn:
    """One column of the file, by the text of its header and of the unit row."""

    index: int
    header: str
    meaning: Meaning | None
    unit: str | None


@dataclass(frozen=True)
class DataTable:
    """Header and rows of the one table of a grid, the block of each row, and `key: value` lines with their rows."""

    grid: TextGrid
    header_row: int
    columns: tuple[DataColumn, ...]
    rows: tuple[TextLine, ...]
    blocks: tuple[int, ...]
    metadata: Mapping[str, tuple[str, int]]
    notes: tuple[str, ...]

    def refusal(self, column: DataColumn, message: str, row: int | None = None) -> InputError:
        """Error at the header of a column, or at one of its rows, counted from 0."""
        number = self.header_row if row is None else self.rows[row].number
        return self.grid.refusal(number, column.index, message, header=column.header)

    def label(self, column: DataColumn) -> str:
        """How notes name a column, as in `column 2 "E' (Pa)"`."""
        return str(self.refusal(column, "")).split(": ", 1)[1].removesuffix(":")

    @property
    def width(self) -> int:
        """Cells of a full row."""
        return self.columns[-1].index + 1

    @property
    def row_numbers(self) -> IntArray:
        """Of each row in the file."""
        return np.array([line.number for line in self.rows], dtype=np.int64)


def has_table(grid: TextGrid) -> bool:
    """Whether some line names two or more known quantities, one of them measured, and rows of numbers follow."""
    return any(_measures(grid.lines[header]) for header in _with_rows(grid, _headers(grid)))


def find_table(grid: TextGrid) -> DataTable:
    """Split a grid into header, unit row and rows; every other line is metadata or a remark named in the notes."""
    grid = _with_listed_names(grid)
    headers = _headers(grid)
    tables = _with_rows(grid, headers)
    if not tables:
        raise _no_table(grid, headers)
    starts = [start for start in tables if _measures(grid.lines[start])] or tables
    columns, body = _columns(grid, starts[0])
    notes = [f"row {grid.lines[starts[0]].number} is the header"]
    if body > starts[0] + 1:
        notes.append(f"row {grid.lines[starts[0] + 1].number} holds the units")
    notes += [
        f"row {grid.lines[h].number} also names columns, but no numbers follow it"
        for h in headers
        if h not in tables
    ]
    notes += [
        f"row {grid.lines[t].number} begins a table that names no modulus and is not read"
        for t in tables
        if t not in starts
    ]
    for start, end in pairwise([*tables, len(grid.lines)]):
        if start not in starts:
            _check_left_aside(grid, start, end)
    rows: list[TextLine] = []
    blocks: list[int] = []
    between: list[str] = []
    ranges = [(start, end) for start, end in pairwise([*tables, len(grid.lines)]) if start in starts]
    for block, (start, end) in enumerate(ranges):
        here, body = _columns(grid, start)
        _check_same(grid, start, here, columns)
        lines = [line for line in grid.lines[body:end] if not line.comment]
        stop = len(lines)
        while end < len(grid.lines) and stop and not _is_row(lines[stop - 1], columns):
            stop -= 1
        rows += lines[:stop]
        blocks += [block] * stop
        between += [f"{lines[stop].number}-{lines[-1].number}"] if stop < len(lines) else []
    if between:
        notes.append(f"rows {', '.join(between)} stand between blocks and are not read")
    if len(starts) > 1:
        notes.append(f"{len(starts)} blocks with the same header are read one after the other")
    silent = [line.number for line in grid.lines[starts[0] :] if line.comment and _numbers(line) >= 2]
    if silent:
        notes.append(
            f"{len(silent)} row(s) of numbers are marked as remarks and not read, first row {silent[0]}"
        )
    said = {key: (value, row) for key, value, row in _metadata(grid, starts[0])}
    first = grid.lines[starts[0]].number
    return DataTable(grid, first, columns, tuple(rows), tuple(blocks), said, tuple(notes))


def _check_left_aside(grid: TextGrid, start: int, end: int) -> None:
    """Refuse to leave aside rows of more cells than the header above them: they are of another table."""
    width = len(grid.lines[start].cells)
    for line in filter(_is_data, grid.lines[start + 1 : end]):
        if len(line.cells) > width:
            what = f"more cells than row {grid.lines[start].number} has names, which begins a table without a modulus"
            raise grid.refusal(
                line.number, width, f"{what}; name every column, or remove that row if it is a remark"
            )


def without_rows(table: DataTable, exclude: str) -> DataTable:
    """The table without the rows that a person names by their number in the file, as 12-15,20; read or not."""
    if not _EXCLUDED.fullmatch(exclude):
        raise InputError(f'exclude = "{exclude}" (--exclude): expected rows such as 12-15,20')
    spans = [
        (int(low), int(high or low)) for low, _, high in (part.partition("-") for part in exclude.split(","))
    ]
    kept = [not any(low <= line.number <= high for low, high in spans) for line in table.rows]
    if all(kept) or not any(kept):
        what = "the table has no such rows" if all(kept) else "no row would be left"
        raise InputError(f'{table.grid.name}: exclude = "{exclude}" (--exclude): {what}')
    return replace(
        table,
        rows=tuple(compress(table.rows, kept)),
        blocks=tuple(compress(table.blocks, kept)),
        notes=(*table.notes, f"{kept.count(False)} row(s) excluded by hand: {exclude}"),
    )


def _with_listed_names(grid: TextGrid) -> TextGrid:
    """A grid with a header of the names that it lists above the numbers, a line each: "Sig2", "Temperature (°C)"."""
    first = next((position for position, line in enumerate(grid.lines) if _is_data(line)), 0)
    listed = {}
    for line in grid.lines[:first]:
        # blanks of a name may have been taken for the ends of cells, to come to as many as the rows have
        cells = line.cells if len(line.cells) == 2 else re.split(r"\s*[\t;,]\s*", line.text)
        if len(cells) == 2 and (match := _LISTED.fullmatch(cells[0])):
            listed[int(match[1])] = line.number, cells[1]
    if len(listed) < 2 or sorted(listed) != list(range(1, len(grid.lines[first].cells) + 1)):
        return grid
    names = tuple(listed[number][1] for number in sorted(listed))
    header = TextLine(listed[len(listed)][0], names, " ".join(names), comment=False)
    return replace(grid, lines=(*grid.lines[:first], header, *grid.lines[first:]))


def _numbers(line: TextLine) -> int:
    return sum(map(is_number, line.cells))


def _is_data(line: TextLine) -> bool:
    return not line.comment and _numbers(line) >= 2


def _is_row(line: TextLine, columns: Sequence[DataColumn]) -> bool:
    """Whether numbers stand in half of the known columns: titles and remarks between blocks may hold some, too."""
    known = [column.index for column in columns if column.meaning is not None]
    return 2 * sum(is_number(cell) for k, cell in enumerate(line.cells) if k in known) >= len(known)


def _headers(grid: TextGrid) -> list[int]:
    """Positions of the lines without a number that name two quantities and more."""
    headers = []
    for position, line in enumerate(grid.lines):
        if len(line.cells) >= 2 and not _numbers(line):
            quantities = {m.quantity for cell in line.cells if cell and (m := meaning(cell)) is not None}
            if len(quantities) >= 2:
                headers.append(position)
    return headers


def _with_rows(grid: TextGrid, headers: Sequence[int]) -> list[int]:
    """Those of the headers that rows of numbers follow, before the next."""
    ends = [*headers[1:], len(grid.lines)]
    return [a for a, b in zip(headers, ends, strict=False) if any(map(_is_data, grid.lines[a + 1 : b]))]


def _measures(header: TextLine) -> bool:
    """Whether a header names more than what is set in a test, and its clock."""
    named = {sense.quantity for cell in header.cells if cell and (sense := meaning(cell)) is not None}
    return not named <= {"frequency", "temperature", "strain", "time", "run"}


def _columns(grid: TextGrid, position: int) -> tuple[tuple[DataColumn, ...], int]:
    """Columns of the header at `position`, and where its rows begin: below the unit row, if there is one."""
    header = grid.lines[position]
    below = grid.lines[position + 1] if position + 1 < len(grid.lines) else None
    units: tuple[str, ...] = ()
    if below is not None and len(below.cells) >= 2 and not _numbers(below):
        known = [is_any_unit(cell) for cell in below.cells if cell]
        if all(known) if below.comment else any(known):
            units = below.cells
            if len(units) > len(header.cells):
                raise grid.refusal(
                    below.number,
                    len(header.cells),
                    f"the unit row has {len(units)} cells, the header row {header.number} names"
                    f" {len(header.cells)} columns; give each column one name and one unit",
                )
    columns = tuple(
        DataColumn(index, text, meaning(text) if text else None, unit or None)
        for index, (text, unit) in enumerate(zip_longest(header.cells, units))
    )
    return columns, position + 1 + bool(units)


def _check_same(grid: TextGrid, start: int, here: Sequence[DataColumn], first: Sequence[DataColumn]) -> None:
    for index, (now, then) in enumerate(zip_longest(here, first)):
        if now != then:
            what = (
                "a second table begins here with other names or units than the first; save each table in a file"
                " of its own"
            )
            raise grid.refusal(grid.lines[start].number, index, what, header=now.header if now else "")


def _metadata(grid: TextGrid, header: int) -> Iterator[tuple[str, str, int]]:
    """`key: value` (or `=`) of remark lines anywhere and of lines before the header, rows of two cells there; line."""
    for position, line in enumerate(grid.lines):
        if position == header or (position > header and not line.comment):
            continue
        key, mark, value = (*re.split("([:=])", line.text, maxsplit=1), "", "")[:3]
        if mark and value.strip() and "\t" not in key and ";" not in key:
            yield key.strip(), value.strip(" \t;,"), line.number
        elif not line.comment and len(line.cells) == 2 and not is_number(line.cells[0]):
            yield line.cells[0].rstrip(": "), line.cells[1], line.number


def _no_table(grid: TextGrid, headers: Sequence[int]) -> InputError:
    data = next((position for position, line in enumerate(grid.lines) if _is_data(line)), None)
    if data is None:
        row = grid.lines[headers[0] if headers else 0].number if grid.lines else 1
        what = "a header but no row of numbers below it" if headers else "no row of two or more numbers"
        return grid.refusal(row, 0, f"{what}; the file needs {EXAMPLE} and one row for each measurement")
    named = [line for line in grid.lines[:data] if len(line.cells) >= 2 and not _numbers(line)]
    if not named:
        return grid.refusal(grid.lines[data].number, 0, f"numbers without a header; put {EXAMPLE} above them")
    header = named[-1]
    if all(map(is_any_unit, filter(None, header.cells))) and len(named) > 1:
        header = named[-2]
    index = next((i for i, cell in enumerate(header.cells) if meaning(cell) is None), 0)
    what = f"the header names fewer than two known quantities; rename its columns as in {EXAMPLE}"
    return grid.refusal(header.number, index, what, header=header.cells[index])
