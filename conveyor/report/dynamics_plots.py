"""Figures of starting and stopping: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from conveyor.report.animation import Panel, moving
from conveyor.report.columns import slug
from conveyor.report.plots import colour, grouped, keyed, stacked, titled
from conveyor.units import System
from conveyor.units.presentation import unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from conveyor.dynamics.follow import Followed
    from conveyor.markup import Html

_LEVELS, _MOST = 14, 80  # shades, and points a side, of the map
_POINTS = 1500  # of a history
_FRAMES, _PLACES = 45, 60  # of what moves
_HEIGHT, _LOW, _WHOLE = 4.4, 3.0, 13.0


def tension_map(scenario: Followed, *, system: System = "SI") -> Figure:
    """Tension over place and time."""
    figure, (axis,) = stacked(1, _HEIGHT)
    _map(figure, axis, scenario, system)
    return figure


def envelope(scenario: Followed, *, system: System = "SI") -> Figure:
    """Highest and lowest tension over the place, and that at the start."""
    figure, (axis,) = stacked(1, _HEIGHT)
    _envelope(axis, scenario, system)
    return figure


def speeds(scenario: Followed, *, system: System = "SI") -> Figure:
    """Speeds at drives and tail over time."""
    figure, (axis,) = stacked(1, _LOW)
    _speeds(axis, scenario, system)
    return figure


def forces(scenario: Followed, *, system: System = "SI") -> Figure:
    """Tensions at drives, tail and take-up, and forces of the motors, over time."""
    figure, (axis,) = stacked(1, _HEIGHT)
    _forces(axis, scenario, system)
    return figure


def profile(scenario: Followed, *, system: System = "SI") -> Html:
    """Tension and speed over the place, moving; it plays when it is asked to."""
    force, length, speed = (
        unit("force", system, large=True),
        unit("length", system, large=True),
        unit("speed", system),
    )
    order, distance = scenario.round_loop
    record = scenario.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _FRAMES).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _PLACES).astype(int))
    ends = record.lowest[order][cells], record.highest[order][cells]
    tension = record.tensions[np.ix_(kept, order[cells])].astype(float)
    going = record.speeds[:, order[cells]].astype(float)
    where = length.beside("distance from the head, return strand first")
    return moving(
        f"moving_{slug(scenario.name)}", (where, length(distance[cells])),
        (unit("duration", system).beside("time"), record.times[kept]),
        (Panel(force.beside("tension"), force(tension), (force(ends[0]), force(ends[1]))),
         Panel(speed.beside("speed"), speed(going[kept]), (speed(going.min(axis=0)), speed(going.max(axis=0))))),
        mark=float(length(scenario.line.loop.way[scenario.line.count])),
    )  # fmt: skip


def picture(scenario: Followed, *, system: System = "SI") -> Figure:
    """All of them on one sheet."""
    figure, axes = stacked(4, _WHOLE)
    _map(figure, axes[0], scenario, system)
    _envelope(axes[1], scenario, system)
    _speeds(axes[2], scenario, system)
    _forces(axes[3], scenario, system)
    titled(figure, scenario.name)
    return figure


def _map(figure: Figure, axis: Axes, scenario: Followed, system: System) -> None:
    force, length = unit("force", system, large=True), unit("length", system, large=True)
    order, distance = scenario.round_loop
    record = scenario.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _MOST).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _MOST).astype(int))
    tension = force(record.tensions[np.ix_(kept, order[cells])])
    shaded = axis.contourf(
        length(distance[cells]), record.times[kept], tension, levels=_LEVELS, cmap="viridis"
    )
    taut = record.tensions[np.ix_(kept, order[cells])] / scenario.cells.slack[order[cells]]
    if float(taut.min()) < 1.0 < float(taut.max()):
        axis.contour(
            length(distance[cells]), record.times[kept], taut, levels=[1.0], colors="red", linewidths=1.0
        )
    axis.axvline(float(length(scenario.line.loop.way[scenario.line.count])), color="white", linewidth=0.8)
    axis.grid(visible=False)
    axis.set(
        xlabel=length.beside("distance from the head, return strand first"),
        ylabel=unit("duration", system).beside("time"),
    )
    grouped(axis.xaxis)
    beside = axis.inset_axes((1.02, 0.0, 0.03, 1.0))  # no axes of its own: those bind the figure's layout
    figure.colorbar(shaded, cax=beside, label=force.beside("tension"))


def _envelope(axis: Axes, scenario: Followed, system: System) -> None:
    force, length = unit("force", system, large=True), unit("length", system, large=True)
    order, distance = scenario.round_loop
    x, record = length(distance), scenario.record
    axis.fill_between(
        x, force(record.lowest[order]), force(record.highest[order]), color="#1F4E79", alpha=0.15
    )
    for k, (name, values) in enumerate(
        (("highest", record.highest), ("lowest", record.lowest), ("at the start", record.tensions[0]))
    ):
        axis.plot(x, force(values[order]), color=colour(k), label=name)
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    axis.axvline(float(length(scenario.line.loop.way[scenario.line.count])), color="0.8", zorder=0)
    axis.set(
        xlabel=length.beside("distance from the head, return strand first"), ylabel=force.beside("tension")
    )
    for scaled in (axis.xaxis, axis.yaxis):
        grouped(scaled)
    keyed(axis)


def _speeds(axis: Axes, scenario: Followed, system: System) -> None:
    speed, time = unit("speed", system), unit("duration", system)
    kept = np.unique(np.linspace(0, scenario.times.size - 1, _POINTS).astype(int))
    drives = scenario.record.drives
    for d, drive in enumerate(scenario.ride.drives):
        axis.plot(
            scenario.times[kept],
            speed(drives["belt"][kept, d]),
            color=colour(2 * d),
            label=f"belt at {drive.name}",
        )
        if scenario.record.slipped[d]:
            rim = speed(drives["rim"][kept, d])
            axis.plot(
                scenario.times[kept], rim, color=colour(2 * d), linestyle=":", label=f"rim of {drive.name}"
            )
    tail = speed(scenario.record.speeds[:, _tail(scenario)])
    axis.plot(scenario.record.times, tail, color="0.4", linewidth=0.9, label="belt at the tail")
    axis.set(xlabel=time.beside("time"), ylabel=speed.beside("speed"))
    keyed(axis)


def _forces(axis: Axes, scenario: Followed, system: System) -> None:
    force, time = unit("force", system, large=True), unit("duration", system)
    kept = np.unique(np.linspace(0, scenario.times.size - 1, _POINTS).astype(int))
    drives, times = scenario.record.drives, scenario.times[kept]
    for d, drive in enumerate(scenario.ride.drives):
        for k, name in enumerate(("arriving", "leaving")):
            axis.plot(
                times, force(drives[name][kept, d]), color=colour(2 * d + k), label=f"{name} at {drive.name}"
            )
        motor = force(drives["motor"][kept, d])
        axis.plot(
            times, motor, color=colour(2 * d), linestyle="--", linewidth=0.9, label=f"motor of {drive.name}"
        )
    tail = force(scenario.record.tensions[:, _tail(scenario)])
    axis.plot(scenario.record.times, tail, color="0.4", linewidth=0.9, label="at the tail")
    held = force(scenario.record.take_up["tension"][kept])
    axis.plot(times, held, color=colour(6), linewidth=0.9, label="at the take-up")
    axis.set(xlabel=time.beside("time"), ylabel=force.beside("tension, force"))
    grouped(axis.yaxis)
    keyed(axis)


def _tail(scenario: Followed) -> int:
    """The cell at the tail."""
    order, known = scenario.round_loop
    return int(order[int(np.argmin(np.abs(known - scenario.line.loop.way[scenario.line.count])))])
