"""Results for people: tables, reports, figures and notebooks; nothing below imports this.

The functions calculate like those of `conveyor.pipeline` and `conveyor.studies`, and add tables, reports and figures.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, Self, TypeVar

from conveyor.arguments.argument_types import check_arguments
from conveyor.assessment import Assessment
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import Check
from conveyor.models import Conveyor
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.studies import CalculatedStudies, calculate_studies
from conveyor.studies import duty as duty_study
from conveyor.studies import input_ranges as range_study
from conveyor.studies import load_cases as case_study
from conveyor.studies import states as state_study
from conveyor.studies.loads import EveryLoad, StudyProgress
from conveyor.units.unit_systems import report_system

if TYPE_CHECKING:
    import pandas as pd

    from conveyor.dynamics.simulation import CalculatedDynamics
    from conveyor.report.table_files import FileKind
    from conveyor.report.table_model import Contents, Table
    from conveyor.results.analysis_figures import AnalysisPlots
    from conveyor.units import System

Given = ParamSpec("Given")
Face = TypeVar("Face")


class Analysis(CalculatedConveyor):
    """Everything calculated for one conveyor, with tables, reports and figures.

    Examples
    --------
    >>> import conveyor
    >>> conveyor.analyse(conveyor.load("examples/specs/overland.yaml")).in_units("US").conveyor.report.units
    'US'
    """

    def __getstate__(self) -> dict[str, Any]:
        """Calculated fields only; tables are built anew, as their columns are functions."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def assessment(self) -> Assessment:
        """Checks, range of power and take-up of this load, without studies."""
        return Assessment(self)

    @property
    def checks(self) -> tuple[Check, ...]:
        """Every criterion with its verdict."""
        return self.assessment.own_checks

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Assumptions behind every figure."""
        return self.assessment.assumptions

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Strained assumptions and criteria not met, in the units of the spec's report."""
        return tuple(said.text(self.conveyor.report.units) for said in analysis_warnings(self, self.checks))

    def in_units(self, system: System | None) -> Self:
        """Return the same analysis with remarks and reports in another system of units; None leaves it as it is.

        Tables (`summary`, `sections` …) stay SI; `to_tables(system=)` and the reports convert them.
        """
        if system is None or system == self.conveyor.report.units:
            return self
        report = self.conveyor.report.replace(units=system)
        return replace(self, conveyor=self.conveyor.replace(report=report))

    def at_common_take_up(self, studies: Studies | None) -> Self:
        """Return the same load at the common take-up setting of all loads of `conveyor.analyse_studies`."""
        states = None if studies is None else studies.states
        if states is None:
            return self
        own = states.own
        return replace(
            self, contacts=own.contacts, balance=own.balance, rubber_free=own.rubber_free, convergence=own.convergence
        )

    def assess(self, studies: Studies | None = None) -> Assessment:
        """Checks, governing loads, range of power and take-up, with `conveyor.analyse_studies` if given."""
        return (
            self.assessment
            if studies is None
            else Assessment(self.at_common_take_up(studies), studies, studies.dynamics)
        )

    def contents(self, studies: Studies | None = None, *, system: System | None = None) -> Contents:
        """Contents of a report in a system of units, with `conveyor.analyse_studies` if given."""
        from conveyor.report.tables.analysis_contents import analysis_contents

        return analysis_contents(self.assess(studies).in_units(report_system(self.conveyor.report.units, system)))

    @cached_property
    def tables(self) -> Mapping[str, Table]:
        """Every table of the reports by its name (docs/workbook.md); `.frame(system)` is the data frame.

        A table is built when it is read.
        """
        from conveyor.report.tables.analysis_contents import AnalysisTables

        return AnalysisTables(self.assessment)

    @cached_property
    def summary(self) -> pd.Series:
        """Figures of the whole conveyor; units in the names."""
        return self.tables["results"].series(self.conveyor.name)

    @cached_property
    def sections(self) -> pd.DataFrame:
        """One row per section and strand; units in the names."""
        return self.tables["sections"].frame()

    @cached_property
    def resistances(self) -> pd.DataFrame:
        """Every force and its source; the rows add up to the effective tension."""
        return self.tables["resistances"].frame()

    @cached_property
    def rolls(self) -> pd.DataFrame:
        """One row per roll of every section's set; units in the names."""
        return self.tables["rolls"].frame()

    @cached_property
    def rubber(self) -> pd.DataFrame:
        """One row per strand: compound, excited band against its data, working strain; units in the names."""
        return self.tables["rubber"].frame()

    def to_dict(self, studies: Studies | None = None) -> dict[str, Any]:
        """Plain numbers for JSON, SI or the unit in the key, with `conveyor.analyse_studies` if given.

        `conveyor schema --result` prints the JSON schema of it.
        """
        from conveyor.report.tables.result_schema import analysis_json

        return analysis_json(self.assess(studies))

    @check_arguments
    def to_excel(self, path: str | Path, studies: Studies | None = None, *, system: System | None = None) -> Path:
        """Write the workbook, with the sheets of `conveyor.analyse_studies` if given.

        Parameters
        ----------
        path : str or Path
            Name of the workbook, ending in ``.xlsx``; an older workbook there is replaced. A table too long for a
            sheet goes to a CSV file beside it.
        studies : Studies, optional
            Load cases, duty and uncertainty.
        system : {"SI", "US"}, optional
            Units of the tables; without it those of the spec's report.

        Raises
        ------
        InputError
            The path cannot be written, or the system is none of these.
        """
        from conveyor.report.excel import write_workbook

        return write_workbook(self.contents(studies, system=system), Path(path))

    @check_arguments
    def to_tables(
        self,
        folder: str | Path,
        studies: Studies | None = None,
        *,
        system: System | None = None,
        kind: FileKind = "csv",
    ) -> tuple[Path, ...]:
        """Write every table of the workbook as a file of its own; names as in docs/workbook.md.

        Parameters
        ----------
        folder : str or Path
            A folder that exists; older files of the same names are replaced.
        studies : Studies, optional
            Load cases, duty and uncertainty.
        system : {"SI", "US"}, optional
            Units of the tables; without it those of the spec's report.
        kind : {"csv", "parquet"}
            Parquet needs the package pyarrow.

        Raises
        ------
        InputError
            No such folder, it cannot be written to, an unknown system or kind, or Parquet without pyarrow.
        """
        from conveyor.report.table_files import write_tables

        return write_tables(self.contents(studies, system=system), Path(folder), kind)

    @check_arguments
    def to_html(self, path: str | Path, studies: Studies | None = None, *, system: System | None = None) -> Path:
        """Write the HTML report, one static page, with the parts of `conveyor.analyse_studies` if given.

        Parameters
        ----------
        path : str or Path
            Name of the page, ending in ``.html``; an older page there is replaced.
        studies : Studies, optional
            Load cases, duty and uncertainty.
        system : {"SI", "US"}, optional
            Units of the tables; without it those of the spec's report.

        Raises
        ------
        InputError
            The path cannot be written, or the system is none of these.
        """
        from conveyor.report.html import write_page

        return write_page(self.contents(studies, system=system), Path(path))

    @check_arguments
    def to_pdf(self, path: str | Path, studies: Studies | None = None, *, system: System | None = None) -> Path:
        """Write the HTML report as a PDF; as `to_html`, to a name ending in ``.pdf``.

        Raises
        ------
        InputError
            As `to_html`, or the package typst is not installed.
        """
        from conveyor.report.pdf import write_pdf

        return write_pdf(self.contents(studies, system=system), Path(path))

    @property
    def plots(self) -> AnalysisPlots:
        """Figures: resistances, tensions, flap, profile, pressure, rubber, power over temperature and speed."""
        from conveyor.results.analysis_figures import AnalysisPlots

        return AnalysisPlots(self)

    def __repr__(self) -> str:
        balance = self.balance
        return (
            f'Analysis("{self.conveyor.name}": motor power {balance.power.motor / 1e3:.1f} kW, effective tension '
            f"{balance.forces.total:.0f} N, f {balance.friction_factor:.4f}, error {self.error_estimate:.0e})"
        )

    def _repr_html_(self) -> str:
        """For notebooks: key figures, failed checks, warnings."""
        from conveyor.report.page_elements import notebook_summary

        return str(notebook_summary(self.contents()))


