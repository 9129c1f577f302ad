"""What a field allows: in words, as drop-downs, as ranges that the spreadsheet program checks."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.datavalidation import DataValidation
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.forms.layout import Leaf
from conveyor.forms.plan import LISTS
from conveyor.forms.values import EMPTY, NO, YES, to_cells
from conveyor.report.cells import put

_ENDLESS: Final = 1e300
"""Stands for no limit: spreadsheet programs reach a little further."""
_ALLOWED: Final = {
    "switch": f"{YES} or {NO}",
    "list": 'values separated by ";"',
    "reference": "a shelf name, the path of a compound file, or a name written out here",
    "json": "text or JSON",
    "count": "a whole number",
    "number": "a number",
}


class Rules:
    """Gives cells their drop-downs, whose entries stand on a hidden sheet."""

    def __init__(self, compounds: Iterable[str]) -> None:
        self._compounds = tuple(compounds)
        self._lists: dict[tuple[Any, ...], str] = {}

    def apply(self, sheet: Worksheet, leaf: Leaf, value: str, unit: str) -> None:
        """Give the value and unit cells of a field, or the ranges of them, their rules."""
        if leaf.units:
            self._add(sheet, self._drop_down(leaf.units), unit)
        if leaf.kind == "choice" and leaf.choices:
            self._add(sheet, self._drop_down(leaf.choices), value)
        elif leaf.kind == "switch":
            self._add(sheet, self._drop_down((YES, NO)), value)
        elif leaf.kind == "reference" and self._compounds:
            self._add(sheet, self._drop_down(self._compounds, strict=False), value)
        elif leaf.kind in {"number", "count"}:
            self._add(sheet, _range(leaf), value)

    def draw(self, book: Workbook) -> None:
        """Write the entries of all drop-downs to their sheet."""
        sheet = book.create_sheet(LISTS)
        sheet.sheet_state = "hidden"
        for column, entries in enumerate(self._lists, start=1):
            for row, entry in enumerate(entries, start=1):
                put(sheet.cell(row, column), entry)

    def _drop_down(self, entries: tuple[Any, ...], *, strict: bool = True) -> DataValidation:
        if entries not in self._lists:
            letter = get_column_letter(len(self._lists) + 1)
            self._lists[entries] = f"'{LISTS}'!${letter}$1:${letter}${len(entries)}"
        rule = DataValidation(type="list", formula1=self._lists[entries], allow_blank=True)
        rule.showErrorMessage = strict
        rule.errorTitle, rule.error = "Not in the list", "Choose an entry of the list."
        return rule

    @staticmethod
    def _add(sheet: Worksheet, rule: DataValidation, cells: str) -> None:
        known = (old for old in sheet.data_validations.dataValidation if _alike(old, rule))
        alike = next(known, None)
        if alike is None:
            sheet.add_data_validation(rule)
        (alike or rule).add(cells)


def said(leaf: Leaf) -> str:
    """Say what a field allows."""
    if leaf.kind == "choice":
        return ", ".join(map(str, leaf.choices))
    general = _ALLOWED.get(leaf.kind, "")
    if leaf.kind == "list" and leaf.allowed:
        return f"{leaf.allowed}; {general}"
    return leaf.allowed or general


def default_text(leaf: Leaf) -> str:
    """Write a default as its cells would hold it."""
    if leaf.default is None:
        return ""
    value, unit = to_cells(leaf, leaf.default)
    return "" if value in {None, EMPTY} else " ".join(filter(None, (str(value), unit)))


def _range(leaf: Leaf) -> DataValidation:
    """Let the spreadsheet program refuse what no limit allows; open ends it takes as closed."""
    rule = DataValidation(type="decimal", operator="between", allow_blank=True, showErrorMessage=True)
    if leaf.kind == "count":
        rule.type = "whole"
    rule.errorTitle, rule.error = "Not allowed", f"Allowed: {said(leaf)}"
    rule.formula1 = repr(-_ENDLESS if leaf.low is None else leaf.low)
    rule.formula2 = repr(_ENDLESS if leaf.high is None else leaf.high)
    return rule


def _alike(old: DataValidation, new: DataValidation) -> bool:
    return all(getattr(old, name) == getattr(new, name) for name in ("type", "formula1", "formula2", "error"))
