"""Any number of strips: found on the grid, polished spectrally.

The grid is refined until two of them show the same strips, each wide enough to be seen; from these `strips.settle`
converges to the spectral contact, which must press inside every strip and touch nowhere else. Strips too close for
the spectral window keep the grid's answer with the grid's error.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.checks import ENERGY_OVER_ERROR, Sign, overlaps, sign
from conveyor.contact.fields import GridFields, SpectralFields
from conveyor.contact.grid import Grid, GridContact, solve_grid
from conveyor.contact.orders import ORDERS, next_order
from conveyor.contact.problem import Status
from conveyor.contact.scene import Scene
from conveyor.contact.single import LOAD_FLOOR, ROUNDING, SIGN_ORDER, remarks
from conveyor.contact.solution import Found, Outcome
from conveyor.contact.strips import Strips, friction_by_loss, settle
from conveyor.errors import NoSolutionError

Array = NDArray[np.float64]

_COARSEST = 64  # nodes on the roll of the first grid
_FIRST_POLISH, _WRAP_LEVEL, _FINEST = 2, 6, 10  # doublings of it
_MOST_POINTS = 1 << 20
_LAST_TRY, _FAILURES = 64, 2  # orders that may have no contact near the grid's
_SETTLED = 1e-3  # change of friction below which tension is no longer the order's ripple
_POLISHES = 3  # grids whose strips are tried
_STRIP_NODES, _GAP_NODES = 3.0, 2.0  # that show a strip, and that two strips are apart
_LIMIT = "the contact comes within a hundredth of the half circle's end at a mean pressure of about {:.3g}"
_NO_LIMIT = "twelve decades below a mean pressure of {:.3g} none was found that a coarse grid carries"
_LIMIT_FINER = 1 << _FIRST_POLISH  # times the coarsest grid
_FAR_BEYOND = 1.5  # times the limit of a coarse grid: no finer one will carry the load
_LIMIT_ABOUT, _LIMIT_WIDTH = 0.5, 2e-2  # of ln p: where 64 nodes have the limit, and to what 256 name it
_LIMIT_DECADES = 12.0  # that are searched
_ON_GRID = "the strips are known on a grid of {} nodes only"


def overloaded(scene: Scene) -> Outcome | None:
    """The refusal of a load far beyond what a coarse grid carries; None where that is not plain."""
    try:
        grid = solve_grid(scene.problem, _coarsest(scene.problem.rho))
    except NoSolutionError:
        return None
    limit = _limit_passed(scene, grid, 0)
    return None if limit is None else _overloaded(grid, limit)


def by_strips(scene: Scene, rtol: float) -> Outcome:
    """The contact with as many strips as it has."""
    points = _coarsest(scene.problem.rho)
    grids: list[GridContact] = []
    failure, polishes = "", 0
    for doubling in range(_FINEST + 1):
        if points > _MOST_POINTS:
            break
        try:
            grids.append(solve_grid(scene.problem, points, grids[-1] if grids else None, depth=scene.depth))
        except NoSolutionError as unsettled:
            failure = str(unsettled)
            break
        limit = _limit_passed(scene, grids[-1], doubling)
        if limit is not None:
            return _overloaded(grids[-1], limit)
        steady = doubling >= _FIRST_POLISH and len(grids[-1].strips) == len(grids[-2].strips)
        if steady and polishes < _POLISHES and _seen(grids[-1]):
            polishes += 1
            outcome = _polished(scene, grids[-1], rtol)
            if outcome is not None:
                return outcome
        points *= 2
    if not grids:
        return Outcome(Status.NOT_CONVERGED, way="grid", remarks=(failure,))
    if grids[-1].at_roll_end:
        return _overloaded(grids[-1], _limit(scene, grids[-1]))
    return _on_grid(scene, grids, rtol)


def _seen(grid: GridContact) -> bool:
    """Whether every strip, and every gap between two, spans a few nodes."""
    step = 2.0 * math.pi / grid.points
    widths = grid.strips[:, 1] - grid.strips[:, 0]
    gaps = grid.strips[1:, 0] - grid.strips[:-1, 1]
    return bool((widths > _STRIP_NODES * step).all() and (gaps > _GAP_NODES * step).all())


def _polished(scene: Scene, grid: GridContact, rtol: float) -> Outcome | None:
    """The grid's strips spectrally, the order raised until friction settles; None where they are not the contact."""
    centre, alpha = grid.strips.mean(axis=1), 0.5 * (grid.strips[:, 1] - grid.strips[:, 0])
    tight = max(1e-3 * rtol, LOAD_FLOOR)
    n, before, failures = ORDERS[0], None, 0
    while True:
        strips = settle(
            scene, n, centre, alpha, tight, jacobian=before.jacobian if before is not None else None
        )
        if strips is None:
            # a low order may have no contact near the grid's
            failures += 1
            if failures > _FAILURES or n >= _LAST_TRY:
                return None
            centre, alpha = grid.strips.mean(axis=1), 0.5 * (grid.strips[:, 1] - grid.strips[:, 0])
            n, before = next_order(n, 1.0, rtol), None
            continue
        error, scale = 1.0, _scale(scene, strips.friction)
        if before is not None:
            error = abs(before.friction - strips.friction) / scale
        pressing = sign(strips.contact, rtol)
        if pressing is Sign.PULLING and error <= _SETTLED:
            return None
        exhausted = n == ORDERS[-1] or error <= strips.rounding / scale
        if error <= rtol or exhausted:
            energy = abs(friction_by_loss(scene, strips) - strips.friction) / scale
            error = max(error, energy / ENERGY_OVER_ERROR, strips.rounding / scale, ROUNDING)
            decided = n >= SIGN_ORDER or pressing is not Sign.UNDECIDED
            if (error <= rtol and decided) or exhausted:
                if overlaps(scene, strips.contact, strips.depth):
                    return None
                fields = SpectralFields(
                    scene.problem.layer, scene.creep, strips.contact, scene.problem.rho, strips.depth
                )
                return Outcome(
                    status=Status.OK if error <= rtol else Status.NOT_CONVERGED,
                    found=_found(strips, before, fields, (error, energy)),
                    order=n,
                    grid=grid.points,
                    way="strips",
                    remarks=remarks(pressing),
                )
        before, centre, alpha = strips, strips.contact.eps, strips.contact.alpha
        n = next_order(n, error if error < 1.0 else 0.0, rtol)