class CaseStudy(case_study.CalculatedCases):
    """Load cases of a conveyor, with their table."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per case, temperature and speed; units in the names."""
        from conveyor.report.tables.study_tables import case_table

        return case_table(self).frame()

    def _repr_html_(self) -> str:
        from conveyor.report.tables.study_tables import cases_notebook

        return str(cases_notebook(self))


class StateStudy(state_study.CalculatedStates):
    """Load states of a conveyor, with their table."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per state; units in the names."""
        from conveyor.report.tables.study_tables import load_states

        return load_states(self).frame()

    def _repr_html_(self) -> str:
        from conveyor.report.tables.study_tables import states_notebook

        return str(states_notebook(self))


class DutyStudy(duty_study.CalculatedYear):
    """A year of a conveyor, with its tables."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per bar; units in the names."""
        from conveyor.report.tables.study_tables import duty_table

        return duty_table(self).frame()

    @cached_property
    def summary(self) -> pd.Series:
        """Sums of the year; units in the names."""
        from conveyor.report.tables.study_tables import year_table

        return year_table(self).series("year")

    def _repr_html_(self) -> str:
        from conveyor.report.tables.study_tables import duty_notebook

        return str(duty_notebook(self))


class UncertaintyStudy(range_study.CalculatedRanges):
    """The power with its band, with the table of effects."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """The tornado: one row per input, the largest swing first; units in the names."""
        from conveyor.report.tables.study_tables import sensitivity_table

        return sensitivity_table(self).frame()

    def _repr_html_(self) -> str:
        from conveyor.report.tables.study_tables import uncertainty_notebook

        return str(uncertainty_notebook(self))


@dataclass(frozen=True, eq=False, repr=False)
class Studies(CalculatedStudies):
    """Studies of one conveyor, each with its tables; None for those that the spec does not request."""

    states: StateStudy | None = None
    cases: CaseStudy | None = None
    duty: DutyStudy | None = None
    uncertainty: UncertaintyStudy | None = None
    dynamics: CalculatedDynamics | None = None

    def _repr_html_(self) -> str:
        """For notebooks: every study present."""
        held = (self.states, self.cases, self.duty, self.uncertainty)
        return "".join(study._repr_html_() for study in held if study is not None) or "<p>nothing to study</p>"

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers of the studies present for JSON; units in the keys."""
        from conveyor.report.tables.study_json import studies_json

        return studies_json(self)


