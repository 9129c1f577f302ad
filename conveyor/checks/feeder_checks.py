"""Criteria of belts that pull bulk out of hoppers."""

from __future__ import annotations

import math
from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.classical_forces import initial_pull
from conveyor.laws.belt_strength import RATED_START
from conveyor.laws.feeder import FEEDER_SPEED
from conveyor.laws.tension import grip_tension
from conveyor.loop.equilibrium import tension_suffices
from conveyor.units.sentences import escape_braces


def belt_feeder(result: CalculatedConveyor) -> Iterator[Check]:
    """The gate passes the flow, the belt is slow enough to pull it out and does not slip after the hopper is filled."""
    line = result.line
    loaded = [(point, hopper) for point in line.loading if (hopper := point.loaded_hopper) is not None]
    for point, hopper in loaded:
        name = escape_braces(point.name)
        yield check_against_limit(
            "feeder_flow", f"flow under the gate of the hopper{name}", point.flow, "at most", hopper.rated_flow,
            "mass flow", why=f"the gate of the hopper{name} passes {{required}} at this speed, {{calculated}} are "
            "asked: raise the gate, widen the outlet or run faster",
        )  # fmt: skip
    if loaded:
        yield check_against_limit(
            "feeder_speed", "belt speed under a hopper", line.speed, "at most", FEEDER_SPEED.value, "speed",
            source="general knowledge",
            why="the belt runs at {calculated} under the hopper, feeders at {required} or less: bulk slips on it, the "
            "hopper empties from one end and the belt wears; lower belt.speed and raise the gate",
        )  # fmt: skip
        yield from _grip_checks(result, math.fsum(initial_pull(line, point) for point, _ in loaded))


def _grip_checks(result: CalculatedConveyor, more: float) -> Iterator[Check]:
    """No drive slips while it breaks the bulk away under a filled hopper, at the slack-side tension of running."""
    line, settled = result.line, result.balance.settled
    for drive, side in zip(line.drives, settled.steady.drives, strict=True):
        force = side.force + drive.share * line.design_friction * more
        needed = grip_tension(force, friction=drive.friction, wrap_angle=drive.wrap_angle)
        name = escape_braces(drive.name)
        yield check_against_limit(
            "feeder_grip", f"grip of {name}, hopper filled", side.slack, "at least", needed, "force",
            holds=tension_suffices(side.slack, needed),
            why=f'the belt slips on "{name}" when it starts under the filled hopper: {{calculated}} on its slack side, '
            "{required} are needed; raise the take-up's tension, the wrap or the friction (lagging)",
        )  # fmt: skip
        rating = result.belt_duty.rating
        if rating is not None:
            yield check_against_limit(
                "feeder_tension", f"belt tension per width at {name}, hopper filled",
                (side.slack + force) / line.belt.width, "at most", RATED_START * rating, "belt rating",
                source=f"{RATED_START:g} times the rated tension",
                why="the belt bears {calculated} when it starts under the filled hopper, {required} are allowed",
            )  # fmt: skip
