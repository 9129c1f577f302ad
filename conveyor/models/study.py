"""Studies and searches: a spec, the fields that vary, the figures wanted."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Annotated, Any, Literal, Self, TypeAlias, TypeVar

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from conveyor.errors import InputError, PlanError
from conveyor.models.base import AnyInteger, Model, Name, Problem, raise_problems
from conveyor.models.conveyor import Conveyor
from conveyor.models.fields import check_field_path
from conveyor.models.operation import PRICE_PATTERN
from conveyor.models.prices import Prices
from conveyor.models.validation_messages import Location, shown_value
from conveyor.models.variants import scale_quantity
from conveyor.text.ranges import range_error, range_values
from conveyor.units import interpolate_quantity, quantity, si, text
from conveyor.units.presentation import MONEY, display_unit

Value: TypeAlias = str | float | int | bool
"""Value of a field, as in specs."""
Changes: TypeAlias = Mapping[str, Value]
"""New field values by path."""
MOST_SAMPLES = 2**20
MOST_POINTS = 10_000_000
"""Most points of a study: more take weeks on a hundred cores."""
SEARCH_STEPS = 1000
"""Steps of a searched range."""
HOURS_KEY = "hours"
"""Key of the hours among the field paths of a state."""
DUTY_STATES = "duty"
"""Value of `states` that takes those of the spec's duty."""


_RANGE_EXAMPLE = 'from:to:step with a unit, such as "-20:40:5 degC"'


def _axis_values(given: Any) -> Any:
    """Values of `from:to:step unit`; lists unchanged."""
    if isinstance(given, list | tuple):
        for value in given:
            if not isinstance(value, Value) or (isinstance(value, float) and not math.isfinite(value)):
                raise _axis_error(f"got {shown_value(value)} among the values, expected numbers, texts, true or false")
        return given
    numbers, _, sign = str(given).strip().partition(" ")
    if not isinstance(given, str) or numbers.count(":") != 2:
        raise _axis_error(f"got {shown_value(given)}, expected a list, or {_RANGE_EXAMPLE}")
    try:
        why = range_error(numbers)
    except ValueError:
        why = f"expected {_RANGE_EXAMPLE}"
    if why:
        raise _axis_error(f"got {shown_value(given)}: {why}")
    values = [f"{value:.12g}" for value in range_values(numbers)]
    return [f"{value} {sign.strip()}" for value in values] if sign else [float(value) for value in values]


def _axis_error(message: str) -> PydanticCustomError:
    return PydanticCustomError("conflict", "{message}", {"message": message})


Axis = Annotated[tuple[Value, ...], BeforeValidator(_axis_values), Field(min_length=1)]


def hours_of(given: Value) -> float | None:
    """Hours of a number or a time; None for other values."""
    try:
        time = float(given) if isinstance(given, int | float) else si(quantity(given, "duration")) / 3600.0
    except InputError:
        return None
    return time if 0.0 < time < math.inf else None


Listable = TypeVar("Listable")


def _repeated_items(given: Sequence[Listable]) -> list[Listable]:
    """Items listed more than once."""
    return [one for one, times in Counter(given).items() if times > 1]


def merge_equal_states(rows: Iterable[Mapping[str, Value]]) -> tuple[dict[str, Value], ...]:
    """Merge states of equal field values; their hours add up."""
    hours: dict[tuple[tuple[str, Value], ...], float | None] = {}
    for row in rows:
        alike = tuple((path, value) for path, value in row.items() if path != HOURS_KEY)
        time = hours_of(row[HOURS_KEY]) if HOURS_KEY in row else None
        hours[alike] = time if time is None else time + (hours.get(alike) or 0.0)
    return tuple(dict(alike) | ({} if time is None else {HOURS_KEY: time}) for alike, time in hours.items())


class SampledRange(Model):
    """Between what a field is drawn."""

    low: str | float
    """One end."""
    high: str | float
    """Other end."""

    @model_validator(mode="after")
    def _alike(self) -> Self:
        try:
            ends = self.at(0.0), self.at(1.0)
        except InputError as error:
            raise_problems("SampledRange", [Problem((), str(error))])
        if ends[0] == ends[1]:
            raise_problems("SampledRange", [Problem((), f"both ends are {ends[0]}; change the base instead")])
        if self.falls:
            raise_problems("SampledRange", [Problem((), f"low is {ends[0]}, above high, which is {ends[1]}")])
        return self

    @property
    def falls(self) -> bool:
        """True if low is above high."""
        if isinstance(self.low, float) and isinstance(self.high, float):
            return self.low > self.high
        low, high, _ = _range_ends(*self._written)
        return low > high

    @property
    def _written(self) -> tuple[str, str]:
        low, high = (end if isinstance(end, str) else f"{end:g}" for end in (self.low, self.high))
        return low, high

    def at(self, share: float) -> Value:
        """Value between low and high, by its share of the range.

        Raises
        ------
        InputError
            The ends are of different kinds.
        """
        if isinstance(self.low, float) and isinstance(self.high, float):
            return self.low + share * (self.high - self.low)
        ends = _range_ends(*self._written)
        return f"{ends[0] + share * (ends[1] - ends[0]):.9g} {ends[2]}".strip()


