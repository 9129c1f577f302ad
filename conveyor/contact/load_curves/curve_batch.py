"""Load curves of many contact problems in a batch.

Half widths of the lightest and heaviest load come first, then contacts at Chebyshev points between them, all curves of
a batch together. The number of points follows at a low order; the order that meets the tolerance is predicted from a
few of the points, and solved at these only. Contacts that are not plainly narrow are sampled one by one, with the full
rule, between contacts of the general solver.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.argument_types import check_arguments
from conveyor.contact.galerkin.galerkin_tables import GalerkinTables
from conveyor.contact.galerkin.orders import ORDERS, lowest_order, next_order
from conveyor.contact.galerkin.quadrature import CHECK_PANELS, SOLVE_PANELS, build_rule
from conveyor.contact.galerkin.sampling import (
    SampledContacts,
    curve_error,
    lobatto_derivative,
    lobatto_points,
)
from conveyor.contact.galerkin.short_rule import (
    ShortRule,
    as_short_rule,
    panel_count,
    rule_grades,
    short_rules,
)
from conveyor.contact.galerkin.spectral import (
    Contact,
    select_contacts,
    solve_equilibrium,
    solve_nested_equilibrium,
)
from conveyor.contact.load_curves.load_curve import LoadCurve, LoadSolutions
from conveyor.contact.problem import ContactProblem, check_rtol
from conveyor.contact.solution import ContactSolution, SolveStats
from conveyor.contact.solvers.acceptance import (
    energy_errors,
    may_touch_elsewhere,
    order_errors,
    pressure_signs,
)
from conveyor.contact.solvers.entry import solve
from conveyor.contact.solvers.one_strip_batch import (
    CHUNK_SIZE,
    PLACE_SHARE,
    ROUGH_RTOL,
    SEARCH_RANGE,
    WIDTH_ROOM,
    ProblemBatch,
    group_by_layer,
    guess_half_widths,
    plainly_narrow,
)
from conveyor.contact.solvers.refinement import ROUNDING, SIGN_ORDER
from conveyor.contact.solvers.solver_state import merge_instant_terms
from conveyor.errors import InputError, NoSolutionError

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_DEGREES = (8, 12, 16, 32, 64, 128)
_LOW_DEGREE_FROM = 2e-5  # rtol that degree 8 may meet over a factor of 4 in load
_FEW_DEGREE = 4  # degree that carries what a higher order changes
_RANGE_MARGIN = 1e-2  # the sampled range of ln α goes this far beyond the loads of the curve
_BETWEEN_FACTOR = 1.25  # errors between the five checked points over errors at them: 1.03 seen
_ENDS_RTOL = 1e-3  # the ends need to be known only well enough to be enclosed
_WRAP_EXTENT = 0.75  # (a + |e|)/R beyond which one half width may have two loads (docs/method.md)
_OFF_ROLL = (
    "a half width has no contact with both edges on the roll: lower the load, enlarge the radius, or solve such loads "
    "one by one, which names the limit"
)
_NOT_ENCLOSED = "the curve's ends are not known well enough: solve such loads one by one"
_SPLITS = (
    "the contact separates into several strips: lower the load, thicken the layer, use the confined support, "
    "or solve such loads one by one"
)


@check_arguments
def load_curve(problem: ContactProblem, lowest: float, highest: float, rtol: float = 1e-6) -> LoadCurve:
    """Sample a contact between two loads until friction is known to `rtol` anywhere between.

    Parameters
    ----------
    problem : ContactProblem
        Layer, roll and rubber; its own pressure is not used.
    lowest, highest : float
        Range of p̃_m [-].
    rtol : float
        Relative error of friction allowed [-].

    Raises
    ------
    InputError
        lowest > highest.
    NoSolutionError
        A load of the range has no single-strip contact, or the tolerance was not reached.
    """
    if not 0.0 < lowest <= highest:
        raise InputError(f"loads from {lowest!r} to {highest!r}: give 0 < lowest <= highest")
    (curve,) = load_curves([problem], [lowest], [highest], rtol)
    if isinstance(curve, NoSolutionError):
        raise curve
    return curve


@check_arguments
def load_curves(
    problems: Sequence[ContactProblem], lowest: ArrayLike, highest: ArrayLike, rtol: float = 1e-6
) -> list[LoadCurve | NoSolutionError]:
    """Load curves of many problems, in their order, each a LoadCurve or the error that prevented it.

    Parameters
    ----------
    problems : sequence of ContactProblem
        Layers, rolls and rubbers; their own pressures are not used.
    lowest, highest : array_like, shape (b,)
        Range of p̃_m of each [-].
    rtol : float
        Relative error of friction allowed [-].

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
    by_row = _narrow_curves(loaded, low, rtol)
    return [by_row[i] if i in by_row else _wide_curve(problem, float(low[i]), rtol) for i, problem in enumerate(loaded)]


