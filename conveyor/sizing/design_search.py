"""Ranked designs from a duty: candidates screened by a closed estimate, the best calculated exactly.

Belt class, motors and brake of each follow from its own calculated tensions; candidates that fail a check are rejected.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.checks import run_checks
from conveyor.checks.drive_checks import motor_power
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.laws.belt_strength import RATED_START
from conveyor.laws.drives import next_preferred_number
from conveyor.laws.take_up import TRAVEL_RESERVE
from conveyor.line.stretches import STRANDS
from conveyor.models import Conveyor
from conveyor.models.sizing import SizingDuty
from conveyor.pipeline import (
    CalculatedConveyor,
    KnownTestFactors,
    NoAnswer,
    ProgressCallback,
    Variant,
    calculate_many,
    common_take_up_duty,
)
from conveyor.sizing.screen import (
    Candidates,
    EstimateCalibration,
    Estimates,
    Limit,
    first_calibration,
    screen_candidates,
)
from conveyor.sizing.sized_design import Shortfall, SizedDesign, highest_tension
from conveyor.sizing.sizing_task import CarcassClass, DesignChoice, SelectedParts, SizingTask, drive_powers
from conveyor.sizing.spacing import graduated_spacings
from conveyor.studies.costs import conveyor_costs, conveyor_parts, roll_life
from conveyor.studies.loads import EveryLoad
from conveyor.studies.states import at_one_take_up, load_states
from conveyor.units.sentences import Message, escape_braces, format_figure, message

RTOL: Final = 1e-4
"""Of the contacts, as in studies."""
CANDIDATES_AT_ONCE: Final = 16
"""Candidates calculated at once, the best by the estimate."""
MOST_ALIKE: Final = 2
"""Most of them with the same width, speed and drive layout, so that the list shows alternatives."""
GRADUATED_DESIGNS: Final = 3
"""Designs tried with graduated carry spacings, at least."""
BRAKE_RESERVE: Final = 1.3
"""Brake force, or torque of a backstop, over that to hold the loaded belt; general knowledge."""
_SIZINGS: Final = 8  # rounds of belt class, motors and brake against their own tensions
_SCREENINGS: Final = 2  # calibrations of the estimate by calculated candidates
_DRAWS: Final = 20  # of further candidates while designs are missing
_NEAR_LIMIT: Final = 1.1  # estimated use of a limit up to which candidates are calculated if there is no design
_ALIKE_DRAWS: Final = (
    4  # draws in a row without a design, a failed series limit or progress, after which the search ends
)
_NEARER_BY: Final = 0.9  # factor on the nearest shortfall below which a draw counts as progress
_REFUSAL_PROBES: Final = 4  # candidates calculated if the estimate has none near a limit
TAKE_UP_STEP: Final = 500.0
"""Step of a take-up tension that keeps the belt taut beyond the least for grip and sag [N]."""
_LIMIT_MESSAGES: Final[Mapping[Limit, str]] = {
    "belt strength": "its tension asks for a belt of {}, the strongest of the series has {}: allow further drives or "
    "carcasses (rules.drives, rules.carcasses), or split the conveyor",
    "motor power": "a drive pulley needs motors of {}, one may have {}: allow further or larger motors, or further "
    "pulleys (rules.motors_per_pulley, rules.largest_motor, rules.drives), or split the conveyor",
    "take-up travel": "its take-up needs {} of travel, {} are allowed: allow a longer one or steel cord "
    "(rules.take_up_travel, rules.carcasses)",
    "bearings": "the bearings of its idler sets reach an L10 of {}, {} are asked: allow closer sets or a shorter life "
    "(rules.carry_spacings, rules.return_spacings, rules.roll_life)",
    "set rating": "its idler sets bear {}, their class is rated for {}: allow closer sets (rules.carry_spacings)",
}
"""Message of each limit, with the remedy."""
_CURES: Final = {
    "bulk_slip_start": "a softer start (rules.start_factor) or less slope",
    "bulk_slip_stopping": "less slope or a longer conveyor",
    "bulk_slip": "less slope",
    "curve_radius": "a larger radius on the route",
}
"""Remedies in the duty for checks that no choice of parts can meet, by key."""


@dataclass(frozen=True, eq=False)
class CalculatedSizing:
    """Ranked designs of a duty.

    Attributes
    ----------
    duty : SizingDuty
        The duty.
    designs : tuple of SizedDesign
        The lowest yearly cost first; all calculated exactly.
    candidates, possible, calculated : int
        Combinations within the rules; those for which the series have parts; those calculated exactly.
    refused : Mapping
        Reasons why calculated candidates were rejected, with their number.
    estimate_error : float
        Largest relative error of the estimated yearly cost [-].
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
        """The cheapest design."""
        return self.designs[0]


