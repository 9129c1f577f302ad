"""Outlines of an idler set with its belt and bulk, to scale, for drawings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.laws.loading import Wing, spread_bulk, wing_pieces
from conveyor.line.line import Line
from conveyor.line.stretches import STRANDS, Strand, Stretch

Array = NDArray[np.float64]
Outline = tuple[Array, Array]
"""Points across and up [m], each of shape (k,)."""

_HEAP_POINTS = 41


class SetOutline(NamedTuple):
    """Rolls, belt and bulk of a set; the belt is centred, level with the middle roll at height 0."""

    strand: Strand
    rolls: tuple[Outline, ...]
    belt: Outline
    bulk: Outline | None


def set_outlines(line: Line, surcharge: float) -> tuple[SetOutline, ...]:
    """Outline of the set of each strand where it bears most bulk.

    Parameters
    ----------
    line : Line
        The conveyor in SI.
    surcharge : float
        Surcharge angle of the bulk [rad].
    """
    return tuple(
        _set_outline(line, max((s for s in line.stretches if s.strand == strand), key=lambda s: s.bulk_mass), surcharge)
        for strand in STRANDS
    )


def _set_outline(line: Line, stretch: Stretch, surcharge: float) -> SetOutline:
    if stretch.idlers.pipe is not None:
        return _pipe_outline(line, stretch, stretch.idlers.pipe.radius)
    width = line.belt.width
    middle, angle, inner = stretch.idlers.middle_belt(width), stretch.trough_angle, stretch.idlers.inner_wing
    trough = partial(wing_pieces, middle_roll_length=middle, trough_angle=angle, inner_wing=inner)
    bulk = None
    if stretch.bulk_mass > 0.0:
        covered, slope = spread_bulk(
            stretch.bulk_mass / line.density, belt_width=width, middle_roll_length=middle, trough_angle=angle,
            surcharge_angle=surcharge, inner_wing=inner,
        )  # fmt: skip
        x, y = _symmetric_belt(0.5 * min(middle, covered), trough(covered) if covered > middle else ())
        over = np.linspace(x[-1], x[0], _HEAP_POINTS)
        heap = y[-1] + math.tan(slope) * (x[-1] ** 2 - over**2) / (2.0 * x[-1])
        bulk = np.append(x, over), np.append(y, heap)
    half = trough(width)
    return SetOutline(
        stretch.strand,
        tuple(_roll_outlines(stretch, 0.5 * middle, half)),
        _symmetric_belt(0.5 * middle, half),
        bulk,
    )


def _pipe_outline(line: Line, stretch: Stretch, radius: float) -> SetOutline:
    """Outline of a pipe of an inner radius [m] with its level bulk between six rolls."""
    from scipy.optimize import brentq  # a tenth of a second, for pipes alone

    thickness = line.belt.thickness
    turn = np.linspace(0.0, 2.0 * math.pi, 2 * _HEAP_POINTS)
    bulk = None
    if stretch.bulk_mass > 0.0:
        share = min(stretch.bulk_mass / line.density / (math.pi * radius**2), 1.0)
        half = brentq(lambda a: a - math.sin(a) * math.cos(a) - math.pi * share, 0.0, math.pi)
        arc = np.linspace(-half, half, 2 * _HEAP_POINTS)
        bulk = radius * np.sin(arc), -radius * np.cos(arc)
    rolls, long = [], 0.5 * stretch.roll_length
    for place, roll in enumerate(stretch.radii):
        angle, near = math.pi / 3.0 * (place - 2), radius + thickness
        out, along = np.array([math.sin(angle), -math.cos(angle)]), np.array([math.cos(angle), math.sin(angle)])
        far = near + 2.0 * roll
        corners = np.array([near * out - long * along, near * out + long * along, far * out + long * along,
                            far * out - long * along])  # fmt: skip
        rolls.append((corners[:, 0], corners[:, 1]))
    return SetOutline(stretch.strand, tuple(rolls), (radius * np.sin(turn), -radius * np.cos(turn)), bulk)


def _symmetric_belt(flat: float, half: Sequence[Wing]) -> Outline:
    """Outline of a belt (across, up) [m], from left to right: level to `flat` on both sides, then along the wings."""
    x = np.cumsum([flat, *(wing.length * math.cos(wing.angle) for wing in half)])
    y = np.cumsum([0.0, *(wing.length * math.sin(wing.angle) for wing in half)])
    return np.concatenate([-x[::-1], x]), np.concatenate([y[::-1], y])


def _roll_outlines(stretch: Stretch, flat: float, half: Sequence[Wing]) -> Iterator[Outline]:
    """Outlines of the rolls [m]; a wing roll begins at the bend before it."""
    count, long = len(stretch.radii), stretch.roll_length
    if count % 2:
        thick = 2.0 * stretch.radii[count // 2]
        yield np.array([-0.5, 0.5, 0.5, -0.5]) * long, np.array([0.0, 0.0, -thick, -thick])
    x, y = flat, 0.0
    for wing, radius in zip(half, stretch.radii[(count + 1) // 2 :], strict=False):
        along = long * np.array([math.cos(wing.angle), math.sin(wing.angle)])
        down = 2.0 * radius * np.array([math.sin(wing.angle), -math.cos(wing.angle)])
        outline = np.array([x, y]) + np.array([0.0 * along, along, along + down, down])
        for side in (1.0, -1.0):
            yield side * outline[:, 0], outline[:, 1]
        x, y = x + wing.length * math.cos(wing.angle), y + wing.length * math.sin(wing.angle)
