"""Read a filled-in template to plain data, with the cell of every field."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import Any, Final

from openpyxl.utils import get_column_letter
from pydantic import BaseModel

from conveyor.errors import InputError
from conveyor.files.document import error_lines
from conveyor.files.file_bytes import file_content
from conveyor.files.output_marks import REPORT, output_kind
from conveyor.files.workbook_cells import MAGIC, ArchiveLimits, Sheet, SheetCell, read_sheets
from conveyor.forms.cell_values import from_cells
from conveyor.forms.form_fields import FieldGroup, FieldTable, FormField, Path
from conveyor.forms.sheet_plan import (
    Form,
    ListSheet,
    SheetPlan,
    plan_model,
    plan_reference,
    referenced_models,
)
from conveyor.models import Conveyor
from conveyor.models.base import field_path
from conveyor.models.validation_messages import Location

KEY, VALUE, UNIT = "Key", "Value", "Unit"
"""Column headers of a form."""
NUMBER, PARENT = "#", "^"
"""Column keys of a list: number of the item, and of its item in the parent list."""
NAME_KEY: Final = "@"
"""Key of the name of a written-out compound."""
UNIT_OF: Final = "[unit]"
_HEADER_ROWS: Final = 60
"""Rows searched for the header of a form or list."""


def cell_problem(cell: SheetCell) -> str:
    """Reason why a cell is not a value; "" where it is one."""
    if cell.kind == "no result":
        return (
            "holds a formula without a result; open the workbook in a spreadsheet program, let it calculate "
            "and save it, or type the value"
        )
    if cell.kind == "error":
        return f"holds the error {cell.value}; correct its formula or type the value"
    if cell.kind == "date":
        return (
            f"holds a date or time ({cell.value}): the spreadsheet program took the number for one; "
            "format the cell as a number and type it again"
        )
    infinite = isinstance(cell.value, float) and not math.isfinite(cell.value)
    return "holds a number that is not finite" if infinite else ""


def cell_address(sheet: str, row: int, column: int) -> str:
    """Cell address as in spreadsheets.

    Examples
    --------
    >>> cell_address("Belt", 4, 3), cell_address("Rubber compound 1", 4, 3)
    ('Belt!C4', "'Rubber compound 1'!C4")
    """
    quoted = sheet if sheet.isidentifier() else "'" + sheet.replace("'", "''") + "'"
    return f"{quoted}!{get_column_letter(column)}{row}"


@dataclass(frozen=True)
class FieldEntry:
    """The cells of one field."""

    place: str
    value: SheetCell | None
    unit: SheetCell | None
    unit_place: str


@dataclass(frozen=True)
class ListItem:
    """Row of a list: place, number, number of its parent item, fields."""

    place: str
    number: int | None
    parent: int | None
    entries: dict[Path, FieldEntry]


@dataclass
class SheetContent:
    """Entries of all sheets of a plan, and the first cell of each sheet."""

    plan: SheetPlan
    entries: dict[Path, FieldEntry] = field(default_factory=dict)
    items: dict[str, list[ListItem]] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)


class SheetReader:
    """Reads the sheets of a plan and collects all problems."""

    def __init__(self, path: str, grids: dict[str, Sheet]) -> None:
        self.path, self.grids = path, grids
        self.problems: list[str] = []

    def refuse(self, place: str, message: str) -> None:
        """Record a problem of a cell."""
        self.problems.append(f"{self.path}:{place} {message}")

    def content(self, plan: SheetPlan) -> SheetContent:
        """Read every sheet of a plan."""
        wanted = [*(form.name for form in plan.forms), *(sheet.name for sheet in plan.tables)]
        content = SheetContent(plan, places={name: cell_address(name, 1, 1) for name in wanted})
        if not set(wanted) & set(self.grids):
            self.problems.append(
                f'{self.path}: none of the template\'s sheets is in it, such as "{wanted[0]}"; '
                "write a template with: conveyor template input.xlsx"
            )
            return content
        for form in plan.forms:
            grid = self._sheet(form.name, required=form.required)
            if grid is not None:
                self._form(grid, form, content)
        for sheet in plan.tables:
            grid = self._sheet(sheet.name, required=sheet.table.required)
            content.items[sheet.name] = [] if grid is None else self._table(grid, sheet, content)
        for sheet in plan.tables:
            if sheet.parent is not None:
                self._check_parents(content, sheet, sheet.parent)
        return content

    def _sheet(self, name: str, *, required: bool) -> Sheet | None:
        """Return a sheet; an optional one may be missing, unless another has a similar name."""
        if name in self.grids:
            return self.grids[name]
        folded = {other.casefold().strip(): other for other in self.grids}
        near = difflib.get_close_matches(name.casefold(), folded, n=1, cutoff=0.8)
        if required or near:
            guess = f'; is it "{folded[near[0]]}"? Give it its name back' if near else ""
            listed = ", ".join(f'"{other}"' for other in list(self.grids)[:20])
            self.problems.append(
                f'{self.path}: sheet "{name}" is missing{guess}; sheets found: {listed}; '
                "write a new template with: conveyor template input.xlsx"
            )
        return None

    def _form(self, grid: Sheet, form: Form, content: SheetContent) -> None:
        top, columns = self._header(grid, (KEY, VALUE, UNIT))
        if not columns:
            return
        wanted = {".".join(row.path): row.path for row in form.rows if isinstance(row.part, FormField)}
        wanted[NAME_KEY] = (NAME_KEY,)
        self._refuse_merged(grid, top, {columns[name] for name in (KEY, VALUE, UNIT)})
        last = max(columns[name] for name in (KEY, VALUE, UNIT))
        while last + 1 in columns.values():
            last += 1
        self._refuse_strays(grid, top, set(columns.values()), last, "form")
        first: dict[str, int] = {}
        for row in (row for row in grid.rows() if row > top):
            key, place = grid.text(row, columns[KEY]), cell_address(grid.name, row, columns[VALUE])
            value, unit = grid.cells.get((row, columns[VALUE])), grid.cells.get((row, columns[UNIT]))
            if not key:
                if value is not None:
                    self.refuse(place, f'a value in a row without a field (column "{KEY}"); remove it')
            elif key not in wanted:
                self._unknown(cell_address(grid.name, row, columns[KEY]), key, wanted)
            elif key in first:
                self.refuse(place, f"{key}: given twice, first in row {first[key]}; remove one of the rows")
            else:
                first[key] = row
                unit_place = cell_address(grid.name, row, columns[UNIT])
                content.entries[wanted[key]] = FieldEntry(place, value, unit, unit_place)

    def _table(self, grid: Sheet, sheet: ListSheet, content: SheetContent) -> list[ListItem]:
        top, columns = self._header(grid, (NUMBER,))
        if not columns:
            return []
        content.places[sheet.name] = cell_address(grid.name, top, columns[NUMBER])
        known = {".".join(column.path): column.path for column in sheet.columns}
        allowed = [*known, *(f"{key} {UNIT_OF}" for key in known), NUMBER, PARENT]
        for key, column in columns.items():
            if key not in allowed:
                self._unknown(cell_address(grid.name, top, column), key, allowed)
        self._refuse_merged(grid, top, set(columns.values()))
        self._refuse_strays(grid, top, set(columns.values()), max(columns.values()), "list")
        items = []
        for row in (row for row in grid.rows() if row > top):
            entries = {
                path: _field_entry(grid, row, columns[key], columns.get(f"{key} {UNIT_OF}"))
                for key, path in known.items()
                if key in columns
            }
            if any(entry.value is not None for entry in entries.values()):
                number = self._whole(grid, row, columns[NUMBER])
                parent = self._whole(grid, row, columns[PARENT]) if PARENT in columns else None
                items.append(ListItem(cell_address(grid.name, row, columns[NUMBER]), number, parent, entries))
        return items

    def _header(self, grid: Sheet, needed: tuple[str, ...]) -> tuple[int, dict[str, int]]:
        """Number of the header row and its columns by name; no columns where there is none."""
        for row in range(1, _HEADER_ROWS + 1):
            columns: dict[str, int] = {}
            twice = []
            for column in sorted(c for r, c in grid.cells if r == row):
                name = grid.text(row, column)
                if name in columns:
                    twice.append((column, name))
                columns.setdefault(name, column)
            if all(name in columns for name in needed):
                for column, name in twice:
                    self.refuse(cell_address(grid.name, row, column), f'column "{name}" twice; remove one')
                return row, {name: column for name, column in columns.items() if name}
        listed = ", ".join(f'"{name}"' for name in needed)
        self.problems.append(
            f'{self.path}: sheet "{grid.name}" has no row with {listed} in its first {_HEADER_ROWS}; '
            "write a new template with: conveyor template input.xlsx"
        )
        return 0, {}

    def _unknown(self, place: str, key: str, known: Iterable[str]) -> None:
        near = difflib.get_close_matches(key, list(known), n=1)
        guess = f'; did you mean "{near[0]}"?' if near else ""
        self.refuse(place, f'unknown key "{key[:80]}"{guess}')

    def _refuse_merged(self, grid: Sheet, top: int, columns: set[int]) -> None:
        for first_row, first, last_row, last in grid.merged:
            if last_row > top and any(first <= column <= last for column in columns):
                begin = cell_address(grid.name, first_row, first)
                end = cell_address(grid.name, last_row, last).rpartition("!")[2]
                self.refuse(f"{begin}:{end}", "cells are merged; unmerge them, one cell holds one value")

    def _refuse_strays(self, grid: Sheet, top: int, columns: set[int], last: int, of: str) -> None:
        """Refuse cells that nobody reads: right of the last column, or below the header in a column without a name."""
        remark = ', or name its column beside "Key", such as "Remark"' if of == "form" else ""
        for row, column in sorted(grid.cells):
            if column > last or (row > top and column not in columns):
                place = cell_address(grid.name, row, column)
                self.refuse(place, f"outside the columns of the {of}; remove it, move it to another sheet{remark}")

    def _whole(self, grid: Sheet, row: int, column: int) -> int | None:
        cell = grid.cells.get((row, column))
        if cell is None:
            return None
        value = cell.value
        if isinstance(value, int | float) and not isinstance(value, bool) and value == int(value):
            return int(value)
        message = cell_problem(cell) or f'got "{value}", expected the number of an item'
        self.refuse(cell_address(grid.name, row, column), message)
        return None

    def _check_parents(self, content: SheetContent, sheet: ListSheet, parent: str) -> None:
        above = [item.number for item in content.items[parent]]
        for item in content.items[sheet.name]:
            count = above.count(item.parent) if item.parent is not None else 0
            if count != 1:
                given = "nothing" if item.parent is None else item.parent
                which = "no row has" if count == 0 else "several rows have"
                self.refuse(item.place, f'belongs to No. {given} of sheet "{parent}", a number that {which}')


def _field_entry(grid: Sheet, row: int, column: int, of_unit: int | None) -> FieldEntry:
    unit = None if of_unit is None else grid.cells.get((row, of_unit))
    unit_place = "" if of_unit is None else cell_address(grid.name, row, of_unit)
    return FieldEntry(cell_address(grid.name, row, column), grid.cells.get((row, column)), unit, unit_place)


LARGEST_FILE: Final = 3_000_000
"""Bytes; a template of a thousand sections has a twentieth of it."""
LIMITS: Final = ArchiveLimits(content=10_000_000, parts=2_000, elements=150_000, expected="input workbook")
"""A template of a thousand sections has a tenth of the content (so much takes some seconds) and 40,000 elements."""
_OLE: Final = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ENCRYPTED: Final = "EncryptedPackage".encode("utf-16-le")


@dataclass(frozen=True)
class FilledWorkbook:
    """Content of a workbook: plain data as of a spec, and the cell of every field."""

    path: str
    data: dict[str, Any]
    cells: Mapping[Location, str]

    def where(self, location: Location) -> str:
        """Place ``file:sheet!cell`` of a field, or of its nearest parent with a place."""
        known: Location = ()
        for part in location:
            if (*known, part) in self.cells:
                known = (*known, part)
        return f"{self.path}:{self.cells[known]}"


def read_template(path: str | FilePath) -> FilledWorkbook:
    """Read a workbook that `conveyor.starter.template_writer.write_template` wrote and someone filled in.

    Parameters
    ----------
    path : str or Path
        The workbook, ``.xlsx``. Sheets that the template does not have are ignored.

    Returns
    -------
    FilledWorkbook
        Data for `conveyor.spec.from_data`, which checks them, and the places for its messages.

    Raises
    ------
    InputError
        The workbook cannot be read, lacks sheets, or has cells that cannot be taken for one value;
        all of them at once, each on a line ``file:sheet!cell field: message``.
    """
    return read_form(FilePath(path), Conveyor)


def read_form(where: FilePath, model: type[BaseModel], content: bytes | None = None) -> FilledWorkbook:
    """Read a workbook of any model's plan, as `read_template` does that of a conveyor; or its bytes, if given."""
    sheets = SheetReader(str(where), sheets_of(where, content))
    plan = plan_model(model)
    held = sheets.content(plan)
    reader = _DataReader(sheets, {} if sheets.problems else _read_references(plan, sheets))
    reader.cells[()] = held.places[plan.forms[0].name]
    data = {} if sheets.problems else reader.group(plan.root, _Cursor(held, held.entries, (), (), None))[0]
    if sheets.problems:
        if output_kind(_workbook_bytes(where) if content is None else content) == REPORT:
            raise InputError(
                f"{where}: is a report of conveyor, not a workbook to fill in; give the spec it was calculated from, "
                "or write a template with: conveyor template input.xlsx"
            )
        raise InputError(error_lines(sheets.problems, str, str(where)))
    return FilledWorkbook(str(where), data, reader.cells)


