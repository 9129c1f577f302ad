"""Tensions that the strips of the belt may have, and the radii of curves that keep to them."""

from __future__ import annotations

import math
from typing import NamedTuple

from conveyor.laws.belt_strength import CLASSIC_SAFETY
from conveyor.laws.vertical_curve import buckling_radius, overstress_radius
from conveyor.line.line import Line

LEAST_EDGE_TENSION = 4.5e3
"""Least tension per width of a strip slackened by a curve [N/m]; general knowledge."""


class StripLimits(NamedTuple):
    """Least radii of a curve and tensions of its strips; None where stiffness or strength are unknown.

    Attributes
    ----------
    overstress, buckling : float or None
        Least radii at which no strip is overstressed or slack [m]; infinite where none helps.
    most, least : float or None
        Highest and lowest tension of a strip [N/m].
    """

    overstress: float | None = None
    buckling: float | None = None
    most: float | None = None
    least: float | None = None


def classic_safety(line: Line) -> float:
    """Classic safety of the belt in steady running, DIN 22101:1982 [-]."""
    return CLASSIC_SAFETY["steel cord" if line.belt.steel_cord else "textile"]


def allowed_tension(line: Line) -> float | None:
    """Rated tension per width [N/m]; None without strength and rating."""
    belt = line.belt
    return belt.rating if belt.strength is None else belt.strength / classic_safety(line)


def strip_limits(
    line: Line, lowest: float, highest: float, *, radius: float, stretched: float, slackened: float,
    least_tension: float = LEAST_EDGE_TENSION,
) -> StripLimits:  # fmt: skip
    """Limits of a curve for its strips.

    Parameters
    ----------
    line : Line
        The conveyor.
    lowest, highest : float
        Mean tensions per width that occur in the curve [N/m].
    radius : float
        Of the curve [m].
    stretched, slackened : float
        Distances of the strips that it stretches and slackens most from the belt's middle [m].
    least_tension : float
        Least tension per width of a strip [N/m].
    """
    allowed, stiffness = allowed_tension(line), line.belt.tensile_stiffness
    if allowed is None or stiffness is None:
        return StripLimits()
    over = math.inf
    if highest < allowed:
        over = overstress_radius(
            max(0.0, highest), distance=stretched, stiffness_per_width=stiffness, allowed_per_width=allowed
        )
    slack = taut_radius(lowest, slackened, stiffness, least_tension)
    turned = stiffness / radius
    return StripLimits(over, slack, highest + turned * stretched, lowest - turned * slackened)


def taut_radius(lowest: float, slackened: float, stiffness: float, least: float) -> float:
    """Least radius at which the strip at a distance [m] keeps the least tension per width; infinite where none does."""
    if lowest <= least:
        return math.inf
    return buckling_radius(lowest, distance=slackened, stiffness_per_width=stiffness, least_per_width=least)
