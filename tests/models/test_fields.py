"""Fields by their paths: changed, read, refused with the path."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError
from conveyor.models import Conveyor
from conveyor.models.conveyor import CHECKS
from conveyor.models.fields import field_value, with_fields
from conveyor.reuse import ReuseCache
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
    assert si(field_value(made, "belt.speed")) == pytest.approx(5.5)
    assert si(field_value(made, "idlers.return.spacing")) == pytest.approx(4.0)
    assert made.route.sections[2].rise < line.route.sections[2].rise
    assert si(made.route.sections[3].length) == pytest.approx(800.0)
    data = line.as_data()
    data["belt"]["speed"], data["idlers"]["return"]["spacing"] = "5.5 m/s", "4 m"
    data["route"]["sections"][2]["slope"], data["route"]["sections"][3]["length"] = "2 deg", "800 m"
    data["drive"]["start_factor"] = 1.2
    assert made == conveyor.spec.from_data(data)


def test_refusals_name_a_field_as_specs_do(line):
    for path, value in (("idlers.return.spacing", "500 m"), ("idlers.return.roll.diameter", "5 m")):
        with pytest.raises(InputError, match=rf"^{path}: got {value}"):
            with_fields(line, {path: value})
    with pytest.raises(InputError, match=r"^idlers\.return\.foo: no such field"):
        with_fields(line, {"idlers.return.foo": "1 m"})


def test_a_part_that_was_not_given_is_made(line):
    without = line.replace(operation=None)
    made = with_fields(without, {"operation.hours_per_year": "4000 h", "operation.price": "0.1 EUR/kWh"})
    assert made.operation.price.amount == pytest.approx(0.1)
    assert field_value(without, "operation.price") is None


def test_a_compound_is_looked_up_by_name(line):
    made = with_fields(line, {"belt.bottom_cover.compound": "s100"}, resolve=shelf.compound)
    assert made.carry_compound == shelf.compound("s100")


def test_what_two_variants_share_is_the_very_same(line):
    kept = ReuseCache()
    slow, fast = (
        with_fields(line, {"belt.speed": speed, "idlers.carry.spacing": "1 m"}, kept=kept)
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
        ({"belt.speed": "1 m/s"}, r"^material\.flow: .* at 1 m/s"),
    ],
)
def test_what_leads_nowhere_is_refused_with_its_path(line, changes, said):
    with pytest.raises(InputError, match=said):
        with_fields(line, changes)


def test_parts_that_are_known_are_checked_against_each_other_all_the_same(line):
    def made(changes, **known):
        try:
            return with_fields(line, changes, **known).as_data()
        except InputError as error:
            return str(error)

    kept = ReuseCache()
    fields = {
        "belt.speed": ("5.5 m/s", "3 m/s", "5 kg"),
        "material.flow": ("2000 t/h", "6000 t/h"),
        "idlers.carry.roll.length": ("300 mm", "530 mm"),
        "route.feeding.speed": ("2 m/s", "4 m/s"),
    }
    points = [dict(zip(fields, values, strict=True)) for values in product(*fields.values())]
    found = [made(point, kept=kept) for point in points]
    assert found == [made(point) for point in points]
    assert {type(one) for one in found} == {dict, str}
    assert found == [made(point, kept=kept) for point in points]


class _Only:
    """Some fields of a conveyor, and what follows from them."""

    def __init__(self, conveyor, names):
        self._conveyor, self._names = conveyor, names

    def __getattr__(self, name):
        if name in Conveyor.model_fields:
            assert name in self._names, f"reads {name}, too"
            return getattr(self._conveyor, name)
        return getattr(Conveyor, name).fget(self)


@pytest.mark.parametrize("spec", sorted(SPECS.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_check_reads_the_fields_that_it_names(spec):
    given = conveyor.load(spec)
    for check, reads in CHECKS.items():
        assert list(check(_Only(given, reads))) == []


def test_every_change_that_is_refused_is_named_at_once(line):
    changes = {
        "belt.speed": "50 m/s",
        "belt.width": "2 kg",
        "belt.top_cover.thickness": "-1 mm",
        "idlers.carry.spacing": "2 kg",
        "idlers.carry.spacin": "1 m",
        "route.sections[0].length": "1 kg",
        "route.sections.nowhere.lift": "1 m",
        "a b.": 1,
    }
    with pytest.raises(InputError, match="a b") as refused:
        with_fields(line, changes)
    assert [said.partition(":")[0] for said in str(refused.value).splitlines()] == [
        "a b.",
        "belt.top_cover.thickness",
        "belt.width",
        "belt.speed",
        "idlers.carry.spacin",
        "idlers.carry.spacing",
        "route.sections[0].length",
        "route.sections",
    ]


def test_a_refused_field_is_not_held_against_those_that_it_would_fit(line):
    """The angle alone would not fit the one roll that stays; with the number that is refused it might."""
    with pytest.raises(InputError, match=r"^idlers\.carry\.rolls: ") as refused:
        with_fields(line, {"idlers.carry.rolls": "many", "idlers.carry.trough_angle": "20 deg"})
    assert len(str(refused.value).splitlines()) == 1
