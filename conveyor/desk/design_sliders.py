"""The fields that are moved most, chosen by the kind of conveyor, with their range and steps."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Final, Literal, TypeAlias

from conveyor.desk.design_form import DesignField, field_label
from conveyor.files.libraries import ROLL_DIAMETERS, library_entries
from conveyor.models import Conveyor
from conveyor.starter.format_reference import format_fields

ConveyorKind: TypeAlias = Literal["overland", "in-plant", "downhill", "pipe", "feeder"]

SLIDERS: Final = 6
"""Sliders of a page."""
CURVE_POINTS: Final = 9
"""Values at which the curve below a slider is calculated."""
_LOW, _HIGH = 0.6, 1.4
"""Range of a slider, of the value in the file."""
_KELVINS: Final = 25.0
"""Range of a temperature, either way [K]."""
_STEPS: Final = 80
"""Steps of a slider, at least."""
_OVERLAND: Final = 1000.0
"""Length from which a conveyor counts as overland [m]."""

_COVERS: Final = "belt.bottom_cover.thickness"
_HOPPER: Final = "route.feeding.hopper."
_FIRST: Final[Mapping[ConveyorKind, tuple[str, ...]]] = {
    "overland": ("belt.speed", "idlers.carry.spacing", _COVERS, "ambient.belt_temperature", "ambient.temperature",
                 "material.flow", "idlers.carry.roll.diameter"),
    "in-plant": ("belt.speed", "material.flow", "idlers.carry.spacing", "ambient.belt_temperature",
                 "ambient.temperature", _COVERS, "drive.start_factor"),
    "downhill": ("belt.speed", "material.flow", "idlers.carry.spacing", "ambient.belt_temperature",
                 "ambient.temperature", "drive.start_factor", "idlers.carry.roll.diameter"),
    "pipe": ("belt.speed", "material.flow", "idlers.carry.spacing", "belt.transverse_stiffness",
             "idlers.carry.pipe.forming_load", "ambient.belt_temperature", "ambient.temperature", _COVERS),
    "feeder": ("belt.speed", "material.flow", _HOPPER + "gate_height", _HOPPER + "outlet_length",
               _HOPPER + "outlet_width", _HOPPER + "top_width", "drive.start_factor"),
}  # fmt: skip
"""Fields in order; those that a spec does not give are passed over."""
_FURTHER: Final = ("idlers.return.spacing", "drive.wrap_angle", "drive.friction", "drive.efficiency", _COVERS)
_NUMBER: Final = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_BOUND: Final = re.compile(r"([≥≤]) ([+-]?[\d.]+(?:e[+-]?\d+)?)([^,]*)")
_SPANS: Final = {"degC": _KELVINS, "°C": _KELVINS, "K": _KELVINS, "degF": 1.8 * _KELVINS, "°F": 1.8 * _KELVINS}


@dataclass(frozen=True)
class Slider:
    """A field with the range it is moved over.

    Attributes
    ----------
    path, label, unit : str
        Field, words for it, unit as the file has it.
    value, low, high, step : float
        Numbers in this unit.
    series : tuple of float
        Values of a series that it steps through; empty for any.
    """

    path: str
    label: str
    unit: str
    value: float
    low: float
    high: float
    step: float
    series: tuple[float, ...] = ()

    def text(self, number: float) -> str:
        """Value as a spec writes it."""
        return f"{number:.6g} {self.unit}".rstrip()

    def curve_values(self) -> tuple[float, ...]:
        """Values at which its curve is calculated."""
        if self.series:
            return self.series
        gap = (self.high - self.low) / (CURVE_POINTS - 1)
        return tuple(float(f"{self.low + i * gap:.6g}") for i in range(CURVE_POINTS))

    def plain(self) -> dict[str, Any]:
        """The slider as plain data for the page."""
        return {key: list(value) if isinstance(value, tuple) else value for key, value in vars(self).items()}


def conveyor_kind(conveyor: Conveyor) -> ConveyorKind:
    """Kind of a conveyor: by its hopper or pipe, else downhill where it falls, overland from a kilometre on."""
    if conveyor.route.feeding is not None and conveyor.route.feeding.hopper is not None:
        return "feeder"
    if conveyor.idlers.carry.shape.closed:
        return "pipe"
    if conveyor.route.rise < 0.0:
        return "downhill"
    return "overland" if conveyor.route.length >= _OVERLAND else "in-plant"


def choose_sliders(conveyor: Conveyor, rows: Iterable[DesignField]) -> tuple[Slider, ...]:
    """Sliders of a conveyor: the fields of its kind that the spec gives, at most `SLIDERS`."""
    values = {row.path: row.value for row in rows if row.given_by in {"spec", "library"}}
    order = dict.fromkeys((*_FIRST[conveyor_kind(conveyor)], *_FURTHER))
    if "ambient.belt_temperature" in values:
        order.pop("ambient.temperature", None)
    made = (field_slider(path, values[path]) for path in order if path in values)
    return tuple(slider for slider in made if slider is not None)[:SLIDERS]


def field_slider(path: str, value: str | None) -> Slider | None:
    """Slider of a field about its value; None for one that is no single number other than zero.

    Examples
    --------
    >>> slider = field_slider("belt.speed", "5 m/s")
    >>> slider.low, slider.high, slider.step, slider.unit
    (3.0, 7.0, 0.05, 'm/s')
    """
    found = _NUMBER.fullmatch(value or "")
    if found is None or not math.isfinite(number := float(found[1])):
        return None
    unit = found[2]
    series = _series_values(path, unit)
    span = _SPANS.get(unit) if "temperature" in path else None
    low, high = (number - span, number + span) if span is not None else (_LOW * number, _HIGH * number)
    if low >= high:
        return None
    least, most = _allowed_ends(path, unit)
    low, high = max(low, least), min(high, most)
    if low >= high:
        return None
    step = _round_step((high - low) / _STEPS)
    if series:
        near = tuple(one for one in series if low <= one <= high)
        series = near if len(near) > 1 and number in near else ()
    if series:
        low, high = series[0], series[-1]
    else:
        low, high = (float(f"{math.floor(end / step + 0.5) * step:.9g}") for end in (low, high))
    return Slider(path, field_label(path), unit, number, low, high, step, series)


def _allowed_ends(path: str, unit: str) -> tuple[float, float]:
    """Allowed range of a field as far as it is written in a unit; a bound that is excluded counts as none."""
    field = format_fields(Conveyor).get(re.sub(r"\[\d+\]", "[]", path))
    ends = {"≥": -math.inf, "≤": math.inf}
    for sign, number, of in _BOUND.findall("" if field is None else field.allowed):
        if of.strip() == unit:
            ends[sign] = float(number)
    return ends["≥"], ends["≤"]


def _round_step(least: float) -> float:
    """Largest of 1, 2, 5 times a power of ten up to a step."""
    power = 10.0 ** math.floor(math.log10(least))
    return float(f"{max(m for m in (1.0, 2.0, 5.0) if m * power <= least * (1.0 + 1e-9)) * power:.9g}")


@cache
def _series_values(path: str, unit: str) -> tuple[float, ...]:
    """Values that a field has in the trade, in a unit; none where there is no series."""
    if path.endswith("roll.diameter") and unit == "mm":
        return tuple(map(float, ROLL_DIAMETERS))
    if path == "belt.width":
        listed = library_entries("sizes_us" if unit in {"in", "inch"} else "sizes")["belt widths"].fields["widths"]
        texts = (_NUMBER.fullmatch(row["belt"]) for row in listed)
        return tuple(float(text[1]) for text in texts if text is not None and text[2] == unit)
    return ()
