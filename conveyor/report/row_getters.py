"""Getters of a row's value at a path of attributes, keys and indices."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from operator import attrgetter
from typing import Any, Final, TypeAlias

import numpy as np

Getter: TypeAlias = Callable[[Any], Any]
"""Takes a row; returns an SI value, text, or None where it is not known."""

_ANY_DICT: Final = frozenset(dir(dict))
_PLAIN: Final = frozenset({float, int, str, bool, type(None)})


@cache
def path_getter(path: str) -> Getter:
    """Return a getter of a row's value at a path of attributes, keys and indices; None where it meets None.

    Examples
    --------
    >>> (
    ...     path_getter("1.real")(("carry", 2.5)),
    ...     path_getter("0.mass")([{"mass": 3.0}]),
    ...     path_getter("real.0")(None),
    ... )
    (2.5, 3.0, None)
    """
    steps = [(step, int(step) if step.isdecimal() else None) for step in path.split(".")]

    def by_steps(row: Any) -> Any:
        for name, index in steps:
            if row is None:
                return None
            keyed = index is not None or isinstance(row, Mapping)
            row = row[name if index is None else index] if keyed else getattr(row, name)
        return row.item() if isinstance(row, np.ndarray | np.generic) and row.ndim == 0 else row

    (_, first), *further = steps
    names = [name for name, index in (further if first is not None else steps) if index is None]
    if not names or len(names) < len(steps) - (first is not None) or not _ANY_DICT.isdisjoint(names):
        return by_steps
    attributes = attrgetter(".".join(names))

    def taken(row: Any) -> Any:
        try:
            value = attributes(row if first is None else row[first])
        except (AttributeError, TypeError):  # a mapping or None on the way
            return by_steps(row)
        return value if type(value) in _PLAIN else by_steps(row)

    return taken


def extreme_getter(of: Callable[[Iterable[float]], float], path: str, get: str | Getter) -> Getter:
    """Return a getter of the maximum or minimum of a figure over the items at a path; None if none is known."""
    held, figure = path_getter(path), path_getter(get) if isinstance(get, str) else get

    def taken(row: Any) -> float | None:
        known = [value for one in held(row) if isinstance(value := figure(one), float)]
        return of(known) if known else None

    return taken
