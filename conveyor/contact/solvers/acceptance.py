"""Acceptance checks of a contact: order, energy, pressure inside, gap outside."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.contact_fields import SpectralFields
from conveyor.contact.fields.energy_balance import friction_by_loss
from conveyor.contact.galerkin.galerkin_tables import GalerkinTables
from conveyor.contact.galerkin.pressure import EDGE_WAVE_FACTOR, sample_sine_sum
from conveyor.contact.galerkin.quadrature import CHECK_PANELS, build_rule
from conveyor.contact.galerkin.short_rule import ShortRule
from conveyor.contact.galerkin.spectral import Contact
from conveyor.contact.layers.creep import CreepBatch, CreepSpectrum
from conveyor.contact.solvers.solver_state import SolverState

Array = NDArray[np.float64]

ENERGY_OVER_ERROR = 10.0  # energy error over true error of friction while n is too small: 5 to 80 seen
ENERGY_MARGIN = 2.0  # times the energy's error, which is that of two frictions: true errors were up to 1.4 of it
_LAYER_OVER_ENERGY = 1.2  # true error over that of the energy, as `edge_layer_error` says: up to 1.1 seen
LEAST_ENERGY_POWER = (
    2.0  # least power of the order that the energy's error falls with where no layer is left unresolved
)
ORDER_BOUND = 2.3  # 1/(1 - (3/4)²): of an error that grows like n²
_LASTING_SAMPLES = 16  # samples: a ripple of the highest order changes sign after four
_RIPPLE_TAILS = 4.0  # an unresolved edge layer dips below zero by up to 2.1 tails, a resolved split by more than 20
_EDGE_SAMPLES = 12  # from an edge, three half waves of the highest order: undershoots end at 3 to 11, splits lie inside
_RIPPLE_ORDER = 96  # from which on a dip inside within the ripple is one: splits of friction less than rtol show before
_BETWEEN_SAMPLES = (
    0.05  # of the largest pressure: it falls by less than 0.02 between 8n samples (Bernstein's inequality)
)
_DIP_ROUNDING = 1e-12  # of the largest pressure
WRAP_EXTENT = 0.5  # (a + |e|)/R beyond which a second eccentricity and a gap outside are looked for
_GAP_TOLERANCE = 1e-4  # of the depth
_GAP_REACH = 100.0  # m α of the series: (m α)^(-5/2) = 1e-5 of the depth
_GAP_PLACES = np.arange(1.0, 25.0) / 25.0


class OrderErrors(NamedTuple):
    """Errors due to the order, shape (b,) each: friction, relative; its upper bound; places X of the edges."""

    friction: Array
    most: Array
    edges: Array


def order_errors(contact: Contact, lower: Contact, exponent: Array | None) -> OrderErrors:
    """Errors of friction and edges due to the order, from contacts of order n/2 and 3n/4 of the same half width.

    At one half width a lower order differs in friction and in load; at one load friction differs by
    δ = |δμ/μ - β δp/p| with β = d ln μ/d ln p (`exponent`), the two shifts added where β is not known. From δ(n/2)
    and δ(3n/4) the error at n is δ(3n/4)²/δ(n/2) for geometric convergence; four times that covers n^-3, and δ(3n/4)
    is the most. 2.3 times that bounds it down to n^-1.25, and where an unresolved edge layer makes it grow like n².
    Edges shift with ε and with the half width that another load takes, |δp/p| of it at most; they converge more
    slowly, so twice their shift from 3n/4 is taken.

    Parameters
    ----------
    contact : Contact
        Contacts of the full order, batch of b.
    lower : Contact
        Those of half and of three quarters of the order, shapes (2, b).
    exponent : ndarray, shape (b,), or None
        β.

    Returns
    -------
    OrderErrors
        Friction off by all of itself, edges by α, where a lower order has no contact on the roll.
    """
    friction = relative_difference(lower.friction, contact.friction)
    load = lower.pressure / contact.pressure - 1.0
    shift = np.abs(friction) + np.abs(load) if exponent is None else np.abs(friction - exponent * load)
    half, most = np.where(lower.inside, shift, 1.0)
    moved = (contact.alpha + np.abs(contact.eps)) * np.abs(load[1]) + np.abs(lower.eps[1] - contact.eps)
    left: Array = np.where(half <= most, most, np.minimum(most, 4.0 * most * most / np.where(half > 0.0, half, 1.0)))
    return OrderErrors(left, ORDER_BOUND * most, 2.0 * np.where(lower.inside[1], moved, contact.alpha))


def error_from_energy(energy: Array, most: Array) -> Array:
    """Error of friction from the energy error: at least a tenth of it, at most twice it or the bound by order."""
    error: Array = np.maximum(energy / ENERGY_OVER_ERROR, np.minimum(ENERGY_MARGIN * energy, most))
    return error


def edge_layer_error(energy: Array, creep: CreepBatch | CreepSpectrum, alpha: Array, n: int) -> Array:
    """Error of friction from the energy error where order n does not resolve an edge layer, shape (b,).

    t is the loss tangent of the rubber at the shortest length that the order resolves at an edge. Where rubber flows
    there (t > 1) and its glassy layer lies deeper, orders agree with one another, and friction is off by up to 1.1 t of
    the energy's error; by up to 1.1 t³ of it below t = 1 (5,120 contacts of orders 16 to 192 with one to three times,
    E∞/E0 2 to 10,000). Rubber of many times has this tangent at every length: the error is less than a third of that
    of the energy, which then falls with `LEAST_ENERGY_POWER` or a higher power of the order.
    """
    j = creep.compliance(EDGE_WAVE_FACTOR * n**2 / alpha[:, None])[:, 0]
    tangent = j.imag / j.real
    error: Array = _LAYER_OVER_ENERGY * tangent * np.minimum(tangent, 1.0) ** 2 * energy
    return error


def energy_errors(
    tabled: GalerkinTables,
    rule: ShortRule,
    orders: tuple[Contact, Contact],
    rho: Array,
    *,
    most: Array,
    rtol: float,
) -> tuple[Array, Array]:
    """Relative differences of friction by geometry and by loss compliance, and the errors of friction that follow.

    Parameters
    ----------
    tabled : GalerkinTables
        The contacts' creep and half widths, batch of b.
    rule : ShortRule
        Quadrature of the loss, other than that of the solve.
    orders : Contact, Contact
        The contacts, and those of half and of three quarters of their order, shapes (2, b).
    rho : ndarray, shape (b,)
        k R [-].
    most : ndarray, shape (b,)
        Upper bound of the error by order, from `order_errors`.
    rtol : float
        Tolerance of friction [-]; edge layers are checked, by the energy at half the order, only where it decides.

    Returns
    -------
    ndarray, ndarray, shapes (b,)
        Error of the energy; error of friction that follows.
    """
    contact, lower = orders
    energy = _energy_mismatch(tabled, rule, contact, rho)
    error = error_from_energy(energy, most)
    n = int(contact.c.shape[1])
    layer = edge_layer_error(energy, tabled.creeps, tabled.alpha, n)
    doubted = np.flatnonzero((layer > rtol) & (error <= rtol))
    if doubted.size:
        half = Contact(
            lower.alpha[doubted],
            lower.eps[0, doubted],
            lower.c[0, doubted, : n // 2],
            lower.pressure[0, doubted],
            lower.friction[0, doubted],
            lower.inside[0, doubted],
        )
        before = _energy_mismatch(tabled[doubted], rule[doubted], half, rho[doubted])
        falls = half.inside & (energy[doubted] * 2.0**LEAST_ENERGY_POWER <= before)
        layer[doubted[falls]] = 0.0
    return energy, np.maximum(error, layer)


def _energy_mismatch(tabled: GalerkinTables, rule: ShortRule, contact: Contact, rho: Array) -> Array:
    error: Array = np.abs(relative_difference(tabled.friction_by_loss(rule, contact, rho), contact.friction))
    return error


def relative_difference(value: Array, reference: Array) -> Array:
    """value/reference - 1; zero where both are zero (an elastic layer has no friction at any order)."""
    scale = np.where(reference != 0.0, np.abs(reference), 1.0)
    difference: Array = (value - reference) / scale
    return difference


def energy_error(scene: SolverState, contact: Contact, beyond: float) -> Array:
    """Relative difference of friction by geometry and by loss compliance, shape (b,); the loss has its own quadrature.

    `beyond` is the loss of the orders above those of `contact`, as in `energy.loss`.
    """
    rule = build_rule(scene.problem.layer, scene.creep, float(contact.alpha.max()), CHECK_PANELS)
    rho = scene.problem.rho
    by_loss = friction_by_loss(rule, scene.creep, contact, rho) + 2.0 * rho * beyond / contact.pressure
    error: Array = np.abs(relative_difference(by_loss, contact.friction))
    return error


class PressureSign(Enum):
    """Sign of the sampled pressure of a single strip."""

    PRESSING = "not negative, or by less than the tolerance"
    PULLING = "negative by more than the order's ripple: the contact splits"
    UNDECIDED = "negative by no more than the ripple: a higher order decides"


def worst_sign(contact: Contact, rtol: float) -> tuple[PressureSign, float]:
    """Worst sign of a batch's pressure, and the largest share of a load that tension carries [-]."""
    pulling, pressing, tension = pressure_signs(contact, rtol)
    sign = PressureSign.PULLING if pulling.any() else PressureSign.UNDECIDED
    return PressureSign.PRESSING if pressing.all() else sign, float(tension.max())


