"""The choices of a design varied one at a time, everything else sized and calculated again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from conveyor.models.sizing import within_limit
from conveyor.sizing.design_choice import DesignChoice, TroughSize
from conveyor.sizing.part_sizing import foresee_parts, size_parts
from conveyor.sizing.sized_design import Shortfall, SizedDesign
from conveyor.sizing.sizing_task import SizingTask

Neighbours: TypeAlias = Mapping[DesignChoice, SizedDesign | Shortfall]
"""Choices that differ from a design in one value, with their design or why there is none."""
_Point: TypeAlias = tuple[float, "DesignChoice | None"]
_COVER_STEPS: Final = (0, 2, 4, 8)  # steps of the bottom cover
_BREAKS_RULES: Final = "keeps no rule of filling, speed or rolls"
_ONLY_BRAKES: Final = "costs less, but a cover thicker than its wear asks for only brakes the belt"


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
    every_load : tuple of bool
        Whether the design is calculated and checked in every load; else with the full belt, dearer than the best.
    at : float
        Value of the design.
    """

    name: str
    kind: str
    values: tuple[float, ...]
    designs: tuple[SizedDesign | str, ...]
    every_load: tuple[bool, ...]
    at: float


def size_neighbours(task: SizingTask, design: SizedDesign) -> Neighbours:
    """Size every choice that differs from a design in one value, for the full belt.

    Parameters
    ----------
    task : SizingTask
        The duty.
    design : SizedDesign
        Base design; its carry sets are evenly spaced.

    Returns
    -------
    mapping of DesignChoice to SizedDesign or Shortfall
        Belt class, motors and brake are sized for each; the base with evenly spaced sets is one of them.
    """
    varied = _varied_choices(_choice_axes(task, replace(design.choice, graduated=()), design.chosen.bottom))
    parts = replace(design.chosen, settling=False, backstop=0.0, take_up=0.0)
    made = size_parts(task, [(choice, parts, design.estimate) for choice in varied])
    return dict(zip(varied, made, strict=True))


def vary_choices(
    task: SizingTask, design: SizedDesign, neighbours: Neighbours | None = None
) -> tuple[VariedChoice, ...]:
    """Vary the set spacings, roll diameter, speed and bottom cover of a design, one at a time.

    Parameters
    ----------
    task : SizingTask
        The duty.
    design : SizedDesign
        Base design; its carry sets are evenly spaced.
    neighbours : mapping of DesignChoice to SizedDesign or Shortfall, optional
        What `size_neighbours` gave for it; sized here without.

    Returns
    -------
    tuple of VariedChoice
        Belt class, motors and brake are sized at every point; points that violate a rule or check have no design.

    Notes
    -----
    The points beside the design, and all that cost less than it with the full belt, are calculated in every load. A
    further load only adds cost, so the others stay dearer.
    """
    base = replace(design.choice, graduated=())
    axes = list(_choice_axes(task, base, design.chosen.bottom))
    full = size_neighbours(task, design) if neighbours is None else neighbours
    judged = _in_every_load(task, design, full, axes)
    system = task.duty.report.units

    def told(choice: DesignChoice | None) -> SizedDesign | str:
        """Design of a point, or the reason why there is none."""
        if choice is None:
            return _BREAKS_RULES
        one = judged.get(choice, full[choice])
        if isinstance(one, Shortfall):
            return one.why.text(system)
        return _ONLY_BRAKES if choice.thicker > base.thicker and one.year < design.year else one

    def point_value(kind: str, value: float, choice: DesignChoice | None) -> float:
        """Value of a point; a belt speed as gearboxes give it."""
        answer = None if choice is None or kind != "speed" else judged.get(choice, full[choice])
        return answer.choice.speed if isinstance(answer, SizedDesign) else value

    return tuple(
        VariedChoice(
            name,
            kind,
            tuple(point_value(kind, value, choice) for value, choice in points),
            tuple(told(choice) for _, choice in points),
            tuple(choice in judged for _, choice in points),
            at,
        )
        for name, kind, at, points in axes
    )


def _in_every_load(
    task: SizingTask, design: SizedDesign, full: Neighbours, axes: Sequence[tuple[str, str, float, list[_Point]]]
) -> Neighbours:
    """Designs of the full belt that stand beside the base or cost less, sized for every load."""
    base = replace(design.choice, graduated=())
    beside = {base}
    for *_, value, points in axes:
        at = min(range(len(points)), key=lambda i: abs(points[i][0] - value))
        beside |= {choice for _, choice in points[max(0, at - 1) : at + 2] if choice is not None}
    asked = [
        (choice, one)
        for choice, one in full.items()
        if isinstance(one, SizedDesign) and (choice in beside or one.year < design.year) and choice != design.choice
    ]
    made = size_parts(
        task,
        [(choice, foresee_parts(task, one), one.estimate) for choice, one in asked],
        every_load=True,
        made=[one for _, one in asked],
    )
    return {design.choice: design} | dict(zip((choice for choice, _ in asked), made, strict=True))


def _varied_choices(axes: Iterable[tuple[str, str, float, list[_Point]]]) -> list[DesignChoice]:
    """Choices of all points, each once."""
    return list(dict.fromkeys(choice for *_, points in axes for _, choice in points if choice is not None))


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
    same = next(
        one for one in task.troughs if _same_angle(one, base.trough) and one.width.belt == base.trough.width.belt
    )
    rolls = _choices_on(task, base, same, base.speed)
    yield "roll diameter", "size", base.roll.diameter, [(one.roll.diameter, one) for one in rolls]
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
    for trough in sorted(
        (one for one in task.troughs if _same_angle(one, base.trough)), key=lambda one: one.width.belt
    ):
        if task.filling(trough, speed) is not None:
            fits = _choices_on(task, base, trough, speed)
            return next((one for one in fits if one.roll.diameter >= base.roll.diameter), None)
    return None


def _same_angle(trough: TroughSize, other: TroughSize) -> bool:
    """True if two troughs have the same angle."""
    return trough.angle == other.angle


def _choices_on(task: SizingTask, base: DesignChoice, trough: TroughSize, speed: float) -> list[DesignChoice]:
    """Choices with a trough of the series at a speed, on all rolls of the design's class that suit."""
    return [
        replace(base, trough=on, filling=filling, speed=speed, roll=roll)
        for roll in task.rolls
        if roll.cema_class == base.roll.cema_class and (on := task.trough_on(roll, trough)) is not None
        if (filling := task.filling(on, speed)) is not None and task.suits(roll, on, speed)
    ]
