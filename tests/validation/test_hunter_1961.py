"""The spectral solver on a half-space against Hunter's closed form, with the tolerance that the differences leave.

Hunter rolls one parabola, the solver a row of circles. The slope of the circle is t/sqrt(1-t²), t ≤ (a+|e|)/R: its rate
is up to 3t²/2 more. The row replaces the kernel 1/X by ½ cot(X/2) = (1/X)(1 - X²/12 + ...), X up to the width of the
contact plus the length ζ over which the rubber remembers.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.contact.closed_forms import hunter_at_load, hunter_friction_peak, low_speed_friction

RTOL = 1e-9
MEMORIES = [0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0]
RATIOS = [2.0, 10.0, 100.0]


def rolled(ratio, memory, *, hertz_width, radius, rtol=RTOL):
    """Solve at load Hertz' a0/R = hertz_width and memory Vτ/a0 on rolls of R/λ = radius."""
    zeta = memory * hertz_width * 2.0 * math.pi * radius
    creep = CreepSpectrum(1.0 / ratio, [1.0 - 1.0 / ratio], [zeta])
    return solve(ContactProblem("half-space", radius, 0.25 * hertz_width**2, creep), rtol=rtol)


def allowed(found):
    """Return the difference between the two problems, relative; see the docstring of this file."""
    rho = found.problem.rho
    reach = 2.0 * found.half_width * rho + float(found.problem.creep.times[0])
    edge = found.half_width + abs(found.eccentricity)
    return 1.5 * edge**2 + reach**2 / 12.0 + 10.0 * RTOL


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("memory", MEMORIES)
@pytest.mark.parametrize("hertz_width", [1e-2, 1e-4])
def test_figures(ratio, memory, hertz_width):
    closed = hunter_at_load(ratio, memory=memory)
    found = rolled(ratio, memory, hertz_width=hertz_width, radius=1e-2)
    rel = allowed(found)
    # rtol is that of friction; lengths converge more slowly: 2.6e-7 seen with a sharp edge layer (n = 100)
    place = rel + 1e3 * RTOL
    assert found.friction / hertz_width == pytest.approx(closed.friction_at_load, rel=rel)
    assert found.half_width / hertz_width == pytest.approx(closed.shrinkage, rel=place)
    assert found.eccentricity / found.half_width == pytest.approx(closed.eccentricity, rel=place)


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("memory", [0.1, 1.0, 10.0])
def test_pressure(ratio, memory):
    closed = hunter_at_load(ratio, memory=memory)
    width = 1e-4
    found = rolled(ratio, memory, hertz_width=width, radius=1e-3, rtol=1e-2 * RTOL)
    s = np.linspace(-0.99, 0.99, 41)
    x = found.eccentricity + s * found.half_width
    # Hertz' p0 at half width a is p̃ = a/(R ρ)
    expected = closed.pressure(s) * found.half_width / found.problem.rho
    # friction is quadratic in the pressure's error: within sqrt(RTOL) of the largest where friction is 100 times finer
    np.testing.assert_allclose(found.pressure(x), expected, rtol=0, atol=math.sqrt(RTOL) * expected.max())


@pytest.mark.parametrize("memory", [10.0, 100.0])
def test_neighbours_act_by_the_square_of_their_distance(memory):
    # halving R/λ at a fixed contact doubles the distance of the neighbours in units of the contact
    closed = hunter_at_load(2.0, memory=memory)
    width = 1e-4
    far = [
        rolled(2.0, memory, hertz_width=width, radius=radius).friction / width / closed.friction_at_load - 1.0
        for radius in (0.4, 0.2)
    ]
    # the leading term in ζ² and a next one in ζ³ (0.25 and 0.025 wide) remain: a few per cent
    assert far[0] / far[1] == pytest.approx(4.0, rel=0.05)


def test_circle_differs_from_the_parabola_by_the_square_of_the_width():
    closed = hunter_at_load(10.0, memory=1.0)
    off = [
        rolled(10.0, 1.0, hertz_width=width, radius=1e-4).friction / width / closed.friction_at_load - 1.0
        for width in (2e-2, 1e-2)
    ]
    assert off[0] / off[1] == pytest.approx(4.0, rel=1e-3)


def test_peak_of_friction_at_fixed_load():
    peak = hunter_friction_peak(10.0)
    at, width = peak.memory_at_load, 1e-4
    beside = [rolled(10.0, at * f, hertz_width=width, radius=1e-3).friction / width for f in (0.9, 1.0, 1.1)]
    assert beside[1] == pytest.approx(0.483021, abs=5e-7)
    assert beside[1] > max(beside[0], beside[2])


@pytest.mark.parametrize("ratio", RATIOS)
def test_slow_rolling(ratio):
    # μ → (Vτ/R)(1 - E0/E∞) whatever the load; the next term is of the order of Vτ/a0 = 1e-3
    width, memory = 1e-3, 1e-3
    found = rolled(ratio, memory, hertz_width=width, radius=1e-2, rtol=1e-4)
    slow = low_speed_friction(memory=memory * width, radius=1.0, modulus_ratio=ratio)
    assert found.friction == pytest.approx(slow, rel=2.0 * memory)
    wider = rolled(ratio, memory / 2.0, hertz_width=2.0 * width, radius=1e-2, rtol=1e-4)
    assert wider.friction == pytest.approx(found.friction, rel=2.0 * memory)


@pytest.mark.parametrize(
    ("ratio", "memory", "rtol"),
    [(100.0, 0.03, 1e-3), (100.0, 0.01, 1e-4), (100.0, 1e-3, 1e-6), (1000.0, 0.01, 1e-6)],
)
def test_a_contact_on_a_half_space_never_splits(ratio, memory, rtol):
    # Hunter's pressure is positive: the layer at the exit is as thin as Vτ E0/E∞
    found = solve(
        ContactProblem(
            "half-space",
            1e-3,
            0.25e-8,
            CreepSpectrum(1.0 / ratio, [1.0 - 1.0 / ratio], [memory * 1e-4 * 2.0 * math.pi * 1e-3]),
        ),
        rtol=rtol,
        throw=False,
    )
    assert len(found.patches) == 1
