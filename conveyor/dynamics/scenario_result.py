"""A start or stop through time, calculated, or why it is not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import Record
from conveyor.dynamics.cut_loop import Cells
from conveyor.dynamics.machines import ScenarioSetup
from conveyor.laws.waves import SLACK_SAG
from conveyor.line.line import Line
from conveyor.units.sentences import Message

Array = NDArray[np.float64]


_REST = 1e-3  # of the steady speed, below which a belt away from the drives is at rest


@dataclass(frozen=True, eq=False)
class ScenarioResult:
    """Result of a scenario.

    Attributes
    ----------
    setup : ScenarioSetup
        The scenario on its belt.
    cells : Cells
        Cells of the belt.
    record : Record
        Its record, without the axis of scenarios.
    error : float or None
        Error estimate of the highest and lowest tension over the highest [-]; None if the step was given.
    """

    setup: ScenarioSetup
    cells: Cells
    record: Record
    error: float | None

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.setup.scene.name

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.setup.loop.line

    @cached_property
    def times(self) -> Array:
        """Time of every step [s]."""
        return np.asarray(self.record.step * np.arange(len(self.record.take_up["tension"])), dtype=float)

    @cached_property
    def middles(self) -> Array:
        """Distance of every cell from the take-up [m]."""
        return np.asarray(0.5 * (self.cells.at[:-1] + self.cells.at[1:]))

    @property
    def highest(self) -> float:
        """Highest tension [N]."""
        return float(self.record.highest.max())

    @property
    def lowest(self) -> float:
        """Lowest tension [N]."""
        return float(self.record.lowest.min())

    @cached_property
    def jump(self) -> float | None:
        """Lowest tension at a pulley less that in the cell beside it, if it falls there at once, else None [N].

        It does if the largest fall within a step ends closer to the lowest tension than it is long.
        """
        cell = int(self.record.lowest.argmin())
        for d, node in enumerate(self.cells.nodes.tolist()):
            if cell in {node - 1, node}:
                tension = self.record.drives["leaving" if cell == node else "arriving"][:, d]
                fall = tension[:-1] - tension[1:]
                i = int(fall.argmax())
                if tension[i + 1] - self.lowest < fall[i]:
                    return float(tension.min()) - self.lowest
        return None

    def place(self, i: int) -> str:
        """Section and strand of a cell."""
        return self._words(float(self.middles[i]))

    def _words(self, distance: float) -> str:
        """Section and strand at a distance from the take-up."""
        order = self.setup.loop.order
        at = int(np.searchsorted(self.setup.loop.way, distance, side="right")) - 1
        stretch = self.line.loop.stretches[order[min(at, order.size - 1)]]
        return f"{stretch.section}, {stretch.strand}"

    @cached_property
    def top_speed(self) -> tuple[float, str, float]:
        """Highest speed anywhere on the belt in either direction, start included [m/s]; its location and time [s]."""
        record = self.record
        size = np.maximum(record.highest_speed, -record.lowest_speed)
        i = int(size.argmax())
        when = record.highest_speed_at if record.highest_speed[i] >= size[i] else record.lowest_speed_at
        return float(size[i]), self._words(float(self.cells.at[i])), float(when[i])

    @cached_property
    def round_loop(self) -> tuple[NDArray[np.int_], Array]:
        """Cells in belt order from the head, return strand first, and their distance from it [m]."""
        loop, ways = self.setup.loop, self.line.loop.way
        distance = (self.middles + ways[loop.order[0]]) % ways[-1]
        order = np.argsort(distance)
        return order, distance[order]

    def stretches(self) -> Iterator[tuple[int, slice]]:
        """Every stretch of `line.loop` with its cells, at least one."""
        for i, k in enumerate(self.setup.loop.order.tolist()):
            low, high = np.searchsorted(self.middles, self.setup.loop.way[i : i + 2])
            low = min(int(low), self.middles.size - 1)
            yield k, slice(low, max(int(high), low + 1))

    def beside(self, pulley: int) -> NDArray[np.int_]:
        """Cells on both sides of a pulley of the line, across the take-up if it is next to it."""
        at = self.cells.at
        i = int(np.argmin(np.abs(at - self.setup.loop.pulleys[pulley])))
        return np.array([i - 1, i]) % (at.size - 1)

    @cached_property
    def sag(self) -> Array:
        """Largest sag of every cell over the span of its idlers [-]."""
        return np.asarray(SLACK_SAG.value * self.cells.slack / self.record.lowest)

    @cached_property
    def torque(self) -> Array:
        """Torque of every motor over its rated torque [-], shape (steps, d)."""
        return np.asarray(self.record.drives["motor"] / self.setup.rated)

    @cached_property
    def travel(self) -> Array:
        """Travel of the take-up's carriage at every step, away from the belt positive [m]."""
        return np.asarray(self.record.take_up["belt"] / self.line.take_up.strands)

    @cached_property
    def stops(self) -> bool:
        """True if the last command to every drive is to stop."""
        told = {d: happening.do for happening in self.setup.scene.drive_events for d in happening.drives}
        return len(told) == len(self.setup.drives) and "start" not in told.values()

    @cached_property
    def belt_speed(self) -> Array:
        """Belt speed at the first drive at every step [m/s]."""
        return np.asarray(self.record.drives["belt"][:, 0])

    @cached_property
    def rests_at(self) -> float | None:
        """Time at which drive pulleys and belt are finally at rest [s]; None if they are not."""
        turning = np.abs(self.record.drives["belt"]).max(axis=1) > 0.0
        creeping = np.abs(self.record.speeds).max(axis=1) > _REST * self.line.speed
        if turning[-1] or creeping[-1]:
            return None
        ends = [
            float(times[np.flatnonzero(moves)[-1]])
            for times, moves in ((self.times, turning), (self.record.times, creeping))
            if moves.any()
        ]
        return max(ends, default=0.0)

    @cached_property
    def way(self) -> float:
        """Distance run by the belt at the first drive [m]."""
        return float(self.belt_speed.sum() * self.record.step)

    @property
    def missing_energy(self) -> float:
        """Error of the energy balance over its largest term [-]."""
        work = {name: abs(float(value)) for name, value in self.record.work.items()}
        missing = work.pop("missing")
        return missing / max(work.values())


@dataclass(frozen=True)
class ScenarioRefusal:
    """A scenario without an answer, and the reason."""

    scenario: str
    reason: Message
