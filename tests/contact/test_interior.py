"""The layer's interior against closed forms, its own differential equations, and the energy the surface spends."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.polynomial import Chebyshev
from scipy import special

from conveyor.contact import (
    ContactProblem,
    CreepSpectrum,
    HalfSpace,
    solve,
    solve_many,
    working_strains,
)
from conveyor.contact.fields.interior import interior, interior_fields, path_amplitude
from conveyor.contact.fields.working_strain import _wave_tables
from conveyor.contact.layers.layer_models import confined_symbol, free_symbol
from conveyor.contact.layers.layer_shapes import confined_shapes, free_shapes, incompressible_shapes
from conveyor.contact.solvers import many_strips
from conveyor.contact.solvers.refinement import Refined, RefinementEnd
from conveyor.errors import InputError, NoSolutionError

ONE = CreepSpectrum(0.1, [0.9], [1.0])
THREE = CreepSpectrum(0.05, [0.25, 0.3, 0.4], [0.02, 0.5, 20.0])
ELASTIC = CreepSpectrum(1.0)
CONVEYOR = ContactProblem(
    "confined", 0.066, 0.0037, CreepSpectrum(0.02, np.full(14, 0.07), np.logspace(-4.0, 4.0, 14)), 0.0314
)
SPLIT = ContactProblem("free", 0.4, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
SCENES = {
    "free": ContactProblem("free", 0.4, 0.05, ONE, 1.0),
    "free, ν 0.3": ContactProblem("free", 0.3, 0.05, THREE, 1.0, 0.3),
    "confined": ContactProblem("confined", 0.4, 0.05, ONE, 1.0),
    "confined, ν 0.3": ContactProblem("confined", 0.4, 0.05, THREE, 0.4, 0.3),
    "confined, ν 0": ContactProblem("confined", 0.4, 0.05, THREE, 0.4, 0.0),
    "half-space": ContactProblem("half-space", 0.4, 0.05, ONE),
    "half-space, ν 0.2": ContactProblem("half-space", 0.07, 1e-5, THREE, poisson=0.2),
    "thin": ContactProblem("confined", 0.066, 0.001, CreepSpectrum(0.1, [0.9], [0.02]), 0.02),
    "conveyor": CONVEYOR,
    "split": SPLIT,
}
by_scene = pytest.mark.parametrize("name", SCENES)
SHALLOW = 1e-3  # a/R of a roll that stands alone
DEGREE = 32  # e^{-2y}, y = 6 (1 + s): I_32(12) e^{-12} = 1e-15


@cache
def solved(name):
    return solve(SCENES[name], rtol=1e-8)


@cache
def hertz(poisson=0.5):
    """Elastic half-space under rolls 6e5 half widths apart: p̃_m = (a/R)²/4."""
    return solve(ContactProblem("half-space", SHALLOW, 0.25 * SHALLOW**2, ELASTIC, poisson=poisson), 1e-10)


def mcewen(x, z):
    """σ_x, σ_z, τ_xz under p0 sqrt(1-x²), in p0 and a: Johnson, Contact Mechanics (1985), Eq. (4.49)."""
    square = 1.0 - x * x + z * z
    root = np.sqrt(square**2 + 4.0 * x * x * z * z)
    m, n = np.sqrt(0.5 * (root + square)), np.copysign(np.sqrt(0.5 * np.maximum(root - square, 0.0)), x)
    share = (z * z + n * n) / (m * m + n * n)
    return -(m * (1.0 + share) - 2.0 * z), -m * (1.0 - share), -n * (m * m - z * z) / (m * m + n * n)


# the layer, harmonic by harmonic


@pytest.mark.parametrize("poisson", [0.5, 0.4999, 0.3, 0.0])
@pytest.mark.parametrize("q", [0.05, 0.5, 3.0, 12.0])
@pytest.mark.parametrize("shapes", [confined_shapes, free_shapes])
def test_shapes_obey_equilibrium_and_compatibility(shapes, q, poisson):
    """T' = -(H+D), (H-D)' = T, U' = (1-2ν)H - D, U - (D + (1-2ν)H)' = 2T: with the faces they fix D, T, H, U."""
    domain, bulk = (0.0, q), 1.0 - 2.0 * poisson

    def component(index):
        return Chebyshev.interpolate(lambda y: shapes(np.array([q]), y, q - y, poisson)[index], DEGREE, domain=domain)

    D, T, H, U = (component(index) for index in range(4))
    y = np.linspace(0.0, q, 33)
    largest = max(np.abs(f(y)).max() for f in (D, T, H))
    # rounding of a derivative: each coefficient holds some ε, T_n' is n² at the ends, and there are n of them
    tolerance = 1e-15 * DEGREE**3 * max(2.0 / q, 1.0) * largest
    if shapes is free_shapes:
        tolerance /= min(1.0, q * q)  # cancels like q² against the plate's bending
    assert T.deriv()(y) == pytest.approx(-(H + D)(y), abs=tolerance)
    assert (H - D).deriv()(y) == pytest.approx(T(y), abs=tolerance)
    assert U.deriv()(y) == pytest.approx((bulk * H - D)(y), abs=tolerance * max(1.0, np.abs(U(y)).max()))
    assert (U - (D + bulk * H).deriv())(y) == pytest.approx(2.0 * T(y), abs=tolerance * max(1.0, np.abs(U(y)).max()))


@pytest.mark.parametrize("poisson", [0.5, 0.3, 0.0])
@pytest.mark.parametrize("q", [1e-6, 1e-2, 0.5, 3.0, 12.0, 60.0, 1e4])
def test_faces(q, poisson):
    top, bottom = (
        (np.array([q]), np.array([0.0]), np.array([q])),
        (np.array([q]), np.array([q]), np.array([0.0])),
    )
    symbols = {
        confined_shapes: confined_symbol(np.array([q]), poisson),
        free_shapes: free_symbol(np.array([q])),
    }
    for shapes, symbol in symbols.items():
        D, T, H, U = shapes(*top, poisson)
        bending = max(1.0, 6.0 / q**2) if shapes is free_shapes else 1.0
        assert (H - D)[0] == pytest.approx(-1.0, abs=1e-14 * bending)
        assert T[0] == pytest.approx(0.0, abs=1e-14 * bending)
        if q > 1e-3 or shapes is free_shapes:  # below, its cancelling displacement is smaller than its own rounding
            assert U[0] == pytest.approx(2.0 * (1.0 - poisson) * symbol[0], rel=1e-9)
    D, T, H, U = confined_shapes(*bottom, poisson)
    assert (D + (1.0 - 2.0 * poisson) * H)[0] == pytest.approx(0.0, abs=1e-15)  # u_x
    assert U[0] == pytest.approx(0.0, abs=1e-15)
    D, T, H, U = free_shapes(*bottom, poisson)
    assert (H - D)[0] == pytest.approx(0.0, abs=1e-14 * max(1.0, 6.0 / q**2))
    assert T[0] == pytest.approx(0.0, abs=1e-14 * max(1.0, 6.0 / q**2))


# closed forms


@pytest.mark.parametrize("poisson", [0.5, 0.25])
def test_hertz_interior(poisson):
    found = hertz(poisson)
    x, z = np.array([-2.5, -1.0, -0.6, 0.0, 0.3, 0.9, 1.2, 4.0, 30.0]), np.array([0.1, 0.3, 0.786, 1.5, 6.0])
    fields = interior_fields(found, SHALLOW * x, SHALLOW * z, points=96)
    exact = mcewen(x[None, :], z[:, None])
    for stress, closed in zip((fields.stress_xx, fields.stress_zz, fields.stress_xz), exact, strict=True):
        # a far place's window leaves 2e-4 of its stress, the images and the mean 1e-5
        assert stress / found.peak_pressure == pytest.approx(closed, rel=2e-3, abs=3e-5)


def test_hertz_largest_shear():
    """0.30 p0 at 0.78 a: Johnson (1985), section 4.2(a)."""
    found = hertz()
    z = np.linspace(0.7, 0.86, 161)
    fields = interior_fields(found, [0.0], SHALLOW * z)
    shear = 0.5 * (fields.stress_xx - fields.stress_zz)[:, 0] / found.peak_pressure
    assert shear.max() == pytest.approx(0.300, abs=5e-4)
    assert z[shear.argmax()] == pytest.approx(0.786, abs=5e-3)


def test_hertz_amplitude():
    """Path of a particle in McEwen's field, strains (1+ν)σ/E, p0 = E a/(2 (1-ν²) R)."""
    inside = interior(hertz(), depths=12, points=96)
    chosen = (inside.depth > 0.02 * SHALLOW) & (inside.depth < 5.0 * SHALLOW)
    z = inside.depth[chosen] / SHALLOW
    x = np.concatenate([-np.geomspace(1e3, 3.0, 60), np.linspace(-3.0, 3.0, 801), np.geomspace(3.0, 1e3, 60)])
    sx, sz, t = mcewen(x[None, :], z[:, None])
    unit = 0.5 * SHALLOW / (1.0 - 0.5)  # (1+ν) p0/E = a/(2 (1-ν) R)
    exact = path_amplitude(difference=unit * (sx - sz), shear=2.0 * unit * t, dilatation=0.0 * t)
    # between places 1/24 a apart a peak of curvature (1/z)² is missed by less than (a/48 z)²/2
    assert inside.amplitude[chosen] == pytest.approx(exact, rel=3e-3)


