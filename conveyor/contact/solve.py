"""Load control and order control: from a problem to a solution with its error."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.energy import friction_by_loss
from conveyor.contact.problem import ContactProblem, CreepSpectrum, Status
from conveyor.contact.quadrature import CHECK, Rule, build_rule
from conveyor.contact.solution import ContactSolution, Found, SolveStats, surface_series
from conveyor.contact.spectral import Contact, assemble, equilibrium, penetration
from conveyor.errors import InputError, NoSolutionError

Array = NDArray[np.float64]

ORDERS = (8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
_LOAD_STEPS = 60
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising
_LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
_LOAD_ACCEPTED = 1e-9  # a load that stalls below it is kept and its miss reported in error_estimate
_WIDEST = 1.0 - 1e-9
_CLOSED = 1e-10
_WRAP_CHECK = 0.5  # (a + |e|)/R beyond which the gap outside the contact is looked at
_GAP_TOLERANCE = 1e-4  # of the depth; truncation of the series is 1e-7
_ENERGY_OVER_ERROR = (5.0, 50.0)  # seen while n is too small: energy error over true error of friction
_ROUNDING = 1e-14
_DEEP = "the penetration is {:.2f} R, far outside small strain"


@dataclass
class Scene:
    """A problem while it is solved: creep as the solver sees it, quadrature rules made once, counters."""

    problem: ContactProblem
    creep: CreepSpectrum
    rules: dict[str, Rule] = field(default_factory=dict)
    matrices: int = 0

    @classmethod
    def of(cls, problem: ContactProblem) -> Scene:
        """Scene of a problem; terms with ζ = 0 are instantaneous."""
        given = problem.creep
        lasting = given.times > 0.0
        relaxed = given.instantaneous + float(given.weights[~lasting].sum())
        if lasting.all():
            return cls(problem, given)
        return cls(problem, CreepSpectrum(relaxed, given.weights[lasting], given.times[lasting]))

    def rule(self, alpha: float) -> Rule:
        """Quadrature rule good for half width `alpha`; remade with room when a contact outgrows it."""
        rule = self.rules.get("solve")
        if rule is None or alpha > rule.half_width:
            widest = min(1.3 * alpha, 0.5 * (alpha + self.problem.rho))
            rule = self.rules["solve"] = build_rule(self.problem.layer, self.creep, widest)
        return rule

    def matrix(self, alpha: float, n: int) -> Array:
        """Galerkin matrix of one contact, shape (1, n+1, n)."""
        self.matrices += 1
        return assemble(self.rule(alpha), self.creep, np.array([alpha]), n)


@dataclass
class LoadSearch:
    """Root of ln p̃_m(ln α) = ln p̃_m: secant steps between the widest contact too light and the narrowest too heavy."""

    target: float
    log_alpha: float
    slope: float
    low: float = -math.inf
    high: float = math.inf
    last: tuple[float, float] | None = None
    eps: Array | None = None

    def accept(self, log_pressure: float) -> float:
        """Take the load at the present half width, move to the next one; returns the mismatch ln p - target."""
        miss = log_pressure - self.target
        if self.last is not None and self.last[0] != self.log_alpha:
            slope = (log_pressure - self.last[1]) / (self.log_alpha - self.last[0])
            if slope > 0.1:
                self.slope = slope
        self.last = (self.log_alpha, log_pressure)
        if miss < 0.0:
            self.low = max(self.low, self.log_alpha)
        elif miss > 0.0:
            self.high = min(self.high, self.log_alpha)
        step = self.log_alpha - max(-1.5, min(1.5, miss / self.slope))
        if not self.low < step < self.high and math.isfinite(self.low + self.high):
            step = 0.5 * (self.low + self.high)
        self.log_alpha = step
        return miss

    def renew(self) -> None:
        """Forget the bracket: at another order the load of a half width differs slightly."""
        self.low, self.high, self.last = -math.inf, math.inf, None

    def reject(self) -> None:
        """The present half width has no contact on the roll: go back toward a narrower one."""
        self.high = min(self.high, self.log_alpha)
        self.log_alpha = 0.5 * (self.low + self.high) if math.isfinite(self.low) else self.high - 0.7


def solve(problem: ContactProblem, rtol: float = 1e-6, *, throw: bool = True) -> ContactSolution:
    """Solve a steady rolling contact under load control.

    Parameters
    ----------
    problem : ContactProblem
        Layer, roll, load and rubber, dimensionless.
    rtol : float
        Relative error of friction asked for [-], in [1e-12, 1e-2].
    throw : bool
        Raise on any status but OK; False returns it for batches.

    Returns
    -------
    ContactSolution
        Every figure with `error_estimate` and `energy_error`.

    Raises
    ------
    InputError
        rtol outside its range.
    NoSolutionError
        The contact splits, the load wraps the roll, or the tolerance was not reached (throw=True).

    References
    ----------
    Menga, Bottiglione, Carbone, Lubricants 7 (2019), Eqs. (1)-(9), corrected as docs/method.md says.

    Examples
    --------
    >>> creep = CreepSpectrum(instantaneous=0.1, weights=[0.9], times=[1.0])
    >>> s = solve(ContactProblem("free", radius=0.4, thickness=1.0, pressure=0.05, creep=creep), rtol=1e-9)
    >>> round(s.friction, 8), s.status.name
    (0.28505539, 'OK')
    """
    if not 1e-12 <= rtol <= 1e-2:
        raise InputError(f"rtol = {rtol!r}: the tolerance lies in [1e-12, 1e-2]")
    scene = Scene.of(problem)
    solution = _solve(scene, rtol)
    if throw and solution.status is not Status.OK:
        raise NoSolutionError(solution.message)
    return solution


def _solve(scene: Scene, rtol: float) -> ContactSolution:
    """Raise the order until the estimate meets rtol, then close the load and check the energy."""
    search = LoadSearch(math.log(scene.problem.pressure), *guess(scene.problem, scene.creep))
    tight = max(1e-3 * rtol, _LOAD_FLOOR)
    tolerance = _FIRST_LOAD_TOLERANCE
    n = ORDERS[0]
    while True:
        state = carry(scene, search, n, tolerance)
        if state is None:
            return _refused(scene, Status.WRAP_LIMIT, n)
        error = order_error(scene, state)
        if error > rtol and n < ORDERS[-1]:
            n = _next_order(n, error, rtol)
            search.renew()
            continue
        if state.miss > tight:
            tolerance = tight
            continue
        energy = _energy_error(scene, state.contact)
        if energy > _ENERGY_OVER_ERROR[1] * rtol and n < ORDERS[-1]:
            n = _next_order(n, energy, rtol)
            search.renew()
            continue
        return _checked(scene, state, rtol, error=max(error, state.miss), energy=energy)


@dataclass(frozen=True, eq=False)
class State:
    """A contact at one order, its matrix, and how far its load is off (relative)."""

    contact: Contact
    matrix: Array
    miss: float

    @property
    def order(self) -> int:
        """Galerkin order n."""
        return int(self.matrix.shape[2])


def carry(scene: Scene, search: LoadSearch, n: int, tolerance: float) -> State | None:
    """The contact of order n that carries the load to `tolerance`; None where the roll is wrapped before it does."""
    rho = scene.problem.rho
    best: State | None = None
    for _ in range(_LOAD_STEPS):
        alpha = math.exp(search.log_alpha)
        if alpha >= rho * _WIDEST:
            search.reject()
            continue
        matrix = scene.matrix(alpha, n)
        contact = equilibrium(matrix, np.array([alpha]), rho, search.eps)
        if not contact.inside[0] or contact.pressure[0] <= 0.0:
            search.reject()
            if search.high - search.low < _CLOSED:
                break
            continue
        search.eps = contact.eps
        miss = abs(search.accept(math.log(contact.pressure[0])))
        if best is None or miss < best.miss:
            best = State(contact, matrix, miss)
        if miss <= tolerance:
            return best
    return best if best is not None and best.miss <= _LOAD_ACCEPTED else None


def guess(problem: ContactProblem, creep: CreepSpectrum) -> tuple[float, float]:
    """First ln α and d ln p̃_m/d ln α: Hertz, p̃_m = α²/(4ρ² C), with the compliance C = |S| at m = 1/α."""
    rho = problem.rho
    narrow = rho * math.sqrt(problem.pressure * creep.instantaneous)
    widest = 0.8 * rho
    if narrow >= widest:
        return math.log(widest), 2.0
    alpha = np.geomspace(narrow, widest, 48)
    compliance = np.abs(problem.layer.symbol(1.0 / alpha, creep))
    log_alpha = np.log(alpha)
    log_pressure = np.maximum.accumulate(2.0 * np.log(alpha / (2.0 * rho)) - np.log(compliance))
    at = float(np.interp(math.log(problem.pressure), log_pressure, log_alpha))
    return at, 2.0


def order_error(scene: Scene, state: State) -> float:
    """Relative error of friction by order, from the nested matrices of order n/2 and 3n/4 at the same half width.

    Both the friction and the load of a lower order differ; their changes are added. With changes δ(n/2) and δ(3n/4)
    the error at n is δ(3n/4)²/δ(n/2) for geometric convergence; four times that covers n^-3, and δ(3n/4) is the most.
    """
    contact, n = state.contact, state.order
    change = []
    for lower in (n // 2, (3 * n) // 4):
        sub = equilibrium(state.matrix[:, : lower + 1, :lower], contact.alpha, scene.problem.rho, contact.eps)
        if not sub.inside[0]:
            return 1.0
        change.append(
            _relative(float(sub.friction[0]), float(contact.friction[0]))
            + abs(float(sub.pressure[0] / contact.pressure[0]) - 1.0)
        )
    half, most = change
    return most if half <= most else min(most, 4.0 * most * most / half)


def _relative(value: float, reference: float) -> float:
    """|value/reference - 1|; zero where both are zero (an elastic layer has no friction at any order)."""
    if value == reference:
        return 0.0
    return abs(value - reference) / abs(reference) if reference != 0.0 else 1.0


def _next_order(n: int, error: float, rtol: float) -> int:
    """The next order, or the one after where the error is more than two decades off."""
    place = ORDERS.index(n) + (2 if error > 100.0 * rtol else 1)
    return ORDERS[min(place, len(ORDERS) - 1)]


def _energy_error(scene: Scene, contact: Contact) -> float:
    rule = build_rule(scene.problem.layer, scene.creep, float(contact.alpha[0]), CHECK)
    by_loss = friction_by_loss(rule, scene.creep, contact, scene.problem.rho)
    return _relative(float(by_loss[0]), float(contact.friction[0]))


@lru_cache(maxsize=16)
def _sines(n: int) -> Array:
    """sin(vθ) at 4n + 1 inner angles, shape (4n+1, n)."""
    angle = np.arange(1, 4 * n + 2) * (np.pi / (4 * n + 2))
    return np.sin(np.multiply.outer(angle, np.arange(1, n + 1)))


def _splits(contact: Contact, error: float) -> bool:
    """Whether the single-patch pressure turns negative by more than the order's own ripple."""
    p = _sines(contact.c.shape[1]) @ contact.c[0]
    ripple = max(float(np.max(np.abs(contact.c[0, -2:]))) / float(p.max()), error, 1e-12)
    return bool(p.min() < -10.0 * ripple * p.max())


