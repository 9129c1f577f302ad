"""Maximum and minimum that ignore rounding: the first of equal items wins."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")

TIE_RTOL = 1e-9
"""Largest relative rounding difference along a loop of thousands of sections, on any processor."""


def first_maximum(items: Iterable[T], value: Callable[[T], float]) -> T:
    """Return the item of the largest value; of values equal but for rounding the first.

    Raises
    ------
    ValueError
        No items.

    Examples
    --------
    >>> first_maximum([("as given", 2.0), ("full", 2.0 + 1e-15), ("empty", 1.0)], lambda load: load[1])[0]
    'as given'
    """
    values = [(item, value(item)) for item in items]
    most = max(known for _, known in values)
    return next(item for item, known in values if known == most or math.isclose(known, most, rel_tol=TIE_RTOL))


def first_minimum(items: Iterable[T], value: Callable[[T], float]) -> T:
    """Return the item of the smallest value; of values equal but for rounding the first.

    Raises
    ------
    ValueError
        No items.
    """
    return first_maximum(items, lambda item: -value(item))
