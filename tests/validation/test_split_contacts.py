"""Split contacts against a derivation of its own and, over the range of the paper's Fig. 4, against the grid."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve
from conveyor.contact.grid import solve_grid


def scene(radius, thickness, zeta):
    return ContactProblem("free", radius, 0.13, CreepSpectrum(0.1, [0.9], [zeta]), thickness)


# E∞/E0 10, free, p̃_m 0.13, ζ 3, kh 1: polished to 1e-12, a separate grid solver agrees to 1e-5
TWO_STRIPS = {
    0.4: (0.35799886592, 0.24626956256, [[-0.57405087749, 0.11803574191], [0.32586797997, 0.74153527656]]),
    0.3: (0.56514163672, 0.40315679660, [[-0.56623801936, -0.15624540858], [0.42031718971, 0.79156872681]]),
}


@pytest.mark.parametrize("radius", TWO_STRIPS)
def test_two_strips(radius):
    friction, depth, strips = TWO_STRIPS[radius]
    found = solve(scene(radius, 1.0, 3.0), rtol=1e-9)
    assert found.friction == pytest.approx(friction, rel=1e-8)
    assert found.penetration == pytest.approx(depth, rel=1e-8)
    np.testing.assert_allclose(found.patches, strips, rtol=0, atol=1e-8)
    assert found.energy_error < 1e-9


@pytest.mark.parametrize("radius", TWO_STRIPS)
def test_two_strips_on_the_grid(radius):
    friction, depth, _ = TWO_STRIPS[radius]
    found = solve_grid(scene(radius, 1.0, 3.0), 1024)
    assert found.friction == pytest.approx(friction, rel=1e-4)
    assert found.depth == pytest.approx(depth, rel=1e-4)


# from a scan over R/λ 0.2 … 0.5, kh 0.8 and 1, ζ 0.01 … 30 (21 a pair): 48 of 168 split, none at R/λ 0.5
SPLIT = [
    *((0.2, 0.8, zeta) for zeta in (0.01, 0.03, 0.1, 0.3, 1.0, 2.0, 5.0)),
    *((0.3, 0.8, zeta) for zeta in (0.7, 1.0, 1.5, 3.0, 8.0)),
    *((0.4, 0.8, zeta) for zeta in (1.5, 3.0, 6.0)),
    *((0.2, 1.0, zeta) for zeta in (0.5, 1.0, 2.5)),
    *((0.3, 1.0, zeta) for zeta in (1.0, 2.0, 4.0)),
    *((0.4, 1.0, zeta) for zeta in (2.5, 4.0)),
]


def test_twenty_split_contacts_are_looked_at():
    assert len(SPLIT) >= 20


@pytest.mark.parametrize(("radius", "thickness", "zeta"), SPLIT)
def test_spectral_strips_and_grid_agree(radius, thickness, zeta):
    problem = scene(radius, thickness, zeta)
    found = solve(problem, rtol=1e-8)
    assert found.status is Status.OK
    assert found.stats.way == "strips"
    coarse = solve_grid(problem, 2048)
    medium = solve_grid(problem, 4096, coarse)
    fine = solve_grid(problem, 8192, medium)
    assert len(fine.strips) == len(found.patches) == 2
    # the grid's own error: what its last two doublings still changed (the edges jitter between nodes)
    error = max(abs(fine.friction - medium.friction), abs(fine.friction - coarse.friction))
    assert abs(fine.friction - found.friction) <= 2.0 * error
    assert error < 2e-3 * found.friction
    assert fine.depth == pytest.approx(found.penetration, rel=1e-5)
    assert np.abs(fine.strips / problem.rho - found.patches).max() < 5e-3
    # the checks that need no second solver
    assert found.energy_error <= 1e-7
    for low, high in found.patches:
        assert found.pressure(np.linspace(low, high, 101)[1:-1]).min() >= 0.0
    between = np.linspace(found.patches[0, 1], found.patches[1, 0], 31)[1:-1]
    assert np.all(found.profile(between) >= found.penetration - 1.0 + np.sqrt(1.0 - between**2))
