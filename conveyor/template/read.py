"""From a filled-in template to plain data that knows its cells."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any, Final

from conveyor.errors import InputError
from conveyor.models import Conveyor
from conveyor.models.base import Location, field_path
from conveyor.template.layout import Group, Leaf, Path, Table
from conveyor.template.plan import Form, Plan, Sheet, references, whole, written_out
from conveyor.template.values import from_cells
from conveyor.template.workbook import Found, Grid, address, read_workbook

KEY, VALUE, UNIT = "Key", "Value", "Unit"
"""Headers by which the columns of a form are found."""
NUMBER, PARENT = "#", "^"
"""Keys of the columns of a list that number its items and name the item of the list above."""
NAMED = "@"
"""Key of the name that a written-out compound is referred to by."""
UNIT_OF: Final = "[unit]"
MOST_LINES: Final = 100
_HEADER_ROWS: Final = 60
"""Rows in which the header of a form or list is looked for."""


@dataclass(frozen=True)
class Filled:
    """What a workbook holds: plain data as of a spec, and the cell of every field."""

    path: str
    data: dict[str, Any]
    cells: Mapping[Location, str]

    def where(self, location: Location) -> str:
        """Return ``file:sheet!cell`` of a field, or of the nearest part above it that has a place."""
        known: Location = ()
        for part in location:
            if (*known, part) in self.cells:
                known = (*known, part)
        return f"{self.path}:{self.cells[known]}"


@dataclass(frozen=True)
class _Entry:
    """The cells of one field."""

    place: str
    value: Found | None
    unit: Found | None
    unit_place: str = ""

    @property
    def filled(self) -> bool:
        return self.value is not None


@dataclass(frozen=True)
class _Item:
    """A row of a list."""

    place: str
    number: int | None
    parent: int | None
    entries: dict[Path, _Entry]


@dataclass
class _Content:
    """The entries of all sheets of a plan."""

    plan: Plan
    entries: dict[Path, _Entry] = field(default_factory=dict)
    items: dict[str, list[_Item]] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)


def read_template(path: str | FilePath) -> Filled:
    """Read a workbook that `conveyor.template.write.write_template` wrote and someone filled in.

    Parameters
    ----------
    path : str or Path
        The workbook, ``.xlsx``. Sheets that the template does not have are ignored.

    Returns
    -------
    Filled
        Data for `conveyor.spec.from_data`, which checks them, and the places for its messages.

    Raises
    ------
    InputError
        The workbook cannot be read, lacks sheets, or has cells that cannot be taken for one value;
        all of them at once, each on a line ``file:sheet!cell field: message``.
    """
    where = FilePath(path)
    grids = read_workbook(where)
    reader = _Reader(str(where), grids)
    filled = reader.read()
    if reader.problems:
        more = len(reader.problems) - MOST_LINES
        lines = reader.problems[:MOST_LINES] + ([f"{where}: and {more} more errors"] if more > 0 else [])
        raise InputError("\n".join(lines))
    return filled


class _Reader:
    """Reads sheet by sheet, notes every problem, then puts the data together."""

    def __init__(self, path: str, grids: dict[str, Grid]) -> None:
        self.path, self.grids = path, grids
        self.problems: list[str] = []
        self.cells: dict[Location, str] = {}
        self.by_name: dict[str, _Content] = {}

    def read(self) -> Filled:
        plan = whole(Conveyor)
        content = self._content(plan)
        if not self.problems:
            self._read_written_out(plan)
            self.cells[()] = content.places[plan.forms[0].name]
            data, _ = self._group(content, plan.root, (), content.entries, (), None)
            return Filled(self.path, data, self.cells)
        return Filled(self.path, {}, {})

    def refuse(self, place: str, message: str) -> None:
        self.problems.append(f"{self.path}:{place} {message}")

    # -- sheets to entries

    def _content(self, plan: Plan) -> _Content:
        content = _Content(plan)
        for form in plan.forms:
            grid = self._sheet(form.name, required=form.required)
            content.places[form.name] = address(form.name, 1, 1)
            if grid is not None:
                self._form(grid, form, content)
        for sheet in plan.tables:
            grid = self._sheet(sheet.name, required=sheet.table.required)
            content.places[sheet.name] = address(sheet.name, 1, 1)
            content.items[sheet.name] = [] if grid is None else self._table(grid, sheet, content)
        for sheet in plan.tables:
            if sheet.parent is not None:
                self._check_parents(content, sheet, sheet.parent)
        return content

    def _sheet(self, name: str, *, required: bool) -> Grid | None:
        if name in self.grids:
            return self.grids[name]
        near = difflib.get_close_matches(name.casefold(), [other.casefold() for other in self.grids], n=1)
        if required or near:
            meant = next((other for other in self.grids if near and other.casefold() == near[0]), None)
            guess = f'; is it "{meant}"? Give it its name back' if meant else ""
            listed = ", ".join(f'"{other}"' for other in list(self.grids)[:20])
            self.problems.append(
                f'{self.path}: sheet "{name}" is missing{guess}; sheets found: {listed}; '
                "a new template: conveyor template input.xlsx"
            )
        return None

    def _form(self, grid: Grid, form: Form, content: _Content) -> None:
        header = self._header(grid, (KEY, VALUE, UNIT))
        if header is None:
            return
        top, columns = header
        wanted = {".".join(row.path): row.path for row in form.rows if isinstance(row.part, Leaf)}
        wanted[NAMED] = (NAMED,)
        self._refuse_merged(grid, top, set(columns.values()))
        first: dict[str, int] = {}
        for row in (row for row in grid.rows() if row > top):
            key, place = grid.text(row, columns[KEY]), address(grid.name, row, columns[VALUE])
            value, unit = grid.cells.get((row, columns[VALUE])), grid.cells.get((row, columns[UNIT]))
            if not key:
                if value is not None:
                    self.refuse(place, f'a value in a row without a field (column "{KEY}"); remove it')
            elif key not in wanted:
                self._unknown(address(grid.name, row, columns[KEY]), key, list(wanted))
            elif key in first:
                self.refuse(place, f"{key}: given twice, first in row {first[key]}; remove one of the rows")
            else:
                first[key] = row
                unit_place = address(grid.name, row, columns[UNIT])
                content.entries[wanted[key]] = _Entry(place, value, unit, unit_place)

    def _table(self, grid: Grid, sheet: Sheet, content: _Content) -> list[_Item]:
        header = self._header(grid, (NUMBER,))
        if header is None:
            return []
        top, columns = header
        content.places[sheet.name] = address(grid.name, top, columns[NUMBER])
        known = {".".join(column.path): column.path for column in sheet.columns}
        units = {f"{key} {UNIT_OF}": key for key in known}
        for key, column in columns.items():
            if key not in {*known, *units, NUMBER, PARENT}:
                self._unknown(address(grid.name, top, column), key, [*known, *units])
        self._refuse_merged(grid, top, set(columns.values()))
        items = []
        for row in (row for row in grid.rows() if row > top):
            entries = {}
            for key, path in known.items():
                if key in columns:
                    of_unit = columns.get(f"{key} {UNIT_OF}")
                    entries[path] = _Entry(
                        address(grid.name, row, columns[key]),
                        grid.cells.get((row, columns[key])),
                        None if of_unit is None else grid.cells.get((row, of_unit)),
                        "" if of_unit is None else address(grid.name, row, of_unit),
                    )
            if any(entry.filled for entry in entries.values()):
                number = self._whole(grid, row, columns[NUMBER])
                parent = self._whole(grid, row, columns[PARENT]) if PARENT in columns else None
                items.append(_Item(address(grid.name, row, columns[NUMBER]), number, parent, entries))
            else:
                self._refuse_strays(grid, row, set(columns.values()))
        return items

    def _header(self, grid: Grid, needed: tuple[str, ...]) -> tuple[int, dict[str, int]] | None:
        """Find the row that names the columns, and its names."""
        for row in range(1, _HEADER_ROWS + 1):
            named = [(grid.text(r, c), c) for r, c in sorted(grid.cells) if r == row]
            columns = {name: column for name, column in reversed(named) if name}
            if all(name in columns for name in needed):
                for i, (name, column) in enumerate(named):
                    if name and name in {earlier for earlier, _ in named[:i]}:
                        self.refuse(address(grid.name, row, column), f'column "{name}" twice; remove one')
                return row, columns
        listed = ", ".join(f'"{name}"' for name in needed)
        self.problems.append(
            f'{self.path}: sheet "{grid.name}" has no row with {listed} in its first {_HEADER_ROWS}; '
            "start from a new template: conveyor template input.xlsx"
        )
        return None

    def _unknown(self, place: str, key: str, known: list[str]) -> None:
        near = difflib.get_close_matches(key, known, n=1)
        guess = f'; did you mean "{near[0]}"?' if near else ""
        self.refuse(place, f'unknown key "{key[:80]}"{guess}')

    def _refuse_merged(self, grid: Grid, top: int, columns: set[int]) -> None:
        for first_row, first, last_row, last in grid.merged:
            if last_row > top and any(first <= column <= last for column in columns):
                begin = address(grid.name, first_row, first)
                end = address(grid.name, last_row, last).rpartition("!")[2]
                self.refuse(f"{begin}:{end}", "cells are merged; unmerge them, one cell holds one value")

    def _refuse_strays(self, grid: Grid, row: int, columns: set[int]) -> None:
        """Refuse what stands outside the columns of a list in a row that gives no item."""
        for (r, column), found in grid.cells.items():
            if r == row and column not in columns and found.value is not None:
                self.refuse(
                    address(grid.name, row, column),
                    "outside the columns of the list; remove it or move it to another sheet",
                )

    def _whole(self, grid: Grid, row: int, column: int) -> int | None:
        found = grid.cells.get((row, column))
        if found is None:
            return None
        if (
            isinstance(found.value, int | float)
            and not isinstance(found.value, bool)
            and found.value == int(found.value)
        ):
            return int(found.value)
        place = address(grid.name, row, column)
        self.refuse(place, found.problem or f'got "{found.value}", expected the number of an item')
        return None

    def _check_parents(self, content: _Content, sheet: Sheet, parent: str) -> None:
        above = [item.number for item in content.items[parent]]
        for item in content.items[sheet.name]:
            if above.count(item.parent) != 1 or item.parent is None:
                many = "several" if item.parent in above and item.parent is not None else "no"
                given = "nothing" if item.parent is None else item.parent
                self.refuse(item.place, f'belongs to item {given} of sheet "{parent}": {many} such row')

    def _read_written_out(self, plan: Plan) -> None:
        for stem, model in references(plan.root).items():
            for name in self.grids:
                if re.fullmatch(rf"{re.escape(stem)} \d+", name):
                    content = self._content(written_out(model, name))
                    entry = content.entries.get((NAMED,))
                    called = "" if entry is None or entry.value is None else str(entry.value.value)
                    if not called and any(entry.filled for entry in content.entries.values()):
                        self.refuse(content.places[name], f'needs a name to refer to it (key "{NAMED}")')
                    elif called in self.by_name:
                        self.refuse(content.places[name], f'"{called}" is written out twice; rename one')
                    elif called:
                        self.by_name[called] = content

    # -- entries to data

    def _group(
        self,
        content: _Content,
        group: Group,
        path: Path,
        entries: dict[Path, _Entry],
        at: Location,
        item: _Item | None,
    ) -> tuple[dict[str, Any], bool]:
        """Put a nested model together; tells also whether any of it was filled in."""
        data: dict[str, Any] = {}
        any_filled = False
        for part in group.parts:
            here, there = (*path, part.key), (*at, part.key)
            if isinstance(part, Leaf):
                entry = entries.get(here)
                if entry is not None:
                    self.cells[there] = entry.place
                    if entry.filled:
                        data[part.key] = self._leaf(part, entry, there)
            elif isinstance(part, Group):
                self._place_group(content, here, entries, there)
                inner, filled = self._group(content, part, here, entries, there, item)
                if filled or part.required:
                    data[part.key] = inner
                any_filled |= filled
            else:
                rows = self._rows(content, part, here, there, item)
                if rows or part.required:
                    data[part.key] = rows
                any_filled |= bool(rows)
            any_filled |= isinstance(part, Leaf) and part.key in data
        return data, any_filled

    def _place_group(self, content: _Content, path: Path, entries: dict[Path, _Entry], at: Location) -> None:
        """A nested model stands where its first field does, or on its own sheet."""
        inside = (entry.place for known, entry in entries.items() if known[: len(path)] == path)
        sheet = next((f.name for f in content.plan.forms if f.rows and f.rows[0].path[:1] == path), None)
        place = content.places[sheet] if sheet is not None else next(inside, None)
        if place is not None:
            self.cells[at] = place

    def _rows(
        self, content: _Content, table: Table, path: Path, at: Location, item: _Item | None
    ) -> list[dict[str, Any]]:
        sheets = [sheet for sheet in content.plan.tables if sheet.table is table and sheet.path == path]
        name = sheets[0].name
        self.cells[at] = content.places[name]
        rows = []
        for row in content.items[name]:
            if item is None or row.parent == item.number:
                there = (*at, len(rows))
                self.cells[there] = row.place
                data, _ = self._group(content, table.item, (), row.entries, there, row)
                rows.append(data)
        return rows

    def _leaf(self, leaf: Leaf, entry: _Entry, at: Location) -> Any:
        value, unit = entry.value, entry.unit
        if value is None:
            return None
        name = field_path(at)
        for found, place in ((value, entry.place), (unit, entry.unit_place)):
            if found is not None and found.problem:
                self.refuse(place, f"{name}: {found.problem}")
                return None
        of_unit = None if unit is None or unit.value is None else str(unit.value).strip()
        if value.percent and of_unit:
            self.refuse(
                entry.place,
                f'{name}: shown as a percentage beside the unit "{of_unit}"; format the cell as a number, '
                "or empty the unit cell",
            )
            return None
        try:
            data = from_cells(leaf, value.value, of_unit)
        except InputError as error:
            self.refuse(entry.place, f"{name}: {error}")
            return None
        if leaf.kind == "reference" and data in self.by_name:
            content = self.by_name[str(data)]
            inner, _ = self._group(content, content.plan.root, (), content.entries, at, None)
            return inner
        return data