@cache
def _range_ends(low: str, high: str) -> tuple[float, float, str]:
    """Both ends in the unit of the lower one, and that unit."""
    least, most = PRICE_PATTERN.fullmatch(low), PRICE_PATTERN.fullmatch(high)
    if least and most and least[2] == most[2]:
        return float(least[1]), float(most[1]), f"{least[2]}/kWh"
    one, other = quantity(low), interpolate_quantity(quantity(low), quantity(high), 1.0)
    return float(one.magnitude), float(other.magnitude), text(one).partition(" ")[2]


class Samples(Model):
    """Points drawn evenly from ranges of fields."""

    method: Literal["latin hypercube", "sobol"] = "sobol"
    """How points are spread; of Sobol's sequence a power of 2 is balanced."""
    count: Annotated[int, Field(ge=1, le=MOST_SAMPLES), AnyInteger]
    """Points."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1), AnyInteger] = 0
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
            # powers of two: a balanced sequence, and no warning of SciPy
            shares = drawn.random_base2(math.ceil(math.log2(self.count)))[: self.count]
        else:
            shares = drawn.random(self.count)
        for row in shares:
            yield {path: span.at(share) for (path, span), share in zip(ranges, row.tolist(), strict=True)}


Direction: TypeAlias = Literal["least", "most"]


class Limit(Model):
    """What a figure of a design has to keep."""

    least: str | float | None = None
    """Not below."""
    most: str | float | None = None
    """Not above."""

    @model_validator(mode="after")
    def _any(self) -> Self:
        if self.least is None and self.most is None:
            raise_problems("Limit", [Problem((), "missing: give least, most or both")])
        return self

    def ends(self, name: str, kind: str) -> tuple[float | None, float | None]:
        """Least and most allowed of a figure, by its name and kind [SI].

        Raises
        ------
        InputError
            The limits are of another kind.
        """
        least, most = _limit_value(self.least, name, kind), _limit_value(self.most, name, kind)
        if least is not None and most is not None and least > most:
            raise InputError(f"limits: {name}: least, {self.least}, is above most, {self.most}")
        return least, most


def _limit_value(end: str | float | None, name: str, kind: str) -> float | None:
    shown = None if kind.startswith(MONEY) or kind == "money" else display_unit(kind).label
    plain = shown in {None, "-"}
    if end is None or (isinstance(end, int | float) and plain):
        return None if end is None else float(end)
    try:
        given = quantity(str(end))
        if not plain and given.dimensionality == quantity(f"1 {shown}").dimensionality:
            return si(given)
    except InputError:
        pass
    like = "a number" if plain else f'a value such as "1 {shown}"'
    raise InputError(f'limits: {name}: got "{end}", expected {like}')


class VariedSpec(Model):
    """A spec, what of it varies, what every design meets, and what is sought."""

    name: Name
    """Of the study."""
    base: str
    """Spec, beside the study's file."""
    axes: Annotated[dict[str, Axis], Field(default_factory=dict)]
    """Values of fields, by path: a list, or `from:to:step unit`."""
    together: tuple[dict[str, Value], ...] = ()
    """Rows of fields that move together."""
    states: str | tuple[dict[str, Value], ...] = ()
    """What every design meets: rows of fields with their `hours`, a .csv beside the study, or `duty` of the spec."""
    outputs: tuple[str, ...] = ()
    """Figures of points by key; without, what `figures` need, else all."""
    figures: tuple[str, ...] = ()
    """Figures of a design over its states; without, the outputs' means."""
    best: Annotated[dict[str, Direction], Field(default_factory=dict)]
    """Figures of which the least or the most is sought; the first orders the designs."""
    limits: Annotated[dict[str, Limit], Field(default_factory=dict)]
    """What figures have to keep."""
    prices: Prices = Field(default_factory=lambda: Prices.from_data({}))
    """Of the parts, field by field before those of the library of prices."""

    @property
    def drawn(self) -> Mapping[str, SampledRange]:
        """Ranges of fields, sampled or searched."""
        return {}

    @property
    def placed(self) -> Iterator[tuple[Location, str, Value]]:
        """Listed values and ends of ranges: location in the plan, path of the field, value."""
        for path, values in self.axes.items():
            yield from ((("axes", path, i), path, value) for i, value in enumerate(values))
        for path, span in self.drawn.items():
            for name, end in (("low", span.low), ("high", span.high)):
                yield (*self._ranged, path, name), path, end
        for name, rows in (("together", self.together), ("states", self.rows)):
            for i, row in enumerate(rows):
                yield from (((name, i, path), path, value) for path, value in row.items() if path != HOURS_KEY)

    @property
    def _ranged(self) -> Location:
        """Location of the ranges in the plan."""
        return ("ranges",)

    @model_validator(mode="after")
    def _distinct(self) -> Self:
        problems, rows = [], self.rows
        states = tuple(path for row in rows for path in row if path != HOURS_KEY)
        for path in (
            *self.axes,
            *itertools.chain.from_iterable(self.together),
            *self.drawn,
            *dict.fromkeys(states),
        ):
            try:
                check_field_path(path)
            except InputError as error:
                problems.append(Problem((), str(error)))
        for name, given in (("together", self.together), ("states", rows)):
            if len({frozenset(row) for row in given}) > 1:
                problems.append(Problem((name,), "every row has to change the same fields"))
        problems += self._repeated()
        if any(set(row) <= {HOURS_KEY} for row in rows):
            problems.append(Problem(("states",), "every state has to change a field"))
        if rows and HOURS_KEY in rows[0]:
            problems += [
                Problem(("states", i, HOURS_KEY), f'got "{row[HOURS_KEY]}", expected a time such as "2200 h"')
                for i, row in enumerate(rows) if HOURS_KEY in row and hours_of(row[HOURS_KEY]) is None
            ]  # fmt: skip
        told = [*self.axes, *(self.together[0] if self.together else ()), *self.drawn]
        met = [path for path in (rows[0] if rows else ()) if path != HOURS_KEY]
        twice = sorted({path for path in (*told, *met) if [*told, *met].count(path) > 1})
        if twice:
            problems.append(Problem((), f"{', '.join(twice)}: varied twice; leave one of both"))
        if not told:
            problems.append(Problem((), f"nothing varies; give {self._ways}"))
        raise_problems(type(self).__name__, problems)
        return self

    def _repeated(self) -> Iterator[Problem]:
        """Refuse values and rows listed twice."""
        for path, values in self.axes.items():
            for value in _repeated_items(values):
                yield Problem(("axes", path), f'"{value}" is given twice; leave one of both')
        for name, rows in (("together", self.together), ("states", self.rows)):
            changes = [tuple((path, row[path]) for path in sorted(row) if path != HOURS_KEY) for row in rows]
            for row in _repeated_items(changes):
                said = ", ".join(f"{path}: {value}" for path, value in row)
                more = "; add its hours" if name == "states" else ""
                yield Problem((name,), f"{{{said}}} is given twice; leave one of both{more}")

    @property
    def _ways(self) -> str:
        return "axes or together"

    @property
    def rows(self) -> tuple[dict[str, Value], ...]:
        """States as rows; empty where they are named by text."""
        return () if isinstance(self.states, str) else self.states

    @property
    def hours(self) -> tuple[float, ...] | None:
        """Hours of each state in a year [h]; None where the states have none."""
        if not self.rows or HOURS_KEY not in self.rows[0]:
            return None
        return tuple(hours_of(row[HOURS_KEY]) or 0.0 for row in self.rows)

    def currency(self, base: Conveyor) -> str:
        """Currency of all costs: of the energy price in the spec, else of the prices."""
        energy = None if base.operation is None else base.operation.price
        return self.prices.currency if energy is None else energy.currency

    @property
    def design_fields(self) -> tuple[str, ...]:
        """Fields that distinguish designs, the slowest varying first."""
        return (*(self.together[0] if self.together else ()), *self.drawn, *self.axes)

    @property
    def paths(self) -> tuple[str, ...]:
        """All varying fields, the slowest first: of designs, then of states."""
        return (*self.design_fields, *self.met)

    @property
    def met(self) -> tuple[str, ...]:
        """Fields of states."""
        return tuple(path for path in (self.rows[0] if self.rows else ()) if path != HOURS_KEY)

    def points_of(self, design: Changes) -> Iterator[dict[str, Value]]:
        """Points of a design, one for each state."""
        for row in self.rows or ({},):
            yield {**design, **{path: value for path, value in row.items() if path != HOURS_KEY}}


