"""Checks of scenarios: one function per criterion, as in `conveyor.checks`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.checks import Check, check_against_limit, pass_or_fail
from conveyor.dynamics.scenario_result import ScenarioResult
from conveyor.dynamics.simulation import CalculatedDynamics
from conveyor.laws.belt_strength import (
    CLASSIC_SAFETY,
    DUTY_SAFETY,
    RATED_START,
    SPLICE_SAFETY,
    belt_safety,
    required_strength,
)
from conveyor.laws.motion import bulk_slip_limits
from conveyor.laws.vertical_curve import lift_off_radius
from conveyor.laws.waves import MOVING_SAG, SLACK_SAG
from conveyor.units.sentences import Message, escape_braces, message, percent

FULL_SPEED: Final = 0.95
"""Speed over the steady one at which a start is over [-]; general knowledge: motors run within their slip."""
_RATED_START_SOURCE: Final = f"{RATED_START:g} times the tension allowed in steady running, general knowledge"
OVERSPEED: Final = 1.1
"""Speed over the steady one that a belt may reach without power [-]; general knowledge."""

_AT_LIMIT: Final = 1e-6  # rounding of the limit [-]
_BACK_SWING: Final = (0.02, 0.02)
"""Speed backward that a swing may reach, over the steady one [-] and of slow belts [m/s]; general knowledge."""


@dataclass(frozen=True)
class Peak:
    """Extreme tensions of a stretch or at a pulley [N, s], the least for sag in steady running [N], and the sag [-]."""

    section: str
    strand: str
    highest: float
    highest_at: float
    lowest: float
    lowest_at: float
    least_for_sag: float
    sag: float

    @classmethod
    def of(
        cls,
        scenario: ScenarioResult,
        cells: slice | NDArray[np.int_],
        section: str,
        strand: str = "",
        least: float = 0.0,
    ) -> Peak:
        """Extremes of some cells."""
        record = scenario.record
        high, low = int(record.highest[cells].argmax()), int(record.lowest[cells].argmin())
        return cls(
            section, strand, float(record.highest[cells][high]), float(record.highest_at[cells][high]),
            float(record.lowest[cells][low]), float(record.lowest_at[cells][low]), least,
            float(scenario.sag[cells].max()),
        )  # fmt: skip


def tension_peaks(scenario: ScenarioResult) -> Iterator[Peak]:
    """Extreme tensions of every stretch, in belt order from the take-up."""
    shape = scenario.line.loop
    for k, cells in scenario.stretches():
        stretch = shape.stretches[k]
        yield Peak.of(scenario, cells, stretch.section, stretch.strand, float(shape.least[k]))


def pulley_peak(scenario: ScenarioResult, pulley: int) -> Peak:
    """Extreme tensions of the belt on both sides of a pulley of the line."""
    return Peak.of(scenario, scenario.beside(pulley), scenario.line.pulleys[pulley].name)


def _belt_strength(scenario: ScenarioResult) -> Iterator[Check]:
    belt = scenario.line.belt
    i = int(scenario.record.highest.argmax())
    where = f"{scenario.place(i)}, {scenario.record.highest_at[i]:.1f} s"
    most = f"DIN 22101:1982 in steady running; {_RATED_START_SOURCE}"
    if belt.strength is not None:
        needed = CLASSIC_SAFETY["steel cord" if belt.steel_cord else "textile"] / RATED_START
        safety = belt_safety(scenario.highest, nominal_strength=belt.strength, belt_width=belt.width)
        why = message("safety of the belt {} at {}, {} required", (safety, "safety"), (scenario.highest, "force"),
                   (needed, "safety"))  # fmt: skip
        yield check_against_limit("dynamic_safety", "safety of the belt", safety, "at least", needed, "safety",
                       source=most, why=why, where=where)  # fmt: skip
    if belt.rating is not None:
        tension = scenario.highest / belt.width
        yield check_against_limit("dynamic_rating", "belt tension per width", tension, "at most",
        RATED_START * belt.rating,
                       "belt rating", source=_RATED_START_SOURCE, why="the belt bears {calculated}",
                       where=where)  # fmt: skip


def _splice_strength(scenario: ScenarioResult) -> Iterator[Check]:
    """Belt strength for a splice at the highest tension."""
    belt = scenario.line.belt
    if belt.strength is None or belt.splice_strength is None:
        return
    i = int(scenario.record.highest.argmax())
    needed = required_strength(
        scenario.highest / (RATED_START * belt.width), splice_strength=belt.splice_strength,
        s0=SPLICE_SAFETY[belt.splice_making], s1=DUTY_SAFETY[belt.duty],
    )  # fmt: skip
    yield check_against_limit(
        "dynamic_splice", "belt strength for the splice", belt.strength, "at least", needed, "belt strength",
        why="a splice there requires a belt of {required}, given: {calculated}",
        source=f"DIN 22101:2002, {_RATED_START_SOURCE}",
        where=f"{scenario.place(i)}, {scenario.record.highest_at[i]:.1f} s",
    )  # fmt: skip


def _belt_sag(scenario: ScenarioResult) -> Iterator[Check]:
    """Sag between idlers; from a tenth of the span on the belt is slack."""
    i = int(scenario.sag.argmax())
    sag, at = float(scenario.sag[i]), f"{scenario.place(i)}, {scenario.record.lowest_at[i]:.1f} s"
    least = float(scenario.cells.slack[i])
    help_ = "raise the take-up's tension (--size take-up says how far), or slow the motion by ramps or flywheels"
    yield check_against_limit(
        "dynamic_slack", "belt is taut", float(scenario.record.lowest[i]), "at least", least, "force", where=at,
        why=f"the belt goes slack in {escape_braces(scenario.place(i))} at {scenario.record.lowest_at[i]:.1f} s: "
            f"down to "
        f"{{calculated}}; {help_}", source=f"sag of {percent(SLACK_SAG.value)} of the span, general knowledge",
    )  # fmt: skip
    most = MOVING_SAG.value
    yield check_against_limit(
        "dynamic_sag", "sag over the span", sag, "at most", most, "fraction", wording=message(percent(sag)),
        asked=message(f"at most {percent(most)} (general knowledge)"), where=at,
        why=f"the belt sags by {percent(sag)} of the span in {escape_braces(scenario.place(i))}; {help_}",
    )  # fmt: skip


def _lift_off_radius(scenario: ScenarioResult) -> Iterator[Check]:
    sections = {section.name: section for section in scenario.line.sections if section.curve == "concave"}
    stretches = {f"{s.section}, {s.strand}": s for s in scenario.line.loop.stretches}
    for peak in tension_peaks(scenario):
        if peak.section not in sections:
            continue
        stretch, section = stretches[f"{peak.section}, {peak.strand}"], sections[peak.section]
        if stretch.closed:
            continue
        radius = abs(section.radius)
        least = lift_off_radius(max(peak.highest, 0.0), belt_mass=stretch.belt_mass, inclination=section.steepest,
                                gravity=scenario.line.gravity, uplift=scenario.line.uplift)  # fmt: skip
        why = "the empty belt lifts off on the concave curve of {calculated}; at least {required} are needed"
        yield check_against_limit("dynamic_lift_off",
        f"empty belt stays down, {escape_braces(peak.section)}, {peak.strand}", radius,
                       "at least", least, "length", why=why, where=f"{peak.highest_at:.1f} s")  # fmt: skip


def _drive_grip(scenario: ScenarioResult) -> Iterator[Check]:
    for d, drive in enumerate(scenario.setup.drives):
        way, heat = float(scenario.record.slipped[d]), float(scenario.record.heat[d])
        yield check_against_limit(
            "dynamic_grip", f"grip of {escape_braces(drive.name)}", way, "at most", 0.0, "length",
            asked=message("no slip"),
            wording=message("no slip") if way == 0.0 else message("slips {}", (way, "length")),
            why=message(
                f'the belt slips on "{escape_braces(drive.name)}" by {{}} and heats it with {{}}; raise the '
                "take-up's tension (--size take-up says how far), the wrap or the friction, or slow the motion",
                (way, "length"), (heat, "heat"),
            ),
        )  # fmt: skip


def _motor_torque(scenario: ScenarioResult) -> Iterator[Check]:
    """Motors stay within their limits; time at the limit is reported."""
    for d, drive in enumerate(scenario.setup.drives):
        name, most = (
            escape_braces(drive.name),
            float(scenario.setup.limits()[d].max() / scenario.setup.rated[d]),
        )
        size = np.abs(scenario.torque[:, d])
        held = float((size >= (1.0 - _AT_LIMIT) * most).sum()) * scenario.record.step
        words = f", at its limit for {held:.1f} s" if held else ""
        yield check_against_limit(
            "dynamic_torque", f"torque of {name} over rated", float(size.max()), "at most", (1.0 + _AT_LIMIT) * most,
            "safety", source="its limit", wording=message(f"{{}}{words}", (float(size.max()), "safety")),
        )  # fmt: skip
        if drive.power is not None:
            turned = scenario.record.drives["motor"][:, d] * scenario.record.drives["rim"][:, d]
            power = float(np.abs(turned).max()) / scenario.line.efficiency
            why = message(
                f'"{name}" gives {{}}, its torque limit allows {{}}',
                (power, "power"),
                (most * drive.power, "power"),
            )
            yield check_against_limit("dynamic_power", f"motor power of {name}", power, "at most",
            OVERSPEED * most * drive.power,
                           "power", source="torque limit at overspeed", why=why)  # fmt: skip


def _roll_back(scenario: ScenarioResult) -> Iterator[Check]:
    """The belt does not roll back; backstops hold it, given or assumed."""
    least, (share, slow) = float(scenario.belt_speed.min()), _BACK_SWING
    yield check_against_limit(
        "dynamic_backward", "belt does not roll back", max(0.0, -least), "at most",
        max(share * scenario.line.speed, slow), "speed", source="the swing of a wave, general knowledge",
        why="the belt rolls back at {calculated}: a backstop or a brake is needed",
    )  # fmt: skip
    for d, drive in enumerate(scenario.setup.drives):
        held = max(0.0, -float(scenario.record.drives["holding"][:, d].min()))
        if not scenario.setup.backstops[d] or held == 0.0:
            continue
        shown = message("{} at the belt", (held, "force"))
        if drive.radius is not None:
            shown = message("{} at the pulley's shaft", (held * drive.radius, "torque"))
        assumed = scenario.setup.assumed_backstop
        why = message("the spec names no backstop (drive.backstop); one is assumed")
        yield Check("dynamic_backstop", message(f"backstop of {escape_braces(drive.name)}"), held, None, "force", shown,
                    message("a backstop"), "not checked" if assumed else "pass", why if assumed else None)  # fmt: skip


def _take_up_travel(scenario: ScenarioResult) -> Iterator[Check]:
    """The carriage stays within the take-up's travel for start, stop and reserve."""
    duty = scenario.setup.given.steady.take_up.travel
    if duty is None or scenario.line.take_up.keeps_length:
        return
    way = float(np.ptp(scenario.travel))
    room = duty.whole - duty.tensioning
    why = "the carriage of the take-up moves by {calculated}; its computed travel, with the belt taut, is {required}"
    yield check_against_limit(
        "dynamic_travel", "way of the take-up's carriage", way, "at most", room, "length", why=why
    )


