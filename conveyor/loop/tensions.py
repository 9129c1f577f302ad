"""Tensions round belts: offsets by resistances, masses and drives, shifted to the setting of the take-up.

The tension at a place in a state of motion is T = H + o - a: o the offset over the strand that leaves the head, a the
offset of the tension that the take-up fixes (at its place, or the mean of the loop), H its setting, one for all states.
Loops of one plan are computed in one batch, b of them in m states: no result depends on the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.force_sums import Force
from conveyor.laws.resistance import mean_sag_ratio
from conveyor.loop.loop_layout import LoopConstants, LoopLayout

Array = NDArray[np.float64]

STEADY = "steady"


@dataclass(frozen=True)
class DriveTensions:
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
        Name of the state.
    force : float
        Sum of the forces of all drives and brakes on the belt [N].
    acceleration : float
        Acceleration of belt and bulk [m/s²].
    friction : float
        Friction over the computed one [-].
    drives : tuple of DriveTensions
        Every drive pulley.
    starts, ends : Array
        Tension at both ends of every stretch, in loop order [N], shape (2n,).
    leaving, arriving : float
        Tension behind and before all items at the head [N].
    held : float
        Tension at the take-up [N].
    spots : tuple of float
        Tension before every spot of the layout [N].
    largest, smallest : float
        Highest and lowest tension round the loop [N].
    early : float
        Mean tension over that of stretches on which the tension rises evenly [N], by forces on the rear of some.
    """

    name: str
    force: float
    acceleration: float
    friction: float
    drives: tuple[DriveTensions, ...]
    starts: Array
    ends: Array
    leaving: float
    arriving: float
    held: float
    spots: tuple[float, ...]
    largest: float
    smallest: float
    early: float = 0.0

    def mean(self, lengths: Array) -> float:
        """Mean tension round the loop [N], of stretches of those lengths [m], shape (2n,)."""
        return float((self.starts + self.ends) @ lengths) / (2.0 * float(lengths.sum())) + self.early

    @property
    def slack(self) -> bool:
        """True if the belt is slack anywhere."""
        return self.smallest < 0.0


