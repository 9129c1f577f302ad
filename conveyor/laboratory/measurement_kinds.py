"""Kind of measurement of a table, by its columns and what varies in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from conveyor.laboratory.dma_data import FloatArray, IntArray
from conveyor.laboratory.groups import set_points, sweep_restarts, temperature_groups

STRAIN_SPAN: Final = 2.0
"""A strain sweep spans more than this factor; a frequency sweep at constant force varies less [-]."""
UNLIKE_RATIO: Final = 1.5
"""Largest ratio of E' between repeats: specimens scatter by some 20 %, as does a drift of 1 K at the glass transition
(general knowledge) [-]."""
NEEDED_COLUMNS: Final = {
    "master curve": ("frequency", "storage", "loss"),
    "isotherms": ("frequency", "temperature", "storage", "loss"),
    "temperature sweep": ("temperature", "storage", "loss"),
    "strain sweep": ("strain", "storage", "loss"),
    "relaxation": ("time", "modulus"),
    "shift factors": ("temperature", "log10_a_T"),
    "Prony series": ("tau", "term"),
}
"""Columns required by each kind, the swept quantity first."""


def possible_kinds(present: set[str]) -> list[str]:
    """Kinds whose required columns are present.

    Examples
    --------
    >>> possible_kinds({"time", "modulus"})
    ['relaxation']
    """
    return [kind for kind, needs in NEEDED_COLUMNS.items() if set(needs) <= present]


def decide_kind(columns: Mapping[str, FloatArray], run: IntArray | None, *, reduced: bool) -> tuple[str, str]:
    """Kind of a table and the reason; if undecided "" and the ambiguity.

    Examples
    --------
    >>> f = np.array([1.0, 10.0])
    >>> decide_kind({"frequency": f, "storage": 1e6 * f, "loss": 1e5 * f}, None, reduced=False)[0]
    'master curve'
    """
    kinds = possible_kinds(set(columns))
    if "Prony series" in kinds:
        return "Prony series", "relaxation times with their moduli or shares"
    if not {"storage", "loss"} <= set(columns):
        return (kinds[0], " and ".join(NEEDED_COLUMNS[kinds[0]])) if len(kinds) == 1 else ("", "several kinds fit")
    for kind, what in (("relaxation", "E(t)"), ("shift factors", "shift factors")):
        if kind in kinds:
            return "", f"dynamic moduli stand beside {what}"
    if reduced:
        return "master curve", "its frequency is a reduced one"
    return _dynamic_kind(columns, run)


def _dynamic_kind(columns: Mapping[str, FloatArray], run: IntArray | None) -> tuple[str, str]:
    temperature, frequency, strain = (columns.get(q) for q in ("temperature", "frequency", "strain"))
    single = np.zeros(columns["storage"].size, dtype=np.int64)
    group = single if temperature is None else temperature_groups(temperature, run)
    level = single if frequency is None else set_points(frequency)
    swept = 0 if group is None else sum(np.unique(level[group == g]).size > 1 for g in np.unique(group))
    if strain is not None and float(strain.max() / strain.min()) > STRAIN_SPAN:
        if swept or group is None:
            return "", "the strain varies together with frequency or temperature"
        return "strain sweep", "the strain varies, the frequency does not at any temperature"
    if group is None:
        return "temperature sweep", "the temperature is a ramp"
    if _temperature_count(temperature, group, run) > 1:
        unlike = _unlike_repeats(columns["storage"], group, level)
        return ("", unlike) if unlike else _stepped_kind(swept)
    rows = np.column_stack(list(columns.values()))
    repeated = rows.shape[0] - np.unique(rows, axis=0).shape[0]
    return _isothermal_kind(frequency, swept, unknown=temperature is None, repeated=repeated)


def _unlike_repeats(storage: FloatArray, group: IntArray, level: IntArray) -> str:
    """Message on rows of one temperature, run and frequency whose E' differ by more than specimens do, or ""."""
    order = np.lexsort((np.log(storage), level, group))
    first = np.flatnonzero(np.diff(group[order], prepend=-1) | np.diff(level[order], prepend=-1))
    last = np.append(first[1:], storage.size) - 1
    spread = float(np.max(np.log(storage[order[last]] / storage[order[first]])))
    if spread <= np.log(UNLIKE_RATIO):
        return ""
    return (
        f"E' differs by a factor of {np.exp(spread):.2g} at one temperature and frequency: does the strain vary? Name"
        " its column 'strain [%]'; export what else varies into files of its own"
    )


def _isothermal_kind(frequency: FloatArray | None, swept: int, *, unknown: bool, repeated: int) -> tuple[str, str]:
    """Kind and reason at one temperature, which may be unknown."""
    if unknown and frequency is not None and sweep_restarts(frequency):
        same = f"{repeated} row(s) repeat earlier ones digit for digit: delete them; else " if repeated else ""
        return "", (
            f"{same}the frequencies begin anew, as isotherms do, but there is no temperature; add a column"
            " temperature_degC, or for repeats at one temperature give temperature (--temperature)"
        )
    if frequency is not None and (swept or frequency.size == 1):
        return "master curve", "the frequency varies at one temperature (also: one frequency sweep)"
    return "", "neither frequency, temperature nor strain varies"


def _temperature_count(temperature: FloatArray | None, group: IntArray, run: IntArray | None) -> int:
    """Number of temperatures, regardless of runs; rows of a ramp count as one each."""
    if temperature is not None and run is not None:
        whole = temperature_groups(temperature, None)
        return temperature.size if whole is None else int(np.unique(whole).size)
    return int(np.unique(group).size)


def _stepped_kind(swept: int) -> tuple[str, str]:
    """Kind and reason at several temperatures, at `swept` of which the frequency varies."""
    if swept > 1:
        return "isotherms", f"the frequency varies at {swept} temperatures"
    if swept == 0:
        return "temperature sweep", "the temperature varies, the frequency does not"
    return "", "the frequency varies at one temperature only, yet there are several"
