"""Contacts of any number of strips: located on a grid, refined spectrally.

The grid is refined until two of them show the same strips, each resolved; from these `strips.settle` converges to the
spectral contact, which must press inside every strip and touch nowhere else. Strips too close for the spectral window
keep the grid's solution and error.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.contact_fields import RESOLVED_FROM, GridFields, SpectralFields
from conveyor.contact.galerkin.orders import ORDERS, next_order
from conveyor.contact.galerkin.spectral import Contact
from conveyor.contact.problem import LARGEST_RTOL, Status
from conveyor.contact.solution import ContactResult, SolveOutcome
from conveyor.contact.solvers.acceptance import (
    ENERGY_MARGIN,
    ENERGY_OVER_ERROR,
    ORDER_BOUND,
    overlaps_roll,
)
from conveyor.contact.solvers.grid_solver import ContactGrid, GridContact, RaisedContact, solve_grid
from conveyor.contact.solvers.one_strip import (
    LAYER_OVER_ENERGY,
    LOAD_FLOOR,
    layer_beyond_reach,
    layer_resolution,
)
from conveyor.contact.solvers.refinement import (
    ROUNDING,
    EnergyCheck,
    Refined,
    RefinementEnd,
    better_outcome,
    refine_contact,
)
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.contact.solvers.strips import Strips, balance_strips, friction_by_loss, strip_loads, too_close
from conveyor.errors import NoSolutionError

Array = NDArray[np.float64]

_COARSEST = 64  # nodes on the roll of the first grid
_FIRST_POLISH, _WRAP_LEVEL, _FINEST = 2, 6, 10  # doublings of it
_MOST_POINTS = 1 << 20
_LAST_TRIAL_ORDER, _ORDER_FAILURES = 64, 2  # low orders may have no contact near the grid's
_FAR_OFF = 100.0  # of the tolerance: then a rung is left out; a change grows with the step that it is taken over
_FINAL_ENDS = (RefinementEnd.MET, RefinementEnd.EXHAUSTED)
_MOST_STRIPS = 8  # three at most were seen to converge
_POLISHES = 3  # grids whose strips are refined spectrally
_FIRST_WIDTH, _LARGEST_FIT, _FIT_STEPS = (
    1e-3,
    10.0,
    12,
)  # first guess over the nodes' distance, largest step, steps
_STRIP_NODES, _GAP_NODES = 3.0, 2.0  # nodes that resolve a strip, and a gap between strips
_WRAP_REMARK = "the contact comes within a hundredth of the half circle's end at a mean pressure of {} {:.3g}"
_OVERLOAD_FACTOR = 1.5  # times the limit of two coarse grids: no finer one will carry the load
_NEWTON_FACTOR = 3.0  # times what Newton leaves: 1.2 seen in friction, 2.2 in the edges, 1.0 in the largest pressure
_CANCELLATION_REMARK = "the strips' forces cancel: friction is that of the loss compliance"
_GRID_REMARK = "the strips are known on a grid of {} nodes only"


class _StartStrips(NamedTuple):
    """Centres and half widths X of start strips, and the number of orders that may fail from them."""

    centre: Array
    alpha: Array
    failures: int


@dataclass(frozen=True, eq=False)
class CoarseContact:
    """Contact on a coarse grid under a mean pressure p̃_m."""

    coarse: ContactGrid
    load: float

    @classmethod
    def of(cls, scene: SolverState, load: float) -> CoarseContact:
        """Coarse contact of a problem under this load, which replaces a prescribed depth."""
        return cls(ContactGrid(scene.problem, _coarsest_points(scene.problem.rho)), load)

    @cached_property
    def raised(self) -> RaisedContact | None:
        """Contact on 64 nodes on the roll; None where it does not converge."""
        try:
            return self.coarse.raised(self.load)
        except NoSolutionError:
            return None

    @property
    def several(self) -> bool:
        """True where the contact has more than one strip."""
        return self.raised is not None and len(self.raised.contact.strips) > 1

    @property
    def refusal(self) -> SolveOutcome | None:
        """Refusal of a load of which this grid and a finer one carry no more than two thirds; else None."""
        if self.raised is None or _OVERLOAD_FACTOR * self.raised.limit >= self.load:
            return None
        beyond = self.limit is not None and _OVERLOAD_FACTOR * self.limit < self.load
        return _wrap_outcome(self.raised.contact, self.limit) if beyond else None

    @cached_property
    def limit(self) -> float | None:
        """Mean pressure from which the contact touches the last of 256 nodes on the roll, at most the load.

        None where a grid does not converge.
        """
        coarse, raised, load = self.coarse, self.raised, self.load
        if raised is None:
            return None
        try:
            below = coarse.halfway(raised) if raised.limit < load else coarse.contact(0.5 * load)
            below = ContactGrid(coarse.problem, 2 * coarse.points).contact(below.mean_pressure, below)
            finer = ContactGrid(coarse.problem, 4 * coarse.points)
            return min(load, finer.raised(load, below).limit)
        except NoSolutionError:
            return None


def solve_strips(scene: SolverState, rtol: float, seen: CoarseContact | None) -> SolveOutcome:
    """Solve for a contact of any number of strips; `seen` is the coarse contact, if known."""
    grids: list[GridContact] = []
    failures: list[str] = []
    best: SolveOutcome | None = None
    polishes = 0
    for grids in _finer_grids(scene, seen, rtol, failures):
        steady = len(grids) > _FIRST_POLISH and len(grids[-1].strips) == len(grids[-2].strips)
        start = _initial_strips(scene, grids[-1]) if steady and polishes < _POLISHES else None
        if start is None:
            continue
        polishes += 1
        end, found = _polish_strips(scene, grids[-1], start, rtol)
        best = better_outcome(best, found) if found is not None else best
        if best is not None and end in _FINAL_ENDS:
            return best
        if polishes == _POLISHES and best is not None and best.found and best.found.error_estimate <= LARGEST_RTOL:
            break
    if not grids:
        return SolveOutcome(Status.NOT_CONVERGED, way="grid", remarks=tuple(failures))
    if grids[-1].at_roll_end:
        seen = seen or CoarseContact.of(scene, grids[-1].mean_pressure)
        return _wrap_outcome(grids[-1], seen.limit)
    return better_outcome(best, _grid_outcome(scene, grids, rtol))


def _finer_grids(
    scene: SolverState, seen: CoarseContact | None, rtol: float, failures: list[str]
) -> Iterator[list[GridContact]]:
    """Contacts on grids so far, one more each time; why one has none is appended to `failures`.

    Ends where even the finest grid would miss `rtol`: strips that no grid so far resolves are not seen by finer ones.
    """
    grids: list[GridContact] = []
    for doubling in range(_FINEST + 1):
        points = _coarsest_points(scene.problem.rho) << doubling
        if points > _MOST_POINTS:
            return
        try:
            grids.append(_grid_contact(scene, points, grids[-1] if grids else None, seen))
        except NoSolutionError as unsettled:
            failures.append(str(unsettled))
            return
        yield grids
        if doubling >= _WRAP_LEVEL and (grids[-1].at_roll_end or _left_at_finest(scene, grids, doubling) > rtol):
            return


def _left_at_finest(scene: SolverState, grids: list[GridContact], doubling: int) -> float:
    """Relative error of friction that the finest grid would leave: errors fall like step^(3/2)."""
    coarser, grid = grids[-2:]
    change = abs(grid.friction - coarser.friction) / _error_scale(scene, grid.friction)
    return float(change * 2.0 ** (-1.5 * (_FINEST - doubling)))


def _polish_strips(scene: SolverState, grid: GridContact, start: _StartStrips, rtol: float) -> Refined:
    """Refine the grid's strips spectrally."""
    orders = StripsOrders(scene, start, rtol)
    end, found = refine_contact(orders, rtol)
    if found is None:
        return Refined(end, None)
    remarks = (*found.remarks, *((_CANCELLATION_REMARK,) if orders.cancelled else ()))
    return Refined(end, replace(found, grid=grid.points, way="strips", remarks=remarks))


