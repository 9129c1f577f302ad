"""Several strips under one roll, spectrally: each its own Chebyshev basis, zero stress intensity at every edge.

Strip l has centre X_l about the roll's axis and half width α_l. Its own block is that of spectral.py; the block of
test strip l and source strip r is

    g_i = (2-δ_i0) Σ_v v c_v Σ_{m≥1} Re[i^{q+2} S_m e^{im(X_l-X_r)}] J_v(mα_r) J_i(mα_l)/m,   q = i - v,

whose kernel is smooth because the strips do not touch: the flat-topped window ½ erfc((m-m0)/w), m0 = 6.5 w, cuts the
sum off at exp(-(w gap)²/4), and w = 12.5/gap leaves 1e-17 of it. The unknown places follow from row 0 of every strip,
equal heights of the one rigid roll and the load (or depth), by Newton from the grid's strips.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from numpy.typing import NDArray
from scipy import special

from conveyor.contact.fields.energy_balance import energy_loss
from conveyor.contact.galerkin.bessel import ProductIK, bessel_j
from conveyor.contact.galerkin.quadrature import (
    CHECK_PANELS,
    SOLVE_PANELS,
    Panels,
    Rule,
    build_rule,
    series_rule,
)
from conveyor.contact.galerkin.roll_profile import mean_drop, slope_expansion
from conveyor.contact.galerkin.spectral import (
    Contact,
    assemble_matrix,
    contact_from_coefficients,
    mean_displacement,
    sign_factors,
)
from conveyor.contact.solvers.solver_state import SolverState

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_ALIAS, _RAMP = 12.5, 6.5  # as in quadrature.py
_LONGEST = 20_000  # nodes of the window: gaps below 0.008, or 0.008 of the contact's width, stay on the grid
_LOAD_ORDER = 8  # order for a strip's load
_CHUNK = 4_000_000
_NEWTON_STEPS = 24
_STEP_SHRINKAGE = 0.25  # a step of the one before; else the Jacobian is formed anew
_STALL_FACTOR = 100.0  # times the tolerance: steps that shrink no more are rounding
_CLOSING = 0.25  # of the first gap: strips that come as close run into one another
_LARGEST_GROWTH = math.log(10.0)  # of ln α from the first: a line that grows as much has no balance here
_DIFFERENCE = 1e-6  # of α, for the Jacobian's columns: Newton then gains six digits a step
_LARGEST_STEP, _LARGEST_LOG, _ROOM = (
    0.5,
    1.0,
    0.25,
)  # of the narrowest half width, of ln α, of the room of a strip


@dataclass(frozen=True, eq=False)
class Strips:
    """Strips in equilibrium under one roll: `contact` holds one an entry, eps = X_l, `jacobian` is Newton's.

    `left` is Newton's last step of ln α_l, and of X_l in half widths.
    """

    contact: Contact
    depth: float
    jacobian: Array
    left: float

    @property
    def order(self) -> int:
        """Galerkin order n of each strip."""
        return int(self.contact.c.shape[1])

    @property
    def pressure(self) -> float:
        """p̃_m [-]."""
        return float(self.contact.pressure.sum())

    @property
    def gross_friction(self) -> float:
        """Sum of the strips' forces regardless of their sign, over the load, μ [-]: they may cancel."""
        return float(np.abs(self.contact.friction) @ self.contact.pressure) / self.pressure

    @property
    def friction(self) -> float:
        """μ [-]."""
        return float(self.contact.friction @ self.contact.pressure) / self.pressure


def smallest_gap(centre: Array, alpha: Array) -> float:
    """Smallest distance X between strips, those of the next roll included; the period where there is one strip."""
    if alpha.size == 1:
        return 2.0 * math.pi
    rank = np.argsort(centre)
    low, high = (centre - alpha)[rank], (centre + alpha)[rank]
    return float(np.min(np.append(low[1:], low[0] + 2.0 * math.pi) - high))


def _outer_span(centre: Array, alpha: Array) -> float:
    """Distance X of the outer edges."""
    return float((centre + alpha).max() - (centre - alpha).min())


def too_close(centre: Array, alpha: Array) -> bool:
    """True where strips touch, or their window would need more than some 20,000 nodes."""
    reach = 2.0 * _RAMP * _ALIAS * min(_outer_span(centre, alpha), 1.0)
    return _LONGEST * smallest_gap(centre, alpha) < reach


