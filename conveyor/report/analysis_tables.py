"""Tables of an analysis, declared once: figures and columns, their source and where they appear.

Names of sheets, tables, columns and figures are stable: docs/workbook.md lists them.
"""

from __future__ import annotations

import math
import platform
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from datetime import date
from functools import partial
from itertools import accumulate, chain
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np

from conveyor.checks import Check, governing_by_criterion, governing_by_subject, unsearched_criteria
from conveyor.files.output_marks import package_version
from conveyor.laws.drives import next_preferred_number
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.line.belt_contacts import BeltContacts
from conveyor.line.contacts import Contacts
from conveyor.line.covers import CoverTestFactor, compounds_by_strand
from conveyor.line.line import Line
from conveyor.line.roll_lives import idler_set_life, roll_life
from conveyor.line.stretches import Strand
from conveyor.loop.balance import Balance
from conveyor.loop.drive_duty import coasting_flywheel
from conveyor.loop.estimates import CemaEstimate, ClassicalEstimate
from conveyor.loop.horizontal_curve_duty import HorizontalCurveCheck
from conveyor.loop.set_duty import SetDuty
from conveyor.loop.take_up_duty import TakeUpDuty
from conveyor.loop.tensions import MotionState
from conveyor.loop.ties import first_maximum
from conveyor.models import Conveyor, RubberCompound
from conveyor.pipeline import CalculatedConveyor, StretchResult
from conveyor.remarks.assumptions import analysis_assumptions, method_summary
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.report import analysis_plots
from conveyor.report.design_verdict import governing_figures
from conveyor.report.inputs import InputRow, group_inputs
from conveyor.report.inputs import input_rows as entered
from conveyor.report.result_schema import SCHEMA_VERSION
from conveyor.report.study_tables import studies_json as plain_studies
from conveyor.report.study_tables import tables_and_drawings, take_up_json
from conveyor.report.table_model import (
    FIGURE_NAME,
    ROW_KIND,
    Column,
    Contents,
    Drawing,
    Figure,
    PagePlacement,
    ReportHead,
    Table,
    extreme_getter,
    figure_table,
    remark_table,
    slug,
)
from conveyor.report.transfer_tables import discharge_drawing as of_discharge
from conveyor.report.transfer_tables import material_flow_tables
from conveyor.report.what_if import what_if_table
from conveyor.spec import fingerprint
from conveyor.studies import CalculatedStudies
from conveyor.studies.default_bands import PowerRange, power_range
from conveyor.studies.duty import CalculatedYear
from conveyor.studies.load_cases import AS_GIVEN, Load
from conveyor.studies.loads import design_loads, every_check, take_up_demand
from conveyor.units import Quantity, System
from conveyor.units.presentation import MONEY, belt_rating_text, belt_strength_text, display_unit
from conveyor.units.sentences import Message, degree_signs, format_band, format_figure, plain_figure

PARTS: Final = (
    ("key-figures", "Key figures"),
    ("checks", "Checks"),
    ("warnings", "Warnings"),
    ("resistances", "Resistances"),
    ("route", "Route and sections"),
    ("tensions", "Tensions, drives and take-up"),
    ("rolls", "Roll contacts"),
    ("rubber", "Rubber"),
    ("start-stop", "Start and stop"),
    ("dynamics", "Starting and stopping"),
    ("through-time", "Through time"),
    ("belt", "Belt, pulleys and curves"),
    ("transfer", "Loading, cleaning and discharge"),
    ("load-states", "Load states"),
    ("load-cases", "Load cases"),
    ("duty", "Duty of a year"),
    ("uncertainty", "Uncertainty"),
    ("method", "Method"),
    ("assumptions", "Assumptions"),
    ("summary", "Figures as given"),
    ("inputs", "Inputs"),
    ("provenance", "Provenance"),
)
"""Parts of the page."""
CURVE_POINTS: Final = 25
Getter = Callable[[Any], Any]
_Row = TypeVar("_Row")
_DECADES, _PER_DECADE = (-3, 7), 4  # of frequency shown in the rubber table [Hz]
_HOUR: Final = 3600.0
_MOST_NAMES: Final = 2
"""Maximum number of sections named in a cell."""
_USUAL_STIFFNESS: Final = (
    "The belt's stiffness is a usual multiple of its strength (general knowledge) or rating (CEMA)."
)
_PACKAGES: Final = ("conveyor", "numpy", "scipy", "pandas", "pint", "pydantic", "openpyxl", "matplotlib")


class ReportAdditions(NamedTuple):
    """Additions of other calculations to a report: checks, tables, drawings, assumptions, plain numbers."""

    checks: tuple[Check, ...]
    parts: tuple[Table, ...]
    drawings: tuple[Drawing, ...]
    assumptions: tuple[str, ...]
    plain: dict[str, Any]


def analysis_contents(
    analysis: CalculatedConveyor,
    studies: CalculatedStudies | None = None,
    further: ReportAdditions | None = None,
) -> Contents:
    """Contents of the report of an analysis and its studies, in the units of the conveyor's report."""
    system = analysis.conveyor.report.units
    about = report_head(analysis.conveyor, "Belt conveyor calculation", system)
    entries, every_roll = entered(analysis.conveyor), roll_table(analysis)
    studies = CalculatedStudies() if studies is None else studies
    loads = design_loads(analysis, studies.states, studies.cases)
    every = _every_check(analysis, studies, further)
    governing = governing_by_subject(every)
    studied, drawn = tables_and_drawings(studies, system)
    left_open = power_range(analysis)
    asks = take_up_demand(analysis, studies.states, studies.cases)
    parts = (
        identity_table(analysis.conveyor, system),
        governing_figures(loads, studies.motors, governing, asks, left_open),
        result_table(analysis, left_open),
        *given_input_tables(entries, system),
        default_table(left_open, system),
        input_table(entries),
        section_table(analysis),
        resistance_table(analysis),
        classical_table(analysis),
        cema_table(analysis),
        breakdown_table(analysis),
        distinct_rolls(analysis, every_roll),
        idler_sets(analysis, loads),
        every_roll,
        section_ends(analysis),
        tension_table(analysis),
        tension_states(analysis),
        profile_table(analysis),
        drive_table(analysis),
        take_up_table(analysis, asks),
        take_up_conditions(analysis),
        start_stop_table(analysis),
        brake_table(analysis),
        drive_parts(analysis, loads),
        belt_strength_table(analysis),
        pulley_table(analysis),
        pulley_loads(analysis, loads),
        pulley_states(analysis, loads),
        vertical_curves(analysis, loads),
        horizontal_curves(loads),
        curve_edges(analysis, loads),
        drift_states(analysis, loads),
        transition_table(analysis, loads),
        *material_flow_tables(analysis),
        convergence_table(analysis),
        *studied,
        what_if_table(analysis, studies.duty, first_maximum((load.found.governing_motor_power for load in loads), abs)),
        belt_support(analysis),
        contact_solutions(analysis),
        indentation_table(analysis),
        rubber_table(analysis),
        *compound_tables(analysis, system),
        *(() if further is None else further.parts),
        *case_checks(every, system),
        check_table(governing, system, unsearched_criteria(analysis.line)),
        analysis_remarks(analysis, governing, system, () if further is None else further.assumptions),
        provenance_table(about.fingerprint),
    )
    shown = () if further is None else further.drawings
    return Contents(
        about, parts, system, (*analysis_drawings(analysis, system, loads), *drawn, *shown), PARTS, "conveyor"
    )


def _every_check(
    analysis: CalculatedConveyor, studies: CalculatedStudies, further: ReportAdditions | None
) -> tuple[Check, ...]:
    return every_check(analysis, studies.states, studies.cases, () if further is None else further.checks)


def report_head(conveyor: Conveyor, kind: str, system: System, facts: tuple[tuple[str, str], ...] = ()) -> ReportHead:
    """Head of a report of a conveyor."""
    report = conveyor.report
    names = ("project", "client", "number", "revision", "engineer", "reviewer", "approval")
    said = {name: value for name in names if (value := getattr(report, name)) is not None}
    return ReportHead(conveyor.name, kind, said, fingerprint(conveyor), report.sheet(system), facts)


def identity_table(conveyor: Conveyor, system: System) -> Table:
    """Data of the conveyor, for the cover and the top of the page."""
    belt, material = conveyor.belt, conveyor.material
    carcass, top, bottom = belt.carcass, belt.top_cover, belt.bottom_cover

    def shown(value: Quantity, kind: str) -> str:
        return display_unit(kind, system).quantity_text(value)

    def idlers(of: Any) -> str:
        inner = "" if of.inner_trough_angle is None else f"{shown(of.inner_trough_angle, 'angle')} and "
        lying = f" at {inner}{shown(of.trough_angle, 'angle')}" if of.rolls > 1 else ""
        return f"{of.rolls} x {shown(of.roll.diameter, 'thickness')}{lying}, every {shown(of.spacing, 'length')}"

    strength = "" if carcass.strength is None else f", breaking {belt_strength_text(carcass.strength, system)}"
    rating = "" if carcass.rating is None else f", rated {belt_rating_text(carcass.rating, system)}"
    above = "rubber of the bottom cover" if top.compound is None else top.compound.name
    rows = (
        Figure("length", "length", conveyor.route.length),
        Figure("lift", "length", conveyor.route.rise),
        Figure("belt width", "size", conveyor.belt_width),
        Figure("belt speed", "speed", conveyor.belt_speed),
        Figure("mass flow", "mass flow", conveyor.mass_flow),
        Figure("temperature of the covers", "temperature", conveyor.temperature),
        Figure("belt", "text", f"{carcass.kind}{strength}{rating}"),
        Figure("top cover", "text", f"{shown(top.thickness, 'thickness')}, {above}"),
        Figure("bottom cover", "text", f"{shown(bottom.thickness, 'thickness')}, {bottom.compound.name}"),
        Figure("carry idlers", "text", idlers(conveyor.idlers.carry)),
        Figure("return idlers", "text", idlers(conveyor.idlers.return_)),
        Figure("material", "text", f"{material.name}, {shown(material.density, 'density')}"),
    )
    return figure_table("identity", "", "The conveyor", rows)


