"""All shifts at once: steps to the least-squares minimum against the common curves, and its covariance."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import NoSolutionError
from conveyor.rubber.common_curve import (
    KNOT_SPACING,
    MAX_KNOTS,
    PENALTY_ORDER,
    SmoothCurve,
    Smoother,
    SplineBasis,
    spline_basis,
)
from conveyor.rubber.master_curve import COLD_UNIT, Trend
from conveyor.rubber.misfit import hampel_weights
from conveyor.rubber.overlap import LogIsotherm, shift_limits

ModulusCurves = tuple[SmoothCurve, ...]
"""Common curve of each modulus that counts."""

LOSS = 1
"""Number of E'' among the moduli [-]."""

CHOICE_ROUNDS = 6
"""Rounds in which stiffness, noise and weights are chosen anew; afterwards they stay, so that the objective
is one and its minimum is reached even where isotherms of different shape let the choice wander."""
ROUNDS = 15
"""Rounds in all, each with steps to the minimum."""
STEPS = 15
"""Gauss-Newton steps of a round."""
HALVINGS = 12
"""Halvings of a step that does not descend."""
LONGEST_STEP = 0.5
"""Longest move of an isotherm in one step: the slope of the curve holds about so far [decades]."""
STEP_TOLERANCE = 1.0e-2
"""A step this small against the standard error is the minimum [-]."""
RATE_SCATTER = 0.5
"""Standard deviation, over their mean, of the change of the decades per kelvin from one pair of neighbours to the
next. The law of Williams, Landel and Ferry changes them by a tenth to a fifth in 7 K; a measured slope outweighs this
at once, a curve without slope leaves nothing else [-]."""
LEAST_RATE = 0.005
"""Smallest mean shift for this: an activation energy of 8 kJ/mol, below any rubber's [decades/K]."""
ROUNDING_STEP = 1.0e-9
"""A step this small is rounding [decades]."""
SINGULAR_RATIO = 1.0e-11
"""Smallest eigenvalue, over the largest, of normal equations that can be solved [-]."""
SCATTER_FLOOR = 1.0e-9
"""Scatter of ln E below which the digits of the data, not their noise, are seen [-]."""


@dataclass(frozen=True, eq=False)
class JointMinimum:
    """Shifts at the least-squares minimum.

    Parameters
    ----------
    shift : numpy.ndarray
        log10 a_T of each isotherm, one of them 0, shape `(n,)` [decades].
    offset : numpy.ndarray
        ln b_T of each, shape `(n,)` [-].
    covariance : numpy.ndarray
        Of both, shape `(2n, 2n)` [-].
    held : numpy.ndarray
        Whether the step between neighbours is at the limit of their overlap, shape `(n - 1,)` [-].
    scatter : tuple of float
        Standard deviation of each modulus, ln E, about its curve [-].
    correlation : float
        Largest correlation of residuals of neighbouring rows [-].
    residual : numpy.ndarray
        ln E about its curve, shape `(moduli, m)` [-].
    slope : numpy.ndarray
        Of each trend, in the order asked for: change of ln E'' a decade of measured frequency ("phase"), of ln E'' up
        to the highest one ("lag"), of ln E per 10 K of cold ("cold"), shape `(trends,)` [-].
    slope_covariance : numpy.ndarray
        Of them, shape `(trends, trends)` [-].
    """

    shift: FloatArray
    offset: FloatArray
    covariance: FloatArray
    held: NDArray[np.bool_]
    scatter: tuple[float, ...]
    correlation: float
    residual: FloatArray
    slope: FloatArray
    slope_covariance: FloatArray


@dataclass(frozen=True, eq=False)
class _RoundState:
    """Spacing, stiffness, variance and weights of each modulus in a round; rows whose squares uneven shifts cost."""

    spacing: float
    stiffness: tuple[float, ...]
    variance: FloatArray
    weight: FloatArray
    uneven: FloatArray