def _scale(scene: Scene, friction: float) -> float:
    """What errors of friction are relative to; one where the layer is elastic and friction is zero."""
    return abs(friction) if scene.lossy and friction else 1.0


def _edges(strips: Strips) -> Array:
    contact = strips.contact
    edges = np.stack([contact.eps - contact.alpha, contact.eps + contact.alpha], axis=1)
    return edges[np.argsort(edges[:, 0])]


def _found(
    strips: Strips, before: Strips | None, fields: SpectralFields, errors: tuple[float, float]
) -> Found:
    contact = strips.contact
    edges = _edges(strips)
    moved = float(contact.alpha.max()) if before is None else float(np.abs(edges - _edges(before)).max())
    low, high = float(edges[0, 0]), float(edges[-1, 1])
    alone = contact.alpha.size == 1
    return Found(
        friction=strips.friction,
        mean_pressure=strips.pressure,
        half_width=float(contact.alpha[0]) if alone else 0.5 * (high - low),
        centre=float(contact.eps[0]) if alone else 0.5 * (high + low),
        strips=edges,
        energy_error=errors[1],
        error_estimate=errors[0],
        edge_error=moved,
        fields=fields,
    )


def _on_grid(scene: Scene, grids: list[GridContact], rtol: float) -> Outcome:
    """The finest grid's contact; its error from the change at the last two doublings and from the energy."""
    grid = grids[-1]
    scale = _scale(scene, grid.friction)
    energy = abs(grid.friction_by_loss - grid.friction) / scale
    change = max((abs(g.friction - grid.friction) for g in grids[-3:-1]), default=scale) / scale
    error = max(change, energy, ROUNDING)
    low, high = float(grid.strips[0, 0]), float(grid.strips[-1, 1])
    return Outcome(
        status=Status.OK if error <= rtol else Status.NOT_CONVERGED,
        found=Found(
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
        remarks=(_ON_GRID.format(grid.points),),
    )


def _overloaded(grid: GridContact, limit: float | None) -> Outcome:
    said = _NO_LIMIT.format(grid.mean_pressure) if limit is None else _LIMIT.format(limit)
    return Outcome(Status.WRAP_LIMIT, grid=grid.points, way="grid", remarks=(said,))


def _limit_passed(scene: Scene, grid: GridContact, doubling: int) -> float | None:
    """The limit of a load that wraps the roll: seen on a fine grid, or on a coarse one far beyond its limit."""
    if not grid.at_roll_end or 0 < doubling < _WRAP_LEVEL:
        return None
    limit = _limit(scene, grid)
    if limit is None:
        return None
    return limit if doubling >= _WRAP_LEVEL or grid.mean_pressure > _FAR_BEYOND * limit else None


def _limit(scene: Scene, wrapped: GridContact) -> float | None:
    """The mean pressure that brings the contact to the last of 256 nodes on the roll, sought about where 64 have it.

    None where twelve decades hold none.
    """
    nodes = _coarsest(scene.problem.rho)
    about = _least_wrapped(Grid(scene.problem, nodes), wrapped, _LIMIT_ABOUT, 2.0)
    if about is None:
        return None
    finer = Grid(scene.problem, _LIMIT_FINER * nodes)
    load = about.mean_pressure * math.exp(_LIMIT_ABOUT)
    while load < wrapped.mean_pressure:
        start = _settled(finer, load, about)
        if start is not None and start.at_roll_end:
            wrapped = start
            break
        load *= math.exp(2.0 * _LIMIT_ABOUT)
    is_wrapped = _least_wrapped(finer, wrapped, _LIMIT_WIDTH, 2.0 * _LIMIT_ABOUT)
    return None if is_wrapped is None else is_wrapped.mean_pressure


def _settled(grid: Grid, load: float, *starts: GridContact) -> GridContact | None:
    """The contact under a load, from the first of these contacts that leads to it."""
    for start in starts:
        try:
            return grid.contact(load, start)
        except NoSolutionError:
            continue
    return None


def _least_wrapped(grid: Grid, wrapped: GridContact, width: float, stride: float) -> GridContact | None:
    """A contact at the roll's end that leaves it where ln p is less by `width`; None where no load does.

    Loads that do not settle are told by neither side: the search keeps to those beside them that wrap.
    """
    lightest = math.log(wrapped.mean_pressure) - _LIMIT_DECADES * math.log(10.0)
    high, low, carried = math.log(wrapped.mean_pressure), -math.inf, wrapped
    while high - low > width:
        step = min(stride, 0.5 * (high - low))
        wrapped_one = None
        while wrapped_one is None and step >= 0.5 * width:
            wrapped_one = _settled(grid, math.exp(high - step), wrapped, carried)
            step *= 1.0 if wrapped_one is not None else 0.5
        if wrapped_one is None:
            break
        if wrapped_one.at_roll_end:
            high, wrapped = high - step, wrapped_one
        else:
            low, carried = high - step, wrapped_one
        if high < lightest:
            return None
    return wrapped


def _coarsest(rho: float) -> int:
    """Points of the first grid: a power of two with at least 64 nodes on the roll."""
    return max(_COARSEST, 1 << math.ceil(math.log2(_COARSEST * math.pi / rho)))
