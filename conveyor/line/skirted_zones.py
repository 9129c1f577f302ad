"""Zones between skirts, sets and scales of loading points as a spec or duty gives them, in SI."""

from __future__ import annotations

from conveyor.laws.preliminary_sizing import SKIRTBOARD_TIME
from conveyor.laws.resistance import acceleration_length
from conveyor.line.optional_quantities import si_or_none
from conveyor.models.belt_scale import BeltScale
from conveyor.models.route import Feeding
from conveyor.units import si


def loading_zone_length(speed: float, gravity: float, point: Feeding | None) -> float:
    """Length of the zone where bulk lands and comes to rest between skirts [m].

    Parameters
    ----------
    speed : float
        Speed of the belt [m/s].
    gravity : float
        [m/s²].
    point : Feeding or None
        The loading point as the duty gives it; as long as skirtboards usually are without.
    """
    if point is None:
        return SKIRTBOARD_TIME * speed
    if point.skirtboards is not None:
        return point.skirted_length
    accelerated = acceleration_length(
        belt_speed=speed, initial_speed=si(point.speed), belt_friction=point.belt_friction, gravity=gravity
    )
    return accelerated + point.skirted_length


def given_set_spacing(point: Feeding) -> float | None:
    """Spacing of the sets at a loading point as given [m]; None without."""
    return si_or_none(point.idler_spacing)


def scale_distance(scale: BeltScale) -> float:
    """Distance of a scale from the tail end of its section [m]."""
    return si(scale.distance)
