"""Figures to judge a master curve by."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from conveyor.fitting.fitted_compound import FittedCompound
from conveyor.fitting.measured_rows import MeasuredRows
from conveyor.fitting.summary import band_figure as band
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import curve_colour, stacked_axes
from conveyor.rubber import AmplitudeFactors, ShiftTable
from conveyor.units.sentences import ZERO_CELSIUS, to_celsius

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_HEIGHT: Final = 6.6  # of two plots on each other [in]
_POINTS: Final = 200
_LABEL_SPACING: Final = 0.13  # of a plot's height, between labels next to it
_MARK_WIDTH: Final = 9.0  # of a mark before its label [pt]
_LEGEND_ENTRIES: Final = 6  # isotherms in a legend; of more every few are named


def fit_figures(fitted: FittedCompound) -> Iterator[tuple[str, str, Figure]]:
    """Name, caption and figure of all that the data allow."""
    sweeps = np.unique(fitted.rows.temperature).size > 1
    if sweeps:
        yield (
            "isotherms",
            "Isotherms before and after shifting; E' filled, E'' open.",
            isotherm_figure(fitted),
        )
    if fitted.laws:
        yield (
            "shifts",
            "Shift factors with their standard errors, and the laws; below: law less shift.",
            shift_figure(fitted),
        )
    caption = "Free of frequency: van Gurp-Palmen above, Cole-Cole below. Rows of one material lie on one curve."
    yield "collapse", caption, frequency_free_figure(fitted)
    factors = fitted.compound.amplitude_factors()
    if factors is not None:
        caption = "Strain sweeps: E' above, E'' below, over those at the strain of the master curve (dotted)."
        yield "strain", caption, strain_figure(factors)
    caption = "Series less data, over data, row by row; shaded: scatter of the rows themselves."
    yield "residuals", caption, residual_figure(fitted)
    yield "band", "Master curve, series and its 90 % band.", band(fitted)


def _temperature_colours(values: np.ndarray) -> list[Any]:
    """Colour of each temperature, blue to red, none too pale to print."""
    from matplotlib import colormaps

    return [colormaps["turbo"](0.08 + 0.84 * k / max(1, values.size - 1)) for k in range(values.size)]


def _draw_by_temperature(rows: MeasuredRows, draw: Callable[[np.ndarray, Any, str | None], None]) -> None:
    """Draw rows in the colour of their temperature; rows of temperature sweeps grey."""
    temperatures, counts = np.unique(rows.temperature, return_counts=True)
    swept = temperatures[counts > 2]
    every = max(1, round(swept.size / _LEGEND_ENTRIES))
    for k, (t, shade) in enumerate(zip(swept.tolist(), _temperature_colours(swept), strict=True)):
        named = k % every == 0 or k == swept.size - 1
        draw(rows.temperature == t, shade, f"{to_celsius(t):.0f} °C" if named else None)
    single = ~np.isin(rows.temperature, swept)
    if single.any():
        draw(single, "0.45", "temperature sweep")


def _plot_marks(
    axis: Axes, x: np.ndarray, y: np.ndarray, shade: Any, label: str | None, *, filled: bool = True
) -> None:
    axis.plot(
        x, y, "o", color=shade, markersize=3.2, markerfacecolor=shade if filled else "none", markeredgewidth=0.8,
        label=label,
    )  # fmt: skip


def _label_marks(axis: Axes) -> None:
    """Write the labels of marks right of the data."""
    for k, (mark, label) in enumerate(zip(*axis.get_legend_handles_labels(), strict=True)):
        for words, shade, x in (("●", mark.get_color(), 0.0), (label, "0.1", _MARK_WIDTH)):  # type: ignore[attr-defined]
            axis.annotate(
                words, (1.02, 1.0 - _LABEL_SPACING * k), (x, 0.0), xycoords="axes fraction",
                textcoords="offset points", va="top", fontsize=8, color=shade,
            )  # fmt: skip
        mark.set_label("_")  # named; a page gives other colours to what has a label


def _reduced_axis_label(fitted: FittedCompound) -> str:
    return f"frequency at {to_celsius(fitted.compound.reference):.4g} °C [Hz]"


@own_settings()
def isotherm_figure(fitted: FittedCompound) -> Figure:
    """E' and E'' over frequency, as measured above, shifted below."""
    rows = fitted.rows
    made, (above, below) = stacked_axes(2, _HEIGHT)
    reduced, storage, loss = rows.curve

    def draw(here: np.ndarray, shade: Any, label: str | None) -> None:
        _plot_marks(above, rows.frequency[here], rows.storage[here] / 1e6, shade, label)
        _plot_marks(above, rows.frequency[here], rows.loss[here] / 1e6, shade, None, filled=False)
        _plot_marks(below, reduced[here], storage[here] / 1e6, shade, None)
        _plot_marks(below, reduced[here], loss[here] / 1e6, shade, None, filled=False)

    _draw_by_temperature(rows, draw)
    above.set(xscale="log", yscale="log", xlabel="frequency [Hz]", ylabel="E', E'' [MPa]", title="as measured")
    below.set(xscale="log", yscale="log", xlabel=_reduced_axis_label(fitted), ylabel="E', E'' [MPa]")
    _label_marks(above)
    return made


