"""Rating life of the rolls of a stretch, where their bearings are given: an indicator, not a forecast."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.laws.loading import RollLoad
from conveyor.laws.resistance import roll_rotation
from conveyor.laws.roll_life import (
    BALL_EXPONENT,
    ROLLER_EXPONENT,
    heavier_bearing_load,
    rating_life_hours,
    system_life_hours,
)
from conveyor.line.stretches import Stretch, roll_at
from conveyor.models import Roll
from conveyor.units import si

_EXPONENTS = {"ball": BALL_EXPONENT, "roller": ROLLER_EXPONENT}


@dataclass(frozen=True)
class RollLife:
    """Life of a roll's bearings.

    Attributes
    ----------
    heavier, lighter : float
        Loads of the two bearings [N].
    hours : float
        L10 of the heavier one [h].
    both : float
        L10 of the two together: of the roll [h].
    """

    heavier: float
    lighter: float
    hours: float
    both: float


def roll_life(stretch: Stretch, place: int, belt_speed: float) -> RollLife | None:
    """Life of the roll at a place of the set, at a belt speed [m/s]; None without its bearings or without load.

    Notes
    -----
    Steady load of this stretch, at this filling, all the time. The mass of the shell, thrust, impact and the belt's
    edge pressure are left out; seals, dirt and grease end most rolls before fatigue does.
    """
    roll, load = roll_at(stretch.idlers, place), stretch.loads[place]
    if roll.bearing is None or load.force == 0.0:
        return None
    heavier = _heavier(roll, load, si(roll.bearing.distance), alone=len(stretch.loads) == 1)
    lighter = load.force - heavier
    rotation = roll_rotation(belt_speed, roll_diameter=si(roll.diameter))
    rating, exponent = si(roll.bearing.dynamic_rating), _EXPONENTS[roll.bearing.kind]
    lives = [
        rating_life_hours(abs(each), dynamic_rating=rating, rotation=rotation, exponent=exponent)
        for each in (heavier, lighter)
        if each != 0.0
    ]
    return RollLife(heavier=heavier, lighter=lighter, hours=lives[0], both=system_life_hours(lives))


def _heavier(roll: Roll, load: RollLoad, distance: float, *, alone: bool) -> float:
    """Load of the bearing nearer to the middle of the belt; a single roll is loaded in its middle [N]."""
    if alone:
        return 0.5 * load.force
    return heavier_bearing_load(
        load.bulk_force,
        belt_force=load.belt_force,
        loaded_length=load.length,
        bearing_distance=distance,
        triangular=load.shape == "triangular",
        inset=0.5 * (si(roll.length) - distance),
    )


def set_life(stretch: Stretch, belt_speed: float) -> float | None:
    """L10 of all bearings of a set together [h]; None unless every roll's bearings are given."""
    lives = [roll_life(stretch, place, belt_speed) for place in range(len(stretch.loads))]
    known = [life.both for life in lives if life is not None]
    return system_life_hours(known) if len(known) == len(lives) else None
