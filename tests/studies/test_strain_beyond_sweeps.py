"""Strain sweeps that end below the working strain: an answer, flagged, and a range that holds the whole sweep's."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor import shelf
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.variants import with_compound
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load
from conveyor.studies.input_ranges import _vary_rubber

SPEC = Path(__file__).parents[2] / "examples" / "specs" / "overland.yaml"


def cut(compound: RubberCompound, largest: float) -> RubberCompound:
    """The compound with its sweeps up to a strain [%]."""
    known = compound.strain_dependence
    assert known is not None
    sweeps = [
        sweep.replace(**{
            name: getattr(sweep, name)[: sum(strain <= largest for strain in sweep.strain)]
            for name in ("strain", "storage", "loss")
        })
        for sweep in known.sweeps
    ]  # fmt: skip
    return compound.replace(strain_dependence=known.replace(sweeps=tuple(sweeps)))


def calculated(conveyor: Conveyor) -> CalculatedConveyor:
    found = calculate(conveyor)
    assert isinstance(found, CalculatedConveyor)
    return found


@pytest.mark.parametrize("name", ["s100", "s120"])
def test_the_range_of_a_short_sweep_holds_the_whole_one(name: str) -> None:
    whole = with_compound(load(SPEC), shelf.compound(name), "bottom")
    short = with_compound(whole, cut(shelf.compound(name), 0.6), "bottom")
    known, held = calculated(whole), calculated(short)
    assert not any("sweeps end at" in said.words for said in analysis_warnings(known, ()))
    flagged = [said.words for said in analysis_warnings(held, ()) if "sweeps end at" in said.words]
    assert flagged
    assert all("calculation: {{strain: off}}" in words for words in flagged)
    ends = next(v for v in _vary_rubber(held, []) if v.name.startswith("largest strain")).variants
    low, high = sorted(calculated(end.conveyor).contacts.covers["carry"].strain.storage_factor for end in ends)
    true = known.contacts.covers["carry"].strain
    assert true is not None
    # softer rubber is strained more, so both ends are at strains of their own
    assert low <= true.storage_factor <= high
    assert not any(v.name.startswith("largest strain") for v in _vary_rubber(known, []))
