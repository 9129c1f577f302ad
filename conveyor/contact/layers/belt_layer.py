"""The belt itself as the layer: bottom cover, tensioned carcass, top cover.

Per wave number κ = m k two incompressible covers are bonded to a thin carcass. With q = κ h, c = cosh q, s = sinh q,
E0 of the bottom cover, and displacements (u_x, -i u_y), a cover whose other face is free answers at the carcass with
the impedance, in units of 2 E0 κ/3,

    Z = g/(c² + q²) [[s c + q, ±q²], [±q², s c - q]],    g = E*/E0,    + above the carcass, - below;

the carcass adds 3/2 diag(K κ, T κ + D κ³)/E0. Held fast there, the bottom cover passes b = (q c, c + q s)/(c² + q²)
of a unit pressure on to the carcass and gives as the confined layer. Both together, by static condensation,

    S = j L_confined + bᵀ (Z_bottom + Z_top + Z_carcass)⁻¹ b:

sums of what gives, nothing cancels, and S → j of the bottom cover exponentially.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_number, require_positive
from conveyor.contact.layers.creep import CreepBatch, CreepSpectrum
from conveyor.contact.layers.layer_models import HALF_SPACE_DEPTH, Creep, confined_symbol, sinh_minus_scaled

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_THINNEST = 1e-12  # as of any layer
_BUCKLING_HARMONICS = 400  # checked for buckling, the first one by one, then evenly in ln m


@dataclass(frozen=True)
class BeltSupport:
    """A belt over the rolls: covers of rubber on a carcass with tension, bending and in-plane stiffness.

    All of it per width, E0 the rubbery modulus of the bottom cover, k = 2π/λ. Both covers are incompressible.

    Parameters
    ----------
    bottom : float
        k h1, thickness of the cover that runs on the rolls [-].
    top : float
        k h2, of the other cover [-]; zero for none.
    top_creep : CreepSpectrum
        Normalised creep of the top cover, ζ_t = V τ_t k.
    top_modulus : float
        Rubbery modulus of the top cover over E0 [-].
    tension : float
        (T - m_b V²) k/E0 [-]; negative down to where the belt buckles.
    bending : float or complex
        D k³/E0 [-]; D' + i D'' with D'' ≥ 0 loses energy in the carcass.
    stretching : float
        K k/E0, in-plane stiffness [-].

    Raises
    ------
    InputError
        A value outside its range, or a compression under which the belt buckles.

    Examples
    --------
    >>> rubber = CreepSpectrum(0.1, [0.9], [0.01])
    >>> belt = BeltSupport(0.0314, 0.0157, rubber, 0.75, tension=0.05, bending=3e-4, stretching=50)
    >>> belt.symbol(np.array([1.0, 100.0]), rubber).real.round(3).tolist()
    [13.237, 0.499]
    """

    bottom: float
    top: float
    top_creep: CreepSpectrum
    top_modulus: float
    tension: float
    bending: complex = 0.0
    stretching: float = 0.0

    def __post_init__(self) -> None:
        require(isinstance(self.top_creep, CreepSpectrum), "top_creep", self.top_creep, "a CreepSpectrum")
        require_number(bottom=self.bottom, top=self.top, stretching=self.stretching)
        require_number(top_modulus=self.top_modulus, tension=self.tension)
        require(_THINNEST <= self.bottom < math.inf, "bottom", self.bottom, f">= {_THINNEST:g} and finite")
        require_not_negative(top=self.top, stretching=self.stretching)
        require_positive(top_modulus=self.top_modulus)
        require_finite(tension=self.tension)
        if not isinstance(self.bending, complex):
            require_number(bending=self.bending)
        borne = 0.0 <= self.bending.real < math.inf and 0.0 <= self.bending.imag < math.inf
        require(borne, "bending", self.bending, "D' and D'' of the carcass >= 0 and finite")
        if self.tension < 0.0:
            least = self._buckling()
            allowed = f"> {least:.4g}, (T - m_b V²) k/E0 at which the belt buckles"
            require(self.tension > least, "tension", self.tension, allowed)

    @property
    def reach(self) -> float:
        """Wave number beyond which the symbol equals j(m) to rounding [-]."""
        return HALF_SPACE_DEPTH / self.bottom

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        """S_m of the belt whose bottom cover has this creep."""
        j = creep.compliance(m)
        return _belt_symbol(self._numbers, m, j, self.top_creep.compliance(m))

    def losses(self, m: Array, creep: Creep) -> tuple[Array, Array]:
        """Shares of Im S_m lost in the top cover and in the carcass, each of shape (k,).

        The power into what lies above a face is κ Im(u · t̄) of its traction t.
        """
        j, j_top = creep.compliance(m), self.top_creep.compliance(m)
        b, z, above = _carcass_impedance(self._numbers, m, j, j_top)
        x, w = _carcass_displacement(z, b)
        xx, xw, ww = above
        moved = xx * np.abs(x) ** 2 + 2.0 * xw * (np.conj(x) * w).real + ww * np.abs(w) ** 2
        carcass: Array = 1.5 * complex(self.bending).imag * m**3 * np.abs(w) ** 2
        top: Array = -moved.imag
        return top, carcass

    @property
    def _numbers(self) -> _BeltParameters:
        return _BeltParameters(
            np.array(self.bottom),
            np.array(self.top),
            np.array(self.top_modulus),
            np.array(self.tension),
            np.array(complex(self.bending).conjugate()),  # loss is Im j > 0, so Im of a modulus is negative
            np.array(self.stretching),
        )

    def _buckling(self) -> float:
        """Largest compression of the relaxed belt, as a negative tension; a carcass without bending bears none."""
        stiffness = complex(self.bending).real
        if stiffness == 0.0:
            return 0.0
        # covers and bending at rest; beyond, bending alone holds
        highest = max(10.0, 2.0 * math.sqrt(-self.tension / stiffness))
        m = np.unique(np.concatenate([np.arange(1.0, 101.0), np.geomspace(1.0, highest, _BUCKLING_HARMONICS)]))
        numbers = self._numbers
        one = np.ones(m.size, dtype=complex)
        _, (xx, xw, ww), _ = _carcass_impedance(numbers, m, one, one)
        held = (ww - np.where(xx != 0.0, xw * xw / np.where(xx != 0.0, xx, 1.0), 0.0)).real / (1.5 * m)
        return self.tension - float(held.min())


@dataclass(frozen=True, eq=False)
class _BeltParameters:
    """Parameters of one belt or of several, each of shape () or (b, 1)."""

    bottom: Array
    top: Array
    top_modulus: Array
    tension: Array
    bending: ComplexArray
    stretching: Array

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int_]) -> _BeltParameters:
        return _BeltParameters(*(getattr(self, name)[chosen] for name in self.__dataclass_fields__))


@dataclass(frozen=True, eq=False)
class BeltBatch:
    """Batch of belts (internal to the solver)."""

    numbers: _BeltParameters
    top_creeps: CreepBatch

    @classmethod
    def of(cls, belts: list[BeltSupport]) -> BeltBatch:
        """Stack belts."""
        numbers = [belt._numbers for belt in belts]  # noqa: SLF001
        names = _BeltParameters.__dataclass_fields__
        stacked = _BeltParameters(*(np.array([[getattr(n, name)] for n in numbers]) for name in names))
        return cls(stacked, CreepBatch.of([belt.top_creep for belt in belts]))

    def reach(self, depth: float) -> Array:
        """Wave numbers beyond q = m k h1 = `depth`, shape (b,)."""
        reach: Array = depth / self.numbers.bottom[:, 0]
        return reach

    def symbol(self, m: Array, j: ComplexArray) -> ComplexArray:
        """S_m of bottom covers of compliance j(m), shape (b, k)."""
        return _belt_symbol(self.numbers, m, j, self.top_creeps.compliance(m))

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int_]) -> BeltBatch:
        return BeltBatch(self.numbers[chosen], self.top_creeps[chosen])


_Matrix = tuple[ComplexArray, ComplexArray, ComplexArray]  # xx, xw, ww of a symmetric one


def _cover_impedance(q: Array, modulus: ComplexArray, side: float) -> _Matrix:
    """Impedance at the carcass of a cover whose other face is free; `side` is 1 above, -1 below."""
    decay = np.exp(-2.0 * q)
    twice_sum = -0.5 * np.expm1(-4.0 * q) + 2.0 * q * decay  # 2 (s c + q) e^{-2q}
    unit = modulus / (0.5 * (1.0 + decay) ** 2 + 2.0 * q * q * decay)
    return unit * twice_sum, unit * (2.0 * side * q * q * decay), unit * sinh_minus_scaled(2.0 * q, decay)


def _carcass_impedance(
    belt: _BeltParameters, m: Array, j: ComplexArray, j_top: ComplexArray
) -> tuple[tuple[Array, Array], _Matrix, _Matrix]:
    """Share b of the pressure on the carcass, total impedance there, impedance of the top cover."""
    q = m * belt.bottom
    once, decay = np.exp(-q), np.exp(-2.0 * q)
    unit = once / (0.25 * (1.0 + decay) ** 2 + q * q * decay)
    up, down = 0.5 * (1.0 + decay), -0.5 * np.expm1(-2.0 * q)
    b = (unit * q * up, unit * (up + q * down))
    below = _cover_impedance(q, 1.0 / j, -1.0)
    above = _cover_impedance(m * belt.top, belt.top_modulus / j_top, 1.0)
    carcass = (1.5 * m * belt.stretching, 0.0, 1.5 * m * (belt.tension + belt.bending * m * m))
    z = (below[0] + above[0] + carcass[0], below[1] + above[1], below[2] + above[2] + carcass[2])
    return b, z, above


def _carcass_displacement(z: _Matrix, b: tuple[Array, Array]) -> tuple[ComplexArray, ComplexArray]:
    """Displacement of the carcass under b, by eliminating the stiffer, in-plane direction."""
    xx, xw, ww = z
    bent = xw / xx
    w = (b[1] - bent * b[0]) / (ww - bent * xw)
    return b[0] / xx - bent * w, w


def _belt_symbol(belt: _BeltParameters, m: Array, j: ComplexArray, j_top: ComplexArray) -> ComplexArray:
    """S_m, shape of m."""
    b, z, _ = _carcass_impedance(belt, m, j, j_top)
    x, w = _carcass_displacement(z, b)
    symbol: ComplexArray = j * confined_symbol(m * belt.bottom) + (b[0] * x + b[1] * w)
    return symbol
