"""What `conveyor compare` shows: the ranking, and what to know of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from conveyor.cli import notes
from conveyor.cli.terminal import console, table, words
from conveyor.units.presentation import Unit, unit

if TYPE_CHECKING:
    from conveyor.report.columns import Contents, Table
    from conveyor.units import System

Row = Any


def show(contents: Contents) -> None:
    """Print the ranking and its remarks."""
    facts = dict(contents.document.facts)
    title = f"{contents.document.title}: {facts['cover']} cover, against {facts['savings against']}"
    ranked, made = contents["ranking"], table(title)
    columns = _columns(ranked, contents.by_key.get("costs"), contents.system)
    for heading in columns:
        made.add_column(words(heading), justify="left" if heading == "compound" else "right", no_wrap=True)
    for row in ranked.rows:
        made.add_row(*(words(shown(row)) for shown in columns.values()))
    screen = console()
    screen.print(made)
    notes.show(screen, contents.lines("warning"))


def _columns(ranked: Table, costs: Table | None, system: System) -> dict[str, Callable[[Row], str]]:
    """Headings and what stands under them, of what the ranking knows."""
    power, speed, warmth = (unit(kind, system, large=True) for kind in ("power", "speed", "temperature"))

    def band(row: Row) -> str:
        return (
            ""
            if row.low is None or row.high is None
            else f"{_number(power, row.low)}-{_number(power, row.high)}"
        )

    columns: dict[str, Callable[[Row], str]] = {"compound": lambda row: str(row.compound)}
    if len({row.speed for row in ranked.rows}) > 1:
        columns[speed.sign] = lambda row: f"{speed.shown(row.speed):.4g}"
    columns[_over("mean", power)] = lambda row: _number(power, row.motor)
    if any(row.low is not None for row in ranked.rows):
        columns[_over("90 % band", power)] = band
    columns["change"] = lambda row: "" if row.change is None else f"{100.0 * row.change:+.1f} %"
    columns[_over("peak", power)] = lambda row: _number(power, row.peak)
    columns[_over("at", warmth)] = lambda row: (
        "" if row.temperature is None else f"{warmth.shown(row.temperature):g}"
    )
    saved = [] if costs is None else [column for column in costs.columns if column.key == "saving_per_year"]
    if saved:
        money = unit(saved[0].kind, system)
        columns[_over("saved/a", money)] = lambda row: _number(money, row.saving)
    if any(row.payback is not None for row in ranked.rows):
        years = unit("years", system)
        columns[_over("payback", years)] = lambda row: _number(years, row.payback)
    return columns


def _over(words: str, written: Unit) -> str:
    return f"{words}\n[{written.sign}]"


def _number(written: Unit, given: float | None) -> str:
    if given is None:
        return ""
    value = written.shown(given)
    if math.isinf(value):
        return written.written(given)
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.1f}"
