"""What is recorded of belts in motion: extremes, samples, drives, energy."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import Array, Chain, InitialState, Integers, Record
from conveyor.dynamics.wave_solver import BeltLaw
from conveyor.errors import NoSolutionError

_BLOCK = 32  # steps between two searches for extremes
SLIDING_TIME: Final = 0.3
"""Time over which accelerations are means [s]: bulk that a wave's jump leaves behind slides by a T²/2 at most, 0.2 m at
5 m/s² (general knowledge)."""


@dataclass(eq=False)
class _Extremes:
    """Highest and lowest of values recorded step by step, and their steps."""

    shape: tuple[int, ...]
    block: Array = field(init=False)
    count: int = 0
    first: int = -1  # the initial state is recorded before the first step

    def __post_init__(self) -> None:
        self.block = np.empty((_BLOCK, *self.shape))
        self.high, self.low = np.full(self.shape, -np.inf), np.full(self.shape, np.inf)
        self.high_at, self.low_at = np.zeros(self.shape), np.zeros(self.shape)

    def tell(self, values: Array) -> None:
        """Record values of the first belts."""
        self.block[self.count, : len(values)] = values
        self.count += 1
        if self.count == _BLOCK:
            self.look(len(values))

    def look(self, belts: int) -> None:
        """Look for extremes of the first belts in what was recorded since."""
        if self.count == 0:
            return
        block = self.block[: self.count, :belts]
        for extreme, best, at, better in (
            (block.argmax(axis=0), self.high[:belts], self.high_at[:belts], np.greater),
            (block.argmin(axis=0), self.low[:belts], self.low_at[:belts], np.less),
        ):
            extremes = np.take_along_axis(block, extreme[None], axis=0)[0]
            new = better(extremes, best)
            best[new] = extremes[new]
            at[new] = (self.first + extreme)[new]
        self.first += self.count
        self.count = 0

    def include_series(self, *place: int, values: Array) -> None:
        """Include a further series of one of them, from the initial state on."""
        for i, best, at, better in (
            (int(values.argmax()), self.high, self.high_at, np.greater),
            (int(values.argmin()), self.low, self.low_at, np.less),
        ):
            if better(values[i], best[place]):
                best[place], at[place] = values[i], i - 1


def stored_energy(chain: Chain, speed: Array, rims: Array, law: BeltLaw) -> Array:
    """Kinetic energy, that of springs and sag, and that of the relaxing branch [J], shape (3, s)."""
    apart = speed[np.arange(chain.end.size), chain.end] - speed[:, 0]
    mass = np.where(np.isinf(chain.carriage), 0.0, chain.carriage)
    moving = np.einsum("sn,sn->s", chain.mass, speed**2) + np.einsum("sd,sd->s", chain.rim, rims**2)
    return np.stack([0.5 * (moving + mass * apart**2), *law.stored()])


class MotionRecord:
    """Record of belts from step to step; the first belts go on when others end.

    `drives` and `take_up` are as in `Record`; `frictions` and `going` are friction [N] and speed before a step [m/s] of
    the belt on driven pulleys.
    """

    def __init__(
        self, chain: Chain, start: InitialState, law: BeltLaw, *, step: Array, lasts: Integers, samples: int
    ) -> None:
        s, n = chain.stiffness.shape
        self.chain, self.start, self.dt, self.lasts, self.belts = chain, start, step, lasts, s
        most = int(lasts.max())
        self.extremes, self.speeds = _Extremes((s, n)), _Extremes((s, n + 1))
        self.extremes.tell(start.tension)
        self.speeds.tell(start.speed)
        names = ("force", "motor", "rim", "belt", "arriving", "leaving", "holding")
        self.drives = {name: np.zeros((most, *chain.nodes.shape)) for name in names}
        self.take_up = {name: np.zeros((most, s)) for name in ("tension", "belt")}
        self.frictions, self.going = np.zeros((2, most, *chain.nodes.shape))
        self.every = np.maximum(lasts // samples, 1)
        count = int((-(-lasts // self.every)).max())
        self.tensions: NDArray[np.float32] = np.zeros((count, s, n), np.float32)
        self.samples: NDArray[np.float32] = np.zeros((count, s, n + 1), np.float32)
        self.half = np.maximum(np.rint(0.5 * SLIDING_TIME / step).astype(int), 1)
        self.earlier, self.fastest, self.slowest = np.stack([start.speed] * 2), *np.zeros((2, s, n + 1))
        self.taken, self.way, self.rubbed = np.zeros(s), *np.zeros((2, s, n + 1))
        self.damped, self.stored = np.zeros((s, n)), np.zeros((3, s))
        self.first = stored_energy(chain, start.speed, start.rims, law)
        self._group_samples()

    def _group_samples(self) -> None:
        """Belts that go on, by the steps from sample to sample, and by those of half the sliding time."""
        self.due, self.halves = (
            [(int(one), np.flatnonzero(steps == one)) for one in np.unique(steps)]
            for steps in (self.every[: self.belts], self.half[: self.belts])
        )

    def end_belts(self, count: int, stored: Array) -> None:
        """End all but the first belts, with the energy stored in all that went on until now [J]."""
        self.extremes.look(self.belts)
        self.speeds.look(self.belts)
        self.stored[:, count : self.belts] = stored[:, count:]
        self.belts = count
        self._group_samples()

    def add_work(self, speed: Array, spread: Array, friction: Array, damping: Array) -> None:
        """Add the work of a step along the belts, with twice the mean speeds and speed differences."""
        self.way[: self.belts] += speed
        self.rubbed[: self.belts] += friction * speed
        self.damped[: self.belts] += damping * spread

    def keep(self, i: int, tension: Array, speed: Array, pulled: Array, apart: Array) -> None:
        """Record extremes, samples and the take-up after a step."""
        self.extremes.tell(tension)
        self.speeds.tell(speed)
        taken = self.taken[: self.belts]
        taken += self.dt[: self.belts] * apart
        self.take_up["tension"][i, : self.belts], self.take_up["belt"][i, : self.belts] = pulled, taken
        for every, rows in self.due:
            if i % every == 0:
                self.tensions[i // every, rows], self.samples[i // every, rows] = tension[rows], speed[rows]
        for half, rows in self.halves:
            if i % half == 0:
                now = speed[rows]
                change = (now - self.earlier[0, rows]) / (2.0 * half * self.dt[rows, None])
                self.fastest[rows] = np.maximum(change, self.fastest[rows])
                self.slowest[rows] = np.minimum(change, self.slowest[rows])
                self.earlier[0, rows], self.earlier[1, rows] = self.earlier[1, rows], now

    def closed(self, beside: Array) -> Record:
        """Record of all belts, with the initial tensions before and behind the driven pulleys."""
        self._at_pulleys(beside)
        extremes, speeds, dt = self.extremes, self.speeds, self.dt
        if not (np.all(np.isfinite(extremes.high)) and np.all(np.isfinite(self.stored))):
            raise NoSolutionError("the belt's motion has no finite answer: look for extreme inputs")
        slip = dt[:, None] * (self.drives["rim"] - self.drives["belt"])
        sampled = self.every * np.arange(len(self.samples))[:, None]
        return Record(
            dt, extremes.high, extremes.low, self._time(extremes.high_at), self._time(extremes.low_at), speeds.high,
            speeds.low, self._time(speeds.high_at), self._time(speeds.low_at),
            np.where(sampled < self.lasts, sampled * dt, 0.0), self.tensions, self.samples, self.drives, self.take_up,
            np.abs(slip).sum(axis=0), (slip * self.drives["force"]).sum(axis=0), self.fastest, self.slowest,
            self._work(),
        )  # fmt: skip

    def _time(self, steps: Array) -> Array:
        """Time of a step; 0 for the initial state."""
        return np.asarray(self.dt[:, None] * np.maximum(steps, 0.0))

    def _at_pulleys(self, begin: Array) -> None:
        """Extremes of cells that end on driven pulleys, where sudden forces act first."""
        at = self.chain.nodes
        for side, name in enumerate(("arriving", "leaving")):
            values = np.concatenate([begin[side][None], self.drives[name]])
            for row, d in np.argwhere(at != (self.chain.end[:, None] if side else 0)).tolist():
                series = values[: self.lasts[row] + 1, row, d]
                self.extremes.include_series(row, int(at[row, d]) - 1 + side, values=series)

    def _work(self) -> dict[str, Array]:
        """Energy balance, at the mean of old and new speeds; that in the relaxing branch is elastic, not damped."""
        chain, drives, start, dt = self.chain, self.drives, self.start, self.dt
        kinetic, elastic, held = self.stored - self.first
        rim = 0.5 * (drives["rim"] + np.concatenate([start.rims[None], drives["rim"][:-1]]))
        belt = 0.5 * (drives["belt"] + self.going)
        begins = start.speed[np.arange(chain.end.size), chain.end] - start.speed[:, 0]
        apart = np.diff(self.take_up["belt"], axis=0, prepend=0.0) / dt
        mean = 0.5 * (apart + np.concatenate([begins[None], apart[:-1]]))
        goes_on = np.arange(len(mean))[:, None] < self.lasts
        pull = np.where(goes_on, np.where(chain.winch[0] > 0.0, self.take_up["tension"], chain.held), 0.0)
        made = {
            "motors": dt * (drives["motor"] * rim).sum(axis=(0, 2)),
            "lift": 0.5 * dt * (chain.weight * self.way).sum(axis=1),
            "friction": dt * ((self.frictions * belt).sum(axis=(0, 2)) + 0.5 * self.rubbed.sum(axis=1)),
            "damping": 0.5 * dt * self.damped.sum(axis=1) - held,
            "brakes": dt * (drives["holding"] * rim).sum(axis=(0, 2)),
            "slip": dt * (drives["force"] * (rim - belt)).sum(axis=(0, 2)),
            "take-up": -dt * (pull * mean).sum(axis=0),
            "kinetic": kinetic,
            "elastic": elastic + held,
        }
        spent = sum((value for name, value in made.items() if name != "motors"), np.zeros_like(kinetic))
        return made | {"missing": made["motors"] - spent}
