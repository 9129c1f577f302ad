"""Criteria for signing a master curve: calculated and required, pass or fail."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import ConveyorError
from conveyor.fitting.amplitude import UNLIKE_STRAINS, amplitude_ratio, strain_text
from conveyor.fitting.findings import DOUBTFUL_RESIDUAL, SCATTER_MARGIN
from conveyor.fitting.fitted_compound import FittedCompound
from conveyor.fitting.levels import LEVEL_LIMIT
from conveyor.fitting.measured_rows import MeasuredRows
from conveyor.fitting.shift_choice import slope_text
from conveyor.models import Conveyor
from conveyor.rubber import PronySeries, ShiftComparison, Superposition
from conveyor.rubber.strain import FEWEST_SCATTER_POINTS
from conveyor.units import text
from conveyor.units.sentences import percent, to_celsius

VerdictWord = Literal["pass", "FAIL", "not checked"]

NOISE_LIMITS: Final = (0.03, 0.06)
"""Largest scatter of E' and E'' from row to row (general knowledge: a DMA on rubber holds 1 and 3 %) [-]."""
SHIFT_LIMIT: Final = 0.1
"""Largest uncertainty of log10 a_T: 1 K near the glass transition (`conveyor.rubber.superpose`) [decades]."""
LEFT_OUT_LIMIT: Final = 0.2
"""Largest error of a shift left out: E' of a rubber goes as f^0.15, 0.2 are 7 % (general knowledge) [decades]."""
OVERLAP_LIMIT: Final = 0.5
"""Least overlap of neighbouring isotherms (docs/rubber.md, what to measure) [decades]."""
SHAPE_LIMIT: Final = 0.5
"""Correlation of neighbouring residuals beyond which isotherms differ in shape [-]."""
ANGLE_REPEATABILITY: Final = 0.3
"""Repeatability of the phase angle of a DMA (general knowledge: 0.1 to 0.3 degrees) [degrees]."""
MODULUS_REPEATABILITY: Final = 0.005
"""Repeatability of |E*| of a DMA (general knowledge) [-]."""
SCATTER_LIMIT: Final = 2.0
"""Largest difference over the scatter of the rows: 95 % of a normal distribution lie within twice [-]."""
ROLL_BAND: Final = (150.0, 2500.0)
"""Band of nine tenths of the loss of a carry roll: 159 mm, 4 mm of cover, 5 m/s (docs/rubber.md, section 1) [Hz]."""
FEWEST_COMMON: Final = 3
"""Least rows of an isotherm within the next one's line: twice their scatter by chance in 2 % of two, 1 % of three."""
LINE_POINTS: Final = 8
"""Points of a line between two rows: its sag falls by the square, 64 times."""
PHASE_SLOPE_LIMIT: Final = 0.03
"""Largest change of E'' per decade of measured frequency: `ANGLE_REPEATABILITY` is 5 % of E'' at tan δ 0.1, over the
1.7 decades of a usual isotherm 3 % [-]."""
KRAMERS_KRONIG_LIMIT: Final = 0.1
"""Largest rms error of one modulus predicted from the other (general knowledge) [-]."""
RESIDUAL_MARGIN: Final = 0.01
"""Residual above that of the best positive spectrum: the scatter of a good instrument [-]."""
END_LIMIT: Final = 0.05
"""Largest mean error of E' and E'' over the half decade at either end of the window [-]."""
END_DECADES: Final = 0.5
"""Length of an end of the window: three rows at six to the decade (general knowledge) [decades]."""

