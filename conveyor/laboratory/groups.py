"""Rows that belong together: one temperature, one frequency, one run."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from conveyor.laboratory.table import ISOTHERM_DRIFT, FloatArray, IntArray

ISOTHERM_GAP = 0.8
"""Temperatures further apart than this are different isotherms [K]: steps are 1 K or more, furnaces hold 0.5 K
(general knowledge)."""
SAME_SET_POINT = 5e-3
"""Frequencies or strains closer than this, relatively, are one set point; instruments set 10 a decade (26 % apart)."""
SAME_TEMPERATURE = 0.01
"""Rows of a ramp closer than this are repeats [K]: the last digit printed."""
SAME_REDUCED_FREQUENCY = 1e-9
"""A master curve merges shifted isotherms: only equal frequencies, to rounding, are repeats [-]."""
_SHORTEST_RUN = 3
_SHORTEST_OTHER_RUN = 5
"""Rows in no order rarely fall into rising or falling stretches of five: ten rows in 4/(5! 5!) of all orders."""


def temperature_groups(temperature: FloatArray, run: IntArray | None) -> IntArray | None:
    """Number the isotherms of a file by ascending temperature.

    Parameters
    ----------
    temperature : numpy.ndarray
        Of each row, shape `(n,)` [K].
    run : numpy.ndarray or None
        Label of each row, shape `(n,)` [-].

    Returns
    -------
    numpy.ndarray or None
        Group of each row, shape `(n,)`; None if the temperature is a ramp [-].

    Notes
    -----
    A run whose temperatures stay within `ISOTHERM_DRIFT` is one group; any other is cut where ascending
    temperatures are more than `ISOTHERM_GAP` apart. Groups of different runs stay apart.

    Examples
    --------
    >>> temperature_groups(np.array([293.2, 273.1, 293.1, 273.2]), None)
    array([1, 0, 1, 0])
    >>> temperature_groups(np.arange(270.0, 290.0, 0.5), None) is None
    True
    """
    labels = np.zeros(temperature.size, dtype=np.int64) if run is None else run
    members: list[IntArray] = []
    for label in np.unique(labels):
        rows = np.flatnonzero(labels == label)
        rows = rows[np.argsort(temperature[rows], kind="stable")]
        steps = np.diff(temperature[rows])
        whole = temperature[rows[-1]] - temperature[rows[0]] <= ISOTHERM_DRIFT
        cuts = np.flatnonzero(steps > ISOTHERM_GAP) + 1
        members += [rows] if whole and run is not None else np.split(rows, cuts)
    if any(np.ptp(temperature[rows]) > ISOTHERM_DRIFT for rows in members):
        return None
    members.sort(key=lambda rows: float(np.mean(temperature[rows])))
    group = np.empty(temperature.size, dtype=np.int64)
    for number, rows in enumerate(members):
        group[rows] = number
    return group


def levels(values: FloatArray) -> IntArray:
    """Number the set points of a quantity in ascending order.

    Parameters
    ----------
    values : numpy.ndarray
        Frequencies or strains, > 0, shape `(n,)` [unit].

    Returns
    -------
    numpy.ndarray
        Set point of each row, shape `(n,)` [-].

    Examples
    --------
    >>> levels(np.array([10.0, 1.0, 10.01]))
    array([1, 0, 1])
    """
    return _clusters(np.log(values), SAME_SET_POINT)


def _clusters(values: FloatArray, gap: float) -> IntArray:
    order = np.argsort(values, kind="stable")
    number = np.concatenate([[0], np.cumsum(np.diff(values[order]) > gap)])
    found = np.empty(values.size, dtype=np.int64)
    found[order] = number
    return found


def duplicate_runs(
    values: FloatArray, group: IntArray, *, tolerance: float, merged: bool = False
) -> IntArray | None:
    """Tell repeated sweeps of one group apart.

    Parameters
    ----------
    values : numpy.ndarray
        The swept quantity in the order of the file, shape `(n,)` [unit].
    group : numpy.ndarray
        Rows of equal number are one condition, shape `(n,)` [-].
    tolerance : float
        Values closer than this are one set point [unit].
    merged : bool
        The rows are shifted isotherms, whose ranges overlap without being repeats [-].

    Returns
    -------
    numpy.ndarray or None
        Run of each row within its group, from 0, shape `(n,)`; None if nothing is repeated [-].

    Notes
    -----
    If the rows of a group fall into stretches of three or more (five if no set point comes back), each rising
    or falling, and at least half of each lies inside the range of the one before (`merged`: on its set points),
    every stretch is a run: up and down, or one sweep after the other. Else the second row at one set point
    begins the second run: two runs sorted into each other, or a repeated point.

    Examples
    --------
    >>> duplicate_runs(np.array([1.0, 2, 4, 4, 2, 1]), np.zeros(6, dtype=int), tolerance=0.01)
    array([0, 0, 0, 1, 1, 1])
    >>> duplicate_runs(np.array([1.0, 2, 4, 1.5, 3, 6]), np.zeros(6, dtype=int), tolerance=0.01) is None
    True
    >>> duplicate_runs(np.array([1.0, 1.001, 2.0]), np.zeros(3, dtype=int), tolerance=0.01)
    array([0, 1, 0])
    """
    run = np.zeros(values.size, dtype=np.int64)
    for number in np.unique(group):
        rows = np.flatnonzero(group == number)
        inside = values[rows]
        points = _clusters(inside, tolerance)
        stretch = _stretches(points)
        repeats = np.unique(points).size < rows.size
        shortest = _SHORTEST_RUN if repeats else _SHORTEST_OTHER_RUN
        swept_again = _swept_again(points if merged else inside, stretch, shortest, exactly=merged)
        run[rows] = stretch if swept_again else _occurrence(points)
    return run if run.any() else None


def _swept_again(values: FloatArray | IntArray, stretch: IntArray, shortest: int, *, exactly: bool) -> bool:
    parts = [values[stretch == number] for number in range(int(stretch[-1]) + 1)]
    if len(parts) < 2 or min(part.size for part in parts) < shortest:
        return False
    return all(
        2 * int(np.sum(np.isin(b, a) if exactly else (b >= a.min()) & (b <= a.max()))) >= b.size
        for a, b in pairwise(parts)
    )


def restarts(frequency: FloatArray) -> int:
    """How often a frequency sweep begins anew in the order of the file.

    Parameters
    ----------
    frequency : numpy.ndarray
        Of each row, shape `(n,)` [Hz].

    Returns
    -------
    int
        0 for one sweep, and for rows in no order [-].

    Examples
    --------
    >>> restarts(np.array([1.0, 2, 4, 1, 2, 4])), restarts(np.array([1.0, 2, 4, 3, 6, 9]))
    (1, 0)
    """
    points = levels(frequency)
    stretch = _stretches(points)
    first = np.unique(stretch, return_index=True)[1]
    lengths = np.bincount(stretch)
    same = np.unique(points[first]).size == 1
    return lengths.size - 1 if same and lengths.min() >= _SHORTEST_RUN else 0


def _stretches(points: IntArray) -> IntArray:
    """Number the strictly monotone stretches of a sequence."""
    number = np.zeros(points.size, dtype=np.int64)
    direction = 0
    current = 0
    for i in range(1, points.size):
        step = int(np.sign(points[i] - points[i - 1]))
        if step == 0 or (direction and step != direction):
            current += 1
            direction = 0
        else:
            direction = step
        number[i] = current
    return number


def _occurrence(points: IntArray) -> IntArray:
    """How often the same point has come before."""
    seen: dict[int, int] = {}
    counts = np.empty(points.size, dtype=np.int64)
    for i, point in enumerate(points.tolist()):
        counts[i] = seen[point] = seen.get(point, -1) + 1
    return counts
