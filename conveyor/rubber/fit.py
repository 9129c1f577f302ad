"""Prony series from a measured master curve: non-negative least squares on relative errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls

from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber.arrays import FloatArray, positive, positive_vector
from conveyor.rubber.prony import PronySeries

DUST = 1.0e-12
"""NNLS may return zero as rounding, 1e-16; no data resolve a modulus this far below the smallest E'."""
FLOOR_TERMS_PER_DECADE = 10.0
"""Spectrum lines of the consistency test. Lines d apart in ln(time) ripple by 4 exp(-pi^2/d): here 1e-18."""
FLOOR_EXTRA_DECADES = 3.0
"""Reach of the consistency test beyond the window: farther lines move E'' by < 1e-3 of their weight."""


@dataclass(frozen=True)
class Misfit:
    """Relative errors, model over data minus one, of one quantity over all rows.

    Parameters
    ----------
    rms : float
        Root mean square relative error [-].
    worst : float
        Relative error largest in magnitude, with its sign [-].
    worst_frequency : float
        Cyclic frequency of that row [Hz].
    """

    rms: float
    worst: float
    worst_frequency: float


@dataclass(frozen=True)
class PronyFit:
    """A fitted series and everything needed to judge it.

    Parameters
    ----------
    series : PronySeries
        The fit, at the temperature of the data [Pa, s].
    storage : Misfit
        Of E' [-].
    loss : Misfit
        Of E'' [-].
    tan_delta : Misfit
        Of E''/E' [-].
    window : tuple of float
        Lowest and highest measured frequency: the series says nothing outside [Hz].
    grid_terms : int
        Terms offered; `active_terms` is what the data took [-].
    condition : float
        Condition number of the active columns, each scaled to unit length [-].
    residual : float
        Root mean square of all relative errors, E' and E'' together: what was minimised [-].
    consistency_floor : float
        The same for the best of ALL positive spectra (ten lines a decade, three decades beyond the window,
        equilibrium free): no series does better by more than 0.1 %, so this much is noise or contradiction
        of the data [-].
    """

    series: PronySeries
    storage: Misfit
    loss: Misfit
    tan_delta: Misfit
    window: tuple[float, float]
    grid_terms: int
    condition: float
    residual: float
    consistency_floor: float

    @property
    def active_terms(self) -> int:
        """Number of terms the fit kept [-]."""
        return int(self.series.times.size)


def fit_prony(
    frequency: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    *,
    terms_per_decade: float = 1.0,
    times: ArrayLike | None = None,
    equilibrium: float | None = None,
) -> PronyFit:
    """Fit a Prony series to a master curve.

    Parameters
    ----------
    frequency : array_like
        CYCLIC frequency f in HERTZ, not rad/s: omega = 2 pi f is formed here. Shape `(n,)`, any order [Hz].
    storage : array_like
        E' at them, shape `(n,)` [Pa].
    loss : array_like
        E'' at them, shape `(n,)` [Pa].
    terms_per_decade : float
        Density of the relaxation times, spread evenly in log over the window 1/omega_max ... 1/omega_min,
        ends included; not used with `times` [1/decade].
    times : array_like, optional
        Relaxation times to use instead, shape `(m,)`; outside the window only with `equilibrium` held [s].
    equilibrium : float, optional
        Equilibrium modulus to hold, below every E'; fitted when left out [Pa].

    Returns
    -------
    PronyFit
        The series and its statistics.

    Raises
    ------
    InputError
        If a value is not finite and > 0 (the message names the row), lengths differ, fewer than two
        distinct frequencies are given, or `times` leave the window without `equilibrium`.
    NoSolutionError
        If the best equilibrium modulus is zero, or no term is active.

    Notes
    -----
    Minimised is the sum of squared RELATIVE errors of E' and E'' with all moduli >= 0 (NNLS), so every decade
    weighs the same. Rows of equal frequency are kept as separate rows: they are separate measurements, and
    least squares then weighs their mean by their number. Times outside the window are not determined by
    the data: with them a free E_e of the shelf's S120 fell from 3 MPa to 0 at nearly the same residual.

    A dense grid (2 a decade and more) returns twins: neighbours that together stand for one time between
    them. They are not merged: the pair is the least-squares answer on its grid, and a merged line would
    suggest a resolution that the data do not have. For a short series ask for fewer terms per decade: at the
    default there are no twins. A discrete series interpolates the curve; it is not the rubber's spectrum.

    `consistency_floor` is a Kramers-Kronig test in the measurement-model form: E' and E'' of a solid with
    fading memory come from one positive spectrum, so what the densest of these leaves over is noise,
    contradiction of E' and E'', or a master curve that was not one material state.

    References
    ----------
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23 (NNLS).
    M. Baumgaertel, H. H. Winter, Rheol. Acta 28 (1989) 511-519 (relative errors, parsimony).
    B. A. Boukamp, J. Electrochem. Soc. 142 (1995) 1885-1894 (Kramers-Kronig by measurement model).

    Examples
    --------
    >>> import numpy as np
    >>> truth = PronySeries(1e6, [2e6, 5e6], [1e-4, 1e-2])
    >>> f = np.logspace(0, 4, 30)
    >>> omega = 2 * np.pi * f
    >>> fit = fit_prony(f, truth.storage(omega), truth.loss(omega), times=[1e-4, 1e-2])
    >>> fit.active_terms, round(fit.series.equilibrium), fit.storage.rms < 1e-12
    (2, 1000000, True)
    """
    f, e1, e2 = _rows(frequency, storage, loss)
    omega = 2.0 * np.pi * f
    density = positive("terms_per_decade", terms_per_decade, "1/decade")
    held = None if equilibrium is None else _held(equilibrium, e1)
    tau = _grid(omega, density) if times is None else _given(times, omega, held)
    moduli, matrix = _solve(omega, e1, e2, tau, held)
    active = moduli > DUST * e1.min()
    fitted, terms = float(moduli[0]) if held is None else held, active[1:]
    if not active[0]:
        raise NoSolutionError(
            "the best equilibrium modulus is 0 (a fluid): the data do not reach the rubbery plateau;"
            " measure lower frequencies or hotter, or hold it with equilibrium=<measured value in Pa>"
        )
    if not terms.any():
        raise NoSolutionError(
            "no relaxation time fits the loss modulus: check times, and that frequency is in Hz"
        )
    series = PronySeries(fitted, moduli[1:][terms], tau[terms])
    columns = matrix[:, active] / np.linalg.norm(matrix[:, active], axis=0)
    error1, error2 = series.storage(omega) / e1 - 1.0, series.loss(omega) / e2 - 1.0
    return PronyFit(
        series=series,
        storage=_misfit(error1, f),
        loss=_misfit(error2, f),
        tan_delta=_misfit((1.0 + error2) / (1.0 + error1) - 1.0, f),
        window=(float(f[0]), float(f[-1])),
        grid_terms=int(tau.size),
        condition=float(np.linalg.cond(columns)),
        residual=float(np.sqrt((error1 @ error1 + error2 @ error2) / (2 * f.size))),
        consistency_floor=_floor(omega, e1, e2),
    )


