"""Relaxation fits against truth and against the published Prony set of the published curve."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError, NoSolutionError
from conveyor.rubber.prony import PronySeries
from conveyor.rubber.relaxation_fit import fit_relaxation, relaxation_misfit

DATA = Path(__file__).parent / "data"
E0 = 1739.03e6
"""Head of the published set [Pa]."""


def published() -> tuple[np.ndarray, np.ndarray, PronySeries]:
    curve = np.loadtxt(DATA / "pyvisco_time_user_master.csv", delimiter=",", skiprows=2, encoding="utf-8-sig")
    share, times = np.loadtxt(DATA / "pyvisco_time_prony_reference.csv", delimiter=",", skiprows=2).T
    return curve[:, 0], curve[:, 1] * 1e6, PronySeries(E0 * (1.0 - share.sum()), E0 * share, times)


def test_truth_on_its_own_times() -> None:
    truth = PronySeries(2e6, [1e6, 3e6, 5e6], [1.0, 10.0, 100.0])
    t = np.logspace(0, 3, 40)
    fit = fit_relaxation(t, truth.relaxation(t), terms_per_decade=1.0)
    np.testing.assert_allclose(fit.series.times, truth.times, rtol=1e-12)
    np.testing.assert_allclose(fit.series.moduli, truth.moduli, rtol=1e-8)
    assert fit.series.equilibrium == pytest.approx(2e6, rel=1e-8)
    assert fit.window == (1.0, 1e3)
    assert (fit.active_terms, fit.grid_terms) == (3, 4)


def test_smooth_spectrum_with_noise() -> None:
    tau = np.logspace(-4, 8, 61)
    truth = PronySeries(2e6, np.full(61, 2e5), tau)
    t = np.logspace(-2, 5, 120)
    noise = 1.0 + 0.01 * np.random.default_rng(0).standard_normal(t.size)
    fit = fit_relaxation(t, truth.relaxation(t) * noise)
    assert fit.misfit.rms == pytest.approx(
        0.01, rel=0.25
    )  # 1/sqrt(2*120) = 6 %, less parameters; three of it
    assert fit.floor <= fit.misfit.rms
    # the curve itself is nearer than a datum: 1 % over 120 rows for some 10 parameters
    assert relaxation_misfit(fit.series, t, truth.relaxation(t)).rms < 0.01 * np.sqrt(20 / 120)


def test_invariances() -> None:
    t, e, _ = published()
    plain = fit_relaxation(t, e, terms_per_decade=1.0)
    other = fit_relaxation(t[::-1] * 60.0, e[::-1] * 1e-6, terms_per_decade=1.0)
    np.testing.assert_allclose(other.series.times, 60.0 * plain.series.times, rtol=1e-9)
    assert other.misfit.rms == pytest.approx(plain.misfit.rms, rel=1e-6)


def test_published_prony_set() -> None:
    t, e, theirs = published()
    there = relaxation_misfit(theirs, t, e)
    # what is printed: 7 digits of 30 moduli; E(t) to 1e-6
    assert there.rms == pytest.approx(0.002541, abs=2e-6)
    assert there.worst == pytest.approx(-0.02166, abs=2e-5)
    assert there.worst_time == pytest.approx(3.34e19)
    assert theirs.equilibrium == pytest.approx(80.727e6, rel=1e-4)
    same = fit_relaxation(t, e, times=theirs.times)
    # on the same times the least-squares answer cannot be farther; theirs minimised absolute errors
    assert same.misfit.rms <= there.rms
    mine = fit_relaxation(t, e)
    assert mine.misfit.rms < 0.5 * there.rms
    assert mine.floor < mine.misfit.rms < 1.5 * mine.floor
    assert abs(mine.misfit.worst) < 0.5 * abs(there.worst)
    # both curves over the window: no farther apart than the sum of their misfits
    apart = mine.series.relaxation(t) / theirs.relaxation(t) - 1.0
    assert np.sqrt(np.mean(apart**2)) < mine.misfit.rms + there.rms
    assert mine.series.equilibrium == pytest.approx(theirs.equilibrium, rel=0.03)


def test_held_equilibrium() -> None:
    t, e, _ = published()
    assert fit_relaxation(t, e, equilibrium=70e6).series.equilibrium == pytest.approx(70e6, rel=1e-12)
    with pytest.raises(InputError, match=r"equilibrium = 9e\+07 Pa must be below the smallest modulus"):
        fit_relaxation(t, e, equilibrium=90e6)


def test_refusals() -> None:
    t = np.logspace(0, 3, 31)
    with pytest.raises(NoSolutionError, match="still falls at the last time"):
        fit_relaxation(t, 1e6 * np.exp(-t / 100.0))
    with pytest.raises(NoSolutionError, match="does not fall with time"):
        fit_relaxation(t, 1e6 * t**0.1)
    with pytest.raises(InputError, match=r"modulus\[1\] = 0 Pa must be > 0"):
        fit_relaxation([1.0, 2.0], [1e6, 0.0])
    with pytest.raises(InputError, match="one modulus per time"):
        fit_relaxation([1.0, 2.0], [1e6])
    with pytest.raises(InputError, match=r"terms_per_decade = -1 1/decade"):
        fit_relaxation(t, 1e6 + 1e6 / t, terms_per_decade=-1.0)
    with pytest.raises(InputError, match="not both"):
        fit_relaxation(t, 1e6 + 1e6 / t, terms_per_decade=1.0, times=[1.0])
    with pytest.raises(
        InputError, match=r"relaxation time 0\.1 s is outside the measured window 1 to 1000 s"
    ):
        fit_relaxation(t, 1e6 + 1e6 / t, times=[0.1, 10.0])
    with pytest.raises(InputError, match="one length"):
        relaxation_misfit(PronySeries(1e6, [1e6], [1.0]), t, [1e6])
