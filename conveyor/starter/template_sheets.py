"""Sheets of the template: forms and lists with notes, drop-downs and ranges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from copy import copy
from importlib.metadata import version
from typing import Any, Final

from openpyxl.cell.cell import Cell, MergedCell
from openpyxl.comments import Comment
from openpyxl.formatting.rule import Rule
from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
from openpyxl.styles.differential import DifferentialStyle
from openpyxl.utils import get_column_letter
from openpyxl.workbook import Workbook
from openpyxl.worksheet.datavalidation import DataValidation
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.forms.cell_values import EMPTY, NO, YES, to_cells
from conveyor.forms.form_fields import FieldGroup, FormField, in_system
from conveyor.forms.form_reader import KEY, NAME_KEY, NUMBER, PARENT, UNIT, UNIT_OF, VALUE
from conveyor.forms.sheet_plan import LISTS, FieldColumn, Form, FormRow, ListSheet, key_label
from conveyor.report.cells import ACCENT, BOLD, GREY, HEADING, LINK, PALE, TITLE, write_value
from conveyor.report.sheet_paper import set_up_print
from conveyor.starter.filled_cells import FilledSheets
from conveyor.units import System

_ENDLESS: Final = 1e300
"""Number for "no limit", just below the largest of spreadsheet programs."""
_ALLOWED_TEXTS: Final = {
    "switch": f"{YES} or {NO}",
    "list": 'values separated by ";"',
    "reference": "a shelf name, the path of a compound file, or a name written out here",
    "json": "text or JSON",
    "count": "a whole number",
    "number": "a number",
}


class CellRules:
    """Validation rules of cells; entries of drop-downs are on a hidden sheet."""

    def __init__(self, compounds: Iterable[str]) -> None:
        self._compounds = tuple(compounds)
        self._lists: dict[tuple[Any, ...], str] = {}

    def apply(self, sheet: Worksheet, leaf: FormField, value: str, unit: str) -> None:
        """Add the rules of a field to its value and unit cells or ranges."""
        if leaf.units:
            self._add(sheet, self._drop_down(leaf.units), unit)
        if leaf.kind == "choice" and leaf.choices:
            self._add(sheet, self._drop_down(leaf.choices), value)
        elif leaf.kind == "switch":
            self._add(sheet, self._drop_down((YES, NO)), value)
        elif leaf.kind == "reference" and self._compounds:
            self._add(sheet, self._drop_down(self._compounds, strict=False), value)
        elif leaf.kind in {"number", "count"}:
            self._add(sheet, _range_rule(leaf), value)

    def draw(self, book: Workbook) -> None:
        """Write the entries of all drop-downs to their sheet."""
        sheet = book.create_sheet(LISTS)
        sheet.sheet_state = "hidden"
        for column, entries in enumerate(self._lists, start=1):
            for row, entry in enumerate(entries, start=1):
                write_value(sheet.cell(row, column), entry)

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
        known = (old for old in sheet.data_validations.dataValidation if _same_rule(old, rule))
        alike = next(known, None)
        if alike is None:
            sheet.add_data_validation(rule)
        (alike or rule).add(cells)


def allowed_text(leaf: FormField) -> str:
    """Allowed values of a field as text."""
    if leaf.kind == "choice":
        return ", ".join(map(str, leaf.choices))
    general = _ALLOWED_TEXTS.get(leaf.kind, "")
    if leaf.kind == "list" and leaf.allowed:
        return f"{leaf.allowed}; {general}"
    return leaf.allowed or general


def default_text(leaf: FormField) -> str:
    """Default of a field as text."""
    if leaf.default is None:
        return ""
    value, unit = to_cells(leaf, leaf.default)
    return "" if value in {None, EMPTY} else " ".join(filter(None, (str(value), unit)))


def _range_rule(leaf: FormField) -> DataValidation:
    """Validation rule for the range of a number; open ends are treated as closed."""
    rule = DataValidation(type="decimal", operator="between", allow_blank=True, showErrorMessage=True)
    if leaf.kind == "count":
        rule.type = "whole"
    rule.errorTitle, rule.error = "Not allowed", f"Allowed: {allowed_text(leaf)}"
    rule.formula1 = repr(-_ENDLESS if leaf.low is None else leaf.low)
    rule.formula2 = repr(_ENDLESS if leaf.high is None else leaf.high)
    return rule


def _same_rule(old: DataValidation, new: DataValidation) -> bool:
    return all(getattr(old, name) == getattr(new, name) for name in ("type", "formula1", "formula2", "error"))


_HEADERS: Final = {"Field": 26, VALUE: 30, UNIT: 11, "Allowed": 30, "Default": 14, "Meaning": 56, KEY: 30}
"""Columns of a form and their widths [characters]."""
_PRINTED_COLUMNS: Final = 4
"""Printed columns: field, value, unit, allowed."""
_HEAD: Final = 4
"""Row of the headers."""
_KEYS: Final = 6
"""Row of a list's keys, the last above its items."""
_SPARE_ROWS, _LEAST_ROWS, _LISTED_ROWS = 10, 20, _KEYS + 1000
"""Rows of a list drawn beyond those filled in and at least; the last row with drop-downs."""
_WHITE: Final = Font(name="Calibri", bold=True, color="FFFFFF")
_SMALL: Final = Font(name="Calibri", size=8, italic=True, color="808080")
_BAR: Final = PatternFill("solid", fgColor=ACCENT)
_NEEDED_FILL: Final = PatternFill("solid", bgColor="FFE699")
_LINE: Final = Side(style="thin", color="BFC8D2")
_BOX: Final = Border(left=_LINE, right=_LINE, top=_LINE, bottom=_LINE)
_WRAP_TEXT: Final = Alignment(horizontal="left", vertical="top", wrap_text=True, indent=1)
_AUTHOR: Final = "conveyor"
HOW_TO: Final = (
    "Fill in the framed cells: the value in one cell, its unit beside it (drop-down). A number without a unit "
    "is refused.",
    "* marks what is needed; such a cell is yellow while it is empty. Of a part that may be left out, * is needed "
    "once any of it is filled in.",
    "Grey defaults hold where the value cell stays empty. Notes on the field names repeat meaning and range.",
    "Parts that may be left out are folded: the + beside their heading opens them. Paper has what is open.",
    "Lists have a row for each item, in order; empty rows are passed over, rows may be added at the end.",
    "Sheets that few conveyors need are hidden while they are empty: right-click a tab, Unhide. Paper leaves them out.",
    "Write numbers as your spreadsheet program shows numbers; cells may refer to other sheets of your own, "
    "which are ignored.",
    'Rows and sheets are found by the names in the column "Key" and by the sheets\' names: leave those as they are.',
    'Remarks of your own go beside a form, in a column with a name beside "Key", or on a sheet of your own.',
    "Calculate with: conveyor power input.xlsx -o report.xlsx",
)


