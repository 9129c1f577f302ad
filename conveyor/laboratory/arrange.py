"""Sort rows by temperature, run and swept quantity; separate duplicate runs; refuse wrong trends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from conveyor.laboratory.dma_data import FloatArray, IntArray
from conveyor.laboratory.groups import SAME_SET_POINT, duplicate_runs, set_points, temperature_groups
from conveyor.laboratory.measurement_kinds import NEEDED_COLUMNS
from conveyor.laboratory.table_layout import DataTable

SAME_TEMPERATURE: Final = 0.01
"""Rows of a ramp this close are repeats [K]: the last digit printed."""
SAME_REDUCED_FREQUENCY: Final = 1e-9
"""A master curve merges shifted isotherms: only equal frequencies, to rounding, are repeats [-]."""
WRONG_WAY_FACTOR: Final = 0.8
"""Ratio of end values above which a wrong trend may be the scatter of a flat modulus [-]."""


@dataclass(frozen=True)
class Arrangement:
    """Order of the rows; group and run are in the order of the file."""

    order: IntArray
    group: IntArray | None
    run: IntArray | None
    duplicates: IntArray | None


def arrange_rows(kind: str, columns: Mapping[str, FloatArray], labels: IntArray | None) -> Arrangement:
    """Group and sort rows, duplicate runs of one group and label apart.

    Examples
    --------
    >>> f = np.array([10.0, 1.0, 10.0])
    >>> found = arrange_rows("master curve", {"frequency": f}, None)
    >>> found.order, found.run
    (array([1, 0, 2]), array([0, 0, 1]))
    """
    swept = columns[NEEDED_COLUMNS[kind][0]]
    group = _sweep_groups(kind, columns, labels)
    zero = np.zeros(swept.size, dtype=np.int64)
    condition = zero if group is None else group
    parted = condition if labels is None else _number_pairs(condition, labels)
    if NEEDED_COLUMNS[kind][0] == "temperature":
        duplicates = duplicate_runs(swept, parted, tolerance=SAME_TEMPERATURE)
    else:
        merged = kind == "master curve"
        tolerance = SAME_REDUCED_FREQUENCY if merged else SAME_SET_POINT
        duplicates = duplicate_runs(np.log(swept), parted, tolerance=tolerance, merged=merged)
    run = labels if labels is not None else duplicates
    again, second = (zero if marks is None else marks for marks in (duplicates, run))
    first = parted if group is None else group
    return Arrangement(np.lexsort((swept, again, second, first)), group, run, duplicates)


def _number_pairs(first: IntArray, second: IntArray) -> IntArray:
    """Number the distinct pairs of two labels."""
    inverse = np.unique(np.stack([first, second]), axis=1, return_inverse=True)[1]
    return inverse.reshape(-1).astype(np.int64)


def _sweep_groups(kind: str, columns: Mapping[str, FloatArray], labels: IntArray | None) -> IntArray | None:
    """Group numbers of rows measured under one condition; None for a ramp."""
    temperature, frequency = columns.get("temperature"), columns.get("frequency")
    single = np.zeros(columns[NEEDED_COLUMNS[kind][0]].size, dtype=np.int64)
    if kind in {"relaxation", "shift factors", "master curve", "Prony series"}:
        return single
    level = single if frequency is None else set_points(frequency)
    if kind == "temperature sweep":
        return level
    group = single if temperature is None else temperature_groups(temperature, labels)
    return group if group is None or kind == "isotherms" else _number_pairs(group, level)


def check_trend(table: DataTable, kind: str, columns: Mapping[str, FloatArray], arrangement: Arrangement) -> None:
    """Refuse a series that runs the wrong way, or two shift factors at one temperature.

    Notes
    -----
    E' rises with frequency and E(t) falls with time for every linear viscoelastic solid (Prony series with
    moduli > 0). With f_reduced = f a_T a rubber has a_T > 1 below the reference temperature.
    """
    first, last = int(arrangement.order[0]), int(arrangement.order[-1])
    wrong: tuple[int, tuple[str, ...], str] | None = None
    if first == last:
        return
    if kind == "master curve" and columns["storage"][last] < WRONG_WAY_FACTOR * columns["storage"][first]:
        what = (
            "E' falls as the frequency rises: a period instead of a frequency, or several temperatures in one series?"
            " add a column temperature_degC, or correct the header"
        )
        wrong = last, ("storage", "loss"), what
    elif kind == "relaxation" and columns["modulus"][last] * WRONG_WAY_FACTOR > columns["modulus"][first]:
        what = "E(t) rises with time: a creep compliance, or times in descending order? correct the header"
        wrong = last, ("relaxation",), what
    elif kind == "shift factors" and arrangement.duplicates is not None:
        what = "a second shift factor at this temperature; delete one of the two rows"
        wrong = int(np.flatnonzero(arrangement.duplicates)[0]), ("temperature",), what
    elif kind == "shift factors" and columns["log10_a_T"][last] > columns["log10_a_T"][first]:
        what = "a_T rises with temperature: 1/a_T in the other convention? write a_T with f_reduced = f a_T"
        wrong = last, ("a_T",), what
    if wrong is not None:
        row, quantities, what = wrong
        by = {c.meaning.quantity: c for c in table.columns if c.meaning is not None}
        column = next((by[q] for q in quantities if q in by), table.columns[0])
        raise table.refusal(column, what, row)
