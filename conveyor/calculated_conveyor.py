"""A conveyor calculated: every figure of one load, SI."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.forces import RubberFreeForces
from conveyor.line.contacts import Contacts, RollResult
from conveyor.line.covers import CoverState
from conveyor.line.line import Line
from conveyor.line.stretches import Strand, Stretch
from conveyor.loop.annual_energy import AnnualEnergy, annual_energy
from conveyor.loop.balance import Balance
from conveyor.loop.belt_duty import BeltDuty, belt_duty
from conveyor.loop.drive_duty import DriveDuty, drive_duty
from conveyor.loop.hopper_states import HopperState, hopper_states
from conveyor.loop.horizontal_curve_duty import HorizontalCurveCheck, horizontal_curve_checks
from conveyor.loop.loop_layout import TakeUpSetting
from conveyor.loop.pipe_curve_duty import PipeCurveCheck, pipe_curve_checks
from conveyor.loop.pulley_duty import PulleyDuty, pulley_duty
from conveyor.loop.set_duty import SetDuty, set_duty
from conveyor.loop.start_and_stop import StartAndStop, motion_states, start_and_stop
from conveyor.loop.take_up_duty import TakeUpDuty, take_up_duty
from conveyor.loop.tension_coupling import Convergence
from conveyor.loop.tensions import MotionState
from conveyor.loop.transfer_points import (
    CleanerDuty,
    LoadingPointDuty,
    Trajectory,
    cleaner_duty,
    discharge_trajectory,
    loading_point_duty,
)
from conveyor.models import Conveyor

NoAnswer: TypeAlias = NoSolutionError | RangeError | InputError


@dataclass(frozen=True, eq=False)
class Variant:
    """A conveyor with overrides.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    temperature : float, optional
        Temperature of the covers instead of the spec's [K]; the air stays.
    indentation_factors : mapping of strand to float
        Factor on a strand's indentation [-]; 1 if absent.
    roll_drag : float
        Factor on the drag of all rolls [-].
    take_up : TakeUpSetting, optional
        Setting of the take-up by other loads, instead of the spec's or the least [N], and its side.
    design_friction : float, optional
        Friction to design for over the computed one [-], where the spec gives none; 1 for the expected figures alone.
        Without it the upper end of the band of this variant's own defaults.
    """

    conveyor: Conveyor
    temperature: float | None = None
    indentation_factors: Mapping[Strand, float] = field(default_factory=dict)
    roll_drag: float = 1.0
    take_up: TakeUpSetting | None = None
    design_friction: float | None = None

    @property
    def covers_at(self) -> float:
        """Temperature of the covers [K]."""
        return self.conveyor.temperature if self.temperature is None else self.temperature


@dataclass(frozen=True, eq=False)
class StretchResult:
    """Results of a section of one strand: rolls on their cover, and every force along it [N].

    Attributes
    ----------
    stretch : Stretch
        Geometry, masses and loads.
    cover : CoverState
        Cover under its rolls.
    rolls : tuple of RollResult
        Rolls of one set, left to right.
    forces : mapping
        Forces by key, as in `Balance.along`.
    main, unit_main : float
        Main resistance, and that which DIN 22101 gives for f = 1.
    """

    stretch: Stretch
    cover: CoverState
    rolls: tuple[RollResult, ...]
    forces: Mapping[str, float]
    main: float
    unit_main: float

    @property
    def total(self) -> float:
        """All forces along the stretch [N]."""
        return math.fsum(self.forces.values())


@dataclass(frozen=True, eq=False)
class CalculatedConveyor:
    """Everything calculated for one conveyor, SI.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    temperature : float
        Temperature of its covers [K].
    contacts : Contacts
        Contacts of all rolls.
    balance : Balance
        Forces, tensions, power.
    fixed : RubberFreeForces
        Forces independent of the rubber.
    convergence : Convergence or None
        Convergence of tensions and roll loads; None without coupling.
    friction_band : tuple of float or None
        Low and high factor on the computed friction [-]; least_friction and design_friction of the line where None.
    start_of_motors : float or None
        Force at rest of motors of unknown power, sized for the load that needs most [N]; None where only this load is
        known, or every power.
    """

    conveyor: Conveyor
    temperature: float
    contacts: Contacts
    balance: Balance
    rubber_free: RubberFreeForces
    convergence: Convergence | None = None
    friction_band: tuple[float, float] | None = None
    start_of_motors: float | None = None

    @cached_property
    def drive_forces(self) -> tuple[float, float]:
        """Drive force at both ends of the friction band [N]."""
        equilibrium = self.balance.equilibrium
        low, high = map(
            equilibrium.resistance, self.friction_band or (self.line.least_friction, self.line.design_friction)
        )
        return low, high

    @property
    def governing_motor_power(self) -> float:
        """Motor power at the less favourable end of the friction band [W]; negative: generating."""
        least, most = map(self.balance.layout.motor, self.drive_forces)
        return least if abs(least) > abs(most) else most

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.balance.line

    @cached_property
    def stretches(self) -> tuple[StretchResult, ...]:
        """Results of every section: carry strand from the tail, return strand from the head."""
        along = {force.key: force for force in self.balance.along}
        columns = [force.newtons.tolist() for force in along.values() if not isinstance(force.newtons, float)]
        main = [key for key, force in along.items() if force.kind == "main"]
        results = []
        for stretch, rolls, unit_main, *newtons in zip(
            self.line.stretches, self.contacts.rolls, self.rubber_free.unit_main.tolist(), *columns, strict=True
        ):
            forces = dict(zip(along, newtons, strict=True))
            total = math.fsum(forces[key] for key in main)
            cover = self.contacts.covers[stretch.strand]
            results.append(StretchResult(stretch, cover, rolls, forces, total, unit_main))
        return tuple(results)

    @cached_property
    def motions(self) -> StartAndStop:
        """Start, coasting, braking, holding; slip limits of the bulk."""
        return start_and_stop(self.balance)

    @property
    def motion_states(self) -> tuple[MotionState, ...]:
        """Tensions in every state of motion."""
        return motion_states(self.balance, self.motions)

    @cached_property
    def take_up(self) -> TakeUpDuty:
        """Setting, mass and travel of the take-up for this load."""
        return common_take_up_duty([self])

    @cached_property
    def belt_duty(self) -> BeltDuty:
        """Safety of the belt, diameters of the pulleys, radii of vertical curves, lengths of transitions."""
        return belt_duty(self.balance, self.motion_states)

    @cached_property
    def horizontal(self) -> tuple[HorizontalCurveCheck, ...]:
        """Horizontal curves on both strands: drift in every state, radii, tensions of the edges."""
        return horizontal_curve_checks(self.balance, self.motion_states)

    @cached_property
    def pipe_curves(self) -> tuple[PipeCurveCheck, ...]:
        """Curves of a pipe on both strands: tensions, radii, force on a panel."""
        return pipe_curve_checks(self.line, self.motion_states)

    @cached_property
    def pulley_duty(self) -> tuple[PulleyDuty, ...]:
        """Loads of every pulley in every state, its shaft, bearings and lagging."""
        return pulley_duty(self.balance, self.motion_states)

    @cached_property
    def drive_duty(self) -> tuple[DriveDuty, ...]:
        """Gear, backstop, brake, starts and sharing of the drives whose parts the spec gives."""
        return drive_duty(self.balance, self.motions)

    @cached_property
    def set_duty(self) -> tuple[SetDuty, ...]:
        """Load, axles, life and flap of the idler sets whose limits the spec gives."""
        return set_duty(self.balance)

    @cached_property
    def hopper_states(self) -> tuple[HopperState, ...]:
        """States of the hoppers over a belt feeder; none without a hopper that has bulk in it."""
        return hopper_states(self.balance, self.motions)

    @cached_property
    def loading_point_duty(self) -> tuple[LoadingPointDuty, ...]:
        """Impact and skirts of every loading point."""
        return loading_point_duty(self.line)

    @cached_property
    def cleaner_duty(self) -> tuple[CleanerDuty, ...]:
        """Carryback behind every cleaner."""
        return cleaner_duty(self.line)

    @cached_property
    def trajectory(self) -> Trajectory | None:
        """Trajectory of the bulk over the head pulley, where the spec gives `discharge`."""
        return discharge_trajectory(self.line)

    @cached_property
    def year(self) -> AnnualEnergy | None:
        """Annual energy at constant load and its cost; None without hours or with a duty."""
        operation = self.conveyor.operation
        if operation is None or operation.duty:
            return None
        return annual_energy(operation, self.balance.power.mains, self.line.flow)

    @property
    def error_estimate(self) -> float:
        """Largest relative error estimate of any roll's indentation [-]."""
        return self.contacts.error


def common_take_up_duty(loads: Sequence[CalculatedConveyor], temperatures: Iterable[float] = ()) -> TakeUpDuty:
    """Setting, mass and travel of the take-up for several loads calculated at one setting.

    The travel covers further `temperatures` of the belt [K], too.
    """
    return take_up_duty(
        [load.balance for load in loads],
        [load.motion_states for load in loads],
        [*(load.temperature for load in loads), *temperatures],
    )
