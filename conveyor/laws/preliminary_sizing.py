"""First choices of a conveyor: width for lumps, edge distance, cover against wear, masses of parts, annuities.

Sources: CEMA, Belt Conveyors for Bulk Materials, 5th ed., as commonly reproduced (lumps, edge distance, speeds);
DIN 22101 (wear of the carrying cover). General knowledge is marked.
"""

from __future__ import annotations

import math
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require, require_angle, require_not_negative, require_positive

Severity = Literal["low", "medium", "high"]
SEVERITIES: Final[tuple[Severity, ...]] = ("low", "medium", "high")

# CEMA, belt width over the largest lump at 20 and 30 deg surcharge [-]: few lumps among fines, or all lumps
LUMP_RATIOS: Final = {"mixed": (3.0, 6.0), "sized": (5.0, 10.0)}
# CEMA, recommended maximum speeds: belt widths up to [m], speed [ft/min]
RECOMMENDED_SPEEDS: Final = {
    "low": ((0.5, 500), (0.8, 700), (1.1, 800), (math.inf, 1000)),
    "medium": ((0.5, 400), (0.95, 600), (1.6, 800), (math.inf, 1000)),
    "high": ((0.5, 350), (0.95, 500), (math.inf, 600)),
}
FOOT_PER_MINUTE: Final = 0.3048 / 60.0  # [m/s]
FOOT: Final = 0.3048  # [m]
INCH: Final = 0.0254  # [m]
POUND_PER_CUBIC_FOOT: Final = 16.01846  # [kg/m³]
# CEMA, suggested normal spacing of belt idlers: densities of the columns [lb/ft³]; belt widths up to [in], carry
# spacings of the columns, return spacing [ft]
SPACING_DENSITIES: Final = (30, 50, 75, 100, 150, 200)
NORMAL_SPACINGS: Final = (
    (18, 5.5, 5.0, 5.0, 5.0, 4.5, 4.5, 10.0),
    (24, 5.0, 4.5, 4.5, 4.0, 4.0, 4.0, 10.0),
    (30, 5.0, 4.5, 4.5, 4.0, 4.0, 4.0, 10.0),
    (36, 5.0, 4.5, 4.0, 4.0, 3.5, 3.5, 10.0),
    (42, 4.5, 4.5, 4.0, 3.5, 3.0, 3.0, 10.0),
    (48, 4.5, 4.0, 4.0, 3.5, 3.0, 3.0, 10.0),
    (54, 4.5, 4.0, 3.5, 3.5, 3.0, 3.0, 10.0),
    (60, 4.0, 4.0, 3.5, 3.0, 3.0, 3.0, 10.0),
    (72, 4.0, 3.5, 3.5, 3.0, 2.5, 2.5, 8.0),
    (84, 3.5, 3.5, 3.0, 2.5, 2.5, 2.0, 8.0),
    (96, 3.5, 3.5, 3.0, 2.5, 2.0, 2.0, 8.0),
)
LOADING_SPACING_SHARE: Final = 0.5  # [-], sets at a loading point over the others; CEMA, general knowledge
SKIRTBOARD_TIME: Final = 0.6 / 0.5  # [s] from where bulk lands; Martin Engineering, little air: 0.6 m for each 0.5 m/s
ROLL_ROOM_SHARE: Final = (
    0.5  # [-], of the rolls beyond the belt's edges, how much may be missing or more; general knowledge
)
EDGE_SHARE: Final = 0.055  # [-], CEMA: standard edge distance 0.055 B + 0.9 in
EDGE_LEAST: Final = 0.9 * 0.0254  # [m], CEMA
# DIN 22101, sum of points up to -> addition to the least cover [m]; general knowledge, middle of each range
WEAR_ADDITIONS: Final = ((6, 0.5e-3), (8, 2e-3), (11, 4.5e-3), (13, 8e-3), (15, 10e-3))
_ROUND_TIMES: Final = (60.0, 20.0)  # [s] from which the points of frequency are 1 and 2; general knowledge
_WEAR_LUMPS: Final = (0.05, 0.15)  # [m] up to which the points of lumps are 1 and 2; general knowledge
_WEAR_DENSITIES: Final = (
    1000.0,
    2000.0,
)  # [kg/m³] up to which the points of density are 1 and 2; general knowledge
STEEL_DENSITY: Final = 7850.0  # [kg/m³]
CARCASS_RUBBER: Final = 1150.0  # [kg/m³]
CORD_STRESS: Final = (
    1.8e9  # [Pa], breaking strength over metal of the cords; of two listed belts, to 6 % of the carcass
)
TEXTILE_DENSITY: Final = 1500.0  # [kg/m³], carcasses of EP630/4 and EP1250/4 as listed
PULLEY_MASS: Final = 1750.0  # [kg/m³], m = c D² B: pulleys with shaft of 0.5 to 1 m; general knowledge


