"""Belt scales, in SI."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from conveyor.line.optional_quantities import si_or_default, si_or_none
from conveyor.models import Conveyor
from conveyor.units import si


@dataclass(frozen=True)
class WeighSection:
    """A belt scale: first and last weigh set from the tail, spacing [m]; `section` is the number of its section.

    `to_curve` is the distance to the nearest curve [m], infinite without one; `alignment` [m] and `allowed_error` [-]
    None not given.
    """

    name: str
    section: int
    start: float
    end: float
    spacing: float
    n_sets: int
    to_curve: float
    alignment: float | None
    allowed_error: float | None
    for_trade: bool


def weigh_sections(conveyor: Conveyor) -> tuple[WeighSection, ...]:
    """Belt scales of a route."""
    route = conveyor.route
    names = [section.name for section in route.sections]
    ends = [0.0, *itertools.accumulate(si(section.length) for section in route.sections)]
    curves = [
        (ends[i], ends[i + 1])
        for i, section in enumerate(route.sections)
        if section.curve is not None or section.horizontal_curve is not None
    ]
    found = []
    for scale in route.belt_scales:
        at = names.index(scale.section)
        spacing = si_or_default(route.sections[at].carry_spacing, si(conveyor.idlers.carry.spacing))
        start = ends[at] + si(scale.distance)
        end = start + (scale.weigh_sets - 1) * spacing
        gaps = (max(low - end, start - high, 0.0) for low, high in curves)
        found.append(
            WeighSection(
                name=scale.section,
                section=at,
                start=start,
                end=end,
                spacing=spacing,
                n_sets=scale.weigh_sets,
                to_curve=min(gaps, default=math.inf),
                alignment=si_or_none(scale.alignment),
                allowed_error=si_or_none(scale.allowed_error),
                for_trade=scale.for_trade,
            )
        )
    return tuple(found)
