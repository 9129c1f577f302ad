"""Measured files, bytes as published: every trap they hold is read or asked about."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laboratory import read_dma

REAL = Path(__file__).parent / "files" / "real"
ROOT = Path(__file__).parents[2]


def test_korean_master_curve() -> None:
    data = read_dma(REAL / "S100_master.txt")
    plain = np.loadtxt(REAL / "S100_master.txt", encoding="latin-1")
    assert data.kind == "master curve"
    assert plain.shape == (84, 3)
    # Hz and Pa: not one digit may change
    assert data.frequency is not None
    assert data.storage is not None
    assert data.loss is not None
    np.testing.assert_array_equal(np.stack([data.frequency, data.storage, data.loss], axis=1), plain)
    assert data.metadata == {"원본": "S100-2.13 F.txt"}
    assert "encoding: euc_kr (not UTF-8; Korean)" in data.understood


def test_korean_shift_factors() -> None:
    data = read_dma(REAL / "S100_aT.txt")
    plain = np.loadtxt(REAL / "S100_aT.txt", encoding="latin-1")
    assert data.kind == "shift factors"
    np.testing.assert_allclose(data.temperature, plain[:, 0] + 273.15, rtol=1e-15)
    np.testing.assert_allclose(data.log10_a_T, np.log10(plain[:, 1]), rtol=1e-15)


@pytest.mark.parametrize("name", ["S100", "S120"])
def test_strain_sweep_asks_for_both_units(name: str) -> None:
    file = REAL / f"{name}_strain_sweep.txt"
    with pytest.raises(InputError, match=rf"^{name}_strain_sweep\.txt:2: column 3 \"Strain\": strain has no unit") as e:
        read_dma(file)
    assert 'column 4 "E\'(Pa)": storage = 1' in str(e.value)
    assert 'modulus_unit="MPa" (--modulus-unit MPa)' in str(e.value)
    with pytest.raises(InputError, match=r":3: column 4 .* in Pa, but a solid has 10000 to 1e\+11 Pa"):
        read_dma(file, strain_unit="%")


def test_strain_sweep_with_units_given() -> None:
    data = read_dma(REAL / "S100_strain_sweep.txt", modulus_unit="MPa", strain_unit="%")
    assert data.kind == "strain sweep"
    assert 'column 4 "E\'(Pa)": storage, in MPa as given, overriding Pa of the file, times 1e+06' in data.understood
    sweeps = data.strain_sweeps()
    assert [sweep.strain.size for sweep in sweeps] == [29, 29, 29, 28]
    cold = sweeps[0]
    assert (cold.temperature, cold.frequency, cold.run) == (pytest.approx(273.17), 1.0, None)
    # first row of the file: 0.00998199 %, 12.3965 and 1.76989 MPa
    assert cold.strain[0] == pytest.approx(9.98199e-5, rel=1e-14)
    assert (cold.storage[0], cold.loss[0]) == pytest.approx((12.3965e6, 1.76989e6), rel=1e-14)


def test_two_runs_sorted_into_each_other() -> None:
    data = read_dma(REAL / "S120_strain_sweep.txt", modulus_unit="MPa", strain_unit="%")
    first, second, *_ = data.strain_sweeps()
    assert (first.run, first.strain.size) == (0, 29)
    assert (second.run, second.row_numbers.tolist()) == (1, [4])
    assert first.storage[1] > 16.9e6
    assert second.storage[0] == pytest.approx(12.8436e6, rel=1e-14)
    assert any("duplicate runs: 1 row(s)" in sentence and "first row 4" in sentence for sentence in data.understood)


def test_pyvisco_isotherms() -> None:
    data = read_dma(REAL / "pyvisco_freq_user_raw.csv")
    plain = np.genfromtxt(REAL / "pyvisco_freq_user_raw.csv", delimiter=",", skip_header=2, encoding="utf-8-sig")
    isotherms = data.isotherms()
    assert data.kind == "isotherms"
    assert [isotherm.run for isotherm in isotherms] == list(range(21))
    for label, isotherm in enumerate(isotherms):
        rows = plain[plain[:, 4] == label]
        assert isotherm.temperature == pytest.approx(rows[:, 3].mean() + 273.15, rel=1e-14)
        assert isotherm.temperature_spread == pytest.approx(np.ptp(rows[:, 3]), abs=1e-12)
        np.testing.assert_allclose(isotherm.storage, rows[:, 1] * 1e6, rtol=1e-15)
        np.testing.assert_allclose(isotherm.loss, rows[:, 2] * 1e6, rtol=1e-15)
        assert isotherm.frequency.tolist() == rows[:, 0].tolist()


def test_isotherms_without_their_set_column(tmp_path: Path) -> None:
    lines = (REAL / "pyvisco_freq_user_raw.csv").read_text(encoding="utf-8-sig").splitlines()
    file = tmp_path / "raw.csv"
    # shuffled by a step prime to the number of rows
    rows = [lines[2 + (k * 37) % 210].rsplit(",", 1)[0] for k in range(210)]
    file.write_text("\n".join([*(line.rsplit(",", 1)[0] for line in lines[:2]), *rows]), encoding="utf-8")
    plain, labelled = read_dma(file).isotherms(), read_dma(REAL / "pyvisco_freq_user_raw.csv").isotherms()
    assert len(plain) == len(labelled) == 21
    for a, b in zip(plain, labelled, strict=True):
        np.testing.assert_array_equal(a.storage, b.storage)
        assert a.temperature == pytest.approx(b.temperature, rel=1e-14)


def test_pyvisco_master_curve_relaxation_and_shift() -> None:
    master = read_dma(REAL / "pyvisco_freq_user_master.csv")
    assert master.kind == "master curve"
    assert master.frequency is not None
    assert master.run is not None
    # shifts printed with two decimals bring two isotherms onto one frequency once: 1584.893192461108 and ...1134
    assert master.row_numbers[master.run > 0].tolist() == [166]
    assert (master.frequency.size, master.frequency[0]) == (206, 1e-12)
    relaxation = read_dma(REAL / "pyvisco_time_user_master.csv")
    assert relaxation.kind == "relaxation"
    assert relaxation.modulus is not None
    assert (relaxation.modulus.size, relaxation.modulus[0]) == (481, 1714.266e6)
    shift = read_dma(REAL / "pyvisco_freq_user_master_shift_factors.csv")
    assert shift.kind == "shift factors"
    assert shift.log10_a_T is not None
    assert (shift.log10_a_T[0], shift.log10_a_T[-1]) == (12.75, -11.7)


def test_prony_terms_are_no_measurement() -> None:
    with pytest.raises(InputError, match=r"reference\.csv:2: column 1 \"rel_mod\": .*rename its columns"):
        read_dma(REAL / "pyvisco_time_prony_reference.csv")


@pytest.mark.parametrize("name", ["s100", "s120"])
def test_shelf_files(name: str) -> None:
    curve = read_dma(ROOT / "materials" / f"{name}.dma.csv")
    shift = read_dma(ROOT / "materials" / f"{name}.shift.csv")
    assert (curve.kind, shift.kind) == ("master curve", "shift factors")
    assert curve.metadata["name"] == name.upper()
    assert curve.row_numbers.size == 84
    assert shift.row_numbers.size == 12
