"""Layouts of the sheets of workbooks, one function each."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import date
from itertools import pairwise

from openpyxl.styles import Alignment
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.files.marks import version
from conveyor.report import charts
from conveyor.report.cells import GREY, HEADING, TITLE, VERDICTS, lines_of, put
from conveyor.report.columns import FAILS, HEADINGS, ordered
from conveyor.report.places import CHART_ROWS, Page, define
from conveyor.units.presentation import unit

_NARROW = 12.0  # width of a chart on a page held upright [cm]
_NEW_PAGE = 40  # rows beyond which a table to fill in goes on on new sheets of paper
_MOST_BARS = 24
"""Maximum number of bars of a chart."""
_PIECE = 1000  # characters of a note in one cell


def stacked(page: Page, widest: int = 56) -> None:
    """All tables stacked; text wraps at `widest` [characters]."""
    page.rest(widest=widest)


def noted(page: Page) -> None:
    """All tables stacked, with narrow columns and notes."""
    page.stacked(page.keys, widest=24)


def beside(page: Page) -> None:
    """Lists of figures on the left, tables of several columns on the right."""
    lists = [key for key in page.keys if page.contents[key].figures]
    page.beside(lists, [key for key in page.keys if key not in lists])


def single(page: Page) -> None:
    """One main table, further ones below it."""
    page.rest(page.headed(page.keys[0]).last + 4)


def wide(page: Page) -> None:
    """One wide main table with its name columns frozen, further ones below it."""
    names = [column.kind for column in page.contents[page.keys[0]].columns]
    corner = f"{get_column_letter(1 + next(i for i, kind in enumerate(names) if kind != 'text'))}3"
    page.rest(page.headed(page.keys[0], frozen=corner, widest=30).last + 4)


def tensions(page: Page) -> None:
    """Tension behind every section in every state, with a chart; states that fail in red."""
    place = page.headed("section_ends")
    sheet, row = page.sheet, place.last + 3
    for column in range(place.first_column, place.last_column + 1):
        head = sheet.cell(place.header, column)
        if FAILS in str(head.value):
            head.fill = VERDICTS["FAIL"].fill
    if place.whole:
        sheet.add_chart(charts.tension(sheet, place, page.contents.system), f"A{row}")


def transfer(page: Page) -> None:
    """Loading points, cleaners and discharge, with a chart of the trajectory to scale."""
    contents = page.contents
    shown = page.stacked([key for key in page.keys if contents[key].printed])
    row = max(place.last for place in shown.values()) + 4
    drawn = page.stacked([key for key in page.keys if not contents[key].printed], row + 2 * CHART_ROWS)
    if drawn:
        pair = drawn["trajectory"], drawn["pulley_outline"]
        page.sheet.add_chart(charts.trajectory(page.sheet, *pair, contents.system), f"A{row}")


def uncertainty(page: Page) -> None:
    """Power with its band, and the sensitivity with a chart."""
    page.beside([key for key in page.keys if key != "sensitivity"], ["sensitivity"])
    place = page.placed["sensitivity"][1]
    if place.whole and place.last - place.header <= _MOST_BARS:
        rows = place.header, place.last
        swing = place.column("swing")
        chart = charts.bars(
            page.sheet, "Sensitivity of motor power", rows, label=place.first_column, value=swing
        )
        page.sheet.add_chart(chart, f"{get_column_letter(place.first_column)}{place.last + 4}")


def rubber(page: Page) -> None:
    """Excitation bands, data and moduli charts of every compound; tables of curves are not printed."""
    sheet, contents = page.sheet, page.contents
    row = page.place("rubber", 1, widest=30).last + 3
    sheet.column_dimensions["A"].width = 24
    strands = [strand for strand in ("carry", "return") if f"known_{strand}" in contents]
    for strand in strands:
        known = contents[f"known_{strand}"]
        row = _known(sheet, row, f"{known.heading}, {strand} strand", known.rows)
    charted, row = row, row + CHART_ROWS
    tables = [f"{name}_{strand}" for strand in strands for name in ("moduli", "prony")]
    places = page.stacked(tables, row)
    for strand, corner in zip(strands, ("A", "E"), strict=False):
        name, moduli = contents[f"known_{strand}"].heading.rpartition(" (")[0], places[f"moduli_{strand}"]
        chart = charts.moduli(sheet, name, moduli, contents.system)
        charts.sized(chart, _NARROW)
        sheet.add_chart(chart, f"{corner}{charted}")
        if len(strands) == 1:  # one compound on both strands
            define(sheet, "table_moduli_return", moduli.cells)
            define(sheet, "table_prony_return", places[f"prony_{strand}"].cells)
    page.rest(max(place.last for place in places.values()) + 3, but=("moduli_return", "prony_return"))


def _known(sheet: Worksheet, row: int, heading: str, facts: Sequence[tuple[str, str]]) -> int:
    """Write the facts of a compound; return the next row."""
    put(sheet.cell(row, 1), heading, HEADING)
    for name, value in facts:
        row += 1
        put(sheet.cell(row, 1), name, GREY)
        sheet.cell(row, 1).alignment = Alignment(vertical="top")
        _across(sheet, row, 2, value, columns=8)
    return row + 2


def notes(page: Page) -> None:
    """Checks, method, warnings, assumptions, notes of the spec, provenance."""
    sheet, contents = page.sheet, page.contents
    row = page.place("checks", 1, widest=40).last + 3
    for heading, kind in (
        ("Method", "method"),
        ("Warnings", "warning"),
        ("Assumptions", "assumption"),
        ("Notes of the spec", "note of the spec"),
    ):
        lines = contents.lines(kind)
        pieces = [line[i : i + _PIECE] for line in lines for i in range(0, len(line), _PIECE)]
        row = paragraphs(sheet, row, heading, pieces, columns=6)
    page.rest(page.place("provenance", row, widest=34).last + 4, but=("remarks",))


def about(page: Page) -> None:
    """First sheet of a verification workbook: facts, basis of the figures, cells to fill in."""
    sheet, head = page.sheet, page.contents.document
    put(sheet["A1"], head.title, TITLE)
    for row, (name, value) in enumerate(head.facts, start=2):
        put(sheet.cell(row, 1), name, GREY)
        put(sheet.cell(row, 2), value)
    sheet.column_dimensions["A"].width, sheet.column_dimensions["B"].width = 26, 60
    row = paragraphs(sheet, len(head.facts) + 3, "What these figures are", page.contents.lines("assumption"))
    page.rest(row, but=("remarks",))


def to_compare(page: Page) -> None:
    """Table to fill in, with frozen header and names; a page break at every new first name."""
    (key,) = page.keys
    part = page.contents[key].on_sheet()
    place = page.headed(key, frozen=f"{get_column_letter(part.named + 1)}3", widest=44)
    names = [part.columns[0].get(row) for row in part.rows]
    for i, (before, after) in enumerate(pairwise(names), start=place.header + 1):
        if before != after and len(names) > _NEW_PAGE:
            page.sheet.row_breaks.append(Break(id=i))


def ranking(page: Page) -> None:
    """Ranking on one page: facts, ranking, costs, chart of the differences, notes."""
    sheet, contents, about = page.sheet, page.contents, page.contents.document
    facts = dict(about.facts)
    put(sheet["A1"], f"Compounds compared: {about.title}", TITLE)
    stamp = f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec {about.fingerprint[:16]}"
    put(sheet["A2"], "; ".join(filter(None, (about.documented, stamp))), GREY)
    words = f"{facts['cover']} cover of each compound; base of savings: {facts['savings against']}"
    put(sheet["A3"], words, GREY)
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
            at = unit("speed", contents.system).brief(speeds[0])
            title = f"Mean motor power against {facts['savings against']} at {at}"
            sheet.add_chart(charts.differences(sheet, title, place, last), f"A{row}")
            row += CHART_ROWS
    for heading, lines in zip(HEADINGS, ordered(contents.lines("warning")), strict=True):
        if lines:
            row = paragraphs(sheet, row, heading.capitalize(), lines, columns=8)
    page.rest(row)
    sheet.page_setup.fitToHeight = 1


def power(page: Page) -> None:
    """Motor power over temperature at every speed, with charts."""
    sheet, contents = page.sheet, page.contents
    row = 1
    for key in page.keys:
        part = contents[key]
        place = page.place(key, row, widest=24)
        if place.whole and len(part.rows) > 1:
            chart = charts.power_over_temperature(sheet, place, part, contents.system)
            sheet.add_chart(chart, f"A{place.last + 2}")
        row = place.last + CHART_ROWS + 5
    if row == 1:
        put(sheet["A1"], "No temperature that every compound has an answer for", HEADING)


def scenes(page: Page) -> None:
    """Every scene of the comparison."""
    if "scenes" in page.contents:
        page.headed("scenes", widest=44)
    else:
        put(page.sheet["A1"], "No scene has an answer", HEADING)


def coverage(page: Page) -> None:
    """Excitation bands against data ranges; scenes without a solution."""
    row = 1
    if "coverage" in page.contents:
        row = page.place("coverage", row).last + 3
    if "refused" in page.contents:
        page.place("refused", row, widest=90)
    else:
        put(page.sheet.cell(row, 1), "Scenes without an answer: none", HEADING)
    page.sheet.freeze_panes = "B1"


def compounds(page: Page) -> None:
    """Compounds, remarks, provenance."""
    row = page.place("compounds", 1, widest=44).last + 3
    row = paragraphs(page.sheet, row, "Remarks", page.contents.lines("warning"), columns=6)
    page.place("provenance", row, widest=70)
    page.sheet.freeze_panes = "B1"


def paragraphs(
    sheet: Worksheet, row: int, heading: str, lines: tuple[str, ...] | list[str], columns: int = 4
) -> int:
    """Write a heading and lines of text across columns; return the next row but one."""
    put(sheet.cell(row, 1), heading, HEADING)
    for line in lines or ("none",):
        row += 1
        _across(sheet, row, 1, line, columns=columns)
    return row + 2


def _across(sheet: Worksheet, row: int, column: int, line: str, *, columns: int) -> None:
    """Write text across columns, wrapped."""
    cell = sheet.cell(row, column)
    put(cell, line)
    cell.alignment = Alignment(wrap_text=True, vertical="top", indent=1)
    last = column + columns - 1
    sheet.merged_cells.add(f"{cell.coordinate}:{get_column_letter(last)}{row}")
    letters = [get_column_letter(j) for j in range(column, last + 1)]
    width = sum(sheet.column_dimensions[x].width if x in sheet.column_dimensions else 8.0 for x in letters)
    sheet.row_dimensions[row].height = 15.0 * lines_of(line, width)
