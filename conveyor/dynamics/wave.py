"""The wave equation of belts between two ends of a take-up, many side by side; numbers only.

A belt is cut into cells of equal travel time: springs between masses, friction on the masses. Tensions stand at whole
steps, speeds between them (leapfrog), so at a step of one travel time of a cell an even belt without damping is solved
exactly, and nothing is damped that the belt does not damp. The damping T = k (Δu + τ Δu̇) is taken at the mean of old
and new speeds: one tridiagonal system a step, stable at any τ. Friction is a set-valued force: what a mass would need
to stand still, limited to what there is; so nothing chatters where the motion turns. The same holds for the grip of a
belt on its driven pulley, for brakes and for backstops. What lies along the belt is taken on every mass alone; what
stands at one place on the answer of the whole belt: it stays as it is while the mass there gets as small as its cell.
Between the idlers the belt hangs: as its tension falls the sag takes in belt, so that it softens and never pushes.

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

_BLOCK = 32  # steps between two looks for extremes
_NEWTON, _NEAR = (
    60,
    1e-4,
)  # steps for a tension at most, and a relative one after which the rest is its square
_SHARE = 0.05  # of k by which the damping of the solver may be above that of a cell: half of it moves no peak by 1e-4
SPEED_POINTS = 65  # points of the motors' limits over speed


@dataclass(frozen=True, eq=False)
class Chain:
    """Belts side by side, shape (s, n + 1) a mass, (s, n) a cell; cells behind a belt's own end stay idle.

    Attributes
    ----------
    mass : ndarray
        Of belt, bulk and rolls [kg].
    stiffness : ndarray
        k = EA/Δs of a cell [N/m]; 0 of an idle one.
    retardation : float
        τ of Kelvin and Voigt [s].
    sag : ndarray
        b of a cell, which sag shortens by b/T² [m N²]: its length times (m' g a)²/24; 0 where nothing hangs.
    relaxing : tuple of float
        Stiffness over k of Maxwell's branch beside the spring, and its relaxation time [-, s]; a standard solid.
    weight : ndarray
        Force of gravity against the running direction [N].
    friction : ndarray, shape (3, s, n + 1)
        Force at a speed, f0 + f1 |v| + f2 v² [N], beyond `known` as there.
    sticking : ndarray
        Force up to which a mass at rest stays there [N].
    end : ndarray of int, shape (s,)
        Mass right before the take-up; mass 0 is right behind it.
    nodes : ndarray of int, shape (s, d)
        Masses on driven pulleys, all of them different.
    before : ndarray, shape (6, s, d)
        Of each of those what lies before its pulley: mass [kg], weight, friction f0, f1, f2, and that at rest, as those
        of the whole mass; the rest lies behind it.
    lumps : ndarray of int, shape (s, l)
        Masses on which friction stands that does not get less with the cell, and those beside the take-up; a driven
        one has its friction with its pulley.
    rim : ndarray, shape (s, d)
        Rotating mass of each drive reduced to the belt [kg].
    grip : ndarray, shape (s, d)
        e^(μ α) - 1 of each driven pulley [-].
    backstop : ndarray of bool, shape (s, d)
        Whether a pulley cannot turn backward.
    held : ndarray, shape (s,)
        Tension that the take-up gives at rest [N].
    carriage : ndarray, shape (s,)
        Its mass over the square of its strands [kg]; infinite where it is fixed.
    winch : ndarray, shape (3, s)
        Speed at which a winch takes in belt [m/s], 0 without one; tension over `held` within which it rests [-]; time
        in which it comes to its speed and to rest [s].
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
        """Step up to which the leapfrog is stable, by Gershgorin: 2/ω of the fastest pair of cells [s]."""
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
        Of the line on which a motor runs steadily [N s/m].
    reference : ndarray, shape (steps, s, d)
        Speed of the pulley's rim at no load [m/s].
    share : ndarray, shape (steps, s, d)
        Of the limit that is switched on [-]; 0 without power.
    brake : ndarray, shape (steps, s, d)
        Force of the brakes at the belt [N].
    limits : ndarray, shape (s, d, 65)
        Largest force over the speed from 0 to `top` [N].
    top : float
        [m/s].
    drag : ndarray, shape (s, d)
        What a drive without power takes of its own once its belt slips [N].
    """

    slope: Array
    reference: Array
    share: Array
    brake: Array
    limits: Array
    top: float
    drag: Array

    def limit(self, speed: Array) -> Array:
        """Largest force at a speed [N], shape (s, d)."""
        over = np.minimum(np.abs(speed) / self.top, 1.0) * (SPEED_POINTS - 1)
        low = np.minimum(over.astype(int), SPEED_POINTS - 2)
        s, d = np.ogrid[: low.shape[0], : low.shape[1]]
        first, second = self.limits[s, d, low], self.limits[s, d, low + 1]
        return np.asarray(first + (over - low) * (second - first))


@dataclass(frozen=True, eq=False)
class Beginning:
    """Where belts begin: speeds and tensions, friction that acts, forces of the drives on the belt [m/s, N]."""

    speed: Array
    tension: Array
    resisting: Array
    driving: Array
    rims: Array


@dataclass(frozen=True, eq=False)
class Record:
    """What happened.

    Attributes
    ----------
    step : float
        Of the calculation [s].
    highest, lowest, highest_at, lowest_at : ndarray, shape (s, n)
        Extreme tensions in the middle of every cell, and at the driven pulley where one ends there [N]; when [s].
    highest_speed, lowest_speed, highest_speed_at, lowest_speed_at : ndarray, shape (s, n + 1)
        Extreme speeds of every mass, that at the begin too [m/s], and when [s].
    times, tensions : ndarray, shape (m,), (m, s, n)
        Samples of the tension [N].
    speeds : ndarray, shape (m, s, n + 1)
        Samples of the belt's speed [m/s].
    drives : dict of str to ndarray, shape (steps, s, d)
        At every step: "force" on the belt, "motor", "rim", "belt" speeds, "arriving" and "leaving" tensions at the
        pulley, "holding" force of brake and backstop.
    take_up : dict of str to ndarray, shape (steps, s)
        Its "tension" [N] and the "belt" it has taken in [m].
    slipped, heat : ndarray, shape (s, d)
        Way of the rim over the belt [m], and what it heats [J].
    fastest, slowest : ndarray, shape (s, n + 1)
        Highest and lowest acceleration of every mass over a sample [m/s²].
    work : dict of str to ndarray, shape (s,)
        Energy that motors gave and where it is, J; "missing" is what the sum lacks.
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
    """Highest and lowest of what is told step by step, and at which step."""

    shape: tuple[int, ...]
    block: Array = field(init=False)
    count: int = 0
    first: int = -1  # the state at the begin is told before the first step

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

    def look_at(self, *place: int, values: Array) -> None:
        """Take in what else one of them was from the begin on."""
        for i, best, at, better in (
            (int(values.argmax()), self.high, self.high_at, np.greater),
            (int(values.argmin()), self.low, self.low_at, np.less),
        ):
            if better(values[i], best[place]):
                best[place], at[place] = values[i], i - 1


class _BeltLaw:
    """Tension of every cell by how far its ends have moved apart, u = T/k - b/T², and a relaxing branch beside it."""

    def __init__(self, chain: Chain, step: float, tension: Array) -> None:
        self.bears = chain.stiffness > 0.0
        self.k, self.sag = np.where(self.bears, chain.stiffness, 1.0), chain.sag
        self.hangs = bool(chain.sag.any())
        if self.hangs:
            self.sag = np.where(self.bears, chain.sag, 1.0)
            tension = np.where(self.bears, tension, 1.0)
            if tension.min() <= 0.0:
                raise NoSolutionError(
                    "a belt that hangs between idlers bears tension only: the begin is slack"
                )
        self.gives, self.softens = 1.0 / self.k, 2.0 * self.k * self.sag
        self.root = self.tension = tension
        self.apart = self.gives * tension - (self.sag / tension**2 if self.hangs else 0.0)
        share, time = chain.relaxing
        self.fades = math.exp(-step / time)
        self.branch_k = share * np.where(self.bears, self.k, 0.0)
        self.fed = self.branch_k * time / step * (1.0 - self.fades)
        self.branch = np.zeros_like(tension)
        self._ease()

    def _ease(self) -> None:
        """Share of k that the cells have at their tension; without sag 1."""
        self.eased = (
            1.0 / (1.0 + self.softens / (self.root * self.root * self.root))
            if self.hangs
            else np.ones_like(self.root)
        )

    def stretch(self, way: Array) -> Array:
        """Move the ends of the cells apart [m]; the tension without damping [N]."""
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
        if self.branch_k.any():
            self.branch = self.fades * self.branch + self.eased * self.fed * way
        self.tension = np.where(self.bears, self.root + self.branch, 0.0)
        return self.tension

    def stored(self) -> tuple[Array, Array]:
        """Work that springs and sag keep, and the relaxing branch, of every belt [J]."""
        own = 0.5 * self.root**2 / self.k - (2.0 * self.sag / self.root if self.hangs else 0.0)
        held = np.divide(
            self.branch**2, 2.0 * self.branch_k, out=np.zeros_like(own), where=self.branch_k > 0.0
        )
        return np.where(self.bears, own, 0.0).sum(axis=1), held.sum(axis=1)


@dataclass(frozen=True, eq=False)
class _Answer:
    """Of a belt to an impulse of 1 N s at each of some places.

    The places; all speeds [m/s], shape (s, d, n + 1); what the take-up lacks [N s].
    """

    places: Integers
    columns: Array
    of_take_up: Array

    @cached_property
    def mutual(self) -> Array:
        """Speeds of the places, shape (s, d, d)."""
        return np.take_along_axis(self.columns, self.places[:, None], axis=2)

    @cached_property
    def own(self) -> Array:
        """Speed of each place by its own impulse."""
        return np.asarray(np.einsum("sdd->sd", self.mutual))

    @cached_property
    def beside(self) -> tuple[Array, Array]:
        """Of the speed of each place by its own impulse what the masses before and behind it do not share [-]."""
        last = self.columns.shape[2] - 1
        shared = (
            np.take_along_axis(self.columns, masses[:, :, None], axis=2)[:, :, 0]
            for masses in (np.maximum(self.places - 1, 0), np.minimum(self.places + 1, last))
        )
        before, behind = (1.0 - speed / self.own for speed in shared)
        return before, behind

    def turns(self) -> list[list[int]]:
        """Places that move each other, to rounding, are not in one group."""
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
        """Speeds, and what the take-up lacks, after impulses at the places."""
        return (
            speed + np.einsum("sd,sdn->sn", impulse, self.columns),
            lacking + (self.of_take_up * impulse).sum(axis=1),
        )


class _Solver:
    """One step's linear system: masses, damping, the take-up between both ends; pulleys' responses beside it."""

    def __init__(self, chain: Chain, step: float) -> None:
        s, n = chain.stiffness.shape
        self.mass, self.end, self.rows = chain.mass, chain.end, np.arange(s)
        self.stiff = np.isinf(chain.carriage) | (chain.winch[0] > 0.0)
        self.carriage = np.where(self.stiff, 0.0, chain.carriage)
        self.damping = 0.5 * step * chain.retardation * chain.stiffness
        self.shares, self.drives = np.full((s, n), np.inf), chain.nodes.shape[1]
        places = np.hstack([chain.end[:, None], chain.nodes, chain.lumps])
        units = np.zeros((places.shape[1], s, n + 1))
        units[np.arange(places.shape[1]), self.rows[:, None], places] = 1.0
        units[0, :, 0] -= 1.0
        self.units, self.places = units.reshape(len(units), -1).T, places[:, 1:]

    def eases(self, shares: Array) -> None:
        """Make the system anew for belts some of whose shares of k have changed.

        A share below that of the cell would make the step unstable, one above it puts the difference off by a step.
        """
        shares = np.where(self.damping > 0.0, shares, 0.0)
        over = self.shares - shares
        changed = np.any((over < 0.0) | (over > _SHARE), axis=1)
        if not changed.any():
            return
        self.shares = np.where(changed[:, None], np.minimum(shares + 0.5 * _SHARE, 1.0), self.shares)
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
            _Answer(self.places[:, k], columns[:, k], of_take_up[:, k])
            for k in (slice(self.drives), slice(self.drives, None))
        )

    def _banded(self, right: Array) -> Array:
        solution, _ = dpttrs(self.lower, self.off, right.ravel())
        return np.asarray(solution).reshape(right.shape)

    def _apart(self, speed: Array) -> Array:
        """How much faster the belt runs into the take-up than out of it."""
        return np.asarray(speed[self.rows, self.end] - speed[:, 0])

    def change(self, impulse: Array, before: Array, wanted: Array) -> tuple[Array, Array]:
        """Change of all speeds by impulses [m/s], and the impulse that the take-up's tension lacks [N s]."""
        change = self._banded(impulse)
        apart = self._apart(change)
        apart = np.where(self.stiff, apart + self._apart(before) - wanted, apart)
        lacking = self.kappa * apart
        return change - self.pair * lacking[:, None], lacking


