"""Sizing for starts and stops that keep every criterion: ramp, brake, delay between drives, take-up tension."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from conveyor.checks import Check
from conveyor.dynamics.criteria import CRITERIA
from conveyor.dynamics.follow import (
    ERROR,
    CalculatedDynamics,
    Followed,
    prepared_rides,
    refined,
    side_by_side,
)
from conveyor.dynamics.machines import Ride, Size
from conveyor.errors import Amount, InputError, NoSolutionError
from conveyor.laws.take_up import take_up_mass
from conveyor.models import Conveyor, Scenario, TakeUp
from conveyor.units.sentences import Said, telling

Sought: TypeAlias = Literal["ramp", "brake", "delay", "take-up"]

_TRIED, _ROUNDS, _CELLS = 8, 3, 60
_RAMPS, _DELAYS = (5.0, 600.0), (0.0, 120.0)  # [s]
_BRAKES = (0.02, 5.0)  # over the rated force of all motors
_SETTINGS = (0.25, 8.0)  # over the setting as given
_NOT_SIZED: Final = frozenset({"dynamic_travel"})
"""Criteria left out of sizing: the take-up is built for the travel it needs."""


def size(
    conveyor: Conveyor,
    scenario: Scenario,
    sought: Sought,
    *,
    between: tuple[float, float] | None = None,
) -> Size:
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
    Size
        The smallest value tried from which on all keep the criteria, up to the largest that does.

    Raises
    ------
    InputError
        The scenario has nothing of the kind: no inverter, no brake, one drive.
    NoSolutionError
        No value in the range keeps the criteria: the message gives the failures of the best one.
    """
    (ride,), _ = prepared_rides(conveyor, (scenario,))
    made, ends, kind = _MAKERS[sought](ride)
    low, high = between or ends
    if not (0.0 <= low < high and (low > 0.0 or sought == "delay")):
        raise InputError(f"between {low:g} and {high:g}: 0 < low < high is needed")
    with telling(conveyor.report.units):
        if sought == "delay":
            return _best_delay(ride, made, low, high)
        least, most, below, fails = _least(scenario.name, made, (low, high), kind)
    error = None if below is None else least / below - 1.0
    first = fails[0] if fails else None
    sized = Size(
        scenario.name, _LABELS[sought], kind, least, error, most, "" if first is None else first.subject.text(),
        "" if first is None or first.why is None else first.why.text(), _named(made(least), sought, least),
    )  # fmt: skip
    return _of_take_up(conveyor, scenario, sized) if sought == "take-up" else sized


def sized(
    conveyor: Conveyor, scenarios: Sequence[Scenario], sought: Sought, *, error: float = ERROR, **how: Any
) -> CalculatedDynamics:
    """Size every scenario and simulate it at its size; arguments and errors as of `size` and `follow`."""
    sizes = tuple(size(conveyor, one, sought) for one in scenarios)
    _, given = prepared_rides(conveyor, scenarios)
    return CalculatedDynamics(conveyor, given, *refined([one.ride for one in sizes], error, **how), sizes)


def _ramped(ride: Ride) -> tuple[Callable[[float], Ride], tuple[float, float], str]:
    units = ride.starters
    others = [unit.kind for unit in units if unit.kind != "inverter"]
    if others:
        raise InputError(f'scenario "{ride.scene.name}": a ramp needs inverters, a starter is "{others[0]}"')

    def made(time: float) -> Ride:
        return replace(ride, units=tuple(replace(unit, time=time, stop_time=time) for unit in units))

    return made, _RAMPS, "duration"


def _braked(ride: Ride) -> tuple[Callable[[float], Ride], tuple[float, float], str]:
    if all(happening.do != "brake" for happening in ride.scene.happenings):
        raise InputError(
            f'scenario "{ride.scene.name}": no brake grips in it; give it an event {{do: brake}}'
        )
    given = np.array(ride.brakes, dtype=float)
    shares = given / given.sum() if given.sum() > 0.0 else np.array([drive.share for drive in ride.drives])
    rated = float(ride.rated.sum())

    def made(force: float) -> Ride:
        return replace(ride, braking=tuple((force * shares).tolist()))

    return made, (_BRAKES[0] * rated, _BRAKES[1] * rated), "force"


def _delayed(ride: Ride) -> tuple[Callable[[float], Ride], tuple[float, float], str]:
    if len(ride.drives) == 1:
        raise InputError(f'scenario "{ride.scene.name}": one drive only, nothing to delay')

    def made(time: float) -> Ride:
        units = tuple(replace(unit, delay=d * time) for d, unit in enumerate(ride.starters))
        return replace(ride, units=units)

    return made, _DELAYS, "duration"


def _tightened(ride: Ride) -> tuple[Callable[[float], Ride], tuple[float, float], str]:
    def made(setting: float) -> Ride:
        return replace(ride, setting=setting)

    return made, (_SETTINGS[0] * ride.setting, _SETTINGS[1] * ride.setting), "force"


