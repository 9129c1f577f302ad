"""Least radii of a pipe conveyor's curves by rule of thumb, and the reach of its strips from the middle.

Source: conveyorbeltguide.com/pipe-belts.html, rules of thumb (read November 2026); they do not tell vertical from
horizontal curves.
"""

from __future__ import annotations

from typing import Final

from conveyor.arguments.limits import require_not_negative, require_positive

PIPE_RADIUS: Final = {"textile": 300.0, "steel cord": 600.0}
"""Least radius of a curve over the diameter of the pipe [-], by carcass; conveyorbeltguide.com/pipe-belts.html."""


def least_pipe_radius(diameter: float, *, steel_cord: bool) -> float:
    """Least radius of a pipe conveyor's curve, r = 300 D of textile belts, 600 D of steel cord.

    Parameters
    ----------
    diameter : float
        D of the pipe [m], positive.
    steel_cord : bool
        Carcass of steel cord; every other counts as textile [-].

    Returns
    -------
    float
        r [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> least_pipe_radius(0.4, steel_cord=True)
    240.0
    """
    require_positive(diameter=diameter)
    return PIPE_RADIUS["steel cord" if steel_cord else "textile"] * diameter


def pipe_strip_distance(diameter: float, *, cover_thickness: float, carcass_thickness: float) -> float:
    """Distance of the carcass from the middle of the pipe, D/2 + h_cover + h_carcass/2 (geometry).

    Parameters
    ----------
    diameter : float
        D of the pipe inside the belt [m], positive.
    cover_thickness : float
        h_cover of the cover inside the pipe [m], at least 0.
    carcass_thickness : float
        h_carcass [m], at least 0.

    Returns
    -------
    float
        d [m], of the strip that a curve stretches most and of the one that it slackens most, in `overstress_radius` and
        `buckling_radius`.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Plane sections of a round pipe; the overlap, which moves the middle a little to itself, is left out.

    Examples
    --------
    >>> round(pipe_strip_distance(0.4, cover_thickness=0.006, carcass_thickness=0.004), 4)
    0.208
    """
    require_positive(diameter=diameter)
    require_not_negative(cover_thickness=cover_thickness, carcass_thickness=carcass_thickness)
    return 0.5 * (diameter + carcass_thickness) + cover_thickness
