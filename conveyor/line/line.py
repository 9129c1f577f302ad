"""A conveyor in SI numbers, frozen; above this layer no quantity carries a unit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.indentation import Support
from conveyor.laws.belt_strength import Condition, fall_severity, least_cover
from conveyor.laws.motion import START_FACTOR, reduced_mass, typical_reduced_mass
from conveyor.laws.preliminary_sizing import wear_addition
from conveyor.laws.pulley import Keyway, Steel
from conveyor.laws.resistance import (
    BULK_ON_BELT_FRICTION,
    CARCASS_BENDING,
    acceleration_length,
    idler_rotation_resistance,
)
from conveyor.laws.take_up import LOOP_STRANDS, TRAVEL_RESERVE
from conveyor.laws.tension import usual_stiffness
from conveyor.laws.wind import AIR_DENSITY, WIND_LIFT, wind_force
from conveyor.line import usual_parts
from conveyor.line.drive_scenarios import StarterUnit
from conveyor.line.loop_positions import LoopPosition, LoopPositions
from conveyor.line.roll_drags import RollDrags, roll_drags
from conveyor.line.roll_kinds import RollKind
from conveyor.line.strands import LoopShape, Strands
from conveyor.line.stretches import RouteSection, Stretch
from conveyor.models import Calculation, Conveyor, Drive, DrivePulley, Feeding, Pulley
from conveyor.models.calculation_methods import Cema
from conveyor.models.part_conflicts import drive_diameter
from conveyor.units import Quantity, si
from conveyor.units.unit_systems import trade_of

Array = NDArray[np.float64]

_LEAST_DRIVEN_WRAP = math.radians(90.0)
"""Least wrap of a driven pulley [rad]; general knowledge."""
_MOST_DRIVEN_WRAP = math.radians(270.0)
"""Largest wrap of one driven pulley [rad], a larger one counts as several pulleys; general knowledge."""


@dataclass(frozen=True)
class CoverRequirement:
    """Thickness of a cover and its requirement [m]: `least` over the carcass, `wear` in addition."""

    cover: str
    thickness: float
    least: float
    wear: float


@dataclass(frozen=True)
class BeltBody:
    """The belt: width, total thickness, carcass and covers (top, bottom) [m].

    Strength, rating and stiffness are per width [N/m], None not given; `relaxing` is the relaxing stiffness over the
    lasting one and its relaxation time [-, s].
    """

    width: float
    thickness: float
    line_mass: float
    carcass: str
    carcass_thickness: float
    cover_thicknesses: tuple[float, float]
    strength: float | None
    rating: float | None
    stiffness: float | None
    splice_strength: float | None
    splice_making: Condition
    duty: Condition
    permanent_stretch: float | None
    retardation: float | None
    bending: float
    """D' of the carcass per width [N m]."""
    bending_loss: float
    relaxing: tuple[float, float] | None = None
    bears: tuple[float | None, float | None] = (None, None)
    """Lowest and highest temperature [K]; None not given."""
    covers: tuple[CoverRequirement, ...] = ()
    """Empty where the spec gives no wear."""

    @property
    def tensile_stiffness(self) -> float | None:
        """Per width [N/m]: as given, else a usual multiple of strength or rating; None without any."""
        if self.stiffness is not None:
            return self.stiffness
        return usual_stiffness(self.strength, rating=self.rating, carcass=self.carcass)

    @property
    def steel_cord(self) -> bool:
        """True for a steel-cord carcass."""
        return self.carcass == "steel cord"


@dataclass(frozen=True)
class LoadingPoint:
    """A loading point: position, flow that lands, all flow beyond it [kg/s, m/s, m].

    `section` is the number of the section fed, `comes_with` that of the section whose bulk lands: the same for fresh
    bulk, the one before for a tripper, which lifts the bulk by `lift` [m] before the drives at `before`. `skirtboards`
    is their length, `seal_drag` the drag of their seals [m, N/m]; the bulk falls `drop_height` on sets `idler_spacing`
    apart, lumps of `lump_mass` on springs [m, kg, N/m]; `idler_rating` is the rated load of a set [N]; None not given.
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
    assumed: bool = False

    def acceleration_length(self, belt_speed: float, gravity: float) -> float:
        """Length in which the bulk reaches the belt's speed [m]."""
        return acceleration_length(
            belt_speed=belt_speed, initial_speed=self.speed, belt_friction=self.belt_friction, gravity=gravity
        )

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


