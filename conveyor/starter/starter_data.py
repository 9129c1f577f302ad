"""Values of the starter specs, in both systems of units."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any, Final, Literal, get_args

from ruamel.yaml import YAML

from conveyor.units import System
from conveyor.units.unit_systems import TRADES, trade_of

Kind = Literal["overland", "in-plant", "downhill"]
KINDS: Final[tuple[Kind, ...]] = get_args(Kind)
"""Kinds of conveyor with a starter."""
OPTIONAL: Final = "?"
"""Suffix of the key of a field written as a comment."""
LEFT_OUT: Final = "~"
"""Value of a field left out in a system of units."""


@cache
def read_values(name: str) -> dict[str, Any]:
    """Read a file of this folder."""
    content = files("conveyor.starter").joinpath(name).read_text(encoding="utf-8")
    read: dict[str, Any] = YAML(typ="safe", pure=True).load(content)
    return read


def starter_values(kind: Kind | Literal["duty"], units: System = "SI", *, optional: bool = False) -> dict[str, Any]:
    """Return the plain data of a starter.

    Parameters
    ----------
    kind : {"overland", "in-plant", "downhill", "duty"}
        Conveyor; or the duty of one that is to be sized.
    units : {"SI", "US"}
        System of units.
    optional : bool
        Include the fields that the spec shows as comments.

    Examples
    --------
    >>> starter_values("in-plant", "US")["belt"]["width"]
    '42 in'
    """
    given: dict[str, Any] = _plain_values(read_values(f"{kind}.yaml"), units, optional=optional)
    if "units" in given.get("report", {}):
        given["report"]["units"] = units  # the values are those of its trade
    return given


def _plain_values(value: Any, units: System, *, optional: bool) -> Any:
    if isinstance(value, Mapping):
        return {
            key.removesuffix(OPTIONAL): _plain_values(item, units, optional=optional)
            for key, item in value.items()
            if (optional or not key.endswith(OPTIONAL)) and in_units(item, units) != LEFT_OUT
        }
    if isinstance(value, list):
        return [_plain_values(item, units, optional=optional) for item in value]
    return in_units(value, units)


def in_units(value: Any, units: System) -> Any:
    """Value of a system of units from ``SI | US``."""
    if not isinstance(value, str) or " | " not in value:
        return value
    chosen = value.split(" | ")[TRADES.index(trade_of(units))]
    return chosen.strip("[]").split(", ") if chosen.startswith("[") else chosen
