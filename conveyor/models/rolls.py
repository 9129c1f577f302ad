"""Rolls: size, drag, bearings."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from conveyor.laws.resistance import (
    BEARING_F0,
    BEARING_F1_EXPONENT,
    BEARING_F1_FACTOR,
    TEST_LOAD,
    TEST_ROTATION,
)
from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.models.library_items import LibraryItem
from conveyor.models.maker_lists import Listed
from conveyor.units import (
    Angle,
    Bounds,
    Force,
    ForcePerRotation,
    Length,
    Mass,
    Moment,
    Rotation,
    Temperature,
    TemperatureDifference,
    Viscosity,
    from_si,
    quantity,
    si,
    text,
)

Drag = Annotated[Force, Bounds(ge="0 N", le="1 kN")]
OilTemperature = Annotated[Temperature, Bounds(ge="-60 degC", le="200 degC")]
OilViscosity = Annotated[Viscosity, Bounds(ge="2 mm^2/s", le="10000 mm^2/s")]


class MakerDrag(Model):
    """Straight line through a measured drag, as makers publish it: over load and speed."""

    law: Literal["maker"]
    drag: Drag
    """Measured running drag at the rim."""
    load: Annotated[Force, Bounds(ge="0 N", le="100 kN")] = from_si(TEST_LOAD, "force")
    """Load of the roll in the measurement; else that of the acceptance test."""
    rotation: Annotated[Rotation, Bounds(ge="0 rpm", le="5000 rpm")] = from_si(TEST_ROTATION, "rotation")
    """Rotational speed in the measurement; else that of the acceptance test."""
    load_slope: Annotated[Number, Field(ge=0, le=0.1)] = 0.0
    """Newtons of drag per newton of load."""
    rotation_slope: Annotated[ForcePerRotation, Bounds(ge="0 N/rpm", le="1 N/rpm")] = quantity("0 N/rpm")
    """Drag per rotational speed."""


class BearingDrag(Model):
    """Drag from the friction of two equal bearings (Palmgren) and of the seals, over load, speed, temperature."""

    law: Literal["bearing"]
    mean_diameter: Annotated[Length, Bounds(gt="5 mm", le="500 mm")]
    """Of a bearing: mean of bore and outside diameter."""
    static_rating: Annotated[Force, Bounds(gt="0 N", le="10 MN")]
    """Static load rating C0 of a bearing."""
    first_viscosity: OilViscosity
    """Viscosity of the grease's base oil at the first temperature."""
    second_viscosity: OilViscosity
    """The same at the second temperature."""
    first_temperature: OilTemperature = quantity("40 degC")
    """Temperature of the first viscosity."""
    second_temperature: OilTemperature = quantity("100 degC")
    """Temperature of the second viscosity."""
    seal_moment: Annotated[Moment, Bounds(ge="0 N*m", le="10 N*m")]
    """Friction moment of the seals of one end."""
    warming: Annotated[TemperatureDifference, Bounds(ge="0 K", le="100 K")] = quantity("0 K", "temperature difference")
    """How much warmer than the air the running bearings are; none is on the safe side."""
    f0: Annotated[Number, Field(ge=0, le=20)] = BEARING_F0.value
    """Factor of the no-load moment, from bearing type and lubrication."""
    f1_factor: Annotated[Number, Field(ge=0, le=0.01)] = BEARING_F1_FACTOR.value
    """z of the load moment's factor z (P/C0)^y."""
    f1_exponent: Annotated[Number, Field(ge=0, le=2)] = BEARING_F1_EXPONENT.value
    """y of the load moment's factor."""

    @model_validator(mode="after")
    def _thinner_when_hot(self) -> Self:
        first, second = si(self.first_temperature), si(self.second_temperature)
        if first == second:
            message = f"got {text(self.second_temperature)}, that of the first viscosity; two are needed"
            raise_problems("BearingDrag", [Problem(("second_temperature",), message)])
        if (second - first) * (si(self.first_viscosity) - si(self.second_viscosity)) <= 0.0:
            message = (
                f"got {text(self.second_viscosity)} at {text(self.second_temperature)} and "
                f"{text(self.first_viscosity)} at {text(self.first_temperature)}; the hotter oil is the thinner"
            )
            raise_problems("BearingDrag", [Problem(("second_viscosity",), message)])
        return self


