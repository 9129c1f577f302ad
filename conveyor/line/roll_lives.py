"""Rating life of the rolls of a stretch with known bearings: an indicator, not a forecast."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from conveyor.laws.loading import RollLoad
from conveyor.laws.resistance import roll_rotation
from conveyor.laws.roll_life import (
    BALL_EXPONENT,
    ROLLER_EXPONENT,
    WEIBULL_SLOPE_BALL,
    WEIBULL_SLOPE_ROLLER,
    heavier_bearing_load,
    rating_life_hours,
    system_life_hours,
)
from conveyor.line.stretches import Strand, Stretch
from conveyor.models import Roll
from conveyor.units import si

_LIFE_EXPONENTS = {"ball": BALL_EXPONENT, "roller": ROLLER_EXPONENT}
_WEIBULL_SLOPES = {"ball": WEIBULL_SLOPE_BALL, "roller": WEIBULL_SLOPE_ROLLER}


_LIGHT_RATED_LIFE, _HEAVY_RATED_LIFE = 30e3, 60e3
"""L10 of CEMA's load ratings at 500 rpm [h]: of B and C; of D, E and C on tapered rollers (scribd 483814341)."""


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
        L10 of the roll, both bearings together [h].
    weibull_slope : float
        Weibull slope of the bearings' lives [-].
    """

    heavier: float
    lighter: float
    hours: float
    both: float
    weibull_slope: float


def roll_life(stretch: Stretch, place: int, belt_speed: float) -> RollLife | None:
    """Life of the roll at a place of the set, at a belt speed [m/s]; None without bearings or load.

    Notes
    -----
    Steady load of this stretch, at this filling, all the time. The mass of the shell, thrust, impact and the belt's
    edge pressure are left out; seals, dirt and grease end most rolls before fatigue does.
    """
    roll, load = stretch.idlers.roll_at(place), stretch.loads[place]
    if roll.bearing is None or load.force == 0.0:
        return None
    heavier = _heavier_load(roll, load, si(roll.bearing.distance), alone=len(stretch.loads) == 1)
    lighter = load.force - heavier
    rotation = roll_rotation(belt_speed, roll_diameter=si(roll.diameter))
    rating, exponent = si(roll.bearing.dynamic_rating), _LIFE_EXPONENTS[roll.bearing.kind]
    lives = [
        rating_life_hours(abs(each), dynamic_rating=rating, rotation=rotation, exponent=exponent)
        for each in (heavier, lighter)
        if each != 0.0
    ]
    slope = _WEIBULL_SLOPES[roll.bearing.kind]
    both = system_life_hours(lives, weibull_slopes=[slope] * len(lives))
    return RollLife(heavier=heavier, lighter=lighter, hours=lives[0], both=both, weibull_slope=slope)


def _heavier_load(roll: Roll, load: RollLoad, distance: float, *, alone: bool) -> float:
    """Load of the bearing nearer to the middle of the belt, half the load on a single roll [N]."""
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


@dataclass(frozen=True)
class SetLife:
    """L10 of all known bearings of a set together.

    Attributes
    ----------
    section : str
        Section of the set.
    hours : float
        L10 of the set [h].
    weakest : str
        The roll of the shortest life.
    weakest_hours : float
        L10 of that roll [h].
    whole : bool
        True if the bearings of every roll are known; else the life is shorter.
    rated : float
        L10 that the sets' CEMA class is rated for; without a class that of light series [h].
    """

    section: str
    hours: float
    weakest: str
    weakest_hours: float
    whole: bool
    rated: float

    @property
    def too_short(self) -> bool:
        """True if below the rated life."""
        return self.hours < self.rated


def _rated_life(stretch: Stretch) -> float:
    """L10 that the class of a stretch's sets is rated for [h]."""
    name = stretch.idlers.cema_class
    kinds = {bearing.kind for place in range(len(stretch.loads)) if (bearing := stretch.idlers.roll_at(place).bearing)}
    return _HEAVY_RATED_LIFE if name in {"D", "E"} or (name == "C" and "roller" in kinds) else _LIGHT_RATED_LIFE


def idler_set_life(stretch: Stretch, belt_speed: float) -> SetLife | None:
    """Life of a set of a stretch; None without known bearings."""
    lives = [(roll_life(stretch, place, belt_speed), load) for place, load in enumerate(stretch.loads)]
    known = [(life.both, load.name, life.weibull_slope) for life, load in lives if life is not None]
    if not known:
        return None
    together = system_life_hours([one[0] for one in known], weibull_slopes=[one[2] for one in known])
    hours, roll, _ = min(known)
    return SetLife(stretch.section, together, roll, hours, len(known) == len(lives), _rated_life(stretch))


def shortest_set_life(stretches: Sequence[Stretch], strand: Strand, belt_speed: float) -> SetLife | None:
    """Life of a strand's sets, the shortest over the rated one, at a belt speed [m/s]; None without known bearings."""
    sets = [stretch for stretch in reversed(stretches) if stretch.strand == strand]
    alike = {(stretch.loads, _rated_life(stretch)): stretch for stretch in sets}
    lives = [idler_set_life(stretch, belt_speed) for stretch in alike.values()]
    return min((life for life in lives if life is not None), key=lambda life: life.hours / life.rated, default=None)
