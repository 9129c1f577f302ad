"""What the tensions ask of the belt: strength, pulley diameters, radii of vertical curves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from conveyor.laws.belt import (
    CLASSIC_SAFETY,
    DUTY_SAFETY,
    PULLEY_DIAMETERS,
    SPLICE_SAFETY,
    Group,
    belt_safety,
    needed_strength,
    next_pulley_diameter,
    pulley_group_diameter,
)
from conveyor.laws.tension import PULLEY_FACTOR, least_pulley_diameter, steel_cord_stiffness
from conveyor.laws.vertical_curve import (
    TroughSection,
    buckling_radius,
    lift_off_radius,
    overstress_radius,
    trough_section,
)
from conveyor.line.stretches import Strand, Stretch
from conveyor.loop.balance import Balance
from conveyor.loop.single_forces import driven_pulleys
from conveyor.models import Conveyor, Pulley
from conveyor.units import si

SNUB_WRAP = math.radians(30.0)
"""Wrap below which a pulley is of group C, DIN 22101 [rad]; general knowledge."""
LEAST_EDGE_TENSION = 4.5e3
"""Tension per width left in a strip that a curve slackens [N/m]; general knowledge."""


@dataclass(frozen=True)
class PulleyCheck:
    """A pulley beside the least diameter its belt asks for [m]; `next_size` of the series, None beyond it."""

    name: str
    position: str
    group: Group
    diameter: float
    least: float
    next_size: float | None

    @property
    def large_enough(self) -> bool:
        """Whether the belt bears it."""
        return self.diameter >= self.least


@dataclass(frozen=True)
class CurveCheck:
    """A vertical curve on one strand: its radius beside the least ones [m]; None where a figure for it is missing.

    Attributes
    ----------
    section, strand : str
        Where.
    kind : {"convex", "concave"}
        Hill or valley.
    radius : float
        As given.
    lowest, highest : float
        Tensions that occur in it [N].
    lift_off : float or None
        At which the empty belt stays down; of concave curves.
    overstress, buckling : float or None
        At which no strip of the belt is overstressed or slack; infinite where no radius helps.
    """

    section: str
    strand: Strand
    kind: str
    radius: float
    lowest: float
    highest: float
    lift_off: float | None
    overstress: float | None
    buckling: float | None


@dataclass(frozen=True)
class BeltDuty:
    """Tensions of the belt against its strength.

    Attributes
    ----------
    largest_steady, largest : float
        Highest tension in steady running and in all states [N].
    safety_steady, safety : float or None
        Strength over them [-]; None where the strength is not given.
    safety_needed : float
        Classic safety in steady running, DIN 22101:1982 [-].
    strength_needed : float or None
        Strength class by the endurance of the splice, DIN 22101:2002 [N/m]; None without the splice's.
    pulleys : tuple of PulleyCheck
        Empty for carcasses without a rule.
    drive_diameter : float or None
        Least diameter of the drive pulleys [m].
    curves : tuple of CurveCheck
        Every vertical curve on both strands.
    """

    largest_steady: float
    largest: float
    safety_steady: float | None
    safety: float | None
    safety_needed: float
    strength_needed: float | None
    pulleys: tuple[PulleyCheck, ...]
    drive_diameter: float | None
    curves: tuple[CurveCheck, ...]


def belt_duty(conveyor: Conveyor, found: Balance) -> BeltDuty:
    """Check belt, pulleys and vertical curves against the tensions of every state."""
    carcass, width = conveyor.belt.carcass, si(conveyor.belt.width)
    steady = found.settled.steady.largest
    largest = found.tensions.largest
    strength = None if carcass.strength is None else si(carcass.strength)
    return BeltDuty(
        largest_steady=steady,
        largest=largest,
        safety_steady=None
        if strength is None
        else belt_safety(steady, nominal_strength=strength, belt_width=width),
        safety=None
        if strength is None
        else belt_safety(largest, nominal_strength=strength, belt_width=width),
        safety_needed=CLASSIC_SAFETY["steel cord" if carcass.kind == "steel cord" else "textile"],
        strength_needed=None
        if carcass.splice_strength is None
        else needed_strength(
            steady / width,
            splice_strength=si(carcass.splice_strength),
            s0=SPLICE_SAFETY[carcass.splice_making],
            s1=DUTY_SAFETY[carcass.duty],
        ),
        pulleys=tuple(_pulleys(conveyor)),
        drive_diameter=_drive_diameter(conveyor),
        curves=tuple(_curves(conveyor, found)),
    )


def _drive_diameter(conveyor: Conveyor) -> float | None:
    carcass = conveyor.belt.carcass
    if carcass.kind not in PULLEY_FACTOR:
        return None
    return least_pulley_diameter(si(carcass.thickness), carcass=carcass.kind)  # type: ignore[arg-type]


def _pulleys(conveyor: Conveyor) -> Iterator[PulleyCheck]:
    drive = _drive_diameter(conveyor)
    if drive is None:
        return
    driven = driven_pulleys(conveyor)
    for i, pulley in enumerate(conveyor.route.pulleys):
        group = _group(pulley, driven=i in driven)
        least = pulley_group_diameter(drive, group=group)
        size = next_pulley_diameter(least) if least <= PULLEY_DIAMETERS[-1] else None
        yield PulleyCheck(pulley.name, pulley.position, group, si(pulley.diameter), least, size)


def _group(pulley: Pulley, *, driven: bool) -> Group:
    snub = si(pulley.wrap_angle) < SNUB_WRAP
    if driven or (pulley.position == "head" and not snub):
        return "A"
    return "C" if snub else "B"


def _curves(conveyor: Conveyor, found: Balance) -> Iterator[CurveCheck]:
    sections = {s.name: s for s in conveyor.route.sections if s.curve is not None}
    settled = found.settled
    states = tuple(settled.states.values())
    for i, stretch in enumerate(settled.loop.geometry.stretches):
        section = sections.get(stretch.section)
        if section is None or section.curve is None:
            continue
        tensions = [float(end[i]) for state in states for end in (state.starts, state.ends)]
        lowest, highest = max(0.0, min(tensions)), max(0.0, *tensions)
        lift = None
        if section.curve == "concave":
            lift = lift_off_radius(
                highest,
                belt_mass=stretch.belt_mass,
                inclination=stretch.inclination,
                gravity=settled.loop.data.gravity,
            )
        over, slack = _strips(conveyor, stretch, section.curve, lowest, highest)
        yield CurveCheck(
            stretch.section,
            stretch.strand,
            section.curve,
            abs(section.signed_radius),
            lowest,
            highest,
            lift,
            over,
            slack,
        )


def _strips(
    conveyor: Conveyor, stretch: Stretch, kind: str, lowest: float, highest: float
) -> tuple[float | None, float | None]:
    """Radii at which edges and middle of the belt bear the curve; None where stiffness or trough are not known."""
    carcass, width = conveyor.belt.carcass, si(conveyor.belt.width)
    trough = _trough(stretch, width)
    if trough is None or carcass.strength is None:
        return None, None
    strength = si(carcass.strength)
    if carcass.stiffness is not None:
        stiffness = si(carcass.stiffness)
    elif carcass.kind == "steel cord":
        stiffness = steel_cord_stiffness(strength)
    else:
        return None, None
    stretched, slackened = trough.edge_above, trough.middle_below
    if kind == "concave":
        stretched, slackened = slackened, stretched
    allowed = strength / CLASSIC_SAFETY["steel cord" if carcass.kind == "steel cord" else "textile"]
    over = slack = math.inf
    if highest / width < allowed:
        over = overstress_radius(
            highest / width, distance=stretched, stiffness_per_width=stiffness, allowed_per_width=allowed
        )
    if lowest / width > LEAST_EDGE_TENSION:
        slack = buckling_radius(
            lowest / width,
            distance=slackened,
            stiffness_per_width=stiffness,
            least_per_width=LEAST_EDGE_TENSION,
        )
    return over, slack


def _trough(stretch: Stretch, width: float) -> TroughSection | None:
    """Heights of the troughed belt; None for five rolls, which have no rule."""
    idlers = stretch.idlers
    middle = {1: width, 2: 0.0, 3: min(si(idlers.roll.length), width)}.get(idlers.rolls)
    if middle is None:
        return None
    return trough_section(width, middle_roll_length=middle, trough_angle=si(idlers.trough_angle))
