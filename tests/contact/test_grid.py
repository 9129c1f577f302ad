"""The grid: complementarity itself, its convergence to the spectral contact, its two ways to solve its equations."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.contact.fields.contact_fields import GridFields
from conveyor.contact.layers.layer_models import Layer
from conveyor.contact.solvers import grid_solver as module
from conveyor.contact.solvers.grid_solver import ContactGrid, solve_grid
from conveyor.errors import InputError, NoSolutionError

ROUNDING = 1e-11  # of systems of condition 100 and sums of 100 terms, in whatever order: 1e4 of 2e-16
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
    w = found.surface_displacement[np.round(found.x / (2.0 * np.pi / found.points)).astype(int) % found.points]
    gap = w - found.depth + 1.0 - np.sqrt(1.0 - turn**2)
    depth = abs(found.depth)
    assert found.pressure.min() >= 0.0
    assert gap.min() >= -1e-10 * depth
    assert np.abs(gap[found.pressure > 0.0]).max() <= 1e-10 * depth
    assert found.pressure.sum() / found.points == pytest.approx(problem.pressure, rel=1e-12)
    assert abs(found.surface_displacement.mean()) <= 1e-12 * depth


MESHES = (240, 248, 256, 264, 272)  # an edge falls anywhere between two nodes


def worst(problem, exact, factor):
    """Return the largest relative errors of friction, depth and friction by loss on five meshes."""
    grids = [solve_grid(problem, factor * points) for points in MESHES]
    off = []
    for found in grids:
        # an edge lies between its last node of pressure and the next one
        step = 2.0 * np.pi / found.points
        assert np.abs(found.strips - exact.patches * problem.rho).max() < step
        off.append(
            (
                found.friction / exact.friction - 1.0,
                found.depth / exact.penetration - 1.0,
                found.friction_by_loss / exact.friction - 1.0,
            )
        )
    return np.abs(off).max(axis=0)


@by_scene
def test_it_converges_to_the_spectral_contact(name):
    # an edge that is wrong by part of a step h, where p ∝ sqrt(distance), misplaces a force of h^(3/2): the error falls
    # at least like that, and like h² away from the edges. Meshes eight times finer gain 8^1.5 or more
    exact = solve(SCENES[name], rtol=1e-10)
    coarse, fine = worst(SCENES[name], exact, 2), worst(SCENES[name], exact, 16)
    # h against the contact's half width of 0.2 or more, to the power 3/2: 1.5e-2
    assert coarse.max() < (2.0 * np.pi / 480 / 0.2) ** 1.5
    assert (fine < 8.0**-1.5 * coarse).all()


def test_start_is_only_a_start():
    problem = SCENES["free, split"]
    coarse = solve_grid(problem, 256)
    started, fresh = solve_grid(problem, 1024, coarse), solve_grid(problem, 1024)
    assert started.friction == pytest.approx(fresh.friction, rel=1e-11)
    assert started.pivots < fresh.pivots


@pytest.mark.parametrize("strips", [[[-9.0, 9.0]], [[1.5, 1.6]], [[-1.8, -1.7], [0.1, 0.2]], [[3.0, 3.1]]])
@by_scene
def test_any_start_ends_at_the_one_solution(name, strips):
    # the whole roll, one place far from the crown, two places, none at all
    problem = SCENES[name]
    fresh = solve_grid(problem, 256)
    started = solve_grid(problem, 256, replace(fresh, strips=np.array(strips)))
    np.testing.assert_allclose(started.pressure, fresh.pressure, rtol=0, atol=1e-10 * fresh.pressure.max())
    assert started.depth == pytest.approx(fresh.depth, rel=1e-10)


@by_scene
def test_depth_in_place_of_load(name):
    problem = SCENES[name]
    loaded = solve_grid(problem, 512)
    held = solve_grid(replace(problem, pressure=1.0), 512, depth=loaded.depth)
    assert held.mean_pressure == pytest.approx(problem.pressure, rel=1e-9)
    assert held.friction == pytest.approx(loaded.friction, rel=1e-9)


def test_elastic_contact_is_symmetric():
    found = solve_grid(replace(SCENES["free"], creep=CreepSpectrum(1.0)), 1024)
    np.testing.assert_allclose(found.pressure, found.pressure[::-1], rtol=0, atol=1e-10 * found.pressure.max())
    assert abs(found.friction) < 1e-12
    assert found.friction_by_loss == 0.0


@dataclass(frozen=True)
class Backwards:
    """A layer that runs the other way: lag becomes lead."""

    layer: Layer

    @property
    def reach(self):
        return self.layer.reach

    def symbol(self, m, creep):
        return np.conj(self.layer.symbol(m, creep))


@by_scene
def test_a_belt_that_runs_backwards_is_the_mirror_image(name):
    forth = solve_grid(SCENES[name], 512)
    back = solve_grid(replace(SCENES[name], support=Backwards(SCENES[name].layer)), 512)
    np.testing.assert_allclose(back.pressure, forth.pressure[::-1], rtol=0, atol=1e-10 * forth.pressure.max())
    assert back.friction == pytest.approx(-forth.friction, rel=1e-10)
    assert back.friction_by_loss == pytest.approx(-forth.friction_by_loss, rel=1e-10)
    np.testing.assert_allclose(back.strips, -forth.strips[::-1, ::-1], rtol=0, atol=1e-9)


@by_scene
def test_load_and_compliance_scale(name):
    # half the compliance under twice the pressure is the same surface
    problem = SCENES[name]
    times = problem.creep.times
    stiff = replace(
        problem,
        pressure=2.0 * problem.pressure,
        # an instant term of long memory takes half of the compliance out of play
        creep=CreepSpectrum(0.5 * problem.creep.instantaneous, [*(0.5 * problem.creep.weights), 0.5], [*times, 1e12]),
    )
    soft, hard = solve_grid(problem, 512), solve_grid(stiff, 512)
    np.testing.assert_allclose(hard.pressure, 2.0 * soft.pressure, rtol=0, atol=1e-9 * hard.pressure.max())
    assert hard.friction == pytest.approx(soft.friction, rel=1e-9)
    assert hard.depth == pytest.approx(soft.depth, rel=1e-9)


def test_both_ways_to_solve_the_equations_agree(monkeypatch):
    direct = solve_grid(SCENES["free"], 1024)
    monkeypatch.setattr(module, "_DENSE_NODES", 10)
    krylov = solve_grid(SCENES["free"], 1024)
    # GMRES to 1e-12, times the condition of the preconditioned equations
    assert krylov.friction == pytest.approx(direct.friction, rel=1e-10)
    assert krylov.depth == pytest.approx(direct.depth, rel=1e-10)


def test_products_on_the_roll_alone_are_those_of_the_period():
    # R/λ 0.02: the roll takes 1/25 of the period, its nodes have a transform of their own
    problem = ContactProblem("half-space", 0.02, 1e-3, ONE)
    grid = ContactGrid(problem, 1 << 14)
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
    grid = ContactGrid(SCENES["confined"], 512)
    for pressure in (0.01, 0.05):
        alone = solve_grid(replace(SCENES["confined"], pressure=pressure), 512)
        assert grid.contact(pressure).friction == pytest.approx(alone.friction, rel=ROUNDING)


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
        solve_grid(SCENES["confined"], 2048)  # fewer nodes are gone through one by one


# a thin free plate on whose grid block exchanges run in circles
PLATE = ContactProblem("free", 0.259, 3.33e-4, CreepSpectrum(1.5e-6, [0.5, 0.4999985], [149.0, 2.56e6]), 0.00167, 0.16)


@pytest.mark.parametrize(("pressure", "error"), [([1.0, 4.0, 3.0], 0.75), ([3.0, 4.0, 1.0], 0.75), ([4.0, 3.0], 1.0)])
def test_the_peak_of_a_grid_errs_by_the_step_to_its_lower_neighbour(pressure, error):
    """Beyond the last node of a strip there is none."""
    problem = ContactProblem("free", 0.4, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
    grid = solve_grid(problem, 512)
    given = GridFields(replace(grid, x=grid.x[: len(pressure)], pressure=np.array(pressure)))
    assert given.errors(problem).peak == pytest.approx(error, rel=1e-12)


class TestRaisedFromNothing:
    @by_scene
    def test_the_same_contact(self, name):
        grid = ContactGrid(SCENES[name], 256)
        raised, limit, _ = grid.raised(SCENES[name].pressure)
        straight = grid.contact(SCENES[name].pressure)
        assert raised.friction == pytest.approx(straight.friction, rel=ROUNDING, abs=1e-15)
        assert raised.depth == pytest.approx(straight.depth, rel=ROUNDING)
        assert math.isinf(limit)

    @pytest.mark.parametrize("start", [None, 1e-7])
    def test_the_limit_is_where_the_end_is_reached(self, start):
        grid = ContactGrid(PLATE, 128)
        below = None if start is None else ContactGrid(PLATE, 256).contact(start)
        wrapped, limit, _ = grid.raised(PLATE.pressure, below)
        assert wrapped.at_roll_end
        assert not grid.raised(0.999 * limit)[0].at_roll_end
        assert grid.raised(1.001 * limit)[0].at_roll_end

    def test_where_block_exchanges_run_in_circles(self):
        grid = ContactGrid(PLATE, 128)
        found = grid.contact(PLATE.pressure)
        assert found.friction == pytest.approx(grid.raised(PLATE.pressure)[0].friction, rel=1e-9)
