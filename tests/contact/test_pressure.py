"""Largest pressures: closer by smoothing, with an error that holds for sharp and for broad rubber."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve, solve_many
from conveyor.contact.galerkin.pressure import largest_pressure, sample_sine_sum, smoothed_coefficients
from conveyor.contact.galerkin.spectral import solve_equilibrium
from conveyor.contact.solvers.peak_error import flow_order, peak_error
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.indentation import RollContact, to_problem
from conveyor.shelf import compound

BROAD = CreepSpectrum(0.02, np.full(14, 0.07), np.logspace(-4.0, 4.0, 14))
SHARP = CreepSpectrum(0.02, [0.98], [1e-3])
SOFT = CreepSpectrum(0.3, [0.7], [0.1])
SCENES = {
    "broad": ContactProblem("confined", 0.066, 0.0037, BROAD, 0.0314),
    "sharp": ContactProblem("confined", 0.066, 0.0037, SHARP, 0.0314),
    "resolved": ContactProblem("free", 0.4, 0.05, SOFT, 1.0),
}
ROUNDING = 1e-13  # of sums of some hundred terms
ORDERS = (24, 32, 48, 64, 96)


@pytest.fixture(scope="module")
def contacts():
    """Of each scene at one half width, by order; 384 last."""
    found = {}
    for name, problem in SCENES.items():
        scene, alpha = SolverState.of(problem), solve(problem, 1e-6).half_width * problem.rho
        found[name] = {
            n: solve_equilibrium(scene.system(alpha, n, n).matrix, np.array([alpha]), problem.rho)
            for n in (*ORDERS, 384)
        }
    return found


def carried(contact):
    """Largest pressure over the root of the load, which compares orders at one half width."""
    return largest_pressure(contact.c)[0] / math.sqrt(contact.pressure[0])


@pytest.mark.parametrize("name", SCENES)
def test_error_of_the_largest_pressure_holds(contacts, name):
    by_order = contacts[name]
    exact = carried(by_order[384])
    for n in ORDERS:
        true = abs(carried(by_order[n]) / exact - 1.0)
        at_its_load = replace(SCENES[name], pressure=float(by_order[n].pressure[0]))
        told = peak_error(at_its_load, by_order[n])
        moved = abs(math.log(by_order[384].pressure[0] / by_order[n].pressure[0]))
        assert true <= told + ROUNDING, n
        # three times what a finer order differs by, which is nearer; and by how much its load differs
        assert told <= 5.0 * true + 2.0 * moved + 1e-5, n


def strips_and_edges(rng):
    """A scene of one to three times, E∞/E0 3 to 1000, of loads and speeds that excite them."""
    terms = rng.integers(1, 4)
    instantaneous = 10.0 ** rng.uniform(-3.0, -0.5)
    weights = rng.dirichlet(np.ones(terms)) * (1.0 - instantaneous)
    creep = CreepSpectrum(1.0 - weights.sum(), weights, 10.0 ** rng.uniform(-3.5, 0.5, terms))
    support = str(rng.choice(["half-space", "confined", "free"]))
    radius, pressure = rng.uniform(0.03, 0.4), 10.0 ** rng.uniform(-3.0, -1.2)
    thickness = math.inf if support == "half-space" else 10.0 ** rng.uniform(-1.5, 0.7)
    return ContactProblem(support, radius, pressure, creep, thickness)


def test_what_is_told_holds_for_sharp_and_broad_rubber_and_to_some_purpose():
    rng = np.random.default_rng(11)
    problems = [strips_and_edges(rng) for _ in range(30)]
    for name, celsius, thickness in (("s100", -10.0, 0.01), ("s100", 20.0, 0.004), ("s100", 40.0, 0.01)):
        rubber = compound(name).series(273.15 + celsius)
        roll = RollContact(radius=0.0795, spacing=1.2, cover_thickness=thickness, speed=4.0, series=rubber)
        problems += [to_problem(roll, load) for load in (250.0, 4500.0)]
    over = []
    for rough, fine in zip(solve_many(problems, 1e-4), solve_many(problems, 1e-9), strict=True):
        if rough.status is Status.OK and fine.status is Status.OK and len(rough.patches) == len(fine.patches):
            true = abs(fine.peak_pressure / rough.peak_pressure - 1.0)
            assert true <= rough.peak_error
            if true > 1e-7:  # else the load, and rtol, are what is told
                over.append(rough.peak_error / true)
    assert len(over) > 15
    assert np.median(over) < 10.0


def test_smoothing_brings_the_largest_pressure_of_broad_rubber_nearer(contacts):
    by_order = contacts["broad"]
    exact = carried(by_order[384])
    for n in ORDERS[1:]:
        rippled = sample_sine_sum(by_order[n].c, 8 * n).max() / math.sqrt(by_order[n].pressure[0])
        assert abs(carried(by_order[n]) / exact - 1.0) < 0.3 * abs(rippled / exact - 1.0), n


def test_a_series_that_falls_exponentially_is_summed_as_it_is(contacts):
    c = contacts["resolved"][64].c
    np.testing.assert_allclose(smoothed_coefficients(c), c, rtol=1e-15)
    rippled = contacts["broad"][64].c
    np.testing.assert_allclose(smoothed_coefficients(rippled)[:, :32], rippled[:, :32], rtol=1e-15)
    assert abs(smoothed_coefficients(rippled)[0, -1]) < 0.01 * abs(rippled[0, -1])


def test_orders_are_asked_for_down_to_the_lengths_in_which_rubber_flows():
    # one time: j = j∞ + (1 - j∞)/(1 + iy) has its tangent above one between y = 1/(1 - 2j∞) and about 1/j∞
    alpha, n = 0.01, 16
    seen = 0.05 * n**2 / alpha
    for instantaneous in (1e-2, 1e-4):
        for later in (1.0, 10.0):
            creep = CreepSpectrum(instantaneous, [1.0 - instantaneous], [1.0 / (later * seen)])
            expected = n * math.sqrt(later / instantaneous)
            assert flow_order(creep, alpha, n) == pytest.approx(expected, rel=0.06)  # 24 wave numbers a decade
    assert flow_order(CreepSpectrum(0.3, [0.7], [1e-6]), alpha, n) == n  # tangent 0.64 at most
    assert flow_order(CreepSpectrum(1.0), alpha, n) == n
    # six decades in which pressure falls before two in which it grows
    later = CreepSpectrum(1e-3, [0.9, 0.099], [1e3 / seen, 1e-6 / seen])
    assert flow_order(later, alpha, n) == n


@pytest.mark.parametrize("rtol", [1e-4, 1e-6])
def test_a_solved_cover_tells_its_largest_pressure(rtol):
    problem = SCENES["broad"]
    found, fine = solve(problem, rtol), solve(problem, 1e-9)
    assert abs(found.peak_pressure / fine.peak_pressure - 1.0) <= found.peak_error
    assert found.peak_error < {1e-4: 0.05, 1e-6: 5e-3}[rtol]
    x = np.linspace(*found.patches[0], 4001)
    assert found.pressure(x).max() == pytest.approx(found.peak_pressure, rel=1e-5)


def test_errors_where_the_load_hardly_rises_with_the_half_width():
    # a thin elastic plate gives: d ln p̃_m/d ln α is 0.2, the half width is off by five times what the load is
    plate = ContactProblem(
        "free",
        0.394,
        thickness=0.00102,
        pressure=7.77e-12,
        creep=CreepSpectrum(1.0, [], []),
        poisson=0.14,
    )
    found, fine = solve(plate), solve(plate, rtol=1e-12)
    off = abs(fine.peak_pressure / found.peak_pressure - 1.0)
    assert 0.0 < off <= found.peak_error <= 5.0 * off
    moved = float(np.abs(fine.patches - found.patches).max())
    assert 0.0 < moved <= found.edge_error <= 5.0 * moved
