"""Order control: from a problem to a solution with its error."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from conveyor.contact.checks import (
    ENERGY_OVER_ERROR,
    Sign,
    energy_error,
    order_error,
    overlaps,
    relative_difference,
    sign,
)
from conveyor.contact.load import LoadSearch, carry, guess
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.quadrature import RuleTooLongError
from conveyor.contact.scene import Scene, State
from conveyor.contact.solution import ContactSolution, Found, SolveStats
from conveyor.contact.spectral import penetration
from conveyor.contact.wrap import follow, settle
from conveyor.errors import InputError, NoSolutionError

ORDERS = (16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising
_LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
_ROUNDING = 1e-14
_WRAPPED = 0.5  # (a + |e|)/R beyond which a second eccentricity and a gap outside are looked for
_FULLY_WRAPPED = 0.98
_LIGHT_ORDER, _PATH_ORDER, _LIGHTEST = 16, 24, 14
SIGN_ORDER = 256  # splits show below it; a dip that lasts is an edge layer that friction does not feel
_EDGE_LAYER = "a layer at the contact's edge is thinner than the order resolves: pressure ripples there"
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
    >>> from conveyor.contact import CreepSpectrum
    >>> creep = CreepSpectrum(instantaneous=0.1, weights=[0.9], times=[1.0])
    >>> s = solve(ContactProblem("free", radius=0.4, thickness=1.0, pressure=0.05, creep=creep), rtol=1e-9)
    >>> round(s.friction, 8), s.status.name
    (0.28505539, 'OK')
    """
    if not 1e-12 <= rtol <= 1e-2:
        raise InputError(f"rtol = {rtol!r}: the tolerance lies in [1e-12, 1e-2]")
    scene = Scene.of(problem)
    try:
        solution = _solve(scene, rtol)
    except RuleTooLongError:
        solution = _refused(scene, Status.TOO_THIN, 0)
    if throw and solution.status is not Status.OK:
        raise NoSolutionError(solution.message)
    return solution


def _solve(scene: Scene, rtol: float) -> ContactSolution:
    """The contact by half width; where that fails or splits under wrap, the contact by load."""
    found = _by_half_width(scene, rtol)
    if found is not None:
        solution = _checked(scene, *found, rtol)
        if solution.status is not Status.SPLIT or _edge(found[0], scene) <= _WRAPPED:
            return solution
    return _by_load(scene, rtol)


def _by_half_width(scene: Scene, rtol: float) -> tuple[State, float, float] | None:
    """Raise the order until the estimate meets rtol, then close the load and check the energy."""
    search = LoadSearch(math.log(scene.problem.pressure), *guess(scene.problem, scene.creep))
    tight = max(1e-3 * rtol, _LOAD_FLOOR)
    tolerance = _FIRST_LOAD_TOLERANCE
    n = ORDERS[0]
    while True:
        state = carry(scene, search, n, tolerance)
        if state is None:
            return None
        error = float(order_error(state.contact, state.matrix, scene.problem.rho, search.exponent)[0])
        if error <= rtol or n == ORDERS[-1]:
            if state.miss > tight and tolerance > tight:
                tolerance = tight
                continue
            energy = float(energy_error(scene, state.contact)[0])
            error = max(error, state.miss, energy / ENERGY_OVER_ERROR)
            decided = n >= SIGN_ORDER or sign(state.contact, rtol) is not Sign.UNDECIDED
            settled = error <= rtol and decided
            if settled or n == ORDERS[-1]:
                return state, error, energy
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
        # the path of a single patch ends inside the roll only where the layer pulls off or touches again
        pressing = sign(state.contact, rtol) is Sign.PRESSING
        status = Status.WRAP_LIMIT if pressing and _edge(state, scene) > _FULLY_WRAPPED else Status.SPLIT
        return _refused(scene, status, _PATH_ORDER, _LIMIT.format(math.exp(reached)))
    tight = max(1e-3 * rtol, _LOAD_FLOOR)
    for n in ORDERS[ORDERS.index(_PATH_ORDER) + 1 :]:
        place = np.array([math.log(state.contact.alpha[0]), state.contact.eps[0]])
        finer = settle(scene, n, place, target, tight)
        if finer is None:
            return _refused(scene, Status.NOT_CONVERGED, n)
        error = float(np.abs(relative_difference(state.contact.friction, finer.contact.friction))[0])
        state = finer
        if error > rtol and n < ORDERS[-1]:
            continue
        energy = float(energy_error(scene, state.contact)[0])
        error = max(error, energy / ENERGY_OVER_ERROR)
        decided = n >= SIGN_ORDER or sign(state.contact, rtol) is not Sign.UNDECIDED
        if error <= rtol and decided:
            break
    return _checked(scene, state, error, energy, rtol)


def _light(scene: Scene) -> State | None:
    """A contact of the same scene under a load light enough not to wrap the roll."""
    target = math.log(scene.problem.pressure)
    start, slope = guess(scene.problem, scene.creep)
    for decade in range(1, _LIGHTEST):
        drop = decade * math.log(10.0)
        search = LoadSearch(target - drop, start - drop / slope, slope)
        state = carry(scene, search, _LIGHT_ORDER, 1e-6)
        if state is not None and _edge(state, scene) <= _WRAPPED:
            return state
    return None


def _edge(state: State, scene: Scene) -> float:
    """(a + |e|)/R, the outer edge."""
    return (float(state.contact.alpha[0]) + abs(float(state.contact.eps[0]))) / scene.problem.rho


def _next_order(n: int, error: float, rtol: float) -> int:
    """The next order, or the one after where the error is more than two decades off."""
    place = ORDERS.index(n) + (2 if error > 100.0 * rtol else 1)
    return ORDERS[min(place, len(ORDERS) - 1)]


def _checked(scene: Scene, state: State, error: float, energy: float, rtol: float) -> ContactSolution:
    """Accept a contact only with p ≥ 0 inside and no overlap outside; attach its errors and remarks."""
    contact, rho = state.contact, scene.problem.rho
    pressed = sign(contact, rtol)
    if pressed is Sign.PULLING:
        return _refused(scene, Status.SPLIT, state.order)
    rule = scene.rule(float(contact.alpha[0]))
    depth = float(penetration(rule, scene.creep, contact, rho)[0])
    if _edge(state, scene) > _WRAPPED and overlaps(scene, contact, depth):
        return _refused(scene, Status.SPLIT, state.order)
    estimate = max(error, _ROUNDING)
    found = Found(contact, depth, energy, estimate, scene.creep)
    status = Status.OK if estimate <= rtol else Status.NOT_CONVERGED
    advice = []
    if depth > 1.0:
        advice.append(_DEEP.format(depth))
    if pressed is Sign.UNDECIDED:
        advice.append(_EDGE_LAYER)
    return ContactSolution(scene.problem, status, _stats(scene, state.order), tuple(advice), found)


def _refused(scene: Scene, status: Status, n: int, *advice: str) -> ContactSolution:
    return ContactSolution(scene.problem, status, _stats(scene, n), advice)


def _stats(scene: Scene, n: int) -> SolveStats:
    rule = scene.rules.get("solve")
    return SolveStats(n, scene.matrices, rule.nodes.size if rule else 0, scene.creep.weights.size)


def solve_many(
    problems: Sequence[ContactProblem], rtol: float = 1e-6, *, throw: bool = False
) -> list[ContactSolution]:
    """Solve scenes of any kind, in their order; by default a refused one is returned with its status, not raised."""
    return [solve(problem, rtol, throw=throw) for problem in problems]
