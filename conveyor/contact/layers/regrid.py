"""Weights of scattered places moved to a grid, so that sums over the places are products with tables on the grid.

Σ_k w_k f(x_k) = Σ_g W_g f(x_g) where f is smooth: the weight of each place is spread over the 16 grid points about it
by Lagrange interpolation. The table f(x_g) is computed once for all problems.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Stencils = tuple[NDArray[np.int_], Array]

STENCIL_POINTS = 16
POINTS_BEFORE = STENCIL_POINTS // 2 - 1
"""Grid points before place 0 that a stencil there reaches."""
_STENCIL_INDEX = np.arange(STENCIL_POINTS)[:, None, None]
# ln b = 2 + 5 sinh x in steps of 0.02: a tenth in the middle, where functions of ln b are analytic within π/2 of the
# real axis only, more where they fall like b or 1/b (seen: 4e-13 of functions below one)
_STEP, _MIDDLE, _SCALE, _REACH = 0.02, 2.0, 5.0, 130  # to both sides: b from 2e-14 to 2e15
LOG_GRID_SIZE = 2 * _REACH + STENCIL_POINTS
"""Points of the grid of ln b."""


@lru_cache(maxsize=1)
def _lagrange_powers() -> Array:
    """Coefficients of Π (x - x_j)/(x_i - x_j) in powers of x, counted from the stencil's middle.

    Each is exact to rounding: the inverse of a Vandermonde matrix is not.
    """
    x = np.arange(STENCIL_POINTS) - 0.5 * (STENCIL_POINTS - 1)
    others = [np.delete(x, i) for i in range(STENCIL_POINTS)]
    return np.array([np.poly(rest)[::-1] / np.prod(here - rest) for here, rest in zip(x, others, strict=True)])


def lagrange_stencils(place: Array) -> Stencils:
    """First points and weights (16, b, k) of places of shape (b, k), in grid steps from point `POINTS_BEFORE`."""
    first = np.floor(place)
    powers = np.empty((STENCIL_POINTS, *place.shape))
    powers[0] = 1.0
    np.subtract(place, first + 0.5, out=powers[1])
    for known in (2, 4, 8):
        np.multiply(powers[:known], powers[1] * powers[known - 1], out=powers[known : 2 * known])
    shares = _lagrange_powers() @ powers.reshape(STENCIL_POINTS, -1)
    return first.astype(int), shares.reshape(powers.shape)


def regrid_weights(at: Stencils, size: int, *weights: Array) -> list[Array]:
    """Weights, each of shape (b, k), moved to a grid of `size` points, shape (b, size)."""
    first, shares = at
    rows = first.shape[0]
    index = (_STENCIL_INDEX + (first + size * np.arange(rows)[:, None])).ravel()
    grids = (np.bincount(index, (each * shares).ravel(), rows * size) for each in weights)
    return [np.asarray(grid, dtype=np.float64).reshape(rows, size) for grid in grids]


def log_grid() -> Array:
    """Arguments b of the grid of ln b, shape (LOGS,)."""
    steps = np.arange(LOG_GRID_SIZE) - (_REACH + POINTS_BEFORE)
    b: Array = np.exp(_MIDDLE + _SCALE * np.sinh(_STEP * steps))
    return b


def log_places(b: Array) -> Array:
    """Places of arguments b on the grid of ln b."""
    places: Array = np.arcsinh((np.log(b) - _MIDDLE) / _SCALE) / _STEP + _REACH
    return places


def within_log_grid(places: Array) -> NDArray[np.bool_]:
    """True for rows whose `log_places`, shape (b, k), all lie on the grid."""
    return np.asarray((np.abs(places - _REACH) <= _REACH).all(axis=1))
