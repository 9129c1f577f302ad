"""Study files: what varies of which spec; every error with file, line and column."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Final, TypeVar

from pydantic import ValidationError

from conveyor.errors import InputError
from conveyor.explain import findings
from conveyor.files.content import file_content
from conveyor.files.document import listing, read_document
from conveyor.laboratory.encoding import decoded
from conveyor.models.study import DUTY, HOURS, SearchPlan, StudyPlan, Value, VariedSpec, hours_of

LARGEST_FILE: Final = 10_000_000
"""Bytes; a year of hourly values has a tenth."""
_HEAD: Final = re.compile(r"\s*([^\s\[\]()]+)\s*(?:\[\s*(.*?)\s*\])?\s*")
Given = TypeVar("Given", bound=VariedSpec)


def read_plan(path: str | Path) -> StudyPlan:
    """Read a study from a ``.yaml``, ``.yml`` or ``.json`` file, with the table of its states.

    Raises
    ------
    InputError
        A file cannot be read, or is refused; all its errors at once, each with file, line, column and field.
    """
    return _read(StudyPlan, Path(path))


def read_search(path: str | Path) -> SearchPlan:
    """Read what `conveyor optimise` searches; as `read_plan`."""
    return _read(SearchPlan, Path(path))


def _read(kind: type[Given], path: Path) -> Given:
    document = read_document(path)
    found = list(document.findings)
    plan = None
    try:
        plan = kind.model_validate(document.data)
    except ValidationError as error:
        found = findings(error, kind, document)
    if plan is None or found:
        raise InputError(listing(document.path, found))
    if isinstance(plan.states, str) and plan.states != DUTY:
        table = path.parent / plan.states
        try:
            return plan.replace(states=read_states(table))
        except InputError as error:
            named = str(error).startswith(str(table))
            raise InputError(str(error) if named else f"{table}: {error}") from None
    return plan


def read_states(path: Path) -> tuple[dict[str, Value], ...]:
    """States of a table: a column a field, headed by its path and unit, and `hours`; alike rows become one.

    Raises
    ------
    InputError
        It cannot be read, or a cell is empty or of another kind.
    """
    text, _ = decoded(file_content(path, largest=LARGEST_FILE, expected="table of states"), path.name)
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    separator = max("\t;,", key=lines[0].count) if lines else ","
    head, *rows = csv.reader(lines, delimiter=separator, skipinitialspace=True) if lines else ([],)
    heads = [_HEAD.fullmatch(name) for name in head]
    if not rows or not all(heads):
        raise InputError(
            f'{path}: expected a column a field, such as "ambient.temperature [degC]", and hours [h]'
        )
    named = [(one[1], one[2] or "") for one in heads if one is not None]
    found: dict[tuple[Value, ...], float] = {}
    for number, row in enumerate(rows, start=2):
        if len(row) != len(named) or not all(cell.strip() for cell in row):
            raise InputError(f"{path}: row {number}: expected {len(named)} cells, none of them empty")
        given = {name: _cell(cell.strip(), unit) for cell, (name, unit) in zip(row, named, strict=True)}
        time = hours_of(given.pop(HOURS, 1.0))
        if time is None:
            raise InputError(f"{path}: row {number}: hours: expected a time above 0")
        alike = tuple(given.values())
        found[alike] = found.get(alike, 0.0) + time
    paths = [name for name, _ in named if name != HOURS]
    timed = any(name == HOURS for name, _ in named)
    return tuple(
        dict(zip(paths, alike, strict=True)) | ({HOURS: time} if timed else {})
        for alike, time in found.items()
    )


def _cell(cell: str, unit: str) -> Value:
    """A value as specs write it."""
    if unit:
        return f"{cell} {unit}"
    try:
        return float(cell)
    except ValueError:
        return cell
