"""Checks of a conveyor: one function for each criterion.

The same functions check a run and each of its load cases; warnings and all outputs use their results. The case of the
least margin governs a criterion.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.belt_strength import RATED_START
from conveyor.laws.motion import Stop
from conveyor.laws.pulley import HUB_SLOPE, SHAFT_SAFETY
from conveyor.laws.take_up import SCREW_LENGTH
from conveyor.laws.tension import grip_tension
from conveyor.laws.wind import AIR_DENSITY, WIND_LIFT, lifting_speed
from conveyor.line.covers import compounds_by_strand
from conveyor.line.line import Line
from conveyor.line.roll_lives import SERIES_RATED_LIFE, shortest_set_life
from conveyor.line.stretches import STRANDS, Strand
from conveyor.loop.belt_duty import CurveCheck, TransitionCheck
from conveyor.loop.drive_duty import coasting_flywheel
from conveyor.loop.equilibrium import tension_suffices
from conveyor.loop.horizontal_curve_duty import DriftState, HorizontalCurveCheck
from conveyor.loop.set_duty import SetDuty
from conveyor.loop.start_and_stop import motion_states
from conveyor.loop.take_up_duty import TakeUpDuty, take_up_weight_mass
from conveyor.loop.ties import first_maximum
from conveyor.loop.worst_loadings import SINGLE_CHANGE_SECTIONS
from conveyor.units.sentences import Message, escape_braces, format_band, message, percent

Verdict = Literal["pass", "FAIL", "not checked"]
Relation = Literal["at least", "at most"]

_AT_MOST: Final[Relation] = "at most"
_AT_LEAST: Final[Relation] = "at least"
_HALF_TROUGH: Final = 0.5
_FIGURE_PATTERN: Final = re.compile(r"(?<!{){(?:calculated|required)}(?!})")
_MARGIN_DIGITS: Final = 9
"""Digits of margins, so that rounding does not decide between equals, see `conveyor.loop.ties`."""
MAX_PENETRATION: Final = 0.2
"""Largest Δ/h for linear small-strain theory; strain is about Δ/h [-]."""


@dataclass(frozen=True)
class Check:
    """Result of one criterion.

    Attributes
    ----------
    key : str
        Key of the criterion in files.
    subject : Message
        What is checked.
    calculated, required : float or None
        Values in SI; None without a figure.
    kind : str
        Kind of quantity of both.
    found, asked : Message
        Both in words, with their units.
    verdict : {"pass", "FAIL", "not checked"}
        "not checked" where the spec lacks data for it.
    why : Message or None
        Message where it fails.
    relation : {"at least", "at most"}
        Relation of the calculated to the required figure.
    where : str
        Governing state of motion or section.
    case : Message or None
        The load case; None for the conveyor as its spec gives it.

    Examples
    --------
    >>> required = message("at most {}", (1.6e6, "power"))
    >>> Check(
    ...     "motor_power",
    ...     message("motor power"),
    ...     1.25e6,
    ...     1.6e6,
    ...     "power",
    ...     message("{}", (1.25e6, "power")),
    ...     required,
    ...     "pass",
    ... )
    Check("motor power": 1,250 kW, at most 1,600 kW: pass)
    """

    key: str
    subject: Message
    calculated: float | None
    required: float | None
    kind: str
    found: Message
    asked: Message
    verdict: Verdict
    why: Message | None = None
    relation: Relation = "at least"
    where: str = ""
    case: Message | None = None

    def __repr__(self) -> str:
        case = "" if self.case is None else f' in "{self.case}"'
        return f'Check("{self.name}"{case}: {self.found}, {self.asked}: {self.verdict})'

    @property
    def failed(self) -> bool:
        """True if the criterion is not met."""
        return self.verdict == "FAIL"

    @property
    def name(self) -> Message:
        """Subject of the check with the governing state or section."""
        if not self.where:
            return self.subject
        return replace(self.subject, words=f"{self.subject.words} ({escape_braces(self.where)})")

    @property
    def margin(self) -> float | None:
        """Relative margin of the calculated to the required figure, positive on the safe side [-].

        Calculated over required less 1 for "at least", 1 less calculated over required for "at most";
        None where a figure is missing, the required one is 0, or both are temperatures, which have no ratio.
        """
        if self.calculated is None or not self.required or self.kind == "temperature":
            return None
        over = (self.calculated - self.required) / abs(self.required)
        return over if self.relation == "at least" else -over

    @property
    def use(self) -> float | None:
        """Utilisation of the limit [-]; None where a figure is missing or 0."""
        if not self.calculated or not self.required:
            return None
        ratio = self.calculated / self.required
        return ratio if self.relation == "at most" else 1.0 / ratio


def highest_use(checks: Iterable[Check], keys: Collection[str]) -> tuple[float | None, Check | None]:
    """Highest utilisation among checks of these keys [-] and its check; None without one."""
    used = [(one.use, one) for one in checks if one.key in keys and one.use is not None]
    return max(used, key=lambda pair: pair[0] or 0.0, default=(None, None))


BELT_STRENGTH_CRITERIA: Final = frozenset({"belt_safety", "belt_rating"})
"""Criteria of belt tension, by strength or rating."""


def pass_or_fail(*, holds: bool) -> Verdict:
    """Return pass or FAIL."""
    return "pass" if holds else "FAIL"


def check_against_limit(  # noqa: PLR0917 reads as the sentence it checks
    key: str,
    subject: str | Message,
    calculated: float,
    relation: Relation,
    required: float | None,
    kind: str,
    *,
    source: str = "",
    wording: Message | None = None,
    asked: Message | None = None,
    holds: bool | None = None,
    missing: str = "",
    why: Message | str | None = None,
    where: str = "",
) -> Check:
    """Check a figure against its limit.

    Parameters
    ----------
    key, subject : str
        Key and subject of the criterion.
    calculated, required : float
        Values in SI; `required` is None if unknown.
    relation : {"at least", "at most"}
        Relation of the calculated to the required figure.
    kind : str
        Kind of quantity of both.
    source : str
        Source of the limit.
    wording : Message, optional
        The calculated figure in other words.
    asked : Message, optional
        The required figure in other words.
    holds : bool, optional
        Result, where the figures alone do not decide.
    missing : str
        Message where no limit is known.
    why : Message or str, optional
        Message where it fails; in a str {calculated} and {required} are replaced by the figures.
    where : str
        Governing state or section.
    """
    shown = message("{}", (calculated, kind)) if wording is None else wording
    name = message(subject) if isinstance(subject, str) else subject
    if required is None:
        shortfall = message(missing)
        return Check(key, name, calculated, None, kind, shown, shortfall, "not checked", None, relation, where)
    if holds is None:
        holds = calculated >= required if relation == "at least" else calculated <= required
    if asked is None:
        asked = message(f"{relation} {{}}{f' ({source})' if source else ''}", (required, kind))
    if isinstance(why, str):
        figures = {"{calculated}": (calculated, kind), "{required}": (required, kind)}
        why = Message(_FIGURE_PATTERN.sub("{}", why), tuple(figures[word] for word in _FIGURE_PATTERN.findall(why)))
    judged = pass_or_fail(holds=holds)
    return Check(key, name, calculated, required, kind, shown, asked, judged, why, relation, where)


def run_checks(result: CalculatedConveyor, *, contacts: bool = True) -> tuple[Check, ...]:
    """Check one calculation for every criterion in the order of `CRITERIA`; `CONTACT_CRITERIA` only with contacts."""
    chosen = [criterion for criterion in CRITERIA if contacts or criterion not in CONTACT_CRITERIA]
    return tuple(check for criterion in chosen for check in criterion(result))


def governing_by_subject(every: Iterable[Check]) -> tuple[Check, ...]:
    """Governing check of each criterion and subject, those of one criterion together.

    A failed check goes before a passed one, that before one not checked; then the least margin decides, among equals
    the first.
    """
    groups: dict[str, dict[Message, list[Check]]] = {}
    for check in every:
        groups.setdefault(check.key, {}).setdefault(check.subject, []).append(check)
    return tuple(min(group, key=severity_rank) for of in groups.values() for group in of.values())


def governing_by_criterion(checks: Iterable[Check]) -> tuple[Check, ...]:
    """Governing check of each criterion over all subjects."""
    groups: dict[str, list[Check]] = {}
    for check in checks:
        groups.setdefault(check.key, []).append(check)
    return tuple(min(group, key=severity_rank) for group in groups.values())


def severity_rank(check: Check) -> tuple[int, float, float]:
    """Sort key of a check: the least governs; a failure without margin comes first.

    Among checks of a calculated 0, which has the same margin for any limit, the larger requirement governs; without a
    limit the one without a figure, else the lowest or highest.
    """
    margin, further = check.margin, 0.0
    sign = 1.0 if check.relation == "at least" else -1.0
    if check.required is not None and check.calculated is not None:
        over = sign * (check.calculated - check.required)
        margin = over if margin is None else margin
        further = 0.0 if check.calculated else over
    else:
        margin = -math.inf if check.failed else math.inf
        further = -math.inf if check.calculated is None else sign * check.calculated
    order = ("FAIL", "pass", "not checked").index(check.verdict)
    return order, round(margin, _MARGIN_DIGITS), float(f"{further:.{_MARGIN_DIGITS}g}")


def belt_filling(result: CalculatedConveyor) -> Iterator[Check]:
    """Every section holds its bulk on its slope."""
    line, holds_on = result.line, result.conveyor.section_on_slope
    loaded = [
        (stretch, stretch.bulk_mass / line.density, holds_on(stretch.inclination))
        for stretch in line.stretches[: line.count]
        if stretch.bulk_mass > 0.0
    ]
    if loaded:
        stretch, bulk, most = first_maximum(loaded, lambda one: -one[2] / one[1])
        section = f'section "{escape_braces(stretch.section)}"'
        why = message(f"the bulk takes {{}}, {section} holds nothing on its slope", (bulk, "area"))
        if most > 0.0:
            flooded = (result.conveyor.flooded_section, "area")
            spills = [flooded] if bulk > flooded[0] else []
            why = message(
                f"the bulk takes {{}}, {percent(bulk / most)} of the {{}} that {section} holds on its slope"
                f"{', and spills beyond {}, heaped from edge to edge' if spills else ''}: reduce "
                "material.flow to {}, raise belt.speed to {}, or take a wider belt",
                (bulk, "area"), (most, "area"), *spills,
                (line.flow * most / bulk, "mass flow"), (line.speed * bulk / most, "speed"),
            )  # fmt: skip
        yield check_against_limit(
            "filling", "filling of the belt", bulk, "at most", most, "area", source="ISO 5048",
            wording=message(f"{{}}, {percent(bulk / holds_on(0.0))} of the level cross-section", (bulk, "area")),
            where=stretch.section, why=why,
        )  # fmt: skip


def motor_power(result: CalculatedConveyor) -> Iterator[Check]:
    """Every drive's motors give or hold its share in steady running, with the friction at both ends of its band."""
    line, motor = result.line, result.balance.frame.motor
    low, high = result.drive_forces
    for drive in line.drives:
        least, most = motor(drive.share * low), motor(drive.share * high)
        certain = abs(least) > abs(most)
        power = least if certain else most
        who = "the motor" if len(line.drives) == 1 else f'"{escape_braces(drive.name)}"'
        yield check_against_limit(
            "motor_power", f"motor power, {escape_braces(drive.name)}", abs(power), "at most", drive.power, "power",
            wording=message("{}" + (" (generating)" if power < 0.0 else ""), (abs(power), "power")),
            missing="installed power not given", where="least friction" if certain else "",
            why=f"{who} requires {{calculated}}, {{required}} are installed: install more power",
        )  # fmt: skip


