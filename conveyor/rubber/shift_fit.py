"""Fit a WLF or Arrhenius law to tabulated shift factors, with its misfit in decades."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import (
    FloatArray,
    finite_vector,
    non_negative_array,
    positive_number,
    positive_vector,
)
from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber.shift import GAS_CONSTANT, WLF, Arrhenius

POLE_DISTANCE = (0.1, 1.0e4)
"""Searched distance of the WLF pole below the coldest point [K]; at 1e4 K the law is a straight line in T."""
SEARCH_POINTS = 201


@dataclass(frozen=True)
class ShiftFit:
    """A fitted shift law and its misfit, every temperature counted alike.

    Parameters
    ----------
    law : WLF or Arrhenius
        The fitted law [-].
    rms : float
        Root mean square residual of log10 a_T [decades].
    worst : float
        Residual largest in magnitude, law minus table [decades].
    worst_temperature : float
        Absolute temperature of the worst residual [K].
    """

    law: WLF | Arrhenius
    rms: float
    worst: float
    worst_temperature: float


def fit_wlf(
    temperatures: ArrayLike, log10_a_T: ArrayLike, reference: float, *, error: ArrayLike | None = None
) -> ShiftFit:
    """Least-squares WLF law in decades, reference held.

    Parameters
    ----------
    temperatures : array_like
        Absolute temperatures, shape `(n,)`, at least 3 apart from the reference [K].
    log10_a_T : array_like
        Shifts at them, shape `(n,)` [-].
    reference : float
        Absolute temperature at which the law is to give a_T = 1 [K].
    error : array_like, optional
        Standard uncertainty of each shift, shape `(n,)`, > 0, or 0 at the reference, where the law is exact
        by construction; rows weigh by 1/error^2. Equal weights when left out [decades].

    Returns
    -------
    ShiftFit
        The law and its residuals in decades.

    Raises
    ------
    InputError
        If the table is too short or not finite.
    NoSolutionError
        If the table has no WLF curvature (best pole at the end of the searched range) or the wrong sign.

    Notes
    -----
    c1 is linear for a given c2; c2 is searched with the pole 0.1 to 1e4 K below the coldest point.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.array([263.0, 283.0, 303.0, 323.0])
    >>> fit = fit_wlf(t, WLF(8.86, 101.6, 293.0).log10_a_T(t), reference=293.0)
    >>> round(fit.law.c1, 4), round(fit.law.c2, 3), fit.rms < 1e-6
    (8.86, 101.6, True)
    """
    from scipy.optimize import minimize_scalar

    t, y, x = _check_table(temperatures, log10_a_T, reference, minimum=3)
    weight = _shift_weights(x, error)
    floor = max(0.0, -float(x.min()))

    def slope(v: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """c1 at places of the pole, shape `(m,)`, and its factors, shape `(m, n)`."""
        basis = -x / (floor + np.exp(np.atleast_1d(v))[:, None] + x)
        return (weight * basis) @ y / np.einsum("ij,ij->i", weight * basis, basis), basis

    def costs(v: ArrayLike) -> FloatArray:
        c1, basis = slope(v)
        return np.asarray((c1[:, None] * basis - y) ** 2 @ weight)

    def cost(v: float) -> float:
        return float(costs(v)[0])

    grid = np.linspace(np.log(POLE_DISTANCE[0]), np.log(POLE_DISTANCE[1]), SEARCH_POINTS)
    best = int(np.argmin(costs(grid)))
    if best in {0, SEARCH_POINTS - 1}:
        raise NoSolutionError("the shifts do not follow a WLF law (its pole leaves the searched range): use a table")
    least = minimize_scalar(cost, bounds=(grid[best - 1], grid[best + 1]), method="bounded", options={"xatol": 1e-10})
    c1 = float(slope(float(least.x))[0][0])
    if c1 <= 0.0:
        raise NoSolutionError("the shifts rise with temperature: no WLF law; reversed sign, or log of 1/a_T?")
    return _with_residuals(WLF(c1, floor + float(np.exp(least.x)), float(reference)), t, y)


def fit_arrhenius(
    temperatures: ArrayLike, log10_a_T: ArrayLike, reference: float, *, error: ArrayLike | None = None
) -> ShiftFit:
    """Least-squares Arrhenius law in decades, reference held.

    Parameters
    ----------
    temperatures : array_like
        Absolute temperatures, shape `(n,)`, at least one apart from the reference [K].
    log10_a_T : array_like
        Shifts at them, shape `(n,)` [-].
    reference : float
        Absolute temperature at which the law is to give a_T = 1 [K].
    error : array_like, optional
        Standard uncertainty of each shift, shape `(n,)`, > 0, or 0 at the reference, where the law is exact
        by construction; rows weigh by 1/error^2. Equal weights when left out [decades].

    Returns
    -------
    ShiftFit
        The law and its residuals in decades.

    Raises
    ------
    InputError
        If the table is too short or not finite.
    NoSolutionError
        If the shifts rise with temperature.

    Examples
    --------
    >>> fit = fit_arrhenius([273.0, 313.0], Arrhenius(120e3, 293.0).log10_a_T([273.0, 313.0]), reference=293.0)
    >>> round(fit.law.activation_energy)
    120000
    """
    t, y, x = _check_table(temperatures, log10_a_T, reference, minimum=1)
    weight = _shift_weights(x, error)
    basis = -x / (t * reference * GAS_CONSTANT * np.log(10.0))
    energy = float((weight * basis) @ y / ((weight * basis) @ basis))
    if energy <= 0.0:
        raise NoSolutionError("the shifts rise with temperature: no Arrhenius law; reversed sign, or log of 1/a_T?")
    return _with_residuals(Arrhenius(energy, float(reference)), t, y)


def _check_table(
    temperatures: ArrayLike, shifts: ArrayLike, reference: float, *, minimum: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    t = positive_vector("temperatures", temperatures, "K")
    y = finite_vector("log10_a_T", shifts, "decades")
    if t.shape != y.shape:
        raise InputError(f"temperatures and log10_a_T must have one length; got {t.size} and {y.size}")
    x = t - positive_number("reference", reference, "K")
    distinct = int(np.unique(x[x != 0.0]).size)
    if distinct < minimum:
        raise InputError(f"the fit needs >= {minimum} temperatures apart from the reference; got {distinct}")
    return t, y, x


def _shift_weights(x: FloatArray, error: ArrayLike | None) -> FloatArray:
    """Weights of the rows, 1 for the smallest uncertainty; 0 at the reference, where no law can differ."""
    away = x != 0.0
    if error is None:
        return np.asarray(away, dtype=np.float64)
    sigma = non_negative_array("error", error, "decades")
    if sigma.shape != x.shape:
        raise InputError(f"error must hold one standard uncertainty per shift, shape {x.shape}; got {sigma.shape}")
    if np.any(sigma[away] == 0.0):
        raise InputError("error: got 0 decades, allowed: > 0 decades except at the reference (0 is exact)")
    weight = np.zeros_like(x)
    weight[away] = np.square(sigma[away].min() / sigma[away])
    return weight


def _with_residuals(law: WLF | Arrhenius, t: FloatArray, y: FloatArray) -> ShiftFit:
    residual = law.log10_a_T(t) - y
    k = int(np.argmax(np.abs(residual)))
    return ShiftFit(law, float(np.sqrt(np.mean(residual**2))), float(residual[k]), float(t[k]))
