"""Figures of one analysis and of its studies: matplotlib figures returned, never shown or saved.

Axes are in SI units (kN, kW, MPa), or in US units (lbf, hp, psi).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from conveyor.contact import solve
from conveyor.errors import InputError
from conveyor.force_sums import force_label
from conveyor.indentation import to_problem
from conveyor.laws.tension import grip_tension
from conveyor.line.contacts import Contacts, RollResult
from conveyor.line.stretches import STRANDS
from conveyor.loop.equilibrium import tension_suffices
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import (
    PowerAxis,
    add_legend,
    condition_text,
    curve_colour,
    finish_figure,
    master_curve,
    set_title,
    stacked_axes,
)
from conveyor.report.set_outline import set_outlines
from conveyor.report.table_model import FAILS
from conveyor.units import System
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.calculated_conveyor import CalculatedConveyor
    from conveyor.line.line import Line
    from conveyor.line.stretches import RouteSection, Strand
    from conveyor.loop.balance import Balance
    from conveyor.loop.estimates import ClassicalEstimate
    from conveyor.loop.horizontal_curve_duty import HorizontalCurveCheck
    from conveyor.loop.start_and_stop import StartAndStop
    from conveyor.loop.tensions import MotionState
    from conveyor.models import Conveyor, RubberCompound
    from conveyor.studies.input_ranges import CalculatedRanges
    from conveyor.studies.load_cases import CalculatedCases, CaseResult
    from conveyor.studies.monte_carlo import MonteCarlo


_SUMS = ("main", "secondary", "special", "lift", "total")
_BAR_INCHES, _BAR_GAP = 0.17, 0.6  # height of a bar, which its number needs; between rows, of a bar
_ABOUT_BARS = 1.3  # height of the title, the axis and the legend [in]
_HATCH = ("", "////", "\\\\\\\\")
_BAND, _BAND_LINES = (0.5, 0.5, 0.5, 0.15), (0.3, 0.3, 0.3, 0.45)
_POINTS = 300
_HALF_WIDTHS = 1.25  # half widths drawn on either side of a contact
_PRESSURE_RTOL = 1e-6  # of friction; the pressure is then good to about 1 % at the edges
_TORNADO_INPUTS = 12  # inputs drawn, those that matter most


@own_settings()
def resistance_breakdown(balance: Balance, *, system: System = "SI") -> Figure:
    """Bars of every resistance [kN, lbf], and the classical estimates of their sums; numbers at the bars."""
    force = display_unit("force", system, large=True)
    estimates: list[tuple[str, ClassicalEstimate]] = [
        (f"ISO 5048 / DIN 22101, f = {balance.classical.friction_factor:.4g}", balance.classical)
    ]
    if balance.cema is not None:
        estimates.append(("CEMA classic, given Ky", balance.cema))
    parts = [name for name in balance.forces.parts if name not in _SUMS]
    names, first_sum = [*parts, *_SUMS], len(parts)
    bars = [1] * first_sum + [1 + len(estimates)] * len(_SUMS)
    tops = list(accumulate((count + _BAR_GAP for count in bars), initial=0.0))
    figure, (axis,) = stacked_axes(1, _ABOUT_BARS + _BAR_INCHES * tops[-1])
    sums_here = balance.forces
    forces = force([*(sums_here.parts[name] for name in parts), *(getattr(sums_here, name) for name in _SUMS)])
    columns = [("this calculation", tops[:-1], forces)]
    columns += [
        (label, tops[first_sum:-1], force([getattr(made, name) for name in _SUMS])) for label, made in estimates
    ]
    for k, (label, at, values) in enumerate(columns):
        drawn = axis.barh([top + k for top in at], values, height=1.0, label=label, **_bar_style(k))
        axis.bar_label(drawn, fmt="{:,.1f}" if system == "SI" else "{:,.0f}", padding=3, fontsize=9)
    middles = [top + 0.5 * (count - 1) for top, count in zip(tops, bars, strict=False)]
    axis.set_yticks(middles, [_resistance_label(name) for name in names])
    axis.axhline(tops[first_sum] - 0.5 * (1.0 + _BAR_GAP), color="0.75", linewidth=0.8)
    axis.axvline(0.0, color="0.3", linewidth=0.8)
    axis.invert_yaxis()
    axis.margins(x=0.12)
    axis.grid(visible=False, axis="y")
    return finish_figure(figure, force.beside("force"), title="Resistances", group="x")


def _bar_style(k: int) -> dict[str, Any]:
    """Style of the bars of the k-th calculation: the first filled, the others hatched."""
    return {"color": curve_colour(0) if k == 0 else "white", "edgecolor": curve_colour(k), "hatch": _HATCH[k]}


def _resistance_label(name: str) -> str:
    words = {"total": "effective tension", "main": "main resistance"}
    return words.get(name, force_label(name))


def governing_roll(contacts: Contacts, strand: Strand) -> RollResult:
    """Roll with the highest line load on a strand."""
    pairs = zip(contacts.line.stretches, contacts.rolls, strict=True)
    of_strand = [roll for stretch, rolls in pairs if stretch.strand == strand for roll in rolls]
    return max(of_strand, key=lambda roll: roll.load.peak_line_load)


@own_settings()
def pressure_under_rolls(contacts: Contacts, *, system: System = "SI") -> Figure:
    """Contact pressure under the highest line load of each strand, over the distance from the roll's axis.

    In MPa over mm, or psi over inches; positive on the side the belt comes from. The load is that at the inner end of
    a wing roll, or along a middle roll.

    Raises
    ------
    NoSolutionError
        A contact that was interpolated between others has no answer of its own.
    """
    figure, (axis,) = stacked_axes(1, 3.6)
    stress, way, line = (display_unit(kind, system, large=True) for kind in ("pressure", "thickness", "line force"))
    strands = tuple(filter(contacts.rolls_on, STRANDS))
    for k, strand in enumerate(strands):
        roll = governing_roll(contacts, strand)
        contact, load = roll.curve.contact, roll.load.peak_line_load
        problem = to_problem(contact, load)
        solution = solve(problem, _PRESSURE_RTOL)
        pascal = load / (contact.spacing * problem.pressure)
        reach = _HALF_WIDTHS * solution.half_width
        x = np.linspace(solution.eccentricity - reach, solution.eccentricity + reach, _POINTS)
        edges = solution.patches.ravel()  # the curve meets zero at the edges, whatever the grid
        x = np.sort(np.concatenate([x, edges]))
        axis.plot(
            way(contact.radius * x),
            stress(pascal * solution.pressure(x)),
            color=curve_colour(k),
            label=f"{strand}: {_load_text(float(line(load)))} {line.sign}, "
            f"roll {way(2.0 * contact.radius):.4g} {way.sign}, "
            f"cover {way(contact.cover_thickness):.3g} {way.sign}",
        )
    axis.axvline(0.0, color="0.75", linewidth=0.8, zorder=0)
    axis.set(
        xlabel=way.beside("distance from the roll's axis, positive where the belt arrives"),
        ylabel=stress.beside("pressure"),
        title="Pressure under the rolls of the highest line load",
    )
    axis.margins(y=0.4)  # room for the legend above the curves
    axis.set_ylim(bottom=0.0)
    add_legend(axis)
    return figure


def _load_text(value: float) -> str:
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.4g}"


@own_settings()
def excited_master_curve(
    compound: RubberCompound,
    temperature: float,
    contacts: Contacts,
    strands: tuple[Strand, ...],
    *,
    system: System = "SI",
) -> Figure:
    """Master curve of a compound at a temperature [K], with the band each strand's rolls excite [Hz] shaded."""
    figure = master_curve(compound, temperature, system=system)
    for k, strand in enumerate(strands):
        band = contacts.excited_band(strand)
        if band is None:
            continue
        for axis in figure.axes:
            shaded = axis.axvspan(*band, facecolor=_BAND, hatch=_HATCH[k + 1][:2], edgecolor=_BAND_LINES)
            shaded.set(linewidth=0, label=f"{strand} rolls: 90 % loss band")
    add_legend(figure.axes[-1])
    return figure


