"""What people look at in a study: its designs as numbers, the best of them, the front, and what each field does."""

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
from conveyor.models import Conveyor
from conveyor.models.study import Direction, StudyPlan, Value
from conveyor.studies.campaign import Campaign
from conveyor.studies.designs import Design, DesignFigure, front
from conveyor.studies.points import OUTPUTS
from conveyor.units import quantity

Array: TypeAlias = NDArray[np.float64]
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
BEST: Final = 10
"""Designs that are listed, and written as specs."""
BINS: Final = 8
"""Of a field that is drawn from a range."""


@dataclass(frozen=True)
class VariedField:
    """A field of designs as numbers: in the unit of its first value, or numbers of its words.

    Attributes
    ----------
    path : str
        Of the field.
    unit : str
        Of its numbers; empty without.
    words : tuple of str
        What it is given by where it has no numbers; number 0 is the first.
    label : str
        The end of its path, as long as it takes to tell the fields apart.
    """

    path: str
    unit: str = ""
    words: tuple[str, ...] = ()
    label: str = ""

    def number(self, value: Value) -> float:
        """A value as a number."""
        if self.words:
            return float(self.words.index(str(value)))
        return _read(value, self.unit)

    def said(self, number: float) -> str:
        """A number in words."""
        return self.words[int(number)] if self.words else f"{number:.9g} {self.unit}".strip()


@dataclass(frozen=True)
class MainEffect:
    """What sought figure the designs with a value of a field have: mean, least and most [SI].

    Attributes
    ----------
    at : float
        Number of the value; of a range the middle of a part.
    value : str
        It in words.
    count : int
        Designs.
    mean, least, most : float
        Of what is sought first [SI].
    error : float or None
        Standard error of the mean, of a field that is drawn [SI]: the fields drawn beside it have other values in every
        part. None of one draw, and of a field all of whose values meet the same others.
    """

    at: float
    value: str
    count: int
    mean: float
    least: float
    most: float
    error: float | None


@dataclass(frozen=True, eq=False)
class Explored:
    """Designs of a study that have an answer, as numbers.

    Attributes
    ----------
    plan : StudyPlan
        The study.
    base : Conveyor
        Its spec.
    fields : tuple of VariedField
        What tells designs apart; not those that are the same in all.
    figures : mapping of str to DesignFigure
        Of designs, by name.
    sought : mapping of str to {"least", "most"}
        The figures that order and front are of.
    values : ndarray
        Of the fields, shape `(n, fields)`.
    found : ndarray
        What is sought, shape `(n, sought)` [SI].
    keeps, front : ndarray
        Whether a design keeps all limits; whether of those that do none beats it, shape `(n,)`.
    numbers : ndarray
        Of the designs in the plan, shape `(n,)`.
    best : tuple of Design
        The ten that come first: those that keep the limits, in the order of what is sought first.
    refused : mapping of str to int
        Why designs have no answer, and how many.
    count : int
        Designs, those without an answer included.
    """

    plan: StudyPlan
    base: Conveyor
    fields: tuple[VariedField, ...]
    figures: dict[str, DesignFigure]
    sought: dict[str, Direction]
    values: Array
    found: Array
    keeps: NDArray[np.bool_]
    front: NDArray[np.bool_]
    numbers: NDArray[np.int64]
    best: tuple[Design, ...]
    refused: dict[str, int]
    count: int

    @property
    def currency(self) -> str:
        """Of all costs."""
        return self.plan.currency(self.base)

    @property
    def costs(self) -> Array:
        """What is sought with less better, shape `(n, sought)`."""
        return self.found * signs(self.sought)

    def effects(self, field: int) -> tuple[MainEffect, ...]:
        """What a field does to what is sought first: over all other fields, value by value or in parts of its range."""
        at, values_of = self.values[:, field], self.found[:, 0]
        different = np.unique(at)
        varied = self.fields[field]
        if len(different) <= BINS or varied.words:
            groups = [(float(value), np.flatnonzero(at == value)) for value in different]
        else:
            edges = np.linspace(different[0], different[-1], BINS + 1)
            place = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, BINS - 1)
            groups = [(float(edges[k] + edges[k + 1]) / 2.0, np.flatnonzero(place == k)) for k in range(BINS)]
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
        """Of the mean of what is sought first of some designs, each draw counted once; None of one draw."""
        drawn = [k for k, field in enumerate(self.fields) if field.path in self.plan.drawn]
        values = self.values[rows][:, drawn]
        _, draw, count = np.unique(values, axis=0, return_inverse=True, return_counts=True)
        means = np.bincount(draw.ravel(), self.found[rows, 0]) / count
        return float(means.std(ddof=1) / math.sqrt(len(means))) if len(means) > 1 else None

    @property
    def ordered(self) -> tuple[int, ...]:
        """Fields, that which matters most first: by the range of its means."""

        def span(field: int) -> float:
            means = [effect.mean for effect in self.effects(field)]
            return max(means) - min(means)

        return tuple(sorted(range(len(self.fields)), key=lambda field: -span(field)))


