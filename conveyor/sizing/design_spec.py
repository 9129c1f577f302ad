"""The spec of a design, as a user would write it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

from conveyor.laws.preliminary_sizing import PULLEY_MASS
from conveyor.laws.pulley import Steel
from conveyor.line.usual_parts import SHAFT_DIAMETER_RATIO, TAKE_UP_WRAPS
from conveyor.models import Conveyor
from conveyor.models.base import given_data
from conveyor.models.maker_lists import ListedItem
from conveyor.models.sizing import DriveLayout
from conveyor.sizing.design_choice import CarcassClass, DesignChoice, RollSize, SelectedParts, WidthSize
from conveyor.sizing.listed_sizes import listed_belt, listed_motor, named_item
from conveyor.sizing.loading_zones import divide_loading_sections
from conveyor.sizing.sizing_task import SizingTask
from conveyor.units import from_si, text

_BEARING_INSET: Final = 0.02  # [m], middle of a bearing inside the tube's end; general knowledge


SECOND_DRIVE_PULLEY: Final = "head 2"
"""Name of the second driven pulley at the head."""
SHAFT_STEEL: Final[Steel] = "C1045"
"""C45, the usual steel of pulley shafts; general knowledge."""


_UNIT_KINDS: Final = {"m": "length", "mm": "thickness", "m/s": "speed", "deg": "angle", "kW": "power",
"N/mm": "line force",
                 "PIW": "line force", "kN": "force", "kN*m": "torque", "kg": "mass", "kg/m^2": "area mass"}  # fmt: skip


_US_UNITS: Final = {
    "m": "ft",
    "mm": "in",
    "m/s": "fpm",
    "kW": "hp",
    "kN": "lbf",
    "kN*m": "lbf*ft",
    "kg": "lb",
    "kg/m^2": "lb/ft^2",
}
"""ST classes keep N/mm in the US."""


def design_spec(task: SizingTask, choice: DesignChoice, chosen: SelectedParts, name: str) -> Conveyor:
    """The complete spec of a candidate.

    Raises
    ------
    InputError
        The spec is invalid: the duty does not fit the choice.
    """
    choice = built_choice(task, choice, chosen)
    duty, carcass, written = task.duty, chosen.carcass, partial(_field_text, task)
    route = given_data(duty.sized_route)
    for section, spacing in zip(route["sections"], choice.graduated, strict=bool(choice.graduated)):
        section["carry_spacing"] = written(spacing, "m")
    route = divide_loading_sections(task, choice, route, written)
    route["pulleys"] = _all_pulleys(task, choice, chosen)
    tension = {"tension": written(chosen.take_up, "kN")} if chosen.take_up > 0.0 else {}
    route["take_up"] = {"kind": "gravity", **_take_up_position(chosen, route["sections"][0]["name"]), **tension}
    covers = duty.covers
    return Conveyor.from_data({
        "name": name,
        **task.kept_fields,
        "belt": {
            "width": written(choice.trough.width.belt, "mm"),
            "speed": written(choice.speed, "m/s"),
            "top_cover": {"thickness": written(chosen.top, "mm"), "compound": covers[0]},
            "bottom_cover": {"thickness": written(chosen.bottom, "mm"), "compound": covers[choice.cover]},
            **_belt_fields(task, carcass),
            "wear": {
                "lump": written(task.lump, "mm"), "abrasiveness": duty.abrasiveness, "loading": duty.loading
            },
        },
        "idlers": _idler_fields(task, choice),
        "route": route,
        "drive": _drive_fields(task, choice, chosen),
        **({"cases": task.cases} if task.cold else {}),
    })  # fmt: skip


def _take_up_position(chosen: SelectedParts, first: str) -> dict[str, str]:
    """Spec fields of the take-up's place; the tail end of the return strand is behind the first section."""
    if chosen.take_up_place == "tail end":
        return {"position": "return", "section": first}
    return {"position": "head" if chosen.take_up_place == "head end" else "drive"}


def built_choice(task: SizingTask, choice: DesignChoice, chosen: SelectedParts) -> DesignChoice:
    """The choice at the belt speed that its gearboxes give."""
    if chosen.listed is None or chosen.listed.gearbox is None:
        return choice
    speed = chosen.listed.speed
    return replace(choice, speed=speed, filling=task.filled(choice.trough, speed))


