"""Kramers-Kronig test: E' and E'' each predicted from the other."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import InputError
from conveyor.rubber.fit_rows import FitRows, checked_rows, debye_kernel, even_times
from conveyor.rubber.misfit import Misfit, relative_misfit
from conveyor.rubber.term_count import PenalisedFit, aicc

LINES_PER_DECADE = 4.0
"""Lines d apart in ln(time) ripple by 4 exp(-pi^2/d): here 1e-7 for a smooth spectrum. A spectrum of few sharp
lines is met to d^2/8 = 4 % of E'' only: rubbers have none [1/decade]."""
REACH = 2.0
"""Reach of lines beyond both ends of the window: farther ones are a constant or nothing to 1e-4 [decades]."""
MARGIN = 1.0
"""Ends of the window that are not judged: a line a decade outside, unseen by the data, moves E'' there by a tenth of
its modulus [decades]."""
STRENGTHS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0)
"""Offered penalties on the curvature of the spectrum, see `PenalisedFit`; AICc chooses [-]."""
LEAST_ROWS = 6
"""Rows in the judged window: a slope and a curvature, each twice over."""
IGNORED_SCALE = 1.0e150
"""Scale that gives a row no weight: its square is still finite, its reciprocal's square is nothing."""


@dataclass(frozen=True)
class DecadeError:
    """Mean contradiction in one decade of the judged window.

    Parameters
    ----------
    low : float
        Lowest frequency [Hz].
    high : float
        Highest frequency [Hz].
    rows : int
        Measured rows in it [-].
    loss : float
        Mean of predicted over measured E'', less one, E'' predicted from E' [-].
    storage : float
        The same of E', predicted from E'' [-].
    """

    low: float
    high: float
    rows: int
    loss: float
    storage: float


@dataclass(frozen=True, eq=False)
class KramersKronig:
    """Each modulus against its prediction from the other.

    Parameters
    ----------
    loss : Misfit
        E'' predicted from E' alone, over the measured one less one, in the judged window [-].
    storage : Misfit
        E' predicted from E'' alone and one constant, the same [-].
    judged : tuple of float
        Frequencies of the judged window: the measured one less a decade at both ends [Hz].
    storage_fit : float
        Root mean square misfit of the positive spectrum of E' to E' itself, whole window [-].
    loss_fit : float
        The same of E'' [-].
    outside : float
        Largest share, in the judged window, of the predicted E'' that comes from lines outside the measured
        window: so much of the prediction is extrapolation [-].
    decades : tuple of DecadeError
        Where they contradict each other.
    frequency : numpy.ndarray
        Of all rows, ascending, shape `(n,)` [Hz].
    predicted_loss : numpy.ndarray
        E'' from E', shape `(n,)` [Pa].
    predicted_storage : numpy.ndarray
        E' from E'', shape `(n,)` [Pa].
    """

    loss: Misfit
    storage: Misfit
    judged: tuple[float, float]
    storage_fit: float
    loss_fit: float
    outside: float
    decades: tuple[DecadeError, ...]
    frequency: FloatArray = field(repr=False)
    predicted_loss: FloatArray = field(repr=False)
    predicted_storage: FloatArray = field(repr=False)


def kramers_kronig_applicable(frequency: ArrayLike) -> bool:
    """True if enough rows lie a decade and more from both ends of the window for `kramers_kronig`.

    Parameters
    ----------
    frequency : array_like
        CYCLIC frequency, shape `(n,)`, any order [Hz].

    Examples
    --------
    >>> kramers_kronig_applicable(np.logspace(0, 2, 30)), kramers_kronig_applicable(np.logspace(-2, 4, 30))
    (False, True)
    """
    f = np.asarray(frequency, dtype=float)
    inside = (f >= f.min() * 10.0**MARGIN) & (f <= f.max() / 10.0**MARGIN)
    return bool(np.count_nonzero(inside) >= LEAST_ROWS)


