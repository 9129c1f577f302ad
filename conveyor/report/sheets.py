"""Layouts of the sheets of workbooks, one function each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import date
from itertools import pairwise

from openpyxl.styles import Alignment
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.files.output_marks import package_version
from conveyor.report import charts
from conveyor.report.cells import GREY, HEADING, TITLE, VERDICT_STYLES, line_count, write_value
from conveyor.report.merged_notes import NOTE_HEADINGS, sort_notes
from conveyor.report.sheet_paper import CHART_ROWS, TEXT_WIDTH, columns_of_text, columns_width, paragraph_width
from conveyor.report.sheet_writer import SheetWriter, define_name
from conveyor.report.table_model import FAILS
from conveyor.units.presentation import display_unit

_RUBBER_COLUMNS = (23.0, 24.0, 13.0, 13.0, 14.0, 15.0, 15.0, 11.0, 12.0, 12.0, 14.0, 12.0)
"""Widths of the printed columns [characters]: with them the table of the rubber is as wide as a page across."""
_NARROW_CHART = 12.0  # width of a chart on a page held upright [cm]
_ONE_PAGE_ROWS = 40  # rows beyond which a table to fill in goes on on new sheets of paper
_MOST_BARS = 24
"""Maximum number of bars of a chart."""
_CELL_CHARACTERS = 1000  # characters of a note in one cell


def stacked_sheet(page: SheetWriter, widest: int = 56) -> None:
    """All tables stacked; text wraps at `widest` [characters]."""
    page.rest(widest=widest)


def narrow_sheet(page: SheetWriter) -> None:
    """All tables stacked, with narrow columns and notes."""
    page.stacked(page.keys, widest=24)


def figures_sheet(page: SheetWriter) -> None:
    """Lists of figures on the left, tables of several columns on the right."""
    lists = [key for key in page.keys if page.contents[key].figures]
    page.beside(lists, [key for key in page.keys if key not in lists])


def single_table_sheet(page: SheetWriter) -> None:
    """One main table, further ones below it."""
    page.rest(page.place_single(page.keys[0]).last + 4)


def wide_table_sheet(page: SheetWriter) -> None:
    """One wide main table with its name columns frozen, further ones below it."""
    names = [column.kind for column in page.contents[page.keys[0]].columns]
    corner = f"{get_column_letter(1 + next(i for i, kind in enumerate(names) if kind != 'text'))}3"
    page.rest(page.place_single(page.keys[0], frozen=corner, widest=30).last + 4)


def tension_sheet(page: SheetWriter) -> None:
    """Tension behind every section in every state, with a chart; states that fail in red."""
    place = page.place_single("section_ends")
    sheet, row = page.sheet, place.last + 3
    failing = [column.key for column in page.contents["section_ends"].columns if FAILS in column.label]
    for key in failing:
        sheet.cell(place.header, place.column(key)).fill = VERDICT_STYLES["FAIL"].fill
    if place.whole:
        chart = charts.tension_chart(sheet, place, page.contents.system, failing=failing, said=page.said)
        sheet.add_chart(chart, f"A{row}")


def transfer_sheet(page: SheetWriter) -> None:
    """Loading points, cleaners and discharge, with a chart of the trajectory to scale."""
    contents = page.contents
    shown = page.stacked([key for key in page.keys if contents[key].printed])
    row = max(place.last for place in shown.values()) + 4
    drawn = page.stacked([key for key in page.keys if not contents[key].printed], row + 2 * CHART_ROWS)
    if drawn:
        pair = drawn["trajectory"], drawn["pulley_outline"]
        page.sheet.add_chart(charts.trajectory_chart(page.sheet, *pair, contents.system, said=page.said), f"A{row}")


def uncertainty_sheet(page: SheetWriter) -> None:
    """Power with its band, and the sensitivity with a chart."""
    page.beside([key for key in page.keys if key != "sensitivity"], ["sensitivity"])
    place = page.placed["sensitivity"][1]
    if place.whole and place.last - place.header <= _MOST_BARS:
        rows = place.header, place.last
        swing = place.column("swing")
        title = page.said("Sensitivity of motor power")
        chart = charts.bar_chart(page.sheet, title, rows, label=place.first_column, value=swing)
        page.sheet.add_chart(chart, f"{get_column_letter(place.first_column)}{place.last + 4}")


def rubber_sheet(page: SheetWriter) -> None:
    """Excitation bands, data and moduli charts of every compound; tables of curves are not printed."""
    sheet, contents = page.sheet, page.contents
    row = page.place("rubber", 1, widest=30).last + 3
    strands = [strand for strand in ("carry", "return") if f"known_{strand}" in contents]
    for strand in strands:
        known = contents[f"known_{strand}"]
        row = _write_compound(page, row, f"{known.heading}, {strand} strand", known.rows)
    charted, row = row, row + CHART_ROWS
    tables = [f"{name}_{strand}" for strand in strands for name in ("moduli", "prony")]
    places = page.stacked(tables, row)
    for strand, corner in zip(strands, ("A", "E"), strict=False):
        name, moduli = contents[f"known_{strand}"].heading.rpartition(" (")[0], places[f"moduli_{strand}"]
        chart = charts.moduli_chart(sheet, name, moduli, contents.system, said=page.said)
        charts.resize_chart(chart, _NARROW_CHART)
        sheet.add_chart(chart, f"{corner}{charted}")
        if len(strands) == 1:  # one compound on both strands
            define_name(sheet, "table_moduli_return", moduli.cells)
            define_name(sheet, "table_prony_return", places[f"prony_{strand}"].cells)
    page.rest(max(place.last for place in places.values()) + 3, but=("moduli_return", "prony_return"))
    for column, width in enumerate(_RUBBER_COLUMNS, start=1):
        sheet.column_dimensions[get_column_letter(column)].width = width


def _write_compound(page: SheetWriter, row: int, heading: str, facts: Sequence[tuple[str, str]]) -> int:
    """Write the facts of a compound; return the next row."""
    page.write(row, 1, heading, HEADING)
    for name, value in facts:
        row += 1
        page.write(row, 1, name, GREY)
        page.sheet.cell(row, 1).alignment = Alignment(vertical="top", wrap_text=True)
        _write_across(page.sheet, row, 2, page.said(value), columns=8)
    return row + 2


def notes_sheet(page: SheetWriter) -> None:
    """Checks, method, warnings, assumptions, notes of the spec, provenance."""
    row = page.place("checks", 1, widest=40).last + 3
    for heading, kind in (
        ("Method", "method"),
        ("Warnings", "warning"),
        ("Assumptions", "assumption"),
        ("Notes of the spec", "note of the spec"),
    ):
        row = write_paragraphs(page, row, heading, page.contents.lines(kind), columns=6)
    page.rest(page.place("provenance", row, widest=34).last + 4, but=("remarks",))


def about_sheet(page: SheetWriter) -> None:
    """First sheet of a verification workbook: facts, basis of the figures, cells to fill in."""
    sheet, head = page.sheet, page.contents.document
    write_value(sheet["A1"], head.title, TITLE)
    for row, (name, value) in enumerate(head.facts, start=2):
        page.write(row, 1, name, GREY)
        page.write(row, 2, value)
    sheet.column_dimensions["A"].width, sheet.column_dimensions["B"].width = 26, 60
    row = write_paragraphs(page, len(head.facts) + 3, "What these figures are", page.contents.lines("assumption"))
    page.rest(row, but=("remarks",))


def fill_in_sheet(page: SheetWriter) -> None:
    """Table to fill in, with frozen header and names; a page break at every new first name."""
    (key,) = page.keys
    part = page.contents[key].on_sheet()
    place = page.place_single(key, frozen=f"{get_column_letter(part.named + 1)}3", widest=44)
    names = [part.columns[0].get(row) for row in part.rows]
    for i, (before, after) in enumerate(pairwise(names), start=place.header + 1):
        if before != after and len(names) > _ONE_PAGE_ROWS:
            page.sheet.row_breaks.append(Break(id=i))


def ranking_sheet(page: SheetWriter) -> None:
    """Ranking on one page: facts, ranking, costs, chart of the differences, notes."""
    sheet, contents, about = page.sheet, page.contents, page.contents.document
    facts = dict(about.facts)
    page.write(1, 1, f"Compounds compared: {about.title}", TITLE)
    stamp = f"conveyor {package_version('conveyor')}, {date.today().isoformat()}, spec {about.fingerprint[:16]}"
    page.write(2, 1, "; ".join(filter(None, (about.document_line, stamp))), GREY)
    words = f"{facts['cover']} cover of each compound; base of savings: {facts['savings against']}"
    page.write(3, 1, words, GREY)
    row = 5
    if "ranking" in contents:
        ranked = contents["ranking"]
        place = page.place("ranking", row, widest=44)
        sheet.freeze_panes = "B1"
        row = place.last + 3
        if "costs" in contents:
            row = page.place("costs", row, widest=44).last + 3
            row = page.stacked(["what_if"], row)["what_if"].last + 4
        speeds = [each.speed for each in ranked.rows]
        last = place.header + speeds.count(speeds[0])  # those of the first speed stand first
        if place.whole and "motor_power_against_base" in place.keys:
            at = display_unit("speed", contents.system).said(speeds[0], 4)
            title = f"Mean motor power against {facts['savings against']} at {at}"
            sheet.add_chart(charts.difference_chart(sheet, title, place, last, said=page.said), f"A{row}")
            row += CHART_ROWS
    tables = [contents[key].on_sheet() for key in ("ranking", "costs") if key in contents]
    printed = max((sum(column.page is not None for column in table.columns) for table in tables), default=0)
    widest = paragraph_width(sheet, range(1, 1 + printed), about.paper)
    for heading, lines in zip(NOTE_HEADINGS, sort_notes(contents.lines("warning")), strict=True):
        if lines:
            row = write_paragraphs(page, row, heading.capitalize(), lines, columns=max(8, printed), widest=widest)
    page.rest(row)


def power_sheet(page: SheetWriter) -> None:
    """Motor power over temperature at every speed, with charts."""
    sheet, contents = page.sheet, page.contents
    row = 1
    for key in page.keys:
        part = contents[key]
        place = page.place(key, row, widest=24)
        if place.whole and len(part.rows) > 1:
            chart = charts.power_over_temperature(sheet, place, part, contents.system, said=page.said)
            sheet.add_chart(chart, f"A{place.last + 2}")
        row = place.last + CHART_ROWS + 5
    if row == 1:
        page.write(1, 1, "No temperature that every compound has an answer for", HEADING)


def scenes_sheet(page: SheetWriter) -> None:
    """Every scene of the comparison."""
    if "scenes" in page.contents:
        page.place_single("scenes", widest=44)
    else:
        page.write(1, 1, "No scene has an answer", HEADING)


def coverage_sheet(page: SheetWriter) -> None:
    """Excitation bands against data ranges; scenes without a solution."""
    row = 1
    if "coverage" in page.contents:
        row = page.place("coverage", row).last + 3
    if "refused" in page.contents:
        page.place("refused", row, widest=90)
    else:
        page.write(row, 1, "Scenes without an answer: none", HEADING)
    page.sheet.freeze_panes = "B1"


def compounds_sheet(page: SheetWriter) -> None:
    """Compounds, remarks, provenance."""
    row = page.place("compounds", 1, widest=24, unknown=34).last + 3
    row = write_paragraphs(page, row, "Remarks", page.contents.lines("warning"), columns=6)
    page.place("provenance", row, widest=24)
    page.sheet.freeze_panes = "B1"


def write_paragraphs(
    page: SheetWriter,
    row: int,
    heading: str,
    lines: Iterable[str],
    *,
    columns: int = 4,
    widest: float = TEXT_WIDTH,
) -> int:
    """Write a heading and lines of text across columns, long ones in pieces; return the next row but one."""
    page.write(row, 1, heading, HEADING)
    for line in map(page.said, tuple(lines) or ("none",)):
        for i in range(0, len(line), _CELL_CHARACTERS):
            row += 1
            _write_across(page.sheet, row, 1, line[i : i + _CELL_CHARACTERS], columns=columns, widest=widest)
    return row + 2


def _write_across(
    sheet: Worksheet, row: int, column: int, line: str, *, columns: int, widest: float = TEXT_WIDTH
) -> None:
    """Write text across columns, wrapped."""
    cell = sheet.cell(row, column)
    write_value(cell, line)
    cell.alignment = Alignment(wrap_text=True, vertical="top", indent=1)
    over = columns_of_text(sheet, range(column, column + columns), widest)
    sheet.merged_cells.add(f"{cell.coordinate}:{get_column_letter(over[-1])}{row}")
    sheet.row_dimensions[row].height = 15.0 * line_count(line, columns_width(sheet, over))
