"""The pint registry of the package: units of specs at once, all of pint's when a program needs more.

Reading all of pint's units takes longer than calculating a conveyor.
"""

from __future__ import annotations

from pathlib import Path
from threading import RLock
from typing import Any, Final

import pint

from conveyor.units.quantity_kinds import SPELLINGS

_DEFINITIONS: Final = """
@defaults
    group = international
    system = specs
@end
micro- = 1e-6 = µ- = μ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
meter = [length] = m
second = [time] = s
gram = [mass] = g
mole = [substance] = mol
kelvin = [temperature]; offset: 0 = K
radian = [] = rad
π = 3.1415926535897932384626433832795028841971693993751
standard_gravity = 9.80665 * meter / second ** 2 = g_0
degree = π / 180 * radian = deg
percent = 0.01 = %
metric_ton = 1e3 * kilogram = t
minute = 60 * second = min
hour = 60 * minute = h
day = 24 * hour = d
degree_Celsius = kelvin; offset: 273.15 = °C = degC = degreeC
degree_Fahrenheit = 5 / 9 * kelvin; offset: 233.15 + 200 / 9 = °F = degF = degreeF
yard = 0.9144 * meter = yd
inch = yard / 36 = in
foot = yard / 3 = ft
mile = 1760 * yard = mi
grain = 64.79891 * milligram = gr
pound = 7e3 * grain = lb
ton = 2e3 * pound = _ = short_ton
force_pound = g_0 * pound = lbf
hertz = 1 / second = Hz
mile_per_hour = mile / hour = mph
newton = kilogram * meter / second ** 2 = N
joule = newton * meter = J
watt = joule / second = W
watt_hour = watt * hour = Wh
horsepower = 550 * foot * force_pound / second = hp
pascal = newton / meter ** 2 = Pa
bar = 1e5 * pascal
pound_force_per_square_inch = force_pound / inch ** 2 = psi
stokes = centimeter ** 2 / second = St
foot_per_minute = foot / minute = fpm
metric_ton_per_hour = metric_ton / hour = tph
short_ton_per_hour = short_ton / hour = stph
pound_per_inch_width = force_pound / inch = PIW
@system specs using root
    kilogram
@end
"""
"""Definitions as in pint's file, and fpm, tph, stph, PIW."""


REGISTRY: Final[pint.UnitRegistry[Any]] = pint.UnitRegistry(_DEFINITIONS.splitlines(), on_redefinition="ignore")
REGISTRY.formatter.default_format = "~P"
_PINT_NAMES: Final = {
    "°": "degree",
    "Δ°C": "delta_degC",
    "Δ°F": "delta_degF",
    "rpm": "1/minute",
    "N/rpm": "newton*minute",
}
_SPEC_UNITS: Final = {name: REGISTRY.Unit(_PINT_NAMES.get(name, name)) for name in SPELLINGS.values()}
UNITS: Final[dict[str, Any]] = {form: _SPEC_UNITS[name] for form, name in SPELLINGS.items()}
"""Units of specs by each of their spellings."""


_READ_LOCK: Final = RLock()


def _load_all_units(text: str) -> str:
    """Load all of pint's units, at the first unit that a program gives as text."""
    with _READ_LOCK:
        if _load_all_units in REGISTRY.preprocessors:
            REGISTRY.preprocessors[REGISTRY.preprocessors.index(_load_all_units)] = _wait_for_units
            written = REGISTRY.formatter.default_format
            REGISTRY.formatter.default_format = ""  # pint compares long names
            REGISTRY.load_definitions(Path(pint.__file__).with_name("default_en.txt"))
            REGISTRY.formatter.default_format = written
            REGISTRY.preprocessors.remove(_wait_for_units)
    return text


def _wait_for_units(text: str) -> str:
    """Wait while another thread loads pint's units."""
    with _READ_LOCK:
        return text


REGISTRY.preprocessors.append(_load_all_units)
