"""Layout of the loop independent of the forces along the belt: positions, point forces, pulleys, drives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from conveyor.classical_forces import initial_pull
from conveyor.force_sums import Force
from conveyor.forces import PulleyResistance, point_forces, pulley_resistances
from conveyor.laws.power import belt_power, motor_power
from conveyor.laws.resistance import secondary_resistance
from conveyor.laws.tension import grip_tension
from conveyor.line.line import Line
from conveyor.line.loop_positions import LoopPosition
from conveyor.loop.reach_shares import reach_shares
from conveyor.loop.run_up import StartingForces

Array = NDArray[np.float64]
PlaceIndices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class LoopPlan:
    """Numbered sequence of runs, point forces, pulleys and drives round the loop from the head.

    Attributes
    ----------
    key : tuple
        Equal for loops of the same sequence, which are solved in one batch.
    count : int
        Number of items; place k is behind k items.
    boundaries : ndarray
        Boundaries between stretches that have items.
    runs, spots, bends, drives : ndarray
        Item numbers of the runs between boundaries, of the forces at each spot, of the pulleys, of the drives.
    driven : ndarray, shape (d, 2)
        Places before and behind every drive.
    sides : ndarray, shape (pulleys, k)
        Places whose tensions act on each pulley: of a driven one both sides of its drives.
    carried : ndarray of bool, shape (pulleys,)
        True for pulleys with the take-up's tension instead.
    held : int or None
        Place of the take-up; None on the slack side of the drives.
    station : tuple of int
        Places before and behind the drives at the first one's spot.
    head, landing : int
        Place before all items at the head; item of the forces where the bulk lands.
    keeps_length : bool
        True if the take-up fixes the belt's length.
    """

    key: tuple[object, ...]
    count: int
    boundaries: PlaceIndices
    runs: PlaceIndices
    spots: PlaceIndices
    bends: PlaceIndices
    drives: PlaceIndices
    driven: PlaceIndices
    sides: PlaceIndices
    carried: NDArray[np.bool_]
    held: int | None
    station: tuple[int, int]
    head: int
    landing: int
    keeps_length: bool

    @cached_property
    def run_lengths(self) -> PlaceIndices:
        """Number of stretches of each run, shape (runs,)."""
        return np.diff(self.boundaries)


@dataclass(frozen=True, eq=False)
class LoopConstants:
    """Constants of a loop independent of the forces along the belt; for loops of one plan with a leading axis.

    Attributes
    ----------
    met : ndarray, shape (3, count)
        Forces at single places without and with friction [N], and masses of the runs [kg].
    pulls : ndarray, shape (3, 2n)
        Forces along the outlets of hoppers in loop order, at the computed friction [N]: in flow, and what they change
        when the belt starts under filled hoppers and when the hoppers are empty.
    early : ndarray, shape (3,)
        What each adds to the mean tension of the loop, as it acts on the rear of its stretches, not evenly [N].
    mass : ndarray, shape (2n + 1,)
        Running sum of the moving masses [kg].
    least, centrifugal, lengths : ndarray, shape (2n,)
        Least tension for the sag, m' v² [N], and length [m] of the stretches.
    grip, brakes : ndarray, shape (d,)
        Tension that a newton of each drive needs for its grip [-]; force of its brake [N].
    wrap, slope, bearings, pulley_mass, wrap_angle : ndarray, shape (pulleys,)
        Wrap without tension [N] and per newton of mean tension [-], bearings per newton of load [-], kg, rad.
    least_friction, design_friction, gravity : ndarray, shape ()
        Least friction and that to design for, over the computed one [-]; gravity [m/s²].
    by_length : ndarray, shape ()
        Secondary resistances over the main ones, C - 1 [-]; 0 where they are itemised.
    pull : StartingForces
        Forces of the drives at a start.
    """

    met: Array
    pulls: Array
    early: Array
    mass: Array
    least: Array
    centrifugal: Array
    lengths: Array
    grip: Array
    brakes: Array
    wrap: Array
    slope: Array
    bearings: Array
    pulley_mass: Array
    wrap_angle: Array
    least_friction: Array
    design_friction: Array
    gravity: Array
    by_length: Array
    pull: StartingForces

    @classmethod
    def side_by_side(cls, several: Sequence[Self]) -> Self:
        """Stack the constants of loops of one plan, one in each row."""
        unlike = {one: k for k, one in enumerate(dict.fromkeys(several))}
        rows = [unlike[one] for one in several]

        def stacked(parts: Sequence[LoopConstants | StartingForces]) -> dict[str, Any]:
            """Stack arrays in rows; other values are equal in all."""
            columns = {name: [getattr(part, name) for part in parts] for name in vars(parts[0])}
            return {
                name: _stack_rows(column, rows) if isinstance(column[0], np.ndarray) else column[0]
                for name, column in columns.items()
            }

        return cls(**stacked(list(unlike)) | {"pull": StartingForces(**stacked([one.pull for one in unlike]))})


def _stack_rows(column: Sequence[Array], rows: Sequence[int]) -> Array:
    """Stack arrays in the order of `rows`."""
    return column[0][None] if len(rows) == 1 else np.array(column)[rows]


class TakeUpSetting(NamedTuple):
    """Setting of a take-up [N]; on the slack side of the drives, True if that is behind them."""

    tension: float
    behind: bool


class LoopLayout:
    """Layout of a line's loop; shared by cases that differ in rubber.

    Attributes
    ----------
    line : Line
        The conveyor.
    points : tuple of Force
        Forces at single places independent of tension.
    bends : tuple of PulleyResistance
        Pulleys that bend the belt.
    spots, boundaries : list
        Occupied positions and boundaries in running direction from the head.
    """

    def __init__(self, line: Line) -> None:
        self.line = line
        self.points: tuple[Force, ...] = point_forces(line)
        self.bends: tuple[PulleyResistance, ...] = pulley_resistances(line)
        places = line.places
        self.landing = line.loading[0].spot if line.loading else places.landing(None)
        ends = (places.before("tail", None), places.before("head", None), places.behind("head", None))
        held = () if line.take_up.spot is None else (line.take_up.spot,)
        standing = (
            *(force.spot for force in self.points if force.spot is not None),
            *(pulley.spot for pulley in line.pulleys),
            *(drive.spot for drive in line.drives),
        )
        self.spots: list[LoopPosition] = sorted({*ends, self.landing, *held, *standing})
        self.boundaries: list[int] = sorted({spot.boundary for spot in self.spots})
        self.at = {spot: j for j, spot in enumerate(self.spots)}
        self.drives: list[list[int]] = [[] for _ in self.spots]
        for i, drive in enumerate(line.drives):
            self.drives[self.at[drive.spot]].append(i)
        self.station = next(stop for stop in self.drives if 0 in stop)
        self.anchor = None if line.take_up.spot is None else self.at[line.take_up.spot]
        self.plan = _loop_plan(self)
        self.standing = _loop_constants(self)

    def standing_on(self, *, behind: bool) -> LoopLayout:
        """The loop with a slack-side take-up behind or before the drives."""
        unit = self.line.take_up
        if not unit.on_slack_side or unit.behind is behind:
            return self
        made = self.of(replace(self.line, take_up=replace(unit, behind=behind)))
        made.plan = _loop_plan(made)
        return made

    def designed_for(self, friction: float) -> LoopLayout:
        """The loop with a friction to design for, over the computed one [-]."""
        if friction == self.line.design_friction:
            return self
        made = self.of(replace(self.line, design_friction=friction))
        made.standing = replace(self.standing, design_friction=np.array(friction))
        return made

    def of(self, line: Line) -> LoopLayout:
        """The loop of a line with other roll drags."""
        made = copy(self)
        made.line = line
        return made

    def scaled(self, change: Callable[[Force], Force]) -> LoopLayout:
        """The loop with its forces at single places changed; a pulley's wrap and bearings by one factor."""
        made = copy(self)
        made.points = tuple(map(change, self.points))
        units = (next(bend.forces(1.0, 1.0)) for bend in self.bends)
        made.bends = tuple(bend.times(change(unit).total) for bend, unit in zip(self.bends, units, strict=True))
        made.standing = _loop_constants(made)
        return made

    def motor(self, force: float, share: float = 1.0) -> float:
        """Power at the motors' shafts of a force at the belt [W], negative when the belt drives them.

        CEMA's bearings of the drive pulleys are in it, those of a drive by its share of the force [-].
        """
        return self.shaft_power(force + share * self.line.drive_bearings)

    def shaft_power(self, force: float) -> float:
        """Power at the motors' shafts of a force at the rims of the drive pulleys [W]."""
        belt = belt_power(force, belt_speed=self.line.speed)
        return motor_power(belt, efficiency=self.line.efficiency if force >= 0.0 else self.line.regeneration)

    def mains(self, force: float) -> float:
        """Power from the mains for a force at the belt, negative when it is fed back [W]."""
        return motor_power(self.motor(force), efficiency=self.line.mains_efficiency)


