"""Designs of a study: their figures over the operating states, limits, and the Pareto front."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError, PlanError
from conveyor.laws.energy import YEAR, DutyStep, duty_sums
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.loop.annual_energy import annual_cost
from conveyor.models import Conveyor, Operation
from conveyor.models.fields import field_value
from conveyor.models.study import Changes, Limit, VariedSpec
from conveyor.models.validation_messages import Location
from conveyor.studies.points import OUTPUTS, Answer, select_outputs

Array: TypeAlias = NDArray[np.float64]
_FIGURE_NAME: Final = re.compile(r"(\S+)(?: (mean|lowest|highest|(\d+(?:\.\d+)?) ?%))?")
_YEARLY: Final = ("energy_per_year", "cost_per_year", "total_cost_per_year")
_PARTS_FIGURES: Final = ("capital_cost", "parts_cost_per_year")


@dataclass(frozen=True)
class DesignFigure:
    """A design figure: label, kind of quantity, outputs needed, and its function of outputs and operation [SI]."""

    label: str
    kind: str
    needs: tuple[str, ...]
    get: Callable[[Sequence[Array], Operation | None], float | None]


@dataclass(frozen=True)
class Design:
    """A design over its states.

    Attributes
    ----------
    number : int
        Of the design, from 1.
    changes : mapping
        Its fields, by path.
    figures : mapping of str to float or None
        By name [SI]; empty without an answer.
    why : str or None
        Reason if it has no answer.
    broken : tuple of str
        Limits exceeded.
    """

    number: int
    changes: Changes
    figures: Mapping[str, float | None]
    why: str | None
    broken: tuple[str, ...] = ()

    @property
    def keeps(self) -> bool:
        """True if it has an answer and keeps every limit."""
        return self.why is None and not self.broken


def figures_by_name(plan: VariedSpec, base: Conveyor) -> dict[str, DesignFigure]:
    """Figures of a plan's designs by name: those requested, then objectives and limited ones.

    Without any, the mean of every requested output over the states.

    Raises
    ------
    InputError
        A name is unknown, a yearly figure has no hours, or a limit is of another kind.
    """
    named = plan.figures or (() if plan.best or plan.limits else tuple(select_outputs(plan.outputs)))
    hours = plan.hours
    weights = np.ones(max(len(plan.rows), 1)) if hours is None else np.array(hours)
    if float(weights.sum()) * 3600.0 > YEAR and hours is not None:
        said = f"states: {weights.sum():g} h together; a year has at most {YEAR / 3600.0:g} h"
        raise PlanError([(("states",), said)])
    figures: dict[str, DesignFigure] = {}
    wrong: list[tuple[Location, str]] = []
    places: list[tuple[Location, str]] = [(("figures", i), name) for i, name in enumerate(named)]
    places += [((key, name), name) for key in ("best", "limits") for name in getattr(plan, key)]
    for place, name in places:
        try:
            figures.setdefault(name, _parse_figure(name, plan, base.operation, weights))
            if place[0] != "figures" or plan.figures:
                _require_fields(name, plan, base)
                require_year(name, plan, base)
            if place[0] == "limits":
                plan.limits[name].ends(name, figures[name].kind)
        except InputError as error:
            wrong.append((place, str(error)))
    if wrong:
        raise PlanError(wrong)
    return figures


def _require_fields(name: str, plan: VariedSpec, base: Conveyor) -> None:
    """Reject a figure if none of the fields it needs is in the spec or among those that vary."""
    needs = OUTPUTS[name.partition(" ")[0]].needs
    varied = [f"{path}." for path in plan.paths]
    given = (field_value(base, need) or any(f"{need}.".startswith(path) for path in varied) for need in needs)
    if needs and not any(given):
        raise InputError(f"{name}: the spec has no {' or '.join(needs)}")


def require_year(name: str, plan: VariedSpec, base: Conveyor) -> None:
    """Reject a yearly energy or cost that a single state of a spec's duty does not have.

    Raises
    ------
    InputError
        It is requested without states, or as a mean or an extreme of them.
    """
    key, _, how = name.partition(" ")
    if base.duty and key in _YEARLY and (how or plan.hours is None):
        raise InputError(f"{name}: the year of this spec is that of its duty; give states: duty, and {key}")


def _parse_figure(name: str, plan: VariedSpec, operation: Operation | None, weights: Array) -> DesignFigure:
    match = _FIGURE_NAME.fullmatch(name)
    if match is None or match[1] not in OUTPUTS:
        raise InputError(
            f'no figure "{name}"; expected one of {", ".join(OUTPUTS)}, and after it, over states, '
            'mean, lowest, highest or a percentile such as "95 %"'
        )
    key, how, percent = match.groups()
    output, many = OUTPUTS[key], len(weights) > 1
    if how is None and key in _YEARLY and (many or plan.hours is not None):
        return _yearly_figure(key, plan, operation, weights)
    if how is None and (key in _PARTS_FIGURES or output.of == "loads"):  # a take-up follows from the worst state
        return DesignFigure(output.label, output.kind, (key,), lambda values, _: float(np.max(values[0])))
    if how is None or how == "mean":
        label = f"{output.label}, mean" if many else output.label
        kind = "ratio" if many and output.kind == "count" else output.kind
        return DesignFigure(label, kind, (key,), lambda values, _: weighted_mean(values[0], weights))
    label = f"{output.label}, {how}" if many else output.label
    if percent is None:
        end = np.min if how == "lowest" else np.max
        return DesignFigure(label, output.kind, (key,), lambda values, _: float(end(values[0])))
    share = float(percent) / 100.0
    if not 0.0 < share < 1.0:
        raise InputError(
            f'figure "{name}": expected a percentile above 0 and below 100 %; of all there is {key} highest'
        )
    return DesignFigure(label, output.kind, (key,), lambda values, _: weighted_percentile(values[0], weights, share))


def _yearly_figure(key: str, plan: VariedSpec, operation: Operation | None, hours: Array) -> DesignFigure:
    """Yearly energy or cost over the states' hours, as for a duty; total cost with that of the parts."""
    if plan.hours is None:
        raise InputError(f"{key}: the states have no hours; give them hours, or ask for {key} mean")
    unpriced = (operation is None or operation.price is None) and "operation.price" not in plan.paths
    if key != "energy_per_year" and unpriced:
        raise InputError(f"{key}: the spec has no operation.price")
    parts = ("parts_cost_per_year",) if key == "total_cost_per_year" else ()

    def get(values: Sequence[Array], operation: Operation | None) -> float | None:
        steps = zip((3600.0 * hours).tolist(), *(one.tolist() for one in values[:2]), strict=True)
        sums = duty_sums([DutyStep(*step) for step in steps])
        if key == "energy_per_year":
            return JOULE_PER_KWH * sums.net_kwh
        energy = None if operation is None else annual_cost(operation, sums)
        return None if energy is None else energy + math.fsum(float(np.max(one)) for one in values[2:])

    return DesignFigure(OUTPUTS[key].label, OUTPUTS[key].kind, ("mains_power", "flow", *parts), get)


