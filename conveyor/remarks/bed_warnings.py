"""Warnings on plates that carry the belt."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.laws.resistance import BED_FRICTION
from conveyor.models import Conveyor
from conveyor.units.sentences import Message, escape_braces, message


def bed_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Friction of plates that is a maker's figure, and what no figure of a plate includes."""
    beds = [section.bed for section in conveyor.route.sections if section.bed is not None]
    for surface, underside in dict.fromkeys((bed.surface, bed.underside) for bed in beds if bed.friction is None):
        of = BED_FRICTION[surface, underside]
        yield message(
            f"route.sections[].bed.friction not given: {of.value:g} assumed of {underside} on {surface} ({of.low:g} to "
            f"{of.high:g}; {escape_braces(of.source)}), dry and clean: measure it, wet and dirty too"
        )
    if beds:
        yield message(
            "route.sections[].bed: neither the wear of the sliding belt (belt.wear is that of loading) nor the higher "
            "friction of a belt at rest on the plate is calculated"
        )
