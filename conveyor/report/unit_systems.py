"""Tables in another unit system: units in the names of columns or figures, their numbers converted with them."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any, Final

import pandas as pd

from conveyor.errors import InputError
from conveyor.models import Conveyor
from conveyor.units import System, from_si, quantity, unit_label

_UNIT = re.compile(r"^(.*) \[([^\]]*)\]$")
_KINDS: Final = {
    "m": "length",
    "mm": "thickness",
    "N": "force",
    "kW": "power",
    "kg": "mass",
    "kg/m": "line mass",
    "N/m": "line force",
    "MPa": "pressure",
    "m/s": "speed",
    "m/s²": "acceleration",
    "t/h": "mass flow",
    "degC": "temperature",
}
"""What a unit of the tables measures; others (Hz, s, MWh, ratios) are the same in both systems."""
_SPELLED: Final = {"ft/s^2": "ft/s²"}
_DIGITS, _DECIMALS = 12, 9  # beyond them is the rounding of a conversion
_PER_N_MM: Final = "N/mm"


def chosen(conveyor: Conveyor, system: System | None) -> System:
    """Return the system a report is written in: the one asked for, else that of the spec's report.

    Raises
    ------
    InputError
        Neither SI nor US.
    """
    if system is None:
        return conveyor.report.units
    if system not in {"SI", "US"}:
        raise InputError(f'system = "{system}": SI or US, or none for that of the spec (report.units)')
    return system


def converted(frame: pd.DataFrame, system: System) -> pd.DataFrame:
    """Return a table in a unit system: names and numbers of its columns.

    Examples
    --------
    >>> converted(pd.DataFrame({"length [m]": [0.3048], "share [-]": [0.5]}), "US").round(9).to_dict("list")
    {'length [ft]': [1.0], 'share [-]': [0.5]}
    """
    if system == "SI":
        return frame
    columns = [converted_figure(str(name), frame[name].tolist(), system) for name in frame.columns]
    return pd.DataFrame(dict(columns), dtype=object)


def converted_rows(frame: pd.DataFrame, names: str, system: System) -> pd.DataFrame:
    """Return a table in a unit system whose figures are named in a column."""
    if system == "SI":
        return frame
    others = [name for name in frame.columns if name != names]
    rows = []
    for row in frame.to_dict("records"):
        name, values = converted_figure(str(row[names]), [row[other] for other in others], system)
        rows.append({names: name, **dict(zip(others, values, strict=True))})
    return pd.DataFrame(rows, columns=frame.columns, dtype=object)


def converted_figure(name: str, values: list[Any], system: System) -> tuple[str, list[Any]]:
    """Return a figure's name and values in a unit system; text and gaps stay.

    Examples
    --------
    >>> converted_figure("belt temperature [degC]", [20.0, None], "US")
    ('belt temperature [degF]', [68.0, None])
    """
    found = _UNIT.match(name)
    if found is None or system == "SI":
        return name, values
    unit = found[2]
    if unit == _PER_N_MM:
        label, kind, spelled = "lbf/in", "line force", "N/mm"
    elif unit in _KINDS:
        kind, spelled = _KINDS[unit], unit.replace("²", "^2")
        label = unit_label(kind, system)
    else:
        return name, values
    return f"{found[1]} [{_SPELLED.get(label, label)}]", [_value(v, kind, spelled, label) for v in values]


def _value(value: Any, kind: str, unit: str, label: str) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return value
    factor, zero = _scale(kind, unit, label)
    if zero:
        return round(factor * value + zero, _DECIMALS) + 0.0  # a difference of like figures; no -0
    return float(f"{factor * value:.{_DIGITS}g}")


@cache
def _scale(kind: str, unit: str, label: str) -> tuple[float, float]:
    """Factor and zero of one unit in another; the registry is asked once for each pair."""
    to = from_si(1.0, kind, label).units
    zero, one = (float(quantity(f"{number} {unit}", kind).to(to).magnitude) for number in (0, 1))
    return one - zero, zero
