"""The bulk material and how much of it is carried."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from conveyor.laws.loading import surcharge_from_slope
from conveyor.models.base import Name
from conveyor.models.library_items import EntryName, LibraryItem
from conveyor.units import Angle, Bounds, Density, MassFlow, si


class BulkMaterial(LibraryItem):
    """What the belt carries."""

    library: ClassVar = "materials"

    name: Name
    """What it is called in reports."""
    density: Annotated[Density, Bounds(gt="0 kg/m^3", le="20000 kg/m^3")]
    """Bulk density."""
    flow: Annotated[MassFlow, Bounds(ge="0 t/h", le="200000 t/h")]
    """Mass flow; 0 is the empty belt."""
    surcharge_angle: Annotated[Angle, Bounds(ge="0 deg", le="45 deg")]
    """Slope of the moving heap."""
    surcharge_convention: Literal["ISO 5048", "DIN 22101"] = "ISO 5048"
    """ISO 5048: of a parabola at its edge, θ; DIN 22101: of a triangle of the same area, tan β = 2/3 tan θ."""
    listed: EntryName | None = None
    """Entry of the library of materials that gives what is not given here."""

    @property
    def surcharge(self) -> float:
        """Surcharge angle θ of the parabolic heap [rad], from either convention."""
        given = si(self.surcharge_angle)
        return given if self.surcharge_convention == "ISO 5048" else surcharge_from_slope(given)
