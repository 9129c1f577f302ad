"""Loads of the pulleys in every state; their shafts, bearings and lagging."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from conveyor.laws.pulley import (
    hub_moment,
    lagging_pressure,
    least_shaft_diameter,
    pulley_resultant,
    shaft_safety,
    shaft_slope,
)
from conveyor.laws.resistance import pulley_load
from conveyor.laws.roll_life import ROLLER_EXPONENT, SECONDS_PER_HOUR, rating_life_hours
from conveyor.line.bend_pulleys import BendPulley
from conveyor.line.line import Line
from conveyor.loop.balance import Balance
from conveyor.loop.tensions import STEADY, MotionState
from conveyor.loop.ties import first_maximum, first_minimum


@dataclass(frozen=True)
class PulleyLoad:
    """Load of a pulley in a state: tensions before and behind it, resultant with its weight [N], shaft torque [N m].

    The difference of the tensions excludes the resistance of wrap and bearings.
    """

    state: str
    arriving: float
    leaving: float
    resultant: float
    torque: float


@dataclass(frozen=True)
class PulleyDuty:
    """A pulley and its load in every state.

    Attributes
    ----------
    pulley : BendPulley
        The pulley.
    line : Line
        The conveyor.
    tensions : tuple of (str, float, float)
        Name of each state of motion, tension before and behind the pulley [N].
    """

    pulley: BendPulley
    line: Line
    tensions: tuple[tuple[str, float, float], ...]

    @cached_property
    def loads(self) -> tuple[PulleyLoad, ...]:
        """Load in each state of motion; a slack belt adds nothing to the pulley's weight."""
        pulley, gravity = self.pulley, self.line.gravity
        ends = np.array([sides for _, *sides in self.tensions])
        tight, slack = np.maximum(ends.max(axis=1), 0.0), np.maximum(ends.min(axis=1), 0.0)
        pulls = pulley_load(
            tight_tension=tight, slack_tension=slack, pulley_mass=0.0, gravity=gravity, wrap_angle=pulley.wrap_angle
        )
        return tuple(
            PulleyLoad(
                state, arriving, leaving,
                pulley_resultant(pull, weight=pulley.mass * gravity, pull_angle=pulley.pull_angle),
                0.5 * abs(arriving - leaving) * pulley.diameter,
            )
            for (state, arriving, leaving), pull in zip(self.tensions, pulls.tolist(), strict=True)
        )  # fmt: skip

    @cached_property
    def steady(self) -> PulleyLoad:
        """Load in steady running."""
        return next(load for load in self.loads if load.state == STEADY)

    @cached_property
    def largest(self) -> PulleyLoad:
        """Load of the largest resultant."""
        return first_maximum(self.loads, lambda load: load.resultant)

    @property
    def torque(self) -> float:
        """Largest torque of the shaft [N m]."""
        return max(load.torque for load in self.loads)

    @property
    def rotation(self) -> float:
        """Rotation [1/s]."""
        return self.line.speed / (math.pi * self.pulley.diameter)

    @cached_property
    def pressure(self) -> float:
        """Largest pressure of the belt on the lagging [Pa]."""
        tight = max(max(arriving, leaving, 0.0) for _, arriving, leaving in self.tensions)
        return lagging_pressure(tight, pulley_diameter=self.pulley.diameter, belt_width=self.line.belt.width)

    def _moment(self, load: PulleyLoad) -> float | None:
        bearings, hubs = self.pulley.bearing_centres, self.pulley.hub_centres
        if bearings is None or hubs is None:
            return None
        return hub_moment(load.resultant, bearing_centres=bearings, hub_centres=hubs)

    @cached_property
    def moment(self) -> float | None:
        """Largest bending moment of the shaft at the hub [N m]; None without its distances."""
        shaft = self.pulley.bearing_centres, self.pulley.hub_centres
        return None if None in shaft else self._moment(self.largest)

    @cached_property
    def slope(self) -> float | None:
        """Largest slope of the shaft at the hub [-]; None without its distances."""
        hubs = self.pulley.hub_centres
        if self.moment is None or hubs is None:
            return None
        return shaft_slope(self.moment, hub_centres=hubs, diameter=self.pulley.hub_diameter)

    @cached_property
    def safety(self) -> tuple[float, str] | None:
        """Least safety of the shaft [-] and its state; None without distances or steel."""
        p = self.pulley
        if self.moment is None or p.shaft_steel is None:
            return None
        safeties = [
            (
                shaft_safety(
                    self._moment(load) or 0.0,
                    torque=load.torque,
                    diameter=p.hub_diameter,
                    steel=p.shaft_steel,
                    keyway=p.keyway,
                ),
                load.state,
            )
            for load in self.loads
        ]
        return first_minimum(safeties, lambda one: one[0])

    @cached_property
    def least_shaft(self) -> float | None:
        """Least diameter of the shaft in the hub [m], without steel by its slope; None without distances."""
        p = self.pulley
        if not self.moment or p.hub_centres is None:
            return None
        return max(
            least_shaft_diameter(
                moment, torque=load.torque, hub_centres=p.hub_centres, steel=p.shaft_steel, keyway=p.keyway
            )
            for load in self.loads
            if (moment := self._moment(load))
        )

    @cached_property
    def bearing_hours(self) -> float | None:
        """L10 of each bearing in steady running [h]; None without its rating, or without load."""
        rating = self.pulley.bearing_rating
        if rating is None or (load := 0.5 * self.steady.resultant) == 0.0:
            return None
        return rating_life_hours(load, dynamic_rating=rating, rotation=self.rotation, exponent=ROLLER_EXPONENT)

    @property
    def bearing_seconds(self) -> float | None:
        """L10 of each bearing in steady running [s]; None likewise."""
        return None if self.bearing_hours is None else SECONDS_PER_HOUR * self.bearing_hours


def pulley_duty(balance: Balance, states: Sequence[MotionState]) -> tuple[PulleyDuty, ...]:
    """Loads of every pulley of the spec in every state; none of assumed ones."""
    return tuple(
        PulleyDuty(pulley, balance.line, tuple((state.name, *pulley_tensions(balance, i, state)) for state in states))
        for i, pulley in enumerate(balance.line.pulleys)
        if not pulley.assumed
    )


def pulley_tensions(balance: Balance, i: int, state: MotionState) -> tuple[float, float]:
    """Tensions before and behind pulley i [N].

    Driven pulleys at one place follow in the order listed, each with the drive of its number; where a drive has several
    they share its force equally.
    """
    line, pulley = balance.line, balance.line.pulleys[i]
    if line.take_up.pulls(pulley):
        return state.held, state.held
    if not pulley.driven:
        before = state.spots[balance.layout.at[pulley.spot]]
        return before, before
    met = [k for k, other in enumerate(line.pulleys) if other.driven and other.spot == pulley.spot]
    steps = list(_tension_steps(balance, pulley, state, len(met)))
    return steps[met.index(i)], steps[met.index(i) + 1]


def _tension_steps(balance: Balance, pulley: BendPulley, state: MotionState, count: int) -> Iterator[float]:
    """Tension before the first of the driven pulleys at a place, then behind each."""
    sides = [side for drive, side in zip(balance.line.drives, state.drives, strict=True) if drive.spot == pulley.spot]
    yield sides[0].arriving
    if len(sides) == count:
        yield from (side.leaving for side in sides)
    else:
        drop = (sides[0].arriving - sides[-1].leaving) / count
        yield from (sides[0].arriving - k * drop for k in range(1, count + 1))
