"""Loads of a belt feeder under a slot hopper: after filling, in flow, and the force that pulls the bulk out.

After filling: Arnold, McLean and Roberts (1982), read in a printed feeder calculation of Helix delta-T (Q_i and F_i of
that print follow to its digits). In flow: the radial stress field of Jenike in the closed form of Walker (1966) and
Arnold and McLean (1976), general knowledge, and the balance of forces on the wedge below the outlet, derived.
"""

from __future__ import annotations

import math
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.errors import RangeError
from conveyor.laws.resistance import Default

FEEDER_SPEED: Final = Default(
    0.5, 0.5, 0.7, "flat feeders with a shear gate run at 0.5 to 0.7 m/s at most (makers)", True
)
"""Belt speed of a feeder, at most [m/s]."""


BIN_PRESSURE_RATIO: Final = Default(
    0.4, 0.3, 0.6, "horizontal over vertical pressure of bulk in bins with upright walls (Jenike)", True
)
"""K of a bin above a hopper [-]."""


def bin_surcharge_height(
    bin_height: float, *, hydraulic_radius: float, wall_friction: float, pressure_ratio: float
) -> float:
    """Column of bulk that presses like a bin at its foot, R/(K tan φ) (1 - e^(-K tan φ h/R)) (Janssen 1895).

    Parameters
    ----------
    bin_height : float
        h, of the bulk in the bin [m], at least 0.
    hydraulic_radius : float
        R, area over perimeter of the bin [m], above 0; half the width of a long slot.
    wall_friction : float
        φ of bulk on the walls [rad], above 0 and below π/2.
    pressure_ratio : float
        K, horizontal over vertical pressure [-], above 0; `BIN_PRESSURE_RATIO`.

    Returns
    -------
    float
        p/(ρ g) [m], p being the vertical pressure after filling.

    Raises
    ------
    InputError
        An argument is outside its range.

    References
    ----------
    G. I. Tardos, Stresses in bins and hoppers, Educational Resources for Particle Technology 992Q, equation 3.

    Examples
    --------
    >>> import math
    >>> bin = {"wall_friction": math.atan(0.5), "pressure_ratio": 0.4}
    >>> round(bin_surcharge_height(10.0, hydraulic_radius=1.5, **bin), 3)
    5.523
    """
    require_not_negative(bin_height=bin_height)
    require_positive(hydraulic_radius=hydraulic_radius, pressure_ratio=pressure_ratio)
    require(0.0 < wall_friction < 0.5 * math.pi, "wall_friction", wall_friction, "0 to π/2")
    deepest = hydraulic_radius / (pressure_ratio * math.tan(wall_friction))
    return -deepest * math.expm1(-bin_height / deepest)


def initial_load_factor(
    top_width: float, *, outlet_width: float, half_angle: float, surcharge_height: float = 0.0
) -> float:
    """Load on the feeder after filling, q_i = (D/B - 1)/(2 tan α) + h_s/B, of a slot (Arnold, McLean, Roberts 1982).

    Parameters
    ----------
    top_width : float
        D, width of the hopper at its top [m], above B.
    outlet_width : float
        B, width of the slot [m], above 0.
    half_angle : float
        α of the hopper to the vertical [rad], between 0 and π/2.
    surcharge_height : float
        h_s, column that presses on the hopper's top like the bin above it [m], at least 0; `bin_surcharge_height`.

    Returns
    -------
    float
        q_i = Q_i/(ρ g L B²) [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    It is the column of bulk over the outlet as high as the hopper, without support by its walls, under the pressure of
    the bin: an upper bound. In flow the bin does not count: the field of stress in the hopper hangs on its outlet.

    Examples
    --------
    >>> import math
    >>> round(initial_load_factor(3.5, outlet_width=0.35, half_angle=math.radians(40.0)), 2)
    5.36
    """
    require_positive(outlet_width=outlet_width)
    require(top_width > outlet_width, "top_width", top_width, "> outlet_width")
    require(0.0 < half_angle < 0.5 * math.pi, "half_angle", half_angle, "0 to π/2")
    require_not_negative(surcharge_height=surcharge_height)
    return (top_width / outlet_width - 1.0) / (2.0 * math.tan(half_angle)) + surcharge_height / outlet_width


