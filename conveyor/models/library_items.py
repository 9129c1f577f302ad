"""Models that may name a library entry, which supplies the fields not given."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any, ClassVar, Self, cast

from pydantic import GetJsonSchemaHandler, ValidationInfo, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from conveyor.errors import InputError
from conveyor.files import libraries
from conveyor.models.base import Model, Problem, raise_problems
from conveyor.models.maker_lists import MAKER_KINDS, ListedItem, MakerKind, MakerLists

__all__ = ["LibraryItem", "find_item", "merge_fields", "without_entry_fields"]


class LibraryItem(Model):
    """Base of models with a field `listed`."""

    library: ClassVar[str]
    """Which library the names are of: of the package, of makers' lists, or both."""

    @model_validator(mode="before")
    @classmethod
    def _from_library(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, Mapping) or data.get("listed") is None:
            return data
        listed = data["listed"]
        if not isinstance(listed, str):
            return merge_fields(_item_fields(listed), data)
        built_in = libraries.built_in_entries(cls.library)
        try:
            if cls.library in MAKER_KINDS and not libraries.has_entry(built_in, listed):
                item = find_item((cls.library,), listed, info, built_in)
                return merge_fields(item.fields, data) | {"listed": item}
            return merge_fields(libraries.library_entry(cast("libraries.Library", cls.library), listed).fields, data)
        except InputError as error:
            raise_problems(cls.__name__, [Problem(("listed",), str(error))])
            raise

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """JSON schema: fields that an entry may supply are required only where none is named."""
        described = handler.resolve_ref_schema(handler(schema))
        known = {name for entry in libraries.built_in_entries(cls.library).values() for name in entry.fields}
        known |= _MAKER_FIELDS.get(cls.library, set())
        needed: list[str] = described.get("required", [])
        described["required"] = [name for name in needed if name not in known]
        described["anyOf"] = [
            {"required": ["listed"]},
            {"required": [name for name in needed if name in known]},
        ]
        return described

    @property
    def entry(self) -> libraries.LibraryEntry | None:
        """Library entry, if one is named."""
        named: str | ListedItem | None = getattr(self, "listed", None)
        if isinstance(named, ListedItem):
            return named.entry
        return None if named is None else libraries.library_entry(cast("libraries.Library", self.library), named)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with changed fields; another `listed` drops the values of the old entry.

        `listed=None` keeps all values and forgets where they came from.
        """
        old = self.entry
        if old is None or changes.get("listed") is None:
            return super().replace(**changes)
        data = {name: value for name, value in self.as_data().items() if name != "listed"}
        return self.from_data(without_entry_fields(data, old.fields) | changes)


_MAKER_FIELDS = {"pulleys": {"diameter", "shaft_diameter", "mass"}}
"""Required fields that an item of a maker's list always has, of kinds without a library of the package."""


def find_item(kinds: Collection[MakerKind], name: str, info: ValidationInfo, others: Iterable[str] = ()) -> ListedItem:
    """Item of the makers' lists of the validation context, without one of those for the working folder.

    Raises
    ------
    InputError
        There is none of that name, or there are two.
    """
    lists: MakerLists = (info.context or {}).get("lists") or MakerLists()
    return lists.item(kinds, name, others)


def _item_fields(listed: Any) -> Mapping[str, Any]:
    """Fields of an item that a spec keeps; none of one that is refused at its own field."""
    fields = (
        listed.fields if isinstance(listed, ListedItem) else listed.get("fields") if isinstance(listed, Mapping) else {}
    )
    return fields if isinstance(fields, Mapping) else {}


def merge_fields(entry: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of an entry, overridden by those given; nested mappings likewise.

    Examples
    --------
    >>> merge_fields({"mass": "27 kg/m^2", "carcass": {"kind": "EP"}}, {"carcass": {"thickness": "5 mm"}})
    {'mass': '27 kg/m^2', 'carcass': {'kind': 'EP', 'thickness': '5 mm'}}
    """
    fields: dict[str, Any] = dict(entry)
    for name, value in given.items():
        known = fields.get(name)
        if isinstance(value, Mapping) and isinstance(known, Mapping):
            fields[name] = merge_fields(known, value)
        else:
            fields[name] = value
    return fields


def without_entry_fields(data: Mapping[str, Any], entry: Mapping[str, Any]) -> dict[str, Any]:
    """Data without the values equal to those of an entry."""
    kept = {}
    for name, value in data.items():
        known = entry.get(name)
        if isinstance(value, Mapping) and isinstance(known, Mapping):
            kept[name] = without_entry_fields(value, known)
        elif value != known:
            kept[name] = value
    return kept
