"""Invariances of the reader: order of rows, units, damage, speed; names and numbers cell by cell."""

from __future__ import annotations

import re
import time
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laboratory import read_dma

FILES = Path(__file__).parent / "files"


def write(folder: Path, text: str) -> Path:
    file = folder / "pad.csv"
    file.write_text(text, encoding="utf-8")
    return file


def refusal(folder: Path, *lines: str) -> str:
    with pytest.raises(InputError) as refused:
        read_dma(write(folder, "\n".join(lines)))
    return str(refused.value)


@pytest.mark.parametrize(
    ("header", "quantity", "unit"),
    [
        ("Freq(Hz)", "frequency", "Hz"),
        ("Frequency, Hz", "frequency", "Hz"),
        ("f in Hz", "frequency", "Hz"),
        ("Angular frequency ω (rad/s)", "frequency", "rad/s"),
        ("fred [Hz]", "frequency", "Hz"),
        ("f*aT (Hz)", "frequency", "Hz"),
        ("Temp. / °C", "temperature", "°C"),
        ("T [K]", "temperature", "K"),
        ("t [K]", "temperature", "K"),
        ("T [s]", "time", "s"),
        ("t", "time", None),
        ("Temperature T [°C]", "temperature", "°C"),
        ("E'/MPa", "storage", "MPa"),
        ("Storage modulus (E') [MPa]", "storage", "MPa"),
        ("Speichermodul G' (kPa)", "storage", "kPa"),
        ('E" (MPa)', "loss", "MPa"),
        ("E′′ (MPa)", "loss", "MPa"),
        ("E_loss", "loss", None),
        ("|E*| [MPa]", "complex", "MPa"),
        ("tan(delta)", "tan_delta", None),
        ("tan δ", "tan_delta", None),
        ("손실계수", "tan_delta", None),
        ("E(t) [MPa]", "relaxation", "MPa"),
        ("Strain %", "strain", "%"),
        ("DSA (%)", "strain", "%"),
        ("log a_T", "a_T", None),
        ("Set", "run", None),
    ],
)
def test_names(tmp_path: Path, header: str, quantity: str, unit: str | None) -> None:
    # beside a run or a temperature it makes no measurement: the refusal says what was found, or asks for its unit
    beside = "T [degC]" if quantity == "run" else "run"
    message = refusal(tmp_path, f"{beside};{header}", "20;20", "20;40")
    assert re.search(rf"{quantity}\b|{quantity.replace('_', ' ')}\b", message)
    asked = unit is None and quantity not in {"tan_delta", "a_T", "run"}
    assert ("has no unit" in message) == asked
    assert "not known" not in message


@pytest.mark.parametrize(
    "header",
    [
        "F [N]",
        "F",
        "e [%]",
        "Static force",
        "Set temperature",
        "rel_mod",
        "S' [dNm]",
        "storage_furlong",
        "log",
    ],
)
def test_names_that_are_no_quantity(tmp_path: Path, header: str) -> None:
    assert "fewer than two known quantities" in refusal(tmp_path, f"run;{header}", "1;20", "1;40")


def shifts(cells: list[str]) -> str:
    """A table of shift factors, the last one measured at the lowest temperature."""
    return "\n".join(["T [degC];log aT", *(f"{-20 * k};{cell}" for k, cell in enumerate(cells))])


@pytest.mark.parametrize(
    ("cells", "values"),
    [
        (["1", "2"], [1.0, 2.0]),
        (["1.5", "2"], [1.5, 2.0]),
        (["0,5", "2"], [0.5, 2.0]),
        (["6,800", "12,25"], [6.8, 12.25]),
        (["0", "1,234E+00"], [0.0, 1.234]),
        (["6,800", "1000,5"], [6.8, 1000.5]),
    ],
)
def test_decimal_mark(tmp_path: Path, cells: list[str], values: list[float]) -> None:
    data = read_dma(write(tmp_path, shifts(cells)))
    assert data.log10_a_T is not None
    assert data.log10_a_T.tolist() == values[::-1]


@pytest.mark.parametrize(
    ("cells", "reason"),
    [
        (["6,800", "7,100"], "'6,800': a decimal comma or a thousands separator cannot be told apart"),
        (["6,8", "7.1"], "'6,8': a comma here and decimal points elsewhere"),
        (["1.234,5"], "thousands separator"),
        (["1,234.5"], "thousands separator"),
        (["1 234"], "thousands separator"),
        (["1.234.567,8"], "thousands separator"),
        (["10 Hz"], "holds a unit"),
        (["1. Feb"], "a date or time"),
        (["1-Feb"], "a date or time"),
        (["12:30"], "a date or time"),
        (["#N/A"], "not a finite number"),
        (["1_000"], "not a number"),
        (["#DIV/0!"], "not a number"),
    ],
)
def test_why_a_cell_is_no_number(tmp_path: Path, cells: list[str], reason: str) -> None:
    assert reason in refusal(tmp_path, shifts([*cells, "20"]))