@own_settings()
def case_power(study: CalculatedCases, over: PowerAxis, at: float | None = None, *, system: System = "SI") -> Figure:
    """Motor power [kW, hp] of every load case over temperature at one speed [m/s], or over speed at a temperature [K].

    By default the speed or temperature that most cases have.

    Raises
    ------
    InputError
        No case was answered, or none there.
    """
    name, sign = ("speed", "m/s") if over == "temperature" else ("temperature", "K")
    values = [getattr(result, name) for result in study.results]
    if not values:
        raise InputError("no load case has an answer: nothing to draw")
    chosen = max(sorted(set(values)), key=values.count) if at is None else at
    results = [result for result in study.results if getattr(result, name) == chosen]
    if not results:
        listed = ", ".join(f"{known:g}" for known in sorted(set(values)))
        raise InputError(f"{name} = {chosen!r} {sign}: no load case has it, there are {listed}")
    figure, (low, high) = _power_lines(results, over, system), study.friction_band
    title = f"{study.conveyor.name}, {condition_text(name, chosen, system)}"
    set_title(figure, title, f"shaded: friction factor {low:g}-{high:g}")
    return figure


@own_settings()
def _power_lines(cases: list[CaseResult], over: str, system: System) -> Figure:
    figure, (axis,) = stacked_axes(1, 3.8)
    power, along = display_unit("power", system, large=True), display_unit(over, system, large=True)
    covered = [result for result in cases if result.covered]
    names = [result.case.name for result in covered]
    lines = [name for name in dict.fromkeys(names) if names.count(name) > 1]  # one point makes no line
    for k, case in enumerate(lines or dict.fromkeys(names)):
        rows = sorted((r for r in covered if r.case.name == case), key=lambda r: float(getattr(r, over)))
        at = along([getattr(r, over) for r in rows])
        motor = power([r.found.balance.power.motor for r in rows])
        axis.plot(at, motor, color=curve_colour(k), marker="o", markersize=4, label=case)
        low, high = (power([r.motors[end] for r in rows]) for end in (0, 1))
        axis.fill_between(at, low, high, color=curve_colour(k), alpha=0.12, linewidth=0)
    beyond = [result for result in cases if not result.covered]
    if beyond:
        at, shafts = zip(*((getattr(r, over), r.found.balance.power.motor) for r in beyond), strict=True)
        label = "beyond the rubber data: not for design"
        axis.plot(along(at), power(shafts), color="grey", linestyle="none", marker="x", label=label)
    return finish_figure(figure, along.beside(f"belt {over}"), power.beside("motor power"), group="y")


