"""Contact of one strip by its half width: load, order and error."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from conveyor.contact.fields.contact_fields import RESOLVED_FROM, SpectralFields, edge_layer_share
from conveyor.contact.galerkin.order_tail import DENSE_ORDER, FIRST_TAIL, longest_tail
from conveyor.contact.galerkin.orders import ORDERS, next_order
from conveyor.contact.galerkin.spectral import Contact, lower_order_contacts
from conveyor.contact.solution import ContactResult
from conveyor.contact.solvers.acceptance import (
    LEAST_ENERGY_POWER,
    OrderErrors,
    edge_layer_error,
    energy_error,
    error_from_energy,
    may_touch_elsewhere,
    order_errors,
    overlaps_roll,
)
from conveyor.contact.solvers.load_control import LoadSearch, contact_at_load, guess_half_width
from conveyor.contact.solvers.refinement import EnergyCheck, Refined, refine_contact
from conveyor.contact.solvers.solver_state import OrderResult, SolverState

LOAD_FLOOR = 2e-13  # rounding of the load at a condition number of 100
_CORE, _WIDEST_CORE = 64, 512
_LEAST_RESOLUTION, _FAR_OFF = (
    2.0,
    10.0,
)  # that of the longest tail, and energy's error over rtol, where climbing ends
_UNRESOLVED_POWER = 2.4  # power of n that they fall with before
LAYER_OVER_ENERGY = 10.0  # friction's error over that of the energy where a layer is not resolved: 2 to 7 seen
_MISMATCH_FACTOR = 2.0  # times the mismatch: 1.05 seen in friction
_FIRST_LOAD_TOLERANCE = 1e-3  # while the order is still rising


@dataclass(frozen=True)
class HalfWidthStart:
    """Start values ln α and d ln p̃_m/d ln α of a contact whose edge layers need orders beyond `DENSE_ORDER`."""

    log_alpha: float
    slope: float


def solve_one_strip(
    scene: SolverState, rtol: float, near: HalfWidthStart | None = None, *, doubtful: bool = False
) -> Refined:
    """Solve a contact as one strip.

    `near` is the start where order `DENSE_ORDER` did not suffice; with `doubtful` the gap outside is checked.
    """
    return refine_contact(OneStripOrders(scene, rtol, near, doubtful=doubtful), rtol)


class OneStripOrders:
    """Orders of a strip of a half width that carries the load: a core, from `DENSE_ORDER` on closed by a tail."""

    _state: OrderResult
    _pairs: list[OrderErrors]
    _by_order: OrderErrors
    _error: float
    _reach: float
    _following: tuple[int, int] | None
    _whole: Contact | None

    def __init__(self, scene: SolverState, rtol: float, near: HalfWidthStart | None, *, doubtful: bool) -> None:
        self.scene, self._rtol, self._doubtful = scene, rtol, doubtful
        start = guess_half_width(scene) if near is None else (near.log_alpha, near.slope)
        self._search = LoadSearch(scene.target, *start)
        self._tight, self._tolerance = max(1e-3 * rtol, LOAD_FLOOR), _FIRST_LOAD_TOLERANCE
        self._n, self._last = (ORDERS[0], ORDERS[0]) if near is None else (_CORE, FIRST_TAIL)
        self._longest = longest_tail(scene.creep.weights.size)
        self._before: tuple[int, float] | None = None  # order and energy error of the last check

    @property
    def order(self) -> int:
        """Last order of the tail."""
        return self._last

    @property
    def contact(self) -> Contact:
        """Strip with the coefficients of its tail."""
        if self._whole is None:
            self._whole = self._state.system.whole(self._state.contact)
        return self._whole

    def balance(self, *, closed: bool = False) -> float | None:
        """Error by the lower orders of core and tail."""
        if closed:
            if self._tolerance == self._tight or self._state.miss <= self._tight:
                return self._error
            self._tolerance = self._tight
        state = contact_at_load(self.scene, self._search, self._n, self._tolerance, self._last)
        if state is None:
            return None
        self._state, self._whole = state, None
        self._pairs = _lower_order_errors(self.scene, self._search, state)
        self._by_order = OrderErrors(*(np.max(errors, axis=0) for errors in zip(*self._pairs, strict=True)))
        self._error = float(self._by_order.friction[0])
        self._following = self._next(bounds=False)
        self._reach = layer_resolution(self.scene, state.contact, self._longest) if self._tailed else math.inf
        return self._error

    @property
    def _tailed(self) -> bool:
        return self._last > self._n

    def _next(self, *, bounds: bool) -> tuple[int, int] | None:
        return _next_orders((self._n, self._last), self._pairs, self._rtol, self._longest, bounds=bounds)

    def may_split(self) -> bool:
        """True up to the first tail."""
        return self._last <= FIRST_TAIL

    def is_last(self) -> bool:
        """True where there is no order after this one, or where none resolves the edge layer."""
        return self._following is None or self._reach < _LEAST_RESOLUTION

    def check_energy(self) -> EnergyCheck:
        """Energy, and errors by order, load and energy."""
        state, contact = self._state, self.contact
        settled = self._error <= self._rtol or self._following is None
        energy = energy_error(self.scene, state.contact, state.system.loss_beyond_core(contact))
        by_loss = float(error_from_energy(energy, self._by_order.most)[0])
        error = max(self._error, _load_mismatch_error(self._search, state.miss), by_loss)
        self._following = self._next(bounds=by_loss > self._rtol)
        if (
            settled
            and self._tailed
            and layer_beyond_reach(self.scene, contact, (self._last, self._longest), error / self._rtol)
        ):
            self._following = None
        here = self._last, float(energy[0])
        if not _energy_error_falls(self._before, here):
            error = max(error, float(edge_layer_error(energy, self.scene.creep, contact.alpha, self._last)[0]))
            if self._reach < _LEAST_RESOLUTION and self._before is not None and here[1] > _FAR_OFF * self._rtol:
                self._following = None
        self._before = here
        return EnergyCheck(here[1], error)

    def advance(self, checked: EnergyCheck | None) -> bool:  # noqa: ARG002 as every ladder has it
        """Raise the order of the core or of its tail, whichever leaves more."""
        if self._following is None:
            return False
        self._n, self._last = self._following
        self._search.reset_bracket()
        return True

    def result(self, checked: EnergyCheck) -> ContactResult | None:
        """Result, unless the layer touches the roll outside."""
        scene, contact = self.scene, self.contact
        alpha, eps, rho = float(contact.alpha[0]), float(contact.eps[0]), scene.problem.rho
        elsewhere = self._doubtful or bool(may_touch_elsewhere(contact, rho)[0])
        depth = None
        if elsewhere or self._tailed:
            depth = scene.depth_of(self._state.system, self._state.contact)
        if elsewhere and overlaps_roll(scene, contact, depth):
            return None
        return ContactResult(
            friction=float(contact.friction[0]),
            mean_pressure=float(contact.pressure[0]),
            half_width=alpha,
            centre=eps,
            strips=np.array([[eps - alpha, eps + alpha]]),
            energy_error=checked.energy,
            error_estimate=checked.error,
            edge_error=float(self._by_order.edges[0]),
            fields=SpectralFields(scene.problem.layer, scene.creep, contact, rho, depth),
        )


def _lower_order_errors(scene: SolverState, search: LoadSearch, state: OrderResult) -> list[OrderErrors]:
    """Errors by each pair of lower orders, of the core and of its tail."""
    exponent = search.exponent if scene.depth is None else None
    return [
        order_errors(state.contact, lower_order_contacts(lower, state.contact, scene.problem.rho), exponent)
        for lower in state.system.lower
    ]


def _load_mismatch_error(search: LoadSearch, miss: float) -> float:
    """Error of friction due to a mismatch of load or depth, at least twice that mismatch."""
    return _MISMATCH_FACTOR * miss * max(1.0, 0.0 if search.exponent is None else float(abs(search.exponent[0])))


def _next_orders(
    orders: tuple[int, int], pairs: list[OrderErrors], rtol: float, longest: int, *, bounds: bool
) -> tuple[int, int] | None:
    """Next core and last order: the one with the larger error is raised; None beyond the longest of both.

    With `bounds` the upper bounds of the errors decide. Without a tail the next of the ladder of orders follows.
    """
    n, last = orders
    if last == n:
        following = next_order(n, float(pairs[0].friction[0]) / rtol)
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