def weighted_mean(values: Array, weights: Array) -> float:
    """Weighted mean.

    Parameters
    ----------
    values, weights : ndarray
        Shape `(n,)`.

    Examples
    --------
    >>> weighted_mean(np.array([1.0, 4.0]), np.array([2.0, 1.0]))
    2.0
    """
    return float(weights @ values / weights.sum())


def weighted_percentile(values: Array, weights: Array, share: float) -> float:
    """Weighted percentile: the least value not exceeded for a share of the weight.

    Parameters
    ----------
    values, weights : ndarray
        Shape `(n,)`.
    share : float
        Between 0 and 1 [-].

    Examples
    --------
    >>> weighted_percentile(np.array([3.0, 1.0, 2.0]), np.array([10.0, 50.0, 40.0]), 0.9)
    2.0
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order])
    # the sum of hours rounds; a share that they reach exactly is reached
    at = int(np.searchsorted(reached, share * reached[-1] * (1.0 - 1e-12)))
    return float(values[order][at])


def reduce_states(
    plan: VariedSpec,
    figures: Mapping[str, DesignFigure],
    outputs: Sequence[str],
    answers: Sequence[Answer],
    operation: Operation | None,
) -> tuple[dict[str, float | None], str | None, tuple[str, ...]]:
    """Figures of a design from the answers of its states; reason if it has none; limits exceeded.

    Parameters
    ----------
    plan : VariedSpec
        With the limits.
    figures : mapping
        Design figures by name.
    outputs : sequence of str
        Keys of the answers' figures.
    answers : sequence
        One per state.
    operation : Operation or None
        Of the design.
    """
    known: list[Sequence[float | int | None]] = []
    for i, answer in enumerate(answers, start=1):
        if isinstance(answer, str):
            return {}, f"state {i}: {answer}" if len(answers) > 1 else answer, ()
        known.append(answer)
    columns = dict(zip(outputs, zip(*known, strict=True), strict=True))
    values: dict[str, float | None] = {}
    for name, figure in figures.items():
        needed = [columns[key] for key in figure.needs]
        missing = any(value is None for column in needed for value in column)
        arrays = [np.array(column, dtype=float) for column in needed if not missing]
        values[name] = None if missing else figure.get(arrays, operation)
    limits = plan.limits.items()
    broken = (name for name, one in limits if limit_excess(one, name, figures[name].kind, values[name]) > 0.0)
    return values, None, tuple(broken)


def limit_excess(limit: Limit, name: str, kind: str, value: float | None) -> float:
    """Excess of a figure over its limit, relative unless the limit is 0; infinite if the figure is unknown [-]."""
    if value is None:
        return float("inf")
    least, most = limit.ends(name, kind)
    over = [(end, sign * (value - end)) for end, sign in ((least, -1.0), (most, 1.0)) if end is not None]
    return max(0.0, *(beyond / (abs(end) or 1.0) for end, beyond in over))


def pareto_front(costs: Array) -> NDArray[np.bool_]:
    """Pareto front: mask of the points to which no other is as good in every cost and better in one.

    Parameters
    ----------
    costs : ndarray
        Shape `(n, m)`, less is better.

    Returns
    -------
    ndarray
        Shape `(n,)`.

    Examples
    --------
    >>> pareto_front(np.array([[1.0, 4.0], [2.0, 2.0], [3.0, 3.0], [4.0, 1.0]])).tolist()
    [True, True, False, True]
    """
    kept = np.zeros(len(costs), dtype=bool)
    best = np.empty((0, costs.shape[1]))
    for i in np.lexsort(costs.T[::-1]):  # none that comes later beats an earlier one
        if not np.any(np.all(best <= costs[i], axis=1) & np.any(best < costs[i], axis=1)):
            kept[i] = True
            best = np.vstack([best, costs[i]])
    return kept
