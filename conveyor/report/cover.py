"""The workbook's cover: one printed page of what a conveyor is, what it needs, and what it was checked for."""

from __future__ import annotations

from collections import Counter
from datetime import date
from importlib.metadata import version
from typing import Any, Final

from openpyxl.styles import Alignment, Border, Side
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report import charts
from conveyor.report.cells import (
    ACCENT,
    BOLD,
    FIGURE,
    GREY,
    HEADING,
    LINK,
    PALE,
    TITLE,
    VERDICTS,
    Look,
    header_row,
    put,
    table,
)
from conveyor.report.columns import CHECKS_AND_NOTES, Figure, ReportHead, Table
from conveyor.report.places import Page
from conveyor.units.presentation import headed, unit

_COLUMNS: Final = "ABCDEFG"
_WIDTHS: Final = {"A": 31, "B": 15, "C": 2, "D": 35, "E": 17, "F": 19, "G": 17}
_FIRST: Final = ("power", "force")
"""Kinds of figures in their order below "Tensions and power"; others follow."""
_CHART_ROWS: Final = 14
_HALF, _WHOLE_WIDTH, _CHART_HEIGHT = 9.2, 26.0, 7.2  # [cm]
_SMALL, _LARGE = 10.0, 1e4  # below, one decimal is too few; beyond, a figure in large type needs none
_RULE: Final = Border(bottom=Side(style="thin", color=ACCENT))
_HAIR: Final = Border(bottom=Side(style="hair", color="A6A6A6"))
_ROW: Final = 15.0  # [pt]
_GAP: Final = 7.0  # [pt]


def summary(page: Page) -> None:
    """Head, what the conveyor is, key figures, tensions and power, breakdown, governing cases, checks."""
    sheet = page.sheet
    for letter, width in _WIDTHS.items():
        sheet.column_dimensions[letter].width = width
    row = _head(sheet, page.contents.document)
    row = _facts(page, row)
    row = _left_open(page, _tiles(page, row))
    row = _figures(page, row)
    row = _picture(page, row)
    _checked(page, row)
    sheet.page_setup.fitToHeight = 1
    sheet.print_options.horizontalCentered = True


def _rule(sheet: Worksheet, row: int, words: str, column: int = 1, last: int = 7) -> None:
    """Heading over a line across columns."""
    put(sheet.cell(row, column), words, HEADING)
    for j in range(column, last + 1):
        sheet.cell(row, j).border = _RULE


def _gap(sheet: Worksheet, row: int) -> int:
    sheet.row_dimensions[row].height = _GAP
    return row + 1


def _head(sheet: Worksheet, about: ReportHead) -> int:
    put(sheet["A1"], about.title, TITLE)
    sheet.row_dimensions[1].height = 24.0
    made = f"conveyor {version('conveyor')}, spec {about.fingerprint[:16]}"
    put(sheet["A2"], f"Power and tensions of a belt conveyor; {made}", GREY)
    row = 3
    facts: list[tuple[str, Any]] = [*about.said.items(), ("date", date.today())]
    for k, (name, value) in enumerate(facts):
        row, column = 3 + k // 2, 1 + 3 * (k % 2)
        put(sheet.cell(row, column), name, GREY)
        put(sheet.cell(row, column + 1), value)
        sheet.cell(row, column + 1).alignment = Alignment(horizontal="left")
    return _gap(sheet, row + 1)


def _facts(page: Page, row: int) -> int:
    """What the conveyor is: figures on the left, words on the right."""
    sheet, system, rows = page.sheet, page.contents.system, page.contents["identity"].rows
    _rule(sheet, row, page.contents["identity"].heading)
    sides = [[r for r in rows if r.kind != "text"], [r for r in rows if r.kind == "text"]]
    for column, figures in zip((1, 4), sides, strict=True):
        for i, figure in enumerate(figures, start=row + 1):
            written = figure.unit(system)
            shown = headed(figure.called(system), figure.kind, system), written.shown(figure.value)
            _line(sheet, (i, column), *shown, written.pattern)
    return _gap(sheet, row + 1 + max(map(len, sides)))