_MAKERS: Final = {"ramp": _ramped, "brake": _braked, "delay": _delayed, "take-up": _tightened}
_LABELS: Final = {
    "ramp": "time of the ramp",
    "brake": "force of all brakes at the belt",
    "delay": "delay from drive to drive",
    "take-up": "tension of the take-up",
}


def _followed(made: Callable[[float], Ride], values: list[float], k: int) -> list[Followed]:
    """Simulate all trial values in one batch, with cells half as long every round."""
    rides = [made(value) for value in values]
    return side_by_side(rides, max(float(ride.loop.travel[-1]) for ride in rides) / (_CELLS * 2**k))


def _checks(scenario: Followed) -> list[Check]:
    every = [check for criterion in CRITERIA for check in criterion(scenario)]
    return [check for check in every if check.key not in _NOT_SIZED]


def _failing(scenario: Followed) -> list[Check]:
    """Failed checks of a scenario."""
    return [check for check in _checks(scenario) if check.failed]


def _reasons(failing: list[Check]) -> Said:
    """Reasons of failed checks in one sentence."""
    why = [check.why for check in failing if check.why is not None]
    return Said("; ".join(one.words for one in why), tuple(figure for one in why for figure in one.figures))


def _least(
    name: str, made: Callable[[float], Ride], between: tuple[float, float], kind: str
) -> tuple[float, float | None, float | None, list[Check]]:
    """Least and largest value of the last passing run, the next smaller value and its failed checks."""
    most: float | None = None
    (low, high), shown = between, "time" if kind == "duration" else kind
    for k in range(_ROUNDS):
        # what passed on coarser cells may just fail on finer ones: one step further is included
        values = np.geomspace(low, high if k == 0 else high * high / low, _TRIED).tolist()
        failing = [_failing(one) for one in _followed(made, values, k)]
        serve = [i for i, of in enumerate(failing) if not of]
        if not serve:
            raise NoSolutionError(
                'scenario "{}": nothing from {} to {} keeps every check; at best: {}',
                name,
                Amount(low, shown, f"{low:.4g}"),
                Amount(values[-1], shown, f"{values[-1]:.4g} (SI)"),
                _reasons(min(failing, key=len)),
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


def _best_delay(ride: Ride, made: Callable[[float], Ride], low: float, high: float) -> Size:
    """Delay with the lowest peak among those that keep every criterion."""
    best: tuple[float, float, Followed] | None = None
    for k in range(_ROUNDS):
        values = np.linspace(low, high, _TRIED).tolist()
        followed = _followed(made, values, k)
        serve = [(one.highest, value, one) for value, one in zip(values, followed, strict=True)
                 if not _failing(one)]  # fmt: skip
        if not serve and best is None:
            raise NoSolutionError(
                f'scenario "{{}}": no delay to {high:.4g} s keeps every criterion: {{}}',
                ride.scene.name,
                _reasons(_failing(followed[-1])),
            )
        best = min([*serve, *([best] if best else [])], key=lambda one: one[0])
        step = (high - low) / (_TRIED - 1)
        low, high = max(low, best[1] - step), min(high, best[1] + step)
    assert best is not None  # noqa: S101 a first round without a result raises
    _, value, one = best
    margins = [check for check in _checks(one) if check.margin is not None]
    governs = min(margins, key=lambda check: check.margin or 0.0)
    return Size(
        ride.scene.name, _LABELS["delay"], "duration", value, step / value if value else None, None,
        governs.subject.text(), f"lowest peak: {one.highest / 1e3:.1f} kN", _named(made(value), "delay", value),
    )  # fmt: skip


def _named(ride: Ride, sought: str, value: float) -> Ride:
    """Scenario with its size in the name."""
    figure = f"{value:.3g} s" if sought in {"ramp", "delay"} else f"{value / 1e3:.3g} kN"
    return replace(ride, scene=replace(ride.scene, name=f"{ride.scene.name}, {sought} {figure}"))


def _of_take_up(conveyor: Conveyor, scenario: Scenario, size: Size) -> Size:
    """Size recalculated with the take-up tension in the spec; for a gravity take-up as its mass."""
    given = conveyor.route.take_up or TakeUp.from_data({"kind": "gravity"})
    unit = given.replace(tension=f"{size.value:.9g} N", mass=None)
    (ride,), _ = prepared_rides(conveyor.replace(route=conveyor.route.replace(take_up=unit)), (scenario,))
    size = replace(size, ride=_named(ride, "take-up", size.value))
    if given.kind != "gravity":
        return size
    line = ride.loop.line

    def mass(tension: float | None) -> float | None:
        if tension is None:
            return None
        return take_up_mass(
            tension, reeving=line.take_up.reeving, gravity=line.gravity, strands=line.take_up.strands
        )

    value = mass(size.value)
    assert value is not None  # noqa: S101 it has a tension
    return replace(size, label="mass of the take-up's weight", kind="mass", value=value, most=mass(size.most))
