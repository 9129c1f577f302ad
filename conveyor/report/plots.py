"""Figures, one function each: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from conveyor.errors import InputError, NoSolutionError
from conveyor.report.comparing import celsius
from conveyor.units import si, text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from conveyor.comparison import Comparison
    from conveyor.models import RubberCompound

_COLOURS = ("#1F4E79", "#C55A11", "#2E8B57", "#8064A2", "#B8860B", "#7F7F7F", "#A61C3C", "#008B8B")
_SIZE = (8.0, 4.8)
_POINTS = 400
_DECADES_BEYOND = 1.0  # of the data's window, drawn dashed
_WIDEST = (1e-6, 1e12)  # frequencies drawn where a compound states no window [Hz]


def stacked(rows: int = 1, height: float = _SIZE[1]) -> tuple[Figure, list[Axes]]:
    """A figure without pyplot: nothing global, safe in threads and servers."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_SIZE[0], height), layout="constrained")
    axes = [figure.add_subplot(rows, 1, k + 1) for k in range(rows)]
    for axis in axes:
        axis.grid(visible=True, color="0.9")
        axis.spines[["top", "right"]].set_visible(False)
    return figure, axes


def colour(k: int) -> str:
    """Colour of the k-th curve."""
    return _COLOURS[k % len(_COLOURS)]


def save(figure: Figure, path: str | Path) -> Path:
    """Write a figure; the ending of the name chooses the format (.png, .svg, .pdf).

    Raises
    ------
    InputError
        An unknown ending, or a path that cannot be written.
    """
    where = Path(path)
    known = figure.canvas.get_supported_filetypes()
    if where.suffix.lower().removeprefix(".") not in known:
        raise InputError(f'{where}: a figure\'s name ends in .png, .svg or .pdf, got "{where.suffix}"')
    partial = where.with_name(f".{where.stem}.part{where.suffix}")
    try:
        figure.savefig(partial, dpi=150)
        partial.replace(where)
    except OSError as error:
        raise InputError(f"{where}: cannot be written ({error.strerror or error})") from None
    return where


def power_against_temperature(comparison: Comparison, speed: float | None = None) -> Figure:
    """Motor power of every compound over temperature at one speed [m/s], the slowest without; bands shaded."""
    figure, (axis,) = stacked()
    chosen = min(scene.speed for scene in comparison.scenes) if speed is None else speed
    for k, compound in enumerate(comparison.compounds):
        found = sorted(
            (s for s in comparison.scenes if s.compound == compound.name and s.speed == chosen),
            key=lambda scene: scene.temperature,
        )
        at = [celsius(scene.temperature) for scene in found]
        axis.plot(at, [s.motor / 1e3 for s in found], color=colour(k), marker=".", label=compound.name)
        low = [s.motor_low / 1e3 for s in found if s.motor_low is not None]
        high = [s.motor_high / 1e3 for s in found if s.motor_high is not None]
        if found and len(low) == len(found):
            axis.fill_between(at, low, high, color=colour(k), alpha=0.15, linewidth=0)
    axis.set(
        xlabel="belt temperature [°C]",
        ylabel="motor power [kW]",
        title=f"{comparison.conveyor.name}, {chosen:g} m/s",
    )
    axis.legend(fontsize=8)
    return figure


def power_against_speed(comparison: Comparison, temperature: float | None = None) -> Figure:
    """Motor power of every compound over belt speed at one temperature [K], the coldest answered by all without."""
    figure, (axis,) = stacked()
    answered = [
        {s.temperature for s in comparison.scenes if s.compound == c.name} for c in comparison.compounds
    ]
    chosen = min(set.intersection(*answered)) if temperature is None else temperature
    for k, compound in enumerate(comparison.compounds):
        found = sorted(
            (s for s in comparison.scenes if s.compound == compound.name and s.temperature == chosen),
            key=lambda scene: scene.speed,
        )
        speeds = [s.speed for s in found]
        axis.plot(speeds, [s.motor / 1e3 for s in found], color=colour(k), marker=".", label=compound.name)
    axis.set(
        xlabel="belt speed [m/s]",
        ylabel="motor power [kW]",
        title=f"{comparison.conveyor.name}, {celsius(chosen):g} °C",
    )
    axis.legend(fontsize=8)
    return figure