def kramers_kronig(frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike) -> KramersKronig:
    """Test a master curve for the relation that causality sets between E' and E''.

    Parameters
    ----------
    frequency : array_like
        CYCLIC frequency, shape `(n,)`, any order, over more than two decades [Hz].
    storage : array_like
        E' at them, shape `(n,)` [Pa].
    loss : array_like
        E'' at them, shape `(n,)` [Pa].

    Returns
    -------
    KramersKronig
        Residuals in both directions, and by decade.

    Raises
    ------
    InputError
        If a value is not finite and > 0, shapes differ, or fewer than six rows are in the judged window.

    Notes
    -----
    In place of the integrals, which need all frequencies, a measurement model: a smooth positive spectrum is
    fitted to E' alone and gives E'', another to E'' alone gives E'. The measured partner enters only as the scale
    of the penalty on the curvature.

    The spectrum outside the window is unknown. It adds to E' a constant (slow lines and E_e),
    which is why E' from E'' has one constant fitted; to E'' a tail at both ends, which is why a decade at
    either end is not judged. An E'' that is wrong there, or wrong by a process outside the window, passes.
    E'' from E' rests on the slope of E': scatter of E' of 1 % gives some per cent of a small E''.

    Which of the two is wrong, the relation does not say.

    References
    ----------
    B. A. Boukamp, J. Electrochem. Soc. 142 (1995) 1885-1894 (Kramers-Kronig by measurement model).
    H. C. Booij, G. P. J. M. Thoone, Rheol. Acta 21 (1982) 15-24 (E' and E'' of polymers).

    Examples
    --------
    >>> from conveyor.rubber.prony import PronySeries
    >>> series = PronySeries(1e6, np.full(49, 1e6), np.logspace(-9, 3, 49))
    >>> f = np.logspace(-1, 6, 60)
    >>> omega = 2 * np.pi * f
    >>> test = kramers_kronig(f, series.storage(omega), 1.1 * series.loss(omega))
    >>> round(test.loss.rms, 3)  # 1/1.1 - 1
    0.091
    """
    rows = checked_rows(frequency, storage, loss, storage_error=None, loss_error=None)
    f, omega = rows.frequency, rows.omega
    low, high = f[0] * 10.0**MARGIN, f[-1] / 10.0**MARGIN
    inside = (f >= low) & (f <= high)
    if np.count_nonzero(inside) < LEAST_ROWS:
        raise InputError(
            f"the window {f[0]:g} to {f[-1]:g} Hz has {np.count_nonzero(inside)} rows farther than"
            f" {MARGIN:g} decade from its ends; the test needs >= {LEAST_ROWS}: measure a wider range, or"
            " superpose isotherms"
        )
    tau = even_times(omega, LINES_PER_DECADE, REACH)
    unit = debye_kernel(omega, tau)
    n = f.size
    by_storage, storage_fit = _one_sided_spectrum(rows, tau, slice(n, None))
    by_loss, loss_fit = _one_sided_spectrum(rows, tau, slice(0, n))
    predicted_loss = unit[n:] @ by_storage
    level = unit[:n, 1:] @ by_loss[1:]
    # constant of least squares of the relative errors: E' = level + constant
    weight = 1.0 / rows.storage[inside] ** 2
    constant = float(weight @ (rows.storage - level)[inside]) / float(weight.sum())
    predicted_storage = level + constant
    beyond = (tau < 1.0 / omega[-1]) | (tau > 1.0 / omega[0])
    share = (unit[n:, 1:][:, beyond] @ by_storage[1:][beyond]) / predicted_loss
    error_loss, error_storage = predicted_loss / rows.loss - 1.0, predicted_storage / rows.storage - 1.0
    return KramersKronig(
        loss=relative_misfit(error_loss[inside], f[inside]),
        storage=relative_misfit(error_storage[inside], f[inside]),
        judged=(float(low), float(high)),
        storage_fit=storage_fit,
        loss_fit=loss_fit,
        outside=float(share[inside].max()),
        decades=_errors_by_decade(f[inside], error_loss[inside], error_storage[inside]),
        frequency=f,
        predicted_loss=predicted_loss,
        predicted_storage=predicted_storage,
    )


def _one_sided_spectrum(rows: FitRows, tau: FloatArray, ignored: slice) -> tuple[FloatArray, float]:
    """Spectrum of one modulus, equilibrium first [Pa], and its misfit to that modulus [-]."""
    scale = rows.scale.copy()
    scale[ignored] = IGNORED_SCALE
    blind = replace(rows, scale=scale)
    problem = PenalisedFit(blind, tau, None)
    n = rows.frequency.size
    candidates = [problem.judged(blind.target, strength) for strength in STRENGTHS]
    judged = [one for one in candidates if n - one.freedom - 2.0 > 0.0] or candidates[-1:]
    rms = [one.residual * float(np.sqrt(2.0)) for one in judged]  # half of the rows have no weight
    if len(judged) > 1:
        best = int(np.argmin([aicc(n, one.freedom, r) for one, r in zip(judged, rms, strict=True)]))
    else:
        best = 0
    return judged[best].moduli, rms[best]


def _errors_by_decade(f: FloatArray, loss: FloatArray, storage: FloatArray) -> tuple[DecadeError, ...]:
    """Mean errors by decade, counted from the lowest frequency."""
    number = np.minimum(np.floor(np.log10(f / f[0])).astype(int), max(0, int(np.ceil(np.log10(f[-1] / f[0]))) - 1))
    return tuple(
        DecadeError(
            float(f[number == k].min()),
            float(f[number == k].max()),
            int(np.count_nonzero(number == k)),
            float(loss[number == k].mean()),
            float(storage[number == k].mean()),
        )
        for k in np.unique(number)
    )
