"""Prony series from a measured master curve: non-negative least squares on relative errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray, positive_number
from conveyor.arguments.limits import require, require_not_negative
from conveyor.errors import NoSolutionError
from conveyor.rubber.fit_rows import (
    NO_TERM,
    FitRows,
    checked_rows,
    even_times,
    fit_moduli,
    given_times,
    held_equilibrium,
    scale_to_fit,
)
from conveyor.rubber.misfit import Misfit, neighbour_correlation, relative_misfit, row_scatter
from conveyor.rubber.prony import PronySeries
from conveyor.rubber.term_count import REACH, Candidate, PenalisedFit, choose_terms

__all__ = ["Misfit", "PronyFit", "fit_prony"]

REFERENCE_TERMS_PER_DECADE = 2.0
"""Density of the fit that errors are relative to: any spectrum to a few per cent, less than makes a row an outlier
(eight times `conveyor.rubber.misfit.LEAST_SCATTER`)."""
FLOOR_TERMS_PER_DECADE = 10.0
"""Spectrum lines of the consistency test. Lines d apart in ln(time) ripple by 4 exp(-pi^2/d): here 1e-18."""
FLOOR_EXTRA_DECADES = 3.0
"""Reach of the consistency test beyond the window: farther lines move E'' by < 1e-3 of their weight."""


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
        Lowest and highest measured frequency: outside, the series is a guess [Hz].
    grid_terms : int
        Terms offered; `active_terms` is what the data took [-].
    condition : float
        Condition number of the active columns, each scaled to unit length [-].
    residual : float
        Root mean square of all weighted relative errors, E' and E'' together: what was minimised [-].
    consistency_floor : float
        The same for the best of ALL positive spectra (ten lines a decade, three decades beyond the window,
        equilibrium free): no series does better by more than 0.1 %, so this much is noise or contradiction
        of the data [-].
    best_errors : numpy.ndarray
        Relative errors of that spectrum, as `errors`, shape `(2, n)` [-].
    regularisation : float
        Strength of the penalty on the curvature of the spectrum [-].
    freedom : float
        Effective number of fitted parameters [-].
    storage_noise : float or None
        Scatter of E' from row to row, see `conveyor.rubber.misfit.row_scatter` [-]; None for fewer than three rows. A
        `storage.rms` far above it is contradiction or lack of terms, not noise.
    loss_noise : float or None
        The same for E'' [-].
    correlation : float
        Correlation of each residual with its neighbour in frequency, the larger of E' and E'' [-].
    candidates : tuple of Candidate
        The criterion's table, the chosen line first; empty if the times were given.
    rows : FitRows
        The measurements as they were fitted, for `bootstrap`.
    held : float or None
        Equilibrium modulus held; None if fitted [Pa].

    Examples
    --------
    >>> frequency = np.logspace(-1.0, 4.0, 41)
    >>> series = PronySeries(4e6, [1e6, 2e6, 4e6], [1e-3, 1e-2, 1e-1])
    >>> omega = 2.0 * np.pi * frequency
    >>> fit_prony(frequency, series.storage(omega), series.loss(omega), times=series.times)
    PronyFit(3 terms, 0.1 to 1e+04 Hz, equilibrium modulus 4 MPa, error of E' 0.0 %, of E'' 0.0 %)
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
    best_errors: FloatArray = field(repr=False, compare=False)
    regularisation: float
    freedom: float
    storage_noise: float | None
    loss_noise: float | None
    correlation: float
    candidates: tuple[Candidate, ...]
    rows: FitRows = field(repr=False, compare=False)
    held: float | None

    @property
    def active_terms(self) -> int:
        """Number of terms the fit kept [-]."""
        return int(self.series.times.size)

    @property
    def spent(self) -> float:
        """Effective parameters over the values that they were fitted to [-]."""
        return _spent_share(self.freedom, self.rows)

    @property
    def relative_errors(self) -> FloatArray:
        """Relative errors of E', then of E'', series over data minus one, shape `(2, n)` [-]."""
        rows, omega = self.rows, self.rows.omega
        return np.array([self.series.storage(omega) / rows.storage, self.series.loss(omega) / rows.loss]) - 1.0

    def __repr__(self) -> str:
        low, high = self.window
        return (
            f"PronyFit({self.active_terms} terms, {low:.3g} to {high:.3g} Hz, equilibrium modulus "
            f"{self.series.equilibrium / 1e6:.3g} MPa, error of E' {100.0 * self.storage.rms:.1f} %, "
            f"of E'' {100.0 * self.loss.rms:.1f} %)"
        )

    def _repr_html_(self) -> str:
        """For notebooks: the series, and how far it is from the data."""
        from conveyor.text.markup import name_value_table

        rows = [
            ("data", f"{self.window[0]:.4g} to {self.window[1]:.4g} Hz"),
            *(
                (
                    f"{name}, error",
                    f"rms {100.0 * error.rms:.1f} %, worst {100.0 * error.worst:+.1f} % at "
                    f"{error.worst_frequency:.3g} Hz",
                )
                for name, error in (("E'", self.storage), ("E''", self.loss), ("tan δ", self.tan_delta))
            ),
            ("any positive spectrum leaves", f"{100.0 * self.consistency_floor:.1f} %"),
        ]
        return f"{name_value_table('PronyFit', rows)}{self.series._repr_html_()}"