def flow_load_factor(half_angle: float, *, internal_friction: float, wall_friction: float) -> float:
    """Load on the feeder in flow, q_f = (2 σ_w/(ρ g B) (tan α + tan φ) - 1)/(4 tan α), of a slot in mass flow.

    Parameters
    ----------
    half_angle : float
        α of the hopper to the vertical [rad], between 0 and π/2.
    internal_friction : float
        δ, effective angle of internal friction [rad], between 0 and π/2.
    wall_friction : float
        φ of bulk on the walls [rad], above 0 and below δ.

    Returns
    -------
    float
        q_f = Q_f/(ρ g L B²) [-].

    Raises
    ------
    InputError
        An argument is outside its range.
    RangeError
        The hopper has no such field of stress: it is too shallow or too rough for mass flow.

    Notes
    -----
    With 2 β = φ + asin(sin φ/sin δ), σ_w = ρ g B Y (1 + sin δ cos 2β)/(2 (X - 1) sin α) is the pressure on the wall at
    the outlet, it falls to 0 at the apex. The virtual wedge below the outlet, of weight ρ g L B²/(4 tan α), is held by
    its walls and loaded by Q_f. A printed calculation of Helix delta-T has q_f without the divisor 4 tan α, 3.4 times
    as much at 40 deg and as much at 14 deg; it does not satisfy that balance.

    Examples
    --------
    >>> import math
    >>> angles = {"internal_friction": math.radians(55.0), "wall_friction": math.radians(15.0)}
    >>> round(flow_load_factor(math.radians(40.0), **angles), 3)
    0.285
    """
    require(0.0 < half_angle < 0.5 * math.pi, "half_angle", half_angle, "0 to π/2")
    require(0.0 < internal_friction < 0.5 * math.pi, "internal_friction", internal_friction, "0 to π/2")
    require(0.0 < wall_friction < internal_friction, "wall_friction", wall_friction, "0 to internal_friction")
    yielding = math.sin(internal_friction)
    double = wall_friction + math.asin(math.sin(wall_friction) / yielding)  # 2 β
    turned = 0.5 * double + half_angle
    x = yielding / (1.0 - yielding) * (math.sin(double + half_angle) / math.sin(half_angle) + 1.0)
    y = (turned * math.sin(half_angle) + math.sin(0.5 * double) * math.sin(turned)) / (
        (1.0 - yielding) * math.sin(turned) ** 2
    )
    factor = 0.0
    if x > 1.0 and turned < 0.5 * math.pi:
        wall = y * (1.0 + yielding * math.cos(double)) / (2.0 * (x - 1.0) * math.sin(half_angle))
        factor = (2.0 * wall * (math.tan(half_angle) + math.tan(wall_friction)) - 1.0) / (4.0 * math.tan(half_angle))
    if factor <= 0.0:
        raise RangeError(
            f"a slot hopper of {math.degrees(half_angle):.3g} deg to the vertical with wall friction "
            f"{math.degrees(wall_friction):.3g} deg and internal friction {math.degrees(internal_friction):.3g} deg "
            "has no field of stress in mass flow: make it steeper or smoother, or give flow_factor"
        )
    return factor


def mass_flow_half_angle(internal_friction: float, *, wall_friction: float) -> float:
    """Largest half angle of a slot hopper in mass flow, α = (e^(3.75 · 1.01^((δ - 30)/10)) - φ)/(0.725 tan^(1/5) δ).

    Parameters
    ----------
    internal_friction : float
        δ, effective angle of internal friction [rad], between 0 and π/2; the chart has 30 to 70 deg.
    wall_friction : float
        φ of bulk on the walls [rad], above 0 and below δ.

    Returns
    -------
    float
        α to the vertical [rad]; 0 where the walls are too rough at any slope.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A fit in degrees of Jenike's chart for plane flow (Bulletin 123, 1964) by Arnold, McLean and Roberts (1982),
    general knowledge. The fit of ter Borg (1986) has 33.6 deg where this one has 34.4.

    Examples
    --------
    >>> import math
    >>> limit = mass_flow_half_angle(math.radians(50.0), wall_friction=math.radians(20.0))
    >>> round(math.degrees(limit), 1)
    34.4
    """
    require(0.0 < internal_friction < 0.5 * math.pi, "internal_friction", internal_friction, "0 to π/2")
    require(0.0 < wall_friction < internal_friction, "wall_friction", wall_friction, "0 to internal_friction")
    smooth = math.exp(3.75 * 1.01 ** ((math.degrees(internal_friction) - 30.0) / 10.0))
    limit = (smooth - math.degrees(wall_friction)) / (0.725 * math.tan(internal_friction) ** 0.2)
    return math.radians(limit) if limit > 0.0 else 0.0


