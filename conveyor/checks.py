"""What a conveyor is checked for: one function a criterion.

A run and each of its load cases are checked by the very same functions; the warnings and every output use what they
say, nothing else says what passes. Of all cases the one with the least margin governs a criterion.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from conveyor.laws.belt import RATED_START
from conveyor.laws.motion import Stop
from conveyor.laws.pulley import HUB_SLOPE, SHAFT_SAFETY
from conveyor.laws.take_up import SCREW_LENGTH
from conveyor.laws.tension import grip_tension
from conveyor.laws.wind import AIR_DENSITY, WIND_LIFT, lifting_speed
from conveyor.line.covers import compounds_by_strand
from conveyor.line.line import Line
from conveyor.line.roll_lives import ASKED_LIFE, shortest_life
from conveyor.line.stretches import STRANDS, Strand
from conveyor.loop.belt_duty import CurveCheck, TransitionCheck
from conveyor.loop.drive_duty import coasting_flywheel
from conveyor.loop.equilibrium import holds
from conveyor.loop.horizontal import DriftState, HorizontalCheck
from conveyor.loop.set_duty import SetDuty
from conveyor.loop.starting import every_state
from conveyor.loop.take_up import TakeUpDuty, weight_mass
from conveyor.loop.worst_loadings import ONE_BY_ONE
from conveyor.pipeline import CalculatedConveyor
from conveyor.ties import largest
from conveyor.units.sentences import Said, band_words, percent, quoted, said

Verdict = Literal["pass", "FAIL", "not checked"]
Relation = Literal["at least", "at most"]

_AT_MOST: Final[Relation] = "at most"
_AT_LEAST: Final[Relation] = "at least"
_HALF_TROUGH: Final = 0.5
_FIGURE: Final = re.compile(r"(?<!{){(?:calculated|required)}(?!})")
_DIGITS: Final = 9
"""Of margins: what rounding parts is equal, see `conveyor.ties`."""
DEEP: Final = 0.2
"""Δ/h beyond which a linear small-strain cover is a stretch of the law; strain is about Δ/h [-]."""


@dataclass(frozen=True)
class Check:
    """One criterion and how it stands.

    Attributes
    ----------
    key : str
        Of the criterion, for programs.
    subject : Said
        What is checked.
    calculated, required : float or None
        SI; None where no figure says it.
    kind : str
        Kind of both.
    found, asked : Said
        Both in words, with their units.
    verdict : {"pass", "FAIL", "not checked"}
        "not checked" where the spec does not say what is needed for it.
    why : Said or None
        What to say of it where it fails.
    relation : {"at least", "at most"}
        How the calculated figure must stand to the required one.
    where : str
        What decides in it: a state of motion, a section.
    case : Said or None
        The load case; None for the conveyor as its spec gives it.

    Examples
    --------
    >>> required = said("at most {}", (1.6e6, "power"))
    >>> Check(
    ...     "motor_power",
    ...     said("motor power"),
    ...     1.25e6,
    ...     1.6e6,
    ...     "power",
    ...     said("{}", (1.25e6, "power")),
    ...     required,
    ...     "pass",
    ... )
    Check("motor power": 1,250 kW, at most 1,600 kW: pass)
    """

    key: str
    subject: Said
    calculated: float | None
    required: float | None
    kind: str
    found: Said
    asked: Said
    verdict: Verdict
    why: Said | None = None
    relation: Relation = "at least"
    where: str = ""
    case: Said | None = None

    def __repr__(self) -> str:
        case = "" if self.case is None else f' in "{self.case}"'
        return f'Check("{self.name}"{case}: {self.found}, {self.asked}: {self.verdict})'

    @property
    def failed(self) -> bool:
        """Whether the criterion is not met."""
        return self.verdict == "FAIL"

    @property
    def name(self) -> Said:
        """What is checked, and what decides in it."""
        if not self.where:
            return self.subject
        return replace(self.subject, words=f"{self.subject.words} ({quoted(self.where)})")

    @property
    def margin(self) -> float | None:
        """How far the calculated figure is on the safe side of the required one, over that one [-].

        Calculated over required less 1 where at least that is required, 1 less calculated over required where at most;
        None where a figure is missing, the required one is 0, or both are temperatures, which have no ratio.
        """
        if self.calculated is None or not self.required or self.kind == "temperature":
            return None
        over = (self.calculated - self.required) / abs(self.required)
        return over if self.relation == "at least" else -over

    @property
    def use(self) -> float | None:
        """Of what is allowed the share that is used [-]; None where a figure is missing or 0."""
        if not self.calculated or not self.required:
            return None
        ratio = self.calculated / self.required
        return ratio if self.relation == "at most" else 1.0 / ratio


def highest_use(checks: Iterable[Check], keys: Collection[str]) -> tuple[float | None, Check | None]:
    """The highest use of criteria [-] and its check; None where no check of these keys says one."""
    used = [(one.use, one) for one in checks if one.key in keys and one.use is not None]
    return max(used, key=lambda pair: pair[0] or 0.0, default=(None, None))


BELT_USE: Final = frozenset({"belt_safety", "belt_rating"})
"""Criteria of what a belt bears, by its strength or its rating."""


def verdict(*, holds: bool) -> Verdict:
    """Return pass or FAIL."""
    return "pass" if holds else "FAIL"


def compared(  # noqa: PLR0917 reads as the sentence it checks
    key: str,
    subject: str | Said,
    calculated: float,
    relation: Relation,
    required: float | None,
    kind: str,
    *,
    source: str = "",
    wording: Said | None = None,
    asked: Said | None = None,
    holds: bool | None = None,
    missing: str = "",
    why: Said | str | None = None,
    where: str = "",
) -> Check:
    """Check a figure against its limit.

    Parameters
    ----------
    key, subject : str
        Of the criterion.
    calculated, required : float
        SI; `required` is None where it is not known.
    relation : {"at least", "at most"}
        How the calculated figure must stand to the required one.
    kind : str
        Kind of both.
    source : str
        Where the limit comes from.
    wording : Said, optional
        The calculated figure in other words.
    asked : Said, optional
        What is required in other words.
    holds : bool, optional
        Whether it is met, where the figures alone do not tell.
    missing : str
        What to say where no limit is known.
    why : Said or str, optional
        What to say where it fails; in plain words {calculated} and {required} stand for the figures.
    where : str
        What decides in it.
    """
    shown = said("{}", (calculated, kind)) if wording is None else wording
    name = said(subject) if isinstance(subject, str) else subject
    if required is None:
        shortfall = said(missing)
        return Check(
            key, name, calculated, None, kind, shown, shortfall, "not checked", None, relation, where
        )
    if holds is None:
        holds = calculated >= required if relation == "at least" else calculated <= required
    if asked is None:
        asked = said(f"{relation} {{}}{f' ({source})' if source else ''}", (required, kind))
    if isinstance(why, str):
        figures = {"{calculated}": (calculated, kind), "{required}": (required, kind)}
        why = Said(_FIGURE.sub("{}", why), tuple(figures[word] for word in _FIGURE.findall(why)))
    judged = verdict(holds=holds)
    return Check(key, name, calculated, required, kind, shown, asked, judged, why, relation, where)


def checks(result: CalculatedConveyor, *, contacts: bool = True) -> tuple[Check, ...]:
    """Check one calculation for every criterion, in the order of `CRITERIA`; without contacts not `OF_CONTACTS`."""
    chosen = [criterion for criterion in CRITERIA if contacts or criterion not in OF_CONTACTS]
    return tuple(check for criterion in chosen for check in criterion(result))


def deciding(every: Iterable[Check]) -> tuple[Check, ...]:
    """Of each criterion and subject the check that governs, those of one criterion together.

    One that fails goes before one that passes, that before one that is not checked; then the least margin decides, and
    among equals the first.
    """
    groups: dict[str, dict[Said, list[Check]]] = {}
    for check in every:
        groups.setdefault(check.key, {}).setdefault(check.subject, []).append(check)
    return tuple(min(group, key=severity) for of in groups.values() for group in of.values())


def leading(checks: Iterable[Check]) -> tuple[Check, ...]:
    """Of each criterion the check that governs, whatever its subject."""
    groups: dict[str, list[Check]] = {}
    for check in checks:
        groups.setdefault(check.key, []).append(check)
    return tuple(min(group, key=severity) for group in groups.values())


def severity(check: Check) -> tuple[int, float, float]:
    """How a check ranks among others: the least governs. A failure without a margin is beyond any.

    Where nothing is there at all, which is the same margin whatever is needed, the one that needs more governs; where
    no limit is known, the one without a figure, else the lowest or highest.
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
    return order, round(margin, _DIGITS), float(f"{further:.{_DIGITS}g}")


