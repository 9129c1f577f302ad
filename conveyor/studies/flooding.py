"""Flooded belt: bulk from edge to edge or a full pipe over the whole route, with its forces, tensions, set loads.

A feeder that does not stop fills the belt to its edges, a pipe whole: the load for which structures are designed and
from which drives may have to start (general knowledge). The conveyor is not designed by it: nothing is checked, the
figures are listed with the installed ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.errors import ConveyorError
from conveyor.line.stretches import Stretch
from conveyor.models import LoadCase
from conveyor.models.variants import heavy_bulk, with_case
from conveyor.pipeline import calculate_many
from conveyor.reuse import ReuseCache
from conveyor.units import from_si

_RTOL = 1e-3
"""Of the contacts [-]: the flooded cross-section is known to per cents."""


@dataclass(frozen=True, eq=False)
class FloodedBelt:
    """A conveyor flooded to the brim on every section that bears bulk.

    Attributes
    ----------
    section, held : float
        Cross-section of the bulk, and that of ISO 5048 on a level belt [m²].
    found : CalculatedConveyor or None
        Forces, tensions and power, the take-up at its setting; None without an answer.
    reason : str
        Reason if it has no answer.
    """

    section: float
    held: float
    found: CalculatedConveyor | None
    reason: str = ""

    @property
    def heaviest(self) -> Stretch | None:
        """Carry stretch with the highest set load."""
        if self.found is None:
            return None
        carry = self.found.line.stretches[: self.found.line.count]
        return max(carry, key=_set_load)

    @property
    def set_load(self) -> float | None:
        """Largest force of belt and bulk on a carry set [N]; None without an answer."""
        return None if self.heaviest is None else _set_load(self.heaviest)

    @property
    def line_mass(self) -> float | None:
        """Mass of belt and bulk per length of the carry strand there, without the sets [kg/m]."""
        return None if self.heaviest is None else self.heaviest.line_mass


def _set_load(stretch: Stretch) -> float:
    """Force of belt and bulk on one set [N]."""
    return math.fsum(roll.force for roll in stretch.loads)


def flooded_belt(own: CalculatedConveyor, kept: ReuseCache | None = None) -> FloodedBelt | None:
    """Calculate a conveyor full to the brim with bulk at its heaviest; None if it carries no bulk.

    Parameters
    ----------
    own : CalculatedConveyor
        The spec's own load; its take-up setting is kept.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.
    """
    conveyor, line = own.conveyor, own.line
    section, held = conveyor.flooded_section, conveyor.section_on_slope(0.0)
    if line.flow == 0.0 or section == 0.0:
        return None
    material = heavy_bulk(conveyor.material)
    flow = from_si(section * line.speed * line.weight_density, "mass flow", "kg/s")
    try:
        filled = conveyor.replace(material=material.replace(flow=flow))
        flooded = with_case(filled, LoadCase.from_data({"name": "flooded", "loading": "full"}))
    except ConveyorError as error:
        return FloodedBelt(section, held, None, str(error))
    variant = Variant(flooded, own.temperature, take_up=own.balance.equilibrium.take_up)
    (found,) = calculate_many([variant], _RTOL, known=own, kept=kept)
    if not isinstance(found, CalculatedConveyor):
        return FloodedBelt(section, held, None, str(found))
    return FloodedBelt(section, held, found)
