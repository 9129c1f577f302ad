"""What the loop of tensions has before the forces along the belt are known: spots, point forces, pulleys, drives."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from conveyor.forces import Bend, Force, at_places, bends
from conveyor.laws.power import belt_power, motor_power
from conveyor.line.line import Line
from conveyor.line.stations import Spot

Array = NDArray[np.float64]


class Sums:
    """Running sums of one kind of force round the loop: everywhere, at the boundaries in use, and their mean."""

    def __init__(self, forces: Array, line: Line, boundaries: list[int]) -> None:
        shape = line.loop
        self.along = np.concatenate([np.zeros(1), np.cumsum(forces)])
        self.at: list[float] = self.along[boundaries].tolist()
        self.mean = float((self.along[:-1] + self.along[1:]) @ shape.length) / (2.0 * float(shape.way[-1]))
        self.whole = self.at[-1]


class Frame:
    """The loop of a line, ready for the forces along the belt; scenes that differ in rubber share it.

    Attributes
    ----------
    line : Line
        The conveyor.
    points : tuple of Force
        At single places, that no tension changes.
    bends : tuple of Bend
        Pulleys that bend the belt.
    spots, boundaries : list
        Where anything stands, as the belt meets it from the head.
    stops : list of int
        Of each spot the place of its boundary among `boundaries`.
    """

    def __init__(self, line: Line) -> None:
        self.line = line
        self.points: tuple[Force, ...] = at_places(line)
        self.bends: tuple[Bend, ...] = bends(line)
        places = line.places
        self.landing = line.loading[0].spot if line.loading else places.landing(None)
        ends = (places.before("tail", None), places.before("head", None), places.behind("head", None))
        held = () if line.take_up.spot is None else (line.take_up.spot,)
        standing = (
            *(force.spot for force in self.points if force.spot is not None),
            *(pulley.spot for pulley in line.pulleys),
            *(drive.spot for drive in line.drives),
        )
        self.spots: list[Spot] = sorted({*ends, self.landing, *held, *standing})
        self.boundaries: list[int] = sorted({spot.boundary for spot in self.spots})
        self.runs = np.diff(self.boundaries)
        self.at = {spot: j for j, spot in enumerate(self.spots)}
        numbered = {boundary: k for k, boundary in enumerate(self.boundaries)}
        self.stops = [numbered[spot.boundary] for spot in self.spots]
        self.head = self.stops.index(len(self.boundaries) - 1)
        self.drives: list[list[int]] = [[] for _ in self.spots]
        for i, drive in enumerate(line.drives):
            self.drives[self.at[drive.spot]].append(i)
        self.station = next(stop for stop in self.drives if 0 in stop)
        self.anchor = None if line.take_up.spot is None else self.at[line.take_up.spot]
        way = line.loop.way
        self.run_shares: list[float] = (np.diff(way[self.boundaries]) / way[-1]).tolist()
        self.masses = Sums(line.loop.mass, line, self.boundaries)

    def of(self, line: Line) -> Frame:
        """The same loop of a line whose rolls drag otherwise."""
        made = copy(self)
        made.line = line
        return made

    def scaled(self, change: Callable[[Force], Force]) -> Frame:
        """The same loop with its forces at single places changed; a pulley's wrap and bearings alike."""
        made = copy(self)
        made.points = tuple(map(change, self.points))
        units = (replace(next(bend.forces(0.0, 0.0, self.line.gravity)), newtons=1.0) for bend in self.bends)
        made.bends = tuple(
            bend.times(change(unit).total) for bend, unit in zip(self.bends, units, strict=True)
        )
        return made

    def motor(self, force: float) -> float:
        """Power at the motors' shafts for a force at the belt, negative when the belt drives them [W]."""
        belt = belt_power(force, belt_speed=self.line.speed)
        return motor_power(belt, efficiency=self.line.efficiency if force >= 0.0 else self.line.regeneration)

    def mains(self, force: float) -> float:
        """Power from the mains for a force at the belt, negative when it is fed back [W]."""
        return motor_power(self.motor(force), efficiency=self.line.mains_efficiency)
