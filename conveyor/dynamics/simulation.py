"""Simulation of scenarios through time, in batches, with cells refined until the peak tensions converge."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, NamedTuple, Self, TypeAlias, TypeGuard

import numpy as np

from conveyor.arguments.limits import require_workers
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.dynamics.belt_chain import Record
from conveyor.dynamics.cut_loop import SPEEDS, CutLoop
from conveyor.dynamics.machines import ScenarioSetup, ScenarioSize, machines_over_time, prepare_belts
from conveyor.dynamics.scenario_result import ScenarioRefusal, ScenarioResult
from conveyor.dynamics.wave import simulate_belts
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.waves import BELT_RETARDATION, DRIVE_DRAG, MOTOR_SLIP, PULLEY_INERTIA, TORQUE_LIMIT
from conveyor.line.drive_scenarios import ScenarioUnit
from conveyor.models import Conveyor, LoadCase, Scenario
from conveyor.models.variants import at_reduced_speed, with_case, with_temperature
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.studies.loads import EveryLoad, every_load
from conveyor.studies.states import CalculatedStates
from conveyor.studies.worker_failures import report_lost_worker
from conveyor.units import from_si
from conveyor.units.sentences import Message, escape_braces, message, percent, reraise_in_units

ERROR: Final = 0.01
"""Default error of the peaks [-]."""


_CELLS = 50  # of the longest belt at first


_REFINEMENTS = 5  # refinements at most


_RETRIES = 2  # refinements of a scenario without an answer: its cells may be too long


_SIZES = 3  # cell sizes for an error estimate


_SAFETY = 2.0  # of an error by its change; the 1.25 of Roache (1994, 405) left true ones up to 1.3 times above it


_SLOWEST, _FASTEST = math.sqrt(2.0), 2.0  # ratio of changes: at a jump of speed, at first order


_HALVING_HELPS = 0.75  # ratio of errors up to which halving helps: 1/2 at first order, 1/√2 at a jump of speed


_COURANT = 0.95  # of the longest stable step: at that step itself cell-to-cell oscillations are never damped


_ResultOrRefusal: TypeAlias = ScenarioResult | ScenarioRefusal


class _Peaks(NamedTuple):
    """Peak tensions of a scenario at a cell size, and the lowest's jump as in `ScenarioResult` [N, s]."""

    highest: float
    lowest: float
    step: float
    jump: float | None = None

    @classmethod
    def of(cls, one: ScenarioResult) -> Self:
        return cls(one.highest, one.lowest, float(one.record.step), one.jump)


@dataclass(frozen=True, eq=False)
class CalculatedDynamics:
    """Scenarios of a conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    given : CalculatedConveyor
        Its steady result, at the one take-up setting of every load of the spec.
    followed : tuple of ScenarioResult
        Results in order of the scenarios.
    refused : tuple of ScenarioRefusal
        Scenarios without an answer.
    sized : tuple of ScenarioSize
        Sizes determined for them, if any.
    """

    conveyor: Conveyor
    given: CalculatedConveyor
    followed: tuple[ScenarioResult, ...]
    refused: tuple[ScenarioRefusal, ...] = ()
    sized: tuple[ScenarioSize, ...] = ()

    @cached_property
    def assumptions(self) -> tuple[str, ...]:
        """Assumptions for values that the spec does not give."""
        return tuple(dict.fromkeys(_dynamics_assumptions(self)))


def standard_scenarios(conveyor: Conveyor) -> tuple[Scenario, ...]:
    """Standard scenarios: starts full and empty, a stop by the drives, an emergency stop, power failures."""
    line = conveyor.drive
    led = all(pulley.starter is None or pulley.starter.kind == "inverter" for pulley in line.pulleys)
    direct = line.start_factor is None and (line.torque_curve or line.torque_factor is not None)
    led = led and not (direct and line.starter is None)
    braked = any(pulley.braked for pulley in line.pulleys)
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


