"""Columns of a table to numbers in SI: selection, units, and questions to the user."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final, NamedTuple

import numpy as np

from conveyor.errors import InputError
from conveyor.laboratory.cell_grid import AnswerableError
from conveyor.laboratory.column_units import ColumnUnit, allowed_units, find_unit
from conveyor.laboratory.dma_data import FloatArray, IntArray
from conveyor.laboratory.header_meanings import DIMENSIONS, Meaning
from conveyor.laboratory.numbers import decimal_mark, is_number, last_digit, why_not_a_number
from conveyor.laboratory.table_layout import DataColumn, DataTable

_EXAMPLES: Final = {"frequency": "Hz", "modulus": "MPa", "temperature": "degC", "strain": "%"}
_ROUNDING: Final = 1e-6  # of a digit: decimal numbers are none in binary
FREQUENCY_AGREEMENT: Final = 1e-2
"""Relative difference allowed between a column in Hz and one in rad/s of one file: three printed digits."""


@dataclass(frozen=True)
class ColumnSeries:
    """One used column in SI; `log10` of it where `meaning` is a shift factor with a logarithm."""

    column: DataColumn
    meaning: Meaning
    values: FloatArray
    unit: ColumnUnit
    explicit: bool

    @property
    def name(self) -> str:
        """Name of the quantity in messages."""
        return quantity_words(self.meaning)


class Question(NamedTuple):
    """Question to the user about a column, or one of its rows, counted from 0."""

    column: DataColumn
    text: str
    row: int | None = None


class TableValues(NamedTuple):
    """Series by quantity, the labels of a run column, notes on decisions, and open questions."""

    series: dict[str, ColumnSeries]
    labels: IntArray | None
    notes: list[str]
    questions: list[Question]


def unit_remedy(dimension: str, example: str = "") -> str:
    """Advice on stating a unit: the option in Python and on the command line, or the header.

    Examples
    --------
    >>> unit_remedy("modulus")
    'give modulus_unit, for example modulus_unit="MPa" (--modulus-unit MPa)'
    """
    if dimension == "number":
        return "it is a plain number: write - or nothing as its unit"
    if dimension not in _EXAMPLES:
        return f"write it in the header; allowed: {allowed_units(dimension)}"
    unit = example or _EXAMPLES[dimension]
    return f'give {dimension}_unit, for example {dimension}_unit="{unit}" (--{dimension}-unit {unit})'


def check_units(units: Mapping[str, str | None]) -> dict[str, ColumnUnit]:
    """Units given as options, by dimension; unknown ones are refused."""
    given = {}
    for dimension, text in units.items():
        unit = None if text is None else find_unit(dimension, text)
        if unit is not None:
            given[dimension] = unit
        elif text is not None:
            raise InputError(
                f'{dimension}_unit = "{text}" (--{dimension}-unit) is not known; allowed: {allowed_units(dimension)}'
            )
    return given


def read_columns(table: DataTable, given: Mapping[str, ColumnUnit]) -> TableValues:
    """Read every known column into SI; `given` units override those of the file."""
    _check_width(table)
    every = {
        column.index: [_cell_text(table, row, column) for row in range(len(table.rows))]
        for column in table.columns
        if column.meaning is not None
    }
    empty = [c for c in table.columns if c.index in every and not any(every[c.index])]
    used, spare = _select_columns(table, every, empty)
    _check_cells(table, list(chain(*used.values())), every)
    cells = every
    unneeded = _drop_unneeded(used)
    labelled = next(iter(used.pop("run", ())), None)
    labels = None if labelled is None else _run_labels(table, labelled, cells[labelled.index])
    mark = _table_decimal_mark(table, list(chain(*used.values())), cells)
    notes = ["decimal comma"] if mark == "," else []
    if labelled is not None:
        notes.append(f"{table.label(labelled)} tells runs apart")
    read = TableValues({}, labels, notes, [])
    for quantity, columns in used.items():
        in_si = [
            _column_in_si(table, column, _cell_numbers(cells[column.index], mark), given, read) for column in columns
        ]
        read.series[quantity] = in_si[0] if len(in_si) == 1 else _check_frequencies(table, *in_si)
    notes += [*(f"{table.label(c)} is not needed" for c in unneeded), *spare]
    for column in table.columns:
        if column.meaning is None and any(_cell_text(table, row, column) for row in range(len(table.rows))):
            why = "its name is not a quantity read here" if column.header else "it has no name"
            notes.append(f"{table.label(column)} is not used: {why}")
    return read


def quantity_words(meaning: Meaning) -> str:
    """Name of a quantity in messages, as in `tan delta`."""
    words = meaning.quantity if meaning.quantity in {"a_T", "b_T"} else meaning.quantity.replace("_", " ")
    return f"{words} (peak to peak)" if meaning.peak_to_peak else words


def _select_columns(
    table: DataTable, cells: Mapping[int, list[str]], empty: Sequence[DataColumn]
) -> tuple[dict[str, list[DataColumn]], list[str]]:
    """Columns by quantity, and notes on unused ones: empty, commanded where measured, repeated.

    Only frequency may come twice, the angular one second.
    """
    used: dict[str, list[DataColumn]] = {}
    said = [f"{table.label(column)} is empty in every row and not used" for column in empty]
    named = [column for column in table.columns if column.meaning is not None and column not in empty]
    measured = {_column_identity(c) for c in named if c.meaning is not None and not c.meaning.commanded}
    angular = {c.index for c in named if c.meaning is not None and c.meaning.angular}
    for column in named:
        assert column.meaning is not None  # noqa: S101
        if column.meaning.commanded and _column_identity(column) in measured:
            said.append(f"{table.label(column)} is not used: what was commanded, beside what was measured")
            continue
        others = used.setdefault(column.meaning.quantity, [])
        first = next((other for other in others if _column_identity(other) == _column_identity(column)), None)
        if first is None and others and (len(others) > 1 or (others[0].index in angular) == (column.index in angular)):
            first = others[0]
        if first is not None:
            if _is_repetition(cells[first.index], cells[column.index]) and _column_identity(
                first, unit=True
            ) == _column_identity(column, unit=True):
                said.append(f"{table.label(column)} repeats {table.label(first)} and is not used")
                continue
            raise _second_column_error(table, first, column)
        others.append(column)
        others.sort(key=lambda c: c.index in angular)
    return used, said


def _column_identity(column: DataColumn, *, unit: bool = False) -> tuple[object, ...]:
    """Identity of a column's quantity: equal for two columns that hold the same in the same way."""
    sense = column.meaning
    assert sense is not None  # noqa: S101
    units = (sense.unit, column.unit) if unit else ()
    return (sense.quantity, sense.angular, sense.log_base, sense.peak_to_peak, sense.at, *units)