def _grid_contact(
    scene: SolverState, points: int, start: GridContact | None, seen: CoarseContact | None
) -> GridContact:
    """Contact on a grid, started from a coarser one, or that of `seen`."""
    if start is not None or seen is None:
        return solve_grid(scene.problem, points, start, depth=scene.depth)
    return seen.raised.contact if seen.raised else seen.coarse.block_exchange(scene.problem.pressure)


def _initial_strips(scene: SolverState, grid: GridContact) -> _StartStrips | None:
    """Start strips from the grid; a strip that it does not resolve gets the half width that carries its force.

    None where strips touch one another, come too near to the roll's end, or are too many.
    """
    step, rho = 2.0 * math.pi / grid.points, scene.problem.rho
    if (
        grid.at_roll_end
        or len(grid.strips) > _MOST_STRIPS
        or (grid.strips[1:, 0] - grid.strips[:-1, 1] <= _GAP_NODES * step).any()
    ):
        return None
    centre, alpha = grid.strips.mean(axis=1), 0.5 * (grid.strips[:, 1] - grid.strips[:, 0])
    unseen = np.flatnonzero(alpha <= 0.5 * _STRIP_NODES * step)
    if not unseen.size:
        return _StartStrips(centre, alpha, _ORDER_FAILURES)
    inside = [np.abs(grid.x - x) <= a for x, a in zip(centre, alpha, strict=True)]
    force = np.array([grid.pressure[nodes].sum() for nodes in inside])
    centre = np.array([grid.pressure[nodes] @ grid.x[nodes] for nodes in inside]) / force
    alpha[unseen] = _FIRST_WIDTH * step
    for fits in range(_FIT_STEPS + 1):
        if (alpha + np.abs(centre) >= rho).any() or too_close(centre, alpha):
            return None
        if fits < _FIT_STEPS:
            carried = strip_loads(scene, centre[None], alpha[None])[0] * grid.points / force
            alpha[unseen] /= np.sqrt(np.clip(carried[unseen], _LARGEST_FIT**-2, _LARGEST_FIT**2))
    return _StartStrips(centre, alpha, 0)


