"""Tables of a comparison of compounds, declared once; its ranking and notes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from conveyor.report import plots
from conveyor.report.json_keys import (
    VERSION_KEY,
    JsonList,
    JsonObject,
    describe_value,
    number_key,
    number_list,
    table_rows,
    text_key,
    text_list,
)
from conveyor.report.page_elements import notebook_html
from conveyor.report.table_model import Column, Contents, Drawing, PagePlacement, Remark, Table
from conveyor.report.tables.comparison_notes import comparison_notes, ranking_changes
from conveyor.report.tables.document_tables import provenance_table, report_head
from conveyor.report.tables.ranking_tables import (
    COMPOUND,
    COSTS,
    PAPER_VIEW,
    SPEED,
    RankedCompound,
    cost_table,
    kwh_in_joules,
    money_kind,
    ranking_table,
    what_if_table,
)
from conveyor.report.tables.rubber_tables import band_columns
from conveyor.spec import fingerprint
from conveyor.text.markup import Html
from conveyor.units import System
from conveyor.units.presentation import display_unit
from conveyor.units.sentences import degree_signs, to_celsius

if TYPE_CHECKING:
    from conveyor.studies.comparison import CalculatedComparison, ComparedScene

PARTS: Final = (
    ("ranking", "Ranking"),
    ("warnings", "Action required, basis and limitations"),
    ("power", "Power"),
    ("loss-tangents", "Loss tangents"),
    ("coverage", "Coverage of the data"),
    ("scenes", "Every scene"),
    ("refused", "Without an answer"),
)
"""Parts of the page."""
_TEMPERATURE = Column("temperature", "temperature", "temperature")


def comparison_contents(comparison: CalculatedComparison, system: System) -> Contents:
    """Contents of the comparison report in a unit system."""
    ranked, every = ranking_table(comparison), scene_table(comparison)
    parts = (
        replace(ranked, columns=tuple(c for c in ranked.columns if c.key not in COSTS)),
        cost_table(ranked),
        what_if_table(comparison),
        *power_tables(comparison, system),
        every,
        coverage_table(comparison),
        refused_scenes(comparison),
        comparison_remarks(comparison, system),
        compound_table(comparison),
        provenance_table(fingerprint(comparison.conveyor), "Notes"),
    )
    facts = (
        ("compounds", ", ".join(compound.name for compound in comparison.compounds)),
        ("savings against", comparison.base),
        ("cover", comparison.cover),
        *(
            (
                f"belt {name}s",
                _value_range([getattr(scene, name) for scene in comparison.scenes], name, system),
            )
            for name in ("temperature", "speed")
        ),
    )
    about = report_head(comparison.conveyor, "Comparison of belt covers", system, facts, named=comparison.compounds)
    drawn = tuple(comparison_drawings(comparison, system))
    return Contents.of(about, parts, system, drawings=drawn, page=PARTS, layout="comparison")


def _value_range(values: list[float], kind: str, system: System) -> str:
    ends = [display_unit(kind, system).said(value, 4) for value in (min(values), max(values))] if values else []
    return " to ".join(dict.fromkeys(ends)) or "none answered"


def scene_table(comparison: CalculatedComparison) -> Table:
    """One row per scene, by compound, speed and temperature; no cost where the rubber data do not reach."""
    money = money_kind(comparison)
    covered = {_scene_key(scene) for scene in comparison.covered}

    def known(row: ComparedScene, figure: float | None) -> float | None:
        return figure if _scene_key(row) in covered else None

    columns = (
        COMPOUND,
        _TEMPERATURE,
        SPEED,
        Column("indentation", "force", "indentation"),
        Column("effective tension", "force", "effective", None),
        Column("equivalent DIN f", "friction", "friction_factor"),
        Column("motor power", "power", "motor"),
        Column("motor power, low", "power", "motor_low"),
        Column("motor power, high", "power", "motor_high"),
        Column("largest tension", "force", "largest_tension", None),
        Column("energy", "specific energy", "energy_per_tonne_km", sparse=True),
        Column("energy per year", "energy", lambda row: kwh_in_joules(known(row, row.energy_per_year)), None,
        sparse=True),
        Column("cost per year", money, lambda row: known(row, row.cost_per_year), None, sparse=True),
        Column("error estimate", "error", "error", None),
        Column("covered", "verdict", lambda row: "yes" if _scene_key(row) in covered else "NO"),
    )  # fmt: skip
    page = (PagePlacement("scenes", "One row a compound, speed and temperature"),)
    return Table("scenes", "Scenes", "Every scene that has an answer", columns, comparison.scenes, page)


def _scene_key(scene: ComparedScene) -> tuple[str, float, float]:
    """Sort key of a scene."""
    return scene.compound, scene.speed, scene.temperature


def coverage_table(comparison: CalculatedComparison) -> Table:
    """Excitation band of the rolls and data range of each compound at each temperature."""
    columns = (
        COMPOUND,
        _TEMPERATURE,
        *(
            replace(column, page=PAPER_VIEW if column.page is None else column.page)
            for column in band_columns("excited", "data")
        ),
        Column("covered", "verdict", lambda row: "yes" if row.covered else "NO"),
    )
    heading = "90 % loss band of the rolls against the data of the compounds"
    page = (PagePlacement("coverage", "Excitation band of the rolls, and range of the data"),)
    note = "NO: the excitation band reaches beyond the data."
    return Table("coverage", "Coverage", heading, columns, comparison.coverage, page, note)


def refused_scenes(comparison: CalculatedComparison) -> Table:
    """Scenes without a solution, with the reason."""
    columns = (
        COMPOUND,
        _TEMPERATURE,
        SPEED,
        Column("reason", "text", lambda row: degree_signs(row.reason)),
    )
    heading, rows = "Scenes without an answer", tuple(dict.fromkeys(comparison.refused))
    return Table("refused", "Coverage", heading, columns, rows, "refused")


def power_tables(comparison: CalculatedComparison, system: System) -> Iterator[Table]:
    """Motor power over temperature, one column per compound, one table per speed.

    Cells without a solution, or beyond the data, are empty: lines of charts break there.
    """
    for number, speed in enumerate(sorted({scene.speed for scene in comparison.scenes}), start=1):
        at = [scene for scene in comparison.covered if scene.speed == speed]
        names = [c.name for c in comparison.compounds if any(scene.compound == c.name for scene in at)]
        power = {(scene.compound, scene.temperature): scene.motor for scene in at}
        rows = tuple(sorted({scene.temperature for scene in at}))
        columns = (
            Column("temperature", "temperature", lambda t: t),
            *(Column(name, "power", _power_getter(name, power)) for name in names),
        )
        said = display_unit("speed", system).said(speed, 4)
        yield Table(f"power_{number}", "Power", f"Motor power over temperature at {said}", columns, rows, note=said)


def _power_getter(name: str, powers: dict[tuple[str, float], float]) -> Any:
    return lambda temperature: powers.get((name, temperature))


def compound_table(comparison: CalculatedComparison) -> Table:
    """Kind, origin and gaps of the data of each compound."""
    columns = (
        Column("compound", "text", "name"),
        Column("kind", "text", "kind"),
        Column("strain", "text", lambda compound: compound.strain or "not stated"),
        Column("origin", "text", lambda c: degree_signs(c.source.origin)),
        Column("licence", "text", "source.licence"),
        Column("unknown", "text", lambda c: degree_signs("; ".join(c.missing)) or "nothing listed"),
    )
    return Table("compounds", "Notes", "Compounds", columns, comparison.compounds)


def comparison_remarks(comparison: CalculatedComparison, system: System) -> Table:
    """Table of the notes of a comparison."""
    columns = (Column("remark", "text", "text"),)
    rows = tuple(Remark("warning", line) for line in comparison_notes(comparison, system))
    return Table("remarks", "Notes", "Remarks", columns, rows)


def comparison_drawings(comparison: CalculatedComparison, system: System) -> Iterator[Drawing]:
    """Drawings of the page."""
    if not comparison.scenes:
        return
    ranked = [row for row in ranking_table(comparison).rows if row.change is not None]
    if len(ranked) > 1:
        shown = [(_compound_label(row, comparison, system), row.change, row.band) for row in ranked]
        yield Drawing(
            "differences",
            f"Difference of the mean motor power to {comparison.base} and its 90 % interval: one that holds 0 tells "
            "nothing apart.",
            lambda: plots.power_differences(shown, comparison.base),
            "ranking",
        )
    speeds, warmth = {scene.speed for scene in comparison.scenes}, plots.fixed_condition(comparison, "speed")
    if len({scene.temperature for scene in comparison.scenes}) > 1:
        at = display_unit("speed", system).said(plots.fixed_condition(comparison, "temperature") or 0.0, 4)
        yield Drawing(
            "power-temperature",
            f"Motor power over the belt's temperature at {at}, dotted beyond the data; shaded: bands.",
            lambda: plots.power_over(comparison, "temperature", system=system),
            "power",
        )
    if len(speeds) > 1 and warmth is not None:
        at = display_unit("temperature", system).said(warmth, 4)
        turning = " The ranking changes with temperature: see the notes." if ranking_changes(comparison) else ""
        yield Drawing(
            "power-speed",
            f"Motor power over belt speed at {at}, next to the spec's of those every compound has an answer for."
            f"{turning}",
            lambda: plots.power_over(comparison, "speed", system=system),
            "power",
        )
    yield Drawing(
        "tangents",
        "Loss tangents, dotted beyond the data; shaded: 90 % loss band of the rolls.",
        lambda: plots.compared_loss_tangents(comparison, system=system),
        "loss-tangents",
    )


def _compound_label(row: RankedCompound, comparison: CalculatedComparison, system: System) -> str:
    """Label of a ranked compound, with its speed if there are several."""
    several = len({scene.speed for scene in comparison.scenes}) > 1
    return f"{row.compound}, {display_unit('speed', system).said(row.speed, 4)}" if several else row.compound


def _compared_speeds(comparison: CalculatedComparison) -> list[tuple[float, list[float]]]:
    """Speeds, each with the temperatures that means are over [degC]."""
    speeds = sorted({scene.speed for scene in comparison.scenes})
    return [(speed, [to_celsius(t) for t in comparison.common(speed)]) for speed in speeds]


COMPARISON_KEYS: Final = JsonObject(
    lambda comparison: comparison,
    describe_value("conveyor compare SPEC --json"),
    keys={
        "schema_version": VERSION_KEY,
        "conveyor": text_key("conveyor.name"),
        "base": text_key("base", "compound of the savings"),
        "cover": text_key("cover"),
        "compared": JsonList(
            _compared_speeds,
            item=JsonObject(
                lambda pair: pair,
                describe_value("temperatures that means are over"),
                keys={"speed_m_per_s": number_key("0"), "temperatures_degC": number_list("1")},
            ),
        ),
        "ranking": table_rows(ranking_table),
        "scenes": table_rows(scene_table),
        "coverage": table_rows(coverage_table),
        "refused": table_rows(refused_scenes),
        "warnings": text_list(comparison_notes, "notes"),
    },
)
"""Keys of a comparison."""


def comparison_json(comparison: CalculatedComparison) -> dict[str, Any]:
    """Plain numbers for JSON; units in the keys."""
    made: dict[str, Any] = COMPARISON_KEYS.plain(comparison)
    return made


def comparison_notebook(comparison: CalculatedComparison) -> Html:
    """Ranking and notes for a notebook."""
    tables = [(comparison.conveyor.name, ranking_table(comparison))]
    return notebook_html(
        comparison.conveyor.report.units,
        tables,
        {"notes": comparison_notes(comparison, comparison.conveyor.report.units)},
    )
