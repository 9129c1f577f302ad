"""A belt feeder in the states of its hoppers: filled after standing, in flow, run out."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.loop.balance import Balance
from conveyor.loop.equilibrium import DESIGN, FILLED, RUN_OUT
from conveyor.loop.start_and_stop import StartAndStop
from conveyor.loop.tensions import MotionState


@dataclass(frozen=True, eq=False)
class HopperState:
    """A state of all hoppers at once, the take-up at its setting and the friction that to design for.

    Attributes
    ----------
    name : str
        "filled, after standing", "in flow" or "run-out", the hopper empty and the belt still full.
    motion : MotionState
        Tensions with the friction to design for, at constant speed or when the belt breaks the bulk away.
    start_time : float or None
        Time to full speed [s] by the drive force at rest: as if the load stayed, and not less than without it; None
        where the start stalls, or the belt drives.
    """

    name: str
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
    """
    states = balance.equilibrium.states
    if FILLED not in states:
        return ()
    made = (
        ("filled, after standing", states[FILLED]),
        ("in flow", states.get(DESIGN, balance.equilibrium.steady)),
        ("run-out", states[RUN_OUT]),
    )
    speed = balance.line.speed
    return tuple(HopperState(name, state, _start_time(speed, state, motions)) for name, state in made)


def _start_time(speed: float, state: MotionState, motions: StartAndStop) -> float | None:
    """Time to full speed under the load of a state [s], at most."""
    start, mass = motions.design_start, motions.moving_mass + motions.rotating_mass
    free = start.standstill - state.force
    if start.time is None or start.force <= 0.0 or free <= 0.0:
        return None
    return max(start.time, speed * mass / free)