class StripsOrders:
    """Orders of strips that are balanced from the grid's; the error of an order is the change from the one before."""

    def __init__(self, scene: SolverState, start: _StartStrips, rtol: float) -> None:
        scene.built = None  # made for wider strips, and longer
        self.scene, self._rtol, self._start = scene, rtol, start
        self._tight = max(1e-3 * rtol, LOAD_FLOOR)
        self.order, self._failures = ORDERS[0], 0
        self._strips: Strips | None = None
        self._before: Strips | None = None
        self._friction, self._error, self._falls, self._scale, self.cancelled = math.inf, 1.0, 0.0, 1.0, False

    @property
    def contact(self) -> Contact:
        """Strips last balanced."""
        return self._balanced.contact

    @property
    def _balanced(self) -> Strips:
        assert self._strips is not None  # noqa: S101 balanced before it is asked for
        return self._strips

    def balance(self, *, closed: bool = False) -> float | None:
        """Change of friction; a low order may have no strips near the grid's."""
        if closed:
            return self._error
        before, friction_before = self._strips, self._friction
        while (found := self._balance_near(before)) is None:
            self._failures += 1
            if self._failures > self._start.failures or self.order >= _LAST_TRIAL_ORDER:
                return None
            self.order = next_order(self.order, math.inf)
            before, friction_before = None, math.inf
        self._before, self._strips = before, found
        friction, self._scale = found.friction, _error_scale(self.scene, found.friction)
        self.cancelled = self._tight * found.gross_friction > self._rtol * self._scale
        if self.cancelled:
            friction = friction_by_loss(self.scene, found)
            self._scale = _error_scale(self.scene, friction)
        change = min(abs(friction_before - friction) / self._scale, 1.0)
        now = self.order, change
        self._falls = 0.0 if before is None else convergence_power(now, (before.order, self._error))
        self._friction, self._error = friction, change
        return change

    def _balance_near(self, before: Strips | None) -> Strips | None:
        """Strips of the present order from those of the one before, or from the grid's."""
        if before is None:
            return balance_strips(self.scene, self.order, self._start.centre, self._start.alpha, self._tight)
        place = before.contact.eps, before.contact.alpha
        return balance_strips(self.scene, self.order, *place, self._tight, jacobian=before.jacobian)

    def may_split(self) -> bool:
        """At any order."""
        return True

    def is_last(self) -> bool:
        """True at the highest order, and where none resolves the edge layer."""
        return self.order == ORDERS[-1] or self._is_hopeless()

    def _is_hopeless(self) -> bool:
        excess = self._error / self._rtol
        return self.order >= _LAST_TRIAL_ORDER and layer_beyond_reach(
            self.scene, self.contact, (self.order, ORDERS[-1]), excess, self._falls
        )

    def check_energy(self) -> EnergyCheck:
        """Energy, and errors by order, energy and Newton's rest."""
        strips, scale, error, hopeless = self._balanced, self._scale, self._error, self._is_hopeless()
        by_loss = self._friction if self.cancelled else friction_by_loss(self.scene, strips)
        energy = abs(by_loss - strips.friction) / scale
        if not self.cancelled:
            # errors by order, and by Newton's remainder of forces that partly cancel
            turned = strips.gross_friction + float(strips.contact.alpha.max()) / self.scene.problem.rho
            most = ORDER_BOUND * error + strips.left * turned / scale
            if layer_resolution(self.scene, strips.contact, self.order) < RESOLVED_FROM:
                most = math.inf  # orders agree before an edge layer is resolved
            rounding = ROUNDING * strips.gross_friction / scale
            error = max(error, energy / ENERGY_OVER_ERROR, min(ENERGY_MARGIN * energy, most), rounding)
        return EnergyCheck(
            energy, max(error, LAYER_OVER_ENERGY * energy if hopeless else 0.0, _NEWTON_FACTOR * strips.left)
        )

    def advance(self, checked: EnergyCheck | None) -> bool:
        """Raise the order, by two rungs where the error is far off."""
        if self.is_last():
            return False
        error = self._error if checked is None else checked.error
        self.order = next_order(self.order, math.inf if _FAR_OFF * self._rtol < error < 1.0 else 0.0)
        return True

    def result(self, checked: EnergyCheck) -> ContactResult | None:
        """Result, unless the layer touches the roll outside the strips."""
        scene, strips = self.scene, self._balanced
        if overlaps_roll(scene, strips.contact, strips.depth):
            return None
        fields = SpectralFields(scene.problem.layer, scene.creep, strips.contact, scene.problem.rho, strips.depth)
        found = _strips_result(strips, self._before, fields, (checked.error, checked.energy))
        return replace(found, friction=self._friction)


