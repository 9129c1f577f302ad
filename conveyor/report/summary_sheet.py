"""The workbook's first page: verdict, governing figures, data of the conveyor, key figures, charts, checks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from datetime import date
from typing import Any, Final

from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.files.output_marks import package_version
from conveyor.report import charts
from conveyor.report.cells import (
    ACCENT,
    FIGURE,
    GREY,
    HEADING,
    LINK,
    PALE,
    TITLE,
    VERDICT_STYLES,
    CellStyle,
    header_row,
    line_count,
    write_value,
)
from conveyor.report.sheet_paper import columns_width, page_room, rows_height
from conveyor.report.sheet_writer import SheetWriter, TablePlace
from conveyor.report.table_model import CHECKS_AND_NOTES, Figure, ReportHead
from conveyor.units.presentation import DIGITS, Unit, display_unit, label_for_people

_COLUMNS: Final = "ABCDEFG"
_LARGE_COLUMNS: Final = "ABDEFG"
"""Columns of the large figures."""
_WIDTHS: Final = {"A": 29, "B": 17, "C": 2, "D": 33, "E": 13, "F": 25, "G": 13}
_CHART_ROWS: Final = 14
_CHART_WIDTHS, _CHART_HEIGHT = (9.0, 15.4), 6.4  # [cm]
_RULE: Final = Border(bottom=Side(style="thin", color=ACCENT))
_HAIR: Final = Border(bottom=Side(style="hair", color="A6A6A6"))
_SIGNATURES: Final = ("engineer", "reviewer", "approval")
_ADEQUATE = CellStyle(Font(name="Calibri", size=12, bold=True, color="1E6B34"), PatternFill("solid", fgColor="E2F0E5"))
_INADEQUATE = CellStyle(
    Font(name="Calibri", size=12, bold=True, color="9B1C1C"), PatternFill("solid", fgColor="FDEBEB")
)
_ROW_HEIGHT: Final = 15.0  # [pt]
_GAP_HEIGHT: Final = 7.0  # [pt]


def write_summary(page: SheetWriter, places: Mapping[str, tuple[Worksheet, TablePlace]]) -> None:
    """Write the first page; `places` has the tables of the other sheets, for the charts and the link to the checks."""
    sheet = page.sheet
    for letter, width in _WIDTHS.items():
        sheet.column_dimensions[letter].width = width
    row = _verdict_row(page, _document_block(page, page.contents.document))
    row = _governing_rows(page, row)
    row = _identity_rows(page, row)
    row = _key_figures(page, row)
    row = _summary_charts(page, row, places)
    first = row
    row = _check_rows(page, row, places["checks"][0].title)
    hidden = [each.title for each in sheet.parent or () if each.sheet_state == "hidden"]
    if hidden:
        said = page.said("Hidden data sheets (right-click a tab, Unhide)")
        write_value(sheet.cell(row, 1), f"{said}: {', '.join(hidden)}", GREY)
    if rows_height(sheet, range(1, row + 1)) > page_room(page.contents.document.paper, portrait=True)[1]:
        sheet.row_breaks.append(Break(id=first - 1))
    sheet.print_options.horizontalCentered = True


def _ruled_heading(sheet: Worksheet, row: int, words: str) -> None:
    """Write a heading with a rule across columns."""
    write_value(sheet.cell(row, 1), words, HEADING)
    for j in range(1, 8):
        sheet.cell(row, j).border = _RULE


def _blank_row(sheet: Worksheet, row: int) -> int:
    sheet.row_dimensions[row].height = _GAP_HEIGHT
    return row + 1


def _document_block(page: SheetWriter, about: ReportHead) -> int:
    """Write title and document block, with names or room to sign; return the next row."""
    sheet = page.sheet
    write_value(sheet["A1"], about.title, TITLE)
    sheet.row_dimensions[1].height = 24.0
    made = f"conveyor {package_version('conveyor')}, spec {about.fingerprint[:16]}"
    page.write(2, 1, f"Power and tensions of a belt conveyor; {made}", GREY)
    facts: list[tuple[str, Any]] = [(n, v) for n, v in about.said.items() if n not in _SIGNATURES]
    facts += [("date", date.today()), *((name, about.said.get(name)) for name in _SIGNATURES)]
    row = 3
    for k, (name, value) in enumerate(facts):
        row, column = 3 + k // 2, 1 + 3 * (k % 2)
        page.write(row, column, name, GREY)
        write_value(sheet.cell(row, column + 1), value)
        sheet.cell(row, column + 1).alignment = Alignment(horizontal="left")
        if name in _SIGNATURES:
            for j in range(column + 1, 3 if column == 1 else 7):
                sheet.cell(row, j).border = _HAIR
    return _blank_row(sheet, row + 1)


def _write_across(sheet: Worksheet, row: int, words: str) -> None:
    """Write text across the page, wrapped."""
    write_value(sheet.cell(row, 1), words)
    sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=len(_COLUMNS))
    sheet.cell(row, 1).alignment = Alignment(wrap_text=True, vertical="center", indent=1)
    lines = line_count(words, columns_width(sheet, range(1, len(_COLUMNS) + 1)))
    sheet.row_dimensions[row].height = (_ROW_HEIGHT + 1.5) * lines


def _verdict_row(page: SheetWriter, row: int) -> int:
    """Write the verdict, green or red; return the next row."""
    _write_across(page.sheet, row, page.said(page.contents["governing_figures"].note))
    failed = any(check.verdict == "FAIL" for check in page.contents["checks"].rows)
    cell, look = page.sheet.cell(row, 1), _INADEQUATE if failed else _ADEQUATE
    cell.font, cell.fill = look.font, look.fill
    return _blank_row(page.sheet, row + 1)


def _governing_rows(page: SheetWriter, row: int) -> int:
    """Write the governing figures; return the next row."""
    sheet, part = page.sheet, page.contents["governing_figures"]
    _ruled_heading(sheet, row, page.headed(part.heading))
    for i, line in enumerate(part.rows, start=row + 1):
        where = page.said(line.where)
        page.write(i, 1, line.subject)
        page.write(i, 2, line.value)
        write_value(sheet.cell(i, 4), where, GREY)
        for j in range(1, 8):
            sheet.cell(i, j).border = _HAIR
            sheet.cell(i, j).alignment = Alignment(horizontal="left", vertical="top", wrap_text=j == 4)
        sheet.merge_cells(start_row=i, start_column=4, end_row=i, end_column=len(_COLUMNS))
        sheet.row_dimensions[i].height = _ROW_HEIGHT * line_count(where, columns_width(sheet, range(4, 8)))
    return _blank_row(sheet, row + 1 + len(part.rows))


def _identity_rows(page: SheetWriter, row: int) -> int:
    """Write the data of the conveyor, figures left, text right; return the next row."""
    sheet, system, rows = page.sheet, page.contents.system, page.contents["identity"].rows
    _ruled_heading(sheet, row, page.headed(page.contents["identity"].heading))
    sides = [[r for r in rows if r.kind != "text"], [r for r in rows if r.kind == "text"]]
    for column, figures in zip((1, 4), sides, strict=True):
        for i, figure in enumerate(figures, start=row + 1):
            written = figure.unit(system)
            name = page.headed(figure.called(system))
            value, *look = _value_font_format(figure, written)
            write_value(sheet.cell(i, column), label_for_people(name, figure.kind, system))
            write_value(sheet.cell(i, column + 1), page.said(value) if isinstance(value, str) else value, *look)
            for j in range(column, 3 if column == 1 else 8):
                sheet.cell(i, j).border = _HAIR
            if figure.kind == "text":
                sheet.cell(i, column + 1).alignment = Alignment(horizontal="left")
    return _blank_row(sheet, row + 1 + max(map(len, sides)))


def _value_font_format(figure: Figure, written: Unit, font: Any = None) -> tuple[Any, Any, str | None]:
    """Value rounded to significant digits, font and number format."""
    value = written.shown(figure.value)
    if not isinstance(value, float) or written.digits.endswith("%"):
        return value, font, None if isinstance(value, str) else written.pattern
    digits = DIGITS if figure.on else DIGITS + 1
    short = float(f"{value:.{digits}g}")
    decimals = max(0, len(f"{short:.9f}".rstrip("0").partition(".")[2]))
    return short, font, "#,##0" + ("." + "0" * decimals if decimals else "")


def _key_figures(page: SheetWriter, row: int) -> int:
    """Write the key figures, large, six a row; return the next row."""
    sheet, system = page.sheet, page.contents.system
    large = page.contents.figures_for("large")
    for start in range(0, len(large), len(_LARGE_COLUMNS)):
        for letter in _COLUMNS:
            sheet[f"{letter}{row}"].fill = sheet[f"{letter}{row + 1}"].fill = PALE
        for letter, figure in zip(_LARGE_COLUMNS, large[start:], strict=False):
            caption, cell = sheet[f"{letter}{row}"], sheet[f"{letter}{row + 1}"]
            written = display_unit(figure.kind, system, large=True)
            name = figure.called(system).replace(" of main resistance", "")
            write_value(caption, page.said(f"as given: {written.beside(name) if written.sign else name}"), GREY)
            write_value(cell, *_value_font_format(figure, written, FIGURE))
            caption.alignment = Alignment(horizontal="left", vertical="center", indent=1, wrap_text=True)
            cell.alignment = Alignment(horizontal="left", vertical="center", indent=1)
        sheet.row_dimensions[row].height, sheet.row_dimensions[row + 1].height = 42.0, 26.0
        row += 2
    if "defaults" in page.contents:
        _write_across(sheet, row, page.said(page.contents["defaults"].note))
        row += 1
    return _blank_row(sheet, row)


def _summary_charts(page: SheetWriter, row: int, places: Mapping[str, tuple[Worksheet, TablePlace]]) -> int:
    """Add charts of resistances and profile; return the next row."""
    made: list[Any] = []
    if "breakdown" in places:
        of, place = places["breakdown"]
        rows, at = (place.header, place.last), place.first_column
        title = page.said("Resistances as given")
        made.append(charts.bar_chart(of, title, rows, label=at, value=place.column("force")))
        charts.force_axis(made[-1].y_axis, page.said("force"), page.contents.system)
    if "profile" in places:
        of, place = places["profile"]
        made.append(charts.profile_chart(of, place, page.contents.system, said=page.said))
    for chart, letter, width in zip(made, "AD", _CHART_WIDTHS, strict=False):
        charts.resize_chart(chart, width, _CHART_HEIGHT)
        page.sheet.add_chart(chart, f"{letter}{row}")
    return _blank_row(page.sheet, row + (_CHART_ROWS if made else 0))


def _check_rows(page: SheetWriter, row: int, checks_sheet: str) -> int:
    """Write the governing checks and all failures, with links to the rest; return the next row."""
    sheet, checks, system = page.sheet, page.contents["checks"].rows, page.contents.system
    count = Counter(check.verdict for check in checks)
    counted = ", ".join(f"{count[word]} {word}" for word in ("pass", "FAIL", "not checked") if count[word])
    _ruled_heading(sheet, row, page.said(f"Checks: {counted}"))
    names = "check", "", "", "calculated, required", "margin", "case", "verdict"
    header_row(sheet, row + 1, 1, map(page.said, names))
    sheet.cell(row + 1, 5).alignment = Alignment(horizontal="right", vertical="center")
    written = display_unit("margin", system)
    shown = [check for check in checks if check.leads or check.verdict == "FAIL"]
    i = row + 1
    for i, check in enumerate(shown, start=row + 2):
        text, case = f"{page.said(check.found)}, {page.said(check.asked)}", page.said(check.case)
        page.write(i, 1, check.subject)
        sheet.merged_cells.add(f"A{i}:C{i}")
        write_value(sheet.cell(i, 4), text)
        write_value(sheet.cell(i, 5), written.shown(check.margin), None, written.pattern)
        write_value(sheet.cell(i, 6), case)
        page.write(i, 7, check.verdict)
        for j in (1, 4, 6):
            sheet.cell(i, j).alignment = Alignment(
                indent=1, horizontal="left", vertical="top", wrap_text=j != 1, shrink_to_fit=j == 1
            )
        sheet.cell(i, 5).alignment = Alignment(horizontal="right", vertical="top")
        lines = max(line_count(text, _WIDTHS["D"] - 1), line_count(case, _WIDTHS["F"] - 1))
        sheet.row_dimensions[i].height = _ROW_HEIGHT * lines
        _style_check_row(sheet, i, VERDICT_STYLES[check.verdict])
    if len(shown) < len(checks):
        i += 1
        words = f"smallest margin of each criterion; all {len(checks)} checks: see {CHECKS_AND_NOTES}"
        page.write(i, 1, words, GREY)
    kinds = ("warning", "assumption")
    said = ", ".join(f"{len(page.contents.lines(kind))} {kind}s" for kind in kinds)
    link = sheet.cell(i + 1, 1)
    write_value(link, page.said(f"{said}: see {CHECKS_AND_NOTES}"))
    link.hyperlink = Hyperlink(ref=link.coordinate, location=f"'{checks_sheet}'!A1")
    link.font = LINK
    return i + 2


def _style_check_row(sheet: Worksheet, row: int, look: CellStyle) -> None:
    verdict = sheet.cell(row, 7)
    verdict.font, verdict.fill = look.font, look.fill
    verdict.alignment = Alignment(horizontal="center", vertical="top")
    for j in range(1, 8):
        sheet.cell(row, j).border = _HAIR
