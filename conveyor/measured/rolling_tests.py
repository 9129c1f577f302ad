"""Tables of rolling-resistance tests, .csv or .xlsx: units in the headers, one row a test point."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.laboratory.grid import TextGrid, TextLine
from conveyor.measured.table import Meant, MeasuredRow, TableKind, grid_of, rows_of
from conveyor.models.rolling_tests import RollingTest
from conveyor.units import text

_TESTS: Final = TableKind(
    what="table of rolling-resistance tests",
    one="test",
    columns={
        "line load": Meant("line_load", "line force"), "resistance": Meant("resistance", "line force"),
        "indentation resistance": Meant("resistance", "line force"),
        "rolling resistance": Meant("resistance", "line force"),
        "roll diameter": Meant("roll_diameter", "length"), "drum diameter": Meant("roll_diameter", "length"),
        "cover thickness": Meant("cover_thickness", "length"), "cover": Meant("cover_thickness", "length"),
        "speed": Meant("speed", "speed"), "belt speed": Meant("speed", "speed"),
        "temperature": Meant("temperature", "temperature"), "uncertainty": Meant("uncertainty", "fraction"),
        "shared uncertainty": Meant("shared_uncertainty", "fraction"),
        "specimen": Meant("specimen", ""), "source": Meant("source", ""), "note": Meant("note", ""),
    },
    needed={
        "line_load": "line load [N/mm]", "resistance": "resistance [N/m]", "roll_diameter": "roll diameter [mm]",
        "cover_thickness": "cover thickness [mm]", "speed": "speed [m/s]", "temperature": "temperature [degC]",
    },
    example='"line load [N/mm],resistance [N/m],roll diameter [mm],cover thickness [mm],speed [m/s],'
    'temperature [degC]"',
)  # fmt: skip
FORM: Final = "N per width"
"""Sheet name of the test form for belt makers (`conveyor verify-sheet`)."""
_ASKED: Final = re.compile(r"at (\S+) (\S+), ours \[.+\]")
_OF_FORM: Final = {
    "cover": "cover thickness",
    "roll": "roll diameter",
    "belt speed": "speed",
    "temperature": "temperature",
}
"""Columns of the form and their names in a table of tests."""
_ONE_TEST: Final = (
    "roll_diameter", "cover_thickness", "speed", "temperature", "uncertainty", "shared_uncertainty", "specimen",
    "source", "note",
)  # fmt: skip


def read_rolling_tests(path: str | Path, source: str | None = None) -> tuple[RollingTest, ...]:
    """Read a table of rolling-resistance tests, as DIN 22123, AS 1334.13 or CEMA-7 laboratories deliver them.

    Parameters
    ----------
    path : str or Path
        Table with a header: ``line load``, ``resistance``, ``roll diameter``, ``cover thickness``, ``speed``,
        ``temperature``; further ``uncertainty`` (half-width that holds nine tenths of repeated tests), ``shared
        uncertainty`` (its part that all belts tested alike have in common), ``specimen`` (belt or rubber), ``source``,
        ``note``. Units are in the headers, as in ``line load [N/mm]``. Or the workbook
        of `conveyor.verify_sheet`, filled in by the maker.
    source : str, optional
        Of rows without one; the name of the file without it.

    Returns
    -------
    tuple of RollingTest
        One a roll, cover, speed and temperature, with all its line loads, in the order they first occur.

    Raises
    ------
    InputError
        ``file:row: column: what, and what to do``, for anything that is no number, unit or column known, or no test.
    """
    tests: dict[tuple[Any, ...], list[MeasuredRow]] = {}
    for row in _rows(path):
        _plausible(row)
        tests.setdefault(tuple(str(row.given.get(field)) for field in _ONE_TEST), []).append(row)
    return tuple(_test(rows, source or Path(path).name) for rows in tests.values())


def _rows(path: str | Path) -> Iterator[MeasuredRow]:
    """Rows of a table, or of a filled-in form: at every line load those with a figure of the maker."""
    grid = grid_of(path, _TESTS, form=FORM)
    start = next((k for k, line in enumerate(grid.lines) if line.cells[0] == "compound"), None)
    if grid.sheet != FORM or start is None:
        yield from rows_of(grid, _TESTS)
        return
    head, lines = grid.lines[start], grid.lines[start + 1 :]
    pairs = _pairs(grid, head)
    given = {at: [line for line in lines if any(line.cells[at : at + 1])] for at in pairs}
    belts: dict[str, int] = {}
    for line in lines:
        if any(line in filled for filled in given.values()):
            belts.setdefault(line.cells[0], line.number)
    if len(belts) != 1:
        what = f"figures of the maker beside {' and '.join(belts)}; keep those of one belt"
        what = what if belts else "no figure of the maker in it; fill in the columns named maker"
        raise grid.refusal(max(belts.values(), default=head.number), 0, what)
    columns = (name.partition(" [") for name in head.cells)
    common = [f"{_OF_FORM[name]} [{unit}" if name in _OF_FORM else "" for name, _, unit in columns]
    for at, (beside, asked) in pairs.items():
        names = [*common]
        names[beside] = f"line load [{asked[2]}]"
        names[at] = "resistance" + "".join(head.cells[at].partition(" [")[1:])
        rows = [
            line._replace(cells=(*line.cells[:beside], asked[1], *line.cells[beside + 1 :]))
            for line in given[at]
        ]
        if rows:
            yield from rows_of(replace(grid, lines=(head._replace(cells=tuple(names)), *rows)), _TESTS)


def _pairs(grid: TextGrid, head: TextLine) -> dict[int, tuple[int, re.Match[str]]]:
    """Columns of the maker, each with our column before it, which gives its line load."""
    pairs: dict[int, tuple[int, re.Match[str]]] = {}
    ours: tuple[int, re.Match[str]] | None = None
    for at, name in enumerate(head.cells):
        if asked := _ASKED.fullmatch(name):
            ours = at, asked
        elif name.startswith("maker"):
            if ours is None:
                what = "no column of ours before it says its line load; put it behind its own"
                raise grid.refusal(head.number, at, what, header=name)
            pairs[at], ours = ours, None
    return pairs


def _plausible(row: MeasuredRow) -> None:
    """Check one row as a test of its own, so that a wrong unit is reported at its row."""
    try:
        _test([row], "row")
    except InputError as error:
        raise row.refusal(str(error), "resistance" if "line load" in str(error) else None) from None


def _test(rows: list[MeasuredRow], source: str) -> RollingTest:
    given = {field: rows[0].given[field] for field in _ONE_TEST if field in rows[0].given}
    data = {name: value if isinstance(value, str) else text(value) for name, value in given.items()}
    lists = {field: [text(row.given[field]) for row in rows] for field in ("line_load", "resistance")}
    return RollingTest.from_data({"source": source} | data | lists)
