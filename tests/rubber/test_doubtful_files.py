"""Files that read well and are hardly what they say: refused with what was seen, and fitted where one insists."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from conveyor import shelf
from conveyor.cli import app
from conveyor.errors import InputError
from conveyor.fitting.findings import FINDINGS, check_findings
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.laboratory import read_dma
from conveyor.laboratory.moduli import equivalent_strain
from conveyor.rubber import PronySeries

FILES = Path(__file__).parents[1] / "laboratory" / "files"
DOUBTFUL = FILES / "doubtful"
MATERIALS = Path(__file__).parents[2] / "materials"

SEEN = [
    ("three_rows.csv", "few-rows", "3 frequencies over 0.4 decades"),
    ("too_soft.csv", "modulus", "E' = 0.0127 MPa at 0.01 Hz; rubber has 0.05 to 12,000 MPa"),
    ("too_stiff.csv", "modulus", "E' = 1.824e+04 MPa at 1e+06 Hz"),
    ("tan_delta_as_loss.csv", "contradiction", "what is named E'' is tan delta"),
    ("logarithms_unnamed.csv", "contradiction", "frequency and moduli are log10"),
    ("butyl_columns_exchanged.csv", "contradiction", "exchange the names of the two columns"),
]


def request(at: str | None = "20 degC", **more: object) -> Request:
    return Request("x", at, replicas=0, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(("name", "finding", "seen"), SEEN, ids=[case[0] for case in SEEN])
def test_refused_with_what_was_seen_and_how_to_insist(name: str, finding: str, seen: str) -> None:
    with pytest.raises(InputError, match=re.escape(seen)) as refused:
        fit_file(DOUBTFUL / name, request())
    assert str(refused.value).startswith(str(DOUBTFUL / name))
    assert f"--accept {finding}" in str(refused.value)


@pytest.mark.parametrize("name", ["too_soft.csv", "too_stiff.csv"])
def test_one_finding_is_insisted_on_and_written_down(name: str) -> None:
    found = fit_file(DOUBTFUL / name, request(accept=frozenset({"modulus"})))
    assert found.compound.fit is not None
    assert "accepted (modulus)" in found.compound.fit.method
    assert "accepted (modulus)" in found.understood[-1]


def test_insisting_on_another_finding_does_not_help() -> None:
    with pytest.raises(InputError, match="--accept modulus"):
        fit_file(DOUBTFUL / "too_soft.csv", request(accept=frozenset({"few-rows"})))
    with pytest.raises(InputError, match=f'"soft" .* allowed: {", ".join(FINDINGS)}'):
        fit_file(DOUBTFUL / "too_soft.csv", request(accept=frozenset({"soft"})))


@pytest.mark.parametrize("seed", range(8))
def test_good_rubber_is_not_doubted(seed: int) -> None:
    """From a soft gum to a stiff, cold one, butyl's broad loss among them, with up to 5 % of noise."""
    rng = np.random.default_rng(seed)
    places = np.linspace(-9.0, 2.0, 45)
    width, middle = rng.uniform(1.5, 6.0), rng.uniform(-7.0, -1.0)
    moduli = 10.0 ** -(((places - middle) / width) ** 2)
    soft = 10.0 ** rng.uniform(5.0, 6.5)
    series = PronySeries(soft, moduli / moduli.sum() * soft * 10.0 ** rng.uniform(0.5, 3.0), 10.0**places)
    f = np.logspace(-2.0, rng.uniform(0.5, 8.0), 40)
    noise = 1.0 + 0.05 * (seed % 2) * rng.uniform(-1.0, 1.0, (2, f.size))
    omega = 2.0 * np.pi * f
    curve = (f, series.storage(omega) * noise[0], series.loss(omega) * noise[1])
    assert check_findings("good", curve, frozenset(), 3.0) == ()


NEARLY = {
    "E' and E''": (lambda e1, e2: (e1, e2), None),
    "|E*| named E', E''": (lambda e1, e2: (np.hypot(e1, e2), e2), "if what is named E' is |E*|"),
    "|E*| named E', tan delta": (
        lambda e1, e2: (np.hypot(e1, e2), np.hypot(e1, e2) * e2 / e1),
        "E'' was made of it by tan",
    ),
    "phase named tan delta": (
        lambda e1, e2: (e1, e1 * np.arctan(e2 / e1)),
        "if its tan delta is the phase angle in rad",
    ),
    "phase in degrees named tan delta": (
        lambda e1, e2: (e1, e1 * np.degrees(np.arctan(e2 / e1))),
        "if its tan delta is the phase angle in degrees",
    ),
}


