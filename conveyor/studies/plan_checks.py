"""Validation of a plan against its spec: all errors at once, each with its location in the plan."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from conveyor.errors import InputError, PlanError
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.base import Model
from conveyor.models.fields import field_value, with_fields
from conveyor.models.study import Value, VariedSpec
from conveyor.models.validation_messages import Location
from conveyor.studies.design_figures import figures_by_name
from conveyor.studies.points import select_outputs
from conveyor.units import Quantity, is_quantity, quantity

_MOST_PROBLEMS = 100
"""Most problems reported."""


class Problems:
    """Collected errors of a plan."""

    def __init__(self) -> None:
        self._found: list[tuple[Location, str]] = []

    @contextmanager
    def at(self, *location: int | str) -> Iterator[None]:
        """Record an error with its location."""
        try:
            yield
        except PlanError as error:
            self._found += error.problems
        except InputError as error:
            self._found.append((location, str(error)))

    def __len__(self) -> int:
        return len(self._found)

    def refuse(self) -> None:
        """Raise the recorded errors, if any."""
        if self._found:
            raise PlanError(self._found)


def refuse_unknown(plan: VariedSpec, base: Conveyor, resolve: Callable[[str], RubberCompound]) -> None:
    """Reject fields, values, compounds, figures and limits of a plan that cannot be right for its spec.

    A value outside its range makes a point without an answer instead.

    Raises
    ------
    PlanError
        All errors.
    """
    problems = Problems()
    known: dict[str, object] = {}
    seen: set[tuple[str, Value]] = set()
    for place, path, value in plan.placed:
        if path not in known:
            known[path] = None
            with problems.at(*place[: place.index(path) + 1]):
                known[path] = field_value(base, path)
                _refuse_drawn(plan, path, known[path])
        if (path, value) not in seen and len(problems) < _MOST_PROBLEMS:
            seen.add((path, value))
            with problems.at(*place):
                _refuse_other_kind(base, path, known[path], value, resolve)
                if path == "operation.price":
                    _refuse_other_currency(plan, base, value)
    for i, key in enumerate(plan.outputs):
        with problems.at("outputs", i):
            select_outputs([key])
    if not len(problems):
        with problems.at("figures"):
            figures_by_name(plan, base)
    problems.refuse()


def _refuse_drawn(plan: VariedSpec, path: str, like: object) -> None:
    if path in plan.drawn and isinstance(like, int):
        raise InputError(f"{path}: has no values between two others; list its values under axes")


def _refuse_other_kind(
    base: Conveyor, path: str, like: object, value: Value, resolve: Callable[[str], RubberCompound]
) -> None:
    """Reject an unknown compound, a value of the wrong dimension, or a value for a group of fields."""
    if isinstance(like, RubberCompound) and isinstance(value, str):
        resolve(value)
    elif is_quantity(like) and not _same_dimension(value, like):
        with_fields(base, {path: value})
    elif isinstance(like, Model | tuple):
        try:
            with_fields(base, {path: value})
        except InputError:
            raise InputError(f'{path}: got "{value}" for a group of fields; name one field of it') from None


def _refuse_other_currency(plan: VariedSpec, base: Conveyor, value: Value) -> None:
    """Reject an energy price in another currency than the study's costs."""
    operation = with_fields(base, {"operation.price": value}).operation
    price = None if operation is None else operation.price
    if price is not None and price.currency != plan.currency(base):
        raise InputError(f"operation.price: got {price}, the study's costs are in {plan.currency(base)}")


def _same_dimension(value: Value, like: Quantity) -> bool:
    try:
        return isinstance(value, str) and quantity(value).dimensionality == like.dimensionality
    except InputError:
        return False
