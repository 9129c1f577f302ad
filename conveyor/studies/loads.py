"""Every load of a conveyor at the one take-up setting that suits them all, and all their checks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TypeAlias

from conveyor.calculated_conveyor import CalculatedConveyor, common_take_up_duty
from conveyor.checks import BELT_STRENGTH_CRITERIA, Check, governing_by_subject, highest_use, run_checks
from conveyor.checks.tension_checks import take_up_travel_checks
from conveyor.loop.take_up_duty import TakeUpDuty
from conveyor.models import Conveyor
from conveyor.reuse import ReuseCache
from conveyor.studies.load_cases import AS_GIVEN, CalculatedCases, Load, analyse_cases
from conveyor.studies.one_take_up import at_one_take_up
from conveyor.studies.states import CalculatedStates, load_states
from conveyor.units.sentences import Message, escape_braces, message

StudyProgress: TypeAlias = Callable[[str, int, int], None]
"""Called with a name, the items done and their total."""


@dataclass(frozen=True, eq=False)
class EveryLoad:
    """The load of a spec, its load states and its load cases.

    Attributes
    ----------
    states : CalculatedStates
        Load states, with the spec's own load.
    cases : CalculatedCases or None
        Load cases.
    """

    states: CalculatedStates
    cases: CalculatedCases | None

    @property
    def own(self) -> CalculatedConveyor:
        """The spec's own load."""
        return self.states.own

    @cached_property
    def governing(self) -> tuple[Check, ...]:
        """Governing check of each criterion and subject, as `conveyor power` lists them; without scenarios."""
        duty, _ = take_up_demand(self.loads, self.cases)
        return governing_by_subject(combine_checks(run_checks(self.own), duty, self.states, self.cases))

    @property
    def failed(self) -> int:
        """Number of criteria not met in at least one load."""
        return sum(check.failed for check in self.governing)

    @cached_property
    def loads(self) -> tuple[Load, ...]:
        """Loads to design by, with their names."""
        return design_loads(self.own, self.states, self.cases)

    @property
    def designing(self) -> tuple[CalculatedConveyor, ...]:
        """Loads to design by."""
        return tuple(load.found for load in self.loads)

    @property
    def motor_power(self) -> float:
        """Highest power that motors give or hold, at the less favourable end of the friction band [W]."""
        return max(abs(load.governing_motor_power) for load in self.designing)

    @property
    def motor_use(self) -> float | None:
        """Utilisation of the most loaded drive [-]; None without an installed power."""
        return highest_use(self.governing, {"motor_power"})[0]

    @property
    def largest_tension(self) -> float:
        """Largest belt tension of all states of motion [N]."""
        return max(load.balance.tensions.largest for load in self.designing)

    @property
    def belt_safety(self) -> float | None:
        """Lowest belt safety in steady running, as checked [-]; None without the belt's strength."""
        safeties = [load.belt_duty.safety_steady for load in self.designing]
        return min((one for one in safeties if one is not None), default=None)

    @property
    def belt_use(self) -> float | None:
        """Belt utilisation by strength or rating [-]; None if neither is given."""
        return highest_use(self.governing, BELT_STRENGTH_CRITERIA)[0]

    @property
    def take_up(self) -> float:
        """Setting of the take-up [N]."""
        return self.states.setting


def every_load(
    conveyor: Conveyor,
    given: CalculatedConveyor | None = None,
    *,
    progress: StudyProgress | None = None,
    kept: ReuseCache | None = None,
) -> EveryLoad:
    """Calculate the load states and load cases of a spec.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    given : CalculatedConveyor, optional
        The spec's own load, if already calculated.
    progress : callable, optional
        Called with "load cases" or "load states", the items done and their total.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        The spec's own load has no answer, or no setting of the take-up suits all; cases without an answer are listed.
    """

    def told(name: str) -> Callable[[int, int], None] | None:
        return None if progress is None else partial(progress, name)

    kept = ReuseCache() if kept is None else kept
    cases = analyse_cases(conveyor, progress=told("load cases"), kept=kept) if conveyor.cases else None
    own = given if cases is None else cases.as_given
    states = load_states(conveyor, own, cases, progress=told("load states"), kept=kept)
    return EveryLoad(*at_one_take_up(states, cases))


def design_loads(
    own: CalculatedConveyor, states: CalculatedStates | None, cases: CalculatedCases | None
) -> tuple[Load, ...]:
    """Loads to design by: as given, load cases covered by the rubber's data, load states."""
    return (
        Load(AS_GIVEN, message(AS_GIVEN), own),
        *(() if cases is None else cases.designing),
        *(() if states is None else states.loads),
    )


def take_up_demand(loads: Sequence[Load], cases: CalculatedCases | None) -> tuple[TakeUpDuty, Message]:
    """Take-up duty of loads to design by at one setting, and the governing load and condition.

    The travel covers the temperatures of all cases.
    """
    duty = common_take_up_duty([load.found for load in loads], () if cases is None else cases.temperatures)
    condition, label = escape_braces(duty.governed_by), loads[duty.governing].label
    return duty, message(condition) if len(loads) == 1 else message(f"{label.words}: {condition}", *label.figures)


def combine_checks(
    own: Iterable[Check], take_up: TakeUpDuty, states: CalculatedStates | None, cases: CalculatedCases | None
) -> tuple[Check, ...]:
    """Checks of the conveyor as given and of its take-up, then those of its load cases and load states."""
    of_cases = () if cases is None else cases.checks
    of_states = () if states is None else states.checks
    return (*own, *take_up_travel_checks(take_up), *of_cases, *of_states)
