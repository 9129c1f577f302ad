"""Pulleys as machine parts: resultant, shaft by bending and torsion, its slope at the hub, pressure on the lagging.

Source: CEMA B105.1 / ANSI (welded steel conveyor pulleys), the shaft formulas as pulley makers reproduce them: safety
against fatigue, 1.5, and slope at the hub, 0.0023. The rest is statics.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final, Literal

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.errors import RangeError

Steel = Literal["C1018", "C1045", "C4140"]
Keyway = Literal["profiled", "sled runner"]

_PSI: Final = 4.4482216152605 / 0.0254**2
_INCH: Final = 0.0254
STEEL_MODULUS: Final = 29e6 * _PSI
"""Young's modulus of shafts [Pa]; CEMA B105.1."""
SHAFT_SAFETY: Final = 1.5
"""Safety of the shaft, at least [-]; CEMA B105.1."""
HUB_SLOPE: Final = 0.0023
"""Slope of the free shaft at the hub, at most [-], 8 minutes of arc; CEMA B105.1."""
SHAFT_STEELS: Final[Mapping[Steel, tuple[float, float]]] = {
    "C1018": (29000.0 * _PSI, 32000.0 * _PSI),
    "C1045": (41000.0 * _PSI, 45000.0 * _PSI),
    "C4140": (47500.0 * _PSI, 60500.0 * _PSI),
}
"""Fatigue limit of the polished specimen, yield strength [Pa]; CEMA B105.1, 4140 annealed."""
KEYWAY_FACTOR: Final[Mapping[Keyway, float]] = {"profiled": 0.63, "sled runner": 0.77}
"""Fatigue limit with the keyway over that without [-]; CEMA B105.1, steels of less than 200 BHN."""
SHAFT_DIAMETERS: Final = tuple(
    1e-3 * mm for mm in (40, 50, 60, 70, 80, 90, 100, 110, 125, 140, 160, 180, *range(200, 1001, 20))
)
"""Diameters of shafts, by the bores of bearings in housings [m]; general knowledge."""
CEMA_SHAFTS: Final = tuple(
    _INCH * inches
    for inches in (1.4375, 1.9375, 2.1875, 2.4375, 2.9375, 3.4375, 3.9375, 4.4375, 4.9375, 5.4375, 6.0, 6.5, 7.0, 7.5,
                   8.0, *range(9, 41))
)  # fmt: skip
"""The same in the US, CEMA B105.1 as commonly listed [m]; general knowledge."""
_SURFACE, _RELIABILITY = 0.8, 0.897  # [-], CEMA B105.1: machined shaft, 90 %
_SIZE_EXPONENT = -0.19  # CEMA B105.1: k_b = D^-0.19, D in inches
_STEPS = 20  # each takes 0.19/3 of the error at most


def pulley_resultant(belt_pull: float, *, weight: float, pull_angle: float = 0.0) -> float:
    """Resultant load of a pulley, sqrt(F² + W² + 2 F W cos θ), of the belt's pull and its weight (statics).

    Parameters
    ----------
    belt_pull : float
        F, vector sum of the belt's tensions [N], at least 0, see `pulley_load` without mass.
    weight : float
        W of pulley and shaft [N], at least 0.
    pull_angle : float
        θ between the belt's pull and straight down [rad], 0 to pi; 0 where it is not known is on the safe side.

    Returns
    -------
    float
        Load of both bearings together [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> pulley_resultant(300.0, weight=400.0, pull_angle=math.pi / 2), pulley_resultant(300.0, weight=400.0)
    (500.0, 700.0)
    """
    require_not_negative(belt_pull=belt_pull, weight=weight)
    require(0.0 <= pull_angle <= math.pi, "pull_angle", pull_angle, ">= 0 and <= pi rad")
    return math.hypot(belt_pull * math.sin(pull_angle), weight + belt_pull * math.cos(pull_angle))


def hub_moment(load: float, *, bearing_centres: float, hub_centres: float) -> float:
    """Bending moment of the shaft between its hubs, M = R/2 (L - l)/2 (statics, both hubs bear alike).

    Parameters
    ----------
    load : float
        R, resultant of the pulley [N], at least 0.
    bearing_centres : float
        L between the bearings' centres [m], more than l.
    hub_centres : float
        l between the hubs' centres [m], positive.

    Returns
    -------
    float
        M [N m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> hub_moment(100e3, bearing_centres=1.5, hub_centres=1.0)
    12500.0
    """
    require_not_negative(load=load)
    require_positive(hub_centres=hub_centres)
    ok = hub_centres < bearing_centres < math.inf
    require(ok, "bearing_centres", bearing_centres, f"> hub_centres = {hub_centres!r} m")
    return 0.25 * load * (bearing_centres - hub_centres)


def shaft_slope(moment: float, *, hub_centres: float, diameter: float) -> float:
    """Slope of the free shaft at the hub, M l/(2 E I) (CEMA B105.1: tan α = R A (B - 2 A)/(4 E I)).

    Parameters
    ----------
    moment : float
        M between the hubs, R A/2 [N m], at least 0, see `hub_moment`.
    hub_centres : float
        l = B - 2 A between the hubs' centres [m], positive.
    diameter : float
        D of the shaft in and between the hubs [m], positive.

    Returns
    -------
    float
        tan α [-], to be compared with `HUB_SLOPE`.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The end discs hold the shaft back: the true slope is less.

    Examples
    --------
    >>> round(shaft_slope(10e3, hub_centres=1.4, diameter=0.15), 5)
    0.00141
    """
    require_not_negative(moment=moment)
    require_positive(hub_centres=hub_centres, diameter=diameter)
    return 32.0 * moment * hub_centres / (STEEL_MODULUS * math.pi * diameter**4)


