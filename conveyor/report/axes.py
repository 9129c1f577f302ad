"""The scale of an axis in a system of units: kN and MPa where tables have N and m, lbf and psi in US units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from conveyor.figures import ZERO_CELSIUS
from conveyor.units import System, convert, unit_label

_SI: Final = {
    "force": ("kN", 1e3),
    "power": ("kW", 1e3),
    "pressure": ("MPa", 1e6),
    "thickness": ("mm", 1e-3),
    "length": ("m", 1.0),
    "speed": ("m/s", 1.0),
    "line force": ("N/m", 1.0),
}
"""Units of SI figures and what one of each is in SI."""
_DIGITS: Final = 9  # beyond them is the rounding of 273.15


@dataclass(frozen=True)
class Scale:
    """An axis: its unit, and the value it shows for an SI value, factor * value + offset."""

    unit: str
    factor: float
    offset: float = 0.0

    def __call__(self, values: ArrayLike) -> Any:
        """Values on the axis, of SI values."""
        scaled = np.asarray(values, dtype=float) * self.factor
        return scaled if self.offset == 0.0 else np.round(scaled + self.offset, _DIGITS)


def scale(kind: str, system: System = "SI") -> Scale:
    """Return the scale of a kind of quantity.

    Examples
    --------
    >>> scale("force").unit, float(scale("force")(2500.0)), float(scale("temperature", "US")(293.15))
    ('kN', 2.5, 68.0)
    """
    if system == "SI":
        if kind == "temperature":
            return Scale("°C", 1.0, -ZERO_CELSIUS)
        unit, one = _SI[kind]
        return Scale(unit, 1.0 / one)
    zero = convert(0.0, kind, system)
    unit = unit_label(kind, system).replace("degF", "°F")
    return Scale(unit, convert(1.0, kind, system) - zero, zero)
