"""Idler sets on horizontal curves: loads, guiding forces and drift of the belt; SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from conveyor.laws.horizontal_curve import (
    FULL_SLIP_TILT,
    LEAST_GUIDANCE,
    DriftLaw,
    FlatDrift,
    drifted_loads,
    guide_friction,
    outward_force,
    outward_force_factors,
)
from conveyor.laws.loading import RollLoad, roll_angles
from conveyor.laws.resistance import ROLL_ON_BELT_FRICTION
from conveyor.laws.wind import AIR_DENSITY, WIND_DRAG, wind_force
from conveyor.models import IdlerSet, Section
from conveyor.units import Quantity, si

RollLoads = tuple[RollLoad, ...]


@dataclass(frozen=True)
class HorizontalCurve:
    """A horizontal curve: its side in running direction of the carry strand, radius [m], banking and skew [rad]."""

    side: str
    radius: float
    banking: Mapping[str, float]
    skew: Mapping[str, float]

    @classmethod
    def of(cls, section: Section) -> HorizontalCurve | None:
        """Return the SI view; None on the straight."""
        if section.horizontal_curve is None or section.horizontal_radius is None:
            return None

        def angle(given: Quantity | None) -> float:
            return 0.0 if given is None else si(given)

        return cls(
            section.horizontal_curve,
            si(section.horizontal_radius),
            {"carry": angle(section.carry_banking), "return": angle(section.return_banking)},
            {"carry": angle(section.carry_skew), "return": angle(section.return_skew)},
        )


@dataclass(frozen=True)
class CurveSets:
    """The sets of one strand on a horizontal curve.

    Attributes
    ----------
    side : {"left", "right"}
        Inside of the curve, in running direction of the carry strand.
    radius, vertical, length : float
        Radius of the curve; that of a vertical curve in the same section, as in `RouteSection`; section length [m].
    banking, skew, trough_angle, inner_angle, tilt_angle, roll_length : float
        Geometry of the sets; `inner_angle` of the inner wing rolls of four and five [rad, rad, rad, rad, rad, m].
    weights : tuple of RollLoad
        Weight on each roll of one set with the belt centred, inside roll first.
    drift : float
        Inward drift of the belt in steady running [m].
    wind : float
        Force of the wind across the belt on one set [N]; none under bulk.
    """

    side: str
    radius: float
    vertical: float
    length: float
    banking: float
    skew: float
    trough_angle: float
    inner_angle: float
    tilt_angle: float
    roll_length: float
    weights: RollLoads
    drift: float
    wind: float

    @property
    def flat(self) -> bool:
        """True for sets of one roll, without restoring force to the middle."""
        return len(self.weights) == 1

    @property
    def guided(self) -> bool:
        """True if friction across the rolls steers the belt."""
        return self.flat or self.skew != 0.0

    @property
    def room(self) -> float:
        """Drift at which an edge of the belt reaches the end of its roll, or the other wing is bare [m]."""
        on_roll = self.weights[0].length
        if self.flat:
            return 0.5 * (self.roll_length - on_roll)
        return min(self.roll_length - on_roll, on_roll)

    @cached_property
    def pushes(self) -> tuple[float, ...]:
        """Outward force over the weight on each roll with the full guiding friction [-]."""
        return self._pushes(1.0)

    @property
    def slopes(self) -> tuple[float, ...]:
        """Sine of each roll's slope, falling outward [-]: the push without friction."""
        if self.flat:
            return (math.sin(self.banking),)
        return self._pushed((0.0,) * len(self.weights))

    def _pushed(self, frictions: Sequence[float]) -> tuple[float, ...]:
        return outward_force_factors(
            frictions,
            trough_angle=self.trough_angle,
            banking_angle=self.banking,
            inner_angle=self.inner_angle,
        )

    @cached_property
    def _laws(self) -> tuple[DriftLaw | FlatDrift, DriftLaw | FlatDrift]:
        """Drift laws under weight alone, at the full and the least friction."""
        return self._law(self.weights, 1.0), self._law(self.weights, LEAST_GUIDANCE)

    def law(self, pressing: float, *, least: bool) -> DriftLaw | FlatDrift:
        """Drift law under weight and the force of a vertical curve [N], at the least or the full friction."""
        if pressing == 0.0:
            return self._laws[least]
        belt = math.fsum(load.belt_force for load in self.weights)
        loads = tuple(replace(w, belt_force=w.belt_force * (1.0 + pressing / belt)) for w in self.weights)
        return self._law(loads, LEAST_GUIDANCE if least else 1.0)

    def _law(self, loads: RollLoads, share: float) -> DriftLaw | FlatDrift:
        if self.flat:
            return FlatDrift(
                weight=loads[0].force,
                banking_angle=self.banking,
                skew=self.skew,
                friction=share * ROLL_ON_BELT_FRICTION.value,
                full_slip=FULL_SLIP_TILT.value,
                length=self.length,
                reach=0.5 * self.roll_length,
            )
        return DriftLaw.of(loads, self._pushes(share))

    def _pushes(self, share: float) -> tuple[float, ...]:
        """Outward pushes from tilt of the outer rolls (inward) and skew of the set, by cos λ on wings."""
        angles = roll_angles(len(self.weights), trough_angle=self.trough_angle, inner_angle=self.inner_angle)
        tilts = [self.skew * math.cos(angle) for angle in angles]
        tilts[0] += self.tilt_angle
        tilts[-1] -= self.tilt_angle
        friction = share * ROLL_ON_BELT_FRICTION.value
        frictions = [guide_friction(e, friction=friction, full_slip=FULL_SLIP_TILT.value) for e in tilts]
        return self._pushed(frictions)

    def guidance(self) -> float:
        """Resistance of one set's skew: outward guiding force times the sine of the angle of set and belt [N]."""
        law = self._laws[0]
        if isinstance(law, FlatDrift):
            return law.guiding_force(self.drift) * math.sin(self.skew + self.drift / self.length)
        if self.skew == 0.0:
            return 0.0
        guided = [with_it - without for with_it, without in zip(self.pushes, self.slopes, strict=True)]
        loads = drifted_loads(self.weights, self.drift, roll_length=self.roll_length)
        return outward_force(loads, guided) * math.sin(self.skew)

    def drifted(self, loads: RollLoads) -> RollLoads:
        """Loads of the rolls of a drifted belt, left to right.

        The balanced pull presses the belt into the inside wing and lifts it from the other.
        """
        if self.flat:
            pull = self._laws[0].force(self.drift)
            return (replace(loads[0], belt_force=loads[0].belt_force + pull * self.slopes[0]),)
        inside_first = loads if self.side == "left" else loads[::-1]
        moved = drifted_loads(inside_first, self.drift, roll_length=self.roll_length)
        pull, across = outward_force(moved, self.pushes), math.fsum(load.length for load in moved)
        made = tuple(
            replace(load, belt_force=load.belt_force + pull * load.length / across * slope)
            for load, slope in zip(moved, self.slopes, strict=True)
        )
        return made if self.side == "left" else made[::-1]


