"""What can go wrong, as types: input that is refused, a calculation without an answer, data used at their limit."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final

_WORD: Final = re.compile(r"(\S{200})\S{100,}")
_LINE: Final = re.compile(r"(.{800}).{100,}(.{100})")


class ConveyorError(Exception):
    """Base of every error this package raises on purpose; the message says what to change.

    Whatever a message quotes of an input is cut to a length that a person reads.
    """

    def __init__(self, message: object = "") -> None:
        super().__init__(_LINE.sub(r"\1 ... \2", _WORD.sub(r"\1...", str(message))))


def shortened(quoted: str, longest: int = 80) -> str:
    """Cut what a message quotes to a length that a person reads.

    Examples
    --------
    >>> shortened("overland"), shortened("overland", 4)
    ('overland', 'over...')
    """
    return quoted if len(quoted) <= longest else quoted[:longest] + "..."


class InputError(ConveyorError, ValueError):
    """An input is outside what is allowed; the message names it, its value and the allowed range."""


class PlacedError(InputError):
    """What is wrong with a plan, all of it, each with its place as pydantic locates it."""

    def __init__(self, problems: Iterable[tuple[tuple[int | str, ...], str]]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(said for _, said in self.problems))

    def __reduce__(self) -> tuple[Any, ...]:
        """Sent from a worker as what it was made of: its message alone makes none."""
        return type(self), (self.problems,), self.__dict__


class NoSolutionError(ConveyorError):
    """The calculation has no answer for valid input; the message says why and what to change."""


class RangeError(ConveyorError):
    """Data would have to be extrapolated (temperature shift, load curve)."""


class ValidityWarning(UserWarning):
    """A result is computed, but outside the range in which its law or data are known to hold."""
