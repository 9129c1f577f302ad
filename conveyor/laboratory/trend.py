"""Series that run the wrong way: refused, because a convention or a column was mistaken."""

from __future__ import annotations

import numpy as np

from conveyor.laboratory.arrange import SWEPT, Arrangement
from conveyor.laboratory.layout import DataTable
from conveyor.laboratory.table import FloatArray

SCATTER = 0.8
"""A modulus that changes the wrong way by less than this factor may be flat with scatter [-]."""


def check_trend(table: DataTable, kind: str, columns: dict[str, FloatArray], found: Arrangement) -> None:
    """Compare both ends of a sorted series.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    kind : str
        One of `KINDS` [-].
    columns : dict of numpy.ndarray
        By quantity, SI, in the order of the file [unit].
    found : Arrangement
        Order of the rows and duplicates [-].

    Raises
    ------
    InputError
        If E' falls as the frequency rises, E(t) rises with time, a_T rises with temperature, or a temperature has
        two shift factors.

    Notes
    -----
    E' rises with frequency and E(t) falls with time for every linear viscoelastic solid (Prony series with
    moduli > 0). With f_reduced = f a_T a rubber has a_T > 1 below the reference temperature.
    """
    first, last = int(found.order[0]), int(found.order[-1])
    if first == last:
        return
    if kind == "master curve" and columns["storage"][last] < SCATTER * columns["storage"][first]:
        _refuse(
            table,
            last,
            "storage",
            "loss",
            "E' falls as the frequency rises: a period instead of a frequency, or"
            " several temperatures in one series? add a column temperature_degC, or correct the header",
        )
    if kind == "relaxation" and columns["modulus"][last] * SCATTER > columns["modulus"][first]:
        _refuse(
            table,
            last,
            "relaxation",
            "",
            "E(t) rises with time: a creep compliance, or times in descending order? correct the header",
        )
    if kind != "shift factors":
        return
    if found.duplicates is not None:
        row = int(np.flatnonzero(found.duplicates)[0])
        _refuse(
            table,
            row,
            SWEPT[kind],
            "",
            "a second shift factor at this temperature; delete one of the two rows",
        )
    if columns["log10_a_T"][last] > columns["log10_a_T"][first]:
        _refuse(
            table,
            last,
            "a_T",
            "",
            "a_T rises with temperature: 1/a_T in the other convention? write a_T with f_reduced = f a_T",
        )


def _refuse(table: DataTable, row: int, quantity: str, other: str, what: str) -> None:
    column = next(
        (
            c
            for q in (quantity, other)
            for c in table.columns
            if c.meaning is not None and c.meaning.quantity == q
        ),
        table.columns[0],
    )
    raise table.grid.refusal(table.rows[row].number, column.index, what, header=column.header)
