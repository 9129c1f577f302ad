"""Belt scales that weigh the bulk as it passes."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from conveyor.models.base import AnyInteger, Model, Name, Problem, Switch, raise_problems
from conveyor.units import Bounds, Distance, Fraction, Length


class BeltScale(Model):
    """A belt scale in the carry strand."""

    section: Name
    """The section it stands in."""
    distance: Annotated[Distance, Bounds(ge="0 m", le="100 km")]
    """From the tail end of that section to the first weigh set."""
    weigh_sets: Annotated[int, Field(ge=1, le=20, strict=True), AnyInteger] = 1
    """Sets on the scale, side by side."""
    alignment: Annotated[Length, Bounds(ge="0 mm", le="50 mm")] | None = None
    """Height by which the weigh sets may stand out of line with their neighbours; the error is not asked without it."""
    allowed_error: Annotated[Fraction, Bounds(gt="0 %", le="20 %")] | None = None
    """Error of weight that alignment may cost, over the weight of the bulk."""
    for_trade: Switch = False
    """Whether bulk is sold by it: length of the conveyor and kind of take-up are checked too."""

    @model_validator(mode="after")
    def _error_of_alignment(self) -> Self:
        if self.allowed_error is not None and self.alignment is None:
            raise_problems(
                "BeltScale", [Problem(("alignment",), "missing: allowed_error needs it; give it, e.g. 0.8 mm")]
            )
        return self
