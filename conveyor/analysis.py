"""From a conveyor to its forces, tensions and power: the whole calculation in one call."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from conveyor.display import chosen
from conveyor.errors import InputError
from conveyor.line.walk import StretchResult, worst_error
from conveyor.loop.balance import Balance
from conveyor.loop.belt_duty import BeltDuty, belt_duty
from conveyor.loop.curved import Convergence, run
from conveyor.loop.starting import Motions, motions
from conveyor.models import Conveyor
from conveyor.remarks import assumptions, warnings

if TYPE_CHECKING:
    import pandas as pd

    from conveyor.report.columns import Contents, Table
    from conveyor.report.files import FileKind
    from conveyor.studies import Studies
    from conveyor.studies.drawing import AnalysisPlots
    from conveyor.units import System


def analyse(conveyor: Conveyor) -> Analysis:
    """Calculate a conveyor.

    Parameters
    ----------
    conveyor : Conveyor
        From `conveyor.load` or built in Python.

    Returns
    -------
    Analysis
        Forces, tensions, power, per section and per roll, with assumptions and warnings.

    Raises
    ------
    InputError
        Something else than a Conveyor.
    NoSolutionError
        A roll's contact has no answer, or the tensions do not settle.
    RangeError
        A compound is not known at the belt's temperature.
    """
    if not isinstance(conveyor, Conveyor):
        raise InputError(
            f"analyse: takes a Conveyor, got {type(conveyor).__name__}; conveyor.load(path) reads one from a file"
        )
    done = run(conveyor)
    stretches, found = done.stretches, done.balance
    remarks = warnings(conveyor, stretches, found)
    return Analysis(conveyor, stretches, found, assumptions(conveyor), remarks, done.convergence)


@dataclass(frozen=True, eq=False, repr=False)
class Analysis:
    """Everything calculated for one conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        What was calculated.
    stretches : tuple of StretchResult
        Forces of every section of both strands, SI.
    balance : Balance
        Forces, tensions, power of the whole, SI.
    assumptions, warnings : tuple of str
        What every figure rests on, and where that is strained.
    convergence : Convergence or None
        How tensions and roll loads settled on vertical curves; None without curves.
    """

    conveyor: Conveyor
    stretches: tuple[StretchResult, ...]
    balance: Balance
    assumptions: tuple[str, ...]
    warnings: tuple[str, ...]
    convergence: Convergence | None = None

    def contents(self, studies: Studies | None = None, *, system: System | None = None) -> Contents:
        """Everything a report holds, in a system of units, and of `conveyor.studies` where they are given."""
        from conveyor.report.tables import of_analysis

        return of_analysis(self.in_units(chosen(self.conveyor.report.units, system)), studies)

    @cached_property
    def tables(self) -> dict[str, Table]:
        """Every table of the reports by its name (docs/workbook.md); `.frame(system)` is the data frame."""
        return self.contents().by_key

    @cached_property
    def summary(self) -> pd.Series:
        """Figures of the whole conveyor; units in the names."""
        return self.tables["results"].series(self.conveyor.name)

    @cached_property
    def sections(self) -> pd.DataFrame:
        """One row a section and strand; units in the names."""
        return self.tables["sections"].frame()

    @cached_property
    def resistances(self) -> pd.DataFrame:
        """Every force and its source; the rows add up to the effective tension."""
        return self.tables["resistances"].frame()

    @cached_property
    def rolls(self) -> pd.DataFrame:
        """One row a roll of every section's set; units in the names."""
        return self.tables["rolls"].frame()

    @cached_property
    def rubber(self) -> pd.DataFrame:
        """One row a strand: compound, excited band against its data, working strain; units in the names."""
        return self.tables["rubber"].frame()

    @cached_property
    def motions(self) -> Motions:
        """Start, coasting, braking, holding; limits of the bulk."""
        return motions(self.conveyor, self.stretches, self.balance)

    @cached_property
    def belt_duty(self) -> BeltDuty:
        """Safety of the belt, diameters of the pulleys, radii of vertical curves."""
        return belt_duty(self.conveyor, self.balance)

    def in_units(self, system: System | None) -> Analysis:
        """Return the same analysis with remarks and reports in another system of units; None leaves it as it is.

        Tables (`summary`, `sections` …) stay SI; `to_tables(system=)` and the reports convert them.

        Examples
        --------
        >>> import conveyor
        >>> result = conveyor.analyse(conveyor.load("examples/specs/overland.yaml"))
        >>> result.in_units("US").conveyor.report.units
        'US'
        """
        if system is None or system == self.conveyor.report.units:
            return self
        conveyor = self.conveyor.replace(report=self.conveyor.report.replace(units=system))
        return replace(self, conveyor=conveyor, warnings=warnings(conveyor, self.stretches, self.balance))

    @property
    def error_estimate(self) -> float:
        """Largest relative error estimate of any roll's indentation [-]."""
        return worst_error(self.stretches)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON, SI or the unit in the key."""
        from conveyor.report.tables import plain

        return plain(self)

    def to_excel(
        self, path: str | Path, studies: Studies | None = None, *, system: System | None = None
    ) -> Path:
        """Write the workbook, with the sheets of `conveyor.studies` where they are given.

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
            The path cannot be written, or the system is neither SI nor US.
        """
        from conveyor.report.excel import write

        return write(self.contents(studies, system=system), Path(path))

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
        from conveyor.report.files import write

        return write(self.contents(studies, system=system), Path(folder), kind)

    def to_html(
        self, path: str | Path, studies: Studies | None = None, *, system: System | None = None
    ) -> Path:
        """Write the HTML report, one static page, with the parts of `conveyor.studies` where they are given.

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
            The path cannot be written, or the system is neither SI nor US.
        """
        from conveyor.report.html import write

        return write(self.contents(studies, system=system), Path(path))

    @property
    def plots(self) -> AnalysisPlots:
        """Figures: resistances, tensions, profile, pressure, rubber, power over temperature and speed."""
        from conveyor.studies.drawing import AnalysisPlots

        return AnalysisPlots(self)

    def __repr__(self) -> str:
        found = self.balance
        return (
            f'Analysis("{self.conveyor.name}": motor power {found.power.motor / 1e3:.1f} kW, effective tension '
            f"{found.forces.total:.0f} N, f {found.friction_factor:.4f}, error {self.error_estimate:.0e})"
        )

    def _repr_html_(self) -> str:
        """For notebooks: key figures, failed checks, warnings."""
        from conveyor.report import representations

        return representations.of_analysis(self.contents())