@check_arguments
def solve_loads(problem: ContactProblem, pressures: ArrayLike, rtol: float = 1e-6) -> LoadSolutions:
    """Solve one problem under many loads with one shared set-up.

    Loads whose contact splits or wraps the roll are solved one by one.

    Parameters
    ----------
    problem : ContactProblem
        Layer, roll and rubber; its own pressure is not used.
    pressures : array_like
        Mean pressures p̃_m [-], positive.
    rtol : float
        Relative error of friction allowed [-].

    Returns
    -------
    LoadSolutions
        Arrays of the shape of `pressures`.

    Raises
    ------
    InputError, NoSolutionError
        As `solve`.

    Examples
    --------
    >>> from conveyor.contact import CreepSpectrum
    >>> creep = CreepSpectrum(0.1, [0.9], [1.0])
    >>> loads = solve_loads(ContactProblem("half-space", 0.4, 0.05, creep), [0.01, 0.05])
    >>> loads.friction.round(6).tolist()
    [0.086769, 0.192195]
    """
    try:
        p = np.asarray(pressures, dtype=float)
    except (TypeError, ValueError):
        raise InputError("pressures: give numbers, one or more finite positive mean pressures") from None
    if p.size == 0 or not np.all(np.isfinite(p) & (p > 0.0)):
        raise InputError("pressures: give one or more finite positive mean pressures")
    try:
        return load_curve(problem, float(p.min()), float(p.max()), rtol).at(p)
    except NoSolutionError:
        return _solve_separately(problem, p, rtol)


def wraps_roll(solution: ContactSolution) -> bool:
    """True where a contact reaches so far round the roll that one half width may carry two loads."""
    return solution.outer_edge > _WRAP_EXTENT


def _solve_separately(problem: ContactProblem, pressures: Array, rtol: float) -> LoadSolutions:
    solved = [solve(replace(problem, pressure=float(p)), rtol) for p in pressures.ravel()]
    column = partial(_solution_column, solved, pressures.shape)
    return LoadSolutions(
        pressure=pressures,
        friction=column("friction"),
        half_width=column("half_width"),
        eccentricity=column("eccentricity"),
        dissipation=column("dissipation"),
        energy_error=column("energy_error"),
        error_estimate=column("error_estimate"),
        stats=max((s.stats for s in solved), key=lambda stats: stats.order),
        _form_figure=column,
    )


def _solution_column(solved: list[ContactSolution], shape: tuple[int, ...], name: str) -> Array:
    return np.array([getattr(solution, name) for solution in solved]).reshape(shape)


