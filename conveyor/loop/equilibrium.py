"""Equilibrium of loops: pulley resistances depend on the tensions, and one take-up setting serves all states."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import NoSolutionError
from conveyor.force_sums import Force
from conveyor.laws.resistance import pulley_load
from conveyor.line.line import Line
from conveyor.loop.loop_layout import LoopLayout, TakeUpSetting
from conveyor.loop.run_up import start_motion
from conveyor.loop.tensions import STEADY, BatchTensions, LoopBatch, MotionOffsets, MotionState

Array = NDArray[np.float64]

_MAX_LOOP_STEPS = 200
_LOOP_TOLERANCE = 1e-13  # relative change of the drive force; wraps add about 1e-3 of it per step
_SECANT_LIMIT = 1.0 / 3.0  # |q|/(1 + |q|) at a ratio of two steps q = -1/2: within ±1/2 they converge
_SUFFICIENT_SHARE = 1.0 - 1e-9  # of the tension needed; a setting typed with rounded digits still passes

START, BRAKING, DESIGN, DESIGN_START, LEAST, LEAST_BRAKING, BRAKES = (
    "start",
    "braking",
    "design friction",
    "start, design friction",
    "least friction",
    "braking, least friction",
    "brakes on",
)
COASTING = "drives off"
FILLED = "hopper filled"
"""Start of a belt feeder after standing, when it breaks the bulk away under filled hoppers."""
RUN_OUT = "run-out"
"""Running of a belt feeder when its hoppers are empty and the belt is still full."""


def tension_suffices(setting: float, needed: float) -> bool:
    """True if a tension is at least the one needed [N], within 1e-9."""
    return setting >= needed * (_SUFFICIENT_SHARE if needed > 0.0 else 1.0)


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """Equilibrium of one loop of a batch.

    Attributes
    ----------
    closed : BatchEquilibrium
        The batch.
    row : int
        Index of the loop in the batch.
    points : tuple of Force
        Forces at single places independent of tension.
    """

    closed: BatchEquilibrium
    row: int
    points: tuple[Force, ...]

    @property
    def layout(self) -> LoopLayout:
        """Layout of the loop."""
        return self.closed.loops.layouts[self.row]

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.layout.line

    @property
    def mass(self) -> float:
        """Moving mass of belt, bulk and rolls [kg]."""
        return float(self.closed.loops.mass[self.row])

    def resistance(self, friction: float) -> float:
        """Steady drive force at a friction over the computed one [N]; at 0 lift and other certain forces alone."""
        return float(self.closed.loops.lift[self.row] + friction * self.closed.now.rubbing[self.row])

    @property
    def force(self) -> float:
        """Drive force in steady running [N]."""
        return self.resistance(1.0)

    @property
    def design_force(self) -> float:
        """Drive force with the friction to design for [N]."""
        return self.resistance(self.line.design_friction)

    @property
    def least_force(self) -> float:
        """Drive force with the least certain friction [N]."""
        return self.resistance(self.line.least_friction)

    @property
    def setting(self) -> float:
        """Setting of the take-up [N]."""
        return float(self.closed.setting[self.row])

    @property
    def take_up(self) -> TakeUpSetting:
        """Setting of the take-up, and its side of the drives."""
        given = self.line.take_up.behind
        return TakeUpSetting(self.setting, bool(self.closed.loops.pulled[self.row]) if given is None else given)

    @property
    def needed(self) -> float:
        """Least setting that every state needs [N]."""
        return float(self.closed.needed[self.row])

    @property
    def given(self) -> bool:
        """True if the setting was given by the spec or other loads, not solved for."""
        return self.closed.given

    @cached_property
    def bends(self) -> tuple[float, ...]:
        """Wrap and bearing resistance of every pulley together [N]."""
        return tuple(self.closed.pulleys[self.row].sum(axis=-1).tolist())

    @cached_property
    def singles(self) -> tuple[Force, ...]:
        """All forces at single places."""
        pairs = zip(self.layout.bends, self.closed.pulleys[self.row].tolist(), strict=True)
        return (*self.points, *(force for bend, newtons in pairs for force in bend.forces(*newtons)))

    @cached_property
    def states(self) -> dict[str, MotionState]:
        """Tensions in every state that decides the setting."""
        return {name: self.closed.states.state(self.row, k, name) for name, k in self._names.items()}

    @cached_property
    def _names(self) -> dict[str, int]:
        """Indices of the states that occur, by name."""
        start = START if self.force >= 0.0 else BRAKING
        occurs = zip(self.closed.now.names, self.closed.now.occurs[self.row].tolist(), strict=True)
        return {start if kind == START else kind: k for k, (kind, here) in enumerate(occurs) if here}

    @property
    def steady(self) -> MotionState:
        """Steady running."""
        return self.states[STEADY]

    @property
    def unsteady(self) -> MotionState:
        """Start, or a regenerative conveyor's braking, at the start factor."""
        return self.states[START if self.force >= 0.0 else BRAKING]

    @cached_property
    def coasting(self) -> MotionState | None:
        """State with drives off and no brakes; None where the belt does not slow down."""
        occurs, states = self.closed.off
        return states.state(self.row, 0, COASTING) if occurs[self.row] else None

    @property
    def largest(self) -> float:
        """Highest tension round the loop in every state that decides the setting [N]."""
        return float(self.closed.largest[self.row])

    @cached_property
    def _governing(self) -> tuple[int, int]:
        """Indices of the state and condition that govern the least setting."""
        asked = self.closed.asked[self.row]
        k, c = divmod(int(asked.argmax()), asked.shape[-1])
        return k, c

    @property
    def governed_by(self) -> str:
        """Criterion that governs the least setting: "grip" or "sag"."""
        return "grip" if self._governing[1] < len(self.line.drives) else "sag"

    @property
    def governing(self) -> str:
        """Name of the condition that governs the take-up."""
        k, c = self._governing
        return self._condition(next(name for name, at in self._names.items() if at == k), c)

    def _condition(self, state: str, c: int) -> str:
        """Name of condition c of a state: grip of a drive, or sag where a run is the slackest."""
        drives, k = self.line.drives, self._names[state]
        if c < len(drives):
            return f"grip, {drives[c].name}, {state}"
        low, high = self.layout.boundaries[c - len(drives) :][:2]
        along = self.closed.now.moving.along[self.row, k]
        needed = self.line.loop.least - np.minimum(along[:-1], along[1:])
        stretch = self.line.loop.stretches[low + int(np.argmax(needed[low:high]))]
        return f"sag, {stretch.strand}, {stretch.section}, {state}"

    @cached_property
    def conditions(self) -> dict[str, float]:
        """Least setting of the take-up for each condition [N], by its name."""
        return {
            self._condition(state, c): setting
            for state, k in self._names.items()
            for c, setting in enumerate(self.closed.asked[self.row, k].tolist())
            if setting > -np.inf
        }

    @property
    def running(self) -> tuple[MotionState, ...]:
        """States of constant speed, in which the sag is checked."""
        return tuple(state for name, state in self.states.items() if state.acceleration == 0.0 and name != FILLED)

    @property
    def short(self) -> dict[str, float]:
        """Conditions that need more than the take-up's setting, and what they need [N]."""
        return {name: needed for name, needed in self.conditions.items() if not tension_suffices(self.setting, needed)}


