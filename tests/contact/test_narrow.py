"""Narrow contacts side by side: the short rules against the full ones, the batch against the general ways."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import integrate, special

from conveyor.contact import (
    Confined,
    ContactProblem,
    CreepSpectrum,
    Free,
    HalfSpace,
    Status,
    solve,
    solve_many,
)
from conveyor.contact.galerkin.quadrature import build_rule
from conveyor.contact.galerkin.short_rule import (
    COARSE_GRADES,
    FINE_GRADES,
    LOOSE_GRADES,
    WINDOW_CAPS,
    _legendre_moments,
    _window_width,
    short_rules,
)
from conveyor.contact.galerkin.spectral import Contact, assemble_matrix
from conveyor.contact.layers.creep import CreepBatch
from conveyor.contact.layers.layer_models import PlainLayerBatch
from conveyor.contact.solution import SolveOutcome
from conveyor.contact.solvers import entry, load_control, one_strip_batch
from conveyor.contact.solvers.acceptance import WRAP_EXTENT, pressure_signs
from conveyor.contact.solvers.one_strip import HalfWidthStart, solve_one_strip
from conveyor.contact.solvers.one_strip_batch import UnsolvedReason, solve_batch
from conveyor.contact.solvers.solver_state import SolverState

SUPPORTS = ("free", "confined", "half-space")


@pytest.mark.parametrize("pressure", [1e-6, 1e-3, 0.05, 0.14])
def test_an_elastic_half_space_is_guessed_as_hertz_has_it(pressure):
    # p̃_m = α²/(4ρ²) is a straight line of logarithms: nothing is lost between the points of the tables
    problem = ContactProblem("half-space", 0.3, pressure, CreepSpectrum(1.0))
    hertz = 2.0 * problem.rho * np.sqrt(pressure)
    alone, _ = load_control.guess_half_width(SolverState.of(problem))
    (batch,) = one_strip_batch.guess_half_widths(one_strip_batch.ProblemBatch.of([problem], [problem.creep]))
    assert [np.exp(alone), batch] == pytest.approx([hertz, hertz], rel=1e-12)


def test_a_half_width_with_no_place_on_the_roll_is_half_way_back_to_the_last_too_light():
    search = load_control.LoadSearch(target=0.0, log_alpha=-1.0, slope=2.0, low=-3.0)
    search.reject()
    assert (search.high, search.log_alpha) == (-1.0, -2.0)


def test_a_load_that_is_a_power_of_the_width_is_met_by_the_second_secant():
    """p = 3 α^2.7 and μ = p^0.4: two half widths have both exponents, and the straight line of logarithms ends on p."""
    search = load_control.LoadSearch(target=math.log(0.02), log_alpha=math.log(0.1), slope=2.0)
    for _ in range(2):
        pressure = 3.0 * math.exp(2.7 * search.log_alpha)
        search.accept(SimpleNamespace(friction=np.array([pressure**0.4]), eps=np.zeros(1)), math.log(pressure))
    assert search.slope == pytest.approx(2.7, rel=1e-12)
    assert search.exponent == pytest.approx([0.4], rel=1e-12)
    assert math.exp(search.log_alpha) == pytest.approx((0.02 / 3.0) ** (1.0 / 2.7), rel=1e-12)


@pytest.mark.parametrize(("tolerated", "pressing"), [(1.2, True), (0.8, False)])
def test_a_contact_presses_where_its_tension_carries_no_more_than_is_tolerated(tolerated, pressing):
    # p = sin θ + 0.6 sin 2θ = sin θ (1 + 1.2 cos θ) pulls where cos θ < -1/1.2; the load is π/2
    pull, _ = integrate.quad(lambda t: -(np.sin(t) ** 2) * (1.0 + 1.2 * np.cos(t)), np.arccos(-1.0 / 1.2), np.pi)
    one = np.ones(1)
    contact = Contact(one, 0.0 * one, np.array([[1.0, 0.6, *[0.0] * 6]]), one, one, one > 0.0)
    found = pressure_signs(contact, tolerated * pull / (0.5 * np.pi))
    assert found.pressing.tolist() == [pressing]
    step = np.pi / 34  # of the places that it is summed over
    assert found.tension == pytest.approx(pull / (0.5 * np.pi), rel=2.0 * step**2)


@pytest.mark.parametrize(("order", "dip"), [(16, 3e-3), (16, -3e-3), (24, -1e-9)])
def test_a_dip_below_zero_inside_a_strip_is_no_pressing_contact(order, dip):
    # p = sin θ (s² + dip) = ¼ (1 + 4 dip) sin θ + ¼ sin 3θ is lowest in the middle, whatever its load
    one = np.ones(1)
    c = np.zeros((1, order))
    c[0, 0], c[0, 2] = 0.25 + dip, 0.25
    signs = pressure_signs(Contact(one, 0.0 * one, c, one, one, one > 0.0), 1.0)
    assert signs.pressing.tolist() == [dip > 0.0]


def test_a_dip_between_the_sampled_places_is_seen():
    # s - s0 squared, less 1e-5: below zero over 0.006 of the half width, a fifth of the distance of two samples
    step, order = np.pi / (8 * 16 + 4), 16
    for shift in (0.25, 0.5, 0.75):
        turn = 0.5 * np.pi - (1.0 + shift) * step
        s0 = np.cos(turn)
        one = np.ones(1)
        c = np.zeros((1, order))
        c[0, :3] = 0.25 + s0**2 - 1e-5, -s0, 0.25  # sin θ cos² θ, -2 s0 sin θ cos θ, (s0² - 1e-5) sin θ
        signs = pressure_signs(Contact(one, 0.0 * one, c, one, one, one > 0.0), 1.0)
        assert not signs.pressing.any()


@pytest.mark.parametrize("rtol", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize(
    ("radius", "thickness", "pressure", "zeta"),
    [(0.3, 0.8, 0.05, 0.3**0.5), (0.4, 1.0, 0.05, 1.4422), (0.4, 1.0, 0.13, 2.08008382)],
)
def test_strips_are_told_apart_at_any_tolerance(radius, thickness, pressure, zeta, rtol):
    # their gaps are 0.19, 0.08 and 0.03 R wide; what little tension one strip would have there friction hardly feels
    problem = ContactProblem("free", radius, pressure, CreepSpectrum(0.1, [0.9], [zeta]), thickness)
    found, fine = solve(problem, rtol), solve(problem, 1e-8)
    assert len(found.patches) == len(fine.patches) == 2
    np.testing.assert_allclose(found.patches, fine.patches, rtol=0, atol=found.edge_error + fine.edge_error)
    assert abs(found.friction / fine.friction - 1.0) <= found.error_estimate <= rtol


def test_strips_that_no_grid_resolves_are_told_in_words(monkeypatch):
    problem = ContactProblem("free", 0.3, 0.05, CreepSpectrum(0.1, [0.9], [0.3**0.5]), 0.8)
    fine = solve(problem, 1e-8)
    refused = SolveOutcome(Status.NOT_CONVERGED, way="grid")
    monkeypatch.setattr(entry, "solve_strips", lambda *_: refused)
    found = solve(problem, 1e-2)
    assert len(found.patches) == 1
    assert "the layer lifts off there" in found.message
    assert found.edge_error > 0.5 * float(fine.patches[1, 0] - fine.patches[0, 1])
    assert abs(found.friction / fine.friction - 1.0) <= found.error_estimate <= 1e-2


def spectrum(seed: int, terms: int = 7) -> CreepSpectrum:
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet(np.ones(terms)) * 0.99
    return CreepSpectrum(1.0 - weights.sum(), weights, 10.0 ** rng.uniform(-8.0, 8.0, terms))


def conveyors(count: int, seed: int = 0) -> list[ContactProblem]:
    """Contacts like a conveyor's: thin confined covers, half widths of a few hundredths, broad spectra."""
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet(np.full(15, 5.0)) * 0.95
    return [
        ContactProblem(
            "confined",
            radius=0.066 * rng.uniform(0.7, 1.4),
            pressure=0.0037 * rng.uniform(0.1, 2.0),
            creep=CreepSpectrum(0.05, weights, np.geomspace(1e-6, 1e4, 15) * 10.0 ** rng.uniform(-1.0, 1.0)),
            thickness=0.0314 * rng.uniform(0.5, 2.0),
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize(
    ("zeta", "count"), [(7.5, 10), (9.0, 10), (30.0, 10), (1e3, 10), (1e6, 10), (22.0, 18), (1e5, 18)]
)
def test_moments_of_slow_terms(zeta, count):
    found = _legendre_moments(np.array([zeta]), count)[:, 0]
    for degree in (0, 1, 4, 9, count - 1):
        for part, value in ((np.real, found[degree].real), (np.imag, found[degree].imag)):
            expected, error = integrate.quad(
                lambda m, part=part, degree=degree: part(
                    special.eval_legendre(degree, 2.0 * m - 1.0) / (1.0 - 1j * m * zeta)
                ),
                0.0,
                1.0,
                points=[min(0.5, 1.0 / zeta), min(0.7, 10.0 / zeta)],
                epsabs=1e-13,
                limit=400,
            )
            assert value == pytest.approx(expected, abs=error + 1e-13)


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("half_width", [0.003, 0.03, 0.15, 0.5, 0.8, 1.4, 2.3])
@pytest.mark.parametrize("thickness", [0.02, 0.3, 4.0])
def test_short_rules_make_the_matrix_of_the_full_rule(support, half_width, thickness):
    # promised: rounding, 1e-9 and 1e-7; entries of a small instantaneous compliance are cancelled by a factor of 100
    creep = spectrum(int(1e4 * half_width))
    problem = ContactProblem(support, 0.45, 0.01, creep, thickness, 0.45)
    full = build_rule(problem.layer, creep, half_width)
    side = CreepBatch(np.array([creep.instantaneous]), creep.weights[None], creep.times[None])
    layers = PlainLayerBatch(support, np.array([thickness]), np.array([0.45]))
    for grades, tolerance in ((FINE_GRADES, 1e-10), (COARSE_GRADES, 2e-8), (LOOSE_GRADES, 2e-6)):
        for rule in short_rules(layers, side, np.array([half_width]), grades):
            # the full rule takes wide contacts on thin layers one by one
            assert rule.nodes.shape[1] < full.nodes.size or (thickness < 0.1 and half_width >= 0.5)
            for share in (1.0, 0.3):
                alpha = np.array([share * half_width])
                expected = assemble_matrix(full, creep, alpha, 24)
                found = assemble_matrix(rule, side, alpha, 24)
                np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * np.abs(expected).max())


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-8])
def test_the_batch_agrees_with_the_general_way(rtol):
    problems = conveyors(12)
    for problem, left in zip(problems, solve_batch(problems, rtol), strict=True):
        outcome = (
            solve_one_strip(SolverState.of(problem), rtol, left).best if isinstance(left, HalfWidthStart) else left
        )
        exact = solve_one_strip(SolverState.of(problem), 1e-10).best.found
        true_error = abs(outcome.found.friction / exact.friction - 1.0)
        assert true_error <= rtol
        assert true_error <= 10.0 * outcome.found.error_estimate
        assert outcome.found.energy_error <= 10.0 * rtol
        # of the load a tenth of rtol may be left; places converge more slowly than friction
        assert outcome.found.mean_pressure == pytest.approx(problem.pressure, rel=0.1 * rtol)
        assert outcome.found.half_width == pytest.approx(exact.half_width, abs=3.0 * rtol * problem.rho)


