"""A master curve laid without a vertical shift, of an entropic network whose truth is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.fitting import fit_verdict, summary
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.rubber import Arrhenius, PronySeries, shift_series
from tests.command_line import run

MATERIALS = Path(__file__).parent.parent / "materials"
REFERENCE = 293.15
TIMES = np.logspace(-12.0, 6.0, 109)
TRUTH = PronySeries(3e6, 1.1e5 * TIMES[TIMES > 1e-11] ** -0.2, TIMES[TIMES > 1e-11])
LAW = Arrhenius(250e3, REFERENCE)
TEMPERATURES = np.arange(-16.0, 45.0, 6.0) + 273.15
MEASURED = np.logspace(0.0, 1.0, 6)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Isotherms of an entropic rubber, moved sideways alone, and their shift factors."""
    folder = tmp_path_factory.mktemp("entropic")
    lines, omega = [], 2.0 * np.pi * MEASURED
    for t in TEMPERATURES:
        a = 10.0 ** float(LAW.log10_a_T(t))
        series = shift_series(TRUTH, LAW, t, b_T=t / REFERENCE)
        lines += [
            f"{f:.9g},{e1:.9g},{e2:.9g}"
            for f, e1, e2 in zip(MEASURED * a, series.storage(omega), series.loss(omega), strict=True)
        ]
    curve, shifts = folder / "curve.csv", folder / "shifts.csv"
    curve.write_text("\n".join(["frequency_Hz,E'_Pa,E''_Pa", *lines, ""]), encoding="utf-8")
    rows = [f"{t - 273.15:.6g},{float(LAW.log10_a_T(t)):.9g}" for t in TEMPERATURES]
    shifts.write_text("\n".join(["temperature_degC,log10_aT", *rows, ""]), encoding="utf-8")
    return curve, shifts


def found(files: tuple[Path, Path], **changes):
    curve, shifts = files
    return fit_file(curve, Request("x", "20 degC", shift=shifts, **({"replicas": 0} | changes)))


def test_it_is_suggested_and_mends_the_contradiction(files: tuple[Path, Path]) -> None:
    """T/T_ref is 0.88 to 1.08, which no positive spectrum has; with it 0.15 decades a kelvin leave 3 K, 1 %."""
    plain, mended = found(files), found(files, vertical=True)
    assert plain.entropic_floor == pytest.approx(mended.fit.consistency_floor, rel=0.1)
    assert mended.fit.consistency_floor < 0.01 < 0.5 * plain.fit.consistency_floor
    omega = 2.0 * np.pi * np.geomspace(*mended.fit.window, 40)
    for model, true in ((mended.fit.series.storage, TRUTH.storage), (mended.fit.series.loss, TRUTH.loss)):
        assert np.max(np.abs(model(omega) / true(omega) - 1.0)) < 0.03
    compound = mended.compound
    assert compound.shift.vertical(273.15) == pytest.approx(273.15 / REFERENCE, rel=1e-4)
    cold = shift_series(TRUTH, LAW, 263.15, b_T=263.15 / REFERENCE)
    w = 2.0 * np.pi * 100.0
    assert float(compound.series(263.15).storage(w)) == pytest.approx(float(cold.storage(w)), rel=0.03)


def test_a_curve_without_one_gets_no_advice(tmp_path: Path) -> None:
    shifts = tmp_path / "shifts.csv"
    shifts.write_text("temperature_degC,log10_aT\n0,2.2\n20,0\n40,-1.8\n", encoding="utf-8")
    f = np.logspace(-4.0, 6.0, 61)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal((2, f.size)))
    moduli = np.array([TRUTH.storage(2.0 * np.pi * f), TRUTH.loss(2.0 * np.pi * f)]) * noise
    curve = tmp_path / "curve.csv"
    lines = [f"{a:.9g},{b:.9g},{c:.9g}" for a, b, c in zip(f, *moduli, strict=True)]
    curve.write_text("\n".join(["frequency_Hz,E'_Pa,E''_Pa", *lines, ""]), encoding="utf-8")
    assert found((curve, shifts)).entropic_floor is None


def test_curves_that_contradict_themselves_say_so() -> None:
    """S120 (measured): 6.5 % left without, 3.0 % with; its ends off by 12.6 % of E', which no spectrum mends."""
    s120 = (MATERIALS / "s120.dma.csv", MATERIALS / "s120.shift.csv")
    plain = fit_file(s120[0], Request("s120", shift=s120[1], replicas=0))
    assert plain.entropic_floor == pytest.approx(0.030, abs=0.001)
    assert any("it would leave 3.0 %: try --vertical" in line for line in summary.summary_lines(plain))
    ends = next(one for one in fit_verdict.fit_criteria(plain) if one.name == "ends of the window")
    assert (ends.verdict, "contradict" in ends.why) == ("FAIL", True)
    mended = fit_file(s120[0], Request("s120", shift=s120[1], replicas=0, vertical=True))
    assert mended.entropic_floor is None
    assert next(one for one in fit_verdict.fit_criteria(mended) if one.name == "ends of the window").verdict == "pass"


def test_what_cannot_be_told_is_refused(files: tuple[Path, Path], tmp_path: Path) -> None:
    curve, shifts = files
    with pytest.raises(InputError, match=r"curve\.csv: --vertical: .* give them with --shift"):
        fit_file(curve, Request("x", "20 degC", vertical=True))
    head, *rows = shifts.read_text(encoding="utf-8").splitlines()
    both = tmp_path / "both.csv"
    both.write_text("\n".join([f"{head},log10_bT", *(f"{row},0.01" for row in rows), ""]), encoding="utf-8")
    with pytest.raises(InputError, match=r"both\.csv: has vertical shifts"):
        fit_file(curve, Request("x", "20 degC", shift=both, vertical=True))


def test_a_verdict_that_fails_is_a_result(tmp_path: Path) -> None:
    """Exit code 0, as of `conveyor power` with checks that fail; compound and workbook are written."""
    from openpyxl import load_workbook

    book, compound = tmp_path / "s120.xlsx", tmp_path / "s120.yaml"
    done = run("fit", "materials/s120.dma.csv", "--shift", "materials/s120.shift.csv", "-o", book, "-o", compound)
    assert done.returncode == 0, done.stderr
    assert "FAIL  ends of the window" in done.stdout
    sheets = load_workbook(book)
    assert sheets.sheetnames == [
        "Verdict",
        "Shifts",
        "Files",
        "Master curve",
        "Series",
        "Read and done",
        "Glossary",
    ]
    assert [sheets["Verdict"].cell(2, k).value for k in (1, 4)] == ["criterion", "verdict"]
    words = [row[0].value for row in sheets["Verdict"].iter_rows()]
    assert "ends of the window" in words
    assert sheets["Master curve"].max_row == 84 + 2
    assert sheets["Series"].cell(3, 3).value == pytest.approx(
        shelf.read_compound(compound).prony.equilibrium.magnitude, rel=1e-9
    )
