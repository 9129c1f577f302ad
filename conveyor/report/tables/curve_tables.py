"""Vertical and horizontal curves, and transitions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any, Final, TypeVar

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.loop.horizontal_curve_duty import HorizontalCurveCheck
from conveyor.report.row_getters import extreme_getter
from conveyor.report.table_model import Column, Table
from conveyor.studies.load_cases import Load
from conveyor.units import System

_Row = TypeVar("_Row")
_USUAL_STIFFNESS: Final = (
    "The belt's stiffness is a usual multiple of its strength (general knowledge) or rating (CEMA)."
)


def _worst_of_cases(every: Iterable[Sequence[_Row]], **worst: Callable[[list[Any]], Any]) -> tuple[_Row, ...]:
    """Merge the rows of several cases: as in the first, with the worst known value of the named figures."""
    made = []
    for same in zip(*every, strict=True):
        known = {name: [one for row in same if (one := getattr(row, name)) is not None] for name in worst}
        made.append(replace(same[0], **{name: worst[name](ones) for name, ones in known.items() if ones}))
    return tuple(made)


def _curves_of_cases(loads: Sequence[Load]) -> tuple[HorizontalCurveCheck, ...]:
    """Horizontal curves with the states of all cases."""
    every = [load.found.horizontal for load in loads]
    return _worst_of_cases(
        every, states=lambda each: tuple(chain(*each)), overstress=max, buckling=max, most=max, least=min
    )


def vertical_curves(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Radius of every vertical curve and strand, and the minimum radii of all cases."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("curve", "text", "kind"),
        Column("radius", "length", "radius"),
        Column("lowest tension", "force", "lowest"),
        Column("highest tension", "force", "highest"),
        Column("minimum against lift-off", "length", "lift_off"),
        Column("against lift-off by CEMA", "length", "cema_lift_off", sparse=True),
        Column("minimum against overstress", "length", "overstress"),
        Column("minimum against slack strips", "length", "buckling"),
        Column("against slack strips by CEMA", "length", "cema_buckling", sparse=True),
        Column("highest in a strip", "strength", "most"),
        Column("lowest in a strip", "strength", "least"),
    )
    every = [load.found.belt_duty.curves for load in loads]
    rows = _worst_of_cases(
        every, lowest=min, highest=max, lift_off=max, overstress=max, buckling=max, most=max, least=min,
        cema_lift_off=max, cema_buckling=max,
    )  # fmt: skip
    notes = ["By CEMA: 1.11 T over the belt's weight, not checked."] if any(row.cema_lift_off for row in rows) else []
    if any(row.cema_buckling for row in rows):
        notes.append("By CEMA: the middle of a convex curve keeps 30 lbf/in (5.25 N/mm), not checked.")
    notes += [_USUAL_STIFFNESS] if rows and a.line.belt.stiffness is None else []
    if rows and a.line.wind_speed is not None:
        notes.append("Against lift-off: with the wind of ambient.wind_speed under the empty belt.")
    heading = "Vertical curves, all cases"
    return Table("vertical_curves", "Curves", heading, columns, rows, "belt", " ".join(notes))


def horizontal_curves(loads: Sequence[Load]) -> Table:
    """Drift and radius limits of every horizontal curve and strand over all cases."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("to the", "text", "turn.side"),
        Column("radius", "length", "radius"),
        Column("banking", "angle", "turn.banking"),
        Column("skew", "angle", "turn.skew"),
        Column("drift, steady", "size", "turn.drift"),
        Column("farthest inside", "size", "farthest_in.inside"),
        Column("farthest outside", "size", "farthest_out.outside"),
        Column("room on the rolls", "size", "turn.room"),
        Column("minimum against drift", "length", extreme_getter(max, "states", "least")),
        Column("maximum against drift", "length", extreme_getter(min, "states", "most")),
    )
    note = (
        "Drift is positive to the inside; steady as given. Inside: highest tension, 70 % of the guiding friction; "
        "outside: lowest tension, all of it; the wind of ambient.wind_speed either way on a strand without bulk. Of a "
        "flat set: at the end of the curve, with the worse of both. ∞: the belt runs off its rolls, or no radius is "
        "too large."
    )
    heading = "Horizontal curves, all cases"
    return Table("horizontal_curves", "Curves", heading, columns, _curves_of_cases(loads), "belt", note)


