"""Columns of a table to numbers in SI: which is used, in which unit, and what has to be asked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from conveyor.errors import InputError
from conveyor.laboratory.body import check_finite, check_width, column_cells, run_labels, table_mark
from conveyor.laboratory.cells import TextGrid
from conveyor.laboratory.decimals import to_floats
from conveyor.laboratory.factors import ModulusUnit, allowed, find_unit
from conveyor.laboratory.layout import DataColumn, DataTable
from conveyor.laboratory.names import DIMENSIONS, Meaning
from conveyor.laboratory.table import FloatArray, IntArray

_EXAMPLES = {"frequency": "Hz", "modulus": "MPa", "temperature": "degC", "strain": "%"}
FREQUENCY_AGREEMENT = 1e-2
"""Relative difference allowed between a column in Hz and one in rad/s of one file: three printed digits."""


@dataclass(frozen=True)
class Series:
    """One used column in SI; `log10` of it where `column.meaning` is a shift factor."""

    column: DataColumn
    meaning: Meaning
    values: FloatArray
    unit: ModulusUnit
    explicit: bool


@dataclass(frozen=True)
class Question:
    """Something only the user can decide, with its place."""

    row: int
    column: DataColumn
    text: str


def remedy(dimension: str, example: str = "") -> str:
    """The option that answers a question of unit, for Python and for the command line.

    Parameters
    ----------
    dimension : str
        frequency, modulus, temperature or strain; else the header is the place [-].
    example : str
        Unit shown, by default a usual one [-].

    Returns
    -------
    str
        Part of a message [-].

    Examples
    --------
    >>> remedy("modulus")
    'give modulus_unit, for example modulus_unit="MPa" (--modulus-unit MPa)'
    """
    if dimension == "number":
        return "it is a plain number: write - or nothing as its unit"
    if dimension not in _EXAMPLES:
        return f"write it in the header; allowed: {allowed(dimension)}"
    unit = example or _EXAMPLES[dimension]
    return f'give {dimension}_unit, for example {dimension}_unit="{unit}" (--{dimension}-unit {unit})'


def check_units(units: Mapping[str, str | None]) -> dict[str, ModulusUnit]:
    """Units given as options.

    Parameters
    ----------
    units : mapping of str
        Dimension to spelling or None [-].

    Returns
    -------
    dict of Unit
        Only those that were given [-].

    Raises
    ------
    InputError
        If a spelling is not a unit of its dimension.

    Examples
    --------
    >>> check_units({"modulus": "MPa", "strain": None})
    {'modulus': ModulusUnit(name='MPa', factor=1000000.0, offset=0.0)}
    """
    given = {}
    for dimension, text in units.items():
        if text is None:
            continue
        unit = find_unit(dimension, text)
        if unit is None:
            raise InputError(
                f'{dimension}_unit = "{text}" (--{dimension}-unit) is not known; allowed: {allowed(dimension)}'
            )
        given[dimension] = unit
    return given


def read_columns(
    table: DataTable, given: Mapping[str, ModulusUnit]
) -> tuple[Mapping[str, Series], IntArray | None, list[str], list[Question]]:
    """Numbers of every known column.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    given : mapping of Unit
        Units the user states, by dimension [-].

    Returns
    -------
    tuple
        Series by quantity, the labels of a run column or None, notes, open questions [-].

    Raises
    ------
    InputError
        For a cell that is no number, a row longer than the header, two columns of one quantity, a decimal mark
        that is not certain.
    """
    grid = table.grid
    used = _chosen(table)
    check_width(table)
    cells = {column.index: column_cells(table, column) for columns in used.values() for column in columns}
    unneeded = _unneeded(used)
    label_column = used.pop("run")[0] if "run" in used else None
    run = None if label_column is None else run_labels(grid, table, label_column, cells)
    mark = table_mark(table, [c for columns in used.values() for c in columns], cells)
    notes = ["decimal comma"] if mark == "," else []
    if label_column is not None:
        notes.append(f"{column_label(grid, label_column)} tells runs apart")
    series: dict[str, Series] = {}
    questions: list[Question] = []
    for quantity, columns in used.items():
        read = []
        for column in columns:
            numbers = np.array(to_floats(cells[column.index], mark))
            check_finite(table, column, numbers, cells[column.index])
            found, column_notes = _in_si(table, column, numbers, given, questions)
            notes += column_notes
            read.append(found)
        series[quantity] = read[0] if len(read) == 1 else _agreed(table, read)
    notes += [f"{column_label(grid, c)} is not needed" for c in unneeded]
    notes += [
        f"{column_label(grid, c)} is not used: "
        + ("it has no name" if not c.header else "its name is not a quantity read here")
        for c in table.columns
        if c.meaning is None and any(len(r.cells) > c.index and r.cells[c.index] for r in table.rows)
    ]
    return MappingProxyType(series), run, notes, questions


def column_label(grid: TextGrid, column: DataColumn) -> str:
    """How notes name a column.

    Parameters
    ----------
    grid : Grid
        Where it stands [-].
    column : Column
        The column [-].

    Returns
    -------
    str
        As in `column 2 "E' (Pa)"` [-].
    """
    place = str(grid.refusal(0, column.index, "", header=column.header))
    return place.split(": ", 1)[1].removesuffix(":")


def _chosen(table: DataTable) -> dict[str, list[DataColumn]]:
    """Columns by quantity; only frequency may come twice, once as an angular frequency."""
    used: dict[str, list[DataColumn]] = {}
    for column in table.columns:
        if column.meaning is None:
            continue
        others = used.setdefault(column.meaning.quantity, [])
        both_frequencies = (
            len(others) == 1
            and others[0].meaning is not None
            and others[0].meaning.angular != column.meaning.angular
        )
        if others and not both_frequencies:
            raise table.grid.refusal(
                table.header_row,
                column.index,
                f"a second column for {column.meaning.quantity} (the first is {column_label(table.grid, others[0])});"
                " keep one, or one row for each measurement with the temperature in a column of its own; rename what"
                " is not to be read",
                header=column.header,
            )
        others.append(column)
    for columns in used.values():
        columns.sort(key=lambda c: c.meaning is not None and c.meaning.angular)
    return used


def _unneeded(used: dict[str, list[DataColumn]]) -> list[DataColumn]:
    """Take out the clock of a dynamic test, and the complex modulus beside E' and E''."""
    found: list[DataColumn] = []
    if {"storage", "loss", "complex"} & set(used) and "relaxation" not in used:
        found += used.pop("time", [])
    if {"storage", "loss"} <= set(used):
        found += used.pop("complex", [])
    return found