@dataclass(frozen=True, eq=False)
class LoopStates:
    """States of loops at given pulley resistances; `START` is the braking of a belt that drives.

    `resistance` is the drive force at constant speed at the friction of each state, shape (b, m), `rubbing` the
    friction part of the steady one, shape (b,) [N]; `occurs` marks the states that exist, shape (b, m).
    """

    names: tuple[str, ...]
    resistance: Array
    rubbing: Array
    moving: MotionOffsets
    occurs: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class BatchEquilibrium:
    """Equilibrium of a batch of loops; conveyors on the first axis, shape (b, ...).

    Attributes
    ----------
    loops, now : LoopBatch, LoopStates
        The loops, and the states that decide the settings.
    asked : ndarray, shape (b, m, d + runs)
        Setting needed for each condition [N]; -inf for conditions that do not exist.
    setting, needed : ndarray, shape (b,)
        Setting of the take-up, and the least needed [N].
    bends : ndarray, shape (b, pulleys)
        Resistance of every pulley at equilibrium [N].
    pulleys : ndarray, shape (b, pulleys, 2)
        Wrap and bearing resistance of every pulley [N].
    flexure : ndarray, shape (b, 2n)
        Flexure by load and sag at the tensions of steady running, in loop order [N].
    given : bool
        True if the settings were given, or one for all.
    """

    loops: LoopBatch
    now: LoopStates
    asked: Array
    setting: Array
    needed: Array
    bends: Array
    pulleys: Array
    flexure: Array
    given: bool

    @cached_property
    def states(self) -> BatchTensions:
        """Tensions of all states."""
        return BatchTensions(self.now.moving, self.setting)

    @cached_property
    def largest(self) -> Array:
        """Highest tension of every state [N], shape (b,)."""
        return np.asarray(np.where(self.now.occurs, self.states.extremes[1], -np.inf).max(axis=-1))

    @cached_property
    def off(self) -> tuple[NDArray[np.bool_], BatchTensions]:
        """Mask of loops that slow down without drives and brakes, shape (b,), and that state."""
        loops, now = self.loops, self.now
        drive = now.resistance[:, 0]
        occurs, acceleration, forces = _coasting_motion(loops, drive, np.zeros_like(loops.standing.brakes))
        states = np.ones((len(drive), 1)), acceleration[:, None], forces[:, None]
        moving = loops.moving(*states, self.bends)
        return occurs, BatchTensions(moving, self.setting)


