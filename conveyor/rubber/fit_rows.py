"""Rows of a fit: checked measurements, and the relative-error matrix of relaxation times."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray, positive_number, positive_vector
from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber.misfit import hampel_weights
from conveyor.rubber.non_negative import non_negative_least_squares

ZERO_MODULUS = 1.0e-12
"""Moduli below this share of the smallest E' are 0: NNLS may leave rounding, 1e-16, and no data resolve them."""
LEAST_TRUST = 1.0e-300
"""Least weight of a row: its reciprocal is still finite [-]."""
SCALING_PASSES = 5
"""Passes of `scale_to_fit`: each leaves about sigma^2 of the last change, 1e-3 at 28 % noise."""


@dataclass(frozen=True, eq=False)
class FitRows:
    """Measurements in ascending frequency, with scale of error and weight.

    Parameters
    ----------
    frequency : numpy.ndarray
        Cyclic frequency, shape `(n,)` [Hz].
    storage : numpy.ndarray
        E', shape `(n,)` [Pa].
    loss : numpy.ndarray
        E'', shape `(n,)` [Pa].
    scale : numpy.ndarray
        Divisor of errors, shape `(2n,)`, E' first: the data or the fit, over the row's weight [Pa].
    trust : numpy.ndarray
        Weight of each row, shape `(2n,)`, E' first; 0 for an outlier, see `conveyor.rubber.misfit.hampel_weights` [-].
    """

    frequency: FloatArray
    storage: FloatArray
    loss: FloatArray
    scale: FloatArray
    trust: FloatArray

    @property
    def omega(self) -> FloatArray:
        """Angular frequency, shape `(n,)` [rad/s]."""
        return 2.0 * np.pi * self.frequency

    @property
    def target(self) -> FloatArray:
        """Data over `scale`, shape `(2n,)` [-]."""
        return np.concatenate([self.storage, self.loss]) / self.scale

    def matrix(self, tau: FloatArray) -> FloatArray:
        """Rows of E' and E'' over `scale`, equilibrium first, shape `(2n, 1 + m)` [1/Pa]."""
        return debye_kernel(self.omega, tau) / self.scale[:, None]


def debye_kernel(omega: FloatArray, tau: FloatArray) -> FloatArray:
    """E' above E'' of a unit equilibrium modulus and of a unit term at each time [-]."""
    x = np.outer(omega, tau)
    debye = x / np.square(np.hypot(1.0, x))
    top = np.column_stack([np.ones_like(omega), x * debye])
    return np.vstack([top, np.column_stack([np.zeros_like(omega), debye])])


def checked_rows(
    frequency: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    *,
    storage_error: ArrayLike | None,
    loss_error: ArrayLike | None,
) -> FitRows:
    """Check and sort measurements by frequency [Hz, Pa]; errors relative to the data."""
    columns = {"frequency": (frequency, "Hz"), "storage": (storage, "Pa"), "loss": (loss, "Pa")}
    arrays = {name: np.array(values, dtype=np.float64) for name, (values, _) in columns.items()}
    f = arrays["frequency"]
    if f.ndim != 1 or any(a.shape != f.shape for a in arrays.values()):
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items())
        raise InputError(f"frequency, storage and loss must have one shape (n,); got {shapes}")
    for name, a in arrays.items():
        bad = np.flatnonzero(~(np.isfinite(a) & (a > 0.0)))
        if bad.size:
            row, unit = int(bad[0]), columns[name][1]
            where = f"row {row + 1}" if name == "frequency" else f"row {row + 1} (frequency {f[row]:g} Hz)"
            raise InputError(f"{where}: {name}: got {a[row]:g} {unit}, allowed: > 0 {unit} and finite")
    if np.unique(f).size < 2:
        raise InputError(f"a fit needs at least 2 distinct frequencies; got {np.unique(f).size}")
    order = np.argsort(f, kind="stable")
    spread = _relative_errors(f.size, storage_error, loss_error).reshape(2, -1)[:, order].ravel()
    e1, e2 = arrays["storage"][order], arrays["loss"][order]
    return FitRows(f[order], e1, e2, np.concatenate([e1, e2]) * spread, np.ones(2 * f.size))


