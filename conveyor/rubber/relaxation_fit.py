"""Prony series from a relaxation curve E(t): non-negative least squares on relative errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber.arrays import FloatArray, positive, positive_vector
from conveyor.rubber.non_negative import non_negative
from conveyor.rubber.prony import PronySeries

TERMS_PER_DECADE = 2.0
"""Lines d apart in ln(time) give E'' a ripple of about 4 exp(-pi^2/d): 5.5 % at one a decade, 0.08 % at two
[1/decade]."""
FLOOR_TERMS_PER_DECADE = 10.0
FLOOR_EXTRA_DECADES = 3.0
"""Density and reach of the densest spectrum, as in `fit_prony`."""
DUST = 1.0e-12
"""NNLS may return zero as rounding, 1e-16; no data resolve a modulus this far below the smallest E(t)."""


@dataclass(frozen=True)
class RelaxationMisfit:
    """Relative errors of E(t), series over data minus one.

    Parameters
    ----------
    rms : float
        Root mean square [-].
    worst : float
        Largest in magnitude, with its sign [-].
    worst_time : float
        Time of that row [s].
    """

    rms: float
    worst: float
    worst_time: float


@dataclass(frozen=True)
class RelaxationFit:
    """A fitted series and how well it fits.

    Parameters
    ----------
    series : PronySeries
        The fit, at the temperature of the data [Pa, s].
    misfit : RelaxationMisfit
        Of E(t) [-].
    window : tuple of float
        Shortest and longest measured time: the series says nothing outside [s].
    grid_terms : int
        Terms offered; `active_terms` is what the data took [-].
    floor : float
        Root mean square error of the best of ALL completely monotone curves (positive spectra): no series is
        closer, so this much is noise, or a curve that was not one material state [-].
    """

    series: PronySeries
    misfit: RelaxationMisfit
    window: tuple[float, float]
    grid_terms: int
    floor: float

    @property
    def active_terms(self) -> int:
        """Number of terms the fit kept [-]."""
        return int(self.series.times.size)


def fit_relaxation(
    time: ArrayLike,
    modulus: ArrayLike,
    *,
    terms_per_decade: float | None = None,
    times: ArrayLike | None = None,
    equilibrium: float | None = None,
) -> RelaxationFit:
    """Fit a Prony series to a relaxation modulus.

    Parameters
    ----------
    time : array_like
        Time since the step of strain, shape `(n,)`, any order [s].
    modulus : array_like
        E(t) at them, shape `(n,)` [Pa].
    terms_per_decade : float, optional
        Density of the relaxation times, spread evenly in log from the first to the last time; two when left
        out [1/decade].
    times : array_like, optional
        Relaxation times to use instead, shape `(m,)`, from the first to the last time [s].
    equilibrium : float, optional
        Equilibrium modulus to hold, below every E(t); fitted when left out [Pa].

    Returns
    -------
    RelaxationFit
        The series and its statistics.

    Raises
    ------
    InputError
        If a value is not finite and > 0, lengths differ, there are fewer than two distinct times,
        `equilibrium` is not below every E(t), `times` leave the window, or both times and their density are given.
    NoSolutionError
        If the best equilibrium modulus is 0, or no term is active.

    Notes
    -----
    Minimised is the sum of squared RELATIVE errors with all moduli >= 0. Times never leave the window. Rows of
    equal time are separate measurements.

    What has relaxed before the first time is not in the data: the glassy modulus of the series is E at the
    first time, no more, and its E' and E'' hold up to about 1/(first time). A relaxation curve tells the loss
    modulus less well than a frequency sweep does: E'' is about the slope of E(t), one per cent of E(t) is many
    per cent of a small E''.

    References
    ----------
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23 (NNLS).

    Examples
    --------
    >>> truth = PronySeries(1e6, [2e6, 5e6], [1.0, 10.0])
    >>> t = np.logspace(0, 3, 31)
    >>> fit = fit_relaxation(t, truth.relaxation(t))
    >>> fit.active_terms, fit.misfit.rms < 1e-12
    (2, True)
    """
    t, e = positive_vector("time", time, "s"), positive_vector("modulus", modulus, "Pa")
    if t.shape != e.shape or np.unique(t).size < 2:
        raise InputError(
            f"a fit needs one modulus per time and >= 2 distinct times; got {e.size} and {t.size}"
        )
    held = None if equilibrium is None else _held(equilibrium, e)
    order = np.argsort(t, kind="stable")
    t, e = t[order], e[order]
    tau = _asked(t, terms_per_decade, times)
    moduli = _solve(t, e, tau, held)
    active = moduli[1:] > 0.0
    if not moduli[0] > 0.0:
        raise NoSolutionError(
            "the best equilibrium modulus is 0 (a fluid): E(t) still falls at the last time; measure longer or"
            " hotter, or hold it with equilibrium=<measured value in Pa>"
        )
    if not active.any():
        raise NoSolutionError("no relaxation time fits: E(t) does not fall with time")
    series = PronySeries(float(moduli[0]), moduli[1:][active], tau[active])
    dense = _times(t, FLOOR_TERMS_PER_DECADE, FLOOR_EXTRA_DECADES)
    floor = _matrix(t, e, dense) @ _solve(t, e, dense, None) - 1.0
    return RelaxationFit(
        series=series,
        misfit=relaxation_misfit(series, t, e),
        window=(float(t[0]), float(t[-1])),
        grid_terms=int(tau.size),
        floor=float(np.sqrt(np.mean(floor**2))),
    )


def relaxation_misfit(series: PronySeries, time: ArrayLike, modulus: ArrayLike) -> RelaxationMisfit:
    """How far any series is from a relaxation curve.

    Parameters
    ----------
    series : PronySeries
        The series to judge [Pa, s].
    time : array_like
        Time since the step of strain, shape `(n,)` [s].
    modulus : array_like
        Measured E(t), shape `(n,)` [Pa].

    Returns
    -------
    RelaxationMisfit
        Root mean square and worst relative error.

    Raises
    ------
    InputError
        If a value is not finite and > 0, or lengths differ.

    Examples
    --------
    >>> relaxation_misfit(PronySeries(1e6, [1e6], [1.0]), [1e9], [2e6]).worst
    -0.5
    """
    t, e = positive_vector("time", time, "s"), positive_vector("modulus", modulus, "Pa")
    if t.shape != e.shape or t.size == 0:
        raise InputError(f"time and modulus must have one length, >= 1; got {t.size} and {e.size}")
    error = series.relaxation(t) / e - 1.0
    k = int(np.argmax(np.abs(error)))
    return RelaxationMisfit(float(np.sqrt(np.mean(error**2))), float(error[k]), float(t[k]))


def _held(equilibrium: float, e: FloatArray) -> float:
    value = positive("equilibrium", equilibrium, "Pa")
    if value >= e.min():
        raise InputError(f"equilibrium = {value:g} Pa must be below the smallest modulus, {e.min():g} Pa")
    return value


def _asked(t: FloatArray, density: float | None, times: ArrayLike | None) -> FloatArray:
    if times is None:
        per_decade = TERMS_PER_DECADE if density is None else density
        return _times(t, positive("terms_per_decade", per_decade, "1/decade"), 0.0)
    if density is not None:
        raise InputError("give times or terms_per_decade, not both")
    tau = np.unique(positive_vector("times", times, "s"))
    outside = tau[(tau < t[0]) | (tau > t[-1])]
    if outside.size:
        raise InputError(
            f"relaxation time {outside[0]:g} s is outside the measured window {t[0]:g} to {t[-1]:g} s: nothing"
            " measured determines its modulus"
        )
    return tau


def _times(t: FloatArray, density: float, extra: float) -> FloatArray:
    low, high = np.log10(t[0]) - extra, np.log10(t[-1]) + extra
    return np.logspace(low, high, max(2, round((high - low) * density) + 1))


def _matrix(t: FloatArray, e: FloatArray, tau: FloatArray) -> FloatArray:
    """Equilibrium and terms over the data, shape `(n, 1 + m)` [1/Pa]."""
    return np.column_stack([np.ones_like(t), np.exp(-t[:, None] / tau)]) / e[:, None]


def _solve(t: FloatArray, e: FloatArray, tau: FloatArray, held: float | None) -> FloatArray:
    """Moduli of least relative squares, equilibrium first, shape `(1 + m,)` [Pa]."""
    unit = float(e.min())
    matrix = _matrix(t, e, tau) * unit
    ones = np.ones_like(t)
    if held is None:
        found = non_negative(matrix, ones)
    else:
        rest = non_negative(matrix[:, 1:], ones - matrix[:, 0] * (held / unit))
        found = np.concatenate([[held / unit], rest])
    return np.asarray(np.where(found > DUST, found, 0.0) * unit)
