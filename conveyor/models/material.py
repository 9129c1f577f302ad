"""The bulk material and how much of it is carried."""

from __future__ import annotations

from typing import Annotated

from conveyor.models.base import Model, Name
from conveyor.units import Angle, Bounds, Density, MassFlow


class BulkMaterial(Model):
    """What the belt carries."""

    name: Name
    density: Annotated[Density, Bounds(gt="0 kg/m^3", le="20000 kg/m^3")]
    """Bulk density."""
    flow: Annotated[MassFlow, Bounds(ge="0 t/h", le="200000 t/h")]
    """Mass flow; 0 is the empty belt."""
    surcharge_angle: Annotated[Angle, Bounds(ge="0 deg", le="45 deg")]
    """Slope of the moving heap."""
