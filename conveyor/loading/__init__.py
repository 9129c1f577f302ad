"""From the mass flow to the line load on every roll: cross-sections, shares, load along a roll."""

from conveyor.loading.bulk import CrossSection, bulk_line_mass, cross_section, fill_ratio, usable_width
from conveyor.loading.rolls import RollLoad, middle_share_belt, middle_share_bulk, roll_loads

__all__ = [
    "CrossSection",
    "RollLoad",
    "bulk_line_mass",
    "cross_section",
    "fill_ratio",
    "middle_share_belt",
    "middle_share_bulk",
    "roll_loads",
    "usable_width",
]