def _line(
    sheet: Worksheet, place: tuple[int, int], label: str, value: float | str, shown: str | None = None
) -> None:
    """One fact: its name and its value, over a thin line."""
    row, column = place
    put(sheet.cell(row, column), label)
    put(sheet.cell(row, column + 1), value, None, shown)
    if isinstance(value, str):
        sheet.cell(row, column + 1).alignment = Alignment(horizontal="left", shrink_to_fit=False)
    for j in range(column, 3 if column == 1 else 8):
        sheet.cell(row, j).border = _HAIR


def _tiles(page: Page, row: int) -> int:
    """Key figures, large, each under its name."""
    sheet, system = page.sheet, page.contents.system
    for letter in _COLUMNS:
        sheet[f"{letter}{row}"].fill = sheet[f"{letter}{row + 1}"].fill = PALE
    for letter, figure in zip("ABDEFG", page.contents.marked("large"), strict=False):
        caption, cell = sheet[f"{letter}{row}"], sheet[f"{letter}{row + 1}"]
        put(
            caption,
            headed(figure.called(system).replace(" of main resistance", ""), figure.kind, system),
            GREY,
        )
        put(cell, *_shown(figure, page, FIGURE, large="#,##0"))
        caption.alignment = Alignment(horizontal="left", vertical="center", indent=1, wrap_text=True)
        cell.alignment = Alignment(horizontal="left", vertical="center", indent=1)
    sheet.row_dimensions[row].height, sheet.row_dimensions[row + 1].height = 31.0, 26.0
    return _gap(sheet, row + 2)


def _left_open(page: Page, row: int) -> int:
    """The range of power that defaults leave open, and which to replace first."""
    if "defaults" not in page.contents:
        return row
    put(page.sheet.cell(row, 1), page.contents["defaults"].note)
    page.sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=len(_COLUMNS))
    page.sheet.cell(row, 1).alignment = Alignment(wrap_text=True, vertical="center")
    page.sheet.row_dimensions[row].height = 2.0 * _ROW
    return _gap(page.sheet, row + 1)


def _shown(figure: Figure, page: Page, font: Any = None, *, large: str = "#,##0.0") -> tuple[Any, Any, str]:
    """Value, font and number format of a figure; small ones with more digits, large ones with as many as asked for."""
    written = figure.unit(page.contents.system)
    value, pattern = written.shown(figure.value), written.pattern
    if pattern == "#,##0.0":
        pattern = large if abs(value) >= _LARGE else "0.000" if abs(value) < _SMALL else pattern
    return value, font, pattern


def _figures(page: Page, row: int) -> int:
    """Tensions and power on the left; breakdown and the classical estimate on the right."""
    sheet, contents = page.sheet, page.contents
    _rule(sheet, row, "Tensions and power", 1, 2)
    rank = {kind: i for i, kind in enumerate(_FIRST)}
    ordered = sorted(contents.marked("cover"), key=lambda figure: rank.get(figure.kind, len(rank)))
    i = row
    for i, figure in enumerate(ordered, start=row + 1):
        label = (
            f"take-up {figure.label}" if figure.key.startswith("take_up") else figure.called(contents.system)
        )
        value, _, pattern = _shown(figure, page)
        name = headed(label.replace(" of the contacts", ""), figure.kind, contents.system)
        _line(sheet, (i, 1), name, value, pattern)
        if i == row + 1:
            sheet.cell(i, 1).font = sheet.cell(i, 2).font = BOLD
    _rule(sheet, row, "Resistances", 4)
    last = _placed(page, "breakdown", row + 1)
    part = contents["classical"]
    put(sheet.cell(last + 1, 4), "Beside the classical estimate", BOLD)
    last = _placed(page, "classical", last + 2)
    put(sheet.cell(last + 1, 4), part.note, GREY)
    return _gap(sheet, max(i, last + 1) + 1)


def _placed(page: Page, key: str, row: int) -> int:
    last = table(page.sheet, page.contents[key].on_sheet(), page.contents.system, row, 4)
    page.sheet.row_dimensions[row].height = _ROW
    return last