def _in_si(
    table: DataTable,
    column: DataColumn,
    numbers: FloatArray,
    given: Mapping[str, ModulusUnit],
    questions: list[Question],
) -> tuple[Series, list[str]]:
    meaning = column.meaning
    assert meaning is not None  # noqa: S101
    dimension = DIMENSIONS[meaning.quantity]
    written = [text for text in (meaning.unit, column.unit) if text]
    stated = [find_unit(dimension, text) for text in written]
    override = given.get(dimension)
    label = column_label(table.grid, column)
    if override is not None:
        unit = override
        differs = [t for t, u in zip(written, stated, strict=True) if u != override]
        how = f"{unit.name} as given" + (
            f", overriding {' and '.join(differs)} of the file" if differs else ""
        )
    elif dimension in {"number", "label"} and not written:
        unit, how = ModulusUnit("-", 1.0), ""
    else:
        problem = _unit_problem(meaning, dimension, written, stated)
        if problem:
            questions.append(Question(table.header_row, column, problem))
        unit = next((u for u in stated if u is not None), ModulusUnit("?", 1.0))
        how = f"{unit.name} by the {'header' if meaning.unit else 'unit row'}"
    values, scale = _converted(meaning, numbers, unit)
    words = [f"{label}: {spoken(meaning)}", *([f"in {how}"] if how else []), *([scale] if scale else [])]
    return Series(column, meaning, values, unit, override is not None), [", ".join(words)]


def _unit_problem(
    meaning: Meaning, dimension: str, written: list[str], stated: list[ModulusUnit | None]
) -> str:
    if not written:
        which = "Hz or rad/s? " if dimension == "frequency" else ""
        return f"{which}{spoken(meaning)} has no unit; {remedy(dimension)}"
    for text, unit in zip(written, stated, strict=True):
        if unit is None:
            known = f"unit '{text}' of {spoken(meaning)} is not known"
            if dimension == "frequency" and text.replace(" ", "") in {"1/s", "s^-1", "s-1", "s⁻¹"}:
                known = f"unit '{text}' may be Hz or rad/s"
            if text in {"mPa", "mpa"}:
                known = f"unit '{text}' reads millipascal, is MPa meant?"
            return f"{known} (allowed: {allowed(dimension)}); {remedy(dimension)}"
    if len({unit.name for unit in stated if unit}) > 1:
        return f"the header says {written[0]}, the unit row {written[1]}; {remedy(dimension)}"
    if meaning.angular and stated[0] is not None and stated[0].name != "rad/s":
        return f"an angular frequency in {written[0]}: Hz or rad/s? {remedy('frequency', 'rad/s')}"
    return ""


def spoken(meaning: Meaning) -> str:
    """How messages name a quantity.

    Parameters
    ----------
    meaning : Meaning
        Of the column [-].

    Returns
    -------
    str
        As in `tan delta` [-].
    """
    words = meaning.quantity.replace("_", " ") if meaning.quantity not in {"a_T", "b_T"} else meaning.quantity
    return f"{words} (peak to peak)" if meaning.peak_to_peak else words


def _converted(meaning: Meaning, numbers: FloatArray, unit: ModulusUnit) -> tuple[FloatArray, str]:
    """SI values, for shift factors their log10; and how they were converted."""
    base = meaning.log_base
    if meaning.quantity in {"a_T", "b_T"} and base is not None:
        return numbers / np.log(10.0) * np.log(base) if base != 10.0 else numbers, (
            "log10 as it stands" if base == 10.0 else "natural logarithm divided by ln 10"
        )
    with np.errstate(over="ignore"):
        plain = numbers if base is None else np.power(base, numbers)
    factor = unit.factor * (0.5 if meaning.peak_to_peak else 1.0)
    with np.errstate(over="ignore"):  # an infinite value is refused with its row
        values = (plain + unit.offset) * factor if unit.offset else plain * factor
    words = [] if base is None else ["log10 undone" if base == 10.0 else "natural logarithm undone"]
    if unit.offset:
        words.append(f"+ {unit.offset:g}")
    if factor != 1.0:
        words.append(f"times {factor:.6g}")
    return values, ", ".join(words)


def _agreed(table: DataTable, read: list[Series]) -> Series:
    """Frequency in Hz where the file has an angular frequency too; refused where they contradict."""
    cyclic, angular = read
    apart = np.abs(angular.values - cyclic.values) - FREQUENCY_AGREEMENT * np.abs(cyclic.values)
    worst = int(np.argmax(apart))
    if apart[worst] > 0.0:
        raise table.grid.refusal(
            table.rows[worst].number,
            angular.column.index,
            f"{angular.values[worst]:g} Hz by this column, {cyclic.values[worst]:g} Hz by"
            f" {column_label(table.grid, cyclic.column)}; rename the one that is wrong, or give frequency_unit"
            " (--frequency-unit) with only one of them",
            header=angular.column.header,
        )
    return cyclic
