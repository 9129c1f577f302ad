"""Lines of a fit: with one modulus alone placing the isotherms, the other has no scatter and none is written."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import pytest

from conveyor.compound_file import Request, fit_file
from conveyor.report import fitting

ISOTHERMS = Path(__file__).parents[1] / "laboratory" / "files" / "fits" / "stretched_exponential.xlsx"


@pytest.mark.parametrize(("by", "placed"), [("storage", "E'"), ("loss", "E''")])
def test_isotherms_placed_by_one_modulus(by: Literal["storage", "loss"], placed: str) -> None:
    found = fit_file(ISOTHERMS, Request(name="x", by=by, replicas=0))
    (line,) = (line for line in fitting.lines(found) if "overlaps differ" in line)
    assert line.endswith(f"({placed}); it alone placed them")
    assert "(E') and" in line
