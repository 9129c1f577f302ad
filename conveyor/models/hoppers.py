"""Hoppers from which a belt pulls the bulk."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Self

from pydantic import Field, model_validator

from conveyor.errors import ConveyorError
from conveyor.laws.feeder import BIN_PRESSURE_RATIO, bin_surcharge_height, flow_load_factor, initial_load_factor
from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.units import Angle, Bounds, Distance, Fraction, Length, from_si, si, text

Factor = Annotated[Number, Field(gt=0, le=100)]


class Hopper(Model):
    """A slot hopper over the belt, from which it pulls the bulk."""

    outlet_length: Annotated[Distance, Bounds(gt="0 m", le="50 m")]
    """Length of the outlet along the belt."""
    outlet_width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Width of the outlet across the belt; the gate is as wide."""
    gate_height: Annotated[Length, Bounds(gt="0 m", le="3 m")]
    """Opening of the gate over the belt."""
    gate_efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """Flow over that of the full opening at belt speed, less where upper layers slip; 100 % without it."""
    top_width: Annotated[Length, Bounds(gt="0 m", le="50 m")]
    """Width of the hopper at its top."""
    bin_height: Annotated[Distance, Bounds(gt="0 m", le="100 m")] | None = None
    """Of the bulk in a bin above the hopper, as wide as its top; no bin without it."""
    bin_pressure_ratio: Annotated[Number, Field(ge=0.2, le=1)] | None = None
    """Horizontal over vertical pressure in the bin; 0.4 without it."""
    half_angle: Annotated[Angle, Bounds(ge="3 deg", le="60 deg")]
    """Slope of its walls to the vertical."""
    internal_friction: Annotated[Angle, Bounds(ge="20 deg", le="80 deg")]
    """Effective angle of internal friction of the bulk, by its shear tests."""
    wall_friction: Annotated[Angle, Bounds(ge="3 deg", le="60 deg")]
    """Angle of friction of the bulk on the walls."""
    shear_friction: Annotated[Number, Field(gt=0, le=2)] | None = None
    """Pull-out force over the vertical load; the sine of internal_friction without it."""
    initial_factor: Factor | None = None
    """Load after filling over density, gravity, length and square of the width of the outlet; of the hopper's height
    and the bin without it."""
    skirt_pressure_ratio: Annotated[Number, Field(ge=0.2, le=1)] | None = None
    """Side over vertical pressure of the bulk that moves between outlet and belt; its friction on the skirts there, of
    feeding.skirt_friction, is not asked without it."""
    flow_factor: Factor | None = None
    """The same in flow; by the field of stress in mass flow without it, needed in funnel flow."""

    @model_validator(mode="after")
    def _holds_bulk(self) -> Self:
        raise_problems("Hopper", list(self._problems()))
        raise_problems("Hopper", list(self._load_problems()))
        return self

    @property
    def height(self) -> float:
        """Height of the hopper over its outlet [m]."""
        return (si(self.top_width) - si(self.outlet_width)) / (2.0 * math.tan(si(self.half_angle)))

    @property
    def load_factors(self) -> tuple[float, float]:
        """Load after filling and in flow over ρ g L B² [-], as given or by the hopper's shape."""
        wall = si(self.wall_friction)
        surcharge = 0.0
        if self.bin_height is not None:
            surcharge = bin_surcharge_height(
                si(self.bin_height),
                hydraulic_radius=0.5 * si(self.top_width),  # of a long slot: end walls would bear more
                wall_friction=wall,
                pressure_ratio=self.bin_pressure_ratio or BIN_PRESSURE_RATIO.value,
            )
        initial = self.initial_factor or initial_load_factor(
            si(self.top_width),
            outlet_width=si(self.outlet_width),
            half_angle=si(self.half_angle),
            surcharge_height=surcharge,
        )
        flow = self.flow_factor or flow_load_factor(
            si(self.half_angle), internal_friction=si(self.internal_friction), wall_friction=wall
        )
        return initial, flow

    def _problems(self) -> Iterator[Problem]:
        if self.bin_height is None and self.bin_pressure_ratio is not None:
            yield Problem(("bin_pressure_ratio",), "given without bin_height; give the height of the bulk in the bin")
        if self.bin_height is not None and self.initial_factor is not None:
            yield Problem(
                ("bin_height",), "given with initial_factor, which has all that presses; remove one of the two"
            )
        if si(self.top_width) <= si(self.outlet_width):
            message = f"got {text(self.top_width)}, not wider than the outlet (outlet_width {text(self.outlet_width)})"
            yield Problem(("top_width",), message)
        elif si(self.gate_height) > self.height:
            unit = text(self.gate_height).split()[1]
            height = text(from_si(float(f"{self.height:.4g}"), "length", unit))
            message = (
                f"got {text(self.gate_height)}, higher than the hopper, {height} by top_width, outlet_width and "
                "half_angle: correct one of the four"
            )
            yield Problem(("gate_height",), message)
        if si(self.wall_friction) >= si(self.internal_friction):
            message = (
                f"got {text(self.wall_friction)}, not below internal_friction {text(self.internal_friction)}: the bulk "
                "would shear in itself; correct one of the two"
            )
            yield Problem(("wall_friction",), message)
        elif self.flow_factor is None:
            try:
                flow_load_factor(
                    si(self.half_angle),
                    internal_friction=si(self.internal_friction),
                    wall_friction=si(self.wall_friction),
                )
            except ConveyorError as error:
                yield Problem(("half_angle",), str(error))

    def _load_problems(self) -> Iterator[Problem]:
        """Refuse a load after filling below that in flow."""
        initial, flow = self.load_factors
        if initial < flow:
            name, its = ("top_width", "of its shape") if self.initial_factor is None else ("initial_factor", "given")
            message = (
                f"the load factor after filling, {initial:.3g} {its}, is below the {flow:.3g} of flow: bulk at rest "
                "bears on the belt with no less; take a higher hopper, or give both factors"
            )
            yield Problem((name,), message)