def _rows(
    frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Check every row, then sort by frequency."""
    columns = {"frequency": (frequency, "Hz"), "storage": (storage, "Pa"), "loss": (loss, "Pa")}
    arrays = {name: np.array(values, dtype=np.float64) for name, (values, _) in columns.items()}
    f = arrays["frequency"]
    if f.ndim != 1 or any(a.shape != f.shape for a in arrays.values()):
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items())
        raise InputError(f"frequency, storage and loss must have one shape (n,); got {shapes}")
    for name, a in arrays.items():
        bad = np.flatnonzero(~(np.isfinite(a) & (a > 0.0)))
        if bad.size:
            row = int(bad[0])
            where = f"row {row + 1}" if name == "frequency" else f"row {row + 1} (frequency {f[row]:g} Hz)"
            raise InputError(f"{where}: {name} = {a[row]:g} {columns[name][1]} must be finite and > 0")
    if np.unique(f).size < 2:
        raise InputError(f"a fit needs at least 2 distinct frequencies; got {np.unique(f).size}")
    order = np.argsort(f, kind="stable")
    return f[order], arrays["storage"][order], arrays["loss"][order]


def _held(equilibrium: float, storage: FloatArray) -> float:
    value = positive("equilibrium", equilibrium, "Pa")
    if value >= storage.min():
        raise InputError(
            f"equilibrium = {value:g} Pa must be below the smallest storage modulus, {storage.min():g} Pa"
        )
    return value


def _grid(omega: FloatArray, per_decade: float, extra: float = 0.0) -> FloatArray:
    """Space times evenly in log over the window, ends included, `extra` decades wider on both sides."""
    low, high = -np.log10(omega[-1]) - extra, -np.log10(omega[0]) + extra
    return np.logspace(low, high, max(2, round((high - low) * per_decade) + 1))


def _given(times: ArrayLike, omega: FloatArray, held: float | None) -> FloatArray:
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


def _solve(
    omega: FloatArray, storage: FloatArray, loss: FloatArray, tau: FloatArray, held: float | None
) -> tuple[FloatArray, FloatArray]:
    """Moduli, equilibrium first, and the matrix of relative rows (moduli in units of a typical E')."""
    unit = float(np.exp(np.mean(np.log(storage))))
    x = np.outer(omega, tau)
    debye = x / np.square(np.hypot(1.0, x))
    top = np.column_stack([np.ones_like(omega), x * debye]) * (unit / storage)[:, None]
    bottom = np.column_stack([np.zeros_like(omega), debye]) * (unit / loss)[:, None]
    matrix = np.vstack([top, bottom])
    target = np.ones(len(matrix))
    if held is None:
        moduli, _ = nnls(matrix, target)
    else:
        rest, _ = nnls(matrix[:, 1:], target - matrix[:, 0] * (held / unit))
        moduli = np.concatenate([[held / unit], rest])
    return moduli * unit, matrix


def _misfit(error: FloatArray, frequency: FloatArray) -> Misfit:
    k = int(np.argmax(np.abs(error)))
    return Misfit(float(np.sqrt(np.mean(error**2))), float(error[k]), float(frequency[k]))


def _floor(omega: FloatArray, storage: FloatArray, loss: FloatArray) -> float:
    moduli, matrix = _solve(
        omega, storage, loss, _grid(omega, FLOOR_TERMS_PER_DECADE, FLOOR_EXTRA_DECADES), None
    )
    unit = float(np.exp(np.mean(np.log(storage))))
    return float(np.sqrt(np.mean((matrix @ (moduli / unit) - 1.0) ** 2)))
