"""Fields of a spec as a form: what each is, what it may be, what it is now, all read from the models."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.files.libraries import built_in_entries
from conveyor.forms.form_fields import FormField
from conveyor.models import Conveyor
from conveyor.models.fields import field_value
from conveyor.models.library_items import LibraryItem
from conveyor.report.tables.inputs import input_rows
from conveyor.starter.format_reference import example_value, format_fields
from conveyor.units.quantity_kinds import readable_unit

_INDEX: Final = re.compile(r"\[(\d+)\]")
_YES: Final = {"true": True, "yes": True, "false": False, "no": False}
MOST_ENTRIES: Final = 100
"""Entries of a list that a form has fields for; longer ones are changed in the file."""
_STEPS_NAMED: Final = 2
"""Last steps of a path that name a field: "carry spacing"."""


@dataclass(frozen=True)
class DesignField:
    """A field of a spec.

    Attributes
    ----------
    path : str
        Its path, as `--set` takes it.
    label, part : str
        Words for people; the block of the spec that it belongs to.
    kind : str
        Kind of value: quantity, number, count, switch, choice, text, list, reference, json.
    doc, allowed, example : str
        Its line of docs, its range, an example value.
    choices : tuple of str
        Values that it may have, if listed.
    required : bool
        Whether the spec must give it.
    value : str or None
        As written in the file, else by library or default.
    given_by : str
        spec, library, default, or nothing where it has no value.
    """

    path: str
    label: str
    part: str
    kind: str
    doc: str
    allowed: str
    example: str
    choices: tuple[str, ...]
    required: bool
    value: str | None
    given_by: str

    def plain(self) -> dict[str, Any]:
        """The row as plain data for the page, without what is empty."""
        return {key: value for key, value in asdict(self).items() if value not in ("", (), None, False)}


def form_rows(conveyor: Conveyor, data: Mapping[str, Any]) -> tuple[DesignField, ...]:
    """Every field of a spec but the version of its format, in the order of the models; lists with their entries.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    data : mapping
        Plain data of its file, for values as they are written.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> [row.value for row in form_rows(line, {}) if row.path == "belt.speed"]  # doctest: +SKIP
    ['5 m/s']
    """
    known = _values_by_path(conveyor, data)
    rows = []
    fields = format_fields(Conveyor)
    del fields["conveyor"]
    for pattern, field in fields.items():
        for path in _expand_path(conveyor, pattern):
            value, origin = known.get(path, (None, ""))
            choices = tuple(map(str, field.choices)) if field.kind == "choice" else _library_names(conveyor, path)
            example = example_value(Conveyor, pattern)
            rows.append(_form_row(path, field, value, origin, example=example, choices=choices))
    return tuple(rows)


def _form_row(
    path: str, field: FormField, value: str | None, origin: str, *, example: Any, choices: tuple[str, ...]
) -> DesignField:
    return DesignField(
        path=path,
        label=field_label(path),
        part=path.partition(".")[0].partition("[")[0] if "." in path else "",
        kind=field.kind,
        doc=field.doc,
        allowed=field.allowed,
        example="" if example is None else value_text(example),
        choices=choices,
        required=field.required,
        value=value,
        given_by=origin,
    )


def _library_names(conveyor: Conveyor, path: str) -> tuple[str, ...]:
    """Names that a field `listed` may have: the entries of the library of its part."""
    part, _, name = path.rpartition(".")
    holder = field_value(conveyor, part) if name == "listed" else None
    return tuple(built_in_entries(holder.library)) if isinstance(holder, LibraryItem) else ()


def field_label(path: str) -> str:
    """Words for a field from the end of its path.

    Examples
    --------
    >>> field_label("idlers.carry.spacing"), field_label("route.sections[2].lift"), field_label("name")
    ('carry spacing', 'sections 3 lift', 'name')
    """
    steps = _INDEX.sub(lambda index: f" {int(index[1]) + 1}", path).split(".")
    return " ".join(steps[-_STEPS_NAMED:]).replace("_", " ")


def value_text(value: Any) -> str:
    """Plain value as a person types it; lists in the notation of JSON."""
    if isinstance(value, str):
        return value
    return json.dumps(value, ensure_ascii=False)


def read_change(path: str, text: str | None) -> Any:
    """Read a typed text as a value of its field; empty text of an optional field is its default.

    The models check the value: what cannot be read stays text, which they refuse with what is allowed.

    Raises
    ------
    InputError
        No such field.

    Examples
    --------
    >>> read_change("drive.friction", "0.35"), read_change("belt.speed", "5 m/s"), read_change("name", "12")
    (0.35, '5 m/s', '12')
    """
    field = format_fields(Conveyor).get(_INDEX.sub("[]", path))
    if field is None:
        raise InputError(f"{path}: no such field")
    if text is None or (text.strip() == "" and not field.required):
        return field.default
    return _typed_value(field, text.strip())


def _typed_value(field: FormField, text: str) -> Any:
    if field.kind == "switch":
        return _YES.get(text.casefold(), text)
    if field.kind in {"number", "count", "json"}:
        return _json_or_text(text)
    if field.kind == "choice":
        return next((choice for choice in field.choices if str(choice) == text), text)
    if field.kind == "list":
        if text.startswith("["):
            return _json_or_text(text)
        item = field.item or field
        return [_typed_value(item, part.strip()) for part in text.split(",") if part.strip()]
    return text


def _json_or_text(text: str) -> Any:
    try:
        return json.loads(text, parse_constant=lambda name: name)
    except (ValueError, RecursionError):
        return text


def _values_by_path(conveyor: Conveyor, data: Mapping[str, Any]) -> dict[str, tuple[str, str]]:
    """Value as text and its origin, by path."""
    known: dict[str, tuple[str, str]] = {}
    lists: dict[str, list[str]] = {}
    for path, entered, _, _, origin in input_rows(conveyor):
        known[path] = (readable_unit(entered) if origin == "default" else entered), origin
        if path.endswith("]"):
            lists.setdefault(path.rpartition("[")[0], []).append(entered)
    for path, items in lists.items():
        known.setdefault(path, (", ".join(items), "spec"))
    for path, value in _written_values(data, ""):
        known[path] = value_text(value), "spec"
    return known


def _written_values(data: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Paths and values that a file gives, lists of values as one."""
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from _written_values(value, f"{path}.{key}" if path else str(key))
    elif isinstance(data, list) and any(isinstance(item, Mapping) for item in data):
        for i, item in enumerate(data):
            yield from _written_values(item, f"{path}[{i}]")
    elif isinstance(data, list):
        yield path, ", ".join(map(value_text, data)) if all(isinstance(item, str) for item in data) else data
    elif data is not None:
        yield path, data


def _expand_path(conveyor: Conveyor, pattern: str) -> Iterator[str]:
    """Paths of a pattern in a spec: one for each entry of its lists."""
    paths = [""]
    for step in pattern.split("."):
        name = step.removesuffix("[]")
        made = []
        for path in paths:
            here = f"{path}.{name}" if path else name
            if step.endswith("[]"):
                made += [f"{here}[{i}]" for i in range(_list_length(conveyor, here))]
            else:
                made.append(here)
        paths = made
    yield from paths


def _list_length(conveyor: Conveyor, path: str) -> int:
    """Entries of a list of a spec that have fields; none where it is not given."""
    value = field_value(conveyor, path)
    return min(len(value), MOST_ENTRIES) if isinstance(value, tuple) else 0
