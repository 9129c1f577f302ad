"""Displacement of a layer's surface under pressures on an even grid."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray
from scipy import special

from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_batch import CustomLayerBatch, layer_kind
from conveyor.contact.layers.layer_models import Layer
from conveyor.contact.problem import ContactProblem
from conveyor.contact.solvers.solver_state import SolverState

Array = NDArray[np.float64]


_ALIASES = 6  # explicit ones; beyond, S varies by less than 1e-2 and the sum is a Hurwitz zeta function


_FIRST_OCTAVE = 1 << 12  # wave numbers below are taken one by one


@dataclass(frozen=True, eq=False)
class SurfaceOperator:
    """Operator from pressures to displacements of the nodes on the roll.

    The mean of the pressure lifts no Fourier component; a compliance of the mean is added all the same (`lift`), which
    makes every principal submatrix positive definite and shifts the depth by lift x mean pressure.
    """

    index: NDArray[np.int_]
    transform: NDArray[np.complex128]  # T_m, m = 0 … N/2
    loss_transform: Array
    row: Array  # t_d, d = 0 … N-1
    lift: float
    window: NDArray[np.complex128]  # transform of t_d of the nodes on the roll alone, where they are few
    inverse: NDArray[np.complex128]  # 1/T at the window's wave numbers

    @classmethod
    def of(cls, problem: ContactProblem, points: int, index: NDArray[np.int_]) -> SurfaceOperator:
        """Operator of a problem on an even grid, at the nodes of `index`."""
        transform, loss = _surface_transform(problem, points)
        lift = float(np.abs(transform[1]))
        transform[0] = lift
        row = np.fft.irfft(transform, points)
        size = 1 << math.ceil(math.log2(2 * index.size))
        if size >= points:
            return cls(index, transform, loss, row, lift, transform, 1.0 / transform)
        # a product of the nodes on the roll needs t_d of their distances only
        near = np.concatenate([row[: size // 2], [0.0], row[points - size // 2 + 1 :]])
        wave = np.arange(size // 2 + 1) * (points / size)
        place = np.maximum(np.minimum(wave, points / 2.0), 1.0)
        at = np.arange(1.0, transform.size)
        middle = np.interp(place, at, transform[1:].real) + 1j * np.interp(place, at, transform[1:].imag)
        return cls(index, transform, loss, row, lift, np.fft.rfft(near), 1.0 / middle)

    @property
    def points(self) -> int:
        """Nodes of one period."""
        return int(self.row.size)

    def dense(self, nodes: NDArray[np.int_]) -> Array:
        """Matrix of the chosen nodes."""
        at = self.index[nodes]
        matrix: Array = self.row[np.subtract.outer(at, at) % self.points]
        return matrix

    def lifted(self, p: Array) -> Array:
        """W + lift x mean p at the nodes of `index`."""
        return self._product(p, self.window)

    def pressed(self, w: Array) -> Array:
        """Approximate pressure of a displacement, the preconditioner."""
        return self._product(w, self.inverse)

    def _product(self, values: Array, transform: NDArray[np.complex128]) -> Array:
        size = 2 * (transform.size - 1)
        full = np.zeros(size)
        place = self.index - self.index[0] if size < self.points else self.index
        full[place] = values
        out: Array = np.fft.irfft(np.fft.rfft(full) * transform, size)[place]
        return out

    def whole(self, p: Array) -> Array:
        """W + lift x mean p at every node of the period."""
        full = np.zeros(self.points)
        full[self.index] = p
        out: Array = np.fft.irfft(np.fft.rfft(full) * self.transform, self.points)
        return out

    def loss(self, p: Array) -> float:
        """2 Σ_{m≥1} Im S_m |p̂_m|² of the piecewise linear pressure."""
        full = np.zeros(self.points)
        full[self.index] = p
        amplitude = np.fft.rfft(full) / self.points
        return 2.0 * float(np.sum(self.loss_transform * np.abs(amplitude) ** 2))


def _surface_transform(problem: ContactProblem, points: int) -> tuple[NDArray[np.complex128], Array]:
    """T_m for m = 0 … N/2 (T_0 = 0), and Σ_l Im S sinc⁴ of the same."""
    layer, creep = problem.layer, SolverState.of(problem).creep
    aliases = _alias_coefficients(layer, creep, points)

    def at(m: Array) -> Array:
        """Re T, Im T and the loss at wave numbers m, shape (3, k)."""
        symbol = layer.symbol(m, creep)
        sine = (np.sin(math.pi * m / points) * (points / math.pi)) ** 2
        shown = np.stack([symbol.real / m**3, symbol.imag / m**3, symbol.imag / m**4])
        shown += chebyshev.chebval(4.0 * m / points - 1.0, aliases)
        out: Array = shown * np.stack([sine, sine, sine * sine])
        return out

    parts = np.empty((3, points // 2 + 1))
    parts[:, 0] = 0.0
    start = parts.shape[1] if layer_kind(layer) is CustomLayerBatch else min(_FIRST_OCTAVE, parts.shape[1])
    parts[:, 1:start] = at(np.arange(1.0, start))
    while 2 * start < parts.shape[1]:
        parts[:, start : 2 * start] = _interpolate_octave(at, start)
        start *= 2
    parts[:, start:] = at(np.arange(float(start), parts.shape[1]))
    parts[1:, -1] = 0.0
    return parts[0] + 1j * parts[1], parts[2]


def _alias_coefficients(layer: Layer, creep: CreepSpectrum, points: int) -> Array:
    """Aliases of Re T, Im T and the loss as Chebyshev coefficients over a half period, shape (21, 3).

    They are smooth in m/N: degree 20 carries them to 1e-13.
    """
    nodes = chebyshev.chebpts1(21)
    at = 0.25 * points * (nodes + 1.0)
    turns = points * np.arange(1.0, _ALIASES + 1.0)[:, None]
    m = np.stack([turns + at, turns - at])
    symbol = layer.symbol(m.ravel(), creep).reshape(m.shape)
    symbol[1] = np.conj(symbol[1])
    alias, alias_loss = (symbol / m**3).sum(axis=(0, 1)), (symbol.imag / m**4).sum(axis=(0, 1))
    far = layer.symbol(np.array([(_ALIASES + 2.0) * points]), creep)[0].real
    tail = special.zeta(3.0, _ALIASES + 1.0 + at / points) + special.zeta(3.0, _ALIASES + 1.0 - at / points)
    alias += far * tail / float(points) ** 3
    fitted: Array = chebyshev.chebfit(nodes, np.stack([alias.real, alias.imag, alias_loss], axis=1), 20)
    return fitted


def _interpolate_octave(figures: Callable[[Array], Array], start: int) -> Array:
    """`figures` at wave numbers `start` … 2 start - 1, interpolated in sixteen equal parts, shape (3, start).

    Their poles lie 45° and more off the real axis of m: degree 9 over a part is exact to 1e-15.
    """
    nodes = chebyshev.chebpts1(10)
    size = start // 16
    low = start + size * np.arange(16.0)[:, None]
    values = figures((low + 0.5 * size * (nodes + 1.0)).ravel()).reshape(3 * 16, 10)
    carried = chebyshev.chebvander(np.arange(size) * (2.0 / size) - 1.0, 9) @ chebyshev.chebfit(nodes, values.T, 9)
    return np.asarray(carried.T.reshape(3, start), dtype=np.float64)