def _overlaps(scene: Scene, contact: Contact, depth: float) -> bool:
    """Whether the layer's surface lies inside the roll outside the contact (a wrong root under strong wrap)."""
    rho = scene.problem.rho
    edge = np.array([-1.0, 1.0]) * contact.alpha[0]
    reach = np.array([-rho - contact.eps[0], rho - contact.eps[0]])
    place = np.linspace(0.02, 1.0, 50)
    x = np.concatenate([edge[k] + place * (reach[k] - edge[k]) for k in (0, 1)])
    roll = depth - 1.0 + np.sqrt(np.maximum(1.0 - ((x + contact.eps[0]) / rho) ** 2, 0.0))
    gap = surface_series(scene.problem, scene.creep, contact, x) - roll
    return bool(gap.min() < -_GAP_TOLERANCE * abs(depth))


def _checked(scene: Scene, state: State, rtol: float, *, error: float, energy: float) -> ContactSolution:
    """Accept a contact only with p ≥ 0 inside and no overlap outside; attach its errors and remarks."""
    contact, rho = state.contact, scene.problem.rho
    if _splits(contact, error):
        return _refused(scene, Status.SPLIT, state.order)
    alpha, eps = float(contact.alpha[0]), abs(float(contact.eps[0]))
    depth = float(penetration(scene.rule(alpha), scene.creep, contact, rho)[0])
    if (alpha + eps) > _WRAP_CHECK * rho and _overlaps(scene, contact, depth):
        return _refused(scene, Status.SPLIT, state.order)
    estimate = max(error, energy / _ENERGY_OVER_ERROR[0], _ROUNDING)
    status = Status.OK if estimate <= rtol else Status.NOT_CONVERGED
    advice = (_DEEP.format(depth),) if depth > 1.0 else ()
    found = Found(contact, depth, energy, estimate, scene.creep)
    return ContactSolution(scene.problem, status, _stats(scene, state.order), advice, found)


def _refused(scene: Scene, status: Status, n: int) -> ContactSolution:
    return ContactSolution(scene.problem, status, _stats(scene, n))


def _stats(scene: Scene, n: int) -> SolveStats:
    rule = scene.rules.get("solve")
    return SolveStats(n, scene.matrices, rule.nodes.size if rule else 0, scene.creep.weights.size)
