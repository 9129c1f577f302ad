"""The route from tail to head, and the equipment at single places of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from conveyor.laws.resistance import BULK_ON_BELT_FRICTION, BULK_ON_SKIRT_FRICTION, CLEANER_FRICTION, CLEANER_PRESSURE
from conveyor.laws.transfer import CLEANER_EFFICIENCY
from conveyor.models.base import AnyInteger, Friction, Model, Name, Problem, Switch, raise_problems
from conveyor.models.belt_scale import BeltScale
from conveyor.models.calculation_methods import FlexureFactor, FrictionFactor
from conveyor.models.hoppers import Hopper
from conveyor.models.idlers import Spacing
from conveyor.models.loop_parts import Pulley, TakeUp, Transition
from conveyor.models.ploughs import Plough
from conveyor.models.slider_beds import SliderBed
from conveyor.models.validation_messages import Location
from conveyor.units import (
    Angle,
    AreaMass,
    Bounds,
    Distance,
    Force,
    Fraction,
    Length,
    LineForce,
    Mass,
    Pressure,
    Quantity,
    Speed,
    SpringRate,
    Thickness,
    from_si,
    quantity,
    si,
    text,
)

Banking = Annotated[Angle, Bounds(ge="0 deg", le="20 deg")]


Skew = Annotated[Angle, Bounds(ge="0 deg", le="5 deg")]


_LARGEST_TURN = math.pi  # [rad] of horizontal turn in a section


_LARGEST_HOLDING_WRAP = math.radians(90.0)  # wrap angle above which bulk falls off the carry strand [rad]


SHARE_SUM_TOLERANCE = 1e-9
"""Tolerance of a sum of shares typed as decimals."""


class Section(Model):
    """A part of the route, both strands; its lift or its slope, up in running direction positive."""

    name: Name
    """Each its own; feeding, drives and pulleys may name it."""
    length: Annotated[Distance, Bounds(gt="0 m", le="100 km")]
    """Length along the belt."""
    lift: Annotated[Distance, Bounds(ge="-5 km", le="5 km")] | None = None
    """Rise from its tail end to its head end; level without lift and slope."""
    slope: Annotated[Angle, Bounds(ge="-45 deg", le="45 deg")] | None = None
    """Angle to the level, instead of the lift."""
    carry_spacing: Spacing | None = None
    """Distance of the carry sets here, where it differs."""
    return_spacing: Spacing | None = None
    """Distance of the return sets here, where it differs."""
    loaded: Switch = True
    """Whether the carry strand bears bulk here."""
    curve: Literal["convex", "concave"] | None = None
    """Vertical curve: convex over a hill, concave through a valley; straight without."""
    curve_radius: Annotated[Distance, Bounds(ge="10 m", le="100 km")] | None = None
    """Radius of the vertical curve; lift or slope are those of its chord."""
    horizontal_curve: Literal["left", "right"] | None = None
    """Horizontal curve, to the left or right in running direction of the carry strand; straight without."""
    horizontal_radius: Annotated[Distance, Bounds(ge="10 m", le="100 km")] | None = None
    """Radius of the horizontal curve."""
    carry_banking: Banking | None = None
    """Angle by which the carry sets are raised on the inside of the horizontal curve."""
    return_banking: Banking | None = None
    """Angle by which the return sets are raised on the inside of the horizontal curve."""
    carry_skew: Skew | None = None
    """Angle in plan by which the carry sets are turned to steer the belt out of the horizontal curve."""
    return_skew: Skew | None = None
    """Angle in plan by which the return sets are turned to steer the belt out of the horizontal curve."""
    friction_factor: FrictionFactor | None = None
    """Friction factor f of the carry strand here, by ISO 5048 and DIN 22101; that of calculation without it."""
    return_friction_factor: FrictionFactor | None = None
    """f of the return strand here; that of calculation without it."""
    flexure_factor: FlexureFactor | None = None
    """Ky of CEMA here, by the book's table for its slope, length and load; that of calculation.cema without it."""
    bed: SliderBed | None = None
    """Plate that carries the belt here instead of carry sets."""

    @model_validator(mode="after")
    def _one_slope(self) -> Self:
        problems = [*self._curve_problems(), *self._horizontal_problems(), *self._bed_problems()]
        if self.lift is not None and self.slope is not None:
            problems.append(
                Problem(
                    ("slope",),
                    f"got slope {text(self.slope)} and lift {text(self.lift)}; give one of the two, remove the other",
                )
            )
        elif self.lift is not None and abs(si(self.lift)) >= si(self.length):
            problems.append(
                Problem(
                    ("lift",),
                    f"got {text(self.lift)}, but the section is only {text(self.length)} long; "
                    "the lift must be less than the length: correct lift or length",
                )
            )
        raise_problems("Section", problems)
        return self

    def _curve_problems(self) -> list[Problem]:
        if self.curve is not None and self.curve_radius is not None:
            return self._upright_problems(self.curve_radius)
        if (self.curve is None) == (self.curve_radius is None):
            return []
        missing, given = ("curve", "curve_radius") if self.curve is None else ("curve_radius", "curve")
        return [Problem((missing,), f"missing: {given} is given; a vertical curve needs both, or remove {given}")]

    def _upright_problems(self, radius: Quantity) -> list[Problem]:
        length = si(self.length)
        if abs(self.rise) >= length:
            return []
        turn, left = length / si(radius), 0.5 * math.pi - abs(math.asin(self.rise / length))
        if 0.5 * turn < left:
            return []
        least = from_si(float(f"{0.5 * length / left:.6g}"), "length", text(radius).split()[1])
        message = (
            f"got {text(radius)}, with which {text(self.length)} turn by {math.degrees(turn):.0f} deg and stand "
            f"upright at an end: take more than {text(least)}, or a shorter section"
        )
        return [Problem(("curve_radius",), message)]

    def _horizontal_problems(self) -> Iterator[Problem]:
        side, radius = self.horizontal_curve, self.horizontal_radius
        if (side is None) != (radius is None):
            missing, given = ("horizontal_curve", "horizontal_radius")[:: 1 if side is None else -1]
            message = f"missing: {given} is given; a horizontal curve needs both, or remove {given}"
            yield Problem((missing,), message)
        elif radius is not None and (turn := si(self.length) / si(radius)) > _LARGEST_TURN:
            least = from_si(float(f"{si(self.length) / _LARGEST_TURN:.6g}"), "length", text(radius).split()[1])
            yield Problem(
                ("horizontal_radius",),
                f"got {text(radius)}, with which {text(self.length)} turn by {math.degrees(turn):.0f} deg, more than "
                f"180 deg in a section: take {text(least)} or more, or a shorter section",
            )
        if side is None and radius is None:
            for name in ("carry_banking", "return_banking", "carry_skew", "return_skew"):
                if (given := getattr(self, name)) is not None:
                    message = f"got {text(given)} on the straight; give horizontal_curve and its radius, or remove it"
                    yield Problem((name,), message)

    def _bed_problems(self) -> Iterator[Problem]:
        """Refuse carry sets, their factors and curves where a plate carries the belt."""
        if self.bed is None:
            return
        for name in ("curve_radius", "horizontal_radius"):
            if getattr(self, name) is not None:
                message = "given with bed, a straight plate; give the curve a section of its own with carry sets"
                yield Problem((name,), message)
        for name in ("carry_spacing", "friction_factor", "flexure_factor"):
            if getattr(self, name) is not None:
                yield Problem((name,), "given, but a plate (bed) carries the belt here, no carry sets; remove one")

    @property
    def signed_radius(self) -> float:
        """Radius of the vertical curve, positive convex, negative concave; infinite on the straight [m]."""
        if self.curve_radius is None:
            return math.inf
        return si(self.curve_radius) * (1.0 if self.curve == "convex" else -1.0)

    @cached_property
    def rise(self) -> float:
        """Lift from tail end to head end [m]."""
        if self.slope is not None:
            return si(self.length) * math.sin(si(self.slope))
        return 0.0 if self.lift is None else si(self.lift)


