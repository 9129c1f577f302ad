"""The belt: covers, carcass, width, speed and mass."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, ClassVar, Final, Literal, Self

from pydantic import Field, model_validator

from conveyor.laws.preliminary_sizing import Severity
from conveyor.models.base import AnyInteger, Model, Number, Problem, raise_problems, value_digest
from conveyor.models.compound import CompoundReference, RubberCompound
from conveyor.models.library_items import LibraryItem
from conveyor.models.maker_lists import Listed
from conveyor.units import (
    AreaMass,
    BeltMass,
    BendingStiffness,
    Bounds,
    Fraction,
    Length,
    LineForce,
    Moment,
    Quantity,
    Speed,
    Temperature,
    Thickness,
    Time,
    is_kind,
    si,
    text,
    unit_system,
)
from conveyor.units.presentation import format_figure

RUBBER_DENSITY: Final = 1150.0
"""Density of cover rubber where the compound states none [kg/m³]: about 1.15 kg/m² per mm of cover."""
THICKNESS_TOLERANCE: Final = 0.5e-3
"""Precision of listed belt thicknesses [m]: a larger mismatch is a slip."""

CoverThickness = Annotated[Thickness, Bounds(gt="0 mm", le="50 mm")]


def _rubber_density(compound: RubberCompound | None) -> float:
    return RUBBER_DENSITY if compound is None or compound.density is None else si(compound.density)


class Cover(Model):
    """A cover that rolls run on: its rubber decides the indentation resistance."""

    thickness: CoverThickness
    """As new, or as worn as it is to be calculated."""
    compound: CompoundReference
    """Rubber: a shelf name, the path of a compound file, or the compound itself."""

    @property
    def area_mass(self) -> float:
        """Mass per area [kg/m²]."""
        return si(self.thickness) * _rubber_density(self.compound)


class TopCover(Model):
    """The carrying-side cover; the return rolls run on it unless the belt is turned over."""

    thickness: CoverThickness
    """As new, or as worn as it is to be calculated."""
    compound: CompoundReference | None = None
    """Rubber; without it the bottom cover's is taken for the return rolls."""

    @property
    def area_mass(self) -> float:
        """Mass per area [kg/m²]."""
        return si(self.thickness) * _rubber_density(self.compound)


class BulkWear(Model):
    """How the bulk wears the top cover, for the thickness that DIN 22101 asks for."""

    lump: Annotated[Length, Bounds(ge="0 mm", le="2 m")]
    """Largest size of the bulk."""
    abrasiveness: Severity = "medium"
    """Low: grain, wood; medium: coal, soft ores; high: hard, sharp-edged ore and stone."""
    loading: Severity | None = None
    """How hard the bulk lands: height of fall and difference of speeds; by route.feeding.drop_height without it."""


