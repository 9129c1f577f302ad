"""Exports as laboratories send them: other languages and units, columns twice, overloads, ramps, what nothing says."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laboratory import read_dma
from conveyor.laboratory.column_units import find_unit
from conveyor.laboratory.header_meanings import header_meaning
from conveyor.laboratory.table_layout import row_spans
from conveyor.laboratory.vocabulary import find_deformations

ROWS = [(t, f, 6.0 - 0.02 * t + 0.5 * k, 0.6 + 0.05 * k) for t in (0, 20) for k, f in enumerate((1, 10, 100))]
"""Temperature [degC], frequency [Hz], E' and E'' [MPa]: invented."""


def table(header: str, rows: Iterable[tuple[float, ...]] = ROWS, separator: str = ";") -> str:
    return "\n".join([header, *(separator.join(f"{value:g}" for value in row) for row in rows)]) + "\n"


def written(folder: Path, text: str, encoding: str = "utf-8") -> Path:
    file = folder / "pad.csv"
    file.write_bytes(text.encode(encoding))
    return file


def check(data_of: Path, **answers: object) -> tuple[str, ...]:
    """The file holds `ROWS`; returns what was understood."""
    data = read_dma(data_of, **answers)  # type: ignore[arg-type]
    assert data.kind == "isotherms"
    found = data.columns("isotherms", "temperature", "frequency", "storage", "loss")
    expected = np.array(ROWS).T * [[1.0], [1.0], [1e6], [1e6]] + [[273.15], [0.0], [0.0], [0.0]]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    return data.understood


@pytest.mark.parametrize(
    ("header", "encoding"),
    [
        ("温度（℃）;周波数（Hz）;貯蔵弾性率 E'（MPa）;損失弾性率 E''（MPa）", "cp932"),
        (
            "引張試験 温度／℃;周波数／Hz;貯蔵弾性率E'／MPa;損失弾性率E''／MPa".replace("引張試験 ", ""),
            "cp932",
        ),
        ("温度（℃）;周波数（Hz）;貯蔵弾性率 E'（MPa）;損失弾性率 E''（MPa）", "euc_jp"),
        ("温度(℃);频率(Hz);储能模量E' (MPa);损耗模量E'' (MPa)", "gb18030"),
        ("溫度(℃);頻率(Hz);儲能模量 E' (MPa);損耗模量 E'' (MPa)", "big5"),
        ("온도 [℃];주파수 [Hz];저장탄성률 E' [MPa];손실탄성률 E'' [MPa]", "cp949"),
        ("Температура, °С;Частота, Гц;Модуль накопления E', МПа;Модуль потерь E'', МПа", "cp1251"),
        ("Sıcaklık [°C];Frekans [Hz];Depolama modülü E' [MPa];Kayıp modülü E'' [MPa]", "cp1254"),
        (
            "Temperatura [°C];Częstotliwość [Hz];Moduł zachowawczy E' [MPa];Moduł stratności E'' [MPa]",
            "cp1250",
        ),
        (
            "Temperatura [°C];Frecuencia [Hz];Módulo de almacenamiento E' [MPa];Módulo de pérdida E'' [MPa]",
            "cp1252",
        ),
        (
            "Temperatura [°C];Frequência [Hz];Módulo de armazenamento E' [MPa];Módulo de perda E'' [MPa]",
            "cp1252",
        ),
        (
            "Temperatura [°C];Frequenza [Hz];Modulo conservativo E' [MPa];Modulo dissipativo E'' [MPa]",
            "cp1252",
        ),
        (
            "Température (°C);Fréquence (Hz);Module de conservation E' (MPa);Module de perte E'' (MPa)",
            "cp1252",
        ),
        ("Temperatur [°C];Frequenz [Hz];Speichermodul E' [MPa];Verlustmodul E'' [MPa]", "cp1252"),
    ],
)
@pytest.mark.parametrize("unicode", [True, False])
def test_names_in_many_languages_and_encodings(tmp_path: Path, header: str, encoding: str, unicode: bool) -> None:
    check(written(tmp_path, table(header), "utf-8" if unicode else encoding))


