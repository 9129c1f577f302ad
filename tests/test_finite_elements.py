"""Input of other programs, read back as their manuals say it is read: the same E' and E'' come out."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path

import numpy as np
import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.fitting.fitted_compound import Request, TabulatedCompound, compound_from_files
from conveyor.fitting.programs import INCOMPRESSIBLE_RATIO, program_input
from conveyor.models import RubberCompound
from conveyor.rubber import PronySeries

OMEGA = 2.0 * np.pi * np.logspace(-3.0, 9.0, 61)
PRINTED = 1e-10  # twelve digits of each modulus and time, of some 40 terms of one sign
REST = 40 * 5e-13  # of E_0: E_e is what is left of 1 by 40 shares of twelve digits


def moduli(instantaneous: float, terms: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """E' and E'' [MPa] of shares and times [s]: g(t) = 1 - sum g_i (1 - exp(-t/tau_i))."""
    share, time = terms.T
    x = OMEGA[:, None] * time
    storage = instantaneous * (1.0 - share.sum() + (share * x * x / (1.0 + x * x)).sum(axis=1))
    return storage, instantaneous * (share * x / (1.0 + x * x)).sum(axis=1)


def read_abaqus(text: str) -> tuple[float, np.ndarray, list[str]]:
    lines = [line for line in text.splitlines() if not line.startswith("**")]
    data: dict[str, list[str]] = {}
    for line in lines:
        if line.startswith("*"):
            data[key := line] = []
        else:
            data[key].append(line)
    (elastic,) = data["*ELASTIC, MODULI=INSTANTANEOUS"]
    rows = np.array([[float(x) for x in row.split(",")] for row in data["*VISCOELASTIC, TIME=PRONY"]])
    assert np.array_equal(rows[:, 0], rows[:, 1])  # shear and bulk alike: Poisson's ratio is constant
    assert float(elastic.split(",")[1]) == INCOMPRESSIBLE_RATIO
    shift = next((values for key, values in data.items() if key.startswith("*TRS")), [])
    return float(elastic.split(",")[0]), rows[:, [0, 2]], shift


def read_ansys(text: str) -> tuple[float, np.ndarray, list[str]]:
    modulus, kind, constants = 0.0, "", {}
    for line in text.splitlines():
        words = line.split(",")
        if words[:3] == ["MP", "EX", "1"]:
            modulus = float(words[3])
        if words[0] == "TB":
            kind = words[-1]
        if words[0] == "TBDATA":
            for k, value in enumerate(words[2:]):
                constants[kind, int(words[1]) + k] = float(value)
    shear, bulk = ([v for (of, _), v in sorted(constants.items()) if of == name] for name in ("SHEAR", "BULK"))
    assert shear == bulk
    count = int(re.search(r"^TB,PRONY,1,,(\d+),SHEAR$", text, re.MULTILINE)[1])  # type: ignore[index]
    assert len(shear) == 2 * count
    return (
        modulus,
        np.array(shear).reshape(-1, 2),
        [v for (of, _), v in sorted(constants.items()) if of in {"WLF", "TN"}],
    )


@pytest.mark.parametrize("name", ["standard-cover", "s120"])
@pytest.mark.parametrize(("ending", "read"), [(".inp", read_abaqus), (".mac", read_ansys)])
def test_read_back_the_moduli_are_the_compounds(name, ending, read):
    compound = shelf.compound(name)
    instantaneous, terms, _ = read(program_input(compound, ending)[1])
    storage, loss = moduli(instantaneous, terms)
    series = compound.series_at_reference
    assert storage == pytest.approx(series.storage(OMEGA) / 1e6, rel=PRINTED, abs=REST * instantaneous)
    assert loss == pytest.approx(series.loss(OMEGA) / 1e6, rel=PRINTED)


def test_the_table_of_pyvisco_goes_out_and_in(tmp_path: Path):
    compound = shelf.compound("s120")
    text = program_input(compound, ".csv")[1]
    head, units, *rows = csv.reader(io.StringIO(text))
    assert (head, units) == (["i", "tau_i", "alpha_i", "E_0", "E_i"], ["-", "s", "-", "MPa", "MPa"])
    table = np.array(rows, dtype=float)
    storage, _ = moduli(table[0, 3], table[:, [2, 1]])
    expected = compound.series_at_reference.storage(OMEGA) / 1e6
    assert storage == pytest.approx(expected, rel=PRINTED, abs=REST * table[0, 3])
    (tmp_path / "terms.csv").write_text(text, encoding="utf-8")
    back = compound_from_files(tmp_path / "terms.csv", Request("back", "39.9639 degC"))
    assert isinstance(back, TabulatedCompound)
    assert back.compound.series_at_reference.loss(OMEGA) == pytest.approx(
        compound.series_at_reference.loss(OMEGA), rel=PRINTED
    )