class Carcass(Model):
    """The tension member between the covers."""

    kind: Literal[
        "steel cord", "EP", "polyamide", "aramid", "cotton", "solid woven", "PVC solid woven", "PVG solid woven"
    ]
    """Material: decides pulley diameters and the resistance of wrapping a pulley; solid woven are all calculated alike,
    as textile."""
    plies: Annotated[int, Field(ge=1, le=20, strict=True), AnyInteger] | None = None
    """Of fabric; said in reports, no figure uses it."""
    thickness: Annotated[Thickness, Bounds(gt="0 mm", le="50 mm")]
    """Of plies or cords between the covers."""
    mass: Annotated[AreaMass, Bounds(gt="0 kg/m^2", le="200 kg/m^2")] | None = None
    """Mass per area of the carcass alone; needed where the belt's mass is not given."""
    strength: Annotated[LineForce, Bounds(gt="0 N/mm", le="20000 N/mm")] | None = None
    """Nominal breaking strength per width (ST1600: 1600 N/mm; EP800: 800 N/mm, 4570 lbf/in); not in PIW."""
    rating: Annotated[LineForce, Bounds(gt="0 N/mm", le="5000 N/mm")] | None = None
    """Rated working tension per width, as US belts are sold: a "600 PIW" belt; instead of the strength or beside it."""
    stiffness: Annotated[LineForce, Bounds(gt="0 N/mm", le="1000000 N/mm")] | None = None
    """Tensile stiffness per width; without it a multiple of the strength (of steel cord 72 times), or of rating."""
    bending_stiffness: Annotated[BendingStiffness, Bounds(ge="0 N*m^2", le="10000 N*m^2")] | None = None
    """Of the carcass, flat, over the belt's width, for calculation.support belt; 15 N m² a metre without it."""
    bending_loss: Annotated[Number, Field(ge=0, le=1)] = 0.0
    """tan δ of the carcass in bending, for calculation.support belt; without it the covers alone lose."""
    retardation_time: Annotated[Time, Bounds(ge="0 s", le="10 s")] | None = None
    """Damping of the belt lengthwise, force = stiffness (strain + time x its rate), for scenarios; 0.1 s without it, 0
    where relaxation_time is given."""
    relaxing_stiffness: Annotated[Fraction, Bounds(gt="0 %", le="1000 %")] | None = None
    """Of a standard solid: stiffness that fades with relaxation_time, beside the lasting one and over it."""
    relaxation_time: Annotated[Time, Bounds(gt="0 s", le="1 h")] | None = None
    """In which relaxing_stiffness fades at held strain."""
    permanent_stretch: Annotated[Fraction, Bounds(ge="0 %", le="10 %")] | None = None
    """Lasting elongation over the belt's life; 0.1 % of steel cord and 0.75 % of others without it."""
    splice_strength: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """Endurance of the splice over the nominal strength, by test or from the belt's maker."""
    splice_making: Literal["favourable", "normal", "unfavourable"] = "normal"
    """Conditions under which the splice is made."""
    duty: Literal["favourable", "normal", "unfavourable"] = "normal"
    """Life wanted, consequences of a failure, and how hard the belt is used."""

    @model_validator(mode="after")
    def _named(self) -> Self:
        strength, rating, problems = self.strength, self.rating, []
        if strength is not None and text(strength).endswith(" PIW"):
            message = (
                f"got {text(strength)}: PIW says what a belt is rated to work at, not where it breaks; give "
                f"rating: {text(strength)}, or the breaking strength in lbf/in or N/mm"
            )
            problems.append(Problem(("strength",), message))
        elif strength is not None and rating is not None and si(rating) >= si(strength):
            message = f"got {text(rating)}, but the belt breaks at {text(strength)} (strength); correct one of the two"
            problems.append(Problem(("rating",), message))
        if self.kind == "steel cord" and self.plies is not None:
            problems.append(Problem(("plies",), f"got {self.plies}, but cords of steel (kind) are no plies; remove it"))
        if strength is None and self.splice_strength is not None:
            message = "given without the strength it is a share of; give strength, or remove it"
            problems.append(Problem(("splice_strength",), message))
        if (self.relaxing_stiffness is None) != (self.relaxation_time is None):
            names = ("relaxing_stiffness", "relaxation_time")
            missing, other = names if self.relaxing_stiffness is None else names[::-1]
            problems.append(Problem((missing,), f"missing: {other} is given and needs it, or remove {other}"))
        raise_problems("Carcass", problems)
        return self