@own_settings()
def tornado_chart(study: CalculatedRanges, *, system: System = "SI") -> Figure:
    """Change of the motor power [kW, hp] at both ends of every input's range, the most influential input on top."""
    effects, power = study.effects[:_TORNADO_INPUTS], display_unit("power", system, large=True)
    figure, (axis,) = stacked_axes(1, 1.2 + 0.32 * len(effects))
    rows = range(len(effects))
    for label, k, ends in (
        ("at the low end", 0, [effect.motor_low for effect in effects]),
        ("at the high end", 1, [effect.motor_high for effect in effects]),
    ):
        changes = power([end - study.motor for end in ends])
        axis.barh(rows, changes, label=label, height=0.6, **_bar_style(k))
    axis.set_yticks(list(rows), [effect.name for effect in effects], parse_math=False)
    axis.axvline(0.0, color="0.3", linewidth=0.8)
    axis.invert_yaxis()
    axis.grid(visible=False, axis="y")
    return finish_figure(figure, power.beside("change of the motor power"), title=study.conveyor.name)


@own_settings()
def interval_convergence(exact: MonteCarlo, first_order: tuple[float, float], *, system: System) -> Figure:
    """Ends of the 90 % interval of the motor power [kW, hp] over the number of draws, and those of first order."""
    figure, (axis,) = stacked_axes(1, 3.6)
    power, rows = display_unit("power", system, large=True), exact.convergence
    draws = [row.draws for row in rows]
    for k, (name, end) in enumerate((("low", first_order[0]), ("high", first_order[1]))):
        values = power([getattr(row, name) for row in rows])
        between = [power([getattr(row, f"{name}_between")[side] for row in rows]) for side in (0, 1)]
        axis.fill_between(draws, *between, color=curve_colour(k), alpha=0.15, linewidth=0)
        axis.plot(draws, values, color=curve_colour(k), marker="o", markersize=4, label=f"{name} end, draws in full")
        axis.axhline(float(power(end)), color=curve_colour(k), linestyle=":", linewidth=1.2)
    axis.plot([], [], ":", color="0.3", label="first order")
    axis.set_xscale("log", base=2)
    axis.set_xticks(draws, [f"{n:,}" for n in draws], minor=False)
    return finish_figure(figure, "draws", power.beside("motor power"), group="y")


