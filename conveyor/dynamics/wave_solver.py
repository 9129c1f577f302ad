"""Forces of the belt between its masses, and the linear system of one step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpttrf, dpttrs

from conveyor.dynamics.belt_chain import Array, BeltRow, Chain, Integers
from conveyor.errors import NoSolutionError

NEWTON, NEAR = (
    60,
    1e-5,
)  # iterations for a tension at most, and the relative change after which the error is its square


_FALL = 0.75  # of a tension, by which the tangent may take it down


_SHARE = 0.05  # of k, by which solver damping may exceed that of a cell: half of it moves no peak by 1e-4


NO_CELL = 1.0
"""Constant tension of the cells in the row that stand for take-ups, which act by themselves [N]."""


class BeltLaw:
    """Tension of every cell by its elongation, u = T/k - b/T², and a relaxing branch in parallel."""

    def __init__(self, chain: Chain, row: BeltRow, step: Array, tension: Array) -> None:
        self.k, self.row = row.cells(chain.stiffness, 1.0), row
        self.way_k = row.cells(chain.stiffness * step[:, None], 0.0)
        self.hangs = bool(chain.sag.any())
        self.bends = self.k * row.cells(chain.sag, 0.0)
        self.root = self.tension = row.cells(tension, NO_CELL)
        if self.hangs and self.root.min() <= 0.0:
            raise NoSolutionError("a belt that hangs between idlers bears tension only: the begin is slack")
        self.straight = self.root - (self.bends / self.root**2 if self.hangs else 0.0)
        share, time = chain.relaxing
        self.fades = row.each(np.exp(-step / time))
        self.branch_k = share * row.cells(chain.stiffness, 0.0)
        self.fed = self.branch_k * time * (1.0 - self.fades)
        self.branch, self.relaxes = np.zeros_like(self.root), bool(self.branch_k.any())
        self.eased = np.ones_like(self.root)
        self._ease()

    def drop_belts(self, row: BeltRow) -> None:
        """Go on with the first belts only, those of a row."""
        self.row, count = row, row.last[-1] + 1
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, value[:count])

    def _ease(self) -> None:
        """Tangent stiffness of the cells over k at their tension, T/(3 T - 2 k u); 1 without sag."""
        if self.hangs:
            self.eased = self.root - self.straight
            self.eased += self.eased
            self.eased += self.root
            np.divide(self.root, self.eased, out=self.eased)

    def stretch(self, apart: Array) -> Array:
        """Elongate the cells at speeds [m/s] over a step and return the tension without damping [N]."""
        change = self.way_k * apart
        self.straight = straight = self.straight + change
        if not self.hangs:
            self.root = straight
        else:
            # T³ - k u T² - k b is convex above k u: Newton comes from above, and begins no lower than there
            change *= self.eased
            change += self.root
            root = np.maximum(change, straight, out=change)
            np.maximum(root, (1.0 - _FALL) * self.root, out=root)
            for _ in range(NEWTON):
                above = root - straight
                change = above - self.bends / (root * root)
                above += above
                above += root
                change /= above
                root -= change * root
                if max(np.maximum.reduce(change), -np.minimum.reduce(change)) < NEAR:
                    break
            else:
                raise NoSolutionError("the tension of a slack belt has no answer: look for extreme inputs")
            self.root = root
        self._ease()
        self.tension = self.root
        if self.relaxes:
            self.branch = self.fades * self.branch + self.eased * self.fed * apart
            self.tension = self.root + self.branch
        return self.tension

    def stored(self) -> tuple[Array, Array]:
        """Energy stored in springs and sag, and in the relaxing branch, of every belt [J]."""
        own = (0.5 * self.root**2 - (2.0 * self.bends / self.root if self.hangs else 0.0)) / self.k
        own[self.row.last] = 0.0
        held = np.divide(self.branch**2, 2.0 * self.branch_k, out=np.zeros_like(own), where=self.branch_k > 0.0)
        return self.row.sums(own), self.row.sums(held)


@dataclass(frozen=True, eq=False)
class StepPlaces:
    """Masses on which single impulses act, and those beside them; places in the row.

    `near` has lumps, then the masses before the drives, those of the drives and those behind them, shape (s, l + 3d);
    `acting` both ends of the belt, lumps and drives, shape (s, 2 + l + d).
    """

    near: Integers
    acting: Integers
    lumps: int
    drives: int

    @classmethod
    def of(cls, chain: Chain, row: BeltRow) -> StepPlaces:
        """Those of a chain."""
        first, end = row.first[:, None], chain.end[:, None]
        before, behind = np.maximum(chain.nodes - 1, 0), np.minimum(chain.nodes + 1, end)
        near = first + np.hstack([chain.lumps, before, chain.nodes, behind])
        acting = first + np.hstack([np.zeros_like(end), end, chain.lumps, chain.nodes])
        return cls(near, acting, chain.lumps.shape[1], chain.nodes.shape[1])

    @property
    def of_lumps(self) -> slice:
        """Lumps in `near`."""
        return slice(self.lumps)

    @property
    def of_drives(self) -> slice:
        """Drives in `near`."""
        return slice(self.lumps + self.drives, self.lumps + 2 * self.drives)


class WaveSolver:
    """Linear system of a step: masses, damping, the take-up between both ends; and the responses of single masses.

    `reach`, shape (s, l + d, l + 3d), are the speeds of `places.near` by an impulse of 1 N s at a lump or drive, with
    the take-up between both ends; `of_take_up`, shape (s, l + d), the impulse that it lacks then; `pair`,
    shape (s, l + 3d), the speeds by 1 N s at both ends, apart.
    """

    def __init__(
        self, chain: Chain, row: BeltRow, places: StepPlaces, step: Array, shares: Array | None = None
    ) -> None:
        s = chain.end.size
        self.row, self.places, self.mass = row, places, row.masses(chain.mass)
        self.stiff = np.isinf(chain.carriage) | (chain.winch[0] > 0.0)
        self.keeps = bool(self.stiff.any())
        self.carriage = np.where(self.stiff, 0.0, chain.carriage)
        self.damping = row.cells(0.5 * step[:, None] * chain.retardation * chain.stiffness, 0.0)
        self.damps = bool(self.damping.any())
        self.lower, self.off = np.zeros((2, self.mass.size))
        self.kappa, self.pair, self.of_take_up = (
            np.zeros(s), np.zeros((s, places.near.shape[1])), np.zeros((s, places.lumps + places.drives))
        )  # fmt: skip
        self.reach = np.zeros((*self.of_take_up.shape, places.near.shape[1]))
        self.shares = np.full(self.mass.size, np.inf)
        self.middle = self.shares.copy()
        if shares is not None:
            self._factorise(np.ones(s, dtype=bool), shares)

    def update_damping(self, shares: Array) -> bool:
        """Factorise the system again if shares of k have changed; return true if so.

        A share below that of the cell would make the step unstable, one above it delays the difference by a step.
        """
        if not self.damps and np.isfinite(self.shares[0]):  # factorised once
            return False
        off = np.abs(shares - self.middle)
        if np.maximum.reduce(off) <= 0.5 * _SHARE:
            return False
        self._factorise(np.maximum.reduceat(off, self.row.first) > 0.5 * _SHARE, shares)
        return True

    def _factorise(self, belts: NDArray[np.bool_], shares: Array) -> None:
        """Factorise the system of some belts with these shares of k, and find its responses."""
        row, places = self.row, self.places
        inside = np.flatnonzero(np.repeat(belts, row.size))
        shares = np.minimum(shares.take(inside) + 0.5 * _SHARE, 1.0)
        self.shares[inside], self.middle[inside] = shares, shares - 0.5 * _SHARE
        self.middle[row.last] = 1.0  # the share of take-ups, which never changes
        damping = self.damping.take(inside) * shares
        diagonal = self.mass.take(inside) + damping
        diagonal[1:] += damping[:-1]
        lower, off, info = dpttrf(diagonal, -damping[:-1])
        if info != 0:
            raise NoSolutionError("the masses of the belt must be positive")
        self.lower[inside], self.off[inside] = lower, np.append(off, 0.0)
        before = (row.first[belts] - np.cumsum(row.size[belts]) + row.size[belts])[:, None]  # masses of other belts
        acting, near = places.acting[belts] - before, places.near[belts] - before
        units = np.zeros((acting.shape[1] - 1, diagonal.size))
        units[0, acting[:, 0]] -= 1.0
        units[np.arange(len(units)), acting[:, 1:]] += 1.0
        solved, _ = dpttrs(lower, off, units.T, overwrite_b=True)
        made = solved.T[:, np.hstack([acting[:, :2], near])].transpose(1, 0, 2)
        ends, stiff, carriage = made[:, :, 1] - made[:, :, 0], self.stiff[belts], self.carriage[belts]
        own = ends[:, 0]
        kappa = np.where(stiff, 1.0 / own, carriage / (1.0 + carriage * own))
        of_take_up = kappa[:, None] * ends[:, 1:]
        self.pair[belts], self.kappa[belts], self.of_take_up[belts] = made[:, 0, 2:], kappa, of_take_up
        self.reach[belts] = made[:, 1:, 2:] - made[:, :1, 2:] * of_take_up[:, :, None]

    def respond(self, impulse: Array) -> Array:
        """Change of all speeds by impulses, without the take-up [m/s]."""
        solution, _ = dpttrs(self.lower, self.off[:-1], impulse, overwrite_b=True)
        return np.asarray(solution)

    def lacking(self, change: Array, before: Array, wanted: Array) -> Array:
        """Impulse lacking in the take-up's tension after such a change of speeds [N s]."""
        first, last = self.row.first, self.row.last
        apart = change.take(last) - change.take(first)
        if self.keeps:
            apart = np.where(self.stiff, apart + (before[last] - before[first]) - wanted, apart)
        return np.asarray(self.kappa * apart)

    def speed_changes(self, impulses: Array) -> Array:
        """Change of all speeds by impulses at the ends, lumps and drives, shape (s, 2 + l + d) [m/s]."""
        places = self.places.acting.reshape(-1)
        at_masses = np.bincount(places, weights=impulses.reshape(-1), minlength=self.mass.size)
        return self.respond(np.asarray(at_masses, dtype=float))
