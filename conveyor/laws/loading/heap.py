"""The two conventions of the heap, and shares of the rolls by the area above them.

Sources: ISO 5048 (parabola that meets the edge at the surcharge angle θ); DIN 22101 (triangle of the equivalent slope
β, tan β = 2/3 tan θ: the same area); the share by area is geometry.
"""

from __future__ import annotations

import math
from typing import Final, Literal

from conveyor.arguments.limits import require, require_angle
from conveyor.laws.loading.wings import NO_WING, Wing, wing_pieces

Heap = Literal["parabola", "triangle"]
EQUAL_AREA: Final = 2.0 / 3.0  # [-], tan β/tan θ: W² tan θ/6 = W² tan β/4


def surcharge_from_slope(slope: float) -> float:
    """Surcharge angle of the parabolic heap, tan θ = 3/2 tan β (ISO 5048 from DIN 22101).

    Parameters
    ----------
    slope : float
        β of the triangular heap (DIN 22101) [rad], from 0 to below pi/2.

    Returns
    -------
    float
        θ of the parabola of equal area [rad].

    Raises
    ------
    InputError
        The angle is outside its range.

    Examples
    --------
    >>> round(math.degrees(surcharge_from_slope(math.radians(13.639))), 2)
    20.0
    """
    require_angle(0.0, slope=slope)
    return math.atan(math.tan(slope) / EQUAL_AREA)


def shares_by_area(
    usable_width: float,
    *,
    middle_roll_length: float,
    trough_angle: float,
    surcharge_angle: float,
    heap: Heap = "parabola",
    inner_wing: Wing = NO_WING,
) -> tuple[float, ...]:
    """Shares of the bulk's weight above the rolls of a set: their areas over the whole.

    Parameters
    ----------
    usable_width : float
        b of the belt under the bulk [m], positive.
    middle_roll_length : float
        l_M, belt on the middle roll [m], from 0 (two or four rolls) to b.
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2.
    surcharge_angle : float
        θ in the convention of ISO 5048, for either heap [rad], from 0 to below pi/2.
    heap : {"parabola", "triangle"}
        Shape of the heap [-]: ISO 5048, or DIN 22101 with the same area.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`.

    Returns
    -------
    tuple of float
        Of the middle, then of the pieces of one wing outward, as far as the bulk reaches [-].

    Raises
    ------
    InputError
        An argument is outside its range, or there is no bulk: flat belt without a heap.

    Notes
    -----
    Vertical columns: neither the bulk's inner friction nor the wings' thrust is in it; VDI 2341's line, see
    `middle_share_bulk`, and measured overland cases put more on the middle.

    Examples
    --------
    >>> middle, wing = shares_by_area(
    ...     1.03,
    ...     middle_roll_length=0.436,
    ...     trough_angle=math.radians(45),
    ...     surcharge_angle=math.radians(20),
    ... )
    >>> round(middle, 3), round(wing, 3)
    (0.681, 0.16)
    """
    require_angle(0.0, surcharge_angle=surcharge_angle)
    require(heap in {"parabola", "triangle"}, "heap", heap, "parabola, triangle")
    pieces = wing_pieces(
        usable_width, middle_roll_length=middle_roll_length, trough_angle=trough_angle, inner_wing=inner_wing
    )
    steepness, depth = math.tan(surcharge_angle), math.fsum(w.length * math.sin(w.angle) for w in pieces)
    half = 0.5 * middle_roll_length + math.fsum(w.length * math.cos(w.angle) for w in pieces)

    def above(x: float) -> float:
        """Heap over the water line from the middle to x [m²]."""
        if heap == "parabola":
            return steepness * x * (half / 2.0 - x**2 / (6.0 * half))
        return EQUAL_AREA * steepness * x * (half - x / 2.0)

    place = 0.5 * middle_roll_length
    areas = [depth * place + above(place)]
    for length, angle in pieces:
        across, rise = length * math.cos(angle), length * math.sin(angle)
        areas.append((depth - 0.5 * rise) * across + above(place + across) - above(place))
        place, depth = place + across, depth - rise
    whole = math.fsum(areas)
    require(whole > 0.0, "surcharge_angle", surcharge_angle, "> 0: a flat belt carries a heap only")
    return (areas[0] / whole, *(0.5 * area / whole for area in areas[1:]))