@np.errstate(over="ignore", invalid="ignore")  # of a row that grows until it is refused
def solve_equilibria(
    loops: LoopBatch, given: Array | None, *, serving: NDArray[np.bool_] | None
) -> tuple[BatchEquilibrium, dict[int, NoSolutionError]]:
    """Solve the equilibrium of loops under the forces along their belts, each independently or at one setting.

    Wraps and bearings of pulleys and the flexure by load and sag depend on the tensions of steady running.

    Parameters
    ----------
    loops : LoopBatch
        Loops of one plan under their forces.
    given : ndarray, shape (b,), or None
        Settings of the take-ups [N]; by default the least that serves every state.
    serving : ndarray of bool, shape (b,), or None
        Loops that one setting of all take-ups must serve; not with `given`.

    Returns
    -------
    tuple
        The solved loops, and the error of each row that does not converge (wraps that grow faster than the tension
        they need).

    Notes
    -----
    Where the tension comes out negative the belt bends round pulleys and loads bearings as at zero tension. Tensions
    are reported as they come out, below zero by what the take-up lacks.
    """
    kinds, whole = _StateSet(loops), np.abs(loops.along[:, :2, -1].sum(axis=-1))
    b, pulleys, sags = len(loops.layouts), len(loops.plan.bends), bool(loops.flexure.any())
    yielding, drive = np.concatenate([np.zeros((b, pulleys)), loops.given], axis=-1), np.full(b, np.inf)
    going, refused = np.ones(b, dtype=bool), dict[int, NoSolutionError]()
    last: tuple[Array, Array] | None = None
    for _ in range(_MAX_LOOP_STEPS):
        bends, flexure = yielding[:, :pulleys], yielding[:, pulleys:]
        bent = loops.with_flexure(flexure) if sags else loops
        before, now = drive, kinds.at(bent, bends)
        drive = now.resistance[:, 0]
        running = (now.moving.acceleration == 0.0) & np.array([name != FILLED for name in kinds.names])
        sagging = bent.sagging(kinds.friction, kinds.hoppers)
        asked = np.where(now.occurs[..., None], now.moving.asked(sagging, running), -np.inf)
        needed = asked.max(axis=(1, 2))
        setting = needed if given is None else given
        if serving is not None:
            setting = np.full(b, needed[serving].max())
        moves = ~(np.abs(drive - before) <= _LOOP_TOLERANCE * np.maximum(np.abs(drive), whole))
        going &= moves if serving is None else moves.any()
        wraps, bearings = _pulley_forces(bent, now.moving, setting, refused)
        if refused:
            going[list(refused)] = False
        if not going.any():
            break
        found = np.concatenate([wraps + bearings, now.moving.flexure(setting) if sags else flexure], axis=-1)
        step = (found, found - yielding)
        yielding = np.where(going[:, None], found if last is None else _secant_step(last, step), yielding)
        last = step
    else:
        refused |= {row: _divergence_error() for row in np.flatnonzero(going).tolist()}
    single, held = np.stack([wraps, bearings], axis=-1), given is not None or serving is not None
    return BatchEquilibrium(bent, now, asked, setting, needed, bends, single, flexure, held), refused


def _divergence_error() -> NoSolutionError:
    return NoSolutionError("the tensions round the belt do not settle: check pulley diameters and drive friction")


def _secant_step(last: tuple[Array, Array], step: tuple[Array, Array]) -> Array:
    """Secant step (Anderson mixing of depth one), or the plain last step where steps do not shrink.

    A step is the new resistances that depend on tension and their change.
    """
    (before, was), (here, short) = last, step
    turned = short - was
    along, whole = (turned * short).sum(axis=-1), (turned * turned).sum(axis=-1)
    shrinks = (along > -whole) & (along < _SECANT_LIMIT * whole)
    share = np.divide(along, whole, out=np.zeros(len(here)), where=shrinks)
    return np.asarray(here - share[:, None] * (here - before))


