"""Tables of measured runs, .csv or .xlsx: units in the headers, one row a run; what is doubtful is refused."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.files.content import file_content
from conveyor.laboratory.cells import TextGrid, TextLine
from conveyor.laboratory.decimals import decimal_mark, is_number, why_not_a_number
from conveyor.laboratory.encoding import decoded
from conveyor.laboratory.workbook import MAGIC, workbook_grids
from conveyor.models import MeasuredRun
from conveyor.units import quantity

LARGEST_FILE: Final = 10_000_000
"""Bytes; a year of hourly means has a tenth."""
MOST_RUNS: Final = 1000
"""Rows; means over a minute or more say as much as their thousands of samples."""

_COLUMNS: Final = {
    "motor power": ("power", "power"), "mains power": ("power", "power"),
    "flow": ("flow", "mass flow"), "mass flow": ("flow", "mass flow"),
    "speed": ("speed", "speed"), "belt speed": ("speed", "speed"),
    "temperature": ("temperature", "temperature"), "belt temperature": ("temperature", "temperature"),
    "air temperature": ("air_temperature", "temperature"),
    "standard deviation": ("deviation", "power"), "note": ("note", ""),
}  # fmt: skip
"""Headers: the field of a run, its kind of quantity."""
_PLACES: Final = {"motor power": "motor shaft", "mains power": "mains"}
_HEADER: Final = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
_EXAMPLE: Final = '"motor power [kW],flow [t/h],temperature [degC]"'


class _Head:
    """A column: its index, its name, field and kind, its unit."""

    def __init__(self, index: int, header: str) -> None:
        match = _HEADER.fullmatch(header)
        self.index, self.header = index, header
        self.name = "" if match is None else " ".join(match[1].lower().replace("_", " ").split())
        self.unit = "" if match is None or match[2] is None else match[2]
        if self.name.startswith("note"):
            self.name = "note"
        self.field, self.kind = _COLUMNS.get(self.name, ("", ""))


def read_runs(path: str | Path) -> tuple[MeasuredRun, ...]:
    """Read measured runs.

    Parameters
    ----------
    path : str or Path
        Table with a header: ``motor power`` or ``mains power`` (or both, one of them filled in each row) and ``flow``;
        further ``speed``, ``temperature``, ``air temperature``, ``standard deviation``, ``note``. Units stand in the
        headers, as in ``flow [t/h]``; the standard deviation is a power or a percentage of the row's.

    Returns
    -------
    tuple of MeasuredRun
        In their order.

    Raises
    ------
    InputError
        ``file:row: column: what, and what to do``, for anything that is no number, unit or column known.
    """
    grid = _grid(Path(path))
    lines = [line for line in grid.lines if not line.comment]
    if len(lines) < 2:
        raise InputError(
            f"{path}: no run in it; the first line names columns, as {_EXAMPLE}, one row a run follows"
        )
    head, *rows = lines
    if len(rows) > MOST_RUNS:
        raise InputError(
            f"{path}: {len(rows)} rows, at most {MOST_RUNS} are read; give means over longer times"
        )
    columns = _columns(grid, head)
    mark = _mark(grid, columns, rows)
    return tuple(_run(grid, columns, row, len(head.cells), mark) for row in rows)


def _grid(path: Path) -> TextGrid:
    """The lines of a text, or of the one sheet that holds cells."""
    data = file_content(path, largest=LARGEST_FILE, expected="table of measured runs")
    if data.startswith(MAGIC):
        filled = [grid for grid in workbook_grids(data, path.name) if grid.lines]
        if len(filled) != 1:
            raise InputError(
                f"{path}: {len(filled)} sheets hold cells; keep the runs on one, and save it alone"
            )
        return filled[0]
    text, _ = decoded(data, path.name)
    written = [(n, line) for n, line in enumerate(text.splitlines(), start=1) if line.strip()]
    first = next((line for _, line in written if not line.lstrip().startswith("#")), "")
    separator = max("\t;,", key=first.count)
    lines = []
    for number, line in written:
        (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
        comment = line.lstrip().startswith("#")
        lines.append(TextLine(number, tuple(cell.strip() for cell in cells), line.strip(), comment))
    return TextGrid(path.name, tuple(lines), ())


def _columns(grid: TextGrid, head: TextLine) -> list[_Head]:
    """The named columns, each known and there once."""
    found: dict[str, _Head] = {}
    for index, header in enumerate(head.cells):
        column = _Head(index, header)
        if not column.field:
            if header:
                raise grid.refusal(
                    head.number, index, f"not known; allowed: {', '.join(_COLUMNS)}, with a unit as in {_EXAMPLE}; "
                    'begin the name with "note" to have it left alone', header=header,
                )  # fmt: skip
            continue
        if column.field == "note":
            found.setdefault("note", column)
            continue
        if any(column.field == other.field and other.name not in _PLACES for other in found.values()):
            raise grid.refusal(head.number, index, "is there twice; remove one of the two", header=header)
        found[column.name] = column
    missing = [] if _PLACES.keys() & found else ["motor power [kW] or mains power [kW]"]
    missing += (
        [] if any(column.field == "flow" for column in found.values()) else ["flow [t/h], 0 where empty"]
    )
    if missing:
        raise grid.refusal(
            head.number, 0, f"no column {' and none '.join(missing)}; name it as in {_EXAMPLE}"
        )
    # a deviation after the power that it may be a share of
    return sorted(found.values(), key=lambda column: column.field == "deviation")


def _cells(row: TextLine, columns: list[_Head]) -> Iterator[tuple[_Head, str]]:
    for column in columns:
        cell = row.cells[column.index] if column.index < len(row.cells) else ""
        if cell:
            yield column, cell


def _mark(grid: TextGrid, columns: list[_Head], rows: list[TextLine]) -> str:
    """Decimal mark of all numbers together."""
    numbers = [
        (row, *each) for row in rows for each in _cells(row, columns) if each[0].unit and is_number(each[1])
    ]
    mark, doubtful = decimal_mark(cell for *_, cell in numbers)
    if doubtful is not None:
        row, column = next((row, column) for row, column, cell in numbers if cell == doubtful)
        raise grid.refusal(
            row.number, column.index, f"'{doubtful}' may have a decimal comma or one between thousands; write decimal "
            "points and nothing between thousands", header=column.header,
        )  # fmt: skip
    return mark


def _run(grid: TextGrid, columns: list[_Head], row: TextLine, width: int, mark: str) -> MeasuredRun:
    extra = next((i for i, cell in enumerate(row.cells) if cell and i >= width), None)
    if extra is not None:
        raise grid.refusal(row.number, extra, "a cell beyond the last header; name its column or remove it")
    given: dict[str, Any] = {}
    for column, cell in _cells(row, columns):
        if column.field == "note":
            given["note"] = cell
            continue
        if column.name in _PLACES:
            if "at" in given:
                raise grid.refusal(row.number, column.index, "the row has a power at the motor and at the mains; leave "
                                   "one of the two empty", header=column.header)  # fmt: skip
            given["at"] = _PLACES[column.name]
        try:
            given[column.field] = _value(column, cell, mark, given)
        except InputError as error:
            raise grid.refusal(row.number, column.index, str(error), header=column.header) from None
    for field, wanted in (("power", "the power"), ("flow", "the flow, 0 where empty,")):
        if field not in given:
            index = next(column.index for column in columns if column.field == field)
            raise grid.refusal(row.number, index, f"{wanted} is missing; complete or delete the row")
    try:
        return MeasuredRun.from_data(given)
    except InputError as error:
        raise InputError(f"{grid.name}:{row.number}: {error}") from None


def _value(column: _Head, cell: str, mark: str, given: Mapping[str, Any]) -> Any:
    """A cell in the unit of its header, or in its own."""
    if not column.unit:
        return quantity(cell, column.kind)
    if not is_number(cell):
        raise InputError(why_not_a_number(cell))
    number = cell.replace(",", ".") if mark == "," else cell
    if column.field == "deviation" and column.unit == "%":
        if "power" not in given:
            raise InputError("a percentage of a power that is missing in the row")
        return abs(given["power"]) * (float(number) / 100.0)
    return quantity(f"{number} {column.unit}", column.kind)
