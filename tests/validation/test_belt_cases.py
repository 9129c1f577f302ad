"""Belts solved elsewhere: six converged contacts of a separate implementation, and three methods on one belt.

`belt_cases.json`: converged in order until friction changed by `relative_change`; two rows were confirmed on a grid.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import pytest

from conveyor.contact import Belt, ContactProblem, CreepSpectrum, solve, solve_many
from conveyor.contact.solvers.grid_solver import solve_grid

from .test_boundary_elements import route

CASES = {case["name"]: case for case in json.loads((Path(__file__).parent / "belt_cases.json").read_text("utf-8"))}
by_name = pytest.mark.parametrize("name", CASES)


def creep(case):
    return CreepSpectrum(case["instantaneous_compliance"], case["creep_weights"], case["creep_times_zeta"])


def problem(case):
    top = case["top_cover"]
    belt = Belt(
        case["bottom_kh"],
        case["top_kh"],
        creep(top),
        top["rubbery_modulus_ratio"],
        case["tension"],
        case["bending"],
        case["stretching"],
    )
    return ContactProblem(belt, case["radius_over_spacing"], case["mean_pressure"], creep(case))


@cache
def solved(name, rtol):
    return solve(problem(CASES[name]), rtol=rtol)


@by_name
@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
def test_figures(name, rtol):
    case, found = CASES[name], solved(name, rtol)
    assert found.friction == pytest.approx(case["friction"], rel=rtol + 10.0 * case["relative_change"])
    assert found.error_estimate <= rtol
    assert found.energy_error <= 10.0 * rtol
    # of R; lengths converge more slowly than friction
    assert found.half_width == pytest.approx(case["half_width_over_R"], abs=10.0 * rtol)
    assert found.eccentricity == pytest.approx(case["eccentricity_over_R"], abs=10.0 * rtol)
    assert found.loss_shares["top_cover"] == pytest.approx(case["top_cover_share"], rel=1e-4)


def test_batch():
    found = solve_many([problem(case) for case in CASES.values()], rtol=1e-6)
    for case, one in zip(CASES.values(), found, strict=True):
        assert one.friction == pytest.approx(case["friction"], rel=1e-6)


@pytest.mark.parametrize("name", ["carry T 20000", "thick fabric"])
def test_three_methods_agree(name):
    # grid: second order, 45 nodes in the contact; boundary elements: third order
    scene, exact = problem(CASES[name]), solved(name, 1e-8)
    grid = solve_grid(scene, 16384)
    assert grid.friction == pytest.approx(exact.friction, rel=1e-3)
    assert grid.depth == pytest.approx(exact.penetration, rel=1e-4)
    elements = route.solve_boundary_elements(scene, 256)
    assert elements.friction == pytest.approx(exact.friction, rel=2e-5)
    assert elements.half_width == pytest.approx(exact.half_width, rel=2e-5)
    assert elements.penetration == pytest.approx(exact.penetration, rel=2e-5)