class JointShift:
    """Rows of all isotherms, regressed on shifts and a common curve of each modulus.

    Parameters
    ----------
    sheets : list of LogIsotherm
        The isotherms, coldest first.
    moduli : tuple of int
        Those that count: 0 is E', 1 is E'' [-].
    vertical : bool
        Whether ln b_T is fitted [-].
    trends : tuple of {"phase", "lag", "cold"}
        Trends that are fitted besides; "cold" without `vertical` only, which holds it [-].

    Notes
    -----
    The unknowns are the steps between neighbours, cold less hot: log10 a_T of all pairs, then ln b_T; behind them the
    slopes of the trends. A step stays within the limits of `shift_limits`: isotherms of different shape would otherwise
    be torn apart, since without an overlap nothing contradicts.
    """

    def __init__(
        self, sheets: list[LogIsotherm], *, moduli: tuple[int, ...], vertical: bool, trends: tuple[Trend, ...] = ()
    ) -> None:
        self.moduli = moduli
        self.count = len(sheets)
        self.x = np.concatenate([s.x for s in sheets])
        self.y = np.hstack([s.y[list(moduli)] for s in sheets])
        self.of = np.repeat(np.arange(self.count), [s.x.size for s in sheets])
        summed = np.triu(np.ones((self.count, self.count - 1)))
        t = np.array([s.temperature for s in sheets])
        cold = (t[-1] - t) / COLD_UNIT
        zero, no_trend = np.zeros_like(summed), np.zeros(self.count)
        horizontal = [summed, *([zero] if vertical else []), *(no_trend[:, None] for _ in trends)]
        upright = [zero, *([summed] if vertical else []), *((cold * (one == "cold"))[:, None] for one in trends)]
        self.to_isotherms = np.vstack([np.hstack(horizontal), np.hstack(upright)])
        self.to_rows = summed[self.of]
        loss = np.equal(self.moduli, LOSS)[:, None]
        rows = {
            "phase": loss * self.x,
            "lag": loss * 10.0 ** (self.x - self.x.max()),
            "cold": np.ones_like(loss, dtype=float) * cold[self.of],
        }
        self.trends = [rows[one] for one in trends]
        self.vertical = vertical
        others = (self.count - 1 if vertical else 0) + len(trends)
        self.rates = np.pad(np.diag(1.0 / np.diff(t)), ((0, 0), (0, others)))
        limits = np.array([shift_limits(*pair) for pair in pairwise(sheets)])
        free = np.full((others, 2), [-np.inf, np.inf])
        self.lower, self.upper = np.vstack([limits, free]).T

    def minimum(self, start: FloatArray) -> JointMinimum:
        """Solve for steps of log10 a_T and ln b_T between neighbours, stiffness and weights re-estimated each round."""
        steps = start.ravel() if self.vertical else start[0]
        place = np.clip(np.pad(steps, (0, len(self.trends))), self.lower, self.upper)
        share, weight = np.zeros(len(self.y)), np.ones_like(self.y)
        state = self._choose_smoothing(place, weight, share)
        for turn in range(ROUNDS):
            moved, covariance, share, curves = self._descend(place, state)
            far = np.abs(moved - place) > np.maximum(STEP_TOLERANCE * np.sqrt(np.diagonal(covariance)), ROUNDING_STEP)
            place = moved
            if not far.any():
                return self._placed(place, covariance, state, curves)
            if turn < CHOICE_ROUNDS:
                weight = np.array([hampel_weights(c.residual) for c in curves])
                state = self._choose_smoothing(place, weight, share)
        raise NoSolutionError(
            f"the shifts do not settle in {ROUNDS} rounds: the isotherms do not determine them; look for one"
            " that is flat or of another shape, and leave it out"
        )

    def score(self, place: FloatArray, residual: FloatArray) -> float:
        """Rao's score of trial steps: chi squared, the fall of the cost in its quadratic approximation.

        References
        ----------
        C. R. Rao, Proc. Camb. Phil. Soc. 44 (1948) 50-57.
        """
        state = self._choose_smoothing(
            place, np.array([hampel_weights(one) for one in residual]), np.zeros(len(self.y))
        )
        rows, downward = self._regression(place, *self._fit(place, state), state)
        return float(downward @ _invert_normal_matrix(_normal_matrix(rows)) @ downward)

    def _choose_smoothing(self, place: FloatArray, weight: FloatArray, share: FloatArray) -> _RoundState:
        x, y = self._moved(place)
        spacing = max(KNOT_SPACING, float(np.ptp(x)) / MAX_KNOTS)
        splines = spline_basis(x, spacing)
        smoothers = [Smoother(splines, one, w) for one, w in zip(y, weight, strict=True)]
        best = tuple(s.best_stiffness() for s in smoothers)
        cost = np.array([s.curve(b).cost for s, b in zip(smoothers, best, strict=True)])
        freedom = np.maximum(weight.sum(axis=1) - PENALTY_ORDER - share, 1.0)
        rates = self.rates @ place
        uneven = np.diff(self.rates, axis=0) / (RATE_SCATTER * max(float(np.mean(np.abs(rates))), LEAST_RATE))
        return _RoundState(spacing, best, np.maximum(cost / freedom, SCATTER_FLOOR**2), weight, uneven)

    def _descend(
        self, place: FloatArray, state: _RoundState
    ) -> tuple[FloatArray, FloatArray, FloatArray, ModulusCurves]:
        """Projected Gauss-Newton steps; place, covariance, effective parameters of each modulus, curves."""
        splines, curves = self._fit(place, state)
        for _ in range(STEPS):
            rows, downward = self._regression(place, splines, curves, state)
            held = ((place <= self.lower) & (downward < 0.0)) | ((place >= self.upper) & (downward > 0.0))
            move = np.zeros_like(place)
            free = ~held
            whole = _normal_matrix(rows)
            inner = _invert_normal_matrix(whole[np.ix_(free, free)])
            move[free] = inner @ downward[free]
            move /= max(1.0, float(np.max(np.abs(move))) / LONGEST_STEP)
            small = np.maximum(STEP_TOLERANCE * np.sqrt(np.diagonal(inner)) / 2.0, ROUNDING_STEP)
            if np.all(np.abs(move[free]) <= small):
                break
            before = _total_cost(place, curves, state)
            for halving in range(HALVINGS):
                trial = np.clip(place + move / 2.0**halving, self.lower, self.upper)
                splines, curves = self._fit(trial, state)
                if _total_cost(trial, curves, state) < before:
                    place = trial
                    break
            else:
                splines, curves = self._fit(place, state)
                break
        inverse = _invert_normal_matrix(whole)
        wide = [_variance_widening(c.residual * np.sqrt(w), self.of) for c, w in zip(curves, state.weight, strict=True)]
        spread = [one @ inverse * np.sqrt(f) for one, f in zip(rows, [*wide, 1.0], strict=True)]
        covariance = _normal_matrix(spread)
        share = np.array([float(np.sum((one @ inverse) * one)) for one in rows[:-1]])
        return place, covariance, share, curves

    def _regression(
        self, place: FloatArray, splines: SplineBasis, curves: ModulusCurves, state: _RoundState
    ) -> tuple[list[FloatArray], FloatArray]:
        """Rows of the steps for each modulus, curves eliminated, and for unevenness; downward gradient.

        The product of the rows with themselves is the normal matrix. Formed as a difference of two matrices it is not
        positive where a direction is hardly determined: G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973)
        413-432, project the rows instead.
        """
        rows, downward = [], -(place @ state.uneven.T @ state.uneven)
        of_each = zip(curves, state.weight, state.stiffness, state.variance, strict=True)
        for row, (one, weight, stiffness, variance) in enumerate(of_each):
            across = one.slope[:, None] * self.to_rows
            columns = np.hstack([across, self.to_rows]) if self.vertical else across
            columns = np.column_stack([columns, *(trend[row] for trend in self.trends)])
            weighted = weight[:, None] * columns
            along = one.solve(splines.matrix.T @ weighted)
            apart = np.sqrt(weight)[:, None] * (columns - splines.matrix @ along)
            bends = 10.0 ** (stiffness / 2.0) * np.diff(along, PENALTY_ORDER, axis=0)
            rows.append(np.vstack([apart, bends]) / np.sqrt(variance))
            downward += weighted.T @ one.residual / variance
            turning = weight * np.sum(splines.slope * one.solve(splines.matrix.T).T, axis=1)
            downward[: self.count - 1] -= turning @ self.to_rows
        return [*rows, state.uneven], downward

    def _fit(self, place: FloatArray, state: _RoundState) -> tuple[SplineBasis, ModulusCurves]:
        x, y = self._moved(place)
        splines = spline_basis(x, state.spacing)
        rows = zip(y, state.weight, state.stiffness, strict=True)
        return splines, tuple(Smoother(splines, one, w).curve(stiffness) for one, w, stiffness in rows)

    def _moved(self, place: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Reduced frequency and moduli at a place."""
        steps = self.count - 1
        x, y = self.x + self.to_rows @ place[:steps], self.y
        if self.vertical:
            y = y - self.to_rows @ place[steps : 2 * steps]
        for slope, trend in zip(place[place.size - len(self.trends) :], self.trends, strict=True):
            y = y - slope * trend
        return x, y

    def _placed(
        self, place: FloatArray, covariance: FloatArray, state: _RoundState, curves: ModulusCurves
    ) -> JointMinimum:
        n, behind = self.count, place.size - len(self.trends)
        each = self.to_isotherms @ place
        at_limit = (place <= self.lower) | (place >= self.upper)
        return JointMinimum(
            shift=each[:n],
            offset=each[n:],
            covariance=self.to_isotherms @ covariance @ self.to_isotherms.T,
            held=at_limit[: n - 1],
            scatter=tuple(np.sqrt(state.variance).tolist()),
            correlation=max(_isotherm_correlation(c.residual, self.of) for c in curves),
            residual=np.array([c.residual for c in curves]),
            slope=place[behind:],
            slope_covariance=covariance[behind:, behind:],
        )


def _total_cost(place: FloatArray, curves: ModulusCurves, state: _RoundState) -> float:
    fitted = sum(c.cost / v + c.occam for c, v in zip(curves, state.variance, strict=True))
    return float(fitted + np.sum((state.uneven @ place) ** 2))


def _isotherm_correlation(residual: FloatArray, of: NDArray[np.intp]) -> float:
    """Correlation of neighbouring rows of the same isotherm [-]."""
    total = float(residual @ residual)
    same = of[1:] == of[:-1]
    return float((residual[1:] * residual[:-1])[same].sum()) / total if total > 0.0 else 0.0


def _variance_widening(residual: FloatArray, of: NDArray[np.intp]) -> float:
    """Variance of a mean of correlated rows over that of independent ones [-]."""
    c = _isotherm_correlation(residual, of)
    return (1.0 + c) / (1.0 - c) if c > 2.0 / np.sqrt(residual.size) else 1.0


def _normal_matrix(rows: list[FloatArray]) -> FloatArray:
    whole = np.vstack(rows)
    return np.asarray(whole.T @ whole)


def _invert_normal_matrix(matrix: FloatArray) -> FloatArray:
    """Inverse of the normal matrix, refused where a combination of shifts is not determined."""
    scale = np.sqrt(np.diagonal(matrix))
    if not np.all(scale > 0.0):
        raise NoSolutionError(UNDETERMINED_SHIFTS)
    values, vectors = np.linalg.eigh(matrix / np.outer(scale, scale))
    if values[0] < SINGULAR_RATIO * values[-1]:
        raise NoSolutionError(UNDETERMINED_SHIFTS)
    return np.asarray((vectors / values) @ vectors.T / np.outer(scale, scale))


UNDETERMINED_SHIFTS = (
    "the isotherms do not determine their shifts: a curve without slope can be moved sideways, and with"
    " vertical=True a straight line in log-log along itself; leave such isotherms out, or vertical=False"
)