def sheets_of(path: FilePath, content: bytes | None = None) -> dict[str, Sheet]:
    """Read every sheet of a workbook, by name."""
    read = read_sheets(_workbook_bytes(path) if content is None else content, str(path), LIMITS)
    return {sheet.name: sheet for sheet in read}


def _workbook_bytes(path: FilePath) -> bytes:
    if path.suffix.lower() != ".xlsx":
        raise InputError(f'{path}: expected a workbook that ends in .xlsx, got "{path.name}"')
    content = file_content(path, largest=LARGEST_FILE, expected="input workbook")
    if content.startswith(_OLE):
        if _ENCRYPTED in content:
            raise InputError(f"{path}: protected by a password; save it without one")
        raise InputError(f"{path}: not a workbook of the .xlsx format; save it as .xlsx")
    if not content.startswith(MAGIC):
        what = "empty" if not content else "not a workbook (.xlsx)"
        raise InputError(f"{path}: {what}; write one with: conveyor template input.xlsx")
    return content


def _read_references(plan: SheetPlan, sheets: SheetReader) -> dict[str, SheetContent]:
    """Read the written-out models by their names."""
    by_name: dict[str, SheetContent] = {}
    for stem, model in referenced_models(plan.root).items():
        for name in sheets.grids:
            if re.fullmatch(rf"{re.escape(stem)} \d+", name):
                content = sheets.content(plan_reference(model, name))
                entry = content.entries.get((NAME_KEY,))
                called = "" if entry is None or entry.value is None else str(entry.value.value)
                place = content.places[name] if entry is None else entry.place
                if not called and any(other.value is not None for other in content.entries.values()):
                    sheets.refuse(place, "needs a name to be referred to by")
                elif called in by_name:
                    sheets.refuse(place, f'"{called}" is written out twice; give each its own name')
                elif called:
                    by_name[called] = content
    return by_name


