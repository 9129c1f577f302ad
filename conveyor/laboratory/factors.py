"""Units as laboratories write them, to SI: a factor and an offset for each."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple


class ModulusUnit(NamedTuple):
    """SI value = factor * (number + offset)."""

    name: str
    factor: float
    offset: float = 0.0


_POUND_FORCE_PER_SQUARE_INCH = 6894.757293168361
"""0.45359237 kg * 9.80665 m/s^2 / (0.0254 m)^2, exact definitions, rounded to double."""
_STANDARD_GRAVITY = 9.80665
"""[m/s^2], exact by definition; 1 kgf = 9.80665 N."""
_RADIAN_PER_SECOND = 1.0 / (2.0 * math.pi)


def _units(table: Mapping[str, tuple[float, str] | tuple[float, str, float]]) -> dict[str, ModulusUnit]:
    units = {}
    for name, (factor, spellings, *offset) in table.items():
        for spelling in (name, *spellings.split()):
            units[spelling] = ModulusUnit(name, factor, *offset)
    return units


_MODULUS = {
    "Pa": (1.0, "pascal N/m^2 N/m2"),
    "kPa": (1e3, "KPa Kpa kpa KPA"),
    "MPa": (1e6, "Mpa MPA megapascal N/mm^2 N/mm2 MN/m^2 MN/m2"),
    "GPa": (1e9, "Gpa GPA gpa"),
    "psi": (_POUND_FORCE_PER_SQUARE_INCH, "PSI lbf/in^2 lbf/in2"),
    "ksi": (1e3 * _POUND_FORCE_PER_SQUARE_INCH, "KSI"),
    "dyn/cm^2": (0.1, "dyn/cm2 dyne/cm^2 dyne/cm2 dynes/cm^2 dynes/cm2"),
    "kgf/cm^2": (_STANDARD_GRAVITY / 1e-4, "kgf/cm2"),
    "bar": (1e5, ""),
}
_NONE = {"-": (1.0, "1 – — none dimensionless")}

UNITS = MappingProxyType(
    {
        "frequency": _units(
            {
                "Hz": (1.0, "hz HZ cps cycles/s"),
                "rad/s": (
                    _RADIAN_PER_SECOND,
                    "rads/s rad/sec radian/s radians/s rads^-1 rads-1 radsec^-1 Rad/s rad·s^-1 rad·s-1",
                ),
                "kHz": (1e3, "khz KHz"),
                "mHz": (1e-3, ""),
                "MHz": (1e6, ""),
            }
        ),
        "modulus": _units(_MODULUS),
        "temperature": _units(
            {
                "degC": (1.0, "C degc celsius Celsius oC gradC ℃ centigrade", 273.15),
                "degF": (5.0 / 9.0, "F degf fahrenheit Fahrenheit oF ℉", 459.67),
                "K": (1.0, "kelvin Kelvin degK"),
            }
        ),
        "strain": _units(
            {
                "-": (1.0, "1 – — mm/mm m/m in/in strain fraction dimensionless"),
                "%": (1e-2, "pct percent Prozent % %strain"),
                "permille": (1e-3, "‰"),
                "ppm": (1e-6, "um/m microstrain ustrain uε ue"),
            }
        ),
        "time": _units(
            {
                "s": (1.0, "sec secs second seconds Sek"),
                "ms": (1e-3, "msec"),
                "min": (60.0, "minute minutes"),
                "h": (3600.0, "hr hour hours"),
            }
        ),
        "angle": _units({"deg": (math.pi / 180.0, "degree degrees Grad"), "rad": (1.0, "radian radians")}),
        "number": _units(_NONE),
        "label": _units(_NONE),
    }
)
"""For each dimension every accepted spelling, blanks removed."""

_LOOKS = str.maketrans(
    {"°": "deg", "º": "deg", "˚": "deg", "µ": "u", "μ": "u", "²": "^2", "⋅": "·", "*": "·"}
)


def find_unit(dimension: str, text: str) -> ModulusUnit | None:
    """The unit behind a spelling.

    Parameters
    ----------
    dimension : str
        Key of `UNITS` [-].
    text : str
        As written in the file, brackets allowed [-].

    Returns
    -------
    Unit or None
        None if it is not a known unit of that dimension [-].

    Examples
    --------
    >>> find_unit("modulus", "[ N/mm² ]"), find_unit("temperature", "°C").offset, find_unit("modulus", "Hz")
    (ModulusUnit(name='MPa', factor=1000000.0, offset=0.0), 273.15, None)
    """
    plain = re.sub(r"\s+", "", text).replace("⁻¹", "^-1")
    if len(plain) > 1 and plain[0] + plain[-1] in {"[]", "()", "<>"}:
        plain = plain[1:-1]
    plain = plain.translate(_LOOKS)
    return UNITS[dimension].get(plain)


def is_any_unit(text: str) -> bool:
    """Whether a text is a unit of some dimension.

    Parameters
    ----------
    text : str
        As written in the file [-].

    Returns
    -------
    bool
        True for every accepted spelling [-].

    Examples
    --------
    >>> is_any_unit("(MPa)"), is_any_unit("E'")
    (True, False)
    """
    return any(find_unit(dimension, text) for dimension in UNITS)


def allowed(dimension: str) -> str:
    """Canonical names of the units of a dimension, for messages.

    Parameters
    ----------
    dimension : str
        Key of `UNITS` [-].

    Returns
    -------
    str
        Separated by commas [-].

    Examples
    --------
    >>> allowed("temperature")
    'degC, degF, K'
    """
    return ", ".join(dict.fromkeys(unit.name for unit in UNITS[dimension].values()))
