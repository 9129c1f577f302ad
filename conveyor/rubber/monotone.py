"""Piecewise cubic through points, monotone wherever they are."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray


class MonotoneCubic:
    """Cubic Hermite interpolant whose slopes never overshoot (PCHIP).

    Interior slopes are weighted harmonic means of the neighbouring secants, zero where these differ in sign; at the
    ends three-point formulas, limited so that the interpolant stays monotone. That of SciPy takes longer to import than
    an analysis takes.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places, ascending, n ≥ 2.
    y : ndarray, shape (n,)
        Values there.

    References
    ----------
    F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304.

    Examples
    --------
    >>> MonotoneCubic(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))([0.5, 1.5]).tolist()
    [0.6875, 1.0]
    """

    def __init__(self, x: FloatArray, y: FloatArray) -> None:
        self._x, self._y = x, y
        step, secant = np.diff(x), np.diff(y) / np.diff(x)
        slope = np.full(x.size, secant[0])
        if x.size > 2:
            left, right = step[1:] + 2.0 * step[:-1], 2.0 * step[1:] + step[:-1]
            rising = secant[:-1] * secant[1:] > 0.0
            safe = np.where(rising, secant[:-1], 1.0), np.where(rising, secant[1:], 1.0)
            slope[1:-1] = np.where(rising, (left + right) / (right / safe[0] + left / safe[1]), 0.0)
            slope[0] = _end_slope(step[0], step[1], secant[0], secant[1])
            slope[-1] = _end_slope(step[-1], step[-2], secant[-1], secant[-2])
        self._slope = slope

    def __call__(self, at: ArrayLike) -> FloatArray:
        """Values at places between the first and the last, shape of `at`."""
        at = np.asarray(at, dtype=float)
        i = np.minimum(np.maximum(np.searchsorted(self._x, at, side="right"), 1), self._x.size - 1) - 1
        low, base = self._x[i], self._y[i]
        step, rise = self._x[i + 1] - low, self._y[i + 1] - base
        t = (at - low) / step
        first, last = step * self._slope[i], step * self._slope[i + 1]
        return np.asarray(base + t * (first + t * (3.0 * rise - 2.0 * first - last + t * (first + last - 2.0 * rise))))


def _end_slope(near: float, far: float, secant: float, next_secant: float) -> float:
    """Slope at an end from the steps and secants next to it."""
    slope = ((2.0 * near + far) * secant - near * next_secant) / (near + far)
    if slope * secant <= 0.0:
        return 0.0
    return 3.0 * secant if secant * next_secant < 0.0 and abs(slope) > 3.0 * abs(secant) else slope
