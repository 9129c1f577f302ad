"""Figures of the route and of the tensions: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.tension import grip_tension
from conveyor.line.stretches import STRANDS
from conveyor.loop.equilibrium import holds
from conveyor.report.columns import FAILS
from conveyor.report.plots import colour, grouped, keyed, stacked, titled
from conveyor.units import System
from conveyor.units.presentation import unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.line.line import Line
    from conveyor.line.stretches import RouteSection
    from conveyor.loop.balance import Balance
    from conveyor.loop.horizontal import HorizontalCheck
    from conveyor.loop.starting import Motions
    from conveyor.loop.tensions import MotionState
    from conveyor.models import Conveyor
    from conveyor.pipeline import CalculatedConveyor

Array = NDArray[np.float64]
_HEIGHT = 4.4
_MARKERS = {"feeding": ("v", 10, "#2E8B57"), "drive": ("o", 9, "#C55A11"), "take-up": ("s", 14, "#8064A2")}
"""How what stands along the route is drawn: marker, its size, its colour."""
_FAILS = "#B3261E"
_PIECES = 24  # chords of a curve in plan
_BEYOND = 1.5  # of the room on the rolls, to where a drift without end is drawn
_ROOM = 0.05  # of the length, above and below a level route
_ASPECT = 5.0  # a height that is less than a fifth of the length is drawn larger


def places(conveyor: Conveyor, line: Line) -> dict[str, tuple[int, ...]]:
    """Boundaries of sections, counted from the tail, at which feeding points, drives and the take-up stand."""
    names = [section.name for section in conveyor.route.sections]
    feeding = [0 if at.section is None else names.index(at.section) for at in conveyor.route.feeding_points]
    n = len(names)
    drives = [_from_tail(drive.spot.boundary, n) for drive in line.drives]
    spot = line.take_up.spot
    held = drives[:1] if spot is None else [_from_tail(spot.boundary, n)]
    marks = {"feeding": feeding, "drive": drives, "take-up": held}
    return {what: tuple(dict.fromkeys(at)) for what, at in marks.items() if at}


def _from_tail(boundary: int, sections: int) -> int:
    """Boundary of the route of a boundary of the loop, which goes from the head along the return strand and back."""
    return abs(sections - boundary)


def fault(line: Line, state: MotionState) -> str:
    """What is wrong with the tensions of a state, to stand behind its name; nothing where nothing is."""
    slips = any(
        not holds(side.slack, grip_tension(side.force, friction=drive.friction, wrap_angle=drive.wrap_angle))
        for drive, side in zip(line.drives, state.drives, strict=True)
    )
    wrong = [what for what, so in (("slack belt", state.slack), ("belt slips", slips)) if so]
    return f", {FAILS}: {', '.join(wrong)}" if wrong else ""


def route_profile(
    conveyor: Conveyor, line: Line, boundaries: Sequence[tuple[float, float]], *, system: System = "SI"
) -> Figure:
    """Height over horizontal distance from the tail [m], of every boundary of sections; what is where is marked."""
    figure, (axis,) = stacked(1, _HEIGHT)
    length = unit("length", system, large=True)
    x, z = length(np.transpose(boundaries))
    axis.plot(x, z, color="#1F4E79", marker=".", zorder=2)
    for what, at in places(conveyor, line).items():
        marker, size, ink = _MARKERS[what]
        axis.plot(
            x[list(at)], z[list(at)], marker, color=ink, markersize=size, fillstyle="none", markeredgewidth=1.8,
            label=what,
        )  # fmt: skip
    for i, section in enumerate(conveyor.route.sections):
        if section.curve is not None:
            axis.plot(
                x[i : i + 2], z[i : i + 2], color="#A61C3C", linewidth=3, label=f"{section.curve} curve"
            )
    if np.ptp(z) == 0.0:
        axis.set_ylim(-_ROOM * np.ptp(x), _ROOM * np.ptp(x))
    elif np.ptp(x) < _ASPECT * np.ptp(z):
        axis.set_aspect("equal", adjustable="datalim")
    axis.set(xlabel=length.beside("horizontal distance"), ylabel=length.beside("height over the tail"))
    titled(figure, conveyor.name)
    grouped(axis.xaxis)
    keyed(axis)
    return figure


def _drawn(section: RouteSection, heading: float) -> tuple[Array, float]:
    """Steps of a section in plan (x, y) from its tail end [m], shape (k, 2), and the heading behind it [rad]."""
    level = math.sqrt(section.length**2 - section.rise**2)
    bend = section.horizontal
    turned = 0.0 if bend is None else level / bend.radius * (1.0 if bend.side == "left" else -1.0)
    pieces = 1 if bend is None else _PIECES
    middles = heading + turned * (np.arange(pieces) + 0.5) / pieces
    return level / pieces * np.stack([np.cos(middles), np.sin(middles)], axis=1), heading + turned


def plan(line: Line, *, system: System = "SI") -> Figure:
    """The route seen from above, from the tail, which heads along x; sections on horizontal curves in red."""
    figure, (axis,) = stacked(1, _HEIGHT)
    length = unit("length", system, large=True)
    at, heading = np.zeros(2), 0.0
    for section in line.sections:
        steps, heading = _drawn(section, heading)
        points = np.concatenate([[at], at + np.cumsum(steps, axis=0)])
        x, y = length(points.T)
        label = "straight" if section.horizontal is None else "horizontal curve"
        axis.plot(
            x, y, color="#1F4E79" if section.horizontal is None else "#A61C3C", linewidth=3, label=label
        )
        axis.plot(x[:1], y[:1], ".", color="0.3")
        at = points[-1]
    axis.plot(*length(at[:, None]), "o", color="#C55A11", fillstyle="none", label="head")
    axis.set_aspect("equal", adjustable="datalim")
    axis.set(xlabel=length.beside("along, from the tail"), ylabel=length.beside("across"))
    titled(figure, "Plan of the route")
    for scaled in (axis.xaxis, axis.yaxis):
        grouped(scaled)
    keyed(axis)
    return figure


def drift(loads: Sequence[tuple[str, Sequence[HorizontalCheck]]], *, system: System = "SI") -> Figure:
    """Range of the drift over all states of each load in every horizontal curve; the room on the rolls in grey."""
    bends, size = loads[0][1], unit("thickness", system)
    figure, (axis,) = stacked(1, 1.4 + 0.7 * len(bends))
    thick = 0.8 / len(loads)
    for i, bend in enumerate(bends):
        room = float(size(bend.turn.room))
        axis.barh(i, 2.0 * room, left=-room, height=0.9, color="0.88", zorder=1)
        for k, (name, turns) in enumerate(loads):
            outside, inside = turns[i].farthest_out.outside, turns[i].farthest_in.inside
            y, ends = i - 0.4 + (k + 0.5) * thick, (outside, inside)
            low, high = (
                math.copysign(_BEYOND * room, end) if math.isinf(end) else float(size(end)) for end in ends
            )
            runs_off = any(map(math.isinf, ends))
            axis.plot(
                [low, high], [y, y], color=colour(k), linewidth=max(1.5, 14.0 * thick), label=name,
                linestyle=":" if runs_off else "-", solid_capstyle="butt", zorder=3,
            )  # fmt: skip
            if runs_off:
                axis.annotate("runs off", (max(low, high, key=abs), y), fontsize=7, color=_FAILS, va="center")
    axis.axvline(0.0, color="0.5", linewidth=0.8)
    axis.set_yticks(range(len(bends)), [f"{bend.section}, {bend.strand}" for bend in bends])
    axis.invert_yaxis()
    axis.set(xlabel=size.beside("drift, outside negative, inside positive"))
    titled(figure, "Drift in the horizontal curves")
    keyed(axis)
    return figure


def tension_diagram(balance: Balance, moving: Motions | None = None, *, system: System = "SI") -> Figure:
    """Tension round the loop from the head and back, a line a state; the least that the sag allows in grey."""
    figure, (axis,) = stacked(1, _HEIGHT)
    settled = balance.settled
    shape = balance.line.loop
    force, length = unit("force", system, large=True), unit("length", system, large=True)
    way = length(np.repeat(shape.way, 2)[1:-1])
    states = settled.states | ({} if moving is None else moving.states)
    for k, state in enumerate(states.values()):
        tensions = np.stack([state.starts, state.ends], axis=1).ravel()
        x = np.concatenate([[0.0], way, way[-1:]])
        y = np.concatenate([[state.leaving], tensions, [state.arriving]])
        axis.plot(x, force(y), color=colour(k), label=f"{state.name}{fault(balance.line, state)}")
        if state.slack:
            low = force(np.minimum(y, 0.0))
            axis.fill_between(x, low, 0.0, color=_FAILS, alpha=0.35, linewidth=0, zorder=0)
    axis.plot(
        way, force(np.repeat(shape.least, 2)), color="0.6", linestyle=":", label="minimum tension (sag)"
    )
    tail = float(length(shape.way[len(shape.length) // 2]))
    axis.axvline(tail, color="0.8", zorder=0)
    axis.annotate(
        "tail", (tail, 0.0), xycoords=("data", "axes fraction"), color="0.4", ha="center", va="bottom"
    )
    axis.set(
        xlabel=length.beside("distance from the head along the belt, return strand first"),
        ylabel=force.beside("tension"),
    )
    for scaled in (axis.xaxis, axis.yaxis):
        grouped(scaled)
    titled(figure, "Tension round the loop")
    keyed(axis)
    return figure


def flap_diagram(result: CalculatedConveyor, *, system: System = "SI") -> Figure:
    """Natural frequencies of the belt between the sets round the loop, steady running, beside the rolls' rotation."""
    figure, (axis,) = stacked(1, _HEIGHT)
    length, frequency, shape = unit("length", system, large=True), unit("swing", system), result.line.loop
    places = {(s.section, s.strand): shape.way[i : i + 2] for i, s in enumerate(shape.stretches)}
    lines: dict[str, tuple[str, str, list[float], list[float]]] = {}

    def drawn(label: str, ink: str, line: str, x: Sequence[float], y: Sequence[float]) -> None:
        _, _, ways, values = lines.setdefault(label, (ink, line, [], []))
        ways += [*x, math.nan]  # a gap
        values += [*y, math.nan]

    for duty in result.set_duty:
        x = length(np.asarray(places[duty.stretch.section, duty.stretch.strand])).tolist()
        strand, margin = duty.stretch.strand, duty.limits.flap_margin or 0.0
        ink = colour(STRANDS.index(strand))
        drawn(f"belt, {strand}", ink, "-", x, duty.swings)
        drawn(f"belt, {strand}, second mode", ink, "--", x, [2.0 * swing for swing in duty.swings])
        for each in dict.fromkeys(duty.rotations):
            drawn("rotation of the rolls", _FAILS, "-", x, [each, each])
            axis.fill_between(
                x, each * (1 - margin), each * (1 + margin), color=_FAILS, alpha=0.15, linewidth=0
            )
    for label, (ink, line, ways, values) in lines.items():
        axis.plot(ways, values, line, color=ink, label=label)
    axis.set_ylim(bottom=0.0)
    axis.set(
        xlabel=length.beside("distance from the head along the belt, return strand first"),
        ylabel=frequency.beside("frequency"),
    )
    grouped(axis.xaxis)
    titled(figure, "Belt between the idlers and rotation of the rolls")
    keyed(axis)
    return figure
