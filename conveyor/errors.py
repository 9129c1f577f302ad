"""What can go wrong, as types: input that is refused, a calculation without an answer, data used at their limit."""

from __future__ import annotations


class ConveyorError(Exception):
    """Base of every error this package raises on purpose; the message says what to change."""


class InputError(ConveyorError, ValueError):
    """An input is outside what is allowed; the message names it, its value and the allowed range."""


class NoSolutionError(ConveyorError):
    """The calculation has no answer for valid input; the message says why and what to change."""


class RangeError(ConveyorError):
    """Data would have to be extrapolated (temperature shift, load curve)."""


class ValidityWarning(UserWarning):
    """A result is computed, but outside the range in which its law or data are known to hold."""
