"""Parts where bulk is loaded, cleaned off and thrown off, in SI."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.resistance import (
    BULK_ON_BELT_FRICTION,
    acceleration_length,
)
from conveyor.line import usual_parts
from conveyor.line.hopper_outlets import HopperOutlet
from conveyor.line.loop_positions import LoopPosition, LoopPositions
from conveyor.line.optional_quantities import si_or_default, si_or_none
from conveyor.models import Conveyor, Feeding
from conveyor.units import si


@dataclass(frozen=True)
class LoadingPoint:
    """A loading point: position, flow that lands, all flow beyond it [kg/s, m/s, m].

    `section` is the number of the section fed, `comes_with` that of the section whose bulk lands: the same for fresh
    bulk, the one before for a tripper, which lifts the bulk by `lift` [m] before the drives at `before`. `skirtboards`
    is their length, `seal_drag` the drag of their seals [m, N/m]; the bulk falls `drop_height` on sets `idler_spacing`
    apart, lumps of `lump_mass` on springs [m, kg, N/m]; `idler_rating` is the rated load of a set [N]; None not given.
    `hopper` is the outlet over the belt, None where the bulk falls.
    `assumed`: a usual part instead of the spec's, here and in `Scraper` and `BendPulley`.
    """

    name: str
    spot: LoopPosition
    place: str
    section: int
    comes_with: int
    flow: float
    flow_beyond: float
    speed: float
    skirt_length: float
    skirt_width: float
    belt_friction: float
    skirt_friction: float
    lift: float | None
    before: LoopPosition
    skirtboards: float | None
    seal_drag: float
    drop_height: float | None
    lump_mass: float | None
    idler_stiffness: float | None
    idler_spacing: float | None
    idler_rating: float | None
    hopper: HopperOutlet | None = None
    assumed: bool = False

    @property
    def loaded_hopper(self) -> HopperOutlet | None:
        """Hopper with bulk in it."""
        return self.hopper if self.flow > 0.0 else None

    def acceleration_length(self, belt_speed: float, gravity: float, inclination: float = 0.0) -> float:
        """Length in which the bulk reaches the belt's speed [m]; level as ISO 5048 has it, or on a slope [rad]."""
        return acceleration_length(
            belt_speed=belt_speed, initial_speed=self.speed, belt_friction=self.belt_friction, gravity=gravity,
            inclination=inclination,
        )  # fmt: skip

    def boards(self, belt_speed: float, gravity: float) -> float:
        """Length of the skirtboards [m]: as given, else the zone of acceleration and beyond it."""
        return self.skirtboards or self.acceleration_length(belt_speed, gravity) + self.skirt_length


@dataclass(frozen=True)
class Scraper:
    """One or more equal cleaners: width [m], contact area [m²], pressure [Pa], friction and efficiency [-]."""

    kind: str | None
    count: int
    width: float
    area: float
    pressure: float
    friction: float
    efficiency: float
    assumed: bool = False


@dataclass(frozen=True)
class HeadDischarge:
    """Discharge at the head: pulley diameter and fall [m], slope of the belt [rad], frictions [-]."""

    diameter: float
    slope: float
    drop: float
    friction: float
    sliding_friction: float


@dataclass(frozen=True)
class PloughBlade:
    """One or more equal ploughs: width [m], scraping factor [N/m], position."""

    count: int
    spot: LoopPosition
    place: str
    width: float
    scraping_factor: float


def loading_points(conveyor: Conveyor, places: LoopPositions) -> tuple[LoadingPoint, ...]:
    """Loading points of a route, by default the usual one."""
    points, assumed = usual_parts.route_feeding_points(conveyor)
    return tuple(_loading_point(conveyor, point, places, assumed=assumed) for point in points)


def _loading_point(conveyor: Conveyor, point: Feeding, places: LoopPositions, *, assumed: bool) -> LoadingPoint:
    route, flow = conveyor.route, si(conveyor.material.flow)
    spot = places.landing(point.section)
    names = [section.name for section in route.sections]
    fed = 0 if point.section is None else names.index(point.section)
    beyond, share, lift, before = (
        flow * route.flow_shares[names[fed]],
        si_or_default(point.share, 1.0),
        None,
        spot,
    )
    if point is not route.feeding and route.feeds_back(point):
        previous = route.sections[fed - 1]
        share = route.flow_shares[previous.name] if previous.loaded else 0.0
        lift, before = si_or_default(point.tripper_lift, 0.0), places.before("carry", previous.name)
    return LoadingPoint(
        name=f", {point.section or 'first'}" if route.further_feeding else "",
        spot=spot,
        place=places.name(spot),
        section=fed,
        comes_with=fed if lift is None else fed - 1,
        flow=flow * share,
        flow_beyond=beyond,
        speed=si(point.speed),
        skirt_length=si(point.skirt_length),
        skirt_width=si(point.skirt_width),
        belt_friction=point.belt_friction,
        skirt_friction=point.skirt_friction,
        lift=lift,
        before=before,
        skirtboards=si_or_none(point.skirtboards),
        seal_drag=si_or_default(point.seal_drag, 0.0),
        drop_height=si_or_none(point.drop_height),
        lump_mass=si_or_none(point.lump_mass),
        idler_stiffness=si_or_none(point.idler_stiffness),
        idler_spacing=si_or_none(point.idler_spacing),
        idler_rating=si_or_none(point.idler_rating),
        hopper=None
        if point.hopper is None
        else HopperOutlet.of(point.hopper, conveyor, skirt_friction=point.skirt_friction),
        assumed=assumed,
    )


def head_discharge(conveyor: Conveyor) -> HeadDischarge | None:
    """Head discharge, by default over the first head pulley."""
    given, last = conveyor.route.discharge, conveyor.route.sections[-1]
    if given is None:
        return None
    at_head = (pulley.diameter for pulley in usual_parts.route_pulleys(conveyor)[0] if pulley.position == "head")
    return HeadDischarge(
        diameter=si(given.pulley_diameter or next(at_head)),
        slope=math.asin(last.rise / si(last.length)) if given.slope is None else si(given.slope),
        drop=si(given.drop),
        friction=given.friction,
        sliding_friction=given.friction if given.sliding_friction is None else given.sliding_friction,
    )


def bulk_friction(conveyor: Conveyor) -> float:
    """Friction of bulk on the belt [-]."""
    feeding = conveyor.route.feeding
    return BULK_ON_BELT_FRICTION.value if feeding is None else feeding.belt_friction


def belt_scrapers(conveyor: Conveyor) -> tuple[Scraper, ...]:
    """Cleaners of a belt, by default the usual ones."""
    cleaners, assumed = usual_parts.route_cleaners(conveyor)
    return tuple(
        Scraper(
            kind=cleaner.kind,
            count=cleaner.count,
            width=si(cleaner.width),
            area=si(cleaner.width) * si(cleaner.thickness),
            pressure=si(cleaner.pressure),
            friction=cleaner.friction,
            efficiency=si(cleaner.efficiency),
            assumed=assumed,
        )
        for cleaner in cleaners
    )


def plough_blades(conveyor: Conveyor, places: LoopPositions) -> tuple[PloughBlade, ...]:
    """Ploughs of a route."""
    return tuple(
        PloughBlade(
            count=plough.count,
            spot=places.before(plough.position, plough.section),
            place="head" if plough.section is None else f"behind {plough.section}, carry",
            width=si(plough.width),
            scraping_factor=si(plough.scraping_factor),
        )
        for plough in conveyor.route.ploughs
    )
