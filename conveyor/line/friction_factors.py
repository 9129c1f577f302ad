"""Friction factor f of every stretch (ISO 5048, DIN 22101)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from conveyor.line.stretches import Stretch
from conveyor.models import Conveyor


def friction_factors(conveyor: Conveyor, stretches: Sequence[Stretch]) -> NDArray[np.float64]:
    """Friction factor of every stretch [-], shape (2n,): of its load, section and strand, else the one of all."""
    given = conveyor.calculation
    sections = {section.name: section for section in conveyor.route.sections}

    def factor(stretch: Stretch) -> float:
        section = sections[stretch.section]
        if stretch.strand == "return":
            ranked = (section.return_friction_factor, given.return_friction_factor)
        else:
            ranked = (given.empty_friction_factor if stretch.bulk_mass == 0.0 else None, section.friction_factor)
        return next((f for f in ranked if f is not None), given.friction_factor)

    return np.array([factor(stretch) for stretch in stretches])
