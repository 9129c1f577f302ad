"""Where the table is in a grid: header, unit row, body; preamble, remarks and blocks around it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from conveyor.laboratory.cells import TextGrid, TextLine
from conveyor.laboratory.decimals import is_number
from conveyor.laboratory.factors import is_any_unit
from conveyor.laboratory.names import Meaning, meaning

EXAMPLE = "a header row such as 'frequency_Hz,storage_MPa,loss_MPa'"


@dataclass(frozen=True)
class DataColumn:
    """One column of the file, by the text of its header and of the unit row."""

    index: int
    header: str
    meaning: Meaning | None
    unit: str | None


@dataclass(frozen=True)
class DataTable:
    """Header and rows of the one table of a grid."""

    grid: TextGrid
    header_row: int
    columns: tuple[DataColumn, ...]
    rows: tuple[TextLine, ...]
    blocks: tuple[int, ...]
    metadata: dict[str, str]
    metadata_rows: dict[str, int]
    notes: tuple[str, ...]


def has_table(grid: TextGrid) -> bool:
    """Whether some line names two or more known quantities and rows of numbers follow.

    Parameters
    ----------
    grid : Grid
        One sheet or text [-].

    Returns
    -------
    bool
        True if `find_table` has something to read [-].
    """
    headers = _headers(grid)
    return bool(headers) and any(_is_data(line) for line in grid.lines[headers[0] + 1 :])


def find_table(grid: TextGrid) -> DataTable:
    """Split a grid into header, unit row and rows.

    Parameters
    ----------
    grid : Grid
        One sheet or text [-].

    Returns
    -------
    Table
        Every line is either a row, a header, a unit row, metadata or a remark named in the notes [-].

    Raises
    ------
    InputError
        If no header is found, a header repeats with other columns, or a line after it is neither a row of
        numbers nor a remark.
    """
    headers = _headers(grid)
    starts = [
        start
        for start, end in pairwise([*headers, len(grid.lines)])
        if any(_is_data(line) for line in grid.lines[start + 1 : end])
    ]
    if not starts:
        raise _no_table(grid, headers)
    first = grid.lines[starts[0]]
    columns, unit_line = _columns(grid, starts[0])
    rows: list[TextLine] = []
    blocks: list[int] = []
    notes = [f"row {first.number} is the header"]
    if unit_line is not None:
        notes.append(f"row {grid.lines[unit_line].number} holds the units")
    notes += [
        f"row {grid.lines[h].number} also names columns, but no numbers follow it"
        for h in headers
        if h not in starts
    ]
    for block, (start, end) in enumerate(pairwise([*starts, len(grid.lines)])):
        _same_columns(grid, start, columns)
        _, units = _columns(grid, start)
        last_block = end == len(grid.lines)
        body, skipped = _body(grid, (units if units is not None else start) + 1, end, last_block=last_block)
        rows += body
        blocks += [block] * len(body)
        if skipped:
            notes.append(
                f"rows {skipped[0].number} to {skipped[-1].number}, between two blocks, are not read"
            )
    if len(starts) > 1:
        notes.append(f"{len(starts)} blocks with the same header are read one after the other")
    silent = [
        line.number
        for line in grid.lines[starts[0] :]
        if line.comment and sum(map(is_number, line.cells)) >= 2
    ]
    if silent:
        notes.append(
            f"{len(silent)} row(s) of numbers are marked as remarks and not read, first row {silent[0]}"
        )
    said = list(_metadata(grid, starts[0]))
    return DataTable(
        grid,
        first.number,
        columns,
        tuple(rows),
        tuple(blocks),
        {key: value for key, value, _ in said},
        {key: row for key, _, row in said},
        tuple(notes),
    )


def _headers(grid: TextGrid) -> list[int]:
    found = []
    for position, line in enumerate(grid.lines):
        if len(line.cells) < 2 or _is_data(line) or any(map(is_number, line.cells)):
            continue
        quantities = {m.quantity for cell in line.cells if cell and (m := meaning(cell)) is not None}
        if len(quantities) >= 2:
            found.append(position)
    return found


def _is_data(line: TextLine) -> bool:
    return not line.comment and bool(line.cells) and sum(map(is_number, line.cells)) >= 2


def _columns(grid: TextGrid, position: int) -> tuple[tuple[DataColumn, ...], int | None]:
    """Columns of the header at `position`, and the position of its unit row if there is one."""
    header = grid.lines[position]
    names = header.cells
    units: tuple[str, ...] = ()
    where = None
    if position + 1 < len(grid.lines):
        below = grid.lines[position + 1]
        words = [cell for cell in below.cells if cell]
        text_row = len(below.cells) >= 2 and not any(map(is_number, below.cells))
        if text_row and (
            any(map(is_any_unit, words)) and (not below.comment or all(map(is_any_unit, words)))
        ):
            units, where = below.cells, position + 1
    if len(units) > len(names):
        raise grid.refusal(
            grid.lines[position + 1].number,
            len(names),
            f"the unit row has {len(units)} cells, the header row {header.number} names {len(names)} columns;"
            " give each column one name and one unit",
        )
    columns = tuple(
        DataColumn(
            index,
            text,
            meaning(text) if text else None,
            (units[index] or None) if index < len(units) else None,
        )
        for index, text in enumerate(names)
    )
    return columns, where


def _same_columns(grid: TextGrid, start: int, columns: tuple[DataColumn, ...]) -> None:
    here, _ = _columns(grid, start)
    for index in range(max(len(here), len(columns))):
        now = here[index] if index < len(here) else None
        then = columns[index] if index < len(columns) else None
        if now != then:
            raise grid.refusal(
                grid.lines[start].number,
                index,
                "a second table begins here with other names or units than the first; save each table in a file"
                " of its own",
                header=now.header if now else "",
            )


def _body(grid: TextGrid, start: int, end: int, *, last_block: bool) -> tuple[list[TextLine], list[TextLine]]:
    """Rows between two positions, and the words before the next block."""
    lines = [line for line in grid.lines[start:end] if not line.comment]
    stop = len(lines)
    if not last_block:
        while stop and not any(map(is_number, lines[stop - 1].cells)):
            stop -= 1
    return lines[:stop], lines[stop:]


def _metadata(grid: TextGrid, header: int) -> Iterator[tuple[str, str, int]]:
    """`key: value` (or `=`) of remark lines anywhere and of lines before the header, rows of two cells there; line."""
    for position, line in enumerate(grid.lines):
        if not line.comment and position >= header:
            continue
        if position == header:
            continue
        key, mark, value = (*re.split("([:=])", line.text, maxsplit=1), "", "")[:3]
        if mark and value.strip() and "\t" not in key and ";" not in key:
            yield key.strip(), value.strip(" \t;,"), line.number
        elif not line.comment and len(line.cells) == 2 and not is_number(line.cells[0]):
            yield line.cells[0].rstrip(": "), line.cells[1], line.number


def _no_table(grid: TextGrid, headers: Sequence[int]) -> Exception:
    data = next((position for position, line in enumerate(grid.lines) if _is_data(line)), None)
    if data is None:
        row = grid.lines[headers[0]].number if headers else (grid.lines[0].number if grid.lines else 1)
        what = "a header but no row of numbers below it" if headers else "no row of two or more numbers"
        return grid.refusal(row, 0, f"{what}; the file needs {EXAMPLE} and one row for each measurement")
    words = [line for line in grid.lines[:data] if not any(map(is_number, line.cells))]
    named = [line for line in words if len(line.cells) >= 2]
    if not named:
        line = grid.lines[data]
        return grid.refusal(line.number, 0, f"numbers without a header; put {EXAMPLE} above them")
    header = named[-1]
    if all(map(is_any_unit, filter(None, header.cells))) and len(named) > 1:
        header = named[-2]
    index = next((i for i, cell in enumerate(header.cells) if meaning(cell) is None), 0)
    return grid.refusal(
        header.number,
        index,
        f"the header names fewer than two known quantities; rename its columns as in {EXAMPLE}",
        header=header.cells[index],
    )
