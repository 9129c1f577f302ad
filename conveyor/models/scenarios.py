"""Scenarios of starting and stopping: loading, initial state, drive commands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from conveyor.models.base import Model, Name, Problem, raise_problems
from conveyor.models.cases import Loading
from conveyor.models.motor_starter import Starter
from conveyor.models.operation import EarthTemperature
from conveyor.units import Bounds, Fraction, Time, quantity, si, text

Action = Literal["start", "ramp down", "power off", "brake"]


class Event(Model):
    """What drives are told to do, and when."""

    at: Annotated[Time, Bounds(ge="0 s", le="10 h")] = quantity("0 s")
    """From the begin of the scenario."""
    do: Action
    """Start or stop as the starter does it, lose power at once, or grip with the brake; a start lets the brake go."""
    drives: Annotated[tuple[Name, ...], Field(max_length=21)] = ()
    """Names of the drives ("drive" is the first one); all of them without."""
    over: Annotated[Time, Bounds(ge="0 s", le="10 min")] = quantity("0 s")
    """In which a brake's force grows."""
    share: Annotated[Fraction, Bounds(ge="0 %", le="200 %")] = quantity(1.0, "fraction")
    """Of the brake's force that is there; 0 % of one that fails."""

    @model_validator(mode="after")
    def _of_brakes(self) -> Self:
        given = {"over": si(self.over) != 0.0, "share": si(self.share) != 1.0}
        if self.do != "brake":
            message = f'given with do "{self.do}"; it is of brakes, remove it'
            raise_problems("Event", [Problem((name,), message) for name, differs in given.items() if differs])
        return self


class Scenario(Model):
    """A start or a stop to follow through time."""

    name: Name
    """Each its own."""
    begins: Literal["at rest", "running"]
    """Held at rest as after a slow stop, or in steady running."""
    loading: Loading | Literal["worst"] = "as given"
    """Sections that bear bulk, as in cases; worst: those that make the drive force largest."""
    sections: Annotated[tuple[Name, ...], Field(max_length=20000)] = ()
    """The sections that bear bulk, for loading "sections"."""
    share: Annotated[Fraction, Bounds(gt="0 %", le="200 %")] | None = None
    """Mass flow over material.flow, for part load."""
    temperature: EarthTemperature | None = None
    """Of the belt's covers; that of ambient without."""
    friction: Annotated[Fraction, Bounds(gt="0 %", le="300 %")] = quantity(1.0, "fraction")
    """Of all resistances but lift and acceleration of bulk, over the computed ones."""
    events: Annotated[tuple[Event, ...], Field(min_length=1, max_length=100)]
    """What happens, in order of time."""
    duration: Annotated[Time, Bounds(gt="0 s", le="10 h")] | None = None
    """How long it is followed; without it until all has happened and the belt has come to rest or to speed."""
    starter: Starter | None = None
    """Of all drives here, instead of their own."""

    @model_validator(mode="after")
    def _check_consistency(self) -> Self:
        problems = []
        if self.loading == "part load" and self.share is None:
            problems.append(Problem(("share",), 'missing: loading "part load" needs its share of material.flow'))
        elif self.loading != "part load" and self.share is not None:
            problems.append(Problem(("share",), f'got {text(self.share)} with loading "{self.loading}"; remove it'))
        if (self.loading == "sections") != bool(self.sections):
            problems.append(Problem(("sections",), 'loading "sections" needs names, and names need loading "sections"'))
        raise_problems("Scenario", problems)
        return self


def scenario_problems(scenarios: Iterable[Scenario], drives: Iterable[str]) -> Iterator[Problem]:
    """Refuse duplicate names, and drives that the conveyor does not have."""
    names, known = set(), tuple(drives)
    for i, scenario in enumerate(scenarios):
        if scenario.name in names:
            yield Problem(("scenarios", i, "name"), f'got "{scenario.name}" again; give each scenario its own name')
        names.add(scenario.name)
        for j, event in enumerate(scenario.events):
            for k, name in enumerate(event.drives):
                if name not in known:
                    allowed = ", ".join(known)
                    yield Problem(("scenarios", i, "events", j, "drives", k), f'got "{name}", drives are: {allowed}')
