"""Load cases at several temperatures and speeds, and the governing case of each design figure.

All share one take-up: unless the spec gives its setting, it is the least that suits every state of the spec's own load
and of every case. The resistances of every case are computed as `analyse` does. Motors and starts are sized with the
friction at the upper end of a band, generators and brakes at its lower end.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from conveyor.arguments.argument_types import check_arguments
from conveyor.calculated_conveyor import CalculatedConveyor, Variant, common_take_up_duty
from conveyor.checks import Check, rubber_data_suffice, run_checks
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.energy import MOTOR_SERIES, NEMA_MOTORS, next_motor
from conveyor.loop.take_up_duty import TakeUpDuty
from conveyor.loop.ties import first_maximum, first_minimum
from conveyor.models import Conveyor, LoadCase, standard_cases
from conveyor.models.variants import case_settings
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.reuse import ReuseCache
from conveyor.units.sentences import Message, escape_braces, message

MOTOR_RESERVE: Final = 1.1
"""Rated power over the largest needed [-]; general knowledge (10 to 15 % is customary), not a source."""
AS_GIVEN: Final = "as given"
"""Name of the spec's own load."""
_CARRYING: Final = frozenset({AS_GIVEN, "full", "part load", "heavy bulk"})


@dataclass(frozen=True, eq=False)
class Load:
    """A load of a conveyor: as given, a load state, or a case at one temperature and speed.

    Attributes
    ----------
    name : str
        Its name.
    label : Message
        Its name, and its temperature unless it is as given.
    found : CalculatedConveyor
        Forces, tensions and power as `analyse` gives them, SI.
    """

    name: str
    label: Message
    found: CalculatedConveyor

    @property
    def temperature(self) -> float:
        """Temperature of the covers [K]."""
        return self.found.temperature

    @property
    def speed(self) -> float:
        """Belt speed [m/s]."""
        return self.found.line.speed

    @property
    def forces(self) -> tuple[float, float]:
        """Drive force at low and high friction [N]; lift and acceleration of bulk do not vary."""
        return self.found.drive_forces

    @cached_property
    def motors(self) -> tuple[float, float]:
        """Motor shaft power with the friction at both ends of the band [W]."""
        low, high = map(self.found.balance.layout.motor, self.forces)
        return low, high

    @cached_property
    def heaviest_roll(self) -> tuple[float, str]:
        """Highest force on a roll [N], and its location."""
        load, stretch = max(
            ((load, stretch) for stretch in self.found.line.stretches for load in stretch.loads),
            key=lambda pair: pair[0].force,
        )
        return load.force, f"{stretch.section}, {stretch.strand}, {load.name}"


@dataclass(frozen=True, eq=False)
class CaseResult(Load):
    """One case at one temperature and speed; its label has the speed where the case has speeds of its own.

    Attributes
    ----------
    case : LoadCase
        The load case.
    """

    case: LoadCase

    @cached_property
    def covered(self) -> bool:
        """True if the rubber's data cover it; otherwise it is not designed by."""
        return rubber_data_suffice(self.found)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Every criterion as `analyse` checks it; only the rubber's if its data do not cover the case."""
        made = [replace(check, case=self.label) for check in run_checks(self.found)]
        if self.case.speeds:  # led there by an inverter: the motor turns otherwise than at the spec's own speed
            made = [check for check in made if check.key != "drive_speed"]
        return tuple(made if self.covered else map(_without_verdict, made))

    @property
    def energy_per_tonne_km(self) -> float | None:
        """Energy from the mains [kWh/(t km)], if the whole route carries."""
        return self.found.balance.power.energy_per_tonne_km if self.case.loading in _CARRYING else None


def _case_label(case: LoadCase, temperature: float, speed: float) -> Message:
    at = [(temperature, "temperature"), *([(speed, "speed")] if case.speeds else [])]
    return message(", ".join([escape_braces(case.name), *("{}" for _ in at)]), *at)


def _without_verdict(check: Check) -> Check:
    if check.key == "rubber_coverage":
        return check
    return replace(check, verdict="not checked", why=message("the rubber's data do not cover the case"))


@dataclass(frozen=True)
class CaseRefusal:
    """A case without an answer, and the reason; SI."""

    case: str
    temperature: float
    speed: float
    reason: str


@dataclass(frozen=True, eq=False)
class GoverningLoad:
    """The governing load of a figure: key, name, value and kind of the figure, and the load."""

    key: str
    figure: str
    value: float
    kind: str
    result: Load