def as_results_class(plain: Any, face: Callable[..., Face]) -> Face:
    """Convert plain results to their class for people."""
    return face(**{field.name: getattr(plain, field.name) for field in fields(plain)})


def results_function(name: str, work: Callable[Given, Any], face: type[Face]) -> Callable[Given, Face]:
    """Wrap a function to return results of a class for people, named as in the module of that class for pickling.

    Its signature and docstring state that class, too.
    """

    @wraps(work)
    def called(*given: Given.args, **named: Given.kwargs) -> Face:
        return as_results_class(work(*given, **named), face)

    plain = inspect.signature(work)
    called.__module__, called.__name__, called.__qualname__ = face.__module__, name, name
    called.__annotations__ = {**work.__annotations__, "return": face}
    called.__signature__ = plain.replace(return_annotation=face)  # type: ignore[attr-defined]
    called.__doc__ = (work.__doc__ or "").replace(str(plain.return_annotation), face.__name__)
    return called


analyse = results_function("analyse", calculate, Analysis)
analyse_cases = results_function("analyse_cases", case_study.analyse_cases, CaseStudy)
analyse_duty = results_function("analyse_duty", duty_study.analyse_duty, DutyStudy)
study_ranges = results_function("study_ranges", range_study.analyse_ranges, UncertaintyStudy)


def analyse_studies(
    conveyor: Conveyor, given: CalculatedConveyor | None = None, *, progress: StudyProgress | None = None
) -> Studies:
    """Calculate the load states and what the spec requests: load cases, duty, ranges, scenarios.

    Parameters
    ----------
    conveyor : Conveyor
        With `cases`, `operation.duty`, `uncertainty`, `scenarios`, or none of them.
    given : CalculatedConveyor, optional
        The spec's own load, if already calculated; `conveyor.analyse` returns it.
    progress : callable, optional
        Called with the study's name, the items done and their total.

    Returns
    -------
    Studies
        Studies for the reports of an `Analysis`.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        The spec's own load, a bar of the duty, a range or a scenario has no answer; cases without one are listed.

    Examples
    --------
    >>> import conveyor
    >>> conveyor.analyse_studies(conveyor.load("examples/specs/shuttle.yaml"))
    Studies(states, flooded)
    """
    made = calculate_studies(conveyor, given, progress=progress)
    return Studies(
        states=None if made.states is None else as_results_class(made.states, StateStudy),
        cases=None if made.cases is None else as_results_class(made.cases, CaseStudy),
        duty=None if made.duty is None else as_results_class(made.duty, DutyStudy),
        uncertainty=None if made.uncertainty is None else as_results_class(made.uncertainty, UncertaintyStudy),
        flooded=made.flooded,
        dynamics=_scenario_results(conveyor, made, progress) if conveyor.scenarios else None,
    )


def _scenario_results(
    conveyor: Conveyor, made: CalculatedStudies, progress: StudyProgress | None
) -> CalculatedDynamics:
    """Simulated scenarios of a spec, at the take-up setting of its loads."""
    from conveyor.dynamics.simulation import simulate_scenarios

    loads = None if made.states is None else EveryLoad(made.states, made.cases)
    told = None if progress is None else partial(progress, "scenarios")
    return simulate_scenarios(conveyor, progress=told, loads=loads)
