"""Results for people: compounds compared and verified against tests, factors fitted to measured power.

Separate from `conveyor.results.analysis`, so that one conveyor is calculated without importing any of this.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from conveyor.arguments.argument_types import check_arguments
from conveyor.measured.run_table import read_runs
from conveyor.models import Conveyor, MeasuredRun, RubberCompound
from conveyor.models.variants import CoverChoice
from conveyor.pipeline import ProgressCallback
from conveyor.report.report_exports import ReportExports
from conveyor.results.analysis import as_results_class, results_function
from conveyor.studies import calibration as calibration_study
from conveyor.studies import comparison as compound_study
from conveyor.studies import verification as verification_study
from conveyor.studies.comparison import RTOL
from conveyor.units import Quantity
from conveyor.units.sentences import reraise_in_units
from conveyor.units.unit_systems import report_system

if TYPE_CHECKING:
    import pandas as pd

    from conveyor.report.table_model import Contents
    from conveyor.results.analysis_figures import ComparisonPlots
    from conveyor.units import System


class Comparison(compound_study.CalculatedComparison, ReportExports):
    """Compounds on one conveyor, with tables, reports and figures."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per scene; units in the names."""
        from conveyor.report.tables import comparison_tables

        return comparison_tables.scene_table(self).frame()

    @cached_property
    def ranking(self) -> pd.DataFrame:
        """One row per compound and speed, the least mean power first; savings and payback against the base."""
        from conveyor.report.tables.ranking_tables import ranking_table

        return ranking_table(self).frame()

    def contents(self, system: System | None = None) -> Contents:
        """Everything a report holds, in a system of units."""
        from conveyor.report.tables.comparison_tables import comparison_contents

        return comparison_contents(self, report_system(self.conveyor.report.units, system))

    @property
    def plots(self) -> ComparisonPlots:
        """Figures: power over temperature and speed, loss tangents."""
        from conveyor.results.analysis_figures import ComparisonPlots

        return ComparisonPlots(self)

    def _repr_html_(self) -> str:
        """For notebooks: the ranking and its remarks."""
        from conveyor.report.tables import comparison_tables

        return str(comparison_tables.comparison_notebook(self))