def result_table(a: CalculatedConveyor, left_open: PowerRange) -> Table:
    """Figures of the whole conveyor, with the range of power due to defaults."""
    conveyor, balance = a.conveyor, a.balance
    forces, power, tensions_at, classic = balance.forces, balance.power, balance.tensions, balance.classical
    low, high = (left_open.low, left_open.high) if left_open.effects else (None, None)
    share = forces.indentation / forces.main
    error, energy_error = a.contacts.error, a.contacts.energy_error
    safety, of_year = a.belt_duty.safety, a.year
    energy, cost = (None, None) if of_year is None else (of_year.energy * JOULE_PER_KWH, of_year.cost)
    money = f"{MONEY}{(of_year and of_year.currency) or '-'}"
    rows = (
        Figure("length", "length", conveyor.route.length, json="length_m"),
        Figure("lift", "length", conveyor.route.rise, json="lift_m"),
        Figure("belt speed", "speed", a.line.speed),
        Figure("mass flow", "mass flow", a.line.flow, json="flow_t_per_h"),
        Figure("motor power", "power", power.motor, "tile large notebook", "power_kW.motor"),
        Figure("motor power, low by defaults", "power", low, "", "defaults.motor_kW.low", key="motor_power_low"),
        Figure("motor power, high by defaults", "power", high, "", "defaults.motor_kW.high",
               key="motor_power_high"),
        Figure("belt power", "power", power.belt, "large notebook", "power_kW.belt"),
        Figure("mains power", "power", power.mains, "", "power_kW.mains"),
        Figure("effective tension", "force", forces.total, "tile large notebook", "forces_N.total", us="Te"),
        *(
            Figure(
                "lift force" if name == "lift" else name.replace("_", " "), "force", newtons, "notebook",
                f"forces_N.{name}", key=f"{name}_force",
            )
            for name, newtons in forces.parts.items()
        ),
        Figure("indentation share of main resistance", "share", share, "tile large", key="indentation_share"),
        Figure("equivalent DIN f", "friction", balance.friction_factor, "tile large notebook", "friction_factor",
               key="equivalent_f"),
        Figure("tight side tension", "force", tensions_at.tight, "tile notebook", us="T1"),
        Figure("slack side tension", "force", tensions_at.slack, "notebook", us="T2"),
        Figure("tight side tension at start", "force", tensions_at.tight_start),
        Figure("minimum tension, steady", "force", tensions_at.smallest, key="smallest_tension"),
        Figure("belt safety at start", "ratio", safety),
        Figure("energy", "specific energy", power.energy_per_tonne_km, "tile large notebook",
               key="specific_energy"),
        Figure("energy per year", "energy", energy),
        Figure("cost per year", money, cost),
        Figure("classical f", "friction", classic.friction_factor),
        Figure("classical effective tension", "force", classic.total, us="Te"),
        Figure("classical motor power", "power", balance.frame.motor(classic.total)),
        Figure("maximum error estimate of the contacts", "error", error, "", "error_estimate",
               key="contact_error_estimate"),
        Figure("maximum energy error of the contacts", "error", energy_error, key="contact_energy_error"),
    )  # fmt: skip
    heading = "Figures of the whole conveyor as given"
    page = (PagePlacement("summary", heading, printed=False),)
    table = figure_table("results", "Results", heading, rows, page=page, prefix="")
    name = Column("name", "text", "key", page=None)
    return replace(table, columns=(*table.columns, name))


def default_table(left_open: PowerRange, system: System) -> Table:
    """Defaults in use and their effect on the power, the most influential first."""
    columns = (
        Column("default", "text", "name", json="what"),
        Column("forces, low", "ratio", "low_factor", json="low_factor"),
        Column("forces, high", "ratio", "high_factor", json="high_factor"),
        Column("motor power at low", "power", "motor_low", json="motor_low_kW"),
        Column("motor power at high", "power", "motor_high", json="motor_high_kW"),
        Column("give instead", "text", "give", json="give"),
        Column("name", "text", "key", page=None, json="key"),
    )
    heading = "Defaults that affect the power, most influential first"
    return Table("defaults", "Results", heading, columns, left_open.effects, "inputs",
                 _power_range_text(left_open, system) if left_open.effects else "")  # fmt: skip


def _power_range_text(power: PowerRange, system: System) -> str:
    """Power with its range, and the default to replace first."""
    low, high = (format_figure(end, "power", system) for end in (power.low, power.high))
    first, motor = power.effects[0], format_figure(power.motor, "power", system)
    said = (
        f"Motor power: expected {motor}, design {high}, least {low} (90 % interval by site, defaults and rubber). "
        f"Replace first: {first.name} (give {first.give})."
    )
    untested = (f"Beyond the tests: {one.text(system)}." for one in power.untested)
    return " ".join((said, *untested, *(f"Not included: {note}." for note in power.notes)))


def input_table(entries: tuple[InputRow, ...]) -> Table:
    """Every field: as entered, in SI, and its origin: spec, library or default."""
    columns = (
        Column("field", "text", "0"),
        Column("as entered", "text", "1"),
        Column("SI value", "number", "2"),
        Column("SI unit", "text", "3"),
        Column("given by", "text", "4"),
    )
    caption = "Every field: as entered, in SI, and whether the spec, a library or a default gave it"
    page, heading = (PagePlacement("inputs", caption, printed=False),), "Inputs as entered and in SI"
    return Table("inputs", "Inputs", heading, columns, entries, page, printed=False)


def given_input_tables(entries: tuple[InputRow, ...], system: System) -> Iterator[Table]:
    """Inputs grouped by part: those given, then those left to defaults."""
    columns = (Column("part", "text", "0"), Column("values", "text", "1"))
    for key, heading, chosen in (
        ("inputs_given", "Inputs given", [row for row in entries if row[-1] != "default"]),
        ("inputs_default", "Inputs left to defaults", [row for row in entries if row[-1] == "default"]),
    ):
        shown = group_inputs(chosen, system, alike=key == "inputs_default")
        yield Table(key, "Given", heading, columns, shown, "inputs")


def section_table(a: CalculatedConveyor) -> Table:
    """Geometry, masses and forces of every section of both strands, in running direction."""
    columns = (
        Column("section", "text", "stretch.section", json="section"),
        Column("strand", "text", "stretch.strand", json="strand"),
        Column("length", "length", "stretch.length", "layout", json="length_m"),
        Column("lift", "length", "stretch.rise", "layout", json="lift_m"),
        Column("inclination", "angle", "stretch.inclination", page=None),
        Column("idler spacing", "spacing", "stretch.spacing", "layout"),
        Column("belt mass", "line mass", "stretch.belt_mass", "layout"),
        Column("bulk mass", "line mass", "stretch.bulk_mass", "layout"),
        *(
            Column(force.short or force.name, "force", f"forces.{force.key}", "forces", json=f"{force.key}_N",
                   total=True)
            for force in a.balance.along
        ),
        Column("total", "force", "total", "forces", json="total_N", total=True),
        Column("equivalent f", "friction", lambda r: r.main / r.unit_main, "layout"),
        Column("idler set L10 life", "life", _set_life_seconds, "layout", sparse=True),
    )  # fmt: skip
    page = (
        PagePlacement("route", "Sections of both strands, in running direction", "layout", printed=False),
        PagePlacement("route", "Forces of the sections", "forces"),
    )
    heading = "Forces of every section and strand"
    return Table("sections", "Sections", heading, columns, a.stretches, page, foot="all sections")


def _set_life_seconds(r: StretchResult) -> float | None:
    """L10 life of the bearings of a set [s]; None where one is not given."""
    life = idler_set_life(r.stretch, r.rolls[0].curve.contact.speed)
    return life.hours * _HOUR if life is not None and life.whole else None


def resistance_table(a: CalculatedConveyor) -> Table:
    """Resistances with their sources; the rows add up to the effective tension."""
    by_strand = [
        (f"{force.name}, {strand}", force.kind, newtons, force.source)
        for force in a.balance.along
        for strand, newtons in force.by_strand().items()
    ]
    total = a.balance.forces.total
    columns = (
        Column("resistance", "text", "0"),
        Column("kind", "text", "1"),
        Column("force", "force", "2", total=True),
        Column("share", "share", lambda row: _share_or_nan(row[2], total), total=total != 0.0),
        Column("source", "text", "3"),
    )
    rows = (*by_strand, *((each.name, each.kind, each.total, each.source) for each in a.balance.singles))
    heading = "Resistances and their sources"
    return Table("resistances", "Resistances", heading, columns, rows, "resistances", foot="effective tension")


def _share_or_nan(part: float, whole: float) -> float:
    """Share of a whole; NaN if that is zero."""
    return part / whole if whole else math.nan


def _friction_part(a: CalculatedConveyor, name: str) -> float:
    """Contribution of a main resistance to the friction factor f [-]; NaN for others."""
    balance = a.balance
    main = {force.key for force in balance.along if force.kind == "main"}
    return balance.forces.parts[name] / balance.unit_main if name in main else math.nan