class LoopBatch:
    """Loops of one plan, each under the forces of one analysis.

    Parameters
    ----------
    layouts : sequence of LoopLayout
        Layout of each loop.
    along : sequence of sequence of Force
        Forces along each belt.
    further : sequence of sequence of Force
        Forces at single places in addition to those of each layout.
    """

    def __init__(
        self,
        layouts: Sequence[LoopLayout],
        along: Sequence[Sequence[Force]],
        further: Sequence[Sequence[Force]],
    ) -> None:
        self.layouts, self.plan, count = layouts, layouts[0].plan, layouts[0].line.count
        self.standing = LoopConstants.side_by_side([layout.standing for layout in layouts])
        forces = np.roll([_force_sums(each, count) for each in along], count, axis=-1)
        forces[:, 1] += self.standing.pulls[:, 0]
        by_sag = np.roll([_flexure_by_sag(each, count) for each in along], count, axis=-1)
        self.given, self.flexure = by_sag[:, 0], by_sag[:, 1]
        """Flexure as given and at the largest sag, in loop order [N], shape (b, 2n); 0 where it is another law's."""
        self.along = np.zeros((len(layouts), 3, 2 * count + 1))
        """Running sums of the forces along the belt without and with friction [N], and of the mass [kg]."""
        np.cumsum(forces, axis=-1, out=self.along[:, :2, 1:])
        self.along[:, 2] = self.standing.mass
        self.met = self.standing.met.copy()
        """The same sums between two places of the plan, shape (b, 3, count)."""
        self.met[:, :2, self.plan.runs] = np.diff(self.along[:, :2, self.plan.boundaries])
        for met, layout, forces_there in zip(self.met, layouts, further, strict=True):
            for force in forces_there:
                if force.spot is not None:
                    met[1, self.plan.spots[layout.at[force.spot]]] += force.total
        self.lift, self.rubbing = self.met[:, 0].sum(axis=-1), self.met[:, 1].sum(axis=-1)
        self.mass = self.standing.mass[:, -1]
        relieved = (1.0 + self.standing.by_length) * (self.flexure - self.given).sum(axis=-1)
        self.pulled = self.lift + self.rubbing + relieved >= 0.0
        """True where the drives pull without the pulleys' losses, which sets the side of a slack-side take-up."""

    def with_flexure(self, flexure: Array) -> LoopBatch:
        """The loops with another flexure [N], in loop order, shape (b, 2n)."""
        made, plan = copy(self), self.plan
        made.__dict__.pop("_means", None)
        made.along, made.met = self.along.copy(), self.met.copy()
        relief = np.zeros((len(flexure), flexure.shape[1] + 1))
        np.cumsum(self.given - flexure, axis=-1, out=relief[:, 1:])
        made.along[:, 1] -= relief
        runs = relief[:, plan.boundaries]
        made.met[:, 1, plan.runs] -= runs[:, 1:] - runs[:, :-1]
        by_length = self.standing.by_length * relief[:, -1]
        made.met[:, 1, plan.landing] -= by_length
        made.rubbing = self.rubbing - relief[:, -1] - by_length
        return made

    @cached_property
    def _shares(self) -> Array:
        """Share of every run in the loop, shape (b, runs)."""
        lengths = self.standing.lengths
        runs = np.add.reduceat(lengths, self.plan.boundaries[:-1], axis=-1)
        return np.asarray(runs / lengths.sum(axis=-1)[:, None])

    @cached_property
    def _means(self) -> Array:
        """Mean of each running sum over its value where its run begins, shape (b, 3, 1)."""
        means = self._means_of(self.along)
        means[:, 1] += self.standing.early[:, :1]
        return means

    def _means_of(self, along: Array) -> Array:
        """Mean of running sums along the belt over their value where its run begins, shape (b, k, 1)."""
        lengths = self.standing.lengths[:, None]
        mean = ((along[..., :-1] + along[..., 1:]) * lengths).sum(axis=-1) / (2.0 * lengths.sum(axis=-1))
        begun = along[..., self.plan.boundaries[:-1]] * self._shares[:, None]
        return np.asarray((mean - begun.sum(axis=-1))[..., None])

    def along_in_state(self, friction: Array, acceleration: Array, hoppers: Array | None) -> Array:
        """Running sums of forces along the belt in states of motion [N], shape (b, m, 2n + 1); as in `moving`."""
        sums = _totals_in_state(self.along, friction, acceleration)
        return sums if hoppers is None else sums + friction[..., None] * (hoppers @ self._pulls)

    @cached_property
    def _pulls(self) -> Array:
        """Running sums of what hoppers change along the belt, filled and empty [N], shape (b, 2, 2n + 1)."""
        changes = self.standing.pulls[:, 1:]
        return np.concatenate([np.zeros((*changes.shape[:2], 1)), np.cumsum(changes, axis=-1)], axis=-1)

    def moving(
        self, friction: Array, acceleration: Array, forces: Array, bends: Array, hoppers: Array | None = None
    ) -> MotionOffsets:
        """Tension offsets of states with given drive forces, which balance resistances and inertia.

        Parameters
        ----------
        friction, acceleration : ndarray, shape (b, m)
            Friction over the computed one [-]; acceleration of belt and bulk [m/s²].
        forces : ndarray, shape (b, m, d)
            Forces of the drives [N].
        bends : ndarray, shape (b, pulleys)
            Resistances of the pulleys [N].
        hoppers : ndarray, shape (m, 2), optional
            1 for states in which the belt breaks away under filled hoppers, and for those with empty ones, else 0 [-];
            hoppers in flow without it.
        """
        plan = self.plan
        steps = _totals_in_state(self.met, friction, acceleration)
        if hoppers is not None:
            steps[..., plan.runs] += friction[..., None] * (hoppers @ np.diff(self._pulls[..., plan.boundaries]))
        steps[..., plan.bends] = friction[..., None] * bends[:, None]
        steps[..., plan.drives] = -forces
        offsets = np.zeros((*friction.shape, plan.count + 1))
        np.cumsum(steps, axis=-1, out=offsets[..., 1:])
        if plan.keeps_length:
            begun = offsets[..., plan.runs] * self._shares[:, None]
            anchor = _totals_in_state(self._means, friction, acceleration)[..., 0] + begun.sum(axis=-1)
            if hoppers is not None:
                changes = self._means_of(self._pulls)[..., 0] + self.standing.early[:, 1:]
                anchor = anchor + friction * (changes @ hoppers.T)
        elif plan.held is not None:
            anchor = offsets[..., plan.held]
        else:
            before, behind = plan.station
            anchor = np.where(self.pulled[:, None], offsets[..., behind], offsets[..., before])
        return MotionOffsets(self, friction, acceleration, forces, offsets, anchor, hoppers)

    def sagging(self, friction: Array, hoppers: Array | None) -> Array:
        """Tension needed for the sag of each run at its start, at constant speed [N], shape (b, m, runs)."""
        along, begins = self.along_in_state(friction, np.zeros_like(friction), hoppers), self.plan.boundaries[:-1]
        needed = self.standing.least[:, None] - np.minimum(along[..., :-1], along[..., 1:])
        return np.maximum.reduceat(needed, begins, axis=-1) + along[..., begins]