def convergence_power(now: tuple[int, float], before: tuple[int, float]) -> float:
    """Power of the order that changes fall with, from orders and changes; zero where either change is zero."""
    if now[1] == 0.0 or before[1] == 0.0:
        return 0.0
    return math.log(before[1] / now[1]) / math.log(now[0] / before[0])


def _error_scale(scene: SolverState, friction: float) -> float:
    """Reference of relative errors of friction; one for an elastic layer, whose friction is zero."""
    return abs(friction) if scene.lossy and friction else 1.0


def _strip_edges(strips: Strips) -> Array:
    contact = strips.contact
    edges = np.stack([contact.eps - contact.alpha, contact.eps + contact.alpha], axis=1)
    return edges[np.argsort(edges[:, 0])]


def _strips_result(
    strips: Strips, before: Strips | None, fields: SpectralFields, errors: tuple[float, float]
) -> ContactResult:
    contact = strips.contact
    edges = _strip_edges(strips)
    moved = float(contact.alpha.max()) if before is None else float(np.abs(edges - _strip_edges(before)).max())
    left = _NEWTON_FACTOR * strips.left
    low, high = float(edges[0, 0]), float(edges[-1, 1])
    alone = contact.alpha.size == 1
    return ContactResult(
        friction=strips.friction,
        mean_pressure=strips.pressure,
        half_width=float(contact.alpha[0]) if alone else 0.5 * (high - low),
        centre=float(contact.eps[0]) if alone else 0.5 * (high + low),
        strips=edges,
        energy_error=errors[1],
        error_estimate=errors[0],
        edge_error=moved + left * float(contact.alpha.max()),
        peak_error=left,
        fields=fields,
    )


def _grid_outcome(scene: SolverState, grids: list[GridContact], rtol: float) -> SolveOutcome:
    """Outcome of the finest grid; error from the change at the last two doublings and from the energy."""
    grid = grids[-1]
    scale = _error_scale(scene, grid.friction)
    energy = abs(grid.friction_by_loss - grid.friction) / scale
    change = max((abs(g.friction - grid.friction) for g in grids[-3:-1]), default=scale) / scale
    error = max(change, energy, ROUNDING)
    low, high = float(grid.strips[0, 0]), float(grid.strips[-1, 1])
    return SolveOutcome(
        status=Status.OK if error <= rtol else Status.NOT_CONVERGED,
        found=ContactResult(
            friction=grid.friction,
            mean_pressure=grid.mean_pressure,
            half_width=0.5 * (high - low),
            centre=0.5 * (high + low),
            strips=grid.strips,
            energy_error=energy,
            error_estimate=error,
            edge_error=4.0 * math.pi / grid.points,
            fields=GridFields(grid),
        ),
        grid=grid.points,
        way="grid",
        remarks=(_GRID_REMARK.format(grid.points),),
    )


def _wrap_outcome(grid: GridContact, limit: float | None) -> SolveOutcome:
    """Refusal of a load beyond `limit`; where that is unknown the grid's mean pressure bounds it."""
    named = _WRAP_REMARK.format("at most" if limit is None else "about", limit or grid.mean_pressure)
    return SolveOutcome(Status.WRAP_LIMIT, grid=grid.points, way="grid", remarks=(named,))


def _coarsest_points(rho: float) -> int:
    """Points of the first grid, a power of two with at least 64 nodes on the roll."""
    return max(_COARSEST, 1 << math.ceil(math.log2(_COARSEST * math.pi / rho)))
