"""Criteria of vertical and horizontal curves, and of wind."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.laws.pipe_geometry import PIPE_RADIUS
from conveyor.laws.wind import AIR_DENSITY, WIND_LIFT, lifting_speed
from conveyor.line.stretches import STRANDS
from conveyor.loop.belt_duty import CurveCheck
from conveyor.loop.horizontal_curve_duty import DriftState, HorizontalCurveCheck
from conveyor.units.sentences import Message, escape_braces, message

_PIPE_RULE: Final = f"{PIPE_RADIUS['textile']:g} D textile, {PIPE_RADIUS['steel cord']:g} D steel cord, rule of thumb"


def curve_radius(result: CalculatedConveyor) -> Iterator[Check]:
    """On every vertical curve the belt stays down, its strips neither overstressed nor slack."""
    for curve in result.belt_duty.curves:
        for least, fine, bad in (
            (curve.lift_off, "empty belt stays down", "the empty belt lifts off"),
            (curve.overstress, "no strip overstressed", "a strip of the belt is overstressed"),
            (curve.buckling, "no strip slack", "a strip of the belt goes slack"),
        ):
            if least is not None:
                yield _curve_radius_check(curve, least, fine, bad)


def _curve_radius_check(curve: CurveCheck | HorizontalCurveCheck, least: float, fine: str, bad: str) -> Check:
    section = escape_braces(curve.section)
    words = f'section "{section}", {curve.strand}: {bad} on the {curve.kind} curve of {{}}; '
    helps = math.isfinite(least)
    why = message(words + "at least {} are needed", (curve.radius, "length"), (least, "length"))
    made = check_against_limit(
        "curve_radius", f"{curve.kind} curve, {section}, {curve.strand}: {fine}", curve.radius, "at least",
        least if helps else None, "length", missing="no radius helps",
        why=why if helps else message(words + "no radius helps", (curve.radius, "length")),
    )  # fmt: skip
    return (
        made
        if helps
        else replace(made, verdict="FAIL", why=message(words + "no radius helps", (curve.radius, "length")))
    )


def wind_lift(result: CalculatedConveyor) -> Iterator[Check]:
    """The wind given does not lift a strand without bulk."""
    line = result.line
    if line.wind_speed is None:
        return
    for strand in STRANDS:
        bare = [one for one in line.stretches if one.strand == strand and one.bulk_mass == 0.0]
        if not bare:
            continue
        steepest = max(bare, key=lambda one: abs(one.inclination))
        least = lifting_speed(
            steepest.belt_mass,
            width=line.belt.width,
            lift=WIND_LIFT.value,
            inclination=steepest.inclination,
            gravity=line.gravity,
            air_density=AIR_DENSITY,
        )
        yield check_against_limit(
            "wind_lift", f"empty belt stays down in the wind, {strand}", line.wind_speed, "at most", least, "wind",
            source=f"lift coefficient {WIND_LIFT.value:g}, general knowledge",
            why=f"{strand}: a gust of {{calculated}} lifts the empty belt, {{required}} does not (lift coefficient "
            f"{WIND_LIFT.value:g}, general knowledge): hoods, hold-down rolls or a heavier belt",
        )  # fmt: skip


def pipe_curves(result: CalculatedConveyor) -> Iterator[Check]:
    """In every curve of a pipe the radius is that of the rule of thumb.

    Its strips are a remark: makers bend pipes by their diameter alone, whatever plane sections give.
    """
    for curve in result.pipe_curves:
        section = escape_braces(curve.section)
        yield check_against_limit(
            "pipe_radius", f"{curve.kind} curve of the pipe, {section}, {curve.strand}", curve.radius, "at least",
            curve.by_rule, "length", source=_PIPE_RULE,
            why=f'section "{section}", {curve.strand}: a radius of {{calculated}}, makers bend such pipes to '
            f"{{required}} or more ({_PIPE_RULE}): a wider curve, a smaller pipe, or ask the belt's maker",
        )  # fmt: skip


def horizontal_edges(result: CalculatedConveyor) -> Iterator[Check]:
    """In every horizontal curve the outer edge of the belt is not overstressed, the inner one not slack."""
    for bend in result.horizontal:
        for least, fine, bad in (
            (bend.overstress, "outer edge not overstressed", "the outer edge of the belt is overstressed"),
            (bend.buckling, "inner edge not slack", "the inner edge of the belt goes slack"),
        ):
            if least is not None:
                yield _curve_radius_check(bend, least, fine, bad)


def belt_drift(result: CalculatedConveyor) -> Iterator[Check]:
    """In every horizontal curve and state of motion the belt's edges stay on their rolls, with the wind given."""
    for bend in result.horizontal:
        inside, outside = bend.farthest_in, bend.farthest_out
        cure = message("at least a radius of {} is needed, or more banking", (inside.least, "length"))
        if math.isinf(inside.least):
            cure = message("no radius helps: more banking, a deeper trough or a hood")
        yield _drift_check(bend, inside, "inside", inside.inside, cure)
        less = "a deeper trough, a hood, less banking or skew" if bend.turn.wind else "less banking or skew"
        cure = message(less)
        if 0.0 < outside.most < math.inf:
            cure = message(less + ", or a radius of at most {}", (outside.most, "length"))
        yield _drift_check(bend, outside, "outside", -outside.outside, cure)


def _drift_check(bend: HorizontalCurveCheck, state: DriftState, way: str, drift: float, cure: Message) -> Check:
    room, section = bend.turn.room, escape_braces(bend.section)
    off = math.isinf(drift)
    how = message("runs off its rolls" if off else "drifts by {}", *(() if off else ((drift, "thickness"),)))
    why = Message(
        f'section "{section}", {bend.strand}: the belt {how.words} to the {way} of the horizontal curve in the state '
        f'"{escape_braces(state.state)}", {{}} are left on its rolls; {cure.words}',
        (*how.figures, (room, "thickness"), *cure.figures),
    )
    made = check_against_limit(
        "belt_drift", f"drift to the {way}, {section}, {bend.strand}", drift, "at most", room, "thickness",
        source="end of the roll", wording=how if off else None, why=why, where=state.state,
    )  # fmt: skip
    return replace(made, calculated=None) if off else made
