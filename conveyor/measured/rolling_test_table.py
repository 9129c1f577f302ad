"""Tables of rolling-resistance tests, .csv or .xlsx: units in the headers, one row a test point."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.laboratory.cell_grid import TextGrid, TextLine
from conveyor.languages.original_text import every_translation, original_header
from conveyor.measured.measurement_table import (
    ColumnMeaning,
    MeasuredRow,
    TableKind,
    measured_rows,
    read_grid,
)
from conveyor.models.rolling_tests import RollingTest
from conveyor.units import text

_TEST_TABLE: Final = TableKind(
    what="table of rolling-resistance tests",
    one="test",
    columns={
        "line load": ColumnMeaning("line_load", "line force"), "resistance": ColumnMeaning("resistance", "line force"),
        "indentation resistance": ColumnMeaning("resistance", "line force"),
        "rolling resistance": ColumnMeaning("resistance", "line force"),
        "roll diameter": ColumnMeaning("roll_diameter", "length"),
        "drum diameter": ColumnMeaning("roll_diameter", "length"),
        "cover thickness": ColumnMeaning("cover_thickness", "length"),
        "cover": ColumnMeaning("cover_thickness", "length"),
        "speed": ColumnMeaning("speed", "speed"), "belt speed": ColumnMeaning("speed", "speed"),
        "temperature": ColumnMeaning("temperature", "temperature"),
        "uncertainty": ColumnMeaning("uncertainty", "fraction"),
        "shared uncertainty": ColumnMeaning("shared_uncertainty", "fraction"),
        "specimen": ColumnMeaning("specimen", ""), "source": ColumnMeaning("source", ""),
        "note": ColumnMeaning("note", ""),
    },
    needed={
        "line_load": "line load [N/mm]", "resistance": "resistance [N/m]", "roll_diameter": "roll diameter [mm]",
        "cover_thickness": "cover thickness [mm]", "speed": "speed [m/s]", "temperature": "temperature [degC]",
    },
    example='"line load [N/mm],resistance [N/m],roll diameter [mm],cover thickness [mm],speed [m/s],'
    'temperature [degC]"',
)  # fmt: skip
FORM_SHEET: Final = "N per width"
"""Sheet name of the test form for belt makers (`conveyor verify-sheet`)."""
_LOAD_HEADER: Final = re.compile(r"at (\S+) (\S+), ours \[.+\]")
_FORM_COLUMNS: Final = {
    "cover": "cover thickness",
    "roll": "roll diameter",
    "belt speed": "speed",
    "temperature": "temperature",
}
"""Columns of the form and their names in a table of tests."""
_FORM_HEADERS: Final = ("compound", *_FORM_COLUMNS, "maker", "at {}, ours")
"""Headers of the form, which comes in any language."""
_TEST_FIELDS: Final = (
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
    for row in _test_rows(path):
        _check_row(row)
        tests.setdefault(tuple(str(row.given.get(field)) for field in _TEST_FIELDS), []).append(row)
    return tuple(_rolling_test(rows, source or Path(path).name) for rows in tests.values())


def _test_rows(path: str | Path) -> Iterator[MeasuredRow]:
    """Rows of a table, or of a filled-in form: at every line load those with a figure of the maker."""
    titles = every_translation(FORM_SHEET)
    grid = read_grid(path, _TEST_TABLE, form=titles)
    first = every_translation("compound")
    start = next((k for k, line in enumerate(grid.lines) if line.cells[0] in first), None)
    if grid.sheet not in titles or start is None:
        yield from measured_rows(grid, _TEST_TABLE)
        return
    head, lines = grid.lines[start], grid.lines[start + 1 :]
    head = head._replace(cells=tuple(original_header(name, _FORM_HEADERS) for name in head.cells))
    pairs = _maker_columns(grid, head)
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
    common = [f"{_FORM_COLUMNS[name]} [{unit}" if name in _FORM_COLUMNS else "" for name, _, unit in columns]
    for at, (beside, asked) in pairs.items():
        names = [*common]
        names[beside] = f"line load [{asked[2]}]"
        names[at] = "resistance" + "".join(head.cells[at].partition(" [")[1:])
        rows = [line._replace(cells=(*line.cells[:beside], asked[1], *line.cells[beside + 1 :])) for line in given[at]]
        if rows:
            yield from measured_rows(replace(grid, lines=(head._replace(cells=tuple(names)), *rows)), _TEST_TABLE)


def _maker_columns(grid: TextGrid, head: TextLine) -> dict[int, tuple[int, re.Match[str]]]:
    """Columns of the maker, each with our column before it, which gives its line load."""
    pairs: dict[int, tuple[int, re.Match[str]]] = {}
    ours: tuple[int, re.Match[str]] | None = None
    for at, name in enumerate(head.cells):
        if asked := _LOAD_HEADER.fullmatch(name):
            ours = at, asked
        elif name.startswith("maker"):
            if ours is None:
                what = "no column of ours before it says its line load; put it behind its own"
                raise grid.refusal(head.number, at, what, header=name)
            pairs[at], ours = ours, None
    return pairs


def _check_row(row: MeasuredRow) -> None:
    """Check one row as a test of its own, so that a wrong unit is reported at its row."""
    try:
        _rolling_test([row], "row")
    except InputError as error:
        raise row.refusal(str(error), "resistance" if "line load" in str(error) else None) from None


def _rolling_test(rows: list[MeasuredRow], source: str) -> RollingTest:
    given = {field: rows[0].given[field] for field in _TEST_FIELDS if field in rows[0].given}
    data = {name: value if isinstance(value, str) else text(value) for name, value in given.items()}
    lists = {field: [text(row.given[field]) for row in rows] for field in ("line_load", "resistance")}
    return RollingTest.from_data({"source": source} | data | lists)
