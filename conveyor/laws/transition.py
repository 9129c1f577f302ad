"""Transitions: stretch of the strips of a belt between a flat pulley and the first full trough.

Sources: ISO 5293:2004, L = h/sin λ (M/ΔT (1 - cos λ))^0.5 with h = w sin λ (formula as commonly reproduced): the edge's
straight way against that of the middle. Here it is taken on to every strip and to a raised pulley, and the mean of the
strips is that of the belt (derived; Beckley, Belt conveyor transition geometry, Bulk Solids Handling 2 (1982), assumes
the same).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.laws.loading import NO_WING, Wing, wing_pieces

EDGE_OVER_RATED: Final = 1.3
"""Tension of the edges over the belt's rated one, at most [-]; ISO 5293."""
HALF_TROUGH: Final = 0.5
"""Top of the pulley over the middle roll, over the depth of the trough [-]."""


@dataclass(frozen=True, slots=True)
class TransitionStretch:
    """Elongation of strips over the mean, times the length of the transition squared [m²].

    Parameters
    ----------
    edge, middle : float
        Of the belt's edges and of what lies on the middle roll.
    least : float
        Of the strip that is stretched least: the middle, or with a raised pulley one in the wing.
    """

    edge: float
    middle: float
    least: float

    @property
    def largest(self) -> float:
        """Value of the most stretched strip [m²]."""
        return max(self.edge, self.middle)


def transition_stretch(
    belt_width: float,
    *,
    middle_roll_length: float,
    trough_angle: float,
    pulley_height: float,
    inner_wing: Wing = NO_WING,
) -> TransitionStretch:
    """Stretch of strips straight from pulley to trough: ε L² = s² (1 - cos λ) - s H sin λ + H²/2, less its mean.

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    middle_roll_length : float
        l_M, belt on the middle roll [m], from 0 (two or four rolls) to B (flat).
    trough_angle : float
        λ of the outer rolls of the first full set [rad], from 0 to below pi/2.
    pulley_height : float
        H, top of the pulley over the middle roll, over the depth of the trough w sin λ [-], from 0 (full trough) to 1;
        0.5 is half trough.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`; not steeper than λ.

    Returns
    -------
    TransitionStretch
        Over the mean of the belt's width [m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    w = (B - l_M)/2, s from 0 at the bend to w at the edge. A strip rises s sin λ - H and moves inwards s (1 - cos λ)
    over the length L; ε to its first order in (w/L)², whose next is below 1 % for L > 2 B. Past an inner wing what it
    rises and moves by there goes before. Shear between strips, which evens them out, and what reaches beyond pulley and
    set are left out: on the safe side.

    Examples
    --------
    >>> full = transition_stretch(1.2, middle_roll_length=0.4, trough_angle=math.radians(35), pulley_height=0.0)
    >>> half = transition_stretch(1.2, middle_roll_length=0.4, trough_angle=math.radians(35), pulley_height=0.5)
    >>> round(full.edge, 5), round(full.middle, 5), round(half.edge, 5), round(half.middle, 5)
    (0.02251, -0.00643, 0.00496, 0.00234)
    """
    require(0.0 <= pulley_height <= 1.0, "pulley_height", pulley_height, ">= 0 and <= 1")
    pieces = wing_pieces(
        belt_width, middle_roll_length=middle_roll_length, trough_angle=trough_angle, inner_wing=inner_wing
    )
    height = pulley_height * math.fsum(wing.length * math.sin(wing.angle) for wing in pieces)
    moved, risen, stretch, whole, least = 0.0, 0.0, 0.0, 0.0, 0.0
    for wing, angle in pieces:
        # ε L² at t beyond the last bend: stretch + slope t + square t²
        square = 2.0 * math.sin(0.5 * angle) ** 2  # 1 - cos λ
        slope = moved * square + (risen - height) * math.sin(angle)
        whole += wing * (stretch + wing * (slope / 2.0 + wing * square / 3.0))
        lowest = min(max(-0.5 * slope, 0.0), square * wing)  # over the square: s = H sin λ/(2 (1 - cos λ))
        if square > 0.0:
            least = min(least, stretch + lowest * (slope + lowest) / square)
        stretch += wing * (slope + wing * square)
        moved, risen = moved + wing * square, risen + wing * math.sin(angle)
    mean = 2.0 * whole / belt_width
    return TransitionStretch(edge=stretch - mean, middle=-mean, least=least - mean)


