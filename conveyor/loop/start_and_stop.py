"""Starting and stopping: accelerations, forces of motors and brakes, slip of the bulk."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

from conveyor.classical_forces import initial_pull
from conveyor.errors import NoSolutionError
from conveyor.laws.motion import Stop, brake_force, bulk_slip_limits, constant_force_stop, run_up_time
from conveyor.laws.resistance.resistance_defaults import ROLL_DRAG_STANDSTILL_FACTOR
from conveyor.line.line import Line
from conveyor.loop.balance import Balance
from conveyor.loop.run_up import run_up
from conveyor.loop.tensions import MotionState


@dataclass(frozen=True)
class Start:
    """The start [N, m/s², s]; for a regenerative conveyor its braking at the start factor.

    Attributes
    ----------
    force : float
        Largest force of all drives on the belt.
    acceleration, time : float
        Acceleration of belt and bulk under it; time to full speed, None if not reached.
    factor : float
        That force over the steady one.
    torque_factor : float or None
        Motor torque needed over the rated one, rotating masses included; None without installed power.
    asked : float or None
        Motor force needed for a controlled start, rotating masses included; None for an uncontrolled one.
    available, least : float or None
        Force of the motors at the belt by their torque: largest and least of the run-up; the least of a controlled
        start with each drive at its share.
    standstill : float
        Force on the belt at rest; in a controlled start with known motors at least their rated force.
    breakaway : float
        Highest resistance after standstill.
    """

    force: float
    acceleration: float
    time: float | None
    factor: float
    torque_factor: float | None
    asked: float | None
    available: float | None
    least: float | None
    standstill: float
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
class StartAndStop:
    """Start and stop of a conveyor.

    Attributes
    ----------
    moving_mass, rotating_mass : float
        Mass of belt, bulk and rolls; that of the drives, reduced to the belt [kg].
    start, design_start : Start
        Start at the spec's start factor, with the expected friction and with that to design for.
    coasting, coasting_design, coasting_least : Stop or None
        Stop without brakes, at computed friction, that to design for and the least certain one; None where the belt
        does not stop by itself.
    braked : Stop or None
        Stop with the brakes of the spec after their delay, at least certain friction; None without brakes or a stop.
    runaway : float or None
        Acceleration without power and brakes at the least certain friction [m/s²]; None where it does not run away.
    gripping_speed : float
        Speed at which the brakes grip [m/s].
    braking_heat : float or None
        Work of all brakes in the braked stop [J].
    brake_to_stop : float or None
        Brake force at the belt for the required deceleration [N], at least certain friction; 0 where none is needed.
    brake_to_hold : float
        Force that holds the loaded belt at rest [N], at least certain friction, by a brake downhill or a backstop
        uphill; 0 where it stays by itself.
    rolls_back : bool
        True if a backstop must hold it.
    hardest : tuple of float
        Hardest deceleration (negative) and highest acceleration that occur, whatever the friction [m/s²].
    slip : SlipLimits or None
        Limits of bulk slip; None on an empty belt.
    states : dict of str to MotionState
        State without drives and brakes, in addition to those of the balance.
    """

    moving_mass: float
    rotating_mass: float
    start: Start
    design_start: Start
    coasting: Stop | None
    coasting_design: Stop | None
    coasting_least: Stop | None
    braked: Stop | None
    runaway: float | None
    gripping_speed: float
    braking_heat: float | None
    brake_to_stop: float | None
    brake_to_hold: float
    rolls_back: bool
    hardest: tuple[float, float]
    slip: SlipLimits | None
    states: dict[str, MotionState]


def start_and_stop(balance: Balance) -> StartAndStop:
    """Start, coasting, braking and holding of a conveyor under its load.

    Parameters
    ----------
    balance : Balance
        The conveyor.
    """
    equilibrium, line = balance.equilibrium, balance.line
    mass, rotating = equilibrium.mass, math.fsum(drive.reduced_mass for drive in line.drives)
    least = equilibrium.least_force
    brakes = math.fsum(line.brakes)
    wanted = line.stop_deceleration
    certain = equilibrium.resistance(0.0)
    moving = math.fsum(force.total for force in equilibrium.points if force.certain and force.kind != "lift")
    lift = certain - moving
    hold, back = _holding_force(lift, least - certain)
    whole = mass + rotating
    gripping = max(0.0, line.speed - least / whole * line.brake_delay)
    stopped, heat = (None, None) if brakes == 0.0 else _braked_stop(line, least, brakes, whole, gripping)
    off, starting = equilibrium.coasting, partial(_conveyor_start, balance, mass, rotating)
    frictions = {1.0, line.design_friction, line.least_friction}
    starts = {friction: starting(friction) for friction in frictions}
    pushes = [start.acceleration for start in starts.values()]
    stop = _hardest_stop(line, equilibrium.design_force, brakes, whole)
    return StartAndStop(
        moving_mass=mass,
        rotating_mass=rotating,
        start=starts[1.0],
        design_start=starts[line.design_friction],
        coasting=_stop_under_force(line.speed, equilibrium.force, whole),
        coasting_design=_stop_under_force(line.speed, equilibrium.design_force, whole),
        coasting_least=_stop_under_force(line.speed, least, whole),
        braked=stopped,
        runaway=-least / whole if least < 0.0 else None,
        gripping_speed=gripping,
        braking_heat=heat,
        brake_to_stop=None if wanted is None else max(0.0, brake_force(wanted, resistance=least, moving_mass=whole)),
        brake_to_hold=hold,
        rolls_back=back,
        hardest=(min(-stop, *pushes), max(0.0, *pushes)),
        slip=_slip_limits(line),
        states={} if off is None else {off.name: off},
    )


def motion_states(balance: Balance, moving: StartAndStop) -> tuple[MotionState, ...]:
    """All states of motion: those that decide the take-up's setting, and coasting."""
    return (*balance.equilibrium.states.values(), *moving.states.values())


