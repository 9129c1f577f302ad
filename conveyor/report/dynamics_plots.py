"""Figures and animation of starts and stops."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from conveyor.report.animation import Panel, animated_curves
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import curve_colour, label_axes, set_title, stacked_axes
from conveyor.report.table_model import slug
from conveyor.units import System
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Picture

    from conveyor.dynamics.scenario_result import ScenarioResult
    from conveyor.text.markup import Html


_LEVELS, _MAP_POINTS = 14, 80  # shades, and points a side, of the map


_POINTS = 1500  # of a history


_FRAMES, _FRAME_POINTS = 45, 60  # times and points of an animation


_LOOP_DISTANCE: Final = "distance from the head, return strand first"


_HEIGHT, _LOW_HEIGHT, _WHOLE_HEIGHT = 4.4, 3.0, 13.0


def tension_animation(scenario: ScenarioResult, *, system: System = "SI") -> Html:
    """Animation of tension and speed round the loop."""
    force, length, speed = (
        display_unit("force", system, large=True),
        display_unit("length", system, large=True),
        display_unit("speed", system),
    )
    order, distance = scenario.round_loop
    record = scenario.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _FRAMES).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _FRAME_POINTS).astype(int))
    ends = record.lowest[order][cells], record.highest[order][cells]
    tension = record.tensions[np.ix_(kept, order[cells])].astype(float)
    going = record.speeds[:, order[cells]].astype(float)
    where = length.beside(_LOOP_DISTANCE)
    return animated_curves(
        f"moving_{slug(scenario.name)}", (where, length(distance[cells])),
        (display_unit("time", system).beside("time"), record.times[kept]),
        (Panel(force.beside("tension"), force(tension), (force(ends[0]), force(ends[1]))),
         Panel(speed.beside("speed"), speed(going[kept]), (speed(going.min(axis=0)), speed(going.max(axis=0))))),
        mark=float(length(scenario.line.loop.way[scenario.line.count])),
    )  # fmt: skip


@own_settings()
def scenario_figure(scenario: ScenarioResult, *names: str, system: System = "SI") -> Picture:
    """Figure of a scenario: tension map, envelope, speeds and forces, or those named."""
    drawn = {"tension_map": (_draw_tension_map, _HEIGHT), "envelope": (_draw_envelope, _HEIGHT),
    "speeds": (_draw_speeds, _LOW_HEIGHT),
             "forces": (_draw_forces, _HEIGHT)}  # fmt: skip
    shown = [drawn[name] for name in names or drawn]
    figure, axes = stacked_axes(len(shown), sum(height for _, height in shown) if names else _WHOLE_HEIGHT)
    for axis, (draw, _) in zip(axes, shown, strict=True):
        draw(axis, scenario, system)
    if not names:
        set_title(figure, scenario.name)
    return figure


def _draw_tension_map(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    force, length = display_unit("force", system, large=True), display_unit("length", system, large=True)
    order, distance = scenario.round_loop
    record = scenario.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _MAP_POINTS).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _MAP_POINTS).astype(int))
    tension = force(record.tensions[np.ix_(kept, order[cells])])
    shaded = axis.contourf(length(distance[cells]), record.times[kept], tension, levels=_LEVELS, cmap="viridis")
    taut = record.tensions[np.ix_(kept, order[cells])] / scenario.cells.slack[order[cells]]
    if float(taut.min()) < 1.0 < float(taut.max()):
        axis.contour(length(distance[cells]), record.times[kept], taut, levels=[1.0], colors="red", linewidths=1.0)
    axis.axvline(float(length(scenario.line.loop.way[scenario.line.count])), color="white", linewidth=0.8)
    axis.grid(visible=False)
    label_axes(axis, length.beside(_LOOP_DISTANCE), display_unit("time", system).beside("time"), group="x")
    beside = axis.inset_axes((1.02, 0.0, 0.03, 1.0))  # no axes of its own: those bind the figure's layout
    axis.figure.colorbar(shaded, cax=beside, label=force.beside("tension"))


def _draw_envelope(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    force, length = display_unit("force", system, large=True), display_unit("length", system, large=True)
    order, distance = scenario.round_loop
    x, record = length(distance), scenario.record
    axis.fill_between(x, force(record.lowest[order]), force(record.highest[order]), color="#1F4E79", alpha=0.15)
    for k, (name, values) in enumerate(
        (("highest", record.highest), ("lowest", record.lowest), ("at the start", record.tensions[0]))
    ):
        axis.plot(x, force(values[order]), color=curve_colour(k), label=name)
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    axis.axvline(float(length(scenario.line.loop.way[scenario.line.count])), color="0.8", zorder=0)
    label_axes(axis, length.beside(_LOOP_DISTANCE), force.beside("tension"), group="xy")


def _draw_speeds(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    speed, time = display_unit("speed", system), display_unit("time", system)
    kept = np.unique(np.linspace(0, scenario.times.size - 1, _POINTS).astype(int))
    drives = scenario.record.drives
    for d, drive in enumerate(scenario.setup.drives):
        belt = speed(drives["belt"][kept, d])
        axis.plot(scenario.times[kept], belt, color=curve_colour(2 * d), label=f"belt at {drive.name}")
        if scenario.record.slipped[d]:
            rim = speed(drives["rim"][kept, d])
            axis.plot(
                scenario.times[kept],
                rim,
                color=curve_colour(2 * d),
                linestyle=":",
                label=f"rim of {drive.name}",
            )
    tail = speed(scenario.record.speeds[:, _tail_cell(scenario)])
    axis.plot(scenario.record.times, tail, color="0.4", linewidth=0.9, label="belt at the tail")
    label_axes(axis, time.beside("time"), speed.beside("speed"))


def _draw_forces(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    force, time = display_unit("force", system, large=True), display_unit("time", system)
    kept = np.unique(np.linspace(0, scenario.times.size - 1, _POINTS).astype(int))
    drives, times = scenario.record.drives, scenario.times[kept]
    for d, drive in enumerate(scenario.setup.drives):
        for k, name in enumerate(("arriving", "leaving")):
            axis.plot(
                times,
                force(drives[name][kept, d]),
                color=curve_colour(2 * d + k),
                label=f"{name} at {drive.name}",
            )
        motor = force(drives["motor"][kept, d])
        axis.plot(
            times,
            motor,
            color=curve_colour(2 * d),
            linestyle="--",
            linewidth=0.9,
            label=f"motor of {drive.name}",
        )
    tail = force(scenario.record.tensions[:, _tail_cell(scenario)])
    axis.plot(scenario.record.times, tail, color="0.4", linewidth=0.9, label="at the tail")
    held = force(scenario.record.take_up["tension"][kept])
    axis.plot(times, held, color=curve_colour(6), linewidth=0.9, label="at the take-up")
    label_axes(axis, time.beside("time"), force.beside("tension, force"), group="y")


def _tail_cell(scenario: ScenarioResult) -> int:
    """Index of the cell at the tail."""
    order, known = scenario.round_loop
    return int(order[int(np.argmin(np.abs(known - scenario.line.loop.way[scenario.line.count])))])
