"""Tables of load states, load cases, duty and uncertainty, declared once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from conveyor.laws.power import JOULE_PER_KWH
from conveyor.report import analysis_plots
from conveyor.report.page_elements import notebook_html
from conveyor.report.plots import PowerAxis
from conveyor.report.table_model import (
    FIGURE_NAME,
    ROW_KIND,
    Column,
    Drawing,
    Figure,
    PagePlacement,
    Table,
    figure_table,
)
from conveyor.text.markup import Html
from conveyor.units import System
from conveyor.units.presentation import MONEY
from conveyor.units.sentences import degree_signs

if TYPE_CHECKING:
    from conveyor.studies import CalculatedStudies
    from conveyor.studies.duty import CalculatedYear
    from conveyor.studies.flooding import FloodedBelt
    from conveyor.studies.input_ranges import CalculatedRanges
    from conveyor.studies.load_cases import CalculatedCases, CaseResult, GoverningLoad
    from conveyor.studies.monte_carlo import Percentiles
    from conveyor.studies.states import CalculatedStates

_FLOODED = (
    "Bulk at its heaviest, {}, on the whole route, at the take-up's setting: load on structure, belt and drives if the "
    "feeder does not stop (general knowledge). Nothing is checked by it; the mass is without sets and frame."
)
_STATES, _CASES, _DUTY, _UNCERTAINTY = "load-states", "load-cases", "duty", "uncertainty"
_TENSIONS = (
    "tight_side_tension", "slack_side_tension", "largest_tension", "smallest_tension", "take_up_tension_asked_for",
    "governed_by",
)  # fmt: skip
_ROLL_LOADS = ("largest_roll_load", "at_roll")
_CONDITIONS = (
    Column("temperature", "temperature", "temperature"),
    Column("belt speed", "speed", "speed", key="speed"),
)


def _study_table(name: str, make: Callable[[Any], Table]) -> Callable[[CalculatedStudies, System], Table | None]:
    """Table of one of the studies; None without it."""
    return lambda studies, _system: None if (study := getattr(studies, name)) is None else make(study)


def study_drawings(studies: CalculatedStudies, system: System) -> Iterator[Drawing]:
    """Drawings of the studies of a conveyor."""
    if studies.cases is not None:
        yield from _case_drawings(studies.cases, system)
    if studies.uncertainty is not None:
        study = studies.uncertainty
        caption = "Sensitivity of motor power: its change at both ends of the range of every input."
        draw = partial(analysis_plots.tornado_chart, study, system=system)
        yield Drawing("tornado", caption, draw, "sensitivity")
        exact = study.monte_carlo
        if exact is not None:
            caption = (
                "Ends of the 90 % interval of the inputs' ranges alone after ever more draws; shaded: between "
                "which each lies with 90 %."
            )
            draw = partial(analysis_plots.interval_convergence, exact, study.sampled, system=system)
            yield Drawing("settling", caption, draw, "convergence_of_draws")


def load_states(study: CalculatedStates) -> Table:
    """Load states: loaded sections, power, tensions, required take-up tension."""
    columns = (
        Column("state", "text", "label", key="state"),
        Column("sections loaded", "text", "loaded_in_words"),
        Column("temperature", "temperature", "temperature"),
        Column("effective tension", "force", "balance.forces.total"),
        Column("belt power", "power", "balance.power.belt", page=None),
        Column("motor power", "power", "balance.power.motor"),
        Column("tight side tension", "force", "balance.tensions.tight", page=None),
        Column("slack side tension", "force", "balance.tensions.slack", page=None),
        Column("maximum tension", "force", "balance.tensions.largest", key="largest_tension"),
        Column("minimum tension, steady", "force", "balance.tensions.smallest", key="smallest_tension"),
        Column("required take-up tension", "force", "balance.equilibrium.needed", key="take_up_tension_asked_for"),
        Column("governed by", "text", "balance.equilibrium.governing", page=None),
    )
    note = (
        "All with the take-up at its setting. Inclines only and declines only leave level sections empty; not listed "
        "where that is the full or the empty belt. The worst "
        "loadings are looked for at every temperature of the cases: to calculate one as a case, loading: sections."
    )
    return Table("load_states", "Load cases", "Load states", columns, study.states, _STATES, note)


def refused_states(study: CalculatedStates) -> Table:
    """Load states without a solution, with the reason."""
    columns = (
        Column("state", "text", "name"),
        Column("temperature", "temperature", "temperature"),
        Column("reason", "text", lambda row: degree_signs(row.reason)),
    )
    heading = "Load states without an answer"
    return Table("refused_states", "Load cases", heading, columns, study.refused, _STATES)


def design_case_table(study: CalculatedCases) -> Table:
    """Load cases without their tensions, for reports."""
    every = case_table(study)
    kept = tuple(column for column in every.columns if column.key not in {*_TENSIONS, *_ROLL_LOADS})
    return replace(every, columns=kept, page=_CASES)


def case_tensions(study: CalculatedCases) -> Table:
    """Tensions and roll loads of the load cases."""
    heading = "Tensions and roll loads of the cases"
    whole = case_table(study).only("case", "temperature", "speed", "covered", *_TENSIONS, *_ROLL_LOADS)
    views = {"covered": None, **dict.fromkeys(_TENSIONS, "tensions"), **dict.fromkeys(_ROLL_LOADS, "rolls")}
    columns = tuple(replace(column, page=views.get(column.key, "")) for column in whole.columns)
    page = (
        PagePlacement(_CASES, "Tensions of the cases", "tensions"),
        PagePlacement(_CASES, "Highest roll load of the cases", "rolls"),
    )
    return replace(whole, key="case_tensions", heading=heading, columns=columns, page=page)


def _loading_text(result: CaseResult) -> str:
    return f"{result.case.loading}, reversed" if result.case.reversed else result.case.loading


def case_table(study: CalculatedCases) -> Table:
    """Load cases, one row per case, speed and temperature."""
    columns = (
        Column("case", "text", "case.name"),
        *_CONDITIONS,
        Column("loading", "text", _loading_text, page=None),
        Column("covered", "verdict", lambda row: "yes" if row.covered else "NO"),
        Column("mass flow", "mass flow", "found.line.flow"),
        Column("indentation", "force", "found.balance.forces.indentation"),
        Column("main resistance", "force", "found.balance.forces.main", page=None),
        Column("effective tension", "force", "found.balance.forces.total"),
        Column("motor power", "power", "found.balance.power.motor"),
        Column("motor power, least friction", "power", "motors.0", page=None),
        Column("motor power, design friction", "power", "motors.1", page=None),
        Column("equivalent DIN f", "friction", "found.balance.friction_factor", page=None),
        Column("tight side tension", "force", "found.balance.tensions.tight", page=None),
        Column("slack side tension", "force", "found.balance.tensions.slack", page=None),
        Column("maximum tension", "force", "found.balance.tensions.largest", json="largest tension",
               key="largest_tension"),
        Column("minimum tension, steady", "force", "found.balance.tensions.smallest",
               json="smallest tension", key="smallest_tension"),
        Column("required take-up tension", "force", "found.balance.equilibrium.needed",
               json="take-up tension asked for", key="take_up_tension_asked_for"),
        Column("governed by", "text", "found.balance.equilibrium.governing", page=None),
        Column("maximum roll load", "force", "heaviest_roll.0", page=None,
               json="largest roll load", key="largest_roll_load"),
        Column("at roll", "text", "heaviest_roll.1", page=None),
        Column("energy", "specific energy", "energy_per_tonne_km", page=None),
        Column("error estimate", "error", "found.error_estimate", page=None),
    )  # fmt: skip
    note = (
        "covered: NO where the rubber data do not cover the excitation band: not for design, and left out of tables of "
        "all cases."
    )
    shown = "" if all(row.covered for row in study.results) else note
    return Table("load_cases", "Load cases", "Load cases", columns, study.results, note=shown, named=3)


def governing_cases(study: CalculatedCases, governing: Sequence[GoverningLoad]) -> Table:
    """Governing value of every figure, with its load case or load state."""
    low, high = study.friction_band
    columns = (
        Column("figure", FIGURE_NAME, "label"),
        Column("case", "text", "value.result.name"),
        Column("value", ROW_KIND, "value.value"),
        *(column.of("value.result") for column in _CONDITIONS),
    )
    rows = tuple(Figure(row.figure, row.kind, row, key=f"governing_{row.key}") for row in governing)
    left_out = [row.label.text() for row in study.results if not row.covered]
    held = "; negative: the motors hold the belt" if any(row.value < 0.0 for row in governing) else ""
    note = f"friction {low:.3g} to {high:.3g} times the computed, least favourable{held}"
    if left_out:
        note += f"; without {'; '.join(left_out)}: the rubber data do not cover the excitation band there"
    return Table("governing_cases", "Load cases", "Governing cases", columns, rows, _CASES, note, links=True)


def refused_cases(study: CalculatedCases) -> Table:
    """Cases without a solution, with the reason."""
    columns = (
        Column("case", "text", "case"),
        *_CONDITIONS,
        Column("reason", "text", lambda row: degree_signs(row.reason)),
    )
    heading = "Cases without an answer"
    return Table("refused_cases", "Load cases", heading, columns, study.refused, _CASES)


def motor_table(studies: CalculatedStudies, system: System) -> Table:
    """Required power of every drive pulley over all cases and load states, and standard motors."""
    columns = (
        Column("drive", "text", "drive"),
        Column("governing case", "text", lambda row: row.case.text(system)),
        Column("required at the shaft", "power", "needed", json="needed at the shaft"),
        Column("reserve", "ratio", "reserve"),
        Column("motors", "count", "count"),
        Column("rated each", "power", "rated"),
        Column("series", "text", "series"),
        Column("installed", "power", lambda row: row.count * row.rated),
    )
    heading = "Selected standard motors"
    note = "For the largest motor power of all load cases and load states."
    return Table("motors", "Load cases", heading, columns, studies.motors, _CASES, note)


def _case_drawings(study: CalculatedCases, system: System) -> Iterator[Drawing]:
    overs: tuple[PowerAxis, ...] = ("temperature", "speed")
    for over, words in zip(overs, ("temperature", "belt speed"), strict=True):
        if len({getattr(result, over) for result in study.results}) > 1:
            draw = partial(analysis_plots.case_power, study, over, system=system)
            yield Drawing(f"case-{over}", f"Motor power of the load cases over {words}.", draw, "load_cases")


def duty_table(study: CalculatedYear) -> Table:
    """Hours at load, temperature and speed: bars of the yearly histogram."""
    columns = (
        Column("hours", "duration", lambda row: 3600.0 * row.hours),
        Column("load share", "share", "share"),
        *_CONDITIONS,
        Column("mass flow", "mass flow", "flow"),
        Column("effective tension", "force", "effective"),
        Column("motor power", "power", "shaft"),
        Column("mains power", "power", "mains"),
        Column("energy", "energy", lambda row: row.energy * JOULE_PER_KWH),
        Column("conveyed", "conveyed", "mass"),
    )
    heading = "Hours at load, temperature and speed"
    return Table("duty", "Duty", heading, columns, study.rows, _DUTY)


def year_table(study: CalculatedYear) -> Table:
    """Sums of the year; cost and emission only if price and factor are given."""
    sums = study.year
    rows = (
        Figure("in operation", "duration", sums.time),
        Figure("conveyed", "conveyed", sums.mass),
        Figure("drawn", "energy", sums.drawn_kwh * JOULE_PER_KWH),
        Figure("fed back", "energy", sums.fed_back_kwh * JOULE_PER_KWH),
        Figure("net", "energy", sums.net_kwh * JOULE_PER_KWH),
        Figure("energy", "specific energy", study.energy_per_tonne_km),
        Figure("cost", f"{MONEY}{study.currency or '-'}", study.cost),
        Figure("carbon dioxide", "carbon dioxide", study.emission),
    )
    note = f"Carbon dioxide: {study.emission_source}." if study.emission_source else ""
    return figure_table("duty_year", "Duty", "The year", rows, page=_DUTY, note=note, prefix="year_")


def sensitivity_table(study: CalculatedRanges) -> Table:
    """Sensitivity of the motor power to every input, the most influential first."""
    columns = (
        Column("input", "text", "0.name"),
        Column("low", "text", "0.low"),
        Column("as given", "text", "0.given"),
        Column("high", "text", "0.high"),
        Column("motor power at low", "power", "0.motor_low", page=None),
        Column("motor power at high", "power", "0.motor_high", page=None),
        Column("change at low", "power", lambda row: row[0].motor_low - study.motor),
        Column("change at high", "power", lambda row: row[0].motor_high - study.motor),
        Column("swing", "power", "0.swing", page=None),
        Column("share of variance", "share", "1"),
    )
    rows, heading = tuple(zip(study.effects, study.shares, strict=True)), "Sensitivity ranking"
    note = "; ".join(study.notes)
    return Table("sensitivity", "Uncertainty", heading, columns, rows, _UNCERTAINTY, note)


def power_bands(study: CalculatedRanges) -> Table:
    """Motor power with its band, one row per method of combining the inputs."""
    columns = (
        Column("combined by", "text", "0"),
        Column("motor power, low", "power", "1.0"),
        Column("motor power", "power", lambda _: study.motor),
        Column("motor power, high", "power", "1.1"),
    )
    exact, rows = study.monte_carlo, [
        ("root sum of squares, first order", study.band), ("Latin hypercube, first order", study.sampled),
    ]  # fmt: skip
    if exact is not None:
        rows.append((f"Monte Carlo, {len(exact.power)} draws in full", exact.band))
    note = ""
    if study.uncovered_defaults:
        names = "; ".join(effect.name for effect in study.uncovered_defaults)
        rows.append((f"root sum of squares, with the defaults in use: {names}", study.band_with_defaults))
        note = "The last row alone has the defaults in use that no range covers; the others leave them out."
    heading = "Motor power, 90 % interval of the inputs' ranges"
    return Table("power_band", "Uncertainty", heading, columns, rows, _UNCERTAINTY, note)


def flooded_belt(study: FloodedBelt) -> Table:
    """Loads of a belt full to the brim on drives, belt and structure."""
    found, heading = study.found, "Flooded belt"
    rows: list[Figure] = [
        Figure("cross-section of the bulk", "area", study.section),
        Figure("cross-section over what the belt holds", "share", study.section / study.held),
    ]
    note = f"No answer: {study.reason}." if found is None else _FLOODED.format(found.conveyor.idlers.carry.shape.brim)
    if found is not None:
        balance, duty = found.balance, found.belt_duty
        powers = [drive.power for drive in found.line.drives]
        installed = None if None in powers else math.fsum(power for power in powers if power is not None)
        rows += [
            Figure("mass flow", "mass flow", found.line.flow),
            Figure("mass of belt and bulk", "line mass", study.line_mass),
            Figure("load of a carry set", "force", study.set_load),
            Figure("effective tension", "force", balance.forces.total),
            Figure("motor power", "power", balance.power.motor),
            Figure("motor power over installed", "share", installed and abs(balance.power.motor) / installed),
            Figure("resistance after standstill, at most", "force", found.motions.start.breakaway),
            Figure("maximum tension, all states", "force", balance.tensions.largest),
            Figure("safety, steady", "ratio", duty.safety_steady),
            Figure("required take-up tension", "force", balance.equilibrium.needed),
        ]
    return figure_table("flooded", "Load cases", heading, rows, page=_STATES, note=note, prefix="flooded_")


def draw_convergence(study: CalculatedRanges) -> Table:
    """Ends of the interval over the number of draws, with their own intervals; no rows without draws."""

    def end(name: str, k: int) -> Callable[[Percentiles], float]:
        return lambda row: float(getattr(row, f"{name}_between")[k])

    columns = (
        Column("draws", "count", "draws"),
        Column("motor power, low", "power", "low", key="low"),
        Column("low end, from", "power", end("low", 0)),
        Column("low end, to", "power", end("low", 1)),
        Column("motor power, high", "power", "high", key="high"),
        Column("high end, from", "power", end("high", 0)),
        Column("high end, to", "power", end("high", 1)),
    )
    exact = study.monte_carlo
    rows = () if exact is None else exact.convergence
    reasons = {} if exact is None else exact.refused
    note = "; ".join(f"{count} draws have no answer: {why}" for why, count in reasons.items())
    heading = "Monte Carlo: ends of the 90 % interval, and between which they lie with 90 %"
    return Table("convergence_of_draws", "Uncertainty", heading, columns, rows, _UNCERTAINTY, note)


def _governing_table(studies: CalculatedStudies, _system: System) -> Table | None:
    return None if studies.cases is None else governing_cases(studies.cases, studies.governing)


STUDY_TABLES: Final[dict[str, Callable[[CalculatedStudies, System], Table | None]]] = {
    "load_states": _study_table("states", load_states),
    "refused_states": _study_table("states", refused_states),
    "flooded": _study_table("flooded", flooded_belt),
    "governing_cases": _governing_table,
    "load_cases": _study_table("cases", design_case_table),
    "case_tensions": _study_table("cases", case_tensions),
    "motors": lambda studies, system: None if studies.cases is None else motor_table(studies, system),
    "refused_cases": _study_table("cases", refused_cases),
    "duty_year": _study_table("duty", year_table),
    "duty": _study_table("duty", duty_table),
    "power_band": _study_table("uncertainty", power_bands),
    "convergence_of_draws": _study_table("uncertainty", draw_convergence),
    "sensitivity": _study_table("uncertainty", sensitivity_table),
}
"""Tables of studies by key; None where a study was not requested."""


def states_notebook(study: CalculatedStates) -> Html:
    """Load states for a notebook, and those without a solution."""
    refusals = [f"{row.name}: {row.reason}" for row in study.refused]
    tables = [(f"{study.conveyor.name}: load states", load_states(study))]
    return notebook_html(study.conveyor.report.units, tables, {"without an answer": refusals})


def cases_notebook(study: CalculatedCases) -> Html:
    """Governing cases for a notebook, and those without a solution."""
    refusals = [f"{row.case}: {row.reason}" for row in study.refused]
    tables = [(f"{study.conveyor.name}: governing load cases", governing_cases(study, study.governing))]
    return notebook_html(study.conveyor.report.units, tables, {"without an answer": refusals})


def duty_notebook(study: CalculatedYear) -> Html:
    """Sums and bars of the year for a notebook."""
    tables = [(f"{study.conveyor.name}: the year", year_table(study)), ("bars", duty_table(study))]
    return notebook_html(study.conveyor.report.units, tables)


def uncertainty_notebook(study: CalculatedRanges) -> Html:
    """Bands and sensitivity of the motor power for a notebook."""
    tables = [
        (f"{study.conveyor.name}: motor power", power_bands(study)),
        ("sensitivity ranking", sensitivity_table(study)),
    ]
    return notebook_html(study.conveyor.report.units, tables, {"notes": study.notes})
