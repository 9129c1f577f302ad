"""Pressure and surface of a solved contact at any place, computed on demand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.energy_balance import Strip
from conveyor.contact.galerkin.bessel import bessel_j, nonzero_orders
from conveyor.contact.galerkin.pressure import largest_pressure, series_tail, sine_sum, smoothed_coefficients
from conveyor.contact.galerkin.quadrature import build_rule, series_rule, window_end
from conveyor.contact.galerkin.spectral import Contact, crown_depth
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Layer
from conveyor.contact.problem import ContactProblem
from conveyor.contact.solvers.grid_solver import GridContact
from conveyor.contact.solvers.peak_error import FieldErrors, field_errors

Array = NDArray[np.float64]

SERIES_REACH = 600.0  # m α where the series outside ends: cut by (m α)^(-5/2) = 1e-7, at an edge (m α)^(-3/2)
_FAR_REACH = 64.0
_LONGEST_SERIES = 500.0  # wave numbers up to which the series is summed one by one: a window has as many nodes
_CHUNK = 4_000_000
RESOLVED_FROM: Final = 4.0
"""n² times an edge layer's share of the half width from which errors fall exponentially."""


class Fields(Protocol):
    """Pressure and surface of a contact; X about the roll's axis."""

    def pressure(self, x: Array) -> Array:
        """p̃ at X, zero outside the strips; shape of x."""

    def outside(self, x: Array) -> Array:
        """u/R about the mean line at X outside the strips, shape (p,)."""

    def peak(self) -> float:
        """Largest p̃."""

    def errors(self, problem: ContactProblem) -> FieldErrors:
        """Errors of the largest p̃ and of the edges under the problem's load, due to resolution."""

    def depth(self) -> float:
        """Δ/R."""


def edge_layer_share(creep: CreepSpectrum, alpha: float) -> float:
    """Width of the edge layer over the half width α; infinite for an elastic contact.

    j(m) is j∞ + Σ d/(m ζ) for large m: the two are equal at the layer's 1/m.
    """
    lasting = creep.times > 0.0
    if not lasting.any():
        return math.inf
    instantaneous = creep.instantaneous + float(creep.weights[~lasting].sum())
    retarded = float(np.sum(creep.weights[lasting] / creep.times[lasting]))
    return float(instantaneous / (alpha * retarded))


@dataclass(frozen=True, eq=False)
class SpectralFields:
    """Fields of one or more strips from their Chebyshev coefficients; `contact.eps` holds the strips' centres.

    `known_depth` is Δ/R where the solve has computed it.
    """

    layer: Layer
    creep: CreepSpectrum
    contact: Contact
    rho: float
    known_depth: float | None = None

    @property
    def strips(self) -> list[Strip]:
        """Centre, half width and coefficients of every strip."""
        contact = self.contact
        return list(zip(contact.eps.tolist(), contact.alpha.tolist(), contact.c, strict=True))

    def depth(self) -> float:
        """Δ/R, computed unless known."""
        if self.known_depth is not None:
            return self.known_depth
        rule = build_rule(self.layer, self.creep, float(self.contact.alpha[0]))
        return float(crown_depth(rule, self.creep, self.contact, self.rho)[0])

    def pressure(self, x: Array) -> Array:
        """Sum over the strips of p̃ = Σ c_v sin(vθ), X = X_l + α_l cos θ."""
        out = np.zeros(x.shape)
        for centre, alpha, c in zip(self.contact.eps, self.contact.alpha, self._settled, strict=True):
            s = (x - centre) / alpha
            inside = np.abs(s) < 1.0
            out[inside] += sine_sum(c, np.arccos(s[inside]))
        return out

    def outside(self, x: Array, reach: float = SERIES_REACH) -> Array:
        """Fourier series up to m α = `reach`: cut off at about 1e-7 of the depth, 3e-5 at the very edges."""
        out = np.zeros(x.shape)
        for centre, alpha, c in zip(self.contact.eps, self.contact.alpha, self.contact.c, strict=True):
            away = x - centre
            away -= 2.0 * math.pi * np.round(away / (2.0 * math.pi))
            out += surface_series(self.layer, self.creep, (float(alpha), c), away, reach)
        return out

    def peak(self) -> float:
        """Largest pressure of any strip."""
        return float(largest_pressure(self.contact.c).max())

    def errors(self, problem: ContactProblem) -> FieldErrors:
        """Errors from a contact of higher order; for the edges α/n of the series' tail, too.

        Of 284 sharp contacts two had edges that were off by more, 1.2 and 1.5 times.
        """
        c, finer = self.contact.c, field_errors(problem, self.contact)
        worst = float((self.contact.alpha * series_tail(c)).max() / largest_pressure(c).max())
        return FieldErrors(finer.peak, finer.edges + worst / float(c.shape[1]))

    @cached_property
    def _settled(self) -> Array:
        """Coefficients that the pressure is summed from, shape (l, n)."""
        return smoothed_coefficients(self.contact.c)


