"""Hoppers from which a belt pulls the bulk."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Self

from pydantic import Field, model_validator

from conveyor.errors import ConveyorError
from conveyor.laws.feeder import flow_load_factor
from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.units import Angle, Bounds, Distance, Length, si, text

Factor = Annotated[Number, Field(gt=0, le=100)]


class Hopper(Model):
    """A slot hopper over the belt, from which it pulls the bulk."""

    outlet_length: Annotated[Distance, Bounds(gt="0 m", le="50 m")]
    """Length of the outlet along the belt."""
    outlet_width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Width of the outlet across the belt; the gate is as wide."""
    gate_height: Annotated[Length, Bounds(gt="0 m", le="3 m")]
    """Opening of the gate over the belt."""
    top_width: Annotated[Length, Bounds(gt="0 m", le="50 m")]
    """Width of the hopper at its top."""
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
    without it."""
    flow_factor: Factor | None = None
    """The same in flow; by the field of stress in mass flow without it, needed in funnel flow."""

    @model_validator(mode="after")
    def _holds_bulk(self) -> Self:
        raise_problems("Hopper", list(self._problems()))
        return self

    def _problems(self) -> Iterator[Problem]:
        if si(self.top_width) <= si(self.outlet_width):
            message = f"got {text(self.top_width)}, not wider than the outlet (outlet_width {text(self.outlet_width)})"
            yield Problem(("top_width",), message)
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
