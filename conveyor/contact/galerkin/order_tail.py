"""Galerkin orders beyond the reach of layer and images, coupled by the isolated half-space alone.

An edge layer of width ζ j∞ needs orders n ~ 4 sqrt(α/(ζ j∞)), thousands of them, but J_v(mα) of such orders is zero
wherever the correction of spectral.py is not. Beyond its core the matrix is diagonal and, for each retardation term,
I_max K_min: the orders below n act on those above through F_t = Σ_{v≤n} K_v x_v, x_v = v c_v, and these react by
B_t = Σ_{v>n} (-1)^v I_v x_v = Z F. Orders are eliminated from the top, block by block (V = d K_n Z K_n, scaled so
that nothing overflows), and close the core exactly:

    g_i += (2-δ_i0) (-1)^i (K_i/K_n)ᵀ V F/K_n.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.galerkin.bessel import ProductIK, neighbour_ratios
from conveyor.contact.layers.creep import CreepSpectrum

Array = NDArray[np.float64]

DENSE_ORDER: Final = 192
"""Order beyond which a core is closed by a tail."""
FIRST_TAIL: Final = 1 << 10
"""Last order of the first tail."""
_LONGEST_TAIL = 1 << 18
_LONGEST_TABLE = 1 << 20  # orders times terms
_BLOCK = 32
_SEGMENT = 4096  # orders whose tables are in memory at once


def longest_tail(terms: int) -> int:
    """Last order of the longest tail, limited by memory and half a second; zero for an elastic contact."""
    if not terms:
        return 0
    last = FIRST_TAIL
    while 4 * last <= _LONGEST_TAIL and 4 * last * terms <= _LONGEST_TABLE:
        last *= 4
    return last


class _OrderSegment:
    """Blocks of `block` orders between `first` and `last` of one half width; arrays over blocks k, orders m, terms t.

    `rows` are the equations of a block's own x, `up` = d I_i K_l with l the order below the block, `down` = K_i/K_n
    with n its highest, `across` = K_l/K_n, `sign` = (-1)^i.
    """

    def __init__(self, creep: tuple[float, Array, Array], alpha: float, first: int, last: int, block: int) -> None:
        instantaneous, weights, times = creep
        b = alpha / times
        upper, lower = neighbour_ratios(first - 1, last, b)
        v = np.arange(first, last + 1.0)[:, None]
        # I_v K_v = 1/(2v + δ), 1/(2v) - I_v K_v = δ/(2v (2v + δ)): bessel.ProductIK
        delta = b * (upper[1:] + lower[:-1])
        diagonal = 1.0 / (2.0 * v + delta)
        deficit = delta * diagonal / (2.0 * v)
        shape = ((last - first) // block, block, b.size)
        rising, falling = upper[1:-1].reshape(shape), lower[1:-1].reshape(shape)
        self.up = weights * diagonal[:-1].reshape(shape)[:, :1] * np.cumprod(rising, axis=1)
        back = np.cumprod(falling[:, ::-1], axis=1)[:, ::-1]
        self.down = np.concatenate([back[:, 1:], np.ones_like(back[:, :1])], axis=1)
        self.across = np.asarray(back[:, 0], dtype=np.float64)
        orders = v[1:].reshape(shape[:2])
        self.sign = np.where(orders % 2.0 == 0.0, 1.0, -1.0)[..., None]
        self.rows = np.zeros((*shape[:2], block))
        product = 2.0 * weights * diagonal[1:].reshape(shape)
        for step in range(1, block):
            product = product[:, :-1] * rising[:, step:]
            along, at = product.sum(axis=2), np.arange(block - step)
            self.rows[:, at + step, at] = along
            self.rows[:, at, at + step] = along if step % 2 == 0 else -along
        at = np.arange(block)
        self.rows[:, at, at] = -(instantaneous / orders + 2.0 * (deficit[1:].reshape(shape) @ weights))


@dataclass(frozen=True, eq=False)
class _SegmentAnswers:
    """Solutions x = X F/K_l of a segment's blocks for F/K_l of the orders below each."""

    answers: Array
    down: Array
    across: Array