@pytest.mark.parametrize("name", NEARLY)
@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_a_modulus_that_is_nearly_another_is_named(name: str, noise: float) -> None:
    """Through the glass transition of the shelf's constructed rubbers."""
    made, words = NEARLY[name]
    rng, f = np.random.default_rng(5), np.logspace(2.0, 9.0, 36)
    for compound in ("standard-cover", "low-rolling-resistance-cover"):
        rubber = shelf.compound(compound).series(293.15)
        moduli = [
            one(2.0 * np.pi * f) * np.exp(noise * rng.standard_normal(f.size)) for one in (rubber.storage, rubber.loss)
        ]
        curve = (f, *made(*moduli))
        if words is None:
            assert check_findings("right", curve, frozenset(), 3.0) == ()
        else:
            with pytest.raises(InputError, match=re.escape(words)):
                check_findings("wrong", curve, frozenset(), 3.0)


@pytest.mark.parametrize("name", ["|E*| named E', E''", "|E*| named E', tan delta"])
def test_it_is_named_where_little_of_the_curve_shows_it(name: str) -> None:
    """Thirteen decades, 0.1 % of noise: the best positive spectrum leaves 0.7 to 1.5 %, the right reading 0.1 %."""
    made, words = NEARLY[name]
    rng, f = np.random.default_rng(7), np.logspace(-4.0, 9.0, 78)
    for compound in ("s120", "low-rolling-resistance-cover"):
        rubber = shelf.compound(compound).series_at_reference
        storage, loss = (
            one(2.0 * np.pi * f) * np.exp(0.001 * rng.standard_normal(f.size)) for one in (rubber.storage, rubber.loss)
        )
        assert check_findings("right", (f, storage, loss), frozenset(), 3.0) == ()
        with pytest.raises(InputError, match=re.escape(words or "")):
            check_findings("wrong", (f, *made(storage, loss)), frozenset(), 3.0)


@pytest.mark.parametrize("seed", range(10))
def test_short_sweeps_with_noise_are_not_read_otherwise(seed: int) -> None:
    """A spectrum fits another reading of few rows by chance: of seed 2, if it were looked for."""
    rng = np.random.default_rng(seed)
    f = np.logspace(0.0, rng.uniform(1.0, 2.0), int(rng.integers(5, 9)))
    noise = np.exp(0.01 * rng.standard_normal((2, f.size)))
    curve = (f, 8e6 * np.sqrt(f) * noise[0], 8e6 * np.sqrt(f) * noise[1])  # a tan delta of 1
    assert check_findings("short", curve, frozenset(), 3.0) == ()


def written(folder: Path, head: str, *columns: np.ndarray) -> Path:
    path = folder / "master.csv"
    rows = ("; ".join(f"{value:.4g}" for value in row) for row in zip(*columns, strict=True))
    path.write_text("\n".join([f"f [Hz]; {head}", *rows]) + "\n", encoding="utf-8")
    return path


def test_three_columns_tell_which_is_which(tmp_path: Path) -> None:
    """At four digits, on a plateau where the curve alone tells nothing."""
    f, rubber = np.logspace(-2.0, 2.0, 21), shelf.compound("standard-cover").series(293.15)
    storage, loss = rubber.storage(2.0 * np.pi * f) / 1e6, rubber.loss(2.0 * np.pi * f) / 1e6
    whole, tangent, phase = np.hypot(storage, loss), loss / storage, np.arctan2(loss, storage)
    three = "E' [MPa]; E'' [MPa]; tan delta"
    assert read_dma(written(tmp_path, three, f, storage, loss, tangent)).storage[0] == pytest.approx(
        1e6 * storage[0], 1e-3
    )
    with pytest.raises(InputError, match=r"what is named E' is \|E\*\|; name the column"):
        read_dma(written(tmp_path, three, f, whole, loss, tangent))
    with pytest.raises(InputError, match="what is named tan delta is the phase angle"):
        read_dma(written(tmp_path, three, f, storage, loss, phase))


def test_whole_modulus_beside_the_loss(tmp_path: Path) -> None:
    f, rubber = np.logspace(-2.0, 2.0, 21), shelf.compound("standard-cover").series(293.15)
    storage, loss = rubber.storage(2.0 * np.pi * f), rubber.loss(2.0 * np.pi * f)
    head = "|E*| [MPa]; E'' [MPa]"
    found = read_dma(written(tmp_path, head, f, np.hypot(storage, loss) / 1e6, loss / 1e6))
    assert found.storage == pytest.approx(storage, rel=1e-3)  # four digits
    with pytest.raises(InputError, match=r"E'' is 1.1 times \|E\*\|"):
        read_dma(written(tmp_path, head, f, loss / 1e6 / 1.1, loss / 1e6))


