"""The route from tail to head, and what brakes the belt at single places."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from conveyor.models.base import Model, Name, Number, Problem, Switch, refuse
from conveyor.models.idlers import Spacing
from conveyor.resistance import (
    BULK_ON_BELT_FRICTION,
    BULK_ON_SKIRT_FRICTION,
    CLEANER_FRICTION,
    CLEANER_PRESSURE,
)
from conveyor.units import Angle, Bounds, Length, Mass, Pressure, Speed, Thickness, quantity, si, text

Friction = Annotated[Number, Field(gt=0, le=2)]


class Section(Model):
    """A straight part of the route, both strands; its lift or its slope, up in running direction positive."""

    name: Name
    length: Annotated[Length, Bounds(gt="0 m", le="100 km")]
    """Length along the belt."""
    lift: Annotated[Length, Bounds(ge="-5 km", le="5 km")] | None = None
    """Rise from its tail end to its head end; level without lift and slope."""
    slope: Annotated[Angle, Bounds(ge="-45 deg", le="45 deg")] | None = None
    """Angle to the level, instead of the lift."""
    carry_spacing: Spacing | None = None
    """Distance of the carry sets here, where it differs."""
    return_spacing: Spacing | None = None
    """Distance of the return sets here, where it differs."""
    loaded: Switch = True
    """Whether the carry strand bears bulk here."""

    @model_validator(mode="after")
    def _one_slope(self) -> Self:
        problems = []
        if self.lift is not None and self.slope is not None:
            problems.append(
                Problem(
                    ("slope",),
                    f"got slope {text(self.slope)} and lift {text(self.lift)}; give one of the two, remove the other",
                )
            )
        elif self.lift is not None and abs(si(self.lift)) >= si(self.length):
            problems.append(
                Problem(
                    ("lift",),
                    f"got {text(self.lift)}, but the section is only {text(self.length)} long; "
                    "the lift must be less than the length: correct lift or length",
                )
            )
        refuse("Section", problems)
        return self

    @property
    def rise(self) -> float:
        """Lift from tail end to head end [m]."""
        if self.slope is not None:
            return si(self.length) * math.sin(si(self.slope))
        return 0.0 if self.lift is None else si(self.lift)


class Feeding(Model):
    """The loading point and its skirts."""

    speed: Annotated[Speed, Bounds(ge="0 m/s", le="20 m/s")] = quantity("0 m/s")
    """Speed of the bulk in running direction as it lands."""
    skirt_length: Annotated[Length, Bounds(ge="0 m", le="1 km")]
    """Length of the skirts beyond the acceleration zone, which is computed."""
    skirt_width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Distance between the skirts."""
    belt_friction: Friction = BULK_ON_BELT_FRICTION.value
    """Friction of bulk on belt μ1."""
    skirt_friction: Friction = BULK_ON_SKIRT_FRICTION.value
    """Friction of bulk on skirts μ2."""


class Cleaner(Model):
    """A scraper on the belt, or several alike."""

    count: Annotated[int, Field(ge=1, le=100, strict=True)] = 1
    width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Length of the blade across the belt."""
    thickness: Annotated[Thickness, Bounds(gt="0 mm", le="200 mm")]
    """Thickness of the blade that touches the belt."""
    pressure: Annotated[Pressure, Bounds(ge="0 Pa", le="1 MPa")] = quantity(f"{CLEANER_PRESSURE.value:g} Pa")
    friction: Friction = CLEANER_FRICTION.value
    """Friction of blade on belt μ3."""


class Pulley(Model):
    """A pulley that bends the belt and turns in bearings."""

    name: Name
    position: Literal["head", "tail", "take-up"]
    """Which belt tension acts: drive at the head, tail end, or slack strand behind the drive."""
    diameter: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    shaft_diameter: Annotated[Length, Bounds(gt="0 m", le="2 m")]
    """Diameter of the shaft in its bearings."""
    mass: Annotated[Mass, Bounds(ge="0 kg", le="100 t")]
    wrap_angle: Annotated[Angle, Bounds(gt="0 deg", le="360 deg")] = quantity("180 deg")

    @model_validator(mode="after")
    def _shaft_inside(self) -> Self:
        if si(self.shaft_diameter) >= si(self.diameter):
            message = (
                f"got {text(self.shaft_diameter)}, but the pulley's diameter is {text(self.diameter)}; "
                "the shaft must be thinner: correct shaft_diameter or diameter"
            )
            refuse("Pulley", [Problem(("shaft_diameter",), message)])
        return self


class Route(Model):
    """Sections in running direction of the carry strand, tail first."""

    sections: Annotated[tuple[Section, ...], Field(min_length=1, max_length=1000)]
    feeding: Feeding | None = None
    cleaners: Annotated[tuple[Cleaner, ...], Field(max_length=100)] = ()
    pulleys: Annotated[tuple[Pulley, ...], Field(max_length=100)] = ()
    turned_over: Switch = False
    """Whether the return strand is turned over, so that its rolls run on the bottom cover too."""

    @model_validator(mode="after")
    def _names_once(self) -> Self:
        first: dict[str, int] = {}
        problems = []
        for i, section in enumerate(self.sections):
            if section.name in first:
                message = (
                    f'got "{section.name}", already the name of sections[{first[section.name]}]; '
                    "give each section its own name"
                )
                problems.append(Problem(("sections", i, "name"), message))
            first.setdefault(section.name, i)
        refuse("Route", problems)
        return self

    @property
    def length(self) -> float:
        """Length along the belt [m]."""
        return math.fsum(si(section.length) for section in self.sections)

    @property
    def rise(self) -> float:
        """Lift from tail to head [m]."""
        return math.fsum(section.rise for section in self.sections)