@dataclass(frozen=True, eq=False)
class OrderTail:
    """Orders beyond a core of n, up to `last`, of one contact of given half width.

    Attributes
    ----------
    given : ndarray, shape (3, t, t)
        V at order n of tails that end at `last`, three quarters and half of it.
    half, most : ndarray, shape (1, t, t)
        V of the first of them at orders n/2 and 3n/4, whose upper half it then is.
    """

    alpha: float
    creep: CreepSpectrum
    core: int
    last: int
    given: Array
    half: Array
    most: Array
    _segments: Sequence[_SegmentAnswers]

    @classmethod
    def of(cls, alpha: float, creep: CreepSpectrum, core: int, last: int) -> OrderTail:
        """Eliminate the orders from `last` down; `core` is a multiple of 64, `last` of it, four times it at least."""
        terms = creep.weights.size
        parts = creep.instantaneous, creep.weights, creep.times
        starts = {last, last // 2, (3 * last) // 4}
        given = np.zeros((0, terms, terms))
        kept = []
        for low, high in reversed(list(_order_ranges(core, last))):
            segment = _OrderSegment(parts, alpha, low, high, _BLOCK)
            answers = []
            for k in range(segment.up.shape[0] - 1, -1, -1):
                if low + (k + 1) * _BLOCK in starts:
                    given = np.concatenate([given, np.zeros((1, terms, terms))])
                given, answer = _eliminate_block(segment, k, given)
                answers.append(answer[0])
            kept.append(_SegmentAnswers(np.array(answers[::-1]), segment.down, segment.across))
        below = _OrderSegment(parts, alpha, core // 2, core, core // 4)
        most, _ = _eliminate_block(below, 1, given[:1])
        half, _ = _eliminate_block(below, 0, most)
        return cls(alpha, creep, core, last, given, half, most, kept[::-1])

    def closed(self, matrix: Array, ik: ProductIK) -> tuple[Array, list[tuple[Array, Array]]]:
        """Matrix of the core, shape (1, n+1, n), closed by every order up to `last`, and pairs of lower orders.

        The first pair has a core of half and three quarters of the order, the second a tail of half and three quarters.
        """
        n = self.core
        whole, longer, shorter = matrix + _closing_matrix(n, ik, self.given)
        cores = [
            matrix[:, : order + 1, :order] + _closing_matrix(order, ik, v)
            for order, v in ((n // 2, self.half), ((3 * n) // 4, self.most))
        ]
        return whole[None], [(cores[0], cores[1]), (shorter[None], longer[None])]

    def coefficients(self, ik: ProductIK, c: Array) -> Array:
        """Coefficients c_1 … c_last from those of the core, shape (n,)."""
        orders = np.arange(1.0, self.last + 1.0)
        below = ik.falling_ratios(self.core)[1:, 0].T @ (orders[: self.core] * c)
        out = [c]
        for segment in self._segments:
            for answers, down, across in zip(segment.answers, segment.down, segment.across, strict=True):
                x = answers @ below
                below = across * below + down.T @ x
                out.append(x)
        every = np.concatenate(out)
        every[self.core :] /= orders[self.core :]
        return every

    def level(self, ik: ProductIK, c: Array) -> float:
        """Tail's part Σ_t d_t ζ_t K_0 B_t of W_0 (`mean_displacement`), from the core's c."""
        falling = ik.falling_ratios(self.core)[:, 0]
        below = falling[1:].T @ (np.arange(1.0, self.core + 1.0) * c)
        return float(self.creep.times * falling[0] @ (self.given[0] @ below))

    def quadratic(self, ik: ProductIK, c: Array) -> float:
        """Tail's part of `ProductIK.quadratic` with weights d ζ, from all coefficients, shape (last,)."""
        x = np.arange(1.0, self.last + 1.0) * c
        weights = self.creep.weights * self.creep.times
        falling = ik.falling_ratios(self.core)[1:, 0]
        below = np.stack([falling[parity::2].T @ x[parity : self.core : 2] for parity in (0, 1)])  # odd, even orders
        total = 0.0
        for low, high in _order_ranges(self.core, self.last):
            segment = _OrderSegment((0.0, weights, self.creep.times), self.alpha, low, high, _BLOCK)
            mine = x[low:high].reshape(-1, _BLOCK)
            total -= 0.5 * float(np.einsum("ki,kij,kj->", mine, segment.rows, mine))
            for k, part in enumerate(mine):
                for parity in (0, 1):
                    here = slice(parity, None, 2)
                    total -= 2.0 * float(below[parity] @ (segment.up[k, here].T @ part[here]))
                    below[parity] = segment.across[k] * below[parity] + segment.down[k, here].T @ part[here]
        return total


def _closing_matrix(order: int, ik: ProductIK, v: Array) -> Array:
    """Matrix that tails V, shape (s, t, t), add to the core of `order`, shape (s, order+1, order)."""
    falling = ik.falling_ratios(order)[:, 0]
    i = np.arange(order + 1.0)
    sign = np.where(i % 2.0 == 0.0, 2.0, -2.0)
    sign[0] = 1.0
    added: Array = (sign[:, None] * (falling @ v)) @ falling[1:].T * i[1:]
    return added


def _order_ranges(core: int, last: int) -> Iterator[tuple[int, int]]:
    """Ranges of orders between core and last, in whole blocks."""
    edges = [core, *range(_SEGMENT, last, _SEGMENT), last]
    yield from pairwise(edges)


def _eliminate_block(segment: _OrderSegment, k: int, v: Array) -> tuple[Array, Array]:
    """V below block k from V above it, and the block's solutions; shapes (s, t, t) and (s, m, t)."""
    down, across, sign = segment.down[k], segment.across[k], segment.sign[k]
    given = sign * (down @ v)
    right = segment.up[k] + given * across
    answers = np.linalg.solve(segment.rows[k] + 2.0 * given @ down.T, -2.0 * right)
    below = across[:, None] * v * across + (sign * right).swapaxes(1, 2) @ answers
    return below, answers
