"""Drive train between mains and belt: efficiencies of its parts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Final, Literal

from conveyor.errors import SpecError
from conveyor.models.base import Model, Name
from conveyor.units import Bounds, Fraction, quantity, si

PRODUCT_TOLERANCE: Final = 1e-9
"""Tolerance of a product of efficiencies typed as decimals."""
_PRODUCT_DIGITS: Final = 12  # of a product of decimals


class DrivePart(Model):
    """A part of the drive train."""

    name: Name
    """Such as motor, converter, coupling, gear."""
    efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")]
    """Power out over power in."""
    side: Literal["belt", "mains"] = "belt"
    """Between motor shaft and belt (coupling, gear), or between mains and motor shaft (converter, motor itself)."""


def train_efficiency(parts: Iterable[DrivePart], side: str) -> float:
    """Efficiency of all parts of a side, "mains" or "belt" [-]; 1 without any."""
    return math.prod(si(part.efficiency) for part in parts if part.side == side)


def with_efficiency(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Fill in the efficiency from motor shaft to belt from the train's parts, where only those are given."""
    given = data.get("train")
    if data.get("efficiency") is not None or not isinstance(given, list | tuple) or not given:
        return data
    try:
        parts = [DrivePart.model_validate(part) for part in given]
    except SpecError:
        return data  # refused at the field itself
    return {
        **data,
        "efficiency": quantity(round(train_efficiency(parts, "belt"), _PRODUCT_DIGITS), "fraction"),
    }
