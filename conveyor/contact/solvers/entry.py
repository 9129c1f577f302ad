"""Solve a contact problem: as one strip by its half width, else with any number of strips."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from conveyor.arguments.argument_types import check_arguments
from conveyor.arguments.limits import require
from conveyor.contact.galerkin.quadrature import RuleTooLongError
from conveyor.contact.problem import LARGEST_RTOL, ContactProblem, Status, check_rtol
from conveyor.contact.solution import ContactSolution, SolveOutcome, SolveStats
from conveyor.contact.solvers.many_strips import CoarseContact, solve_strips
from conveyor.contact.solvers.one_strip import HalfWidthStart, solve_one_strip
from conveyor.contact.solvers.one_strip_batch import UnsolvedReason, solve_batch
from conveyor.contact.solvers.refinement import RefinementEnd, better_outcome
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.errors import NoSolutionError

_SHALLOWEST, _DEEPEST = 1e-28, 1e3  # of penetrations over R: the loads of others underflow or lead beyond the roll
_ESTIMATE_REMARK = "friction is known to {:.1e} of itself"


@check_arguments
def solve(problem: ContactProblem, rtol: float = 1e-6, *, throw: bool = True) -> ContactSolution:
    """Solve a steady rolling contact under load control.

    Parameters
    ----------
    problem : ContactProblem
        Layer, roll, load and rubber, dimensionless.
    rtol : float
        Relative error of friction allowed [-], in [1e-12, 1e-2].
    throw : bool
        Raise where the tolerance is not met; False returns the status, for batches.

    Returns
    -------
    ContactSolution
        Results with `error_estimate` and `energy_error`.

    Raises
    ------
    InputError
        rtol outside its range.
    NoSolutionError
        The load wraps the roll, or the tolerance was not reached (throw=True).

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
    return _solve_all([problem], rtol, throw)[0]


@check_arguments
def solve_penetration(
    problem: ContactProblem, penetration: float, rtol: float = 1e-6, *, throw: bool = True
) -> ContactSolution:
    """Solve a steady rolling contact at a given penetration instead of a load.

    Parameters
    ----------
    problem : ContactProblem
        Layer, roll and rubber; its own pressure is not used.
    penetration : float
        Δ/R [-], positive: mean line of the deformed surface to the roll's crown.
    rtol, throw
        As in `solve`; rtol also holds the penetration.

    Returns
    -------
    ContactSolution
        Its `problem` has the mean pressure that belongs to the penetration.

    Raises
    ------
    InputError
        rtol or penetration outside its range.
    NoSolutionError
        As in `solve`.

    Examples
    --------
    >>> from conveyor.contact import CreepSpectrum
    >>> scene = ContactProblem("confined", 0.4, 1.0, CreepSpectrum(0.1, [0.9], [1.0]), thickness=1.0)
    >>> s = solve_penetration(scene, 0.0378398947)
    >>> round(s.problem.pressure, 6), round(s.friction, 5)
    (0.05, 0.13098)
    """
    ok = _SHALLOWEST <= penetration <= _DEEPEST
    require(ok, "penetration", penetration, f">= {_SHALLOWEST:g} and <= {_DEEPEST:g} (Δ/R)")
    check_rtol(rtol)
    return _solve_alone(problem, penetration, rtol, throw)


@check_arguments
def solve_many(problems: Sequence[ContactProblem], rtol: float = 1e-6, *, throw: bool = False) -> list[ContactSolution]:
    """Solve many problems, in their order; by default a refused one is returned with its status, not raised.

    Contacts of one strip on the same kind of layer are solved in a batch.

    Raises
    ------
    InputError
        rtol outside its range.
    NoSolutionError
        As `solve`, for the first problem without a solution (throw=True).
    """
    return _solve_all(problems, rtol, throw)


def _solve_all(problems: Sequence[ContactProblem], rtol: float, throw: bool) -> list[ContactSolution]:
    check_rtol(rtol)
    return [
        _make_solution(problem, outcome, throw)
        if isinstance(outcome, SolveOutcome)
        else _solve_alone(problem, None, rtol, throw, outcome)
        for problem, outcome in zip(problems, solve_batch(problems, rtol), strict=True)
    ]