def _final_speed(scenario: ScenarioResult) -> Iterator[Check]:
    """A stop comes to rest without running away; a start reaches full speed."""
    full, (top, place, at) = scenario.line.speed, scenario.top_speed
    if scenario.stops:
        words = message("not within the calculated time")
        if scenario.rests_at is not None:
            words = message(f"in {scenario.rests_at:,.1f} s, {{}}", (scenario.way, "length"))
        why = message("the belt does not stop; {} at the end", (float(scenario.belt_speed[-1]), "speed"))
        yield Check("dynamic_rest", message("stopping"), scenario.rests_at, None, "duration", words, message("a stop"),
                    pass_or_fail(holds=scenario.rests_at is not None), why)  # fmt: skip
        yield check_against_limit("dynamic_overspeed", "speed of the belt", top, "at most", OVERSPEED * full, "speed",
                       source="general knowledge", where=f"{place}, {at:.1f} s",
                       why=f"the belt runs away to {{calculated}}, most in {escape_braces(place)}")  # fmt: skip
    elif not scenario.setup.scene.running:
        end = float(scenario.belt_speed[-1])
        yield check_against_limit("dynamic_full_speed", "speed at the end", end, "at least", FULL_SPEED * full, "speed",
                       why="the belt reaches {calculated}")  # fmt: skip


