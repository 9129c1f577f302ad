"""Words of laboratories in many languages, from the lists in `words/`: names of columns, deformations of specimens."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from importlib.resources import files
from typing import Final, NamedTuple

_SEPARATORS: Final = re.compile(r"[\s_.|\-]+")
_UNDIVIDED_LETTERS: Final = str.maketrans({"ı": "i", "ł": "l", "ß": "ss", "ø": "o", "đ": "d"})
"""Letters that Unicode does not take apart."""


class Deformation(NamedTuple):
    """Deformation of a specimen by a text: E or G, and the words for it."""

    letter: str
    words: str


def compact_name(name: str) -> str:
    """Name without capitals, accents, blanks, points, bars, hyphens and underscores.

    Examples
    --------
    >>> (
    ...     compact_name("Módulo de almacenamiento"),
    ...     compact_name("ＳＩＣＡＫＬＩＫ".lower()),
    ...     compact_name("Sıcaklık"),
    ... )
    ('modulodealmacenamiento', 'ｓｉｃａｋｌｉｋ', 'sicaklik')
    """
    apart = unicodedata.normalize("NFD", name.lower().translate(_UNDIVIDED_LETTERS))
    plain = "".join(sign for sign in apart if unicodedata.category(sign) != "Mn")
    return _SEPARATORS.sub("", unicodedata.normalize("NFC", plain))


def word_lists(name: str) -> Iterator[tuple[str, list[str]]]:
    """Head and words of each line of a list in `words/`."""
    text = (files("conveyor.laboratory") / "words" / f"{name}.txt").read_text(encoding="utf-8")
    for line in text.splitlines():
        head, bar, words = line.partition(" | ")
        if bar and not line.startswith("#"):
            yield head.strip(), [word.strip() for word in words.split(",")]


def _word_pattern(words: list[str], *, as_written: bool) -> re.Pattern[str]:
    """Pattern of whole words; Chinese, Japanese and Korean ones match anywhere."""
    one = [re.escape(word).replace(r"\*", r"\w*").replace(r"\#", r"\d+").replace(r"\ ", r"\s+") for word in words]
    whole = [each if ord(word[0]) > 0x2E00 else rf"(?<!\w){each}(?!\w)" for word, each in zip(words, one, strict=True)]
    return re.compile("|".join(whole), re.NOFLAG if as_written else re.IGNORECASE)


def _deformation_patterns() -> dict[bool, list[tuple[str, re.Pattern[str]]]]:
    """Patterns of shear and tension, for column names (True) and texts; words with capitals match as written."""
    words: dict[tuple[bool, str, bool], list[str]] = {}
    for what, listed in word_lists("deformation"):
        way, _, beside = what.partition(" ")
        for word in listed:
            key = (bool(beside), "G" if way == "shear" else "E", word != word.lower())
            words.setdefault(key, []).append(word)
    made: dict[bool, list[tuple[str, re.Pattern[str]]]] = {True: [], False: []}
    for (of_column, letter, written), some in words.items():
        made[of_column].append((letter, _word_pattern(some, as_written=written)))
    return made


_DEFORMATIONS: Final = _deformation_patterns()


def find_deformations(text: str, *, column: bool = False) -> Iterator[Deformation]:
    """Deformations that a text or column name states: E for tension, bending, compression; G for shear, torsion.

    Examples
    --------
    >>> [one.letter for one in find_deformations("Measuring system: PP25")]
    ['G']
    >>> (
    ...     list(find_deformations("Clamp: Tension Film")),
    ...     list(find_deformations("Laboratory Fischer, sheared off")),
    ... )
    ([Deformation(letter='E', words='Tension')], [Deformation(letter='G', words='sheared')])
    """
    for letter, pattern in _DEFORMATIONS[column]:
        if match := pattern.search(text):
            yield Deformation(letter, match[0])
