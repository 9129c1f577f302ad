"""Exceptions: refused input, a calculation without an answer, data used beyond their range."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from copy import copy
from dataclasses import dataclass
from typing import Any, Final, Self

_LONG_WORD: Final = re.compile(r"(\S{200})\S{100,}")
_LONG_LINE: Final = re.compile(r"(.{800}).{100,}(.{100})")


@dataclass(frozen=True)
class MessageQuantity:
    """Quantity in an error message: SI text, SI value and kind, so that it can be written in other units.

    Parameters
    ----------
    value : float
        Value in SI units.
    kind : str
        Kind of quantity, a key of `conveyor.units.quantity_kinds.KINDS`.
    written : str
        Text with its SI unit.
    digits : int
        Significant digits in other units.

    Examples
    --------
    >>> error = ConveyorError("a belt of {}", MessageQuantity(1.2, "length", "1.2 m"))
    >>> str(error), str(error.told(lambda part: f"{part.value / 0.3048:.3g} ft"))
    ('a belt of 1.2 m', 'a belt of 3.94 ft')
    """

    value: float
    kind: str
    written: str
    digits: int = 4

    def __str__(self) -> str:
        return self.written


class ConveyorError(Exception):
    """Base of every error this package raises on purpose; the message says what to change.

    Long quotations of input are cut.

    Parameters
    ----------
    message : object
        Text, with {} for each of the parts if there are any.
    parts : object
        Amounts, other errors, sentences with figures, texts.
    """

    def __init__(self, message: object = "", *parts: object) -> None:
        self._message, self._parts = str(message), parts
        super().__init__(self._said(str))

    def told(self, write: Callable[[Any], object]) -> Self:
        """Copy of the error, its parts and those of nested errors written by `write`."""
        twin = copy(self)
        twin.args = (self._said(lambda part: part.told(write) if isinstance(part, ConveyorError) else write(part)),)
        return twin

    def at(self, place: str) -> ConveyorError:
        """Error with a place before its message; its amounts keep their kinds.

        Examples
        --------
        >>> print(RangeError("no data at {}", MessageQuantity(250.0, "temperature", "250 K")).at("run 2"))
        run 2: no data at 250 K
        """
        kind = InputError if isinstance(self, InputError) else type(self)
        return kind("{}: {}", place, self)

    def _said(self, write: Callable[[object], object]) -> str:
        whole = self._message.format(*map(write, self._parts)) if self._parts else self._message
        return _LONG_LINE.sub(r"\1 ... \2", _LONG_WORD.sub(r"\1...", whole))


def shorten_text(quoted: str, longest: int = 80) -> str:
    """Cut a quoted text to a readable length.

    Examples
    --------
    >>> shorten_text("overland"), shorten_text("overland", 4)
    ('overland', 'over...')
    """
    return quoted if len(quoted) <= longest else quoted[:longest] + "..."


class InputError(ConveyorError, ValueError):
    """Input outside its allowed range; the message names it, its value and the range."""


class SpecError(InputError):
    """Refused fields of a model; the message has a line for each: path, given value, allowed range.

    Parameters
    ----------
    problems : iterable of (str, str)
        Path of the field ("route.sections[2].lift"), empty for the whole model; the problem.

    Attributes
    ----------
    problems : tuple of (str, str)
        All of them, for programs.

    Examples
    --------
    >>> SpecError([("belt.width", "got 1 kg, expected a length")]).problems[0][0]
    'belt.width'
    """

    def __init__(self, problems: Iterable[tuple[str, str]]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(": ".join(filter(None, problem)) for problem in self.problems))

    def __reduce__(self) -> tuple[Any, ...]:
        """Sent from a worker as what it was made of: its message alone makes none."""
        return type(self), (self.problems,), self.__dict__


class PlanError(InputError):
    """All problems of a plan, each with its location as pydantic gives it."""

    def __init__(self, problems: Iterable[tuple[tuple[int | str, ...], str]]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(said for _, said in self.problems))

    def __reduce__(self) -> tuple[Any, ...]:
        """Sent from a worker as what it was made of: its message alone makes none."""
        return type(self), (self.problems,), self.__dict__


class NoSolutionError(ConveyorError):
    """Valid input without a solution; the message says why and what to change."""


class RangeError(ConveyorError):
    """Data would have to be extrapolated (temperature shift, load curve)."""


class ValidityWarning(UserWarning):
    """Result outside the range in which its law or data are known to hold."""
