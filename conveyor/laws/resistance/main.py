"""Main, secondary (as a factor) and slope resistance: the whole-conveyor methods.

Sources: DIN 22101, ISO 5048.
"""

from __future__ import annotations

import math
import warnings
from typing import Final

import numpy as np

from conveyor.arguments.limits import require_finite, require_not_negative, require_positive, require_slope
from conveyor.errors import RangeError, ValidityWarning

SHORTEST_FOR_FACTOR: Final = 80.0  # [m], ISO 5048: below, itemise the secondary resistances

# ISO 5048, DIN 22101: coefficient C over the conveyor length L [m]
# fmt: off
LENGTH_COEFFICIENTS: Final = (
    (3.0, 9.0), (4.0, 7.6), (6.0, 5.9), (10.0, 4.5), (16.0, 3.6), (20.0, 3.2), (25.0, 2.9), (32.0, 2.6),
    (40.0, 2.4), (50.0, 2.2), (63.0, 2.0), (80.0, 1.92), (90.0, 1.86), (100.0, 1.78), (120.0, 1.70),
    (140.0, 1.63), (160.0, 1.56), (180.0, 1.50), (200.0, 1.45), (250.0, 1.38), (300.0, 1.31), (350.0, 1.27),
    (400.0, 1.25), (450.0, 1.22), (500.0, 1.20), (550.0, 1.18), (600.0, 1.17), (700.0, 1.14), (800.0, 1.12),
    (900.0, 1.10), (1000.0, 1.09), (1500.0, 1.06), (2000.0, 1.05), (2500.0, 1.04), (5000.0, 1.03),
)
# fmt: on


def roll_line_mass(set_mass: float, *, spacing: float) -> float:
    """Rotating mass of the idler sets per length, m'_R (ISO 5048).

    Parameters
    ----------
    set_mass : float
        Rotating mass of one set [kg], at least 0.
    spacing : float
        Distance of the sets [m], positive.

    Returns
    -------
    float
        m'_R [kg/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(roll_line_mass(15.5, spacing=1.2), 2)
    12.92
    """
    require_not_negative(set_mass=set_mass)
    require_positive(spacing=spacing)
    return set_mass / spacing


def section_main_resistance(
    *,
    friction_factor: float,
    length: float,
    roll_mass: float,
    belt_mass: float,
    bulk_mass: float,
    inclination: float,
    gravity: float,
) -> float:
    """Main resistance of one section of one strand (DIN 22101:2002).

    F_H,i = l f g (m'_R + (m'_belt + m'_bulk) cos δ).

    Parameters
    ----------
    friction_factor : float
        f [-], at least 0.
    length : float
        l [m], at least 0.
    roll_mass : float
        m'_R of this strand [kg/m], at least 0.
    belt_mass : float
        m'_belt [kg/m], at least 0.
    bulk_mass : float
        m'_bulk [kg/m], at least 0; 0 on the return strand.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F_H,i [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(
    ...     section_main_resistance(
    ...         friction_factor=0.02,
    ...         length=143.0,
    ...         roll_mass=4.4,
    ...         belt_mass=16.44,
    ...         bulk_mass=0.0,
    ...         inclination=0.0,
    ...         gravity=9.81,
    ...     ),
    ...     2,
    ... )
    584.7
    """
    require_not_negative(friction_factor=friction_factor, length=length)
    require_not_negative(roll_mass=roll_mass, belt_mass=belt_mass, bulk_mass=bulk_mass)
    require_slope(inclination=inclination)
    require_positive(gravity=gravity)
    return length * friction_factor * gravity * (roll_mass + (belt_mass + bulk_mass) * math.cos(inclination))


