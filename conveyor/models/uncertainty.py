"""What a designer does not know exactly, as ranges."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from conveyor.models.base import Model, Problem, Switch, refuse
from conveyor.units import Bounds, Fraction, Quantity, TemperatureDifference, si, text

HalfWidth = Annotated[Fraction, Bounds(gt="0 %", lt="100 %")]
Share = Annotated[Fraction, Bounds(ge="0 %", lt="100 %")]


class Uncertainty(Model):
    """Ranges of inputs, each a 90 % interval; a share is of the value in the spec, up and down."""

    roll_drag: HalfWidth | None = None
    """Of the drag of all rolls, up and down ("30 %")."""
    flexure_share: Annotated[tuple[Share, ...], Field(min_length=2, max_length=2)] | None = None
    """Lowest and highest share of the flexure in the main resistance."""
    flow: HalfWidth | None = None
    """Of the mass flow, up and down."""
    density: HalfWidth | None = None
    """Of the bulk density at the same mass flow, up and down: it works on the skirts."""
    belt_mass: HalfWidth | None = None
    """Of the belt's mass per length, up and down."""
    cover_thickness: HalfWidth | None = None
    """Of the bottom cover's thickness, up and down (a worn cover is thinner)."""
    cleaner_pressure: HalfWidth | None = None
    """Of the pressure of all cleaners, up and down."""
    skirt_friction: HalfWidth | None = None
    """Of the friction of bulk on skirts, up and down."""
    temperature: Annotated[TemperatureDifference, Bounds(gt="0 K", le="100 K")] | None = None
    """Of the belt's covers, up and down."""
    rubber: Switch = False
    """Whether the compounds' replicas (bootstrap of their fits) and the band of their tests are calculated."""

    def half_width(self, name: str) -> float | None:
        """Half width of a range, as a share or in kelvin [-, K]; None where it is not given."""
        given: Quantity | None = getattr(self, name)
        return None if given is None else si(given)

    @model_validator(mode="after")
    def _lower_first(self) -> Self:
        pair = self.flexure_share
        if pair is not None and not si(pair[0]) < si(pair[1]):
            message = f"got {text(pair[0])} to {text(pair[1])}, expected the lower value first"
            refuse("Uncertainty", [Problem(("flexure_share",), message)])
        return self
