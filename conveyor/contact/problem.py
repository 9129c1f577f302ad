"""The dimensionless contact problem and why a solve stopped.

Scales (paper, section 3; E0 = rubbery modulus, k = 2π/λ, λ = roll spacing)

===============  =============================  ==========================
name             dimensionless                  physical
===============  =============================  ==========================
length x         X = k x                        x [m]
radius           R/λ; ρ = k R                   R [m]
thickness        k h                            h [m]
pressure         p̃ = 2(1-ν²) p/(E0 k R)         p [Pa]
retardation      ζ = V τ k                      τ [s], V [m/s]
displacement     w = u/R                        u [m]
half width       α = k a                        a [m]
eccentricity     ε = k e                        e [m]
===============  =============================  ==========================
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments import checked
from conveyor.contact.layers import Confined, Free, HalfSpace, Layer
from conveyor.errors import InputError

Array = NDArray[np.float64]
_SUPPORTS = ("free", "confined", "half-space")
_THINNEST, _LIGHTEST = 1e-12, 1e-30  # squares and cubes of smaller numbers underflow
_HEAVIEST = 1e30  # of pressure and thickness: squares and cubes of larger ones overflow
_SMALLEST_ROLL = 1e-12
_TIMES = 1e-100, 1e100
_SUM_TOLERANCE = 1e-9  # j∞ + Σ d = 1: users type decimals


class Status(Enum):
    """Why a solve stopped; the value says what to change."""

    OK = "converged to the tolerance asked for"
    WRAP_LIMIT = (
        "the load presses the roll in beyond its half circle: no contact with an edge inside the roll "
        "carries it; lower the load, or enlarge the radius"
    )
    TOO_THIN = (
        "the layer is so thin against the contact that its quadrature would need more than two million nodes; "
        "use a thicker layer, a smaller load, or a plate model"
    )
    NOT_CONVERGED = (
        "the highest order, or the finest grid of a split contact, did not reach the tolerance: see error_estimate; "
        "ask for a larger rtol, or resolve a sharp retardation time by more terms"
    )

    @property
    def message(self) -> str:
        """Why the solve stopped and what to change."""
        return self.value


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

    @checked
    def __init__(self, instantaneous: float, weights: ArrayLike = (), times: ArrayLike = ()) -> None:
        try:
            d, z = (np.array(given, dtype=float, ndmin=1) for given in (weights, times))
        except (TypeError, ValueError):
            raise InputError("weights and times: two lists of numbers are needed") from None
        if d.ndim != 1 or d.shape != z.shape:
            raise InputError(f"weights {d.shape} and times {z.shape}: give two lists of equal length")
        if not np.all(np.isfinite(d) & (d > 0.0)):
            raise InputError(f"weights = {d.tolist()}: each weight is a finite positive number")
        if not np.all((z == 0.0) | ((z >= _TIMES[0]) & (z <= _TIMES[1]))):
            raise InputError(
                f"times = {z.tolist()}: each ζ is finite and not negative: 0, or from {_TIMES[0]:g} to {_TIMES[1]:g}"
            )
        if not (math.isfinite(instantaneous) and 0.0 < instantaneous <= 1.0 + _SUM_TOLERANCE):
            raise InputError(f"instantaneous = {instantaneous!r}: j∞ = E0/E∞ lies in (0, 1]")
        if abs(instantaneous + d.sum() - 1.0) > _SUM_TOLERANCE:
            raise InputError(
                f"instantaneous + sum(weights) = {instantaneous + d.sum():.12g}: must be 1 "
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
class Creeps:
    """Creep spectra of several scenes side by side (internal to the solver): terms of weight zero fill the gaps.

    Shapes: `instantaneous` (b,), `weights` and `times` (b, t), every time positive.
    """

    instantaneous: Array
    weights: Array
    times: Array

    def compliance(self, m: Array) -> NDArray[np.complex128]:
        """j(m) of each scene at its wave numbers m, shape (b, k), or at those of all, shape (1, k)."""
        x = m[:, :, None] * self.times[:, None, :]
        real = 1.0 / (1.0 + x * x)
        out = np.empty(x.shape[:2], dtype=complex)
        out.real = (real @ self.weights[:, :, None])[..., 0] + self.instantaneous[:, None]
        real *= x
        out.imag = (real @ self.weights[:, :, None])[..., 0]
        return out

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int_]) -> Creeps:
        return Creeps(self.instantaneous[chosen], self.weights[chosen], self.times[chosen])


@dataclass(frozen=True)
class ContactProblem:
    """A viscoelastic layer rolling over periodic rigid cylinders, pressed on by a mean pressure.

    Parameters
    ----------
    support : "free", "confined", "half-space" or Layer
        Far face of the layer: loaded but free to bend (the paper's belt), bonded to a rigid plane (a cover on a
        stiff carcass), or infinitely far. Any object with the methods of `Layer` brings its own symbol.
    radius : float
        R/λ [-], in (0, 0.5].
    pressure : float
        p̃_m = 2(1-ν²) p_m/(E0 k R) [-], positive; p_m is the load per roll and width over the spacing.
    creep : CreepSpectrum
        Normalised creep compliance.
    thickness : float
        k h [-], positive, infinity allowed.
    poisson : float
        ν [-], in [0, 0.5]; enters the confined layer only, beside the scale of pressure.

    Raises
    ------
    InputError
        A value outside its range.
    """

    support: str | Layer
    radius: float
    pressure: float
    creep: CreepSpectrum
    thickness: float = math.inf
    poisson: float = 0.5

    def __post_init__(self) -> None:
        if isinstance(self.support, str) and self.support not in _SUPPORTS:
            raise InputError(f"support = {self.support!r}: allowed are {', '.join(_SUPPORTS)} or a Layer")
        if not isinstance(self.support, str) and not all(
            hasattr(self.support, name) for name in ("reach", "symbol")
        ):
            raise InputError(f"support = {self.support!r}: allowed are {', '.join(_SUPPORTS)} or a Layer")
        for name in ("radius", "thickness", "pressure", "poisson"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
                raise InputError(f"{name} = {value!r}: a number is needed")
        if not _SMALLEST_ROLL <= self.radius <= 0.5:
            raise InputError(
                f"radius = {self.radius!r}: R/λ lies in (0, 0.5], rolls must not overlap; at least {_SMALLEST_ROLL:g}"
            )
        if not (_THINNEST <= self.thickness <= _HEAVIEST or self.thickness == math.inf):
            raise InputError(
                f"thickness = {self.thickness!r}: k h is positive, at least {_THINNEST:g} (infinity allowed), "
                f"at most {_HEAVIEST:g} below it"
            )
        if not _LIGHTEST <= self.pressure <= _HEAVIEST:
            raise InputError(
                f"pressure = {self.pressure!r}: the mean pressure is finite and positive, "
                f"from {_LIGHTEST:g} to {_HEAVIEST:g}"
            )
        if not 0.0 <= self.poisson <= 0.5:
            raise InputError(f"poisson = {self.poisson!r}: Poisson's ratio lies in [0, 0.5]")

    @property
    def rho(self) -> float:
        """ρ = k R [-]."""
        return 2.0 * math.pi * self.radius

    @property
    def layer(self) -> Layer:
        """The layer whose symbol the solver uses."""
        if not isinstance(self.support, str):
            return self.support
        if self.support == "half-space" or math.isinf(self.thickness):
            return HalfSpace()
        if self.support == "free":
            return Free(self.thickness)
        return Confined(self.thickness, self.poisson)


def check_rtol(rtol: float) -> None:
    """Refuse a tolerance that is none, or none that double precision reaches."""
    if not (isinstance(rtol, (int, float, np.floating)) and 1e-12 <= rtol <= 1e-2):
        raise InputError(f"rtol = {rtol!r}: the tolerance lies in [1e-12, 1e-2]")