class Feeding(Model):
    """A loading point and its skirts."""

    speed: Annotated[Speed, Bounds(ge="0 m/s", le="20 m/s")] = quantity("0 m/s")
    """Speed of the bulk in running direction as it lands."""
    skirt_length: Annotated[Distance, Bounds(ge="0 m", le="1 km")]
    """Length of the skirts beyond the acceleration zone, which is computed."""
    skirt_width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Distance between the skirts."""
    belt_friction: Friction = BULK_ON_BELT_FRICTION.value
    """Friction of bulk on belt μ1."""
    skirt_friction: Friction = BULK_ON_SKIRT_FRICTION.value
    """Friction of bulk on skirts μ2."""
    section: Name | None = None
    """Section at whose tail end the bulk lands; the first without it."""
    share: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """Share of the mass flow fed here; needed where there are several feeding points, not of a tripper."""
    tripper_lift: Annotated[Distance, Bounds(ge="0 m", le="50 m")] | None = None
    """Of a tripper or intermediate drive that feeds the belt's own bulk back here: how high it lifts it over the
    line of the section."""
    skirtboards: Annotated[Distance, Bounds(gt="0 m", le="1 km")] | None = None
    """Whole length of the skirtboards as they stand, beside the zone of acceleration; not asked without it."""
    seal_drag: Annotated[LineForce, Bounds(ge="0 N/m", le="10 kN/m")] | None = None
    """Drag of the rubber seals of both sides on the belt, per length of skirtboard; none without it."""
    drop_height: Annotated[Distance, Bounds(gt="0 m", le="100 m")] | None = None
    """Free fall of the bulk onto the belt; impact is not asked without it."""
    lump_mass: Annotated[Mass, Bounds(gt="0 kg", le="100 t")] | None = None
    """Of the heaviest lump; the stream alone without it."""
    idler_stiffness: Annotated[SpringRate, Bounds(gt="1 kN/m", le="1000000 kN/m")] | None = None
    """Spring rate under a lump, of an impact set with belt and frame, by its maker; needed for the force of lumps."""
    idler_spacing: Spacing | None = None
    """Distance of the sets where the bulk lands; that of carry sets without it."""
    idler_rating: Annotated[Force, Bounds(gt="0 N", le="10 MN")] | None = None
    """Load that a set there bears, by its maker."""
    skirt_height: Annotated[Length, Bounds(gt="0 m", le="5 m")] | None = None
    """Of the skirts over the belt where they stand on it; sections wholly between them hold bulk up to it, and as on an
    open belt without it."""
    hopper: Hopper | None = None
    """Hopper from which the belt pulls the bulk here, as a feeder."""

    @property
    def skirted_length(self) -> float:
        """Length between skirts from where the bulk lands, without a computed zone of acceleration [m]."""
        if self.skirtboards is not None:
            return si(self.skirtboards)
        return si(self.skirt_length) + (0.0 if self.hopper is None else si(self.hopper.outlet_length))

    @model_validator(mode="after")
    def _lands(self) -> Self:
        needs = {
            "lump_mass": self.lump_mass,
            "idler_stiffness": self.idler_stiffness,
            "idler_rating": self.idler_rating,
        }
        raise_problems("Feeding", [
            Problem((name,), "given without drop_height; give how far the bulk falls, or remove it")
            for name, value in needs.items()
            if value is not None and self.drop_height is None
        ])  # fmt: skip
        if self.hopper is not None:
            raise_problems("Feeding", list(self._feeder_problems()))
        return self

    def _feeder_problems(self) -> Iterator[Problem]:
        """Refuse what bulk that is pulled out of a hopper does not do."""
        if si(self.speed) > 0.0:
            yield Problem(("speed",), f"got {text(self.speed)}: the belt pulls the bulk out of the hopper from rest")
        for name in ("tripper_lift", "drop_height"):
            if getattr(self, name) is not None:
                yield Problem((name,), "given with hopper, whose bulk rests on the belt; remove one of the two")


class Discharge(Model):
    """How the bulk leaves over the head pulley, for its trajectory."""

    drop: Annotated[Distance, Bounds(ge="0 m", le="200 m")]
    """Depth below the axis of the pulley down to which the stream is followed."""
    pulley_diameter: Annotated[Length, Bounds(gt="0 m", le="5 m")] | None = None
    """Of the head pulley with its lagging; that of the first pulley at the head without it."""
    slope: Annotated[Angle, Bounds(ge="-45 deg", le="45 deg")] | None = None
    """Of the belt where it meets the pulley, up positive; that of the last section without it."""
    friction: Friction = BULK_ON_BELT_FRICTION.value
    """Of bulk on belt before it slips on the pulley."""
    sliding_friction: Friction | None = None
    """Of bulk that slips on the belt; friction without it."""

    @model_validator(mode="after")
    def _slides_easier(self) -> Self:
        if self.sliding_friction is not None and self.sliding_friction > self.friction:
            message = f"got {self.sliding_friction:g}, more than friction {self.friction:g}; correct one of the two"
            raise_problems("Discharge", [Problem(("sliding_friction",), message)])
        return self


class Cleaner(Model):
    """A scraper on the belt, or several alike."""

    kind: Literal["pre-cleaner", "primary", "secondary", "tertiary"] | None = None
    """Where it stands: before or on the face of the head pulley, behind it, behind a snub; for the report."""
    count: Annotated[int, Field(ge=1, le=100, strict=True), AnyInteger] = 1
    """How many alike."""
    width: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Length of the blade across the belt."""
    thickness: Annotated[Thickness, Bounds(gt="0 mm", le="200 mm")]
    """Thickness of the blade that touches the belt."""
    pressure: Annotated[Pressure, Bounds(ge="0 Pa", le="1 MPa")] = quantity(f"{CLEANER_PRESSURE.value:g} Pa")
    """Of the blade on the belt."""
    friction: Friction = CLEANER_FRICTION.value
    """Friction of blade on belt μ3."""
    efficiency: Annotated[Fraction, Bounds(ge="0 %", lt="100 %")] = quantity(CLEANER_EFFICIENCY.value, "fraction")
    """Share of what clings to the belt that one takes off; general knowledge without it."""


