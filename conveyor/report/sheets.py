"""The sheets of the workbooks that hold more than their tables under one another, one function each."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import date
from importlib.metadata import version
from itertools import pairwise

from openpyxl.styles import Alignment
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report import charts
from conveyor.report.cells import GREY, HEADING, TITLE, put
from conveyor.report.places import Page, define
from conveyor.units.presentation import unit

_CHART_COLUMN = "F"
_CURVES_COLUMN = "H"
_CHART_ROWS = 20
_NARROW = 12.0  # width of a chart on a page held upright [cm]
_PAGE_ROWS = 110  # of a compound that still fit its page
_NEW_PAGE = 40  # rows beyond which a table to fill in goes on on new sheets of paper
_MOST_BARS = 24
"""Bars that one chart shows legibly."""
_FILLED = 1.05  # of a line's width that text takes before it breaks at a word
_PIECE = 1000  # characters of a note in one cell


def stacked(page: Page) -> None:
    """All tables of the sheet under one another."""
    page.stacked(page.contents.of(page.sheet.title))


def single(page: Page) -> None:
    """A table that fills its sheet; further ones below it."""
    key, *others = page.contents.of(page.sheet.title)
    page.below(page.headed(key), others)


def wide(page: Page) -> None:
    """A wide table that fills its sheet, the columns that name its rows kept in view; further ones below it."""
    key, *others = page.contents.of(page.sheet.title)
    names = [column.kind for column in page.contents[key].columns]
    corner = f"{get_column_letter(1 + next(i for i, kind in enumerate(names) if kind != 'text'))}3"
    page.below(page.headed(key, frozen=corner, widest=30), others)


def resistances(page: Page) -> None:
    """Every force and its law, adding up to the effective tension; their sums; the classical estimate."""
    place = page.headed("resistances")
    page.below(place, ("breakdown", "classical"))


def tensions(page: Page) -> None:
    """Tension at every place of the loop, with its chart."""
    place = page.headed("tensions")
    if place.whole:
        page.sheet.column_dimensions["E"].width = 3
        page.sheet.add_chart(charts.tension(page.sheet, place), f"{_CHART_COLUMN}4")


def states(page: Page) -> None:
    """Route profile beside its chart where it rises, and the tension at every place in every state of motion."""
    place = page.place("profile", 1)
    row, profile = place.last + 3, page.contents["profile"]
    if place.whole and len(set(profile.cells(profile.columns[profile.index("height")], "SI"))) > 1:
        page.sheet.add_chart(
            charts.profile(page.sheet, place, page.contents.system), f"{_CHART_COLUMN}{place.header}"
        )
        row = max(row, place.header + _CHART_ROWS)
    page.stacked([key for key in page.contents.of("States") if key != "profile"], row)


def uncertainty(page: Page) -> None:
    """The power with its band, and which input matters, with its chart."""
    places = page.stacked(page.contents.of("Uncertainty"))
    place = places["sensitivity"]
    if place.whole and place.last - place.header <= _MOST_BARS:
        rows = place.header, place.last
        swing = place.column("swing")
        chart = charts.bars(page.sheet, "What the motor power swings by", rows, label=1, value=swing)
        page.sheet.add_chart(chart, f"A{max(each.last for each in places.values()) + 4}")


def indentation(page: Page) -> None:
    """What every distinct contact cost, and its load curve with a chart of the curves."""
    place = page.stacked(page.contents.of("Indentation"))["indentation"]
    if place.whole:
        chart = charts.indentation(page.sheet, page.contents["indentation"], place)
        charts.sized(chart, _NARROW)
        page.sheet.add_chart(chart, f"{_CURVES_COLUMN}{place.header + 1}")


def rubber(page: Page) -> None:
    """What the rolls ask; provenance, relaxation spectrum and moduli of every compound in use."""
    sheet, contents = page.sheet, page.contents
    row = page.place("rubber", 1, widest=30).last + 3
    sheet.column_dimensions["A"].width = 24
    strands = [strand for strand in ("carry", "return") if f"known_{strand}" in contents]
    for strand in strands:
        known = contents[f"known_{strand}"]
        if strand == "return":
            sheet.row_breaks.append(Break(id=row - 1))
        row = _known(sheet, row, f"{known.heading}, {strand} strand", known.rows)
        moduli = page.place(f"moduli_{strand}", row)
        prony = page.place(f"prony_{strand}", moduli.last + 3)
        chart = charts.moduli(sheet, known.heading.rpartition(" (")[0], moduli, contents.system)
        charts.sized(chart, _NARROW)
        sheet.add_chart(chart, f"{_CHART_COLUMN}{moduli.header + 1}")
        row = prony.last + 3
        if len(strands) == 1:  # one compound on both strands
            define(sheet, "table_moduli_return", moduli.cells)
            define(sheet, "table_prony_return", prony.cells)
    if row <= _PAGE_ROWS * len(strands):
        sheet.page_setup.fitToHeight = len(strands)
    told = {"rubber", *(f"{name}_{strand}" for name in ("moduli", "prony") for strand in ("carry", "return"))}
    page.stacked([key for key in contents.of("Rubber") if key not in told], row)


def _known(sheet: Worksheet, row: int, heading: str, facts: Sequence[tuple[str, str]]) -> int:
    """What is known of a compound; the row its tables begin in."""
    put(sheet.cell(row, 1), heading, HEADING)
    for name, value in facts:
        row += 1
        put(sheet.cell(row, 1), name, GREY)
        sheet.cell(row, 1).alignment = Alignment(vertical="top")
        _across(sheet, row, 2, value, columns=10)
    return row + 2


def notes(page: Page) -> None:
    """Checks, warnings, assumptions, the spec's notes, and what made the figures."""
    sheet, contents = page.sheet, page.contents
    row = page.place("checks", 1, widest=56).last + 3
    for heading, kind in (
        ("Warnings", "warning"),
        ("Assumptions", "assumption"),
        ("Notes of the spec", "note of the spec"),
    ):
        lines = contents.lines(kind)
        pieces = [line[i : i + _PIECE] for line in lines for i in range(0, len(line), _PIECE)]
        row = paragraphs(sheet, row, heading, pieces)
    place = page.place("provenance", row, widest=70)
    told = {"checks", "remarks", "provenance"}
    page.below(place, [key for key in contents.of(sheet.title) if key not in told])