def drive_diameter(task: SizingTask, chosen: SelectedParts) -> float:
    """Diameter of the drive pulleys [m]."""
    return series_drive_diameter(task, chosen) if chosen.listed is None else chosen.listed.drive_diameter


def series_drive_diameter(task: SizingTask, chosen: SelectedParts) -> float:
    """Diameter of the drive pulleys of the series [m], with room for the shafts of head and tail."""
    bends = len(TAKE_UP_WRAPS)
    ends = chosen.shafts[: -bends - 1] + chosen.shafts[-1:]
    return max([task.pulleys.drive_diameter(chosen.carcass), *map(task.pulleys.pulley_around, ends)])


def _field_text(task: SizingTask, value: float, unit: str, digits: int = 6) -> str:
    """Value and unit as spec text, in the unit of the series."""
    own = _US_UNITS.get(unit, unit) if task.duty.series == "US" else unit
    return f"{float(from_si(value, _UNIT_KINDS[unit], own).magnitude):.{digits}g} {own}"


def _belt_fields(task: SizingTask, carcass: CarcassClass) -> dict[str, Any]:
    """Spec fields of a carcass, or of the belt of a maker's list."""
    if carcass.listed:
        return {"listed": listed_belt(named_item(task.duty.listed.items("belts"), carcass.listed), carcass)}
    strength = (
        {"strength": _field_text(task, carcass.strength, "N/mm")}
        if carcass.rating is None
        else {"rating": _field_text(task, carcass.rating, "PIW")}
    )
    thickness, mass = _field_text(task, carcass.thickness, "mm"), _field_text(task, carcass.mass, "kg/m^2", 3)
    return {"carcass": {"kind": carcass.kind, **strength, "thickness": thickness, "mass": mass}}


def _all_pulleys(task: SizingTask, choice: DesignChoice, chosen: SelectedParts) -> list[dict[str, Any]]:
    """Pulleys of head, take-up with its bends, and tail, of the lists or the series."""
    if chosen.listed is not None and chosen.listed.pulleys:
        items = {one.place: one.item for one in chosen.listed.pulleys}
        return [
            {**placed, "listed": items[place]}
            | ({"bearing_life": text(task.rules.roll_life)} if "bearing_rating" in items[place].fields else {})
            for place, placed in _pulley_places(choice.drives)
        ]
    driven, bend = drive_diameter(task, chosen), task.pulleys.bend_diameter(chosen.carcass)
    sizes = {"head": driven, "take-up": bend, "tail": driven if "tail" in choice.drives else bend}
    places = _pulley_places(choice.drives)
    width, shafts = choice.trough.width, chosen.shafts or (None,) * len(places)
    return [
        placed | _pulley_fields(task, sizes[place], width, shaft)
        for (place, placed), shaft in zip(places, shafts, strict=True)
    ]


def _pulley_places(drives: DriveLayout) -> list[tuple[str, dict[str, str]]]:
    """Place, and name, position and wrap, of every pulley: the take-up hangs in the belt's loop between two bends."""
    wraps = [(name, "take-up", wrap) for name, wrap in TAKE_UP_WRAPS.items()]
    second = [(SECOND_DRIVE_PULLEY, "head", None)] if has_second_pulley(drives) else []
    return [
        (place, {"name": name, "position": place} | ({} if wrap is None else {"wrap_angle": wrap}))
        for name, place, wrap in (("head", "head", None), *second, *wraps, ("tail", "tail", None))
    ]


def has_second_pulley(drives: DriveLayout) -> bool:
    """True if two pulleys drive at the head."""
    return "two pulleys" in drives


def _pulley_fields(task: SizingTask, diameter: float, width: WidthSize, shaft: float | None) -> dict[str, Any]:
    """Spec fields of a pulley; without its shaft a usual one, whose hubs and bearings have no place yet."""
    diameter = diameter if shaft is None else max(diameter, task.pulleys.pulley_around(shaft))
    bearings, hubs = task.pulleys.shaft_distances(width)
    placed = {
        "bearing_centres": _field_text(task, bearings, "mm"),
        "hub_centres": _field_text(task, hubs, "mm"),
        "shaft_steel": SHAFT_STEEL,
    }
    return {
        "diameter": _field_text(task, diameter, "mm"),
        "shaft_diameter": _field_text(task, SHAFT_DIAMETER_RATIO * diameter if shaft is None else shaft, "mm"),
        "mass": _field_text(task, PULLEY_MASS * diameter**2 * width.belt, "kg", 3),
        **({} if shaft is None else placed),
    }