@pytest.mark.parametrize(
    ("text", "codec", "note"),
    [
        ("T (°C) Größe µm", "cp1252", "cp1252"),
        ("T (°C)", "cp1252", "cp1252"),  # b"\xb0C" is one syllable in CP949
        ("온도 (℃)", "euc_kr", "euc_kr"),
        ("온도 뷁 시험", "cp949", "cp949"),
        ("온도 (℃)", "utf-8", "UTF-8"),
        ("온도 (℃)", "utf-16", "UTF-16"),
    ],
)
def test_encodings(tmp_path: Path, text: str, codec: str, note: str) -> None:
    file = tmp_path / "pad.txt"
    file.write_bytes(f"# note: {text}\n{shifts(['0', '3'])}\n".encode(codec))
    data = read_dma(file)
    assert data.metadata["note"] == text
    assert note in data.understood[0]


def test_order_of_rows_does_not_matter(tmp_path: Path) -> None:
    header, units, *rows = (FILES / "real" / "pyvisco_freq_user_raw.csv").read_text("utf-8-sig").splitlines()
    expected = read_dma(FILES / "real" / "pyvisco_freq_user_raw.csv")
    shuffled = np.random.default_rng(4).permutation(len(rows))
    data = read_dma(write(tmp_path, "\n".join([header, units, *(rows[i] for i in shuffled)])))
    for name in ("frequency", "temperature", "storage", "loss", "run", "group"):
        np.testing.assert_array_equal(getattr(data, name), getattr(expected, name))
    # rows are named where they now stand: two lines of header, lines counted from 1
    np.testing.assert_array_equal(shuffled[data.row_numbers - 3], expected.row_numbers - 3)


def test_numbers_marked_as_remarks_are_reported(tmp_path: Path) -> None:
    data = read_dma(write(tmp_path, "f [Hz],E' [MPa],E'' [MPa]\n1,5.6,0.56\n#5,6.2,0.6\n10,6.8,0.748\n"))
    assert data.row_numbers.tolist() == [2, 4]
    assert "1 row(s) of numbers are marked as remarks and not read, first row 3" in data.understood


def test_force_beside_frequency_is_not_a_frequency(tmp_path: Path) -> None:
    data = read_dma(write(tmp_path, "f [Hz],F [N],E' [MPa],E'' [MPa]\n1,9,5.6,0.56\n10,9,6.8,0.748\n"))
    assert data.frequency is not None
    assert data.frequency.tolist() == [1.0, 10.0]
    assert any('column 2 "F [N]" is not used' in sentence for sentence in data.understood)


def test_clock_of_a_dynamic_test_needs_no_unit(tmp_path: Path) -> None:
    data = read_dma(write(tmp_path, "time,f [Hz],E' [MPa],E'' [MPa]\n0,1,5.6,0.56\n60,10,6.8,0.748\n"))
    assert data.time is None
    assert 'column 1 "time" is not needed' in data.understood


def test_blocks_without_temperature_are_not_taken_for_one_curve(tmp_path: Path) -> None:
    block = "f [Hz];E' [MPa];E'' [MPa]\n1;5,6;0,56\n10;6,8;0,748\n100;8,6;1,075\n"
    with pytest.raises(InputError, match=r"frequencies begin anew.*temperature_degC.*--temperature"):
        read_dma(write(tmp_path, f"20 degC\n{block}\n40 degC\n{block}"))


def test_reduced_frequency_is_a_master_curve(tmp_path: Path) -> None:
    # overlapping isotherms, not merged, in the order of their measurement
    rows = "1,5,0.5\n10,6,0.6\n100,7,0.7\n30,6.5,0.65\n300,7.5,0.75\n3000,8.5,0.9\n"
    data = read_dma(write(tmp_path, "f*aT [Hz],E' [MPa],E'' [MPa]\n" + rows))
    assert (data.kind, data.run) == ("master curve", None)


def test_runs_with_other_set_points_are_told_apart(tmp_path: Path) -> None:
    first, second = [1.0, 2, 4, 8, 16], [1.5, 3, 6, 9, 12]
    rows = [f"{f},5,0.5" for f in (*first, *second)]
    file = write(tmp_path, "\n".join(["f [Hz],E' [MPa],E'' [MPa]", *rows]))
    runs = read_dma(file, kind="isotherms", temperature=293.15).isotherms()
    assert [run.frequency.tolist() for run in runs] == [first, second]


