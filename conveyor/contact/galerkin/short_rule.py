"""Quadrature of the correction for many problems at once, with as few nodes as the contacts resolve.

quadrature.py sums window and panels node by node. Where the contact is narrow, f = F/m turns by a few radians over the
whole window [0, 2 m0] only, so the functional

    Σ_{m≥1} χ S f  -  ∫_0^1 j f dm  +  ∫_1^{2m0} [(1-χ) S - j] f dm

is carried over to K Gauss nodes by interpolation: one weight a node, the symbol's integers, window, poles and decades
of slow retardation terms all inside the weights. On [0, 1] a slow term is integrated exactly against Legendre
polynomials, ∫ P_l/(1-imζ) dm = 2 Q_l(z)/(iζ), z = -1 - 2i/ζ (Neumann's integral, A&S 8.8.3). Beyond the window the
layer's part S - j is left, on Gauss panels of each problem.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from conveyor.contact.galerkin.quadrature import Rule
from conveyor.contact.layers.creep import CreepBatch
from conveyor.contact.layers.layer_batch import LayerBatch
from conveyor.contact.layers.layer_models import PlainLayerBatch
from conveyor.contact.layers.regrid import STENCIL_POINTS, lagrange_stencils, log_grid, regrid_weights

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

WINDOW_CAPS = (0.5, 1.0, 1.5, 2.0, 2.4)
"""Half widths α up to which windows are made: the alias exp(-(w(2π-2α))²/4) requires wider ones."""
NARROW_CAP = WINDOW_CAPS[0]  # where the width below meets it, 1e-17
# Up to a cap: nodes on [0, 1], where f is a polynomial of one degree less to rounding; ζ beyond which Q_l is recurred
# upward, where it loses r^(2·nodes) units of rounding, r = |z + sqrt(z² - 1)| = 1.7, 1.36, z = -1 - 2i/ζ; Gauss points
# of the other terms, r^(nodes - 2·points) = 1e-15
_UNIT_NODES = {True: (10, 7.4, 36), False: (18, 21.5, 64)}


@dataclass(frozen=True)
class RuleGrade:
    """Fineness of a rule: window width w, Gauss points and coarse nodes beyond what the phase needs.

    `stretch` and `phase` limit the panels beyond the window as in quadrature.Panels; `depth` is the q = m k h beyond
    which L = 1 is taken, |L-1| < 4 q² exp(-2q). `error` bounds the error of friction (seen: a quarter of it),
    `other` that under belts and layers of the user's own, whose symbol is no product of j and a layer's own
    (seen: 2.4e-5 loose, 3.0e-8 coarse, of 800 belts).
    The window is one up to m = 1 and zero from its end 2 m0 on: m0 = `ramp` w.
    """

    width: float
    points: int
    spare: int
    stretch: float
    phase: float
    depth: float
    error: float
    other: float
    ramp: float = 6.5  # as in quadrature.py

    def floor(self, layers: LayerBatch) -> float:
        """Error of friction that the rule may leave over such layers."""
        return self.error if isinstance(layers, PlainLayerBatch) else self.other


# to rounding, to 1e-9 and to 1e-7 of the largest entry; the rules of a pair have no node in common
FINE_GRADES = (
    RuleGrade(2.4, 16, 11, 1.7, 14.0, 20.0, 5e-11, 1e-10),
    RuleGrade(2.8, 18, 14, 1.9, 15.0, 20.0, 5e-11, 1e-10),
)
COARSE_GRADES = (
    RuleGrade(2.4, 12, 5, 1.7, 13.0, 13.5, 2e-8, 6e-8),
    RuleGrade(2.8, 13, 6, 1.8, 13.0, 14.0, 2e-8, 6e-8),
)
LOOSE_GRADES = (
    RuleGrade(1.55, 9, 3, 1.7, 10.0, 10.5, 5e-6, 5e-5, 4.6),
    RuleGrade(1.7, 10, 4, 1.8, 10.0, 11.0, 5e-6, 5e-5, 4.6),
)
LOOSE_FROM, COARSE_FROM, FINE_FROM = 1e-4, 1e-7, 1e-10  # rtol down to which the pairs are valid


def rule_grades(rtol: float) -> tuple[RuleGrade, RuleGrade]:
    """Grades of the rules that solve and check to a tolerance."""
    if rtol >= LOOSE_FROM:
        return LOOSE_GRADES
    return COARSE_GRADES if rtol >= COARSE_FROM else FINE_GRADES


@dataclass(frozen=True, eq=False)
class ShortRule:
    """Nodes m and complex weights of F/m for each problem, shape (b, k)."""

    nodes: Array
    weights: ComplexArray

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int_] | slice) -> ShortRule:
        return ShortRule(self.nodes[chosen], self.weights[chosen])


def as_short_rule(rule: Rule) -> ShortRule:
    """Full rule of one problem as a batch of one."""
    return ShortRule(rule.nodes[None], rule.weights[None])


@dataclass(frozen=True, eq=False)
class _Window:
    """Places in the window and their interpolation to K coarse nodes, common to all problems."""

    inner: Array  # integers, then the panels' nodes
    ramp: Array  # χ at the integers
    measure: Array
    rest: Array  # 1-χ at the panels' nodes
    end: float
    coarse: Array
    spread: Array  # (unit + inner, K)


_gauss_rule = lru_cache(maxsize=32)(np.polynomial.legendre.leggauss)


def _window_width(grade: RuleGrade, cap: float) -> float:
    """Width w of the window for contacts up to a cap."""
    return grade.width * (math.pi - NARROW_CAP) / (math.pi - cap)


def _window_panels(grade: RuleGrade, cap: float, end: float) -> Array:
    """Panels of the window from m = 1 on."""
    if cap == NARROW_CAP:
        return np.concatenate([[1.0, 3.0], np.linspace(0.28, 1.0, 4) * end])
    longest = min(grade.phase / (2.0 * cap), 3.0 * _window_width(grade, cap))
    edges = [1.0]
    while edges[-1] < end:
        edges.append(min(edges[-1] + min(math.expm1(grade.stretch) * edges[-1], longest), end))
    return np.array(edges)


@lru_cache(maxsize=64)
def _grade_window(grade: RuleGrade, count: int, cap: float) -> _Window:
    """Window of a grade with `count` coarse nodes, for contacts up to `cap`."""
    width = _window_width(grade, cap)
    centre = grade.ramp * width
    end = float(math.ceil(2.0 * centre))
    integers = np.arange(1.0, end + 1.0)
    x, gauss = _gauss_rule(grade.points)
    edges = _window_panels(grade, cap, end)
    half = 0.5 * np.diff(edges)[:, None]
    panels = (edges[:-1, None] + half * (x + 1.0)).ravel()
    measure = (half * gauss).ravel()
    unit_x, _ = _gauss_rule(_UNIT_NODES[cap == NARROW_CAP][0])
    coarse_x, coarse_gauss = _gauss_rule(count)
    fine = np.concatenate([0.5 * (unit_x + 1.0), integers, panels]) * (2.0 / end) - 1.0
    all_degrees = np.arange(count)
    spread = (special.eval_legendre(all_degrees, fine[:, None]) * (all_degrees + 0.5)) @ (
        special.eval_legendre(all_degrees[:, None], coarse_x) * coarse_gauss
    )
    return _Window(
        inner=np.concatenate([integers, panels]),
        ramp=0.5 * special.erfc((integers - centre) / width),
        measure=measure,
        rest=0.5 * special.erfc((centre - panels) / width),
        end=end,
        coarse=0.5 * end * (coarse_x + 1.0),
        spread=spread,
    )


@lru_cache(maxsize=2)
def _unit_table(unit: int, slow: float, plain: int) -> Array:
    """`_unit_weights` of terms with 1/ζ on the grid of logarithms, real and imaginary parts in turn."""
    return _unit_weights(1.0 / log_grid(), unit, slow, plain).view(float)


def window_cap(half_width: float) -> float:
    """Cap of the window for contacts of this half width; infinite beyond all caps."""
    return next((cap for cap in WINDOW_CAPS if half_width <= cap), math.inf)


def short_rules(
    layers: LayerBatch, creeps: CreepBatch, half_width: Array, grades: Sequence[RuleGrade]
) -> list[ShortRule]:
    """Rules of b problems in each grade, each valid for contacts up to its half width α [-], at most 2.4.

    All problems get as many nodes as the one that needs most: pass similar ones. Times must lie `within`.
    """
    widest = float(half_width.max())
    cap = window_cap(widest)
    windows = [_grade_window(grade, _node_count(grade, cap, widest), cap) for grade in grades]
    panels = _layer_panels(layers, half_width, grades, [window.end for window in windows])
    unit = _UNIT_NODES[cap == NARROW_CAP]
    first, shares = lagrange_stencils(creeps.places)
    low, high = int(first.min()), int(first.max()) + STENCIL_POINTS
    (terms,) = regrid_weights((first - low, shares), high - low, creeps.weights)
    below = (terms @ _unit_table(*unit)[low:high]).view(complex)
    below += creeps.instantaneous[:, None] * (0.5 * _gauss_rule(unit[0])[1])
    inner = np.concatenate([window.inner for window in windows])
    every = _join_nodes(inner, np.concatenate([nodes for nodes, _ in panels], axis=1))
    j = creeps.compliance(every)
    symbol = layers.symbol(every, j)
    rules, start, far = [], 0, inner.size
    for window, (nodes, measure) in zip(windows, panels, strict=True):
        end, cut, last = start + window.inner.size, start + window.ramp.size, far + nodes.shape[1]
        inside = window.measure * (window.rest * symbol[:, cut:end] - j[:, cut:end])
        fine = np.concatenate([-below, window.ramp * symbol[:, start:cut], inside], axis=1)
        # complex @ real would make the real one complex first
        parts = (np.concatenate([fine.real, fine.imag]) @ window.spread) / window.coarse
        weights = np.empty((half_width.size, window.coarse.size + nodes.shape[1]), dtype=complex)
        weights.real[:, : window.coarse.size] = parts[: half_width.size]
        weights.imag[:, : window.coarse.size] = parts[half_width.size :]
        weights[:, window.coarse.size :] = measure * (symbol[:, far:last] - j[:, far:last]) / nodes
        rules.append(ShortRule(_join_nodes(window.coarse, nodes), weights))
        start, far = end, last
    return rules


def _join_nodes(shared: Array, own: Array) -> Array:
    """Common nodes, shape (k,), and those of each problem, shape (b, l), joined to shape (b, k + l)."""
    out = np.empty((own.shape[0], shared.size + own.shape[1]))
    out[:, : shared.size] = shared
    out[:, shared.size :] = own
    return out


def _node_count(grade: RuleGrade, cap: float, widest: float) -> int:
    """Number of coarse nodes: a function that turns ±c radians is a polynomial of degree c + O(c^(1/3))."""
    phase = widest * math.ceil(2.0 * grade.ramp * _window_width(grade, cap))
    steps = 4.0 if cap == NARROW_CAP else 16.0
    return int(steps * math.ceil((phase + 4.0 * phase ** (1.0 / 3.0) + grade.spare) / steps))


def _layer_panels(
    layers: LayerBatch, half_width: Array, grades: Sequence[RuleGrade], ends: Sequence[float]
) -> list[tuple[Array, Array]]:
    """Panels from the windows' ends to the layer's reach; problems with fewer panels get empty ones."""
    reach = np.array([layers.reach(grade.depth) for grade in grades])
    longest = np.multiply.outer([0.5 * grade.phase for grade in grades], 1.0 / half_width)
    growth = np.array([[math.expm1(grade.stretch)] for grade in grades])
    end = np.array(ends)[:, None]
    edges = [np.zeros(reach.shape) + end]
    while (reach > edges[-1]).any():
        edges.append(np.maximum(np.minimum(edges[-1] + np.minimum(growth * edges[-1], longest), reach), end))
    bounds = np.array(edges)
    half = 0.5 * (bounds[1:] - bounds[:-1])
    panels = []
    for k, grade in enumerate(grades):
        x, gauss = _gauss_rule(grade.points)
        count = np.count_nonzero(half[:, k].max(axis=1))
        wide, shape = half[:count, k].T[:, :, None], (half_width.size, count * grade.points)
        nodes = bounds[:count, k].T[:, :, None] + wide * (x + 1.0)
        panels.append((nodes.reshape(shape), (wide * gauss).reshape(shape)))
    return panels


def panel_count(reach: Array, half_width: Array, grade: RuleGrade) -> NDArray[np.int_]:
    """Approximate number of panels of each problem beyond the window, to group similar ones."""
    end = float(math.ceil(2.0 * grade.ramp * grade.width))
    by_phase = np.maximum(reach - end, 0.0) * 2.0 * half_width / grade.phase
    by_stretch = np.log(np.maximum(reach / end, 1.0)) / grade.stretch
    return np.ceil(np.maximum(by_phase, by_stretch)).astype(int)


def _unit_weights(zeta: Array, unit: int, slow: float, plain: int) -> ComplexArray:
    """Weights of ∫_0^1 f/(1-imζ) dm on Gauss nodes of [0, 1], shape (t, unit); ζ of shape (t,)."""
    degrees = np.arange(unit)[:, None]
    x, gauss = _gauss_rule(plain)
    nodes = 0.5 * (x + 1.0)
    moments = (0.5 * gauss * special.eval_legendre(degrees, x)) @ (1.0 / (1.0 - 1j * np.multiply.outer(nodes, zeta)))
    moments[:, zeta > slow] = _legendre_moments(zeta[zeta > slow], unit)
    x, gauss = _gauss_rule(unit)
    return moments.T @ ((2.0 * degrees + 1.0) * special.eval_legendre(degrees, x) * (0.5 * gauss))


def _legendre_moments(zeta: Array, count: int) -> ComplexArray:
    """∫_0^1 P_l(2m-1)/(1-imζ) dm for l < `count` of slow terms, shape (count, ...): upward, 2 Q_l/(iζ)."""
    z = -1.0 - 2.0j / zeta
    out = np.empty((count, *zeta.shape), dtype=complex)
    out[0] = 1j * np.log1p(-1j * zeta) / zeta
    # Q_1 = z Q_0 - 1; in these units Q_0 = first iζ/2, so 1 is 2/(iζ)
    out[1] = z * out[0] - 2.0 / (1j * zeta)
    for level in range(1, count - 1):
        out[level + 1] = ((2 * level + 1) * z * out[level] - level * out[level - 1]) / (level + 1)
    return out