def _bulk_slip(scenario: ScenarioResult) -> Iterator[Check]:
    """The bulk does not slip, by means over `SLIDING_TIME`, on stretches where it rests at steady speed."""
    line, worst = scenario.line, []
    for k, cells in scenario.stretches():
        stretch = line.loop.stretches[k]
        grip = line.bulk_belt_friction - abs(np.tan(stretch.inclination))
        if stretch.bulk_mass == 0.0 or grip <= 0.0:
            continue
        low, high = bulk_slip_limits(line.bulk_belt_friction, inclination=stretch.inclination, gravity=line.gravity)
        hardest = float(scenario.record.slowest[cells.start : cells.stop + 1].min())
        fastest = float(scenario.record.fastest[cells.start : cells.stop + 1].max())
        worst += [
            (-hardest / -low, -hardest, -low, stretch.section),
            (fastest / high, fastest, high, stretch.section),
        ]
    if worst:
        _, most, allowed, section = max(worst)
        why = f'the bulk slides in "{escape_braces(section)}": {{calculated}}, {{required}} are allowed'
        yield check_against_limit("dynamic_bulk", "no material slip", most, "at most", allowed, "acceleration", why=why,
                       where=section)  # fmt: skip


DYNAMICS_CRITERIA: Final[tuple[Callable[[ScenarioResult], Iterator[Check]], ...]] = (
    _belt_strength, _splice_strength, _belt_sag, _lift_off_radius, _drive_grip, _motor_torque, _roll_back,
    _take_up_travel, _final_speed, _bulk_slip,
)  # fmt: skip