def breakdown_table(a: CalculatedConveyor) -> Table:
    """Sums of the forces by kind, with their shares."""
    forces = a.balance.forces
    columns = (
        Column("resistance", "text", lambda name: name.replace("_", " ")),
        Column("force", "force", forces.parts.get),
        Column("share of total", "share", lambda name: _share_or_nan(forces.parts[name], forces.total)),
        Column("part of f", "friction", lambda name: _friction_part(a, name)),
    )
    heading = "Breakdown of the effective tension"
    return Table("breakdown", "Resistances", heading, columns, tuple(forces.parts), printed=False)


def classical_table(a: CalculatedConveyor) -> Table:
    """Comparison with ISO 5048 / DIN 22101 at a given f, and with CEMA where its factors are given."""
    balance, forces = a.balance, a.balance.forces
    estimates = [("classical, given f", balance.classical), ("CEMA classic, given Ky", balance.cema)]
    others = [(name, made) for name, made in estimates if made is not None]

    def row(label: str, kind: str, name: str, here: float) -> Figure:
        return Figure(label, kind, (here, *(getattr(made, name) for _, made in others)), key=name)

    powers = (balance.power.motor, *(_estimate_motor_power(balance, made) for _, made in others))

    rows = (
        row("f", "friction", "friction_factor", balance.friction_factor),
        row("main", "force", "main", forces.main),
        row("secondary", "force", "secondary", forces.secondary),
        row("special", "force", "special", forces.special),
        row("lift", "force", "lift", forces.lift),
        replace(row("effective tension", "force", "total", forces.total), us="Te"),
        Figure("motor power", "power", powers, key="motor"),
    )
    names = ["this calculation", *(name for name, _ in others)]
    columns = (
        Column("quantity", FIGURE_NAME, "label"),
        *(Column(name, ROW_KIND, f"value.{i}", key=f"estimate_{i}") for i, name in enumerate(names)),
    )
    heading = "Comparison with ISO 5048 / DIN 22101, given f"
    note = (
        f"secondary resistances of the classical estimate: {balance.classical.secondary_by}; "
        f"governing at the drive: {balance.tensions.governed_by}"
    )
    return Table("classical", "Resistances", heading, columns, rows, "resistances", note)


def cema_table(a: CalculatedConveyor) -> Table:
    """CEMA classic, itemised; the rows add up to Te."""
    made, given = a.balance.cema, a.line.cema
    columns = (
        Column("symbol", "text", "0"),
        Column("CEMA resistance", "text", "1"),
        Column("force", "force", "2", total=True),
    )
    rows = () if made is None else made.items
    heading = "CEMA classic, itemised"
    note = (
        ""
        if given is None
        else f"Ky {given.flexure:g}, Kt {given.temperature:g}; Tp is "
        + ("the book's, by place and wrap" if given.pulleys is None else "the spec's")
    )
    return Table("cema", "Resistances", heading, columns, rows, "resistances", note, foot="Te", named=2)


def _estimate_motor_power(balance: Balance, made: ClassicalEstimate) -> float:
    """Motor power of an estimate [W]; that of CEMA includes the bearings of the drive pulleys."""
    beside = made.drive_pulleys if isinstance(made, CemaEstimate) else 0.0
    return balance.frame.motor(made.total + beside)


def roll_table(a: CalculatedConveyor) -> Table:
    """Every roll of every section: load, contact at its highest line load, indentation, drag, life."""
    columns = (
        Column("section", "text", "0.stretch.section"),
        Column("strand", "text", "0.stretch.strand"),
        Column("roll", "text", "1.load.name"),
        Column("diameter", "size", lambda row: 2.0 * row[1].curve.contact.radius, page=None),
        Column("force", "force", "1.load.force"),
        Column("highest line load", "line force", "1.peak.line_load"),
        Column("half width", "thickness", "1.peak.half_width"),
        Column("eccentricity", "thickness", "1.peak.eccentricity", page=None),
        Column("penetration", "thickness", "1.peak.penetration"),
        Column("penetration of cover", "share",
               lambda row: row[1].cover_penetration / row[1].curve.contact.cover_thickness, page=None),
        Column("peak pressure", "pressure", "1.peak.peak_pressure"),
        Column("error of the peak", "share", "1.peak.peak_error"),
        Column("transit frequency", "passing",
               lambda row: row[1].curve.contact.speed / (2.0 * float(row[1].peak.half_width)), page=None),
        Column("indentation", "roll force", "1.resistance"),
        Column("error estimate", "error", "1.peak.error", page=None),
        Column("energy error", "error", "1.peak.energy_error", page=None),
        Column("rim drag", "roll force", "2"),
        Column("rotation", "rotation",
               lambda row: row[1].curve.contact.speed / (2.0 * math.pi * row[1].curve.contact.radius), page=None),
        Column("heavier bearing", "force", "3.heavier", page=None, sparse=True),
        Column("roll L10 life", "life", lambda row: row[3] and row[3].both * _HOUR, sparse=True),
    )  # fmt: skip
    rows = tuple(
        (r, roll, drag, roll_life(r.stretch, place, roll.curve.contact.speed))
        for r, drags in zip(a.stretches, a.line.roll_drags, strict=True)
        for place, (roll, drag) in enumerate(zip(r.rolls, drags, strict=True))
    )
    heading = "Every roll of a set, contact at the highest line load"
    return Table("rolls", "Rolls", heading, columns, rows, printed=False)


def distinct_rolls(a: CalculatedConveyor, every: Table) -> Table:
    """Rolls with identical figures once, with their sections."""
    by_look, looks = dict[tuple[str, ...], list[Any]](), dict[tuple[Any, ...], tuple[str, ...]]()
    shown = tuple(column for column in every.columns if column.page is not None)
    for row in every.rows:
        values = tuple(column.get(row) for column in shown[1:])
        if values not in looks:
            looks[values] = tuple(
                display_unit(column.kind).short(value) for column, value in zip(shown[1:], values, strict=True)
            )
        by_look.setdefault(looks[values], []).append(row)
    columns = (
        Column("sections", "text", lambda rows: _section_names([row[0].stretch.section for row in rows])),
        *(column.of("0") for column in shown[1:]),
    )
    heading = "Rolls of a set at their highest line load, identical ones once"
    note = f"Relative error of the contacts: at most {a.error_estimate:.0e}."
    return Table("distinct_rolls", "Sections", heading, columns, tuple(by_look.values()), "rolls", note, named=3)


