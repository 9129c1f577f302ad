"""Parts of a conveyor, and quantities that depend on several of them."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

from pydantic import AfterValidator, Field, field_validator, model_validator
from pydantic_core import PydanticCustomError

from conveyor.laws.resistance import FRICTION_FACTOR, Site
from conveyor.models.base import AnyInteger, Model, Name, Number, Problem, raise_problems
from conveyor.models.belt import Belt
from conveyor.models.calculation_methods import Calibration, Cema, Flexure, FrictionFactor, Method
from conveyor.models.compound import RubberCompound
from conveyor.models.drive import CEMA_LEAST_FRICTION, LEAST_FRICTION, Drive
from conveyor.models.idlers import Idlers
from conveyor.models.material import BulkMaterial
from conveyor.models.operation import DutyEntry, EarthTemperature, Operation
from conveyor.models.route import Route
from conveyor.units import Acceleration, Bounds, Fraction, Quantity, WindSpeed, quantity, si, text


class Ambient(Model):
    """Where the conveyor stands."""

    temperature: EarthTemperature
    """Temperature of the air."""
    belt_temperature: EarthTemperature | None = None
    """Temperature of the running belt's covers, where it differs."""
    wind_speed: Annotated[WindSpeed, Bounds(ge="0 m/s", le="80 m/s")] | None = None
    """Gust for which the empty belt is checked, against lifting and drift in horizontal curves; no wind without."""

    @property
    def belt(self) -> Quantity:
        """Temperature of the covers."""
        return self.temperature if self.belt_temperature is None else self.belt_temperature


class Calculation(Model):
    """How to calculate."""

    method: Method = "viscoelastic"
    """What the forces, and with them tensions, motors, take-up and checks, follow: the contact of every roll on its
    cover, the factor f (friction_factor, with C where it is tabled), or the factors of CEMA's classic form (cema)."""
    support: Literal["confined", "belt", "free", "half-space"] = "confined"
    """What holds the cover: a stiff carcass (confined), the belt under its tension, nothing (free), endless rubber."""
    rtol: Annotated[Number, Field(ge=1e-10, le=1e-2)] = 1e-4
    """Relative tolerance of the rolling contact: rubber is known to per cents, 1e-6 costs several times as much."""
    strain: Literal["where known", "off"] = "where known"
    """Moduli at the strain the rolls work the cover at, for compounds with strain sweeps."""
    anchor: Literal["tests", "off"] = "tests"
    """Level of indentation by the compounds' rolling-resistance tests, or by the theory alone (off)."""
    gauss_points: Annotated[int, Field(ge=1, le=64, strict=True), AnyInteger] = 8
    """Points along a roll at which the contact is solved."""
    secondary: Literal["itemised", "C"] | None = None
    """Secondary resistances one by one, or all by the length coefficient C (80 m and longer); without it C for the
    methods of a friction factor where it is tabled, else one by one."""
    not_given: Literal["usual values", "nothing"] = "usual values"
    """What stands in where the route has no feeding, no cleaners or no pulleys: usual ones, or nothing."""
    friction_factor: FrictionFactor = FRICTION_FACTOR.value
    """Friction factor f of the classical estimate, and of the methods that follow it; sections may have their own."""
    return_friction_factor: FrictionFactor | None = None
    """f of the return strand, where it differs."""
    empty_friction_factor: FrictionFactor | None = None
    """f of the carry strand where it bears no bulk, where it differs; of sections with an f of their own too."""
    roll_drag: Literal["in service", "acceptance limit"] = "in service"
    """Drag of rolls without one: usual bearings, grease and seals over load, speed and air; or a new roll's limit."""
    flexure_share: Annotated[Fraction, Bounds(ge="0 %", lt="100 %")] | None = None
    """Flexure of belt and bulk as a share of the main resistance, instead of load and sag."""
    flexure: Flexure | None = None
    """Laws for the flexure, instead of load and sag by one measured site."""
    calibration: Calibration | None = None
    """Factors on indentation, idler rotation and flexure, from measured power; 1 without."""
    cema: Cema | None = None
    """Factors of the classic form of CEMA, computed beside this calculation where they are given."""
    gravity: Annotated[Acceleration, Bounds(ge="9.7 m/s^2", le="9.9 m/s^2")] = quantity("9.81 m/s^2")
    """Acceleration of gravity at the site."""

    @field_validator("method", mode="before")
    @classmethod
    def _citable(cls, method: object) -> object:
        if method == "cema universal":
            message = (
                'got "cema universal": neither its form nor its coefficients are in a source that may be cited; take '
                '"cema classic" with Ky of the book, or "viscoelastic", whose forces are of the same kinds'
            )
            raise PydanticCustomError("conflict", "{message}", {"message": message})
        return method

    @model_validator(mode="after")
    def _whole_method(self) -> Self:
        if self.method == "cema classic" and self.cema is None:
            message = "missing: method cema classic needs Ky and Ai from the book: give cema"
            raise_problems("Calculation", [Problem(("cema",), message)])
        if self.method == "cema classic" and self.secondary == "C":
            message = 'got "C" beside method cema classic, which has Tp and Tam for what C stands for: remove it'
            raise_problems("Calculation", [Problem(("secondary",), message)])
        if self.method != "viscoelastic" and self.calibration is not None:
            message = f"given beside method {self.method}, which has no such forces: remove it"
            raise_problems("Calculation", [Problem(("calibration",), message)])
        return self

    @model_validator(mode="after")
    def _one_flexure(self) -> Self:
        if self.flexure is not None and self.flexure_share is not None:
            message = f"given beside flexure_share {text(self.flexure_share)}; give one of the two, remove the other"
            raise_problems("Calculation", [Problem(("flexure",), message)])
        if self.support == "belt" and self.flexure_share is not None:
            message = (
                f"got {text(self.flexure_share)}: it holds the flexure of the belt, which support "
                '"belt" computes with the indentation; remove it, or give flexure.bulk'
            )
            raise_problems("Calculation", [Problem(("flexure_share",), message)])
        return self


