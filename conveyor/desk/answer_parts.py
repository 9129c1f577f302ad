"""The pieces of the page, from the tables that every report is made of."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final, NamedTuple

from conveyor.assessment import Assessment
from conveyor.checks import Check
from conveyor.report.line_drawings import (
    NamedTable,
    PowerBand,
    band_chart,
    profile_chart,
    set_chart,
    share_chart,
    tension_chart,
)
from conveyor.report.merged_notes import NOTE_HEADINGS, sort_notes
from conveyor.report.page_elements import bullet_list, figure_list, table_html
from conveyor.report.set_outline import set_outlines
from conveyor.report.svg import figure_svg, stand_alone_svg
from conveyor.report.table_model import FIGURE_NAME, ROW_KIND, Column, Figure, Table
from conveyor.report.tables.analysis_contents import TABLES, AnalysisTables, analysis_drawings
from conveyor.text.markup import Html, element, join_html
from conveyor.units import System
from conveyor.units.presentation import Unit, display_unit

_VERDICTS: Final = ("FAIL", "not checked", "pass")
"""Verdicts of checks, the gravest first."""
_NEAREST: Final = 6
"""Checks that pass and are shown without unfolding: those with the least margin."""
_ROWS_SHOWN: Final = 500
"""Rows of a table by name that a page is given."""
_FIGURE: Final = "figure "
"""Before the name of a figure among those of tables."""
_ALIKE: Final = 5e-5
"""Relative difference below which two figures are written as alike [-]; reports have four digits."""
_NOT_COMPARED: Final = {"contact_error_estimate", "contact_energy_error"}
_FORCE_DIGITS: Final = ",.2f"
"""Digits of forces in kN beside each other: misalignment is a fraction of one."""


class _ComparedFigure(Figure):
    """A figure of two variants beside each other, forces in their large unit."""

    def unit(self, system: System) -> Unit:
        """Unit and digits of the figure in a system."""
        own, large = super().unit(system), display_unit(self.kind, system, large=True)
        return replace(large, digits=_FORCE_DIGITS) if self.kind == "force" and large != own else own


class NamedAssessment(NamedTuple):
    """An assessed variant, its tables, and its name on the page."""

    name: str
    rank: int
    assessment: Assessment
    tables: AnalysisTables

    @classmethod
    def of(cls, name: str, rank: int, assessment: Assessment) -> NamedAssessment:
        """Assessed variant with its tables; rank 0 for the one that is compared against, 1 for the other."""
        return cls(name, rank, assessment, AnalysisTables(assessment))


def own_load_parts(shown: NamedAssessment, beside: NamedAssessment | None = None) -> dict[str, Html]:
    """Pieces of the page that are right before the other loads are known: power, and what it is made of."""
    return {"power": power_part(shown, beside), "shares": share_part(shown.tables, shown.assessment.system)}


def answer_parts(shown: NamedAssessment, beside: NamedAssessment | None = None) -> dict[str, Html]:
    """Pieces of the page for a variant, and for one beside it, by name.

    Parameters
    ----------
    shown : NamedAssessment
        The variant that the page is about.
    beside : NamedAssessment, optional
        The one that it is compared with, in the same units.
    """
    system = shown.assessment.system
    tables = shown.tables
    parts = own_load_parts(shown, beside) | {
        "verdict": verdict_part(tables),
        "tiles": tile_part(tables, system),
        "governing": table_html(tables["governing_figures"], tables["governing_figures"].heading, system),
        "profile": profile_chart(tables["profile"], system, _table_beside(beside, "profile")),
        "tensions": tension_chart(tables["tension_states"], system, _table_beside(beside, "tension_states")),
        "sets": set_part(shown.assessment),
        "checks": check_part(tables["checks"], system),
        "notes": note_part(tables),
        "compared": Html() if beside is None else compared_part(*sorted((shown, beside), key=_rank_of)),
    }
    if beside is not None:
        parts["verdict_beside"] = verdict_part(beside.tables)
    return parts


def _table_beside(beside: NamedAssessment | None, key: str) -> NamedTable | None:
    return None if beside is None else NamedTable(beside.name, beside.tables[key])


def set_part(assessment: Assessment) -> Html:
    """Sets of both strands with belt and bulk."""
    own = assessment.own
    outlines = set_outlines(own.line, own.conveyor.material.surcharge)
    return set_chart(outlines, display_unit("size", assessment.system), own.line.belt.width)


def verdict_part(tables: Mapping[str, Table]) -> Html:
    """Verdict with the number of checks, and the sentence that says what decides it."""
    count = {word: sum(row.verdict == word for row in tables["checks"].rows) for word in _VERDICTS}
    word = "FAIL" if count["FAIL"] else "pass"
    first, _, rest = tables["governing_figures"].note.partition(":")
    facts, _, action = rest.strip().partition(". Action required")
    counted = join_html(element("span", f"{n} {word}", class_=_VERDICT_CLASS[word]) for word, n in count.items() if n)
    content = [element("p", element("strong", first), element("span", counted, class_="counts"))]
    content.append(element("p", facts[:1].upper() + facts[1:].rstrip("."), class_="why"))
    if action:
        content.append(element("p", f"Action required{action}", class_="why"))
    return element("div", *content, class_=f"stands {_VERDICT_CLASS[word]}")


_VERDICT_CLASS: Final = {"FAIL": "fail", "pass": "pass", "not checked": "open"}


def _result_figure(tables: Mapping[str, Table], key: str) -> Figure | None:
    return next((row for row in tables["results"].rows if row.key == key), None)


def _rank_of(variant: NamedAssessment) -> int:
    return variant.rank


def _band_of(variant: NamedAssessment) -> PowerBand:
    """Motor power of a variant with its range, for the drawing."""
    of = variant.assessment.power_range
    low, high = (of.low, of.high) if of.effects else (None, None)
    return PowerBand(variant.name, of.motor, low, high, variant.rank)


def power_part(shown: NamedAssessment, beside: NamedAssessment | None = None) -> Html:
    """Motor power with its band, beside that installed; of two variants on one scale."""
    unit = display_unit("power", shown.assessment.system, large=True)
    both = (shown,) if beside is None else sorted((shown, beside), key=_rank_of)
    bands = [_band_of(one) for one in both]
    drives = [drive.power for drive in shown.assessment.own.line.drives if drive.power is not None]
    installed = sum(drives) if drives else None
    _, motor, low, high, _ = _band_of(shown)
    side = -1.0 if motor < 0.0 else 1.0  # motors hold as much as they drive
    number, _, sign = unit.said(motor, 4).partition(" ")
    said = [element("p", element("b", number), " ", element("small", sign), class_="large")]
    if low is not None and high is not None:
        band = f"90 % band {unit.said(low, 3)} to {unit.said(high, 3)}"
        design = f"to design for {unit.said(shown.assessment.power_range.design, 3)}"
        said.append(element("p", band, element("br"), design, class_="note"))
    if beside is not None:
        other = beside.assessment.power_range.motor
        gap, sign = motor - other, "+" if motor >= other else "−"
        share = f", {sign}{100.0 * abs(gap / other):.1f} %" if other else ""
        said.insert(1, element("p", f"{sign}{unit.said(abs(gap), 3)}{share} against {beside.name}", class_="gap"))
    limit = "" if installed is None else f"installed {unit.said(installed, 3)}"
    label = f"Motor power {unit.said(motor, 4)}" + (f", {limit}" if limit else "")
    return join_html([
        element("h2", "Motor power, expected"),
        element("div", *said),
        band_chart(bands, None if installed is None else side * installed, unit, label, limit),
    ])  # fmt: skip


def tile_part(tables: Mapping[str, Table], system: System) -> Html:
    """Key figures beside the power."""
    rows = [row for row in tables["results"].rows if "tile" in row.on.split() and row.key != "motor_power"]
    rows += [row for row in tables["take_up"].rows if row.key in {"take_up_setting"}] if "take_up" in tables else []
    rows += [row for row in tables["results"].rows if row.key in {"belt_safety_at_start", "cost_per_year"}]
    pairs = []
    for row in rows:
        if row.value is None:
            continue
        label = "take-up setting" if row.key == "take_up_setting" else row.called(system)
        number, _, sign = display_unit(row.kind, system, large=True).said(row.value, 4).partition(" ")
        value = join_html([number, " ", element("small", sign)]) if sign else number
        pairs.append(element("div", element("dt", label), element("dd", value)))
    return element("dl", *pairs, class_="tiles")


def share_part(tables: Mapping[str, Table], system: System) -> Html:
    """Forces that make up the effective tension, as bars."""
    unit = display_unit("force", system, large=True)
    columns = {column.key: column.get for column in tables["breakdown"].columns}
    rows = [
        (str(columns["resistance"](row)).replace("_", " "), force, share)
        for row in tables["breakdown"].rows
        if (force := columns["force"](row)) and (share := columns["share_of_total"](row)) is not None
    ]
    if not rows:
        return Html()
    label = "Breakdown of the effective tension: " + ", ".join(
        f"{name} {unit.said(force, 3)}" for name, force, _ in rows
    )
    return element(
        "figure",
        element("figcaption", f"{unit.beside('what makes the effective tension')}, share"),
        share_chart(rows, unit, label),
        class_="drawn",
    )


def check_part(checks: Table, system: System) -> Html:
    """Checks, the gravest and nearest first; those with more margin are folded away."""
    order = sorted(checks.rows, key=lambda row: (_VERDICTS.index(row.verdict), row.margin is None, row.margin or 0.0))
    grave = sum(row.verdict != "pass" for row in order)
    first, folded = order[: grave + _NEAREST], order[grave + _NEAREST :]
    caption = "Worst of all loads first; margin: reserve over the limit"
    parts = [table_html(replace(checks, rows=tuple(first)), caption, system, kind="checks")]
    if folded:
        more = f"{len(folded)} more that pass with more margin"
        rest = table_html(replace(checks, rows=tuple(folded)), more, system, kind="checks")
        parts.append(element("details", element("summary", more), rest))
    return join_html(parts)


def note_part(tables: Mapping[str, Table]) -> Html:
    """Warnings in two groups, and the default to replace first."""
    lines = [row.text for row in tables["remarks"].rows if row.kind == "warning"] if "remarks" in tables else []
    grouped = zip(NOTE_HEADINGS, sort_notes(lines), strict=True)
    shown = [
        element("details", element("summary", f"{heading.capitalize()} ({len(lines)})"), bullet_list(lines))
        for heading, lines in grouped
        if lines
    ]
    if "defaults" in tables:
        shown.insert(0, element("p", tables["defaults"].note, class_="note"))
    return join_html(shown)


def compared_part(first: NamedAssessment, second: NamedAssessment) -> Html:
    """Differences of two variants: figures, then checks with another verdict."""
    system = second.assessment.system
    figures, alike = _compared_figures(first, second)
    changed = _changed_checks(first, second, system)
    caption = f"{second.name} against {first.name}" + (f"; {alike} figures are alike" if alike else "")
    parts = [table_html(figures, caption, system) if figures.rows else element("p", "Every figure is alike.")]
    if changed.rows:
        parts.append(table_html(changed, "Checks with another verdict", system, kind="checks"))
    else:
        parts.append(element("p", "No check changes its verdict.", class_="note"))
    return join_html(parts)


def _compared_figures(first: NamedAssessment, second: NamedAssessment) -> tuple[Table, int]:
    """Figures that differ, and how many do not."""
    rows, alike, above = list[Figure](), 0, set[tuple[str, str, str]]()
    for key in ("results", "take_up"):
        others = {row.key: row for row in second.tables[key].rows} if key in second.tables else {}
        for row in first.tables[key].rows if key in first.tables else ():
            other = others.get(row.key)
            if row.key in _NOT_COMPARED or other is None or other.kind != row.kind:
                continue
            one, two = row.value, other.value
            if not (isinstance(one, float) and isinstance(two, float)):
                continue
            if abs(two - one) <= _ALIKE * max(abs(one), abs(two)):
                alike += 1
                continue
            pair = row.kind, f"{one:.5g}", f"{two:.5g}"
            if pair in above:  # as the mains power of a drive without losses, or the setting that is required
                continue
            above.add(pair)
            change = None if one == 0.0 else (two - one) / abs(one)
            label = f"take-up, {row.label}" if key == "take_up" else row.label
            rows.append(_ComparedFigure(label, row.kind, (one, two, two - one, change), key=row.key))
    columns = (
        Column("figure", FIGURE_NAME, "label"),
        Column(first.name, ROW_KIND, "value.0", key="first"),
        Column(second.name, ROW_KIND, "value.1", key="second"),
        Column("difference", ROW_KIND, "value.2"),
        Column("change", "share", "value.3"),
    )
    return Table("compared", "", "Differences", columns, tuple(rows)), alike


def _changed_checks(first: NamedAssessment, second: NamedAssessment, system: System) -> Table:
    """Checks that have another verdict in the second variant."""

    def by_subject(of: NamedAssessment) -> dict[tuple[str, str], Check]:
        return {(check.key, check.subject.text(system)): check for check in of.assessment.governing}

    one, two = by_subject(first), by_subject(second)
    rows = tuple(
        (two.get(key) or one[key], one.get(key), two.get(key))
        for key in dict.fromkeys((*one, *two))
        if (None if key not in one else one[key].verdict) != (None if key not in two else two[key].verdict)
    )
    columns = (
        Column("check", "text", lambda row: row[0].name.text(system)),
        Column(first.name, "verdict", lambda row: None if row[1] is None else row[1].verdict, key="first"),
        Column(second.name, "verdict", lambda row: None if row[2] is None else row[2].verdict, key="second"),
        Column("calculated", "text", lambda row: row[0].found.text(system), key="found"),
        Column("required", "text", lambda row: row[0].asked.text(system), key="asked"),
    )
    return Table("changed_checks", "", "Changed checks", columns, rows)


def table_names(assessment: Assessment) -> list[tuple[str, str]]:
    """Names of the tables that have rows and of the report's figures, and their headings."""
    tables = AnalysisTables(assessment)
    figures = [(f"{_FIGURE}{one.name}", f"figure: {one.name}") for one in analysis_drawings(assessment)]
    return [*((key, tables[key].heading or key.replace("_", " ")) for key in tables), *figures]