def _idler_fields(task: SizingTask, choice: DesignChoice) -> dict[str, Any]:
    carry_sag, return_sag = task.sags
    count, length, angle = choice.trough.width.return_rolls
    rated = {} if choice.roll.cema_class is None else {"cema_class": choice.roll.cema_class}
    return {
        "carry": {
            "rolls": 3,
            "spacing": _field_text(task, choice.carry, "m"),
            "trough_angle": _field_text(task, choice.trough.angle, "deg"),
            "roll": _roll_fields(task, choice.roll, choice.trough.width.three),
            "sag": f"{100.0 * carry_sag:.6g} %",
            **rated,
        },
        "return": {
            "rolls": count,
            "spacing": _field_text(task, choice.back, "m"),
            "trough_angle": _field_text(task, angle, "deg"),
            "roll": _roll_fields(task, choice.roll, length),
            "sag": f"{100.0 * return_sag:.6g} %",
            **rated,
        },
    }


def _drive_fields(task: SizingTask, choice: DesignChoice, chosen: SelectedParts) -> dict[str, Any]:
    rules, motors = task.rules, chosen.motors
    one = {"wrap_angle": _field_text(task, task.grip[1], "deg"), "friction": rules.friction}
    listed, holding, held = chosen.listed, dict[str, str](), list[ListedItem]()
    for part, field, value, unit in (
        (None if listed is None else listed.backstop, "backstop_torque", chosen.backstop, "kN*m"),
        (None if listed is None else listed.brake, "brake_force", chosen.brake, "kN"),
    ):
        if part is not None:
            held.append(part.item)
        elif value > 0.0:
            holding[field] = _field_text(task, value, unit, 4)
    train = listed is not None and listed.gearbox is not None
    rated = listed is not None and (listed.gearbox is not None or listed.coupling is not None)
    first = {
        **one,
        **holding,
        "position": "tail" if choice.drives == "tail" else "head",
        **_motor_fields(task, choice, chosen, 0, held),
        **({} if train else {"efficiency": f"{100.0 * task.efficiency:.6g} %"}),
        **({"service_factor": rules.service_factor} if rated else {}),
        "start_factor": rules.start_factor,
        **({} if rules.design_friction is None else {"design_friction": rules.design_friction}),
    }
    further = []
    for number in range(2, len(motors) + 1):
        tail = "tail" in choice.drives and number == len(motors)
        place = {"name": f"drive {number}", "position": "tail" if tail else "head"}
        further.append({**one, **place, **_motor_fields(task, choice, chosen, number - 1)})
    return {**first, "further_drives": further} if further else first


def _motor_fields(
    task: SizingTask, choice: DesignChoice, chosen: SelectedParts, drive: int, further: Sequence[ListedItem] = ()
) -> dict[str, Any]:
    """Spec fields of a drive's motors with their gearboxes, couplings and further listed parts."""
    rated, listed = chosen.motors[drive], chosen.listed
    count, item = task.motor_count(rated), task.listed_motor(rated)
    parts = [] if listed is None else [part.item for part in (listed.gearbox, listed.coupling) if part is not None]
    turning = choice.speed / (math.pi * drive_diameter(task, chosen))
    motor = {"installed_power": _field_text(task, rated, "kW")} if item is None else listed_motor(item, turning)
    if listed is not None and listed.gearbox is not None:
        motor.pop("gear_ratio", None)
    items = [*motor.get("listed", []), *parts, *further]
    return motor | ({"listed": items} if items else {}) | ({"motors": count} if count > 1 else {})


def _roll_fields(task: SizingTask, roll: RollSize, length: float) -> dict[str, Any]:
    listed = roll.listed(length)
    if listed is not None:
        return {"listed": named_item(task.duty.listed.items("rolls"), listed.name)}
    return {
        "diameter": _field_text(task, roll.diameter, "mm"),
        "length": _field_text(task, length, "mm"),
        "rotating_mass": _field_text(task, roll.mass(length), "kg", 3),
        "bearing": {
            "dynamic_rating": _field_text(task, roll.rating, "kN"),
            "distance": _field_text(task, length - 2.0 * _BEARING_INSET, "mm"),
        },
    }