GLOSSARY: Final = (
    ("E', E''", "storage and loss modulus, in tension: stress in phase and out of phase over strain"),
    ("tan δ", "E''/E', loss over storage; δ is the phase angle"),
    ("isotherm", "E' and E'' over frequency at one temperature"),
    ("a_T", "shift factor: what frequencies at T are multiplied by to lie on the curve of the reference temperature"),
    ("b_T", "vertical shift: what moduli at T are divided by; 1 unless chosen; T/T_ref of an entropic network"),
    ("master curve", "all isotherms at their shifted frequencies"),
    ("WLF, Arrhenius", "formulas of a_T over temperature: near the glass transition, far above it"),
    ("van Gurp-Palmen", "phase angle over |E*|: free of frequency: isotherms of one material lie on one curve"),
    ("Cole-Cole", "E'' over E', likewise free of frequency"),
    ("Kramers-Kronig", "each modulus follows from the other over all frequencies; else it was not one material state"),
    ("Prony series", "E(t) = E_e + sum of E_i exp(-t/τ_i): springs and dashpots that E' and E'' follow from"),
    ("E_e, E_inf", "modulus at rest, and at infinite frequency"),
    ("best positive spectrum", "the closest curve that any Prony series could give; what it leaves is in the data"),
    ("90 % band", "what nine tenths of the replicas of the fit keep to, data resampled by their own residuals"),
    ("scatter", "of a row about the line through its neighbours, bent as the curve of all isotherms"),
    ("strain sweep", "E' and E'' over strain amplitude: filled rubber softens with it (Payne effect)"),
    ("overlap", "frequencies that two neighbouring isotherms share on the master curve"),
    ("correlation", "of each error with its neighbour's: near 0 for scatter, near 1 for a misfit with a shape"),
    ("rms", "root mean square"),
    ("AICc", "corrected Akaike criterion: how many terms, and how smooth a spectrum, the data support"),
    ("replica", "a series that the same measurement could have given, with its own shifts"),
    ("Poisson's ratio", "ν, sideways over lengthwise strain; turns G into E = 2(1 + ν) G"),
    ("window", "lowest to highest reduced frequency measured; beyond it nothing is known"),
)  # fmt: skip


@dataclass(frozen=True)
class Criterion:
    """One criterion: calculated, required, verdict and reason."""

    name: str
    calculated: str
    required: str
    verdict: VerdictWord
    why: str

    @property
    def line(self) -> str:
        """Criterion in one line."""
        why = f"; {self.why}" if self.verdict == "FAIL" else ""
        return f"{self.name}: " + (f"{self.calculated} ({self.required}){why}" if self.calculated else self.why)


def fit_criteria(fitted: FittedCompound, conveyor: Conveyor | None = None) -> tuple[Criterion, ...]:
    """Every criterion of a fit, with those of the rolls of a given conveyor.

    Parameters
    ----------
    fitted : FittedCompound
        The fit.
    conveyor : Conveyor, optional
        Its rolls, speed and temperature set the frequencies that the window must cover.
    """
    made = (
        _finding_criteria,
        _window_criteria,
        _noise_criteria,
        _strain_criteria,
        _sweep_criteria,
        _shift_criteria,
        _shape_criteria,
        _collapse_criteria,
        _consistency_criteria,
        _residual_criteria,
        _end_criteria,
    )
    return (
        *(one for of in made for one in of(fitted)),
        *(() if conveyor is None else coverage_criteria(fitted, conveyor)),
    )


def is_accepted(criteria: tuple[Criterion, ...]) -> bool:
    """True if no criterion fails."""
    return all(one.verdict != "FAIL" for one in criteria)


def record_failures(fitted: FittedCompound, criteria: tuple[Criterion, ...]) -> FittedCompound:
    """Fit whose compound names the criteria that it does not meet (`fit.failed`), for every report that uses it."""
    statistics = fitted.compound.fit
    failed = tuple(one.line for one in criteria if one.verdict == "FAIL")
    if statistics is None or failed == statistics.failed:
        return fitted
    return replace(fitted, compound=fitted.compound.replace(fit=statistics.replace(failed=failed)))


def _at_most(name: str, value: float, most: float, write: Callable[[float], str], why: str) -> Criterion:
    return Criterion(name, write(value), f"at most {write(most)}", "pass" if value <= most else "FAIL", why)


def _percent_text(value: float) -> str:
    return percent(value, 1)


def _decades_text(value: float) -> str:
    return f"{value:.2f} decades"


def _not_checked(name: str, why: str) -> Criterion:
    return Criterion(name, "", "", "not checked", why)


def _finding_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    """Findings that the user insisted on: data hardly of rubber stay so."""
    for one in fitted.accepted:
        yield Criterion(f"finding {one.name}", "accepted by the user", "no finding", "FAIL", one.text)


def _window_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    """The band of usual carry rolls within the window, at one temperature of the compound at least."""
    compound, (slow, fast) = fitted.compound, ROLL_BAND
    reference = compound.reference
    low, high = (reference, reference) if compound.range is None else compound.range.kelvin
    covered = [
        t
        for t in np.linspace(low, high, 1 + round(high - low)).tolist()
        if (window := compound.frequencies(t)) is not None and window[0] <= slow and window[1] >= fast
    ]
    name, required = "window covers usual carry rolls", f"{slow:,.0f} to {fast:,.0f} Hz"
    if covered:
        yield Criterion(
            name, _span_text(covered[0], covered[-1]), required, "pass", "temperatures of the belt at which it does"
        )
        return
    first, last = fitted.fit.window
    calculated = f"{first:.2g} to {last:.2g} Hz at {to_celsius(reference):.4g} °C"
    why = f"it has {np.log10(last / first):.1f} decades: measure more temperatures, or more frequencies"
    yield Criterion(name, calculated, required, "FAIL", why)


