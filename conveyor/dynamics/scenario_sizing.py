"""Sizing for starts and stops that keep every criterion: ramp, brake, delay between drives, take-up tension."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from conveyor.checks import Check
from conveyor.dynamics.criteria import DYNAMICS_CRITERIA
from conveyor.dynamics.machines import ScenarioSetup, ScenarioSize
from conveyor.dynamics.scenario_result import ScenarioResult
from conveyor.dynamics.simulation import ERROR, CalculatedDynamics, prepare_setups, simulate_batch, simulate_to_error
from conveyor.errors import InputError, MessageQuantity, NoSolutionError
from conveyor.laws.take_up import take_up_mass
from conveyor.models import Conveyor, Scenario, TakeUp
from conveyor.units.sentences import Message, message, reraise_in_units

SizingTarget: TypeAlias = Literal["ramp", "brake", "delay", "take-up"]

_TRIALS, _ROUNDS, _CELLS = 8, 3, 60
_RAMPS, _DELAYS = (5.0, 600.0), (0.0, 120.0)  # [s]
_BRAKES = (0.02, 5.0)  # over the rated force of all motors
_SETTINGS = (0.25, 8.0)  # over the setting as given
_NOT_SIZED: Final = frozenset({"dynamic_travel"})
"""Criteria left out of sizing: the take-up is built for the travel it needs."""


def size_scenario(
    conveyor: Conveyor,
    scenario: Scenario,
    sought: SizingTarget,
    *,
    between: tuple[float, float] | None = None,
) -> ScenarioSize:
    """Find the least ramp, brake force or take-up tension that keeps every criterion, or the best delay.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    scenario : Scenario
        A start or a stop.
    sought : {"ramp", "brake", "delay", "take-up"}
        Time of the ramps of all drives; total brake force, shared as given, else like the drive force; time from one
        drive to the next, with the lowest peak; take-up tension, and its weight. A stop must come to rest within the
        duration of its scenario.
    between : tuple of float, optional
        Range to search: s, N at the belt, N; by default 5 to 600 s, 2 to 500 % of the motors' rated force, 0 to 120 s,
        a quarter to eight times the setting.

    Returns
    -------
    ScenarioSize
        The smallest value tried from which on all keep the criteria, up to the largest that does.

    Raises
    ------
    InputError
        The scenario has nothing of the kind: no inverter, no brake, one drive.
    NoSolutionError
        No value in the range keeps the criteria: the message gives the failures of the best one.
    """
    (setup,), _ = prepare_setups(conveyor, (scenario,))
    made, ends, kind = _VARIANTS[sought](setup)
    low, high = between or ends
    if not (0.0 <= low < high and (low > 0.0 or sought == "delay")):
        raise InputError(f"between {low:g} and {high:g}: 0 < low < high is needed")
    with reraise_in_units(conveyor.report.units):
        if sought == "delay":
            return _best_delay(setup, made, low, high)
        least, most, below, fails = _least_value(scenario.name, made, (low, high), kind)
    error = None if below is None else least / below - 1.0
    first = fails[0] if fails else None
    sized = ScenarioSize(
        scenario.name, _LABELS[sought], kind, least, error, most, message("") if first is None else first.subject,
        message("") if first is None or first.why is None else first.why, _name_with_size(made(least), sought, least),
    )  # fmt: skip
    return _take_up_size(conveyor, scenario, sized) if sought == "take-up" else sized


def size_and_simulate(
    conveyor: Conveyor,
    scenarios: Sequence[Scenario],
    sought: SizingTarget,
    *,
    error: float = ERROR,
    **how: Any,
) -> CalculatedDynamics:
    """Size every scenario and simulate it at its size; arguments and errors as of `size_scenario` and `follow`."""
    sizes = tuple(size_scenario(conveyor, one, sought) for one in scenarios)
    _, given = prepare_setups(conveyor, scenarios)
    return CalculatedDynamics(conveyor, given, *simulate_to_error([one.setup for one in sizes], error, **how), sizes)


def _ramp_variants(setup: ScenarioSetup) -> tuple[Callable[[float], ScenarioSetup], tuple[float, float], str]:
    units = setup.starters
    others = [unit.kind for unit in units if unit.kind != "inverter"]
    if others:
        raise InputError(f'scenario "{setup.scene.name}": a ramp needs inverters, a starter is "{others[0]}"')

    def made(time: float) -> ScenarioSetup:
        return replace(setup, units=tuple(replace(unit, time=time, stop_time=time) for unit in units))

    return made, _RAMPS, "time"


def _brake_variants(
    setup: ScenarioSetup,
) -> tuple[Callable[[float], ScenarioSetup], tuple[float, float], str]:
    if all(happening.do != "brake" for happening in setup.scene.drive_events):
        raise InputError(f'scenario "{setup.scene.name}": no brake grips in it; give it an event {{do: brake}}')
    given = np.array(setup.brakes, dtype=float)
    shares = given / given.sum() if given.sum() > 0.0 else np.array([drive.share for drive in setup.drives])
    rated = float(setup.rated.sum())

    def made(force: float) -> ScenarioSetup:
        return replace(setup, braking=tuple((force * shares).tolist()))

    return made, (_BRAKES[0] * rated, _BRAKES[1] * rated), "force"


def _delay_variants(
    setup: ScenarioSetup,
) -> tuple[Callable[[float], ScenarioSetup], tuple[float, float], str]:
    if len(setup.drives) == 1:
        raise InputError(f'scenario "{setup.scene.name}": one drive only, nothing to delay')

    def made(time: float) -> ScenarioSetup:
        units = tuple(replace(unit, delay=d * time) for d, unit in enumerate(setup.starters))
        return replace(setup, units=units)

    return made, _DELAYS, "time"


def _take_up_variants(
    setup: ScenarioSetup,
) -> tuple[Callable[[float], ScenarioSetup], tuple[float, float], str]:
    def made(setting: float) -> ScenarioSetup:
        return replace(setup, setting=setting)

    return made, (_SETTINGS[0] * setup.setting, _SETTINGS[1] * setup.setting), "force"


_VARIANTS: Final = {
    "ramp": _ramp_variants,
    "brake": _brake_variants,
    "delay": _delay_variants,
    "take-up": _take_up_variants,
}
_LABELS: Final = {
    "ramp": "time of the ramp",
    "brake": "force of all brakes at the belt",
    "delay": "delay from drive to drive",
    "take-up": "tension of the take-up",
}


def _simulate_trials(made: Callable[[float], ScenarioSetup], values: list[float], k: int) -> list[ScenarioResult]:
    """Simulate all trial values in one batch, with cells half as long every round."""
    setups = [made(value) for value in values]
    return simulate_batch(setups, max(float(setup.loop.travel[-1]) for setup in setups) / (_CELLS * 2**k))


def _size_checks(scenario: ScenarioResult) -> list[Check]:
    every = [check for criterion in DYNAMICS_CRITERIA for check in criterion(scenario)]
    return [check for check in every if check.key not in _NOT_SIZED]


def _failed_checks(scenario: ScenarioResult) -> list[Check]:
    """Failed checks of a scenario."""
    return [check for check in _size_checks(scenario) if check.failed]


def _failure_reasons(failing: list[Check]) -> Message:
    """Reasons of failed checks in one sentence."""
    why = [check.why for check in failing if check.why is not None]
    return Message("; ".join(one.words for one in why), tuple(figure for one in why for figure in one.figures))


def _least_value(
    name: str, made: Callable[[float], ScenarioSetup], between: tuple[float, float], kind: str
) -> tuple[float, float | None, float | None, list[Check]]:
    """Least and largest value of the last passing run, the next smaller value and its failed checks."""
    most: float | None = None
    low, high = between
    for k in range(_ROUNDS):
        # what passed on coarser cells may just fail on finer ones: one step further is included
        values = np.geomspace(low, high if k == 0 else high * high / low, _TRIALS).tolist()
        failing = [_failed_checks(one) for one in _simulate_trials(made, values, k)]
        serve = [i for i, of in enumerate(failing) if not of]
        if not serve:
            raise NoSolutionError(
                'scenario "{}": nothing from {} to {} keeps every check; at best: {}',
                name,
                MessageQuantity(low, kind, f"{low:.4g}"),
                MessageQuantity(values[-1], kind, f"{values[-1]:.4g} (SI)"),
                _failure_reasons(min(failing, key=len)),
            )
        first = last = serve[-1]
        while first and not failing[first - 1]:
            first -= 1
        if k == 0 and last < len(values) - 1:
            most = values[last]
        if first == 0:
            return values[0], most, None, []
        low, high, fails = values[first - 1], values[first], failing[first - 1]
    return high, most, low, fails


def _best_delay(setup: ScenarioSetup, made: Callable[[float], ScenarioSetup], low: float, high: float) -> ScenarioSize:
    """Delay with the lowest peak among those that keep every criterion."""
    best: tuple[float, float, ScenarioResult] | None = None
    for k in range(_ROUNDS):
        values = np.linspace(low, high, _TRIALS).tolist()
        followed = _simulate_trials(made, values, k)
        serve = [(one.highest, value, one) for value, one in zip(values, followed, strict=True)
                 if not _failed_checks(one)]  # fmt: skip
        if not serve and best is None:
            raise NoSolutionError(
                f'scenario "{{}}": no delay to {high:.4g} s keeps every criterion: {{}}',
                setup.scene.name,
                _failure_reasons(_failed_checks(followed[-1])),
            )
        best = min([*serve, *([best] if best else [])], key=lambda one: one[0])
        step = (high - low) / (_TRIALS - 1)
        low, high = max(low, best[1] - step), min(high, best[1] + step)
    assert best is not None  # noqa: S101 a first round without a result raises
    _, value, one = best
    margins = [check for check in _size_checks(one) if check.margin is not None]
    governs = min(margins, key=lambda check: check.margin or 0.0)
    return ScenarioSize(
        setup.scene.name, _LABELS["delay"], "time", value, step / value if value else None, None,
        governs.subject, message("lowest peak: {}", (one.highest, "force")),
        _name_with_size(made(value), "delay", value),
    )  # fmt: skip


def _name_with_size(setup: ScenarioSetup, sought: str, value: float) -> ScenarioSetup:
    """Scenario with its size in the name."""
    figure = f"{value:.3g} s" if sought in {"ramp", "delay"} else f"{value / 1e3:.3g} kN"
    return replace(setup, scene=replace(setup.scene, name=f"{setup.scene.name}, {sought} {figure}"))


def _take_up_size(conveyor: Conveyor, scenario: Scenario, size: ScenarioSize) -> ScenarioSize:
    """Size recalculated with the take-up tension in the spec; for a gravity take-up as its mass."""
    given = conveyor.route.take_up or TakeUp.from_data({"kind": "gravity"})
    unit = given.replace(tension=f"{size.value:.9g} N", mass=None)
    (setup,), _ = prepare_setups(conveyor.replace(route=conveyor.route.replace(take_up=unit)), (scenario,))
    size = replace(size, setup=_name_with_size(setup, "take-up", size.value))
    if given.kind != "gravity":
        return size
    line = setup.loop.line

    def mass(tension: float | None) -> float | None:
        if tension is None:
            return None
        return take_up_mass(tension, reeving=line.take_up.reeving, gravity=line.gravity, strands=line.take_up.strands)

    value = mass(size.value)
    assert value is not None  # noqa: S101 it has a tension
    return replace(size, label="mass of the take-up's weight", kind="mass", value=value, most=mass(size.most))