def _solve_alone(
    problem: ContactProblem,
    depth: float | None,
    rtol: float,
    throw: bool,
    left: UnsolvedReason | HalfWidthStart | None = None,
) -> ContactSolution:
    """Solve one problem by itself; what misses the tolerance is the best of this and coarser tolerances."""
    outcome = _find_outcome(problem, depth, rtol, left)
    if outcome.status is Status.NOT_CONVERGED:
        outcome = _best_outcome(problem, depth, rtol, outcome)
    if depth is not None and outcome.found is not None:
        problem = replace(problem, pressure=outcome.found.mean_pressure)
    return _make_solution(problem, outcome, throw)


def _best_outcome(problem: ContactProblem, depth: float | None, rtol: float, outcome: SolveOutcome) -> SolveOutcome:
    """The outcome of the smallest estimate: this one, or one of the tolerances between rtol and its estimate."""
    told = 1.0 if outcome.found is None else outcome.found.error_estimate
    if outcome.way == "grid" and outcome.grid:
        return outcome  # another tolerance comes to the same grids
    decades = math.floor(math.log10(min(told, LARGEST_RTOL) / rtol))
    best = outcome
    for decade in range(decades, 0, -1):
        coarser = min(rtol * 10.0**decade, LARGEST_RTOL)
        left = solve_batch([problem], coarser)[0] if depth is None else None
        other = left if isinstance(left, SolveOutcome) else _find_outcome(problem, depth, coarser, left)
        if other.found is not None and (best.found is None or other.found.error_estimate < best.found.error_estimate):
            met = other.found.error_estimate <= rtol
            best = other if met else replace(other, status=Status.NOT_CONVERGED)
        if other.status is not Status.OK:
            break
    if best.found is None:
        return best
    return replace(best, remarks=(*best.remarks, _ESTIMATE_REMARK.format(best.found.error_estimate)))


def _find_outcome(
    problem: ContactProblem, depth: float | None, rtol: float, left: UnsolvedReason | HalfWidthStart | None
) -> SolveOutcome:
    """Outcome of one problem as one strip, or as several where a coarse grid shows them."""
    scene = SolverState.of(problem, depth=depth)
    try:
        outcome = _find_contact(scene, rtol, left)
    except RuleTooLongError:
        outcome = SolveOutcome(Status.TOO_THIN)
    nodes = scene.built.nodes.size if scene.built else 0
    return replace(outcome, matrices=scene.matrices, nodes=nodes, terms=scene.creep.weights.size)


def _find_contact(scene: SolverState, rtol: float, left: UnsolvedReason | HalfWidthStart | None) -> SolveOutcome:
    seen = CoarseContact.of(scene, scene.problem.pressure) if left is UnsolvedReason.ANY else None
    refusal = seen.refusal if seen is not None else None
    if refusal is not None:
        return refusal
    several = left is UnsolvedReason.STRIPS or (seen is not None and seen.several)
    outcome = solve_strips(scene, rtol, seen) if several else None
    if outcome is not None and outcome.status is not Status.NOT_CONVERGED:
        return outcome
    near = left if isinstance(left, HalfWidthStart) else None
    end, one = solve_one_strip(scene, rtol, near, doubtful=outcome is not None)
    if outcome is not None:
        return outcome if one is None else better_outcome(outcome, one)
    if one is not None and end in (RefinementEnd.MET, RefinementEnd.EXHAUSTED):
        return one
    return better_outcome(one, solve_strips(scene, rtol, seen))


def _make_solution(problem: ContactProblem, outcome: SolveOutcome, throw: bool) -> ContactSolution:
    stats = SolveStats(outcome.order, outcome.matrices, outcome.nodes, outcome.terms, outcome.grid, outcome.way)
    solution = ContactSolution(problem, outcome.status, stats, outcome.remarks, outcome.found)
    if throw and outcome.status is not Status.OK:
        raise NoSolutionError(solution.message)
    return solution
