"""A conveyor in SI numbers, frozen; above this layer no quantity carries a unit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.indentation import Support
from conveyor.laws.motion import START_FACTOR
from conveyor.laws.resistance import idler_rotation_resistance
from conveyor.laws.wind import AIR_DENSITY, WIND_LIFT, wind_force
from conveyor.line.belt_body import BeltBody, belt_body
from conveyor.line.bend_pulleys import BendPulley, TransitionZone, bend_pulleys, transition_zones
from conveyor.line.cema_factors import CemaFactors, cema_factors
from conveyor.line.drive_units import DriveUnit, drive_units, torque_curve
from conveyor.line.friction_factors import friction_factors, secondary_method
from conveyor.line.loop_positions import LoopPositions
from conveyor.line.optional_quantities import si_or_default, si_or_none
from conveyor.line.roll_drags import RollDrags, roll_drags
from conveyor.line.roll_kinds import RollKind
from conveyor.line.strands import LoopShape, Strands
from conveyor.line.stretches import RouteSection, Stretch
from conveyor.line.take_up_unit import TakeUpUnit, take_up_unit
from conveyor.line.transfer_parts import (
    HeadDischarge,
    LoadingPoint,
    PloughBlade,
    Scraper,
    belt_scrapers,
    bulk_friction,
    head_discharge,
    loading_points,
    plough_blades,
)
from conveyor.line.weigh_sections import WeighSection, weigh_sections
from conveyor.models import Calculation, Conveyor
from conveyor.models.calculation_methods import Method
from conveyor.units import si
from conveyor.units.unit_systems import trade_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Line:
    """A conveyor in SI: m, kg, s, N, Pa, W, rad. Rubber and temperature are not in it (`line.covers`).

    Attributes
    ----------
    strands : Strands
        The sections, and their stretches with the loads of their rolls.
    roll_drags : tuple of tuple of float
        Drag of each roll of one set at its rim, of every stretch [N].
    speed, flow, gravity : float
        Of the belt, the bulk, the site.
    density, weight_density : float
        Of the bulk as it fills the cross-section, and at its heaviest [kg/m³].
    lump : float or None
        Largest size of the bulk [m], where the spec says it.
    drives : tuple of DriveUnit
        The first one first.
    bulk_belt_friction : float
        Friction of bulk on belt μ1 [-].
    efficiency, regeneration, mains_efficiency : float
        Motor shaft to belt, belt to motor shaft, mains to motor shaft [-].
    secondary : {"itemised", "C"}
        Secondary resistances one by one, or by the length coefficient.
    support, rtol, softened, flexure_share
        Support and tolerance of the contacts; True if strain softens the rubber; share of flexure or None [-].
    carryback : tuple of float or None
        Carryback before the cleaners, and the most allowed behind them [kg/m²].
    flexes_by_sag : bool
        True if the flexure is that of load and sag, at the tension that stands there.
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
    weight_density: float
    lump: float | None
    gravity: float
    loading: tuple[LoadingPoint, ...]
    scrapers: tuple[Scraper, ...]
    carryback: tuple[float | None, float | None]
    discharge: HeadDischarge | None
    ploughs: tuple[PloughBlade, ...]
    belt_scales: tuple[WeighSection, ...]
    pulleys: tuple[BendPulley, ...]
    transitions: tuple[TransitionZone, ...]
    drives: tuple[DriveUnit, ...]
    take_up: TakeUpUnit
    places: LoopPositions
    bulk_belt_friction: float
    efficiency: float
    regeneration: float
    mains_efficiency: float
    start_factor: float | None
    torque_curve: tuple[tuple[float, float], ...]
    brake_delay: float
    stop_deceleration: float | None
    coast_time: float | None
    least_friction: float
    design_friction: float
    method: Method
    secondary: str
    friction_factors: Array
    flexure_share: float | None
    flexes_by_sag: bool
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
            belt=belt_body(conveyor),
            speed=si(conveyor.belt.speed),
            flow=si(conveyor.material.flow),
            density=si(conveyor.material.density),
            weight_density=si(conveyor.material.heaviest),
            lump=None if conveyor.belt.wear is None else si(conveyor.belt.wear.lump),
            gravity=si(calculation.gravity),
            loading=loading_points(conveyor, places),
            scrapers=belt_scrapers(conveyor),
            carryback=(si_or_none(conveyor.route.carryback), si_or_none(conveyor.route.carryback_allowed)),
            discharge=head_discharge(conveyor),
            ploughs=plough_blades(conveyor, places),
            belt_scales=weigh_sections(conveyor),
            pulleys=bend_pulleys(conveyor, places),
            transitions=transition_zones(conveyor),
            drives=drive_units(conveyor, places),
            take_up=take_up_unit(conveyor, places),
            places=places,
            bulk_belt_friction=bulk_friction(conveyor),
            efficiency=efficiency,
            regeneration=si_or_default(drive.regeneration_efficiency, efficiency),
            mains_efficiency=drive.mains_efficiency,
            start_factor=drive.start_factor,
            torque_curve=torque_curve(drive),
            brake_delay=si(drive.brake_delay),
            stop_deceleration=si_or_none(drive.stop_deceleration),
            coast_time=si_or_none(drive.coast_time),
            least_friction=conveyor.certain_friction,
            design_friction=si_or_default(drive.design_friction, 1.0),
            method=calculation.method,
            secondary=secondary_method(conveyor.calculation, conveyor.route.length),
            friction_factors=friction_factors(conveyor, strands.stretches),
            flexure_share=si_or_none(calculation.flexure_share),
            flexes_by_sag=calculation.flexure is None and calculation.flexure_share is None,
            flexure_source=_flexure_source(calculation),
            cema=cema_factors(conveyor.calculation, conveyor.route),
            support=calculation.support,
            rtol=calculation.rtol,
            softened=calculation.strain != "off",
            us_sizes=trade_of(conveyor.report.units) == "US",
            wind_speed=si_or_none(conveyor.ambient.wind_speed),
        )

    @property
    def friction_text(self) -> str:
        """Friction factor f of all stretches, or the range of theirs."""
        low, high = float(self.friction_factors.min()), float(self.friction_factors.max())
        return f"f = {low:g}" if low == high else f"f = {low:g} to {high:g}"

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
    def roll_drag_forces(self) -> Array:
        """Drag of all rolls of every stretch [N], shape (2n,)."""
        whole = (
            idler_rotation_resistance(math.fsum(drags), n_rolls=1, spacing=s.spacing, length=s.length)
            for s, drags in zip(self.stretches, self.roll_drags, strict=True)
        )
        return np.fromiter(whole, float)

    @property
    def drive_bearings(self) -> float:
        """Friction of the drive pulleys' bearings at the belt that the method counts beside the forces [N]."""
        return self.cema.drive_pulleys if self.method == "cema classic" and self.cema is not None else 0.0

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
