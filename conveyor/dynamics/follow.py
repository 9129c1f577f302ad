"""Scenarios of a conveyor followed through time, side by side, until their peaks hold."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, NamedTuple, Self, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.loop import SPEEDS, Cells, CutLoop
from conveyor.dynamics.machines import Ride, Size, machines, prepared
from conveyor.dynamics.wave import Record, run
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.waves import (
    BELT_RETARDATION,
    DRIVE_DRAG,
    MOTOR_SLIP,
    PULLEY_INERTIA,
    SLACK_SAG,
    TORQUE_LIMIT,
)
from conveyor.line.line import Line
from conveyor.line.scenes import ScenarioUnit
from conveyor.models import Conveyor, LoadCase, Scenario
from conveyor.models.variants import slowed, with_case, with_temperature
from conveyor.pipeline import CalculatedConveyor, Progress, Variant, calculate_many
from conveyor.studies.loads import EveryLoad, every_load
from conveyor.studies.states import CalculatedStates
from conveyor.studies.workers import workers_of
from conveyor.units import from_si
from conveyor.units.sentences import Said, percent, quoted, said, telling

Array = NDArray[np.float64]

ERROR: Final = 0.01
"""Error of the peaks asked for without a word [-]."""
_CELLS = 25  # of the longest belt at first
_REFINED = 6  # times at most
_RETRIED = 2  # times for a scenario without an answer: cells may be too long for it
_SIZES = 4  # of cells for an error
_SAFETY = 1.25  # of three and more: P. J. Roache, grid convergence index, J. Fluids Eng. 116 (1994) 405
_SLOWEST, _FASTEST = math.sqrt(2.0), 2.0  # change over the next one: at a jump of speed, and at first order
_CLOSER = 0.75  # error over the one before up to which halving helps: a half at first order, 1/√2 at a jump of speed
_REST = 1e-3  # of the steady speed, below which a belt away from the drives rests
_COURANT = 0.95  # of the longest stable step: at that itself the swing from cell to cell is never damped


@dataclass(frozen=True, eq=False)
class Followed:
    """A scenario and what happened.

    Attributes
    ----------
    ride : Ride
        The scenario on its belt.
    cells : Cells
        How the belt was cut.
    record : Record
        Of it alone: without the axis of scenarios.
    error : float or None
        Estimate of the error of the highest and lowest tension over the highest [-]; None where the step was given.
    """

    ride: Ride
    cells: Cells
    record: Record
    error: float | None

    @property
    def name(self) -> str:
        """Of the scenario."""
        return self.ride.scene.name

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.ride.loop.line

    @cached_property
    def times(self) -> Array:
        """Every step [s]."""
        return np.asarray(self.record.step * np.arange(len(self.record.take_up["tension"])), dtype=float)

    @cached_property
    def middles(self) -> Array:
        """Distance of every cell from the take-up [m]."""
        return np.asarray(0.5 * (self.cells.at[:-1] + self.cells.at[1:]))

    @property
    def highest(self) -> float:
        """Tension [N]."""
        return float(self.record.highest.max())

    @property
    def lowest(self) -> float:
        """Tension [N]."""
        return float(self.record.lowest.min())

    def place(self, i: int) -> str:
        """Where a cell is, in words: section and strand."""
        return self._words(float(self.middles[i]))

    def _words(self, distance: float) -> str:
        """Section and strand at a distance from the take-up."""
        order = self.ride.loop.order
        at = int(np.searchsorted(self.ride.loop.way, distance, side="right")) - 1
        stretch = self.line.loop.stretches[order[min(at, order.size - 1)]]
        return f"{stretch.section}, {stretch.strand}"

    @cached_property
    def top_speed(self) -> tuple[float, str, float]:
        """Highest speed anywhere on the belt, either way, its begin too [m/s]; where in words, and when [s]."""
        record = self.record
        size = np.maximum(record.highest_speed, -record.lowest_speed)
        i = int(size.argmax())
        when = record.highest_speed_at if record.highest_speed[i] >= size[i] else record.lowest_speed_at
        return float(size[i]), self._words(float(self.cells.at[i])), float(when[i])

    @cached_property
    def round_loop(self) -> tuple[NDArray[np.int_], Array]:
        """Cells as the belt meets them from the head, return strand first, and their distance from it [m]."""
        loop, ways = self.ride.loop, self.line.loop.way
        distance = (self.middles + ways[loop.order[0]]) % ways[-1]
        order = np.argsort(distance)
        return order, distance[order]

    def stretches(self) -> Iterator[tuple[int, slice]]:
        """Every stretch of `line.loop` and its cells; at least one."""
        for i, k in enumerate(self.ride.loop.order.tolist()):
            low, high = np.searchsorted(self.middles, self.ride.loop.way[i : i + 2])
            low = min(int(low), self.middles.size - 1)
            yield k, slice(low, max(int(high), low + 1))

    def beside(self, pulley: int) -> NDArray[np.int_]:
        """Cells on both sides of a pulley of the line; beyond the take-up where it stands beside that."""
        at = self.cells.at
        i = int(np.argmin(np.abs(at - self.ride.loop.pulleys[pulley])))
        return np.array([i - 1, i]) % (at.size - 1)

    @cached_property
    def sag(self) -> Array:
        """Largest sag of every cell over the span of its idlers [-]."""
        return np.asarray(SLACK_SAG.value * self.cells.slack / self.record.lowest)

    @cached_property
    def torque(self) -> Array:
        """Of every motor over its rated one [-], shape (steps, d)."""
        return np.asarray(self.record.drives["motor"] / self.ride.rated)

    @cached_property
    def travel(self) -> Array:
        """Of the take-up's carriage, away from the belt positive [m], every step."""
        return np.asarray(self.record.take_up["belt"] / self.line.take_up.strands)

    @cached_property
    def stops(self) -> bool:
        """Whether the last thing every drive is told is to stop."""
        told = {d: happening.do for happening in self.ride.scene.happenings for d in happening.drives}
        return len(told) == len(self.ride.drives) and "start" not in told.values()

    @cached_property
    def belt_speed(self) -> Array:
        """At the first drive [m/s], every step."""
        return np.asarray(self.record.drives["belt"][:, 0])

    @cached_property
    def rests_at(self) -> float | None:
        """When the belt has come to rest for good, drive pulleys and all along [s]; None where it has not."""
        turning = np.abs(self.record.drives["belt"]).max(axis=1) > 0.0
        creeping = np.abs(self.record.speeds).max(axis=1) > _REST * self.line.speed
        if turning[-1] or creeping[-1]:
            return None
        ends = [
            float(times[np.flatnonzero(moves)[-1]])
            for times, moves in ((self.times, turning), (self.record.times, creeping))
            if moves.any()
        ]
        return max(ends, default=0.0)

    @cached_property
    def way(self) -> float:
        """Of the belt at the first drive [m]."""
        return float(self.belt_speed.sum() * self.record.step)

    @property
    def missing_energy(self) -> float:
        """What the sum of all energies lacks over the largest of them [-]."""
        work = {name: abs(float(value)) for name, value in self.record.work.items()}
        missing = work.pop("missing")
        return missing / max(work.values())


