"""Starting and stopping: accelerations, what motors and brakes have to give, and whether the bulk stays on the belt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from conveyor.errors import NoSolutionError
from conveyor.laws.motion import Stop, brake_force, bulk_slip_limits, start_force, stop
from conveyor.laws.resistance.defaults import ROLL_DRAG_STANDSTILL_FACTOR
from conveyor.line.line import Line
from conveyor.loop.balance import Balance
from conveyor.loop.settled import coasting
from conveyor.loop.tensions import MotionState

COASTING = "drives off"


@dataclass(frozen=True)
class Start:
    """The start [N, m/s², s]; of a regenerative conveyor its braking at the start factor.

    Attributes
    ----------
    force : float
        Of all drives on the belt: the steady one times the start factor.
    acceleration, time : float
        Of belt and bulk, until full speed; time is None where the start factor is 1.
    torque_factor : float or None
        Motor torque over the rated one for it, rotating masses of the drives included; None without installed power.
    available : float or None
        Force the motors give at the belt at the largest torque factor of the spec.
    breakaway : float
        Resistance with the rolls after standstill, at most.
    """

    force: float
    acceleration: float
    time: float | None
    torque_factor: float | None
    available: float | None
    breakaway: float


@dataclass(frozen=True)
class SlipLimits:
    """Accelerations between which the bulk stays on the belt, and the sections that set them [m/s²]."""

    braking: float
    starting: float
    braking_at: str
    starting_at: str
    sliding: tuple[str, ...]
    """Sections so steep that the bulk slides at constant speed."""


@dataclass(frozen=True, eq=False)
class Motions:
    """Start and stop of a conveyor.

    Attributes
    ----------
    moving_mass, rotating_mass : float
        Of belt, bulk and rolls; of the drives, reduced to the belt [kg].
    start : Start
        With the spec's start factor.
    coasting, coasting_least : Stop or None
        Without brakes, with the computed and the least certain friction; None where the belt does not stop by itself.
    braked : Stop or None
        With the brakes of the spec and the least certain friction; None without brakes or where they do not stop it.
    brake_to_stop : float or None
        Brake force at the belt for the deceleration wanted [N], at least certain friction; 0 where none is needed.
    brake_to_hold : float
        Force that holds the loaded belt at rest [N], at least certain friction; 0 where it stays by itself. Of a
        brake on a downhill conveyor, of a backstop on an uphill one.
    rolls_back : bool
        Whether it is a backstop.
    slip : SlipLimits or None
        None where nothing lies on the belt.
    states : dict of str to State
        Tensions without drives and brakes, beside the states of the balance.
    """

    moving_mass: float
    rotating_mass: float
    start: Start
    coasting: Stop | None
    coasting_least: Stop | None
    braked: Stop | None
    brake_to_stop: float | None
    brake_to_hold: float
    rolls_back: bool
    slip: SlipLimits | None
    states: dict[str, MotionState]

    @cached_property
    def hardest(self) -> tuple[float, float]:
        """Hardest deceleration (negative) and highest acceleration that occur [m/s²]."""
        found = [0.0, self.start.acceleration]
        found += [-s.deceleration for s in (self.coasting, self.coasting_least, self.braked) if s is not None]
        return min(found), max(found)


def motions(found: Balance) -> Motions:
    """Start, coasting, braking and holding of a conveyor under its load.

    Parameters
    ----------
    found : Balance
        Its forces, and the loop of its tensions.
    """
    settled, line = found.settled, found.line
    loop = settled.loop
    mass, rotating = loop.masses.whole, math.fsum(drive.reduced_mass for drive in line.drives)
    least = settled.least_force
    brakes = math.fsum(line.brakes)
    wanted = line.stop_deceleration
    moving = math.fsum(force.total for force in loop.points if force.certain)
    hold, back = _holding(loop.lifts.whole, least - loop.lifts.whole - moving)
    off = coasting(loop, settled.bends, 1.0, [0.0] * len(line.drives), COASTING)
    return Motions(
        moving_mass=mass,
        rotating_mass=rotating,
        start=_start(found, mass, rotating),
        coasting=_stop(line.speed, settled.force, mass + rotating),
        coasting_least=_stop(line.speed, least, mass + rotating),
        braked=None if brakes == 0.0 else _stop(line.speed, least + brakes, mass + rotating),
        brake_to_stop=None
        if wanted is None
        else max(0.0, brake_force(wanted, resistance=least, moving_mass=mass + rotating)),
        brake_to_hold=hold,
        rolls_back=back,
        slip=_slip(line),
        states={} if off is None else {off.name: loop.state(off, settled.setting)},
    )


def every_state(found: Balance, moving: Motions) -> tuple[MotionState, ...]:
    """Tensions in every state of motion: those that decide the take-up's setting, and those of stopping."""
    return (*found.settled.states.values(), *moving.states.values())


def _holding(lift: float, friction: float) -> tuple[float, bool]:
    """Force that keeps the belt at rest, and whether it would roll back; friction acts against what gravity wants."""
    return max(0.0, abs(lift) - friction), lift > 0.0


def _stop(speed: float, force: float, mass: float) -> Stop | None:
    return stop(speed, retarding_force=force, moving_mass=mass) if force > 0.0 else None


def _start(found: Balance, mass: float, rotating: float) -> Start:
    line, steady = found.line, found.settled.force
    force = line.start_factor * steady
    acceleration = (line.start_factor - 1.0) * steady / mass
    powers = [drive.power for drive in line.drives]
    installed = math.fsum(power for power in powers if power is not None)
    rated = available = None
    if all(power is not None for power in powers) and force > 0.0:
        one = start_force(
            installed, torque_factor=1.0, efficiency=line.efficiency, rated_belt_speed=line.speed
        )
        rated = (force + rotating * acceleration) / one
        if line.torque_factor is not None:
            available = line.torque_factor * one
    stuck = (ROLL_DRAG_STANDSTILL_FACTOR - 1.0) * found.forces.parts["idler_rotation"]
    return Start(
        force=force,
        acceleration=acceleration,
        time=None if acceleration == 0.0 else line.speed / abs(acceleration),
        torque_factor=rated,
        available=available,
        breakaway=steady + stuck,
    )


def _slip(line: Line) -> SlipLimits | None:
    lows: dict[str, float] = {}
    highs: dict[str, float] = {}
    sliding = []
    for stretch in line.stretches:
        if stretch.bulk_mass == 0.0:
            continue
        try:
            low, high = bulk_slip_limits(
                line.bulk_on_belt, inclination=stretch.inclination, gravity=line.gravity
            )
        except NoSolutionError:
            sliding.append(stretch.section)
            continue
        lows[stretch.section], highs[stretch.section] = low, high
    if not lows:
        return None if not sliding else SlipLimits(0.0, 0.0, sliding[0], sliding[0], tuple(sliding))
    hard, fast = max(lows, key=lambda name: lows[name]), min(highs, key=lambda name: highs[name])
    return SlipLimits(lows[hard], highs[fast], hard, fast, tuple(sliding))
