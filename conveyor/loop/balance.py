"""The whole conveyor: forces, tensions round the loop, power, and the classical estimate beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.energy import DutyStep, duty_sums
from conveyor.laws.power import belt_power, motor_power, specific_energy
from conveyor.laws.resistance import (
    LENGTH_COEFFICIENTS,
    SHORTEST_FOR_FACTOR,
    equivalent_friction_factor,
    secondary_resistance,
)
from conveyor.line.walk import StretchResult
from conveyor.loop.classical import cema_estimate
from conveyor.loop.data import LoopData, loop_data
from conveyor.loop.settled import Settled, settle
from conveyor.loop.single_forces import Placed, SingleForce
from conveyor.loop.tensions import Loop, State
from conveyor.loop.year import year_cost
from conveyor.models import Conveyor
from conveyor.units import si

__all__ = [
    "Balance",
    "Classical",
    "Forces",
    "Power",
    "SingleForce",
    "TensionPoint",
    "Tensions",
    "balance",
    "points",
]

Array = NDArray[np.float64]

_LONGEST_FOR_FACTOR = LENGTH_COEFFICIENTS[-1][0]
_COLUMNS = ("indentation", "rotation", "flexure", "tilt", "lift", "unit_main")


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
    """Power [W] at belt, motor shafts and mains; energy from the mains, per year and cost where they are asked for."""

    belt: float
    motor: float
    mains: float
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


@dataclass(frozen=True, eq=False)
class Balance:
    """The whole conveyor: forces, single forces, tensions round the loop, power, classical estimate.

    `settled` holds the loop itself: every drive, the take-up, the states that decide its setting.
    """

    forces: Forces
    singles: tuple[SingleForce, ...]
    tensions: Tensions
    power: Power
    friction_factor: float
    classical: Classical
    settled: Settled
    cema: Classical | None = None
    """Classic form of CEMA, where the spec gives its factors; its f is the one DIN 22101 would need."""

    @cached_property
    def points(self) -> tuple[TensionPoint, ...]:
        """Tensions round the loop in steady running, from the head back to it."""
        return points(self.settled, self.settled.steady)


def balance(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> Balance:
    """Close the loop of tensions around the stretches' forces.

    Raises
    ------
    NoSolutionError
        The tensions do not settle (wraps that grow faster than the tension they need), or the belt is slack.
    """
    data = loop_data(conveyor)
    sums, total, lift = _columns(results, data.places.count)
    loop = Loop(data, data.geometry(results), _with_coefficient(conveyor, data, sums), total, lift)
    settled = settle(loop)
    forces = _forces(sums, settled.singles)
    unit_main = sums["unit_main"]
    return Balance(
        forces=forces,
        singles=settled.singles,
        tensions=_tensions(settled),
        power=_power(conveyor, data, forces.total),
        friction_factor=equivalent_friction_factor(forces.main, unit_main_force=unit_main),
        classical=_classical(conveyor, data, forces, unit_main),
        settled=settled,
        cema=_cema(conveyor, data, results, settled, unit_main),
    )


def _columns(results: tuple[StretchResult, ...], count: int) -> tuple[dict[str, float], Array, Array]:
    """Sums of every kind of force [N]; total and lift of each stretch in loop order, shape (2n,)."""
    rows = np.array(list(map(attrgetter(*_COLUMNS), results)))
    rows = np.concatenate([rows[count:], rows[:count]])
    found = {name: math.fsum(column) for name, column in zip(_COLUMNS, rows.T.tolist(), strict=True)}
    return found, rows[:, :5].sum(axis=1), rows[:, 4]


def _with_coefficient(conveyor: Conveyor, data: LoopData, sums: dict[str, float]) -> tuple[Placed, ...]:
    """Single forces that no tension changes; the secondary ones by the length coefficient where it is asked for."""
    if conveyor.calculation.secondary != "C":
        return data.fixed
    main = sums["indentation"] + sums["rotation"] + sums["flexure"]
    force = secondary_resistance(main, length=data.length)
    place = data.places.name(data.landing)
    single = SingleForce("secondary, (C-1) F_H", "secondary", place, force, "ISO 5048 / DIN 22101, C(L)")
    return (*data.fixed, Placed(data.landing, single))


def points(settled: Settled, state: State) -> tuple[TensionPoint, ...]:
    """Tensions round the loop in a state, from the head back to it."""
    data, geometry = settled.loop.data, settled.loop.geometry
    way: list[float] = geometry.way.tolist()
    last = data.boundaries[-1]
    met = sorted(zip(data.drives, state.drives, strict=True), key=lambda pair: pair[0].spot)
    at_head = [side for drive, side in met if drive.spot.boundary == last]
    head = "drive" if at_head else "head"
    between: dict[int, list[TensionPoint]] = {}
    for drive, side in met:
        at = drive.spot.boundary
        if at != last:
            between.setdefault(at, []).extend(
                TensionPoint(f"{drive.name}, {when}", way[at], tension, 0.0)
                for when, tension in (("arriving", side.arriving), ("leaving", side.leaving))
            )
    found = [TensionPoint(f"{head}, leaving", 0.0, state.leaving, 0.0)]
    columns = (geometry.stretches, geometry.least.tolist(), state.starts.tolist(), state.ends.tolist())
    for i, (stretch, least, start, end) in enumerate(zip(*columns, strict=True)):
        found.extend(between.get(i, ()))
        name = f"{stretch.section}, {stretch.strand}"
        found.append(TensionPoint(f"{name}, start", way[i], start, least))
        found.append(TensionPoint(f"{name}, end", way[i + 1], end, least))
    arriving = at_head[0].arriving if at_head else state.arriving
    found.append(TensionPoint(f"{head}, arriving", way[-1], arriving, 0.0))
    return tuple(found)


def _tensions(settled: Settled) -> Tensions:
    steady, unsteady = settled.steady, settled.unsteady
    given = settled.loop.data.take_up.tension is not None
    return Tensions(
        tight=max(drive.tight for drive in steady.drives),
        slack=min(drive.slack for drive in steady.drives),
        tight_start=max(drive.tight for drive in unsteady.drives),
        governed_by="take-up" if given else settled.governed_by.kind,
        largest=max(state.largest for state in settled.states.values()),
        smallest=steady.smallest,
    )


def _forces(sums: dict[str, float], singles: tuple[SingleForce, ...]) -> Forces:
    return Forces(
        indentation=sums["indentation"],
        idler_rotation=sums["rotation"],
        flexure=sums["flexure"],
        secondary=math.fsum(single.force for single in singles if single.kind == "secondary"),
        special=sums["tilt"] + math.fsum(single.force for single in singles if single.kind == "special"),
        lift=sums["lift"],
    )


def _power(conveyor: Conveyor, data: LoopData, force: float) -> Power:
    belt = belt_power(force, belt_speed=data.speed)
    motor = data.motor(force)
    mains = motor_power(motor, efficiency=conveyor.drive.mains_efficiency)
    flow, operation = data.flow, conveyor.operation
    energy = cost = currency = None
    if operation is not None:
        year = duty_sums([DutyStep(time=si(operation.hours_per_year), power=mains, mass_flow=flow)])
        energy, cost = year.net_kwh, year_cost(operation, year)
        currency = None if operation.price is None else operation.price.currency
    specific = specific_energy(mains, mass_flow=flow, length=data.length) if flow > 0.0 else None
    return Power(
        belt=belt,
        motor=motor,
        mains=mains,
        energy_per_tonne_km=specific,
        energy_per_year=energy,
        cost_per_year=cost,
        currency=currency,
    )


def _cema(
    conveyor: Conveyor,
    data: LoopData,
    results: tuple[StretchResult, ...],
    settled: Settled,
    unit_main: float,
) -> Classical | None:
    factors = conveyor.calculation.cema
    if factors is None:
        return None
    found = cema_estimate(conveyor, factors, [result.stretch for result in results], settled.singles)
    return Classical(
        friction_factor=equivalent_friction_factor(found.main, unit_main_force=unit_main),
        main=found.main,
        secondary=found.secondary,
        secondary_by="Tp + Tam (CEMA)",
        special=found.special,
        lift=found.lift,
        total=found.total,
        motor=data.motor(found.total),
    )


def _classical(conveyor: Conveyor, data: LoopData, forces: Forces, unit_main: float) -> Classical:
    """F_U = C F_H + F_S + F_St; beyond the table of C the itemised secondary resistances stand in."""
    factor = conveyor.calculation.friction_factor
    main = factor * unit_main
    length = data.length
    tabled = SHORTEST_FOR_FACTOR < length <= _LONGEST_FOR_FACTOR
    secondary = secondary_resistance(main, length=length) if tabled else forces.secondary
    total = main + secondary + forces.special + forces.lift
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
        motor=data.motor(total),
    )