def pipe_curves(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Radius of every curve of a pipe and strand, the minimum radii and the force on a panel of all cases."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("curve", "text", "kind"),
        Column("radius", "length", "radius"),
        Column("angle", "angle", "angle"),
        Column("lowest tension", "force", "lowest"),
        Column("highest tension", "force", "highest"),
        Column("largest pull on a panel", "force", "push"),
        Column("minimum by rule of thumb", "length", "by_rule"),
        Column("minimum against overstress", "length", "overstress"),
        Column("minimum against slack strips", "length", "buckling"),
        Column("highest in a strip", "strength", "most"),
        Column("lowest in a strip", "strength", "least"),
    )
    every = [load.found.pipe_curves for load in loads]
    rows = _worst_of_cases(every, lowest=min, highest=max, push=max, overstress=max, buckling=max, most=max, least=min)
    note = (
        "Rule of thumb: conveyorbeltguide.com/pipe-belts.html. Strips: plane sections of a round pipe, the carcass at "
        "its distance from the middle; told, not judged: the rule governs. Vertical and horizontal in one section: the "
        "radius of both together. Twist of the pipe and of its overlap in the curve is not calculated."
    )
    if rows and a.line.belt.stiffness is None:
        note += f" {_USUAL_STIFFNESS}"
    return Table("pipe_curves", "Curves", "Curves of the pipe, all cases", columns, rows, "belt", note)


def curve_edges(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Edge tensions of horizontal curves; no rows where stiffness or strength are not known."""
    columns = (
        Column("section", "text", "section"),
        Column("strand", "text", "strand"),
        Column("radius", "length", "radius"),
        Column("minimum against overstress", "length", "overstress"),
        Column("minimum against a slack edge", "length", "buckling"),
        Column("highest at the outer edge", "strength", "most"),
        Column("lowest at the inner edge", "strength", "least"),
    )
    rows = tuple(curve for curve in _curves_of_cases(loads) if curve.most is not None)
    note = _USUAL_STIFFNESS if rows and a.line.belt.stiffness is None else ""
    heading = "Edges of the belt in horizontal curves, all cases"
    return Table("curve_edges", "Curves", heading, columns, rows, "belt", note)


def drift_states(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Tensions, drift and radius limits of horizontal curves in every case and state."""
    system = a.conveyor.report.units
    rows = tuple(
        (bend, load.label.text(system), state)
        for load in loads
        for bend in load.found.horizontal
        for state in bend.states
    )
    columns = (
        Column("section", "text", "0.section"),
        Column("strand", "text", "0.strand"),
        Column("case", "text", "1"),
        Column("state", "text", "2.state"),
        Column("lowest tension", "force", "2.lowest"),
        Column("highest tension", "force", "2.highest"),
        Column("farthest inside", "size", "2.inside"),
        Column("farthest outside", "size", "2.outside"),
        Column("minimum against drift", "length", "2.least"),
        Column("maximum against drift", "length", "2.most"),
    )
    heading = "Drift in horizontal curves in every case and state"
    return Table("drift_states", "States", heading, columns, rows, printed=False)


def transition_table(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Transition lengths, their minimum lengths and strip tensions over all cases."""
    columns = (
        Column("end", "text", "zone.name"),
        Column("pulley over depth of trough", "share", "zone.pulley_height"),
        Column("length", "spacing", "zone.length"),
        Column("minimum against overstress", "spacing", "stretched"),
        Column("minimum against slack strips", "spacing", "slackened"),
        Column("minimum by CEMA", "spacing", "cema", sparse=True),
        Column("minimum by rule of thumb", "spacing", "by_rule", sparse=True),
        Column("lowest tension per width", "strength", "lowest"),
        Column("highest tension per width", "strength", "highest"),
        Column("highest in a strip", "strength", "most"),
        Column("allowed in a strip", "strength", "allowed"),
        Column("lowest in a strip", "strength", "least"),
    )
    heading = "Transitions between the sets and the pulley, all cases"
    note = (
        "Strips of straight way, ISO 5293 taken on to every strip and a raised pulley; at most 130 % of the rated "
        "tension (or strength over the classic safety), none slack. Carry strand, of a pipe both, every state of "
        "motion."
    )
    if a.line.transitions and a.line.belt.stiffness is None:
        note += f" {_USUAL_STIFFNESS}"
    note += "".join(f" Not known: {missing}." for missing in {row.missing for row in a.belt_duty.transitions} - {""})
    every = [load.found.belt_duty.transitions for load in loads]
    rows = _worst_of_cases(every, lowest=min, highest=max, stretched=max, slackened=max, most=max, least=min, cema=max)
    if any(row.cema is not None for row in rows):
        note += " By CEMA: its table over trough and share of the rated tension, not checked."
    if any(row.by_rule is not None for row in rows):
        note += " Of a pipe: 55 D, conveyorbeltguide.com/pipe-belts.html, rule of thumb, not checked."
    return Table("transitions", "Curves", heading, columns, rows, "belt", note)


def drifts_by_case(loads: Sequence[Load], system: System) -> list[tuple[str, tuple[HorizontalCurveCheck, ...]]]:
    """Horizontal curves of every case, with its name."""
    return [(load.label.text(system).removeprefix("load state "), load.found.horizontal) for load in loads]
