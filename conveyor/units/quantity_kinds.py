"""Kinds of quantity: how each is read from input and written in reports."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple


class Shown(NamedTuple):
    """How a kind is written in a system of units.

    Attributes
    ----------
    unit : str or None
        As specs spell it, if they know it; None for kinds without one.
    digits : str
        Python format of its numbers in tables; empty for six significant digits.
    large, small : tuple of (str, str), optional
        Another unit and its digits: on axes and for large figures of sentences, for figures of sentences below one.
    said : str
        Python format of its numbers in sentences; empty for three significant digits.
    """

    unit: str | None
    digits: str = ""
    large: tuple[str, str] | None = None
    small: tuple[str, str] | None = None
    said: str = ""


@dataclass(frozen=True)
class Kind:
    """A kind of quantity.

    Attributes
    ----------
    si : Shown
        How it is written with SI units, and in every system that does not say otherwise.
    noun, spelled, example : str
        Of input: what it is, its units ("^2" is also read as "²" and "2"), an example; empty for kinds of reports only.
    sizes : tuple of (float, float)
        Smallest and largest nonzero size in SI base units; so wide that products and ratios stay finite.
    base : str
        SI base unit as written, where reports have another.
    most : float
        Larger numbers are written "> most": their size is meaningless [unit of reports].
    """

    si: Shown
    noun: str = ""
    spelled: str = ""
    example: str = ""
    sizes: tuple[float, float] = (0.0, float("inf"))
    base: str = ""
    most: float = float("inf")
    units: dict[str, str] = field(init=False, repr=False, compare=False)
    """Output spelling of each accepted spelling."""

    def __post_init__(self) -> None:
        table = {form: name for name in self.spelled.split() for form in _unit_spellings(name)}
        if self.spelled and self.si.unit == NO_UNIT:
            table[""] = ""
        object.__setattr__(self, "units", table)
        if not self.base:
            object.__setattr__(self, "base", readable_unit(self.si.unit or ""))


NO_UNIT = "-"
"""Unit of ratios, in headers."""


def readable_unit(spelled: str) -> str:
    """A unit as people write it, from its spelling in specs.

    Examples
    --------
    >>> readable_unit("kg*m^2"), readable_unit("delta_degC")
    ('kg m²', 'Δ°C')
    """
    return spelled.replace("delta_deg", "Δ°").replace("^2", "²").replace("^3", "³").replace("*", " ")


def _unit_spellings(name: str) -> list[str]:
    """Spellings of a unit, the one used for output first."""
    forms = [name]
    for power, signs in {"^2": ("²", "2"), "^3": ("³", "3")}.items():
        forms += [name.replace(power, sign) for sign in signs if power in name]
    return forms


_LENGTHS = "mm cm m km in inch ft"
_SPEEDS = "m/s fpm ft/min km/h m/min ft/s mph"
_LINE_FORCES = "N/m kN/m N/mm lbf/in lbf/ft PIW"
_MASS_FLOWS = "t/h tph kg/s short_ton/h stph lb/h kg/h"

KINDS: dict[str, Kind] = {
    "length": Kind(Shown("m", ",.1f"), "a length", _LENGTHS, "1200 mm", (1e-9, 1e6)),
    "distance": Kind(Shown("m"), "a length", _LENGTHS, "150 m", (1e-9, 1e6)),
    "thickness": Kind(Shown("mm", ",.2f"), "a length", _LENGTHS, "6 mm", (1e-9, 1e6), "m"),
    "area": Kind(Shown("m^2", ".3f"), "an area", "mm^2 cm^2 m^2 in^2 ft^2", "0.2 m^2", (1e-9, 1e6)),
    "speed": Kind(Shown("m/s", ".2f"), "a speed", _SPEEDS, "5 m/s", (1e-6, 1e3)),
    "wind": Kind(Shown("m/s", ".1f"), "a speed", _SPEEDS, "15 m/s", (1e-6, 1e3)),
    "acceleration": Kind(Shown("m/s^2", ".3f"), "an acceleration", "m/s^2 ft/s^2", "9.81 m/s^2", (1e-6, 1e3)),
    "mass": Kind(Shown("kg", ",.0f"), "a mass", "kg g t lb short_ton", "15.5 kg", (1e-6, 1e9)),
    "line mass": Kind(Shown("kg/m", ".2f"), "a mass per length", "kg/m lb/ft t/m", "16.4 kg/m", (1e-6, 1e6)),
    "area mass": Kind(Shown("kg/m^2", ".3f"), "a mass per area", "kg/m^2 lb/ft^2", "27 kg/m^2", (1e-6, 1e6)),
    "belt mass": Kind(Shown("kg/m^2"), "a mass per area or per length", "kg/m^2 lb/ft^2 kg/m lb/ft", "27 kg/m^2",
                      (1e-6, 1e6)),
    "set mass": Kind(Shown("kg"), "a mass of a set or per length", "kg g lb kg/m lb/ft", "15.5 kg", (1e-6, 1e6)),
    "density": Kind(Shown("kg/m^3", ",.0f"), "a density", "kg/m^3 t/m^3 lb/ft^3 g/cm^3", "850 kg/m^3", (1e-3, 1e5)),
    "force": Kind(Shown("N", ",.0f", large=("kN", ",.1f")), "a force", "N kN MN lbf", "2.5 N", (1e-6, 1e10)),
    "line force": Kind(Shown("N/m", ",.2f"), "a force per width", _LINE_FORCES, "1600 N/mm", (1e-6, 1e10)),
    "spring rate": Kind(Shown("N/m"), "a spring rate", "N/m kN/m N/mm lbf/in", "400 kN/m", (1e-6, 1e10)),
    "pressure": Kind(Shown("MPa", ",.3f"), "a pressure", "Pa kPa MPa GPa psi N/mm^2 bar", "10 MPa", (1e-9, 1e15), "Pa"),
    "time": Kind(Shown("s", ",.1f"), "a time", "s ms us µs min h d", "0.1 s", (1e-25, 1e25)),
    "duration": Kind(Shown("h", ",.0f"), "a time", "h d min s", "5500 h", (1e-3, 1e9), "s", most=1e6),
    "frequency": Kind(Shown("Hz", ".2E"), "a frequency", "Hz mHz kHz MHz GHz", "10 Hz", (1e-25, 1e25)),
    "angular frequency": Kind(Shown("rad/s"), "an angular frequency", "rad/s", "63 rad/s", (1e-25, 1e25)),
    "rotation": Kind(Shown("rpm", ",.1f"), "a rotational speed", "rpm", "650 rpm", (1e-6, 1e4), "1/s"),
    "force per rotation": Kind(Shown("N/rpm"), "a force per rotational speed", "N/rpm", "0.001 N/rpm", (1e-9, 1e6),
                               "N s"),
    "moment": Kind(Shown("N*m"), "a moment", "N*m kN*m MN*m N*mm lbf*in lbf*ft", "0.02 N*m", (1e-9, 1e9)),
    "torque": Kind(Shown("N*m", ",.0f"), "a torque", "N*m kN*m MN*m lbf*ft lbf*in", "12 kN*m", (1e-9, 1e9)),
    "inertia": Kind(Shown("kg*m^2", ",.2f"), "a moment of inertia", "kg*m^2 lb*ft^2", "12 kg*m^2", (1e-9, 1e9)),
    "bending stiffness": Kind(Shown("N*m^2"), "a bending stiffness", "N*m^2 lbf*in^2", "30 N*m^2", (1e-9, 1e9)),
    "viscosity": Kind(Shown("mm^2/s"), "a kinematic viscosity", "mm^2/s cSt m^2/s", "100 mm^2/s", (1e-9, 1e3), "m²/s"),
    "temperature": Kind(Shown("degC", ".1f"), "a temperature", "degC degF K °C °F", "20 degC", (0.0, 1e4), "K"),
    "temperature difference": Kind(Shown("delta_degC"), "a temperature difference", "K delta_degC delta_degF Δ°C Δ°F",
                                   "50 K", (1e-9, 1e4), "K"),
    "angle": Kind(Shown("deg", ".2f"), "an angle", "deg rad °", "35 deg", (1e-9, 1e3), "rad"),
    "mass flow": Kind(Shown("t/h", ",.1f"), "a mass flow", _MASS_FLOWS, "2400 t/h", (1e-6, 1e6), "kg/s"),
    "volume flow": Kind(Shown("m^3/h"), "a volume flow", "m^3/h m^3/s ft^3/min", "2800 m^3/h", (1e-9, 1e6), "m³/s"),
    "power": Kind(Shown("kW", ",.1f"), "a power", "W kW MW hp", "500 kW", (1e-3, 1e12), "W"),
    "heat": Kind(Shown("MJ", ",.3f", small=("kJ", ",.1f")), "an energy", "J kJ MJ kWh MWh", "1500 kWh", (1e-3, 1e18),
                 "J"),
    "molar energy": Kind(Shown("kJ/mol"), "an energy per amount", "J/mol kJ/mol", "150 kJ/mol", (1e-3, 1e9), "J/mol"),
    "fraction": Kind(Shown("-"), 'a fraction (0.95 or "95 %")', "%", "95 %", (1e-9, 1e6)),
    "text": Kind(Shown(None)),
    "verdict": Kind(Shown(None)),
    "number": Kind(Shown(None, said="g")),
    "count": Kind(Shown(None, ",.0f")),
    "ratio": Kind(Shown("-", ".2f")),
    "share": Kind(Shown("-", ".1%")),
    "margin": Kind(Shown("-", ".1%"), most=1.0),
    "factor": Kind(Shown("-", ".3f")),
    "friction": Kind(Shown("-", ".4f")),
    "decades": Kind(Shown("-", ".4f")),
    "error": Kind(Shown("-", ".1E")),
    "safety": Kind(Shown("-", ".2f", said=".2f")),
    "relaxation time": Kind(Shown("s", ".2E")),
    "years": Kind(Shown("a", ".1f")),
    "passing": Kind(Shown("Hz", ",.0f")),
    "swing": Kind(Shown("Hz", ".1f")),
    "rise": Kind(Shown("K", ",.0f")),
    "warming": Kind(Shown("K", ".2f")),
    "spacing": Kind(Shown("m", ".2f")),
    "size": Kind(Shown("mm", ",.1f")),
    "roll force": Kind(Shown("N", ",.1f")),
    "strength": Kind(Shown("N/mm", ",.1f")),
    "belt strength": Kind(Shown("N/mm", ",.0f", said=",.0f")),
    "belt rating": Kind(Shown("N/mm", ",.1f")),
    "conveyed": Kind(Shown("t", ",.0f")),
    "carryback": Kind(Shown("kg/h", ",.1f")),
    "energy": Kind(Shown("MWh", ",.1f")),
    "specific energy": Kind(Shown("kWh/(t km)", ".4f")),
    "carbon dioxide": Kind(Shown("t", ",.0f")),
    "emission factor": Kind(Shown("kg/kWh", ".3f")),
}  # fmt: skip
"""Every kind of input and of reports; energies per mass and distance come in kWh/(t km), paybacks in years."""

INPUT_KINDS: dict[str, Kind] = {name: kind for name, kind in KINDS.items() if kind.noun}
"""The kinds of fields."""

SPELLINGS: dict[str, str] = {}
for _kind in KINDS.values():
    for _form, _name in _kind.units.items():
        SPELLINGS.setdefault(_form, _name)