Plan = TypeVar("Plan", bound=VariedSpec)


class StudyPlan(VariedSpec):
    """A spec and what of it varies: every value of every axis with every other, with every row and every sample."""

    samples: Samples | None = None
    """Points drawn evenly from ranges."""

    @property
    def count(self) -> int:
        """Number of points."""
        samples = 1 if self.samples is None else self.samples.count
        designs = math.prod(len(values) for values in self.axes.values()) * max(len(self.together), 1) * samples
        return designs * max(len(self.rows), 1)

    def designs(self) -> Iterator[dict[str, Value]]:
        """All designs in order; the last axis changes fastest."""
        for row in self.together or ({},):
            for sample in ({},) if self.samples is None else self.samples.points():
                for values in itertools.product(*self.axes.values()):
                    yield {**row, **sample, **dict(zip(self.axes, values, strict=True))}

    def points(self) -> Iterator[dict[str, Value]]:
        """All designs in all states; the state changes fastest."""
        for design in self.designs():
            yield from self.points_of(design)

    @property
    def drawn(self) -> Mapping[str, SampledRange]:
        """Ranges of sampled fields."""
        return {} if self.samples is None else self.samples.fields

    @property
    def _ranged(self) -> Location:
        return "samples", "fields"

    @model_validator(mode="after")
    def _countable(self) -> Self:
        if self.count > MOST_POINTS:
            message = f"{self.count:,} points, at most {MOST_POINTS:,}; take coarser steps, or samples"
            raise_problems("StudyPlan", [Problem((), message)])
        return self

    @property
    def _ways(self) -> str:
        return "axes, together or samples"


