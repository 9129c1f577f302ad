"""Figures in sentences: text with units from SI values."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeVar

from conveyor.errors import ConveyorError, MessageQuantity
from conveyor.units.quantities import System, format_si, in_report_unit, unit_label

E = TypeVar("E", bound=ConveyorError)

ZERO_CELSIUS: Final = 273.15
"""[K]."""
SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Digits of an exponent."""
DIGITS: Final = 3
"""Significant digits of figures in sentences."""
_KILO: Final = 1e3
_DEGREES: Final = re.compile(r"deg(?<=\bdeg)(?=[CF]\b)")  # letters first: searched for four times as fast
_PLAIN_FROM, _PLAIN_BELOW = 1e-2, 1e6  # frequencies between which no power of ten is written [Hz]


def to_celsius(temperature: float) -> float:
    """A temperature [K] in degC, without the rounding of the conversion."""
    return round(temperature - ZERO_CELSIUS, 9)


def format_number(number: float) -> str:
    """Format a number to three significant digits, its thousands grouped.

    Examples
    --------
    >>> format_number(30097.4), format_number(76.331), format_number(0.04069), format_number(-0.0)
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


def format_figure(value: float, kind: str, system: System = "SI") -> str:
    """Format an SI figure: three digits, thousands grouped, forces in kN, heat below 1 MJ in kJ, ° for deg.

    Examples
    --------
    >>> (
    ...     format_figure(30097.4, "force"),
    ...     format_figure(2.267, "force"),
    ...     format_figure(9.81, "acceleration", "US"),
    ...     format_figure(5180.0, "energy"),
    ... )
    ('30.1 kN', '2.27 N', '32.2 ft/s²', '5.18 kJ')
    """
    number, sign = in_report_unit(value, kind, system), unit_label(kind, system)
    if sign == "N" and abs(number) >= _KILO:
        number, sign = number / _KILO, "kN"
    if sign == "MJ" and abs(number) < 1.0:
        number, sign = number * _KILO, "kJ"
    sign = sign.replace("^2", "²").replace("^3", "³").replace("deg", "°").replace("*", " ")
    return f"{format_number(number)}°" if sign == "°" else f"{format_number(number)} {sign}".rstrip()


def format_strength(value: float, system: System = "SI") -> str:
    """Format a breaking strength per width [N/m] as in belt names.

    Examples
    --------
    >>> format_strength(1.6e6), format_strength(1.0508e6, "US")
    ('1,600 N/mm', '6,000 lbf/in')
    """
    return f"{value / 1e3:,.0f} N/mm" if system == "SI" else format_figure(value, "line force", system)


def format_rating(value: float, system: System = "SI") -> str:
    """Format a working tension per width [N/m] like rated ones: PIW in the US.

    Examples
    --------
    >>> format_rating(1.0508e5), format_rating(1.0508e5, "US")
    ('105 N/mm', '600 PIW')
    """
    if system == "SI":
        return f"{format_number(value / 1e3)} N/mm"
    return format_figure(value, "line force", system).replace("lbf/in", "PIW")


@dataclass(frozen=True)
class Message:
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
    >>> line = message("at most {}, {} are installed", (500e3, "power"), (450e3, "power"))
    >>> line.text(), line.text("US")
    ('at most 500 kW, 450 kW are installed', 'at most 671 hp, 603 hp are installed')
    """

    words: str
    figures: tuple[tuple[float, str], ...] = ()

    def text(self, system: System = "SI") -> str:
        """Text in a system of units."""
        return self.words.format(*(_figure_text(value, kind, system) for value, kind in self.figures))

    def __str__(self) -> str:
        return self.text()


def error_in_units(error: E, system: System) -> E:
    """Return an error with its figures in a system of units.

    Examples
    --------
    >>> str(error_in_units(ConveyorError("slack at {}", MessageQuantity(1.2, "length", "1.2 m")), "US"))
    'slack at 3.937 ft'
    """
    return error if system == "SI" else error.told(partial(_part_text, system=system))


@contextmanager
def reraise_in_units(system: System) -> Iterator[None]:
    """Raise errors of the block with their figures in a system of units."""
    try:
        yield
    except ConveyorError as error:
        raise error_in_units(error, system) from error.__cause__


def _part_text(part: object, system: System) -> object:
    if isinstance(part, MessageQuantity):
        return format_si(part.value, part.kind, system, digits=part.digits)
    return part.text(system) if isinstance(part, Message) else part


def message(words: str, *figures: tuple[float, str]) -> Message:
    """Make a sentence with figures."""
    return Message(words, figures)


def degree_signs(words: str) -> str:
    """Replace degC and degF by °C and °F.

    Examples
    --------
    >>> degree_signs("at 20 degC, 10 Hz")
    'at 20 °C, 10 Hz'
    """
    return _DEGREES.sub("°", words)


def escape_braces(words: str) -> str:
    """Escape the braces of a user's text for a `Message`; degrees get their sign."""
    return degree_signs(words).replace("{", "{{").replace("}", "}}")


def _figure_text(value: float, kind: str, system: System) -> str:
    if kind == "belt strength":
        return format_strength(value, system)
    if kind == "belt rating":
        return format_rating(value, system)
    if kind == "safety":
        return f"{value:.2f}"
    return f"{value:g}" if kind == "number" else format_figure(value, kind, system)


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
    return None if value is None else in_report_unit(value, kind), unit_label(kind) or "-"


def format_band(band: tuple[float, float]) -> str:
    """Format a band of frequency [Hz].

    Examples
    --------
    >>> format_band((154.31, 2605.4)), format_band((7.7e-4, 1e11))
    ('154 to 2,610 Hz', '8×10⁻⁴ to 1×10¹¹ Hz')
    """
    return f"{' to '.join(map(_frequency_text, band))} Hz"


def _frequency_text(value: float) -> str:
    if _PLAIN_FROM <= value < _PLAIN_BELOW:
        return f"{float(f'{value:.{DIGITS}g}'):,.0f}" if value >= 100.0 else f"{value:.{DIGITS}g}"
    digit, exponent = f"{value:.0e}".split("e")
    return f"{digit}×10{str(int(exponent)).translate(SUPERSCRIPTS)}"
