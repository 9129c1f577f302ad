"""Strongly wrapped contacts: half width and eccentricity solved together, followed from a light load.

Where a roll is wrapped beyond about 0.75 R with large friction, one half width has two eccentricities and the load is
not monotone in it. The pair (α, ε) as a function of the load is single-valued all the same, because the
complementarity problem has one solution: Newton in both, with the load as the path's parameter, passes the fold.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.circle import slope_coefficients
from conveyor.contact.scene import Scene, State
from conveyor.contact.spectral import assemble, figures

Array = NDArray[np.float64]

_NEWTON_STEPS = 12
_DIFFERENCE = 1e-6  # relative change of α for the Jacobian's column: Newton then gains six digits a step
_FIRST_STEP, _LARGEST_STEP, _SMALLEST_STEP = 0.2, 0.7, 1e-3  # in ln p̃_m
_PATH_STEPS = 150
_STRAY = 0.05  # from the predicted place, in ln α and ε/ρ


def settle(scene: Scene, n: int, start: Array, target: float, tolerance: float) -> State | None:
    """Newton in (ln α, ε) for ln p̃_m = target and row 0; None where it leaves the roll or does not settle.

    Parameters
    ----------
    start : ndarray, shape (2,)
        ln α and ε to start from.
    target, tolerance : float
        ln p̃_m, and the mismatch allowed in it and in ε/α.
    """
    rho = scene.problem.rho
    place = start.copy()
    for _ in range(_NEWTON_STEPS):
        alpha = math.exp(place[0])
        if alpha + abs(place[1]) >= rho:
            return None
        both = alpha * np.array([1.0, 1.0 + _DIFFERENCE])
        matrix = assemble(scene.rule(float(both[1])), scene.creep, both, n)
        scene.matrices += 2
        residual, by_eps, c = _residual(matrix, both, place[1], rho)
        if not (c[:, 0] > 0.0).all():
            return None
        load = np.log(0.25 * both * c[:, 0])
        miss = np.array([load[0] - target, residual[0]])
        jacobian = np.array(
            [
                [(load[1] - load[0]) / _DIFFERENCE, by_eps[0, 0]],
                [(residual[1] - residual[0]) / _DIFFERENCE, by_eps[0, 1]],
            ]
        )
        step = np.linalg.solve(jacobian, miss)
        largest = max(abs(step[0]), abs(step[1]) / alpha)
        if abs(miss[0]) <= tolerance and abs(step[1]) <= tolerance * alpha:
            inverse = np.asarray(np.linalg.inv(matrix[:1, 1:]), dtype=np.float64)
            contact = figures(inverse, both[:1], place[1:2], rho)
            return State(contact, matrix[:1], abs(float(miss[0])))
        place = place - step * min(1.0, 0.5 / largest)
    return None


def _residual(matrix: Array, alpha: Array, eps: float, rho: float) -> tuple[Array, Array, Array]:
    """Row 0 at both half widths, shape (2,); ε-derivatives of (ln p, row 0), shape (2, 2); coefficients (2, n)."""
    n = matrix.shape[2]
    inverse = np.linalg.inv(matrix[:, 1:])
    g, dg = slope_coefficients(alpha, np.full(alpha.size, eps), rho, n + 2)
    c = (inverse @ g[:, 1 : n + 1, None])[..., 0]
    dc = (inverse @ dg[:, 1 : n + 1, None])[..., 0]
    row = matrix[:, 0]
    residual = np.einsum("bv,bv->b", row, c) - g[:, 0]
    by_eps = np.stack([dc[:, 0] / c[:, 0], np.einsum("bv,bv->b", row, dc) - dg[:, 0]], axis=1)
    return residual, by_eps, c


def follow(scene: Scene, light: State, n: int) -> tuple[State, float]:
    """Follow the contact from a light load toward the problem's load.

    Returns
    -------
    State, float
        The last contact reached and its ln p̃_m: the problem's own where the path arrives.
    """
    target = math.log(scene.problem.pressure)
    load = math.log(light.contact.pressure[0])
    place = np.array([math.log(light.contact.alpha[0]), light.contact.eps[0]])
    before: tuple[float, Array] | None = None
    state, step = light, _FIRST_STEP
    for _ in range(_PATH_STEPS):
        if load >= target:
            break
        goal = min(target, load + step)
        ahead = place
        if before is not None:
            ahead = place + (goal - load) / (load - before[0]) * (place - before[1])
        found = settle(scene, n, ahead, goal, 1e-9)
        if found is None or _far(found, ahead, scene.problem.rho):
            step *= 0.5
            if step < _SMALLEST_STEP:
                break
            continue
        before, load, state = (load, place), goal, found
        place = np.array([math.log(found.contact.alpha[0]), found.contact.eps[0]])
        step = min(1.5 * step, _LARGEST_STEP)
    return state, load


def _far(found: State, ahead: Array, rho: float) -> bool:
    """Whether Newton left the path: it may fall on another branch of the single-patch equations."""
    contact = found.contact
    narrower = abs(math.log(contact.alpha[0]) - ahead[0])
    return bool(narrower > _STRAY or abs(contact.eps[0] - ahead[1]) > _STRAY * rho)