@pytest.mark.parametrize("ratio", [0.05, 0.025])
def test_thin_incompressible_layer(ratio):
    """p = G a⁴/(8 R h³) (1-s²)² (lubrication; Johnson 1985, section 5.8): γ = h p'/G at the base, a³/(9 R h²)."""
    half_width, radius = 2e-3, 0.05  # a/R, R/λ
    rho = 2.0 * math.pi * radius
    h = ratio * half_width
    line = 16.0 / 15.0 * half_width * (half_width**4 / (8.0 * h**3)) / 3.0  # W/(E R), G = E/3
    found = solve(ContactProblem("confined", radius, 0.75 * line / math.pi, ELASTIC, rho * h))
    # the edges' boundary layers widen the contact by O(h/a)
    assert found.half_width == pytest.approx(half_width, rel=2.0 * ratio)
    inside = interior(found, depths=12, points=96)
    assert inside.amplitude.argmax() == inside.depth.size - 1
    assert inside.maximum == pytest.approx(half_width**3 / (9.0 * h * h), rel=2.0 * ratio)
    # parabolic flow: no shear at the loaded face, but it stretches by p'' h²/(2G)
    assert inside.relative_depth[-1] == pytest.approx(1.0)


def test_path_amplitude_is_that_of_a_uniaxial_test():
    turn = np.linspace(0.0, 2.0 * math.pi, 361)[None, :]
    nothing = np.zeros_like(turn)
    # incompressible tension along z, seen as plane: a strain of equal size needs difference² = 3 ε²
    line = path_amplitude(difference=math.sqrt(3.0) * 0.02 * np.cos(turn), shear=nothing, dilatation=nothing)
    assert line == pytest.approx([0.02], rel=1e-9)
    # plane uniaxial strain ε_zz = v: e = v diag(-1/3, 2/3, -1/3), sqrt(2/3 e:e) = 2/3 |v|
    v = 0.03 * np.cos(turn)
    assert path_amplitude(difference=-v, shear=nothing, dilatation=v) == pytest.approx([0.02], rel=1e-9)
    pulse = path_amplitude(difference=nothing, shear=0.5 * (1.0 - np.cos(turn)), dilatation=nothing)
    assert pulse == pytest.approx([0.5 / math.sqrt(3.0)], rel=1e-9)
    shifted = path_amplitude(difference=5.0 + np.cos(turn), shear=3.0 + np.sin(turn), dilatation=nothing)
    assert shifted == pytest.approx([1.0 / math.sqrt(3.0)], rel=1e-9)


