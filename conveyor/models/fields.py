"""Read and change fields of a conveyor by path: `belt.speed`, `route.sections[2].lift`."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache, partial
from typing import Any, Final, TypeAlias, TypeVar

from conveyor.errors import InputError
from conveyor.models.base import Model
from conveyor.models.compound import RubberCompound
from conveyor.models.conveyor import Conveyor
from conveyor.reuse import ReuseCache
from conveyor.units import is_quantity

CompoundResolver: TypeAlias = Callable[[str], RubberCompound]
"""Function that looks up a compound by name or path."""
Change = TypeVar("Change")
Outcome = TypeVar("Outcome")
_PATH_PART: Final = re.compile(r"([^.\[\]]+)|\[(\d+)\]")
_FIELD_PATH: Final = re.compile(r"[^.\[\]]+(?:\.[^.\[\]]+|\[\d+\])*")


def with_fields(
    conveyor: Conveyor,
    changes: Mapping[str, Any],
    *,
    resolve: CompoundResolver | None = None,
    kept: ReuseCache | None = None,
) -> Conveyor:
    """Copy of a conveyor with changed fields, checked like a new spec.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    changes : mapping of str to value
        New values as specs write them, by path: names of fields joined by points; items of a list by number from 0 in
        brackets, or by their `name` (`route.sections.incline.lift`).
    resolve : callable, optional
        Looks up compounds given by name or path.
    kept : ReuseCache, optional
        Cache kept from call to call: parts shared by variants are one object, checked once.

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
    refused: list[str] = []
    try:
        _collect_results(changes.items(), lambda change: _insert_change(tree, *change))
    except InputError as error:
        refused.append(str(error))
    kept = kept or ReuseCache()

    def changed(change: tuple[str, Any]) -> tuple[str, Any]:
        name, below = _field_name(conveyor, change[0], ""), change[1]
        old = getattr(conveyor, name)
        make = partial(_apply_changes, old, below, name, resolve)
        return name, kept.once(make, "changed", (old,), (name, _change_key(below)))

    made = dict(_collect_results(tree.items(), changed, refused))
    if not made:
        return conveyor
    alike = all(isinstance(part, Model) and type(part) is type(getattr(conveyor, name)) for name, part in made.items())
    return conveyor.with_parts(made, kept.passed) if alike else _replace_with_path(conveyor, made, "")


def field_value(conveyor: Conveyor, path: str) -> Any:
    """Value of a field by its path; None where a part on the way is not given.

    Raises
    ------
    InputError
        The path leads nowhere.
    """
    value: Any = conveyor
    way = ""
    for part in _path_parts(path):
        if value is None:
            return None
        if isinstance(value, tuple):
            value = value[_item_number(value, part, way)]
        elif isinstance(value, Model):
            value = getattr(value, _field_name(value, part, way))
        else:
            raise InputError(f"{path}: {way} has no parts")
        way = f"{way}.{part}" if way else part
    return value


class _NewValue:
    """New value at the end of a path."""

    def __init__(self, value: Any) -> None:
        self.value = value


def check_field_path(path: str) -> None:
    """Refuse text that is not the path of a field; the field need not exist.

    Raises
    ------
    InputError
        The text is no path.
    """
    _path_parts(path)


@lru_cache(maxsize=1024)
def _path_parts(path: str) -> tuple[str, ...]:
    if _FIELD_PATH.fullmatch(path) is None:
        raise InputError(f'{path}: no path of a field; expected names joined by points, as in "belt.speed"')
    return tuple(name or number for name, number in _PATH_PART.findall(path))


def _insert_change(tree: dict[str, Any], path: str, value: Any) -> None:
    """Insert a value at its path into the tree of changes."""
    *way, last = _path_parts(path)
    for part in way:
        tree = tree.setdefault(part, {})
        if isinstance(tree, _NewValue):
            raise InputError(f"{path}: a part of it is changed as a whole, too; give one of both")
    if last in tree:
        raise InputError(f"{path}: changed twice, or a field below it is; give one of both")
    tree[last] = _NewValue(value)