Array = NDArray[np.float64]
_HEIGHT = 4.4
_MARKERS = {"feeding": ("v", 10, "#2E8B57"), "drive": ("o", 9, "#C55A11"), "take-up": ("s", 14, "#8064A2")}
"""Marker, size and colour of equipment along the route."""
_FAILS = "#B3261E"
_LOOP_DISTANCE = "distance from the head along the belt, return strand first"
_CURVE_CHORDS = 24  # chords of a curve in plan
_OFF_ROLLS = 1.5  # of the free roll width: drawn length of an unbounded drift
_LEVEL_MARGIN = 0.05  # of the length, above and below a level route
_ASPECT = 5.0  # a height that is less than a fifth of the length is drawn larger


def route_markers(conveyor: Conveyor, line: Line) -> dict[str, tuple[int, ...]]:
    """Section boundaries, counted from the tail, of feeding points, drives and the take-up."""
    names = [section.name for section in conveyor.route.sections]
    feeding = [0 if at.section is None else names.index(at.section) for at in conveyor.route.feeding_points]
    n = len(names)
    drives = [_from_tail(drive.spot.boundary, n) for drive in line.drives]
    spot = line.take_up.spot
    held = drives[:1] if spot is None else [_from_tail(spot.boundary, n)]
    marks = {"feeding": feeding, "drive": drives, "take-up": held}
    return {what: tuple(dict.fromkeys(at)) for what, at in marks.items() if at}


def _from_tail(boundary: int, sections: int) -> int:
    """Route boundary of a loop boundary; the loop runs from the head along the return strand and back."""
    return abs(sections - boundary)


def tension_fault(line: Line, state: MotionState) -> str:
    """Suffix for the name of a motion state whose belt is slack or slips; else empty."""
    slips = any(
        not tension_suffices(side.slack, grip_tension(side.force, friction=drive.friction, wrap_angle=drive.wrap_angle))
        for drive, side in zip(line.drives, state.drives, strict=True)
    )
    wrong = [what for what, so in (("slack belt", state.slack), ("belt slips", slips)) if so]
    return f", {FAILS}: {', '.join(wrong)}" if wrong else ""


@own_settings()
def route_profile(
    conveyor: Conveyor, line: Line, boundaries: Sequence[tuple[float, float]], *, system: System = "SI"
) -> Figure:
    """Height over horizontal distance from the tail [m], with feeding points, drives and take-up marked."""
    figure, (axis,) = stacked_axes(1, _HEIGHT)
    length = display_unit("length", system, large=True)
    x, z = length(np.transpose(boundaries))
    axis.plot(x, z, color="#1F4E79", marker=".", zorder=2)
    for what, at in route_markers(conveyor, line).items():
        marker, size, ink = _MARKERS[what]
        axis.plot(
            x[list(at)], z[list(at)], marker, color=ink, markersize=size, fillstyle="none", markeredgewidth=1.8,
            label=what,
        )  # fmt: skip
    for i, section in enumerate(conveyor.route.sections):
        if section.curve is not None:
            axis.plot(x[i : i + 2], z[i : i + 2], color="#A61C3C", linewidth=3, label=f"{section.curve} curve")
    if np.ptp(z) == 0.0:
        axis.set_ylim(-_LEVEL_MARGIN * np.ptp(x), _LEVEL_MARGIN * np.ptp(x))
    elif np.ptp(x) < _ASPECT * np.ptp(z):
        axis.set_aspect("equal", adjustable="datalim")
    across, up = length.beside("horizontal distance"), length.beside("height over the tail")
    return finish_figure(figure, across, up, conveyor.name, group="x")