def test_most_conveyor_contacts_are_narrow():
    found = solve_batch(conveyors(40), 1e-6)
    assert all(outcome is not None and outcome.way == "narrow" for outcome in found)


def test_a_scene_does_not_feel_its_neighbours():
    # padding of terms and panels, and the node count of the widest, change rounding and the coarse rule's 1e-9 only
    strange = ContactProblem("free", 0.3, 1e-6, spectrum(3, terms=40), 0.5)
    problems = [
        *conveyors(5),
        strange,
        ContactProblem("half-space", 0.2, 1e-4, CreepSpectrum(0.1, [0.9], [0.3])),
    ]
    together = solve_many(problems)
    for problem, found in zip(problems, together, strict=True):
        assert found.problem is problem
        assert found.friction == pytest.approx(solve(problem).friction, rel=1e-7)


@pytest.mark.parametrize(
    ("problem", "left"),
    [
        # thin against the contact
        (ContactProblem("free", 0.3, 0.001, CreepSpectrum(0.1, [0.9], [1.0]), 1e-4), UnsolvedReason.ANY),
        # beside the crown, where it touches again
        (ContactProblem("free", 0.4, 0.0012, CreepSpectrum(0.1, [0.9], [3.0]), 0.3), UnsolvedReason.STRIPS),
        # negative between two strips
        (ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0), UnsolvedReason.STRIPS),
    ],
)
def test_what_is_not_one_strip_is_left_to_other_ways(problem, left):
    assert solve_batch([problem], 1e-6) == [left]


