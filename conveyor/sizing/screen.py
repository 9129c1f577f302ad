"""Candidates and their closed estimate: friction by scaling laws, tensions round the loop, yearly cost.

Indentation scales with (W⁴ h/D²)^(1/3) as on Winkler's foundation (Jonkers 1980); factors on it, on roll drag and on
the secondary resistances are calibrated by exact calculations of some candidates. By a classical method the main
resistance is that of its factors. The estimate only selects what to calculate: no figure of a design comes from here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.loading import middle_share_belt, middle_share_bulk
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.laws.resistance.flexure import FLEXURE_COEFFICIENT
from conveyor.laws.resistance.resistance_defaults import CLEANER_PRESSURE
from conveyor.laws.roll_life import BALL_EXPONENT, RATED_REVOLUTIONS
from conveyor.models.belt import RUBBER_DENSITY
from conveyor.models.calculation_methods import Method
from conveyor.models.sizing import DriveLayout
from conveyor.sizing.design_choice import DesignChoice, RollSize, TroughSize, drive_powers
from conveyor.sizing.sizing_task import SizingTask
from conveyor.studies.costs import Parts, conveyor_costs

Array = NDArray[np.float64]

_LOAD_EXPONENT: Final = 4.0 / 3.0  # exponent of the line load
_WING_LOAD_FACTOR: Final = 2.0**_LOAD_EXPONENT / (_LOAD_EXPONENT + 1.0)  # a triangular load over an even one
_CLEANERS: Final = 2.0 * 0.008 * CLEANER_PRESSURE.value * 0.6  # [N/m] of belt width: `line.defaults`
_SKIRTS: Final = 2.0 * 0.7 * 9.81 / 0.625**2  # [m/s²]: both zones of the usual skirts, over (Q/v)²/(ρ B²) and 1 m
_SET_LIFE_SHARE: Final = 0.5  # bearing life of a set over that of its most loaded bearing
_FLEXURE_PASSES: Final = 3  # flexure is a tenth of the friction, its tension settles to a per cent of it
_START_MEAN_SHARE: Final = 0.375  # mean round the loop of a start's extra force, over it; 1/4 of the mass returns
_ROUNDING: Final = 1e-9  # [m], of units
_ROUNDS: Final = 4  # of belt class, mass and tensions


Limit = Literal["belt strength", "motor power", "take-up travel", "bearings", "set rating"]
"""Limits of the series: the strongest belt, the largest motors, the longest travel, the strongest rolls."""


@dataclass(frozen=True)
class EstimateCalibration:
    """Calibration factors of the estimate.

    Attributes
    ----------
    carry, back : tuple of float
        Indentation under carry and return rolls, of each cover [Pa^(-1/3)]; by a classical method the calculated main
        resistance of carry and return strand over the estimated one [-].
    drag : float
        Drag of a roll [N].
    rest : float
        Secondary and special resistances over the estimated ones [-].
    design : float
        Friction to design for over the expected one [-].
    uses : mapping of str to float
        Calculated over estimated use of each limit [-]; 1 for those left out.
    """

    carry: tuple[float, ...]
    back: tuple[float, ...]
    drag: float
    rest: float
    design: float = 1.25
    uses: Mapping[Limit, float] = field(default_factory=dict)


def first_calibration(covers: int, method: Method = "viscoelastic") -> EstimateCalibration:
    """Initial calibration: Jonkers at E' 10 MPa and tan δ 0.12, or the method's factors; it selects the first ones."""
    if method != "viscoelastic":
        given = (1.0,) * covers
        return EstimateCalibration(given, given, 0.0, 1.0, design=1.0)
    jonkers = 1.138 * 0.12 / 1e7 ** (1.0 / 3.0)
    return EstimateCalibration((jonkers,) * covers, (jonkers,) * covers, 2.5, 1.0)


class TroughAtSpeed(NamedTuple):
    """A trough with a speed [m/s], its filling [-], and rolls that turn slowly enough."""

    trough: TroughSize
    speed: float
    filling: float
    roll: RollSize


def _running_troughs(task: SizingTask) -> Iterator[TroughAtSpeed]:
    """Every trough at every speed on every rolls that keep the rules."""
    for trough in task.troughs:
        rolling = [(roll, on) for roll in task.rolls if (on := task.trough_on(roll, trough)) is not None]
        for speed in task.speeds:
            fillings = {on: task.filling(on, speed) for on in dict.fromkeys(on for _, on in rolling)}
            for roll, on in rolling:
                filling = fillings[on]
                if filling is not None and task.suits(roll, on, speed):
                    yield TroughAtSpeed(on, speed, filling, roll)


@dataclass(frozen=True, eq=False)
class Candidates:
    """All combinations within the rules of width, lumps, filling, edge distance and rotation.

    Attributes
    ----------
    running : tuple of TroughAtSpeed
        Troughs with a speed and suitable rolls.
    numbers : ndarray of int, shape (n, 6)
        Indices of each candidate: running combination, carry and return spacing, cover, kind of carcass, drive layout.
    """

    task: SizingTask
    running: tuple[TroughAtSpeed, ...]
    numbers: NDArray[np.int64]

    @classmethod
    def of(cls, task: SizingTask) -> Candidates:
        """Combine the free choices of a duty."""
        running = tuple(_running_troughs(task))
        carry, back = task.spacings
        series = (running, carry, back, task.bottom_covers, task.kinds, task.rules.drives)
        numbers = np.indices([len(one) for one in series]).reshape(len(series), -1).T
        numbers[:, 3] = np.array(task.bottom_covers)[numbers[:, 3]]
        apart = np.array([np.array(carry)[numbers[:, 1]], np.array(back)[numbers[:, 2]]])
        widest = np.array([task.widest_spacings(on.trough) for on in running]).reshape(-1, 2)[numbers[:, 0]].T
        return cls(task, running, numbers[(apart[0] <= apart[1]) & np.all(apart <= widest + _ROUNDING, axis=0)])

    @classmethod
    def of_choices(cls, task: SizingTask, choices: Sequence[DesignChoice]) -> Candidates:
        """These choices alone, with the least covers and evenly spaced sets."""
        running = tuple(TroughAtSpeed(one.trough, one.speed, one.filling, one.roll) for one in choices)
        carry, back = task.spacings
        numbers = [
            (i, carry.index(one.carry), back.index(one.back), one.cover, task.kinds.index(one.kind),
             task.rules.drives.index(one.drives))
            for i, one in enumerate(choices)
        ]  # fmt: skip
        return cls(task, running, np.array(numbers, dtype=np.int64).reshape(-1, 6))

    def __len__(self) -> int:
        return len(self.numbers)

    def only(self, rows: NDArray[np.int64] | NDArray[np.bool_]) -> Candidates:
        """Subset of the candidates."""
        return Candidates(self.task, self.running, self.numbers[rows])

    def within_travel(self) -> Candidates:
        """Candidates whose permanent stretch is within the take-up's travel, whatever the tensions."""
        task = self.task
        travel = [task.lasting_strain(kind) < task.take_up_strain for kind in task.kinds]
        return self.only(np.array(travel)[self.numbers[:, 4]])

    def __getitem__(self, i: int) -> DesignChoice:
        ran, carry, back, cover, kind, drives = self.numbers[i].tolist()
        task = self.task
        trough, speed, filling, roll = self.running[ran]
        apart = task.spacings[0][carry], task.spacings[1][back]
        return DesignChoice(trough, speed, filling, roll, *apart, cover, task.kinds[kind], task.rules.drives[drives])

    def runs(self, get: Callable[[TroughAtSpeed], float]) -> Array:
        """Figure of trough, speed and rolls for each candidate."""
        return np.array([get(one) for one in self.running])[self.numbers[:, 0]]

    def ratings(self) -> Array:
        """Class rating of the carry and return sets of each candidate, shape (2, n) [N]."""
        rated = np.array([self.task.set_ratings(on.roll, on.trough) for on in self.running])
        return np.asarray(rated[self.numbers[:, 0]].T)

    def driven(self, get: Callable[[DriveLayout], float]) -> Array:
        """Figure of the drive layout for each candidate."""
        return np.array([get(one) for one in self.task.rules.drives])[self.numbers[:, 5]]


