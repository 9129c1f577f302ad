"""The orders beyond the core: against the dense matrix that holds them all; edge layers no dense matrix resolves."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import special

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve
from conveyor.contact.galerkin.bessel import ProductIK
from conveyor.contact.galerkin.order_tail import OrderTail, neighbour_ratios
from conveyor.contact.galerkin.quadrature import build_rule
from conveyor.contact.galerkin.spectral import (
    assemble_matrix,
    mean_displacement,
    nested_matrices,
    solve_equilibrium,
)
from conveyor.contact.solvers.one_strip import HalfWidthStart, layer_beyond_reach, solve_one_strip
from conveyor.contact.solvers.solver_state import SolverState

ALPHA, CORE, LAST = 0.03, 64, 256


@pytest.mark.parametrize("order", [32, 64, 1000])
def test_ratios_of_neighbours_are_those_of_bessel_functions(order):
    # scaled functions that neither overflow nor lose digits: ratios to some units of rounding
    b = np.array([0.3, 3.0, 40.0, 1e3, 1e6]) * order / 32.0
    upper, lower = neighbour_ratios(order, order + 2, b)
    seen = special.ive(order, b) > 1e-250
    assert seen.sum() >= 3
    x = b[seen]
    assert upper[0, seen] == pytest.approx(special.ive(order + 1, x) / special.ive(order, x), rel=1e-12)
    assert lower[0, seen] == pytest.approx(special.kve(order, x) / special.kve(order + 1, x), rel=1e-12)
    # the recurrences I_{v-1} - I_{v+1} = 2v/b I_v and K_{v+1} - K_{v-1} = 2v/b K_v
    rise = 2.0 * (order + 1.0) / b
    assert upper[0] * (rise + upper[1]) == pytest.approx(np.ones(5), rel=1e-14)
    assert lower[1] * (rise + lower[0]) == pytest.approx(np.ones(5), rel=1e-14)


@pytest.mark.parametrize("terms", [1, 6])
class TestAgainstAllOrdersAtOnce:
    """A matrix of order 256, and a core of 64 that the other 192 orders are eliminated onto."""

    @pytest.fixture
    def dense_and_closed(self, terms):
        rng = np.random.default_rng(terms)
        creep = CreepSpectrum(1e-3, np.full(terms, 0.999 / terms), 10.0 ** rng.uniform(-6.0, 1.0, terms))
        problem = ContactProblem("confined", 0.05, 1e-3, creep, 0.3)
        place = np.array([ALPHA])
        rule = build_rule(problem.layer, creep, ALPHA)
        dense = assemble_matrix(rule, creep, place, LAST)
        ik = ProductIK(CORE, place[:, None] / creep.times)
        tail = OrderTail.of(ALPHA, creep, CORE, LAST)
        closed, lower = tail.closed(assemble_matrix(rule, creep, place, CORE, ik), ik)
        whole = solve_equilibrium(dense, place, problem.rho)
        core = solve_equilibrium(closed, place, problem.rho)
        return problem, rule, dense, ik, tail, lower, whole, core

    def test_every_coefficient_is_the_same(self, dense_and_closed):
        *_, ik, tail, _, whole, core = dense_and_closed
        found = tail.coefficients(ik, core.c[0])
        assert found == pytest.approx(whole.c[0], abs=1e-12 * np.abs(whole.c).max())
        assert core.friction == pytest.approx(whole.friction, rel=1e-12)
        assert core.eps == pytest.approx(whole.eps, rel=1e-12)

    def test_so_are_those_of_shorter_tails_and_of_smaller_cores(self, dense_and_closed):
        problem, _, dense, _, _, lower, whole, _ = dense_and_closed
        place = np.array([ALPHA])
        (half_core, most_core), tails = lower
        for shorter, block in zip(tails, nested_matrices(dense), strict=True):
            exact = solve_equilibrium(block, place, problem.rho).friction
            assert solve_equilibrium(shorter, place, problem.rho).friction == pytest.approx(exact, rel=1e-12)
        # the correction ends at m α = 60 · 0.03: all of it lies within order 32
        for smaller in (half_core, most_core):
            assert solve_equilibrium(smaller, place, problem.rho).friction == pytest.approx(whole.friction, rel=1e-12)

    def test_level_and_loss_are_the_same(self, dense_and_closed):
        problem, rule, _, ik, tail, _, whole, core = dense_and_closed
        place, creep = np.array([ALPHA]), problem.creep
        here = mean_displacement(rule, creep, place, core.c.shape[1])[0] @ core.c[0] + tail.level(ik, core.c[0])
        beyond = mean_displacement(rule, creep, place, whole.c.shape[1])[0] @ whole.c[0]
        assert here == pytest.approx(beyond, rel=1e-12)
        weights = creep.weights * creep.times
        every = ProductIK(LAST, place[:, None] / creep.times)
        v = np.arange(1.0, LAST + 1.0)
        lost = ik.quadratic(weights, v[:CORE] * core.c)[0] + tail.quadratic(ik, whole.c[0])
        assert lost == pytest.approx(every.quadratic(weights, v * whole.c)[0], rel=1e-11)


@pytest.mark.parametrize("instantaneous", [1e-3, 1e-5])
def test_an_edge_layer_a_millionth_wide_is_resolved(instantaneous):
    # ζ j∞/α = 2e-6: order 512 left 4e-5; the first law, formed apart, agrees to rounding
    zeta = 2e-6 * 0.0075 / instantaneous
    creep = CreepSpectrum(instantaneous, [1.0 - instantaneous], [zeta])
    found = solve(ContactProblem("half-space", 0.05, 1e-3, creep), rtol=1e-9)
    assert found.status is Status.OK
    assert found.stats.order > 512
    assert found.energy_error <= 1e-9
    tighter = solve(ContactProblem("half-space", 0.05, 1e-3, creep), rtol=1e-11)
    assert abs(tighter.friction / found.friction - 1.0) <= found.error_estimate
    assert found.pressure(np.linspace(-1.0, 1.0, 999)[np.newaxis] * found.half_width).min() >= -1e-9


def test_a_long_tail_gives_what_a_dense_matrix_does():
    # order 128 meets 1e-8 here; the same scene by a core of 64 and a tail to 1024
    problem = ContactProblem("confined", 0.1, 1e-3, CreepSpectrum(0.05, [0.95], [0.01]), 0.5)
    dense = solve(problem, rtol=1e-8)
    start = HalfWidthStart(np.log(dense.half_width * problem.rho), 2.0)
    long = solve_one_strip(SolverState.of(problem), 1e-8, start).best
    assert long.order == 1024
    assert long.found.friction == pytest.approx(dense.friction, rel=2e-8)
    assert long.found.fields.depth() == pytest.approx(dense.penetration, rel=1e-8)
    assert long.found.fields.peak() == pytest.approx(dense.peak_pressure, rel=1e-6)


def test_a_core_that_the_energy_doubts_is_lengthened_not_its_tail():
    # a thin cover, its contact 17 times as wide: a core of 64 left 7e-9 at any tail
    creep = CreepSpectrum(0.37120710068382384, [0.62879289931617616], [2.61086272e-05])
    problem = ContactProblem("confined", 0.22029309106284228, 0.018418492740884012, creep, 0.0047395977, 0.38083557)
    found = solve(problem, rtol=1e-9)
    assert found.status is Status.OK
    assert found.stats.order == 1024
    tighter = solve(problem, rtol=1e-11)
    assert abs(tighter.friction / found.friction - 1.0) <= found.error_estimate


def test_an_error_that_falls_fast_is_not_beyond_reach():
    creep = CreepSpectrum(1e-4, [1.0 - 1e-4], [1e-9])  # its layer is beyond order 512
    scene = SolverState.of(ContactProblem("half-space", 0.05, 1e-3, creep))
    alpha = 0.0075
    contact = solve_equilibrium(scene.system(alpha, 96, 96).matrix, np.array([alpha]), scene.problem.rho)
    assert layer_beyond_reach(scene, contact, (96, 512), 1e3)
    assert not layer_beyond_reach(scene, contact, (96, 512), 1e3, falls=8.0)
