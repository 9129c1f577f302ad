"""Seeded damage to a text: tokens and lines taken out, doubled, exchanged, bytes turned over."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from typing import Final

HOSTILE: Final = (
    "", "0", "-1", "1e308", "1e400 m", "nan", ".inf", "~", "true", "{}", "[]", "!!x", "*a", "&a", '"', "'", "|", ">",
    "%", "@", "\t", "\0", "\x85", "\u2028", "\ufeff", "１", "°", "9" * 400, "1 mm", "0 m", "?", "- ", ": ", ",", "#",
    "<<: ", "---\n", "...\n", "\r", "1_000", "0x10", "1:30", "=", "/dev/null", "../x.yaml", "1e-300 kg", "head", "s100",
)  # fmt: skip
_TOKEN: Final = re.compile(r"[\w.%/^+-]+|[^\w\s]|\n\s*|\s")
_NUMBER: Final = re.compile(r"(?<![\w.])\d+\.?\d*")


def _taken(text: str, at: re.Match[str], _: random.Random) -> str:
    return text[: at.start()] + text[at.end() :]


def _doubled(text: str, at: re.Match[str], _: random.Random) -> str:
    return text[: at.end()] + at[0] + text[at.end() :]


def _replaced(text: str, at: re.Match[str], seeded: random.Random) -> str:
    return text[: at.start()] + seeded.choice(HOSTILE) + text[at.end() :]


def _exchanged(text: str, at: re.Match[str], seeded: random.Random) -> str:
    other = seeded.choice(_tokens(text))
    return text[: at.start()] + other[0] + text[at.end() :]


def _line_taken(text: str, at: re.Match[str], _: random.Random) -> str:
    end = text.find("\n", at.end())
    return text[: text.rfind("\n", 0, at.start()) + 1] + (text[end + 1 :] if end >= 0 else "")


def _cut_off(text: str, at: re.Match[str], _: random.Random) -> str:
    return text[: at.end()]


def _scaled(text: str, at: re.Match[str], seeded: random.Random) -> str:
    number = _NUMBER.search(text, at.start())
    if number is None:
        return text
    new = seeded.choice(("0", f"-{number[0]}", f"{number[0]}000", "0.001", "1e9", "1e-9"))
    return text[: number.start()] + new + text[number.end() :]


_DAMAGE: Final[Sequence[Callable[[str, re.Match[str], random.Random], str]]] = (
    _taken, _doubled, _replaced, _exchanged, _line_taken, _cut_off, _scaled,
)  # fmt: skip


def _tokens(text: str) -> list[re.Match[str]]:
    return list(_TOKEN.finditer(text))


def mutated(text: str, seeded: random.Random) -> bytes:
    """Damage a text in one to four places, and one in twelve in its bytes, too."""
    for _ in range(seeded.choice((1, 1, 2, 4))):
        tokens = _tokens(text)
        if tokens:
            text = seeded.choice(_DAMAGE)(text, seeded.choice(tokens), seeded)
    data = bytearray(text.encode())
    if data and seeded.random() < 1.0 / 12.0:
        data[seeded.randrange(len(data))] = seeded.randrange(256)
    return bytes(data)
