"""Criteria of belts that pull bulk out of hoppers."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.laws.feeder import FEEDER_SPEED
from conveyor.units.sentences import escape_braces


def belt_feeder(result: CalculatedConveyor) -> Iterator[Check]:
    """The gate passes the flow, the hopper is in mass flow or its load given, the belt is slow enough."""
    line = result.line
    loaded = [(point, hopper) for point in line.loading if (hopper := point.loaded_hopper) is not None]
    for point, hopper in loaded:
        name = escape_braces(point.name)
        yield check_against_limit(
            "feeder_flow", f"flow under the gate of the hopper{name}", point.flow, "at most", hopper.rated_flow,
            "mass flow", why=f"the gate of the hopper{name} passes {{required}} at this speed, {{calculated}} are "
            "asked: raise the gate, widen the outlet or run faster",
        )  # fmt: skip
        if hopper.mass_flow_angle is not None:
            yield check_against_limit(
                "mass_flow", f"half angle of the hopper{name} for mass flow", hopper.half_angle, "at most",
                hopper.mass_flow_angle, "angle", source="Jenike's chart for plane flow, general knowledge",
                why=f"the walls of the hopper{name} stand at {{calculated}} to the vertical, mass flow ends at "
                "{required}: funnel flow is likely, and the load in flow is more than the one of mass flow taken here, "
                "at most the one after filling; give flow_factor, up to that of filling, or make the hopper steeper or "
                "smoother",
            )  # fmt: skip
    if loaded:
        yield check_against_limit(
            "feeder_speed", "belt speed under a hopper", line.speed, "at most", FEEDER_SPEED.value, "speed",
            source="general knowledge",
            why="the belt runs at {calculated} under the hopper, feeders at {required} or less: bulk slips on it, the "
            "hopper empties from one end and the belt wears; lower belt.speed and raise the gate",
        )  # fmt: skip