# conservation and boundary conditions


@by_scene
def test_dissipation_inside_is_the_work_of_friction(name):
    found = solved(name)
    inside = interior(found)
    # the harmonics end at m α = 192: where Im j is level, as 192^-2 times a figure of a few
    assert inside.energy_error < 3e-4
    assert inside.friction == pytest.approx(found.friction, rel=3e-4)
    assert (inside.dissipation >= 0.0).all()
    assert interior(found, depths=32, points=192).energy_error < max(0.2 * inside.energy_error, 1e-7)


@by_scene
def test_surface_is_the_profile(name):
    found = solved(name)
    low, high = found.patches[0]
    x = np.concatenate([low + (high - low) * np.array([0.2, 0.5, 0.8]), [high + 0.5 * (high - low)]])
    fields = interior_fields(found, x, [0.0], points=192)
    depth = found.penetration
    # the series ends at m α = 768: (m α)^(-3/2) of the depth at worst
    assert fields.displacement_z[0] == pytest.approx(found.profile(x), abs=5e-5 * depth)
    inner = slice(0, 3)
    mean = sum(found.pressure(np.linspace(-math.pi, math.pi, 200_001) / found.problem.rho)[:-1]) / 200_000
    assert fields.stress_zz[0, inner] - mean == pytest.approx(-found.pressure(x[inner]), abs=1e-4 * found.peak_pressure)
    assert fields.stress_xz[0] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "name", ["free", "free, ν 0.3", "confined", "confined, ν 0.3", "half-space, ν 0.2", "conveyor"]
)
def test_strains_are_the_slopes_of_the_displacements(name):
    """ε_xx = ∂u_x/∂x, ε_zz = ∂u_z/∂z, γ = ∂u_x/∂z + ∂u_z/∂x, by central differences of fourth order.

    Waves of m α = 10 are the shortest of weight at these depths: (0.01 × 10)^4/30 of them is lost, 3e-6, and of those
    of twice that 5e-5.
    """
    found = solved(name)
    low, high = found.patches[0]
    x, half = np.linspace(low - 0.5 * (high - low), high, 5), 0.5 * (high - low)
    depth = half if found.problem.thickness is None else min(half, 0.5 * found.problem.thickness / found.problem.rho)
    step = 0.01 * depth
    weights, apart = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * step), step * np.array([-2.0, -1.0, 1.0, 2.0])
    beside = [interior_fields(found, x + d, [depth]) for d in apart]
    above = interior_fields(found, x, depth + apart)
    here = interior_fields(found, x, [depth])
    along = {one: sum(w * getattr(f, one)[0] for w, f in zip(weights, beside, strict=True))
             for one in ("displacement_x", "displacement_z")}  # fmt: skip
    down = {one: weights @ getattr(above, one) for one in along}
    close = 1e-4 * np.abs(here.strain_xx).max()
    assert here.strain_xx[0] == pytest.approx(along["displacement_x"], abs=close)
    assert here.strain_zz[0] == pytest.approx(down["displacement_z"], abs=close)
    assert here.strain_xz[0] == pytest.approx(down["displacement_x"] + along["displacement_z"], abs=close)


