"""Check values: refuse impossible or implausible ones, with the option that would correct them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.laboratory.column_values import ColumnSeries, Question, unit_remedy
from conveyor.laboratory.moduli import Moduli
from conveyor.laboratory.table_layout import DataTable

STORAGE_RANGE: Final = (1.0e4, 1.0e11)
"""Modulus of a solid, soft gel to steel [Pa] (general knowledge); outside, the unit is wrong."""
TEMPERATURE_RANGE: Final = (113.15, 523.15)
"""-160 to 250 degC [K]: below, no common furnace; above, rubber burns (general knowledge)."""
KELVIN_AS_CELSIUS: Final = 473.15
"""Temperatures all above 200 degC are probably kelvins labelled degC [K]."""
HIGHEST_STRAIN: Final = 1.0
"""100 %: more is hardly dynamic, a percentage was probably labelled a fraction [-]."""
HIGHEST_TAN_DELTA: Final = 10.0
"""No rubber reaches it in any row; its glass transition gives 1 to 3 (general knowledge) [-]."""
USUAL_TAN_DELTA: Final = 3.0
"""No rubber exceeds it in half of its rows [-]."""
OVERLOAD_READING: Final = 1e20
"""No modulus, temperature, strain or angle reaches it in any unit: instruments write 9.9E+37 and the like for a missing
reading (general knowledge) [-]."""
MEASURABLE_RANGE: Final = (1e-30, 1e30)
"""Frequencies [Hz] and times [s] of any master curve, with room: a shift of 30 decades is none."""
_DELETE_ADVICE: Final = "repair or delete the row"
_POSITIVE_ADVICE: Final = {
    "frequency": "; if the column is log10 f, name it 'log10 f', else " + _DELETE_ADVICE,
    "time": "; if the column is log10 t, name it 'log10 t', else " + _DELETE_ADVICE,
    "storage": "; if the column is log10 E', name it so, else " + _DELETE_ADVICE,
    "loss": " (noise beyond the instrument's range?); " + _DELETE_ADVICE,
    "relaxation": "; if the column is log10 E, name it so, else " + _DELETE_ADVICE,
    "a_T": "; if the column is log10, name it 'log10 a_T'",
    "b_T": "; if the column is log10, name it 'log10 b_T'",
} | dict.fromkeys(("strain", "complex", "tau", "term", "share", "instant", "tan_delta", "phase"), f"; {_DELETE_ADVICE}")
"""Quantities that must be > 0, with advice."""


_UNLIMITED_QUANTITIES: Final = frozenset({"frequency", "time", "tau", "a_T", "b_T", "run"})
"""Quantities without upper limit, as shifts may make them large."""


def check_possible(table: DataTable, series: Mapping[str, ColumnSeries]) -> None:
    """Refuse values impossible in any unit: not finite, not > 0, a phase angle of 90 degrees or more."""
    low, high = MEASURABLE_RANGE
    for quantity, column in series.items():
        values = column.values
        if quantity not in _UNLIMITED_QUANTITIES and column.meaning.log_base is None:
            overload = np.abs(values / column.unit.factor) > OVERLOAD_READING
            _refuse_rows(table, column, overload, f"is no reading but an overload of the instrument; {_DELETE_ADVICE}")
        _refuse_rows(
            table,
            column,
            ~np.isfinite(values),
            f"is too large once its logarithm is undone; {_DELETE_ADVICE}",
        )
        logarithm = quantity in {"a_T", "b_T"} and column.meaning.log_base is not None
        if quantity in _POSITIVE_ADVICE and not logarithm:
            _refuse_rows(table, column, values <= 0.0, "must be > 0" + _POSITIVE_ADVICE[quantity])
        if quantity in {"frequency", "time"}:
            far = (values < low) | (values > high)
            _refuse_rows(table, column, far, f"is outside {low:g} to {high:g}; {_DELETE_ADVICE}")
        if quantity == "phase" and column.unit.name != "?":
            what = "is 90 degrees or more: degrees labelled rad? correct the unit in the header"
            _refuse_rows(table, column, values >= np.pi / 2, what)


def _refuse_rows(table: DataTable, series: ColumnSeries, bad: NDArray[np.bool_], what: str) -> None:
    if bad.any():
        faults = [_row_question(table, series, row, what) for row in np.flatnonzero(bad).tolist()]
        raise table.refusal_of_rows([(each.column, each.text, each.row or 0) for each in faults])


def _row_question(table: DataTable, series: ColumnSeries, row: int, text: str) -> Question:
    value = table.rows[row].cells[series.column.index]
    return Question(series.column, f"{series.name} = {value} {text}", row)


def doubtful_values(table: DataTable, series: Mapping[str, ColumnSeries], moduli: Moduli | None) -> Iterator[Question]:
    """Questions on values implausible in the stated unit, each at its first row."""
    for quantity in ("storage", "complex", "relaxation"):
        if quantity in series:
            yield from _modulus_doubts(table, series[quantity])
    if moduli is not None:
        yield from _loss_doubts(table, moduli)
    if "temperature" in series:
        yield from _temperature_doubts(table, series["temperature"])
    if "strain" in series and not series["strain"].explicit:
        yield from _strain_doubts(table, series["strain"])


def _modulus_doubts(table: DataTable, series: ColumnSeries) -> Iterator[Question]:
    low, high = STORAGE_RANGE
    rows = np.flatnonzero((series.values < low) | (series.values > high))
    if rows.size:
        advice = unit_remedy("modulus", "Pa" if series.values[rows[0]] > high else "MPa")
        what = f"in {series.unit.name}, but a solid has {low:g} to {high:g} Pa; {advice}"
        yield _row_question(table, series, rows[0], what)


def _loss_doubts(table: DataTable, moduli: Moduli) -> Iterator[Question]:
    tangent = moduli.loss / moduli.storage
    above = tangent > HIGHEST_TAN_DELTA
    swapped = np.median(tangent) > USUAL_TAN_DELTA
    if above.any() or swapped:
        row = int(np.argmax(above) if above.any() else np.argmax(tangent))
        limit = f"in most rows below {USUAL_TAN_DELTA:g}" if swapped else f"below {HIGHEST_TAN_DELTA:g}"
        what = (
            f"makes tan delta {tangent[row]:.3g}; rubber stays {limit}: columns of E' and E'' swapped, or two units?"
            " rename the columns, or correct the units in the header or unit row"
        )
        if moduli.loss_from.meaning.quantity == "tan_delta":
            what = f"is too much; rubber stays {limit}: a phase angle in degrees? name the column 'phase [deg]'"
        yield _row_question(table, moduli.loss_from, row, what)


def _temperature_doubts(table: DataTable, series: ColumnSeries) -> Iterator[Question]:
    low, high = TEMPERATURE_RANGE
    unit, advice = series.unit.name, unit_remedy("temperature", "degC" if series.unit.name == "K" else "K")
    impossible = series.values <= 0.0
    outside = (series.values < low) | (series.values > high)
    if not outside.any():
        outside[0] = series.values.min() > KELVIN_AS_CELSIUS
    if impossible.any():
        yield _row_question(table, series, int(np.argmax(impossible)), f"{unit} is below absolute zero; {advice}")
    elif outside.any() and not series.explicit:
        what = (
            f"{unit} is outside {low - 273.15:g} to {high - 273.15:g} degC, or all above"
            f" {KELVIN_AS_CELSIUS - 273.15:g}: kelvin and degC mixed up? {advice}, or {unit} to confirm"
        )
        yield _row_question(table, series, int(np.argmax(outside)), what)


def _strain_doubts(table: DataTable, series: ColumnSeries) -> Iterator[Question]:
    rows = np.flatnonzero(series.values > HIGHEST_STRAIN)
    if rows.size:
        percent, advice = (
            100.0 * series.values[rows[0]],
            unit_remedy("strain", "-" if series.unit.name == "%" else "%"),
        )
        what = f"in {series.unit.name}, that is {percent:g} %, more than 100 %; {advice}"
        yield _row_question(table, series, rows[0], what)