def _span_text(low: float, high: float) -> str:
    """Temperatures [K] from low to high, for messages."""
    return " to ".join(dict.fromkeys(f"{to_celsius(t):.0f} °C" for t in (low, high)))


def _noise_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    for label, value, most in zip(("E'", "E''"), fitted.noise, NOISE_LIMITS, strict=True):
        name, why = f"scatter of {label} from row to row", "instrument, clamping, range of its force"
        yield (
            _not_checked(name, "too few rows to tell scatter from curvature")
            if value is None
            else _at_most(name, value, most, _percent_text, why)
        )
    if fitted.disagreement is None:
        return
    for label, value, most in zip(("E'", "E''"), fitted.disagreement, NOISE_LIMITS, strict=True):
        why = "rows of one isotherm agree: another specimen, clamping, strain or temperature, or a vertical shift"
        yield _at_most(f"disagreement of {label} between isotherms", value, most, _percent_text, why)


def _strain_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    name, known = "strain of the isotherms", fitted.amplitudes
    if not known:
        yield _not_checked(
            name, "no file states it: measure all at one amplitude and write it into a column 'strain [%]'"
        )
        return
    low, high = min(known, key=lambda one: one.low), max(known, key=lambda one: one.high)
    why = f"{strain_text(low.low)} to {strain_text(high.high)}: filled rubber softens with strain, measure all at one"
    yield _at_most(name, amplitude_ratio(known), UNLIKE_STRAINS, lambda v: f"a factor of {v:.3g}", why)


def _sweep_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    """Scatter of the strain sweeps, and their E' beside that of the master curve."""
    factors = fitted.compound.amplitude_factors()
    if factors is None:
        return
    for k, (label, most) in enumerate(zip(("E'", "E''"), NOISE_LIMITS, strict=True)):
        name = f"scatter of {label} in strain sweeps"
        known = [(sweep.scatter[k], sweep.temperature) for sweep in factors.sweeps if sweep.scatter is not None]
        if not known:
            yield _not_checked(name, f"no sweep of {FEWEST_SCATTER_POINTS} strains: it is in no band")
            continue
        scatter, at = max(known)
        why = f"at {round(to_celsius(at))} °C; it is in the band of the rubber"
        yield _at_most(name, scatter, most, _percent_text, why)
    name = "strain sweeps beside the master curve"
    if not fitted.levels:
        yield _not_checked(name, "no sweep within the window and the shift factors")
        return
    worst = max(fitted.levels, key=lambda one: one.factor)
    where = f"at {to_celsius(worst.temperature):.0f} °C; another rubber, temperature, strain, or E and G"
    yield _at_most(name, worst.factor, LEVEL_LIMIT, lambda v: f"a factor of {v:.3g}", where)


def _shift_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    shifted = fitted.superposition
    if shifted is not None:
        worst = float(np.max(shifted.log10_a_T_error))
        yield _at_most(
            "uncertainty of the shifts",
            worst,
            SHIFT_LIMIT,
            _decades_text,
            "too little overlap or too much scatter"
            if not shifted.contradicting
            else "E' and E'' ask for different shifts, or vertical ones: the error holds their spread",
        )
        yield from _phase_criteria(shifted)
        least = min(one.decades for one in shifted.overlaps)
        yield Criterion(
            "least overlap of neighbours", _decades_text(least), f"at least {_decades_text(OVERLAP_LIMIT)}",
            "pass" if round(least, 2) >= OVERLAP_LIMIT else "FAIL",
            "measure a temperature between, or more frequencies",
        )  # fmt: skip
    if not fitted.laws:
        yield _not_checked("smoothness of the shifts", "fewer than five temperatures")
        return
    law = compound_law(fitted)
    missed = law.left_out if law.name == "table" else law.rms
    farthest = f"; worst {law.worst:+.2f} at {to_celsius(law.worst_temperature):.0f} °C"
    what = "a shift left out, predicted by its neighbours" if law.name == "table" else f"shifts about the law{farthest}"
    yield _at_most(
        f"smoothness of the shifts ({law.name})", missed, LEFT_OUT_LIMIT, _decades_text,
        what,
    )  # fmt: skip


