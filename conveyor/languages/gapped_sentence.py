"""Sentences of a catalogue with gaps for what varies."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Self

GAP: Final = re.compile(r"(?<!{)\{(\d*)\}(?!})")
"""A gap of a sentence, in a translation with the number of the gap that it takes."""
_PATH_END: Final = re.compile(r"\.[a-z_]")
"""What follows a gap that is the begin of a path of a field."""
_SHORT: Final = 16
"""Letters of a sentence below which nothing with a comma fills a gap that no mark stands beside."""


def _literal_pieces(words: str) -> list[str]:
    """Text before, between and behind the gaps of a sentence."""
    return [piece.replace("{{", "{").replace("}}", "}") for piece in GAP.split(words)[::2]]


def gap_pattern(words: str) -> re.Pattern[str]:
    """Return the pattern of a sentence; its groups are what fills the gaps."""
    return re.compile("(.*?)".join(map(re.escape, _literal_pieces(words))), re.DOTALL)


@dataclass(frozen=True)
class GappedSentence:
    """A sentence with gaps: its pattern, translation, longest piece and number of letters.

    Of every gap: whether it stays as it is, a name in quotation marks or part of a path; whether a name of the user may
    fill it, behind a comma or before the word pulley; whether commas may be in what fills it.
    """

    pattern: re.Pattern[str]
    translation: str
    piece: str
    letters: int
    quoted: tuple[bool, ...]
    named: tuple[bool, ...]
    bounded: tuple[bool, ...]

    def before(self, found: re.Match[str]) -> str:
        """Text in a gap that the sentence begins with; empty where it begins with a word of its own."""
        return found[1] if found.start(1) == 0 else ""

    @classmethod
    def of(cls, english: str, translation: str) -> Self:
        """Return the sentence of a text and its translation."""
        pieces = _literal_pieces(english)
        letters = sum(letter.isalpha() for piece in pieces for letter in piece)
        quoted = tuple(
            (one.endswith('"') and next_.startswith('"')) or one.endswith(".") or _PATH_END.match(next_) is not None
            for one, next_ in pairwise(pieces)
        )
        named = tuple(one.endswith(", ") or next_.startswith(" pulley") for one, next_ in pairwise(pieces))
        bounded: list[bool] = []
        for one, next_ in pairwise(pieces):
            marks = one.endswith((", ", ": ", "; ", "(", '"')) or next_.startswith((",", ":", ";", ")", '"'))
            bounded.append(letters >= _SHORT or marks or (one == "" and bounded[-1:] == [True]))
        longest = max(pieces, key=len)
        return cls(gap_pattern(english), translation, longest, letters, quoted, named, tuple(bounded))
