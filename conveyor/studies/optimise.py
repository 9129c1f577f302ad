"""Best design by differential evolution over ranges and lists, every design calculated in full and stored.

Storn and Price 1997 in SciPy's implementation, with Lampinen's rule for limits (2002): a design that keeps them beats
one that does not; of two that do not, the one with the smaller excess wins. The designs tried depend on the seed and
the answers alone; a stopped search resumes from the stored answers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, NonlinearConstraint, differential_evolution

from conveyor.errors import InputError, NoSolutionError
from conveyor.models.study import SearchPlan, Value
from conveyor.studies.design_figures import Design, limit_excess
from conveyor.studies.parametric_study import ParametricStudy, ResultStore, design_result, run_study
from conveyor.units.presentation import MONEY, display_unit

Array: TypeAlias = NDArray[np.float64]
Generation: TypeAlias = Callable[[int, int, Design], None]
"""Called with the generations done, their maximum, and the best design so far."""
_SPREAD: Final = 0.01
"""Relative spread of the costs of a generation below which the search ends (SciPy's default)."""


@dataclass(frozen=True, eq=False)
class SearchResult:
    """The best design of a search.

    Attributes
    ----------
    design : Design
        The best design.
    tried : int
        Different designs calculated.
    generations : int
        Generations calculated.
    settled : bool
        True if the designs of the last generation cost alike; else generations ran out.
    history : tuple of float
        Best cost of each generation, of those that keep every limit [SI].
    """

    design: Design
    tried: int
    generations: int
    settled: bool
    history: tuple[float, ...]


def optimise(
    campaign: ParametricStudy,
    known: ResultStore,
    *,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Generation | None = None,
) -> SearchResult:
    """Search for the best design of a plan.

    Parameters
    ----------
    campaign : ParametricStudy
        Study of a `SearchPlan`.
    known : ResultStore
        Stored answers; new ones are added.
    executor : concurrent.futures.Executor, optional
        Executor of the designs of a generation.
    workers : int
        Workers of the executor.
    progress : callable, optional
        Called after every generation.

    Raises
    ------
    InputError
        The plan is of another kind, or a list of fields leaves no choice.
    NoSolutionError
        No design tried keeps the limits; the message names those that the closest exceeds.
    ConveyorError
        As `campaign.run`.
    """
    plan = campaign.plan
    if not isinstance(plan, SearchPlan):
        raise InputError("optimise: takes a campaign of a SearchPlan")
    search = _Search(campaign, plan, known, partial(run_study, executor=executor, workers=workers))
    history: list[float] = []
    gone = itertools.count(1)

    def told(*_: object, **__: object) -> None:
        best = search.best
        if best.keeps:
            history.append(search.cost(best))
        if progress is not None:
            progress(next(gone), plan.generations, best)

    ends = [(0.0, 1.0)] * len(plan.ranges) + [(0.0, len(listed) - 1.0) for listed in plan.choices]
    evolved = differential_evolution(
        search.costs,  # type: ignore[arg-type]  # takes many designs, as vectorized says
        Bounds(*np.transpose(ends)),
        popsize=plan.population,
        maxiter=plan.generations,
        tol=_SPREAD,
        rng=plan.seed,
        callback=told,
        polish=False,
        updating="deferred",
        vectorized=True,
        integrality=[False] * len(plan.ranges) + [True] * len(plan.choices),
        constraints=NonlinearConstraint(search.beyond, -math.inf, 0.0),
    )
    best = search.best
    if not best.keeps:
        why = best.why or f"the closest has {', '.join(map(search.told, best.broken))}"
        raise NoSolutionError(f"none of {len(search.designs)} designs keeps the limits: {why}")
    return SearchResult(best, len(search.designs), int(evolved.nit), bool(evolved.success), tuple(history))


class _Search:
    """Designs tried, by their fields; each is calculated once."""

    def __init__(
        self, campaign: ParametricStudy, plan: SearchPlan, known: ResultStore, calculate: Callable[..., None]
    ) -> None:
        self._campaign, self._plan, self._known, self._calculate = campaign, plan, known, calculate
        self._name, self._direction = next(iter(plan.best.items()))
        self.designs: dict[tuple[Value, ...], Design] = {}

    def costs(self, shares: Array, /) -> Array:
        """Objective of designs, less is better, shape `(n,)` from `(fields, n)`."""
        return np.array([self.cost(design) for design in self._of(shares)])

    def beyond(self, shares: Array) -> Array:
        """Excess of designs over their limits, shape `(1, n)` from `(fields, n)`."""
        return np.array([[self.violation(design) for design in self._of(shares)]])

    def cost(self, design: Design) -> float:
        """Objective of a design, less is better."""
        value = design.figures.get(self._name)
        return math.inf if value is None else value if self._direction == "least" else -value

    def violation(self, design: Design) -> float:
        """Sum of the excesses over the limits [-]; infinite without an answer."""
        if design.figures.get(self._name) is None:
            return math.inf
        limits = self._plan.limits.items()
        kinds = self._campaign.figures
        return math.fsum(limit_excess(one, name, kinds[name].kind, design.figures[name]) for name, one in limits)

    def told(self, name: str) -> str:
        """Text of a figure of the best design and the limit it exceeds."""
        kind, value, limit = (
            self._campaign.figures[name].kind,
            self.best.figures[name],
            self._plan.limits[name],
        )
        if value is None:
            return f"no {name}"
        shown = display_unit(f"{MONEY}{self._campaign.currency}" if kind == "money" else kind).said(value, 4)
        ends = (("least", limit.least), ("most", limit.most))
        kept = " and ".join(f"{word} {end}" for word, end in ends if end is not None)
        return f"{name} {shown} against {kept}"

    @property
    def best(self) -> Design:
        """Best design that keeps the limits, else the one with the least excess; the first of equals."""
        return min(self.designs.values(), key=lambda one: (self.violation(one), self.cost(one)))

    def _of(self, shares: Array) -> list[Design]:
        """Designs at given shares; new ones are calculated in one batch."""
        asked = [self._plan.design(one) for one in np.atleast_2d(shares.T).tolist()]
        new = {key: one for one in asked if (key := tuple(one.values())) not in self.designs}
        points = [point for one in new.values() for point in self._plan.points_of(one)]
        self._calculate(self._campaign, self._known, points)
        for key, one in new.items():
            self.designs[key] = design_result(self._campaign, self._known, one, len(self.designs) + 1)
        return [self.designs[tuple(one.values())] for one in asked]
