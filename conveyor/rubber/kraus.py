"""Kraus' law of a filled rubber's moduli against strain amplitude, and its fit to a strain sweep."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray
from conveyor.rubber.non_negative import non_negative_least_squares
from conveyor.rubber.strain import StrainSweep

_KRAUS_STARTS = (0.3, 0.6, 0.9)  # about the exponents of carbon blacks, 0.5 to 0.6 (Kraus)


@dataclass(frozen=True)
class KrausLaw:
    r"""Kraus' law of de-agglomerating filler, ``x = (strain/critical_strain)^m``, ``y`` the same of E''.

    ``E' = far + (plateau - far)/(1 + x^2)`` and ``E'' = far_loss + 2 (peak_loss - far_loss) y/(1 + y^2)``.

    Parameters
    ----------
    plateau, far : float
        E' at vanishing and at large strain [Pa].
    peak_loss, far_loss : float
        E'' at the critical strain and far from it [Pa].
    critical_strain, loss_strain : float
        Strain at which E' has fallen half way, and at which E'' is largest [-]; equal in Kraus' theory.
    exponent, loss_exponent : float
        m of E' and of E'' [-]; equal in Kraus' theory.

    References
    ----------
    G. Kraus, Mechanical losses in carbon-black-filled rubbers, J. Appl. Polym. Sci.: Appl. Polym. Symp. 39 (1984)
    75-92.
    """

    plateau: float
    far: float
    peak_loss: float
    far_loss: float
    critical_strain: float
    exponent: float
    loss_strain: float
    loss_exponent: float

    def storage(self, strain: ArrayLike) -> FloatArray:
        """Return E' at strain amplitudes [-], shape of `strain` [Pa]."""
        broken, _ = _kraus_shapes(np.asarray(strain, dtype=np.float64), self.critical_strain, self.exponent)
        return np.asarray(self.plateau + (self.far - self.plateau) * broken)[()]

    def loss(self, strain: ArrayLike) -> FloatArray:
        """Return E'' at strain amplitudes [-], shape of `strain` [Pa]."""
        _, rate = _kraus_shapes(np.asarray(strain, dtype=np.float64), self.loss_strain, self.loss_exponent)
        return np.asarray(self.far_loss + (self.peak_loss - self.far_loss) * rate)[()]


@dataclass(frozen=True)
class KrausFit:
    """Kraus' law fitted to a sweep.

    Attributes
    ----------
    law : KrausLaw
        The law.
    storage_rms, loss_rms : float
        Root mean square of the relative errors of E' and E'' [-].
    smoothed : StrainSweep
        The law at the strains of the sweep, a smooth replacement for it.
    """

    law: KrausLaw
    storage_rms: float
    loss_rms: float
    smoothed: StrainSweep = field(repr=False)


def _kraus_shapes(strain: FloatArray, critical: float, exponent: float) -> tuple[FloatArray, FloatArray]:
    """x²/(1+x²) and 2x/(1+x²)."""
    x = exponent * np.log(strain / critical)
    return np.asarray(0.5 * (1.0 + np.tanh(x))), np.asarray(1.0 / np.cosh(x))


def fit_kraus(sweep: StrainSweep, *, shared: bool = False) -> KrausFit:
    """Fit Kraus' law to both moduli of a sweep, relative errors, least squares.

    Parameters
    ----------
    sweep : StrainSweep
        Measured moduli [Pa].
    shared : bool
        One critical strain and exponent for both moduli, as in Kraus' theory, in place of each its own [-].

    Returns
    -------
    KrausFit
        The law and its misfit; judge it by the misfit, not every compound follows it.

    Notes
    -----
    The four moduli are linear in the law (non-negative least squares); critical strains and exponents are searched.

    Examples
    --------
    >>> law = KrausLaw(10e6, 3e6, 1.5e6, 0.5e6, 0.01, 0.6, 0.01, 0.6)
    >>> strain = np.geomspace(1e-4, 0.3, 20)
    >>> sweep = StrainSweep(293.15, 1.0, strain, law.storage(strain), law.loss(strain))
    >>> fit = fit_kraus(sweep, shared=True)
    >>> round(fit.law.critical_strain, 6), round(fit.law.exponent, 6)
    (0.01, 0.6)
    """
    strain = sweep.strain
    if shared:
        both = _search_best_start(
            strain,
            lambda place: np.concatenate(
                [
                    _branch_moduli(strain, sweep.storage, 0, place)[1],
                    _branch_moduli(strain, sweep.loss, 1, place)[1],
                ]
            ),
        )
        places = (both, both)
    else:
        places = (
            _search_best_start(strain, lambda place: _branch_moduli(strain, sweep.storage, 0, place)[1]),
            _search_best_start(strain, lambda place: _branch_moduli(strain, sweep.loss, 1, place)[1]),
        )
    (plateau, far), missed = _branch_moduli(strain, sweep.storage, 0, places[0])
    (far_loss, peak_loss), missed_loss = _branch_moduli(strain, sweep.loss, 1, places[1])
    law = KrausLaw(plateau, far, peak_loss, far_loss, *np.exp(places[0]).tolist(), *np.exp(places[1]).tolist())
    return KrausFit(
        law,
        float(np.sqrt(np.mean(missed**2))),
        float(np.sqrt(np.mean(missed_loss**2))),
        StrainSweep(sweep.temperature, sweep.frequency, strain, law.storage(strain), law.loss(strain)),
    )


def _branch_moduli(
    strain: FloatArray, measured: FloatArray, which: int, place: FloatArray
) -> tuple[tuple[float, float], FloatArray]:
    """Moduli of one branch of the law at ln critical strain and ln m, and their relative errors."""
    share = _kraus_shapes(strain, math.exp(place[0]), math.exp(place[1]))[which]
    unit = float(measured.max())
    columns = np.stack([1.0 - share, share], axis=1) * (unit / measured)[:, None]
    scaled = non_negative_least_squares(columns, np.ones(measured.size))
    return (unit * float(scaled[0]), unit * float(scaled[1])), np.asarray(columns @ scaled - 1.0)


def _search_best_start(strain: FloatArray, missed: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Least squares in ln critical strain and ln m, the best of several starts."""
    from scipy.optimize import least_squares

    middle = 0.5 * (math.log(strain[0]) + math.log(strain[-1]))
    best, least = np.zeros(2), math.inf
    for exponent in _KRAUS_STARTS:
        solution = least_squares(missed, [middle, math.log(exponent)], xtol=1e-12, ftol=1e-12, gtol=1e-12)
        if float(solution.cost) < least:
            best, least = np.asarray(solution.x, dtype=np.float64), float(solution.cost)
    return best
