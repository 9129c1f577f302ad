"""Friction moment of a bearing and of a seal, with load, speed and the viscosity of the lubricant.

Sources: Palmgren, Ball and Roller Bearing Engineering, 3rd ed. 1959 (friction moment of a bearing, also in Harris,
Rolling Bearing Analysis); ASTM D341 (Walther, viscosity of an oil over temperature); Petroff 1883 (shear of a
lubricant in a gap).
"""

from __future__ import annotations

import math
import warnings
from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.errors import MessageQuantity, ValidityWarning
from conveyor.laws.resistance.resistance_defaults import Default

MM: Final = 1e-3  # [m]
CENTISTOKES: Final = 1e-6  # [m²/s], 1 mm²/s
PER_MINUTE: Final = 60.0  # [1/min per 1/s]

WALTHER_OFFSET: Final = 0.7  # [mm²/s], ASTM D341: log log (ν + 0.7) = A - B log T
WALTHER_LEAST: Final = 2.0  # [mm²/s], ASTM D341: below, the offset has further terms

PALMGREN_SWITCH: Final = 2000.0  # [mm²/s 1/min], Palmgren: ν n from which the film is fed
PALMGREN_FED: Final = 1e-7  # Palmgren, N mm from mm²/s, 1/min, mm
PALMGREN_SLOW: Final = 160e-7  # Palmgren, N mm from mm

BEARING_F0: Final = Default(2.0, 0.7, 2.0, "f0, deep-groove ball bearing, grease (Palmgren); upper end", True)
BEARING_F1_FACTOR: Final = Default(
    0.0009, 0.0004, 0.0009, "z in f1 = z (P0/C0)^y, deep-groove ball bearing (Palmgren); upper end", True
)
BEARING_F1_EXPONENT: Final = Default(0.55, 0.55, 0.55, "y in f1 = z (P0/C0)^y, deep-groove ball bearing", True)


def oil_viscosity(
    temperature: float,
    *,
    first_temperature: float,
    first_viscosity: float,
    second_temperature: float,
    second_viscosity: float,
) -> float:
    """Viscosity of an oil from two measured ones, log log(ν + 0.7) = A - B log T (Walther, ASTM D341).

    Parameters
    ----------
    temperature : float
        T [K], positive.
    first_temperature : float
        Of the first measured viscosity [K], positive; as a rule 313.15 K.
    first_viscosity : float
        ν of the grease's base oil there [m²/s], at least 2e-6.
    second_temperature : float
        Of the second [K], not the first; as a rule 373.15 K.
    second_viscosity : float
        ν there [m²/s], at least 2e-6 and lower if it is hotter.

    Returns
    -------
    float
        ν [m²/s].

    Raises
    ------
    InputError
        An argument is outside its range, or the result is no viscosity: the temperature is too far away.

    Warns
    -----
    ValidityWarning
        The result is below 2 mm²/s, where ASTM D341 adds terms to the offset 0.7.

    Notes
    -----
    Mineral oils above their cloud and pour points; below them an extrapolation is far too low.

    Examples
    --------
    >>> nu = oil_viscosity(
    ...     353.0,
    ...     first_temperature=313.0,
    ...     first_viscosity=32e-6,
    ...     second_temperature=373.0,
    ...     second_viscosity=5.4e-6,
    ... )
    >>> round(nu * 1e6, 1)
    8.5
    """
    require_positive(temperature=temperature, first_temperature=first_temperature)
    require_positive(second_temperature=second_temperature)
    for name, value in (("first_viscosity", first_viscosity), ("second_viscosity", second_viscosity)):
        least = WALTHER_LEAST * CENTISTOKES
        require(least <= value < math.inf, name, value, f">= {least:g} m²/s")
    falls = (second_temperature - first_temperature) * (first_viscosity - second_viscosity) > 0.0
    require(falls, "second_viscosity", second_viscosity, "< first_viscosity: the hotter of the two is the thinner")
    turn, slope = walther_constants(first_temperature, first_viscosity, second_temperature, second_viscosity)
    log_z = math.exp(turn - slope * math.log(temperature))
    cold = MessageQuantity(temperature, "temperature", f"{temperature!r}")
    require(log_z < math.log10(1e9), "temperature", cold, "hotter ones: the oil is solid there")
    viscosity: float = 10.0**log_z - WALTHER_OFFSET
    if viscosity < WALTHER_LEAST:
        warnings.warn(
            f"viscosity {viscosity:.3g} mm²/s at {temperature:g} K: ASTM D341's short form holds from 2 mm²/s",
            ValidityWarning,
            stacklevel=2,
        )
    return viscosity * CENTISTOKES


def walther_constants(
    first: float, first_viscosity: float, second: float, second_viscosity: float
) -> tuple[float, float]:
    """A and B of ln log10(ν + 0.7) = A - B ln T through two points (ASTM D341, equation 1).

    Parameters
    ----------
    first : float
        Temperature of a point [K], positive.
    first_viscosity : float
        ν there [m²/s], above 0.3 mm²/s.
    second : float
        Another temperature [K], positive.
    second_viscosity : float
        ν there [m²/s], above 0.3 mm²/s.

    Returns
    -------
    tuple of float
        A and B [-], with ν in mm²/s and T in K.

    Raises
    ------
    ValueError
        A viscosity is not above 0.3 mm²/s; `oil_viscosity` checks its own.

    Examples
    --------
    >>> a, b = walther_constants(313.0, 32e-6, 373.0, 5.4e-6)
    >>> round(10.0 ** math.exp(a - b * math.log(353.0)) - 0.7, 1)
    8.5
    """
    thick, thin = (
        math.log(math.log10(viscosity / CENTISTOKES + WALTHER_OFFSET))
        for viscosity in (first_viscosity, second_viscosity)
    )
    slope = (thick - thin) / math.log(second / first)
    return thick + slope * math.log(first), slope


