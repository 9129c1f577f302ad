"""Summary of a fit: lines for the terminal, and a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from conveyor.errors import InputError
from conveyor.fitting.fitted_compound import FittedCompound, TabulatedCompound
from conveyor.fitting.shift_choice import law_constants, slope_text
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import add_legend, curve_colour, master_curve, stacked_axes
from conveyor.rubber.term_count import AICC_SUPPORT
from conveyor.rubber.time_temperature import OUTLIER_TRUST
from conveyor.units import text
from conveyor.units.sentences import percent, to_celsius

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from matplotlib.figure import Figure

    from conveyor.arguments.arrays import FloatArray
    from conveyor.rubber import PronyFit, PronySeries, Superposition

_MOST_CANDIDATES = 6  # of the criterion's table that are printed
_MOST_OUTLIERS = 6  # outliers that are named
_POINTS = 400
_SHAPE_CORRELATION = 0.5  # of neighbouring residuals beyond which isotherms differ in shape


def summary_lines(rubber: FittedCompound | TabulatedCompound) -> list[str]:
    """Lines on reading, shift, fit, errors and doubts."""
    if isinstance(rubber, TabulatedCompound):
        series = rubber.compound.series_at_reference
        return [
            "read",
            *(f"  {line}" for line in rubber.understood),
            f"{rubber.compound.name}: {series.times.size} terms as tabulated, nothing fitted; E_e "
            f"{series.equilibrium / 1e6:.4g} MPa, E_inf {series.glassy / 1e6:.4g} MPa",
            "missing data: " + "; ".join(rubber.compound.missing),
        ]
    return [
        "read",
        *(f"  {line}" for line in rubber.understood),
        *_shift_lines(rubber),
        *_law_lines(rubber),
        *_series_lines(rubber),
        *_criterion_lines(rubber),
        *_consistency_lines(rubber),
        *_failure_lines(rubber),
        "missing data: " + ("; ".join(rubber.compound.missing) or "nothing listed"),
    ]


def _failure_lines(fitted: FittedCompound) -> Iterator[str]:
    """Criteria that are not met; every report that uses the compound names them too."""
    statistics = fitted.compound.fit
    if statistics is not None and statistics.failed:
        yield "the fit fails; reports that use the compound say so"
        yield from (f"  {line}" for line in statistics.failed)


def _shift_lines(fitted: FittedCompound) -> Iterator[str]:
    shifted = fitted.superposition
    if shifted is None:
        return
    yield f"shift of {shifted.temperatures.size} isotherms to {to_celsius(shifted.reference):.4g} degC"
    for t, shift, error in zip(shifted.temperatures, shifted.log10_a_T, shifted.log10_a_T_error, strict=True):
        yield f"  {to_celsius(float(t)):8.2f} degC  log10 a_T {shift:+9.4f} +- {error:.4f}"
    overlaps = ((shifted.storage_residual, "E'"), (shifted.loss_residual, "E''"))
    scatter = ((shifted.storage_scatter, "E'"), (shifted.loss_scatter, "E''"))
    told = " and ".join(f"{percent(value, 1)} ({name})" for value, name in scatter if value is not None)
    apart = " and ".join(f"{percent(value, 1)} ({name})" for value, name in overlaps)
    yield (
        f"  isotherms differ in their overlaps by {apart}; scatter about the common curve {told}"
        + ("" if None not in (shifted.storage_scatter, shifted.loss_scatter) else "; it alone placed them")
    )
    for one in shifted.resonances:
        yield (
            f"  {one.frequency:.4g} Hz is left out of all isotherms: {one.isotherms} of them stand off the common curve"
            f" there, E' by {percent(one.storage, signed=True)}, E'' by {percent(one.loss, signed=True)}: a "
            "resonance of the instrument?"
        )
    yield from _variant_lines(shifted)
    other = shifted.with_vertical
    if other is not None:
        beside = [
            f"{percent(now, 1)} of {name} to {percent(then, 1)}"
            for now, then, name in (
                (shifted.storage_scatter, other.storage_scatter, "E'"),
                (shifted.loss_scatter, other.loss_scatter, "E''"),
            )
            if now is not None and then is not None
        ]
        vertical = 10.0 ** float(np.max(np.abs(other.log10_b_T))) - 1.0
        yield (
            f"  a vertical shift of up to {percent(vertical)} would bring them closer, the scatter from "
            f"{' and '.join(beside)}: try --vertical"
        )
    if other is None and shifted.correlation > _SHAPE_CORRELATION:
        yield (
            f"  neighbouring residuals are correlated by {shifted.correlation:.2f}: the isotherms differ in shape, "
            "no shift makes them one curve"
        )


def _variant_lines(shifted: Superposition) -> Iterator[str]:
    """Lines on the shifts that the same isotherms have by other moduli and vertical shifts."""
    if shifted.variants:
        yield "  alternative shifts for comparison: log10 a_T of the coldest and the hottest isotherm"
    for one in shifted.variants:
        ends = " and ".join(
            f"{one.log10_a_T[k]:+.3f} +- {one.log10_a_T_error[k]:.3f}" for k in (0, one.log10_a_T.size - 1)
        )
        yield f"    {one.name}: {ends}" + (", differs beyond chance" if one.differs else "")
    if shifted.contradicting:
        yield (
            "  E' and E'' ask for different shifts: the errors above hold the largest difference, the band every one; "
            "look for the cause before the compound is used"
        )
    phase, cold = shifted.phase_slope, shifted.cold_slope
    if phase is not None and phase.found:
        lag = any("lag" in one.trends for one in shifted.variants)
        yield (
            f"  E'' changes by {slope_text(phase)} per decade of measured frequency at one reduced frequency"
            + (", in proportion to it: a time lag" if lag else ": a phase error")
            + " of the instrument; the band holds E'' as it would be without"
        )
    if cold is not None and cold.found:
        yield (
            f"  E' and E'' change by {slope_text(cold)} per 10 K of cold at one reduced frequency: a vertical shift of "
            f"the rubber{'' if shifted.with_vertical else ' (--vertical)'}, or clamps and frame that change with cold; "
            "the band holds both"
        )


def _law_lines(fitted: FittedCompound) -> Iterator[str]:
    if fitted.laws:
        yield "shift laws"
    for law in fitted.laws:
        constants = law_constants(law, fitted.compound.reference)
        yield (
            f"  {law.name}: {constants}{'; ' * bool(constants)}rms {law.rms:.2f}, worst {law.worst:+.2f} decades at "
            f"{to_celsius(law.worst_temperature):.0f} "
            f"degC; leave-one-out error {law.left_out:.2f} decades"
        )


def _series_lines(fitted: FittedCompound) -> Iterator[str]:
    fit, compound = fitted.fit, fitted.compound
    yield (
        f"{compound.name}: {fit.active_terms} terms, E_e {fit.series.equilibrium / 1e6:.4g} MPa, "
        f"E_inf {fit.series.glassy / 1e6:.4g} MPa"
    )
    yield (f"  data window {fit.window[0]:.4g} to {fit.window[1]:.4g} Hz at {text(compound.reference_temperature)}")
    for label, misfit in (("E'", fit.storage), ("E''", fit.loss), ("tan delta", fit.tan_delta)):
        yield (
            f"  {label:>9}: rms {percent(misfit.rms, 1)}, worst {percent(misfit.worst, 1, signed=True)} at "
            f"{misfit.worst_frequency:.3g} Hz"
        )
    yield from _outlier_lines(fit)
    storage, loss = fitted.noise
    if storage is not None and loss is not None:
        yield f"  scatter from row to row: {percent(storage, 1)} (E'), {percent(loss, 1)} (E'')"
    if fitted.disagreement is not None:
        apart = [percent(value, 1) for value in fitted.disagreement]
        yield f"  disagreement between isotherms beyond it: {apart[0]} (E'), {apart[1]} (E'')"


def _outlier_lines(fit: PronyFit) -> Iterator[str]:
    """Lines on rows with little weight in the fit."""
    f = fit.rows.frequency
    for name, kept, error in zip(("E'", "E''"), np.split(fit.rows.trust, 2), fit.relative_errors, strict=True):
        stray = np.flatnonzero(kept < OUTLIER_TRUST)
        if stray.size:
            rows = ", ".join(
                f"{f[k]:.3g} Hz ({percent(1.0 / (1.0 + error[k]) - 1.0, signed=True)})" for k in stray[:_MOST_OUTLIERS]
            )
            more = f" and {stray.size - _MOST_OUTLIERS} more" if stray.size > _MOST_OUTLIERS else ""
            beyond = "more than four times what the fit misses of others"
            yield f"  {name} of {stray.size} rows stands off by {beyond}: {rows}{more}:"
            yield "    a resonance, a bad contact? They hardly pull the fit, and count in its errors above"


def _criterion_lines(fitted: FittedCompound) -> Iterator[str]:
    candidates = fitted.fit.candidates
    if len(candidates) < 2:
        return
    yield (
        f"  number of terms, chosen first: the fewest of all solids within {AICC_SUPPORT:g} of the lowest AICc, "
        "which is a tie; per decade, penalty, terms, effective parameters, residual, score"
    )
    for candidate in candidates[:_MOST_CANDIDATES]:
        yield (
            f"    {candidate.terms_per_decade:5.2f} {candidate.regularisation:7.3g} {candidate.terms:4d} "
            f"{candidate.freedom:7.1f} {candidate.residual:8.2%} {candidate.score:10.1f}"
        )


def _consistency_lines(fitted: FittedCompound) -> Iterator[str]:
    yield (
        f"no Prony series fits E' and E'' better than {percent(fitted.fit.consistency_floor, 1)} rms: the data scatter "
        "or contradict themselves by that much"
    )
    if fitted.entropic_floor is not None:
        yield (
            "  with the vertical shift of an entropic network, b_T = T/T_ref, it would leave "
            f"{percent(fitted.entropic_floor, 1)}: try --vertical"
        )
    known = fitted.consistency
    if known is None:
        yield "  Kramers-Kronig: not tested, the window has too few rows beyond a decade from its ends"
        return
    for label, one, misfit in (("E''", "E'", known.loss), ("E'", "E''", known.storage)):
        yield (
            f"  Kramers-Kronig, {label} predicted from {one} over {known.judged[0]:.3g} to {known.judged[1]:.3g} Hz: "
            f"rms {percent(misfit.rms, 1)}, worst {percent(misfit.worst, 1, signed=True)} at "
            f"{misfit.worst_frequency:.3g} Hz"
        )


def shift_table(rubber: FittedCompound | TabulatedCompound) -> str:
    """Shift factors of a fit as text of a file for `--shift`, to edit by hand."""
    shifted = None if isinstance(rubber, TabulatedCompound) else rubber.superposition
    if shifted is None:
        raise InputError("--write-shift: shift factors are found from isotherms at two temperatures and more")
    columns = zip(shifted.temperatures, shifted.log10_a_T, shifted.log10_b_T, strict=True)
    rows = [f"{to_celsius(float(t)):.6g},{a:.6f},{b:.6f}" for t, a, b in columns]
    return "\n".join(["temperature_degC,log10_aT,log10_bT", *rows, ""])


@own_settings()
def band_figure(rubber: FittedCompound | TabulatedCompound) -> Figure:
    """Data, fit and band: E', E'' above, tan δ below."""
    if isinstance(rubber, TabulatedCompound):
        return master_curve(rubber.compound)
    made, (above, below) = stacked_axes(2, 7.0)
    f, storage, loss = rubber.rows.curve
    low, high = rubber.fit.window
    omega = 2.0 * np.pi * np.geomspace(low, high, _POINTS)
    at = omega / (2.0 * np.pi)
    series = rubber.fit.series
    replicas = rubber.compound.replicas(rubber.compound.reference)
    models: tuple[Callable[[PronySeries], FloatArray], ...] = (
        lambda s: s.storage(omega) / 1e6,
        lambda s: s.loss(omega) / 1e6,
        lambda s: s.tan_delta(omega),
    )
    measured = (storage / 1e6, loss / 1e6, loss / storage)
    for k, (axis, label) in enumerate(((above, "E'"), (above, "E''"), (below, "tan δ"))):
        data, model = measured[k], models[k]
        axis.plot(f, data, color=curve_colour(k), marker="o", markersize=3, linestyle="none", alpha=0.6)
        axis.plot(at, model(series), color=curve_colour(k), label=label)
        if replicas:
            bottom, top = np.quantile([model(replica) for replica in replicas], (0.05, 0.95), axis=0, method="weibull")
            axis.fill_between(at, bottom, top, color=curve_colour(k), alpha=0.2, linewidth=0)
    reference = text(rubber.compound.reference_temperature)
    above.set(
        xscale="log",
        yscale="log",
        ylabel="modulus [MPa]",
        title=f"{rubber.compound.name}: data, fit, 90 % band",
    )
    below.set(xscale="log", xlabel=f"frequency at {reference} [Hz]", ylabel="tan δ [-]")
    below.set_ylim(bottom=0.0)
    add_legend(above)
    return made
