"""What a notebook shows of results: small tables, everything escaped, no figures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from conveyor.markup import Html, element, grid, joined, listing
from conveyor.report.columns import NAMED, Column, Contents, Figure, Table
from conveyor.units import System
from conveyor.units.presentation import headed

_ROWS = 40  # of a table that a notebook is shown


def of_analysis(contents: Contents) -> Html:
    """Key figures, checks that failed, warnings."""
    checks = contents["checks"].rows
    failed = [check.subject for check in checks if check.verdict == "FAIL"]
    said = f"{len(failed)} of {len(checks)} checks failed" + (f": {'; '.join(failed)}" if failed else "")
    figures = _figures(contents.marked("notebook"), contents.system)
    known = [listing(contents.document.title, figures), element("p", said)]
    if "defaults" in contents:
        known.append(element("p", contents["defaults"].note))
    return joined([*known, folded("warnings", contents.lines("warning"))])


def of_figures(shown: Table, caption: str, system: System) -> Html:
    """Figures with their units."""
    return listing(caption, _figures(shown.rows, system))


def of_table(shown: Table, caption: str, system: System) -> Html:
    """The first rows of a table, units in its header."""
    columns = [column for column in shown.columns if column.sheet]
    rows = [
        {shown.name(column, system): _cell(shown, column, row, system) for column in columns}
        for row in shown.rows[:_ROWS]
    ]
    return grid(caption, rows)


def _cell(shown: Table, column: Column, row: Any, system: System) -> str:
    if column.kind == NAMED:
        return headed(row.called(system), row.kind, system)
    return shown.unit(column, row, system).written(column.value(row))


def _figures(figures: Iterable[Figure], system: System) -> list[tuple[str, str]]:
    return [(figure.called(system), figure.unit(system).said(figure.value)) for figure in figures]


def folded(name: str, lines: Sequence[object]) -> Html:
    """Lines folded away under their name and number; nothing of none."""
    if not lines:
        return Html("")
    summary = element("summary", f"{name} ({len(lines)})")
    return element("details", summary, element("ul", *(element("li", line) for line in lines)))
