"""Notes merged where they are alike, and sorted by what they are on."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

NOTE_HEADINGS: Final = ("action required", "basis and limitations")
"""Headings of the two lists of notes."""


_NAME_PATTERN: Final = re.compile(r'"[^"]*"|\b[a-z_]+(?:\[\d+\])?(?:\.[a-z_]+(?:\[\d+\])?)+')
"""Quoted names and fields, in which similar notes differ."""


_COMPOUNDS_PATTERN: Final = re.compile(r'^compound ("[^"]*"(?:, "[^"]*")+) is ')


_BASIS_PATTERN: Final = re.compile(
    r"^compounds? \"|^calculation\.(calibration|flexure)|^the belt gives|^means over|^90 % bands|^energy and cost|"
    "not given|assumed|illustrative|not read in the standard|as commonly reproduced"
)
"""Notes on inputs and assumptions, not on results."""


def merge_notes(notes: Iterable[str]) -> list[str]:
    """Merge notes that differ in quoted names or fields only, listing those.

    Examples
    --------
    >>> merge_notes(['compound "a" is made up', "no brake", 'compound "b" is made up'])
    ['compounds "a", "b" are made up', 'no brake']
    """
    alike: dict[str, list[list[str]]] = {}
    for note in notes:
        alike.setdefault(_NAME_PATTERN.sub("\0", note), []).append(_NAME_PATTERN.findall(note))
    return [_combined_note(pattern, names) for pattern, names in alike.items()]


def _combined_note(pattern: str, names: Sequence[Sequence[str]]) -> str:
    columns = iter([", ".join(dict.fromkeys(column)) for column in zip(*names, strict=True)])
    note = "".join(next(columns) if part == "\0" else part for part in re.split("(\0)", pattern))
    return _COMPOUNDS_PATTERN.sub(r"compounds \1 are ", note)


def sort_notes(notes: Iterable[str]) -> tuple[list[str], list[str]]:
    """Return merged notes on results, then those on inputs and assumptions."""
    every = merge_notes(notes)
    of_data = [note for note in every if _BASIS_PATTERN.search(note)]
    return [note for note in every if note not in of_data], of_data
