"""Harmonics of a solved contact inside the layer: sums of fields and of dissipation at any depth.

The sums are those of the surface (quadrature.series_rule), octave by octave of the distance from a strip: far from it
few wave numbers matter.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from conveyor.contact.galerkin.bessel import bessel_j, nonzero_orders
from conveyor.contact.galerkin.quadrature import series_rule
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Confined, Creep, Free, HalfSpace
from conveyor.contact.layers.layer_shapes import Shapes, confined_shapes, free_shapes, half_space_shapes
from conveyor.contact.solution import ContactSolution
from conveyor.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

HARMONICS_PER_POINT = 4.0  # m α up to this many times `points`: two wave numbers for each spacing of the places
_DEEPEST = 12.0  # k z where e^{-2kz} leaves 4e-11 of the dissipation of a half-space
_DEPTH_GRADING = 0.5  # of the half width: depths are evenly spread above it, logarithmically below
NEAR_FIELD = 2.0  # half widths about a strip that are sampled evenly, octaves beyond
OCTAVE_SHARE = 6  # an octave on one side takes a sixth of the places of the near field
# outside the strips the field is smooth over the distance d to them: a flat window ½ erfc((m - m1)/w) ending at 40/d
# blurs over less than d and leaves 2e-4 of it
FAR_END, WINDOW_MIDDLE, WINDOW_RAMP = 40.0, 0.62, 0.15
_CHUNK = 512
_gauss_rule = lru_cache(maxsize=8)(np.polynomial.legendre.leggauss)
_GRID_TERMS = 256  # sine coefficients of a pressure known on a grid
_ELASTIC_CREEP = CreepSpectrum(1.0)


class _PlainSymbol:
    """Symbol equal to m, whose summation rule has plain weights."""

    reach = 0.0

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        return m * creep.compliance(m)


@dataclass(frozen=True, eq=False)
class _PressureStrip:
    """A strip's pressure: centre X about the roll's axis, half width α, sine coefficients c."""

    centre: float
    alpha: float
    c: Array

    def amplitude(self, m: Array) -> ComplexArray:
        """p̃̂_m about the strip's centre, ½ Σ_v v c_v (-i)^{v-1} J_v(mα)/m (spectral.py)."""
        v = np.arange(1, nonzero_orders(m * self.alpha, self.c.size) + 1)
        signed = 0.5 * v * self.c[: v.size] * np.where((v - 1) % 4 < 2, 1.0, -1.0)
        table = bessel_j(v.size, m * self.alpha)
        out = np.empty(m.shape, dtype=complex)
        out.real = signed[::2] @ table[1::2]  # (-i)^{v-1} is real for odd v, imaginary for even
        out.imag = -(signed[1::2] @ table[2::2])
        out /= m
        return out