@pytest.mark.parametrize("header", ["temperature_c,freq_hz,e'_mpa,e''_mpa", "T [DEGC],f [HZ],Ep [MPA],Epp [mpa]"])
def test_capitals_of_units_do_not_count(tmp_path: Path, header: str) -> None:
    check(written(tmp_path, table(header, separator=",")))


def test_capitals_count_where_they_tell_units_apart(tmp_path: Path) -> None:
    assert find_unit("frequency", "mHz") != find_unit("frequency", "MHz")
    for text, said in (("f [mhz]", "'mhz' may be mHz or MHz"), ("f [MHZ]", "'MHZ' may be mHz or MHz")):
        with pytest.raises(InputError, match=rf"unit {said}.*--frequency-unit"):
            read_dma(written(tmp_path, table(f"T [degC];{text};E' [MPa];E'' [MPa]")))
    with pytest.raises(InputError, match=r"'mPa' reads millipascal.*--modulus-unit MPa"):
        read_dma(written(tmp_path, table("T [degC];f [Hz];E' [mPa];E'' [mPa]")))


def test_a_column_twice(tmp_path: Path) -> None:
    header = "T [degC];f [Hz];E' [MPa];E'' [MPa];T [degC]"
    same = written(tmp_path, table(header, [(*row, row[0]) for row in ROWS]))
    assert any("column 5" in said and "repeats column 1" in said for said in check(same))
    other = written(tmp_path, table(header, [(*row, row[0] + 1.5) for row in ROWS]))
    with pytest.raises(InputError, match=r"pad\.csv:1: column 5 .*a second column for temperature.*--ignore 5"):
        read_dma(other)
    check(other, ignore=["5"])
    with pytest.raises(InputError, match=r'ignore = "G" \(--ignore\): no such column; there are: T'):
        read_dma(other, ignore=["G"])


@pytest.mark.parametrize("name", ["Strain (cmd) [%]", "Commanded strain [%]", "Soll-Dehnung [%]", "Strain, target [%]"])
def test_what_was_measured_goes_before_what_was_commanded(tmp_path: Path, name: str) -> None:
    header = f"T [degC];f [Hz];E' [MPa];E'' [MPa];{name};Strain [%]"
    file = written(tmp_path, table(header, [(*row, 0.1, 0.0995) for row in ROWS]))
    assert any("column 5" in said and "commanded" in said for said in check(file))
    assert read_dma(file).strain == pytest.approx(np.full(6, 0.000995), rel=1e-12)
    # alone it is what there is
    alone = written(tmp_path, table(header.rpartition(";")[0], [(*row, 0.1) for row in ROWS]))
    assert read_dma(alone).strain == pytest.approx(np.full(6, 0.001), rel=1e-12)


def test_a_name_without_values(tmp_path: Path) -> None:
    text = table("T [degC];f [Hz];E' [MPa];E'' [MPa];tan delta;Normal force [N]")
    assert any("column 5" in said and "empty in every row" in said for said in check(written(tmp_path, text)))


def test_tables_that_the_instrument_made_of_the_steps(tmp_path: Path) -> None:
    steps = [table("T [degC];f [Hz];E' [MPa];E'' [MPa]", ROWS[k : k + 3]) for k in (0, 3)]
    made = "TTS - shift factors\n" + table("T [degC];a_T", [(0, 9.0), (20, 1.0)])
    made += "TTS - master curve\n" + table("f [Hz];E' [MPa];E'' [MPa]", [(9.0, 6.0, 0.6), (90.0, 7.0, 0.7)])
    said = check(written(tmp_path, "".join(f"[step]\n{step}" for step in steps) + made))
    assert sum("made of the steps" in line for line in said) == 2
    # a table of another test is none of these, and --exclude answers
    other = "".join(steps) + table("T [degC];f [Hz];E' [MPa];tan delta", [(0, 1, 9.0, 0.5)])
    with pytest.raises(InputError, match=r"pad\.csv:9: column 4 .*a second table begins here.*--exclude 9-10"):
        read_dma(written(tmp_path, other))
    check(written(tmp_path, other), exclude="9-10")