@dataclass(frozen=True, eq=False)
class Estimates:
    """The estimate of every candidate, shape (n,).

    Attributes
    ----------
    cost, year : ndarray
        Yearly cost [currency/a]; `year` is infinite if no belt, motor or bearing of the series suffices.
    carcass : ndarray of int
        Index of the belt class.
    force, design_force : ndarray
        Force of all drives, as expected and with the friction to design for [N].
    scaled_forces : ndarray, shape (n, 2)
        What has a factor for carry and return strand: indentation, by a classical method the main resistance [N].
    rolls : ndarray
        Number of rolls in all sets.
    rest : ndarray
        Secondary and special resistances [N].
    uses : mapping of str to ndarray
        Use of each limit of series and rules [-]; above 1 nothing in the series suffices.
    """

    cost: Array
    year: Array
    carcass: NDArray[np.int64]
    force: Array
    design_force: Array
    scaled_forces: Array
    rolls: Array
    rest: Array
    uses: Mapping[Limit, Array]

    @property
    def largest_use(self) -> Array:
        """Largest use of a limit by each candidate [-]."""
        return np.asarray(np.max(list(self.uses.values()), axis=0))


class _BeltSeries(NamedTuple):
    """Belt classes by kind and index; beyond the last of a kind like its last, but infinitely strong.

    Strength and stiffness [N/m], mass of the carcass [kg/m²], pulleys per belt width [kg/m]; `covers` also by running
    combination: top and bottom [m]; `last` index of each kind, and its strength and stiffness.
    """

    strengths: Array
    stiffnesses: Array
    masses: Array
    pulleys: Array
    covers: Array
    last: NDArray[np.int64]
    strongest: Array
    stiffest: Array

    @classmethod
    def of(cls, task: SizingTask, wear: Sequence[float]) -> _BeltSeries:
        """Tables of a duty; `wear` is the addition to the covers [m]."""
        kinds = [task.carcasses[kind] for kind in task.kinds]
        most = max(map(len, kinds))
        filled = [[each[min(k, len(each) - 1)] for k in range(most)] for each in kinds]
        known = np.array([[k < len(each) for k in range(most)] for each in kinds])
        strengths, stiffnesses = (
            np.where(known, [[get(one) for one in row] for row in filled], np.inf)
            for get in (attrgetter("strength"), attrgetter("stiffness"))
        )
        return cls(
            strengths,
            stiffnesses,
            np.array([[one.mass for one in row] for row in filled]),
            np.array([[task.pulleys.pulley_mass(one, 1.0) for one in row] for row in filled]),
            np.array([[[task.worn_covers(one, addition) for addition in wear] for one in row] for row in filled]),
            np.array([len(each) - 1 for each in kinds]),
            np.array([each[-1].strength for each in kinds]),
            np.array([each[-1].stiffness for each in kinds]),
        )


