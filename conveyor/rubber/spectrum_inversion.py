"""Exact inversion of relaxation or retardation spectra: the roots that interlace with their poles."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import NoSolutionError

MAX_ITERATIONS = 100
"""Quadratic convergence: 5-12 steps are usual, 23 the most seen in 20 000 random spectra."""
ROUNDING_PER_TERM = 4.0
"""A sum of n terms of one sign, each with a few roundings, is right to about 4 n machine epsilons."""


def invert_spectrum(
    constant: ArrayLike, weights: FloatArray, times: FloatArray, *, reciprocal: bool = False
) -> tuple[FloatArray, FloatArray]:
    r"""Zeros and residues of the inverse of ``constant + sum_j weights_j s t_j/(1 + s t_j)``, vectorised.

    `constant` has the shape of `weights` and `times` without its last axis, which is that of the terms.

    Notes
    -----
    With s = -1/L the roots solve ``1 = sum_j g_j t_j/(L - t_j)``, ``g_j = weights_j/constant``: one root
    between consecutive poles, one above the last. In interval i unknown are the distance z from the
    lower pole and w from the upper one, both in units of t_i, so every difference is a sum of two
    positive numbers and a root 1e-30 from its pole keeps all its digits. Each step replaces the sums over
    lower and upper poles by ``p + q/z`` and ``s + t/w`` of equal value and slope and solves the resulting
    quadratic: quadratically convergent, always inside the interval.

    The residues follow from the roots alone, as for ``(1/constant) prod_j (1 + s t_j)/(1 + s L_j)``. They are then
    exact for the roots found, and a rounding of a root by eps moves the inverse by eps at every s. Formed
    from the weights instead, two roots that crowd one weak pole lose half the digits of their split.

    References
    ----------
    M. Gu, S. C. Eisenstat, SIAM J. Matrix Anal. Appl. 15 (1994) 1266-1276 (weights recomputed from the roots).
    R.-C. Li, "Solving secular equations stably and efficiently", LAPACK Working Note 89 (1993), section 3.
    """
    if weights.shape[-1] == 0:
        return np.empty(weights.shape), np.empty(weights.shape)
    whole = np.asarray(constant, dtype=float)[..., None]
    ratio, gap = _pole_geometry(times, reciprocal=reciprocal)
    if reciprocal:
        weights = weights[..., ::-1]
    n = weights.shape[-1]
    g = ratio * (weights / whole)[..., None, :]
    lower = np.tri(n, dtype=np.bool_)
    offset, span, z, w = _start_values(ratio, gap, g, lower)
    g_low, g_up = np.where(lower, g, 0.0), np.where(lower, 0.0, g)
    g_low_offset, g_up_offset = g_low * offset, g_up * offset
    tolerance = ROUNDING_PER_TERM * n * float(np.finfo(np.float64).eps)
    settled = np.zeros(whole.shape, dtype=np.bool_)
    for _ in range(MAX_ITERATIONS):
        inverse_square = 1.0 / np.square(np.where(lower, z[..., None], w[..., None]) + offset)
        p, low = (g_low_offset * inverse_square).sum(-1), (g_low * inverse_square).sum(-1) * z
        s, up = (g_up_offset * inverse_square).sum(-1), (g_up * inverse_square).sum(-1) * w
        residual, size = (1.0 + s + up) - (p + low), (1.0 + s + up) + (p + low)
        nearer = _solve_quadratic(1.0 + s - p, low * z, up * w, span)
        z, w = (np.where(settled, old, new) for old, new in zip((z, w), nearer, strict=True))
        settled = settled | np.all(np.abs(residual) <= tolerance * size, axis=-1, keepdims=True)
        if settled.all():
            break
    else:
        raise NoSolutionError(
            f"the spectrum could not be inverted in {MAX_ITERATIONS} steps; the weights span"
            f" {np.log10(weights.max() / weights.min()):.0f} decades: drop the terms that do not matter"
        )
    return z, _root_residues(np.where(lower, z[..., None], w[..., None]) + offset, z, ratio, lower) / whole


def _pole_geometry(times: FloatArray, *, reciprocal: bool) -> tuple[FloatArray, FloatArray]:
    """Pole j over pole i, and their difference over pole i, each correctly rounded."""
    if reciprocal:
        t = times[..., ::-1]
        return t[..., :, None] / t[..., None, :], (t[..., :, None] - t[..., None, :]) / t[..., None, :]
    poles, own = times[..., None, :], times[..., :, None]
    return poles / own, (poles - own) / own


def _start_values(
    ratio: FloatArray, gap: FloatArray, g: FloatArray, lower: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Offsets of all poles from the near end of each interval; widths; geometric mid-points as (z, w)."""
    i = np.arange(ratio.shape[-1] - 1)
    step = ratio[..., i, i + 1]
    offset = -gap
    offset[..., :-1, :] = np.where(lower[:-1], offset[..., :-1, :], gap[..., 1:, :] * step[..., None])
    span, z, w = np.empty(ratio.shape[:-1]), np.empty(ratio.shape[:-1]), np.ones(ratio.shape[:-1])
    span[..., :-1] = gap[..., i, i + 1]
    z[..., :-1] = span[..., :-1] / (1.0 + np.sqrt(step))
    w[..., :-1] = np.sqrt(step) * z[..., :-1]
    # above the last pole: g t/(L - t) summed <= sum(g)/z bounds the root; from there the steps descend
    span[..., -1] = z[..., -1] = g[..., -1, :].sum(-1)
    return offset, span, z, w


def _root_residues(
    distance: FloatArray,
    z: FloatArray,
    ratio: FloatArray,
    lower: np.ndarray[tuple[int, ...], np.dtype[np.bool_]],
) -> FloatArray:
    """Residues times the constant; `distance` is |root i - pole j| over pole i."""
    # the pole between two roots splits |root i - root j| into two positive parts: nothing cancels
    between = distance.swapaxes(-1, -2) * ratio
    roots = np.where(lower, z[..., None] + between, distance + z[..., None, :] * ratio)
    every = np.arange(z.shape[-1])
    roots[..., every, every] = 1.0 + z
    return np.asarray(np.prod(distance / roots, axis=-1))


def _solve_quadratic(c: FloatArray, q: FloatArray, t: FloatArray, span: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Solve c + t/w = q/z, z + w = span: both unknowns by the form of the formula without cancellation."""
    cr = c * span
    root = np.hypot(cr + t - q, 2.0 * np.sqrt(q * t))
    b, d = cr + t + q, cr - t - q
    z = np.where(b > 0.0, 2.0 * q * span, b - root) / np.where(b > 0.0, b + root, 2.0 * c)
    w = np.where(d < 0.0, 2.0 * t * span, d + root) / np.where(d < 0.0, root - d, 2.0 * c)
    w[..., -1] = 1.0
    return z, w
