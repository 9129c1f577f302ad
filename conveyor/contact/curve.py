"""Many loads of one scene: the contact sampled over its half width, once, and interpolated.

With ln α as the parameter nothing has to be searched for: load, friction and place are smooth functions of it, sampled
at Chebyshev-Lobatto points in one batch (one set of nodes, one symbol, stacked linear algebra) and inverted by Newton.
The points of one degree are every other point of the next: what the interpolant through those misses at the points
between, where the error of Chebyshev interpolation peaks, bounds the error of the interpolant through all.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments import checked
from conveyor.contact.checks import ENERGY_OVER_ERROR, Sign, order_error, relative_difference, sign
from conveyor.contact.energy import friction_by_loss
from conveyor.contact.excitation import excited_harmonics
from conveyor.contact.fields import peak
from conveyor.contact.lobatto import coefficients, interpolated, points, weave, woven
from conveyor.contact.narrow import LOW_ORDER_FROM, places, shared_rules
from conveyor.contact.orders import ORDERS, next_order
from conveyor.contact.problem import ContactProblem, Status, check_rtol
from conveyor.contact.quadrature import CHECK, Rule, build_rule
from conveyor.contact.scene import Scene, instantly_relaxed
from conveyor.contact.short_rule import ShortRule, grades_for
from conveyor.contact.single import ROUNDING, SIGN_ORDER
from conveyor.contact.solution import ContactSolution, SolveStats
from conveyor.contact.solve import solve
from conveyor.contact.spectral import Contact, assemble, equilibrium, penetration
from conveyor.errors import InputError, NoSolutionError, RangeError

Array = NDArray[np.float64]

_DEGREES = (16, 32, 64, 128)
_ENDS = 1e-3  # the ends need to be known only well enough to be enclosed
MARGIN = 1e-2  # the sampled range of ln α goes this far beyond the loads asked for
_NEWTON_STEPS, SIGN_FLOOR = 40, 1e-9
_SPLITS = (
    "the contact separates into several strips: lower the load, thicken the layer, use the confined support, "
    "or solve such loads one by one"
)
_WRAPPED = 0.75  # (a + |e|)/R beyond which one half width may have two loads (docs/method.md)


@dataclass(frozen=True, eq=False)
class LoadSolutions:
    """Figures of many loads of one scene; arrays of the shape of `pressure`, meanings as in ContactSolution.

    Penetration and peak pressure are formed when asked for.
    """

    pressure: Array
    friction: Array
    half_width: Array
    eccentricity: Array
    dissipation: Array
    energy_error: Array
    error_estimate: Array
    stats: SolveStats
    _later: Callable[[str], Array]  # a partial of a function at the top: solutions pickle

    @cached_property
    def penetration(self) -> Array:
        """Δ/R [-]."""
        return self._later("penetration")

    @cached_property
    def peak_pressure(self) -> Array:
        """Largest p̃ [-]."""
        return self._later("peak_pressure")


@dataclass(frozen=True, eq=False, repr=False)
class LoadCurve:
    """Contact of one scene as a function of load, good between two mean pressures.

    Attributes
    ----------
    problem : ContactProblem
        The scene; its pressure is the largest of the curve.
    lowest, highest : float
        Range of p̃_m [-].
    error : float
        Estimated relative error of friction anywhere on the curve: order, energy and interpolation [-].
    energy_error : float
        Largest relative difference of friction by geometry and by loss at the sampled points [-].
    stats : SolveStats
        What the curve cost.
    """

    problem: ContactProblem
    lowest: float
    highest: float
    error: float
    energy_error: float
    stats: SolveStats
    _centre: float
    _half: float
    _contacts: Contact  # at the Chebyshev-Lobatto points, from the widest to the narrowest
    _columns: Array  # Chebyshev coefficients of (ln p, μρ/α, ε/α), shape (k, 3)

    def _repr_html_(self) -> str:
        """For notebooks: the range of load, and the contact at its ends."""
        from conveyor.markup import listing

        ends = self.at([self.lowest, self.highest])
        there = [("friction there", ends.friction), ("half_width there", ends.half_width)]
        rows = [("mean pressure p̃_m", f"{self.lowest:.6g} to {self.highest:.6g}")]
        rows += [(name, " to ".join(f"{value:.6g}" for value in found)) for name, found in there]
        rows.append(("relative error of friction", f"{self.error:.1e}"))
        return listing("LoadCurve, lengths over R", rows)

    def at(self, pressure: ArrayLike) -> LoadSolutions:
        """Figures at mean pressures p̃_m.

        Raises
        ------
        RangeError
            A pressure outside the curve: it is not extrapolated.
        """
        p = np.asarray(pressure, dtype=float)
        slack = 1e-12
        if not np.all((p >= self.lowest * (1.0 - slack)) & (p <= self.highest * (1.0 + slack))):
            raise RangeError(
                f"p̃_m from {p.min():.6g} to {p.max():.6g}: the load curve holds from {self.lowest:.6g} "
                f"to {self.highest:.6g}"
            )
        t = self._place(np.log(p))
        alpha = np.exp(self._centre + self._half * t)
        rho = self.problem.rho
        _, friction, eps = chebyshev.chebval(t, self._columns)
        friction = friction * alpha / rho
        times = self.problem.creep.times
        return LoadSolutions(
            pressure=p,
            friction=friction,
            half_width=alpha / rho,
            eccentricity=eps * alpha / rho,
            dissipation=friction * p * (float(times[0]) if times.size else 0.0),
            energy_error=np.full(p.shape, self.energy_error),
            error_estimate=np.full(p.shape, self.error),
            stats=self.stats,
            _later=partial(self._figure, t, alpha / rho),
        )

    def _figure(self, t: Array, width: Array, name: str) -> Array:
        if name == "penetration":
            return np.asarray(chebyshev.chebval(t, self._depths) * width**2)
        return np.asarray(chebyshev.chebval(t, self._peaks) * width)

    @cached_property
    def excitation_widest(self) -> Array:
        """Harmonics below which the shares 5, 50 and 95 % of the widest contact's loss lie; empty without loss."""
        return self._excitation(0)

    @cached_property
    def excitation_narrowest(self) -> Array:
        """The same of the narrowest contact."""
        return self._excitation(-1)

    def _excitation(self, k: int) -> Array:
        contacts = self._contacts
        if not (contacts.friction > 0.0).all():
            return np.empty(0)
        strip = float(contacts.eps[k]), float(contacts.alpha[k]), contacts.c[k]
        return excited_harmonics(self.problem.layer, instantly_relaxed(self.problem.creep), [strip])

    @cached_property
    def _depths(self) -> Array:
        """Chebyshev coefficients of Δρ²/α²."""
        scene = Scene.of(self.problem)
        alpha, rho = self._contacts.alpha, self.problem.rho
        depth = penetration(scene.rule(float(alpha.max())), scene.creep, self._contacts, rho)
        return coefficients((depth * (rho / alpha) ** 2)[:, None])[:, 0]

    @cached_property
    def _peaks(self) -> Array:
        """Chebyshev coefficients of p̂ρ/α."""
        scaled = peak(self._contacts.c) * self.problem.rho / self._contacts.alpha
        return coefficients(scaled[:, None])[:, 0]

    def _place(self, log_p: Array) -> Array:
        """Place t in [-1, 1] with ln p(t) = log_p: Newton from the chord, on a monotone smooth function."""
        column = self._columns[:, 0]
        slope = chebyshev.chebder(column)
        ends = chebyshev.chebval(np.array([-1.0, 1.0]), column)
        t: Array = 2.0 * (log_p - ends[0]) / (ends[1] - ends[0]) - 1.0
        for _ in range(_NEWTON_STEPS):
            step = (chebyshev.chebval(t, column) - log_p) / chebyshev.chebval(t, slope)
            t = t - step
            if np.all(np.abs(step) < 1e-14):
                break
        return t