def _relative_errors(size: int, storage_error: ArrayLike | None, loss_error: ArrayLike | None) -> FloatArray:
    """Relative errors over their root mean square, so that equal ones change nothing [-]."""
    if storage_error is None and loss_error is None:
        return np.ones(2 * size)
    if storage_error is None or loss_error is None:
        raise InputError("storage_error and loss_error weigh E' against E'': give both or neither")
    both = []
    for name, given in (("storage_error", storage_error), ("loss_error", loss_error)):
        value = np.asarray(given, dtype=np.float64)
        if value.shape not in {(), (size,)}:
            raise InputError(f"{name} must be one number or one per row, shape ({size},); got {value.shape}")
        both.append(positive_vector(name, np.broadcast_to(value, (size,)), "-"))
    errors = np.concatenate(both)
    return np.asarray(errors / np.sqrt(np.mean(errors**2)))


def held_equilibrium(equilibrium: float, storage: FloatArray) -> float:
    """Equilibrium modulus to hold [Pa], refused unless below every E'."""
    value = positive_number("equilibrium", equilibrium, "Pa")
    if value >= storage.min():
        raise InputError(
            f"equilibrium: got {value:g} Pa, allowed: < {storage.min():g} Pa, the smallest storage modulus"
        )
    return value


def even_times(omega: FloatArray, per_decade: float, extra: float = 0.0) -> FloatArray:
    """Times [s], even in log over the window 1/omega, ends included."""
    low, high = -np.log10(omega[-1]) - extra, -np.log10(omega[0]) + extra
    return np.logspace(low, high, max(2, round((high - low) * per_decade) + 1))


def given_times(times: ArrayLike, omega: FloatArray, held: float | None) -> FloatArray:
    """Times chosen by the user [s], distinct and ascending."""
    tau = np.unique(positive_vector("times", times, "s"))
    low, high = 1.0 / omega[-1], 1.0 / omega[0]
    slack = 1e-9  # a time typed as the rounded end of the window is not outside it
    outside = tau[(tau < low * (1.0 - slack)) | (tau > high * (1.0 + slack))]
    if outside.size and held is None:
        raise InputError(
            f"times: {outside[0]:g} s is outside the window of the data, {low:g} to {high:g} s (1/(2 pi f));"
            " there the data cannot tell a slow term from the equilibrium modulus: hold equilibrium=<Pa>"
        )
    return tau


def fit_moduli(rows: FitRows, tau: FloatArray, held: float | None) -> FloatArray:
    """Fit moduli to rows by non-negative least squares, equilibrium first [Pa].

    References
    ----------
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23.
    """
    return _fit_kernel(rows, debye_kernel(rows.omega, tau), held)


def _fit_kernel(rows: FitRows, terms: FloatArray, held: float | None) -> FloatArray:
    """Moduli as `fit_moduli`, from the `debye_kernel` of the times."""
    unit = float(np.exp(np.mean(np.log(rows.storage))))
    matrix = terms / rows.scale[:, None] * unit
    if held is None:
        moduli = non_negative_least_squares(matrix, rows.target)
    else:
        rest = non_negative_least_squares(matrix[:, 1:], rows.target - matrix[:, 0] * (held / unit))
        moduli = np.concatenate([[held / unit], rest])
    return np.asarray(moduli * unit)


def scale_to_fit(rows: FitRows, tau: FloatArray, held: float | None) -> FitRows:
    """Make errors relative to the fit, in a few passes of `fit_moduli`, and remove the weight of outliers.

    Notes
    -----
    An error over the DATUM weighs a reading that came out low more than one that came out high: the fit is
    low by about 2 sigma^2 for scatter sigma (16 % at 28 %). Over the fit it is right in the mean (the
    estimating equation of quasi-likelihood for a constant coefficient of variation).

    References
    ----------
    R. W. M. Wedderburn, Biometrika 61 (1974) 439-447.
    """
    data = np.concatenate([rows.storage, rows.loss])
    spread = rows.scale / data
    terms = debye_kernel(rows.omega, tau)
    for _ in range(SCALING_PASSES):
        moduli = _fit_kernel(rows, terms, held)
        if not moduli[1:].any():
            raise NoSolutionError(NO_TERM)
        fitted = terms @ moduli
        kept = np.concatenate([hampel_weights(error) for error in np.split(data / fitted - 1.0, 2)])
        rows = replace(rows, scale=fitted * spread / np.sqrt(np.maximum(kept, LEAST_TRUST)), trust=kept)
    return rows


NO_TERM = "no relaxation time fits the loss modulus: check times, and that frequency is in Hz"
