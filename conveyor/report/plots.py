"""Figures, one function each: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

import numpy as np

from conveyor.errors import InputError, NoSolutionError
from conveyor.files import atomic_write, output_marks
from conveyor.report.matplotlib_settings import own_settings, refuse_wrong_date
from conveyor.text.printable import escape_controls
from conveyor.units import System
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from conveyor.models import Conveyor, RubberCompound
    from conveyor.studies.comparison import CalculatedComparison
    from conveyor.studies.comparison_scenes import ComparedScene, Coverage

_NO_GLYPH = "Glyph .* missing from font"  # a letter that our font lacks is no fault
_COLOURS = ("#1F4E79", "#C55A11", "#2E8B57", "#8064A2", "#B8860B", "#7F7F7F", "#A61C3C", "#008B8B")
_SIZE = (8.0, 4.8)
_POINTS = 400
_LEGEND_COLUMNS, _LEGEND_TOP = 3, -0.19  # of the legend; its top, of the height of the axis
_DECADES_BEYOND = 1.0  # of the data's window, drawn dashed
_WIDEST_BAND = (1e-6, 1e12)  # frequencies drawn where a compound states no window [Hz]


_OTHER_AXIS: Final = {"temperature": "speed", "speed": "temperature"}


def stacked_axes(rows: int = 1, height: float = _SIZE[1]) -> tuple[Figure, list[Axes]]:
    """Figure with axes under one another, made without pyplot: safe in threads and servers."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_SIZE[0], height), layout="constrained")
    axes = [figure.add_subplot(rows, 1, k + 1) for k in range(rows)]
    for axis in axes:
        axis.grid(visible=True, color="0.9")
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
    return figure, axes


def curve_colour(k: int) -> str:
    """Colour of the k-th curve."""
    return _COLOURS[k % len(_COLOURS)]


def group_thousands(axis: Axis) -> None:
    """Group the thousands of an axis: 12,000."""
    from matplotlib.ticker import FuncFormatter

    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))


def set_title(figure: Figure, title: str, note: str = "") -> None:
    """Set the title of a figure, with a note below it; a "$" is a dollar, no formula."""
    axis = figure.axes[0]
    axis.set_title(title, parse_math=False, pad=20.0 if note else None)
    if note:
        words = axis.annotate(note, (0.5, 1.02), xycoords="axes fraction", fontsize=9, color="0.3", ha="center")
        words.set_parse_math(False)


def add_legend(axis: Axes) -> None:
    """Add a legend below the axis, where it covers no point; a "$" is a dollar, no formula."""
    handles, labels = axis.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    if once:
        legend = axis.legend(
            once.values(), once.keys(), fontsize=8, frameon=False, ncols=_LEGEND_COLUMNS, loc="upper center",
            bbox_to_anchor=(0.5, _LEGEND_TOP),
        )  # fmt: skip
        for text in legend.get_texts():
            text.set_parse_math(False)


def finish_figure(figure: Figure, x: str, y: str = "", title: str = "", *, group: str = "") -> Figure:
    """Label the axes as `label_axes`, set the title, and return the figure."""
    label_axes(figure.axes[0], x, y, group=group)
    if title:
        set_title(figure, title)
    return figure


