"""The dimensionless contact problem and the status of a solve.

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
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np

from conveyor.arguments.limits import require, require_number
from conveyor.contact.layers.belt_layer import BeltSupport
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Confined, Free, HalfSpace, Layer
from conveyor.errors import InputError

_SUPPORTS = ("free", "confined", "half-space")
_HEAVIEST = 1e30  # squares and cubes of larger numbers overflow, of much smaller ones underflow
_LIMITS = {
    "radius": (1e-12, 0.5, " (R/λ: rolls do not overlap)"),
    "thickness": (1e-12, _HEAVIEST, " or inf (k h)"),
    "pressure": (1e-30, _HEAVIEST, " (mean pressure)"),
    "poisson": (0.0, 0.5, ""),
}
LARGEST_RTOL = 1e-2
_TRIAL_WAVES = 5  # wave numbers at which a user's own layer is checked


class Status(Enum):
    """Reason why a solve stopped; the value says what to change."""

    OK = "converged to the tolerance asked for"
    TOO_DEEP = (
        "converged, but the roll sinks in deeper than its radius, far outside small strain: figures are those of the "
        "linear problem; lower the load, tighten or thicken the layer"
    )
    WRAP_LIMIT = (
        "the load presses the roll in to, or beyond its half circle: an edge that is still inside is nearer to the end "
        "than grids tell; lower the load, or enlarge the radius"
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
        """Reason why the solve stopped, and what to change."""
        return self.value


@dataclass(frozen=True)
class ContactProblem:
    """A viscoelastic layer rolling over periodic rigid cylinders, pressed on by a mean pressure.

    Parameters
    ----------
    support : "free", "confined", "half-space", Belt or Layer
        Far face of the layer: loaded but free to bend (the paper's belt), bonded to a rigid plane (a cover on a
        stiff carcass), or infinitely far; or the belt itself, with thicknesses of its own. Any object with the
        methods of `Layer` has its own symbol.
    radius : float
        R/λ [-], in (0, 0.5].
    pressure : float
        p̃_m = 2(1-ν²) p_m/(E0 k R) [-], positive; p_m is the load per roll and width over the spacing.
    creep : CreepSpectrum
        Normalised creep compliance of the layer, of a belt's bottom cover.
    thickness : float
        k h [-], positive, infinity allowed.
    poisson : float
        ν [-], in [0, 0.5]; enters the scale of pressure and the confined layer only.

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
        require(isinstance(self.creep, CreepSpectrum), "creep", self.creep, "a CreepSpectrum")
        for name, (least, most, meaning) in _LIMITS.items():
            value = getattr(self, name)
            require_number(**{name: value})
            number = float(value)  # single precision would go on into every scale
            inside = least <= number <= most or (name == "thickness" and number == math.inf)
            require(inside, name, value, f">= {least:g} and <= {most:g}{meaning}")
            object.__setattr__(self, name, number)
        self._check_support()

    def _check_support(self) -> None:
        if isinstance(self.support, BeltSupport):
            require(self.poisson == 0.5, "poisson", self.poisson, "0.5, the covers of a Belt are incompressible")
        layer = all(hasattr(self.support, name) for name in ("reach", "symbol"))
        known = self.support in _SUPPORTS if isinstance(self.support, str) else layer
        require(known, "support", self.support, f"{', '.join(_SUPPORTS)} or a Layer")
        if not isinstance(self.support, (str, BeltSupport)):
            _check_symbol(self.support, self.creep)

    @property
    def rho(self) -> float:
        """ρ = k R [-]."""
        return 2.0 * math.pi * self.radius

    @cached_property
    def layer(self) -> Layer:
        """Layer that the solver uses."""
        if not isinstance(self.support, str):
            return self.support
        if self.support == "half-space" or math.isinf(self.thickness):
            return HalfSpace()
        if self.support == "free":
            return Free(self.thickness)
        return Confined(self.thickness, self.poisson)


def _check_symbol(layer: Layer, creep: CreepSpectrum) -> None:
    """Raise InputError for a user's own layer whose symbol is no compliance at some wave numbers."""
    m = np.geomspace(1.0, 1e4, _TRIAL_WAVES)
    symbol = np.asarray(layer.symbol(m, creep))
    if symbol.shape != m.shape or not (np.isfinite(symbol).all() and (symbol.real > 0.0).all()):
        raise InputError(
            f"support = {layer!r}: symbol(m, creep) of {m.size} wave numbers must be as many finite complex numbers "
            f"with a positive real part, not {symbol.tolist()}"
        )


def check_rtol(rtol: float) -> None:
    """Raise InputError for a tolerance outside [1e-12, 1e-2]."""
    require_number(rtol=rtol)
    require(1e-12 <= rtol <= LARGEST_RTOL, "rtol", rtol, f">= 1e-12 and <= {LARGEST_RTOL:g}")