class InteriorHarmonics:
    """Strips and layer of a contact; lengths X = k x, Z = k z."""

    def __init__(self, solution: ContactSolution, points: int) -> None:
        problem = solution.problem
        layer = problem.layer
        if not isinstance(layer, (HalfSpace, Free, Confined)):
            raise InputError(
                f"support = {problem.support!r}: the interior of a Layer of your own is not known here; "
                "use free, confined or half-space"
            )
        self.problem, self.layer, self.points = problem, layer, points
        self.nu = layer.poisson if isinstance(layer, Confined) else problem.poisson
        self.thickness = math.inf if isinstance(layer, HalfSpace) else layer.thickness
        self.strips = _pressure_strips(solution)
        self.pressure = sum(0.25 * s.alpha * float(s.c[0]) for s in self.strips)
        self.scale = 0.5 * problem.rho / (1.0 - self.nu)

    def depths(self, count: int) -> tuple[Array, Array]:
        """The surface, Gauss nodes graded toward it, the far face if there is one, and their weights, in Z."""
        unit = _DEPTH_GRADING * min(s.alpha for s in self.strips)
        end = math.asinh(min(self.thickness, _DEEPEST) / unit)
        x, w = _gauss_rule(count)
        at = 0.5 * end * (x + 1.0)
        bottom = [] if math.isinf(self.thickness) else [self.thickness]
        z = np.concatenate([[0.0], unit * np.sinh(at), bottom])
        return z, np.concatenate([[0.0], 0.5 * end * w * unit * np.cosh(at), np.zeros(len(bottom))])

    def places(self) -> Array:
        """X along the path: evenly within two half widths of each strip, then by octaves up to half a period."""
        out = []
        per_octave = max(2, self.points // OCTAVE_SHARE)
        for strip in self.strips:
            near = strip.alpha * np.linspace(-NEAR_FIELD, NEAR_FIELD, self.points + 1)
            octaves = max(math.log2(math.pi / (NEAR_FIELD * strip.alpha)), 0.0)
            steps = math.ceil(octaves * per_octave)
            far = NEAR_FIELD * strip.alpha * 2.0 ** np.linspace(0.0, octaves, steps + 1)[1:]
            out.append(strip.centre + np.concatenate([-far, near, far]))
        return np.concatenate(out)

    def shapes(self, m: Array, z: Array) -> Shapes:
        """D, T, H, U at wave numbers m, shape (k,), and depths Z, shape (nz,); each (nz, k)."""
        y = np.multiply.outer(z, m)
        if isinstance(self.layer, HalfSpace):
            return half_space_shapes(y, self.nu)
        t = np.multiply.outer(np.maximum(self.thickness - z, 0.0), m)
        kind: Callable[[Array, Array, Array, float], Shapes]
        kind = confined_shapes if isinstance(self.layer, Confined) else free_shapes
        return kind(m * self.thickness, y, t, self.nu)

    def sums(self, x: Array, z: Array, *, strains_only: bool = False) -> list[Array]:
        """(σ difference/2, τ, σ sum/2,) ε difference/2, γ/2, dilatation (, k u_x, k u_z), each (nz, nx)."""
        count = 3 if strains_only else 8
        out = np.zeros((count, z.size, x.size))
        if not out.size:
            return list(out)
        for strip in self.strips:
            away = x - strip.centre
            away -= 2.0 * math.pi * np.round(away / (2.0 * math.pi))
            octave = np.floor(np.log2(np.maximum(np.abs(away) / (NEAR_FIELD * strip.alpha), 0.5)))
            groups = [np.flatnonzero(octave == one) for one in np.unique(octave)]
            rules = [self._rule(strip, np.abs(away[chosen])) for chosen in groups]
            m = np.concatenate([nodes for nodes, _ in rules])
            weights = np.concatenate([weights for _, weights in rules])
            parts = self._coefficients(strip, m, weights, z, strains_only=strains_only)
            start = 0
            for chosen, (nodes, _) in zip(groups, rules, strict=True):
                its = parts[:, start : start + nodes.size]
                start += nodes.size
                for i in range(0, chosen.size, _CHUNK):
                    part = chosen[i : i + _CHUNK]
                    turn = np.multiply.outer(nodes, away[part])
                    fields = its.real @ np.cos(turn) - its.imag @ np.sin(turn)
                    out[:, :, part] += fields.reshape(count, z.size, part.size)
        return list(out)

    def _rule(self, strip: _PressureStrip, distance: Array) -> tuple[Array, Array]:
        """Wave numbers and weights of the sum at distances from a strip's centre."""
        gap, span = float(distance.min()) - strip.alpha, float(distance.max()) + strip.alpha
        end = HARMONICS_PER_POINT * self.points / strip.alpha
        if gap >= 0.5 * strip.alpha:
            end = min(end, FAR_END / gap)
        m, weights = series_rule(_PlainSymbol(), _ELASTIC_CREEP, span=span, end=end)
        keep = m <= end
        window = 0.5 * special.erfc((m[keep] / end - WINDOW_MIDDLE) / WINDOW_RAMP)
        return m[keep], 2.0 * weights[keep].real * window

    def _coefficients(
        self, strip: _PressureStrip, m: Array, weights: Array, z: Array, *, strains_only: bool
    ) -> ComplexArray:
        """Weighted amplitudes of the fields at wave numbers m of shape (k,); shape (count · nz, k)."""
        wave = weights * strip.amplitude(m)
        strained = self.scale * wave * self.problem.creep.compliance(m)
        D, T, H, U = self.shapes(m, z)
        bulk = 1.0 - 2.0 * self.nu
        parts = [strained * D, 1j * strained * T, 2.0 * bulk * strained * H]
        if not strains_only:
            # i m k u_x = ε_xx
            moved = strained / m
            parts = [wave * D, 1j * wave * T, wave * H, *parts, -1j * moved * (D + bulk * H), moved * U]
        return np.concatenate(parts)

    def dissipation(self, z: Array) -> tuple[Array, float]:
        """D R/F_N = ρ²/((1-ν) p̃_m) Σ m Im j 2 (D² + T² + (1-2ν) H²) |p̂_m|², shape (nz,); mean m of it."""
        low = min(s.centre - s.alpha for s in self.strips)
        high = max(s.centre + s.alpha for s in self.strips)
        end = HARMONICS_PER_POINT * self.points / min(s.alpha for s in self.strips)
        m, weights = series_rule(_PlainSymbol(), _ELASTIC_CREEP, span=high - low, end=end)
        waves = [s.amplitude(m) * np.exp(-1j * m * (s.centre - low)) for s in self.strips]
        loss = weights.real * np.abs(sum(waves)) ** 2 * self.problem.creep.compliance(m).imag
        D, T, H, _ = self.shapes(m, z)
        density = 2.0 * (D * D + T * T + (1.0 - 2.0 * self.nu) * H * H) @ (m * loss)
        density *= self.problem.rho**2 / ((1.0 - self.nu) * self.pressure)
        # over the whole depth a harmonic loses Im S |p̂|² (contact/fields/energy_balance.py)
        lost = weights.real * np.abs(sum(waves)) ** 2 * self.layer.symbol(m, self.problem.creep).imag
        total = float(lost.sum())
        return density, math.exp(float(lost @ np.log(m)) / total) if total > 0.0 else 0.0


def _pressure_strips(solution: ContactSolution) -> list[_PressureStrip]:
    """Sine coefficients of every strip's pressure, from the solution or sampled from a grid."""
    if (known := solution.strips) is not None:
        return [_PressureStrip(*strip) for strip in known]
    angle = np.arange(1, _GRID_TERMS + 1) * (math.pi / (_GRID_TERMS + 1))
    out = []
    for low, high in solution.patches:
        centre, half = 0.5 * (low + high), 0.5 * (high - low)
        values = solution.pressure(centre + half * np.cos(angle))
        odd = np.concatenate([[0.0], values, [0.0], -values[::-1]])
        c = -np.fft.rfft(odd).imag[1 : _GRID_TERMS + 1] / (_GRID_TERMS + 1)
        rho = solution.problem.rho
        out.append(_PressureStrip(rho * centre, rho * half, c))
    return out
