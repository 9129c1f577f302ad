"""From the mass flow to the line load on every roll: cross-sections, shares, load along a roll."""

from conveyor.laws.loading.bulk import (
    CrossSection,
    bulk_line_mass,
    cross_section,
    filled_width,
    usable_width,
)
from conveyor.laws.loading.curves import (
    curve_belt_mass,
    curve_set_force,
    effective_tension,
)
from conveyor.laws.loading.heap import Heap, middle_share_by_area, surcharge_from_slope
from conveyor.laws.loading.rolls import RollLoad, line_loads, middle_share_belt, middle_share_bulk, roll_loads

__all__ = [
    "CrossSection",
    "Heap",
    "RollLoad",
    "bulk_line_mass",
    "cross_section",
    "curve_belt_mass",
    "curve_set_force",
    "effective_tension",
    "filled_width",
    "line_loads",
    "middle_share_belt",
    "middle_share_bulk",
    "middle_share_by_area",
    "roll_loads",
    "surcharge_from_slope",
    "usable_width",
]
