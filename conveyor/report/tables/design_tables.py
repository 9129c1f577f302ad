"""Tables and figures of a study's designs, declared once; its plain numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from conveyor.remarks.assumptions import failed_fits, stepped_drags
from conveyor.report.design_plots import DesignPlots
from conveyor.report.point_tables import money_kind
from conveyor.report.table_model import Column, Contents, Drawing, PagePlacement, Table, remark_table
from conveyor.report.tables.document_tables import provenance_table, report_head
from conveyor.spec import fingerprint
from conveyor.units import System

if TYPE_CHECKING:
    from conveyor.models.study import Limit
    from conveyor.studies.design_figures import Design
    from conveyor.studies.evaluation import StudySummary

PARTS: Final = (
    ("best", "The best designs"),
    ("front", "Front"),
    ("effects", "Main effects"),
    ("map", "The two fields that matter most"),
    ("lines", "All designs"),
    ("refused", "Without an answer"),
    ("remarks", "Remarks"),
    ("provenance", "Provenance"),
)
"""Parts of the page."""
_CAPTIONS: Final = {
    "front": "Every design by the first two figures that are sought; of those that keep the limits none beats "
    "the joined ones in both. Numbers are those of the designs.",
    "effects": "Mean of what is sought first over all other fields, at each value of a field; shaded from the least to "
    "the most of any design. The field that matters most comes first. Bars, where fields are drawn: two standard "
    "errors of the mean to both sides.",
    "map": "Best over all other fields at each pair of values, of designs that keep the limits; in brackets where none "
    "does.",
    "lines": "A line a design, light where what is sought first is best; grey do not keep the limits.",
}
_FRONT_ROWS: Final = 50  # rows of the front on the page


def _study_warnings(study: StudySummary) -> list[str]:
    """Compounds whose fit fails, and varied diameters that change the drag of rolls in steps."""
    return [*failed_fits(study.compounds), *stepped_drags(study.base, study.plan.paths)]


def study_contents(study: StudySummary, system: System) -> Contents:
    """Contents of the report of a study's designs in a unit system."""
    parts = (
        best_designs(study),
        pareto_front(study),
        effect_table(study),
        refused_designs(study),
        remark_table({"warning": _study_warnings(study)}, "Notes", page="remarks"),
        provenance_table(fingerprint(study.base), "Notes"),
    )
    facts = (
        ("study", study.plan.name),
        ("designs", f"{study.count:,}, {int(study.keeps.sum()):,} of them keep the limits"),
        ("states of each", f"{max(len(study.plan.rows), 1):,}"),
        ("sought", _order_text(study)),
        (
            "limits",
            "; ".join(_limit_text(study.figures[name].label, one) for name, one in study.plan.limits.items()) or "none",
        ),
    )
    about = report_head(study.base, "Study of designs", system, facts, named=(study.plan,))
    drawn: tuple[Drawing, ...] = ()
    if len(study.values):
        every = DesignPlots(study, system).every
        drawn = tuple(Drawing(key, _CAPTIONS[key], draw, key) for key, draw in every.items())
    return Contents.of(about, parts, system, drawings=drawn, page=PARTS)


def _order_text(study: StudySummary) -> str:
    """Order of the designs in words."""
    name, direction = next(iter(study.objectives.items()))
    first = "those that keep the limits first, then " if study.plan.limits else ""
    return f"{first}the {direction} {study.figures[name].label}"


def _limit_text(label: str, limit: Limit) -> str:
    ends = ((limit.least, "at least"), (limit.most, "at most"))
    return f"{label} " + " and ".join(f"{words} {end}" for end, words in ends if end is not None)


def best_designs(study: StudySummary) -> Table:
    """Best designs, one row each."""
    columns = (
        Column("design", "count", "number"),
        *(Column(field.label, "text", _change_getter(field.path), key=field.path) for field in study.fields),
        *(
            Column(figure.label, money_kind(figure.kind, study.currency), _figure_getter(name), key=name)
            for name, figure in study.figures.items()
        ),
        Column("breaks", "text", lambda row: ", ".join(row.broken) or None, sparse=True),
    )
    heading = f"The best {len(study.best)}: {_order_text(study)}"
    return Table("best", "Best", heading, columns, study.best, "best")


def _change_getter(path: str) -> Callable[[Design], str]:
    return lambda row: str(row.changes[path])


def _figure_getter(name: str) -> Callable[[Design], float | None]:
    return lambda row: row.figures[name]  # not by a path: a percentile may have a point


def pareto_front(study: StudySummary) -> Table:
    """Pareto-optimal designs, one row each; no rows for a single objective."""
    several = len(study.objectives) > 1
    rows = [int(i) for i in study.front.nonzero()[0]] if several else []
    rows.sort(key=lambda i: float(study.costs[i, 0]))
    columns = (
        Column("design", "count", lambda i: int(study.numbers[i])),
        *(Column(field.label, "text", _value_getter(study, k), key=field.path) for k, field in enumerate(study.fields)),
        *(
            Column(
                study.figures[name].label,
                money_kind(study.figures[name].kind, study.currency),
                _objective_getter(study, k),
                key=name,
            )
            for k, name in enumerate(study.objectives)
        ),
    )
    heading = "Pareto-optimal designs" + (f", the first {_FRONT_ROWS}" if len(rows) > _FRONT_ROWS else "")
    return Table("front", "Front", heading, columns, tuple(rows[:_FRONT_ROWS]), "front")


def _value_getter(study: StudySummary, k: int) -> Callable[[int], str]:
    return lambda i: study.fields[k].said(float(study.values[i, k]))


def _objective_getter(study: StudySummary, k: int) -> Callable[[int], float]:
    return lambda i: float(study.found[i, k])


def effect_table(study: StudySummary) -> Table:
    """Main effect of each field on the first objective, one row per field and value."""
    rows = (
        [(study.fields[k].path, effect) for k in study.ordered for effect in study.effects(k)]
        if len(study.values)
        else []
    )
    figure = study.figures[next(iter(study.objectives))]
    kind = money_kind(figure.kind, study.currency)
    told = {"mean": "mean", "least": "least", "most": "most"}
    if study.plan.drawn:
        told["error"] = "standard error of the mean"
    columns = (
        Column("field", "text", "0"),
        Column("value", "text", "1.value"),
        Column("designs", "count", "1.count"),
        *(Column(f"{figure.label}, {words}", kind, f"1.{get}", key=get) for get, words in told.items()),
    )
    heading = "Effect of each field"
    return Table(
        "effects",
        "Effects",
        heading,
        columns,
        rows,
        (PagePlacement("effects", heading, printed=False),),
        named=2,
    )


def refused_designs(study: StudySummary) -> Table:
    """Reasons for designs without a solution, and their counts."""
    columns = (Column("designs", "count", "1"), Column("no answer because", "text", "0"))
    heading = "Designs without an answer"
    return Table("refused", "Refused", heading, columns, tuple(study.refused.items()), "refused")


def study_json(study: StudySummary) -> dict[str, Any]:
    """Plain numbers for JSON; SI, the unit in the key."""
    table = replace(best_designs(study), page=())
    front = study.numbers[study.front].tolist()
    return {
        "designs": study.count,
        "keep_the_limits": int(study.keeps.sum()),
        "best": table.records(),
        "front": front,
    }
