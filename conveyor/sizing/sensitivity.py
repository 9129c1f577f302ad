"""Sensitivity of a design: one choice varied at a time, everything else sized and calculated again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from conveyor.models.sizing import within_limit
from conveyor.sizing.design_choice import DesignChoice, RollSize, TroughSize
from conveyor.sizing.part_sizing import size_parts
from conveyor.sizing.sized_design import Shortfall, SizedDesign
from conveyor.sizing.sizing_task import SizingTask

_Point: TypeAlias = tuple[float, "DesignChoice | None"]
_COVER_STEPS: Final = (0, 2, 4, 8)  # steps of the bottom cover


@dataclass(frozen=True, eq=False)
class VariedChoice:
    """One choice varied around a design.

    Attributes
    ----------
    name, kind : str
        Name and kind of quantity of the choice.
    values : tuple of float
        SI.
    designs : tuple of SizedDesign or str
        Design at each value, or the reason why there is none.
    at : float
        Value of the design.
    """

    name: str
    kind: str
    values: tuple[float, ...]
    designs: tuple[SizedDesign | str, ...]
    at: float


def vary_choices(task: SizingTask, design: SizedDesign) -> tuple[VariedChoice, ...]:
    """Vary the set spacings, roll diameter, speed and bottom cover of a design, one at a time.

    Parameters
    ----------
    task : SizingTask
        The duty.
    design : SizedDesign
        Base design; its carry sets are evenly spaced.

    Returns
    -------
    tuple of VariedChoice
        Belt class, motors and brake are sized at every point; points that violate a rule or check have no design.
    """
    base = replace(design.choice, graduated=())
    axes = list(_choice_axes(task, base, design.chosen.bottom))
    varied = list(dict.fromkeys(choice for *_, points in axes for _, choice in points if choice is not None))
    begin = [(choice, replace(design.chosen, settling=False), design.estimate) for choice in varied]
    made = size_parts(task, begin)
    system = task.duty.report.units
    answers = {
        choice: one.why.text(system) if isinstance(one, Shortfall) else one
        for choice, one in zip(varied, made, strict=True)
    }

    def point_value(kind: str, value: float, choice: DesignChoice | None) -> float:
        """Value of a point; a belt speed as gearboxes give it."""
        answer = None if choice is None or kind != "speed" else answers[choice]
        return answer.choice.speed if isinstance(answer, SizedDesign) else value

    return tuple(
        VariedChoice(
            name,
            kind,
            tuple(point_value(kind, value, choice) for value, choice in points),
            tuple(
                "keeps no rule of filling, speed or rolls" if choice is None else answers[choice]
                for _, choice in points
            ),
            at,
        )
        for name, kind, at, points in axes
    )


def _choice_axes(task: SizingTask, base: DesignChoice, bottom: float) -> Iterator[tuple[str, str, float, list[_Point]]]:
    """Name, kind, present value and points of each varied choice; None at points that a rule forbids."""
    carry, back = (
        [a for a in series if within_limit(a, widest)]
        for series, widest in zip(task.spacings, task.widest_spacings(base.trough), strict=True)
    )
    yield (
        "distance of carry sets",
        "spacing",
        base.carry,
        [(a, replace(base, carry=a)) for a in carry if a <= base.back],
    )
    yield (
        "distance of return sets",
        "spacing",
        base.back,
        [(a, replace(base, back=a)) for a in back if a >= base.carry],
    )
    rolls = _suitable_rolls(task, base, base.trough, base.speed)
    yield (
        "roll diameter", "size", base.roll.diameter, [(roll.diameter, replace(base, roll=roll)) for roll in rolls]
    )  # fmt: skip
    yield (
        "belt speed, each with the narrowest belt",
        "speed",
        base.speed,
        [(speed, _choice_at_speed(task, base, speed)) for speed in task.speeds],
    )
    more = [steps * task.cover_step for steps in _COVER_STEPS]
    thicker: list[_Point] = [(bottom + one, replace(base, thicker=base.thicker + one)) for one in more]
    yield "bottom cover", "size", bottom, thicker


def _choice_at_speed(task: SizingTask, base: DesignChoice, speed: float) -> DesignChoice | None:
    """Choice at another speed, with the narrowest belt within the rules and the smallest rolls."""
    alike = sorted((one for one in task.troughs if one.angle == base.trough.angle), key=lambda one: one.width.belt)
    fits = [(one, filling) for one in alike if (filling := task.filling(one, speed)) is not None]
    rolls = [
        roll
        for roll in (_suitable_rolls(task, base, fits[0][0], speed) if fits else ())
        if roll.diameter >= base.roll.diameter
    ]
    if not rolls:
        return None
    return replace(base, trough=fits[0][0], filling=fits[0][1], speed=speed, roll=rolls[0])


def _suitable_rolls(task: SizingTask, base: DesignChoice, trough: TroughSize, speed: float) -> list[RollSize]:
    """Rolls of the design's class that suit a trough at a speed."""
    return [one for one in task.rolls if one.cema_class == base.roll.cema_class and task.suits(one, trough, speed)]
