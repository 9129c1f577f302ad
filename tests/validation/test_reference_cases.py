"""Contacts computed elsewhere (conveyor/_reference): every figure at two tolerances, and the estimate of its error."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from conveyor.contact import solve
from conveyor.validation import contact_cases
from conveyor.validation.reference_cases import run_reference_checks
from conveyor.validation.reference_check import ReferenceCheck

CASES = contact_cases.reference_cases()
SINGLE = [case for case in CASES if not case.split]
SPLIT = [case for case in CASES if case.split]
PROMISED = {1e-6: 1e-6, 1e-9: 1e-8}  # rtol: error of friction; the reference is good to 1e-9


@cache
def solved(case, rtol):
    return solve(case.problem, rtol=rtol)


def by_name(cases):
    return pytest.mark.parametrize("case", cases, ids=[case.name for case in cases])


def test_there_are_as_many_cases_as_the_file_was_made_with():
    assert (len(SINGLE), len(SPLIT)) == (41, 1)


@by_name(SINGLE)
@pytest.mark.parametrize("rtol", PROMISED)
class TestSingleStrip:
    def test_friction(self, case, rtol):
        assert solved(case, rtol).friction == pytest.approx(case.friction, rel=PROMISED[rtol])

    def test_place(self, case, rtol):
        # in units of R; the tolerance asked for is that of friction, lengths converge more slowly
        found = solved(case, rtol)
        assert found.half_width == pytest.approx(case.half_width, abs=1e-5)
        assert found.eccentricity == pytest.approx(case.eccentricity, abs=1e-5)
        assert found.penetration == pytest.approx(case.penetration, abs=1e-5)

    def test_error_estimate_is_within_ten_of_the_true_error(self, case, rtol):
        found = solved(case, rtol)
        true = abs(found.friction / case.friction - 1.0)
        assert found.error_estimate <= rtol
        # the reference's own error, ten times its last change, is not the solver's
        assert true <= 10.0 * (found.error_estimate + case.relative_change)

    def test_energy_error_is_small(self, case, rtol):
        # ten times rtol is what the solver accepts: while the order is too small it is 5 to 80 times the error
        assert solved(case, rtol).energy_error <= 10.0 * rtol

    def test_peak_pressure(self, case, rtol):
        # pressure converges more slowly than friction (3.4e-4 seen at 1e-6), and the reference is the largest
        # of samples, up to 3e-4 below the maximum
        assert solved(case, rtol).peak_pressure == pytest.approx(case.peak_pressure, rel=5e-4)


@by_name(SPLIT)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_contact_that_splits_has_several_strips(case, rtol):
    # the reference knows only that it splits; figures of split contacts: test_split_contacts.py
    found = solve(case.problem, rtol=rtol)
    assert len(found.patches) > 1
    assert found.energy_error <= 10.0 * rtol


def test_the_tighter_tolerance_is_closer_on_the_whole():
    worst = [max(abs(solved(case, rtol).friction / case.friction - 1.0) for case in SINGLE) for rtol in (1e-6, 1e-9)]
    assert worst[1] < 1e-2 * worst[0]


# the command's own list of checks


def test_every_shipped_check_passes():
    failed = [check for check in run_reference_checks() if not check.passed]
    assert failed == []


def test_shipped_checks_name_source_and_quantity():
    checks = run_reference_checks()
    assert {check.source for check in checks} == {
        "Bessel-Galerkin prototype",
        "CEMA, transition",
        "CONTACT program",
        "Conveyor C-1.1 report",
        "Grimmer, Kessler (1987), by eytelwein 0.1.9",
        "Harrison (1983, 1985), measured",
        "Helix delta-T reports",
        "Helix feeder load calculation",
        "Helix shaft report",
        "Hunter (1961)",
        "ISO 5048 worked example",
        "ISO 5048, cross-section",
        "ISO 5293:2004",
        "J*(ω) E*(ω) = 1",
        "Lemmon (2013), finite elements",
        "Lodewijks (1996), finite elements",
        "NEMA MG 10, table 2-3",
        "Nordell and Ciozda (1984), measured",
        "Rulmeca, impact rollers",
        "Sandvik (1999), load of idlers",
        "Shortt (2019), idler of 127 mm, bearings 6305",
        "Song et al. (2012)",
        "ckit.co.za, trajectories",
        "catenary between the sets",
        "course of a flat belt, set by set",
        "least cost of the sets, by search",
        "polygon of five rolls",
        "two-strip derivation",
    }
    assert len({(check.source, check.quantity) for check in checks}) == len(checks)


@pytest.mark.parametrize(("deviation", "passed"), [(0.9e-6, True), (1e-6, True), (1.1e-6, False)])
def test_a_check_fails_beyond_its_tolerance(deviation, passed):
    check = ReferenceCheck("s", "q", expected=1.0, got=1.0 + deviation, deviation=deviation, tolerance=1e-6)
    assert check.passed is passed


def test_a_wrong_solver_would_fail(monkeypatch):
    def wrong(problem, **options):
        return solve(replace(problem, pressure=1.01 * problem.pressure), **options)

    monkeypatch.setattr(contact_cases, "solve", wrong)
    failed = [check for check in run_reference_checks() if not check.passed]
    # every friction of the reference and of the split contacts, every Hunter figure that depends on the load
    assert sum("friction" in check.quantity for check in failed) == len(SINGLE) + 2 + 9
