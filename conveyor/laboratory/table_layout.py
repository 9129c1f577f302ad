"""Locate the table in a grid: header, unit row, body; preamble, remarks and blocks around it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, zip_longest
from typing import Final

import numpy as np

from conveyor.errors import InputError
from conveyor.laboratory.cell_grid import AnswerableError, TextGrid, TextLine
from conveyor.laboratory.column_units import is_any_unit
from conveyor.laboratory.dma_data import IntArray
from conveyor.laboratory.header_meanings import Meaning, bare_name, header_meaning
from conveyor.laboratory.numbers import is_number

_ROW_RANGES: Final = re.compile(r"\d{1,9}(?:-\d{1,9})?(?:,\d{1,9}(?:-\d{1,9})?)*")
_LISTED_NAME: Final = re.compile(r"[A-Za-z]+ ?(\d{1,2})")
EXAMPLE_HEADER: Final = "a header row such as 'frequency_Hz,E'_MPa,E''_MPa'"
_SUPERPOSITION_TITLE: Final = re.compile(r"\btts\b|master\s*(?:curve|kurve)|masterkurve|superposition", re.IGNORECASE)
_TITLE_LINES: Final = 3
"""Lines above a header that may hold a title."""
_MOST_ROWS_NAMED: Final = 6
"""Most rows of one fault named one by one in a message."""


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

    def refusal_of_rows(self, faults: Sequence[tuple[DataColumn, str, int]]) -> InputError:
        """Error at rows, counted from 0, each with column and message; advises how to leave all out.

        If more than half of the rows are at fault, only the first is named, without that advice.
        """
        column, message, row = faults[0]
        rows = sorted({each for _, _, each in faults})
        if 2 * len(rows) > len(self.rows) > 1:
            return self.refusal(column, message, row)
        numbers = row_spans([self.rows[each].number for each in rows])
        first = str(self.refusal(column, f"{message}, or {exclude_advice(numbers)}", row))
        others = [(c, what, each) for c, what, each in faults if each != row]
        also = [str(self.refusal(c, what, each)).split(":", 1)[1] for c, what, each in others[: _MOST_ROWS_NAMED - 1]]
        more = f" and {len(others) - len(also)} more" if len(others) > len(also) else ""
        text = first + "".join(f"; likewise row {each}" for each in also) + more
        return AnswerableError(text, option="exclude", value=numbers)

    def label(self, column: DataColumn) -> str:
        """Label of a column in notes, as in `column 2 "E' (Pa)"`."""
        return str(self.refusal(column, "")).split(": ", 1)[1].removesuffix(":")

    @property
    def width(self) -> int:
        """Number of cells of a full row."""
        return self.columns[-1].index + 1

    @property
    def row_numbers(self) -> IntArray:
        """Number of each row in the file."""
        return np.array([line.number for line in self.rows], dtype=np.int64)


def exclude_advice(rows: str) -> str:
    """Advice on the option that leaves out rows, in Python and on the command line."""
    return f'leave {"it" if rows.isdigit() else "them"} out: exclude="{rows}" (--exclude {rows})'


def row_spans(numbers: Sequence[int]) -> str:
    """Ascending row numbers as ranges for --exclude.

    Examples
    --------
    >>> row_spans([4, 11, 12, 13, 20])
    '4,11-13,20'
    """
    ends = [k for k in range(len(numbers)) if k == len(numbers) - 1 or numbers[k + 1] != numbers[k] + 1]
    starts = [0, *(k + 1 for k in ends[:-1])]
    return ",".join(
        f"{numbers[a]}-{numbers[b]}" if b > a else f"{numbers[a]}" for a, b in zip(starts, ends, strict=True)
    )


def row_numbers(rows: str) -> set[int]:
    """Set of row numbers in 12-15,20."""
    parts = (part.partition("-") for part in rows.split(","))
    return {row for low, _, high in parts for row in range(int(low), int(high or low) + 1)}


def has_table(grid: TextGrid) -> bool:
    """True if a header names two or more known quantities, one of them measured, and rows of numbers follow."""
    return any(_names_measurement(grid.lines[header]) for header in _headers_with_rows(grid, _header_positions(grid)))


def find_table(grid: TextGrid) -> DataTable:
    """Split a grid into header, unit row and rows; every other line is metadata or a remark named in the notes."""
    grid = _with_listed_names(grid)
    headers = _header_positions(grid)
    tables = _headers_with_rows(grid, headers)
    if not tables:
        raise _no_table_error(grid, headers)
    starts = [start for start in tables if _names_measurement(grid.lines[start])] or tables
    columns, body = _header_columns(grid, starts[0])
    notes = [f"row {grid.lines[starts[0]].number} is the header"]
    made = [start for start in starts[1:] if _is_superposed_table(grid, start, columns)]
    starts = [start for start in starts if start not in made]
    notes += [
        f"row {grid.lines[start].number} begins a table that the instrument made of the steps (time-temperature"
        " superposition); it is not read, save it in a file of its own to use it"
        for start in made
    ]
    if body > starts[0] + 1:
        notes.append(f"row {grid.lines[starts[0] + 1].number} holds the units")
    notes += [
        f"row {grid.lines[h].number} also names columns, but no numbers follow it" for h in headers if h not in tables
    ]
    notes += [
        f"row {grid.lines[t].number} begins a table that names no modulus and is not read"
        for t in tables
        if t not in starts and t not in made
    ]
    for start, end in pairwise([*tables, len(grid.lines)]):
        if start not in starts:
            _check_unread_table(grid, start, end)
    rows: list[TextLine] = []
    blocks: list[int] = []
    between: list[str] = []
    ranges = [(start, end) for start, end in pairwise([*tables, len(grid.lines)]) if start in starts]
    for block, (start, end) in enumerate(ranges):
        here, body = _header_columns(grid, start)
        _check_same_columns(grid, (start, end), here, columns)
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
    silent = [line.number for line in grid.lines[starts[0] :] if line.comment and _number_count(line) >= 2]
    if silent:
        notes.append(f"{len(silent)} row(s) of numbers are marked as remarks and not read, first row {silent[0]}")
    said = {key: (value, row) for key, value, row in _metadata_lines(grid, starts[0])}
    first = grid.lines[starts[0]].number
    return DataTable(grid, first, columns, tuple(rows), tuple(blocks), said, tuple(notes))


def _check_unread_table(grid: TextGrid, start: int, end: int) -> None:
    """Refuse unread rows with more cells than the header above them: they are of another table."""
    width = len(grid.lines[start].cells)
    for line in filter(_is_data, grid.lines[start + 1 : end]):
        if len(line.cells) > width:
            what = f"more cells than row {grid.lines[start].number} has names, which begins a table without a modulus"
            raise grid.refusal(line.number, width, f"{what}; name every column, or remove that row if it is a remark")


def without_rows(grid: TextGrid, exclude: str) -> TextGrid:
    """Grid without rows given by their number in the file, as 12-15,20."""
    if not _ROW_RANGES.fullmatch(exclude):
        raise InputError(f'exclude = "{exclude}" (--exclude): expected rows such as 12-15,20')
    ranges = [(int(low), int(high or low)) for low, _, high in (part.partition("-") for part in exclude.split(","))]
    lines = tuple(line for line in grid.lines if not any(low <= line.number <= high for low, high in ranges))
    if len(lines) == len(grid.lines) or not any(map(_is_data, lines)):
        what = "the table has no such rows" if len(lines) == len(grid.lines) else "no row would be left"
        raise InputError(f'{grid.name}: exclude = "{exclude}" (--exclude): {what}')
    return replace(
        grid,
        lines=lines,
        notes=(*grid.notes, f"{len(grid.lines) - len(lines)} row(s) excluded by hand: {exclude}"),
    )


def without_columns(table: DataTable, ignore: Sequence[str]) -> DataTable:
    """Table without the meaning of columns given by header, number or letter."""
    columns = list(table.columns)
    for name in ignore:
        known = [
            k
            for k, column in enumerate(columns)
            if column.header
            and _comparable_name(name) in {_comparable_name(column.header), _comparable_name(bare_name(column.header))}
        ] or [k for k, column in enumerate(columns) if name.strip().upper() == table.grid.column(column.index)]
        if not known:
            names = ", ".join(column.header for column in columns if column.header)
            raise table.refusal(columns[0], f'ignore = "{name}" (--ignore): no such column; there are: {names}')
        for k in known:
            columns[k] = replace(columns[k], meaning=None)
    notes = tuple(f"column left aside as asked: {name}" for name in ignore)
    return replace(table, columns=tuple(columns), notes=(*table.notes, *notes))


def with_column_names(grid: TextGrid, columns: Mapping[str, str]) -> TextGrid:
    """Grid with column names replaced by the given ones."""
    lines, notes = list(grid.lines), []
    for name, given in columns.items():
        if header_meaning(given) is None:
            raise InputError(
                f'{grid.name}: columns: "{name}={given}" (--column): "{given}" is no name of a column known here; write'
                " one such as E' [MPa], storage, loss, tan_delta, phase [deg], frequency [Hz], temperature [degC],"
                " strain [%]"
            )
        found = False
        for k, line in enumerate(lines):
            cells = line.cells
            if len(cells) < 2 or _number_count(line):
                continue
            named = tuple(
                _with_unit_of(cell, given)
                if cell and _comparable_name(name) in {_comparable_name(cell), _comparable_name(bare_name(cell))}
                else cell
                for cell in cells
            )
            if named != cells:
                lines[k], found = line._replace(cells=named), True
        if not found:
            raise InputError(f'{grid.name}: columns: "{name}={given}" (--column): no column has the name "{name}"')
        notes.append(f'"{name}" is {given} as given')
    return replace(grid, lines=tuple(lines), notes=(*grid.notes, *notes))


def names_column(grid: TextGrid, name: str) -> bool:
    """True if a line of names holds this name, or a column of this number or letter."""
    for line in grid.lines:
        if len(line.cells) >= 2 and not _number_count(line):
            if any(
                _comparable_name(name) in {_comparable_name(cell), _comparable_name(bare_name(cell))}
                for cell in line.cells
                if cell
            ):
                return True
            if name.strip().upper() in {grid.column(k) for k in range(len(line.cells))}:
                return True
    return False


def _comparable_name(name: str) -> str:
    """Name for comparison, in lower case without blanks."""
    return re.sub(r"\s+", "", name).lower()


def _with_unit_of(cell: str, given: str) -> str:
    """Given name with the unit of the cell it replaces, if it has none."""
    sense, unit = header_meaning(given), cell.removeprefix(bare_name(cell)).strip()
    return f"{given} {unit}" if sense is not None and sense.unit is None and unit else given


def _with_listed_names(grid: TextGrid) -> TextGrid:
    """Grid with a header made of names listed above the numbers, a line each: "Sig2", "Temperature (°C)"."""
    first = next((position for position, line in enumerate(grid.lines) if _is_data(line)), 0)
    listed = {}
    for line in grid.lines[:first]:
        # blanks of a name may have been split into cells, to match the width of the rows
        cells = line.cells if len(line.cells) == 2 else re.split(r"\s*[\t;,]\s*", line.text)
        if len(cells) == 2 and (match := _LISTED_NAME.fullmatch(cells[0])):
            listed[int(match[1])] = line.number, cells[1]
    if len(listed) < 2 or sorted(listed) != list(range(1, len(grid.lines[first].cells) + 1)):
        return grid
    names = tuple(listed[number][1] for number in sorted(listed))
    header = TextLine(listed[len(listed)][0], names, " ".join(names), comment=False)
    return replace(grid, lines=(*grid.lines[:first], header, *grid.lines[first:]))


def _number_count(line: TextLine) -> int:
    return sum(map(is_number, line.cells))


def _is_data(line: TextLine) -> bool:
    return not line.comment and _number_count(line) >= 2


def _is_row(line: TextLine, columns: Sequence[DataColumn]) -> bool:
    """True if half of the known columns hold numbers: titles and remarks between blocks may hold some, too."""
    known = [column.index for column in columns if column.meaning is not None]
    return 2 * sum(is_number(cell) for k, cell in enumerate(line.cells) if k in known) >= len(known)


def _header_positions(grid: TextGrid) -> list[int]:
    """Positions of the lines without a number that name two quantities and more."""
    headers = []
    for position, line in enumerate(grid.lines):
        if len(line.cells) >= 2 and not _number_count(line):
            quantities = {m.quantity for cell in line.cells if cell and (m := header_meaning(cell)) is not None}
            if len(quantities) >= 2:
                headers.append(position)
    return headers


def _headers_with_rows(grid: TextGrid, headers: Sequence[int]) -> list[int]:
    """Headers followed by rows of numbers before the next."""
    ends = [*headers[1:], len(grid.lines)]
    return [a for a, b in zip(headers, ends, strict=False) if any(map(_is_data, grid.lines[a + 1 : b]))]


def _names_measurement(header: TextLine) -> bool:
    """True if a header names a measured quantity: more than set points and time."""
    named = {sense.quantity for cell in header.cells if cell and (sense := header_meaning(cell)) is not None}
    return not named <= {"frequency", "temperature", "strain", "time", "run"}


def _header_columns(grid: TextGrid, position: int) -> tuple[tuple[DataColumn, ...], int]:
    """Columns of the header at `position`, and the position of its first row, below any unit row."""
    header = grid.lines[position]
    below = grid.lines[position + 1] if position + 1 < len(grid.lines) else None
    units: tuple[str, ...] = ()
    if below is not None and len(below.cells) >= 2 and not _number_count(below):
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
        DataColumn(index, text, header_meaning(text) if text else None, unit or None)
        for index, (text, unit) in enumerate(zip_longest(header.cells, units))
    )
    return columns, position + 1 + bool(units)


def _is_superposed_table(grid: TextGrid, start: int, steps: Sequence[DataColumn]) -> bool:
    """True if a table below isotherms holds their shift factors or master curve, by its names and title."""
    first = {column.meaning.quantity for column in steps if column.meaning is not None}
    here = {m.quantity for cell in grid.lines[start].cells if cell and (m := header_meaning(cell)) is not None}
    if not {"frequency", "temperature"} <= first or not first & {"storage", "loss", "complex"}:
        return False
    if "a_T" in here and not here & {"storage", "loss", "complex"}:
        return True
    title = " ".join(line.text for line in grid.lines[max(0, start - _TITLE_LINES) : start] if not _is_data(line))
    return "temperature" not in here and _SUPERPOSITION_TITLE.search(title) is not None


def _check_same_columns(
    grid: TextGrid, block: tuple[int, int], here: Sequence[DataColumn], first: Sequence[DataColumn]
) -> None:
    for index, (now, then) in enumerate(zip_longest(here, first)):
        if now != then:
            start, end = block
            lines = [line.number for line in grid.lines[start:end] if not line.comment]
            rows = row_spans(lines)
            what = (
                "a second table begins here with other names or units than the first; save each table in a file"
                f" of its own, or {exclude_advice(rows)}"
            )
            refused = grid.refusal(grid.lines[start].number, index, what, header=now.header if now else "")
            raise AnswerableError(str(refused), option="exclude", value=rows)


def _metadata_lines(grid: TextGrid, header: int) -> Iterator[tuple[str, str, int]]:
    """`key: value` (or `=`) of remarks anywhere and of lines before the header, of two cells (and a unit); line."""
    for position, line in enumerate(grid.lines):
        if position == header or (position > header and not line.comment):
            continue
        key, mark, value = (*re.split("([:=])", line.text, maxsplit=1), "", "")[:3]
        if mark and value.strip() and "\t" not in key and ";" not in key:
            yield key.strip(), value.strip(" \t;,"), line.number
        elif not line.comment and len(line.cells) == 2 and not is_number(line.cells[0]):
            yield line.cells[0].rstrip(": "), line.cells[1], line.number
        elif not line.comment and len(line.cells) == 3 and is_number(line.cells[1]) and is_any_unit(line.cells[2]):
            yield line.cells[0].rstrip(": "), f"{line.cells[1]} {line.cells[2]}", line.number


def _no_table_error(grid: TextGrid, headers: Sequence[int]) -> InputError:
    data = next((position for position, line in enumerate(grid.lines) if _is_data(line)), None)
    if data is None:
        row = grid.lines[headers[0] if headers else 0].number if grid.lines else 1
        what = "a header but no row of numbers below it" if headers else "no row of two or more numbers"
        return grid.refusal(row, 0, f"{what}; the file needs {EXAMPLE_HEADER} and one row for each measurement")
    named = [line for line in grid.lines[:data] if len(line.cells) >= 2 and not _number_count(line)]
    if not named:
        return grid.refusal(grid.lines[data].number, 0, f"numbers without a header; put {EXAMPLE_HEADER} above them")
    header = named[-1]
    if all(map(is_any_unit, filter(None, header.cells))) and len(named) > 1:
        header = named[-2]
    index = next((i for i, cell in enumerate(header.cells) if header_meaning(cell) is None), 0)
    what = f"the header names fewer than two known quantities; rename its columns as in {EXAMPLE_HEADER}"
    return grid.refusal(header.number, index, what, header=header.cells[index])
