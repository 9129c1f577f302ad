"""Which measurement a table is: from its columns and from what varies in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from conveyor.laboratory.groups import levels, restarts, temperature_groups
from conveyor.laboratory.table import FloatArray, IntArray

STRAIN_SPAN = 2.0
"""A strain sweep spans more than this factor; a frequency sweep at constant force varies less [-]."""

NEEDS = {
    "master curve": ("frequency", "storage", "loss"),
    "isotherms": ("frequency", "temperature", "storage", "loss"),
    "temperature sweep": ("temperature", "storage", "loss"),
    "strain sweep": ("strain", "storage", "loss"),
    "relaxation": ("time", "modulus"),
    "shift factors": ("temperature", "log10_a_T"),
    "Prony series": ("tau", "term"),
}
"""Columns each kind cannot do without."""


@dataclass(frozen=True)
class Decision:
    """The kind and its reason, or an empty kind and what leaves it open."""

    kind: str
    reason: str


def possible_kinds(present: set[str]) -> list[str]:
    """Kinds whose columns are there.

    Parameters
    ----------
    present : set of str
        Quantities of the file [-].

    Returns
    -------
    list of str
        In the order of `NEEDS` [-].

    Examples
    --------
    >>> possible_kinds({"time", "modulus"})
    ['relaxation']
    """
    return [kind for kind, needs in NEEDS.items() if set(needs) <= present]


def decide(columns: dict[str, FloatArray], run: IntArray | None, *, reduced: bool) -> Decision:
    """Kind of a table, certain or not at all.

    Parameters
    ----------
    columns : dict of numpy.ndarray
        By quantity, SI, each of shape `(n,)` [unit].
    run : numpy.ndarray or None
        Labels of a run column, shape `(n,)` [-].
    reduced : bool
        The frequency is named a reduced one [-].

    Returns
    -------
    Decision
        With an empty kind if several are possible [-].

    Examples
    --------
    >>> f = np.array([1.0, 10.0])
    >>> decide({"frequency": f, "storage": 1e6 * f, "loss": 1e5 * f}, None, reduced=False).kind
    'master curve'
    """
    kinds = possible_kinds(set(columns))
    if not {"storage", "loss"} <= set(columns):
        only = kinds[0] if len(kinds) == 1 else ""
        return Decision(only, " and ".join(NEEDS[only]) if only else "")
    if {"relaxation", "shift factors"} & set(kinds):
        return Decision(
            "", "dynamic moduli stand beside " + ("E(t)" if "relaxation" in kinds else "shift factors")
        )
    if reduced:
        return Decision("master curve", "its frequency is a reduced one")
    return _dynamic(columns, run)


def _dynamic(columns: dict[str, FloatArray], run: IntArray | None) -> Decision:
    temperature, frequency, strain = (columns.get(q) for q in ("temperature", "frequency", "strain"))
    size = columns["storage"].size
    group: IntArray | None = np.zeros(size, dtype=np.int64)
    if temperature is not None:
        group = temperature_groups(temperature, run)
    level = np.zeros(size, dtype=np.int64) if frequency is None else levels(frequency)
    swept = 0 if group is None else sum(np.unique(level[group == g]).size > 1 for g in np.unique(group))
    strained = strain is not None and float(strain.max() / strain.min()) > STRAIN_SPAN
    if strained:
        if swept or group is None:
            return Decision("", "the strain varies together with frequency or temperature")
        return Decision("strain sweep", "the strain varies, the frequency does not at any temperature")
    if group is None:
        return Decision("temperature sweep", "the temperature is a ramp")
    temperatures = 1 if temperature is None else np.unique(group[:, None], axis=0).size
    if temperature is not None and run is not None:
        temperatures = int(np.unique(_whole_groups(temperature)).size)
    restarted = temperature is None and frequency is not None and restarts(frequency) > 0
    return _stepped(size, temperatures, swept, has_frequency=frequency is not None, restarted=restarted)


def _whole_groups(temperature: FloatArray) -> IntArray:
    """Groups without regard to runs; rows of a ramp count as one each."""
    found = temperature_groups(temperature, None)
    return np.arange(temperature.size, dtype=np.int64) if found is None else found


def _stepped(size: int, temperatures: int, swept: int, *, has_frequency: bool, restarted: bool) -> Decision:
    if temperatures > 1:
        if swept > 1:
            return Decision("isotherms", f"the frequency varies at {swept} temperatures")
        if swept == 0:
            return Decision("temperature sweep", "the temperature varies, the frequency does not")
        return Decision("", "the frequency varies at one temperature only, yet there are several")
    if has_frequency and restarted:
        return Decision(
            "",
            "the frequencies begin anew, as isotherms do, but there is no temperature; add a column temperature_degC,"
            " or for repeats at one temperature give temperature (--temperature)",
        )
    if has_frequency and (swept or size == 1):
        return Decision("master curve", "the frequency varies at one temperature (also: one frequency sweep)")
    return Decision("", "neither frequency, temperature nor strain varies")
