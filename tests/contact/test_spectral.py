"""Matrix and quadrature: the closed half-space part plus the short correction is the plain infinite sum."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import special

from conveyor.contact import Confined, CreepSpectrum, Free, HalfSpace
from conveyor.contact.galerkin.quadrature import CHECK_PANELS, SOLVE_PANELS, Panels, build_rule
from conveyor.contact.galerkin.spectral import assemble_matrix, crown_depth, solve_equilibrium
from conveyor.errors import NoSolutionError

TERMS = {
    "elastic": CreepSpectrum(1.0),
    "short": CreepSpectrum(0.1, [0.9], [1e-3]),
    "near": CreepSpectrum(0.1, [0.9], [1.0]),
    "long": CreepSpectrum(0.1, [0.9], [1e4]),
    "wide": CreepSpectrum(0.05, [0.25, 0.3, 0.4], [0.02, 0.5, 20.0]),
}
LAYERS = {
    "half-space": HalfSpace(),
    "free": Free(1.0),
    "thin": Free(0.3),
    "confined": Confined(1.0),
    "ν 0.3": Confined(0.5, 0.3),
}
ORDER = 6
by_layer = pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
by_creep = pytest.mark.parametrize("creep", TERMS.values(), ids=TERMS)
WIDTHS = pytest.mark.parametrize("alpha", [0.05, 0.6, 1.9, 2.8])


def _plain_sum(layer, creep, alpha):
    """Sum the matrix entries to m α = 3e4."""
    m = np.arange(1.0, 3e4 / alpha)
    i = np.arange(ORDER + 1)[:, None]
    bessel = np.array([special.jv(v, m * alpha) for v in range(ORDER + 1)])
    symbol = layer.symbol(m, creep)
    matrix = np.empty((ORDER + 1, ORDER))
    for v in range(1, ORDER + 1):
        phase = (1j) ** ((i - v + 2) % 4)
        terms = np.real(phase * symbol) * bessel[v] * bessel / m
        matrix[:, v - 1] = np.where(i[:, 0] == 0, 1.0, 2.0) * v * terms.sum(axis=1)
    return matrix


@by_layer
@by_creep
def test_matrix_is_the_plain_sum(layer, creep):
    alpha = 0.6
    rule = build_rule(layer, creep, alpha)
    matrix = assemble_matrix(rule, creep, np.array([alpha]), ORDER)[0]
    # the rest of the plain sum: J J <= 2/(π m α), so at most 2 v Σ_{m>M} 2/(π α m²) = 4 v/(π α M) with α M = 3e4
    np.testing.assert_allclose(matrix, _plain_sum(layer, creep, alpha), rtol=0, atol=4 * ORDER / (math.pi * 3e4))


@by_layer
@by_creep
@WIDTHS
@pytest.mark.parametrize(
    "panels",
    [CHECK_PANELS, Panels(points=24, stretch=1.0, phase=8.0, ramps=1.5, window=2.0)],
    ids=["check", "fine"],
)
def test_panels_and_window_do_not_matter(layer, creep, alpha, panels):
    n = 24
    matrices = [
        assemble_matrix(build_rule(layer, creep, alpha, p), creep, np.array([alpha]), n)[0]
        for p in (SOLVE_PANELS, panels)
    ]
    # panels are graded for 1e-13 of each integral; weights v up to 24 multiply it: 2.6e-12 of the largest entry seen
    scale = np.abs(matrices[1]).max()
    np.testing.assert_allclose(matrices[0], matrices[1], rtol=0, atol=5e-12 * scale)


@by_layer
def test_rule_is_good_for_narrower_contacts_too(layer):
    creep = TERMS["near"]
    wide, narrow = (build_rule(layer, creep, width) for width in (1.5, 0.3))
    matrices = [assemble_matrix(rule, creep, np.array([0.3]), 12) for rule in (wide, narrow)]
    np.testing.assert_allclose(matrices[0], matrices[1], rtol=0, atol=1e-13 * np.abs(matrices[1]).max())


@by_layer
@by_creep
def test_penetration_does_not_depend_on_the_panels(layer, creep):
    rho = 2.5
    depth = []
    for panels in (SOLVE_PANELS, CHECK_PANELS):
        rule = build_rule(layer, creep, 0.6, panels)
        alpha = np.array([0.6])
        contact = solve_equilibrium(assemble_matrix(rule, creep, alpha, 16), alpha, rho)
        depth.append(crown_depth(rule, creep, contact, rho)[0])
    # a sum with one power of m more than the matrix: the graded panel at zero limits it to 1e-9
    assert depth[0] == pytest.approx(depth[1], rel=1e-9)


def test_matrices_are_nested():
    creep = TERMS["wide"]
    rule = build_rule(Free(1.0), creep, 0.8)
    alpha = np.array([0.8, 0.2])
    large, small = (assemble_matrix(rule, creep, alpha, n) for n in (24, 8))
    np.testing.assert_allclose(large[:, :9, :8], small, rtol=1e-12, atol=1e-14)


def test_a_batch_is_its_members():
    creep = TERMS["wide"]
    rule = build_rule(Confined(0.5), creep, 0.8)
    alpha = np.array([0.1, 0.4, 0.8])
    together = assemble_matrix(rule, creep, alpha, 12)
    for place, a in enumerate(alpha):
        np.testing.assert_allclose(
            together[place], assemble_matrix(rule, creep, np.array([a]), 12)[0], rtol=1e-13, atol=1e-15
        )


def test_elastic_half_space_matrix_is_the_identity_with_images():
    # Σ_m J_v J_i/m → ∫: the diagonal of the isolated half-space is -1, images fall with α²
    alpha = 1e-4
    matrix = assemble_matrix(build_rule(HalfSpace(), TERMS["elastic"], alpha), TERMS["elastic"], np.array([alpha]), 8)[
        0
    ]
    np.testing.assert_allclose(matrix[1:], -np.eye(8), rtol=0, atol=alpha**2)
    np.testing.assert_allclose(matrix[0], 0.0, rtol=0, atol=alpha**2)


def test_a_layer_too_thin_for_the_contact_is_refused_with_the_reason():
    with pytest.raises(NoSolutionError, match=r"too wide for so thin a layer .*thicker layer or a smaller load"):
        build_rule(Confined(1e-9), TERMS["near"], 1.0)
