"""Kinds of quantity: name, accepted units, units of reports."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Kind:
    """A kind of quantity: noun, spelled units ("^2" is also read as "²" and "2"), example, report units."""

    noun: str
    spelled: str
    example: str
    si: str
    us: str
    units: dict[str, str] = field(init=False, repr=False, compare=False)
    """Output spelling of each accepted spelling."""

    def __post_init__(self) -> None:
        table = {form: name for name in self.spelled.split() for form in _unit_spellings(name)}
        if self.si == "":
            table[""] = ""
        object.__setattr__(self, "units", table)

    @property
    def expected(self) -> str:
        """Expected input, for messages: noun and example."""
        return self.noun if self.si == "" else f'{self.noun} such as "{self.example}"'


def _unit_spellings(name: str) -> list[str]:
    """Spellings of a unit, the one used for output first."""
    forms = [name]
    for power, signs in {"^2": ("²", "2"), "^3": ("³", "3")}.items():
        forms += [name.replace(power, sign) for sign in signs if power in name]
    return forms


_TEMPERATURES = "degC degF K °C °F"
_DIFFERENCES = "K delta_degC delta_degF Δ°C Δ°F"

KINDS: dict[str, Kind] = {
    "length": Kind("a length", "mm cm m km in inch ft", "1200 mm", "m", "ft"),
    "distance": Kind("a length", "mm cm m km in inch ft", "150 m", "m", "ft"),
    "thickness": Kind("a length", "mm cm m km in inch ft", "6 mm", "mm", "in"),
    "area": Kind("an area", "mm^2 cm^2 m^2 in^2 ft^2", "0.2 m^2", "m^2", "ft^2"),
    "speed": Kind("a speed", "m/s fpm ft/min km/h m/min ft/s mph", "5 m/s", "m/s", "fpm"),
    "wind": Kind("a speed", "m/s fpm ft/min km/h m/min ft/s mph", "15 m/s", "m/s", "mph"),
    "acceleration": Kind("an acceleration", "m/s^2 ft/s^2", "9.81 m/s^2", "m/s^2", "ft/s^2"),
    "mass": Kind("a mass", "kg g t lb short_ton", "15.5 kg", "kg", "lb"),
    "line mass": Kind("a mass per length", "kg/m lb/ft t/m", "16.4 kg/m", "kg/m", "lb/ft"),
    "area mass": Kind("a mass per area", "kg/m^2 lb/ft^2", "27 kg/m^2", "kg/m^2", "lb/ft^2"),
    "belt mass": Kind("a mass per area or per length", "kg/m^2 lb/ft^2 kg/m lb/ft", "27 kg/m^2", "kg/m^2", "lb/ft^2"),
    "set mass": Kind("a mass of a set or per length", "kg g lb kg/m lb/ft", "15.5 kg", "kg", "lb"),
    "density": Kind("a density", "kg/m^3 t/m^3 lb/ft^3 g/cm^3", "850 kg/m^3", "kg/m^3", "lb/ft^3"),
    "force": Kind("a force", "N kN MN lbf", "2.5 N", "N", "lbf"),
    "line force": Kind("a force per width", "N/m kN/m N/mm lbf/in lbf/ft PIW", "1600 N/mm", "N/m", "lbf/in"),
    "spring rate": Kind("a spring rate", "N/m kN/m N/mm lbf/in", "400 kN/m", "N/m", "lbf/in"),
    "pressure": Kind("a pressure", "Pa kPa MPa GPa psi N/mm^2 bar", "10 MPa", "MPa", "psi"),
    "time": Kind("a time", "s ms us µs min h d", "0.1 s", "s", "s"),
    "duration": Kind("a time", "h d min s", "5500 h", "h", "h"),
    "frequency": Kind("a frequency", "Hz mHz kHz MHz GHz", "10 Hz", "Hz", "Hz"),
    "angular frequency": Kind("an angular frequency", "rad/s", "63 rad/s", "rad/s", "rad/s"),
    "rotation": Kind("a rotational speed", "rpm", "650 rpm", "rpm", "rpm"),
    "force per rotation": Kind("a force per rotational speed", "N/rpm", "0.001 N/rpm", "N/rpm", "N/rpm"),
    "moment": Kind("a moment", "N*m kN*m MN*m N*mm lbf*in lbf*ft", "0.02 N*m", "N*m", "lbf*in"),
    "torque": Kind("a torque", "N*m kN*m MN*m lbf*ft lbf*in", "12 kN*m", "N*m", "lbf*ft"),
    "inertia": Kind("a moment of inertia", "kg*m^2 lb*ft^2", "12 kg*m^2", "kg*m^2", "lb*ft^2"),
    "bending stiffness": Kind("a bending stiffness", "N*m^2 lbf*in^2", "30 N*m^2", "N*m^2", "lbf*in^2"),
    "viscosity": Kind("a kinematic viscosity", "mm^2/s cSt m^2/s", "100 mm^2/s", "mm^2/s", "cSt"),
    "temperature": Kind("a temperature", _TEMPERATURES, "20 degC", "degC", "degF"),
    "temperature difference": Kind("a temperature difference", _DIFFERENCES, "50 K", "delta_degC", "delta_degF"),
    "angle": Kind("an angle", "deg rad °", "35 deg", "deg", "deg"),
    "mass flow": Kind("a mass flow", "t/h tph kg/s short_ton/h stph lb/h kg/h", "2400 t/h", "t/h", "stph"),
    "volume flow": Kind("a volume flow", "m^3/h m^3/s ft^3/min", "2800 m^3/h", "m^3/h", "ft^3/min"),
    "power": Kind("a power", "W kW MW hp", "500 kW", "kW", "hp"),
    "energy": Kind("an energy", "J kJ MJ kWh MWh", "1500 kWh", "MJ", "MJ"),
    "molar energy": Kind("an energy per amount", "J/mol kJ/mol", "150 kJ/mol", "kJ/mol", "kJ/mol"),
    "fraction": Kind('a fraction (0.95 or "95 %")', "%", "95 %", "", ""),
}

MAGNITUDES: dict[str, tuple[float, float]] = {
    "length": (1e-9, 1e6), "distance": (1e-9, 1e6), "thickness": (1e-9, 1e6), "area": (1e-9, 1e6),
    "speed": (1e-6, 1e3), "wind": (1e-6, 1e3),
    "acceleration": (1e-6, 1e3), "mass": (1e-6, 1e9), "line mass": (1e-6, 1e6), "area mass": (1e-6, 1e6),
    "belt mass": (1e-6, 1e6), "set mass": (1e-6, 1e6), "density": (1e-3, 1e5),
    "force": (1e-6, 1e10), "line force": (1e-6, 1e10), "spring rate": (1e-6, 1e10),
    "pressure": (1e-9, 1e15), "time": (1e-25, 1e25), "duration": (1e-3, 1e9), "frequency": (1e-25, 1e25),
    "angular frequency": (1e-25, 1e25), "rotation": (1e-6, 1e4), "force per rotation": (1e-9, 1e6),
    "moment": (1e-9, 1e9), "torque": (1e-9, 1e9), "inertia": (1e-9, 1e9),
    "bending stiffness": (1e-9, 1e9), "viscosity": (1e-9, 1e3), "temperature": (0.0, 1e4),
    "temperature difference": (1e-9, 1e4), "angle": (1e-9, 1e3), "mass flow": (1e-6, 1e6),
    "volume flow": (1e-9, 1e6), "power": (1e-3, 1e12), "energy": (1e-3, 1e18), "molar energy": (1e-3, 1e9),
    "fraction": (1e-9, 1e6),
}  # fmt: skip
"""Smallest and largest nonzero size of each kind in SI base units; so wide that products and ratios stay finite."""

SPELLINGS: dict[str, str] = {}
for _kind in KINDS.values():
    for _form, _name in _kind.units.items():
        SPELLINGS.setdefault(_form, _name)
