"""Specs drawn from the examples at random: each is answered or refused, and what is answered holds together."""

from __future__ import annotations

from collections import Counter

import pytest

import conveyor
from conveyor.models.fields import with_fields
from tests.robustness.drawn import EXAMPLES, FAULT, drawn, run

_SPECS, _BLOCKS = 150, 10
"""As many of `benchmarks/drawn_specs.py`, which draws 2,000."""


@pytest.mark.parametrize("block", range(_BLOCKS))
def test_a_drawn_spec_is_answered_or_refused_and_its_figures_hold(block: int) -> None:
    endings = {seed: run(seed, whole=seed % 3 == 0) for seed in range(block, _SPECS, _BLOCKS)}
    faults = {seed: ending for seed, ending in endings.items() if ending[1].startswith(FAULT)}
    assert not faults
    counted = Counter(ending for _, ending in endings.values())
    assert counted["answered"] >= 3  # neither too much is changed nor too little
    assert counted["refused"] >= 1


def test_a_seed_is_always_the_same_spec() -> None:
    assert drawn(7) == drawn(7)
    assert len({drawn(seed)[0] for seed in range(100)}) > 95


@pytest.mark.parametrize(
    ("example", "changes"),
    [
        ("transfer", {"ambient.temperature": "-34.8 degC"}),
        (
            "in_plant_us",
            {
                "ambient.temperature": "-20 degC",
                "belt.bottom_cover.thickness": "25 mm",
                "belt.speed": "6 m/s",
            },
        ),
    ],
)
def test_a_cover_that_is_hard_in_the_cold_is_answered(example: str, changes: dict[str, str]) -> None:
    """Layers more than fifty times thicker than their contacts are wide."""
    line = with_fields(conveyor.load(EXAMPLES / f"{example}.yaml"), changes)
    assert conveyor.analyse(line).balance.power.belt > 0.0