def size_conveyor(duty: SizingDuty, *, best: int = 3, progress: ProgressCallback | None = None) -> CalculatedSizing:
    """Size a conveyor from its duty.

    Parameters
    ----------
    duty : SizingDuty
        The duty and its rules.
    best : int
        Designs wanted.
    progress : callable, optional
        Called with the candidates calculated and their total.

    Returns
    -------
    CalculatedSizing
        Designs by rank, and the failures of the others.

    Raises
    ------
    NoSolutionError
        No candidate keeps the rules; the message gives the limit of the nearest one, with figures and the remedy.
    """
    task = SizingTask(duty)
    every = Candidates.of(task)
    if not len(every):
        task.refuse()
    choices = every.within_travel()
    if not len(choices):
        raise _stretch_refusal(task)
    search = _Search(task, choices, first_calibration(len(duty.covers)))
    search.begin()
    final: list[SizedDesign] = []
    for _ in range(_SCREENINGS):
        new = search.draw(CANDIDATES_AT_ONCE)
        search.calculate(new, progress)
    ranked, alike = list(search.designs), 0
    for _ in range(_DRAWS):
        final = _rank_designs([*final, *_final_designs(search, ranked, best - len(final))])
        if len(final) >= best:
            break
        new = search.draw(CANDIDATES_AT_ONCE + len(list(search.designs))) or search.nearest(CANDIDATES_AT_ONCE)
        nearest = search.nearest_over
        if not new:
            break
        ranked = search.calculate(new, progress)
        fails = {one.rule for i in new if isinstance(one := search.answers[i], Shortfall)}
        if ranked or fails & set(_LIMIT_MESSAGES) or search.nearest_over < _NEARER_BY * nearest:
            alike = 0
        elif (alike := alike + 1) == _ALIKE_DRAWS:
            break
    if not final:
        raise search.refusal(len(every))
    return CalculatedSizing(
        duty,
        tuple(final[:best]),
        len(every),
        int(np.isfinite(search.estimate.year).sum()),
        len(search.answers),
        search.reasons,
        max(abs(one.estimate / one.year - 1.0) for one in [*search.designs, *final]),
    )


def _stretch_refusal(task: SizingTask) -> NoSolutionError:
    """Error that the lasting stretch of every carcass exceeds the take-up's travel."""
    least = min(task.lasting_strain(kind) for kind in task.kinds) * task.length
    reserve = 1.0 + TRAVEL_RESERVE.value
    kinds, system = " and ".join(task.kinds), task.duty.report.units
    needed, allowed = (format_figure(x, "length", system) for x in (least * reserve, task.take_up_travel))
    cure = "" if "steel cord" in task.kinds else ", or steel cord (rules.carcasses)"
    return NoSolutionError(
        f"the lasting stretch of {kinds} belts alone asks for {needed} of the take-up's travel, {allowed} are allowed: "
        f"a longer one (rules.take_up_travel){cure}"
    )