def signs(sought: dict[str, Direction]) -> Array:
    """1 of what is sought least, -1 of what is sought most."""
    return np.array([1.0 if direction == "least" else -1.0 for direction in sought.values()])


def sought_of(plan: StudyPlan, figures: Iterable[str], base: Conveyor) -> dict[str, Direction]:
    """What is sought: as the plan says, else cost and energy of a year if designs have them, else the first figure.

    Of a safety and of the flow the most, of all else the least.
    """
    known, operation = tuple(figures), base.operation
    priced = (
        operation is not None and operation.price is not None and (plan.hours is not None or not base.duty)
    )
    cost = "total_cost_per_year" if plan.figures and "total_cost_per_year" in known else "cost_per_year"
    usual = tuple(name for name in (cost, "energy_per_year") if priced and name in known)
    return dict(plan.best) or {name: OUTPUTS[name.partition(" ")[0]].better for name in usual or known[:1]}


def explored(campaign: Campaign, designs: Iterable[Design]) -> Explored:
    """Gather the designs of a study, once through.

    Parameters
    ----------
    campaign : Campaign
        The study.
    designs : iterable of Design
        All of them; numbers of each are kept, of the best ten everything.
    """
    plan = campaign.listed
    every = varied(plan)
    fields = tuple(field for field in every if len(set(_given(plan, field.path))) > 1) or every
    sought = sought_of(plan, campaign.figures, campaign.base)
    sign = signs(sought)
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
        heapq.heappush(best, (rank, design)) if len(best) < BEST else heapq.heappushpop(best, (rank, design))
    costs = np.array(reached).reshape(-1, len(sought))
    kept = np.frombuffer(keeps, dtype=bool)
    beaten_by_none = np.zeros(len(kept), dtype=bool)
    beaten_by_none[kept] = front(costs[kept] * sign)
    return Explored(
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
    )


def varied(plan: StudyPlan, paths: Sequence[str] = ()) -> tuple[VariedField, ...]:
    """Fields that vary; those that tell designs apart without paths."""
    every = paths or plan.designed
    return tuple(replace(_field(path, _given(plan, path)), label=_label(path, every)) for path in every)


def _label(path: str, every: Sequence[str]) -> str:
    parts = path.split(".")
    ends = (".".join(parts[-k:]) for k in range(1, len(parts) + 1))
    label = next(end for end in ends if sum(f".{other}".endswith(f".{end}") for other in every) == 1)
    return label.replace("_", " ").replace(".", " ")


def _given(plan: StudyPlan, path: str) -> Sequence[Value]:
    """Values of a field; of a range its ends."""
    if plan.samples is not None and path in plan.samples.fields:
        span = plan.samples.fields[path]
        return (span.at(0.0), span.at(1.0))
    return plan.axes.get(path) or [row[path] for row in (*plan.together, *plan.rows) if path in row]


def _field(path: str, given: Sequence[Value]) -> VariedField:
    unit = str(given[0]).strip().partition(" ")[2].strip() if isinstance(given[0], str) else ""
    try:
        if not any(isinstance(value, bool) or math.isnan(_read(value, unit)) for value in given):
            return VariedField(path, unit)
    except InputError:
        pass
    return VariedField(path, words=tuple(dict.fromkeys(map(str, given))))


def _read(value: Value, unit: str) -> float:
    """A number, or that of a quantity in a unit."""
    if not isinstance(value, str):
        return float(value)
    number, _, sign = value.partition(" ")
    if sign == unit and _NUMBER.fullmatch(number):
        return float(number)
    given, like = quantity(value), quantity(f"0 {unit}".strip())
    if given.dimensionality != like.dimensionality:
        raise InputError(f"got {value}, expected a value in {unit}")
    return float(f"{given.to(like.units).magnitude:.12g}")
