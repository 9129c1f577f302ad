"""What the belt's tension adds to the rolls on a vertical curve.

Source: statics of a taut belt on a polygon of idler sets.
"""

from __future__ import annotations

import math

from conveyor.require import require, require_finite, require_not_negative, require_positive, require_slope


def effective_tension(tension: float, *, line_mass: float, belt_speed: float) -> float:
    """Tension that acts on a curve, T - m' v²: the rest bends the path of the moving mass.

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
    require(ok, "radius", radius, f"at least spacing/2 = {spacing / 2.0:.4g} m in size is needed")
    return 2.0 * tension * math.sin(spacing / (2.0 * radius))


def curve_belt_mass(set_force: float, *, spacing: float, inclination: float, gravity: float) -> float:
    """Mass per length that would press like the curve, Δm' = F/(a g cos δ).

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
    shares out between the rolls like the belt's own weight; for uneven tension see `curve_middle_share`.

    Examples
    --------
    >>> round(curve_belt_mass(500.0, spacing=1.0, inclination=0.0, gravity=10.0), 9)
    50.0
    """
    require_finite(set_force=set_force)
    require_positive(spacing=spacing, gravity=gravity)
    require_slope(inclination=inclination)
    return set_force / (spacing * gravity * math.cos(inclination))


def curve_middle_share(
    even_share: float,
    *,
    tension_per_width: float,
    middle_below: float,
    stiffness_per_width: float,
    radius: float,
) -> float:
    """Share of a curve's force on the middle roll, s (1 - E z/(r k)): the lower middle is slacker on a hill.

    Parameters
    ----------
    even_share : float
        s, share of the belt's width on the middle roll [-], from 0 to 1, see `middle_share_belt`.
    tension_per_width : float
        k, mean of the belt [N/m], positive.
    middle_below : float
        z, depth of the middle below the belt's centre [m], at least 0, see `trough_section`.
    stiffness_per_width : float
        E of the belt per width [N/m], at least 0; 0 gives the even share.
    radius : float
        r [m], positive convex, negative concave, not 0; infinite on the straight.

    Returns
    -------
    float
        Share [-]; both wings together carry the rest.

    Raises
    ------
    InputError
        An argument is outside its range, or the middle is slack, or the wings are: the curve is too sharp.

    Notes
    -----
    Plane sections, as in `overstress_radius`.

    Examples
    --------
    >>> round(
    ...     curve_middle_share(
    ...         0.4, tension_per_width=100e3, middle_below=0.05, stiffness_per_width=72e6, radius=300.0
    ...     ),
    ...     6,
    ... )
    0.352
    """
    require(0.0 <= even_share <= 1.0, "even_share", even_share, "from 0 to 1 is needed")
    require_positive(tension_per_width=tension_per_width)
    require_not_negative(middle_below=middle_below, stiffness_per_width=stiffness_per_width)
    require(abs(radius) > 0.0, "radius", radius, "a number other than 0 is needed")
    share = even_share * (1.0 - stiffness_per_width * middle_below / (radius * tension_per_width))
    require(0.0 <= share <= 1.0, "radius", radius, "a strip of the belt goes slack, choose a larger radius")
    return share
