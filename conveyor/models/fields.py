"""Fields of a conveyor by their paths, as specs and messages write them: `belt.speed`, `route.sections[2].lift`."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from itertools import count
from typing import Any, Final, TypeAlias

from conveyor.errors import InputError
from conveyor.models.base import Model
from conveyor.models.compound import RubberCompound
from conveyor.models.conveyor import Conveyor
from conveyor.units import is_quantity

Resolve: TypeAlias = Callable[[str], RubberCompound]
"""A compound by its name or path."""
_PART: Final = re.compile(r"([^.\[\]]+)|\[(\d+)\]")
_WHOLE: Final = re.compile(r"[^.\[\]]+(?:\.[^.\[\]]+|\[\d+\])*")


class KnownParts:
    """Parts of one conveyor's variants, each made and checked once; which of them are known to fit each other."""

    MOST: Final = 2048
    """Parts kept, and combinations of them 32 times as many."""

    def __init__(self) -> None:
        self._made: dict[object, tuple[int, Any]] = {}
        self._numbers = count(1)
        self.fit: set[tuple[object, ...]] = set()
        """Of `Conveyor.with_parts`."""

    @property
    def full(self) -> bool:
        """Whether it has become much."""
        return len(self._made) > self.MOST or len(self.fit) > 32 * self.MOST

    def once(self, change: object, make: Callable[[], Any]) -> tuple[int, Any]:
        """Number and part of a change, made where it is new."""
        if change not in self._made:
            self._made.setdefault(change, (next(self._numbers), make()))
        return self._made[change]


def with_fields(
    conveyor: Conveyor,
    changes: Mapping[str, Any],
    *,
    resolve: Resolve | None = None,
    known: KnownParts | None = None,
) -> Conveyor:
    """The conveyor with some fields changed, checked like a new spec.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    changes : mapping of str to value
        New values as specs write them, by path: names of fields joined by points; items of a list by number from 0 in
        brackets, or by their `name` (`route.sections.incline.lift`).
    resolve : callable, optional
        Looks compounds up that are given by name or path.
    known : KnownParts, optional
        Parts that were made of the same changes, kept from call to call with one conveyor: what two variants share is
        then the very same object, and what was checked is not checked again.

    Raises
    ------
    InputError
        A path leads nowhere, two contradict each other, or a value is refused; each on its own line with its path.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> with_fields(line, {"belt.speed": "5.5 m/s"}).belt_speed  # doctest: +SKIP
    5.5
    """
    tree: dict[str, Any] = {}
    for path, value in changes.items():
        _plant(tree, path, value)
    known, made, numbers, alike = known or KnownParts(), {}, {}, True
    for name, below in _named(conveyor, tree, ""):
        old = getattr(conveyor, name)
        make = partial(_changed, old, below, name, resolve)
        numbers[name], made[name] = known.once((name, _frozen(below)), make)
        alike = alike and isinstance(old, Model) and type(made[name]) is type(old)
    if not made:
        return conveyor
    return conveyor.with_parts(made, numbers, known.fit) if alike else _replaced(conveyor, made, "")


def field(conveyor: Conveyor, path: str) -> Any:
    """Value of a field by its path; None where a part on the way is not given.

    Raises
    ------
    InputError
        The path leads nowhere.
    """
    value: Any = conveyor
    way = ""
    for part in _parts(path):
        if value is None:
            return None
        if isinstance(value, tuple):
            value = value[_item(value, part, way)]
        elif isinstance(value, Model):
            ((name, _),) = _named(value, {part: None}, way)
            value = getattr(value, name)
        else:
            raise InputError(f"{path}: {way} has no parts")
        way = f"{way}.{part}" if way else part
    return value


class _Leaf:
    """A value at the end of a path."""

    def __init__(self, value: Any) -> None:
        self.value = value


def check_path(path: str) -> None:
    """Refuse what is no path of a field, whether the field is there or not.

    Raises
    ------
    InputError
        It is none.
    """
    _parts(path)


@lru_cache(maxsize=1024)
def _parts(path: str) -> tuple[str, ...]:
    if _WHOLE.fullmatch(path) is None:
        raise InputError(f'{path}: no path of a field; expected names joined by points, as in "belt.speed"')
    return tuple(name or number for name, number in _PART.findall(path))


def _plant(tree: dict[str, Any], path: str, value: Any) -> None:
    """Put a value at the end of its path."""
    *way, last = _parts(path)
    for part in way:
        tree = tree.setdefault(part, {})
        if isinstance(tree, _Leaf):
            raise InputError(f"{path}: a part of it is changed as a whole, too; give one of both")
    if last in tree:
        raise InputError(f"{path}: changed twice, or a field below it is; give one of both")
    tree[last] = _Leaf(value)


def _changed(old: Any, below: Any, path: str, resolve: Resolve | None) -> Any:
    if isinstance(below, _Leaf):
        if resolve is not None and isinstance(old, RubberCompound) and isinstance(below.value, str):
            return resolve(below.value)
        return below.value
    if isinstance(old, Model):
        made = {
            name: _changed(getattr(old, name), lower, f"{path}.{name}", resolve)
            for name, lower in _named(old, below, path)
        }
        return _replaced(old, made, path)
    if isinstance(old, tuple):
        items = list(old)
        for part, lower in below.items():
            i = _item(old, part, path)
            items[i] = _changed(items[i], lower, f"{path}[{i}]", resolve)
        return tuple(items)
    if old is None:
        return _plain(below)
    raise InputError(f"{path}: is a single value, it has no {', '.join(below)}")


def _named(old: Model, below: Mapping[str, Any], path: str) -> list[tuple[str, Any]]:
    """Names of the fields in Python, and what is below them."""
    aliases = _aliases(type(old))
    for key in below:
        if key not in aliases:
            near = difflib.get_close_matches(key, aliases, n=1)
            guess = f"did you mean {near[0]}?" if near else f"there are {', '.join(aliases)}"
            raise InputError(f"{path + '.' if path else ''}{key}: no such field; {guess}")
    return [(aliases[key], lower) for key, lower in below.items()]


@lru_cache(maxsize=128)
def _aliases(model: type[Model]) -> dict[str, str]:
    """Names of a model's fields in Python by those that specs use."""
    return {info.alias or name: name for name, info in model.model_fields.items()}


def _item(items: tuple[Any, ...], part: str, path: str) -> int:
    """Number of an item given by its number or name."""
    names = [getattr(item, "name", None) for item in items]
    if part in names:
        return names.index(part)
    if part.isdigit() and int(part) < len(items):
        return int(part)
    known = ", ".join(name for name in names if name) or f"{len(items)} items"
    raise InputError(f"{path}: has no item {part}; it has {known}")


def _replaced(old: Model, made: Mapping[str, Any], path: str) -> Any:
    try:
        return old.replace(**made)
    except InputError as error:
        placed = partial("{}.{}".format, path) if path else str
        raise InputError("\n".join(map(placed, str(error).splitlines()))) from None


def _plain(below: Any) -> Any:
    return below.value if isinstance(below, _Leaf) else {key: _plain(lower) for key, lower in below.items()}


def _frozen(below: Any) -> object:
    """What tells changes apart."""
    if isinstance(below, _Leaf):
        value = below.value
        told = (value.magnitude, value.units) if is_quantity(value) else repr(value)
        return type(value).__name__, told
    return tuple(sorted((key, _frozen(lower)) for key, lower in below.items()))
