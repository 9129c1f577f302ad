"""Factors of the classic CEMA estimate, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from conveyor.line.optional_quantities import si_or_default, si_or_none
from conveyor.models import Calculation, Route
from conveyor.units import si


@dataclass(frozen=True)
class CemaFactors:
    """Factors of the classic CEMA form: Ky, Kt, Cs [-], Ai, Tp (None: by table), accessories [N], hs [m], N/m.

    `section_flexure` is Ky of the sections that have their own.
    """

    flexure: float
    temperature: float
    idler_friction: float
    skirt_factor: float
    skirt_depth: float
    seals: float
    cleaner: float
    plough: float
    pulleys: float | None
    drive_pulleys: float
    accessories: float
    section_flexure: Mapping[str, float]

    def flexure_of(self, section: str) -> float:
        """Ky of a section [-]."""
        return self.section_flexure.get(section, self.flexure)


def cema_factors(calculation: Calculation, route: Route) -> CemaFactors | None:
    """Factors of the CEMA estimate; None without them."""
    factors = calculation.cema
    if factors is None:
        return None
    return CemaFactors(
        flexure=factors.flexure_factor,
        temperature=factors.temperature_factor,
        idler_friction=si(factors.idler_friction),
        skirt_factor=factors.skirt_factor or 0.0,
        skirt_depth=si_or_default(factors.skirt_depth, 0.0),
        seals=si(factors.skirt_seals),
        cleaner=si(factors.cleaner_friction),
        plough=si(factors.plough_friction),
        pulleys=si_or_none(factors.pulley_friction),
        drive_pulleys=si(factors.drive_pulley_friction),
        accessories=si(factors.accessories),
        section_flexure={
            section.name: section.flexure_factor for section in route.sections if section.flexure_factor is not None
        },
    )
