"""Cells of the template filled in from a conveyor; defaults stay empty."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import Any, TypeAlias

from pydantic import BaseModel

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.forms.cell_values import CellValue, to_cells
from conveyor.forms.form_fields import FieldGroup, FieldTable, FormField, Part, Path
from conveyor.forms.sheet_plan import SheetPlan, plan_model, plan_reference, referenced_models
from conveyor.models.base import given_data

Cells: TypeAlias = dict[Path, tuple[CellValue, str | None]]


@dataclass(frozen=True)
class FilledRow:
    """Row of a list: number, number of its parent item, cells."""

    number: int
    parent: int | None
    cells: Cells


@dataclass
class FilledSheets:
    """Cells of all sheets of a plan."""

    plan: SheetPlan
    called: str = ""
    """Name of a written-out model in references."""
    cells: Cells = field(default_factory=dict)
    items: dict[str, list[FilledRow]] = field(default_factory=dict)


def fill_sheets(model: BaseModel, shelves: Iterable[str | FilePath] = ()) -> list[FilledSheets]:
    """Cells of a model: its own sheets first, then those of its written-out compounds.

    A compound that is on the shelf under its name, with the same content, is given by name.
    """
    plan = plan_model(type(model))
    filler = _SheetFiller(plan, tuple(shelves))
    own = filler.fill(plan, given_data(model))
    return [own, *filler.written.values()]


@dataclass(frozen=True)
class _Cursor:
    """Filling position: sheets, cells of a form or row, path among them, number of the row."""

    sheets: FilledSheets
    cells: Cells
    path: Path
    number: int | None

    def down(self, key: str) -> _Cursor:
        return replace(self, path=(*self.path, key))


class _SheetFiller:
    def __init__(self, plan: SheetPlan, shelves: tuple[str | FilePath, ...]) -> None:
        self._stems = {model: stem for stem, model in referenced_models(plan.root).items()}
        self.shelves = shelves
        self._taken = set(shelf.names(shelves))
        self.written: dict[str, FilledSheets] = {}
        self._contents: dict[str, dict[str, Any]] = {}

    def fill(self, plan: SheetPlan, data: dict[str, Any], called: str = "") -> FilledSheets:
        sheets = FilledSheets(plan, called, items={sheet.name: [] for sheet in plan.tables})
        self._group(plan.root, data, _Cursor(sheets, sheets.cells, (), None))
        return sheets

    def _group(self, group: FieldGroup, data: dict[str, Any], at: _Cursor) -> None:
        written = [self._part(part, data[part.key], at.down(part.key)) for part in group.parts if part.key in data]
        if not any(written) and not group.required:
            # an empty form means "not given": a model given without any field shows its defaults
            for part in group.parts:
                if isinstance(part, FormField) and part.default is not None:
                    at.cells[*at.path, part.key] = to_cells(part, part.default)

    def _part(self, part: Part, data: Any, at: _Cursor) -> bool:
        """Fill in a field, a nested model or a list; True if any cell was filled."""
        before = len(at.cells)
        if isinstance(part, FormField):
            given = self._reference(part.model, data) if part.model is not None else data
            at.cells[at.path] = to_cells(part, given)
        elif isinstance(part, FieldGroup):
            self._group(part, data, at)
        else:
            self._rows(part, data, at)
            return bool(data)
        return len(at.cells) > before

    def _rows(self, table: FieldTable, data: list[Any], at: _Cursor) -> None:
        name = next(sheet.name for sheet in at.sheets.plan.tables if sheet.table is table)
        rows = at.sheets.items[name]
        for item in data:
            row = FilledRow(len(rows) + 1, at.number, {})
            rows.append(row)
            self._group(replace(table.item, required=False), item, _Cursor(at.sheets, row.cells, (), row.number))

    def _reference(self, model: type[BaseModel], data: dict[str, Any]) -> str:
        """Name of a model on the shelf, or of its own sheet in this workbook."""
        whole_data = model.model_validate(data).model_dump(mode="json", by_alias=True, exclude_none=True)
        name = str(data.get("name", "")) or "compound"
        if self._on_shelf(name, whole_data):
            return name
        called, number = name, 2
        while called.casefold() in self._taken or self._contents.get(called, whole_data) != whole_data:
            called, number = f"{name} ({number})", number + 1
        if called not in self._contents:
            self._contents[called] = whole_data
            plan = plan_reference(model, f"{self._stems[model]} {len(self._contents)}")
            self.written[called] = self.fill(plan, data, called)
        return called

    def _on_shelf(self, name: str, whole_data: dict[str, Any]) -> bool:
        try:
            return shelf.compound(name, extra=self.shelves).as_data() == whole_data
        except InputError:
            return False
