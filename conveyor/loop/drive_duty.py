"""Loads on the parts of every drive: gear, backstop, brake, starts an hour, sharing without control."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from conveyor.errors import RangeError
from conveyor.laws.drives import (
    Poles,
    allowed_starts,
    backstop_torque,
    disc_temperature_rise,
    flywheel_inertia,
    gear_torque,
    nearest_ratio,
    next_preferred_number,
    shared_forces,
)
from conveyor.laws.motion import start_force
from conveyor.laws.waves import MOTOR_SLIP
from conveyor.line.drive_units import DriveParts, DriveUnit
from conveyor.line.line import Line
from conveyor.loop.balance import Balance
from conveyor.loop.equilibrium import DESIGN
from conveyor.loop.start_and_stop import StartAndStop
from conveyor.loop.take_up_duty import belt_stiffness

# [1/s], slowest rated speed of 2, 4 and 6 poles at 50 Hz, 8 poles at 60 Hz below it; derived
_POLE_SPEEDS: tuple[tuple[Poles, float], ...] = ((2, 40.0), (4, 22.5), (6, 15.2))


@dataclass(frozen=True, eq=False)
class DriveDuty:
    """A drive under one load.

    Attributes
    ----------
    line : Line
        The conveyor.
    drive : DriveUnit
        The drive.
    parts : DriveParts
        Its parts in the spec.
    moving : StartAndStop
        Start and stop of the conveyor.
    backstops : int
        Number of drives with a backstop.
    shared : float or None
        Its steady force where only the belt couples the drives [N]; None without a diameter loss.
    """

    line: Line
    drive: DriveUnit
    parts: DriveParts
    moving: StartAndStop
    backstops: int
    shared: float | None

    @property
    def rotation(self) -> float | None:
        """Rotation of the pulley [1/s]; None without its diameter."""
        radius = self.drive.radius
        return None if radius is None else self.line.speed / (2.0 * math.pi * radius)

    @property
    def ratio(self) -> float | None:
        """Speed of the motor over that of the pulley [-]: as given, else from the motor speed."""
        if self.parts.ratio is not None or self.parts.rotation is None or self.rotation is None:
            return self.parts.ratio
        return self.parts.rotation / self.rotation

    @property
    def standard_ratio(self) -> float | None:
        """Nearest preferred gear ratio [-]."""
        return None if self.ratio is None else nearest_ratio(self.ratio)

    @cached_property
    def gear(self) -> float | None:
        """Gear size for one motor by its rated torque, of the preferred numbers [N m]; None without power."""
        return None if self.gear_torque is None else next_preferred_number(self.gear_torque)

    @property
    def gear_torque(self) -> float | None:
        """Rated torque asked of the gearbox of one motor, at its slow shaft [N m]; None without power or diameter."""
        return self._rated_torque(self.rotation)

    @property
    def coupling_torque(self) -> float | None:
        """Rated torque asked of the coupling of one motor, at the motor's shaft [N m]; None without motor speed."""
        return self._rated_torque(self.parts.rotation)

    def _rated_torque(self, rotation: float | None) -> float | None:
        """Service factor times the torque of one motor at a shaft [N m]."""
        if self.drive.power is None or rotation is None:
            return None
        return gear_torque(self.drive.power / self.parts.motors, rotation=rotation, service=self.parts.service)

    @cached_property
    def holding(self) -> float | None:
        """Backstop torque that holds the loaded belt [N m]; None without a backstop or roll-back."""
        radius, has = self.drive.radius, self.parts.backstop is not None or self.drive.backstop is True
        if radius is None or not has or not self.moving.rolls_back:
            return None
        return backstop_torque(self.moving.brake_to_hold, radius=radius, count=self.backstops)

    @cached_property
    def stalled(self) -> float | None:
        """Torque at the pulley when motors trip at largest torque, the belt blocked [N m]; None if unknown.

        Of its own motors; a backstop bears its part of what drives without one pulled, too: nothing else holds that.
        """
        others = self.line.drives if _has_backstop(self.drive) else ()
        unheld = [_stall_force(self.line, drive) for drive in others if not _has_backstop(drive)]
        forces = [_stall_force(self.line, self.drive), *unheld]
        if self.drive.radius is None or None in forces:
            return None
        own, *more = (force for force in forces if force is not None)
        held = backstop_torque(math.fsum(more), radius=self.drive.radius, count=self.backstops) if more else 0.0
        return own * self.drive.radius + held

    @property
    def backstop(self) -> float | None:
        """Required backstop torque [N m]."""
        return None if self.holding is None else max(self.holding, self.stalled or 0.0)

    @cached_property
    def load_inertia(self) -> float | None:
        """Load inertia at the shaft of one motor [kg m²]; None without motor speed."""
        if self.parts.rotation is None:
            return None
        mass = self.moving.moving_mass * self.drive.share / self.parts.motors
        return mass * (self.line.speed / (2.0 * math.pi * self.parts.rotation)) ** 2

    @cached_property
    def allowed_starts(self) -> float | str | None:
        """Starts an hour allowed by NEMA [1/h], or why unknown; None where none are required."""
        power, inertia, rotation = self.drive.power, self.load_inertia, self.parts.rotation
        if self.parts.starts is None or power is None or inertia is None or rotation is None:
            return None
        poles = next((number for number, slowest in _POLE_SPEEDS if rotation > slowest), None)
        if poles is None:
            return "NEMA's table of starts has 2, 4 and 6 poles: ask the motor's maker"
        try:
            return allowed_starts(power / self.parts.motors, poles=poles, load_inertia=inertia)
        except RangeError as error:
            return str(error)

    @property
    def heat(self) -> float | None:
        """Brake heat of a stop at the least certain friction [J]; None without a brake or a stop."""
        if self.drive.brake is None or self.moving.braking_heat is None:
            return None
        return self.moving.braking_heat * self.drive.brake / math.fsum(self.line.brakes)

    @property
    def disc_rise(self) -> float | None:
        """Temperature rise of the brake disc in that stop [K]."""
        if self.heat is None or self.parts.disc is None:
            return None
        return disc_temperature_rise(self.heat, mass=self.parts.disc)


