"""Cross line of the belt on a set: level on the middle roll, each wing of straight pieces.

Sets of two and three rolls have one piece a side, those of four and five two; geometry.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from conveyor.arguments.limits import require, require_angle, require_not_negative, require_positive


class Wing(NamedTuple):
    """A straight piece of belt on one side of the middle: length [m], and angle to the level [rad]."""

    length: float
    angle: float


NO_WING: Final = Wing(0.0, 0.0)
"""Between middle and outer rolls: none, in sets of up to three rolls."""


def wing_pieces(
    width: float, *, middle_roll_length: float, trough_angle: float, inner_wing: Wing = NO_WING
) -> tuple[Wing, ...]:
    """Straight pieces of belt on one side of the middle roll, from it outward.

    Parameters
    ----------
    width : float
        Of the belt, or of what of it lies under the bulk [m], positive.
    middle_roll_length : float
        l_M, belt on the middle roll [m], from 0 (two or four rolls) to the width (flat).
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of sets of four and five, the angle like λ.

    Returns
    -------
    tuple of Wing
        One or two; the last ends at the edge.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> [w.length for w in wing_pieces(1.5, middle_roll_length=0.25, trough_angle=1.0, inner_wing=Wing(0.25, 0.5))]
    [0.25, 0.375]
    """
    require_positive(width=width)
    ok = 0.0 <= middle_roll_length <= width
    require(ok, "middle_roll_length", middle_roll_length, f">= 0 and <= the width {width!r} m")
    require_not_negative(inner_wing_length=inner_wing.length)
    require_angle(0.0, trough_angle=trough_angle, inner_wing_angle=inner_wing.angle)
    beside = 0.5 * (width - middle_roll_length)
    if inner_wing.length == 0.0:
        return (Wing(beside, trough_angle),)
    if beside <= inner_wing.length:
        return (Wing(beside, inner_wing.angle),)
    return (inner_wing, Wing(beside - inner_wing.length, trough_angle))


def roll_angles(rolls: int, *, trough_angle: float, inner_angle: float = 0.0) -> tuple[float, ...]:
    """Angle of each roll of a set to the level, falling from the first to the last.

    Parameters
    ----------
    rolls : int
        Of the set [-], 1 to 5.
    trough_angle : float
        λ of the outer rolls [rad].
    inner_angle : float
        Of the inner wing rolls of four and five [rad].

    Returns
    -------
    tuple of float
        Angles [rad], positive where the belt falls toward the last.

    Raises
    ------
    InputError
        Not 1 to 5 rolls.

    Examples
    --------
    >>> roll_angles(5, trough_angle=1.0, inner_angle=0.5)
    (1.0, 0.5, 0.0, -0.5, -1.0)
    """
    require(1 <= rolls <= 5, "rolls", rolls, "1, 2, 3, 4, 5")
    half = (trough_angle, inner_angle)[: rolls // 2]
    return (*half, *([0.0] * (rolls % 2)), *(-angle for angle in reversed(half)))
