"""Checks of hoppers over a belt with the belt, its sets and the route."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from conveyor.laws.feeder import FEEDER_SPEED
from conveyor.models.base import Problem
from conveyor.models.hoppers import Hopper
from conveyor.models.parts import ConveyorParts
from conveyor.models.route import Feeding, Route
from conveyor.models.validation_messages import Location
from conveyor.units import from_si, si, text

FASTEST_FEEDER: Final = 2.0
"""Belt speed above which a hopper over the belt is refused [m/s], four times that of feeders: general knowledge."""


def located_feeding(route: Route) -> dict[Location, Feeding]:
    """Loading points by their place in the route."""
    points: dict[Location, Feeding] = {} if route.feeding is None else {("feeding",): route.feeding}
    return points | {("further_feeding", i): point for i, point in enumerate(route.further_feeding)}


def hopper_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse what a belt under a hopper cannot be, and outlets without room on it.

    Yields
    ------
    Problem
        Of a hopper, with the reason.
    """
    route, speed = conveyor.route, conveyor.belt.speed
    hoppers = [(at, point, point.hopper) for at, point in located_feeding(route).items() if point.hopper is not None]
    begins = [distance_of_section(route, point.section) for _, point, _ in hoppers]
    for (location, point, hopper), begin in zip(hoppers, begins, strict=True):
        place = ("route", *location, "hopper")
        if si(speed) > FASTEST_FEEDER:
            message = (
                f"given, but the belt runs at {text(speed)} (belt.speed): a feeder runs at "
                f"{FEEDER_SPEED.value:g} m/s or less, above {FASTEST_FEEDER:g} m/s the bulk under the hopper does not "
                "follow it; feed by a feeder of its own"
            )
            yield Problem(place, message)
        if conveyor.idlers.carry.shape.closed:
            message = (
                "given, but the belt closes to a pipe (idlers.carry.pipe), which the full section under a gate does "
                "not allow; feed it by a feeder of its own"
            )
            yield Problem(place, message)
        yield from _curve_problems(route, point, place)
        if si(hopper.outlet_width) > si(point.skirt_width):
            message = (
                f"got {text(hopper.outlet_width)}, wider than the skirts (skirt_width {text(point.skirt_width)}):"
                " skirts widen from the outlet on; correct one of the two"
            )
            yield Problem((*place, "outlet_width"), message)
        yield from _room_problems(route, hopper, begin, [other for other in begins if other > begin], place)
    for i, begin in enumerate(begins):
        if begin in begins[:i]:
            message = "stands where another hopper does: give the section at whose tail end its outlet begins"
            yield Problem(("route", *hoppers[i][0], "section"), message)


def distance_of_section(route: Route, name: str | None) -> float:
    """Distance of a section's tail end from the tail [m]; of the first without a name."""
    before = 0.0
    for section in route.sections:
        if name is None or section.name == name:
            return before
        before += si(section.length)
    return before


def _curve_problems(route: Route, point: Feeding, place: Location) -> Iterator[Problem]:
    section = next((one for one in route.sections if point.section in {None, one.name}), None)
    if section is not None and (section.curve is not None or section.horizontal_curve is not None):
        message = f'given on the curve of section "{section.name}": a feeder is straight under its hopper'
        yield Problem(place, message)


def _room_problems(
    route: Route, hopper: Hopper, begin: float, further: Sequence[float], place: Location
) -> Iterator[Problem]:
    """Refuse an outlet longer than the belt to the head, or to the next hopper."""
    room = min([*further, route.length]) - begin
    if si(hopper.outlet_length) > room:
        unit = text(hopper.outlet_length).split()[1]
        end = "the next hopper" if further else "the head"
        left = text(from_si(float(f"{room:.6g}"), "length", unit))
        message = f"got {text(hopper.outlet_length)}, longer than the {left} of belt to {end}; correct one of the two"
        yield Problem((*place, "outlet_length"), message)
