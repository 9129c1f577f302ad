"""Loads of the six rolls of a pipe conveyor's panel: statics of a ring, derived; the forming load is given.

The belt's own stiffness presses it against all six rolls; that forming load has no law here, it is asked for.
"""

from __future__ import annotations

import math
from typing import Final

from conveyor.arguments.limits import (
    require,
    require_angle,
    require_finite,
    require_not_negative,
    require_positive,
)
from conveyor.laws.loading.roll_loading import RollLoad

__all__ = ["PIPE_ROLLS", "pipe_area", "pipe_roll_loads"]

PIPE_ROLLS: Final = ("upper left", "lower left", "bottom", "lower right", "upper right", "top")
"""Places of the rolls of a panel: 60 deg apart, one below."""
_APART: Final = math.pi / 3.0  # angle between neighbours [rad]
_BELT_BELOW: Final = 1.0 / 6.0
"""Share of the ring's weight that stands on the bottom roll [-]."""
_BULK_BELOW: Final = 4.0 / math.pi * (_APART / 4.0 + math.sin(_APART) ** 2 / (4.0 * _APART))
"""The same of bulk in vertical columns 2 R cos θ of a full pipe, (4/π) ∫ cos²θ (1 - 3 θ/π) dθ up to 60 deg [-]."""


def pipe_area(diameter: float, *, filling: float = 1.0) -> float:
    """Cross-section of the bulk in a pipe, φ π D²/4.

    Parameters
    ----------
    diameter : float
        D inside the belt [m], positive.
    filling : float
        φ, from 0 to 1 [-].

    Returns
    -------
    float
        Area [m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(pipe_area(0.4, filling=0.75), 4)
    0.0942
    """
    require_positive(diameter=diameter)
    require(0.0 <= filling <= 1.0, "filling", filling, ">= 0 and <= 1")
    return filling * math.pi * diameter**2 / 4.0


def pipe_roll_loads(
    *,
    bulk_line_mass: float,
    belt_line_mass: float,
    spacing: float,
    diameter: float,
    roll_length: float,
    forming_load: float,
    inclination: float,
    gravity: float,
    curve_down: float = 0.0,
    curve_right: float = 0.0,
) -> tuple[RollLoad, ...]:
    """Load of each of the six rolls of a panel: weights, forming load, tension in curves (statics, derived).

    Parameters
    ----------
    bulk_line_mass, belt_line_mass : float
        m' of bulk and belt [kg/m], at least 0.
    spacing : float
        Of the panels [m], positive.
    diameter : float
        D of the pipe [m], positive.
    roll_length : float
        Of each roll [m], positive.
    forming_load : float
        What the belt, which would open, presses on each roll [N], at least 0.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.
    curve_down, curve_right : float
        Forces of the belt's tension on one panel of a vertical and a horizontal curve [N], negative upward and to the
        left, see `curve_set_force`.

    Returns
    -------
    tuple of RollLoad
        By `PIPE_ROLLS`. The parts of the forces across the slope add up to (m'_bulk + m'_belt) g cos δ a + F_down,
        those to the right to F_right.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A weight at θ from below stands on the bottom roll by 1 - θ/60 deg, the rest on the lower one beside it, beyond
    60 deg all of it. Less filling moves bulk to the middle, which is left out. Without friction a roll pushes toward
    the middle of the pipe. A weight v on a lower roll, 60 deg from below, needs
    v/cos 60 deg = 2 v; the two push inward on each other through the ring. The forming load is the same on
    all rolls, so that it holds itself. Each roll bears over a sixth of the pipe's circumference, evenly.

    Tension spread evenly round the pipe pulls strip by strip in the plane of the curve, as weight does. Down and up
    it adds to the belt's weight; if the sum lifts, it lies on the three upper rolls in the same way, the bulk stays on
    the lower ones. To a side it lies on the two rolls there, F/(2 cos 30 deg) on each. No pull relieves a roll of its
    forming load: the safe side.

    Examples
    --------
    >>> loads = pipe_roll_loads(
    ...     bulk_line_mass=50.0,
    ...     belt_line_mass=20.0,
    ...     spacing=1.2,
    ...     diameter=0.4,
    ...     roll_length=0.25,
    ...     forming_load=100.0,
    ...     inclination=0.0,
    ...     gravity=9.81,
    ... )
    >>> [round(load.force) for load in loads]
    [100, 554, 470, 554, 100, 100]
    """
    require_not_negative(bulk_line_mass=bulk_line_mass, belt_line_mass=belt_line_mass, forming_load=forming_load)
    require_positive(spacing=spacing, diameter=diameter, roll_length=roll_length, gravity=gravity)
    require_angle(-math.pi / 2.0, inclination=inclination)
    require_finite(curve_down=curve_down, curve_right=curve_right)
    pull = gravity * math.cos(inclination) * spacing
    length = min(roll_length, math.pi * diameter / 6.0)
    bulk = _loads_about(bulk_line_mass * pull, _BULK_BELOW)
    belt = _loads_about(belt_line_mass * pull + curve_down, _BELT_BELOW)
    side = abs(curve_right) / (2.0 * math.cos(0.5 * _APART))
    inside = "right" if curve_right > 0.0 else "left"
    return tuple(
        RollLoad(
            name=name,
            bulk_force=bulk[name],
            belt_force=belt[name] + (side if name.endswith(inside) else 0.0) + forming_load,
            length=length,
            shape="uniform",
        )
        for name in PIPE_ROLLS
    )


def _loads_about(force: float, share: float) -> dict[str, float]:
    """Loads of a force down, or up if negative, by its share on the middle one of three rolls [N]."""
    middle, beside = ("bottom", "lower") if force >= 0.0 else ("top", "upper")
    size = abs(force)

    def borne(name: str) -> float:
        if name == middle:
            return share * size
        return (1.0 - share) * size if name.startswith(beside) else 0.0  # half of the rest, over cos 60 deg

    return {name: borne(name) for name in PIPE_ROLLS}
