"""Largest pressures: closer by smoothing, with an error that holds for sharp and for broad rubber."""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.contact.pressure import growth, peak, peak_error, sampled_sines, settled
from conveyor.contact.scene import Scene
from conveyor.contact.spectral import equilibrium

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
    """Coefficients over sqrt(p̃_m), half width: of each scene at one half width, by order; 384 last."""
    found = {}
    for name, problem in SCENES.items():
        scene, alpha = Scene.of(problem), solve(problem, 1e-6).half_width * problem.rho
        by_order = {}
        for n in (*ORDERS, 384):
            contact = equilibrium(scene.system(alpha, n, n).matrix, np.array([alpha]), problem.rho)
            by_order[n] = contact.c / math.sqrt(contact.pressure[0])
        found[name] = by_order, alpha
    return found


@pytest.mark.parametrize("name", SCENES)
def test_error_of_the_largest_pressure_holds(contacts, name):
    by_order, alpha = contacts[name]
    exact = peak(by_order[384])[0]
    for n in ORDERS:
        c = by_order[n]
        told = peak_error(c, np.array([growth(SCENES[name].creep, alpha, n)]))[0]
        assert abs(peak(c)[0] / exact - 1.0) <= told + ROUNDING, n
    assert told < {"broad": 5e-3, "sharp": 5.0, "resolved": 1e-6}[name]


def test_smoothing_brings_the_largest_pressure_of_broad_rubber_nearer(contacts):
    by_order, _ = contacts["broad"]
    exact = peak(by_order[384])[0]
    for n in ORDERS[1:]:
        rippled = sampled_sines(by_order[n], 8 * n).max()
        assert abs(peak(by_order[n])[0] / exact - 1.0) < 0.3 * abs(rippled / exact - 1.0), n


def test_a_series_that_falls_exponentially_is_summed_as_it_is(contacts):
    c = contacts["resolved"][0][64]
    np.testing.assert_allclose(settled(c), c, rtol=1e-15)
    rippled = contacts["broad"][0][64]
    np.testing.assert_allclose(settled(rippled)[:, :32], rippled[:, :32], rtol=1e-15)
    assert abs(settled(rippled)[0, -1]) < 0.01 * abs(rippled[0, -1])


def test_pressure_grows_only_where_rubber_flows():
    # one time: j = j∞ + (1 - j∞)/(1 + iy) has its tangent above one between y = 1/(1 - 2j∞) and about 1/j∞
    alpha, n = 0.01, 16
    seen = 0.05 * n**2 / alpha
    for instantaneous in (1e-2, 1e-4):
        flows = 1.0 / instantaneous
        at_once = CreepSpectrum(instantaneous, [1.0 - instantaneous], [1.0 / seen])
        assert growth(at_once, alpha, n) == pytest.approx(math.sqrt(flows), rel=0.1)
        later = CreepSpectrum(instantaneous, [1.0 - instantaneous], [0.1 / seen])
        assert growth(later, alpha, n) == pytest.approx(math.sqrt(flows / 10.0), rel=0.1)
    assert growth(CreepSpectrum(0.3, [0.7], [1e-6]), alpha, n) == 1.0  # tangent 0.64 at most
    assert growth(CreepSpectrum(1.0), alpha, n) == 1.0


@pytest.mark.parametrize("rtol", [1e-4, 1e-6])
def test_a_solved_cover_tells_its_largest_pressure(rtol):
    problem = SCENES["broad"]
    found, fine = solve(problem, rtol), solve(problem, 1e-9)
    assert abs(found.peak_pressure / fine.peak_pressure - 1.0) <= found.peak_error
    assert found.peak_error < {1e-4: 0.05, 1e-6: 5e-3}[rtol]
    x = np.linspace(*found.patches[0], 4001)
    assert found.pressure(x).max() == pytest.approx(found.peak_pressure, rel=1e-5)
