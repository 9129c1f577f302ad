"""The Bessel-Galerkin method: one contact of given half width.

p̃(X) = sqrt(1-s²) Σ_{v=1..n} c_v U_{v-1}(s), X = α s, vanishes at both edges, so both stress intensity factors are
zero. Its slope in Chebyshev coefficients g_i of T_i, i = 0 … n, is the matrix

    g_i = (2-δ_i0) Σ_v v c_v Σ_{m≥1} Re[i^{q+2} S_m] J_v(mα) J_i(mα)/m,   q = i - v.

Rows 1 … n give c, row 0 the eccentricity. The isolated half-space's share is closed (bessel.ProductIK), the rest is
the short sum of quadrature.py: a weighted Gram product of one Bessel table. Everything is batched over half widths.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.galerkin.bessel import ProductIK, bessel_j, nonzero_orders
from conveyor.contact.galerkin.quadrature import Rule
from conveyor.contact.galerkin.roll_profile import mean_drop, slope_expansion, solve_eccentricity
from conveyor.contact.galerkin.short_rule import ShortRule
from conveyor.contact.layers.creep import CreepBatch, CreepSpectrum

Array = NDArray[np.float64]

_ECCENTRICITY_RTOL = 1e-14  # relative, of the eccentricity
_NEAR_EXTENT = 0.95  # (a + |e|)/R up to which one or two steps suffice
_BALANCE_STEPS = 2


@dataclass(frozen=True, eq=False)
class Contact:
    """Contacts of given half widths in equilibrium; arrays over the batch, shape (b,), c of shape (b, n).

    `inside` is false where no eccentricity keeps both edges on the roll; other entries are then meaningless.
    """

    alpha: Array
    eps: Array
    c: Array
    pressure: Array
    friction: Array
    inside: NDArray[np.bool_]


def select_contacts(contact: Contact, at: NDArray[np.int_] | slice) -> Contact:
    """Selected contacts of a batch, of one order or of several."""
    return Contact(
        contact.alpha[at],
        contact.eps[..., at],
        contact.c[..., at, :],
        contact.pressure[..., at],
        contact.friction[..., at],
        contact.inside[..., at],
    )


@lru_cache(maxsize=32)
def sign_factors(n: int) -> tuple[Array, Array, Array]:
    """Factors of Re S and Im S in the matrix, and of the retardation products, shape (n+1, n)."""
    i, v = np.arange(n + 1.0)[:, None], np.arange(1.0, n + 1.0)[None, :]
    q = i - v
    factor = np.where(i == 0, 1.0, 2.0) * v
    real = np.where(q % 2 == 0, -((-1.0) ** (q // 2)), 0.0) * factor
    imaginary = np.where(q % 2 == 1, -((-1.0) ** ((q + 1) // 2)), 0.0) * factor
    retarded = np.where((i < v) & (q % 2 == 1), -1.0, 1.0) * factor
    return real, imaginary, retarded


def assemble_matrix(
    rule: Rule | ShortRule,
    creep: CreepSpectrum | CreepBatch,
    alpha: Array,
    n: int,
    ik: ProductIK | None = None,
) -> Array:
    """Galerkin matrix, rows T_0 … T_n, columns c_1 … c_n, shape (b, n+1, n).

    Matrices are nested: that of a lower order is a leading block.

    Parameters
    ----------
    rule : Rule or ShortRule
        Nodes valid for the largest of `alpha`; one rule for all, or one for each.
    creep : CreepSpectrum or CreepBatch
        Every ζ_t positive; one for all, or one for each.
    alpha : ndarray, shape (b,)
        Half widths k a [-].
    n : int
        Order, at least 2.
    ik : ProductIK, optional
        Bessel products of these half widths, if known.
    """
    real, imaginary, retarded = sign_factors(n)
    place = alpha[:, None] * rule.nodes
    shown = nonzero_orders(place, n)
    table = bessel_j(shown, place).swapaxes(0, 1)
    even, odd = table[:, 0::2], table[:, 1::2]
    dense, lossy = rule.weights.real[..., None, :], rule.weights.imag[..., None, :]
    gram = np.zeros((alpha.size, n + 1, n + 1))  # i - v even: Re S, odd: Im S
    at_even, at_odd = slice(0, shown + 1, 2), slice(1, shown + 1, 2)
    gram[:, at_even, at_even] = (even * dense) @ even.swapaxes(1, 2)
    gram[:, at_odd, at_odd] = (odd * dense) @ odd.swapaxes(1, 2)
    gram[:, at_even, at_odd] = (even * lossy) @ odd.swapaxes(1, 2)
    gram[:, at_odd, at_even] = gram[:, at_even, at_odd].swapaxes(1, 2)
    matrix: Array = (real + imaginary) * gram[:, :, 1:]
    index = np.arange(n)
    half_space = np.zeros((alpha.size, n))
    half_space -= np.asarray(creep.instantaneous)[..., None]
    if creep.weights.size:
        ik = ProductIK(n, alpha[:, None] / creep.times) if ik is None else ik
        products, deficit = ik.weighted_sums(creep.weights)
        matrix += products[:, :, 1:] * retarded
        # -j0 + 2v Σ d I K = -(j∞ + Σ d (1 - 2v I K)) keeps a small j∞
        half_space -= 2.0 * (index + 1) * deficit[:, 1:]
    matrix[:, index + 1, index] += half_space
    return matrix


def solve_equilibrium(
    matrix: Array,
    alpha: Array,
    rho: Array | float,
    eps: Array | None = None,
    tolerance: float = _ECCENTRICITY_RTOL,
) -> Contact:
    """Pressure and eccentricity of contacts of given half width.

    Parameters
    ----------
    matrix : ndarray, shape (b, n+1, n)
        From `assemble_matrix`, or a leading block of it.
    alpha : ndarray, shape (b,)
        Half widths [-].
    rho : float or ndarray, shape (b,)
        k R [-].
    eps : ndarray, shape (b,), optional
        Start value of the eccentricity; default that of a parabola.
    tolerance : float
        Relative error of the eccentricity allowed [-].

    Returns
    -------
    Contact
        With friction μ = -(1/λ)∫ p u' dx / p_m (paper, section 3) from the coefficients of pressure and slope.
    """
    found = _balance_contacts(_solve_whole, matrix, (alpha, eps), rho, tolerance)
    return _select_order(found, 0, found.inside)


def solve_nested_equilibrium(
    matrix: Array, alpha: Array, rho: Array | float, eps: Array | None, tolerance: float
) -> tuple[Contact, Contact]:
    """`solve_equilibrium` with the contacts of half and of three quarters of the order, these as one of shape (2, b).

    The lower orders are exact to second order in the shift of their eccentricity.
    """
    found = _balance_contacts(_solve_nested, matrix, (alpha, eps), rho, tolerance)
    lower = slice(1, None)
    on_roll = (found.alpha + np.abs(found.eps[lower]) < rho) & (found.pressure[lower] > 0.0)
    return _select_order(found, 0, found.inside), _select_order(found, lower, on_roll)


def _select_order(found: Contact, at: int | slice, inside: NDArray[np.bool_]) -> Contact:
    """Contacts of the selected orders of the solver."""
    return Contact(found.alpha, found.eps[at], found.c[at], found.pressure[at], found.friction[at], inside)


LinearSolver = Callable[[Array, Array], Array]
"""Solutions x of rows (b, n, n) for right sides (b, n, r), shape (k, b, n, r): full order, then lower ones."""


def _solve_whole(rows: Array, right: Array) -> Array:
    return np.asarray(np.linalg.solve(rows, right), dtype=np.float64)[None]


def _solve_nested(rows: Array, right: Array) -> Array:
    """Solutions at the full, half and three quarters of the order by one elimination, in blocks n/2, n/4 and n/4."""
    n = rows.shape[2]
    half, most = n // 2, (3 * n) // 4
    middle, rest = most - half, n - most
    both = np.concatenate([rows, right], axis=2)
    first = np.linalg.solve(both[:, :half, :half], both[:, :half, half:])
    below = both[:, half:, half:] - both[:, half:, :half] @ first
    second = np.linalg.solve(below[:, :middle, :middle], below[:, :middle, middle:])
    last = below[:, middle:, middle:] - below[:, middle:, :middle] @ second
    x = np.zeros((3, *right.shape))
    x[1, :, :half] = first[..., n - half :]
    x[2, :, half:most] = second[..., rest:]
    x[2, :, :half] = x[1, :, :half] - first[..., :middle] @ x[2, :, half:most]
    x[0, :, most:] = np.linalg.solve(last[..., :rest], last[..., rest:])
    x[0, :, half:most] = x[2, :, half:most] - second[..., :rest] @ x[0, :, most:]
    x[0, :, :half] = x[1, :, :half] - first[..., : n - half] @ x[0, :, half:]
    return x


def _balance_contacts(
    solver: LinearSolver,
    matrix: Array,
    place: tuple[Array, Array | None],
    rho: Array | float,
    tolerance: float,
) -> Contact:
    """Equilibrium of the k orders that the solver returns: eps, c, pressure and friction have k rows of b."""
    alpha, eps = place
    radius = np.zeros(alpha.shape) + rho
    if eps is None:
        unit = np.zeros((matrix.shape[2], 1))
        unit[0] = 1.0
        eps = alpha * (matrix[:, :1] @ np.linalg.solve(matrix[:, 1:], unit))[:, 0, 0]
    for _ in range(_BALANCE_STEPS):
        reach = (alpha + np.abs(eps)) / radius
        near = reach < _NEAR_EXTENT
        inner, start = alpha, eps
        if not near.all():
            inner, start = np.where(near, alpha, 0.5 * radius), np.where(near, eps, 0.0)
        slope, c, step = _balance_step(solver, matrix, inner, start, radius)
        here = start + step[0]
        # what the parabola in the step leaves: (d³h/dt³)/6 (step/ρ)³, h = t/sqrt(1-t²)
        square = reach * reach
        left = (step[0] / radius) ** 2 * np.abs(step[0]) * (0.5 + 2.0 * square)
        settled = near & (left <= tolerance * (1.0 - square) ** 2 * np.abs(here))
        if settled.all() or (settled | ~near).all():
            break
        eps = np.where(np.abs(step[0]) < 0.5 * (radius - inner), here, eps)
    found, inside = start + step, settled
    if not settled.all():
        rows = np.flatnonzero(~settled)
        start, inside[rows] = _far_eccentricity(matrix[rows], alpha[rows], radius[rows], eps[rows])
        inner = np.where(inside, alpha, 0.5 * radius)
        slope[:, rows], c[:, rows], step = _balance_step(solver, matrix[rows], inner[rows], start, radius[rows])
        found[:, rows] = start + step
    load, friction = _load_and_friction(c, slope, inner, radius)
    return Contact(inner, found, c, load, friction, inside)


def _balance_step(
    solver: LinearSolver, matrix: Array, alpha: Array, eps: Array, radius: Array
) -> tuple[Array, Array, Array]:
    """Slope and pressure coefficients and the step of ε that satisfy every row, to second order in the step."""
    n = matrix.shape[2]
    slopes = slope_expansion(alpha, eps, radius, n + 2)
    answers = solver(matrix[:, 1:], slopes[:, 1 : n + 1])
    off = (matrix[:, :1] @ answers)[..., 0, :] - slopes[:, 0]
    rise = off[..., 1]
    straight, bend = -off[..., 0] / rise, -0.5 * off[..., 2] / rise
    step = straight + bend * (straight + bend * straight * straight) ** 2
    powers = np.empty((*step.shape, 3, 1))
    powers[..., 0, 0], powers[..., 1, 0], powers[..., 2, 0] = 1.0, step, 0.5 * step * step
    return (slopes @ powers)[..., 0], (answers @ powers)[..., 0], step


def _far_eccentricity(matrix: Array, alpha: Array, radius: Array, eps: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Eccentricities by Newton where two steps do not converge; zero where there is none."""
    row = np.linalg.solve(matrix[:, 1:].swapaxes(1, 2), matrix[:, 0, :, None])[..., 0]
    eps, inside = solve_eccentricity(np.asarray(row, dtype=np.float64), alpha, radius, eps)
    return np.where(inside, eps, 0.0), inside


