"""Force of the drives on the belt at the start: asked for by a controlled start, or all that the motors give."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.motion import start_force
from conveyor.line.line import Line

Array = NDArray[np.float64]


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
    drives, rated, torques = line.drives, _rated(line), [torque for _, torque in line.torque_curve]
    pushed, per_drive = started(line, np.asarray(steady), np.asarray(mass))
    forces, acceleration = tuple(per_drive.tolist()), float(pushed)
    factor = math.fsum(forces) / steady
    together = None if rated is None else math.fsum(rated)
    standstill = least = largest = None
    if together is not None and torques:
        standstill, least, largest = (
            torque * together for torque in (torques[0], min(torques), max(torques))
        )
    if uncontrolled(line):
        return RunUp(forces, acceleration, factor, None, together, standstill, least, largest)
    own = math.fsum(drive.reduced_mass for drive in drives) / mass

    def of_motors(factor: float) -> float:
        return factor * steady + (factor - 1.0) * steady * own

    if rated is not None and torques:
        least = of_motors(float(_possible(line, np.asarray(steady), np.asarray(mass))))
    return RunUp(
        forces, acceleration, factor, of_motors(line.start_over_steady), together, standstill, least, largest
    )


def uncontrolled(line: Line) -> bool:
    """Whether a start takes all that the motors give, and not a multiple of the steady force."""
    return line.start_factor is None and _rated(line) is not None and bool(line.torque_curve)


def started(line: Line, steady: Array, mass: Array) -> tuple[Array, Array]:
    """Acceleration [m/s²] and force of every drive [N], shape (d, ...), at one or many loads as `run_up` takes them."""
    shares = np.array([drive.share for drive in line.drives])
    own = np.array([drive.reduced_mass for drive in line.drives])
    if uncontrolled(line):
        given = max(torque for _, torque in line.torque_curve) * np.array(_rated(line))
        acceleration = np.maximum((given.sum() - steady) / (mass + own.sum()), 0.0)
        pulled = np.add.outer(given, np.zeros_like(acceleration)) - np.multiply.outer(own, acceleration)
        return acceleration, np.where(acceleration > 0.0, pulled, np.multiply.outer(shares, steady))
    factor = np.maximum(1.0, np.minimum(line.start_over_steady, _possible(line, steady, mass)))
    return (factor - 1.0) * steady / mass, np.multiply.outer(shares, factor * steady)


def _possible(line: Line, steady: Array, mass: Array) -> Array:
    """The same at which the weakest motor, at its least torque, still keeps its share; infinite where not known."""
    rated, torques = _rated(line), [torque for _, torque in line.torque_curve]
    if rated is None or not torques:
        return np.full_like(steady, np.inf)
    factors = [
        (min(torques) * force / steady + drive.reduced_mass / mass)
        / (drive.share + drive.reduced_mass / mass)
        for force, drive in zip(rated, line.drives, strict=True)
        if drive.share + drive.reduced_mass > 0.0
    ]
    return np.asarray(np.min(factors, axis=0))


def _rated(line: Line) -> list[float] | None:
    """Rated force of every drive's motors at the belt [N]; None where a power is not known."""
    powers = [drive.power for drive in line.drives if drive.power is not None]
    if len(powers) < len(line.drives):
        return None
    return [
        start_force(power, torque_factor=1.0, efficiency=line.efficiency, rated_belt_speed=line.speed)
        for power in powers
    ]
