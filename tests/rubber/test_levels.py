"""Files, and strain sweeps, whose moduli are a factor off those beside them."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.fitting.fit_verdict import fit_criteria
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.fitting.levels import LEVEL_LIMIT

ROOT = Path(__file__).parents[2]
ISOTHERMS = ROOT / "examples" / "laboratory" / "isotherms.csv"
TRUTH = runpy.run_path(str(ROOT / "examples" / "07_laboratory.py"))["TRUTH"]
AT = "20 degC"


def write(path: Path, head: str, rows) -> Path:
    path.write_text("\n".join([head, *(";".join(f"{x:.6g}" for x in row) for row in rows)]), encoding="utf-8")
    return path


def moduli(celsius: float, frequency: float, factor: float) -> tuple[float, float]:
    """E' and E'' of the truth times a factor [MPa]."""
    series, omega = TRUTH.series(273.15 + celsius), 2.0 * np.pi * frequency
    return factor * float(series.storage(omega)) / 1e6, factor * float(series.loss(omega)) / 1e6


def sweep(folder: Path, factor: float, letter: str = "E") -> Path:
    """A strain sweep at 20 degC and 10 Hz, times a factor; E' is the truth's at 0.1 %."""
    rows = []
    for strain in np.geomspace(0.01, 10.0, 16):
        storage, loss = moduli(20.0, 10.0, factor)
        rows.append((strain, 10.0, 20.0, storage * (strain / 0.1) ** -0.05, loss))
    return write(folder / "sweep.csv", f"strain [%];f [Hz];T [degC];{letter}' [MPa];{letter}'' [MPa]", rows)


def ramp(folder: Path, factor: float, name: str = "ramp.csv") -> Path:
    rows = [(t, 10.0, *moduli(t, 10.0, factor)) for t in np.arange(-30.0, 41.0, 2.0)]
    return write(folder / name, "Temperature [degC];Frequency [Hz];Storage modulus [MPa];Loss modulus [MPa]", rows)


def fit(*paths: Path, accept=(), letter="E", **more):
    reading = {"letter": letter}
    return fit_file(list(paths), Request("x", AT, replicas=0, reading=reading, accept=frozenset(accept), **more))


def level(fitted):
    return next(one for one in fit_criteria(fitted) if one.name.startswith("strain sweeps beside"))


@pytest.mark.parametrize("factor", [0.9, 1.0, 0.95 * LEVEL_LIMIT])
def test_a_strain_sweep_near_the_master_curve_passes(tmp_path: Path, factor):
    one = level(fit(ISOTHERMS, strain=sweep(tmp_path, factor), reference_strain="0.1 %"))
    # E' of the fit is within 2 % of the truth (tests/test_measured_rows.py)
    assert float(one.calculated.split()[-1]) == pytest.approx(max(factor, 1.0 / factor), rel=0.02)
    assert one.verdict == "pass"


@pytest.mark.parametrize(
    ("factor", "letter", "said"),
    [
        (3.0, "E", r"sweep\.csv: E' of the strain sweep is [23]\.?\d* times .*at 0\.1 %, 20 degC and 10 Hz: .*E and G"),
        (1.0, "G", r"is [23]\.?\d* times .*are its moduli E, taken for G\?.*--moduli E"),
        (1.0 / 3.0, "E", r"is 0\.3\d* times .*are its moduli G, taken for E\?.*--moduli G"),
        (1000.0, "E", "correct the unit of its moduli"),
        (1.7, "E", r"another rubber, temperature or strain.*--accept contradiction"),
    ],
)
def test_a_strain_sweep_off_the_master_curve_is_refused(tmp_path: Path, factor, letter, said):
    path = sweep(tmp_path, factor, letter)
    with pytest.raises(InputError, match=said):
        fit(ISOTHERMS, strain=path, reference_strain="0.1 %")
    accepted = fit(ISOTHERMS, strain=path, reference_strain="0.1 %", accept={"contradiction"})
    assert level(accepted).verdict == "FAIL"
    assert any(one.name == "finding contradiction" and one.verdict == "FAIL" for one in fit_criteria(accepted))


def test_a_sweep_beyond_the_data_is_not_checked(tmp_path: Path):
    path = sweep(tmp_path, 1.0)
    path.write_text(path.read_text(encoding="utf-8").replace(";20;", ";90;"), encoding="utf-8")
    fitted = fit(ISOTHERMS, strain=path, reference_strain="0.1 %")
    assert level(fitted).verdict == "not checked"


def test_the_file_that_stands_off_is_named(tmp_path: Path):
    good, soft = ramp(tmp_path, 1.0), ramp(tmp_path, 1.0 / 3.0, "soft.csv")
    fit(ISOTHERMS, good)
    with pytest.raises(InputError, match=r"ramp\.csv: E' of its rows is [23]\.?\d* times .* taken for G\?.*--moduli E"):
        fit(ISOTHERMS, good, letter="G")
    with pytest.raises(InputError, match=r"soft\.csv: E' of its rows is 0\.3\d* times .*taken for E\?.*--moduli G"):
        fit(ISOTHERMS, good, soft)
    with pytest.raises(InputError, match=r"1\.[67]\d* times .*another rubber"):
        fit(ISOTHERMS, ramp(tmp_path, 1.7))
    fit(ISOTHERMS, ramp(tmp_path, 1.3))
