"""The band of harmonics in which a contact loses its energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, load_curve, solve
from conveyor.contact.fields.energy_balance import pressure_spectrum
from conveyor.contact.solvers.solver_state import SolverState
from conveyor.errors import NoSolutionError

CREEP = CreepSpectrum(0.1, [0.4, 0.5], [0.05, 2.0])
WIDE = ContactProblem("free", 0.4, 0.05, CREEP, 1.0)
SPLIT = ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
NARROW = ContactProblem("confined", 0.066, 0.004, CREEP, 0.02)
SHARES = (0.05, 0.5, 0.95)


def shares_below(problem, m_end):
    """Running sum of the loss by harmonic, from the pressure itself: p̂_m = (1/2π) ∫ p e^{-imX} dX at 2,000 angles."""
    found = solve(problem, rtol=1e-8)
    m = np.arange(1, m_end + 1)
    spectrum = np.zeros(m.size, dtype=complex)
    for low, high in found.patches * problem.rho:
        angle = (np.arange(2000) + 0.5) * np.pi / 2000
        x = 0.5 * (low + high) + 0.5 * (high - low) * np.cos(angle)
        weight = 0.5 * (high - low) * np.sin(angle) * np.pi / 2000
        spectrum += np.exp(-1j * np.outer(m, x)) @ (found.pressure(x / problem.rho) * weight)
    symbol = problem.layer.symbol(m.astype(float), SolverState.of(problem).creep)
    running = np.cumsum(symbol.imag * np.abs(spectrum) ** 2)
    return found, running / running[-1]


@pytest.mark.parametrize("problem", [WIDE, SPLIT, replace(WIDE, support="confined")])
def test_band_is_that_of_the_plain_sum(problem):
    found, running = shares_below(problem, 4000)
    for share, harmonic in zip(SHARES, found.excitation(), strict=True):
        # a harmonic is the most that a sum of steps can say
        at = 1 + int(np.searchsorted(running, share))
        assert at - 1.0 <= harmonic <= at + 1.0


def test_narrow_band_is_that_of_the_plain_sum():
    found, running = shares_below(NARROW, 40_000)
    exact = [1 + int(np.searchsorted(running, share)) for share in SHARES]
    # a harmonic of 30 is three per cent
    np.testing.assert_allclose(found.excitation(), exact, rtol=0.03)


def test_band_moves_with_the_speed_and_narrows_with_one_sharp_time():
    slow, fast = (solve(replace(NARROW, creep=CreepSpectrum(0.9, [0.1], [zeta]))).excitation() for zeta in (1e-2, 1e-4))
    # the loss sits where mζ is one, or where the contact's width ends, whichever is lower
    assert slow[1] < fast[1]
    assert slow[1] < 1.0 / 1e-2 * 3.0
    alpha = solve(NARROW).half_width * NARROW.rho
    assert fast[2] < 100.0 / alpha


def test_curve_gives_the_band_of_its_widest_and_narrowest_contact():
    curve = load_curve(NARROW, 0.001, 0.004)
    for loaded, band in ((0.004, curve.excitation_widest), (0.001, curve.excitation_narrowest)):
        # the sampled ends lie a hundredth in half width beyond the loads
        np.testing.assert_allclose(band, solve(replace(NARROW, pressure=loaded)).excitation(), rtol=0.03)


@pytest.mark.parametrize("problem", [replace(NARROW, creep=CreepSpectrum(1.0))])
def test_elastic_layers_have_no_band(problem):
    with pytest.raises(NoSolutionError, match="no loss"):
        solve(problem).excitation()
    assert load_curve(problem, 0.001, 0.004).excitation_widest.size == 0


def test_the_spectrum_of_strips_is_the_transform_of_their_pressure():
    """(1/2π) ∫ p̃ e^(-imX) dX over X = X_l + α_l cos θ, by the trapezoidal rule: exact to rounding on these series."""
    strips = [(-0.4, 0.2, np.array([1.0, 0.3, -0.2])), (0.7, 0.1, np.array([0.5, -0.4]))]
    m, theta = np.array([1.0, 2.0, 7.0, 40.0]), np.linspace(0.0, np.pi, 401)
    direct = np.zeros(m.size, dtype=complex)
    for centre, alpha, c in strips:
        pressure = c @ np.sin(np.arange(1, c.size + 1)[:, None] * theta)
        wave = np.exp(-1j * m[:, None] * (centre + alpha * np.cos(theta)))
        direct += np.trapezoid(wave * pressure * alpha * np.sin(theta), theta, axis=1) / (2.0 * np.pi)
    assert pressure_spectrum(m, strips) == pytest.approx(direct, rel=1e-12, abs=1e-15)
