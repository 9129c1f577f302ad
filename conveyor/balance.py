"""Closes the loop: single forces, tensions at the drive, power, and the classical estimate beside it.

Wraps and pulley bearings depend on the tensions they add to; the loop is closed by fixed-point iteration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from conveyor.errors import NoSolutionError
from conveyor.line import StretchResult
from conveyor.models import Conveyor, Pulley
from conveyor.power import annual_cost, annual_energy_kwh, belt_power, motor_power, specific_energy
from conveyor.resistance import (
    LENGTH_COEFFICIENTS,
    SHORTEST_FOR_FACTOR,
    acceleration_length,
    acceleration_resistance,
    acceleration_skirt_resistance,
    cleaner_resistance,
    equivalent_friction_factor,
    fabric_wrap_resistance,
    pulley_bearing_resistance,
    pulley_load,
    secondary_resistance,
    skirt_resistance,
    steel_cord_wrap_resistance,
)
from conveyor.tension import drive_tensions
from conveyor.units import si

Place = Literal["head", "take-up", "tail"]
Kind = Literal["secondary", "special"]

_LOOP_STEPS = 200
_LOOP_CLOSED = 1e-13  # relative change of the drive force; wraps add about 1e-3 of it per step
_LONGEST_FOR_FACTOR = LENGTH_COEFFICIENTS[-1][0]


@dataclass(frozen=True)
class SingleForce:
    """A resistance at one place of the belt [N], with the law it comes from."""

    name: str
    kind: Kind
    place: Place
    force: float
    source: str


@dataclass(frozen=True)
class TensionPoint:
    """Tension at a place of the loop in steady running [N], and the least that the sag there allows [N]."""

    place: str
    distance: float
    tension: float
    least_for_sag: float


@dataclass(frozen=True)
class Forces:
    """Resistances of the whole conveyor [N]; flat as `power --json` prints them."""

    indentation: float
    idler_rotation: float
    flexure: float
    secondary: float
    special: float
    lift: float

    @property
    def main(self) -> float:
        """Indentation, rotation, flexure [N]."""
        return self.indentation + self.idler_rotation + self.flexure

    @property
    def total(self) -> float:
        """Effective tension F_U at the drive [N]."""
        return self.main + self.secondary + self.special + self.lift


@dataclass(frozen=True)
class Tensions:
    """Tensions at the drive pulley [N]: steady, at start, and why the slack side is as it is."""

    tight: float
    slack: float
    tight_start: float
    governed_by: str
    largest: float
    smallest: float


@dataclass(frozen=True)
class Power:
    """Power [W] and energy; per year and cost only where operation and price are given."""

    belt: float
    motor: float
    energy_per_tonne_km: float | None
    energy_per_year: float | None
    cost_per_year: float | None
    currency: str | None


@dataclass(frozen=True)
class Classical:
    """ISO 5048 / DIN 22101 with a given friction factor f, for the same spec [N, W]."""

    friction_factor: float
    main: float
    secondary: float
    secondary_by: str
    special: float
    lift: float
    total: float
    motor: float


@dataclass(frozen=True)
class Balance:
    """The whole conveyor: forces, single forces, tensions round the loop, power, classical estimate."""

    forces: Forces
    singles: tuple[SingleForce, ...]
    tensions: Tensions
    points: tuple[TensionPoint, ...]
    power: Power
    friction_factor: float
    classical: Classical


def balance(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> Balance:
    """Close the loop of tensions around the stretches' forces.

    Raises
    ------
    NoSolutionError
        The tensions do not settle (wraps that grow faster than the tension they need).
    """
    fixed = (*_feeding(conveyor), *_cleaners(conveyor), *_by_length(conveyor, results))
    singles, drive = fixed, math.nan
    along = math.fsum(result.total for result in results)
    for _ in range(_LOOP_STEPS):
        before, drive = drive, along + math.fsum(single.force for single in singles)
        loop = _Loop(conveyor, results, singles, drive)
        if abs(drive - before) <= _LOOP_CLOSED * max(abs(drive), abs(along)):
            break
        singles = (*fixed, *_pulleys(conveyor, loop))
    else:
        raise NoSolutionError(
            "the tensions round the belt do not settle: check pulley diameters and drive friction"
        )
    forces = _forces(results, singles)
    unit_main = math.fsum(result.unit_main for result in results)
    return Balance(
        forces=forces,
        singles=singles,
        tensions=loop.tensions,
        points=loop.points,
        power=_power(conveyor, forces.total),
        friction_factor=equivalent_friction_factor(forces.main, unit_main_force=unit_main),
        classical=_classical(conveyor, forces, unit_main),
    )


class _Loop:
    """Tensions round the belt for a drive force: offsets from the strand that leaves the drive, then their level."""

    def __init__(
        self,
        conveyor: Conveyor,
        results: tuple[StretchResult, ...],
        singles: tuple[SingleForce, ...],
        drive: float,
    ) -> None:
        at = {
            place: math.fsum(s.force for s in singles if s.place == place)
            for place in ("head", "take-up", "tail")
        }
        carry = [result for result in results if result.stretch.strand == "carry"]
        back = [result for result in results if result.stretch.strand == "return"]
        offset, way, tail = 0.0, 0.0, 0.0
        rows: list[tuple[str, float, float, float]] = [("drive, leaving", way, offset, 0.0)]
        offset += at["take-up"]
        for result in (*back, None, *carry):
            if result is None:  # round the tail
                tail, offset = offset, offset + at["tail"]
                continue
            stretch = result.stretch
            least = stretch.least_tension
            rows.append((f"{stretch.section}, {stretch.strand}, start", way, offset, least))
            offset, way = offset + result.total, way + stretch.length
            rows.append((f"{stretch.section}, {stretch.strand}, end", way, offset, least))
        rows.append(("drive, arriving", way, offset + at["head"], 0.0))
        level = max((least - rise for _, _, rise, least in rows), default=0.0) + min(drive, 0.0)
        settings = conveyor.drive
        found = drive_tensions(
            drive,
            friction=settings.friction,
            wrap_angle=si(settings.wrap_angle),
            start_factor=settings.start_factor,
            slack_for_sag=max(level, 0.0),
        )
        leaving = found.slack + max(-drive, 0.0)
        self.leaving, self.arriving, self.tail = leaving, leaving + drive, leaving + tail
        self.points = tuple(
            TensionPoint(place, way, leaving + rise, least) for place, way, rise, least in rows
        )
        everywhere = [point.tension for point in self.points]
        self.tensions = Tensions(
            tight=max(self.leaving, self.arriving),
            slack=found.slack,
            tight_start=found.tight,
            governed_by=found.governed_by,
            largest=max(*everywhere, found.tight),
            smallest=min(everywhere),
        )


def _feeding(conveyor: Conveyor) -> tuple[SingleForce, ...]:
    feeding = conveyor.route.feeding
    flow, speed = si(conveyor.material.flow), si(conveyor.belt.speed)
    if feeding is None or flow == 0.0:
        return ()
    density, gravity = si(conveyor.material.density), si(conveyor.calculation.gravity)
    landing = si(feeding.speed)
    length = acceleration_length(
        belt_speed=speed, initial_speed=landing, belt_friction=feeding.belt_friction, gravity=gravity
    )
    skirts = skirt_resistance(
        volume_flow=flow / density,
        bulk_density=density,
        length=si(feeding.skirt_length),
        bulk_speed=speed,
        skirt_distance=si(feeding.skirt_width),
        skirt_friction=feeding.skirt_friction,
        gravity=gravity,
    )
    beyond = SingleForce("skirts beyond the loading zone", "special", "tail", skirts, "ISO 5048, F_gL")
    if conveyor.calculation.secondary == "C":
        return (beyond,)
    inertia = acceleration_resistance(flow, belt_speed=speed, initial_speed=landing)
    zone = acceleration_skirt_resistance(
        volume_flow=flow / density,
        bulk_density=density,
        length=length,
        belt_speed=speed,
        initial_speed=landing,
        skirt_distance=si(feeding.skirt_width),
        skirt_friction=feeding.skirt_friction,
        gravity=gravity,
    )
    return (
        SingleForce("acceleration of the bulk", "secondary", "tail", inertia, "ISO 5048, F_bA"),
        SingleForce("skirts in the loading zone", "secondary", "tail", zone, "ISO 5048, F_f"),
        beyond,
    )


def _cleaners(conveyor: Conveyor) -> tuple[SingleForce, ...]:
    return tuple(
        SingleForce(
            f"cleaner {i} (x{cleaner.count})",
            "special",
            "take-up",
            cleaner.count
            * cleaner_resistance(
                si(cleaner.width) * si(cleaner.thickness),
                pressure=si(cleaner.pressure),
                friction=cleaner.friction,
            ),
            "ISO 5048, F_r",
        )
        for i, cleaner in enumerate(conveyor.route.cleaners, start=1)
    )


def _by_length(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> tuple[SingleForce, ...]:
    """All secondary resistances at once by the length coefficient, where the spec asks for it."""
    if conveyor.calculation.secondary != "C":
        return ()
    main = math.fsum(result.main for result in results)
    force = secondary_resistance(main, length=conveyor.route.length)
    return (SingleForce("secondary, (C-1) F_H", "secondary", "tail", force, "ISO 5048 / DIN 22101, C(L)"),)


def _pulleys(conveyor: Conveyor, loop: _Loop) -> tuple[SingleForce, ...]:
    """Wraps, and bearings of every pulley but the driven one (in the drive's efficiency); none beside C."""
    if conveyor.calculation.secondary == "C":
        return ()
    around = {"head": (loop.arriving, loop.leaving), "take-up": (loop.leaving,) * 2, "tail": (loop.tail,) * 2}
    found = []
    for pulley in conveyor.route.pulleys:
        tight, slack = around[pulley.position]
        wrap = _wrap(conveyor, pulley, 0.5 * (tight + slack))
        source = "ISO 5048 / DIN 22101, belt wrap"
        found.append(SingleForce(f"wrap, {pulley.name}", "secondary", pulley.position, wrap, source))
        if pulley.position != "head":
            load = pulley_load(
                tight_tension=tight,
                slack_tension=slack,
                pulley_mass=si(pulley.mass),
                gravity=si(conveyor.calculation.gravity),
            )
            bearing = pulley_bearing_resistance(
                load, shaft_diameter=si(pulley.shaft_diameter), pulley_diameter=si(pulley.diameter)
            )
            name = f"bearings, {pulley.name}"
            found.append(SingleForce(name, "secondary", pulley.position, bearing, "ISO 5048, F_t"))
    return tuple(found)


def _wrap(conveyor: Conveyor, pulley: Pulley, tension: float) -> float:
    belt = conveyor.belt
    law = steel_cord_wrap_resistance if belt.carcass.kind == "steel cord" else fabric_wrap_resistance
    parts = (belt.top_cover.thickness, belt.bottom_cover.thickness, belt.carcass.thickness)
    return law(
        belt_width=si(belt.width),
        tension=tension,
        belt_thickness=math.fsum(si(part) for part in parts),
        pulley_diameter=si(pulley.diameter),
    )


def _forces(results: tuple[StretchResult, ...], singles: tuple[SingleForce, ...]) -> Forces:
    tilt = math.fsum(result.tilt for result in results)
    return Forces(
        indentation=math.fsum(result.indentation for result in results),
        idler_rotation=math.fsum(result.rotation for result in results),
        flexure=math.fsum(result.flexure for result in results),
        secondary=math.fsum(single.force for single in singles if single.kind == "secondary"),
        special=tilt + math.fsum(single.force for single in singles if single.kind == "special"),
        lift=math.fsum(result.lift for result in results),
    )


def _power(conveyor: Conveyor, force: float) -> Power:
    belt = belt_power(force, belt_speed=si(conveyor.belt.speed))
    motor = motor_power(belt, efficiency=si(conveyor.drive.efficiency))
    flow, operation = si(conveyor.material.flow), conveyor.operation
    price = None if operation is None else operation.price
    year = (
        None if operation is None else annual_energy_kwh(motor, operating_time=si(operation.hours_per_year))
    )
    specific = specific_energy(motor, mass_flow=flow, length=conveyor.route.length) if flow > 0.0 else None
    return Power(
        belt=belt,
        motor=motor,
        energy_per_tonne_km=specific,
        energy_per_year=year,
        cost_per_year=None
        if year is None or price is None
        else annual_cost(year, price_per_kwh=price.amount),
        currency=None if price is None else price.currency,
    )


def _classical(conveyor: Conveyor, forces: Forces, unit_main: float) -> Classical:
    """F_U = C F_H + F_S + F_St; beyond the table of C the itemised secondary resistances stand in."""
    factor = conveyor.calculation.friction_factor
    main = factor * unit_main
    length = conveyor.route.length
    tabled = SHORTEST_FOR_FACTOR < length <= _LONGEST_FOR_FACTOR
    secondary = secondary_resistance(main, length=length) if tabled else forces.secondary
    total = main + secondary + forces.special + forces.lift
    belt = belt_power(total, belt_speed=si(conveyor.belt.speed))
    return Classical(
        friction_factor=factor,
        main=main,
        secondary=secondary,
        secondary_by="(C-1) F_H"
        if tabled
        else f"itemised (C is tabled for {SHORTEST_FOR_FACTOR:g} to 5000 m)",
        special=forces.special,
        lift=forces.lift,
        total=total,
        motor=motor_power(belt, efficiency=si(conveyor.drive.efficiency)),
    )