def dynamics_checks(dynamics: CalculatedDynamics) -> tuple[Check, ...]:
    """Every criterion of every scenario; for a backstop, which has no limit, the scenario that loads it most."""
    every = [*_unanswered_scenarios(dynamics)] + [
        replace(check, case=scenario_case(followed))
        for followed in dynamics.followed
        for criterion in DYNAMICS_CRITERIA
        for check in criterion(followed)
    ]
    most: dict[Message, Check] = {}
    for check in every:
        if check.key == "dynamic_backstop":
            most[check.subject] = max(most.get(check.subject, check), check, key=lambda one: one.calculated or 0.0)
    return tuple(check for check in every if check is most.get(check.subject, check))


def _unanswered_scenarios(dynamics: CalculatedDynamics) -> Iterator[Check]:
    count = f"{len(dynamics.refused)} of {len(dynamics.followed) + len(dynamics.refused)}"
    for refusal in dynamics.refused:
        yield Check(
            "dynamic_answer", message("answer to every scenario"), None, None, "number", message(f"none to {count}"),
            message("an answer"), "FAIL", refusal.reason, case=message(escape_braces(refusal.scenario)),
        )  # fmt: skip


def scenario_case(scenario: ScenarioResult) -> Message:
    """A scenario as the case of a check."""
    return message(escape_braces(scenario.name))