def take_up_tension(result: CalculatedConveyor) -> Iterator[Check]:
    """The take-up's tension suffices for grip and sag in every state; names the governing or all failed conditions."""
    settled = result.balance.settled
    for name, asked in (settled.short or {settled.governing: settled.needed}).items():
        words, figures = _setting_text(result.line, asked)
        why = message(
            f"the take-up holds {{}}, {escape_braces(name)} requires {words}",
            (settled.setting, "force"),
            *figures,
        )
        yield check_against_limit(
            "take_up_tension", "take-up tension", settled.setting, "at least", asked, "force", holds=not settled.short,
            why=why, where=name,
        )  # fmt: skip


def _setting_text(line: Line, tension: float) -> tuple[str, tuple[tuple[float, str], ...]]:
    """Setting of the take-up in words, for a gravity take-up with its weight, and its figures."""
    if line.take_up.kind != "gravity":
        return "{}", ((tension, "force"),)
    return "{} (a weight of {})", ((tension, "force"), (take_up_weight_mass(line, tension), "mass"))


def take_up_travel(result: CalculatedConveyor) -> Iterator[Check]:
    """Travel and speed of the take-up suffice for this load; screws are for short conveyors only."""
    unit = result.line.take_up
    if unit.travel is not None or unit.winch is not None:
        yield from take_up_travel_checks(result.take_up)
    if unit.kind == "screw":
        yield check_against_limit(
            "screw_take_up", "length of a conveyor with a screw take-up", result.line.length, "at most", SCREW_LENGTH,
            "length", source="general knowledge", why="a screw take-up on {calculated}: give it a weight or a winch",
        )  # fmt: skip


