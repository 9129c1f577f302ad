"""Drives and take-ups through one step: the motion of their pulleys."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import Array, Chain, Integers, Machines
from conveyor.dynamics.wave_solver import WaveSolver

_SIDES, _FROM = (
    np.array([1.0, -1.0])[:, None, None],
    np.array([0.0, 1.0])[:, None, None],
)  # before and behind a pulley


@dataclass(frozen=True, eq=False)
class DriveGroup:
    """Constants of drives that are solved together; shape (2, s, d) for both sides, negative behind.

    Flat indices of their places and adjacent cells; `ends` is true next to the take-up. `reverse` is infinite at a
    backstop, else 0. `late` is the time within a step at which a rim meets its motor's characteristic: the middle while
    the step resolves the approach, else later, so that nothing oscillates.
    """

    drives: list[int] | slice
    chain: Chain
    machines: Machines
    at: Integers
    sides: Integers
    ahead: Integers
    astern: Integers
    ends: NDArray[np.bool_]
    lying: Array
    inert: Array
    tau_k: Array
    stuck: Array
    at_rest: Array
    reverse: Array
    late: Array

    @classmethod
    def of(cls, chain: Chain, machines: Machines, step: Array, k: list[int]) -> DriveGroup:
        """Some drives of every belt."""
        drives: list[int] | slice = slice(None) if len(k) == chain.nodes.shape[1] else k
        (s, n), at, before = chain.stiffness.shape, chain.nodes[:, drives], chain.before[:, :, drives]
        rows = np.arange(s)[:, None]
        side = np.stack([np.maximum(at - 1, 0), np.minimum(at, n - 1)])
        astern = rows * (n + 1) + side
        rim, gives = chain.rim[:, drives], step * machines.slope[:, drives]
        weight, mass, stuck = chain.weight[rows, at], chain.mass[rows, at], chain.sticking[rows, at]
        return cls(
            drives,
            replace(chain, rim=rim, grip=chain.grip[:, drives], backstop=chain.backstop[:, drives],
                    before=before),
            replace(
                machines, slope=machines.slope[:, drives], reference=machines.reference[..., drives],
                share=machines.share[..., drives], brake=machines.brake[..., drives], limits=machines.limits[:, drives],
                drag=machines.drag[:, drives],
            ),
            at=rows * (n + 1) + at, sides=rows * n + side, ahead=astern + 1, astern=astern,
            ends=np.stack([at == 0, at == chain.end[:, None]]),
            lying=np.stack([before[1], before[1] - weight]),
            inert=np.stack([before[0], before[0] - mass]) / step,
            tau_k=chain.retardation * chain.stiffness[rows, side], stuck=stuck, at_rest=_safe_ratio(before[5], stuck),
            reverse=np.where(chain.backstop[:, drives], np.inf, 0.0),
            late=np.maximum(0.5, 1.0 - np.divide(rim, gives, out=np.full_like(gives, 0.5), where=gives > 0.0)),
        )  # fmt: skip

    def shares(self, on: Array, rests: NDArray[np.bool_], rolling: Array) -> Array:
        """Share of the friction on driven masses before the pulleys, and behind them negative [-]."""
        parabola, size = self.chain.before[2:5], np.minimum(np.abs(on), self.chain.known)
        moving = _safe_ratio(parabola[0] + size * (parabola[1] + size * parabola[2]), rolling)
        return np.asarray(np.where(rests, self.at_rest, moving) - _FROM)


def _safe_ratio(part: Array, whole: Array) -> Array:
    """Part over whole; 0 if the whole is 0."""
    return np.divide(part, whole, out=np.zeros_like(whole), where=whole > 0.0)


@dataclass(frozen=True, eq=False)
class GroupResponse:
    """Response of the belts to a group of drives: speeds by an impulse, damping and adjacent tensions by a speed.

    `reach` is the speed by a force over the step, `softer` the damping at new speeds, `yields` the tension added by a
    speed, before, and behind negative.
    """

    own: Array
    reach: Array
    columns: Array
    of_take_up: Array
    softer: Array
    yields: Array

    @classmethod
    def of(cls, solver: WaveSolver, turn: DriveGroup, step: Array) -> GroupResponse:
        """Response of the present system."""
        k, pulleys = turn.drives, solver.pulleys
        softer = 0.5 * turn.tau_k * solver.shares.take(turn.sides)
        own, of_take_up = pulleys.own[:, k], pulleys.of_take_up[:, k]
        apart = pulleys.beside[:, :, k] * _SIDES
        tight = -of_take_up / (own * step)
        yields = turn.inert + np.where(turn.ends, tight, softer * apart)
        return cls(own, own * step, pulleys.columns[:, k], of_take_up, softer, yields)


def winch_direction(over: Array, band: Array) -> Array:
    """1 for a winch that takes in, -1 for one that pays out, 0 within its band."""
    return np.asarray(np.where(over < -band, 1.0, np.where(over > band, -1.0, 0.0)))


@dataclass(frozen=True, eq=False)
class PulleyState:
    """Driven pulleys after a step: forces on the belt, of motor, brake and friction, side tensions [N], speeds."""

    force: Array
    motor: Array
    holding: Array
    friction: Array
    rim: Array
    belt: Array
    sides: Array
    grips: NDArray[np.bool_]


def speed_after_friction(free: Array, forward: Array, backward: Array) -> Array:
    """Speed left by friction, which takes up to `forward` off a free speed or adds up to `backward`."""
    return free - np.minimum(np.maximum(free, -backward), forward)


def solve_pulleys(
    turn: DriveGroup, i: int, *, step: Array, answer: Array, reach: Array, rim: Array, free: Array, sides: Array,
    yields: Array, friction: Array, shares: Array, last: tuple[Array, Array], gripped: NDArray[np.bool_],
) -> PulleyState:  # fmt: skip
    """Solve motors, brakes, rims and the belt on them together; a motor on its characteristic, or at its limit.

    `free` is the belt's speed without the pulley, `answer` its change by an impulse, `reach` by a force over the step;
    `sides` are the tensions before and behind at zero speed there and without friction, `yields` their change by a
    speed, `shares` that by friction. They include mass and damping of the half cells up to the pulley, so that a sudden
    force is split by the impedances of both sides, however long the cells. A belt that `gripped` and now slips is taken
    to start slipping in the middle of the step: force and tensions are the mean of the `last` and the new ones. At the
    start of the step they would make the tension oscillate from cell to cell.
    """
    chain, machines, late = turn.chain, turn.machines, turn.late
    most = machines.share[i] * machines.limit(rim)
    brake, grip = machines.brake[i], chain.grip
    on = most > 0.0
    slope = machines.slope * on
    base, rests = slope * machines.reference[i], reach * friction
    for tried in range(2):
        later = late * slope
        base_now = base - (slope - later) * rim  # of the motor, without the part by the new speed
        mass, push = chain.rim + step * later, chain.rim * rim + step * base_now
        heavy = 1.0 + answer * mass
        stop = (reach * brake + rests) / heavy
        common = speed_after_friction((free + answer * push) / heavy, stop, stop + turn.reverse)
        against = np.sign(common) * friction
        rubbed = sides + shares * against
        force = (common - free) / reach + against
        bears = grip * np.maximum(rubbed + yields * common, 0.0)
        forward, slips = force > bears[1], force < -bears[0]
        slips |= forward
        belt, turned, begins = common, common, None
        if slips.any():
            pushed, slack = np.where(forward, rubbed[1], -rubbed[0]), np.where(forward, -yields[1], yields[0])
            eased = 1.0 + reach * grip * slack
            rub = rests / eased
            earlier, begins = last[0] + grip * np.where(forward, -last[1][1], last[1][0]), gripped & slips
            driven = grip * pushed + np.where(begins, 0.5 * earlier, 0.0)
            slid = speed_after_friction((free + reach * driven) / eased, rub, rub)
            limit = driven - grip * slack * slid
            limit = np.where(forward, np.maximum(limit, 0.0), np.minimum(limit, 0.0))
            slid = np.where(limit == 0.0, speed_after_friction(free, rests, rests), slid)
            force = np.where(slips, limit, force)
            stop = step * (brake + np.where(on, 0.0, machines.drag)) / mass
            spun = speed_after_friction((push - step * force) / mass, stop, stop + turn.reverse)
            belt, turned = np.where(slips, slid, common), np.where(slips, spun, common)
        motor = base_now - later * turned
        beyond = np.abs(motor) > most
        if tried or not beyond.any():
            break
        base, slope = np.where(beyond, np.copysign(most, motor), base), slope * ~beyond
    taken = force - (belt - free) / reach
    tensions = sides + yields * belt + shares * taken
    if begins is not None:
        tensions = np.where(begins, 2.0 * tensions - last[1], tensions)
    return PulleyState(force, motor, (push - mass * turned) / step - force, taken, turned, belt, tensions, ~slips)
