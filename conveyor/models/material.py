"""The bulk material and how much of it is carried."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, Self

from pydantic import model_validator

from conveyor.laws.loading import surcharge_from_slope
from conveyor.models.base import Name, Problem, raise_problems
from conveyor.models.library_items import LibraryItem
from conveyor.models.maker_lists import EntryName
from conveyor.units import Angle, Bounds, Density, MassFlow, Quantity, si, text


class BulkMaterial(LibraryItem):
    """What the belt carries."""

    library: ClassVar = "materials"

    name: Name
    """What it is called in reports."""
    density: Annotated[Density, Bounds(ge="10 kg/m^3", le="20000 kg/m^3")]
    """Bulk density, loose: the flow over it fills the belt's cross-section."""
    weight_density: Annotated[Density, Bounds(ge="10 kg/m^3", le="20000 kg/m^3")] | None = None
    """Bulk density at its heaviest, for flooded belt, heavy bulk, lumps and wear; density without."""
    flow: Annotated[MassFlow, Bounds(ge="0 t/h", le="200000 t/h")]
    """Mass flow; 0 is the empty belt."""
    surcharge_angle: Annotated[Angle, Bounds(ge="0 deg", le="45 deg")]
    """Slope of the moving heap."""
    surcharge_convention: Literal["ISO 5048", "DIN 22101"] = "ISO 5048"
    """ISO 5048: of a parabola at its edge, θ; DIN 22101: of a triangle of the same area, tan β = 2/3 tan θ."""
    max_slope: Annotated[Angle, Bounds(gt="0 deg", le="45 deg")] | None = None
    """Steepest section it is carried on, up or down, as CEMA's recommended maximum inclination; 18 deg without it, in a
    pipe 27 deg."""
    listed: EntryName | None = None
    """Entry of the library of materials that gives what is not given here."""

    @model_validator(mode="after")
    def _weighs_what_it_fills(self) -> Self:
        heavy = self.weight_density
        if heavy is not None and si(heavy) < si(self.density):
            message = (
                f"got {text(heavy)}, less than the density {text(self.density)} that fills the belt: density is that "
                "of the loosest bulk, weight_density that of the heaviest; exchange the two"
            )
            raise_problems("BulkMaterial", [Problem(("weight_density",), message)])
        return self

    @property
    def heaviest(self) -> Quantity:
        """Bulk density for weight."""
        return self.density if self.weight_density is None else self.weight_density

    @property
    def surcharge(self) -> float:
        """Surcharge angle θ of the parabolic heap [rad], from either convention."""
        given = si(self.surcharge_angle)
        return given if self.surcharge_convention == "ISO 5048" else surcharge_from_slope(given)
