"""Tables of Bessel products against the products themselves, and weights moved to their grids."""

import numpy as np
import pytest

from conveyor.contact.fields.energy_balance import friction_by_loss
from conveyor.contact.galerkin.galerkin_tables import GalerkinTables
from conveyor.contact.galerkin.short_rule import ShortRule
from conveyor.contact.galerkin.spectral import assemble_matrix, solve_equilibrium
from conveyor.contact.layers import regrid
from conveyor.contact.layers.creep import CreepBatch

ALPHA = np.array([0.004, 0.03, 0.4])
RHO = np.array([0.3, 0.4, 1.5])


def creeps(times):
    """Three spectra of these times, a third part of each weight instantaneous."""
    weights = np.random.default_rng(1).dirichlet(np.ones(len(times)), size=3) * (2.0 / 3.0)
    return CreepBatch(np.full(3, 1.0 / 3.0), weights, np.outer([0.3, 1.0, 5.0], times))


def rule():
    """A few dozen nodes with weights that fall like those of a layer."""
    rng = np.random.default_rng(2)
    nodes = np.sort(rng.uniform(0.05, 40.0, (3, 30)), axis=1)
    weights = 0.05 * (rng.standard_normal(nodes.shape) + 1j * rng.standard_normal(nodes.shape)) / nodes
    return ShortRule(nodes, weights)


def test_moved_weights_sum_a_smooth_function_as_before():
    # Lagrange interpolation of cos at 16 points: step^16 (0.5·1.5·…·7.5)²/16! of the largest value, 3e-6 · 0.2^16
    rng = np.random.default_rng(0)
    places, weights = rng.uniform(0.0, 50.0, (2, 40)), rng.standard_normal((2, 40))
    (grid,) = regrid.regrid_weights(regrid.lagrange_stencils(places), 80, weights)
    at = 0.2 * (np.arange(80) - regrid.POINTS_BEFORE)
    np.testing.assert_allclose(grid @ np.cos(at), (weights * np.cos(0.2 * places)).sum(axis=1), atol=1e-12)
    np.testing.assert_allclose(grid.sum(axis=1), weights.sum(axis=1), atol=1e-12)


def test_moved_logarithms_keep_relative_precision_of_what_falls():
    b = np.geomspace(1e-12, 1e13, 200)[:, None]
    assert regrid.within_log_grid(regrid.log_places(b)).all()
    (grid,) = regrid.regrid_weights(
        regrid.lagrange_stencils(regrid.log_places(b)), regrid.LOG_GRID_SIZE, np.ones_like(b)
    )
    np.testing.assert_allclose(grid @ (1.0 / (1.0 + regrid.log_grid())), 1.0 / (1.0 + b[:, 0]), rtol=1e-7)
    assert not regrid.within_log_grid(regrid.log_places(np.array([[1.0, 1e-20]]))).any()


@pytest.mark.parametrize("order", [10, 32, 64])
@pytest.mark.parametrize("times", [[1.0], np.geomspace(1e-9, 1e8, 12)])
def test_matrices_and_losses_are_those_formed_one_by_one(order, times):
    # promised: 2e-12 of a node's weight, the terms' 1e-12, times the matrix's factor of 2 v
    side, given = creeps(times), rule()
    tabled, ratios = GalerkinTables.of(side, ALPHA), (0.8, 1.0, 1.3)
    found = tabled.matrices(given, order, ratios).reshape(3, 3, order + 1, order)
    tolerance = 4e-12 * 2.0 * order * max(np.abs(given.weights).sum(axis=1).max(), 1.0)
    for k, ratio in enumerate(ratios):
        expected = assemble_matrix(given, side, ratio * ALPHA, order)
        np.testing.assert_allclose(found[:, k], expected, rtol=0, atol=tolerance)
    contact = solve_equilibrium(found[:, 1], ALPHA, RHO)
    expected = friction_by_loss(given, side, contact, RHO)
    np.testing.assert_allclose(
        tabled.friction_by_loss(given, contact, RHO), expected, rtol=0, atol=1e-9 * np.abs(expected).max()
    )


@pytest.mark.parametrize(("order", "times"), [(96, [1.0]), (10, [1e-40])])
def test_what_the_tables_do_not_hold_is_formed_one_by_one(order, times):
    side, given = creeps(times), rule()
    found = GalerkinTables.of(side, ALPHA).matrices(given, order)
    np.testing.assert_array_equal(found, assemble_matrix(given, side, ALPHA, order))


def test_moved_weights_keep_what_is_small_at_the_start_of_the_grid():
    # sums that vanish with their places do so to rounding of the stencil's largest value, 1.6
    places = np.array([[1e-7, 1e-3]])
    (grid,) = regrid.regrid_weights(regrid.lagrange_stencils(places), 32, np.array([[1.0, -1.0]]))
    at = np.arange(32) - float(regrid.POINTS_BEFORE)
    for power in (0, 1, 2, 5):
        expected = 0.0 if power == 0 else 1e-7**power - 1e-3**power
        assert grid[0] @ (0.2 * at) ** power == pytest.approx(0.2**power * expected, abs=2e-15)
