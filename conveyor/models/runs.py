"""Measured runs of a conveyor."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import StringConstraints, model_validator

from conveyor.models.base import Model, Problem, raise_problems
from conveyor.models.operation import BeltSpeed, EarthTemperature
from conveyor.units import Bounds, MassFlow, Power, si, text

MeasuringPlace = Literal["motor shaft", "mains"]


class MeasuredRun(Model):
    """Power measured in steady running, all drives together, and what the conveyor did meanwhile."""

    power: Power
    """Negative where the belt drives its motors."""
    at: MeasuringPlace
    """Where it was measured."""
    flow: Annotated[MassFlow, Bounds(ge="0 t/h")]
    """Of the bulk, 0 for an empty belt."""
    speed: BeltSpeed | None = None
    """Of the belt; that of the spec without it."""
    temperature: EarthTemperature | None = None
    """Of the belt's covers, and of the air where that is not given; those of the spec without it."""
    air_temperature: EarthTemperature | None = None
    """Of the air; the spec's distance to the covers without it."""
    deviation: Annotated[Power, Bounds(gt="0 W")] | None = None
    """Standard deviation of the power, of meter and of flow together; less than the power."""
    note: Annotated[str, StringConstraints(max_length=200)] = ""
    """What else to know of it."""

    @property
    def watts(self) -> float:
        """Measured power [W]."""
        return si(self.power)

    @property
    def mass_flow(self) -> float:
        """Mass flow of the bulk [kg/s]."""
        return si(self.flow)

    @property
    def belt_speed(self) -> float | None:
        """Belt speed [m/s]; None for that of the spec."""
        return None if self.speed is None else si(self.speed)

    @property
    def belt_temperature(self) -> float | None:
        """Temperature of the covers [K]; None for that of the spec."""
        return None if self.temperature is None else si(self.temperature)

    @property
    def deviation_watts(self) -> float | None:
        """Standard deviation of the power [W]."""
        return None if self.deviation is None else si(self.deviation)

    @property
    def state(self) -> tuple[float | None, ...]:
        """Flow, speed and temperatures [kg/s, m/s, K]; runs of equal state are calculated once."""
        given = (self.flow, self.speed, self.temperature, self.air_temperature)
        return tuple(None if value is None else si(value) for value in given)

    @model_validator(mode="after")
    def _deviation_below_power(self) -> Self:
        if self.deviation is not None and self.watts != 0.0 and si(self.deviation) >= abs(self.watts):
            message = f"got {text(self.deviation)} of a power of {text(self.power)}, allowed: less than the power"
            raise_problems("MeasuredRun", [Problem(("deviation",), message)])
        return self

    @model_validator(mode="after")
    def _covers_before_air(self) -> Self:
        if self.air_temperature is not None and self.temperature is None:
            message = "missing: give the belt's temperature beside the air's, or only `temperature` for both"
            raise_problems("MeasuredRun", [Problem(("temperature",), message)])
        return self
