"""The sheets of a comparison of compounds, one function each."""

from __future__ import annotations

from datetime import date
from importlib.metadata import version
from typing import TYPE_CHECKING

from openpyxl.utils import get_column_letter

from conveyor.report import charts
from conveyor.report.cells import GREY, HEADING, TITLE, put
from conveyor.report.cover import documented
from conveyor.report.places import Page
from conveyor.report.sheets import paragraphs
from conveyor.spec import fingerprint
from conveyor.units import display, si

if TYPE_CHECKING:
    from conveyor.studies.comparison import Comparison

_CHART_ROWS = 20


def ranking(page: Page, comparison: Comparison) -> None:
    """One page: what was compared, the ranking, bars of the mean power, what to know."""
    sheet, conveyor = page.sheet, comparison.conveyor
    put(sheet["A1"], f"Compounds compared: {conveyor.name}", TITLE)
    stamp = f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec {fingerprint(conveyor)[:16]}"
    put(sheet["A2"], f"{documented(conveyor.report)}{stamp}", GREY)
    words = f"{comparison.cover} cover of each compound; base of savings: {comparison.base}"
    put(sheet["A3"], words, GREY)
    row = 5
    if "ranking" in page.contents.by_key:
        place = page.place("ranking", row, widest=44)
        sheet.freeze_panes = "B1"
        row = place.last + 3
        if "costs" in page.contents.by_key:
            row = page.place("costs", row, widest=44).last + 3
        frame = page.contents["ranking"].frame
        names = [str(name) for name in frame.columns]
        value = 1 + next(j for j, name in enumerate(names) if name.startswith("mean motor power ["))
        speeds = comparison.ranking["belt speed [m/s]"].tolist()
        speed = min(speeds, key=lambda v: abs(v - si(conveyor.belt.speed)))
        at = [place.header + 1 + k for k, v in enumerate(speeds) if v == speed]
        if place.whole:
            title = f"Mean motor power at {display(speed, 'speed', page.contents.system)}"
            chart = charts.bars(sheet, title, (at[0] - 1, at[-1]), label=1, value=value)
            chart.y_axis.title = charts.axis_title(names[value - 1])
            chart.y_axis.scaling.min = 0.0
            sheet.add_chart(chart, f"A{row}")
            row += _CHART_ROWS
    known = page.contents["remarks"].frame["remark"].tolist()
    paragraphs(sheet, row, "What to know", known, columns=8)
    sheet.page_setup.fitToHeight = 1


def power(page: Page, _: Comparison) -> None:
    """Motor power over temperature at every speed, one column a compound, with its chart."""
    sheet, contents = page.sheet, page.contents
    row = 1
    for part in contents.of("Power"):
        place = page.place(part.key, row, widest=24)
        count = len(part.frame.columns) - 1
        if place.whole and len(part.frame) > 1:
            least = min(float(v) for name in part.frame.columns[1:] for v in part.frame[name])
            chart = charts.power_over_temperature(
                sheet,
                (place.header, place.last),
                count=count,
                speed=part.heading.rpartition(" at ")[2],
                least=least,
            )
            sheet.add_chart(chart, f"{get_column_letter(count + 3)}{row + 1}")
        row = max(place.last, row + _CHART_ROWS) + 3
    if row == 1:
        put(sheet["A1"], "No temperature that every compound has an answer for", HEADING)


def scenes(page: Page, _: Comparison) -> None:
    """Every scene, one row each."""
    if "scenes" in page.contents.by_key:
        page.headed("scenes", widest=44)
    else:
        put(page.sheet["A1"], "No scene has an answer", HEADING)


def coverage(page: Page, _: Comparison) -> None:
    """What the rolls excite against what the data hold; scenes without an answer."""
    row = 1
    if "coverage" in page.contents.by_key:
        row = page.place("coverage", row).last + 3
    if "refused" in page.contents.by_key:
        page.place("refused", row, widest=90)
    else:
        put(page.sheet.cell(row, 1), "Scenes without an answer: none", HEADING)
    page.sheet.freeze_panes = "B1"


def notes(page: Page, _: Comparison) -> None:
    """What is known of each compound, remarks, and what made the figures."""
    row = page.place("compounds", 1, widest=44).last + 3
    lines = page.contents["remarks"].frame["remark"].tolist()
    row = paragraphs(page.sheet, row, "Remarks", lines, columns=6)
    page.place("provenance", row, widest=70)
    page.sheet.freeze_panes = "B1"
