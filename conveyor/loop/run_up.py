"""Drive forces at the start: those of a controlled start, or all that the motors give."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.motion import start_force
from conveyor.line.line import Line

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StartingForces:
    """Force limits of the drives at a start; drives on the last axis, loops before it.

    Attributes
    ----------
    share, own : ndarray, shape (d,)
        Share of each drive in the whole force [-], its rotating masses at the belt [kg].
    least, most : ndarray, shape (d,)
        Force of its motors at the belt at their least and largest torque [N]; infinite if unknown.
    factor : ndarray, shape ()
        Force of a controlled start over the steady one [-].
    kind : {"uncontrolled", "limited", "asked"}
        Full motor force on the belt; controlled start with known motors; controlled start with unknown motors.
    """

    share: Array
    own: Array
    least: Array
    most: Array
    factor: Array
    kind: str

    @classmethod
    def of(cls, line: Line) -> StartingForces:
        """Limits of a line's drives."""
        rated, torques = _rated_forces(line), [torque for _, torque in line.torque_curve]
        least = most = unknown = np.full(len(line.drives), np.inf)
        if rated is not None and torques:
            least, most = min(torques) * np.array(rated), max(torques) * np.array(rated)
        return cls(
            np.array([drive.share for drive in line.drives]),
            np.array([drive.reduced_mass for drive in line.drives]),
            least,
            most,
            np.array(line.start_over_steady),
            "uncontrolled" if is_start_uncontrolled(line) else "asked" if least is unknown else "limited",
        )


@dataclass(frozen=True)
class RunUp:
    """A start with all drives rigidly coupled by the belt.

    Attributes
    ----------
    forces : tuple of float
        Largest force of every drive on the belt [N], net of its own rotating masses.
    acceleration : float
        Acceleration of belt and bulk under them [m/s²].
    factor : float
        Their sum over the steady force [-].
    asked : float or None
        Motor force needed for a controlled start, referred to the belt [N]; None for an uncontrolled one.
    rated, standstill, least, largest : float or None
        Force of the motors at the belt [N]: rated, at rest, least and largest of the run-up; None if unknown. In a
        controlled start the least is that with each drive at its share.
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
        """Force of all drives on the belt [N]."""
        return math.fsum(self.forces)


def run_up(line: Line, steady: float, mass: float) -> RunUp:
    """Start of the conveyor under a load.

    Parameters
    ----------
    line : Line
        Drives, start factor, torque curve.
    steady : float
        Drive force in steady running [N], positive.
    mass : float
        Moving mass of belt, bulk and rolls [kg].

    Notes
    -----
    Of the motor's force k η P/v each drive keeps what accelerates its own rotating masses: F = k η P/v - m a. A
    controlled start keeps the shares of the drives and is as fast as the weakest motor allows.
    """
    rated, torques, pull = (
        _rated_forces(line),
        [torque for _, torque in line.torque_curve],
        StartingForces.of(line),
    )
    pushed, per_drive = start_motion(pull, np.asarray(steady), np.asarray(mass))
    forces, acceleration = tuple(per_drive.tolist()), float(pushed)
    factor = math.fsum(forces) / steady
    together = None if rated is None else math.fsum(rated)
    standstill = least = largest = None
    if together is not None and torques:
        standstill, least, largest = (torque * together for torque in (torques[0], min(torques), max(torques)))
    if is_start_uncontrolled(line):
        return RunUp(forces, acceleration, factor, None, together, standstill, least, largest)
    own = float(pull.own.sum()) / mass

    def of_motors(factor: float) -> float:
        return factor * steady + (factor - 1.0) * steady * own

    if rated is not None and torques:
        least = of_motors(float(_possible_start_factor(pull, np.asarray(steady), np.asarray(mass))))
    return RunUp(forces, acceleration, factor, of_motors(line.start_over_steady), together, standstill, least, largest)


def is_start_uncontrolled(line: Line) -> bool:
    """True if a start takes the full motor force, not a multiple of the steady force."""
    return line.start_factor is None and _rated_forces(line) is not None and bool(line.torque_curve)


def start_motion(pull: StartingForces, steady: Array, mass: Array) -> tuple[Array, Array]:
    """Acceleration [m/s²], and force of every drive [N] on a last axis, at one or many loads as `run_up` takes them."""
    if pull.kind == "uncontrolled":
        free = pull.most.sum(axis=-1) - steady
        acceleration = np.maximum(free / (mass + pull.own.sum(axis=-1)), 0.0)
        pulled = pull.most - pull.own * acceleration[..., None]
        return acceleration, np.where(acceleration[..., None] > 0.0, pulled, pull.share * steady[..., None])
    asked = pull.factor if pull.kind == "asked" else np.minimum(pull.factor, _possible_start_factor(pull, steady, mass))
    factor = np.maximum(1.0, asked)
    return (factor - 1.0) * steady / mass, pull.share * (factor * steady)[..., None]


def rated_force(line: Line) -> float | None:
    """Rated force of all motors at the belt [N]; None if a power is unknown."""
    rated = _rated_forces(line)
    return None if rated is None else math.fsum(rated)


def start_force_ratio(pull: StartingForces, steady: Array, mass: Array) -> Array:
    """Needed over available motor force of a controlled start of kind "limited" [-]; the weakest motor limits."""
    own, possible = pull.own.sum() / mass, _possible_start_factor(pull, steady, mass)
    return np.asarray((pull.factor + (pull.factor - 1.0) * own) / (possible + (possible - 1.0) * own))


def _possible_start_factor(pull: StartingForces, steady: Array, mass: Array) -> Array:
    """Largest start factor at which the weakest motor at its least torque keeps its share; infinite if unknown."""
    own = pull.own / mass[..., None]
    asked, given = pull.share + own, pull.least / steady[..., None] + own
    factors = np.divide(given, asked, out=np.full(given.shape, np.inf), where=asked > 0.0)
    return np.asarray(factors.min(axis=-1))


def _rated_forces(line: Line) -> list[float] | None:
    """Rated force of every drive's motors at the belt [N]; None if a power is unknown."""
    powers = [drive.power for drive in line.drives if drive.power is not None]
    if len(powers) < len(line.drives):
        return None
    return [
        start_force(power, torque_factor=1.0, efficiency=line.efficiency, rated_belt_speed=line.speed)
        for power in powers
    ]
