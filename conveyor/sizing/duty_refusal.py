"""Error of a duty that no belt, speed and rolls satisfy."""

from __future__ import annotations

import math
from operator import itemgetter
from typing import NoReturn

from conveyor.errors import NoSolutionError
from conveyor.laws.preliminary_sizing import least_width_for_lumps, standard_edge_distance
from conveyor.models.belt_shapes import Trough
from conveyor.models.sizing import within_limit
from conveyor.sizing.design_choice import WidthSize
from conveyor.sizing.sizing_task import SizingTask
from conveyor.units import from_si, text
from conveyor.units.presentation import format_figure
from conveyor.units.sentences import percent


def refuse_slope(task: SizingTask) -> None:
    """Refuse a route steeper than the bulk is carried on.

    Raises
    ------
    NoSolutionError
        A section is too steep.
    """
    if not within_limit(task.steepest, task.steepest_for_bulk):
        system = task.duty.report.units
        slope, asked = (format_figure(each, "angle", system) for each in (task.steepest, task.steepest_for_bulk))
        source = Trough.slope_source if task.duty.material.max_slope is None else "material.max_slope"
        raise NoSolutionError(
            f"route: a section slopes by {slope}, the bulk is carried on {asked} at most ({source}): a longer route, "
            "or material.max_slope where the bulk bears more"
        )


def refuse_duty(task: SizingTask) -> NoReturn:
    """Raise the error of a duty that no belt, speed and rolls satisfy, naming the rule that fails.

    Raises
    ------
    NoSolutionError
        No belt is wide enough for the lumps or fast and full enough for the flow; or speeds are too fast, belts too
        wide, free edges too narrow, rolls too fast.
    """
    duty, rules, system = task.duty, task.rules, task.duty.report.units
    lumps = least_width_for_lumps(task.lump, surcharge_angle=duty.material.surcharge, share=duty.lumps)
    widest = task.widest_belt
    if not within_limit(lumps, widest):
        asked, had = (format_figure(width, "thickness", system) for width in (lumps, widest))
        raise NoSolutionError(
            f"lump: {text(duty.lump)} asks for a belt of {asked}, the widest has {had} (rules.widths)"
        )
    surcharge = duty.material.surcharge_angle
    if not task.heaps:
        raise NoSolutionError(
            f"route: on a slope of {format_figure(task.steepest, 'angle', system)} no heap of {text(surcharge)} "
            f"stands, "
            "and flat sets hold nothing else: allow troughs (rules.trough_angles)"
        )
    pairs = [(trough, v) for trough in task.troughs for v in task.speeds if task.allows(trough, v)]
    if not pairs:
        slowest = format_figure(min(task.speeds), "speed", system)
        raise NoSolutionError(
            f"every speed, from {slowest}, is faster than the rules or CEMA allow for every width and abrasiveness "
            f'"{duty.abrasiveness}": allow slower ones or a faster belt (rules.speeds, rules.fastest, rules.widths)'
        )
    most = max(trough.area * v for trough, v in pairs) * task.density * task.fullest
    if task.flow > most:
        raise NoSolutionError(
            f"material.flow: {text(duty.material.flow)} is more than the widest and fastest belt takes, "
            f"{format_figure(most, 'mass flow', system)} (rules.widths, rules.fastest, rules.speeds, rules.filling)"
        )
    pairs = [pair for pair in pairs if task.filled(*pair) <= task.fullest]
    if not any(task.full_enough(*pair) for pair in pairs):
        fullest = max(task.filled(*pair) for pair in pairs)
        raise NoSolutionError(
            f"material.flow: {text(duty.material.flow)} fills no belt that may be chosen to more than "
            f"{percent(fullest)}, rules.least_filling asks for {text(rules.least_filling)}: allow narrower or "
            "slower belts (rules.widths, rules.speeds), or a lower filling"
        )
    pairs = [pair for pair in pairs if task.full_enough(*pair)]
    if all(task.filling(*pair) is None for pair in pairs):
        edges = [(task.edge(*pair), standard_edge_distance(pair[0].width.belt)) for pair in pairs]
        edge, asked = (format_figure(each, "thickness", system) for each in max(edges, key=lambda of: of[0] / of[1]))
        raise NoSolutionError(
            f"the bulk leaves {edge} of either edge of the belt free, CEMA asks for {asked}: allow wider or faster "
            "belts (rules.widths, rules.speeds, rules.fastest)"
        )
    on_rolls = [
        (roll, on, v) for trough, v in pairs for roll in task.rolls if (on := task.trough_on(roll, trough)) is not None
    ]
    if not on_rolls:
        raise NoSolutionError(_missing_rolls(task, pairs[0][0].width))
    rolling = [(v / (math.pi * roll.diameter), roll, v) for roll, on, v in on_rolls if task.filling(on, v) is not None]
    if not rolling:
        raise NoSolutionError(
            "with the lengths of the listed rolls no belt keeps the filling and the free edges asked for: list further "
            "ones (listed.rolls), or allow wider or faster belts (rules.widths, rules.speeds, rules.filling)"
        )
    turns, roll, slowest_belt = min(rolling, key=itemgetter(0))
    if not task.turns_slowly(roll, slowest_belt):
        at, size, turn = (
            format_figure(value, kind, system)
            for value, kind in ((slowest_belt, "speed"), (roll.diameter, "thickness"), (turns, "rotation"))
        )
        raise NoSolutionError(
            f"at {at} the rolls of {size}, those that turn most slowly, turn at {turn}, "
            f"{text(rules.roll_rotation)} are allowed (rules.roll_rotation): allow slower or wider belts or larger "
            "rolls (rules.speeds, rules.widths, rules.roll_diameters)"
        )
    raise NoSolutionError(
        "no class of rolls of the series has sets for the widths and troughs that take the flow: allow others "
        "(rules.widths, rules.trough_angles, rules.series)"
    )


def _missing_rolls(task: SizingTask, width: WidthSize) -> str:
    """Words of a duty without rolls for its belts: lengths that a width needs, and the nearest there are."""
    unit, digits = ("in", 2) if task.duty.report.units == "US" else ("mm", 0)

    def size(value: float) -> str:
        """Length to the last digit that rolls are listed by."""
        return f"{from_si(value, 'length', unit).magnitude:.{digits}f} {unit}"

    carry, back = (
        f"{size(length)} ({size(shortest)} to {size(longest)})" for length, shortest, longest in width.suitable_lengths
    )
    needed = f"a belt of {size(width.belt)} needs rolls of one diameter, {carry} long for carry sets, {back} for return"
    cure = "list further ones (listed.rolls), or allow others (rules.roll_diameters, rules.widths)"
    if not any(roll.pieces for roll in task.rolls):
        return f"no rolls that may be chosen are of the diameters that the belts that take the flow need: {cure}"
    near = [
        f"{size(roll.diameter)}: {' and '.join(size(long) for long in dict.fromkeys(roll.nearest(width)))}"
        for roll in {roll.diameter: roll for roll in task.rolls}.values()
    ]
    return f"no listed rolls are of the diameters and lengths that the belts that take the flow need: {needed}; " + (
        f"the nearest listed, by diameter, are {'; '.join(near)}: {cure}"
    )
