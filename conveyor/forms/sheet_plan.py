"""Sheets of a model: one for each part and each list, under stable names."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import Final

from pydantic import BaseModel

from conveyor.forms.form_fields import (
    FieldGroup,
    FieldTable,
    FormField,
    Part,
    Path,
    leaf_fields,
    model_layout,
)

LONGEST_NAME: Final = 31
"""Characters of a sheet's name (Excel specifications and limits)."""
LISTS: Final = "Lists"
"""Hidden sheet of the entries of drop-downs."""


@dataclass(frozen=True)
class FormRow:
    """Line of a form: a field, or the heading of a nested model."""

    path: Path
    depth: int
    part: FormField | FieldGroup
    certain: bool
    """True if the field is required whatever else is filled in."""


@dataclass(frozen=True)
class Form:
    """Sheet of fields, one a line."""

    name: str
    doc: str
    path: Path
    rows: tuple[FormRow, ...]
    required: bool


@dataclass(frozen=True)
class FieldColumn:
    """Column of a list: a field of its items."""

    path: Path
    leaf: FormField
    certain: bool


@dataclass(frozen=True)
class ListSheet:
    """Sheet of a list, one row an item."""

    name: str
    table: FieldTable
    path: Path
    """From the root, or from the item of the list that holds it."""
    columns: tuple[FieldColumn, ...]
    parent: str | None
    """Sheet of the list whose items hold this one."""


@dataclass(frozen=True)
class SheetPlan:
    """All sheets of a model."""

    root: FieldGroup
    forms: tuple[Form, ...]
    tables: tuple[ListSheet, ...]


@dataclass
class _SheetNames:
    """Unique sheet names: the last word of the path, longer where that is taken."""

    prefix: str = ""
    taken: set[str] = field(default_factory=lambda: {LISTS.casefold(), "history"})

    def free_sheet_name(self, path: Path) -> str:
        for count in range(1, len(path) + 1):
            name = key_label(f"{self.prefix} {' '.join(path[-count:])}")[:LONGEST_NAME].strip()
            if name.casefold() not in self.taken:
                break
        number, stem = 2, name
        while name.casefold() in self.taken:
            name, number = f"{stem[: LONGEST_NAME - 4]} {number}", number + 1
        self.taken.add(name.casefold())
        return name


def key_label(key: str) -> str:
    """Key as a readable label.

    Examples
    --------
    >>> key_label("top_cover"), key_label("log10_aT"), key_label("cema_class")
    ('Top cover', 'Log10 aT', 'CEMA class')
    """
    words = key.replace("_", " ").strip().replace("cema", "CEMA")
    return words[:1].upper() + words[1:]


@cache
def plan_model(model: type[BaseModel]) -> SheetPlan:
    """Sheets of a model: its own fields on a first sheet, each nested model and each list on its own.

    Examples
    --------
    >>> from conveyor.models import Conveyor
    >>> [form.name for form in plan_model(Conveyor).forms][:3]
    ['Conveyor', 'Belt', 'Idlers']
    """
    root = model_layout(model)
    names = _SheetNames()
    own = FieldGroup(
        key="", doc=root.doc, required=True, parts=tuple(p for p in root.parts if isinstance(p, FormField))
    )
    forms = [_form_sheet(names.free_sheet_name((model.__name__,)), own, ())]
    forms += [
        _form_sheet(names.free_sheet_name((part.key,)), part, (part.key,))
        for part in root.parts
        if isinstance(part, FieldGroup)
    ]
    return SheetPlan(root, tuple(forms), tuple(_list_sheets(root, (), None, names)))


@cache
def plan_reference(model: type[BaseModel], name: str) -> SheetPlan:
    """Sheets of a referenced model: one form under `name`, its lists after it.

    Examples
    --------
    >>> from conveyor.models import RubberCompound
    >>> [sheet.name for sheet in plan_reference(RubberCompound, "Rubber compound 1").tables]
    ['Rubber compound 1 terms', 'Rubber compound 1 shift', 'Rubber compound 1 sweeps', 'Rubber compound 1 tests']
    """
    root = model_layout(model)
    names = _SheetNames(prefix=name)
    return SheetPlan(root, (_form_sheet(name, root, ()),), tuple(_list_sheets(root, (), None, names)))


def reference_stem(model: type[BaseModel]) -> str:
    """Name of the sheets of written-out models, without their number.

    Examples
    --------
    >>> from conveyor.models import RubberCompound
    >>> reference_stem(RubberCompound)
    'Rubber compound'
    """
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in model.__name__)
    return key_label(words)[: LONGEST_NAME - 14]


def referenced_models(part: Part) -> dict[str, type[BaseModel]]:
    """Models that fields refer to, by the stem of their sheet names."""
    models = [leaf.model for leaf in leaf_fields(part) if leaf.model is not None]
    return {reference_stem(model): model for model in models}


def _form_sheet(name: str, group: FieldGroup, path: Path) -> Form:
    return Form(name, group.doc, path, tuple(_form_rows(group, path, 0, certain=group.required)), group.required)


def _form_rows(group: FieldGroup, path: Path, depth: int, *, certain: bool) -> Iterator[FormRow]:
    for part in sorted(group.parts, key=lambda part: isinstance(part, FieldGroup)):
        here = (*path, part.key)
        if isinstance(part, FormField):
            yield FormRow(here, depth, part, certain and part.required)
        elif isinstance(part, FieldGroup):
            needed = certain and part.required
            yield FormRow(here, depth, part, needed)
            yield from _form_rows(part, here, depth + 1, certain=needed)


def _list_sheets(group: FieldGroup, path: Path, parent: str | None, names: _SheetNames) -> Iterator[ListSheet]:
    """Sheets of all lists of a group, nested lists after the list that holds them."""
    for part in group.parts:
        here = (*path, part.key)
        if isinstance(part, FieldTable):
            name = names.free_sheet_name(here)
            columns = tuple(_list_columns(part.item, (), certain=True))
            yield ListSheet(name, part, here, columns, parent)
            yield from _list_sheets(part.item, (), name, names)
        elif isinstance(part, FieldGroup):
            yield from _list_sheets(part, here, parent, names)


def _list_columns(group: FieldGroup, path: Path, *, certain: bool) -> Iterator[FieldColumn]:
    for part in group.parts:
        here = (*path, part.key)
        if isinstance(part, FormField):
            yield FieldColumn(here, part, certain and part.required)
        elif isinstance(part, FieldGroup):
            yield from _list_columns(part, here, certain=certain and part.required)
