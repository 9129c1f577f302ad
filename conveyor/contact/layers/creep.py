"""Normalised creep compliance of rubber: one spectrum, or a batch of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.argument_types import check_arguments
from conveyor.arguments.limits import require
from conveyor.contact.layers.regrid import log_places
from conveyor.errors import InputError

Array = NDArray[np.float64]

_TIME_RANGE = 1e-100, 1e100
_STIFFEST = 1e-30  # products of smaller ones with a load underflow; rubber stiffens by 1e5
_SUM_TOLERANCE = 1e-9  # j∞ + Σ d = 1: users type decimals


@dataclass(frozen=True, eq=False)
class CreepSpectrum:
    """Normalised complex creep compliance j(m) = j∞ + Σ d_t/(1 - i m ζ_t).

    Parameters
    ----------
    instantaneous : float
        j∞ = E0/E∞ [-], in (0, 1].
    weights : array_like, shape (t,)
        d_t = E0 J_t [-], positive; j∞ + Σ d_t = 1.
    times : array_like, shape (t,)
        ζ_t = V τ_t k [-], retardation (not relaxation) times, zero or positive.

    Raises
    ------
    InputError
        A value outside its range, lengths that differ, or a sum other than one.

    Examples
    --------
    >>> CreepSpectrum(instantaneous=0.1, weights=[0.9], times=[1.0]).compliance(np.array([1.0]))
    array([0.55+0.45j])
    """

    instantaneous: float
    weights: Array = field(default_factory=lambda: np.empty(0))
    times: Array = field(default_factory=lambda: np.empty(0))

    @check_arguments
    def __init__(self, instantaneous: float, weights: ArrayLike = (), times: ArrayLike = ()) -> None:
        try:
            d, z = (np.array(given, dtype=float, ndmin=1) for given in (weights, times))
        except (TypeError, ValueError):
            raise InputError("weights and times: two lists of numbers are needed") from None
        if d.ndim != 1 or d.shape != z.shape:
            raise InputError(f"weights {d.shape} and times {z.shape}: give two lists of equal length")
        if d.size:
            positive = 0.0 < d.min() <= d.max() <= 1.0 + _SUM_TOLERANCE
            require(positive, "weights", d.tolist(), "> 0 each, instantaneous + sum(weights) = 1")
        least, most = _TIME_RANGE
        plain = z.size == 0 or least <= z.min() <= z.max() <= most
        if not plain:
            usable = bool(np.all((z == 0.0) | ((z >= least) & (z <= most))))
            require(usable, "times", z.tolist(), f"0, or >= {least:g} and <= {most:g}, each ζ")
        soft = _STIFFEST <= instantaneous <= 1.0 + _SUM_TOLERANCE
        require(soft, "instantaneous", instantaneous, f">= {_STIFFEST:g} and <= 1 (j∞ = E0/E∞)")
        if abs((whole := instantaneous + float(d.sum())) - 1.0) > _SUM_TOLERANCE:
            raise InputError(
                f"instantaneous + sum(weights) = {whole:.12g}: must be 1 "
                "(compliances are in units of the rubbery compliance 1/E0)"
            )
        for array in (d, z):
            array.flags.writeable = False
        object.__setattr__(self, "instantaneous", float(instantaneous))
        object.__setattr__(self, "weights", d)
        object.__setattr__(self, "times", z)

    def compliance(self, m: Array) -> NDArray[np.complex128]:
        """j(m) at wave numbers m [-], shape of m."""
        out = np.full(m.shape, self.instantaneous, dtype=complex)
        if self.weights.size:
            mz = np.multiply.outer(m, self.times)
            with np.errstate(over="ignore"):  # 1/(1 + z²) of z = 1e200 is zero, to rounding
                real = 1.0 / (1.0 + mz * mz)
            out.real += real @ self.weights
            real *= mz
            out.imag = real @ self.weights
        return out


@dataclass(frozen=True, eq=False)
class CreepBatch:
    """Batch of creep spectra (internal to the solver); terms of weight zero fill the gaps.

    Shapes: `instantaneous` (b,), `weights` and `times` (b, t), every time positive.
    """

    instantaneous: Array
    weights: Array
    times: Array

    @cached_property
    def places(self) -> Array:
        """Places of 1/ζ on the logarithmic grid, shape (b, t)."""
        return log_places(1.0 / self.times)

    def compliance(self, m: Array) -> NDArray[np.complex128]:
        """j(m) of each spectrum at its wave numbers m, shape (b, k), or at common ones, shape (1, k)."""
        x = m[:, :, None] * self.times[:, None, :]
        real = x * x
        real += 1.0
        np.reciprocal(real, out=real)
        out = np.empty(x.shape[:2], dtype=complex)
        out.real = (real @ self.weights[:, :, None])[..., 0] + self.instantaneous[:, None]
        real *= x
        out.imag = (real @ self.weights[:, :, None])[..., 0]
        return out

    @classmethod
    def of(cls, spectra: Sequence[CreepSpectrum]) -> CreepBatch:
        """Stack spectra."""
        terms = max([1, *(creep.weights.size for creep in spectra)])
        weights, times = np.zeros((len(spectra), terms)), np.ones((len(spectra), terms))
        for row, creep in enumerate(spectra):
            weights[row, : creep.weights.size] = creep.weights
            times[row, : creep.times.size] = creep.times
        return cls(np.array([creep.instantaneous for creep in spectra]), weights, times)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int_] | slice) -> CreepBatch:
        return CreepBatch(self.instantaneous[chosen], self.weights[chosen], self.times[chosen])
