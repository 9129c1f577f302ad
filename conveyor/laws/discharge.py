"""Discharge over the head pulley: bulk on the pulley, discharge angle, trajectory.

Sources: Booth, Trajectories from conveyors, Engineering and Mining Journal 135 (1934); CEMA and Goodyear follow the
centre of the bulk, as Hastie and Wypych (Conveyor trajectory discharge angles, Newcastle 2007) compare them; inclined
and declined belts as ckit.co.za, conveyor, trajectories, prints them. Formulas as commonly reproduced; air is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_not_negative, require_positive, require_slope

FREE_EDGE: Final = 0.05
"""Belt left free at each edge on the pulley, at most [m]; ckit.co.za."""
EDGE_SHARE: Final = 0.055
EDGE_LEAST: Final = 0.023
"""Edge distance 0.055 B + 23 mm, of flat belts [-, m]; ckit.co.za."""
TIME_STEP: Final = 0.05
"""Between the points of a trajectory [s]; CEMA draws one every 1/20 s."""

_SERIES_BELOW: Final = 0.02  # half angle of a segment [rad] below which series are as good as the closed forms, 1e-8
_ROOT_TOLERANCE: Final = 1e-18  # of a root that may be as small as 1e-6 [rad]


@dataclass(frozen=True, slots=True)
class BulkOnPulley:
    """Bulk on the flat belt of a pulley.

    Parameters
    ----------
    height : float
        Height of its middle over the belt [m].
    centroid : float
        Height of its centre of area over the belt, a1 [m].
    """

    height: float
    centroid: float


def width_on_pulley(belt_width: float) -> float:
    """Width of the bulk on the flat belt of a pulley, B - 2 e with e = 0.055 B + 23 mm, at most 50 mm (ckit.co.za).

    Parameters
    ----------
    belt_width : float
        B [m], more than 0.052 m.

    Returns
    -------
    float
        L [m].

    Raises
    ------
    InputError
        The belt is too narrow to carry anything.

    Examples
    --------
    >>> round(width_on_pulley(0.45), 4), round(width_on_pulley(1.2), 4)
    (0.3545, 1.1)
    """
    require_positive(belt_width=belt_width)
    width = belt_width - 2.0 * min(EDGE_SHARE * belt_width + EDGE_LEAST, FREE_EDGE)
    require(width > 0.0, "belt_width", belt_width, "> 0.052 m")
    return width


def bulk_on_pulley(area: float, *, width: float) -> BulkOnPulley:
    """Bulk on a flat belt as a segment of a circle: A = r² (φ - sin φ cos φ), r sin φ = L/2 (ckit.co.za; derived).

    Parameters
    ----------
    area : float
        A, cross-section of the bulk [m²], positive, at most that of the half circle.
    width : float
        L, of its base [m], positive.

    Returns
    -------
    BulkOnPulley
        h = r (1 - cos φ) and a1 = 2 r sin³ φ/(3 (φ - sin φ cos φ)) - r cos φ [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> half = bulk_on_pulley(math.pi / 8.0, width=1.0)
    >>> round(half.height, 6), round(half.centroid, 6), round(2.0 / 3.0 / math.pi, 6)
    (0.5, 0.212207, 0.212207)
    """
    from scipy.optimize import brentq  # 0.4 s that a command without discharge does not pay

    require_positive(area=area, width=width)
    most = math.pi * width**2 / 8.0

    require(area <= most, "area", area, f"<= {most:.4g} m², a half circle on the belt")

    def over(half: float) -> float:
        return _segment_factor(half) * (0.5 * width / math.sin(half)) ** 2 - area

    # 3 A/L² < φ: a flat segment has A = L² φ/6 to its first order
    half = (
        math.pi / 2.0
        if over(math.pi / 2.0) <= 0.0
        else brentq(over, 3.0 * area / width**2, math.pi / 2.0, xtol=_ROOT_TOLERANCE)
    )
    height = 0.5 * width * math.tan(0.5 * half)
    if half < _SERIES_BELOW:
        return BulkOnPulley(height, height * (0.4 + 3.0 / 350.0 * half**2))
    radius = 0.5 * width / math.sin(half)
    return BulkOnPulley(height, radius * (2.0 * math.sin(half) ** 3 / (3.0 * _segment_factor(half)) - math.cos(half)))


def _segment_factor(half: float) -> float:
    """φ - sin φ cos φ, by its series where the difference loses digits."""
    if half < _SERIES_BELOW:
        return 2.0 / 3.0 * half**3 * (1.0 - half**2 / 5.0 + 2.0 * half**4 / 105.0)
    return half - math.sin(half) * math.cos(half)


def discharge_angle(speed: float, *, radius: float, inclination: float, gravity: float) -> float:
    """Discharge angle without slip: where the belt meets the pulley, or beyond its top at v²/(g r) = cos θ.

    Parameters
    ----------
    speed : float
        v, tangential at the radius [m/s], positive.
    radius : float
        r, of the bulk's path round the axis [m], positive.
    inclination : float
        δ of the belt, up positive [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    float
        θ beyond the top of the pulley [rad]; -δ where the bulk leaves as the belt meets the pulley.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A level or rising belt throws from v²/(g r) = 1 on (CEMA), a falling one from cos δ on (ckit.co.za). On a rising one
    a single lump flies clear of the pulley from 1/cos δ on and lands on it again below (derived: its height over the
    circle is a square of time whose least value is v² cos² δ - g r cos δ); 1 lies between.

    Examples
    --------
    >>> round(math.degrees(discharge_angle(1.5, radius=0.4, inclination=0.0, gravity=9.81)), 2)
    55.01
    >>> round(math.degrees(discharge_angle(4.0, radius=0.4, inclination=0.2, gravity=9.81)), 2)
    -11.46
    """
    require_positive(speed=speed, radius=radius, gravity=gravity)
    require_slope(inclination=inclination)
    over = speed**2 / (gravity * radius)
    return 0.0 - inclination if over >= min(1.0, math.cos(min(inclination, 0.0))) else math.acos(over)


@dataclass(frozen=True, slots=True)
class SlippingDischarge:
    """Bulk that slips on the belt before it leaves.

    Parameters
    ----------
    slip_angle, angle : float
        Angles at which it begins to slip and leaves, beyond the top of the pulley [rad].
    speed : float
        At which it leaves [m/s].
    """

    slip_angle: float
    angle: float
    speed: float


def slipping_discharge(
    speed: float,
    *,
    radius: float,
    inclination: float,
    friction: float,
    sliding_friction: float,
    gravity: float,
) -> SlippingDischarge:
    """Lower edge of the bulk after Booth: it slips from v²/(g r) = cos θ - sin θ/μ on and leaves at V²/(g r) = cos θ.

    V²/(g r) = [(4 μ_k² - 2) cos θ - 6 μ_k sin θ]/(1 + 4 μ_k²) + C exp(2 μ_k θ) between the two, C from the slip.

    Parameters
    ----------
    speed : float
        v of the belt [m/s], positive.
    radius : float
        r, of the outside of the belt round the pulley's axis [m], positive.
    inclination : float
        δ of the belt, up positive [rad], between -pi/2 and pi/2.
    friction : float
        μ, bulk on belt at rest [-], positive.
    sliding_friction : float
        μ_k of bulk that slips [-], positive, at most μ.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    SlippingDischarge
        Angles [rad] and speed [m/s]; of bulk that leaves as the belt meets the pulley -δ twice, and v.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Without adhesion. Booth (1934), as Hastie and Wypych give it. Slip backwards on a rising belt, just before the bulk
    would leave at once, is left out.

    Examples
    --------
    >>> found = slipping_discharge(1.0, radius=0.5, inclination=0.0, friction=0.6, sliding_friction=0.5, gravity=9.81)
    >>> [round(math.degrees(a), 2) for a in (found.slip_angle, found.angle)], round(found.speed, 3)
    ([24.94, 52.9], 1.72)
    """
    from scipy.optimize import brentq

    require_positive(friction=friction, sliding_friction=sliding_friction)

    require(sliding_friction <= friction, "sliding_friction", sliding_friction, "<= friction")
    angle = discharge_angle(speed, radius=radius, inclination=inclination, gravity=gravity)
    if angle == -inclination:
        return SlippingDischarge(angle, angle, speed)
    over, steep = speed**2 / (gravity * radius), math.atan(1.0 / friction)
    begin = max(math.acos(over * math.sin(math.atan(friction))) - steep, -inclination, 0.0)
    square = 1.0 + 4.0 * sliding_friction**2

    def forced(at: float) -> float:
        cosine = (4.0 * sliding_friction**2 - 2.0) * math.cos(at)
        return (cosine - 6.0 * sliding_friction * math.sin(at)) / square

    def ratio(at: float) -> float:
        return forced(at) + (over - forced(begin)) * math.exp(2.0 * sliding_friction * (at - begin))

    leaves = brentq(lambda at: ratio(at) - math.cos(at), begin, angle)
    return SlippingDischarge(begin, leaves, math.sqrt(ratio(leaves) * gravity * radius))


@dataclass(frozen=True, eq=False)
class FreeFall:
    """Trajectory of a free fall, arrays of shape (n,): a point every 1/20 s, the last at the end.

    Parameters
    ----------
    time : ndarray
        Since the bulk left the belt [s].
    across, up : ndarray
        Distance from the axis of the pulley, forward and upward [m].
    speed : ndarray
        [m/s].
    steepness : ndarray
        Angle of the path below the horizontal [rad].
    """

    time: NDArray[np.float64]
    across: NDArray[np.float64]
    up: NDArray[np.float64]
    speed: NDArray[np.float64]
    steepness: NDArray[np.float64]

    def beside(self, distance: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points at a distance square to the path, outward positive [m]: edges of the stream, as CEMA draws them."""
        return self.across + distance * np.sin(self.steepness), self.up + distance * np.cos(self.steepness)


def free_fall(angle: float, *, speed: float, radius: float, drop: float, gravity: float) -> FreeFall:
    """Trajectory of bulk that leaves a pulley: x = r sin θ + v cos θ t, y = r cos θ - v sin θ t - g t²/2.

    Parameters
    ----------
    angle : float
        θ beyond the top of the pulley where it leaves [rad].
    speed : float
        v there, at right angles to the radius [m/s], positive.
    radius : float
        r [m], positive.
    drop : float
        Depth below the axis down to which it is followed [m], at least 0.
    gravity : float
        g [m/s²], positive.

    Returns
    -------
    FreeFall
        Its points.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> level = free_fall(0.0, speed=4.0, radius=0.5, drop=4.405, gravity=9.81)
    >>> float(level.time[-1].round(6)), float(level.across[-1].round(6)), float(level.speed[-1].round(3))
    (1.0, 4.0, 10.594)
    """
    require(abs(angle) < math.pi / 2.0, "angle", angle, "> -pi/2 and < pi/2 rad")
    require_positive(speed=speed, radius=radius, gravity=gravity)
    require_not_negative(drop=drop)
    forward, down = speed * math.cos(angle), speed * math.sin(angle)
    height = radius * math.cos(angle) + drop
    end = 2.0 * height / (down + math.hypot(down, math.sqrt(2.0 * gravity * height)))
    time = np.append(np.arange(0.0, end, TIME_STEP), end)
    falling = down + gravity * time
    return FreeFall(
        time,
        radius * math.sin(angle) + forward * time,
        radius * math.cos(angle) - (down + 0.5 * gravity * time) * time,
        np.hypot(forward, falling),
        np.arctan2(falling, forward),
    )
