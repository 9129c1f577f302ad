"""One strip by its half width: load, order and error."""

from __future__ import annotations

import numpy as np

from conveyor.contact.checks import (
    Sign,
    by_energy,
    energy_error,
    may_touch_elsewhere,
    order_errors,
    overlaps,
    sign,
)
from conveyor.contact.fields import SpectralFields
from conveyor.contact.load import LoadSearch, carry, guess
from conveyor.contact.orders import ORDERS, next_order
from conveyor.contact.problem import Status
from conveyor.contact.scene import Scene, State
from conveyor.contact.solution import Found, Outcome
from conveyor.contact.spectral import penetration

LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
SIGN_ORDER = 256  # splits show below it; a dip that lasts is an edge layer that friction does not feel
ROUNDING = 1e-14
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising
EDGE_LAYER = "a layer at the contact's edge is thinner than the order resolves: pressure ripples there"


def by_half_width(scene: Scene, rtol: float) -> Outcome | None:
    """The contact as one strip; None where it splits, overlaps the roll outside or is not single-valued in α."""
    found = _converged(scene, rtol)
    if found is None:
        return None
    state, error, energy, edges = found
    contact, rho = state.contact, scene.problem.rho
    pressing = sign(contact, rtol)
    if pressing is Sign.PULLING:
        return None
    alpha, eps = float(contact.alpha[0]), float(contact.eps[0])
    depth = None
    if may_touch_elsewhere(contact, rho)[0]:
        depth = float(penetration(scene.rule(alpha), scene.creep, contact, rho)[0])
        if overlaps(scene, contact, depth):
            return None
    estimate = max(error, ROUNDING)
    return Outcome(
        status=Status.OK if estimate <= rtol else Status.NOT_CONVERGED,
        found=Found(
            friction=float(contact.friction[0]),
            mean_pressure=float(contact.pressure[0]),
            half_width=alpha,
            centre=eps,
            strips=np.array([[eps - alpha, eps + alpha]]),
            energy_error=energy,
            error_estimate=estimate,
            edge_error=edges,
            fields=SpectralFields(scene.problem.layer, scene.creep, contact, rho, depth),
        ),
        order=state.order,
        remarks=remarks(pressing),
    )


def remarks(pressing: Sign) -> tuple[str, ...]:
    """What a reader of the solution must know of its pressure."""
    return (EDGE_LAYER,) if pressing is Sign.UNDECIDED else ()


def _converged(scene: Scene, rtol: float) -> tuple[State, float, float, float] | None:
    """Raise the order until the estimate meets rtol, then close the load and check the energy."""
    search = LoadSearch(scene.target, *guess(scene))
    tight = max(1e-3 * rtol, LOAD_FLOOR)
    tolerance = _FIRST_LOAD_TOLERANCE
    n = ORDERS[0]
    while True:
        state = carry(scene, search, n, tolerance)
        if state is None:
            return None
        exponent = search.exponent if scene.depth is None else None
        by_order = order_errors(state.contact, state.matrix, scene.problem.rho, exponent)
        error = float(by_order.friction[0])
        if error <= rtol or n == ORDERS[-1]:
            if state.miss > tight and tolerance > tight:
                tolerance = tight
                continue
            energy = energy_error(scene, state.contact)
            error = max(error, state.miss, float(by_energy(energy, by_order.most)[0]))
            decided = n >= SIGN_ORDER or sign(state.contact, rtol) is not Sign.UNDECIDED
            settled = error <= rtol and decided
            if settled or n == ORDERS[-1]:
                return state, error, float(energy[0]), float(by_order.edges[0])
        n = next_order(n, error, rtol)
        search.renew()
