"""The spec of a design, as a user would write it."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, Final

from conveyor.laws.preliminary_sizing import PULLEY_MASS
from conveyor.line.usual_parts import SHAFT_DIAMETER_RATIO
from conveyor.models import Conveyor
from conveyor.models.base import given_data
from conveyor.sizing.design_choice import CarcassClass, DesignChoice, RollSize, SelectedParts
from conveyor.sizing.listed_sizes import listed_belt, listed_motor, named_item
from conveyor.sizing.sizing_task import SizingTask
from conveyor.units import from_si

_BEARING_INSET: Final = 0.02  # [m], middle of a bearing inside the tube's end; general knowledge


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
    duty, carcass, written = task.duty, chosen.carcass, partial(_field_text, task)
    drive_diameter, bend_diameter = task.drive_diameter(carcass), task.bend_diameter(carcass)
    route = given_data(duty.sized_route)
    for section, spacing in zip(route["sections"], choice.graduated, strict=bool(choice.graduated)):
        section["carry_spacing"] = written(spacing, "m")
    for point in [*([route["feeding"]] if "feeding" in route else []), *route.get("further_feeding", [])]:
        at = next((i for i, section in enumerate(route["sections"]) if section["name"] == point.get("section")), 0)
        spacing = choice.graduated[at] if choice.graduated else choice.carry
        point.setdefault("idler_spacing", written(task.loading_spacing(spacing), "m"))
    route["pulleys"] = [
        _pulley_fields(task, name, place, size, choice.trough.width.belt)
        for name, place, size in (
            ("head", "head", drive_diameter),
            ("take-up", "take-up", bend_diameter),
            ("tail", "tail", drive_diameter if "tail" in choice.drives else bend_diameter),
        )
    ]
    tension = {"tension": written(chosen.take_up, "kN", 4)} if chosen.take_up > 0.0 else {}
    route["take_up"] = {"kind": "gravity", **tension}
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
    })  # fmt: skip


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


def _pulley_fields(task: SizingTask, name: str, place: str, diameter: float, width: float) -> dict[str, Any]:
    return {
        "name": name,
        "position": place,
        "diameter": _field_text(task, diameter, "mm"),
        "shaft_diameter": _field_text(task, SHAFT_DIAMETER_RATIO * diameter, "mm"),
        "mass": _field_text(task, PULLEY_MASS * diameter**2 * width, "kg", 3),
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
    turning = choice.speed / (math.pi * task.drive_diameter(chosen.carcass))
    one = {"wrap_angle": _field_text(task, task.grip[1], "deg"), "friction": rules.friction}
    brake = {"brake_force": _field_text(task, chosen.brake, "kN", 4)} if chosen.brake > 0.0 else {}
    if chosen.backstop > 0.0:
        brake["backstop_torque"] = _field_text(task, chosen.backstop, "kN*m", 4)
    first = {
        **one,
        **brake,
        "position": "tail" if choice.drives == "tail" else "head",
        **_motor_fields(task, motors[0], turning),
        "efficiency": f"{100.0 * task.efficiency:.6g} %",
        "start_factor": rules.start_factor,
    }
    further = []
    for number, motor in enumerate(motors[1:], start=2):
        tail = "tail" in choice.drives and number == len(motors)
        place = {"name": f"drive {number}", "position": "tail" if tail else "head"}
        further.append({**one, **place, **_motor_fields(task, motor, turning)})
    return {**first, "further_drives": further} if further else first


def _motor_fields(task: SizingTask, rated: float, turning: float) -> dict[str, Any]:
    """Spec fields of a pulley's motors of a total power [W]; `turning` is the speed of the pulley [1/s]."""
    count, item = task.motor_count(rated), task.listed_motor(rated)
    power = {"installed_power": _field_text(task, rated, "kW")} if item is None else listed_motor(item, turning)
    return power | ({"motors": count} if count > 1 else {})


def _roll_fields(task: SizingTask, roll: RollSize, length: float) -> dict[str, Any]:
    listed = roll.piece(length)
    if listed is not None:
        return {"listed": named_item(task.duty.listed.items("rolls"), listed[1])}
    return {
        "diameter": _field_text(task, roll.diameter, "mm"),
        "length": _field_text(task, length, "mm"),
        "rotating_mass": _field_text(task, roll.mass(length), "kg", 3),
        "bearing": {
            "dynamic_rating": _field_text(task, roll.rating, "kN"),
            "distance": _field_text(task, length - 2.0 * _BEARING_INSET, "mm"),
        },
    }
