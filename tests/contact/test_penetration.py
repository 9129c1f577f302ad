"""Contacts of given depth, and where the mean line lies."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, HalfSpace, Status, solve, solve_penetration
from conveyor.errors import InputError, NoSolutionError

ROUNDING = 1e-11  # of systems of condition 100 and sums of 100 terms, in whatever order: 1e4 of 2e-16
ONE = CreepSpectrum(0.1, [0.9], [1.0])
ELASTIC = CreepSpectrum(1.0)
SCENES = {
    "confined": ContactProblem("confined", 0.4, 0.05, ONE, 1.0),
    "conveyor": ContactProblem("confined", 0.066, 0.0037, CreepSpectrum(0.1, [0.4, 0.5], [1e-3, 0.1]), 0.03),
    "compressible": ContactProblem("confined", 0.3, 0.01, ONE, 0.1, 0.3),
    "free": ContactProblem("free", 0.4, 0.05, ONE, 1.0),
    "half-space": ContactProblem("half-space", 0.1, 1e-3, ONE),
    "elastic": ContactProblem("half-space", 0.1, 1e-3, ELASTIC),
    "wrapped": ContactProblem("free", 0.1, 0.13, ONE, 1.0),
    "two strips": ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0),
    "elastic strips": ContactProblem("free", 0.2, 0.13, ELASTIC, 0.8),
    "three strips": ContactProblem("free", 0.3, 0.03, CreepSpectrum(0.1, [0.9], [0.3]), 0.3),
}
SPLIT = SCENES["two strips"]
by_scene = pytest.mark.parametrize("name", SCENES)


@cache
def loaded(problem, rtol):
    return solve(problem, rtol=rtol)


# load and depth


@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-8])
@by_scene
def test_depth_gives_back_the_load(name, rtol):
    problem = SCENES[name]
    given = loaded(problem, rtol)
    held = solve_penetration(replace(problem, pressure=7.0), given.penetration, rtol=rtol)
    # depth and load are known as well as friction, within a factor of the order of their exponents
    rel = 10.0 * rtol
    assert held.penetration == pytest.approx(given.penetration, rel=rel)
    assert held.problem.pressure == pytest.approx(problem.pressure, rel=rel)
    # elastic: zero to the places' tolerance, a thousandth of rtol
    assert held.friction == pytest.approx(given.friction, rel=rel, abs=1e-3 * rtol)
    assert len(held.patches) == len(given.patches)
    np.testing.assert_allclose(held.patches, given.patches, rtol=0, atol=max(rel, math.sqrt(rtol) * 0.1))


@by_scene
def test_the_problems_own_load_plays_no_part(name):
    problem = SCENES[name]
    depth = loaded(problem, 1e-6).penetration
    light, heavy = (solve_penetration(replace(problem, pressure=pressure), depth) for pressure in (1e-9, 1e9))
    assert light.problem.pressure == pytest.approx(heavy.problem.pressure, rel=ROUNDING)
    assert light.friction == pytest.approx(heavy.friction, rel=ROUNDING)


@by_scene
def test_deeper_is_heavier_and_wider(name):
    depth = loaded(SCENES[name], 1e-6).penetration
    found = [solve_penetration(SCENES[name], f * depth, 1e-4) for f in (1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0)]
    assert all(np.diff([s.problem.pressure for s in found]) > 0.0)
    assert all(np.diff([s.outer_edge for s in found]) > 0.0)


@pytest.mark.parametrize("name", ["elastic", "elastic strips"])
def test_load_is_the_slope_of_the_stored_energy(name):
    # elastic contact stores ½<p w>, which the roll's advance pays for: d(½<p w>)/dΔ = p̃_m. The angles of a strip
    # integrate p times a smooth function exactly, Gauss' eight depths the smooth load to rounding
    problem = SCENES[name]
    depth = loaded(problem, 1e-9).penetration
    low, high = 0.95 * depth, 1.05 * depth

    def held(at):
        found = solve_penetration(problem, at, rtol=1e-10)
        assert len(found.patches) == len(loaded(problem, 1e-9).patches)
        return found

    def stored(at):
        found, total = held(at), 0.0
        for left, right in found.patches:
            angle = np.arange(1, 400) * math.pi / 400
            x = 0.5 * (left + right) + 0.5 * (right - left) * np.cos(angle)
            w = found.penetration - 1.0 + np.sqrt(1.0 - x**2)
            total += float(np.sin(angle) @ (found.pressure(x) * w)) * 0.5 * (right - left) * math.pi / 400
        return 0.5 * total * problem.radius

    node, weight = np.polynomial.legendre.leggauss(8)
    depths = 0.5 * (low + high) + 0.5 * (high - low) * node
    work = 0.5 * (high - low) * float(weight @ [held(at).problem.pressure for at in depths])
    # the difference of two energies a tenth apart, each to 1e-9 of itself
    assert stored(high) - stored(low) == pytest.approx(work, rel=2e-8)


def test_light_half_space_contacts_are_hertzian():
    # narrow parabolas far apart: p̃ is Hertz', p̃_m = (α/2ρ)², and the series 2 Σ p̃̂_m/m, p̃̂_m = p̃_m 2 J_1(mα)/(mα),
    # tends to Δ/R = ½ (α/ρ)² (½ + ln(2/α)) for α → 0
    rho = 2.0 * math.pi * 0.1
    scene = ContactProblem("half-space", 0.1, 1.0, ELASTIC)
    for alpha in (1e-2, 1e-3):
        depth = 0.5 * (alpha / rho) ** 2 * (0.5 + math.log(2.0 / alpha))
        found = solve_penetration(scene, depth, 1e-9)
        # the neighbours and the circle act by α²
        assert found.half_width * rho == pytest.approx(alpha, rel=alpha**2 * 3.0)
        assert found.problem.pressure == pytest.approx(0.25 * (alpha / rho) ** 2, rel=6.0 * alpha**2)


@pytest.mark.parametrize("depth", [0.0, -0.0, -0.1, math.nan, math.inf, -math.inf])
def test_depths_are_refused(depth):
    with pytest.raises(InputError, match=r"penetration: got .*, allowed: >= 1e-28"):
        solve_penetration(SPLIT, depth)


@pytest.mark.parametrize("rtol", [0.0, 1e-13, 0.5, -1.0, math.nan])
def test_tolerance_of_a_depth_is_refused(rtol):
    with pytest.raises(InputError, match=r"rtol: got .*, allowed: >= 1e-12"):
        solve_penetration(SPLIT, 0.1, rtol=rtol)


def test_a_depth_that_wraps_the_roll_is_refused_with_the_load_that_does():
    with pytest.raises(NoSolutionError, match=r"beyond its half circle.*at a mean pressure of about"):
        solve_penetration(SCENES["half-space"], 50.0)
    held = solve_penetration(SCENES["half-space"], 50.0, throw=False)
    assert held.status is Status.WRAP_LIMIT
    by_load = solve(replace(SCENES["half-space"], pressure=1e3), throw=False)
    limits = [float(found.message.rsplit(" ", 1)[1]) for found in (held, by_load)]
    # three digits are printed
    assert limits[0] == pytest.approx(limits[1], rel=1e-2)


# mean line


@pytest.mark.parametrize("name", ["confined", "free", "half-space", "two strips"])
def test_mean_line_of_an_incompressible_layer_stays(name):
    assert loaded(SCENES[name], 1e-6).mean_shift == 0.0


@pytest.mark.parametrize("poisson", [0.0, 0.2, 0.3, 0.4])
def test_thin_compressible_layer_is_winklers(poisson):
    # a thin bonded layer is a bed of springs of oedometric stiffness M = (1-ν) E0/((1+ν)(1-2ν)). Its free surface
    # stays where it was, u_m above the mean line; under the crown the springs give way by Δ + u_m = a²/2R, where the
    # pressure is M (Δ + u_m)/h or p̃ = 2 (1-ν)²/(1-2ν) (Δ + u_m)/(R k h). Inside the contact the springs' shear is of
    # second order in h/a, at its edges of the first
    for thickness in (1e-2, 1e-3):
        pressure = 3e-3 * math.sqrt(thickness)
        found = solve(ContactProblem("confined", 0.3, pressure, ELASTIC, thickness, poisson))
        thin = thickness / (found.half_width * found.problem.rho)
        assert thin < 0.33
        approach = found.penetration + found.mean_shift
        stiffness = 2.0 * (1.0 - poisson) ** 2 / (1.0 - 2.0 * poisson) / thickness
        assert found.peak_pressure == pytest.approx(stiffness * approach, rel=2.0 * thin**2)
        assert approach == pytest.approx(0.5 * found.half_width**2, rel=thin)
        # the surface's series is cut off at about 1e-7 of the depth
        far = float(found.profile(0.5 / found.problem.radius))
        assert -far == pytest.approx(found.mean_shift, abs=1e-6 * found.penetration)
        assert found.mean_shift > 1e-3 * found.penetration


def test_mean_shift_by_equation_8():
    # u_m = (1+ν)(1-2ν) p_m h/((1-ν) E0) of a real layer, and what its scales make of it
    nu, modulus, load, height, wave, radius = 0.3, 8e6, 2e4, 7e-3, 5.0, 0.08
    given = (1 + nu) * (1 - 2 * nu) * load * height / ((1 - nu) * modulus)
    pressure = 2 * (1 - nu**2) * load / (modulus * wave * radius)
    problem = ContactProblem("confined", wave * radius / (2 * math.pi), pressure, ONE, wave * height, nu)
    assert solve(problem).mean_shift * radius == pytest.approx(given, rel=1e-12)


def test_mean_shift_follows_the_load_that_was_found():
    given = loaded(SCENES["compressible"], 1e-8)
    held = solve_penetration(replace(SCENES["compressible"], pressure=9.0), given.penetration, 1e-8)
    assert held.mean_shift == pytest.approx(given.mean_shift, rel=1e-7)
    assert given.mean_shift > 0.0


@pytest.mark.parametrize(
    ("problem", "reason"),
    [
        (ContactProblem("half-space", 0.1, 1e-3, ONE, poisson=0.3), "sinks without bound"),
        (ContactProblem("free", 0.1, 1e-3, ONE, poisson=0.3), "sinks without bound"),
        (ContactProblem("confined", 0.1, 1e-3, ONE, poisson=0.499), "sinks without bound"),
        (ContactProblem(HalfSpace(), 0.1, 1e-3, ONE, poisson=0.3), "Layer of your own"),
    ],
)
def test_mean_shift_is_refused_where_there_is_none(problem, reason):
    with pytest.raises(NoSolutionError, match=reason):
        _ = solve(problem).mean_shift