def simulate_scenarios(
    conveyor: Conveyor,
    scenarios: Sequence[Scenario] | None = None,
    *,
    error: float = ERROR,
    step: float | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    progress: ProgressCallback | None = None,
    loads: EveryLoad | None = None,
) -> CalculatedDynamics:
    """Simulate scenarios through time.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    scenarios : sequence of Scenario, optional
        By default those of the spec, or the standard ones if it has none.
    error : float
        Permitted error of the highest and lowest tension over the highest [-].
    step : float, optional
        Travel time of a cell [s]; by default cells are halved until the peaks converge to `error`.
    executor : concurrent.futures.Executor, optional
        Executor of groups of scenarios, as in `conveyor.studies.parametric_study.run_study`; by default one batch in
        this process.
    workers : int
        Workers of the executor, and number of groups.
    progress : callable, optional
        Called with the items done and their total.
    loads : EveryLoad, optional
        Every load of the spec, if already calculated.

    Returns
    -------
    CalculatedDynamics
        One result per scenario, and the scenarios without an answer.

    Raises
    ------
    InputError
        A loading does not fit the belt, or an argument is outside its range.
    NoSolutionError, RangeError
        A load has no steady answer, the belt's stiffness is not known, or no scenario has an answer.
    """
    if not 0.0 < error < 1.0:
        raise InputError(f"error = {error}: between 0 and 1 is needed")
    require_workers(workers)
    setups, given = prepare_setups(
        conveyor, tuple(scenarios or conveyor.scenarios or standard_scenarios(conveyor)), loads
    )
    with reraise_in_units(conveyor.report.units):
        if step is not None:
            answers = _split_refusals(_simulate_group(setups, [step] * len(setups)))
        else:
            answers = simulate_to_error(setups, error, executor=executor, workers=workers, progress=progress)
    return CalculatedDynamics(conveyor, given, *answers)