def _phase_criteria(shifted: Superposition) -> Iterator[Criterion]:
    """E'' over measured frequency, at one reduced frequency."""
    name, slope = "E'' over measured frequency", shifted.phase_slope
    if slope is None:
        yield _not_checked(name, "fewer than three isotherms, or they do not tell")
        return
    known = max(abs(slope.slope) - 2.0 * slope.error, 0.0)
    yield Criterion(
        name, f"{slope_text(slope)} per decade",
        f"at most {percent(PHASE_SLOPE_LIMIT)}", "pass" if known <= PHASE_SLOPE_LIMIT else "FAIL",
        "a rubber has none: a phase error of the instrument",
    )  # fmt: skip


def compound_law(fitted: FittedCompound) -> ShiftComparison:
    """Comparison of the shift law of the compound."""
    shift = fitted.compound.shift
    name = "table" if shift is None else shift.law
    return next(law for law in fitted.laws if law.name.lower() == name)


def _shape_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    if fitted.superposition is not None:
        yield _at_most(
            "correlation of neighbouring residuals", fitted.superposition.correlation, SHAPE_LIMIT,
            lambda v: f"{v:.2f}",
            "isotherms that differ in shape superpose at no shift",
        )  # fmt: skip


def collapse_spread(
    rows: MeasuredRows, noise: tuple[float, float], series: PronySeries
) -> tuple[float, float, float] | None:
    """Largest difference of phase angle between neighbouring isotherms at one modulus, |E*|/b_T.

    Parameters
    ----------
    rows : MeasuredRows
        Temperatures of fewer than three rows do not count.
    noise : tuple of float
        Scatter of E' and E'' from row to row [-].
    series : PronySeries
        Bends the lines between the rows of an isotherm.

    Returns
    -------
    tuple or None
        Root mean square of the differences over their scatter [-], and both temperatures [K]; None where no two
        isotherms have moduli of `FEWEST_COMMON` rows in common.

    Notes
    -----
    The distance of each row to the other isotherm's line, in units of scatter along both axes: where the line is steep,
    on a plateau, the modulus decides. Rows beyond the ends of the line do not count.
    d(delta) = sin(2 delta)/2 d(ln tan delta).
    """
    reduced, storage, loss = rows.curve
    measured = _frequency_free(storage, loss)
    omega = 2.0 * np.pi * reduced
    apart = measured - _frequency_free(series.storage(omega), series.loss(omega))
    angles = measured[1]
    turned = np.hypot(np.radians(ANGLE_REPEATABILITY), 0.5 * np.sin(2.0 * angles) * np.hypot(*noise))
    temperatures = [t for t in np.unique(rows.temperature) if np.count_nonzero(rows.temperature == t) > 2]
    spreads = []
    for cold, hot in pairwise(temperatures):
        line = np.flatnonzero(rows.temperature == hot)  # rows are in the order of the frequency
        points = _isotherm_line(np.log(reduced[line]), apart[:, line], series)
        if points.shape[1] < 2:
            continue
        distances = []
        for k in np.flatnonzero(rows.temperature == cold):
            scale = np.array([max(noise[0], MODULUS_REPEATABILITY), turned[k]])
            at = (points.T - measured[:, k]) / scale
            step = np.diff(at, axis=0)
            share = -np.sum(at[:-1] * step, axis=1) / np.sum(step**2, axis=1)
            distance = np.linalg.norm(at[:-1] + np.clip(share, 0.0, 1.0)[:, None] * step, axis=1)
            nearest = int(np.argmin(distance))
            first, last = nearest == 0 and share[0] < 0.0, nearest == share.size - 1 and share[-1] > 1.0
            if not first and not last:
                distances.append(float(distance[nearest]))
        if len(distances) >= FEWEST_COMMON:
            spreads.append((float(np.sqrt(np.mean(np.square(distances)) / 2.0)), float(cold), float(hot)))
    return max(spreads, default=None)


def _frequency_free(storage: FloatArray, loss: FloatArray) -> FloatArray:
    """Logarithm of |E*| and phase angle [rad], shape `(2, n)`."""
    return np.array([np.log(np.hypot(storage, loss)), np.arctan2(loss, storage)])


def _isotherm_line(x: FloatArray, apart: FloatArray, series: PronySeries) -> FloatArray:
    """Line through the rows of an isotherm, ln frequency x, bent as the series from which they are apart."""
    between = np.linspace(x[:-1], x[1:], LINE_POINTS, endpoint=False).T.ravel()
    x_line = np.append(between, x[-1])
    omega = 2.0 * np.pi * np.exp(x_line)
    points = _frequency_free(series.storage(omega), series.loss(omega))
    points += np.array([np.interp(x_line, x, one) for one in apart])
    moved = np.any(np.diff(points, axis=1) != 0.0, axis=0)
    return np.asarray(points[:, np.concatenate([[True], moved])])


