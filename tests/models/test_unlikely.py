"""What hardly anybody means is asked about; what examples and the shelf have is not."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor.errors import InputError
from conveyor.models.fields import with_fields
from conveyor.models.plausibility import implausible_inputs
from conveyor.spec import load

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
PUBLISHED = Path(__file__).parent.parent / "validation" / "conveyors"


@pytest.mark.parametrize("path", sorted([*SPECS.glob("*.yaml"), *PUBLISHED.glob("*.yaml")]), ids=lambda path: path.stem)
def test_nothing_is_asked_about_examples_and_published_conveyors(path):
    assert list(implausible_inputs(load(path))) == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"material.density": "14 t/m^3"},
            "material.density 14 t/m^3: no bulk that belts carry is heavier than 312 lb/ft³",
        ),
        ({"material.flow": "1000 tph"}, "tph are metric tonnes per hour, 1,100 stph; short tons"),
        ({"material.flow": "1000 tph", "report.units": "SI"}, "tph are metric tonnes per hour"),
        ({"drive.efficiency": "9.4 %"}, "drive.efficiency 9.4 %: 91 % of the power is lost"),
        (
            {"idlers.carry.roll.length": "30 in"},
            "idlers.carry: 3 x 30 in side by side are 1.88 times as wide as the belt",
        ),
        ({"idlers.return.roll.diameter": "2.4 in"}, "idlers.return: its rolls turn at 955 rpm"),
        ({"belt.mass": "16 lb/ft"}, "belt.mass leaves 0.261 lb/ft² for the carcass of"),
        ({"belt.mass": "24 lb/ft"}, "is it per area or per length"),
        (
            {"belt.mass": None, "belt.carcass.mass": "2.7 lb/ft^2"},
            "belt.carcass.mass: 2.7 lb/ft² for the carcass of",
        ),
    ],
)
def test_what_is_hardly_meant_is_asked_about(changes, words):
    made = with_fields(load(SPECS / "in_plant_us.yaml"), changes)
    assert [said for one in implausible_inputs(made) if words in (said := one.text("US"))], [
        one.text("US") for one in implausible_inputs(made)
    ]


def test_tonnes_are_no_question_in_a_metric_report():
    assert list(implausible_inputs(with_fields(load(SPECS / "overland.yaml"), {"material.flow": "2000 tph"}))) == []


def test_a_belt_too_small_for_metric_tonnes_says_that_tph_are_metric():
    with pytest.raises(InputError, match=r"needs a cross-section .*; tph are metric tonnes per hour, short tons"):
        with_fields(load(SPECS / "in_plant_us.yaml"), {"material.flow": "9000 tph"})
