"""Load curves of many scenes side by side: what a comparison of compounds, temperatures and speeds asks for.

curve.py for narrow contacts (narrow.py), with the scenes stacked: half widths of the lightest and heaviest load at
order 8, the points of every curve in one batch, at the order and degree that meet rtol. A scene that is not plainly
narrow is sampled by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments import checked
from conveyor.contact.bessel import ProductIK
from conveyor.contact.checks import (
    ENERGY_OVER_ERROR,
    may_touch_elsewhere,
    order_error,
    pulling_and_pressing,
    relative_difference,
)
from conveyor.contact.curve import MARGIN, SIGN_FLOOR, LoadCurve, load_curve
from conveyor.contact.energy import friction_by_loss
from conveyor.contact.lobatto import interpolated, points
from conveyor.contact.narrow import (
    CHUNK,
    LOW_ORDER_FROM,
    RANGE,
    ROOM,
    Group,
    Search,
    chosen_rows,
    fits,
    guess,
    plain,
)
from conveyor.contact.orders import NARROW_ORDERS
from conveyor.contact.problem import ContactProblem, check_rtol
from conveyor.contact.scene import instantly_relaxed
from conveyor.contact.short_rule import ShortRule, grades_for, panels_beyond, short_rule
from conveyor.contact.solution import SolveStats
from conveyor.contact.spectral import Contact, assemble, equilibrium
from conveyor.errors import InputError, NoSolutionError

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_DEGREES = (12, 16, 32)
_LOW_DEGREE_FROM = 1e-4  # rtol that degree 12 may meet over a factor of 100 in load


@checked
def load_curves(
    problems: Sequence[ContactProblem], lowest: ArrayLike, highest: ArrayLike, rtol: float = 1e-6
) -> list[LoadCurve | NoSolutionError]:
    """Load curves of many scenes, in their order; where there is none, the error that says why.

    Parameters
    ----------
    problems : sequence of ContactProblem
        The scenes; their own pressures are not used.
    lowest, highest : array_like, shape (b,)
        Range of p̃_m of each [-].
    rtol : float
        Relative error of friction asked for [-].

    Raises
    ------
    InputError
        Lengths that differ, or lowest > highest.

    Examples
    --------
    >>> from conveyor.contact import CreepSpectrum
    >>> creep = CreepSpectrum(0.1, [0.9], [0.01])
    >>> scene = ContactProblem("confined", 0.066, 0.004, creep, 0.03)
    >>> one, other = load_curves([scene, replace(scene, radius=0.05)], [0.001, 0.001], [0.004, 0.004])
    >>> bool(one.at(0.004).friction < other.at(0.004).friction)
    True
    """
    check_rtol(rtol)
    low, high = np.asarray(lowest, dtype=float), np.asarray(highest, dtype=float)
    if not (low.shape == high.shape == (len(problems),) and np.all((low > 0.0) & (low <= high))):
        raise InputError("lowest and highest: one of each for every scene, 0 < lowest <= highest")
    loaded = [replace(problem, pressure=float(p)) for problem, p in zip(problems, high, strict=True)]
    found = _narrow(loaded, low, rtol)
    return [
        found[i] if i in found else _alone(problem, float(low[i]), rtol) for i, problem in enumerate(loaded)
    ]


def _alone(problem: ContactProblem, lowest: float, rtol: float) -> LoadCurve | NoSolutionError:
    try:
        return load_curve(problem, lowest, problem.pressure, rtol)
    except NoSolutionError as error:
        return error


def _narrow(problems: list[ContactProblem], lowest: Array, rtol: float) -> dict[int, LoadCurve]:
    """Curves of the plainly narrow scenes, by their place in the list."""
    kinds: dict[tuple[str, bool], list[int]] = {}
    creeps = [instantly_relaxed(problem.creep) for problem in problems]
    for i, problem in enumerate(problems):
        if plain(problem, creeps[i]):
            kinds.setdefault((str(problem.support), np.isinf(problem.thickness)), []).append(i)
    grade = grades_for(rtol)[0]
    curves: dict[int, LoadCurve] = {}
    for members in kinds.values():
        group = Group.of([problems[i] for i in members], [creeps[i] for i in members])
        widest = ROOM * guess(group)
        panels = panels_beyond(group.layers.reach(grade.depth), widest, grade)
        order = np.flatnonzero(fits(group, widest, grade))
        order = order[np.lexsort((widest[order], panels[order]))]
        step = max(1, CHUNK // _DEGREES[0])
        for start in range(0, order.size, step):
            chosen = order[start : start + step]
            batch = _Batch.of(group[chosen], np.log(lowest[[members[k] for k in chosen]]), rtol)
            for row, curve in ({} if batch is None else batch.curves(rtol)).items():
                curves[members[chosen[row]]] = curve
    return curves


@dataclass(frozen=True, eq=False)
class _Batch:
    """Scenes whose half widths at both ends are known; `rows` are their places in the chunk."""

    group: Group
    lowest: Array
    centre: Array
    half: Array
    rule: ShortRule
    check: ShortRule
    floor: float
    rows: Index

    @classmethod
    def of(cls, group: Group, log_lowest: Array, rtol: float) -> _Batch | None:
        """Half widths of the lightest and the heaviest loads; None where no scene of the chunk is narrow."""
        solving, checking = grades_for(rtol)
        size = log_lowest.size
        alpha_high = guess(group)
        light = replace(group, target=log_lowest)
        both = replace(group[np.tile(np.arange(size), 2)], target=np.concatenate([log_lowest, group.target]))
        rough = short_rule(group.layers, group.creeps, ROOM * alpha_high, solving)
        search = Search(both, rough[np.tile(np.arange(size), 2)], np.concatenate([guess(light), alpha_high]))
        ends = search.middle + RANGE * search.place
        low, high = ends[:size], ends[size:]
        alive = search.alive[:size] & search.alive[size:] & (high >= low)
        centre, half = 0.5 * (low + high), 0.5 * np.maximum(high - low, 0.0) + MARGIN
        widest = np.exp(centre + half)
        rows = np.flatnonzero(alive & fits(group, widest, solving))
        if rows.size == 0:
            return None
        group, widest = group[rows], widest[rows]
        rule = short_rule(group.layers, group.creeps, widest, solving)
        check = short_rule(group.layers, group.creeps, widest, checking, rule.unit)
        return cls(group, log_lowest[rows], centre[rows], half[rows], rule, check, solving.error, rows)

    def curves(self, rtol: float) -> dict[int, LoadCurve]:
        """Raise order and degree until each curve meets rtol; those that need more, or pull, are left out."""
        waiting = np.arange(self.rows.size)
        found: dict[int, LoadCurve] = {}
        for degree in _DEGREES[0 if rtol >= _LOW_DEGREE_FROM else 1 :]:
            coarse: list[Index] = []
            for n in NARROW_ORDERS[0 if rtol >= LOW_ORDER_FROM else 1 :]:
                if waiting.size:
                    waiting, missed = self._sampled(n, degree, waiting, rtol, found)
                    coarse.append(missed)
            waiting = np.concatenate(coarse) if coarse else waiting[:0]
        return found

    def _sampled(
        self, n: int, degree: int, rows: Index, rtol: float, found: dict[int, LoadCurve]
    ) -> tuple[Index, Index]:
        """Sample some rows; curves that meet rtol go into `found`, rows that need a higher order or degree go back."""
        count = degree + 1
        alpha = np.exp(self.centre[rows, None] + self.half[rows, None] * points(degree)).ravel()
        every = np.repeat(rows, count)
        rho, creeps = self.group.rho[every], self.group.creeps[every]
        ik = ProductIK(n, alpha[:, None] / creeps.times)
        matrix = assemble(self.rule[every], creeps, alpha, n, ik)
        contact = equilibrium(matrix, alpha, rho)
        good = (contact.inside & (contact.pressure > 0.0)).reshape(-1, count).all(axis=1)
        if not good.any():
            return rows[:0], rows[:0]
        if not good.all():
            keep = np.repeat(good, count)
            rows, every, rho, creeps = rows[good], every[keep], rho[keep], creeps[keep]
            contact, matrix = chosen_rows(contact, np.flatnonzero(keep)), matrix[keep]
            ik = ik[np.flatnonzero(keep)]
        error = order_error(contact, matrix, rho, _exponent(contact, count)).reshape(-1, count).max(axis=1)
        by_loss = friction_by_loss(self.check[every], creeps, contact, rho, ik)
        energy = np.abs(relative_difference(by_loss, contact.friction)).reshape(-1, count).max(axis=1)
        error = np.maximum(np.maximum(error, energy / ENERGY_OVER_ERROR), self.floor)
        _, pressing = pulling_and_pressing(contact, max(float(error.max()), SIGN_FLOOR))
        plainly = (pressing & ~may_touch_elsewhere(contact, rho)).reshape(-1, count).all(axis=1)
        columns, missed = interpolated(contact, rho, degree)
        met = error <= rtol
        for k in np.flatnonzero(met & plainly & (missed <= rtol)):
            part = chosen_rows(contact, np.arange(k * count, (k + 1) * count))
            found[int(self.rows[rows[k]])] = self._curve(
                int(rows[k]), part, columns[k], (max(error[k], missed[k]), energy[k]), n
            )
        return np.asarray(rows[~met]), np.asarray(rows[met & plainly & (missed > rtol)])

    def _curve(
        self, row: int, contacts: Contact, columns: Array, errors: tuple[float, float], n: int
    ) -> LoadCurve:
        problem = self.group.problems[row]
        return LoadCurve(
            problem=problem,
            lowest=float(np.exp(self.lowest[row])),
            highest=problem.pressure,
            error=float(errors[0]),
            energy_error=float(errors[1]),
            stats=SolveStats(
                n,
                contacts.alpha.size,
                self.rule.nodes.shape[-1],
                self.group.given[row].weights.size,
                way="curve",
            ),
            _centre=float(self.centre[row]),
            _half=float(self.half[row]),
            _contacts=contacts,
            _columns=columns,
        )


def _exponent(contact: Contact, count: int) -> Array:
    """β = d ln μ/d ln p along each curve; zero where nothing is lost."""
    lossy = contact.friction > 0.0
    log_mu = np.log(np.where(lossy, contact.friction, 1.0)).reshape(-1, count)
    log_p = np.log(contact.pressure).reshape(-1, count)
    beta = np.asarray(np.gradient(log_mu, axis=1)) / np.asarray(np.gradient(log_p, axis=1))
    return np.where(lossy, beta.ravel(), 0.0)
