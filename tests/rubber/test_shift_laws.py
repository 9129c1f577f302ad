"""The comparison of shift laws, and fits weighted by the shifts' uncertainty."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError, RangeError
from conveyor.rubber.shift import WLF, Arrhenius, ShiftTable
from conveyor.rubber.shift_fit import fit_arrhenius, fit_wlf
from conveyor.rubber.shift_laws import compare_shift_laws

MATERIALS = Path(__file__).parents[2] / "materials"
REFERENCE = 293.15
T = REFERENCE + 10.0 * np.arange(-5, 7)
LAW = WLF(8.86, 101.6, REFERENCE)


def test_truth_comes_first() -> None:
    rng = np.random.default_rng(0)
    error = 0.01 * np.abs(T - REFERENCE) / 10.0
    for law, name in ((LAW, "WLF"), (Arrhenius(150e3, REFERENCE), "Arrhenius")):
        y = law.log10_a_T(T) + error * rng.standard_normal(T.size)
        found = compare_shift_laws(T, y, REFERENCE, error=error)
        assert found[0].name == name
        assert found[0].chi2_per_freedom is not None
        # 9 or 10 degrees of freedom: chi^2/dof 1 +- 0.45, three of them
        assert 0.1 < found[0].chi2_per_freedom < 2.4
        assert [one.left_out for one in found] == sorted(one.left_out for one in found)


def test_wrong_law_is_far_outside_its_errors() -> None:
    found = {c.name: c for c in compare_shift_laws(T, LAW.log10_a_T(T), REFERENCE, error=np.full(T.size, 0.01))}
    assert found["WLF"].rms < 1e-6
    assert found["Arrhenius"].chi2_per_freedom is not None
    assert found["Arrhenius"].chi2_per_freedom > 100.0


def test_table_says_that_it_interpolates() -> None:
    table = next(c for c in compare_shift_laws(T, LAW.log10_a_T(T), REFERENCE) if c.name == "table")
    assert isinstance(table.law, ShiftTable)
    assert table.rms < 1e-12
    assert table.chi2_per_freedom is None
    assert "interpolates" in table.remark
    assert (table.low, table.high) == (T[0], T[-1])
    # left out by hand: the third shift from the other eleven
    keep = np.arange(T.size) != 2
    alone = ShiftTable(T[keep], LAW.log10_a_T(T[keep]), REFERENCE).log10_a_T(T[2]) - LAW.log10_a_T(T[2])
    assert 0.0 < abs(alone) < 10 * table.left_out


@pytest.mark.parametrize("name", ["s100", "s120"])
def test_measured_tables_beat_the_laws(name: str) -> None:
    rows = np.array(
        [line.split(",") for line in (MATERIALS / f"{name}.shift.csv").read_text().splitlines() if line[0] not in "#t"],
        dtype=float,
    )
    t, y = rows[:, 0] + 273.15, np.log10(rows[:, 1])
    found = compare_shift_laws(t, y, float(t[y == 0.0][0]))
    assert found[0].name == "table"
    # left out, over 20 K: half of what the laws miss on average
    assert found[0].left_out < 0.08
    assert all(one.left_out > 0.12 for one in found[1:])


def test_weights_are_those_of_least_squares() -> None:
    law = Arrhenius(120e3, REFERENCE)
    y = law.log10_a_T(T)
    y[0] += 0.5
    heavy, light = np.full(T.size, 0.01), np.full(T.size, 0.01)
    light[0] = 1e6
    keep = np.arange(T.size) > 0
    weighted = fit_arrhenius(T, y, REFERENCE, error=light).law.activation_energy
    assert weighted == pytest.approx(120e3, rel=1e-9)
    equal = fit_arrhenius(T, y, REFERENCE).law.activation_energy
    assert fit_arrhenius(T, y, REFERENCE, error=heavy).law.activation_energy == pytest.approx(equal, rel=1e-12)
    y = LAW.log10_a_T(T)
    y[0] += 0.5
    one = fit_wlf(T, y, REFERENCE, error=light).law
    other = fit_wlf(T[keep], y[keep], REFERENCE).law
    assert (one.c1, one.c2) == pytest.approx((other.c1, other.c2), rel=1e-6)


def test_a_law_that_does_not_hold_is_last_and_says_why() -> None:
    y = -0.05 * (T - REFERENCE) - 1e-4 * (T - REFERENCE) ** 2  # bends the other way
    found = compare_shift_laws(T, y, REFERENCE)
    assert found[-1].name == "WLF"
    assert found[-1].law is None
    assert "do not follow a WLF law" in found[-1].remark


def test_reference_between_the_shifts() -> None:
    y = LAW.log10_a_T(T) - LAW.log10_a_T(REFERENCE + 5.0)
    found = {c.name: c for c in compare_shift_laws(T, y, REFERENCE + 5.0)}
    assert found["WLF"].rms < 1e-6
    law = found["table"].law
    assert law is not None
    assert law.reference in T  # a_T = 1 is measured there, not between two rows
    assert np.diff(law.log10_a_T(T)) == pytest.approx(np.diff(y), rel=1e-12)


@pytest.mark.parametrize("beside", [0.0, 0.002, -0.002, 0.4])
def test_a_reference_beside_a_row_changes_no_verdict(beside: float) -> None:
    y = LAW.log10_a_T(T) + 0.05 * np.sin(T)
    error = 0.003 * np.abs(T - REFERENCE) ** 0.5 + 1e-3
    at = {c.name: c for c in compare_shift_laws(T, y, REFERENCE, error=error)}
    # the row 0.002 K from the reference has next to no error of its own; it must not judge the laws alone
    near = compare_shift_laws(T, y, REFERENCE + beside, error=error)
    for one in near:
        assert one.rms == pytest.approx(at[one.name].rms, rel=1e-9)
        assert one.left_out == pytest.approx(at[one.name].left_out, rel=1e-9)


def test_refusals() -> None:
    y = LAW.log10_a_T(T)
    with pytest.raises(InputError, match=">= 5 temperatures"):
        compare_shift_laws(T[:4], y[:4], T[1])
    with pytest.raises(RangeError, match="outside the shifts"):
        compare_shift_laws(T, y, 500.0)
    with pytest.raises(InputError, match=r"one uncertainty per shift, shape \(12,\); got \(3,\)"):
        compare_shift_laws(T, y, REFERENCE, error=[0.1, 0.1, 0.1])
    with pytest.raises(InputError, match="allowed: > 0 decades except at the reference"):
        compare_shift_laws(T, y, REFERENCE, error=np.zeros(T.size))
    with pytest.raises(InputError, match="one standard uncertainty per shift"):
        fit_wlf(T, y, REFERENCE, error=[0.1])
    with pytest.raises(InputError, match="> 0 decades except at the reference"):
        fit_arrhenius(T, y, REFERENCE, error=np.zeros(T.size))
    with pytest.raises(InputError, match="allowed: >= 0 decades and finite"):
        fit_arrhenius(T, y, REFERENCE, error=np.full(T.size, -1.0))
