"""Non-negative least squares that always ends, at a minimum checked by the Kuhn-Tucker conditions."""

from __future__ import annotations

import numpy as np

from conveyor.arguments.arrays import FloatArray

ROUNDING = float(np.finfo(np.float64).eps)
SLOPE_SLACK = 10.0
"""Slopes within this many roundings of the cancelling terms count as 0 [-]."""


def non_negative_least_squares(matrix: FloatArray, target: FloatArray) -> FloatArray:
    r"""Weights >= 0 of least \|matrix weights - target\|.

    Notes
    -----
    The answer of `scipy.optimize.nnls` is taken where it meets the Kuhn-Tucker conditions to rounding
    (see `largest_slope`). On columns that are nearly dependent, as those of a dense spectrum are, it cycles among
    sets whose
    errors differ by rounding and gives up; there an active set is followed that never returns: a column
    enters only if the error, as computed, falls.

    References
    ----------
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23.

    Examples
    --------
    >>> non_negative_least_squares(np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([2.0, -1.0]))
    array([2., 0.])
    """
    from scipy.optimize import nnls

    try:
        solution = np.asarray(nnls(matrix, target)[0])
    except (RuntimeError, np.linalg.LinAlgError):
        return active_set(matrix, target)
    return solution if largest_slope(matrix, target, solution) <= SLOPE_SLACK * ROUNDING else active_set(matrix, target)


def largest_slope(matrix: FloatArray, target: FloatArray, weights: FloatArray) -> float:
    r"""Violation of the Kuhn-Tucker conditions by weights >= 0: the largest slope that should be 0 [-]."""
    length = _column_lengths(matrix)
    falls = (target - matrix @ weights) @ matrix / length
    steepest = float(np.where(weights > 0.0, np.abs(falls), falls).max())
    size = float(np.sqrt(target @ target) + length @ weights)
    return max(0.0, steepest) / size if size else 0.0


def active_set(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """Follow Lawson and Hanson's active set, with unit columns, as long as the computed error falls.

    Notes
    -----
    A column enters where the error falls along it, but never to a set of columns that was there before: without that
    rounding lets sets whose errors differ by less than it follow each other for ever. An entry that raises the
    error by more than rounding is refused until another column has entered.

    Examples
    --------
    >>> active_set(np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([2.0, -1.0]))
    array([2., 0.])
    """
    length = _column_lengths(matrix)
    columns = np.asfortranarray(matrix / length)
    weights = np.zeros(length.size)
    left, least = target, float(np.linalg.norm(target))
    limit = SLOPE_SLACK * ROUNDING * least
    refused = np.zeros(length.size, dtype=np.bool_)
    known = {(weights > 0.0).tobytes()}
    while True:
        falls = left @ columns
        falls[(weights > 0.0) | refused] = 0.0
        enters = int(np.argmax(falls))
        if falls[enters] <= limit:
            return weights / length
        tried = _enter_column(columns, target, weights, enters)
        error = target - columns @ tried
        size = float(np.linalg.norm(error))
        key = (tried > 0.0).tobytes()
        if key in known or size > least * (1.0 + SLOPE_SLACK * ROUNDING):
            refused[enters] = True
            continue
        known.add(key)
        weights, left, least = tried, error, min(size, least)
        refused[:] = False


def _enter_column(columns: FloatArray, target: FloatArray, weights: FloatArray, enters: int) -> FloatArray:
    """Least squares of the weights > 0 and one more column; weights that fall below 0 leave."""
    from scipy.linalg.lapack import dgels

    at = weights.copy()
    inside = weights > 0.0
    inside[enters] = True
    while inside.any():
        best = np.zeros_like(at)
        best[inside] = dgels(columns[:, inside], target)[1][: np.count_nonzero(inside)]
        below = np.flatnonzero(inside & ~(best > 0.0))
        if not below.size:
            return best
        share = at[below] / (at[below] - best[below])
        at = at + share.min() * (best - at)
        inside[below[share <= share.min()]] = False
        at[~inside] = 0.0
    return at


def _column_lengths(matrix: FloatArray) -> FloatArray:
    """Euclidean length of each column; 1 for a column of zeros, which then has no slope."""
    length = np.sqrt(np.einsum("ij,ij->j", matrix, matrix))
    length[length == 0.0] = 1.0
    return np.asarray(length)
