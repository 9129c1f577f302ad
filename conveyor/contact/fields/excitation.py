"""Harmonics in which a contact loses its energy: the frequency band that rubber data must cover.

A particle of the layer passes harmonic m of the rolls at the angular frequency m k V; harmonic m loses
Im S_m |p̃̂_m|² (contact/fields/energy_balance.py). The band lies between two shares of the running sum.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.fields.energy_balance import Strip, contact_width, pressure_spectrum
from conveyor.contact.galerkin.quadrature import series_rule
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Layer

Array = NDArray[np.float64]

LOSS_SHARES = (0.05, 0.5, 0.95)
"""Of the loss: the band between the outer ones holds nine tenths of it."""
_NARROW_WIDTH = 0.2  # width α below which a hundred harmonics and more carry the loss
_POINTS = 240
_REACH = 40.0  # m α: |p̃̂_m|² falls like (mα)^-3, beyond lies less than a thousandth of the loss


def _integral_rule(layer: Layer, creep: CreepSpectrum, end: float) -> tuple[Array, NDArray[np.complex128]]:
    """Nodes and weights of the sum as an integral over ln m, where many harmonics share the loss."""
    logs, step = np.linspace(0.0, np.log(end), _POINTS, retstep=True)
    m = np.exp(logs)
    return m, step * layer.symbol(m, creep)


def excited_harmonics(
    layer: Layer,
    creep: CreepSpectrum,
    strips: Sequence[Strip],
    shares: Sequence[float] = LOSS_SHARES,
) -> Array:
    """Harmonics m below which the given shares of the loss lie, shape of `shares`.

    Parameters
    ----------
    layer : Layer
        Symbol of the layer.
    creep : CreepSpectrum
        With at least one term ζ > 0, else nothing is lost.
    strips : sequence of (centre, half width, coefficients)
        Strips of one contact, lengths X [-].
    shares : sequence of float
        Ascending, in (0, 1) [-].
    """
    span = contact_width(strips)
    narrowest = min(alpha for _, alpha, _ in strips)
    end = _REACH / narrowest
    m, weights = (
        _integral_rule(layer, creep, end) if span < _NARROW_WIDTH else series_rule(layer, creep, span=span, end=end)
    )
    wave = pressure_spectrum(m, strips)
    lost = weights.imag * m * (wave.real**2 + wave.imag**2)
    order = np.argsort(m)
    lost = lost[order]
    middle = np.cumsum(lost) - 0.5 * lost  # a node represents the interval about it
    harmonics: Array = np.exp(np.interp(np.asarray(shares) * lost.sum(), middle, np.log(m[order])))
    return harmonics