def _narrow_curves(problems: list[ContactProblem], lowest: Array, rtol: float) -> dict[int, LoadCurve]:
    """Curves of the plainly narrow contacts, by their place in the list."""
    creeps = [merge_instant_terms(problem.creep) for problem in problems]
    grade = rule_grades(rtol)[0]
    curves: dict[int, LoadCurve] = {}
    for members in group_by_layer(problems):
        group = ProblemBatch.of([problems[i] for i in members], [creeps[i] for i in members])
        high = guess_half_widths(group)
        light = lowest[members]
        low = guess_half_widths(replace(group, target=np.log(light)))
        panels = panel_count(group.layers.reach(grade.depth), high, grade)
        order = np.flatnonzero(plainly_narrow(group, WIDTH_ROOM * high, grade))
        order = order[np.lexsort((high[order], panels[order]))]
        step = max(1, CHUNK_SIZE // _DEGREES[1])
        for start in range(0, order.size, step):
            chosen = order[start : start + step]
            sampler = _narrow_sampler(group[chosen], light[chosen], (low[chosen], high[chosen]), rtol)
            for row, curve in sampler.curves(rtol).items():
                if isinstance(curve, LoadCurve):
                    curves[members[chosen[row]]] = curve
    return curves


def _narrow_sampler(group: ProblemBatch, lowest: Array, guesses: tuple[Array, Array], rtol: float) -> _CurveSampler:
    """Sampler between the half widths guessed for the lightest and heaviest loads, with room to both sides."""
    grades = rule_grades(rtol)
    low, high = np.log(guesses[0]) - SEARCH_RANGE, np.log(guesses[1]) + SEARCH_RANGE
    rule, check = short_rules(group.layers, group.creeps, np.exp(high), grades)
    rows = np.arange(lowest.size)
    return _CurveSampler(
        group,
        lowest,
        0.5 * (low + high),
        0.5 * (high - low),
        rule,
        check,
        grades[0].floor(group.layers),
        rows,
        narrow=True,
    )


def _wide_curve(problem: ContactProblem, lowest: float, rtol: float) -> LoadCurve | NoSolutionError:
    """Curve of a contact that is not plainly narrow, between half widths of the general solver."""
    highest = problem.pressure
    try:
        ends = [solve(replace(problem, pressure=p), _ENDS_RTOL) for p in (lowest, highest)]
        low, high = np.log([s.half_width * problem.rho for s in ends])
        if any(len(s.patches) > 1 for s in ends):
            return _no_curve_error(lowest, highest, _SPLITS)
        if wraps_roll(ends[1]):
            return NoSolutionError(
                f"at the mean pressure {highest:.6g} the contact reaches {ends[1].outer_edge:.2f} R: too far round "
                "the roll for a load curve, solve such loads one by one"
            )
        centre, half = 0.5 * (low + high), 0.5 * (high - low) + _RANGE_MARGIN
        group = ProblemBatch.of([problem], [merge_instant_terms(problem.creep)])
        layer, widest = problem.layer, float(np.exp(centre + half))
        rule, check = (
            as_short_rule(build_rule(layer, group.given[0], widest, p)) for p in (SOLVE_PANELS, CHECK_PANELS)
        )
    except NoSolutionError as error:
        return error
    one = np.zeros(1, dtype=int)
    sampler = _CurveSampler(
        group,
        np.array([lowest]),
        np.array([centre]),
        np.array([half]),
        rule,
        check,
        ROUNDING,
        one,
        narrow=False,
    )
    return sampler.curves(rtol)[0]


@dataclass(frozen=True, eq=False)
class _CurveSampler:
    """Sampling of problems whose half widths at both ends are known; `rows` are their places in the chunk."""

    group: ProblemBatch
    lowest: Array
    centre: Array
    half: Array
    rule: ShortRule
    check: ShortRule
    floor: float  # of the error, by the rule
    rows: Index
    narrow: bool  # a strip that may touch elsewhere is left to the general solver

    def curves(self, rtol: float) -> dict[int, LoadCurve | NoSolutionError]:
        """Curves or errors by row; rows without an entry are left to the general solver."""
        by_row: dict[int, LoadCurve | NoSolutionError] = {}
        n = lowest_order(rtol)
        waiting = np.arange(self.rows.size)
        for degree in _DEGREES[0 if rtol >= _LOW_DEGREE_FROM else 1 : 4 if self.narrow else None]:
            if waiting.size == 0:
                break
            first = self._sample(waiting, lobatto_points(degree), n, rtol)
            for row in waiting[~first.valid]:
                by_row[int(self.rows[row])] = self._none(row, _OFF_ROLL)
            # ends that are known at their own order need not enclose the loads at this one
            plain = self._enclosed(first) if self.narrow else True
            first = first[np.flatnonzero(first.valid & plain)]
            waiting = first.rows
            if waiting.size == 0:
                break
            miss = curve_error(first.contact, np.repeat(self.group.rho[waiting], degree + 1), degree)
            enough = (miss <= rtol) | (degree == _DEGREES[-1])
            if enough.any():
                self._settle(first[np.flatnonzero(enough)], miss[enough], rtol, by_row)
            waiting = waiting[~enough]
        return by_row

    def _sample(self, rows: Index, t: Array, n: int, rtol: float) -> _ContactBatch:
        """Contacts of order n of these rows at places t of their half width."""
        alpha = np.exp(self.centre[rows, None] + self.half[rows, None] * t).ravel()
        every = np.repeat(rows, t.size)
        tabled = GalerkinTables.of(self.group.creeps[every], alpha)
        matrix = tabled.matrices(self.rule[every], n)
        contact = solve_equilibrium(matrix, alpha, self.group.rho[every], tolerance=PLACE_SHARE * rtol)
        valid = (contact.inside & (contact.pressure > 0.0)).reshape(-1, t.size).all(axis=1)
        return _ContactBatch(rows, t.size, contact, matrix, tabled, np.asarray(valid))

    def _enclosed(self, batch: _ContactBatch) -> NDArray[np.bool_]:
        """True where the sampled loads enclose those of the curve; guessed half widths may not."""
        pressure = batch.contact.pressure.reshape(-1, batch.count)
        highest = np.exp(self.group.target[batch.rows])
        return np.asarray((pressure[:, 0] >= highest) & (pressure[:, -1] <= self.lowest[batch.rows]))

    def _settle(
        self, first: _ContactBatch, miss: Array, rtol: float, curves: dict[int, LoadCurve | NoSolutionError]
    ) -> None:
        """Raise the order until each curve meets rtol, at a few of the points where all contacts press."""
        exponent = _friction_exponents(first)
        todo = {(first.order, False): list(range(first.rows.size))}
        while todo:
            n, thin = min(todo)
            places = np.array(todo.pop((n, thin)))
            batch = (
                first[places]
                if n == first.order
                else self._sample(first.rows[places], lobatto_points(_FEW_DEGREE if thin else first.count - 1), n, rtol)
            )
            error, energy, by_loss = self._errors(batch.few(), exponent[places], rtol)
            pulling, pressing, tension = (one.reshape(-1, batch.count) for one in pressure_signs(batch.contact, rtol))
            worst = np.max([_BETWEEN_FACTOR * error, by_loss, tension.max(axis=1)], axis=0).clip(min=self.floor)
            enclosed = self._enclosed(batch)
            for k, place in enumerate(places.tolist()):
                row = int(first.rows[place])
                finer = thin and n > first.order
                sampled = SampledContacts(first.of(place), batch.of(k)) if finer else SampledContacts(batch.of(k))
                left = sampled.left(float(self.group.rho[row]))
                total = max(float(worst[k]), float(miss[place]) + left)
                plain = bool(pressing[k].all())
                key = int(self.rows[row])
                if not batch.valid[k]:
                    curves[key] = self._none(row, _OFF_ROLL)
                elif pulling[k].any():
                    curves[key] = self._none(row, _SPLITS)
                elif total <= rtol and (plain or n >= SIGN_ORDER):
                    touches = may_touch_elsewhere(sampled.contacts, self.group.rho[row]).any()
                    if enclosed[k] and not (self.narrow and touches):
                        curves[key] = self._curve(row, sampled, (total, float(energy[k])), n)
                    elif not self.narrow:
                        curves[key] = self._none(row, _NOT_ENCLOSED)
                elif n == ORDERS[-1]:
                    curves[key] = _accuracy_error(total)
                elif worst[k] <= rtol and plain:  # a few points do not carry what the order changes
                    todo.setdefault((n, False), []).append(place)
                else:
                    more = max(_BETWEEN_FACTOR * float(error[k]), float(by_loss[k]))
                    todo.setdefault((next_order(n, more / rtol), plain), []).append(place)

    def _errors(self, batch: _ContactBatch, exponent: Array, rtol: float) -> tuple[Array, Array, Array]:
        """Largest error of each row by order, of the energy, and of friction by the energy."""
        rho = np.repeat(self.group.rho[batch.rows], batch.count)
        every = np.repeat(batch.rows, batch.count)
        _, lower = solve_nested_equilibrium(batch.matrix, batch.contact.alpha, rho, batch.contact.eps, ROUGH_RTOL)
        by_order = order_errors(batch.contact, lower, exponent.ravel())
        orders = batch.contact, lower
        each = energy_errors(batch.tabled, self.check[every], orders, rho, most=by_order.most, rtol=rtol)
        error, energy, bound = (one.reshape(-1, batch.count).max(axis=1) for one in (by_order.friction, *each))
        return error, energy, bound

    def _none(self, row: int, why: str) -> NoSolutionError:
        return _no_curve_error(float(self.lowest[row]), self.group.problems[row].pressure, why)

    def _curve(self, row: int, sampled: SampledContacts, errors: tuple[float, float], n: int) -> LoadCurve:
        problem = self.group.problems[row]
        matrices = sampled.contacts.alpha.size + (0 if sampled.finer is None else sampled.finer.alpha.size)
        terms = self.group.given[row].weights.size
        return LoadCurve(
            problem=problem,
            lowest=float(self.lowest[row]),
            highest=problem.pressure,
            error=errors[0],
            energy_error=errors[1],
            stats=SolveStats(n, matrices, self.rule.nodes.shape[-1], terms, way="curve"),
            _centre=float(self.centre[row]),
            _half=float(self.half[row]),
            _sampled=sampled,
        )


@dataclass(frozen=True, eq=False)
class _ContactBatch:
    """Contacts of several rows, `count` per row in sequence; `valid` where all of a row are on the roll."""

    rows: Index
    count: int
    contact: Contact
    matrix: Array
    tabled: GalerkinTables
    valid: NDArray[np.bool_]

    @property
    def order(self) -> int:
        return int(self.matrix.shape[2])

    def _part(self, at: Index, rows: Index, count: int) -> _ContactBatch:
        return _ContactBatch(
            self.rows[rows],
            count,
            select_contacts(self.contact, at),
            self.matrix[at],
            self.tabled[at],
            self.valid[rows],
        )

    def __getitem__(self, rows: Index) -> _ContactBatch:
        return self._part((rows[:, None] * self.count + np.arange(self.count)).ravel(), rows, self.count)

    def few(self) -> _ContactBatch:
        """The batch at five of its points."""
        if self.count == _FEW_DEGREE + 1:
            return self
        rows, some = np.arange(self.rows.size), np.arange(0, self.count, (self.count - 1) // _FEW_DEGREE)
        return self._part((rows[:, None] * self.count + some).ravel(), rows, some.size)

    def of(self, k: int) -> Contact:
        """Contacts of one row."""
        return select_contacts(self.contact, np.arange(k * self.count, (k + 1) * self.count))


def _friction_exponents(batch: _ContactBatch) -> Array:
    """β = d ln μ/d ln p at five points of each curve, shape (b, 5); zero where nothing is lost."""
    friction, pressure = (x.reshape(-1, batch.count) for x in (batch.contact.friction, batch.contact.pressure))
    lossy = friction > 0.0
    log_mu = np.log(np.where(lossy, friction, 1.0))
    beta = lobatto_derivative(log_mu) / lobatto_derivative(np.log(pressure))
    every = (batch.count - 1) // _FEW_DEGREE
    exponents: Array = np.where(lossy, beta, 0.0)[:, ::every]
    return exponents


def _no_curve_error(lowest: float, highest: float, why: str) -> NoSolutionError:
    return NoSolutionError(f"between mean pressures {lowest:.6g} and {highest:.6g} {why}")


def _accuracy_error(error: float) -> NoSolutionError:
    return NoSolutionError(
        f"the load curve reached a relative error of {error:.1e} only: ask for a larger rtol or fewer decades of load"
    )