@pytest.mark.parametrize("name", ["confined", "confined, ν 0.3", "confined, ν 0", "conveyor"])
def test_bonded_face_does_not_move(name):
    found = solved(name)
    h = found.problem.thickness / found.problem.rho
    fields = interior_fields(found, np.linspace(-0.1, 0.1, 9), [0.0, h])
    for moved in (fields.displacement_x, fields.displacement_z):
        assert moved[1] == pytest.approx(0.0, abs=1e-12 * found.penetration)
    # ε_zz alone closes the gap: u_z(0) = -∫ ε_zz dz
    z, weights = np.polynomial.legendre.leggauss(60)
    t = 0.5 * (z + 1.0)
    deep = interior_fields(found, [found.eccentricity], h * t * t)
    total = -float((h * t * weights) @ deep.strain_zz[:, 0])
    assert fields.displacement_z.shape == (2, 9)
    centre = interior_fields(found, [found.eccentricity], [0.0]).displacement_z[0, 0]
    assert total == pytest.approx(centre, rel=1e-6)


@pytest.mark.parametrize("name", ["free", "free, ν 0.3", "split"])
def test_far_face_of_a_free_layer_carries_nothing(name):
    found = solved(name)
    fields = interior_fields(found, np.linspace(-1.0, 1.0, 9), [found.problem.thickness / found.problem.rho])
    largest = np.abs(fields.stress_xx).max()
    assert fields.stress_zz == pytest.approx(0.0, abs=1e-12 * largest)
    assert fields.stress_xz == pytest.approx(0.0, abs=1e-12 * largest)


