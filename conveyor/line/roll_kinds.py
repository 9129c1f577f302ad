"""Groups of rolls that share a contact: one radius and spacing on one strand, with all their line loads."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.loading import line_loads
from conveyor.line.stretches import Strand, Stretch

Array = NDArray[np.float64]

_LOWEST_LOAD_SHARE = 0.25  # of the highest load: a curve worth plotting where all rolls bear the same


@dataclass(frozen=True, eq=False)
class RollKind:
    """Rolls of one radius [m] and spacing [m] on one strand: all their line loads [N/m] in one array.

    Attributes
    ----------
    rolls : tuple of (int, int)
        Stretch and place in the set, for each roll.
    starts : ndarray of int
        Index of each roll's first load in `line_loads`, which equals `distinct[which]`.
    weights, sets : ndarray
        Weights of the quadrature along the roll [m]; number of such sets [-].
    lowest, highest : float
        Range of the load curve [N/m].
    """

    strand: Strand
    radius: float
    spacing: float
    rolls: tuple[tuple[int, int], ...]
    starts: NDArray[np.int_]
    line_loads: Array
    distinct: Array
    which: NDArray[np.intp]
    weights: Array
    sets: Array
    lowest: float
    highest: float

    @cached_property
    def bearing(self) -> tuple[object, ...]:
        """Key equal for rolls that load a cover identically."""
        arrays = (self.line_loads, self.weights, self.sets)
        return self.strand, self.radius, self.spacing, *(one.tobytes() for one in arrays)


def roll_kinds(stretches: tuple[Stretch, ...], points: int, first: int) -> tuple[RollKind, ...]:
    """Group the loaded rolls of a strand by contact; `points` of the quadrature along a roll.

    Their stretches are numbered from `first` on.
    """
    gathered: dict[tuple[Strand, float, float], list[tuple[int, int]]] = {}
    for i, stretch in enumerate(stretches):
        for place, (radius, load) in enumerate(zip(stretch.radii, stretch.loads, strict=True)):
            if load.force == 0.0:
                continue  # the belt does not touch it
            gathered.setdefault((stretch.strand, radius, stretch.spacing), []).append((i, place))
    kinds = []
    for (strand, radius, spacing), rolls in gathered.items():
        loads = [stretches[i].loads[place] for i, place in rolls]
        sampled, weights = line_loads(loads, points)
        lines = sampled.ravel()
        distinct, which = np.unique(lines, return_inverse=True)
        highest = max(float(lines.max()), *(load.peak_line_load for load in loads))
        kinds.append(
            RollKind(
                strand=strand,
                radius=radius,
                spacing=spacing,
                rolls=tuple((first + i, place) for i, place in rolls),
                starts=np.arange(0, lines.size, points),
                line_loads=lines,
                distinct=distinct,
                which=which,
                weights=weights.ravel(),
                sets=np.repeat([stretches[i].sets for i, _ in rolls], points),
                lowest=min(float(lines.min()), _LOWEST_LOAD_SHARE * highest),
                highest=highest,
            )
        )
    return tuple(kinds)
