"""Criteria of belts that pull bulk out of hoppers."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.laws.belt_strength import CLASSIC_SAFETY, RATED_START, belt_safety
from conveyor.laws.feeder import FEEDER_SPEED
from conveyor.laws.tension import grip_tension
from conveyor.loop.equilibrium import tension_suffices
from conveyor.loop.tensions import MotionState
from conveyor.units.sentences import escape_braces, message


def belt_feeder(result: CalculatedConveyor) -> Iterator[Check]:
    """The gate passes the flow, the belt is slow enough to pull it out; after filling it holds and does not slip."""
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
    if (filled := result.balance.equilibrium.filled) is not None:
        yield from _filled_checks(result, filled)


def _filled_checks(result: CalculatedConveyor, filled: MotionState) -> Iterator[Check]:
    """No drive slips and the belt is strong enough while it breaks the bulk away under a filled hopper."""
    line, belt, setting = result.line, result.line.belt, result.balance.equilibrium.setting
    for drive, side in zip(line.drives, filled.drives, strict=True):
        needed = grip_tension(side.force, friction=drive.friction, wrap_angle=drive.wrap_angle)
        name = escape_braces(drive.name)
        yield check_against_limit(
            "feeder_grip", f"grip of {name}, hopper filled", side.slack, "at least", needed, "force",
            holds=tension_suffices(side.slack, needed),
            why=message(
                f'the belt slips on "{name}" when it starts under the filled hopper: {{}} on its slack side, {{}} are '
                "needed; raise the take-up's tension from {} to about {}, the wrap or the friction (lagging)",
                *((each, "force") for each in (side.slack, needed, setting, setting + needed - side.slack)),
            ),
        )  # fmt: skip
    rating = result.belt_duty.rating
    if rating is not None:
        yield check_against_limit(
            "feeder_tension", "belt tension per width, hopper filled", filled.largest / belt.width, "at most",
            RATED_START * rating, "belt rating", source=f"{RATED_START:g} times the rated tension",
            why="the belt bears {calculated} when it starts under the filled hopper, {required} are allowed",
        )  # fmt: skip
    if belt.strength is not None:
        yield check_against_limit(
            "feeder_safety", "belt safety factor, hopper filled",
            belt_safety(filled.largest, nominal_strength=belt.strength, belt_width=belt.width), "at least",
            CLASSIC_SAFETY["steel cord" if belt.steel_cord else "textile"] / RATED_START, "safety",
            source=f"DIN 22101:1982 over {RATED_START:g} at the start",
            why="the safety of the belt is {calculated} when it starts under the filled hopper, {required} are needed",
        )  # fmt: skip
