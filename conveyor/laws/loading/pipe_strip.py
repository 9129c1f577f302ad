"""Belt bent to a pipe in six rolls: an elastic strip, flat when free, that rolls hold together and weights press on.

Derived, see docs/special_belts.md: the strip is inextensible, near to the circle, without friction. Of all forces that
hold it in equilibrium and only push, those of rolls and lap that occur have the least complementary energy,
min ∫ (M - D/R)² dθ (Castigliano; a linear complementarity problem).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_not_negative, require_positive

__all__ = ["least_pipe_stiffness", "pipe_forming_load", "pipe_strip_forces", "pipe_transverse_stiffness"]

Array = NDArray[np.float64]

ROLL_ANGLES: Final = tuple(math.radians(degrees) for degrees in (-120.0, -60.0, 0.0, 60.0, 120.0, 180.0))
"""Places of the six rolls, from below to the right [rad]; the order of `PIPE_ROLLS`."""
_MIRRORED: Final = (4, 3, 2, 1, 0, 5)
LATERAL_PRESSURE: Final = 0.5
"""Horizontal over vertical pressure of the bulk at rest, 1 - sin 30 deg (Jaky 1944) [-]; from 0.3 to 1 the sum of the
forces changes by 3 %."""
_FULL: Final = 1.0 + 1e-9  # a pipe filled whole, calculated from its flow
_POINTS: Final = 1201  # of the strip: forces change by less than 1e-4 with twice as many
_LAP_POINTS: Final = 5  # of the lap, at which its layers may touch; its inner edge alone does at usual overlaps
_STRESS_ON_BALANCE: Final = 1e3  # weight of the equilibrium while the touching rolls are sought


@dataclass(frozen=True, eq=False)
class _Strip:
    """A strip with the forces that may act on it, by its half angle; moments over R.

    `rolls` are the rolls that reach the strip; their unit forces and those of the lap have the moments `directions` @
    `sizes`, shapes (points, forces) with orthogonal columns and (forces, forces), and push by `pushes`, shape
    (forces, 2). `hanging`, shape (points, 2), is of a unit force to the right and up spread over the strip.
    """

    angles: Array
    rolls: tuple[int, ...]
    directions: Array
    sizes: Array
    pushes: Array
    hanging: Array

    def forces_of(self, wanted: Array, resting: Array) -> Array:
        """Forces that come nearest to the wanted moments in equilibrium with a force to the right and up, (forces,)."""
        from scipy.optimize import nnls  # 0.3 s that a conveyor without a pipe does not pay

        drawn = self.directions.T @ wanted
        stress = _STRESS_ON_BALANCE * float(np.abs(self.sizes).max())
        rows = np.vstack([self.sizes, stress * self.pushes.T])
        touching = nnls(rows, np.concatenate([drawn, -stress * resting]))[0] > 0.0
        while True:
            found = self._in_balance(touching, drawn, resting)
            if (found[touching] >= 0.0).all():
                return found
            touching[int(np.argmin(found))] = False

    def _in_balance(self, touching: NDArray[np.bool_], drawn: Array, resting: Array) -> Array:
        """The same of touching places alone, which may pull, in balance to the last digit."""
        sizes, pushes = self.sizes[:, touching], self.pushes[touching]
        whole = np.block([[sizes.T @ sizes, pushes], [pushes.T, np.zeros((2, 2))]])
        found = np.zeros(touching.size)
        known = np.concatenate([sizes.T @ drawn, -resting])
        found[touching] = np.linalg.lstsq(whole, known, rcond=None)[0][:-2]
        return found


@lru_cache(maxsize=32)
def _held_strip(half_angle: float) -> _Strip:
    """Strip that reaches from -half_angle to half_angle from below [rad]; its right end lies outside in the lap."""
    angles = np.linspace(-half_angle, half_angle, _POINTS)
    weights = np.full(_POINTS, angles[1] - angles[0])
    weights[[0, -1]] *= 0.5
    root = np.sqrt(weights)[:, None]

    def moment(at: float) -> Array:
        return np.where(angles > at, np.sin(angles - at), 0.0)

    turn = 2.0 * math.pi
    outermost = [at + turn if at + turn <= half_angle else at for at in ROLL_ANGLES]
    rolls = tuple(i for i, at in enumerate(outermost) if abs(at) <= half_angle)
    moments = [moment(outermost[i]) for i in rolls]
    pushes = [(-math.sin(outermost[i]), math.cos(outermost[i])) for i in rolls]
    if half_angle > math.pi:
        for inner in np.linspace(-half_angle, half_angle - turn, _LAP_POINTS).tolist():
            moments.append(moment(inner) - moment(inner + turn))
            pushes.append((0.0, 0.0))
    directions, sizes = np.linalg.qr(root * np.array(moments).T)
    return _Strip(angles, rolls, root * directions, sizes, np.array(pushes), _hanging_moments(angles, half_angle))


def _hanging_moments(angles: Array, half_angle: float) -> Array:
    """Moments over R of unit forces to the right and up, spread evenly over the strip: closed integrals."""
    reach = angles + half_angle
    across = math.cos(half_angle) - np.cos(angles) - reach * np.sin(angles)
    up = -np.sin(angles) - math.sin(half_angle) + reach * np.cos(angles)
    return np.stack([up, -across], axis=1) / (2.0 * half_angle)


@lru_cache(maxsize=256)
def _bulk_moments(half_angle: float, filling: float) -> Array:
    """Moments over R of a unit weight of bulk with a level surface, in vertical columns on the wall below them."""
    from scipy.optimize import brentq  # as above

    angles = _held_strip(half_angle).angles
    surface = math.pi
    if filling < 1.0:
        surface = brentq(lambda to: (to - math.sin(to) * math.cos(to)) / math.pi - filling, 0.0, math.pi)
    below = np.abs(angles) < 0.5 * math.pi
    depth = np.where(below, np.maximum(np.minimum(-math.cos(surface), np.cos(angles)) + np.cos(angles), 0.0), 0.0)
    right, up = LATERAL_PRESSURE * depth * np.sin(angles), -depth * np.cos(angles)
    x, z = np.sin(angles), -np.cos(angles)
    step = angles[1] - angles[0]

    def until(values: Array) -> Array:
        return np.concatenate([[0.0], np.cumsum(0.5 * step * (values[1:] + values[:-1]))])

    to_right, to_up = until(right), until(up)
    moments = x * to_up - z * to_right - until(x * up - z * right)
    return np.asarray(moments / -to_up[-1])


def pipe_strip_forces(
    half_angle: float,
    forming: float,
    *,
    belt: tuple[float, float] = (0.0, 0.0),
    bulk: float = 0.0,
    filling: float = 0.5,
) -> tuple[float, ...]:
    """Forces of the six rolls on a belt bent to a pipe (derived).

    Parameters
    ----------
    half_angle : float
        B/(2 R) of the belt's width on the circle of its carcass [rad], from 2 to below 2 pi.
    forming : float
        D a/R² [N], positive: stiffness across the belt, times spacing, over the circle's radius squared.
    belt : tuple of float
        Force on the belt, evenly over its width, to the right and up [N]: its weight, its tension in curves.
    bulk : float
        Weight of the bulk [N], at least 0.
    filling : float
        Its cross-section over that of the pipe, above 0 to 1 [-].

    Returns
    -------
    tuple of float
        Forces toward the middle, by `PIPE_ROLLS` [N]; 0 where the belt does not touch. They hold belt and bulk. The
        mean of both ways to lap, of which either edge may lie outside.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    A roll touches the pipe in the middle of its length, outside of the lap, which is on top. M = Σ F_j R sin(θ - θ_j)
    over the places between the left edge and θ, and that of the weights; the free strip is flat. Bulk presses by
    vertical columns, and to the sides by `LATERAL_PRESSURE`. Beside the elastica between flat rolls, which bends out
    of the circle, the sum of the forces to the power 4/3, as indentation has it, is 0.75 to 1.27 times that
    here, 1.0 on the median (laps of 6 to 25 %, empty and full, tests/validation/test_pipe_strip.py).

    Examples
    --------
    >>> [round(force) for force in pipe_strip_forces(3.64, 300.0, belt=(0.0, -466.0), bulk=629.0, filling=0.6)]
    [40, 734, 890, 734, 40, 490]
    """
    require(2.0 <= half_angle < 2.0 * math.pi, "half_angle", half_angle, ">= 2 and < 2 pi rad")
    require_positive(forming=forming)
    require_not_negative(bulk=bulk)
    require(0.0 < filling <= _FULL, "filling", filling, "> 0 and <= 1")
    right, up = belt
    lapped = mirrored = _lapped_forces(half_angle, forming, belt, bulk, filling)
    if right:
        mirrored = _lapped_forces(half_angle, forming, (-right, up), bulk, filling)
    return tuple(0.5 * (one + mirrored[other]) for one, other in zip(lapped, _MIRRORED, strict=True))


def _lapped_forces(
    half_angle: float, forming: float, belt: tuple[float, float], bulk: float, filling: float
) -> tuple[float, ...]:
    """Forces of the six rolls with the right edge of the belt outside in the lap [N]."""
    held, (right, up) = _held_strip(half_angle), belt
    wanted = forming - held.hanging @ np.array([right, up])
    if bulk > 0.0:
        wanted = wanted - bulk * _bulk_moments(half_angle, filling)
    found = held.forces_of(wanted, np.array([right, up - bulk]))
    forces = dict(zip(held.rolls, found.tolist(), strict=False))  # those of the lap follow
    return tuple(forces.get(roll, 0.0) for roll in range(len(ROLL_ANGLES)))


@lru_cache(maxsize=32)
def _forming_coefficient(half_angle: float) -> float:
    """Mean force of the six rolls on a belt without weight, over D a/R² [-]: 1.02 to 1.08 at overlaps of 10 to 25 %."""
    return math.fsum(pipe_strip_forces(half_angle, 1.0)) / len(ROLL_ANGLES)


def pipe_forming_load(transverse_stiffness: float, *, half_angle: float, radius: float, spacing: float) -> float:
    """Mean of what a belt without weight presses on the six rolls of a panel, c D a/R² (derived).

    Parameters
    ----------
    transverse_stiffness : float
        D, bending stiffness E I across the belt over its length [N m²/m], positive.
    half_angle : float
        B/(2 R), as in `pipe_strip_forces` [rad].
    radius : float
        R of the carcass [m], positive.
    spacing : float
        a of the panels [m], positive.

    Returns
    -------
    float
        F [N]: what a test device of six rolls measures on the mean, over the length of its specimen.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(pipe_forming_load(8.0, half_angle=3.64, radius=0.2, spacing=1.2))
    250
    """
    require_positive(transverse_stiffness=transverse_stiffness, radius=radius, spacing=spacing)
    return _forming_coefficient(half_angle) * transverse_stiffness * spacing / radius**2


def pipe_transverse_stiffness(forming_load: float, *, half_angle: float, radius: float, spacing: float) -> float:
    """Stiffness across the belt from its forming load, the inverse of `pipe_forming_load`.

    Parameters
    ----------
    forming_load : float
        F, mean of the six rolls [N], positive.
    half_angle, radius, spacing : float
        As in `pipe_forming_load` [rad, m, m].

    Returns
    -------
    float
        D [N m²/m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(pipe_transverse_stiffness(250.0, half_angle=3.64, radius=0.2, spacing=1.2), 2)
    7.98
    """
    require_positive(forming_load=forming_load)
    return forming_load / pipe_forming_load(1.0, half_angle=half_angle, radius=radius, spacing=spacing)


_DECADES: Final = (-3.0, 3.0)
"""Of D/(w R²): from a belt that lies on the lower rolls to one whose forces its weight does not move."""


@lru_cache(maxsize=32)
def _bearing_coefficient(half_angle: float) -> float | None:
    """Least D/(w R²) with which every roll bears, whichever edge laps [-]; None where a roll never does."""
    from scipy.optimize import brentq  # as above

    def least(exponent: float) -> float:
        forces = _lapped_forces(half_angle, 10.0**exponent, (0.0, -1.0), 0.0, 1.0)
        return min(forces) - 1e-9  # 0 where a roll does not bear

    return None if least(_DECADES[1]) < 0.0 else float(10.0 ** brentq(least, *_DECADES, xtol=1e-6))


def least_pipe_stiffness(belt_weight: float, *, half_angle: float, radius: float) -> float | None:
    """Least stiffness across the belt with which an empty pipe bears on all six rolls, κ w R² (derived).

    Parameters
    ----------
    belt_weight : float
        w of the belt over its length [N/m], positive.
    half_angle, radius : float
        As in `pipe_forming_load` [rad, m].

    Returns
    -------
    float or None
        D [N m²/m], whichever edge lies outside in the lap; None where a roll bears at no stiffness, as with laps of up
        to 10 %.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(least_pipe_stiffness(388.5, half_angle=3.641, radius=0.2005), 1)
    8.2
    """
    require_positive(belt_weight=belt_weight, radius=radius)
    coefficient = _bearing_coefficient(half_angle)
    return None if coefficient is None else coefficient * belt_weight * radius**2
