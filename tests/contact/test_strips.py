"""Several strips, and contacts of given depth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, HalfSpace, Status, solve, solve_penetration
from conveyor.contact import general as module
from conveyor.contact.scene import Scene
from conveyor.contact.strips import friction_by_loss, settle, smallest_gap, too_close
from conveyor.errors import InputError, NoSolutionError

ONE = CreepSpectrum(0.1, [0.9], [1.0])
SPLIT = ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
SCENES = {
    "confined": ContactProblem("confined", 0.4, 0.05, ONE, 1.0),
    "conveyor": ContactProblem("confined", 0.066, 0.0037, CreepSpectrum(0.1, [0.4, 0.5], [1e-3, 0.1]), 0.03),
    "free": ContactProblem("free", 0.4, 0.05, ONE, 1.0),
    "half-space": ContactProblem("half-space", 0.1, 1e-3, ONE),
    "wrapped": ContactProblem("free", 0.1, 0.13, ONE, 1.0),
    "split": SPLIT,
}


@pytest.mark.parametrize("name", ["confined", "free", "half-space"])
def test_one_strip_is_the_contact_of_the_half_width(name):
    problem = SCENES[name]
    exact = solve(problem, rtol=1e-11)
    scene = Scene.of(problem)
    start = (
        np.array([1.02 * exact.eccentricity * problem.rho]),
        np.array([0.98 * exact.half_width * problem.rho]),
    )
    found = settle(scene, max(exact.stats.order, 32), *start, 1e-12)
    assert found.friction == pytest.approx(exact.friction, rel=1e-10)
    assert found.depth == pytest.approx(exact.penetration, rel=1e-9)
    assert friction_by_loss(scene, found) == pytest.approx(found.friction, rel=1e-10)


def test_strips_carry_the_load_at_one_height():
    found = solve(SPLIT, rtol=1e-9)
    rho = SPLIT.rho
    carried, force = 0.0, 0.0
    for low, high in found.patches:
        # Chebyshev nodes of the second kind integrate sqrt(1-s²) times a polynomial
        angle = np.arange(1, 400) * math.pi / 400
        x = 0.5 * (low + high) + 0.5 * (high - low) * np.cos(angle)
        weight = 0.5 * (high - low) * math.pi / 400 * np.sin(angle)
        p = found.pressure(x)
        assert p.min() >= 0.0
        carried += float(weight @ p)
        force += float(weight @ (p * x / np.sqrt(1.0 - x**2)))
        # inside a strip the surface is the roll
        np.testing.assert_allclose(
            found._need().fields.outside(x[40:-40] * rho),
            found.penetration - 1.0 + np.sqrt(1.0 - x[40:-40] ** 2),
            rtol=0,
            atol=2e-6 * found.penetration,
        )
    # p̃_m over a period 1/R̃ of x/R
    assert carried * SPLIT.radius == pytest.approx(SPLIT.pressure, rel=1e-9)
    assert force / carried == pytest.approx(found.friction, rel=1e-8)


def test_no_pressure_and_no_overlap_between_the_strips():
    found = solve(SPLIT, rtol=1e-9)
    gap = np.linspace(found.patches[0, 1], found.patches[1, 0], 41)[1:-1]
    assert np.all(found.pressure(gap) == 0.0)
    assert np.all(found.profile(gap) > found.penetration - 1.0 + np.sqrt(1.0 - gap**2))


def test_elastic_split_contact_is_symmetric():
    # a thin plate on a roll: two strips and their mirror images
    found = solve(ContactProblem("free", 0.2, 0.13, CreepSpectrum(1.0), 0.8), rtol=1e-8)
    assert len(found.patches) == 2
    np.testing.assert_allclose(found.patches, -found.patches[::-1, ::-1], rtol=0, atol=1e-8)
    assert abs(found.friction) < 1e-10


def test_fields_repeat_with_the_rolls():
    found = solve(SPLIT)
    x = np.array([-0.4, 0.0, 0.5])
    np.testing.assert_allclose(found.pressure(x + 1.0 / SPLIT.radius), found.pressure(x), rtol=1e-12)


def test_gap_counts_the_next_roll():
    centre, alpha = np.array([-2.0, 2.0]), np.array([0.5, 0.6])
    assert smallest_gap(centre, alpha) == pytest.approx(2.0 * math.pi - 2.6 - 2.5)
    assert smallest_gap(centre[:1], alpha[:1]) == 2.0 * math.pi
    assert too_close(np.array([0.0, 1.0]), np.array([0.497, 0.497]))
    assert not too_close(np.array([0.0, 1.0]), np.array([0.495, 0.495]))


def test_strips_that_cannot_be_polished_keep_the_grid_with_its_error(monkeypatch):
    exact = solve(SPLIT, rtol=1e-9)
    monkeypatch.setattr(module, "_polished", lambda *_: None)
    monkeypatch.setattr(module, "_FINEST", 6)
    found = solve(SPLIT, rtol=1e-9, throw=False)
    assert found.status is Status.NOT_CONVERGED
    assert found.stats.way == "grid"
    assert "known on a grid of" in found.message
    assert abs(found.friction / exact.friction - 1.0) <= found.error_estimate < 1e-3
    assert found.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-3)
    x = np.array([-0.4, 0.1, 0.6, 0.9])
    np.testing.assert_allclose(found.pressure(x), exact.pressure(x), rtol=0, atol=1e-2 * exact.peak_pressure)
    np.testing.assert_allclose(found.profile(x), exact.profile(x), rtol=0, atol=1e-4)


# contacts of given depth


@pytest.mark.parametrize("rtol", [1e-4, 1e-8])
@pytest.mark.parametrize("name", SCENES)
def test_depth_gives_back_the_load(name, rtol):
    problem = SCENES[name]
    loaded = solve(problem, rtol=rtol)
    held = solve_penetration(replace(problem, pressure=7.0), loaded.penetration, rtol=rtol)
    # depth and load are known as well as friction, within a factor of the order of their exponents
    assert held.problem.pressure == pytest.approx(problem.pressure, rel=10.0 * rtol)
    assert held.friction == pytest.approx(loaded.friction, rel=10.0 * rtol)
    assert held.penetration == pytest.approx(loaded.penetration, rel=10.0 * rtol)
    assert len(held.patches) == len(loaded.patches)


def test_deeper_is_heavier():
    loads = [solve_penetration(SPLIT, depth, 1e-5).problem.pressure for depth in (1e-3, 1e-2, 0.1, 0.3, 0.6)]
    assert all(np.diff(loads) > 0.0)


@pytest.mark.parametrize("depth", [0.0, -0.1, math.nan, math.inf])
def test_depths_are_refused(depth):
    with pytest.raises(InputError, match="Δ/R is finite and positive"):
        solve_penetration(SPLIT, depth)


def test_tolerance_of_a_depth_is_refused():
    with pytest.raises(InputError, match=r"rtol = 0\.5"):
        solve_penetration(SPLIT, 0.1, rtol=0.5)


# mean line


def test_mean_line_of_an_incompressible_layer_stays():
    assert solve(SCENES["confined"]).mean_shift == 0.0


def test_mean_shift_of_a_thin_compressible_layer_is_winklers():
    # a thin bonded layer is a bed of springs of oedometric stiffness: where it is not touched its surface stays where
    # it was, which is u_m above the mean line of the deformed surface
    problem = ContactProblem("confined", 0.3, 3e-4, CreepSpectrum(1.0), 1e-3, 0.3)
    found = solve(problem, rtol=1e-6)
    free = found.profile([0.5 / problem.radius])[0]
    thinness = problem.thickness / (found.half_width * problem.rho)
    assert thinness < 0.1
    assert -free == pytest.approx(found.mean_shift, rel=1e-2 * thinness)
    # the springs under the crown give way by a²/2R, to the order of h/a
    assert found.penetration + found.mean_shift == pytest.approx(0.5 * found.half_width**2, rel=thinness)


def test_mean_shift_by_equation_8():
    # u_m = (1+ν)(1-2ν) p_m h/((1-ν) E0) of a real layer, and what its scales make of it
    nu, modulus, load, height, wave, radius = 0.3, 8e6, 2e4, 7e-3, 5.0, 0.08
    given = (1 + nu) * (1 - 2 * nu) * load * height / ((1 - nu) * modulus)
    pressure = 2 * (1 - nu**2) * load / (modulus * wave * radius)
    problem = ContactProblem("confined", wave * radius / (2 * math.pi), pressure, ONE, wave * height, nu)
    assert solve(problem).mean_shift * radius == pytest.approx(given, rel=1e-12)


@pytest.mark.parametrize(
    ("problem", "reason"),
    [
        (ContactProblem("half-space", 0.1, 1e-3, ONE, poisson=0.3), "sinks without bound"),
        (ContactProblem("free", 0.1, 1e-3, ONE, poisson=0.3), "sinks without bound"),
        (ContactProblem(HalfSpace(), 0.1, 1e-3, ONE, poisson=0.3), "Layer of your own"),
    ],
)
def test_mean_shift_is_refused_where_there_is_none(problem, reason):
    with pytest.raises(NoSolutionError, match=reason):
        _ = solve(problem).mean_shift
