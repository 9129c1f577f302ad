"""Lines of a fit: what placed the isotherms, resonances, rows that stand off, a vertical shift that is missing."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from conveyor.fitting import summary
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.rubber import PronySeries


@pytest.mark.parametrize(("by", "placed"), [("storage", "E'"), ("loss", "E''")])
def test_isotherms_placed_by_one_modulus(tmp_path: Path, by: Literal["storage", "loss"], placed: str) -> None:
    series = PronySeries(2e6, np.logspace(8.0, 5.5, 12), np.logspace(-8.0, 0.0, 12))
    rows = ["temperature_degC,frequency_Hz,E'_Pa,E''_Pa"]
    for celsius, shift in ((0, 2.0), (10, 0.9), (20, 0.0)):
        for f in np.logspace(-1.0, 2.0, 10):
            omega = 2.0 * np.pi * f * 10.0**shift
            rows.append(f"{celsius},{f},{series.storage(omega)},{series.loss(omega)}")
    (tmp_path / "isotherms.csv").write_text("\n".join(rows), encoding="utf-8")
    found = fit_file(tmp_path / "isotherms.csv", Request("x", by=by, replicas=0))
    (line,) = (line for line in summary.summary_lines(found) if "isotherms differ in their overlaps" in line)
    assert line.endswith(f"({placed}); it alone placed them")
    assert "(E') and" in line


def isotherms(path: Path, vertical: float, resonance: float) -> Path:
    series = PronySeries(2e6, np.logspace(8.0, 5.5, 26), np.logspace(-9.0, 2.0, 26))
    rng = np.random.default_rng(0)
    rows = ["temperature_degC,frequency_Hz,E'_Pa,E''_Pa"]
    for celsius, shift in ((0, 2.0), (10, 0.9), (20, 0.0), (30, -0.8)):
        for f in np.logspace(-1.0, 2.0, 10):
            omega = 2.0 * np.pi * f * 10.0**shift
            b = (1.0 + vertical) ** ((celsius - 20) / 10.0) * np.exp(0.01 * rng.standard_normal(2))
            off = 1.0 + resonance * (f > 99.0)
            rows.append(f"{celsius},{f:.6g},{series.storage(omega) * b[0] * off},{series.loss(omega) * b[1] * off}")
    path.write_text("\n".join(rows), encoding="utf-8")
    return path


def test_a_resonance_is_said(tmp_path: Path) -> None:
    found = fit_file(isotherms(tmp_path / "x.csv", 0.0, 0.5), Request("x", "20 degC", replicas=0))
    (line,) = (line for line in summary.summary_lines(found) if "left out of all isotherms" in line)
    assert "100 Hz" in line
    assert found.rows.curve[0].size == 36
    assert not any("--vertical" in line for line in summary.summary_lines(found))


def test_a_vertical_shift_is_suggested_and_its_lack_is_in_the_band(tmp_path: Path) -> None:
    data = isotherms(tmp_path / "x.csv", 0.1, 0.0)
    found = fit_file(data, Request("x", "20 degC"))
    (line,) = (line for line in summary.summary_lines(found) if "--vertical" in line)
    assert "a vertical shift of up to" in line
    assert found.compound.prony.band is not None
    assert found.compound.prony.band.log10_b_t is not None
    taken = fit_file(data, Request("x", "20 degC", vertical=True, replicas=0))
    assert not any("--vertical" in line for line in summary.summary_lines(taken))


def test_a_row_that_stands_off_is_named(tmp_path: Path) -> None:
    series = PronySeries(2e6, np.logspace(8.0, 5.5, 26), np.logspace(-9.0, 2.0, 26))
    f = np.logspace(-1.0, 5.0, 40)
    noise = np.exp(0.01 * np.random.default_rng(0).standard_normal((2, 40)))
    omega = 2.0 * np.pi * f
    e1, e2 = series.storage(omega) * noise[0], series.loss(omega) * noise[1]
    e2[20] *= 2.0
    rows = [f"{a},{b},{c}" for a, b, c in zip(f, e1, e2, strict=True)]
    (tmp_path / "x.csv").write_text("\n".join(["frequency_Hz,E'_Pa,E''_Pa", *rows]), encoding="utf-8")
    found = fit_file(tmp_path / "x.csv", Request("x", "20 degC", replicas=0))
    (line,) = (line for line in summary.summary_lines(found) if "stands off" in line)
    assert "E'' of 1 rows" in line
    assert f"{f[20]:.3g} Hz" in line
