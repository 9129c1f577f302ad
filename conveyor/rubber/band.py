"""Bootstrap of a fit: replicas of the series at the same times, for the uncertainty of any result."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray, non_negative_array, positive_vector
from conveyor.arguments.limits import require, require_count
from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber.fit import PronyFit
from conveyor.rubber.master_curve import Superposition
from conveyor.rubber.prony import PronySeries
from conveyor.rubber.shift import ShiftLaw
from conveyor.rubber.term_count import PenalisedFit

BOOTSTRAP_METHOD = (
    "block bootstrap of the relative residuals; penalty, weights of E' and E'' and shifts drawn too; moduli refitted at"
    " the same times"
)
RESIDUAL_WIDENING = 1.1
"""Widening of the residuals: with it the 90 % band covers the truth as `bootstrap` says (benchmarks/families.py).
Without it some 3 % less: times and penalty, chosen from the same data, stay fixed in the replicas [-]."""
UNPENALISED_WIDENING = 1.3
"""The same without penalty: the times of few lines are parameters too, at most as many as moduli, sqrt(2) [-]."""
WEIGHT_SCATTER = 0.5
"""Standard deviation of ln of the factor that weighs E' against E'' in a replica: 1.6 (general knowledge; at two the
band of friction covers the truth too often). It moves a fit where the two contradict each other [-]."""
LEVERAGE_LIMIT = 0.9
"""Largest leverage a residual is corrected for: beyond, it is rounding divided by rounding [-]."""
DRAWS_PER_REPLICA = 20
"""Mean number of draws allowed for one replica that is a solid."""


@dataclass(frozen=True, eq=False)
class ReplicaBand:
    """Replicas of a fitted series, all at the times of the fit.

    Parameters
    ----------
    times : numpy.ndarray
        Relaxation times, shape `(n,)`, ascending [s].
    equilibrium : numpy.ndarray
        Equilibrium modulus of each replica, shape `(replicas,)`, > 0 [Pa].
    moduli : numpy.ndarray
        Moduli of each replica, shape `(replicas, n)`, >= 0 [Pa].
    log10_a_T : numpy.ndarray, optional
        Shift of each replica at the temperatures of the isotherms, shape `(replicas, t)` [decades].
    log10_b_T : numpy.ndarray, optional
        Its vertical shift, likewise [decades].
    laws : tuple of ShiftLaw
        Shift law of each replica, where rows were laid by a law.

    Raises
    ------
    InputError
        If shapes disagree, or a number is not finite, negative, or an equilibrium modulus is not > 0.

    Examples
    --------
    >>> band = ReplicaBand([1e-3, 1.0], [1e6, 2e6], [[1e6, 0.0], [2e6, 1e6]])
    >>> [s.times.size for s in band.series()]
    [1, 2]
    """

    times: FloatArray
    equilibrium: FloatArray
    moduli: FloatArray
    log10_a_T: FloatArray | None = None  # noqa: N815
    log10_b_T: FloatArray | None = None  # noqa: N815
    laws: tuple[ShiftLaw, ...] = ()

    def __post_init__(self) -> None:
        """Check, copy, freeze."""
        times = positive_vector("times", self.times, "s")
        equilibrium = positive_vector("equilibrium", self.equilibrium, "Pa")
        moduli = np.array(self.moduli, dtype=np.float64)
        if moduli.shape != (equilibrium.size, times.size):
            raise InputError(
                f"moduli must have one row per replica and one column per time, shape"
                f" ({equilibrium.size}, {times.size}); got {moduli.shape}"
            )
        moduli = non_negative_array("moduli", moduli, "Pa")
        if np.any(np.diff(times) <= 0.0):
            raise InputError("times of a band must ascend and be distinct")
        for name, array in (("times", times), ("equilibrium", equilibrium), ("moduli", moduli)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def series(self) -> tuple[PronySeries, ...]:
        """Each replica as a series; a modulus of 0 is left out.

        Returns
        -------
        tuple of PronySeries
            As many as there are replicas.
        """
        return tuple(
            PronySeries(float(e), m[m > 0.0], self.times[m > 0.0])
            for e, m in zip(self.equilibrium, self.moduli, strict=True)
        )

    def between(self, of: Callable[[PronySeries], FloatArray], *, level: float = 0.9) -> tuple[FloatArray, FloatArray]:
        """Band of any curve of a series.

        Parameters
        ----------
        of : callable
            Curve of a series, ``lambda series: series.loss(omega)``, shape `(m,)`.
        level : float
            Share of the replicas inside, equal tails cut, 0 to 1 [-].

        Returns
        -------
        tuple of numpy.ndarray
            Lower and upper end, shape `(m,)`, in its unit.

        Raises
        ------
        InputError
            If `level` is not between 0 and 1.
        """
        require(0.0 < level < 1.0, "level", level, "> 0 and < 1")
        tail = 0.5 * (1.0 - level)
        curves = [of(one) for one in self.series()]
        low, high = np.quantile(curves, (tail, 1.0 - tail), axis=0, method="weibull")
        return low, high


def bootstrap(
    fit: PronyFit,
    superposition: Superposition | None = None,
    temperature: ArrayLike | None = None,
    *,
    law: Callable[[FloatArray], ShiftLaw] | None = None,
    replicas: int = 200,
    seed: int = 0,
) -> ReplicaBand:
    """Draw replicas of a fitted series that the same measurement could have given.

    Parameters
    ----------
    fit : PronyFit
        The fit; its times, penalty and weights are kept.
    superposition : Superposition, optional
        What the fitted rows were shifted by; without it the rows count as measured at one temperature.
    temperature : array_like, optional
        Of every fitted row, shape `(m,)` [K], where other rows than the isotherms' were laid on their curve: a row
        between two isotherms moves with both, in proportion.
    law : callable, optional
        Makes a law of log10 a_T at the temperatures of the superposition: where rows were laid by that law.
    replicas : int
        Number of series, >= 1 [-].
    seed : int
        Of the random numbers: the same seed draws the same series [-].

    Returns
    -------
    ReplicaBand
        The replicas at the times of `fit.series`, with the shifts that each of them goes with.

    Raises
    ------
    InputError
        If `replicas` is below 1, or the superposition has other rows than the fit.
    NoSolutionError
        If the data hardly ever give an equilibrium modulus, or shifts that fall with temperature.

    Notes
    -----
    The data of a replica are the rows times ratios data/fit, drawn with their neighbours in circular blocks,
    E' and E'' of one frequency together. In logarithms the ratios are freed of their leverage h, by
    1/sqrt(1 - L h), and widened by `RESIDUAL_WIDENING` or `UNPENALISED_WIDENING`; their mean is brought to 1. A
    block has
    L = (1 + c)/(1 - c) rows, the time constant of a first-order process whose neighbours correlate by c;
    L = 1 where c cannot be told from noise. Residuals of outliers count by their trust only.

    The penalty on the curvature is a prior, and each curvature is held to a draw of it: what the data do not
    determine, in gaps and beyond the window, scatters as the spectrum does elsewhere. Such bands of a penalised curve
    cover the truth, bias included, at their nominal rate on the mean over the window.

    Each replica weighs E' against E'' anew, by `WEIGHT_SCATTER`: where they contradict each other, which no scatter of
    rows shows, the band covers how far the compromise moves with their weights.

    Of isotherms, each replica first draws the shifts from their covariance, in pairs of both signs, vertical ones
    too where they were fitted or are missing, and lays the rows out anew. Where the isotherms contradict each other it
    takes the chosen shifts or one of the variants that contradict them, with equal chances
    (`conveyor.rubber.master_curve.Superposition.drawn`). E'' that grows in proportion to measured frequency is
    brought down to what it is at none; E'' that grows with its decades to what it is at one, drawn evenly over the
    measured decades: where the instrument tells the phase rightly is not known. It keeps these shifts: at another
    temperature most of an error of the shift takes back what it did to the curve. A law is made anew of them, and of
    what it missed of the shifts with signs drawn (wild bootstrap): where shifts do not follow it, the band is as wide.

    Coverage of the truth by the 90 % band: see docs/rubber.md, and benchmarks/families.py. At its worst frequency
    it is 50 to 75 %: at the ends of the window, and in valleys of E'' between lines of a spectrum that IS discrete.

    Draws whose best equilibrium modulus is 0 are drawn again: a cover is a solid. So are shifts that rise with
    temperature.

    The band does not hold what every row has in common (a wrong strain or thermometer).

    References
    ----------
    D. N. Politis, J. P. Romano, A circular block-resampling procedure for stationary data, in: Exploring the
    Limits of Bootstrap (1992) 263-270.
    J. G. MacKinnon, H. White, J. Econometrics 29 (1985) 305-325 (leverage, HC2).
    G. Wahba, J. R. Stat. Soc. B 45 (1983) 133-150; D. Nychka, J. Am. Stat. Assoc. 83 (1988) 1134-1143 (bands of
    a penalised curve, from its prior).
    C. F. J. Wu, Ann. Statist. 14 (1986) 1261-1295 (wild bootstrap).

    Examples
    --------
    >>> from conveyor.rubber.fit import fit_prony
    >>> truth = PronySeries(1e6, [2e6, 5e6], [1e-4, 1e-2])
    >>> f = np.logspace(0, 4, 30)
    >>> noise = 1 + 0.02 * np.random.default_rng(1).standard_normal((2, 30))
    >>> w = 2 * np.pi * f
    >>> fit = fit_prony(f, truth.storage(w) * noise[0], truth.loss(w) * noise[1], times=[1e-4, 1e-2])
    >>> low, high = bootstrap(fit, replicas=100).between(lambda series: series.loss([1e3]))
    >>> bool(low[0] < truth.loss(1e3) < high[0])
    True
    """
    require_count(1, replicas=replicas)
    series, rows = fit.series, fit.rows
    times = series.times
    problem = PenalisedFit(rows, times, fit.held)
    moduli = np.concatenate([[series.equilibrium], series.moduli])
    fitted = rows.matrix(times) @ moduli
    ratio, block = _resampling_ratios(
        1.0 + (rows.target / fitted - 1.0) * rows.trust,
        problem.leverage(moduli, fit.regularisation),
        RESIDUAL_WIDENING if fit.regularisation else UNPENALISED_WIDENING,
    )
    size = rows.frequency.size
    spread = RESIDUAL_WIDENING * fit.residual * float(np.sqrt(2 * size / max(2 * size - fit.freedom, 1.0)))
    generator = np.random.default_rng(seed)
    fits: list[FloatArray] = []
    kept: list[_ReplicaShift] = []
    draws = None
    if superposition is not None:
        at = _row_temperatures(superposition, temperature, size)
        draws = _draw_shifts(superposition, at, rows.frequency, law, generator)
    for _ in range(DRAWS_PER_REPLICA * replicas):
        starts = generator.integers(0, size, -(-size // block))
        taken = ((starts[:, None] + np.arange(block)) % size).ravel()[:size]
        lean = np.repeat(np.exp(WEIGHT_SCATTER * np.array([1.0, -1.0]) * generator.standard_normal()), size)
        drawn = replace(rows, scale=rows.scale * lean)
        target = drawn.target * ratio[:, taken].ravel()
        shift = None if draws is None else next(draws)
        if draws is not None and shift is None:
            continue
        if shift is not None:
            drawn = replace(drawn, frequency=rows.frequency * 10.0 ** shift.moved[0])
            target = target * np.tile(10.0 ** -shift.moved[1], 2)
            target[size:] *= np.exp(-shift.tilt)
        problem = PenalisedFit(drawn, times, fit.held)
        bends = spread * generator.standard_normal(len(problem.bends))
        moduli = problem.solve(target, fit.regularisation, bends)
        if moduli[0] > 0.0:
            fits.append(moduli)
            kept += [] if shift is None else [shift]
        if len(fits) == replicas:
            break
    else:
        raise NoSolutionError(
            f"only {len(fits)} of {DRAWS_PER_REPLICA * replicas} draws are a solid whose shifts fall with temperature:"
            " the data hardly reach the rubbery plateau, or hardly tell the shifts; measure lower frequencies, or hold"
            " equilibrium="
        )
    spectra = np.array(fits)
    equilibrium, moduli = spectra[:, 0], spectra[:, 1:]
    if superposition is None:
        return ReplicaBand(times, equilibrium, moduli)
    if law is not None:
        laws = tuple(one.law for one in kept if one.law is not None)
        return ReplicaBand(times, equilibrium, moduli, laws=laws)
    tables = np.array([one.shifts for one in kept])
    vertical = tables[:, 1] if np.any(tables[:, 1]) or np.any(superposition.log10_b_T_error) else None
    return ReplicaBand(times, equilibrium, moduli, tables[:, 0], vertical)


@dataclass(frozen=True, eq=False)
class _ReplicaShift:
    """log10 a_T and log10 b_T of a replica, shape `(2, t)` [decades]; move of each row, error of its E''; law."""

    shifts: FloatArray
    moved: list[FloatArray]
    tilt: FloatArray
    law: ShiftLaw | None


def _row_temperatures(superposition: Superposition, temperature: ArrayLike | None, size: int) -> FloatArray:
    """Temperature of every fitted row [K]."""
    at = (
        superposition.temperatures[superposition.isotherm]
        if temperature is None
        else np.asarray(temperature, dtype=np.float64)
    )
    if at.size != size:
        raise InputError(f"the superposition has {at.size} rows, the fit {size}: fit its master curve")
    return at


def _draw_shifts(
    superposition: Superposition,
    at: FloatArray,
    frequency: FloatArray,
    maker: Callable[[FloatArray], ShiftLaw] | None,
    generator: np.random.Generator,
) -> Iterator[_ReplicaShift | None]:
    """Draw shifts from their covariance, endlessly; None where no law follows or they rise."""
    known = superposition.temperatures
    laid = superposition.shifts
    if maker is not None:
        laid = np.array([maker(laid[0]).log10_a_T(known), laid[1]])
    missed = (superposition.shifts - laid)[0]
    measured = np.log10(frequency) - np.interp(at, known, laid[0])
    while True:
        for drawn in reversed(superposition.drawn(generator)):
            law, shifts = None, drawn.shifts
            if maker is not None:
                try:
                    law = maker(shifts[0] + generator.choice([-2.0, 0.0], known.size) * missed)
                except NoSolutionError:
                    yield None
                    continue
                shifts = np.array([law.log10_a_T(known), shifts[1]])
            moved = [np.interp(at, known, change) for change in shifts - laid]
            tilt = drawn.lag_slope * 10.0**measured
            if drawn.phase_slope:
                right = generator.uniform(float(measured.min()), float(measured.max()))
                tilt += drawn.phase_slope * (measured - right)
            kept = shifts if drawn.vertical else shifts * [[1.0], [0.0]]
            yield None if np.any(np.diff(shifts[0]) >= 0.0) else _ReplicaShift(kept, moved, tilt, law)


def _resampling_ratios(
    ratio: FloatArray, leverage: FloatArray, widened: float = RESIDUAL_WIDENING
) -> tuple[FloatArray, int]:
    """Ratios data/fit of E' and E'' to draw from, `(2, n)`, mean 1 each [-], and the block length [rows]."""
    error = (ratio - 1.0).reshape(2, -1)
    size = error.shape[1]
    total = float(np.sum(error**2))
    together = float(np.sum(error[:, 1:] * error[:, :-1])) / total if total > 0.0 else 0.0
    told = together > 2.0 / np.sqrt(2 * size)
    block = min(max(1, size // 4), int(np.ceil((1.0 + together) / (1.0 - together)))) if told else 1
    freed = np.log(ratio) * widened / np.sqrt(1.0 - np.minimum(block * leverage, LEVERAGE_LIMIT))
    drawn = np.exp(freed).reshape(2, -1)
    return drawn / drawn.mean(axis=1, keepdims=True), block
