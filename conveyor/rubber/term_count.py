"""Number of terms and smoothness of the spectrum that the data support, by AICc of penalised fits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import InputError
from conveyor.rubber.fit_rows import ZERO_MODULUS, FitRows, even_times
from conveyor.rubber.non_negative import non_negative_least_squares

DENSITIES = (2.0, 3.0, 4.0, 8.0)
"""Offered terms per decade. Lines d apart in ln(time) ripple by 4 exp(-pi^2/d), 0.08 % at two; twins stand for a line
between them to d^2/8, 1 % of E'' at eight, and are set closer where that shows."""
REACH = 1.0
"""Reach of the times beyond both ends of the window. A line a decade outside stands for all farther ones: they are
a constant and a loss ~ 1/omega on the slow side, a loss ~ omega on the fast one, to 1 % [decades]."""
HALVINGS = 4
"""Halvings of the spacing about the lines of a spectrum of few: 0.018 in ln(time), (0.018)^2/8 = 4e-5."""
UNPENALISED_DENSITY = 8.0
"""Density from which no penalty is offered: a smooth spectrum needs fewer lines [1/decade]."""
STRENGTHS = (0.0, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0)
"""Offered strengths of the penalty; at 10 the spectrum follows E'' smoothed over a decade."""
AICC_SUPPORT = 2.0
"""Candidates within this of the best have substantial support: Burnham & Anderson (2002), section 2.6 [-]."""
AICC_NO_SUPPORT = 10.0
"""Candidates farther than this from the best have essentially none: the same section [-]."""
ROUNDING = 1e-13
"""Relative errors below this are rounding, not information [-]."""
SMOOTHING = 0.5 * np.log(10.0)
"""Standard deviation in ln(frequency) of the smoothing of E'': half a decade."""


@dataclass(frozen=True)
class Candidate:
    """One line of the criterion's table.

    Parameters
    ----------
    terms_per_decade : float
        Density of the relaxation times offered [1/decade].
    regularisation : float
        Strength of the penalty [-].
    terms : int
        Active terms [-].
    freedom : float
        Effective number of fitted parameters, trace of the hat matrix [-].
    residual : float
        Root mean square of the relative errors, E' and E'' together [-].
    score : float
        The corrected Akaike criterion AICc; differences count, below 2 is a tie [-].
    """

    terms_per_decade: float
    regularisation: float
    terms: int
    freedom: float
    residual: float
    score: float


@dataclass(frozen=True, eq=False)
class PenalisedSolution:
    """Moduli of one penalised fit, effective parameters and residual.

    Parameters
    ----------
    moduli : numpy.ndarray
        Equilibrium first, shape `(1 + m,)` [Pa].
    freedom : float
        Trace of the hat matrix [-].
    residual : float
        Root mean square of the relative errors [-].
    """

    moduli: FloatArray
    freedom: float
    residual: float


class PenalisedFit:
    """Penalised fit on given times, factorised once for any penalty and data.

    Parameters
    ----------
    rows : FitRows
        The measurements.
    tau : numpy.ndarray
        Relaxation times, shape `(m,)`, ascending [s].
    held : float or None
        Equilibrium modulus held; fitted without one [Pa].

    Notes
    -----
    Minimised is, over moduli >= 0,

        sum of squared relative errors  +  lambda (N/L) integral (d^2 g/du^2)^2 du,   u = ln tau,

    with N rows of E' and E'' over L = ln(omega_max/omega_min), and g = H/H0: the spectrum over its own
    first estimate H0(tau) = (2/pi) E''(1/tau), E'' smoothed; beyond the window it goes on as a power law, of the
    slope of E'' at its end. So each decade of a spectrum that spans many is smoothed alike, as it would be by a
    penalty on ln H, while the problem stays linear.

    References
    ----------
    J. Honerkamp, J. Weese, Macromolecules 22 (1989) 4372-4377 (regularised spectra).
    N. W. Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989), chapter 4
    (H0, first approximation).
    """

    def __init__(self, rows: FitRows, tau: FloatArray, held: float | None) -> None:
        self.tau, self.held = tau, held
        u = np.log(tau)
        cell = np.gradient(u) if tau.size > 1 else np.ones(1)
        first = (2.0 / np.pi) * _smoothed_loss(rows, tau) * cell
        self.unit = np.concatenate([[float(rows.storage.min())], first])
        matrix = rows.matrix(tau) * self.unit
        self.count = len(matrix)
        self.fixed = matrix[:, 0] * (0.0 if held is None else held / self.unit[0])
        self.columns = matrix if held is None else matrix[:, 1:]
        self.basis, self.triangle = np.linalg.qr(self.columns)
        length = float(np.log(rows.frequency[-1] / rows.frequency[0]))
        bends = _second_derivative(u) * np.sqrt(self.count / length)
        self.bends = np.column_stack([np.zeros(len(bends)), bends]) if held is None else bends
        self.dust = ZERO_MODULUS * float(rows.storage.min()) / self.unit

    def solve(self, target: FloatArray, strength: float, bend: FloatArray | None = None) -> FloatArray:
        """Moduli, equilibrium first, shape `(1 + m,)`, for data over scale `target`, shape `(2n,)` [Pa].

        `bend` is the target of the penalised curvatures, shape `(bends,)`; 0 without it [-].
        """
        return self._solved(target, self._penalised_matrix(strength), bend)

    def _solved(self, target: FloatArray, matrix: FloatArray, bend: FloatArray | None = None) -> FloatArray:
        """Moduli as `solve`, from the matrix of its strength."""
        right = self.basis.T @ (target - self.fixed)
        bend = np.zeros(len(matrix) - right.size) if bend is None else bend[: len(matrix) - right.size]
        solution = non_negative_least_squares(matrix, np.concatenate([right, bend]))
        full = solution if self.held is None else np.concatenate([[self.held / self.unit[0]], solution])
        return np.asarray(np.where(full > self.dust, full, 0.0) * self.unit)

    def leverage(self, moduli: FloatArray, strength: float) -> FloatArray:
        """Diagonal of the hat matrix on the active set, shape `(2n,)` [-]."""
        active = moduli > 0.0 if self.held is None else moduli[1:] > 0.0
        penalty = np.sqrt(strength) * self.bends[:, active]
        factor, _ = np.linalg.qr(np.vstack([self.columns[:, active], penalty]))
        return np.asarray(np.sum(factor[: self.count] ** 2, axis=1))

    def judged(self, target: FloatArray, strength: float) -> PenalisedSolution:
        """Solve, with effective parameters and residual."""
        matrix = self._penalised_matrix(strength)
        moduli = self._solved(target, matrix)
        active = moduli > 0.0 if self.held is None else moduli[1:] > 0.0
        freedom = float(np.count_nonzero(active))
        if strength > 0.0:
            factor, _ = np.linalg.qr(matrix[:, active])
            freedom = float(np.sum(factor[: len(self.triangle)] ** 2))
        weights = moduli / self.unit if self.held is None else (moduli / self.unit)[1:]
        error = self.columns @ weights + self.fixed - target
        return PenalisedSolution(moduli, freedom, float(np.sqrt(np.mean(error**2))))

    def _penalised_matrix(self, strength: float) -> FloatArray:
        if strength == 0.0:
            return self.triangle
        return np.vstack([self.triangle, np.sqrt(strength) * self.bends])


def _smoothed_loss(rows: FitRows, tau: FloatArray) -> FloatArray:
    """E'' at omega = 1/tau, ln E'' smoothed by a Gaussian-weighted mean over ln omega [Pa].

    Beyond the window a power law goes on, of the slope at its end: between 0 and 1 on the slow side, where a loss that
    grew would eat the equilibrium modulus, between -1 and 1 on the fast one.
    """
    x, y = np.log(rows.omega), np.log(rows.loss)
    at = -np.log(tau)
    inside = np.clip(at, x[0], x[-1])
    weights = np.exp(-0.5 * ((x - inside[:, None]) / SMOOTHING) ** 2) * rows.trust[x.size :]
    weights /= weights.sum(axis=1, keepdims=True)
    away = x - (weights @ x)[:, None]
    slope = np.sum(weights * away * y, axis=1) / np.sum(weights * away**2, axis=1)
    slope = np.clip(slope, np.where(at < inside, 0.0, -1.0), 1.0)
    return np.asarray(np.exp(weights @ y + slope * (at - inside)))


def _second_derivative(u: FloatArray) -> FloatArray:
    """Rows whose sum of squares is the integral of (g'')^2 over u, shape `(m - 2, m)`."""
    if u.size < 3:
        return np.zeros((0, u.size))
    step = np.diff(u)
    slopes = np.diff(np.eye(u.size), axis=0) / step[:, None]
    middle = 0.5 * (step[1:] + step[:-1])
    return np.asarray(np.diff(slopes, axis=0) / np.sqrt(middle)[:, None])


def aicc(count: int, freedom: float, residual: float) -> float:
    """Corrected Akaike criterion, ``N [ln s^2 + 1 + 2 (k + 1)/(N - k - 2)]``.

    C. M. Hurvich, J. S. Simonoff, C.-L. Tsai, J. R. Stat. Soc. B 60 (1998) 271-293, Eq. for AICc with k the
    trace of the hat matrix: it chooses the number of terms and the strength of the penalty alike.

    Examples
    --------
    >>> aicc(100, 10.0, 0.01) < aicc(100, 20.0, 0.0099)
    True
    """
    s = max(residual, ROUNDING)
    return float(count * (2.0 * np.log(s) + 1.0 + 2.0 * (freedom + 1.0) / (count - freedom - 2.0)))


def choose_terms(
    rows: FitRows, held: float | None, strengths: tuple[float, ...] = STRENGTHS
) -> tuple[FloatArray, float, tuple[Candidate, ...]]:
    """Choose the fit with the fewest terms that the data support: times [s], strength and table.

    Notes
    -----
    Of all candidates within `AICC_SUPPORT` of the smallest AICc, the one with the fewest active terms is taken,
    among equals the smoothest (fewest effective parameters). Candidates without an equilibrium modulus
    (fluids) count only if all others have essentially no support: a cover is a solid.
    """
    offers: list[_ScoredFit] = []
    for density in DENSITIES:
        tau = even_times(rows.omega, density, REACH)
        problem = PenalisedFit(rows, tau, held)
        for strength in strengths if density < UNPENALISED_DENSITY else strengths[:1]:
            offers += _score_candidate(rows, problem, density, strength)
    if offers and offers[-1][0].regularisation == 0.0:
        offers += _refine_lines(rows, held, offers[-1])
    if not offers:
        raise InputError(
            f"{rows.frequency.size} rows are too few to choose the number of terms: measure more frequencies,"
            " or give terms_per_decade= or times="
        )
    best = min(one[0].score for one in offers)
    solid = [one for one in offers if one[2][0] > 0.0 and one[0].score <= best + AICC_NO_SUPPORT]
    least = min(one[0].score for one in solid or offers)
    supported = [one for one in solid or offers if one[0].score <= least + AICC_SUPPORT]
    chosen = min(supported, key=lambda one: (one[0].terms, one[0].freedom))
    others = sorted((c[0] for c in offers if c is not chosen), key=lambda line: line.score)
    return chosen[1], chosen[0].regularisation, (chosen[0], *others)


_ScoredFit = tuple[Candidate, FloatArray, FloatArray]
"""A candidate, its times [s], and its moduli, equilibrium first [Pa]."""


def _score_candidate(rows: FitRows, problem: PenalisedFit, density: float, strength: float) -> list[_ScoredFit]:
    """Fit and score one candidate; none where the criterion does not exist."""
    target = rows.target
    one = problem.judged(target, strength)
    terms = int(np.count_nonzero(one.moduli[1:]))
    if target.size - one.freedom - 2.0 <= 0.0 or terms == 0:
        return []
    score = aicc(target.size, one.freedom, one.residual)
    return [(Candidate(density, strength, terms, one.freedom, one.residual, score), problem.tau, one.moduli)]


def _refine_lines(rows: FitRows, held: float | None, last: _ScoredFit) -> list[_ScoredFit]:
    """Candidates of halved spacing about the lines of a discrete spectrum, while each is better."""
    offers: list[_ScoredFit] = []
    for _ in range(HALVINGS):
        line, tau, moduli = last
        if 2 * line.terms > tau.size:
            break  # no lines, a spectrum
        near = np.convolve(moduli[1:] > 0.0, np.ones(3), "same") > 0.0
        u = np.log(tau[near])
        step = np.log(10.0) / line.terms_per_decade
        between = 0.5 * (u[1:] + u[:-1])[np.diff(u) < 1.5 * step]
        problem = PenalisedFit(rows, np.exp(np.sort(np.concatenate([u, between]))), held)
        closer = _score_candidate(rows, problem, 2.0 * line.terms_per_decade, 0.0)
        if not closer or closer[0][0].score > line.score - AICC_SUPPORT:
            break
        last = closer[0]
        offers.append(last)
    return offers
