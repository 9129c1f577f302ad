"""The workbook's first page: verdict, governing figures, data of the conveyor, key figures, charts, checks."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from datetime import date
from typing import Any, Final

from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.files.marks import version
from conveyor.report import charts
from conveyor.report.cells import (
    ACCENT,
    FIGURE,
    GREY,
    HEADING,
    LINK,
    PALE,
    TITLE,
    VERDICTS,
    Look,
    header_row,
    lines_of,
    put,
)
from conveyor.report.columns import CHECKS_AND_NOTES, Figure, ReportHead
from conveyor.report.places import Page, TablePlace
from conveyor.units.presentation import Unit, spelled, unit
from conveyor.units.sentences import DIGITS

_COLUMNS: Final = "ABCDEFG"
_WIDTHS: Final = {"A": 31, "B": 18, "C": 2, "D": 33, "E": 17, "F": 25, "G": 17}
_CHART_ROWS: Final = 14
_CHART_WIDTHS, _CHART_HEIGHT = (11.0, 20.4), 6.4  # [cm]
_RULE: Final = Border(bottom=Side(style="thin", color=ACCENT))
_HAIR: Final = Border(bottom=Side(style="hair", color="A6A6A6"))
_SIGNED: Final = ("engineer", "reviewer", "approval")
_STANDS = Look(
    Font(name="Calibri", size=12, bold=True, color="1E6B34"), PatternFill("solid", fgColor="E2F0E5")
)
_FAILS = Look(
    Font(name="Calibri", size=12, bold=True, color="9B1C1C"), PatternFill("solid", fgColor="FDEBEB")
)
_MOST_CHECKS: Final = 28
"""Rows of checks that fit on the first page."""
_ROW: Final = 15.0  # [pt]
_GAP: Final = 7.0  # [pt]
_LINE: Final = 118
"""Characters of the verdict on one line."""


def summary(page: Page, places: Mapping[str, tuple[Worksheet, TablePlace]]) -> None:
    """Write the first page; `places` has the tables of the other sheets, for the charts."""
    sheet = page.sheet
    for letter, width in _WIDTHS.items():
        sheet.column_dimensions[letter].width = width
    row = _verdict(page, _head(sheet, page.contents.document))
    row = _governing(page, row)
    row = _facts(page, row)
    row = _tiles(page, row)
    row = _pictures(page, row, places)
    row = _checked(page, row)
    hidden = [each.title for each in sheet.parent or () if each.sheet_state == "hidden"]
    if hidden:
        put(sheet.cell(row, 1), f"Hidden data sheets (right-click a tab, Unhide): {', '.join(hidden)}", GREY)
    sheet.page_setup.fitToHeight = 1
    sheet.print_options.horizontalCentered = True


def _rule(sheet: Worksheet, row: int, words: str, column: int = 1, last: int = 7) -> None:
    """Write a heading with a rule across columns."""
    put(sheet.cell(row, column), words, HEADING)
    for j in range(column, last + 1):
        sheet.cell(row, j).border = _RULE


def _gap(sheet: Worksheet, row: int) -> int:
    sheet.row_dimensions[row].height = _GAP
    return row + 1


def _head(sheet: Worksheet, about: ReportHead) -> int:
    """Write title and document block, with names or room to sign; return the next row."""
    put(sheet["A1"], about.title, TITLE)
    sheet.row_dimensions[1].height = 24.0
    made = f"conveyor {version('conveyor')}, spec {about.fingerprint[:16]}"
    put(sheet["A2"], f"Power and tensions of a belt conveyor; {made}", GREY)
    facts: list[tuple[str, Any]] = [(n, v) for n, v in about.said.items() if n not in _SIGNED]
    facts += [("date", date.today()), *((name, about.said.get(name)) for name in _SIGNED)]
    row = 3
    for k, (name, value) in enumerate(facts):
        row, column = 3 + k // 2, 1 + 3 * (k % 2)
        put(sheet.cell(row, column), name, GREY)
        put(sheet.cell(row, column + 1), value)
        sheet.cell(row, column + 1).alignment = Alignment(horizontal="left")
        if name in _SIGNED:
            for j in range(column + 1, 3 if column == 1 else 7):
                sheet.cell(row, j).border = _HAIR
    return _gap(sheet, row + 1)


def _across(sheet: Worksheet, row: int, words: str) -> None:
    """Write text across the page, wrapped."""
    put(sheet.cell(row, 1), words)
    sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=len(_COLUMNS))
    sheet.cell(row, 1).alignment = Alignment(wrap_text=True, vertical="center", indent=1)
    sheet.row_dimensions[row].height = (_ROW + 1.5) * (1 + len(words) // _LINE)


def _verdict(page: Page, row: int) -> int:
    """Write the verdict, green or red; return the next row."""
    _across(page.sheet, row, page.contents["governing_figures"].note)
    failed = any(check.verdict == "FAIL" for check in page.contents["checks"].rows)
    cell, look = page.sheet.cell(row, 1), _FAILS if failed else _STANDS
    cell.font, cell.fill = look.font, look.fill
    return _gap(page.sheet, row + 1)


def _governing(page: Page, row: int) -> int:
    """Write the governing figures; return the next row."""
    sheet, part = page.sheet, page.contents["governing_figures"]
    _rule(sheet, row, part.heading)
    for i, line in enumerate(part.rows, start=row + 1):
        put(sheet.cell(i, 1), line.subject)
        put(sheet.cell(i, 2), line.value)
        put(sheet.cell(i, 4), line.where, GREY)
        for j in range(1, 8):
            sheet.cell(i, j).border = _HAIR
            sheet.cell(i, j).alignment = Alignment(horizontal="left")
    return _gap(sheet, row + 1 + len(part.rows))


def _facts(page: Page, row: int) -> int:
    """Write the data of the conveyor, figures left, text right; return the next row."""
    sheet, system, rows = page.sheet, page.contents.system, page.contents["identity"].rows
    _rule(sheet, row, page.contents["identity"].heading)
    sides = [[r for r in rows if r.kind != "text"], [r for r in rows if r.kind == "text"]]
    for column, figures in zip((1, 4), sides, strict=True):
        for i, figure in enumerate(figures, start=row + 1):
            written = figure.unit(system)
            put(sheet.cell(i, column), spelled(figure.called(system), figure.kind, system))
            put(sheet.cell(i, column + 1), *_three(figure, written))
            for j in range(column, 3 if column == 1 else 8):
                sheet.cell(i, j).border = _HAIR
            if figure.kind == "text":
                sheet.cell(i, column + 1).alignment = Alignment(horizontal="left")
    return _gap(sheet, row + 1 + max(map(len, sides)))


def _three(figure: Figure, written: Unit, font: Any = None) -> tuple[Any, Any, str | None]:
    """Value rounded to significant digits, font and number format."""
    value = written.shown(figure.value)
    if not isinstance(value, float) or written.digits.endswith("%"):
        return value, font, None if isinstance(value, str) else written.pattern
    digits = DIGITS if figure.on else DIGITS + 1
    short = float(f"{value:.{digits}g}")
    decimals = max(0, len(f"{short:.9f}".rstrip("0").partition(".")[2]))
    return short, font, "#,##0" + ("." + "0" * decimals if decimals else "")


def _tiles(page: Page, row: int) -> int:
    """Write the key figures, large; return the next row."""
    sheet, system = page.sheet, page.contents.system
    for letter in _COLUMNS:
        sheet[f"{letter}{row}"].fill = sheet[f"{letter}{row + 1}"].fill = PALE
    for letter, figure in zip("ABDEFG", page.contents.marked("large"), strict=False):
        caption, cell = sheet[f"{letter}{row}"], sheet[f"{letter}{row + 1}"]
        written = unit(figure.kind, system, large=True)
        name = figure.called(system).replace(" of main resistance", "")
        put(caption, f"as given: {written.beside(name) if written.sign else name}", GREY)
        put(cell, *_three(figure, written, FIGURE))
        caption.alignment = Alignment(horizontal="left", vertical="center", indent=1, wrap_text=True)
        cell.alignment = Alignment(horizontal="left", vertical="center", indent=1)
    sheet.row_dimensions[row].height, sheet.row_dimensions[row + 1].height = 42.0, 26.0
    row += 2
    if "defaults" in page.contents:
        _across(sheet, row, page.contents["defaults"].note)
        row += 1
    return _gap(sheet, row)


def _pictures(page: Page, row: int, places: Mapping[str, tuple[Worksheet, TablePlace]]) -> int:
    """Add charts of resistances and profile; return the next row."""
    made: list[Any] = []
    if "breakdown" in places:
        of, place = places["breakdown"]
        rows, at = (place.header, place.last), place.first_column
        made.append(charts.bars(of, "Resistances as given", rows, label=at, value=place.column("force")))
        charts.forces(made[-1].y_axis, "force", page.contents.system)
    if "profile" in places:
        of, place = places["profile"]
        made.append(charts.profile(of, place, page.contents.system))
    for chart, letter, width in zip(made, "AD", _CHART_WIDTHS, strict=False):
        charts.sized(chart, width, _CHART_HEIGHT)
        page.sheet.add_chart(chart, f"{letter}{row}")
    return _gap(page.sheet, row + (_CHART_ROWS if made else 0))


def _margin(check: Any) -> float:
    """Margin of a check; infinite where it has none."""
    return math.inf if check.margin is None else check.margin


def _checked(page: Page, row: int) -> int:
    """Write the governing checks and all failures, with links to the rest; return the next row.

    If there is no room for all, those that pass by the widest margin are left out.
    """
    sheet, checks, system = page.sheet, page.contents["checks"].rows, page.contents.system
    count = Counter(check.verdict for check in checks)
    counted = ", ".join(f"{count[word]} {word}" for word in ("pass", "FAIL", "not checked") if count[word])
    _rule(sheet, row, f"Checks: {counted}")
    header_row(sheet, row + 1, 1, ("check", "", "", "calculated, required", "margin", "case", "verdict"))
    sheet.cell(row + 1, 5).alignment = Alignment(horizontal="right", vertical="center")
    written = unit("margin", system)
    leading = [check for check in checks if check.leads or check.verdict == "FAIL"]
    safe = sorted((check for check in leading if check.verdict == "pass"), key=_margin)
    left = safe[len(safe) - max(0, len(leading) - _MOST_CHECKS) :]
    shown = [check for check in leading if check not in left]
    i = row + 1
    for i, check in enumerate(shown, start=row + 2):
        text = f"{check.found}, {check.asked}"
        put(sheet.cell(i, 1), check.subject)
        sheet.merged_cells.add(f"A{i}:C{i}")
        put(sheet.cell(i, 4), text)
        put(sheet.cell(i, 5), written.shown(check.margin), None, written.pattern)
        put(sheet.cell(i, 6), check.case)
        put(sheet.cell(i, 7), check.verdict)
        for j in (1, 4, 6):
            sheet.cell(i, j).alignment = Alignment(
                indent=1, horizontal="left", vertical="top", wrap_text=j != 1, shrink_to_fit=j == 1
            )
        sheet.cell(i, 5).alignment = Alignment(horizontal="right", vertical="top")
        lines = max(lines_of(text, _WIDTHS["D"] - 1), lines_of(check.case, _WIDTHS["F"] - 1))
        sheet.row_dimensions[i].height = _ROW * lines
        _coloured(sheet, i, VERDICTS[check.verdict])
    if len(shown) < len(checks):
        i += 1
        which = "the least margins" if left else "of every criterion the least margin"
        words = f"{which}; all {len(checks)} checks: see {CHECKS_AND_NOTES}"
        put(sheet.cell(i, 1), words, GREY)
    kinds = ("warning", "assumption")
    said = ", ".join(f"{len(page.contents.lines(kind))} {kind}s" for kind in kinds)
    link = sheet.cell(i + 1, 1)
    put(link, f"{said}: see {CHECKS_AND_NOTES}")
    link.hyperlink = Hyperlink(ref=link.coordinate, location=f"'{CHECKS_AND_NOTES}'!A1")
    link.font = LINK
    return i + 2


def _coloured(sheet: Worksheet, row: int, look: Look) -> None:
    verdict = sheet.cell(row, 7)
    verdict.font, verdict.fill = look.font, look.fill
    verdict.alignment = Alignment(horizontal="center", vertical="top")
    for j in range(1, 8):
        sheet.cell(row, j).border = _HAIR