def idler_sets(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Idler sets with rating, bearings or flap check, one row per strand and spacing; worst of all cases."""
    system, alike = a.conveyor.report.units, dict[tuple[Strand, float], list[tuple[str, SetDuty]]]()
    for load in loads:
        for duty in load.found.set_duty:
            key = (duty.stretch.strand, duty.stretch.spacing)
            alike.setdefault(key, []).append((load.label.text(system), duty))
    rows = []
    for of in alike.values():
        duties, sets = [duty for _, duty in of], [duty.stretch.sets for case, duty in of if case == of[0][0]]
        heaviest = first_maximum(of, lambda pair: pair[1].limits.load)
        closest = min(duties, key=lambda duty: duty.distance)  # to resonance
        rows.append((duties[0], math.fsum(sets), *heaviest, closest, duties))
    columns = (
        Column("strand", "text", "0.stretch.strand"),
        Column("spacing", "spacing", "0.stretch.spacing"),
        Column("sets", "count", "1"),
        Column("turning mass of a set", "mass", "0.stretch.set_mass"),
        Column("rotation", "rotation", extreme_getter(max, "5", "rotations.1"), page=None),
        Column("load of a set", "force", "3.limits.load"),
        Column("lump factor", "ratio", "3.limits.lump_factor", page=None),
        Column("of the case", "text", "2", page=None),
        Column("rating", "force", "0.limits.rating", sparse=True),
        Column("CEMA class", "text", "0.limits.cema_class", sparse=True),
        Column("least CEMA class", "text", "3.limits.least_class", sparse=True),
        Column("slope of the axle", "angle", extreme_getter(max, "5", "limits.axle.slope"), sparse=True),
        Column("L10 life of a set", "life",
        extreme_getter(min, "5", lambda duty: duty.life and duty.life.hours * _HOUR),
               sparse=True),
        Column("rolls turn at", "swing", "4.rotations.1"),
        Column("belt swings from", "swing", "4.frequencies.0"),
        Column("belt swings to", "swing", "4.frequencies.1"),
        Column("distance from resonance", "share", "4.distance"),
        Column("in section", "text", "4.stretch.section"),
        Column("spacing at most, against flap", "spacing",
        extreme_getter(min, "5", lambda duty: duty.still_spacing or None),
               sparse=True),
    )  # fmt: skip
    heading = "Idler sets, the worst of all cases"
    note = (
        "Load with the lump factor (given, else by belt.wear.lump) and the tension on a raised set. Belt: first "
        "natural frequency between two sets in the section closest to resonance; rolls out of round excite it and "
        "twice it; distance 0 where a span is hit."
    )
    return Table("idler_sets", "Sections", heading, columns, rows, "rolls", note, named=2)


def _section_names(names: list[str]) -> str:
    """Names of sections; of many the first and the number of others."""
    return ", ".join(names) if len(names) <= _MOST_NAMES else f"{names[0]} and {len(names) - 1} more"


def tension_table(a: CalculatedConveyor) -> Table:
    """Tension round the loop in steady running, from the drive."""
    columns = (
        Column("place", "text", "place"),
        Column("distance from drive", "length", "distance"),
        Column("tension", "force", "tension"),
        Column("minimum tension (sag)", "force", "least_for_sag", key="least_for_sag"),
    )
    heading = "Tension round the loop, steady running, from the drive"
    return Table("tensions", "Tensions", heading, columns, a.balance.points, printed=False)


def profile_table(a: CalculatedConveyor) -> Table:
    """Profile of the route: horizontal distance and height of every section boundary over the tail."""
    sections, ends = a.line.sections, section_boundaries(a.line)
    along = accumulate((section.length for section in sections), initial=0.0)
    places = analysis_plots.route_markers(a.conveyor, a.line)
    rows = zip(range(len(ends)), ("", *(section.name for section in sections)), along, ends, strict=True)
    columns = (
        Column("behind section", "text", "1"),
        Column("along the belt", "length", "2"),
        Column("horizontal", "length", "3.0"),
        Column("height", "length", "3.1"),
        *(
            Column(f"{what} at height", "length", _height_at(at), key=what.replace("-", "_"))
            for what, at in places.items()
        ),
    )
    heading = "Profile of the route"
    return Table("profile", "States", heading, columns, tuple(rows), printed=False)


def _height_at(boundaries_of: tuple[int, ...]) -> Getter:
    return lambda row: row[3][1] if row[0] in boundaries_of else None


def section_boundaries(line: Line) -> list[tuple[float, float]]:
    """Horizontal distance and height over the tail of every section boundary [m]."""
    points = [(0.0, 0.0)]
    for section in line.sections:
        across, up = points[-1]
        level = math.sqrt(section.length**2 - section.rise**2)
        points.append((across + level, up + section.rise))
    return points


def section_ends(a: CalculatedConveyor) -> Table:
    """Tension at every section end of the loop, from the head, in every state; failing states are marked."""
    shape = a.line.loop
    rows = ((0, 0), *((i, 1) for i in range(len(shape.stretches))))

    def place(at: tuple[int, int]) -> str:
        return f"{shape.stretches[at[0]].section}, {shape.stretches[at[0]].strand}" if at[1] else "head"

    columns = (
        Column("behind section", "text", place),
        *_place_columns(a),
        *(
            Column(
                f"{name}{analysis_plots.tension_fault(a.line, state)}",
                "force",
                _tension_getter(state),
                key=slug(name),
            )
            for name, state in _motion_states(a).items()
        ),
    )
    heading = "Tension behind every section in every state of motion"
    return Table("section_ends", "Tension diagram", heading, columns, rows, "tensions")


def _motion_states(a: CalculatedConveyor) -> dict[str, MotionState]:
    return a.balance.settled.states | a.motions.states


def _place_columns(a: CalculatedConveyor) -> tuple[Column, ...]:
    """Columns of location and minimum tension for sag."""
    shape = a.line.loop
    return (
        Column("distance from head", "length", lambda at: float(shape.way[at[0] + at[1]])),
        Column("minimum tension (sag)", "force", lambda at: float(shape.least[at[0]]), key="least_for_sag"),
    )


def tension_states(a: CalculatedConveyor) -> Table:
    """Tension at both ends of every stretch in every state, in loop order from the head."""
    shape = a.line.loop
    columns = (
        Column("section", "text", lambda at: shape.stretches[at[0]].section),
        Column("strand", "text", lambda at: shape.stretches[at[0]].strand),
        Column("end", "text", lambda at: ("start", "end")[at[1]]),
        *_place_columns(a),
        *(Column(name, "force", _tension_getter(state)) for name, state in _motion_states(a).items()),
    )
    rows = tuple((i, end) for i in range(len(shape.stretches)) for end in (0, 1))
    heading = "Tension at both ends of every section in every state of motion"
    return Table("tension_states", "States", heading, columns, rows, printed=False)


def _tension_getter(state: Any) -> Getter:
    return lambda at: float((state.starts, state.ends)[at[1]][at[0]])


def drive_table(a: CalculatedConveyor) -> Table:
    """Force, power, tensions and grip of every drive in every state."""
    motor, states = a.balance.frame.motor, a.balance.settled.states
    columns = (
        Column("drive", "text", "0.name"),
        Column("state", "text", "1"),
        Column("force", "force", "2.force"),
        Column("motor power at full speed", "power", lambda row: motor(row[2].force)),
        Column("installed power", "power", "0.power"),
        Column("arriving", "force", "2.arriving"),
        Column("leaving", "force", "2.leaving"),
        Column("tension ratio", "ratio",
               lambda row: math.inf if row[2].slack <= 0.0 else row[2].tight / row[2].slack),
        Column("grip limit", "ratio", lambda row: math.exp(row[0].friction * row[0].wrap_angle)),
    )  # fmt: skip
    rows = tuple(
        (drive, state.name, side)
        for state in states.values()
        for drive, side in zip(a.line.drives, state.drives, strict=True)
    )
    heading = "Drives in every state of motion"
    return Table(
        "drives",
        "Loop",
        heading,
        columns,
        rows,
        (PagePlacement("tensions", "Drives in every state"),),
        named=2,
    )


def take_up_table(a: CalculatedConveyor, asks: tuple[TakeUpDuty, Message]) -> Table:
    """Take-up of all loads: setting, governing condition, mass or pull, travel."""
    duty, governed_by = asks
    mass, travel = duty.mass, duty.travel
    mean = a.balance.settled.steady.mean(a.line.loop.length)
    winch = duty.unit.kind == "winch"
    screws = 0.5 * duty.unit.strands * duty.setting if duty.unit.kind == "screw" else None
    rows = [
        Figure("setting", "force", duty.setting, "cover"),
        Figure("required setting", "force", duty.needed, key="least_setting"),
        Figure("mean tension of the loop", "force", mean, key="mean_tension"),
        Figure("strands at the take-up", "count", float(duty.unit.strands), key="strands"),
        Figure("mass of a gravity take-up", "mass", mass, key="mass"),
        Figure("pull on the rope of a winch", "force", None if mass is None else mass * a.line.gravity, key="pull"),
        Figure("force of each of two screws", "force", screws),
        Figure("carriage speed through a start", "speed", duty.speed if winch else None),
        Figure("power of the winch", "power",
               None if duty.speed is None or not winch else duty.speed * duty.unit.strands * max(duty.setting, 0.0)),
        Figure("change of mean tension by temperature", "force", duty.mean_change),
    ]  # fmt: skip
    if travel is not None:
        rows += [
            Figure("travel, tensioning the slack belt", "length", travel.tensioning),
            Figure("travel, load", "length", travel.load),
            Figure("travel, starting and stopping", "length", travel.motion),
            Figure("travel, permanent stretch", "length", travel.permanent),
            Figure("travel, temperature of the belt", "length", travel.temperature),
            Figure("travel, reserve", "length", travel.reserve),
            Figure("travel", "length", travel.whole),
            Figure("travel given", "length", duty.unit.travel),
        ]
    note = f"kind: {duty.unit.kind}, governed by: {governed_by.text(a.conveyor.report.units)}{_travel_note(a, duty)}"
    return figure_table("take_up", "Loop", "Take-up", rows, page="tensions", note=note, prefix="take_up_")


def _travel_note(a: CalculatedConveyor, duty: TakeUpDuty) -> str:
    """Note on usual values used for the travel."""
    carcass = a.conveyor.belt.carcass
    if duty.travel is None:
        return "; travel: give belt.carcass.stiffness, nothing usual is known of this carcass"
    usual = []
    if carcass.stiffness is None:
        usual.append("stiffness a multiple of the strength")
    if carcass.permanent_stretch is None:
        usual.append("permanent stretch of its kind")
    return f"; travel: {', '.join(usual)} (general knowledge)" if usual else ""


def take_up_conditions(a: CalculatedConveyor) -> Table:
    """Required take-up setting of every condition, the governing one first."""
    settled = a.balance.settled
    columns = (
        Column("condition", "text", "0"),
        Column("required setting", "force", "1", key="setting_it_asks_for"),
        Column("margin", "force", lambda row: settled.setting - row[1]),
    )
    heading, rows = (
        "Governing take-up conditions",
        sorted(settled.conditions.items(), key=lambda item: -item[1]),
    )
    return Table("tension_conditions", "Loop", heading, columns, tuple(rows), "tensions")


def start_stop_table(a: CalculatedConveyor) -> Table:
    """Start, stop, brakes and limits of material slip."""
    moving = a.motions
    start, slip = moving.start, moving.slip
    holder = "backstop" if moving.rolls_back else "brake"
    rows = [
        Figure("moving mass", "mass", moving.moving_mass),
        Figure("rotating mass of the drives", "mass", moving.rotating_mass),
        Figure("drive force at start", "force", start.force),
        Figure("drive force at start over steady", "ratio", start.factor),
        Figure("acceleration at start", "acceleration", start.acceleration),
        Figure("time over the whole speed range", "duration", start.time),
        Figure("motor torque at start over rated", "ratio", start.torque_factor),
        Figure("required motor force", "force", start.asked, key="force_asked_of_the_motors"),
        Figure("available motor force", "force", start.available, key="force_the_motors_give"),
        Figure("drive force at rest", "force", start.standstill),
        Figure("resistance after standstill, at most", "force", start.breakaway),
    ]  # fmt: skip
    for label, stop in (
        ("drives off", moving.coasting),
        ("drives off, least friction", moving.coasting_least),
        ("brakes on, least friction", moving.braked),
    ):
        if stop is not None:
            rows += [
                Figure(f"deceleration, {label}", "acceleration", stop.deceleration),
                Figure(f"stopping time, {label}", "duration", stop.time),
                Figure(f"stopping distance, {label}", "length", stop.distance),
            ]  # fmt: skip
    radius = a.line.drives[0].radius
    torque = None if radius is None else moving.brake_to_hold * radius
    gripping = moving.gripping_speed if a.line.brake_delay > 0.0 else None
    braking, starting = (None, None) if slip is None else (-slip.braking, slip.starting)
    rows += [
        Figure("brake force for the specified deceleration", "force", moving.brake_to_stop,
               key="brake_for_the_deceleration_wanted"),
        Figure(f"{holder} to hold", "force", moving.brake_to_hold),
        Figure("torque to hold, at the first drive's pulley", "torque", torque, key="torque_to_hold"),
        Figure("flywheel for the coasting time, at the motors", "inertia", coasting_flywheel(a.line, moving)),
        Figure("runaway, drives and brakes off", "acceleration", moving.runaway),
        Figure("speed at which the brakes grip", "speed", gripping),
        Figure("maximum deceleration without material slip", "acceleration", braking,
               key="hardest_braking_before_the_bulk_slides"),
        Figure("maximum acceleration without material slip", "acceleration", starting,
               key="highest_acceleration_before_the_bulk_slides"),
    ]  # fmt: skip
    page = (PagePlacement("start-stop", "Start, stop and limits of material slip"),)
    return figure_table("start_stop", "Loop", "Start and stop", rows, page=page, prefix="motion_")


def brake_table(a: CalculatedConveyor) -> Table:
    """Torque and heat of every brake in a stop at minimum friction."""
    whole, heat = math.fsum(a.line.brakes), a.motions.braking_heat
    columns = (
        Column("drive", "text", "name"),
        Column("brake force", "force", "brake"),
        Column("brake torque at the pulley", "torque", lambda d: None if d.radius is None else d.brake * d.radius),
        Column("heat of a stop", "heat", lambda d: None if heat is None else heat * d.brake / whole),
    )
    rows = tuple(drive for drive in a.line.drives if drive.brake is not None)
    return Table("brakes", "Loop", "Brakes", columns, rows, "start-stop")


def drive_parts(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Parts of the drives: gear, backstop, starts, brake, load sharing; worst of all cases."""
    every = [load.found.drive_duty for load in loads]
    rows = [(own, [duties[i] for duties in every]) for i, own in enumerate(a.drive_duty)]

    worst = partial(extreme_getter, path="1")
    motor = a.balance.frame.motor
    columns = (
        Column("drive", "text", "0.drive.name"),
        Column("motors", "count", lambda row: float(row[0].parts.motors), page=None),
        Column("pulley speed", "rotation", "0.rotation"),
        Column("gear ratio", "ratio", "0.ratio", sparse=True),
        Column("preferred ratio", "ratio", "0.standard_ratio", sparse=True),
        Column("gear size", "torque", "0.gear", sparse=True),
        Column("backstop, holding", "torque", worst(max, get="holding"), sparse=True),
        Column("backstop, motors stalled", "torque",
               worst(max, get=lambda duty: None if duty.holding is None else duty.stalled), sparse=True),
        Column("backstop size", "torque",
               lambda row: next_preferred_number(most) if (most := worst(max, get="backstop")(row)) else None,
               sparse=True),
        Column("load at a motor's shaft", "inertia", worst(max, get="load_inertia"), sparse=True),
        Column("starts an hour", "ratio", worst(min, get="allowed_starts"), sparse=True),
        Column("heat of a stop", "heat", worst(max, get="heat"), sparse=True),
        Column("rise of the disc", "rise", worst(max, get="disc_rise"), sparse=True),
        Column("motor power, uncontrolled", "power",
               worst(partial(max, key=abs), get=lambda duty: None if duty.shared is None else motor(duty.shared)),
               sparse=True),
    )  # fmt: skip
    note = (
        "Sizes are preferred numbers (ISO 3): gear 1.5 times the motor's torque, one of several backstops 1.4 times an "
        "even share (general knowledge). Starts of motors switched on directly, NEMA MG 10. Uncontrolled: nothing but "
        "the belt couples the drives."
    )
    heading = "Parts of the drives, all cases"
    return Table("drive_parts", "Loop", heading, columns, tuple(rows), "start-stop", note)


def belt_strength_table(a: CalculatedConveyor) -> Table:
    """Strength of the belt; figures that are not known are left out."""
    duty, strength = a.belt_duty, a.line.belt.strength
    needed = duty.strength_needed.values()
    used = max(needed) / strength if needed and strength is not None else None
    rows = (
        Figure("maximum tension, steady", "force", duty.largest_steady, us="Tmax", key="largest_tension_steady"),
        Figure("maximum tension, all states", "force", duty.largest, us="Tmax", key="largest_tension_all_states"),
        Figure("safety, steady", "ratio", duty.safety_steady),
        Figure("safety, all states", "ratio", duty.safety),
        Figure("required safety", "ratio", duty.safety_needed, key="classic_safety_asked_for"),
        Figure("tension per width, steady", "strength", duty.per_width_steady),
        Figure("tension per width, all states", "strength", duty.per_width),
        Figure("rated tension per width", "strength", duty.rating),
        Figure("belt strength required by the splice", "strength", max(needed, default=None),
               key="strength_the_splice_asks_for"),
        Figure("utilisation of the splice", "share", used),
        *(
            Figure(f"required {cover.cover} cover", "thickness", cover.least + cover.wear)
            for cover in a.line.belt.covers
        ),
        Figure("minimum diameter of drive pulleys", "size", duty.drive_diameter,
               key="least_diameter_of_drive_pulleys"),
    )  # fmt: skip
    return figure_table("belt_strength", "Loop", "Strength of the belt", rows, page="belt", prefix="belt_")


def pulley_table(a: CalculatedConveyor) -> Table:
    """Diameter of every pulley, and the minimum."""
    columns = (
        Column("pulley", "text", "name"),
        Column("position", "text", "position"),
        Column("group", "text", "group"),
        Column("utilisation", "share", "utilisation", sparse=True),
        Column("diameter", "size", "diameter"),
        Column("minimum", "size", "least", key="least"),
        Column("standard size", "size", "next_size", key="of_the_series"),
        Column("large enough", "verdict", "large_enough"),
    )
    return Table("pulleys", "Pulleys", "Pulleys", columns, tuple(a.belt_duty.pulleys), "belt")


def pulley_loads(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Largest loads of every pulley over all cases and states; shaft, bearings, lagging."""
    system = a.conveyor.report.units
    every = [(load.label, duty) for load in loads for duty in load.found.pulley_duty]
    rows = []
    for own in a.pulley_duty:
        of = [(label, duty) for label, duty in every if duty.pulley.name == own.pulley.name]
        rows.append((own, *first_maximum(of, lambda pair: pair[1].largest.resultant), [duty for _, duty in of]))

    columns = (
        Column("pulley", "text", "0.pulley.name"),
        Column("driven", "verdict", lambda row: "yes" if row[0].pulley.driven else "no", page=None),
        Column("diameter", "size", "0.pulley.diameter"),
        Column("wrap", "angle", "0.pulley.wrap_angle", page=None),
        Column("rotation", "rotation", extreme_getter(max, "3", "rotation"), page=None),
        Column("resultant, steady", "force", "0.steady.resultant", page=None),
        Column("largest resultant", "force", "2.largest.resultant"),
        Column("in the state", "text", "2.largest.state"),
        Column("of the case", "text", lambda row: row[1].text(system), page=None),
        Column("largest torque", "torque", extreme_getter(max, "3", "torque")),
        Column("bending moment at the hub", "torque", extreme_getter(max, "3", "moment"), sparse=True, page=None),
        Column("shaft in the hub", "size", "0.pulley.hub_diameter"),
        Column("minimum shaft in the hub", "size", extreme_getter(max, "3", "least_shaft"), sparse=True),
        Column("slope at the hub", "friction", extreme_getter(max, "3", "slope"), sparse=True),
        Column("safety of the shaft", "ratio",
               extreme_getter(min, "3", "safety.0"), sparse=True),
        Column("L10 of a bearing, steady", "life", extreme_getter(min, "3", "bearing_seconds"), sparse=True),
        Column("pressure on the lagging", "pressure", extreme_getter(max, "3", "pressure")),
    )  # fmt: skip
    note = (
        "Resultant of belt and weight; without pull_angle the weight adds to the pull in full. Shaft after CEMA B105.1 "
        "(slope at most 0.0023, safety at least 1.5). Driven pulleys at one place are passed in the order listed."
    )
    heading = "Loads of the pulleys, all cases and states"
    return Table("pulley_loads", "Pulleys", heading, columns, tuple(rows), "belt", note)


def pulley_states(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Tensions, resultant and torque of every pulley in every case and state."""
    system = a.conveyor.report.units
    rows = tuple(
        (duty.pulley.name, load.label.text(system), pull)
        for load in loads
        for duty in load.found.pulley_duty
        for pull in duty.loads
    )
    columns = (
        Column("pulley", "text", "0"),
        Column("case", "text", "1"),
        Column("state", "text", "2.state"),
        Column("arriving", "force", "2.arriving"),
        Column("leaving", "force", "2.leaving"),
        Column("resultant", "force", "2.resultant"),
        Column("torque", "torque", "2.torque"),
    )
    heading = "Loads of the pulleys in every case and state"
    return Table("pulley_states", "States", heading, columns, rows, printed=False)


def _worst_of_cases(every: Iterable[Sequence[_Row]], **worst: Callable[[list[Any]], Any]) -> tuple[_Row, ...]:
    """Merge the rows of several cases: as in the first, with the worst known value of the named figures."""
    made = []
    for same in zip(*every, strict=True):
        known = {name: [one for row in same if (one := getattr(row, name)) is not None] for name in worst}
        made.append(replace(same[0], **{name: worst[name](ones) for name, ones in known.items() if ones}))
    return tuple(made)


def _curves_of_cases(loads: Sequence[Load]) -> tuple[HorizontalCurveCheck, ...]:
    """Horizontal curves with the states of all cases."""
    every = [load.found.horizontal for load in loads]
    return _worst_of_cases(
        every, states=lambda each: tuple(chain(*each)), overstress=max, buckling=max, most=max, least=min
    )


def vertical_curves(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Radius of every vertical curve and strand, and the minimum radii of all cases."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("curve", "text", "kind"),
        Column("radius", "length", "radius"),
        Column("lowest tension", "force", "lowest"),
        Column("highest tension", "force", "highest"),
        Column("minimum against lift-off", "length", "lift_off"),
        Column("minimum against overstress", "length", "overstress"),
        Column("minimum against slack strips", "length", "buckling"),
        Column("highest in a strip", "strength", "most"),
        Column("lowest in a strip", "strength", "least"),
    )
    every = [load.found.belt_duty.curves for load in loads]
    rows = _worst_of_cases(
        every, lowest=min, highest=max, lift_off=max, overstress=max, buckling=max, most=max, least=min
    )
    notes = [_USUAL_STIFFNESS] if rows and a.line.belt.stiffness is None else []
    if rows and a.line.wind_speed is not None:
        notes.append("Against lift-off: with the wind of ambient.wind_speed under the empty belt.")
    heading = "Vertical curves, all cases"
    return Table("vertical_curves", "Curves", heading, columns, rows, "belt", " ".join(notes))


def horizontal_curves(loads: Sequence[Load]) -> Table:
    """Drift and radius limits of every horizontal curve and strand over all cases."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("to the", "text", "turn.side"),
        Column("radius", "length", "radius"),
        Column("banking", "angle", "turn.banking"),
        Column("skew", "angle", "turn.skew"),
        Column("drift, steady", "size", "turn.drift"),
        Column("farthest inside", "size", "farthest_in.inside"),
        Column("farthest outside", "size", "farthest_out.outside"),
        Column("room on the rolls", "size", "turn.room"),
        Column("minimum against drift", "length", extreme_getter(max, "states", "least")),
        Column("maximum against drift", "length", extreme_getter(min, "states", "most")),
    )
    note = (
        "Drift is positive to the inside; steady as given. Inside: highest tension, 70 % of the guiding friction; "
        "outside: lowest tension, all of it; the wind of ambient.wind_speed either way on a strand without bulk. Of a "
        "flat set: at the end of the curve, with the worse of both. ∞: the belt runs off its rolls, or no radius is "
        "too large."
    )
    heading = "Horizontal curves, all cases"
    return Table("horizontal_curves", "Curves", heading, columns, _curves_of_cases(loads), "belt", note)


def curve_edges(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Edge tensions of horizontal curves; no rows where stiffness or strength are not known."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("radius", "length", "radius"),
        Column("minimum against overstress", "length", "overstress"),
        Column("minimum against a slack edge", "length", "buckling"),
        Column("highest at the outer edge", "strength", "most"),
        Column("lowest at the inner edge", "strength", "least"),
    )
    rows = tuple(curve for curve in _curves_of_cases(loads) if curve.most is not None)
    note = _USUAL_STIFFNESS if rows and a.line.belt.stiffness is None else ""
    heading = "Edges of the belt in horizontal curves, all cases"
    return Table("curve_edges", "Curves", heading, columns, rows, "belt", note)


def drift_states(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Tensions, drift and radius limits of horizontal curves in every case and state."""
    system = a.conveyor.report.units
    rows = tuple(
        (bend, load.label.text(system), state)
        for load in loads
        for bend in load.found.horizontal
        for state in bend.states
    )
    columns = (
        Column("section", "text", "0.section"),
        Column("strand", "text", "0.strand"),
        Column("case", "text", "1"),
        Column("state", "text", "2.state"),
        Column("lowest tension", "force", "2.lowest"),
        Column("highest tension", "force", "2.highest"),
        Column("farthest inside", "size", "2.inside"),
        Column("farthest outside", "size", "2.outside"),
        Column("minimum against drift", "length", "2.least"),
        Column("maximum against drift", "length", "2.most"),
    )
    heading = "Drift in horizontal curves in every case and state"
    return Table("drift_states", "States", heading, columns, rows, printed=False)


def transition_table(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Transition lengths, their minimum lengths and strip tensions over all cases."""
    columns = (
        Column("end", "text", "zone.end"),
        Column("pulley over depth of trough", "share", "zone.pulley_height"),
        Column("length", "spacing", "zone.length"),
        Column("minimum against overstress", "spacing", "stretched"),
        Column("minimum against slack strips", "spacing", "slackened"),
        Column("lowest tension per width", "strength", "lowest"),
        Column("highest tension per width", "strength", "highest"),
        Column("highest in a strip", "strength", "most"),
        Column("allowed in a strip", "strength", "allowed"),
        Column("lowest in a strip", "strength", "least"),
    )
    heading = "Transitions between trough and pulley, all cases"
    note = (
        "Strips of straight way, ISO 5293 taken on to every strip and a raised pulley; at most 130 % of the rated "
        "tension (or strength over the classic safety), none slack. Carry strand, every state of motion."
    )
    if a.line.transitions and a.line.belt.stiffness is None:
        note += f" {_USUAL_STIFFNESS}"
    note += "".join(f" Not known: {missing}." for missing in {row.missing for row in a.belt_duty.transitions} - {""})
    every = [load.found.belt_duty.transitions for load in loads]
    rows = _worst_of_cases(every, lowest=min, highest=max, stretched=max, slackened=max, most=max, least=min)
    return Table("transitions", "Curves", heading, columns, rows, "belt", note)


def convergence_table(a: CalculatedConveyor) -> Table:
    """Convergence of tensions and roll loads on the curves; empty without curves."""
    state = a.convergence
    rows = () if state is None else (
        Figure("steps", "count", float(state.steps)),
        Figure("last change over largest tension", "error", state.change),
        Figure("ratio of changes", "ratio", state.ratio),
        Figure("bound over largest tension", "error", state.bound),
    )  # fmt: skip
    heading = "Convergence of tensions and roll loads"
    page = (PagePlacement("belt", f"{heading} on the curves", printed=False),)
    return figure_table("convergence", "Loop", heading, rows, page=page, printed=False)


def _distinct_contacts(a: CalculatedConveyor) -> dict[Any, Any]:
    """Distinct load curves, each with the last stretch that uses it."""
    return {curve: r for r in a.stretches for roll in r.rolls for curve in roll.curve.solved}


def belt_support(a: CalculatedConveyor) -> Table:
    """Effect of belt compliance and shares of the loss, by strand; empty on a stiff carcass."""
    columns = (
        Column("strand", "text", "strand"),
        Column("lowest effective tension", "line force", "tensions.0"),
        Column("mean effective tension", "line force", "tensions.1"),
        Column("highest effective tension", "line force", "tensions.2"),
        Column("indentation on a stiff carcass", "force", "confined"),
        Column("indentation on the belt", "force", "force"),
        Column("change by the give", "share", "change"),
        Column("loss in the cover on the rolls", "share", lambda row: row.shares.get("bottom_cover")),
        Column("loss in the other cover", "share", lambda row: row.shares.get("top_cover")),
        Column("loss in the carcass", "share", lambda row: row.shares.get("carcass")),
    )
    rows = a.contacts.gives if isinstance(a.contacts, BeltContacts) else ()
    heading = "Effect of belt compliance, and shares of the loss"
    return Table("belt_support", "Indentation", heading, columns, rows, "rolls")


def contact_solutions(a: CalculatedConveyor) -> Table:
    """Distinct contacts: range of loads, size of the solution, errors."""
    gives = isinstance(a.contacts, BeltContacts)  # its contacts are solved at T - m' V² per width
    columns = (
        Column("strand", "text", "1.stretch.strand"),
        Column("roll", "size", lambda row: 2.0 * row[0].contact.radius),
        Column("spacing", "spacing", "0.contact.spacing"),
        Column("cover", "size", "0.contact.cover_thickness"),
        *((Column("effective tension", "line force", "0.contact.pull"),) if gives else ()),
        Column("lowest load", "line force", "0.lowest"),
        Column("highest load", "line force", "0.highest"),
        Column("order", "count", "0.stats.order"),
        Column("matrices", "count", "0.stats.matrices"),
        Column("nodes", "count", "0.stats.nodes"),
        Column("retardation terms", "count", "0.stats.terms"),
        Column("error estimate", "error", "0.error"),
        Column("energy error", "error", "0.energy_error"),
    )
    heading, caption = (
        "Contacts, one a distinct roll, cover and spacing",
        "Contact solutions, one a distinct roll, cover and spacing",
    )
    rows, page = tuple(_distinct_contacts(a).items()), (PagePlacement("provenance", caption, printed=False),)
    return Table("contact_solutions", "Indentation", heading, columns, rows, page, printed=False)


def indentation_table(a: CalculatedConveyor) -> Table:
    """Indentation against line load, one block per distinct contact, over the loads that occur."""
    seen: dict[Any, tuple[str, CoverTestFactor | None]] = {}
    for r in a.stretches:
        for roll in r.rolls:
            size, apart = (
                display_unit(kind, a.conveyor.report.units).four_digits(value)
                for kind, value in (("size", 2.0 * roll.curve.contact.radius), ("spacing", r.stretch.spacing))
            )
            for curve in roll.curve.solved:
                pull = curve.contact.pull
                held = (
                    "" if pull is None else f", {display_unit('line force', a.conveyor.report.units).four_digits(pull)}"
                )
                seen.setdefault(curve, (f"{r.stretch.strand}, {size}, {apart}{held}", r.cover.level))
    rows: list[tuple[Any, ...]] = []
    for curve, (label, level) in seen.items():
        loads = np.geomspace(curve.lowest, curve.highest, CURVE_POINTS)
        solved = curve.at(loads)
        resistance = solved.resistance if level is None else level.factor(loads) * solved.resistance
        columns = (loads, resistance, solved.half_width, solved.peak_pressure, solved.peak_error)
        rows += [(label, *point) for point in zip(*(column.tolist() for column in columns), strict=True)]
    declared = (
        Column("contact", "text", "0"),
        Column("line load", "line force", "1"),
        Column("indentation", "line force", "2"),
        Column("friction", "friction", lambda row: row[2] / row[1]),
        Column("half width", "thickness", "3"),
        Column("peak pressure", "pressure", "4"),
        Column("error of the peak", "share", "5"),
    )
    heading = "Indentation against line load, one block a contact"
    return Table("indentation", "Indentation", heading, declared, tuple(rows), printed=False)


def rubber_table(a: CalculatedConveyor) -> Table:
    """Compound, working strain, excitation band and test factor of every strand."""
    at, rows = a.temperature, []
    for strand, compound in compounds_by_strand(a.conveyor).items():
        strain = a.contacts.covers[strand].strain
        band, data = a.contacts.excited_band(strand), compound.frequencies(at)
        rows.append((strand, compound, band or (None, None), data or (None, None), strain))
    contacts = a.contacts
    columns = (
        Column("strand", "text", "0", json="strand"),
        Column("compound", "text", "1.name", json="compound"),
        Column("kind", "text", "1.kind"),
        Column("temperature", "temperature", lambda _: at, json="temperature_degC"),
        *band_columns("2", "3"),
        Column("", "text", lambda row: list(row[2]), page=None, sheet=False, json="excited_Hz", key="excited"),
        Column("", "text", lambda row: list(row[3]), page=None, sheet=False, json="data_Hz", key="data"),
        Column("working strain", "share", "4.strain", json="working_strain"),
        Column("E' factor of strain", "factor",
               lambda row: 1.0 if row[4] is None else row[4].storage_factor, json="storage_factor",
               key="storage_factor"),
        Column("E'' factor of strain", "factor",
               lambda row: 1.0 if row[4] is None else row[4].loss_factor, json="loss_factor", key="loss_factor"),
        Column("tests", "count", lambda row: sum(test.points().line_load.size for test in row[1].tests), page=None),
        Column("level factor", "factor", lambda row: contacts.test_factor(row[0]), json="level_factor"),
        Column("level from", "factor", lambda row: _test_factor_end(contacts, row[0], -1.0), json="level_from"),
        Column("level to", "factor", lambda row: _test_factor_end(contacts, row[0], 1.0), json="level_to"),
    )  # fmt: skip
    heading = "Rubber excitation band, working strain and level"
    return Table("rubber", "Rubber", heading, columns, rows, "rubber")


def _test_factor_end(contacts: Contacts, strand: Strand, sign: float) -> float | None:
    """Lower or upper end of a strand's test factor; None without tests."""
    if contacts.covers[strand].level is None:
        return None
    return contacts.test_factor(strand) * contacts.test_factor_range(strand)[sign > 0.0]


def band_columns(excited: str, data: str) -> Iterator[Column]:
    """Columns of excitation band and data range: numbers in workbook and files, text on the page."""
    for name, kind, path in (("excited", "passing", excited), ("data", "frequency", data)):
        yield Column(f"{name} from", kind, f"{path}.0", page=None)
        yield Column(f"{name} to", kind, f"{path}.1", page=None)
    yield Column("excitation band", "frequency", _in_hertz, sheet=False).of(excited)
    yield Column("band of the data", "frequency", _in_hertz, sheet=False).of(data)


def _in_hertz(band: tuple[float | None, float | None] | None) -> str | None:
    low, high = band or (None, None)
    return None if low is None or high is None else format_band((low, high)).removesuffix(" Hz")


def compound_tables(a: CalculatedConveyor, system: System) -> Iterator[Table]:
    """Facts, relaxation spectrum and moduli of the rubber of each strand."""
    at, seen = a.temperature, set()
    for strand, compound in compounds_by_strand(a.conveyor).items():
        if compound.name not in seen:
            seen.add(compound.name)
            yield _compound_facts(compound, strand, system)
        yield _prony_table(compound, strand, at)
        yield _moduli_table(compound, strand, at)


def _compound_facts(compound: RubberCompound, strand: str, system: System) -> Table:
    """Facts of a compound in words."""
    known, fit = compound.range, compound.fit
    warmth, share = display_unit("temperature", system), display_unit("share")
    band = compound.frequencies(compound.reference)
    said = (
        ("description", compound.description),
        ("origin", compound.source.origin),
        ("licence", compound.source.licence),
        ("data", compound.source.data or "not stated"),
        ("strain of the data", compound.strain or "not stated"),
        ("Poisson's ratio", repr(compound.poisson_ratio)),
        ("reference temperature", warmth.quantity_text(compound.reference_temperature)),
        ("equilibrium modulus", display_unit("pressure", system).quantity_text(compound.prony.equilibrium)),
        ("Prony terms", str(len(compound.prony.terms))),
        ("temperature shift", "none" if compound.shift is None else compound.shift.law),
        ("range of frequency", "not stated" if band is None else format_band(band)),
        ("range of temperature",
         "not stated" if known is None else " to ".join(map(warmth.quantity_text, known.temperature))),
        ("spectrum", "" if compound.carrier is None else f"of {compound.carrier}, which carries the tests"),
        ("rolling-resistance tests", "; ".join(dict.fromkeys(test.source for test in compound.tests)) or "none"),
        ("fit", "" if fit is None else fit.method),
        ("rms errors of E', E''", "" if fit is None or compound.kind != "measured" else
         f"{share.quantity_text(fit.storage_rms)}, {share.quantity_text(fit.loss_rms)}"),
        ("unknown", "; ".join(compound.missing) or "nothing listed"),
    )  # fmt: skip
    columns = (Column("fact", "text", "0"), Column("value", "text", "1"))
    rows = tuple((name, degree_signs(words)) for name, words in said if words)
    page = (PagePlacement("rubber", f"What is known of {compound.name}", printed=False),)
    return Table(f"known_{strand}", "", f"{compound.name} ({compound.kind})", columns, rows, page)


def _prony_table(compound: RubberCompound, strand: str, at: float) -> Table:
    """Relaxation spectrum of a compound, at the reference and at a temperature [K]."""
    reference = compound.series_at_reference
    columns = (
        Column("modulus", "pressure", "0"),
        Column("time at reference", "time", "1"),
        Column("time at belt temperature", "time", "2"),
    )
    values = (reference.moduli, reference.times, compound.series(at).times)
    rows = tuple(zip(*(value.tolist() for value in values), strict=True))
    return Table(f"prony_{strand}", "Rubber", "Relaxation spectrum", columns, rows, printed=False)


def _moduli_table(compound: RubberCompound, strand: str, at: float) -> Table:
    """E', E'', tan δ of a compound at a temperature [K] over frequency."""
    frequency = np.logspace(*_DECADES, (_DECADES[1] - _DECADES[0]) * _PER_DECADE + 1)
    series, omega = compound.series(at), 2.0 * np.pi * frequency
    values = (frequency, series.storage(omega), series.loss(omega), series.tan_delta(omega))
    columns = (
        Column("frequency", "frequency", "0"),
        Column("E'", "pressure", "1", key="storage"),
        Column("E''", "pressure", "2", key="loss"),
        Column("tan delta", "friction", "3"),
    )
    rows = tuple(zip(*(value.tolist() for value in values), strict=True))
    return Table(f"moduli_{strand}", "Rubber", "Moduli at the belt's temperature", columns, rows, printed=False)


class CheckRow(NamedTuple):
    """A check as text; `leads` if it governs its criterion."""

    subject: str
    found: str
    asked: str
    margin: float | None
    case: str
    verdict: str
    leads: bool

    @classmethod
    def of(cls, check: Check, system: System, *, leads: bool = False, not_sought: bool = False) -> CheckRow:
        """Write a check in a system of units; `not_sought`: no worse loading was searched for."""
        name, calculated, asked = (said.text(system) for said in (check.name, check.found, check.asked))
        case = AS_GIVEN if check.case is None else check.case.text(system)
        if not_sought:
            case += "; worst loading not sought"
        margin = None if check.verdict == "not checked" else check.margin
        return cls(name, calculated, asked, margin, case, check.verdict, leads)


_CHECK_COLUMNS: Final = (
    Column("check", "text", "subject"),
    Column("calculated", "text", "found", key="found"),
    Column("required", "text", "asked", key="asked"),
    Column("margin", "margin", "margin"),
)
_CASE_COLUMN: Final = Column("case", "text", "case")
_VERDICT_COLUMN: Final = Column("verdict", "verdict", "verdict")


def check_table(checks: tuple[Check, ...], system: System, not_sought: Collection[str] = ()) -> Table:
    """Checks of the governing case: calculated, required, verdict.

    `not_sought`: keys for which no worse loading was searched for.
    """
    first = governing_by_criterion(checks)
    unsought = not_sought if any(check.case is not None for check in checks) else ()
    rows = tuple(
        CheckRow.of(check, system, leads=any(check is one for one in first), not_sought=check.key in unsought)
        for check in checks
    )
    caption = "Calculated against required; of all calculated cases the least margin"
    note = "margin: reserve over the limit; least of all calculated cases"
    of_case = (_CASE_COLUMN,) if any(row.case != AS_GIVEN for row in rows) else ()
    page, columns = (PagePlacement("checks", caption),), (*_CHECK_COLUMNS, *of_case, _VERDICT_COLUMN)
    return Table("checks", "Checks and notes", "Checks", columns, rows, page, note)


def case_checks(every: tuple[Check, ...], system: System) -> Iterator[Table]:
    """Every criterion in every load case, and those that fail for the page."""
    rows = tuple(CheckRow.of(check, system) for check in every if check.case is not None)
    columns, heading = (_CASE_COLUMN, *_CHECK_COLUMNS, _VERDICT_COLUMN), "Every criterion in every load case"
    yield Table("case_checks", "Case checks", heading, columns, rows, named=2, printed=False)
    failed = tuple(row for row in rows if row.verdict == "FAIL")
    yield Table("case_failures", "", "Failed checks by case", columns, failed, "load-cases", named=2)


def analysis_remarks(
    a: CalculatedConveyor, checks: tuple[Check, ...], system: System, further: tuple[str, ...] = ()
) -> Table:
    """Warnings, method, assumptions, and the notes of the spec."""
    return remark_table({
        "warning": [line.text(system) for line in analysis_warnings(a, checks)],
        "method": method_summary(a),
        "assumption": (*analysis_assumptions(a.conveyor), *further),
        "note of the spec": [line for line in (a.conveyor.notes or "").splitlines() if line.strip()],
    })  # fmt: skip


def provenance_table(spec: str, sheet: str = "Checks and notes") -> Table:
    """Versions behind the figures; `spec` is the spec's SHA-256."""
    facts = {
        "spec SHA-256": spec,
        "date": date.today().isoformat(),
        "python": platform.python_version(),
        **{name: package_version(name) for name in _PACKAGES},
    }
    columns = (Column("made by", "text", "0"), Column("version", "text", "1"))
    page = (PagePlacement("provenance", "What made these figures", printed=False),)
    return Table("provenance", sheet, "Provenance", columns, tuple(facts.items()), page)


def drifts_by_case(loads: Sequence[Load], system: System) -> list[tuple[str, tuple[HorizontalCurveCheck, ...]]]:
    """Horizontal curves of every case, with its name."""
    return [(load.label.text(system).removeprefix("load state "), load.found.horizontal) for load in loads]


def analysis_drawings(a: CalculatedConveyor, system: System, loads: Sequence[Load]) -> Iterator[Drawing]:
    """Drawings of the page, each above a table."""
    conveyor, at = a.conveyor, a.temperature
    yield Drawing(
        "breakdown",
        "Resistances of this calculation, their sums beside the estimates with a given friction factor.",
        lambda: analysis_plots.resistance_breakdown(a.balance, system=system),
        "classical",
    )
    yield Drawing(
        "profile",
        "Profile of the route from the tail, with feeding points, drives and take-up.",
        lambda: analysis_plots.route_profile(conveyor, a.line, section_boundaries(a.line), system=system),
        "key-figures",
    )
    yield Drawing(
        "tensions",
        "Tension round the loop in every state, from the head along the return strand and back.",
        lambda: analysis_plots.tension_diagram(a.balance, a.motions, system=system),
        "section_ends",
    )
    yield from of_discharge(a, system)
    if a.horizontal:
        yield Drawing(
            "plan",
            "Plan of the route from the tail, horizontal curves in red; lengths across and along at one scale.",
            lambda: analysis_plots.plan_view(a.line, system=system),
            "sections",
        )
        yield Drawing(
            "drift",
            "Drift of the belt in every horizontal curve, all states of motion of all cases; grey: room on the rolls.",
            lambda: analysis_plots.drift_diagram(drifts_by_case(loads, system), system=system),
            "horizontal_curves",
        )
    yield Drawing(
        "cross-section",
        "A set of each strand with belt and bulk as it lies on it, to scale; the belt centred, the strand at rest.",
        lambda: analysis_plots.cross_section(conveyor, a.line, system=system),
        "distinct_rolls",
    )
    yield Drawing(
        "pressure",
        "Contact pressure at the highest line load of each strand; the contact leans to where the belt arrives.",
        lambda: analysis_plots.pressure_under_rolls(a.contacts, system=system),
        "distinct_rolls",
    )
    if any(duty.limits.flap_margin is not None for duty in a.set_duty):
        yield Drawing(
            "flap",
            "Natural frequencies of the belt between the idlers in steady running, and rotation of the rolls with the "
            "distance wanted.",
            lambda: analysis_plots.flap_diagram(a, system=system),
            "idler_sets",
        )
    strands = compounds_by_strand(conveyor)
    worked = {compound.name: compound for compound in strands.values()}
    for k, (name, compound) in enumerate(worked.items(), start=1):
        on_it = tuple(strand for strand, other in strands.items() if other.name == name)
        yield Drawing(
            f"rubber-{k}",
            f"Master curve of {name} at {display_unit('temperature', system).four_digits(at)}; "
            f"shaded: 90 % loss band of the {' and '.join(on_it)} rolls; dashed: beyond the data.",
            partial(analysis_plots.excited_master_curve, compound, at, a.contacts, on_it, system=system),
            f"known_{on_it[0]}",
        )


def analysis_json(
    a: CalculatedConveyor, studies: CalculatedStudies | None = None, further: ReportAdditions | None = None
) -> dict[str, Any]:
    """Plain numbers for JSON, SI or the unit in the key, as `result_schema` describes them."""
    balance, studies = a.balance, CalculatedStudies() if studies is None else studies
    settled, every = balance.settled, _every_check(a, studies, further)
    governing = governing_by_subject(every)
    left_open = power_range(a)
    data: dict[str, Any] = {
        "schema_version": SCHEMA_VERSION,
        "name": a.conveyor.name,
        **dict.fromkeys(("flow_t_per_h", "length_m", "lift_m", "friction_factor", "error_estimate")),
        "forces_N": dict.fromkeys(balance.forces.parts),
        "power_kW": dict.fromkeys(("belt", "motor", "mains")),
        "tensions_N": asdict(balance.tensions),
        "drives": [
            {
                "drive": side.name,
                "force_N": side.force,
                "motor_kW": balance.frame.motor(side.force) / 1e3,
                "arriving_N": side.arriving,
                "leaving_N": side.leaving,
            }
            for side in settled.steady.drives
        ],
        "take_up": take_up_json(*take_up_demand(a, studies.states, studies.cases)),
        "energy": _energy_json(a, studies.duty),
        "classical": {
            **_estimate_json(balance, balance.classical),
            "secondary_by": balance.classical.secondary_by,
        },
        "cema": None
        if balance.cema is None
        else {
            **_estimate_json(balance, balance.cema),
            "items_N": {symbol: newtons for symbol, _, newtons in balance.cema.items},
        },
        "defaults": {
            "motor_kW": {"low": None, "high": None},
            "replace_first": left_open.effects[0].give if left_open.effects else None,
            "in_use": default_table(left_open, "SI").plain(),
            "notes": list(left_open.notes),
        },
        "rubber": rubber_table(a).plain(),
        "sections": section_table(a).plain(),
        "assumptions": [*analysis_assumptions(a.conveyor), *(() if further is None else further.assumptions)],
        "checks": [check_json(check, governs=any(check is one for one in governing)) for check in every],
        "warnings": [said.text(a.conveyor.report.units) for said in analysis_warnings(a, governing)],
    }
    also = {} if further is None else {"dynamics": further.plain}
    return insert_by_path(data, result_table(a, left_open).rows) | plain_studies(studies) | also


def _energy_json(a: CalculatedConveyor, duty: CalculatedYear | None) -> dict[str, Any]:
    """Specific energy, and energy and cost of a year at even load or of the duty."""
    price = None if a.conveyor.operation is None else a.conveyor.operation.price
    kwh, cost = (None, None) if a.year is None else (a.year.energy, a.year.cost)
    if duty is not None:
        kwh, cost = duty.year.net_kwh, duty.cost
    return {
        "kWh_per_tonne_km": a.balance.power.energy_per_tonne_km,
        "kWh_per_year": kwh,
        "cost_per_year": cost,
        "currency": None if price is None else price.currency,
    }


def check_json(check: Check, *, governs: bool) -> dict[str, Any]:
    """A check as JSON, in SI."""
    calculated, required, margin = map(_finite_or_none, (check.calculated, check.required, check.margin))
    (shown, sign), (asked, _) = (plain_figure(value, check.kind) for value in (calculated, required))
    return {
        "key": check.key,
        "subject": check.subject.text(),
        "where": check.where or None,
        "case": None if check.case is None else check.case.text(),
        "calculated": shown,
        "relation": check.relation,
        "required": asked,
        "unit": sign,
        "margin": margin,
        "verdict": check.verdict.lower(),
        "why": None if check.why is None or check.verdict == "pass" else check.why.text(),
        "governs": governs,
    }


def _finite_or_none(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def _estimate_json(balance: Balance, made: ClassicalEstimate) -> dict[str, float]:
    motor = _estimate_motor_power(balance, made)
    return {"friction_factor": made.friction_factor, "total_N": made.total, "motor_kW": motor / 1e3}


def insert_by_path(data: dict[str, Any], rows: Iterable[Figure]) -> dict[str, Any]:
    """Insert figures into plain data at their dotted paths, in SI units of reports."""
    for row in rows:
        if row.json:
            *path, last = row.json.split(".")
            inside = data
            for name in path:
                inside = inside.setdefault(name, {})
            inside[last] = row.unit("SI").shown(row.value)
    return data