# invariances and limits


def test_spacing_does_not_matter_to_aconfined_shapes_layer():
    """Spacing 1, 2, 4: R/λ, k h and ζ shrink, p̃_m = (1-ν²) w/(π E0 R) stays."""
    problems = [
        ContactProblem("confined", 0.066 / n, 0.0037, CreepSpectrum(0.2, [0.4, 0.4], [0.02 / n, 0.2 / n]), 0.0314 / n)
        for n in (1, 2, 4)
    ]
    first, *others = [interior(s, depths=12) for s in solve_many(problems, rtol=1e-9)]
    for n, other in zip((2, 4), others, strict=True):
        assert other.depth == pytest.approx(first.depth, rel=1e-6)
        # what is left of a roll's strain at the next: exp(-λ/(V τ)) = exp(-2π/0.2) and the far windows
        assert other.amplitude[1:] == pytest.approx(first.amplitude[1:], rel=1e-3)
        assert other.working_strain == pytest.approx(first.working_strain, rel=1e-4)
        assert other.dissipation == pytest.approx(first.dissipation, rel=1e-5)
        assert other.wave_number / n == pytest.approx(first.wave_number, rel=1e-3)


@pytest.mark.parametrize("support", ["free", "confined", "half-space"])
def test_slow_and_fast_belts_strain_like_elastic_ones(support):
    base = ContactProblem(support, 0.2, 1e-3, ELASTIC, 0.5)
    slow = replace(base, creep=CreepSpectrum(0.1, [0.9], [1e-10]))
    fast = replace(base, pressure=1e-2, creep=CreepSpectrum(0.1, [0.9], [1e10]))
    still, creeping, glassy = [interior(s) for s in solve_many([base, slow, fast], rtol=1e-8)]
    assert creeping.amplitude == pytest.approx(still.amplitude, rel=1e-6, abs=1e-9)
    assert glassy.amplitude == pytest.approx(still.amplitude, rel=1e-6, abs=1e-9)


def test_strains_scale_with_the_contact():
    """A half-space's strains are those of a/R: a hundredfold load strains ten times as much."""
    problems = [ContactProblem("half-space", 1e-3, p, ELASTIC) for p in (1e-9, 1e-7)]
    light, heavy = [interior(s, depths=64).maximum for s in solve_many(problems, rtol=1e-9)]
    # the depths between which the maximum falls differ
    assert heavy / light == pytest.approx(10.0, rel=2e-3)


def test_thick_layers_are_half_spaces():
    thick = [
        ContactProblem(support, 0.1, 1e-6, ONE, thickness)
        for support, thickness in (("half-space", math.inf), ("confined", 12.0), ("free", 12.0))
    ]
    deep, *others = [interior(s) for s in solve_many(thick, rtol=1e-9)]
    for other in others:
        assert other.amplitude[:-1] == pytest.approx(deep.amplitude, rel=1e-6, abs=1e-10)
        assert other.working_strain == pytest.approx(deep.working_strain, rel=1e-6)


def test_layer_objects_are_supports_too():
    problem = SCENES["half-space"]
    named, given = (
        interior(solved("half-space")),
        interior(solve(replace(problem, support=HalfSpace()), 1e-8)),
    )
    assert given.working_strain == pytest.approx(named.working_strain, rel=1e-12)


