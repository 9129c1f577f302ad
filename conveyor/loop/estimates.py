"""Classical estimates for the same spec: ISO 5048 / DIN 22101 with a given f, CEMA with a given Ky.

CEMA: Kx computed, Ky, Kt and Ai from the user's copy of Belt Conveyors for Bulk Materials, 5th ed. 1997, chapter 6, as
commonly reproduced.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from conveyor.forces import Force, ForceSums
from conveyor.laws.resistance import (
    LENGTH_COEFFICIENTS,
    SHORTEST_FOR_FACTOR,
    CemaTension,
    cema_acceleration,
    cema_effective_tension,
    cema_idler_factor,
    cema_pulley_friction,
    equivalent_friction_factor,
    secondary_resistance,
)
from conveyor.laws.resistance.cema import Place
from conveyor.line.line import BendPulley, CemaFactors, Line
from conveyor.line.stretches import Stretch

_LONGEST_FOR_FACTOR = LENGTH_COEFFICIENTS[-1][0]
_ACCESSORIES = frozenset({"loading_skirts", "skirts", "cleaner", "plough"})
"""Forces of this calculation that stand for Tac."""
_LEAST_WRAP = math.radians(150.0)  # CEMA: below it a pulley counts as "other"


@dataclass(frozen=True)
class Classical:
    """An estimate with a given friction factor f, for the same spec [N]."""

    friction_factor: float
    main: float
    secondary: float
    secondary_by: str
    special: float
    lift: float

    @property
    def total(self) -> float:
        """Effective tension [N]."""
        return self.main + self.secondary + self.special + self.lift


def classical(line: Line, forces: ForceSums, unit_main: float) -> Classical:
    """F_U = C F_H + F_S + F_St; beyond the table of C the itemised secondary resistances stand in.

    Parameters
    ----------
    line : Line
        With its f.
    forces : ForceSums
        Of this calculation: special, lift, itemised secondary resistances.
    unit_main : float
        Main resistance for f = 1 [N].
    """
    main = line.friction_factor * unit_main
    tabled = SHORTEST_FOR_FACTOR < line.length <= _LONGEST_FOR_FACTOR
    return Classical(
        friction_factor=line.friction_factor,
        main=main,
        secondary=secondary_resistance(main, length=line.length) if tabled else forces.secondary,
        secondary_by="(C-1) F_H"
        if tabled
        else f"itemised (C is tabled for {SHORTEST_FOR_FACTOR:g} to 5000 m)",
        special=forces.special,
        lift=forces.lift,
    )


def cema(line: Line, points: Iterable[Force], unit_main: float) -> Classical | None:
    """Te = L Kt (Kx + Ky Wb + 0.015 Wb) + Wm (L Ky ± H) + Tp + Tam + Tac, section by section; None without factors.

    Parameters
    ----------
    line : Line
        With Ky, Kt, Ai, loading points and pulleys.
    points : iterable of Force
        Of this calculation: its skirts, cleaners and ploughs stand for Tac.
    unit_main : float
        Main resistance for f = 1 [N].

    Notes
    -----
    Ky is one figure for the whole conveyor, though the book's table has one for each length, slope and load. The
    acceleration and the pulleys (200, 150 or 100 lbf by place) are the book's; of pulleys that are not listed there is
    nothing. Lengths are along the belt; the tilt of idlers is in Kx and not counted again.
    """
    if line.cema is None:
        return None
    parts = [_section(stretch, line.cema) for stretch in line.stretches[: line.count]]
    main = math.fsum(part.effective - part.lift for part in parts)
    pulleys = cema_pulley_friction([_place(pulley) for pulley in line.pulleys if not pulley.driven])
    return Classical(
        friction_factor=equivalent_friction_factor(main, unit_main_force=unit_main),
        main=main,
        secondary=pulleys + _acceleration(line),
        secondary_by="Tp + Tam (CEMA)",
        special=math.fsum(force.total for force in points if force.key in _ACCESSORIES),
        lift=math.fsum(part.lift for part in parts),
    )


def _section(stretch: Stretch, factors: CemaFactors) -> CemaTension:
    kx = cema_idler_factor(
        stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        idler_friction=factors.idler_friction,
        spacing=stretch.spacing,
    )
    return cema_effective_tension(
        stretch.length,
        lift=stretch.rise,
        belt_mass=stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        idler_factor=kx,
        flexure_factor=factors.flexure,
        temperature_factor=factors.temperature,
    )


def _acceleration(line: Line) -> float:
    return math.fsum(
        cema_acceleration(point.flow, belt_speed=line.speed, initial_speed=point.speed)
        for point in line.loading
    )


def _place(pulley: BendPulley) -> Place:
    """Tight side: head and carry strand; slack side: the rest."""
    if pulley.wrap_angle < _LEAST_WRAP:
        return "other"
    return "tight" if pulley.position in {"head", "carry"} else "slack"
