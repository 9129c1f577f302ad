"""Input of sizing: duty, site rules, series of parts, prices."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import cache
from typing import Annotated, Any, Final, Literal, Self

from pydantic import Field, model_validator

from conveyor.files import libraries
from conveyor.laws.drives import DRIVE_SPEED_TOLERANCE, GEAR_SERVICE
from conveyor.laws.idler_sets import CemaClass
from conveyor.laws.preliminary_sizing import Severity
from conveyor.laws.resistance import Site
from conveyor.models.base import AnyInteger, Model, Name, Number, Problem, raise_problems
from conveyor.models.calculation_methods import FACTOR_METHODS, Method
from conveyor.models.compound import CompoundReference
from conveyor.models.drive import DesignFriction
from conveyor.models.material import BulkMaterial
from conveyor.models.operation import EarthTemperature, Operation
from conveyor.models.part_conflicts import flexure_factor_problems
from conveyor.models.parts import Ambient, Calculation
from conveyor.models.prices import Prices
from conveyor.models.report import Report
from conveyor.models.route import Route
from conveyor.models.sizing_lists import ListedSeries
from conveyor.models.validation_messages import Location
from conveyor.units import (
    Angle,
    AreaMass,
    Bounds,
    Distance,
    Duration,
    Force,
    Fraction,
    Length,
    LineForce,
    Mass,
    Power,
    Quantity,
    Rotation,
    Speed,
    Thickness,
    quantity,
    si,
    text,
)
from conveyor.units.sentences import ZERO_CELSIUS
from conveyor.units.unit_systems import Trade, trade_of

Carcasses = Literal["EP", "steel cord"]
DriveLayout = Literal["head", "head, two pulleys", "head and tail", "head, two pulleys, and tail", "tail"]
DesignWidth = Annotated[Length, Bounds(gt="100 mm", le="5 m")]
DesignSpeed = Annotated[Speed, Bounds(gt="0 m/s", le="20 m/s")]
TroughAngle = Annotated[Angle, Bounds(ge="0 deg", le="60 deg")]
RollDiameter = Annotated[Thickness, Bounds(ge="20 mm", le="1 m")]
SetSpacing = Annotated[Distance, Bounds(gt="0.2 m", le="20 m")]


_SAME_SIZE: Final = 1e-9
"""Relative tolerance of sizes typed as decimals in any unit."""


def same_width(one: float, other: float) -> bool:
    """True if two widths are equal but for rounding [m]."""
    return math.isclose(one, other, rel_tol=_SAME_SIZE)


def within_limit(size: float, most: float) -> bool:
    """True if a size is at most a limit, but for the rounding of unit conversion."""
    return size <= most * (1.0 + _SAME_SIZE)


class WidthRow(Model):
    """A belt width and the lengths of its rolls."""

    belt: DesignWidth
    """Width."""
    one: DesignWidth
    """Roll of a flat set."""
    two: DesignWidth
    """Rolls of a set of two."""
    three: DesignWidth
    """Rolls of a set of three."""
    rolls: tuple[RollDiameter, ...] = ()
    """Usual diameters of its rolls; all of the series without."""


class RollRow(Model):
    """Rolls of a diameter."""

    diameter: RollDiameter
    """Outside."""
    wall: Annotated[Thickness, Bounds(gt="0 mm", le="50 mm")]
    """Of the tube."""
    ends: Annotated[Mass, Bounds(ge="0 kg", le="100 kg")]
    """What turns beside the tube."""
    bearing: Name
    """Its bearings."""
    dynamic_rating: Annotated[Force, Bounds(gt="0 N", le="10 MN")]
    """Rating C of one."""
    cema_class: CemaClass | None = None
    """Class of their sets, which bear no more than it is rated for."""


class CarcassRow(Model):
    """A class of belts."""

    strength: Annotated[LineForce, Bounds(gt="0 N/mm", le="20000 N/mm")]
    """Nominal."""
    thickness: Annotated[Thickness, Bounds(gt="0 mm", le="50 mm")]
    """Of the carcass."""
    rating: Annotated[LineForce, Bounds(gt="0 N/mm", le="5000 N/mm")] | None = None
    """Working tension that it is sold by, in the US."""
    mass: Annotated[AreaMass, Bounds(gt="0 kg/m^2", le="200 kg/m^2")] | None = None
    """Of the carcass; by its strength and thickness without it."""


class Sizes(Model):
    """The series that parts are chosen from."""

    speeds: tuple[DesignSpeed, ...]
    trough_angles: tuple[TroughAngle, ...]
    carry_spacings: tuple[SetSpacing, ...]
    return_spacings: tuple[SetSpacing, ...]
    cover_step: Annotated[Thickness, Bounds(gt="0 mm", le="5 mm")]
    vee_from: DesignWidth
    widths: tuple[WidthRow, ...]
    rolls: tuple[RollRow, ...]
    textile: tuple[CarcassRow, ...]
    steel_cord: tuple[CarcassRow, ...]


@cache
def size_series(series: Trade) -> Sizes:
    """Series of sizes from the library."""
    entries = libraries.library_entries("sizes_us" if series == "US" else "sizes").values()
    return Sizes.from_data({name: value for entry in entries for name, value in entry.fields.items()})


class SiteRules(Model):
    """What a design has to keep; everything has a default, those without a source are general knowledge."""

    series: Trade | None = None
    """Library of sizes that parts are chosen from; that of report.units without it."""
    widths: tuple[DesignWidth, ...] = ()
    """Belt widths to choose from; all of the library without."""
    speeds: tuple[DesignSpeed, ...] = ()
    """Belt speeds to choose from; all of the library without."""
    fastest: DesignSpeed | None = None
    """Highest speed of the belt; without it that which CEMA recommends for width and material."""
    filling: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity("90 %")
    """Most of the cross-section of ISO 5048 that the bulk may take."""
    least_filling: Annotated[Fraction, Bounds(ge="0 %", lt="100 %")] = quantity("40 %")
    """Least of it, but for the narrowest belt that takes the lumps: emptier ones are not looked at."""
    trough_angles: tuple[TroughAngle, ...] = ()
    """Of sets of three rolls; all of the library without."""
    carcasses: Annotated[tuple[Carcasses, ...], Field(min_length=1)] = ("EP", "steel cord")
    """Kinds of belt."""
    roll_diameters: tuple[RollDiameter, ...] = ()
    """Diameters of rolls to choose from; without it the usual ones of the width, in the US those of the class."""
    carry_spacings: tuple[SetSpacing, ...] = ()
    """Distances of carry sets to choose from; without it those in use, overland ones with `site: overland`; in the US
    without it at most the normal ones of CEMA for width and density."""
    return_spacings: tuple[SetSpacing, ...] = ()
    """The same of return sets."""
    loading_spacing: SetSpacing | None = None
    """Distance of the sets where the bulk lands, at most that of the carry sets; half of it without."""
    graduated: bool = True
    """Whether the distance of carry sets may differ from section to section."""
    carry_sag: Annotated[Fraction, Bounds(gt="0 %", le="5 %")] = quantity("1 %")
    """Largest sag of the belt between carry sets, over their distance."""
    return_sag: Annotated[Fraction, Bounds(gt="0 %", le="5 %")] = quantity("2 %")
    """The same of return sets."""
    roll_rotation: Annotated[Rotation, Bounds(gt="0 rpm", le="5000 rpm")] = quantity("650 rpm")
    """Highest speed of the rolls."""
    roll_life: Annotated[Duration, Bounds(gt="0 h", le="1000000 h")] = quantity("30000 h")
    """Least L10 of the bearings of a set, and of listed pulleys whose bearings have a rating."""
    drives: Annotated[tuple[DriveLayout, ...], Field(min_length=1)] = (
        "head",
        "head, two pulleys",
        "head and tail",
        "head, two pulleys, and tail",
        "tail",
    )
    """Places of the drives to choose from."""
    largest_motor: Annotated[Power, Bounds(gt="0 kW", le="1 MW")] = quantity("1000 kW")
    """Largest motor; the series ends at 1 MW."""
    motors_per_pulley: Annotated[int, Field(ge=1, le=2, strict=True), AnyInteger] = 2
    """Motors that a drive pulley may have: one, or one at either end of its shaft."""
    wrap_angle: Annotated[Angle, Bounds(gt="90 deg", le="270 deg")] = quantity("210 deg")
    """Of a drive pulley."""
    friction: Annotated[Number, Field(ge=0.01, le=1)] = 0.35
    """Of belt on drive pulley."""
    efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity("94 %")
    """From motor shaft to belt."""
    start_factor: Annotated[Number, Field(ge=1, le=5)] = 1.3
    """Force of a start over the steady one."""
    take_up_travel: Annotated[Distance, Bounds(gt="0 m", le="500 m")] = quantity("30 m")
    """Longest travel of the take-up, which keeps textile belts to short conveyors."""
    service_factor: Annotated[Number, Field(ge=1, le=5)] = GEAR_SERVICE.value
    """Rated torque of listed gearboxes and couplings over that of their motor."""
    face_allowance: Annotated[Length, Bounds(gt="0 mm", le="1 m")] | None = None
    """How much wider than the belt listed pulleys are at least; without it 100 mm, in the US series 2 in."""
    speed_tolerance: Annotated[Fraction, Bounds(gt="0 %", le="10 %")] = quantity(f"{100.0 * DRIVE_SPEED_TOLERANCE:g} %")
    """How far listed gearboxes may take the belt from a speed to choose from; the design has the speed they give."""
    basis: Method = "viscoelastic"
    """Method by which the motors have to suffice, beside the friction to design for of calculation.method."""
    motor_reserve: Annotated[Number, Field(ge=1, le=3)] = 1.1
    """Rated power of motors over the highest needed, with the friction to design for."""
    design_friction: DesignFriction | None = None
    """Friction that motors, belt, grip and take-up are designed for, over the computed one, as drive.design_friction of
    the designs; without it the upper end of the band of the defaults in use."""


class SizingDuty(Model):
    """What is to be conveyed, from where to where, and by which rules."""

    name: Name
    """What the conveyor is called in reports."""
    site: Site = "plant"
    """How well it will be aligned and kept: as a good overland conveyor, as plants usually are, or poorly."""
    material: BulkMaterial
    lump: Annotated[Length, Bounds(ge="0 mm", le="2 m")]
    """Largest size of the bulk."""
    lumps: Literal["mixed", "sized"] = "mixed"
    """Whether a few lumps are among fines, or all is lumps."""
    abrasiveness: Severity = "medium"
    """Of the bulk."""
    loading: Severity = "medium"
    """How hard the bulk lands on the belt."""
    length: Annotated[Distance, Bounds(gt="2 m", le="100 km")] | None = None
    """Along the belt, of a conveyor of one slope; instead of route."""
    lift: Annotated[Distance, Bounds(ge="-5 km", le="5 km")] | None = None
    """From tail to head, with length."""
    route: Route | None = None
    """Sections as in a spec; pulleys, take-up and distances of idlers are sized."""
    ambient: Ambient
    coldest: EarthTemperature | None = None
    """Of the covers, for motors, strength and take-up, a load case of the designs; that of ambient without it. The air
    around the rolls keeps ambient's distance to them."""
    operation: Operation
    covers: Annotated[tuple[CompoundReference, ...], Field(min_length=1, max_length=10)]
    """Compounds of the bottom cover to choose from; the first one is that of the top cover, too."""
    rules: SiteRules = SiteRules()
    listed: ListedSeries = ListedSeries()
    """Makers' items that designs are built of, instead of the package's series."""
    prices: Prices = Field(default_factory=lambda: Prices.from_data({}))
    calculation: Calculation = Calculation()
    report: Report = Report()

    @model_validator(mode="after")
    def _whole(self) -> Self:
        raise_problems("SizingDuty", self._problems())
        return self

    def _problems(self) -> Iterator[Problem]:
        if (self.route is None) == (self.length is None):
            yield Problem(("route",), "give either route, or length and lift of one slope")
        if self.lift is not None and self.length is None:
            yield Problem(("lift",), "given without length; give the lifts of the route's sections")
        elif self.lift is not None and self.length is not None and abs(si(self.lift)) >= si(self.length):
            yield Problem(("lift",), "is not less than length, which is along the belt; correct one of the two")
        if self.route is not None:
            yield from self._sized_problems(self.route)
        yield from self._method_problems()
        yield from self._cold_problems()
        if si(self.material.flow) == 0.0:
            yield Problem(("material", "flow"), "got 0: an empty belt has no duty; give what is conveyed")
        yield from self._series_problems()
        yield from self._price_problems()

    @staticmethod
    def _sized_problems(route: Route) -> Iterator[Problem]:
        """Refuse fields that the sizing determines."""
        given: dict[Location, object] = {
            ("route", "pulleys"): route.pulleys,
            ("route", "take_up"): route.take_up,
        }
        for i, section in enumerate(route.sections):
            place = ("route", "sections", i)
            given |= {
                (*place, "carry_spacing"): section.carry_spacing,
                (*place, "return_spacing"): section.return_spacing,
            }
        yield from (
            Problem(place, "is what the sizing is to find; remove it") for place, value in given.items() if value
        )

    def _series_problems(self) -> Iterator[Problem]:
        """Refuse rules that the series or the lists have no parts for."""
        sizes, rules = size_series(self.series), self.rules
        yield from self._size_problems("widths", rules.widths, (row.belt for row in sizes.widths))
        if not self.listed.items("rolls"):
            diameters = (row.diameter for row in sizes.rolls)
            yield from self._size_problems("roll_diameters", rules.roll_diameters, diameters)
        kinds = {
            "steel cord" if one.fields["carcass"]["kind"] == "steel cord" else "EP"
            for one in self.listed.items("belts")
        }
        if kinds and not kinds & set(rules.carcasses):
            told = f"none is of rules.carcasses, {' and '.join(rules.carcasses)}: list others or allow them"
            yield Problem(("listed", "belts"), told)

    def _size_problems(self, rule: str, asked: Iterable[Quantity], series: Iterable[Quantity]) -> Iterator[Problem]:
        """Refuse sizes of a rule that the series has not."""
        there = list(series)
        listed = ", ".join(dict.fromkeys(map(text, there)))
        for i, size in enumerate(asked):
            if not any(same_width(si(size), si(one)) for one in there):
                told = f"got {text(size)}, the series has {listed} (rules.series {self.series})"
                yield Problem(("rules", rule, i), told)

    def _method_problems(self) -> Iterator[Problem]:
        method, basis = self.calculation.method, self.rules.basis
        named = {method, *(FACTOR_METHODS if method in FACTOR_METHODS else ())}
        if method != "viscoelastic" and "basis" in self.rules.model_fields_set:
            if basis in named:
                told = f'got "{basis}" beside calculation.method "{method}", by which everything is sized: remove it'
                yield Problem(("rules", "basis"), told)
            elif basis == "viscoelastic":
                told = f'got "{basis}" beside calculation.method "{method}": designs follow that alone; remove one'
                yield Problem(("rules", "basis"), told)
        if basis == "cema classic" and self.calculation.cema is None:
            yield Problem(("rules", "basis"), "cema classic needs Ky and Ai from the book: give calculation.cema")
        if self.route is not None:
            yield from flexure_factor_problems(self.route, self.calculation)

    def _cold_problems(self) -> Iterator[Problem]:
        """Refuse a coldest temperature above that of the duty, and frost by CEMA without its factor."""
        usual, coldest = self.ambient.belt, self.lowest_temperature
        if si(coldest) > si(usual):
            told = f"got {text(coldest)}, warmer than the covers of the duty (ambient), {text(usual)}; correct one"
            yield Problem(("coldest",), told)
        cema = self.calculation.cema
        by_cema = "cema classic" in {self.calculation.method, self.rules.basis}
        if by_cema and cema is not None and "temperature_factor" not in cema.model_fields_set:
            lowest = min(coldest, usual, self.ambient.temperature, key=si)
            if si(lowest) < ZERO_CELSIUS:
                told = f"missing: at {text(lowest)}, below freezing, give the book's Kt"
                yield Problem(("calculation", "cema", "temperature_factor"), told)

    def _price_problems(self) -> Iterator[Problem]:
        price = self.operation.price
        if price is None:
            yield Problem(("operation", "price"), "missing: designs are ranked by what their energy costs")
        elif price.currency != self.prices.currency:
            message = f"got {price.currency}, but the prices are in {self.prices.currency}; give both in one currency, "
            message += f"or the library's theirs: prices.euro 1.1 {price.currency}"
            yield Problem(("operation", "price"), message)
        if self.operation.duty:
            yield Problem(("operation", "duty"), "designs are ranked at their full load; give hours_per_year")

    @property
    def lowest_temperature(self) -> Quantity:
        """Temperature that motors, strength and take-up are for: the coldest, else that of the covers."""
        return self.ambient.belt if self.coldest is None else self.coldest

    @property
    def series(self) -> Trade:
        """Series of sizes that parts are chosen from."""
        return self.rules.series or trade_of(self.report.units)

    @property
    def sized_route(self) -> Route:
        """Route as given, else one section of the length and lift."""
        if self.route is not None:
            return self.route
        section: dict[str, Any] = {"name": "conveyor", "length": self.length, "lift": self.lift}
        return Route.from_data({"sections": [{k: v for k, v in section.items() if v is not None}]})
