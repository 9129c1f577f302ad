"""The drive, and what its energy costs."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated, Any, Final, Self

from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema, model_validator
from pydantic_core import PydanticCustomError

from conveyor.models.base import Model, Name, Number, Problem, refuse
from conveyor.models.route import SHARE_SUM_TOLERANCE, Position, position_problem
from conveyor.resistance import FRICTION_FACTOR, FRICTION_FACTOR_DOWNHILL
from conveyor.units import Acceleration, Angle, Bounds, Duration, Force, Fraction, Mass, Power, quantity, si

LEAST_FRICTION: Final = FRICTION_FACTOR_DOWNHILL.value / FRICTION_FACTOR.value
"""Friction taken for certain when it brakes, over the computed one: f downhill over f, general knowledge."""

_PRICE = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([A-Z]{3})\s*/\s*kWh\s*")


class DrivePulley(Model):
    """A drive pulley with its motors and its brake."""

    position: Position = "head"
    """Where it stands: head, tail, or behind a section of a strand in its running direction."""
    section: Name | None = None
    """The section, for position "carry" or "return"."""
    wrap_angle: Annotated[Angle, Bounds(gt="0 deg", le="1440 deg")]
    """Angle of wrap; of all drive pulleys together where they stand at one place and are given as one."""
    friction: Annotated[Number, Field(gt=0, le=1)]
    """Friction of belt on pulley μ: about 0.35 lagged, 0.25 bare."""
    installed_power: Annotated[Power, Bounds(gt="0 kW")] | None = None
    """Power of the motors."""
    share: Annotated[Fraction, Bounds(ge="0 %", le="100 %")] | None = None
    """Share of the whole drive force; of several drives without it in proportion to installed power."""
    brake_force: Annotated[Force, Bounds(gt="0 N", le="10 MN")] | None = None
    """Force of its brake at the belt."""
    reduced_mass: Annotated[Mass, Bounds(ge="0 kg", le="10000 t")] = quantity("0 kg")
    """Rotating masses of motor, gear and pulley reduced to the belt, m = J i²/r²."""

    @model_validator(mode="after")
    def _placed(self) -> Self:
        refuse(type(self).__name__, position_problem(self.position, self.section))
        return self


class FurtherDrive(DrivePulley):
    """A drive pulley beside the first."""

    name: Name


class Drive(DrivePulley):
    """The drive pulley and its motor; further drives beside it."""

    efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")]
    """From the motor's shaft to the belt."""
    start_factor: Annotated[Number, Field(ge=1, le=5)] = 1.3
    """Drive force at start over that in steady running; a regenerative conveyor's braking force likewise."""
    torque_factor: Annotated[Number, Field(ge=1, le=5)] | None = None
    """Largest torque at start over the rated one, as motor, coupling or converter allow."""
    stop_deceleration: Annotated[Acceleration, Bounds(gt="0 m/s^2", le="5 m/s^2")] | None = None
    """Deceleration wanted when the conveyor is stopped."""
    least_friction: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity(LEAST_FRICTION, "fraction")
    """Friction that is certain where it helps to brake, over the computed one."""
    further_drives: Annotated[tuple[FurtherDrive, ...], Field(max_length=20)] = ()
    """Drives beside the first; at one place the belt meets them in the order of the list."""

    @model_validator(mode="after")
    def _shared(self) -> Self:
        refuse("Drive", self._share_problems())
        return self

    @property
    def pulleys(self) -> tuple[DrivePulley, ...]:
        """All drives."""
        return (self, *self.further_drives)

    def _share_problems(self) -> list[Problem]:
        places = [(), *(("further_drives", i) for i in range(len(self.further_drives)))]
        given = [pulley.share is not None for pulley in self.pulleys]
        if any(given):
            if not all(given):
                message = (
                    "missing: another drive has a share of the force; give it for all drives or for none"
                )
                return [Problem((*places[i], "share"), message) for i, ok in enumerate(given) if not ok]
            total = math.fsum(si(pulley.share) for pulley in self.pulleys if pulley.share is not None)
            if abs(total - 1.0) > SHARE_SUM_TOLERANCE:
                message = f"got a sum of {total:.6g}, the shares of all drives must add up to 1 (100 %)"
                return [Problem(("share",), message)]
        elif self.further_drives:
            message = (
                "missing: several drives share the force by installed power; give it, or share, for each"
            )
            return [
                Problem((*place, "installed_power"), message)
                for place, pulley in zip(places, self.pulleys, strict=True)
                if pulley.installed_power is None
            ]
        return []


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
