"""The workbook's sheets on the loop (drives, take-up, start and stop, belt) and on the studies a spec asks for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report import case_tables, charts, loop_tables
from conveyor.report.cells import GREY, HEADING, put, table

if TYPE_CHECKING:
    from collections.abc import Iterable

    from conveyor.analysis import Analysis
    from conveyor.cases import CaseStudy
    from conveyor.duty import DutyStudy
    from conveyor.uncertainty import UncertaintyStudy

_NAMES = 46  # characters of a name on one line
_CHART_ROWS = 20


def _stacked(sheet: Worksheet, parts: Iterable[tuple[str, pd.DataFrame]]) -> dict[str, tuple[int, int]]:
    """Tables under one another, each under its heading; empty ones left out. Header and last row of each."""
    row, places = 1, {}
    for heading, frame in parts:
        if frame.empty:
            continue
        put(sheet.cell(row, 1), heading, HEADING)
        by_row = "quantity" if list(frame.columns) == ["quantity", "value"] else ""
        last = table(sheet, frame, row + 1, widest=_NAMES, by_row=by_row)
        places[heading] = row + 1, last
        row = last + 3
    sheet.freeze_panes = "B1"
    return places


def _listed(figures: pd.Series) -> pd.DataFrame:
    return figures.rename_axis("quantity").rename("value").reset_index()


def loop(sheet: Worksheet, analysis: Analysis) -> None:
    """Drives, take-up, start and stop, the belt, its pulleys and curves."""
    found, duty = analysis.balance, analysis.belt_duty
    _stacked(
        sheet,
        (
            ("Drives in every state of motion", loop_tables.drives(found)),
            ("Take-up", _listed(loop_tables.take_up(found))),
            ("What asks for the tension", loop_tables.conditions(found)),
            ("Start and stop", _listed(loop_tables.start_stop(analysis.motions))),
            ("Strength of the belt", _listed(loop_tables.belt(duty))),
            ("Pulleys", loop_tables.pulleys(duty)),
            ("Vertical curves", loop_tables.curves(duty)),
            ("How tensions and roll loads settled", _listed(loop_tables.convergence(analysis.convergence))),
        ),
    )


def states(sheet: Worksheet, analysis: Analysis) -> None:
    """Route profile, and the tension at every place in every state of motion."""
    places = _stacked(
        sheet,
        (
            ("Profile of the route", loop_tables.profile(analysis.conveyor)),
            (
                "Tension in every state of motion",
                loop_tables.tension_states(analysis.balance, analysis.motions),
            ),
        ),
    )
    header, last = places["Profile of the route"]
    sheet.add_chart(charts.profile(sheet, header=header, last=last), f"M{header}")


def cases(sheet: Worksheet, study: CaseStudy) -> None:
    """Every load case, and the case that governs each figure."""
    places = _stacked(
        sheet,
        (
            ("Governing cases", case_tables.governing(study)),
            ("Load cases", case_tables.cases(study)),
            ("Motors of the series", case_tables.motors(study.motors())),
            ("Cases without an answer", case_tables.refused_cases(study)),
        ),
    )
    low, high = study.friction_band
    row = max(last for _, last in places.values()) + 2
    put(
        sheet.cell(row, 1),
        f"governing figures take friction between {low:g} and {high:g} of the computed one, to the safe side",
        GREY,
    )


def duty(sheet: Worksheet, study: DutyStudy) -> None:
    """The year's histogram and its sums."""
    _stacked(
        sheet,
        (
            ("The year", _listed(case_tables.year(study))),
            ("Hours at load, temperature and speed", case_tables.duty(study)),
        ),
    )


def uncertainty(sheet: Worksheet, study: UncertaintyStudy) -> None:
    """The power with its band, and which input matters."""
    places = _stacked(
        sheet,
        (
            ("Motor power with its band", case_tables.band(study)),
            ("Which input matters", case_tables.tornado(study)),
        ),
    )
    row = max(last for _, last in places.values()) + 2
    for note in study.notes:
        put(sheet.cell(row, 1), note, GREY)
        row += 1