@pytest.mark.parametrize(("support", "pressure"), [("free", 0.05), ("confined", 0.05), ("half-space", 0.1)])
@pytest.mark.parametrize("zeta", [0.01, 1.0, 10.0])
@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-10])
def test_wide_contacts_agree_with_the_general_way(support, pressure, zeta, rtol):
    problem = ContactProblem(support, 0.4, pressure, CreepSpectrum(0.1, [0.9], [zeta]), 1.0)
    exact = solve_one_strip(SolverState.of(problem), 1e-12).best.found
    (outcome,) = solve_batch([problem], rtol)
    outcome = (
        solve_one_strip(SolverState.of(problem), rtol, outcome).best if isinstance(outcome, HalfWidthStart) else outcome
    )
    assert abs(outcome.found.friction / exact.friction - 1.0) <= outcome.found.error_estimate <= rtol
    assert outcome.found.half_width == pytest.approx(exact.half_width, abs=10.0 * rtol)


@pytest.mark.parametrize("own", [HalfSpace(), Confined(0.03), Free(2.0)])
def test_layers_of_ones_own_are_narrow_too(own):
    class Wrapped:
        reach = own.reach

        def symbol(self, m, creep):
            return own.symbol(m, creep)

    scenes = [ContactProblem(layer, 0.1, 1e-4, CreepSpectrum(0.1, [0.9], [0.1])) for layer in (own, Wrapped())]
    known, asked = solve_many(scenes)
    assert asked.stats.way == known.stats.way == "narrow"
    assert asked.friction == pytest.approx(known.friction, rel=1e-7)


