"""Ranked designs from a duty: candidates screened by a closed estimate, the best calculated exactly.

Belt class, motors and brake of each follow from its own calculated tensions; candidates that fail a check are rejected.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.errors import NoSolutionError
from conveyor.laws.take_up import TRAVEL_RESERVE
from conveyor.line.stretches import STRANDS
from conveyor.models.sizing import SizingDuty
from conveyor.pipeline import ProgressCallback
from conveyor.sizing.design_choice import DesignChoice, SelectedParts, drive_powers
from conveyor.sizing.duty_refusal import refuse_duty, refuse_slope
from conveyor.sizing.part_sizing import LIMIT_MESSAGES, calculate_specs, candidate_specs, foresee_parts, size_parts
from conveyor.sizing.screen import (
    Candidates,
    EstimateCalibration,
    Estimates,
    Limit,
    first_calibration,
    screen_candidates,
)
from conveyor.sizing.sensitivity import Neighbours, size_neighbours
from conveyor.sizing.sized_design import Shortfall, SizedDesign
from conveyor.sizing.sizing_task import SizingTask
from conveyor.sizing.spacing import graduated_spacings
from conveyor.units.presentation import format_figure
from conveyor.units.sentences import Message

CANDIDATES_AT_ONCE: Final = 16
"""Candidates calculated at once, the best by the estimate."""


MOST_ALIKE: Final = 2
"""Most of them with the same width, speed and drive layout, so that the list shows alternatives."""


GRADUATED_DESIGNS: Final = 3
"""Designs tried with graduated carry spacings, at least."""


_LEAST_DESIGNS: Final = 3  # looked for even if fewer are wanted, so that the best does not depend on how many are


_SCREENINGS: Final = 2  # calibrations of the estimate by calculated candidates


_DRAWS: Final = 20  # of further candidates while designs are missing


_NEAR_LIMIT: Final = 1.1  # estimated use of a limit up to which candidates are calculated if there is no design


_ALIKE_DRAWS: Final = (
    4  # draws in a row without a design, a failed series limit or progress, after which the search ends
)


_NEARER_BY: Final = 0.9  # factor on the nearest shortfall below which a draw counts as progress


_REFUSAL_PROBES: Final = 4  # candidates calculated if the estimate has none near a limit


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
    neighbours : mapping of DesignChoice to SizedDesign or Shortfall
        Choices that differ from the best design in one value, sized for the full belt; none that keeps every rule and
        check in every load costs less.
    """

    duty: SizingDuty
    designs: tuple[SizedDesign, ...]
    candidates: int
    possible: int
    calculated: int
    refused: Mapping[str, int]
    estimate_error: float
    neighbours: Neighbours = field(repr=False)

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
        A section is too steep for the bulk, or no candidate keeps the rules; then with the limit of the nearest one,
        figures and the remedy.
    """
    task = SizingTask(duty)
    refuse_slope(task)
    every = Candidates.of(task)
    if not len(every):
        refuse_duty(task)
    choices = every.within_travel()
    if not len(choices):
        raise _stretch_refusal(task)
    search = _Search(task, choices, first_calibration(len(duty.covers), duty.calculation.method))
    search.begin()
    final: list[SizedDesign] = []
    count = max(best, _LEAST_DESIGNS)
    for _ in range(_SCREENINGS):
        new = search.draw(CANDIDATES_AT_ONCE)
        search.calculate(new, progress)
    ranked, alike = list(search.designs), 0
    for _ in range(_DRAWS):
        final = _rank_designs([*final, *_final_designs(search, ranked, count - len(final))])
        if len(final) >= count:
            break
        new = search.draw(CANDIDATES_AT_ONCE + len(list(search.designs))) or search.nearest(CANDIDATES_AT_ONCE)
        nearest = search.nearest_over
        if not new:
            break
        ranked = search.calculate(new, progress)
        fails = {one.rule for i in new if isinstance(one := search.answers[i], Shortfall)}
        if ranked or fails & set(LIMIT_MESSAGES) or search.nearest_over < _NEARER_BY * nearest:
            alike = 0
        elif (alike := alike + 1) == _ALIKE_DRAWS:
            break
    if not final:
        raise search.refusal(len(every))
    ranked, neighbours = _rank_with_neighbours(search, final)
    return CalculatedSizing(
        duty,
        tuple(ranked[:best]),
        len(every),
        int(np.isfinite(search.estimate.year).sum()),
        len(search.answers),
        search.reasons,
        max(abs(one.estimate / one.year - 1.0) for one in [*search.designs, *final, *ranked]),
        neighbours,
    )


def _rank_with_neighbours(search: _Search, final: list[SizedDesign]) -> tuple[list[SizedDesign], Neighbours]:
    """Designs by rank, and what stands around the first: none of it costs less and keeps all rules in every load.

    Covers thicker than wear asks for are no choice of the search.
    """
    task, tried = search.task, set[DesignChoice]()
    while True:
        first = final[0]
        neighbours = size_neighbours(task, first)
        cheaper = {
            choice: one
            for choice, one in neighbours.items()
            if isinstance(one, SizedDesign)
            and one.year < first.year
            and choice.thicker <= first.choice.thicker
            and choice not in tried
        }
        if not cheaper:
            return final, neighbours
        tried |= cheaper.keys()
        estimated = screen_candidates(
            task, Candidates.of_choices(task, [one.choice for one in cheaper.values()]), search.levels
        )
        begun = [replace(one, estimate=float(cost)) for one, cost in zip(cheaper.values(), estimated.cost, strict=True)]
        final = _rank_designs([*final, *_final_designs(search, begun, 1)])
        if final[0] is first:
            return final, neighbours


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
        first = _first_calculations(task, self.choices, self.estimate, probes)
        self._update_calibration(first, {})

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
        found = _calculate_candidates(self.task, self.choices, self.estimate, new)
        self.answers |= zip(new, found, strict=True)
        self.reasons.update(one.rule for one in found if isinstance(one, Shortfall))
        made = {i: one.found for i, one in self.answers.items() if isinstance(one, SizedDesign)}
        self._update_calibration(made, {i: one.uses for i, one in self.answers.items()})
        return [one for one in found if isinstance(one, SizedDesign)]

    def failed(self, design: SizedDesign, why: Shortfall) -> None:
        """Reject a design that fails under another load."""
        for i, one in self.answers.items():
            if one is design:
                self.answers[i] = why
                self.reasons[why.rule] += 1

    def _update_calibration(
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
    task = search.task
    ranked = sorted(designs, key=_yearly_cost)
    if task.rules.graduated and len(task.sections) > 1:
        first = max(best, GRADUATED_DESIGNS)
        ranked = sorted([*ranked, *_graduated_designs(task, ranked[:first])], key=_yearly_cost)
    final: list[SizedDesign] = []
    while ranked and (len(final) < best or ranked[0].year < final[best - 1].year):
        batch, ranked = ranked[: max(1, best - len(final))], ranked[max(1, best - len(final)) :]
        begin = [(design.choice, foresee_parts(task, design), design.estimate) for design in batch]
        made = size_parts(task, begin, every_load=True, made=batch)
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
) -> dict[int, CalculatedConveyor]:
    """Calculated candidates with estimated parts, to calibrate the estimate; only those with an answer."""
    specs, _ = candidate_specs(task, {i: (choices[i], _estimated_parts(task, choices[i], estimate, i)) for i in chosen})
    found = calculate_specs(specs, {})
    return {i: one for i, one in found.items() if isinstance(one, CalculatedConveyor)}


def _calibrate_estimate(
    choices: Candidates, estimate: Estimates, levels: EstimateCalibration,
    calculated: Mapping[int, CalculatedConveyor], uses: Mapping[int, Mapping[Limit, float]],
) -> EstimateCalibration:  # fmt: skip
    """Calibration at which the estimate agrees with the median of the calculations."""
    over: dict[object, list[float]] = {}
    for i, one in calculated.items():
        main = {force.key: force for force in one.balance.along if force.kind == "main"}
        cover, forces, classical = choices[i].cover, one.balance.forces, choices.task.classical
        scaled_forces = main if classical else ("indentation",)
        for k, strand in enumerate(STRANDS):
            exact = math.fsum(main[key].by_strand()[strand] for key in scaled_forces)
            over.setdefault((strand, cover), []).append(exact / estimate.scaled_forces[i, k])
        if classical is None:
            over.setdefault("drag", []).append(main["idler_rotation"].total / estimate.rolls[i])
        over.setdefault("design", []).append(one.line.design_friction / levels.design)
        by_length = 0.0 if classical is None else (classical.coefficient - 1.0) * forces.main
        if estimate.rest[i] > 0.0:
            over.setdefault("rest", []).append((forces.secondary + forces.special - by_length) / estimate.rest[i])

    for i, used in uses.items():
        for limit, exact in used.items():
            over.setdefault(limit, []).append(exact / float(estimate.uses[limit][i]))

    def middle(key: object) -> float:
        return float(np.median(over[key])) if key in over else 1.0

    carry, back = ([k * middle((strand, i)) for i, k in enumerate(of)] for strand, of in
                   zip(STRANDS, (levels.carry, levels.back), strict=True))  # fmt: skip
    drag = middle("drag") if "drag" in over else levels.drag
    limits = {limit: levels.uses.get(limit, 1.0) * middle(limit) for limit in estimate.uses}
    design = levels.design * middle("design")
    return EstimateCalibration(tuple(carry), tuple(back), drag, levels.rest * middle("rest"), design, limits)


def _estimated_parts(task: SizingTask, choice: DesignChoice, estimate: Estimates, i: int) -> SelectedParts:
    """Belt class and motors by the estimate."""
    carcass = task.carcasses[choice.kind][int(estimate.carcass[i])]
    force = max(abs(float(estimate.force[i])), abs(float(estimate.design_force[i])))
    power = force * choice.speed / task.efficiency
    most = task.largest_drive / task.rules.motor_reserve
    motors = tuple(task.motors(min(each, most)) for each in drive_powers(power, choice.drives))
    return SelectedParts(carcass, *task.covers(choice, carcass), motors, 0.0)


def _calculate_candidates(
    task: SizingTask,
    choices: Candidates,
    estimate: Estimates,
    chosen: Sequence[int],
) -> list[SizedDesign | Shortfall]:
    """Calculate candidates exactly."""
    begin = [(choices[i], _estimated_parts(task, choices[i], estimate, i), float(estimate.cost[i])) for i in chosen]
    return size_parts(task, begin)


def _graduated_designs(task: SizingTask, designs: Sequence[SizedDesign]) -> list[SizedDesign]:
    """Designs with the cheapest carry spacing in each section, if that saves."""
    tried = [
        (design, replace(design.choice, graduated=one))
        for design in designs
        for one in dict.fromkeys(graduated_spacings(task, design))
        if len(set(one)) > 1
    ]
    made = size_parts(task, [(choice, even.chosen, even.estimate) for even, choice in tried])
    return [
        new for (even, _), new in zip(tried, made, strict=True) if isinstance(new, SizedDesign) and new.year < even.year
    ]
