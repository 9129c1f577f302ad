"""Contact without any assumption on its strips: a real-space grid and nonsymmetric complementarity.

Pressure is piecewise linear on a uniform grid over one period, displacement is collocated at its nodes. With the roll's
drop s = 1 - sqrt(1 - (X/ρ)²) below its crown and the depth Δ of the crown, for every node on the roll

    p ≥ 0,   gap = w + s - Δ ≥ 0,   p · gap = 0,   mean p = p̃_m   (or Δ given).

The hat's transform and its aliases make w = Σ_j t_{i-j} p_j a circulant, T_m = Σ_l S_{m+lN} sinc²(π(m+lN)/N)/|m+lN|.
The symmetric part of the operator, Re S_m/|m|, is positive, so the solution is unique and the principal block pivoting
of Júdice and Pires (Computers & Operations Research 21 (1994) 587) ends: all infeasible nodes change sides at once
(which is the primal-dual active set method), one at a time where that does not lessen their number. Equations of the
active set are solved densely when few, else by GMRES with FFT products and the inverse symbol as preconditioner.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.problem import ContactProblem
from conveyor.contact.solvers.surface_operator import Array, SurfaceOperator
from conveyor.errors import InputError, NoSolutionError

_ROLL_SHARE = 1.0 - 1e-12  # nodes on the roll: |X| < ρ


_DENSE_NODES = 400  # active nodes solved by LU; beyond it GMRES is faster


_PIVOTS, _COSTLY_PIVOTS = 300, 60  # of few and of many active nodes


_FEW_NODES = 520  # nodes on the roll up to which the load is raised from zero where block exchanges fail


_EXCHANGES, _FEW_EXCHANGES = 25, 4  # per node, from zero load (1 to 19 seen) and from another load


_EXCHANGES_AT_HEIGHT = 100  # exchanges at one height (1 to 6 seen): more run in circles, by rounding


_PATIENCE = 10  # block exchanges that may fail to lessen the infeasible nodes (Júdice and Pires)


_ROUNDING = 1e-12  # of the depth; gaps smaller than it are closed


_DENSE_PREFERRED = 1000  # LU is faster than two cycles of GMRES that do not converge


_DENSE_AT_WORST = 2000  # where GMRES does not converge: lags near a right angle, E∞/E0 1000 and more


_KRYLOV_RTOL, _RESTART, _CYCLES, _FEW_CYCLES = 1e-12, 60, 8, 2


@dataclass(frozen=True, eq=False)
class GridContact:
    """Contact on a grid; arrays over the nodes on the roll, X = k x about the roll's axis.

    Attributes
    ----------
    x, pressure : ndarray, shape (m,)
        Nodes X and pressure p̃ at them [-].
    depth : float
        Δ/R [-].
    mean_pressure : float
        p̃_m [-].
    friction : float
        μ [-] by geometry.
    strips : ndarray, shape (l, 2)
        Edges of the strips, X; between nodes by p ∝ sqrt(distance).
    points : int
        Nodes in a period.
    pivots : int
        Exchanges of the active set.
    """

    x: Array
    pressure: Array
    depth: float
    mean_pressure: float
    friction: float
    strips: Array
    points: int
    pivots: int
    _made: SurfaceOperator = field(repr=False)
    _rho: float = field(repr=False)

    @cached_property
    def friction_by_loss(self) -> float:
        """μ [-] by the loss compliance."""
        return self._made.loss(self.pressure) * self._rho / self.mean_pressure

    @cached_property
    def surface_displacement(self) -> Array:
        """Displacement u/R about the mean line at X = 2πj/points [-], shape (points,)."""
        lifted: Array = self._made.whole(self.pressure) - self._made.lift * self.mean_pressure
        return lifted

    @property
    def at_roll_end(self) -> bool:
        """True if the contact reaches the last node on the roll: the load wraps its half circle."""
        return bool(self.pressure[0] > 0.0 or self.pressure[-1] > 0.0)


def solve_grid(
    problem: ContactProblem, points: int, start: GridContact | None = None, *, depth: float | None = None
) -> GridContact:
    """Solve a contact on a grid of `points` nodes in a period.

    Parameters
    ----------
    problem : ContactProblem
        Layer, roll, load and rubber, dimensionless.
    points : int
        Nodes in a period, even, at least 16; at least three must lie on the roll.
    start : GridContact, optional
        Contact on another grid, whose strips are the first active set.
    depth : float, optional
        Prescribed Δ/R [-] in place of the load.

    Raises
    ------
    InputError
        `points` odd, too small, or too few for the roll.
    NoSolutionError
        The active set or GMRES did not converge within its steps.

    Examples
    --------
    >>> from conveyor.contact import CreepSpectrum
    >>> problem = ContactProblem("free", 0.4, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
    >>> grid = solve_grid(problem, 512)
    >>> round(grid.friction, 4), len(grid.strips)
    (0.358, 2)
    """
    return ContactGrid(problem, points).contact(problem.pressure, start, depth=depth)


class RaisedContact(NamedTuple):
    """Contact reached from zero load, and the p̃_m (`limit`) from which it touches the roll's end, else infinite.

    `half` are the nodes in contact under half of that.
    """

    contact: GridContact
    limit: float
    half: NDArray[np.bool_]


class ContactGrid:
    """Surface of a problem on a grid, set up once for any number of loads; parameters as in `solve_grid`."""

    def __init__(self, problem: ContactProblem, points: int) -> None:
        reach = math.floor(problem.rho * _ROLL_SHARE * points / (2.0 * math.pi)) if points > 0 else 0
        if points < 16 or points % 2 or reach < 1:
            raise InputError(f"points = {points!r}: an even number of nodes, three or more of them on the roll")
        index = np.arange(-reach, reach + 1)[: points - 1]
        self.x = np.asarray(index * (2.0 * math.pi / points), dtype=np.float64)
        self.problem = problem
        turn = self.x / problem.rho
        self._drop = np.asarray(turn * turn / (1.0 + np.sqrt(1.0 - turn * turn)), dtype=np.float64)
        self._surface = SurfaceOperator.of(problem, points, index)

    def contact(self, pressure: float, start: GridContact | None = None, *, depth: float | None = None) -> GridContact:
        """Contact under a mean pressure p̃_m, or at a depth Δ/R in its place."""
        try:
            return self.block_exchange(pressure, start, depth=depth)
        except NoSolutionError:
            if self.x.size > _FEW_NODES or depth is not None:
                raise
            return self.raised(pressure).contact

    def block_exchange(
        self, pressure: float, start: GridContact | None = None, *, depth: float | None = None
    ) -> GridContact:
        """`contact` by block exchanges alone, which may run in circles."""
        active = np.abs(self.x) < 0.5 * self.problem.rho if start is None else _nodes_in_strips(self.x, start.strips)
        return self._contact(active, pressure, depth)

    def raised(self, pressure: float, start: GridContact | None = None) -> RaisedContact:
        """Contact under a mean pressure p̃_m reached from zero load, and the load at which it touches the roll's end.

        Starts from the load of `start`, a contact on another grid, where that has a solution here. For some hundred
        nodes: each exchange of the active set costs their square.
        """
        if start is not None:
            try:
                begun = self._contact(_nodes_in_strips(self.x, start.strips), start.mean_pressure, None)
                return self._lowered(begun.pressure > 0.0, begun.mean_pressure, pressure, _FEW_EXCHANGES)
            except NoSolutionError:
                pass  # what rounding makes of two nodes that touch at once may run in circles
        return self._lowered(np.zeros(self.x.size, dtype=bool), 0.0, pressure, _EXCHANGES)

    def _lowered(self, active: NDArray[np.bool_], carried: float, pressure: float, exchanges: int) -> RaisedContact:
        """`raised` from the nodes in contact under a smaller mean pressure."""
        surface, height = self._surface, 0.0
        if carried:
            height = _active_set_pressure(surface, self._drop, np.flatnonzero(active), (carried, None))[1]
        tableau = _Tableau(surface.dense(np.arange(self.x.size)), self._drop, active, height)
        limit = tableau.lower(pressure * self.points, exchanges * self.x.size)
        half = tableau.active_under(0.5 * limit)
        return RaisedContact(self._contact(tableau.active, pressure, None), limit / self.points, half)

    def halfway(self, raised: RaisedContact) -> GridContact:
        """Contact under half the mean pressure that touches the roll's end."""
        return self._contact(raised.half, 0.5 * raised.limit, None)

    @property
    def points(self) -> int:
        """Nodes in a period."""
        return self._surface.points

    def _contact(self, active: NDArray[np.bool_], pressure: float, depth: float | None) -> GridContact:
        surface, turn = self._surface, self.x / self.problem.rho
        slope = turn / np.sqrt(1.0 - turn * turn)
        p, delta, pivots = _block_pivoting(surface, self._drop, active, pressure, depth)
        mean = float(p.sum()) / surface.points
        return GridContact(
            x=self.x,
            pressure=p,
            depth=delta,
            mean_pressure=mean,
            friction=float(p @ slope) / surface.points / mean,
            strips=_strip_edges(self.x, p),
            points=surface.points,
            pivots=pivots,
            _made=surface,
            _rho=self.problem.rho,
        )


def _block_pivoting(
    surface: SurfaceOperator, drop: Array, active: NDArray[np.bool_], mean: float, depth: float | None
) -> tuple[Array, float, int]:
    """Principal block pivoting: pressure at the nodes, depth, number of exchanges."""
    active = active.copy()
    if not active.any():
        active[np.argmin(drop)] = True
    fewest, patience = drop.size + 1, _PATIENCE
    costly, dense = 0, _DENSE_NODES
    seen = set[bytes]()
    for pivots in range(1, _PIVOTS + 1):
        costly += int(active.sum() > _DENSE_NODES)
        if costly > _COSTLY_PIVOTS:
            break
        p, raised, dense = _active_set_pressure(surface, drop, np.flatnonzero(active), (mean, depth), dense)
        gap = surface.lifted(p) + drop - raised
        closed = _ROUNDING * max(abs(raised), float(drop.max()))
        wrong = np.where(active, p < 0.0, gap < -closed)
        count = int(wrong.sum())
        if count == 0:
            return p, raised - surface.lift * float(p.sum()) / surface.points, pivots
        before, now = len(seen), active.tobytes()
        seen.add(now)
        if count < fewest:
            fewest, patience = count, _PATIENCE
        elif patience > 0 and len(seen) > before:
            patience -= 1
        elif drop.size <= _FEW_NODES and depth is None:
            break
        else:
            last = np.flatnonzero(wrong)[-1]
            wrong = np.arange(wrong.size) == last
        active ^= wrong
        if not active.any():
            active[np.argmin(drop)] = True
    raise NoSolutionError(f"the active set of the grid did not settle in {pivots - 1} exchanges")


class _Tableau:
    """Pressures and gaps of all nodes by principal pivots: an exchange of a node pivots on the diagonal.

    Pressure or gap of every node is zero; the other is constant + slope δ, with δ the roll's raised depth, `height`.
    The matrix is positive definite: its diagonal stays positive, and the path as the roll is lowered is unique.
    """

    def __init__(self, matrix: Array, drop: Array, active: NDArray[np.bool_], height: float) -> None:
        a, b = np.flatnonzero(active), np.flatnonzero(~active)
        self.active, self.height = active.copy(), height
        self._before, self._way = active.copy(), list[tuple[float, int]]()
        self.table, self.lines = np.array(matrix, order="F"), np.stack([drop, -np.ones(drop.size)])
        if a.size:
            inverse, over = np.linalg.inv(matrix[np.ix_(a, a)]), matrix[np.ix_(a, b)]
            under = matrix[np.ix_(b, a)] @ inverse
            self.lines[:, b] -= self.lines[:, a] @ under.T
            self.lines[:, a] = -self.lines[:, a] @ inverse.T
            self.table[np.ix_(a, a)], self.table[np.ix_(a, b)] = inverse, -inverse @ over
            self.table[np.ix_(b, a)], self.table[np.ix_(b, b)] = under, matrix[np.ix_(b, b)] - under @ over

    def lower(self, load: float, exchanges: int) -> float:
        """Lower the roll until Σ p = `load`; returns the Σ p from which an end node is in contact, or infinity."""
        from scipy.linalg.blas import dger  # 10 ms that contacts without a grid do without

        limit = 0.0 if self._at_end() else math.inf
        constant, slope = self.lines
        at_once = 0
        for _ in range(exchanges):
            ready = np.where(slope < 0.0, constant, math.inf) / np.abs(slope)
            node = int(ready.argmin())
            at_once = 0 if ready[node] > self.height else at_once + 1
            if at_once > _EXCHANGES_AT_HEIGHT:
                break
            self.height = max(self.height, float(ready[node]))
            carried = math.inf
            if math.isfinite(self.height):
                carried = float(constant @ self.active + self.height * (slope @ self.active))
            if carried >= load:
                return limit
            self._exchange(node, dger)
            self._way.append((carried, node))
            limit = min(limit, carried) if self._at_end() else math.inf
        raise NoSolutionError(f"the load on the grid did not rise within {len(self._way)} exchanges")

    def active_under(self, load: float) -> NDArray[np.bool_]:
        """Nodes in contact under a smaller Σ p of the path taken."""
        active = self._before.copy()
        for carried, node in self._way:
            if carried > load:
                break
            active[node] ^= True
        return active

    def _at_end(self) -> bool:
        return bool(self.active[0] or self.active[-1])

    def _exchange(self, node: int, rank_one: Callable[..., Array]) -> None:
        """Exchange a node's pressure and gap."""
        inverse = 1.0 / self.table[node, node]
        column, row, line = self.table[:, node].copy(), self.table[node].copy(), self.lines[:, node] * inverse
        self.lines -= line[:, None] * column
        self.table = rank_one(-inverse, column, row, a=self.table, overwrite_a=1)
        self.table[node], self.table[:, node] = -row * inverse, column * inverse
        self.lines[:, node], self.table[node, node] = -line, inverse
        self.active[node] ^= True


def _active_set_pressure(
    surface: SurfaceOperator,
    drop: Array,
    nodes: NDArray[np.int_],
    held: tuple[float, float | None],
    dense: int = _DENSE_NODES,
) -> tuple[Array, float, int]:
    """Pressure with w + s = Δ at the active nodes, the raised depth Δ + lift x mean pressure, and the next `dense`.

    `held` are the mean pressure and, in its place, a depth or None.
    """
    mean, depth = held
    right = np.stack([-drop[nodes], np.ones(nodes.size)], axis=1)
    answer, dense = _solve_active_set(surface, nodes, right, dense)
    shape, level = answer.T
    # p = shape + (Δ + lift x mean) level
    if depth is None:
        raised = (mean * surface.points - shape.sum()) / level.sum()
    else:
        share = surface.lift / surface.points
        raised = (depth + share * shape.sum()) / (1.0 - share * level.sum())
    p = np.zeros(drop.size)
    p[nodes] = shape + raised * level
    return p, float(raised), dense


def _solve_active_set(surface: SurfaceOperator, nodes: NDArray[np.int_], right: Array, dense: int) -> tuple[Array, int]:
    """Solution of an active set's equations, and the size up to which the next one is solved densely."""
    if nodes.size <= dense:
        return _solve_densely(surface, nodes, right), dense
    from scipy.sparse.linalg import LinearOperator, gmres  # 40 ms that small grids do without

    full = np.zeros(surface.index.size)

    def spread(values: Array) -> Array:
        full[:] = 0.0
        full[nodes] = values
        return full

    size = (nodes.size, nodes.size)
    product = LinearOperator(size, lambda v: surface.lifted(spread(v))[nodes], dtype=np.float64)
    inverse = LinearOperator(size, lambda v: surface.pressed(spread(v))[nodes], dtype=np.float64)
    out = np.empty_like(right)
    cycles = _FEW_CYCLES if nodes.size <= _DENSE_PREFERRED else _CYCLES
    for k in range(right.shape[1]):
        out[:, k], failed = gmres(product, right[:, k], rtol=_KRYLOV_RTOL, restart=_RESTART, maxiter=cycles, M=inverse)
        if failed and nodes.size <= _DENSE_AT_WORST:
            return _solve_densely(surface, nodes, right), max(_DENSE_PREFERRED, nodes.size)
        if failed:
            raise NoSolutionError(f"GMRES did not settle on {nodes.size} active nodes of the grid")
    return out, dense


def _solve_densely(surface: SurfaceOperator, nodes: NDArray[np.int_], right: Array) -> Array:
    try:
        return np.asarray(np.linalg.solve(surface.dense(nodes), right), dtype=np.float64)
    except np.linalg.LinAlgError as singular:
        raise NoSolutionError(f"the grid's equations of {nodes.size} active nodes are singular") from singular


def _nodes_in_strips(x: Array, strips: Array) -> NDArray[np.bool_]:
    return np.asarray(((x[:, None] >= strips[:, 0]) & (x[:, None] <= strips[:, 1])).any(axis=1))


def _strip_edges(x: Array, p: Array) -> Array:
    """Strips of positive pressure; an edge lies h p1²/(p2² - p1²), at most one step, beyond its last node."""
    step = x[1] - x[0]
    change = np.diff(np.concatenate([[0], (p > 0.0).astype(int), [0]]))
    out = []
    for first, last in zip(np.flatnonzero(change == 1), np.flatnonzero(change == -1) - 1, strict=True):
        beyond = []
        for edge, inner in ((first, first + 1), (last, last - 1)):
            rise = p[inner] ** 2 - p[edge] ** 2 if last > first else 0.0
            beyond.append(step * min(1.0, p[edge] ** 2 / rise) if rise > 0.0 else 0.5 * step)
        out.append((x[first] - beyond[0], x[last] + beyond[1]))
    return np.array(out)
