"""Figures in sentences: text with units from SI values."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeVar

from conveyor.errors import Amount, ConveyorError
from conveyor.units.quantities import System, convert, display, unit_label

E = TypeVar("E", bound=ConveyorError)

ZERO_CELSIUS: Final = 273.15
"""[K]."""
RAISED: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Digits of an exponent."""
DIGITS: Final = 3
"""Significant digits of figures in sentences."""
_KILO: Final = 1e3
_DEGREES: Final = re.compile(r"deg(?<=\bdeg)(?=[CF]\b)")  # letters first: searched for four times as fast
_LEAST, _MOST = 1e-2, 1e6  # frequencies between which no power of ten is written [Hz]


def celsius(temperature: float) -> float:
    """A temperature [K] in degC, without the rounding of the conversion."""
    return round(temperature - ZERO_CELSIUS, 9)


def rounded(number: float) -> str:
    """Format a number to three significant digits, its thousands grouped.

    Examples
    --------
    >>> rounded(30097.4), rounded(76.331), rounded(0.04069), rounded(-0.0)
    ('30,100', '76.3', '0.0407', '0')
    """
    written = f"{number:.{DIGITS}g}"
    if math.isfinite(number) and abs(float(written)) >= 10.0 ** (DIGITS - 1):
        return f"{float(written):,.0f}"
    return "0" if float(written) == 0.0 else written


def percent(share: float, decimals: int = 0, *, signed: bool = False) -> str:
    """Format a share in per cent, `signed` with a plus; no minus on a rounded zero.

    Examples
    --------
    >>> percent(0.0222, 1), percent(-0.14), percent(0.05, signed=True), percent(-1e-9, 1)
    ('2.2 %', '-14 %', '+5 %', '0.0 %')
    """
    return f"{100.0 * share:{'+' if signed else ''}z.{decimals}f} %"


def figure(value: float, kind: str, system: System = "SI") -> str:
    """Format an SI figure: three digits, thousands grouped, forces in kN, heat below 1 MJ in kJ, ° for deg.

    Examples
    --------
    >>> (
    ...     figure(30097.4, "force"),
    ...     figure(2.267, "force"),
    ...     figure(9.81, "acceleration", "US"),
    ...     figure(5180.0, "energy"),
    ... )
    ('30.1 kN', '2.27 N', '32.2 ft/s²', '5.18 kJ')
    """
    number, sign = convert(value, kind, system), unit_label(kind, system)
    if sign == "N" and abs(number) >= _KILO:
        number, sign = number / _KILO, "kN"
    if sign == "MJ" and abs(number) < 1.0:
        number, sign = number * _KILO, "kJ"
    sign = sign.replace("^2", "²").replace("^3", "³").replace("deg", "°").replace("*", " ")
    return f"{rounded(number)}°" if sign == "°" else f"{rounded(number)} {sign}".rstrip()


def belt_strength(value: float, system: System = "SI") -> str:
    """Format a breaking strength per width [N/m] as in belt names.

    Examples
    --------
    >>> belt_strength(1.6e6), belt_strength(1.0508e6, "US")
    ('1,600 N/mm', '6,000 lbf/in')
    """
    return f"{value / 1e3:,.0f} N/mm" if system == "SI" else figure(value, "line force", system)


def belt_rating(value: float, system: System = "SI") -> str:
    """Format a working tension per width [N/m] like rated ones: PIW in the US.

    Examples
    --------
    >>> belt_rating(1.0508e5), belt_rating(1.0508e5, "US")
    ('105 N/mm', '600 PIW')
    """
    if system == "SI":
        return f"{rounded(value / 1e3)} N/mm"
    return figure(value, "line force", system).replace("lbf/in", "PIW")


@dataclass(frozen=True)
class Said:
    """Sentence with figures: SI values with their kinds, written in the reader's units.

    Parameters
    ----------
    words : str
        Text with {} for each figure.
    figures : tuple of (float, str)
        Value and kind of quantity; also "belt strength" and "belt rating", written as in belt names, "safety" with
        two decimals, "number" plainly.

    Examples
    --------
    >>> line = said("at most {}, {} are installed", (500e3, "power"), (450e3, "power"))
    >>> line.text(), line.text("US")
    ('at most 500 kW, 450 kW are installed', 'at most 671 hp, 603 hp are installed')
    """

    words: str
    figures: tuple[tuple[float, str], ...] = ()

    def text(self, system: System = "SI") -> str:
        """Text in a system of units."""
        return self.words.format(*(_written(value, kind, system) for value, kind in self.figures))

    def __str__(self) -> str:
        return self.text()


def told(error: E, system: System) -> E:
    """Return an error with its figures in a system of units.

    Examples
    --------
    >>> str(told(ConveyorError("slack at {}", Amount(1.2, "length", "1.2 m")), "US"))
    'slack at 3.937 ft'
    """
    return error if system == "SI" else error.told(partial(_part, system=system))


@contextmanager
def telling(system: System) -> Iterator[None]:
    """Raise errors of the block with their figures in a system of units."""
    try:
        yield
    except ConveyorError as error:
        raise told(error, system) from error.__cause__


def _part(part: object, system: System) -> object:
    if isinstance(part, Amount):
        return display(part.value, part.kind, system, digits=part.digits)
    return part.text(system) if isinstance(part, Said) else part


def said(words: str, *figures: tuple[float, str]) -> Said:
    """Make a sentence with figures."""
    return Said(words, figures)


def degrees(words: str) -> str:
    """Replace degC and degF by °C and °F.

    Examples
    --------
    >>> degrees("at 20 degC, 10 Hz")
    'at 20 °C, 10 Hz'
    """
    return _DEGREES.sub("°", words)


def quoted(words: str) -> str:
    """Escape the braces of a user's text for a `Said`; degrees get their sign."""
    return degrees(words).replace("{", "{{").replace("}", "}}")


def _written(value: float, kind: str, system: System) -> str:
    if kind == "belt strength":
        return belt_strength(value, system)
    if kind == "belt rating":
        return belt_rating(value, system)
    if kind == "safety":
        return f"{value:.2f}"
    return f"{value:g}" if kind == "number" else figure(value, kind, system)


def plain_figure(value: float | None, kind: str) -> tuple[float | None, str]:
    """Return an SI figure for programs in the SI unit of reports, and that unit; "-" for ratios.

    Examples
    --------
    >>> plain_figure(103.5e3, "power"), plain_figure(2.5e6, "belt strength"), plain_figure(None, "safety")
    ((103.5, 'kW'), (2500.0, 'N/mm'), (None, '-'))
    """
    if kind in {"belt strength", "belt rating"}:
        return None if value is None else value / 1e3, "N/mm"
    if kind in {"safety", "number"}:
        return value, "-"
    return None if value is None else convert(value, kind), unit_label(kind) or "-"


def band_words(band: tuple[float, float]) -> str:
    """Format a band of frequency [Hz].

    Examples
    --------
    >>> band_words((154.31, 2605.4)), band_words((7.7e-4, 1e11))
    ('154 to 2,610 Hz', '8×10⁻⁴ to 1×10¹¹ Hz')
    """
    return f"{' to '.join(map(_frequency, band))} Hz"


def _frequency(value: float) -> str:
    if _LEAST <= value < _MOST:
        return f"{float(f'{value:.{DIGITS}g}'):,.0f}" if value >= 100.0 else f"{value:.{DIGITS}g}"
    digit, exponent = f"{value:.0e}".split("e")
    return f"{digit}×10{str(int(exponent)).translate(RAISED)}"