def fit_prony(
    frequency: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    *,
    terms_per_decade: float | None = None,
    times: ArrayLike | None = None,
    equilibrium: float | None = None,
    regularisation: float | None = None,
    relative_to: Literal["fit", "data"] | None = None,
    storage_error: ArrayLike | None = None,
    loss_error: ArrayLike | None = None,
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
    terms_per_decade : float, optional
        Density of the relaxation times, spread evenly in log over the window 1/omega_max ... 1/omega_min,
        ends included; not used with `times`. Chosen by the criterion, with times to a decade beyond, when both
        are left out [1/decade].
    times : array_like, optional
        Relaxation times to use instead, shape `(m,)`; outside the window only with `equilibrium` held [s].
    equilibrium : float, optional
        Equilibrium modulus to hold, below every E'; fitted when left out [Pa].
    regularisation : float, optional
        Strength of the penalty on the curvature of the spectrum, >= 0, see `PenalisedFit`. Left out: chosen by
        the criterion together with the density; 0 where density or times are given [-].
    relative_to : {"fit", "data"}, optional
        What the minimised errors are divided by. Left out: the fit; the data where density or times are
        given, which with no penalty is the plain least squares of the literature [-].
    storage_error : array_like, optional
        Relative standard error of E', one number or shape `(n,)`; rows weigh by its reciprocal [-].
    loss_error : array_like, optional
        The same for E''; both or neither [-].

    Returns
    -------
    PronyFit
        The series and its statistics.

    Raises
    ------
    InputError
        If a value is not finite and > 0 (the message names the row), lengths differ, fewer than two
        distinct frequencies are given, `times` leave the window without `equilibrium`, or the rows are too
        few to choose the number of terms.
    NoSolutionError
        If the best equilibrium modulus is zero, or no term is active.

    Notes
    -----
    Minimised is the sum of squared RELATIVE errors of E' and E'' with all moduli >= 0 (NNLS), so every decade
    weighs the same. Rows of equal frequency are kept as separate rows: they are separate measurements, and
    least squares then weighs their mean by their number.

    Where density and times are chosen, the times reach a decade beyond the window on both sides: without them the
    tails of what relaxes outside are missing, and E'' at the ends turns down by some ten per cent. Farther times
    are not determined by the data: with them a free E_e of the shelf's S120 fell from 3 MPa to 0 at nearly the same
    residual.
    A decade loses it 13 %, and the penalty holds the spectrum there to the slope that E'' has at the end of the
    window (see `PenalisedFit`). So E_e is what does not relax within ten times the slowest measured period.

    There, too, a row that stands off by more than four robust standard deviations of its modulus loses its
    pull (`conveyor.rubber.misfit.hampel_weights`); it still counts in the misfits.

    The number of terms: densities of 2 to 8 a decade and seven strengths of the penalty are fitted, spectra of few
    lines on finer ones, and of those that AICc cannot tell from the best the one with the fewest terms is taken
    (see `choose_terms`).

    A dense grid (2 a decade and more) returns twins: neighbours that together stand for one time between
    them. They are not merged: the pair is the least-squares answer on its grid, and a merged line would
    suggest a resolution that the data do not have. For a short series ask for fewer terms per decade.

    A discrete series INTERPOLATES the curve; it is not the rubber's spectrum. Between lines d apart in ln(tau)
    the loss modulus of a smooth spectrum ripples by about 4 exp(-pi^2/d) (half peak to peak): 5.5 % at one
    term a decade, 0.64 % at 1.5, 0.08 % at two. It shows in whatever is a slope: local exponents of
    the contact's load or speed.

    `consistency_floor` is a Kramers-Kronig test in the measurement-model form: E' and E'' of a solid with
    fading memory come from one positive spectrum, so what the densest of these leaves over is noise,
    contradiction of E' and E'', or a master curve that was not one material state.

    References
    ----------
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23 (NNLS).
    M. Baumgaertel, H. H. Winter, Rheol. Acta 28 (1989) 511-519 (relative errors, parsimony).
    J. Honerkamp, J. Weese, Macromolecules 22 (1989) 4372-4377 (regularisation).
    C. M. Hurvich, J. S. Simonoff, C.-L. Tsai, J. R. Stat. Soc. B 60 (1998) 271-293 (AICc).
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
    rows = checked_rows(frequency, storage, loss, storage_error=storage_error, loss_error=loss_error)
    held = None if equilibrium is None else held_equilibrium(equilibrium, rows.storage)
    asked = None if regularisation is None else _penalty_strength(regularisation)
    tau = _chosen_times(rows, terms_per_decade, times, held)
    if _error_reference(relative_to, chosen=tau is None) == "fit":
        first = even_times(rows.omega, REFERENCE_TERMS_PER_DECADE, REACH) if tau is None else tau
        rows = scale_to_fit(rows, first, held)
    candidates: tuple[Candidate, ...] = ()
    strength = 0.0 if asked is None else asked
    if tau is None:
        tau, strength, candidates = choose_terms(rows, held, *([] if asked is None else [(asked,)]))
    return _fit_on_times(rows, tau, strength, held, candidates)


def _chosen_times(
    rows: FitRows, density: float | None, times: ArrayLike | None, held: float | None
) -> FloatArray | None:
    if density is not None:
        positive_number("terms_per_decade", density, "1/decade")
    if times is not None:
        return given_times(times, rows.omega, held)
    return None if density is None else even_times(rows.omega, density)


def _penalty_strength(regularisation: float) -> float:
    require_not_negative(regularisation=regularisation)
    return float(regularisation)


def _error_reference(relative_to: str | None, *, chosen: bool) -> str:
    require(relative_to in {"fit", "data", None}, "relative_to", relative_to, "fit, data")
    return relative_to or ("fit" if chosen else "data")


def _fit_on_times(
    rows: FitRows, tau: FloatArray, strength: float, held: float | None, candidates: tuple[Candidate, ...]
) -> PronyFit:
    """Fit on given times, and collect the statistics."""
    problem = PenalisedFit(rows, tau, held)
    solution = problem.judged(rows.target, strength)
    moduli = solution.moduli
    terms = moduli[1:] > 0.0
    if not moduli[0] > 0.0:
        raise NoSolutionError(
            "the best equilibrium modulus is 0 (a fluid): the data do not reach the rubbery plateau;"
            " measure lower frequencies or hotter, or hold it with equilibrium=<measured value in Pa>"
        )
    if not terms.any():
        raise NoSolutionError(NO_TERM)
    series = PronySeries(float(moduli[0]), moduli[1:][terms], tau[terms])
    columns = rows.matrix(tau)[:, moduli > 0.0]
    best = _best_errors(rows)
    f, omega = rows.frequency, rows.omega
    storage, loss = series.storage(omega), series.loss(omega)
    error1, error2 = storage / rows.storage - 1.0, loss / rows.loss - 1.0
    spent = _spent_share(solution.freedom, rows)
    return PronyFit(
        series=series,
        storage=relative_misfit(error1, f),
        loss=relative_misfit(error2, f),
        tan_delta=relative_misfit((1.0 + error2) / (1.0 + error1) - 1.0, f),
        window=(float(f[0]), float(f[-1])),
        grid_terms=int(tau.size),
        condition=float(np.linalg.cond(columns / np.linalg.norm(columns, axis=0))),
        residual=solution.residual,
        consistency_floor=float(np.sqrt(np.mean(best**2))),
        best_errors=(best / rows.target).reshape(2, -1),
        regularisation=strength,
        freedom=solution.freedom,
        storage_noise=row_scatter(f, rows.storage, storage, spent),
        loss_noise=row_scatter(f, rows.loss, loss, spent),
        correlation=max(neighbour_correlation(error1), neighbour_correlation(error2)),
        candidates=candidates,
        rows=rows,
        held=held,
    )


def consistency_floor(frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike) -> float:
    """Residual of the best of all positive spectra [-], see `PronyFit.consistency_floor`."""
    best, _ = _best_of_rows(frequency, storage, loss)
    return float(np.sqrt(np.mean(best**2)))


def scatter_about_best(frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike) -> tuple[float | None, float | None]:
    """Scatter of E' and E'' from row to row about the best of all positive spectra [-], see `row_scatter`."""
    best, rows = _best_of_rows(frequency, storage, loss)
    curve, other = np.split((best + rows.target) * rows.scale, 2)
    return row_scatter(rows.frequency, rows.storage, curve), row_scatter(rows.frequency, rows.loss, other)


def _best_of_rows(frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike) -> tuple[FloatArray, FitRows]:
    """Errors of `_best_errors` and their rows, for errors relative to the fit."""
    rows = checked_rows(frequency, storage, loss, storage_error=None, loss_error=None)
    rows = scale_to_fit(rows, even_times(rows.omega, REFERENCE_TERMS_PER_DECADE, REACH), None)
    return _best_errors(rows), rows


def _spent_share(freedom: float, rows: FitRows) -> float:
    return freedom / (2.0 * rows.frequency.size)


def _best_errors(rows: FitRows) -> FloatArray:
    """Errors of the best of all positive spectra over the scale of the rows, shape `(2n,)` [-]."""
    tau = even_times(rows.omega, FLOOR_TERMS_PER_DECADE, FLOOR_EXTRA_DECADES)
    return np.asarray(rows.matrix(tau) @ fit_moduli(rows, tau, None) - rows.target)
