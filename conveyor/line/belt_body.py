"""The belt in SI: width, carcass and covers."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.belt_strength import Condition, fall_severity, least_cover
from conveyor.laws.preliminary_sizing import wear_addition
from conveyor.laws.resistance import (
    CARCASS_BENDING,
)
from conveyor.laws.tension import usual_stiffness
from conveyor.line.optional_quantities import si_or_none
from conveyor.models import Conveyor
from conveyor.units import si


@dataclass(frozen=True)
class CoverRequirement:
    """Thickness of a cover and its requirement [m]: `least` over the carcass, `wear` in addition."""

    cover: str
    thickness: float
    least: float
    wear: float


@dataclass(frozen=True)
class BeltBody:
    """The belt: width, total thickness, carcass and covers (top, bottom) [m].

    Strength, rating and stiffness are per width [N/m], None not given; `relaxing` is the relaxing stiffness over the
    lasting one and its relaxation time [-, s].
    """

    width: float
    thickness: float
    line_mass: float
    carcass: str
    carcass_thickness: float
    cover_thicknesses: tuple[float, float]
    strength: float | None
    rating: float | None
    stiffness: float | None
    splice_strength: float | None
    splice_making: Condition
    duty: Condition
    permanent_stretch: float | None
    retardation: float | None
    bending: float
    """D' of the carcass per width [N m]."""
    bending_loss: float
    relaxing: tuple[float, float] | None = None
    bears: tuple[float | None, float | None] = (None, None)
    """Lowest and highest temperature [K]; None not given."""
    covers: tuple[CoverRequirement, ...] = ()
    """Empty where the spec gives no wear."""

    @property
    def tensile_stiffness(self) -> float | None:
        """Per width [N/m]: as given, else a usual multiple of strength or rating; None without any."""
        if self.stiffness is not None:
            return self.stiffness
        return usual_stiffness(self.strength, rating=self.rating, carcass=self.carcass)

    @property
    def steel_cord(self) -> bool:
        """True for a steel-cord carcass."""
        return self.carcass == "steel cord"


def belt_body(conveyor: Conveyor) -> BeltBody:
    """The belt of a conveyor."""
    belt, carcass, width = conveyor.belt, conveyor.belt.carcass, si(conveyor.belt.width)
    parts = (belt.top_cover.thickness, belt.bottom_cover.thickness, carcass.thickness)
    return BeltBody(
        width=width,
        thickness=math.fsum(map(si, parts)),
        line_mass=belt.line_mass,
        carcass=carcass.kind,
        carcass_thickness=si(carcass.thickness),
        cover_thicknesses=(si(belt.top_cover.thickness), si(belt.bottom_cover.thickness)),
        strength=si_or_none(carcass.strength),
        rating=si_or_none(carcass.rating),
        stiffness=si_or_none(carcass.stiffness),
        splice_strength=si_or_none(carcass.splice_strength),
        splice_making=carcass.splice_making,
        duty=carcass.duty,
        permanent_stretch=si_or_none(carcass.permanent_stretch),
        retardation=si_or_none(carcass.retardation_time),
        bending=CARCASS_BENDING.value if carcass.bending_stiffness is None else si(carcass.bending_stiffness) / width,
        bending_loss=carcass.bending_loss,
        relaxing=None
        if carcass.relaxing_stiffness is None or carcass.relaxation_time is None
        else (si(carcass.relaxing_stiffness), si(carcass.relaxation_time)),
        bears=(si_or_none(belt.lowest_temperature), si_or_none(belt.highest_temperature)),
        covers=_cover_requirements(conveyor),
    )


def _cover_requirements(conveyor: Conveyor) -> tuple[CoverRequirement, ...]:
    """Required covers where the spec gives the wear."""
    belt = conveyor.belt
    if belt.wear is None:
        return ()
    feeding = conveyor.route.feeding
    drop = 0.0 if feeding is None or feeding.drop_height is None else si(feeding.drop_height)
    least = least_cover(si(belt.carcass.thickness), steel_cord=belt.carcass.kind == "steel cord")
    wear = wear_addition(
        lump=si(belt.wear.lump),
        density=si(conveyor.material.heaviest),
        round_time=2.0 * conveyor.route.length / si(belt.speed),
        abrasiveness=belt.wear.abrasiveness,
        loading=belt.wear.loading or fall_severity(drop),
    )
    return (
        CoverRequirement("top", si(belt.top_cover.thickness), least, wear),
        CoverRequirement("bottom", si(belt.bottom_cover.thickness), least, 0.0),
    )
