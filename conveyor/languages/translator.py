"""Translation of a report's texts: looked up whole, by a sentence with gaps, or in parts; numbers as the language has.

Texts are composed in English where they arise. A catalogue has every text of its own, and with {} for what varies; what
fills a gap is translated in turn. Names that the user gave, paths of fields, clauses of standards and symbols of units
are the same in all languages.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import Final

from conveyor.languages.catalogue import Catalogue, load_catalogue
from conveyor.languages.number_format import NUMBER
from conveyor.units.presentation import report_units

_LATIN: Final = re.compile(r"[A-Za-z]")
_PARTS: Final = ("\n", ". ", "; ", " – ", ": ", ", ", " / ", " x ", " + ", "\xa0×\xa0")
"""What parts of a text stand between, in the order in which it is divided."""
_LOOSE: Final = frozenset({"\n", "; ", ". ", " – ", ": "})
"""Between these a part may stay as it is where another is translated."""
_SAME: Final = re.compile(
    r"(?:(?:ISO|DIN|EN|CEMA|VDI|IEC|NEMA|FEM|SHA|AS|ASTM)[ -]?[\w .:/-]*?\d[\w.:-]*)"  # a standard
    r"|(?:[a-z_]+(?:\[\d+\])?(?:\.[a-z_]+(?:\[\d+\])?)+)"  # a path of a field
    r"|(?:[A-Za-z0-9]+(?:_[A-Za-z0-9]+)+|[0-9a-f]{12,}|\"[^\"]*\")"  # a key, a fingerprint, a name in quotes
    r"|(?:[A-Z]{1,4}-?\d[\w/.-]*|\S+\.[a-z]{2,4}(?:[/:]\S*)?)"  # a part or belt of a series, a file or site
    r"|(?:python|numpy|scipy|pandas|pint|pydantic|openpyxl|matplotlib)"  # a program
    r"|(?:cp\d+|tau|dyn/cm\^2|ksi|min)"  # an encoding, a column and units of laboratory files
    r"|(?:[A-Z]'{0,2}|[a-zA-Z](?:_\w+)?|T(?:[12e]|max|min)|tan δ|\(C-1\) F_H|\|E\*\|/b_T"
    r"|T(?:x|yc|yr|ym|m|p|am|sb|bc|pl|ac))"  # a symbol
)
_SYMBOL_FIGURE: Final = re.compile(rf"(?:f =|K[xyt]|T(?:x|yc|yr|ym)) {NUMBER}(?: (?:[kM]?W|hp))?")
"""A symbol with its figure, and the power that it takes."""
_WITH_UNIT: Final = re.compile(r"(.+) (\[[^][]+\]|T(?:[12e]|max|min))", re.DOTALL)
"""A label with its unit, or with its symbol in US reports."""
_LEAST_LETTERS: Final = 8
"""Letters of a sentence below which all that fills its gaps has to be known."""


@cache
def _figure_pattern() -> re.Pattern[str]:
    """Pattern of a number, with or without a unit of reports or a currency, and of a unit alone."""
    signs = "|".join(map(re.escape, sorted(report_units(), key=len, reverse=True)))
    unit = rf"(?:{signs}|%|kWh|[kG]?Pa|[A-Z]{{3}})(?:/(?:{signs}|kWh))?"
    return re.compile(rf"(?:(?:[<>≤≥±~+] ?)?{NUMBER}(?: ?{unit})?)|{unit}|\[[^][]+\]")


@dataclass
class Translator:
    """Translator of the texts of a report.

    Attributes
    ----------
    catalogue : Catalogue
        Texts of the language.
    names : collection of str
        Names that the user gave; they stay as they are where they stand alone, between marks or before "pulley".
    notes : collection of str
        Notes of compounds; they stay as they are where the catalogue has them not whole.

    Examples
    --------
    >>> from conveyor.languages.number_format import NumberFormat
    >>> texts = {"drive": "Antrieb", "{} of {} checks": "{} von {} Prüfungen"}
    >>> german = Translator(Catalogue("de", texts, NumberFormat(",", ".")))
    >>> german.text("drive, 1,250.5 kW"), german.text("3 of 5 checks"), german.text("a drive")
    ('Antrieb, 1.250,5 kW', '3 von 5 Prüfungen', 'a drive')
    """

    catalogue: Catalogue
    names: Collection[str] = frozenset()
    notes: Collection[str] = frozenset()
    missing: dict[str, None] = field(default_factory=dict)
    """Texts, or parts of them, that have no translation."""

    def __post_init__(self) -> None:
        self._known: dict[str, tuple[str, tuple[str, ...]]] = {}

    def text(self, words: str) -> str:
        """Translate an English text; what has no translation stays as it is."""
        inner = words.strip()
        if not inner:
            return words
        translated, left = self._resolve(inner)
        self.missing.update(dict.fromkeys(left))
        return words.replace(inner, translated, 1)

    def heading(self, words: str) -> str:
        """Translate a heading or the name of a column, which are the report's own even where a name is spelled so."""
        known = self.catalogue.texts.get(words)
        return self.text(words) if known is None else known

    def _resolve(self, words: str) -> tuple[str, tuple[str, ...]]:
        """Translation of a text, and what of it has none."""
        if words not in self._known:
            self._known[words] = words, (words,)  # for sentences that begin or end with a gap
            self._known[words] = self._looked_up(words)
        return self._known[words]

    def _looked_up(self, words: str) -> tuple[str, tuple[str, ...]]:
        known = self._whole(words)
        if known is not None:
            return known, ()
        if (inner := words.strip()) != words:
            translated, left = self._resolve(inner)
            return words.replace(inner, translated, 1), left
        best: tuple[str, tuple[str, ...]] = words, (words,)
        for found in (*self._by_sentences(words), *self._by_parts(words)):
            if not found[1]:
                return found
            if sum(map(len, found[1])) < sum(map(len, best[1])):
                best = found
        return best

    def _whole(self, words: str) -> str | None:
        """Translation of a text known whole, or the text where it is the same in all languages; None for others."""
        if not words.strip() or words in self.names:
            return words
        if any(one.fullmatch(words) for one in (_figure_pattern(), _SYMBOL_FIGURE)) or not _LATIN.search(words):
            return self.catalogue.numbers.localise(words)
        if words in self.catalogue.texts:
            return self.catalogue.texts[words]
        if words in self.notes:
            return words
        if (other := words[0].swapcase() + words[1:]) in self.catalogue.texts:
            return _with_first_letter_as(words, self.catalogue.texts[other])
        return words if _SAME.fullmatch(words) else None

    def _by_sentences(self, words: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        for sentence in self.catalogue.sentences:
            if sentence.piece in words and (found := sentence.pattern.fullmatch(words)):
                gaps = zip(found.groups(), sentence.bounded, strict=True)
                if any(_has_comma(part) for part, bounded in gaps if not bounded) or "; " in sentence.before(found):
                    continue  # the sentence is one of the parts
                filled = zip(found.groups(), sentence.quoted, sentence.named, strict=True)
                parts = [(part, ()) if quoted else self._filling(part, named) for part, quoted, named in filled]
                left = tuple(one for _, missing in parts for one in missing)
                if not left or sentence.letters >= _LEAST_LETTERS:
                    yield sentence.translation.format(*(part for part, _ in parts)), left

    def _filling(self, words: str, named: bool) -> tuple[str, tuple[str, ...]]:
        """Translation of what fills a gap: where no name stands, a word of the report though a name is spelled so."""
        own = not named and words in self.names and words in self.catalogue.texts
        return (self.catalogue.texts[words], ()) if own else self._resolve(words)

    def _by_parts(self, words: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        if words.endswith((".", ":")):
            inner, left = self._resolve(words[:-1])
            yield inner + words[-1], left
        if (found := _WITH_UNIT.fullmatch(words)) is not None:
            label, left = self._resolve(found[1])
            yield f"{label} {found[2]}", left
        for between in _PARTS:
            pieces = _split_outside(words, between, most=1 if between in _LOOSE else -1)
            if len(pieces) > 1:
                parts = [self._resolve(piece) for piece in pieces]
                left = tuple(one for _, missing in parts for one in missing)
                if not left or between in _LOOSE:
                    yield between.join(part for part, _ in parts), left
        if (start := _last_bracket(words)) > 0:
            before, inside = self._resolve(words[:start].rstrip()), self._resolve(words[start + 1 : -1])
            gap = words[len(words[:start].rstrip()) : start]
            yield f"{before[0]}{gap}({inside[0]})", (*before[1], *inside[1])


def _with_first_letter_as(model: str, words: str) -> str:
    """Words that begin with a capital if the model does."""
    return words[0].upper() + words[1:] if model[0].isupper() else words


def _has_comma(words: str) -> bool:
    return words.endswith(",") or len(_split_outside(words, ", ")) > 1


def _split_outside(words: str, between: str, *, most: int = -1) -> list[str]:
    """Divide a text at what stands between its parts, at most so often, but not within brackets or quotation marks."""
    if between not in words:
        return [words]
    pieces: list[str] = []
    start, depth, quoted = 0, 0, False
    for i, letter in enumerate(words):
        depth += (letter in "([") - (letter in ")]")
        quoted ^= letter == '"'
        if len(pieces) == most:
            break
        if depth == 0 and not quoted and i >= start and words.startswith(between, i):
            pieces.append(words[start:i])
            start = i + len(between)
    return [*pieces, words[start:]]


def _last_bracket(words: str) -> int:
    """Place of the bracket that opens what a text ends with in brackets; 0 without one."""
    if not words.endswith(")"):
        return 0
    depth = 0
    for i in range(len(words) - 1, 0, -1):
        depth += (words[i] == ")") - (words[i] == "(")
        if depth == 0:
            return i
    return 0


def report_translator(
    language: str, names: Collection[str] = frozenset(), notes: Collection[str] = frozenset()
) -> Translator:
    """Return the translator of a language with a catalogue, with the names that stay as they are and with notes."""
    return Translator(load_catalogue(language), names, notes)
