"""What a notebook shows of results: small tables, everything escaped, no figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from conveyor.markup import Html, element, grid, joined, listing
from conveyor.report import case_tables, comparing
from conveyor.report.checks import checks
from conveyor.report.page import number, unit_of
from conveyor.report.unit_systems import converted_figure

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies.cases import CaseStudy
    from conveyor.studies.comparison import Comparison
    from conveyor.studies.duty import DutyStudy
    from conveyor.studies.uncertainty import UncertaintyStudy

_ROWS = 40  # of a table that a notebook is shown
_SHOWN = (
    "motor power [kW]", "belt power [kW]", "effective tension [N]", "indentation [N]", "idler rotation [N]",
    "flexure [N]", "secondary [N]", "special [N]", "lift force [N]", "equivalent DIN f [-]",
    "tight side tension [N]", "slack side tension [N]", "energy [kWh/(t km)]",
)  # fmt: skip


def of_analysis(analysis: Analysis) -> Html:
    """Key figures, checks that failed, warnings."""
    system = analysis.conveyor.report.units
    figures = []
    for known in _SHOWN:
        if known in analysis.summary.index:
            name, (value,) = converted_figure(known, [float(analysis.summary[known])], system)
            figures.append((unit_of(name)[0], _with_unit(name, value)))
    found = checks(analysis, system)
    failed = [check.subject for check in found if check.verdict == "FAIL"]
    said = f"{len(failed)} of {len(found)} checks failed" + (f": {'; '.join(failed)}" if failed else "")
    return joined(
        [listing(analysis.conveyor.name, figures), element("p", said), _folded("warnings", analysis.warnings)]
    )


def of_comparison(comparison: Comparison) -> Html:
    """The ranking, and what to know of it."""
    return joined(
        [
            _table(comparison.conveyor.name, comparison.ranking),
            _folded("what to know", comparing.remarks(comparison)),
        ]
    )


def of_cases(study: CaseStudy) -> Html:
    """The cases that govern, and those without an answer."""
    refused = [f"{row.case}: {row.reason}" for row in study.refused]
    shown = _table(f"{study.conveyor.name}: load cases that govern", case_tables.governing(study))
    return joined([shown, _folded("without an answer", tuple(refused))])


def of_duty(study: DutyStudy) -> Html:
    """Sums of the year, the bars folded away."""
    figures = [
        (unit_of(str(name))[0], _with_unit(str(name), float(value)))
        for name, value in case_tables.year(study).items()
    ]
    bars = element("details", element("summary", "bars"), _table("", case_tables.duty(study)))
    return joined([listing(f"{study.conveyor.name}: the year", figures), bars])


def of_uncertainty(study: UncertaintyStudy) -> Html:
    """Bands of the motor power, and which input matters."""
    return joined(
        [
            _table(f"{study.conveyor.name}: motor power", case_tables.band(study)),
            _table("which input matters", case_tables.tornado(study)),
            _folded("notes", study.notes),
        ]
    )


def _table(caption: str, frame: pd.DataFrame) -> Html:
    rows = [
        {str(name): _cell(str(name), value) for name, value in row.items()}
        for row in frame.head(_ROWS).to_dict("records")
    ]
    return grid(caption, rows)


def _with_unit(name: str, value: float) -> str:
    return f"{number(name, value)} {unit_of(name)[1]}".rstrip()


def _cell(name: str, value: object) -> str:
    if isinstance(value, int | float):
        return "" if pd.isna(value) else number(name, value)
    return str(value)


def _folded(name: str, lines: tuple[str, ...]) -> Html:
    if not lines:
        return Html("")
    summary = element("summary", f"{name} ({len(lines)})")
    return element("details", summary, element("ul", *(element("li", line) for line in lines)))
