"""Bessel tables for the Galerkin matrix, built from ratios so that nothing overflows.

Sources: Abramowitz & Stegun 9.1.27 (J recurrence), 9.6.26 (I, K recurrences); Amos, Math. Comp. 28 (1974) 239
(bounds of I_{v+1}/I_v, used as the start of the backward recurrence).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import special

Array = NDArray[np.float64]

_LOG_RANGE = 600.0  # e^600 = 1e260 is within double range
_NEGLIGIBLE = 1e-20  # of the diagonal, whose sum over terms is of the order of one
_LARGEST_SCALED_I = 1e8  # beyond it the uniform start of Amos is exact to 1e-15 and AMOS' `ive` loses digits


def bessel_j(order: int, x: Array) -> Array:
    """Table of J_0 … J_order.

    Orders above x come from the ratio J_{v+1}/J_v (backward recurrence, stable there), orders below x from the
    forward recurrence, so values may underflow to zero but never overflow.

    Parameters
    ----------
    order : int
        Highest order [-], at least 1.
    x : ndarray, shape (...,)
        Arguments [-], positive.

    Returns
    -------
    ndarray, shape (order + 1, ...)
        J_v(x).

    Examples
    --------
    >>> bessel_j(2, np.array([1.0]))[:, 0].round(12).tolist()
    [0.765197686558, 0.440050585745, 0.114903484932]
    """
    flat = x.ravel()
    rank = np.argsort(flat, kind="stable")
    sorted_x = flat[rank]
    two_over_x = 2.0 / sorted_x
    below = np.searchsorted(sorted_x, np.arange(order + 1))  # nodes with x < v: ratio region of order v
    ratio = np.empty((order + 1, sorted_x.size))
    size = int(below[order])
    # turning-point width: 7.5 n^(1/3) orders above n damp the start value by 1e-17
    start = order + int(8.0 * order ** (1.0 / 3.0)) + 2
    r = 1.0 / ((start + 1) * two_over_x[:size])
    for v in range(start, 0, -1):
        if v <= order:
            size = int(below[v])
            r = r[:size]
            ratio[v, :size] = r
        r = 1.0 / (v * two_over_x[:size] - r)
    table = np.empty((order + 1, sorted_x.size))
    table[0] = special.j0(sorted_x)
    table[1] = special.j1(sorted_x)
    for v in range(1, order):
        k = int(below[v])
        np.multiply(table[v, :k], ratio[v, :k], out=table[v + 1, :k])
        table[v + 1, k:] = v * two_over_x[k:] * table[v, k:] - table[v - 1, k:]
    out = np.empty_like(table)
    out[:, rank] = table
    return out.reshape((order + 1, *x.shape))


def product_ik(order: int, b: Array, weights: Array) -> tuple[Array, Array]:
    """Weighted sum over retardation terms of the half-space's Bessel products, Σ_t w_t I_max(b_t) K_min(b_t).

    Parameters
    ----------
    order : int
        Highest order [-], at least 1.
    b : ndarray, shape (k, t)
        Half width over retardation length, α/ζ [-], positive.
    weights : ndarray, shape (t,) or (k, t)
        w_t.

    Returns
    -------
    products : ndarray, shape (k, order + 1, order + 1)
        Off the diagonal Σ_t w_t I_max K_min, max and min of (row, column); on it zero.
    deficit : ndarray, shape (k, order + 1)
        Σ_t w_t [1/(2v) - I_v K_v], free of cancellation for b → 0; entry 0 is zero and has no meaning.

    Notes
    -----
    With r_v = I_{v+1}/I_v and k_v = K_{v+1}/K_v: I_v K_v = 1/(b (r_v + k_v)) (Wronskian, A&S 9.6.15) and
    b (r_v + k_v) = 2v + b (r_v + 1/k_{v-1}), so the deficit is δ/(2v (2v + δ)), δ = b (r_v + 1/k_{v-1}).
    I_hi/I_lo = exp(l_hi - l_lo), l the summed logarithms of r. Where l spans less than 600 the sum over terms is a
    matrix product of exp(l_hi) and exp(-l_lo); for smaller b the products die out within a few diagonals.

    Examples
    --------
    >>> products, _ = product_ik(2, np.array([[1.0]]), np.array([1.0]))
    >>> round(float(products[0, 0, 1] / (special.iv(1, 1.0) * special.kv(0, 1.0))), 12)
    1.0
    """
    r = _ratio_i(order, b)
    k = np.empty((order + 1, *b.shape))
    k[0] = special.k1e(b) / special.k0e(b)
    for v in range(1, order + 1):
        k[v] = 1.0 / k[v - 1] + 2.0 * v / b
    diagonal = 1.0 / (b * (r + k))
    twice = 2.0 * np.arange(1.0, order + 1.0)[:, None, None]
    delta = b * (r[1:] + 1.0 / k[:-1])
    weights = np.broadcast_to(weights, b.shape)
    deficit = np.zeros((b.shape[0], order + 1))
    deficit[:, 1:] = np.einsum("vkt,kt->kv", delta / (twice * (twice + delta)), weights)
    log_i = np.zeros_like(r)
    np.cumsum(np.log(r[:-1]), axis=0, out=log_i[1:])

    wide = (log_i[-1] > -_LOG_RANGE).all(axis=0)
    all_wide = bool(wide.all())
    logs, scaled = (log_i, diagonal) if all_wide else (log_i[..., wide], diagonal[..., wide])
    high = np.exp(logs)
    low = scaled * (weights if all_wide else weights[:, wide]) / high
    upper = np.triu(np.moveaxis(low, 0, 1) @ np.moveaxis(high, 0, 2), 1)
    if not all_wide:
        narrow = diagonal[..., ~wide] * weights[:, ~wide]
        logs = log_i[..., ~wide]
        for step in range(1, order + 1):
            ratio = np.exp(logs[step:] - logs[:-step])
            if float(ratio.max()) < _NEGLIGIBLE:
                break
            at = np.arange(order + 1 - step)
            upper[:, at, at + step] += (narrow[:-step] * ratio).sum(axis=2).T
    return upper + upper.swapaxes(1, 2), deficit


def _ratio_i(order: int, b: Array) -> Array:
    """I_{v+1}(b)/I_v(b), shape (order + 1, ...): backward continued fraction from order + 24."""
    start = order + 24  # damps the start value by (1 + sqrt 2)^-48 = 1e-18 for b <= order
    r = b / (start + 0.5 + np.hypot(start + 1.5, b))
    wide = (b > order) & (b < _LARGEST_SCALED_I)
    if wide.any():
        r[wide] = special.ive(start + 1, b[wide]) / special.ive(start, b[wide])
    out = np.empty((order + 1, *b.shape))
    two_over_b = 2.0 / b
    for v in range(start, 0, -1):
        if v <= order:
            out[v] = r
        r = 1.0 / (v * two_over_b + r)
    out[0] = r
    return out
