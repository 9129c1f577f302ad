"""Order control: from a problem to a solution with its error."""

from __future__ import annotations

import math

import numpy as np

from conveyor.contact.checks import energy_error, order_error, overlaps, relative_difference, splits
from conveyor.contact.load import LoadSearch, carry, guess
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.scene import Scene, State
from conveyor.contact.solution import ContactSolution, Found, SolveStats
from conveyor.contact.spectral import penetration
from conveyor.contact.wrap import follow, settle
from conveyor.errors import InputError, NoSolutionError

ORDERS = (8, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising
_LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
_ENERGY_OVER_ERROR = 10.0  # energy error over true error of friction while n is too small: 5 to 80 seen
_ROUNDING = 1e-14
_WRAPPED = 0.5  # (a + |e|)/R beyond which a second eccentricity and a gap outside are looked for
_LIGHT_ORDER, _PATH_ORDER, _LIGHTEST = 16, 24, 14
_DEEP = "the penetration is {:.2f} R, far outside small strain"
_LIMIT = "the largest mean pressure reached is {:.6g}"


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
    """The contact by half width; where that fails or splits under wrap, the contact by load."""
    found = _by_half_width(scene, rtol)
    if found is not None:
        solution = _checked(scene, *found, rtol)
        if solution.status is not Status.SPLIT or not _is_wrapped(found[0], scene.problem.rho):
            return solution
    return _by_load(scene, rtol)


def _by_half_width(scene: Scene, rtol: float) -> tuple[State, float] | None:
    """Raise the order until the estimate meets rtol, then close the load and check the energy."""
    search = LoadSearch(math.log(scene.problem.pressure), *guess(scene.problem, scene.creep))
    tight = max(1e-3 * rtol, _LOAD_FLOOR)
    tolerance = _FIRST_LOAD_TOLERANCE
    n = ORDERS[0]
    while True:
        state = carry(scene, search, n, tolerance)
        if state is None:
            return None
        error = order_error(state, scene.problem.rho, search.exponent)
        if error <= rtol or n == ORDERS[-1]:
            if state.miss > tight and tolerance > tight:
                tolerance = tight
                continue
            error = max(error, state.miss, energy_error(scene, state.contact) / _ENERGY_OVER_ERROR)
            if error <= rtol or n == ORDERS[-1]:
                return state, error
        n = _next_order(n, error, rtol)
        search.renew()


def _by_load(scene: Scene, rtol: float) -> ContactSolution:
    """Follow the contact from a light load, then raise the order until friction settles at the load itself."""
    light = _light(scene)
    if light is None:
        return _refused(scene, Status.WRAP_LIMIT, _LIGHT_ORDER)
    state, reached = follow(scene, light, _PATH_ORDER)
    target = math.log(scene.problem.pressure)
    if reached < target:
        status = Status.SPLIT if splits(state.contact, rtol) else Status.WRAP_LIMIT
        return _refused(scene, status, _PATH_ORDER, _LIMIT.format(math.exp(reached)))
    tight = max(1e-3 * rtol, _LOAD_FLOOR)
    for n in ORDERS[ORDERS.index(_PATH_ORDER) + 1 :]:
        place = np.array([math.log(state.contact.alpha[0]), state.contact.eps[0]])
        finer = settle(scene, n, place, target, tight)
        if finer is None:
            return _refused(scene, Status.NOT_CONVERGED, n)
        error = abs(relative_difference(float(state.contact.friction[0]), float(finer.contact.friction[0])))
        state = finer
        if error <= rtol:
            error = max(error, energy_error(scene, state.contact) / _ENERGY_OVER_ERROR)
            if error <= rtol:
                break
    return _checked(scene, state, error, rtol)


def _light(scene: Scene) -> State | None:
    """A contact of the same scene under a load light enough not to wrap the roll."""
    target = math.log(scene.problem.pressure)
    start, slope = guess(scene.problem, scene.creep)
    for decade in range(1, _LIGHTEST):
        drop = decade * math.log(10.0)
        search = LoadSearch(target - drop, start - drop / slope, slope)
        state = carry(scene, search, _LIGHT_ORDER, 1e-6)
        if state is not None and not _is_wrapped(state, scene.problem.rho):
            return state
    return None


def _is_wrapped(state: State, rho: float) -> bool:
    return float(state.contact.alpha[0]) + abs(float(state.contact.eps[0])) > _WRAPPED * rho


def _next_order(n: int, error: float, rtol: float) -> int:
    """The next order, or the one after where the error is more than two decades off."""
    place = ORDERS.index(n) + (2 if error > 100.0 * rtol else 1)
    return ORDERS[min(place, len(ORDERS) - 1)]


def _checked(scene: Scene, state: State, error: float, rtol: float) -> ContactSolution:
    """Accept a contact only with p ≥ 0 inside and no overlap outside; attach its errors and remarks."""
    contact, rho = state.contact, scene.problem.rho
    if splits(contact, error):
        return _refused(scene, Status.SPLIT, state.order)
    rule = scene.rule(float(contact.alpha[0]))
    depth = float(penetration(rule, scene.creep, contact, rho)[0])
    if _is_wrapped(state, rho) and overlaps(scene, contact, depth):
        return _refused(scene, Status.SPLIT, state.order)
    estimate = max(error, _ROUNDING)
    found = Found(contact, depth, energy_error(scene, contact), estimate, scene.creep)
    status = Status.OK if estimate <= rtol else Status.NOT_CONVERGED
    advice = (_DEEP.format(depth),) if depth > 1.0 else ()
    return ContactSolution(scene.problem, status, _stats(scene, state.order), advice, found)


def _refused(scene: Scene, status: Status, n: int, *advice: str) -> ContactSolution:
    return ContactSolution(scene.problem, status, _stats(scene, n), advice)


def _stats(scene: Scene, n: int) -> SolveStats:
    rule = scene.rules.get("solve")
    return SolveStats(n, scene.matrices, rule.nodes.size if rule else 0, scene.creep.weights.size)
