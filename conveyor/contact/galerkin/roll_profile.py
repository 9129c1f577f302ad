"""Chebyshev coefficients of the true circular profile over an eccentric contact.

With X = α s measured from the contact's centre and the roll's axis at X = -ε, t = (X + ε)/ρ: slope
w' = -(1/ρ) t/sqrt(1-t²) (paper, Eq. 9, corrected: u = Δ - R + v(x+e), v = sqrt(R² - x²)).
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


_NEGLIGIBLE = 39.2  # -ln 1e-17: coefficients beyond are rounding
_SPARE_NODES = 4  # Chebyshev nodes beyond the coefficients, against aliasing
_NEAR_SHARE = 0.5  # of ρ: eccentricities up to the rest of it are solved with few coefficients first
_NEWTON_STEPS, _LAST_STEP = 60, 1e-8


@lru_cache(maxsize=256)
def _cosine_transforms(count: int) -> tuple[Array, Array, Array]:
    """Chebyshev nodes s > 0, shape (h,), and transforms to even and odd coefficients, (h, count/2) each."""
    half = (count + count % 2 + _SPARE_NODES) // 2
    angle = (np.arange(half) + 0.5) * (0.5 * np.pi / half)
    transform = np.cos(np.multiply.outer(angle, np.arange(count))) * (-1.0 / half)
    transform[:, 0] *= 0.5
    return np.cos(angle), transform[:, ::2].copy(), transform[:, 1::2].copy()


def _significant_coefficients(nearest: float, count: int) -> int:
    """Number of `count` coefficients that exceed rounding; the slope's branch points lie at |s| = `nearest` > 1.

    Coefficients fall like (|s| + sqrt(s² - 1))^-i (Bernstein).
    """
    rate = math.acosh(max(nearest, 1.0))
    return count if rate * (count - 2) <= _NEGLIGIBLE else max(4, int(_NEGLIGIBLE / rate) + 2)


def _even_and_odd_parts(y: Array, e: Array) -> tuple[Array, Array]:
    """Even and odd part of h(t) = t/sqrt(1-t²) at t = e ± y, times two, and two derivatives by e, (3, b, k) each.

    The even part of a contact almost centred (e → 0) keeps its relative precision.
    """
    t = np.empty((2, y.shape[0], y.shape[1]))
    np.add(e, y, out=t[0])
    np.subtract(e, y, out=t[1])
    c = 1.0 - t * t
    root = 1.0 / np.sqrt(c)
    shape = np.empty((3, *t.shape))
    np.multiply(t, root, out=shape[0])
    np.divide(root, c, out=shape[1])
    # d²h/dt² = 3 t (1-t²)^(-5/2)
    np.multiply(shape[1], 3.0 * t / c, out=shape[2])
    even, odd = shape[:, 0] + shape[:, 1], shape[:, 0] - shape[:, 1]
    # h(y+e) - h(y-e) without cancellation where both have one sign: over their sum, the difference of their squares
    np.divide(4.0 * y * e, c[0] * c[1] * odd[0], out=even[0], where=y > np.abs(e))
    return even, odd


def slope_expansion(alpha: Array, eps: Array, rho: Array | float, count: int) -> Array:
    """T_i coefficients g_i of the slope w'(X) over contacts and its first two derivatives by ε, shape (b, count, 3).

    Parameters
    ----------
    alpha, eps : ndarray, shape (b,)
        Half width and eccentricity [-]; α + |ε| < ρ.
    rho : float or ndarray, shape (b,)
        k R [-].
    count : int
        Number of coefficients.
    """
    radius = np.zeros(alpha.shape) + rho
    few = _significant_coefficients(float(((radius - np.abs(eps)) / alpha).min()), count)
    s, to_even, to_odd = _cosine_transforms(few)
    even, odd = _even_and_odd_parts((alpha / radius)[:, None] * s, (eps / radius)[:, None])
    value = np.zeros((3, alpha.size, count))
    np.matmul(even, to_even, out=value[:, :, :few:2])
    np.matmul(odd, to_odd, out=value[:, :, 1:few:2])
    value[2] /= radius[:, None]  # each derivative by ε is one by t over ρ
    value[1:] /= radius[:, None]
    value /= radius[:, None]
    return value.transpose(1, 2, 0)


def solve_eccentricity(row: Array, alpha: Array, rho: Array | float, start: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Eccentricity from row 0 of the Galerkin equations, Σ_v row_v g_v(ε) = g_0(ε), by a scalar Newton per contact.

    Parameters
    ----------
    row : ndarray, shape (b, n)
        Row 0 times the inverse of rows 1 … n.
    alpha, start : ndarray, shape (b,)
        Half widths and start values of ε [-].
    rho : float or ndarray, shape (b,)
        k R [-].

    Returns
    -------
    eps : ndarray, shape (b,)
    inside : ndarray of bool, shape (b,)
        False where no eccentricity satisfies α + |ε| < ρ.
    """
    radius = np.zeros(alpha.shape) + rho
    room = radius - alpha
    fits = room > 0.0
    room = np.where(fits, room, radius)
    alpha = np.where(fits, alpha, 0.0)
    eps = np.where(np.abs(start) < 0.9 * room, start, np.sign(start) * 0.9 * room)
    count = row.shape[1] + 1
    few = _significant_coefficients(
        float((_NEAR_SHARE * radius / np.maximum(alpha, np.finfo(float).tiny)).min()), count
    )
    root, settled = _newton_eccentricity(row, (alpha, eps, radius), room, few)
    if few < count and not (settled & (np.abs(root) <= (1.0 - _NEAR_SHARE) * radius)).all():
        root, settled = _newton_eccentricity(row, (alpha, eps, radius), room, count)
    return root, settled & fits


def _newton_eccentricity(
    row: Array, place: tuple[Array, Array, Array], room: Array, few: int
) -> tuple[Array, NDArray[np.bool_]]:
    """Newton on the first `few` coefficients, summed once into weights of the transform's nodes."""
    alpha, eps, radius = place
    s, to_even, to_odd = _cosine_transforms(few)
    even_weights = row[:, 1 : few - 1 : 2] @ to_even[:, 1:].T - to_even[:, 0]
    odd_weights = row[:, 0 : few - 1 : 2] @ to_odd.T
    y = (alpha / radius)[:, None] * s
    settled = np.zeros(alpha.size, dtype=bool)
    for _ in range(_NEWTON_STEPS):
        even, odd = _even_and_odd_parts(y, (eps / radius)[:, None])
        miss, rise, _ = (even_weights * even + odd_weights * odd).sum(axis=2)
        rise /= radius
        target = eps - miss / rise
        outside = np.abs(target) >= room
        target = np.where(outside, 0.5 * (eps + np.sign(target) * room), target)
        # a step of 1e-8 leaves its square
        settled = ~outside & (np.abs(target - eps) <= _LAST_STEP * np.abs(target))
        eps = target
        if settled.all():
            break
    return eps, settled


def mean_drop(alpha: Array, eps: Array, rho: Array | float, points: int) -> Array:
    """1 - v_0: T_0 coefficient over the contact of 1 - sqrt(1 - t²) = t²/(1 + sqrt(1 - t²)), shape (b,)."""
    s = np.cos((np.arange(points) + 0.5) * (np.pi / points))
    t2 = ((alpha[:, None] * s + eps[:, None]) / np.broadcast_to(rho, alpha.shape)[:, None]) ** 2
    drop: Array = np.mean(t2 / (1.0 + np.sqrt(1.0 - t2)), axis=1)
    return drop