@report_lost_worker("scenarios")
def simulate_to_error(
    setups: Sequence[ScenarioSetup],
    error: float = ERROR,
    *,
    executor: Executor | None = None,
    workers: int = 1,
    progress: ProgressCallback | None = None,
) -> tuple[tuple[ScenarioResult, ...], tuple[ScenarioRefusal, ...]]:
    """Simulate scenarios as `simulate_scenarios`, halving cells until the peaks converge to an error [-].

    Scenarios that do not converge at the finest cells count as without an answer.
    """

    def beside(some: list[ScenarioSetup], steps: list[float]) -> list[list[_ResultOrRefusal]]:
        """Simulate one group per worker at every step; results in the order of the scenarios."""
        if executor is None:
            return _simulate_sizes(some, steps)
        groups = [some[k::workers] for k in range(min(workers, len(some)))]
        made = list(executor.map(_simulate_sizes, groups, itertools.repeat(steps)))
        return [made[i % len(groups)][i // len(groups)] for i in range(len(some))]

    longest = max(float(setup.loop.travel[-1]) for setup in setups) / _CELLS
    sizes = [longest * 0.5**halved for halved in range(_REFINEMENTS + 1)]
    # as many as an error estimate needs, in one batch
    first = beside(list(setups), sizes[:_SIZES])
    answers = [made[0] for made in first]
    peaks = [[_Peaks.of(one)] if isinstance(one, ScenarioResult) else [] for one in answers]
    for halved in range(_REFINEMENTS):
        retried = halved < _RETRIES
        open_ones = [
            i
            for i, one in enumerate(answers)
            if _needs_refinement(one, error) or (retried and isinstance(one, ScenarioRefusal))
        ]
        if not open_ones:
            break
        if progress is not None:
            progress(len(setups) - len(open_ones), len(setups))
        size = halved + 1
        made = (
            [first[i][size] for i in open_ones]
            if size < _SIZES
            else [one for (one,) in beside([setups[i] for i in open_ones], [sizes[size]])]
        )
        for i, now in zip(open_ones, made, strict=True):
            answers[i] = now
            if isinstance(now, ScenarioResult):
                peaks[i].append(_Peaks.of(now))
                answers[i] = replace(now, error=_peak_error(peaks[i]))
    return _split_refusals(
        [_unconverged_refusal(one, peaks[i]) if _needs_refinement(one, error) else one for i, one in enumerate(answers)]
    )


def _needs_refinement(one: _ResultOrRefusal, error: float) -> TypeGuard[ScenarioResult]:
    """True if the peaks have not converged."""
    return isinstance(one, ScenarioResult) and (one.error is None or one.error > error)


def _peak_error(peaks: Sequence[_Peaks]) -> float | None:
    """Error of the last peaks over the highest [-], from their changes as cells were halved; None for fewer than three.

    Grid convergence index with the observed order, at most the first: a change may be small by chance, so it counts at
    least half the previous one. A change of opposite sign shows no order and counts like the previous one. A lowest
    tension that comes at once converges with order 1/2, however its changes fall; the belt beside the pulley may swing
    from cell to cell, below the tension at the pulley itself.
    """
    if len(peaks) < _SIZES:
        return None
    errors: list[float] = []
    jump = peaks[-1].jump
    for k, tension in enumerate(list(zip(*peaks[-_SIZES:], strict=True))[:2]):
        at_once = k == 1 and jump is not None
        changes = [fine - coarse for coarse, fine in itertools.pairwise(tension)]
        before, change = 0.0, abs(changes[0])
        for now in changes[1:]:
            before, change = change, max(abs(now), change / (_SLOWEST if at_once else _FASTEST))
        if changes[-2] * changes[-1] < 0.0 and not at_once:
            errors.append(_SAFETY * max(change, abs(changes[-2])))
        elif change > 0.0:
            errors.append(_SAFETY * change / (max(before / change, _SLOWEST) - 1.0))
    return max([*errors, jump or 0.0]) / peaks[-1].highest


def _unconverged_refusal(one: ScenarioResult, peaks: Sequence[_Peaks]) -> ScenarioRefusal:
    """Refusal of a scenario that has not converged: the last figures, their location, and the remedy."""
    record, error = one.record, one.error or 0.0
    coarse, fine = peaks[-2:]
    high = abs(fine.highest - coarse.highest) > abs(fine.lowest - coarse.lowest)
    i = int(record.highest.argmax() if high else record.lowest.argmin())
    at = float((record.highest_at if high else record.lowest_at)[i])
    helps = (
        f"they come closer: an error of {percent(math.ceil(1e3 * error) / 1e3, 1)} can be asked for"
        if error < _HALVING_HELPS * (_peak_error(peaks[:-1]) or 0.0)
        else "shorter cells bring them no closer, a larger error would only hide it: look for what jumps there, as a "
        "winch with hardly any run-up or a drive of hardly any mass"
    )
    figures = zip((*coarse[:3], *fine[:3]), 2 * ("force", "force", "time"), strict=True)
    return ScenarioRefusal(one.name, message(
        "highest and lowest tension are {} and {} at steps of {}, {} and {} at steps of {}: an error of "
        f"{percent(error, 1)} of the highest, most in {escape_braces(one.place(i))} after {at:.1f} s; {helps}", *figures
    ))  # fmt: skip


def _split_refusals(
    answers: Sequence[_ResultOrRefusal],
) -> tuple[tuple[ScenarioResult, ...], tuple[ScenarioRefusal, ...]]:
    """Separate scenarios with an answer from those without.

    Raises
    ------
    NoSolutionError
        None has an answer.
    """
    followed = tuple(one for one in answers if isinstance(one, ScenarioResult))
    refused = tuple(one for one in answers if isinstance(one, ScenarioRefusal))
    if not followed:
        named: dict[Message, list[str]] = {}
        for one in refused:
            named.setdefault(one.reason, []).append(f'"{one.scenario}"')
        of_reason = ((", ".join(of), why) for why, of in named.items())
        raise NoSolutionError("\n".join(["scenario {}: {}"] * len(named)), *itertools.chain.from_iterable(of_reason))
    return followed, refused


def _simulate_sizes(setups: list[ScenarioSetup], steps: list[float]) -> list[list[_ResultOrRefusal]]:
    """Simulate every scenario at every step in one batch."""
    answers = iter(_simulate_group([setup for setup in setups for _ in steps], steps * len(setups)))
    return [list(itertools.islice(answers, len(steps))) for _ in setups]


def _simulate_group(setups: list[ScenarioSetup], steps: list[float]) -> list[_ResultOrRefusal]:
    """Simulate scenarios in one batch, or by halves of it if one of them has no answer."""
    try:
        return list(simulate_batch(setups, steps))
    except NoSolutionError as error:
        if len(setups) == 1:
            return [ScenarioRefusal(setups[0].scene.name, message(escape_braces(str(error))))]
    half = len(setups) // 2
    return [*_simulate_group(setups[:half], steps[:half]), *_simulate_group(setups[half:], steps[half:])]


def simulate_batch(setups: Sequence[ScenarioSetup], step: float | Sequence[float]) -> list[ScenarioResult]:
    """Simulate scenarios of one conveyor in one batch, each to its end.

    Parameters
    ----------
    setups : sequence of ScenarioSetup
        The scenarios.
    step : float or sequence of float
        Time in which a wave travels through a cell [s], of all or of each.

    Raises
    ------
    NoSolutionError
        The drives have no room, a drive cannot execute its command, or a figure is not finite.
    """
    cells, chain, start = prepare_belts(list(setups), np.asarray(step))
    steps = _COURANT * np.minimum(step, chain.longest_steps)
    lasts = np.ceil(np.array([setup.duration for setup in setups]) / steps).astype(int) + 1
    order = np.argsort(-lasts, kind="stable")
    setups, cells, steps, lasts = [setups[i] for i in order], [cells[i] for i in order], steps[order], lasts[order]
    chain, start = chain.of_belts(order), start.of_belts(order)
    record = simulate_belts(chain, machines_over_time(setups, start, steps, lasts), start, step=steps, lasts=lasts)
    made = [
        ScenarioResult(setup, one, _single_record(record, i, one.at.size, int(lasts[i]), setup.duration), None)
        for i, (setup, one) in enumerate(zip(setups, cells, strict=True))
    ]
    return [made[i] for i in np.argsort(order)]


def _single_record(record: Record, i: int, size: int, steps: int, duration: float) -> Record:
    """Record of one belt, with its own cells and duration."""
    kept = record.times[:, i] <= duration
    kept[1:] &= record.times[1:, i] > 0.0
    return Record(
        record.step[i], record.highest[i, : size - 1], record.lowest[i, : size - 1], record.highest_at[i, : size - 1],
        record.lowest_at[i, : size - 1], record.highest_speed[i, :size], record.lowest_speed[i, :size],
        record.highest_speed_at[i, :size], record.lowest_speed_at[i, :size], record.times[kept, i],
        record.tensions[kept, i, : size - 1],
        record.speeds[kept, i, :size], {name: values[:steps, i] for name, values in record.drives.items()},
        {name: values[:steps, i] for name, values in record.take_up.items()}, record.slipped[i], record.heat[i],
        record.fastest[i, :size], record.slowest[i, :size], {name: v[i] for name, v in record.work.items()},
    )  # fmt: skip


def prepare_setups(
    conveyor: Conveyor, scenarios: Sequence[Scenario], loads: EveryLoad | None = None
) -> tuple[list[ScenarioSetup], CalculatedConveyor]:
    """Scenarios on their loads at the take-up setting of `every_load`; shared loads are calculated once."""
    loads = every_load(conveyor) if loads is None else loads
    loaded: dict[tuple[object, ...], Conveyor] = {}
    keys = []
    for scenario in scenarios:
        temperature = ScenarioUnit.of(scenario, conveyor).temperature
        key = (scenario.loading, scenario.sections, str(scenario.share), temperature)
        keys.append(key)
        if key not in loaded:
            case = _scenario_case(loads.states, scenario)
            made = with_case(conveyor, case)
            if temperature is not None:
                made = with_temperature(made, from_si(temperature, "temperature", "K"))
            loaded[key] = made
    steady = _steady_results([Variant(one, take_up=loads.states.take_up) for one in loaded.values()])
    slower = _steady_results([
        Variant(at_reduced_speed(one, share), take_up=loads.states.take_up)
        for one in (conveyor, *loaded.values()) for share in SPEEDS
    ])  # fmt: skip
    loops = [
        CutLoop.of(one, slower[len(SPEEDS) * i : len(SPEEDS) * (i + 1)]) for i, one in enumerate((loads.own, *steady))
    ]
    of_key = dict(zip(loaded, loops[1:], strict=True))
    setups = [
        ScenarioSetup(ScenarioUnit.of(scenario, conveyor), of_key[key], loops[0], loads.take_up)
        for scenario, key in zip(scenarios, keys, strict=True)
    ]
    return setups, loads.own


def _scenario_case(states: CalculatedStates, scenario: Scenario) -> LoadCase:
    """Load case of a scenario."""
    loading, sections = scenario.loading, scenario.sections
    if loading == "worst":
        state = states.state("worst")
        if state is None:
            raise NoSolutionError(f'scenario "{scenario.name}": no loading is worst; name the sections')
        loading, sections = ("sections", state.loaded) if state.loaded else ("empty", ())
    return LoadCase(name=scenario.name, loading=loading, sections=sections, share=scenario.share)


def _steady_results(variants: list[Variant]) -> list[CalculatedConveyor]:
    results = []
    for one in calculate_many(variants):
        if not isinstance(one, CalculatedConveyor):
            raise one
        results.append(one)
    return results


def _dynamics_assumptions(dynamics: CalculatedDynamics) -> Iterator[str]:
    line = dynamics.given.line
    if line.belt.retardation is None and line.belt.relaxing is None:
        yield f"belt.carcass.retardation_time not given: {BELT_RETARDATION.value:g} s, general knowledge"
    if line.belt.stiffness is None:
        yield "belt.carcass.stiffness not given: the usual multiple of strength or rating"
    if any(not pulley.driven for pulley in line.pulleys):
        yield (
            f"pulleys not driven turn like {percent(PULLEY_INERTIA.value)} of their mass, not given: general knowledge"
        )
    if line.take_up.kind == "slack side":
        yield "route.take_up not given: a weight on the slack side of the drive"
    if any(float(followed.record.slipped.max()) > 0.0 for followed in dynamics.followed):
        yield (
            f"drag of a drive without power, whose belt slips, not given: {percent(DRIVE_DRAG.value)} of its "
            "loss at rated "
            "power, general knowledge"
        )
    if any(point.loaded_hopper is not None for point in line.loading):
        yield (
            "hoppers are as after filling where a scenario begins at rest: their pull falls to that of flow as soon as "
            "the belt under them moves, no law of its decay is known; the jump of the belt there is an upper bound"
        )
    if any(stretch.bed is not None for stretch in line.stretches):
        yield "a belt on a plate gives way in waves like one on the carry sets"
    if any(followed.setup.scene.friction == 1.0 for followed in dynamics.followed):
        yield (
            "scenarios without a friction of their own have the expected one; that to design for is "
            f"{percent(line.design_friction)} of it, the least {percent(line.least_friction)}"
        )
    for followed in dynamics.followed:
        yield from _drive_assumptions(followed.setup)


def _drive_assumptions(setup: ScenarioSetup) -> Iterator[str]:
    for drive, unit in zip(setup.drives, setup.starters, strict=True):
        values = {
            "slip": f"{percent(MOTOR_SLIP.value)}, general knowledge",
            "kind": unit.kind,
            "time": f"{unit.time or 0.0:.0f} s, of the stiff belt at the start factor, by the ramp's shape",
            "initial torque": f"{percent(unit.initial)}, general knowledge",
        }
        for what in unit.assumed:
            yield f"{drive.name}: starter's {what} not given: {values[what]}"
        if unit.limit is None and not setup.loop.line.torque_curve:
            yield f"{drive.name}: torque limit not given: {TORQUE_LIMIT.value:g} x rated, general knowledge"
        if drive.power is None:
            yield f"{drive.name}: installed power not given: motors rated for the largest steady force"
        if not (drive.mass_given and drive.reduced_mass):
            given = "of 0 kg" if drive.mass_given else "not given"
            yield f"{drive.name}: rotating masses {given}: typical of its power"
    if setup.assumed_backstop:
        yield f"{setup.drives[0].name}: backstop not given: one is assumed, the loaded belt would roll back"
