"""The master curve as penalised splines, their stiffness by restricted likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from conveyor.arguments.arrays import FloatArray

SPLINE_DEGREE = 3
"""Cubic: continuous curvature, so that the slope, which places an isotherm, is smooth."""
PENALTY_ORDER = 3
"""Order of the penalised differences: a parabola in log-log is free, and bends cost."""
KNOT_SPACING = 0.2
"""Distance of the knots [decades]. A Debye peak in ln E'' has a fourth derivative below 50 per decade^4:
the best cubic spline misses it by less than 0.2^4/384 * 50 = 2e-4."""
MAX_KNOTS = 300
"""Above 60 decades the knots are set farther apart."""
STIFFNESS = np.arange(-7.0, 7.01, 1.0)
"""Offered log10 of the stiffness; beyond the lower end the curve interpolates, beyond the upper it is a
parabola."""
STIFFNESS_REFINEMENT = np.array([-0.5, -0.25, 0.0, 0.25, 0.5])
"""Refinement about the best of `STIFFNESS`: the likelihood is flat over such steps."""

LN10 = float(np.log(10.0))


@dataclass(frozen=True, eq=False)
class SplineBasis:
    """Cubic B-splines on knots at whole multiples of a spacing, so that a shift moves data, not knots.

    Parameters
    ----------
    knots : numpy.ndarray
        Shape `(k + 4,)` [decades].
    matrix : numpy.ndarray
        Values at the data, shape `(n, k)` [-].
    slope : numpy.ndarray
        First derivatives at the data, shape `(n, k)` [1/decade].
    penalty : numpy.ndarray
        Lower diagonals of the squared third differences, shape `(4, k)` [-].
    """

    knots: FloatArray
    matrix: FloatArray
    slope: FloatArray
    penalty: FloatArray


def spline_basis(x: FloatArray, spacing: float) -> SplineBasis:
    """Splines over log10 of the reduced frequency, shape `(n,)`, with knots at a distance [decades].

    On even knots the four splines that are not 0 in an interval are polynomials of the place in it: C. de Boor,
    A Practical Guide to Splines (1978), chapter X. SciPy's take longer to import than all of this takes.
    """
    first, last = int(np.floor(x.min() / spacing)), int(np.floor(x.max() / spacing)) + 1
    knots = spacing * np.arange(first - SPLINE_DEGREE, last + SPLINE_DEGREE + 1, dtype=np.float64)
    count = knots.size - SPLINE_DEGREE - 1
    interval = np.floor(x / spacing).astype(np.intp)
    t = x / spacing - interval
    values = np.array([(1.0 - t) ** 3, 3.0 * t**3 - 6.0 * t**2 + 4.0, 1.0 + 3.0 * (t + t**2 - t**3), t**3]) / 6.0
    slopes = np.array([-((1.0 - t) ** 2), 3.0 * t**2 - 4.0 * t, 1.0 + 2.0 * t - 3.0 * t**2, t**2]) / (2.0 * spacing)
    matrix, slope = np.zeros((x.size, count)), np.zeros((x.size, count))
    place = np.arange(x.size), interval - first + np.arange(SPLINE_DEGREE + 1)[:, None]
    matrix[place], slope[place] = values, slopes
    bends = np.asarray(np.diff(np.eye(count), PENALTY_ORDER, axis=0), dtype=np.float64)
    return SplineBasis(knots, matrix, slope, _lower_diagonals(bends, bends))


@dataclass(frozen=True, eq=False)
class SmoothCurve:
    """One smooth curve through one modulus of all isotherms.

    Parameters
    ----------
    factor : numpy.ndarray
        Banded Cholesky factor of the penalised normal equations, shape `(4, k)` [-].
    residual : numpy.ndarray
        Data less curve, shape `(n,)` [-].
    slope : numpy.ndarray
        Slope of the curve at the data, shape `(n,)` [1/decade].
    cost : float
        Weighted sum of squares and penalty [-].
    occam : float
        log determinant of the penalised normal equations over that of the penalty: what a curve that bends
        more, or is longer, could have fitted besides [-].
    """

    factor: FloatArray
    residual: FloatArray
    slope: FloatArray
    cost: float
    occam: float

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve the penalised normal equations, right side shape `(k,)` or `(k, m)` [-]."""
        from scipy.linalg import cho_solve_banded

        return np.asarray(cho_solve_banded((self.factor, True), right))


class Smoother:
    """Rows of one modulus on given splines, for any stiffness.

    Parameters
    ----------
    splines : SplineBasis
        Splines at the data.
    y : numpy.ndarray
        ln of the modulus, shape `(n,)` [-].
    weight : numpy.ndarray
        Weight of each row, shape `(n,)` [-].
    """

    def __init__(self, splines: SplineBasis, y: FloatArray, weight: FloatArray) -> None:
        self.splines, self.weight = splines, weight
        self.y = y - np.mean(y)  # constants are free of penalty; without the mean fewer digits are lost
        b = splines.matrix
        weighted = weight[:, None] * b
        self.normal = _lower_diagonals(b, weighted)
        self.penalty = splines.penalty
        self.right = weighted.T @ self.y

    def curve(self, stiffness: float) -> SmoothCurve:
        """Fit at a stiffness, log10 of the factor on the penalty [-]."""
        from scipy.linalg import cho_solve_banded, cholesky_banded

        splines, strength = self.splines, 10.0**stiffness
        factor = cholesky_banded(self.normal + strength * self.penalty, lower=True)
        coefficients = cho_solve_banded((factor, True), self.right)
        residual = self.y - splines.matrix @ coefficients
        bends = np.diff(coefficients, PENALTY_ORDER)
        cost = float(self.weight @ residual**2 + strength * bends @ bends)
        determinant = 2.0 * float(np.sum(np.log(factor[0])))
        occam = determinant - (coefficients.size - PENALTY_ORDER) * LN10 * stiffness
        return SmoothCurve(factor, residual, splines.slope @ coefficients, cost, occam)

    def likelihood(self, stiffness: float) -> float:
        """-2 log of the restricted likelihood at a stiffness, up to a constant [-]."""
        one = self.curve(stiffness)
        free = self.y.size - PENALTY_ORDER
        return free * float(np.log(max(one.cost, np.finfo(np.float64).tiny))) + one.occam

    def best_stiffness(self) -> float:
        """Stiffness of highest restricted likelihood: log10 of the factor on the penalty [-].

        G. Wahba, Ann. Statist. 13 (1985) 1378-1402 (generalised maximum likelihood); P. H. C. Eilers,
        B. D. Marx, Statist. Sci. 11 (1996) 89-121 (penalised B-splines).
        """
        coarse = STIFFNESS[int(np.argmin([self.likelihood(float(s)) for s in STIFFNESS]))]
        near = coarse + STIFFNESS_REFINEMENT
        return float(near[int(np.argmin([self.likelihood(float(s)) for s in near]))])


def _lower_diagonals(left: FloatArray, right: FloatArray) -> FloatArray:
    """Lower diagonals of left^T right, of bandwidth 3, shape `(4, k)`; only those are formed."""
    size = left.shape[1]
    lower = np.zeros((SPLINE_DEGREE + 1, size))
    for d in range(SPLINE_DEGREE + 1):
        lower[d, : size - d] = np.einsum("ij,ij->j", right[:, : size - d], left[:, d:])
    return lower