class _Search:
    """Candidates of a duty, their estimates, and those calculated so far."""

    def __init__(self, task: SizingTask, choices: Candidates, levels: EstimateCalibration) -> None:
        self.task, self.choices, self.levels = task, choices, levels
        self.estimate = screen_candidates(task, choices, levels)
        self.answers: dict[int, SizedDesign | Shortfall] = {}
        """Results of candidates under the full belt; the failure of those that fail under another load."""
        self.anchors: KnownTestFactors = []
        self.reasons: Counter[str] = Counter()

    @property
    def designs(self) -> Iterator[SizedDesign]:
        """Designs so far, not rejected under another load."""
        return (one for one in self.answers.values() if isinstance(one, SizedDesign))

    @property
    def short(self) -> Iterator[tuple[int, Shortfall]]:
        """Rejected candidates with their shortfalls."""
        return ((i, one) for i, one in self.answers.items() if isinstance(one, Shortfall))

    @property
    def nearest_over(self) -> float:
        """Smallest shortfall of the rejected candidates, needed over allowed [-]; infinite without a figure."""
        return min((one.over for _, one in self.short), default=math.inf)

    def begin(self) -> None:
        """Calibrate the estimate by a few candidates."""
        task = self.task
        count = 2 * len(task.duty.covers)
        probes = _shortlist_candidates(task, self.choices, self.estimate.year, count, covers=True)
        if not probes:
            probes = _shortlist_candidates(task, self.choices, self.estimate.largest_use, count, covers=True)
        first = _first_calculations(task, self.choices, self.estimate, probes, self.anchors)
        self._levelled(first, {})

    def draw(self, most: int) -> list[int]:
        """Uncalculated ones of the `most` candidates that are cheapest by the estimate."""
        year = self.estimate.year.copy()
        year[[i for i, _ in self.short]] = np.inf
        listed = _shortlist_candidates(self.task, self.choices, year, most)
        return [i for i in listed if i not in self.answers]

    def nearest(self, most: int) -> list[int]:
        """Candidates beyond a limit by no more than the error of the estimate, the nearest first.

        If none is calculated yet, the nearest of all, so that a refusal has exact figures.
        """
        over = self.estimate.largest_use.copy()
        over[list(self.answers)] = np.inf
        if self.answers:
            over[over > _NEAR_LIMIT] = np.inf
        return _shortlist_candidates(self.task, self.choices, over, most if self.answers else _REFUSAL_PROBES)

    def calculate(self, new: Sequence[int], progress: ProgressCallback | None) -> list[SizedDesign]:
        """Calculate candidates, recalibrate the estimate, and return the designs among them."""
        if progress is not None:
            progress(len(self.answers), len(self.answers) + len(new))
        found = _calculate_candidates(self.task, self.choices, self.estimate, new, self.anchors)
        self.answers |= zip(new, found, strict=True)
        self.reasons.update(one.rule for one in found if isinstance(one, Shortfall))
        made = {i: one.found for i, one in self.answers.items() if isinstance(one, SizedDesign)}
        self._levelled(made, {i: one.uses for i, one in self.answers.items()})
        return [one for one in found if isinstance(one, SizedDesign)]

    def failed(self, design: SizedDesign, why: Shortfall) -> None:
        """Reject a design that fails under another load."""
        self.reasons[why.rule] += 1
        for i, one in self.answers.items():
            if one is design:
                self.answers[i] = why

    def _levelled(
        self,
        calculated: Mapping[int, CalculatedConveyor],
        uses: Mapping[int, Mapping[Limit, float]],
    ) -> None:
        self.levels = _calibrate_estimate(self.choices, self.estimate, self.levels, calculated, uses)
        self.estimate = screen_candidates(self.task, self.choices, self.levels)

    def refusal(self, combinations: int) -> NoSolutionError:
        """Error that there is no design, with the shortfall of the nearest candidate."""
        i, nearest = min(self.short, key=lambda of: of[1].over)
        choice, system = self.choices[i], self.task.duty.report.units
        width, speed = choice.trough.width.belt, choice.speed
        counted = "; ".join(f"{count} times: {rule}" for rule, count in self.reasons.most_common(3))
        words = (
            f"none of {combinations:,} combinations is a design. The nearest ({{}}, {{}}, {choice.kind}; drives: "
            f"{choice.drives}): {nearest.why.words}. Of {len(self.answers)} calculated {counted}"
        )
        figures = ((width, "thickness"), (speed, "speed"), *nearest.why.figures)
        return NoSolutionError(Message(words, figures).text(system))


