"""The wave equation of belts between both ends of a take-up, many in one batch; numbers only.

A belt is cut into cells of equal travel time: springs between masses, friction on the masses. Tensions are taken at
whole steps, speeds between them (leapfrog), so that at a step of one cell travel time a uniform belt without damping is
solved exactly, without numerical damping. The damping T = k (Δu + τ Δu̇) is taken at the mean of old and new speeds:
one tridiagonal system per step, stable at any τ. Friction is a set-valued force: that needed to keep a mass at rest, up
to its limit, so that nothing chatters where the motion reverses. The same holds for the grip of a belt on its driven
pulley, for brakes and for backstops. Distributed friction acts on every mass alone, local friction on the response of
the whole belt: it is constant while the mass there shrinks with its cell. Between the idlers the belt hangs: as its
tension falls the sag takes up belt, so that it softens and never pushes.

Source: derived (Newton, Hooke, Kelvin and Voigt, Maxwell, the shallow parabola); leapfrog, its stability (Courant,
Friedrichs, Lewy 1928) and the projection of friction are textbook numerics.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpttrf, dpttrs

from conveyor.errors import NoSolutionError

Array = NDArray[np.float64]
Integers = NDArray[np.int_]

_BLOCK = 32  # steps between two searches for extremes
_NEWTON, _NEAR = (
    60,
    1e-4,
)  # iterations for a tension at most, and the relative change after which the error is its square
_SHARE = 0.05  # of k, by which solver damping may exceed that of a cell: half of it moves no peak by 1e-4
_SIDES, _FROM = (
    np.array([1.0, -1.0])[:, None, None],
    np.array([0.0, 1.0])[:, None, None],
)  # before and behind a pulley
SPEED_POINTS = 65  # points of the motors' limits over speed


@dataclass(frozen=True, eq=False)
class Chain:
    """A batch of belts, shape (s, n + 1) for masses, (s, n) for cells; cells behind a belt's own end stay idle.

    Attributes
    ----------
    mass : ndarray
        Of belt, bulk and rolls [kg].
    stiffness : ndarray
        k = EA/Δs of a cell [N/m]; 0 of an idle one.
    retardation : float
        τ of Kelvin and Voigt [s].
    sag : ndarray
        b of a cell, which sag shortens by b/T² [m N²]: its length times (m' g a)²/24; 0 without sag.
    relaxing : tuple of float
        Stiffness over k of Maxwell's branch parallel to the spring, and its relaxation time [-, s]; a standard solid.
    weight : ndarray
        Force of gravity against the running direction [N].
    friction : ndarray, shape (3, s, n + 1)
        Force at a speed, f0 + f1 |v| + f2 v² [N], constant beyond `known`.
    sticking : ndarray
        Force up to which a mass stays at rest [N].
    end : ndarray of int, shape (s,)
        Mass right before the take-up; mass 0 is right behind it.
    nodes : ndarray of int, shape (s, d)
        Masses on driven pulleys, all of them different.
    before : ndarray, shape (6, s, d)
        Part of each of those before its pulley: mass [kg], weight, friction f0, f1, f2, and that at rest, as for the
        whole mass; the rest lies behind it.
    lumps : ndarray of int, shape (s, l)
        Masses with local friction, which does not shrink with the cell, and those next to the take-up; friction on a
        driven mass belongs to its pulley.
    rim : ndarray, shape (s, d)
        Rotating mass of each drive reduced to the belt [kg].
    grip : ndarray, shape (s, d)
        e^(μ α) - 1 of each driven pulley [-].
    backstop : ndarray of bool, shape (s, d)
        True if a pulley cannot turn backward.
    held : ndarray, shape (s,)
        Take-up tension at rest [N].
    carriage : ndarray, shape (s,)
        Its mass over the square of its strands [kg]; infinite if it is fixed.
    winch : ndarray, shape (3, s)
        Speed at which a winch takes in belt [m/s], 0 without one; tension over `held` within which it rests [-];
        run-up and stopping time [s].
    known : float
        Speed up to which friction is known [m/s].
    """

    mass: Array
    stiffness: Array
    retardation: float
    weight: Array
    friction: Array
    sticking: Array
    end: Integers
    nodes: Integers
    before: Array
    lumps: Integers
    rim: Array
    grip: Array
    backstop: NDArray[np.bool_]
    held: Array
    carriage: Array
    winch: Array
    sag: Array
    relaxing: tuple[float, float] = (0.0, 1.0)
    known: float = math.inf

    @property
    def longest_step(self) -> float:
        """Longest stable step of the leapfrog, by Gershgorin: 2/ω of the fastest pair of cells [s]."""
        stiff = (1.0 + self.relaxing[0]) * self.stiffness
        pull = 2.0 * (np.pad(stiff, ((0, 0), (1, 0))) + np.pad(stiff, ((0, 0), (0, 1))))
        return float(2.0 / np.sqrt((pull / self.mass).max()))

    def resisting(self, speed: Array) -> Array:
        """Friction of every mass at a speed [N]."""
        size = np.minimum(np.abs(speed), self.known)
        return np.asarray(self.friction[0] + size * (self.friction[1] + size * self.friction[2]))


@dataclass(frozen=True, eq=False)
class Machines:
    """Motors and brakes of the drives over time, shape (steps, s, d), and over speed.

    A motor gives the force `slope` (`reference` - v) on the belt [N], limited to `share` times its limit at the speed.

    Attributes
    ----------
    slope : ndarray, shape (s, d)
        Slope of the motor's steady characteristic [N s/m].
    reference : ndarray, shape (steps, s, d)
        Rim speed of the pulley at no load [m/s].
    share : ndarray, shape (steps, s, d)
        Share of the limit that is switched on [-]; 0 without power.
    brake : ndarray, shape (steps, s, d)
        Force of the brakes at the belt [N].
    limits : ndarray, shape (s, d, 65)
        Largest force over the speed from 0 to `top` [N].
    top : float
        Highest speed of `limits` [m/s].
    drag : ndarray, shape (s, d)
        Own drag of a drive without power once its belt slips [N].
    """

    slope: Array
    reference: Array
    share: Array
    brake: Array
    limits: Array
    top: float
    drag: Array

    @cached_property
    def even(self) -> Array | None:
        """The limits if they do not change with speed, shape (s, d)."""
        first = self.limits[..., 0]
        return first if bool(np.all(self.limits == first[..., None])) else None

    def limit(self, speed: Array) -> Array:
        """Largest force at a speed [N], shape (s, d)."""
        if self.even is not None:
            return self.even
        over = np.minimum(np.abs(speed) / self.top, 1.0) * (SPEED_POINTS - 1)
        low = np.minimum(over.astype(int), SPEED_POINTS - 2)
        s, d = np.ogrid[: low.shape[0], : low.shape[1]]
        first, second = self.limits[s, d, low], self.limits[s, d, low + 1]
        return np.asarray(first + (over - low) * (second - first))


@dataclass(frozen=True, eq=False)
class InitialState:
    """Initial state: speeds and tensions, friction, forces of the drives on the belt, rim speeds [m/s, N]."""

    speed: Array
    tension: Array
    resisting: Array
    driving: Array
    rims: Array


@dataclass(frozen=True, eq=False)
class Record:
    """Recorded motion.

    Attributes
    ----------
    step : float
        Time step [s].
    highest, lowest, highest_at, lowest_at : ndarray, shape (s, n)
        Extreme tensions in the middle of every cell, and at the driven pulley of cells ending there [N]; times [s].
    highest_speed, lowest_speed, highest_speed_at, lowest_speed_at : ndarray, shape (s, n + 1)
        Extreme speeds of every mass, initial ones included [m/s], and times [s].
    times, tensions : ndarray, shape (m,), (m, s, n)
        Samples of the tension [N].
    speeds : ndarray, shape (m, s, n + 1)
        Samples of the belt's speed [m/s].
    drives : dict of str to ndarray, shape (steps, s, d)
        At every step: "force" on the belt, "motor" force, "rim" and "belt" speeds, "arriving" and "leaving" tensions at
        the pulley, "holding" force of brake and backstop.
    take_up : dict of str to ndarray, shape (steps, s)
        Its "tension" [N] and the "belt" it has taken in [m].
    slipped, heat : ndarray, shape (s, d)
        Slip distance of the rim on the belt [m], and its heat [J].
    fastest, slowest : ndarray, shape (s, n + 1)
        Highest and lowest acceleration of every mass over a sample [m/s²].
    work : dict of str to ndarray, shape (s,)
        Energy given by the motors and its uses [J]; "missing" is the error of the balance.
    """

    step: float
    highest: Array
    lowest: Array
    highest_at: Array
    lowest_at: Array
    highest_speed: Array
    lowest_speed: Array
    highest_speed_at: Array
    lowest_speed_at: Array
    times: Array
    tensions: Array
    speeds: Array
    drives: dict[str, Array]
    take_up: dict[str, Array]
    slipped: Array
    heat: Array
    fastest: Array
    slowest: Array
    work: dict[str, Array]


@dataclass(eq=False)
class _Extremes:
    """Highest and lowest of values recorded step by step, and their steps."""

    shape: tuple[int, ...]
    block: Array = field(init=False)
    count: int = 0
    first: int = -1  # the initial state is recorded before the first step

    def __post_init__(self) -> None:
        self.block = np.empty((_BLOCK, *self.shape))
        self.high, self.low = np.full(self.shape, -np.inf), np.full(self.shape, np.inf)
        self.high_at, self.low_at = np.zeros(self.shape), np.zeros(self.shape)

    def tell(self, values: Array) -> None:
        self.block[self.count] = values
        self.count += 1
        if self.count == _BLOCK:
            self.look()

    def look(self) -> None:
        if self.count == 0:
            return
        block = self.block[: self.count]
        for extreme, best, at, better in (
            (block.argmax(axis=0), self.high, self.high_at, np.greater),
            (block.argmin(axis=0), self.low, self.low_at, np.less),
        ):
            extremes = np.take_along_axis(block, extreme[None], axis=0)[0]
            new = better(extremes, best)
            best[new] = extremes[new]
            at[new] = (self.first + extreme)[new]
        self.first += self.count
        self.count = 0

    def include_series(self, *place: int, values: Array) -> None:
        """Include a further series of one of them, from the initial state on."""
        for i, best, at, better in (
            (int(values.argmax()), self.high, self.high_at, np.greater),
            (int(values.argmin()), self.low, self.low_at, np.less),
        ):
            if better(values[i], best[place]):
                best[place], at[place] = values[i], i - 1


class _BeltLaw:
    """Tension of every cell by its elongation, u = T/k - b/T², and a relaxing branch in parallel."""

    def __init__(self, chain: Chain, step: float, tension: Array) -> None:
        self.bears = chain.stiffness > 0.0
        self.idle = not bool(self.bears.all())
        self.k, self.sag = np.where(self.bears, chain.stiffness, 1.0), chain.sag
        self.hangs = bool(chain.sag.any())
        if self.hangs:
            self.sag = np.where(self.bears, chain.sag, 1.0)
            tension = np.where(self.bears, tension, 1.0)
            if tension.min() <= 0.0:
                raise NoSolutionError("a belt that hangs between idlers bears tension only: the begin is slack")
        self.gives, self.softens = 1.0 / self.k, 2.0 * self.k * self.sag
        self.root = self.tension = tension
        self.apart = self.gives * tension - (self.sag / tension**2 if self.hangs else 0.0)
        share, time = chain.relaxing
        self.fades = math.exp(-step / time)
        self.branch_k = share * np.where(self.bears, self.k, 0.0)
        self.fed = self.branch_k * time / step * (1.0 - self.fades)
        self.branch, self.relaxes = np.zeros_like(tension), bool(self.branch_k.any())
        self._ease()

    def _ease(self) -> None:
        """Tangent stiffness of the cells over k at their tension; 1 without sag."""
        self.eased = (
            1.0 / (1.0 + self.softens / (self.root * self.root * self.root)) if self.hangs else np.ones_like(self.root)
        )

    def stretch(self, way: Array) -> Array:
        """Elongate the cells [m] and return the tension without damping [N]."""
        if self.idle:
            way = np.where(self.bears, way, 0.0)
        self.apart = self.apart + way
        if not self.hangs:
            self.root = self.k * self.apart
        else:
            for _ in range(_NEWTON):  # concave and rising: from below each step falls short of the root
                earlier = self.root
                slack = self.sag / (earlier * earlier)
                change = (self.apart + slack - self.gives * earlier) / (self.gives + 2.0 * slack / earlier)
                self.root = np.maximum(earlier + change, 0.25 * earlier)
                if float((np.abs(change) - _NEAR * earlier).max()) < 0.0:
                    break
            else:
                raise NoSolutionError("the tension of a slack belt has no answer: look for extreme inputs")
        self._ease()
        self.tension = self.root
        if self.relaxes:
            self.branch = self.fades * self.branch + self.eased * self.fed * way
            self.tension = self.root + self.branch
        if self.idle:
            self.tension = np.where(self.bears, self.tension, 0.0)
        return self.tension

    def stored(self) -> tuple[Array, Array]:
        """Energy stored in springs and sag, and in the relaxing branch, of every belt [J]."""
        own = 0.5 * self.root**2 / self.k - (2.0 * self.sag / self.root if self.hangs else 0.0)
        held = np.divide(self.branch**2, 2.0 * self.branch_k, out=np.zeros_like(own), where=self.branch_k > 0.0)
        return np.where(self.bears, own, 0.0).sum(axis=1), held.sum(axis=1)


@dataclass(frozen=True, eq=False)
class _ImpulseResponse:
    """Response of a belt to an impulse of 1 N s at each of several places.

    All speeds [m/s], shape (s, d, n + 1); impulse lacking at the take-up [N s]; speeds of the places, shape (s, d, d),
    of each by its own impulse, and of the masses before and behind it, shape (2, s, d).
    """

    columns: Array
    of_take_up: Array
    mutual: Array
    own: Array
    near: Array

    @property
    def beside(self) -> Array:
        """Share of each place's speed by its own impulse that the masses before and behind do not follow [-]."""
        return np.asarray(1.0 - self.near / self.own)

    def turns(self) -> list[list[int]]:
        """Groups of places that do not move each other, to rounding."""
        coupled = np.any(np.abs(self.mutual) > np.finfo(float).eps * self.own[:, None], axis=0)
        groups: list[list[int]] = []
        for j in range(len(coupled)):
            for group in groups:
                if not (coupled[j, group].any() or coupled[group, j].any()):
                    group.append(j)
                    break
            else:
                groups.append([j])
        return groups

    def moved(self, impulse: Array, speed: Array, lacking: Array) -> tuple[Array, Array]:
        """Speeds, and the impulse lacking at the take-up, after impulses at the places."""
        return (
            speed + np.einsum("sd,sdn->sn", impulse, self.columns),
            lacking + (self.of_take_up * impulse).sum(axis=1),
        )


def _flat_indices(places: Integers, masses: int, first: int, count: int) -> tuple[Integers, Integers, Integers]:
    """Flat indices, in `count` columns, of speeds of places by all impulses, by their own, and of their neighbours."""
    s, d = places.shape
    rows = masses * (count * np.arange(s)[:, None] + first + np.arange(d))
    near = np.stack([np.maximum(places - 1, 0), np.minimum(places + 1, masses - 1)])
    return rows[:, :, None] + places[:, None], rows + places, rows + near


class _Solver:
    """Linear system of a step: masses, damping, the take-up between both ends; and the responses of pulleys."""

    def __init__(self, chain: Chain, step: float) -> None:
        s, n = chain.stiffness.shape
        self.mass, self.end, self.rows = chain.mass, chain.end, np.arange(s)
        self.stiff = np.isinf(chain.carriage) | (chain.winch[0] > 0.0)
        self.carriage = np.where(self.stiff, 0.0, chain.carriage)
        self.damping = 0.5 * step * chain.retardation * chain.stiffness
        self.shares, self.drives = np.full((s, n), np.inf), chain.nodes.shape[1]
        self.middle, self.damps = self.shares, bool(self.damping.any())
        places = np.hstack([chain.end[:, None], chain.nodes, chain.lumps])
        units = np.zeros((places.shape[1], s, n + 1))
        units[np.arange(places.shape[1]), self.rows[:, None], places] = 1.0
        units[0, :, 0] -= 1.0
        self.units = units.reshape(len(units), -1).T
        self.answers = [
            (part, *_flat_indices(places[:, 1:][:, part], n + 1, part.start, places.shape[1] - 1))
            for part in (slice(0, self.drives), slice(self.drives, places.shape[1] - 1))
        ]

    def update_damping(self, shares: Array) -> bool:
        """Factorise the system again if shares of k have changed; return true if so.

        A share below that of the cell would make the step unstable, one above it delays the difference by a step.
        """
        if not self.damps:  # factorised once
            shares = np.zeros_like(shares)
        off = np.abs(shares - self.middle) > 0.5 * _SHARE
        if not off.any():
            return False
        changed = off.any(axis=1)
        self.shares = np.where(changed[:, None], np.minimum(shares + 0.5 * _SHARE, 1.0), self.shares)
        self.middle = self.shares - 0.5 * _SHARE
        damping = self.damping * self.shares
        diagonal, beside = self.mass.copy(), np.zeros_like(self.mass)
        diagonal[:, :-1] += damping
        diagonal[:, 1:] += damping
        beside[:, :-1] = -damping
        self.lower, self.off, info = dpttrf(diagonal.ravel(), beside.ravel()[:-1])
        if info != 0:
            raise NoSolutionError("the masses of the belt must be positive")
        solved, _ = dpttrs(self.lower, self.off, self.units)
        made = np.moveaxis(solved.T.reshape(-1, *self.mass.shape), 0, 1)
        self.pair = made[:, 0]
        own = self._apart(self.pair)
        self.kappa = np.where(self.stiff, 1.0 / own, self.carriage / (1.0 + self.carriage * own))
        columns = made[:, 1:]
        of_take_up = self.kappa[:, None] * (columns[self.rows, :, self.end] - columns[:, :, 0])
        columns = columns - self.pair[:, None] * of_take_up[:, :, None]
        self.pulleys, self.lumps = (
            _ImpulseResponse(
                columns[:, k], of_take_up[:, k], columns.take(mutual), columns.take(own), columns.take(near)
            )
            for k, mutual, own, near in self.answers
        )
        return True

    def _banded(self, right: Array) -> Array:
        solution, _ = dpttrs(self.lower, self.off, right.ravel())
        return np.asarray(solution).reshape(right.shape)

    def _apart(self, speed: Array) -> Array:
        """Speed of the belt into the take-up less that out of it."""
        return np.asarray(speed[self.rows, self.end] - speed[:, 0])

    def change(self, impulse: Array, before: Array, wanted: Array) -> tuple[Array, Array]:
        """Change of all speeds by impulses [m/s], and the impulse lacking in the take-up's tension [N s]."""
        change = self._banded(impulse)
        apart = self._apart(change)
        apart = np.where(self.stiff, apart + self._apart(before) - wanted, apart)
        lacking = self.kappa * apart
        return change - self.pair * lacking[:, None], lacking


def simulate_belts(chain: Chain, machines: Machines, start: InitialState, *, step: float, samples: int = 300) -> Record:
    """Simulate belts through time.

    Parameters
    ----------
    chain : Chain
        The belts.
    machines : Machines
        Motors and brakes; they set the number of steps.
    start : InitialState
        Initial speeds, tensions and forces.
    step : float
        Time step [s], at most `chain.longest_step`.
    samples : int
        Approximate number of samples of all tensions.

    Raises
    ------
    NoSolutionError
        The step is too long, or a figure is not finite.
    """
    if step > chain.longest_step * (1.0 + 1e-9):  # rounding of the quotient
        raise NoSolutionError(f"a step of {step:.4g} s is unstable: at most {chain.longest_step:.4g} s")
    return _Motion(chain, machines, start, step, samples).followed()


class _Motion:
    """Belts in motion: the state from step to step, and its record."""

    def __init__(self, chain: Chain, machines: Machines, start: InitialState, step: float, samples: int) -> None:
        self.chain, self.machines, self.dt = chain, machines, step
        self.steps = machines.reference.shape[0]
        self.every = max(1, self.steps // samples)
        self.solver, self.law = _Solver(chain, step), _BeltLaw(chain, step, start.tension)
        self.solver.update_damping(self.law.eased)
        self.ledger = _EnergyLedger(chain, step, start, self.law)
        self._set_up()
        self._answered()
        s, n = chain.stiffness.shape
        self.speed, self.tension = start.speed, start.tension
        self.stretching = np.diff(start.speed, axis=1)
        self.viscous = self.tau_k * self.law.eased * self.stretching
        self.resisting = start.resisting * self.loose
        self.driving, self.rims = start.driving, start.rims
        self.begun = start.rims
        self.gripping = np.ones(chain.nodes.shape, dtype=bool)
        self.rubbing = start.resisting[self.rows, self.at]
        self.on_pulleys = start.speed[self.rows, self.at]  # exactly 0 at rest, which rounding in the solver would blur
        self.lumps_rest = start.speed[self.rows, chain.lumps] == 0.0
        self.pulled, self.taken, self.winding = chain.held, np.zeros(s), np.zeros(s)
        self.extremes, self.speeds = _Extremes((s, n)), _Extremes((s, n + 1))
        names = ("force", "motor", "rim", "belt", "arriving", "leaving", "holding")
        self.drives = {name: np.zeros((self.steps, *chain.nodes.shape)) for name in names}
        self.take_up = {name: np.zeros((self.steps, s)) for name in ("tension", "belt")}
        self.frictions, self.going = np.zeros((2, self.steps, *chain.nodes.shape))
        self.fastest, self.slowest = np.zeros((s, n + 1)), np.zeros((s, n + 1))
        self.sampled = start.speed
        self.kept: list[tuple[float, Array, Array]] = []

    def _set_up(self) -> None:
        """Set constants: places, compliances, friction at rest."""
        chain, step, n = self.chain, self.dt, self.chain.stiffness.shape[1]
        self.one, self.rows = np.arange(chain.end.size), np.arange(chain.end.size)[:, None]
        self.at = at = chain.nodes
        self.loose = np.ones_like(chain.mass)
        self.loose[self.rows, at] = 0.0  # friction there belongs to the pulley
        alone = self.loose.copy()
        alone[self.rows, chain.lumps] = 0.0
        self.over_mass, self.under_mass = alone * step / chain.mass, alone * chain.mass / step
        self.still = chain.sticking * self.over_mass
        self.lumps = self.rows * (n + 1) + chain.lumps
        self.lumps_loose, self.lumps_stuck = self.loose.take(self.lumps), chain.sticking.take(self.lumps)
        self.winds = bool(np.any(chain.winch[0]))
        self.tau_k = chain.retardation * chain.stiffness
        self.flat = self.rows * (n + 1) + at
        self.turns = [_DriveGroup.of(chain, self.machines, step, k) for k in self.solver.pulleys.turns()]

    def _answered(self) -> None:
        """Update the responses of the pulleys after a factorisation."""
        self.half_k = 0.5 * self.tau_k * self.solver.shares
        self.replies = [_GroupResponse.of(self.solver, turn, self.dt) for turn in self.turns]

    def followed(self) -> Record:
        """Take every step."""
        rolling = self.chain.resisting(self.speed)
        self.beside = np.empty((2, *self.at.shape))
        for turn in self.turns:
            k, on = turn.drives, self.on_pulleys[:, turn.drives]
            self.beside[:, :, k] = (
                np.where(turn.ends, self.chain.held[:, None], self.tension.take(turn.sides))
                + turn.lying + turn.shares(on, rolling.take(turn.at)) * self.rubbing[:, k]
            )  # fmt: skip
        beside = self.beside.copy()
        self.extremes.tell(self.tension)
        self.speeds.tell(self.speed)
        for i in range(self.steps):
            self._step(i)
            self._keep(i)
        self.extremes.look()
        self.speeds.look()
        self._at_pulleys(beside)
        slip = self.dt * (self.drives["rim"] - self.drives["belt"])
        self.ledger.drives(self.begun, self.drives, self.frictions, self.going)
        extremes, speeds, kept = self.extremes, self.speeds, self.kept
        if not (np.all(np.isfinite(extremes.high)) and np.all(np.isfinite(self.speed))):
            raise NoSolutionError("the belt's motion has no finite answer: look for extreme inputs")
        return Record(
            self.dt, extremes.high, extremes.low, self._time(extremes.high_at), self._time(extremes.low_at),
            speeds.high, speeds.low, self._time(speeds.high_at), self._time(speeds.low_at),
            np.array([time for time, _, _ in kept]), np.stack([t for _, t, _ in kept]),
            np.stack([v for _, _, v in kept]), self.drives, self.take_up, np.abs(slip).sum(axis=0),
            (slip * self.drives["force"]).sum(axis=0), self.fastest,
            self.slowest, self.ledger.closed(self.speed, self.rims, self.law),
        )  # fmt: skip

    def _time(self, steps: Array) -> Array:
        """Time of a step; 0 for the initial state."""
        return np.asarray(self.dt * np.maximum(steps, 0.0))

    def _step(self, i: int) -> None:
        """Advance speeds by forces, pulleys and friction, then tensions by speeds."""
        chain = self.chain
        if self.winds:
            speed, band, run_up = chain.winch
            wanted, most = (
                speed * _winch_direction(self.pulled / chain.held - 1.0, band),
                self.dt * speed / run_up,
            )
            self.winding = np.clip(wanted, self.winding - most, self.winding + most)
        if self.solver.update_damping(self.law.eased):
            self._answered()
        change, lacking = self.solver.change(self.dt * self._acting(), self.speed, self.winding)
        new, rolling = self.speed + change, chain.resisting(self.speed)
        new, lacking, lumped = self._rubbed(new, lacking, rolling)
        if self.at.size:
            new, lacking = self._driven(i, new, lacking, rolling)
        # damping: the solver's share of τ k on half the new speeds, before single masses rub, the rest on the old
        damping = self.viscous + self.half_k * (new[:, 1:] - new[:, :-1] - self.stretching)
        free = new + self.resisting * self.over_mass
        allowed = np.where(self.speed == 0.0, self.still, rolling * self.over_mass)
        rubbed = np.minimum(np.maximum(free, -allowed), allowed)
        new = free - rubbed
        self.resisting = rubbed * self.under_mass
        self.resisting[self.rows, chain.lumps] = lumped
        self.pulled = chain.held - lacking / self.dt
        self.shown, spread = self.tension + damping, self.stretching
        self.stretching = new[:, 1:] - new[:, :-1]
        if self.law.relaxes:
            damping = damping + self.law.branch
        spread = 0.5 * (spread + self.stretching)
        self.ledger.belts(0.5 * (self.speed + new), spread, self.resisting, self.pulled, damping)
        self.speed = new
        self.tension = self.law.stretch(self.dt * self.stretching)
        self.viscous = self.tau_k * self.law.eased * self.stretching

    def _acting(self) -> Array:
        """Force on every mass, with the last friction and drive forces."""
        acting, strained = -self.chain.weight - self.resisting, self.tension + self.viscous
        acting[:, 1:] -= strained
        acting[:, :-1] += strained
        acting[:, 0] -= self.chain.held  # cancels exactly at rest
        acting[self.one, self.chain.end] += self.chain.held
        acting[self.rows, self.at] += self.driving - self.rubbing
        return acting

    def _driven(self, i: int, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array]:
        """Speeds with new pulley forces, in turn for coupled pulleys, and the impulse lacking at the take-up."""
        record, impulse = self.drives, self.dt * (self.driving - self.rubbing)
        friction, beside = self.frictions[i], np.empty_like(self.beside)
        self.going[i] = self.speed.take(self.flat)
        for turn, reply in zip(self.turns, self.replies, strict=True):
            k, on, going, rolls = (
                turn.drives,
                self.on_pulleys[:, turn.drives],
                new.take(turn.at),
                rolling.take(turn.at),
            )
            faster = new.take(turn.ahead) - new.take(turn.astern) - self.stretching.take(turn.sides)
            cells = self.tension.take(turn.sides) + self.viscous.take(turn.sides) + reply.softer * faster
            tight = (self.chain.held - lacking / self.dt)[:, None]
            moved = _solve_pulleys(
                turn, i, step=self.dt, answer=reply.own, rim=self.rims[:, k], free=going - reply.own * impulse[:, k],
                sides=np.where(turn.ends, tight, cells) + turn.lying + turn.inert * (going - on)
                - reply.yields * going,
                yields=reply.yields, friction=np.where(on == 0.0, turn.stuck, rolls), shares=turn.shares(on, rolls),
                last=(self.driving[:, k], self.beside[:, :, k]), gripped=self.gripping[:, k],
            )  # fmt: skip
            record["force"][i][:, k], record["motor"][i][:, k] = moved.force, moved.motor
            record["rim"][i][:, k], record["belt"][i][:, k] = moved.rim, moved.belt
            record["holding"][i][:, k], beside[:, :, k] = moved.holding, moved.sides
            friction[:, k], self.gripping[:, k] = moved.friction, moved.grips
            change = (moved.belt - going) / reply.own
            new = new + np.einsum("sd,sdn->sn", change, reply.columns)
            lacking = lacking + (reply.of_take_up * change).sum(axis=1)
        record["arriving"][i], record["leaving"][i] = self.beside = beside
        self.driving, self.rubbing = record["force"][i], friction
        self.rims, self.on_pulleys = record["rim"][i], record["belt"][i]
        return new, lacking

    def _rubbed(self, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array, Array]:
        """Speeds with the lumps' friction, in turn, the impulse lacking at the take-up, and the friction."""
        at, answer = self.lumps, self.solver.lumps
        if not at.size:
            return new, lacking, np.zeros(at.shape)
        earlier, speed = self.resisting.take(at), new.take(at)
        most = self.lumps_loose * np.where(self.lumps_rest, self.lumps_stuck, rolling.take(at))
        over_force, impulse = self.dt * answer.own, np.zeros_like(most)
        free, allowed = over_force * earlier, over_force * most
        for j in range(at.shape[1]):
            left = _speed_after_friction(speed[:, j] + free[:, j], allowed[:, j], allowed[:, j])
            self.lumps_rest[:, j] = left == 0.0
            impulse[:, j] = (left - speed[:, j]) / answer.own[:, j]
            speed = speed + impulse[:, j, None] * answer.mutual[:, j]
        return *answer.moved(impulse, new, lacking), earlier - impulse / self.dt

    def _keep(self, i: int) -> None:
        """Record extremes, samples and the take-up."""
        self.extremes.tell(self.shown)
        self.speeds.tell(self.speed)
        self.taken = self.taken + self.dt * (self.speed[self.one, self.chain.end] - self.speed[:, 0])
        self.take_up["tension"][i], self.take_up["belt"][i] = self.pulled, self.taken
        if i % self.every == 0:
            self.kept.append((i * self.dt, self.shown.astype(np.float32), self.speed.astype(np.float32)))
            if i:
                change = (self.speed - self.sampled) / (self.every * self.dt)
                self.fastest, self.slowest = (
                    np.maximum(change, self.fastest),
                    np.minimum(change, self.slowest),
                )
            self.sampled = self.speed

    def _at_pulleys(self, begin: Array) -> None:
        """Extremes of cells that end on driven pulleys, where sudden forces act first."""
        for side, name in enumerate(("arriving", "leaving")):
            values = np.concatenate([begin[side][None], self.drives[name]])
            for row, d in np.argwhere(self.at != (self.chain.end[:, None] if side else 0)).tolist():
                self.extremes.include_series(row, int(self.at[row, d]) - 1 + side, values=values[:, row, d])


@dataclass(frozen=True, eq=False)
class _DriveGroup:
    """Constants of drives that are solved together; shape (2, s, d) for both sides, negative behind.

    Flat indices of their places and adjacent cells; `ends` is true next to the take-up.
    """

    drives: list[int] | slice
    chain: Chain
    machines: Machines
    at: Integers
    sides: Integers
    ahead: Integers
    astern: Integers
    ends: NDArray[np.bool_]
    lying: Array
    inert: Array
    tau_k: Array
    stuck: Array
    at_rest: Array

    @classmethod
    def of(cls, chain: Chain, machines: Machines, step: float, k: list[int]) -> _DriveGroup:
        """Some drives of every belt."""
        drives: list[int] | slice = slice(None) if len(k) == chain.nodes.shape[1] else k
        (s, n), at, before = chain.stiffness.shape, chain.nodes[:, drives], chain.before[:, :, drives]
        rows = np.arange(s)[:, None]
        side = np.stack([np.maximum(at - 1, 0), np.minimum(at, n - 1)])
        astern = rows * (n + 1) + side
        weight, mass, stuck = chain.weight[rows, at], chain.mass[rows, at], chain.sticking[rows, at]
        return cls(
            drives,
            replace(chain, rim=chain.rim[:, drives], grip=chain.grip[:, drives], backstop=chain.backstop[:, drives],
                    before=before),
            replace(
                machines, slope=machines.slope[:, drives], reference=machines.reference[..., drives],
                share=machines.share[..., drives], brake=machines.brake[..., drives], limits=machines.limits[:, drives],
                drag=machines.drag[:, drives],
            ),
            at=rows * (n + 1) + at, sides=rows * n + side, ahead=astern + 1, astern=astern,
            ends=np.stack([at == 0, at == chain.end[:, None]]),
            lying=np.stack([before[1], before[1] - weight]),
            inert=np.stack([before[0], before[0] - mass]) / step,
            tau_k=chain.retardation * chain.stiffness[rows, side], stuck=stuck, at_rest=_safe_ratio(before[5], stuck),
        )  # fmt: skip

    def shares(self, on: Array, rolling: Array) -> Array:
        """Share of the friction on driven masses before the pulleys, and behind them negative [-]."""
        parabola, size = self.chain.before[2:5], np.minimum(np.abs(on), self.chain.known)
        moving = _safe_ratio(parabola[0] + size * (parabola[1] + size * parabola[2]), rolling)
        return np.asarray(np.where(on == 0.0, self.at_rest, moving) - _FROM)


def _safe_ratio(part: Array, whole: Array) -> Array:
    """Part over whole; 0 if the whole is 0."""
    return np.divide(part, whole, out=np.zeros_like(whole), where=whole > 0.0)


@dataclass(frozen=True, eq=False)
class _GroupResponse:
    """Response of the belts to a group of drives: speeds by an impulse, damping and adjacent tensions by a speed.

    `softer` is the damping at new speeds, `yields` the tension added by a speed, before, and behind negative.
    """

    own: Array
    columns: Array
    of_take_up: Array
    softer: Array
    yields: Array

    @classmethod
    def of(cls, solver: _Solver, turn: _DriveGroup, step: float) -> _GroupResponse:
        """Response of the present system."""
        k, pulleys = turn.drives, solver.pulleys
        softer = 0.5 * turn.tau_k * solver.shares.take(turn.sides)
        own, of_take_up = pulleys.own[:, k], pulleys.of_take_up[:, k]
        apart = pulleys.beside[:, :, k] * _SIDES
        tight = -of_take_up / (own * step)
        yields = turn.inert + np.where(turn.ends, tight, softer * apart)
        return cls(own, pulleys.columns[:, k], of_take_up, softer, yields)


def _winch_direction(over: Array, band: Array) -> Array:
    """1 for a winch that takes in, -1 for one that pays out, 0 within its band."""
    return np.asarray(np.where(over < -band, 1.0, np.where(over > band, -1.0, 0.0)))


@dataclass(frozen=True, eq=False)
class _PulleyState:
    """Driven pulleys after a step: forces on the belt, of motor, brake and friction, side tensions [N], speeds."""

    force: Array
    motor: Array
    holding: Array
    friction: Array
    rim: Array
    belt: Array
    sides: Array
    grips: NDArray[np.bool_]


def _speed_after_friction(free: Array, forward: Array, backward: Array) -> Array:
    """Speed left by friction, which takes up to `forward` off a free speed or adds up to `backward`."""
    return free - np.minimum(np.maximum(free, -backward), forward)


def _solve_pulleys(
    turn: _DriveGroup, i: int, *, step: float, answer: Array, rim: Array, free: Array, sides: Array, yields: Array,
    friction: Array, shares: Array, last: tuple[Array, Array], gripped: NDArray[np.bool_],
) -> _PulleyState:  # fmt: skip
    """Solve motors, brakes, rims and the belt on them together; a motor on its characteristic, or at its limit.

    `free` is the belt's speed without the pulley, `answer` its change by an impulse; `sides` are the tensions before
    and behind at zero speed there and without friction, `yields` their change by a speed, `shares` that by friction.
    They include mass and damping of the half cells up to the pulley, so that a sudden force is split by the impedances
    of both sides, however long the cells. A belt that `gripped` and now slips is taken to start slipping in the middle
    of the step: force and tensions are the mean of the `last` and the new ones. At the start of the step they would
    make the tension oscillate from cell to cell.
    """
    chain, machines = turn.chain, turn.machines
    most = machines.share[i] * machines.limit(rim)
    brake, back, grip = machines.brake[i], chain.backstop, chain.grip
    on = most > 0.0
    slope = np.where(on, machines.slope, 0.0)
    base = slope * machines.reference[i]
    for tried in range(2):
        # mean of both ends while a step resolves a rim's approach to the characteristic, else later: no oscillation
        gives = step * slope
        late = np.maximum(0.5, 1.0 - np.divide(chain.rim, gives, out=np.full_like(gives, 0.5), where=gives > 0.0))
        mass = chain.rim + late * gives
        alone = (chain.rim * rim + step * (base - (1.0 - late) * slope * rim)) / mass
        together = 1.0 / answer + mass
        stop = step * (brake + friction) / together
        common = _speed_after_friction((free / answer + mass * alone) / together, stop, np.where(back, np.inf, stop))
        against = np.sign(common) * friction
        rubbed = sides + shares * against
        force = (common - free) / (answer * step) + against
        bears = grip * np.maximum(rubbed + yields * common, 0.0)
        forward, backward = force > bears[1], force < -bears[0]
        grips = ~(forward | backward)
        belt, turned, begins = common, common, gripped & ~grips
        if not grips.all():
            pushed, slack = np.where(forward, rubbed[1], -rubbed[0]), np.where(forward, -yields[1], yields[0])
            eased = 1.0 + answer * step * grip * slack
            rub = answer * step * friction / eased
            earlier = last[0] + grip * np.where(forward, -last[1][1], last[1][0])
            driven = grip * pushed + np.where(begins, 0.5 * earlier, 0.0)
            slid = _speed_after_friction((free + answer * step * driven) / eased, rub, rub)
            limit = driven - grip * slack * slid
            limit = np.where(forward, np.maximum(limit, 0.0), np.minimum(limit, 0.0))
            slid = np.where(
                limit == 0.0,
                _speed_after_friction(free, answer * step * friction, answer * step * friction),
                slid,
            )
            force = np.where(grips, force, limit)
            stop = step * (brake + np.where(on, 0.0, machines.drag)) / mass
            spun = _speed_after_friction(alone - step * force / mass, stop, np.where(back, np.inf, stop))
            belt, turned = np.where(grips, common, slid), np.where(grips, common, spun)
        motor = base - slope * (late * turned + (1.0 - late) * rim)
        beyond = np.abs(motor) > most
        if tried or not beyond.any():
            break
        base, slope = np.where(beyond, np.copysign(most, motor), base), np.where(beyond, 0.0, slope)
    taken = force - (belt - free) / (answer * step)
    tensions = sides + yields * belt + shares * taken
    return _PulleyState(
        force, motor, mass * (alone - turned) / step - force, taken, turned, belt,
        np.where(begins, 2.0 * tensions - last[1], tensions), grips,
    )  # fmt: skip


class _EnergyLedger:
    """Energy balance, at the mean of old and new speeds."""

    def __init__(self, chain: Chain, step: float, start: InitialState, law: _BeltLaw) -> None:
        self.chain, self.dt = chain, step
        self.rows = np.arange(chain.end.size)
        names = ("motors", "lift", "friction", "damping", "brakes", "slip", "take-up")
        self.sums = {name: np.zeros(chain.end.size) for name in names}
        self.winches = chain.winch[0] > 0.0
        self.first = self._stored(start.speed, start.rims, law)

    def drives(self, begun: Array, drives: dict[str, Array], frictions: Array, going: Array) -> None:
        """Add the work of all steps at the driven pulleys, from initial rim speeds and belt speeds before each step."""
        rim = 0.5 * (drives["rim"] + np.concatenate([begun[None], drives["rim"][:-1]]))
        at = 0.5 * (drives["belt"] + going)
        for name, power in (
            ("motors", drives["motor"] * rim),
            ("friction", frictions * at),
            ("brakes", drives["holding"] * rim),
            ("slip", drives["force"] * (rim - at)),
        ):
            self.sums[name] += self.dt * power.sum(axis=(0, 2))

    def belts(self, mean: Array, spread: Array, friction: Array, tight: Array, damping: Array) -> None:
        """Add the work of a step along the belts, at mean speeds and speed differences."""
        apart = mean[self.rows, self.chain.end] - mean[:, 0]
        self.sums["lift"] += self.dt * np.einsum("sn,sn->s", self.chain.weight, mean)
        self.sums["friction"] += self.dt * np.einsum("sn,sn->s", friction, mean)
        self.sums["damping"] += self.dt * np.einsum("sn,sn->s", damping, spread)
        self.sums["take-up"] -= self.dt * np.where(self.winches, tight, self.chain.held) * apart

    def _stored(self, speed: Array, rims: Array, law: _BeltLaw) -> tuple[Array, Array, Array]:
        apart = speed[self.rows, self.chain.end] - speed[:, 0]
        mass = np.where(np.isinf(self.chain.carriage), 0.0, self.chain.carriage)
        moving = np.einsum("sn,sn->s", self.chain.mass, speed**2) + np.einsum("sd,sd->s", self.chain.rim, rims**2)
        return 0.5 * (moving + mass * apart**2), *law.stored()

    def closed(self, speed: Array, rims: Array, law: _BeltLaw) -> dict[str, Array]:
        """All terms and the error of the balance; energy stored in the relaxing branch is elastic, not damped."""
        kinetic, elastic, held = (
            last - first for last, first in zip(self._stored(speed, rims, law), self.first, strict=True)
        )
        made = dict(self.sums) | {"kinetic": kinetic, "elastic": elastic + held}
        made["damping"] = made["damping"] - held
        spent = sum((value for name, value in made.items() if name != "motors"), np.zeros_like(kinetic))
        return made | {"missing": made["motors"] - spent}
