"""Figures in sentences: text with units from SI values."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeVar

from conveyor.errors import ConveyorError, MessageQuantity
from conveyor.units.presentation import DIGITS, format_figure
from conveyor.units.unit_systems import System

E = TypeVar("E", bound=ConveyorError)

ZERO_CELSIUS: Final = 273.15
"""[K]."""
SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Digits of an exponent."""
_DEGREES: Final = re.compile(r"deg(?<=\bdeg)(?=[CF]\b)")  # letters first: searched for four times as fast
_MOST_DIGITS: Final = 6
"""Digits of figures that would be written alike with fewer."""
_PLAIN_FROM, _PLAIN_BELOW = 1e-2, 1e6  # frequencies between which no power of ten is written [Hz]


def to_celsius(temperature: float) -> float:
    """A temperature [K] in degC, without the rounding of the conversion."""
    return round(temperature - ZERO_CELSIUS, 9)


def percent(share: float, decimals: int = 0, *, signed: bool = False) -> str:
    """Format a share in per cent, `signed` with a plus; no minus on a rounded zero.

    Examples
    --------
    >>> percent(0.0222, 1), percent(-0.14), percent(0.05, signed=True), percent(-1e-9, 1)
    ('2.2 %', '-14 %', '+5 %', '0.0 %')
    """
    return f"{100.0 * share:{'+' if signed else ''}z.{decimals}f} %"


@dataclass(frozen=True)
class Message:
    """Sentence with figures: SI values with their kinds, written in the reader's units.

    Parameters
    ----------
    words : str
        Text with {} for each figure.
    figures : tuple of (float, str)
        SI value and kind of quantity.

    Examples
    --------
    >>> line = message("at most {}, {} are installed", (500e3, "power"), (450e3, "power"))
    >>> line.text(), line.text("US")
    ('at most 500 kW, 450 kW are installed', 'at most 671 hp, 603 hp are installed')
    >>> message("{} are asked for, {} are there", (5.002e6, "power"), (5e6, "power")).text()
    '5,002 kW are asked for, 5,000 kW are there'
    """

    words: str
    figures: tuple[tuple[float, str], ...] = ()

    def text(self, system: System = "SI") -> str:
        """Text in a system of units; figures that differ get the digits that show it."""
        shown = self._figures(system, DIGITS)
        if len(set(shown)) < len(shown):
            unlike = len({(float(f"{value:.{_MOST_DIGITS}g}"), kind) for value, kind in self.figures})
            more = (self._figures(system, digits) for digits in range(DIGITS, _MOST_DIGITS + 1))
            shown = next((one for one in more if len(set(one)) == unlike), shown)
        return self.words.format(*shown)

    def _figures(self, system: System, digits: int) -> list[str]:
        return [format_figure(value, kind, system, digits=digits) for value, kind in self.figures]

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
        return format_figure(part.value, part.kind, system, digits=part.digits, as_input=True)
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
