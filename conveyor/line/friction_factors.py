"""Friction factor f of every stretch (ISO 5048, DIN 22101), and what the secondary resistances follow."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.resistance import LENGTH_COEFFICIENTS, SHORTEST_FOR_FACTOR
from conveyor.line.stretches import Stretch
from conveyor.models import Calculation, Conveyor
from conveyor.models.calculation_methods import FACTOR_METHODS


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


def secondary_method(calculation: Calculation, length: float) -> str:
    """Method of the secondary resistances, "itemised" or "C": as given; with a factor f C where it is tabled."""
    tabled = SHORTEST_FOR_FACTOR < length <= LENGTH_COEFFICIENTS[-1][0]
    usual = "C" if calculation.method in FACTOR_METHODS and tabled else "itemised"
    return usual if calculation.secondary is None else calculation.secondary