def shaft_safety(moment: float, *, torque: float, diameter: float, steel: Steel, keyway: Keyway) -> float:
    """Safety of the shaft, π D³/(32 sqrt((M/S_f)² + 3/4 (T/S_y)²)) (CEMA B105.1).

    Parameters
    ----------
    moment : float
        M, bending that turns with the shaft [N m], at least 0.
    torque : float
        T, steady torsion [N m], at least 0, not both 0.
    diameter : float
        D in the hub [m], positive.
    steel : {"C1018", "C1045", "C4140"}
        Of the shaft [-].
    keyway : {"profiled", "sled runner"}
        That weakens it [-].

    Returns
    -------
    float
        [-], to be compared with `SHAFT_SAFETY`; infinite without load.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    S_f = 0.8 · D^-0.19 · 0.897 · k_f S_f*, D in inches: machined, 90 % reliability, -57 to 204 °C.

    Examples
    --------
    >>> round(shaft_safety(10e3, torque=0.0, diameter=0.15, steel="C1045", keyway="profiled"), 3)
    3.022
    """
    require_not_negative(moment=moment, torque=torque)
    require_positive(diameter=diameter)
    asked = _required_modulus(moment, torque, diameter, steel, keyway)
    return math.inf if asked == 0.0 else math.pi * diameter**3 / (32.0 * asked)


def _required_modulus(moment: float, torque: float, diameter: float, steel: Steel, keyway: Keyway) -> float:
    """Bending and torsional moments over strength, combined [m³]."""
    require(steel in SHAFT_STEELS, "steel", steel, ", ".join(SHAFT_STEELS))
    require(keyway in KEYWAY_FACTOR, "keyway", keyway, ", ".join(KEYWAY_FACTOR))
    fatigue, yielding = SHAFT_STEELS[steel]
    size: float = (diameter / _INCH) ** _SIZE_EXPONENT
    held = _SURFACE * _RELIABILITY * KEYWAY_FACTOR[keyway] * size * fatigue
    return math.hypot(moment / held, math.sqrt(0.75) * torque / yielding)


def least_shaft_diameter(
    moment: float, *, torque: float, hub_centres: float, steel: Steel | None, keyway: Keyway
) -> float:
    """Least diameter of the shaft in the hub by slope 0.0023 and, of a known steel, safety 1.5 (CEMA B105.1).

    Parameters
    ----------
    moment : float
        M between the hubs [N m], positive.
    torque : float
        T [N m], at least 0.
    hub_centres : float
        l between the hubs' centres [m], positive.
    steel : {"C1018", "C1045", "C4140"} or None
        Of the shaft [-].
    keyway : {"profiled", "sled runner"}
        That weakens it [-].

    Returns
    -------
    float
        D [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> d = least_shaft_diameter(10e3, torque=5e3, hub_centres=1.4, steel="C1045", keyway="profiled")
    >>> round(d, 4), round(shaft_slope(10e3, hub_centres=1.4, diameter=d), 6)
    (0.1327, 0.0023)
    """
    require_positive(moment=moment, hub_centres=hub_centres)
    require_not_negative(torque=torque)
    stiff: float = (32.0 * moment * hub_centres / (STEEL_MODULUS * math.pi * HUB_SLOPE)) ** 0.25
    if steel is None:
        return stiff
    strong = stiff
    for _ in range(_STEPS):  # the size factor asks for the diameter
        cubed = 32.0 * SHAFT_SAFETY / math.pi * _required_modulus(moment, torque, strong, steel, keyway)
        strong = cubed ** (1.0 / 3.0)
    return max(stiff, strong)


def next_shaft_diameter(least_diameter: float, *, series: Sequence[float] = SHAFT_DIAMETERS) -> float:
    """Next larger diameter of a series of shafts (bores of bearings; CEMA B105.1).

    Parameters
    ----------
    least_diameter : float
        Required, see `least_shaft_diameter` [m], at least 0.
    series : sequence of float
        Diameters, the least first [m], shape (n,): `SHAFT_DIAMETERS` or `CEMA_SHAFTS`.

    Returns
    -------
    float
        Diameter [m].

    Raises
    ------
    InputError
        The diameter is negative.
    RangeError
        Larger than the largest of the series, 1 m.

    Examples
    --------
    >>> next_shaft_diameter(0.0888), next_shaft_diameter(0.1327)
    (0.09, 0.14)
    """
    require_not_negative(least_diameter=least_diameter)
    size = next((size for size in series if size >= least_diameter), None)
    if size is None:
        raise RangeError(f"least_diameter: got {least_diameter!r}, the largest of the series is {series[-1]:g} m")
    return size


def lagging_pressure(tension: float, *, pulley_diameter: float, belt_width: float) -> float:
    """Pressure of the belt on the lagging where its tension is T, p = 2 T/(D B) (statics of a wrapped band).

    Parameters
    ----------
    tension : float
        T [N], at least 0; the tight side's is the highest.
    pulley_diameter : float
        D with its lagging [m], positive.
    belt_width : float
        B [m], positive.

    Returns
    -------
    float
        p [Pa].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> lagging_pressure(200e3, pulley_diameter=1.0, belt_width=1.0)
    400000.0
    """
    require_not_negative(tension=tension)
    require_positive(pulley_diameter=pulley_diameter, belt_width=belt_width)
    return 2.0 * tension / (pulley_diameter * belt_width)
