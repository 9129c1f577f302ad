"""What a notebook shows of results: small tables, everything escaped, no figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from conveyor.markup import Html, element, grid, joined, listing
from conveyor.report import comparing
from conveyor.report.checks import checks
from conveyor.report.page import number, unit_of

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.comparison import Comparison

_ROWS = 40  # of a table that a notebook is shown
_SHOWN = (
    "motor power [kW]", "belt power [kW]", "effective tension [N]", "indentation [N]", "idler rotation [N]",
    "flexure [N]", "secondary [N]", "special [N]", "lift force [N]", "equivalent DIN f [-]",
    "tight side tension [N]", "slack side tension [N]", "energy [kWh/(t km)]",
)  # fmt: skip


def of_analysis(analysis: Analysis) -> Html:
    """Key figures, checks that failed, warnings."""
    figures = [
        (unit_of(name)[0], _with_unit(name, float(analysis.summary[name])))
        for name in _SHOWN
        if name in analysis.summary.index
    ]
    found = checks(analysis)
    failed = [check.subject for check in found if check.verdict == "FAIL"]
    said = f"{len(failed)} of {len(found)} checks failed" + (f": {'; '.join(failed)}" if failed else "")
    return joined(
        [listing(analysis.conveyor.name, figures), element("p", said), _folded("warnings", analysis.warnings)]
    )


def of_comparison(comparison: Comparison) -> Html:
    """The ranking, and what to know of it."""
    frame = comparison.ranking.head(_ROWS)
    rows = [
        {str(name): _cell(str(name), value) for name, value in row.items()}
        for row in frame.to_dict("records")
    ]
    return joined(
        [grid(comparison.conveyor.name, rows), _folded("what to know", comparing.remarks(comparison))]
    )


def _with_unit(name: str, value: float) -> str:
    return f"{number(name, value)} {unit_of(name)[1]}".rstrip()


def _cell(name: str, value: object) -> str:
    if isinstance(value, int | float):
        return "" if pd.isna(value) else number(name, value)
    return str(value)


def _folded(name: str, lines: tuple[str, ...]) -> Html:
    summary = element("summary", f"{name} ({len(lines)})")
    return element("details", summary, element("ul", *(element("li", line) for line in lines)))