def named_figure(assessment: Assessment, key: str) -> Html | None:
    """One figure of the report by its name, as an image: the page allows no styles inside itself; None without it."""
    drawing = next((one for one in analysis_drawings(assessment) if key == f"{_FIGURE}{one.name}"), None)
    if drawing is None:
        return None
    drawn = stand_alone_svg(figure_svg(drawing.draw(), drawing.name, drawing.caption))
    source = f"data:image/svg+xml;base64,{base64.b64encode(drawn.encode()).decode()}"
    return element("figure", element("img", src=source, alt=drawing.caption), element("figcaption", drawing.caption))


def named_table(assessment: Assessment, key: str, *, most: int | None = None) -> Html | None:
    """One table by its name as in workbooks; None where there is none, or where it has more rows than `most`."""
    tables = AnalysisTables(assessment)
    if key not in TABLES or key not in tables:
        return None
    table = tables[key]
    if most is not None and len(table.rows) > most:
        return None
    cut = replace(table, rows=table.rows[:_ROWS_SHOWN], foot="" if len(table.rows) > _ROWS_SHOWN else table.foot)
    cut = cut.on_sheet() if cut.sheet else cut
    write = figure_list if cut.figures else table_html
    parts: list[Any] = [write(cut, table.heading, assessment.system)]
    if len(table.rows) > _ROWS_SHOWN:
        parts.append(element("p", f"first {_ROWS_SHOWN} of {len(table.rows):,} rows; all are in the workbook"))
    if table.note:
        parts.append(element("p", table.note, class_="note"))
    return join_html(parts)
