"""Many loads of one scene: the contact sampled over its half width, once, and interpolated.

With ln α as the parameter nothing has to be searched for: load, friction and place are smooth functions of it, sampled
at Chebyshev points in one batch (one set of nodes, one symbol, stacked linear algebra) and inverted by Newton.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from conveyor.contact.checks import ENERGY_OVER_ERROR, Sign, energy_error, order_error, sign
from conveyor.contact.fields import peak
from conveyor.contact.orders import ORDERS
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.scene import Scene
from conveyor.contact.single import SIGN_ORDER
from conveyor.contact.solution import ContactSolution, SolveStats
from conveyor.contact.solve import solve
from conveyor.contact.spectral import assemble, equilibrium, penetration
from conveyor.errors import InputError, NoSolutionError, RangeError

Array = NDArray[np.float64]

_POINTS = (8, 12, 16, 24, 32, 48, 64)
_ENDS = 1e-3  # the ends need to be known only well enough to be enclosed
_MARGIN = 2e-2  # the sampled range of ln α goes this far beyond the loads asked for
_NEWTON_STEPS = 40
_SIGN_FLOOR = 1e-9
_SPLITS = (
    "the contact separates into several strips: lower the load, thicken the layer, use the confined support, "
    "or solve such loads one by one"
)
_WRAPPED = 0.75  # (a + |e|)/R beyond which one half width may have two loads (docs/method.md)


@dataclass(frozen=True, eq=False)
class LoadSolutions:
    """Figures of many loads of one scene; arrays of the shape of `pressure`, meanings as in ContactSolution."""

    pressure: Array
    friction: Array
    half_width: Array
    eccentricity: Array
    penetration: Array
    peak_pressure: Array
    dissipation: Array
    energy_error: Array
    error_estimate: Array
    stats: SolveStats


@dataclass(frozen=True, eq=False)
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
    _columns: Array  # Chebyshev coefficients of (ln p, μρ/α, ε/α, Δρ²/α², p̂ρ/α), shape (k, 5)

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
        _, friction, eps, depth, peak = chebyshev.chebval(t, self._columns)
        friction = friction * alpha / rho
        times = self.problem.creep.times
        return LoadSolutions(
            pressure=p,
            friction=friction,
            half_width=alpha / rho,
            eccentricity=eps * alpha / rho,
            penetration=depth * (alpha / rho) ** 2,
            peak_pressure=peak * alpha / rho,
            dissipation=friction * p * (float(times[0]) if times.size else 0.0),
            energy_error=np.full(p.shape, self.energy_error),
            error_estimate=np.full(p.shape, self.error),
            stats=self.stats,
        )

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
    ends = [solve(replace(problem, pressure=p), _ENDS) for p in (lowest, highest)]
    scene = Scene.of(problem)
    if any(len(s.patches) > 1 for s in ends):
        raise NoSolutionError(f"between mean pressures {lowest:.6g} and {highest:.6g} {_SPLITS}")
    if wraps(ends[1]):
        raise NoSolutionError(
            f"at the mean pressure {highest:.6g} the contact reaches {ends[1].outer_edge:.2f} R: too far round "
            "the roll for a load curve, solve such loads one by one"
        )
    low, high = (math.log(s.half_width * problem.rho) for s in ends)
    centre, half = 0.5 * (low + high), 0.5 * (high - low) + _MARGIN
    order = max(ORDERS.index(s.stats.order) for s in ends)
    points = 0
    while True:
        sample = _sample(scene, centre, half, points=_POINTS[points], n=ORDERS[order], rtol=rtol)
        if sample.sign is Sign.PULLING:
            raise NoSolutionError(f"between mean pressures {lowest:.6g} and {highest:.6g} {_SPLITS}")
        unsigned = sample.sign is Sign.UNDECIDED and ORDERS[order] < SIGN_ORDER
        undecided = unsigned or sample.order_error > rtol
        if undecided and order + 1 < len(ORDERS):
            order = min(order + (2 if sample.order_error > 100.0 * rtol else 1), len(ORDERS) - 1)
        elif sample.tail > rtol and points + 1 < len(_POINTS):
            points += 1
        else:
            break
    error = max(sample.order_error, sample.tail)
    if not error <= rtol or undecided:
        raise NoSolutionError(
            f"the load curve reached a relative error of {error:.1e} only: "
            "ask for a larger rtol or fewer decades of load"
        )
    stats = SolveStats(
        order=ORDERS[order],
        matrices=scene.matrices + sum(s.stats.matrices for s in ends),
        nodes=scene.rule(math.exp(centre + half)).nodes.size,
        terms=scene.creep.weights.size,
    )
    return LoadCurve(
        problem=problem,
        lowest=lowest,
        highest=highest,
        error=error,
        energy_error=sample.energy_error,
        stats=stats,
        _centre=centre,
        _half=half,
        _columns=sample.columns,
    )


def solve_loads(problem: ContactProblem, pressures: ArrayLike, rtol: float = 1e-6) -> LoadSolutions:
    """Solve many loads of one scene with one shared set-up.

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
        As `load_curve`.

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
    heaviest = solve(replace(problem, pressure=float(p.max())), _ENDS)
    if wraps(heaviest) or len(heaviest.patches) > 1:
        return _one_by_one(problem, p, rtol)
    try:
        return load_curve(problem, float(p.min()), float(p.max()), rtol).at(p)
    except NoSolutionError:
        return _one_by_one(problem, p, rtol)


