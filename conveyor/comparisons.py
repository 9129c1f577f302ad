"""Compounds compared, held to a maker's tests, and forces fitted to measured power: the results for people.

Apart from `conveyor.analysis`, so that one conveyor is calculated without reading any of this.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from conveyor.analysis import faced, facing
from conveyor.measured.runs import read_runs
from conveyor.models import Conveyor, MeasuredRun, RubberCompound
from conveyor.studies import calibration as calibration_study
from conveyor.studies import comparison as compound_study
from conveyor.studies import verification as verification_study
from conveyor.units.presentation import chosen
from conveyor.units.sentences import telling

if TYPE_CHECKING:
    import pandas as pd

    from conveyor.drawing import ComparisonPlots
    from conveyor.report.columns import Contents
    from conveyor.report.files import FileKind
    from conveyor.units import System


class Comparison(compound_study.CalculatedComparison):
    """Compounds on one conveyor, with tables, reports and figures."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a scene; units in the names."""
        from conveyor.report import comparison_tables

        return comparison_tables.scenes(self).frame()

    @cached_property
    def ranking(self) -> pd.DataFrame:
        """One row a compound and speed, the least mean power first; savings and payback against the base."""
        from conveyor.report import comparison_tables

        return comparison_tables.ranking(self).frame()

    def contents(self, system: System | None = None) -> Contents:
        """Everything a report holds, in a system of units."""
        from conveyor.report.comparison_tables import of_comparison

        return of_comparison(self, chosen(self.conveyor.report.units, system))

    def to_excel(self, path: str | Path, *, system: System | None = None) -> Path:
        """Write the workbook; as `Analysis.to_excel`."""
        from conveyor.report.excel import write

        return write(self.contents(system), Path(path))

    def to_tables(
        self, folder: str | Path, *, system: System | None = None, kind: FileKind = "csv"
    ) -> tuple[Path, ...]:
        """Write every table as a file of its own; as `Analysis.to_tables`."""
        from conveyor.report.files import write

        return write(self.contents(system), Path(folder), kind)

    def to_html(self, path: str | Path, *, system: System | None = None) -> Path:
        """Write the HTML report; as `Analysis.to_html`."""
        from conveyor.report.html import write

        return write(self.contents(system), Path(path))

    def to_pdf(self, path: str | Path, *, system: System | None = None) -> Path:
        """Write the HTML report as it prints; as `Analysis.to_pdf`."""
        from conveyor.report.pdf import write

        return write(self.contents(system), Path(path))

    @property
    def plots(self) -> ComparisonPlots:
        """Figures: power over temperature and speed, loss tangents."""
        from conveyor.drawing import ComparisonPlots

        return ComparisonPlots(self)

    def _repr_html_(self) -> str:
        """For notebooks: the ranking and what to know of it."""
        from conveyor.report import comparison_tables

        return comparison_tables.notebook_of_comparison(self)


class CalibrationStudy(calibration_study.CalculatedCalibration):
    """Factors from measured power, with their tables."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a factor with its band."""
        from conveyor.report.calibration_tables import factors

        return factors(self).frame()

    @cached_property
    def residuals(self) -> pd.DataFrame:
        """One row a run: measured, calculated before and after; units in the names."""
        from conveyor.report.calibration_tables import runs

        return runs(self).frame()

    def contents(self, system: System | None = None) -> Contents:
        """Everything a report holds, in a system of units."""
        from conveyor.report.calibration_tables import of_calibration

        return of_calibration(self, chosen(self.conveyor.report.units, system))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON; units in the keys."""
        from conveyor.report.calibration_tables import plain

        return plain(self)


class VerificationSheet(verification_study.CalculatedVerification):
    """What compounds lose under rolls, to be held to a maker's tests, with its tables and reports."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a compound, cover, roll, speed and temperature; units in the names."""
        return self.contents()["per_width"].frame()

    def contents(self, system: System = "SI") -> Contents:
        """Everything a report holds, in a system of units."""
        from conveyor.report.verification_tables import of_verification

        return of_verification(self, system)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON; units in the keys."""
        from conveyor.report.verification_tables import plain

        return plain(self)


compare_compounds = facing("compare_compounds", compound_study.compare_compounds, Comparison)
verify_sheet = facing("verify_sheet", verification_study.verification, VerificationSheet)


def calibrate(
    conveyor: Conveyor, runs: str | Path | Sequence[MeasuredRun], **options: Any
) -> CalibrationStudy:
    """Factors on forces from measured power, of a file or of runs; as `conveyor.studies.calibration.calibrate`.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> conveyor.calibrate(line, "runs.csv").table  # doctest: +SKIP
    """
    given = read_runs(runs) if isinstance(runs, str | Path) else runs
    with telling(conveyor.report.units):
        return faced(calibration_study.calibrate(conveyor, given, **options), CalibrationStudy)


def compare(conveyor: Conveyor, compounds: Iterable[str | RubberCompound], **options: Any) -> pd.DataFrame:
    """The table of `compare_compounds`, one row a scene; its options are those of `compare_compounds`.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> conveyor.compare(line, ["s100", "s120"], temperatures=["0 degC", "20 degC"])  # doctest: +SKIP
    """
    return compare_compounds(conveyor, compounds, **options).table