def about(page: Page) -> None:
    """What a sheet to fill in is of, what its figures are, and who fills it in."""
    sheet, head = page.sheet, page.contents.document
    put(sheet["A1"], head.title, TITLE)
    for row, (name, value) in enumerate(head.facts, start=2):
        put(sheet.cell(row, 1), name, GREY)
        put(sheet.cell(row, 2), value)
    sheet.column_dimensions["A"].width, sheet.column_dimensions["B"].width = 26, 60
    row = paragraphs(sheet, len(head.facts) + 3, "What these figures are", page.contents.lines("assumption"))
    told = {"remarks"}
    page.stacked([key for key in page.contents.of(sheet.title) if key not in told], row)


def to_compare(page: Page) -> None:
    """A table to fill in: names of rows and header in view, a new sheet of paper for every new first name."""
    (key,) = page.contents.of(page.sheet.title)
    part = page.contents[key].on_sheet()
    place = page.headed(key, frozen=f"{get_column_letter(part.named + 1)}3", widest=44)
    names = [part.columns[0].get(row) for row in part.rows]
    for i, (before, after) in enumerate(pairwise(names), start=place.header + 1):
        if before != after and len(names) > _NEW_PAGE:
            page.sheet.row_breaks.append(Break(id=i))


def ranking(page: Page) -> None:
    """One page: what was compared, the ranking, bars of the mean power, what to know."""
    sheet, contents, about = page.sheet, page.contents, page.contents.document
    facts = dict(about.facts)
    put(sheet["A1"], f"Compounds compared: {about.title}", TITLE)
    stamp = f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec {about.fingerprint[:16]}"
    put(sheet["A2"], "; ".join(filter(None, (about.documented, stamp))), GREY)
    words = f"{facts['cover']} cover of each compound; base of savings: {facts['savings against']}"
    put(sheet["A3"], words, GREY)
    row = 5
    if "ranking" in contents:
        ranked, own = contents["ranking"], about.own_speed
        place = page.place("ranking", row, widest=44)
        sheet.freeze_panes = "B1"
        row = place.last + 3
        if "costs" in contents:
            row = page.place("costs", row, widest=44).last + 3
        speeds = [each.speed for each in ranked.rows]
        speed = min(speeds, key=lambda v: abs(v - own))
        at = [place.header + 1 + k for k, v in enumerate(speeds) if v == speed]
        if place.whole and "mean_motor_power" in place.keys:
            title = f"Mean motor power at {unit('speed', contents.system).said(speed)}"
            value = place.column("mean_motor_power")
            chart = charts.bars(sheet, title, (at[0] - 1, at[-1]), label=1, value=value)
            chart.y_axis.title = charts.axis_title(str(sheet.cell(place.header, value).value))
            chart.y_axis.scaling.min = 0.0
            sheet.add_chart(chart, f"A{row}")
            row += _CHART_ROWS
    row = paragraphs(sheet, row, "What to know", contents.lines("warning"), columns=8)
    told = {"ranking", "costs"}
    page.stacked([key for key in contents.of(sheet.title) if key not in told], row)
    sheet.page_setup.fitToHeight = 1


