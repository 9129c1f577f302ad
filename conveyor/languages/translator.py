"""Translation of a report's texts: looked up whole, by a sentence with gaps, or in parts; numbers as the language has.

Texts are composed in English where they arise. A catalogue has every text of its own, and with {} for what varies; what
fills a gap is translated in turn. Names that the user gave, paths of fields, clauses of standards and symbols of units
are the same in all languages.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from itertools import pairwise
from typing import Final

from conveyor.units.presentation import report_units

GAP: Final = re.compile(r"(?<!{)\{(\d*)\}(?!})")
"""A gap of a sentence, in a translation with the number of the gap that it takes."""
_NUMBER: Final = r"[-+−±]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:(?:[eE][+-]?\d+)|(?:×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?"
_LATIN: Final = re.compile(r"[A-Za-z]")
_LONE_NUMBER: Final = re.compile(rf"(?<![\w.,]){_NUMBER}(?![\w,]|\.\d)")
_PARTS: Final = ("\n", ". ", "; ", " – ", ": ", ", ", " / ", " x ", " + ", "\xa0×\xa0")
"""What parts of a text stand between, in the order in which it is divided."""
_LOOSE: Final = frozenset({"\n", "; ", ". ", " – ", ": "})
"""Between these a part may stay as it is where another is translated."""
_SAME: Final = re.compile(
    r"(?:(?:ISO|DIN|EN|CEMA|VDI|IEC|NEMA|FEM|SHA|AS|ASTM)[ -]?[\w .:/-]*?\d[\w.:-]*)"  # a standard
    r"|(?:[a-z_]+(?:\[\d+\])?(?:\.[a-z_]+(?:\[\d+\])?)+)"  # a path of a field
    r"|(?:[A-Za-z0-9]+(?:_[A-Za-z0-9]+)+|[0-9a-f]{12,}|\"[^\"]*\")"  # a key, a fingerprint, a name in quotes
    r"|(?:[A-Z]{1,4}-?\d[\w/.-]*|\S+\.[a-z]{2,4}(?:[/:]\S*)?)"  # a part or belt of a series, a file or site
    r"|(?:[A-Z]'{0,2}|[a-zA-Z](?:_\w+)?|T(?:[12e]|max|min)|tan δ|\(C-1\) F_H|\|E\*\|/b_T)"  # a symbol
)
_WITH_UNIT: Final = re.compile(r"(.+) (\[[^][]+\]|T(?:[12e]|max|min))", re.DOTALL)
"""A label with its unit, or with its symbol in US reports."""
_PATH_END: Final = re.compile(r"\.[a-z_]")
"""What follows a gap that is the begin of a path of a field."""
_SHORT: Final = 16
"""Letters of a sentence below which nothing with a comma fills a gap that no mark stands beside."""
_LEAST_LETTERS: Final = 8
"""Letters of a sentence below which all that fills its gaps has to be known."""


@cache
def _figure_pattern() -> re.Pattern[str]:
    """Pattern of a number, with or without a unit of reports or a currency, and of a unit alone."""
    signs = "|".join(map(re.escape, sorted(report_units(), key=len, reverse=True)))
    unit = rf"(?:{signs}|%|kWh|[kG]?Pa|[A-Z]{{3}})(?:/(?:{signs}|kWh))?"
    return re.compile(rf"(?:(?:[<>≤≥±~+] ?)?{_NUMBER}(?: ?{unit})?)|{unit}|\[[^][]+\]")


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
        return words if self == _ENGLISH else _LONE_NUMBER.sub(self._number, words)

    def read(self, words: str) -> str:
        """Write a figure of the language as English does.

        Examples
        --------
        >>> NumberFormat(",", ".").read("1.250,5 N/mm")
        '1,250.5 N/mm'
        """
        return words if self == _ENGLISH else words.translate(str.maketrans(self.group + self.decimal, ",."))

    def _number(self, found: re.Match[str]) -> str:
        whole, point, rest = found[0].partition(".")
        digits = sum(letter.isdigit() for letter in whole)
        return whole.replace(",", self.group if digits >= self.grouped_from else "") + (point and self.decimal) + rest


_ENGLISH = NumberFormat()


@dataclass(frozen=True)
class _Sentence:
    """A sentence with gaps: its pattern, translation, longest piece and number of letters.

    Of every gap: whether it stays as it is, a name in quotation marks or part of a path, and whether commas may be in
    what fills it.
    """

    pattern: re.Pattern[str]
    translation: str
    piece: str
    letters: int
    quoted: tuple[bool, ...]
    bounded: tuple[bool, ...]


def _literal_pieces(words: str) -> list[str]:
    """Text before, between and behind the gaps of a sentence."""
    return [piece.replace("{{", "{").replace("}}", "}") for piece in GAP.split(words)[::2]]


def gap_pattern(words: str) -> re.Pattern[str]:
    """Return the pattern of a sentence; its groups are what fills the gaps."""
    return re.compile("(.*?)".join(map(re.escape, _literal_pieces(words))), re.DOTALL)


def _make_sentence(english: str, translation: str) -> _Sentence:
    pieces = _literal_pieces(english)
    letters = sum(letter.isalpha() for piece in pieces for letter in piece)
    quoted = tuple(
        (one.endswith('"') and next_.startswith('"')) or one.endswith(".") or _PATH_END.match(next_) is not None
        for one, next_ in pairwise(pieces)
    )
    bounded: list[bool] = []
    for one, next_ in pairwise(pieces):
        marks = one.endswith((", ", ": ", "; ", "(", '"')) or next_.startswith((",", ":", ";", ")", '"'))
        bounded.append(letters >= _SHORT or marks or (one == "" and bounded[-1:] == [True]))
    longest = max(pieces, key=len)
    return _Sentence(gap_pattern(english), translation, longest, letters, quoted, tuple(bounded))


@dataclass
class Translator:
    """Translator of the texts of a report.

    Attributes
    ----------
    language : str
        Code of the language (ISO 639-1).
    entries : mapping
        Translations by English text; with {} for what varies, in both.
    numbers : NumberFormat
        How the language writes numbers.
    names : collection of str
        Names that the user gave; they stay as they are.

    Examples
    --------
    >>> german = Translator(
    ...     "de", {"drive": "Antrieb", "{} of {} checks": "{} von {} Prüfungen"}, NumberFormat(",", ".")
    ... )
    >>> german.text("drive, 1,250.5 kW"), german.text("3 of 5 checks"), german.text("a drive")
    ('Antrieb, 1.250,5 kW', '3 von 5 Prüfungen', 'a drive')
    """

    language: str
    entries: Mapping[str, str]
    numbers: NumberFormat = NumberFormat()
    names: Collection[str] = frozenset()
    missing: dict[str, None] = field(default_factory=dict)
    """Texts, or parts of them, that have no translation."""

    def __post_init__(self) -> None:
        self._known: dict[str, tuple[str, tuple[str, ...]]] = {}
        self._made: set[str] = set()

    @cached_property
    def _sentences(self) -> list[_Sentence]:
        """Sentences with gaps, the longest first."""
        made = [_make_sentence(*pair) for pair in self.entries.items() if GAP.search(pair[0])]
        return sorted(made, key=lambda one: -one.letters)

    def text(self, words: str) -> str:
        """Translate a text; what is translated already, and what has no translation, stays as it is."""
        inner = words.strip()
        if not inner or self._is_made(inner):
            return words
        translated, left = self._resolve(inner)
        self.missing.update(dict.fromkeys(left))
        self._made.add(translated)
        return words.replace(inner, translated, 1)

    def heading(self, words: str) -> str:
        """Translate a heading or the name of a column, which are the report's own even where a name is spelled so."""
        if words not in self.entries:
            return self.text(words)
        self._made.add(self.entries[words])
        return self.entries[words]

    def _is_made(self, words: str) -> bool:
        """True for a translation, alone or with a unit."""
        label = _WITH_UNIT.fullmatch(words)
        return words in self._made or (label is not None and label[1] in self._made)

    def keep(self, words: str) -> str:
        """Leave a text as it is, here and wherever it comes again."""
        self._made.add(words.strip())
        return words

    def numbers_only(self, words: str) -> str:
        """Write a number as the language has it; other text stays as it is."""
        known = words in self._made or not _figure_pattern().fullmatch(words.strip())
        return words if known else self.numbers.localise(words)

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
        if not words.strip() or words in self.names or self._is_made(words):
            return words
        if _figure_pattern().fullmatch(words) or not _LATIN.search(words):
            return self.numbers.localise(words)
        if words in self.entries:
            return self.entries[words]
        if (other := words[0].swapcase() + words[1:]) in self.entries:
            return _with_first_letter_as(words, self.entries[other])
        return words if _SAME.fullmatch(words) else None

    def _by_sentences(self, words: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        for sentence in self._sentences:
            if sentence.piece in words and (found := sentence.pattern.fullmatch(words)):
                gaps = zip(found.groups(), sentence.bounded, strict=True)
                if any(_has_comma(part) for part, bounded in gaps if not bounded):
                    continue  # the sentence is one of the parts
                gaps = zip(found.groups(), sentence.quoted, strict=True)
                parts = [(part, ()) if quoted else self._resolve(part) for part, quoted in gaps]
                left = tuple(one for _, missing in parts for one in missing)
                if not left or sentence.letters >= _LEAST_LETTERS:
                    yield sentence.translation.format(*(part for part, _ in parts)), left

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
