"""Drag of every roll of a set at its rim, by the law of its spec; SI, prepared once for each strand."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError
from conveyor.laws.resistance import (
    ROLL_CONDITION,
    Default,
    bearing_roll_drag,
    default_roll_drag,
    linear_roll_drag,
    oil_viscosity,
    roll_rotation,
    service_roll_drag,
    usual_bearing,
)
from conveyor.line.strands import OneStrand
from conveyor.line.stretches import Strand
from conveyor.models import Conveyor, IdlerSet, Roll
from conveyor.models.rolls import BearingDrag, MakerDrag
from conveyor.units import si

Array = NDArray[np.float64]
DragLaw = Callable[[Array], Array]
"""Drag of a roll at its rim [N] as a function of its loads [N]."""
StrandDrags: TypeAlias = tuple[tuple[float, ...], ...]
"""Drag of each roll of one set, for each stretch [N]."""
RollDrags: TypeAlias = Sequence[StrandDrags]
"""Drag of each roll of one set, for each strand and stretch [N]."""


def roll_drags(conveyor: Conveyor, strand: OneStrand) -> StrandDrags:
    """Drag of each roll of one set of every stretch of a strand at its rim, by its load [N].

    Raises
    ------
    InputError
        A maker's line falls below zero at a load, or the air is too cold for the grease.
    """
    (drags,) = roll_drags_many([(conveyor, strand)])
    if isinstance(drags, InputError):
        raise drags
    return drags


def roll_drags_many(asked: Sequence[tuple[Conveyor, OneStrand]]) -> list[StrandDrags | InputError]:
    """Drags of the rolls of many strands, each as by `roll_drags`; rolls in service in one batch."""
    drags = [np.empty(np.shape(strand.distinct_sets[0])) for _, strand in asked]
    refused: dict[int, InputError] = {}
    served: dict[tuple[float, float], list[tuple[int, list[int], _ServiceRoll]]] = {}
    for k, (conveyor, strand) in enumerate(asked):
        loads = np.array(strand.distinct_sets[0])
        try:
            for places, law in _drag_laws(conveyor, strand.strand) if loads.size else ():
                if isinstance(law, _ServiceRoll):
                    served.setdefault((law.diameter, law.length), []).append((k, places, law))
                else:
                    drags[k][:, places] = law(loads[:, places])
        except InputError as error:
            refused[k] = error
    for alike in served.values():
        loads_of = [np.array(asked[k][1].distinct_sets[0])[:, places] for k, places, _ in alike]
        for (k, places, _), one in zip(alike, _service_drags([law for *_, law in alike], loads_of), strict=True):
            if isinstance(one, InputError):
                refused.setdefault(k, one)
            else:
                drags[k][:, places] = one
    return [
        refused[k] if k in refused else _drags_of_stretches(strand, drags[k]) for k, (_, strand) in enumerate(asked)
    ]


def _drags_of_stretches(strand: OneStrand, sets: Array) -> StrandDrags:
    """Drags of every stretch from those of its distinct sets."""
    rows = [tuple(row) for row in sets.tolist()]
    return tuple(() if i is None else rows[i] for i in strand.distinct_sets[1])


def _drag_laws(conveyor: Conveyor, strand: Strand) -> Iterator[tuple[list[int], DragLaw | _ServiceRoll]]:
    """Drag laws of a set, each with the places of its rolls."""
    idlers = conveyor.idlers.carry if strand == "carry" else conveyor.idlers.return_
    if idlers.drag is not None:
        yield list(range(idlers.rolls)), _constant_drag(si(idlers.drag) / idlers.rolls)
        return
    rolls = [idlers.roll_at(place) for place in range(idlers.rolls)]
    for first, roll in enumerate(rolls):
        same = [place for place, other in enumerate(rolls) if other is roll]
        if first == same[0]:
            yield same, _drag_law(roll, conveyor, _roll_field(idlers, roll, strand))


@dataclass(frozen=True)
class _ServiceRoll:
    """A roll in service: size [m], belt speed [m/s], air temperature [K], condition factor [-], spec field."""

    diameter: float
    length: float
    speed: float
    air: float
    condition: float
    field: str


def _service_drags(laws: Sequence[_ServiceRoll], loads: Sequence[Array]) -> list[Array | InputError]:
    """Drags of rolls of one size under their loads [N]; after an error each law by itself."""
    sizes = [one.size for one in loads]
    speed, air = (np.repeat(each, sizes) for each in zip(*((law.speed, law.air) for law in laws), strict=True))
    try:
        whole = service_roll_drag(
            np.concatenate([one.ravel() for one in loads]),
            belt_speed=speed,
            roll_diameter=laws[0].diameter,
            roll_length=laws[0].length,
            air_temperature=air,
        ).force
    except InputError as error:
        if len(laws) == 1:
            return [InputError("{}: drag not given: {}", laws[0].field, error)]
        return [_service_drags([law], [one])[0] for law, one in zip(laws, loads, strict=True)]
    parts = np.split(whole, np.cumsum(sizes)[:-1])
    return [law.condition * part.reshape(one.shape) for law, part, one in zip(laws, parts, loads, strict=True)]


def _roll_field(idlers: IdlerSet, roll: Roll, strand: Strand) -> str:
    name = "roll" if roll is idlers.roll else "middle_roll"
    return f"idlers.{strand}.{name}"


def _drag_law(roll: Roll, conveyor: Conveyor, field: str) -> DragLaw | _ServiceRoll:
    diameter, law = si(roll.diameter), roll.drag_law
    speed, air = si(conveyor.belt.speed), si(conveyor.ambient.temperature)
    if isinstance(law, MakerDrag):
        return _name_error_field(_maker_drag(law, roll_rotation(speed, roll_diameter=diameter)), f"{field}.drag_law")
    if isinstance(law, BearingDrag):
        return _name_error_field(_bearing_drag(law, diameter, speed, air, f"{field}.drag_law"), f"{field}.drag_law")
    if roll.drag is None and conveyor.calculation.roll_drag == "in service":
        condition = ROLL_CONDITION[conveyor.site].value
        return _ServiceRoll(diameter, si(roll.length), speed, air, condition, field)
    return _constant_drag(acceptance_limit(roll).value if roll.drag is None else si(roll.drag))


def _constant_drag(drag: float) -> DragLaw:
    """Drag independent of the load."""
    return lambda loads: np.full(loads.shape, drag)


def _law_of_loads(law: Callable[[float], float]) -> DragLaw:
    """Vectorise a law of one load; equal loads are computed once."""

    def drags(loads: Array) -> Array:
        distinct, which = np.unique(loads, return_inverse=True)
        return np.array([law(load) for load in distinct.tolist()])[which].reshape(loads.shape)

    return drags


def assumed_drag_share(conveyor: Conveyor, idlers: IdlerSet, drags: Sequence[float]) -> float:
    """Share of assumed drags in the drag of a set [-], from the drags of its rolls [N]."""
    if conveyor.calculation.roll_drag != "in service" or idlers.drag is not None:
        return 0.0
    rolls = [idlers.roll_at(place) for place in range(idlers.rolls)]
    without = [roll.drag is None and roll.drag_law is None for roll in rolls]
    assumed = math.fsum(drag for drag, one in zip(drags, without, strict=True) if one) if drags else 0.0
    return assumed / math.fsum(drags) if assumed > 0.0 else 0.0


def assumed_bearing(roll: Roll) -> str:
    """Name of the bearing assumed for a roll in service."""
    return usual_bearing(si(roll.diameter)).name


def acceptance_limit(roll: Roll) -> Default:
    """Acceptance limit of a new roll's drag, by its diameter [N]."""
    return default_roll_drag(si(roll.diameter))


