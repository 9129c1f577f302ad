"""Files of studies and of duties to size; every error with file, line and column."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, TypeVar

from conveyor import shelf
from conveyor.errors import InputError, PlanError
from conveyor.files.document import Document, Fault, error_lines, fault_lines, read_document
from conveyor.files.file_bytes import file_content
from conveyor.laboratory.cell_grid import TextLine, cell_error
from conveyor.laboratory.delimited_text import table_lines
from conveyor.laboratory.encoding import decode_text
from conveyor.models.base import field_path
from conveyor.models.file_kinds import read_file_of
from conveyor.models.maker_lists import MakerLists
from conveyor.models.sizing import SizingDuty
from conveyor.models.study import (
    DUTY_STATES,
    HOURS_KEY,
    SearchPlan,
    StudyPlan,
    Value,
    VariedSpec,
    hours_of,
    merge_equal_states,
)
from conveyor.models.validation_messages import Location
from conveyor.units import quantity

LARGEST_FILE: Final = 10_000_000
"""Bytes; a year of hourly values takes a tenth."""
_HEADER_PATTERN: Final = re.compile(r"\s*([^\s\[\]()]+)\s*(?:\[\s*(.*?)\s*\])?\s*")
Plan = TypeVar("Plan", bound=VariedSpec)


def read_plan(path: str | Path) -> StudyPlan:
    """Read a study from a ``.yaml``, ``.yml`` or ``.json`` file, with the table of its states.

    Raises
    ------
    InputError
        A file cannot be read, or is refused; all its errors at once, each with file, line, column and field.
    """
    return _with_state_table(read_file_of(StudyPlan, Path(path)), Path(path))


def read_search(path: str | Path) -> SearchPlan:
    """Read a search for `conveyor optimise`; as `read_plan`."""
    return _with_state_table(read_file_of(SearchPlan, Path(path)), Path(path))


def read_duty(path: str | Path, *, shelves: Iterable[str | Path] = ()) -> SizingDuty:
    """Read the duty of a conveyor that is to be sized; as `read_plan`, compounds by name or path.

    Raises
    ------
    InputError
        As `read_plan`.
    """
    where = Path(path)
    context = {"compound": shelf.resolver(extra=shelves, base=where.parent), "lists": MakerLists(where.parent)}
    return read_file_of(SizingDuty, where, context)


@contextmanager
def name_plan_file(path: str | Path) -> Iterator[None]:
    """Name the plan file in later errors about its fields, figures or compounds.

    Raises
    ------
    InputError
        As it was raised, with the file.
    """
    try:
        yield
    except PlanError as error:
        raise InputError(_problem_lines(read_document(Path(path)), error)) from None
    except InputError as error:
        raise InputError("\n".join(f"{path}: {line}" for line in str(error).splitlines())) from None


def _problem_lines(document: Document, error: PlanError) -> str:
    """Text of the problems of a plan with their lines in its file or its table of states."""
    faults, of_states = [], []
    table = document.data.get("states")
    for place, said in error.problems:
        if place[0] == "states" and len(place) == 3 and isinstance(table, str) and table != DUTY_STATES:
            of_states.append((place[1], place[2], said))
        else:
            faults.append(Fault(document.place(place, of_key=True), field_path(place), _strip_place(place, said)))
    lines = [fault_lines(document.path, sorted(faults, key=lambda fault: fault.place))] if faults else []
    if of_states:
        path = Path(document.path).parent / str(table)
        firsts: dict[tuple[tuple[str, Value], ...], int] = {}
        rows = _state_rows(path)
        for number, row in rows:
            firsts.setdefault(tuple((name, value) for name, value in row.items() if name != HOURS_KEY), number)
        numbers = list(firsts.values())
        columns = list(rows[0][1])
        lines += [
            str(cell_error(str(path), numbers[int(i)], columns.index(str(field)), said)) for i, field, said in of_states
        ]
    return "\n".join(lines)


def _strip_place(place: Location, said: str) -> str:
    """Message without the parts of its location, which are written before it."""
    for part in place:
        said = said.removeprefix(f"{part}: ")
    return said


def base_spec_path(plan: VariedSpec, path: str | Path) -> Path:
    """Path of the base spec of a plan, relative to its file.

    Raises
    ------
    InputError
        The spec does not exist.
    """
    base = Path(path).parent / plan.base
    with name_plan_file(path):
        if not base.exists():
            raise PlanError([(("base",), f"{base}: no such file")])
    return base


def _with_state_table(plan: Plan, path: Path) -> Plan:
    """Plan with the states of its table, where it names one."""
    if not isinstance(plan.states, str) or plan.states == DUTY_STATES:
        return plan
    table = path.parent / plan.states
    try:
        return plan.replace(states=read_states(table))
    except InputError as error:
        named = str(error).startswith(str(table))
        raise InputError(str(error) if named else f"{table}: {error}") from None


def read_states(path: Path) -> tuple[dict[str, Value], ...]:
    """States of a table: one column a field, headed by path and unit, and `hours`; equal rows are merged.

    Raises
    ------
    InputError
        The table cannot be read, or a cell is empty or of another kind.
    """
    return merge_equal_states(row for _, row in _state_rows(path))


def _state_rows(path: Path) -> list[tuple[int, dict[str, Value]]]:
    """Numbered rows of a table of states; all problems in one error."""
    text, _ = decode_text(file_content(path, largest=LARGEST_FILE, expected="table of states"), path.name)
    head, *lines = [line for line in table_lines(text) if not line.comment] or [TextLine(1, ("",), "", False)]
    heads = [_HEADER_PATTERN.fullmatch(name) for name in head.cells]
    named = [(one[1], one[2] or "") for one in heads if one is not None]
    if not lines or len(named) < len(heads):
        raise InputError(f'{path}: expected a column a field, such as "ambient.temperature [degC]", and hours [h]')
    names = [name for name, _ in named]
    wrong = [
        cell_error(str(path), head.number, i, f"{name} has a column already; leave one of both")
        for i, name in enumerate(names)
        if name in names[:i]
    ]
    if wrong:
        raise InputError("\n".join(map(str, wrong)))
    rows: list[tuple[int, dict[str, Value]]] = []
    for number, cells, *_ in lines:
        if len(cells) != len(named) or not all(cells):
            wrong.append(InputError(f"{path}:{number}: expected {len(named)} cells, none of them empty"))
            continue
        given: dict[str, Value] = {}
        for i, (cell, (name, unit)) in enumerate(zip(cells, named, strict=True)):
            try:
                given[name] = _cell_value(cell, unit, timed=name == HOURS_KEY)
            except InputError as error:
                wrong.append(cell_error(str(path), number, i, str(error), header=head.cells[i]))
        rows.append((number, given))
    if wrong:
        raise InputError(error_lines(wrong, str, str(path)))
    return rows


def _cell_value(cell: str, unit: str, *, timed: bool) -> Value:
    """Value of a cell as in specs; hours of a time."""
    value = f"{cell} {unit}" if unit else _number_or_text(cell)
    if unit:
        quantity(value)
    if not timed:
        return value
    time = hours_of(value)
    if time is None:
        raise InputError(f'got "{value}", expected a time above 0')
    return time


def _number_or_text(cell: str) -> Value:
    """Number, else the text."""
    try:
        return float(cell)
    except ValueError:
        return cell
