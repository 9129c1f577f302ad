"""Belts cut into masses, their machines, how they begin, and what is recorded of their motion."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


Integers = NDArray[np.int_]


SPEED_POINTS = 65  # points of the motors' limits over speed

_Number = TypeVar("_Number", np.float64, np.float32)


_Belts = TypeVar("_Belts", "Chain", "Machines", "InitialState")


def _of_belts(batch: _Belts, rows: slice | Integers, second: Collection[str]) -> _Belts:
    """Some belts of a batch; their axis is the first of its arrays, of some the second."""
    arrays = {one.name: getattr(batch, one.name) for one in fields(batch)}
    some: dict[str, Any] = {
        name: value[:, rows] if name in second else value[rows]
        for name, value in arrays.items()
        if isinstance(value, np.ndarray)
    }
    return replace(batch, **some)


@dataclass(frozen=True, eq=False)
class Chain:
    """A batch of belts, shape (s, n + 1) for masses, (s, n) for cells; cells behind a belt's own end stay idle.

    Attributes
    ----------
    mass : ndarray
        Of belt, bulk and rolls [kg].
    stiffness : ndarray
        k = EA/Δs of a cell [N/m]; 0 of an idle one.
    retardation : float
        τ of Kelvin and Voigt [s].
    sag : ndarray
        b of a cell, which sag shortens by b/T² [m N²]: its length times (m' g a)²/24; 0 without sag.
    relaxing : tuple of float
        Stiffness over k of Maxwell's branch parallel to the spring, and its relaxation time [-, s]; a standard solid.
    weight : ndarray
        Force of gravity against the running direction [N].
    friction : ndarray, shape (3, s, n + 1)
        Force at a speed, f0 + f1 |v| + f2 v² [N], constant beyond `known`.
    sticking : ndarray
        Force up to which a mass stays at rest [N].
    end : ndarray of int, shape (s,)
        Mass right before the take-up; mass 0 is right behind it.
    nodes : ndarray of int, shape (s, d)
        Masses on driven pulleys, all of them different.
    before : ndarray, shape (6, s, d)
        Part of each of those before its pulley: mass [kg], weight, friction f0, f1, f2, and that at rest, as for the
        whole mass; the rest lies behind it.
    lumps : ndarray of int, shape (s, l)
        Masses with local friction, which does not shrink with the cell, and those next to the take-up; friction on a
        driven mass belongs to its pulley.
    rim : ndarray, shape (s, d)
        Rotating mass of each drive reduced to the belt [kg].
    grip : ndarray, shape (s, d)
        e^(μ α) - 1 of each driven pulley [-].
    backstop : ndarray of bool, shape (s, d)
        True if a pulley cannot turn backward.
    held : ndarray, shape (s,)
        Take-up tension at rest [N].
    carriage : ndarray, shape (s,)
        Its mass over the square of its strands [kg]; infinite if it is fixed.
    winch : ndarray, shape (3, s)
        Speed at which a winch takes in belt [m/s], 0 without one; tension over `held` within which it rests [-];
        run-up and stopping time [s].
    known : float
        Speed up to which friction is known [m/s].
    """

    mass: Array
    stiffness: Array
    retardation: float
    weight: Array
    friction: Array
    sticking: Array
    end: Integers
    nodes: Integers
    before: Array
    lumps: Integers
    rim: Array
    grip: Array
    backstop: NDArray[np.bool_]
    held: Array
    carriage: Array
    winch: Array
    sag: Array
    relaxing: tuple[float, float] = (0.0, 1.0)
    known: float = math.inf

    def of_belts(self, rows: slice | Integers) -> Chain:
        """Some of the belts."""
        return _of_belts(self, rows, {"friction", "before", "winch"})

    @property
    def longest_step(self) -> float:
        """Longest stable step of all belts [s]."""
        return float(self.longest_steps.min())

    @property
    def longest_steps(self) -> Array:
        """Longest stable step of the leapfrog, by Gershgorin: 2/ω of the fastest pair of cells [s], shape (s,)."""
        stiff = (1.0 + self.relaxing[0]) * self.stiffness
        pull = 2.0 * (np.pad(stiff, ((0, 0), (1, 0))) + np.pad(stiff, ((0, 0), (0, 1))))
        return np.asarray(2.0 / np.sqrt((pull / self.mass).max(axis=1)))


def friction_at_speed(friction: Array, speed: Array, known: float) -> Array:
    """Friction f0 + f1 |v| + f2 v² at speeds [N], from its coefficients, shape (3, ...); constant beyond `known`."""
    size = np.minimum(np.abs(speed), known)
    force = np.asarray(size * friction[2])
    force += friction[1]
    force *= size
    force += friction[0]
    return force


@dataclass(frozen=True, eq=False)
class BeltRow:
    """Masses of all belts in one row, m in all, each with the cell behind it; the last cell of a belt is its take-up.

    Attributes
    ----------
    inside : ndarray of bool, shape (s, n + 1)
        Masses of a chain that are not behind the end of their belt.
    size, first, last : ndarray of int, shape (s,)
        Masses of every belt, and where the first and the last of them are in the row.
    """

    inside: NDArray[np.bool_]
    size: Integers
    first: Integers
    last: Integers

    @classmethod
    def of(cls, chain: Chain) -> BeltRow:
        """The belts of a chain, one behind the other."""
        size = chain.end + 1
        last = np.cumsum(size) - 1
        return cls(np.arange(chain.mass.shape[1]) <= chain.end[:, None], size, last - chain.end, last)

    def masses(self, values: Array) -> Array:
        """Values of masses in the row, from shape (..., s, n + 1) to (..., m)."""
        return np.asarray(values[..., self.inside])

    def cells(self, values: Array, take_up: float) -> Array:
        """Values of cells in the row, from shape (s, n) to (m,), with one for the take-ups."""
        made = np.pad(values, ((0, 0), (0, 1)))[self.inside]
        made[self.last] = take_up
        return np.asarray(made)

    def each(self, values: Array) -> Array:
        """Values of belts at all of their masses, from shape (s,) to (m,)."""
        return np.repeat(values, self.size)

    def sums(self, values: Array) -> Array:
        """Sums over every belt, from shape (..., m) to (..., s)."""
        return np.asarray(np.add.reduceat(values, self.first, axis=-1))

    def padded(self, values: NDArray[_Number]) -> NDArray[_Number]:
        """Values of the row as those of a chain, 0 behind the end of a belt, from shape (..., m) to (..., s, n + 1)."""
        made = np.zeros((*values.shape[:-1], *self.inside.shape), values.dtype)
        made[..., self.inside] = values
        return made


@dataclass(frozen=True, eq=False)
class Machines:
    """Motors and brakes of the drives over time, shape (steps, s, d), and over speed.

    A motor gives the force `slope` (`reference` - v) on the belt [N], limited to `share` times its limit at the speed.

    Attributes
    ----------
    slope : ndarray, shape (s, d)
        Slope of the motor's steady characteristic [N s/m].
    reference : ndarray, shape (steps, s, d)
        Rim speed of the pulley at no load [m/s].
    share : ndarray, shape (steps, s, d)
        Share of the limit that is switched on [-]; 0 without power.
    brake : ndarray, shape (steps, s, d)
        Force of the brakes at the belt [N].
    limits : ndarray, shape (s, d, 65)
        Largest force over the speed from 0 to `top` [N].
    top : float
        Highest speed of `limits` [m/s].
    drag : ndarray, shape (s, d)
        Own drag of a drive without power once its belt slips [N].
    """

    slope: Array
    reference: Array
    share: Array
    brake: Array
    limits: Array
    top: float
    drag: Array

    def of_belts(self, rows: slice | Integers) -> Machines:
        """Those of some belts."""
        return _of_belts(self, rows, {"reference", "share", "brake"})

    @cached_property
    def even(self) -> Array | None:
        """The limits if they do not change with speed, shape (s, d)."""
        first = self.limits[..., 0]
        return first if bool(np.all(self.limits == first[..., None])) else None

    def limit(self, speed: Array) -> Array:
        """Largest force at a speed [N], shape (s, d)."""
        if self.even is not None:
            return self.even
        over = np.minimum(np.abs(speed) / self.top, 1.0) * (SPEED_POINTS - 1)
        low = np.minimum(over.astype(int), SPEED_POINTS - 2)
        s, d = np.ogrid[: low.shape[0], : low.shape[1]]
        first, second = self.limits[s, d, low], self.limits[s, d, low + 1]
        return np.asarray(first + (over - low) * (second - first))


@dataclass(frozen=True, eq=False)
class InitialState:
    """Initial state: speeds and tensions, friction, forces of the drives on the belt, rim speeds [m/s, N]."""

    speed: Array
    tension: Array
    resisting: Array
    driving: Array
    rims: Array

    def of_belts(self, rows: slice | Integers) -> InitialState:
        """That of some belts."""
        return _of_belts(self, rows, ())


@dataclass(frozen=True, eq=False)
class Record:
    """Recorded motion.

    Attributes
    ----------
    step : ndarray, shape (s,)
        Time step [s].
    highest, lowest, highest_at, lowest_at : ndarray, shape (s, n)
        Extreme tensions in the middle of every cell, and at the driven pulley of cells ending there [N]; times [s].
    highest_speed, lowest_speed, highest_speed_at, lowest_speed_at : ndarray, shape (s, n + 1)
        Extreme speeds of every mass, initial ones included [m/s], and times [s].
    times, tensions : ndarray, shape (m, s), (m, s, n)
        Samples of the tension [N] and their times [s]; 0 after the end of a belt's motion.
    speeds : ndarray, shape (m, s, n + 1)
        Samples of the belt's speed [m/s].
    drives : dict of str to ndarray, shape (steps, s, d)
        At every step, 0 after the end: "force" on the belt, "motor" force, "rim" and "belt" speeds, "arriving" and
        "leaving" tensions at the pulley, "holding" force of brake and backstop.
    take_up : dict of str to ndarray, shape (steps, s)
        Its "tension" [N] and the "belt" it has taken in [m].
    slipped, heat : ndarray, shape (s, d)
        Slip distance of the rim on the belt [m], and its heat [J].
    fastest, slowest : ndarray, shape (s, n + 1)
        Highest and lowest mean acceleration of every mass over `SLIDING_TIME` [m/s²].
    work : dict of str to ndarray, shape (s,)
        Energy given by the motors and its uses [J]; "missing" is the error of the balance.
    """

    step: Array
    highest: Array
    lowest: Array
    highest_at: Array
    lowest_at: Array
    highest_speed: Array
    lowest_speed: Array
    highest_speed_at: Array
    lowest_speed_at: Array
    times: Array
    tensions: NDArray[np.float32]
    speeds: NDArray[np.float32]
    drives: dict[str, Array]
    take_up: dict[str, Array]
    slipped: Array
    heat: Array
    fastest: Array
    slowest: Array
    work: dict[str, Array]
