"""Weights of scattered places moved to a grid, so that sums over the places are products with tables on the grid.

Σ_k w_k f(x_k) = Σ_g W_g f(x_g) where f is smooth: each place hands its weight to the 16 grid points about it by
Lagrange interpolation. The table f(x_g) is made once, and many scenes need one product with it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Stencils = tuple[NDArray[np.int_], Array]

POINTS = 16
BEFORE = POINTS // 2 - 1
"""Grid points before place 0, which a stencil there reaches."""
_ALONG = np.arange(POINTS)[:, None, None]
# ln b = 2 + 5 sinh x in steps of 0.02: a tenth in the middle, where functions of ln b are analytic within π/2 of the
# real axis only, more where they fall like b or 1/b (seen: 4e-13 of functions below one)
_STEP, _MIDDLE, _SCALE, _REACH = 0.02, 2.0, 5.0, 130  # to both sides: b from 2e-14 to 2e15
LOGS = 2 * _REACH + POINTS
"""Points of the grid of ln b."""


@lru_cache(maxsize=1)
def _lagrange() -> Array:
    """From powers of a place, counted from the stencil's middle, to the weights of its points.

    Coefficients of Π (x - x_j)/(x_i - x_j), each to rounding: the inverse of a Vandermonde matrix is not.
    """
    x = np.arange(POINTS) - 0.5 * (POINTS - 1)
    others = [np.delete(x, i) for i in range(POINTS)]
    return np.array(
        [np.poly(rest)[::-1] / np.prod(here - rest) for here, rest in zip(x, others, strict=True)]
    )


def stencils(place: Array) -> Stencils:
    """Places of shape (b, k), in steps of the grid from its point `BEFORE`: first points, and weights (16, b, k)."""
    first = np.floor(place)
    powers = np.empty((POINTS, *place.shape))
    powers[0] = 1.0
    np.subtract(place, first + 0.5, out=powers[1])
    for known in (2, 4, 8):
        np.multiply(powers[:known], powers[1] * powers[known - 1], out=powers[known : 2 * known])
    shares = _lagrange() @ powers.reshape(POINTS, -1)
    return first.astype(int), shares.reshape(powers.shape)


def moved(at: Stencils, size: int, *weights: Array) -> list[Array]:
    """Each of some weights, shape (b, k), on a grid of `size` points, shape (b, size)."""
    first, shares = at
    rows = first.shape[0]
    index = (_ALONG + (first + size * np.arange(rows)[:, None])).ravel()
    grids = (np.bincount(index, (each * shares).ravel(), rows * size) for each in weights)
    return [np.asarray(grid, dtype=np.float64).reshape(rows, size) for grid in grids]


def logs() -> Array:
    """Arguments b of the grid of ln b, shape (LOGS,)."""
    steps = np.arange(LOGS) - (_REACH + BEFORE)
    b: Array = np.exp(_MIDDLE + _SCALE * np.sinh(_STEP * steps))
    return b


def log_places(b: Array) -> Array:
    """Places of arguments b on the grid of ln b."""
    places: Array = np.arcsinh((np.log(b) - _MIDDLE) / _SCALE) / _STEP + _REACH
    return places


def within(places: Array) -> NDArray[np.bool_]:
    """Which of the scenes have all `log_places`, shape (b, k), on the grid."""
    return np.asarray((np.abs(places - _REACH) <= _REACH).all(axis=1))
