"""Tensions round the loop, profile of the route, take-up."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import accumulate
from typing import Any

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.line.line import Line
from conveyor.loop.take_up_duty import TakeUpDuty
from conveyor.loop.tensions import MotionState
from conveyor.report import analysis_plots
from conveyor.report.table_model import Column, Figure, PagePlacement, Table, figure_table, slug
from conveyor.units.sentences import Message

Getter = Callable[[Any], Any]


def tension_table(a: CalculatedConveyor) -> Table:
    """Tension round the loop in steady running, from the drive."""
    columns = (
        Column("place", "text", "place"),
        Column("distance from drive", "length", "distance"),
        Column("tension", "force", "tension"),
        Column("minimum tension (sag)", "force", "least_for_sag", key="least_for_sag"),
    )
    heading = "Tension round the loop, steady running, from the drive"
    return Table("tensions", "Tensions", heading, columns, a.balance.tension_points, printed=False)


def profile_table(a: CalculatedConveyor) -> Table:
    """Profile of the route: horizontal distance and height of every section boundary over the tail."""
    sections, ends = a.line.sections, section_boundaries(a.line)
    along = accumulate((section.length for section in sections), initial=0.0)
    places = analysis_plots.route_markers(a.conveyor, a.line)
    rows = zip(range(len(ends)), ("", *(section.name for section in sections)), along, ends, strict=True)
    columns = (
        Column("behind section", "text", "1"),
        Column("along the belt", "length", "2"),
        Column("horizontal", "length", "3.0"),
        Column("height", "length", "3.1"),
        *(
            Column(f"{what} at height", "length", _height_at(at), key=what.replace("-", "_"))
            for what, at in places.items()
        ),
    )
    heading = "Profile of the route"
    return Table("profile", "States", heading, columns, tuple(rows), printed=False)


def _height_at(boundaries_of: tuple[int, ...]) -> Getter:
    return lambda row: row[3][1] if row[0] in boundaries_of else None


def section_boundaries(line: Line) -> list[tuple[float, float]]:
    """Horizontal distance and height over the tail of every section boundary [m]."""
    points = [(0.0, 0.0)]
    for section in line.sections:
        across, up = points[-1]
        level = math.sqrt(section.length**2 - section.rise**2)
        points.append((across + level, up + section.rise))
    return points


def section_ends(a: CalculatedConveyor) -> Table:
    """Tension at every section end of the loop, from the head, in every state; failing states are marked."""
    shape = a.line.loop
    rows = ((0, 0), *((i, 1) for i in range(len(shape.stretches))))

    def place(at: tuple[int, int]) -> str:
        return f"{shape.stretches[at[0]].section}, {shape.stretches[at[0]].strand}" if at[1] else "head"

    columns = (
        Column("behind section", "text", place),
        *_place_columns(a),
        *(
            Column(
                f"{name}{analysis_plots.tension_fault(a.line, state)}",
                "force",
                _tension_getter(state),
                key=slug(name),
            )
            for name, state in _motion_states(a).items()
        ),
    )
    heading = "Tension behind every section in every state of motion"
    return Table("section_ends", "Tension diagram", heading, columns, rows, "tensions")


def _motion_states(a: CalculatedConveyor) -> dict[str, MotionState]:
    return a.balance.equilibrium.states | a.motions.states


def _place_columns(a: CalculatedConveyor) -> tuple[Column, ...]:
    """Columns of location and minimum tension for sag."""
    shape = a.line.loop
    return (
        Column("distance from head", "length", lambda at: float(shape.way[at[0] + at[1]])),
        Column("minimum tension (sag)", "force", lambda at: float(shape.least[at[0]]), key="least_for_sag"),
    )


def tension_states(a: CalculatedConveyor) -> Table:
    """Tension at both ends of every stretch in every state, in loop order from the head."""
    shape = a.line.loop
    columns = (
        Column("section", "text", lambda at: shape.stretches[at[0]].section),
        Column("strand", "text", lambda at: shape.stretches[at[0]].strand),
        Column("end", "text", lambda at: ("start", "end")[at[1]]),
        *_place_columns(a),
        *(Column(name, "force", _tension_getter(state)) for name, state in _motion_states(a).items()),
    )
    rows = tuple((i, end) for i in range(len(shape.stretches)) for end in (0, 1))
    heading = "Tension at both ends of every section in every state of motion"
    return Table("tension_states", "States", heading, columns, rows, printed=False)


def _tension_getter(state: Any) -> Getter:
    return lambda at: float((state.starts, state.ends)[at[1]][at[0]])


def take_up_table(a: CalculatedConveyor, asks: tuple[TakeUpDuty, Message]) -> Table:
    """Take-up of all loads: setting, governing condition, mass or pull, travel."""
    duty, governed_by = asks
    mass, travel = duty.mass, duty.travel
    mean = a.balance.equilibrium.steady.mean(a.line.loop.length)
    winch = duty.unit.kind == "winch"
    screws = 0.5 * duty.unit.strands * duty.setting if duty.unit.kind == "screw" else None
    rows = [
        Figure("setting", "force", duty.setting, "cover"),
        Figure("required setting", "force", duty.needed, key="least_setting"),
        Figure("mean tension of the loop", "force", mean, key="mean_tension"),
        Figure("strands at the take-up", "count", float(duty.unit.strands), key="strands"),
        Figure("mass of a gravity take-up, with pulley and carriage", "mass", mass, key="mass"),
        Figure("pull on the rope of a winch", "force", None if mass is None else mass * a.line.gravity, key="pull"),
        Figure("force of each of two screws", "force", screws),
        Figure("carriage speed through a start", "speed", duty.speed if winch else None),
        Figure("power of the winch", "power",
               None if duty.speed is None or not winch else duty.speed * duty.unit.strands * max(duty.setting, 0.0)),
        Figure("change of mean tension by temperature", "force", duty.mean_change),
    ]  # fmt: skip
    if travel is not None:
        rows += [
            Figure("travel, tensioning the slack belt", "length", travel.tensioning),
            Figure("travel, load", "length", travel.load),
            Figure("travel, starting and stopping", "length", travel.motion),
            Figure("travel, permanent stretch", "length", travel.permanent),
            Figure("travel, temperature of the belt", "length", travel.temperature),
            Figure("travel, reserve", "length", travel.reserve),
            Figure("travel", "length", travel.whole),
            Figure("travel given", "length", duty.unit.travel),
        ]
    note = f"kind: {duty.unit.kind}, governed by: {governed_by.text(a.conveyor.report.units)}{_travel_note(a, duty)}"
    return figure_table("take_up", "Loop", "Take-up", rows, page="tensions", note=note, prefix="take_up_")


def _travel_note(a: CalculatedConveyor, duty: TakeUpDuty) -> str:
    """Note on usual values used for the travel."""
    carcass = a.conveyor.belt.carcass
    if duty.travel is None:
        return "; travel: give belt.carcass.stiffness, nothing usual is known of this carcass"
    usual = []
    if carcass.stiffness is None:
        usual.append("stiffness a multiple of the strength")
    if carcass.permanent_stretch is None:
        usual.append("permanent stretch of its kind")
    return f"; travel: {', '.join(usual)} (general knowledge)" if usual else ""


def take_up_conditions(a: CalculatedConveyor) -> Table:
    """Required take-up setting of every condition, the governing one first."""
    equilibrium = a.balance.equilibrium
    columns = (
        Column("condition", "text", "0"),
        Column("required setting", "force", "1", key="setting_it_asks_for"),
        Column("margin", "force", lambda row: equilibrium.setting - row[1]),
    )
    heading, rows = (
        "Governing take-up conditions",
        sorted(equilibrium.conditions.items(), key=lambda item: -item[1]),
    )
    return Table("tension_conditions", "Loop", heading, columns, tuple(rows), "tensions")


def convergence_table(a: CalculatedConveyor) -> Table:
    """Convergence of tensions and roll loads on the curves; empty without curves."""
    state = a.convergence
    rows = () if state is None else (
        Figure("steps", "count", float(state.steps)),
        Figure("last change over largest tension", "error", state.change),
        Figure("ratio of changes", "ratio", state.ratio),
        Figure("bound over largest tension", "error", state.bound),
    )  # fmt: skip
    heading = "Convergence of tensions and roll loads"
    page = (PagePlacement("belt", f"{heading} on the curves", printed=False),)
    return figure_table("convergence", "Loop", heading, rows, page=page, printed=False)
