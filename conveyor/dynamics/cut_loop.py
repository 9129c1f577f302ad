"""Loop of a steady result, cut open at the take-up: masses and forces along it, and its cells of equal travel time."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.classical_forces import initial_pull
from conveyor.errors import NoSolutionError
from conveyor.laws.resistance.resistance_defaults import ROLL_DRAG_STANDSTILL_FACTOR
from conveyor.laws.waves import PULLEY_INERTIA, SLACK_SAG, sag_factor, wave_speed
from conveyor.line.line import Line
from conveyor.line.loop_positions import BoundaryOrder, LoopPosition
from conveyor.loop.take_up_duty import belt_stiffness

Array = NDArray[np.float64]

SPEEDS = (0.1, 0.5)
"""Further speeds, over the steady one, at which the resistances are computed [-]."""
_PIECES = 16  # of a force over a length of the belt; it is lumped at the cells anyway
_WITH_SPEED = frozenset({"acceleration", "loading_skirts"})
"""Forces of bulk that is fed in proportion to the belt's speed."""


@dataclass(frozen=True)
class _Lump:
    """Lumped item: distance [m] and order, mass [kg], friction f0, f2 [N, N s²/m²], weight, more at rest [N]."""

    at: float
    stand: BoundaryOrder
    mass: float = 0.0
    friction: float = 0.0
    square: float = 0.0
    weight: float = 0.0
    stuck: float = 0.0


