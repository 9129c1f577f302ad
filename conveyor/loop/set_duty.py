"""Duty of the idler sets: rated load, axles, life, the belt's distance from resonance."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from conveyor.laws.idler_sets import flap_frequency, resonance_free_spacing, resonance_margin
from conveyor.line.roll_lives import SetLife, idler_set_life
from conveyor.line.set_limits import SetLimits
from conveyor.line.stretches import Stretch
from conveyor.loop.balance import Balance


@dataclass(frozen=True, eq=False)
class SetDuty:
    """Duty of a stretch's sets in steady running under one load.

    Attributes
    ----------
    stretch : Stretch
        The stretch.
    limits : SetLimits
        Limits of the sets, and their load as rated.
    life : SetLife or None
        L10 of all bearings of a set together; None without any.
    belt_speed : float
        Speed of the belt [m/s].
    swings : tuple of float
        First natural frequency of the belt between two sets at both ends of the stretch [Hz]; 0 at tensions to m' v².
    """

    stretch: Stretch
    limits: SetLimits
    life: SetLife | None
    belt_speed: float
    swings: tuple[float, float]

    @property
    def frequencies(self) -> tuple[float, float]:
        """First natural frequency of the belt at the lowest and highest tension in the stretch [Hz]."""
        return min(self.swings), max(self.swings)

    @cached_property
    def rotations(self) -> tuple[float, float]:
        """Rotation of the slowest and the fastest rolls [1/s]."""
        each = [self.belt_speed / (2.0 * math.pi * radius) for radius in self.stretch.radii]
        return min(each), max(each)

    @cached_property
    def distance(self) -> float:
        """Distance of the rolls' rotation from resonance [-]; 0 where a span of the stretch resonates."""
        low, high = self.frequencies
        return min(resonance_margin(each, lowest=low, highest=high) for each in self.rotations)

    @cached_property
    def still_spacing(self) -> float | None:
        """Widest spacing with the required distance from resonance [m]; None without one or if none is required."""
        margin = self.limits.flap_margin
        if margin is None or self.frequencies[0] == 0.0:
            return None
        return resonance_free_spacing(
            self.rotations[1], lowest=self.frequencies[0], spacing=self.stretch.spacing, margin=margin
        )

    @property
    def still_diameter(self) -> float | None:
        """Least roll diameter with that distance at the present spacing [m]; None likewise."""
        if self.still_spacing is None:
            return None
        return 2.0 * min(self.stretch.radii) * self.stretch.spacing / self.still_spacing


def set_duty(balance: Balance) -> tuple[SetDuty, ...]:
    """Set duties of every stretch whose spec gives set limits, in loop order."""
    line, steady = balance.line, balance.equilibrium.steady
    return tuple(
        _stretch_duty(balance, stretch, float(start), float(end))
        for stretch, start, end in zip(line.loop.stretches, steady.starts, steady.ends, strict=True)
        if stretch.idlers.judged and stretch.bed is None
    )


def _stretch_duty(balance: Balance, stretch: Stretch, start: float, end: float) -> SetDuty:
    line = balance.line
    limits = SetLimits.of(stretch, line, tension=max(start, end))
    swings = (_natural_frequency(stretch, start, line.speed), _natural_frequency(stretch, end, line.speed))
    return SetDuty(stretch, limits, idler_set_life(stretch, line.speed), line.speed, swings)


def _natural_frequency(stretch: Stretch, tension: float, belt_speed: float) -> float:
    """First natural frequency between two sets at a tension [Hz]; 0 at tensions up to m' v²."""
    if tension <= stretch.line_mass * belt_speed**2:
        return 0.0
    return flap_frequency(tension, line_mass=stretch.line_mass, spacing=stretch.spacing, belt_speed=belt_speed)
