"""Any scene in broad ranges ends as an answer with its error or as a status with its advice: no NaN, no warning."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve

RTOL = 1e-5
BOUNDED = settings(max_examples=400, derandomize=True)
FEW = settings(max_examples=100, derandomize=True)


def decades(low, high):
    return st.floats(low, high).map(lambda exponent: float(10.0**exponent))


@st.composite
def spectra(draw, max_terms=8):
    """Creep spectra of 0 to `max_terms` terms, E∞/E0 up to 1000, times over 14 decades."""
    terms = draw(st.integers(0, max_terms))
    if terms == 0:
        return CreepSpectrum(1.0)
    instantaneous = draw(decades(-3.0, -0.01))
    shares = np.array([draw(st.floats(0.01, 1.0)) for _ in range(terms)])
    times = [draw(decades(-8.0, 6.0)) for _ in range(terms)]
    return CreepSpectrum(instantaneous, (1.0 - instantaneous) * shares / shares.sum(), times)


@st.composite
def problems(draw):
    support = draw(st.sampled_from(["free", "confined", "half-space"]))
    # thinner free layers are plates wrapped round the roll: found by path following, in seconds
    thinnest = -0.5 if support == "free" else -2.5
    return ContactProblem(
        support,
        radius=min(draw(decades(-3.0, -0.301)), 0.5),
        pressure=draw(decades(-8.0, -0.5)),
        creep=draw(spectra()),
        thickness=draw(decades(thinnest, 1.5)),
        poisson=draw(st.floats(0.0, 0.5)),
    )


@BOUNDED
@given(problems())
def test_every_scene_ends_with_an_answer_or_advice(problem):
    found = solve(problem, rtol=RTOL, throw=False)
    assert found.status in Status
    assert found.message
    if found.status not in {Status.OK, Status.NOT_CONVERGED}:
        return
    figures = [
        found.friction,
        found.half_width,
        found.eccentricity,
        found.penetration,
        found.peak_pressure,
        found.error_estimate,
        found.energy_error,
    ]
    assert all(math.isfinite(value) for value in figures)
    low, high = found.patches[0]
    assert -1.0 < low < high < 1.0
    # second law: a spectrum of positive weights only dissipates
    assert found.friction > 0.0 or problem.creep.weights.size == 0
    assert found.eccentricity > 0.0 or problem.creep.weights.size == 0
    if found.status is Status.OK:
        assert found.error_estimate <= RTOL
        assert found.energy_error <= 10.0 * RTOL
        # a pressure no sharper than all its load on the middle half of the strip, no blunter than uniform
        mean = 2.0 * math.pi * problem.pressure / (2.0 * found.half_width * problem.rho)
        assert found.peak_pressure > mean


@FEW
@given(problems())
def test_a_tighter_tolerance_confirms_the_looser(problem):
    loose = solve(problem, rtol=RTOL, throw=False)
    tight = solve(problem, rtol=1e-8, throw=False)
    assume(loose.status is Status.OK and tight.status is Status.OK)
    assert loose.friction == pytest.approx(tight.friction, rel=10.0 * RTOL)
    assert loose.half_width == pytest.approx(tight.half_width, rel=RTOL**0.5)


@FEW
@given(problems(), st.floats(0.05, 0.95))
def test_splitting_a_term_changes_nothing(problem, share):
    given_creep = problem.creep
    assume(given_creep.weights.size > 0)
    first = given_creep.weights[0]
    split = CreepSpectrum(
        given_creep.instantaneous,
        np.concatenate([[share * first, (1.0 - share) * first], given_creep.weights[1:]]),
        np.concatenate([given_creep.times[:1], given_creep.times]),
    )
    one, two = (solve(p, rtol=RTOL, throw=False) for p in (problem, replace(problem, creep=split)))
    assert one.status is two.status
    if one.status is Status.OK:
        # both are the same equations: rounding times their condition, which the load search may stretch
        assert two.friction == pytest.approx(one.friction, rel=1e-8)


@FEW
@given(problems())
def test_load_and_width_grow_together(problem):
    light, heavy = (solve(replace(problem, pressure=f * problem.pressure), rtol=RTOL, throw=False) for f in (1.0, 1.5))
    assume(light.status is Status.OK and heavy.status is Status.OK)
    # strongly wrapped contacts may narrow as they move round the roll
    assume(heavy.half_width + abs(heavy.eccentricity) < 0.5)
    assert heavy.half_width > light.half_width
