"""Temperature and frequency that a file states beside its table: above it, in a remark, or as the name of a sheet."""

from __future__ import annotations

import re
from typing import Final, NamedTuple

from conveyor.errors import InputError
from conveyor.laboratory.column_units import UNITS, ColumnUnit, find_unit
from conveyor.laboratory.header_meanings import header_meaning
from conveyor.laboratory.numbers import half_width
from conveyor.laboratory.table_layout import DataTable
from conveyor.laboratory.value_checks import TEMPERATURE_RANGE

STATED_QUANTITIES: Final = {"strain sweep": ("temperature", "frequency"), "temperature sweep": ("frequency",)}
"""What is taken from beside the table, by kind. Not the temperature of a frequency sweep: it may be that
of the room."""
_AMOUNT: Final = re.compile(r"(?P<number>[+-]?\d+(?:[.,]\d+)?)\s*(?P<unit>\S.*)?")
_SHEET_NAME: Final = re.compile(r"(?:T\s*=?\s*)?(?P<number>[+-]?\d+(?:[.,]\d+)?)\s*(?P<unit>\S+)", re.IGNORECASE)
_SAME: Final = 1e-9  # rounding of a unit


class StatedValue(NamedTuple):
    """A value in SI that holds for every row, and a note on where it stands."""

    value: float
    note: str


def stated_value(table: DataTable, quantity: str) -> StatedValue | None:
    """Temperature [K] or frequency [Hz] in a line such as `Temperature: 20 °C` or `Frequency [Hz];1`; None without one.

    Raises
    ------
    InputError
        Two lines differ, or one says what no test has.
    """
    found: StatedValue | None = None
    for key, (text, row) in table.metadata.items():
        meaning, amount = header_meaning(key), _AMOUNT.fullmatch(half_width(text).strip())
        if meaning is None or meaning.quantity != quantity or amount is None:
            continue
        unit = find_unit(quantity, amount["unit"] or meaning.unit or "")
        if unit is None:
            continue
        value = _si_value(amount["number"], unit)
        if (refused := _range_refusal(quantity, value)) is not None:
            raise table.grid.refusal(row, 0, f'"{key}" says {text}; {refused}')
        if found is not None and abs(value - found.value) > _SAME * abs(found.value):
            what = f'"{key}" says {text}, but: {found.note}; correct one of them, or give every row its {quantity}'
            raise table.grid.refusal(row, 0, what)
        found = StatedValue(value, f"{quantity} of every row {amount['number']} {unit.name}, as row {row} says")
    return found


def sheet_temperature(table: DataTable) -> StatedValue | None:
    """Temperature [K] that is the whole name of a sheet, as `-40 °C` or `T=20C`; None for other names.

    Raises
    ------
    InputError
        No test has that temperature.
    """
    name = _SHEET_NAME.fullmatch(half_width(table.grid.sheet).strip())
    unit = find_unit("temperature", name["unit"]) if name is not None else None
    if name is None or unit is None:
        return None
    note = f"temperature of every row {name['number']} {unit.name}, as the name of the sheet says"
    value = _si_value(name["number"], unit)
    if (refused := _range_refusal("temperature", value)) is not None:
        raise InputError(f"{table.grid.name}: the name of the sheet is a temperature; {refused}")
    return StatedValue(value, note)


def _range_refusal(quantity: str, value: float) -> str | None:
    """Refusal of a value that no test has, in SI; None for others."""
    low, high = TEMPERATURE_RANGE
    if quantity == "temperature" and not low <= value <= high:
        zero = UNITS["temperature"]["degC"].offset
        return f"{low - zero:g} to {high - zero:g} degC are allowed"
    return "a frequency is above 0" if quantity == "frequency" and value <= 0.0 else None


def _si_value(number: str, unit: ColumnUnit) -> float:
    return unit.factor * (float(number.replace(",", ".")) + unit.offset)
