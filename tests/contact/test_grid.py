"""The grid: complementarity itself, its convergence to the spectral contact, its two ways to solve its equations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.contact import grid as module
from conveyor.contact.grid import Grid, solve_grid
from conveyor.errors import InputError, NoSolutionError

ONE = CreepSpectrum(0.1, [0.9], [1.0])
SCENES = {
    "free": ContactProblem("free", 0.4, 0.05, ONE, 1.0),
    "free, wrapped": ContactProblem("free", 0.1, 0.13, ONE, 1.0),
    "free, split": ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0),
    "confined": ContactProblem("confined", 0.4, 0.05, ONE, 1.0, 0.4),
    "half-space": ContactProblem("half-space", 0.4, 0.05, CreepSpectrum(0.2, [0.3, 0.5], [0.05, 4.0])),
}
by_scene = pytest.mark.parametrize("name", SCENES)


@by_scene
def test_complementarity(name):
    problem = SCENES[name]
    found = solve_grid(problem, 2048)
    turn = found.x / problem.rho
    w = found.surface[np.round(found.x / (2.0 * np.pi / found.points)).astype(int) % found.points]
    gap = w - found.depth + 1.0 - np.sqrt(1.0 - turn**2)
    depth = abs(found.depth)
    assert found.pressure.min() >= 0.0
    assert gap.min() >= -1e-10 * depth
    assert np.abs(gap[found.pressure > 0.0]).max() <= 1e-10 * depth
    assert found.pressure.sum() / found.points == pytest.approx(problem.pressure, rel=1e-12)
    assert abs(found.surface.mean()) <= 1e-12 * depth


@by_scene
def test_it_converges_to_the_spectral_contact(name):
    # piecewise linear pressure: second order in the mesh, less a jitter of the edges between nodes. 1024 nodes give
    # 4e-5 or better; three doublings gain a factor of 10 at the least where second order would gain 64
    exact = solve(SCENES[name], rtol=1e-10)
    errors = {}
    for points in (1024, 8192):
        found = solve_grid(SCENES[name], points)
        errors[points] = max(
            abs(found.friction / exact.friction - 1.0), abs(found.depth / exact.penetration - 1.0)
        )
        # an edge is known to a node
        assert np.abs(found.strips - exact.patches * exact.problem.rho).max() < 2.0 * 2.0 * np.pi / points
        assert found.friction_by_loss == pytest.approx(exact.friction, rel=20.0 / points**1.5 * 32.0)
    assert errors[1024] < 1e-4
    assert errors[8192] < 0.1 * errors[1024]


def test_start_is_only_a_start():
    problem = SCENES["free, split"]
    coarse = solve_grid(problem, 256)
    started, fresh = solve_grid(problem, 1024, coarse), solve_grid(problem, 1024)
    assert started.friction == pytest.approx(fresh.friction, rel=1e-11)
    assert started.pivots < fresh.pivots


@by_scene
def test_depth_in_place_of_load(name):
    problem = SCENES[name]
    loaded = solve_grid(problem, 512)
    held = solve_grid(replace(problem, pressure=1.0), 512, depth=loaded.depth)
    assert held.mean_pressure == pytest.approx(problem.pressure, rel=1e-9)
    assert held.friction == pytest.approx(loaded.friction, rel=1e-9)


def test_elastic_contact_is_symmetric():
    found = solve_grid(replace(SCENES["free"], creep=CreepSpectrum(1.0)), 1024)
    np.testing.assert_allclose(
        found.pressure, found.pressure[::-1], rtol=0, atol=1e-10 * found.pressure.max()
    )
    assert abs(found.friction) < 1e-12
    assert found.friction_by_loss == 0.0


def test_both_ways_to_solve_the_equations_agree(monkeypatch):
    direct = solve_grid(SCENES["free"], 1024)
    monkeypatch.setattr(module, "_DENSE", 10)
    krylov = solve_grid(SCENES["free"], 1024)
    # GMRES to 1e-12, times the condition of the preconditioned equations
    assert krylov.friction == pytest.approx(direct.friction, rel=1e-10)
    assert krylov.depth == pytest.approx(direct.depth, rel=1e-10)


def test_products_on_the_roll_alone_are_those_of_the_period():
    # R/λ 0.02: the roll takes 1/25 of the period, its nodes have a transform of their own
    problem = ContactProblem("half-space", 0.02, 1e-3, ONE)
    grid = Grid(problem, 1 << 14)
    found = grid.contact(problem.pressure)
    # 20 nodes in the contact
    assert found.friction == pytest.approx(solve(problem, rtol=1e-9).friction, rel=2e-2)
    p = found.pressure
    surface = grid._surface
    assert surface.window.size < surface.transform.size
    np.testing.assert_allclose(
        surface.lifted(p),
        surface.whole(p)[surface.index],
        rtol=0,
        atol=1e-12 * np.abs(surface.whole(p)).max(),
    )


def test_one_grid_serves_many_loads():
    grid = Grid(SCENES["confined"], 512)
    for pressure in (0.01, 0.05):
        alone = solve_grid(replace(SCENES["confined"], pressure=pressure), 512)
        assert grid.contact(pressure).friction == alone.friction


@pytest.mark.parametrize("points", [0, -4, 14, 513])
def test_points_are_refused(points):
    with pytest.raises(InputError, match=f"points = {points}: an even number of nodes"):
        solve_grid(SCENES["free"], points)


def test_a_grid_without_nodes_on_the_roll_is_refused():
    with pytest.raises(InputError, match="three or more of them on the roll"):
        solve_grid(ContactProblem("free", 1e-3, 0.01, ONE, 1.0), 64)


def test_exchanges_are_bounded(monkeypatch):
    monkeypatch.setattr(module, "_PIVOTS", 2)
    with pytest.raises(NoSolutionError, match=r"did not settle in \d exchanges"):
        solve_grid(SCENES["confined"], 512)
