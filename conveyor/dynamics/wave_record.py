"""What is recorded of belts in motion: extremes, samples, drives, energy."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import Array, BeltRow, Chain, InitialState, Integers, Record
from conveyor.dynamics.wave_solver import BeltLaw
from conveyor.errors import NoSolutionError

_BLOCK = 32  # steps between two searches for extremes
DRIVE_FIGURES: Final = ("force", "motor", "rim", "belt", "arriving", "leaving", "holding", "friction", "before")
"""Figures of a drive at every step: seven as in `Record`, friction of the belt on its pulley [N], and speed of the belt
there before the step [m/s]."""
BESIDE: Final = slice(4, 6)
"""Those that are tensions before and behind a pulley."""
_TOLD = 7
SLIDING_TIME: Final = 0.3
"""Time over which accelerations are means [s]: bulk that a wave's jump leaves behind slides by a T²/2 at most, 0.2 m at
5 m/s² (general knowledge)."""


class _Extremes:
    """Highest and lowest of values over the steps, and their steps."""

    def __init__(self, begin: Array) -> None:
        self.high, self.low = begin.copy(), begin.copy()
        self.high_at, self.low_at = np.zeros((2, *begin.shape))

    def include(self, block: Array, first: int) -> None:
        """Include the values of some steps of the first masses, from step `first` on."""
        masses = block.shape[1]
        for extremes, best, at, better in (
            (block.max(axis=0), self.high[:masses], self.high_at[:masses], np.greater),
            (block.min(axis=0), self.low[:masses], self.low_at[:masses], np.less),
        ):
            new = better(extremes, best)
            best[new] = extremes[new]
            at[new] = first + (block[:, new] == best[new]).argmax(axis=0)

    def include_series(self, place: int, values: Array) -> None:
        """Include a further series of one of them, from the initial state on."""
        for i, best, at, better in (
            (int(values.argmax()), self.high, self.high_at, np.greater),
            (int(values.argmin()), self.low, self.low_at, np.less),
        ):
            if better(values[i], best[place]):
                best[place], at[place] = values[i], i - 1


def stored_energy(chain: Chain, row: BeltRow, speed: Array, rims: Array, law: BeltLaw) -> Array:
    """Kinetic energy, that of springs and sag, and that of the relaxing branch [J], shape (3, s)."""
    apart = speed[row.last] - speed[row.first]
    mass = np.where(np.isinf(chain.carriage), 0.0, chain.carriage)
    moving = row.sums(row.masses(chain.mass) * speed**2) + np.einsum("sd,sd->s", chain.rim, rims**2)
    return np.stack([0.5 * (moving + mass * apart**2), *law.stored()])


class MotionRecord:
    """Record of belts from step to step; the first belts go on when others end.

    Steps are kept in blocks, from which extremes, samples and work are taken together. `drives`, shape
    (steps, 9, s, d), has the figures of `DRIVE_FIGURES`; `take_up` is as in `Record`.
    """

    def __init__(
        self, chain: Chain, row: BeltRow, start: InitialState, law: BeltLaw, *,
        step: Array, lasts: Integers, samples: int,
    ) -> None:  # fmt: skip
        s = chain.end.size
        self.chain, self.row, self.start, self.dt, self.lasts, self.belts = chain, row, start, step, lasts, s
        most, masses = int(lasts.max()), int(row.last[-1]) + 1
        speed = row.masses(start.speed)
        self.extremes, self.speeds = _Extremes(law.tension), _Extremes(speed)
        self.first, self.count = 0, 0  # first step of the block, and steps in it
        self.shown, self.damping, self.friction = np.empty((3, _BLOCK, masses))
        self.speed = np.empty((_BLOCK + 1, masses))
        self.speed[0] = speed
        self.drives = np.zeros((most, len(DRIVE_FIGURES), *chain.nodes.shape))
        self.take_up = {name: np.zeros((most, s)) for name in ("tension", "belt")}
        self.pulled = self.take_up["tension"]
        self.every = np.maximum(lasts // samples, 1)
        count = int((-(-lasts // self.every)).max())
        self.tensions: NDArray[np.float32] = np.zeros((count, masses), np.float32)
        self.samples: NDArray[np.float32] = np.zeros((count, masses), np.float32)
        self.half = np.maximum(np.rint(0.5 * SLIDING_TIME / step).astype(int), 1)
        self.earlier, self.fastest, self.slowest = np.stack([speed] * 2), *np.zeros((2, masses))
        self.taken, self.way, self.rubbed, self.damped = np.zeros(s), *np.zeros((3, masses))
        self.stored = np.zeros((3, s))
        self.initial = stored_energy(chain, row, speed, start.rims, law)
        self._group_samples()

    def _group_samples(self) -> None:
        """Masses of the belts that go on, by the steps from sample to sample, and by those of half the sliding time."""
        size = self.row.size[: self.belts]
        self.masses = int(size.sum())
        self.due, self.halves = (
            [(int(one), np.flatnonzero(np.repeat(steps[: self.belts] == one, size))) for one in np.unique(steps)]
            for steps in (self.every, self.half)
        )

    def end_belts(self, count: int, stored: Array) -> None:
        """End all but the first belts, with the energy stored in all that went on until now [J]."""
        self._close_block()
        self.stored[:, count : self.belts] = stored[:, count:]
        self.belts = count
        self._group_samples()

    def step_rows(self) -> tuple[Array, Array, Array, Array]:
        """Arrays to write the next step into: tensions, speeds, still those before it, friction and damping."""
        at, masses = self.count, self.masses
        new = self.speed[at + 1, :masses]
        new[:] = self.speed[at, :masses]
        return self.shown[at, :masses], new, self.friction[at, :masses], self.damping[at, :masses]

    def keep(self, i: int, *, pulled: Array) -> None:
        """Keep the step that is written, with the take-up's tension."""
        self.pulled[i, : self.belts] = pulled
        self.count += 1
        if self.count == _BLOCK:
            self._close_block()

    def _close_block(self) -> None:
        """Take from the block what is recorded, and begin the next one."""
        first, count, masses = self.first, self.count, self.masses
        if count == 0:
            return
        tension, speed = self.shown[:count, :masses], self.speed[: count + 1, :masses]
        self.extremes.include(tension, first)
        self.speeds.include(speed[1:], first)
        self._add_work(speed[1:] + speed[:-1])
        self._add_belt(speed[1:])
        steps = np.arange(first, first + count)
        for every, at in self.due:
            now = steps[steps % every == 0, None]
            if now.size:
                self.tensions[now // every, at] = tension[now - first, at]
                self.samples[now // every, at] = speed[1:][now - first, at]
        for half, at in self.halves:
            now = steps[steps % half == 0, None]
            if now.size:
                series = np.concatenate([self.earlier[:, at], speed[1:][now - first, at]])
                change = series[2:] - series[:-2]  # over twice the time of half of it
                self.fastest[at] = np.maximum(change.max(axis=0), self.fastest[at])
                self.slowest[at] = np.minimum(change.min(axis=0), self.slowest[at])
                self.earlier[:, at] = series[-2:]
        self.speed[0, :masses] = speed[-1]
        self.first, self.count = first + count, 0

    def _add_work(self, twice: Array) -> None:
        """Add the work of the steps of the block along the belts, by twice the mean speeds."""
        count, masses = twice.shape
        self.way[:masses] += twice.sum(axis=0)
        self.rubbed[:masses] += np.einsum("km,km->m", self.friction[:count, :masses], twice)
        self.damped[: masses - 1] += np.einsum(
            "km,km->m", self.damping[:count, : masses - 1], twice[:, 1:] - twice[:, :-1]
        )

    def _add_belt(self, speed: Array) -> None:
        """Add the belt that the take-up has taken in over the steps of the block."""
        count, belts, row = len(speed), self.belts, self.row
        apart = speed[:, row.last[:belts]] - speed[:, row.first[:belts]]
        taken = np.cumsum(np.concatenate([self.taken[None, :belts], self.dt[:belts] * apart]), axis=0)
        self.take_up["belt"][self.first : self.first + count, :belts] = taken[1:]
        self.taken[:belts] = taken[-1]

    def closed(self, beside: Array) -> Record:
        """Record of all belts, with the initial tensions before and behind the driven pulleys."""
        self._at_pulleys(beside)
        extremes, speeds, dt, row = self.extremes, self.speeds, self.dt, self.row
        if not (np.all(np.isfinite(extremes.high)) and np.all(np.isfinite(self.stored))):
            raise NoSolutionError("the belt's motion has no finite answer: look for extreme inputs")
        drives = {name: self.drives[:, k] for k, name in enumerate(DRIVE_FIGURES[:_TOLD])}
        slip = dt[:, None] * (drives["rim"] - drives["belt"])
        sampled = self.every * np.arange(len(self.samples))[:, None]
        high, low, high_at, low_at = (
            row.padded(one)[:, :-1] for one in (extremes.high, extremes.low, extremes.high_at, extremes.low_at)
        )
        fastest, slowest = row.padded(np.stack([self.fastest, self.slowest])) / (2.0 * self.half * dt)[:, None]
        return Record(
            dt, high, low, self._time(high_at), self._time(low_at), row.padded(speeds.high),
            row.padded(speeds.low), self._time(row.padded(speeds.high_at)), self._time(row.padded(speeds.low_at)),
            np.where(sampled < self.lasts, sampled * dt, 0.0), row.padded(self.tensions)[:, :, :-1],
            row.padded(self.samples), drives, self.take_up, np.abs(slip).sum(axis=0),
            (slip * drives["force"]).sum(axis=0), fastest, slowest, self._work(),
        )  # fmt: skip

    def _time(self, steps: Array) -> Array:
        """Time of a step; 0 for the initial state."""
        return np.asarray(self.dt[:, None] * np.maximum(steps, 0.0))

    def _at_pulleys(self, begin: Array) -> None:
        """Extremes of cells that end on driven pulleys, where sudden forces act first."""
        at, beside = self.chain.nodes, np.concatenate([begin[None], self.drives[:, BESIDE]])
        for side in range(2):
            values = beside[:, side]
            for row, d in np.argwhere(at != (self.chain.end[:, None] if side else 0)).tolist():
                series = values[: self.lasts[row] + 1, row, d]
                self.extremes.include_series(int(self.row.first[row] + at[row, d]) - 1 + side, series)

    def _work(self) -> dict[str, Array]:
        """Energy balance, at the mean of old and new speeds; that in the relaxing branch is elastic, not damped."""
        chain, start, dt = self.chain, self.start, self.dt
        drives = {name: self.drives[:, k] for k, name in enumerate(DRIVE_FIGURES)}
        kinetic, elastic, held = self.stored - self.initial
        rim = 0.5 * (drives["rim"] + np.concatenate([start.rims[None], drives["rim"][:-1]]))
        belt = 0.5 * (drives["belt"] + drives["before"])
        begins = start.speed[np.arange(chain.end.size), chain.end] - start.speed[:, 0]
        lifted = self.row.sums(self.row.masses(chain.weight) * self.way)
        apart = np.diff(self.take_up["belt"], axis=0, prepend=0.0) / dt
        mean = 0.5 * (apart + np.concatenate([begins[None], apart[:-1]]))
        goes_on = np.arange(len(mean))[:, None] < self.lasts
        pull = np.where(goes_on, np.where(chain.winch[0] > 0.0, self.take_up["tension"], chain.held), 0.0)
        made = {
            "motors": dt * (drives["motor"] * rim).sum(axis=(0, 2)),
            "lift": 0.5 * dt * lifted,
            "friction": dt * ((drives["friction"] * belt).sum(axis=(0, 2)) + 0.5 * self.row.sums(self.rubbed)),
            "damping": 0.5 * dt * self.row.sums(self.damped) - held,
            "brakes": dt * (drives["holding"] * rim).sum(axis=(0, 2)),
            "slip": dt * (drives["force"] * (rim - belt)).sum(axis=(0, 2)),
            "take-up": -dt * (pull * mean).sum(axis=0),
            "kinetic": kinetic,
            "elastic": elastic + held,
        }
        spent = sum((value for name, value in made.items() if name != "motors"), np.zeros_like(kinetic))
        return made | {"missing": made["motors"] - spent}
