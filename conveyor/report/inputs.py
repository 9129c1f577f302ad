"""Every field of a conveyor as a row: as entered, in SI, and whether the spec or a default gave it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import pandas as pd

from conveyor.models import Conveyor, Model, RubberCompound
from conveyor.models.base import field_path
from conveyor.units import is_quantity, si, si_unit, text

Origin = Literal["spec", "default"]
Row = tuple[str, str, float | None, str, Origin]


def inputs(conveyor: Conveyor) -> pd.DataFrame:
    """Field, value as entered (text), SI value (number where it is one), SI unit, origin; compounds by name.

    Fields that are left open and have no default have no row.
    """
    rows = list(_rows((), conveyor, "spec"))
    return pd.DataFrame(
        rows, columns=["field", "as entered", "SI value", "SI unit", "given by"], dtype=object
    )


def _rows(place: tuple[str | int, ...], value: Any, origin: Origin) -> Iterator[Row]:
    field = field_path(place)
    if value is None:
        return
    if isinstance(value, RubberCompound):
        yield field, value.name, None, "", origin
    elif isinstance(value, Model):
        for name, info in type(value).model_fields.items():
            given = origin == "spec" and name in value.model_fields_set
            yield from _rows(
                (*place, info.alias or name), getattr(value, name), "spec" if given else "default"
            )
    elif isinstance(value, tuple):
        for i, item in enumerate(value):
            yield from _rows((*place, i), item, origin)
    elif is_quantity(value):
        yield field, text(value), si(value), si_unit(value), origin
    elif isinstance(value, bool):
        yield field, str(value).lower(), None, "", origin
    elif isinstance(value, int | float):
        yield field, repr(value).removesuffix(".0"), float(value), "-", origin
    else:
        yield field, str(value), None, "", origin
