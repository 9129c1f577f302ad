"""Tensions round the belt: offsets from resistances, masses and drives, and the level the take-up gives them.

The tension at a place in a state of motion is T = H + o - a: o the offset over the strand that leaves the head, a the
offset of what the take-up holds (tension at its place, or the mean of the loop), H the setting, one for all states.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.forces import Force
from conveyor.laws.tension import grip_tension
from conveyor.loop.frame import Frame, Sums

Array = NDArray[np.float64]

Singles = list[float]
"""Sum of the single forces at every spot in use, as the belt meets them [N]."""

STEADY = "steady"


@dataclass(frozen=True)
class DriveSide:
    """A drive pulley in a state: its force on the belt, and the tensions before and behind it [N]."""

    name: str
    force: float
    arriving: float
    leaving: float

    @property
    def slack(self) -> float:
        """The lower of both [N]."""
        return min(self.arriving, self.leaving)

    @property
    def tight(self) -> float:
        """The higher of both [N]."""
        return max(self.arriving, self.leaving)


@dataclass(frozen=True, eq=False)
class MotionState:
    """A state of motion with the tensions in it.

    Attributes
    ----------
    name : str
        What moves how.
    force : float
        Sum of the forces of all drives and brakes on the belt [N].
    acceleration : float
        Of belt and bulk [m/s²].
    friction : float
        Friction over the computed one [-].
    drives : tuple of DriveSide
        Every drive pulley.
    starts, ends : Array
        Tension at both ends of every stretch, in loop order [N], shape (2n,).
    leaving, arriving : float
        At the head, behind and before all that stands there [N].
    held : float
        Tension at the take-up [N].
    spots : tuple of float
        Tension before what stands at every spot of the frame [N].
    """

    name: str
    force: float
    acceleration: float
    friction: float
    drives: tuple[DriveSide, ...]
    starts: Array
    ends: Array
    leaving: float
    arriving: float
    held: float
    spots: tuple[float, ...]

    @property
    def largest(self) -> float:
        """Highest tension round the loop [N]."""
        sides = [drive.tight for drive in self.drives]
        return max(float(self.starts.max()), float(self.ends.max()), self.leaving, self.arriving, *sides)

    def mean(self, lengths: Array) -> float:
        """Mean tension round the loop [N], of stretches of those lengths [m], shape (2n,)."""
        return float((self.starts + self.ends) @ lengths) / (2.0 * float(lengths.sum()))

    @property
    def slack(self) -> bool:
        """Whether the belt is slack anywhere."""
        return self.smallest < 0.0

    @property
    def smallest(self) -> float:
        """Lowest tension round the loop [N]."""
        sides = [drive.slack for drive in self.drives]
        return min(float(self.starts.min()), float(self.ends.min()), self.leaving, self.arriving, *sides)


@dataclass(frozen=True)
class Condition:
    """What asks for tension ("grip" or "sag"), and the setting H of the take-up it needs [N]."""

    kind: str
    where: tuple[str, str | int]
    """State, and drive or run of stretches."""
    setting: float


@dataclass(frozen=True)
class Motion:
    """A state of motion before the level of its tensions is known: offsets round the loop [N].

    `sagging` are the settings that the sag of each run of stretches asks for; None where it may sag.
    """

    name: str
    force: float
    acceleration: float
    friction: float
    before: tuple[float, ...]
    """At each spot, before what stands there."""
    arriving: float
    """At the head, before all that stands there."""
    drives: tuple[tuple[float, float, float], ...]
    """Force, offset before, offset behind of every drive."""
    shifts: tuple[float, ...]
    """Offset of every run over the running sum of forces."""
    anchor: float
    sagging: tuple[float, ...] | None = None


class Loop:
    """The loop of one conveyor under the forces of one analysis.

    Parameters
    ----------
    frame : Frame
        What stands where.
    along : iterable of Force
        Forces along the belt.
    further : iterable of Force
        Forces at single places beside those of the frame.
    """

    def __init__(self, frame: Frame, along: Iterable[Force], further: Iterable[Force] = ()) -> None:
        self.frame, self.line = frame, frame.line
        self.points = (*frame.points, *further)
        total, lift = np.zeros(2 * self.line.count), np.zeros(2 * self.line.count)
        for force in along:
            total += force.newtons
            if force.certain:
                lift += force.newtons
        half = self.line.count
        self.totals = Sums(np.roll(total, half), self.line, frame.boundaries)
        self.lifts = Sums(np.roll(lift, half), self.line, frame.boundaries)
        self.masses = frame.masses
        self._points = [
            (frame.at[force.spot], force.total, force.certain)
            for force in self.points
            if force.spot is not None
        ]
        self._bends = [frame.at[bend.pulley.spot] for bend in frame.bends]
        self._sagging: dict[float, tuple[float, ...]] = {}

    def along(self, friction: float, acceleration: float) -> Array:
        """Running sum of the forces along the belt in a state [N], shape (2n + 1,)."""
        totals, lifts = self.totals.along, self.lifts.along
        friction_only = totals if friction == 1.0 else lifts + friction * (totals - lifts)
        return friction_only if acceleration == 0.0 else friction_only + acceleration * self.masses.along

    def sagging(self, friction: float) -> tuple[float, ...]:
        """Settings that the sag of each run asks for over its shift, in steady running [N]."""
        known = self._sagging.get(friction)
        if known is None:
            along = self.along(friction, 0.0)
            needed = self.line.loop.least - np.minimum(along[:-1], along[1:])
            known = tuple(np.maximum.reduceat(needed, self.frame.boundaries[:-1]).tolist())
            self._sagging[friction] = known
        return known

    def singles(self, bends: Sequence[float], friction: float = 1.0) -> Singles:
        """Sum of the single forces at every spot [N]."""
        newtons = [0.0] * len(self.frame.stops)
        for j, force, certain in self._points:
            newtons[j] += force if certain else friction * force
        for j, force in zip(self._bends, bends, strict=True):
            newtons[j] += friction * force
        return newtons

    def resistance(self, singles: Singles, friction: float = 1.0) -> float:
        """What the drives have to give in steady running, lift and all [N]; `singles` at the same friction."""
        lift = self.lifts.whole
        return math.fsum((lift, friction * (self.totals.whole - lift), *singles))

    def motion(
        self,
        name: str,
        forces: Sequence[float],
        singles: Singles,
        *,
        driving: bool,
        acceleration: float = 0.0,
        friction: float = 1.0,
        may_sag: bool = False,
    ) -> Motion:
        """A state in which every drive gives its force [N]; they and the masses balance the resistances.

        `driving` says whether the drives pull in steady running: a take-up on their slack side stands there always.
        """
        sides: list[tuple[float, float, float]] = [(0.0, 0.0, 0.0)] * len(forces)
        along = self._at(friction, acceleration)
        ins, outs, shifts = [], [], [0.0] * len(along)
        level, passed = 0.0, 0.0
        for k, single, drives in zip(self.frame.stops, singles, self.frame.drives, strict=True):
            level += along[k] - passed
            passed = along[k]
            ins.append(level)
            level += single
            for i in drives:
                sides[i] = (forces[i], level, level - forces[i])
                level -= forces[i]
            outs.append(level)
            shifts[k] = level - passed
        station = self.frame.station
        slack_side = sides[station[-1]][2] if driving else sides[station[0]][1]
        anchor = self._anchor(slack_side, outs, shifts, friction, acceleration)
        return Motion(
            name, math.fsum(forces), acceleration, friction, tuple(ins), ins[self.frame.head], tuple(sides),
            tuple(shifts), anchor, None if may_sag else self.sagging(friction),
        )  # fmt: skip

    def _at(self, friction: float, acceleration: float) -> list[float]:
        """Running sum of the forces along the belt at the boundaries [N]."""
        at = self.totals.at
        if friction != 1.0:
            at = [lift + friction * (total - lift) for total, lift in zip(at, self.lifts.at, strict=True)]
        if acceleration != 0.0:
            at = [force + acceleration * mass for force, mass in zip(at, self.masses.at, strict=True)]
        return at

    def at_bends(self, steady: Motion, setting: float) -> list[tuple[float, float]]:
        """Tensions on both sides of every pulley in steady running [N], of a driven one those of its drives."""
        level, pairs = setting - steady.anchor, []
        for j in self._bends:
            sides = [offset for i in self.frame.drives[j] for offset in steady.drives[i][1:]] or [
                steady.before[j]
            ]
            pairs.append((level + max(sides), level + min(sides)))
        return pairs

    def _anchor(
        self,
        slack_side: float,
        outs: Sequence[float],
        shifts: Sequence[float],
        friction: float,
        acceleration: float,
    ) -> float:
        """Offset of what the take-up holds [N]."""
        if self.line.take_up.keeps_length:
            totals, lifts = self.totals.mean, self.lifts.mean
            steady = lifts + friction * (totals - lifts) + acceleration * self.masses.mean
            return steady + math.fsum(
                s * share for s, share in zip(shifts[:-1], self.frame.run_shares, strict=True)
            )
        if self.frame.anchor is not None:
            return outs[self.frame.anchor]
        return slack_side

    def conditions(self, motion: Motion) -> Iterator[Condition]:
        """What a state asks of the take-up's setting: every drive grips, no stretch sags too much."""
        for drive, (force, arriving, leaving) in zip(self.line.drives, motion.drives, strict=True):
            needed = grip_tension(force, friction=drive.friction, wrap_angle=drive.wrap_angle)
            yield Condition(
                "grip", (motion.name, drive.name), needed - min(arriving, leaving) + motion.anchor
            )
        if motion.sagging is not None:
            for k, needed in enumerate(motion.sagging):
                yield Condition("sag", (motion.name, k), needed - motion.shifts[k] + motion.anchor)

    def state(self, motion: Motion, setting: float) -> MotionState:
        """The tensions of a state at a setting of the take-up."""
        level = setting - motion.anchor
        along = self.along(motion.friction, motion.acceleration)
        shifts = level + np.repeat(motion.shifts[:-1], self.frame.runs)
        return MotionState(
            name=motion.name,
            force=motion.force,
            acceleration=motion.acceleration,
            friction=motion.friction,
            drives=tuple(
                DriveSide(drive.name, force, level + arriving, level + leaving)
                for drive, (force, arriving, leaving) in zip(self.line.drives, motion.drives, strict=True)
            ),
            starts=along[:-1] + shifts,
            ends=along[1:] + shifts,
            leaving=level,
            arriving=level + motion.arriving,
            held=setting,
            spots=tuple(level + before for before in motion.before),
        )

    def slackest(self, motion: Motion, run: int) -> int:
        """Stretch of a run whose sag asks for most, as an index in loop order."""
        low, high = self.frame.boundaries[run : run + 2]
        along = self.along(motion.friction, motion.acceleration)
        needed = self.line.loop.least - np.minimum(along[:-1], along[1:])
        return low + int(np.argmax(needed[low:high]))