def least_width_for_lumps(lump: float, *, surcharge_angle: float, share: Literal["mixed", "sized"]) -> float:
    """Least belt width for the largest lump (CEMA).

    Parameters
    ----------
    lump : float
        Largest size of the bulk [m], at least 0.
    surcharge_angle : float
        θ of the moving heap [rad], from 0 to below pi/2.
    share : {"mixed", "sized"}
        Few lumps, up to a tenth, among fines; or all lumps [-].

    Returns
    -------
    float
        B [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    3 and 5 lumps at 20 deg surcharge and less, 6 and 10 at 30 deg and more, straight between.

    Examples
    --------
    >>> round(least_width_for_lumps(0.2, surcharge_angle=math.radians(20), share="mixed"), 3)
    0.6
    """
    require_not_negative(lump=lump)
    require_angle(0.0, surcharge_angle=surcharge_angle)
    require(share in LUMP_RATIOS, "share", share, ", ".join(LUMP_RATIOS))
    flat, steep = LUMP_RATIOS[share]
    along = min(1.0, max(0.0, (math.degrees(surcharge_angle) - 20.0) / 10.0))
    return lump * (flat + along * (steep - flat))


def recommended_speed(belt_width: float, *, abrasiveness: Severity) -> float:
    """Highest speed recommended for a belt (CEMA).

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    abrasiveness : {"low", "medium", "high"}
        Low: grain and the like; medium: coal, soft ores, overburden, fine crushed stone; high: hard, sharp-edged ore,
        coarse crushed stone [-].

    Returns
    -------
    float
        v [m/s].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The table is in inches; a metric width counts to the nearest of its columns (derived). Overland conveyors run
    faster.

    Examples
    --------
    >>> round(recommended_speed(1.2, abrasiveness="medium"), 2)
    4.06
    """
    require_positive(belt_width=belt_width)
    require(
        abrasiveness in RECOMMENDED_SPEEDS,
        "abrasiveness",
        abrasiveness,
        ", ".join(RECOMMENDED_SPEEDS),
    )
    return next(FOOT_PER_MINUTE * fpm for widest, fpm in RECOMMENDED_SPEEDS[abrasiveness] if belt_width <= widest)


def standard_edge_distance(belt_width: float) -> float:
    """Width of belt left free of bulk at each edge, 0.055 B + 0.9 in (CEMA).

    Parameters
    ----------
    belt_width : float
        B [m], positive.

    Returns
    -------
    float
        Distance along the belt [m].

    Raises
    ------
    InputError
        The width is not positive.

    Examples
    --------
    >>> round(standard_edge_distance(1.2), 4)
    0.0889
    """
    require_positive(belt_width=belt_width)
    return EDGE_SHARE * belt_width + EDGE_LEAST


def suitable_roll_lengths(length: float, *, belt_width: float, rolls: int) -> tuple[float, float]:
    """Shortest and longest rolls that do instead of those of a series: the belt still lies on them with its edges.

    The rolls of a set reach n l - B beyond the belt, which runs off centre on them; at least half of that is left, and
    at most as much again is added, as far as frames of the series take it.

    Parameters
    ----------
    length : float
        Of a roll of the series l [m], positive.
    belt_width : float
        B [m], positive, less than the rolls of a set together.
    rolls : int
        Number of rolls of a set n [-], at least 1.

    Returns
    -------
    tuple of float
        Shortest and longest roll [m].

    Raises
    ------
    InputError
        An argument is not positive, or the rolls together are not longer than the belt is wide.

    Notes
    -----
    General knowledge: standards give lengths (ISO 1537), no tolerance of sets made of other ones.

    Examples
    --------
    Three rolls of 315 mm under 800 mm of belt reach 72.5 mm beyond either edge, those of 291 mm half of it.

    >>> [round(long, 4) for long in suitable_roll_lengths(0.315, belt_width=0.8, rolls=3)]
    [0.2908, 0.3392]
    """
    require_positive(length=length, belt_width=belt_width, rolls=rolls)
    room = rolls * length - belt_width
    require(room > 0.0, "length", length, f"> {belt_width / rolls:g}, the belt's width over the number of rolls")
    spare = ROLL_ROOM_SHARE * room / rolls
    return length - spare, length + spare


def normal_spacings(belt_width: float, *, density: float) -> tuple[float, float]:
    """Normal spacings of carry and return sets (CEMA, as commonly reproduced).

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    density : float
        Of the bulk [kg/m³], positive.

    Returns
    -------
    tuple of float
        Of carry and return sets [m].

    Raises
    ------
    InputError
        An argument is not positive.

    Notes
    -----
    Table "Suggested normal spacing of belt idlers". A width counts to the next wider row, a density to the nearest
    column (derived). Sag, load rating and bearing life may ask for less.

    Examples
    --------
    36 in and 100 lb/ft³: 4 ft and 10 ft.

    >>> [round(a, 4) for a in normal_spacings(0.9144, density=1602.0)]
    [1.2192, 3.048]
    """
    require_positive(belt_width=belt_width, density=density)
    columns = [abs(density / POUND_PER_CUBIC_FOOT - column) for column in SPACING_DENSITIES]
    row = next((row for widest, *row in NORMAL_SPACINGS if belt_width / INCH <= widest + 1e-6), NORMAL_SPACINGS[-1][1:])
    return FOOT * row[columns.index(min(columns))], FOOT * row[-1]