class CalibrationStudy(calibration_study.CalculatedCalibration, ReportExports):
    """Factors from measured power, with their tables."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per factor with its band."""
        from conveyor.report.tables.calibration_tables import factor_table

        return factor_table(self).frame()

    @cached_property
    def residuals(self) -> pd.DataFrame:
        """One row per run: measured, calculated before and after; units in the names."""
        from conveyor.report.tables.calibration_tables import run_table

        return run_table(self).frame()

    def contents(self, system: System | None = None) -> Contents:
        """Everything a report holds, in a system of units."""
        from conveyor.report.tables.calibration_tables import calibration_contents

        return calibration_contents(self, report_system(self.conveyor.report.units, system))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON; units in the keys."""
        from conveyor.report.tables.calibration_tables import calibration_json

        return calibration_json(self)


class VerificationSheet(verification_study.CalculatedVerification, ReportExports):
    """Losses of compounds under rolls for comparison with a maker's tests, with tables and reports."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per compound, cover, roll, speed and temperature; units in the names."""
        return self.contents()["per_width"].frame()

    def contents(self, system: System | None = None) -> Contents:
        """Contents of a report in a system of units, SI by default."""
        from conveyor.report.tables.verification_tables import verification_contents

        return verification_contents(self, "SI" if system is None else system)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON; units in the keys."""
        from conveyor.report.tables.verification_tables import verification_json

        return verification_json(self)


compare_compounds = results_function("compare_compounds", compound_study.compare_compounds, Comparison)
verify_sheet = results_function("verify_sheet", verification_study.verify_compounds, VerificationSheet)


@check_arguments
def calibrate(
    conveyor: Conveyor,
    runs: str | Path | Sequence[MeasuredRun],
    *,
    error: float | None = None,
    factors: Sequence[str] | None = None,
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
) -> CalibrationStudy:
    """Fit factors on forces to measured power, as `conveyor.studies.calibration.fit_factors`.

    Parameters
    ----------
    conveyor : Conveyor
        The spec; its own calibration is ignored and replaced.
    runs : path or sequence of MeasuredRun
        Measured power: a file or data.
    error : float, optional
        Relative standard deviation of a power [-], for runs that do not state theirs; by default from the residuals,
        with bands no narrower than 2 % make them.
    factors : sequence of str, optional
        Those of indentation, idler_rotation, flexure and misalignment to fit; by default as many as the runs resolve.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of the spec.
    progress : callable, optional
        Called with the items done and their total.

    Returns
    -------
    CalibrationStudy
        Factors with bands, runs with residuals, and their tables.

    Raises
    ------
    InputError
        The file is refused, or the runs do not resolve the factors.
    NoSolutionError, RangeError
        A run has no answer.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> conveyor.calibrate(line, "runs.csv").table  # doctest: +SKIP
    """
    given = read_runs(runs) if isinstance(runs, str | Path) else runs
    with reraise_in_units(conveyor.report.units):
        found = calibration_study.fit_factors(
            conveyor, given, error=error, factors=factors, rtol=rtol, progress=progress
        )
        return as_results_class(found, CalibrationStudy)


@check_arguments
def compare(
    conveyor: Conveyor,
    compounds: Iterable[str | RubberCompound],
    *,
    temperatures: Iterable[str | Quantity] | None = None,
    speeds: Iterable[str | Quantity] | None = None,
    cover: CoverChoice = "bottom",
    base: str | None = None,
    extra_costs: Mapping[str, float] | None = None,
    lot_scatter: float | Mapping[str, float] | None = None,
    rtol: float = RTOL,
    shelves: Iterable[str | Path] = (),
    executor: Executor | None = None,
    workers: int = 1,
    progress: ProgressCallback | None = None,
) -> pd.DataFrame:
    """The table of `compare_compounds`, one row per scene.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    compounds : iterable of str or RubberCompound
        Shelf names, paths of compound files, or compounds.
    temperatures, speeds : iterable of str or Quantity, optional
        Of the belt, each with its unit ("-30 degC", "5 m/s"); by default those of the spec.
    cover : {"bottom", "top", "both"}
        Cover made of the compounds, the bottom one by default.
    base : str, optional
        Name of the reference compound; by default the first.
    extra_costs : mapping of str to float, optional
        Price of a belt of a compound above that of the base, in the currency of the spec's energy price.
    lot_scatter : float or mapping of str to float, optional
        Half-width of the 90 % interval of the indentation from lot to lot, of all compounds or by name [-]; by default
        what a compound's file states, else 8 %.
    rtol : float
        Relative tolerance of the contacts, 1e-4 by default [-].
    shelves : iterable of path
        Further folders of compounds; none by default.
    executor : concurrent.futures.Executor, optional
        Executor of groups of compounds; by default they are calculated one after the other in this process.
    workers : int
        Workers of the executor, and number of groups.
    progress : callable, optional
        Called with the number of compounds done and their total.

    Returns
    -------
    pandas.DataFrame
        Columns with their units in the names.

    Raises
    ------
    InputError
        No compound, one twice, an unknown base or name, a value without unit or outside its range.
    ConveyorError
        A worker was lost.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> conveyor.compare(line, ["s100", "s120"], temperatures=["0 degC", "20 degC"])  # doctest: +SKIP
    """
    return compare_compounds(
        conveyor,
        compounds,
        temperatures=temperatures,
        speeds=speeds,
        cover=cover,
        base=base,
        extra_costs=extra_costs,
        lot_scatter=lot_scatter,
        rtol=rtol,
        shelves=shelves,
        executor=executor,
        workers=workers,
        progress=progress,
    ).table