class RollBearing(Model):
    """The two equal bearings of a roll, for its rating life and the slope of its axle."""

    dynamic_rating: Annotated[Force, Bounds(gt="0 N", le="10 MN")]
    """Dynamic load rating C of a bearing."""
    distance: Annotated[Length, Bounds(gt="0 mm", le="5 m")]
    """Distance of the bearings along the roll, in its middle."""
    kind: Literal["ball", "roller"] = "ball"
    """Rolling elements: decide the exponent of the life."""
    axle_diameter: Annotated[Length, Bounds(gt="0 mm", le="300 mm")] | None = None
    """Of the axle between the bearings, for its slope at them."""
    support_distance: Annotated[Length, Bounds(gt="0 mm", le="6 m")] | None = None
    """Distance of the places where the frame holds the axle; needed beside axle_diameter."""
    allowed_slope: Annotated[Angle, Bounds(gt="0 deg", le="5 deg")] = quantity("0.1667 deg")
    """Slope of the axle that the bearings bear; 10 minutes of arc of greased ball bearings without it."""

    @model_validator(mode="after")
    def _supported(self) -> Self:
        if (self.axle_diameter is None) != (self.support_distance is None):
            names = ("axle_diameter", "support_distance")
            missing, other = names if self.axle_diameter is None else names[::-1]
            message = f"missing: {other} is given and needs it, or remove {other}"
            raise_problems("RollBearing", [Problem((missing,), message)])
        if self.support_distance is not None and si(self.support_distance) <= si(self.distance):
            message = (
                f"got {text(self.support_distance)}, but the bearings stand {text(self.distance)} apart between them; "
                "correct one of the two"
            )
            raise_problems("RollBearing", [Problem(("support_distance",), message)])
        return self


class Roll(LibraryItem):
    """One roll."""

    library: ClassVar = "rolls"

    diameter: Annotated[Length, Bounds(ge="20 mm", le="1 m")]
    """Of the shell, outside."""
    length: Annotated[Length, Bounds(gt="0 mm", le="5 m")]
    """Length of the shell."""
    rotating_mass: Annotated[Mass, Bounds(gt="0 kg", le="1000 kg")] | None = None
    """Mass of the parts that turn; needed where that of the sets is not given."""
    drag: Drag | None = None
    """Running drag of the roll (bearings and seals) at its rim; else as calculation.roll_drag says."""
    drag_law: Annotated[MakerDrag | BearingDrag, Field(discriminator="law")] | None = None
    """Law of the drag over load, speed and temperature, instead of one figure."""
    bearing: RollBearing | None = None
    """Bearings, for the rating life; without them no life is computed."""
    listed: Listed | None = None
    """Entry of the roll library, or item of a maker's list, that gives what is not given here."""

    @model_validator(mode="after")
    def _one_drag(self) -> Self:
        problems = []
        axle = None if self.bearing is None else self.bearing.axle_diameter
        if axle is not None and si(axle) >= si(self.diameter):
            message = f"got {text(axle)}, but the roll's diameter is {text(self.diameter)}; correct one of the two"
            problems.append(Problem(("bearing", "axle_diameter"), message))
        if self.drag is not None and self.drag_law is not None:
            message = f"given beside drag {text(self.drag)}; give one of the two, remove the other"
            problems.append(Problem(("drag_law",), message))
        if isinstance(self.drag_law, BearingDrag) and si(self.drag_law.mean_diameter) >= si(self.diameter):
            message = (
                f"got {text(self.drag_law.mean_diameter)}, but the roll's diameter is {text(self.diameter)}; "
                "the bearings sit inside: correct one of the two"
            )
            problems.append(Problem(("drag_law", "mean_diameter"), message))
        raise_problems("Roll", problems)
        return self