class Route(Model):
    """Sections in running direction of the carry strand, tail first."""

    sections: Annotated[tuple[Section, ...], Field(min_length=1, max_length=20000)]
    feeding: Feeding | None = None
    """The loading point, or the first of several."""
    further_feeding: Annotated[tuple[Feeding, ...], Field(max_length=100)] = ()
    """Loading points beside the first."""
    take_up: TakeUp | None = None
    """Without it the slack side of the drive is kept at the least tension that grip and sag ask for."""
    cleaners: Annotated[tuple[Cleaner, ...], Field(max_length=100)] = ()
    """In the order in which the belt meets them."""
    carryback: Annotated[AreaMass, Bounds(gt="0 kg/m^2", le="100 kg/m^2")] | None = None
    """Bulk that clings to the belt before the cleaners; what they leave is not asked without it."""
    carryback_allowed: Annotated[AreaMass, Bounds(gt="0 kg/m^2", le="100 kg/m^2")] | None = None
    """Most of it that may be left behind them."""
    discharge: Discharge | None = None
    """Over the head pulley; no trajectory without it."""
    ploughs: Annotated[tuple[Plough, ...], Field(max_length=100)] = ()
    belt_scales: Annotated[tuple[BeltScale, ...], Field(max_length=10)] = ()
    pulleys: Annotated[tuple[Pulley, ...], Field(max_length=100)] = ()
    head_transition: Transition | None = None
    """From the last full trough to the head pulley."""
    tail_transition: Transition | None = None
    """From the tail pulley to the first full trough."""
    turned_over: Switch = False
    """Whether the return strand is turned over, so that its rolls run on the bottom cover too."""
    turnover_length: Annotated[Length, Bounds(gt="0 m", le="1 km")] | None = None
    """Of each of its two turnovers, from pulley to pulley."""

    @model_validator(mode="after")
    def _names_once(self) -> Self:
        first: dict[str, int] = {}
        problems = []
        for i, section in enumerate(self.sections):
            if section.name in first:
                message = (
                    f'got "{section.name}", already the name of sections[{first[section.name]}]; '
                    "give each section its own name"
                )
                problems.append(Problem(("sections", i, "name"), message))
            first.setdefault(section.name, i)
        if self.turnover_length is not None and not self.turned_over:
            problems.append(Problem(("turnover_length",), "goes with turned_over: true; give both or neither"))
        raise_problems("Route", [*problems, *self._place_problems(), *self._feeding_problems()])
        return self

    def _place_problems(self) -> Iterator[Problem]:
        """Refuse equipment at sections that the route does not have."""
        named: list[tuple[Location, str | None]] = [
            (("pulleys", i, "section"), pulley.section) for i, pulley in enumerate(self.pulleys)
        ]
        named += [(("ploughs", i, "section"), plough.section) for i, plough in enumerate(self.ploughs)]
        named += [(("belt_scales", i, "section"), scale.section) for i, scale in enumerate(self.belt_scales)]
        named += [(("further_feeding", i, "section"), f.section) for i, f in enumerate(self.further_feeding)]
        if self.feeding is not None:
            named.append((("feeding", "section"), self.feeding.section))
        if self.take_up is not None:
            named.append((("take_up", "section"), self.take_up.section))
        for location, name in named:
            if name is not None:
                yield from self.section_problem(location, name)

    @cached_property
    def _names(self) -> frozenset[str]:
        """Names of the sections."""
        return frozenset(section.name for section in self.sections)

    def section_problem(self, location: Location, name: str) -> Iterator[Problem]:
        """Refuse a name that is not a section of the route."""
        if name not in self._names:
            names = [section.name for section in self.sections[:10]]
            shown = ", ".join(names) + (", …" if len(self.sections) > 10 else "")
            yield Problem(location, f'got "{name}", which is none of the sections: {shown}')

    def _tripper_problems(self) -> Iterator[Problem]:
        """Refuse a tripper as first loading point, at the first section, or with a share of the flow."""
        if self.feeding is not None and self.feeding.tripper_lift is not None:
            message = "given at the first loading point; a tripper is one of further_feeding"
            yield Problem(("feeding", "tripper_lift"), message)
        for i, point in enumerate(self.further_feeding):
            if not self.feeds_back(point):
                continue
            if point.share is not None and si(point.share) != 1.0:
                message = f"got {text(point.share)}, but a tripper feeds back all that comes; remove share"
                yield Problem(("further_feeding", i, "share"), message)
            if point.section is None or point.section == self.sections[0].name:
                message = "a tripper stands behind a section; give the section that follows it"
                yield Problem(("further_feeding", i, "section"), message)

    def feeds_back(self, point: Feeding) -> bool:
        """True if a further feeding point is a tripper: by its lift, or where all bulk lands on a belt that turns.

        Where the carry strand wraps a pulley its bulk has left it, so the whole flow behind it is the same bulk.
        """
        if point.tripper_lift is not None:
            return True
        if point.share is None or si(point.share) != 1.0:
            return False
        turns = {
            p.section for p in self.pulleys if p.position == "carry" and p.wrap_or_half_turn > _LARGEST_HOLDING_WRAP
        }
        return any(
            section.name in turns and after.name == point.section
            for section, after in itertools.pairwise(self.sections)
        )

    def _feeding_problems(self) -> Iterator[Problem]:
        yield from self._tripper_problems()
        if not self.further_feeding:
            if self.feeding is not None and self.feeding.share is not None and si(self.feeding.share) != 1.0:
                message = f"got {text(self.feeding.share)} of a single feeding point; remove it or list further_feeding"
                yield Problem(("feeding", "share"), message)
            return
        if self.feeding is None:
            yield Problem(("feeding",), "missing: further_feeding is given; the first loading point stands here")
            return
        total, certain = 0.0, True
        fresh = [(i, point) for i, point in enumerate(self.further_feeding) if not self.feeds_back(point)]
        if not fresh and self.feeding.share is None:
            return
        for location, point in (
            (("feeding", "share"), self.feeding),
            *((("further_feeding", i, "share"), point) for i, point in fresh),
        ):
            if point.share is None:
                certain = False
                yield Problem(location, "missing: with several feeding points each has its share of the flow")
            else:
                total += si(point.share)
        if certain and abs(total - 1.0) > SHARE_SUM_TOLERANCE:
            message = (
                f"got a sum of {total:.6g}, the shares of all feeding points must add up to 1 (100 %); of a tripper "
                "that feeds back the same bulk give tripper_lift, not share"
            )
            yield Problem(("feeding", "share"), message)

    @cached_property
    def feeding_points(self) -> tuple[Feeding, ...]:
        """All loading points."""
        return () if self.feeding is None else (self.feeding, *self.further_feeding)

    @cached_property
    def flow_shares(self) -> dict[str, float]:
        """Share of the mass flow carried by each section [-]; 1 without feeding points."""
        if self.feeding is None:
            return {section.name: 1.0 for section in self.sections}
        fed: dict[str, list[float]] = {}
        points = [self.feeding, *(point for point in self.further_feeding if not self.feeds_back(point))]
        for point in points:
            name = self.sections[0].name if point.section is None else point.section
            fed.setdefault(name, []).append(1.0 if point.share is None else si(point.share))
        landed: list[float] = []
        shares = {}
        for section in self.sections:
            landed += fed.get(section.name, [])
            total = math.fsum(landed)
            shares[section.name] = 1.0 if len(landed) == len(points) else total
        return shares

    @property
    def length(self) -> float:
        """Length along the belt [m]."""
        return math.fsum(si(section.length) for section in self.sections)

    @property
    def rise(self) -> float:
        """Lift from tail to head [m]."""
        return math.fsum(section.rise for section in self.sections)
