"""A conveyor cut into stretches, one a section and strand: geometry, masses, loads of the rolls; SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from conveyor.errors import MessageQuantity, NoSolutionError
from conveyor.laws.loading import RollLoad, bulk_line_mass
from conveyor.laws.misalignment import MISALIGNMENT, misalignment_friction
from conveyor.laws.resistance import BED_FRICTION
from conveyor.laws.tension import sag_tension
from conveyor.line.curve_sets import CurveSets, HorizontalCurve, sets_on_curve
from conveyor.line.flexure_law import FlexureLaw
from conveyor.line.set_loads import SetLoads
from conveyor.models import Conveyor, IdlerSet, Section
from conveyor.models.slider_beds import SliderBed
from conveyor.units import si

Strand = Literal["carry", "return"]
STRANDS: tuple[Strand, Strand] = ("carry", "return")
CurveValues = Mapping[tuple[str, Strand], float]
"""Values by section and strand on curves."""


@dataclass(frozen=True)
class CurveLoads:
    """Effect of tension on curves: mass pressing on the rolls [kg/m], inward drift of the belt [m], pull on a pipe [N].

    A negative mass lifts, a negative drift is outward. `pulls` are forces on one panel around a pipe, down and to the
    right in running direction of the carry strand, of which pressing and drift have none.
    """

    pressing: CurveValues = field(default_factory=dict)
    drift: CurveValues = field(default_factory=dict)
    pulls: Mapping[tuple[str, Strand], tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class PlateBed:
    """Plate on which the carry strand slides: name of the pair, friction [-], allowed belt speed [m/s] or None."""

    name: str
    friction: float
    allowed_speed: float | None
    source: str

    @classmethod
    def of(cls, bed: SliderBed) -> PlateBed:
        """Plate of a section, SI."""
        pair = f"{bed.underside} on {bed.surface}"
        allowed = None if bed.allowed_speed is None else si(bed.allowed_speed)
        source = "given" if bed.friction is not None else BED_FRICTION[bed.surface, bed.underside].source
        return cls(pair, bed.friction_of_belt, allowed, source)


@dataclass(frozen=True)
class RouteSection:
    """A section of the route: length and rise in running direction of the carry strand [m], its curves.

    `radius` is positive on a convex curve, negative on a concave one, infinite on the straight [m]; `spacing` is the
    section's own of each strand's sets [m], or None; `bed` is the plate of the carry strand, or None.
    """

    name: str
    length: float
    rise: float
    loaded: bool
    spacing: Mapping[Strand, float | None]
    curve: str | None
    radius: float
    horizontal: HorizontalCurve | None
    bed: PlateBed | None = None

    @property
    def curved(self) -> bool:
        """True on a vertical or horizontal curve."""
        return self.curve is not None or self.horizontal is not None

    @property
    def rightward_radius(self) -> float:
        """Radius of the horizontal curve, positive to the right, negative to the left; infinite on the straight [m]."""
        if self.horizontal is None:
            return math.inf
        return math.copysign(self.horizontal.radius, 1.0 if self.horizontal.side == "right" else -1.0)

    @property
    def bend_radius(self) -> float:
        """Radius of vertical and horizontal curve together, 1/r² = 1/r_v² + 1/r_h² [m]; infinite on the straight."""
        bent = math.hypot(1.0 / self.radius, 1.0 / self.rightward_radius)
        return 1.0 / bent if bent > 0.0 else math.inf

    @property
    def steepest(self) -> float:
        """Slope at the steeper end of its vertical curve, up or down [rad]."""
        return abs(math.asin(self.rise / self.length)) + 0.5 * self.length / abs(self.radius)


def route_sections(conveyor: Conveyor) -> tuple[RouteSection, ...]:
    """Sections of a route from the tail, SI."""
    return tuple(map(_route_section, conveyor.route.sections))


def _route_section(section: Section) -> RouteSection:
    return RouteSection(
        name=section.name,
        length=si(section.length),
        rise=section.rise,
        loaded=section.loaded,
        spacing={
            "carry": None if section.carry_spacing is None else si(section.carry_spacing),
            "return": None if section.return_spacing is None else si(section.return_spacing),
        },
        curve=section.curve,
        radius=section.signed_radius,
        horizontal=HorizontalCurve.of(section),
        bed=None if section.bed is None else PlateBed.of(section.bed),
    )


@dataclass(frozen=True)
class Stretch:
    """One section of one strand, SI, in running direction of that strand.

    Attributes
    ----------
    section : str
        Name of the section.
    strand : {"carry", "return"}
        Which strand.
    length, rise : float
        Along the belt, and upward in running direction [m].
    spacing : float
        Of the idler sets [m].
    idlers : IdlerSet
        The sets, as the spec has them.
    trough_angle, tilt_angle, roll_length : float
        Of the sets [rad, rad, m].
    radii : tuple of float
        Of each roll of a set [m].
    belt_mass, bulk_mass : float
        m'_belt, m'_bulk [kg/m].
    loads : tuple of RollLoad
        Load of each roll of one set.
    least_tension : float
        Tension that limits the sag between the sets as specified [N]; 0 on a plate, where nothing sags.
    set_mass, rim_mass : float
        Rotating mass of one set, and its mass reduced to the rim [kg].
    misalignment : tuple of float
        Drag of each roll of a set by misalignment over its load [-].
    span_flexure : float or None
        Flexure of belt and bulk over one span [N]; None where it is a share of the main resistance.
    turn : CurveSets or None
        Sets on a horizontal curve, without a pipe.
    bed : PlateBed or None
        Plate that carries the belt instead of sets, which then are none: no rolls, no sag.
    """

    section: str
    strand: Strand
    length: float
    rise: float
    spacing: float
    idlers: IdlerSet
    trough_angle: float
    tilt_angle: float
    roll_length: float
    radii: tuple[float, ...]
    belt_mass: float
    bulk_mass: float
    loads: tuple[RollLoad, ...]
    least_tension: float
    set_mass: float
    rim_mass: float
    misalignment: tuple[float, ...]
    span_flexure: float | None = None
    turn: CurveSets | None = None
    bed: PlateBed | None = None

    @property
    def inclination(self) -> float:
        """Slope angle δ [rad]."""
        return math.asin(self.rise / self.length)

    @property
    def closed(self) -> bool:
        """True if rolls hold the belt from all sides, as a pipe."""
        return self.idlers.shape.closed

    @property
    def sets(self) -> float:
        """Number of idler sets, a broken number allowed; none on a plate."""
        return 0.0 if self.bed is not None else self.length / self.spacing

    @property
    def line_mass(self) -> float:
        """m'_belt + m'_bulk [kg/m]."""
        return self.belt_mass + self.bulk_mass


def strand_stretches(
    conveyor: Conveyor, sections: Sequence[RouteSection], strand: Strand, acting: CurveLoads
) -> tuple[Stretch, ...]:
    """Stretches of a strand in running direction, SI, under the loads of tension on curves."""
    made = _StretchBuilder(conveyor, strand, acting)
    along = sections if strand == "carry" else reversed(sections)
    return tuple(made.stretch(section) for section in along)


def masses_on_rolls(
    belt_mass: float, bulk_mass: float, pressing: float, *, radius: float, where: str
) -> tuple[float, float]:
    """Masses of belt and bulk as they press on the rolls of a vertical curve [kg/m].

    A concave curve's negative mass relieves the belt first, then the bulk; the sum is kept.

    Raises
    ------
    NoSolutionError
        The belt lifts off with its bulk.
    """
    belt, whole = belt_mass + pressing, belt_mass + bulk_mass
    if bulk_mass + belt <= 0.0:
        needed = radius * -pressing / whole
        raise NoSolutionError(
            "the belt lifts off in {}: on its concave curve of {} the tension pulls up like {}, belt and bulk are {}; "
            "choose a curve_radius beyond {} (route.sections), or less tension",
            where,
            MessageQuantity(radius, "length", f"{radius:.4g} m"),
            *(MessageQuantity(each, "line mass", f"{each:.4g} kg/m") for each in (-pressing, whole)),
            MessageQuantity(needed, "length", f"{needed:.4g} m"),
        )
    return (belt, bulk_mass) if belt >= 0.0 else (0.0, bulk_mass + belt)


def misalignment_angle(conveyor: Conveyor, idlers: IdlerSet) -> float:
    """Standard deviation of the angles of the sets of a strand from square to the belt [rad]."""
    given = idlers.misalignment
    return MISALIGNMENT[conveyor.site].value if given is None else si(given)


def _misalignment_frictions(conveyor: Conveyor, idlers: IdlerSet) -> tuple[float, ...]:
    """Drag of each roll of a set by misalignment over its load [-]."""
    angle = misalignment_angle(conveyor, idlers)
    turns = idlers.shape.roll_turns()
    frictions = {turn: misalignment_friction(angle * turn) for turn in turns}
    return tuple(frictions[turn] for turn in turns)


class _StretchBuilder:
    """Builds the stretches of a strand from the data they share."""

    def __init__(self, conveyor: Conveyor, strand: Strand, acting: CurveLoads) -> None:
        self.strand, self.acting, self.conveyor = strand, acting, conveyor
        self.carrying = strand == "carry"
        self.idlers = conveyor.idlers.carry if self.carrying else conveyor.idlers.return_
        self.spacing, self.sag = si(self.idlers.spacing), si(self.idlers.sag)
        self.belt_mass = conveyor.belt.line_mass
        self.gravity = si(conveyor.calculation.gravity)
        self.full = bulk_line_mass(si(conveyor.material.flow), belt_speed=si(conveyor.belt.speed))
        self.flow_shares = conveyor.route.flow_shares
        self.set_mass, self.rim_mass = self.idlers.set_mass, self.idlers.rim_mass
        self.trough, self.tilt = si(self.idlers.trough_angle), si(self.idlers.tilt_angle)
        self.roll_length = si(self.idlers.roll.length)
        self.radii = tuple(0.5 * si(self.idlers.roll_at(i).diameter) for i in range(self.idlers.rolls))
        self.misalignment = _misalignment_frictions(conveyor, self.idlers)
        self.set_loads = SetLoads(conveyor, self.idlers)
        share = conveyor.calculation.flexure_share
        self.flexure = FlexureLaw(conveyor, self.set_loads) if share is None else None

    def stretch(self, section: RouteSection) -> Stretch:
        """Stretch of one section."""
        own = section.spacing[self.strand]
        spacing = self.spacing if own is None else own
        flow = self.full if self.carrying and section.loaded else 0.0
        flow *= self.flow_shares[section.name]
        pressing = self.acting.pressing.get((section.name, self.strand), 0.0)
        belt_on_rolls, bulk_on_rolls = masses_on_rolls(
            self.belt_mass,
            flow,
            pressing,
            radius=abs(section.radius),
            where=f'section "{section.name}", {self.strand}',
        )
        length = section.length
        rise = section.rise if self.carrying else -section.rise
        inclination = math.asin(rise / length)
        if self.carrying and section.bed is not None:
            return self._on_bed(section, section.bed, flow)
        loads = self.set_loads.of(
            spacing=spacing,
            inclination=inclination,
            belt_mass=belt_on_rolls,
            bulk_mass=bulk_on_rolls,
            flow_mass=flow,
            pull=self.acting.pulls.get((section.name, self.strand), (0.0, 0.0)),
        )
        turned = self._turn(section, spacing, inclination, flow)
        if turned is not None and (section.name, self.strand) in self.acting.drift:
            loads = turned.drifted(loads)
        least = sag_tension(self.belt_mass + flow, spacing=spacing, relative_sag=self.sag, gravity=self.gravity)
        return Stretch(
            section=section.name,
            strand=self.strand,
            length=length,
            rise=rise,
            spacing=spacing,
            idlers=self.idlers,
            trough_angle=self.trough,
            tilt_angle=self.tilt,
            roll_length=self.roll_length,
            radii=self.radii,
            belt_mass=self.belt_mass,
            bulk_mass=flow,
            loads=loads,
            least_tension=least,
            set_mass=self.set_mass,
            rim_mass=self.rim_mass,
            misalignment=self.misalignment,
            span_flexure=self._span(flow, spacing, inclination, least),
            turn=turned,
        )

    def _on_bed(self, section: RouteSection, bed: PlateBed, flow: float) -> Stretch:
        """Stretch of a section on a plate in the shape of the trough, without sets."""
        return Stretch(
            section=section.name, strand=self.strand, length=section.length, rise=section.rise, spacing=self.spacing,
            idlers=self.idlers, trough_angle=self.trough, tilt_angle=0.0, roll_length=self.roll_length, radii=(),
            belt_mass=self.belt_mass, bulk_mass=flow, loads=(), least_tension=0.0, set_mass=0.0,
            rim_mass=0.0, misalignment=(), span_flexure=None if self.flexure is None else 0.0, bed=bed,
        )  # fmt: skip

    def _turn(self, section: RouteSection, spacing: float, inclination: float, flow: float) -> CurveSets | None:
        """Sets of a section on a horizontal curve; None on the straight and around a pipe, which keeps its place."""
        if section.horizontal is None or self.idlers.shape.closed:
            return None
        weights = self.set_loads.of(
            spacing=spacing, inclination=inclination, belt_mass=self.belt_mass, bulk_mass=flow, flow_mass=flow
        )
        wind, belt = self.conveyor.ambient.wind_speed, self.conveyor.belt
        return sets_on_curve(
            section.horizontal,
            self.idlers,
            self.strand,
            weights,
            vertical=section.radius,
            length=section.length,
            drift=self.acting.drift.get((section.name, self.strand), 0.0),
            wind_speed=0.0 if wind is None else si(wind),
            spacing=spacing,
            thickness=si(belt.top_cover.thickness) + si(belt.bottom_cover.thickness) + si(belt.carcass.thickness),
        )

    def _span(self, flow: float, spacing: float, inclination: float, least: float) -> float | None:
        if self.flexure is None:
            return None
        return self.flexure.span(
            belt_mass=self.belt_mass,
            bulk_mass=flow,
            spacing=spacing,
            inclination=inclination,
            least_tension=least,
        )