@dataclass(frozen=True)
class BendPulley:
    """A pulley that bends the belt: diameters, distances of bearings and hubs [m], mass [kg], wrap [rad], rating [N].

    `pull_angle` is between the belt's pull and straight down [rad], `bearing_life` the required one [s],
    `allowed_pressure` that of its lagging [Pa]; None not given. `driven`: it has a drive.
    """

    name: str
    position: str
    spot: LoopPosition
    place: str
    diameter: float
    shaft_diameter: float
    mass: float
    wrap_angle: float
    driven: bool
    pull_angle: float
    bearing_centres: float | None
    hub_centres: float | None
    hub_diameter: float
    shaft_steel: Steel | None
    keyway: Keyway
    bearing_rating: float | None
    bearing_life: float | None
    allowed_pressure: float | None
    assumed: bool = False


@dataclass(frozen=True)
class TransitionZone:
    """Transition between trough and pulley: length [m], None not given; pulley height over trough depth [-]."""

    end: str
    length: float | None
    pulley_height: float


@dataclass(frozen=True)
class DriveParts:
    """Parts of a drive; None not given.

    Number of `motors` and their rated `rotation` [1/s], gear `ratio`, rated torque of the `backstop` [N m], required
    `starts` [1/h], `loss` of pulley diameter [m], mass of the brake's `disc` [kg] and the `heat` it may take [J].
    """

    motors: int
    rotation: float | None
    ratio: float | None
    backstop: float | None
    starts: float | None
    loss: float | None
    disc: float | None
    heat: float | None


@dataclass(frozen=True)
class DriveUnit:
    """A drive pulley with its motors and its brake: share of the force [-], wrap [rad], W, N, kg, radius [m].

    `mass_given`: rotating masses are the spec's, not typical of its power; `starter` and `backstop` are None where not
    given, `parts` where the spec gives those of no drive.
    """

    name: str
    spot: LoopPosition
    share: float
    friction: float
    wrap_angle: float
    power: float | None
    brake: float | None
    reduced_mass: float
    mass_given: bool
    radius: float | None
    starter: StarterUnit | None = None
    backstop: bool | None = None
    parts: DriveParts | None = None


@dataclass(frozen=True)
class TakeUpUnit:
    """The take-up; `spot` is None on the slack side of the drives at the first one's position.

    `behind` then tells that side, behind or before the drives, under the spec's own load; None if not yet calculated.
    `tension` is its setting [N], None for the least needed; `reserve` of its travel [-]; mass of its `carriage` [kg];
    `winch`: speed [m/s], dead band of tension [-] and run-up [s] or None; available `travel` [m].
    """

    kind: str
    spot: LoopPosition | None
    tension: float | None
    reeving: float
    strands: int
    reserve: float
    carriage: float = 0.0
    winch: tuple[float, float, float | None] | None = None
    travel: float | None = None
    behind: bool | None = None

    @property
    def keeps_length(self) -> bool:
        """True if it fixes the belt's length, and so the mean tension of the loop, not the local tension."""
        return self.kind in {"fixed", "screw", "locked winch"}

    @property
    def on_slack_side(self) -> bool:
        """True if it fixes the tension on the slack side of the drives, whichever side that is."""
        return self.spot is None and not self.keeps_length

    def pulls(self, pulley: BendPulley) -> bool:
        """True for a pulley on its carriage, with the take-up's tension on both sides."""
        return pulley.position == "take-up" and not self.keeps_length


@dataclass(frozen=True)
class CemaFactors:
    """Factors of the classic CEMA form: Ky, Kt, Cs [-], Ai, Tp (None: by table), accessories [N], hs [m], N/m."""

    flexure: float
    temperature: float
    idler_friction: float
    skirt_factor: float
    skirt_depth: float
    seals: float
    cleaner: float
    plough: float
    pulleys: float | None
    drive_pulleys: float
    accessories: float