def test_shift_laws_of_the_programs():
    cover = shelf.compound("standard-cover")
    law = cover.shift_law()
    t0, c1, c2 = map(float, read_abaqus(program_input(cover, ".inp")[1])[2][0].split(","))
    assert -c1 * (0.0 - t0) / (c2 + 0.0 - t0) == pytest.approx(float(law.log10_a_T(273.15)), rel=1e-8)
    assert read_ansys(program_input(cover, ".mac")[1])[2] == pytest.approx([t0, c1, c2])
    arrhenius = cover.replace(shift={"law": "arrhenius", "activation_energy": "120 kJ/mol"})
    text = program_input(arrhenius, ".inp")[1]
    gas = float(re.search(r"UNIVERSAL GAS=([\d.]+)", text)[1])  # type: ignore[index]
    zero = float(re.search(r"ABSOLUTE ZERO=(-[\d.]+)", text)[1])  # type: ignore[index]
    t0, energy = map(float, read_abaqus(text)[2][0].split(","))
    decades = energy / gas * (1.0 / (0.0 - zero) - 1.0 / (t0 - zero)) / np.log(10.0)
    assert decades == pytest.approx(float(arrhenius.shift_law().log10_a_T(273.15)), rel=1e-8)
    reference, over_gas = read_ansys(program_input(arrhenius, ".mac")[1])[2]
    assert (reference, over_gas) == pytest.approx((20.0, 120e3 / gas))


def test_a_table_that_no_wlf_law_follows_is_not_written_as_one():
    bent = shelf.compound("s120").as_data()
    bent["shift"]["log10_aT"][0] += 3.0
    text = program_input(RubberCompound.from_data(bent), ".inp")[1]
    assert "*TRS" not in text
    assert "none written, the nearest WLF law misses the table" in text
    with pytest.raises(InputError, match=r"ends in \.inp"):
        program_input(shelf.compound("s120"), ".txt")


TABLES = [
    ("tau [s],E_i [MPa],E_0 [MPa]\n1e-3,5,10\n1e-2,3,10\n", {}, 2e6),
    ("g_i,tau [s]\n0.5,1e-3\n0.3,1e-2\n", {"instantaneous": 10e6}, 2e6),
    ("tau [s],G_i [MPa]\n1e-3,5\n1e-2,3\n", {}, None),
]


@pytest.mark.parametrize(("text", "reading", "equilibrium"), TABLES)
def test_tables_of_finite_element_programs(tmp_path: Path, text, reading, equilibrium):
    path = tmp_path / "table.csv"
    path.write_text(text, encoding="utf-8")
    held = None if equilibrium else 6e6
    made = compound_from_files(path, Request("x", "20 degC", equilibrium=held, reading=reading)).compound
    factor = 3.0 if "G_i" in text else 1.0  # 2 (1 + nu) at nu = 0.5
    expected = PronySeries(equilibrium or 6e6, factor * np.array([5e6, 3e6]), np.array([1e-3, 1e-2]))
    assert made.series(293.15).storage(OMEGA) == pytest.approx(expected.storage(OMEGA), rel=1e-11)
    low, high = made.frequencies(293.15)
    assert (low, high) == pytest.approx((1.0 / (2e-2 * np.pi), 1.0 / (2e-3 * np.pi)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("tau [s],E_i [MPa]\n1e-3,5\n1e-2,3\n", "E_e is not stated"),
        ("tau [s],alpha_i\n1e-3,0.5\n1e-2,0.3\n", "shares of which modulus.*--instantaneous"),
        ("tau [s],alpha_i,E_0 [MPa]\n1e-3,0.8,1\n1e-2,0.3,1\n", "add up to 1.1"),
        ("tau [s],E_i [MPa],E_0 [MPa]\n1e-3,5,7\n1e-2,3,7\n", "more than E_0"),
    ],
)
def test_tables_that_say_too_little_or_too_much(tmp_path: Path, text, message):
    path = tmp_path / "table.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message):
        compound_from_files(path, Request("x", "20 degC"))