@own_settings()
def shift_figure(fitted: FittedCompound) -> Figure:
    """log10 a_T over temperature with the laws above, residuals of the laws below."""
    made, (above, below) = stacked_axes(2, _HEIGHT)
    shifted = fitted.superposition
    table = next(law.law for law in fitted.laws if isinstance(law.law, ShiftTable))
    kelvin = shifted.temperatures if shifted is not None else table.temperatures
    decades = shifted.log10_a_T if shifted is not None else table.log10_factors
    nearest = table.reference  # where the laws are 0
    zero = float(decades[np.argmin(np.abs(kelvin - nearest))])
    error = shifted.log10_a_T_error if shifted is not None else np.zeros(kelvin.size)
    at = np.linspace(kelvin[0], kelvin[-1], _POINTS)
    above.errorbar(
        kelvin - ZERO_CELSIUS, decades, error, fmt="o", color="0.1", markersize=3.5, capsize=2, label="shifts"
    )
    known = [(law, law.law) for law in fitted.laws if law.law is not None]
    for k, (law, shift) in enumerate(known):
        drawn = zero + shift.log10_a_T(np.clip(at, law.low, law.high))
        above.plot(at - ZERO_CELSIUS, drawn, color=curve_colour(k), label=f"{law.name}, rms {law.rms:.2f}")
        if law.name != "table":
            missed = zero + shift.log10_a_T(kelvin) - decades
            below.plot(kelvin - ZERO_CELSIUS, missed, "o-", color=curve_colour(k), markersize=3.5, label=law.name)
    below.fill_between(
        kelvin - ZERO_CELSIUS, -error, error, color="0.5", alpha=0.25, linewidth=0, label="standard error"
    )
    above.set(ylabel="log10 a_T [decades]")
    below.set(xlabel="temperature [°C]", ylabel="law less shift [decades]")
    for axis in (above, below):
        axis.legend(fontsize=8)
    return made


@own_settings()
def frequency_free_figure(fitted: FittedCompound) -> Figure:
    """Phase angle over |E*| above, E'' over E' below: without frequency, so without shift."""
    rows = fitted.rows
    made, (above, below) = stacked_axes(2, _HEIGHT)
    _, stored, lost = rows.curve
    angle, modulus = np.degrees(np.arctan2(lost, stored)), np.hypot(stored, lost) / 1e6

    def draw(here: np.ndarray, shade: Any, label: str | None) -> None:
        _plot_marks(above, modulus[here], angle[here], shade, label)
        _plot_marks(below, stored[here] / 1e6, lost[here] / 1e6, shade, None)

    _draw_by_temperature(rows, draw)
    low, high = fitted.fit.window
    series = fitted.fit.series
    omega = 2.0 * np.pi * np.geomspace(low, high, _POINTS)
    storage, loss = series.storage(omega), series.loss(omega)
    above.plot(np.hypot(storage, loss) / 1e6, np.degrees(np.arctan2(loss, storage)), color="0.1", label="series")
    below.plot(storage / 1e6, loss / 1e6, color="0.1")
    above.set(xscale="log", xlabel="|E*|/b_T [MPa]", ylabel="δ [°]")
    above.set_ylim(bottom=0.0)
    below.set(xscale="log", yscale="log", xlabel="E'/b_T [MPa]", ylabel="E''/b_T [MPa]")
    _label_marks(above)
    return made


@own_settings()
def strain_figure(factors: AmplitudeFactors) -> Figure:
    """Factors of E' above and E'' below over strain amplitude: every row, and the curve through the sweeps."""
    made, axes = stacked_axes(2, _HEIGHT)
    colours = _temperature_colours(np.array([sweep.temperature for sweep in factors.sweeps]))
    for axis, name, label in zip(axes, ("storage", "loss"), ("E'", "E''"), strict=True):
        for sweep, colour in zip(factors.sweeps, colours, strict=True):
            curve = AmplitudeFactors([sweep], factors.reference_strain)
            factor, rows = getattr(curve, name), getattr(sweep, name)
            unit = rows[0] / factor(sweep.strain[0], sweep.temperature)
            fine = np.geomspace(sweep.strain[0], sweep.strain[-1], _POINTS)
            axis.plot(100.0 * fine, factor(fine, sweep.temperature), color=colour, linewidth=1.0)
            words = f"{round(to_celsius(sweep.temperature))} °C, {sweep.frequency:.3g} Hz" if axis is axes[0] else None
            _plot_marks(axis, 100.0 * sweep.strain, rows / unit, colour, words)
        axis.axvline(100.0 * factors.reference_strain, color="0.4", linestyle=":", linewidth=0.8)
        axis.set(xscale="log", ylabel=f"factor of {label} [-]")
        axis.set_ylim(bottom=0.0)
    axes[1].set(xlabel="strain amplitude [%]")
    _label_marks(axes[0])
    return made


@own_settings()
def residual_figure(fitted: FittedCompound) -> Figure:
    """Series over data less one: E' above, E'' below."""
    from matplotlib.ticker import MaxNLocator

    made, axes = stacked_axes(2, _HEIGHT)
    f, storage, loss = fitted.rows.curve
    omega, series = 2.0 * np.pi * f, fitted.fit.series
    both = (
        (series.storage(omega), storage, fitted.noise[0]),
        (series.loss(omega), loss, fitted.noise[1]),
    )
    for axis, (model, data, noise), label in zip(axes, both, ("E'", "E''"), strict=True):
        for k, name in enumerate(fitted.files):
            mine = fitted.rows.file == k
            _plot_marks(axis, f[mine], 100.0 * (model / data - 1.0)[mine], curve_colour(k), name)
        if noise is not None:
            axis.axhspan(-100.0 * noise, 100.0 * noise, color="0.5", alpha=0.2, linewidth=0)
        axis.axhline(0.0, color="0.3", linewidth=0.8)
        axis.yaxis.set_major_locator(MaxNLocator(4))
        axis.set(xscale="log", ylabel=f"error of {label} [%]")
    axes[1].set(xlabel=_reduced_axis_label(fitted))
    _label_marks(axes[0])
    return made