def test_all_findings_of_a_file_at_once(tmp_path: Path) -> None:
    rows = [(t, 10**k, 6.0 + k, 0.6, t + 2) for t in (0, 20) for k in range(5)]
    lines = table("T [degC];f [Hz];E' [MPa];E'' [MPa];T [degC]", rows).splitlines()
    lines[2], lines[6], lines[8] = "0;10;7;-0.6;2", "0;10000;9.9E+37;0.6;2", "20;10;OVL;0.6;22"
    file = written(tmp_path, "\n".join(lines))
    with pytest.raises(InputError, match=r"--ignore 5") as refused:
        read_dma(file)
    said = str(refused.value).splitlines()
    for row, what in (
        (3, "loss = -0.6 must be > 0"),
        (7, "an overload of the instrument"),
        (9, "'OVL' is not"),
    ):
        assert any(line.startswith(f"pad.csv:{row}: ") and what in line and f"--exclude {row}" in line for line in said)
    assert said[-1] == "these at once: --exclude 3,7,9 --ignore 5"
    data = read_dma(file, exclude="3,7,9", ignore=["5"])
    assert data.row_numbers.tolist() == [2, 4, 5, 6, 8, 10, 11]


def test_rows_at_fault_are_named_together(tmp_path: Path) -> None:
    rows = [(0, 10**k, 6.0, -0.1 if k in {1, 3, 4} else 0.6) for k in range(9)]
    with pytest.raises(InputError, match=r"pad\.csv:3: .*--exclude 3,5-6\); likewise row 5: .*likewise row 6: "):
        read_dma(written(tmp_path, table("T [degC];f [Hz];E' [MPa];E'' [MPa]", rows)))
    assert row_spans([1, 3, 4, 5, 9]) == "1,3-5,9"


def test_a_column_of_another_name(tmp_path: Path) -> None:
    file = written(tmp_path, table("T [degC];f [Hz];Modul A [MPa];E'' [MPa]"))
    check(file, columns={"Modul A": "E'"})
    check(file, columns={"modul a [MPa]": "storage"})
    with pytest.raises(InputError, match=r'"Modul B=E\'" \(--column\): no column has the name "Modul B"'):
        read_dma(file, columns={"Modul B": "E'"})
    with pytest.raises(InputError, match=r'\(--column\): "stiffness" is no name of a column known here'):
        read_dma(file, columns={"Modul A": "stiffness"})


SHEAR = (
    "Mode: shear", "double shear", "Shear sandwich", "Geometry: parallel plate", "plate-plate", "plate/plate", "PP25",
    "PP 08", "CP50-1", "SRF12", "cone-plate", "torsion", "Torsionspendel", "Rheometer", "ARES-G2", "MCR 302",
    "MCR302", "DHR-2", "Kinexus", "RPA 2000", "MDR", "MDR2000", "rubber process analyzer", "cisaillement",
    "double cisaillement", "plan-plan", "Doppelscherprobe", "Scherversuch", "Schubmodus", "Platte-Platte", "cizalla",
    "cisalhamento", "taglio", "ścinanie", "kesme", "сдвиг", "кручение", "剪切", "せん断",
    "전단 시험", "HAAKE MARS 60",
)  # fmt: skip
TENSION = (
    "Clamp: Tension", "tensile", "dual cantilever", "three-point bending", "3-point bending", "compression", "Zug",
    "Dreipunktbiegung", "traction", "flexion", "trazione", "tracción", "rozciąganie", "çekme", "растяжение",
    "拉伸", "引張", "인장",
)  # fmt: skip
NEITHER = (
    "Laboratory Fischer",
    "it compares two cases",
    "in March",
    "operator: Marsh",
    "DMA Q800",
    "cone of silence".replace("cone", "code"),
)


@pytest.mark.parametrize("words", SHEAR)
def test_every_way_of_saying_shear(tmp_path: Path, words: str) -> None:
    assert {one.letter for one in find_deformations(words)} == {"G"}
    open_ = written(tmp_path, f"# {words}\n" + table("T [degC];f [Hz];storage [MPa];loss [MPa]"))
    with pytest.raises(InputError, match=r"E or G\?.*row 1 speaks of.*--moduli G"):
        read_dma(open_)
    third = read_dma(open_, letter="E").storage
    assert read_dma(open_, letter="G").storage == pytest.approx(3.0 * third, rel=1e-12)
    # columns that say E contradict it, and the answer decides
    tensile = written(tmp_path, f"# {words}\n" + table("T [degC];f [Hz];E' [MPa];E'' [MPa]"))
    with pytest.raises(InputError, match=r"the name says E, but row 1 speaks of .*--moduli E, --moduli G"):
        read_dma(tensile)
    check(tensile, letter="E")
    assert read_dma(tensile, letter="G").storage == pytest.approx(3.0 * third, rel=1e-12)


