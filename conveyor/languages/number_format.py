"""How a language writes numbers."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

NUMBER: Final = r"[-+−±]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:(?:[eE][+-]?\d+)|(?:×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?"
"""Pattern of a number as reports write it in English."""
_LONE_NUMBER: Final = re.compile(rf"(?<![\w.,]){NUMBER}(?![\w,]|\.\d)")


@dataclass(frozen=True)
class NumberFormat:
    """Signs of numbers in a language: decimal, between thousands, digits from which thousands are grouped."""

    decimal: str = "."
    group: str = ","
    grouped_from: int = 4

    def localise(self, words: str) -> str:
        """Write the numbers of a text as the language has them.

        Examples
        --------
        >>> NumberFormat(",", ".").localise("1,250.5 kW to 2×10⁻³ (0.1.0)")
        '1.250,5 kW to 2×10⁻³ (0.1.0)'
        """
        return words if self == ENGLISH_NUMBERS else _LONE_NUMBER.sub(self._number, words)

    def read(self, words: str) -> str:
        """Write a figure of the language as English does.

        Examples
        --------
        >>> NumberFormat(",", ".").read("1.250,5 N/mm")
        '1,250.5 N/mm'
        """
        return words if self == ENGLISH_NUMBERS else words.translate(str.maketrans(self.group + self.decimal, ",."))

    def _number(self, found: re.Match[str]) -> str:
        whole, point, rest = found[0].partition(".")
        digits = sum(letter.isdigit() for letter in whole)
        return whole.replace(",", self.group if digits >= self.grouped_from else "") + (point and self.decimal) + rest


ENGLISH_NUMBERS: Final = NumberFormat()