@pytest.mark.parametrize(
    ("name", "said"),
    [
        (
            "temperature_column.csv",
            "temperature_column.csv:2: column of the temperature: the temperature is -15 degC",
        ),
        (
            "one_temperature.csv",
            "one_temperature.csv:2: column of the temperature: the temperature is 8 degC",
        ),
        (
            "temperature_remark.csv",
            'temperature_remark.csv:1: "reference_temperature": the temperature is 40 degC',
        ),
    ],
)
def test_a_temperature_against_the_files_own_is_refused(name: str, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said) + ".* --at says 20 degC.*leave out --at"):
        fit_file(DOUBTFUL / name, request())
    stated = fit_file(DOUBTFUL / name, request(None))
    assert stated.compound.reference_temperature.magnitude == pytest.approx(float(said.split()[-2]))


def test_a_temperature_without_unit_is_asked_for(tmp_path: Path) -> None:
    text = (DOUBTFUL / "temperature_remark.csv").read_text(encoding="utf-8").replace("40 degC", "40")
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"a.csv:1: .*: '40' is no temperature with its unit"):
        fit_file(tmp_path / "a.csv", request())


@pytest.mark.parametrize("name", ["s100", "s120"])
@pytest.mark.parametrize("at", ["39.96 degC", "40 degC", None])
def test_published_curves_at_their_temperature_as_rounded(name: str, at: str | None) -> None:
    found = fit_file(MATERIALS / f"{name}.dma.csv", request(at, shift=MATERIALS / f"{name}.shift.csv"))
    assert found.compound.shift is not None
    assert {law.name for law in found.laws} == {"table", "WLF", "Arrhenius"}


def test_a_shift_that_is_not_zero_at_the_reference_blames_the_shift_file(tmp_path: Path) -> None:
    curve = (MATERIALS / "s100.dma.csv").read_text(encoding="utf-8").replace("# reference_temp", "# temp")
    (tmp_path / "s100.csv").write_text(curve, encoding="utf-8")
    with pytest.raises(InputError, match=r"s100\.shift\.csv: .*at the reference 42\.00 degC is -0\.16"):
        fit_file(tmp_path / "s100.csv", request("42 degC", shift=MATERIALS / "s100.shift.csv"))


def test_exchanged_temperatures_are_named_with_their_rows() -> None:
    said = r"2\.00 degC \(from row 52 on\) and 14\.00 degC \(from row 32 on\) exchanged all shifts fall"
    with pytest.raises(InputError, match=said):
        fit_file(DOUBTFUL / "temperatures_exchanged.csv", request())


def test_shear_strain_becomes_the_tensile_one_of_equal_energy() -> None:
    first = read_dma(DOUBTFUL / "strain_sweep_in_shear.csv").strain_sweeps()[0]
    shear, modulus = 1e-4, 15.559e6  # the file's first row
    assert first.strain[0] == pytest.approx(shear / np.sqrt(3.0), rel=1e-14)
    assert first.storage[0] == pytest.approx(3.0 * modulus, rel=1e-14)
    assert first.storage[0] * first.strain[0] ** 2 == pytest.approx(modulus * shear**2, rel=1e-13)
    # sqrt(2/3 e:e) of simple shear, e_12 = e_21 = gamma/2
    strain = np.array([[0.0, 0.5], [0.5, 0.0]])
    assert equivalent_strain(np.array([1.0]), 0.5)[0][0] == pytest.approx(
        np.sqrt(2.0 / 3.0 * np.sum(strain**2)), rel=1e-14
    )


def command(*arguments: str | Path) -> None:
    """`conveyor` without its exit code: an InputError is 2."""
    app([str(one) for one in arguments], standalone_mode=False)


HEADER = "frequency [Hz],E' [MPa],E'' [MPa]\n"
ROWS = "".join(f"{10.0 ** (0.25 * i - 2)},{2.0 + 0.3 * i},{0.2 + 0.02 * i}\n" for i in range(25))
BROKEN = {
    "a frequency of no instrument": (
        HEADER + ROWS + "1e308,20,2\n",
        "frequency = 1e308 is outside 1e-30 to",
    ),
    "a frequency of nothing": (HEADER + "1e-308,1.9,0.1\n" + ROWS, "frequency = 1e-308 is outside"),
    "a quoted field without end": (HEADER + ROWS + '"' + "1" * 150_000 + '",1,1\n', "is not a number"),
    "a control character": (
        "# T_ref: \x1b[31m40 degC\n" + HEADER + ROWS,
        r"'\\x1b\[31m40 degC' is no temperature",
    ),
    "two temperatures": ("# T_ref: 40,5 degC\n# Tref = 60 °C\n" + HEADER + ROWS, '"Tref" says 60 degC'),
}