def _collapse_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    name, (storage, loss) = "van Gurp-Palmen collapse", fitted.noise
    if storage is None or loss is None:
        yield _not_checked(name, "scatter from row to row is not known")
        return
    worst = collapse_spread(fitted.rows, (storage, loss), fitted.fit.series)
    if worst is None:
        yield _not_checked(name, "no two isotherms with moduli in common, of three rows at least")
        return
    pair = " and ".join(f"{to_celsius(t):.0f}" for t in worst[1:])
    why = f"worst of {pair} °C; another state, specimen or strain, or a vertical shift"
    yield _at_most(name, worst[0], SCATTER_LIMIT, lambda v: f"{v:.1f} times scatter", why)


def _consistency_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    why = "more is in the data: two strains, two set-ups, an outlier"
    if fitted.entropic_floor is not None:
        why = f"with b_T = T/T_ref {percent(fitted.entropic_floor, 1)}: a vertical shift is missing, --vertical"
    yield _at_most(
        "best positive spectrum of E' and E''",
        fitted.fit.consistency_floor,
        DOUBTFUL_RESIDUAL,
        _percent_text,
        why,
    )
    known = fitted.consistency
    if known is None:
        yield _not_checked("Kramers-Kronig", "too few rows beyond a decade from the ends of the window")
        return
    for label, misfit in (("E'' from E'", known.loss), ("E' from E''", known.storage)):
        where = f"worst {percent(misfit.worst, signed=True)} at {misfit.worst_frequency:.2g} Hz"
        yield _at_most(f"Kramers-Kronig, {label}", misfit.rms, KRAMERS_KRONIG_LIMIT, _percent_text, where)


def _residual_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    fit = fitted.fit
    storage, loss = (min(value or 0.0, most) for value, most in zip(fitted.noise, NOISE_LIMITS, strict=True))
    scatter = float(np.hypot(storage, loss)) / np.sqrt(2.0)
    most = max(fit.consistency_floor + RESIDUAL_MARGIN, SCATTER_MARGIN * scatter)
    yield _at_most(
        "left by the series", fit.residual, most, _percent_text,
        "of E' and E'', against the best positive spectrum and the scatter",
    )  # fmt: skip


def _end_criteria(fitted: FittedCompound) -> Iterator[Criterion]:
    fit = fitted.fit
    decades, trust = np.log10(fit.rows.frequency), fit.rows.trust.reshape(2, -1)
    slow, fast = decades <= decades[0] + END_DECADES, decades >= decades[-1] - END_DECADES
    ends = [(f"{label}, {side} end", k, here) for side, here in (("slow", slow), ("fast", fast))
            for k, label in enumerate(("E'", "E''")) if trust[k, here].any()]  # fmt: skip
    means = [
        [float(np.average(errors[k, here], weights=trust[k, here])) for _, k, here in ends]
        for errors in (fit.relative_errors, fit.best_errors)
    ]
    worst = int(np.argmax(np.abs(means[0])))
    why = f"{ends[worst][0]}; the best positive spectrum has {percent(means[1][worst], 1, signed=True)} there"
    if abs(means[1][worst]) > END_LIMIT:
        why += ": the data contradict themselves"
    yield _at_most("ends of the window", abs(means[0][worst]), END_LIMIT, _percent_text, why)


def coverage_criteria(fitted: FittedCompound, conveyor: Conveyor) -> Iterator[Criterion]:
    """Coverage of the frequencies of a conveyor's carry rolls by the window of a fit."""
    from conveyor.checks.contact_checks import rubber_coverage
    from conveyor.models.variants import with_compound
    from conveyor.pipeline import calculate

    where = f"window covers {conveyor.name}"
    try:
        result = calculate(with_compound(conveyor, fitted.compound, "bottom"))
    except ConveyorError as error:
        yield Criterion(where, "no answer", f"data at {text(conveyor.ambient.belt)}", "FAIL", str(error))
        return
    for check in rubber_coverage(result):
        if "carry" in check.subject.text():
            yield Criterion(
                f"{where}, carry rolls", check.found.text(), check.asked.text(),
                "pass" if check.verdict == "pass" else "FAIL", "frequencies that hold nine tenths of their loss",
            )  # fmt: skip
