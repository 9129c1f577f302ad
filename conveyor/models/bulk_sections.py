"""Bulk cross-sections that a belt holds between skirts."""

from __future__ import annotations

from conveyor.laws.loading import cross_section
from conveyor.models.feeder_conflicts import distance_of_section, located_feeding
from conveyor.models.parts import ConveyorParts
from conveyor.units import si


def skirted_areas(conveyor: ConveyorParts) -> dict[str, float]:
    """Bulk cross-sections of sections wholly between skirts of known height [m²], by name.

    The trough between the skirts, as wide along the belt as they are apart, and the rectangle over it.
    """
    route, carry, areas = conveyor.route, conveyor.idlers.carry, dict[str, float]()
    if carry.shape.closed:
        return areas
    for point in located_feeding(route).values():
        if point.skirt_height is None:
            continue
        width, begin = si(point.skirt_width), distance_of_section(route, point.section)
        trough = cross_section(
            width,
            middle_roll_length=carry.middle_belt(width),
            trough_angle=si(carry.trough_angle),
            surcharge_angle=0.0,
            inner_wing=carry.inner_wing,
        )
        area, at = trough.area + width * si(point.skirt_height), 0.0
        for section in route.sections:
            end = at + si(section.length)
            if begin <= at and end <= begin + point.skirted_length:
                areas[section.name] = area
            at = end
    return areas