def run(chain: Chain, machines: Machines, start: Beginning, *, step: float, samples: int = 300) -> Record:
    """Follow belts through time.

    Parameters
    ----------
    chain : Chain
        The belts.
    machines : Machines
        Motors and brakes; as many steps as they have.
    start : Beginning
        Speeds, tensions and forces at the begin.
    step : float
        Of time [s], at most `chain.longest_step`.
    samples : int
        Samples kept of all tensions, about so many.

    Raises
    ------
    NoSolutionError
        The step is too long, or a figure is not finite.
    """
    if step > chain.longest_step * (1.0 + 1e-9):  # rounding of the quotient
        raise NoSolutionError(f"a step of {step:.4g} s is unstable: at most {chain.longest_step:.4g} s")
    return _Motion(chain, machines, start, step, samples).followed()


class _Motion:
    """Belts in motion: what changes from step to step, and what is kept of it."""

    def __init__(self, chain: Chain, machines: Machines, start: Beginning, step: float, samples: int) -> None:
        self.chain, self.machines, self.dt = chain, machines, step
        self.steps = machines.reference.shape[0]
        self.every = max(1, self.steps // samples)
        self.solver, self.law = _Solver(chain, step), _BeltLaw(chain, step, start.tension)
        self.solver.eases(self.law.eased)
        self.ledger = _Ledger(chain, step, start, self.law)
        self._set_up()
        s, n = chain.stiffness.shape
        self.speed, self.tension = start.speed, start.tension
        self.stretching = np.diff(start.speed, axis=1)
        self.strained = start.tension + self.tau_k * self.law.eased * self.stretching
        self.resisting = start.resisting * self.loose
        self.driving, self.rims = start.driving, start.rims
        self.gripping = np.ones(chain.nodes.shape, dtype=bool)
        self.rubbing = start.resisting[self.rows, self.at]
        self.on_pulleys = start.speed[
            self.rows, self.at
        ]  # at rest exactly 0, which the solver's rounding blurs
        self.lumps_rest = start.speed[self.rows, chain.lumps] == 0.0
        self.pulled, self.taken, self.winding = chain.held, np.zeros(s), np.zeros(s)
        self.extremes, self.speeds = _Extremes((s, n)), _Extremes((s, n + 1))
        names = ("force", "motor", "rim", "belt", "arriving", "leaving", "holding")
        self.drives = {name: np.zeros((self.steps, *chain.nodes.shape)) for name in names}
        self.take_up = {name: np.zeros((self.steps, s)) for name in ("tension", "belt")}
        self.slipped, self.heat = np.zeros(chain.nodes.shape), np.zeros(chain.nodes.shape)
        self.fastest, self.slowest = np.zeros((s, n + 1)), np.zeros((s, n + 1))
        self.sampled = start.speed
        self.kept: list[tuple[float, Array, Array]] = []

    def _set_up(self) -> None:
        """What stays the same: places, compliances, friction at rest."""
        chain, step, n = self.chain, self.dt, self.chain.stiffness.shape[1]
        self.one, self.rows = np.arange(chain.end.size), np.arange(chain.end.size)[:, None]
        self.at = at = chain.nodes
        self.loose = np.ones_like(chain.mass)
        self.loose[self.rows, at] = 0.0  # friction there is taken with the pulley's
        alone = self.loose.copy()
        alone[self.rows, chain.lumps] = 0.0
        self.over_mass, self.under_mass = alone * step / chain.mass, alone * chain.mass / step
        self.still, self.stuck = chain.sticking * self.over_mass, chain.sticking[self.rows, at]
        self.tau_k = chain.retardation * chain.stiffness
        self.first, self.last = (
            at == 0,
            at == chain.end[:, None],
        )  # beside the take-up pulleys bear its tension
        self.before, self.behind = np.maximum(at - 1, 0), np.minimum(at, n - 1)
        self.turns = [_only(chain, self.machines, some) for some in self.solver.pulleys.turns()]
        weight = chain.weight[self.rows, at]
        self.lying = chain.before[1], weight - chain.before[1]
        self.inert = chain.before[0] / step, (chain.mass[self.rows, at] - chain.before[0]) / step

    def followed(self) -> Record:
        """Take every step."""
        before, behind = self._shares(self.chain.resisting(self.speed)[self.rows, self.at])
        tight = self.chain.held[:, None]
        coming = np.where(self.first, tight, self.tension[self.rows, self.before])
        parting = np.where(self.last, tight, self.tension[self.rows, self.behind])
        self.beside = beside = (
            coming + self.lying[0] + before * self.rubbing,
            parting - self.lying[1] - behind * self.rubbing,
        )
        self.extremes.tell(self.tension)
        self.speeds.tell(self.speed)
        for i in range(self.steps):
            self._step(i)
            self._keep(i)
        self.extremes.look()
        self.speeds.look()
        self._at_pulleys(*beside)
        extremes, speeds, kept = self.extremes, self.speeds, self.kept
        if not (np.all(np.isfinite(extremes.high)) and np.all(np.isfinite(self.speed))):
            raise NoSolutionError("the belt's motion has no finite answer: look for extreme inputs")
        return Record(
            self.dt, extremes.high, extremes.low, self._time(extremes.high_at), self._time(extremes.low_at),
            speeds.high, speeds.low, self._time(speeds.high_at), self._time(speeds.low_at),
            np.array([time for time, _, _ in kept]), np.stack([t for _, t, _ in kept]),
            np.stack([v for _, _, v in kept]), self.drives, self.take_up, self.slipped, self.heat, self.fastest,
            self.slowest, self.ledger.closed(self.speed, self.rims, self.law),
        )  # fmt: skip

    def _time(self, steps: Array) -> Array:
        """Of a step; that of the begin is 0."""
        return np.asarray(self.dt * np.maximum(steps, 0.0))

    def _step(self, i: int) -> None:
        """Speeds by forces, pulleys, friction; then tensions by speeds."""
        chain = self.chain
        speed, band, run_up = chain.winch
        if np.any(speed):
            wanted, most = speed * _winding(self.pulled / chain.held - 1.0, band), self.dt * speed / run_up
            self.winding = np.clip(wanted, self.winding - most, self.winding + most)
        self.solver.eases(self.law.eased)
        change, lacking = self.solver.change(self.dt * self._acting(), self.speed, self.winding)
        new, rolling = self.speed + change, chain.resisting(self.speed)
        new, lacking, lumped = self._rubbed(new, lacking, rolling)
        if self.at.size:
            new, lacking = self._driven(i, new, lacking, rolling)
        # what acts: of τ k the solver's share on half the new speeds, before masses rub alone, the rest on the old
        half = 0.5 * self.solver.shares
        damping = self.tau_k * (half * np.diff(new, axis=1) + (self.law.eased - half) * self.stretching)
        free = new + self.resisting * self.over_mass
        allowed = np.where(self.speed == 0.0, self.still, rolling * self.over_mass)
        rubbed = np.minimum(np.maximum(free, -allowed), allowed)
        new = free - rubbed
        self.resisting = rubbed * self.under_mass
        self.resisting[self.rows, chain.lumps] = lumped
        self.pulled = chain.held - lacking / self.dt
        self.ledger.belts(self.speed, new, self.resisting, self.pulled, damping + self.law.branch)
        self.shown = self.tension + damping
        self.speed, self.stretching = new, np.diff(new, axis=1)
        self.tension = self.law.stretch(self.dt * self.stretching)
        self.strained = self.tension + self.tau_k * self.law.eased * self.stretching

    def _acting(self) -> Array:
        """Force on every mass, friction and drives as they were."""
        acting = -self.chain.weight - self.resisting
        acting[:, 1:] -= self.strained
        acting[:, :-1] += self.strained
        acting[:, 0] -= self.chain.held
        acting[self.one, self.chain.end] += self.chain.held
        acting[self.rows, self.at] += self.driving - self.rubbing
        return acting

    def _driven(self, i: int, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array]:
        """Speeds with new forces of pulleys, in turn where they move each other, and what the take-up lacks then."""
        chain, rows, pulleys = self.chain, self.rows, self.solver.pulleys
        half = 0.5 * self.solver.shares
        softer, stressed = self.tau_k * half, self.tau_k * (self.law.eased - half) * self.stretching
        shares = self._shares(rolling[rows, self.at])
        impulse, friction, over = (
            self.dt * (self.driving - self.rubbing),
            self.rubbing.copy(),
            self.rubbing.copy(),
        )
        for k, drive, machine in self.turns:
            at, first, last, left, right, on = (
                part[:, k]
                for part in (self.at, self.first, self.last, self.before, self.behind, self.on_pulleys)
            )
            answer, going = pulleys.own[:, k], new[rows, at]
            of_take_up = pulleys.of_take_up[:, k] / (answer * self.dt)
            inert = tuple(part[:, k] for part in self.inert)
            yields = (
                inert[0] + np.where(first, -of_take_up, softer[rows, left] * pulleys.beside[0][:, k]),
                inert[1] + np.where(last, of_take_up, softer[rows, right] * pulleys.beside[1][:, k]),
            )
            tight = (chain.held - lacking / self.dt)[:, None]
            coming, parting = (
                self.tension[rows, side] + stressed[rows, side]
                + softer[rows, side] * (new[rows, side + 1] - new[rows, side])
                for side in (left, right)
            )  # fmt: skip
            coming = np.where(first, tight, coming) + self.lying[0][:, k] + inert[0] * (going - on)
            parting = np.where(last, tight, parting) - self.lying[1][:, k] - inert[1] * (going - on)
            moved = _pulleys(
                drive, machine, i, step=self.dt, answer=answer, rim=self.rims[:, k],
                free=going - answer * impulse[:, k],
                arriving=coming - yields[0] * going, leaving=parting + yields[1] * going,
                yields=yields, friction=np.where(on == 0.0, self.stuck[:, k], rolling[rows, at]),
                shares=(shares[0][:, k], shares[1][:, k]),
                last=(self.driving[:, k], self.beside[0][:, k], self.beside[1][:, k]), gripped=self.gripping[:, k],
            )  # fmt: skip
            for name, values in self.drives.items():
                values[i][:, k] = getattr(moved, name)
            friction[:, k], self.gripping[:, k] = moved.friction, moved.grips
            over[:, k] = np.where(moved.grips, 0.0, self.dt * (moved.rim - moved.belt))
            change = (moved.belt - going) / answer
            new = new + np.einsum("sd,sdn->sn", change, pulleys.columns[:, k])
            lacking = lacking + (pulleys.of_take_up[:, k] * change).sum(axis=1)
        now = {name: values[i] for name, values in self.drives.items()} | {"friction": friction}
        self.beside = now["arriving"], now["leaving"]
        self.slipped = self.slipped + np.abs(over)
        self.heat = self.heat + over * now["force"]
        self.ledger.drives(self.rims, self.speed[rows, self.at], now)
        self.driving, self.rubbing, self.rims, self.on_pulleys = (
            now["force"],
            friction,
            now["rim"],
            now["belt"],
        )
        return new, lacking

    def _rubbed(self, new: Array, lacking: Array, rolling: Array) -> tuple[Array, Array, Array]:
        """Speeds with the friction of the lumps, one after the other, what the take-up lacks with it, and itself."""
        rows, at, answer = self.rows, self.chain.lumps, self.solver.lumps
        earlier, speed = self.resisting[rows, at], new[rows, at]
        most = self.loose[rows, at] * np.where(
            self.lumps_rest, self.chain.sticking[rows, at], rolling[rows, at]
        )
        over_force, impulse = self.dt * answer.own, np.zeros_like(most)
        free, allowed = over_force * earlier, over_force * most
        for j in range(at.shape[1]):
            left = _rest(speed[:, j] + free[:, j], allowed[:, j], allowed[:, j])
            self.lumps_rest[:, j] = left == 0.0
            impulse[:, j] = (left - speed[:, j]) / answer.own[:, j]
            speed = speed + impulse[:, j, None] * answer.mutual[:, j]
        return *answer.moved(impulse, new, lacking), earlier - impulse / self.dt

    def _keep(self, i: int) -> None:
        """Note extremes, samples, and what the take-up does."""
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

    def _shares(self, rolling: Array) -> tuple[Array, Array]:
        """Of the friction on the driven masses what acts before and behind their pulleys [-]."""
        _, _, *parabola, sticking = self.chain.before
        size = np.minimum(np.abs(self.on_pulleys), self.chain.known)
        moving = parabola[0] + size * (parabola[1] + size * parabola[2])
        still = self.on_pulleys == 0.0
        of, part = np.where(still, self.stuck, rolling), np.where(still, sticking, moving)
        before = np.divide(part, of, out=np.zeros_like(of), where=of > 0.0)
        return before, 1.0 - before

    def _at_pulleys(self, arriving: Array, leaving: Array) -> None:
        """Extremes of cells that end on driven pulleys: what acts there at once jumps there first."""
        for cells, end, begin, name in (
            (self.before, self.first, arriving, "arriving"),
            (self.behind, self.last, leaving, "leaving"),
        ):
            values = np.concatenate([begin[None], self.drives[name]])
            for d in range(cells.shape[1]):
                for row in np.flatnonzero(~end[:, d]).tolist():
                    self.extremes.look_at(row, int(cells[row, d]), values=values[:, row, d])


def _only(chain: Chain, machines: Machines, k: list[int]) -> tuple[list[int], Chain, Machines]:
    """Some drives of every belt."""
    return (
        k,
        replace(chain, rim=chain.rim[:, k], grip=chain.grip[:, k], backstop=chain.backstop[:, k]),
        replace(
            machines, slope=machines.slope[:, k], reference=machines.reference[..., k], share=machines.share[..., k],
            brake=machines.brake[..., k], limits=machines.limits[:, k], drag=machines.drag[:, k],
        ),
    )  # fmt: skip


def _winding(over: Array, band: Array) -> Array:
    """1 where a winch takes in, -1 where it pays out, 0 within its band."""
    return np.asarray(np.where(over < -band, 1.0, np.where(over > band, -1.0, 0.0)))


@dataclass(frozen=True, eq=False)
class _Moved:
    """A driven pulley after a step: forces on the belt, of motor, brake and friction of the belt there [N], speeds."""

    force: Array
    motor: Array
    holding: Array
    friction: Array
    rim: Array
    belt: Array
    arriving: Array
    leaving: Array
    grips: NDArray[np.bool_]


def _rest(free: Array, forward: Array, backward: Array) -> Array:
    """Speed that friction leaves of a free one: it takes up to `forward` off, or adds up to `backward`."""
    return free - np.minimum(np.maximum(free, -backward), forward)


def _pulleys(
    chain: Chain, machines: Machines, i: int, *, step: float, answer: Array, rim: Array, free: Array,
    arriving: Array, leaving: Array, yields: tuple[Array, Array], friction: Array, shares: tuple[Array, Array],
    last: tuple[Array, Array, Array], gripped: NDArray[np.bool_],
) -> _Moved:  # fmt: skip
    """Motors, brakes, rims and the belt on them, each at once; a motor on its line, beyond its limit at that.

    `free` is the belt's speed without the pulley, `answer` what an impulse adds to it; the tensions are those at no
    speed there and without friction, `yields` what a speed adds before and takes off behind, `shares` those of the
    friction there. They are those between which the force stands, mass and damping of the half cells up to the pulley
    taken in: a force that comes at once is split as the impedances of both sides, however long the cells. A belt that
    `gripped` and slips now is taken to do so in the middle of the step: force and tensions are half the `last` ones,
    half those told. At the begin of the step they would make the tension swing from cell to cell.
    """
    most = machines.share[i] * machines.limit(rim)
    brake, back, grip = machines.brake[i], chain.backstop, chain.grip
    on = most > 0.0
    slope = np.where(on, machines.slope, 0.0)
    base = slope * machines.reference[i]
    for tried in range(2):
        # the mean of both ends while a step resolves how a rim comes to its line, else later: no swing about it
        gives = step * slope
        late = np.maximum(
            0.5, 1.0 - np.divide(chain.rim, gives, out=np.full_like(gives, 0.5), where=gives > 0.0)
        )
        mass = chain.rim + late * gives
        alone = (chain.rim * rim + step * (base - (1.0 - late) * slope * rim)) / mass
        together = 1.0 / answer + mass
        stop = step * (brake + friction) / together
        common = _rest((free / answer + mass * alone) / together, stop, np.where(back, np.inf, stop))
        against = np.sign(common) * friction
        before, behind = arriving + shares[0] * against, leaving - shares[1] * against
        force = (common - free) / (answer * step) + against
        forward = force > grip * np.maximum(behind - yields[1] * common, 0.0)
        backward = force < -grip * np.maximum(before + yields[0] * common, 0.0)
        grips = ~(forward | backward)
        belt, turned, begins = common, common, gripped & ~grips
        if not grips.all():
            pushed, slack = np.where(forward, behind, -before), np.where(forward, yields[1], yields[0])
            eased = 1.0 + answer * step * grip * slack
            rub = answer * step * friction / eased
            driven = grip * pushed + np.where(
                begins, 0.5 * (last[0] + grip * np.where(forward, -last[2], last[1])), 0.0
            )
            slid = _rest((free + answer * step * driven) / eased, rub, rub)
            limit = driven - grip * slack * slid
            limit = np.where(forward, np.maximum(limit, 0.0), np.minimum(limit, 0.0))
            slid = np.where(
                limit == 0.0, _rest(free, answer * step * friction, answer * step * friction), slid
            )
            force = np.where(grips, force, limit)
            stop = step * (brake + np.where(on, 0.0, machines.drag)) / mass
            spun = _rest(alone - step * force / mass, stop, np.where(back, np.inf, stop))
            belt, turned = np.where(grips, common, slid), np.where(grips, common, spun)
        motor = base - slope * (late * turned + (1.0 - late) * rim)
        beyond = np.abs(motor) > most
        if tried or not beyond.any():
            break
        base, slope = np.where(beyond, np.copysign(most, motor), base), np.where(beyond, 0.0, slope)
    taken = force - (belt - free) / (answer * step)
    arriving = arriving + yields[0] * belt + shares[0] * taken
    leaving = leaving - yields[1] * belt - shares[1] * taken
    return _Moved(
        force, motor, mass * (alone - turned) / step - force, taken, turned, belt,
        np.where(begins, 2.0 * arriving - last[1], arriving), np.where(begins, 2.0 * leaving - last[2], leaving), grips,
    )  # fmt: skip


class _Ledger:
    """Energy given and where it goes, at the mean of old and new speeds."""

    def __init__(self, chain: Chain, step: float, start: Beginning, law: _BeltLaw) -> None:
        self.chain, self.dt = chain, step
        self.rows = np.arange(chain.end.size)
        names = ("motors", "lift", "friction", "damping", "brakes", "slip", "take-up")
        self.sums = {name: np.zeros(chain.end.size) for name in names}
        self.first = self._stored(start.speed, start.rims, law)

    def drives(self, rims: Array, belt: Array, now: dict[str, Array]) -> None:
        """Add the work of a step at the driven pulleys, from their speeds and the belt's before it."""
        rim, at = 0.5 * (rims + now["rim"]), 0.5 * (belt + now["belt"])
        for name, power in (
            ("motors", now["motor"] * rim),
            ("friction", now["friction"] * at),
            ("brakes", now["holding"] * rim),
            ("slip", now["force"] * (rim - at)),
        ):
            self.sums[name] += self.dt * power.sum(axis=1)

    def belts(self, before: Array, now: Array, friction: Array, tight: Array, damping: Array) -> None:
        """Add the work of a step all along the belts."""
        mean = 0.5 * (before + now)
        apart = mean[self.rows, self.chain.end] - mean[:, 0]
        spread = np.diff(mean, axis=1)
        for name, power in (
            ("lift", np.einsum("sn,sn->s", self.chain.weight, mean)),
            ("friction", np.einsum("sn,sn->s", friction, mean)),
            ("damping", np.einsum("sn,sn->s", damping, spread)),
            ("take-up", -np.where(self.chain.winch[0] > 0.0, tight, self.chain.held) * apart),
        ):
            self.sums[name] += self.dt * power

    def _stored(self, speed: Array, rims: Array, law: _BeltLaw) -> tuple[Array, Array, Array]:
        apart = speed[self.rows, self.chain.end] - speed[:, 0]
        mass = np.where(np.isinf(self.chain.carriage), 0.0, self.chain.carriage)
        moving = np.einsum("sn,sn->s", self.chain.mass, speed**2) + np.einsum(
            "sd,sd->s", self.chain.rim, rims**2
        )
        return 0.5 * (moving + mass * apart**2), *law.stored()

    def closed(self, speed: Array, rims: Array, law: _BeltLaw) -> dict[str, Array]:
        """Every sum, and what they lack; what the relaxing branch keeps is elastic, not damped."""
        kinetic, elastic, held = (
            last - first for last, first in zip(self._stored(speed, rims, law), self.first, strict=True)
        )
        made = dict(self.sums) | {"kinetic": kinetic, "elastic": elastic + held}
        made["damping"] = made["damping"] - held
        spent = sum((value for name, value in made.items() if name != "motors"), np.zeros_like(kinetic))
        return made | {"missing": made["motors"] - spent}
