"""What the design of a conveyor is judged by: every load, every check, the range of power, the take-up."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Self

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import Check, governing_by_subject, run_checks
from conveyor.default_bands import PowerRange, power_range
from conveyor.loop.take_up_duty import TakeUpDuty
from conveyor.loop.ties import first_maximum
from conveyor.pipeline import calculate
from conveyor.remarks.assumptions import analysis_assumptions
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.studies import CalculatedStudies
from conveyor.studies.load_cases import Load, MotorChoice
from conveyor.studies.loads import combine_checks, design_loads, take_up_demand
from conveyor.units import System
from conveyor.units.sentences import Message

if TYPE_CHECKING:
    from conveyor.dynamics.simulation import CalculatedDynamics


@dataclass(frozen=True, eq=False)
class Assessment:
    """A calculated conveyor with its studies and scenarios, and what follows from all of them, each calculated once.

    Attributes
    ----------
    own : CalculatedConveyor
        The spec's own load, at the take-up setting of every load if there are studies.
    studies : CalculatedStudies
        Load states, load cases, duty and ranges; by default none.
    dynamics : CalculatedDynamics or None
        Scenarios.
    """

    own: CalculatedConveyor
    studies: CalculatedStudies = field(default_factory=CalculatedStudies)
    dynamics: CalculatedDynamics | None = None

    @property
    def system(self) -> System:
        """Units of the report."""
        return self.own.conveyor.report.units

    def in_units(self, system: System) -> Self:
        """Return the assessment with remarks and reports in a system of units."""
        if system == self.system:
            return self
        conveyor = self.own.conveyor
        shown = conveyor.replace(report=conveyor.report.replace(units=system))
        return replace(self, own=replace(self.own, conveyor=shown))

    @cached_property
    def loads(self) -> tuple[Load, ...]:
        """Loads to design by, the first as given."""
        return design_loads(self.own, self.studies.states, self.studies.cases)

    @cached_property
    def own_checks(self) -> tuple[Check, ...]:
        """Every criterion of the conveyor as given."""
        return run_checks(self.own)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Every criterion as given, in every load case and load state, and in every scenario."""
        held = self.studies
        every = combine_checks(self.own_checks, self.take_up[0], held.states, held.cases)
        if self.dynamics is None:
            return every
        from conveyor.dynamics.criteria import dynamics_checks

        return (*every, *dynamics_checks(self.dynamics))

    @cached_property
    def governing(self) -> tuple[Check, ...]:
        """Governing check of each criterion and subject."""
        return governing_by_subject(self.checks)

    @cached_property
    def take_up(self) -> tuple[TakeUpDuty, Message]:
        """Take-up duty of all loads to design by, and the governing load and condition."""
        return take_up_demand(self.loads, self.studies.cases)

    @cached_property
    def by_contact(self) -> CalculatedConveyor | None:
        """The spec's own load by the rolling contact, beside a classical method; None where that is the method."""
        conveyor = self.own.conveyor
        if conveyor.calculation.method == "viscoelastic":
            return None
        given = conveyor.calculation.replace(method="viscoelastic")
        return calculate(conveyor.replace(calculation=given))

    @cached_property
    def power_range(self) -> PowerRange:
        """Range of the motor power from the defaults in use."""
        return power_range(self.own)

    @cached_property
    def motors(self) -> tuple[MotorChoice, ...]:
        """Standard motors of every drive pulley; none without a load case to design by."""
        return self.studies.motors

    @property
    def governing_motor_power(self) -> float:
        """Motor power of the load with the highest, driving or braking [W]."""
        return first_maximum((load.found.governing_motor_power for load in self.loads), abs)

    @cached_property
    def warnings(self) -> tuple[Message, ...]:
        """Strained assumptions and criteria not met."""
        return analysis_warnings(self.own, self.governing)

    @cached_property
    def assumptions(self) -> tuple[str, ...]:
        """Assumptions behind every figure."""
        further = () if self.dynamics is None else self.dynamics.assumptions
        return (*analysis_assumptions(self.own.conveyor), *further)
