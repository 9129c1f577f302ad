"""Requirements of the tensions on the belt: strength, pulley diameters, vertical curve radii, transition lengths."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from conveyor.laws.belt_strength import (
    CEMA_PULLEYS,
    DUTY_SAFETY,
    PULLEY_DIAMETERS,
    RATED_START,
    SPLICE_SAFETY,
    Group,
    belt_safety,
    next_pulley_diameter,
    pulley_group_diameter,
    required_strength,
    standard_pulley_diameter,
)
from conveyor.laws.tension import PULLEY_FACTOR, least_pulley_diameter
from conveyor.laws.transition import (
    EDGE_OVER_RATED,
    cema_transition_length,
    transition_length,
)
from conveyor.laws.vertical_curve import (
    CEMA_LEAST_TENSION,
    TroughSection,
    cema_lift_off_radius,
    cema_middle_below,
    lift_off_radius,
    trough_section,
)
from conveyor.line.bend_pulleys import BendPulley, TransitionZone
from conveyor.line.line import Line
from conveyor.line.stretches import RouteSection, Strand, Stretch
from conveyor.loop.balance import Balance
from conveyor.loop.belt_limits import StripLimits, allowed_tension, classic_safety, strip_limits, taut_radius
from conveyor.loop.pipe_curve_duty import pipe_curve_checks
from conveyor.loop.pulley_duty import pulley_tensions
from conveyor.loop.tensions import MotionState

SNUB_WRAP = math.radians(30.0)
"""Wrap below which a pulley is of group C, DIN 22101 [rad]; general knowledge."""


@dataclass(frozen=True)
class PulleyCheck:
    """Diameter of a pulley and the least for its belt [m]; `next_size` of the series, None beyond it.

    `utilisation`: tension there in steady running over the allowed one [-]; None if unknown, then 1 is assumed.
    """

    name: str
    position: str
    group: Group
    utilisation: float | None
    diameter: float
    least: float
    next_size: float | None

    @property
    def large_enough(self) -> bool:
        """True if at least the least diameter."""
        return self.diameter >= self.least


@dataclass(frozen=True)
class CurveCheck:
    """Radius of a vertical curve on one strand and the least ones [m]; None where data are missing.

    Attributes
    ----------
    section, strand : str
        Section and strand.
    kind : {"convex", "concave"}
        Hill or valley.
    radius : float
        Radius of the spec.
    lowest, highest : float
        Tensions that occur in it [N].
    lift_off : float or None
        Least radius at which the empty belt stays down in the given wind; concave curves only.
    overstress, buckling : float or None
        Least radii at which no strip of the belt is overstressed or slack; infinite where no radius helps.
    most, least : float or None
        Highest and lowest tension of a strip that occur on it [N/m].
    cema_lift_off : float or None
        Least radius against lift-off that CEMA recommends; concave curves only.
    cema_buckling : float or None
        Least radius at which the middle keeps the tension that CEMA asks for; convex curves only.
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
    most: float | None = None
    least: float | None = None
    cema_lift_off: float | None = None
    cema_buckling: float | None = None


