"""Any scene of the widest ranges ends with an answer whose errors hold, or with a status and advice."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve, solve_many

RTOL = 1e-6


def decades(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


@st.composite
def spectra(draw: st.DrawFn) -> CreepSpectrum:
    """E∞/E0 1 … 1e6; 0 … 60 terms of ζ 0 and 1e-12 … 1e12."""
    terms = draw(st.sampled_from([0, 1, 1, 2, 5, 60]))
    if terms == 0:
        return CreepSpectrum(1.0)
    instantaneous = draw(decades(-6.0, -1e-6))
    shares = np.array(draw(st.lists(st.floats(0.01, 1.0), min_size=terms, max_size=terms)))
    times = draw(st.lists(st.one_of(st.just(0.0), decades(-12.0, 12.0)), min_size=terms, max_size=terms))
    return CreepSpectrum(instantaneous, (1.0 - instantaneous) * shares / shares.sum(), times)


@st.composite
def problems(draw: st.DrawFn) -> ContactProblem:
    """R/λ 1e-4 … 0.5, kh 1e-3 … 1e3 and infinite, p̃_m 1e-12 … 0.1, ν 0 … 0.5."""
    return ContactProblem(
        draw(st.sampled_from(["free", "confined", "half-space"])),
        radius=min(draw(decades(-4.0, -0.3)), 0.5),
        pressure=draw(decades(-12.0, -1.0)),
        creep=draw(spectra()),
        thickness=draw(st.one_of(st.just(math.inf), decades(-3.0, 3.0))),
        poisson=draw(st.floats(0.0, 0.5)),
    )


@given(problem=problems())
@settings(max_examples=60, derandomize=True, suppress_health_check=list(HealthCheck))
def test_every_scene_ends_well(problem):
    found = solve(problem, rtol=RTOL, throw=False)
    if found.status is not Status.OK:
        assert any(word in found.message for word in ("lower", "thicker", "larger rtol"))
        return
    assert found.error_estimate <= RTOL
    # a tenth of it is part of the estimate
    assert found.energy_error <= 10.0 * RTOL
    assert found.friction >= -1e-12
    assert all(math.isfinite(v) for v in (found.penetration, found.peak_pressure, found.half_width))
    assert np.all(np.diff(found.patches.ravel()) > 0.0)
    assert found.outer_edge <= 1.0


@given(scenes=st.lists(problems(), min_size=2, max_size=4))
@settings(max_examples=8, derandomize=True, suppress_health_check=list(HealthCheck))
def test_neighbours_in_a_batch_change_nothing(scenes):
    for alone, together in zip(
        [solve(p, rtol=RTOL, throw=False) for p in scenes], solve_many(scenes, RTOL), strict=True
    ):
        assert alone.status is together.status
        if alone.status is Status.OK:
            scale = abs(alone.friction) or 1.0
            assert abs(alone.friction - together.friction) <= 2.0 * RTOL * scale