class Belt(LibraryItem):
    """A belt as listed by its maker, and its speed."""

    library: ClassVar = "belts"

    width: Annotated[Length, Bounds(ge="100 mm", le="5 m")]
    """Width of the belt."""
    speed: Annotated[Speed, Bounds(gt="0 m/s", le="20 m/s")]
    """Speed of the belt in steady running."""
    top_cover: TopCover
    bottom_cover: Cover
    carcass: Carcass
    mass: Annotated[BeltMass, Bounds()] | None = None
    """Mass per area or per length of the whole belt; else from covers and carcass."""
    thickness: Annotated[Thickness, Bounds(gt="0 mm", le="150 mm")] | None = None
    """Total thickness, to check covers and carcass against."""
    transverse_stiffness: Annotated[Moment, Bounds(gt="0 N*m", le="10 kN*m")] | None = None
    """Bending stiffness E I across the belt over its length, which holds a pipe open."""
    wear: BulkWear | None = None
    """How the bulk wears the top cover; without it the covers' thickness is not checked."""
    lowest_temperature: Annotated[Temperature, Bounds(ge="-100 degC", le="200 degC")] | None = None
    """Lowest temperature that covers and carcass bear, by the belt's maker."""
    highest_temperature: Annotated[Temperature, Bounds(ge="-100 degC", le="400 degC")] | None = None
    """Highest temperature that they bear."""
    listed: Listed | None = None
    """Entry of the belt library, or item of a maker's list, that gives what is not given here."""

    @model_validator(mode="after")
    def _check_consistency(self) -> Self:
        raise_problems("Belt", self._problems())
        return self

    @cached_property
    def body_fingerprint(self) -> bytes:
        """Digest of everything but the rubber of the covers: equal for belts that differ in it alone."""
        covers = {"top_cover": self.top_cover.thickness, "bottom_cover": self.bottom_cover.thickness}
        fields = (covers.get(name) or getattr(self, name) for name in Belt.model_fields)
        return value_digest(self.line_mass, *fields)

    def _problems(self) -> list[Problem]:
        problems = []
        parts = (self.top_cover.thickness, self.bottom_cover.thickness, self.carcass.thickness)
        total = sum(si(part) for part in parts)
        if self.thickness is not None and abs(total - si(self.thickness)) > THICKNESS_TOLERANCE:
            listed = " + ".join(text(part) for part in parts)
            problems.append(
                Problem(
                    ("thickness",),
                    f"got {text(self.thickness)}, but top cover + bottom cover + carcass are {listed} = "
                    f"{format_figure(total, 'thickness', unit_system(self.thickness), as_input=True)}; correct "
                    "belt.thickness or the part that is wrong",
                )
            )
        low, high = self.lowest_temperature, self.highest_temperature
        if low is not None and high is not None and si(low) >= si(high):
            message = f"got {text(high)}, not more than lowest_temperature {text(low)}; correct one of the two"
            problems.append(Problem(("highest_temperature",), message))
        if self.mass is None and self.carcass.mass is None:
            problems.append(
                Problem(("mass",), "missing: give belt.mass or belt.carcass.mass, the belt's mass is not known")
            )
        elif self.mass is not None and si(self.mass) <= 0.0:
            problems.append(Problem(("mass",), f"got {text(self.mass)}, allowed: > 0"))
        elif self.line_mass <= self._cover_line_mass:
            problems.append(
                Problem(
                    ("mass",),
                    f"got {self._mass_as_given()}, but the rubber of the covers alone weighs "
                    f"{self._in_words(self._cover_line_mass)}; correct belt.mass (per area or per length?) "
                    "or the covers",
                )
            )
        return problems

    def _mass_as_given(self) -> str:
        given: Quantity | None = self.mass
        return self._in_words(self.line_mass) if given is None else text(given)

    def _in_words(self, line_mass: float) -> str:
        """Mass per length as text; per area where the belt's mass is given so; units of the width."""
        system = unit_system(self.width)
        if self.mass is None or is_kind(self.mass, "line mass"):
            return format_figure(line_mass, "line mass", system, as_input=True)
        return format_figure(line_mass / si(self.width), "area mass", system, as_input=True)

    @property
    def _cover_line_mass(self) -> float:
        return (self.top_cover.area_mass + self.bottom_cover.area_mass) * si(self.width)

    @property
    def line_mass(self) -> float:
        """Mass per length m'_belt [kg/m]: as given, else of covers and carcass."""
        if self.mass is not None:
            return si(self.mass) * (1.0 if is_kind(self.mass, "line mass") else si(self.width))
        carcass = 0.0 if self.carcass.mass is None else si(self.carcass.mass)
        return self._cover_line_mass + carcass * si(self.width)