def power(page: Page) -> None:
    """Motor power over temperature at every speed, one column a compound, with its chart."""
    sheet, contents = page.sheet, page.contents
    row = 1
    for key in contents.of("Power"):
        part = contents[key]
        place = page.place(key, row, widest=24)
        if place.whole and len(part.rows) > 1:
            chart = charts.power_over_temperature(sheet, place, part, contents.system)
            sheet.add_chart(chart, f"{get_column_letter(place.last_column + 2)}{row + 1}")
        row = max(place.last, row + _CHART_ROWS) + 3
    if row == 1:
        put(sheet["A1"], "No temperature that every compound has an answer for", HEADING)


def scenes(page: Page) -> None:
    """Every scene, one row each."""
    if "scenes" in page.contents:
        page.headed("scenes", widest=44)
    else:
        put(page.sheet["A1"], "No scene has an answer", HEADING)


def coverage(page: Page) -> None:
    """What the rolls excite against what the data hold; scenes without an answer."""
    row = 1
    if "coverage" in page.contents:
        row = page.place("coverage", row).last + 3
    if "refused" in page.contents:
        page.place("refused", row, widest=90)
    else:
        put(page.sheet.cell(row, 1), "Scenes without an answer: none", HEADING)
    page.sheet.freeze_panes = "B1"


def compounds(page: Page) -> None:
    """What is known of each compound, remarks, and what made the figures."""
    row = page.place("compounds", 1, widest=44).last + 3
    row = paragraphs(page.sheet, row, "Remarks", page.contents.lines("warning"), columns=6)
    page.place("provenance", row, widest=70)
    page.sheet.freeze_panes = "B1"


def paragraphs(
    sheet: Worksheet, row: int, heading: str, lines: tuple[str, ...] | list[str], columns: int = 4
) -> int:
    """Write lines of text across columns, under a heading; the row after the next blank one."""
    put(sheet.cell(row, 1), heading, HEADING)
    for line in lines or ("none",):
        row += 1
        _across(sheet, row, 1, line, columns=columns)
    return row + 2


def _across(sheet: Worksheet, row: int, column: int, line: str, *, columns: int) -> None:
    """Write one text across columns, on as many lines as it takes."""
    cell = sheet.cell(row, column)
    put(cell, line)
    cell.alignment = Alignment(wrap_text=True, vertical="top", indent=1)
    last = column + columns - 1
    sheet.merged_cells.add(f"{cell.coordinate}:{get_column_letter(last)}{row}")
    letters = [get_column_letter(j) for j in range(column, last + 1)]
    width = sum(sheet.column_dimensions[x].width if x in sheet.column_dimensions else 8.0 for x in letters)
    sheet.row_dimensions[row].height = 15.0 * -(-len(line) // max(1, int(_FILLED * width)))
