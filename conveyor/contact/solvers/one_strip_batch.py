"""Contacts of one strip by their half width, many problems in a batch.

Stacked linear algebra and the short rules: the half width is solved at a low order and refined at the order that meets
rtol. Loads near the roll's half circle, extremely thin layers and contacts of several strips are left to the other
solvers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.contact_fields import SpectralFields
from conveyor.contact.galerkin.galerkin_tables import GalerkinTables
from conveyor.contact.galerkin.order_tail import DENSE_ORDER
from conveyor.contact.galerkin.orders import lowest_order, next_order
from conveyor.contact.galerkin.short_rule import (
    FINE_FROM,
    NARROW_CAP,
    WINDOW_CAPS,
    RuleGrade,
    ShortRule,
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
from conveyor.contact.layers.creep import CreepBatch, CreepSpectrum
from conveyor.contact.layers.layer_batch import LayerBatch, layer_kind, stack_layers
from conveyor.contact.layers.regrid import within_log_grid
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.solution import ContactResult, SolveOutcome
from conveyor.contact.solvers.acceptance import (
    WRAP_EXTENT,
    energy_errors,
    may_touch_elsewhere,
    order_errors,
    overlaps_roll,
    pressure_signs,
)
from conveyor.contact.solvers.one_strip import LOAD_FLOOR, HalfWidthStart
from conveyor.contact.solvers.solver_state import SolverState, merge_instant_terms

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_SEARCH_ORDER = 10
ROUGH_RTOL = 1e-6  # relative error of eccentricities on the way: a tenth of the cubics'
_SAMPLES, SEARCH_RANGE = 4, 0.25  # half widths sampled, to both sides of the guess in ln α
_GUESS_RANGES = (SEARCH_RANGE, SEARCH_RANGE, SEARCH_RANGE, 0.05, 0.05, 0.05)  # those near the roll's end come last
_SPAN = 2.0 * math.cos(0.5 * math.pi / _SAMPLES)  # of the samples, over that range
_OUTSIDE_SHARE = 0.2  # of the samples' span of ln p: farther beyond them, the guess was wrong
WIDTH_ROOM = 1.4  # the rule is valid for contacts wider than the guess by this factor: exp(1.3 x 0.25)
_CLOSING_STEPS = 8
_LOAD_SHARE = 0.1  # of rtol: error of friction that a mismatch of load may leave
_LOAD_LOOSE = 0.5  # of rtol: error by order and by the load's mismatch, together
PLACE_SHARE = 1e-4  # of rtol: error of an eccentricity
# times the mismatch of load, times the error of the search's order: error of friction as a contact is carried to its
# load (seen: 0.2 to 1 in the median, 7 to 30 in 99 % of contacts), and of its edges over α (0.3; 0.2 to 70)
_CARRY_FACTOR, _EDGE_CARRY_FACTOR = 20.0, 100.0
_CUBIC_ERROR = 0.03  # of a cubic's last coefficient: its own error between its points
_MOST_PANELS = 12
_WIDEST_ON_ROLL = 0.98  # of its radius: the widest half width
_WIDE_CHUNK = 16  # wide ones have several times the nodes
_MOST_ENTRIES = 3_000_000  # of the matrices that are formed together
_FLATTEST, _FARTHEST_GUESS = 0.4, 1.5  # d ln p/d ln α; ln of half widths
_CAPS = np.array(WINDOW_CAPS)
CHUNK_SIZE = 200  # problems whose tables stay in the processor's cache
_GUESSES = np.linspace(0.0, 1.0, 14)


@dataclass(eq=False)
class ProblemBatch:
    """Problems of one kind of layer in a batch."""

    problems: list[ContactProblem]
    given: list[CreepSpectrum]  # as the solver sees them: terms without time are instantaneous
    layers: LayerBatch
    creeps: CreepBatch
    rho: Array
    target: Array

    @classmethod
    def of(cls, problems: list[ContactProblem], given: list[CreepSpectrum]) -> ProblemBatch:
        """Batch of problems; creeps are padded with terms of weight zero."""
        return cls(
            problems,
            given,
            stack_layers([p.layer for p in problems], given),
            CreepBatch.of(given),
            np.array([p.rho for p in problems]),
            np.log([p.pressure for p in problems]),
        )

    def __getitem__(self, chosen: Index) -> ProblemBatch:
        if len(self.problems) == 1:
            return self
        return ProblemBatch(
            [self.problems[i] for i in chosen],
            [self.given[i] for i in chosen],
            self.layers[chosen],
            self.creeps[chosen],
            self.rho[chosen],
            self.target[chosen],
        )


class UnsolvedReason(Enum):
    """Reason why the batch leaves a problem unsolved."""

    ANY = "its half width was not found"
    STRIPS = "one strip is not the answer"


def solve_batch(
    problems: Sequence[ContactProblem], rtol: float
) -> list[SolveOutcome | HalfWidthStart | UnsolvedReason | None]:
    """Outcome of every problem solved as one strip; a start value or a reason for the others.

    All None where the short rules do not reach so fine a tolerance.
    """
    if rtol < FINE_FROM:
        return [None] * len(problems)
    outcomes: list[SolveOutcome | HalfWidthStart | UnsolvedReason | None] = [UnsolvedReason.ANY] * len(problems)
    creeps = [merge_instant_terms(p.creep) for p in problems]
    grades = rule_grades(rtol)
    for members in group_by_layer(problems):
        group = ProblemBatch.of([problems[i] for i in members], [creeps[i] for i in members])
        alpha, rows = guess_half_widths(group), np.arange(len(members))
        for span in _GUESS_RANGES:
            room = WIDTH_ROOM ** (span / SEARCH_RANGE)
            alpha = np.minimum(alpha, np.minimum(_WIDEST_ON_ROLL * group.rho, WINDOW_CAPS[-1]) / room)
            strayed = []
            for chosen in _similar_chunks(group, room * alpha, rows, grades[0]):
                part = group[chosen]
                rules = short_rules(part.layers, part.creeps, room * alpha[chosen], grades)
                search = HalfWidthSearch(part, rules, alpha[chosen], rtol, span)
                for row, outcome in _OrderControl(search, rtol).outcomes().items():
                    outcomes[members[chosen[row]]] = outcome
                if search.stray.any():
                    strayed.append(chosen[search.stray])
                    alpha[chosen] = search.extrapolated
            rows = np.concatenate(strayed) if strayed else rows[:0]
            if rows.size == 0:
                break
    return outcomes


def _similar_chunks(group: ProblemBatch, widest: Array, rows: Index, grade: RuleGrade) -> Iterator[Index]:
    """Chunks of similar problems that fit the cache, without those whose rules would be too long."""
    half_width = widest[rows]
    caps = np.searchsorted(_CAPS, half_width)
    panels = panel_count(group.layers.reach(grade.depth)[rows], half_width, grade)
    order = np.lexsort((half_width, panels, caps))
    order = order[(panels[order] <= _MOST_PANELS) & within_log_grid(group.creeps.places)[rows[order]]]
    for cap in sorted(set(caps[order].tolist())):
        same = rows[order[caps[order] == cap]]
        step = CHUNK_SIZE if WINDOW_CAPS[cap] == NARROW_CAP else _WIDE_CHUNK
        for start in range(0, same.size, step):
            yield same[start : start + step]


def group_by_layer(problems: Sequence[ContactProblem]) -> Iterable[list[int]]:
    """Places of the problems of each kind of layer, which can share a batch."""
    kinds: dict[type, list[int]] = {}
    for i, problem in enumerate(problems):
        kinds.setdefault(layer_kind(problem.layer), []).append(i)
    return kinds.values()


def plainly_narrow(group: ProblemBatch, half_width: Array, grade: RuleGrade) -> NDArray[np.bool_]:
    """True where contacts up to these half widths are narrow against window, roll and layer."""
    panels = panel_count(group.layers.reach(grade.depth), half_width, grade)
    slim = (half_width < np.minimum(NARROW_CAP, WRAP_EXTENT * group.rho)) & (panels <= _MOST_PANELS)
    return np.asarray(slim & within_log_grid(group.creeps.places))


def guess_half_widths(group: ProblemBatch) -> Array:
    """Hertz half width of each problem, p̃_m = α²/(4ρ² C), with the compliance C = |S| at m = 1/α.

    The true half widths of conveyor covers, glassy to rubbery, are 0.80 to 1.21 of it.
    """
    narrow = group.rho * np.sqrt(np.exp(group.target) * group.creeps.instantaneous)
    span = np.log(np.maximum(0.8 * group.rho / narrow, 1.0 + 1e-9))
    log_alpha = np.log(narrow)[:, None] + _GUESSES * span[:, None]
    alpha = np.exp(log_alpha)
    m = np.maximum(1.0 / alpha, 1.0)
    compliance = np.abs(group.layers.symbol(m, group.creeps.compliance(m)))
    log_load = 2.0 * (log_alpha - np.log(2.0 * group.rho)[:, None]) - np.log(compliance)
    log_load = np.maximum.accumulate(log_load, axis=1)
    # a load beyond the table is no narrow contact: it gets the table's end
    return np.exp([np.interp(*each) for each in zip(group.target, log_load, log_alpha, strict=True)])


@lru_cache(maxsize=2)
def _sample_ratios(span: float) -> tuple[float, ...]:
    """Half widths over the guess at Chebyshev points of a range of ln α, from the widest down."""
    return tuple(np.exp(span * np.cos((np.arange(_SAMPLES) + 0.5) * (np.pi / _SAMPLES))).tolist())


class CubicInterpolants:
    """Newton cubics through four points y, shape (b, 4), of f quantities of b problems, shape (f, b, 4)."""

    def __init__(self, y: Array, figures: Array) -> None:
        self.y = y
        self.parts = np.empty((_SAMPLES, *figures.shape[:2]))
        self.parts[0], last = figures[..., 0], figures
        for step in range(1, _SAMPLES):
            last = (last[..., 1:] - last[..., :-1]) / (y[:, step:] - y[:, :-step])
            self.parts[step] = last[..., 0]

    def value(self, rows: Index, y: Array) -> Array:
        """Values of these rows at y."""
        first, second, third, fourth = self.parts[..., rows]
        away = y[:, None] - self.y[rows]
        value: Array = first + away[:, 0] * (second + away[:, 1] * (third + away[:, 2] * fourth))
        return value

    def slope(self, rows: Index, y: Array) -> Array:
        """Derivatives by y of the first three quantities."""
        _, second, third, fourth = self.parts[:, :3, rows]
        away = y[:, None] - self.y[rows]
        sum_, product = away[:, 0] + away[:, 1], away[:, 0] * away[:, 1]
        slope: Array = second + sum_ * third + (product + away[:, 2] * sum_) * fourth
        return slope


class _Evaluation(NamedTuple):
    """Contacts at their order, those of lower orders, ln p - target, tables; y and values of the cubics there."""

    contact: Contact
    lower: Contact
    miss: Array
    tabled: GalerkinTables
    place: Array
    known: Array

    def of(self, at: Index | slice) -> _Evaluation:
        """Selected rows."""
        return _Evaluation(
            select_contacts(self.contact, at),
            select_contacts(self.lower, at),
            self.miss[at],
            self.tabled[at],
            self.place[at],
            self.known[:, at],
        )


class HalfWidthSearch:
    """Search for the half widths that carry the loads, one problem a row.

    At a low order four half widths are sampled in one batch: ln α, ε/α, ln |μ| and the pressure's shape c_v/c_1 are
    cubics of y = ln p̃_m, to 1e-5. At a higher order ln p̃_m differs by an offset that hardly depends on α: each
    evaluation gives the next place, and the contact there once it is near.
    """

    def __init__(self, group: ProblemBatch, rules: Sequence[ShortRule], alpha: Array, rtol: float, span: float) -> None:
        self.group, self.tolerance, self.width = group, PLACE_SHARE * rtol, _SPAN * span
        self.rule, self.check = rules
        self.middle = np.log(alpha)
        size = alpha.size
        ratios = _sample_ratios(span)
        sampled = np.multiply.outer(alpha, ratios).ravel()
        matrix = GalerkinTables.of(group.creeps, alpha).matrices(self.rule, _SEARCH_ORDER, ratios)
        contact = solve_equilibrium(matrix, sampled, np.repeat(group.rho, _SAMPLES), tolerance=ROUGH_RTOL)
        pressing = contact.inside & (contact.pressure > 0.0)
        good = pressing.reshape(size, _SAMPLES).all(axis=1)
        lossy = contact.friction != 0.0
        self.lossy = lossy.reshape(size, _SAMPLES).all(axis=1)
        figures = np.empty((_SEARCH_ORDER + 2, size * _SAMPLES))
        np.log(sampled, out=figures[0])
        np.divide(contact.eps, sampled, out=figures[1])
        figures[2] = _log_magnitude(contact.friction, lossy)
        np.divide(contact.c[:, 1:].T, contact.c[:, 0], out=figures[3:])
        y = _log_magnitude(contact.pressure, pressing).reshape(size, _SAMPLES)
        rising = (y[:, 1:] < y[:, :-1]).all(axis=1)
        y[~rising] = -np.arange(_SAMPLES)
        self.cubics = CubicInterpolants(y, figures.reshape(-1, size, _SAMPLES))
        self.span = y[:, 0] - y[:, -1]
        self.place = self.group.target.copy()
        self.offset = np.zeros(size)
        self._order, self._miss, self._share = np.zeros(size), np.zeros(size), np.zeros(size)
        self.alive = np.asarray(good & rising)
        self.matrices = np.ones(size, dtype=int)
        self.move_to_loads(np.flatnonzero(self.alive))
        self.stray = good & ~self.alive

    @property
    def extrapolated(self) -> Array:
        """Half widths where a straight line through the middle meets the load, for those far outside."""
        exponent = np.maximum(self.span / self.width, _FLATTEST)
        away = (self.group.target - self.cubics.y.mean(axis=1)) / exponent
        values: Array = np.exp(self.middle + np.clip(away, -_FARTHEST_GUESS, _FARTHEST_GUESS))
        return values

    def move_to_loads(self, rows: Index) -> None:
        """Move to the places that meet the load with the present offset; drop rows far outside."""
        self.place[rows] = y = self.group.target[rows] - self.offset[rows]
        ends = self.cubics.y[rows]
        beyond = np.maximum(y - ends[:, 0], ends[:, -1] - y)
        self.alive[rows] &= beyond < _OUTSIDE_SHARE * self.span[rows]

    def place_and_slope(self, row: int) -> tuple[float, float]:
        """Ln α of the present place and d ln p̃_m/d ln α there."""
        at = np.array([row])
        run = self.cubics.slope(at, self.place[at])[0, 0]
        return float(self.cubics.value(at, self.place[at])[0, 0]), float(1.0 / run)

    def exponent(self, rows: Index, y: Array) -> Array:
        """β = d ln μ/d ln p at places y; zero where nothing is lost."""
        return np.where(self.lossy[rows], self.cubics.slope(rows, y)[2], 0.0)

    def evaluate(self, rows: Index, n: int) -> _Evaluation:
        """Contacts of these rows at order n; moves on to the next places."""
        y = self.place[rows]
        known = self.cubics.value(rows, y)
        alpha = np.exp(known[0])
        at = _row_selection(rows, self.place.size)
        tabled = GalerkinTables.of(self.group.creeps[at], alpha)
        matrix = tabled.matrices(self.rule[at], n)
        contact, lower = solve_nested_equilibrium(matrix, alpha, self.group.rho[rows], alpha * known[1], self.tolerance)
        self.matrices[rows] += 1
        good = np.asarray(contact.inside & (contact.pressure > 0.0))
        self.alive[rows] &= good
        miss = np.log(np.where(good, contact.pressure, 1.0)) - self.group.target[rows]
        share = self._share[rows]
        # where the slope at this order is 1 - q of the cubic's, a miss comes back as its q-th part
        again = (self._order[rows] == n) & (np.abs(miss) < 0.5 * np.abs(self._miss[rows]))
        if again.any():
            back = np.where(again, miss / np.where(again, self._miss[rows], 1.0), 0.0)
            share = share + back * (1.0 - share)
        self._share[rows], self._miss[rows], self._order[rows] = share, miss, n
        self.offset[rows] += np.where(good, miss / (1.0 - share), 0.0)
        self.move_to_loads(rows[good])
        return _Evaluation(contact, lower, miss, tabled, y, known)

    def carried(self, rows: Index, found: _Evaluation) -> tuple[Contact, Array]:
        """Evaluated contacts carried to their loads by the low-order cubics, and the relative error of friction."""
        contact, miss, y_from, here = found.contact, found.miss, found.place, found.known
        y_to = y_from - miss
        change = self.cubics.value(rows, y_to) - here
        log_wider, shifted, dragged = change[:3]
        lossy = self.lossy[rows] & (contact.friction != 0.0)
        wider, heavier = np.exp(log_wider), np.exp(y_to - y_from)
        alpha = contact.alpha * wider
        eps = wider * contact.eps + alpha * shifted
        c = contact.c * (heavier / wider)[:, None]
        c[:, 1:_SEARCH_ORDER] += c[:, :1] * change[3:].T
        # errors of the cubics: of friction, of the load
        cut = _CUBIC_ERROR * np.abs(self.cubics.parts[3][:, rows]) * (self.span[rows] / _SPAN) ** 3
        off = np.where(lossy, np.abs(_log_magnitude(contact.friction, lossy) - here[2]) + cut[2], 0.0)
        off += np.abs(self.group.target[rows] + miss - y_from) + cut[0] * self.span[rows] / self.width
        met = Contact(
            alpha,
            eps,
            c,
            contact.pressure * heavier,
            contact.friction * np.exp(np.where(lossy, dragged, 0.0)),
            contact.inside & (alpha + np.abs(eps) < self.group.rho[rows]),
        )
        share = np.abs(self._share[rows] / (1.0 - self._share[rows]))
        return met, np.maximum(_CARRY_FACTOR * off, share) * np.abs(miss)


def _row_selection(rows: Index, size: int) -> Index | slice:
    """Ascending rows as an index; as a slice, which copies nothing, where they are all of `size`."""
    return rows if rows.size < size else slice(None)


def _log_magnitude(values: Array, told: NDArray[np.bool_]) -> Array:
    """Ln |values| where `told`, else zero."""
    logs: Array = np.log(np.abs(np.where(told, values, 1.0)))
    return logs


class _OrderControl:
    """Raises the order until each problem meets rtol, and checks the contacts."""

    def __init__(self, search: HalfWidthSearch, rtol: float) -> None:
        self.search, self.rtol = search, rtol
        self.tight = max(_LOAD_SHARE * rtol, LOAD_FLOOR)
        self.error, self.most, self.edges = np.ones((3, search.place.size))
        self.wanted = np.full(search.place.size, lowest_order(rtol))
        self.done: dict[int, SolveOutcome | HalfWidthStart | UnsolvedReason] = {}

    def outcomes(self) -> dict[int, SolveOutcome | HalfWidthStart | UnsolvedReason]:
        """Outcomes by row; rows without an entry are left to the other solvers."""
        waiting = np.flatnonzero(self.search.alive)
        while waiting.size:
            wanted = self.wanted[waiting]
            n = int(wanted.min())
            rows, step = waiting[wanted == n], max(1, _MOST_ENTRIES // (n * n))
            for start in range(0, rows.size, step):
                self._close(rows[start : start + step], n)
            # rows that are neither accepted nor raised to a higher order did not meet their load
            waiting = waiting[(self.wanted[waiting] > n) & self.search.alive[waiting]]
        return self.done

    def _close(self, rows: Index, n: int) -> None:
        """Close the load at order n."""
        search, rtol = self.search, self.rtol
        for step in range(_CLOSING_STEPS):
            found = search.evaluate(rows, n)
            if step == 0:
                by_order = order_errors(found.contact, found.lower, search.exponent(rows, found.place))
                self.error[rows], self.most[rows], self.edges[rows] = by_order
            alive = np.flatnonzero(search.alive[rows])
            if alive.size < rows.size:
                rows, found = rows[alive], found.of(alive)
            fine = self.error[rows] <= rtol
            met, left = search.carried(rows, found)
            error = self.error[rows] + left
            near = fine & met.inside & ((left <= self.tight) | (error <= _LOAD_LOOSE * rtol))
            at = np.flatnonzero(near)
            if at.size:
                self.edges[rows[at]] += _EDGE_CARRY_FACTOR / _CARRY_FACTOR * left[at] * met.alpha[at]
                part = _row_selection(at, rows.size)
                self._accept(rows[at], found.of(part), select_contacts(met, part), error[at])
            for row in rows[~fine]:
                self._raise(int(row), n, 0.0)
            rows = rows[fine & ~near]
            if rows.size == 0:
                return

    def _raise(self, row: int, n: int, energy: float) -> None:
        self.wanted[row] = next_order(n, max(float(self.error[row]), energy) / self.rtol)
        if self.wanted[row] > DENSE_ORDER:
            self.search.alive[row] = False
            self.done[row] = HalfWidthStart(*self.search.place_and_slope(row))

    def _accept(self, rows: Index, found: _Evaluation, closed: Contact, error: Array) -> None:
        """Check energy, sign and gap of contacts whose order suffices, and accept or raise them."""
        search, rtol, contact = self.search, self.rtol, found.contact
        grade = rule_grades(rtol)[1]
        rho = search.group.rho[rows]
        check = search.check[_row_selection(rows, search.place.size)]
        orders = contact, found.lower
        energy, by_loss_error = energy_errors(found.tabled, check, orders, rho, most=self.most[rows], rtol=rtol)
        pulling, pressing, tension = pressure_signs(contact, rtol)
        estimate = np.max([error, by_loss_error, tension], axis=0).clip(min=grade.floor(search.group.layers))
        outside = may_touch_elsewhere(closed, rho)
        n = int(contact.c.shape[1])
        for k, row in enumerate(rows.tolist()):
            if pulling[k]:
                self.done[row] = UnsolvedReason.STRIPS
            elif estimate[k] > rtol or not pressing[k]:
                self._raise(row, n, float(by_loss_error[k]))
            else:
                one = select_contacts(closed, slice(k, k + 1))
                errors = float(estimate[k]), float(energy[k])
                self.done[row] = self._found(row, one, errors, outside=bool(outside[k]))

    def _found(
        self, row: int, contact: Contact, errors: tuple[float, float], *, outside: bool
    ) -> SolveOutcome | UnsolvedReason:
        """Outcome of an accepted contact, unless the layer touches the roll elsewhere."""
        search, group = self.search, self.search.group
        problem, creep = group.problems[row], group.given[row]
        alpha, eps = float(contact.alpha[0]), float(contact.eps[0])
        if outside and overlaps_roll(SolverState(problem, creep), contact):
            return UnsolvedReason.STRIPS
        return SolveOutcome(
            Status.OK,
            ContactResult(
                friction=float(contact.friction[0]),
                mean_pressure=float(contact.pressure[0]),
                half_width=alpha,
                centre=eps,
                strips=np.array([[eps - alpha, eps + alpha]]),
                energy_error=errors[1],
                error_estimate=errors[0],
                edge_error=float(self.edges[row]),
                fields=SpectralFields(problem.layer, creep, contact, problem.rho),
            ),
            order=int(contact.c.shape[1]),
            matrices=int(search.matrices[row]),
            nodes=int(search.rule.nodes.shape[1]),
            terms=creep.weights.size,
            way="one strip" if outside else "narrow",
        )
