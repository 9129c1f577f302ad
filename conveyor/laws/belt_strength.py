"""Strength of the belt and diameters of the pulleys.

Sources: DIN 22101 (safety against rupture, 1982; strength of the splice with S0 and S1, 2002; groups of pulleys). The
figures below are general knowledge, not read in the standard: an analysis that uses them must say so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final, Literal

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.errors import RangeError

Reinforcement = Literal["textile", "steel cord"]
Condition = Literal["favourable", "normal", "unfavourable"]
Group = Literal["A", "B", "C"]

# DIN 22101:1982, safety in steady operation [-]; general knowledge
CLASSIC_SAFETY: Final[Mapping[Reinforcement, float]] = {"textile": 8.0, "steel cord": 6.7}
# DIN 22101:2002, S0 for the make of the splice and S1 for life and duty [-]; general knowledge
SPLICE_SAFETY: Final[Mapping[Condition, float]] = {"favourable": 1.0, "normal": 1.1, "unfavourable": 1.2}
DUTY_SAFETY: Final[Mapping[Condition, float]] = {"favourable": 1.5, "normal": 1.7, "unfavourable": 1.9}
# DIN 22101, diameter over that of group A at 60 to 100 % of the allowed tension [-], a step of R10 each
_DIAMETER_STEPS: Final = (1.0, 0.8, 0.63, 0.5)
# DIN 22101, utilisation of the allowed tension above which the steps of the groups hold [-]
_GROUP_STEPS: Final[tuple[tuple[float, Mapping[Group, int]], ...]] = (
    (0.6, {"A": 0, "B": 1, "C": 2}),
    (0.3, {"A": 1, "B": 2, "C": 3}),
    (-math.inf, {"A": 2, "B": 2, "C": 3}),
)
# [m], ISO 3684, R10 steps up to 1000 mm; general knowledge
PULLEY_DIAMETERS: Final = (
    0.200, 0.250, 0.315, 0.400, 0.500, 0.630, 0.800, 1.000, 1.250, 1.400, 1.600, 1.800, 2.000,
)  # fmt: skip
# [m], CEMA B105.1 as commonly listed, 66 and 72 in engineered ones; general knowledge
CEMA_PULLEYS: Final = tuple(
    0.0254 * inches for inches in (8, 10, 12, 14, 16, 18, 20, 24, 30, 36, 42, 48, 54, 60, 66, 72)
)
# [m], DIN 22101 as a belt maker prints it (scribd 134461858): of the steps, in the order of the sizes of group A
_STANDARD_DIAMETERS: Final = (
    PULLEY_DIAMETERS,
    (0.160, 0.200, 0.250, 0.315, 0.400, 0.500, 0.630, 0.800, 1.000, 1.250, 1.250, 1.400, 1.600),
    (0.125, 0.160, 0.200, 0.250, 0.315, 0.400, 0.500, 0.630, 0.800, 1.000, 1.000, 1.250, 1.250),
    (0.100, 0.125, 0.160, 0.200, 0.250, 0.315, 0.400, 0.500, 0.630, 0.800, 0.800, 1.000, 1.000),
)


# CEMA, breaking strength of US belts over the tension they are rated for [-]; general knowledge
RATED_SAFETY: Final[Mapping[Reinforcement, float]] = {"textile": 10.0, "steel cord": 6.67}
RATED_START: Final = 1.5
"""Tension of a start or stop over the rated one that makers of US belts allow at most [-]; general knowledge."""


_LEAST_OVER_CORD: Final = 0.7  # [-], DIN 22131: least cover over the diameter of the cords; general knowledge
_LEAST_STEEL: Final = 4e-3  # [m], DIN 22131: least cover of steel-cord belts; general knowledge
_LEAST_TEXTILE: Final = 2e-3  # [m], general knowledge
FALL_BORDERS: Final = (0.5, 1.5)
"""Height of fall from which the bulk lands with medium and with high severity [m]; general knowledge."""


def least_cover(carcass_thickness: float, *, steel_cord: bool) -> float:
    """Least cover that protects the carcass, wear apart (DIN 22101, DIN 22131; general knowledge).

    Parameters
    ----------
    carcass_thickness : float
        Diameter of the cords, or thickness of the plies [m], positive.
    steel_cord : bool
        Steel cords [-]; else plies of fabric.

    Returns
    -------
    float
        Thickness of either cover [m].

    Raises
    ------
    InputError
        The thickness is not positive.

    Notes
    -----
    0.7 cord diameters, at least 4 mm; 2 mm on fabric.

    Examples
    --------
    >>> round(least_cover(9e-3, steel_cord=True), 6), least_cover(5e-3, steel_cord=False)
    (0.0063, 0.002)
    """
    require_positive(carcass_thickness=carcass_thickness)
    return max(_LEAST_STEEL, _LEAST_OVER_CORD * carcass_thickness) if steel_cord else _LEAST_TEXTILE


def fall_severity(drop: float) -> Literal["low", "medium", "high"]:
    """Severity of the impact of bulk that falls from a height, for the cover's wear (general knowledge).

    Parameters
    ----------
    drop : float
        Height of fall [m], at least 0.

    Returns
    -------
    str
        For `wear_addition`.

    Raises
    ------
    InputError
        The height is negative.

    Examples
    --------
    >>> fall_severity(0.3), fall_severity(2.0)
    ('low', 'high')
    """
    require_not_negative(drop=drop)
    return "low" if drop < FALL_BORDERS[0] else "medium" if drop < FALL_BORDERS[1] else "high"


def belt_safety(largest_tension: float, *, nominal_strength: float, belt_width: float) -> float:
    """Safety of the belt against rupture, S = k_N B/T (DIN 22101).

    Parameters
    ----------
    largest_tension : float
        T [N], positive.
    nominal_strength : float
        k_N, strength class per width [N/m], positive: ST1600 is 1.6e6 N/m.
    belt_width : float
        B [m], positive.

    Returns
    -------
    float
        S [-], to be compared with `CLASSIC_SAFETY`.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> belt_safety(200e3, nominal_strength=1.6e6, belt_width=1.0)
    8.0
    """
    require_positive(largest_tension=largest_tension, nominal_strength=nominal_strength, belt_width=belt_width)
    return nominal_strength * belt_width / largest_tension


def required_strength(largest_per_width: float, *, splice_strength: float, s0: float, s1: float) -> float:
    """Least strength class by the endurance of the splice, k_N = k_max S0 S1/k_t,rel (DIN 22101:2002).

    Parameters
    ----------
    largest_per_width : float
        k_max, at the edge or middle of the belt, curves and transitions included [N/m], positive.
    splice_strength : float
        k_t,rel, endurance of the splice over nominal strength [-], above 0, at most 1, from a test (DIN 22110-3)
        or the belt's maker.
    s0 : float
        S0 for the make of the splice [-], at least 1, see `SPLICE_SAFETY`.
    s1 : float
        S1 for life and duty [-], at least 1, see `DUTY_SAFETY`.

    Returns
    -------
    float
        k_N [N/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(required_strength(300e3, splice_strength=0.45, s0=1.1, s1=1.7))
    1246667
    """
    require_positive(largest_per_width=largest_per_width)
    require(0.0 < splice_strength <= 1.0, "splice_strength", splice_strength, "> 0 and <= 1")
    for name, value in (("s0", s0), ("s1", s1)):
        require(1.0 <= value < math.inf, name, value, ">= 1")
    return largest_per_width * s0 * s1 / splice_strength


def _standard_step(group: Group, utilisation: float) -> int:
    require(group in _GROUP_STEPS[0][1], "group", group, "A, B, C")
    require_not_negative(utilisation=utilisation)
    return next(steps[group] for above, steps in _GROUP_STEPS if utilisation > above)


def pulley_group_diameter(drive_diameter: float, *, group: Group, utilisation: float = 1.0) -> float:
    """Least diameter of a pulley, D_A times 1.0, 0.8, 0.63 or 0.5 (DIN 22101).

    Parameters
    ----------
    drive_diameter : float
        D_A, least diameter of the drive pulley at full tension [m], positive, see `least_pulley_diameter`.
    group : {"A", "B", "C"}
        A [-]: drive pulleys and all at high tension, wherever they stand; B: pulleys at low tension, as tail and
        take-up of most conveyors; C: snub pulleys that turn the belt by less than 30 deg.
    utilisation : float
        Tension of the belt there in steady running over the allowed one [-], at least 0.

    Returns
    -------
    float
        Diameter [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Up to 60 % of the allowed tension a step of R10 less, up to 30 % another one but for groups B and C: the steps of
    the standard's table, see `standard_pulley_diameter`.

    Examples
    --------
    >>> [round(pulley_group_diameter(1.0, group=g), 3) for g in ("A", "B", "C")]
    [1.0, 0.8, 0.63]
    >>> [round(pulley_group_diameter(1.0, group=g, utilisation=0.25), 3) for g in ("A", "B", "C")]
    [0.63, 0.63, 0.5]
    """
    require_positive(drive_diameter=drive_diameter)
    return _DIAMETER_STEPS[_standard_step(group, utilisation)] * drive_diameter


def standard_pulley_diameter(drive_diameter: float, *, group: Group, utilisation: float = 1.0) -> float:
    """Standard diameter of a pulley by the table of DIN 22101, the drive pulley's rounded up to the series first.

    Parameters
    ----------
    drive_diameter : float
        D_A, least diameter of the drive pulley at full tension [m], positive.
    group : {"A", "B", "C"}
        As of `pulley_group_diameter` [-].
    utilisation : float
        Likewise [-], at least 0.

    Returns
    -------
    float
        Diameter without lagging [m].

    Raises
    ------
    InputError
        An argument is outside its range.
    RangeError
        The drive pulley is larger than the largest of the series, 2 m.

    Examples
    --------
    >>> [standard_pulley_diameter(0.95, group=g, utilisation=0.5) for g in ("A", "B", "C")]
    [0.8, 0.63, 0.5]
    """
    size = next_pulley_diameter(drive_diameter)
    return _STANDARD_DIAMETERS[_standard_step(group, utilisation)][PULLEY_DIAMETERS.index(size)]


def next_pulley_diameter(least_diameter: float, *, series: Sequence[float] = PULLEY_DIAMETERS) -> float:
    """Next larger diameter of a standard series (ISO 3684; CEMA B105.1).

    Parameters
    ----------
    least_diameter : float
        Required by the belt [m], positive.
    series : sequence of float
        Diameters, the least first [m], shape (n,): those of ISO 3684, or `CEMA_PULLEYS`.

    Returns
    -------
    float
        Diameter [m].

    Raises
    ------
    InputError
        The diameter is not positive.
    RangeError
        Larger than the largest of the series, 2 m of ISO.

    Examples
    --------
    >>> next_pulley_diameter(0.54), next_pulley_diameter(0.63)
    (0.63, 0.63)
    """
    require_positive(least_diameter=least_diameter)
    needed = round(least_diameter, 6)  # products of decimals: 0.63 · 0.5 is 0.315, not the next size
    for diameter in series:
        if round(diameter, 6) >= needed:
            return diameter
    raise RangeError(
        f"{least_diameter:.4g} m is more than the largest pulley of the series, {series[-1]:.4g} m: "
        "choose a thinner carcass or give the diameter"
    )
