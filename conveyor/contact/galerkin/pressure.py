"""Pressure of a strip from its sine series, p̃ = Σ c_v sin(vθ), and its largest value.

Where rubber has loss at every length no order resolves the pressure at the edges: the last coefficients ripple over
the whole strip, by far more than the error of the mean over a wave of them. So the upper half of the series is summed
with weights that fall to zero (those of de la Vallée-Poussin, rounded off). Where every layer is resolved, and the
series falls exponentially, it is summed as it is.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

EDGE_WAVE_FACTOR: Final = 0.05
"""Factor of n²/α: wave number that order n resolves at an edge, where its nodes are 5 α/n² apart."""
_PEAK_STEPS = 8
_CHUNK = 4_000_000
_LARGEST_TABLE = 1 << 16  # entries of a table of sines: a product with it costs no more than a transform
_FAST_FALL = 8.0  # times, from a quarter of the series to the next: powers up to the fifth fall by less


def sine_sum(c: Array, angle: Array) -> Array:
    """Σ_v c_v sin(vθ) at any angles, shape (p,): v = q w + r takes 2 sqrt(n) exponentials an angle in place of n."""
    width = math.isqrt(c.size) + 1
    table = np.zeros((c.size // width + 1, width))
    table.ravel()[1 : c.size + 1] = c
    sums = []
    for part in np.array_split(angle, 1 + angle.size * 2 * width // _CHUNK):
        low = np.exp(1j * np.multiply.outer(part, np.arange(width)))
        high = np.exp(1j * np.multiply.outer(part, width * np.arange(table.shape[0])))
        sums.append(((low @ table.T) * high).sum(axis=1).imag)
    return np.concatenate(sums)


@lru_cache(maxsize=16)
def _sine_table(n: int, count: int) -> Array:
    """Sin(vθ) of v = 1 … n at θ = 0, π/count … π, shape (n, count + 1)."""
    turn = np.outer(np.arange(1, n + 1), np.arange(count + 1)) % (2 * count)
    waves: Array = np.sin(turn * (math.pi / count))
    return waves


def sample_sine_sum(c: Array, count: int) -> Array:
    """Σ_v c_v sin(vθ) at θ = 0, π/count … π, shape (b, count + 1), for c of shape (b, n)."""
    if c.shape[1] * count <= _LARGEST_TABLE:
        return c @ _sine_table(c.shape[1], count)
    waves = np.zeros((c.shape[0], c.shape[1] + 1), dtype=complex)
    waves[:, 1:] = -1j * count * c
    sampled: Array = np.fft.irfft(waves, 2 * count)[:, : count + 1]
    return sampled


def smoothed_coefficients(c: Array) -> Array:
    """Coefficients that the pressure is summed from, shape (b, n) like those of the equations."""
    return np.where(_falls_fast(c)[:, None], c, c * _smoothing_weights(c.shape[1]))


def largest_pressure(c: Array) -> Array:
    """Largest pressure of contacts with coefficients c, shape (b, n): sampled, then Newton on dp/dθ = 0."""
    c = smoothed_coefficients(c)
    n = c.shape[1]
    v = np.arange(1.0, n + 1.0)
    angle = np.linspace(0.0, np.pi, 8 * n + 17)
    sampled = sample_sine_sum(c, 8 * n + 16)
    best = np.argmax(sampled, axis=1)
    theta = angle[best]
    for _ in range(_PEAK_STEPS):
        turn = np.multiply.outer(theta, v)
        first = np.einsum("bv,bv->b", np.cos(turn), v * c)
        second = -np.einsum("bv,bv->b", np.sin(turn), v * v * c)
        curved = second < 0.0
        theta = np.where(curved, theta - first / np.where(curved, second, -1.0), theta)
        theta = np.clip(theta, angle[best] - angle[1], angle[best] + angle[1])
    refined = np.einsum("bv,bv->b", np.sin(np.multiply.outer(theta, v)), c)
    highest: Array = np.maximum(refined, sampled.max(axis=1))
    return highest


def series_tail(c: Array) -> Array:
    """Sum of |c_v| over the last quarter of the series of contacts, shape (b,)."""
    last: Array = np.abs(c[:, -(c.shape[1] // 4) :]).sum(axis=1)
    return last


def _falls_fast(c: Array) -> NDArray[np.bool_]:
    """True where a series falls faster over its last half than a power of the order: it is summed as it is."""
    n = c.shape[1]
    before = np.abs(c[:, n // 2 : n - n // 4]).sum(axis=1)
    return np.asarray(_FAST_FALL * series_tail(c) < before)


@lru_cache(maxsize=32)
def _smoothing_weights(n: int) -> Array:
    """1 up to half of the series, falling like a cosine squared to 0 beyond its end."""
    place = np.arange(1.0, n + 1.0) / (n + 1.0)
    weights: Array = np.cos(np.pi * np.maximum(place - 0.5, 0.0)) ** 2
    return weights
