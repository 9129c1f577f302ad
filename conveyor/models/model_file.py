"""Read a model from a file; errors as lines with place, field, what was given, what is allowed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from conveyor.errors import InputError
from conveyor.files.document import MOST_LINES, Document, Fault, fault_lines, read_document
from conveyor.models.base import field_path, real_errors, validate_model
from conveyor.models.validation_messages import Location, error_message

M = TypeVar("M", bound=BaseModel)


def read_model(model: type[M], path: Path, context: Mapping[str, Any] | None = None) -> M:
    """Read a model from a YAML or JSON file.

    Raises
    ------
    InputError
        The file cannot be read, or is refused; all its errors at once, each with file, line, column and field.
    """
    document = read_document(path)
    faults = list(document.findings)
    try:
        read = validate_model(model, document.data, _plain_context(context))
    except ValidationError as error:
        faults = _validation_faults(_error_with_commas(error, model, document, context), model, document)
    if faults:
        raise InputError(fault_lines(document.path, faults))
    return read


def _plain_context(context: Mapping[str, Any] | None) -> dict[str, Any] | None:
    return None if context is None else dict(context)


def _error_with_commas(
    error: ValidationError, model: type[BaseModel], document: Document, context: Mapping[str, Any] | None
) -> ValidationError:
    """Error of the data with numbers that a comma has torn apart in braces, ``{length: 2,300 ft}``, as written."""
    joined = _join_at_commas(document.data)
    if joined != document.data:
        try:
            validate_model(model, joined, _plain_context(context))
        except ValidationError as of_joined:
            return of_joined
    return error


def _join_at_commas(data: Any) -> Any:
    """Data in which a key that begins with a digit and has no value goes on with the number before it."""
    if isinstance(data, list):
        return [_join_at_commas(item) for item in data]
    if not isinstance(data, dict):
        return data
    joined: dict[Any, Any] = {}
    for key, value in data.items():
        last = next(reversed(joined), None)
        number = joined.get(last)
        if value is None and str(key)[:1].isdigit() and isinstance(number, int | float):
            joined[last] = f"{number},{key}"
        else:
            joined[key] = _join_at_commas(value)
    return joined


def _validation_faults(error: ValidationError, model: type[BaseModel], document: Document) -> list[Fault]:
    """Errors of a validation in the order of the file, with their places; only the first have messages."""
    faults = list(document.findings)
    known = {finding.field for finding in faults}
    placed = []
    for item in real_errors(error):
        location = _file_location(tuple(item["loc"]), document.data)
        place = document.place(location, of_key=item["type"] == "extra_forbidden")
        field = field_path(location) or "file"
        if field not in known:
            placed.append((place, field, item))
    placed.sort(key=lambda error: error[0])
    for count, (place, field, item) in enumerate(placed):
        faults.append(Fault(place, field, error_message(item, model) if count < MOST_LINES else ""))
    return sorted(faults, key=lambda finding: finding.place)


def _file_location(location: Location, data: Any) -> Location:
    """Location without the tags of unions, which pydantic adds."""
    kept: list[int | str] = []
    for part in location:
        is_tag = isinstance(data, dict) and part not in data and part in data.values()
        if not is_tag:
            data = _child_data(data, part)
            kept.append(part)
    return tuple(kept)


def _child_data(data: Any, part: int | str) -> Any:
    if isinstance(data, dict):
        return data.get(part)
    return data[part] if isinstance(data, list) and isinstance(part, int) and part < len(data) else None
