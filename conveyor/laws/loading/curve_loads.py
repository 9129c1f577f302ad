"""Loads of the belt's tension on the rolls of a vertical curve.

Source: statics of a taut belt on a polygon of idler sets.
"""

from __future__ import annotations

import math

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_positive, require_slope


def effective_tension(tension: float, *, line_mass: float, belt_speed: float) -> float:
    """Effective tension on a curve, T - m' v²: the rest bends the path of the moving mass.

    Parameters
    ----------
    tension : float
        T of the belt [N], at least 0.
    line_mass : float
        m' of belt and bulk [kg/m], at least 0.
    belt_speed : float
        v [m/s], at least 0.

    Returns
    -------
    float
        T - m' v² [N], negative when the belt would fly.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> effective_tension(100e3, line_mass=150.0, belt_speed=5.0)
    96250.0
    """
    require_not_negative(tension=tension, line_mass=line_mass, belt_speed=belt_speed)
    return tension - line_mass * belt_speed**2


def curve_set_force(tension: float, *, radius: float, spacing: float) -> float:
    """Force of the belt's tension on one idler set of a curve, F = 2 T sin(a/(2 r)), about T a/r.

    Parameters
    ----------
    tension : float
        T in the curve [N], at least 0, see `effective_tension`.
    radius : float
        r [m]: positive on a convex curve (hill), where the force presses on the rolls; negative on a concave one
        (valley), where it relieves them. At least a/2 in size; infinite on the straight.
    spacing : float
        a of the sets along the curve [m], positive.

    Returns
    -------
    float
        F normal to the belt [N], positive on the rolls.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The belt turns by a/r at each set. If F + weight is negative the belt lifts off the set.

    Examples
    --------
    >>> round(curve_set_force(100e3, radius=200.0, spacing=1.0), 2)
    500.0
    >>> round(curve_set_force(100e3, radius=-200.0, spacing=1.0), 2)
    -500.0
    """
    require_not_negative(tension=tension)
    require_positive(spacing=spacing)
    ok = abs(radius) >= spacing / 2.0
    require(ok, "radius", radius, f">= spacing/2 = {spacing / 2.0:.4g} m in size")
    return 2.0 * tension * math.sin(spacing / (2.0 * radius))


def curve_belt_mass(set_force: float, *, spacing: float, inclination: float, gravity: float) -> float:
    """Equivalent mass per length of the curve's load, Δm' = F/(a g cos δ).

    Parameters
    ----------
    set_force : float
        F of the curve on one set [N], of either sign, see `curve_set_force`.
    spacing : float
        a of the sets [m], positive.
    inclination : float
        δ [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        Δm' [kg/m]: added to the belt's own it gives the loads of the rolls; the sum below 0 is lift-off.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Tension spread evenly over the width acts strip by strip in the plane of the curve, as weight does, so it
    shares out between the rolls like the belt's own weight.

    Examples
    --------
    >>> round(curve_belt_mass(500.0, spacing=1.0, inclination=0.0, gravity=10.0), 9)
    50.0
    """
    require_finite(set_force=set_force)
    require_positive(spacing=spacing, gravity=gravity)
    require_slope(inclination=inclination)
    return set_force / (spacing * gravity * math.cos(inclination))
