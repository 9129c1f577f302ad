"""Thin bonded layers: the compressible one becomes a Winkler foundation, the incompressible one its own scaling law.

As h/a → 0 a compressible layer of ν carries p = M u/h with M = E (1-ν)/((1+ν)(1-2ν)) (symbol L → κ' q); an
incompressible one p'' = -(3/(2 h³)) u in the solver's scales (symbol 2q³/3).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.contact.closed_forms import winkler

RADIUS = 0.1
RHO = 2.0 * math.pi * RADIUS
WIDTH = 1e-3 * RHO  # entry of the contact: 1e-3 of R, so the circle is a parabola to 1e-6
RTOL = 1e-6


def _modulus(poisson):
    return (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))


def _pair(poisson, ratio, memory, slenderness):
    """Return the closed form and the solver's contact at its load; retardation length = memory times the entry."""
    thickness = slenderness * WIDTH
    modulus = _modulus(poisson)
    closed = winkler(
        equilibrium=modulus,
        moduli=np.array([modulus * (ratio - 1.0)]),
        memories=np.array([memory * WIDTH / ratio]),  # relaxation time = retardation time times E0/E∞
        entry=WIDTH,
        radius=RHO,
        thickness=thickness,
    )
    # lengths in 1/k and E0 = 1: W = p_m λ and p̃_m = 2(1-ν²) p_m/ρ
    problem = ContactProblem(
        "confined",
        radius=RADIUS,
        thickness=thickness,
        pressure=closed.load * (1.0 - poisson**2) / (math.pi * RHO),
        creep=CreepSpectrum(1.0 / ratio, [1.0 - 1.0 / ratio], [memory * WIDTH]),
        poisson=poisson,
    )
    return closed, solve(problem, rtol=RTOL)


SCENES = [(0.3, 5.0, 1.0), (0.3, 5.0, 0.1), (0.3, 5.0, 10.0), (0.3, 50.0, 1.0), (0.0, 5.0, 1.0)]


@pytest.mark.parametrize(("poisson", "ratio", "memory"), SCENES)
class TestCompressible:
    def test_friction_tends_to_winkler_with_the_cube_of_the_slenderness(self, poisson, ratio, memory):
        off = []
        for slenderness in (0.2, 0.1, 0.05):
            closed, found = _pair(poisson, ratio, memory, slenderness)
            off.append(found.friction / closed.friction - 1.0)
        # 0.16 h³/a³ at most was seen; the circle's 1e-6 and rtol remain under it
        assert abs(off[2]) < 0.2 * 0.05**3 + 1e-6 + RTOL
        assert abs(off[1]) < 0.25 * abs(off[0])

    def test_edges_tend_to_winkler_with_the_slenderness(self, poisson, ratio, memory):
        entry, leaving = [], []
        for slenderness in (0.1, 0.05):
            closed, found = _pair(poisson, ratio, memory, slenderness)
            low, high = found.patches[0] * RHO
            entry.append(high / closed.entry - 1.0)
            leaving.append(-low / closed.exit - 1.0)
        # a boundary layer of about h at each edge: halves with h, so 2·(fine) - (coarse) is what is left of it
        for coarse, fine in (entry, leaving):
            assert fine / coarse == pytest.approx(0.5, rel=0.02)
            assert abs(2.0 * fine - coarse) < 0.2 * 0.1**2


def _wide_loss(support, pressure, thickness, poisson):
    """Friction of a rubber with tan δ almost constant over 12 decades, 2.5 % of its compliance lossy."""
    weights = np.full(25, 1e-3)
    creep = CreepSpectrum(1.0 - weights.sum(), weights, np.logspace(-9.0, 3.0, 25))
    problem = ContactProblem(support, RADIUS, pressure, creep, thickness, poisson)
    return solve(problem, rtol=RTOL).friction


def _exponent(support, pressure, thickness=math.inf, poisson=0.5):
    """Return d ln μ/d ln W between half and twice the load."""
    low, high = (_wide_loss(support, factor * pressure, thickness, poisson) for factor in (0.5, 2.0))
    return math.log(high / low) / math.log(4.0)


# stiffness drifts by two weights of 1e-3 a decade, over the third of a decade by which the width changes: 1e-3


def test_compressible_force_grows_with_the_load_to_four_thirds():
    # Winkler: W^(4/3) h^(1/3) R^(-2/3) E^(-1/3)
    thickness = 0.05 * WIDTH
    load = 2.0 * WIDTH**3 / (3.0 * RHO * thickness) * _modulus(0.3)
    pressure = load * (1.0 - 0.3**2) / (math.pi * RHO)
    assert _exponent("confined", pressure, thickness, 0.3) == pytest.approx(1.0 / 3.0, abs=1e-3)
    # h^(1/3) at fixed load
    thick, thin = (_wide_loss("confined", pressure, f * thickness, 0.3) for f in (2.0, 0.5))
    assert math.log(thick / thin) / math.log(4.0) == pytest.approx(1.0 / 3.0, abs=2e-3)


def test_half_space_force_grows_with_the_load_to_three_halves():
    # a ~ W^(1/2), μ ~ a/R
    assert _exponent("half-space", 0.25e-6) == pytest.approx(0.5, abs=1e-3)


def test_incompressible_force_grows_with_the_load_to_six_fifths():
    # p ~ E a⁴/(R h³): W ~ a⁵, μ ~ a/R; the edges give 2.6e-3 at h/a = 0.1 and 3e-4 at 0.05
    assert _exponent("confined", _bonded_load(0.1), 0.1 * WIDTH) == pytest.approx(0.2, abs=4e-3)
    assert _exponent("confined", _bonded_load(0.05), 0.05 * WIDTH) == pytest.approx(0.2, abs=1.5e-3)


def _bonded_load(slenderness):
    """p̃_m of the thin incompressible elastic layer, p̃ = (α² - X²)²/(16 (kh)³ ρ²), so p̃_m = α⁵/(30 π (kh)³ ρ²)."""
    return WIDTH**5 / (30.0 * math.pi * (slenderness * WIDTH) ** 3 * RHO**2)


def test_incompressible_elastic_layer_tends_to_the_thin_film_law():
    elastic = CreepSpectrum(1.0)
    widths, depths = [], []
    for slenderness in (0.1, 0.05, 0.025):
        problem = ContactProblem("confined", RADIUS, _bonded_load(slenderness), elastic, slenderness * WIDTH)
        found = solve(problem, rtol=RTOL)
        widths.append(found.half_width * RHO / WIDTH)
        depths.append(found.penetration * 6.0 * RHO**2 / WIDTH**2)
    # the boundary layer at the edges takes 1.46 h from the width: first order, halved with h
    lost = 1.0 - np.array(widths)
    np.testing.assert_allclose(lost[1:] / lost[:-1], 0.5, rtol=0.03)
    assert 2.0 * widths[2] - widths[1] == pytest.approx(1.0, abs=2.0 * 0.025**2)
    # Δ = a²/(6R) with an error of the second order in h/a
    off = np.abs(np.array(depths) - 1.0)
    assert off[2] < 6.0 * 0.025**2
    np.testing.assert_allclose(off[1:] / off[:-1], 0.25, rtol=0.15)