def label_axes(axis: Axes, x: str, y: str, *, group: str = "") -> None:
    """Label both axes, group the thousands of those in `group` ("x", "y"), add a legend."""
    axis.set(xlabel=x, ylabel=y)
    for name in group:
        group_thousands(axis.xaxis if name == "x" else axis.yaxis)
    add_legend(axis)


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write a figure as .png, .svg or .pdf.

    Raises
    ------
    InputError
        An unknown ending, or a path that cannot be written; an older file is then untouched.
    """
    where = Path(path)
    atomic_write.check_writable(where)
    atomic_write.save_files({where: figure_bytes(figure, where)})
    return where


def figure_bytes(figure: Figure, path: Path) -> bytes:
    """Encode a figure in the format of a file's name; the same figure gives the same bytes.

    Raises
    ------
    InputError
        An unknown ending, or settings or variables of the user that keep matplotlib from drawing.
    """
    maker = output_marks.program_version()
    about: dict[str, dict[str, str | None]] = {
        ".png": {"Software": maker},
        ".svg": {"Creator": maker, "Date": None},
        ".pdf": {"Creator": maker, "CreationDate": None},
    }
    ending = path.suffix.lower()
    if ending not in about:
        raise InputError(f'{path}: a figure\'s name ends in .png, .svg or .pdf, got "{path.suffix}"')
    content = BytesIO()
    with drawing_settings():
        figure.savefig(content, format=ending[1:], dpi=150, metadata=about[ending])
    return escape_controls(content.getvalue().decode()).encode() if ending == ".svg" else content.getvalue()


@contextmanager
def drawing_settings(*, letters: Literal["path", "none"] = "path") -> Iterator[None]:
    """Draw one figure at a time, as settings and warnings are global; letters of SVG as paths or as text.

    Raises
    ------
    InputError
        Settings or variables of the user keep matplotlib from drawing.
    """
    refuse_wrong_date()
    with own_settings(svg__fonttype=letters, svg__hashsalt="conveyor"), warnings.catch_warnings():
        warnings.filterwarnings("ignore", _NO_GLYPH, UserWarning)
        yield


@dataclass(frozen=True)
class ConveyorSweep:
    """Power of a conveyor with its own rubber at several temperatures and speeds, as of a comparison."""

    conveyor: Conveyor
    compounds: tuple[RubberCompound, ...]
    scenes: tuple[ComparedScene, ...]
    coverage: tuple[Coverage, ...]


PowerScenes: TypeAlias = "CalculatedComparison | ConveyorSweep"
PowerAxis: TypeAlias = Literal["temperature", "speed"]
"""Variable of the abscissa; the other is fixed."""


def fixed_condition(comparison: PowerScenes, over: PowerAxis) -> float | None:
    """Speed [m/s] or temperature [K] at which power is drawn over the other: the solved one nearest to the spec's.

    A temperature must be solved for every compound.
    """
    if over == "temperature":
        spec, answered = comparison.conveyor.belt_speed, [{scene.speed for scene in comparison.scenes}]
    else:
        spec = comparison.conveyor.temperature
        answered = [{s.temperature for s in comparison.scenes if s.compound == c.name} for c in comparison.compounds]
    known = sorted(set.intersection(*answered))
    return min(known, key=lambda given: abs(given - spec), default=spec if over == "temperature" else None)


@own_settings()
def power_over(comparison: PowerScenes, over: PowerAxis, at: float | None = None, *, system: System = "SI") -> Figure:
    """Motor power of every compound over temperature at one speed [m/s], or over belt speed at one temperature [K].

    By default that of `fixed_condition`. Bands of the fit's replicas are shaded; dotted beyond the rubber's data.

    Raises
    ------
    InputError
        No scene is solved there, or no temperature for all compounds.
    """
    chosen, other = fixed_condition(comparison, over) if at is None else at, _OTHER_AXIS[over]
    if chosen is None:
        raise InputError("no temperature that every compound has an answer for: nothing to draw")
    scenes = [scene for scene in comparison.scenes if getattr(scene, other) == chosen]
    where = display_unit(other, system, large=True)
    if not scenes:
        raise InputError(f"no scene has an answer at {where(chosen):g} {where.sign}: nothing to draw")
    figure = _power_lines(comparison, scenes, over, system)
    set_title(figure, f"{comparison.conveyor.name}, {condition_text(other, chosen, system)}")
    return figure


def condition_text(name: str, value: float, system: System) -> str:
    """Speed or temperature as text for titles."""
    written = display_unit(name, system, large=True)
    return written.said(value, 4) if name == "speed" else f"{written(value):g} {written.sign}"


@own_settings()
def _power_lines(comparison: PowerScenes, scenes: Sequence[ComparedScene], over: str, system: System) -> Figure:
    """Power of scenes over temperature or speed, one line per compound."""
    figure, (axis,) = stacked_axes(1, 4.0)
    power, along = display_unit("power", system, large=True), display_unit(over, system, large=True)
    beyond = {(row.compound, row.temperature) for row in comparison.coverage if not row.covered}
    dotted = False
    for k, compound in enumerate(comparison.compounds):
        mine = sorted(
            (scene for scene in scenes if scene.compound == compound.name),
            key=lambda scene: float(getattr(scene, over)),
        )
        outside = [(compound.name, scene.temperature) in beyond for scene in mine]
        at, motor = along([getattr(scene, over) for scene in mine]), power([scene.motor for scene in mine])
        inside = np.ma.masked_array(motor, outside)
        if any(outside):
            axis.plot(at, motor, color=curve_colour(k), linestyle=":", linewidth=1)
            dotted = True
        axis.plot(at, inside, color=curve_colour(k), marker=".", label=compound.name)
        low = [s.motor_low for s in mine if s.motor_low is not None]
        high = [s.motor_high for s in mine if s.motor_high is not None]
        if mine and len(low) == len(mine):
            where = ~np.array(outside)
            axis.fill_between(at, power(low), power(high), where=where, color=curve_colour(k), alpha=0.15, linewidth=0)
    if dotted:
        axis.plot([], [], ":", color="0.3", linewidth=1, label="beyond the data")
    return finish_figure(figure, along.beside(f"belt {over}"), power.beside("motor power"), group="y")


@own_settings()
def power_differences(rows: Sequence[tuple[str, float, tuple[float | None, float | None]]], base: str) -> Figure:
    """Difference of motor power to a base in per cent, one dot per compound with its band."""
    figure, (axis,) = stacked_axes(1, 1.4 + 0.36 * len(rows))
    for i, (_, change, (low, high)) in enumerate(rows):
        if low is not None and high is not None:
            axis.plot([100.0 * low, 100.0 * high], [i, i], color=curve_colour(0), linewidth=2.5, alpha=0.5)
        axis.plot(100.0 * change, i, "o", color=curve_colour(0), markersize=7)
    axis.set_yticks(range(len(rows)), [name for name, *_ in rows], parse_math=False)
    axis.axvline(0.0, color="0.3", linewidth=0.8)
    axis.invert_yaxis()
    axis.margins(y=0.15)
    axis.set_xlabel(f"difference of mean motor power to {base} in %", parse_math=False)
    return figure


@own_settings()
def loss_tangents(
    compounds: Sequence[RubberCompound],
    temperature: float,
    excited: Mapping[str, tuple[float, float]] | None = None,
    *,
    system: System = "SI",
) -> Figure:
    """Master curves of tan δ at a temperature [K], solid within the data, and the excited bands.

    Parameters
    ----------
    compounds : sequence of RubberCompound
        At least one.
    temperature : float
        Temperature to which the curves are shifted [K].
    excited : mapping of str to tuple, optional
        Excited frequency bands by label [Hz].
    system : {"SI", "US"}
        Unit system of the temperature in the label.
    """
    figure, (axis,) = stacked_axes()
    warmth = display_unit("temperature", system, large=True)
    for k, compound in enumerate(compounds):
        series = compound.series(temperature)
        data = compound.frequencies(temperature)
        low, high = _WIDEST_BAND if data is None else data
        wide = np.geomspace(low / 10.0**_DECADES_BEYOND, high * 10.0**_DECADES_BEYOND, _POINTS)
        inside = np.ma.masked_array(wide, (wide < low) | (wide > high) | (data is None))
        tangent = series.tan_delta(2.0 * np.pi * wide)
        axis.plot(wide, tangent, color=curve_colour(k), linestyle=":", linewidth=1)
        axis.plot(inside, tangent, color=curve_colour(k), label=compound.name)
    for k, (name, (low, high)) in enumerate((excited or {}).items()):
        axis.axvspan(low, high, color="0.55", alpha=0.18 if k == 0 else 0.10, linewidth=0, label=name)
    axis.set(
        xscale="log",
        xlabel=display_unit("frequency").beside(f"frequency at {warmth(temperature):g} {warmth.sign}"),
        ylabel=display_unit("friction").beside("tan δ"),
        title="Loss tangent (dotted: beyond the data)",
    )
    axis.set_ylim(bottom=0.0)
    add_legend(axis)
    return figure


@own_settings()
def compared_loss_tangents(
    comparison: CalculatedComparison, temperature: float | None = None, *, system: System
) -> Figure:
    """Loss tangents of all compounds at one temperature [K], and the band that the conveyor's rolls excite there.

    By default the temperature nearest the spec's that is solved for every compound.

    Raises
    ------
    NoSolutionError
        No temperature is solved for every compound.
    """
    at = [{row.temperature for row in comparison.coverage if row.compound == c.name} for c in comparison.compounds]
    common = set.intersection(*at)
    if not common:
        raise NoSolutionError("no temperature that every compound has an answer for")
    own = comparison.conveyor.temperature if temperature is None else temperature
    chosen = min(common, key=lambda t: abs(t - own))
    rows = [row.excited for row in comparison.coverage if row.temperature == chosen]
    band = min(low for low, _ in rows), max(high for _, high in rows)
    return loss_tangents(comparison.compounds, chosen, {"90 % loss band of the rolls": band}, system=system)


@own_settings()
def master_curve(compound: RubberCompound, temperature: float | None = None, *, system: System = "SI") -> Figure:
    """E', E'' and tan δ of a compound at a temperature [K], by default its reference temperature."""
    figure, (above, below) = stacked_axes(2, 7.0)
    modulus, warmth = (
        display_unit("pressure", system, large=True),
        display_unit("temperature", system, large=True),
    )
    at = compound.reference if temperature is None else temperature
    series, data = compound.series(at), compound.frequencies(at)
    low, high = _WIDEST_BAND if data is None else data
    f = np.geomspace(low, high, _POINTS)
    omega = 2.0 * np.pi * f
    drawn = "-" if data is not None else ":"  # no data are stated: nothing is solid
    if data is not None:
        for beyond in (
            np.geomspace(low / 10.0**_DECADES_BEYOND, low, _POINTS),
            np.geomspace(high, high * 10.0**_DECADES_BEYOND, _POINTS),
        ):
            past = 2.0 * np.pi * beyond
            for axis, values, k in (
                (above, modulus(series.storage(past)), 0),
                (above, modulus(series.loss(past)), 1),
                (below, series.tan_delta(past), 2),
            ):
                axis.plot(beyond, values, color=curve_colour(k), linestyle=":", linewidth=1)
    above.plot(f, modulus(series.storage(omega)), drawn, color=curve_colour(0), label="E'")
    above.plot(f, modulus(series.loss(omega)), drawn, color=curve_colour(1), label="E''")
    below.plot(f, series.tan_delta(omega), drawn, color=curve_colour(2), label="tan δ")
    replicas = compound.replicas(at)
    if replicas:
        for axis, figures, k in (
            (above, modulus([r.storage(omega) for r in replicas]), 0),
            (above, modulus([r.loss(omega) for r in replicas]), 1),
            (below, [r.tan_delta(omega) for r in replicas], 2),
        ):
            bottom, top = np.quantile(np.array(figures), (0.05, 0.95), axis=0, method="weibull")
            axis.fill_between(f, bottom, top, color=curve_colour(k), alpha=0.2, linewidth=0)
    above.set(xscale="log", yscale="log", ylabel=modulus.beside("modulus"))
    set_title(figure, f"{compound.name} ({compound.kind})")
    where = f"{warmth(at):g} {warmth.sign}"
    below.set(
        xscale="log",
        xlabel=display_unit("frequency").beside(f"frequency at {where}"),
        ylabel=display_unit("friction").beside("tan δ"),
    )
    below.set_ylim(bottom=0.0)
    add_legend(above)
    return figure
