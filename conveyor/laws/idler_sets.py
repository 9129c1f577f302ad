"""Idler sets: rated load by class, load of a raised set, belt flap between sets.

Sources: CEMA 502 (ratings of classes B, C and D as reproduced in "Calculating L10 Idler Life", scribd 483814341; E
general knowledge); lumps by Sandvik, Selection and load rating of the idlers for belt conveyors (12/99, scribd
424696958); the rest is statics and the string that moves along itself (derived).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, Literal, get_args

from conveyor.arguments.limits import require, require_angle, require_not_negative, require_positive
from conveyor.errors import MessageQuantity, RangeError

CemaClass = Literal["B", "C", "D", "E"]
CEMA_CLASSES: Final[tuple[CemaClass, ...]] = get_args(CemaClass)
_POUND_FORCE: Final = 4.4482216152605  # [N]
_INCH: Final = 0.0254  # [m]
_FLAT, _VEE, _TROUGH = 1, 2, 3  # rolls of a set
_TROUGHS: Final = (20.0, 35.0, 45.0)  # [deg]
# CEMA 502, widths [in], [lbf]: three equal rolls at 20, 35 and 45 deg, one return roll; 0 where the class has none
_RATINGS: Final[Mapping[CemaClass, Mapping[int, tuple[int, int, int, int]]]] = {
    "B": {
        18: (410, 410, 410, 220), 24: (410, 410, 410, 190), 30: (410, 410, 410, 165), 36: (410, 410, 396, 155),
        42: (390, 363, 351, 140), 48: (380, 353, 342, 125),
    },
    "C": {
        18: (900, 900, 900, 475), 24: (900, 900, 900, 325), 30: (900, 900, 900, 250), 36: (900, 837, 810, 200),
        42: (850, 791, 765, 150), 48: (800, 744, 720, 125), 54: (750, 698, 675, 0), 60: (700, 650, 630, 0),
    },
    "D": {
        24: (1200, 1200, 1200, 600), 30: (1200, 1200, 1200, 600), 36: (1200, 1200, 1200, 600),
        42: (1200, 1200, 1200, 500), 48: (1200, 1200, 1200, 425), 54: (1200, 1116, 1080, 375),
        60: (1150, 1070, 1035, 280),
    },
    "E": {
        36: (1800, 1800, 1800, 1000), 42: (1800, 1800, 1800, 1000), 48: (1800, 1800, 1800, 1000),
        54: (1800, 1800, 1800, 925), 60: (1800, 1800, 1800, 850), 72: (1800, 1800, 1800, 700),
        84: (1800, 1674, 1620, 575), 96: (1750, 1628, 1575, 425),
    },
}  # fmt: skip
_VEE_RATINGS: Final[Mapping[CemaClass, tuple[int, int, int]]] = {
    "C": (30, 66, 500), "D": (36, 60, 850), "E": (36, 96, 1300),
}  # fmt: skip
"""Two rolls in a V: narrowest and widest belt [in], [lbf]."""
# Sandvik 12/99, table 2: factor c [-] up to these sizes of lumps [m], at these densities [kg/m³]
_LUMP_DENSITIES: Final = (800.0, 1200.0, 1600.0, 2000.0, 2400.0, 2800.0, 3200.0)
_LUMP_FACTORS: Final[Mapping[float, tuple[float, ...]]] = {
    0.100: (1.0, 1.0, 1.0, 1.0, 1.1, 1.1, 1.1), 0.150: (1.0, 1.0, 1.0, 1.1, 1.1, 1.1, 1.1),
    0.200: (1.0, 1.0, 1.1, 1.1, 1.1, 1.2, 1.2), 0.300: (1.0, 1.1, 1.1, 1.2, 1.2, 1.2, 1.3),
    0.400: (1.1, 1.1, 1.1, 1.2, 1.2, 1.3, 1.3), 0.500: (1.1, 1.1, 1.2, 1.2, 1.3, 1.3, 1.4),
}  # fmt: skip
_WIDTH_SLACK: Final = 0.06
"""Share by which a width may exceed that of its column: 1000 mm in 42 in, 1200 mm in 48 in; derived [-]."""
FLAP_MODES: Final = 2
"""Natural frequencies of a span excited by rolls out of round [-]; general knowledge."""


def raised_set_load(tension: float, *, height: float, spacing: float) -> float:
    """Load of the belt's tension on a set raised above its neighbours, 2 T h/a (CEMA: IML).

    Parameters
    ----------
    tension : float
        T of the belt [N], at least 0.
    height : float
        h over the neighbours [m], at least 0.
    spacing : float
        a of the sets [m], positive.

    Returns
    -------
    float
        Load [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Statics of a string, h much less than a: CEMA's D T/(6 S_i) with D in inches and S_i in feet is the same.

    Examples
    --------
    >>> raised_set_load(60e3, height=0.006, spacing=1.2)
    600.0
    """
    require_not_negative(tension=tension, height=height)
    require_positive(spacing=spacing)
    return 2.0 * tension * height / spacing


def rated_set_load(cema_class: CemaClass, *, belt_width: float, trough_angle: float, rolls: int) -> float:
    """Rated load of an idler set of a CEMA class (CEMA 502; class E general knowledge).

    Parameters
    ----------
    cema_class : {"B", "C", "D", "E"}
        Of the set [-].
    belt_width : float
        B [m], positive.
    trough_angle : float
        Of the wing rolls [rad], from 0 to below pi/2; a flat set of three rolls has the rating at 20 deg.
    rolls : int
        Of equal length [-]; there are ratings for 1, 2 and 3.

    Returns
    -------
    float
        Rating of the whole set [N].

    Raises
    ------
    InputError
        An argument is outside its range.
    RangeError
        The class has no such set.

    Notes
    -----
    L10 of 30,000 h (B, C) and 60,000 h (D, E) at 500 rpm, 70 % of the load on the middle roll. A width counts to the
    next column, an angle likewise (derived); 6 % of a width are let pass for metric belts.

    Examples
    --------
    >>> [round(rated_set_load("C", belt_width=0.914, trough_angle=math.radians(a), rolls=3)) for a in (20, 35, 45)]
    [4003, 3723, 3603]
    >>> round(rated_set_load("D", belt_width=1.2, trough_angle=0.0, rolls=1))
    1890
    """
    require_positive(belt_width=belt_width)
    require_angle(0.0, trough_angle=trough_angle)
    require(cema_class in _RATINGS, "cema_class", cema_class, ", ".join(CEMA_CLASSES))
    inches = belt_width / _INCH
    width = MessageQuantity(belt_width, "thickness", f"{belt_width:g} m")
    none = RangeError(f"CEMA class {cema_class} has no set of {rolls} roll(s) for a belt of {{}}", width)
    if rolls == _VEE:
        narrowest, widest, rating = _VEE_RATINGS.get(cema_class, (0, 0, 0))
        if not narrowest * (1.0 - _WIDTH_SLACK) <= inches <= widest * (1.0 + _WIDTH_SLACK):
            raise none
        return rating * _POUND_FORCE
    if rolls not in {_FLAT, _TROUGH}:
        raise none
    table = _RATINGS[cema_class]
    column = next((width for width in table if inches <= width * (1.0 + _WIDTH_SLACK)), None)
    if column is None or inches < min(table) * (1.0 - _WIDTH_SLACK):
        raise none
    degrees = round(math.degrees(trough_angle), 9)
    steps = [i for i, angle in enumerate(_TROUGHS) if degrees <= angle]
    if rolls == _TROUGH and not steps:
        raise RangeError(f"CEMA rates troughs of up to {_TROUGHS[-1]:g} deg, not {degrees:g} deg")
    rating = table[column][-1 if rolls == _FLAT else steps[0]]
    if rating == 0:
        raise none
    return rating * _POUND_FORCE


def lump_load_factor(lump: float, *, density: float) -> float:
    """Factor c of a set's load under lumps over the steady one (Sandvik 12/99, table 2).

    Parameters
    ----------
    lump : float
        Largest size of the bulk [m], at least 0.
    density : float
        Of the bulk [kg/m³], positive.

    Returns
    -------
    float
        c [-].

    Raises
    ------
    InputError
        An argument is outside its range.
    RangeError
        The table ends at lumps of 500 mm and 3200 kg/m³.

    Notes
    -----
    Of the middle roll there, belt included. Between two columns or rows the next one counts (derived).

    Examples
    --------
    >>> [lump_load_factor(0.25, density=density) for density in (850.0, 1700.0, 3000.0)]
    [1.1, 1.2, 1.3]
    """
    require_not_negative(lump=lump)
    require_positive(density=density)
    # the edge of a column in inches or pounds is that edge: to the nanometre, to the milligram
    size, heaviness = round(lump, 9), round(density, 6)
    for largest, factors in _LUMP_FACTORS.items():
        for most, factor in zip(_LUMP_DENSITIES, factors, strict=True):
            if size <= largest and heaviness <= most:
                return factor
    raise RangeError(
        f"factors are printed up to lumps of 500 mm and 3200 kg/m³, not {1e3 * lump:g} mm and {density:g} kg/m³"
    )


def flap_frequency(tension: float, *, line_mass: float, spacing: float, belt_speed: float, mode: int = 1) -> float:
    """Natural frequency of the belt between two sets, n (c² - v²)/(2 a c) with c = sqrt(T/m').

    Parameters
    ----------
    tension : float
        T of the belt [N], more than m' v².
    line_mass : float
        m' of belt and bulk [kg/m], positive.
    spacing : float
        a of the sets [m], positive.
    belt_speed : float
        v [m/s], at least 0.
    mode : int
        n, half waves in the span [-], at least 1.

    Returns
    -------
    float
        f [Hz].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Of a string that moves along itself: waves run at c + v and c - v, once there and back takes a/(c + v) + a/(c - v)
    (derived). The stiffness of the trough raises it, bulk that does not follow the belt too: both left out.

    Examples
    --------
    >>> round(flap_frequency(40e3, line_mass=16.0, spacing=3.0, belt_speed=0.0), 3)  # sqrt(T/m')/(2 a)
    8.333
    >>> round(flap_frequency(40e3, line_mass=16.0, spacing=3.0, belt_speed=5.0), 3)
    8.25
    """
    require_positive(line_mass=line_mass, spacing=spacing)
    require_not_negative(belt_speed=belt_speed)
    require(mode >= 1, "mode", mode, ">= 1")
    least = line_mass * belt_speed**2
    require(least < tension < math.inf, "tension", tension, f"> m' v² = {least:.6g} N")
    wave = math.sqrt(tension / line_mass)
    return mode * (wave**2 - belt_speed**2) / (2.0 * spacing * wave)


def resonance_margin(roll_frequency: float, *, lowest: float, highest: float) -> float:
    """Relative distance of the first natural frequencies of the spans from a roll's rotation.

    Parameters
    ----------
    roll_frequency : float
        f_r, revolutions [1/s], positive.
    lowest : float
        First natural frequency of the belt where its tension is lowest [Hz], at least 0.
    highest : float
        The same where it is highest [Hz], at least `lowest`.

    Returns
    -------
    float
        Least of abs(f/f_r - 1) over the first two modes of all spans between [-]; 0 where one of them is hit.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> (
    ...     resonance_margin(10.0, lowest=15.0, highest=17.0),
    ...     resonance_margin(10.0, lowest=8.0, highest=11.0),
    ... )
    (0.5, 0.0)
    """
    require_positive(roll_frequency=roll_frequency)
    require_not_negative(lowest=lowest)
    require(lowest <= highest < math.inf, "highest", highest, f">= lowest = {lowest!r} Hz")
    over = [(n * lowest / roll_frequency - 1.0, 1.0 - n * highest / roll_frequency) for n in range(1, FLAP_MODES + 1)]
    return max(0.0, min(max(pair) for pair in over))


def resonance_free_spacing(roll_frequency: float, *, lowest: float, spacing: float, margin: float) -> float:
    """Widest spacing with every natural frequency above the rolls' rotation by a margin, a f/(f_r (1 + m)).

    Parameters
    ----------
    roll_frequency : float
        f_r, revolutions of the smallest roll [1/s], positive.
    lowest : float
        f, first natural frequency at the present spacing where the tension is lowest [Hz], at least 0.
    spacing : float
        a, present one [m], positive.
    margin : float
        m, wanted distance [-], at least 0.

    Returns
    -------
    float
        Spacing [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The tension is held. With rolls larger by the same factor the present spacing does.

    Examples
    --------
    >>> round(resonance_free_spacing(10.0, lowest=6.0, spacing=3.0, margin=0.2), 3)
    1.5
    """
    require_positive(roll_frequency=roll_frequency, spacing=spacing)
    require_not_negative(lowest=lowest, margin=margin)
    return spacing * lowest / (roll_frequency * (1.0 + margin))