def loss_tangents(
    compounds: Sequence[RubberCompound],
    temperature: float,
    excited: Mapping[str, tuple[float, float]] | None = None,
) -> Figure:
    """Master curves of tan δ at one temperature [K], solid where the data hold them, and the band a conveyor excites.

    Parameters
    ----------
    compounds : sequence of RubberCompound
        At least one.
    temperature : float
        To which the curves are shifted [K].
    excited : mapping of str to tuple, optional
        Bands of frequency by what excites them [Hz].
    """
    figure, (axis,) = stacked()
    for k, compound in enumerate(compounds):
        series = compound.series(temperature)
        data = compound.frequencies(temperature)
        low, high = _WIDEST if data is None else data
        wide = np.geomspace(low / 10.0**_DECADES_BEYOND, high * 10.0**_DECADES_BEYOND, _POINTS)
        inside = np.geomspace(low, high, _POINTS)
        axis.plot(wide, series.tan_delta(2.0 * np.pi * wide), color=colour(k), linestyle=":", linewidth=1)
        axis.plot(inside, series.tan_delta(2.0 * np.pi * inside), color=colour(k), label=compound.name)
    for k, (name, (low, high)) in enumerate((excited or {}).items()):
        axis.axvspan(low, high, color="0.55", alpha=0.18 if k == 0 else 0.10, linewidth=0, label=name)
    axis.set(
        xscale="log",
        xlabel=f"frequency at {celsius(temperature):g} °C [Hz]",
        ylabel="tan δ [-]",
        title="Loss tangent (dotted: beyond the data)",
    )
    axis.set_ylim(bottom=0.0)
    axis.legend(fontsize=8)
    return figure


def compared_loss_tangents(comparison: Comparison, temperature: float | None = None) -> Figure:
    """Loss tangents of all compounds at one temperature [K], and the band that the conveyor's rolls excite there.

    Without a temperature the one nearest the spec's that every compound has an answer for.

    Raises
    ------
    NoSolutionError
        No temperature that every compound has an answer for.
    """
    at = [
        {row.temperature for row in comparison.coverage if row.compound == c.name}
        for c in comparison.compounds
    ]
    common = set.intersection(*at)
    if not common:
        raise NoSolutionError("no temperature that every compound has an answer for")
    own = si(comparison.conveyor.ambient.belt) if temperature is None else temperature
    chosen = min(common, key=lambda t: abs(t - own))
    rows = [row.excited for row in comparison.coverage if row.temperature == chosen]
    band = min(low for low, _ in rows), max(high for _, high in rows)
    return loss_tangents(comparison.compounds, chosen, {"nine tenths of the rolls' loss": band})


def master_curve(compound: RubberCompound, temperature: float | None = None) -> Figure:
    """E', E'' and tan δ of one compound at a temperature [K], its reference temperature without."""
    figure, (above, below) = stacked(2, 7.0)
    at = si(compound.reference_temperature) if temperature is None else temperature
    series, data = compound.series(at), compound.frequencies(at)
    low, high = _WIDEST if data is None else data
    f = np.geomspace(low, high, _POINTS)
    omega = 2.0 * np.pi * f
    above.plot(f, series.storage(omega) / 1e6, color=colour(0), label="E'")
    above.plot(f, series.loss(omega) / 1e6, color=colour(1), label="E''")
    below.plot(f, series.tan_delta(omega), color=colour(2), label="tan δ")
    replicas = compound.replicas(at)
    if replicas:
        for axis, figures, k in (
            (above, [r.storage(omega) / 1e6 for r in replicas], 0),
            (above, [r.loss(omega) / 1e6 for r in replicas], 1),
            (below, [r.tan_delta(omega) for r in replicas], 2),
        ):
            bottom, top = np.quantile(np.array(figures), (0.05, 0.95), axis=0)
            axis.fill_between(f, bottom, top, color=colour(k), alpha=0.2, linewidth=0)
    above.set(xscale="log", yscale="log", ylabel="modulus [MPa]", title=f"{compound.name} ({compound.kind})")
    where = text(compound.reference_temperature) if temperature is None else f"{celsius(at):g} °C"
    below.set(xscale="log", xlabel=f"frequency at {where} [Hz]", ylabel="tan δ [-]")
    below.set_ylim(bottom=0.0)
    above.legend(fontsize=8)
    return figure