FORMAT_VERSION: Final = 1
"""Version of the specs' format; a field that goes or changes its meaning makes a new one."""


def _read_version(given: int) -> int:
    if given > FORMAT_VERSION:
        message = f"got {given}, this version of conveyor reads {FORMAT_VERSION}; the spec is of a newer one: update it"
        raise PydanticCustomError("conflict", "{message}", {"message": message})
    return given


class ConveyorParts(Model):
    """What a conveyor is made of, where it stands and how it is calculated."""

    format_version: Annotated[
        int, AfterValidator(_read_version), Field(alias="conveyor", ge=1, strict=True), AnyInteger
    ] = 1
    """Version of the format that the spec is written in."""
    name: Name
    """What the conveyor is called in reports."""
    site: Site = "plant"
    """How well it is aligned and kept: as a good overland conveyor, as plants usually are, or poorly."""
    belt: Belt
    idlers: Idlers
    material: BulkMaterial
    route: Route
    drive: Drive
    ambient: Ambient
    operation: Operation | None = None
    calculation: Calculation = Calculation()

    @property
    def duty(self) -> tuple[DutyEntry, ...]:
        """Histogram of the year; empty where all hours are alike or there is no operation."""
        return () if self.operation is None else self.operation.duty

    @property
    def temperature(self) -> float:
        """Temperature of the covers [K]."""
        return si(self.ambient.belt)

    @property
    def belt_width(self) -> float:
        """Belt width [m]."""
        return si(self.belt.width)

    @property
    def mass_flow(self) -> float:
        """Mass flow of the bulk where the belt is fully fed [kg/s]."""
        return si(self.material.flow)

    @property
    def belt_speed(self) -> float:
        """Belt speed [m/s]."""
        return si(self.belt.speed)

    @property
    def certain_friction(self) -> float:
        """Friction relied on for braking over the computed one [-]: as given, else usual of the method."""
        given, cema = self.drive.least_friction, self.calculation.method == "cema classic"
        usual = CEMA_LEAST_FRICTION if cema else LEAST_FRICTION
        return usual if given is None else si(given)

    @property
    def air_temperature(self) -> float:
        """Air temperature [K]."""
        return si(self.ambient.temperature)

    @property
    def carry_compound(self) -> RubberCompound:
        """Compound under the carry rolls: the bottom cover's."""
        return self.belt.bottom_cover.compound

    @property
    def bottom_cover_on_both(self) -> bool:
        """True if the rolls of both strands run on the bottom cover: a belt turned over, or a pipe on both strands."""
        return self.route.turned_over or self.idlers.return_.shape.closed

    @property
    def turnover_length(self) -> float | None:
        """Length of each turnover of the return strand [m]; None if not given."""
        given = self.route.turnover_length
        return None if given is None else si(given)

    @property
    def return_compound(self) -> RubberCompound:
        """Compound under the return rolls: the top cover's, unless turned over or not stated."""
        top = self.belt.top_cover.compound
        return self.carry_compound if self.bottom_cover_on_both or top is None else top

    @property
    def return_cover_thickness(self) -> Quantity:
        """Thickness of the cover that the return rolls run on."""
        belt = self.belt
        return belt.bottom_cover.thickness if self.bottom_cover_on_both else belt.top_cover.thickness
