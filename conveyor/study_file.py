"""Files of studies and of duties to size; every error with file, line and column."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, TypeVar

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.explain import read_model
from conveyor.files.content import file_content
from conveyor.laboratory.encoding import decoded
from conveyor.laboratory.separated import headed_lines
from conveyor.models.sizing import SizingDuty
from conveyor.models.study import (
    DUTY,
    HOURS,
    SearchPlan,
    StudyPlan,
    Value,
    VariedSpec,
    alike_as_one,
    hours_of,
)

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
    return _with_states(read_model(StudyPlan, Path(path)), Path(path))


def read_search(path: str | Path) -> SearchPlan:
    """Read what `conveyor optimise` searches; as `read_plan`."""
    return _with_states(read_model(SearchPlan, Path(path)), Path(path))


def read_duty(path: str | Path, *, shelves: Iterable[str | Path] = ()) -> SizingDuty:
    """Read the duty of a conveyor that is to be sized; as `read_plan`, compounds by name or path.

    Raises
    ------
    InputError
        As `read_plan`.
    """
    where = Path(path)
    return read_model(SizingDuty, where, {"compound": shelf.resolver(extra=shelves, base=where.parent)})


@contextmanager
def named(path: str | Path) -> Iterator[None]:
    """Name the file of a plan in what refuses it later: a field, a figure or a compound that its spec does not know.

    Raises
    ------
    InputError
        As it was raised, with the file.
    """
    try:
        yield
    except InputError as error:
        raise InputError("\n".join(f"{path}: {line}" for line in str(error).splitlines())) from None


def _with_states(plan: Given, path: Path) -> Given:
    """A plan with the table of its states, where it names one."""
    if not isinstance(plan.states, str) or plan.states == DUTY:
        return plan
    table = path.parent / plan.states
    try:
        return plan.replace(states=read_states(table))
    except InputError as error:
        named = str(error).startswith(str(table))
        raise InputError(str(error) if named else f"{table}: {error}") from None


def read_states(path: Path) -> tuple[dict[str, Value], ...]:
    """States of a table: a column a field, headed by its path and unit, and `hours`; alike rows become one.

    Raises
    ------
    InputError
        It cannot be read, or a cell is empty or of another kind.
    """
    text, _ = decoded(file_content(path, largest=LARGEST_FILE, expected="table of states"), path.name)
    lines = [line for line in headed_lines(text) if not line.comment]
    heads = [_HEAD.fullmatch(name) for line in lines[:1] for name in line.cells]
    if len(lines) < 2 or not all(heads):
        raise InputError(
            f'{path}: expected a column a field, such as "ambient.temperature [degC]", and hours [h]'
        )
    named = [(one[1], one[2] or "") for one in heads if one is not None]
    timed = any(name == HOURS for name, _ in named)
    rows: list[dict[str, Value]] = []
    for number, cells, *_ in lines[1:]:
        if len(cells) != len(named) or not all(cells):
            raise InputError(f"{path}: row {number}: expected {len(named)} cells, none of them empty")
        given = {name: _cell(cell, unit) for cell, (name, unit) in zip(cells, named, strict=True)}
        time = hours_of(given.pop(HOURS, 1.0))
        if time is None:
            raise InputError(f"{path}: row {number}: hours: expected a time above 0")
        rows.append(given | ({HOURS: time} if timed else {}))
    return alike_as_one(rows)


def _cell(cell: str, unit: str) -> Value:
    """A value as specs write it."""
    if unit:
        return f"{cell} {unit}"
    try:
        return float(cell)
    except ValueError:
        return cell