# where it dissipates


def test_mean_wave_number_of_a_slow_belt():
    """Im j ∝ m and Hertz: mean ln(mα) = ∫ ln x J1²/x dx/∫ J1²/x dx = ½ + ln 2 - γ (DLMF 10.22.57)."""
    slow = replace(hertz().problem, creep=CreepSpectrum(0.9, [0.1], [1e-14]))
    found = solve(slow, 1e-8)
    inside = interior(found, points=192)
    alpha = found.half_width * slow.rho
    reach = 4.0 * 192.0
    # J1² ~ 1/(πx): what lies beyond the reach is 2/(π reach) of the weight, times ln(reach) + 1
    missed = 2.0 / (math.pi * 0.62 * reach) * (math.log(reach) + 1.0)
    assert math.log(inside.wave_number * alpha) == pytest.approx(0.5 + math.log(2.0) - np.euler_gamma, abs=1.5 * missed)


@by_scene
def test_error_estimate_bounds_the_error(name):
    found = solved(name)
    inside, fine = interior(found), interior(found, depths=48, points=144)
    error = abs(inside.working_strain / fine.working_strain - 1.0)
    assert error < 3e-3
    assert error <= max(3.0 * inside.error_estimate, 2e-4)


def test_strains_of_a_split_contact_change_steadily_with_the_load():
    found = solved("split")
    near = solve(replace(SPLIT, pressure=0.1299), rtol=1e-6)
    assert len(found.patches) == len(near.patches) == 2
    assert interior(near).working_strain == pytest.approx(interior(found).working_strain, rel=5e-3)


def test_contacts_known_on_a_grid_have_an_interior(monkeypatch):
    monkeypatch.setattr(many_strips, "_polish_strips", lambda *_: Refined(RefinementEnd.LOST, None))
    monkeypatch.setattr(many_strips, "_FINEST", 6)
    grid = solve(SPLIT, throw=False)
    assert grid.stats.way == "grid"
    inside, exact = interior(grid), interior(solved("split"))
    # its pressure is straight between nodes: 1e-2 of the peak at the edges
    assert inside.working_strain == pytest.approx(exact.working_strain, rel=1e-2)
    assert inside.energy_error < 1e-2


# refusals


def test_elastic_layers_have_no_dissipation_to_weight_with():
    inside = interior(hertz())
    assert inside.friction == inside.energy_error == inside.wave_number == 0.0
    assert 1e-3 < inside.error_estimate < 0.1  # 16 depths over the six decades from a to λ
    with pytest.raises(NoSolutionError, match="an elastic layer dissipates nothing to weight with; use maximum"):
        _ = inside.working_strain


def test_refusals():
    found = solved("confined")
    with pytest.raises(InputError, match=r"depths: got 3, allowed: a whole number >= 4"):
        interior(found, depths=3)
    with pytest.raises(InputError, match=r"points: got 48\.0, allowed: a whole number >= 12"):
        interior(found, points=48.0)
    with pytest.raises(InputError, match=r"points: got True, allowed: a whole number >= 12"):
        interior_fields(found, [0.0], [0.0], points=True)
    with pytest.raises(InputError, match=r"depths z/R from 0 to 0\.39\d+, the far face"):
        interior_fields(found, [0.0], [0.5])
    with pytest.raises(InputError, match="finite lists"):
        interior_fields(found, [math.nan], [0.0])
    with pytest.raises(NoSolutionError, match="relative_depth: a half-space has no thickness; use depth"):
        _ = interior(hertz()).relative_depth


def test_own_layers_are_refused():
    class Own:
        reach = 0.0

        def symbol(self, m, creep):
            return creep.compliance(m)

    found = solve(replace(SCENES["half-space"], support=Own()), 1e-6)
    with pytest.raises(InputError, match="interior of a Layer of your own is not known here"):
        interior(found)


