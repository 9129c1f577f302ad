"""Candidates, and a closed estimate of each: friction by scaling laws, tensions round the loop, cost of a year.

Indentation goes with (W⁴ h/D²)^(1/3), the scaling of Winkler's foundation (Jonkers 1980); its level, that of roll drag
and of the secondary resistances are set by exact calculations of some candidates. It chooses what is worth calculating,
nothing else: no figure of a design comes from here.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.belt import CLASSIC_SAFETY
from conveyor.laws.loading import middle_share_belt, middle_share_bulk
from conveyor.laws.resistance.flexure import FLEXURE_COEFFICIENT
from conveyor.laws.roll_life import BALL_EXPONENT, RATED_REVOLUTIONS
from conveyor.line.task import Choice, SizingTask, spread
from conveyor.models.sizing import DriveLayout
from conveyor.sizing.costs import Parts, costs

Array = NDArray[np.float64]

_LOAD: Final = 4.0 / 3.0  # exponent of the line load
_WING: Final = 2.0**_LOAD / (_LOAD + 1.0)  # a triangular load over an even one
_CLEANERS: Final = 2.0 * 0.008 * 30e3 * 0.6  # [N/m], of belt width: `line.usual`
_SKIRTS: Final = 2.0 * 0.7 * 9.81 / 0.625**2  # [m/s²]: both zones of the usual skirts, over (Q/v)²/(ρ B²) and 1 m
_SET: Final = 0.5  # life of the bearings of a set over that of the heaviest loaded alone
_ANYWHERE: Final = 1e9  # [N]
_ROUNDS: Final = 4  # class of the belt, its mass, its tensions


@dataclass(frozen=True)
class Levels:
    """Levels of the estimate: indentation under carry and return rolls [Pa^(-1/3)], of each cover; drag of a roll [N];
    secondary and special resistances over the estimated ones [-].
    """

    carry: tuple[float, ...]
    back: tuple[float, ...]
    drag: float
    rest: float


def first_levels(covers: int) -> Levels:
    """Levels to begin with: Jonkers at E' 10 MPa and tan δ 0.12; they choose what is calculated first."""
    jonkers = 1.138 * 0.12 / 1e7 ** (1.0 / 3.0)
    return Levels((jonkers,) * covers, (jonkers,) * covers, 2.5, 1.0)


def candidates(task: SizingTask) -> list[Choice]:
    """Every combination that keeps the rules of width, lumps, filling, edge distance, and rotation."""
    found = []
    for trough, speed in itertools.product(task.troughs, task.speeds):
        filling = task.filling(trough, speed)
        if filling is None:
            continue
        rolls = [roll for roll in task.rolls if task.turns_slowly(roll, speed)]
        for roll, carry, back, cover, kind, drives in itertools.product(
            rolls, *task.spacings, range(len(task.duty.covers)), task.carcasses, task.rules.drives
        ):
            if carry <= back:
                found.append(Choice(trough, speed, filling, roll, carry, back, cover, kind, drives))
    return found


@dataclass(frozen=True, eq=False)
class Screened:
    """The estimate of every candidate, shape (n,).

    Attributes
    ----------
    year : ndarray
        Cost of a year [currency/a]; infinite where no belt, motor or bearing of the series does.
    carcass : ndarray of int
        Number of the class of the belt.
    force : ndarray
        On all drives [N].
    indentation : ndarray, shape (n, 2)
        Of carry and return strand [N].
    rolls : ndarray
        In all sets.
    rest : ndarray
        Secondary and special resistances [N].
    """

    year: Array
    carcass: NDArray[np.int64]
    force: Array
    indentation: Array
    rolls: Array
    rest: Array


