"""Forces of the belt between its masses, and the linear system of one step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpttrf, dpttrs

from conveyor.dynamics.belt_chain import Array, Chain, Integers
from conveyor.errors import NoSolutionError

NEWTON, NEAR = (
    60,
    1e-4,
)  # iterations for a tension at most, and the relative change after which the error is its square


_FALL = 0.75  # of a tension, by which an iteration takes it down at most


_SHARE = 0.05  # of k, by which solver damping may exceed that of a cell: half of it moves no peak by 1e-4


class BeltLaw:
    """Tension of every cell by its elongation, u = T/k - b/T², and a relaxing branch in parallel."""

    def __init__(self, chain: Chain, step: Array, tension: Array) -> None:
        self.bears = chain.stiffness > 0.0
        self.idle = not bool(self.bears.all())
        self.k, self.sag = np.where(self.bears, chain.stiffness, 1.0), chain.sag
        self.step = np.where(self.bears, step, 0.0) if self.idle else step
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
        self.fades = np.exp(-step / time)
        self.branch_k = share * np.where(self.bears, self.k, 0.0)
        self.fed = self.branch_k * time / step * (1.0 - self.fades)
        self.branch, self.relaxes = np.zeros_like(tension), bool(self.branch_k.any())
        self._ease()

    def drop_belts(self, count: int) -> None:
        """Go on with the first belts only."""
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, value[:count])

    def _ease(self) -> None:
        """Tangent stiffness of the cells over k at their tension; 1 without sag."""
        self.eased = (
            1.0 / (1.0 + self.softens / (self.root * self.root * self.root)) if self.hangs else np.ones_like(self.root)
        )

    def stretch(self, apart: Array) -> Array:
        """Elongate the cells at speeds [m/s] over a step and return the tension without damping [N]."""
        way = self.step * apart
        self.apart = self.apart + way
        if not self.hangs:
            self.root = self.k * self.apart
        else:
            # concave and rising: from below each of Newton's steps falls short of the root, the first by the tangent
            self.root = np.maximum(self.root + self.k * self.eased * way, (1.0 - _FALL) * self.root)
            for _ in range(NEWTON):
                earlier = self.root
                slack = self.sag / (earlier * earlier)
                change = (self.apart + slack - self.gives * earlier) / (self.gives + 2.0 * slack / earlier)
                self.root = earlier + change
                size = float(np.abs(change / earlier).max())
                if size < NEAR:
                    break
                if not size < _FALL:
                    self.root = np.maximum(self.root, (1.0 - _FALL) * earlier)
            else:
                raise NoSolutionError("the tension of a slack belt has no answer: look for extreme inputs")
        self._ease()
        self.tension = self.root
        if self.relaxes:
            self.branch = self.fades * self.branch + self.eased * self.fed * way
            self.tension = self.root + self.branch
        if self.idle:
            self.tension = self.tension * self.bears
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
        return add_impulses(impulse, self.columns, self.of_take_up, speed, lacking)


def add_impulses(
    impulse: Array, columns: Array, of_take_up: Array, speed: Array, lacking: Array
) -> tuple[Array, Array]:
    """Speeds, and the impulse lacking at the take-up, after impulses at places with these responses."""
    return speed + (impulse[:, None] @ columns)[:, 0], lacking + np.vecdot(impulse, of_take_up)


def _flat_indices(places: Integers, masses: int, first: int, count: int) -> tuple[Integers, Integers, Integers]:
    """Flat indices, in `count` columns, of speeds of places by all impulses, by their own, and of their neighbours."""
    s, d = places.shape
    rows = masses * (count * np.arange(s)[:, None] + first + np.arange(d))
    near = np.stack([np.maximum(places - 1, 0), np.minimum(places + 1, masses - 1)])
    return rows[:, :, None] + places[:, None], rows + places, rows + near


class WaveSolver:
    """Linear system of a step: masses, damping, the take-up between both ends; and the responses of pulleys."""

    def __init__(self, chain: Chain, step: Array, shares: Array | None = None) -> None:
        s, n = chain.stiffness.shape
        self.mass, self.end, self.rows = chain.mass, chain.end, np.arange(s)
        self.stiff = np.isinf(chain.carriage) | (chain.winch[0] > 0.0)
        self.keeps = bool(self.stiff.any())
        self.carriage = np.where(self.stiff, 0.0, chain.carriage)
        self.damping = 0.5 * step * chain.retardation * chain.stiffness
        self.drives, self.damps = chain.nodes.shape[1], bool(self.damping.any())
        places = np.hstack([chain.end[:, None], chain.nodes, chain.lumps])
        count = places.shape[1]
        self.units = np.zeros((count, s, n + 1))
        self.units[np.arange(count), self.rows[:, None], places] = 1.0
        self.units[0, :, 0] -= 1.0
        self.lower, self.off, self.pair = np.zeros((3, s, n + 1))
        self.kappa, self.columns, self.of_take_up = (
            np.zeros(s),
            np.zeros((s, count - 1, n + 1)),
            np.zeros((s, count - 1)),
        )
        self.answers = [
            (part, *_flat_indices(places[:, 1:][:, part], n + 1, part.start, places.shape[1] - 1))
            for part in (slice(0, self.drives), slice(self.drives, places.shape[1] - 1))
        ]
        self.shares = np.full((s, n), np.inf)
        self.middle = self.shares.copy()
        if shares is not None:
            self._factorise(self.rows, shares)

    def update_damping(self, shares: Array) -> bool:
        """Factorise the system again if shares of k have changed; return true if so.

        A share below that of the cell would make the step unstable, one above it delays the difference by a step.
        """
        if not self.damps:  # factorised once
            shares = np.zeros_like(shares)
        off = np.abs(shares - self.middle)
        if float(off.max()) <= 0.5 * _SHARE:
            return False
        changed = np.flatnonzero(off.max(axis=1) > 0.5 * _SHARE)
        self._factorise(changed, np.minimum(shares[changed] + 0.5 * _SHARE, 1.0))
        return True

    def _factorise(self, belts: Integers, shares: Array) -> None:
        """Factorise the system of some belts with these shares of k, and find its responses."""
        self.shares[belts], self.middle[belts] = shares, shares - 0.5 * _SHARE
        damping, end = self.damping[belts] * shares, (np.arange(belts.size), self.end[belts])
        diagonal, beside = self.mass[belts], np.zeros((belts.size, self.mass.shape[1]))
        diagonal[:, :-1] += damping
        diagonal[:, 1:] += damping
        np.negative(damping, out=beside[:, :-1])
        lower, off, info = dpttrf(diagonal.reshape(-1), beside.reshape(-1)[:-1])
        if info != 0:
            raise NoSolutionError("the masses of the belt must be positive")
        beside.reshape(-1)[:-1] = off
        self.lower[belts], self.off[belts] = lower.reshape(beside.shape), beside
        solved, _ = dpttrs(lower, off, self.units[:, belts].reshape(len(self.units), -1).T)
        made = solved.T.reshape(-1, *beside.shape)
        pair, columns = made[0], made[1:]
        own, stiff, carriage = pair[end] - pair[:, 0], self.stiff[belts], self.carriage[belts]
        kappa = carriage / (1.0 + carriage * own)
        if self.keeps:
            kappa = np.where(stiff, 1.0 / own, kappa)
        of_take_up = kappa * (columns[:, *end] - columns[:, :, 0])
        self.pair[belts], self.kappa[belts], self.of_take_up[belts] = pair, kappa, of_take_up.T
        self.columns[belts] = (columns - pair * of_take_up[:, :, None]).transpose(1, 0, 2)
        columns = self.columns
        self.pulleys, self.lumps = (
            _ImpulseResponse(
                columns[:, k], self.of_take_up[:, k], columns.take(mutual), columns.take(own), columns.take(near)
            )
            for k, mutual, own, near in self.answers
        )

    def _banded(self, right: Array) -> Array:
        solution, _ = dpttrs(self.lower.ravel(), self.off.ravel()[:-1], right.ravel())
        return np.asarray(solution).reshape(right.shape)

    def _apart(self, speed: Array) -> Array:
        """Speed of the belt into the take-up less that out of it."""
        return np.asarray(speed[self.rows, self.end] - speed[:, 0])

    def change(self, impulse: Array, before: Array, wanted: Array) -> tuple[Array, Array]:
        """Change of all speeds by impulses [m/s], and the impulse lacking in the take-up's tension [N s]."""
        change = self._banded(impulse)
        apart = self._apart(change)
        if self.keeps:
            apart = np.where(self.stiff, apart + self._apart(before) - wanted, apart)
        lacking = self.kappa * apart
        return change - self.pair * lacking[:, None], lacking