def _is_repetition(first: Sequence[str], second: Sequence[str]) -> bool:
    """True if two columns hold the same numbers to their printed digits."""
    for a, b in zip(first, second, strict=True):
        if a == b:
            continue
        if not (is_number(a) and is_number(b)):
            return False
        x, y = (float(each.replace(",", ".")) for each in (a, b))
        if abs(x - y) > 0.5 * (_digit_value(a) + _digit_value(b)) * (1.0 - _ROUNDING):
            return False
    return True


def _digit_value(cell: str) -> float:
    """Value of one in the last digit; 1 for a whole number."""
    return 1.0 if cell.lstrip("+-").isdigit() else last_digit(cell)


def _second_column_error(table: DataTable, first: DataColumn, column: DataColumn) -> InputError:
    """Error: a second column of a quantity, with other values than the first."""
    assert column.meaning is not None  # noqa: S101
    name = table.grid.column(column.index)
    what = (
        f"a second column for {column.meaning.quantity} (the first is {table.label(first)}) with other values; keep"
        f' one: ignore=["{name}"] (--ignore {name}) leaves this one aside, {table.grid.column(first.index)} the first;'
        " or give one row for each measurement with the temperature in a column of its own"
    )
    return AnswerableError(str(table.refusal(column, what)), option="ignore", value=name)


