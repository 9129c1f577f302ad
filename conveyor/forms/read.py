"""From a filled-in template to plain data that knows its cells."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any, Final

from pydantic import BaseModel

from conveyor.errors import InputError
from conveyor.files.content import file_content
from conveyor.files.document import first_lines
from conveyor.files.workbook import MAGIC, Limits, Sheet, read_sheets
from conveyor.forms.entries import NAMED, Content, FieldEntry, Item, SheetReader, problem_of
from conveyor.forms.layout import FieldGroup, FieldTable, Leaf, Path
from conveyor.forms.plan import Plan, references, whole, written_out
from conveyor.forms.values import from_cells
from conveyor.models import Conveyor
from conveyor.models.base import field_path
from conveyor.models.wording import Location

LARGEST_FILE: Final = 3_000_000
"""Bytes; a template of a thousand sections has a twentieth of it."""
LIMITS: Final = Limits(content=10_000_000, parts=2_000, elements=150_000, expected="input workbook")
"""A template of a thousand sections has a tenth of the content (so much takes some seconds) and 40,000 elements."""
_OLE: Final = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ENCRYPTED: Final = "EncryptedPackage".encode("utf-16-le")


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
    return read_filled(FilePath(path), Conveyor)


def read_filled(where: FilePath, model: type[BaseModel], content: bytes | None = None) -> Filled:
    """Read a workbook of any model's plan, as `read_template` does that of a conveyor; or its bytes, if given."""
    sheets = SheetReader(str(where), sheets_of(where, content))
    plan = whole(model)
    held = sheets.content(plan)
    reader = _Reader(sheets, {} if sheets.problems else _written_out(plan, sheets))
    reader.cells[()] = held.places[plan.forms[0].name]
    data = {} if sheets.problems else reader.group(plan.root, _At(held, held.entries, (), (), None))[0]
    if sheets.problems:
        raise InputError(first_lines(sheets.problems, str, str(where)))
    return Filled(str(where), data, reader.cells)


def sheets_of(path: FilePath, content: bytes | None = None) -> dict[str, Sheet]:
    """Read every sheet of a workbook, by name."""
    read = read_sheets(_content(path) if content is None else content, str(path), LIMITS)
    return {sheet.name: sheet for sheet in read}


def _content(path: FilePath) -> bytes:
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


def _written_out(plan: Plan, sheets: SheetReader) -> dict[str, Content]:
    """Read what references may stand for, by the names they are referred to."""
    by_name: dict[str, Content] = {}
    for stem, model in references(plan.root).items():
        for name in sheets.grids:
            if re.fullmatch(rf"{re.escape(stem)} \d+", name):
                content = sheets.content(written_out(model, name))
                entry = content.entries.get((NAMED,))
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
class _At:
    """Where reading stands: the sheets, the fields of a form or row, the path among them, the place in the data."""

    content: Content
    entries: dict[Path, FieldEntry]
    path: Path
    location: Location
    item: Item | None

    def down(self, key: str) -> _At:
        return replace(self, path=(*self.path, key), location=(*self.location, key))


class _Reader:
    """Puts entries together to data and remembers the cell of each."""

    def __init__(self, sheets: SheetReader, by_name: dict[str, Content]) -> None:
        self._sheets, self._by_name = sheets, by_name
        self.cells: dict[Location, str] = {}

    def group(self, group: FieldGroup, at: _At) -> tuple[dict[str, Any], bool]:
        """Return the data of a nested model, and whether any of it was filled in."""
        data: dict[str, Any] = {}
        any_filled = False
        for part in group.parts:
            here = at.down(part.key)
            if isinstance(part, Leaf):
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

    def _place(self, at: _At) -> None:
        """Place a nested model on its own sheet, else where its first field stands."""
        forms = at.content.plan.forms
        own = (at.content.places[form.name] for form in forms if form.path == at.path and at.item is None)
        first = (entry.place for path, entry in at.entries.items() if path[: len(at.path)] == at.path)
        place = next(own, None) or next(first, None)
        if place is not None:
            self.cells[at.location] = place

    def _rows(self, table: FieldTable, at: _At) -> list[dict[str, Any]]:
        name = next(sheet.name for sheet in at.content.plan.tables if sheet.table is table)
        self.cells[at.location] = at.content.places[name]
        data: list[dict[str, Any]] = []
        for row in at.content.items[name]:
            if at.item is None or row.parent == at.item.number:
                here = _At(at.content, row.entries, (), (*at.location, len(data)), row)
                self.cells[here.location] = row.place
                data.append(self.group(table.item, here)[0])
        return data

    def _leaf(self, leaf: Leaf, at: _At, data: dict[str, Any]) -> bool:
        """Put a field's value into the data; tells whether it was filled in."""
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
            inside = _At(content, content.entries, (), at.location, None)
            value = self.group(content.plan.root, inside)[0]
        data[leaf.key] = value
        return True

    @staticmethod
    def _refused(entry: FieldEntry) -> tuple[str, str] | None:
        """Return the place and the reason why the cells of a field cannot be taken."""
        for value, place in ((entry.value, entry.place), (entry.unit, entry.unit_place)):
            problem = "" if value is None else problem_of(value)
            if problem:
                return place, problem
        if entry.value is not None and entry.value.percent and entry.unit is not None and entry.unit.value:
            advice = "format the cell as a number, or empty the unit cell"
            return entry.place, f'shown as a percentage beside the unit "{entry.unit.value}"; {advice}'
        return None
