"""A conveyor that runs the other way: the same parts, met in the other order."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final, TypeVar

from conveyor.errors import InputError
from conveyor.models.base import Problem
from conveyor.models.drive import Drive, DrivePulley
from conveyor.models.loop_parts import Pulley, TakeUp
from conveyor.models.parts import ConveyorParts
from conveyor.models.route import Feeding, Route, Section
from conveyor.models.validation_messages import Location
from conveyor.units import si, text

Parts = TypeVar("Parts", bound=ConveyorParts)
_OTHER_END: Final = {"head": "tail", "tail": "head", "left": "right", "right": "left"}


def reversal_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse what works in one direction only."""
    yield from _feeding_problems(conveyor.route)
    yield from _steering_problems(conveyor)
    yield from _drive_problems(conveyor.drive)
    take_up = conveyor.route.take_up
    if take_up is None or take_up.position == "drive":
        message = "the slack side of the drives changes with the direction; say where the take-up stands"
        yield Problem(("route", "take_up", "position"), message)
    if conveyor.route.ploughs:
        yield Problem(("route", "ploughs"), "a plough sweeps in one direction only")


def _feeding_problems(route: Route) -> Iterator[Problem]:
    """Refuse loading points at the tail, trippers, hoppers and bulk that lands with a speed."""
    places: list[tuple[Location, Feeding | None]] = [(("route", "feeding"), route.feeding)]
    places += [(("route", "further_feeding", i), point) for i, point in enumerate(route.further_feeding)]
    for place, point in places:
        if point is None or point.section in {None, route.sections[0].name}:
            message = "at the tail the bulk would leave a reversed belt where it lands; give the section it lands on"
            yield Problem((*place, "section"), message)
        elif route.feeds_back(point):
            yield Problem((*place, "tripper_lift"), "a tripper lifts the bulk of one direction only")
        elif point.hopper is not None:
            message = "the gate of a hopper stands at one end of its outlet: a reversed belt pulls against its wall"
            yield Problem((*place, "hopper"), message)
        elif si(point.speed) > 0.0:
            message = f"got {text(point.speed)} in one direction; on a belt that reverses the bulk lands at 0 m/s"
            yield Problem((*place, "speed"), message)


def _steering_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse rolls that steer the belt in one direction."""
    for i, section in enumerate(conveyor.route.sections):
        for name, angle in (("carry_skew", section.carry_skew), ("return_skew", section.return_skew)):
            if angle is not None and si(angle) > 0.0:
                message = f"got {text(angle)}: sets turned in plan steer a reversed belt the wrong way"
                yield Problem(("route", "sections", i, name), message)
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        if si(idlers.tilt_angle) > 0.0:
            message = f"got {text(idlers.tilt_angle)}: tilted rolls guide a belt that runs one way only"
            yield Problem(("idlers", strand, "tilt_angle"), message)


def _drive_problems(drive: Drive) -> Iterator[Problem]:
    """Refuse backstops, and a further drive at the place of the first."""
    places: list[Location] = [("drive",), *(("drive", "further_drives", i) for i in range(len(drive.further_drives)))]
    for place, pulley in zip(places, drive.pulleys, strict=True):
        if pulley.backstop or pulley.backstop_torque is not None:
            name = "backstop" if pulley.backstop else "backstop_torque"
            yield Problem((*place, name), "a backstop holds a belt that runs one way only; give a brake")
        if pulley is not drive and (pulley.position, pulley.section) == (drive.position, drive.section):
            message = "a reversed belt meets it before the first drive at its place; give both as one drive"
            yield Problem((*place, "position"), message)


def with_direction_reversed(conveyor: Parts) -> Parts:
    """Conveyor whose carry strand runs from the head of the spec to its tail.

    Sections are met from the other end, with their lifts and horizontal curves the other way; feeding points, drives,
    pulleys, take-up and transitions stay where they stand. Cleaners are at the end that discharges; the trajectory and
    belt scales belong to the direction of the spec and are left out.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.

    Raises
    ------
    InputError
        A part works in one direction only; every refusal on its own line.
    """
    problems = [f"{'.'.join(map(str, one.location))}: {one.message}" for one in reversal_problems(conveyor)]
    if problems:
        raise InputError("the conveyor cannot be reversed\n" + "\n".join(problems))
    drive, route = conveyor.drive, conveyor.route
    further = [one.replace(**_mirrored_place(one, route)) for one in reversed(drive.further_drives)]
    return conveyor.replace(
        route=_reversed_route(route),
        drive=drive.replace(further_drives=further, **_mirrored_place(drive, route)),
    )


def _reversed_route(route: Route) -> Route:
    points = [point.replace(section=_section_before(route, point.section)) for point in reversed(route.feeding_points)]
    fed = {"feeding": points[0], "further_feeding": points[1:]} if points else {}
    take_up = route.take_up
    return route.replace(
        sections=[_reversed_section(section) for section in reversed(route.sections)],
        take_up=None if take_up is None else take_up.replace(**_mirrored_place(take_up, route)),
        pulleys=[one.replace(**_mirrored_place(one, route)) for one in reversed(route.pulleys)],
        head_transition=route.tail_transition,
        tail_transition=route.head_transition,
        discharge=None,
        belt_scales=[],
        **fed,
    )


def _reversed_section(section: Section) -> Section:
    changes: dict[str, Any] = {}
    if section.lift is not None:
        changes["lift"] = -section.lift
    if section.slope is not None:
        changes["slope"] = -section.slope
    if section.horizontal_curve is not None:
        changes["horizontal_curve"] = _OTHER_END[section.horizontal_curve]
    return section.replace(**changes) if changes else section


def _mirrored_place(part: DrivePulley | Pulley | TakeUp, route: Route) -> dict[str, str | None]:
    """Position and section of a part that stays where it stands; behind a section of its strand as that runs now."""
    if part.section is None:
        return {"position": _OTHER_END.get(part.position, part.position)}
    names = [section.name for section in route.sections]
    k = names.index(part.section) + (1 if part.position == "carry" else -1)
    if 0 <= k < len(names):
        return {"section": names[k]}
    return {"position": "tail" if part.position == "carry" else "head", "section": None}


def _section_before(route: Route, name: str | None) -> str:
    names = [section.name for section in route.sections]
    return names[names.index(name) - 1]  # type: ignore[arg-type]  # refused before: a point at the tail