def bearing_no_load_moment(f0: float, *, viscosity: float, rotation: float, mean_diameter: float) -> float:
    """No-load moment of a bearing, M0 = f0 1e-7 (ν n)^(2/3) d_m³, slow 160e-7 f0 d_m³ (Palmgren).

    Parameters
    ----------
    f0 : float
        f0 of bearing type and lubrication [-], at least 0; default of the craft `BEARING_F0`.
    viscosity : float
        ν at the running temperature, of the base oil if greased [m²/s], positive, see `oil_viscosity`.
    rotation : float
        n, revolutions [1/s], at least 0.
    mean_diameter : float
        d_m = (bore + outside)/2 [m], positive.

    Returns
    -------
    float
        M0 of one bearing [N m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The equation works in N mm, mm²/s, 1/min, mm; the slow form holds below ν n = 2000 mm²/s/min, where the two
    differ by 0.8 %. Freshly greased bearings drag more until the grease is spread. f0 is an empirical factor
    with a wide range: measured drag, if there is one, takes precedence over this law.

    Examples
    --------
    >>> moment = bearing_no_load_moment(2.0, viscosity=100e-6, rotation=650 / 60, mean_diameter=0.051)
    >>> round(moment, 4)
    0.0429
    """
    require_not_negative(f0=f0, rotation=rotation)
    require_positive(viscosity=viscosity, mean_diameter=mean_diameter)
    speed = viscosity / CENTISTOKES * rotation * PER_MINUTE
    film = PALMGREN_FED * speed ** (2.0 / 3.0) if speed >= PALMGREN_SWITCH else PALMGREN_SLOW
    return f0 * film * (mean_diameter / MM) ** 3 * MM


def bearing_load_factor(static_load: float, *, static_rating: float, factor: float, exponent: float) -> float:
    """Load factor of a bearing, f1 = z (P0/C0)^y (Palmgren).

    Parameters
    ----------
    static_load : float
        P0 on the bearing [N], at least 0; the radial load if there is no thrust.
    static_rating : float
        C0 of the bearing [N], positive.
    factor : float
        z [-], at least 0; default of the craft `BEARING_F1_FACTOR`.
    exponent : float
        y [-], at least 0; default of the craft `BEARING_F1_EXPONENT`.

    Returns
    -------
    float
        f1 [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(bearing_load_factor(160.0, static_rating=16000.0, factor=0.0009, exponent=0.5), 9)
    9e-05
    """
    require_not_negative(static_load=static_load, factor=factor, exponent=exponent)
    require_positive(static_rating=static_rating)
    relative: float = (static_load / static_rating) ** exponent
    return factor * relative


def bearing_load_moment(f1: float, *, load: float, mean_diameter: float) -> float:
    """Load moment of a bearing, M1 = f1 P1 d_m (Palmgren).

    Parameters
    ----------
    f1 : float
        f1 [-], at least 0, see `bearing_load_factor`.
    load : float
        P1 [N], at least 0; the radial load if there is no thrust.
    mean_diameter : float
        d_m = (bore + outside)/2 [m], positive.

    Returns
    -------
    float
        M1 of one bearing [N m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(bearing_load_moment(1e-4, load=500.0, mean_diameter=0.05), 6)
    0.0025
    """
    require_not_negative(f1=f1, load=load)
    require_positive(mean_diameter=mean_diameter)
    return f1 * load * mean_diameter


def labyrinth_moment(dynamic_viscosity: float, *, rotation: float, radius: float, length: float, gap: float) -> float:
    """Friction moment of one cylindrical labyrinth gap, M = 4 π² η n b r³/c (Petroff).

    Parameters
    ----------
    dynamic_viscosity : float
        η of the filling at its shear rate 2 π n r/c [Pa s], at least 0.
    rotation : float
        n, revolutions [1/s], at least 0.
    radius : float
        r of the gap [m], positive.
    length : float
        b of the gap along the axis [m], at least 0.
    gap : float
        c [m], positive, at most a tenth of the radius.

    Returns
    -------
    float
        M of one gap [N m]; the gaps of a labyrinth add up.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A Newtonian filling of a thin gap. Grease is not Newtonian: η is its apparent viscosity at this shear rate
    and temperature, which only a measurement gives. An empty gap costs nothing worth counting.

    Examples
    --------
    >>> round(labyrinth_moment(0.5, rotation=10.0, radius=0.03, length=0.01, gap=0.001), 5)
    0.0533
    """
    require_not_negative(dynamic_viscosity=dynamic_viscosity, rotation=rotation, length=length)
    require_positive(radius=radius)
    require(0.0 < gap <= radius / 10.0, "gap", gap, f"> 0 and <= a tenth of radius = {radius!r} m")
    shear_stress = dynamic_viscosity * 2.0 * math.pi * rotation * radius / gap
    return shear_stress * 2.0 * math.pi * radius * length * radius
