"""Drives and take-ups through one step: the motion of their pulleys."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import Array, BeltRow, Chain, Integers, Machines, friction_at_speed
from conveyor.dynamics.wave_solver import NO_CELL, WaveSolver

_SIDES = np.array([1.0, -1.0])[:, None, None]  # before and behind a pulley


_FROM = np.array([0.0, 1.0])[:, None, None]


def motor_lines(chain: Chain, machines: Machines, step: Array) -> Array:
    """Motors and brakes on their characteristics at every step, shape (steps, 6, s, d).

    Share of the limit, brake force, motor force at a standing rim, its fall by the speed at the begin and at the end of
    the step, rim mass with the latter. A rim meets its motor's characteristic in the middle of a step while that
    resolves the approach, else later, so that nothing oscillates.
    """
    gives = step * machines.slope
    late = np.maximum(0.5, 1.0 - np.divide(chain.rim, gives, out=np.full_like(gives, 0.5), where=gives > 0.0))
    slope = machines.slope * (machines.share > 0.0)
    later = late * slope
    return np.stack([
        machines.share, machines.brake, slope * machines.reference, slope - later, later, chain.rim + step * later
    ], axis=1)  # fmt: skip


def group_drives(solver: WaveSolver) -> list[list[int]]:
    """Groups of drives that do not move each other, to rounding."""
    places = solver.places
    mutual = solver.reach[:, places.lumps :, places.of_drives]
    own = np.einsum("sdd->sd", mutual)
    coupled = np.any(np.abs(mutual) > np.finfo(float).eps * own[:, None], axis=0)
    groups: list[list[int]] = []
    for j in range(len(coupled)):
        for group in groups:
            if not (coupled[j, group].any() or coupled[group, j].any()):
                group.append(j)
                break
        else:
            groups.append([j])
    return groups


@dataclass(frozen=True, eq=False)
class DriveGroup:
    """Constants of drives that are solved together; shape (2, s, d) for both sides, negative behind.

    `cells` are both adjacent cells in the row; `ends` is 1 next to the take-up. `reverse` is infinite at a backstop,
    else 0.
    """

    drives: list[int] | slice
    machines: Machines
    rim: Array
    grip: Array
    cells: Integers
    ends: Array
    lying: Array
    inert: Array
    tau_k: Array
    friction: Array
    at_rest: Array
    known: float
    reverse: Array

    @classmethod
    def of(cls, chain: Chain, row: BeltRow, machines: Machines, step: Array, k: list[int]) -> DriveGroup:
        """Some drives of every belt."""
        drives: list[int] | slice = slice(None) if len(k) == chain.nodes.shape[1] else k
        at, before, rows = chain.nodes[:, drives], chain.before[:, :, drives], np.arange(chain.end.size)[:, None]
        weight, mass, stuck = chain.weight[rows, at], chain.mass[rows, at], chain.sticking[rows, at]
        ends = np.stack([at == 0, at == chain.end[:, None]]).astype(float)
        cells = row.first[:, None] + np.stack([at - 1, at])
        return cls(
            drives,
            replace(machines, limits=machines.limits[:, drives], drag=machines.drag[:, drives]),
            chain.rim[:, drives], chain.grip[:, drives], cells=cells, ends=ends,
            lying=np.stack([before[1], before[1] - weight]) + ends * (chain.held[:, None] - NO_CELL),
            inert=np.stack([before[0], before[0] - mass]) / step,
            tau_k=chain.retardation * row.cells(chain.stiffness, 0.0)[cells],
            friction=np.stack([before[2:5], chain.friction[:, rows, at]], axis=1),
            at_rest=np.stack([_safe_ratio(before[5], stuck), stuck]), known=chain.known,
            reverse=np.where(chain.backstop[:, drives], np.inf, 0.0),
        )  # fmt: skip

    def belt_friction(self, on: Array) -> tuple[Array, Array]:
        """Friction on driven masses at their speed [N]; its share before the pulleys, and behind them negative [-]."""
        friction = friction_at_speed(self.friction, on, self.known)
        friction[0] = _safe_ratio(friction[0], friction[1])
        np.copyto(friction, self.at_rest, where=on == 0.0)
        return friction[1], friction[0] - _FROM


def _safe_ratio(part: Array, whole: Array) -> Array:
    """Part over whole; 0 if the whole is 0."""
    return np.divide(part, whole, out=np.zeros(whole.shape), where=whole > 0.0)


@dataclass(frozen=True, eq=False)
class GroupResponse:
    """Response of the belts to a group of drives: speeds by an impulse, damping and adjacent tensions by a speed.

    `reach` is the speed by a force over the step, `near` those before, at and behind all drives by an impulse, `softer`
    the damping at new speeds, `gives` the tension added by a speed, before, and behind negative, `yields` the same with
    what lies on the pulley.
    """

    own: Array
    reach: Array
    near: Array
    of_take_up: Array
    softer: Array
    gives: Array
    yields: Array

    @classmethod
    def of(cls, solver: WaveSolver, turn: DriveGroup, step: Array) -> GroupResponse:
        """Response of the present system."""
        lumps, drives, k = solver.places.lumps, solver.places.drives, turn.drives
        near, of_take_up = solver.reach[:, lumps:, lumps:][:, k], solver.of_take_up[:, lumps:][:, k]
        sides = np.einsum("sdkd->ksd", near.reshape(*near.shape[:2], 3, drives)[..., k])
        own = sides[1]
        reach, apart = own * step, _SIDES * (1.0 - sides[::2] / own)
        softer = 0.5 * turn.tau_k * solver.shares.take(turn.cells, mode="wrap")
        gives = softer * apart - turn.ends * (of_take_up / reach)
        return cls(own, reach, near, of_take_up, softer, gives, turn.inert + gives)


def winch_direction(over: Array, band: Array) -> Array:
    """1 for a winch that takes in, -1 for one that pays out, 0 within its band."""
    return np.asarray(np.where(over < -band, 1.0, np.where(over > band, -1.0, 0.0)))


class PulleyState(NamedTuple):
    """Driven pulleys after a step: forces on the belt, of motor, brake and friction, side tensions [N], speeds."""

    force: Array
    motor: Array
    holding: Array
    friction: Array
    rim: Array
    belt: Array
    sides: Array
    slips: NDArray[np.bool_]


def speed_after_friction(free: Array, forward: Array, backward: Array) -> Array:
    """Speed left by friction, which takes up to `forward` off a free speed or adds up to `backward`."""
    return free - np.minimum(np.maximum(free, -backward), forward)


def solve_pulleys(
    turn: DriveGroup, motors: Array, *, step: Array, answer: Array, reach: Array, rim: Array, free: Array, sides: Array,
    yields: Array, friction: Array, shares: Array, last: tuple[Array, Array], slipped: NDArray[np.bool_],
) -> PulleyState:  # fmt: skip
    """Solve motors, brakes, rims and the belt on them together; a motor on its characteristic, or at its limit.

    `free` is the belt's speed without the pulley, `answer` its change by an impulse, `reach` by a force over the step;
    `sides` are the tensions before and behind at zero speed there and without friction, `yields` their change by a
    speed, `shares` that by friction. They include mass and damping of the half cells up to the pulley, so that a sudden
    force is split by the impedances of both sides, however long the cells. A belt that had not `slipped` and now slips
    is taken to start slipping in the middle of the step: force and tensions are the mean of the `last` and the new
    ones. At the start of the step they would make the tension oscillate from cell to cell.
    """
    grip = turn.grip
    share, brake, base, early, later, mass = motors
    most, rests = share * turn.machines.limit(rim), reach * friction
    halts = reach * brake + rests
    for tried in range(2):
        base_now = base - early * rim  # of the motor, without the part by the new speed
        push = turn.rim * rim + step * base_now
        heavy = 1.0 + answer * mass
        stop = halts / heavy
        common = speed_after_friction((free + answer * push) / heavy, stop, stop + turn.reverse)
        taken = np.sign(common) * friction
        rubbed = sides + shares * taken
        force = (common - free) / reach + taken
        tensions = rubbed + yields * common
        bears = grip * np.maximum(tensions, 0.0)
        forward, slips = force > bears[1], force < -bears[0]
        slips |= forward
        belt, turned = common, common
        if np.count_nonzero(slips):
            pushed, slack = np.where(forward, rubbed[1], -rubbed[0]), np.where(forward, -yields[1], yields[0])
            eased = 1.0 + reach * grip * slack
            rub = rests / eased
            earlier, begins = last[0] + grip * np.where(forward, -last[1][1], last[1][0]), slips & ~slipped
            driven = grip * pushed + np.where(begins, 0.5 * earlier, 0.0)
            slid = speed_after_friction((free + reach * driven) / eased, rub, rub)
            limit = driven - grip * slack * slid
            limit = np.where(forward, np.maximum(limit, 0.0), np.minimum(limit, 0.0))
            slid = np.where(limit == 0.0, speed_after_friction(free, rests, rests), slid)
            force = np.where(slips, limit, force)
            stop = step * (brake + np.where(most > 0.0, 0.0, turn.machines.drag)) / mass
            spun = speed_after_friction((push - step * force) / mass, stop, stop + turn.reverse)
            belt, turned = np.where(slips, slid, common), np.where(slips, spun, common)
            taken = force - (belt - free) / reach
            tensions = sides + yields * belt + shares * taken
            tensions = np.where(begins, 2.0 * tensions - last[1], tensions)
        motor = base_now - later * turned
        beyond = np.abs(motor) > most
        if tried or not np.count_nonzero(beyond):
            break
        base, within = np.where(beyond, np.copysign(most, motor), base), ~beyond
        early, later = early * within, later * within
        mass = turn.rim + step * later
    return PulleyState(force, motor, (push - mass * turned) / step - force, taken, turned, belt, tensions, slips)