@dataclass(frozen=True, eq=False)
class CutLoop:
    """Loaded belt from behind its take-up round to it again.

    Attributes
    ----------
    steady : CalculatedConveyor
        Its steady result.
    way : ndarray, shape (2n + 1,)
        Distance of every boundary of stretches [m].
    order : ndarray of int, shape (2n,)
        Stretch of `line.loop` between them.
    mass, weight, stuck : ndarray, shape (2n,)
        Of every stretch: mass [kg], slope resistance [N], additional roll resistance at rest [N].
    friction : ndarray, shape (3, 2n)
        Coefficients f0, f1, f2 of f0 + f1 v + f2 v² for every stretch [N].
    lumps : tuple
        Lumped items.
    drives, pulleys : ndarray
        Distance of the drives, and of every pulley of the line [m].
    stiffness : float
        EA [N].
    hanging : ndarray, shape (2n,)
        Belt length taken up by sag between the idlers of every stretch, times T² over the length: (m' g a)²/24 [N²].
    """

    steady: CalculatedConveyor
    way: Array
    order: NDArray[np.int_]
    mass: Array
    weight: Array
    stuck: Array
    friction: Array
    lumps: tuple[_Lump, ...]
    drives: Array
    pulleys: Array
    stiffness: float
    hanging: Array

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.steady.line

    @cached_property
    def travel(self) -> Array:
        """Travel time of a wave to every boundary [s]."""
        each = [
            length / wave_speed(self.stiffness, line_mass=mass / length)
            for length, mass in zip(np.diff(self.way).tolist(), self.mass.tolist(), strict=True)
        ]
        return np.concatenate([np.zeros(1), np.cumsum(each)])

    @classmethod
    def of(cls, steady: CalculatedConveyor, slower: Sequence[CalculatedConveyor] = ()) -> CutLoop:
        """Cut open the loop of a steady result.

        Parameters
        ----------
        steady : CalculatedConveyor
            At full speed.
        slower : sequence of CalculatedConveyor
            The same at `SPEEDS` of it; by default the resistances do not change with speed.

        Raises
        ------
        NoSolutionError
            The belt's stiffness or the run-up time of a winch is not known.
        """
        line, equilibrium = steady.line, steady.balance.equilibrium
        stiffness = belt_stiffness(line.belt)
        if stiffness is None:
            raise NoSolutionError(
                "the belt's stiffness is not known: give belt.carcass.stiffness or belt.carcass.strength"
            )
        if line.take_up.winch is not None and line.take_up.winch[2] is None:
            raise NoSolutionError(
                "a winch that is at its speed at once pulls the harder the shorter the cells, without a limit: give "
                "route.take_up.winch_run_up, the time in which it comes to its speed"
            )
        ways, count = line.loop.way, 2 * line.count
        cut, after = _cut_position(line, behind=equilibrium.take_up.behind)
        first = cut.boundary % count
        order = (first + np.arange(count)) % count
        friction, weight = _stretch_forces(steady)
        drags = (np.asarray(force.newtons) for force in steady.balance.along if force.key == "idler_rotation")
        drag = next(drags, line.roll_drag_forces)  # no own part of classical methods
        stuck = (ROLL_DRAG_STANDSTILL_FACTOR - 1.0) * drag
        whole = float(ways[-1])

        def distance(spot: LoopPosition) -> float:
            at = float(ways[spot.boundary % count] - ways[first]) % whole
            before = (spot.boundary, spot.stand) <= (cut.boundary, cut.stand) if after else spot < cut
            if at == 0.0 and (before if spot.boundary == cut.boundary else spot.boundary > cut.boundary):
                return whole
            return at

        return cls(
            steady=steady,
            way=np.concatenate([np.zeros(1), np.cumsum(line.loop.length[order])]),
            order=order,
            mass=line.loop.mass[order],
            weight=_loop_order(weight, line)[order],
            stuck=_loop_order(stuck, line)[order],
            friction=_friction_parabola(line.speed, [_stretch_forces(one)[0] for one in slower], friction, line)[:,
            order],
            lumps=tuple(_point_lumps(steady, distance)),
            drives=np.array([distance(drive.spot) for drive in line.drives]),
            pulleys=np.array([distance(pulley.spot) for pulley in line.pulleys]),
            stiffness=stiffness,
            hanging=np.array([
                sag_factor(
                    s.belt_mass + s.bulk_mass, spacing=s.spacing, inclination=s.inclination, gravity=line.gravity
                )
                for s in (line.loop.stretches[k] for k in order.tolist())
            ]),
        )  # fmt: skip

    def cut_into_cells(self, step: float, *, filled: bool = True) -> Cells:
        """Cut into cells that a wave crosses in a step or little longer, with drives at cell ends.

        Parameters
        ----------
        step : float
            [s].
        filled : bool
            True if hoppers hold their bulk as after filling until the belt breaks it away; else it flows.

        Raises
        ------
        NoSolutionError
            The step is too long for the number of drives.
        """
        arriving = _space_drives(np.interp(self.drives, self.way, self.travel), float(self.travel[-1]), step)
        stations = [0.0, *sorted(arriving), float(self.travel[-1])]
        times = [np.zeros(1)]
        for start, stop in itertools.pairwise(stations):
            pieces = max(1, math.floor((stop - start) / step * (1.0 + 1e-9)))  # rounding of the quotient
            if stop > start:
                times.append(start + (stop - start) * np.arange(1, pieces + 1) / pieces)
        time = np.concatenate(times)
        at = np.interp(time, self.travel, self.way)

        def half(values: Array) -> Array:
            """Half of the distributed values along the cell before every mass."""
            cell = np.diff(np.interp(at, self.way, np.concatenate([np.zeros(1), np.cumsum(values)])))
            return np.asarray(0.5 * np.append(0.0, cell))

        def lumped(values: Array) -> Array:
            """Distributed values lumped by halves at the ends of each cell."""
            before = half(values)
            return np.asarray(before + np.append(before[1:], 0.0))

        hanging = np.concatenate([np.zeros(1), np.cumsum(self.hanging * np.diff(self.way))])
        sag = np.diff(np.interp(at, self.way, hanging))
        lying = np.stack([lumped(one) for one in (self.mass, self.weight, *self.friction, self.stuck)])
        nodes = np.array([int(np.argmin(np.abs(time - t))) for t in arriving], dtype=int)
        before = np.stack([half(one)[nodes] for one in (self.mass, self.weight, *self.friction, self.stuck)])
        rubbing = {0, at.size - 1}
        for lump in self.lumps:
            k = int(np.argmin(np.abs(at - lump.at)))
            stuck = lump.stuck if filled else 0.0
            part = np.array([lump.mass, lump.weight, lump.friction, 0.0, lump.square, stuck])
            lying[:, k] += part
            for d in np.flatnonzero(nodes == k).tolist():
                if (lump.at, lump.stand) <= (float(self.drives[d]), self.line.drives[d].spot.stand):
                    before[:, d] += part
            if lump.friction or lump.square or stuck:
                rubbing.add(k)
        mass, weight, friction, sticking = lying[0], lying[1], lying[2:5], lying[5]
        before[5] += before[2]
        lumps = np.array(sorted(rubbing.difference(nodes.tolist())), dtype=int)
        return Cells(at, mass, self.stiffness / np.diff(at), weight, friction, sticking, nodes, before, lumps, sag)


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of a loop: positions of its masses [m], shape (n + 1,); the rest as in `wave.Chain`, for one belt."""

    at: Array
    mass: Array
    stiffness: Array
    weight: Array
    friction: Array
    stuck: Array
    nodes: NDArray[np.int_]
    before: Array
    lumps: NDArray[np.int_]
    sag: Array

    @cached_property
    def slack(self) -> Array:
        """Tension at which every cell sags by a tenth of the span, from (m' g a)² = 24 b/Δs [N]."""
        return np.asarray(np.sqrt(24.0 * self.sag / np.diff(self.at)) / (8.0 * SLACK_SAG.value))

    def resisting(self, speed: float, friction: float) -> Array:
        """Friction of every mass at a speed [N]."""
        return np.asarray(friction * (self.friction[0] + speed * (self.friction[1] + speed * self.friction[2])))

    def sticking(self, friction: float) -> Array:
        """Force up to which every mass stays at rest [N], without friction that grows with speed."""
        return self.resisting(0.0, friction) + friction * self.stuck


def _cut_position(line: Line, *, behind: bool) -> tuple[LoopPosition, bool]:
    """Position of the take-up (else the slack side of the drives), and whether it is behind other items there."""
    if line.take_up.spot is not None:
        return line.take_up.spot, True
    spot = line.drives[0].spot
    return LoopPosition(spot.boundary, BoundaryOrder(spot.stand)), behind


def _loop_order(values: Array, line: Line) -> Array:
    """Reorder values from carry and return strand to the loop."""
    return np.roll(values, line.count)


def _stretch_forces(result: CalculatedConveyor) -> tuple[Array, Array]:
    """Friction and slope resistance of every stretch [N]."""
    friction, weight = np.zeros(2 * result.line.count), np.zeros(2 * result.line.count)
    for force in result.balance.along:
        if force.certain:
            weight = weight + force.newtons
        else:
            friction = friction + force.newtons
    return friction, weight


def _friction_parabola(speed: float, slower: Sequence[Array], full: Array, line: Line) -> Array:
    """Parabola through the friction at three speeds, shape (3, 2n); constant if only one is known."""
    if not slower:
        return np.stack([_loop_order(full, line), np.zeros_like(full), np.zeros_like(full)])
    powers = np.vander(speed * np.array([*SPEEDS, 1.0]), 3, increasing=True)
    return np.asarray(
        np.linalg.solve(powers, np.stack([_loop_order(one, line) for one in (*slower, full)])), dtype=float
    )


def _point_lumps(result: CalculatedConveyor, distance: Callable[[LoopPosition], float]) -> Iterator[_Lump]:
    """Local forces, what a filled hopper holds more at rest, and the pulleys without a drive."""
    speed = result.line.speed
    for force in result.balance.singles:
        if force.spot is None:
            continue
        at, stand = distance(force.spot), force.spot.stand
        if force.reach > 0.0:
            yield from _split_lump(_Lump(at, stand, friction=force.total), force.reach)
        elif force.kind == "lift":
            yield _Lump(at, stand, weight=force.total)
        elif force.key in _WITH_SPEED:
            yield _Lump(at, stand, square=force.total / speed**2)
        else:
            yield _Lump(at, stand, friction=force.total)
    for point in result.line.loading:
        if (hopper := point.loaded_hopper) is not None:
            held = _Lump(distance(point.spot), point.spot.stand, stuck=initial_pull(result.line, point))
            yield from _split_lump(held, hopper.length)
    for pulley in result.line.pulleys:
        if not pulley.driven:
            yield _Lump(distance(pulley.spot), pulley.spot.stand, mass=PULLEY_INERTIA.value * pulley.mass)


def _split_lump(whole: _Lump, reach: float) -> Iterator[_Lump]:
    """Equal pieces of a lump that acts evenly from its place over a reach [m]."""
    for k in range(_PIECES):
        at = whole.at + (k + 0.5) / _PIECES * reach
        yield replace(whole, at=at, friction=whole.friction / _PIECES, stuck=whole.stuck / _PIECES)


def _space_drives(times: Array, whole: float, step: float) -> list[float]:
    """Wave travel times of the drives, at least a step apart from each other and from the take-up.

    Raises
    ------
    NoSolutionError
        There is no room for them.
    """
    instants = [0.0 if t < 0.5 * step else whole if t > whole - 0.5 * step else float(t) for t in times]
    order = sorted(range(len(instants)), key=lambda i: instants[i])
    for k, i in enumerate(order):
        least = instants[order[k - 1]] + step if k else step
        instants[i] = instants[i] if k == 0 and instants[i] == 0.0 else max(instants[i], least)
    latest = whole
    for i in reversed(order):
        if instants[i] > latest - step and latest == whole and instants[i] != whole:
            latest = whole if instants[i] > whole - 0.5 * step else whole - step
        instants[i] = min(instants[i], latest)
        latest = instants[i] - step
    if instants and min(instants) < 0.0:
        raise NoSolutionError("the belt is too short for waves between its drives: a rigid belt will do")
    return instants
