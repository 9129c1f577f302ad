"""From a duty to ranked designs: candidates screened by a closed estimate, the best calculated exactly.

Belt class, motors and brake of each follow from its own calculated tensions; those whose checks fail are no designs.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Final

import numpy as np

from conveyor.checks import checks, motor_power
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.laws.drives import next_preferred
from conveyor.line.stretches import STRANDS
from conveyor.line.task import CarcassClass, Choice, Chosen, SizingTask, spread
from conveyor.models import Conveyor
from conveyor.models.sizing import SizingDuty
from conveyor.pipeline import (
    Anchors,
    CalculatedConveyor,
    NoAnswer,
    Progress,
    Variant,
    calculate_many,
    take_up_of,
)
from conveyor.sizing.screen import Candidates, Levels, Screened, first_levels, screen
from conveyor.sizing.sized import SizedDesign, highest_tension
from conveyor.sizing.spacing import graduated_spacings
from conveyor.studies.costs import costs, parts_of, roll_life
from conveyor.studies.loads import EveryLoad
from conveyor.studies.states import at_one_take_up, load_states

RTOL: Final = 1e-4
"""Of the contacts, as in studies."""
CALCULATED: Final = 16
"""Candidates calculated at once, the best of the estimate."""
ALIKE: Final = 2
"""Of them of one width, speed and place of drives, so that the list shows what else could be built."""
GRADUATED: Final = 3
"""Designs whose carry sets are tried farther apart where the belt is tighter, if no more are wanted."""
BRAKE_RESERVE: Final = 1.3
"""Brake force, or torque of a backstop, over that which holds the loaded belt; general knowledge."""
_SIZINGS: Final = 5  # belt class, motors and brake against their own tensions
_SCREENINGS: Final = 2  # levels of the estimate against calculated candidates
_TOO_MUCH: Final = (
    "no candidate has a belt, motors, bearings and take-up that do among the series: allow further carcasses, drives, "
    "motors, closer sets (rules.carcasses, rules.drives, rules.motors_per_pulley, rules.take_up_travel, "
    "rules.carry_spacings), or split the conveyor"
)


@dataclass(frozen=True, eq=False)
class CalculatedSizing:
    """Ranked designs of a duty.

    Attributes
    ----------
    duty : SizingDuty
        What was sized.
    designs : tuple of SizedDesign
        The cheapest in a year first; every one calculated exactly.
    candidates, possible, calculated : int
        Combinations within the rules; those for which the series have parts; those calculated exactly.
    refused : Mapping
        Why calculated candidates are no designs, and how many.
    estimate_error : float
        Largest difference of the estimated cost of a year from the exact one, over it [-].
    """

    duty: SizingDuty
    designs: tuple[SizedDesign, ...]
    candidates: int
    possible: int
    calculated: int
    refused: Mapping[str, int]
    estimate_error: float

    def __repr__(self) -> str:
        count = f"{len(self.designs)} designs of {self.calculated} calculated, {self.candidates:,} candidates"
        return f'Sizing("{self.duty.name}": {count}; cheapest {self.best!r})'

    @cached_property
    def task(self) -> SizingTask:
        """The duty in SI."""
        return SizingTask(self.duty)

    @property
    def best(self) -> SizedDesign:
        """The cheapest one."""
        return self.designs[0]


def size(duty: SizingDuty, *, best: int = 3, progress: Progress | None = None) -> CalculatedSizing:
    """Size a conveyor from its duty.

    Parameters
    ----------
    duty : SizingDuty
        What is conveyed, and the rules.
    best : int
        Designs wanted.
    progress : callable, optional
        Called with what is done of all.

    Returns
    -------
    CalculatedSizing
        Designs by rank, and what the others failed.

    Raises
    ------
    NoSolutionError
        No candidate keeps the rules; the message says which rule leaves none.
    """
    task = SizingTask(duty)
    choices = Candidates.of(task)
    if not len(choices):
        task.fits()
        raise NoSolutionError(
            "no belt width and speed keep the rules of lumps, filling, edge distance and roll speed: allow wider belts "
            "(rules.widths), other speeds (rules.speeds, rules.fastest, rules.roll_rotation) fillings or troughs"
        )
    candidates, choices, levels = len(choices), choices.taken_up(), first_levels(len(duty.covers))
    estimate = screen(task, choices, levels)
    probes = _shortlist(task, choices, estimate, 2 * len(duty.covers), covers=True)
    if not probes:
        raise NoSolutionError(_TOO_MUCH)
    anchors: Anchors = []
    first = _first(task, choices, estimate, probes, anchors)
    levels = _levels(choices, estimate, probes, first, levels)
    sized: dict[int, SizedDesign | str] = {}
    for _ in range(_SCREENINGS):
        estimate = screen(task, choices, levels)
        new = [i for i in _shortlist(task, choices, estimate, CALCULATED) if i not in sized]
        if progress is not None:
            progress(len(sized), len(sized) + len(new))
        sized |= zip(new, _designs(task, choices, estimate, new, anchors), strict=True)
        made = {i: one for i, one in sized.items() if isinstance(one, SizedDesign)}
        levels = _levels(choices, estimate, list(made), [one.found for one in made.values()], levels)
    if not sized:
        raise NoSolutionError(_TOO_MUCH)
    reasons = Counter(one for one in sized.values() if isinstance(one, str))
    final = _final(task, made.values(), best, anchors, reasons)
    if not final:
        told = "; ".join(f"{count} times: {why}" for why, count in reasons.most_common(3))
        raise NoSolutionError(f"no candidate of {len(sized)} calculated keeps every check: {told}")
    return CalculatedSizing(
        duty,
        tuple(final[:best]),
        candidates,
        int(np.isfinite(estimate.year).sum()),
        len(sized),
        reasons,
        max(abs(one.estimate / one.year - 1.0) for one in [*made.values(), *final]),
    )


def _final(
    task: SizingTask,
    designs: Iterable[SizedDesign],
    best: int,
    anchors: Anchors,
    reasons: Counter[str],
) -> list[SizedDesign]:
    """Designs sized for every load, by rank; further loads never make one cheaper, so that no other can be better."""
    ranked = sorted(designs, key=_year)
    if task.rules.graduated and len(task.sections) > 1:
        first = max(best, GRADUATED)
        ranked = sorted([*ranked, *_graduated(task, ranked[:first], anchors)], key=_year)
    final: list[SizedDesign] = []
    while ranked and (len(final) < best or ranked[0].year < final[best - 1].year):
        batch, ranked = ranked[: max(1, best - len(final))], ranked[max(1, best - len(final)) :]
        begin = [(design.choice, _foreseen(task, design), design.estimate) for design in batch]
        for one in settled(task, begin, anchors, every_load=True, made=batch):
            if isinstance(one, SizedDesign):
                final.append(one)
            else:
                reasons[one] += 1
        cheapest_last = sorted(final, key=_year, reverse=True)
        final = sorted({replace(one.choice, graduated=()): one for one in cheapest_last}.values(), key=_year)
    return final


def _year(design: SizedDesign) -> float:
    return design.year


def _shortlist(
    task: SizingTask, choices: Candidates, estimate: Screened, most: int, *, covers: bool = False
) -> list[int]:
    """Candidates of the lowest estimated cost, not too many alike; with `covers` as many of each cover."""
    taken: Counter[object] = Counter()
    chosen: list[int] = []
    for i in np.argsort(estimate.year, kind="stable").tolist():
        if not math.isfinite(estimate.year[i]) or len(chosen) == most:
            break
        choice = choices[i]
        key: object = (choice.trough.width, choice.speed, choice.drives) if not covers else choice.cover
        limit = ALIKE if not covers else max(1, most // len(task.duty.covers))
        if taken[key] < limit:
            taken[key] += 1
            chosen.append(i)
    return chosen


def _first(
    task: SizingTask, choices: Candidates, estimate: Screened, chosen: Sequence[int], anchors: Anchors
) -> list[CalculatedConveyor | None]:
    """Calculations of candidates as the estimate chose them, to set its levels; None without an answer."""
    specs = [task.spec(choices[i], _estimated(task, choices[i], estimate, i), "probe") for i in chosen]
    return [
        one if isinstance(one, CalculatedConveyor) else None
        for one in calculate_many([Variant(spec) for spec in specs], RTOL, anchors=anchors)
    ]


def _levels(
    choices: Candidates, estimate: Screened, chosen: Sequence[int],
    results: Iterable[CalculatedConveyor | None], levels: Levels,
) -> Levels:  # fmt: skip
    """Levels at which the estimate meets calculations in the middle."""
    over: dict[object, list[float]] = {}
    for i, one in zip(chosen, results, strict=True):
        if one is None:
            continue
        main = {force.key: force for force in one.balance.along}
        cover, forces = choices[i].cover, one.balance.forces
        for k, strand in enumerate(STRANDS):
            exact = main["indentation"].by_strand()[strand]
            over.setdefault((strand, cover), []).append(exact / estimate.indentation[i, k])
        over.setdefault("drag", []).append(main["idler_rotation"].total / estimate.rolls[i])
        over.setdefault("rest", []).append((forces.secondary + forces.special) / estimate.rest[i])

    def middle(key: object) -> float:
        return float(np.median(over[key])) if key in over else 1.0

    carry, back = ([k * middle((strand, i)) for i, k in enumerate(of)] for strand, of in
                   zip(STRANDS, (levels.carry, levels.back), strict=True))  # fmt: skip
    drag = middle("drag") if "drag" in over else levels.drag
    return Levels(tuple(carry), tuple(back), drag, levels.rest * middle("rest"))


def _estimated(task: SizingTask, choice: Choice, estimate: Screened, i: int) -> Chosen:
    """Class and motors as the estimate has them."""
    carcass = task.carcasses[choice.kind][int(estimate.carcass[i])]
    power = abs(float(estimate.force[i])) * choice.speed / task.efficiency
    motors = tuple(map(task.motors, spread(power, choice.drives)))
    return Chosen(carcass, *task.covers(choice, carcass), motors, 0.0)


def _designs(
    task: SizingTask,
    choices: Candidates,
    estimate: Screened,
    chosen: Sequence[int],
    anchors: Anchors,
) -> list[SizedDesign | str]:
    """Candidates calculated exactly."""
    begin = [(choices[i], _estimated(task, choices[i], estimate, i), float(estimate.year[i])) for i in chosen]
    return settled(task, begin, anchors)


def settled(
    task: SizingTask,
    begin: Sequence[tuple[Choice, Chosen, float]],
    anchors: Anchors,
    *,
    every_load: bool = False,
    made: Sequence[SizedDesign] = (),
) -> list[SizedDesign | str]:
    """Designs whose class, motors and brake suit their own calculated tensions, or why there is none.

    Parameters
    ----------
    task : SizingTask
        The duty.
    begin : sequence of (Choice, Chosen, float)
        Candidates, class and motors to begin with, cost of a year by the estimate.
    anchors : list
        Of the compounds, from calculations before; what is new is added.
    every_load : bool
        Whether empty, inclines only, declines only and the worst loadings count, too, not the full belt alone; then
        also at the temperature of the duty, where less friction relieves a brake.
    made : sequence of SizedDesign
        The same candidates as designs for the full belt: what is calculated of them is not calculated again.
    """
    now = {i: chosen for i, (_, chosen, _) in enumerate(begin)}
    designs: dict[int, SizedDesign | str] = {}
    sized: dict[int, tuple[Chosen, Conveyor, tuple[CalculatedConveyor, ...]]] = {}
    mild: dict[int, CalculatedConveyor] = {}
    for _ in range(_SIZINGS):
        specs, refused = _specs(task, {i: (begin[i][0], chosen) for i, chosen in now.items()})
        designs |= refused
        coldest = {i: task.colder(spec) if task.cold else spec for i, spec in specs.items()}
        alike = {i: made[i] for i in specs if made and now[i] == made[i].chosen}
        cold = _calculated(coldest, anchors, {i: one.coldest for i, one in alike.items()})
        warm = dict[int, CalculatedConveyor | NoAnswer]()
        if every_load and task.cold:
            warm = _calculated(specs, anchors, {i: one.found for i, one in alike.items()})
        again = {}
        for i, answer in cold.items():
            try:
                loads = _loads(answer, every_load=every_load)
                if i in warm:
                    mild[i], *others = _loads(warm[i], every_load=True)
                    loads += (mild[i], *others)
                wanted = _chosen(task, begin[i][0], now[i], loads)
            except (NoSolutionError, RangeError, InputError) as error:
                designs[i] = str(error)
                continue
            if replace(wanted, settling=now[i].settling) == now[i]:
                sized[i] = now[i], specs[i], loads
            else:
                again[i] = wanted
        now = again
        if not now:
            break
    held = {
        i: made[i].found for i, (chosen, _, _) in sized.items() if made and chosen == made[i].chosen
    } | mild
    left = {i: spec for i, (_, spec, _) in sized.items() if task.cold}
    found = _calculated(left, anchors, {i: one for i, one in held.items() if i in left})
    for i, (chosen, _, loads) in sized.items():
        answer = found.get(i, loads[0])
        designs[i] = (
            _design(task, begin[i], chosen, answer, loads)
            if isinstance(answer, CalculatedConveyor)
            else str(answer)
        )
    return [designs.get(i, "belt class and motors do not settle") for i in range(len(begin))]


def _specs(
    task: SizingTask, now: Mapping[int, tuple[Choice, Chosen]]
) -> tuple[dict[int, Conveyor], dict[int, str]]:
    """Specs of candidates as they are chosen now, and why others have none."""
    specs, refused = dict[int, Conveyor](), dict[int, str]()
    for i, (choice, chosen) in now.items():
        try:
            specs[i] = task.spec(choice, chosen, task.duty.name)
        except InputError as error:
            refused[i] = str(error)
    return specs, refused


def _calculated(
    specs: Mapping[int, Conveyor], anchors: Anchors, known: Mapping[int, CalculatedConveyor]
) -> dict[int, CalculatedConveyor | NoAnswer]:
    """Calculations of specs, those that are not known side by side."""
    new = {i: Variant(spec) for i, spec in specs.items() if i not in known}
    return {**known, **dict(zip(new, calculate_many(list(new.values()), RTOL, anchors=anchors), strict=True))}


def _loads(answer: CalculatedConveyor | NoAnswer, *, every_load: bool) -> tuple[CalculatedConveyor, ...]:
    """The full belt, and every other load at one take-up where they count.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        It has no answer.
    """
    if not isinstance(answer, CalculatedConveyor):
        raise answer
    if not every_load:
        return (answer,)
    return EveryLoad(*at_one_take_up(load_states(answer.conveyor, answer), None)).designing


def _chosen(task: SizingTask, choice: Choice, before: Chosen, pair: Sequence[CalculatedConveyor]) -> Chosen:
    """What calculated tensions ask for; after the first time no weaker class is taken, so that sizing ends.

    Raises
    ------
    NoSolutionError
        No class of the belt is strong enough, or no motor large enough.
    """
    tension = highest_tension(pair)
    carcass = next(
        (one for one in task.carcasses[choice.kind] if _needed(one, choice, tension) <= one.strength), None
    )
    if carcass is None:
        raise NoSolutionError("no class of the belt is strong enough (rules.carcasses)")
    if before.settling and carcass.strength < before.carcass.strength:
        carcass = before.carcass
    powers = [_powers(one) for one in pair]
    needed = [max(each) for each in zip(*powers, strict=True)]
    most = max(needed)
    if most * task.rules.motor_reserve > task.largest_drive:
        raise NoSolutionError(
            "no motor is large enough for its drive (rules.largest_motor, rules.motors_per_pulley)"
        )
    motor = task.motors(most)
    brake = max((0.0 if one.motions.rolls_back else one.motions.brake_to_hold) for one in pair)
    brake = 0.0 if brake <= 0.0 else max(before.brake, BRAKE_RESERVE * brake)
    if before.brake > 0.0 and brake <= before.brake * (1.0 + RTOL):
        brake = before.brake
    held = max((one.motions.brake_to_hold if one.motions.rolls_back else 0.0) for one in pair)
    torque = BRAKE_RESERVE * held * 0.5 * task.drive_diameter(carcass)
    backstop = max(before.backstop, next_preferred(torque)) if torque > 0.0 else 0.0
    return Chosen(
        carcass, *task.covers(choice, carcass), (motor,) * len(needed), brake, backstop, settling=True
    )


def _foreseen(task: SizingTask, design: SizedDesign) -> Chosen:
    """Class and motors that the worst loading is likely to ask for, so that calculating the loads once mostly does.

    Bulk is left out where the belt alone pulls harder; its friction is taken in proportion to the load.
    """
    one, chosen = design.coldest, design.chosen
    steady = one.balance.forces.total
    if steady <= 0.0:
        return chosen
    more = 0.0
    for of in one.stretches[: one.line.count]:
        bulk = of.stretch.bulk_mass / of.stretch.line_mass
        more += max(0.0, -bulk * (of.total - of.forces["idler_rotation"]))
    motor = task.motors(
        min(max(_powers(one)) * (1.0 + more / steady), task.largest_drive / task.rules.motor_reserve)
    )
    needed = partial(_needed, choice=design.choice, tension=highest_tension([one]) + more)
    carcass = next(
        (each for each in task.carcasses[design.choice.kind] if needed(each) <= each.strength), chosen.carcass
    )
    covers, motors = task.covers(design.choice, carcass), (motor,) * len(chosen.motors)
    return Chosen(carcass, *covers, motors, chosen.brake, chosen.backstop, settling=False)


def _needed(carcass: CarcassClass, choice: Choice, tension: float) -> float:
    """Strength that a tension asks of a class [N/m]."""
    return carcass.safety * tension / choice.trough.width.belt


def _powers(one: CalculatedConveyor) -> list[float]:
    """Highest power of every drive, with the friction at both ends of its band [W]."""
    return [check.calculated or 0.0 for check in motor_power(one)]


def _design(
    task: SizingTask,
    begin: tuple[Choice, Chosen, float],
    chosen: Chosen,
    result: CalculatedConveyor,
    loads: Sequence[CalculatedConveyor],
) -> SizedDesign | str:
    """The design, or what fails in it."""
    failed = next(_failed(task, (result, *loads)), None)
    if failed is not None:
        return failed
    choice, _, estimate = begin
    energy = 0.0 if result.year is None or result.year.cost is None else result.year.cost
    parts = parts_of(result)
    if parts is None:
        raise AssertionError("a sized spec lists its parts")
    cost = costs(parts, task.duty.prices.amounts, seconds=task.seconds, energy=energy)
    return SizedDesign(choice, chosen, result, loads[0], cost, estimate, roll_life(result))


def _failed(task: SizingTask, pair: Sequence[CalculatedConveyor]) -> Iterator[str]:
    """Criteria that fail in either; of penetration and rubber data the report warns."""
    for one in pair:
        for check in checks(one, contacts=False):
            if check.failed:
                yield check.subject.text("SI")
        if roll_life(one) < task.roll_life:
            yield "L10 life of a roll set (rules.roll_life)"
    travel = take_up_of(pair).travel
    if travel is not None and travel.whole > task.take_up_travel:
        yield "travel of the take-up (rules.take_up_travel)"


def _graduated(task: SizingTask, designs: Sequence[SizedDesign], anchors: Anchors) -> list[SizedDesign]:
    """The same with carry sets as far apart in each section as is cheapest there, where that saves."""
    tried = [
        (design, replace(design.choice, graduated=one))
        for design in designs
        for one in dict.fromkeys(graduated_spacings(task, design))
        if len(set(one)) > 1
    ]
    made = settled(task, [(choice, even.chosen, even.estimate) for even, choice in tried], anchors)
    return [
        new
        for (even, _), new in zip(tried, made, strict=True)
        if isinstance(new, SizedDesign) and new.year < even.year
    ]