def _pulley_forces(
    loops: LoopBatch, moving: MotionOffsets, setting: Array, refused: dict[int, NoSolutionError]
) -> tuple[Array, Array]:
    """Wrap and bearing resistance of every pulley in steady running [N], shape (b, pulleys).

    Slack belt counts as belt without tension; rows that diverge are added to `refused`.
    """
    standing = loops.standing
    sides = (setting - moving.anchor[:, 0])[:, None, None] + moving.offsets[:, 0, loops.plan.sides]
    sides = np.where(loops.plan.carried[:, None], setting[:, None, None], sides)
    lost: NDArray[np.bool_] = ~np.all(np.isfinite(sides), axis=(1, 2))
    if lost.any():
        for row in np.flatnonzero(lost).tolist():
            refused.setdefault(row, _divergence_error())
        sides = np.where(lost[:, None, None], 0.0, sides)
    tight, slack = np.maximum(sides.max(axis=-1), 0.0), np.maximum(sides.min(axis=-1), 0.0)
    load = pulley_load(
        tight_tension=tight,
        slack_tension=slack,
        pulley_mass=standing.pulley_mass,
        gravity=standing.gravity[:, None],
        wrap_angle=standing.wrap_angle,
    )
    return standing.wrap + standing.slope * 0.5 * (tight + slack), standing.bearings * load


class _StateSet:
    """States in which the drives must grip: friction and motion of each."""

    def __init__(self, loops: LoopBatch) -> None:
        standing, pull = loops.standing, loops.standing.pull
        self.uncertain = standing.least_friction < 1.0
        self.raised = standing.design_friction > 1.0
        self.braked = standing.brakes.any(axis=-1)
        design = (DESIGN, DESIGN_START) if self.raised.any() else ()
        falling = (LEAST, LEAST_BRAKING) if (self.uncertain & (loops.lift < 0.0)).any() else ()
        self.fed = np.asarray(standing.pulls[:, 0].any(axis=-1))
        changed = (FILLED, RUN_OUT) if self.fed.any() else ()
        self.names = (STEADY, START, *design, *falling, *((BRAKES,) if self.braked.any() else ()), *changed)
        self.hoppers = (
            np.array([[name == FILLED, name == RUN_OUT] for name in self.names], dtype=float) if changed else None
        )
        self.friction = np.ones((len(loops.layouts), len(self.names)))
        self.friction[:, 2 + len(design) :] = standing.least_friction[:, None]
        for k, name in enumerate(self.names):
            if name in {DESIGN, DESIGN_START, FILLED, RUN_OUT}:
                self.friction[:, k] = standing.design_friction
        over = np.ones_like(self.friction)
        over[:, 1::2] = pull.factor[:, None]
        over[:, len(self.names) - len(changed) :] = 1.0
        self.shares, self.pushes = over[..., None] * pull.share[:, None], (over - 1.0) / loops.mass[:, None]

    def at(self, loops: LoopBatch, bends: Array) -> LoopStates:
        """States of the loops at given pulley resistances [N], shape (b, pulleys)."""
        standing = loops.standing
        rubbing = loops.rubbing + bends.sum(axis=-1)
        rubs = np.repeat(rubbing[:, None], len(self.names), axis=-1)
        if self.hoppers is not None:
            rubs += standing.pulls[:, 1:].sum(axis=-1) @ self.hoppers.T
        resistance = loops.lift[:, None] + self.friction * rubs
        acceleration, forces = self.pushes * resistance, self.shares * resistance[..., None]
        occurs = np.ones(resistance.shape, dtype=bool)
        for steady in (0, 2) if DESIGN in self.names else (0,):
            pulls, start = resistance[:, steady] > 0.0, steady + 1
            if pulls.any():
                pushed, pulled = start_motion(standing.pull, np.where(pulls, resistance[:, steady], 1.0), loops.mass)
                acceleration[:, start] = np.where(pulls, pushed, acceleration[:, start])
                forces[:, start] = np.where(pulls[:, None], pulled, forces[:, start])
        if DESIGN in self.names:
            occurs[:, 2] = self.raised
            occurs[:, 3] = self.raised & (resistance[:, 2] > 0.0)
        if LEAST in self.names:
            least = self.names.index(LEAST)
            occurs[:, least : least + 2] = (self.uncertain & (resistance[:, least] < 0.0))[:, None]
        if BRAKES in self.names:
            k = self.names.index(BRAKES)
            slows, acceleration[:, k], forces[:, k] = _coasting_motion(loops, resistance[:, k], standing.brakes)
            occurs[:, k] = slows & self.braked
        if self.hoppers is not None:
            occurs[:, -2:] = self.fed[:, None]
        moving = loops.moving(self.friction, acceleration, forces, bends, self.hoppers)
        return LoopStates(self.names, resistance, rubbing, moving, occurs)


def _coasting_motion(loops: LoopBatch, resistance: Array, brakes: Array) -> tuple[NDArray[np.bool_], Array, Array]:
    """With drives off and brakes on [N]: mask of belts that slow down, acceleration [m/s²], drive forces [N]."""
    own = loops.standing.pull.own
    retarding = resistance + brakes.sum(axis=-1)
    slowing = retarding / (loops.mass + own.sum(axis=-1))
    return retarding > 0.0, -slowing, own * slowing[:, None] - brakes
