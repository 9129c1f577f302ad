"""Criteria of pulleys and of the belt on its way to them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.laws.pulley import HUB_SLOPE, SHAFT_SAFETY
from conveyor.laws.transition import HALF_TROUGH
from conveyor.line.bend_pulleys import name_pulley
from conveyor.loop.belt_duty import TransitionCheck
from conveyor.units.sentences import Message, escape_braces, message, percent


def pulley_diameter(result: CalculatedConveyor) -> Iterator[Check]:
    """Every pulley has at least the diameter that the carcass requires."""
    for pulley in result.belt_duty.pulleys:
        size, figures = "", [(pulley.diameter, "thickness"), (pulley.least, "thickness")]
        if pulley.next_size is not None:
            size = ", standard size {}"
            figures.append((pulley.next_size, "thickness"))
        name, group = escape_braces(pulley.name), f"DIN 22101, group {pulley.group}"
        if pulley.utilisation is not None:
            group += f" at {percent(pulley.utilisation)} of the allowed tension"
        words = f'pulley "{name}" is {{}} in diameter, the carcass requires {{}}{size} ({group})'
        yield check_against_limit(
            "pulley_diameter", f"diameter, {name_pulley(name)}", pulley.diameter, "at least", pulley.least, "thickness",
            source=group, why=Message(words, tuple(figures)),
        )  # fmt: skip


def belt_transitions(result: CalculatedConveyor) -> Iterator[Check]:
    """In every transition given no strip of the belt is overstressed or slack."""
    for zone in result.belt_duty.transitions:
        for least, fine, bad in (
            (zone.stretched, "no strip overstressed", "a strip of the belt is overstressed"),
            (zone.slackened, "no strip slack", "a strip of the belt goes slack"),
        ):
            yield _transition_check(zone, least, fine, bad)


def _transition_check(of: TransitionCheck, least: float | None, fine: str, bad: str) -> Check:
    key, subject = "transition_length", message(f"{of.zone.name} transition: {fine}")
    length, missing = of.zone.length, of.missing or "least lengths in its table"
    if length is None or least is None:
        words = message("length not given") if length is None else message("{}", (length, "length"))
        return Check(key, subject, length, None, "length", words, message(missing), "not checked")
    if math.isinf(least):
        why = message(
            f"{of.zone.name} transition: {bad} whatever its length, at a belt tension of {{}} to {{}} per width",
            (of.lowest, "belt rating"),
            (of.highest, "belt rating"),
        )
        asked = message("no length helps")
        return Check(key, subject, length, None, "length", message("{}", (length, "length")), asked, "FAIL", why)
    why = message(
        f"{of.zone.name} transition: {bad} over {{}}; at least {{}} are needed (ISO 5293 taken on to every strip)"
        + (
            f"; or raise the pulley towards half {'trough' if of.by_rule is None else 'the pipe'}"
            if of.zone.pulley_height < HALF_TROUGH
            else ""
        ),
        (length, "length"),
        (least, "length"),
    )
    return check_against_limit(key, subject, length, "at least", least, "length", why=why)


def pulley_shaft(result: CalculatedConveyor) -> Iterator[Check]:
    """Pulley shafts withstand bending and torsion with little slope at the hubs; where their distances are given."""
    for duty in result.pulley_duty:
        if duty.slope is None:
            continue
        name, where = escape_braces(duty.pulley.name), duty.largest.state
        needed = () if duty.least_shaft is None else ((duty.least_shaft, "thickness"),)
        cure = "; {} in the hubs (hub_shaft_diameter) are needed" if needed else ""
        why = message(f'the shaft of pulley "{name}" bends too much at its hubs{cure}', *needed)
        yield check_against_limit(
            "pulley_shaft_slope", f"slope at the hubs, {name_pulley(name)}", duty.slope, "at most", HUB_SLOPE, "number",
            source="CEMA B105.1", wording=message(f"{duty.slope:.4f}"), why=why, where=where,
        )  # fmt: skip
        subject = message(f"safety of the shaft, {name_pulley(name)}")
        asked = message("at least {} (CEMA B105.1)", (SHAFT_SAFETY, "number"))
        if duty.safety is None:
            yield Check(
                "pulley_shaft_safety", subject, None, SHAFT_SAFETY, "safety", message("not known"),
                message("steel of the shaft not given"), "not checked",
            )  # fmt: skip
            continue
        safety, where = duty.safety
        why = message(f'the shaft of pulley "{name}" is too thin for bending and torsion{cure}', *needed)
        yield check_against_limit("pulley_shaft_safety", subject, safety, "at least", SHAFT_SAFETY, "safety",
        asked=asked,
                       why=why, where=where)  # fmt: skip


def pulley_bearings(result: CalculatedConveyor) -> Iterator[Check]:
    """Pulley bearings reach the required life in steady running; where their rating is given."""
    for duty in result.pulley_duty:
        seconds, name = duty.bearing_seconds, escape_braces(duty.pulley.name)
        if seconds is None:
            continue
        yield check_against_limit(
            "pulley_bearings", f"L10 life of a bearing, {name_pulley(name)}", seconds, "at least",
            duty.pulley.bearing_life, "duration", missing="life asked of it (bearing_life) not given",
            why=f'the bearings of pulley "{name}" reach an L10 of {{calculated}}, {{required}} are required',
        )  # fmt: skip


def lagging_pressure(result: CalculatedConveyor) -> Iterator[Check]:
    """Pressure on the lagging is within its limit; where given."""
    for duty in result.pulley_duty:
        allowed, name = duty.pulley.allowed_pressure, escape_braces(duty.pulley.name)
        if allowed is not None:
            yield check_against_limit(
                "lagging_pressure", f"pressure on the lagging, {name_pulley(name)}", duty.pressure, "at most", allowed,
                "pressure", why=f'the belt presses with {{calculated}} on the lagging of pulley "{name}", it bears '
                "{required}; a larger diameter",
            )  # fmt: skip
