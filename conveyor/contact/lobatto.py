"""Chebyshev-Lobatto interpolation of contacts in the half width; curves side by side on the leading axes."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from conveyor.contact.spectral import Contact

Array = NDArray[np.float64]


def points(degree: int) -> Array:
    """t_j = cos(jπ/N), from 1 to -1; those of half the degree are every other one."""
    t: Array = np.cos(np.arange(degree + 1) * (np.pi / degree))
    return t


def coefficients(values: Array) -> Array:
    """Chebyshev coefficients of values at the points, along the last axis but one."""
    found: Array = _transform(values.shape[-2] - 1) @ values
    return found


@lru_cache(maxsize=16)
def _transform(degree: int) -> Array:
    """From values at Lobatto points to Chebyshev coefficients: a_k = (2/N) Σ f_j cos(kjπ/N), ends halved."""
    index = np.arange(degree + 1)
    matrix = (2.0 / degree) * np.cos(np.multiply.outer(index, index) * (np.pi / degree))
    matrix[:, [0, -1]] *= 0.5
    matrix[[0, -1]] *= 0.5
    return matrix


@lru_cache(maxsize=16)
def _between(degree: int) -> Array:
    """From values at every other point to the interpolant's values at the points between."""
    half = degree // 2
    matrix: Array = chebyshev.chebvander(points(degree)[1::2], half) @ _transform(half)
    return matrix


def interpolated(contact: Contact, rho: Array | float, degree: int) -> tuple[Array, Array]:
    """Columns (ln p, μρ/α, ε/α) of curves, and what the interpolants of half the degree miss of friction.

    `contact` holds the curves one after the other, each with its degree + 1 points.

    Returns
    -------
    columns : ndarray, shape (b, degree + 1, 3)
        Chebyshev coefficients.
    missed : ndarray, shape (b,)
        Relative error of friction at given load of the interpolant through every other point, at the points between.
    """
    shape = (-1, degree + 1)
    drag = (contact.friction * rho / contact.alpha).reshape(shape)
    values = np.stack(
        [np.log(contact.pressure).reshape(shape), drag, (contact.eps / contact.alpha).reshape(shape)], axis=-1
    )
    miss = np.abs(_between(degree) @ values[:, ::2, :2] - values[:, 1::2, :2])
    smallest = np.maximum(np.abs(drag).min(axis=1), np.finfo(float).tiny)
    missed: Array = (miss[..., 0] + miss[..., 1] / smallest[:, None]).max(axis=1)
    return coefficients(values), missed


def weave(even: Array, odd: Array) -> Array:
    """Values at the points of a degree from those of half of it and those between."""
    out = np.empty((even.shape[0] + odd.shape[0], *even.shape[1:]))
    out[::2], out[1::2] = even, odd
    return out


def woven(even: Contact, odd: Contact) -> Contact:
    """The same of contacts."""
    return Contact(
        alpha=weave(even.alpha, odd.alpha),
        eps=weave(even.eps, odd.eps),
        c=weave(even.c, odd.c),
        pressure=weave(even.pressure, odd.pressure),
        friction=weave(even.friction, odd.friction),
        inside=even.inside.all() & np.ones(even.alpha.size + odd.alpha.size, dtype=bool),
    )
