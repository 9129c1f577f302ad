"""Ploughs that sweep the bulk off the belt."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from conveyor.laws.resistance import SCRAPING_FACTOR
from conveyor.models.base import AnyInteger, Model, Name, Problem, raise_problems
from conveyor.units import Bounds, Length, LineForce, quantity


class Plough(Model):
    """A plough on the belt, or several alike at one place."""

    count: Annotated[int, Field(ge=1, le=100, strict=True), AnyInteger] = 1
    """Ploughs that sweep at the same time."""
    width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Width of the belt that is swept."""
    scraping_factor: Annotated[LineForce, Bounds(ge="0 N/m", le="20 kN/m")] = quantity(f"{SCRAPING_FACTOR.value:g} N/m")
    """Force per width, k_a."""
    position: Literal["head", "carry"] = "head"
    """Right before the head, or behind a section of the carry strand."""
    section: Name | None = None
    """The section, for position "carry"."""

    @model_validator(mode="after")
    def _placed(self) -> Self:
        if self.position == "carry" and self.section is None:
            message = 'missing: position "carry" stands behind a section; give its name'
            raise_problems("Plough", [Problem(("section",), message)])
        if self.position == "head" and self.section is not None:
            message = f'got "{self.section}" with position "head"; remove section, or set position to "carry"'
            raise_problems("Plough", [Problem(("section",), message)])
        return self
