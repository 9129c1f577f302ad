"""Isotherms from a slow ramp with several frequencies, interpolated to common temperatures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from conveyor.laboratory.dma_data import FloatArray, IntArray
from conveyor.laboratory.groups import set_points
from conveyor.rubber.monotone import MonotoneCubic

LEAST_FREQUENCIES: Final = 3
"""Least frequencies of an isotherm that can be shifted."""
FEWEST_TEMPERATURES: Final = 4
"""Least temperatures of each frequency for a cubic interpolation."""
LARGEST_STEP: Final = 5.0
"""Largest step between rows of a frequency: over 5 K near the glass transition a cubic in ln E' is some per cent off
(general knowledge) [K]."""
_INTERPOLATED_COLUMNS: Final = ("storage", "loss")


class RampIsotherms(NamedTuple):
    """Isotherms of a ramp: nearest rows, columns, group numbers and a note."""

    rows: IntArray
    columns: dict[str, FloatArray]
    group: IntArray
    note: str


def isotherms_of_ramp(columns: Mapping[str, FloatArray]) -> RampIsotherms | None:
    """Isotherms of a ramp at several frequencies; None if the rows are no such ramp.

    Notes
    -----
    While an instrument goes through its frequencies the temperature goes on. So rows of one cycle differ in
    temperature, by a kelvin or two, which near the glass transition is as much as a tenth of a decade. Here ln E' and
    ln E'' of each frequency, monotone cubics over its own temperatures, are taken at those of the middle frequency;
    none is taken beyond the temperatures of any.

    Examples
    --------
    >>> f, t = np.tile([1.0, 10.0, 100.0], 5), np.arange(15.0) + 273.0
    >>> made = isotherms_of_ramp({"frequency": f, "temperature": t, "storage": np.exp(-t), "loss": np.exp(-t)})
    >>> made.columns["temperature"].tolist()[::3], made.group.tolist()[:6]
    ([277.0, 280.0, 283.0], [0, 0, 0, 1, 1, 1])
    """
    if not {"frequency", "temperature", *_INTERPOLATED_COLUMNS} <= columns.keys():
        return None
    temperature, level = columns["temperature"], set_points(columns["frequency"])
    sweeps = []
    for each in np.unique(level):
        rows = np.flatnonzero(level == each)
        sweeps.append(rows[np.argsort(temperature[rows], kind="stable")])
    if len(sweeps) < LEAST_FREQUENCIES or min(rows.size for rows in sweeps) < FEWEST_TEMPERATURES:
        return None
    steps = [np.diff(temperature[rows]) for rows in sweeps]
    if min(float(step.min()) for step in steps) <= 0.0 or max(float(step.max()) for step in steps) > LARGEST_STEP:
        return None
    middle = sorted(sweeps, key=lambda rows: float(np.mean(temperature[rows])))[len(sweeps) // 2]
    low = max(float(temperature[rows[0]]) for rows in sweeps)
    high = min(float(temperature[rows[-1]]) for rows in sweeps)
    at = temperature[middle]
    at = at[(at >= low) & (at <= high)]
    if at.size < 2:
        return None
    made: dict[str, list[FloatArray]] = {name: [] for name in columns}
    taken: list[IntArray] = []
    for rows in sweeps:
        nearest = rows[np.argmin(np.abs(temperature[rows][:, None] - at), axis=0)]
        taken.append(nearest)
        for name, values in columns.items():
            moved = values[nearest]
            if name in _INTERPOLATED_COLUMNS:
                moved = np.exp(MonotoneCubic(temperature[rows], np.log(values[rows]))(at))
            made[name].append(at if name == "temperature" else moved)
    group = np.tile(np.arange(at.size, dtype=np.int64), len(sweeps))
    order = np.argsort(group, kind="stable")
    drift = float(np.max(np.abs(temperature[np.concatenate(taken)] - np.tile(at, len(sweeps)))))
    note = (
        f"a ramp with {len(sweeps)} frequencies at each temperature: {at.size} isotherms, E' and E'' of each frequency"
        f" interpolated over at most {drift:.2g} K to the temperatures of the middle one"
    )
    joined = {name: np.concatenate(parts)[order] for name, parts in made.items()}
    return RampIsotherms(np.concatenate(taken)[order], joined, group[order], note)