@own_settings()
def cross_section(conveyor: Conveyor, line: Line, *, system: System = "SI") -> Figure:
    """An idler set of each strand with its belt and bulk, to scale; the belt is centred."""
    figure, axes = stacked_axes(2, 1.4 * _HEIGHT)
    size = display_unit("size", system)
    for axis, one in zip(axes, set_outlines(line, conveyor.material.surcharge), strict=True):
        for x, y in one.rolls:
            axis.fill(size(x), size(y), color="0.85", edgecolor="0.4")
        axis.plot(*map(size, one.belt), color="#1F4E79", linewidth=3, zorder=3)
        if one.bulk is not None:
            axis.fill(*map(size, one.bulk), color="#C9A66B", zorder=2)
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_ylabel(size.beside(f"{one.strand}, up"))
    axes[1].set_xlabel(size.beside("across the belt"))
    set_title(figure, "Sets, belt and bulk")
    return figure


def _plan_steps(section: RouteSection, heading: float) -> tuple[Array, float]:
    """Steps of a section in plan (x, y) from its tail end [m], shape (k, 2), and the heading behind it [rad]."""
    level = math.sqrt(section.length**2 - section.rise**2)
    bend = section.horizontal
    turned = 0.0 if bend is None else level / bend.radius * (1.0 if bend.side == "left" else -1.0)
    pieces = 1 if bend is None else _CURVE_CHORDS
    middles = heading + turned * (np.arange(pieces) + 0.5) / pieces
    return level / pieces * np.stack([np.cos(middles), np.sin(middles)], axis=1), heading + turned


@own_settings()
def plan_view(line: Line, *, system: System = "SI") -> Figure:
    """Plan of the route from the tail, which heads along x; horizontal curves in red."""
    figure, (axis,) = stacked_axes(1, _HEIGHT)
    length = display_unit("length", system, large=True)
    at, heading = np.zeros(2), 0.0
    for section in line.sections:
        steps, heading = _plan_steps(section, heading)
        points = np.concatenate([[at], at + np.cumsum(steps, axis=0)])
        x, y = length(points.T)
        label = "straight" if section.horizontal is None else "horizontal curve"
        axis.plot(x, y, color="#1F4E79" if section.horizontal is None else "#A61C3C", linewidth=3, label=label)
        axis.plot(x[:1], y[:1], ".", color="0.3")
        at = points[-1]
    axis.plot(*length(at[:, None]), "o", color="#C55A11", fillstyle="none", label="head")
    axis.set_aspect("equal", adjustable="datalim")
    along, across = length.beside("along, from the tail"), length.beside("across")
    return finish_figure(figure, along, across, "Plan of the route", group="xy")


@own_settings()
def drift_diagram(loads: Sequence[tuple[str, Sequence[HorizontalCurveCheck]]], *, system: System) -> Figure:
    """Range of belt drift over all states of each load in every horizontal curve; the free roll width in grey."""
    bends, size = loads[0][1], display_unit("size", system)
    figure, (axis,) = stacked_axes(1, 1.4 + 0.7 * len(bends))
    axis.use_sticky_edges = False  # the grey ends within the picture
    thick = 0.8 / len(loads)
    for i, bend in enumerate(bends):
        room = float(size(bend.turn.room))
        axis.barh(i, 2.0 * room, left=-room, height=0.9, color="0.88", zorder=1)
        for k, (name, turns) in enumerate(loads):
            outside, inside = turns[i].farthest_out.outside, turns[i].farthest_in.inside
            y, ends = i - 0.4 + (k + 0.5) * thick, (outside, inside)
            low, high = (math.copysign(_OFF_ROLLS * room, end) if math.isinf(end) else float(size(end)) for end in ends)
            runs_off = any(map(math.isinf, ends))
            axis.plot(
                [low, high], [y, y], color=curve_colour(k), linewidth=max(1.5, 14.0 * thick), label=name,
                linestyle=":" if runs_off else "-", solid_capstyle="butt", zorder=3,
            )  # fmt: skip
            if runs_off:
                axis.annotate("runs off", (max(low, high, key=abs), y), fontsize=7, color=_FAILS, va="center")
    axis.axvline(0.0, color="0.5", linewidth=0.8)
    axis.set_yticks(range(len(bends)), [f"{bend.section}, {bend.strand}" for bend in bends])
    axis.invert_yaxis()
    words = size.beside("drift, outside negative, inside positive")
    return finish_figure(figure, words, title="Drift in the horizontal curves")


