"""Convert a relaxation curve to the equivalent frequency sweep."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray, positive_vector
from conveyor.errors import InputError
from conveyor.rubber.fit_rows import FitRows, debye_kernel, even_times
from conveyor.rubber.non_negative import non_negative_least_squares
from conveyor.rubber.term_count import PenalisedFit, choose_terms

LINES_PER_DECADE = 2.0
"""Density of the first estimate: E'' ripples by 0.08 % (`conveyor.rubber.fit_prony`) [1/decade]."""
MARGIN = 1.0
"""Window cut at both ends: a line a decade beyond an end adds a tenth of its modulus to E'' there [decades]."""
ROWS_PER_DECADE = 6.0
"""Rows of the sweep, as instruments measure (general knowledge) [1/decade]."""
LEAST_DECADES = 2.5
"""Least span of time: half a decade of frequency remains, four rows [decades]."""


def equivalent_sweep(time: ArrayLike, modulus: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
    """E' and E'' that a relaxation modulus implies, a decade inside its window.

    Parameters
    ----------
    time : array_like
        Since the step of strain, shape `(n,)`, any order [s].
    modulus : array_like
        E(t) at them, shape `(n,)` [Pa].

    Returns
    -------
    tuple of numpy.ndarray
        Cyclic frequency, ascending [Hz], E' and E'' [Pa], each of shape `(m,)`.

    Raises
    ------
    InputError
        A value is not finite and > 0, lengths differ, or the times span less than 2.5 decades.

    Notes
    -----
    A series is fitted to E(t), relative errors, moduli >= 0, its times and the penalty on its curvature chosen as those
    of a frequency sweep (`conveyor.rubber.term_count.choose_terms`), and evaluated at omega = 1/t (Park and Schapery
    1999, by
    a Prony series). One per cent of E(t) is many per cent of a small E'': of a tan delta of 0.2 two, of one of 0.05
    eight. The rows are no independent measurements: they carry the smoothness of the series.

    References
    ----------
    S. W. Park, R. A. Schapery, Int. J. Solids Struct. 36 (1999) 1653-1675.

    Examples
    --------
    >>> from conveyor.rubber import PronySeries
    >>> truth = PronySeries(1e6, np.full(25, 1e5), np.logspace(-6, 6, 25))
    >>> t = np.logspace(-2, 3, 51)
    >>> f, storage, loss = equivalent_sweep(t, truth.relaxation(t))
    >>> bool(np.max(np.abs(loss / truth.loss(2 * np.pi * f) - 1)) < 0.1)
    True
    """
    t, e = positive_vector("time", time, "s"), positive_vector("modulus", modulus, "Pa")
    if t.size != e.size:
        raise InputError(f"relaxation: one modulus a time is needed; got {t.size} times, {e.size} moduli")
    low, high = np.log10(t.min()), np.log10(t.max())
    if high - low < LEAST_DECADES:
        raise InputError(
            f"relaxation over {high - low:.2g} decades of time; {LEAST_DECADES:g} are needed, as a decade at either "
            "end says nothing certain of E' and E''"
        )
    order = np.argsort(-t, kind="stable")
    rows = _RelaxationRows.of(t[order], e[order])
    tau, strength, _ = choose_terms(rows, None)
    solution = PenalisedFit(rows, tau, None).solve(rows.target, strength)
    inside = high - low - 2.0 * MARGIN
    omega = np.logspace(MARGIN - high, -low - MARGIN, round(ROWS_PER_DECADE * inside) + 1)
    storage, loss = np.split(debye_kernel(omega, tau) @ solution, 2)
    return omega / (2.0 * np.pi), storage, loss


class _RelaxationRows(FitRows):
    """E(t) as rows of a fit, each at omega = 1/t; `loss` is a first estimate of E'' there."""

    @classmethod
    def of(cls, t: FloatArray, e: FloatArray) -> _RelaxationRows:
        """Rows of times that fall [s] and E(t) [Pa]."""
        frequency, scale, trust = 0.5 / (np.pi * t), np.concatenate([e, e]), np.ones(2 * t.size)
        plain = cls(frequency, e, e, scale, trust)
        tau = even_times(plain.omega, LINES_PER_DECADE)
        unit = float(e.min())
        loss = (
            debye_kernel(plain.omega, tau)[t.size :]
            @ non_negative_least_squares(plain.matrix(tau) * unit, plain.target)
            * unit
        )
        if not np.all(loss > 0.0):
            raise InputError("relaxation: E(t) does not fall, no loss modulus follows from it")
        return cls(frequency, e, loss, scale, trust)

    @property
    def target(self) -> FloatArray:
        return np.ones(self.frequency.size)

    def matrix(self, tau: FloatArray) -> FloatArray:
        decays = np.exp(-np.outer(1.0 / self.omega, 1.0 / tau))
        return np.column_stack([np.ones_like(self.omega), decays]) / self.storage[:, None]
