"""Layer symbols: displacement per pressure of a layer's surface, wave number by wave number.

Fourier form of the paper's Eqs. (1)-(4): ŵ_m = S_m p̃̂_m/|m|, S_m = L(|m| k h) j(m). The paper prints as Eq. (5) the
confined incompressible layer; its text and figures treat the free one (see docs/method.md).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

HALF_SPACE_DEPTH = 20.0  # q beyond which |L - 1| <= 4 q² exp(-2q) < 1e-14, below the rounding of the matrix
_SERIES_BELOW = 1.0
_SERIES = [1.0 / math.factorial(2 * n + 1) for n in range(9, 0, -1)]  # of sinh x - x


class Creep(Protocol):
    """Creep compliance of a layer's rubber."""

    def compliance(self, m: Array) -> ComplexArray:
        """j(m)."""


class Layer(Protocol):
    """Symbol of a layer; any symbol that approaches j(m) can be solved."""

    @property
    def reach(self) -> float:
        """Wave number m beyond which the symbol equals j(m) to rounding [-]; zero for the half-space."""

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        """S_m for real m > 0; S_{-m} is its conjugate."""


@dataclass(frozen=True)
class HalfSpace:
    """Infinitely deep layer, L = 1."""

    @property
    def reach(self) -> float:
        """Zero: the symbol is j(m) everywhere."""
        return 0.0

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        """S_m = j(m)."""
        return creep.compliance(m)


@dataclass(frozen=True)
class Free:
    """Layer whose far face carries only the uniform load; `thickness` is k h [-]."""

    thickness: float

    @property
    def reach(self) -> float:
        """Wave number beyond which the symbol equals j(m) to rounding [-]."""
        return HALF_SPACE_DEPTH / self.thickness

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        """S_m = L(m k h) j(m)."""
        return free_symbol(m * self.thickness) * creep.compliance(m)


@dataclass(frozen=True)
class Confined:
    """Layer bonded to a rigid plane; `thickness` is k h [-], `poisson` in [0, 0.5]."""

    thickness: float
    poisson: float = 0.5

    @property
    def reach(self) -> float:
        """Wave number beyond which the symbol equals j(m) to rounding [-]."""
        return HALF_SPACE_DEPTH / self.thickness

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        """S_m = L(m k h) j(m)."""
        return confined_symbol(m * self.thickness, self.poisson) * creep.compliance(m)


@dataclass(frozen=True, eq=False)
class PlainLayerBatch:
    """Batch of layers of one kind (internal to the solver); `thickness` k h and `poisson` of shape (b,)."""

    support: str
    thickness: Array
    poisson: Array

    def reach(self, depth: float) -> Array:
        """Wave numbers beyond q = m k h = `depth`, shape (b,); zero for the half-space."""
        return np.zeros(self.thickness.size) if self.support == "half-space" else depth / self.thickness

    def symbol(self, m: Array, j: ComplexArray) -> ComplexArray:
        """S_m of rubbers of compliance j(m), shape (b, k)."""
        if self.support == "half-space":
            return j
        q = m * self.thickness[:, None]
        return j * (free_symbol(q) if self.support == "free" else confined_symbol(q, self.poisson[:, None]))

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int_]) -> PlainLayerBatch:
        return PlainLayerBatch(self.support, self.thickness[chosen], self.poisson[chosen])


def free_symbol(q: Array) -> Array:
    """L(q) = (sinh 2q + 2q)/(cosh 2q - 1 - 2q²); 6/q³ (Kirchhoff plate) for q → 0, 1 for q → ∞.

    The denominator is 2 (sinh q - q)(sinh q + q): only sinh q - q cancels, and is summed as a series.

    Parameters
    ----------
    q : ndarray
        |m| k h [-], positive.

    Examples
    --------
    >>> float(free_symbol(np.array([1e-4]))[0]) * 1e-12 / 6  # doctest: +ELLIPSIS
    1.0000000...
    """
    root = np.exp(-q)
    decay = root * root
    numerator = -0.5 * np.expm1(-4.0 * q) + 2.0 * q * decay
    grown = -0.5 * np.expm1(-2.0 * q) + q * root
    symbol: Array = numerator / (2.0 * sinh_minus_scaled(q, root) * grown)
    return symbol


def confined_symbol(q: Array, poisson: Array | float = 0.5) -> Array:
    """L(q) = (2κ sinh 2q - 4q)/(2κ cosh 2q + 4q² + 1 + κ²), κ = 3 - 4ν; 2q³/3 (ν = ½) for q → 0, 1 for q → ∞.

    Parameters
    ----------
    q : ndarray
        |m| k h [-], positive.
    poisson : float
        ν [-], in [0, 0.5].

    Examples
    --------
    >>> round(float(confined_symbol(np.array([1e-4]))[0]) * 1.5e12, 7)
    1.0
    """
    kappa = 3.0 - 4.0 * poisson
    decay = np.exp(-2.0 * q)
    numerator = 2.0 * kappa * sinh_minus_scaled(2.0 * q, decay) + 8.0 * (1.0 - 2.0 * poisson) * q * decay
    denominator = kappa * (1.0 + decay * decay) + (4.0 * q * q + 1.0 + kappa * kappa) * decay
    return numerator / denominator


def sinh_minus_scaled(x: Array, decay: Array) -> Array:
    """(sinh x - x) e^{-x} of x ≥ 0 and e^{-x}, by its Taylor series below 1 (nine terms: 1e-17 of the first)."""
    square = np.minimum(x, _SERIES_BELOW) ** 2
    series = square * _SERIES[0]
    for coefficient in _SERIES[1:]:
        series += coefficient
        series *= square
    small = x < _SERIES_BELOW
    return np.where(small, series * x, 0.5 * (1.0 - decay * decay) - x * decay) * np.where(small, decay, 1.0)
