"""The sheets of a comparison of compounds, one function each."""

from __future__ import annotations

from datetime import date
from importlib.metadata import version
from typing import TYPE_CHECKING

import pandas as pd
from openpyxl.styles import Alignment
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report import charts, comparing
from conveyor.report.cells import GREY, HEADING, TITLE, put, table
from conveyor.spec import fingerprint
from conveyor.units import si

if TYPE_CHECKING:
    from conveyor.comparison import Comparison

MOST_ROWS = 10_000
"""Scenes written to the workbook; beyond it a spreadsheet is the wrong place and takes half a minute to write."""
_CHART_ROWS = 20
_NAMES = 44  # characters of a compound's name on one line
_LINE = 130  # characters of a note in one line of the merged columns


def ranking(sheet: Worksheet, comparison: Comparison) -> None:
    """One page: what was compared, the ranking, bars of the mean power."""
    put(sheet["A1"], f"Compounds compared: {comparison.conveyor.name}", TITLE)
    stamp = f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec {fingerprint(comparison.conveyor)[:16]}"
    put(sheet["A2"], stamp, GREY)
    put(sheet["A3"], f"{comparison.cover} cover of each compound; base of savings: {comparison.base}", GREY)
    frame = comparison.ranking
    table(sheet, frame, 5, widest=_NAMES)
    sheet.freeze_panes = "B6"
    value = 1 + list(frame.columns).index("mean motor power [kW]")
    speed = min(frame["belt speed [m/s]"], key=lambda v: abs(v - si(comparison.conveyor.belt.speed)))
    rows = [6 + k for k, v in enumerate(frame["belt speed [m/s]"]) if v == speed]
    chart = charts.breakdown(sheet, header=rows[0] - 1, last=rows[-1], label=1, value=value)
    chart.y_axis.scaling.min = 0.0
    charts.name(chart, f"Mean motor power at {speed:g} m/s", "motor power [kW]")
    sheet.add_chart(chart, f"A{5 + len(frame) + 3}")


def power(sheet: Worksheet, comparison: Comparison) -> None:
    """Motor power over temperature at every speed, one column a compound, with its chart."""
    frame = comparison.table
    put(sheet["A1"], "Motor power [kW] over temperature, one block a speed", HEADING)
    row = 3
    for speed in sorted(frame["belt speed [m/s]"].unique()):
        block = frame[frame["belt speed [m/s]"] == speed].pivot_table(
            index="temperature [degC]", columns="compound", values="motor power [kW]", sort=False
        )
        names = [compound.name for compound in comparison.compounds if compound.name in block.columns]
        # a gap in one compound's column would break its line: only rows that every compound answers
        block = block.sort_index()[names].dropna()
        put(sheet.cell(row, 1), f"{speed:g} m/s", HEADING)
        if block.empty:
            put(sheet.cell(row + 1, 1), "no temperature that every compound has an answer for", GREY)
            row += 4
            continue
        shown = block.rename(columns={name: f"{name} [kW]" for name in names}).reset_index()
        last = table(sheet, shown, row + 1, widest=24)
        if len(block) > 1:
            chart = charts.power_over_temperature(
                sheet, (row + 1, last), count=len(names), speed=speed, least=float(block.to_numpy().min())
            )
            sheet.add_chart(chart, sheet.cell(row, len(names) + 3).coordinate)
        row = max(last, row + _CHART_ROWS) + 2


def scenes(sheet: Worksheet, comparison: Comparison) -> None:
    """Every scene, one row each."""
    frame = comparison.table
    put(sheet["A1"], "Every scene that has an answer", HEADING)
    if len(frame) > MOST_ROWS:
        put(sheet["A2"], f"{len(frame)} scenes: write them with Comparison.table.to_csv or --csv", GREY)
        return
    sheet.freeze_panes = "B3"
    sheet.print_title_rows = "1:2"
    table(sheet, frame, 2, widest=_NAMES)
    sheet.auto_filter.ref = f"A2:{get_column_letter(len(frame.columns))}{2 + len(frame)}"


def coverage(sheet: Worksheet, comparison: Comparison) -> None:
    """What the rolls excite against what the data hold; scenes without an answer."""
    put(sheet["A1"], "Frequencies that hold nine tenths of the loss, against the compounds' data", HEADING)
    frame = comparing.coverage(comparison)
    last = 2 if frame.empty else table(sheet, frame, 2, widest=_NAMES)
    put(sheet.cell(last + 3, 1), "Scenes without an answer", HEADING)
    refused = comparing.refused(comparison).drop_duplicates()
    if refused.empty:
        put(sheet.cell(last + 4, 1), "none", GREY)
    else:
        table(sheet, refused, last + 4, widest=80)
    sheet.freeze_panes = "A3"


def notes(sheet: Worksheet, comparison: Comparison) -> None:
    """Remarks, and what is known of each compound."""
    put(sheet["A1"], "Remarks", HEADING)
    row = 1
    for line in comparing.remarks(comparison):
        row += 1
        sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=6)
        put(sheet.cell(row, 1), line)
        sheet.cell(row, 1).alignment = Alignment(wrap_text=True, vertical="top", indent=1)
        sheet.row_dimensions[row].height = 15.0 * -(-len(line) // _LINE)
    put(sheet.cell(row + 2, 1), "Compounds", HEADING)
    facts = pd.DataFrame(
        [
            {
                "compound": compound.name,
                "kind": compound.kind,
                "strain": compound.strain or "not stated",
                "origin": compound.source.origin,
                "licence": compound.source.licence,
                "not known": "; ".join(compound.missing) or "nothing listed",
            }
            for compound in comparison.compounds
        ]
    )
    table(sheet, facts, row + 3, widest=44)
