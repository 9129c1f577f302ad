"""The monotone cubic: SciPy's PCHIP, its limits by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from conveyor.rubber.monotone import MonotoneCubic


@pytest.mark.parametrize("count", [2, 3, 4, 9])
def test_it_is_pchip(count):
    random = np.random.default_rng(count)
    for _ in range(20):
        x = np.cumsum(random.random(count) + 0.01)
        y = random.normal(size=count).round(int(random.integers(0, 3)))  # with equal neighbours
        at = np.linspace(x[0], x[-1], 41)
        assert MonotoneCubic(x, y)(at) == pytest.approx(PchipInterpolator(x, y)(at), rel=1e-13, abs=1e-13)


def test_it_never_overshoots():
    x, y = np.arange(6.0), np.array([0.0, 0.0, 1.0, 1.0, 5.0, 5.0])
    found = MonotoneCubic(x, y)(np.linspace(0.0, 5.0, 501))
    assert np.all(np.diff(found) >= -1e-15)
    assert found[:101] == pytest.approx(np.zeros(101), abs=1e-15)
