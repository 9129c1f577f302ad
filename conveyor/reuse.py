"""The cache of a batch, a study or a report: parts of calculations, by the values they are made of."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import Any, Final, TypeVar

T = TypeVar("T")
_MISSING: Final[Any] = object()


class ReuseCache:
    """Parts shared by variants of a spec: models, strands, lines, covers, load curves.

    Models are known by their fingerprint, other parts are made once and frozen: they are their own keys.

    Attributes
    ----------
    covers, curves, drags : dict
        Covers at their working strain, load curves of contacts and drags of rolls, which are solved in batches.
    passed : dict
        Checks between the parts of a spec that found nothing to refuse; values are of no use.
    """

    MOST: Final = 2048
    """Entries of each kind kept between calls, the last used; more than a study over speeds and spacings needs."""
    CHECKS_PER_PART: Final = 32
    """Checks kept for each part, at most."""

    def __init__(self) -> None:
        self._made: dict[Hashable, Any] = {}
        self.covers: dict[Any, Any] = {}
        self.curves: dict[Any, Any] = {}
        self.drags: dict[Any, Any] = {}
        self.passed: dict[Hashable, None] = {}

    def begin(self) -> None:
        """Drop the least recently used entries beyond `MOST`."""
        for known in (self._made, self.covers, self.curves, self.drags):
            _drop_oldest(known, self.MOST)
        _drop_oldest(self.passed, self.CHECKS_PER_PART * self.MOST)

    def forget_solved(self) -> None:
        """Drop batch solutions, whose last digits depend on the batch."""
        self.covers.clear()
        self.curves.clear()

    def once(self, make: Callable[[], T], what: str, parts: Iterable[object], values: Hashable = ()) -> T:
        """Cached value for equal parts and equal values, made if absent."""
        key = (what, *map(part_key, parts), values)
        made: T = self._made.pop(key, _MISSING)
        if made is _MISSING:
            made = make()
        self._made[key] = made  # at the end are those used last
        return made

    def first(self, one: T, what: str, parts: Iterable[object], values: Hashable = ()) -> T:
        """First of all objects given for equal parts and equal values."""
        return self.once(lambda: one, what, parts, values)


def part_key(part: object) -> Hashable:
    """Key of a part: the fingerprint of a model, of models in a row theirs, else the part itself."""
    if isinstance(part, tuple):
        return tuple(map(part_key, part))
    return getattr(part, "fingerprint", part)


def _drop_oldest(known: dict[Any, Any], most: int) -> None:
    for key in list(known)[: max(0, len(known) - most)]:
        known.pop(key, None)