def _loop_plan(layout: LoopLayout) -> LoopPlan:
    """Number the items of a loop, place by place."""
    line, met = layout.line, 0
    runs, spots, drives = [], [], [0] * len(layout.line.drives)
    pulleys, sides = [0] * len(layout.bends), [[0]] * len(layout.bends)
    held = None
    for j, spot in enumerate(layout.spots):
        if j and spot.boundary != layout.spots[j - 1].boundary:
            runs.append(met)
            met += 1
        spots.append(met)
        met += 1
        here = [p for p, bend in enumerate(layout.bends) if bend.pulley.spot == spot]
        for p in here:
            pulleys[p] = met
            met += 1
        first = met
        for d in layout.drives[j]:
            drives[d] = met
            met += 1
        for p in here:
            sides[p] = list(range(first, met + 1)) if layout.drives[j] else [spots[j]]
        if j == layout.anchor:
            held = met
    widest = max(map(len, sides), default=1)
    padded = [each + each[-1:] * (widest - len(each)) for each in sides]
    columns = (layout.boundaries, runs, spots, pulleys, drives, *padded)
    station = (drives[layout.station[0]], drives[layout.station[-1]] + 1)
    if held is None and line.take_up.behind is not None:
        held = station[line.take_up.behind]
    keeps = line.take_up.keeps_length
    carried = [line.take_up.pulls(bend.pulley) for bend in layout.bends]
    return LoopPlan(
        key=(*map(tuple, columns), tuple(carried), held, station, keeps, StartingForces.of(line).kind),
        count=met,
        boundaries=np.array(layout.boundaries),
        runs=np.array(runs),
        spots=np.array(spots),
        bends=np.array(pulleys, dtype=np.intp),
        drives=np.array(drives),
        driven=np.array([(d, d + 1) for d in drives]),
        sides=np.array(padded, dtype=np.intp).reshape(len(padded), widest),
        carried=np.array(carried, dtype=bool),
        held=held,
        station=station,
        head=runs[-1] + 1,
        landing=spots[layout.at[layout.landing]],
        keeps_length=keeps,
    )


