"""Studies that take longer than a change of the page: the year, ranges of inputs, starts and stops through time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from conveyor.assessment import Assessment
from conveyor.desk.answer_parts import named_table
from conveyor.errors import InputError
from conveyor.models import Conveyor
from conveyor.pipeline import ProgressCallback
from conveyor.report.tables.dynamics_tables import SCENARIO_TABLES
from conveyor.studies.duty import analyse_duty
from conveyor.studies.input_ranges import analyse_ranges
from conveyor.studies.loads import EveryLoad
from conveyor.text.markup import Html, join_html

_TABLES: Final[Mapping[str, tuple[str, ...]]] = {
    "year": ("duty_year", "duty"),
    "ranges": ("power_band", "sensitivity"),
    "starts": tuple(SCENARIO_TABLES),
}
_ROWS: Final = 60
"""Rows up to which a table of a study is shown; the course of every figure through time is in the reports."""
STUDY_NAMES: Final[Mapping[str, str]] = {
    "year": "the year's duty",
    "ranges": "ranges of the inputs",
    "starts": "starts and stops through time",
}
"""Studies of the page by key, in words."""


def offered_studies(conveyor: Conveyor) -> dict[str, str]:
    """Studies that a spec has what they need for: the year its duty, the ranges their inputs; starts always."""
    missing = {"year": not conveyor.duty, "ranges": conveyor.uncertainty is None}
    return {key: words for key, words in STUDY_NAMES.items() if not missing.get(key)}


def study_part(assessment: Assessment, key: str, progress: ProgressCallback) -> Html:
    """Tables of one study of an assessed variant.

    Parameters
    ----------
    assessment : Assessment
        With its load states.
    key : str
        One of `offered_studies`.
    progress : callable
        Called with the items done and their total.

    Raises
    ------
    InputError
        The spec does not have what the study needs.
    NoSolutionError, RangeError
        A variant has no answer.
    """
    conveyor, held = assessment.own.conveyor, assessment.studies
    if key not in offered_studies(conveyor) or held.states is None:
        raise InputError(f"{key}: no study of this spec; there are {', '.join(offered_studies(conveyor))}")
    take_up = held.states.take_up
    if key == "year":
        made = replace(
            assessment, studies=replace(held, duty=analyse_duty(conveyor, take_up=take_up, progress=progress))
        )
    elif key == "ranges":
        made = replace(
            assessment, studies=replace(held, uncertainty=analyse_ranges(conveyor, take_up=take_up, progress=progress))
        )
    else:
        from conveyor.dynamics.simulation import simulate_scenarios

        loads = EveryLoad(held.states, held.cases)
        made = replace(assessment, dynamics=simulate_scenarios(conveyor, progress=progress, loads=loads))
    parts = [named_table(made, name, most=_ROWS) for name in _TABLES[key]]
    return join_html(part for part in parts if part is not None)
