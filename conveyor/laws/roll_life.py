"""Rating life of the bearings of a roll: an indicator, not a forecast.

Source: ISO 281 (basic rating life). Seals, dirt and grease end most rolls before fatigue does.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive

RATED_REVOLUTIONS: Final = 1e6  # [-], ISO 281: revolutions of the basic rating life at P = C
BALL_EXPONENT: Final = 3.0  # [-], ISO 281, ball bearings
ROLLER_EXPONENT: Final = 10.0 / 3.0  # [-], ISO 281, roller bearings
WEIBULL_SLOPE_BALL: Final = 10.0 / 9.0  # [-], Lundberg and Palmgren, point contact: ball bearings
WEIBULL_SLOPE_ROLLER: Final = 9.0 / 8.0  # [-], Lundberg and Palmgren, line contact: roller bearings
_STEPS: Final = 50  # of Newton at most; slopes of bearings take two, 0.01 beside 100 a dozen
_SUM_TOLERANCE: Final = 1e-15  # of a sum of rates that is one but for rounding
SECONDS_PER_HOUR: Final = 3600.0
SHELL_ROUNDING: Final = 1e-12  # of the shell's length, which distance and inset give back but for rounding


def heavier_bearing_load(
    bulk_force: float,
    *,
    belt_force: float,
    loaded_length: float,
    bearing_distance: float,
    triangular: bool,
    inset: float = 0.0,
) -> float:
    """Load of the heavier bearing of a roll, by moments about the other one.

    Parameters
    ----------
    bulk_force : float
        Of the bulk on the roll [N], at least 0.
    belt_force : float
        Of belt and curve, even along the loaded length [N], at least 0.
    loaded_length : float
        Length under the belt from the inner end of the shell on [m], positive, at most that of the shell,
        bearing_distance + 2 inset.
    bearing_distance : float
        Between the two bearings [m], positive.
    triangular : bool
        True [-]: the bulk falls from the inner end to 0 at the loaded length's end (wing); False: even.
    inset : float
        Distance of each bearing from its end of the shell [m], negative outside it, above -bearing_distance/2.

    Returns
    -------
    float
        Load [N], at least half of the roll's; more than all of it where the load's centre overhangs the bearing.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The loaded length begins at the inner end of the shell; the mass of the shell is left out.

    Examples
    --------
    >>> load = heavier_bearing_load(600.0, belt_force=100.0, loaded_length=0.4, bearing_distance=0.4, triangular=True)
    >>> round(load, 6)
    450.0
    """
    require_not_negative(bulk_force=bulk_force, belt_force=belt_force)
    require_positive(loaded_length=loaded_length, bearing_distance=bearing_distance)
    shell = bearing_distance + 2.0 * inset
    require(shell > 0.0, "inset", inset, f"> -bearing_distance/2 = {-bearing_distance / 2.0!r} m")
    allowed = f"<= bearing_distance + 2 inset = {shell!r} m"
    ok = loaded_length <= shell * (1.0 + SHELL_ROUNDING)
    require(ok, "loaded_length", loaded_length, allowed)
    bulk_centre = (loaded_length / (3.0 if triangular else 2.0) - inset) / bearing_distance
    belt_centre = (loaded_length / 2.0 - inset) / bearing_distance
    return bulk_force * (1.0 - bulk_centre) + belt_force * (1.0 - belt_centre)


def rating_life_hours(load: float, *, dynamic_rating: float, rotation: float, exponent: float = BALL_EXPONENT) -> float:
    """Basic rating life, L10h = (C/P)^p 1e6/(3600 n) (ISO 281).

    Parameters
    ----------
    load : float
        P, equivalent load of the bearing [N], positive.
    dynamic_rating : float
        C of the bearing [N], positive.
    rotation : float
        n, revolutions [1/s], positive.
    exponent : float
        p [-], 3 for ball and 10/3 for roller bearings.

    Returns
    -------
    float
        L10h [h], reached by 90 % of the bearings.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    P up to C/2; below C/100 or so the figure means nothing: fatigue does not end such a bearing.

    Examples
    --------
    >>> round(rating_life_hours(1000.0, dynamic_rating=20e3, rotation=10.0))
    222222
    """
    require_positive(load=load, dynamic_rating=dynamic_rating, rotation=rotation)
    require(1.0 <= exponent <= 4.0, "exponent", exponent, "3 (ball) or 10/3 (roller)")
    revolutions: float = RATED_REVOLUTIONS * (dynamic_rating / load) ** exponent
    return revolutions / (rotation * SECONDS_PER_HOUR)


def system_life_hours(lives: Sequence[float], *, weibull_slopes: Sequence[float]) -> float:
    """Rating life of several bearings together, L of Σ (L/L_i)^e_i = 1 (Lundberg and Palmgren).

    Of one slope L = (Σ L_i^-e)^(-1/e).

    Parameters
    ----------
    lives : sequence of float
        L10h of each bearing [h], positive.
    weibull_slopes : sequence of float
        e of each bearing's Weibull distribution [-], positive; 10/9 for ball and 9/8 for roller bearings.

    Returns
    -------
    float
        L10h of all: 90 % of such groups run so long without a failure [h].

    Raises
    ------
    InputError
        An argument is outside its range.
    ValueError
        Not as many slopes as lives.

    Examples
    --------
    >>> round(system_life_hours([50e3, 50e3], weibull_slopes=[10 / 9, 10 / 9]))
    26794
    """
    require(len(lives) > 0, "lives", list(lives), "at least one bearing")
    bearings = list(zip(lives, weibull_slopes, strict=True))
    for life, slope in bearings:
        require_positive(lives=life, weibull_slopes=slope)
    together = min(lives)
    for _ in range(_STEPS):
        # Newton for the logarithm of the life, in which the sum's is convex: from above
        rates = [(together / life) ** slope for life, slope in bearings]
        total = math.fsum(rates)
        if total <= 1.0 + _SUM_TOLERANCE:
            break
        mean = math.fsum(rate * slope for rate, (_, slope) in zip(rates, bearings, strict=True)) / total
        factor: float = total ** (-1.0 / mean)
        together *= factor
    return together