class _LoopEstimate(NamedTuple):
    """Estimate of candidates with a belt class each.

    Covers [m], load of the middle roll and of carry and return sets, what has a factor of its strand, force of all
    drives, as expected and with the friction to design for, tension behind the head [N]; the class required by the
    tensions, and with the strongest class the use of its strength and of the take-up's travel [-].
    """

    covers: Array
    middle: Array
    sets: Array
    scaled_forces: Array
    force: Array
    design_force: Array
    slack: Array
    carcass: NDArray[np.int64]
    strength: Array
    travel: Array


def screen_candidates(task: SizingTask, every: Candidates, levels: EstimateCalibration) -> Estimates:
    """Estimate every candidate."""
    length, numbers = task.length, every.numbers
    cover, kind = numbers[:, 3], numbers[:, 4]
    width, speed = every.runs(lambda on: on.trough.width.belt), every.runs(lambda on: on.speed)
    carry, back = (np.array(apart)[numbers[:, 1 + k]] for k, apart in enumerate(task.spacings))
    bulk, wear = task.flow / speed, [task.wear(v) for _, v, _, _ in every.running]
    skirts = _SKIRTS * bulk**2 / (task.density * width**2) * speed
    rest = levels.rest * (_bulk_acceleration(task, speed) + _CLEANERS * width + skirts)
    per_metre = np.array([3.0 / carry, every.runs(lambda on: on.trough.width.return_rolls[0]) / back])
    steel = np.array([one == "steel cord" for one in task.kinds])[kind]
    series = _BeltSeries.of(task, wear)
    carcass = np.zeros(len(every), dtype=np.int64)
    around = _estimate_loop(every, levels, series, carcass, rest)
    for _ in range(_ROUNDS - 1):
        rows = np.flatnonzero(around.carcass != carcass)  # the others no longer change
        carcass = around.carcass.copy()
        again = _estimate_loop(every.only(rows), levels, series, carcass[rows], rest[rows])
        for figure, value in zip(around, again, strict=True):
            figure[rows] = value
    (top, bottom), carcass, force = around.covers.T, around.carcass, around.force
    power, drives = (
        np.maximum(np.abs(force), np.abs(around.design_force)) * speed / task.efficiency,
        every.driven(lambda one: len(drive_powers(1.0, one))),
    )
    life = _roll_life(every, around.middle)
    uses: dict[Limit, Array] = {
        "belt strength": around.strength,
        "motor power": levels.uses.get("motor power", 1.0)
        * (power * task.rules.motor_reserve / (drives * task.largest_drive)),
        "take-up travel": around.travel,
        "bearings": task.roll_life / life,
        "set rating": np.max(around.sets.T / every.ratings(), axis=0),
    }
    at_tail = every.driven(_tail_share) == 1.0
    slack_under_bulk = at_tail == (force >= 0.0)  # a drive at the tail pushes the belt, one at the head holds it back
    possible = np.max(list(uses.values()), axis=0) <= 1.0
    if (possible & ~slack_under_bulk).any():
        possible &= ~slack_under_bulk
    first = cover == 0
    parts = Parts(
        width=width, length=length, strength=series.strengths[kind, carcass], steel_cord=steel.astype(float),
        cover=top + first * bottom, special_cover=(1.0 - first) * bottom, sets=length / carry + length / back,
        rolls=length * per_metre.sum(axis=0), roll_mass=length * _rotating_masses(every, carry, back).sum(axis=0),
        roll_life=life, drives=drives, power=power * task.rules.motor_reserve,
        pulley_mass=series.pulleys[kind, carcass] * width, take_up=around.slack,
    )  # fmt: skip
    drawn, fed_back = np.maximum(0.0, force) / task.efficiency, np.maximum(0.0, -force) * task.efficiency
    worth = (task.energy_price * drawn - task.feed_in_price * fed_back) * speed * task.seconds / JOULE_PER_KWH
    cost = conveyor_costs(parts, task.duty.prices.amounts, seconds=task.seconds, energy=worth)
    yearly = np.asarray(cost.year)
    year = np.where(possible, yearly, np.inf)
    rolls = length * per_metre.sum(axis=0)
    return Estimates(yearly, year, carcass, force, around.design_force, around.scaled_forces, rolls, rest, uses)


