"""Rows in order: by temperature, run and the swept quantity, with duplicate runs told apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from conveyor.laboratory.groups import (
    SAME_REDUCED_FREQUENCY,
    SAME_SET_POINT,
    SAME_TEMPERATURE,
    duplicate_runs,
    levels,
    temperature_groups,
)
from conveyor.laboratory.table import FloatArray, IntArray

SWEPT = {
    "master curve": "frequency",
    "isotherms": "frequency",
    "temperature sweep": "temperature",
    "strain sweep": "strain",
    "relaxation": "time",
    "shift factors": "temperature",
    "Prony series": "tau",
}
"""The quantity each kind sweeps."""


@dataclass(frozen=True)
class Arrangement:
    """Order of the rows; group and run are in the order of the file."""

    order: IntArray
    group: IntArray | None
    run: IntArray | None
    duplicates: IntArray | None


def arrange(kind: str, columns: dict[str, FloatArray], labels: IntArray | None) -> Arrangement:
    """Group, tell apart and sort.

    Parameters
    ----------
    kind : str
        One of `KINDS` [-].
    columns : dict of numpy.ndarray
        By quantity, SI, each of shape `(n,)` [unit].
    labels : numpy.ndarray or None
        Labels of a run column, shape `(n,)` [-].

    Returns
    -------
    Arrangement
        With the duplicate runs found inside one group and label [-].

    Examples
    --------
    >>> f = np.array([10.0, 1.0, 10.0])
    >>> found = arrange("master curve", {"frequency": f}, None)
    >>> found.order, found.run
    (array([1, 0, 2]), array([0, 0, 1]))
    """
    swept = columns[SWEPT[kind]]
    group = _group(kind, columns, labels)
    condition = np.zeros(swept.size, dtype=np.int64) if group is None else group
    if labels is not None:
        condition = np.unique(np.stack([condition, labels]), axis=1, return_inverse=True)[1].reshape(-1)
    if SWEPT[kind] == "temperature":
        duplicates = duplicate_runs(swept, condition, tolerance=SAME_TEMPERATURE)
    else:
        merged = kind == "master curve"
        tolerance = SAME_REDUCED_FREQUENCY if merged else SAME_SET_POINT
        duplicates = duplicate_runs(np.log(swept), condition, tolerance=tolerance, merged=merged)
    run = labels if labels is not None else duplicates
    again = np.zeros(swept.size) if duplicates is None else duplicates
    first = condition if group is None else group
    second = np.zeros(swept.size) if run is None else run
    return Arrangement(np.lexsort((swept, again, second, first)), group, run, duplicates)


def _group(kind: str, columns: dict[str, FloatArray], labels: IntArray | None) -> IntArray | None:
    """Conditions under which one sweep was made; None for a ramp whose rows form none."""
    temperature, frequency = columns.get("temperature"), columns.get("frequency")
    size = columns[SWEPT[kind]].size
    single = np.zeros(size, dtype=np.int64)
    if kind in {"relaxation", "shift factors", "master curve", "Prony series"}:
        return single
    if kind == "temperature sweep":
        return single if frequency is None else levels(frequency)
    group = single if temperature is None else temperature_groups(temperature, labels)
    if group is None or kind == "isotherms" or frequency is None:
        return group
    pairs = np.unique(np.stack([group, levels(frequency)]), axis=1, return_inverse=True)[1]
    return pairs.reshape(-1).astype(np.int64)
