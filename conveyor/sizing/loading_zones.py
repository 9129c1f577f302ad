"""Closer idler sets where the bulk lands, as sections of their own in the spec of a design."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from conveyor.line.skirted_zones import given_set_spacing, loading_zone_length, scale_distance
from conveyor.models.route import Feeding, Route, Section
from conveyor.sizing.design_choice import DesignChoice
from conveyor.sizing.sizing_task import SizingTask

_ROUNDING = 1e-9  # [-], of a number of sets


def divide_loading_sections(
    task: SizingTask, choice: DesignChoice, route: Mapping[str, Any], written: Callable[[float, str], str]
) -> dict[str, Any]:
    """Data of a route with closer carry sets where the bulk lands.

    Parameters
    ----------
    task : SizingTask
        The duty.
    choice : DesignChoice
        The candidate, at the speed of its belt.
    route : mapping
        Data of its route, with the distances of graduated sets.
    written : callable
        Writes a value of a unit as the spec has it.

    Returns
    -------
    dict
        A loading section that is longer than its zone is divided; the front part is named after it.

    Notes
    -----
    The zone reaches to the end of the skirts that the duty gives, else as far as skirtboards usually do
    (`loading_zone_length`), in whole sets. Plates, vertical curves and sections without bulk keep what they have.
    """
    given, data, sections = task.duty.sized_route, dict(route), []
    names = {section.name for section in given.sections}
    spacings = choice.graduated or (choice.carry,) * len(given.sections)
    moved: dict[str, tuple[str, float]] = {}
    left = 0.0
    for section, (length, _), apart, fields in zip(
        given.sections, task.sections, spacings, route["sections"], strict=True
    ):
        for point in _points_at(given, section):
            left = max(left, loading_zone_length(choice.speed, task.gravity, point))
        close = _loading_spacing(task, given, section, apart)
        if left <= 0.0 or close >= apart or not section.loaded or section.bed or section.curve:
            left = 0.0
            sections.append(fields)
            continue
        zone = close * math.ceil(left / close - _ROUNDING)
        if zone >= length:
            sections.append(fields | {"carry_spacing": written(close, "m")})
            left = max(0.0, left - length)
            continue
        left, name = 0.0, _front_name(section.name, names)
        share = zone / length
        parts = [(zone, share), (length - zone, 1.0 - share)]
        front, rest = (
            fields
            | {"length": written(long, "m")}
            | ({"lift": written(section.rise * part, "m")} if section.lift is not None else {})
            for long, part in parts
        )
        sections += [front | {"name": name, "carry_spacing": written(close, "m")}, rest]
        moved[section.name] = name, zone
    data["sections"] = sections
    return _follow_divided_sections(data, given, moved, written)


def _points_at(route: Route, section: Section) -> Iterator[Feeding | None]:
    """Loading points at the tail end of a section; an assumed one on the first."""
    first = section.name == route.sections[0].name
    if not route.feeding_points and first:
        yield None
    for point in route.feeding_points:
        if point.section == section.name or (point.section is None and first):
            yield point


def _loading_spacing(task: SizingTask, route: Route, section: Section, apart: float) -> float:
    """Spacing of the sets of a loading section [m]: that of its loading point, else by the rules."""
    spacings = (given_set_spacing(point) for point in _points_at(route, section) if point is not None)
    given = [one for one in spacings if one is not None]
    return min([*given, apart]) if given else task.loading_spacing(apart)


def _front_name(name: str, names: set[str]) -> str:
    """Name of the front part of a section, which no other has."""
    return next(
        one
        for count in itertools.count(1)
        if (one := f"{name}, skirts" + ("" if count == 1 else f" {count}")) not in names
    )


def _follow_divided_sections(
    data: dict[str, Any], route: Route, moved: Mapping[str, tuple[str, float]], written: Callable[[float, str], str]
) -> dict[str, Any]:
    """Route data whose loading points and scales name the part of a divided section that they stand in."""

    def at_front(fields: dict[str, Any]) -> dict[str, Any]:
        """Fields of a loading point."""
        name = str(fields.get("section"))
        return fields | {"section": moved[name][0]} if name in moved else fields

    if "feeding" in data:
        data["feeding"] = at_front(data["feeding"])
    if "further_feeding" in data:
        data["further_feeding"] = [at_front(point) for point in data["further_feeding"]]
    if "belt_scales" in data:
        placed = []
        for scale, fields in zip(route.belt_scales, data["belt_scales"], strict=True):
            name, zone = moved.get(scale.section, (scale.section, 0.0))
            beyond = scale_distance(scale) - zone
            here = {"section": name} if beyond < 0.0 else {"distance": written(beyond, "m")}
            placed.append(fields | here if scale.section in moved else fields)
        data["belt_scales"] = placed
    return data
