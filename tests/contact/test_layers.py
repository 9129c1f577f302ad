"""Layer symbols against their formulas in 60 digits, their limits, and the half-space they become."""

from __future__ import annotations

from itertools import pairwise

import mpmath
import numpy as np
import pytest

from conveyor.contact import Confined, CreepSpectrum, Free, HalfSpace
from conveyor.contact.closed_forms import plate_symbol
from conveyor.contact.layers.layer_models import HALF_SPACE_DEPTH, confined_symbol, free_symbol

DEPTHS = np.concatenate([np.logspace(-6, 1.5, 40), [0.9999999, 1.0, 1.0000001, 0.5, 0.50000001, 25.0, 400.0]])
CREEP = CreepSpectrum(0.1, [0.9], [1.0])


def _free(q):
    q = mpmath.mpf(float(q))
    return (mpmath.sinh(2 * q) + 2 * q) / (mpmath.cosh(2 * q) - 1 - 2 * q**2)


def _confined(q, poisson):
    q, k = mpmath.mpf(float(q)), 3 - 4 * mpmath.mpf(poisson)
    return (2 * k * mpmath.sinh(2 * q) - 4 * q) / (2 * k * mpmath.cosh(2 * q) + 4 * q**2 + 1 + k**2)


def test_free_symbol():
    with mpmath.workdps(60):
        expected = [float(_free(q)) for q in DEPTHS]
    np.testing.assert_allclose(free_symbol(DEPTHS), expected, rtol=2e-14)


@pytest.mark.parametrize("poisson", [0.0, 0.25, 0.3, 0.499, 0.5])
def test_confined_symbol(poisson):
    with mpmath.workdps(60):
        expected = [float(_confined(q, poisson)) for q in DEPTHS]
    np.testing.assert_allclose(confined_symbol(DEPTHS, poisson), expected, rtol=2e-14)


def test_confined_symbol_of_the_incompressible_layer_is_the_short_form():
    q = np.array([0.5, 1.0, 3.0])
    short = (np.sinh(2 * q) - 2 * q) / (np.cosh(2 * q) + 1 + 2 * q**2)
    np.testing.assert_allclose(confined_symbol(q), short, rtol=1e-14)


def test_thin_free_layer_is_a_plate():
    q = np.array([1e-1, 1e-2])
    # plate: 6/q³ with a relative remainder q²/5 + O(q⁴)
    np.testing.assert_allclose(free_symbol(q) / plate_symbol(q) - 1.0, q**2 / 5.0, rtol=2e-2)


def test_thin_confined_layers():
    q = np.array([1e-4, 1e-3])
    np.testing.assert_allclose(confined_symbol(q), 2.0 * q**3 / 3.0, rtol=2e-6)
    # Winkler: u = p h (1+ν)(1-2ν)/(E (1-ν)), and L = q u E/(2 (1-ν²) p h)
    nu = 0.3
    np.testing.assert_allclose(confined_symbol(q, nu), q * (1 - 2 * nu) / (2 * (1 - nu) ** 2), rtol=2e-6)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_symbols_are_one_beyond_the_reach(poisson):
    q = np.array([HALF_SPACE_DEPTH, 30.0, 500.0])
    np.testing.assert_allclose(free_symbol(q), 1.0, rtol=2e-14)
    np.testing.assert_allclose(confined_symbol(q, poisson), 1.0, rtol=2e-14)


def test_free_layer_is_softer_and_confined_stiffer_than_the_half_space():
    # up to q = 15: beyond, the difference is lost in rounding
    q = np.linspace(0.05, 15.0, 300)
    assert np.all(free_symbol(q) > 1.0)
    assert np.all(confined_symbol(q) < 1.0)


def test_confined_layer_softens_as_poisson_ratio_falls():
    # at equal E/(1-ν²): the bond to the plane hinders an incompressible layer most
    q = np.linspace(0.05, 5.0, 100)
    values = [confined_symbol(q, nu) for nu in (0.5, 0.4, 0.3, 0.2)]
    for stiff, soft in pairwise(values):
        assert np.all(soft > stiff)


@pytest.mark.parametrize("layer", [HalfSpace(), Free(0.7), Confined(0.7, 0.5), Confined(0.7, 0.3)])
def test_symbol_is_layer_times_compliance_and_reach_says_where_it_ends(layer):
    m = np.array([1.0, 3.0, 10.0])
    ratio = layer.symbol(m, CREEP) / CREEP.compliance(m)
    np.testing.assert_allclose(ratio.imag, 0.0, atol=1e-15)
    beyond = np.array([max(layer.reach, 1.0) * 1.0001])
    np.testing.assert_allclose(layer.symbol(beyond, CREEP), CREEP.compliance(beyond), rtol=2e-14)
