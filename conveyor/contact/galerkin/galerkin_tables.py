"""Galerkin matrices of many problems from common tables, in one product.

A matrix (spectral.py) is a sum over nodes of J_i J_v(u), u = m α, and over retardation terms of I_max K_min(b),
b = α/ζ. Both are smooth: J_i J_v in u (no wave shorter than π), I K in ln b (no singularity within π/2 of the real
axis). So the weights of nodes and terms are moved to grids (`regrid`), and matrices are products of the grids'
weights with tables of J_i J_v and I_max K_min there; at a half width r times as large the tables are of r u and r b.
A node's matrix agrees with `conveyor.contact.galerkin.spectral.assemble_matrix` to 2e-12 of its weight.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.energy_balance import friction_by_loss
from conveyor.contact.galerkin.bessel import ProductIK, bessel_j
from conveyor.contact.galerkin.short_rule import ShortRule
from conveyor.contact.galerkin.spectral import Contact, assemble_matrix
from conveyor.contact.layers.creep import CreepBatch
from conveyor.contact.layers.regrid import (
    LOG_GRID_SIZE,
    POINTS_BEFORE,
    STENCIL_POINTS,
    Stencils,
    lagrange_stencils,
    log_grid,
    log_places,
    regrid_weights,
    within_log_grid,
)

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_LEAST_LOSS = 1e-4  # Σ d min(b, 1/b) from which on friction is off by less than 1e-8 of itself: 1e-13 over it seen
_STEP = 0.2  # of the grid of u
_NARROWEST = 1e-3  # half width below which J_0 J_1, and friction with it, is too small against the table's rounding
_HIGHEST_ORDER, _LARGEST_TABLE = (
    64,
    1 << 20,
)  # order, and entries of a table of waves, beyond which matrices are formed one by one


class _OrderPairs(NamedTuple):
    """Order pairs i ≤ v of equal and of unequal parity, and the factors of equal ones in the loss."""

    of_parity: tuple[tuple[Index, Index], tuple[Index, Index]]
    lost: Array


@lru_cache(maxsize=16)
def _order_pairs(n: int) -> _OrderPairs:
    v, i = (np.asarray(index, dtype=np.int_) for index in np.nonzero(np.tri(n + 1, dtype=bool)))
    even = (v - i) % 2 == 0
    lost = np.where((v - i) % 4 == 0, 0.25, -0.25) * np.where(i == v, 1.0, 2.0) * (i > 0)
    return _OrderPairs(((i[even], v[even]), (i[~even], v[~even])), np.asarray(lost[even], dtype=np.float64))


@lru_cache(maxsize=16)
def _entry_places(n: int, count: int) -> tuple[Index, Array]:
    """Places of the entries of `count` matrices of order n in the products with the tables, and their factors."""
    even, odd = _order_pairs(n).of_parity
    place = np.empty((count, n + 1, n + 1), dtype=int)
    for (i, v), start in ((even, 0), (odd, count * even[0].size)):
        place[:, i, v] = place[:, v, i] = start + np.arange(count * i.size).reshape(count, i.size)
    row, column = np.arange(n + 1)[:, None], np.arange(1, n + 1)
    q = row - column
    factor = np.where(row == 0, 1.0, 2.0) * column * np.where((q + q % 2) % 4 == 0, -1.0, 1.0)
    return np.asarray(place[:, :, 1:].ravel()), np.tile(factor.ravel(), count)


@lru_cache(maxsize=16)
def _term_tables(n: int, ratio: float) -> list[Array]:
    """I_max K_min(r b) on the grid of b for pairs of each parity, with signs; on the diagonal 1/(2v) - I_v K_v."""
    products, deficit = ProductIK(n, ratio * log_grid()[:, None]).weighted_sums(np.ones(1))
    return [
        np.where(i == v, deficit[:, v], np.where((v - i - 1) % 4 < 2, 1.0, -1.0) * products[:, i, v])
        for i, v in _order_pairs(n).of_parity
    ]


def _argument_grid(size: int) -> Array:
    """Grid of u, `size` points."""
    u = _STEP * (np.arange(float(size)) - POINTS_BEFORE)
    u[POINTS_BEFORE] = 1e-150  # for zero: J_1²/u² is ¼ there
    return u


@lru_cache(maxsize=32)
def _product_tables(n: int, size: int, ratios: tuple[float, ...]) -> list[Array]:
    """Tables of each parity: rows I_max K_min(r b) on the grid of b, then J_i J_v(r u) on that of u; ratio by ratio."""
    table = [bessel_j(n, np.abs(ratio * _argument_grid(size))) for ratio in ratios]
    for one in table:
        one[1::2] *= np.sign(_argument_grid(size))
    return [
        np.block(
            [
                [_term_tables(n, ratio)[parity] for ratio in ratios],
                [(one[i] * one[v]).T for one in table],
            ]
        )
        for parity, (i, v) in enumerate(_order_pairs(n).of_parity)
    ]


@lru_cache(maxsize=32)
def _loss_table(n: int, size: int) -> Array:
    """Table of pairs of equal parity for the loss, with J_i J_v over u²."""
    table: Array = _product_tables(n, size, (1.0,))[0].copy()
    table[LOG_GRID_SIZE:] /= (_argument_grid(size) ** 2)[:, None]
    return table


class _TableRows(NamedTuple):
    """Stencils of the terms and nodes, and the rows of the tables that they reach."""

    at: Stencils
    chosen: slice
    size: int


@dataclass(frozen=True, eq=False)
class GalerkinTables:
    """Matrices of any order, and the loss, of contacts of given half widths.

    Attributes
    ----------
    creeps : CreepBatch
        Spectrum of each.
    alpha : ndarray, shape (b,)
        Half widths [-].
    places : ndarray, shape (b, t), optional
        Places of their terms on the grid of ln b; None where one lies beyond the tables.
    """

    creeps: CreepBatch
    alpha: Array
    places: Array | None

    @classmethod
    def of(cls, creeps: CreepBatch, alpha: Array) -> GalerkinTables:
        """Contacts of half widths α, shape (b,)."""
        b = alpha[:, None] / creeps.times
        # friction of memories far longer or shorter than the passage is of this order: the tables lack the digits
        felt = (creeps.weights * np.minimum(b, 1.0 / b)).sum(axis=1)
        told = (felt > _LEAST_LOSS) | (felt == 0.0)  # without memory there is none
        places = log_places(b)
        return cls(creeps, alpha, places if told.all() and within_log_grid(places).all() else None)

    def __getitem__(self, chosen: Index | slice) -> GalerkinTables:
        places = None if self.places is None else self.places[chosen]
        return GalerkinTables(self.creeps[chosen], self.alpha[chosen], places)

    def _rows(self, rule: ShortRule, n: int) -> _TableRows | None:
        """Rows of terms, then nodes; None where the tables do not apply."""
        if self.places is None:
            return None
        u = (self.alpha / _STEP)[:, None] * rule.nodes
        size = int(u.max()) + STENCIL_POINTS
        if n > _HIGHEST_ORDER or size * n * n > _LARGEST_TABLE or float(self.alpha.min()) < _NARROWEST:
            return None
        first, shares = lagrange_stencils(np.concatenate([self.places, u], axis=1))
        terms = self.places.shape[1]
        low = int(first[:, :terms].min())
        first[:, :terms] -= low
        first[:, terms:] += LOG_GRID_SIZE - low
        return _TableRows((first, shares), slice(low, LOG_GRID_SIZE + size), 1 << (size - 1).bit_length())

    def _moved(self, rows: _TableRows, terms: Array, *nodes: Array) -> list[Array]:
        """Weights of the terms, joined with each set of weights of the nodes, on rows of the tables."""
        both = (np.concatenate([terms, each], axis=1) for each in nodes)
        return regrid_weights(rows.at, rows.chosen.stop - rows.chosen.start, *both)

    def matrices(self, rule: ShortRule, n: int, ratios: tuple[float, ...] = (1.0,)) -> Array:
        """Galerkin matrices of order n at α times each ratio, contact after contact, shape (b · r, n+1, n)."""
        rows = self._rows(rule, n)
        if rows is None:
            every = np.repeat(np.arange(self.alpha.size), len(ratios))
            alpha = np.multiply.outer(self.alpha, ratios).ravel()
            return assemble_matrix(rule[every], self.creeps[every], alpha, n)
        where, factor = _entry_places(n, len(ratios))
        weights = self._moved(rows, self.creeps.weights, rule.weights.real, rule.weights.imag)
        tables = _product_tables(n, rows.size, ratios)
        packed = [weight @ table[rows.chosen] for weight, table in zip(weights, tables, strict=True)]
        out: Array = np.concatenate(packed, axis=1).take(where, axis=1)
        out *= factor
        out = out.reshape(self.alpha.size, len(ratios), -1)
        out[..., n :: n + 1] -= self.creeps.instantaneous[:, None, None]
        return out.reshape(-1, n + 1, n)

    def friction_by_loss(self, rule: ShortRule, contact: Contact, rho: Array) -> Array:
        """μ of the contacts from the loss compliance, shape (b,)."""
        if not (self.creeps.weights.any() or rule.weights.imag.any()):
            return np.zeros(self.alpha.size)
        n = contact.c.shape[1]
        rows = self._rows(rule, n)
        if rows is None:
            return friction_by_loss(rule, self.creeps, contact, rho)
        pairs = _order_pairs(n)
        (i, v), _ = pairs.of_parity
        lossy = rule.weights.imag * rule.nodes * (self.alpha * self.alpha)[:, None]
        (weights,) = self._moved(rows, self.creeps.weights * self.creeps.times, lossy)
        power = weights @ _loss_table(n, rows.size)[rows.chosen]
        x = np.zeros((self.alpha.size, n + 1))
        np.multiply(contact.c, np.arange(1.0, n + 1.0), out=x[:, 1:])
        power *= x[:, i]
        power *= x[:, v]
        friction: Array = 2.0 * rho * (power @ pairs.lost) / contact.pressure
        return friction
