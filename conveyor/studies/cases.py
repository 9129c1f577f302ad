"""Load cases at several temperatures and speeds, and which of them governs each figure of the design.

The resistances of every case are computed as `analyse` does. What they are used for decides on which side they are
safe: motors and starts are sized with the friction at the upper end of a band, generators and brakes at its lower end.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from conveyor.arguments import checked
from conveyor.errors import ConveyorError, InputError
from conveyor.laws.energy import MOTOR_SERIES, next_motor
from conveyor.laws.power import motor_power
from conveyor.line.walk import StretchResult, worst_error
from conveyor.loop.curved import Run
from conveyor.loop.data import loop_data
from conveyor.loop.settled import Settled
from conveyor.models import Conveyor, LoadCase, standard_cases
from conveyor.studies.scenes import Progress, Scene, runs
from conveyor.studies.variants import with_case, with_temperature
from conveyor.units import display, si

if TYPE_CHECKING:
    import pandas as pd

    from conveyor.loop.balance import Balance

MOTOR_RESERVE: Final = 1.1
"""Rated power over the largest needed one [-]; general knowledge (10 to 15 % is customary), not a source."""


@dataclass(frozen=True, eq=False)
class CaseResult:
    """One case at one temperature and speed; SI.

    Attributes
    ----------
    case, loading : str
        Name, and what is loaded.
    temperature, speed : float
        Of the belt [K], [m/s].
    flow : float
        Mass flow where the belt is fully fed [kg/s].
    indentation, main, effective : float
        Of both strands [N]; the drive force F_U with the friction as computed [N].
    effective_low, effective_high : float
        Drive force with the friction at the ends of the band [N].
    friction_factor : float
        The f that DIN 22101's main resistance would need [-].
    belt, motor, motor_low, motor_high : float
        Power at the belt, at the motor's shaft, and that at the ends of the band of friction [W].
    tight, slack, largest, smallest : float
        Tensions at the drive, and round the loop, start included [N].
    take_up : float
        Least tension that the take-up should hold [N].
    governed_by : str
        What asks for it.
    largest_roll : float
        Highest force on a roll [N].
    largest_roll_at : str
        Where that roll is.
    energy_per_tonne_km : float or None
        Energy from the mains [kWh/(t km)], where the whole route carries.
    error : float
        Largest relative error estimate of the contacts [-].
    balance : Balance
        Forces, tensions and power as `analyse` gives them.
    """

    case: str
    loading: str
    temperature: float
    speed: float
    flow: float
    indentation: float
    main: float
    effective: float
    effective_low: float
    effective_high: float
    friction_factor: float
    belt: float
    motor: float
    motor_low: float
    motor_high: float
    tight: float
    slack: float
    largest: float
    smallest: float
    take_up: float
    governed_by: str
    largest_roll: float
    largest_roll_at: str
    energy_per_tonne_km: float | None
    error: float
    balance: Balance

    @property
    def label(self) -> str:
        """Case, temperature and speed for people."""
        return f"{self.case}, {display(self.temperature, 'temperature')}, {display(self.speed, 'speed')}"


@dataclass(frozen=True)
class CaseRefusal:
    """A case without an answer, and why; SI."""

    case: str
    temperature: float
    speed: float
    reason: str


@dataclass(frozen=True, eq=False)
class Governing:
    """The case that decides a figure: the figure's name, its value and kind of quantity, the case."""

    figure: str
    value: float
    kind: str
    result: CaseResult


@dataclass(frozen=True)
class MotorChoice:
    """Motors of one drive pulley: the shaft power they must give or hold [W], how many of which rating [W]."""

    drive: str
    needed: float
    reserve: float
    count: int
    rated: float
    case: str