def test_a_strip_beside_the_crown_is_not_taken_for_the_whole_contact():
    # alone the right strip has a converged answer, friction 0.406, but the layer touches left of the crown again
    found = solve(ContactProblem("free", 0.4, 0.0012, CreepSpectrum(0.1, [0.9], [3.0]), 0.3), rtol=1e-7)
    assert len(found.patches) == 2
    assert found.outer_edge < WRAP_EXTENT
    assert found.friction == pytest.approx(0.3815, abs=2e-4)


def test_elastic_layers_in_a_batch():
    problems = [replace(p, creep=CreepSpectrum(1.0)) for p in conveyors(3)]
    for found in solve_many(problems):
        assert found.status is Status.OK
        assert found.friction == 0.0
        assert found.eccentricity == 0.0


def test_widest_contact_meets_the_alias_of_its_window():
    # exp(-(w(2π-2α))²/4) of the solving windows
    for grade, alias in ((FINE_GRADES[0], 1e-16), (COARSE_GRADES[0], 1e-16), (LOOSE_GRADES[0], 1e-7)):
        for cap in WINDOW_CAPS:
            assert np.exp(-((_window_width(grade, cap) * (2.0 * np.pi - 2.0 * cap)) ** 2) / 4.0) < alias


@pytest.mark.parametrize("pressure", [1e-3, 1e-7, 1e-11])
@pytest.mark.parametrize("zeta", [1e-6, 1.0, 1e6])
def test_friction_keeps_its_relative_precision_however_small(pressure, zeta):
    # half widths down to 1e-8, friction to 1e-20: what is looked up must not leave its rounding there
    problem = ContactProblem("half-space", 0.002, pressure, CreepSpectrum(0.01, [0.99], [zeta]))
    exact = solve_one_strip(SolverState.of(problem), 1e-10).best.found
    (outcome,) = solve_batch([problem], 1e-6)
    outcome = (
        solve_one_strip(SolverState.of(problem), 1e-6, outcome).best if isinstance(outcome, HalfWidthStart) else outcome
    )
    assert abs(outcome.found.friction / exact.friction - 1.0) <= outcome.found.error_estimate <= 1e-6


def test_memory_far_longer_than_the_passage():
    # friction is as small as α/ζ = 1e-11, and inversely proportional to ζ
    scene = ContactProblem("half-space", 1.6e-3, 2e-8, CreepSpectrum(1e-3, [0.999], [3e5]))
    long = solve(scene)
    longer = solve(replace(scene, creep=CreepSpectrum(1e-3, [0.999], [3e6])))
    assert long.friction / longer.friction == pytest.approx(10.0, rel=1e-8)
    assert long.energy_error < 1e-9


def test_half_widths_far_outside_the_search_are_left_without_a_word():
    # the search's next place is so far outside that its α is zero to rounding: dividing by it warned
    creep = CreepSpectrum(0.00322, [0.99678], [0.379])
    problem = ContactProblem("free", 0.066, 0.0374, creep, 0.603)
    assert solve_batch([problem], 1e-3) == [UnsolvedReason.ANY]
    assert solve(problem, 1e-3, throw=False).status is Status.TOO_DEEP