@dataclass(frozen=True, eq=False)
class MotionOffsets:
    """Tension offsets of states of motion, before the take-up's setting is known.

    `offsets` are those of every place [N], shape (b, m, count + 1), `anchor` that of the tension the take-up fixes.
    """

    loops: LoopBatch
    friction: Array
    acceleration: Array
    forces: Array
    offsets: Array
    anchor: Array
    hoppers: Array | None = None

    @cached_property
    def sides(self) -> Array:
        """Offsets before and behind every drive [N], shape (b, m, d, 2)."""
        return self.offsets[..., self.loops.plan.driven]

    def asked(self, sagging: Array, running: NDArray[np.bool_]) -> Array:
        """Settings needed for grip of every drive, and in running states for sag of every run [N], (b, m, d + runs)."""
        begun = self.offsets[..., self.loops.plan.runs]
        grip = np.abs(self.forces) * self.loops.standing.grip[:, None] - self.sides.min(axis=-1)
        sag = np.where(running[..., None], sagging - begun, -np.inf)
        return np.concatenate([grip, sag], axis=-1) + self.anchor[..., None]

    @cached_property
    def along(self) -> Array:
        """Offsets along the belt without point forces [N], shape (b, m, 2n + 1)."""
        return self.loops.along_in_state(self.friction, self.acceleration, self.hoppers)

    @cached_property
    def early(self) -> Array:
        """Mean tension over that of stretches on which the tension rises evenly [N], shape (b, m)."""
        early = self.loops.standing.early
        changes = 0.0 if self.hoppers is None else early[:, 1:] @ self.hoppers.T
        return np.asarray(self.friction * (early[:, :1] + changes))

    def flexure(self, setting: Array) -> Array:
        """Flexure in steady running with the take-ups at a setting, in loop order [N], shape (b, 2n)."""
        loops, plan, standing = self.loops, self.loops.plan, self.loops.standing
        along = loops.along[:, 0] + loops.along[:, 1]
        shift = (setting - self.anchor[:, 0])[:, None] + self.offsets[:, 0, plan.runs] - along[:, plan.boundaries[:-1]]
        shift = np.repeat(shift, plan.run_lengths, axis=-1) - standing.centrifugal
        return loops.flexure * mean_sag_ratio(along[:, :-1] + shift, along[:, 1:] + shift, limit=standing.least)


@dataclass(frozen=True, eq=False)
class BatchTensions:
    """States of motion at a setting of each take-up [N], shape (b,)."""

    moving: MotionOffsets
    setting: Array

    @cached_property
    def level(self) -> Array:
        """Tension of the strand that leaves the head [N], shape (b, m)."""
        return self.setting[:, None] - self.moving.anchor

    @cached_property
    def ends(self) -> Array:
        """Tension at both ends of every stretch, in loop order [N], shape (2, b, m, 2n)."""
        plan, along = self.moving.loops.plan, self.moving.along
        single = self.moving.offsets[..., plan.runs] - along[..., plan.boundaries[:-1]]
        shift = self.level[..., None] + np.repeat(single, plan.run_lengths, axis=-1)
        return np.stack([along[..., :-1] + shift, along[..., 1:] + shift])

    @cached_property
    def extremes(self) -> tuple[Array, Array]:
        """Lowest and highest tension round the loop [N], shape (b, m)."""
        plan, level = self.moving.loops.plan, self.level
        arriving = self.moving.offsets[..., plan.head]
        sides = self.moving.sides
        low = np.minimum(np.minimum(sides.min(axis=(-2, -1)), arriving), 0.0) + level
        high = np.maximum(np.maximum(sides.max(axis=(-2, -1)), arriving), 0.0) + level
        return np.minimum(self.ends.min(axis=(0, -1)), low), np.maximum(self.ends.max(axis=(0, -1)), high)

    def state(self, i: int, k: int, name: str) -> MotionState:
        """State k of loop i."""
        moving, level = self.moving, float(self.level[i, k])
        plan, line = moving.loops.plan, moving.loops.layouts[i].line
        forces, sides = moving.forces[i, k].tolist(), (level + moving.sides[i, k]).tolist()
        spots = (level + moving.offsets[i, k, plan.spots]).tolist()
        return MotionState(
            name=name,
            force=float(moving.forces[i, k].sum()),
            acceleration=float(moving.acceleration[i, k]),
            friction=float(moving.friction[i, k]),
            drives=tuple(
                DriveTensions(drive.name, force, *pair)
                for drive, force, pair in zip(line.drives, forces, sides, strict=True)
            ),
            starts=self.ends[0, i, k],
            ends=self.ends[1, i, k],
            leaving=level,
            arriving=level + float(moving.offsets[i, k, plan.head]),
            held=float(self.setting[i]),
            spots=tuple(spots),
            largest=float(self.extremes[1][i, k]),
            smallest=float(self.extremes[0][i, k]),
            early=float(moving.early[i, k]),
        )


def _force_sums(along: Sequence[Force], count: int) -> Array:
    """Sums of the forces along a belt of n sections without and with friction, shape (2, 2n)."""
    sums = np.zeros((2, 2 * count))
    for force in along:
        sums[0 if force.certain else 1] += force.newtons
    return sums


def _flexure_by_sag(along: Sequence[Force], count: int) -> Array:
    """Flexure of a belt as given and at the largest sag, shape (2, 2n); 0 where tension does not change it."""
    for force in along:
        if force.at_sag_limit is not None:
            return np.stack([force.newtons, force.at_sag_limit])
    return np.zeros((2, 2 * count))


def _totals_in_state(parts: Array, friction: Array, acceleration: Array) -> Array:
    """Sum of certain, friction and inertia forces in states, from shape (b, 3, n) to (b, m, n)."""
    certain, uncertain, mass = (parts[:, None, k] for k in range(3))
    return certain + friction[..., None] * uncertain + acceleration[..., None] * mass
