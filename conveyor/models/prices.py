"""Prices and lives of conveyor parts."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, Final, Self

from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from conveyor.files import libraries
from conveyor.laws.drives import HORSEPOWER
from conveyor.laws.resistance.cema import FOOT, POUND, POUND_FORCE
from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.models.library_items import merge_fields
from conveyor.units import Bounds, Distance, Duration, Fraction, si

_PRICE_PATTERN: Final = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([A-Z]{3})(?:\s*/\s*(\S+))?\s*")
_SI_SCALES: Final = {
    "kW": 1e-3, "kN": 1e-3, "MN*m": 1e-6, "hp": 1.0 / HORSEPOWER, "lbf": 1.0 / POUND_FORCE, "lb": 1.0 / POUND,
    "ft": 1.0 / FOOT, "ft^2": FOOT**-2, "ft^3": FOOT**-3,
}  # fmt: skip
"""Factors from a price per unit to a price per SI unit."""
_US_UNITS: Final = {"kg": "lb", "m": "ft", "m^2": "ft^2", "m^3": "ft^3", "kW": "hp", "kN": "lbf"}
"""US units in which a price may be given, too."""


@dataclass(frozen=True)
class UnitPrice:
    """Price per unit, in a currency named by its three-letter code."""

    number: float
    currency: str
    unit: str

    @property
    def amount(self) -> float:
        """Price per SI unit of mass, length, area, volume, power, force, strength times area [currency/…]."""
        return self.number * _SI_SCALES.get(self.unit, 1.0)

    def __str__(self) -> str:
        per = f"({self.unit})" if "*" in self.unit else self.unit
        return f"{self.number:.12g} {self.currency}" + (f"/{per}" if per else "")


def _price_annotation(unit: str) -> tuple[Any, ...]:
    """Validator, serializer and schema of a price per unit."""
    example = str(UnitPrice(12.0, "EUR", unit))

    def read(value: Any) -> UnitPrice:
        if isinstance(value, UnitPrice):
            return value
        match = _PRICE_PATTERN.fullmatch(value) if isinstance(value, str) and len(value) <= 80 else None
        written = "" if match is None else (match[3] or "").strip("()")
        if match is None or written not in {unit, _US_UNITS.get(unit)}:
            message = f'got "{str(value)[:80]}", expected a price such as "{example}"'
            raise PydanticCustomError("price", "{message}", {"message": message})
        return UnitPrice(float(match[1]), match[2], written)

    schema = WithJsonSchema({"type": "string", "examples": [example]})
    return BeforeValidator(read), PlainSerializer(str, when_used="json"), schema


_LumpSum = Annotated[UnitPrice, *_price_annotation("")]
_PerMass = Annotated[UnitPrice, *_price_annotation("kg")]
_PerLength = Annotated[UnitPrice, *_price_annotation("m")]
_PerArea = Annotated[UnitPrice, *_price_annotation("m^2")]
_PerVolume = Annotated[UnitPrice, *_price_annotation("m^3")]
_PerPower = Annotated[UnitPrice, *_price_annotation("kW")]
_PerForce = Annotated[UnitPrice, *_price_annotation("kN")]
_PerStrength = Annotated[UnitPrice, *_price_annotation("MN*m")]
Years = Annotated[Number, Field(gt=0, le=100)]


class Prices(Model):
    """Prices, lives and rates; what is not given is that of the library of prices."""

    euro: _LumpSum | None = None
    """What a euro costs in the currency of the duty, for the library's prices; of a duty in euros it is left out."""
    textile: _PerArea
    """Textile belt, without its strength and covers."""
    textile_strength: _PerStrength
    """Beside it, for strength per width times area."""
    steel_cord: _PerArea
    """Steel-cord belt, without its strength and covers."""
    steel_cord_strength: _PerStrength
    """Beside it, for strength per width times area."""
    cover: _PerVolume
    """Cover rubber."""
    special_cover: _PerVolume
    """Cover rubber of every compound but the first of the duty's."""
    splice: _PerLength
    """A splice, per width of belt."""
    roll_of_belt: Annotated[Distance, Bounds(gt="10 m", le="10 km")]
    """Belt between splices."""
    textile_life: Years
    """Of a textile belt, years."""
    steel_cord_life: Years
    """Of a steel-cord belt, years."""
    roll: _LumpSum
    """Bearings, seals and assembly of a roll."""
    roll_mass: _PerMass
    """What turns of a roll."""
    set: _PerLength
    """Frame and erection of an idler set, per width of belt."""
    roll_life: Annotated[Duration, Bounds(gt="100 h", le="1000000 h")]
    """Of a roll's seals in running; its bearings may end it sooner."""
    structure: _PerLength
    """Stringers, walkway, cables, per length of conveyor."""
    structure_width: _PerArea
    """Beside it, per length and width of belt."""
    drive: _LumpSum
    """Every drive: base, coupling, cables."""
    drive_power: _PerPower
    """Motor, gear and inverter."""
    pulley_mass: _PerMass
    """Pulleys with shafts and bearings."""
    take_up: _LumpSum
    """Take-up."""
    take_up_force: _PerForce
    """Beside it, for the belt tension it is set to."""
    interest: Annotated[Fraction, Bounds(ge="0 %", le="100 %")]
    """A year."""
    years: Years
    """Life of structure, drives and pulleys, years."""
    upkeep: Annotated[Fraction, Bounds(ge="0 %", le="100 %")]
    """A year, over all capital."""

    @model_validator(mode="before")
    @classmethod
    def _from_library(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        euro = _PRICE_PATTERN.fullmatch(str(data.get("euro")))
        return merge_fields({name: _converted_price(price, euro) for name, price in library_prices().items()}, data)

    @model_validator(mode="after")
    def _one_currency(self) -> Self:
        given = {name: value for name, value in self if isinstance(value, UnitPrice)}
        known = {value.currency for value in given.values()}
        if self.euro is not None and self.euro.number == 0.0:
            raise_problems("Prices", [Problem(("euro",), f"got {self.euro}, allowed: > 0")])
        if len(known) > 1:
            own = {name for name in self.model_fields_set if name in given}
            if self.euro is not None:
                own = {name for name in own if given[name].currency != self.euro.currency}
            else:
                own = {name for name in own if str(given[name]) != library_prices()[name]} or set(given)
            message = f"got {', '.join(sorted(known))}; give every price in one currency: {', '.join(sorted(given))}"
            raise_problems("Prices", [Problem((min(own),), message)])
        return self

    @property
    def currency(self) -> str:
        """Currency of all prices."""
        return self.drive.currency

    @cached_property
    def amounts(self) -> dict[str, float]:
        """Figures by field: prices per SI unit, lives in years, seconds or metres."""
        return {
            name: value.amount if isinstance(value, UnitPrice) else value if isinstance(value, float) else si(value)
            for name, value in self
            if value is not None
        }


def library_prices() -> dict[str, Any]:
    """Library prices, as in specs."""
    return {
        name: value for entry in libraries.library_entries("prices").values() for name, value in entry.fields.items()
    }


def _converted_price(written: Any, euro: re.Match[str] | None) -> Any:
    """Library field; a price is converted where an exchange rate of the euro is given."""
    price = _PRICE_PATTERN.fullmatch(str(written))
    if euro is None or price is None:
        return written
    return str(UnitPrice(float(price[1]) * float(euro[1]), euro[2], (price[3] or "").strip("()")))
