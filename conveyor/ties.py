"""The largest and the least of several, whatever rounding makes of equals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")

ALIKE = 1e-9
"""Relative difference that rounding along a loop of thousands of sections makes at most; another processor's kernels
round otherwise, and of two loads that are one the first is to govern there too."""


def largest(items: Iterable[T], value: Callable[[T], float]) -> T:
    """Return the item of the largest value, of those that are as large but for rounding the first.

    Raises
    ------
    ValueError
        There is none.

    Examples
    --------
    >>> largest([("as given", 2.0), ("full", 2.0 + 1e-15), ("empty", 1.0)], lambda load: load[1])[0]
    'as given'
    """
    values = [(item, value(item)) for item in items]
    most = max(known for _, known in values)
    return next(item for item, known in values if known == most or math.isclose(known, most, rel_tol=ALIKE))


def least(items: Iterable[T], value: Callable[[T], float]) -> T:
    """Return the item of the least value, of those that are as small but for rounding the first.

    Raises
    ------
    ValueError
        There is none.
    """
    return largest(items, lambda item: -value(item))