@dataclass(frozen=True)
class ScenarioRefusal:
    """A scenario without an answer, and why."""

    scenario: str
    reason: Said


_Answer: TypeAlias = Followed | ScenarioRefusal


class _Peaks(NamedTuple):
    """Of a scenario at a size of cells [N, s]."""

    highest: float
    lowest: float
    step: float

    @classmethod
    def of(cls, one: Followed) -> Self:
        return cls(one.highest, one.lowest, one.record.step)


@dataclass(frozen=True, eq=False)
class CalculatedDynamics:
    """Scenarios of a conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    given : CalculatedConveyor
        Its steady result, the take-up at the one setting of every load of the spec.
    followed : tuple of Followed
        In order of the scenarios.
    refused : tuple of ScenarioRefusal
        Those without an answer.
    sized : tuple of Size
        Figures that were sought for them, where any were.
    """

    conveyor: Conveyor
    given: CalculatedConveyor
    followed: tuple[Followed, ...]
    refused: tuple[ScenarioRefusal, ...] = ()
    sized: tuple[Size, ...] = ()

    @cached_property
    def assumptions(self) -> tuple[str, ...]:
        """What the figures rest on that the spec does not say."""
        return tuple(dict.fromkeys(_assumed(self)))


def standard_scenarios(conveyor: Conveyor) -> tuple[Scenario, ...]:
    """Starts full and empty, a stop by the drives, an emergency stop, power failures: what every conveyor meets."""
    line = conveyor.drive
    led = all(pulley.starter is None or pulley.starter.kind == "inverter" for pulley in line.pulleys)
    direct = line.start_factor is None and (line.torque_curve or line.torque_factor is not None)
    led = led and not (direct and line.starter is None)
    braked = any(pulley.brake_force is not None for pulley in line.pulleys)
    brake = [{"at": line.brake_delay, "do": "brake"}] if braked else []
    made = [
        ("start full", "at rest", "full", [{"do": "start"}]),
        ("start empty", "at rest", "empty", [{"do": "start"}]),
        *([("stop full", "running", "full", [{"do": "ramp down"}])] if led else []),
        ("emergency stop full", "running", "full", [{"do": "power off"}, *brake]),
        *([("power failure full, brakes fail", "running", "full", [{"do": "power off"}])] if braked else []),
        *(
            (f"power failure of {name}", "running", "full", [{"do": "power off", "drives": [name]}])
            for name in line.names
            if len(line.names) > 1
        ),
    ]
    return tuple(
        Scenario.from_data({"name": name, "begins": begins, "loading": loading, "events": events})
        for name, begins, loading, events in made
    )