@dataclass(frozen=True, eq=False, repr=False)
class CaseStudy:
    """All load cases of a conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec that was varied.
    cases : tuple of LoadCase
        What was asked for.
    friction_band : tuple of float
        Friction over the computed one, low and high end [-]; lift and acceleration of bulk have none.
    results, refused : tuple
        What was answered, in the order case, speed, temperature, and what was not.
    """

    conveyor: Conveyor
    cases: tuple[LoadCase, ...]
    friction_band: tuple[float, float]
    results: tuple[CaseResult, ...]
    refused: tuple[CaseRefusal, ...]

    def __repr__(self) -> str:
        name, answered = self.conveyor.name, len(self.results)
        return f'CaseStudy("{name}": {len(self.cases)} cases, {answered} answered, {len(self.refused)} not)'

    @cached_property
    def governing(self) -> tuple[Governing, ...]:
        """For every figure of the design the case that decides it."""
        return governing(self.results)

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a case, temperature and speed; units in the names."""
        from conveyor.report import case_tables

        return case_tables.cases(self)

    def _repr_html_(self) -> str:
        from conveyor.report.representations import of_cases

        return of_cases(self)

    def motors(self, reserve: float = MOTOR_RESERVE) -> tuple[MotorChoice, ...]:
        """Motors of every drive pulley from the series, for the governing case.

        Parameters
        ----------
        reserve : float
            Rated power over needed power [-], at least 1.

        Raises
        ------
        InputError
            The reserve is below 1, or no case has an answer.
        """
        return recommended_motors(self.results, reserve=reserve)


@checked
def analyse_cases(
    conveyor: Conveyor,
    cases: Sequence[LoadCase] | None = None,
    *,
    friction_band: tuple[float, float] | None = None,
    rtol: float | None = None,
    progress: Progress | None = None,
) -> CaseStudy:
    """Calculate load cases, all contacts side by side.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    cases : sequence of LoadCase, optional
        Those of the spec without it; without any there the standard ones: full, empty, inclines only, declines only.
    friction_band : tuple of float, optional
        Friction over the computed one where it is certain, and where it must be reckoned with [-]. Without it
        drive.least_friction (0.6 by default, general knowledge: f 0.012 over 0.020) and 1: the computed resistances.
    rtol : float, optional
        Relative tolerance of the contacts [-]; that of the spec without it.
    progress : callable, optional
        Called with what is done and the whole.

    Returns
    -------
    CaseStudy
        One result a case, speed and temperature; governing cases; motors.

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
    band = (si(conveyor.drive.least_friction), 1.0) if friction_band is None else friction_band
    if not 0.0 < band[0] <= 1.0 <= band[1] < math.inf:
        raise InputError(f"friction_band = {band}: 0 < low <= 1 <= high is needed")
    made, refused = _variants(conveyor, chosen)
    found = runs([Scene(variant) for _, variant in made], rtol, progress)
    results = []
    for (case, variant), done in zip(made, found, strict=True):
        if isinstance(done, Run):
            results.append(_result(case, variant, done, band))
        else:
            at = si(variant.ambient.belt), si(variant.belt.speed)
            refused.append(CaseRefusal(case.name, *at, str(done)))
    return CaseStudy(conveyor, chosen, band, tuple(results), tuple(refused))


def _variants(
    conveyor: Conveyor, cases: Iterable[LoadCase]
) -> tuple[list[tuple[LoadCase, Conveyor]], list[CaseRefusal]]:
    """The conveyor of every case, speed and temperature that its spec allows."""
    made: list[tuple[LoadCase, Conveyor]] = []
    refused = []
    for case in cases:
        speeds = case.speeds or (conveyor.belt.speed,)
        temperatures = case.temperatures or (conveyor.ambient.belt,)
        for speed in speeds:
            try:
                loaded = with_case(conveyor, case, speed=speed)
            except ConveyorError as error:
                refused += [CaseRefusal(case.name, si(t), si(speed), str(error)) for t in temperatures]
                continue
            for temperature in temperatures:
                try:
                    made.append((case, with_temperature(loaded, temperature)))
                except ConveyorError as error:
                    refused.append(CaseRefusal(case.name, si(temperature), si(speed), str(error)))
    return made, refused


def shaft_power(conveyor: Conveyor, force: float) -> float:
    """Power at the motors' shafts for a drive force [N]; negative when the belt drives [W]."""
    return loop_data(conveyor).motor(force)


def mains_power(conveyor: Conveyor, force: float) -> float:
    """Power from the mains for a drive force [N]; negative when it is fed back [W]."""
    return motor_power(shaft_power(conveyor, force), efficiency=conveyor.drive.mains_efficiency)


