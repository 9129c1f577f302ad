"""A figure that slipped by a unit is told, one that means a share is answered with the number."""

from __future__ import annotations

from pathlib import Path

import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.models.fields import with_fields

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("material.flow", "4 t/h", "of what the belt holds to its edges: its unit?"),
        ("drive.installed_power", "1600 MW", "times what the conveyor takes or gives: its unit?"),
        ("idlers.carry.roll.rotating_mass", "60 kg", "a solid steel roll of its size has"),
    ],
)
def test_an_implausible_size_is_told(field, value, words):
    line = conveyor.load(SPECS / "overland.yaml")
    assert not [told for told in conveyor.analyse(line).warnings if words in told]
    slipped = conveyor.analyse(with_fields(line, {field: value}))
    assert [told for told in slipped.warnings if words in told]


def test_a_percentage_of_a_friction_is_answered_with_its_number():
    line = conveyor.load(SPECS / "overland.yaml")
    with pytest.raises(InputError, match=r'expected a number, got "35 %"; write 0\.35'):
        line.replace(drive=line.drive.as_data() | {"friction": "35 %"})


def test_a_bulk_lighter_than_any_is_refused():
    line = conveyor.load(SPECS / "overland.yaml")
    with pytest.raises(InputError, match=r"0\.9 t/m\^3"):
        line.replace(material=line.material.as_data() | {"density": "0.9"})
