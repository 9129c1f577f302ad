"""Contacts sampled at Chebyshev-Lobatto points of the half width, and their interpolation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from conveyor.contact.galerkin.spectral import Contact

Array = NDArray[np.float64]


def lobatto_points(degree: int) -> Array:
    """Lobatto points t_j = cos(jπ/N), from 1 to -1; those of half the degree are every other one."""
    t: Array = np.cos(np.arange(degree + 1) * (np.pi / degree))
    return t


def chebyshev_coefficients(values: Array) -> Array:
    """Chebyshev coefficients of values at the points, along the last axis but one."""
    series: Array = _coefficient_matrix(values.shape[-2] - 1) @ values
    return series


@lru_cache(maxsize=16)
def _coefficient_matrix(degree: int) -> Array:
    """Matrix from values at Lobatto points to Chebyshev coefficients, a_k = (2/N) Σ f_j cos(kjπ/N), ends halved."""
    index = np.arange(degree + 1)
    matrix = (2.0 / degree) * np.cos(np.multiply.outer(index, index) * (np.pi / degree))
    matrix[:, [0, -1]] *= 0.5
    matrix[[0, -1]] *= 0.5
    return matrix


def interpolation_weights(degree: int, t: Array) -> Array:
    """Interpolation weights of the Lobatto values at places t, shape (*t.shape, degree + 1)."""
    weights: Array = chebyshev.chebvander(t, degree).reshape(*np.shape(t), -1) @ _coefficient_matrix(degree)
    return weights


def interpolation_errors(values: Array) -> Array:
    """Error of the interpolant through values at the Lobatto points, shape (N + 1, f), as in `curve_error`."""
    return _remaining_error(values, np.ptp(values, axis=0))


def half_degree_errors(values: Array) -> Array:
    """Error of the interpolant through every other point at the points between, an upper bound of the full one's."""
    miss: Array = np.abs(_midpoint_matrix(values.shape[-2] - 1) @ values[..., ::2, :] - values[..., 1::2, :]).max(
        axis=-2
    )
    return miss


def lobatto_derivative(values: Array) -> Array:
    """Derivative by t at the points, of values along the last axis."""
    slope: Array = values @ _derivative_matrix(values.shape[-1] - 1).T
    return slope


@lru_cache(maxsize=16)
def _derivative_matrix(degree: int) -> Array:
    t = lobatto_points(degree)
    matrix: Array = np.array(
        [chebyshev.chebval(t, chebyshev.chebder(column)) for column in _coefficient_matrix(degree).T]
    ).T
    return matrix


@lru_cache(maxsize=16)
def _midpoint_matrix(degree: int) -> Array:
    """Matrix from values at every other point to the interpolant's values at the points between."""
    half = degree // 2
    matrix: Array = chebyshev.chebvander(lobatto_points(degree)[1::2], half) @ _coefficient_matrix(half)
    return matrix


def curve_figures(rho: float, contact: Contact) -> Array:
    """(ln p, μρ/α, ε/α) of contacts, shape (k, 3)."""
    drag = contact.friction * rho / contact.alpha
    return np.stack([np.log(contact.pressure), drag, contact.eps / contact.alpha], axis=-1)


def curve_error(contact: Contact, rho: Array | float, degree: int) -> Array:
    """Relative error of friction at given load of the interpolants through all points, shape (b,).

    `contact` holds the curves one after the other, each with its degree + 1 points. The interpolant through every other
    point has an error m at the points between, where the error of Chebyshev interpolation peaks; doubling the degree
    squares it: with a variation A, m²/A is left, at most four times that. Where a part varies faster than the whole the
    series falls more slowly in the end: with sums of absolute coefficients E of its last half and e of its last
    quarter, e²/E is left, times four, too; at most m.
    """
    shape = (-1, degree + 1)
    drag = (contact.friction * rho / contact.alpha).reshape(shape)
    values = np.stack([np.log(contact.pressure).reshape(shape), drag], axis=-1)
    left = _remaining_error(values, np.ptp(values, axis=1))
    smallest = np.maximum(np.abs(drag).min(axis=1), np.finfo(float).tiny)
    worst: Array = left[:, 0] + left[:, 1] / smallest
    return worst


def _remaining_error(values: Array, size: Array) -> Array:
    """Error of the interpolant through values at the points, shape (…, N + 1, f), of a variation of that `size`."""
    miss, series = half_degree_errors(values), np.abs(chebyshev_coefficients(values))
    count, tiny = series.shape[-2] - 1, np.finfo(float).tiny
    half, quarter = (series[..., -(count // part) :, :].sum(axis=-2) for part in (2, 4))
    squared = 4.0 * miss * miss / np.maximum(size, tiny)
    left: Array = np.minimum(miss, np.maximum(squared, 4.0 * quarter * quarter / np.maximum(half, tiny)))
    return left


@dataclass(frozen=True, eq=False)
class SampledContacts:
    """Contacts of one problem at Chebyshev-Lobatto points of ln α, from the widest to the narrowest.

    Where a higher order was needed `finer` holds it at some of the points only: its change is small and smooth, and a
    polynomial of low degree carries it to the others.
    """

    contacts: Contact
    finer: Contact | None = None

    @property
    def best(self) -> Contact:
        """Contacts of the highest order, both ends among them."""
        return self.contacts if self.finer is None else self.finer

    def interpolated_series(self, figures: Callable[[Contact], Array]) -> Array:
        """Chebyshev coefficients of `figures`, which has shape (k, f) of k contacts."""
        series = chebyshev_coefficients(figures(self.contacts))
        if self.finer is not None:
            change = self._change(self.finer, figures)
            series[: change.shape[0]] += chebyshev_coefficients(change)
        return series

    def _change(self, finer: Contact, figures: Callable[[Contact], Array]) -> Array:
        """Change of `figures` by the higher order, at its points."""
        return figures(finer) - figures(self.contacts)[:: point_stride(self.contacts, finer)]

    def left(self, rho: float) -> float:
        """Relative error of friction by interpolating the higher order's change, as in `curve_error`."""
        if self.finer is None:
            return 0.0
        change = self._change(self.finer, partial(curve_figures, rho))[:, :2]
        left = _remaining_error(change, np.abs(change).max(axis=0))
        smallest = max(float(np.abs(curve_figures(rho, self.finer)[:, 1]).min()), np.finfo(float).tiny)
        return float(left[0] + left[1] / smallest)


def point_stride(all_points: Contact, some: Contact) -> int:
    """Stride in `all_points` that gives the points of `some`."""
    return (all_points.alpha.size - 1) // (some.alpha.size - 1)
