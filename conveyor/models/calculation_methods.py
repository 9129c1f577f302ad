"""Method of a calculation and its optional laws: flexure, CEMA, calibration factors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from conveyor.laws.resistance.cema import CLEANER_PER_INCH, PLOUGH_PER_INCH, SEALS_PER_FOOT
from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.units import Angle, BendingStiffness, Bounds, Force, LineForce, Thickness, quantity

Method = Literal["viscoelastic", "iso 5048", "din 22101", "cema classic"]
FACTOR_METHODS: Final[tuple[Method, ...]] = ("iso 5048", "din 22101")
"""Methods with one friction factor f."""
METHOD_NAMES: Final[Mapping[Method, str]] = {
    "viscoelastic": "rolling contact",
    "iso 5048": "ISO 5048",
    "din 22101": "DIN 22101",
    "cema classic": "CEMA classic",
}
"""Methods as reports name them."""


FrictionFactor = Annotated[Number, Field(gt=0, le=0.1)]
"""f of ISO 5048 and DIN 22101."""
FlexureFactor = Annotated[Number, Field(gt=0, le=0.1)]
"""Ky of CEMA."""


class BeltFlexure(Model):
    """Loss of the belt that bends over the idler sets: a tensioned beam with a loss tangent."""

    bending_stiffness: Annotated[BendingStiffness, Bounds(ge="0 N*m^2", le="100000 N*m^2")] = quantity("0 N*m^2")
    """Of the whole belt as it lies, lengthwise; 0 is the limit of a limp belt, which loses most."""
    loss_tangent: Annotated[Number, Field(ge=0, le=1)]
    """tan δ of the belt in bending at the frequency of the idler sets."""
    tension: Annotated[Force, Bounds(gt="0 N", le="10 MN")] | None = None
    """Belt tension it is computed at; the least that the sag allows without it, on the safe side."""


class BulkFlexure(Model):
    """Working of the bulk by the wings of the trough as they open between the sets: an upper bound."""

    opening_angle: Annotated[Angle, Bounds(ge="0 deg", le="30 deg")]
    """By which each wing opens between the sets, measured or computed."""
    friction_angle: Annotated[Angle, Bounds(ge="0 deg", le="60 deg")]
    """Inner friction of the bulk."""


class Flexure(Model):
    """Laws for the flexure of belt and bulk, instead of load and sag by one measured site."""

    belt: BeltFlexure | None = None
    bulk: BulkFlexure | None = None

    @model_validator(mode="after")
    def _something(self) -> Self:
        if self.belt is None and self.bulk is None:
            message = "missing: give belt, bulk or both, or remove flexure for the law of load and sag"
            raise_problems("Flexure", [Problem(("belt",), message)])
        return self


class Cema(Model):
    """Factors of the classic form of CEMA, from the user's copy of the book."""

    flexure_factor: FlexureFactor
    """Ky, from the book's table over spacing, slope, length and load (0.016 to 0.035); sections may have their own."""
    temperature_factor: Annotated[Number, Field(ge=1, le=10)] = 1.0
    """Kt, 1 above freezing."""
    idler_friction: Annotated[Force, Bounds(ge="0 N", le="1 kN")]
    """Ai of one idler set (1.5 to 2.8 lbf by roll diameter and series)."""
    skirt_factor: Annotated[Number, Field(ge=0, le=1)] | None = None
    """Cs of the bulk on the skirts, from the book's table; without it the seals alone."""
    skirt_depth: Annotated[Thickness, Bounds(ge="0 mm", le="2 m")] | None = None
    """Depth of the bulk that touches the skirts, hs; needed beside skirt_factor."""
    skirt_seals: Annotated[LineForce, Bounds(ge="0 N/m", le="10 kN/m")] = quantity(f"{SEALS_PER_FOOT.value:g} lbf/ft")
    """Friction of the rubber seals of both skirts along them; of a loading point with seal_drag that instead."""
    cleaner_friction: Annotated[LineForce, Bounds(ge="0 N/m", le="10 kN/m")] = quantity(
        f"{CLEANER_PER_INCH.value:g} lbf/in"
    )
    """Of a cleaner's blade, per its width."""
    plough_friction: Annotated[LineForce, Bounds(ge="0 N/m", le="10 kN/m")] = quantity(
        f"{PLOUGH_PER_INCH.value:g} lbf/in"
    )
    """Of a plough, per its width; 3 lbf/in of one that takes half."""
    pulley_friction: Annotated[Force, Bounds(ge="0 N", le="1 MN")] | None = None
    """Tp of all pulleys that are not driven, together; else 200, 150 or 100 lbf each by place and wrap."""
    drive_pulley_friction: Annotated[Force, Bounds(ge="0 N", le="1 MN")] = quantity("0 N")
    """Bearings of the drive pulleys at the belt: in the motor power, not in Te."""
    accessories: Annotated[Force, Bounds(ge="0 N", le="1 MN")] = quantity("0 N")
    """Other accessories, in Te: trippers, stackers, belt turnovers."""

    @model_validator(mode="after")
    def _skirts(self) -> Self:
        if (self.skirt_factor is None) != (self.skirt_depth is None):
            missing, given = "skirt_depth", "skirt_factor"
            if self.skirt_factor is None:
                missing, given = given, missing
            message = f"missing: {given} is given; the bulk on the skirts needs both, or remove {given}"
            raise_problems("Cema", [Problem((missing,), message)])
        return self


CALIBRATED_FORCES: Final = ("indentation", "idler_rotation", "flexure", "misalignment")
"""Keys of the forces that a calibration has a factor for."""
Factor = Annotated[Number, Field(gt=0, le=10)]


class Calibration(Model):
    """Factors on forces along the belt, from measured power (`conveyor calibrate`) or from experience."""

    indentation: Factor = 1.0
    """On the indentation of the covers by the rolls."""
    idler_rotation: Factor = 1.0
    """On the drag of all rolls."""
    flexure: Factor = 1.0
    """On the flexure of belt and bulk; flexure that is a share of the main resistance follows the other two as well."""
    misalignment: Factor = 1.0
    """On the drag of rolls that are not square to the belt."""
    source: Annotated[str, Field(min_length=1, max_length=500)] | None = None
    """Where they are from: conveyor, date, number of runs."""

    @property
    def factors(self) -> dict[str, float]:
        """Factors by force key."""
        return {name: getattr(self, name) for name in CALIBRATED_FORCES}
