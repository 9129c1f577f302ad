"""Several strips: laws every one of them obeys, and invariances of the whole."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import special

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve
from conveyor.contact.solvers import many_strips as module
from conveyor.contact.solvers.grid_solver import solve_grid
from conveyor.contact.solvers.refinement import Refined, RefinementEnd
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.contact.solvers.strips import (
    _gap_window,
    balance_strips,
    friction_by_loss,
    smallest_gap,
    too_close,
)

ROUNDING = 1e-11  # of systems of condition 100 and sums of 100 terms, in whatever order: 1e4 of 2e-16
ONE = CreepSpectrum(0.1, [0.9], [1.0])
SPLIT = ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
SINGLE = {
    "confined": ContactProblem("confined", 0.4, 0.05, ONE, 1.0),
    "free": ContactProblem("free", 0.4, 0.05, ONE, 1.0),
    "half-space": ContactProblem("half-space", 0.1, 1e-3, ONE),
}
SEVERAL = {
    "two": SPLIT,
    "three": ContactProblem("free", 0.3, 0.03, CreepSpectrum(0.1, [0.9], [0.3]), 0.3),
    "four": ContactProblem("free", 0.3, 0.03, ONE, 0.2),
}
COUNT = {"two": 2, "three": 3, "four": 4}
several = pytest.mark.parametrize("name", SEVERAL)


@cache
def solved(problem, rtol=1e-9):
    return solve(problem, rtol=rtol)


def quadrature(low, high, points=400):
    """Nodes and weights of the second kind: exact for sqrt(1-s²) times a polynomial."""
    angle = np.arange(1, points) * math.pi / points
    return 0.5 * (low + high) + 0.5 * (high - low) * np.cos(angle), 0.5 * (high - low) * math.pi / points * np.sin(
        angle
    )


def roll(found, x):
    return found.penetration - 1.0 + np.sqrt(1.0 - x**2)


@pytest.mark.parametrize("name", SINGLE)
def test_one_strip_is_the_contact_of_the_half_width(name):
    problem = SINGLE[name]
    exact = solve(problem, rtol=1e-11)
    scene = SolverState.of(problem)
    start = (
        np.array([1.02 * exact.eccentricity * problem.rho]),
        np.array([0.98 * exact.half_width * problem.rho]),
    )
    found = balance_strips(scene, max(exact.stats.order, 32), *start, 1e-12)
    assert found.friction == pytest.approx(exact.friction, rel=1e-10)
    assert found.depth == pytest.approx(exact.penetration, rel=1e-9)
    assert friction_by_loss(scene, found) == pytest.approx(found.friction, rel=1e-10)


@several
def test_strips_carry_the_load_at_one_height(name):
    found = solved(SEVERAL[name])
    assert len(found.patches) == COUNT[name]
    rho = found.problem.rho
    carried, force = 0.0, 0.0
    for low, high in found.patches:
        x, weight = quadrature(low, high)
        p = found.pressure(x)
        assert p.min() >= 0.0
        carried += float(weight @ p)
        force += float(weight @ (p * x / np.sqrt(1.0 - x**2)))
        # inside a strip the surface is the roll; the series is cut off at 1e-7 of the depth, worse near the edges
        inner = x[40:-40:16]
        np.testing.assert_allclose(
            found._need().fields.outside(inner * rho),
            roll(found, inner),
            rtol=0,
            atol=2e-6 * found.penetration,
        )
    # p̃_m over a period 1/R̃ of x/R
    assert carried * found.problem.radius == pytest.approx(found.problem.pressure, rel=1e-9)
    assert force / carried == pytest.approx(found.friction, rel=1e-8)


@several
def test_no_pressure_and_no_overlap_beside_the_strips(name):
    found = solved(SEVERAL[name])
    ends = np.concatenate([[-1.0], found.patches.ravel(), [1.0]]).reshape(-1, 2)
    for low, high in ends:
        gap = np.linspace(low, high, 41)[1:-1]
        assert np.all(found.pressure(gap) == 0.0)
        assert np.all(found.profile(gap) > roll(found, gap))


@several
def test_friction_by_loss_is_friction_by_geometry(name):
    assert solved(SEVERAL[name]).energy_error < 1e-8


@several
def test_the_grid_agrees(name):
    # an error that falls like step^(3/2) is at most 0.55 of the last doubling's change; the edges' place between the
    # nodes scatters it, so the larger of two changes is taken whole
    problem, found = SEVERAL[name], solved(SEVERAL[name])
    grids = [solve_grid(problem, 512)]
    for points in (1024, 2048, 4096, 8192):
        grids.append(solve_grid(problem, points, grids[-1]))
    coarse, medium, fine = grids[-3:]
    assert len(fine.strips) == COUNT[name]
    assert np.abs(fine.strips - found.patches * problem.rho).max() < 2.0 * math.pi / 8192
    for figure, exact in (("friction", found.friction), ("depth", found.penetration)):
        last = getattr(fine, figure)
        change = max(abs(getattr(medium, figure) - last), abs(getattr(coarse, figure) - last))
        assert abs(last - exact) <= change
        # four strips: the narrowest has eight nodes at the coarse grid
        assert change < 3e-3 * exact


@several
def test_strips_have_no_order_and_start_anywhere_near(name):
    problem = SEVERAL[name]
    found = solved(problem)
    scene = SolverState.of(problem)
    edges = found.patches * problem.rho
    centre, alpha = edges.mean(axis=1), 0.5 * np.diff(edges, axis=1)[:, 0]
    # part of the narrowest half width: Newton is on its own
    away = centre + 0.03 * alpha.min() * np.where(np.arange(centre.size) % 2, 1.0, -1.0)
    turned = balance_strips(scene, 64, away[::-1], 0.97 * alpha[::-1], 1e-9)
    assert turned is not None
    np.testing.assert_allclose(turned.contact.eps[::-1], centre, rtol=0, atol=1e-8)
    np.testing.assert_allclose(turned.contact.alpha[::-1], alpha, rtol=0, atol=1e-8)
    assert turned.friction == pytest.approx(found.friction, rel=1e-8)
    assert friction_by_loss(scene, turned) == pytest.approx(found.friction, rel=1e-8)


def test_equal_retardation_times_are_one():
    halves = replace(SPLIT, creep=CreepSpectrum(0.1, [0.3, 0.6], [3.0, 3.0]))
    found, twice = solved(SPLIT), solved(halves)
    assert twice.friction == pytest.approx(found.friction, rel=1e-11)
    np.testing.assert_allclose(twice.patches, found.patches, rtol=0, atol=1e-11)


def test_poissons_ratio_only_scales_a_free_layer():
    other = solved(replace(SPLIT, poisson=0.3))
    assert other.friction == pytest.approx(solved(SPLIT).friction, rel=ROUNDING)


# a thin plate on a roll: two strips of equal width, each the other's mirror image
PLATE = ContactProblem("free", 0.2, 0.13, CreepSpectrum(1.0), 0.8)


@pytest.mark.parametrize("problem", [PLATE, replace(SEVERAL["three"], creep=CreepSpectrum(1.0))])
def test_elastic_split_contact_is_symmetric(problem):
    found = solve(problem, rtol=1e-8)
    assert len(found.patches) == COUNT["two" if problem is PLATE else "three"]
    np.testing.assert_allclose(found.patches, -found.patches[::-1, ::-1], rtol=0, atol=1e-8)
    assert abs(found.friction) < 1e-10
    x = found.patches[0].mean() * np.array([0.98, 1.0, 1.02])
    np.testing.assert_allclose(found.pressure(x), found.pressure(-x), rtol=1e-6)


def test_slow_and_fast_strips_are_elastic():
    # rubber at rest, and glass: E∞ in place of E0 under ten times the pressure is the same surface; what is left of
    # the memory falls like ζ and 1/ζ
    elastic = solved(PLATE)
    slow = solve(replace(PLATE, creep=CreepSpectrum(0.1, [0.9], [1e-4])), rtol=1e-4)
    fast = solve(replace(PLATE, creep=CreepSpectrum(0.1, [0.9], [9e4]), pressure=1.3), rtol=1e-4)
    for found in (slow, fast):
        # 1e-4 of memory, times the lag's lever of 1/R
        np.testing.assert_allclose(found.patches, elastic.patches, rtol=0, atol=1e-3)
        assert found.penetration == pytest.approx(elastic.penetration, rel=1e-3)
        assert 0.0 < found.friction < 1e-3


def test_a_contact_splits_without_a_jump():
    # one strip at the first three loads, two at the last four. Third differences are a twelfth of the second; a jump
    # would make them twice as large
    loads = np.arange(0.0682, 0.0719, 0.0005)
    found = [solved(replace(SPLIT, pressure=float(load)), 1e-8) for load in loads]
    count = [len(s.patches) for s in found]
    assert (count[0], count[-1]) == (1, 2)
    assert count == sorted(count)
    for figure in ("friction", "penetration", "half_width", "eccentricity"):
        second, third = (np.diff([getattr(s, figure) for s in found], k) for k in (2, 3))
        assert np.abs(third).max() < 0.2 * np.abs(second).max()


def test_the_gap_opens_like_the_square_root_of_the_load():
    # where pressure touches zero it is a parabola, which the load beyond the split lowers in proportion
    loads = np.array([0.0702, 0.0707, 0.0712, 0.0717])
    patches = [solved(replace(SPLIT, pressure=float(load)), 1e-8).patches for load in loads]
    square = np.array([(p[1, 0] - p[0, 1]) ** 2 for p in patches])
    rise = np.diff(square)
    # the next term is of the order of the load's change, 2 %
    assert rise[1:] == pytest.approx(rise[:-1], rel=0.02)
    begins = loads[0] - square[0] * (loads[1] - loads[0]) / rise[0]
    assert len(solved(replace(SPLIT, pressure=0.999 * begins), 1e-8).patches) == 1


def test_fields_repeat_with_the_rolls():
    found = solve(SPLIT)
    x = np.array([-0.4, 0.0, 0.5])
    np.testing.assert_allclose(found.pressure(x + 1.0 / SPLIT.radius), found.pressure(x), rtol=1e-12)


def test_gap_counts_the_next_roll():
    centre, alpha = np.array([-2.0, 2.0]), np.array([0.5, 0.6])
    assert smallest_gap(centre, alpha) == pytest.approx(2.0 * math.pi - 2.6 - 2.5)
    assert smallest_gap(centre[:1], alpha[:1]) == pytest.approx(2.0 * math.pi, rel=1e-15)
    assert too_close(np.array([0.0, 1.0]), np.array([0.497, 0.497]))
    assert not too_close(np.array([0.0, 1.0]), np.array([0.495, 0.495]))


def test_what_counts_is_the_gap_beside_the_contacts_width():
    assert not too_close(1e-3 * np.array([0.0, 1.0]), 1e-3 * np.array([0.49, 0.49]))
    assert too_close(1e-3 * np.array([0.0, 1.0]), 1e-3 * np.array([0.495, 0.495]))


@pytest.mark.parametrize("width", [1.0, 0.01])
def test_window_of_near_strips_is_their_sum_wave_by_wave(width):
    # two line forces a gap g apart: the window, by a quadrature where the contact is narrow, or every m of it
    scene = SolverState.of(ContactProblem("free", 0.3, 0.01, CreepSpectrum(0.1, [0.9], [1e-3]), 0.02))
    gap = 0.5 * width
    m, weights = _gap_window(scene, gap, width)
    ramp = 12.5 / gap
    every = np.arange(1.0, 13.0 * ramp + 1.0)
    plain = scene.problem.layer.symbol(every, scene.creep) / every
    plain *= 0.5 * special.erfc(every / ramp - 6.5)
    assert m.size <= every.size
    for distance in (gap, width):
        sums = (weights @ np.exp(1j * m * distance), plain @ np.exp(1j * every * distance))
        assert abs(sums[0] - sums[1]) <= 1e-12 * np.abs(plain).sum()  # Gauss panels, quadrature.py


def test_two_lines_of_a_small_roll_are_polished():
    # 0.0022/k apart: the grid of 2^20 nodes was the last word, friction to 6 %
    thin = ContactProblem("free", 2.46e-4, 7.53e-3, CreepSpectrum(0.48, [0.52], [9e6]), 3.25e-3)
    found, finer = solve(thin, throw=False), solve(thin, rtol=1e-8, throw=False)  # rounding leaves 1e-9
    assert found.status is finer.status is Status.TOO_DEEP
    assert found.stats.way == "strips"
    assert len(found.patches) == 2
    assert found.friction == pytest.approx(finer.friction, rel=found.error_estimate + finer.error_estimate)
    grid = solve_grid(thin, 1 << 20)
    step = 2.0 * math.pi / grid.points / thin.rho
    np.testing.assert_allclose(found.patches, grid.strips / thin.rho, rtol=0, atol=2.0 * step)


def test_strips_that_cannot_be_polished_keep_the_grid_with_its_error(monkeypatch):
    exact = solve(SPLIT, rtol=1e-9)
    monkeypatch.setattr(module, "_polish_strips", lambda *_: Refined(RefinementEnd.LOST, None))
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


@pytest.mark.parametrize("allowed", [0, 2])
def test_orders_without_strips_near_the_grids_are_given_up_after_those_allowed(monkeypatch, allowed):
    tried = []
    monkeypatch.setattr(module, "balance_strips", lambda _, order, *__, **___: tried.append(order))
    monkeypatch.setattr(module, "_LAST_TRIAL_ORDER", module.ORDERS[0] + 20)
    monkeypatch.setattr(module, "next_order", lambda order, _: order + 1)
    start = SimpleNamespace(centre=0.0, alpha=1.0, failures=allowed)
    assert module.StripsOrders(SimpleNamespace(), start, 1e-4).balance() is None
    assert len(tried) == allowed + 1


class TestLineContacts:
    """A thin lossy plate tilts under the roll until a line of it touches: narrower than any grid shows at first."""

    THIN = ContactProblem("free", 0.01, 2e-5, CreepSpectrum(0.01, [0.99], [39.0]), 0.01)

    @pytest.mark.parametrize("pressure", [2e-5, 1e-4])
    def test_friction_is_the_slope_at_the_line(self, pressure):
        found = solve(replace(self.THIN, pressure=pressure))
        assert found.status is Status.TOO_DEEP  # a plate this thin sags far below the roll
        slope = found.eccentricity / math.sqrt(1.0 - found.eccentricity**2)
        # slopes spread over the strip by a/R (1 + slope²)^(3/2): second order
        assert found.friction == pytest.approx(slope, rel=(found.half_width * (1.0 + slope**2) ** 1.5) ** 2)
        assert found.energy_error < 1e-9

    def test_a_line_force_tilts_in_proportion_to_itself(self):
        # a point force's own slope is its force times 2 Σ Im S: that of the finite strip differs by O(α/kh)²
        one, five = (solve(replace(self.THIN, pressure=p)) for p in (2e-5, 1e-4))
        assert five.friction / one.friction == pytest.approx(5.0, rel=1e-6)
        assert (one.half_width * self.THIN.rho / self.THIN.thickness) ** 2 < 1e-4


def test_forces_that_cancel_leave_the_friction_of_the_loss():
    # two strips push forward and back a hundred million times harder than the layer resists
    thin = ContactProblem("free", 0.207, 2.4e-4, CreepSpectrum(0.1, [0.9], [1e-9]), 0.15)
    short = solve(replace(thin, creep=CreepSpectrum(0.1, [0.9], [1e-12])))
    found = solve(thin)
    # memory this short: friction in proportion to it, to O(ζ/kh)
    assert found.friction / short.friction == pytest.approx(1e3, rel=1e-8)
    assert "forces cancel" in short.message
    assert short.error_estimate < 1e-6


@pytest.mark.parametrize(
    ("problem", "count"),
    [
        (ContactProblem("free", 0.252, 1.4e-3, CreepSpectrum(0.075, [0.925], [1.5e-12]), 0.178), 3),
        (ContactProblem("free", 0.353, 3.29e-7, CreepSpectrum(0.19, [0.81], [1e6]), 0.0166), 2),
    ],
)
def test_what_newton_leaves_is_in_the_errors(problem, count):
    # orders agree to rounding at places that Newton left 1e-10 off: friction was off by 700 times its estimate,
    # edges by 3,600 times, the largest pressure by 36,000 times
    found, finer = solve(problem), solve(problem, rtol=1e-10)
    assert len(found.patches) == len(finer.patches) == count
    assert found.friction == pytest.approx(finer.friction, rel=found.error_estimate)
    np.testing.assert_allclose(found.patches, finer.patches, rtol=0, atol=found.edge_error)
    assert found.peak_pressure == pytest.approx(finer.peak_pressure, rel=found.peak_error)


def test_a_place_alone_leaves_the_matrices():
    # each Jacobian of l strips: the whole and l half widths, not (2l + 1) l matrices
    found = solve(SEVERAL["three"])
    assert found.stats.matrices % 3 == 0
    assert found.stats.matrices < 60


def test_an_elastic_plate_may_ask_for_more_than_192_coefficients():
    # a contact that nearly fills the half circle: without retardation terms there is no tail of orders to go on with
    found = solve(ContactProblem("free", 0.496, 8.25e-6, CreepSpectrum(1.0, [], []), 0.0019))
    assert found.status is Status.OK
    assert found.stats.order > 192
    assert abs(found.friction) < 1e-6
