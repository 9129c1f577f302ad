"""Isotherms whose E' and E'' ask for different shifts: the spread is in the error, and the cause is named."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.rubber import WLF, PronySeries, superpose
from conveyor.rubber.master_curve import Isotherm

FREQUENCY = np.geomspace(1.0, 50.0, 10)
TEMPERATURES = 273.15 + np.arange(-10.0, 47.0, 7.0)
LAW = WLF(6.0, 150.0, 293.15)
SERIES = PronySeries(5e6, np.geomspace(4e5, 4e6, 13), np.geomspace(1.0, 1e-8, 13))
TRUE_SHIFT = np.array([LAW.log10_a_T(t) for t in TEMPERATURES.tolist()])


def isotherms(*, phase: float = 0.0, clamps: float = 0.0, noise: float = 0.002, seed: int = 1) -> list[Isotherm]:
    """Sweeps of a known rubber: E'' grows by `phase` a decade, both moduli by `clamps` per 10 K of cold."""
    random = np.random.default_rng(seed)
    made = []
    for t, shift in zip(TEMPERATURES.tolist(), TRUE_SHIFT.tolist(), strict=True):
        omega = 2.0 * np.pi * FREQUENCY * 10.0**shift
        stiff = (1.0 + clamps) ** ((293.15 - t) / 10.0)
        scatter = random.normal(1.0, [[noise], [5.0 * noise]], (2, FREQUENCY.size))
        loss = SERIES.loss(omega) * (1.0 + phase) ** np.log10(FREQUENCY)
        made.append(Isotherm(t, FREQUENCY, stiff * SERIES.storage(omega) * scatter[0], stiff * loss * scatter[1]))
    return made


@pytest.mark.parametrize("seed", range(4))
def test_a_clean_rubber_has_no_contradiction(seed):
    """Its variants agree within chance, and its errors are those of scatter and overlap alone."""
    made = superpose(isotherms(seed=seed), 293.15)
    assert [one.name for one in made.variants if one.differs] == []
    assert abs(made.phase_slope.per_decade) < 4.0 * made.phase_slope.error
    assert np.max(made.log10_a_T_error) < 0.05


@pytest.mark.parametrize("phase", [0.05, 0.15])
def test_a_phase_error_is_named_with_its_slope(phase):
    """E' alone has the true shifts; both moduli have others, and their error holds the difference."""
    made = superpose(isotherms(phase=phase), 293.15)
    slope = made.phase_slope
    assert slope.per_decade == pytest.approx(np.log1p(phase), abs=4.0 * slope.error + 0.1 * phase)
    (storage,) = (one for one in made.variants if (one.by, one.vertical) == ("storage", False))
    assert any(one.differs for one in made.variants)
    assert storage.log10_a_T == pytest.approx(TRUE_SHIFT, abs=0.03)
    assert np.all(np.abs(made.log10_a_T - TRUE_SHIFT) <= 1.645 * made.log10_a_T_error + 0.01)


@pytest.mark.parametrize("clamps", [0.04, 0.08])
def test_clamps_that_stiffen_the_cold_are_in_the_error(clamps):
    made = superpose(isotherms(clamps=clamps), 293.15)
    assert any(one.differs for one in made.variants)
    assert np.all(np.abs(made.log10_a_T - TRUE_SHIFT) <= 1.645 * made.log10_a_T_error + 0.01)


def test_variants_are_the_other_moduli_and_vertical_shifts():
    made = superpose(isotherms(), 293.15, by="storage")
    placements = [(one.by, one.vertical) for one in made.variants]
    assert placements == [("both", False), ("loss", False), ("both", True)]
