"""Horizontal curves: inward and outward forces on the belt, and its drift on the rolls.

Sources: Grimmer, Kessler, Spezielle Betrachtungen zur Gurtführung bei Gurtförderern mit Horizontalkurven (1987), Parts
I and II, by the forms and figures that the open library eytelwein 0.1.9 gives for them; the paper itself was not read.
Derived parts are marked.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from conveyor.arguments.limits import (
    require,
    require_angle,
    require_finite,
    require_not_negative,
    require_positive,
)
from conveyor.laws.loading import NO_WING, RollLoad, Wing, roll_angles, wing_pieces
from conveyor.laws.resistance.resistance_defaults import Default

FULL_SLIP_TILT: Final = Default(
    math.radians(3.0), math.radians(2.0), math.radians(4.0),
    "tilt from which a roll slides across the belt over all of its contact, 2 μ p h/(G a) of usual covers", True,
)  # fmt: skip
"""[rad]"""
LEAST_GUIDANCE: Final = 0.7
"""Guiding friction to count on over the full one, wet or dirty: Grimmer, Kessler, worked example [-]."""
MOST_ROLLS: Final = 5
"""Largest number of rolls of a set [-]."""


def guide_friction(tilt: float, *, friction: float, full_slip: float) -> float:
    """Friction across the belt of a skewed roll, μ [1 - (1 - ε/ε_s)³], from ε_s on μ.

    Parameters
    ----------
    tilt : float
        ε of the roll's axis from square to the belt [rad], of either sign.
    friction : float
        μ of belt on roll [-], at least 0.
    full_slip : float
        ε_s from which the whole contact slides [rad], positive.

    Returns
    -------
    float
        Force across the belt over the normal force, of the sign of the tilt [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived: brush model of a rolling contact with parabolic pressure (as of tyres), without turning slip. ISO 5048
    takes the full μ at any tilt.

    Examples
    --------
    >>> (
    ...     round(guide_friction(0.5, friction=0.4, full_slip=1.0), 12),
    ...     guide_friction(-2.0, friction=0.4, full_slip=1.0),
    ... )
    (0.35, -0.4)
    """
    require_finite(tilt=tilt)
    require_not_negative(friction=friction)
    require_positive(full_slip=full_slip)
    sliding = abs(tilt) >= full_slip
    share = 1.0 if sliding else 1.0 - (1.0 - abs(tilt) / full_slip) ** 3
    return math.copysign(friction * share, tilt)


def outward_force_factors(
    frictions: Sequence[float], *, trough_angle: float, banking_angle: float, inner_angle: float = 0.0
) -> tuple[float, ...]:
    """Outward force per weight of each roll of a set, from the inside roll outward.

    Inside sin(λ+β) + κ cos(λ+β), middle sin β + κ_m cos β, outside -sin(λ-β) + κ cos(λ-β); the belt that slides down
    the wings presses on the middle roll with sin(λ±β) sin λ, which κ_m adds to theirs.

    Parameters
    ----------
    frictions : sequence of float
        κ of each roll to the outside, see `guide_friction` [-]: two to five, the inside roll first.
    trough_angle : float
        λ of the outer rolls [rad], above 0 and below pi/2.
    banking_angle : float
        β by which the set is raised on the inside [rad], at least 0; λ + β below pi/2.
    inner_angle : float
        λ' of the inner wing rolls of four and five [rad], from 0 to λ.

    Returns
    -------
    tuple of float
        Of each roll [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Grimmer, Kessler, Part II ("improved"), their load factors 1: the weight on a wing acts along the wing in full, as
    of a belt that passes the corner without friction. Part I takes cos λ of it. The paper has three rolls; of four and
    five the inner wings push with λ', and a wing presses on every roll that it slides toward by the sine of the bend
    before that (derived). A V has no roll between its wings.

    Examples
    --------
    >>> pushes = outward_force_factors((0.0, 0.0, 0.0), trough_angle=math.radians(30), banking_angle=0.0)
    >>> [round(push, 3) for push in pushes]
    [0.5, 0.0, -0.5]
    """
    rolls = len(frictions)
    require(2 <= rolls <= MOST_ROLLS, "frictions", frictions, "of two to five rolls")
    require_finite(**{f"frictions_{i}": one for i, one in enumerate(frictions)})
    require_angle(0.0, trough_angle=trough_angle, banking_angle=banking_angle, inner_angle=inner_angle)
    require_angle(0.0, sum_of_trough_and_banking=trough_angle + banking_angle)
    require_positive(trough_angle=trough_angle)
    require(inner_angle <= trough_angle, "inner_angle", inner_angle, f"<= {trough_angle!r} rad")
    angles = roll_angles(rolls, trough_angle=trough_angle, inner_angle=inner_angle)
    pushes = []
    for i, (angle, friction) in enumerate(zip(angles, frictions, strict=True)):
        slope, inside = angle + banking_angle, i < rolls // 2
        step, end = (1, (rolls + 1) // 2) if inside else (-1, rolls // 2 - 1)
        pressed = math.fsum(
            frictions[j] * math.sin(step * (angles[j - step] - angles[j])) for j in range(i + step, end, step)
        )
        pushes.append(math.sin(slope) * (1.0 + step * pressed) + friction * math.cos(slope))
    return tuple(pushes)


def drifted_loads(loads: Sequence[RollLoad], drift: float, *, roll_length: float) -> tuple[RollLoad, ...]:
    """Roll loads of a set whose belt has drifted inside by s, the load of each strip of belt unchanged.

    Parameters
    ----------
    loads : sequence of RollLoad
        Of the centred belt, inside roll first: two to five [N].
    drift : float
        s toward the inside, negative outward [m]; the belt stays on the roll that it leaves.
    roll_length : float
        Shell length of the rolls [m], positive: the belt beyond it hangs over.

    Returns
    -------
    tuple of RollLoad
        Inside roll first [N]; their sum is that of the centred belt's.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived. The strip that comes on to a roll bears what it bore on the one before (of two rolls, what it bore at the
    inner end of the other wing); along a wing the bulk is laid as before, over its new length.

    Examples
    --------
    >>> roll = lambda name, belt, length: RollLoad(name, 0.0, belt, length, "uniform")
    >>> set_ = [roll("left wing", 24.0, 0.24), roll("middle", 32.0, 0.32), roll("right wing", 24.0, 0.24)]
    >>> moved = drifted_loads(set_, 0.06, roll_length=0.32)
    >>> [(round(one.belt_force, 9), round(one.length, 9)) for one in moved]
    [(30.0, 0.3), (32.0, 0.32), (18.0, 0.18)]
    """
    require_positive(roll_length=roll_length)
    require(2 <= len(loads) <= MOST_ROLLS, "loads", loads, "of two to five rolls")
    if drift < 0.0:
        return tuple(reversed(drifted_loads(loads[::-1], -drift, roll_length=roll_length)))
    left = loads[-1]
    require(
        drift <= left.length,
        "drift",
        drift,
        f"<= {left.length:.4g} m, the belt on the wing",
    )
    over = drift / left.length
    bulk = left.bulk_force * (over * (2.0 - over) if left.shape == "triangular" else over)
    belt = left.belt_force * over
    made = [_roll_with_loads(left, -bulk, -belt, left.length - drift)]
    for inner in reversed(loads[1:-1]):
        passed = drift / inner.length
        bulk_on, belt_on = inner.bulk_force * passed, inner.belt_force * passed
        made.insert(0, _roll_with_loads(inner, bulk - bulk_on, belt - belt_on, inner.length))
        bulk, belt = bulk_on, belt_on
    return (_roll_with_loads(loads[0], bulk, belt, min(loads[0].length + drift, roll_length)), *made)


def _roll_with_loads(load: RollLoad, bulk: float, belt: float, length: float) -> RollLoad:
    return replace(load, bulk_force=load.bulk_force + bulk, belt_force=load.belt_force + belt, length=length)


def outward_force(loads: Sequence[RollLoad], pushes: Sequence[float]) -> float:
    """Outward force of weight and guiding friction on a set, sum of W c over its rolls.

    Parameters
    ----------
    loads : sequence of RollLoad
        W on each roll, inside roll first [N], see `drifted_loads`.
    pushes : sequence of float
        c of each roll [-], see `outward_force_factors`.

    Returns
    -------
    float
        Force on one set [N], against T a/R of the belt's tension.

    Raises
    ------
    ValueError
        Not as many pushes as loads.

    Examples
    --------
    >>> roll = lambda name, belt: RollLoad(name, 0.0, belt, 0.3, "uniform")
    >>> outward_force([roll("left", 60.0), roll("right", 40.0)], (0.5, -0.5))
    10.0
    """
    return math.fsum(load.force * push for load, push in zip(loads, pushes, strict=True))


@dataclass(frozen=True, slots=True)
class DriftLaw:
    """Outward force on a set over the belt's drift: one parabola inside of the centre, one outside.

    Parameters
    ----------
    centred : float
        Force with the centred belt [N].
    inward, outward : tuple of float
        Slope [N/m] and curvature [N/m²] over the drift's size, and the drift at which the wing it leaves is bare [m].
    """

    centred: float
    inward: tuple[float, float, float]
    outward: tuple[float, float, float]

    @classmethod
    def of(cls, loads: Sequence[RollLoad], pushes: Sequence[float]) -> DriftLaw:
        """Return the drift law of a set.

        Parameters
        ----------
        loads : sequence of RollLoad
            Of the centred belt, inside roll first [N].
        pushes : sequence of float
            Of `outward_force_factors` [-].

        Raises
        ------
        InputError
            Not two to five rolls.
        """
        centred = outward_force(loads, pushes)

        def parabola(reach: float, side: float) -> tuple[float, float, float]:
            """Slope, curvature and end of the parabola through three points."""
            half, whole = (
                outward_force(drifted_loads(loads, side * s, roll_length=2.0 * reach), pushes)
                for s in (0.5 * reach, reach)
            )
            curvature = 2.0 * (whole - 2.0 * half + centred) / reach**2
            return (whole - centred) / reach - curvature * reach, curvature, reach

        return cls(centred, parabola(loads[-1].length, 1.0), parabola(loads[0].length, -1.0))

    @property
    def most(self) -> float:
        """Largest outward force, the outside wing bare [N]."""
        return self.force(self.inward[-1])

    def force(self, drift: float) -> float:
        """Outward force [N] at a drift to the inside [m]."""
        slope, curvature, reach = self.inward if drift >= 0.0 else self.outward
        size = abs(drift)
        require(size <= reach, "drift", drift, f"<= {reach:.4g} m in size")
        return self.centred + size * (slope + curvature * size)

    def drift(self, pull: float) -> float:
        """Inward drift at which the set balances an inward pull [m]; infinite where the belt runs off.

        Parameters
        ----------
        pull : float
            On one set [N], T a/R of the tension and what else acts across.
        """
        inside = pull >= self.centred
        slope, curvature, reach = self.inward if inside else self.outward
        more, side = pull - self.centred, 1.0 if inside else -1.0
        if more == 0.0:
            return 0.0
        root = slope**2 + 4.0 * curvature * more
        if root < 0.0 or slope * side <= 0.0:
            return side * math.inf
        size = 2.0 * more / (slope + side * math.sqrt(root))
        return side * (size if size <= reach else math.inf)


@dataclass(frozen=True, slots=True)
class FlatDrift:
    """Outward force on a flat set over the belt's drift at the end of a curve, W [sin β + κ(ε + s/L) cos β].

    Parameters
    ----------
    weight : float
        W on the roll [N], positive.
    banking_angle : float
        β by which it is raised on the inside [rad], from 0 to below pi/2.
    skew : float
        ε by which it steers outward [rad].
    friction, full_slip : float
        μ of belt on roll [-] and tilt from which it slides [rad], both positive, see `guide_friction`.
    length : float
        L of the curve [m], positive.
    reach : float
        Drift at which the belt falls off [m], positive.

    Notes
    -----
    Derived. No wing draws the belt back: the part of T a/R beyond W sin β turns its course by s' from that of the sets,
    until the guiding friction κ(ε + s') of the turned course holds it. The course settles within T a/(W dκ/dε), some
    spans, and then the belt drifts by s' of every metre: from the middle of the sets, where it comes in, to s = s' L
    at the end. There is no such course where more than μ is needed.

    Examples
    --------
    >>> flat = FlatDrift(1000.0, banking_angle=0.0, skew=0.0, friction=0.35, full_slip=0.05, length=100.0, reach=0.7)
    >>> round(flat.force(0.5), 6), round(flat.drift(94.85), 6), flat.drift(400.0)  # 0.35 (1 - 0.9³) W
    (94.85, 0.5, inf)
    """

    weight: float
    banking_angle: float
    skew: float
    friction: float
    full_slip: float
    length: float
    reach: float

    @property
    def centred(self) -> float:
        """Outward force without drift [N]."""
        return self.force(0.0)

    @property
    def most(self) -> float:
        """Largest outward force [N]."""
        return self.weight * (math.sin(self.banking_angle) + self.friction * math.cos(self.banking_angle))

    def guiding_force(self, drift: float) -> float:
        """Guiding friction along the roll [N] at a drift to the inside [m]."""
        held = guide_friction(self.skew + drift / self.length, friction=self.friction, full_slip=self.full_slip)
        return self.weight * math.cos(self.banking_angle) * held

    def force(self, drift: float) -> float:
        """Outward force [N] at a drift to the inside [m]."""
        return self.weight * math.sin(self.banking_angle) + self.guiding_force(drift)

    def drift(self, pull: float) -> float:
        """Inward drift at the end of the curve [m] under a pull on one set [N]; infinite off the roll."""
        asked = (pull / self.weight - math.sin(self.banking_angle)) / math.cos(self.banking_angle)
        share = abs(asked) / self.friction
        if share >= 1.0:
            return math.copysign(math.inf, asked)
        turned = math.copysign(self.full_slip * (1.0 - math.cbrt(1.0 - share)), asked)
        drift = (turned - self.skew) * self.length
        return drift if abs(drift) < self.reach else math.copysign(math.inf, drift)


def half_span(
    belt_width: float, *, middle_roll_length: float, trough_angle: float, inner_wing: Wing = NO_WING
) -> float:
    """Distance of the belt's edge from its middle across the curve, l_M/2 + (B - l_M)/2 cos λ.

    Parameters
    ----------
    belt_width : float
        B [m], positive.
    middle_roll_length : float
        l_M, belt on the middle roll [m], from 0 (two or four rolls) to B.
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2.
    inner_wing : Wing
        Length [m] and angle [rad] of the inner wing rolls of four and five, see `wing_pieces`.

    Returns
    -------
    float
        d [m]: on a radius R the outer edge is longer than the middle by d/R, the inner one shorter.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived: plane sections. The strips of a vertical curve, `vertical_curve.overstress_radius` and `buckling_radius`,
    hold with this distance.

    Examples
    --------
    >>> round(half_span(1.2, middle_roll_length=0.4, trough_angle=math.radians(60)), 9)
    0.4
    """
    pieces = wing_pieces(
        belt_width, middle_roll_length=middle_roll_length, trough_angle=trough_angle, inner_wing=inner_wing
    )
    return 0.5 * middle_roll_length + math.fsum(wing.length * math.cos(wing.angle) for wing in pieces)
