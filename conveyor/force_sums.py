"""A resistance of the belt, and the sums of a list of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from conveyor.line.loop_positions import LoopPosition
from conveyor.line.stretches import STRANDS, Strand

Array = NDArray[np.float64]
ForceKind = Literal["main", "secondary", "special", "lift"]


@dataclass(frozen=True, eq=False)
class Force:
    """A resistance to the belt's motion [N].

    Attributes
    ----------
    key, name : str
        Key in files and in Python; name in reports.
    kind : {"main", "secondary", "special", "lift"}
        Group of DIN 22101.
    newtons : ndarray or float
        Force of every stretch, shape (2n,), or one number at a single place.
    source : str
        Source of its law.
    certain : bool
        True if not by friction, so that no uncertainty of friction changes it.
    spot, place : LoopPosition or None, str
        Position in the loop, and in words; None and empty for forces along the belt.
    reach : float
        Length from its spot in running direction over which it acts evenly [m]; 0 at a single place.
    short : str
        Name of its column in tables of sections; `name` without it.
    assumed : bool
        True for a usual part that the spec does not give.
    bulk : int or None
        Number of the section whose bulk causes it; None without bulk, and along the belt.
    at_sag_limit : ndarray or None, shape (2n,)
        Flexure at the largest sag [N], of which the tension that stands there leaves `newtons`; None if independent.
    only_on : {"carry", "return"} or None
        The strand of a force that the other one never has; its name says it. None for both.
    """

    key: str
    name: str
    kind: ForceKind
    newtons: Array | float
    source: str
    certain: bool = False
    spot: LoopPosition | None = None
    place: str = ""
    reach: float = 0.0
    short: str = ""
    assumed: bool = False
    bulk: int | None = None
    at_sag_limit: Array | None = None
    only_on: Strand | None = None

    @property
    def total(self) -> float:
        """Total force [N]."""
        return self.newtons if isinstance(self.newtons, float) else math.fsum(self.newtons.tolist())

    @property
    def along(self) -> Array | None:
        """Force on every stretch [N], shape (2n,); None at one place."""
        return None if isinstance(self.newtons, float) else self.newtons

    def by_strand(self) -> dict[Strand, float]:
        """Force on each strand [N]; empty for a force at one place."""
        if isinstance(self.newtons, float):
            return {}
        halves = np.split(self.newtons, 2)
        return {strand: math.fsum(half.tolist()) for strand, half in zip(STRANDS, halves, strict=True)}


@dataclass(frozen=True)
class ForceSums:
    """Resistances of the whole conveyor [N]: main resistances by key, the others by kind."""

    parts: Mapping[str, float]

    @classmethod
    def of(cls, forces: Iterable[Force]) -> ForceSums:
        """Sum up the list."""
        sums: dict[str, list[float]] = {}
        for force in forces:
            sums.setdefault(force.key if force.kind == "main" else force.kind, []).append(force.total)
        order = [*(key for key in sums if key not in _AFTER_MAIN), *_AFTER_MAIN]
        return cls({key: math.fsum(sums.get(key, ())) for key in order})

    @property
    def indentation(self) -> float:
        """Indentation resistance of the covers [N]; 0 by a method that does not know it."""
        return self.parts.get("indentation", 0.0)

    @property
    def main(self) -> float:
        """Main resistance F_H: indentation, idler rotation, flexure, misalignment, or as the method has it [N]."""
        return math.fsum(value for key, value in self.parts.items() if key not in _AFTER_MAIN)

    @property
    def secondary(self) -> float:
        """Secondary resistances F_N [N]."""
        return self.parts["secondary"]

    @property
    def special(self) -> float:
        """Special resistances F_S [N]."""
        return self.parts["special"]

    @property
    def lift(self) -> float:
        """Slope resistance F_St [N]."""
        return self.parts["lift"]

    @property
    def total(self) -> float:
        """Effective tension F_U [N]."""
        return self.main + self.secondary + self.special + self.lift


_AFTER_MAIN = ("secondary", "special", "lift")


def force_label(key: str) -> str:
    """Return the name of a part of the forces or of a kind of theirs; the lift alone is a height.

    Examples
    --------
    >>> force_label("idler_rotation"), force_label("lift")
    ('idler rotation', 'lift force')
    """
    return "lift force" if key == "lift" else key.replace("_", " ")
