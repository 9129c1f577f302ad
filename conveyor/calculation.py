"""From a conveyor to its forces, tensions and power: the whole calculation, as plain data."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

from conveyor.errors import InputError
from conveyor.line.walk import StretchResult, worst_error
from conveyor.loop.balance import Balance
from conveyor.loop.belt_duty import BeltDuty, belt_duty
from conveyor.loop.curved import Convergence, run
from conveyor.loop.starting import Motions, motions
from conveyor.models import Conveyor
from conveyor.remarks import assumptions, warnings
from conveyor.units import System


@dataclass(frozen=True, eq=False, repr=False)
class Calculation:
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
    def motions(self) -> Motions:
        """Start, coasting, braking, holding; limits of the bulk."""
        return motions(self.conveyor, self.stretches, self.balance)

    @cached_property
    def belt_duty(self) -> BeltDuty:
        """Safety of the belt, diameters of the pulleys, radii of vertical curves."""
        return belt_duty(self.conveyor, self.balance)

    def in_units(self, system: System | None) -> Self:
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


def calculate(conveyor: Conveyor) -> Calculation:
    """Calculate a conveyor.

    Parameters
    ----------
    conveyor : Conveyor
        From `conveyor.load` or built in Python.

    Returns
    -------
    Calculation
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
    return Calculation(conveyor, stretches, found, assumptions(conveyor), remarks, done.convergence)