def main_resistance(
    *,
    friction_factor: float,
    length: float,
    carry_roll_mass: float,
    return_roll_mass: float,
    belt_mass: float,
    bulk_mass: float,
    inclination: float,
    gravity: float,
) -> float:
    """Main resistance of both strands of a conveyor (ISO 5048).

    F_H = f L g [m'_R,carry + m'_R,return + (2 m'_belt + m'_bulk) cos δ].

    Parameters
    ----------
    friction_factor : float
        f [-], at least 0; standard value `FRICTION_FACTOR`.
    length : float
        L, distance of the pulleys [m], at least 0.
    carry_roll_mass : float
        m'_R of the carry strand [kg/m], at least 0.
    return_roll_mass : float
        m'_R of the return strand [kg/m], at least 0.
    belt_mass : float
        m'_belt [kg/m], at least 0.
    bulk_mass : float
        m'_bulk [kg/m], at least 0.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F_H [N], both strands.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(
    ...     main_resistance(
    ...         friction_factor=0.02,
    ...         length=143.0,
    ...         carry_roll_mass=15.5 / 1.2,
    ...         return_roll_mass=4.4,
    ...         belt_mass=16.44,
    ...         bulk_mass=2300 / 3.6 / 4.8,
    ...         inclination=0.0,
    ...         gravity=9.81,
    ...     ),
    ...     2,
    ... )
    5142.73
    """
    require_not_negative(friction_factor=friction_factor, length=length)
    require_not_negative(carry_roll_mass=carry_roll_mass, return_roll_mass=return_roll_mass)
    require_not_negative(belt_mass=belt_mass, bulk_mass=bulk_mass)
    require_slope(inclination=inclination)
    require_positive(gravity=gravity)
    normal = (2.0 * belt_mass + bulk_mass) * math.cos(inclination)
    return friction_factor * length * gravity * (carry_roll_mass + return_roll_mass + normal)


def equivalent_friction_factor(main_force: float, *, unit_main_force: float) -> float:
    """Friction factor of DIN 22101's main resistance for the same force, f = F_H / F_H(f = 1).

    Parameters
    ----------
    main_force : float
        F_H from any other method (indentation + idler rotation + flexure) [N].
    unit_main_force : float
        F_H of the same conveyor at f = 1 [N], positive, from `main_resistance` or the sum of
        `section_main_resistance`.

    Returns
    -------
    float
        f [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> equivalent_friction_factor(120.0, unit_main_force=6000.0)
    0.02
    """
    require_finite(main_force=main_force)
    require_positive(unit_main_force=unit_main_force)
    return main_force / unit_main_force


def length_coefficient(length: float) -> float:
    """Coefficient C of the secondary resistances over the conveyor length (ISO 5048, DIN 22101).

    Parameters
    ----------
    length : float
        L [m], from 3 to 5000.

    Returns
    -------
    float
        C [-], linear in ln L between the nodes of the table, so it meets each node and falls monotonically.

    Raises
    ------
    RangeError
        The length is outside the table.

    Notes
    -----
    F_N = (C - 1) F_H is meant for L > 80 m; see `secondary_resistance`.

    Examples
    --------
    >>> length_coefficient(140.0), round(length_coefficient(1250.0), 4)
    (1.63, 1.0735)
    """
    lengths, coefficients = zip(*LENGTH_COEFFICIENTS, strict=True)
    if not lengths[0] <= length <= lengths[-1]:
        raise RangeError(
            f"length = {length!r} m is outside the table of C ({lengths[0]:g} to {lengths[-1]:g} m): "
            "itemise the secondary resistances"
        )
    return float(np.interp(math.log(length), np.log(lengths), coefficients))


def secondary_resistance(main_force: float, *, length: float) -> float:
    """Secondary resistances as a share of the main resistance, F_N = (C - 1) F_H (ISO 5048, DIN 22101).

    Parameters
    ----------
    main_force : float
        F_H [N], at least 0.
    length : float
        L [m], from 3 to 5000; the method is meant for more than 80 m.

    Returns
    -------
    float
        F_N [N].

    Raises
    ------
    InputError
        The force is negative.
    RangeError
        The length is outside the table of C.

    Warns
    -----
    ValidityWarning
        The conveyor is not longer than 80 m.

    Examples
    --------
    >>> round(secondary_resistance(5000.0, length=200.0), 6)
    2250.0
    """
    require_not_negative(main_force=main_force)
    coefficient = length_coefficient(length)
    if length <= SHORTEST_FOR_FACTOR:
        warnings.warn(
            f"length = {length:g} m: F_N = (C - 1) F_H is meant for more than {SHORTEST_FOR_FACTOR:g} m; "
            "itemise the secondary resistances",
            ValidityWarning,
            stacklevel=2,
        )
    return (coefficient - 1.0) * main_force


def slope_resistance(line_mass: float, *, lift: float, gravity: float) -> float:
    """Slope resistance, F_St = m' g H (ISO 5048, DIN 22101).

    Parameters
    ----------
    line_mass : float
        m'_bulk for the whole conveyor; m'_belt + m'_bulk for one strand on its own [kg/m], at least 0.
    lift : float
        H [m], positive uphill in the direction of travel.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        F_St [N], negative downhill.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> slope_resistance(100.0, lift=-20.0, gravity=9.81)
    -19620.0
    """
    require_not_negative(line_mass=line_mass)
    require_finite(lift=lift)
    require_positive(gravity=gravity)
    return line_mass * gravity * lift
