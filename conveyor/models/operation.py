"""Operation in a year: hours and duty, energy price, emissions."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Final, Self

from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from conveyor.models.base import Model, Problem, raise_problems
from conveyor.units import Bounds, Duration, Fraction, Speed, Temperature, si, text

EarthTemperature = Annotated[Temperature, Bounds(ge="-100 degC", le="200 degC")]
BeltSpeed = Annotated[Speed, Bounds(gt="0 m/s", le="20 m/s")]
Hours = Annotated[Duration, Bounds(ge="0 h", le="8784 h")]

YEAR_HOURS: Final = 8784.0
"""Hours of a leap year, the longest duty."""
HOURS_TOLERANCE: Final = 1e-9
"""Relative tolerance of a sum of hours typed as decimals."""
_LONGEST_TEXT: Final = 80
PRICE_PATTERN: Final = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([A-Z]{3})\s*/\s*kWh\s*")
"""Energy price in specs: amount and currency."""
_EMISSION_PATTERN = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*(kg|g|t)\s*/\s*(kWh|MWh)\s*")
_KILOGRAMS: Final = {"g": 1e-3, "kg": 1.0, "t": 1e3}
_KILOWATT_HOURS: Final = {"kWh": 1.0, "MWh": 1e3}


@dataclass(frozen=True)
class EnergyPrice:
    """Price of a kilowatt hour in a currency named by its three-letter code."""

    amount: float
    """[currency/kWh]."""
    currency: str

    def __str__(self) -> str:
        return f"{self.amount!r}".removesuffix(".0") + f" {self.currency}/kWh"


@dataclass(frozen=True)
class EmissionFactor:
    """Carbon dioxide of a kilowatt hour, as written: number and unit."""

    number: float
    unit: str

    @property
    def amount(self) -> float:
        """Carbon dioxide [kg/kWh]."""
        mass, energy = self.unit.split("/")
        return self.number * _KILOGRAMS[mass] / _KILOWATT_HOURS[energy]

    def __str__(self) -> str:
        return f"{self.number!r}".removesuffix(".0") + f" {self.unit}"


def _match_pattern(pattern: re.Pattern[str], value: Any, kind: str, wanted: str) -> re.Match[str]:
    match = pattern.fullmatch(value) if isinstance(value, str) and len(value) <= _LONGEST_TEXT else None
    if match is None:
        message = f'got "{str(value)[:_LONGEST_TEXT]}", expected {wanted}'
        raise PydanticCustomError(kind, "{message}", {"message": message})
    return match


def _read_price(value: Any) -> Any:
    if isinstance(value, EnergyPrice):
        return value
    match = _match_pattern(PRICE_PATTERN, value, "price", 'a price with the currency\'s code such as "0.12 EUR/kWh"')
    return EnergyPrice(float(match[1]), match[2])


def _read_emission(value: Any) -> Any:
    if isinstance(value, EmissionFactor):
        return value
    match = _match_pattern(
        _EMISSION_PATTERN, value, "price", 'a mass of carbon dioxide per energy such as "0.35 kg/kWh"'
    )
    return EmissionFactor(float(match[1]), f"{match[2]}/{match[3]}")


def _text_annotation(read: Callable[[Any], Any], pattern: re.Pattern[str], example: str) -> tuple[Any, ...]:
    schema = {"type": "string", "pattern": f"^{pattern.pattern}$", "examples": [example]}
    return BeforeValidator(read), PlainSerializer(str, when_used="json"), WithJsonSchema(schema)


Price = Annotated[EnergyPrice, *_text_annotation(_read_price, PRICE_PATTERN, "0.12 EUR/kWh")]
Emission = Annotated[EmissionFactor, *_text_annotation(_read_emission, _EMISSION_PATTERN, "0.35 kg/kWh")]


class DutyEntry(Model):
    """A bar of the year's histogram: hours at a load, a temperature and a speed."""

    hours: Hours
    """In a year."""
    share: Annotated[Fraction, Bounds(ge="0 %", le="200 %")]
    """Mass flow over material.flow; 0 is the empty belt."""
    temperature: EarthTemperature | None = None
    """Of the belt's covers, where it differs from that of ambient; the air keeps ambient's distance to it."""
    speed: BeltSpeed | None = None
    """Of the belt, where it differs."""

    @property
    def seconds(self) -> float:
        """Time in a year [s]."""
        return si(self.hours)

    @property
    def load(self) -> float:
        """Mass flow over that of the spec [-]."""
        return si(self.share)

    def __str__(self) -> str:
        parts = [text(self.hours), f"share {text(self.share)}"]
        parts += [text(value) for value in (self.temperature, self.speed) if value is not None]
        return ", ".join(parts)


