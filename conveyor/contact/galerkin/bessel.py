"""Bessel tables for the Galerkin matrix, built from ratios so that nothing overflows.

Sources: Abramowitz & Stegun 9.1.27 (J recurrence), 9.6.26 (I, K recurrences); Amos, Math. Comp. 28 (1974) 239
(bounds of I_{v+1}/I_v, used as the start of the backward recurrence).
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

Array = NDArray[np.float64]

_LONGEST_DESCENT = 2
_SMALLEST = 1e-260  # I_v/I_0 whose inverse is within double range
_NEGLIGIBLE = 1e-20  # of the diagonal, whose sum over terms is of the order of one
_UPWARD_FROM = 0.25  # times order²: rounding grows e⁴ upward from there
# sweeps, by differences and by the recurrence: 1e-15 from order 32 on, for every argument
_DIFFERENCE_SWEEPS, _RECURRENCE_SWEEPS = 8, 4
_SMOOTH_FROM = 32  # order from which the ratios are computed so; only tables beyond twice this order use it
_DAMPING_EXPONENT = 24.0  # exponent of the damping: 4e-11 of the start's error, itself below 1e-3


def bessel_j(order: int, x: Array) -> Array:
    """Table of J_0 … J_order.

    Where no argument lies far above the order: J_v = (x/2)^v/v! f_v, f_{v-1} = f_v - (x/2)²/(v(v+1)) f_{v+1} downward
    (stable, and f stays near one for small x), scaled by the larger of J_0 and J_1. Else orders above x come from the
    ratio J_{v+1}/J_v (backward recurrence), orders below x from the forward recurrence. Values may underflow to zero
    but never overflow.

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
    top = float(x.max(initial=0.0))
    # f_start = 1 has no influence where J_start falls below 1e-16 J_order or, for x < order, x²/4v below rounding
    start = max(order + 6, int(top + 6.0 * top ** (1.0 / 3.0)) + 2)
    return (
        _downward_recurrence(order, start, x) if start <= _LONGEST_DESCENT * order + 40 else _ratio_recurrence(order, x)
    )


def nonzero_orders(x: Array, order: int) -> int:
    """Number of orders of J_v(x) that are not zero to rounding, at most `order`."""
    top = float(x.max(initial=0.0))
    return min(order, int(top + 12.0 * math.cbrt(top)) + 24)


def _downward_recurrence(order: int, start: int, x: Array) -> Array:
    half = 0.5 * x
    quarter = half * half
    table = np.empty((start + 1, *x.shape))
    table[start] = 1.0
    np.subtract(1.0, quarter * _recurrence_factors(start)[0], out=table[start - 1])
    work = np.empty_like(x)
    for v, factor in zip(range(start - 1, 0, -1), _recurrence_factors(start)[1:], strict=True):
        np.multiply(quarter, factor, out=work)
        work *= table[v + 1]
        np.subtract(table[v], work, out=table[v - 1])
    table = table[: order + 1]
    first, second = special.j0(x), special.j1(x)
    larger = np.abs(first) > np.abs(second)
    scale = np.where(larger, first, second) / np.where(larger, table[0], half * table[1])
    table[0] *= scale
    for v in range(1, order + 1):
        np.multiply(half, 1.0 / v, out=work)
        scale *= work
        table[v] *= scale
    return table


@lru_cache(maxsize=256)
def _recurrence_factors(start: int) -> list[float]:
    """Factors 1/(v (v+1)) for v = start … 1."""
    return [1.0 / (v * (v + 1.0)) for v in range(start, 0, -1)]


def _ratio_recurrence(order: int, x: Array) -> Array:
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


@lru_cache(maxsize=32)
def _upper_triangle(size: int) -> Array:
    return np.triu(np.ones((size, size)), 1)