@dataclass(frozen=True)
class MotorChoice:
    """Motors of one drive pulley: shaft power to give or hold [W], number, rating [W], series, load."""

    drive: str
    needed: float
    count: int
    rated: float
    series: str
    case: Message

    @property
    def reserve(self) -> float:
        """Rated over needed power [-]."""
        return math.inf if self.needed == 0.0 else self.count * self.rated / abs(self.needed)


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedCases:
    """All load cases of a conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec that was varied.
    cases : tuple of LoadCase
        The requested cases.
    friction_band : tuple of float
        Friction over the computed one, low and high end [-]; lift and acceleration of bulk have none. That to design
        for is of the spec's own load where each case has its own.
    results, refused : tuple
        Results in the order case, speed, temperature, and cases without an answer.
    as_given : CalculatedConveyor or None
        The spec's own load with the take-up of the cases; None if it has no answer.
    """

    conveyor: Conveyor
    cases: tuple[LoadCase, ...]
    friction_band: tuple[float, float]
    results: tuple[CaseResult, ...]
    refused: tuple[CaseRefusal, ...]
    as_given: CalculatedConveyor | None

    def __repr__(self) -> str:
        name, answered = self.conveyor.name, len(self.results)
        return f'CaseStudy("{name}": {len(self.cases)} cases, {answered} answered, {len(self.refused)} not)'

    @cached_property
    def designing(self) -> tuple[CaseResult, ...]:
        """Cases to design by: those covered by the rubber's data."""
        return tuple(result for result in self.results if result.covered)

    @property
    def temperatures(self) -> tuple[float, ...]:
        """Belt temperature of every case with an answer [K]."""
        return tuple(result.temperature for result in self.results)

    @cached_property
    def take_up(self) -> TakeUpDuty:
        """Take-up duty of the spec's own load and the cases to design by; of all cases if there is neither.

        Raises
        ------
        NoSolutionError
            Nothing has an answer.
        """
        own = [] if self.as_given is None else [self.as_given]
        loads = [*own, *(result.found for result in self.designing)] or [result.found for result in self.results]
        if not loads:
            raise NoSolutionError("no load has an answer: see why each case has none")
        return common_take_up_duty(loads, self.temperatures)

    @cached_property
    def governing(self) -> tuple[GoverningLoad, ...]:
        """Governing case of every design figure, of those to design by."""
        return governing_loads(self.designing)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Every criterion in every case; cases without an answer give the reason."""
        return (*_unanswered_cases(self), *(check for result in self.results for check in result.checks))

    def motors(self, reserve: float = MOTOR_RESERVE) -> tuple[MotorChoice, ...]:
        """Motors of every drive pulley from the series, for the governing load.

        Parameters
        ----------
        reserve : float
            Rated power over needed power [-], at least 1.

        Raises
        ------
        InputError
            The reserve is below 1, or no case has an answer.
        """
        return recommended_motors(self.designing, reserve=reserve)


@check_arguments
def analyse_cases(
    conveyor: Conveyor,
    cases: Sequence[LoadCase] | None = None,
    *,
    friction_band: tuple[float, float] | None = None,
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
    kept: ReuseCache | None = None,
) -> CalculatedCases:
    """Calculate load cases, all contacts in one batch.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    cases : sequence of LoadCase, optional
        By default those of the spec, or the standard ones: full, empty, inclines only, declines only.
    friction_band : tuple of float, optional
        Least certain friction and that to design for, over the computed one [-]. By default drive.least_friction (0.6
        unless given, general knowledge: f 0.012 over 0.020) and drive.design_friction, without it the upper end of the
        band of the defaults of each case.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of the spec.
    progress : callable, optional
        Called with the items done and their total.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.

    Returns
    -------
    CalculatedCases
        One result per case, speed and temperature; governing cases; motors.

    Raises
    ------
    InputError
        Two cases of one name, or a band that is not 0 < low <= 1 <= high.

    Examples
    --------
    >>> import conveyor
    >>> from conveyor.models import standard_cases
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> conveyor.analyse_cases(line, standard_cases(["-20 degC", "30 degC"])).table  # doctest: +SKIP
    """
    chosen = tuple(cases) if cases is not None else (conveyor.cases or standard_cases())
    names = [case.name for case in chosen]
    twice = next((name for name in names if names.count(name) > 1), None)
    if not chosen or twice is not None:
        raise InputError(f'cases: "{twice}" is given twice' if chosen else "cases: give at least one")
    if friction_band is not None and not 0.0 < friction_band[0] <= 1.0 <= friction_band[1] < math.inf:
        raise InputError(f"friction_band = {friction_band}: 0 < low <= 1 <= high is needed")
    design = None if friction_band is None else friction_band[1]
    settings = [(case, setting) for case in chosen for setting in case_settings(conveyor, case)]
    made = [(case, s, s.conveyor) for case, s in settings if isinstance(s.conveyor, Conveyor)]
    refused = [
        CaseRefusal(case.name, s.temperature, s.speed, str(s.conveyor))
        for case, s in settings
        if not isinstance(s.conveyor, Conveyor)
    ]
    variants = [Variant(one, design_friction=design) for one in (conveyor, *(variant for _, _, variant in made))]
    as_given, *answers = calculate_many(
        variants,
        rtol,
        progress,
        one_take_up=lambda one: one.conveyor is conveyor or rubber_data_suffice(one),
        kept=kept,
    )
    results = []
    for (case, setting, _), result in zip(made, answers, strict=True):
        if isinstance(result, CalculatedConveyor):
            label = _case_label(case, result.temperature, result.line.speed)
            results.append(CaseResult(case.name, label, replace(result, friction_band=friction_band), case))
        else:
            refused.append(CaseRefusal(case.name, setting.temperature, setting.speed, str(result)))
    own = as_given if isinstance(as_given, CalculatedConveyor) else None
    band = friction_band or (conveyor.certain_friction, 1.0 if own is None else own.line.design_friction)
    return with_motors(CalculatedCases(conveyor, chosen, band, tuple(results), tuple(refused), own))


def with_motors(cases: CalculatedCases, further: Iterable[CalculatedConveyor] = ()) -> CalculatedCases:
    """Cases with the starting force of motors without a given power: that of the load that needs most."""
    own = () if cases.as_given is None else (cases.as_given,)
    force = motor_start_force([*own, *(result.found for result in cases.designing), *further])
    if force is None:
        return cases
    results = tuple(replace(r, found=replace(r.found, start_of_motors=force)) for r in cases.results)
    as_given = None if cases.as_given is None else replace(cases.as_given, start_of_motors=force)
    return replace(cases, results=results, as_given=as_given)


def motor_start_force(loads: Sequence[CalculatedConveyor]) -> float | None:
    """Starting force at the belt for the load that needs most [N]; None if the motors' power is given."""
    if not loads or all(drive.power is not None for drive in loads[0].line.drives):
        return None
    return max(load.motions.design_start.standstill for load in loads)


