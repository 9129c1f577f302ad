"""Contacts of any number of strips: located on a grid, refined spectrally.

The grid is refined until two of them show the same strips, each resolved; from these `strips.settle` converges to the
spectral contact, which must press inside every strip and touch nowhere else. Strips too close for the spectral window
keep the grid's solution and error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.contact_fields import RESOLVED_FROM, GridFields, SpectralFields
from conveyor.contact.galerkin.orders import ORDERS, next_order
from conveyor.contact.problem import Status
from conveyor.contact.solution import ContactResult, SolveOutcome
from conveyor.contact.solvers.acceptance import (
    ENERGY_MARGIN,
    ENERGY_OVER_ERROR,
    ORDER_BOUND,
    PressureSign,
    overlaps_roll,
    worst_sign_and_tension,
)
from conveyor.contact.solvers.grid_solver import ContactGrid, GridContact, RaisedContact, solve_grid
from conveyor.contact.solvers.one_strip import (
    LAYER_OVER_ENERGY,
    LOAD_FLOOR,
    ROUNDING,
    SETTLED_CHANGE,
    SIGN_ORDER,
    layer_beyond_reach,
    layer_resolution,
    pressure_remarks,
)
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.contact.solvers.strips import Strips, balance_strips, friction_by_loss, strip_loads, too_close
from conveyor.errors import NoSolutionError

Array = NDArray[np.float64]

_COARSEST = 64  # nodes on the roll of the first grid
_FIRST_POLISH, _WRAP_LEVEL, _FINEST = 2, 6, 10  # doublings of it
_MOST_POINTS = 1 << 20
_LAST_TRIAL_ORDER, _ORDER_FAILURES = 64, 2  # low orders may have no contact near the grid's
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


def solve_strips(scene: SolverState, rtol: float, seen: CoarseContact | None = None) -> SolveOutcome:
    """Solve for a contact of any number of strips; `seen` is the coarse contact, if known."""
    grids: list[GridContact] = []
    failure, polishes = "", 0
    for doubling in range(_FINEST + 1):
        points = _coarsest_points(scene.problem.rho) << doubling
        if points > _MOST_POINTS:
            break
        try:
            grids.append(_grid_contact(scene, points, grids[-1] if grids else None, seen))
        except NoSolutionError as unsettled:
            failure = str(unsettled)
            break
        if grids[-1].at_roll_end and (doubling >= _WRAP_LEVEL or 2 * points > _MOST_POINTS):
            break
        steady = doubling >= _FIRST_POLISH and len(grids[-1].strips) == len(grids[-2].strips)
        start = _initial_strips(scene, grids[-1]) if steady and polishes < _POLISHES else None
        if start is not None:
            polishes += 1
            outcome = _polish_strips(scene, grids[-1], start, rtol)
            if outcome is not None:
                return outcome
    if not grids:
        return SolveOutcome(Status.NOT_CONVERGED, way="grid", remarks=(failure,))
    if grids[-1].at_roll_end:
        seen = seen or CoarseContact.of(scene, grids[-1].mean_pressure)
        return _wrap_outcome(grids[-1], seen.limit)
    return _grid_outcome(scene, grids, rtol)


def _grid_contact(
    scene: SolverState, points: int, start: GridContact | None, seen: CoarseContact | None
) -> GridContact:
    """Contact on a grid, started from a coarser one, or that of `seen`."""
    if start is not None or seen is None:
        return solve_grid(scene.problem, points, start, depth=scene.depth)
    return seen.raised.contact if seen.raised else seen.coarse.block_exchange(scene.problem.pressure)


def _initial_strips(scene: SolverState, grid: GridContact) -> _StartStrips | None:
    """Start strips from the grid; a strip that it does not resolve gets the half width that carries its force.

    None where strips touch one another or come too near to the roll's end.
    """
    step, rho = 2.0 * math.pi / grid.points, scene.problem.rho
    if grid.at_roll_end or (grid.strips[1:, 0] - grid.strips[:-1, 1] <= _GAP_NODES * step).any():
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


def _polish_strips(scene: SolverState, grid: GridContact, start: _StartStrips, rtol: float) -> SolveOutcome | None:
    """Spectral solution from the grid's strips, the order raised until friction converges; None where they fail."""
    centre, alpha, allowed = start
    scene.rules.clear()  # made for wider strips, and longer
    tight = max(1e-3 * rtol, LOAD_FLOOR)
    n, before, failures, friction_before, change_before = ORDERS[0], None, 0, math.inf, 1.0
    while True:
        strips = balance_strips(
            scene, n, centre, alpha, tight, jacobian=before.jacobian if before is not None else None
        )
        if strips is None:
            # a low order may have no contact near the grid's
            failures += 1
            if failures > allowed or n >= _LAST_TRIAL_ORDER:
                return None
            centre, alpha = start.centre, start.alpha
            n, before, friction_before = next_order(n, 1.0, rtol), None, math.inf
            continue
        friction, scale = strips.friction, _error_scale(scene, strips.friction)
        cancelled = tight * strips.gross_friction > rtol * scale
        if cancelled:
            friction = friction_by_loss(scene, strips)
            scale = _error_scale(scene, friction)
        error = change = min(abs(friction_before - friction) / scale, 1.0)
        pressing, tension = worst_sign_and_tension(strips.contact, rtol)
        if pressing is PressureSign.PULLING and error <= SETTLED_CHANGE:
            return None
        falls = math.log(change_before / change) / math.log(n / before.order) if before and change else 0.0
        hopeless = n >= _LAST_TRIAL_ORDER and layer_beyond_reach(
            scene, strips.contact, (n, ORDERS[-1]), error / rtol, falls
        )
        if error <= rtol or n == ORDERS[-1] or hopeless:
            by_loss = friction if cancelled else friction_by_loss(scene, strips)
            energy = abs(by_loss - strips.friction) / scale
            if not cancelled:
                # errors by order, and by Newton's remainder of forces that partly cancel
                most = (
                    ORDER_BOUND * error
                    + strips.left * (strips.gross_friction + _relative_half_width(strips, scene)) / scale
                )
                rounding = ROUNDING * strips.gross_friction / scale
                resolved = layer_resolution(scene, strips.contact, n) >= RESOLVED_FROM
                most = most if resolved else math.inf  # orders agree before an edge layer is resolved
                error = max(error, energy / ENERGY_OVER_ERROR, min(ENERGY_MARGIN * energy, most), rounding)
            error = max(
                error,
                LAYER_OVER_ENERGY * energy if hopeless else ROUNDING,
                _NEWTON_FACTOR * strips.left,
                tension,
            )
            decided = n >= SIGN_ORDER or pressing is not PressureSign.UNDECIDED
            if (error <= rtol and decided) or n == ORDERS[-1] or hopeless:
                if overlaps_roll(scene, strips.contact, strips.depth):
                    return None
                fields = SpectralFields(
                    scene.problem.layer, scene.creep, strips.contact, scene.problem.rho, strips.depth
                )
                return SolveOutcome(
                    status=Status.OK if error <= rtol else Status.NOT_CONVERGED,
                    found=replace(_strips_result(strips, before, fields, (error, energy)), friction=friction),
                    order=n,
                    grid=grid.points,
                    way="strips",
                    remarks=(*pressure_remarks(pressing), *((_CANCELLATION_REMARK,) if cancelled else ())),
                )
        before, centre, alpha = strips, strips.contact.eps, strips.contact.alpha
        friction_before, change_before = friction, change
        n = next_order(n, error if error < 1.0 else 0.0, rtol)


def _error_scale(scene: SolverState, friction: float) -> float:
    """Reference of relative errors of friction; one for an elastic layer, whose friction is zero."""
    return abs(friction) if scene.lossy and friction else 1.0


def _relative_half_width(strips: Strips, scene: SolverState) -> float:
    """Largest half width over R: turn of a strip's force as it moves by its half width."""
    return float(strips.contact.alpha.max()) / scene.problem.rho


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
