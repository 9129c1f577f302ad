"""Every field of a conveyor as a row: as entered, and in SI."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from conveyor.models import Conveyor, Model, RubberCompound
from conveyor.models.base import field_path
from conveyor.units import is_quantity, si, si_unit, text


def inputs(conveyor: Conveyor) -> pd.DataFrame:
    """Field, value as entered (text), SI value (number where it is one), SI unit; compounds by name."""
    rows = [
        {"field": field_path(place), "as entered": entered, "SI value": value, "SI unit": unit}
        for place, entered, value, unit in _rows((), conveyor)
    ]
    return pd.DataFrame(rows, columns=["field", "as entered", "SI value", "SI unit"])


def _rows(place: tuple[str | int, ...], value: Any) -> Iterator[tuple[tuple[str | int, ...], str, Any, str]]:
    if value is None:
        return
    if isinstance(value, RubberCompound):
        yield place, value.name, None, ""
    elif isinstance(value, Model):
        for name, field in type(value).model_fields.items():
            yield from _rows((*place, field.alias or name), getattr(value, name))
    elif isinstance(value, tuple):
        for i, item in enumerate(value):
            yield from _rows((*place, i), item)
    elif is_quantity(value):
        yield place, text(value), si(value), si_unit(value)
    elif isinstance(value, (bool, str)):
        yield place, str(value).lower() if isinstance(value, bool) else value, None, ""
    elif isinstance(value, (int, float)):
        yield place, f"{value:g}", float(value), "-"
    else:
        yield place, str(value), None, ""
