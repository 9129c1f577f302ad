"""Settles the loop: wraps and pulley bearings depend on the tensions they add to, and one setting serves all states."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from conveyor.errors import NoSolutionError
from conveyor.forces import Force
from conveyor.loop.run_up import started
from conveyor.loop.tensions import STEADY, Condition, Loop, Motion, MotionState, Singles

_LOOP_STEPS = 200
_LOOP_CLOSED = 1e-13  # relative change of the drive force; wraps add about 1e-3 of it per step
_EXTRAPOLATED = 3  # steps that show a ratio
_SHRINKS = 0.5  # ratio below which the steps are a geometric row
_HELD = 1.0 - 1e-9  # of what is needed; a setting typed to the computed figure is not short of it

Bends = tuple[float, ...]
"""Wrap and bearings of every pulley together [N]."""

START, BRAKING, LEAST, LEAST_BRAKING, BRAKES = (
    "start",
    "braking",
    "least friction",
    "braking, least friction",
    "brakes on",
)


def holds(setting: float, needed: float) -> bool:
    """Whether a setting of the take-up is as much as is needed [N]; typed digits apart."""
    return setting >= needed * (_HELD if needed > 0.0 else 1.0)


@dataclass(frozen=True, eq=False)
class Settled:
    """The loop at rest with itself.

    Attributes
    ----------
    loop : Loop
        What was settled.
    bends : tuple of float
        Wrap and bearings of every pulley together [N].
    singles : tuple of Force
        Every force at a single place.
    force, least_force : float
        Drive force in steady running, as computed and with the least certain friction [N].
    motions : tuple of Motion
        The states that decide the take-up's setting.
    setting, needed : float
        Tension the take-up holds, and the least it should [N].
    governed_by : Condition
        What asks for the least setting.
    given : bool
        Whether the setting was given, by the spec or by other loads of the conveyor, and not looked for.
    """

    loop: Loop
    bends: Bends
    singles: tuple[Force, ...]
    force: float
    least_force: float
    motions: tuple[Motion, ...]
    setting: float
    needed: float
    governed_by: Condition
    given: bool

    @cached_property
    def states(self) -> dict[str, MotionState]:
        """Tensions in every state that decides the setting."""
        return {motion.name: self.loop.state(motion, self.setting) for motion in self.motions}

    @property
    def steady(self) -> MotionState:
        """Steady running."""
        return self.states[STEADY]

    @property
    def unsteady(self) -> MotionState:
        """Start, or a regenerative conveyor's braking, at the start factor."""
        return self.states[START if self.force >= 0.0 else BRAKING]

    def condition_name(self, condition: Condition) -> str:
        """Write a condition for people."""
        state, where = condition.where
        if isinstance(where, str):
            return f"grip, {where}, {state}"
        motion = next(motion for motion in self.motions if motion.name == state)
        stretch = self.loop.line.loop.stretches[self.loop.slackest(motion, where)]
        return f"sag, {stretch.strand}, {stretch.section}, {state}"

    @property
    def governing(self) -> str:
        """Name of the condition that governs the take-up."""
        return self.condition_name(self.governed_by)

    @cached_property
    def conditions(self) -> dict[str, float]:
        """Setting of the take-up that each condition asks for [N], by its name."""
        return {
            self.condition_name(condition): condition.setting
            for motion in self.motions
            for condition in self.loop.conditions(motion)
        }

    @property
    def short(self) -> dict[str, float]:
        """Of these, the ones that the take-up's setting falls short of [N]."""
        return {name: needed for name, needed in self.conditions.items() if not holds(self.setting, needed)}


