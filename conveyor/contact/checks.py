"""What a contact must pass before it is an answer: order, energy, pressure inside, gap outside."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.energy import friction_by_loss
from conveyor.contact.quadrature import CHECK, build_rule
from conveyor.contact.scene import Scene, State
from conveyor.contact.solution import surface_series
from conveyor.contact.spectral import Contact, equilibrium

Array = NDArray[np.float64]

_GAP_TOLERANCE = 1e-4  # of the depth; truncation of the series is 1e-7


def order_error(state: State, rho: float, exponent: float | None) -> float:
    """Relative error of friction by order, from the nested matrices of order n/2 and 3n/4 at the same half width.

    At one half width a lower order differs in friction and in load; at one load friction differs by
    δ = |δμ/μ - β δp/p| with β = d ln μ/d ln p (`exponent`), the two shifts added where β is not known. From δ(n/2)
    and δ(3n/4) the error at n is δ(3n/4)²/δ(n/2) for geometric convergence; four times that covers n^-3, and δ(3n/4)
    is the most.
    """
    contact, n = state.contact, state.order
    change = []
    for lower in (n // 2, (3 * n) // 4):
        sub = equilibrium(state.matrix[:, : lower + 1, :lower], contact.alpha, rho, contact.eps)
        if not sub.inside[0]:
            return 1.0
        friction = relative_difference(float(sub.friction[0]), float(contact.friction[0]))
        load = float(sub.pressure[0] / contact.pressure[0]) - 1.0
        if exponent is None:
            change.append(abs(friction) + abs(load))
        else:
            change.append(abs(friction - exponent * load))
    half, most = change
    return most if half <= most else min(most, 4.0 * most * most / half)


def relative_difference(value: float, reference: float) -> float:
    """value/reference - 1; zero where both are zero (an elastic layer has no friction at any order)."""
    if value == reference:
        return 0.0
    return (value - reference) / abs(reference) if reference != 0.0 else 1.0


def energy_error(scene: Scene, contact: Contact) -> float:
    """Relative difference of friction by geometry and by loss compliance, with a rule of its own."""
    rule = build_rule(scene.problem.layer, scene.creep, float(contact.alpha[0]), CHECK)
    by_loss = friction_by_loss(rule, scene.creep, contact, scene.problem.rho)
    return abs(relative_difference(float(by_loss[0]), float(contact.friction[0])))


@lru_cache(maxsize=16)
def _sines(n: int) -> Array:
    """sin(vθ) at 4n + 1 inner angles, shape (4n+1, n)."""
    angle = np.arange(1, 4 * n + 2) * (np.pi / (4 * n + 2))
    return np.sin(np.multiply.outer(angle, np.arange(1, n + 1)))


def splits(contact: Contact, error: float) -> bool:
    """Whether the single-patch pressure turns negative by more than the order's own ripple."""
    p = _sines(contact.c.shape[1]) @ contact.c[0]
    ripple = max(float(np.max(np.abs(contact.c[0, -2:]))) / float(p.max()), error, 1e-12)
    return bool(p.min() < -10.0 * ripple * p.max())


def overlaps(scene: Scene, contact: Contact, depth: float) -> bool:
    """Whether the layer's surface lies inside the roll outside the contact (a wrong root under strong wrap)."""
    rho = scene.problem.rho
    edge = np.array([-1.0, 1.0]) * contact.alpha[0]
    reach = np.array([-rho - contact.eps[0], rho - contact.eps[0]])
    place = np.linspace(0.02, 1.0, 50)
    x = np.concatenate([edge[k] + place * (reach[k] - edge[k]) for k in (0, 1)])
    roll = depth - 1.0 + np.sqrt(np.maximum(1.0 - ((x + contact.eps[0]) / rho) ** 2, 0.0))
    gap = surface_series(scene.problem, scene.creep, contact, x) - roll
    return bool(gap.min() < -_GAP_TOLERANCE * abs(depth))
