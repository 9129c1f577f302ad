"""Contact of one strip by its half width: load, order and error."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from conveyor.contact.checks import (
    STEADY,
    OrderErrors,
    Sign,
    by_energy,
    energy_error,
    layer_error,
    may_touch_elsewhere,
    order_errors,
    overlaps,
    sign,
    sign_and_tension,
)
from conveyor.contact.fields import RESOLVED, SpectralFields, edge_layer
from conveyor.contact.load import LoadSearch, carry, guess
from conveyor.contact.orders import ORDERS, next_order
from conveyor.contact.problem import Status
from conveyor.contact.scene import Scene, State
from conveyor.contact.solution import Found, Outcome
from conveyor.contact.spectral import Contact, of_orders
from conveyor.contact.tail import DENSE, FIRST_TAIL, longest_tail

LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
SIGN_ORDER = 256  # splits show below it; a dip that lasts is an edge layer that friction does not feel
SETTLED = 1e-3  # change of friction below which tension is no longer the order's ripple
ROUNDING = 1e-14
_CORE, _WIDEST_CORE = 64, 512
_BEYOND_REACH, _FAR = 2.0, 10.0  # that of the longest tail, and energy's error over rtol, where climbing ends
_UNRESOLVED = 2.4  # power of n that they fall with before
LAYER_OVER_ENERGY = (
    10.0  # friction's error over that of the energy where a layer is not resolved: 2 to 7 seen
)
_MISSED = 2.0  # times the mismatch: 1.05 seen in friction
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising
EDGE_LAYER = "a layer at the contact's edge is thinner than the order resolves: pressure ripples there"


@dataclass(frozen=True)
class Near:
    """Start values ln α and d ln p̃_m/d ln α of a contact whose edge layers need orders beyond `DENSE`."""

    log_alpha: float
    slope: float


def by_half_width(
    scene: Scene, rtol: float, near: Near | None = None, *, doubtful: bool = False
) -> Outcome | None:
    """Solve a contact as one strip; None where it splits, overlaps the roll outside or is not single-valued in α.

    `near` is the start where order `DENSE` did not suffice; with `doubtful` the gap outside is checked.
    """
    half_width = _converged(scene, rtol, near)
    if half_width is None:
        return None
    state, contact, error, energy, edges = half_width
    rho = scene.problem.rho
    pressing, tension = sign_and_tension(contact, rtol)
    if pressing is Sign.PULLING:
        return None
    alpha, eps = float(contact.alpha[0]), float(contact.eps[0])
    depth = None
    elsewhere = doubtful or bool(may_touch_elsewhere(contact, rho)[0])
    if elsewhere or state.system.tail is not None:
        depth = scene.depth_of(state.system, state.contact)
    if elsewhere and depth is not None and overlaps(scene, contact, depth):
        return None
    estimate = max(error, ROUNDING, tension)
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
        order=int(contact.c.shape[1]),
        remarks=remarks(pressing),
    )


def remarks(pressing: Sign) -> tuple[str, ...]:
    """Remarks of the solution on its pressure."""
    return (EDGE_LAYER,) if pressing is Sign.UNDECIDED else ()


def _converged(
    scene: Scene, rtol: float, near: Near | None
) -> tuple[State, Contact, float, float, float] | None:
    """Raise the order until the error meets rtol, then close the load and check the energy."""
    search = LoadSearch(scene.target, *(guess(scene) if near is None else (near.log_alpha, near.slope)))
    tight = max(1e-3 * rtol, LOAD_FLOOR)
    tolerance = _FIRST_LOAD_TOLERANCE
    n, last = (ORDERS[0], ORDERS[0]) if near is None else (_CORE, FIRST_TAIL)
    longest = longest_tail(scene.creep.weights.size)
    lost: tuple[int, float] | None = None
    while True:
        state = carry(scene, search, n, tolerance, last)
        if state is None:
            return None
        pairs = _by_order(scene, search, state)
        by_order = OrderErrors(*(np.max(errors, axis=0) for errors in zip(*pairs, strict=True)))
        error = float(by_order.friction[0])
        if error <= SETTLED and last <= FIRST_TAIL and _pulls(state, rtol):
            return None
        following = _next((n, last), pairs, rtol, longest)
        reach = resolution(scene, state.contact, longest) if last > n else math.inf
        if error <= rtol or following is None or reach < _BEYOND_REACH:
            settled = error <= rtol or following is None
            if state.miss > tight and tolerance > tight:
                tolerance = tight
                continue
            contact = state.system.whole(state.contact)
            energy = energy_error(scene, state.contact, state.system.lost_beyond(contact))
            by_loss = float(by_energy(energy, by_order.most)[0])
            error = max(error, _by_load(search, state.miss), by_loss)
            following = _next((n, last), pairs, rtol, longest, bounds=by_loss > rtol)
            decided = last >= SIGN_ORDER or sign(contact, rtol) is not Sign.UNDECIDED
            if settled and last > n and beyond_reach(scene, contact, (last, longest), error / rtol):
                following = None
            here = last, float(energy[0])
            if not _falls(lost, here):
                error = max(error, float(layer_error(energy, scene.creep, contact.alpha, last)[0]))
                if reach < _BEYOND_REACH and lost is not None and here[1] > _FAR * rtol:
                    following = None
            lost = here
            if (error <= rtol and decided) or following is None:
                return state, contact, error, here[1], float(by_order.edges[0])
        n, last = following
        search.renew()


def _by_order(scene: Scene, search: LoadSearch, state: State) -> list[OrderErrors]:
    """Errors by each pair of lower orders, of the core and of its tail."""
    exponent = search.exponent if scene.depth is None else None
    return [
        order_errors(state.contact, of_orders(lower, state.contact, scene.problem.rho), exponent)
        for lower in state.system.lower
    ]


def _pulls(state: State, rtol: float) -> bool:
    """True where the contact, with the orders of its tail, is in tension somewhere: it splits."""
    return sign(state.system.whole(state.contact), rtol) is Sign.PULLING


def _by_load(search: LoadSearch, miss: float) -> float:
    """Error of friction due to a mismatch of load or depth, at least twice that mismatch."""
    return _MISSED * miss * max(1.0, 0.0 if search.exponent is None else float(abs(search.exponent[0])))


def _next(
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
        return (following, following) if following <= DENSE else (_CORE, FIRST_TAIL)
    core, tail = (float((pair.most if bounds else pair.friction)[0]) for pair in pairs)
    if core > max(tail, rtol):
        return (2 * n, max(last, 8 * n)) if n < _WIDEST_CORE else None
    return (n, 4 * last) if 4 * last <= longest else None


def _falls(before: tuple[int, float] | None, now: tuple[int, float]) -> bool:
    """True where the energy error falls from one last order to the next as fast as for resolved layers."""
    return before is not None and now[1] * now[0] ** STEADY <= before[1] * before[0] ** STEADY


def beyond_reach(
    scene: Scene, contact: Contact, orders: tuple[int, int], excess: float, falls: float = _UNRESOLVED
) -> bool:
    """True where the longest order neither resolves the edge layer nor brings the error below rtol.

    `orders` are the present and the longest one, `excess` is the error over rtol, `falls` the power of the order that
    the error falls with.
    """
    now, longest = orders
    enough = excess * (now / longest) ** max(falls, _UNRESOLVED) <= 1.0
    return not enough and resolution(scene, contact, longest) < RESOLVED


def resolution(scene: Scene, contact: Contact, last: int) -> float:
    """Square of an order times the edge layer's share of the narrowest half width; infinite for an elastic contact."""
    return edge_layer(scene.creep, float(contact.alpha.min())) * last**2