def _loop_constants(layout: LoopLayout) -> LoopConstants:
    """Constants of a loop in the order of its plan."""
    line, plan = layout.line, layout.plan
    shape, pulleys = line.loop, [bend.pulley for bend in layout.bends]
    met = np.zeros((3, plan.count))
    pulls, early = np.zeros((3, 2 * line.count)), np.zeros(3)
    for force in layout.points:
        if force.spot is not None and force.reach > 0.0:
            spread = reach_shares(line.loop, force.spot, force.reach)
            pulls += np.outer((force.total, 0.0, -force.total), spread.shares)
            early += spread.early * np.array((force.total, 0.0, -force.total))
        elif force.spot is not None:
            met[0 if force.certain else 1, plan.spots[layout.at[force.spot]]] += force.total
    for point in line.loading:
        if (hopper := point.loaded_hopper) is not None:
            spread, more = reach_shares(line.loop, point.spot, hopper.length), initial_pull(line, point)
            pulls[1] += more * spread.shares
            early[1] += more * spread.early
    mass = np.concatenate([[0.0], np.cumsum(shape.mass)])
    met[2, plan.runs] = np.diff(mass[plan.boundaries])
    return LoopConstants(
        met=met,
        pulls=pulls,
        early=early,
        mass=mass,
        least=shape.least,
        centrifugal=line.speed**2 * np.array([stretch.line_mass for stretch in shape.stretches]),
        lengths=shape.length,
        grip=np.array([grip_tension(1.0, friction=d.friction, wrap_angle=d.wrap_angle) for d in line.drives]),
        brakes=np.array(line.brakes),
        wrap=np.array([bend.wrap[0] for bend in layout.bends]),
        slope=np.array([bend.wrap[1] for bend in layout.bends]),
        bearings=np.array([bend.bearings or 0.0 for bend in layout.bends]),
        pulley_mass=np.array([pulley.mass for pulley in pulleys]),
        wrap_angle=np.array([pulley.wrap_angle for pulley in pulleys]),
        least_friction=np.array(line.least_friction),
        design_friction=np.array(line.design_friction),
        gravity=np.array(line.gravity),
        by_length=np.array(secondary_resistance(1.0, length=line.length) if line.secondary == "C" else 0.0),
        pull=StartingForces.of(line),
    )