@checked
def load_curve(problem: ContactProblem, lowest: float, highest: float, rtol: float = 1e-6) -> LoadCurve:
    """Sample a scene between two loads until friction is known to `rtol` anywhere between.

    Parameters
    ----------
    problem : ContactProblem
        The scene; its own pressure is not used.
    lowest, highest : float
        Range of p̃_m [-].
    rtol : float
        Relative error of friction asked for [-].

    Raises
    ------
    InputError
        lowest > highest.
    NoSolutionError
        A load of the range has no single-strip contact, or the tolerance was not reached.
    """
    if not 0.0 < lowest <= highest:
        raise InputError(f"loads from {lowest!r} to {highest!r}: give 0 < lowest <= highest")
    problem = replace(problem, pressure=highest)
    check_rtol(rtol)
    sampler = _Sampler.between(problem, lowest, highest, rtol)
    n = ORDERS[0 if rtol >= LOW_ORDER_FROM else 1]
    degree, sampled = 0, None
    while True:
        sampled = sampler.sample(_DEGREES[degree], n, sampled)
        error, energy, pressed = sampler.judge(sampled, rtol)
        if pressed is Sign.PULLING:
            raise NoSolutionError(f"between mean pressures {lowest:.6g} and {highest:.6g} {_SPLITS}")
        undecided = error > rtol or (pressed is Sign.UNDECIDED and n < SIGN_ORDER)
        if undecided and n < ORDERS[-1]:
            n, sampled = next_order(n, error, rtol), None
            continue
        columns, missed = interpolated(sampled.contact, problem.rho, _DEGREES[degree])
        if missed[0] <= rtol or degree + 1 == len(_DEGREES):
            break
        degree += 1
    error = max(error, float(missed[0]))
    if not error <= rtol or undecided:
        raise NoSolutionError(
            f"the load curve reached a relative error of {error:.1e} only: "
            "ask for a larger rtol or fewer decades of load"
        )
    return LoadCurve(
        problem=problem,
        lowest=lowest,
        highest=highest,
        error=error,
        energy_error=energy,
        stats=SolveStats(
            n, sampler.matrices, sampler.rule.nodes.shape[-1], sampler.scene.creep.weights.size, way="curve"
        ),
        _centre=sampler.centre,
        _half=sampler.half,
        _contacts=sampled.contact,
        _columns=columns[0],
    )


