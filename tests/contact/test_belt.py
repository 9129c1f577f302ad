"""The belt as support: its symbol against the equations it condenses, its limits, what it refuses, what it loses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from conveyor.contact import (
    Belt,
    Confined,
    ContactProblem,
    CreepSpectrum,
    Free,
    LoadCurve,
    load_curves,
    solve,
    solve_loads,
    solve_many,
)
from conveyor.errors import InputError, NoSolutionError

BOTTOM, TOP = CreepSpectrum(0.1, [0.5, 0.4], [1.0, 0.01]), CreepSpectrum(0.2, [0.8], [0.3])
M = np.array([1.0, 2.0, 7.0, 60.0])
ELASTIC = CreepSpectrum(1.0)


def stream_functions(y, low, high):
    """ψ = e^{-a}, a e^{-a}, e^{b}, b e^{b}, a = y - low, b = y - high, and three derivatives; lengths times κ."""
    a, b = y - low, y - high
    down, up = np.exp(-a), np.exp(b)
    return np.array(
        [
            [down, a * down, up, b * up],
            [-down, (1 - a) * down, up, (1 + b) * up],
            [down, (a - 2) * down, up, (2 + b) * up],
            [-down, (3 - a) * down, up, (3 + b) * up],
        ]
    )


def field(psi, kappa, modulus):
    """u_x, u_y, τ, σ_y of stream functions in an incompressible layer of Young's modulus E: G = E/3."""
    G = modulus / 3.0
    return (
        kappa * psi[1],
        -1j * kappa * psi[0],
        G * kappa**2 * (psi[2] + psi[0]),
        1j * G * kappa**2 * (psi[3] - 3.0 * psi[1]),
    )


def eight_equations(belt, creep, m):
    """S_m and the top cover's share of Im S_m from continuity and balance at three faces, E0 = k = 1, pressure 1."""
    lower, upper = 1.0 / creep.compliance(m), belt.top_modulus / belt.top_creep.compliance(m)
    symbols, tops = [], []
    for kappa, e1, e2 in zip(m, lower, upper, strict=True):
        mid, high = kappa * belt.bottom, kappa * (belt.bottom + belt.top)
        A, right = np.zeros((8, 8), dtype=complex), np.zeros(8, dtype=complex)
        _, uy, tau, sigma = field(stream_functions(0.0, 0.0, mid), kappa, e1)
        A[0, :4], A[1, :4], right[1] = tau, sigma, -1.0
        below = field(stream_functions(mid, 0.0, mid), kappa, e1)
        above = field(stream_functions(mid, mid, high), kappa, e2)
        bending = np.conj(belt.bending)  # Im j > 0 is loss here
        stiff = (0, 0, kappa**2 * belt.stretching, belt.tension * kappa**2 + bending * kappa**4)
        for row, part in ((2, 0), (3, 1), (4, 2), (5, 3)):
            A[row, :4], A[row, 4:] = -below[part], above[part]
        A[4, :4] -= stiff[2] * below[0]
        A[5, :4] -= stiff[3] * below[1]
        A[6, 4:], A[7, 4:] = field(stream_functions(high, mid, high), kappa, e2)[2:]
        size = np.abs(A).max(axis=1)
        x = np.linalg.solve(A / size[:, None], right / size)
        symbols.append(kappa * (uy @ x[:4]) / 1.5)
        u, v, tau, sigma = (row @ x[4:] for row in above)
        tops.append(kappa / 1.5 * (u * np.conj(-tau) + v * np.conj(-sigma)).imag)
    return np.array(symbols), np.array(tops)


@pytest.mark.parametrize(
    "belt",
    [
        Belt(0.8, 0.5, TOP, 0.7, tension=0.05, bending=3e-2, stretching=5.0),
        Belt(0.8, 0.5, TOP, 1.6, tension=-0.001, bending=3e-2 + 1e-2j, stretching=0.0),
        Belt(0.2, 0.9, TOP, 0.1, tension=3.0, bending=0.0, stretching=1e3),
        Belt(0.5, 1e-3, TOP, 1.0, tension=0.2, bending=1e-3j, stretching=0.1),
    ],
)
def test_symbol_and_losses_are_those_of_eight_equations(belt):
    expected, top = eight_equations(belt, BOTTOM, M)
    # the eight equations lose κh^-3 of their digits where a cover is thin: 1e-9 for kh 1e-3
    tolerance = 1e-11 if belt.top > 0.1 else 1e-6
    np.testing.assert_allclose(belt.symbol(M, BOTTOM), expected, rtol=tolerance)
    found, carcass = belt.losses(M, BOTTOM)
    np.testing.assert_allclose(found, top, rtol=tolerance, atol=1e-14)
    assert np.all(carcass >= 0.0)
    assert np.all(found + carcass <= belt.symbol(M, BOTTOM).imag)