_RARE_SHEETS: Final = frozenset({
    "Further feeding", "Ploughs", "Fill", "Train", "Torque curve", "Further drives", "Starter fill", "Correlations",
    "Scenarios", "Events", "Starter fill 2",
})  # fmt: skip
"""Rare lists: their sheets are hidden while empty."""


def _has_values(sheets: FilledSheets, part: tuple[str, ...]) -> bool:
    """True if any field of a part has a value."""
    return any(path[: len(part)] == part for path in sheets.cells)


class TemplateBook:
    """The template workbook."""

    def __init__(self, title: str, compounds: Sequence[str], system: System = "SI") -> None:
        self.system = system
        self.book, self.title, self.rules = Workbook(), title, CellRules(compounds)
        self.book.remove(self.book.worksheets[0])
        self._looks: dict[tuple[bool, bool], Any] = {}

    def draw(self, every: Sequence[FilledSheets]) -> Workbook:
        """Draw all sheets: every form followed by the lists of its part, then the other lists."""
        for sheets in every:
            for drawn in _sheets_in_order(sheets):
                if isinstance(drawn, Form):
                    self._form(drawn, sheets)
                else:
                    self._table(drawn, sheets)
        self._how_to(self.book.worksheets[0], every)
        for sheet in self.book.worksheets:
            set_up_print(sheet, self.title)
        self.rules.draw(self.book)
        return self.book

    # -- forms

    def _form(self, form: Form, sheets: FilledSheets) -> None:
        sheet = self.book.create_sheet(form.name)
        optional = "" if form.required else " May be left empty as a whole."
        _write_title(sheet, form.name, f"{form.doc}{optional}")
        for column, (name, width) in enumerate(_HEADERS.items(), start=1):
            _header_bar(sheet.cell(_HEAD, column), name)
            sheet.column_dimensions[get_column_letter(column)].width = width
        sheet.row_dimensions[_HEAD].height = 20
        row = _HEAD
        if sheets.called:
            row += 1
            doc = "Write this where a compound is to be given."
            told = FormField(key="Referred to by", kind="text", required=True, doc=doc)
            self._field(sheet, row, FormRow((NAME_KEY,), 0, told, certain=True), (sheets.called, None))
        sheet.sheet_properties.outlinePr.summaryBelow = False
        closed: tuple[str, ...] = ()
        for line in form.rows:
            row += 1
            if closed and line.path[: len(closed)] == closed:
                sheet.row_dimensions[row].outlineLevel, sheet.row_dimensions[row].hidden = 1, True
            elif isinstance(line.part, FieldGroup) and not line.part.required and not _has_values(sheets, line.path):
                closed = line.path
            if isinstance(line.part, FieldGroup):
                _draw_heading(sheet, row, line)
            else:
                self._field(sheet, row, line, sheets.cells.get(line.path, (None, None)))
        sheet.freeze_panes = sheet.cell(_HEAD + 1, 2)
        sheet.print_title_rows = f"{_HEAD}:{_HEAD}"
        sheet.print_area = f"A1:{get_column_letter(_PRINTED_COLUMNS)}{row}"

    def _field(self, sheet: Worksheet, row: int, line: FormRow, cells: tuple[Any, str | None]) -> None:
        leaf = line.part
        if not isinstance(leaf, FormField):
            raise TypeError("a heading has no cells")
        leaf = in_system(leaf, self.system, (cells[1],))
        name, value, unit, allowed, default, meaning, key = (sheet.cell(row, c) for c in range(1, 8))
        write_value(name, key_label(leaf.key) + (" *" if leaf.required else ""), BOLD if leaf.required else None)
        name.alignment = Alignment(horizontal="left", indent=1 + line.depth, vertical="top")
        name.comment = _field_note(leaf, ".".join(line.path))
        self._input(value, leaf)
        write_value(value, cells[0])
        if leaf.units:
            self._input(unit, None)
        write_value(unit, cells[1])
        write_value(allowed, allowed_text(leaf))
        write_value(default, default_text(leaf), GREY)
        write_value(meaning, leaf.doc)
        write_value(key, ".".join(line.path), _SMALL)
        for cell in (allowed, default, meaning, key):
            cell.alignment = Alignment(horizontal="left", wrap_text=True, vertical="top", indent=1)
        shown = (
            (allowed_text(leaf), _HEADERS["Allowed"]),
            (leaf.doc, _HEADERS["Meaning"]),
            (str(cells[0] or ""), _HEADERS[VALUE]),
        )
        sheet.row_dimensions[row].height = 15.5 * max(1, *(_line_count(text, width) for text, width in shown))
        self.rules.apply(sheet, leaf, value.coordinate, unit.coordinate)
        if line.certain:
            rule = _missing_rule(f"ISBLANK({value.coordinate})")
            sheet.conditional_formatting.add(value.coordinate, rule)

    # -- lists

    def _table(self, table: ListSheet, sheets: FilledSheets) -> None:
        sheet = self.book.create_sheet(table.name)
        allowed = f" ({table.table.allowed})" if table.table.allowed else ""
        _write_title(sheet, table.name, f"{table.table.doc}{allowed}")
        rows = sheets.items[table.name]
        first = _KEYS + 1
        last = first - 1 + max(len(rows) + _SPARE_ROWS, _LEAST_ROWS)
        fixed = {NUMBER: "No."} | ({PARENT: f"No. in {table.parent}"} if table.parent else {})
        for column, (key, name) in enumerate(fixed.items(), start=1):
            _header_bar(sheet.cell(_HEAD, column), name)
            write_value(sheet.cell(_KEYS, column), key, _SMALL)
            sheet.column_dimensions[get_column_letter(column)].width = 6 if key == NUMBER else 14
            for i in range(first, last + 1):
                item = rows[i - first] if i - first < len(rows) else None
                number = i - first + 1 if key == NUMBER else None if item is None else item.parent
                write_value(sheet.cell(i, column), number, GREY)
        column = len(fixed) + 1
        leader = get_column_letter(column)
        for of in table.columns:
            cells = [row.cells.get(of.path) for row in rows]
            self._column(sheet, of, cells, column=column, last=last)
            if of.certain:
                letter = get_column_letter(column)
                formula = f"AND(NOT(ISBLANK(${leader}{first})),ISBLANK({letter}{first}))"
                rule = _missing_rule(formula)
                sheet.conditional_formatting.add(f"{letter}{first}:{letter}{_LISTED_ROWS}", rule)
            column += 2 if of.leaf.units else 1
        sheet.row_dimensions[_HEAD].height = 31
        sheet.row_dimensions[_HEAD + 1].height, sheet.row_dimensions[_KEYS].height = 46, 24
        sheet.freeze_panes = sheet.cell(first, len(fixed) + 2)
        sheet.print_title_rows = f"{_HEAD}:{_KEYS}"
        sheet.print_title_cols = f"A:{leader}"
        sheet.sheet_state = "hidden" if not rows and table.name in _RARE_SHEETS else "visible"

    def _column(
        self,
        sheet: Worksheet,
        of: FieldColumn,
        cells: list[tuple[Any, str | None] | None],
        *,
        column: int,
        last: int,
    ) -> None:
        first, key = _KEYS + 1, ".".join(of.path)
        leaf = in_system(of.leaf, self.system, (cell[1] for cell in cells if cell is not None))
        default = default_text(leaf)
        about = [*filter(None, (allowed_text(leaf), f"default {default}" if default else ""))]
        head = ": ".join(key_label(word) for word in of.path) + (" *" if leaf.required else "")
        _header_bar(sheet.cell(_HEAD, column), head)
        sheet.cell(_HEAD, column).comment = _field_note(leaf, key)
        _write_key(sheet.cell(_KEYS, column), key)
        write_value(sheet.cell(_HEAD + 1, column), "\n".join(about), GREY)
        sheet.cell(_HEAD + 1, column).alignment = _WRAP_TEXT
        letter, of_unit = get_column_letter(column), get_column_letter(column + 1)
        longest = max((len(str(cell[0])) for cell in cells if cell is not None), default=0)
        sheet.column_dimensions[letter].width = min(60, max(13, longest + 3, len(default) + 10))
        if leaf.units:
            _header_bar(sheet.cell(_HEAD, column + 1), "Unit")
            _write_key(sheet.cell(_KEYS, column + 1), f"{key} {UNIT_OF}")
            sheet.column_dimensions[of_unit].width = 3 + max(7, *map(len, leaf.units))
        usual = next((cell[1] for cell in reversed(cells) if cell is not None), None)
        for i in range(first, last + 1):
            cell = (cells[i - first] if i - first < len(cells) else None) or (None, usual)
            self._input(sheet.cell(i, column), leaf)
            write_value(sheet.cell(i, column), cell[0])
            if leaf.units:
                self._input(sheet.cell(i, column + 1), None)
                write_value(sheet.cell(i, column + 1), cell[1])
        ranges = [f"{name}{first}:{name}{_LISTED_ROWS}" for name in (letter, of_unit)]
        self.rules.apply(sheet, leaf, ranges[0], ranges[1])

    def _input(self, cell: Any, leaf: FormField | None) -> None:
        """Format an input cell, text fields as text; styles are copied, which is ten times faster."""
        is_text = leaf is not None and leaf.kind in {"text", "list", "reference", "json"}
        numeric = leaf is not None and leaf.kind in {"quantity", "number", "count"}
        if (is_text, numeric) in self._looks:
            cell._style = copy(self._looks[is_text, numeric])  # noqa: SLF001 openpyxl's own way to copy a look
            return
        cell.border = _BOX
        if is_text:
            cell.number_format = "@"
        side = "right" if numeric else "left"
        cell.alignment = Alignment(horizontal=side, indent=1, vertical="top", wrap_text=is_text)
        self._looks[is_text, numeric] = copy(cell._style)  # noqa: SLF001

    # -- first sheet

    def _how_to(self, sheet: Worksheet, every: Sequence[FilledSheets]) -> None:
        """Add instructions and links to all sheets below the fields of the first one."""
        write_value(sheet.cell(1, 1), f"{self.title}: input", TITLE)
        row = int(sheet.max_row) + 2
        write_value(sheet.cell(row, 1), "How to fill in", HEADING)
        for text in HOW_TO:
            row += 1
            write_value(sheet.cell(row, 1), text)
        row += 2
        write_value(sheet.cell(row, 1), "Sheets", HEADING)
        docs = {form.name: form.doc for sheets in every for form in sheets.plan.forms}
        docs |= {table.name: table.table.doc for sheets in every for table in sheets.plan.tables}
        for other in self.book.worksheets[1:]:
            row += 1
            shown = other.sheet_state == "visible"
            name = other.title if shown else f"{other.title} (hidden)"
            write_value(sheet.cell(row, 1), name, LINK if shown else GREY)
            if shown:
                sheet.cell(row, 1).hyperlink = Hyperlink(ref=f"A{row}", location=f"'{other.title}'!A1")
            write_value(sheet.cell(row, 4), docs[other.title])
        write_value(sheet.cell(row + 2, 1), f"Template of conveyor {version('conveyor')}", GREY)


