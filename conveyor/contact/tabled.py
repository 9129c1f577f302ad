"""Galerkin matrices from tables: what does not depend on the scene is looked up, many scenes in one product.

A matrix (spectral.py) is a sum over nodes of J_i J_v(u), u = m α, and over retardation terms of I_max K_min(b),
b = α/ζ. Both are smooth: J_i J_v in u (no wave shorter than π), I K in ln b (no singularity within π/2 of the real
axis). So the weights of nodes and terms are moved to grids (moved.py), and matrices are products of the grids' weights
with tables of J_i J_v and I_max K_min there; at a half width r times as
large the tables are of r u and r b. A node's matrix is that of `spectral.assemble` to 2e-12 of its weight.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.bessel import ProductIK, bessel_j
from conveyor.contact.creep import Creeps
from conveyor.contact.energy import friction_by_loss
from conveyor.contact.moved import BEFORE, LOGS, POINTS, Stencils, log_stencils, logs, moved, stencils, within
from conveyor.contact.short_rule import ShortRule
from conveyor.contact.spectral import Contact, assemble

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_FELT = 1e-4  # Σ d min(b, 1/b) from which on friction is off by less than 1e-8 of itself: 1e-13 over it seen
_STEP = 0.2  # of the grid of u
_NARROWEST = (
    1e-3  # half width below which J_0 J_1, and friction with it, is too small beside the table's rounding
)
_HIGHEST, _LARGEST = (
    64,
    1 << 20,
)  # order, and entries of a table of waves, beyond which matrices are formed one by one


@lru_cache(maxsize=16)
def _pairs(n: int) -> tuple[list[tuple[Index, Index]], Index, Array, Array]:
    """Pairs i ≤ v of equal and of unequal parity; where a matrix finds its entries, and their factors; of the loss."""
    v, i = (np.asarray(index, dtype=np.int_) for index in np.nonzero(np.tri(n + 1, dtype=bool)))
    even = (v - i) % 2 == 0
    pairs: list[tuple[Index, Index]] = [(i[kind], v[kind]) for kind in (even, ~even)]
    place = np.empty((n + 1, n + 1), dtype=int)
    low, high = (np.concatenate(side) for side in zip(*pairs, strict=True))
    place[low, high] = place[high, low] = np.arange(low.size)
    row, column = np.arange(n + 1)[:, None], np.arange(1, n + 1)
    q = row - column
    factor = np.where(row == 0, 1.0, 2.0) * column * np.where((q + q % 2) % 4 == 0, -1.0, 1.0)
    i, v = pairs[0]
    lost = np.where((v - i) % 4 == 0, 0.25, -0.25) * np.where(i == v, 1.0, 2.0) * (i > 0)
    signs, lost = np.asarray(factor.ravel(), dtype=np.float64), np.asarray(lost, dtype=np.float64)
    return pairs, np.asarray(place[:, 1:].ravel()), signs, lost


@lru_cache(maxsize=64)
def _waves(n: int, size: int, ratio: float) -> list[Array]:
    """J_i J_v(r u) on the grid of u for pairs of equal and of unequal parity, and of equal parity over u²."""
    u = _STEP * (np.arange(size) - BEFORE)
    u[BEFORE] = 1e-150  # for zero: J_1²/u² is ¼ there
    table = bessel_j(n, np.abs(ratio * u))
    table[1::2] *= np.sign(u)
    even, odd = (np.ascontiguousarray((table[i] * table[v]).T) for i, v in _pairs(n)[0])
    return [even, odd, even / (u * u)[:, None]]


@lru_cache(maxsize=32)
def _terms(n: int, ratio: float) -> list[Array]:
    """I_max K_min(r b) on the grid of b for the same pairs, with signs; on the diagonal 1/(2v) - I_v K_v."""
    products, deficit = ProductIK(n, ratio * logs()[:, None]).weighted(np.ones(1))
    signs = [np.where((v - i - 1) % 4 < 2, 1.0, -1.0) for i, v in _pairs(n)[0]]
    return [
        np.where(i == v, deficit[:, v], sign * products[:, i, v])
        for sign, (i, v) in zip(signs, _pairs(n)[0], strict=True)
    ]


@dataclass(frozen=True, eq=False)
class Tabled:
    """Contacts of given half widths: matrices of any order, and the loss.

    Attributes
    ----------
    creeps : Creeps
        Spectrum of each.
    alpha : ndarray, shape (b,)
        Half widths [-].
    b : tuple, optional
        Stencils of their terms; none where one lies beyond the tables.
    """

    creeps: Creeps
    alpha: Array
    b: Stencils | None

    @classmethod
    def of(cls, creeps: Creeps, alpha: Array) -> Tabled:
        """Contacts of half widths α, shape (b,)."""
        b = alpha[:, None] / creeps.times
        # friction of memories far longer or shorter than the passage is of this order: the tables lack the digits
        felt = (creeps.weights * np.minimum(b, 1.0 / b)).sum(axis=1)
        return cls(creeps, alpha, log_stencils(b) if within(b).all() and (felt > _FELT).all() else None)

    def __getitem__(self, chosen: Index) -> Tabled:
        b = None if self.b is None else (self.b[0][chosen], self.b[1][:, chosen])
        return Tabled(self.creeps[chosen], self.alpha[chosen], b)

    def _stencils(self, rule: ShortRule, n: int) -> tuple[Stencils, int, Stencils] | None:
        """Of nodes, with the size of the grid of u, and of terms; none where tables do not serve."""
        u = (self.alpha / _STEP)[:, None] * rule.nodes
        size = 32 * int((float(u.max()) + POINTS) / 32.0 + 1.0)
        served = n <= _HIGHEST and size * n * n <= _LARGEST and float(self.alpha.min()) >= _NARROWEST
        return (stencils(u), size, self.b) if served and self.b else None

    def matrices(self, rule: ShortRule, n: int, ratios: tuple[float, ...] = (1.0,)) -> Array:
        """`spectral.assemble` of order n at α times each ratio, one contact's after the other, (b · r, n+1, n)."""
        grids = self._stencils(rule, n)
        if grids is None:
            every = np.repeat(np.arange(self.alpha.size), len(ratios))
            alpha = np.multiply.outer(self.alpha, ratios).ravel()
            return assemble(rule[every], self.creeps[every], alpha, n)
        nodes, size, b = grids
        _, where, factor, _ = _pairs(n)
        (terms,) = moved(b, LOGS, self.creeps.weights)
        weights = moved(nodes, size, rule.weights.real, rule.weights.imag)
        out = np.empty((self.alpha.size, len(ratios), (n + 1) * n))
        for k, ratio in enumerate(ratios):
            tables = zip(weights, _waves(n, size, ratio)[:2], _terms(n, ratio), strict=True)
            packed = [weight @ wave + terms @ half_space for weight, wave, half_space in tables]
            np.multiply(np.concatenate(packed, axis=1).take(where, axis=1), factor, out=out[:, k])
        out[..., n :: n + 1] -= self.creeps.instantaneous[:, None, None]
        return out.reshape(-1, n + 1, n)

    def friction_by_loss(self, rule: ShortRule, contact: Contact, rho: Array) -> Array:
        """`energy.friction_by_loss` of the contacts, shape (b,)."""
        n = contact.c.shape[1]
        grids = self._stencils(rule, n)
        if grids is None:
            return friction_by_loss(rule, self.creeps, contact, rho)
        nodes, size, b = grids
        ((i, v), _), _, _, factor = _pairs(n)
        (lossy,) = moved(nodes, size, rule.weights.imag * rule.nodes * (self.alpha * self.alpha)[:, None])
        (terms,) = moved(b, LOGS, self.creeps.weights * self.creeps.times)
        power = lossy @ _waves(n, size, 1.0)[2] + terms @ _terms(n, 1.0)[0]
        x = np.zeros((self.alpha.size, n + 1))
        np.multiply(contact.c, np.arange(1.0, n + 1.0), out=x[:, 1:])
        power *= x[:, i]
        power *= x[:, v]
        friction: Array = 2.0 * rho * (power @ factor) / contact.pressure
        return friction
