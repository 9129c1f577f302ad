"""Misaligned idler sets: drag of rolls whose axes are not square to the belt, averaged over a conveyor.

No set is exactly square. A roll turned by ε pushes the belt across its running direction; the part of that
friction along the belt, μ(ε) sin ε, is lost at every set, whichever way it is turned.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.laws.horizontal_curve import FULL_SLIP_TILT
from conveyor.laws.resistance.resistance_defaults import ROLL_ON_BELT_FRICTION, Default, Site


def _angle_default(value: float, low: float, high: float, source: str) -> Default:
    return Default(math.radians(value), math.radians(low), math.radians(high), source, True)


MISALIGNMENT: Final[dict[Site, Default]] = {
    "overland": _angle_default(0.1, 0.05, 0.38, "aligned by laser; high: CEMA 7, precise alignment procedures"),
    "plant": _angle_default(0.5, 0.38, 0.75, "CEMA 7, installed without measurement; precise, imprecise footings"),
    "poor": _angle_default(1.0, 0.75, 1.5, "CEMA 7, between imprecise footings and roof hung"),
}
"""Standard deviation of the angles of the sets' axes from square to the belt [rad], by site.

CEMA 7 recommends installation tolerances of 0.375, 0.50, 0.75 and 1.50 in (precise procedures, no measurement,
imprecise footings, moveable or roof hung; read in the help of Belt Analyst). On a frame 57 in long, of a belt 48 in
wide (general knowledge), these are 0.38, 0.50, 0.75 and 1.51 deg.
"""

LARGEST_MISALIGNMENT: Final = math.radians(5.0)
"""Largest allowed input: beyond it a belt runs off [rad]."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_TAIL: Final = 9.0  # standard deviations; beyond lies 1e-19 of a normal distribution


def misalignment_friction(
    misalignment: float,
    *,
    friction: float = ROLL_ON_BELT_FRICTION.value,
    full_slip: float = FULL_SLIP_TILT.value,
) -> float:
    """Mean drag over normal force of rolls with normally distributed skew, E[μ(ε) sin ε] (derived).

    Parameters
    ----------
    misalignment : float
        Standard deviation σ of ε, the angle of the axes from square to the belt [rad], from 0 to 5 deg.
    friction : float
        μ of belt on roll [-], at least 0.
    full_slip : float
        ε_s from which the whole contact slides [rad], positive.

    Returns
    -------
    float
        Force along the belt over the normal force [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    μ(ε) is that of `guide_friction`, the brush model of a rolling contact. For small σ the mean is 3 μ σ²/ε_s: half
    the misalignment, a quarter of the drag. Alignment that is not normally distributed but has the same standard
    deviation differs by terms of σ³.

    Examples
    --------
    >>> [round(misalignment_friction(math.radians(a), friction=0.35), 5) for a in (0.1, 0.5, 1.0)]
    [6e-05, 0.00116, 0.00354]
    """
    require(0.0 <= misalignment <= LARGEST_MISALIGNMENT, "misalignment", misalignment, ">= 0 and <= 5 deg")
    require_not_negative(friction=friction)
    require_positive(full_slip=full_slip)
    if misalignment == 0.0:
        return 0.0
    end, mean = _TAIL * misalignment, 0.0
    edge = min(full_slip, end)
    for low, high in ((0.0, edge), (edge, end)):
        # two panels: μ(ε) has a corner in its third derivative where the contact slides altogether
        tilt = 0.5 * (low + high) + 0.5 * (high - low) * _NODES
        sliding = 1.0 - np.clip(1.0 - tilt / full_slip, 0.0, None) ** 3
        density = math.sqrt(2.0 / math.pi) / misalignment * np.exp(-0.5 * (tilt / misalignment) ** 2)
        mean += 0.5 * (high - low) * float(_WEIGHTS @ (friction * sliding * np.sin(tilt) * density))
    return mean
