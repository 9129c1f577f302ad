"""Studies of a spec beyond one analysis: load states, load cases, the year's duty, input ranges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property, partial

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.models import Conveyor
from conveyor.reuse import ReuseCache
from conveyor.studies.duty import CalculatedYear, analyse_duty
from conveyor.studies.flooding import FloodedBelt, flooded_belt
from conveyor.studies.input_ranges import CalculatedRanges, analyse_ranges
from conveyor.studies.load_cases import (
    MOTOR_RESERVE,
    CalculatedCases,
    GoverningLoad,
    Load,
    MotorChoice,
    governing_loads,
    recommended_motors,
)
from conveyor.studies.loads import StudyProgress, design_loads, every_load
from conveyor.studies.states import CalculatedStates


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedStudies:
    """Studies of one conveyor; None for those that the spec does not request.

    Attributes
    ----------
    states : CalculatedStates
        Load states, for every spec.
    cases : CalculatedCases or None
        From `cases`.
    duty : CalculatedYear or None
        From `operation.duty`.
    uncertainty : CalculatedRanges or None
        From `uncertainty`.
    flooded : FloodedBelt or None
        Bulk from edge to edge, for every spec that carries some.
    """

    states: CalculatedStates | None = None
    cases: CalculatedCases | None = None
    duty: CalculatedYear | None = None
    uncertainty: CalculatedRanges | None = None
    flooded: FloodedBelt | None = None

    def __repr__(self) -> str:
        held = [field.name for field in fields(self) if getattr(self, field.name) is not None]
        return f"Studies({', '.join(held) or 'none requested'})"

    @cached_property
    def governing(self) -> tuple[GoverningLoad, ...]:
        """Governing load of every design figure: as given, a load case or a load state."""
        return governing_loads(self._loads)

    @property
    def motors(self) -> tuple[MotorChoice, ...]:
        """Motors of every drive pulley for the governing load; none without a case to design by."""
        return recommended_motors(self._loads, reserve=MOTOR_RESERVE) if self._loads else ()

    @cached_property
    def _loads(self) -> tuple[Load, ...]:
        """Loads to design by; none without such a case."""
        if self.cases is None or not self.cases.designing:
            return ()
        of, states = self.cases, self.states
        return of.designing if states is None else design_loads(states.own, states, of)


def calculate_studies(
    conveyor: Conveyor, given: CalculatedConveyor | None = None, *, progress: StudyProgress | None = None
) -> CalculatedStudies:
    """Calculate the load states and the studies that the spec requests.

    Parameters
    ----------
    conveyor : Conveyor
        With `cases`, `operation.duty` or `uncertainty`, or none of them.
    given : CalculatedConveyor, optional
        The spec's own load, if already calculated.
    progress : callable, optional
        Called with the study's name, the items done and their total.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        The spec's own load, a variant of the duty or of the ranges has no answer; cases without one are listed in the
        study.
    """

    def told(name: str) -> Callable[[int, int], None] | None:
        return None if progress is None else partial(progress, name)

    kept = ReuseCache()
    loads = every_load(conveyor, given, progress=progress, kept=kept)
    return CalculatedStudies(
        states=loads.states,
        cases=loads.cases,
        duty=analyse_duty(conveyor, take_up=loads.states.take_up, progress=told("duty of a year"))
        if conveyor.duty
        else None,
        uncertainty=None
        if conveyor.uncertainty is None
        else analyse_ranges(conveyor, take_up=loads.states.take_up, progress=told("ranges of the inputs")),
        flooded=flooded_belt(loads.own, kept),
    )
