"""Stress inside a layer under a harmonic pressure: plane strain, one wave number at a time.

Every harmonic p̂_m e^{imX} of the pressure is a plane-strain layer problem of wave number one in y = m k z (depth),
t = m k (h - z) (height above the far face), q = y + t. With A = 2(1-ν), B = 1-2ν, κ = 3-4ν, C, S = cosh, sinh q and
c, s = cosh, sinh t its Airy stress function gives, per unit pressure,

    D = (σ_xx - σ_zz)/2,  T = τ_xz/i,  H = (σ_xx + σ_zz)/2,  U = 2G k m u_z      (u_z into the layer)

    half-space  D = T = y e^{-y},  H = -e^{-y},  U = (A + y) e^{-y}
    confined    D = [(AB + q t) cosh y + y (B S c + A C s)]/n,   T = [y (A C c + B S s) - (AB + q t) sinh y]/n,
                H = -[A C c + B S s + q sinh y]/n,   U = [κ (A C + q S) s - t (A C c + B S s) - q t sinh y]/n,
                n = κ C² + B² + q²
    free        D = [y S c - q t cosh y]/n,   T = [y S s + q t sinh y]/n,   H = [q sinh y - S s]/n,
                U = [A S c + q (A C c - B S s) + t (q sinh y - S s)]/n,   n = S² - q²

all evaluated with e^{-2q} and e^{-y} taken out, so that nothing overflows, and without a term 1/(1-2ν).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.layers.layer_models import free_symbol

Array = NDArray[np.float64]
Shapes = tuple[Array, Array, Array, Array]


def half_space_shapes(y: Array, nu: float) -> Shapes:
    """D, T, H, U of a half-space.

    Parameters
    ----------
    y : ndarray
        Depth m k z [-].
    nu : float
        ν [-], in [0, 0.5].
    """
    decay = np.exp(-y)
    return y * decay, y * decay, -decay, (2.0 * (1.0 - nu) + y) * decay


def _hyperbolic_products(q: Array, t: Array) -> tuple[Array, Array, Array, Array]:
    """Four times C c, C s, S c, S s, each times e^{-(q+t)}."""
    high, low = 1.0 + np.exp(-2.0 * q), -np.expm1(-2.0 * q)
    up, down = 1.0 + np.exp(-2.0 * t), -np.expm1(-2.0 * t)
    return high * up, high * down, low * up, low * down


def confined_shapes(q: Array, y: Array, t: Array, nu: float) -> Shapes:
    """D, T, H, U of a layer bonded to a rigid plane.

    Parameters
    ----------
    q, y, t : ndarray
        Thickness, depth and height m k h, m k z, m k (h - z) [-], broadcastable.
    nu : float
        ν [-], in [0, 0.5].
    """
    A, B, kappa = 2.0 * (1.0 - nu), 1.0 - 2.0 * nu, 3.0 - 4.0 * nu
    Cc, Cs, Sc, Ss = _hyperbolic_products(q, t)
    once, twice = np.exp(-2.0 * q), np.exp(-2.0 * t)
    cosh_y, sinh_y = 2.0 * (twice + once), -2.0 * twice * np.expm1(-2.0 * y)
    unit = np.exp(-y) / (kappa * (1.0 + once) ** 2 + 4.0 * (B * B + q * q) * once)
    bent = A * B + q * t
    sum_ = A * Cc + B * Ss
    return (
        (bent * cosh_y + y * (B * Sc + A * Cs)) * unit,
        (y * sum_ - bent * sinh_y) * unit,
        -(sum_ + q * sinh_y) * unit,
        (kappa * (A * Cs + q * Ss) - t * sum_ - q * t * sinh_y) * unit,
    )


def incompressible_shapes(q: Array, y: Array, t: Array) -> tuple[Array, Array]:
    """D and T of an incompressible bonded layer alone, as `confined_shapes` has them at ν = ½, for many depths.

    Parameters
    ----------
    q, y, t : ndarray
        Thickness, depth and height m k h, m k z, m k (h - z) [-], broadcastable.
    """
    high, up, deep = np.exp(-2.0 * q), np.exp(-2.0 * t), np.exp(-y)
    unit = deep / ((1.0 + high) ** 2 + 4.0 * q * q * high)
    bent, slope = 2.0 * q * t, (1.0 + high) * y
    down = up * deep * deep
    return (slope * (1.0 - up) + bent * (up + down)) * unit, (slope * (1.0 + up) - bent * (up - down)) * unit


def free_shapes(q: Array, y: Array, t: Array, nu: float) -> Shapes:
    """D, T, H, U of a layer whose far face carries nothing.

    Parameters
    ----------
    q, y, t : ndarray
        Thickness, depth and height m k h, m k z, m k (h - z) [-], broadcastable.
    nu : float
        ν [-], in [0, 0.5].
    """
    A, B = 2.0 * (1.0 - nu), 1.0 - 2.0 * nu
    Cc, _, Sc, Ss = _hyperbolic_products(q, t)
    once, twice = np.exp(-2.0 * q), np.exp(-2.0 * t)
    cosh_y, sinh_y = 2.0 * (twice + once), -2.0 * twice * np.expm1(-2.0 * y)
    # S² - q² = (S C + q)/L(q) without its cancellation
    unit = np.exp(-y) * free_symbol(q) / (-np.expm1(-4.0 * q) + 4.0 * q * once)
    spread = q * sinh_y - Ss
    return (
        (y * Sc - q * t * cosh_y) * unit,
        (y * Ss + q * t * sinh_y) * unit,
        spread * unit,
        (A * Sc + q * (A * Cc - B * Ss) + t * spread) * unit,
    )