def _drop_unneeded(used: dict[str, list[DataColumn]]) -> list[DataColumn]:
    """Drop the time of a dynamic test, and the complex modulus where E' and E'' are given."""
    unneeded: list[DataColumn] = []
    if {"storage", "loss", "complex"} & set(used) and "relaxation" not in used:
        unneeded += used.pop("time", [])
    if {"storage", "loss"} <= set(used):
        unneeded += used.pop("complex", [])
    return unneeded


def _check_width(table: DataTable) -> None:
    """Refuse rows longer than the header."""
    width = table.width
    for line in table.rows:
        count = len(line.cells)
        if count > width:
            comma = table.grid.notes[-1].endswith("comma") and count == 2 * width
            advice = (
                "decimal commas in a table separated by commas? export it with semicolons or decimal points"
                if comma
                else "name every column in the header, or remove the extra cell"
            )
            what = f"{count} cells, the header names {width}; {advice}"
            raise table.grid.refusal(line.number, width, what)


def _cell_text(table: DataTable, row: int, column: DataColumn) -> str:
    cells = table.rows[row].cells
    return cells[column.index] if column.index < len(cells) else ""


def _check_cells(table: DataTable, columns: Sequence[DataColumn], cells: Mapping[int, list[str]]) -> None:
    """Refuse every row in which a cell is empty, or no finite number, of a column that holds numbers."""
    hint = "or a formula without a stored value" if table.grid.sheet else "a line cut short?"
    faults: list[tuple[DataColumn, str, int]] = []
    for column in columns:
        assert column.meaning is not None  # noqa: S101
        label = column.meaning.quantity == "run"
        for row, cell in enumerate(cells[column.index]):
            if not cell:
                faults.append((column, f"the cell is empty ({hint}); complete or delete the row", row))
            elif not label and not is_number(cell):
                line = table.rows[row]
                faults.append((column, why_not_a_number(cell if any(map(is_number, line.cells)) else line.text), row))
            elif not label and not math.isfinite(float(cell.replace(",", "."))):
                faults.append((column, f"'{cell}' is too large for a number; repair or delete the row", row))
    first = {row: (column, text, row) for column, text, row in reversed(faults)}
    if first:
        raise table.refusal_of_rows([first[row] for row in sorted(first)])


def _table_decimal_mark(table: DataTable, columns: list[DataColumn], cells: Mapping[int, list[str]]) -> str:
    """Decimal mark of all number columns together."""
    every = [cell for column in columns for cell in cells[column.index]]
    mark, doubtful = decimal_mark(every)
    if doubtful is not None:
        column = next(column for column in columns if doubtful in cells[column.index])
        why = (
            "a comma here and decimal points elsewhere"
            if any("." in cell for cell in every)
            else "a decimal comma or a thousands separator cannot be told apart"
        )
        what = f"'{doubtful}': {why}; export the table with decimal points and no thousands separators"
        raise table.refusal(column, what, cells[column.index].index(doubtful))
    return mark


def _cell_numbers(cells: list[str], mark: str) -> FloatArray:
    return np.array([float(cell.replace(",", ".") if mark == "," else cell) for cell in cells])


def _run_labels(table: DataTable, column: DataColumn, cells: list[str]) -> IntArray:
    """Run labels as numbers: whole numbers unchanged, others by order of appearance."""
    plain = [cell.removesuffix(".0") for cell in cells]
    if all(cell.lstrip("-").isdigit() for cell in plain):
        return np.array([int(cell) for cell in plain], dtype=np.int64)
    order = {label: number for number, label in enumerate(dict.fromkeys(cells))}
    if len(order) == len(cells) > 1:
        what = "every row has a label of its own, so they tell no runs apart; rename the column if it is not a run"
        raise table.refusal(column, what, 0)
    return np.array([order[label] for label in cells], dtype=np.int64)