def follow(
    conveyor: Conveyor,
    scenarios: Sequence[Scenario] | None = None,
    *,
    error: float = ERROR,
    step: float | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Progress | None = None,
    loads: EveryLoad | None = None,
) -> CalculatedDynamics:
    """Follow scenarios through time.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    scenarios : sequence of Scenario, optional
        Those of the spec without it, or the standard ones where it has none.
    error : float
        Of the highest and lowest tension over the highest, asked for [-].
    step : float, optional
        Travel time of a cell [s]; without it cells are halved until the peaks hold to `error`.
    executor : concurrent.futures.Executor, optional
        Where groups of scenarios are followed, as in `conveyor.studies.campaign.run`; side by side here without one.
    workers : int
        Of the executor: as many groups.
    progress : callable, optional
        Called with what is done and the whole.
    loads : EveryLoad, optional
        Every load of the spec, where they are calculated already.

    Returns
    -------
    CalculatedDynamics
        One result a scenario; those without an answer beside them.

    Raises
    ------
    InputError
        A loading does not fit the belt, or an argument is outside its range.
    NoSolutionError, RangeError
        A load has no steady answer, the belt's stiffness is not known, or no scenario has an answer.
    """
    if not 0.0 < error < 1.0:
        raise InputError(f"error = {error}: between 0 and 1 is needed")
    rides, given = prepared_rides(
        conveyor, tuple(scenarios or conveyor.scenarios or standard_scenarios(conveyor)), loads
    )
    with telling(conveyor.report.units):
        if step is not None:
            answers = _sorted(_each(rides, step))
        else:
            answers = refined(rides, error, executor=executor, workers=workers, progress=progress)
    return CalculatedDynamics(conveyor, given, *answers)


