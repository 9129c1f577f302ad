"""The shortest ramp of a start or stop that keeps every criterion."""

from __future__ import annotations

import numpy as np

from conveyor.dynamics.answers import CRITERIA
from conveyor.dynamics.follow import Followed, prepared_rides, side_by_side
from conveyor.errors import InputError, NoSolutionError
from conveyor.models import Conveyor, Scenario, Starter

_TIMES, _ROUNDS, _CELLS = 8, 2, 80


def shortest_ramp(
    conveyor: Conveyor, scenario: Scenario, *, least: float = 5.0, most: float = 600.0
) -> tuple[float, Followed]:
    """Find the shortest ramp with which a scenario keeps every criterion, and every longer one tried does too.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    scenario : Scenario
        A start or a stop led by inverters; the shape of the ramp is that of its starter, or of the first drive's.
    least, most : float
        Times to look between [s].

    Returns
    -------
    time : float
        Of the ramp [s], to about a tenth.
    found : Followed
        The scenario with it.

    Raises
    ------
    InputError
        The starter is no inverter, or the times are not in order.
    NoSolutionError
        Not even the longest ramp keeps every criterion: the message says what fails.
    """
    if not 0.0 < least < most:
        raise InputError(f"least = {least}, most = {most}: 0 < least < most is needed")
    starter = scenario.starter or conveyor.drive.starter or Starter()
    if starter.kind != "inverter":
        raise InputError(
            f'scenario "{scenario.name}": a ramp needs an inverter, its starter is "{starter.kind}"'
        )
    best: Followed | None = None
    for _ in range(_ROUNDS):
        times = np.geomspace(least, most, _TIMES).tolist()
        tried = [_ramped(scenario, starter, time, i) for i, time in enumerate(times)]
        rides, _ = prepared_rides(conveyor, tried)
        found = side_by_side(rides, max(float(ride.loop.travel[-1]) for ride in rides) / _CELLS)
        failing = [i for i, one in enumerate(found) if _fails(one)]
        first = failing[-1] + 1 if failing else 0
        if first == len(found):
            if best is None:
                why = "; ".join(_fails(found[-1]))
                raise NoSolutionError(
                    f'scenario "{scenario.name}" fails even with a ramp of {most:.4g} s: {why}'
                )
            break
        best, most = found[first], times[first]
        if first == 0:
            break
        least = times[first - 1]
    assert best is not None  # noqa: S101 a first round that finds nothing raises
    return most, best


def _ramped(scenario: Scenario, starter: Starter, time: float, i: int) -> Scenario:
    """The scenario with a ramp of a time [s]."""
    changed = starter.replace(time=f"{time:.9g} s", stop_time=f"{time:.9g} s")
    return scenario.replace(name=f"{scenario.name} {i}", starter=changed, duration=None)


def _fails(found: Followed) -> list[str]:
    """What of it fails, in words."""
    checks = [check for criterion in CRITERIA for check in criterion(found)]
    return [check.why.text() for check in checks if check.failed and check.why is not None]
