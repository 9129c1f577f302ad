"""Criteria of a pipe: its belt bears on all rolls, laps and passes lumps."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.laws.pipe_geometry import LEAST_LAP, pipe_roll_lengths
from conveyor.line.set_loads import FormedPipe
from conveyor.units.sentences import message, percent


def pipe_bearing(result: CalculatedConveyor) -> Iterator[Check]:
    """The belt is stiff enough across for the empty pipe to bear on all six rolls."""
    pipe = FormedPipe.of(result.conveyor, result.conveyor.idlers.carry)
    if pipe is None:
        return
    key, subject, least = "pipe_bearing", "stiffness across the belt, pipe on all six rolls", pipe.least_stiffness
    if least is None:
        shown = message("{}", (pipe.stiffness, "moment"))
        why = message("with this lap the empty pipe leaves a roll untouched, however stiff the belt: a wider belt")
        yield Check(key, message(subject), pipe.stiffness, None, "moment", shown, message("a wider lap"), "FAIL", why)
        return
    yield check_against_limit(
        key, subject, pipe.stiffness, "at least", least, "moment", source="elastic strip, derived",
        why="the empty pipe bears on all six rolls from a stiffness across the belt of {required}, here it is "
        "{calculated}: a stiffer belt, or the pipe does not keep its form",
    )  # fmt: skip


def pipe_lap(result: CalculatedConveyor) -> Iterator[Check]:
    """The edges of the belt lap far enough to stay closed."""
    pipe = FormedPipe.of(result.conveyor, result.conveyor.idlers.carry)
    if pipe is not None:
        least = LEAST_LAP * pipe.circumference
        yield check_against_limit(
            "pipe_lap", "lap of the pipe", pipe.lap, "at least", least, "thickness",
            wording=message(f"{{}}, {percent(pipe.lap / pipe.circumference)} of the circumference",
                            (pipe.lap, "thickness")),
            source=f"{percent(LEAST_LAP)}, general knowledge",
            why=f"the belt laps by {{calculated}}, {{required}} ({percent(LEAST_LAP)} of the circumference, general "
            "knowledge) are the least with which a pipe stays closed: a wider belt, or a smaller pipe",
        )  # fmt: skip


def pipe_rolls(result: CalculatedConveyor) -> Iterator[Check]:
    """The rolls of a panel are long enough to bear the pipe all round, and not longer than the polygon they form."""
    conveyor = result.conveyor
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        pipe = FormedPipe.of(conveyor, idlers)
        if pipe is None:
            continue
        length, radius = pipe.roll_length, pipe.outer_radius
        shortest, longest = pipe_roll_lengths(pipe.diameter, outer_radius=radius, offset=pipe.offset)
        yield check_against_limit(
            "pipe_roll_shortest", f"length of the rolls round the pipe, {strand}, shortest", length, "at least",
            shortest, "thickness", source="a sixth of the circumference",
            why=f"{strand} rolls of {{calculated}} leave gaps round the pipe, {{required}} bear it all round: longer "
            "ones",
        )  # fmt: skip
        yield check_against_limit(
            "pipe_roll_longest", f"length of the rolls round the pipe, {strand}, longest", length, "at most", longest,
            "thickness", source=f"{'triangle' if pipe.offset else 'hexagon'} round the pipe, geometry",
            why=f"{strand} rolls of {{calculated}} do not fit round the pipe, {{required}} do: shorter ones, "
            "or every other one behind the panel (offset)",
        )  # fmt: skip


def pipe_lumps(result: CalculatedConveyor) -> Iterator[Check]:
    """The largest lump passes the pipe; none without its size."""
    pipe, lump = result.conveyor.idlers.carry.pipe, result.line.lump
    if pipe is not None and lump is not None:
        yield check_against_limit(
            "pipe_lumps", "largest lump in the pipe", lump, "at most", pipe.largest_lump, "thickness",
            source="idlers.carry.pipe.lump",
            why="lumps of {calculated} jam in the pipe, {required} is allowed: crush finer, or a wider pipe",
        )  # fmt: skip
