"""Lines of a fit: with one modulus alone placing the isotherms, the other has no scatter and none is written."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from conveyor import fitting
from conveyor.compound_file import Request, fit_file
from conveyor.rubber import PronySeries


@pytest.mark.parametrize(("by", "placed"), [("storage", "E'"), ("loss", "E''")])
def test_isotherms_placed_by_one_modulus(tmp_path: Path, by: Literal["storage", "loss"], placed: str) -> None:
    series = PronySeries(2e6, np.logspace(8.0, 5.5, 12), np.logspace(-8.0, 0.0, 12))
    rows = ["temperature_degC,frequency_Hz,storage_Pa,loss_Pa"]
    for celsius, shift in ((0, 2.0), (10, 0.9), (20, 0.0)):
        for f in np.logspace(-1.0, 2.0, 10):
            omega = 2.0 * np.pi * f * 10.0**shift
            rows.append(f"{celsius},{f},{series.storage(omega)},{series.loss(omega)}")
    (tmp_path / "isotherms.csv").write_text("\n".join(rows), encoding="utf-8")
    found = fit_file(tmp_path / "isotherms.csv", Request("x", by=by, replicas=0))
    (line,) = (line for line in fitting.lines(found) if "overlaps differ" in line)
    assert line.endswith(f"({placed}); it alone placed them")
    assert "(E') and" in line