def _final_designs(search: _Search, designs: Iterable[SizedDesign], best: int) -> list[SizedDesign]:
    """Designs sized for every load, by rank; further loads never make a design cheaper, so no other can be better."""
    task, anchors = search.task, search.anchors
    ranked = sorted(designs, key=_yearly_cost)
    if task.rules.graduated and len(task.sections) > 1:
        first = max(best, GRADUATED_DESIGNS)
        ranked = sorted([*ranked, *_graduated_designs(task, ranked[:first], anchors)], key=_yearly_cost)
    final: list[SizedDesign] = []
    while ranked and (len(final) < best or ranked[0].year < final[best - 1].year):
        batch, ranked = ranked[: max(1, best - len(final))], ranked[max(1, best - len(final)) :]
        begin = [(design.choice, _foresee_parts(task, design), design.estimate) for design in batch]
        made = size_parts(task, begin, anchors, every_load=True, made=batch)
        for design, one in zip(batch, made, strict=True):
            if isinstance(one, SizedDesign):
                final.append(one)
            else:
                search.failed(design, one)
        final = _rank_designs(final)
    return final


def _rank_designs(designs: Iterable[SizedDesign]) -> list[SizedDesign]:
    """Designs by yearly cost, only the cheapest of those that differ in graduated spacings alone."""
    cheapest_last = sorted(designs, key=_yearly_cost, reverse=True)
    return sorted({replace(one.choice, graduated=()): one for one in cheapest_last}.values(), key=_yearly_cost)


def _yearly_cost(design: SizedDesign) -> float:
    return design.year


