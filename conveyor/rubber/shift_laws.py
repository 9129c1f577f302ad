"""Compare shift laws, WLF, Arrhenius and the table itself, by their error at a shift left out."""

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
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.rubber.shift import WLF, Arrhenius, ShiftLaw, ShiftTable
from conveyor.rubber.shift_fit import fit_arrhenius, fit_wlf

LEAST_TEMPERATURES = 5
"""Least number of temperatures: two ends that no table predicts when left out, and three between them."""
LAW_PARAMETERS = {"WLF": 2, "Arrhenius": 1}
LAW_REMARKS = {
    "WLF": "two parameters, smooth; above the glass transition, not near its pole",
    "Arrhenius": "one parameter; a glass, or far above the glass transition",
    "table": (
        "interpolates: no residual at its own points, so only a point left out judges it, and that over twice"
        " the spacing it has in use; it smooths no noise and never extrapolates"
    ),
}


@dataclass(frozen=True, eq=False)
class ShiftComparison:
    """One law and how it fits the shifts.

    Parameters
    ----------
    name : str
        "WLF", "Arrhenius" or "table" [-].
    law : WLF, Arrhenius, ShiftTable or None
        The fitted law; None if the shifts do not follow it [-].
    rms : float
        Root mean square of law minus shift, weighted [decades].
    worst : float
        Largest in magnitude, not weighted, with its sign [decades].
    worst_temperature : float
        Temperature of the worst [K].
    left_out : float
        Root mean square error, weighted, of each inner shift predicted by the law refitted without it
        [decades].
    chi2_per_freedom : float or None
        Sum of (residual/error)^2 over rows less parameters; 1 for a law within its errors. None without
        `error`, and for the table [-].
    low : float
        Coldest temperature at which the law is supported by shifts [K].
    high : float
        Hottest one [K].
    remark : str
        Kind of law, or the reason for its absence [-].
    """

    name: str
    law: WLF | Arrhenius | ShiftTable | None
    rms: float
    worst: float
    worst_temperature: float
    left_out: float
    chi2_per_freedom: float | None
    low: float
    high: float
    remark: str


@dataclass(frozen=True, eq=False)
class _CheckedShifts:
    """Checked rows by ascending temperature, zero at the row nearest the reference; weights 1/error^2 of the others."""

    t: FloatArray
    y: FloatArray
    reference: float
    error: FloatArray | None
    weight: FloatArray

    def law(self, name: str, keep: FloatArray | slice = slice(None)) -> WLF | Arrhenius | ShiftTable:
        """Fit a law to some rows."""
        t, y = self.t[keep], self.y[keep]
        if name == "table":
            return ShiftTable(t, y, reference=self.reference)
        error = None if self.error is None else self.error[keep]
        fit = fit_wlf if name == "WLF" else fit_arrhenius
        return fit(t, y, self.reference, error=error).law


def compare_shift_laws(
    temperatures: ArrayLike, log10_a_T: ArrayLike, reference: float, *, error: ArrayLike | None = None
) -> tuple[ShiftComparison, ...]:
    """Fit WLF and Arrhenius, take the table, and order them by their error at a shift left out.

    Parameters
    ----------
    temperatures : array_like
        Absolute temperatures, shape `(n,)`, n >= 5, distinct, any order [K].
    log10_a_T : array_like
        Shifts at them, shape `(n,)` [-].
    reference : float
        Absolute temperature, within the measured ones, at which a_T = 1 [K]. The laws are made to pass through the
        row nearest to it: between two rows a_T = 1 is interpolated, not measured.
    error : array_like, optional
        Standard uncertainty of each shift, shape `(n,)`; rows weigh by 1/error^2. Equal weights when left
        out [decades].

    Returns
    -------
    tuple of ShiftComparison
        Best first; a law that the shifts do not follow comes last, without a law.

    Raises
    ------
    InputError
        If there are fewer than five temperatures, values repeat or are not finite, or the shifts rise with
        temperature.
    RangeError
        If the reference is outside the temperatures.

    Notes
    -----
    The criterion is leave-one-out cross-validation over the inner temperatures: it is what a law is used for,
    a temperature between the measured ones, and the one figure that a table and a formula share. Chi^2 per degree
    of freedom is added where uncertainties are given: far above 1 the law is wrong for
    this rubber, however it ranks. Uncertainties along a chain of isotherms are correlated (see
    `Superposition.covariance`); here they count as independent, so chi^2 is a guide.

    References
    ----------
    M. Stone, J. R. Stat. Soc. B 36 (1974) 111-147 (cross-validation).

    Examples
    --------
    >>> t = np.array([263.0, 273.0, 283.0, 293.0, 303.0, 313.0, 323.0])
    >>> found = compare_shift_laws(t, WLF(8.86, 101.6, 293.0).log10_a_T(t), 293.0)
    >>> [one.name for one in found]
    ['WLF', 'table', 'Arrhenius']
    """
    shifts = _check_shifts(temperatures, log10_a_T, reference, error)
    judged = [_compare_law(shifts, name) for name in ("WLF", "Arrhenius", "table")]
    return tuple(sorted(judged, key=lambda one: one.left_out))


