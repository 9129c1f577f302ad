"""Worst loading by superposition: forces add by section, so signs of coefficients tell which sections to load.

Every force along the belt, every mass and every feeding point belongs to a section that is loaded or not. In a state
of motion a tension is then

    T = c + Σ xᵢ qᵢ + a (μ + Σ xᵢ μᵢ) + Σ ω_d F_d,    a = (ξ - 1) R/M  or  -(R + B)/(M + M_r),

with xᵢ 0 or 1, and R, M and the drives' F linear likewise; in an uncontrolled start F_d and a follow from the motors
at R and M. With a = 0 the signs of the coefficients are the answer, else the start of an ascent by whole sections.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.forces import rubber_free_forces
from conveyor.laws.tension import grip_tension
from conveyor.loop.balance import Balance, OpenLoop, close_loops, raise_first_error
from conveyor.loop.equilibrium import (
    BRAKES,
    DESIGN,
    DESIGN_START,
    FILLED,
    LEAST,
    LEAST_BRAKING,
    RUN_OUT,
    START,
)
from conveyor.loop.loop_events import loop_events
from conveyor.loop.loop_layout import LoopLayout
from conveyor.loop.run_up import is_start_uncontrolled, start_motion
from conveyor.loop.tensions import STEADY
from conveyor.loop.ties import first_maximum

Array = NDArray[np.float64]
Loading = NDArray[np.bool_]
"""Mask of loaded sections, shape (n,)."""

DRIVE_FORCE: Final = "drive force"
LEAST_FORCE: Final = "least drive force"
TENSION: Final = "largest tension"
TAKE_UP: Final = "tension of the take-up"
HOLDING_BACK: Final = "holding force of a backstop"
HOLDING_DOWN: Final = "holding force of a brake"
_ONLY_IF_POSITIVE: Final = (LEAST_FORCE, HOLDING_BACK, HOLDING_DOWN)  # only where above 0
_STARTS: Final = (START, DESIGN_START)
_CANDIDATE_COUNT = 3  # highest places of the loop by the first estimate


@dataclass(frozen=True)
class MotionCase:
    """A state of motion: friction over the computed one, drive force over the resistance; None with brakes alone.

    `hoppers` is the row of `LoopEvents.hoppers` of a state in which they are filled or empty; None in flow.
    """

    name: str
    friction: float
    over: float | None
    hoppers: int | None = None


@dataclass(frozen=True, eq=False)
class _TargetFigure:
    """A quantity in a state as a function of the loading: c + q·x + a (μ0 + μ·x) + Σ ω F + κ |F of a drive|."""

    state: MotionCase
    base: float
    more: Array
    mass: float
    more_mass: Array
    drives: Array
    grip: tuple[float, int] | None = None


class SectionLoadings:
    """Loadings of one conveyor by section, between empty and full.

    Parameters
    ----------
    full, empty : Balance
        Conveyor with bulk on every section and on none, the take-up at one setting.
    """

    def __init__(self, full: Balance, empty: Balance) -> None:
        self.line, self.full, self.empty = full.line, full, empty
        self.count = full.line.count
        self.setting = full.equilibrium.setting
        self.events = loop_events(full, empty)
        self.drive_at, self.stretch_at, self.stretch_end = self.events.drives, self.events.stretches, self.events.ends
        self.rotating = np.array([drive.reduced_mass for drive in self.line.drives])
        self.brakes = np.array(self.line.brakes)
        self.shares = np.array([drive.share for drive in self.line.drives])
        least = [balance.line.loop.least for balance in (empty, full)]
        self._resistances: dict[tuple[float, int | None], tuple[float, Array]] = {}
        self.least, self.more_least = least[0], least[1] - least[0]

    def worst(self) -> dict[str, Loading]:
        """Worst loading for each figure, by its name; no change of a single section makes it worse.

        Figures are the largest drive force, the least one if negative, the largest tension, the tension of the take-up,
        that needed for the grip of each of several drives, and the force that holds a belt at rest.
        """
        steady = self.resistance(self.line.design_friction)[1]
        least = self.resistance(self.line.least_friction)[1]
        (_, lift), (_, rubbing) = self.at_rest
        candidates = [
            steady > 0.0,
            steady < 0.0,
            least < 0.0,
            lift > rubbing,
            -lift > rubbing,
            *self.standard,
        ]
        loadings = {DRIVE_FORCE: candidates[0]}
        for state in self._states:
            for sought in self._candidates(state):
                starts = {loading.tobytes(): loading for loading in (sought.more > 0.0, candidates[0])}
                candidates += [self._ascent(sought, loading) for loading in starts.values()]
        tried = {loading.tobytes(): loading for loading in candidates}
        figures = {key: self.figures(loading) for key, loading in tried.items()}
        for name in figures[candidates[0].tobytes()]:
            known = {key: of[name] for key, of in figures.items()}
            best = first_maximum(known, known.__getitem__)
            if name not in _ONLY_IF_POSITIVE or known[best] > 0.0:
                loadings[name] = tried[best]
        return loadings

    def loaded(self, loadings: Iterable[Loading]) -> list[Balance]:
        """Balances under loadings, closed side by side."""
        return raise_first_error(close_loops(list(map(self.open_loop, loadings))))

    def open_loop(self, loading: Loading) -> OpenLoop:
        """Loop under one loading, to be closed at the setting of the take-up.

        It has the forces of the full belt on loaded sections, of the empty one elsewhere.
        """
        line, count = self.line, self.count
        on = np.append(loading, np.ones(count, bool))
        pairs = zip(line.stretches, self.empty.line.stretches, on.tolist(), strict=True)
        mixture = tuple(laden if loaded else bare for laden, bare, loaded in pairs)
        carry, back = line.strands.each
        each = replace(carry, stretches=mixture[:count]), replace(back, stretches=mixture[count:])
        mixed = replace(
            line,
            strands=replace(line.strands, each=each),
            loading=tuple(
                replace(
                    point,
                    flow=point.flow * bool(loading[point.comes_with]),
                    flow_beyond=point.flow_beyond * bool(loading[point.section]),
                )
                for point in line.loading
            ),
        )
        along = tuple(
            replace(
                laden,
                newtons=np.where(on, laden.newtons, bare.newtons),
                at_sag_limit=None
                if laden.at_sag_limit is None or bare.at_sag_limit is None
                else np.where(on, laden.at_sag_limit, bare.at_sag_limit),
            )
            for laden, bare in zip(self.full.along, self.empty.along, strict=True)
        )
        unit_main = float(rubber_free_forces(mixed.strands).unit_main.sum())
        return OpenLoop(LoopLayout(mixed), along, unit_main, self.setting)

    def figures(self, loading: Loading) -> dict[str, float]:
        """Figures of `worst` under one loading [N]; the least drive force with reversed sign."""
        asked: list[float] = []
        grips = [-math.inf] * len(self.line.drives)
        largest = -math.inf
        for state in self._occurring(loading):
            acceleration, forces = self._moved(state, loading)
            offsets = self._offsets(state, loading, acceleration, forces)
            offsets = offsets - self._anchor @ offsets
            largest = max(largest, float(offsets.max()))
            for d, drive in enumerate(self.line.drives):
                needed = grip_tension(float(forces[d]), friction=drive.friction, wrap_angle=drive.wrap_angle)
                at = self.drive_at[d]
                grips[d] = max(grips[d], needed - float(min(offsets[at], offsets[at + 1])))
            if limits_sag(state):
                least = self.least.copy()
                least[self.count :] += self.more_least[self.count :] * loading
                ends = np.minimum(offsets[self.stretch_at], offsets[self.stretch_end])
                asked.append(float((least - ends).max()))
        lift, rubbing = (base + float(more @ loading) for base, more in self.at_rest)
        named = {
            DRIVE_FORCE: self._total(self.line.design_friction, loading),
            LEAST_FORCE: -self._total(self.line.least_friction, loading),
            TENSION: self.setting + largest,
            TAKE_UP: max(*asked, *grips),
            HOLDING_BACK: max(0.0, lift - rubbing),
            HOLDING_DOWN: max(0.0, -lift - rubbing),
        }
        if len(grips) > 1:
            named |= {f"grip, {drive.name}": grip for drive, grip in zip(self.line.drives, grips, strict=True)}
        return named

    def resistance(self, friction: float, hoppers: int | None = None) -> tuple[float, Array]:
        """Resistance of the empty belt [N], and the addition of each section's bulk, shape (n,)."""
        known = self._resistances.get((friction, hoppers))
        if known is None:
            base, more = self._steps(friction, hoppers)
            known = float(base.sum()), self.events.by_section(more, self.count)
            self._resistances[friction, hoppers] = known
        return known

    def _steps(self, friction: float, hoppers: int | None = None) -> tuple[Array, Array]:
        """Resistance of the empty belt at every event, and the addition of its section's bulk [N], shape (e,)."""
        events = self.events
        base = events.certain + friction * (events.force - events.certain)
        more = events.more_certain + friction * (events.more_force - events.more_certain)
        return base, more if hoppers is None else more + friction * events.hoppers[hoppers]

    @cached_property
    def at_rest(self) -> tuple[tuple[float, Array], tuple[float, Array]]:
        """Lift and least friction at rest [N]: of the empty belt, and the addition of each section's bulk."""
        (base, more), (certain, more_certain) = (
            self.resistance(self.line.least_friction),
            self.resistance(0.0),
        )
        moving = np.zeros(self.count)
        for force in self.full.equilibrium.points:
            if force.certain and force.kind != "lift" and force.bulk is not None:
                moving[force.bulk] += force.total
        return (certain, more_certain - moving), (base - certain, more - more_certain)

    @cached_property
    def standard(self) -> list[Loading]:
        """Standard loadings: all sections, none, inclines, declines."""
        rises = np.array([section.rise for section in self.line.sections])
        return [np.ones(self.count, bool), np.zeros(self.count, bool), rises > 0.0, rises < 0.0]

    @cached_property
    def _masses(self) -> tuple[float, Array]:
        events = self.events
        return float(events.mass.sum()), events.by_section(events.more_mass, self.count)

    @cached_property
    def _states(self) -> tuple[MotionCase, ...]:
        """States of motion that may govern; the loading decides which occur."""
        factor, certain, design = self.line.start_over_steady, self.line.least_friction, self.line.design_friction
        states = [MotionCase(STEADY, 1.0, 1.0), MotionCase(START, 1.0, factor)]
        if design > 1.0:
            states += [MotionCase(DESIGN, design, 1.0), MotionCase(DESIGN_START, design, factor)]
        if certain < 1.0:
            states += [MotionCase(LEAST, certain, 1.0), MotionCase(LEAST_BRAKING, certain, factor)]
        if self.brakes.any():
            states.append(MotionCase(BRAKES, certain, None))
        if self.events.hoppers.any():
            states += [MotionCase(name, design, 1.0, k) for k, name in enumerate((FILLED, RUN_OUT))]
        return tuple(states)

    def _occurring(self, loading: Loading) -> Iterator[MotionCase]:
        """States that decide the take-up's setting under a loading, as in `settle`."""
        least = self._total(self.line.least_friction, loading)
        for state in self._states:
            if state.over is None:
                if least + float(self.brakes.sum()) > 0.0:
                    yield state
            elif state.name == DESIGN_START:
                if self._total(state.friction, loading) > 0.0:
                    yield state
            elif state.hoppers is not None:
                if self._has_hoppers(loading):
                    yield state
            elif state.name in {STEADY, START, DESIGN} or least < 0.0:
                yield state

    def _has_hoppers(self, loadings: Loading) -> NDArray[np.bool_]:
        """True where a hopper over the belt has bulk in it; of loadings in rows, shape (..., n), shape (...)."""
        fed = np.unique(self.events.section[self.events.hoppers.any(axis=0)])
        return np.asarray(loadings[..., fed].any(axis=-1))

    def _total(self, friction: float, loading: Loading, hoppers: int | None = None) -> float:
        base, more = self.resistance(friction, hoppers)
        return base + float(more @ loading)

    def _moved(self, state: MotionCase, loading: Loading) -> tuple[float, Array]:
        """Acceleration [m/s²] and force of every drive [N] in a state."""
        mass = self._masses[0] + float(self._masses[1] @ loading)
        acceleration, forces = self._motion(state, self._total(state.friction, loading, state.hoppers), mass)
        return float(acceleration), np.asarray(forces)

    def _motion(self, state: MotionCase, resistance: Array | float, mass: Array | float) -> tuple[Array, Array]:
        """Acceleration and drive forces, shape (d,) or (d, m), at one or many resistances and masses."""
        resistance, mass = np.asarray(resistance), np.asarray(mass)
        if state.over is None:
            brakes = self.brakes if state.name == BRAKES else np.zeros_like(self.brakes)
            slowing = (resistance + brakes.sum()) / (mass + self.rotating.sum())
            return -slowing, np.multiply.outer(self.rotating, slowing) - _as_column(brakes, slowing)
        acceleration = (state.over - 1.0) * resistance / mass
        forces = np.multiply.outer(self.shares * state.over, resistance)
        if state.name not in _STARTS:
            return acceleration, forces
        pulls = resistance > 0.0
        pushed, pulled = start_motion(self.full.layout.standing.pull, np.where(pulls, resistance, 1.0), mass)
        return np.where(pulls, pushed, acceleration), np.where(pulls, pulled.T, forces)

    def _offsets(self, state: MotionCase, loading: Loading, acceleration: float, forces: Array) -> Array:
        """Tension over that of the head's return strand before and behind every event [N], shape (e + 1,)."""
        events = self.events
        on = np.append(loading, False)[events.section]
        base, more = self._steps(state.friction, state.hoppers)
        steps = base + on * more
        steps += acceleration * (events.mass + on * events.more_mass)
        steps[self.drive_at] -= forces
        return np.concatenate([[0.0], np.cumsum(steps)])

    @cached_property
    def _anchor(self) -> Array:
        """Weights of the offsets whose sum the take-up fixes, shape (e + 1,)."""
        if self.line.take_up.keeps_length:
            return self._mean_weights
        weights = np.zeros(self.events.force.size + 1)
        weights[self.events.held] = 1.0
        return weights

    @cached_property
    def _mean_weights(self) -> Array:
        """Weights of the tensions at every place in the mean of the loop, shape (e + 1,)."""
        weights, ahead = np.zeros(self.events.force.size + 1), self.events.ahead
        shares = self.line.loop.length / float(self.line.loop.way[-1])
        for places, share in ((self.stretch_at, 0.5), (self.stretch_at + 1, 0.5 - ahead), (self.stretch_end, ahead)):
            np.add.at(weights, places, share * shares)
        return weights

    def _candidates(self, state: MotionCase) -> Iterator[_TargetFigure]:
        """Candidate figures of a state: grips, and the highest places by estimate."""
        for d, drive in enumerate(self.line.drives):
            grip = (grip_tension(1.0, friction=drive.friction, wrap_angle=drive.wrap_angle), d)
            for at in (self.drive_at[d], self.drive_at[d] + 1):
                yield self._sought(state, at, -1.0, grip=grip)
        tight, low = self._estimates(state)
        for at in _places_of_largest(tight):
            yield self._sought(state, at, 1.0)
        if limits_sag(state):
            for k in _places_of_largest(np.maximum(low[self.stretch_at], low[self.stretch_end])):
                for at in (self.stretch_at[k], self.stretch_end[k]):
                    yield self._sought(state, int(at), -1.0, stretch=k)

    def _estimates(self, state: MotionCase) -> tuple[Array, Array]:
        """Estimates at every place by signs, at the full belt's acceleration: highest tension and shortfall [N]."""
        loading, events, anchor = self.standard[0], self.events, self._anchor
        acceleration, forces = self._moved(state, loading)
        total, more = self.resistance(state.friction, state.hoppers)
        step = self._steps(state.friction, state.hoppers)[1]
        added = events.by_section(step + acceleration * events.more_mass, self.count)
        taken = np.zeros_like(anchor)  # share of the drives that stand before a place
        if state.over is not None and not (state.name in _STARTS and is_start_uncontrolled(self.line)):
            _, forces = self._motion(state, total, self._masses[0])
            for share, at in zip(self.shares * state.over, self.drive_at, strict=True):
                taken[at + 1 :] += share
        held = _weights_behind(anchor)[self.stretch_at[self.count :]]
        raised, whole = np.zeros_like(anchor), np.zeros_like(anchor)
        passed = np.searchsorted(self.stretch_at[self.count :], np.arange(anchor.size))
        for share in np.unique(taken):
            # the bulk of a section acts before or behind a place: sums up to it, and from it on
            relieved = (share - anchor @ taken) * more
            before, behind = (1.0 - held) * added - relieved, -held * added - relieved
            for sums, (ahead, rest) in (
                (raised, (np.maximum(before, 0.0), np.maximum(behind, 0.0))),
                (whole, (before, behind)),
            ):
                run = np.concatenate([[0.0], np.cumsum(ahead)]) + rest.sum()
                run -= np.concatenate([[0.0], np.cumsum(rest)])
                sums[taken == share] = run[passed[taken == share]]
        base = self._offsets(state, self.standard[1], acceleration, forces)
        base = base - anchor @ base
        least = np.zeros_like(base)
        least[self.stretch_at] = np.maximum(self.least, self.least + self.more_least)
        least[self.stretch_end] = np.maximum(least[self.stretch_end], least[self.stretch_at])
        return base + raised, least - base + raised - whole

    def _sought(
        self,
        state: MotionCase,
        at: int,
        sign: float,
        *,
        grip: tuple[float, int] | None = None,
        stretch: int | None = None,
    ) -> _TargetFigure:
        """Tension at a place over the take-up's, or its shortfall there with sign -1."""
        events, weights = self.events, sign * self._weights(at)
        base, more = self._steps(state.friction, state.hoppers)
        constant = float(weights @ base)
        by_section = events.by_section(weights * more, self.count)
        if stretch is not None:
            constant += float(self.least[stretch])
            if stretch >= self.count:
                by_section[stretch - self.count] += self.more_least[stretch]
        return _TargetFigure(
            state,
            constant,
            by_section,
            float(weights @ events.mass),
            events.by_section(weights * events.more_mass, self.count),
            -weights[self.drive_at],
            grip,
        )

    def _weights(self, at: int) -> Array:
        """Weight of every event in the tension at a place over the take-up's, shape (e,)."""
        return np.asarray((np.arange(self.events.force.size) < at) - _weights_behind(self._anchor))

    def _ascent(self, sought: _TargetFigure, loading: Loading) -> Loading:
        """Ascent: change all sections that gain while that gains together, then the best one, until none gains."""
        here, together = self._values(sought, loading, self._unchanged)[0], True
        while True:
            values = self._values(sought, loading)
            gains = values > here
            if together and gains.any():
                tried = loading ^ gains
                value = self._values(sought, tried, self._unchanged)[0]
                together = bool(value > here)
                if together:
                    loading, here = tried, value
                    continue
            best = int(np.argmax(values))
            if not values[best] > here:
                return loading
            loading, here = loading ^ (np.arange(self.count) == best), values[best]

    @cached_property
    def _unchanged(self) -> Loading:
        return np.zeros((1, self.count), bool)

    def _values(self, sought: _TargetFigure, loading: Loading, changes: Loading | None = None) -> Array:
        """Values of a figure with each change of a loading, by default of each single section, shape (m,)."""
        turn = None if changes is None else changes * np.where(loading, -1.0, 1.0)

        def changed(linear: tuple[float, Array]) -> Array:
            base, more = linear
            here = base + float(more @ loading)
            if turn is None:
                return here + np.where(loading, -more, more)
            return np.asarray(here + turn @ more)

        resistance = changed(self.resistance(sought.state.friction, sought.state.hoppers))
        acceleration, forces = self._motion(sought.state, resistance, changed(self._masses))
        value = changed((sought.base, sought.more)) + sought.drives @ forces
        value += acceleration * changed((sought.mass, sought.more_mass))
        if sought.grip is not None:
            factor, d = sought.grip
            value += factor * np.abs(forces[d])
        return np.asarray(value)


def _weights_behind(anchor: Array) -> Array:
    """Sum of the take-up's weights behind each event, shape (e,)."""
    return np.asarray(np.cumsum(anchor[::-1])[::-1][1:])


def _as_column(values: Array, like: Array) -> Array:
    """Values of the drives as a column where `like` is an array."""
    return values if like.ndim == 0 else values[:, None]


def limits_sag(state: MotionCase) -> bool:
    """True at constant speed, where the sag is limited."""
    return state.over == 1.0 and state.name != FILLED


def _places_of_largest(values: Array) -> list[int]:
    """Indices of the largest values."""
    return [int(k) for k in np.argsort(values)[::-1][:_CANDIDATE_COUNT]]