def filling(result: CalculatedConveyor) -> Iterator[Check]:
    """On its slope every section holds its bulk."""
    line, holds_on = result.line, result.conveyor.section_on_slope
    loaded = [
        (stretch, stretch.bulk_mass / line.density, holds_on(stretch.inclination))
        for stretch in line.stretches[: line.count]
        if stretch.bulk_mass > 0.0
    ]
    if loaded:
        stretch, bulk, most = largest(loaded, lambda one: -one[2] / one[1])
        section = f'section "{quoted(stretch.section)}"'
        why = said(f"the bulk takes {{}}, {section} holds nothing on its slope", (bulk, "area"))
        if most > 0.0:
            flooded = (result.conveyor.flooded_section, "area")
            spills = [flooded] if bulk > flooded[0] else []
            why = said(
                f"the bulk takes {{}}, {percent(bulk / most)} of the {{}} that {section} holds on its slope"
                f"{', and spills beyond {}, heaped from edge to edge' if spills else ''}: reduce "
                "material.flow to {}, raise belt.speed to {}, or take a wider belt",
                (bulk, "area"), (most, "area"), *spills,
                (line.flow * most / bulk, "mass flow"), (line.speed * bulk / most, "speed"),
            )  # fmt: skip
        yield compared(
            "filling", "filling of the belt", bulk, "at most", most, "area", source="ISO 5048",
            wording=said(f"{{}}, {percent(bulk / holds_on(0.0))} of the level cross-section", (bulk, "area")),
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
        who = "the motor" if len(line.drives) == 1 else f'"{quoted(drive.name)}"'
        yield compared(
            "motor_power", f"motor power, {quoted(drive.name)}", abs(power), "at most", drive.power, "power",
            wording=said("{}" + (" (generating)" if power < 0.0 else ""), (abs(power), "power")),
            missing="installed power not given", where="least friction" if certain else "",
            why=f"{who} requires {{calculated}}, {{required}} are installed: install more power",
        )  # fmt: skip


def take_up_tension(result: CalculatedConveyor) -> Iterator[Check]:
    """The take-up holds what grip and sag ask for in every state; what governs is named, or all it falls short of."""
    settled = result.balance.settled
    for name, asked in (settled.short or {settled.governing: settled.needed}).items():
        words, figures = _setting(result.line, asked)
        why = said(
            f"the take-up holds {{}}, {quoted(name)} requires {words}", (settled.setting, "force"), *figures
        )
        yield compared(
            "take_up_tension", "take-up tension", settled.setting, "at least", asked, "force", holds=not settled.short,
            why=why, where=name,
        )  # fmt: skip


def _setting(line: Line, tension: float) -> tuple[str, tuple[tuple[float, str], ...]]:
    """A setting of the take-up in words, with the weight of one by gravity, and its figures."""
    if line.take_up.kind != "gravity":
        return "{}", ((tension, "force"),)
    return "{} (a weight of {})", ((tension, "force"), (weight_mass(line, tension), "mass"))


def take_up_reach(result: CalculatedConveyor) -> Iterator[Check]:
    """The take-up's carriage goes as far and as fast as this load asks for; screws keep short conveyors only."""
    unit = result.line.take_up
    if unit.travel is not None or unit.winch is not None:
        yield from reach(result.take_up)
    if unit.kind == "screw":
        yield compared(
            "screw_take_up", "length of a conveyor with a screw take-up", result.line.length, "at most", SCREW_LENGTH,
            "length", source="general knowledge", why="a screw take-up on {calculated}: give it a weight or a winch",
        )  # fmt: skip


def reach(duty: TakeUpDuty) -> Iterator[Check]:
    """Travel and speed that loads ask of the take-up, where its spec gives them."""
    unit, travel = duty.unit, duty.travel
    if unit.travel is not None and travel is not None:
        why = "the take-up has {required} of travel, {calculated} are needed"
        yield compared(
            "take_up_travel", "travel of the take-up", travel.whole, "at most", unit.travel, "length", why=why
        )
    if unit.winch is not None and duty.speed is not None:
        yield compared(
            "winch_speed", "speed of the winch through a start", duty.speed, "at most", unit.winch[0], "speed",
            why="the winch moves its carriage at {required}, a start asks for {calculated}: the belt slackens behind "
            "the drive meanwhile",
        )  # fmt: skip


def drive_grip(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt does not slip on any drive, in running, starting and stopping."""
    for state in every_state(result.balance, result.motions):
        for drive, side in zip(result.line.drives, state.drives, strict=True):
            needed = grip_tension(side.force, friction=drive.friction, wrap_angle=drive.wrap_angle)
            name = quoted(drive.name)
            yield compared(
                "drive_grip", f"grip of {name}, {state.name}", side.slack, "at least", needed, "force",
                wording=said("{} on the slack side", (side.slack, "force")), holds=holds(side.slack, needed),
                why=f'the belt slips on "{name}" in the state "{state.name}": {{calculated}} on its slack side, '
                "{required} are needed; raise the take-up's tension, the wrap or the friction (lagging)",
            )  # fmt: skip


def sag(result: CalculatedConveyor) -> Iterator[Check]:
    """Between no two idler sets the belt sags more than allowed while it runs steadily."""
    settled, shape = result.balance.settled, result.line.loop
    running = settled.running
    lowest = [np.minimum(state.starts, state.ends) for state in running]
    over = [(tension / shape.least).tolist() for tension in lowest]
    for strand in STRANDS:
        places = [
            (k, i)
            for k in range(len(running))
            for i, stretch in enumerate(shape.stretches)
            if stretch.strand == strand
        ]
        k, i = min(places, key=lambda at: over[at[0]][at[1]])
        tension, needed, section = float(lowest[k][i]), float(shape.least[i]), shape.stretches[i].section
        yield compared(
            "sag", f"minimum tension (sag), {strand}", tension, "at least", needed, "force",
            holds=holds(tension, needed), where=f"{section}, {running[k].name}",
            why=f'the belt sags more than allowed in section "{quoted(section)}", {strand}: tension {{calculated}}, '
            "{required} are needed",
        )  # fmt: skip


def slack_belt(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt is nowhere slack in any state of motion; the slackest state is named, or every one that fails."""
    states, settled = every_state(result.balance, result.motions), result.balance.settled
    slack = [state for state in states if state.slack]
    for state in slack or [min(states, key=lambda state: state.smallest)]:
        words, figures = _setting(result.line, settled.setting - state.smallest)
        slower = ", or slow the stop by a flywheel or the drives" if state.acceleration < 0.0 else ""
        why = said(
            f'the belt goes slack in the state "{state.name}": down to {{}}; raise the take-up\'s tension from {{}} to '
            f"about {words}{slower}",
            (state.smallest, "force"), (settled.setting, "force"), *figures,
        )  # fmt: skip
        yield compared(
            "slack_belt", "minimum belt tension, all states", state.smallest, "at least", 0.0, "force",
            asked=said("at least 0 (not slack)"), where=state.name, why=why,
        )  # fmt: skip


def belt_safety(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt's strength over its tension in steady running; not asked of a belt given by its rating alone."""
    duty, subject = result.belt_duty, said("belt safety factor, steady")
    if duty.safety_steady is None and duty.rating is not None:
        return
    safety, needed = duty.safety_steady, duty.safety_needed
    asked = said("at least {} (DIN 22101:1982)", (needed, "number"))
    if safety is None:
        shown = said("strength not given")
        yield Check("belt_safety", subject, None, needed, "safety", shown, asked, "not checked")
        return
    why = said(
        "safety of the belt {} in steady running, {} is usual (DIN 22101:1982, general knowledge)",
        (safety, "safety"),
        (needed, "number"),
    )
    yield compared("belt_safety", subject, safety, "at least", needed, "safety", asked=asked, why=why)


def belt_rating(result: CalculatedConveyor) -> Iterator[Check]:
    """The tension per width, steady at most the rated one and else somewhat more; said only where a rating is given."""
    duty = result.belt_duty
    steady, unsteady = said("belt tension per width, steady"), said("belt tension per width, all states")
    if duty.rating is None:
        return
    over_rated = f"{RATED_START:g} times the rated tension, general knowledge"
    for subject, calculated, most, source in (
        (steady, duty.per_width_steady, duty.rating, "rated tension"),
        (unsteady, duty.per_width, RATED_START * duty.rating, over_rated),
    ):
        why = said(
            "the belt is rated for {}, it bears {}", (duty.rating, "belt rating"), (calculated, "belt rating")
        )
        yield compared(
            "belt_rating", subject, calculated, "at most", most, "belt rating", source=source, why=why
        )


def belt_breakage(result: CalculatedConveyor) -> Iterator[Check]:
    """The largest tension of all states is below the belt's strength; said only where it is not."""
    safety = result.belt_duty.safety
    if safety is not None and safety < 1.0:
        largest = (result.belt_duty.largest, "force")
        why = said("the belt's strength is exceeded: safety {} at {}", (safety, "safety"), largest)
        yield compared(
            "belt_breakage", "belt safety factor, all states", safety, "at least", 1.0, "safety", why=why
        )


def splice_strength(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt is as strong as its splice asks for: by mean tension, by the strips that are longest, by starts."""
    duty, strength = result.belt_duty, result.line.belt.strength
    if strength is None:
        return
    for what, needed in duty.strength_needed.items():
        name = "belt strength for the splice" + ("" if what == "steady" else f", {what}")
        yield compared(
            "splice_strength", name, strength, "at least", needed, "belt strength", source="DIN 22101:2002",
            why=f"the splice requires a belt of {{required}} ({what}; DIN 22101:2002, factors general knowledge), "
            "given: {calculated}",
        )  # fmt: skip


def cover_thickness(result: CalculatedConveyor) -> Iterator[Check]:
    """The covers protect the carcass and outlast the bulk; where the spec says how it wears them."""
    for cover in result.line.belt.covers:
        least = cover.least + cover.wear
        why = said(
            f"the {cover.cover} cover is {{}}, {{}} over the carcass and {{}} for wear are needed (DIN 22101 "
            "by points, general knowledge)",
            *((value, "thickness") for value in (cover.thickness, cover.least, cover.wear)),
        )
        yield compared(
            "cover_thickness", f"thickness of the {cover.cover} cover", cover.thickness, "at least", least, "thickness",
            source="DIN 22101", why=why,
        )  # fmt: skip


def belt_temperature(result: CalculatedConveyor) -> Iterator[Check]:
    """The covers stay within the temperatures that the belt's maker allows, as far as given."""
    relations: tuple[Relation, Relation] = ("at least", "at most")
    for limit, relation in zip(result.line.belt.bears, relations, strict=True):
        if limit is None:
            continue
        end = "lowest" if relation == "at least" else "highest"
        yield compared(
            "belt_temperature", f"{end} temperature of the covers", result.temperature, relation, limit, "temperature",
            why="the covers are at {calculated}, the belt bears {required} " + relation,
        )  # fmt: skip


def pulley_diameter(result: CalculatedConveyor) -> Iterator[Check]:
    """Every pulley is as large as the carcass asks for."""
    for pulley in result.belt_duty.pulleys:
        size, figures = "", [(pulley.diameter, "thickness"), (pulley.least, "thickness")]
        if pulley.next_size is not None:
            size = ", standard size {}"
            figures.append((pulley.next_size, "thickness"))
        name, group = quoted(pulley.name), f"DIN 22101, group {pulley.group}"
        if pulley.utilisation is not None:
            group += f" at {percent(pulley.utilisation)} of the allowed tension"
        words = f'pulley "{name}" is {{}} in diameter, the carcass requires {{}}{size} ({group})'
        yield compared(
            "pulley_diameter", f"diameter, {name} pulley", pulley.diameter, "at least", pulley.least, "thickness",
            source=group, why=Said(words, tuple(figures)),
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
                yield _radius(curve, least, fine, bad)


def _radius(curve: CurveCheck | HorizontalCheck, least: float, fine: str, bad: str) -> Check:
    section = quoted(curve.section)
    words = f'section "{section}", {curve.strand}: {bad} on the {curve.kind} curve of {{}}; '
    helps = math.isfinite(least)
    why = said(words + "at least {} are needed", (curve.radius, "length"), (least, "length"))
    made = compared(
        "curve_radius", f"{curve.kind} curve, {section}, {curve.strand}: {fine}", curve.radius, "at least",
        least if helps else None, "length", missing="no radius helps",
        why=why if helps else said(words + "no radius helps", (curve.radius, "length")),
    )  # fmt: skip
    return (
        made
        if helps
        else replace(made, verdict="FAIL", why=said(words + "no radius helps", (curve.radius, "length")))
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
        yield compared(
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
                yield _radius(bend, least, fine, bad)


def belt_drift(result: CalculatedConveyor) -> Iterator[Check]:
    """In every horizontal curve and state of motion the belt's edges stay on their rolls, with the wind given."""
    for bend in result.horizontal:
        inside, outside = bend.farthest_in, bend.farthest_out
        cure = said("at least a radius of {} is needed, or more banking", (inside.least, "length"))
        if math.isinf(inside.least):
            cure = said("no radius helps: more banking, a deeper trough or a hood")
        yield _drift(bend, inside, "inside", inside.inside, cure)
        less = "a deeper trough, a hood, less banking or skew" if bend.turn.wind else "less banking or skew"
        cure = said(less)
        if 0.0 < outside.most < math.inf:
            cure = said(less + ", or a radius of at most {}", (outside.most, "length"))
        yield _drift(bend, outside, "outside", -outside.outside, cure)


def _drift(bend: HorizontalCheck, state: DriftState, way: str, drift: float, cure: Said) -> Check:
    room, section = bend.turn.room, quoted(bend.section)
    off = math.isinf(drift)
    how = said("runs off its rolls" if off else "drifts by {}", *(() if off else ((drift, "thickness"),)))
    why = Said(
        f'section "{section}", {bend.strand}: the belt {how.words} to the {way} of the horizontal curve in the state '
        f'"{quoted(state.state)}", {{}} are left on its rolls; {cure.words}',
        (*how.figures, (room, "thickness"), *cure.figures),
    )
    made = compared(
        "belt_drift", f"drift to the {way}, {section}, {bend.strand}", drift, "at most", room, "thickness",
        source="end of the roll", wording=how if off else None, why=why, where=state.state,
    )  # fmt: skip
    return replace(made, calculated=None) if off else made


def transitions(result: CalculatedConveyor) -> Iterator[Check]:
    """Between trough and pulley no strip of the belt is overstressed or slack; of the transitions given."""
    for zone in result.belt_duty.transitions:
        for least, fine, bad in (
            (zone.stretched, "no strip overstressed", "a strip of the belt is overstressed"),
            (zone.slackened, "no strip slack", "a strip of the belt goes slack"),
        ):
            yield _transition(zone, least, fine, bad)


def _transition(of: TransitionCheck, least: float | None, fine: str, bad: str) -> Check:
    key, subject = "transition_length", said(f"{of.zone.end} transition: {fine}")
    length, missing = of.zone.length, of.missing or "least lengths in its table"
    if length is None or least is None:
        words = said("length not given") if length is None else said("{}", (length, "length"))
        return Check(key, subject, length, None, "length", words, said(missing), "not checked")
    if math.isinf(least):
        why = said(
            f"{of.zone.end} transition: {bad} whatever its length, at a belt tension of {{}} to {{}} per width",
            (of.lowest, "belt rating"),
            (of.highest, "belt rating"),
        )
        asked = said("no length helps")
        return Check(key, subject, length, None, "length", said("{}", (length, "length")), asked, "FAIL", why)
    why = said(
        f"{of.zone.end} transition: {bad} over {{}}; at least {{}} are needed (ISO 5293 taken on to every strip)"
        + ("; or raise the pulley towards half trough" if of.zone.pulley_height < _HALF_TROUGH else ""),
        (length, "length"),
        (least, "length"),
    )
    return compared(key, subject, length, "at least", least, "length", why=why)


def impact_load(result: CalculatedConveyor) -> Iterator[Check]:
    """Where bulk falls, the sets bear what rests on them with the impact; of loading points that give the drop."""
    for landing in result.landings:
        point, load = landing.point, landing.load
        if load is None:
            continue
        missing = "load that a set there bears (idler_rating) not given"
        if point.lump_mass is not None and landing.lump is None:
            missing = "spring rate for the lump (idler_stiffness) not given"
        rating = None if point.lump_mass is not None and landing.lump is None else point.idler_rating
        yield compared(
            "impact_load", f"load of an impact set{quoted(point.name)}", load, "at most", rating, "force",
            source="its maker", missing=missing,
            why=f"the bulk lands on sets{quoted(point.name)} with {{calculated}}, they bear {{required}}: less drop, "
            "sets closer together (stream) or softer (lumps), a heavier series",
        )  # fmt: skip


def skirtboards(result: CalculatedConveyor) -> Iterator[Check]:
    """Skirtboards reach at least as far as the belt accelerates the bulk; of loading points that give their length."""
    for landing in result.landings:
        point = landing.point
        if point.skirtboards is not None:
            yield compared(
                "skirtboards", f"length of the skirtboards{quoted(point.name)}", point.skirtboards, "at least",
                landing.acceleration, "length", source="zone of acceleration, ISO 5048",
                why=f"the skirtboards{quoted(point.name)} end {{calculated}} behind the place of loading, the bulk has "
                "the belt's speed after {required}: longer ones, or bulk that lands faster",
            )  # fmt: skip


def belt_cleaning(result: CalculatedConveyor) -> Iterator[Check]:
    """The cleaners leave no more on the belt than is allowed; where the spec says what clings to it."""
    on_belt, allowed = result.line.carryback
    if on_belt is not None:
        left = result.cleanings[-1].left if result.cleanings else None
        left = on_belt if left is None else left
        yield compared(
            "belt_cleaning", "bulk left on the belt behind its cleaners", left, "at most", allowed, "area mass",
            missing="carryback_allowed not given",
            why="the cleaners leave {calculated} on the belt, {required} is allowed: one more, or better ones",
        )  # fmt: skip


def pulley_shaft(result: CalculatedConveyor) -> Iterator[Check]:
    """The shaft of every pulley that gives its distances bears bending and torsion, and bends little at the hubs."""
    for duty in result.pulley_duty:
        if duty.slope is None:
            continue
        name, where = quoted(duty.pulley.name), duty.largest.state
        needed = () if duty.least_shaft is None else ((duty.least_shaft, "thickness"),)
        cure = "; {} in the hubs (hub_shaft_diameter) are needed" if needed else ""
        why = said(f'the shaft of pulley "{name}" bends too much at its hubs{cure}', *needed)
        yield compared(
            "pulley_shaft_slope", f"slope at the hubs, {name} pulley", duty.slope, "at most", HUB_SLOPE, "number",
            source="CEMA B105.1", wording=said(f"{duty.slope:.4f}"), why=why, where=where,
        )  # fmt: skip
        subject = said(f"safety of the shaft, {name} pulley")
        asked = said("at least {} (CEMA B105.1)", (SHAFT_SAFETY, "number"))
        if duty.safety is None:
            yield Check(
                "pulley_shaft_safety", subject, None, SHAFT_SAFETY, "safety", said("not known"),
                said("steel of the shaft not given"), "not checked",
            )  # fmt: skip
            continue
        safety, where = duty.safety
        why = said(f'the shaft of pulley "{name}" is too thin for bending and torsion{cure}', *needed)
        yield compared("pulley_shaft_safety", subject, safety, "at least", SHAFT_SAFETY, "safety", asked=asked,
                       why=why, where=where)  # fmt: skip


def pulley_bearings(result: CalculatedConveyor) -> Iterator[Check]:
    """The bearings of every pulley that gives their rating live as long as asked, in steady running."""
    for duty in result.pulley_duty:
        seconds, name = duty.bearing_seconds, quoted(duty.pulley.name)
        if seconds is None:
            continue
        yield compared(
            "pulley_bearings", f"L10 life of a bearing, {name} pulley", seconds, "at least", duty.pulley.bearing_life,
            "duration", missing="life asked of it (bearing_life) not given",
            why=f'the bearings of pulley "{name}" reach an L10 of {{calculated}}, {{required}} are required',
        )  # fmt: skip


def lagging(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt presses no harder on a lagging than its maker allows; of laggings that give it."""
    for duty in result.pulley_duty:
        allowed, name = duty.pulley.allowed_pressure, quoted(duty.pulley.name)
        if allowed is not None:
            yield compared(
                "lagging_pressure", f"pressure on the lagging, {name} pulley", duty.pressure, "at most", allowed,
                "pressure", why=f'the belt presses with {{calculated}} on the lagging of pulley "{name}", it bears '
                "{required}; a larger diameter",
            )  # fmt: skip


def starting_force(result: CalculatedConveyor) -> Iterator[Check]:
    """The motors give what a controlled start asks, or accelerate the belt over its whole run-up; it breaks away."""
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
        yield compared("starting_force", "starting force, motors", given, relation, limit, "force", why=why)
    given = start.standstill if result.start_of_motors is None else result.start_of_motors
    yield compared(
        "breakaway", "starting force after standstill", given, "at least", start.breakaway, "force",
        why="the starting force of {calculated} does not overcome the resistance after standstill, up to {required}: "
        "raise drive.start_factor or the motors' torque",
    )  # fmt: skip


def comes_to_rest(result: CalculatedConveyor) -> Iterator[Check]:
    """The conveyor stops without power by friction alone, or by its brakes; each beside the other."""
    moving, brakes = result.motions, math.fsum(result.line.brakes)
    alone, stopped = moving.coasting_least, moving.braked
    why = said("the conveyor does not stop by itself and has no brake: give drive.brake_force")
    if moving.runaway is not None:
        why = said(
            "the conveyor does not stop by itself and has no brake, it runs away at {}: give drive.brake_force",
            (moving.runaway, "acceleration"),
        )
    words = _rest(alone, moving.runaway)
    safe = alone is not None or stopped is not None
    asked = said("a stop at minimum friction" if brakes == 0.0 else "a stop at minimum friction, or brakes")
    yield Check(
        "comes_to_rest", said("coast-down stop"), None if alone is None else alone.time, None,
        "duration", words, asked, verdict(holds=safe), why, _AT_MOST,
    )  # fmt: skip
    if brakes > 0.0:
        why = said("brakes of {} do not stop the conveyor", (brakes, "force"))
        yield Check(
            "comes_to_rest", said("coast-down stop, brakes on"), None if stopped is None else stopped.time,
            None, "duration", _rest(stopped, None), said("a stop at minimum friction"),
            verdict(holds=stopped is not None), why, _AT_MOST,
        )  # fmt: skip


def _rest(stopping: Stop | None, runaway: float | None) -> Said:
    """How a conveyor comes to rest, in words."""
    if stopping is not None:
        return said(f"in {stopping.time:,.1f} s, {{}}", (stopping.distance, "length"))
    return said("does not") if runaway is None else said("runs away at {}", (runaway, "acceleration"))


def holding(result: CalculatedConveyor) -> Iterator[Check]:
    """A brake or backstop holds the loaded belt, and brakes give the deceleration wanted."""
    moving, line = result.motions, result.line
    given = any(drive.brake is not None for drive in line.drives)
    brakes = math.fsum(line.brakes)
    if moving.brake_to_hold > 0.0:
        what = "backstop" if moving.rolls_back else "brake"
        bear = _backstops(line) if moving.rolls_back else ()
        known = given or bool(bear)
        none = "no brake given, nor what a backstop bears" if moving.rolls_back else "no brake given"
        made = compared(
            "holding_brake", f"holding {what}, loaded belt", math.fsum((brakes, *bear)), "at least",
            moving.brake_to_hold, "force", wording=None if known else said(none),
            why=f"the loaded belt needs a {what} of {{required}} at the belt to stay at rest",
        )  # fmt: skip
        yield made if known else replace(made, verdict="not checked")
    if moving.brake_to_stop is not None:
        yield compared(
            "stopping_brake", "brakes for the specified deceleration", brakes, "at least", moving.brake_to_stop,
            "force", wording=None if given else said("no brake given"),
            why="drive.stop_deceleration requires brakes of {required} at the belt, given: {calculated}",
        )  # fmt: skip


def _backstops(line: Line) -> tuple[float, ...]:
    """What the backstops of given torque bear at the belt [N]."""
    parts = ((drive.parts, drive.radius) for drive in line.drives)
    return tuple(
        part.backstop / radius
        for part, radius in parts
        if part is not None and part.backstop is not None and radius is not None
    )


def drive_parts(result: CalculatedConveyor) -> Iterator[Check]:
    """Backstops, brakes, starts an hour and sharing without control, of drives that give what they bear."""
    motor = result.balance.frame.motor
    for duty in result.drive_duty:
        name, parts, installed = quoted(duty.drive.name), duty.parts, duty.drive.power
        if parts.backstop is not None and duty.backstop is not None:
            yield compared(
                "backstop_torque", f"torque of the backstop, {name}", duty.backstop, "at most", parts.backstop,
                "torque", where="holding" if duty.backstop == duty.holding else "motors stalled",
                why=f'the backstop of "{name}" bears {{required}}, {{calculated}} are asked of it',
            )  # fmt: skip
        if parts.heat is not None and duty.heat is not None:
            yield compared(
                "brake_heat", f"heat of a stop in the brake, {name}", duty.heat, "at most", parts.heat, "energy",
                why=f'a stop leaves {{calculated}} in the brake of "{name}", it bears {{required}}',
            )  # fmt: skip
        if parts.starts is not None and duty.allowed_starts is not None:
            yield _starts(name, parts.starts, duty.allowed_starts)
        if duty.shared is not None and installed is not None:
            yield compared(
                "load_sharing", f"motor power by uncontrolled sharing, {name}", abs(motor(duty.shared)), "at most",
                installed, "power",
                why=f'"{name}" takes {{calculated}} where nothing but the belt couples the drives, installed: '
                "{required}; control the sharing, or choose motors of more slip and pulleys alike",
            )  # fmt: skip


def _starts(name: str, asked: float, allowed: float | str) -> Check:
    subject = said(f"starts an hour, {name}")
    if isinstance(allowed, str):
        wanted = said("{}", (asked, "number"))
        return Check("motor_starts", subject, asked, None, "number", wanted, said(allowed), "not checked")
    return compared(
        "motor_starts", subject, asked, "at most", allowed, "number",
        asked=said(f"at most {allowed:.2f} (NEMA MG 10)"),
        why=f'the motors of "{name}" bear {allowed:.2g} starts an hour of this load (NEMA MG 10), {asked:g} are asked '
        "for: a coupling or an inverter",
    )  # fmt: skip


def coasting_time(result: CalculatedConveyor) -> Iterator[Check]:
    """Without power and brakes the conveyor runs on as long as wanted; else the flywheel for it is named."""
    wanted, stopped = result.line.coast_time, result.motions.coasting
    if wanted is None or stopped is None:
        return
    inertia = coasting_flywheel(result.line, result.motions)
    figures = () if inertia is None else ((inertia, "inertia"),)
    cure = ": a flywheel of {} at the motors' shafts" if figures else ""
    why = said(f"the conveyor coasts for {stopped.time:,.1f} s, {wanted:,.1f} s are wanted{cure}", *figures)
    yield compared(
        "coasting_time", "coasting without power", stopped.time, "at least", wanted, "time", why=why,
        wording=said(f"{stopped.time:,.1f} s"), asked=said(f"at least {wanted:,.1f} s"),
    )  # fmt: skip


def bulk_slip(result: CalculatedConveyor) -> Iterator[Check]:
    """The bulk stays on the belt in running, stopping and starting."""
    slip = result.motions.slip
    if slip is None:
        return
    if slip.sliding:
        where = quoted(", ".join(slip.sliding))
        yield Check(
            "bulk_slip", said("no material slip in running"), None, None, "acceleration", said(f"slips in {where}"),
            said("no slip"), "FAIL",
            said(f'the material slips on the belt in section "{where}" at any speed: too steep for its friction'),
        )  # fmt: skip
        return
    hardest, fastest = result.motions.hardest
    for key, when, occurs, allowed, where in (
        ("bulk_slip_stopping", "on stopping", -hardest, -slip.braking, slip.braking_at),
        ("bulk_slip_start", "on starting", fastest, slip.starting, slip.starting_at),
    ):
        why = f'the material slips {when}: {{calculated}}, section "{quoted(where)}" allows {{required}}'
        yield compared(
            key, f"no material slip {when}", occurs, "at most", allowed, "acceleration", why=why, where=where
        )


def penetration(result: CalculatedConveyor) -> Iterator[Check]:
    """No roll presses deeper into its cover than the law of small strain bears."""
    for strand in STRANDS:
        deepest, thickness = result.contacts.deepest(strand), result.contacts.covers[strand].thickness
        why = said(
            f"{strand} rolls indent the cover by {percent(deepest)} of its thickness ({{}}): beyond small strain, "
            "the linear law is not proven",
            (thickness, "thickness"),
        )
        yield Check(
            "penetration", said(f"penetration of the cover, {strand} rolls"), deepest, DEEP, "fraction",
            said(f"{percent(deepest, 1)} of its thickness"), said(f"at most {percent(DEEP)} (small strain)"),
            verdict(holds=deepest <= DEEP), why, "at most",
        )  # fmt: skip


def roll_life(result: CalculatedConveyor) -> Iterator[Check]:
    """Idler sets last as long as light series are rated for, where their bearings are given."""
    for strand in STRANDS:
        life = shortest_life(result.line.stretches, strand, result.line.speed)
        if life is None:
            continue
        why = said(
            f"{strand} rolls: L10 of all bearings of a set in {quoted(life.section)} is {{}} (of the {life.weakest} "
            f"alone {{}}), less than the {ASKED_LIFE:,.0f} h that light series are rated for (CEMA, as commonly "
            "reproduced); seals and dirt may end it sooner",
            *((3600.0 * hours, "duration") for hours in (life.hours, life.weakest_hours)),
        )
        asked, judged = said(f"at least {ASKED_LIFE:,.0f} h"), verdict(holds=not life.too_short)
        if not life.whole and not life.too_short:
            asked, judged = said("bearings of some rolls not given"), "not checked"
        yield Check(
            "roll_life", said(f"L10 life, {strand} idler sets"), 3600.0 * life.hours, 3600.0 * ASKED_LIFE,
            "duration", said("{}", (3600.0 * life.hours, "duration")), asked, judged, why,
        )  # fmt: skip


def set_rating(result: CalculatedConveyor) -> Iterator[Check]:
    """No set bears more than it is rated for; of sets that give a class or a rating."""
    for strand, duties in _sets_of_strands(result):
        rated = [(duty, duty.limits.rating) for duty in duties if duty.limits.rating is not None]
        if not rated:
            continue
        worst, rating = max(rated, key=lambda pair: pair[0].limits.load / pair[1])
        limits = worst.limits
        of_class = "" if limits.cema_class is None else f"CEMA class {limits.cema_class}"
        of_class += ", general knowledge" if limits.cema_class == "E" else ""
        cure = "" if limits.least_class is None else f"; class {limits.least_class} bears it"
        section = worst.stretch.section
        yield compared(
            "set_rating", f"load of a set, {strand} idlers", limits.load, "at most",
            None if limits.lump_factor is None else rating, "force", source=of_class, where=section,
            missing="lump_factor not given: none is printed for such lumps",
            why=f"{strand} sets in {quoted(section)} bear {{calculated}}, they are rated for {{required}}{cure}",
        )  # fmt: skip


def roll_axle(result: CalculatedConveyor) -> Iterator[Check]:
    """The axles of the rolls bend no more at their bearings than these bear; of axles that are given."""
    for strand, duties in _sets_of_strands(result):
        axles = [(duty.limits.axle, duty.stretch.section) for duty in duties if duty.limits.axle is not None]
        if not axles:
            continue
        axle, section = max(axles, key=lambda of: of[0].slope / of[0].allowed)
        yield compared(
            "roll_axle", f"slope of the axle at its bearings, {strand} rolls", axle.slope, "at most", axle.allowed,
            "angle", where=f"{axle.roll}, {section}",
            why=f"the axle of the {axle.roll} roll, {strand}, {quoted(section)}, slopes by {{calculated}} at its "
            "bearings, they bear {required}: a thicker axle, a closer spacing",
        )  # fmt: skip


def belt_flap(result: CalculatedConveyor) -> Iterator[Check]:
    """The rolls' rotation stays off the belt's natural frequencies between sets; where a distance is asked for."""
    for strand, duties in _sets_of_strands(result):
        asked = [duty for duty in duties if duty.limits.flap_margin is not None]
        if not asked:
            continue
        worst = min(asked, key=lambda duty: duty.distance)
        cure, figures = "; a higher tension", list[tuple[float, str]]()
        if worst.still_spacing is not None and worst.still_diameter is not None:
            cure = "; sets at most {} apart, or rolls of at least {}, keep it still"
            figures = [(worst.still_spacing, "length"), (worst.still_diameter, "thickness")]
        why = said(
            f"the belt may flap on its {strand} sets in {quoted(worst.stretch.section)}: rolls turn at "
            f"{_band(worst.rotations)} Hz, the belt swings at {_band(worst.frequencies)} Hz and twice that{cure}",
            *figures,
        )
        yield compared(
            "belt_flap", f"distance from resonance of belt and rolls, {strand}", worst.distance, "at least",
            worst.limits.flap_margin, "fraction", wording=said(percent(worst.distance)), why=why,
            asked=said(f"at least {percent(worst.limits.flap_margin or 0.0)}"), where=worst.stretch.section,
        )  # fmt: skip


def _band(ends: tuple[float, float]) -> str:
    """Both ends of a band in words, an even one once."""
    return " to ".join(dict.fromkeys(f"{end:.3g}" for end in ends))


def _sets_of_strands(result: CalculatedConveyor) -> Iterator[tuple[Strand, list[SetDuty]]]:
    for strand in STRANDS:
        yield strand, [duty for duty in result.set_duty if duty.stretch.strand == strand]


def rubber_coverage(result: CalculatedConveyor) -> Iterator[Check]:
    """The data of each rubber cover the band in which its rolls lose nine tenths of their energy."""
    for strand, compound in compounds_by_strand(result.conveyor).items():
        if compound.kind == "illustrative":
            if result.contacts.lossy(strand):
                yield Check(
                    "rubber_coverage", said(f"rubber, {strand}"), None, None, "frequency",
                    said("constructed spectrum"), said("a measured compound required"), "not checked",
                )  # fmt: skip
            continue
        band = result.contacts.excited_band(strand)
        if band is None:
            continue
        yield _covering(
            strand, quoted(compound.name), band, compound.frequencies(result.temperature), result.temperature
        )


def _covering(
    strand: Strand, name: str, band: tuple[float, float], data: tuple[float, float] | None, at: float
) -> Check:
    """A band against that of the data [Hz]; the end that is nearer to theirs, or farther beyond it, decides."""
    subject = f"rubber data over the excitation band, {strand}"
    shown = said(f"{band_words(band)} at {{}}", (at, "temperature"))
    if data is None:
        missing = "range of the data not stated"
        return compared(
            "rubber_coverage", subject, band[1], "at most", None, "frequency", wording=shown, missing=missing
        )
    why = said(
        f'compound "{name}": 90 % of the loss of the {strand} rolls lies between '
        f"{band[0]:.3g} and {band[1]:.3g} Hz, its data cover {data[0]:.3g} to {data[1]:.3g} Hz "
        "at {}: the series is extrapolated: not for design",
        (at, "temperature"),
    )
    ends = (
        compared(
            "rubber_coverage", subject, band[0], "at least", data[0], "frequency", wording=shown, why=why
        ),
        compared(
            "rubber_coverage", subject, band[1], "at most", data[1], "frequency", wording=shown, why=why
        ),
    )
    return replace(min(ends, key=severity), asked=said(f"within {band_words(data)}"))


def worst_not_sought(line: Line) -> frozenset[str]:
    """Keys of criteria for which no loading of a conveyor is sought that would be worse than those calculated."""
    return _LOADS_THERE_ARE | (_OF_STRETCHES if line.count > ONE_BY_ONE else frozenset())


def covered(result: CalculatedConveyor) -> bool:
    """Whether the rubber's data cover what a calculation rests on; else its figures are none to design by."""
    return not any(check.failed for check in rubber_coverage(result))


OF_CONTACTS: Final = (penetration, rubber_coverage)
"""Criteria that need every roll's contact; the others need forces and tensions only."""
_LOADS_THERE_ARE: Final = frozenset({"belt_flap", "load_sharing", "penetration", "rubber_coverage"})
"""Keys of criteria of which only the loads that are calculated anyway are looked at."""
_OF_STRETCHES: Final = frozenset({"curve_radius", "belt_drift", "set_rating"})
"""Keys of criteria of single sections: of long routes they are looked at as the others are."""
CRITERIA: Final[tuple[Callable[[CalculatedConveyor], Iterable[Check]], ...]] = (
    filling, motor_power, take_up_tension, take_up_reach, drive_grip, sag, slack_belt, belt_safety, belt_rating,
    belt_breakage, splice_strength, cover_thickness, belt_temperature, pulley_diameter, curve_radius,
    wind_lift, horizontal_edges, belt_drift, transitions, impact_load, skirtboards, belt_cleaning, pulley_shaft,
    pulley_bearings, lagging, starting_force, comes_to_rest, holding, drive_parts, coasting_time, bulk_slip,
    penetration, roll_life, set_rating, roll_axle, belt_flap, rubber_coverage,
)  # fmt: skip