@pytest.mark.parametrize(("text", "message"), BROKEN.values(), ids=BROKEN)
def test_broken_files_are_refused_by_the_command(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message) as refused:
        command("fit", path, "--at", "20 degC")
    said = str(refused.value)
    assert said.startswith(str(path)), "the file is named once, with its folder"
    assert len(said) < 500


def test_accept_is_an_option(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    soft = DOUBTFUL / "too_soft.csv"
    with pytest.raises(InputError, match="--accept modulus"):
        command("fit", soft, "--at", "20 degC")
    command("fit", soft, "--at", "20 degC", "--accept", "modulus", "-o", tmp_path / "soft.yaml")
    assert "accepted (modulus)" in capsys.readouterr().out
    assert "accepted (modulus)" in (tmp_path / "soft.yaml").read_text(encoding="utf-8")


def test_an_unreadable_shift_file_is_blamed_itself(tmp_path: Path) -> None:
    (tmp_path / "a_T.csv").write_text("temperature_degC,a_T\n20,1\n30,OVL\n", encoding="utf-8")
    with pytest.raises(InputError, match=re.escape(f"{tmp_path / 'a_T.csv'}:3: column 2")):
        command("fit", MATERIALS / "s100.dma.csv", "--shift", tmp_path / "a_T.csv")


ISOTHERM = "{t},{f:g},{e:.5g},{loss:.5g}\n"
OF_A_SET = [(t, f) for t in (10, 20, 30) for f in (0.1, 0.3, 1.0, 3.0, 10.0, 30.0)]


def isotherms(folder: Path, *more: tuple[float, float], header: str = "T [degC],f [Hz],E' [MPa],E'' [MPa]") -> Path:
    """Three isotherms of six rows on a power law, and more rows of temperature and frequency."""
    path = folder / "set.csv"
    rows = [
        ISOTHERM.format(
            t=t,
            f=f,
            e=8.0 * (f * 10.0 ** (0.1 * (20 - t))) ** 0.15,
            loss=1.9 * (f * 10.0 ** (0.1 * (20 - t))) ** 0.15,
        )
        for t, f in [*OF_A_SET, *more]
    ]
    path.write_text(header + "\n" + "".join(rows), encoding="utf-8")
    return path


def test_a_sweep_that_is_there_twice_is_named_by_its_rows_and_left_out(tmp_path: Path) -> None:
    path = isotherms(tmp_path, *[(20, f) for f in (0.1, 0.3, 1.0, 3.0)])
    said = re.escape(f"{path}:20: its rows at 20.00 degC repeat those that begin at {path}:8 digit for digit: delete")
    with pytest.raises(InputError, match=said + ".*--exclude"):
        fit_file(path, request())
    assert fit_file(path, request(exclude=("20-23",))).rows.frequency.size == 18


def test_rows_of_a_strain_sweep_among_isotherms_are_named_and_left_out(tmp_path: Path) -> None:
    """Without a strain column they are repeats of one frequency."""
    path = isotherms(tmp_path, (20, 1.0), (20, 1.0))
    with pytest.raises(
        InputError, match=re.escape(f"{path}:20: the isotherm at 20.00 degC needs >= 3 rows") + ".*--exclude"
    ):
        fit_file(path, request())
    assert fit_file(path, request(exclude=("20-21",))).rows.frequency.size == 18


@pytest.mark.parametrize(
    "names",
    ["D' [1/MPa],D'' [1/MPa]", "J' [1/Pa],J'' [1/Pa]", "storage compliance [1/Pa],loss compliance [1/Pa]"],
)
def test_compliances_are_told_how_to_become_moduli(tmp_path: Path, names: str) -> None:
    with pytest.raises(InputError, match=r"set.csv:1: column 3 .*compliances are not read; give moduli: E' = D'/"):
        read_dma(isotherms(tmp_path, header="T [degC],f [Hz]," + names))


def test_degrees_under_the_name_of_tan_delta_are_guessed(tmp_path: Path) -> None:
    f = np.logspace(-1.0, 1.0, 9)
    with pytest.raises(InputError, match=r"tan delta = 14 is too much; .* name the column 'phase \[deg\]'"):
        read_dma(written(tmp_path, "E' [MPa]; tan delta", f, 8.0 * f**0.15, np.full(9, 14.0)))
