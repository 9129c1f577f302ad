"""Batches of layers of one kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.layers.belt_layer import BeltBatch, BeltSupport
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import (
    HALF_SPACE_DEPTH,
    Confined,
    Free,
    HalfSpace,
    Layer,
    PlainLayerBatch,
)

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Rows = NDArray[np.bool_] | NDArray[np.int_]


class LayerBatch(Protocol):
    """Layers of b problems."""

    def reach(self, depth: float) -> Array:
        """Wave numbers beyond which |S - j| < 4 q² exp(-2q) of q = `depth`, shape (b,)."""

    def symbol(self, m: Array, j: ComplexArray) -> ComplexArray:
        """S_m of layers whose touched rubber has compliance j(m), shape (b, k); m of shape (1, k) or (b, k)."""

    def __getitem__(self, chosen: Rows) -> LayerBatch:
        """Selected layers."""


@dataclass(frozen=True, eq=False)
class CustomLayerBatch:
    """Layers of the user's own, evaluated one by one."""

    layers: Sequence[Layer]
    creeps: Sequence[CreepSpectrum]

    def reach(self, depth: float) -> Array:  # noqa: ARG002
        """Wave numbers of the layers themselves, shape (b,)."""
        return np.array([layer.reach for layer in self.layers])

    def symbol(self, m: Array, j: ComplexArray) -> ComplexArray:
        """S_m, shape (b, k)."""
        rows = np.broadcast_to(m, j.shape)
        each = zip(self.layers, rows, self.creeps, strict=True)
        return np.array([layer.symbol(row, creep) for layer, row, creep in each])

    def __getitem__(self, chosen: Rows) -> CustomLayerBatch:
        places = np.arange(len(self.layers))[chosen]
        return CustomLayerBatch([self.layers[i] for i in places], [self.creeps[i] for i in places])


def layer_kind(layer: Layer) -> type:
    """Kind of batch a layer belongs to: its own type, or that of all users' own layers."""
    return type(layer) if type(layer) in {HalfSpace, Free, Confined, BeltSupport} else CustomLayerBatch


def stack_layers(layers: Sequence[Layer], creeps: Sequence[CreepSpectrum]) -> LayerBatch:
    """Batch of layers of one kind; `creeps` are the rubbers that are touched."""
    belts = [layer for layer in layers if isinstance(layer, BeltSupport)]
    if len(belts) == len(layers):
        return BeltBatch.of(belts)
    plain = [layer for layer in layers if isinstance(layer, (Free, Confined))]
    if len(plain) == len(layers):
        poisson = [layer.poisson if isinstance(layer, Confined) else 0.5 for layer in plain]
        support = "free" if isinstance(plain[0], Free) else "confined"
        return PlainLayerBatch(support, np.array([layer.thickness for layer in plain]), np.array(poisson))
    if all(isinstance(layer, HalfSpace) for layer in layers):
        return PlainLayerBatch("half-space", np.full(len(layers), HALF_SPACE_DEPTH), np.full(len(layers), 0.5))
    return CustomLayerBatch(layers, creeps)