@dataclass(frozen=True, eq=False)
class Line:
    """A conveyor in SI: m, kg, s, N, Pa, W, rad. Rubber and temperature are not in it (`line.covers`).

    Attributes
    ----------
    strands : Strands
        The sections, and their stretches with the loads of their rolls.
    roll_drags : tuple of tuple of float
        Drag of each roll of one set at its rim, of every stretch [N].
    speed, flow, density, gravity : float
        Of the belt, the bulk, the site.
    lump : float or None
        Largest size of the bulk [m], where the spec says it.
    drives : tuple of DriveUnit
        The first one first.
    bulk_on_belt : float
        Friction of bulk on belt μ1 [-].
    efficiency, regeneration, mains_efficiency : float
        Motor shaft to belt, belt to motor shaft, mains to motor shaft [-].
    secondary : {"itemised", "C"}
        Secondary resistances one by one, or by the length coefficient.
    support, rtol, softened, flexure_share
        Support and tolerance of the contacts; True if strain softens the rubber; share of flexure or None [-].
    carryback : tuple of float or None
        Carryback before the cleaners, and the most allowed behind them [kg/m²].
    flexure_source : str
        Source of the flexure for reports.
    us_sizes : bool
        True if motors and pulleys are suggested from the US series.
    wind_speed : float or None
        Gust that the empty belt must withstand [m/s].
    """

    strands: Strands
    roll_drags: tuple[tuple[float, ...], ...]
    belt: BeltBody
    speed: float
    flow: float
    density: float
    lump: float | None
    gravity: float
    loading: tuple[LoadingPoint, ...]
    scrapers: tuple[Scraper, ...]
    carryback: tuple[float | None, float | None]
    discharge: HeadDischarge | None
    ploughs: tuple[PloughBlade, ...]
    pulleys: tuple[BendPulley, ...]
    transitions: tuple[TransitionZone, ...]
    drives: tuple[DriveUnit, ...]
    take_up: TakeUpUnit
    places: LoopPositions
    bulk_on_belt: float
    efficiency: float
    regeneration: float
    mains_efficiency: float
    start_factor: float | None
    torque_curve: tuple[tuple[float, float], ...]
    brake_delay: float
    stop_deceleration: float | None
    coast_time: float | None
    least_friction: float
    secondary: str
    friction_factor: float
    flexure_share: float | None
    flexure_source: str
    cema: CemaFactors | None
    support: Support
    rtol: float
    softened: bool
    us_sizes: bool
    wind_speed: float | None

    @classmethod
    def of(cls, conveyor: Conveyor, strands: Strands | None = None, drags: RollDrags | None = None) -> Line:
        """Return the SI view of a conveyor.

        Parameters
        ----------
        conveyor : Conveyor
            The spec.
        strands : Strands, optional
            Its strands, if known.
        drags : sequence, optional
            Drags of the rolls of each strand, if known.

        Raises
        ------
        InputError
            A law of roll drag does not hold at a load.
        """
        drive, calculation = conveyor.drive, conveyor.calculation
        places, strands = LoopPositions(conveyor), strands or Strands.of(conveyor)
        carry, back = drags or [roll_drags(conveyor, strand) for strand in strands.each]
        efficiency = si(drive.efficiency)
        return cls(
            strands=strands,
            roll_drags=(*carry, *back),
            belt=_belt_body(conveyor),
            speed=si(conveyor.belt.speed),
            flow=si(conveyor.material.flow),
            density=si(conveyor.material.density),
            lump=None if conveyor.belt.wear is None else si(conveyor.belt.wear.lump),
            gravity=si(calculation.gravity),
            loading=_loading_points(conveyor, places),
            scrapers=_belt_scrapers(conveyor),
            carryback=(_si_or_none(conveyor.route.carryback), _si_or_none(conveyor.route.carryback_allowed)),
            discharge=_head_discharge(conveyor),
            ploughs=_plough_blades(conveyor, places),
            pulleys=_bend_pulleys(conveyor, places),
            transitions=_transition_zones(conveyor),
            drives=_drive_units(conveyor, places),
            take_up=_take_up_unit(conveyor, places),
            places=places,
            bulk_on_belt=_belt_friction(conveyor),
            efficiency=efficiency,
            regeneration=_si_or_default(drive.regeneration_efficiency, efficiency),
            mains_efficiency=drive.mains_efficiency,
            start_factor=drive.start_factor,
            torque_curve=_torque_curve(drive),
            brake_delay=si(drive.brake_delay),
            stop_deceleration=_si_or_none(drive.stop_deceleration),
            coast_time=_si_or_none(drive.coast_time),
            least_friction=si(drive.least_friction),
            secondary=calculation.secondary,
            friction_factor=calculation.friction_factor,
            flexure_share=_si_or_none(calculation.flexure_share),
            flexure_source=_flexure_source(calculation),
            cema=_cema_factors(calculation.cema),
            support=calculation.support,
            rtol=calculation.rtol,
            softened=calculation.strain != "off",
            us_sizes=trade_of(conveyor.report.units) == "US",
            wind_speed=_si_or_none(conveyor.ambient.wind_speed),
        )

    @property
    def uplift(self) -> float:
        """Lift of the wind on the empty belt [N/m]."""
        return wind_force(
            self.wind_speed or 0.0,
            height=self.belt.width,
            length=1.0,
            drag=WIND_LIFT.value,
            air_density=AIR_DENSITY,
        )

    @property
    def count(self) -> int:
        """Number of sections n."""
        return len(self.sections)

    @property
    def start_over_steady(self) -> float:
        """Force of a controlled start over the steady one [-]: as given, else usual."""
        return START_FACTOR.value if self.start_factor is None else self.start_factor

    @property
    def brakes(self) -> list[float]:
        """Brake force of every drive at the belt [N]; 0 where it has none."""
        return [drive.brake or 0.0 for drive in self.drives]

    @property
    def has_tension_coupling(self) -> bool:
        """True if tension changes the loads of rolls: on curves, or with a yielding belt."""
        return self.support == "belt" or any(section.curved for section in self.sections)

    @property
    def length(self) -> float:
        """Length of one strand along the belt [m]."""
        return math.fsum(section.length for section in self.sections)

    @property
    def sections(self) -> tuple[RouteSection, ...]:
        """Sections from the tail."""
        return self.strands.sections

    @property
    def stretches(self) -> tuple[Stretch, ...]:
        """Carry strand from the tail, then return strand from the head: 2n of n sections."""
        return self.strands.stretches

    @property
    def kinds(self) -> tuple[RollKind, ...]:
        """Groups of rolls that share a contact."""
        return self.strands.kinds

    @cached_property
    def rotation(self) -> Array:
        """Drag of all rolls of every stretch [N], shape (2n,)."""
        whole = (
            idler_rotation_resistance(math.fsum(drags), n_rolls=1, spacing=s.spacing, length=s.length)
            for s, drags in zip(self.stretches, self.roll_drags, strict=True)
        )
        return np.fromiter(whole, float)

    @property
    def loop(self) -> LoopShape:
        """The stretches as the belt meets them from the head."""
        return self.strands.loop


