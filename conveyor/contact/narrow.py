"""One strip by its half width, many scenes at once, without a Python loop over scenes.

Stacked linear algebra and the short rules: the half width is found at order 8 and closed at the order that meets rtol.
What is not found this way (loads near the roll's half circle, extremely thin layers) or is not one strip is left to the
other ways.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.bessel import ProductIK
from conveyor.contact.checks import (
    WRAPPED,
    by_energy,
    may_touch_elsewhere,
    order_errors,
    overlaps,
    pulling_and_pressing,
    relative_difference,
)
from conveyor.contact.creep import Creeps, CreepSpectrum
from conveyor.contact.energy import friction_by_loss
from conveyor.contact.fields import SpectralFields
from conveyor.contact.orders import lowest_order, order_for
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.scene import Scene, instantly_relaxed
from conveyor.contact.short_rule import (
    CAPS,
    FINE_FROM,
    WIDEST,
    Grade,
    ShortRule,
    cap_of,
    grades_for,
    panels_beyond,
    short_rule,
)
from conveyor.contact.single import DENSE, LOAD_FLOOR, Near
from conveyor.contact.solution import Found, Outcome
from conveyor.contact.spectral import Contact, assemble, equilibrium, penetration
from conveyor.contact.stack import Stack, kind, stacked

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_SEARCH = 8
_ROUGH = 1e-9  # relative error of eccentricities on the way
_SAMPLES, RANGE = 4, 0.25  # half widths sampled at order 8, to both sides of the guess in ln α
_OUTSIDE = 1.3  # of that range: farther, the guess was wrong
ROOM = 1.4  # the rule serves contacts wider than the guess by so much: exp(1.3 x 0.25)
_NEWTON_STEPS = 3  # of the nearly straight cubic; every move goes on from the last
_CLOSING_STEPS = 8
_LOAD_SHARE = 0.1  # of rtol: mismatch of load that may be left; friction feels a third of it
_LOAD_FELT = 1.5  # times β, whose value of order 8 is good to a tenth
_MOST_PANELS = 12
_ROLL = 0.98  # of its radius: the widest half width
_WIDE_CHUNK = 16  # wide ones have several times the nodes
_MOST_ENTRIES = 3_000_000  # of the matrices that are formed together
_FARTHEST = 2.0  # times the order, in one step
_GUESSES_TRIED = 4
_FLATTEST, _FARTHEST_GUESS = 0.1, 1.5  # d ln p over the search's half range; ln of half widths
CHUNK = 100  # scenes whose tables stay in the processor's cache
_GUESSES = 14
_GUESS = 1.0  # of the Hertz guess: the true half widths of conveyor covers, glassy to rubbery, are 0.80 to 1.21 of it


@dataclass(eq=False)
class Group:
    """Scenes of one support side by side, and what is known of each."""

    problems: list[ContactProblem]
    given: list[CreepSpectrum]  # as the solver sees them: terms without time are instantaneous
    layers: Stack
    creeps: Creeps
    rho: Array
    target: Array

    @classmethod
    def of(cls, problems: list[ContactProblem], given: list[CreepSpectrum]) -> Group:
        """Scenes of one support; creeps are filled up with terms of weight zero."""
        return cls(
            problems,
            given,
            stacked([p.layer for p in problems], given),
            Creeps.of(given),
            np.array([p.rho for p in problems]),
            np.log([p.pressure for p in problems]),
        )

    def __getitem__(self, chosen: Index) -> Group:
        return Group(
            [self.problems[i] for i in chosen],
            [self.given[i] for i in chosen],
            self.layers[chosen],
            self.creeps[chosen],
            self.rho[chosen],
            self.target[chosen],
        )


class Left(Enum):
    """What the batch leaves undone of a scene."""

    ANY = "its half width was not found"
    STRIPS = "one strip is not the answer"


def solve_narrow(problems: Sequence[ContactProblem], rtol: float) -> list[Outcome | Near | Left | None]:
    """Outcome of every scene whose single strip is found by its half width, what is left of the others.

    None of all where the short rules do not serve so fine a tolerance.
    """
    if rtol < FINE_FROM:
        return [None] * len(problems)
    outcomes: list[Outcome | Near | Left | None] = [Left.ANY] * len(problems)
    creeps = [instantly_relaxed(p.creep) for p in problems]
    grade = grades_for(rtol)[0]
    for members in alike(problems):
        group = Group.of([problems[i] for i in members], [creeps[i] for i in members])
        widest = np.minimum(_ROLL * group.rho, CAPS[-1]) / ROOM
        alpha = guess(group)
        rows = np.arange(alpha.size)
        for _ in range(_GUESSES_TRIED):
            alpha = np.minimum(alpha, widest)
            strayed = []
            for chosen in _chunks(group, alpha, rows, grade):
                part = group[chosen]
                search = Search(
                    part, short_rule(part.layers, part.creeps, ROOM * alpha[chosen], grade), alpha[chosen]
                )
                for row, outcome in _Closing(search, rtol).outcomes().items():
                    outcomes[members[chosen[row]]] = outcome
                strayed.append(chosen[search.stray])
                alpha[chosen] = search.extrapolated
            rows = np.concatenate(strayed) if strayed else rows[:0]
            if rows.size == 0:
                break
    return outcomes


def _chunks(group: Group, alpha: Array, rows: Index, grade: Grade) -> Iterator[Index]:
    """Like with like, few enough for the cache; without those whose rules would be too long."""
    half_width = ROOM * alpha[rows]
    caps = np.array([cap_of(width) for width in half_width])
    panels = panels_beyond(group.layers.reach(grade.depth)[rows], half_width, grade)
    order = np.lexsort((half_width, panels, caps))
    order = order[panels[order] <= _MOST_PANELS]
    for cap in np.unique(caps[order]):
        same = rows[order[caps[order] == cap]]
        step = CHUNK if cap == WIDEST else _WIDE_CHUNK
        for start in range(0, same.size, step):
            yield same[start : start + step]


def alike(problems: Sequence[ContactProblem]) -> Iterable[list[int]]:
    """Places of the scenes that can be solved side by side."""
    kinds: dict[type, list[int]] = {}
    for i, problem in enumerate(problems):
        kinds.setdefault(kind(problem.layer), []).append(i)
    return kinds.values()


def fits(group: Group, half_width: Array, grade: Grade) -> NDArray[np.bool_]:
    """Whether contacts up to these half widths are narrow: for the window, for the roll, against the layer."""
    panels = panels_beyond(group.layers.reach(grade.depth), half_width, grade)
    return np.asarray((half_width < np.minimum(WIDEST, WRAPPED * group.rho)) & (panels <= _MOST_PANELS))


def guess(group: Group) -> Array:
    """Half width of each scene: Hertz, p̃_m = α²/(4ρ² C), with the compliance C = |S| at m = 1/α."""
    narrow = group.rho * np.sqrt(np.exp(group.target) * group.creeps.instantaneous)
    span = np.log(np.maximum(0.8 * group.rho / narrow, 1.0 + 1e-9))
    log_alpha = np.log(narrow)[:, None] + np.linspace(0.0, 1.0, _GUESSES) * span[:, None]
    alpha = np.exp(log_alpha)
    m = np.maximum(1.0 / alpha, 1.0)
    compliance = np.abs(group.layers.symbol(m, group.creeps.compliance(m)))
    log_load = 2.0 * (log_alpha - np.log(2.0 * group.rho)[:, None]) - np.log(compliance)
    log_load = np.maximum.accumulate(log_load, axis=1)
    # a load beyond the table is no narrow contact: its place is the table's end and it is handed back
    above = np.clip((log_load < group.target[:, None]).sum(axis=1), 1, _GUESSES - 1)
    row = np.arange(group.rho.size)
    rise = log_load[row, above] - log_load[row, above - 1]
    run = log_alpha[row, above] - log_alpha[row, above - 1]
    rising = rise > 0.0
    share = np.where(rising, (group.target - log_load[row, above - 1]) / np.where(rising, rise, 1.0), 1.0)
    place = log_alpha[row, above - 1] + np.maximum(share, 0.0) * run
    guess: Array = _GUESS * np.exp(place)
    return guess


@lru_cache(maxsize=1)
def _points() -> tuple[Array, Array]:
    """Chebyshev points of the search in units of its half range, and from values there to polynomial coefficients."""
    t = np.cos((np.arange(_SAMPLES) + 0.5) * (np.pi / _SAMPLES))
    return t, np.linalg.inv(np.vander(t, increasing=True)).T


class Search:
    """Half widths on their way to the load, one scene a row.

    At order 8 the load is sampled at four half widths in one batch: ln p̃_m(ln α) is a cubic to 1e-5. At a higher order
    it differs by an offset that hardly depends on α, so that each evaluation there gives the next place.
    """

    def __init__(self, group: Group, rule: ShortRule, alpha: Array) -> None:
        self.group, self.rule = group, rule
        self.middle = np.log(alpha)
        t, transform = _points()
        size = alpha.size
        sampled = np.exp(self.middle[:, None] + RANGE * t).ravel()
        every = np.repeat(np.arange(size), _SAMPLES)
        rho = group.rho[every]
        matrix = assemble(rule[every], group.creeps[every], sampled, _SEARCH)
        contact = equilibrium(matrix, sampled, rho, tolerance=_ROUGH)
        good = (contact.inside & (contact.pressure > 0.0)).reshape(size, _SAMPLES).all(axis=1)
        self.load = (
            np.log(np.where(contact.pressure > 0.0, contact.pressure, 1.0)).reshape(size, -1) @ transform
        )
        self.shift = (contact.eps / sampled).reshape(size, -1) @ transform
        lossy = (contact.friction != 0.0).reshape(size, _SAMPLES).all(axis=1)
        log_mu = np.log(np.abs(np.where(contact.friction != 0.0, contact.friction, 1.0)))
        self.drag = log_mu.reshape(size, -1) @ transform
        self.lossy = lossy
        self.place = np.zeros(size)
        self.offset = np.zeros(size)
        self._order, self._miss, self._share = np.zeros(size), np.zeros(size), np.zeros(size)
        self.alive = np.array(good, dtype=bool)
        self.matrices = np.ones(size, dtype=int)
        self.move(np.flatnonzero(good))
        self.stray = good & ~self.alive

    @property
    def extrapolated(self) -> Array:
        """Half widths where a straight line through the middle meets the load: for those far outside."""
        rise = np.where(self.load[:, 1] > _FLATTEST, self.load[:, 1], _FLATTEST)
        away = RANGE * (self.group.target - self.load[:, 0]) / rise
        found: Array = np.exp(self.middle + np.clip(away, -_FARTHEST_GUESS, _FARTHEST_GUESS))
        return found

    def move(self, rows: Index) -> None:
        """Newton on the cubic and its offset, to the place where the load is met; rows far outside are given up."""
        cubic = self.load[rows]
        wanted = self.group.target[rows] - self.offset[rows]
        t = self.place[rows]
        for _ in range(_NEWTON_STEPS):
            value = cubic[:, 0] + t * (cubic[:, 1] + t * (cubic[:, 2] + t * cubic[:, 3]))
            rise = cubic[:, 1] + t * (2.0 * cubic[:, 2] + t * 3.0 * cubic[:, 3])
            rising = rise > 0.0
            t = np.where(rising, t - (value - wanted) / np.where(rising, rise, 1.0), _OUTSIDE)
            t = np.clip(t, -_OUTSIDE, _OUTSIDE)
        self.place[rows] = t
        self.alive[rows] &= np.abs(t) < _OUTSIDE

    def place_and_slope(self, row: int) -> tuple[float, float]:
        """Ln α of the present place and d ln p̃_m/d ln α there."""
        t, load = float(self.place[row]), self.load[row]
        slope = (load[1] + t * (2.0 * load[2] + t * 3.0 * load[3])) / RANGE
        return float(self.middle[row] + RANGE * t), float(slope)

    def exponent(self, rows: Index) -> Array:
        """β = d ln μ/d ln p at the present places; zero where nothing is lost."""
        t = self.place[rows]
        drag, load = self.drag[rows], self.load[rows]
        rise = load[:, 1] + t * (2.0 * load[:, 2] + t * 3.0 * load[:, 3])
        out: Array = np.where(
            self.lossy[rows], (drag[:, 1] + t * (2.0 * drag[:, 2] + t * 3.0 * drag[:, 3])) / rise, 0.0
        )
        return out

    def evaluate(self, rows: Index, n: int) -> tuple[Contact, Array, Array, ProductIK]:
        """Contacts of some rows at order n, matrices, ln p - target, Bessel products; moves on to the next places."""
        t = self.place[rows]
        alpha = np.exp(self.middle[rows] + RANGE * t)
        creeps = self.group.creeps[rows]
        ik = ProductIK(n, alpha[:, None] / creeps.times)
        matrix = assemble(self.rule[rows], creeps, alpha, n, ik)
        shift = self.shift[rows]
        start = alpha * (shift[:, 0] + t * (shift[:, 1] + t * (shift[:, 2] + t * shift[:, 3])))
        contact = equilibrium(matrix, alpha, self.group.rho[rows], start)
        self.matrices[rows] += 1
        good = np.asarray(contact.inside & (contact.pressure > 0.0))
        self.alive[rows] &= good
        miss = np.log(np.where(good, contact.pressure, 1.0)) - self.group.target[rows]
        # where the slope at this order is 1 - q of the cubic's, a miss comes back as its q-th part
        again = (self._order[rows] == n) & (np.abs(miss) < 0.5 * np.abs(self._miss[rows]))
        back = np.where(again, miss / np.where(again, self._miss[rows], 1.0), 0.0)
        share = self._share[rows] + back * (1.0 - self._share[rows])
        self._share[rows], self._miss[rows], self._order[rows] = share, miss, n
        self.offset[rows] += np.where(good, miss / (1.0 - share), 0.0)
        self.move(rows[good])
        return contact, matrix, miss, ik


class _Closing:
    """Raises the order until each scene meets rtol, and checks what it finds."""

    def __init__(self, search: Search, rtol: float) -> None:
        self.search, self.rtol = search, rtol
        self.tight = max(_LOAD_SHARE * rtol, LOAD_FLOOR)
        self.error, self.most, self.edges = np.ones((3, search.place.size))
        self.wanted = np.full(search.place.size, lowest_order(rtol))
        self.done: dict[int, Outcome | Near | Left] = {}

    def outcomes(self) -> dict[int, Outcome | Near | Left]:
        """By row; none of those that are left to other ways."""
        waiting = np.flatnonzero(self.search.alive)
        while waiting.size:
            n = int(self.wanted[waiting].min())
            same = np.flatnonzero(self.wanted[waiting] == n)[: max(1, _MOST_ENTRIES // (n * n))]
            self._close(waiting[same], n)
            # those that were neither closed nor are to be raised did not meet their load
            open_ = (self.wanted[waiting] > n) | ~np.isin(np.arange(waiting.size), same)
            waiting = waiting[open_ & self.search.alive[waiting]]
        return self.done

    def _close(self, rows: Index, n: int) -> None:
        """Meet the load at order n."""
        search, rtol = self.search, self.rtol
        for step in range(_CLOSING_STEPS):
            exponent = search.exponent(rows)
            contact, matrix, miss, ik = search.evaluate(rows, n)
            if step == 0:
                by_order = order_errors(contact, matrix, search.group.rho[rows], exponent)
                self.error[rows], self.most[rows], self.edges[rows] = by_order
            alive = search.alive[rows]
            fine = (self.error[rows] <= rtol) & alive
            near = fine & (np.abs(miss) <= self.tight)
            at = np.flatnonzero(near)
            if at.size:
                felt = np.where(search.lossy[rows[at]], np.abs(exponent[at]), 1.0)
                left = _LOAD_FELT * np.abs(miss[at]) * felt
                self._accept(rows[at], chosen_rows(contact, at), ik[at], self.error[rows[at]] + left)
            for row in rows[alive & ~fine]:
                self._raise(int(row), n, 0.0)
            rows = rows[fine & ~near]
            if rows.size == 0:
                return

    def _raise(self, row: int, n: int, energy: float) -> None:
        excess, excess_energy = float(self.error[row]) / self.rtol, energy / self.rtol
        self.wanted[row] = order_for(n, excess, excess_energy, _FARTHEST)
        if self.wanted[row] > DENSE:
            self.search.alive[row] = False
            self.done[row] = Near(*self.search.place_and_slope(row))

    def _accept(self, rows: Index, contact: Contact, ik: ProductIK, error: Array) -> None:
        """Check energy, sign and place of contacts whose order and load suffice."""
        search, group, rtol = self.search, self.search.group, self.rtol
        grade = grades_for(rtol)[1]
        check = short_rule(group.layers[rows], group.creeps[rows], contact.alpha, grade, search.rule[rows])
        rho = group.rho[rows]
        by_loss = friction_by_loss(check, group.creeps[rows], contact, rho, ik)
        energy = np.abs(relative_difference(by_loss, contact.friction))
        by_loss_error = by_energy(energy, self.most[rows])
        estimate = np.maximum(np.maximum(error, by_loss_error), grade.error)
        pulling, pressing = pulling_and_pressing(contact, rtol)
        outside = may_touch_elsewhere(contact, rho)
        n = int(contact.c.shape[1])
        for k, row in enumerate(rows.tolist()):
            if pulling[k]:
                self.done[row] = Left.STRIPS
            elif estimate[k] > rtol or not pressing[k]:
                self._raise(row, n, float(by_loss_error[k]))
            else:
                one = chosen_rows(contact, np.array([k]))
                errors = float(estimate[k]), float(energy[k])
                self.done[row] = self._found(row, one, errors, outside=bool(outside[k]))

    def _found(
        self, row: int, contact: Contact, errors: tuple[float, float], *, outside: bool
    ) -> Outcome | Left:
        """The contact as an outcome, where the layer does not touch the roll elsewhere."""
        search, group = self.search, self.search.group
        problem, creep = group.problems[row], group.given[row]
        alpha, eps = float(contact.alpha[0]), float(contact.eps[0])
        depth = None
        if outside:
            scene = Scene(problem, creep)
            depth = float(penetration(scene.rule(alpha), creep, contact, problem.rho)[0])
            if overlaps(scene, contact, depth):
                return Left.STRIPS
        return Outcome(
            Status.OK,
            Found(
                friction=float(contact.friction[0]),
                mean_pressure=float(contact.pressure[0]),
                half_width=alpha,
                centre=eps,
                strips=np.array([[eps - alpha, eps + alpha]]),
                energy_error=errors[1],
                error_estimate=errors[0],
                edge_error=float(self.edges[row]),
                fields=SpectralFields(problem.layer, creep, contact, problem.rho, depth),
            ),
            order=int(contact.c.shape[1]),
            matrices=int(search.matrices[row]),
            nodes=int(search.rule.nodes.shape[1]),
            terms=creep.weights.size,
            way="one strip" if outside else "narrow",
        )


def chosen_rows(contact: Contact, at: Index) -> Contact:
    """Some contacts of a batch."""
    return Contact(
        contact.alpha[at],
        contact.eps[at],
        contact.c[at],
        contact.pressure[at],
        contact.friction[at],
        contact.inside[at],
    )
