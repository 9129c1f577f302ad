"""A study: a spec, the fields that vary, and the figures that are asked for."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from conveyor.errors import InputError
from conveyor.models.base import Model, Name, Problem, refuse
from conveyor.models.fields import check_path
from conveyor.ranges import MOST, spaced
from conveyor.units import between, quantity, text

Value: TypeAlias = str | float | int | bool
"""Of a field, as specs write it."""
Changes: TypeAlias = Mapping[str, Value]
"""New values of fields, by path."""
MOST_SAMPLES = 2**20


def _listed(given: Any) -> Any:
    """Values of `from:to:step unit`; lists as they are."""
    if not isinstance(given, str):
        return given
    *numbers, unit = given.partition(" ")
    if given.count(":") == 2:
        try:
            found = spaced(numbers[0])
        except ValueError:
            found = []
        if found:
            return [f"{value:.12g} {unit}".strip() if unit else float(f"{value:.12g}") for value in found]
    raise PydanticCustomError(
        "axis",
        '{message}',
        {"message": f'got "{given}", expected a list, or from:to:step with a unit (at most {MOST} values), '
                    'such as "-20:40:5 degC"'},
    )  # fmt: skip


Axis = Annotated[tuple[Value, ...], BeforeValidator(_listed), Field(min_length=1)]


class SampledRange(Model):
    """Between what a field is drawn."""

    low: str | float
    """One end."""
    high: str | float
    """Other end."""

    @model_validator(mode="after")
    def _alike(self) -> Self:
        try:
            self.at(0.5)
        except InputError as error:
            refuse("SampledRange", [Problem((), str(error))])
        return self

    def at(self, share: float) -> Value:
        """Value a share of the way from low to high.

        Raises
        ------
        InputError
            The ends are of different kinds.
        """
        if isinstance(self.low, float) and isinstance(self.high, float):
            return self.low + share * (self.high - self.low)
        ends = [quantity(end if isinstance(end, str) else f"{end:g}") for end in (self.low, self.high)]
        return text(between(ends[0], ends[1], share))


class Samples(Model):
    """Points drawn evenly from ranges of fields."""

    method: Literal["latin hypercube", "sobol"] = "sobol"
    """How points are spread; of Sobol's sequence a power of 2 is balanced."""
    count: Annotated[int, Field(ge=1, le=MOST_SAMPLES)]
    """Points."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    """Of the random numbers: the same seed draws the same points."""
    fields: Annotated[dict[str, SampledRange], Field(min_length=1)]
    """Range of each field, by path."""

    def points(self) -> Iterator[dict[str, Value]]:
        """Every point."""
        from scipy.stats import qmc

        kinds = {"latin hypercube": qmc.LatinHypercube, "sobol": qmc.Sobol}
        drawn = kinds[self.method](d=len(self.fields), rng=self.seed)
        ranges = list(self.fields.items())
        if self.method == "sobol":
            # powers of two: the sequence is balanced, and SciPy says nothing
            shares = drawn.random_base2(math.ceil(math.log2(self.count)))[: self.count]
        else:
            shares = drawn.random(self.count)
        for row in shares.tolist():
            yield {path: span.at(share) for (path, span), share in zip(ranges, row, strict=True)}


class StudyPlan(Model):
    """A spec and what of it varies: every value of every axis with every other, with every row and every sample."""

    name: Name
    """Of the study."""
    base: str
    """Spec, beside the study's file."""
    axes: Annotated[dict[str, Axis], Field(default_factory=dict)]
    """Values of fields, by path: a list, or `from:to:step unit`."""
    together: tuple[dict[str, Value], ...] = ()
    """Rows of fields that move together."""
    samples: Samples | None = None
    outputs: tuple[str, ...] = ()
    """Figures by key; all without."""

    @model_validator(mode="after")
    def _distinct(self) -> Self:
        problems, sampled = [], {} if self.samples is None else self.samples.fields
        for path in (*self.axes, *itertools.chain.from_iterable(self.together), *sampled):
            try:
                check_path(path)
            except InputError as error:
                problems.append(Problem((), str(error)))
        rows = {frozenset(row) for row in self.together}
        if len(rows) > 1:
            problems.append(Problem(("together",), "every row has to change the same fields"))
        told = [*self.axes, *(next(iter(rows)) if rows else ()), *sampled]
        twice = sorted({path for path in told if told.count(path) > 1})
        if twice:
            problems.append(Problem((), f"{', '.join(twice)}: varied twice; leave one of both"))
        if not told:
            problems.append(Problem((), "nothing varies; give axes, together or samples"))
        refuse("StudyPlan", problems)
        return self

    @property
    def paths(self) -> tuple[str, ...]:
        """Every field that varies, the slowest first."""
        return (
            *(self.together[0] if self.together else ()),
            *(self.samples.fields if self.samples else ()),
            *self.axes,
        )

    @property
    def count(self) -> int:
        """Points."""
        samples = 1 if self.samples is None else self.samples.count
        return math.prod(len(values) for values in self.axes.values()) * max(len(self.together), 1) * samples

    def points(self) -> Iterator[dict[str, Value]]:
        """Every point, in order; the last axis changes fastest."""
        for row in self.together or ({},):
            for sample in ({},) if self.samples is None else self.samples.points():
                for values in itertools.product(*self.axes.values()):
                    yield {**row, **sample, **dict(zip(self.axes, values, strict=True))}