class ProductIK:
    """The half-space's Bessel products I_max(b_t) K_min(b_t), to be summed over retardation terms with any weights.

    Parameters
    ----------
    order : int
        Highest order [-], at least 1.
    b : ndarray, shape (k, t)
        Half width over retardation length, α/ζ [-], positive.

    Notes
    -----
    With r_v = I_{v+1}/I_v and k_v = K_{v+1}/K_v: I_v K_v = 1/(b (r_v + k_v)) (Wronskian, A&S 9.6.15) and
    b (r_v + k_v) = 2v + b (r_v + 1/k_{v-1}), so the deficit is δ/(2v (2v + δ)), δ = b (r_v + 1/k_{v-1}).
    I_hi/I_lo = P_hi/P_lo, P_v the product of the ratios r up to v. Where P stays above 1e-260 the sum over terms is a
    matrix product of P_hi and 1/P_lo; for smaller b the products die out within a few diagonals.

    Examples
    --------
    >>> products, _ = ProductIK(2, np.array([[1.0]])).weighted_sums(np.array([1.0]))
    >>> round(float(products[0, 0, 1] / (special.iv(1, 1.0) * special.kv(0, 1.0))), 12)
    1.0
    """

    def __init__(self, order: int, b: Array) -> None:
        r, k = _ratios_ik(order, b)
        twice = 2.0 * np.arange(1.0, order + 1.0)[:, None, None]
        delta = b * (r[1:] + 1.0 / k[:-1])
        self._deficit = delta / (twice * (twice + delta))
        self._diagonal = 1.0 / (b * (r + k))
        self._ratio, self._rise = r, k
        self._high = np.ones_like(r)  # I_v/I_0
        np.cumprod(r[:-1], axis=0, out=self._high[1:])

    def falling_ratios(self, order: int) -> Array:
        """K_v/K_order of v = 0 … order, shape (order + 1, k, t)."""
        ratios = np.ones((order + 1, *self._rise.shape[1:]))
        ratios[:-1] = np.cumprod(1.0 / self._rise[:order][::-1], axis=0)[::-1]
        return ratios

    def weighted_sums(self, weights: Array) -> tuple[Array, Array]:
        """Sums over the terms.

        Parameters
        ----------
        weights : ndarray, shape (t,) or (k, t)
            w_t.

        Returns
        -------
        products : ndarray, shape (k, order + 1, order + 1)
            Off the diagonal Σ_t w_t I_max K_min, max and min of (row, column); on it zero.
        deficit : ndarray, shape (k, order + 1)
            Σ_t w_t [1/(2v) - I_v K_v], free of cancellation for b → 0; entry 0 is zero and has no meaning.
        """
        size, k, _ = self._diagonal.shape
        weights = np.broadcast_to(weights, self._diagonal.shape[1:])
        deficit = np.zeros((k, size))
        deficit[:, 1:] = np.einsum("vkt,kt->kv", self._deficit, weights)
        wide = (self._high[-1] > _SMALLEST).all(axis=0)
        if wide.all():
            low, high = self._diagonal * weights / self._high, self._high
        else:
            high = self._high[..., wide]
            low = self._diagonal[..., wide] * weights[:, wide] / high
        # contiguous, or the product is not left to BLAS
        left, right = np.ascontiguousarray(low.swapaxes(0, 1)), np.ascontiguousarray(high.swapaxes(0, 1))
        upper = (left @ right.swapaxes(1, 2)) * _upper_triangle(size)
        if not wide.all():
            self._add_narrow(upper, weights, ~wide)
        return upper + upper.swapaxes(1, 2), deficit

    def _add_narrow(self, upper: Array, weights: Array, narrow: NDArray[np.bool_]) -> None:
        """The terms of small b, diagonal by diagonal until they are negligible."""
        ratio = self._ratio[..., narrow]
        product = self._diagonal[..., narrow] * weights[:, narrow]
        size = product.shape[0]
        for step in range(1, size):
            product = product[:-1] * ratio[step - 1 : -1]
            along = product.sum(axis=2).T
            at = np.arange(size - step)
            upper[:, at, at + step] += along
            if float(along.max(initial=0.0)) < _NEGLIGIBLE:
                break

    def quadratic(self, weights: Array, c: Array) -> Array:
        """Σ_t w_t [Σ_v (1/(2v) - I_v K_v) c_v² - Σ_{v≠u} c_v c_u I_max K_min over equal parity], shape (k,).

        `weights` as in `weighted`, c of shape (k, order) for v = 1 … order.
        """
        factors = np.ascontiguousarray(c.T)[:, :, None]
        total = (self._deficit * (factors * factors)).sum(axis=0)
        ratio, order = self._ratio, c.shape[1]
        beyond = [np.zeros(ratio.shape[1:])] * 2  # Σ_{u>v} c_u I_u/I_v of equal parity, of v + 2 and v + 1
        for v in range(order - 2, 0, -1):
            here = ratio[v] * ratio[v + 1]
            here *= factors[v + 1] + beyond[0]
            beyond = [beyond[1], here]
            total -= (2.0 * factors[v - 1]) * self._diagonal[v] * here
        sums: Array = (total * weights).sum(axis=1)
        return sums


