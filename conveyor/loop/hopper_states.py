"""A belt feeder in the states of its hoppers: filled after standing, in flow, run out."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.classical_forces import hopper_forces
from conveyor.loop.balance import Balance, OpenLoop, close_loops, raise_first_error
from conveyor.loop.equilibrium import DESIGN
from conveyor.loop.start_and_stop import StartAndStop
from conveyor.loop.tensions import MotionState


@dataclass(frozen=True, eq=False)
class HopperState:
    """A state of all hoppers at once, the take-up at its setting and the friction that to design for.

    Attributes
    ----------
    name : str
        "filled, after standing", "in flow" or "run-out", the hopper empty and the belt still full.
    balance : Balance
        The loop in steady running; filled hoppers are those of a start, their bulk in flow soon after.
    motion : MotionState
        Tensions with the friction to design for, at constant speed or when the belt breaks the bulk away.
    start_time : float or None
        Time to full speed [s] by the drive force at rest: as if the load stayed, and not less than without it; None
        where the start stalls, or the belt drives.
    """

    name: str
    balance: Balance
    motion: MotionState
    start_time: float | None


def hopper_states(balance: Balance, motions: StartAndStop) -> tuple[HopperState, ...]:
    """States of the hoppers over a belt: filled, flow, run-out; none without a hopper that has bulk in it.

    Parameters
    ----------
    balance : Balance
        The conveyor, its hoppers in flow.
    motions : StartAndStop
        Its start.

    Raises
    ------
    NoSolutionError
        The tensions do not converge.
    """
    filled = balance.settled.filled
    if filled is None:
        return ()
    run_out = _without_hopper_loads(balance)
    made = (
        ("filled, after standing", balance, filled),
        ("in flow", balance, _design_motion(balance)),
        ("run-out", run_out, _design_motion(run_out)),
    )
    return tuple(HopperState(name, loop, state, _start_time(loop, state, motions)) for name, loop, state in made)


def _design_motion(balance: Balance) -> MotionState:
    return balance.settled.states.get(DESIGN, balance.settled.steady)


def _without_hopper_loads(balance: Balance) -> Balance:
    """The loop without vertical loads under its hoppers, the take-up at its setting."""
    changed = {(force.spot, force.name): force for force in hopper_forces(balance.line, lambda _: 0.0)}
    frame = balance.frame.scaled(lambda force: changed.get((force.spot, force.name), force))
    asked = OpenLoop.of(frame, balance.along, balance.unit_main, balance.settled.take_up)
    return raise_first_error(close_loops([asked]))[0]


def _start_time(loop: Balance, state: MotionState, motions: StartAndStop) -> float | None:
    """Time to full speed under the load of a state [s], at most."""
    start, mass = motions.design_start, motions.moving_mass + motions.rotating_mass
    free = start.standstill - state.force
    if start.time is None or start.force <= 0.0 or free <= 0.0:
        return None
    return max(start.time, loop.line.speed * mass / free)