def _result(case: LoadCase, conveyor: Conveyor, done: Run, band: tuple[float, float]) -> CaseResult:
    found = done.balance
    forces, tensions, settled = found.forces, found.tensions, found.settled
    low, high = (_force(settled, friction) for friction in band)
    roll, where = _heaviest_roll(done.stretches)
    carries = case.loading in {"as given", "full", "part load"}
    return CaseResult(
        case=case.name,
        loading=case.loading,
        temperature=si(conveyor.ambient.belt),
        speed=si(conveyor.belt.speed),
        flow=si(conveyor.material.flow),
        indentation=forces.indentation,
        main=forces.main,
        effective=forces.total,
        effective_low=low,
        effective_high=high,
        friction_factor=found.friction_factor,
        belt=found.power.belt,
        motor=shaft_power(conveyor, forces.total),
        motor_low=shaft_power(conveyor, low),
        motor_high=shaft_power(conveyor, high),
        tight=tensions.tight,
        slack=tensions.slack,
        largest=tensions.largest,
        smallest=tensions.smallest,
        take_up=settled.needed,
        governed_by=settled.condition_name(settled.governed_by),
        largest_roll=roll,
        largest_roll_at=where,
        energy_per_tonne_km=found.power.energy_per_tonne_km if carries else None,
        error=worst_error(done.stretches),
        balance=found,
    )


def _force(settled: Settled, friction: float) -> float:
    """Drive force in steady running with a friction over the computed one [N]; lift and acceleration have none."""
    loop = settled.loop
    before, behind = loop.singles(settled.bends, friction)
    lift = loop.lifts.whole
    return math.fsum((lift, friction * (loop.totals.whole - lift), *before, *behind))


def _heaviest_roll(results: Sequence[StretchResult]) -> tuple[float, str]:
    """Highest force on a roll [N], and where."""
    force, roll, result = max(
        ((roll.load.force, roll, result) for result in results for roll in result.rolls),
        key=lambda row: row[0],
    )
    return force, f"{result.stretch.section}, {result.stretch.strand}, {roll.load.name}"


_FIGURES: Final[Mapping[str, tuple[str, str, bool]]] = {
    "largest motor power, friction high": ("motor_high", "power", True),
    "least motor power, friction low": ("motor_low", "power", False),
    "largest drive force, friction high": ("effective_high", "force", True),
    "least drive force, friction low": ("effective_low", "force", False),
    "largest belt tension": ("largest", "force", True),
    "least belt tension": ("smallest", "force", False),
    "largest tension asked of the take-up": ("take_up", "force", True),
    "largest roll load": ("largest_roll", "force", True),
    "largest indentation": ("indentation", "force", True),
}


def governing(results: Sequence[CaseResult]) -> tuple[Governing, ...]:
    """The case that decides each figure, the first of equals; nothing for no results."""
    if not results:
        return ()
    found = []
    for figure, (name, kind, largest) in _FIGURES.items():

        def key(result: CaseResult, name: str = name) -> float:
            return float(getattr(result, name))

        chosen = max(results, key=key) if largest else min(results, key=key)
        found.append(Governing(figure, key(chosen), kind, chosen))
    return tuple(found)


def recommended_motors(results: Sequence[CaseResult], *, reserve: float) -> tuple[MotorChoice, ...]:
    """Motors of every drive pulley: the least number of equal ones of the series that give or hold its share.

    Parameters
    ----------
    results : sequence of CaseResult
        Cases; the one that asks for most, driving with the friction high or braking with it low, decides.
    reserve : float
        Rated power over needed power [-], at least 1.

    Raises
    ------
    InputError
        The reserve is below 1, or there is no result.
    """
    if not results or not 1.0 <= reserve < math.inf:
        raise InputError(
            f"reserve = {reserve}: at least 1 is needed" if results else "no case has an answer to size for"
        )
    ends = [(power, result) for result in results for power in (result.motor_high, result.motor_low)]
    power, decisive = max(ends, key=lambda end: abs(end[0]))
    choices = []
    for drive in decisive.balance.settled.loop.data.drives:
        if drive.share == 0.0:
            continue
        needed = drive.share * power
        count = max(1, math.ceil(round(abs(needed) * reserve / MOTOR_SERIES[-1], 9)))
        rated = next_motor(needed / count, reserve=reserve)
        choices.append(MotorChoice(drive.name, needed, reserve, count, rated, decisive.label))
    return tuple(choices)