def _flexure_source(calculation: Calculation) -> str:
    if calculation.flexure_share is not None:
        return "share of the main resistance, calculation.flexure_share"
    belt = "; the belt's is in the indentation" if calculation.support == "belt" else ""
    if calculation.flexure is not None:
        return f"calculation.flexure, laws{belt}"
    return f"load x sag of the set x coefficient of one measured site, flagged default{belt}"


def _si_or_none(value: Quantity | None) -> float | None:
    return None if value is None else si(value)


def _si_or_default(value: Quantity | None, default: float) -> float:
    return default if value is None else si(value)


def _belt_body(conveyor: Conveyor) -> BeltBody:
    belt, carcass, width = conveyor.belt, conveyor.belt.carcass, si(conveyor.belt.width)
    parts = (belt.top_cover.thickness, belt.bottom_cover.thickness, carcass.thickness)
    return BeltBody(
        width=width,
        thickness=math.fsum(map(si, parts)),
        line_mass=belt.line_mass,
        carcass=carcass.kind,
        carcass_thickness=si(carcass.thickness),
        cover_thicknesses=(si(belt.top_cover.thickness), si(belt.bottom_cover.thickness)),
        strength=_si_or_none(carcass.strength),
        rating=_si_or_none(carcass.rating),
        stiffness=_si_or_none(carcass.stiffness),
        splice_strength=_si_or_none(carcass.splice_strength),
        splice_making=carcass.splice_making,
        duty=carcass.duty,
        permanent_stretch=_si_or_none(carcass.permanent_stretch),
        retardation=_si_or_none(carcass.retardation_time),
        bending=CARCASS_BENDING.value if carcass.bending_stiffness is None else si(carcass.bending_stiffness) / width,
        bending_loss=carcass.bending_loss,
        relaxing=None
        if carcass.relaxing_stiffness is None or carcass.relaxation_time is None
        else (si(carcass.relaxing_stiffness), si(carcass.relaxation_time)),
        bears=(_si_or_none(belt.lowest_temperature), _si_or_none(belt.highest_temperature)),
        covers=_cover_requirements(conveyor),
    )


