"""One curve in every layout reads as the same numbers; the other kinds by hand-computed values."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laboratory import KINDS, read_dma

GOOD = Path(__file__).parent / "files" / "good"
FREQUENCY = [1.0, 10.0, 100.0]
STORAGE = [5.6e6, 6.8e6, 8.6e6]
LOSS = [0.56e6, 0.748e6, 1.075e6]
# conversions multiply a few factors, each rounded to 1.1e-16; files print every digit
ROUNDING = 1e-14

# file, a sentence that `understood` must hold
CURVES = [
    ("own_layout.csv", "row 4 is the header"),
    ("semicolon_decimal_comma.csv", "decimal comma"),
    ("tab_decimal_comma.tsv", "separator: tab"),
    ("quoted_decimal_comma.csv", "decimal comma"),
    ("blanks.txt", "separator: blanks"),
    ("blanks_decimal_comma.txt", "decimal comma"),
    ("comment_header_tab.txt", "row 2 is the header"),
    ("comment_unit_row.txt", "row 2 holds the units"),
    ("unit_row_bom.csv", "encoding: UTF-8 with byte-order mark"),
    ("utf16_excel_unicode_text.txt", "encoding: UTF-16 by its byte-order mark"),
    ("cp1252_german.csv", "encoding: cp1252 (not UTF-8)"),
    ("euckr_korean.txt", "encoding: euc_kr (not UTF-8; Korean)"),
    ("instrument_preamble.txt", 'column 5 "Static force" is not used: its name is not a quantity read here'),
    ("rad_per_second.csv", 'column 1 "omega [rad/s]": frequency, in rad/s by the header, times 0.159155'),
    (
        "hertz_and_rad_per_second.csv",
        'column 2 "omega [rad/s]": frequency, in rad/s by the header, times 0.159155',
    ),
    ("psi.csv", 'column 2 "E\' [psi]": storage, in psi by the header, times 6894.76'),
    ("ksi_and_kpa.csv", "column 3 \"E'' [kPa]\": loss, in kPa by the header, times 1000"),
    ("dyn_per_cm2.csv", 'column 2 "E\' [dyn/cm^2]": storage, in dyn/cm^2 by the header, times 0.1'),
    ("shear_third.csv", "shear moduli: E = 2 (1 + nu) G = 3 G with nu = 0.5"),
    ("tan_delta.csv", "E'' = E' tan delta from each row"),
    ("tan_delta_beside.csv", "column 4 \"tan d\" agrees with E''/E' and is not needed"),
    ("complex_and_phase.csv", "E' and E'' from |E*| and tan(phase) of each row"),
    ("complex_and_tan_delta.csv", "E' and E'' from |E*| and tan delta of each row"),
    ("logarithms.csv", 'column 1 "log10 f (Hz)": frequency, in Hz by the header, log10 undone'),
    ("unsorted.csv", "rows sorted; the file is not in order from row 3 on"),
    ("descending.csv", "rows sorted; the file is not in order from row 3 on"),
    ("excel_separator_line.csv", "separator: semicolon"),
    ("one_table.xlsx", "no table on 'Cover'"),
]


@pytest.mark.parametrize(("name", "sentence"), CURVES, ids=[case[0] for case in CURVES])
def test_one_curve_in_every_layout(name: str, sentence: str) -> None:
    data = read_dma(GOOD / name)
    assert data.kind == "master curve"
    # hertz beside rad/s: the hertz column is taken, so all agree to rounding; logarithms lose ln(1e7)*eps
    np.testing.assert_allclose(data.frequency, FREQUENCY, rtol=ROUNDING)
    np.testing.assert_allclose(data.storage, STORAGE, rtol=ROUNDING)
    np.testing.assert_allclose(data.loss, LOSS, rtol=ROUNDING)
    assert sentence in data.understood
    assert data.source.startswith(str(GOOD / name))
    assert data.run is None


def test_rows_of_the_file_are_kept() -> None:
    assert read_dma(GOOD / "own_layout.csv").row_numbers.tolist() == [5, 6, 8]
    assert read_dma(GOOD / "unsorted.csv").row_numbers.tolist() == [3, 4, 2]
    # an empty row, a title row, a header and a unit row stand before the data
    assert read_dma(GOOD / "one_table.xlsx").row_numbers.tolist() == [5, 6, 7]


def test_metadata() -> None:
    assert read_dma(GOOD / "own_layout.csv").metadata == {"name": "pad", "source": "a: b"}
    assert read_dma(GOOD / "instrument_preamble.txt").metadata["Sample"] == "pad 12"


def test_arrays_are_read_only() -> None:
    data = read_dma(GOOD / "isotherms_set.csv")
    for values in (data.frequency, data.temperature, data.storage, data.loss, data.run, data.row_numbers):
        assert values is not None
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.5])
def test_shear_by_poisson_ratio(poisson_ratio: float) -> None:
    # the file holds E/3; E = 2 (1 + nu) G is 3 G only at 0.5
    data = read_dma(GOOD / "shear_third.csv", poisson_ratio=poisson_ratio)
    expected = np.array(STORAGE) * 2.0 * (1.0 + poisson_ratio) / 3.0
    np.testing.assert_allclose(data.storage, expected, rtol=ROUNDING)


def test_unit_given_overrides_the_file_and_says_so() -> None:
    data = read_dma(GOOD / "rad_per_second.csv", frequency_unit="Hz", strain_unit="%")
    np.testing.assert_allclose(data.frequency, np.array(FREQUENCY) * 2.0 * math.pi, rtol=ROUNDING)
    assert 'column 1 "omega [rad/s]": frequency, in Hz as given, overriding rad/s of the file' in data.understood
    assert "strain_unit % was given, but the file has no such column" in data.understood


def test_temperature_given() -> None:
    data = read_dma(GOOD / "own_layout.csv", temperature=293.15)
    (isotherm,) = data.isotherms()
    assert isotherm.temperature == pytest.approx(293.15, rel=1e-15)
    assert isotherm.temperature_spread == 0.0
    with pytest.raises(
        InputError, match=r"isotherms need temperature; add the column, or give temperature \(--temperature\)"
    ):
        read_dma(GOOD / "own_layout.csv").isotherms()


def test_sheet_by_name() -> None:
    half = read_dma(GOOD / "two_tables.xlsx", sheet="40C")
    np.testing.assert_allclose(half.storage, np.array(STORAGE) / 2.0, rtol=ROUNDING)
    assert half.source.endswith("two_tables.xlsx[40C]")


ISOTHERM_FILES = [
    "isotherms_set.csv",
    "isotherms_by_frequency.txt",
    "isotherms_duplicate_run.csv",
    "isotherms_blocks.txt",
]


@pytest.mark.parametrize("name", ISOTHERM_FILES)
def test_isotherms(name: str) -> None:
    data = read_dma(GOOD / name)
    assert data.kind == "isotherms"
    cold, warm, *again = data.isotherms()
    # by construction within 0.2 degF of 0 and 20 degC
    assert cold.temperature == pytest.approx(273.15, abs=0.12)
    assert warm.temperature == pytest.approx(293.15, abs=0.12)
    assert cold.storage.tolist() == [9.0e6, 11.5e6, 15.5e6]
    assert warm.storage.tolist() == STORAGE
    np.testing.assert_allclose(warm.loss, LOSS, rtol=ROUNDING)
    assert all(np.all(np.diff(isotherm.frequency) > 0) for isotherm in data.isotherms())
    assert len(again) == (1 if "duplicate" in name else 0)


def test_duplicate_run_is_kept_apart() -> None:
    data = read_dma(GOOD / "isotherms_duplicate_run.csv")
    _, up, down = data.isotherms()
    assert (up.run, down.run) == (0, 1)
    assert down.storage.tolist() == [5.7e6, 6.9e6, 8.7e6]
    assert down.row_numbers.tolist() == [10, 9, 8]
    assert (
        "duplicate runs: 3 row(s) repeat a set point of their sweep, first row 8; up to 2 runs are kept apart"
        in data.understood
    )


def test_temperature_sweeps() -> None:
    data = read_dma(GOOD / "temperature_sweep.csv")
    assert data.kind == "temperature sweep"
    np.testing.assert_allclose(data.temperature, [243.15, 263.15, 283.15, 303.15, 323.15], rtol=ROUNDING)
    np.testing.assert_allclose(data.loss, np.array([90.5, 20.1, 9.0, 6.5, 5.5]) * [8e5, 4e5, 2e5, 1.2e5, 0.9e5])
    ramp = read_dma(GOOD / "temperature_ramp.csv")
    assert ramp.kind == "temperature sweep"
    assert ramp.temperature is not None
    assert ramp.temperature.size == 41


def test_ramp_forms_no_isotherms() -> None:
    with pytest.raises(InputError, match=r'a temperature sweep, not isotherms; give kind="isotherms" \(--kind\)'):
        read_dma(GOOD / "temperature_ramp.csv").isotherms()
    ramp = read_dma(GOOD / "temperature_ramp.csv", kind="isotherms")
    with pytest.raises(InputError, match=r"temperature_ramp\.csv:2: the temperature is a ramp"):
        ramp.isotherms()


def test_strain_sweep_of_double_amplitudes_in_shear() -> None:
    data = read_dma(GOOD / "strain_sweep_shear.csv")
    assert data.kind == "strain sweep"
    (sweep,) = data.strain_sweeps()
    # DSA % is twice the amplitude in percent; E = 3 G
    np.testing.assert_allclose(sweep.strain, np.array([0.0005, 0.005, 0.05, 0.1]) / np.sqrt(3.0), rtol=ROUNDING)
    np.testing.assert_allclose(sweep.storage, [9e6, 7.2e6, 4.5e6, 3.6e6], rtol=ROUNDING)
    assert sweep.frequency == pytest.approx(10.0)
    assert sweep.temperature == pytest.approx(333.15)
    with pytest.raises(InputError, match=r"a master curve, not a strain sweep; give kind \(--kind\)"):
        read_dma(GOOD / "own_layout.csv").strain_sweeps()


def test_relaxation() -> None:
    data = read_dma(GOOD / "relaxation_unit_row.csv")
    assert data.kind == "relaxation"
    np.testing.assert_allclose(data.time, [0.01, 1.0, 100.0], rtol=ROUNDING)
    np.testing.assert_allclose(data.modulus, [9.5e6, 7.0e6, 5.5e6], rtol=ROUNDING)
    minutes = read_dma(GOOD / "relaxation_minutes_log.csv", poisson_ratio=0.25)
    np.testing.assert_allclose(minutes.time, [0.6, 60.0, 6000.0], rtol=ROUNDING)
    np.testing.assert_allclose(minutes.modulus, [7.5e6, 6.0e6, 4.75e6], rtol=ROUNDING)


def test_shift_factors() -> None:
    data = read_dma(GOOD / "shift_log_unit_row.csv")
    assert data.kind == "shift factors"
    np.testing.assert_allclose(data.temperature, [253.15, 273.15, 293.15, 313.15], rtol=ROUNDING)
    assert data.log10_a_T is not None
    assert data.log10_a_T.tolist() == [8.4, 3.2, 0.0, -2.1]
    linear = read_dma(GOOD / "shift_linear_vertical.csv")
    np.testing.assert_allclose(linear.log10_a_T, np.log10([1585.0, 1.0, 0.0079]), rtol=ROUNDING)
    np.testing.assert_allclose(linear.log10_b_T, np.log10([1.05, 1.0, 0.95]), rtol=ROUNDING)
    # ln 0.01 = -4.605...
    np.testing.assert_allclose(read_dma(GOOD / "shift_natural.csv").log10_a_T, [0.0, -2.0], rtol=ROUNDING)


def test_every_kind_has_a_file() -> None:
    options = {"two_tables.xlsx": {"sheet": "20C"}}
    kinds = {read_dma(file, **options.get(file.name, {})).kind for file in GOOD.iterdir()}
    assert kinds == set(KINDS)
