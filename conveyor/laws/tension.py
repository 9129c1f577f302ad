"""Belt tensions: grip at the drive, sag between idlers, governing tension; pulley size and belt stiffness.

Sources: Eytelwein; ISO 5048, DIN 22101.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

from conveyor.arguments.limits import require, require_not_negative, require_positive

Carcass = Literal["polyamide", "EP", "steel cord"]

PULLEY_FACTOR: Final[Mapping[Carcass, float]] = {"polyamide": 90.0, "EP": 108.0, "steel cord": 145.0}  # c [-]
LARGEST_FRICTION: Final = 2.0  # [-], beyond any pair of belt and pulley: catches slips of the pen
LARGEST_WRAP: Final = 8.0 * math.pi  # [rad], four pulleys of a full turn: catches degrees given as rad
STEEL_CORD_STIFFNESS_FACTOR: Final = 72.0  # [-], EA over nominal strength, approximate
TEXTILE_STIFFNESS_FACTOR: Final[Mapping[str, float]] = {"EP": 5.0, "polyamide": 4.0}
"""EA over nominal strength [-]: 2.0 and 2.5 % of elongation at a tenth of the strength; general knowledge."""
RATED_STIFFNESS_FACTOR: Final[Mapping[str, float]] = {"steel cord": 400.0, "EP": 100.0, "polyamide": 70.0}
"""EA over the rated tension [-]: CEMA's belt moduli, as lectured at Newcastle (Belt conveying, transitions and curves),
who finds them conservatively high."""


def _require_drive(friction: float, wrap_angle: float) -> None:
    require(0.0 < friction <= LARGEST_FRICTION, "friction", friction, "> 0 and <= 2")
    require(0.0 < wrap_angle <= LARGEST_WRAP, "wrap_angle", wrap_angle, "> 0 and <= 8 pi rad")


def grip_tension(drive_force: float, *, friction: float, wrap_angle: float) -> float:
    """Least tension on the slack side of the drive, T2,min = |F_U|/(e^(μ α) - 1) (Eytelwein, ISO 5048).

    Parameters
    ----------
    drive_force : float
        F_U at the pulley [N]; negative when the belt drives the motor.
    friction : float
        μ [-], above 0, at most 2.
    wrap_angle : float
        α [rad], above 0, at most 8 pi.

    Returns
    -------
    float
        T2,min [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(grip_tension(13232.32, friction=0.3, wrap_angle=math.pi), 2)
    8447.96
    """
    require(math.isfinite(drive_force), "drive_force", drive_force, "finite")
    _require_drive(friction, wrap_angle)
    return abs(drive_force) / math.expm1(friction * wrap_angle)


def sag_tension(line_mass: float, *, spacing: float, relative_sag: float, gravity: float) -> float:
    """Least tension that keeps the sag, T ≥ (m'_belt + m'_bulk) g a/(8 (h/a)) (ISO 5048).

    Parameters
    ----------
    line_mass : float
        m'_belt + m'_bulk on the strand [kg/m], at least 0.
    spacing : float
        a, distance of the idler sets [m], positive.
    relative_sag : float
        h/a [-], positive; 0.01 to 0.02 in operation.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        T [N].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Parabola of a level strand: small relative sag.

    Examples
    --------
    >>> round(sag_tension(16.44, spacing=3.0, relative_sag=0.02, gravity=9.81))
    3024
    """
    require_not_negative(line_mass=line_mass)
    require_positive(spacing=spacing, relative_sag=relative_sag, gravity=gravity)
    return line_mass * gravity * spacing / (8.0 * relative_sag)


def governing_tension(minima: Mapping[str, float]) -> tuple[str, float]:
    """Return the largest of several least tensions at one point of the belt, and its name.

    Parameters
    ----------
    minima : mapping of str to float
        Least tension each condition requires at that point [N], each at least 0, for example
        {"grip": …, "sag carry": …, "sag return": …}.

    Returns
    -------
    name : str
        The condition that governs; of equals the first.
    tension : float
        Its tension [N].

    Raises
    ------
    InputError
        There is no condition, or a tension is negative.

    Examples
    --------
    >>> governing_tension({"grip": 8448.0, "sag carry": 22005.0, "sag return": 3024.0})
    ('sag carry', 22005.0)
    """
    require(len(minima) > 0, "minima", dict(minima), "at least one condition")
    require_not_negative(**minima)
    name = max(minima, key=lambda condition: minima[condition])
    return name, minima[name]


@dataclass(frozen=True, slots=True)
class DriveSideTensions:
    """Tensions on both sides of the drive.

    Parameters
    ----------
    tight : float
        T1 [N].
    slack : float
        T2 [N].
    governed_by : str
        "grip", or "sag" when the sag requires more tension.
    """

    tight: float
    slack: float
    governed_by: str


def drive_tensions(
    drive_force: float,
    *,
    friction: float,
    wrap_angle: float,
    start_factor: float = 1.0,
    slack_for_sag: float = 0.0,
) -> DriveSideTensions:
    """Tensions at the drive: T2 = max(grip, sag), T1 = T2 + ξ |F_U| (ISO 5048, DIN 22101).

    Parameters
    ----------
    drive_force : float
        F_U in steady operation [N]; negative when the belt drives the motor.
    friction : float
        μ [-], above 0, at most 2.
    wrap_angle : float
        α [rad], above 0, at most 8 pi.
    start_factor : float
        ξ, drive force at start over steady one [-], at least 1; 1 for steady operation.
    slack_for_sag : float
        Tension required by the sag, transferred to the slack side of the drive [N], at least 0.

    Returns
    -------
    DriveSideTensions
        Both tensions [N] and the governing condition.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The tight side is the one the belt runs in on for F_U > 0 and the one it leaves on for F_U < 0.

    Examples
    --------
    >>> t = drive_tensions(13232.32, friction=0.3, wrap_angle=math.pi)
    >>> round(t.tight, 2), round(t.slack, 2), t.governed_by
    (21680.28, 8447.96, 'grip')
    """
    require(1.0 <= start_factor < math.inf, "start_factor", start_factor, ">= 1")
    grip = grip_tension(start_factor * drive_force, friction=friction, wrap_angle=wrap_angle)
    governed_by, slack = governing_tension({"grip": grip, "sag": slack_for_sag})
    return DriveSideTensions(tight=slack + start_factor * abs(drive_force), slack=slack, governed_by=governed_by)


def least_pulley_diameter(carcass_thickness: float, *, carcass: Carcass) -> float:
    """Least diameter of the drive pulley, c d_carcass (DIN 22101).

    Parameters
    ----------
    carcass_thickness : float
        d_carcass, fabric plies or cord diameter [m], positive.
    carcass : {"polyamide", "EP", "steel cord"}
        Kind: c is 90, 108, 145.

    Returns
    -------
    float
        Diameter [m].

    Raises
    ------
    InputError
        The thickness is not positive or the kind unknown.

    Examples
    --------
    >>> round(least_pulley_diameter(0.005, carcass="EP"), 3)
    0.54
    """
    require_positive(carcass_thickness=carcass_thickness)
    require(carcass in PULLEY_FACTOR, "carcass", carcass, ", ".join(PULLEY_FACTOR))
    return PULLEY_FACTOR[carcass] * carcass_thickness


def steel_cord_stiffness(nominal_strength: float) -> float:
    """Tensile stiffness of a steel-cord belt per width, EA ≈ 72 × strength class.

    Parameters
    ----------
    nominal_strength : float
        Strength class per width [N/m], positive: ST1600 is 1.6e6 N/m.

    Returns
    -------
    float
        EA per width [N/m].

    Raises
    ------
    InputError
        The strength is not positive.

    Examples
    --------
    >>> steel_cord_stiffness(1.6e6)
    115200000.0
    """
    require_positive(nominal_strength=nominal_strength)
    return STEEL_CORD_STIFFNESS_FACTOR * nominal_strength


def usual_stiffness(nominal_strength: float | None, *, rating: float | None = None, carcass: str) -> float | None:
    """Usual tensile stiffness of a belt per width, a multiple of its strength or rated tension.

    Parameters
    ----------
    nominal_strength : float or None
        Strength class per width [N/m], positive.
    rating : float, optional
        Rated tension per width [N/m], positive: counts where the strength is not known.
    carcass : str
        Its kind: "steel cord", "EP", "polyamide"; of others nothing usual is known.

    Returns
    -------
    float or None
        EA per width [N/m]; None where neither is known.

    Raises
    ------
    InputError
        The strength or the rating is not positive.

    Examples
    --------
    >>> usual_stiffness(1.0e6, carcass="EP"), usual_stiffness(1.0e6, carcass="cotton")
    (5000000.0, None)
    >>> usual_stiffness(None, rating=1.0e5, carcass="EP")
    10000000.0
    """
    if nominal_strength is None:
        if rating is None or carcass not in RATED_STIFFNESS_FACTOR:
            return None
        require_positive(rating=rating)
        return RATED_STIFFNESS_FACTOR[carcass] * rating
    if carcass == "steel cord":
        return steel_cord_stiffness(nominal_strength)
    require_positive(nominal_strength=nominal_strength)
    factor = TEXTILE_STIFFNESS_FACTOR.get(carcass)
    return None if factor is None else factor * nominal_strength
