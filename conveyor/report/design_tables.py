"""Tables and figures of a study's designs, declared once; its plain numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from conveyor.report.columns import Column, Contents, Drawing, OnPage, Table
from conveyor.report.design_plots import Shown
from conveyor.report.point_tables import priced
from conveyor.report.tables import document, provenance
from conveyor.spec import fingerprint
from conveyor.units import System

if TYPE_CHECKING:
    from conveyor.models.study import Limit
    from conveyor.studies.designs import Design
    from conveyor.studies.evaluation import Explored

PARTS: Final = (
    ("best", "The best designs"),
    ("front", "Front"),
    ("effects", "Main effects"),
    ("map", "The two fields that matter most"),
    ("lines", "All designs"),
    ("refused", "Without an answer"),
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
_MOST: Final = 50  # rows of the front on the page


def of_study(study: Explored, system: System) -> Contents:
    """Contents of the report of a study's designs in a unit system."""
    parts = (
        best(study),
        on_the_front(study),
        effects(study),
        refused(study),
        provenance(fingerprint(study.base), "Notes"),
    )
    facts = (
        ("study", study.plan.name),
        ("designs", f"{study.count:,}, {int(study.keeps.sum()):,} of them keep the limits"),
        ("states of each", f"{max(len(study.plan.rows), 1):,}"),
        ("sought", _order(study)),
        (
            "limits",
            "; ".join(_limit(study.figures[name].label, one) for name, one in study.plan.limits.items())
            or "none",
        ),
    )
    about = document(study.base, "Study of designs", system, facts)
    drawn: tuple[Drawing, ...] = ()
    if len(study.values):
        every = Shown(study, system).every
        drawn = tuple(Drawing(key, _CAPTIONS[key], draw, key) for key, draw in every.items())
    return Contents(about, parts, system, drawn, PARTS)


def _order(study: Explored) -> str:
    """Order of the designs in words."""
    name, direction = next(iter(study.sought.items()))
    first = "those that keep the limits first, then " if study.plan.limits else ""
    return f"{first}the {direction} {study.figures[name].label}"


def _limit(label: str, limit: Limit) -> str:
    ends = ((limit.least, "at least"), (limit.most, "at most"))
    return f"{label} " + " and ".join(f"{words} {end}" for end, words in ends if end is not None)


def best(study: Explored) -> Table:
    """Best designs, one row each."""
    columns = (
        Column("design", "count", "number"),
        *(Column(field.label, "text", _change(field.path), key=field.path) for field in study.fields),
        *(
            Column(figure.label, priced(figure.kind, study.currency), _figure(name), key=name)
            for name, figure in study.figures.items()
        ),
        Column("breaks", "text", lambda row: ", ".join(row.broken) or None, sparse=True),
    )
    heading = f"The best {len(study.best)}: {_order(study)}"
    return Table("best", "Best", heading, columns, study.best, "best")


def _change(path: str) -> Callable[[Design], str]:
    return lambda row: str(row.changes[path])


def _figure(name: str) -> Callable[[Design], float | None]:
    return lambda row: row.figures[name]  # not by a path: a percentile may have a point


def on_the_front(study: Explored) -> Table:
    """Pareto-optimal designs, one row each; no rows for a single objective."""
    several = len(study.sought) > 1
    rows = [int(i) for i in study.front.nonzero()[0]] if several else []
    rows.sort(key=lambda i: float(study.costs[i, 0]))
    columns = (
        Column("design", "count", lambda i: int(study.numbers[i])),
        *(
            Column(field.label, "text", _value(study, k), key=field.path)
            for k, field in enumerate(study.fields)
        ),
        *(
            Column(
                study.figures[name].label,
                priced(study.figures[name].kind, study.currency),
                _sought(study, k),
                key=name,
            )
            for k, name in enumerate(study.sought)
        ),
    )
    heading = "Pareto-optimal designs" + (f", the first {_MOST}" if len(rows) > _MOST else "")
    return Table("front", "Front", heading, columns, tuple(rows[:_MOST]), "front")


def _value(study: Explored, k: int) -> Callable[[int], str]:
    return lambda i: study.fields[k].said(float(study.values[i, k]))


def _sought(study: Explored, k: int) -> Callable[[int], float]:
    return lambda i: float(study.found[i, k])


def effects(study: Explored) -> Table:
    """Main effect of each field on the first objective, one row per field and value."""
    rows = (
        [(study.fields[k].path, effect) for k in study.ordered for effect in study.effects(k)]
        if len(study.values)
        else []
    )
    figure = study.figures[next(iter(study.sought))]
    kind = priced(figure.kind, study.currency)
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
        "effects", "Effects", heading, columns, rows, (OnPage("effects", heading, printed=False),), named=2
    )


def refused(study: Explored) -> Table:
    """Reasons for designs without a solution, and their counts."""
    columns = (Column("designs", "count", "1"), Column("no answer because", "text", "0"))
    heading = "Designs without an answer"
    return Table("refused", "Refused", heading, columns, tuple(study.refused.items()), "refused")


def plain(study: Explored) -> dict[str, Any]:
    """Plain numbers for JSON; SI, the unit in the key."""
    table = replace(best(study), page=())
    front = study.numbers[study.front].tolist()
    return {
        "designs": study.count,
        "keep_the_limits": int(study.keeps.sum()),
        "best": table.records(),
        "front": front,
    }