@pytest.mark.parametrize("whole", [1.0, 0.01])
def test_without_a_carcass_it_is_the_free_layer_of_both_covers(whole):
    belt = Belt(0.3 * whole, 0.7 * whole, BOTTOM, 1.0, tension=0.0)
    np.testing.assert_allclose(belt.symbol(M, BOTTOM), Free(whole).symbol(M, BOTTOM), rtol=1e-14)


def test_no_top_cover_is_a_layer_of_no_thickness():
    bare = Belt(0.3, 0.0, BOTTOM, 1.0, tension=0.0)
    np.testing.assert_allclose(bare.symbol(M, BOTTOM), Free(0.3).symbol(M, BOTTOM), rtol=1e-14)


def test_on_a_stiff_carcass_it_is_the_confined_cover():
    belt = Belt(0.3, 0.2, TOP, 1.0, tension=1e12, bending=1e12, stretching=1e12)
    np.testing.assert_allclose(belt.symbol(M, BOTTOM), Confined(0.3).symbol(M, BOTTOM), rtol=1e-9)


def test_long_waves_see_a_string():
    # S → κE0/(2(1-ν²) T κ²)
    belt = Belt(1e-6, 1e-6, TOP, 1.0, tension=0.2)
    np.testing.assert_allclose(belt.symbol(M[:2], BOTTOM), 1.0 / (1.5 * 0.2 * M[:2]), rtol=1e-5)


def test_symbol_becomes_that_of_the_bottom_cover_at_its_reach():
    belt = Belt(0.3, 0.2, TOP, 0.5, tension=0.1, stretching=0.0)
    m = belt.reach * np.array([1.0, 2.0, 1e3])
    np.testing.assert_allclose(belt.symbol(m, BOTTOM), BOTTOM.compliance(m), rtol=1e-14)


def conveyor_belt(**changes):
    """A belt of 6 mm covers on idlers 1.2 m apart, as a number."""
    values = {
        "bottom": 0.0314, "top": 0.0157, "top_creep": TOP, "top_modulus": 0.75,
        "tension": 0.05, "bending": 3e-4, "stretching": 50.0,
    }  # fmt: skip
    return Belt(**{**values, **changes})


TERMS = CreepSpectrum(0.05, np.full(7, 0.95 / 7.0), np.logspace(-5.0, 1.0, 7))


def on_idlers(belt, pressure=0.0037):
    return ContactProblem(support=belt, radius=0.066, pressure=pressure, creep=TERMS)


def test_belts_are_solved_side_by_side_as_one_by_one():
    belts = [conveyor_belt(tension=t, top=h) for t, h in ((0.02, 0.0157), (0.05, 0.0), (0.3, 0.05))]
    problems = [on_idlers(belt) for belt in belts]
    problems.insert(1, ContactProblem("confined", 0.066, 0.0037, TERMS, 0.0314))
    for problem, found in zip(problems, solve_many(problems), strict=True):
        assert found.stats.way == "narrow"
        exact = solve(problem, rtol=1e-9)
        assert found.friction == pytest.approx(exact.friction, rel=1e-6)
        assert found.energy_error < 1e-5


def test_loads_of_a_belt():
    problem = on_idlers(conveyor_belt())
    loads = np.geomspace(0.1, 1.0, 5) * problem.pressure
    found = solve_loads(problem, loads)
    exact = [solve(replace(problem, pressure=p), rtol=1e-8).friction for p in loads]
    np.testing.assert_allclose(found.friction, exact, rtol=1e-6)
    (curve,) = load_curves([problem], loads[:1], loads[-1:])
    assert isinstance(curve, LoadCurve)
    np.testing.assert_allclose(curve.at(loads).friction, exact, rtol=1e-6)


def test_a_tighter_belt_approaches_the_confined_cover():
    confined = solve(ContactProblem("confined", 0.066, 0.0037, TERMS, 0.0314)).friction
    off = [
        abs(solve(on_idlers(conveyor_belt(tension=t, stretching=1e4))).friction / confined - 1.0)
        for t in (0.03, 0.3, 3.0, 300.0)
    ]
    assert off == sorted(off, reverse=True)
    assert off[-1] < 1e-3


def test_shares_of_the_loss():
    quiet = solve(on_idlers(conveyor_belt())).loss_shares
    assert list(quiet) == ["bottom_cover", "top_cover", "carcass"]
    assert sum(quiet.values()) == pytest.approx(1.0, abs=1e-15)
    assert quiet["carcass"] == 0.0
    lossy = solve(on_idlers(conveyor_belt(bending=3e-4 + 1e-4j)))
    assert lossy.loss_shares["carcass"] > 1e-3
    assert lossy.friction > solve(on_idlers(conveyor_belt())).friction


def test_what_covers_of_no_loss_leave_is_lost_in_the_carcass():
    belt = conveyor_belt(top_creep=ELASTIC, bending=3e-4 + 1e-4j)
    found = solve(ContactProblem(belt, 0.066, 0.0037, ELASTIC), rtol=1e-8)
    assert found.friction > 0.0
    assert found.energy_error < 1e-7
    assert found.loss_shares["carcass"] == pytest.approx(1.0, abs=1e-6)


