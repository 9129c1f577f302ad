"""Starters and scenarios in SI."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.laws.waves import INITIAL_TORQUE, MOTOR_SLIP
from conveyor.models import Conveyor, Scenario, Starter
from conveyor.units import si


@dataclass(frozen=True)
class StarterUnit:
    """A starter: times [s], torques over the rated or the largest one [-], slip [-]; None not given.

    `fill` holds times and shares of a coupling's largest torque [s, -].
    """

    kind: str
    ramp: str
    time: float | None
    stop_time: float | None
    delay: float
    initial: float
    limit: float | None
    slip: float
    assumed: tuple[str, ...]
    fill: tuple[tuple[float, float], ...] = ()

    @classmethod
    def of(cls, given: Starter) -> StarterUnit:
        """Return the SI view."""
        assumed = ["slip"] if given.slip is None else []
        fill = tuple((si(point.at), si(point.share)) for point in given.fill)
        if given.initial_torque is None and given.kind in {"soft starter", "fluid coupling"} and not fill:
            assumed.append("initial torque")
        time, stop = (None if value is None else si(value) for value in (given.time, given.stop_time))
        time = fill[-1][0] if fill else time
        return cls(
            kind=given.kind,
            ramp=given.ramp,
            time=time,
            stop_time=time if stop is None else stop,
            delay=si(given.delay),
            initial=INITIAL_TORQUE.value if given.initial_torque is None else si(given.initial_torque),
            limit=given.torque_limit,
            slip=MOTOR_SLIP.value if given.slip is None else si(given.slip),
            assumed=tuple(assumed),
            fill=fill,
        )


@dataclass(frozen=True)
class DriveEvent:
    """A command to drives, by number, at a time [s]; for brakes the ramp [s] and the final share [-]."""

    at: float
    do: str
    drives: tuple[int, ...]
    over: float
    share: float


@dataclass(frozen=True)
class ScenarioUnit:
    """A scenario: friction over the computed one [-], duration [s] or None, temperature of the covers [K] or None."""

    name: str
    running: bool
    friction: float
    temperature: float | None
    duration: float | None
    drive_events: tuple[DriveEvent, ...]
    starter: StarterUnit | None

    @classmethod
    def of(cls, scenario: Scenario, conveyor: Conveyor) -> ScenarioUnit:
        """Return the SI view."""
        names = conveyor.drive.names
        happenings = [
            DriveEvent(
                si(event.at),
                event.do,
                tuple(names.index(name) for name in event.drives) or tuple(range(len(names))),
                si(event.over),
                si(event.share),
            )
            for event in scenario.events
        ]
        return cls(
            name=scenario.name,
            running=scenario.begins == "running",
            friction=si(scenario.friction),
            temperature=None if scenario.temperature is None else si(scenario.temperature),
            duration=None if scenario.duration is None else si(scenario.duration),
            drive_events=tuple(sorted(happenings, key=lambda happening: happening.at)),
            starter=None if scenario.starter is None else StarterUnit.of(scenario.starter),
        )
