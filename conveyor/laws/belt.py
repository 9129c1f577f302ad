"""Strength of the belt and diameters of the pulleys.

Sources: DIN 22101 (safety against rupture, 1982; strength of the splice with S0 and S1, 2002; groups of pulleys). The
figures below are general knowledge, not read in the standard: an analysis that uses them must say so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final, Literal

from conveyor.errors import RangeError
from conveyor.require import require, require_positive

Reinforcement = Literal["textile", "steel cord"]
Condition = Literal["favourable", "normal", "unfavourable"]
Group = Literal["A", "B", "C"]

# DIN 22101:1982, safety in steady operation [-]; general knowledge
CLASSIC_SAFETY: Final[Mapping[Reinforcement, float]] = {"textile": 8.0, "steel cord": 6.7}
# DIN 22101:2002, S0 for the make of the splice and S1 for life and duty [-]; general knowledge
SPLICE_SAFETY: Final[Mapping[Condition, float]] = {"favourable": 1.0, "normal": 1.1, "unfavourable": 1.2}
DUTY_SAFETY: Final[Mapping[Condition, float]] = {"favourable": 1.5, "normal": 1.7, "unfavourable": 1.9}
# DIN 22101, diameter over that of group A at 60 to 100 % of the allowed tension [-]; general knowledge
GROUP_FACTOR: Final[Mapping[Group, float]] = {"A": 1.0, "B": 0.8, "C": 0.63}
# [m], ISO 3684, R10 steps up to 1000 mm; general knowledge
PULLEY_DIAMETERS: Final = (
    0.200, 0.250, 0.315, 0.400, 0.500, 0.630, 0.800, 1.000, 1.250, 1.400, 1.600, 1.800, 2.000,
)  # fmt: skip


RATED_START: Final = 1.5
"""Tension of a start or stop over the rated one that makers of US belts allow at most [-]; general knowledge."""


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
    require_positive(
        largest_tension=largest_tension, nominal_strength=nominal_strength, belt_width=belt_width
    )
    return nominal_strength * belt_width / largest_tension


def needed_strength(largest_per_width: float, *, splice_strength: float, s0: float, s1: float) -> float:
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
    >>> round(needed_strength(300e3, splice_strength=0.45, s0=1.1, s1=1.7))
    1246667
    """
    require_positive(largest_per_width=largest_per_width)
    require(
        0.0 < splice_strength <= 1.0, "splice_strength", splice_strength, "above 0 and at most 1 is needed"
    )
    for name, value in (("s0", s0), ("s1", s1)):
        require(1.0 <= value < math.inf, name, value, "at least 1 is needed")
    return largest_per_width * s0 * s1 / splice_strength


def pulley_group_diameter(drive_diameter: float, *, group: Group) -> float:
    """Least diameter of the pulleys that do not drive, D_A times 1.0, 0.8 or 0.63 (DIN 22101).

    Parameters
    ----------
    drive_diameter : float
        D_A, least diameter of the drive pulley [m], positive, see `least_pulley_diameter`.
    group : {"A", "B", "C"}
        A [-]: drive and others at high tension; B: tail, take-up and bend pulleys at low tension; C: snub pulleys
        that turn the belt by less than 30 deg.

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
    For a belt used to more than 60 % of its allowed tension; less used ones may have smaller pulleys, for which
    the standard's table is needed.

    Examples
    --------
    >>> [round(pulley_group_diameter(1.0, group=g), 3) for g in ("A", "B", "C")]
    [1.0, 0.8, 0.63]
    """
    require_positive(drive_diameter=drive_diameter)
    require(group in GROUP_FACTOR, "group", group, f"one of {', '.join(GROUP_FACTOR)} is needed")
    return GROUP_FACTOR[group] * drive_diameter


def next_pulley_diameter(least_diameter: float) -> float:
    """Smallest diameter of the series that is large enough (ISO 3684).

    Parameters
    ----------
    least_diameter : float
        Asked for by the belt [m], positive.

    Returns
    -------
    float
        Diameter [m].

    Raises
    ------
    InputError
        The diameter is not positive.
    RangeError
        Larger than the largest of the series, 2 m.

    Examples
    --------
    >>> next_pulley_diameter(0.54), next_pulley_diameter(0.63)
    (0.63, 0.63)
    """
    require_positive(least_diameter=least_diameter)
    needed = round(least_diameter, 6)  # products of decimals: 0.63 · 0.5 is 0.315, not the next size
    for diameter in PULLEY_DIAMETERS:
        if diameter >= needed:
            return diameter
    raise RangeError(
        f"{least_diameter:.4g} m is more than the largest pulley of the series, {PULLEY_DIAMETERS[-1]:g} m: "
        "choose a thinner carcass or give the diameter"
    )