class SearchPlan(VariedSpec):
    """What is varied to find the best: fields between two ends, and listed ones."""

    ranges: Annotated[dict[str, SampledRange], Field(default_factory=dict)]
    """Between what a field is searched, by path, in steps of a thousandth."""
    population: Annotated[int, Field(ge=2, le=100), AnyInteger] = 8
    """Designs of a generation for each field that varies."""
    generations: Annotated[int, Field(ge=1, le=10_000), AnyInteger] = 40
    """At most."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1), AnyInteger] = 0
    """Of the random numbers: the same seed tries the same designs."""

    @property
    def drawn(self) -> Mapping[str, SampledRange]:
        """Ranges of searched fields."""
        return self.ranges

    @property
    def _ways(self) -> str:
        return "ranges, axes or together"

    @model_validator(mode="after")
    def _sought(self) -> Self:
        problems = [
            Problem(("axes", path), "one value leaves no choice; give more, or change the base")
            for path, values in self.axes.items()
            if len(values) < 2
        ]
        if len(self.best) != 1:
            problems.append(Problem(("best",), "expected one figure, such as {motor_power: least}"))
        if len(self.together) == 1:
            problems.append(Problem(("together",), "one row leaves no choice; give more, or change the base"))
        raise_problems("SearchPlan", problems)
        return self

    @property
    def choices(self) -> tuple[tuple[Mapping[str, Value], ...], ...]:
        """Lists to choose from: the rows, and each axis."""
        listed = tuple(tuple({path: value} for value in values) for path, values in self.axes.items())
        return (*((self.together,) if self.together else ()), *listed)

    def design(self, shares: Sequence[float]) -> dict[str, Value]:
        """Design from the share of each range and the index in each list."""
        values: dict[str, Value] = {}
        for (path, span), share in zip(self.ranges.items(), shares, strict=False):
            values[path] = span.at(round(share * SEARCH_STEPS) / SEARCH_STEPS)
        for listed, number in zip(self.choices, shares[len(self.ranges) :], strict=True):
            values |= listed[round(number)]
        return {path: values[path] for path in self.design_fields}


def with_states(plan: Plan, base: Conveyor) -> Plan:
    """Plan with the spec's duty as its states, where `states` is "duty".

    Raises
    ------
    InputError
        The spec has no duty, or the states are in a file that was not read.
    """
    if not isinstance(plan.states, str):
        return plan
    if plan.states != DUTY_STATES:
        said = f'states: "{plan.states}" was not read; read_plan reads a study with its files'
        raise PlanError([(("states",), said)])
    if not base.duty:
        raise PlanError([(("states",), "states: duty: the spec has no operation.duty")])
    ambient, rows = base.ambient, []
    for entry in base.duty:
        row: dict[str, Value] = {
            HOURS_KEY: text(entry.hours),
            "material.flow": text(scale_quantity(base.material.flow, entry.load)),
        }
        if any(one.speed is not None for one in base.duty):
            row["belt.speed"] = text(base.belt.speed if entry.speed is None else entry.speed)
        if any(one.temperature is not None for one in base.duty):
            at = ambient.belt if entry.temperature is None else entry.temperature
            row["ambient.temperature"] = text(at)
            if ambient.belt_temperature is not None:
                air = si(ambient.temperature) + si(at) - si(ambient.belt)
                row |= {"ambient.temperature": f"{air:.9g} K", "ambient.belt_temperature": text(at)}
        rows.append(row)
    return plan.replace(states=merge_equal_states(rows))
