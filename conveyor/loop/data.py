"""What the loop of tensions needs of a conveyor: SI numbers and places, made once and kept as long as the conveyor.

Masses, lengths and least tensions of the stretches come with the first results; scenes of one conveyor that differ in
rubber and temperature share them.
"""

from __future__ import annotations

import math
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.power import belt_power, motor_power
from conveyor.laws.take_up import LOOP_STRANDS
from conveyor.line.stretches import Stretch, roll_at
from conveyor.line.walk import StretchResult
from conveyor.loop.single_forces import Bend, Placed, Places, Spot, bends, fixed_singles
from conveyor.models import Conveyor, IdlerSet
from conveyor.units import si

Array = NDArray[np.float64]
T = TypeVar("T")


@dataclass(frozen=True)
class DriveData:
    """A drive pulley, SI."""

    name: str
    spot: Spot
    share: float
    friction: float
    wrap_angle: float
    power: float | None
    brake: float
    reduced_mass: float


@dataclass(frozen=True)
class TakeUpData:
    """The take-up, SI; `spot` is None on the slack side of the drives at the first one's place, whichever that is."""

    kind: str
    spot: Spot | None
    tension: float | None
    reeving: float


@dataclass(frozen=True, eq=False)
class Geometry:
    """The stretches in loop order (return strand from the head, then carry strand), arrays of shape (2n,)."""

    stretches: tuple[Stretch, ...]
    length: Array
    mass: Array
    """Moving mass of belt, bulk and rolls [kg]; the rolls' as if it were all at their rims, on the safe side."""
    least: Array
    """Least tension for the sag [N]."""
    way: Array
    """Distance from the head to each boundary [m], shape (2n + 1,)."""


class LoopData:
    """SI numbers of one conveyor."""

    def __init__(self, conveyor: Conveyor) -> None:
        self.places = places = Places(conveyor)
        self.fixed: tuple[Placed, ...] = fixed_singles(conveyor, places)
        self.bends: tuple[Bend, ...] = bends(conveyor, places)
        self.drives = _drives(conveyor, places)
        self.take_up = _take_up(conveyor)
        self.start_factor = conveyor.drive.start_factor
        self.least_friction = si(conveyor.drive.least_friction)
        self.efficiency = si(conveyor.drive.efficiency)
        back = conveyor.drive.regeneration_efficiency
        self.regeneration = self.efficiency if back is None else si(back)
        self.speed = si(conveyor.belt.speed)
        self.flow = si(conveyor.material.flow)
        self.gravity = si(conveyor.calculation.gravity)
        self.length = conveyor.route.length
        feeding = conveyor.route.feeding
        self.landing = places.landing(None if feeding is None else feeding.section)
        ends = (places.before("tail", None), places.before("head", None), places.behind("head", None))
        held = () if self.take_up.spot is None else (self.take_up.spot,)
        forces = (*(placed.spot for placed in self.fixed), *(bend.spot for bend in self.bends))
        drives = (drive.spot for drive in self.drives)
        self.spots = sorted({*ends, self.landing, *held, *forces, *drives})
        self.boundaries: list[int] = sorted({spot.boundary for spot in self.spots})
        self.runs = np.diff(self.boundaries)
        self._geometry: Geometry | None = None

    def motor(self, force: float) -> float:
        """Power at the motor's shaft for a force at the belt, negative when the belt drives it [W]."""
        belt = belt_power(force, belt_speed=self.speed)
        return motor_power(belt, efficiency=self.efficiency if force >= 0.0 else self.regeneration)

    def geometry(self, results: Sequence[StretchResult]) -> Geometry:
        """Arrays of the stretches; made again only where the stretches are others."""
        known = self._geometry
        if known is not None and known.stretches[self.places.count] is results[0].stretch:
            return known
        found = _geometry(loop_order([result.stretch for result in results]))
        self._geometry = found
        return found


def loop_order(along: Sequence[T]) -> tuple[T, ...]:
    """Put carry strand, return strand in the order the belt meets them from the head: return, carry."""
    half = len(along) // 2
    return (*along[half:], *along[:half])


def _geometry(stretches: tuple[Stretch, ...]) -> Geometry:
    masses: dict[int, float] = {}
    for stretch in stretches:
        if id(stretch.idlers) not in masses:
            masses[id(stretch.idlers)] = _set_mass(stretch.idlers)
    length = np.array([s.length for s in stretches])
    moving = [s.line_mass + masses[id(s.idlers)] / s.spacing for s in stretches]
    return Geometry(
        stretches=stretches,
        length=length,
        mass=length * np.array(moving),
        least=np.array([s.least_tension for s in stretches]),
        way=np.concatenate([[0.0], np.cumsum(length)]),
    )


def _set_mass(idlers: IdlerSet) -> float:
    return math.fsum(si(roll_at(idlers, place).rotating_mass) for place in range(idlers.rolls))


def _drives(conveyor: Conveyor, places: Places) -> tuple[DriveData, ...]:
    pulleys = conveyor.drive.pulleys
    powers = [None if pulley.installed_power is None else si(pulley.installed_power) for pulley in pulleys]
    if conveyor.drive.share is not None:
        shares = [0.0 if pulley.share is None else si(pulley.share) for pulley in pulleys]
    elif len(pulleys) == 1:
        shares = [1.0]
    else:
        given = [power for power in powers if power is not None]
        shares = [power / math.fsum(given) for power in given]
    names = ["drive", *(pulley.name for pulley in conveyor.drive.further_drives)]
    return tuple(
        DriveData(
            name=name,
            spot=places.drive(pulley),
            share=share,
            friction=pulley.friction,
            wrap_angle=si(pulley.wrap_angle),
            power=power,
            brake=0.0 if pulley.brake_force is None else si(pulley.brake_force),
            reduced_mass=si(pulley.reduced_mass),
        )
        for name, pulley, share, power in zip(names, pulleys, shares, powers, strict=True)
    )


def _take_up(conveyor: Conveyor) -> TakeUpData:
    given, places = conveyor.route.take_up, Places(conveyor)
    if given is None:
        return TakeUpData("slack side", None, None, 1.0)
    tension = None if given.tension is None else si(given.tension)
    if given.mass is not None:
        # the law of take_up.take_up_mass, solved for the tension
        tension = si(given.mass) * given.reeving * si(conveyor.calculation.gravity) / LOOP_STRANDS
    slack_side = given.position == "drive"
    return TakeUpData(given.kind, None if slack_side else places.take_up(given), tension, given.reeving)


_known: dict[int, tuple[weakref.ref[Conveyor], LoopData]] = {}


def loop_data(conveyor: Conveyor) -> LoopData:
    """The numbers of a conveyor; the same object for the same conveyor."""
    key = id(conveyor)
    found = _known.get(key)
    if found is not None and found[0]() is conveyor:
        return found[1]
    made = LoopData(conveyor)
    _known[key] = (weakref.ref(conveyor, lambda _: _known.pop(key, None)), made)
    return made
