"""Nodes and weights of the sum over wave numbers: a closed half-space part and a short correction.

For any summand S(m) F(m)/m whose F oscillates no faster than the contact is wide,

    Σ_{m≥1} S F/m  =  ∫_0^∞ j F/m dm  +  Σ_{m≥1} χ S F/m  +  ∫_0^∞ [(1-χ) S - j] F/m dm,

χ(m) = ½ erfc((m - m0)/w). The first term is the isolated half-space, known in closed form (spectral.py); the sum ends
with the window, the last integral where S = j. Σ (1-χ) S F/m may be read as an integral up to its first Poisson alias,
exp(-(w (2π - span))²/4), because (1-χ) S F/m is smooth on m > 0 and vanishes below m = 1.

For a wide contact on a thin layer F turns faster than a Gauss panel of few nodes can follow up to where S = j. The same
is then summed one by one, with an integral up to the window's end only: Σ [S - (1-χ) j] F/m - ∫ χ j F/m dm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Layer
from conveyor.errors import NoSolutionError

Array = NDArray[np.float64]

_ALIAS = 12.5  # exp(-12.5²/4) = 1e-17
_RAMP = 6.5  # ½ erfc(6.5) = 2e-20: the window is one below m0 - 6.5 w and zero beyond m0 + 6.5 w
_MAX_NODES = 2_000_000


class RuleTooLongError(NoSolutionError):
    """A contact so wide against its layer, or so narrow against the spacing, that the rule would not fit in memory."""


@dataclass(frozen=True)
class Panels:
    """Grading of a composite Gauss-Legendre rule; each limit keeps the panel error near 1e-13.

    `points` per panel; `stretch` is the largest ln(right/left): the poles ±i/ζ lie π/2 off the real axis of ln m;
    `phase` the largest change of phase in radians; `ramps` the largest width in units of the window's width;
    `window` multiplies the window width that the alias needs.
    """

    points: int
    stretch: float
    phase: float
    ramps: float
    window: float = 1.0


SOLVE_PANELS = Panels(points=16, stretch=1.7, phase=14.0, ramps=3.0)
CHECK_PANELS = Panels(points=18, stretch=1.9, phase=15.0, ramps=3.3, window=1.3)  # no node of an integral in common


_gauss_rule = lru_cache(maxsize=8)(np.polynomial.legendre.leggauss)


@dataclass(frozen=True, eq=False)
class Rule:
    """Nodes m, shape (k,), and complex weights of F/m; valid for contacts up to `half_width`.

    `edge` ends the first panel [0, edge], `edge_sum` is the rule's value of ∫ dm/m over it: the displacement's summand
    has a logarithm there that is replaced by its closed form.
    """

    nodes: Array
    weights: NDArray[np.complex128]
    half_width: float
    edge: float
    edge_sum: float


def build_rule(layer: Layer, creep: CreepSpectrum, half_width: float, panels: Panels = SOLVE_PANELS) -> Rule:
    """Nodes and weights valid for every contact of half width up to `half_width` = k a [-].

    Raises
    ------
    RuleTooLongError
        The layer is so thin against the contact that the rule would need more than two million nodes.
    """
    span = 2.0 * half_width
    width = panels.window * _window_width(span)
    centre = _RAMP * width
    ramp_end = 2.0 * centre
    end = max(ramp_end, layer.reach)
    one_by_one = ramp_end < end <= _MAX_NODES and span * panels.points > panels.phase
    integers = np.arange(1.0, math.ceil(end if one_by_one else ramp_end) + 1.0)
    last = ramp_end if one_by_one else end
    edges = _panel_edges(creep, panels, span=span, width=width, end=last, ramp_end=ramp_end)
    x, gauss = _gauss_rule(panels.points)
    logs = np.log(edges[1:])
    half = 0.5 * np.diff(logs)
    beyond = np.exp(logs[:-1, None] + half[:, None] * (x + 1.0))
    m = np.concatenate([0.5 * edges[1] * (x + 1.0), beyond.ravel()])
    measure = np.concatenate([0.5 * edges[1] * gauss, (half[:, None] * gauss * beyond).ravel()])

    kernel = -creep.compliance(m)
    symbol = layer.symbol(integers, creep)
    if one_by_one:
        kernel *= 0.5 * special.erfc((m - centre) / width)
        symbol = symbol - 0.5 * special.erfc((centre - integers) / width) * creep.compliance(integers)
    else:
        sampled = m >= 1.0  # below, 1-χ < 1e-17 would meet a symbol that may grow like m^-3
        inside = m[sampled]
        kernel[sampled] += 0.5 * special.erfc((centre - inside) / width) * layer.symbol(inside, creep)
        symbol = 0.5 * special.erfc((integers - centre) / width) * symbol
    return Rule(
        nodes=np.concatenate([integers, m]),
        weights=np.concatenate([symbol / integers, measure * kernel / m]),
        half_width=half_width,
        edge=float(edges[1]),
        edge_sum=float(np.sum(gauss / (1.0 + x))),
    )


def series_rule(
    layer: Layer, creep: CreepSpectrum, *, span: float, end: float, panels: Panels = SOLVE_PANELS
) -> tuple[Array, NDArray[np.complex128]]:
    """Nodes and weights of the plain sum Σ_{1≤m≤end} S F/m for an F that turns by `span` radians a wave number.

    The same window as `build_rule`, but nothing is taken out in closed form: Σ χ S F/m + ∫ (1-χ) S F/m dm. One by one
    where that is not longer.

    Raises
    ------
    RuleTooLongError
        More than two million nodes.
    """
    width = panels.window * _window_width(span)
    centre = _RAMP * width
    last = max(end, 2.0 * centre)
    edges = _panel_edges(creep, panels, span=span, width=width, end=last, ramp_end=2.0 * centre)
    if last <= 2.0 * centre + panels.points * edges.size:
        m = np.arange(1.0, math.ceil(last) + 1.0)
        return m, layer.symbol(m, creep) / m
    integers = np.arange(1.0, math.ceil(2.0 * centre) + 1.0)
    x, gauss = _gauss_rule(panels.points)
    logs = np.log(edges[1:])
    half = 0.5 * np.diff(logs)
    m = np.exp(logs[:-1, None] + half[:, None] * (x + 1.0))
    measure = (half[:, None] * gauss * m)[m >= 1.0]
    m = m[m >= 1.0]
    window = 0.5 * special.erfc((integers - centre) / width)
    rest = 0.5 * special.erfc((centre - m) / width)
    weights = [window * layer.symbol(integers, creep) / integers, measure * rest * layer.symbol(m, creep) / m]
    return np.concatenate([integers, m]), np.concatenate(weights)


def window_end(span: float) -> float:
    """Wave number up to which the window of `series_rule` takes integers."""
    return 2.0 * _RAMP * _window_width(span)


def _window_width(span: float) -> float:
    return max(2.0, _ALIAS / (2.0 * math.pi - span))


def _panel_edges(
    creep: CreepSpectrum, panels: Panels, *, span: float, width: float, end: float, ramp_end: float
) -> Array:
    """Edges from 0 to `end`, graded toward 0 for the slowest retardation term."""
    slowest = float(creep.times.max(initial=0.0))
    edge = min(1.0, 0.5 / slowest) if slowest > 0.0 else 1.0
    edges = [0.0, edge]
    growth = math.expm1(panels.stretch)
    longest = panels.phase / span
    if (end - edge) / longest * panels.points > _MAX_NODES:
        raise RuleTooLongError(
            f"the contact ({span:.3g}/k wide) is too wide for so thin a layer (reach m = {end:.3g}): "
            "use a thicker layer or a smaller load"
        )
    while edge < end:
        step = min(growth * edge, longest)
        if edge < ramp_end:
            step = min(step, panels.ramps * width)
        edge += step
        edges.append(min(edge, end))
    return np.array(edges)
