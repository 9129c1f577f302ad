"""Contents of the report of an analysis: its tables by key, its drawings, its JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Final, TypeAlias

from conveyor.assessment import Assessment
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import unsearched_criteria
from conveyor.line.covers import compounds_by_strand
from conveyor.line.stretches import STRANDS
from conveyor.report import analysis_plots
from conveyor.report.table_model import Contents, Drawing, Table
from conveyor.report.tables import (
    bed_tables,
    belt_tables,
    check_tables,
    curve_tables,
    design_verdict,
    document_tables,
    drive_tables,
    dynamics_tables,
    feeder_tables,
    idler_tables,
    inputs,
    loop_tables,
    resistance_tables,
    result_tables,
    rubber_tables,
    study_tables,
    transfer_tables,
    what_if,
)
from conveyor.spec import fingerprint
from conveyor.studies.load_cases import Load
from conveyor.units.presentation import display_unit

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


Maker: TypeAlias = Callable[["AnalysisTables"], Table]


@dataclass(frozen=True, eq=False)
class AnalysisTables(Mapping[str, Table]):
    """Tables of an assessed conveyor by their names (docs/workbook.md), each built when it is read.

    A table without rows is left out.
    """

    assessment: Assessment
    _built: dict[str, Table] = field(default_factory=dict, repr=False)

    @property
    def own(self) -> CalculatedConveyor:
        """The spec's own load."""
        return self.assessment.own

    def __getitem__(self, key: str) -> Table:
        if key not in self._built:
            self._built[key] = TABLES[key](self)
        if not self._built[key].rows:
            raise KeyError(key)
        return self._built[key]

    def __iter__(self) -> Iterator[str]:
        return (key for key in TABLES if key in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)


def _own_table(make: Callable[[CalculatedConveyor], Table]) -> Maker:
    """Table of the spec's own load."""
    return lambda made: make(made.own)


def _load_table(make: Callable[[CalculatedConveyor, Sequence[Load]], Table]) -> Maker:
    """Table of the spec's own load and of all loads to design by."""
    return lambda made: make(made.own, made.assessment.loads)


def _study_maker(key: str) -> Maker:
    """Table of a study, without rows where that was not requested."""
    return lambda made: (
        study_tables.STUDY_TABLES[key](made.assessment.studies, made.assessment.system) or _empty_table(key)
    )


def _scenario_maker(key: str) -> Maker:
    """Table of the scenarios, without rows where there are none."""

    def make(made: AnalysisTables) -> Table:
        dynamics = made.assessment.dynamics
        return _empty_table(key) if dynamics is None else dynamics_tables.SCENARIO_TABLES[key](dynamics)

    return make


def _empty_table(key: str) -> Table:
    return Table(key, "", "", (), ())


def _grouped_inputs(made: AnalysisTables, *, defaults: bool) -> Table:
    return document_tables.grouped_input_table(made["inputs"].rows, made.assessment.system, defaults=defaults)


def _governing_checks(made: AnalysisTables) -> Table:
    of = made.assessment
    return check_tables.check_table(of.governing, of.system, unsearched_criteria(of.own.line))