def take_up_travel_checks(duty: TakeUpDuty) -> Iterator[Check]:
    """Travel and speed of the take-up suffice for the loads; if given."""
    unit, travel = duty.unit, duty.travel
    if unit.travel is not None and travel is not None:
        why = "the take-up has {required} of travel, {calculated} are needed"
        yield check_against_limit(
            "take_up_travel", "travel of the take-up", travel.whole, "at most", unit.travel, "length", why=why
        )
    if unit.winch is not None and duty.speed is not None:
        yield check_against_limit(
            "winch_speed", "speed of the winch through a start", duty.speed, "at most", unit.winch[0], "speed",
            why="the winch moves its carriage at {required}, a start asks for {calculated}: the belt slackens behind "
            "the drive meanwhile",
        )  # fmt: skip


def drive_grip(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt does not slip on any drive, in running, starting and stopping."""
    for state in motion_states(result.balance, result.motions):
        for drive, side in zip(result.line.drives, state.drives, strict=True):
            needed = grip_tension(side.force, friction=drive.friction, wrap_angle=drive.wrap_angle)
            name = escape_braces(drive.name)
            yield check_against_limit(
                "drive_grip", f"grip of {name}, {state.name}", side.slack, "at least", needed, "force",
                wording=message("{} on the slack side", (side.slack, "force")),
                holds=tension_suffices(side.slack, needed),
                why=f'the belt slips on "{name}" in the state "{state.name}": {{calculated}} on its slack side, '
                "{required} are needed; raise the take-up's tension, the wrap or the friction (lagging)",
            )  # fmt: skip


def belt_sag(result: CalculatedConveyor) -> Iterator[Check]:
    """Between no two idler sets the belt sags more than allowed while it runs steadily."""
    settled, shape = result.balance.settled, result.line.loop
    running = settled.running
    lowest = [np.minimum(state.starts, state.ends) for state in running]
    over = [(tension / shape.least).tolist() for tension in lowest]
    for strand in STRANDS:
        places = [
            (k, i) for k in range(len(running)) for i, stretch in enumerate(shape.stretches) if stretch.strand == strand
        ]
        k, i = min(places, key=lambda at: over[at[0]][at[1]])
        tension, needed, section = float(lowest[k][i]), float(shape.least[i]), shape.stretches[i].section
        yield check_against_limit(
            "sag", f"minimum tension (sag), {strand}", tension, "at least", needed, "force",
            holds=tension_suffices(tension, needed), where=f"{section}, {running[k].name}",
            why=f'the belt sags more than allowed in section "{escape_braces(section)}", {strand}: tension '
                f'{{calculated}}, '
            "{required} are needed",
        )  # fmt: skip


def slack_belt(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt is nowhere slack in any state of motion; names the slackest state or every one that fails."""
    states, settled = motion_states(result.balance, result.motions), result.balance.settled
    slack = [state for state in states if state.slack]
    for state in slack or [min(states, key=lambda state: state.smallest)]:
        words, figures = _setting_text(result.line, settled.setting - state.smallest)
        slower = ", or slow the stop by a flywheel or the drives" if state.acceleration < 0.0 else ""
        why = message(
            f'the belt goes slack in the state "{state.name}": down to {{}}; raise the take-up\'s tension from {{}} to '
            f"about {words}{slower}",
            (state.smallest, "force"), (settled.setting, "force"), *figures,
        )  # fmt: skip
        yield check_against_limit(
            "slack_belt", "minimum belt tension, all states", state.smallest, "at least", 0.0, "force",
            asked=message("at least 0 (not slack)"), where=state.name, why=why,
        )  # fmt: skip


def belt_safety(result: CalculatedConveyor) -> Iterator[Check]:
    """Belt strength over its steady tension; not for a belt given by its rating alone."""
    duty, subject = result.belt_duty, message("belt safety factor, steady")
    if duty.safety_steady is None and duty.rating is not None:
        return
    safety, needed = duty.safety_steady, duty.safety_needed
    asked = message("at least {} (DIN 22101:1982)", (needed, "number"))
    if safety is None:
        shown = message("strength not given")
        yield Check("belt_safety", subject, None, needed, "safety", shown, asked, "not checked")
        return
    why = message(
        "safety of the belt {} in steady running, {} is usual (DIN 22101:1982, general knowledge)",
        (safety, "safety"),
        (needed, "number"),
    )
    yield check_against_limit("belt_safety", subject, safety, "at least", needed, "safety", asked=asked, why=why)


def belt_rating(result: CalculatedConveyor) -> Iterator[Check]:
    """Tension per width is within the rated one when steady, somewhat above it otherwise; if a rating is given."""
    duty = result.belt_duty
    steady, unsteady = (
        message("belt tension per width, steady"),
        message("belt tension per width, all states"),
    )
    if duty.rating is None:
        return
    over_rated = f"{RATED_START:g} times the rated tension, general knowledge"
    for subject, calculated, most, source in (
        (steady, duty.per_width_steady, duty.rating, "rated tension"),
        (unsteady, duty.per_width, RATED_START * duty.rating, over_rated),
    ):
        why = message(
            "the belt is rated for {}, it bears {}", (duty.rating, "belt rating"), (calculated, "belt rating")
        )
        yield check_against_limit(
            "belt_rating", subject, calculated, "at most", most, "belt rating", source=source, why=why
        )


def belt_breakage(result: CalculatedConveyor) -> Iterator[Check]:
    """The largest tension of all states is below the belt's strength; reported only on failure."""
    safety = result.belt_duty.safety
    if safety is not None and safety < 1.0:
        largest = (result.belt_duty.largest, "force")
        why = message("the belt's strength is exceeded: safety {} at {}", (safety, "safety"), largest)
        yield check_against_limit(
            "belt_breakage", "belt safety factor, all states", safety, "at least", 1.0, "safety", why=why
        )


def splice_strength(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt is strong enough for its splice: by mean tension, by the most stretched strips, by starts."""
    duty, strength = result.belt_duty, result.line.belt.strength
    if strength is None:
        return
    for what, needed in duty.strength_needed.items():
        name = "belt strength for the splice" + ("" if what == "steady" else f", {what}")
        yield check_against_limit(
            "splice_strength", name, strength, "at least", needed, "belt strength", source="DIN 22101:2002",
            why=f"the splice requires a belt of {{required}} ({what}; DIN 22101:2002, factors general knowledge), "
            "given: {calculated}",
        )  # fmt: skip


def cover_thickness(result: CalculatedConveyor) -> Iterator[Check]:
    """The covers protect the carcass and withstand wear; if the spec gives the wear."""
    for cover in result.line.belt.covers:
        least = cover.least + cover.wear
        why = message(
            f"the {cover.cover} cover is {{}}, {{}} over the carcass and {{}} for wear are needed (DIN 22101 "
            "by points, general knowledge)",
            *((value, "thickness") for value in (cover.thickness, cover.least, cover.wear)),
        )
        yield check_against_limit(
            "cover_thickness", f"thickness of the {cover.cover} cover", cover.thickness, "at least", least, "thickness",
            source="DIN 22101", why=why,
        )  # fmt: skip


def belt_temperature(result: CalculatedConveyor) -> Iterator[Check]:
    """The covers stay within the belt's temperature limits; if given."""
    relations: tuple[Relation, Relation] = ("at least", "at most")
    for limit, relation in zip(result.line.belt.bears, relations, strict=True):
        if limit is None:
            continue
        end = "lowest" if relation == "at least" else "highest"
        yield check_against_limit(
            "belt_temperature", f"{end} temperature of the covers", result.temperature, relation, limit, "temperature",
            why="the covers are at {calculated}, the belt bears {required} " + relation,
        )  # fmt: skip


def pulley_diameter(result: CalculatedConveyor) -> Iterator[Check]:
    """Every pulley has at least the diameter that the carcass requires."""
    for pulley in result.belt_duty.pulleys:
        size, figures = "", [(pulley.diameter, "thickness"), (pulley.least, "thickness")]
        if pulley.next_size is not None:
            size = ", standard size {}"
            figures.append((pulley.next_size, "thickness"))
        name, group = escape_braces(pulley.name), f"DIN 22101, group {pulley.group}"
        if pulley.utilisation is not None:
            group += f" at {percent(pulley.utilisation)} of the allowed tension"
        words = f'pulley "{name}" is {{}} in diameter, the carcass requires {{}}{size} ({group})'
        yield check_against_limit(
            "pulley_diameter", f"diameter, {name} pulley", pulley.diameter, "at least", pulley.least, "thickness",
            source=group, why=Message(words, tuple(figures)),
        )  # fmt: skip


def curve_radius(result: CalculatedConveyor) -> Iterator[Check]:
    """On every vertical curve the belt stays down, its strips neither overstressed nor slack."""
    for curve in result.belt_duty.curves:
        for least, fine, bad in (
            (curve.lift_off, "empty belt stays down", "the empty belt lifts off"),
            (curve.overstress, "no strip overstressed", "a strip of the belt is overstressed"),
            (curve.buckling, "no strip slack", "a strip of the belt goes slack"),
        ):
            if least is not None:
                yield _curve_radius_check(curve, least, fine, bad)


def _curve_radius_check(curve: CurveCheck | HorizontalCurveCheck, least: float, fine: str, bad: str) -> Check:
    section = escape_braces(curve.section)
    words = f'section "{section}", {curve.strand}: {bad} on the {curve.kind} curve of {{}}; '
    helps = math.isfinite(least)
    why = message(words + "at least {} are needed", (curve.radius, "length"), (least, "length"))
    made = check_against_limit(
        "curve_radius", f"{curve.kind} curve, {section}, {curve.strand}: {fine}", curve.radius, "at least",
        least if helps else None, "length", missing="no radius helps",
        why=why if helps else message(words + "no radius helps", (curve.radius, "length")),
    )  # fmt: skip
    return (
        made
        if helps
        else replace(made, verdict="FAIL", why=message(words + "no radius helps", (curve.radius, "length")))
    )


def wind_lift(result: CalculatedConveyor) -> Iterator[Check]:
    """The wind given does not lift a strand without bulk."""
    line = result.line
    if line.wind_speed is None:
        return
    for strand in STRANDS:
        bare = [one for one in line.stretches if one.strand == strand and one.bulk_mass == 0.0]
        if not bare:
            continue
        steepest = max(bare, key=lambda one: abs(one.inclination))
        least = lifting_speed(
            steepest.belt_mass,
            width=line.belt.width,
            lift=WIND_LIFT.value,
            inclination=steepest.inclination,
            gravity=line.gravity,
            air_density=AIR_DENSITY,
        )
        yield check_against_limit(
            "wind_lift", f"empty belt stays down in the wind, {strand}", line.wind_speed, "at most", least, "wind",
            source=f"lift coefficient {WIND_LIFT.value:g}, general knowledge",
            why=f"{strand}: a gust of {{calculated}} lifts the empty belt, {{required}} does not (lift coefficient "
            f"{WIND_LIFT.value:g}, general knowledge): hoods, hold-down rolls or a heavier belt",
        )  # fmt: skip


def horizontal_edges(result: CalculatedConveyor) -> Iterator[Check]:
    """In every horizontal curve the outer edge of the belt is not overstressed, the inner one not slack."""
    for bend in result.horizontal:
        for least, fine, bad in (
            (bend.overstress, "outer edge not overstressed", "the outer edge of the belt is overstressed"),
            (bend.buckling, "inner edge not slack", "the inner edge of the belt goes slack"),
        ):
            if least is not None:
                yield _curve_radius_check(bend, least, fine, bad)


def belt_drift(result: CalculatedConveyor) -> Iterator[Check]:
    """In every horizontal curve and state of motion the belt's edges stay on their rolls, with the wind given."""
    for bend in result.horizontal:
        inside, outside = bend.farthest_in, bend.farthest_out
        cure = message("at least a radius of {} is needed, or more banking", (inside.least, "length"))
        if math.isinf(inside.least):
            cure = message("no radius helps: more banking, a deeper trough or a hood")
        yield _drift_check(bend, inside, "inside", inside.inside, cure)
        less = "a deeper trough, a hood, less banking or skew" if bend.turn.wind else "less banking or skew"
        cure = message(less)
        if 0.0 < outside.most < math.inf:
            cure = message(less + ", or a radius of at most {}", (outside.most, "length"))
        yield _drift_check(bend, outside, "outside", -outside.outside, cure)


def _drift_check(bend: HorizontalCurveCheck, state: DriftState, way: str, drift: float, cure: Message) -> Check:
    room, section = bend.turn.room, escape_braces(bend.section)
    off = math.isinf(drift)
    how = message("runs off its rolls" if off else "drifts by {}", *(() if off else ((drift, "thickness"),)))
    why = Message(
        f'section "{section}", {bend.strand}: the belt {how.words} to the {way} of the horizontal curve in the state '
        f'"{escape_braces(state.state)}", {{}} are left on its rolls; {cure.words}',
        (*how.figures, (room, "thickness"), *cure.figures),
    )
    made = check_against_limit(
        "belt_drift", f"drift to the {way}, {section}, {bend.strand}", drift, "at most", room, "thickness",
        source="end of the roll", wording=how if off else None, why=why, where=state.state,
    )  # fmt: skip
    return replace(made, calculated=None) if off else made


def belt_transitions(result: CalculatedConveyor) -> Iterator[Check]:
    """In every transition given no strip of the belt is overstressed or slack."""
    for zone in result.belt_duty.transitions:
        for least, fine, bad in (
            (zone.stretched, "no strip overstressed", "a strip of the belt is overstressed"),
            (zone.slackened, "no strip slack", "a strip of the belt goes slack"),
        ):
            yield _transition_check(zone, least, fine, bad)


def _transition_check(of: TransitionCheck, least: float | None, fine: str, bad: str) -> Check:
    key, subject = "transition_length", message(f"{of.zone.end} transition: {fine}")
    length, missing = of.zone.length, of.missing or "least lengths in its table"
    if length is None or least is None:
        words = message("length not given") if length is None else message("{}", (length, "length"))
        return Check(key, subject, length, None, "length", words, message(missing), "not checked")
    if math.isinf(least):
        why = message(
            f"{of.zone.end} transition: {bad} whatever its length, at a belt tension of {{}} to {{}} per width",
            (of.lowest, "belt rating"),
            (of.highest, "belt rating"),
        )
        asked = message("no length helps")
        return Check(key, subject, length, None, "length", message("{}", (length, "length")), asked, "FAIL", why)
    why = message(
        f"{of.zone.end} transition: {bad} over {{}}; at least {{}} are needed (ISO 5293 taken on to every strip)"
        + ("; or raise the pulley towards half trough" if of.zone.pulley_height < _HALF_TROUGH else ""),
        (length, "length"),
        (least, "length"),
    )
    return check_against_limit(key, subject, length, "at least", least, "length", why=why)


def impact_load(result: CalculatedConveyor) -> Iterator[Check]:
    """Impact sets bear resting weight and impact; for loading points with a drop height."""
    for landing in result.loading_point_duty:
        point, load = landing.point, landing.load
        if load is None:
            continue
        missing = "load that a set there bears (idler_rating) not given"
        if point.lump_mass is not None and landing.lump is None:
            missing = "spring rate for the lump (idler_stiffness) not given"
        rating = None if point.lump_mass is not None and landing.lump is None else point.idler_rating
        yield check_against_limit(
            "impact_load", f"load of an impact set{escape_braces(point.name)}", load, "at most", rating, "force",
            source="its maker", missing=missing,
            why=f"the bulk lands on sets{escape_braces(point.name)} with {{calculated}}, they bear {{required}}: "
                f"less drop, "
            "sets closer together (stream) or softer (lumps), a heavier series",
        )  # fmt: skip


def skirtboards(result: CalculatedConveyor) -> Iterator[Check]:
    """Skirtboards are at least as long as the zone of acceleration; where their length is given."""
    for landing in result.loading_point_duty:
        point = landing.point
        if point.skirtboards is not None:
            yield check_against_limit(
                "skirtboards", f"length of the skirtboards{escape_braces(point.name)}", point.skirtboards, "at least",
                landing.acceleration, "length", source="zone of acceleration, ISO 5048",
                why=f"the skirtboards{escape_braces(point.name)} end {{calculated}} behind the place of loading, "
                    f"the bulk has "
                "the belt's speed after {required}: longer ones, or bulk that lands faster",
            )  # fmt: skip


def belt_cleaning(result: CalculatedConveyor) -> Iterator[Check]:
    """Carryback behind the cleaners is within the limit; if the spec gives the carryback."""
    on_belt, allowed = result.line.carryback
    if on_belt is not None:
        left = result.cleaner_duty[-1].left if result.cleaner_duty else None
        left = on_belt if left is None else left
        yield check_against_limit(
            "belt_cleaning", "bulk left on the belt behind its cleaners", left, "at most", allowed, "area mass",
            missing="carryback_allowed not given",
            why="the cleaners leave {calculated} on the belt, {required} is allowed: one more, or better ones",
        )  # fmt: skip


def pulley_shaft(result: CalculatedConveyor) -> Iterator[Check]:
    """Pulley shafts withstand bending and torsion with little slope at the hubs; where their distances are given."""
    for duty in result.pulley_duty:
        if duty.slope is None:
            continue
        name, where = escape_braces(duty.pulley.name), duty.largest.state
        needed = () if duty.least_shaft is None else ((duty.least_shaft, "thickness"),)
        cure = "; {} in the hubs (hub_shaft_diameter) are needed" if needed else ""
        why = message(f'the shaft of pulley "{name}" bends too much at its hubs{cure}', *needed)
        yield check_against_limit(
            "pulley_shaft_slope", f"slope at the hubs, {name} pulley", duty.slope, "at most", HUB_SLOPE, "number",
            source="CEMA B105.1", wording=message(f"{duty.slope:.4f}"), why=why, where=where,
        )  # fmt: skip
        subject = message(f"safety of the shaft, {name} pulley")
        asked = message("at least {} (CEMA B105.1)", (SHAFT_SAFETY, "number"))
        if duty.safety is None:
            yield Check(
                "pulley_shaft_safety", subject, None, SHAFT_SAFETY, "safety", message("not known"),
                message("steel of the shaft not given"), "not checked",
            )  # fmt: skip
            continue
        safety, where = duty.safety
        why = message(f'the shaft of pulley "{name}" is too thin for bending and torsion{cure}', *needed)
        yield check_against_limit("pulley_shaft_safety", subject, safety, "at least", SHAFT_SAFETY, "safety",
        asked=asked,
                       why=why, where=where)  # fmt: skip


def pulley_bearings(result: CalculatedConveyor) -> Iterator[Check]:
    """Pulley bearings reach the required life in steady running; where their rating is given."""
    for duty in result.pulley_duty:
        seconds, name = duty.bearing_seconds, escape_braces(duty.pulley.name)
        if seconds is None:
            continue
        yield check_against_limit(
            "pulley_bearings", f"L10 life of a bearing, {name} pulley", seconds, "at least", duty.pulley.bearing_life,
            "duration", missing="life asked of it (bearing_life) not given",
            why=f'the bearings of pulley "{name}" reach an L10 of {{calculated}}, {{required}} are required',
        )  # fmt: skip


def lagging_pressure(result: CalculatedConveyor) -> Iterator[Check]:
    """Pressure on the lagging is within its limit; where given."""
    for duty in result.pulley_duty:
        allowed, name = duty.pulley.allowed_pressure, escape_braces(duty.pulley.name)
        if allowed is not None:
            yield check_against_limit(
                "lagging_pressure", f"pressure on the lagging, {name} pulley", duty.pressure, "at most", allowed,
                "pressure", why=f'the belt presses with {{calculated}} on the lagging of pulley "{name}", it bears '
                "{required}; a larger diameter",
            )  # fmt: skip


def starting_force(result: CalculatedConveyor) -> Iterator[Check]:
    """Motor force suffices for a controlled start or the whole run-up, and for breaking away after standstill."""
    start = result.motions.start
    if start.force <= 0.0:
        return
    if start.available is not None and start.least is not None:
        if start.asked is not None:
            why = (
                "the motors give {required} at the start (drive.torque_factor, torque_curve), {calculated} are "
                f"required (drive.start_factor, rotating masses): it is limited to {start.factor:.3g} times the steady "
                "force; more power, torque or a softer start"
            )
            given, limit, relation = start.asked, start.least, _AT_MOST
        else:
            why = (
                "the motors give at least {calculated} during run-up (drive.torque_factor, torque_curve), the belt "
                "requires {required}: more power or torque"
            )
            given, limit, relation = start.least, result.balance.settled.force, _AT_LEAST
        yield check_against_limit("starting_force", "starting force, motors", given, relation, limit, "force", why=why)
    given = start.standstill if result.start_of_motors is None else result.start_of_motors
    yield check_against_limit(
        "breakaway", "starting force after standstill", given, "at least", start.breakaway, "force",
        why="the starting force of {calculated} does not overcome the resistance after standstill, up to {required}: "
        "raise drive.start_factor or the motors' torque",
    )  # fmt: skip


def comes_to_rest(result: CalculatedConveyor) -> Iterator[Check]:
    """The conveyor stops without power, by friction alone or by its brakes; both are reported."""
    moving, brakes = result.motions, math.fsum(result.line.brakes)
    alone, stopped = moving.coasting_least, moving.braked
    why = message("the conveyor does not stop by itself and has no brake: give drive.brake_force")
    if moving.runaway is not None:
        why = message(
            "the conveyor does not stop by itself and has no brake, it runs away at {}: give drive.brake_force",
            (moving.runaway, "acceleration"),
        )
    words = _rest_text(alone, moving.runaway)
    safe = alone is not None or stopped is not None
    asked = message("a stop at minimum friction" if brakes == 0.0 else "a stop at minimum friction, or brakes")
    yield Check(
        "comes_to_rest", message("coast-down stop"), None if alone is None else alone.time, None,
        "duration", words, asked, pass_or_fail(holds=safe), why, _AT_MOST,
    )  # fmt: skip
    if brakes > 0.0:
        why = message("brakes of {} do not stop the conveyor", (brakes, "force"))
        yield Check(
            "comes_to_rest", message("coast-down stop, brakes on"), None if stopped is None else stopped.time,
            None, "duration", _rest_text(stopped, None), message("a stop at minimum friction"),
            pass_or_fail(holds=stopped is not None), why, _AT_MOST,
        )  # fmt: skip


def _rest_text(stopping: Stop | None, runaway: float | None) -> Message:
    """Stop or runaway in words."""
    if stopping is not None:
        return message(f"in {stopping.time:,.1f} s, {{}}", (stopping.distance, "length"))
    return message("does not") if runaway is None else message("runs away at {}", (runaway, "acceleration"))


def holding_brake(result: CalculatedConveyor) -> Iterator[Check]:
    """A brake or backstop holds the loaded belt, and brakes give the required deceleration."""
    moving, line = result.motions, result.line
    given = any(drive.brake is not None for drive in line.drives)
    brakes = math.fsum(line.brakes)
    if moving.brake_to_hold > 0.0:
        what = "backstop" if moving.rolls_back else "brake"
        bear = _backstop_forces(line) if moving.rolls_back else ()
        known = given or bool(bear)
        none = "no brake given, nor what a backstop bears" if moving.rolls_back else "no brake given"
        made = check_against_limit(
            "holding_brake", f"holding {what}, loaded belt", math.fsum((brakes, *bear)), "at least",
            moving.brake_to_hold, "force", wording=None if known else message(none),
            why=f"the loaded belt needs a {what} of {{required}} at the belt to stay at rest",
        )  # fmt: skip
        yield made if known else replace(made, verdict="not checked")
    if moving.brake_to_stop is not None:
        yield check_against_limit(
            "stopping_brake", "brakes for the specified deceleration", brakes, "at least", moving.brake_to_stop,
            "force", wording=None if given else message("no brake given"),
            why="drive.stop_deceleration requires brakes of {required} at the belt, given: {calculated}",
        )  # fmt: skip


def _backstop_forces(line: Line) -> tuple[float, ...]:
    """Forces at the belt of the backstops of given torque [N]."""
    parts = ((drive.parts, drive.radius) for drive in line.drives)
    return tuple(
        part.backstop / radius
        for part, radius in parts
        if part is not None and part.backstop is not None and radius is not None
    )


def drive_parts(result: CalculatedConveyor) -> Iterator[Check]:
    """Backstops, brakes, starts an hour and uncontrolled load sharing are within their limits; where given."""
    motor = result.balance.frame.motor
    for duty in result.drive_duty:
        name, parts, installed = escape_braces(duty.drive.name), duty.parts, duty.drive.power
        if parts.backstop is not None and duty.backstop is not None:
            yield check_against_limit(
                "backstop_torque", f"torque of the backstop, {name}", duty.backstop, "at most", parts.backstop,
                "torque", where="holding" if duty.backstop == duty.holding else "motors stalled",
                why=f'the backstop of "{name}" bears {{required}}, {{calculated}} are asked of it',
            )  # fmt: skip
        if parts.heat is not None and duty.heat is not None:
            yield check_against_limit(
                "brake_heat", f"heat of a stop in the brake, {name}", duty.heat, "at most", parts.heat, "heat",
                why=f'a stop leaves {{calculated}} in the brake of "{name}", it bears {{required}}',
            )  # fmt: skip
        if parts.starts is not None and duty.allowed_starts is not None:
            yield _motor_starts_check(name, parts.starts, duty.allowed_starts)
        if duty.shared is not None and installed is not None:
            yield check_against_limit(
                "load_sharing", f"motor power by uncontrolled sharing, {name}", abs(motor(duty.shared)), "at most",
                installed, "power",
                why=f'"{name}" takes {{calculated}} where nothing but the belt couples the drives, installed: '
                "{required}; control the sharing, or choose motors of more slip and pulleys alike",
            )  # fmt: skip


def _motor_starts_check(name: str, asked: float, allowed: float | str) -> Check:
    subject = message(f"starts an hour, {name}")
    if isinstance(allowed, str):
        wanted = message("{}", (asked, "number"))
        return Check("motor_starts", subject, asked, None, "number", wanted, message(allowed), "not checked")
    return check_against_limit(
        "motor_starts", subject, asked, "at most", allowed, "number",
        asked=message(f"at most {allowed:.2f} (NEMA MG 10)"),
        why=f'the motors of "{name}" bear {allowed:.2g} starts an hour of this load (NEMA MG 10), {asked:g} are asked '
        "for: a coupling or an inverter",
    )  # fmt: skip


def coasting_time(result: CalculatedConveyor) -> Iterator[Check]:
    """Coasting without power and brakes lasts the required time; on failure the flywheel needed is named."""
    wanted, stopped = result.line.coast_time, result.motions.coasting
    if wanted is None or stopped is None:
        return
    inertia = coasting_flywheel(result.line, result.motions)
    figures = () if inertia is None else ((inertia, "inertia"),)
    cure = ": a flywheel of {} at the motors' shafts" if figures else ""
    why = message(f"the conveyor coasts for {stopped.time:,.1f} s, {wanted:,.1f} s are wanted{cure}", *figures)
    yield check_against_limit(
        "coasting_time", "coasting without power", stopped.time, "at least", wanted, "time", why=why,
        wording=message(f"{stopped.time:,.1f} s"), asked=message(f"at least {wanted:,.1f} s"),
    )  # fmt: skip


def bulk_slip(result: CalculatedConveyor) -> Iterator[Check]:
    """The bulk stays on the belt in running, stopping and starting."""
    slip = result.motions.slip
    if slip is None:
        return
    if slip.sliding:
        where = escape_braces(", ".join(slip.sliding))
        yield Check(
            "bulk_slip", message("no material slip in running"), None, None, "acceleration",
            message(f"slips in {where}"),
            message("no slip"), "FAIL",
            message(f'the material slips on the belt in section "{where}" at any speed: too steep for its friction'),
        )  # fmt: skip
        return
    hardest, fastest = result.motions.hardest
    for key, when, occurs, allowed, where in (
        ("bulk_slip_stopping", "on stopping", -hardest, -slip.braking, slip.braking_at),
        ("bulk_slip_start", "on starting", fastest, slip.starting, slip.starting_at),
    ):
        why = f'the material slips {when}: {{calculated}}, section "{escape_braces(where)}" allows {{required}}'
        yield check_against_limit(
            key, f"no material slip {when}", occurs, "at most", allowed, "acceleration", why=why, where=where
        )


def cover_penetration(result: CalculatedConveyor) -> Iterator[Check]:
    """Penetration of the rolls is within the range of small-strain theory."""
    for strand in STRANDS:
        deepest, thickness = result.contacts.deepest(strand), result.contacts.covers[strand].thickness
        why = message(
            f"{strand} rolls indent the cover by {percent(deepest)} of its thickness ({{}}): beyond small strain, "
            "the linear law is not proven",
            (thickness, "thickness"),
        )
        yield Check(
            "penetration", message(f"penetration of the cover, {strand} rolls"), deepest, MAX_PENETRATION, "fraction",
            message(f"{percent(deepest, 1)} of its thickness"),
            message(f"at most {percent(MAX_PENETRATION)} (small strain)"),
            pass_or_fail(holds=deepest <= MAX_PENETRATION), why, "at most",
        )  # fmt: skip


def roll_life(result: CalculatedConveyor) -> Iterator[Check]:
    """Idler sets reach the rated life of light series; where their bearings are given."""
    for strand in STRANDS:
        life = shortest_set_life(result.line.stretches, strand, result.line.speed)
        if life is None:
            continue
        why = message(
            f"{strand} rolls: L10 of all bearings of a set in {escape_braces(life.section)} is {{}} (of the "
            f"{life.weakest} "
            f"alone {{}}), less than the {SERIES_RATED_LIFE:,.0f} h that light series are rated for (CEMA, as commonly "
            "reproduced); seals and dirt may end it sooner",
            *((3600.0 * hours, "duration") for hours in (life.hours, life.weakest_hours)),
        )
        asked, judged = (
            message(f"at least {SERIES_RATED_LIFE:,.0f} h"),
            pass_or_fail(holds=not life.too_short),
        )
        if not life.whole and not life.too_short:
            asked, judged = message("bearings of some rolls not given"), "not checked"
        yield Check(
            "roll_life", message(f"L10 life, {strand} idler sets"), 3600.0 * life.hours, 3600.0 * SERIES_RATED_LIFE,
            "duration", message("{}", (3600.0 * life.hours, "duration")), asked, judged, why,
        )  # fmt: skip


def set_rating(result: CalculatedConveyor) -> Iterator[Check]:
    """No set is loaded above its rating; where a class or rating is given."""
    for strand, duties in _set_duties_by_strand(result):
        rated = [(duty, duty.limits.rating) for duty in duties if duty.limits.rating is not None]
        if not rated:
            continue
        worst, rating = max(rated, key=lambda pair: pair[0].limits.load / pair[1])
        limits = worst.limits
        of_class = "" if limits.cema_class is None else f"CEMA class {limits.cema_class}"
        of_class += ", general knowledge" if limits.cema_class == "E" else ""
        cure = "" if limits.least_class is None else f"; class {limits.least_class} bears it"
        section = worst.stretch.section
        yield check_against_limit(
            "set_rating", f"load of a set, {strand} idlers", limits.load, "at most",
            None if limits.lump_factor is None else rating, "force", source=of_class, where=section,
            missing="lump_factor not given: none is printed for such lumps",
            why=f"{strand} sets in {escape_braces(section)} bear {{calculated}}, they are rated for {{required}}{cure}",
        )  # fmt: skip


def roll_axle(result: CalculatedConveyor) -> Iterator[Check]:
    """Slope of the rolls' axles at their bearings is within its limit; where given."""
    for strand, duties in _set_duties_by_strand(result):
        axles = [(duty.limits.axle, duty.stretch.section) for duty in duties if duty.limits.axle is not None]
        if not axles:
            continue
        axle, section = max(axles, key=lambda of: of[0].slope / of[0].allowed)
        yield check_against_limit(
            "roll_axle", f"slope of the axle at its bearings, {strand} rolls", axle.slope, "at most", axle.allowed,
            "angle", where=f"{axle.roll}, {section}",
            why=f"the axle of the {axle.roll} roll, {strand}, {escape_braces(section)}, slopes by {{calculated}} at "
                f"its "
            "bearings, they bear {required}: a thicker axle, a closer spacing",
        )  # fmt: skip


def belt_flap(result: CalculatedConveyor) -> Iterator[Check]:
    """The rolls' rotation is off the belt's natural frequencies between sets; where a distance is required."""
    for strand, duties in _set_duties_by_strand(result):
        asked = [duty for duty in duties if duty.limits.flap_margin is not None]
        if not asked:
            continue
        worst = min(asked, key=lambda duty: duty.distance)
        cure, figures = "; a higher tension", list[tuple[float, str]]()
        if worst.still_spacing is not None and worst.still_diameter is not None:
            cure = "; sets at most {} apart, or rolls of at least {}, keep it still"
            figures = [(worst.still_spacing, "length"), (worst.still_diameter, "thickness")]
        why = message(
            f"the belt may flap on its {strand} sets in {escape_braces(worst.stretch.section)}: rolls turn at "
            f"{_band_text(worst.rotations)} Hz, the belt swings at {_band_text(worst.frequencies)} Hz and twice "
            f"that{cure}",
            *figures,
        )
        yield check_against_limit(
            "belt_flap", f"distance from resonance of belt and rolls, {strand}", worst.distance, "at least",
            worst.limits.flap_margin, "fraction", wording=message(percent(worst.distance)), why=why,
            asked=message(f"at least {percent(worst.limits.flap_margin or 0.0)}"), where=worst.stretch.section,
        )  # fmt: skip


def _band_text(ends: tuple[float, float]) -> str:
    """Both ends of a band in words, equal ones once."""
    return " to ".join(dict.fromkeys(f"{end:.3g}" for end in ends))


def _set_duties_by_strand(result: CalculatedConveyor) -> Iterator[tuple[Strand, list[SetDuty]]]:
    for strand in STRANDS:
        yield strand, [duty for duty in result.set_duty if duty.stretch.strand == strand]


def rubber_coverage(result: CalculatedConveyor) -> Iterator[Check]:
    """The data of each rubber cover the band of nine tenths of its rolls' energy loss."""
    for strand, compound in compounds_by_strand(result.conveyor).items():
        if compound.kind == "illustrative":
            if result.contacts.lossy(strand):
                yield Check(
                    "rubber_coverage", message(f"rubber, {strand}"), None, None, "frequency",
                    message("constructed spectrum"), message("a measured compound required"), "not checked",
                )  # fmt: skip
            continue
        band = result.contacts.excited_band(strand)
        if band is None:
            continue
        yield _coverage_check(
            strand,
            escape_braces(compound.name),
            band,
            compound.frequencies(result.temperature),
            result.temperature,
        )


def _coverage_check(
    strand: Strand, name: str, band: tuple[float, float], data: tuple[float, float] | None, at: float
) -> Check:
    """Check a band against that of the data [Hz]; the end of less margin decides."""
    subject = f"rubber data over the excitation band, {strand}"
    shown = message(f"{format_band(band)} at {{}}", (at, "temperature"))
    if data is None:
        missing = "range of the data not stated"
        return check_against_limit(
            "rubber_coverage", subject, band[1], "at most", None, "frequency", wording=shown, missing=missing
        )
    why = message(
        f'compound "{name}": 90 % of the loss of the {strand} rolls lies between '
        f"{band[0]:.3g} and {band[1]:.3g} Hz, its data cover {data[0]:.3g} to {data[1]:.3g} Hz "
        "at {}: the series is extrapolated: not for design",
        (at, "temperature"),
    )
    ends = (
        check_against_limit(
            "rubber_coverage", subject, band[0], "at least", data[0], "frequency", wording=shown, why=why
        ),
        check_against_limit(
            "rubber_coverage", subject, band[1], "at most", data[1], "frequency", wording=shown, why=why
        ),
    )
    return replace(min(ends, key=severity_rank), asked=message(f"within {format_band(data)}"))


def unsearched_criteria(line: Line) -> frozenset[str]:
    """Keys of criteria that are checked under the calculated loads only, not under the worst loading."""
    return _CALCULATED_LOADS_ONLY | (_SECTION_CRITERIA if line.count > SINGLE_CHANGE_SECTIONS else frozenset())


def rubber_data_suffice(result: CalculatedConveyor) -> bool:
    """True if the rubber's data cover the excited band; otherwise results are not for design."""
    return not any(check.failed for check in rubber_coverage(result))


CONTACT_CRITERIA: Final = (cover_penetration, rubber_coverage)
"""Criteria that need the contacts of all rolls; the others need forces and tensions only."""
_CALCULATED_LOADS_ONLY: Final = frozenset({"belt_flap", "load_sharing", "penetration", "rubber_coverage"})
"""Keys of criteria checked under the calculated loads only."""
_SECTION_CRITERIA: Final = frozenset({"curve_radius", "belt_drift", "set_rating"})
"""Keys of criteria of single sections, on long routes checked under the calculated loads only."""
CRITERIA: Final[tuple[Callable[[CalculatedConveyor], Iterable[Check]], ...]] = (
    belt_filling, motor_power, take_up_tension, take_up_travel, drive_grip, belt_sag, slack_belt, belt_safety,
    belt_rating,
    belt_breakage, splice_strength, cover_thickness, belt_temperature, pulley_diameter, curve_radius,
    wind_lift, horizontal_edges, belt_drift, belt_transitions, impact_load, skirtboards, belt_cleaning, pulley_shaft,
    pulley_bearings, lagging_pressure, starting_force, comes_to_rest, holding_brake, drive_parts, coasting_time,
    bulk_slip,
    cover_penetration, roll_life, set_rating, roll_axle, belt_flap, rubber_coverage,
)  # fmt: skip
