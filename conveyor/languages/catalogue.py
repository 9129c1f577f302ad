"""Catalogues of the texts of reports, as files of gettext (.po), one a language."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Final, Literal, get_args

from conveyor.languages.translator import NumberFormat, Translator

Language = Literal["en", "de", "es", "pt", "zh"]
"""English, German, Spanish, Portuguese, Chinese (ISO 639-1)."""
LANGUAGES: Final[tuple[str, ...]] = get_args(Language)
TRANSLATED: Final = LANGUAGES[1:]
"""Languages with a catalogue; the texts arise in English."""
NUMBER_FORMATS: Final[Mapping[str, NumberFormat]] = MappingProxyType({
    "de": NumberFormat(",", "."),
    "es": NumberFormat(",", ".", 5),
    "pt": NumberFormat(",", "."),
    "zh": NumberFormat(),
})  # fmt: skip
"""Signs of numbers (Unicode CLDR 46, decimal, group, minimumGroupingDigits)."""


@cache
def load_catalogue(language: str) -> Mapping[str, str]:
    """Return the translations of a language by their English text.

    Raises
    ------
    KeyError
        There is no catalogue of it.
    """
    if language not in TRANSLATED:
        raise KeyError(language)
    import polib

    text = files("conveyor.languages").joinpath(f"{language}.po").read_text("utf-8")
    return MappingProxyType({entry.msgid: entry.msgstr for entry in polib.pofile(text)})


def report_translator(language: str, names: Collection[str] = frozenset()) -> Translator | None:
    """Return the translator of a language, with the names that stay as they are; None for English."""
    if language == "en":
        return None
    return Translator(language, load_catalogue(language), NUMBER_FORMATS[language], names)
