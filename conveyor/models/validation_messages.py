"""Messages for pydantic's errors: what was given, what is allowed."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from conveyor.errors import shorten_text
from conveyor.units import Bounds, Measure
from conveyor.units.misreadings import escape_line_breaks, expected_text

Location = tuple[int | str, ...]

_OWN_KINDS = {"quantity", "conflict", "compound", "price"}
_LIMITS = {"greater_than": (">", "gt"), "greater_than_equal": (">=", "ge"), "less_than": ("<", "lt"),
           "less_than_equal": ("<=", "le")}  # fmt: skip
_EXPECTED_TYPES = {
    "string_type": "text",
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "int_parsing_size": "a whole number of a usual size",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "model_type": "fields (key: value)",
    "model_attributes_type": "fields (key: value)",
    "dict_type": "fields (key: value)",
    "finite_number": "a finite number",
}


_OTHER_NAMES = {
    "st": "steel cord", "steel": "steel cord", "polyester": "EP", "ep/pn": "EP", "nylon": "polyamide",
    "pa": "polyamide", "nn": "polyamide", "kevlar": "aramid", "pvg": "PVG solid woven", "pvc": "PVC solid woven",
}  # fmt: skip
"""What makers call things that a field names otherwise."""


def error_message(item: dict[str, Any], model: type[BaseModel]) -> str:
    """Message of one pydantic error: what was given, what is allowed."""
    kind, context, given = item["type"], item.get("ctx", {}), item.get("input")
    location: Location = tuple(item["loc"])
    writers: dict[str, Callable[[], str]] = {
        "missing": lambda: f"missing; expected {_expected_value(model, location)}",
        "extra_forbidden": lambda: _unknown_key(model, location),
        "union_tag_not_found": lambda: (
            f"{_without_quotes(context['discriminator'])} is missing; expected one of "
            + ", ".join(_tag_names(model, location))
        ),
        "union_tag_invalid": lambda: (
            f"got {_without_quotes(context['discriminator'])}: {shown_value(context['tag'])}, allowed: "
            f"{context['expected_tags']}"
        ),
        "literal_error": lambda: (
            f"got {shown_value(given)}, allowed: {context['expected']}{_closest_word(given, context['expected'])}"
        ),
        "too_short": lambda: f"got {context['actual_length']} entries, at least {context['min_length']} needed",
        "too_long": lambda: f"got more than {context['max_length']} entries, the most allowed",
        "string_too_short": lambda: "empty; give some text",
    }
    if kind in _OWN_KINDS:
        return str(item["msg"])
    if kind in writers:
        return writers[kind]()
    if kind in _LIMITS:
        sign, key = _LIMITS[kind]
        return f"got {shown_value(given)}, allowed: {sign} {context[key]:g}"
    if kind in _EXPECTED_TYPES:
        return f"expected {_EXPECTED_TYPES[kind]}, got {shown_value(given)}{_share_as_number(given)}"
    return f"got {shown_value(given)}: {item['msg']}"


def _share_as_number(given: Any) -> str:
    """The number that a percentage means, where a field takes numbers alone."""
    share = re.fullmatch(r"\s*(\d+(?:\.\d*)?)\s*%\s*", given) if isinstance(given, str) else None
    return "" if share is None else f"; write {float(share[1]) / 100.0:.12g}"


def _closest_word(given: Any, expected: str) -> str:
    """Suggest the allowed word closest to the given one, in any case."""
    words = {word.casefold(): word for word in re.findall(r"'([^']+)'", expected)}
    words |= {other: word for other, word in _OTHER_NAMES.items() if word in words.values()}
    near = difflib.get_close_matches(given.casefold(), words, n=1) if isinstance(given, str) else []
    return f'; did you mean "{words[near[0]]}"?' if near else ""


def _without_quotes(name: str) -> str:
    return name.strip("'")


def shown_value(value: Any) -> str:
    """Given value as shortened text for a message."""
    if isinstance(value, dict | BaseModel):
        return "several fields"
    if isinstance(value, list | tuple):
        return "a list"
    if value is None:
        return "nothing"
    text = (
        f'"{escape_line_breaks(value)}"'
        if isinstance(value, str)
        else str(value).lower()
        if isinstance(value, bool)
        else str(value)
    )
    return shorten_text(text)


def _unknown_key(model: type[BaseModel], location: Location) -> str:
    allowed = [
        field.alias or name for owner in _models_at(model, location[:-1]) for name, field in owner.model_fields.items()
    ]
    near = difflib.get_close_matches(str(location[-1]), allowed, n=1)
    guess = f'; did you mean "{near[0]}"?' if near else ""
    return f"unknown key {shown_value(str(location[-1]))}{guess}; keys allowed: {', '.join(allowed)}"


def _expected_value(model: type[BaseModel], location: Location) -> str:
    """Describe the value expected for a missing field."""
    field = next(
        (field for owner in _models_at(model, location[:-1]) if (field := _field_info(owner, location[-1]))),
        None,
    )
    if field is None:
        return "a value"
    measure = next((mark for mark in field.metadata if isinstance(mark, Measure)), None)
    if measure is not None:
        bounds = [mark for mark in field.metadata if isinstance(mark, Bounds)]
        return expected_text(measure.kind, lambda given: all(one.allows(measure.kind, given) for one in bounds))
    listed = get_origin(field.annotation) in {tuple, list}
    marks = (*field.metadata, *(part for arg in get_args(field.annotation) for part in get_args(arg)))
    wanted = next((mark.wanted for mark in marks if hasattr(mark, "wanted")), None)
    if wanted is not None:
        return f"a list, each {wanted}" if listed else str(wanted)
    inner = _models_in(field.annotation)
    if inner:
        needed = ", ".join(f.alias or n for n, f in inner[0].model_fields.items() if f.is_required())
        return f"a list, each with fields: {needed}" if listed else f"fields: {needed}"
    if get_origin(field.annotation) is Literal:
        return "one of " + ", ".join(map(str, get_args(field.annotation)))
    simple = {float: "a number", int: "a whole number", str: "text", bool: "true or false"}
    return simple.get(field.annotation, "a value") if isinstance(field.annotation, type) else "a value"


def _field_info(owner: type[BaseModel], part: int | str) -> FieldInfo | None:
    return next((f for name, f in owner.model_fields.items() if part in {name, f.alias}), None)


def _models_in(annotation: Any) -> list[type[BaseModel]]:
    """Collect the models of an annotation, through lists, unions and markers."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    origin = get_origin(annotation)
    if origin is Annotated:
        return _models_in(get_args(annotation)[0])
    if origin in {Union, UnionType, tuple, list}:
        return [model for part in get_args(annotation) for model in _models_in(part)]
    return []


def _models_at(model: type[BaseModel], location: Location) -> list[type[BaseModel]]:
    """Follow a location from the root model; a union's tag narrows the choice."""
    here = [model]
    for part in location:
        if isinstance(part, int):
            continue
        fields = [field for owner in here if (field := _field_info(owner, part)) is not None]
        if fields:
            here = [one for field in fields for one in _models_in(field.annotation)]
        else:
            here = [owner for owner in here if part in _tags_of(owner)]
    return here


def _tags_of(owner: type[BaseModel]) -> tuple[Any, ...]:
    """Values of literal fields, by which a discriminated union chooses."""
    literals = [f.annotation for f in owner.model_fields.values() if get_origin(f.annotation) is Literal]
    return tuple(value for literal in literals for value in get_args(literal))


def _tag_names(model: type[BaseModel], location: Location) -> list[str]:
    return [str(tag) for owner in _models_at(model, location) for tag in _tags_of(owner)]