def _shortlist_candidates(
    task: SizingTask, choices: Candidates, order: NDArray[np.float64], most: int, *, covers: bool = False
) -> list[int]:
    """Candidates with the lowest finite figures, not too many alike; with `covers` equally many of each cover."""
    taken: Counter[object] = Counter()
    chosen: list[int] = []
    for i in np.argsort(order, kind="stable").tolist():
        if not math.isfinite(order[i]) or len(chosen) == most:
            break
        choice = choices[i]
        key: object = (choice.trough.width, choice.speed, choice.drives) if not covers else choice.cover
        limit = MOST_ALIKE if not covers else max(1, most // len(task.duty.covers))
        if taken[key] < limit:
            taken[key] += 1
            chosen.append(i)
    return chosen


def _first_calculations(
    task: SizingTask,
    choices: Candidates,
    estimate: Estimates,
    chosen: Sequence[int],
    anchors: KnownTestFactors,
) -> dict[int, CalculatedConveyor]:
    """Calculated candidates with estimated parts, to calibrate the estimate; only those with an answer."""
    specs, _ = _candidate_specs(
        task, {i: (choices[i], _estimated_parts(task, choices[i], estimate, i)) for i in chosen}
    )
    found = _calculate_specs(specs, anchors, {})
    return {i: one for i, one in found.items() if isinstance(one, CalculatedConveyor)}


def _calibrate_estimate(
    choices: Candidates, estimate: Estimates, levels: EstimateCalibration,
    calculated: Mapping[int, CalculatedConveyor], uses: Mapping[int, Mapping[Limit, float]],
) -> EstimateCalibration:  # fmt: skip
    """Calibration at which the estimate agrees with the median of the calculations."""
    over: dict[object, list[float]] = {}
    for i, one in calculated.items():
        main = {force.key: force for force in one.balance.along}
        cover, forces = choices[i].cover, one.balance.forces
        for k, strand in enumerate(STRANDS):
            exact = main["indentation"].by_strand()[strand]
            over.setdefault((strand, cover), []).append(exact / estimate.indentation[i, k])
        over.setdefault("drag", []).append(main["idler_rotation"].total / estimate.rolls[i])
        over.setdefault("rest", []).append((forces.secondary + forces.special) / estimate.rest[i])

    for i, used in uses.items():
        for limit, exact in used.items():
            over.setdefault(limit, []).append(exact / float(estimate.uses[limit][i]))

    def middle(key: object) -> float:
        return float(np.median(over[key])) if key in over else 1.0

    carry, back = ([k * middle((strand, i)) for i, k in enumerate(of)] for strand, of in
                   zip(STRANDS, (levels.carry, levels.back), strict=True))  # fmt: skip
    drag = middle("drag") if "drag" in over else levels.drag
    limits = {limit: levels.uses.get(limit, 1.0) * middle(limit) for limit in estimate.uses}
    return EstimateCalibration(tuple(carry), tuple(back), drag, levels.rest * middle("rest"), limits)


def _estimated_parts(task: SizingTask, choice: DesignChoice, estimate: Estimates, i: int) -> SelectedParts:
    """Belt class and motors by the estimate."""
    carcass = task.carcasses[choice.kind][int(estimate.carcass[i])]
    power = abs(float(estimate.force[i])) * choice.speed / task.efficiency
    most = task.largest_drive / task.rules.motor_reserve
    motors = tuple(task.motors(min(each, most)) for each in drive_powers(power, choice.drives))
    return SelectedParts(carcass, *task.covers(choice, carcass), motors, 0.0)


def _calculate_candidates(
    task: SizingTask,
    choices: Candidates,
    estimate: Estimates,
    chosen: Sequence[int],
    anchors: KnownTestFactors,
) -> list[SizedDesign | Shortfall]:
    """Calculate candidates exactly."""
    begin = [(choices[i], _estimated_parts(task, choices[i], estimate, i), float(estimate.cost[i])) for i in chosen]
    return size_parts(task, begin, anchors)


def size_parts(
    task: SizingTask,
    begin: Sequence[tuple[DesignChoice, SelectedParts, float]],
    anchors: KnownTestFactors,
    *,
    every_load: bool = False,
    made: Sequence[SizedDesign] = (),
) -> list[SizedDesign | Shortfall]:
    """Size class, motors, brake and take-up of candidates by their own calculated tensions.

    Both at the lowest temperature and at that of the duty: less friction needs a larger backstop or brake.

    Parameters
    ----------
    task : SizingTask
        The duty.
    begin : sequence of (DesignChoice, SelectedParts, float)
        Candidates, initial class and motors, yearly cost by the estimate.
    anchors : list
        Test calibrations of the compounds from earlier calculations; new ones are added.
    every_load : bool
        True to include empty, inclines only, declines only and the worst loadings, not the full belt alone.
    made : sequence of SizedDesign
        The same candidates as designs for the full belt, whose results are reused.
    """
    now = {i: chosen for i, (_, chosen, _) in enumerate(begin)}
    answers: dict[int, SizedDesign | Shortfall] = {}
    both = set(now) if every_load and task.cold else set[int]()  # calculated at both temperatures
    for _ in range(_SIZINGS):
        specs, refused = _candidate_specs(task, {i: (begin[i][0], chosen) for i, chosen in now.items()})
        answers |= refused
        alike = {i: made[i] for i in specs if made and now[i] == made[i].chosen}
        coldest = {i: task.colder(spec) if task.cold else spec for i, spec in specs.items()}
        known = {i: one.found for i, one in alike.items()}
        cold = _calculate_specs(coldest, anchors, {i: one.coldest for i, one in alike.items()})
        warm = _calculate_specs({i: spec for i, spec in specs.items() if i in both}, anchors, known)
        asked = _required_parts(task, begin, now, cold, warm, every_load=every_load)
        late = {i for i, one in asked.items() if task.cold and i not in both and one.settles(now[i])}
        warm = _calculate_specs({i: specs[i] for i in late}, anchors, {})
        asked |= _required_parts(task, begin, now, {i: cold[i] for i in late}, warm, every_load=every_load)
        both |= late
        answers |= {i: one.short for i, one in asked.items() if one.short is not None}
        again = {}
        for i, one in asked.items():
            if one.settles(now[i]):
                answers[i] = _design_or_shortfall(task, begin[i], now[i], one)
            elif one.chosen is not None:
                again[i] = one.chosen
        now = again
        if not now:
            break
    unsettled = Shortfall("parts do not settle", message("belt class and motors do not settle"), math.inf, {})
    return [answers.get(i, unsettled) for i in range(len(begin))]


@dataclass(frozen=True, eq=False)
class _RequiredParts:
    """Parts required by the loads of a candidate, those at the lowest temperature first, or the shortfall."""

    cold: tuple[CalculatedConveyor, ...] = ()
    warm: tuple[CalculatedConveyor, ...] = ()
    chosen: SelectedParts | None = None
    uses: Mapping[Limit, float] = field(default_factory=dict)
    short: Shortfall | None = None

    @property
    def loads(self) -> tuple[CalculatedConveyor, ...]:
        """All loads."""
        return self.cold + self.warm

    def settles(self, now: SelectedParts) -> bool:
        """True if the required parts are those used in the calculation."""
        return self.chosen is not None and replace(self.chosen, settling=now.settling) == now


def _required_parts(
    task: SizingTask,
    begin: Sequence[tuple[DesignChoice, SelectedParts, float]],
    now: Mapping[int, SelectedParts],
    cold: Mapping[int, CalculatedConveyor | NoAnswer],
    warm: Mapping[int, CalculatedConveyor | NoAnswer],
    *,
    every_load: bool,
) -> dict[int, _RequiredParts]:
    """Parts required by candidates calculated at the lowest temperature, and some at that of the duty."""
    asked = {}
    for i, answer in cold.items():
        try:
            loads = _design_loads(answer, every_load=every_load)
            milder = _design_loads(warm[i], every_load=every_load) if i in warm else ()
        except (NoSolutionError, RangeError, InputError) as error:
            asked[i] = _RequiredParts(short=_without_answer(error))
            continue
        asked[i] = _select_parts(task, begin[i][0], now[i], _RequiredParts(loads, milder), every_load=every_load)
    return asked


def _without_answer(error: NoAnswer) -> Shortfall:
    return Shortfall(str(error), message(escape_braces(str(error))), math.inf, {})


def _candidate_specs(
    task: SizingTask, now: Mapping[int, tuple[DesignChoice, SelectedParts]]
) -> tuple[dict[int, Conveyor], dict[int, Shortfall]]:
    """Specs of candidates with their present parts, and the shortfalls of those without one."""
    specs, refused = dict[int, Conveyor](), dict[int, Shortfall]()
    for i, (choice, chosen) in now.items():
        try:
            specs[i] = task.spec(choice, chosen, task.duty.name)
        except InputError as error:
            refused[i] = _without_answer(error)
    return specs, refused


def _calculate_specs(
    specs: Mapping[int, Conveyor], anchors: KnownTestFactors, known: Mapping[int, CalculatedConveyor]
) -> dict[int, CalculatedConveyor | NoAnswer]:
    """Calculate specs, unknown ones in one batch."""
    new = {i: Variant(spec) for i, spec in specs.items() if i not in known}
    return {**known, **dict(zip(new, calculate_many(list(new.values()), RTOL, anchors=anchors), strict=True))}


def _design_loads(answer: CalculatedConveyor | NoAnswer, *, every_load: bool) -> tuple[CalculatedConveyor, ...]:
    """The full belt, and every other load at one take-up setting if requested.

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


def _select_parts(
    task: SizingTask, choice: DesignChoice, before: SelectedParts, asked: _RequiredParts, *, every_load: bool
) -> _RequiredParts:
    """Select the parts required by the calculated tensions, or the limit that the series cannot meet.

    After the first round no weaker class is taken, so that sizing ends. A backstop affects neither cost nor tensions:
    it is selected only with every load.
    """
    loads = asked.loads
    classes, last = task.carcasses[choice.kind], task.carcasses[choice.kind][-1]
    strength, travel = (
        partial(_required_strength, choice=choice, loads=loads),
        _take_up_travel(before.carcass, loads),
    )
    power, rated = _required_power(task, loads), task.largest_drive
    uses: dict[Limit, float] = {
        "belt strength": strength(last) / last.strength,
        "motor power": power * task.rules.motor_reserve / rated,
        "take-up travel": travel(last) / task.take_up_travel,
    }
    asked = replace(asked, uses=uses)
    if max(uses.values()) > 1.0:
        limit = max(uses, key=uses.__getitem__)
        figures = {
            "belt strength": ((strength(last), "belt strength"), (last.strength, "belt strength")),
            "motor power": ((power * task.rules.motor_reserve, "power"), (rated, "power")),
            "take-up travel": ((travel(last), "length"), (task.take_up_travel, "length")),
        }[limit]
        return replace(asked, short=Shortfall(limit, message(_LIMIT_MESSAGES[limit], *figures), uses[limit], uses))
    carcass = next(one for one in classes if strength(one) <= one.strength and travel(one) <= task.take_up_travel)
    if before.settling and carcass.strength < before.carcass.strength:
        carcass = before.carcass
    motor = task.motors(power)
    brake = max((0.0 if one.motions.rolls_back else one.motions.brake_to_hold) for one in loads)
    brake = 0.0 if brake <= 0.0 else max(before.brake, BRAKE_RESERVE * brake)
    if before.brake > 0.0 and brake <= before.brake * (1.0 + RTOL):
        brake = before.brake
    backstop = max(before.backstop, _backstop_torque(task, carcass, loads)) if every_load else before.backstop
    chosen = SelectedParts(
        carcass, *task.covers(choice, carcass), (motor,) * len(before.motors), brake, backstop,
        _take_up_setting(before.take_up, loads), settling=True,
    )  # fmt: skip
    return replace(asked, chosen=chosen)


def _backstop_torque(task: SizingTask, carcass: CarcassClass, loads: Iterable[CalculatedConveyor]) -> float:
    """Torque of the next preferred backstop for all loads, with a reserve [N m]; 0 if none rolls back."""
    held = max((one.motions.brake_to_hold if one.motions.rolls_back else 0.0) for one in loads)
    torque = BRAKE_RESERVE * held * 0.5 * task.drive_diameter(carcass)
    return next_preferred_number(torque) if torque > 0.0 else 0.0


def _take_up_setting(before: float, loads: Sequence[CalculatedConveyor]) -> float:
    """Take-up tension that keeps the belt taut in every state of motion [N]; 0 if that for grip and sag does."""
    slack = max(-state.smallest for one in loads for state in one.motion_states)
    if slack <= 0.0 and before == 0.0:
        return 0.0
    setting = max(one.balance.settled.setting for one in loads)
    needed = max(setting + max(slack, 0.0), *(one.balance.settled.needed for one in loads))
    return before if needed <= before * (1.0 + RTOL) else TAKE_UP_STEP * math.ceil(needed / TAKE_UP_STEP)


def _required_strength(carcass: CarcassClass, choice: DesignChoice, loads: Sequence[CalculatedConveyor]) -> float:
    """Belt strength required by the tensions [N/m]; of a class with a rating also while starting and stopping."""
    tension = highest_tension(loads)
    if carcass.rating is not None:
        tension = max(tension, max(one.belt_duty.largest for one in loads) / RATED_START)
    return carcass.safety * tension / choice.trough.width.belt


def _take_up_travel(now: CarcassClass, loads: Sequence[CalculatedConveyor]) -> Callable[[CarcassClass], float]:
    """Take-up travel as a function of the belt class [m], by Hooke at the calculated tensions."""
    duty = common_take_up_duty(loads)
    parts = duty.travel
    if parts is None:
        raise AssertionError("every belt of the series has a usual stiffness")
    elastic = parts.tensioning + parts.load + parts.motion
    lasting = parts.permanent + parts.temperature
    return lambda one: (1.0 + duty.unit.reserve) * (elastic * now.stiffness / one.stiffness + lasting)


def _required_power(task: SizingTask, loads: Sequence[CalculatedConveyor]) -> float:
    """Power required of each drive [W]: its share at both ends of the friction band, and that for breakaway.

    Breakaway may use the rated power itself, so that its reserve is taken off.
    """
    running = max(check.calculated or 0.0 for one in loads for check in motor_power(one))
    starts = [(one, one.motions.start) for one in loads]
    stuck = max(
        (start.breakaway * one.line.speed / (one.line.efficiency * len(one.line.drives))
         for one, start in starts if 0.0 < start.force < start.breakaway),
        default=0.0,
    )  # fmt: skip
    return max(running, stuck / task.rules.motor_reserve)


def _foresee_parts(task: SizingTask, design: SizedDesign) -> SelectedParts:
    """Likely class and motors for the worst loading, so that the loads mostly need only one calculation.

    Bulk is left out where the belt alone needs more force; its friction is taken as proportional to the load.
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
        min(max(_drive_powers(one)) * (1.0 + more / steady), task.largest_drive / task.rules.motor_reserve)
    )
    strength = (highest_tension([one]) + more) / design.choice.trough.width.belt
    carcass = next(
        (
            each
            for each in task.carcasses[design.choice.kind]
            if max(each.safety * strength, chosen.carcass.strength) <= each.strength
        ),
        chosen.carcass,
    )
    top, bottom = task.covers(design.choice, carcass)
    motors = (max(motor, *chosen.motors),) * len(chosen.motors)
    backstop = _backstop_torque(task, carcass, design.pair)
    return replace(chosen, carcass=carcass, top=top, bottom=bottom, motors=motors, backstop=backstop, settling=False)


