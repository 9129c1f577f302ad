"""Drag of every roll of a set at its rim, by the law its spec names; SI, prepared once a strand."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError
from conveyor.laws.resistance import (
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
"""From loads of a roll [N] to its drag at the rim under each [N]."""
RollDrags = Sequence[tuple[tuple[float, ...], ...]]
"""Of each strand and stretch the drag of each roll of one set [N]."""


def roll_drags(conveyor: Conveyor, strand: OneStrand) -> tuple[tuple[float, ...], ...]:
    """Drag of each roll of one set of every stretch of a strand at its rim, by its load [N].

    Raises
    ------
    InputError
        A maker's line falls below zero at a load, or the air is too cold for the grease.
    """
    sets, which = strand.distinct_sets
    drags = [tuple(row) for row in _set_drags(conveyor, strand.strand, np.array(sets)).tolist()]
    return tuple(drags[i] for i in which)


def _set_drags(conveyor: Conveyor, strand: Strand, loads: Array) -> Array:
    """Drags of the rolls of sets of a strand under their loads, both shape (sets, rolls) [N]."""
    idlers = conveyor.idlers.carry if strand == "carry" else conveyor.idlers.return_
    if idlers.drag is not None:
        return np.full(loads.shape, si(idlers.drag) / idlers.rolls)
    rolls = [idlers.roll_at(place) for place in range(idlers.rolls)]
    drags = np.empty(loads.shape)
    for first, roll in enumerate(rolls):
        same = [place for place, other in enumerate(rolls) if other is roll]
        if first == same[0]:
            drags[:, same] = _law(roll, conveyor, _field(idlers, roll, strand))(loads[:, same])
    return drags


def _field(idlers: IdlerSet, roll: Roll, strand: Strand) -> str:
    name = "roll" if roll is idlers.roll else "middle_roll"
    return f"idlers.{strand}.{name}"


def _law(roll: Roll, conveyor: Conveyor, field: str) -> DragLaw:
    diameter, law = si(roll.diameter), roll.drag_law
    speed, air = si(conveyor.belt.speed), si(conveyor.ambient.temperature)
    if isinstance(law, MakerDrag):
        return _named(_maker(law, roll_rotation(speed, roll_diameter=diameter)), f"{field}.drag_law")
    if isinstance(law, BearingDrag):
        return _named(_bearing(law, diameter, speed, air, f"{field}.drag_law"), f"{field}.drag_law")
    if roll.drag is None and conveyor.calculation.roll_drag == "in service":
        return _named(_in_service(diameter, si(roll.length), speed, air), f"{field}: drag not given")
    return _evenly(acceptance_limit(roll).value if roll.drag is None else si(roll.drag))


def _evenly(drag: float) -> DragLaw:
    """The same drag under any load."""
    return lambda loads: np.full(loads.shape, drag)


def _each(law: Callable[[float], float]) -> DragLaw:
    """A law of one load, for many; equal ones are computed once."""

    def drags(loads: Array) -> Array:
        distinct, which = np.unique(loads, return_inverse=True)
        return np.array([law(load) for load in distinct.tolist()])[which].reshape(loads.shape)

    return drags


def _in_service(diameter: float, length: float, speed: float, air: float) -> DragLaw:
    return lambda loads: (
        service_roll_drag(
            loads, belt_speed=speed, roll_diameter=diameter, roll_length=length, air_temperature=air
        ).force
    )


def assumed_share(conveyor: Conveyor, idlers: IdlerSet, drags: Sequence[float]) -> float:
    """Share of the rolls that are taken to be in service in the drag of a set [-], from the drags of its rolls [N]."""
    if conveyor.calculation.roll_drag != "in service" or idlers.drag is not None:
        return 0.0
    rolls = [idlers.roll_at(place) for place in range(idlers.rolls)]
    without = [roll.drag is None and roll.drag_law is None for roll in rolls]
    assumed = math.fsum(drag for drag, one in zip(drags, without, strict=True) if one)
    return assumed / math.fsum(drags) if assumed > 0.0 else 0.0


def assumed_bearing(roll: Roll) -> str:
    """Name of the bearing that a roll in service is taken to have."""
    return usual_bearing(si(roll.diameter)).name


def acceptance_limit(roll: Roll) -> Default:
    """Limit of a new roll's test, by its diameter [N]."""
    return default_roll_drag(si(roll.diameter))


def _maker(law: MakerDrag, rotation: float) -> DragLaw:
    measured, slope, per_rotation = si(law.drag), law.load_slope, si(law.rotation_slope)
    at_load, at_rotation = si(law.load), si(law.rotation)
    return _each(
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


def _bearing(law: BearingDrag, diameter: float, speed: float, air: float, field: str) -> DragLaw:
    mean, rating, seal = si(law.mean_diameter), si(law.static_rating), si(law.seal_moment)
    try:
        viscosity = bearing_viscosity(law, air)
    except InputError as error:
        raise InputError(f"{field}: {error}") from None
    return _each(
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
        The oil is solid there.
    """
    return oil_viscosity(
        air + si(law.warming),
        first_temperature=si(law.first_temperature),
        first_viscosity=si(law.first_viscosity),
        second_temperature=si(law.second_temperature),
        second_viscosity=si(law.second_viscosity),
    )


def _named(law: DragLaw, field: str) -> DragLaw:
    """Name the field in a refusal of the law."""

    def drag(loads: Array) -> Array:
        try:
            return law(loads)
        except InputError as error:
            raise InputError(f"{field}: {error}") from None

    return drag
