"""Bulk cross-sections that a belt holds: open, heaped to its edges, between skirts."""

from __future__ import annotations

from conveyor.laws.loading import CrossSection, cross_section, pipe_area, usable_width
from conveyor.models.feeder_conflicts import distance_of_section, located_feeding
from conveyor.models.parts import ConveyorParts
from conveyor.units import si


def largest_section(conveyor: ConveyorParts) -> CrossSection:
    """Largest bulk cross-section on a horizontal belt (ISO 5048)."""
    pipe = conveyor.idlers.carry.pipe
    if pipe is not None:
        return CrossSection(0.0, pipe_area(si(pipe.diameter), filling=si(pipe.filling)))
    return _bulk_section(conveyor, usable_width(si(conveyor.belt.width)))


def flooded_section(conveyor: ConveyorParts) -> CrossSection:
    """Bulk cross-section heaped from edge to edge of a horizontal belt."""
    pipe = conveyor.idlers.carry.pipe
    if pipe is not None:
        return CrossSection(0.0, pipe_area(si(pipe.diameter)))
    return _bulk_section(conveyor, si(conveyor.belt.width))


def _bulk_section(conveyor: ConveyorParts, across: float, *, surcharge: float | None = None) -> CrossSection:
    """Bulk cross-section on a width of the belt [m], heaped at an angle [rad], that of the bulk without it."""
    carry = conveyor.idlers.carry
    return cross_section(
        across,
        middle_roll_length=carry.middle_belt(across),
        trough_angle=si(carry.trough_angle),
        surcharge_angle=conveyor.material.surcharge if surcharge is None else surcharge,
        inner_wing=carry.inner_wing,
    )


def skirted_areas(conveyor: ConveyorParts) -> dict[str, float]:
    """Bulk cross-sections of sections wholly between skirts of known height [m²], by name.

    The trough between the skirts, as wide along the belt as they are apart, and the rectangle over it.
    """
    route, areas = conveyor.route, dict[str, float]()
    if conveyor.idlers.carry.pipe is not None:
        return areas
    for point in located_feeding(route).values():
        if point.skirt_height is None:
            continue
        width, begin = si(point.skirt_width), distance_of_section(route, point.section)
        area = _bulk_section(conveyor, width, surcharge=0.0).area + width * si(point.skirt_height)
        at = 0.0
        for section in route.sections:
            end = at + si(section.length)
            if begin <= at and end <= begin + point.skirted_length:
                areas[section.name] = area
            at = end
    return areas
