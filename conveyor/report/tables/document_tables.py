"""Head of a report, identity of the conveyor, its inputs, versions behind the figures."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Sequence
from datetime import date
from functools import partial
from typing import Any, Final

from conveyor.files.output_marks import package_version
from conveyor.line.set_loads import FormedPipe
from conveyor.models import Conveyor
from conveyor.models.calculation_methods import FACTOR_METHODS, METHOD_NAMES
from conveyor.models.given_names import given_names, given_notes
from conveyor.report.table_model import Column, Figure, PagePlacement, ReportHead, Table, figure_table
from conveyor.report.tables.inputs import InputRow, group_inputs
from conveyor.spec import fingerprint
from conveyor.units import Quantity, System
from conveyor.units.presentation import display_unit, format_figure
from conveyor.units.sentences import percent

_PACKAGES: Final = ("numpy", "scipy", "pandas", "pint", "pydantic", "openpyxl", "matplotlib")


def report_head(
    conveyor: Conveyor,
    kind: str,
    system: System,
    facts: tuple[tuple[str, str], ...] = (),
    *,
    named: Iterable[object] = (),
) -> ReportHead:
    """Head of a report of a conveyor; `named` are further models with names that the user gave."""
    report = conveyor.report
    names = ("project", "client", "number", "revision", "engineer", "reviewer", "approval")
    said = {name: value for name in names if (value := getattr(report, name)) is not None}
    given, notes = (partial(texts, (conveyor, *named)) for texts in (given_names, given_notes))
    paper = report.sheet(system)
    return ReportHead(conveyor.name, kind, said, fingerprint(conveyor), paper, facts, report.language, given, notes)


def identity_table(conveyor: Conveyor, system: System) -> Table:
    """Data of the conveyor, for the cover and the top of the page."""
    belt, material = conveyor.belt, conveyor.material
    carcass, top, bottom = belt.carcass, belt.top_cover, belt.bottom_cover

    def shown(value: Quantity, kind: str) -> str:
        return display_unit(kind, system).said(value, 4)

    def idlers(of: Any) -> str:
        inner = "" if of.inner_trough_angle is None else f"{shown(of.inner_trough_angle, 'angle')} and "
        lying = f" at {inner}{shown(of.trough_angle, 'angle')}" if of.rolls > 1 else ""
        if (pipe := FormedPipe.of(conveyor, of)) is not None:
            load = display_unit("force", system).said(pipe.forming_load, 3)
            lap = f"{display_unit('thickness', system).said(pipe.lap, 3)} ({percent(pipe.lap / pipe.circumference)})"
            lying = f" around a pipe of {shown(of.pipe.diameter, 'thickness')}, lap {lap}, forming load {load} a roll"
        return f"{of.rolls} x {shown(of.roll.diameter, 'thickness')}{lying}, every {shown(of.spacing, 'length')}"

    known = ("breaking", carcass.strength, "belt strength"), ("rated", carcass.rating, "belt rating")
    strengths = "".join(f", {what} {format_figure(v, kind, system)}" for what, v, kind in known if v is not None)
    plies = "" if carcass.plies is None else f", {carcass.plies} {'ply' if carcass.plies == 1 else 'plies'}"
    above = "rubber of the bottom cover" if top.compound is None else top.compound.name
    heavy = "" if material.weight_density is None else f" (at its heaviest {shown(material.weight_density, 'density')})"
    rows: tuple[Figure, ...] = (
        Figure("length", "length", conveyor.route.length),
        Figure("lift", "length", conveyor.route.rise),
        Figure("belt width", "size", conveyor.belt_width),
        Figure("belt speed", "speed", conveyor.belt_speed),
        Figure("mass flow", "mass flow", conveyor.mass_flow),
        Figure("temperature of the covers", "temperature", conveyor.temperature),
        Figure("belt", "text", f"{carcass.kind}{plies}{strengths}"),
        Figure("top cover", "text", f"{shown(top.thickness, 'thickness')}, {above}"),
        Figure("bottom cover", "text", f"{shown(bottom.thickness, 'thickness')}, {bottom.compound.name}"),
        Figure("carry idlers", "text", idlers(conveyor.idlers.carry)),
        Figure("return idlers", "text", idlers(conveyor.idlers.return_)),
        Figure("material", "text", f"{material.name}, {shown(material.density, 'density')}{heavy}"),
    )
    if conveyor.calculation.method != "viscoelastic":
        rows = (*rows, Figure("resistances by", "text", _method_text(conveyor)))
    return figure_table("identity", "", "The conveyor", rows)


def _method_text(conveyor: Conveyor) -> str:
    """Method of the resistances, with the friction factor of those that have one."""
    calculation = conveyor.calculation
    if calculation.method not in FACTOR_METHODS:
        return METHOD_NAMES[calculation.method]
    own = (f for one in conveyor.route.sections for f in (one.friction_factor, one.return_friction_factor))
    others = (calculation.return_friction_factor, calculation.empty_friction_factor, *own)
    differs = any(f not in {None, calculation.friction_factor} for f in others)
    f = f", f = {calculation.friction_factor:g}{', with others by section, strand or load' if differs else ''}"
    return f"{METHOD_NAMES[calculation.method]}{f}"


def input_table(entries: tuple[InputRow, ...]) -> Table:
    """Every field: as entered, in SI, and its origin: spec, library or default."""
    columns = (
        Column("field", "text", "0", verbatim=True),
        Column("as entered", "text", "1", verbatim=True),
        Column("SI value", "number", "2"),
        Column("SI unit", "text", "3", verbatim=True),
        Column("given by", "text", "4"),
    )
    caption = "Every field: as entered, in SI, and whether the spec, a library or a default gave it"
    page, heading = (PagePlacement("inputs", caption, printed=False),), "Inputs as entered and in SI"
    return Table("inputs", "Inputs", heading, columns, entries, page, printed=False)


def grouped_input_table(entries: Sequence[InputRow], system: System, *, defaults: bool) -> Table:
    """Inputs grouped by part, given or left to defaults; without the language, which a command may change."""
    columns = (Column("part", "text", "0", verbatim=True), Column("values", "text", "1", verbatim=True))
    key, heading = ("inputs_default", "Inputs left to defaults") if defaults else ("inputs_given", "Inputs given")
    chosen = [row for row in entries if (row[-1] == "default") is defaults and row[0] != "report.language"]
    return Table(key, "Given", heading, columns, group_inputs(chosen, system, alike=defaults), "inputs")


def provenance_table(spec: str, sheet: str = "Checks and notes") -> Table:
    """Versions behind the figures; `spec` is the spec's SHA-256."""
    facts = {
        "spec SHA-256": spec,
        "date": date.today().isoformat(),
        "program conveyor": package_version("conveyor"),
        "python": platform.python_version(),
        **{name: package_version(name) for name in _PACKAGES},
    }
    columns = (Column("made by", "text", "0"), Column("version", "text", "1", verbatim=True))
    page = (PagePlacement("provenance", "What made these figures", printed=False),)
    return Table("provenance", sheet, "Provenance", columns, tuple(facts.items()), page)
