"""Temperature and frequency that stand beside the table: in lines above it, in remarks, as the name of a sheet."""

from __future__ import annotations

import openpyxl
import pytest

from conveyor.errors import InputError
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.laboratory import read_dma

SWEEP = "Strain [%];E' [MPa];E'' [MPa]\n0,01;6;1\n0,1;5;1\n1;4;0,9\n10;3;0,8\n"


def read(tmp_path, text):
    path = tmp_path / "sweep.csv"
    path.write_text(text, encoding="utf-8")
    return read_dma(path)


@pytest.mark.parametrize(
    ("above", "kelvin", "hertz"),
    [
        ("Temperature: 20 °C\nFrequency: 10 Hz\n", 293.15, 10.0),
        ("Temperatur;20;°C\nFrequenz;1,5;Hz\n", 293.15, 1.5),
        ("# test temperature = 68 °F\n# ω [rad/s]: 6,283185307\n", 293.15, 1.0),
        ("Specimen;A 20\nTemperature [°C];-5,5\n", 267.65, None),
    ],
)
def test_set_points_above_a_strain_sweep_are_read(tmp_path, above, kelvin, hertz):
    data = read(tmp_path, above + SWEEP)
    assert data.kind == "strain sweep"
    assert data.temperature == pytest.approx([kelvin] * 4)
    assert (None if data.frequency is None else data.frequency.tolist()) == (hertz and pytest.approx([hertz] * 4))
    assert any("as row" in line for line in data.understood)


def test_columns_and_a_given_temperature_come_before_lines_above(tmp_path):
    text = (
        SWEEP.replace("Strain [%]", "T [°C];Strain [%]").replace("\n0,01", "\n30;0,01").replace("\n0,1;", "\n30;0,1;")
    )
    text = text.replace("\n1;", "\n30;1;").replace("\n10;", "\n30;10;")
    assert read(tmp_path, "Temperature: 20 °C\n" + text).temperature == pytest.approx([303.15] * 4)
    path = tmp_path / "sweep.csv"
    path.write_text("Temperature: 20 °C\n" + SWEEP, encoding="utf-8")
    assert read_dma(path, temperature=313.15).temperature == pytest.approx([313.15] * 4)


def test_lines_that_differ_are_refused_and_those_without_a_unit_left(tmp_path):
    with pytest.raises(InputError, match=r'sweep\.csv:2: .*"Sample temperature" says 25 °C, but: temperature of every'):
        read(tmp_path, "Temperature: 20 °C\nSample temperature: 25 °C\n" + SWEEP)
    assert read(tmp_path, "Temperature: 20\nTemperature: room\n" + SWEEP).temperature is None


@pytest.mark.parametrize(
    ("above", "said"),
    [
        ("Temperature: -300 °C\n", r'sweep\.csv:1: .*"Temperature" says -300 °C; -160 to 250 degC are allowed'),
        ("Temperature: 5000 °C\n", "-160 to 250 degC are allowed"),
        ("Frequency: 0 Hz\n", '"Frequency" says 0 Hz; a frequency is above 0'),
        ("Frequency;-5;Hz\n", "a frequency is above 0"),
    ],
)
def test_set_points_that_no_test_has_are_refused(tmp_path, above, said):
    with pytest.raises(InputError, match=said):
        read(tmp_path, above + SWEEP)


def test_frequency_above_a_temperature_sweep_is_read(tmp_path):
    rows = "".join(f"{t};{6 - 0.05 * t:.2f};1.0\n" for t in range(-20, 41, 2)).replace(".", ",")
    data = read(tmp_path, "Frequency: 10 Hz\nT [°C];E' [MPa];E'' [MPa]\n" + rows)
    assert data.kind == "temperature sweep"
    assert data.frequency == pytest.approx([10.0] * 31)


def workbook(tmp_path, names):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for k, name in enumerate(names):
        sheet = book.create_sheet(name)
        sheet.append(["f [Hz]", "E' [MPa]", "E'' [MPa]"])
        for i in range(12):
            reduced = (1.5 * i - 6.0 * k) / 10.0  # isotherms of one curve, 0.6 decades apart
            sheet.append([10.0 ** (0.15 * i), 6.0 * 10.0 ** (0.2 * reduced), 10.0 ** (0.22 * reduced)])
    path = tmp_path / "sheets.xlsx"
    book.save(path)
    return path


def test_sheets_named_by_their_temperature_are_isotherms(tmp_path):
    path = workbook(tmp_path, ["0 °C", "T=10C", "293.15 K", "30 degC"])
    assert read_dma(path, sheet="T=10C").temperature == pytest.approx([283.15] * 12)
    fitted = fit_file(path, Request(name="sheets", reading={"sheet": "*"}, reference_temperature="20 degC", replicas=0))
    assert fitted.superposition.temperatures == pytest.approx([273.15, 283.15, 293.15, 303.15])
    assert fitted.superposition.log10_a_T == pytest.approx([1.2, 0.6, 0.0, -0.6], abs=0.01)
    with pytest.raises(InputError, match="at which temperature"):
        fit_file(workbook(tmp_path, ["Run 20", "Run 30"]), Request(name="sheets", reading={"sheet": "*"}, replicas=0))


def test_sheets_of_temperatures_that_no_test_has_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"\[-400 °C\]: the name of the sheet is a temperature; -160 to 250 degC"):
        read_dma(workbook(tmp_path, ["-400 °C"]))


def test_repeated_rows_are_named_as_what_they_are(tmp_path):
    path = workbook(tmp_path, ["20 °C", "30 °C"])
    book = openpyxl.load_workbook(path)
    book.copy_worksheet(book["20 °C"]).title = "20.0 °C"
    book.save(path)
    with pytest.raises(InputError, match=r"repeat those that begin at .* digit for digit: delete them"):
        fit_file(path, Request(name="sheets", reading={"sheet": "*"}, reference_temperature="20 degC", replicas=0))
