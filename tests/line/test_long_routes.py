"""Surveyed profiles: as many sections as a survey has, at an effort that grows with their number."""

from __future__ import annotations

import cProfile
import math
import tracemalloc
from pathlib import Path
from typing import Any

import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.models import Conveyor
from conveyor.results.analysis import analyse_studies
from conveyor.spec import load

SPEC = Path(__file__).parent.parent.parent / "examples" / "specs" / "overland.yaml"
ALIKE = 1e-9
"""Of sums of thousands of forces, and contacts read at slightly other loads."""


def divided(parts: int, *, curved: float = 0.0) -> Conveyor:
    """A line of 4 km that rises by 40 m, in equal sections; lifted by a wave of an amplitude [m]."""
    line = load(SPEC)
    length, rise = 4000.0 / parts, 40.0 / parts
    wave = [curved * math.sin(12.0 * math.pi * i / parts) for i in range(parts + 1)]
    sections: list[dict[str, Any]] = [
        {
            "name": f"s{i}",
            "length": f"{length!r} m",
            "lift": f"{rise + wave[i + 1] - wave[i]!r} m",
        }
        for i in range(parts)
    ]
    route = {"sections": sections, "take_up": {"kind": "gravity", "position": "tail"}}
    return line.replace(route=route, cases=[], drive=line.drive.replace(further_drives=[]))


@pytest.mark.parametrize("share", [True, False])
def test_a_straight_line_is_the_same_in_2000_sections(share: bool) -> None:
    """Flexure by sag takes the tension as linear within a section: off by a quarter of its flexure at most."""
    lines = [divided(n) for n in (2, 2000)]
    if share:
        lines = [line.replace(calculation=line.calculation.replace(flexure_share="10 %")) for line in lines]
    whole, parts = (conveyor.analyse(line).balance for line in lines)
    (flexure,) = (force.newtons for force in whole.along if force.key == "flexure")
    nearly = 0.0 if share else 0.25 * float(flexure @ flexure) / whole.tensions.smallest
    assert parts.forces.total == pytest.approx(whole.forces.total, rel=ALIKE, abs=nearly)
    assert parts.tensions.largest == pytest.approx(whole.tensions.largest, rel=ALIKE, abs=nearly)
    assert parts.tensions.smallest == pytest.approx(whole.tensions.smallest, rel=ALIKE, abs=nearly)


def test_the_effort_grows_with_the_number_of_sections() -> None:
    """Calls and memory of ten times the sections: tenfold in the limit, a hundredfold with their square."""

    def effort(parts: int) -> tuple[int, int]:
        line, profile = divided(parts, curved=10.0), cProfile.Profile()
        tracemalloc.start()
        with profile:
            found = conveyor.analyse(line)
            found.contents(analyse_studies(line, found))
        _, memory = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return sum(one.callcount for one in profile.getstats()), memory

    effort(20)
    few, many = effort(40), effort(400)
    assert many[0] < 20.0 * few[0]
    assert many[1] < 20.0 * few[1]


def test_rolls_read_side_by_side_are_those_read_alone() -> None:
    found = conveyor.analyse(divided(40, curved=10.0))
    for rolls in found.contacts.rolls:
        for roll in rolls:
            alone = roll.curve.at(roll.load.peak_line_load)
            for name in (
                "line_load",
                "half_width",
                "penetration",
                "peak_pressure",
                "peak_error",
                "resistance",
            ):
                assert float(getattr(roll.peak, name)) == pytest.approx(float(getattr(alone, name)), rel=1e-11), name
            assert roll.cover_penetration == pytest.approx(
                float(roll.curve.penetration(roll.load.peak_line_load)), rel=1e-11
            )


def test_more_than_20000_sections_are_refused() -> None:
    section = {"name": "s", "length": "1 m"}
    sections = [section | {"name": f"s{i}"} for i in range(20_001)]
    line = load(SPEC)
    with pytest.raises(InputError, match=r"route\.sections: got more than 20000 entries, the most allowed"):
        line.replace(route={"sections": sections})