def hopper_load(
    load_factor: float, *, density: float, outlet_length: float, outlet_width: float, gravity: float
) -> float:
    """Vertical load on the feeder, Q = q ρ g L B² (Arnold, McLean and Roberts 1982).

    Parameters
    ----------
    load_factor : float
        q [-], at least 0.
    density : float
        ρ of the bulk [kg/m³], above 0.
    outlet_length, outlet_width : float
        L along the belt and B across it [m], above 0.
    gravity : float
        g [m/s²], above 0.

    Returns
    -------
    float
        Q [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(hopper_load(5.3629, density=900.0, outlet_length=2.05, outlet_width=0.35, gravity=9.81) / 1e3, 2)
    11.89
    """
    require_not_negative(load_factor=load_factor)
    require_positive(density=density, outlet_length=outlet_length, outlet_width=outlet_width, gravity=gravity)
    return load_factor * density * gravity * outlet_length * outlet_width**2


def gate_flow(
    belt_speed: float, *, density: float, gate_width: float, gate_height: float, efficiency: float = 1.0
) -> float:
    """Mass flow under a gate that fills its opening, η ρ b h v (Roberts: volumetric efficiency of a belt feeder).

    Parameters
    ----------
    belt_speed : float
        v [m/s], above 0.
    density : float
        ρ of the bulk as it fills [kg/m³], above 0.
    gate_width, gate_height : float
        b across the belt and h over it [m], above 0.
    efficiency : float
        η, mean speed of the bulk under the gate over that of the belt [-], above 0, at most 1.

    Returns
    -------
    float
        Mass flow [kg/s].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> gate_flow(0.25, density=1600.0, gate_width=0.5, gate_height=0.5)
    100.0
    """
    require_positive(belt_speed=belt_speed, density=density, gate_width=gate_width, gate_height=gate_height)
    require(0.0 < efficiency <= 1.0, "efficiency", efficiency, "> 0 and <= 1")
    return efficiency * density * gate_width * gate_height * belt_speed


def hopper_skirt_resistance(
    load: float,
    *,
    pressure_ratio: float,
    friction: float,
    density: float,
    outlet_length: float,
    outlet_width: float,
    gate_height: float,
    gravity: float,
) -> float:
    """Friction of the bulk on both skirts under a hopper, F = μ K (2 Q + ρ g B L y) y/B (form of Roberts; derived).

    Parameters
    ----------
    load : float
        Q on the outlet [N], at least 0.
    pressure_ratio : float
        K, side pressure over vertical pressure of the moving bulk [-], above 0.
    friction : float
        μ of bulk on skirts [-], at least 0.
    density : float
        ρ [kg/m³], above 0.
    outlet_length, outlet_width, gate_height : float
        L along the belt, B across it, y over it [m], above 0.
    gravity : float
        g [m/s²], above 0.

    Returns
    -------
    float
        F [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The vertical pressure grows from Q/(B L) at the outlet by ρ g to the belt; K times it presses on both skirts.

    Examples
    --------
    >>> outlet = {"outlet_length": 4.0, "outlet_width": 0.6, "gate_height": 0.25}
    >>> round(
    ...     hopper_skirt_resistance(3000.0, pressure_ratio=0.4, friction=0.5, density=850.0, gravity=9.81, **outlet), 1
    ... )
    916.9
    """
    require_not_negative(load=load, friction=friction)
    require_positive(pressure_ratio=pressure_ratio, density=density, outlet_length=outlet_length)
    require_positive(outlet_width=outlet_width, gate_height=gate_height, gravity=gravity)
    between = density * gravity * outlet_width * outlet_length * gate_height
    return friction * pressure_ratio * (2.0 * load + between) * gate_height / outlet_width
