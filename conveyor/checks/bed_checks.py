"""Criteria of plates that carry the belt."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.units.sentences import escape_braces


def bed_speed(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt slides no faster than the maker of each plate allows."""
    for section in result.line.sections:
        if section.bed is not None:
            name = escape_braces(section.name)
            yield check_against_limit(
                "bed_speed", f"belt speed on the plate, {name}", result.line.speed, "at most",
                section.bed.allowed_speed, "speed", missing="bed.allowed_speed not given",
                why=f'the belt slides at {{calculated}} on the plate of "{name}", its maker allows {{required}}: take '
                "idler sets there, another plate or a slower belt",
            )  # fmt: skip
