"""Loading points and cleaners: impact of the bulk, length and seals of skirtboards, carryback behind cleaners."""

from __future__ import annotations

import math
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.laws.resistance import Default

SKIRT_SECONDS: Final = Default(1.2, 1.2, 1.8, "CEMA: 2 ft of skirtboard for every 100 fpm of belt speed", True)  # [s]
SKIRT_LEAST: Final = Default(0.9144, 0.9144, 0.9144, "CEMA: no less than 3 ft", True)  # [m]
IMPACT_CLASSES: Final = ((271.2, "light"), (1355.8, "medium"), (2711.6, "heavy"))
"""Largest lump energy of the impact bed classes of CEMA 575: 200, 1000, 2000 lbf ft [J]; general knowledge."""
CLEANER_EFFICIENCY: Final = Default(0.8, 0.6, 0.9, "a scraper in order", True)  # [-]


def stream_impact(mass_flow: float, *, drop_height: float, gravity: float) -> float:
    """Force of a falling stream that comes to rest, F = Q sqrt(2 g H) (momentum).

    Parameters
    ----------
    mass_flow : float
        Q [kg/s], at least 0.
    drop_height : float
        H, free fall onto the belt [m], at least 0.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Rulmeca's catalogue writes the same as Q sqrt(H)/8 in kgf, t/h, m: sqrt(2 g)/(3.6 g) = 1/7.97.

    Examples
    --------
    >>> round(stream_impact(1000.0 / 3.6, drop_height=1.0, gravity=9.80665) / 9.80665, 1)
    125.4
    """
    require_not_negative(mass_flow=mass_flow, drop_height=drop_height)
    require_positive(gravity=gravity)
    return mass_flow * math.sqrt(2.0 * gravity * drop_height)


def lump_impact(mass: float, *, drop_height: float, stiffness: float, gravity: float) -> float:
    """Force of a lump that falls on a spring, F = W + sqrt(W² + 2 k W H), W = m g (energy).

    Parameters
    ----------
    mass : float
        m [kg], at least 0.
    drop_height : float
        H, free fall down to the spring at rest [m], at least 0.
    stiffness : float
        k of belt, rolls and frame together [N/m], positive.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F, the largest [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    CEMA and Rulmeca write W + sqrt(2 k W H), which leaves out the travel of the spring itself. At H = 0 it is twice the
    weight. No loss, no mass of the rolls.

    Examples
    --------
    >>> round(lump_impact(50.0, drop_height=1.2, stiffness=400e3, gravity=9.81))
    22196
    """
    require_not_negative(mass=mass, drop_height=drop_height)
    require_positive(stiffness=stiffness, gravity=gravity)
    weight = mass * gravity
    return weight + math.sqrt(weight * (weight + 2.0 * stiffness * drop_height))


def impact_class(energy: float) -> str:
    """Class of impact bed for the energy of the heaviest lump (CEMA 575; borders general knowledge).

    Parameters
    ----------
    energy : float
        m g H [J], at least 0.

    Returns
    -------
    str
        "light", "medium" or "heavy"; "beyond heavy" above.

    Raises
    ------
    InputError
        The energy is negative.

    Examples
    --------
    >>> impact_class(588.6)
    'medium'
    """
    require_not_negative(energy=energy)
    return next((name for most, name in IMPACT_CLASSES if energy <= most), "beyond heavy")


def usual_skirt_length(belt_speed: float) -> float:
    """Length of skirtboards behind the loading point, 2 ft for every 100 fpm, 3 ft at least (CEMA).

    Parameters
    ----------
    belt_speed : float
        v [m/s], positive.

    Returns
    -------
    float
        [m].

    Raises
    ------
    InputError
        The speed is not positive.

    Notes
    -----
    General knowledge; for bulk that comes with the direction of the belt. Dust needs more.

    Examples
    --------
    >>> round(usual_skirt_length(4.0), 2), usual_skirt_length(0.5)
    (4.8, 0.9144)
    """
    require_positive(belt_speed=belt_speed)
    return max(SKIRT_SECONDS.value * belt_speed, SKIRT_LEAST.value)


def skirt_seal_resistance(length: float, *, drag_per_length: float) -> float:
    """Drag of rubber seals that touch the belt, F = f l.

    Parameters
    ----------
    length : float
        l, of skirtboard with seals on both sides [m], at least 0.
    drag_per_length : float
        f of both seals together [N/m], at least 0; CEMA has 2 x 3 lbf/ft = 87.6 N/m.

    Returns
    -------
    float
        F [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(skirt_seal_resistance(6.0, drag_per_length=87.6), 1)
    525.6
    """
    require_not_negative(length=length, drag_per_length=drag_per_length)
    return drag_per_length * length


def carryback(on_belt: float, *, efficiency: float, count: int) -> float:
    """Bulk left on the belt behind cleaners in a row, m (1 - η)^n (derived: each takes the same share).

    Parameters
    ----------
    on_belt : float
        m, clinging bulk before the first one, per area of belt [kg/m²], at least 0.
    efficiency : float
        η of one [-], from 0 to 1.
    count : int
        n, how many in a row [-], at least 0.

    Returns
    -------
    float
        Behind the last one [kg/m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(carryback(0.5, efficiency=0.8, count=2), 6)
    0.02
    """
    require_not_negative(on_belt=on_belt)
    require(0.0 <= efficiency <= 1.0, "efficiency", efficiency, ">= 0 and <= 1")
    require(count >= 0, "count", count, ">= 0")
    return float(on_belt * (1.0 - efficiency) ** count)
