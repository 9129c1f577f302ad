"""Every field of a conveyor as a row: as entered, in SI, and its origin: spec, library or default."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Literal

from conveyor.models import Conveyor, Model, RubberCompound
from conveyor.models.base import field_path
from conveyor.models.library_items import LibraryItem
from conveyor.models.maker_lists import ListedItem
from conveyor.units import System, is_quantity, si_with_unit, text
from conveyor.units.presentation import format_figure

Origin = Literal["spec", "library", "default"]
InputRow = tuple[str, str, float | None, str, Origin]


def _entered_text(value: Any) -> Any:
    return text(value) if is_quantity(value) else value


def input_rows(conveyor: Conveyor) -> tuple[InputRow, ...]:
    """Rows of all fields with a value: field, text as entered, SI value, unit, origin; compounds, items by name.

    The version of the file's format is none: nothing follows from it.
    """
    return tuple(row for row in _value_rows((), conveyor, "spec") if row[0] != "conveyor")


def _value_rows(place: tuple[str | int, ...], value: Any, origin: Origin, entry: Any = None) -> Iterator[InputRow]:
    """Rows of a value; `entry` is the value of the library entry that is named, if any."""
    field = field_path(place)
    if value is None:
        return
    if isinstance(value, RubberCompound | ListedItem):
        yield field, value.name, None, "", origin
    elif isinstance(value, Model):
        yield from _field_rows(place, value, origin, entry)
    elif isinstance(value, tuple):
        for i, item in enumerate(value):
            yield from _value_rows((*place, i), item, origin)
    elif is_quantity(value):
        yield field, text(value), *si_with_unit(value), origin
    elif isinstance(value, bool):
        yield field, str(value).lower(), None, "", origin
    elif isinstance(value, int | float):
        yield field, repr(value).removesuffix(".0"), float(value), "-", origin
    else:
        yield field, str(value), None, "", origin


def _field_rows(place: tuple[str | int, ...], model: Model, origin: Origin, entry: Any) -> Iterator[InputRow]:
    named = model.entry if isinstance(model, LibraryItem) else None
    known = entry if named is None else named.fields
    held = known if isinstance(known, Mapping) else {}
    for name, info in type(model).model_fields.items():
        key, value = info.alias or name, getattr(model, name)
        given = origin == "spec" and name in model.model_fields_set
        listed = key in held and _entered_text(value) == held[key]
        came: Origin = "library" if listed else "spec" if given else "default"
        yield from _value_rows((*place, key), value, came, held.get(key))


_ITEM = re.compile(r"\[\d+\]")
_DEGREES = re.compile(r"\bdeg(?=[CF]?\b)")
_SI_KINDS = {
    "m": "length",
    "m/s": "speed",
    "m/s²": "acceleration",
    "Pa": "pressure",
    "N": "force",
    "kg": "mass",
}
"""Kinds of the SI units of defaults."""


def _readable_entry(entered: str) -> str:
    """Value as entered, with its unit in the usual spelling."""
    if entered in {"true", "false"}:
        return "yes" if entered == "true" else "no"
    spelled = _DEGREES.sub("°", entered).replace("^2", "²").replace("^3", "³").replace("short_ton/h", "stph")
    return spelled.removesuffix(" °") + "°" if spelled.endswith(" °") else spelled


def group_inputs(rows: Iterable[InputRow], system: System, *, alike: bool) -> tuple[tuple[str, str], ...]:
    """Rows grouped by part of the spec: part, fields with their values; with `alike`, list items merged."""
    parts: dict[str, dict[str, list[str]]] = {}
    for field, entered, value, sign, origin in rows:
        of, _, name = field.rpartition(".")
        if alike:
            of = _ITEM.sub("", of)
        known = parts.setdefault(of, {}).setdefault(_ITEM.sub("", name).replace("_", " "), [])
        shown = "0" if value == 0.0 else _readable_entry(entered)
        if system != "SI" and origin == "default" and value and sign in _SI_KINDS:
            shown = format_figure(value, _SI_KINDS[sign], system)
        if not alike or shown not in known:
            known.append(shown)
    return tuple(
        (part or "conveyor", "; ".join(f"{name} {', '.join(values)}" for name, values in fields.items()))
        for part, fields in parts.items()
    )