@own_settings()
def tension_diagram(balance: Balance, moving: StartAndStop, *, system: System) -> Figure:
    """Tension round the loop from the head, one line per motion state; the minimum for sag in grey."""
    figure, (axis,) = stacked_axes(1, _HEIGHT)
    equilibrium = balance.equilibrium
    shape = balance.line.loop
    force, length = display_unit("force", system, large=True), display_unit("length", system, large=True)
    way = length(np.repeat(shape.way, 2)[1:-1])
    states = equilibrium.states | moving.states
    for k, state in enumerate(states.values()):
        tensions = np.stack([state.starts, state.ends], axis=1).ravel()
        x = np.concatenate([[0.0], way, way[-1:]])
        y = np.concatenate([[state.leaving], tensions, [state.arriving]])
        axis.plot(x, force(y), color=curve_colour(k), label=f"{state.name}{tension_fault(balance.line, state)}")
        if state.slack:
            low = force(np.minimum(y, 0.0))
            axis.fill_between(x, low, 0.0, color=_FAILS, alpha=0.35, linewidth=0, zorder=0)
    axis.plot(way, force(np.repeat(shape.least, 2)), color="0.6", linestyle=":", label="minimum tension (sag)")
    tail = float(length(shape.way[len(shape.length) // 2]))
    axis.axvline(tail, color="0.8", zorder=0)
    axis.annotate("tail", (tail, 0.0), xycoords=("data", "axes fraction"), color="0.4", ha="center", va="bottom")
    return finish_figure(
        figure, length.beside(_LOOP_DISTANCE), force.beside("tension"), "Tension round the loop", group="xy"
    )


@own_settings()
def flap_diagram(result: CalculatedConveyor, *, system: System) -> Figure:
    """Natural frequencies of the belt between the idler sets in steady running, and the rotation of the rolls."""
    figure, (axis,) = stacked_axes(1, _HEIGHT)
    length, frequency, shape = (
        display_unit("length", system, large=True),
        display_unit("swing", system),
        result.line.loop,
    )
    places = {(s.section, s.strand): shape.way[i : i + 2] for i, s in enumerate(shape.stretches)}
    lines: dict[str, tuple[str, str, list[float], list[float]]] = {}

    def drawn(label: str, ink: str, line: str, x: Sequence[float], y: Sequence[float]) -> None:
        _, _, ways, values = lines.setdefault(label, (ink, line, [], []))
        ways += [*x, math.nan]  # a gap
        values += [*y, math.nan]

    for duty in result.set_duty:
        x = length(np.asarray(places[duty.stretch.section, duty.stretch.strand])).tolist()
        strand, margin = duty.stretch.strand, duty.limits.flap_margin or 0.0
        ink = curve_colour(STRANDS.index(strand))
        drawn(f"belt, {strand}", ink, "-", x, duty.swings)
        drawn(f"belt, {strand}, second mode", ink, "--", x, [2.0 * swing for swing in duty.swings])
        for each in dict.fromkeys(duty.rotations):
            drawn("rotation of the rolls", _FAILS, "-", x, [each, each])
            axis.fill_between(x, each * (1 - margin), each * (1 + margin), color=_FAILS, alpha=0.15, linewidth=0)
    for label, (ink, line, ways, values) in lines.items():
        axis.plot(ways, values, line, color=ink, label=label)
    axis.set_ylim(bottom=0.0)
    title = "Belt between the idlers and rotation of the rolls"
    return finish_figure(figure, length.beside(_LOOP_DISTANCE), frequency.beside("frequency"), title, group="x")
