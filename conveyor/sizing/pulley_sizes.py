"""Pulleys and shafts of a design, from the series of its units."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from conveyor.laws.belt_strength import (
    CEMA_PULLEYS,
    PULLEY_DIAMETERS,
    Group,
    next_pulley_diameter,
    pulley_group_diameter,
)
from conveyor.laws.preliminary_sizing import PULLEY_MASS
from conveyor.laws.pulley import CEMA_SHAFTS, SHAFT_DIAMETERS, next_shaft_diameter
from conveyor.sizing.design_choice import CarcassClass, WidthSize

_FACE_ALLOWANCE: Final = 0.1  # [m], ISO 1536 has more for wide belts; general knowledge, 0.1 to 0.2
_FACE_ALLOWANCE_US: Final = 2.0 * 0.0254  # [m], CEMA drums, 3 in for wide belts; general knowledge
_SHAFT_INSETS: Final = (0.075, 0.175)
_SHAFT_INSETS_US: Final = (3.0 * 0.0254, 7.0 * 0.0254)
"""Hubs inside the ends of a pulley's shell, and bearings outside of them [m]; general knowledge."""
_PULLEY_OVER_SHAFT: Final = 2.0  # [-], room for the hubs and what clamps them; general knowledge


@dataclass(frozen=True)
class PulleySizes:
    """Sizes of pulleys and shafts to choose from.

    Attributes
    ----------
    us : bool
        Whether the series are CEMA's.
    falls : bool
        Whether the belt falls: its highest tension may then be at tail and take-up pulleys.
    asked_allowance : float or None
        Face beyond the belt's width by the rules [m]; usual without.
    """

    us: bool
    falls: bool
    asked_allowance: float | None = None

    @property
    def series(self) -> tuple[float, ...]:
        """Diameters of the series [m]."""
        return tuple(CEMA_PULLEYS if self.us else PULLEY_DIAMETERS)

    @property
    def face_allowance(self) -> float:
        """Face of a pulley beyond the belt's width, at least [m]; general knowledge without a rule."""
        if self.asked_allowance is not None:
            return self.asked_allowance
        return _FACE_ALLOWANCE_US if self.us else _FACE_ALLOWANCE

    def drive_diameter(self, carcass: CarcassClass) -> float:
        """Diameter of a drive pulley [m]: the next of the series; beyond it the carcass's least."""
        return self._pulley_diameter(carcass.least_pulley)

    @property
    def bend_group(self) -> Group:
        """Group of tail and take-up pulleys."""
        return "A" if self.falls else "B"

    def bend_diameter(self, carcass: CarcassClass) -> float:
        """Diameter of tail, take-up and bend pulleys [m], likewise."""
        return self._pulley_diameter(pulley_group_diameter(carcass.least_pulley, group=self.bend_group))

    def _pulley_diameter(self, least: float) -> float:
        return next_pulley_diameter(least, series=self.series) if least <= self.series[-1] else least

    def pulley_around(self, shaft: float) -> float:
        """Diameter of the least pulley of the series that has room for a shaft [m]."""
        return self._pulley_diameter(_PULLEY_OVER_SHAFT * shaft)

    def shaft_diameter(self, least: float) -> float:
        """Diameter of the next shaft of the series [m]."""
        return next_shaft_diameter(least, series=CEMA_SHAFTS if self.us else SHAFT_DIAMETERS)

    def shaft_distances(self, width: WidthSize) -> tuple[float, float]:
        """Usual distances of a pulley's bearings and hubs [m]; its shell is as long as the flat roll of the width."""
        inside, outside = _SHAFT_INSETS_US if self.us else _SHAFT_INSETS
        return width.one + 2.0 * outside, width.one - 2.0 * inside

    def pulley_mass(self, carcass: CarcassClass, width: float) -> float:
        """Mass of all pulleys together [kg]: head, take-up with its two bends, and tail."""
        sizes = (self.drive_diameter(carcass), *(4 * (self.bend_diameter(carcass),)))
        return math.fsum(PULLEY_MASS * size**2 * width for size in sizes)