def _drive_powers(one: CalculatedConveyor) -> list[float]:
    """Highest power of every drive with the friction at both ends of its band [W]."""
    return [check.calculated or 0.0 for check in motor_power(one)]


def _design_or_shortfall(
    task: SizingTask,
    begin: tuple[DesignChoice, SelectedParts, float],
    chosen: SelectedParts,
    asked: _RequiredParts,
) -> SizedDesign | Shortfall:
    """The design, or its first failure."""
    failed = next(_failed_criteria(task, asked), None)
    if failed is not None:
        return failed
    choice, _, estimate = begin
    result = (asked.warm or asked.cold)[0]
    energy = 0.0 if result.year is None or result.year.cost is None else result.year.cost
    parts = conveyor_parts(result)
    if parts is None:
        raise AssertionError("a sized spec lists its parts")
    cost = conveyor_costs(parts, task.duty.prices.amounts, seconds=task.seconds, energy=energy)
    life = roll_life(result)
    return SizedDesign(choice, chosen, result, asked.cold[0], cost, estimate, life, asked.uses)


def _failed_criteria(task: SizingTask, asked: _RequiredParts) -> Iterator[Shortfall]:
    """Criteria that fail under a load; penetration and rubber data only give warnings in the report."""
    for one in asked.loads:
        for check in run_checks(one, contacts=False):
            if check.failed:
                why = check.why or message(
                    f"{check.name.words}: {check.found.words}", *check.name.figures, *check.found.figures
                )
                if check.key in _CURES:
                    why = replace(why, words=f"{why.words}: {_CURES[check.key]}")
                yield Shortfall(check.subject.text("SI"), why, check.use or math.inf, asked.uses)
        life = roll_life(one)
        if life < task.roll_life:
            figures = (life, "duration"), (task.roll_life, "duration")
            yield Shortfall(
                "bearings", message(_LIMIT_MESSAGES["bearings"], *figures), task.roll_life / life, asked.uses
            )
    travel = common_take_up_duty(asked.loads).travel
    if travel is not None and travel.whole > task.take_up_travel:
        figures = (travel.whole, "length"), (task.take_up_travel, "length")
        over = travel.whole / task.take_up_travel
        yield Shortfall("take-up travel", message(_LIMIT_MESSAGES["take-up travel"], *figures), over, asked.uses)


def _graduated_designs(
    task: SizingTask, designs: Sequence[SizedDesign], anchors: KnownTestFactors
) -> list[SizedDesign]:
    """Designs with the cheapest carry spacing in each section, if that saves."""
    tried = [
        (design, replace(design.choice, graduated=one))
        for design in designs
        for one in dict.fromkeys(graduated_spacings(task, design))
        if len(set(one)) > 1
    ]
    made = size_parts(task, [(choice, even.chosen, even.estimate) for even, choice in tried], anchors)
    return [
        new for (even, _), new in zip(tried, made, strict=True) if isinstance(new, SizedDesign) and new.year < even.year
    ]