def test_a_refused_problem_has_no_interior():
    refused = solve(ContactProblem("free", 0.066, 0.001, ELASTIC, 0.03), throw=False)
    with pytest.raises(NoSolutionError, match="beyond its half circle"):
        interior(refused)


def test_many_working_strains_are_those_of_each_contact():
    """The sum over a period and the integral: apart by 4 (h/λ)³ = 1e-4 and what lies beyond 1.2 thicknesses, 3e-4."""
    rubber = CreepSpectrum(0.1, [0.4, 0.5], [0.01, 1.0])
    given = ((0.001, 0.03, 0.5), (0.01, 0.02, 0.5), (0.003, 0.15, 0.5), (0.001, 0.03, 0.4))
    thin = [ContactProblem("confined", 0.066, p, rubber, depth, poisson) for p, depth, poisson in given]
    scenes = [*thin, ContactProblem("free", 0.4, 0.05, CreepSpectrum(0.1, [0.9], [1.0]), 1.0)]
    solved = [solve(scene) for scene in scenes]
    found = working_strains(solved, depths=8, points=24)
    each = [interior(one, depths=8, points=24) for one in solved]
    for (strain, wave_number), one in zip(found[:3], each[:3], strict=True):
        assert strain == pytest.approx(one.working_strain, rel=3e-4)
        assert wave_number == pytest.approx(one.wave_number, rel=3e-4)
        assert strain != one.working_strain  # by another way
    assert found[3:] == [(one.working_strain, one.wave_number) for one in each[3:]]


@pytest.mark.parametrize("pressure", [1e-6, 1e-7, 1e-8, 1e-10])
def test_working_strain_of_a_layer_that_is_very_thick_against_its_contact(pressure):
    """Both ways to what 24 points leave, 1e-5 to 1e-4 (seen against 96): the layer is 68 to 3·10⁴ half widths thick."""
    rubber = CreepSpectrum(0.05, [0.4, 0.3, 0.25], [1e-4, 0.02, 3.0])
    solved = solve(ContactProblem("confined", 0.3, 3.0 * pressure, rubber, 0.3))
    ((strain, wave_number),) = working_strains([solved], depths=8, points=24)
    one = interior(solved, depths=8, points=24)
    assert strain == pytest.approx(one.working_strain, rel=1e-4)
    assert wave_number == pytest.approx(one.wave_number, rel=1e-4)
    assert strain != one.working_strain  # by another way


@pytest.mark.parametrize("octaves", [1, 4, 9, 15])
def test_waves_of_every_octave_sum_to_a_pressure_that_is_zero_outside_its_strip(octaves):
    """∫ J_1(u)/u cos(ux) du = 0 for |x| > 1 (Weber, Schafheitlin), to the 1e-5 of the panels; and few waves do."""
    for waves in _wave_tables(48, octaves)[1:]:
        transform = waves.weights * waves.window * special.j1(waves.u) / waves.u
        assert np.abs(transform @ waves.cos).max() < 1e-5
        # 40 of phase over the gap of one half width at least, the span five of them: 200/12 panels and the graded ones
        assert waves.u.size <= 8 * (17 + 15)


def test_an_incompressible_layer_alone_is_the_confined_one():
    q, share = np.geomspace(1e-2, 60.0, 25), np.array([1e-3, 0.1, 0.5, 0.9, 0.999])[:, None]
    difference, shear, _, _ = confined_shapes(q, share * q, (1.0 - share) * q, 0.5)
    found = incompressible_shapes(q, share * q, (1.0 - share) * q)
    assert found[0] == pytest.approx(difference, rel=1e-9)
    assert found[1] == pytest.approx(shear, rel=1e-9)


def test_what_is_no_number_is_refused_and_no_place_has_no_fields():
    found = solve(SCENES["free"])
    assert interior_fields(found, [], [0.01]).stress_xx.shape == (1, 0)
    for refused in (
        lambda: interior("a"),
        lambda: interior_fields(found, "a", [0.01]),
        lambda: found.excitation(["a"]),
    ):
        with pytest.raises(InputError):
            refused()