def test_a_single_layer_loses_all_of_it_itself():
    shares = solve(ContactProblem("confined", 0.066, 0.0037, TERMS, 0.0314)).loss_shares
    assert shares == {"bottom_cover": 1.0, "top_cover": 0.0, "carcass": 0.0}


def test_nothing_lost_has_no_shares():
    belt = conveyor_belt(top_creep=ELASTIC)
    with pytest.raises(NoSolutionError, match="loss_shares: no loss"):
        _ = solve(ContactProblem(belt, 0.066, 0.0037, ELASTIC)).loss_shares


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bottom": 0.0}, r"bottom: got 0\.0, allowed: >= 1e-12"),
        ({"top": -0.1}, r"top: got -0\.1, allowed: >= 0 and finite"),
        ({"stretching": -1.0}, r"stretching: got -1\.0, allowed: >= 0"),
        ({"stretching": np.inf}, "stretching: got inf, allowed"),
        ({"bending": -1e-4}, r"bending: got -0\.0001, allowed: D' and D''"),
        ({"bending": 1e-4 - 1e-5j}, ">= 0 and finite"),
        ({"bending": complex(np.nan, 0.0)}, "bending: got .*finite"),
        ({"top_modulus": 0.0}, "top_modulus: got 0.0, allowed: > 0 and finite"),
        ({"tension": np.nan}, "tension: got nan, allowed: finite"),
        ({"tension": "1"}, "tension: got '1', allowed: a number"),
        ({"top_creep": [1.0]}, r"top_creep: got \[1\.0\], allowed: a CreepSpectrum"),
        ({"tension": -0.1}, r"tension: got -0\.1, allowed: > -0\.00.* at which the belt buckles"),
        ({"tension": -1e-9, "bending": 0.0}, "allowed: > 0, .* at which the belt buckles"),
    ],
)
def test_impossible_belts_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        conveyor_belt(**changes)


def test_the_compression_named_is_the_limit():
    # the relaxed symbol grows without bound toward it, at one of the harmonics
    m = np.arange(1.0, 201.0)
    with pytest.raises(InputError) as refused:
        conveyor_belt(tension=-0.1)
    limit = float(str(refused.value).partition("> ")[2].partition(",")[0])
    near = conveyor_belt(tension=0.99 * limit).symbol(m, ELASTIC).real
    assert near.min() > 0.0
    assert near.max() > 20.0 * conveyor_belt(tension=0.0).symbol(m, ELASTIC).real.max()


def test_covers_of_a_belt_are_incompressible():
    with pytest.raises(InputError, match=r"poisson: got 0\.45, allowed: 0\.5, the covers of a Belt are incompressible"):
        ContactProblem(conveyor_belt(), 0.066, 0.0037, TERMS, poisson=0.45)


SHARP = CreepSpectrum(1.27e-4, [1.0 - 1.27e-4], [107.0])


@pytest.mark.parametrize("rtol", [1e-3, 1e-4, 1e-6, 1e-7])
def test_a_belt_tells_what_the_short_rules_do_to_it(rtol):
    # off by 2.4e-5 and 3.0e-8, more than the rules do to a layer alone
    top = CreepSpectrum(6.5e-4, [1.0 - 6.5e-4], [52.7])
    belt = Belt(0.003767, 0.0, top, 0.642, tension=0.01102, bending=5.78e-6, stretching=40.5)
    problem = ContactProblem(belt, 0.2251, 1.106e-6, SHARP)
    found, fine = solve(problem, rtol), solve(problem, 1e-10)
    off = abs(found.friction / fine.friction - 1.0)
    assert off <= found.error_estimate + fine.error_estimate
    assert found.error_estimate <= rtol


def test_a_belt_carries_the_load_it_is_asked_for():
    # where its load rises with the half width unlike that of the low order, the load is met all the same
    creep = CreepSpectrum(0.0151929, [0.03258744, 0.95221966], [1.57812578, 1.10680536])
    top = CreepSpectrum(0.03783249, [0.09653433, 0.24264424, 0.62298894], [101.80438, 725.213112, 3.40981167e-7])
    belt = Belt(
        0.00462876377,
        0.00462876377,
        top,
        1.588459306,
        tension=4.1443963896e-4,
        bending=1.9477955636e-5 + 9.738977818e-6j,
    )
    problem = ContactProblem(belt, 0.3012064997664983, 1.3685980859436065e-5, creep)
    found, fine = solve(problem, 1e-7), solve(problem, 1e-10)
    carried = sum(0.25 * alpha * c[0] for _, alpha, c in found.strips)
    assert carried == pytest.approx(problem.pressure, rel=1e-12)
    assert abs(found.friction / fine.friction - 1.0) <= found.error_estimate <= 1e-7
