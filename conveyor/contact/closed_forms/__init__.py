"""Closed forms for indentation and line contact: oracles for the solvers, with equation numbers."""

from conveyor.contact.closed_forms.hertz import (
    composite_plane_modulus,
    hertz_half_width,
    hertz_peak_pressure,
    plane_modulus,
    plate_symbol,
)
from conveyor.contact.closed_forms.hunter import (
    HunterContact,
    hunter,
    hunter_at_load,
    hunter_friction_peak,
    low_speed_friction,
)
from conveyor.contact.closed_forms.winkler import (
    WinklerContact,
    jonkers_friction,
    winkler,
    winkler_at_load,
    winkler_pressure,
)

__all__ = [
    "HunterContact",
    "WinklerContact",
    "composite_plane_modulus",
    "hertz_half_width",
    "hertz_peak_pressure",
    "hunter",
    "hunter_at_load",
    "hunter_friction_peak",
    "jonkers_friction",
    "low_speed_friction",
    "plane_modulus",
    "plate_symbol",
    "winkler",
    "winkler_at_load",
    "winkler_pressure",
]