def transition_length(
    tension_per_width: float, *, stretch: float, stiffness_per_width: float, limit_per_width: float
) -> float:
    """Least length that keeps a strip within its limit, L = sqrt(E ε L²/(k_lim - k)).

    Parameters
    ----------
    tension_per_width : float
        k, mean of the belt in the transition [N/m], at least 0.
    stretch : float
        ε L² of the strip over the mean [m²], see `TransitionStretch`; negative of one that is slackened.
    stiffness_per_width : float
        E of the belt per width [N/m], positive.
    limit_per_width : float
        k_lim [N/m]: the highest of a stretched strip, the lowest of a slackened one.

    Returns
    -------
    float
        L [m]; 0 of a strip that is neither, infinite where no length helps.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> transition_length(100e3, stretch=0.02, stiffness_per_width=72e6, limit_per_width=140e3)
    6.0
    """
    require(0.0 <= tension_per_width < math.inf, "tension_per_width", tension_per_width, ">= 0")
    require_positive(stiffness_per_width=stiffness_per_width)
    require(math.isfinite(limit_per_width), "limit_per_width", limit_per_width, "finite")
    if stretch == 0.0:
        return 0.0
    room = (limit_per_width - tension_per_width) * math.copysign(1.0, stretch)
    return math.sqrt(stiffness_per_width * abs(stretch) / room) if room > 0.0 else math.inf


CEMA_TRANSITIONS: Final = {
    "full trough": {
        20: ((1.8, 4.0), (1.6, 3.2), (1.2, 2.8)),
        35: ((3.2, 6.8), (2.4, 5.2), (1.8, 3.6)),
        45: ((4.0, 8.0), (3.2, 6.4), (2.4, 4.4)),
    },
    "half trough": {
        20: ((0.9, 2.0), (0.8, 1.6), (0.6, 1.0)),
        35: ((1.6, 3.4), (1.2, 2.6), (0.9, 1.8)),
        45: ((2.0, 4.0), (1.6, 3.2), (1.2, 2.2)),
    },
}
"""CEMA's least transition over the belt's width [-], by depth and angle of the trough [deg]: above 90 %, from 60 to
90 % and below 60 % of the rated tension, of fabric and of steel-cord belts. Full trough: CEMA 7, table 7.29 (read on
scribd.com/document/408694938); half trough: as reproduced without an edition (scribd.com/document/519435550)."""
_SAME_ANGLE: Final = 0.5  # of the tables' [deg]
_CEMA_SHARES: Final = (0.9, 0.6)  # of the rated tension, between the rows of the table


def cema_transition_length(
    belt_width: float, *, trough_angle: float, utilisation: float, carcass: str, pulley_height: float
) -> float | None:
    """Least transition that CEMA recommends.

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    trough_angle : float
        Of the outer rolls of the first full set [rad].
    utilisation : float
        Tension in the transition over the belt's rated one [-], at least 0.
    carcass : str
        Its material; all but "steel cord" count as fabric.
    pulley_height : float
        Top of the pulley over the middle roll, over the depth of the trough [-], from 0 to 1; the half trough's table
        from 0.5 on, on the safe side beyond.

    Returns
    -------
    float or None
        L [m]; None at an angle that the tables do not have (20, 35 and 45 deg).

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> full = {"trough_angle": math.radians(35), "carcass": "EP", "pulley_height": 0.0}
    >>> round(cema_transition_length(1.0, utilisation=0.4, **full), 3)
    1.8
    """
    require_positive(belt_width=belt_width)
    require_not_negative(utilisation=utilisation)
    require(0.0 <= pulley_height <= 1.0, "pulley_height", pulley_height, ">= 0 and <= 1")
    table = CEMA_TRANSITIONS["half trough" if pulley_height >= HALF_TROUGH else "full trough"]
    angle = next((one for one in table if abs(math.degrees(trough_angle) - one) < _SAME_ANGLE), None)
    if angle is None:
        return None
    row = sum(utilisation <= share for share in _CEMA_SHARES)
    return table[angle][row][carcass == "steel cord"] * belt_width
