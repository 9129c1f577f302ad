"""Narrow contacts, many scenes at once: what real conveyors are, without a Python loop over scenes.

One strip by its half width, as in single.py, with stacked linear algebra and the short rules: the half width is found
at order 8 and closed at the order that meets rtol. Whatever is not plainly a narrow single strip (wide or wrapped
contacts, pressure that may turn negative, orders above 48, extremely thin layers) is handed back as None for the
general ways.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.belt import Belt
from conveyor.contact.bessel import ProductIK
from conveyor.contact.checks import (
    ENERGY_OVER_ERROR,
    WRAPPED,
    may_touch_elsewhere,
    order_error,
    pulling_and_pressing,
    relative_difference,
)
from conveyor.contact.creep import Creeps, CreepSpectrum
from conveyor.contact.energy import friction_by_loss
from conveyor.contact.fields import SpectralFields
from conveyor.contact.orders import ORDERS, lowest_order
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.scene import instantly_relaxed
from conveyor.contact.short_rule import (
    WIDEST,
    Grade,
    ShortRule,
    grades_for,
    panels_beyond,
    short_rule,
)
from conveyor.contact.single import LOAD_FLOOR
from conveyor.contact.solution import Found, Outcome
from conveyor.contact.spectral import Contact, assemble, equilibrium
from conveyor.contact.stack import Stack, kind, stacked

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_SEARCH = 8
_ROUGH = 1e-9  # relative error of eccentricities on the way
_SAMPLES, RANGE = 4, 0.25  # half widths sampled at order 8, to both sides of the guess in ln α
_OUTSIDE = 1.3  # of that range: farther, the guess was wrong
ROOM = 1.4  # the rule serves contacts wider than the guess by so much: exp(1.3 x 0.25)
_NEWTON_STEPS = 3  # of the nearly straight cubic; every move goes on from the last
_CLOSING_STEPS = 5
_LOAD_SHARE = 0.1  # of rtol: mismatch of load that may be left; friction feels a third of it
_TIMES = 1e100  # squares of larger retardation numbers overflow
_MOST_PANELS = 12
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


def solve_narrow(problems: Sequence[ContactProblem], rtol: float) -> list[Outcome | None]:
    """Outcome of every scene that is a plain narrow contact, None of the others; in their order."""
    outcomes: list[Outcome | None] = [None] * len(problems)
    creeps = [instantly_relaxed(p.creep) for p in problems]
    grades = grades_for(rtol)
    for members in alike(problems, creeps):
        group = Group.of([problems[i] for i in members], [creeps[i] for i in members])
        alpha = guess(group)
        half_width = ROOM * alpha
        narrow = np.flatnonzero(fits(group, half_width, grades[0]))
        panels = panels_beyond(group.layers.reach(grades[0].depth), half_width, grades[0])
        narrow = narrow[np.lexsort((half_width[narrow], panels[narrow]))]
        for start in range(0, narrow.size, CHUNK):
            chosen = narrow[start : start + CHUNK]
            part = group[chosen]
            rule = short_rule(part.layers, part.creeps, half_width[chosen], grades[0])
            search = Search(part, rule, alpha[chosen])
            for row, outcome in _closed(search, rtol).items():
                outcomes[members[chosen[row]]] = outcome
    return outcomes


def plain(problem: ContactProblem, creep: CreepSpectrum) -> bool:
    """Whether the scene's retardation numbers can be squared."""
    times = [creep.times]
    if isinstance(problem.support, Belt):
        times.append(problem.support.top_creep.times)
    return all(float(zeta.max(initial=0.0)) < _TIMES for zeta in times)


def alike(problems: Sequence[ContactProblem], creeps: Sequence[CreepSpectrum]) -> Iterable[list[int]]:
    """Places of the scenes that can be solved side by side."""
    kinds: dict[type, list[int]] = {}
    for i, (problem, creep) in enumerate(zip(problems, creeps, strict=True)):
        if plain(problem, creep):
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
        self.alive = np.array(good, dtype=bool)
        self.matrices = np.ones(size, dtype=int)
        self.move(np.flatnonzero(good))

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
        self.offset[rows] += np.where(good, miss, 0.0)
        self.move(rows[good])
        return contact, matrix, miss, ik


def _closed(search: Search, rtol: float) -> dict[int, Outcome]:
    """Raise the order until each scene meets rtol."""
    tight = max(_LOAD_SHARE * rtol, LOAD_FLOOR)
    error = np.ones(search.place.size)
    done: dict[int, Outcome] = {}
    waiting = np.flatnonzero(search.alive)
    for n in [n for n in ORDERS if lowest_order(rtol) <= n <= 48]:
        rows, waiting = waiting, np.empty(0, dtype=int)
        for step in range(_CLOSING_STEPS):
            if rows.size == 0:
                break
            exponent = search.exponent(rows)
            contact, matrix, miss, ik = search.evaluate(rows, n)
            if step == 0:
                error[rows] = order_error(contact, matrix, search.group.rho[rows], exponent)
            alive = search.alive[rows]
            fine = (error[rows] <= rtol) & alive
            near = fine & (np.abs(miss) <= tight)
            missed = np.zeros(rows.size, dtype=bool)
            at = np.flatnonzero(near)
            if at.size:
                left = np.abs(miss[at]) * np.where(search.lossy[rows[at]], np.abs(exponent[at]), 1.0)
                accepted = _accept(
                    search, rows[at], (chosen_rows(contact, at), ik[at]), error[rows[at]] + left, rtol
                )
                done.update(accepted)
                missed[at] = [r not in accepted for r in rows[at].tolist()]
            waiting = np.append(waiting, rows[(alive & ~fine) | missed])
            rows = rows[fine & ~near]
        if waiting.size == 0:
            break
    return done


def _accept(
    search: Search,
    rows: Index,
    contacts: tuple[Contact, ProductIK],
    error: Array,
    rtol: float,
) -> dict[int, Outcome]:
    """Check energy, sign and place of contacts whose order and load suffice; the good ones by their row."""
    group = search.group
    contact, ik = contacts
    grade = grades_for(rtol)[1]
    check = short_rule(group.layers[rows], group.creeps[rows], contact.alpha, grade, search.rule[rows])
    rho = group.rho[rows]
    by_loss = friction_by_loss(check, group.creeps[rows], contact, rho, ik)
    energy = np.abs(relative_difference(by_loss, contact.friction))
    estimate = np.maximum(np.maximum(error, energy / ENERGY_OVER_ERROR), grade.error)
    _, pressing = pulling_and_pressing(contact, rtol)
    good = (estimate <= rtol) & pressing & ~may_touch_elsewhere(contact, rho)
    n = int(contact.c.shape[1])
    done: dict[int, Outcome] = {}
    for k in np.flatnonzero(good):
        row = int(rows[k])
        one = chosen_rows(contact, np.array([k]))
        alpha, eps = float(one.alpha[0]), float(one.eps[0])
        done[row] = Outcome(
            Status.OK,
            Found(
                friction=float(one.friction[0]),
                mean_pressure=float(one.pressure[0]),
                half_width=alpha,
                centre=eps,
                strips=np.array([[eps - alpha, eps + alpha]]),
                energy_error=float(energy[k]),
                error_estimate=float(estimate[k]),
                fields=SpectralFields(group.problems[row].layer, group.given[row], one, float(rho[k])),
            ),
            order=n,
            matrices=int(search.matrices[row]),
            nodes=int(search.rule.nodes.shape[1]),
            terms=group.given[row].weights.size,
            way="narrow",
        )
    return done


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
