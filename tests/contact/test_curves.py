"""Load curves side by side: the same curves as one by one, in any company."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from conveyor.contact import (
    ContactProblem,
    CreepSpectrum,
    LoadCurve,
    frictions,
    load_curve,
    load_curves,
    solve,
)
from conveyor.errors import InputError, NoSolutionError, RangeError

TERMS = CreepSpectrum(0.05, np.full(10, 0.095), np.logspace(-6, 3, 10))
ELASTIC = CreepSpectrum(1.0)
SCENES = [
    ContactProblem("confined", 0.0663, 0.004, TERMS, 0.0209),
    ContactProblem("confined", 0.03, 0.002, CreepSpectrum(0.2, [0.8], [0.02]), 0.05),
    ContactProblem("confined", 0.0663, 0.004, ELASTIC, 0.0209),
    ContactProblem("half-space", 0.0663, 1e-4, TERMS),
    ContactProblem("free", 0.1, 1e-5, TERMS, 2.0),
    ContactProblem("confined", 0.4, 0.05, CreepSpectrum(0.1, [0.9], [1.0]), 1.0),  # wide: sampled by itself
]
HIGH = np.array([p.pressure for p in SCENES])
LOW = HIGH / 20.0


def test_many_curves_are_read_as_each_by_itself():
    curves = load_curves(SCENES, LOW, HIGH, 1e-4)
    loads = [np.geomspace(low, high, 3 + k) for k, (low, high) in enumerate(zip(LOW, HIGH, strict=True))]
    for curve, p, friction in zip(curves, loads, frictions(curves, loads), strict=True):
        np.testing.assert_allclose(friction, curve.at(p).friction, rtol=1e-12, atol=1e-15)  # Newton to 1e-18
        again = frictions([curve, curve], [p.reshape(-1, 1), p[:1]])
        assert again[0].shape == (p.size, 1)
        np.testing.assert_allclose(again[1], friction[:1], rtol=1e-12, atol=1e-15)
    with pytest.raises(RangeError, match="the load curve holds"):
        frictions(curves[:2], [loads[0], 2.0 * loads[1]])


@pytest.mark.parametrize("rtol", [1e-3, 1e-4, 1e-6])
def test_curves_are_those_of_one_scene(rtol):
    found = load_curves(SCENES, LOW, HIGH, rtol)
    for scene, curve, low, high in zip(SCENES, found, LOW, HIGH, strict=True):
        assert isinstance(curve, LoadCurve)
        assert curve.error <= rtol
        loads = np.geomspace(low, high, 9)
        one = load_curve(scene, low, high, rtol).at(loads)
        both = curve.error + one.error_estimate.max()
        np.testing.assert_allclose(curve.at(loads).friction, one.friction, rtol=both, atol=1e-13)
        # lengths are as good as the square root of friction's error where the curve is interpolated
        np.testing.assert_allclose(curve.at(loads).half_width, one.half_width, rtol=10.0 * rtol)


@pytest.mark.parametrize("k", range(5))
def test_error_covers_a_tighter_solve(k):
    (curve,) = load_curves(SCENES[k : k + 1], LOW[k : k + 1], HIGH[k : k + 1], 1e-3)
    loads = np.geomspace(LOW[k], HIGH[k], 11)
    exact = np.array([solve(replace(SCENES[k], pressure=p), 1e-8).friction for p in loads])
    np.testing.assert_allclose(curve.at(loads).friction, exact, rtol=curve.error, atol=1e-13)


def test_company_and_order_do_not_matter():
    alone = [load_curves([s], [lo], [hi], 1e-4)[0] for s, lo, hi in zip(SCENES, LOW, HIGH, strict=True)]
    turned = load_curves(SCENES[::-1], LOW[::-1], HIGH[::-1], 1e-4)[::-1]
    for one, other, high in zip(alone, turned, HIGH, strict=True):
        # scenes of a batch share their number of quadrature nodes: the same to the coarse rules' error
        assert one.at(high).friction == pytest.approx(other.at(high).friction, rel=2e-8, abs=1e-13)


def test_a_scene_without_a_curve_gives_its_reason_and_the_others_their_curves():
    split = ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
    found = load_curves([SCENES[0], split], [LOW[0], 0.05], [HIGH[0], 0.13], 1e-4)
    assert isinstance(found[0], LoadCurve)
    assert isinstance(found[1], NoSolutionError)
    assert "strips" in str(found[1])


def test_one_load_is_a_curve_too():
    (curve,) = load_curves(SCENES[:1], HIGH[:1], HIGH[:1], 1e-4)
    assert curve.at(HIGH[0]).friction == pytest.approx(solve(SCENES[0], 1e-6).friction, rel=1.1e-4)


@pytest.mark.parametrize(("low", "high"), [([1.0], [0.5]), ([0.0], [1.0]), ([0.1, 0.1], [1.0, 1.0]), ([np.nan], [1.0])])
def test_ranges_are_refused(low, high):
    with pytest.raises(InputError, match=r"one of each for every scene, 0 < lowest <= highest"):
        load_curves(SCENES[:1], low, high)


def test_no_scenes_no_curves():
    assert load_curves([], [], []) == []


def test_a_batch_without_a_narrow_scene_has_its_reasons():
    # a free cover of 4 mm under a roll: what the command line's support: free asks for
    thin = replace(SCENES[0], support="free")
    (found,) = load_curves([thin], LOW[:1], HIGH[:1], 1e-4)
    assert isinstance(found, NoSolutionError)
