"""The Kramers-Kronig test: silent for one spectrum, and loud where E' and E'' contradict each other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.rubber.kramers_kronig import kramers_kronig
from conveyor.rubber.prony import PronySeries

MATERIALS = Path(__file__).parents[2] / "materials"
TIMES = np.logspace(-14, 8, 67)
SMOOTH = PronySeries(4e6, 60e6 * np.exp(-0.5 * ((np.log10(TIMES) + 9) / 2.0) ** 2) + 2e5, TIMES)
F = np.logspace(-3, 9, 84)
OMEGA = 2 * np.pi * F
STORAGE, LOSS = SMOOTH.storage(OMEGA), SMOOTH.loss(OMEGA)


def test_exact_spectrum_agrees() -> None:
    test = kramers_kronig(F, STORAGE, LOSS)
    # a decade inside the window the spectrum beyond, 7 % of E'', is continued smoothly to about 1 % of itself
    assert test.loss.rms < 1e-3
    assert test.storage.rms < 1e-4
    assert max(test.storage_fit, test.loss_fit) < 1e-4
    assert test.judged == pytest.approx((1e-2, 1e8))
    assert 0.0 < test.outside < 0.15


def test_scaled_loss_is_found_with_its_factor() -> None:
    test = kramers_kronig(F, STORAGE, 1.1 * LOSS)
    # E' alone knows the true E'': predicted over measured is 1/1.1 everywhere
    assert test.loss.rms == pytest.approx(1.0 - 1.0 / 1.1, abs=1e-3)
    np.testing.assert_allclose([d.loss for d in test.decades], 1.0 / 1.1 - 1.0, atol=2e-3)
    assert test.storage.rms > 0.03


def test_decades_are_counted_from_the_lowest_frequency() -> None:
    # a decade from either end 10^0.15 to 10^2.85 Hz are left, in steps of 0.3 decades
    f = 10.0 ** (0.3 * np.arange(18) - 1.05)
    test = kramers_kronig(f, SMOOTH.storage(2 * np.pi * f), SMOOTH.loss(2 * np.pi * f))
    found = [(np.log10(d.low), np.log10(d.high), d.rows) for d in test.decades]
    assert found == [pytest.approx(one) for one in [(0.15, 1.05, 4), (1.35, 1.95, 3), (2.25, 2.85, 3)]]


def test_noise_is_not_a_contradiction() -> None:
    clean, wrong = [], []
    for seed in range(5):
        n = np.exp(0.01 * np.random.default_rng(seed).standard_normal((2, F.size)))
        clean.append(kramers_kronig(F, STORAGE * n[0], LOSS * n[1]))
        wrong.append(kramers_kronig(F, STORAGE * n[0], 1.1 * LOSS * n[1]))
    # E'' from the slope of E': 1 % over a decade of 7 rows against tan delta of 0.1 is some 4 %
    assert max(t.loss.rms for t in clean) < 0.04
    assert min(t.loss.rms for t in wrong) > 0.08
    assert max(t.storage.rms for t in clean) < 0.02
    assert min(t.storage.rms for t in wrong) > 0.04


def test_it_says_where() -> None:
    wrong = np.where((F > 1e2) & (F < 1e4), 1.3, 1.0)
    test = kramers_kronig(F, STORAGE, LOSS * wrong)
    inside = [d for d in test.decades if d.low > 1e2 and d.high < 1e4]
    outside = [d for d in test.decades if d.high < 1e2 or d.low > 1e4]
    np.testing.assert_allclose([d.loss for d in inside], 1 / 1.3 - 1, atol=5e-3)
    np.testing.assert_allclose([d.loss for d in outside], 0.0, atol=5e-3)
    assert 1e2 < test.loss.worst_frequency < 1e4


def test_measured_compounds() -> None:
    found = {}
    for name in ("s100", "s120"):
        lines = (MATERIALS / f"{name}.dma.csv").read_text(encoding="utf-8").splitlines()
        rows = np.array([line.split(",") for line in lines if line[0] not in "#f"], dtype=float)
        found[name] = kramers_kronig(*rows.T)
    # the shelf's consistency floors, 18.6 and 6.7 %, are compromises of both moduli; one from the other is worse
    assert found["s100"].loss.rms == pytest.approx(0.326, abs=0.01)
    assert found["s120"].loss.rms == pytest.approx(0.202, abs=0.01)
    assert found["s100"].storage.rms == pytest.approx(0.071, abs=0.005)
    assert found["s120"].storage.rms == pytest.approx(0.103, abs=0.005)
    # S100: its E'' is no positive spectrum by itself (scatter); S120: each is, and they contradict
    assert found["s100"].loss_fit > 0.25
    assert found["s120"].loss_fit < 0.04
    assert found["s100"].loss.worst_frequency == pytest.approx(1.028)  # the outlier that the fit names too
    # but for the decade of S120 in which E' jumps by 27 % between two rows 2 % apart in frequency
    assert all(d.loss < 0.05 for test in found.values() for d in test.decades)


def test_refusals() -> None:
    with pytest.raises(InputError, match="rows farther than 1 decade from its ends; the test needs >= 6"):
        kramers_kronig([1.0, 10.0, 50.0], [1e6, 2e6, 3e6], [1e5, 1e5, 1e5])
    with pytest.raises(InputError, match=r"row 1 \(frequency 1 Hz\): loss: got -1 Pa"):
        kramers_kronig([1.0, 10.0], [1e6, 2e6], [-1.0, 1e5])