@pytest.mark.parametrize("drift", [0.0, 0.4, 0.9])
def test_temperatures_of_one_isotherm(tmp_path: Path, drift: float) -> None:
    # 5 K apart, each drifting by less than the gap that separates isotherms
    rows = [f"{10**k},{5 * step + drift * k / 4},5,0.5" for step in range(6) for k in range(5)]
    data = read_dma(write(tmp_path, "\n".join(["f [Hz],T [degC],E' [MPa],E'' [MPa]", *rows])))
    starts = [isotherm.row_numbers[0] for isotherm in data.isotherms()]
    assert starts == [2 + 5 * step for step in range(6)]


def test_files_cut_anywhere_are_read_or_refused_in_a_line_each(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    messages = []
    for source in sorted((FILES / "good").iterdir()):
        data = source.read_bytes()
        for cut in rng.integers(1, len(data), 6):
            file = tmp_path / source.name
            file.write_bytes(data[:cut])
            try:
                read_dma(file)
            except InputError as error:
                messages.append(str(error))
    assert len(messages) > 100
    # one line each, and one for the options together
    names = tuple(file.name for file in (FILES / "good").iterdir())
    assert all(line.startswith((*names, "these at once: --")) for message in messages for line in message.splitlines())


def test_ten_thousand_rows_in_half_a_second(tmp_path: Path) -> None:
    frequency = np.logspace(-3, 3, 500)
    rows = [f"{f:.6g};{5 + np.log10(f):.4f};0.5;{t}".replace(".", ",") for t in range(20) for f in frequency]
    file = write(tmp_path, "\n".join(["f [Hz];E' [MPa];E'' [MPa];T [°C]", *rows]))
    start = time.process_time()
    data = read_dma(file)
    isotherms = data.isotherms()
    # measured 0.15 s, ten times it for slower machines
    assert time.process_time() - start < 1.5
    assert len(isotherms) == 20
    assert data.row_numbers.size == 10_000


@pytest.mark.parametrize("word", ["Instrument: ARES", "rotational rheometer", "Mode: shear", "Scherversuch", "전단"])
def test_modulus_without_letter_in_a_shear_test_is_asked_about(tmp_path: Path, word: str) -> None:
    rows = "frequency_Hz,storage_MPa,loss_MPa\n1,5.6,0.56\n10,6.8,0.748\n"
    with pytest.raises(InputError, match=r"pad\.csv:2: column 2 .*E or G\?.*row 1 speaks of .*--poisson"):
        read_dma(write(tmp_path, f"# {word}\n{rows}"))
    # other words do not matter: "compares" holds "ares"; then nothing says which, and tension does
    with pytest.raises(InputError, match=r"E or G\?.*nothing in the file says whether tension or shear"):
        read_dma(write(tmp_path, f"# it compares two cases\n{rows}"))
    assert read_dma(write(tmp_path, f"# clamp: tension\n{rows}")).kind == "master curve"


def test_pooled_temperatures_are_no_isotherm(tmp_path: Path) -> None:
    rows = "1,20,5,0.5\n10,20,6,0.6\n100,0,7,0.7\n"
    data = read_dma(write(tmp_path, f"f*aT [Hz],T [degC],E' [MPa],E'' [MPa]\n{rows}"))
    with pytest.raises(InputError, match=r"pad\.csv:2: the rows of this master curve span 20 K, not one temperature"):
        data.isotherms()


def test_plain_number_with_a_unit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r":1: column 2 .*unit 'T_ref = 20' of a_T.*write - or nothing as its unit"):
        read_dma(write(tmp_path, "T [degC],log aT (T_ref = 20)\n0,3\n20,0\n"))


def test_endless_cells_are_refused_at_once(tmp_path: Path) -> None:
    file = write(tmp_path, "f [Hz];E' [MPa];E'' [MPa]\n1;" + "1," * 90_000 + "x;2\n3;3;3\n")
    with pytest.raises(InputError, match=r"pad\.csv:2: column 2 .*\.\.\.' is not a number") as refused:
        read_dma(file)
    assert len(str(refused.value)) < 250


def test_decimal_commas_with_thousands_points_name_the_cell_not_the_header(tmp_path: Path) -> None:
    rows = ("0,00100;3.781,12;415,09", "0,00142;3.894,27;457,81", "0,00202;4.073,11;505,70")
    said = refusal(tmp_path, "\n".join(["f [Hz];E' [kPa];E'' [kPa]", *rows]))
    assert ":2: column 2 \"E' [kPa]\": '3.781,12' has a thousands separator" in said
