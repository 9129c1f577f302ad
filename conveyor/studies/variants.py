"""Variants of a conveyor: loaded as a case says, at another speed or temperature."""

from __future__ import annotations

from collections.abc import Sequence

from conveyor.models import Conveyor, LoadCase, Route, Section
from conveyor.units import Quantity, from_si, si


def scaled(value: Quantity, factor: float) -> Quantity:
    """A quantity times a factor, in its own unit."""
    changed: Quantity = value * factor
    return changed


def with_case(conveyor: Conveyor, case: LoadCase, *, speed: Quantity | None = None) -> Conveyor:
    """The conveyor loaded as a case says, at a belt speed.

    A loading point resists only where bulk lies on the section it feeds.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    case : LoadCase
        What is loaded.
    speed : Quantity, optional
        Of the belt; that of the spec without it.

    Raises
    ------
    InputError
        The bulk does not fit the belt, or a loading point is faster than it.
    """
    changes: dict[str, object] = {}
    if speed is not None and si(speed) != si(conveyor.belt.speed):
        changes["belt"] = conveyor.belt.replace(speed=speed)
    if case.loading in {"empty", "part load"}:
        share = 0.0 if case.share is None else si(case.share)
        changes["material"] = conveyor.material.replace(flow=scaled(conveyor.material.flow, share))
    if case.loading in {"full", "inclines only", "declines only"}:
        sections = [_loaded(section, case) for section in conveyor.route.sections]
        if any(new is not old for new, old in zip(sections, conveyor.route.sections, strict=True)):
            changes["route"] = _fed(conveyor, sections, conveyor.belt.speed if speed is None else speed)
    return conveyor.replace(**changes) if changes else conveyor


def _loaded(section: Section, case: LoadCase) -> Section:
    loaded = {
        "full": True,
        "inclines only": section.rise > 0.0,
        "declines only": section.rise < 0.0,
    }[case.loading]
    return section if section.loaded is loaded else section.replace(loaded=loaded)


def _fed(conveyor: Conveyor, sections: Sequence[Section], speed: Quantity) -> Route:
    """The route with those sections; loading points above unloaded ones do not resist."""
    route = conveyor.route
    bearing = {section.name: section.loaded for section in sections}
    points = [
        point
        if bearing[sections[0].name if point.section is None else point.section]
        else point.replace(speed=speed, skirt_length="0 m")
        for point in route.feeding_points
    ]
    if not points:
        return route.replace(sections=sections)
    return route.replace(sections=sections, feeding=points[0], further_feeding=points[1:])


def with_temperature(conveyor: Conveyor, temperature: Quantity) -> Conveyor:
    """The conveyor with its covers at a temperature; the air keeps its distance to them.

    Raises
    ------
    InputError
        A compound is not known there.
    """
    ambient = conveyor.ambient
    change = si(temperature) - si(ambient.belt)
    if change == 0.0:
        return conveyor
    if ambient.belt_temperature is None:
        return conveyor.replace(ambient=ambient.replace(temperature=temperature))
    air = from_si(float(f"{si(ambient.temperature) + change:.9g}"), "temperature", "K")
    return conveyor.replace(ambient=ambient.replace(temperature=air, belt_temperature=temperature))
