"""Force of the drives on the belt at the start: asked for by a controlled start, or all that the motors give."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.motion import START_FACTOR, start_force
from conveyor.line.line import Line


@dataclass(frozen=True)
class RunUp:
    """A start, all drives together rigidly coupled by the belt.

    Attributes
    ----------
    forces : tuple of float
        Of every drive on the belt at its largest [N], its own rotating masses accelerated too.
    acceleration : float
        Of belt and bulk with them [m/s²].
    factor : float
        Their sum over the steady force [-].
    asked : float or None
        Force that a controlled start asks of the motors, referred to the belt [N]; None of an uncontrolled one.
    rated, standstill, least, largest : float or None
        Force of the motors at the belt [N]: rated, at rest, least and largest of the run-up; None where not known. Of
        a controlled start the least is what they give while each keeps its share.
    """

    forces: tuple[float, ...]
    acceleration: float
    factor: float
    asked: float | None
    rated: float | None
    standstill: float | None
    least: float | None
    largest: float | None

    @property
    def force(self) -> float:
        """Of all drives on the belt [N]."""
        return math.fsum(self.forces)


def run_up(line: Line, steady: float, mass: float) -> RunUp:
    """How the conveyor starts under a load.

    Parameters
    ----------
    line : Line
        Drives, start factor, torque curve.
    steady : float
        Drive force in steady running [N], positive.
    mass : float
        Of belt, bulk and rolls [kg].

    Notes
    -----
    Of the motor's force k η P/v each drive keeps what accelerates its own rotating masses: F = k η P/v - m a. A
    controlled start keeps the shares of the drives and is as fast as the weakest motor allows.
    """
    drives, masses = line.drives, [drive.reduced_mass for drive in line.drives]
    rated, torques = _rated(line), [torque for _, torque in line.torque_curve]
    together = None if rated is None else math.fsum(rated)
    standstill = least = largest = None
    if together is not None and torques:
        standstill, least, largest = (
            torque * together for torque in (torques[0], min(torques), max(torques))
        )
    if line.start_factor is None and rated is not None and torques:
        given = [max(torques) * force for force in rated]
        acceleration = (math.fsum(given) - steady) / (mass + math.fsum(masses))
        forces = [force - own * acceleration for force, own in zip(given, masses, strict=True)]
        if acceleration <= 0.0:
            forces, acceleration = [drive.share * steady for drive in drives], 0.0
        return RunUp(
            tuple(forces),
            acceleration,
            math.fsum(forces) / steady,
            None,
            together,
            standstill,
            least,
            largest,
        )
    wanted = START_FACTOR.value if line.start_factor is None else line.start_factor
    own = math.fsum(masses) / mass

    def of_motors(factor: float) -> float:
        return factor * steady + (factor - 1.0) * steady * own

    most = wanted
    if rated is not None and torques:
        possible = min(
            (min(torques) * force / steady + drive.reduced_mass / mass)
            / (drive.share + drive.reduced_mass / mass)
            for force, drive in zip(rated, drives, strict=True)
            if drive.share + drive.reduced_mass > 0.0
        )
        most, least = min(wanted, possible), of_motors(possible)
    factor = max(1.0, most)
    return RunUp(
        tuple(drive.share * factor * steady for drive in drives),
        (factor - 1.0) * steady / mass, factor, of_motors(wanted), together, standstill, least, largest,
    )  # fmt: skip


def _rated(line: Line) -> list[float] | None:
    """Rated force of every drive's motors at the belt [N]; None where a power is not known."""
    powers = [drive.power for drive in line.drives if drive.power is not None]
    if len(powers) < len(line.drives):
        return None
    return [
        start_force(power, torque_factor=1.0, efficiency=line.efficiency, rated_belt_speed=line.speed)
        for power in powers
    ]
