"""Numbers that cannot be, or that no rubber gives: refused with the option that would make them right."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from conveyor.laboratory.columns import Question, Series, remedy, spoken
from conveyor.laboratory.layout import DataTable
from conveyor.laboratory.moduli import Moduli

STORAGE_RANGE = (1.0e4, 1.0e11)
"""Modulus of a solid, soft gel to steel [Pa] (general knowledge); outside, the unit is wrong."""
TEMPERATURE_RANGE = (113.15, 523.15)
"""-160 to 250 degC [K]: below, no common furnace; above, rubber burns (general knowledge)."""
KELVIN_AS_CELSIUS = 473.15
"""If every temperature is above 200 degC, kelvins were probably labelled degC [K]."""
HIGHEST_STRAIN = 1.0
"""100 %: more is hardly dynamic, a percentage was probably labelled a fraction [-]."""
HIGHEST_TAN_DELTA = 10.0
"""No rubber reaches it in any row; its glass transition gives 1 to 3 (general knowledge) [-]."""
USUAL_TAN_DELTA = 3.0
"""No rubber exceeds it in half of its rows [-]."""
MEASURABLE = (1e-30, 1e30)
"""Frequencies [Hz] and times [s] of any master curve, with room: a shift of 30 decades is none."""
_DELETE = "repair or delete the row"
_POSITIVE = {
    "frequency": "must be > 0; if the column is log10 f, name it 'log10 f', else " + _DELETE,
    "strain": "must be > 0; " + _DELETE,
    "time": "must be > 0; if the column is log10 t, name it 'log10 t', else " + _DELETE,
    "storage": "must be > 0; if the column is log10 E', name it so, else " + _DELETE,
    "loss": "must be > 0 (noise beyond the instrument's range?); " + _DELETE,
    "complex": "must be > 0; " + _DELETE,
    "tau": "must be > 0; " + _DELETE,
    "term": "must be > 0; " + _DELETE,
    "share": "must be > 0; " + _DELETE,
    "instant": "must be > 0; " + _DELETE,
    "relaxation": "must be > 0; if the column is log10 E, name it so, else " + _DELETE,
    "tan_delta": "must be > 0; " + _DELETE,
    "phase": "must be > 0; " + _DELETE,
}


def check_possible(table: DataTable, series: Mapping[str, Series]) -> None:
    """Refuse what cannot be in any unit.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    series : mapping of Series
        By quantity, SI [-].

    Raises
    ------
    InputError
        For values that are not finite or not > 0, and phase angles of 90 degrees or more.
    """
    for quantity, found in series.items():
        bad = ~np.isfinite(found.values)
        if bad.any():
            _refuse(table, found, bad, f"is too large once its logarithm is undone; {_DELETE}")
        if quantity in _POSITIVE:
            _refuse(table, found, found.values <= 0.0, _POSITIVE[quantity])
        if quantity in {"frequency", "time"}:
            far = (found.values < MEASURABLE[0]) | (found.values > MEASURABLE[1])
            _refuse(table, found, far, f"is outside {MEASURABLE[0]:g} to {MEASURABLE[1]:g}; {_DELETE}")
        if quantity in {"a_T", "b_T"} and found.meaning.log_base is None:
            _refuse(
                table,
                found,
                found.values <= 0.0,
                f"must be > 0; if the column is log10, name it 'log10 {quantity}'",
            )
        if quantity == "phase" and found.unit.name != "?":
            _refuse(
                table,
                found,
                found.values >= np.pi / 2,
                "is 90 degrees or more: degrees labelled rad? correct the unit in the header",
            )


def _refuse(table: DataTable, found: Series, bad: NDArray[np.bool_], what: str) -> None:
    rows = np.flatnonzero(bad)
    if rows.size:
        line = table.rows[rows[0]]
        raise table.grid.refusal(
            line.number,
            found.column.index,
            f"{spoken(found.meaning)} = {line.cells[found.column.index]} {what}",
            header=found.column.header,
        )


def doubts(table: DataTable, series: Mapping[str, Series], moduli: Moduli | None) -> Iterator[Question]:
    """Values that are possible, but not in the unit the file states.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    series : mapping of Series
        By quantity, SI; only columns whose unit is known [-].
    moduli : Moduli or None
        E' and E'' [-].

    Yields
    ------
    Question
        With the first row in doubt [-].
    """
    yield from _modulus_doubts(table, series)
    if moduli is not None:
        yield from _loss_doubts(table, moduli)
    if "temperature" in series:
        yield from _temperature_doubts(table, series["temperature"])
    strain = series.get("strain")
    if strain is not None and not strain.explicit:
        rows = np.flatnonzero(strain.values > HIGHEST_STRAIN)
        if rows.size:
            yield _question(
                table,
                strain,
                rows[0],
                f"in {strain.unit.name}, that is {100.0 * strain.values[rows[0]]:g} %, more than 100 %;"
                f" {remedy('strain', '-' if strain.unit.name == '%' else '%')}",
            )


def _question(table: DataTable, found: Series, row: int, text: str) -> Question:
    line = table.rows[row]
    value = line.cells[found.column.index]
    return Question(line.number, found.column, f"{spoken(found.meaning)} = {value} {text}")


def _modulus_doubts(table: DataTable, series: Mapping[str, Series]) -> Iterator[Question]:
    low, high = STORAGE_RANGE
    for quantity in ("storage", "complex", "relaxation"):
        found = series.get(quantity)
        if found is None:
            continue
        rows = np.flatnonzero((found.values < low) | (found.values > high))
        if rows.size:
            value = found.values[rows[0]]
            yield _question(
                table,
                found,
                rows[0],
                f"in {found.unit.name}, but a solid has {low:g} to {high:g} Pa;"
                f" {remedy('modulus', 'Pa' if value > high else 'MPa')}",
            )


def _loss_doubts(table: DataTable, moduli: Moduli) -> Iterator[Question]:
    tangent = moduli.loss / moduli.storage
    rows = np.flatnonzero(tangent > HIGHEST_TAN_DELTA)
    swapped = np.median(tangent) > USUAL_TAN_DELTA
    if not rows.size and not swapped:
        return
    row = int(rows[0]) if rows.size else int(np.argmax(tangent))
    most = "in most rows " if swapped else ""
    yield _question(
        table,
        moduli.loss_from,
        row,
        f"makes tan delta {tangent[row]:.3g}; rubber stays {most}below"
        f" {USUAL_TAN_DELTA if swapped else HIGHEST_TAN_DELTA:g}: columns of E' and E'' swapped, or two units?"
        " rename the columns, or correct the units in the header or unit row",
    )


def _temperature_doubts(table: DataTable, found: Series) -> Iterator[Question]:
    low, high = TEMPERATURE_RANGE
    impossible = np.flatnonzero(found.values <= 0.0)
    if impossible.size:
        example = "degC" if found.unit.name == "K" else "K"
        yield _question(
            table,
            found,
            impossible[0],
            f"{found.unit.name} is below absolute zero; {remedy('temperature', example)}",
        )
        return
    if found.explicit:
        return
    rows = np.flatnonzero((found.values < low) | (found.values > high))
    if not rows.size and found.values.min() > KELVIN_AS_CELSIUS:
        rows = np.array([0])
    if rows.size:
        example = "degC" if found.unit.name == "K" else "K"
        yield _question(
            table,
            found,
            rows[0],
            f"{found.unit.name} is outside {low - 273.15:g} to {high - 273.15:g} degC, or all above"
            f" {KELVIN_AS_CELSIUS - 273.15:g}: kelvin and degC mixed up?"
            f" {remedy('temperature', example)}, or {found.unit.name} to confirm",
        )