def _column_in_si(
    table: DataTable,
    column: DataColumn,
    numbers: FloatArray,
    given: Mapping[str, ColumnUnit],
    read: TableValues,
) -> ColumnSeries:
    """Convert a column by the given or stated unit; adds to notes and questions of `read`."""
    meaning = column.meaning
    assert meaning is not None  # noqa: S101
    dimension = DIMENSIONS[meaning.quantity]
    written = [text for text in (meaning.unit, column.unit) if text]
    stated = [find_unit(dimension, text) for text in written]
    override = given.get(dimension)
    words = [f"{table.label(column)}: {quantity_words(meaning)}"]
    if override is not None:
        unit = override
        words.append(f"in {unit.name} as given")
        differs = [t for t, u in zip(written, stated, strict=True) if u != override]
        if differs:
            words.append(f"overriding {' and '.join(differs)} of the file")
    elif dimension in {"number", "label"} and not written:
        unit = ColumnUnit("-", 1.0)
    else:
        problem = _unit_problem(meaning, dimension, written, stated)
        if problem:
            read.questions.append(Question(column, problem))
        unit = next((u for u in stated if u is not None), ColumnUnit("?", 1.0))
        words.append(f"in {unit.name} by the {'header' if meaning.unit else 'unit row'}")
    values, scale = _convert_values(meaning, numbers, unit)
    read.notes.append(", ".join([*words, *scale]))
    return ColumnSeries(column, meaning, values, unit, override is not None)


def _unit_problem(meaning: Meaning, dimension: str, written: list[str], stated: list[ColumnUnit | None]) -> str:
    if not written:
        which = "Hz or rad/s? " if dimension == "frequency" else ""
        return f"{which}{quantity_words(meaning)} has no unit; {unit_remedy(dimension)}"
    for text, unit in zip(written, stated, strict=True):
        if unit is None:
            known = f"unit '{text}' of {quantity_words(meaning)} is not known"
            if dimension == "frequency" and text.replace(" ", "") in {"1/s", "s^-1", "s-1", "s⁻¹"}:
                known = f"unit '{text}' may be Hz or rad/s"
            if text.lower() == "mhz":
                known = f"unit '{text}' may be mHz or MHz"
            if text == "mPa":
                known = f"unit '{text}' reads millipascal, is MPa meant?"
            return f"{known} (allowed: {allowed_units(dimension)}); {unit_remedy(dimension)}"
    if len({unit.name for unit in stated if unit}) > 1:
        return f"the header says {written[0]}, the unit row {written[1]}; {unit_remedy(dimension)}"
    if meaning.angular and stated[0] is not None and stated[0].name != "rad/s":
        return f"an angular frequency in {written[0]}: Hz or rad/s? {unit_remedy('frequency', 'rad/s')}"
    return ""


def _convert_values(meaning: Meaning, numbers: FloatArray, unit: ColumnUnit) -> tuple[FloatArray, list[str]]:
    """SI values, log10 for logarithms of shift factors, and notes on the conversion."""
    base = meaning.log_base
    if meaning.quantity in {"a_T", "b_T"} and base is not None:
        if base == 10.0:
            return numbers, ["log10 as it stands"]
        return numbers / np.log(10.0) * np.log(base), ["natural logarithm divided by ln 10"]
    factor = unit.factor * (0.5 if meaning.peak_to_peak else 1.0)
    with np.errstate(over="ignore"):  # an infinite value is refused with its row
        plain = numbers if base is None else np.power(base, numbers)
        values = (plain + unit.offset) * factor if unit.offset else plain * factor
    words = [] if base is None else ["log10 undone" if base == 10.0 else "natural logarithm undone"]
    words += [f"+ {unit.offset:g}"] if unit.offset else []
    words += [f"times {factor:.6g}"] if factor != 1.0 else []
    return values, words


def _check_frequencies(table: DataTable, cyclic: ColumnSeries, angular: ColumnSeries) -> ColumnSeries:
    """Frequency in Hz, refused where an angular frequency of the file contradicts it."""
    apart = np.abs(angular.values - cyclic.values) - FREQUENCY_AGREEMENT * np.abs(cyclic.values)
    worst = int(np.argmax(apart))
    if apart[worst] > 0.0:
        raise table.refusal(
            angular.column,
            f"{angular.values[worst]:g} Hz by this column, {cyclic.values[worst]:g} Hz by"
            f" {table.label(cyclic.column)}; rename the one that is wrong, or give frequency_unit"
            " (--frequency-unit) with only one of them",
            worst,
        )
    return cyclic