def _check_shifts(
    temperatures: ArrayLike, shifts: ArrayLike, reference: float, error: ArrayLike | None
) -> _CheckedShifts:
    t, y = positive_vector("temperatures", temperatures, "K"), finite_vector("log10_a_T", shifts, "decades")
    if t.shape != y.shape or t.size < LEAST_TEMPERATURES:
        raise InputError(
            f"comparing laws needs >= {LEAST_TEMPERATURES} temperatures and a shift for each; got {t.size} and {y.size}"
        )
    t_ref = positive_number("reference", reference, "K")
    if not t.min() <= t_ref <= t.max():
        raise RangeError(
            f"reference {t_ref:g} K is outside the shifts, {t.min():g} to {t.max():g} K: choose one inside"
        )
    nearest = int(np.argmin(np.abs(t - t_ref)))
    t_ref, y = float(t[nearest]), y - y[nearest]
    order = np.argsort(t, kind="stable")
    sigma = None
    weight = np.ones_like(t)
    if error is not None:
        sigma = non_negative_array("error", error, "decades")
        if sigma.shape != t.shape:
            raise InputError(f"error must hold one uncertainty per shift, shape {t.shape}; got {sigma.shape}")
        if np.any(sigma[t != t_ref] == 0.0):
            raise InputError("error: got 0 decades, allowed: > 0 decades except at the reference (0 is exact)")
        sigma = sigma[order]
        away = t[order] != t_ref
        weight = np.zeros_like(t)
        weight[away] = 1.0 / np.square(sigma[away])
    weight[t[order] == t_ref] = 0.0
    return _CheckedShifts(t[order], y[order], t_ref, sigma, weight)


def _compare_law(shifts: _CheckedShifts, name: str) -> ShiftComparison:
    t, y, weight = shifts.t, shifts.y, shifts.weight
    low, high = float(t[0]), float(t[-1])
    try:
        law = shifts.law(name)
        left_out = _left_out_error(shifts, name)
    except NoSolutionError as refused:
        infinite = float("inf")
        return ShiftComparison(name, None, infinite, infinite, low, infinite, None, low, high, str(refused))
    residual = _law_shifts(law, t) - y
    k = int(np.argmax(np.abs(residual)))
    freedom = int(np.count_nonzero(weight)) - LAW_PARAMETERS.get(name, t.size)
    chi2 = float(weight @ residual**2) / freedom if shifts.error is not None and freedom > 0 else None
    return ShiftComparison(
        name=name,
        law=law,
        rms=float(np.sqrt(weight @ residual**2 / weight.sum())),
        worst=float(residual[k]),
        worst_temperature=float(t[k]),
        left_out=left_out,
        chi2_per_freedom=chi2,
        low=low,
        high=high,
        remark=LAW_REMARKS[name],
    )


def _left_out_error(shifts: _CheckedShifts, name: str) -> float:
    """Weighted error of each inner shift, predicted without it [decades]."""
    rows = [i for i in range(1, shifts.t.size - 1) if shifts.weight[i] > 0.0]
    errors = []
    for i in rows:
        keep = np.arange(shifts.t.size) != i
        errors.append(float(_law_shifts(shifts.law(name, keep), shifts.t[i : i + 1])[0]) - float(shifts.y[i]))
    weight = shifts.weight[rows]
    return float(np.sqrt(weight @ np.square(errors) / weight.sum()))


def _law_shifts(law: ShiftLaw, t: FloatArray) -> FloatArray:
    return np.asarray(law.log10_a_T(t), dtype=np.float64)