def interior_dip(contact: Contact) -> tuple[float, float]:
    """Depth over the largest pressure and width X of the widest place inside a strip where its pressure is negative."""
    n = contact.c.shape[1]
    fine = sample_sine_sum(contact.c, 8 * n + 4)
    inside = np.maximum(-fine[:, 1 + 2 * _EDGE_SAMPLES : -1 - 2 * _EDGE_SAMPLES], 0.0)
    widest = float((_longest_run(inside > 0.0) * contact.alpha).max()) * np.pi / (8 * n + 4)
    return float((inside.max(axis=1) / fine.max(axis=1)).max()), widest


class PressureSigns(NamedTuple):
    """Masks of PULLING and of PRESSING contacts; share of the load that tension carries, zero where undecided [-]."""

    pulling: NDArray[np.bool_]
    pressing: NDArray[np.bool_]
    tension: Array


def pressure_signs(contact: Contact, rtol: Array | float) -> PressureSigns:
    """Sign of the sampled pressure of each contact, shape (b,).

    A contact presses where its tension carries no more than `rtol` of the load, friction may be off by as much, and
    lies at the edges, where an order that does not resolve an edge layer undershoots. Else it pulls if the tension
    exceeds the ripple of the order or lasts longer than a ripple: a thin plate that follows the roll lifts off by far
    less than the tails of its two high peaks.
    """
    n = contact.c.shape[1]
    fine = sample_sine_sum(contact.c, 8 * n + 4)[:, 1:-1]
    p = fine[:, 1::2]
    tension = np.maximum(-p, 0.0)
    step = np.pi / (4 * n + 2)
    pulled = step * (tension @ np.sin(step * np.arange(1, 4 * n + 2)))
    share = pulled / (0.5 * np.pi * contact.c[:, 0])
    highest = p.max(axis=1)
    middle = fine[:, 2 * _EDGE_SAMPLES : -2 * _EDGE_SAMPLES]
    inside = middle.min(axis=1) < _BETWEEN_SAMPLES * highest
    if inside.any():
        inside[inside] = _lowest_between(middle[inside]) < -_DIP_ROUNDING * highest[inside]
    slight = share <= rtol
    pressing = slight & ~inside
    if pressing.all():
        return PressureSigns(~pressing, pressing, share)
    tension[slight, :_EDGE_SAMPLES] = tension[slight, -_EDGE_SAMPLES:] = 0.0
    tail = np.abs(contact.c[:, -(n // 4) :]).sum(axis=1) / highest
    ripple = tension.max(axis=1) <= _RIPPLE_TAILS * tail * highest
    pulling = ~pressing & (~ripple | (_longest_run(tension > 0.0) >= _LASTING_SAMPLES))
    pressing |= slight & ~pulling & (n >= _RIPPLE_ORDER)
    return PressureSigns(pulling, pressing, np.where(pulling | pressing, share, 0.0))


def _lowest_between(p: Array) -> Array:
    """Lowest pressure of each row, by parabolas through three samples around each lowest one, shape (b,)."""
    before, here, after = p[:, :-2], p[:, 1:-1], p[:, 2:]
    bend = before - 2.0 * here + after
    low = (here <= before) & (here <= after) & (bend > 0.0)
    lowest: Array = (here - np.where(low, (after - before) ** 2 / (8.0 * np.where(low, bend, 1.0)), 0.0)).min(axis=1)
    return lowest


def _longest_run(flags: NDArray[np.bool_]) -> NDArray[np.int_]:
    """Longest run of true values in each row, shape (b,)."""
    place = np.arange(1, flags.shape[1] + 1)
    last_false = np.maximum.accumulate(np.where(flags, 0, place), axis=1)
    return np.asarray((np.where(flags, place - last_false, 0)).max(axis=1))


def may_touch_elsewhere(contact: Contact, rho: Array | float) -> NDArray[np.bool_]:
    """True where the gap outside a strip must be checked, shape (b,): far round the roll, or off its crown.

    Next to a strip that covers the crown and ends within half the radius the roll falls away from the layer. With a
    strip beyond the crown a thin free layer may touch there again (R/λ 0.4, kh 0.3, ζ 3, p̃_m 0.0012).
    """
    beside = np.abs(contact.eps) > contact.alpha
    return np.asarray(beside | (contact.alpha + np.abs(contact.eps) > WRAP_EXTENT * rho))


def overlaps_roll(scene: SolverState, contact: Contact, depth: float | None = None) -> bool:
    """True where the layer's surface enters the roll outside the strips; one strip an entry of `contact`.

    Checked between strips, and out to the ends of the roll's half circle. An unknown Δ/R is taken from the surface half
    way to the first strip's edge, to a tenth of the tolerance.
    """
    rho = scene.problem.rho
    rank = np.argsort(contact.eps)
    low, high = (contact.eps - contact.alpha)[rank], (contact.eps + contact.alpha)[rank]
    starts, ends = np.append(-rho, high), np.append(low, rho)
    inside = contact.eps[0] + 0.5 * contact.alpha[0]
    x = np.append((starts[:, None] + _GAP_PLACES * (ends - starts)[:, None]).ravel(), inside)
    roll = np.sqrt(np.maximum(1.0 - (x / rho) ** 2, 0.0)) - 1.0
    gap = SpectralFields(scene.problem.layer, scene.creep, contact, rho).outside(x, _GAP_REACH) - roll
    depth = float(gap[-1]) if depth is None else depth
    return bool(gap[:-1].min() < depth - _GAP_TOLERANCE * abs(depth))
