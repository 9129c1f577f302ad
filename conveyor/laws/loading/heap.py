"""The heap's two conventions, and the share of each roll by the area above it.

Sources: ISO 5048 (parabola that meets the edge at the surcharge angle θ); DIN 22101 (triangle of the equivalent slope
β, tan β = 2/3 tan θ: the same area); the share by area is geometry.
"""

from __future__ import annotations

import math
from typing import Final, Literal

from conveyor.require import require, require_angle, require_positive

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


def middle_share_by_area(
    usable_width: float,
    *,
    middle_roll_length: float,
    trough_angle: float,
    surcharge_angle: float,
    heap: Heap = "parabola",
) -> float:
    """Share of the bulk's weight that stands above the middle of three rolls: its area over the whole.

    Parameters
    ----------
    usable_width : float
        b of the belt under the bulk [m], positive.
    middle_roll_length : float
        l_M, belt on the middle roll [m], from 0 to b.
    trough_angle : float
        λ [rad], from 0 to below pi/2.
    surcharge_angle : float
        θ in the convention of ISO 5048, for either heap [rad], from 0 to below pi/2.
    heap : {"parabola", "triangle"}
        Shape of the heap [-]: ISO 5048, or DIN 22101 with the same area.

    Returns
    -------
    float
        Share [-]; each wing half of the rest.

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
    >>> share = middle_share_by_area(
    ...     1.03,
    ...     middle_roll_length=0.436,
    ...     trough_angle=math.radians(45),
    ...     surcharge_angle=math.radians(20),
    ... )
    >>> round(share, 3)
    0.681
    """
    require_positive(usable_width=usable_width)
    ok = 0.0 <= middle_roll_length <= usable_width
    require(ok, "middle_roll_length", middle_roll_length, f"0 to usable_width = {usable_width!r} m is needed")
    require_angle(0.0, trough_angle=trough_angle, surcharge_angle=surcharge_angle)
    require(heap in {"parabola", "triangle"}, "heap", heap, "one of parabola, triangle is needed")
    wing = (usable_width - middle_roll_length) / 2.0
    depth, across = wing * math.sin(trough_angle), wing * math.cos(trough_angle)
    width, steepness = middle_roll_length + 2.0 * across, math.tan(surcharge_angle)
    middle = middle_roll_length
    area = depth * (middle + across) + width**2 * steepness / 6.0
    require(
        area > 0.0, "surcharge_angle", surcharge_angle, "a flat belt carries a heap only, above 0 is needed"
    )
    if heap == "parabola":
        top = steepness * (width * middle / 4.0 - middle**3 / (12.0 * width))
    else:
        top = EQUAL_AREA * steepness * (width * middle / 2.0 - middle**2 / 4.0)
    return (depth * middle + top) / area