_FIGURES: Final[dict[str, tuple[str, str, bool, Callable[[Load], float]]]] = {
    "largest_motor_power_friction_high": ("maximum motor power", "power", True, lambda r: r.motors[1]),
    "least_motor_power_friction_low": ("minimum motor power", "power", False, lambda r: r.motors[0]),
    "largest_drive_force_friction_high": ("maximum drive force", "force", True, lambda r: r.forces[1]),
    "least_drive_force_friction_low": ("minimum drive force", "force", False, lambda r: r.forces[0]),
    "largest_belt_tension": (
        "maximum belt tension",
        "force",
        True,
        lambda r: r.found.balance.tensions.largest,
    ),
    "least_belt_tension": (
        "minimum belt tension, steady",
        "force",
        False,
        lambda r: r.found.balance.tensions.smallest,
    ),
    "largest_tension_asked_of_the_take_up": (
        "required take-up tension",
        "force",
        True,
        lambda r: r.found.balance.equilibrium.needed,
    ),
    "largest_roll_load": ("maximum roll load", "force", True, lambda r: r.heaviest_roll[0]),
    "largest_indentation": (
        "maximum indentation",
        "force",
        True,
        lambda r: r.found.balance.forces.indentation,
    ),
}


def governing_figures(load: Load) -> dict[str, float]:
    """Figures by which loads are compared, by name; the highest governs."""
    return {figure: value(load) if most else -value(load) for figure, _, most, value in _FIGURES.values()}


def governing_loads(loads: Sequence[Load]) -> tuple[GoverningLoad, ...]:
    """Governing load of each figure, the first of equals; empty without loads."""
    if not loads:
        return ()
    rows = []
    for key, (figure, kind, most, value) in _FIGURES.items():
        chosen = (first_maximum if most else first_minimum)(loads, value)
        rows.append(GoverningLoad(key, figure, value(chosen), kind, chosen))
    return tuple(rows)


def _unanswered_cases(study: CalculatedCases) -> Iterator[Check]:
    cases = {case.name: case for case in study.cases}
    count = f"{len(study.refused)} of {len(study.results) + len(study.refused)}"
    for refusal in study.refused:
        yield Check(
            "case_answer", message("answer to every case"), None, None, "number",
            message(f"{count} cases could not be calculated"), message("every case calculated"), "FAIL",
            message(escape_braces(refusal.reason)),
            case=_case_label(cases[refusal.case], refusal.temperature, refusal.speed),
        )  # fmt: skip


def recommended_motors(loads: Sequence[Load], *, reserve: float) -> tuple[MotorChoice, ...]:
    """Motors of every drive pulley: the fewest equal ones of the series that give or hold its share.

    The series is NEMA for a spec with US units, else IEC 60072-1.

    Parameters
    ----------
    loads : sequence of Load
        The one with the highest power, driving with high or braking with low friction, governs.
    reserve : float
        Least rated power over needed power [-], at least 1.

    Raises
    ------
    InputError
        The reserve is below 1, or there is no load.
    """
    if not loads or not 1.0 <= reserve < math.inf:
        raise InputError(
            f"reserve = {reserve}: at least 1 is needed" if loads else "no case has an answer to design by"
        )
    governs = first_maximum(loads, lambda load: abs(load.found.governing_motor_power))
    decisive, power = governs.found, governs.found.governing_motor_power
    name, series = ("NEMA", NEMA_MOTORS) if decisive.line.us_sizes else ("IEC 60072-1", MOTOR_SERIES)
    choices = []
    for drive in decisive.line.drives:
        if drive.share == 0.0:
            continue
        needed = drive.share * power
        count = max(1, math.ceil(round(abs(needed) * reserve / series[-1], 9)))
        rated = next_motor(needed / count, reserve=reserve, series=series)
        choices.append(MotorChoice(drive.name, needed, count, rated, name, governs.label))
    return tuple(choices)