def balance_strips(
    scene: SolverState,
    n: int,
    centre: Array,
    alpha: Array,
    tolerance: float,
    *,
    jacobian: Array | None = None,
) -> Strips | None:
    """Balance strips by Newton in (X_l, ln α_l) for the load or depth; None where it does not converge.

    Parameters
    ----------
    centre, alpha : ndarray, shape (l,)
        Strips to start from, X about the roll's axis [-].
    tolerance : float
        Change of ln α_l, and of X_l in half widths, at which Newton ends [-].
    jacobian : ndarray, shape (2l, 2l), optional
        That of another order: used while each step is at most a quarter of the one before, else formed anew.
    """
    count, rho = alpha.size, scene.problem.rho
    place = np.concatenate([centre, np.log(alpha)])
    before = last = math.inf
    closest = _CLOSING * smallest_gap(centre, alpha)
    for _ in range(_NEWTON_STEPS):
        x, a = place[:count], np.exp(place[count:])
        astray = np.abs(np.log(a / alpha)).max() > _LARGEST_GROWTH or smallest_gap(x, a) < closest
        if astray or np.any(a + np.abs(x) >= rho) or too_close(x, a):
            return None
        unit = np.concatenate([a, np.ones(count)])
        steps = _DIFFERENCE * unit if jacobian is None else np.empty(0)
        places = np.vstack([place, place + np.diag(steps)]) if jacobian is None else place[None]
        trial = _TrialStrips(scene, n, places[:, :count], np.exp(places[:, count:]))
        residual = trial.residual()
        if residual is None:
            return None
        if jacobian is None:
            jacobian = ((residual[1:] - residual[0]) / steps[:, None]).T
        step = np.linalg.solve(jacobian, residual[0])
        allowed = np.append(np.maximum(_strip_room(x, a, rho), _LARGEST_STEP * a.min()), np.full(count, _LARGEST_LOG))
        largest = float(np.abs(step / unit).max())
        if largest <= tolerance or (largest <= _STALL_FACTOR * tolerance and largest > _STEP_SHRINKAGE * last):
            return trial.strips(jacobian, largest)
        last = largest
        if largest > _STEP_SHRINKAGE * before:
            jacobian, before = None, math.inf
            continue
        before = largest
        place = place - step * min(1.0, float((allowed / np.maximum(np.abs(step), allowed)).min()))
    return None


def _strip_room(centre: Array, alpha: Array, rho: float) -> Array:
    """Largest step of each strip: a share of its distance from its neighbours and from the roll's end."""
    ends = np.concatenate([centre - alpha, centre + alpha, [-rho, rho]])
    away = np.abs(np.subtract.outer(centre, ends))
    away[np.arange(alpha.size), np.arange(alpha.size)] = math.inf
    away[np.arange(alpha.size), np.arange(alpha.size) + alpha.size] = math.inf
    room: Array = _ROOM * (away.min(axis=1) - alpha)
    return room


def strip_loads(scene: SolverState, centre: Array, alpha: Array) -> Array:
    """Parts of p̃_m carried by strips at given places, shape (k, l) like these."""
    carried: Array = 0.25 * alpha * _TrialStrips(scene, _LOAD_ORDER, centre, alpha).c[:, :, 0]
    return carried


def strips_at_places(scene: SolverState, n: int, contact: Contact) -> Contact:
    """Strips of order n at the places of those of `contact`."""
    return _TrialStrips(scene, n, contact.eps[None], contact.alpha[None]).contact


class _TrialStrips:
    """Strips at several trial places at once: coefficients and residuals.

    Shapes: k places, l strips, order n.
    """

    def __init__(self, scene: SolverState, n: int, centre: Array, alpha: Array) -> None:
        self.scene, self.n, self.centre, self.alpha = scene, n, centre, alpha
        rho = scene.problem.rho
        k, count = alpha.shape
        self.rule: Rule = scene.rule(float(alpha.max()))
        times = scene.creep.times
        apart, same = np.unique(alpha.ravel(), return_inverse=True)  # a step of X_l leaves the own blocks
        ik = ProductIK(n, apart[:, None] / times) if times.size else None
        own = assemble_matrix(self.rule, scene.creep, apart, n, ik)[same].reshape(k, count, n + 1, n)
        scene.matrices += apart.size
        slope = slope_expansion(alpha.ravel(), centre.ravel(), rho, n + 2)[..., 0]
        self.slope = slope.reshape(k, count, n + 2)
        full = np.zeros((k, count, n + 1, count, n))
        heights = np.zeros((k, count, count, n))
        if count > 1:
            full, heights = _coupling_blocks(scene, n, centre, alpha)
        strip = np.arange(count)
        full[:, strip, :, strip, :] = np.moveaxis(own, 1, 0)
        self.first = full[:, :, 0]
        rows = full[:, :, 1:].reshape(k, count * n, count * n)
        right = self.slope[:, :, 1 : n + 1].reshape(k, count * n, 1)
        self.c = np.asarray(np.linalg.solve(rows, right), dtype=np.float64).reshape(k, count, n)
        raised = mean_displacement(self.rule, scene.creep, apart, n, ik)[same].reshape(k, count, n)
        lifted = np.einsum("klv,klv->kl", raised, self.c)
        lifted += np.einsum("klrv,krv->kl", heights, self.c)
        drop = mean_drop(alpha.ravel(), centre.ravel(), rho, 2 * n + 16).reshape(k, count)
        self.depth = lifted + drop

    def residual(self) -> Array | None:
        """Residuals of row 0, height differences and load or depth, shape (k, 2l); None without load."""
        loads = 0.25 * self.alpha * self.c[:, :, 0]
        total = loads.sum(axis=1)
        if not (total > 0.0).all():
            return None
        row = np.einsum("klrv,krv->kl", self.first, self.c) - self.slope[:, :, 0]
        heights = np.diff(self.depth, axis=1)
        depth = self.scene.depth
        held = np.log(total / self.scene.problem.pressure) if depth is None else self.depth[:, 0] / depth - 1.0
        return np.concatenate([row, heights, held[:, None]], axis=1)

    def strips(self, jacobian: Array, left: float) -> Strips:
        """The first place as a contact."""
        return Strips(self.contact, float(self.depth[0].mean()), jacobian, left)

    @property
    def contact(self) -> Contact:
        """The strips at the first place."""
        return contact_from_coefficients(
            self.c[0], self.slope[0], (self.alpha[0], self.centre[0]), self.scene.problem.rho
        )


