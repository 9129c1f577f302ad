"""Models that may name a library entry, which supplies the fields not given."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Self

from pydantic import GetJsonSchemaHandler, StringConstraints, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from conveyor.errors import InputError
from conveyor.files import libraries
from conveyor.models.base import Model, Problem, raise_problems

EntryName = Annotated[str, StringConstraints(min_length=1, max_length=100)]


class LibraryItem(Model):
    """Base of models with a field `listed`."""

    library: ClassVar[libraries.Library]
    """Which library the names are of."""

    @model_validator(mode="before")
    @classmethod
    def _from_library(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or not isinstance(data.get("listed"), str):
            return data
        try:
            entry = libraries.library_entry(cls.library, data["listed"])
        except InputError as error:
            raise_problems(cls.__name__, [Problem(("listed",), str(error))])
            raise
        return merge_fields(entry.fields, data)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """JSON schema: fields that an entry may supply are required only where none is named."""
        described = handler.resolve_ref_schema(handler(schema))
        known = {name for entry in libraries.library_entries(cls.library).values() for name in entry.fields}
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
        name: str | None = getattr(self, "listed", None)
        return None if name is None else libraries.library_entry(self.library, name)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with changed fields; another `listed` drops the values of the old entry.

        `listed=None` keeps all values and forgets where they came from.
        """
        old = self.entry
        if old is None or changes.get("listed") is None:
            return super().replace(**changes)
        data = {name: value for name, value in self.as_data().items() if name != "listed"}
        return self.from_data(without_entry_fields(data, old.fields) | changes)


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
