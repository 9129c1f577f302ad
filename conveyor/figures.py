"""Figures in sentences: SI in, text with its unit out, as reports write them."""

from __future__ import annotations

import re
from typing import Final

from conveyor.units import System, display

ZERO_CELSIUS: Final = 273.15
"""[K]."""
RAISED: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Digits of an exponent."""
_WHOLE = re.compile(r"^-?\d{4,}")


def celsius(temperature: float) -> float:
    """A temperature [K] in degC, without the rounding of the conversion."""
    return round(temperature - ZERO_CELSIUS, 9)


def figure(value: float, kind: str, system: System = "SI") -> str:
    """Write an SI figure for people: four digits, thousands grouped, powers raised, degrees with their sign.

    Examples
    --------
    >>> figure(30097.4, "force"), figure(9.81, "acceleration", "US"), figure(293.15, "temperature")
    ('30,097 N', '32.19 ft/s²', '20 °C')
    """
    written = _WHOLE.sub(lambda found: f"{int(found[0]):,}", display(value, kind, system))
    return written.replace("^2", "²").replace("^3", "³").replace(" deg", " °")


def belt_strength(value: float, system: System = "SI") -> str:
    """Write a strength per width [N/m] in N/mm or PIW, as belts are named.

    Examples
    --------
    >>> belt_strength(1.6e6), belt_strength(1.0508e5, "US")
    ('1,600 N/mm', '600 PIW')
    """
    if system == "SI":
        return f"{value / 1e3:,.0f} N/mm"
    return figure(value, "line force", system).replace("lbf/in", "PIW")
