"""The workbook's sheets on the loop (states, drives, take-up, start and stop, belt) and on the studies of a spec."""

from __future__ import annotations

from typing import TYPE_CHECKING

from conveyor.report import charts
from conveyor.report.places import Page

if TYPE_CHECKING:
    from conveyor.analysis import Analysis

_CHART_COLUMN = "F"
_CHART_ROWS = 20
_MOST_BARS = 24
"""Bars that one chart shows legibly."""


def states(page: Page, _: Analysis) -> None:
    """Route profile beside its chart where it rises, and the tension at every place in every state of motion."""
    profile = page.place("profile", 1)
    row = profile.last + 3
    if profile.whole and page.contents["profile"].frame.iloc[:, 3].nunique() > 1:
        chart = charts.profile(page.sheet, header=profile.header, last=profile.last)
        page.sheet.add_chart(chart, f"{_CHART_COLUMN}{profile.header}")
        row = max(row, profile.header + _CHART_ROWS)
    page.place("tension_states", row)
    page.sheet.freeze_panes = "B1"


def loop(page: Page, _: Analysis) -> None:
    """Drives, take-up, start and stop, the belt, its pulleys and curves."""
    page.stacked(
        (
            "drives", "take_up", "tension_conditions", "start_stop", "belt_strength", "pulleys", "vertical_curves",
            "convergence",
        )
    )  # fmt: skip


def cases(page: Page, _: Analysis) -> None:
    """Every load case, and the case that governs each figure."""
    page.stacked(("governing_cases", "load_cases", "case_tensions", "motors", "refused_cases"))


def duty(page: Page, _: Analysis) -> None:
    """The year's histogram and its sums."""
    page.stacked(("duty_year", "duty"))


def uncertainty(page: Page, _: Analysis) -> None:
    """The power with its band, and which input matters, with its chart."""
    place = page.stacked(("power_band", "sensitivity"))["sensitivity"]
    if place.whole and place.last - place.header <= _MOST_BARS:
        columns = [str(name) for name in page.contents["sensitivity"].frame.columns]
        swing = 1 + next(j for j, name in enumerate(columns) if name.startswith("swing"))
        rows = place.header, place.last
        chart = charts.bars(page.sheet, "What the motor power swings by", rows, label=1, value=swing)
        page.sheet.add_chart(chart, f"A{place.last + 4}")
