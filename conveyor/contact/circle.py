"""Chebyshev coefficients of the true circular profile, seen from a contact that is off centre.

With X = α s measured from the contact's centre and the roll's axis at X = -ε, t = (X + ε)/ρ: slope
w' = -(1/ρ) t/sqrt(1-t²) (paper, Eq. 9, corrected: u = Δ - R + v(x+e), v = sqrt(R² - x²)).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@lru_cache(maxsize=64)
def _cosines(count: int, half: int) -> tuple[Array, Array]:
    """Chebyshev nodes s > 0, shape (half,), and the cosine transform, shape (count, half)."""
    angle = (np.arange(half) + 0.5) * (0.5 * np.pi / half)
    transform = np.cos(np.multiply.outer(np.arange(count), angle)) * (2.0 / half)
    transform[0] *= 0.5
    return np.cos(angle), transform


def slope_coefficients(alpha: Array, eps: Array, rho: float, count: int) -> tuple[Array, Array]:
    """T_i coefficients of the slope w'(X) over the contact, and their derivative by ε.

    Even and odd parts are formed apart, so that a contact almost centred (ε → 0) keeps the relative precision of
    its even coefficients.

    Parameters
    ----------
    alpha, eps : ndarray, shape (b,)
        Half width and eccentricity [-]; α + |ε| < ρ.
    rho : float
        k R [-].
    count : int
        Number of coefficients.

    Returns
    -------
    ndarray, shape (b, count), twice
        g_i and dg_i/dε.
    """
    s, transform = _cosines(count, count + count % 2 + 8)
    y = alpha[:, None] * s
    e = eps[:, None]
    t1, t2 = (y + e) / rho, (y - e) / rho
    c1, c2 = 1.0 - t1 * t1, 1.0 - t2 * t2
    h1, h2 = t1 / np.sqrt(c1), t2 / np.sqrt(c2)
    # h1 - h2 without cancellation where both have one sign: (h1² - h2²)/(h1 + h2)
    same = y > np.abs(e)
    total = np.where(same, h1 + h2, 1.0)
    even = np.where(same, 4.0 * y * e / (rho * rho * c1 * c2 * total), h1 - h2)
    odd = h1 + h2
    d1, d2 = c1**-1.5 / rho, c2**-1.5 / rho
    scale = -0.5 / rho
    value = np.empty((alpha.size, count))
    slope = np.empty((alpha.size, count))
    for start, part, change in ((0, even, d1 + d2), (1, odd, d1 - d2)):
        kernel = transform[start::2].T * scale
        value[:, start::2] = part @ kernel
        slope[:, start::2] = change @ kernel
    return value, slope


def mean_drop(alpha: Array, eps: Array, rho: float, points: int) -> Array:
    """1 - v_0: T_0 coefficient over the contact of 1 - sqrt(1 - t²) = t²/(1 + sqrt(1 - t²)), shape (b,)."""
    s = np.cos((np.arange(points) + 0.5) * (np.pi / points))
    t2 = ((alpha[:, None] * s + eps[:, None]) / rho) ** 2
    drop: Array = np.mean(t2 / (1.0 + np.sqrt(1.0 - t2)), axis=1)
    return drop