@dataclass(frozen=True)
class TransitionCheck:
    """Length of a transition and the least ones [m]; None where data are missing.

    Attributes
    ----------
    zone : TransitionZone
        Transition of the spec.
    lowest, highest : float
        Mean tensions of the belt that occur in it [N/m].
    allowed : float or None
        Highest tension allowed in a strip [N/m].
    stretched, slackened : float or None
        Least lengths at which no strip is overstressed or slack; infinite where no length helps.
    most, least : float or None
        Highest and lowest tension of a strip that occur over the given length [N/m].
    missing : str
        Missing data, in words.
    cema : float or None
        Least length that CEMA recommends at the highest tension; None too at an angle that its tables do not have.
    by_rule : float or None
        Least length of a pipe by rule of thumb; None of a trough.
    """

    zone: TransitionZone
    lowest: float
    highest: float
    allowed: float | None = None
    stretched: float | None = None
    slackened: float | None = None
    most: float | None = None
    least: float | None = None
    missing: str = ""
    cema: float | None = None
    by_rule: float | None = None


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
    per_width_steady, per_width, rating : float
        Highest tension per width in steady running and in all states, and the belt's rated one [N/m]; None without.
    strength_needed : mapping of str to float
        Strength class by the endurance of the splice, DIN 22101:2002, by load [N/m]: mean tension and strips of
        transitions and curves in steady running, mean tension of all states; empty without the splice's.
    pulleys : tuple of PulleyCheck
        Empty for carcasses without a rule.
    drive_diameter : float or None
        Least diameter of the drive pulleys [m].
    curves : tuple of CurveCheck
        Every vertical curve of a trough or flat belt on both strands.
    transitions : tuple of TransitionCheck
        Transitions of the spec.
    """

    largest_steady: float
    largest: float
    safety_steady: float | None
    safety: float | None
    safety_needed: float
    per_width_steady: float
    per_width: float
    rating: float | None
    strength_needed: Mapping[str, float]
    pulleys: tuple[PulleyCheck, ...]
    drive_diameter: float | None
    curves: tuple[CurveCheck, ...]
    transitions: tuple[TransitionCheck, ...] = ()


def belt_duty(balance: Balance, states: Sequence[MotionState] = ()) -> BeltDuty:
    """Check belt, pulleys, vertical curves and transitions against the tensions of every state.

    Parameters
    ----------
    balance : Balance
        The conveyor.
    states : sequence of MotionState, optional
        States for curves and transitions; by default those that decide the setting of the take-up.
    """
    states = states or tuple(balance.equilibrium.states.values())
    belt = balance.line.belt
    steady, largest = _largest_running(balance), balance.tensions.largest

    def safety(tension: float) -> float | None:
        if belt.strength is None:
            return None
        return belt_safety(tension, nominal_strength=belt.strength, belt_width=belt.width)

    return BeltDuty(
        largest_steady=steady,
        largest=largest,
        safety_steady=safety(steady),
        safety=safety(largest),
        safety_needed=classic_safety(balance.line),
        per_width_steady=steady / belt.width,
        per_width=largest / belt.width,
        rating=belt.rating,
        strength_needed={} if belt.splice_strength is None else _splice_strengths(balance, belt.splice_strength),
        pulleys=tuple(_pulley_checks(balance)),
        drive_diameter=_drive_diameter(balance.line),
        curves=tuple(_curve_checks(balance, states)),
        transitions=tuple(_transition_check(balance.line, zone, states) for zone in balance.line.transitions),
    )


def _splice_strengths(balance: Balance, endurance: float) -> dict[str, float]:
    """Strength class needed for the splice [N/m], by load; a start may load it `RATED_START` times."""
    belt, steady = balance.line.belt, balance.equilibrium.running
    zones = [_transition_check(balance.line, zone, steady).most for zone in balance.line.transitions]
    curves = [curve.most for curve in _curve_checks(balance, steady)]
    curves += [curve.most for curve in pipe_curve_checks(balance.line, steady)]
    strips = [most for most in (*zones, *curves) if most is not None]
    loads = {
        "steady": _largest_running(balance) / belt.width,
        "strips of transitions and curves, steady": max(strips, default=None),
        "starting and stopping": balance.tensions.largest / belt.width / RATED_START,
    }
    return {
        name: required_strength(
            load,
            splice_strength=endurance,
            s0=SPLICE_SAFETY[belt.splice_making],
            s1=DUTY_SAFETY[belt.duty],
        )
        for name, load in loads.items()
        if load is not None
    }


def _largest_running(balance: Balance) -> float:
    """Largest tension at constant speed, whatever the friction [N]."""
    return max(state.largest for state in balance.equilibrium.running)


def _drive_diameter(line: Line) -> float | None:
    belt = line.belt
    for carcass in PULLEY_FACTOR:
        if belt.carcass == carcass:
            return least_pulley_diameter(belt.carcass_thickness, carcass=carcass)
    return None


def _pulley_checks(balance: Balance) -> Iterator[PulleyCheck]:
    line, allowed = balance.line, allowed_tension(balance.line)
    drive = _drive_diameter(line)
    if drive is None:
        return
    running = balance.equilibrium.running
    lowest = min(float(min(state.starts.min(), state.ends.min())) for state in running)
    high = 0.5 * (lowest + _largest_running(balance))
    for i, pulley in enumerate(line.pulleys):
        if pulley.assumed:  # of the least diameter
            continue
        most = max(max(pulley_tensions(balance, i, state)) for state in running)
        group, used, full = _pulley_group(pulley, tight=most > high), None, 1.0
        if allowed is not None:
            used = full = max(0.0, most) / (line.belt.width * allowed)
        least = pulley_group_diameter(drive, group=group, utilisation=full)
        size = None
        if line.us_sizes:
            size = next_pulley_diameter(least, series=CEMA_PULLEYS) if least <= CEMA_PULLEYS[-1] else None
        elif drive <= PULLEY_DIAMETERS[-1]:
            size = standard_pulley_diameter(drive, group=group, utilisation=full)
        yield PulleyCheck(pulley.name, pulley.position, group, used, pulley.diameter, least, size)


def _pulley_group(pulley: BendPulley, *, tight: bool) -> Group:
    """Group of a pulley; `tight` above the middle of the lowest and highest tension of the loop in steady running."""
    if pulley.driven:
        return "A"
    if pulley.wrap_angle < SNUB_WRAP:
        return "C"
    return "A" if tight else "B"


def _curve_checks(balance: Balance, states: Sequence[MotionState]) -> Iterator[CurveCheck]:
    line = balance.line
    sections = {section.name: section for section in line.sections if section.curve is not None}
    for i, stretch in enumerate(line.loop.stretches):
        section = sections.get(stretch.section)
        if section is None or section.curve is None or stretch.closed:
            continue
        tensions = [float(end[i]) for state in states for end in (state.starts, state.ends)]
        lowest, highest = min(tensions), max(tensions)
        lift = by_cema = slack_by_cema = None
        if section.curve == "concave":
            pull, weight = max(0.0, highest), {"belt_mass": stretch.belt_mass, "gravity": line.gravity}
            lift = lift_off_radius(pull, inclination=section.steepest, uplift=line.uplift, **weight)
            by_cema = cema_lift_off_radius(pull, **weight)
        else:
            slack_by_cema = _cema_buckling_radius(line, stretch, lowest)
        strips = _vertical_strips(line, stretch, section, lowest, highest)
        yield CurveCheck(
            stretch.section,
            stretch.strand,
            section.curve,
            abs(section.radius),
            lowest,
            highest,
            lift,
            *strips,
            by_cema,
            slack_by_cema,
        )


def _cema_buckling_radius(line: Line, stretch: Stretch, lowest: float) -> float | None:
    """Least radius of a convex curve at which the middle keeps CEMA's tension [m]; infinite where none does.

    None without the belt's stiffness, and of other sets than those of three rolls or one, for which it is given.
    """
    width, stiffness = line.belt.width, line.belt.tensile_stiffness
    if stiffness is None or stretch.idlers.rolls not in {1, 3}:
        return None
    below = cema_middle_below(width, trough_angle=stretch.trough_angle)
    return taut_radius(lowest / width, below, stiffness, CEMA_LEAST_TENSION)


def _vertical_strips(line: Line, stretch: Stretch, section: RouteSection, lowest: float, highest: float) -> StripLimits:
    """Least radii against overstress and slack, and highest and lowest strip tension of a vertical curve."""
    width = line.belt.width
    trough = trough_of_stretch(stretch, width)
    stretched, slackened = trough.edge_above, trough.middle_below
    if section.curve == "concave":
        stretched, slackened = slackened, stretched
    return strip_limits(
        line, lowest / width, highest / width, radius=abs(section.radius), stretched=stretched, slackened=slackened
    )


def trough_of_stretch(stretch: Stretch, width: float) -> TroughSection:
    """Cross-section of a belt of a width in the trough of a stretch."""
    return trough_section(
        width,
        middle_roll_length=stretch.idlers.middle_belt(width),
        trough_angle=stretch.trough_angle,
        inner_wing=stretch.idlers.inner_wing,
    )


def _transition_check(line: Line, zone: TransitionZone, states: Sequence[MotionState]) -> TransitionCheck:
    """Check a transition for the tensions there in every state."""
    width, half = line.belt.width, line.count
    starts, at = {
        ("head", "carry"): (False, -1), ("tail", "carry"): (True, half),
        ("head", "return"): (True, 0), ("tail", "return"): (False, half - 1),
    }[zone.end, zone.strand]  # fmt: skip
    tensions = [float((state.starts if starts else state.ends)[at]) for state in states]
    stretch = line.loop.stretches[at]
    shape = stretch.idlers.shape
    lowest, highest = min(tensions) / width, max(tensions) / width
    rated, stiffness = allowed_tension(line), line.belt.tensile_stiffness
    if rated is None:
        return TransitionCheck(zone, lowest, highest, missing="belt.carcass.strength and rating not given")
    by_rule, by_cema = shape.forming_length, None if shape.closed else cema_transition_length(
        width, trough_angle=stretch.trough_angle, utilisation=max(0.0, highest) / rated,
        carcass=line.belt.carcass, pulley_height=zone.pulley_height,
    )  # fmt: skip
    if stiffness is None:
        return TransitionCheck(
            zone, lowest, highest, missing="belt.carcass.stiffness not given", cema=by_cema, by_rule=by_rule
        )
    zone_length = shape.transition_stretch(width, zone.pulley_height)
    allowed = EDGE_OVER_RATED * rated

    def least(tension: float, stretch: float, limit: float) -> float:
        return transition_length(tension, stretch=stretch, stiffness_per_width=stiffness, limit_per_width=limit)

    most = lower = None
    if zone.length is not None:
        most = highest + stiffness * zone_length.largest / zone.length**2
        lower = lowest + stiffness * zone_length.least / zone.length**2
    return TransitionCheck(
        zone,
        lowest,
        highest,
        allowed,
        least(max(0.0, highest), zone_length.largest, allowed),
        least(max(0.0, lowest), zone_length.least, 0.0),
        most,
        lower,
        cema=by_cema,
        by_rule=by_rule,
    )
