"""Viscoelastic oracle on a half-plane: rolling over a solid with one retardation time (Hunter 1961).

Creep compliance J(t) = 1/E0 - (1/E0 - 1/E∞) exp(-t/τ), τ the retardation time, n = E∞/E0. Lengths are in
units of the half-width a (or of a0, Hertz' half-width at the same load and E0); pressures in units of
p0 = E0' a/(2R). In the contact the pressure obeys p - (Vτ/n) p' = q with q the elastic solution for the slope
s + e/a - Vτ/a, and the belt enters at s = +1.

References
----------
Hunter, S. C. (1961), The rolling contact of a rigid cylinder with a viscoelastic half space, J. Appl. Mech.
28, 611-617.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar
from scipy.special import i0e, i1e, ive, k0e, k1e

from conveyor.arguments.limits import require

Array = NDArray[np.float64]

_DIRECT_I2: Final = 2.0  # below, I2 = I0 - 2 I1/β cancels; above, the library loses I2 in the end
_LONGEST_MEMORY: Final = 1e150  # beyond, products with K1(γ) ≈ 1/γ overflow
_GAUSS: Final = 16  # points per panel: panels halve toward the node, the integrand is entire between
_LOG_TOLERANCE: Final = 1e-14  # of ln(Vτ/a), next to rounding


@dataclass(frozen=True, slots=True)
class HunterContact:
    """Rolling contact at a given ratio of memory to contact width.

    Parameters
    ----------
    modulus_ratio : float
        n = E∞/E0 [-].
    memory : float
        Vτ/a [-].
    load_ratio : float
        Load over Hertz' load of the same half-width at E0, P (4 (1-ν²) R)/(π E0 a²) [-], from 1 to n.
    eccentricity : float
        e/a, offset of the contact centre from the cylinder axis [-].
    friction : float
        μ R/a [-].
    """

    modulus_ratio: float
    memory: float
    load_ratio: float
    eccentricity: float
    friction: float

    @property
    def shrinkage(self) -> float:
        """Half-width over Hertz' half-width at the same load and E0, a/a0 [-]."""
        return 1.0 / math.sqrt(self.load_ratio)

    @property
    def memory_at_load(self) -> float:
        """Memory over Hertz' half-width at the same load and E0, Vτ/a0 [-]."""
        return self.memory * self.shrinkage

    @property
    def friction_at_load(self) -> float:
        """μ R/a0 [-]."""
        return self.friction * self.shrinkage

    def pressure(self, s: Array) -> Array:
        """Contact pressure over p0 = E0' a/(2R).

        Parameters
        ----------
        s : ndarray, shape (k,)
            Position from the contact centre over a [-], from -1 (exit) to 1 (entry).

        Returns
        -------
        ndarray, shape (k,)
            p/p0 [-].

        Raises
        ------
        InputError
            A position is outside the contact.

        Notes
        -----
        p = β ∫_s^1 exp(-β (t - s)) q(t) dt with β = n a/(Vτ) and
        q = [L/2 - T_2(t)/2 + (Vτ/a - e/a) t]/sqrt(1-t²), L the load ratio; with t = cos θ a smooth
        integrand, on panels that halve toward t = s.

        Examples
        --------
        >>> hunter(10.0, memory=1.0).pressure(np.array([0.0])).round(5).tolist()
        [1.57509]
        """
        require(bool(np.all(np.abs(s) <= 1.0)), "s", s, ">= -1 and <= 1")
        beta = self.modulus_ratio / self.memory if self.memory > 0.0 else math.inf
        if beta in {0.0, math.inf} or self.modulus_ratio == 1.0:
            return self.load_ratio * np.sqrt(1.0 - s**2)
        depth = 2 + max(0, math.ceil(math.log2(beta)))
        edges = np.concatenate(([0.0], 0.5 ** np.arange(depth, -1, -1)))
        nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
        width = np.diff(edges)[:, None] / 2.0
        fraction = (edges[:-1, None] + width * (nodes + 1.0)).ravel()
        end = np.arccos(s)[:, None]
        theta = end * (1.0 - fraction)
        # cos θ - cos θ_s without cancellation
        drop = 2.0 * np.sin((end + theta) / 2.0) * np.sin(end * fraction / 2.0)
        q = (self.load_ratio - np.cos(2.0 * theta)) / 2.0 + (self.memory - self.eccentricity) * np.cos(theta)
        return beta * end[:, 0] * ((np.exp(-beta * drop) * q) @ (width * weights).ravel())

    def peak_pressure(self) -> float:
        """Largest contact pressure over p0 = E0' a/(2R).

        Returns
        -------
        float
            p_max/p0 [-].

        Examples
        --------
        >>> round(hunter(10.0, memory=0.0).peak_pressure(), 9)
        1.0
        """
        coarse = np.cos(np.linspace(0.0, math.pi, 129))
        best = int(np.argmax(self.pressure(coarse)))
        bounds = (float(coarse[min(best + 1, 128)]), float(coarse[max(best - 1, 0)]))
        peak = minimize_scalar(lambda x: -float(self.pressure(np.array([x]))[0]), bounds=bounds, method="bounded")
        return -float(peak.fun)