@workers_of("scenarios")
def refined(
    rides: Sequence[Ride],
    error: float = ERROR,
    *,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> tuple[tuple[Followed, ...], tuple[ScenarioRefusal, ...]]:
    """Follow scenarios, cells halved until the peaks hold to an error [-]; arguments and errors as of `follow`.

    Those whose peaks do not hold at the finest cells are refused as those without an answer are.
    """

    def beside(some: list[Ride], step: float) -> list[_Answer]:
        """A group for every worker; every scenario keeps its place."""
        if executor is None:
            return _each(some, step)
        groups = [some[k::workers] for k in range(min(workers, len(some)))]
        made = list(executor.map(_each, groups, itertools.repeat(step)))
        return [made[i % len(groups)][i // len(groups)] for i in range(len(some))]

    step = max(float(ride.loop.travel[-1]) for ride in rides) / _CELLS
    answers = beside(list(rides), step)
    peaks = [[_Peaks.of(one)] if isinstance(one, Followed) else [] for one in answers]
    for halved in range(_REFINED):
        retried = halved < _RETRIED
        open_ones = [
            i
            for i, one in enumerate(answers)
            if _open(one, error) or (retried and isinstance(one, ScenarioRefusal))
        ]
        if not open_ones:
            break
        if progress is not None:
            progress(len(rides) - len(open_ones), len(rides))
        step *= 0.5
        for i, now in zip(open_ones, beside([rides[i] for i in open_ones], step), strict=True):
            answers[i] = now
            if isinstance(now, Followed):
                peaks[i].append(_Peaks.of(now))
                answers[i] = replace(now, error=_error(peaks[i]))
    return _sorted([_unsettled(one, peaks[i]) if _open(one, error) else one for i, one in enumerate(answers)])


def _open(one: _Answer, error: float) -> TypeGuard[Followed]:
    """Whether its peaks do not hold yet."""
    return isinstance(one, Followed) and (one.error is None or one.error > error)


def _error(peaks: Sequence[_Peaks]) -> float | None:
    """Of the last peaks over the highest [-], by how they changed as cells were halved; None of fewer than four.

    Grid convergence index with the order that the changes show, the first at most: a change may be small by chance, so
    it counts half the one before at least. One that turns back shows no order and counts as that before it.
    """
    if len(peaks) < _SIZES:
        return None
    errors = []
    for tension in list(zip(*peaks[-_SIZES:], strict=True))[:2]:
        changes = [fine - coarse for coarse, fine in itertools.pairwise(tension)]
        before, change = 0.0, abs(changes[0])
        for now in changes[1:]:
            before, change = change, max(abs(now), change / _FASTEST)
        if changes[-2] * changes[-1] < 0.0:
            errors.append(_SAFETY * max(change, abs(changes[-2])))
        elif change > 0.0:
            errors.append(_SAFETY * change / (max(before / change, _SLOWEST) - 1.0))
    return max(errors, default=0.0) / peaks[-1].highest


def _unsettled(one: Followed, peaks: Sequence[_Peaks]) -> ScenarioRefusal:
    """A scenario whose peaks hold to less than was asked for: the last figures, where, and what helps."""
    record, error = one.record, one.error or 0.0
    coarse, fine = peaks[-2:]
    high = abs(fine.highest - coarse.highest) > abs(fine.lowest - coarse.lowest)
    i = int(record.highest.argmax() if high else record.lowest.argmin())
    at = float((record.highest_at if high else record.lowest_at)[i])
    helps = (
        f"they come closer: an error of {percent(math.ceil(1e3 * error) / 1e3, 1)} can be asked for"
        if error < _CLOSER * (_error(peaks[:-1]) or 0.0)
        else "shorter cells bring them no closer, a larger error would only hide it: look for what jumps there, as a "
        "winch with hardly any run-up or a drive of hardly any mass"
    )
    figures = zip((*coarse, *fine), 2 * ("force", "force", "time"), strict=True)
    return ScenarioRefusal(one.name, said(
        "highest and lowest tension are {} and {} at steps of {}, {} and {} at steps of {}: an error of "
        f"{percent(error, 1)} of the highest, most in {quoted(one.place(i))} after {at:.1f} s; {helps}", *figures
    ))  # fmt: skip


def _sorted(answers: Sequence[_Answer]) -> tuple[tuple[Followed, ...], tuple[ScenarioRefusal, ...]]:
    """Scenarios with an answer, and those without.

    Raises
    ------
    NoSolutionError
        None has one.
    """
    followed = tuple(one for one in answers if isinstance(one, Followed))
    refused = tuple(one for one in answers if isinstance(one, ScenarioRefusal))
    if not followed:
        named: dict[Said, list[str]] = {}
        for one in refused:
            named.setdefault(one.reason, []).append(f'"{one.scenario}"')
        of_reason = ((", ".join(of), why) for why, of in named.items())
        raise NoSolutionError(
            "\n".join(["scenario {}: {}"] * len(named)), *itertools.chain.from_iterable(of_reason)
        )
    return followed, refused


def _each(rides: list[Ride], step: float) -> list[_Answer]:
    """Scenarios side by side; each alone where one of them has no answer."""
    try:
        return list(side_by_side(rides, step))
    except NoSolutionError as error:
        if len(rides) == 1:
            return [ScenarioRefusal(rides[0].scene.name, said(quoted(str(error))))]
    return [answer for one in rides for answer in _each([one], step)]


def side_by_side(rides: Sequence[Ride], step: float) -> list[Followed]:
    """Follow scenarios of one conveyor side by side, their cells as long as a wave travels in a step [s].

    Raises
    ------
    NoSolutionError
        The drives have no room, a drive cannot do what it is told, or a figure is not finite.
    """
    cells, chain, start = prepared(list(rides), step)
    step = _COURANT * min(step, chain.longest_step)
    steps = math.ceil(max(ride.duration for ride in rides) / step) + 1
    record = run(chain, machines(list(rides), start, step, steps), start, step=step)
    return [
        Followed(ride, one, _only(record, i, one.at.size, ride.duration), None)
        for i, (ride, one) in enumerate(zip(rides, cells, strict=True))
    ]


def _only(record: Record, i: int, size: int, duration: float) -> Record:
    """One belt of a record, its own cells, for its own time."""
    steps, kept = math.ceil(duration / record.step) + 1, record.times <= duration
    return Record(
        record.step, record.highest[i, : size - 1], record.lowest[i, : size - 1], record.highest_at[i, : size - 1],
        record.lowest_at[i, : size - 1], record.highest_speed[i, :size], record.lowest_speed[i, :size],
        record.highest_speed_at[i, :size], record.lowest_speed_at[i, :size], record.times[kept],
        record.tensions[kept, i, : size - 1],
        record.speeds[kept, i, :size], {name: values[:steps, i] for name, values in record.drives.items()},
        {name: values[:steps, i] for name, values in record.take_up.items()}, record.slipped[i], record.heat[i],
        record.fastest[i, :size], record.slowest[i, :size], {name: v[i] for name, v in record.work.items()},
    )  # fmt: skip


def prepared_rides(
    conveyor: Conveyor, scenarios: Sequence[Scenario], loads: EveryLoad | None = None
) -> tuple[list[Ride], CalculatedConveyor]:
    """Every scenario on its load, the take-up at the setting of `every_load`; a load of several is calculated once."""
    loads = every_load(conveyor) if loads is None else loads
    loaded: dict[tuple[object, ...], Conveyor] = {}
    keys = []
    for scenario in scenarios:
        temperature = ScenarioUnit.of(scenario, conveyor).temperature
        key = (scenario.loading, scenario.sections, str(scenario.share), temperature)
        keys.append(key)
        if key not in loaded:
            case = _case(loads.states, scenario)
            made = with_case(conveyor, case)
            if temperature is not None:
                made = with_temperature(made, from_si(temperature, "temperature", "K"))
            loaded[key] = made
    steady = _answers([Variant(one, take_up=loads.states.take_up) for one in loaded.values()])
    slower = _answers([
        Variant(slowed(one, share), take_up=loads.states.take_up)
        for one in (conveyor, *loaded.values()) for share in SPEEDS
    ])  # fmt: skip
    loops = [
        CutLoop.of(one, slower[len(SPEEDS) * i : len(SPEEDS) * (i + 1)])
        for i, one in enumerate((loads.own, *steady))
    ]
    of_key = dict(zip(loaded, loops[1:], strict=True))
    rides = [
        Ride(ScenarioUnit.of(scenario, conveyor), of_key[key], loops[0], loads.take_up)
        for scenario, key in zip(scenarios, keys, strict=True)
    ]
    return rides, loads.own


def _case(states: CalculatedStates, scenario: Scenario) -> LoadCase:
    """What a scenario loads."""
    loading, sections = scenario.loading, scenario.sections
    if loading == "worst":
        state = states.state("worst")
        if state is None:
            raise NoSolutionError(f'scenario "{scenario.name}": no loading is worst; name the sections')
        loading, sections = ("sections", state.loaded) if state.loaded else ("empty", ())
    return LoadCase(name=scenario.name, loading=loading, sections=sections, share=scenario.share)


def _answers(variants: list[Variant]) -> list[CalculatedConveyor]:
    results = []
    for one in calculate_many(variants):
        if not isinstance(one, CalculatedConveyor):
            raise one
        results.append(one)
    return results


def _assumed(dynamics: CalculatedDynamics) -> Iterator[str]:
    line = dynamics.given.line
    if line.belt.retardation is None and line.belt.relaxing is None:
        yield f"belt.carcass.retardation_time not given: {BELT_RETARDATION.value:g} s, general knowledge"
    if line.belt.stiffness is None:
        yield "belt.carcass.stiffness not given: the usual multiple of strength or rating"
    if any(not pulley.driven for pulley in line.pulleys):
        yield (
            f"pulleys not driven turn like {percent(PULLEY_INERTIA.value)} of their mass, not given: "
            "general knowledge"
        )
    if line.take_up.kind == "slack side":
        yield "route.take_up not given: a weight on the slack side of the drive"
    if any(float(followed.record.slipped.max()) > 0.0 for followed in dynamics.followed):
        yield (
            f"drag of a drive without power, whose belt slips, not given: {percent(DRIVE_DRAG.value)} of its "
            "loss at rated "
            "power, general knowledge"
        )
    for followed in dynamics.followed:
        yield from _assumed_drives(followed.ride)


def _assumed_drives(ride: Ride) -> Iterator[str]:
    for drive, unit in zip(ride.drives, ride.starters, strict=True):
        values = {
            "slip": f"{percent(MOTOR_SLIP.value)}, general knowledge",
            "kind": unit.kind,
            "time": f"{unit.time or 0.0:.0f} s, of the stiff belt at the start factor, by the ramp's shape",
            "initial torque": f"{percent(unit.initial)}, general knowledge",
        }
        for what in unit.assumed:
            yield f"{drive.name}: starter's {what} not given: {values[what]}"
        if unit.limit is None and not ride.loop.line.torque_curve:
            yield f"{drive.name}: torque limit not given: {TORQUE_LIMIT.value:g} x rated, general knowledge"
        if drive.power is None:
            yield f"{drive.name}: installed power not given: motors rated for the largest steady force"
        if not (drive.mass_given and drive.reduced_mass):
            given = "of 0 kg" if drive.mass_given else "not given"
            yield f"{drive.name}: rotating masses {given}: typical of its power"
    if ride.assumed_backstop:
        yield f"{ride.drives[0].name}: backstop not given: one is assumed, the loaded belt would roll back"
