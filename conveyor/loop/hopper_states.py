"""A belt feeder in the states of its hoppers: filled after standing, in flow, run out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from conveyor.classical_forces import hopper_forces
from conveyor.line.hopper_outlets import HopperOutlet
from conveyor.loop.balance import Balance, OpenLoop, close_loops, raise_first_error
from conveyor.loop.equilibrium import DESIGN
from conveyor.loop.start_and_stop import StartAndStop
from conveyor.loop.tensions import MotionState

FILLED, FLOW, RUN_OUT = "filled, after standing", "flow", "run-out"
_LOADS: Final[Mapping[str, Callable[[HopperOutlet], float]]] = {
    FILLED: lambda hopper: hopper.initial_load,
    FLOW: lambda hopper: hopper.flow_load,
    RUN_OUT: lambda _: 0.0,
}


@dataclass(frozen=True, eq=False)
class HopperState:
    """A state of all hoppers at once, the take-up at its setting and the friction that to design for.

    Attributes
    ----------
    name : str
        `FILLED`, `FLOW` or `RUN_OUT`, the hopper empty and the belt still full.
    balance : Balance
        The loop under it.
    start_time : float or None
        Time to full speed [s] by the drive force at rest: as if the load stayed, and not less than without it; None
        where the start stalls, or the belt drives.
    """

    name: str
    balance: Balance
    start_time: float | None

    @property
    def motion(self) -> MotionState:
        """Tensions at constant speed with the friction to design for."""
        settled = self.balance.settled
        return settled.states.get(DESIGN, settled.steady)


def hopper_states(balance: Balance, motions: StartAndStop) -> dict[str, HopperState]:
    """States of the hoppers over a belt by their names; none without a hopper that has bulk in it.

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
    if all(point.loaded_hopper is None for point in balance.line.loading):
        return {}
    made = {}
    for name, load in _LOADS.items():
        loop = _with_hopper_loads(balance, load)
        made[name] = HopperState(name, loop, _start_time(loop, motions))
    return made


def _with_hopper_loads(balance: Balance, load: Callable[[HopperOutlet], float]) -> Balance:
    """The loop with other vertical loads under its hoppers, the take-up at its setting."""
    changed = {(force.spot, force.name): force for force in hopper_forces(balance.line, load)}
    frame = balance.frame.scaled(lambda force: changed.get((force.spot, force.name), force))
    asked = OpenLoop.of(frame, balance.along, balance.unit_main, balance.settled.take_up)
    return raise_first_error(close_loops([asked]))[0]


def _start_time(loop: Balance, motions: StartAndStop) -> float | None:
    """Time to full speed under the load of a state [s], at most."""
    start, mass = motions.design_start, motions.moving_mass + motions.rotating_mass
    free = start.standstill - loop.settled.design_force
    if start.time is None or start.force <= 0.0 or free <= 0.0:
        return None
    return max(start.time, loop.line.speed * mass / free)