def _ratios_ik(order: int, b: Array) -> tuple[Array, Array]:
    """I_{v+1}/I_v and K_{v+1}/K_v of v = 0 … order at b, shape (order + 1, ...) each."""
    if order <= 2 * _SMOOTH_FROM:
        return _ratio_i(order, b), _ratio_k(order, b)
    upper, lower = neighbour_ratios(_SMOOTH_FROM, order, b.ravel())
    r, k = np.empty((2, order + 1, *b.shape))
    r[_SMOOTH_FROM:], k[_SMOOTH_FROM:] = upper.reshape(-1, *b.shape), 1.0 / lower.reshape(-1, *b.shape)
    r[:_SMOOTH_FROM], k[:_SMOOTH_FROM] = _ratio_i(_SMOOTH_FROM - 1, b), _ratio_k(_SMOOTH_FROM - 1, b)
    return r, k


def _ratio_k(order: int, b: Array) -> Array:
    """K_{v+1}(b)/K_v(b) by the recurrence upward, shape (order + 1, ...)."""
    out = np.empty((order + 1, *b.shape))
    out[0] = last = special.k1e(b) / special.k0e(b)
    steps = np.multiply.outer(np.arange(1.0, order + 1.0), 2.0 / b)
    for v in range(1, order + 1):
        np.add(np.reciprocal(last), steps[v - 1], out=out[v])
        last = out[v]
    return out


def _ratio_i(order: int, b: Array) -> Array:
    """I_{v+1}(b)/I_v(b), shape (order + 1, ...).

    Continued fraction downward from Amos' bound, whose error is damped by (I_start/I_order)² = exp(-(start²-order²)/b);
    where b is so large that this takes long, the recurrence upward from I_1/I_0, which grows rounding by
    exp(order²/b) only.
    """
    far = max(_UPWARD_FROM * order * order, 1.0)
    upward = b > far
    longest = float(b[~upward].max(initial=0.0))
    start = order + 6 + int(np.sqrt(order * order + _DAMPING_EXPONENT * longest) - order)
    two_over_b = 2.0 / b
    r = b / (start + 0.5 + np.hypot(start + 1.5, b))
    out = np.empty((order + 1, *b.shape))
    work = np.empty_like(b)
    for v in range(start, 0, -1):
        if v <= order:
            out[v] = r
        np.multiply(two_over_b, v, out=work)
        work += r
        np.reciprocal(work, out=r)
    out[0] = r
    if upward.any():
        step = two_over_b[upward]
        rising = special.i1e(b[upward]) / special.i0e(b[upward])
        out[0][upward] = rising
        for v in range(1, order + 1):
            rising = 1.0 / rising - v * step
            out[v][upward] = rising
    return out


def neighbour_ratios(first: int, last: int, b: Array) -> tuple[Array, Array]:
    """I_{v+1}/I_v and K_v/K_{v+1} of the orders `first` … `last`, at least 16, without a loop over them.

    Both solve a recurrence r_{v-1} (2v/b + r_v) = 1, h_v (2v/b + h_{v-1}) = 1 whose solution is smooth in v: with the
    neighbour's difference from the sweep before, each equation is a quadratic of its own, and a sweep gains a factor
    of v. The recurrence itself takes the last digits where b < v.

    Parameters
    ----------
    first, last : int
        Orders [-].
    b : ndarray, shape (t,)
        Arguments [-], positive.

    Returns
    -------
    tuple of ndarray, shape (last - first + 1, t)

    Examples
    --------
    >>> from scipy import special
    >>> upper, lower = neighbour_ratios(40, 40, np.array([3.0]))
    >>> round(float(upper[0, 0] / (special.iv(41, 3.0) / special.iv(40, 3.0))), 12)
    1.0
    """
    spare = _DIFFERENCE_SWEEPS + _RECURRENCE_SWEEPS
    v = np.arange(first - spare, last + spare + 1.0)[:, None]
    rise = 2.0 * v / b
    upper = b / (v + 0.5 + np.hypot(v + 1.5, b))
    lower = b / (v - 0.5 + np.hypot(v + 0.5, b))
    for sweep in range(1, _DIFFERENCE_SWEEPS + 1):
        change, step = upper[:-1] - upper[1:], rise[sweep:]
        upper = _positive_root(step + change, 1.0 - change * step)
        lower = _positive_root(step + (lower[:-1] - lower[1:]), 1.0)
    for sweep in range(_RECURRENCE_SWEEPS):
        upper = 1.0 / (rise[_DIFFERENCE_SWEEPS + 1 : upper.shape[0] + _DIFFERENCE_SWEEPS] + upper[1:])
        lower = 1.0 / (rise[_DIFFERENCE_SWEEPS + 1 + sweep :] + lower[:-1])
    count = last - first + 1
    return upper[_RECURRENCE_SWEEPS : _RECURRENCE_SWEEPS + count], lower[:count]


def _positive_root(linear: Array, constant: Array | float) -> Array:
    """Positive root of x² + linear x = constant."""
    root: Array = 2.0 * constant / (linear + np.sqrt(linear * linear + 4.0 * constant))
    return root