def screen(task: SizingTask, choices: Sequence[Choice], levels: Levels) -> Screened:
    """Estimate every candidate."""

    def each(get: object) -> Array:
        return np.array([get(choice) for choice in choices], dtype=float)  # type: ignore[operator]

    g, length = task.gravity, task.length
    width, speed = each(lambda c: c.trough.width.belt), each(lambda c: c.speed)
    carry, back, diameter = each(lambda c: c.carry), each(lambda c: c.back), each(lambda c: c.roll.diameter)
    three = each(lambda c: c.trough.width.three)
    count, flat = each(lambda c: c.trough.width.return_rolls[0]), each(lambda c: c.trough.width.return_rolls[1])
    bulk = task.flow / speed
    shares = {(c.trough.angle, c.trough.width.belt): (
        middle_share_bulk(c.trough.angle), middle_share_belt(c.trough.width.three, belt_width=c.trough.width.belt)
    ) for c in choices}  # fmt: skip
    of_bulk, of_belt = np.array([shares[c.trough.angle, c.trough.width.belt] for c in choices]).T
    wear = {v: task.wear(v) for v in set(speed.tolist())}
    rest = task.flow * speed + _CLEANERS * width + _SKIRTS * bulk**2 / (task.density * width**2) * speed
    rest *= levels.rest
    rolls = 3.0 * length / carry + count * length / back
    sections = np.array(task.sections)
    carcass = np.zeros(len(choices), dtype=np.int64)
    kinds = {kind: (each(lambda c, kind=kind: c.kind == kind) > 0.0, classes) for kind, classes in task.carcasses.items()}  # fmt: skip
    possible = np.ones(len(choices), dtype=bool)
    for _ in range(_ROUNDS):
        strength, belt_mass, top, bottom = (np.empty(len(choices)) for _ in range(4))
        for mine, classes in kinds.values():
            covers = {(k, v): one.covers(wear[v]) for k, one in enumerate(classes) for v in wear}
            chosen = [covers[k, v] for k, v in zip(carcass[mine].tolist(), speed[mine].tolist(), strict=True)]
            top[mine], bottom[mine] = np.array(chosen).reshape(-1, 2).T
            strength[mine] = np.array([one.strength for one in classes])[carcass[mine]]
            belt_mass[mine] = np.array([one.mass for one in classes])[carcass[mine]]
        belt_mass = width * (belt_mass + 1150.0 * (top + bottom))
        middle = (of_bulk * bulk + of_belt * belt_mass) * g * carry
        wing = 0.5 * ((1.0 - of_bulk) * bulk + (1.0 - of_belt) * belt_mass) * g * carry
        on_wing = np.minimum(three, 0.5 * (width - three))
        k_carry = np.array(levels.carry)[[c.cover for c in choices]] * (bottom / diameter**2) ** (1.0 / 3.0)
        k_back = np.array(levels.back)[[c.cover for c in choices]] * (top / diameter**2) ** (1.0 / 3.0)
        per_set = three * (middle / three) ** _LOAD + 2.0 * _WING * on_wing * (wing / on_wing) ** _LOAD
        wide = np.minimum(width, count * flat)
        indentation = np.array([
            k_carry * per_set * length / carry,
            k_back * wide * (belt_mass * g * back / wide) ** _LOAD * length / back,
        ])  # fmt: skip
        bent = FLEXURE_COEFFICIENT.value * g * np.array(task.sags)[:, None] * [belt_mass + bulk, belt_mass] * length
        turning = levels.drag * np.array([3.0 * length / carry, count * length / back])
        friction = (indentation + turning + bent) / length
        up = np.outer(bulk + belt_mass, g * sections[:, 1]) + np.outer(friction[0], sections[:, 0])
        down = np.outer(-belt_mass, g * sections[:, 1]) + np.outer(friction[1], sections[:, 0])
        up[:, 0] += rest
        force = up.sum(axis=1) + down.sum(axis=1)
        slack, largest = _tensions(task, choices, force, down[:, ::-1], up, belt_mass, bulk, carry, back)
        for kind, (mine, classes) in kinds.items():
            safety = CLASSIC_SAFETY["steel cord" if kind == "steel cord" else "textile"]
            needed = safety * largest[mine] / width[mine]
            carcass[mine] = np.searchsorted([one.strength for one in classes], needed)
            possible[mine] = carcass[mine] < len(classes)
            carcass[mine] = np.minimum(carcass[mine], len(classes) - 1)
    power = np.abs(force) * speed / task.efficiency
    drives = each(lambda c: len(spread(1.0, c.drives)))
    possible &= power * task.rules.motor_reserve <= drives * task.largest_motor
    possible &= (each(lambda c: c.drives == "tail") > 0.0) == (force < 0.0)
    rating = each(lambda c: c.roll.rating)
    hours = RATED_REVOLUTIONS * (rating / (0.5 * middle)) ** BALL_EXPONENT / (speed / (math.pi * diameter))
    possible &= _SET * hours >= task.roll_life
    prices, first = task.duty.prices.amounts, each(lambda c: c.cover == 0)
    masses = {(c.roll.diameter, c.trough.width.belt): (
        3.0 * c.roll.mass(c.trough.width.three), c.trough.width.return_rolls[0] * c.roll.mass(c.trough.width.return_rolls[1])
    ) for c in choices}  # fmt: skip
    of_set, of_back = np.array([masses[c.roll.diameter, c.trough.width.belt] for c in choices]).T
    pulleys = {(c.kind, k, c.trough.width.belt): task.pulley_mass(task.carcasses[c.kind][k], c.trough.width.belt)
               for c, k in zip(choices, carcass.tolist(), strict=True)}  # fmt: skip
    parts = Parts(
        width=width, length=length, strength=strength, steel_cord=each(lambda c: c.kind == "steel cord"),
        cover=top + first * bottom, special_cover=(1.0 - first) * bottom,
        sets=length / carry + length / back, rolls=rolls,
        roll_mass=of_set * length / carry + of_back * length / back, roll_life=_SET * hours,
        drives=drives, power=power * task.rules.motor_reserve,
        pulley_mass=np.array([pulleys[c.kind, k, c.trough.width.belt] for c, k in zip(choices, carcass.tolist(), strict=True)]),
        take_up=slack,
    )  # fmt: skip
    energy = np.maximum(0.0, force) * speed / task.efficiency * task.seconds
    year = costs(parts, prices, seconds=task.seconds, energy=energy, energy_price=task.energy_price).year
    return Screened(
        np.where(possible, year, np.inf), carcass, force, indentation.T, rolls, rest
    )


