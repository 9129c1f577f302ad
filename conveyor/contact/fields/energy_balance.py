"""Friction from the loss compliance by the first law, independent of the solve.

τ̃_m = 2ρ Σ_{m≥1} Im S_m |p̃̂_m|², p̃̂_m = ½ Σ_v v c_v (-i)^{v-1} J_v(mα)/m. The sum uses its own window, its own Gauss
panels and the same closed half-space products, so that an error of window, quadrature, order or eccentricity shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.galerkin.bessel import ProductIK, bessel_j, nonzero_orders
from conveyor.contact.galerkin.quadrature import Rule, series_rule
from conveyor.contact.galerkin.short_rule import ShortRule
from conveyor.contact.galerkin.spectral import Contact
from conveyor.contact.layers.belt_layer import BeltSupport
from conveyor.contact.layers.creep import CreepBatch, CreepSpectrum
from conveyor.contact.layers.layer_models import Creep

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def friction_by_loss(
    rule: Rule | ShortRule,
    creep: CreepSpectrum | CreepBatch,
    contact: Contact,
    rho: Array | float,
) -> Array:
    """μ = τ̃_m/p̃_m from the loss compliance, shape (b,)."""
    friction: Array = 2.0 * rho * energy_loss(rule, creep, contact) / contact.pressure
    return friction


Strip = tuple[float, float, Array]
"""Centre and half width, lengths X, and coefficients of a strip of a contact."""


def pressure_spectrum(m: Array, strips: Sequence[Strip]) -> ComplexArray:
    """p̃̂_m of all strips of a contact, shape of m."""
    out = np.zeros(m.size, dtype=complex)
    for centre, alpha, c in strips:
        v = np.arange(1, nonzero_orders(m * alpha, c.size) + 1)
        amplitude = 0.5 * v * c[: v.size] * (-1j) ** ((v - 1) % 4)
        out += np.exp(-1j * m * centre) * (amplitude @ bessel_j(v.size, m * alpha)[1:]) / m
    return out


def contact_width(strips: Sequence[Strip]) -> float:
    """Distance X of the outer edges."""
    return max(x + alpha for x, alpha, _ in strips) - min(x - alpha for x, alpha, _ in strips)


@dataclass(frozen=True)
class _BeltLosses:
    """Losses of a belt's top cover and carcass as real and imaginary part of a symbol."""

    belt: BeltSupport

    @property
    def reach(self) -> float:
        return self.belt.reach

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        top, carcass = self.belt.losses(m, creep)
        return top + 1j * carcass


def belt_losses(belt: BeltSupport, creep: CreepSpectrum, strips: Sequence[Strip]) -> tuple[float, float]:
    """Shares of Σ_{m≥1} Im S_m |p̃̂_m|² lost in a belt's top cover and in its carcass."""
    m, weights = series_rule(_BeltLosses(belt), creep, span=contact_width(strips), end=belt.reach)
    lost = complex(np.sum(weights * m * np.abs(pressure_spectrum(m, strips)) ** 2))
    return lost.real, lost.imag


def energy_loss(rule: Rule | ShortRule, creep: CreepSpectrum | CreepBatch, contact: Contact) -> Array:
    """Σ_{m≥1} Im S_m |p̃̂_m|², shape (b,).

    Half-space part of one retardation term: ∫ Im j |p̃̂|² dm with
    ζ ∫ J_v J_u/(m (1+m²ζ²)) dm = ζ (-1)^{(v-u)/2} [δ_vu/(2v) - I_max K_min].
    """
    n = contact.c.shape[1]
    v = np.arange(1, n + 1)
    weighted = v * contact.c
    place = contact.alpha[:, None] * rule.nodes
    shown = nonzero_orders(place, n)
    table = bessel_j(shown, place)[1:]
    phase = (-1j) ** ((v - 1) % 4)
    spectrum = 0.5 * ((weighted * phase)[:, None, :shown] @ table.swapaxes(0, 1))[:, 0] / rule.nodes
    power = spectrum.real**2 + spectrum.imag**2
    total: Array = np.sum(power * (rule.weights.imag * rule.nodes), axis=1)
    if creep.weights.size:
        ik = ProductIK(n, contact.alpha[:, None] / creep.times)
        total += 0.25 * ik.quadratic(creep.weights * creep.times, weighted)
    return total
