"""The bulk on the belt: line mass, usable width, cross-section, capacity.

Source: ISO 5048.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple, TypedDict

from conveyor.arguments.limits import require, require_angle, require_not_negative, require_positive
from conveyor.laws.loading.wings import NO_WING, Wing, wing_pieces

EDGE_FRACTION: Final = 0.9  # ISO 5048: b = 0.9 B - 50 mm
EDGE_MARGIN: Final = 0.05  # [m], ISO 5048, belts up to WIDE_BELT
WIDE_BELT: Final = 2.0  # [m], ISO 5048
WIDE_EDGE_MARGIN: Final = 0.25  # [m], ISO 5048: b = B - 250 mm beyond WIDE_BELT


def bulk_line_mass(mass_flow: float, *, belt_speed: float) -> float:
    """Mass of bulk per length of belt, m'_bulk = Q/v (ISO 5048).

    Parameters
    ----------
    mass_flow : float
        Q [kg/s], at least 0.
    belt_speed : float
        v [m/s], positive.

    Returns
    -------
    float
        m'_bulk [kg/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(bulk_line_mass(2300 / 3.6, belt_speed=4.8), 2)
    133.1
    """
    require_not_negative(mass_flow=mass_flow)
    require_positive(belt_speed=belt_speed)
    return mass_flow / belt_speed


def usable_width(belt_width: float) -> float:
    """Width of belt that may carry bulk, b = 0.9 B - 50 mm, beyond B = 2 m B - 250 mm (ISO 5048).

    Parameters
    ----------
    belt_width : float
        B [m], more than 0.056 m (below, nothing is left between the free edges).

    Returns
    -------
    float
        b [m].

    Raises
    ------
    InputError
        The belt is too narrow to carry anything.

    Examples
    --------
    >>> round(usable_width(1.2), 3), round(usable_width(2.4), 3)
    (1.03, 2.15)
    """
    narrowest = EDGE_MARGIN / EDGE_FRACTION
    require(narrowest < belt_width < math.inf, "belt_width", belt_width, f"> {narrowest:.4g} m")
    if belt_width <= WIDE_BELT:
        return EDGE_FRACTION * belt_width - EDGE_MARGIN
    return belt_width - WIDE_EDGE_MARGIN


@dataclass(frozen=True, slots=True)
class CrossSection:
    """Cross-section of the bulk on the belt.

    Parameters
    ----------
    top : float
        A_top, the heap above the water line [m²].
    bottom : float
        A_bottom, the trough below the water line [m²].
    """

    top: float
    bottom: float

    @property
    def area(self) -> float:
        """Whole cross-section on the level [m²]."""
        return self.top + self.bottom

    def on_slope(self, inclination: float, *, surcharge_angle: float) -> float:
        """Cross-section on a slope, k A = A_bottom + k1 A_top (ISO 5048), see `heap_on_slope` [m²]."""
        return self.bottom + heap_on_slope(inclination, surcharge_angle=surcharge_angle) * self.top


def heap_on_slope(inclination: float, *, surcharge_angle: float) -> float:
    """Heap above the water line on a slope over that on the level, k1 of the slope factor (ISO 5048, DIN 22101).

    k1 = sqrt((cos²δ - cos²θ)/(1 - cos²θ)) = sqrt(1 - (sin δ/sin θ)²), k = 1 - A_top/A (1 - k1).

    Parameters
    ----------
    inclination : float
        δ of the belt, up or down [rad], from -pi/2 to pi/2.
    surcharge_angle : float
        θ (ISO 5048) or β (DIN 22101) of the heap on the level [rad], from 0 to below pi/2.

    Returns
    -------
    float
        k1 [-]; 0 where the slope is as steep as the heap, which no longer stands on it.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(heap_on_slope(math.radians(12), surcharge_angle=math.radians(20)), 4)
    0.794
    """
    require_angle(0.0, surcharge_angle=surcharge_angle)
    require(abs(inclination) <= 0.5 * math.pi, "inclination", inclination, ">= -pi/2 and <= pi/2 rad")
    if abs(inclination) >= surcharge_angle:
        return 0.0
    return math.sqrt(1.0 - (math.sin(inclination) / math.sin(surcharge_angle)) ** 2)


def cross_section(
    usable_width: float,
    *,
    middle_roll_length: float,
    trough_angle: float,
    surcharge_angle: float,
    inner_wing: Wing = NO_WING,
) -> CrossSection:
    """Largest cross-section of bulk on a trough (ISO 5048).

    A_top = [l_M + (b - l_M) cos λ]² tan β/6, A_bottom = [l_M + (b - l_M)/2 cos λ] (b - l_M)/2 sin λ.

    Parameters
    ----------
    usable_width : float
        b [m], see `usable_width`.
    middle_roll_length : float
        l_M [m], from 0 to b. 0 gives the trough of two or four rolls.
    trough_angle : float
        λ of the outer rolls [rad], from 0 (flat belt) to below pi/2.
    surcharge_angle : float
        β, dynamic slope of the heap [rad], from 0 to below pi/2.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`.

    Returns
    -------
    CrossSection
        Its two parts [m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Level belt; `heap_on_slope` has others. The parabola of the heap is the standard's approximation for moderate β. The
    standard has up to three rolls; of four and five every wing adds (w + l cos λ) l sin λ below the water line, w being
    what lies inside of it across (derived).

    Examples
    --------
    >>> s = cross_section(
    ...     1.03, middle_roll_length=0.436, trough_angle=math.radians(45), surcharge_angle=math.radians(20)
    ... )
    >>> round(s.top, 4), round(s.bottom, 4)
    (0.0445, 0.1357)
    """
    require_angle(0.0, surcharge_angle=surcharge_angle)
    across, bottom = middle_roll_length, 0.0
    for length, angle in wing_pieces(
        usable_width, middle_roll_length=middle_roll_length, trough_angle=trough_angle, inner_wing=inner_wing
    ):
        beside = length * math.cos(angle)
        bottom += (across + beside) * length * math.sin(angle)
        across += 2.0 * beside
    return CrossSection(top=across**2 * math.tan(surcharge_angle) / 6.0, bottom=bottom)


def filled_width(
    area: float,
    *,
    middle_roll_length: float,
    trough_angle: float,
    surcharge_angle: float,
    inner_wing: Wing = NO_WING,
) -> float:
    """Width of belt under a given cross-section of bulk: `cross_section` solved for b (ISO 5048).

    With x = b - l_M: x² (cos²λ tan β/6 + cos λ sin λ/4) + x (l_M cos λ tan β/3 + l_M sin λ/2) + l_M² tan β/6 = A;
    a heap narrower than l_M has A = b² tan β/6.

    Parameters
    ----------
    area : float
        A of the bulk [m²], positive.
    middle_roll_length : float
        l_M [m], at least 0.
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2.
    surcharge_angle : float
        β, dynamic slope of the heap [rad], from 0 to below pi/2.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`: filled, they and the
        middle
        are to the outer wings a level middle as wide as they are across.

    Returns
    -------
    float
        b [m], along the belt; the same slope of the heap at every filling.

    Raises
    ------
    InputError
        An argument is outside its range, or a flat belt without a slope holds nothing.

    Examples
    --------
    >>> trough = {"middle_roll_length": 0.436, "trough_angle": 0.7853982, "surcharge_angle": 0.3490659}
    >>> round(filled_width(cross_section(1.03, **trough).area, **trough), 12)
    1.03
    """
    require_positive(area=area)
    require_not_negative(middle_roll_length=middle_roll_length, inner_wing_length=inner_wing.length)
    require_angle(0.0, trough_angle=trough_angle, surcharge_angle=surcharge_angle)
    if inner_wing.length > 0.0:
        inside = middle_roll_length + 2.0 * inner_wing.length
        full = cross_section(
            inside,
            middle_roll_length=middle_roll_length,
            trough_angle=inner_wing.angle,
            surcharge_angle=surcharge_angle,
        )
        if area <= full.area:
            return filled_width(
                area,
                middle_roll_length=middle_roll_length,
                trough_angle=inner_wing.angle,
                surcharge_angle=surcharge_angle,
            )
        level = middle_roll_length + 2.0 * inner_wing.length * math.cos(inner_wing.angle)
        beyond = filled_width(
            area - full.bottom,
            middle_roll_length=level,
            trough_angle=trough_angle,
            surcharge_angle=surcharge_angle,
        )
        return inside + (beyond - level)
    sine, cosine, steepness = math.sin(trough_angle), math.cos(trough_angle), math.tan(surcharge_angle)
    middle = middle_roll_length
    over_middle = middle**2 * steepness / 6.0
    if area <= over_middle:
        return math.sqrt(6.0 * area / steepness)
    square = cosine**2 * steepness / 6.0 + cosine * sine / 4.0
    linear = middle * (cosine * steepness / 3.0 + sine / 2.0)
    require(square > 0.0, "surcharge_angle", surcharge_angle, "> 0: a flat belt carries a heap only")
    root = math.sqrt(linear**2 + 4.0 * square * (area - over_middle))
    return middle + 2.0 * (area - over_middle) / (linear + root)


class BulkSpread(NamedTuple):
    """Width of belt under a cross-section of bulk [m] and surcharge angle of its heap [rad]."""

    width: float
    surcharge_angle: float


def spread_bulk(
    area: float,
    *,
    belt_width: float,
    middle_roll_length: float,
    trough_angle: float,
    surcharge_angle: float,
    inner_wing: Wing = NO_WING,
) -> BulkSpread:
    """Width of belt under a cross-section and slope of its heap: `filled_width` as far as the belt's edges.

    Bulk beyond a heap of its own slope from edge to edge makes a steeper heap on the whole belt:
    tan β = 6 (A - A_bottom)/W², W the width of the trough across (`cross_section` solved for β).

    Parameters
    ----------
    area : float
        A of the bulk [m²], positive.
    belt_width : float
        B [m], positive, at least l_M.
    middle_roll_length : float
        l_M [m], at least 0.
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2.
    surcharge_angle : float
        β, dynamic slope of the heap [rad], from 0 to below pi/2.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`.

    Returns
    -------
    BulkSpread
        Its width, at most B, and its slope, at least β.

    Raises
    ------
    InputError
        An argument is outside its range, or a flat belt without a slope holds nothing.

    Notes
    -----
    Derived. Steeper than the bulk's own slope it does not stay: such a belt spills, and its check fails.

    Examples
    --------
    >>> trough = {"middle_roll_length": 0.4, "trough_angle": 0.6, "surcharge_angle": 0.3}
    >>> full = cross_section(1.0, **trough).area
    >>> [round(figure, 9) for figure in spread_bulk(full, belt_width=1.0, **trough)]
    [1.0, 0.3]
    >>> [round(figure, 3) for figure in spread_bulk(1.2 * full, belt_width=1.0, **trough)]
    [1.0, 0.492]
    """
    require_positive(belt_width=belt_width)
    trough: _Trough = {
        "middle_roll_length": middle_roll_length,
        "trough_angle": trough_angle,
        "inner_wing": inner_wing,
    }
    width = filled_width(area, surcharge_angle=surcharge_angle, **trough)
    if width <= belt_width:
        return BulkSpread(width, surcharge_angle)
    pieces = wing_pieces(belt_width, **trough)
    across = middle_roll_length + 2.0 * math.fsum(wing.length * math.cos(wing.angle) for wing in pieces)
    level = cross_section(belt_width, surcharge_angle=0.0, **trough).bottom
    return BulkSpread(belt_width, math.atan(6.0 * (area - level) / across**2))


class _Trough(TypedDict):
    """Shape of a set's trough."""

    middle_roll_length: float
    trough_angle: float
    inner_wing: Wing
