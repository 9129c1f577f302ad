"""Criteria of belt tension and take-up: grip, sag, slack, setting and travel."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit, pass_or_fail
from conveyor.laws.take_up import SCREW_LENGTH
from conveyor.laws.tension import grip_tension
from conveyor.line.line import Line
from conveyor.line.stretches import STRANDS
from conveyor.line.usual_parts import LOOP_KINDS
from conveyor.loop.equilibrium import tension_suffices
from conveyor.loop.start_and_stop import motion_states
from conveyor.loop.take_up_duty import TakeUpDuty, take_up_weight_mass
from conveyor.units.sentences import escape_braces, message


def take_up_tension(result: CalculatedConveyor) -> Iterator[Check]:
    """The take-up's tension suffices for grip and sag in every state; names the governing or all failed conditions."""
    settled = result.balance.equilibrium
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


def take_up_place(result: CalculatedConveyor) -> Iterator[Check]:
    """The pulleys of a take-up in the belt's loop do not stand where the belt bears bulk."""
    line = result.line
    if line.take_up.kind not in LOOP_KINDS:
        return
    section = _section_at_take_up(line, behind=result.balance.equilibrium.take_up.behind)
    found, why = "none", None
    if section is not None:
        found = "on the belt"
        why = message(
            "the take-up stands in the loaded carry strand, where no pulley bends the belt: set route.take_up.position "
            "to head, tail or return"
        )
    yield Check(
        "take_up_place", message("bulk at the take-up"), None, None, "number", message(found), message("none"),
        pass_or_fail(holds=section is None), why, where=section or "",
    )  # fmt: skip


def _section_at_take_up(line: Line, *, behind: bool) -> str | None:
    """Section whose bulk is on the belt at the take-up, `behind` or before the drives; None if none is.

    A tripper takes the bulk off before its drive; at the head the carry strand ends before the drives.
    """
    unit = line.take_up
    spot = line.drives[0].spot if unit.spot is None else unit.spot
    section = spot.boundary - line.count - 1
    taken_off = any(point.lift is not None and point.spot.boundary == spot.boundary for point in line.loading)
    if section < 0 or taken_off or (spot.boundary == 2 * line.count and behind):
        return None
    stretch = line.stretches[section]
    return stretch.section if stretch.bulk_mass > 0.0 else None


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
    """Between no two idler sets the belt sags more than allowed while it runs steadily; plates let nothing sag."""
    settled, shape = result.balance.equilibrium, result.line.loop
    running = settled.running
    lowest, least = [np.minimum(state.starts, state.ends).tolist() for state in running], shape.least.tolist()
    for strand in STRANDS:
        on_sets = [i for i, one in enumerate(shape.stretches) if one.strand == strand and one.bed is None]
        if not on_sets:
            continue
        k, i = min(itertools.product(range(len(running)), on_sets), key=lambda at: lowest[at[0]][at[1]] / least[at[1]])
        tension, needed, section = lowest[k][i], least[i], shape.stretches[i].section
        yield check_against_limit(
            "sag", f"minimum tension (sag), {strand}", tension, "at least", needed, "force",
            holds=tension_suffices(tension, needed), where=f"{section}, {running[k].name}",
            why=f'the belt sags more than allowed in section "{escape_braces(section)}", {strand}: tension '
                f'{{calculated}}, '
            "{required} are needed",
        )  # fmt: skip


def slack_belt(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt is nowhere slack in any state of motion; names the slackest state or every one that fails."""
    states, settled = motion_states(result.balance, result.motions), result.balance.equilibrium
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
