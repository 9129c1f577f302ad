"""Criteria of belt scales: where they stand, and the error of their alignment."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, Relation, Verdict, check_against_limit, pass_or_fail
from conveyor.laws.weighing import LEAST_CURVE_DISTANCE, SCALE_CONVEYOR_LENGTHS, alignment_error, weigh_idler_distance
from conveyor.line.line import Line
from conveyor.line.weigh_sections import WeighSection
from conveyor.units.sentences import escape_braces, message, percent

_SOURCE = "Siemens Milltronics MMI, legal for trade"


def belt_scales(result: CalculatedConveyor) -> Iterator[Check]:
    """Belt scales stand where they weigh right; those with an alignment keep their error."""
    for scale in result.line.belt_scales:
        yield from _place_checks(result.line, scale)
        yield from _trade_checks(result.line, scale)
        yield from _alignment_checks(result, scale)


def _place_checks(line: Line, scale: WeighSection) -> Iterator[Check]:
    name = escape_braces(scale.name)
    least = weigh_idler_distance(scale.spacing)
    yield check_against_limit(
        "scale_distance", f"distance of the belt scale, {name}, from skirtboards and head", _nearest_end(line, scale),
        "at least", least, "length", source=_SOURCE,
        why=f'the belt scale in "{name}" is {{calculated}} from skirtboards or head, it needs {{required}}: move it',
    )  # fmt: skip
    if math.isfinite(scale.to_curve):
        yield check_against_limit(
            "scale_curve", f"distance of the belt scale, {name}, from curves", scale.to_curve, "at least",
            LEAST_CURVE_DISTANCE, "length", source=_SOURCE,
            why=f'the belt scale in "{name}" stands {{calculated}} from a curve, it needs {{required}}: move it',
        )  # fmt: skip


def _nearest_end(line: Line, scale: WeighSection) -> float:
    """Distance of the weigh idlers to the nearest skirtboards or to the head [m]; negative between skirtboards."""
    ends = [0.0, *itertools.accumulate(section.length for section in line.sections)]
    gaps = [line.length - scale.end]
    for point in line.loading:
        start = ends[point.section]
        stop = start + point.boards(line.speed, line.gravity)
        gaps.append(start - scale.end if scale.end <= start else scale.start - stop)
    return min(gaps)


def _trade_checks(line: Line, scale: WeighSection) -> Iterator[Check]:
    if not scale.for_trade:
        return
    name, (shortest, longest) = escape_braces(scale.name), SCALE_CONVEYOR_LENGTHS
    limits: tuple[tuple[str, Relation, float], ...] = (
        ("shortest", "at least", shortest), ("longest", "at most", longest),
    )  # fmt: skip
    for key, relation, limit in limits:
        yield check_against_limit(
            f"scale_{key}", f"length of a conveyor with a scale for trade, {name}, {key}", line.length, relation, limit,
            "length", source=_SOURCE,
            why=f'a scale for trade ("{name}") on {{calculated}} of conveyor, {relation} {{required}} are allowed',
        )  # fmt: skip
    gravity = line.take_up.kind == "gravity"
    verdict: Verdict = "not checked" if line.take_up.kind == "slack side" else pass_or_fail(holds=gravity)
    yield Check(
        "scale_take_up", message(f"take-up of a conveyor with a scale for trade, {name}"), None, None, "number",
        message("not given" if verdict == "not checked" else line.take_up.kind), message(f"gravity ({_SOURCE})"),
        verdict, message("a scale for trade asks for a gravity take-up: set route.take_up.kind to gravity")
        if verdict == "FAIL" else None,
    )  # fmt: skip


def _tension_at(result: CalculatedConveyor, scale: WeighSection) -> float:
    """Largest steady tension of the belt on the weigh idlers, linear along their section [N]."""
    line, steady = result.line, result.balance.equilibrium.steady
    length, at = line.sections[scale.section].length, line.count + scale.section
    start = math.fsum(section.length for section in line.sections[: scale.section])
    low, high = float(steady.starts[at]), float(steady.ends[at])
    return max(low + (high - low) * (place - start) / length for place in (scale.start, scale.end))


def _alignment_checks(result: CalculatedConveyor, scale: WeighSection) -> Iterator[Check]:
    line = result.line
    stretch = line.stretches[scale.section]
    if scale.alignment is None or stretch.bulk_mass == 0.0:
        return
    error = alignment_error(
        max(_tension_at(result, scale), 0.0), height=scale.alignment, spacing=scale.spacing,
        n_sets=scale.n_sets, bulk_force=stretch.bulk_mass * line.gravity * math.cos(stretch.inclination),
    )  # fmt: skip
    name = escape_braces(scale.name)
    yield check_against_limit(
        "scale_alignment", f"error of the belt scale by its alignment, {name}", error, "at most", scale.allowed_error,
        "share", wording=message(percent(error, 2)), missing="allowed_error not given",
        asked=None if scale.allowed_error is None else message(f"at most {percent(scale.allowed_error, 2)}"),
        why=f'the belt scale in "{name}" errs by {percent(error, 2)} before its zero is set, more than allowed_error: '
        "align it closer, stand it where the tension is lower, or take more weigh sets",
    )  # fmt: skip