def nested_matrices(matrix: Array) -> tuple[Array, Array]:
    """Matrices of half and of three quarters of the order, leading blocks of the full one."""
    n = matrix.shape[2]
    half, most = (matrix[:, : order + 1, :order] for order in (n // 2, (3 * n) // 4))
    return half, most


def lower_order_contacts(lower: tuple[Array, Array], contact: Contact, rho: Array | float) -> Contact:
    """Contacts of two lower orders, from matrices of shapes (b, l+1, l), at the half widths of a higher order.

    As in `solve_nested_equilibrium`, for matrices that need not be blocks of one another.
    """
    radius = np.zeros(contact.alpha.shape) + rho
    found = []
    for matrix in lower:
        slope, c, step = _balance_step(_solve_whole, matrix, contact.alpha, contact.eps, radius)
        found.append((contact.eps + step[0], *_load_and_friction(c[0], slope[0], contact.alpha, radius)))
    eps, pressure, friction = (np.stack(figures) for figures in zip(*found, strict=True))
    on_roll = (contact.alpha + np.abs(eps) < radius) & (pressure > 0.0)
    return Contact(contact.alpha, eps, contact.c, pressure, friction, on_roll)


def contact_from_coefficients(c: Array, slope: Array, place: tuple[Array, Array], rho: Array | float) -> Contact:
    """Contacts from coefficients c, shape (b, n), slopes T_0 … T_{n+1}, and place (α, ε)."""
    alpha, eps = place
    load, friction = _load_and_friction(c, slope, alpha, rho)
    return Contact(alpha, eps, c, load, friction, np.ones(alpha.size, dtype=bool))


def _load_and_friction(c: Array, slope: Array, alpha: Array, rho: Array | float) -> tuple[Array, Array]:
    """p̃_m and μ from coefficients c, shape (..., n), and slopes T_0 … T_{n+1}."""
    n = c.shape[-1]
    # ∫ sqrt(1-s²) U_{v-1} T_i ds = (π/4) [(1 + δ_{v1}) δ_{i,v-1} - δ_{i,v+1}]
    first = c[..., 0]
    work = (c * (slope[..., :n] - slope[..., 2 : n + 2])).sum(axis=-1) / first + slope[..., 0]
    return 0.25 * alpha * first, -0.5 * rho * work


def crown_depth(rule: Rule, creep: CreepSpectrum, contact: Contact, rho: float) -> Array:
    """Δ/R = 1 + W_0 - v_0: depth of the roll's crown below the mean line of the deformed surface, shape (b,)."""
    n = contact.c.shape[1]
    lifted = np.einsum("bv,bv->b", mean_displacement(rule, creep, contact.alpha, n), contact.c)
    depth: Array = lifted + mean_drop(contact.alpha, contact.eps, rho, 2 * n + 16)
    return depth


def mean_displacement(rule: Rule, creep: CreepSpectrum, alpha: Array, n: int, ik: ProductIK | None = None) -> Array:
    """T_0 coefficient W_0 of a contact's own displacement per coefficient c_1 … c_n, shape (b, n).

    W_0 = Σ_v v c_v Σ_m Re[(-i)^{v-1} S_m] J_v J_0/m². The half-space's part: elastic, by the logarithmic potential,
    ∫_δ^∞ J_1 J_0/x² dx = ½ (ln 2 - γ - ln δ); each retardation term from w_t - ζ w_t' = d w_el.
    """
    table = bessel_j(n, np.multiply.outer(alpha, rule.nodes)).swapaxes(0, 1)
    v = np.arange(1, n + 1)
    moments = (table[:, 1:] @ (table[:, 0] * (rule.weights / rule.nodes))[..., None])[..., 0]
    out: Array = v * np.real((-1j) ** ((v - 1) % 4) * moments)
    compliance = creep.instantaneous + float(creep.weights.sum())
    logarithm = np.log(2.0 / (rule.edge * alpha)) - np.euler_gamma + rule.edge_sum
    out[:, 0] += 0.5 * compliance * alpha * logarithm
    if creep.weights.size:
        ik = ProductIK(n, alpha[:, None] / creep.times) if ik is None else ik
        products, _ = ik.weighted_sums(creep.weights * creep.times)
        out += products[:, 0, 1:] * sign_factors(n)[2][0]
    return out