def _cover_requirements(conveyor: Conveyor) -> tuple[CoverRequirement, ...]:
    """Required covers where the spec gives the wear."""
    belt = conveyor.belt
    if belt.wear is None:
        return ()
    feeding = conveyor.route.feeding
    drop = 0.0 if feeding is None or feeding.drop_height is None else si(feeding.drop_height)
    least = least_cover(si(belt.carcass.thickness), steel_cord=belt.carcass.kind == "steel cord")
    wear = wear_addition(
        lump=si(belt.wear.lump),
        density=si(conveyor.material.density),
        round_time=2.0 * conveyor.route.length / si(belt.speed),
        abrasiveness=belt.wear.abrasiveness,
        loading=belt.wear.loading or fall_severity(drop),
    )
    return (
        CoverRequirement("top", si(belt.top_cover.thickness), least, wear),
        CoverRequirement("bottom", si(belt.bottom_cover.thickness), least, 0.0),
    )


def _loading_points(conveyor: Conveyor, places: LoopPositions) -> tuple[LoadingPoint, ...]:
    points, assumed = usual_parts.route_feeding_points(conveyor)
    return tuple(_loading_point(conveyor, point, places, assumed=assumed) for point in points)


def _loading_point(conveyor: Conveyor, point: Feeding, places: LoopPositions, *, assumed: bool) -> LoadingPoint:
    route, flow = conveyor.route, si(conveyor.material.flow)
    spot = places.landing(point.section)
    names = [section.name for section in route.sections]
    fed = 0 if point.section is None else names.index(point.section)
    beyond, share, lift, before = (
        flow * route.flow_shares[names[fed]],
        _si_or_default(point.share, 1.0),
        None,
        spot,
    )
    if point is not route.feeding and route.feeds_back(point):
        previous = route.sections[fed - 1]
        share = route.flow_shares[previous.name] if previous.loaded else 0.0
        lift, before = _si_or_default(point.tripper_lift, 0.0), places.before("carry", previous.name)
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
        skirtboards=_si_or_none(point.skirtboards),
        seal_drag=_si_or_default(point.seal_drag, 0.0),
        drop_height=_si_or_none(point.drop_height),
        lump_mass=_si_or_none(point.lump_mass),
        idler_stiffness=_si_or_none(point.idler_stiffness),
        idler_spacing=_si_or_none(point.idler_spacing),
        idler_rating=_si_or_none(point.idler_rating),
        assumed=assumed,
    )


def _head_discharge(conveyor: Conveyor) -> HeadDischarge | None:
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


def _belt_friction(conveyor: Conveyor) -> float:
    feeding = conveyor.route.feeding
    return BULK_ON_BELT_FRICTION.value if feeding is None else feeding.belt_friction


def _belt_scrapers(conveyor: Conveyor) -> tuple[Scraper, ...]:
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


def _plough_blades(conveyor: Conveyor, places: LoopPositions) -> tuple[PloughBlade, ...]:
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


def _bend_pulleys(conveyor: Conveyor, places: LoopPositions) -> tuple[BendPulley, ...]:
    pulleys, assumed = usual_parts.route_pulleys(conveyor)
    driven = _driven_pulleys(conveyor, pulleys)
    return tuple(
        replace(_bend_pulley(conveyor, pulley, places, driven=i in driven), assumed=assumed)
        for i, pulley in enumerate(pulleys)
    )


