"""Friction of a belt that slides on a plate instead of running on idler sets.

Coulomb friction, F = μ m' g cos δ L: the form of light conveyors (Van der Graaf, TM 39: belt and load times the
coefficient of friction of belt and bed). Coefficients are those that makers print, dry and clean.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, Literal

from conveyor.arguments.limits import require_not_negative, require_positive
from conveyor.laws.resistance.resistance_defaults import Default

BedSurface = Literal["steel", "aluminium", "UHMW-PE", "hardwood"]
Underside = Literal["rubber cover", "friction surface", "bare fabric"]

_BELTS: Final = "Beltservice Corporation, catalogue, page 50: belt on slider bed of steel or aluminium"
_LINING: Final = "Crown Plastics, bulletin of April 2017: 49 % below 0.557 on galvanised steel, silicone treated"
_ON_METAL: Final[Mapping[Underside, Default]] = {
    "rubber cover": Default(0.525, 0.50, 0.557, f"{_BELTS}, cover on it 0.50 to 0.55; Crown Plastics 0.557"),
    "friction surface": Default(0.325, 0.30, 0.35, f"{_BELTS}, friction surface 0.30 to 0.35"),
    "bare fabric": Default(0.225, 0.20, 0.25, f"{_BELTS}, bare or brushed duck 0.20 to 0.25"),
}
BED_FRICTION: Final[Mapping[tuple[BedSurface, Underside], Default]] = {
    **{("steel", underside): friction for underside, friction in _ON_METAL.items()},
    **{("aluminium", underside): friction for underside, friction in _ON_METAL.items()},
    ("UHMW-PE", "rubber cover"): Default(0.284, 0.284, 0.557, f"{_LINING}; up to that of steel where it is not"),
}
"""Friction of belt on plate [-] by surface and underside, as makers print it; of hardwood it is asked for."""


def slider_bed_resistance(
    line_mass: float, *, friction: float, length: float, inclination: float, gravity: float
) -> float:
    """Resistance of a belt that slides on a plate, F = μ m' g cos δ L (Coulomb).

    Parameters
    ----------
    line_mass : float
        m', of belt and bulk [kg/m], at least 0.
    friction : float
        μ of belt on plate [-], at least 0; as printed by makers `BED_FRICTION`.
    length : float
        L, of the plate along the belt [m], above 0.
    inclination : float
        δ, slope [rad].
    gravity : float
        g [m/s²], above 0.

    Returns
    -------
    float
        F [N], against the motion whatever the slope.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A troughed plate bears as a level one: that the wings wedge the bulk, and that the bulk's own friction relieves
    them, is left out. Tension presses on no straight plate. Wet and dirty plates are not in makers' figures.

    Examples
    --------
    >>> round(slider_bed_resistance(60.0, friction=0.325, length=10.0, inclination=0.0, gravity=9.81), 2)
    1912.95
    """
    require_not_negative(line_mass=line_mass, friction=friction)
    require_positive(length=length, gravity=gravity)
    return friction * line_mass * gravity * math.cos(inclination) * length