def sets_on_curve(
    given: HorizontalCurve,
    idlers: IdlerSet,
    strand: str,
    loads: RollLoads,
    *,
    vertical: float,
    length: float,
    drift: float,
    wind_speed: float,
    spacing: float,
    thickness: float,
) -> CurveSets:
    """Sets of a strand on a curve from the loads of a centred belt, left to right."""
    trough, inner = si(idlers.trough_angle), idlers.inner_wing.angle
    bare = all(load.bulk_force == 0.0 for load in loads)
    wind = 0.0
    if bare and wind_speed:
        angles = roll_angles(idlers.rolls, trough_angle=trough, inner_angle=inner)
        depth = math.fsum(load.length * abs(math.sin(angle)) for load, angle in zip(loads, angles, strict=True))
        height = thickness + 0.5 * depth
        wind = wind_force(wind_speed, height=height, length=spacing, drag=WIND_DRAG.value, air_density=AIR_DENSITY)
    return CurveSets(
        side=given.side,
        radius=given.radius,
        vertical=vertical,
        length=length,
        banking=given.banking[strand],
        skew=given.skew[strand],
        trough_angle=trough,
        inner_angle=inner,
        tilt_angle=si(idlers.tilt_angle),
        roll_length=si(idlers.roll.length),
        weights=loads if given.side == "left" else loads[::-1],
        drift=drift,
        wind=wind,
    )
