"""Escaping of control characters in text for people."""

from __future__ import annotations

import math
import re
import unicodedata
from typing import Final

_WIDE: Final = 0.8
"""Letters more that a wide letter takes."""
_CONTROLS: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]"
)
"""Controls but the tab and the line feed, marks of direction, lone surrogates, non-characters."""


def escape_controls(text: str) -> str:
    r"""Replace control characters by their codes, so that no name moves the cursor or breaks a file.

    All text for people goes through here: terminal, SVG, CSV, HTML, workbooks.

    Examples
    --------
    >>> escape_controls("got \x1b[31mred\x9b")
    'got \\x1b[31mred\\x9b'
    """
    return _CONTROLS.sub(lambda match: match[0].encode("unicode_escape").decode("ascii"), text)


def text_width(text: str) -> int:
    """Width of a text in letters: a Chinese one is nearly as wide as two others.

    Examples
    --------
    >>> text_width("belt"), text_width("输送带")
    (4, 6)
    """
    if text.isascii():
        return len(text)
    wide = sum(unicodedata.east_asian_width(letter) in {"W", "F"} for letter in text)
    return len(text) + math.ceil(_WIDE * wide)


def escape_json_controls(written: str) -> str:
    r"""Replace control characters in JSON text by JSON escapes; it reads back to the same.

    Examples
    --------
    >>> escape_json_controls('"\x9b"')
    '"\\u009b"'
    """
    return _CONTROLS.sub(lambda match: f"\\u{ord(match[0]):04x}", written)
