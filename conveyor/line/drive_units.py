"""Drives in SI: shares, brakes, rotating masses and their parts."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.motion import reduced_mass, typical_reduced_mass
from conveyor.line.drive_scenarios import StarterUnit
from conveyor.line.loop_positions import LoopPosition, LoopPositions
from conveyor.line.optional_quantities import si_or_default, si_or_none
from conveyor.models import Conveyor, Drive, DrivePulley
from conveyor.models.drive import Shaft
from conveyor.models.part_conflicts import drive_diameter
from conveyor.units import Quantity, si


@dataclass(frozen=True)
class DriveParts:
    """Parts of a drive; None not given.

    Number of `motors` and their rated `rotation` [1/s], gear `ratio`, rated torque of the `backstop` [N m], required
    `starts` [1/h], `loss` of pulley diameter [m], mass of the brake's `disc` [kg] and the `heat` it may take [J],
    rated torques of `gearbox` and `coupling` of a motor [N m] and their `service` over the motor's [-].
    """

    motors: int
    rotation: float | None
    ratio: float | None
    backstop: float | None
    starts: float | None
    loss: float | None
    disc: float | None
    heat: float | None
    gearbox: float | None
    coupling: float | None
    service: float


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


def drive_units(conveyor: Conveyor, places: LoopPositions) -> tuple[DriveUnit, ...]:
    """Drives of a conveyor in the order of the spec."""
    pulleys = conveyor.drive.pulleys
    names = conveyor.drive.names
    return tuple(
        DriveUnit(
            name=name,
            spot=places.drive(pulley),
            share=share,
            friction=pulley.friction,
            wrap_angle=si(pulley.wrap_angle),
            power=si_or_none(pulley.installed_power),
            brake=_brake_force(conveyor, pulley),
            reduced_mass=_reduced_mass(conveyor, pulley),
            mass_given=pulley.reduced_mass is not None or pulley.inertia is not None,
            radius=_drive_radius(conveyor, pulley),
            starter=None if pulley.starter is None else StarterUnit.of(pulley.starter),
            backstop=pulley.backstop,
            parts=_drive_parts(conveyor, pulley) if any(other.judged for other in pulleys) else None,
        )
        for name, pulley, share in zip(names, pulleys, _drive_shares(pulleys), strict=True)
    )


def _drive_parts(conveyor: Conveyor, pulley: DrivePulley) -> DriveParts:
    return DriveParts(
        motors=pulley.motors,
        rotation=None if pulley.motor_speed is None else si(pulley.motor_speed),
        ratio=pulley.gear_ratio,
        backstop=_torque_at_pulley(conveyor, pulley, pulley.backstop_torque, pulley.backstop_shaft),
        starts=pulley.starts_per_hour,
        loss=si_or_none(pulley.diameter_loss),
        disc=si_or_none(pulley.brake_disc),
        heat=si_or_none(pulley.brake_heat),
        gearbox=si_or_none(pulley.gear_torque),
        coupling=si_or_none(pulley.coupling_torque),
        service=conveyor.drive.service_factor,
    )


def _brake_force(conveyor: Conveyor, pulley: DrivePulley) -> float | None:
    """Force of a drive's brake at the belt [N]; None without one."""
    torque = _torque_at_pulley(conveyor, pulley, pulley.brake_torque, pulley.brake_shaft)
    radius = _drive_radius(conveyor, pulley)
    return si_or_none(pulley.brake_force) if torque is None or radius is None else torque / radius


def _torque_at_pulley(conveyor: Conveyor, pulley: DrivePulley, torque: Quantity | None, shaft: Shaft) -> float | None:
    """Torque at the pulley of one at a shaft of the drive [N m], without losses; None if not given."""
    if torque is None or shaft == "pulley":
        return si_or_none(torque)
    if pulley.gear_ratio is not None:
        return si(torque) * pulley.gear_ratio
    radius = _drive_radius(conveyor, pulley)
    if pulley.motor_speed is None or radius is None:
        raise AssertionError("a torque at the motor's shaft has a ratio, or speed and radius")
    return si(torque) * si(pulley.motor_speed) * 2.0 * math.pi * radius / si(conveyor.belt.speed)


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


def torque_curve(drive: Drive) -> tuple[tuple[float, float], ...]:
    """Torque over the rated one against speed over the rated one, to full speed; empty if not given."""
    if drive.torque_factor is not None:
        return ((0.0, drive.torque_factor), (1.0, drive.torque_factor))
    points = [(si(point.speed), point.torque) for point in drive.torque_curve]
    return tuple(points if not points or points[-1][0] == 1.0 else [*points, (1.0, points[-1][1])])


def _drive_shares(pulleys: tuple[DrivePulley, ...]) -> list[float]:
    """Share of each drive in the whole force: as given, else by installed power."""
    if any(pulley.share is not None for pulley in pulleys):
        return [si_or_default(pulley.share, 0.0) for pulley in pulleys]
    if len(pulleys) == 1:
        return [1.0]
    powers = [si_or_default(pulley.installed_power, 0.0) for pulley in pulleys]
    return [power / math.fsum(powers) for power in powers]
