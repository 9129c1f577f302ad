"""Files as instruments write them: sheets and blocks of steps, titles between them, columns of other names."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import openpyxl
import pytest

from conveyor.errors import InputError
from conveyor.fitting.fitted_compound import Request, compound_from_files, fit_file
from conveyor.laboratory import read_dma

ISOTHERMS = Path(__file__).parents[2] / "examples" / "laboratory" / "isotherms.csv"
SWEEP = "Temp.;Freq.;Stat. Dehnung;{};E';E''\n[°C];[Hz];[%];[%];[MPa];[MPa]\n" + "".join(
    f"{temperature};10;1,0;{strain};{modulus};1,0\n"
    for temperature in (0, 20)
    for strain, modulus in (("0,1", "12,0"), ("1,0", "9,0"), ("5,0", "6,0"))
)


def written(tmp_path: Path, text: str, name: str = "pad.txt") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", ["Dyn. Dehnung", "Dyn. strain", "Déformation dynamique"])
def test_the_dynamic_strain_makes_a_strain_sweep(tmp_path: Path, name: str) -> None:
    data = read_dma(written(tmp_path, SWEEP.format(name)))
    assert data.kind == "strain sweep"
    assert data.strain is not None
    np.testing.assert_allclose(np.unique(data.strain), [0.001, 0.01, 0.05], rtol=1e-14)


def test_moduli_that_differ_at_one_set_point_are_asked_for(tmp_path: Path) -> None:
    path = written(tmp_path, SWEEP.format("amplitude"))
    with pytest.raises(InputError, match=r"differs by a factor of 2 at one temperature .*'strain \[%\]'.*\(--kind\)"):
        read_dma(path)
    assert read_dma(path, kind="temperature sweep").kind == "temperature sweep"


def test_titles_with_numbers_between_blocks(tmp_path: Path) -> None:
    head = "Interval data:\tPoint No.\tFrequency\tStorage Modulus\tLoss Modulus\tTemperature\n"
    head += "\t\t[Hz]\t[Pa]\t[Pa]\t[°C]\n"
    rows = {t: "".join(f"\t{k}\t{f}\t{2e6 + k * 1e5}\t3e5\t{t}\n" for k, f in enumerate((1, 2, 5))) for t in (0, 20)}
    title = "Result:\tFrequency sweep {} °C\nInterval and data points:\t1\t3\n"
    data = read_dma(written(tmp_path, "".join(title.format(t) + head + rows[t] for t in rows)), letter="E")
    assert data.row_numbers.tolist() == [5, 6, 7, 12, 13, 14]
    assert "rows 8-9 stand between blocks and are not read" in data.understood


def test_steps_without_a_modulus_are_not_read(tmp_path: Path) -> None:
    soak = "[step]\nTemperature soak\nStep time\tTime\tTemperature\ns\ts\t°C\n10\t10\t19.0\n20\t20\t20.0\n"
    sweep = "[step]\nSweep\nFrequency\tStorage modulus\tLoss modulus\tTemperature\nHz\tMPa\tMPa\t°C\n"
    rows = "1\t5.6\t0.56\t{0}\n10\t6.8\t0.748\t{0}\n"
    data = read_dma(
        written(tmp_path, "".join(soak + sweep + rows.format(t) for t in ("20.0", "40.0")) + soak), letter="E"
    )
    assert data.row_numbers.tolist() == [11, 12, 23, 24]
    assert data.kind == "isotherms"
    for row in (3, 15, 27):
        assert f"row {row} begins a table that names no modulus and is not read" in data.understood
    with pytest.raises(InputError, match="make no measurement"):
        read_dma(written(tmp_path, soak))


MATRIX = "Temp./°C;{0}'(1.000Hz)/MPa;{0}''(1.000Hz)/MPa;{0}'(3.333Hz)/MPa;{0}''(3.333Hz)/MPa\n"


def test_frequencies_in_the_headers_make_rows(tmp_path: Path) -> None:
    rows = "0,0;9,0;1,0;9,5;1,1\n10,0;7,0;0,7;;\n20,0;5,6;0,5;5,9;0,55\n"
    data = read_dma(written(tmp_path, "Sample;torsion\n" + MATRIX.format("M") + rows), letter="G")
    assert data.kind == "isotherms"
    columns = data.columns("isotherms", "temperature", "frequency", "storage", "loss")
    found = sorted(zip(*(column.tolist() for column in columns), strict=True))
    expected = [
        (273.15, 1.0, 27e6, 3e6), (273.15, 3.333, 28.5e6, 3.3e6), (283.15, 1.0, 21e6, 2.1e6),
        (293.15, 1.0, 16.8e6, 1.5e6), (293.15, 3.333, 17.7e6, 1.65e6),
    ]  # fmt: skip
    np.testing.assert_allclose(found, expected, rtol=1e-14)
    assert "a row for each frequency of the headers: 1.000, 3.333 Hz" in data.understood


@pytest.mark.parametrize(
    ("header", "row", "place"),
    [
        (MATRIX.format("E"), "0,0;9,0;1,0;9,5;\n", "2: column 5 \"E''(3.333Hz)/MPa\": the cell is empty"),
        (
            MATRIX.format("E"),
            "0,0;9,0;1,0;OVL;1,1\n",
            "2: column 4 \"E'(3.333Hz)/MPa\": 'OVL' is not a finite number",
        ),
        (
            MATRIX.format("E").replace("''(3.333", "'(10"),
            "0,0;9,0;1,0;9,5;1,1\n",
            "3.333 Hz has other columns",
        ),
        (
            MATRIX.format("E").replace("Temp./°C", "f/Hz"),
            "1,0;9,0;1,0;9,5;1,1\n",
            "a second column for storage",
        ),
    ],
)
def test_headers_with_set_points_are_refused_in_their_place(tmp_path: Path, header: str, row: str, place: str) -> None:
    with pytest.raises(InputError, match=re.escape(place)):
        read_dma(written(tmp_path, header + row + row))


def test_names_listed_above_the_numbers(tmp_path: Path) -> None:
    names = (
        "Time (min)",
        "Temperature (°C)",
        "Frequency (Hz)",
        "Storage Modulus (MPa)",
        "Loss Modulus (MPa)",
    )
    head = "Instrument\tDMA Q800\nnsig\t5\n" + "".join(f"Sig{k}\t{name}\n" for k, name in enumerate(names, start=1))
    rows = "1.0\t20.1\t1.0\t5.6\t0.56\n2.0\t20.0\t10.0\t6.8\t0.68\n"
    data = read_dma(written(tmp_path, head + "Clamp\tTension\nTime\t09:14:07\nStartOfData\n" + rows))
    assert data.row_numbers.tolist() == [11, 12]
    np.testing.assert_allclose(data.storage, [5.6e6, 6.8e6], rtol=1e-14)
    with pytest.raises(InputError, match="fewer than two known quantities"):
        read_dma(written(tmp_path, head.replace("Sig5", "Signal") + "StartOfData\n" + rows, "four.txt"))


@pytest.mark.parametrize("remark", ["Time;Temperature", "Frequency @ 1 Hz;Temperature @ 20 °C"])
def test_rows_are_not_left_aside_for_a_remark_of_two_names(tmp_path: Path, remark: str) -> None:
    rows = "1;5;1;{0}\n10;6;1;{0}\n"
    text = "f [Hz];E' [MPa];E'' [MPa];T [°C]\n" + rows.format(20) + remark + "\n" + rows.format(30)
    with pytest.raises(InputError, match=r"pad\.txt:5: column 3: more cells than row 4 has names"):
        read_dma(written(tmp_path, text))


def test_listed_names_of_as_many_words_as_there_are_columns(tmp_path: Path) -> None:
    head = "Sig1\tFrequency (Hz)\nSig2\tStorage Modulus (MPa)\nSig3\tLoss Modulus (MPa)\nStartOfData\n"
    data = read_dma(written(tmp_path, head + "1.0\t5.6\t0.56\n10.0\t6.8\t0.68\n"), letter="E")
    np.testing.assert_allclose(data.storage, [5.6e6, 6.8e6], rtol=1e-14)
    np.testing.assert_allclose(data.loss, [5.6e5, 6.8e5], rtol=1e-14)


@pytest.mark.parametrize("point", ["@ {}", "at {}", "bei {}", "@{}", "@ ({})", "({})"])
def test_set_points_behind_a_word(tmp_path: Path, point: str) -> None:
    names = (f"{name} {point.format(at)} [MPa]" for at in ("1 Hz", "10 Hz") for name in ("E'", "E''"))
    data = read_dma(written(tmp_path, f"Temp. [°C],{','.join(names)}\n0,9,1,12,2\n5,7,1,9,1\n"))
    np.testing.assert_allclose(data.frequency, [1.0, 10.0, 1.0, 10.0], rtol=1e-14)
    np.testing.assert_allclose(data.storage, [9e6, 12e6, 7e6, 9e6], rtol=1e-14)


def test_names_in_french(tmp_path: Path) -> None:
    head = "Température (°C);Fréquence (Hz);Module de conservation E' (MPa);Module de perte E'' (MPa)\n"
    data = read_dma(written(tmp_path, head + "20;1;5,6;0,56\n20;10;6,8;0,68\n"))
    assert data.kind == "master curve"
    np.testing.assert_allclose(data.storage, [5.6e6, 6.8e6], rtol=1e-14)


def test_rows_that_cannot_be_read_are_left_out(tmp_path: Path) -> None:
    path = written(tmp_path, "f [Hz],E' [MPa],E'' [MPa]\n1,5.6,0.56\n5,,0.6\n10,6.8,0.748\nmean,6.2,0.65\n")
    with pytest.raises(InputError, match=r"pad\.txt:3: .*the cell is empty .*--exclude"):
        read_dma(path)
    with pytest.raises(InputError, match=r"pad\.txt:5: .*'mean' is not a number.*--exclude"):
        read_dma(path, exclude="3")
    data = read_dma(path, exclude="3,5-9")
    assert data.row_numbers.tolist() == [2, 4]
    assert "2 row(s) excluded by hand: 3,5-9" in data.understood


def test_sheets_of_one_rubber_are_taken_together(tmp_path: Path) -> None:
    whole = read_dma(ISOTHERMS)
    book = openpyxl.Workbook()
    book.active.append(["Sample name", "pad"])
    for number, one in enumerate(whole.isotherms(), start=1):
        sheet = book.create_sheet(f"Frequency sweep - {number}")
        for cells in (
            [sheet.title],
            ["E'", "E''", "Frequency", "Temperature"],
            ["Pa", "Pa", "Hz", "K"],
        ):
            sheet.append(cells)
        for row in zip(one.storage, one.loss, one.frequency, strict=True):
            sheet.append([*map(float, row), one.temperature])
    path = tmp_path / "steps.xlsx"
    book.save(path)
    with pytest.raises(InputError, match=r"15 sheets hold a table: .*--sheet '\*'"):
        compound_from_files(path, Request("pad", "20 degC"))
    with pytest.raises(InputError, match=r"no sheet 'Temp\*' holds a table; .*'Sheet', 'Frequency sweep - 1'"):
        compound_from_files(path, Request("pad", "20 degC", reading={"sheet": "Temp*"}))
    found = compound_from_files(path, Request("pad", "20 degC", replicas=0, reading={"sheet": "Freq*"}))
    beside = fit_file(ISOTHERMS, Request("pad", "20 degC", replicas=0))
    # the same rows, their temperatures rounded at the mean: nothing but rounding tells them apart
    assert found.superposition.log10_a_T == pytest.approx(beside.superposition.log10_a_T, abs=1e-6)
    left = Request(
        "pad",
        "20 degC",
        replicas=0,
        reading={"sheet": "*"},
        exclude=("steps.xlsx[Frequency sweep - 1]:4-99",),
    )
    with pytest.raises(InputError, match="no row would be left"):
        compound_from_files(path, left)
