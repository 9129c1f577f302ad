"""Curves and forming lengths of a pipe: least ones by rule of thumb, and the stretch of its strips, derived.

Source of the rules: conveyorbeltguide.com/pipe-belts.html (read November 2026); they do not tell vertical from
horizontal curves, nor carcasses in the forming length.
"""

from __future__ import annotations

import math
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.laws.transition import TransitionStretch

PIPE_RADIUS: Final = {"textile": 300.0, "steel cord": 600.0}
"""Least radius of a curve over the diameter of the pipe [-], by carcass; conveyorbeltguide.com/pipe-belts.html."""

FORMING_LENGTH: Final = 55.0
"""Least way from the flat belt to the pipe over its diameter [-]; conveyorbeltguide.com/pipe-belts.html."""
LEAST_LAP: Final = 0.1
"""Least lap over the circumference of the carcass [-]: usual ones are 15 to 27 % (general knowledge); at less than this
an empty pipe leaves a roll untouched, however stiff its belt, see `least_pipe_stiffness`."""
FURTHEST_LAP: Final = 2.0
"""Width of the belt over the circumference of the pipe, below which it laps once [-]; geometry."""


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


def pipe_roll_lengths(diameter: float, *, outer_radius: float, offset: bool) -> tuple[float, float]:
    """Least and largest length of the six rolls of a panel, π D/6 and the side of the polygon round the pipe.

    Parameters
    ----------
    diameter : float
        D of the pipe inside the belt [m], positive.
    outer_radius : float
        r of the pipe outside of the belt [m], positive.
    offset : bool
        True where every other roll stands behind the panel, so that three meet in each plane [-].

    Returns
    -------
    tuple of float
        A sixth of the circumference, over which a roll bears in `pipe_roll_loads`; 2 r tan(30 deg), or 2 r tan(60 deg)
        of three rolls in a plane [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Geometry; the diameter of the rolls, whose ends meet a little earlier, is left out.

    Examples
    --------
    >>> [round(one, 3) for one in pipe_roll_lengths(0.38, outer_radius=0.208, offset=False)]
    [0.199, 0.24]
    """
    require_positive(diameter=diameter, outer_radius=outer_radius)
    return math.pi * diameter / 6.0, 2.0 * outer_radius * math.tan(math.pi / (3.0 if offset else 6.0))


def forming_length(diameter: float) -> float:
    """Least way from the flat belt to the pipe, L = 55 D.

    Parameters
    ----------
    diameter : float
        D of the pipe [m], positive.

    Returns
    -------
    float
        L [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> forming_length(0.4)
    22.0
    """
    require_positive(diameter=diameter)
    return FORMING_LENGTH * diameter


def pipe_transition_stretch(belt_width: float, *, diameter: float, pulley_height: float) -> TransitionStretch:
    """Stretch of strips straight from pulley to pipe, ε L² = r²/2 ((φ - sin φ)² + (1 - cos φ - h)²), less its mean.

    Parameters
    ----------
    belt_width : float
        B [m], positive, below `FURTHEST_LAP` circumferences.
    diameter : float
        D of the pipe that the belt lies round [m], positive.
    pulley_height : float
        Top of the pulley over the bottom of the pipe, over D [-], from 0 to 1.

    Returns
    -------
    TransitionStretch
        Over the mean of the belt's width [m²]; `middle` is its middle line.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    r = D/2, h the pulley's height over r. A strip at s = r φ from the middle ends r sin φ beside it and r (1 - cos φ)
    over the bottom of the pipe; ε to its first order as in `transition_stretch`. Its least is where φ tan(φ/2) = h. The
    mean over 0 to φ_B = B/(2 r) is the closed integral of the squares. The overlap lies on the same circle, shear
    between strips, which evens them out, is left out: on the safe side.

    Examples
    --------
    >>> flat = pipe_transition_stretch(1.46, diameter=0.38, pulley_height=0.5)
    >>> round(flat.edge, 4), round(flat.middle, 4), round(flat.least, 4)
    (0.2886, -0.0673, -0.082)
    """
    require_positive(belt_width=belt_width, diameter=diameter)
    require(0.0 <= pulley_height <= 1.0, "pulley_height", pulley_height, ">= 0 and <= 1")
    lapping = FURTHEST_LAP * math.pi * diameter
    require(belt_width < lapping, "belt_width", belt_width, f"< {lapping:.6g} m, {FURTHEST_LAP:g} circumferences")
    r, h, edge = 0.5 * diameter, 2.0 * pulley_height, belt_width / diameter

    def squares(phi: float) -> float:
        return (phi - math.sin(phi)) ** 2 + (1.0 - math.cos(phi) - h) ** 2

    whole = edge**3 / 3.0 - 2.0 * (math.sin(edge) - edge * math.cos(edge)) + edge
    whole += (1.0 - h) ** 2 * edge - 2.0 * (1.0 - h) * math.sin(edge)
    mean = whole / edge
    made = (squares(edge), squares(0.0), squares(min(_least_strip(h), edge)))
    return TransitionStretch(*(0.5 * r**2 * (one - mean) for one in made))


def _least_strip(height: float) -> float:
    """Angle φ of the strip stretched least, φ tan(φ/2) = h [rad]: the left side rises from 0 to infinity before π."""
    from scipy.optimize import brentq  # 0.4 s that a conveyor without a pipe does not pay

    return float(brentq(lambda phi: phi * math.sin(0.5 * phi) - height * math.cos(0.5 * phi), 0.0, math.pi))
