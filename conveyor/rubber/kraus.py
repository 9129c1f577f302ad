"""Kraus' law of a filled rubber's moduli against strain amplitude, and its fit to a strain sweep."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares, nnls

from conveyor.rubber.arrays import FloatArray
from conveyor.rubber.strain import StrainSweep

_KRAUS_STARTS = (0.3, 0.6, 0.9)  # about the exponents of carbon blacks, 0.5 to 0.6 (Kraus)


@dataclass(frozen=True)
class KrausLaw:
    r"""Kraus' law of de-agglomerating filler, ``x = (strain/critical_strain)^m``.

    ``E' = far + (plateau - far)/(1 + x^2)`` and ``E'' = far_loss + 2 (peak_loss - far_loss) x/(1 + x^2)``.

    Parameters
    ----------
    plateau, far : float
        E' at vanishing and at large strain [Pa].
    peak_loss, far_loss : float
        E'' at the critical strain and far from it [Pa].
    critical_strain : float
        Where E' has fallen half way [-].
    exponent : float
        m [-].

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

    def storage(self, strain: ArrayLike) -> FloatArray:
        """Return E' at strain amplitudes [-], shape of `strain` [Pa]."""
        broken, _ = _kraus_shapes(np.asarray(strain, dtype=np.float64), self.critical_strain, self.exponent)
        return np.asarray(self.plateau + (self.far - self.plateau) * broken)[()]

    def loss(self, strain: ArrayLike) -> FloatArray:
        """Return E'' at strain amplitudes [-], shape of `strain` [Pa]."""
        _, rate = _kraus_shapes(np.asarray(strain, dtype=np.float64), self.critical_strain, self.exponent)
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
        The law at the strains of the sweep: a smooth stand-in wherever a sweep is taken.
    """

    law: KrausLaw
    storage_rms: float
    loss_rms: float
    smoothed: StrainSweep = field(repr=False)


def _kraus_shapes(strain: FloatArray, critical: float, exponent: float) -> tuple[FloatArray, FloatArray]:
    """x²/(1+x²) and 2x/(1+x²)."""
    x = exponent * np.log(strain / critical)
    return np.asarray(0.5 * (1.0 + np.tanh(x))), np.asarray(1.0 / np.cosh(x))


def fit_kraus(sweep: StrainSweep) -> KrausFit:
    """Fit Kraus' law to both moduli of a sweep, relative errors, least squares.

    Parameters
    ----------
    sweep : StrainSweep
        Measured moduli [Pa].

    Returns
    -------
    KrausFit
        The law and its misfit; judge it by the misfit, not every compound follows it.

    Notes
    -----
    The four moduli are linear in the law (non-negative least squares); critical strain and exponent are searched.

    Examples
    --------
    >>> law = KrausLaw(10e6, 3e6, 1.5e6, 0.5e6, 0.01, 0.6)
    >>> strain = np.geomspace(1e-4, 0.3, 20)
    >>> fit = fit_kraus(StrainSweep(293.15, 1.0, strain, law.storage(strain), law.loss(strain)))
    >>> round(fit.law.critical_strain, 6), round(fit.law.exponent, 6)
    (0.01, 0.6)
    """

    def solved(unknown: FloatArray) -> tuple[KrausLaw, FloatArray]:
        critical, exponent = math.exp(unknown[0]), math.exp(unknown[1])
        broken, rate = _kraus_shapes(sweep.strain, critical, exponent)
        moduli, missed = [], []
        for share, measured in ((broken, sweep.storage), (rate, sweep.loss)):
            columns = np.stack([1.0 - share, share], axis=1) / measured[:, None]
            scaled, _ = nnls(columns * measured.max(), np.ones(measured.size))
            moduli += [float(v) * float(measured.max()) for v in scaled]
            missed.append(columns @ (scaled * measured.max()) - 1.0)
        law = KrausLaw(moduli[0], moduli[1], moduli[3], moduli[2], critical, exponent)
        return law, np.concatenate(missed)

    middle = 0.5 * (math.log(sweep.strain[0]) + math.log(sweep.strain[-1]))

    def misses(unknown: FloatArray) -> FloatArray:
        return solved(unknown)[1]

    best, least = np.zeros(2), math.inf
    for exponent in _KRAUS_STARTS:
        found = least_squares(misses, [middle, math.log(exponent)], xtol=1e-12, ftol=1e-12, gtol=1e-12)
        if float(found.cost) < least:
            best, least = np.asarray(found.x, dtype=np.float64), float(found.cost)
    law, miss = solved(best)
    rms = np.sqrt(np.mean(miss.reshape(2, -1) ** 2, axis=1))
    smoothed = StrainSweep(
        sweep.temperature, sweep.frequency, sweep.strain, law.storage(sweep.strain), law.loss(sweep.strain)
    )
    return KrausFit(law, float(rms[0]), float(rms[1]), smoothed)
