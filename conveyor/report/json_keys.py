"""JSON declared once: every key with its value, type and description; the data and their schema follow from it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Self, TypeAlias

from conveyor.report.row_getters import path_getter
from conveyor.report.table_model import Table

SCHEMA_VERSION: Final = 1
"""Increased where a key goes or changes its meaning, not for a new key."""

Schema: TypeAlias = dict[str, Any]
LEFT_OUT: Final = object()
"""Value of a key that is left out."""


@dataclass(frozen=True)
class JsonKey:
    """A value of JSON, and its schema.

    Attributes
    ----------
    get : str or callable
        Path or function of the object that it is a value of; returns `LEFT_OUT` where the key is left out.
    said : dict
        Schema of the value.
    optional : bool
        Whether the schema does not require it.
    """

    get: Any
    said: Schema = field(default_factory=dict)
    optional: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "get", path_getter(self.get) if isinstance(self.get, str) else self.get)

    def plain(self, of: Any) -> Any:
        """Value of an object."""
        return self.get(of)

    def schema(self) -> Schema:
        """Schema of the value."""
        return self.said

    def of(self, get: Any) -> Self:
        """The same key of an object at another path."""
        return replace(self, get=get)

    def inside(self, path: str) -> Self:
        """The same key of an object that holds its object at a path."""
        get, inner = self.get, path_getter(path)
        return replace(self, get=lambda of: get(inner(of)))


@dataclass(frozen=True)
class JsonObject(JsonKey):
    """An object of JSON; left out where there is nothing to describe, or null where its schema allows that.

    Attributes
    ----------
    keys : mapping of str to JsonKey
        Its keys, of what `get` returns.
    """

    keys: Mapping[str, JsonKey] = field(default_factory=dict)

    def plain(self, of: Any) -> Any:
        """Data of an object."""
        inner = self.get(of)
        if inner is None:
            return None if "type" in self.said else LEFT_OUT
        if inner is LEFT_OUT:
            return LEFT_OUT
        made = {name: key.plain(inner) for name, key in self.keys.items()}
        return {name: value for name, value in made.items() if value is not LEFT_OUT}

    def schema(self) -> Schema:
        """Schema of the object."""
        required = [name for name, key in self.keys.items() if not key.optional]
        properties = {name: key.schema() for name, key in self.keys.items()}
        return {"type": "object", "properties": properties, "required": required, **self.said}


@dataclass(frozen=True)
class JsonList(JsonKey):
    """A list of objects of one kind; left out where there is none.

    Attributes
    ----------
    item : JsonKey
        Each of them.
    """

    item: JsonKey = field(default_factory=lambda: JsonKey(""))

    def plain(self, of: Any) -> Any:
        """Data of the list."""
        held = self.get(of)
        return held if held is LEFT_OUT else [self.item.plain(one) for one in held]

    def schema(self) -> Schema:
        """Schema of the list."""
        return {"type": "array", "items": self.item.schema(), **self.said}


def describe_value(of: str) -> Schema:
    """Schema of a description."""
    return {"description": of} if of else {}


def value_key(get: Any, *kinds: str, of: str = "", optional: bool = False) -> JsonKey:
    """Return a key with a value of one of some types."""
    return JsonKey(get, {"type": kinds[0] if len(kinds) == 1 else list(kinds)} | describe_value(of), optional)


def number_key(get: Any, of: str = "", *, optional: bool = False, known: bool = True) -> JsonKey:
    """Return a key with a number, or null where it need not be known."""
    return value_key(get, *(("number",) if known else ("number", "null")), of=of, optional=optional)


def text_key(get: Any, of: str = "", *, known: bool = True) -> JsonKey:
    """Return a key with a text, or null where it need not be known."""
    return value_key(get, *(("string",) if known else ("string", "null")), of=of)


def choice_key(get: Any, *values: str, of: str = "") -> JsonKey:
    """Return a key with one of some values."""
    return JsonKey(get, {"enum": list(values)} | describe_value(of))


def text_list(get: Any, of: str = "") -> JsonList:
    """Return a key with a list of texts."""
    return JsonList(get, describe_value(of), item=text_key(lambda text: text))


def number_list(get: Any, *, known: bool = True) -> JsonList:
    """Return a key with a list of numbers."""
    return JsonList(get, item=number_key(lambda number: number, known=known))


def free_object(get: Any, *kinds: str) -> JsonObject:
    """Return a key with an object of any names, with values of some types."""
    return _OpenObject(get, {"additionalProperties": {"type": list(kinds)}})


def number_object(get: Any, *names: str, of: str = "") -> JsonObject:
    """Return a key with an object of numbers: those named, and maybe more."""
    more = {"additionalProperties": {"type": "number"}}
    return _OpenObject(get, more | describe_value(of), keys={name: number_key(name) for name in names})


class _OpenObject(JsonObject):
    """An object whose keys are those of a mapping."""

    def plain(self, of: Any) -> Any:
        """Data of the mapping."""
        return self.get(of)


ROW_SCHEMA: Final[Schema] = {
    "type": "object",
    "additionalProperties": {"type": ["number", "string", "boolean", "null"]},
}
"""Schema of a row of a table under the names of its columns."""


def table_rows(make: Callable[[Any], Table]) -> JsonList:
    """Return a key with the rows of a table of an object, under the names of its columns."""
    said = describe_value("rows of a table, under the names of its columns with their units")
    return JsonList(lambda of: make(of).records(), said, item=JsonKey(lambda row: row, ROW_SCHEMA))


def row_list(get: Any, *texts: str, numbers: tuple[str, ...], also: tuple[str, ...] = (), of: str = "") -> JsonList:
    """Return a key with rows of text and of numbers or null; `also` names optional numbers."""
    keys = {name: text_key(name) for name in texts}
    keys |= {name: number_key(name, known=False) for name in numbers}
    keys |= {name: number_key(name, known=False, optional=True) for name in also}
    return JsonList(get, describe_value(of), item=row_object(keys))


def row_object(keys: Mapping[str, JsonKey], said: Schema | None = None) -> JsonObject:
    """Return a key with an object that is JSON already."""
    return _OpenObject(lambda held: held, said or {}, keys=keys)


VERSION_KEY: Final = JsonKey(lambda _: SCHEMA_VERSION, {"const": SCHEMA_VERSION})