def _driven_pulleys(conveyor: Conveyor, pulleys: Sequence[Pulley]) -> frozenset[int]:
    """Numbers of the driven pulleys: at each drive's position the most wrapped, as many as its wrap needs."""
    driven: set[int] = set()
    for place in {(drive.position, drive.section) for drive in conveyor.drive.pulleys}:
        wraps = [si(d.wrap_angle) for d in conveyor.drive.pulleys if (d.position, d.section) == place]
        count = sum(math.ceil(wrap / _MOST_DRIVEN_WRAP) for wrap in wraps)
        beside = [
            (-si(pulley.wrap_angle), -si(pulley.diameter), i)
            for i, pulley in enumerate(pulleys)
            if (pulley.position, pulley.section) == place and si(pulley.wrap_angle) >= _LEAST_DRIVEN_WRAP
        ]
        driven.update(i for _, _, i in sorted(beside)[:count])
    return frozenset(driven)


def _bend_pulley(conveyor: Conveyor, pulley: Pulley, places: LoopPositions, *, driven: bool) -> BendPulley:
    return BendPulley(
        name=pulley.name,
        position=pulley.position,
        spot=_pulley_position(conveyor, pulley, places, driven=driven),
        place=pulley.position if pulley.section is None else f"behind {pulley.section}, {pulley.position}",
        diameter=si(pulley.diameter),
        shaft_diameter=si(pulley.shaft_diameter),
        mass=si(pulley.mass),
        wrap_angle=si(pulley.wrap_angle),
        driven=driven,
        pull_angle=si(pulley.pull_angle),
        bearing_centres=_si_or_none(pulley.bearing_centres),
        hub_centres=_si_or_none(pulley.hub_centres),
        hub_diameter=_si_or_default(pulley.hub_shaft_diameter, si(pulley.shaft_diameter)),
        shaft_steel=pulley.shaft_steel,
        keyway=pulley.keyway,
        bearing_rating=_si_or_none(pulley.bearing_rating),
        bearing_life=_si_or_none(pulley.bearing_life),
        allowed_pressure=_si_or_none(pulley.lagging_pressure),
    )


def _transition_zones(conveyor: Conveyor) -> tuple[TransitionZone, ...]:
    """Transitions at tail and head that the spec gives."""
    given = {"tail": conveyor.route.tail_transition, "head": conveyor.route.head_transition}
    return tuple(
        TransitionZone(end, _si_or_none(zone.length), _si_or_default(zone.pulley_height, 0.0))
        for end, zone in given.items()
        if zone is not None
    )


def _pulley_position(conveyor: Conveyor, pulley: Pulley, places: LoopPositions, *, driven: bool) -> LoopPosition:
    """Position of a pulley; one next to a driven one is behind the drive at the head, before it elsewhere."""
    if pulley.position == "take-up":
        return places.take_up(conveyor.route.take_up)
    at = {(drive.position, drive.section): places.drive(drive) for drive in conveyor.drive.pulleys}
    drive = at.get((pulley.position, pulley.section))
    if drive is not None and driven:
        return drive
    if drive is not None and pulley.position == "head":
        return places.behind("head", None)
    return places.before(pulley.position, pulley.section)


def _drive_units(conveyor: Conveyor, places: LoopPositions) -> tuple[DriveUnit, ...]:
    pulleys = conveyor.drive.pulleys
    names = conveyor.drive.names
    return tuple(
        DriveUnit(
            name=name,
            spot=places.drive(pulley),
            share=share,
            friction=pulley.friction,
            wrap_angle=si(pulley.wrap_angle),
            power=_si_or_none(pulley.installed_power),
            brake=_si_or_none(pulley.brake_force),
            reduced_mass=_reduced_mass(conveyor, pulley),
            mass_given=pulley.reduced_mass is not None or pulley.inertia is not None,
            radius=_drive_radius(conveyor, pulley),
            starter=None if pulley.starter is None else StarterUnit.of(pulley.starter),
            backstop=pulley.backstop,
            parts=_drive_parts(pulley) if any(other.judged for other in pulleys) else None,
        )
        for name, pulley, share in zip(names, pulleys, _drive_shares(pulleys), strict=True)
    )