def drive_duty(balance: Balance, moving: StartAndStop) -> tuple[DriveDuty, ...]:
    """Duties of every drive whose parts the spec gives."""
    line = balance.line
    backstops = sum(_has_backstop(drive) for drive in line.drives)
    shared = _shared_drive_forces(balance)
    return tuple(
        DriveDuty(line, drive, drive.parts, moving, max(backstops, 1), None if shared is None else shared[i])
        for i, drive in enumerate(line.drives)
        if drive.parts is not None
    )


def _stall_force(line: Line, drive: DriveUnit) -> float | None:
    """Largest force of the motors of a drive at the belt [N]; None without power or torque curve."""
    if drive.power is None or not line.torque_curve:
        return None
    return start_force(
        drive.power,
        torque_factor=max(torque for _, torque in line.torque_curve),
        efficiency=line.efficiency,
        rated_belt_speed=line.speed,
    )


def _has_backstop(drive: DriveUnit) -> bool:
    return drive.backstop is True or (drive.parts is not None and drive.parts.backstop is not None)


def _shared_drive_forces(balance: Balance) -> tuple[float, ...] | None:
    """Forces of several drives coupled by the belt alone [N], with the friction to design for.

    None where no pulley is below nominal.
    """
    line, stiffness = balance.line, belt_stiffness(balance.line.belt)
    states = balance.equilibrium.states
    steady = states.get(DESIGN, balance.equilibrium.steady)
    powers = [drive.power for drive in line.drives if drive.power is not None]
    smaller = any(drive.parts is not None and drive.parts.loss is not None for drive in line.drives)
    if len(line.drives) == 1 or not smaller or stiffness is None or len(powers) < len(line.drives):
        return None
    first = steady.drives[0].arriving
    return shared_forces(
        balance.equilibrium.design_force,
        rated=[power * line.efficiency / line.speed for power in powers],
        slips=[MOTOR_SLIP.value if drive.starter is None else drive.starter.slip for drive in line.drives],
        diameters=[_diameter_ratio(drive) for drive in line.drives],
        strains=[(side.arriving - first) / stiffness for side in steady.drives],
    )


def _diameter_ratio(drive: DriveUnit) -> float:
    if drive.parts is None or drive.parts.loss is None or drive.radius is None:
        return 1.0
    return 1.0 - drive.parts.loss / (2.0 * drive.radius)


def coasting_flywheel(line: Line, moving: StartAndStop) -> float | None:
    """Flywheel inertia at the motor shafts for the required coasting time [kg m²].

    None where none is required, the belt does not stop by itself, or ratio or diameter of the first drive are unknown.
    """
    first, stopped = line.drives[0], moving.coasting_design
    ratio = None if first.parts is None else first.parts.ratio
    if ratio is None and first.parts is not None and first.parts.rotation is not None and first.radius is not None:
        ratio = 2.0 * math.pi * first.radius * first.parts.rotation / line.speed
    if line.coast_time is None or stopped is None or ratio is None or first.radius is None:
        return None
    whole = moving.moving_mass + moving.rotating_mass
    return flywheel_inertia(
        line.coast_time,
        retarding_force=stopped.deceleration * whole,
        moving_mass=whole,
        belt_speed=line.speed,
        radius=first.radius,
        ratio=ratio,
    )
