"""The parts of the HTML report on what a spec asks for beyond one analysis: load cases, duty, uncertainty."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pandas as pd

from conveyor.markup import Html, element, joined
from conveyor.report import analysis_plots, case_tables
from conveyor.report.html_sections import drawn
from conveyor.report.page import Part, bullets, listed, number, table
from conveyor.report.unit_systems import converted_figure
from conveyor.units import System

if TYPE_CHECKING:
    from conveyor.studies import Studies
    from conveyor.studies.cases import CaseStudy
    from conveyor.studies.duty import DutyStudy
    from conveyor.studies.uncertainty import UncertaintyStudy

_CASE_FIGURES = (
    "case", "temperature [degC]", "belt speed [m/s]", "mass flow [t/h]", "indentation [N]", "effective tension [N]",
    "motor power [kW]", "largest tension [N]", "smallest tension [N]", "take-up tension asked for [N]",
)  # fmt: skip


def studied(studies: Studies, system: System) -> Iterator[Part]:
    """Parts of what was studied."""
    if studies.cases is not None:
        yield Part("load-cases", "Load cases", cases(studies.cases, system))
    if studies.duty is not None:
        yield Part("duty", "Duty of a year", duty(studies.duty, system))
    if studies.uncertainty is not None:
        yield Part("uncertainty", "Uncertainty", uncertainty(studies.uncertainty, system))


def cases(study: CaseStudy, system: System) -> Html:
    """Governing cases, power over temperature and speed, every case, motors, refusals."""
    low, high = study.friction_band
    content = [
        table(_governing(study, system), "Governing cases"),
        element(
            "p",
            f"Governing figures take friction between {low:g} and {high:g} of the computed one, to the safe side.",
            class_="note",
        ),
    ]
    if len({result.temperature for result in study.results}) > 1:
        made = analysis_plots.case_power_against_temperature(study, system=system)
        content.append(drawn(made, "case-temperature", "Motor power of the load cases over temperature."))
    if len({result.speed for result in study.results}) > 1:
        made = analysis_plots.case_power_against_speed(study, system=system)
        content.append(drawn(made, "case-speed", "Motor power of the load cases over belt speed."))
    if study.results:
        frame = case_tables.cases(study)[list(_CASE_FIGURES)]
        content.append(table(frame, "Load cases", system=system))
        content.append(table(case_tables.motors(study.motors()), "Motors of the series", system=system))
    refused = case_tables.refused_cases(study)
    if not refused.empty:
        content.append(table(refused, "Cases without an answer", system=system))
    return joined(content)


def _governing(study: CaseStudy, system: System) -> pd.DataFrame:
    """Value and unit as text: the figures are of different kinds."""
    rows = []
    for row in case_tables.governing(study).to_dict("records"):
        name, (value,) = converted_figure(f"figure [{row['unit']}]", [float(row["value"])], system)
        (warm, (temperature,)), (fast, (speed,)) = (
            converted_figure(known, [row[known]], system)
            for known in ("temperature [degC]", "belt speed [m/s]")
        )
        shown = f"{number(name, value)} {name.partition('[')[2].rstrip(']')}"
        rows.append(
            {"figure": row["figure"], "value": shown, "case": row["case"], warm: temperature, fast: speed}
        )
    return pd.DataFrame(rows)


def duty(study: DutyStudy, system: System) -> Html:
    """The year's sums and its histogram."""
    content = [
        listed(case_tables.year(study), "The year", system=system),
        table(case_tables.duty(study), "Hours at load, temperature and speed", system=system),
    ]
    if study.emission_source:
        content.append(element("p", f"Carbon dioxide: {study.emission_source}.", class_="note"))
    return joined(content)


def uncertainty(study: UncertaintyStudy, system: System) -> Html:
    """The power's band, what matters, what was left out."""
    matters = case_tables.tornado(study)
    columns = [
        "input",
        "low",
        "as given",
        "high",
        "change at low [kW]",
        "change at high [kW]",
        "share of variance [-]",
    ]
    content = [
        table(case_tables.band(study), "Motor power with the band that holds nine tenths", system=system),
        drawn(
            analysis_plots.tornado(study, system=system),
            "tornado",
            "Change of the motor power at both ends of every input's range.",
        ),
        table(matters[columns], "Which input matters", system=system),
    ]
    if study.notes:
        content.append(bullets(study.notes))
    return joined(content)