def _field_note(leaf: FormField, path: str) -> Comment:
    """Note of a field: key, meaning, range, default."""
    default = default_text(leaf)
    lines = [
        path,
        leaf.doc,
        f"Allowed: {allowed_text(leaf)}" if allowed_text(leaf) else "",
        f"Default: {default}" if default else "",
    ]
    lines.append("Needed." if leaf.required else "")
    text = "\n".join(filter(None, lines))
    return Comment(text, _AUTHOR, height=20 + 17 * sum(_line_count(line, 42) for line in text.split("\n")), width=300)


def _line_count(text: str, width: int) -> int:
    return sum(max(1, -(-len(line) // width)) for line in text.split("\n"))


def _sheets_in_order(sheets: FilledSheets) -> Iterator[Form | ListSheet]:
    """Forms and lists in drawing order: lists after the form of their part, nested lists after their parent."""
    tables = {table.name: table for table in sheets.plan.tables}
    tops = {name: table for name, table in tables.items() if table.parent is None}
    for name, table in tables.items():
        if table.parent is not None:
            tops[name] = tops[table.parent]
    given: set[str] = set()
    for form in sheets.plan.forms:
        yield form
        if form.path or len(sheets.plan.forms) == 1:
            own = [name for name, top in tops.items() if top.path[: len(form.path)] == form.path]
            given.update(own)
            yield from (tables[name] for name in own)
    yield from (table for name, table in tables.items() if name not in given)


def _missing_rule(formula: str) -> Rule:
    """Conditional format of a required cell that is empty."""
    return Rule(type="expression", formula=[formula], dxf=DifferentialStyle(fill=_NEEDED_FILL))


def _write_title(sheet: Worksheet, title: str, doc: str) -> None:
    write_value(sheet.cell(1, 1), title, TITLE)
    write_value(sheet.cell(2, 1), doc, GREY)


def _header_bar(cell: Cell | MergedCell, text: str) -> None:
    write_value(cell, text, _WHITE)
    cell.fill = _BAR
    cell.alignment = Alignment(wrap_text=True, vertical="center", horizontal="left", indent=1)


def _write_key(cell: Cell | MergedCell, key: str) -> None:
    write_value(cell, key, _SMALL)
    cell.alignment = _WRAP_TEXT


def _draw_heading(sheet: Worksheet, row: int, line: FormRow) -> None:
    """Draw the heading of a nested model across the form."""
    doc = line.part.doc if line.part.required else f"{line.part.doc} May be left empty."
    write_value(sheet.cell(row, 1), ": ".join(key_label(key) for key in line.path[-1 - line.depth :]), HEADING)
    sheet.cell(row, 1).alignment = Alignment(horizontal="left", indent=1 + line.depth, vertical="center")
    write_value(sheet.cell(row, 4), doc, GREY)
    sheet.cell(row, 4).alignment = Alignment(horizontal="left", vertical="center", indent=1)
    for column in range(1, len(_HEADERS) + 1):
        sheet.cell(row, column).fill = PALE
    sheet.row_dimensions[row].height = 20
