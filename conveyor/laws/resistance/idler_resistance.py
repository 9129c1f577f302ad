"""Resistances at the idlers other than indentation: rotation of the rolls, tilt of the wings, flexure.

Sources: ISO 5048 (tilt); acceptance limits of idler rolls (drag); one measured overland site (flexure).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive, require_slope
from conveyor.laws.resistance.resistance_defaults import (
    ROLL_DRAG_LARGER,
    ROLL_DRAG_TO_153,
    ROLL_DRAG_TO_178,
    Default,
)

_DRAG_STEPS: Final = ((0.153, ROLL_DRAG_TO_153), (0.178, ROLL_DRAG_TO_178))  # roll diameter up to [m], limit


@dataclass(frozen=True, slots=True)
class RollDrag:
    """Drag of one roll.

    Parameters
    ----------
    force : float
        At the rim [N].
    source : str
        Where the figure comes from.
    assumed : bool
        True: a default, because none was given; an analysis must say so.
    """

    force: float
    source: str
    assumed: bool


def default_roll_drag(roll_diameter: float) -> Default:
    """Acceptance limit of a roll's rim drag by its diameter.

    Parameters
    ----------
    roll_diameter : float
        Outer diameter [m], positive.

    Returns
    -------
    Default
        1.28 N to 153 mm, 2.45 N to 178 mm, 3.0 N (the running drag at 650 rpm under 250 N) beyond.

    Raises
    ------
    InputError
        The diameter is not positive.

    Examples
    --------
    >>> default_roll_drag(0.133).value, default_roll_drag(0.159).value, default_roll_drag(0.194).value
    (1.28, 2.45, 3.0)
    """
    require_positive(roll_diameter=roll_diameter)
    for largest, limit in _DRAG_STEPS:
        if roll_diameter <= largest:
            return limit
    return ROLL_DRAG_LARGER


def roll_drag(given: float | None, *, roll_diameter: float) -> RollDrag:
    """Drag of one roll at its rim: the given one, else the acceptance limit, flagged as assumed.

    Parameters
    ----------
    given : float or None
        Measured or catalogue drag at the rim [N], at least 0.
    roll_diameter : float
        Outer diameter [m], positive.

    Returns
    -------
    RollDrag
        Force, source, and whether it is assumed.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Neither speed nor load is in it: no law for them was found in the sources. After standstill the acceptance
    rules allow 1.5 times the running drag.

    Examples
    --------
    >>> roll_drag(1.9, roll_diameter=0.159)
    RollDrag(force=1.9, source='given', assumed=False)
    >>> roll_drag(None, roll_diameter=0.159).assumed
    True
    """
    limit = default_roll_drag(roll_diameter)
    if given is None:
        return RollDrag(force=limit.value, source=limit.source, assumed=True)
    require_not_negative(given=given)
    return RollDrag(force=given, source="given", assumed=False)


def idler_rotation_resistance(drag: float, *, n_rolls: int, spacing: float, length: float) -> float:
    """Rotation resistance of all rolls of a strand section: drag × rolls per set × sets.

    Parameters
    ----------
    drag : float
        Of one roll at its rim [N], at least 0, see `roll_drag`.
    n_rolls : int
        Rolls of a set [-], at least 1.
    spacing : float
        Distance of the sets [m], positive.
    length : float
        Of the section [m], at least 0; length/spacing sets are counted, a broken number allowed, so that
        splitting a section changes nothing.

    Returns
    -------
    float
        Resistance [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> idler_rotation_resistance(2.0, n_rolls=3, spacing=1.25, length=100.0)
    480.0
    """
    require_not_negative(drag=drag, length=length)
    require_positive(spacing=spacing)
    require(n_rolls >= 1, "n_rolls", n_rolls, ">= 1")
    return drag * n_rolls * length / spacing


def idler_tilt_resistance(
    *,
    tilt_coefficient: float,
    roll_friction: float,
    length: float,
    belt_mass: float,
    bulk_mass: float,
    inclination: float,
    tilt_angle: float,
    gravity: float,
) -> float:
    """Resistance of wings tilted forward, F_e = C_e μ0 L_e (m'_belt + m'_bulk) g cos δ sin ε (ISO 5048).

    Parameters
    ----------
    tilt_coefficient : float
        C_e [-], at least 0: 0.4 at a trough angle of 30 deg, 0.5 at 45 deg; of two rolls in a V cos λ.
    roll_friction : float
        μ0, roll on belt [-], at least 0; default of the craft `ROLL_ON_BELT_FRICTION`, general knowledge.
    length : float
        L_e, with tilted idlers [m], at least 0.
    belt_mass : float
        m'_belt [kg/m], at least 0.
    bulk_mass : float
        m'_bulk [kg/m], at least 0.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    tilt_angle : float
        ε [rad], from 0 to below pi/2.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F_e [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(
    ...     idler_tilt_resistance(
    ...         tilt_coefficient=0.4,
    ...         roll_friction=0.35,
    ...         length=100.0,
    ...         belt_mass=20.0,
    ...         bulk_mass=80.0,
    ...         inclination=0.0,
    ...         tilt_angle=math.asin(0.02),
    ...         gravity=10.0,
    ...     ),
    ...     9,
    ... )
    280.0
    """
    require_not_negative(tilt_coefficient=tilt_coefficient, roll_friction=roll_friction, length=length)
    require_not_negative(belt_mass=belt_mass, bulk_mass=bulk_mass, tilt_angle=tilt_angle)
    require_slope(inclination=inclination, tilt_angle=tilt_angle)
    require_positive(gravity=gravity)
    normal = (belt_mass + bulk_mass) * gravity * math.cos(inclination)
    return tilt_coefficient * roll_friction * length * normal * math.sin(tilt_angle)


def flexure_resistance(other_resistance: float, *, share: float) -> float:
    """Flexure of belt and bulk as a measured share of the total, F = s/(1 - s) × all others.

    Parameters
    ----------
    other_resistance : float
        All resistances of the total the share refers to, without flexure [N], at least 0.
    share : float
        s, flexure over total [-], from 0 to below 1; `FLEXURE_SHARE` was measured at one overland site.

    Returns
    -------
    float
        Flexure resistance [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    One site is not a law: an analysis that uses the measured share must say so.

    Examples
    --------
    >>> round(flexure_resistance(8900.0, share=0.11), 6)
    1100.0
    """
    require_not_negative(other_resistance=other_resistance)
    require(0.0 <= share < 1.0, "share", share, ">= 0 and < 1")
    return share / (1.0 - share) * other_resistance