TABLES: Final[dict[str, Maker]] = {
    "identity": lambda made: document_tables.identity_table(made.own.conveyor, made.assessment.system),
    "governing_figures": lambda made: design_verdict.governing_figures(made.assessment),
    "results": lambda made: result_tables.result_table(made.own, made.assessment.power_range),
    "inputs_given": partial(_grouped_inputs, defaults=False),
    "inputs_default": partial(_grouped_inputs, defaults=True),
    "defaults": lambda made: result_tables.default_table(made.assessment.power_range, made.assessment.system),
    "inputs": lambda made: document_tables.input_table(inputs.input_rows(made.own.conveyor)),
    "sections": _own_table(resistance_tables.section_table),
    "resistances": _own_table(resistance_tables.resistance_table),
    "classical": lambda made: resistance_tables.classical_table(made.own, made.assessment.by_contact),
    "cema": _own_table(resistance_tables.cema_table),
    "slider_beds": _own_table(bed_tables.slider_bed_table),
    "breakdown": _own_table(resistance_tables.breakdown_table),
    "distinct_rolls": lambda made: idler_tables.distinct_rolls(made.own, made["rolls"]),
    "idler_sets": _load_table(idler_tables.idler_sets),
    "rolls": _own_table(idler_tables.roll_table),
    "section_ends": _own_table(loop_tables.section_ends),
    "tensions": _own_table(loop_tables.tension_table),
    "tension_states": _own_table(loop_tables.tension_states),
    "profile": _own_table(loop_tables.profile_table),
    "drives": _own_table(drive_tables.drive_table),
    "take_up": lambda made: loop_tables.take_up_table(made.own, made.assessment.take_up),
    "tension_conditions": _own_table(loop_tables.take_up_conditions),
    "start_stop": _own_table(drive_tables.start_stop_table),
    "brakes": _own_table(drive_tables.brake_table),
    "drive_parts": _load_table(drive_tables.drive_parts),
    "belt_strength": _own_table(belt_tables.belt_strength_table),
    "pulleys": _own_table(belt_tables.pulley_table),
    "pulley_loads": _load_table(belt_tables.pulley_loads),
    "pulley_states": _load_table(belt_tables.pulley_states),
    "vertical_curves": _load_table(curve_tables.vertical_curves),
    "horizontal_curves": lambda made: curve_tables.horizontal_curves(made.assessment.loads),
    "pipe_curves": _load_table(curve_tables.pipe_curves),
    "curve_edges": _load_table(curve_tables.curve_edges),
    "drift_states": _load_table(curve_tables.drift_states),
    "transitions": _load_table(curve_tables.transition_table),
    "landings": _own_table(transfer_tables.loading_point_table),
    "hoppers": _own_table(feeder_tables.hopper_table),
    "hopper_states": _own_table(feeder_tables.hopper_state_table),
    "cleaners": _own_table(transfer_tables.cleaner_table),
    "discharge": _own_table(transfer_tables.discharge_table),
    "trajectory": _own_table(transfer_tables.trajectory_table),
    "pulley_outline": _own_table(transfer_tables.pulley_outline),
    "convergence": _own_table(loop_tables.convergence_table),
    **{key: _study_maker(key) for key in study_tables.STUDY_TABLES},
    "what_if": lambda made: what_if.what_if_table(
        made.own, made.assessment.studies.duty, made.assessment.governing_motor_power
    ),
    "belt_support": _own_table(rubber_tables.belt_support),
    "contact_solutions": _own_table(rubber_tables.contact_solutions),
    "indentation": _own_table(rubber_tables.indentation_table),
    "rubber": _own_table(rubber_tables.rubber_table),
    **{
        f"{name}_{strand}": _own_table(partial(make, strand=strand))
        for strand in STRANDS
        for name, make in (
            ("known", rubber_tables.compound_facts),
            ("prony", rubber_tables.prony_table),
            ("moduli", rubber_tables.moduli_table),
        )
    },
    **{key: _scenario_maker(key) for key in dynamics_tables.SCENARIO_TABLES},
    "case_checks": lambda made: check_tables.case_checks(made.assessment.checks, made.assessment.system),
    "case_failures": lambda made: check_tables.case_failures(made.assessment.checks, made.assessment.system),
    "checks": _governing_checks,
    "remarks": lambda made: check_tables.analysis_remarks(made.assessment),
    "provenance": lambda made: document_tables.provenance_table(fingerprint(made.own.conveyor)),
}
"""Tables of the report of a conveyor, in order."""


def analysis_contents(assessment: Assessment) -> Contents:
    """Contents of the report of an assessed conveyor, in the units of its report."""
    about = document_tables.report_head(assessment.own.conveyor, "Belt conveyor calculation", assessment.system)
    tables, draw = AnalysisTables(assessment), partial(analysis_drawings, assessment)
    return Contents(about, tables, assessment.system, draw, PARTS, "conveyor")


def analysis_drawings(assessment: Assessment) -> Iterator[Drawing]:
    """Drawings of the page, each above a table."""
    a, system = assessment.own, assessment.system
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
        lambda: analysis_plots.route_profile(conveyor, a.line, loop_tables.section_boundaries(a.line), system=system),
        "key-figures",
    )
    yield Drawing(
        "tensions",
        "Tension round the loop in every state, from the head along the return strand and back.",
        lambda: analysis_plots.tension_diagram(a.balance, a.motions, system=system),
        "section_ends",
    )
    yield from transfer_tables.discharge_drawing(a, system)
    if any(section.horizontal is not None for section in a.line.sections):
        yield Drawing(
            "plan",
            "Plan of the route from the tail, horizontal curves in red; lengths across and along at one scale.",
            lambda: analysis_plots.plan_view(a.line, system=system),
            "sections",
        )
    if a.horizontal:
        yield Drawing(
            "drift",
            "Drift of the belt in every horizontal curve, all states of motion of all cases; grey: room on the rolls.",
            lambda: analysis_plots.drift_diagram(curve_tables.drifts_by_case(assessment.loads, system), system=system),
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
            f"Master curve of {name} at {display_unit('temperature', system).said(at, 4)}; "
            f"shaded: 90 % loss band of the {' and '.join(on_it)} rolls; dashed: beyond the data.",
            partial(analysis_plots.excited_master_curve, compound, at, a.contacts, on_it, system=system),
            f"known_{on_it[0]}",
        )
    yield from study_tables.study_drawings(assessment.studies, system)
    if assessment.dynamics is not None:
        yield from dynamics_tables.dynamics_drawings(assessment.dynamics, system)
