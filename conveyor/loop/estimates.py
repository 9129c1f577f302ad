"""Classical estimates for the same spec: ISO 5048 / DIN 22101 with a given f, CEMA with a given Ky.

CEMA: Kx computed, Ky, Kt, Ai, Cs from the user's copy of Belt Conveyors for Bulk Materials, 5th ed. 1997, chapter 6, as
commonly reproduced; skirts, cleaners, ploughs and pulleys by its figures. Independent of the contact calculation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.forces import ForceSums
from conveyor.laws.resistance import (
    LENGTH_COEFFICIENTS,
    SHORTEST_FOR_FACTOR,
    CemaTension,
    cema_acceleration,
    cema_effective_tension,
    cema_idler_factor,
    cema_pulley_friction,
    cema_skirts,
    equivalent_friction_factor,
    secondary_resistance,
    slope_resistance,
)
from conveyor.laws.resistance.cema import Place
from conveyor.line.bend_pulleys import BendPulley
from conveyor.line.cema_factors import CemaFactors
from conveyor.line.line import Line
from conveyor.line.stretches import Stretch

STANDARD_GRAVITY = 9.80665
"""Pounds force for pounds mass [m/s²]."""
_LONGEST_FOR_FACTOR = LENGTH_COEFFICIENTS[-1][0]
_LEAST_WRAP = math.radians(150.0)  # CEMA: below it a pulley counts as "other"


@dataclass(frozen=True)
class ClassicalEstimate:
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


def classical_estimate(line: Line, forces: ForceSums, unit_main: float) -> ClassicalEstimate:
    """F_U = C F_H + F_S + F_St; beyond the table of C with the itemised secondary resistances.

    Parameters
    ----------
    line : Line
        The conveyor, with its f.
    forces : ForceSums
        Special, lift and itemised secondary resistances of the calculation.
    unit_main : float
        Main resistance for f = 1 [N].
    """
    main = line.friction_factor * unit_main
    tabled = SHORTEST_FOR_FACTOR < line.length <= _LONGEST_FOR_FACTOR
    return ClassicalEstimate(
        friction_factor=line.friction_factor,
        main=main,
        secondary=secondary_resistance(main, length=line.length) if tabled else forces.secondary,
        secondary_by="(C-1) F_H" if tabled else f"itemised (C is tabled for {SHORTEST_FOR_FACTOR:g} to 5000 m)",
        special=forces.special,
        lift=forces.lift,
    )


@dataclass(frozen=True)
class CemaEstimate(ClassicalEstimate):
    """The classic form of CEMA, by cause [N].

    `items` are symbol, name and force of every part of Te; `drive_pulleys` is the bearing friction of drive pulleys, in
    addition to Te.
    """

    items: tuple[tuple[str, str, float], ...]
    drive_pulleys: float


def cema_estimate(line: Line, unit_main: float) -> CemaEstimate | None:
    """Te = L Kt (Kx + Ky Wb + 0.015 Wb) + Wm (L Ky ± H) + Tp + Tam + Tac, section by section; None without factors.

    Parameters
    ----------
    line : Line
        The conveyor, with its CEMA factors, loading points, cleaners, ploughs and pulleys.
    unit_main : float
        Main resistance for f = 1 [N].

    Notes
    -----
    Ky is one value for the whole conveyor, though the book's table has one for each length, slope and load. Pulleys
    are 200, 150 or 100 lbf by position unless given; unlisted pulleys count nothing. Skirts are the whole skirtboards,
    Lb of the book, with the zone of acceleration. Lengths are along the belt; Kx includes the tilt of idlers.
    """
    given = line.cema
    if given is None:
        return None
    parts = [_section_tension(stretch, given) for stretch in line.stretches[: line.count]]
    pulleys = given.pulleys
    if pulleys is None:
        pulleys = cema_pulley_friction([_pulley_place(pulley) for pulley in line.pulleys if not pulley.driven])
    over = [
        slope_resistance(point.flow / line.speed, lift=point.lift, gravity=STANDARD_GRAVITY)
        for point in line.loading
        if point.lift is not None
    ]
    main = (
        ("Tx", "idlers", math.fsum(part.idlers for part in parts)),
        ("Tyc", "flexure of the belt, carry", math.fsum(part.belt_carry for part in parts)),
        ("Tyr", "flexure of the belt, return", math.fsum(part.belt_return for part in parts)),
        ("Tym", "flexure of the bulk", math.fsum(part.bulk for part in parts)),
    )
    secondary = (("Tp", "pulleys", pulleys), ("Tam", "acceleration of the bulk", _acceleration_force(line)))
    special = (
        ("Tsb", "skirts", _skirt_force(line, given)),
        ("Tbc", "cleaners", given.cleaner * math.fsum(each.count * each.width for each in line.scrapers)),
        ("Tpl", "ploughs", given.plough * math.fsum(each.count * each.width for each in line.ploughs)),
        ("Tac", "other accessories", given.accessories),
    )
    lift = (("Tm", "lift of the bulk", math.fsum([*(part.lift for part in parts), *over])),)
    sums = [math.fsum(item[2] for item in group) for group in (main, secondary, special, lift)]
    return CemaEstimate(
        friction_factor=equivalent_friction_factor(sums[0], unit_main_force=unit_main),
        main=sums[0],
        secondary=sums[1],
        secondary_by="Tp + Tam (CEMA)",
        special=sums[2],
        lift=sums[3],
        items=(*main, *lift, *secondary, *special),
        drive_pulleys=given.drive_pulleys,
    )


def _skirt_force(line: Line, given: CemaFactors) -> float:
    """Skirt friction of all loading points; on an empty belt of the seals alone."""
    return math.fsum(
        cema_skirts(
            point.boards(line.speed, line.gravity),
            skirt_factor=given.skirt_factor if point.flow_beyond > 0.0 else 0.0,
            depth=given.skirt_depth,
            seals=given.seals,
        )
        for point in line.loading
    )


def _section_tension(stretch: Stretch, factors: CemaFactors) -> CemaTension:
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


def _acceleration_force(line: Line) -> float:
    return math.fsum(
        cema_acceleration(point.flow, belt_speed=line.speed, initial_speed=point.speed) for point in line.loading
    )


def _pulley_place(pulley: BendPulley) -> Place:
    """CEMA place of a pulley; tight side: head and carry strand, slack side: the rest."""
    if pulley.wrap_angle < _LEAST_WRAP:
        return "other"
    return "tight" if pulley.position in {"head", "carry"} else "slack"
