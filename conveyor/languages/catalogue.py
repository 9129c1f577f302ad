"""Catalogues of the texts of reports, as files of gettext (.po), one a language."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from types import MappingProxyType
from typing import Final

from conveyor.languages import TRANSLATED
from conveyor.languages.gapped_sentence import GAP, GappedSentence
from conveyor.languages.number_format import ENGLISH_NUMBERS, NumberFormat

NUMBER_FORMATS: Final[Mapping[str, NumberFormat]] = MappingProxyType({
    "de": NumberFormat(",", "."),
    "es": NumberFormat(",", ".", 5),
    "pt": NumberFormat(",", "."),
    "zh": NumberFormat(),
})  # fmt: skip
"""Signs of numbers (Unicode CLDR 46, decimal, group, minimumGroupingDigits)."""


@dataclass(frozen=True)
class Catalogue:
    """Texts of reports in a language.

    Attributes
    ----------
    language : str
        Code of the language (ISO 639-1).
    texts : mapping
        Translations by English text; with {} for what varies, in both.
    numbers : NumberFormat
        How the language writes numbers.
    """

    language: str
    texts: Mapping[str, str]
    numbers: NumberFormat = ENGLISH_NUMBERS

    @cached_property
    def sentences(self) -> list[GappedSentence]:
        """Sentences with gaps, the longest first."""
        made = [GappedSentence.of(*pair) for pair in self.texts.items() if GAP.search(pair[0])]
        return sorted(made, key=lambda one: -one.letters)


@cache
def load_catalogue(language: str) -> Catalogue:
    """Return the catalogue of a language.

    Raises
    ------
    KeyError
        There is none of it.
    """
    if language not in TRANSLATED:
        raise KeyError(language)
    import polib

    content = files("conveyor.languages").joinpath(f"{language}.po").read_text("utf-8")
    texts = {entry.msgid: entry.msgstr for entry in polib.pofile(content)}
    return Catalogue(language, MappingProxyType(_without_stops(texts) | texts), NUMBER_FORMATS[language])


def _without_stops(texts: Mapping[str, str]) -> dict[str, str]:
    """Sentences as they stand before another one, from which they are divided at its stop."""
    return {english[:-1]: text.rstrip(".。") for english, text in texts.items() if english.endswith(".")}