@dataclass(frozen=True, eq=False)
class GridFields:
    """Fields of a contact known on the grid only, linear between nodes."""

    grid: GridContact

    def pressure(self, x: Array) -> Array:
        """Piecewise linear."""
        step = float(self.grid.x[1] - self.grid.x[0])
        at = np.concatenate([[self.grid.x[0] - step], self.grid.x, [self.grid.x[-1] + step]])
        out: Array = np.interp(x, at, np.concatenate([[0.0], self.grid.pressure, [0.0]]))
        return out

    def outside(self, x: Array) -> Array:
        """Displacement, linear between the nodes."""
        step = 2.0 * math.pi / self.grid.points
        place = np.arange(self.grid.points + 1) * step
        w = self.grid.surface_displacement
        out: Array = np.interp(np.mod(x, 2.0 * math.pi), place, np.append(w, w[0]))
        return out

    def peak(self) -> float:
        """Largest pressure of a node."""
        return float(self.grid.pressure.max())

    def errors(self, problem: ContactProblem) -> FieldErrors:  # noqa: ARG002 as every field has it
        """Peak: step from the highest node to its lower neighbour; edges: none beyond the step of the grid."""
        p = np.concatenate([[0.0], self.grid.pressure, [0.0]])
        at = int(p.argmax())
        return FieldErrors(float(1.0 - min(p[at - 1], p[at + 1]) / p[at]), 0.0)

    def depth(self) -> float:
        """Δ/R."""
        return self.grid.depth


def surface_series(layer: Layer, creep: CreepSpectrum, strip: tuple[float, Array], x: Array, reach: float) -> Array:
    """u/R of one strip at X = x about its centre, |x| ≤ π, shape (p,): w = 2 Re Σ S_m p̃̂_m e^{imX}/m, m α ≤ `reach`.

    `strip` is its half width α and its coefficients c.
    """
    alpha, c = strip
    if x.size == 0:
        return np.empty(0)
    v = np.arange(1, c.size + 1)
    amplitudes = 0.5 * v * c * (-1j) ** ((v - 1) % 4)
    out = np.zeros(x.size)

    def add(chosen: NDArray[np.bool_] | slice, m: Array, weights: NDArray[np.complex128]) -> None:
        shown = nonzero_orders(alpha * m, c.size)
        step = max(1, _CHUNK // max(x[chosen].size, shown))
        for i in range(0, m.size, step):
            part = m[i : i + step]
            wave = 2.0 * weights[i : i + step] / part * (amplitudes[:shown] @ bessel_j(shown, part * alpha)[1:])
            turn = np.multiply.outer(x[chosen], part)
            out[chosen] += np.cos(turn) @ wave.real - np.sin(turn) @ wave.imag

    last = max(reach / alpha, window_end(alpha + float(np.abs(x).max())))
    if last <= _LONGEST_SERIES:
        m = np.arange(1.0, math.ceil(last) + 1.0)
        add(slice(None), m, layer.symbol(m, creep) / m)
        return out
    # far from the contact the series' tail cancels: a wave number turns |x| radians, and 64 x 600 are enough
    octave = np.floor(np.log2(np.maximum(np.abs(x) / alpha, 1.0)))
    for group in np.unique(octave):
        chosen = octave == group
        far = float(np.abs(x[chosen]).max())
        end = reach / alpha * min(1.0, _FAR_REACH * alpha / far)
        add(chosen, *series_rule(layer, creep, span=alpha + far, end=end))
    return out
