"""Plates that carry the belt instead of idler sets."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from conveyor.laws.resistance import BED_FRICTION, BedSurface, Underside
from conveyor.models.base import Friction, Model, Problem, raise_problems
from conveyor.units import Bounds, Speed


class SliderBed(Model):
    """A plate on which the carry strand slides, in the shape of the trough of the carry sets."""

    surface: BedSurface
    """What the belt slides on."""
    underside: Underside = "rubber cover"
    """What of the belt slides on it."""
    friction: Friction | None = None
    """Friction of belt on plate; without it as makers print it, of hardwood and of fabric on UHMW-PE it is needed."""
    allowed_speed: Annotated[Speed, Bounds(gt="0 m/s", le="10 m/s")] | None = None
    """Largest belt speed on this plate, by its maker; not checked without it."""

    @model_validator(mode="after")
    def _friction_known(self) -> Self:
        if self.friction is None and (self.surface, self.underside) not in BED_FRICTION:
            message = (
                f"missing: no maker's figure is known of {self.underside} on {self.surface}; give the friction of belt "
                "on plate, measured or by the maker"
            )
            raise_problems("SliderBed", [Problem(("friction",), message)])
        return self

    @property
    def friction_of_belt(self) -> float:
        """Friction of belt on plate [-], as given or as makers print it."""
        return BED_FRICTION[self.surface, self.underside].value if self.friction is None else self.friction
