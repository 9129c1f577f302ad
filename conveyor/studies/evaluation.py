"""Summary of a study: its designs as numbers, the best ones, the Pareto front, and the main effect of each field."""

from __future__ import annotations

import heapq
import math
import re
from array import array
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.study import Direction, StudyPlan, Value
from conveyor.studies.design_figures import Design, DesignFigure, pareto_front
from conveyor.studies.parametric_study import ParametricStudy
from conveyor.studies.points import OUTPUTS
from conveyor.units import quantity

Array: TypeAlias = NDArray[np.float64]
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
MOST_LISTED: Final = 10
"""Most designs listed, and written as specs."""
RANGE_BINS: Final = 8
"""Parts of the range of a field with many values."""


@dataclass(frozen=True)
class VariedField:
    """A field of designs as numbers: in the unit of its first value, or indices of its words.

    Attributes
    ----------
    path : str
        Path of the field.
    unit : str
        Unit of its numbers; empty without one.
    words : tuple of str
        Its values if they are not numbers; index 0 is the first.
    label : str
        Shortest end of its path that is unique among the fields.
    """

    path: str
    unit: str = ""
    words: tuple[str, ...] = ()
    label: str = ""

    def number(self, value: Value) -> float:
        """Convert a value to a number."""
        if self.words:
            return float(self.words.index(str(value)))
        return _read_number(value, self.unit)

    def said(self, number: float) -> str:
        """Format a number as a value."""
        return self.words[int(number)] if self.words else f"{number:.9g} {self.unit}".strip()


@dataclass(frozen=True)
class MainEffect:
    """Mean, least and most of the first objective over the designs with a value of a field [SI].

    Attributes
    ----------
    at : float
        Number of the value; the middle of a part of a range.
    value : str
        The value as text.
    count : int
        Number of designs.
    mean, least, most : float
        Of the first objective [SI].
    error : float or None
        Standard error of the mean for a sampled field [SI], as the other sampled fields differ in every part. None for
        a single draw, and for a field whose values all meet the same others.
    """

    at: float
    value: str
    count: int
    mean: float
    least: float
    most: float
    error: float | None


@dataclass(frozen=True, eq=False)
class StudySummary:
    """Designs of a study with an answer, as numbers.

    Attributes
    ----------
    plan : StudyPlan
        The study.
    base : Conveyor
        Its spec.
    fields : tuple of VariedField
        Fields that differ between designs.
    figures : mapping of str to DesignFigure
        Design figures by name.
    objectives : mapping of str to {"least", "most"}
        Objectives: figures of the ranking and the front.
    values : ndarray
        Values of the fields, shape `(n, fields)`.
    found : ndarray
        Values of the objectives, shape `(n, objectives)` [SI].
    keeps, front : ndarray
        True if a design keeps all limits; true if it is also on the Pareto front, shape `(n,)`.
    numbers : ndarray
        Numbers of the designs in the plan, shape `(n,)`.
    best : tuple of Design
        The ten best: designs that keep the limits, by the first objective.
    refused : mapping of str to int
        Reasons why designs have no answer, with their number.
    count : int
        Number of designs, those without an answer included.
    compounds : tuple of RubberCompound
        Compounds of the designs.
    """

    plan: StudyPlan
    base: Conveyor
    fields: tuple[VariedField, ...]
    figures: dict[str, DesignFigure]
    objectives: dict[str, Direction]
    values: Array
    found: Array
    keeps: NDArray[np.bool_]
    front: NDArray[np.bool_]
    numbers: NDArray[np.int64]
    best: tuple[Design, ...]
    refused: dict[str, int]
    count: int
    compounds: tuple[RubberCompound, ...]

    @property
    def currency(self) -> str:
        """Currency of all costs."""
        return self.plan.currency(self.base)

    @property
    def costs(self) -> Array:
        """Objectives with the sign that makes less better, shape `(n, objectives)`."""
        return self.found * objective_signs(self.objectives)

    def effects(self, field: int) -> tuple[MainEffect, ...]:
        """Main effects of a field on the first objective, by value or in parts of its range."""
        at, values_of = self.values[:, field], self.found[:, 0]
        different = np.unique(at)
        varied = self.fields[field]
        if len(different) <= RANGE_BINS or varied.words:
            groups = [(float(value), np.flatnonzero(at == value)) for value in different]
        else:
            edges = np.linspace(different[0], different[-1], RANGE_BINS + 1)
            place = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, RANGE_BINS - 1)
            groups = [(float(edges[k] + edges[k + 1]) / 2.0, np.flatnonzero(place == k)) for k in range(RANGE_BINS)]
        return tuple(
            MainEffect(
                value,
                varied.said(value),
                len(rows),
                float(values_of[rows].mean()),
                float(values_of[rows].min()),
                float(values_of[rows].max()),
                self._standard_error(rows) if varied.path in self.plan.drawn else None,
            )
            for value, rows in groups
            if len(rows)
        )

    def _standard_error(self, rows: NDArray[np.int64]) -> float | None:
        """Standard error of the mean of the first objective, each draw counted once; None for one draw."""
        drawn = [k for k, field in enumerate(self.fields) if field.path in self.plan.drawn]
        values = self.values[rows][:, drawn]
        _, draw, count = np.unique(values, axis=0, return_inverse=True, return_counts=True)
        means = np.bincount(draw.ravel(), self.found[rows, 0]) / count
        return float(means.std(ddof=1) / math.sqrt(len(means))) if len(means) > 1 else None

    @property
    def ordered(self) -> tuple[int, ...]:
        """Fields by the range of their mean effects, the widest first."""

        def span(field: int) -> float:
            means = [effect.mean for effect in self.effects(field)]
            return max(means) - min(means)

        return tuple(sorted(range(len(self.fields)), key=lambda field: -span(field)))