def wraps(solution: ContactSolution) -> bool:
    """Whether a contact reaches so far round the roll that its half width no longer tells the load."""
    return solution.outer_edge > _WRAPPED


def _one_by_one(problem: ContactProblem, pressures: Array, rtol: float) -> LoadSolutions:
    solved = [solve(replace(problem, pressure=float(p)), rtol) for p in pressures.ravel()]

    def column(name: str) -> Array:
        return np.array([getattr(s, name) for s in solved]).reshape(pressures.shape)

    return LoadSolutions(
        pressure=pressures,
        friction=column("friction"),
        half_width=column("half_width"),
        eccentricity=column("eccentricity"),
        penetration=column("penetration"),
        peak_pressure=column("peak_pressure"),
        dissipation=column("dissipation"),
        energy_error=column("energy_error"),
        error_estimate=column("error_estimate"),
        stats=max((s.stats for s in solved), key=lambda stats: stats.order),
    )


@dataclass(frozen=True, eq=False)
class _Sample:
    """Contacts at Chebyshev points of ln α: interpolation columns and the errors seen."""

    columns: Array
    order_error: float
    tail: float
    energy_error: float
    sign: Sign


def _sample(scene: Scene, centre: float, half: float, *, points: int, n: int, rtol: float) -> _Sample:
    """Contacts at `points` half widths and order n; fields and interpolation only once the order suffices."""
    rho = scene.problem.rho
    t = chebyshev.chebpts1(points)
    alpha = np.exp(centre + half * t)
    rule = scene.rule(float(alpha[-1]))
    matrix = assemble(rule, scene.creep, alpha, n)
    scene.matrices += points
    contact = equilibrium(matrix, alpha, rho)
    if not (contact.inside.all() and (contact.pressure > 0.0).all()):
        raise NoSolutionError(Status.WRAP_LIMIT.message)
    moving = bool((contact.friction > 0.0).all())
    exponent = np.gradient(np.log(contact.friction), np.log(contact.pressure)) if moving else None
    error = float(order_error(contact, matrix, rho, exponent).max())
    energy = math.inf
    if error <= rtol or n == ORDERS[-1]:
        energy = float(energy_error(scene, contact).max())
        error = max(error, energy / ENERGY_OVER_ERROR)
    pressed = sign(contact, max(error, _SIGN_FLOOR))
    if error > rtol and n < ORDERS[-1]:
        return _Sample(np.empty((0, 5)), error, math.inf, energy, pressed)
    fields = np.stack(
        [
            np.log(contact.pressure),
            contact.friction * rho / alpha,
            contact.eps / alpha,
            penetration(rule, scene.creep, contact, rho) * (rho / alpha) ** 2,
            peak(contact.c) * rho / alpha,
        ],
        axis=1,
    )
    columns = chebyshev.chebfit(t, fields, points - 1)
    # the interpolation error of an analytic function is of the size of its last coefficients
    last = np.abs(columns[-2:]).sum(axis=0)
    scale = np.array([1.0, max(float(np.abs(fields[:, 1]).min()), np.finfo(float).tiny)])
    return _Sample(columns, error, float(np.max(last[:2] / scale)), energy, pressed)
