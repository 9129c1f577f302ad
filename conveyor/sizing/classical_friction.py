"""Main resistance of candidates by the factors of a classical method, for the closed estimate."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.classical_forces import STANDARD_GRAVITY
from conveyor.laws.resistance import length_coefficient
from conveyor.laws.resistance.cema import RETURN_FACTOR, SLIDING_FACTOR
from conveyor.line.cema_factors import CemaFactors, cema_factors
from conveyor.line.friction_factors import secondary_method
from conveyor.models.calculation_methods import FACTOR_METHODS
from conveyor.models.sizing import SizingDuty

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ClassicalFriction:
    """Factors of a classical method on the route of a duty, means over its length.

    Attributes
    ----------
    factors : tuple of float
        f of carry and return strand, with the cosine of the slope on the masses of belt and bulk in `level` [-].
    level : float
        Cosine of the slope [-].
    flexure : float
        Ky [-].
    cema : CemaFactors or None
        Factors of CEMA's classic form; None by a friction factor.
    coefficient : float
        C of the secondary resistances [-]; 1 where they are itemised.
    """

    factors: tuple[float, float]
    level: float
    flexure: float
    cema: CemaFactors | None
    coefficient: float

    @classmethod
    def of(cls, duty: SizingDuty, sections: Sequence[tuple[float, float]]) -> ClassicalFriction | None:
        """Factors of a duty with length and rise of its sections [m]; None by the rolling contact."""
        given, route = duty.calculation, duty.sized_route
        if given.method == "viscoelastic":
            return None
        cema = cema_factors(given, route) if given.method not in FACTOR_METHODS else None
        rows = []
        for section, (length, rise) in zip(route.sections, sections, strict=True):
            back = given.return_friction_factor
            rows.append(
                (
                    length,
                    _first_given(section.friction_factor, given.friction_factor),
                    _first_given(section.return_friction_factor, back, given.friction_factor),
                    math.sqrt(1.0 - (rise / length) ** 2),
                    0.0 if cema is None else cema.flexure_of(section.name),
                )
            )
        table = np.array(rows)
        carry, back_factor, level, flexure = np.average(table[:, 1:], axis=0, weights=table[:, 0]).tolist()
        by_length = secondary_method(given, route.length) == "C"
        coefficient = length_coefficient(route.length) if by_length else 1.0
        return cls((carry, back_factor), level, flexure, cema, coefficient)

    def main_friction(self, rolls: Array, belt: Array, bulk: Array, *, spacing: Array, gravity: float) -> Array:
        """Main resistance of carry and return strand per length, shape (2, n) [N/m].

        Parameters
        ----------
        rolls : ndarray, shape (2, n)
            Rotating mass of the rolls of carry and return strand [kg/m].
        belt, bulk : ndarray, shape (n,)
            Mass of belt and bulk [kg/m].
        spacing : ndarray, shape (n,)
            Of the carry sets [m].
        gravity : float
            g [m/s²].

        Notes
        -----
        f g (m'_R + (m'_G + m'_L) cos δ) (DIN 22101); Kt (Kx + Ky Wb) + Ky Wm and 0.015 Kt Wb (CEMA).
        """
        if self.cema is None:
            weighs = rolls + self.level * np.array([belt + bulk, belt])
            return np.asarray(gravity * np.array(self.factors)[:, None] * weighs)
        idlers = SLIDING_FACTOR * STANDARD_GRAVITY * (belt + bulk) + self.cema.idler_friction / spacing
        warm, flexure = self.cema.temperature, self.flexure * STANDARD_GRAVITY
        carry = warm * (idlers + flexure * belt) + flexure * bulk
        return np.array([carry, warm * RETURN_FACTOR * STANDARD_GRAVITY * belt])


def _first_given(*values: float | None) -> float:
    """First value that is given."""
    return next(value for value in values if value is not None)