def _estimate_loop(
    every: Candidates,
    levels: EstimateCalibration,
    series: _BeltSeries,
    carcass: NDArray[np.int64],
    rest: Array,
) -> _LoopEstimate:
    """Friction and tensions with a belt class, and the class that they require."""
    task, numbers = every.task, every.numbers
    g, length, sections = task.gravity, task.length, np.array(task.sections)
    ran, cover, kind = numbers[:, 0], numbers[:, 3], numbers[:, 4]
    width, bulk = every.runs(lambda on: on.trough.width.belt), task.flow / every.runs(lambda on: on.speed)
    diameter, three = every.runs(lambda on: on.roll.diameter), every.runs(lambda on: on.trough.width.three)
    carry, back = (np.array(apart)[numbers[:, 1 + k]] for k, apart in enumerate(task.spacings))
    count = every.runs(lambda on: on.trough.width.return_rolls[0])
    flat = every.runs(lambda on: on.trough.width.return_rolls[1])
    of_bulk = every.runs(lambda on: middle_share_bulk(on.trough.angle))
    of_belt = every.runs(lambda on: middle_share_belt(on.trough.width.three, belt_width=on.trough.width.belt))
    on_wing, wide = np.minimum(three, 0.5 * (width - three)), np.minimum(width, count * flat)
    safety = np.array([task.carcasses[one][0].safety for one in task.kinds])[kind]
    top, bottom = (covers := series.covers[kind, carcass, ran]).T
    belt = width * (series.masses[kind, carcass] + RUBBER_DENSITY * (top + bottom))
    middle = (of_bulk * bulk + of_belt * belt) * g * carry
    wing = 0.5 * ((1.0 - of_bulk) * bulk + (1.0 - of_belt) * belt) * g * carry
    per_set = (
        three * (middle / three) ** _LOAD_EXPONENT
        + 2.0 * _WING_LOAD_FACTOR * on_wing * (wing / on_wing) ** _LOAD_EXPONENT
    )
    scaled_forces = np.array([
        np.array(levels.carry)[cover] * np.cbrt(bottom / diameter**2) * per_set * length / carry,
        np.array(levels.back)[cover] * np.cbrt(top / diameter**2) * wide * (belt * g * back / wide) ** _LOAD_EXPONENT
        * length / back,
    ])  # fmt: skip
    sags = np.array(task.sags)[:, None]
    hanging = g * np.array([belt + bulk, belt])
    spans = hanging * np.array([carry, back])
    square = 1.0 - (1.0 - of_bulk) * np.sin(every.runs(lambda on: on.trough.angle)) ** 2  # wings turn by cos λ
    askew = task.misalignment_friction * g * np.array([(belt + bulk) * square, belt])
    straight = scaled_forces / length + levels.drag * np.array([3.0 / carry, count / back]) + askew
    flexes, sag = FLEXURE_COEFFICIENT.value, sags
    if task.classical is not None:
        main = np.array([levels.carry, levels.back])[:, cover] * task.classical.main_friction(
            _rotating_masses(every, carry, back), belt, bulk, spacing=carry, gravity=g
        )
        scaled_forces, straight, flexes = main * length, task.classical.coefficient * main, 0.0
    for _ in range(_FLEXURE_PASSES):  # the sag follows the tension, which follows the flexure
        friction = straight + flexes * sag * hanging
        rubbing = levels.design * friction
        up = np.outer(bulk + belt, g * sections[:, 1]) + np.outer(rubbing[0], sections[:, 0])
        down = np.outer(-belt, g * sections[:, 1]) + np.outer(rubbing[1], sections[:, 0])
        up[:, 0] += levels.design * rest
        design_force = up.sum(axis=1) + down.sum(axis=1)
        slack, largest, mean = _loop_tensions(every, design_force, (down[:, ::-1], up), spans)
        sag = np.minimum(sags, spans / (8.0 * mean))
    force = friction.sum(axis=0) * length + rest + bulk * g * sections[:, 1].sum()
    mean += (task.rules.start_factor - 1.0) * np.abs(design_force) * _START_MEAN_SHARE
    strength = levels.uses.get("belt strength", 1.0) * safety * largest / width
    lasting = np.array([task.lasting_strain(one) for one in task.kinds])[kind]
    travel = levels.uses.get("take-up travel", 1.0) / task.take_up_strain
    left = 1.0 / travel - lasting
    stiffness = np.divide(mean / width, left, out=np.full_like(mean, np.inf), where=left > 0.0)
    weak = (series.strengths[kind] < strength[:, None]) | (series.stiffnesses[kind] < stiffness[:, None])
    asked, last = weak.sum(axis=1), series.last[kind]
    strength /= series.strongest[kind]
    travel = travel * (mean / width / series.stiffest[kind] + lasting)
    sets = np.array([task.lump_factor * (belt + bulk) * g * carry, spans[1]]).T
    chosen = np.minimum(asked, last)
    return _LoopEstimate(covers, middle, sets, scaled_forces.T, force, design_force, slack, chosen, strength, travel)