def _require_ratio(modulus_ratio: float) -> None:
    ok = 1.0 <= modulus_ratio < math.inf
    require(ok, "modulus_ratio", modulus_ratio, ">= 1 and finite")


def hunter(modulus_ratio: float, *, memory: float) -> HunterContact:
    """Solve the rolling of a cylinder on a half-plane with one retardation time (Hunter 1961).

    With γ = a/(Vτ), β = nγ, I = I_i(β), K = K_i(γ), D = K0 I1 + K1 I0, x = 2 K1 I1 (1/γ - 1/β)/D:
    P/P_Hertz = 1 + x, e/a = K0 I1 (1/γ - 1/β)/D, and
    μ R/a = 1/γ - 1/β - [(K0 I1/β + I0 K1/γ)/D] [1 - 1/(1 + x)].
    Here the last is written without differences, (1/γ - 1/β) [K0 I1 + K1 I2/(1 + x)]/D, which is the same by
    I0 - I2 = 2 I1/β.

    Parameters
    ----------
    modulus_ratio : float
        n = E∞/E0 [-], at least 1.
    memory : float
        Vτ/a [-], from 0 to 1e150, or inf; 0 and inf are the elastic limits at E0 and E∞.

    Returns
    -------
    HunterContact
        Load ratio, eccentricity, friction.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Parabola for the circle: a ≪ R. Bessel functions are exponentially scaled,
    which cancels in every ratio. Two viscoelastic bodies of the same retardation time and modulus ratio:
    the plane compliances (1-ν²)/E0 = (1-ν)/(2 G0) add (`composite_plane_modulus`), and R is the equivalent
    radius, 1/R = 1/R1 + 1/R2.

    Examples
    --------
    >>> c = hunter(10.0, memory=1.0)
    >>> round(c.load_ratio, 6), round(c.eccentricity, 6), round(c.friction, 6)
    (2.026419, 0.358982, 0.575312)
    """
    n = modulus_ratio
    _require_ratio(n)
    ok = 0.0 <= memory <= _LONGEST_MEMORY or memory == math.inf
    require(ok, "memory", memory, f">= 0 and <= {_LONGEST_MEMORY:g}, or inf")
    if n == 1.0 or memory == 0.0 or n / memory == math.inf:
        return HunterContact(n, memory, load_ratio=1.0, eccentricity=0.0, friction=0.0)
    if memory == math.inf:
        return HunterContact(n, memory, load_ratio=n, eccentricity=0.0, friction=0.0)
    gamma, beta = 1.0 / memory, n / memory
    I0, I1, K0, K1 = (float(f) for f in (i0e(beta), i1e(beta), k0e(gamma), k1e(gamma)))
    I2 = float(ive(2, beta)) if beta < _DIRECT_I2 else I0 - 2.0 * I1 / beta
    D = K0 * I1 + K1 * I0
    lag = memory * (n - 1.0) / n  # 1/γ - 1/β
    load_ratio = 1.0 + 2.0 * K1 * I1 * lag / D
    return HunterContact(
        n,
        memory,
        load_ratio=load_ratio,
        eccentricity=K0 * I1 * lag / D,
        friction=lag * (K0 * I1 + K1 * I2 / load_ratio) / D,
    )


