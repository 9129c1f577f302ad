"""Waves along the belt: wave speed and starting ramps.

Sources: d'Alembert for a rod; the ramps as A. Harrison (1 - cos) and L. K. Nordell (two parabolas) are cited for in the
trade; their papers were not read.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require, require_positive, require_slope
from conveyor.laws.resistance.resistance_defaults import Default

BELT_RETARDATION: Final = Default(
    0.1,
    0.03,
    0.3,
    "damping of the belt lengthwise, Kelvin and Voigt; a loss factor of 0.05 at 0.5 rad/s",
    True,
)  # [s]
MOTOR_SLIP: Final = Default(0.02, 0.005, 0.05, "slip of motor and coupling at rated torque", True)  # [-]
TORQUE_LIMIT: Final = Default(1.6, 1.3, 2.2, "largest torque of a motor over the rated one", True)  # [-]
INITIAL_TORQUE: Final = Default(0.3, 0.1, 0.5, "torque at which soft starters and couplings begin", True)  # [-]
PULLEY_INERTIA: Final = Default(
    0.6,
    0.5,
    0.8,
    "rotating mass of a pulley at its rim over its mass; 0.5 of a disc, 1 of a thin shell",
    True,
)  # [-]

DRIVE_DRAG: Final = Default(0.5, 0.3, 0.7, "drag of a drive without power over its loss at rated power", True)  # [-]
SLACK_SAG: Final = Default(0.1, 0.05, 0.2, "sag over the span from which on a belt is slack", True)  # [-]
MOVING_SAG: Final = Default(0.05, 0.03, 0.1, "sag over the span allowed while a conveyor starts or stops", True)  # [-]


def sag_factor(line_mass: float, *, spacing: float, inclination: float, gravity: float) -> float:
    """Strain taken up by the sag between idlers, times T²: (m' g a cos δ)²/24.

    Parameters
    ----------
    line_mass : float
        m' of belt and bulk [kg/m], positive.
    spacing : float
        a [m], positive.
    inclination : float
        δ [rad], below a right angle.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        S in strain = T/EA - S/T² [N²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived: a shallow parabola is longer than its chord by 8/3 (h/a)², h/a = m' g a/(8 T). The belt softens as
    1/EA + 2 S/T³, and never pushes. It hangs as it would at rest: its bouncing is left out.

    Examples
    --------
    >>> sag_factor(100.0, spacing=1.2, inclination=0.0, gravity=10.0)
    60000.0
    """
    require_positive(line_mass=line_mass, spacing=spacing, gravity=gravity)
    require_slope(inclination=inclination)
    return (line_mass * gravity * spacing * math.cos(inclination)) ** 2 / 24.0


def wave_speed(stiffness: float, *, line_mass: float) -> float:
    """Speed of tension waves along a belt, c = sqrt(EA/m').

    Parameters
    ----------
    stiffness : float
        EA of the whole belt [N], positive.
    line_mass : float
        m' of belt, bulk and rolls [kg/m], positive.

    Returns
    -------
    float
        c [m/s].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Of a taut belt: sag between the rolls makes it slower (`sag_factor`). The belt's own speed is left out, below 1 % of
    c.

    Examples
    --------
    >>> wave_speed(40e6, line_mass=40.0)
    1000.0
    """
    require_positive(stiffness=stiffness, line_mass=line_mass)
    return math.sqrt(stiffness / line_mass)


def ramp_speed(share: ArrayLike, *, shape: str) -> NDArray[np.float64]:
    """Speed over full speed of a controlled start: x, (1 - cos πx)/2, or 2x² and 1 - 2(1 - x)².

    Parameters
    ----------
    share : float or array_like
        x, time over the time of the ramp [-]; held at both ends.
    shape : {"linear", "cosine", "S"}
        Jumps of the acceleration, none of it, or even steps of it [-].

    Returns
    -------
    ndarray
        Speed over full speed [-].

    Raises
    ------
    InputError
        Another shape.

    Examples
    --------
    >>> [ramp_speed([0.0, 0.25, 0.5, 1.0], shape=shape).round(3).tolist() for shape in ("linear", "cosine", "S")]
    [[0.0, 0.25, 0.5, 1.0], [0.0, 0.146, 0.5, 1.0], [0.0, 0.125, 0.5, 1.0]]
    """
    x = np.clip(np.asarray(share, dtype=float), 0.0, 1.0)
    made = {
        "linear": x,
        "cosine": 0.5 * (1.0 - np.cos(np.pi * x)),
        "S": np.where(x < 0.5, 2.0 * x**2, 1.0 - 2.0 * (1.0 - x) ** 2),
    }
    require(shape in made, "shape", shape, "linear, cosine, S")
    return np.asarray(made[shape], dtype=float)


STEEPEST_SLOPE: Final = {"linear": 1.0, "cosine": 0.5 * math.pi, "S": 2.0}
"""Highest acceleration of a ramp over its mean one [-]."""
