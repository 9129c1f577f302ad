"""Classical estimates for the same spec: ISO 5048 / DIN 22101 with a given f, CEMA with a given Ky.

CEMA: Kx computed, Ky, Kt, Ai, Cs from the user's copy of Belt Conveyors for Bulk Materials, 5th ed. 1997, chapter 6, as
commonly reproduced; skirts, cleaners, ploughs and pulleys by its figures. Independent of the contact calculation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.classical_forces import cema_forces_along, cema_point_forces, cema_section_tension, unit_main_force
from conveyor.force_sums import ForceSums
from conveyor.laws.resistance import (
    LENGTH_COEFFICIENTS,
    SHORTEST_FOR_FACTOR,
    equivalent_friction_factor,
    secondary_resistance,
)
from conveyor.line.line import Line

_LONGEST_FOR_FACTOR = LENGTH_COEFFICIENTS[-1][0]


@dataclass(frozen=True)
class ClassicalEstimate:
    """An estimate with a given friction factor f, the mean of them where it has several, for the same spec [N]."""

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

    @property
    def motor_force(self) -> float:
        """Force that the motors give at the rims of the drive pulleys [N]."""
        return self.total


def estimate_of_forces(forces: ForceSums, friction_factor: float, secondary_by: str) -> ClassicalEstimate:
    """Forces of a calculation in the form of an estimate, to stand beside another method's [N]."""
    return ClassicalEstimate(friction_factor, forces.main, forces.secondary, secondary_by, forces.special, forces.lift)


def classical_estimate(line: Line, forces: ForceSums, unit_main: float) -> ClassicalEstimate:
    """F_U = C F_H + F_S + F_St; beyond the table of C with the itemised secondary resistances.

    Parameters
    ----------
    line : Line
        The conveyor, with f of every stretch.
    forces : ForceSums
        Special, lift and itemised secondary resistances of the calculation.
    unit_main : float
        Main resistance for f = 1 [N].
    """
    factors = line.friction_factors
    if factors.min() == factors.max():
        main, factor = float(factors[0]) * unit_main, float(factors[0])
    else:
        each = (unit_main_force(stretch, line.gravity) for stretch in line.stretches)
        main = math.fsum(f * unit for f, unit in zip(factors.tolist(), each, strict=True))
        factor = equivalent_friction_factor(main, unit_main_force=unit_main)
    tabled = SHORTEST_FOR_FACTOR < line.length <= _LONGEST_FOR_FACTOR
    return ClassicalEstimate(
        friction_factor=factor,
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

    @property
    def motor_force(self) -> float:
        """Te and the bearing friction of the drive pulleys [N]."""
        return self.total + self.drive_pulleys


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
    Ky is that of the conveyor where a section has none of its own; the book's table has one for each length, slope and
    load. Pulleys are 200, 150 or 100 lbf by position unless given; unlisted pulleys count nothing. Skirts are the whole
    skirtboards, Lb of the book, with the zone of acceleration. Lengths are along the belt; Kx includes the tilt of
    idlers.
    """
    given = line.cema
    if given is None:
        return None
    along = {force.key: force.total for force in cema_forces_along(line, given)}
    points: dict[str, list[float]] = {}
    for force in cema_point_forces(line, given):
        points.setdefault(force.key, []).append(force.total)
    at = {key: math.fsum(forces) for key, forces in points.items()}
    lift = [cema_section_tension(stretch, given).lift for stretch in line.stretches[: line.count]]
    main = (
        ("Tx", "idlers", along["Tx"]),
        ("Tyc", "flexure of the belt, carry", along["Tyc"]),
        ("Tyr", "flexure of the belt, return", along["Tyr"]),
        ("Tym", "flexure of the bulk", along["Tym"]),
    )
    secondary = (("Tp", "pulleys", at.get("Tp", 0.0)), ("Tam", "acceleration of the bulk", at.get("Tam", 0.0)))
    special = (
        ("Tsb", "skirts", at.get("Tsb", 0.0)),
        ("Tbc", "cleaners", at.get("Tbc", 0.0)),
        ("Tpl", "ploughs", at.get("Tpl", 0.0)),
        ("Tac", "other accessories", at.get("Tac", 0.0)),
        *((("", "slider bed", along["slider_bed"]),) if "slider_bed" in along else ()),
        *(
            (("", "hoppers", at["hopper_pull"] + at["hopper_load"] + at.get("hopper_skirts", 0.0)),)
            if "hopper_pull" in at
            else ()
        ),
    )
    lifted = (("Tm", "lift of the bulk", math.fsum([*lift, at.get("tripper_lift", 0.0)])),)
    sums = [math.fsum(item[2] for item in group) for group in (main, secondary, special, lifted)]
    return CemaEstimate(
        friction_factor=equivalent_friction_factor(sums[0], unit_main_force=unit_main),
        main=sums[0],
        secondary=sums[1],
        secondary_by="Tp + Tam (CEMA)",
        special=sums[2],
        lift=sums[3],
        items=(*main, *lifted, *secondary, *special),
        drive_pulleys=given.drive_pulleys,
    )
