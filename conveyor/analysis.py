"""From a conveyor to its forces, tensions and power: the whole calculation in one call."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from conveyor.arguments import checked
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

    @cached_property
    def summary(self) -> pd.Series:
        """Figures of the whole conveyor; units in the names."""
        from conveyor.report import tables

        return tables.summary(self.conveyor, self.stretches, self.balance)

    @cached_property
    def sections(self) -> pd.DataFrame:
        """One row a section and strand; units in the names."""
        from conveyor.report import tables

        return tables.sections(self.stretches)

    @cached_property
    def resistances(self) -> pd.DataFrame:
        """Every force and its source; the rows add up to the effective tension."""
        from conveyor.report import tables

        return tables.resistances(self.stretches, self.balance)

    @cached_property
    def rolls(self) -> pd.DataFrame:
        """One row a roll of every section's set; units in the names."""
        from conveyor.report import tables

        return tables.rolls(self.stretches)

    @cached_property
    def rubber(self) -> pd.DataFrame:
        """One row a strand: compound, excited band against its data, working strain; units in the names."""
        from conveyor.report import tables

        return tables.rubber(self.conveyor, self.stretches)

    @cached_property
    def motions(self) -> Motions:
        """Start, coasting, braking, holding; limits of the bulk."""
        return motions(self.conveyor, self.stretches, self.balance)

    @cached_property
    def belt_duty(self) -> BeltDuty:
        """Safety of the belt, diameters of the pulleys, radii of vertical curves."""
        return belt_duty(self.conveyor, self.balance)

    @checked
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
        forces, power = self.balance.forces, self.balance.power
        even = not self.conveyor.duty
        return {
            "name": self.conveyor.name,
            "forces_N": {**asdict(forces), "total": forces.total},
            "power_kW": {"belt": power.belt / 1e3, "motor": power.motor / 1e3, "mains": power.mains / 1e3},
            "friction_factor": self.balance.friction_factor,
            "tensions_N": asdict(self.balance.tensions),
            "drives": _drives(self.balance),
            "take_up": {
                "kind": self.balance.settled.loop.data.take_up.kind,
                "setting_N": self.balance.settled.setting,
                "least_setting_N": self.balance.settled.needed,
                "governed_by": self.balance.settled.condition_name(self.balance.settled.governed_by),
            },
            "energy": {
                "kWh_per_tonne_km": power.energy_per_tonne_km,
                "kWh_per_year": power.energy_per_year if even else None,
                "cost_per_year": power.cost_per_year if even else None,
                "currency": power.currency,
            },
            "classical": {
                "friction_factor": self.balance.classical.friction_factor,
                "secondary_by": self.balance.classical.secondary_by,
                "total_N": self.balance.classical.total,
                "motor_kW": self.balance.classical.motor / 1e3,
            },
            "cema": None
            if self.balance.cema is None
            else {
                "friction_factor": self.balance.cema.friction_factor,
                "total_N": self.balance.cema.total,
                "motor_kW": self.balance.cema.motor / 1e3,
            },
            "rubber": [
                {
                    "strand": row["strand"],
                    "compound": row["compound"],
                    "temperature_degC": row["temperature [degC]"],
                    "excited_Hz": [row["excited from [Hz]"], row["excited to [Hz]"]],
                    "data_Hz": [row["data from [Hz]"], row["data to [Hz]"]],
                    "working_strain": row["working strain [-]"],
                    "storage_factor": row["E' factor of strain [-]"],
                    "loss_factor": row["E'' factor of strain [-]"],
                }
                for row in self.rubber.astype(object).where(self.rubber.notna(), None).to_dict("records")
            ],
            "sections": [
                {
                    "section": r.stretch.section,
                    "strand": r.stretch.strand,
                    "length_m": r.stretch.length,
                    "lift_m": r.stretch.rise,
                    "indentation_N": r.indentation,
                    "idler_rotation_N": r.rotation,
                    "flexure_N": r.flexure,
                    "tilt_N": r.tilt,
                    "lift_N": r.lift,
                    "total_N": r.total,
                }
                for r in self.stretches
            ],
            "error_estimate": self.error_estimate,
            "assumptions": list(self.assumptions),
            "warnings": list(self.warnings),
        }

    @checked
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

        return write(self, Path(path), studies, system=system)

    @checked
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

        return write(self, Path(folder), studies, system=system, kind=kind)

    @checked
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

        return write(self, Path(path), studies, system=system)

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
        from conveyor.report.representations import of_analysis

        return of_analysis(self)


def _drives(found: Balance) -> list[dict[str, Any]]:
    """Every drive in steady running, plain numbers."""
    motor = found.settled.loop.data.motor
    return [
        {
            "drive": side.name,
            "force_N": side.force,
            "motor_kW": motor(side.force) / 1e3,
            "arriving_N": side.arriving,
            "leaving_N": side.leaving,
        }
        for side in found.settled.steady.drives
    ]