def _drive_parts(pulley: DrivePulley) -> DriveParts:
    return DriveParts(
        motors=pulley.motors,
        rotation=None if pulley.motor_speed is None else si(pulley.motor_speed),
        ratio=pulley.gear_ratio,
        backstop=_si_or_none(pulley.backstop_torque),
        starts=pulley.starts_per_hour,
        loss=_si_or_none(pulley.diameter_loss),
        disc=_si_or_none(pulley.brake_disc),
        heat=_si_or_none(pulley.brake_heat),
    )


def _drive_radius(conveyor: Conveyor, pulley: DrivePulley) -> float | None:
    diameter = drive_diameter(conveyor, pulley)
    return None if diameter is None else 0.5 * si(diameter)


def _reduced_mass(conveyor: Conveyor, pulley: DrivePulley) -> float:
    """Rotating masses of a drive at the belt [kg]; nothing of a drive of unknown power."""
    if pulley.reduced_mass is not None:
        return si(pulley.reduced_mass)
    radius = _drive_radius(conveyor, pulley)
    if pulley.inertia is not None and pulley.gear_ratio is not None and radius is not None:
        return reduced_mass(si(pulley.inertia), radius=radius, ratio=pulley.gear_ratio)
    if pulley.installed_power is None:
        return 0.0
    return typical_reduced_mass(si(pulley.installed_power), belt_speed=si(conveyor.belt.speed))


def _torque_curve(drive: Drive) -> tuple[tuple[float, float], ...]:
    """Torque over the rated one against speed over the rated one, to full speed; empty if not given."""
    if drive.torque_factor is not None:
        return ((0.0, drive.torque_factor), (1.0, drive.torque_factor))
    points = [(si(point.speed), point.torque) for point in drive.torque_curve]
    return tuple(points if not points or points[-1][0] == 1.0 else [*points, (1.0, points[-1][1])])


def _drive_shares(pulleys: tuple[DrivePulley, ...]) -> list[float]:
    """Share of each drive in the whole force: as given, else by installed power."""
    if any(pulley.share is not None for pulley in pulleys):
        return [_si_or_default(pulley.share, 0.0) for pulley in pulleys]
    if len(pulleys) == 1:
        return [1.0]
    powers = [_si_or_default(pulley.installed_power, 0.0) for pulley in pulleys]
    return [power / math.fsum(powers) for power in powers]


def _take_up_unit(conveyor: Conveyor, places: LoopPositions) -> TakeUpUnit:
    given = conveyor.route.take_up
    if given is None:
        return TakeUpUnit("slack side", None, None, 1.0, LOOP_STRANDS, TRAVEL_RESERVE.value)
    tension = _si_or_none(given.tension)
    if given.mass is not None:
        # take_up_mass solved for the tension
        tension = si(given.mass) * given.reeving * si(conveyor.calculation.gravity) / given.strands
    spot = None if given.position == "drive" else places.take_up(given)
    winch = None
    if given.winch_speed is not None:
        winch = si(given.winch_speed), si(given.winch_band), _si_or_none(given.winch_run_up)
    return TakeUpUnit(
        given.kind,
        spot,
        tension,
        given.reeving,
        given.strands,
        si(given.reserve),
        si(given.carriage_mass),
        winch,
        _si_or_none(given.travel),
    )


def _cema_factors(factors: Cema | None) -> CemaFactors | None:
    if factors is None:
        return None
    return CemaFactors(
        flexure=factors.flexure_factor,
        temperature=factors.temperature_factor,
        idler_friction=si(factors.idler_friction),
        skirt_factor=factors.skirt_factor or 0.0,
        skirt_depth=_si_or_default(factors.skirt_depth, 0.0),
        seals=si(factors.skirt_seals),
        cleaner=si(factors.cleaner_friction),
        plough=si(factors.plough_friction),
        pulleys=_si_or_none(factors.pulley_friction),
        drive_pulleys=si(factors.drive_pulley_friction),
        accessories=si(factors.accessories),
    )