def _gap_window(
    scene: SolverState, gap: float, span: float, panels: Panels = SOLVE_PANELS
) -> tuple[Array, ComplexArray]:
    """Wave numbers and χ S/m of the strips' window."""
    width = panels.window * _ALIAS / min(gap, math.pi)
    m, weights = series_rule(scene.problem.layer, scene.creep, span=span, end=2.0 * _RAMP * width, panels=panels)
    return m, 0.5 * special.erfc((m - _RAMP * width) / width) * weights


def _coupling_blocks(scene: SolverState, n: int, centre: Array, alpha: Array) -> tuple[Array, Array]:
    """Slopes and heights of strip l per coefficient of strip r ≠ l; shapes (k, l, n+1, l, n) and (k, l, l, n)."""
    k, count = alpha.shape
    gap = min(smallest_gap(centre[i], alpha[i]) for i in range(k))
    m, weights = _gap_window(scene, gap, max(_outer_span(centre[i], alpha[i]) for i in range(k)))
    apart, same = np.unique(alpha.ravel(), return_inverse=True)
    real, imaginary, _ = sign_factors(n)
    v = np.arange(1.0, n + 1.0)
    turn = v * (1j) ** ((1 - np.arange(1, n + 1)) % 4)
    slopes, heights = np.zeros((k, count, n + 1, count, n)), np.zeros((k, count, count, n))
    step = max(64, _CHUNK // (k * count * (n + 1)))
    for start in range(0, m.size, step):
        part, weight = m[start : start + step], weights[start : start + step]
        table = np.moveaxis(bessel_j(n, np.multiply.outer(apart, part)), 0, 1)[same].reshape(k, count, n + 1, -1)
        for one, other in permutations(range(count), 2):
            wave = weight * np.exp(1j * np.multiply.outer(centre[:, one] - centre[:, other], part))
            across = table[:, other, 1:].swapaxes(1, 2)
            for side, factor, height in ((wave.real, real, turn.real), (wave.imag, imaginary, -turn.imag)):
                rows = table[:, one] * side[:, None]
                slopes[:, one, :, other] += factor * (rows @ across)
                heights[:, one, other] += height * ((rows[:, :1] / part) @ across)[:, 0]
    return slopes, heights


def friction_by_loss(scene: SolverState, strips: Strips) -> float:
    """μ from the loss compliance, with its own rule and window."""
    contact = strips.contact
    rule = build_rule(scene.problem.layer, scene.creep, float(contact.alpha.max()), CHECK_PANELS)
    total = float(energy_loss(rule, scene.creep, contact).sum())
    if contact.alpha.size > 1:
        m, weights = _gap_window(
            scene,
            smallest_gap(contact.eps, contact.alpha),
            _outer_span(contact.eps, contact.alpha),
            CHECK_PANELS,
        )
        n = strips.order
        v = np.arange(1, n + 1)
        table = bessel_j(n, np.multiply.outer(contact.alpha, m))[1:]
        amplitude = np.einsum("lv,vlm->lm", 0.5 * v * contact.c * (-1j) ** ((v - 1) % 4), table) / m
        wave = amplitude * np.exp(-1j * np.multiply.outer(contact.eps, m))
        together = np.abs(wave.sum(axis=0)) ** 2 - np.sum(np.abs(wave) ** 2, axis=0)
        total += float(np.sum(weights.imag * m * together))
    return 2.0 * scene.problem.rho * total / strips.pressure