class Operation(Model):
    """How long the conveyor runs, at which loads, and what its energy costs."""

    hours_per_year: Hours
    """Time in operation in a year; may be left out where duty is given: then the sum of its hours."""
    price: Price | None = None
    """Price of energy, as "0.12 EUR/kWh"."""
    duty: Annotated[tuple[DutyEntry, ...], Field(max_length=1000)] = ()
    """Histogram of the year; without it all hours are at the flow and temperature of the spec."""
    feed_in_price: Price | None = None
    """Credit for energy fed back; none without it."""
    emission: Emission | None = None
    """Carbon dioxide of energy drawn, as "0.35 kg/kWh"; it depends on grid and year."""
    feed_in_emission: Emission | None = None
    """Carbon dioxide credited for energy fed back; none without it."""
    emission_source: str | None = None
    """Where the emission factor comes from; needed with it."""

    @model_validator(mode="before")
    @classmethod
    def _hours_of_duty(cls, data: Any) -> Any:
        """Sum up the duty where the hours are left out; a wrong duty is refused at its own field."""
        if not isinstance(data, dict) or data.get("hours_per_year") is not None or not data.get("duty"):
            return data
        try:
            entries = [DutyEntry.model_validate(entry) for entry in data["duty"]]
        except (ValueError, TypeError):
            return {**data, "hours_per_year": "0 h"}
        total = math.fsum(si(entry.hours) for entry in entries) / 3600.0
        return {
            **data,
            "hours_per_year": f"{total:.12g} h" if total <= YEAR_HOURS else "0 h",
        }

    @property
    def seconds_per_year(self) -> float:
        """Time in operation in a year [s]."""
        return si(self.hours_per_year)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        raise_problems("Operation", self._problems())
        return self

    def _problems(self) -> Iterator[Problem]:
        if self.duty:
            hours = math.fsum(si(entry.hours) for entry in self.duty) / 3600.0
            if hours > YEAR_HOURS:
                yield Problem(("duty",), f"got {hours:.6g} h in all, a year has at most {YEAR_HOURS:g} h")
            elif abs(si(self.hours_per_year) / 3600.0 - hours) > HOURS_TOLERANCE * YEAR_HOURS:
                yield Problem(
                    ("hours_per_year",),
                    f"got {text(self.hours_per_year)}, the hours of duty add up to {hours:.6g} h; leave hours_per_year "
                    "out or correct one of the two",
                )
        if self.emission is not None and not self.emission_source:
            message = "missing: an emission factor holds for one grid and year; say where it comes from"
            yield Problem(("emission_source",), message)
        for name, needs in (("feed_in_price", "price"), ("feed_in_emission", "emission")):
            if getattr(self, name) is not None and getattr(self, needs) is None:
                yield Problem((needs,), f"missing: {name} is given; what is drawn counts too")
        credit = self.feed_in_price
        if credit is not None and self.price is not None and credit.currency != self.price.currency:
            message = f"got {credit.currency}, price is in {self.price.currency}; use one currency"
            yield Problem(("feed_in_price",), message)
