"""Notes in two lists: what has to be seen to, then what the figures rest on; alike ones as one."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

HEADINGS: Final = ("action required", "basis and limitations")
"""Above the two lists."""
_NAMES: Final = re.compile(r'"[^"]*"|\b[a-z_]+(?:\[\d+\])?(?:\.[a-z_]+(?:\[\d+\])?)+')
"""What alike notes differ in: quoted names and fields."""
_SEVERAL: Final = re.compile(r'^compound ("[^"]*"(?:, "[^"]*")+) is ')
_OF_DATA: Final = re.compile(
    r"^compounds? \"|^calculation\.(calibration|flexure)|^the belt gives|^means over|^energy and cost|not given|"
    "assumed|illustrative|not read in the standard"
)
"""Notes on what was given, not on what was found."""


def merged(notes: Iterable[str]) -> list[str]:
    """Make one of notes that differ in quoted names or fields only, listing those.

    Examples
    --------
    >>> merged(['compound "a" is made up', "no brake", 'compound "b" is made up'])
    ['compounds "a", "b" are made up', 'no brake']
    """
    alike: dict[str, list[list[str]]] = {}
    for note in notes:
        alike.setdefault(_NAMES.sub("\0", note), []).append(_NAMES.findall(note))
    return [_joined(pattern, names) for pattern, names in alike.items()]


def _joined(pattern: str, names: Sequence[Sequence[str]]) -> str:
    columns = iter([", ".join(dict.fromkeys(column)) for column in zip(*names, strict=True)])
    note = "".join(next(columns) if part == "\0" else part for part in re.split("(\0)", pattern))
    return _SEVERAL.sub(r"compounds \1 are ", note)


def ordered(notes: Iterable[str]) -> tuple[list[str], list[str]]:
    """Give merged notes on what was found, then those on what the figures rest on."""
    every = merged(notes)
    of_data = [note for note in every if _OF_DATA.search(note)]
    return [note for note in every if note not in of_data], of_data
