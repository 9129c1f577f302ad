"""Figures of starting and stopping: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from conveyor.report.plots import colour, grouped, plain, stacked, titled
from conveyor.units import System
from conveyor.units.presentation import unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from conveyor.dynamics.follow import Followed

_LEVELS, _MOST = 14, 160  # shades, and points a side, of the map
_HEIGHT, _WHOLE = 4.4, 13.0


def tension_map(found: Followed, *, system: System = "SI") -> Figure:
    """Tension over place and time."""
    figure, (axis,) = stacked(1, _HEIGHT)
    _map(figure, axis, found, system)
    return figure


def envelope(found: Followed, *, system: System = "SI") -> Figure:
    """Highest and lowest tension over the place, and that at the begin."""
    figure, (axis,) = stacked(1, _HEIGHT)
    _envelope(axis, found, system)
    return figure


def histories(found: Followed, *, system: System = "SI") -> Figure:
    """Speeds, and tensions at the drives and the take-up, over time."""
    figure, axes = stacked(2, _HEIGHT)
    _histories(axes, found, system)
    return figure


def picture(found: Followed, *, system: System = "SI") -> Figure:
    """All of them on one sheet."""
    figure, axes = stacked(4, _WHOLE)
    _map(figure, axes[0], found, system)
    _envelope(axes[1], found, system)
    _histories(axes[2:], found, system)
    titled(figure, found.name)
    return figure


def _map(figure: Figure, axis: Axes, found: Followed, system: System) -> None:
    force, length = unit("force", system, large=True), unit("length", system, large=True)
    order, distance = found.round_loop
    record = found.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _MOST).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _MOST).astype(int))
    tension = force(record.tensions[np.ix_(kept, order[cells])])
    shaded = axis.contourf(
        length(distance[cells]), record.times[kept], tension, levels=_LEVELS, cmap="viridis"
    )
    if float(tension.min()) < 0.0 < float(tension.max()):
        axis.contour(
            length(distance[cells]), record.times[kept], tension, levels=[0.0], colors="red", linewidths=1.0
        )
    axis.axvline(float(length(found.line.loop.way[found.line.count])), color="white", linewidth=0.8)
    axis.grid(visible=False)
    axis.set(
        xlabel=length.beside("distance from the head, return strand first"),
        ylabel=unit("duration", system).beside("time"),
    )
    grouped(axis.xaxis)
    beside = axis.inset_axes((1.02, 0.0, 0.03, 1.0))  # no axes of its own: those bind the figure's layout
    figure.colorbar(shaded, cax=beside, label=force.beside("tension"))


def _envelope(axis: Axes, found: Followed, system: System) -> None:
    force, length = unit("force", system, large=True), unit("length", system, large=True)
    order, distance = found.round_loop
    x, record = length(distance), found.record
    axis.fill_between(
        x, force(record.lowest[order]), force(record.highest[order]), color="#1F4E79", alpha=0.15
    )
    for k, (name, values) in enumerate(
        (("highest", record.highest), ("lowest", record.lowest), ("at the begin", record.tensions[0]))
    ):
        axis.plot(x, force(values[order]), color=colour(k), label=name)
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    axis.axvline(float(length(found.line.loop.way[found.line.count])), color="0.8", zorder=0)
    axis.set(
        xlabel=length.beside("distance from the head, return strand first"), ylabel=force.beside("tension")
    )
    for scaled in (axis.xaxis, axis.yaxis):
        grouped(scaled)
    plain(axis.legend(fontsize=8))


def _histories(axes: list[Axes], found: Followed, system: System) -> None:
    force, speed = unit("force", system, large=True), unit("speed", system)
    kept = np.unique(np.linspace(0, found.times.size - 1, 2000).astype(int))
    time, drives = found.times[kept], found.record.drives
    above, below = axes
    for d, drive in enumerate(found.ride.drives):
        above.plot(time, speed(drives["belt"][kept, d]), color=colour(2 * d), label=f"belt at {drive.name}")
        if found.record.slipped[d]:
            above.plot(
                time,
                speed(drives["rim"][kept, d]),
                color=colour(2 * d),
                linestyle=":",
                label=f"rim of {drive.name}",
            )
        for k, name in enumerate(("arriving", "leaving")):
            below.plot(
                time, force(drives[name][kept, d]), color=colour(2 * d + k), label=f"{name} at {drive.name}"
            )
        below.plot(
            time,
            force(drives["motor"][kept, d]),
            color=colour(2 * d),
            linestyle="--",
            linewidth=0.9,
            label=f"motor of {drive.name}",
        )
    tail = _cell_at(found, float(found.line.loop.way[found.line.count]))
    above.plot(
        found.record.times,
        speed(found.record.speeds[:, tail]),
        color="0.4",
        linewidth=0.9,
        label="belt at the tail",
    )
    below.plot(
        found.record.times,
        force(found.record.tensions[:, tail]),
        color="0.4",
        linewidth=0.9,
        label="at the tail",
    )
    below.plot(
        time,
        force(found.record.take_up["tension"][kept]),
        color="#B8860B",
        linewidth=0.9,
        label="at the take-up",
    )
    above.set(ylabel=speed.beside("speed"))
    below.set(xlabel=unit("duration", system).beside("time"), ylabel=force.beside("tension, force"))
    grouped(below.yaxis)
    for axis in axes:
        plain(axis.legend(fontsize=7, ncols=2))


def _cell_at(found: Followed, distance: float) -> int:
    """The cell at a distance from the head [m]."""
    order, known = found.round_loop
    return int(order[int(np.argmin(np.abs(known - distance)))])