def settle(loop: Loop, setting: float | None = None) -> Settled:
    """Close the loop of tensions around the forces along the belt.

    Parameters
    ----------
    loop : Loop
        The forces along the belt.
    setting : float, optional
        Of the take-up [N]; without it that of the spec, else the least that every state asks for.

    Raises
    ------
    NoSolutionError
        The tensions do not settle (wraps that grow faster than the tension they need), or the belt is slack at a
        pulley.
    """
    line, frame_bends = loop.line, loop.frame.bends
    given = line.take_up.tension if setting is None else setting
    history: list[Bends] = [(0.0,) * len(frame_bends)]
    drive = math.nan
    for _ in range(_LOOP_STEPS):
        bends = history[-1]
        singles = loop.singles(bends)
        before, drive = drive, loop.resistance(singles)
        motions = _motions(loop, bends, singles, drive)
        governing = max(
            (condition for motion in motions for condition in loop.conditions(motion)),
            key=lambda c: c.setting,
        )
        held = governing.setting if given is None else given
        if abs(drive - before) <= _LOOP_CLOSED * max(abs(drive), abs(loop.totals.whole)):
            break
        sides = loop.at_bends(motions[0], held)
        newtons = tuple(
            math.fsum(bend.newtons(*side, line.gravity))
            for bend, side in zip(frame_bends, sides, strict=True)
        )
        history.append(newtons)
        if len(history) == _EXTRAPOLATED:
            history = [_extrapolated(*history)]
    else:
        raise NoSolutionError(
            "the tensions round the belt do not settle: check pulley diameters and drive friction"
        )
    sides = loop.at_bends(motions[0], held)
    return Settled(
        loop=loop,
        bends=bends,
        singles=(
            *loop.points,
            *(
                force
                for bend, side in zip(frame_bends, sides, strict=True)
                for force in bend.forces(*side, line.gravity)
            ),
        ),
        force=drive,
        least_force=loop.resistance(loop.singles(bends, line.least_friction), line.least_friction),
        motions=motions,
        setting=held,
        needed=governing.setting,
        governed_by=governing,
        given=given is not None,
    )


def _extrapolated(first: Bends, second: Bends, third: Bends) -> Bends:
    """Where three steps lead to (Aitken); the last of them where they do not shrink."""
    further = []
    for a, b, c in zip(first, second, third, strict=True):
        ratio = (c - b) / (b - a) if b != a else 0.0
        further.append(c + (c - b) * ratio / (1.0 - ratio) if abs(ratio) < _SHRINKS else c)
    return tuple(further)


def _motions(loop: Loop, bends: Bends, singles: Singles, drive: float) -> tuple[Motion, ...]:
    """Steady running and every state that the grip of the drives has to hold in."""
    line, mass = loop.line, loop.masses.whole
    factor = line.start_over_steady

    def shared(name: str, force: float, friction: float, over: float) -> Motion:
        forces = [drive.share * over * force for drive in line.drives]
        push = (over - 1.0) * force / mass
        here = singles if friction == 1.0 else loop.singles(bends, friction)
        return loop.motion(
            name,
            forces,
            here,
            driving=drive >= 0.0,
            acceleration=push,
            friction=friction,
            may_sag=over != 1.0,
        )

    states = [shared(STEADY, drive, 1.0, 1.0)]
    if drive > 0.0:
        pushed, per_drive = started(line, np.asarray(drive), np.asarray(mass))
        forces = per_drive.tolist()
        sags = math.fsum(forces) / drive != 1.0
        states.append(
            loop.motion(START, forces, singles, driving=True, acceleration=float(pushed), may_sag=sags)
        )
    else:
        states.append(shared(START if drive >= 0.0 else BRAKING, drive, 1.0, factor))
    certain = line.least_friction
    least = loop.resistance(loop.singles(bends, certain), certain) if loop.lifts.whole < 0.0 else drive
    if least < 0.0 and certain < 1.0:
        states += [shared(LEAST, least, certain, 1.0), shared(LEAST_BRAKING, least, certain, factor)]
    brakes = braked(loop, bends, certain)
    return tuple(states if brakes is None else [*states, brakes])


def braked(loop: Loop, bends: Bends, friction: float) -> Motion | None:
    """All brakes on, drives off; None without brakes, or where they do not stop the belt."""
    brakes = loop.line.brakes
    return coasting(loop, bends, friction, brakes, BRAKES) if any(brakes) else None


def coasting(loop: Loop, bends: Bends, friction: float, brakes: Sequence[float], name: str) -> Motion | None:
    """Drives off, brakes of given forces on [N]; None where the belt does not slow down."""
    rotating = [drive.reduced_mass for drive in loop.line.drives]
    singles = loop.singles(bends, friction)
    retarding = loop.resistance(singles, friction) + math.fsum(brakes)
    if retarding <= 0.0:
        return None
    slowing = retarding / (loop.masses.whole + math.fsum(rotating))
    forces = [mass * slowing - brake for mass, brake in zip(rotating, brakes, strict=True)]
    driving = loop.resistance(loop.singles(bends)) >= 0.0
    return loop.motion(
        name, forces, singles, driving=driving, acceleration=-slowing, friction=friction, may_sag=True
    )
