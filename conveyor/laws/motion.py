"""Starting and stopping: moving masses, starting force, acceleration, coasting, brake, sliding of the bulk.

Source: Newton, with the belt as a rigid ring, as DIN 22101 treats the non-steady states.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import (
    require,
    require_finite,
    require_not_negative,
    require_positive,
    require_slope,
)
from conveyor.errors import NoSolutionError
from conveyor.laws.resistance.resistance_defaults import Default

START_FACTOR: Final = Default(1.3, 1.2, 1.5, "controlled starts of belt conveyors", True)  # [-]
DRIVE_INERTIA: Final = Default(
    0.25, 0.1, 0.5, "motor, coupling and gear: kinetic energy at full speed over rated power", True
)  # [s]


def reduced_mass(inertia: float, *, radius: float, ratio: float = 1.0) -> float:
    """Mass of a rotating part reduced to the belt, m = J i²/r².

    Parameters
    ----------
    inertia : float
        J about its own axis [kg m²], at least 0.
    radius : float
        r of the pulley at the belt [m], positive.
    ratio : float
        i, speed of the part over speed of the pulley [-], positive: the gear's ratio for motor and coupling.

    Returns
    -------
    float
        Reduced mass [kg].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(reduced_mass(2.0, radius=0.5, ratio=20.0), 9)
    3200.0
    """
    require_not_negative(inertia=inertia)
    require_positive(radius=radius, ratio=ratio)
    return inertia * (ratio / radius) ** 2


def typical_reduced_mass(rated_power: float, *, belt_speed: float) -> float:
    """Reduced mass of a drive by its power alone, m = 2 τ P/v², τ = 0.25 s (general knowledge).

    Parameters
    ----------
    rated_power : float
        P of its motors [W], positive.
    belt_speed : float
        v at rated speed [m/s], positive.

    Returns
    -------
    float
        Reduced mass [kg]: its kinetic energy at full speed is what the motors give in τ, 0.1 to 0.5 s.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> typical_reduced_mass(500e3, belt_speed=5.0)
    10000.0
    """
    require_positive(rated_power=rated_power, belt_speed=belt_speed)
    return 2.0 * DRIVE_INERTIA.value * rated_power / belt_speed**2


def run_up_time(speeds: Sequence[float], forces: Sequence[float], *, mass: float) -> float:
    """Time of a start whose accelerating force is linear between points, t = Σ m Δv ln(F2/F1)/(F2 - F1).

    Parameters
    ----------
    speeds : sequence of float
        v of the points from rest to full speed [m/s], ascending, shape (n,).
    forces : sequence of float
        Motors' force less the resistance at each of them [N], shape (n,).
    mass : float
        m of all that is accelerated, the drives too [kg], positive.

    Returns
    -------
    float
        t [s].

    Raises
    ------
    InputError
        An argument is outside its range.
    NoSolutionError
        The motors do not accelerate the belt at one of the speeds.

    Notes
    -----
    Derived: m dv = F(v) dt.

    Examples
    --------
    >>> run_up_time([0.0, 5.0], [10e3, 10e3], mass=50e3)
    25.0
    """
    require_positive(mass=mass)
    require(len(speeds) == len(forces) > 1, "forces", list(forces), "one for each of the speeds, two at least")
    stuck = next((v for v, force in zip(speeds, forces, strict=True) if force <= 0.0), None)
    if stuck is not None:
        raise NoSolutionError(f"the motors do not accelerate the belt at {stuck:.4g} m/s")
    time = 0.0
    for (v1, v2), (f1, f2) in zip(itertools.pairwise(speeds), itertools.pairwise(forces), strict=True):
        require(v2 > v1, "speeds", list(speeds), "ascending speeds")
        steeper = (f2 - f1) / f1
        time += mass * (v2 - v1) / f1 * (math.log1p(steeper) / steeper if steeper else 1.0)
    return time


def start_force(rated_power: float, *, torque_factor: float, efficiency: float, rated_belt_speed: float) -> float:
    """Force at the belt at the start, F = k η P/v.

    Parameters
    ----------
    rated_power : float
        P of all motors [W], positive.
    torque_factor : float
        k, starting over rated torque as the coupling or converter limits it [-], positive.
    efficiency : float
        η of the drive train [-], above 0, at most 1.
    rated_belt_speed : float
        v at rated speed [m/s], positive.

    Returns
    -------
    float
        F [N], the masses of motor and gear still to be accelerated with it.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(start_force(90e3, torque_factor=1.4, efficiency=0.92, rated_belt_speed=4.8))
    24150
    """
    require_positive(rated_power=rated_power, torque_factor=torque_factor, rated_belt_speed=rated_belt_speed)
    require(0.0 < efficiency <= 1.0, "efficiency", efficiency, "> 0 and <= 1")
    return torque_factor * efficiency * rated_power / rated_belt_speed


def bulk_slip_limits(belt_friction: float, *, inclination: float, gravity: float) -> tuple[float, float]:
    """Limits of acceleration at which the bulk does not slip on the belt, |a + g sin δ| ≤ μ g cos δ.

    Parameters
    ----------
    belt_friction : float
        μ, bulk on belt at rest [-], positive.
    inclination : float
        δ in the direction of travel [rad], between -pi/2 and pi/2, positive uphill.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    braking : float
        Lowest acceleration [m/s²], negative: the hardest braking.
    starting : float
        Highest acceleration [m/s²].

    Raises
    ------
    InputError
        An argument is outside its range.
    NoSolutionError
        The bulk slides on the belt even at constant speed.

    Examples
    --------
    >>> [round(a, 3) for a in bulk_slip_limits(0.5, inclination=math.radians(15), gravity=9.81)]
    [-7.277, 2.199]
    """
    require_positive(belt_friction=belt_friction, gravity=gravity)
    require_slope(inclination=inclination)
    grip = belt_friction * gravity * math.cos(inclination)
    pull = gravity * math.sin(inclination)
    if abs(pull) >= grip:
        raise NoSolutionError(
            f"the bulk slides at a slope of {math.degrees(inclination):.3g} deg with friction {belt_friction:g}: "
            "choose a flatter route or a belt with cleats"
        )
    return -grip - pull, grip - pull


@dataclass(frozen=True, slots=True)
class Stop:
    """Deceleration, time and distance of a stop.

    Parameters
    ----------
    deceleration : float
        b [m/s²], positive.
    time : float
        t [s].
    distance : float
        s [m].
    """

    deceleration: float
    time: float
    distance: float


def constant_force_stop(belt_speed: float, *, retarding_force: float, moving_mass: float) -> Stop:
    """Stop under a constant force, b = F/m, t = v/b, s = v²/(2 b).

    Parameters
    ----------
    belt_speed : float
        v [m/s], at least 0.
    retarding_force : float
        F, resistances with the lift plus brake [N].
    moving_mass : float
        m, everything reduced to the belt that stops with it [kg], positive.

    Returns
    -------
    Stop
        Deceleration, time, distance.

    Raises
    ------
    InputError
        An argument is outside its range.
    NoSolutionError
        The force is not positive: the conveyor does not stop.

    Examples
    --------
    >>> constant_force_stop(5.0, retarding_force=25e3, moving_mass=50e3)
    Stop(deceleration=0.5, time=10.0, distance=25.0)
    """
    require_not_negative(belt_speed=belt_speed)
    require_finite(retarding_force=retarding_force)
    require_positive(moving_mass=moving_mass)
    if retarding_force <= 0.0:
        raise NoSolutionError(
            f"a retarding force of {retarding_force:.6g} N does not stop the belt: a brake of more than "
            f"{abs(retarding_force):.6g} N is needed"
        )
    deceleration = retarding_force / moving_mass
    time = belt_speed / deceleration
    return Stop(deceleration=deceleration, time=time, distance=belt_speed * time / 2.0)


def brake_force(deceleration: float, *, resistance: float, moving_mass: float) -> float:
    """Force a brake has to add at the belt, F = m b - W.

    Parameters
    ----------
    deceleration : float
        b wanted [m/s²], at least 0; 0 to hold the belt.
    resistance : float
        W, the least resistances with the lift [N]; negative if the belt runs by itself.
    moving_mass : float
        m [kg], positive.

    Returns
    -------
    float
        F [N]; negative: the conveyor stops harder than that without a brake.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> brake_force(0.4, resistance=-10e3, moving_mass=50e3)
    30000.0
    """
    require_not_negative(deceleration=deceleration)
    require_finite(resistance=resistance)
    require_positive(moving_mass=moving_mass)
    return moving_mass * deceleration - resistance
