"""Criteria of the belt: strength, splice, covers, temperature."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, Relation, check_against_limit, leave_open_unless_failed
from conveyor.laws.belt_strength import RATED_START
from conveyor.laws.turnover import least_turnover_length
from conveyor.units.sentences import message


def belt_safety(result: CalculatedConveyor) -> Iterator[Check]:
    """Belt strength over its tension, steady and in all states; not for a belt given by its rating alone."""
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
    yield check_against_limit(
        "belt_safety", "belt safety factor, all states", duty.safety or safety, "at least", needed / RATED_START,
        "safety", source=f"DIN 22101:1982 over {RATED_START:g}, general knowledge",
        why="safety of the belt {calculated} at the highest tension of starts and stops, {required} is usual (two "
        "thirds of that in steady running, general knowledge): a softer start or stop, or a stronger belt",
    )  # fmt: skip


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


def belt_turnover(result: CalculatedConveyor) -> Iterator[Check]:
    """Turnovers are as long as the rule of thumb for textile belts asks; those of steel cord, longer, have none."""
    if not result.conveyor.route.turned_over:
        return
    key, subject, belt = "belt_turnover", message("length of the turnovers"), result.line.belt
    least = least_turnover_length(belt.width)
    length = result.conveyor.turnover_length
    if length is None:
        asked = message("at least {} (rule of thumb)", (least, "length"))
        if belt.steel_cord:
            asked = message("that of the belt's maker")
        yield Check(key, subject, None, least, "length", message("turnover_length not given"), asked, "not checked")
        return
    made = check_against_limit(
        key, subject, length, "at least", least, "length", source="rule of thumb",
        why="turnovers of {calculated} leave the middle of the belt too slack, {required} are usual (12 belt widths, "
        "rule of thumb): longer ones, or ask the belt's maker",
    )  # fmt: skip
    unknown = message("no rule for steel cord, ask the belt's maker")
    yield leave_open_unless_failed(made, unknown) if belt.steel_cord else made


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