@checked
def solve_loads(problem: ContactProblem, pressures: ArrayLike, rtol: float = 1e-6) -> LoadSolutions:
    """Solve many loads of one scene with one shared set-up.

    Loads whose contact splits or wraps the roll are solved one by one.

    Parameters
    ----------
    problem : ContactProblem
        The scene; its own pressure is not used.
    pressures : array_like
        Mean pressures p̃_m [-], positive.
    rtol : float
        Relative error of friction asked for [-].

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
    p = np.asarray(pressures, dtype=float)
    if p.size == 0 or not np.all(np.isfinite(p) & (p > 0.0)):
        raise InputError("pressures: give one or more finite positive mean pressures")
    try:
        return load_curve(problem, float(p.min()), float(p.max()), rtol).at(p)
    except NoSolutionError:
        return _one_by_one(problem, p, rtol)


def wraps(solution: ContactSolution) -> bool:
    """Whether a contact reaches so far round the roll that its half width no longer tells the load."""
    return solution.outer_edge > _WRAPPED


def _one_by_one(problem: ContactProblem, pressures: Array, rtol: float) -> LoadSolutions:
    solved = [solve(replace(problem, pressure=float(p)), rtol) for p in pressures.ravel()]
    column = partial(_column, solved, pressures.shape)
    return LoadSolutions(
        pressure=pressures,
        friction=column("friction"),
        half_width=column("half_width"),
        eccentricity=column("eccentricity"),
        dissipation=column("dissipation"),
        energy_error=column("energy_error"),
        error_estimate=column("error_estimate"),
        stats=max((s.stats for s in solved), key=lambda stats: stats.order),
        _later=column,
    )


def _column(solved: list[ContactSolution], shape: tuple[int, ...], name: str) -> Array:
    return np.array([getattr(solution, name) for solution in solved]).reshape(shape)


@dataclass(frozen=True, eq=False)
class _Sampled:
    """Contacts at Chebyshev-Lobatto points, and their matrices."""

    contact: Contact
    matrix: Array


@dataclass(eq=False)
class _Sampler:
    """One scene between two half widths: rules made once, contacts at any of them."""

    scene: Scene
    centre: float
    half: float
    rule: Rule | ShortRule
    check: Rule | ShortRule
    floor: float  # of the error, by the rule
    matrices: int = 0

    @classmethod
    def between(cls, problem: ContactProblem, lowest: float, highest: float, rtol: float) -> _Sampler:
        """Range of half widths of a range of loads, and the cheapest rules for it."""
        ends = places(problem, (lowest, highest))
        if ends is None:
            ends = _general_ends(problem, lowest, highest)
        low, high = np.log(ends)
        centre, half = 0.5 * (low + high), 0.5 * (high - low) + MARGIN
        scene, widest = Scene.of(problem), math.exp(centre + half)
        rules = shared_rules(problem, widest, rtol)
        if rules is not None:
            return cls(scene, centre, half, *rules, grades_for(rtol)[0].error)
        check = build_rule(problem.layer, scene.creep, widest, CHECK)
        return cls(scene, centre, half, build_rule(problem.layer, scene.creep, widest), check, ROUNDING)

    def sample(self, degree: int, n: int, before: _Sampled | None) -> _Sampled:
        """Contacts at the degree's points, those of half the degree taken from `before`."""
        t = points(degree)
        fresh = t if before is None else t[1::2]
        alpha = np.exp(self.centre + self.half * fresh)
        matrix = assemble(self.rule, self.scene.creep, alpha, n)
        self.matrices += fresh.size
        contact = equilibrium(matrix, alpha, self.scene.problem.rho)
        if not (contact.inside.all() and (contact.pressure > 0.0).all()):
            raise NoSolutionError(Status.WRAP_LIMIT.message)
        if before is None:
            return _Sampled(contact, matrix)
        return _Sampled(woven(before.contact, contact), weave(before.matrix, matrix))

    def judge(self, sampled: _Sampled, rtol: float) -> tuple[float, float, Sign]:
        """Largest error by order and energy, largest energy error (infinite where not yet asked), worst sign."""
        contact, rho = sampled.contact, self.scene.problem.rho
        moving = bool((contact.friction > 0.0).all())
        exponent = np.gradient(np.log(contact.friction), np.log(contact.pressure)) if moving else None
        error = float(order_error(contact, sampled.matrix, rho, exponent).max())
        energy = math.inf
        if error <= rtol or contact.c.shape[1] == ORDERS[-1]:
            by_loss = friction_by_loss(self.check, self.scene.creep, contact, rho)
            energy = float(np.abs(relative_difference(by_loss, contact.friction)).max())
            error = max(error, energy / ENERGY_OVER_ERROR, self.floor)
        return error, energy, sign(contact, max(error, SIGN_FLOOR))


def _general_ends(problem: ContactProblem, lowest: float, highest: float) -> Array:
    """Half widths at both loads from the general solver, which knows splits and wraps."""
    ends = [solve(replace(problem, pressure=p), _ENDS) for p in (lowest, highest)]
    if any(len(s.patches) > 1 for s in ends):
        raise NoSolutionError(f"between mean pressures {lowest:.6g} and {highest:.6g} {_SPLITS}")
    if wraps(ends[1]):
        raise NoSolutionError(
            f"at the mean pressure {highest:.6g} the contact reaches {ends[1].outer_edge:.2f} R: too far round "
            "the roll for a load curve, solve such loads one by one"
        )
    return np.array([s.half_width * problem.rho for s in ends])
