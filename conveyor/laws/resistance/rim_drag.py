"""Drag of a roll at its rim, from its bearings and seals or from the maker's line.

Sources: Palmgren (moments of the bearings, see `roll_bearing`); acceptance limits of idler rolls.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.errors import InputError, MessageQuantity
from conveyor.laws.resistance.roll_bearing import (
    PER_MINUTE,
    bearing_load_factor,
    bearing_load_moment,
    bearing_no_load_moment,
)

TEST_LOAD: Final = 250.0  # [N], load at which rolls are accepted
TEST_ROTATION: Final = 650.0 / PER_MINUTE  # [1/s], speed at which rolls are accepted


def roll_rotation(belt_speed: float, *, roll_diameter: float) -> float:
    """Revolutions of a roll per time, n = v/(π D).

    Parameters
    ----------
    belt_speed : float
        v [m/s], at least 0.
    roll_diameter : float
        D [m], positive.

    Returns
    -------
    float
        n [1/s], revolutions.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(60 * roll_rotation(5.0, roll_diameter=0.159), 1)
    600.6
    """
    require_not_negative(belt_speed=belt_speed)
    require_positive(roll_diameter=roll_diameter)
    return belt_speed / (math.pi * roll_diameter)


@dataclass(frozen=True, slots=True)
class RollDragParts:
    """Drag of one roll at its rim, by cause.

    Parameters
    ----------
    no_load : float
        Viscous part of the two bearings [N].
    load : float
        Load part of the two bearings [N].
    seals : float
        Seals of both ends [N].
    """

    no_load: float
    load: float
    seals: float

    @property
    def force(self) -> float:
        """Whole drag at the rim [N]."""
        return self.no_load + self.load + self.seals


def bearing_roll_drag(
    roll_load: float,
    *,
    belt_speed: float,
    roll_diameter: float,
    mean_diameter: float,
    viscosity: float,
    static_rating: float,
    f0: float,
    f1_factor: float,
    f1_exponent: float,
    seal_moment: float,
) -> RollDragParts:
    """Drag of a roll on two equal bearings, F = 2 [M0 + M1(P/2) + M_seal]/(D/2) (Palmgren).

    Parameters
    ----------
    roll_load : float
        P, radial, of both bearings together [N], at least 0.
    belt_speed : float
        v [m/s], at least 0.
    roll_diameter : float
        D [m], positive.
    mean_diameter : float
        d_m of a bearing, (bore + outside)/2 [m], positive, less than D.
    viscosity : float
        ν of the base oil at the running temperature [m²/s], positive.
    static_rating : float
        C0 of a bearing [N], positive.
    f0 : float
        f0 [-], at least 0.
    f1_factor : float
        z in f1 = z (P0/C0)^y [-], at least 0.
    f1_exponent : float
        y in it [-], at least 0.
    seal_moment : float
        M_seal of one end [N m], at least 0: given by the maker, or from `labyrinth_moment`.

    Returns
    -------
    RollDragParts
        Drag at the rim [N] by cause.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Load shared equally by the bearings. The bearing's temperature is the ambient one plus its own heating, which
    is not computed: the viscosity at the ambient temperature is on the safe side, in the cold by a multiple (an oil
    of 100 mm²/s at 40 degC gives 1.0 N there, 7 N at 0 degC, 34 N at -20 degC for a 159 mm roll at 5 m/s). Cold
    running needs a measured drag or the bearing's own temperature, as `service_roll_drag` solves it.

    Examples
    --------
    >>> drag = bearing_roll_drag(
    ...     250.0,
    ...     belt_speed=5.4,
    ...     roll_diameter=0.159,
    ...     mean_diameter=0.051,
    ...     viscosity=100e-6,
    ...     static_rating=16e3,
    ...     f0=2.0,
    ...     f1_factor=0.0009,
    ...     f1_exponent=0.55,
    ...     seal_moment=0.01,
    ... )
    >>> round(drag.no_load, 2), round(drag.load, 3), round(drag.seals, 3), round(drag.force, 2)
    (1.08, 0.01, 0.252, 1.34)
    """
    require_not_negative(roll_load=roll_load, seal_moment=seal_moment)
    rotation = roll_rotation(belt_speed, roll_diameter=roll_diameter)
    require(0.0 < mean_diameter < roll_diameter, "mean_diameter", mean_diameter, "> 0 and < D")
    no_load = bearing_no_load_moment(f0, viscosity=viscosity, rotation=rotation, mean_diameter=mean_diameter)
    each = roll_load / 2.0
    f1 = bearing_load_factor(each, static_rating=static_rating, factor=f1_factor, exponent=f1_exponent)
    loaded = bearing_load_moment(f1, load=each, mean_diameter=mean_diameter)
    both_at_rim = 2.0 / (roll_diameter / 2.0)
    return RollDragParts(no_load=no_load * both_at_rim, load=loaded * both_at_rim, seals=seal_moment * both_at_rim)


def linear_roll_drag(
    reference_drag: float,
    *,
    load: float,
    rotation: float,
    load_slope: float,
    rotation_slope: float,
    reference_load: float = TEST_LOAD,
    reference_rotation: float = TEST_ROTATION,
) -> float:
    """Drag of a roll from a measured drag, F = F_ref + c_P (P - P_ref) + c_n (n - n_ref), as makers publish it.

    Parameters
    ----------
    reference_drag : float
        F_ref at the rim, measured [N], at least 0.
    load : float
        P on the roll [N], at least 0.
    rotation : float
        n, revolutions [1/s], at least 0.
    load_slope : float
        c_P [N/N], at least 0.
    rotation_slope : float
        c_n [N s], at least 0.
    reference_load : float
        P_ref of the measurement [N], at least 0; 250 N is the acceptance test's.
    reference_rotation : float
        n_ref of the measurement, revolutions [1/s], at least 0; 650/60 is the acceptance test's.

    Returns
    -------
    float
        F at the rim [N].

    Raises
    ------
    InputError
        An argument is outside its range, or the line falls below zero there.

    Notes
    -----
    A straight line through measured points; nothing is known beyond them.

    Examples
    --------
    >>> round(linear_roll_drag(2.0, load=1250.0, rotation=650 / 60, load_slope=0.0005, rotation_slope=0.0), 6)
    2.5
    """
    require_not_negative(reference_drag=reference_drag, load=load, rotation=rotation)
    require_not_negative(load_slope=load_slope, rotation_slope=rotation_slope)
    require_not_negative(reference_load=reference_load, reference_rotation=reference_rotation)
    drag = reference_drag + load_slope * (load - reference_load)
    drag += rotation_slope * (rotation - reference_rotation)
    if drag < 0.0:
        raise InputError(
            "reference_drag: got {}, its line gives {} at {} and {}; give smaller slopes or a measurement nearer by",
            MessageQuantity(reference_drag, "force", f"{reference_drag!r}"),
            MessageQuantity(drag, "force", f"{drag:.3g} N"),
            MessageQuantity(load, "force", f"{load:g} N"),
            MessageQuantity(rotation, "rotation", f"{rotation:g} 1/s"),
        )
    return drag
