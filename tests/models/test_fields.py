"""Fields by their paths: changed, read, refused with the path."""

from __future__ import annotations

from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError
from conveyor.models.fields import field, with_fields
from conveyor.units import si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "overland.yaml")


def test_a_changed_field_is_that_of_a_spec_written_so(line):
    made = with_fields(
        line,
        {
            "belt.speed": "5.5 m/s",
            "idlers.return.spacing": "4 m",
            "route.sections.first climb.slope": "2 deg",
            "route.sections[3].length": "800 m",
            "drive.start_factor": 1.2,
        },
    )
    assert si(field(made, "belt.speed")) == pytest.approx(5.5)
    assert si(field(made, "idlers.return.spacing")) == pytest.approx(4.0)
    assert made.route.sections[2].rise < line.route.sections[2].rise
    assert si(made.route.sections[3].length) == pytest.approx(800.0)
    data = line.as_data()
    data["belt"]["speed"], data["idlers"]["return"]["spacing"] = "5.5 m/s", "4 m"
    data["route"]["sections"][2]["slope"], data["route"]["sections"][3]["length"] = "2 deg", "800 m"
    data["drive"]["start_factor"] = 1.2
    assert made == conveyor.spec.from_data(data)


def test_a_part_that_was_not_given_is_made(line):
    without = line.replace(operation=None)
    made = with_fields(without, {"operation.hours_per_year": "4000 h", "operation.price": "0.1 EUR/kWh"})
    assert made.operation.price.amount == pytest.approx(0.1)
    assert field(without, "operation.price") is None


def test_a_compound_is_looked_up_by_name(line):
    made = with_fields(line, {"belt.bottom_cover.compound": "s100"}, resolve=shelf.compound)
    assert made.carry_compound == shelf.compound("s100")


def test_what_two_variants_share_is_the_very_same(line):
    known = {}
    slow, fast = (
        with_fields(line, {"belt.speed": speed, "idlers.carry.spacing": "1 m"}, known=known)
        for speed in ("5 m/s", "6 m/s")
    )
    assert slow.idlers is fast.idlers
    assert slow.route is fast.route is line.route
    assert slow.belt is not fast.belt


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"belt.sped": "5 m/s"}, r"^belt\.sped: no such field; did you mean speed\?"),
        ({"belt.speed": "5 kg"}, r'^belt\.speed: got "5 kg" \(a mass\), expected a speed'),
        ({"belt.speed.x": 1}, r"^belt\.speed: is a single value"),
        ({"route.sections[99].lift": "1 m"}, r"^route\.sections: has no item 99; it has loading, "),
        ({"belt..speed": 1}, r"no path of a field"),
        ({"belt": {}, "belt.speed": "5 m/s"}, r"a part of it is changed as a whole"),
        ({"belt.speed": "5 m/s", "belt": {}}, r"changed twice, or a field below it"),
        ({"belt.speed": "3 m/s"}, r"^material\.flow: .* at 3 m/s"),
    ],
)
def test_what_leads_nowhere_is_refused_with_its_path(line, changes, said):
    with pytest.raises(InputError, match=said):
        with_fields(line, changes)