def _picture(page: Page, row: int) -> int:
    """The breakdown as a chart; beside it the cases that govern, where there are any."""
    sheet, cases = page.sheet, page.contents.by_key.get("governing_cases")
    breakdown = page.contents["breakdown"]
    label = breakdown.name(breakdown.columns[0], page.contents.system)
    first = next(i for i in range(1, row) if sheet.cell(i, 4).value == label)
    rows = first, first + len(breakdown.rows)
    chart = charts.bars(sheet, "Resistance breakdown", rows, label=4, value=4 + breakdown.index("force"))
    charts.sized(chart, _WHOLE_WIDTH if cases is None else _HALF, _CHART_HEIGHT)
    sheet.add_chart(chart, f"A{row}")
    end = row + _CHART_ROWS
    if cases is not None:
        _governing(page, cases, row)
        end = max(end, row + 2 + len(cases.rows))
    return _gap(sheet, end)


def _governing(page: Page, cases: Table, row: int) -> None:
    sheet, system = page.sheet, page.contents.system
    _rule(sheet, row, "Governing load cases", 4)
    header_row(sheet, row + 1, 4, ("figure", "value", "case", "at"))
    sheet.cell(row + 1, 5).alignment = Alignment(horizontal="right", vertical="center")
    columns = {column.key: column.get for column in cases.columns}
    for i, figure in enumerate(cases.rows, start=row + 2):
        written = figure.unit(system)
        put(sheet.cell(i, 4), headed(figure.called(system), figure.kind, system))
        sheet.cell(i, 4).alignment = Alignment(indent=1, shrink_to_fit=True)
        put(sheet.cell(i, 5), written.shown(columns["value"](figure)), None, written.pattern)
        put(sheet.cell(i, 6), columns["case"](figure))
        put(sheet.cell(i, 7), unit("temperature", system).brief(columns["temperature"](figure)))
        for j in (6, 7):  # indents hold only where the side is named
            sheet.cell(i, j).alignment = Alignment(horizontal="left", indent=1, shrink_to_fit=True)
        for j in range(4, 8):
            sheet.cell(i, j).border = _HAIR


def _checked(page: Page, row: int) -> None:
    """Of every criterion the check that governs, and all that failed; the way to the others and to the warnings."""
    sheet, checks, system = page.sheet, page.contents["checks"].rows, page.contents.system
    count = Counter(check.verdict for check in checks)
    counted = ", ".join(f"{count[word]} {word}" for word in ("pass", "FAIL", "not checked") if count[word])
    _rule(sheet, row, f"Checks: {counted}")
    header_row(sheet, row + 1, 1, ("check", "", "", "found, asked for", "margin", "case", "verdict"))
    sheet.cell(row + 1, 5).alignment = Alignment(horizontal="right", vertical="center")
    written = unit("share", system)
    shown = [check for check in checks if check.leads or check.verdict == "FAIL"]
    i = row + 1
    for i, check in enumerate(shown, start=row + 2):
        put(sheet.cell(i, 1), check.subject)
        sheet.merged_cells.add(f"A{i}:C{i}")
        put(sheet.cell(i, 4), f"{check.found}, {check.asked}")
        put(sheet.cell(i, 5), written.shown(check.margin), None, written.pattern)
        put(sheet.cell(i, 6), check.case)
        put(sheet.cell(i, 7), check.verdict)
        for j in (1, 4, 6):
            sheet.cell(i, j).alignment = Alignment(
                indent=0 if j == 1 else 1, horizontal="left", shrink_to_fit=True
            )
        _coloured(sheet, i, VERDICTS[check.verdict])
    if len(shown) < len(checks):
        i += 1
        words = f"of every criterion the least margin; all {len(checks)} checks: see {CHECKS_AND_NOTES}"
        put(sheet.cell(i, 1), words, GREY)
    kinds = ("warning", "assumption")
    said = ", ".join(f"{len(page.contents.lines(kind))} {kind}s" for kind in kinds)
    link = sheet.cell(i + 1, 1)
    put(link, f"{said}: see {CHECKS_AND_NOTES}")
    link.hyperlink = Hyperlink(ref=link.coordinate, location=f"'{CHECKS_AND_NOTES}'!A1")
    link.font = LINK


def _coloured(sheet: Worksheet, row: int, look: Look) -> None:
    verdict = sheet.cell(row, 7)
    verdict.font, verdict.fill = look.font, look.fill
    verdict.alignment = Alignment(horizontal="center")
    for j in range(1, 8):
        sheet.cell(row, j).border = _HAIR