def wear_addition(
    *, lump: float, density: float, round_time: float, abrasiveness: Severity, loading: Severity
) -> float:
    """Cover thickness added against wear by the bulk (DIN 22101, by points; general knowledge).

    Parameters
    ----------
    lump : float
        Largest size of the bulk [m], at least 0.
    density : float
        Of the bulk [kg/m³], positive.
    round_time : float
        Time in which the belt goes round once [s], positive: how often it is loaded.
    abrasiveness : {"low", "medium", "high"}
        Of the bulk [-].
    loading : {"low", "medium", "high"}
        Severity of loading: height of fall and difference of speeds [-].

    Returns
    -------
    float
        Middle of the range for the sum of points [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Points 1 to 3 each for loading, its frequency, lumps, density and abrasiveness; the sum of 5 to 15 gives the range.
    Sums and ranges are those of the standard as remembered, the borders of each point general knowledge.

    Examples
    --------
    >>> easy = wear_addition(lump=0.02, density=800.0, round_time=2000.0, abrasiveness="low", loading="low")
    >>> hard = wear_addition(lump=0.3, density=2300.0, round_time=15.0, abrasiveness="high", loading="high")
    >>> easy, hard
    (0.0005, 0.01)
    """
    require_not_negative(lump=lump)
    require_positive(density=density, round_time=round_time)
    for name, word in (("abrasiveness", abrasiveness), ("loading", loading)):
        require(word in SEVERITIES, name, word, ", ".join(SEVERITIES))
    # a border in inches or pounds is that border: to the nanometre, to the milligram
    size, heaviness = round(lump, 9), round(density, 6)
    points = (
        SEVERITIES.index(abrasiveness)
        + SEVERITIES.index(loading)
        + sum(round_time < border for border in _ROUND_TIMES)
        + sum(size > border for border in _WEAR_LUMPS)
        + sum(heaviness > border for border in _WEAR_DENSITIES)
        + 5
    )
    return next(addition for most, addition in WEAR_ADDITIONS if points <= most)


def carcass_mass(strength: float, *, thickness: float, steel_cord: bool) -> float:
    """Usual mass per area of a carcass (derived; fitted to listed belts).

    Parameters
    ----------
    strength : float
        Nominal strength per width [N/m], positive.
    thickness : float
        Diameter of the cords, or thickness of the plies with their rubber [m], positive.
    steel_cord : bool
        Steel cords in rubber [-]; else plies of fabric.

    Returns
    -------
    float
        [kg/m²].

    Raises
    ------
    InputError
        An argument is not positive, or the cords need more steel than the thickness holds.

    Notes
    -----
    Steel of strength/1800 N/mm², rubber between it. Two listed belts: ST2100 15.5 kg/m² (14.7 here, with cords of
    5.85 mm), ST4000 26.4 kg/m² (25.2 here).

    Examples
    --------
    >>> round(carcass_mass(4e6, thickness=9e-3, steel_cord=True), 1)
    25.2
    """
    require_positive(strength=strength, thickness=thickness)
    if not steel_cord:
        return TEXTILE_DENSITY * thickness
    steel = strength / CORD_STRESS
    require(steel < thickness, "thickness", thickness, f"> {steel:.3g} m, the cords' steel")
    return STEEL_DENSITY * steel + CARCASS_RUBBER * (thickness - steel)


def roll_shell_mass(diameter: float, *, wall: float, length: float) -> float:
    """Mass of a roll's tube of steel, π (D - s) s l ρ.

    Parameters
    ----------
    diameter : float
        D, outside [m], more than twice the wall.
    wall : float
        s [m], positive.
    length : float
        l [m], positive.

    Returns
    -------
    float
        [kg].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(roll_shell_mass(0.159, wall=0.0045, length=0.465), 2)
    7.97
    """
    require_positive(wall=wall, length=length)
    require(diameter > 2.0 * wall, "diameter", diameter, "> twice the wall")
    return math.pi * (diameter - wall) * wall * length * STEEL_DENSITY


def annuity(years: ArrayLike, *, interest: float) -> NDArray[np.float64]:
    """Share of a sum to be paid each year of its life, i/(1 - (1 + i)^-n).

    Parameters
    ----------
    years : array_like, shape (n,)
        n [a], positive.
    interest : float
        i a year [-], at least 0; 1/n at 0.

    Returns
    -------
    ndarray, shape (n,)
        [1/a].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> float(annuity(15.0, interest=0.08).round(6)), float(annuity(10.0, interest=0.0))
    (0.11683, 0.1)
    """
    lives = np.asarray(years, dtype=np.float64)
    require_positive(years=float(lives.min()))
    require_not_negative(interest=interest)
    if interest == 0.0:
        return np.asarray(1.0 / lives)
    return np.asarray(-interest / np.expm1(-lives * math.log1p(interest)))
