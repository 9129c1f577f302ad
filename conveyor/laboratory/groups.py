"""Group rows by temperature, set point and run."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from conveyor.laboratory.dma_data import ISOTHERM_DRIFT, FloatArray, IntArray

ISOTHERM_GAP: Final = 0.8
"""Temperatures further apart than this are different isotherms [K]: steps are 1 K or more, furnaces hold 0.5 K
(general knowledge)."""
SAME_SET_POINT: Final = 5e-3
"""Frequencies or strains this close, relatively, are one set point; instruments set 10 a decade (26 % apart)."""
_SHORTEST_RUN: Final = 3
_SHORTEST_OTHER_RUN: Final = 5
"""Rows in no order rarely fall into rising or falling stretches of five: ten rows in 4/(5! 5!) of all orders."""


def temperature_groups(temperature: FloatArray, run: IntArray | None) -> IntArray | None:
    """Number the isotherms of a file by ascending temperature [K]; None if the temperature is a ramp.

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
        if run is not None and np.ptp(temperature[rows]) <= ISOTHERM_DRIFT:
            members.append(rows)
        else:
            members += np.split(rows, np.flatnonzero(np.diff(temperature[rows]) > ISOTHERM_GAP) + 1)
    if any(np.ptp(temperature[rows]) > ISOTHERM_DRIFT for rows in members):
        return None
    members.sort(key=lambda rows: float(np.mean(temperature[rows])))
    group = np.empty(temperature.size, dtype=np.int64)
    for number, rows in enumerate(members):
        group[rows] = number
    return group


def set_points(values: FloatArray) -> IntArray:
    """Number the set points of a frequency or strain in ascending order.

    Examples
    --------
    >>> set_points(np.array([10.0, 1.0, 10.01]))
    array([1, 0, 1])
    """
    return _cluster_numbers(np.log(values), SAME_SET_POINT)


def _cluster_numbers(values: FloatArray, gap: float) -> IntArray:
    order = np.argsort(values, kind="stable")
    members = np.empty(values.size, dtype=np.int64)
    members[order] = np.concatenate([[0], np.cumsum(np.diff(values[order]) > gap)])
    return members


def duplicate_runs(values: FloatArray, group: IntArray, *, tolerance: float, merged: bool = False) -> IntArray | None:
    """Number the run of each row within its group; None without repeats.

    Notes
    -----
    If the rows of a group fall into stretches of three or more (five if no set point comes back), each rising
    or falling, and at least half of each lies inside the range of the one before (`merged`, rows of shifted isotherms
    whose ranges overlap without being repeats: on its set points), every stretch is a run: up and down, or one sweep
    after the other. Else the second row at one set point (within the tolerance) begins the second run: two runs sorted
    into each other, or a repeated point.

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
        points = _cluster_numbers(values[rows], tolerance)
        stretch = _monotone_stretches(points)
        repeats = np.unique(points).size < rows.size
        shortest = _SHORTEST_RUN if repeats else _SHORTEST_OTHER_RUN
        parts = np.split(points if merged else values[rows], np.flatnonzero(np.diff(stretch)) + 1)
        run[rows] = stretch if _is_swept_again(parts, shortest, exactly=merged) else _occurrence_counts(points)
    return run if run.any() else None


def _is_swept_again(parts: Sequence[NDArray[Any]], shortest: int, *, exactly: bool) -> bool:
    """True if stretches are long enough, and each lies at least half on (or within) the one before."""
    if len(parts) < 2 or min(part.size for part in parts) < shortest:
        return False
    return all(
        2 * int(np.sum(np.isin(b, a) if exactly else (b >= a.min()) & (b <= a.max()))) >= b.size
        for a, b in pairwise(parts)
    )


def sweep_restarts(frequency: FloatArray) -> bool:
    """True if the frequency sweep restarts in the order of the file; False for unordered rows.

    Examples
    --------
    >>> sweep_restarts(np.array([1.0, 2, 4, 1, 2, 4])), sweep_restarts(np.array([1.0, 2, 4, 3, 6, 9]))
    (True, False)
    """
    points = set_points(frequency)
    stretch = _monotone_stretches(points)
    first = np.unique(stretch, return_index=True)[1]
    same = np.unique(points[first]).size == 1
    return bool(same and first.size > 1 and np.bincount(stretch).min() >= _SHORTEST_RUN)


def _monotone_stretches(points: IntArray) -> IntArray:
    """Number the strictly monotone stretches of a sequence."""
    number = np.zeros(points.size, dtype=np.int64)
    direction = 0
    current = 0
    for i, step in enumerate(np.sign(np.diff(points)).tolist(), start=1):
        if step == 0 or (direction and step != direction):
            current += 1
            direction = 0
        else:
            direction = step
        number[i] = current
    return number


def _occurrence_counts(points: IntArray) -> IntArray:
    """Number of earlier occurrences of each point."""
    seen: dict[int, int] = {}
    counts = np.empty(points.size, dtype=np.int64)
    for i, point in enumerate(points.tolist()):
        counts[i] = seen[point] = seen.get(point, -1) + 1
    return counts
