"""The drive, and what its energy costs."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema
from pydantic_core import PydanticCustomError

from conveyor.models.base import Model, Number
from conveyor.units import Angle, Bounds, Duration, Fraction, Power

_PRICE = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([A-Z]{3})\s*/\s*kWh\s*")


class Drive(Model):
    """The drive pulley and its motor."""

    position: Literal["head"] = "head"
    """Where it stands; only a drive at the head is computed."""
    wrap_angle: Annotated[Angle, Bounds(gt="0 deg", le="1440 deg")]
    """Angle of wrap, of all drive pulleys together."""
    friction: Annotated[Number, Field(gt=0, le=1)]
    """Friction of belt on pulley μ: about 0.35 lagged, 0.25 bare."""
    efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")]
    """From the motor's shaft to the belt."""
    start_factor: Annotated[Number, Field(ge=1, le=5)] = 1.3
    """Drive force at start over that in steady running."""
    installed_power: Annotated[Power, Bounds(gt="0 kW")] | None = None
    """Power of the motors."""


@dataclass(frozen=True)
class EnergyPrice:
    """Price of a kilowatt hour in a currency named by its three-letter code."""

    amount: float
    """[currency/kWh]."""
    currency: str

    def __str__(self) -> str:
        return f"{self.amount!r}".removesuffix(".0") + f" {self.currency}/kWh"


def _price(value: Any) -> Any:
    if isinstance(value, EnergyPrice):
        return value
    match = _PRICE.fullmatch(value) if isinstance(value, str) and len(value) <= 80 else None
    if match is None:
        shown = str(value)[:80]
        message = f'got "{shown}", expected a price with the currency\'s code such as "0.12 EUR/kWh"'
        raise PydanticCustomError("price", "{message}", {"message": message})
    return EnergyPrice(float(match[1]), match[2])


Price = Annotated[
    EnergyPrice,
    BeforeValidator(_price),
    PlainSerializer(str, when_used="json"),
    WithJsonSchema({"type": "string", "pattern": f"^{_PRICE.pattern}$", "examples": ["0.12 EUR/kWh"]}),
]


class Operation(Model):
    """How long the conveyor runs and what its energy costs."""

    hours_per_year: Annotated[Duration, Bounds(ge="0 h", le="8784 h")]
    """Time under load in a year."""
    price: Price | None = None
    """Price of energy, as "0.12 EUR/kWh"."""