@dataclass(frozen=True)
class _Cursor:
    """Reading position: sheets, entries of a form or row, path among them, location in the data."""

    content: SheetContent
    entries: dict[Path, FieldEntry]
    path: Path
    location: Location
    item: ListItem | None

    def down(self, key: str) -> _Cursor:
        return replace(self, path=(*self.path, key), location=(*self.location, key))


class _DataReader:
    """Builds plain data from entries and records the cell of each."""

    def __init__(self, sheets: SheetReader, by_name: dict[str, SheetContent]) -> None:
        self._sheets, self._by_name = sheets, by_name
        self.cells: dict[Location, str] = {}

    def group(self, group: FieldGroup, at: _Cursor) -> tuple[dict[str, Any], bool]:
        """Data of a nested model, and True if any of it was filled in."""
        data: dict[str, Any] = {}
        any_filled = False
        for part in group.parts:
            here = at.down(part.key)
            if isinstance(part, FormField):
                filled = self._leaf(part, here, data)
            elif isinstance(part, FieldGroup):
                self._place(here)
                inner, filled = self.group(part, here)
                if filled or part.required:
                    data[part.key] = inner
            else:
                rows = self._rows(part, here)
                filled = bool(rows)
                if rows or part.required:
                    data[part.key] = rows
            any_filled |= filled
        return data, any_filled

    def _place(self, at: _Cursor) -> None:
        """Record the cell of a nested model: its own sheet, else its first field."""
        forms = at.content.plan.forms
        own = (at.content.places[form.name] for form in forms if form.path == at.path and at.item is None)
        first = (entry.place for path, entry in at.entries.items() if path[: len(at.path)] == at.path)
        place = next(own, None) or next(first, None)
        if place is not None:
            self.cells[at.location] = place

    def _rows(self, table: FieldTable, at: _Cursor) -> list[dict[str, Any]]:
        name = next(sheet.name for sheet in at.content.plan.tables if sheet.table is table)
        self.cells[at.location] = at.content.places[name]
        data: list[dict[str, Any]] = []
        for row in at.content.items[name]:
            if at.item is None or row.parent == at.item.number:
                here = _Cursor(at.content, row.entries, (), (*at.location, len(data)), row)
                self.cells[here.location] = row.place
                data.append(self.group(table.item, here)[0])
        return data

    def _leaf(self, leaf: FormField, at: _Cursor, data: dict[str, Any]) -> bool:
        """Add a field's value to the data; True if it was filled in."""
        entry = at.entries.get(at.path)
        if entry is None:
            return False
        self.cells[at.location] = entry.place
        if entry.value is None:
            return False
        refused = self._refused(entry)
        if refused is not None:
            place, message = refused
            self._sheets.refuse(place, f"{field_path(at.location)}: {message}")
            return True
        unit = None if entry.unit is None or entry.unit.value is None else str(entry.unit.value).strip()
        try:
            value = from_cells(leaf, entry.value.value, unit)
        except InputError as error:
            self._sheets.refuse(entry.place, f"{field_path(at.location)}: {error}")
            return True
        if leaf.kind == "reference" and value in self._by_name:
            content = self._by_name[value]
            inside = _Cursor(content, content.entries, (), at.location, None)
            value = self.group(content.plan.root, inside)[0]
        data[leaf.key] = value
        return True

    @staticmethod
    def _refused(entry: FieldEntry) -> tuple[str, str] | None:
        """Place and reason where the cells of a field are refused, else None."""
        for value, place in ((entry.value, entry.place), (entry.unit, entry.unit_place)):
            problem = "" if value is None else cell_problem(value)
            if problem:
                return place, problem
        if entry.value is not None and entry.value.percent and entry.unit is not None and entry.unit.value:
            advice = "format the cell as a number, or empty the unit cell"
            return entry.place, f'shown as a percentage beside the unit "{entry.unit.value}"; {advice}'
        return None
