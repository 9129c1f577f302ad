"""Contact of one strip by its half width: load, order and error."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from conveyor.contact.fields.contact_fields import RESOLVED_FROM, SpectralFields, edge_layer_share
from conveyor.contact.galerkin.order_tail import DENSE_ORDER, FIRST_TAIL, longest_tail
from conveyor.contact.galerkin.orders import ORDERS, next_order
from conveyor.contact.galerkin.spectral import Contact, lower_order_contacts
from conveyor.contact.problem import Status
from conveyor.contact.solution import ContactResult, SolveOutcome
from conveyor.contact.solvers.acceptance import (
    LEAST_ENERGY_POWER,
    OrderErrors,
    PressureSign,
    edge_layer_error,
    energy_error,
    error_from_energy,
    may_touch_elsewhere,
    order_errors,
    overlaps_roll,
    worst_sign,
    worst_sign_and_tension,
)
from conveyor.contact.solvers.load_control import LoadSearch, contact_at_load, guess_half_width
from conveyor.contact.solvers.solver_state import OrderResult, SolverState

LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
SIGN_ORDER = 256  # splits show below it; a dip that lasts is an edge layer that friction does not feel
SETTLED_CHANGE = 1e-3  # change of friction below which tension is no longer the order's ripple
ROUNDING = 1e-14
_CORE, _WIDEST_CORE = 64, 512
_LEAST_RESOLUTION, _FAR_OFF = (
    2.0,
    10.0,
)  # that of the longest tail, and energy's error over rtol, where climbing ends
_UNRESOLVED_POWER = 2.4  # power of n that they fall with before
LAYER_OVER_ENERGY = 10.0  # friction's error over that of the energy where a layer is not resolved: 2 to 7 seen
_MISMATCH_FACTOR = 2.0  # times the mismatch: 1.05 seen in friction
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising
EDGE_LAYER_REMARK = "a layer at the contact's edge is thinner than the order resolves: pressure ripples there"


@dataclass(frozen=True)
class HalfWidthStart:
    """Start values ln α and d ln p̃_m/d ln α of a contact whose edge layers need orders beyond `DENSE_ORDER`."""

    log_alpha: float
    slope: float


def solve_one_strip(
    scene: SolverState, rtol: float, near: HalfWidthStart | None = None, *, doubtful: bool = False
) -> SolveOutcome | None:
    """Solve a contact as one strip; None where it splits, overlaps the roll outside or is not single-valued in α.

    `near` is the start where order `DENSE_ORDER` did not suffice; with `doubtful` the gap outside is checked.
    """
    half_width = _converge_order(scene, rtol, near)
    if half_width is None:
        return None
    state, contact, error, energy, edges = half_width
    rho = scene.problem.rho
    pressing, tension = worst_sign_and_tension(contact, rtol)
    if pressing is PressureSign.PULLING:
        return None
    alpha, eps = float(contact.alpha[0]), float(contact.eps[0])
    depth = None
    elsewhere = doubtful or bool(may_touch_elsewhere(contact, rho)[0])
    if elsewhere or state.system.tail is not None:
        depth = scene.depth_of(state.system, state.contact)
    if elsewhere and depth is not None and overlaps_roll(scene, contact, depth):
        return None
    estimate = max(error, ROUNDING, tension)
    return SolveOutcome(
        status=Status.OK if estimate <= rtol else Status.NOT_CONVERGED,
        found=ContactResult(
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
        order=int(contact.c.shape[1]),
        remarks=pressure_remarks(pressing),
    )


def pressure_remarks(pressing: PressureSign) -> tuple[str, ...]:
    """Remarks of the solution on its pressure."""
    return (EDGE_LAYER_REMARK,) if pressing is PressureSign.UNDECIDED else ()


def _converge_order(
    scene: SolverState, rtol: float, near: HalfWidthStart | None
) -> tuple[OrderResult, Contact, float, float, float] | None:
    """Raise the order until the error meets rtol, then close the load and check the energy."""
    search = LoadSearch(scene.target, *(guess_half_width(scene) if near is None else (near.log_alpha, near.slope)))
    tight = max(1e-3 * rtol, LOAD_FLOOR)
    tolerance = _FIRST_LOAD_TOLERANCE
    n, last = (ORDERS[0], ORDERS[0]) if near is None else (_CORE, FIRST_TAIL)
    longest = longest_tail(scene.creep.weights.size)
    lost: tuple[int, float] | None = None
    while True:
        state = contact_at_load(scene, search, n, tolerance, last)
        if state is None:
            return None
        pairs = _lower_order_errors(scene, search, state)
        by_order = OrderErrors(*(np.max(errors, axis=0) for errors in zip(*pairs, strict=True)))
        error = float(by_order.friction[0])
        if error <= SETTLED_CHANGE and last <= FIRST_TAIL and _splits_in_tension(state, rtol):
            return None
        following = _next_orders((n, last), pairs, rtol, longest)
        reach = layer_resolution(scene, state.contact, longest) if last > n else math.inf
        if error <= rtol or following is None or reach < _LEAST_RESOLUTION:
            settled = error <= rtol or following is None
            if state.miss > tight and tolerance > tight:
                tolerance = tight
                continue
            contact = state.system.whole(state.contact)
            energy = energy_error(scene, state.contact, state.system.loss_beyond_core(contact))
            by_loss = float(error_from_energy(energy, by_order.most)[0])
            error = max(error, _load_mismatch_error(search, state.miss), by_loss)
            following = _next_orders((n, last), pairs, rtol, longest, bounds=by_loss > rtol)
            decided = last >= SIGN_ORDER or worst_sign(contact, rtol) is not PressureSign.UNDECIDED
            if settled and last > n and layer_beyond_reach(scene, contact, (last, longest), error / rtol):
                following = None
            here = last, float(energy[0])
            if not _energy_error_falls(lost, here):
                error = max(error, float(edge_layer_error(energy, scene.creep, contact.alpha, last)[0]))
                if reach < _LEAST_RESOLUTION and lost is not None and here[1] > _FAR_OFF * rtol:
                    following = None
            lost = here
            if (error <= rtol and decided) or following is None:
                return state, contact, error, here[1], float(by_order.edges[0])
        n, last = following
        search.reset_bracket()


def _lower_order_errors(scene: SolverState, search: LoadSearch, state: OrderResult) -> list[OrderErrors]:
    """Errors by each pair of lower orders, of the core and of its tail."""
    exponent = search.exponent if scene.depth is None else None
    return [
        order_errors(state.contact, lower_order_contacts(lower, state.contact, scene.problem.rho), exponent)
        for lower in state.system.lower
    ]


def _splits_in_tension(state: OrderResult, rtol: float) -> bool:
    """True where the contact, with the orders of its tail, is in tension somewhere: it splits."""
    return worst_sign(state.system.whole(state.contact), rtol) is PressureSign.PULLING


def _load_mismatch_error(search: LoadSearch, miss: float) -> float:
    """Error of friction due to a mismatch of load or depth, at least twice that mismatch."""
    return _MISMATCH_FACTOR * miss * max(1.0, 0.0 if search.exponent is None else float(abs(search.exponent[0])))


def _next_orders(
    orders: tuple[int, int], pairs: list[OrderErrors], rtol: float, longest: int, *, bounds: bool = False
) -> tuple[int, int] | None:
    """Next core and last order: the one with the larger error is raised; None beyond the longest of both.

    With `bounds` the upper bounds of the errors decide. Without a tail the next of the ladder of orders follows.
    """
    n, last = orders
    if last == n:
        following = next_order(n, float(pairs[0].friction[0]), rtol)
        if not longest:
            return (following, following) if following > n else None
        return (following, following) if following <= DENSE_ORDER else (_CORE, FIRST_TAIL)
    core, tail = (float((pair.most if bounds else pair.friction)[0]) for pair in pairs)
    if core > max(tail, rtol):
        return (2 * n, max(last, 8 * n)) if n < _WIDEST_CORE else None
    return (n, 4 * last) if 4 * last <= longest else None


def _energy_error_falls(before: tuple[int, float] | None, now: tuple[int, float]) -> bool:
    """True where the energy error falls from one last order to the next as fast as for resolved layers."""
    return before is not None and now[1] * now[0] ** LEAST_ENERGY_POWER <= before[1] * before[0] ** LEAST_ENERGY_POWER


def layer_beyond_reach(
    scene: SolverState,
    contact: Contact,
    orders: tuple[int, int],
    excess: float,
    falls: float = _UNRESOLVED_POWER,
) -> bool:
    """True where the longest order neither resolves the edge layer nor brings the error below rtol.

    `orders` are the present and the longest one, `excess` is the error over rtol, `falls` the power of the order that
    the error falls with.
    """
    now, longest = orders
    enough = excess * (now / longest) ** max(falls, _UNRESOLVED_POWER) <= 1.0
    return not enough and layer_resolution(scene, contact, longest) < RESOLVED_FROM


def layer_resolution(scene: SolverState, contact: Contact, last: int) -> float:
    """Square of an order times the edge layer's share of the narrowest half width; infinite for an elastic contact."""
    return edge_layer_share(scene.creep, float(contact.alpha.min())) * last**2
