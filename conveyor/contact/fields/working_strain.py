"""Working strain of many contacts at once, as by `interior`, where one roll does not influence the next.

The sum over the harmonics of a period is then the integral over all wave numbers, and in units of the half width its
nodes are the same for every contact: Bessel functions and turns are tables, and contacts differ in their layer, creep
and pressure alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import special

from conveyor.contact.fields.interior import interior, path_amplitude
from conveyor.contact.fields.interior_harmonics import (
    FAR_END,
    HARMONICS_PER_POINT,
    NEAR_FIELD,
    OCTAVE_SHARE,
    WINDOW_MIDDLE,
    WINDOW_RAMP,
    InteriorHarmonics,
)
from conveyor.contact.galerkin.bessel import bessel_j
from conveyor.contact.galerkin.order_tail import DENSE_ORDER
from conveyor.contact.layers.creep import CreepBatch
from conveyor.contact.layers.layer_models import Confined, confined_symbol
from conveyor.contact.layers.layer_shapes import incompressible_shapes
from conveyor.contact.solution import ContactSolution

Array = NDArray[np.float64]

ISOLATED_UP_TO: Final = 0.4
"""Thickness k h of an incompressible bonded layer up to which the next roll changes strains by less than 1e-3: four
(h/λ)³, as for friction (`conveyor.indentation.SPACING_INFLUENCE`)."""
_PATH_REACH: Final = 1.2
"""Thicknesses from the roll's axis to which a particle's path is sampled: the rest changes it by 3e-4."""
_GRADED_EDGES: Final = (0.0, 0.02, 0.1, 0.4, 1.2)
"""Edges of panels in m α, where the strain rises from nothing as (m h)²."""
_LONGEST: Final = 0.64
"""First edge times 2^octaves at most: a thickness is 5/3 2^octaves half widths at most, so that m h is 1 at most."""
_STEP: Final = 5.0  # from a finer edge to the next
_PHASE: Final = 12.0  # radians a panel at most, pressure and place together: 8 Gauss nodes integrate them to 1e-5
_GAUSS: Final = 8
_DECAY_DEPTH: Final = 16.0
"""Wave number times depth from which on a harmonic leaves 2e-6 of what it is at the surface."""
_DEPTHS_AT_ONCE: Final = 4  # depths whose harmonics are cut at once
_CHUNK: Final = 16  # contacts at once: few enough for the cache, many enough for the calls


class _Waves(NamedTuple):
    """Wave numbers u = m α, their weights, the window, cosines and sines of the turns u x/α."""

    u: Array
    weights: Array
    window: Array
    cos: Array
    sin: Array


def _wave_rule(x: Array, end: float, octaves: int) -> _Waves:
    """Quadrature for places x/α, shape (nx,), of layers that reach so many octaves, windowed to end at u = `end`."""
    span = float(np.abs(x).max())
    edges = np.concatenate([_graded_edges(octaves, end), [end]])
    panels = np.ceil(np.diff(edges) * (1.0 + span) / _PHASE).astype(int)
    pieces = [
        np.linspace(low, high, count, endpoint=False)
        for (low, high), count in zip(pairwise(edges), panels, strict=True)
    ]
    edges = np.concatenate([*pieces, [end]])
    at, gauss = np.polynomial.legendre.leggauss(_GAUSS)
    half = 0.5 * np.diff(edges)[:, None]
    u = (edges[:-1, None] + half * (at + 1.0)).ravel()
    turn = np.multiply.outer(u, x)
    window = 0.5 * special.erfc((u / end - WINDOW_MIDDLE) / WINDOW_RAMP)
    return _Waves(u, (half * gauss).ravel(), window, np.cos(turn), np.sin(turn))


def _graded_edges(octaves: int, end: float) -> Array:
    """Edges of panels from 0 to below `end`, finer near 0 for thicker layers."""
    edges = [*_GRADED_EDGES]
    while edges[1] > _LONGEST * 0.5**octaves:
        edges[1:1] = [edges[1] / _STEP]
    return np.array([edge for edge in edges if edge < end])


@lru_cache(maxsize=16)
def _wave_tables(points: int, octaves: int) -> tuple[_Waves, ...]:
    """Waves for the places within two half widths, and for each octave beyond on either side."""
    end = HARMONICS_PER_POINT * points
    tables = [_wave_rule(np.linspace(-NEAR_FIELD, NEAR_FIELD, points + 1), end, octaves)]
    steps = max(2, points // OCTAVE_SHARE)
    for octave in range(octaves):
        begin = NEAR_FIELD * 2.0**octave
        away = begin * 2.0 ** np.linspace(0.0, 1.0, steps + 1)[1:]
        tables.append(_wave_rule(np.concatenate([-away, away]), min(end, FAR_END / (begin - 1.0)), octaves))
    return tuple(tables)


@lru_cache(maxsize=32)
def _bessel_tables(order: int, points: int, octaves: int) -> tuple[Array, ...]:
    """v/2 J_v(u) of v = 1 … order with the signs of (-i)^(v-1), shape (order, k), at the nodes of every table."""
    v = np.arange(1, order + 1)
    signed = 0.5 * v * np.where((v - 1) % 4 < 2, 1.0, -1.0)
    return tuple(signed[:, None] * bessel_j(order, waves.u)[1:] for waves in _wave_tables(points, octaves))


def working_strains(
    solutions: Sequence[ContactSolution], *, depths: int = 16, points: int = 48
) -> list[tuple[float, float]]:
    """Working strain [-] and wave number m of the dissipation [-] of solved contacts, as by `interior`.

    Parameters
    ----------
    solutions : sequence of ContactSolution
        Contacts with loss.
    depths, points : int
        As of `interior` [-].

    Returns
    -------
    list of tuple of float
        In their order; contacts that are not isolated from the next roll are computed one by one.

    Raises
    ------
    InputError, NoSolutionError
        As `interior`.
    """
    strains_of: dict[int, tuple[float, float]] = {}
    plain: dict[tuple[int, int], list[int]] = {}
    for i, solution in enumerate(solutions):
        if _is_isolated(solution):
            plain.setdefault((solution.stats.order, _path_octaves(solution)), []).append(i)
        else:
            one = interior(solution, depths=depths, points=points)
            strains_of[i] = one.working_strain, one.wave_number
    for (order, octaves), alike in plain.items():
        tables = list(zip(_wave_tables(points, octaves), _bessel_tables(order, points, octaves), strict=True))
        for start in range(0, len(alike), _CHUNK):
            chosen = alike[start : start + _CHUNK]
            strains = _batch_strains([InteriorHarmonics(solutions[i], points) for i in chosen], tables, depths)
            strains_of.update(zip(chosen, strains, strict=True))
    return [strains_of[i] for i in range(len(solutions))]


def _is_isolated(solution: ContactSolution) -> bool:
    """True for a contact of one strip not influenced by the next roll, of orders within the tables."""
    layer, problem = solution.problem.layer, solution.problem
    return (
        isinstance(layer, Confined)
        and layer.poisson == 0.5
        and layer.thickness <= ISOLATED_UP_TO
        and problem.creep.weights.size > 0
        and 0 < solution.stats.order <= DENSE_ORDER
        and len(solution.patches) == 1
        and NEAR_FIELD * 2.0 ** _path_octaves(solution) * solution.half_width * problem.rho <= 0.5 * math.pi
    )


def _path_octaves(solution: ContactSolution) -> int:
    """Octaves from two half widths to where a particle is at rest."""
    depth = solution.problem.thickness / (solution.half_width * solution.problem.rho)
    return max(math.ceil(math.log2(_PATH_REACH * depth / NEAR_FIELD)), 1)


def _batch_strains(
    inside: list[InteriorHarmonics], tables: list[tuple[_Waves, Array]], depths: int
) -> list[tuple[float, float]]:
    """Working strain and wave number of contacts of one order."""
    strips = [one.strips[0] for one in inside]
    alpha, c = np.array([strip.alpha for strip in strips]), np.array([strip.c for strip in strips])
    creeps = CreepBatch.of([one.problem.creep for one in inside])
    thickness = np.array([one.thickness for one in inside]) / alpha
    z, weights = (np.array(part)[:, 1:-1] for part in zip(*(one.depths(depths) for one in inside), strict=True))
    z = z / alpha[:, None]
    difference: list[Array] = []
    shear: list[Array] = []
    losing = np.empty_like(z)
    for waves, bessel in tables:
        u = waves.u
        q = thickness[:, None] * u
        m = u / alpha[:, None]
        creep = creeps.compliance(m)
        # p̃̂ and dm/m with it: the sum's 2 Σ is 2 ∫ dm
        pressure = np.empty(m.shape, dtype=complex)
        pressure.real = c[:, ::2] @ bessel[::2]
        pressure.imag = -(c[:, 1::2] @ bessel[1::2])
        pressure /= m
        strained = (2.0 * waves.weights * waves.window / alpha[:, None]) * pressure * creep
        first = not difference
        if first:
            square = (waves.weights / alpha[:, None]) * np.abs(pressure) ** 2 * creep.imag
        d, g = np.empty((2, *z.shape, waves.cos.shape[1]))
        for top in range(0, depths, _DEPTHS_AT_ONCE):
            part = slice(top, top + _DEPTHS_AT_ONCE)
            k = int(u.searchsorted(_DECAY_DEPTH / z[:, part].min()))
            height = np.maximum(thickness[:, None] - z[:, part], 0.0)[:, :, None]
            D, T = incompressible_shapes(q[:, None, :k], z[:, part, None] * u[:k], height * u[:k])
            d[:, part] = _field_sum(D, strained[:, :k], waves, k)
            g[:, part] = _field_sum(T, 1j * strained[:, :k], waves, k)
            if first:
                losing[:, part] = ((D * D + T * T) @ (square * m)[:, :k, None])[:, :, 0]
        difference.append(d)
        shear.append(g)
        if first:
            lost = square * confined_symbol(q)
            mean = np.exp(np.sum(lost * np.log(m), axis=1) / lost.sum(axis=1))
    scale = np.array([one.scale for one in inside])[:, None, None]
    d, g = (2.0 * scale * np.concatenate(part, axis=2) for part in (difference, shear))
    d, g = (part.reshape(-1, part.shape[2]) for part in (d, g))
    amplitude = path_amplitude(difference=d, shear=g, dilatation=np.zeros_like(d)).reshape(-1, depths)
    weighed = weights * losing
    strain = np.sum(amplitude * weighed, axis=1) / weighed.sum(axis=1)
    return list(zip(strain.tolist(), mean.tolist(), strict=True))


def _field_sum(shape: Array, wave: NDArray[np.complex128], waves: _Waves, k: int) -> Array:
    """Re Σ shape · wave e^{iux} over the first k wave numbers, shape (b, nz, nx)."""
    return (shape * wave.real[:, None, :]) @ waves.cos[:k] - (shape * wave.imag[:, None, :]) @ waves.sin[:k]