def _holding_force(lift: float, friction: float) -> tuple[float, bool]:
    """Force that keeps the belt at rest against gravity net of friction [N]; True if it would roll back."""
    return max(0.0, abs(lift) - friction), lift > 0.0


def _stop_under_force(speed: float, force: float, mass: float) -> Stop | None:
    return constant_force_stop(speed, retarding_force=force, moving_mass=mass) if force > 0.0 else None


def _hardest_stop(line: Line, force: float, brakes: float, mass: float) -> float:
    """Deceleration without drives under a resistance [m/s²], at least 0; with brakes if it runs after their delay."""
    grips = line.speed > force / mass * line.brake_delay
    return max(0.0, (force + brakes) / mass if grips else force / mass)


def _braked_stop(
    line: Line, least: float, brakes: float, mass: float, gripping: float
) -> tuple[Stop | None, float | None]:
    """Stop with brakes that grip after a delay, and their work [J]."""
    if gripping == 0.0:  # the belt rests before they grip
        return _stop_under_force(line.speed, least, mass), 0.0
    made = _stop_under_force(gripping, least + brakes, mass)
    if made is None:
        return None, None
    before = 0.5 * (line.speed + gripping) * line.brake_delay
    whole = Stop(made.deceleration, line.brake_delay + made.time, before + made.distance)
    return whole, brakes * made.distance


def _conveyor_start(balance: Balance, mass: float, rotating: float, friction: float) -> Start:
    """Start at a friction over the computed one [-]."""
    line, steady = balance.line, balance.equilibrium.resistance(friction)
    drag = balance.forces.parts.get("idler_rotation", float(line.roll_drag_forces.sum()))
    stuck = friction * (ROLL_DRAG_STANDSTILL_FACTOR - 1.0) * drag
    stuck += friction * math.fsum(initial_pull(line, point) for point in line.loading)
    if steady <= 0.0:
        factor = line.start_over_steady
        braking = (factor - 1.0) * steady / mass
        time = line.speed / abs(braking) if braking else None
        return Start(factor * steady, braking, time, factor, None, None, None, None, factor * steady, steady + stuck)
    made = run_up(line, steady, mass)
    given = made.force + rotating * made.acceleration
    time = line.speed / made.acceleration if made.acceleration > 0.0 else None
    standstill = made.force
    if made.asked is None and made.rated is not None and made.standstill is not None:
        time = _start_time(line, made.rated, steady, mass + rotating)
        standstill = steady + (made.standstill - steady) * mass / (mass + rotating)
    elif made.rated is not None:  # a controlled start rises until the belt breaks away, to the rated force at least
        standstill = max(standstill, made.rated)
    return Start(
        force=made.force,
        acceleration=made.acceleration,
        time=time,
        factor=made.factor,
        torque_factor=None if made.rated is None else given / made.rated,
        asked=made.asked,
        available=made.largest,
        least=made.least,
        standstill=standstill,
        breakaway=steady + stuck,
    )


def _start_time(line: Line, rated: float, steady: float, mass: float) -> float | None:
    """Run-up time by the torque curve [s]; None where the motors stall."""
    speeds = [line.speed * over for over, _ in line.torque_curve]
    forces = [torque * rated - steady for _, torque in line.torque_curve]
    try:
        return run_up_time(speeds, forces, mass=mass)
    except NoSolutionError:
        return None


def _slip_limits(line: Line) -> SlipLimits | None:
    lows: dict[str, float] = {}
    highs: dict[str, float] = {}
    sliding = []
    for stretch in line.stretches:
        if stretch.bulk_mass == 0.0:
            continue
        try:
            low, high = bulk_slip_limits(line.bulk_belt_friction, inclination=stretch.inclination, gravity=line.gravity)
        except NoSolutionError:
            sliding.append(stretch.section)
            continue
        lows[stretch.section], highs[stretch.section] = low, high
    if not lows:
        return None if not sliding else SlipLimits(0.0, 0.0, sliding[0], sliding[0], tuple(sliding))
    hard, fast = max(lows, key=lambda name: lows[name]), min(highs, key=lambda name: highs[name])
    return SlipLimits(lows[hard], highs[fast], hard, fast, tuple(sliding))
