"""Specs: a conveyor from a YAML or JSON file and back; every error with file, line and column."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from conveyor import shelf
from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError
from conveyor.files.document import error_lines, read_document, yaml_text
from conveyor.models import Conveyor
from conveyor.models.base import Model, field_path, given_data, real_errors, validate_model
from conveyor.models.file_kinds import read_file_of
from conveyor.models.maker_lists import MakerLists
from conveyor.models.validation_messages import Location, error_message

_FIELD: Final = re.compile(r"[a-z_]+(?:\.[a-z_]+|\[[0-9]+\])*(?=[: ])")
_TABLE_ENDINGS: Final = {".xls", ".xlsm", ".xlsb", ".ods", ".csv", ".tsv"}


@check_arguments
def load(path: str | Path, *, shelves: Iterable[str | Path] = ()) -> Conveyor:
    """Read a conveyor from a ``.yaml``, ``.yml`` or ``.json`` file, or from an input workbook (``.xlsx``).

    Parameters
    ----------
    path : str or Path
        The spec.
    shelves : iterable of path
        Further folders of compounds. Paths of compounds in the spec start from the spec's folder, and so does the
        search for makers' lists.

    Returns
    -------
    Conveyor
        Its fields are quantities as written in the file.

    Raises
    ------
    InputError
        The file cannot be read, or is refused; all its errors at once, each on a line
        ``file:line:column field: what was given, what is allowed``.
    """
    where = Path(path)
    if where.suffix.lower() == ".xlsx":
        from conveyor.forms.form_reader import read_template

        filled = read_template(where)
        return from_data(filled.data, where=filled.where, shelves=shelves, base=where.parent)
    if where.suffix.lower() in _TABLE_ENDINGS:
        raise InputError(f"{where}: a workbook or table is read as .xlsx only; save a workbook as .xlsx")
    if where.suffix.lower() not in {".yaml", ".yml", ".json"} and not where.is_dir():
        beside = where.with_name(f"{where.name}.yaml")
        near = f'; did you mean "{beside}"?' if beside.is_file() else ""
        raise InputError(f'{where}: expected a file that ends in .yaml, .yml, .json or .xlsx, got "{where.name}"{near}')
    return read_file_of(Conveyor, where, _name_context(shelves, where.parent))


@check_arguments
def from_data(
    data: Mapping[str, Any],
    *,
    where: Callable[[Location], str] | None = None,
    shelves: Iterable[str | Path] = (),
    base: Path | None = None,
) -> Conveyor:
    """Build a conveyor from plain data that did not come from a spec file (a workbook, a service).

    Parameters
    ----------
    data : mapping
        The same keys and texts as a spec.
    where : callable, optional
        Gives the place of a field for messages (``"Belt!B4"``) from its location (keys and indices).
    shelves, base
        As in `load`.

    Raises
    ------
    InputError
        Refused; all errors at once, each on a line ``place field: message``.
    """
    try:
        return validate_model(Conveyor, dict(data), _name_context(shelves, base))
    except ValidationError as error:

        def line(item: Any) -> str:
            location: Location = tuple(item["loc"])
            place = "" if where is None else where(location) + " "
            return f"{place}{field_path(location) or 'conveyor'}: {error_message(item, Conveyor)}"

        raise InputError(error_lines(real_errors(error), line)) from None


def _name_context(shelves: Iterable[str | Path], base: Path | None) -> dict[str, Any]:
    """Context in which models look up names: compounds on the shelf, items in makers' lists."""
    return {"compound": shelf.resolver(extra=shelves, base=base), "lists": MakerLists(base)}


@contextmanager
def locate_errors(path: str | Path) -> Iterator[None]:
    """Put the place in the spec before an error raised later about one of its fields.

    Parameters
    ----------
    path : str or Path
        The spec that the conveyor was loaded from.

    Raises
    ------
    InputError
        The error raised inside, after ``file:line:column`` where it names a field of the file.
    """
    try:
        yield
    except InputError as error:
        named = _FIELD.match(str(error))
        parts = [] if named is None else re.findall(r"[a-z_]+|[0-9]+", named[0])
        if not parts or parts[0] not in Conveyor.model_fields:
            raise
        location: Location = tuple(int(part) if part.isdigit() else part for part in parts)
        raise InputError(f"{_field_place(Path(path), location)} {error}") from None


def _field_place(path: Path, location: Location) -> str:
    if path.suffix.lower() == ".xlsx":
        from conveyor.forms.form_reader import read_template

        return read_template(path).where(location)
    line, column = read_document(path).place(location)
    return f"{path}:{line}:{column}"


@check_arguments
def dump(conveyor: Conveyor) -> str:
    """Return a spec (YAML) that `load` reads back to an equal conveyor, compounds written out."""
    return yaml_text(conveyor.as_data(), width=110)


def dump_given(conveyor: Conveyor, *, shelves: Iterable[str | Path] = ()) -> str:
    """Return a spec as a designer writes it: without defaults, covers of compounds on the shelf by name.

    Parameters
    ----------
    conveyor : Conveyor
        To be written.
    shelves : iterable of path
        Folders of compounds beside the usual ones.
    """
    data = given_data(conveyor)
    for cover in (data["belt"]["top_cover"], data["belt"]["bottom_cover"]):
        name = cover["compound"]["name"]
        with suppress(InputError):
            if given_data(shelf.compound(name, extra=shelves)) == cover["compound"]:
                cover["compound"] = name
    return yaml_text(data, width=110)


def fingerprint(conveyor: Conveyor, *, without: Collection[str] = ()) -> str:
    """Return the SHA-256 of a conveyor's data, compounds and defaults included, for reports.

    Two specs that differ in comments, order or layout have the same fingerprint; any changed value or unit
    changes it, but not what `report` holds, which no figure depends on, nor the version of the format, nor what fields
    `without` do.
    """
    left_out = {"conveyor", "report", *without}
    data = {key: value for key, value in conveyor.as_data().items() if key not in left_out}
    canonical = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(canonical.encode()).hexdigest()


def schema(model: type[Model] = Conveyor) -> dict[str, Any]:
    """Return the JSON schema of a spec or another file format, for editors.

    Parameters
    ----------
    model : type of Model
        Model of the format.

    Examples
    --------
    >>> sorted(schema()["required"])[:3]
    ['ambient', 'belt', 'drive']
    """
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **model.json_schema()}