def _roll_life(every: Candidates, middle: Array) -> Array:
    """L10 of the bearings of a carry set by the load of its middle roll [s]."""
    turns = RATED_REVOLUTIONS * (every.runs(lambda on: on.roll.rating) / (0.5 * middle)) ** BALL_EXPONENT
    return np.asarray(_SET_LIFE_SHARE * turns * math.pi * every.runs(lambda on: on.roll.diameter / on.speed))


def _bulk_acceleration(task: SizingTask, speed: Array) -> Array:
    """Force that accelerates the bulk [N]; none beside the coefficient C, which holds it."""
    by_length = task.classical is not None and task.classical.coefficient > 1.0
    return np.zeros_like(speed) if by_length else task.flow * speed


def _rotating_masses(every: Candidates, carry: Array, back: Array) -> Array:
    """Rotating mass of the rolls of carry and return strand per length of conveyor, shape (2, n) [kg/m]."""

    def return_set(on: TroughAtSpeed) -> float:
        count, length, _ = on.trough.width.return_rolls
        return count * on.roll.mass(length)

    carry_set = every.runs(lambda on: 3.0 * on.roll.mass(on.trough.width.three))
    return np.array([carry_set / carry, every.runs(return_set) / back])


def _loop_tensions(
    every: Candidates, force: Array, along: tuple[Array, Array], spans: Array
) -> tuple[Array, Array, Array]:
    """Tension right behind the head, the largest, and the mean round the loop in steady running, by grip and sag [N].

    `along` are the forces on return sections from the head and carry sections from the tail, `spans` the loads of
    carry and return strand between two sets [N].
    """
    (down, up), (span_carry, span_back) = along, spans
    task, at_tail = every.task, every.driven(_tail_share)
    friction, wrap = task.grip
    grips = 1.0 / np.expm1(
        friction * wrap * every.driven(lambda one: 2.0 if one.startswith("head, two pulleys") else 1.0)
    )
    start = task.rules.start_factor
    returning = np.cumsum(down, axis=1)
    before_tail = returning[:, -1]
    after_tail = before_tail - at_tail * force
    carrying = np.cumsum(up, axis=1) + after_tail[:, None]
    head, (carry_sag, return_sag) = (1.0 - at_tail) * force, task.sags
    slack = np.max([
        span_back / (8.0 * return_sag) - np.minimum(0.0, returning.min(axis=1)),
        span_carry / (8.0 * carry_sag) - np.minimum(after_tail, carrying.min(axis=1)),
        start * np.abs(head) * grips - np.minimum(0.0, head),
        start * np.abs(at_tail * force) * grips - np.minimum(before_tail, after_tail),
    ], axis=0)  # fmt: skip
    highest = np.maximum(np.maximum(0.0, returning.max(axis=1)), np.maximum(after_tail, carrying.max(axis=1)))
    lengths = np.array([length for length, _ in task.sections]) / (2.0 * task.length)
    mean = slack + (returning - 0.5 * down) @ lengths[::-1] + (carrying - 0.5 * up) @ lengths
    return slack, slack + highest, mean


def _tail_share(drives: DriveLayout) -> float:
    """Share of the drive force at the tail."""
    return (1.0 / len(drive_powers(1.0, drives))) if "tail" in drives else 0.0
