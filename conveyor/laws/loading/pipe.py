"""Loads of the six rolls of a pipe conveyor's panel: weights, tension in curves and the belt's own stiffness."""

from __future__ import annotations

import math
from typing import Final

from conveyor.arguments.limits import (
    require,
    require_angle,
    require_finite,
    require_not_negative,
    require_positive,
)
from conveyor.laws.loading.pipe_strip import pipe_strip_forces
from conveyor.laws.loading.roll_loading import RollLoad

__all__ = ["PIPE_ROLLS", "pipe_area", "pipe_roll_loads"]

PIPE_ROLLS: Final = ("upper left", "lower left", "bottom", "lower right", "upper right", "top")
"""Places of the rolls of a panel: 60 deg apart, one below."""


def pipe_area(diameter: float, *, filling: float = 1.0) -> float:
    """Cross-section of the bulk in a pipe, φ π D²/4.

    Parameters
    ----------
    diameter : float
        D inside the belt [m], positive.
    filling : float
        φ, from 0 to 1 [-].

    Returns
    -------
    float
        Area [m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(pipe_area(0.4, filling=0.75), 4)
    0.0942
    """
    require_positive(diameter=diameter)
    require(0.0 <= filling <= 1.0, "filling", filling, ">= 0 and <= 1")
    return filling * math.pi * diameter**2 / 4.0


def pipe_roll_loads(
    *,
    bulk_line_mass: float,
    belt_line_mass: float,
    spacing: float,
    diameter: float,
    carcass_radius: float,
    half_angle: float,
    transverse_stiffness: float,
    filling: float,
    roll_length: float,
    inclination: float,
    gravity: float,
    curve_down: float = 0.0,
    curve_right: float = 0.0,
) -> tuple[RollLoad, ...]:
    """Load of each of the six rolls of a panel: the belt as an elastic strip under weights and tension in curves.

    Parameters
    ----------
    bulk_line_mass, belt_line_mass : float
        m' of bulk and belt [kg/m], at least 0.
    spacing : float
        a of the panels [m], positive.
    diameter : float
        D of the pipe inside the belt [m], positive.
    carcass_radius : float
        R of its carcass [m], positive, see `pipe_strip_distance`.
    half_angle : float
        B/(2 R) of the belt's width on that circle [rad], from 2 to below 2 pi.
    transverse_stiffness : float
        Bending stiffness across the belt, over its length [N m²/m], positive.
    filling : float
        Cross-section of the bulk over that of the pipe [-], above 0 to 1; not used without bulk.
    roll_length : float
        Of each roll [m], positive.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.
    curve_down, curve_right : float
        Forces of the belt's tension on one panel of a vertical and a horizontal curve [N], negative upward and to the
        left, see `curve_set_force`.

    Returns
    -------
    tuple of RollLoad
        By `PIPE_ROLLS`; 0 on rolls that the belt does not touch. The parts of the forces across the slope add up to
        (m'_bulk + m'_belt) g cos δ a + F_down, those to the right to F_right. `belt_force` is that of the empty belt
        or, where bulk relieves the roll, what is left of it.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    See `pipe_strip_forces`. Tension spread evenly round the pipe pulls strip by strip in the plane of the curve, as
    weight does. Each roll bears over a sixth of the pipe's circumference, evenly.

    Examples
    --------
    >>> loads = pipe_roll_loads(
    ...     bulk_line_mass=53.4,
    ...     belt_line_mass=39.6,
    ...     spacing=1.2,
    ...     diameter=0.38,
    ...     carcass_radius=0.2005,
    ...     half_angle=3.641,
    ...     transverse_stiffness=10.0,
    ...     filling=0.6,
    ...     roll_length=0.23,
    ...     inclination=0.0,
    ...     gravity=9.81,
    ... )
    >>> [round(load.force) for load in loads]
    [40, 732, 889, 732, 40, 486]
    """
    require_not_negative(bulk_line_mass=bulk_line_mass, belt_line_mass=belt_line_mass)
    require_positive(
        spacing=spacing,
        diameter=diameter,
        carcass_radius=carcass_radius,
        transverse_stiffness=transverse_stiffness,
        roll_length=roll_length,
        gravity=gravity,
    )
    require_angle(-math.pi / 2.0, inclination=inclination)
    require_finite(curve_down=curve_down, curve_right=curve_right)
    weight = gravity * math.cos(inclination) * spacing
    forming = transverse_stiffness * spacing / carcass_radius**2
    on_belt = (curve_right, -belt_line_mass * weight - curve_down)
    empty = whole = pipe_strip_forces(half_angle, forming, belt=on_belt)
    if bulk_line_mass > 0.0:
        whole = pipe_strip_forces(half_angle, forming, belt=on_belt, bulk=bulk_line_mass * weight, filling=filling)
    length = min(roll_length, math.pi * diameter / 6.0)
    return tuple(
        RollLoad(
            name=name, bulk_force=force - min(force, bare), belt_force=min(force, bare), length=length, shape="uniform"
        )
        for name, force, bare in zip(PIPE_ROLLS, whole, empty, strict=True)
    )