def _maker_drag(law: MakerDrag, rotation: float) -> DragLaw:
    measured, slope, per_rotation = si(law.drag), law.load_slope, si(law.rotation_slope)
    at_load, at_rotation = si(law.load), si(law.rotation)
    return _law_of_loads(
        lambda load: linear_roll_drag(
            measured,
            load=load,
            rotation=rotation,
            load_slope=slope,
            rotation_slope=per_rotation,
            reference_load=at_load,
            reference_rotation=at_rotation,
        )
    )


def _bearing_drag(law: BearingDrag, diameter: float, speed: float, air: float, field: str) -> DragLaw:
    mean, rating, seal = si(law.mean_diameter), si(law.static_rating), si(law.seal_moment)
    try:
        viscosity = bearing_viscosity(law, air)
    except InputError as error:
        raise InputError("{}: {}", field, error) from None
    return _law_of_loads(
        lambda load: (
            bearing_roll_drag(
                load,
                belt_speed=speed,
                roll_diameter=diameter,
                mean_diameter=mean,
                viscosity=viscosity,
                static_rating=rating,
                f0=law.f0,
                f1_factor=law.f1_factor,
                f1_exponent=law.f1_exponent,
                seal_moment=seal,
            ).force
        )
    )


def bearing_viscosity(law: BearingDrag, air: float) -> float:
    """Viscosity of the base oil in the running bearing [m²/s], in air of a temperature [K].

    Raises
    ------
    InputError
        The oil is solid at that temperature.
    """
    return oil_viscosity(
        air + si(law.warming),
        first_temperature=si(law.first_temperature),
        first_viscosity=si(law.first_viscosity),
        second_temperature=si(law.second_temperature),
        second_viscosity=si(law.second_viscosity),
    )


def _name_error_field(law: DragLaw, field: str) -> DragLaw:
    """Prefix errors of the law with the field."""

    def drag(loads: Array) -> Array:
        try:
            return law(loads)
        except InputError as error:
            raise InputError("{}: {}", field, error) from None

    return drag