def hunter_at_load(modulus_ratio: float, *, memory: float) -> HunterContact:
    """Hunter's contact at fixed load: find Vτ/a from Vτ/a0.

    Parameters
    ----------
    modulus_ratio : float
        n = E∞/E0 [-], at least 1.
    memory : float
        Vτ/a0 [-], a0 Hertz' half-width at the same load and E0; from 0 to 1e140, or inf.

    Returns
    -------
    HunterContact
        Read `shrinkage` (a/a0) and `friction_at_load` (μ R/a0).

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    a/a0 = (P/P_Hertz)^(-1/2) lies between n^(-1/2) and 1, which brackets the root.

    Examples
    --------
    >>> round(hunter_at_load(10.0, memory=1.3495).friction_at_load, 6)
    0.483021
    """
    _require_ratio(modulus_ratio)
    ok = 0.0 <= memory <= _LONGEST_MEMORY / 1e10 or memory == math.inf
    require(ok, "memory", memory, f">= 0 and <= {_LONGEST_MEMORY / 1e10:g}, or inf")
    if modulus_ratio == 1.0 or memory in {0.0, math.inf}:
        return hunter(modulus_ratio, memory=memory)
    target = math.log(memory)

    def excess(log_memory: float) -> float:
        load_ratio = hunter(modulus_ratio, memory=math.exp(log_memory)).load_ratio
        return log_memory - 0.5 * math.log(load_ratio) - target

    # one unit of ln beyond the bracket: rounding must not spoil its signs
    root = brentq(excess, target - 1.0, target + 0.5 * math.log(modulus_ratio) + 1.0, xtol=_LOG_TOLERANCE)
    return hunter(modulus_ratio, memory=math.exp(root))


def hunter_friction_peak(modulus_ratio: float) -> HunterContact:
    """Speed of largest friction at fixed load (Hunter 1961).

    Parameters
    ----------
    modulus_ratio : float
        n = E∞/E0 [-], above 1, at most 1e6.

    Returns
    -------
    HunterContact
        Read `memory_at_load` (Vτ/a0) and `friction_at_load` (μ R/a0).

    Raises
    ------
    InputError
        The ratio is outside its range.

    Notes
    -----
    The maximum is flat: an error of 1e-8 in the friction moves its place by about 1e-4.

    Examples
    --------
    >>> peak = hunter_friction_peak(10.0)
    >>> round(peak.friction_at_load, 6), round(peak.memory_at_load, 4)
    (0.483021, 1.3497)
    """
    require(1.0 < modulus_ratio <= 1e6, "modulus_ratio", modulus_ratio, "> 1 and <= 1e6")
    peak = minimize_scalar(
        lambda log_memory: -hunter(modulus_ratio, memory=math.exp(log_memory)).friction_at_load,
        bounds=(math.log(1e-2), math.log(1e2 * modulus_ratio)),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return hunter(modulus_ratio, memory=math.exp(float(peak.x)))


def low_speed_friction(*, memory: float, radius: float, modulus_ratio: float) -> float:
    """Friction of slow rolling on a half-plane, μ → (Vτ/R) (1 - E0/E∞).

    Parameters
    ----------
    memory : float
        Vτ [m], at least 0, much less than the contact half-width.
    radius : float
        R [m], positive.
    modulus_ratio : float
        E∞/E0 [-], at least 1.

    Returns
    -------
    float
        μ [-], independent of load and width.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(low_speed_friction(memory=1e-4, radius=0.1, modulus_ratio=10.0), 12)
    0.0009
    """
    require(0.0 <= memory < math.inf, "memory", memory, ">= 0 and finite")
    require(0.0 < radius < math.inf, "radius", radius, "> 0 and finite")
    _require_ratio(modulus_ratio)
    return memory / radius * (1.0 - 1.0 / modulus_ratio)
