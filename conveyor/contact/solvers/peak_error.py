"""Error of the largest pressure, from a contact of higher order at the same half widths.

Computed on demand: it takes a matrix, and where rubber flows at lengths that the matrix does not resolve, a tail of
orders down to the shortest of them.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from conveyor.contact.galerkin.order_tail import DENSE_ORDER, longest_tail
from conveyor.contact.galerkin.pressure import EDGE_WAVE_FACTOR, largest_pressure
from conveyor.contact.galerkin.spectral import Contact, assemble_matrix, solve_equilibrium
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.problem import ContactProblem
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.contact.solvers.strips import strips_at_places

_CORE_STEP = 64  # orders that a core with a tail is a multiple of
_LONG_CORE = 128
_LOW_ORDER, _WIDTH_STEP = 16, 1e-3  # order and ln α of the contacts that give the change with the load
_PER_DECADE = 24  # wave numbers at which the loss tangent is evaluated
_MARGIN: Final = 3.0
"""Errors over the difference from the finer contact: about one in the median of 1,100 covers and sharp contacts,
1.5 at most (docs/accuracy.md)."""


class FieldErrors(NamedTuple):
    """Relative error of the largest pressure and error of the edges, X."""

    peak: float
    edges: float


def field_errors(problem: ContactProblem, contact: Contact) -> FieldErrors:
    """Errors of a contact's largest pressure and edges under the problem's load, from a finer contact.

    A difference of load shifts the half width, and with it peak and edges. On a thin plate the load hardly rises with
    the half width: both shift by a multiple of it.
    """
    scene = SolverState.of(problem)
    shape, load, shift = _finer_differences(scene, contact)
    if contact.alpha.size > 1:
        return FieldErrors(shape + load, shift)
    peak_moves, edges_move = _load_sensitivity(scene, contact)
    return FieldErrors(shape + max(1.0, abs(peak_moves - 0.5)) * load, shift + edges_move * load)


def peak_error(problem: ContactProblem, contact: Contact) -> float:
    """Relative error of the largest pressure of a load curve's contact under the problem's load."""
    shape, load, _ = _finer_differences(SolverState.of(problem), contact)
    return shape + load


def _finer_differences(scene: SolverState, contact: Contact) -> tuple[float, float, float]:
    """Differences from the finer contact at the same half widths: three times that of the peak, of load, of centres.

    The peak is compared at the same load, by its square root (seen: powers from -1/2 to 3/2). Errors are 100 % where
    the finer order has no contact on the roll.
    """
    n = contact.c.shape[1]
    if contact.alpha.size > 1:
        finer, lacks = strips_at_places(scene, max(_CORE_STEP, 2 * n), contact), 1.0
    else:
        finer, lacks = _finer_contact(scene, contact)
    load = float(finer.pressure.sum())
    if not (finer.inside.all() and load > 0.0):
        return 1.0, 0.0, float(contact.alpha.max())
    carried = math.sqrt(float(contact.pressure.sum()) / load)
    change = float(largest_pressure(finer.c).max() / largest_pressure(contact.c).max()) * carried - 1.0
    shift = float(np.abs(finer.eps - contact.eps).max())
    return _MARGIN * abs(change) * lacks, abs(math.log(load / scene.problem.pressure)), shift


def _load_sensitivity(scene: SolverState, contact: Contact) -> tuple[float, float]:
    """Change of ln p̂ and of the edges with ln p̃_m, from contacts of low order at two half widths."""
    alpha = contact.alpha[0] * np.exp([-_WIDTH_STEP, _WIDTH_STEP])
    matrix = assemble_matrix(scene.rule(float(alpha[1])), scene.creep, alpha, _LOW_ORDER)
    found = solve_equilibrium(matrix, alpha, scene.problem.rho, np.repeat(contact.eps, 2))
    if not (found.inside.all() and found.pressure[1] > found.pressure[0] > 0.0):
        return 1.0, float(contact.alpha[0])
    rise = math.log(found.pressure[1] / found.pressure[0])
    highest = largest_pressure(found.c)
    edges = np.diff([found.eps - found.alpha, found.eps + found.alpha])
    return math.log(highest[1] / highest[0]) / rise, float(np.abs(edges).max()) / rise


def flow_order(creep: CreepSpectrum, alpha: float, n: int) -> float:
    """Order that resolves the pressure to where it may be largest at the edges of a half width α; at least n.

    Beyond what order n resolves the pressure falls toward an edge like x^1/2 where rubber is elastic and may grow like
    x^-1/2 where it flows: where its loss tangent exceeds one, up to m = Σ d/ζ over j∞ at most. Flow that does not make
    up for the fall before it is left out.
    """
    lasting = creep.times > 0.0
    first = EDGE_WAVE_FACTOR * n**2 / alpha
    glass = creep.instantaneous + float(creep.weights[~lasting].sum())
    last = float(np.sum(creep.weights[lasting] / creep.times[lasting])) / glass
    if last <= first:
        return n
    m = np.geomspace(first, last, 2 + math.ceil(_PER_DECADE * math.log10(last / first)))
    j = creep.compliance(m)
    rise = np.cumsum(np.where(j.imag > j.real, 1, -1))
    highest = int(rise.argmax())
    return math.sqrt(alpha * float(m[highest]) / EDGE_WAVE_FACTOR) if rise[highest] > 0 else n


def _finer_contact(scene: SolverState, contact: Contact) -> tuple[Contact, float]:
    """One strip at twice the order or more, and the orders it needs over those of the longest tail, at least 1."""
    n, alpha = contact.c.shape[1], float(contact.alpha[0])
    dense = n <= DENSE_ORDER or not scene.creep.weights.size
    core = last = _CORE_STEP * math.ceil(2 * n / _CORE_STEP) if dense else _LONG_CORE
    asked = max(flow_order(scene.creep, alpha, core), 2 * n)
    if asked > core:
        last, longest = 4 * core, longest_tail(scene.creep.weights.size)
        while last < min(asked, longest):
            last *= 2
    system = scene.system(alpha, core, last)
    found = solve_equilibrium(system.matrix, contact.alpha, scene.problem.rho, contact.eps)
    if not found.inside[0]:
        return found, 1.0
    return system.whole(found), max(1.0, asked / last)