def _tensions(
    task: SizingTask, choices: Sequence[Choice], force: Array, down: Array, up: Array, belt: Array, bulk: Array,
    carry: Array, back: Array,
) -> tuple[Array, Array]:  # fmt: skip
    """Tension right behind the head, and the largest one, by grip and sag [N]."""
    at_tail = np.array([_at_tail(choice.drives) for choice in choices])
    friction, wrap = task.grip
    pulleys = np.array([2.0 if choice.drives == "head, two pulleys" else 1.0 for choice in choices])
    grips = [1.0 / np.expm1(friction * wrap * pulleys), np.full(len(choices), 1.0 / math.expm1(friction * wrap))]
    start = task.rules.start_factor
    returning = np.cumsum(down, axis=1)
    before_tail = returning[:, -1]
    carrying = np.cumsum(up, axis=1) + (before_tail - at_tail * force)[:, None]
    head = (1.0 - at_tail) * force
    g, (carry_sag, return_sag) = task.gravity, task.sags
    least_carry = (belt + bulk) * g * carry / (8.0 * carry_sag)
    least_back = belt * g * back / (8.0 * return_sag)
    after_tail = before_tail - at_tail * force
    slack = np.max([
        least_back,
        least_back - returning.min(axis=1),
        least_carry - np.minimum(after_tail, carrying.min(axis=1)),
        start * np.abs(head) * grips[0] - np.minimum(0.0, head),
        start * np.abs(at_tail * force) * grips[1] - np.minimum(before_tail, after_tail),
    ], axis=0)  # fmt: skip
    highest = np.maximum(np.maximum(0.0, returning.max(axis=1)), np.maximum(after_tail, carrying.max(axis=1)))
    return slack, slack + highest


def _at_tail(drives: DriveLayout) -> float:
    """Share of the drive force at the tail."""
    return {"head": 0.0, "head, two pulleys": 0.0, "head and tail": 0.5, "tail": 1.0}[drives]