def _apply_changes(old: Any, below: Any, path: str, resolve: CompoundResolver | None) -> Any:
    if isinstance(below, _NewValue):
        if resolve is not None and isinstance(old, RubberCompound) and isinstance(below.value, str):
            return resolve(below.value)
        return below.value
    if isinstance(old, Model):
        return _replace_fields(old, below, path, resolve)
    if isinstance(old, tuple):
        items = list(old)

        def item(change: tuple[str, Any]) -> None:
            i = _item_number(old, change[0], path)
            items[i] = _apply_changes(items[i], change[1], f"{path}[{i}]", resolve)

        _collect_results(below.items(), item)
        return tuple(items)
    if old is None:
        return _plain_changes(below)
    raise InputError(f"{path}: is a single value, it has no {', '.join(below)}")


def _replace_fields(old: Model, below: Mapping[str, Any], path: str, resolve: CompoundResolver | None) -> Any:
    """Part with changed fields; all refusals in one error."""
    made, refused, wrong = {}, [], {}
    for key, lower in below.items():
        name = key
        try:
            name = _field_name(old, key, path)
            made[name] = _apply_changes(getattr(old, name), lower, f"{path}.{key}", resolve)
        except InputError as error:
            refused.append(str(error))
            wrong[name] = object()
    if not wrong:
        return _replace_with_path(old, made, path)
    try:
        # the placeholders fail field validation, so checks between fields do not run
        old.replace(**made, **wrong)
    except InputError as error:
        known = {*wrong, *(alias for alias, name in _names_by_alias(type(old)).items() if name in wrong)}
        said = str(error).splitlines()
        refused += [f"{path}.{line}" for line in said if re.split(r"[.:\[]", line, maxsplit=1)[0] not in known]
    raise InputError("\n".join(refused))


def _collect_results(
    changes: Iterable[Change], make: Callable[[Change], Outcome], refused: Sequence[str] = ()
) -> list[Outcome]:
    """Results of all changes; one error with all refusals, after those known already."""
    made, every = [], [*refused]
    for change in changes:
        try:
            made.append(make(change))
        except InputError as error:
            every.append(str(error))
    if every:
        raise InputError("\n".join(every))
    return made


def _field_name(old: Model, key: str, path: str) -> str:
    """Python name of a field by its name in specs."""
    aliases = _names_by_alias(type(old))
    if key not in aliases:
        near = difflib.get_close_matches(key, aliases, n=1)
        guess = f"did you mean {near[0]}?" if near else f"there are {', '.join(aliases)}"
        raise InputError(f"{path + '.' if path else ''}{key}: no such field; {guess}")
    return aliases[key]


@lru_cache(maxsize=128)
def _names_by_alias(model: type[Model]) -> dict[str, str]:
    """Python names of a model's fields by their names in specs."""
    return {info.alias or name: name for name, info in model.model_fields.items()}


def _item_number(items: tuple[Any, ...], part: str, path: str) -> int:
    """Index of an item given by index or name."""
    names = [getattr(item, "name", None) for item in items]
    if part in names:
        return names.index(part)
    if part.isdigit() and int(part) < len(items):
        return int(part)
    known = ", ".join(name for name in names if name) or f"{len(items)} items"
    raise InputError(f"{path}: has no item {part}; it has {known}")


def _replace_with_path(old: Model, made: Mapping[str, Any], path: str) -> Any:
    try:
        return old.replace(**made)
    except InputError as error:
        placed = partial("{}.{}".format, path) if path else str
        raise InputError("\n".join(map(placed, str(error).splitlines()))) from None


def _plain_changes(below: Any) -> Any:
    return below.value if isinstance(below, _NewValue) else {key: _plain_changes(lower) for key, lower in below.items()}


def _change_key(below: Any) -> object:
    """Hashable key of a tree of changes."""
    if isinstance(below, _NewValue):
        value = below.value
        told = (value.magnitude, value.units) if is_quantity(value) else repr(value)
        return type(value).__name__, told
    return tuple(sorted((key, _change_key(lower)) for key, lower in below.items()))