@pytest.mark.parametrize("words", TENSION)
def test_every_way_of_saying_tension(tmp_path: Path, words: str) -> None:
    check(written(tmp_path, f"# {words}\n" + table("T [degC];f [Hz];storage [MPa];loss [MPa]")))
    shear = written(tmp_path, f"# {words}\n" + table("T [degC];f [Hz];G' [MPa];G'' [MPa]"))
    with pytest.raises(InputError, match="the name says G, but row 1 speaks of"):
        read_dma(shear)


@pytest.mark.parametrize("words", NEITHER)
def test_where_nothing_says_which_it_is_asked(tmp_path: Path, words: str) -> None:
    assert not list(find_deformations(words))
    file = written(tmp_path, f"# {words}\n" + table("T [degC];f [Hz];storage [MPa];loss [MPa]"))
    with pytest.raises(InputError, match=r"E or G\?.*nothing in the file says whether tension or shear.*--moduli E"):
        read_dma(file)
    check(file, letter="E")
    check(written(tmp_path, f"# {words}\n" + table("T [degC];f [Hz];E' [MPa];E'' [MPa]")))


def test_a_shear_strain_beside_tensile_moduli_is_named(tmp_path: Path) -> None:
    file = written(tmp_path, table("T [degC];f [Hz];E' [MPa];E'' [MPa];Shear strain [%]", [(*r, 0.1) for r in ROWS]))
    with pytest.raises(InputError, match=r"says E, but column 5 .*is a shear strain"):
        read_dma(file)


RAMP = 0.4
"""Between two rows of the ramp [K]."""


def law(temperature: np.ndarray, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """E' and E'' [MPa] of one curve, with an exponential shift: invented."""
    x = np.log10(frequency) - 0.06 * temperature
    return 5.0 + np.exp(0.5 * x), 0.4 * np.exp(0.6 * x)


def test_a_slow_ramp_of_several_frequencies_makes_isotherms(tmp_path: Path) -> None:
    frequency = np.tile([1.0, 2.5, 5.0, 10.0, 20.0], 20)
    temperature = -20.0 + RAMP * np.arange(frequency.size)
    storage, loss = law(temperature, frequency)
    rows = np.stack([temperature, frequency, storage, loss], axis=1)
    text = "\n".join(["T [degC];f [Hz];E' [MPa];E'' [MPa]", *(";".join(f"{v:.9g}" for v in row) for row in rows)])
    data = read_dma(written(tmp_path, text))
    isotherms = data.isotherms()
    # every cycle but the first and the last, which the others do not reach on both sides
    assert len(isotherms) == 18
    for one in isotherms:
        assert one.temperature_spread == pytest.approx(0.0, abs=1e-9)
        assert one.frequency == pytest.approx([1.0, 2.5, 5.0, 10.0, 20.0])
        true = law(np.full(5, one.temperature - 273.15), one.frequency)
        # a cubic over steps of 2 K of nearly straight ln E' and ln E'': far below 1e-4, one-sided at its ends
        assert one.storage == pytest.approx(1e6 * true[0], rel=2e-4)
        assert one.loss == pytest.approx(1e6 * true[1], rel=2e-4)
    assert any("a ramp with 5 frequencies" in said for said in data.understood)
    assert read_dma(written(tmp_path, text), kind="temperature sweep").kind == "temperature sweep"


def test_names_of_every_list_are_read() -> None:
    for header, quantity, letter in (
        ("Gp [kPa]", "storage", "G"), ("Gpp [kPa]", "loss", "G"), ("Модуль потерь, МПа", "loss", ""),
        ("せん断ひずみ (%)", "strain", "G"), ("tan δ", "tan_delta", ""), ("Tangens kąta stratności", "tan_delta", ""),
        ("угол сдвига фаз, град", "phase", ""), ("移位因子", "a_T", ""),
    ):  # fmt: skip
        sense = header_meaning(header)
        assert sense is not None, header
        assert (sense.quantity, sense.letter) == (quantity, letter)
