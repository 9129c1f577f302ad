"""Conversion between spec data and cells, number and unit apart."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable
from typing import Any, Final, TypeAlias

from conveyor.errors import InputError
from conveyor.forms.form_fields import FormField, LeafKind
from conveyor.units.misreadings import NUMBER, NUMBER_UNIT

CellValue: TypeAlias = str | int | float | bool | None

YES: Final = "yes"
NO: Final = "no"
EMPTY: Final = '""'
"""Cell text of an empty string: an empty cell means "not given"."""
_SEPARATOR: Final = ";"
_NUMBER: Final = re.compile(rf"\s*({NUMBER})\s*")
_SWITCH: Final = {YES: True, "true": True, NO: False, "false": False}


def to_cells(leaf: FormField, data: Any) -> tuple[CellValue, str | None]:
    """Return the value cell and the unit cell of plain data.

    Examples
    --------
    >>> from conveyor.models import Roll
    >>> from conveyor.forms.form_fields import model_layout
    >>> diameter = model_layout(Roll).parts[0]
    >>> to_cells(diameter, "159 mm"), from_cells(diameter, 159, "mm")
    ((159, 'mm'), '159 mm')
    """
    if leaf.kind == "quantity" and isinstance(data, str):
        match = NUMBER_UNIT.fullmatch(data)
        return (_number_cell(float(match[1])), match[2]) if match is not None and match[2] else (data, None)
    return _cell_value(leaf, data), None


def _cell_value(leaf: FormField, data: Any) -> CellValue:
    writers: dict[LeafKind, Callable[[Any], CellValue]] = {
        "switch": lambda given: YES if given else NO,
        "list": lambda given: _list_cell(leaf, given),
        "json": _json_text,
    }
    if leaf.kind in writers:
        return writers[leaf.kind](data)
    if isinstance(data, int | float) and not isinstance(data, bool):
        return _number_cell(data)
    return EMPTY if data == "" else str(data)


def _number_cell(number: float) -> CellValue:
    """Number for a cell; text where the 16 digits of a workbook would change it."""
    if isinstance(number, float) and number.is_integer() and abs(number) < 1e15 and number != 0.0:
        return int(number)
    if float(f"{number:.16g}") != number or str(number).startswith("-0"):
        return repr(number)
    return 0 if number == 0 else number


def _list_cell(leaf: FormField, data: Any) -> str | None:
    """List as the text of one cell; items with a separator are quoted."""
    if not isinstance(data, list | tuple):
        return _quote_item(_item_text(data))
    if not data:
        return None
    # a separator at the end distinguishes a list of one from a single item, and keeps an empty last item
    ended = (leaf.single and len(data) == 1) or (len(data) > 1 and data[-1] == "")
    return f"{_SEPARATOR} ".join(_quote_item(_item_text(item)) for item in data) + _SEPARATOR * ended


def _item_text(item: Any) -> str:
    return repr(item).removesuffix(".0") if isinstance(item, float) else str(item)


def _quote_item(item: str) -> str:
    needed = not item or item != item.strip() or re.search(r'[;"\r\n]', item)
    return '"' + item.replace('"', '""') + '"' if needed else item


def _json_text(data: Any) -> str:
    if isinstance(data, str) and data and not _is_json(data):
        return data
    return json.dumps(data, ensure_ascii=False, allow_nan=False)


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


def from_cells(leaf: FormField, value: CellValue, unit: str | None = None) -> Any:
    """Return the plain data of a value cell and its unit cell.

    Values that the model will refuse are passed on unchanged, so that its message tells the allowed ones.
    """
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"got {value}, expected a finite number")
    if isinstance(value, int) and abs(value) > 10**300:
        raise InputError("the number is too large")
    reader = _READERS.get(leaf.kind)
    if leaf.kind == "quantity":
        return _read_quantity(leaf, value, unit)
    if unit:
        raise InputError(
            f'got "{value}" beside the unit "{unit}", which has no cell of its own here; write "{value} {unit}" '
            "into the value cell, or empty the unit cell"
        )
    return value if reader is None else reader(leaf, value)


def _read_quantity(leaf: FormField, value: CellValue, unit: str | None) -> Any:
    if isinstance(value, bool) or value is None:
        return value
    if not isinstance(value, str):
        number = repr(float(value)).removesuffix(".0")
        return f"{number} {unit}" if unit else value
    text = value.strip()
    if _NUMBER.fullmatch(text):
        return f"{text} {unit}" if unit else text
    if text in map(str, leaf.choices) and not unit:
        return text
    match = NUMBER_UNIT.fullmatch(text)
    if match is None:
        return f"{text} {unit}" if unit else text
    if unit and match[2].strip() != unit:
        raise InputError(
            f'got "{text}" beside the unit "{unit}" of its cell or heading; give the number alone, in that unit'
        )
    return text


def _read_number(leaf: FormField, value: CellValue) -> Any:
    number = float(value) if isinstance(value, str) and _NUMBER.fullmatch(value) else value
    whole = leaf.kind == "count" and isinstance(number, float) and number.is_integer()
    return int(number) if whole and isinstance(number, float) else number


def _read_switch(_leaf: FormField, value: CellValue) -> bool:
    if isinstance(value, bool):
        return value
    known = _SWITCH.get(str(value).strip().casefold())
    if known is None:
        raise InputError(f'got "{value}", allowed: {YES}, {NO}')
    return known


def _read_choice(leaf: FormField, value: CellValue) -> Any:
    text = _read_text(leaf, value)
    return next((choice for choice in leaf.choices if str(choice) == str(text).strip()), value)


def _read_text(_leaf: FormField, value: CellValue) -> Any:
    if isinstance(value, bool):
        return value
    return "" if value == EMPTY else str(value).removesuffix(".0") if isinstance(value, float) else str(value)


def _read_list(leaf: FormField, value: CellValue) -> Any:
    item = leaf.item
    if item is None:
        raise TypeError(f"{leaf.key} is a list of nothing")
    if not isinstance(value, str):
        return from_cells(item, value) if leaf.single else [from_cells(item, value)]
    try:
        lines = list(csv.reader(io.StringIO(value), delimiter=_SEPARATOR, skipinitialspace=True, strict=True))
    except csv.Error as error:
        raise InputError(f'got "{value[:80]}", expected values separated by "{_SEPARATOR}" ({error})') from None
    texts = [text if item.kind == "text" else text.strip() for line in lines for text in line]
    ended = len(texts) > 1 and texts[-1] == ""
    items = [from_cells(item, text) for text in (texts[:-1] if ended else texts)]
    return items[0] if leaf.single and len(items) == 1 and not ended else items


def _read_json(_leaf: FormField, value: CellValue) -> Any:
    if not isinstance(value, str):
        return value
    try:
        return json.loads(value)
    except (ValueError, RecursionError):
        return value


_READERS: Final[dict[LeafKind, Callable[[FormField, CellValue], Any]]] = {
    "number": _read_number,
    "count": _read_number,
    "switch": _read_switch,
    "choice": _read_choice,
    "text": _read_text,
    "reference": _read_text,
    "list": _read_list,
    "json": _read_json,
}
