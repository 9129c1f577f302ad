"""Limits of idler sets that the spec gives: load, slope of axles, distance from resonance; SI."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.errors import RangeError
from conveyor.laws.idler_sets import (
    CEMA_CLASSES,
    CemaClass,
    raised_set_load,
    rated_set_load,
)
from conveyor.laws.pulley import hub_moment, shaft_slope
from conveyor.line.line import Line
from conveyor.line.roll_lives import roll_life
from conveyor.line.stretches import Stretch
from conveyor.line.usual_parts import usual_lump_factor
from conveyor.units import si


@dataclass(frozen=True)
class AxleSlope:
    """Slope of a roll's axle at its bearings, and the allowed one [-]."""

    roll: str
    slope: float
    allowed: float


@dataclass(frozen=True)
class SetLimits:
    """Limits and rated load of a stretch's sets.

    Attributes
    ----------
    cema_class : str or None
        CEMA class of the sets.
    rating : float or None
        Load that a whole set is rated for [N].
    least_class : str or None
        First CEMA class rated for `load`; None without one, or where the spec gives no rating.
    lump_factor : float or None
        Factor on the bulk's load as given, or on that of belt and bulk by lump size, 1 for unknown size; None outside
        the printed table, where `load` is without it.
    load : float
        Load of a set to compare with its rating [N]: with lumps, and the belt's pull on a set raised too high.
    flap_margin : float or None
        Required distance of the rolls' rotation from the belt's natural frequencies [-].
    axle : AxleSlope or None
        Axle closest to its limit or farthest beyond; None where none is given.
    """

    cema_class: CemaClass | None
    rating: float | None
    least_class: CemaClass | None
    lump_factor: float | None
    load: float
    flap_margin: float | None
    axle: AxleSlope | None

    @classmethod
    def of(cls, stretch: Stretch, line: Line, *, tension: float) -> SetLimits:
        """Limits and load of a stretch's sets at the highest belt tension there in steady running [N]."""
        given, belt_width = stretch.idlers, line.belt.width
        usual = usual_lump_factor(line.lump, line.weight_density)  # Sandvik's: of belt and bulk; CEMA's of bulk alone
        lumps, whole = given.lump_factor or usual, given.lump_factor is None and stretch.bulk_mass > 0.0
        of_bulk = lumps or 1.0
        of_belt = of_bulk if whole else 1.0
        load = math.fsum(of_belt * roll.belt_force + of_bulk * roll.bulk_force for roll in stretch.loads)
        load += raised_set_load(max(tension, 0.0), height=raised_height(stretch), spacing=stretch.spacing)
        ratings = {
            name: rating for name in CEMA_CLASSES if (rating := _class_rating(name, stretch, belt_width)) is not None
        }
        rated = given.cema_class is not None or given.rating is not None
        own = None if given.cema_class is None else ratings.get(given.cema_class)
        return cls(
            cema_class=given.cema_class,
            rating=own if given.rating is None else si(given.rating),
            least_class=next((name for name, most in ratings.items() if rated and load <= most), None),
            lump_factor=lumps,
            load=load,
            flap_margin=None if given.flap_margin is None else si(given.flap_margin),
            axle=_steepest_axle(stretch, line.speed),
        )


def raised_height(stretch: Stretch) -> float:
    """Height by which a set of the stretch may be raised over its neighbours [m]."""
    return si(stretch.idlers.raised)


def _class_rating(name: CemaClass, stretch: Stretch, belt_width: float) -> float | None:
    """Rating of a class [N]; None where it has no such set."""
    try:
        return rated_set_load(name, belt_width=belt_width, trough_angle=stretch.trough_angle, rolls=len(stretch.loads))
    except RangeError:
        return None


def _steepest_axle(stretch: Stretch, belt_speed: float) -> AxleSlope | None:
    """Axle closest to its limit; both bearings take the heavier load, on the safe side."""
    slopes = []
    for place, load in enumerate(stretch.loads):
        life, bearing = roll_life(stretch, place, belt_speed), stretch.idlers.roll_at(place).bearing
        if life is None or bearing is None or bearing.axle_diameter is None or bearing.support_distance is None:
            continue
        apart = si(bearing.distance)
        moment = hub_moment(
            2.0 * max(life.heavier, 0.0), bearing_centres=si(bearing.support_distance), hub_centres=apart
        )
        slope = shaft_slope(moment, hub_centres=apart, diameter=si(bearing.axle_diameter))
        slopes.append(AxleSlope(load.name, slope, si(bearing.allowed_slope)))
    return max(slopes, key=lambda axle: axle.slope / axle.allowed, default=None)
