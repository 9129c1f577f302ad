"""Ranges and defaults of fields in the unit that a reader writes the field in."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Final

from conveyor.forms.layout import Leaf
from conveyor.units import KINDS, System, quantity, text

_BOUND: Final = re.compile(r"([<>≤≥]) ([^ ,]+ [^ ,]+)")
_DIGITS: Final = 3
_SMALL: Final = 5.0
"""Lengths whose limit is not beyond this are of parts, in inches in the US [m]."""


def limits_like(allowed: str, value: Any) -> str:
    """Write ranges in the unit of a value as specs hold it, to three digits rounded inwards: what is said is allowed.

    Examples
    --------
    >>> limits_like("> 0 m, ≤ 5 m", "42 in"), limits_like("> 0, ≤ 1", 0.35)
    ('> 0 in, ≤ 196 in', '> 0, ≤ 1')
    """
    return _BOUND.sub(lambda match: _limit(match, value), allowed)


def _limit(match: re.Match[str], value: Any) -> str:
    limit = like(match[2], value)
    if limit is None or limit[1] == match[2].split(" ")[1]:
        return match[0]
    number, unit = limit
    digits = _DIGITS - 1 - (math.floor(math.log10(abs(number))) if number else 0)
    towards = math.ceil if match[1] in ">≥" else math.floor
    near = round(number, digits)  # of 19999.999999999996 the 20000 that is meant
    inward = (
        near if math.isclose(near, number, rel_tol=1e-9) else towards(number * 10.0**digits) / 10.0**digits
    )
    return f"{match[1]} {_plain_number(inward)} {unit}"


def like(given: str, value: Any) -> tuple[float, str] | None:
    """Return the number and the unit of a quantity, in the unit of another where both are quantities."""
    value = value[0] if isinstance(value, list) and value else value
    if not isinstance(value, str) or len(value.split(" ")) != 2:
        return None
    other = quantity(value)
    unit = text(other).split(" ")[1]
    return float(quantity(given).to(other.units).magnitude), unit


def _plain_number(number: float) -> str:
    return f"{number:.0f}" if abs(number) >= 10.0**_DIGITS else f"{number:.4g}"


def in_system(leaf: Leaf, system: System, units: Iterable[str | None] = ()) -> Leaf:
    """Return a field with its range, its default and its first unit in a system; `units` are those filled in."""
    of = leaf.item if leaf.kind == "list" and leaf.item is not None else leaf
    if system == "SI" or of.kind != "quantity" or not of.units or not of.measure:
        return leaf
    unit = next(filter(None, units), None) or _unit_in_us(of)
    if not unit:
        return leaf
    value = f"1 {unit}"
    default = leaf.default
    if isinstance(default, str) and (known := like(default, value)) is not None:
        default = f"{known[0]:.4g} {unit}"
    first = tuple(dict.fromkeys((unit, *leaf.units))) if leaf.units else ()
    return replace(leaf, allowed=limits_like(leaf.allowed, value), default=default, units=first)


def _unit_in_us(leaf: Leaf) -> str:
    """Unit of reports of the kind; of lengths of parts the inch."""
    if leaf.measure == "length":
        largest = [limit for sign, limit in _BOUND.findall(leaf.allowed) if sign in "<≤"]
        if largest and all(quantity(limit).to("m").magnitude <= _SMALL for limit in largest):
            return KINDS["thickness"].us
    return KINDS[leaf.measure].us