def objective_signs(sought: dict[str, Direction]) -> Array:
    """Sign of each objective: 1 for least, -1 for most."""
    return np.array([1.0 if direction == "least" else -1.0 for direction in sought.values()])


def study_objectives(plan: StudyPlan, figures: Iterable[str], base: Conveyor) -> dict[str, Direction]:
    """Objectives: those of the plan, else cost and energy of a year if designs have them, else the first figure.

    Safeties and the flow are maximised, all others minimised.
    """
    known, operation = tuple(figures), base.operation
    priced = operation is not None and operation.price is not None and (plan.hours is not None or not base.duty)
    cost = "total_cost_per_year" if plan.figures and "total_cost_per_year" in known else "cost_per_year"
    usual = tuple(name for name in (cost, "energy_per_year") if priced and name in known)
    return dict(plan.best) or {name: OUTPUTS[name.partition(" ")[0]].better for name in usual or known[:1]}


def summarise_study(campaign: ParametricStudy, designs: Iterable[Design]) -> StudySummary:
    """Summarise the designs of a study in one pass.

    Parameters
    ----------
    campaign : ParametricStudy
        The study.
    designs : iterable of Design
        All designs; only numbers of each are kept, and the best ten in full.
    """
    plan = campaign.require_list_plan()
    every = varied_fields(plan)
    fields = tuple(field for field in every if len(set(_field_values(plan, field.path))) > 1) or every
    sought = study_objectives(plan, campaign.figures, campaign.base)
    sign = objective_signs(sought)
    values, reached, keeps, numbers = array("d"), array("d"), bytearray(), array("q")
    refused: Counter[str] = Counter()
    best: list[tuple[tuple[bool, float, int], Design]] = []
    count = 0
    for count, design in enumerate(designs, start=1):  # noqa: B007 the number of designs
        known = [design.figures.get(name) for name in sought]
        if any(value is None for value in known):
            missing = ", ".join(name for name, value in zip(sought, known, strict=True) if value is None)
            refused[design.why or f"it has no {missing}"] += 1
            continue
        told = [value for value in known if value is not None]
        values.extend(field.number(design.changes[field.path]) for field in fields)
        reached.extend(told)
        keeps.append(design.keeps)
        numbers.append(design.number)
        rank = (design.keeps, -float(told[0] * sign[0]), -design.number)
        heapq.heappush(best, (rank, design)) if len(best) < MOST_LISTED else heapq.heappushpop(best, (rank, design))
    costs = np.array(reached).reshape(-1, len(sought))
    kept = np.frombuffer(keeps, dtype=bool)
    beaten_by_none = np.zeros(len(kept), dtype=bool)
    beaten_by_none[kept] = pareto_front(costs[kept] * sign)
    return StudySummary(
        plan,
        campaign.base,
        fields,
        campaign.figures,
        sought,
        np.array(values).reshape(-1, len(fields)),
        costs,
        kept,
        beaten_by_none,
        np.array(numbers, dtype=np.int64),
        tuple(design for _, design in sorted(best, key=lambda one: one[0], reverse=True)),
        dict(refused.most_common()),
        count,
        campaign.rubbers,
    )


def varied_fields(plan: StudyPlan, paths: Sequence[str] = ()) -> tuple[VariedField, ...]:
    """Varied fields at the given paths; by default those that differ between designs."""
    every = paths or plan.design_fields
    return tuple(
        replace(_varied_field(path, _field_values(plan, path)), label=_field_label(path, every)) for path in every
    )


def _field_label(path: str, every: Sequence[str]) -> str:
    parts = path.split(".")
    ends = (".".join(parts[-k:]) for k in range(1, len(parts) + 1))
    label = next(end for end in ends if sum(f".{other}".endswith(f".{end}") for other in every) == 1)
    return label.replace("_", " ").replace(".", " ")


def _field_values(plan: StudyPlan, path: str) -> Sequence[Value]:
    """Values of a field, or the ends of its range."""
    if plan.samples is not None and path in plan.samples.fields:
        span = plan.samples.fields[path]
        return (span.at(0.0), span.at(1.0))
    return plan.axes.get(path) or [row[path] for row in (*plan.together, *plan.rows) if path in row]


def _varied_field(path: str, given: Sequence[Value]) -> VariedField:
    unit = str(given[0]).strip().partition(" ")[2].strip() if isinstance(given[0], str) else ""
    try:
        if not any(isinstance(value, bool) or math.isnan(_read_number(value, unit)) for value in given):
            return VariedField(path, unit)
    except InputError:
        pass
    return VariedField(path, words=tuple(dict.fromkeys(map(str, given))))


def _read_number(value: Value, unit: str) -> float:
    """Number of a value, converted to a unit if it is a quantity."""
    if not isinstance(value, str):
        return float(value)
    number, _, sign = value.partition(" ")
    if sign == unit and _NUMBER.fullmatch(number):
        return float(number)
    given, like = quantity(value), quantity(f"0 {unit}".strip())
    if given.dimensionality != like.dimensionality:
        raise InputError(f"got {value}, expected a value in {unit}")
    return float(f"{given.to(like.units).magnitude:.12g}")
