"""The smooth curve common to shifted isotherms, against the mixed model of the textbook."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.rubber.common_curve import PENALTY_ORDER, Smoother, spline_basis


def restricted(b, y, weight, strength):
    """-2 log of the restricted likelihood of y = B c + e, ORDER-th differences of c free of all but a variance.

    C. D. Patterson, R. Thompson, Biometrika 58 (1971) 545: fixed X, random Z u, V = W^-1 + Z Z'/λ, variance profiled.
    """
    differences = np.diff(np.eye(b.shape[1]), PENALTY_ORDER, axis=0)
    fixed = b @ np.vander(np.linspace(-1.0, 1.0, b.shape[1]), PENALTY_ORDER)
    random = b @ np.linalg.pinv(differences)
    covariance = np.diag(1.0 / weight) + random @ random.T / strength
    inverse = np.linalg.inv(covariance)
    normal = fixed.T @ inverse @ fixed
    rest = y - fixed @ np.linalg.solve(normal, fixed.T @ inverse @ y)
    free = y.size - PENALTY_ORDER
    determinants = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(normal)[1]
    return determinants + free * np.log(rest @ inverse @ rest)


def test_the_stiffness_is_judged_by_the_restricted_likelihood():
    rng = np.random.default_rng(5)
    x = np.sort(rng.uniform(0.0, 6.0, 40))
    y = np.tanh(x - 3.0) + 0.05 * rng.standard_normal(x.size)
    weight = rng.uniform(0.5, 2.0, x.size)
    splines = spline_basis(x, 0.5)
    smoother = Smoother(splines, y, weight)
    stiffness = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    found = np.array([smoother.likelihood(s) for s in stiffness])
    expected = np.array([restricted(splines.matrix, y, weight, 10.0**s) for s in stiffness])
    # up to one constant
    assert found - found[0] == pytest.approx(expected - expected[0], abs=1e-6)
    best = smoother.best_stiffness()
    assert smoother.likelihood(best) <= found.min()
