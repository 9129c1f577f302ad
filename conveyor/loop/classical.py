"""The classic form of CEMA beside this calculation: Kx computed, Ky, Kt and Ai from the user's copy of the book.

Source: CEMA, Belt Conveyors for Bulk Materials, 5th ed. 1997, chapter 6, as commonly reproduced.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from conveyor.laws.resistance import (
    CemaTension,
    cema_acceleration,
    cema_effective_tension,
    cema_idler_factor,
    cema_pulley_friction,
)
from conveyor.laws.resistance.cema import Place
from conveyor.line.stretches import Stretch
from conveyor.loop.single_forces import SingleForce, driven_pulleys
from conveyor.models import Conveyor, Pulley
from conveyor.models.methods import Cema
from conveyor.units import si

_ACCESSORIES = frozenset({"ISO 5048, F_f", "ISO 5048, F_gL", "ISO 5048, F_r", "ISO 5048, F_a"})
"""Skirts, cleaners, ploughs: laws whose forces stand for Tac."""
_LEAST_WRAP = math.radians(150.0)  # CEMA: below it a pulley counts as "other"


@dataclass(frozen=True)
class CemaEstimate:
    """Effective tension of the classic form [N]: idlers and flexure, pulleys and acceleration, accessories, lift."""

    main: float
    secondary: float
    special: float
    lift: float

    @property
    def total(self) -> float:
        """Te [N]."""
        return self.main + self.secondary + self.special + self.lift


def cema_estimate(
    conveyor: Conveyor, factors: Cema, stretches: Sequence[Stretch], singles: Iterable[SingleForce]
) -> CemaEstimate:
    """Te = L Kt (Kx + Ky Wb + 0.015 Wb) + Wm (L Ky ± H) + Tp + Tam + Tac, section by section.

    Parameters
    ----------
    conveyor : Conveyor
        Feeding points and pulleys.
    factors : Cema
        Ky, Kt, Ai.
    stretches : sequence of Stretch
        Of both strands.
    singles : iterable of SingleForce
        Of this calculation: its skirts, cleaners and ploughs stand for Tac.

    Notes
    -----
    Ky is one figure for the whole conveyor, though the book's table has one for each length, slope and load. The
    acceleration and the pulleys (200, 150 or 100 lbf by place) are the book's; of pulleys that are not listed there is
    nothing. Lengths are along the belt; the tilt of idlers is in Kx and not counted again.
    """
    parts = [_section(stretch, factors) for stretch in stretches if stretch.strand == "carry"]
    return CemaEstimate(
        main=math.fsum(part.effective - part.lift for part in parts),
        secondary=_pulleys(conveyor) + _acceleration(conveyor),
        special=math.fsum(single.force for single in singles if single.source in _ACCESSORIES),
        lift=math.fsum(part.lift for part in parts),
    )


def _section(stretch: Stretch, factors: Cema) -> CemaTension:
    kx = cema_idler_factor(
        stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        idler_friction=si(factors.idler_friction),
        spacing=stretch.spacing,
    )
    return cema_effective_tension(
        stretch.length,
        lift=stretch.rise,
        belt_mass=stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        idler_factor=kx,
        flexure_factor=factors.flexure_factor,
        temperature_factor=factors.temperature_factor,
    )


def _acceleration(conveyor: Conveyor) -> float:
    flow, speed = si(conveyor.material.flow), si(conveyor.belt.speed)
    return math.fsum(
        cema_acceleration(
            flow * (1.0 if point.share is None else si(point.share)),
            belt_speed=speed,
            initial_speed=si(point.speed),
        )
        for point in conveyor.route.feeding_points
    )


def _pulleys(conveyor: Conveyor) -> float:
    """Of the pulleys that are not driven."""
    driven = driven_pulleys(conveyor)
    return cema_pulley_friction(
        [_place(pulley) for i, pulley in enumerate(conveyor.route.pulleys) if i not in driven]
    )


def _place(pulley: Pulley) -> Place:
    """Tight side: head and carry strand; slack side: the rest."""
    if si(pulley.wrap_angle) < _LEAST_WRAP:
        return "other"
    return "tight" if pulley.position in {"head", "carry"} else "slack"
