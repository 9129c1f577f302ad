"""Libraries: every entry is what the models take, names are found or guessed, a spec goes before an entry."""

from __future__ import annotations

import pytest

from conveyor.errors import InputError
from conveyor.files import libraries
from conveyor.models import Belt, BulkMaterial, Roll
from conveyor.models.library_items import merge_fields, without_entry_fields
from conveyor.pipeline import calculate
from conveyor.remarks.assumptions import roll_assumptions
from conveyor.remarks.part_warnings import part_warnings
from conveyor.report.tables.inputs import input_rows
from conveyor.spec import from_data
from conveyor.units import is_quantity, quantity, si, text

MODELS = {"belts": Belt, "rolls": Roll, "materials": BulkMaterial}
NEEDED = {
    "belts": {
        "width": "1 m",
        "speed": "3 m/s",
        "carcass": {"thickness": "5 mm", "mass": "9 kg/m^2"},
        "top_cover": {"thickness": "5 mm"},
    },
    "rolls": {"diameter": "133 mm", "length": "465 mm"},
    "materials": {"flow": "1000 t/h"},
}
"""What an entry may leave open."""
ENTRIES = [
    pytest.param(library, name, id=f"{library}-{name}")
    for library in MODELS
    for name in libraries.library_entries(library)
]


def built(library, name, compound, **given):
    entry = libraries.library_entry(library, name)
    data = merge_fields(NEEDED[library], entry.fields) | {"listed": name} | given
    if library == "belts":
        data["bottom_cover"] = {"thickness": "4 mm"} | data.get("bottom_cover", {}) | {"compound": compound}
        data["top_cover"] = {"thickness": "5 mm"} | data.get("top_cover", {})
    return MODELS[library].from_data(data)


@pytest.mark.parametrize(("library", "name"), ENTRIES)
def test_every_entry_builds_its_model_and_is_written_as_reports_write(library, name, compound_data):
    made = built(library, name, compound_data)
    for path, value in libraries.flatten_fields(libraries.library_entry(library, name).fields).items():
        held = made
        for part in path.split("."):
            held = getattr(held, part)
        # inputs() tells a library's value by its text
        assert (text(held) if is_quantity(held) else held) == value


@pytest.mark.parametrize("library", ["belts", "rolls", "materials", "spacing"])
def test_every_entry_has_a_source_and_knowledge_of_the_craft_a_range(library):
    for entry in libraries.library_entries(library).values():
        assert entry.source
        assert entry.general_knowledge == ("general knowledge" in entry.source)
        listed = {
            "name",
            *(("diameter", "length", "bearing") if library == "rolls" else ()),
        }  # standard sizes
        assert not entry.general_knowledge or set(entry.range) == set(entry.fields) - listed
        for key, span in entry.range.items():
            low, high = span.split(" to ")
            unit = high.split()[1]
            assert float(low) <= quantity(entry.fields[key]).to(unit).magnitude <= float(high.split()[0])


def test_tables_have_a_row_for_each_entry_and_end_with_the_source():
    tables = (libraries.belts(), libraries.rolls(), libraries.materials(), libraries.spacings())
    for library, table in zip(("belts", "rolls", "materials", "spacing"), tables, strict=True):
        assert list(table.index) == list(libraries.library_entries(library))
        assert list(table.columns[-3:]) == ["note", "general knowledge", "source"]
    assert tables[0].loc["ST4000", "mass"] == "54 kg/m^2"
    assert tables[0].loc["EP1250/4", "carcass.mass"] == "9.1 kg/m^2"
    assert tables[1].loc["159x670", "rotating_mass"] == "12.3 kg"
    assert tables[2].loc["hard coal", "density, range"] == "750 to 1000 kg/m^3"
    assert libraries.widest_spacings() == {"carry": 3.0, "return": 6.0}
    assert tuple(sorted(libraries.ROLL_DIAMETERS)) == libraries.ROLL_DIAMETERS


@pytest.mark.parametrize(
    ("library", "name", "message"),
    [
        (
            "belts",
            "ST160",
            r'"ST160" is not in the library of belts; did you mean "ST1600"\? there are: ST800 \|',
        ),
        ("rolls", "159x466", r'did you mean "159x465"\?'),
        (
            "materials",
            "cheese",
            r'"cheese" is not in the library of materials; there are: hard coal \| lignite',
        ),
        ("materials", "x" * 90, r'"x{80}\.\.\." is not in the library'),
    ],
)
def test_unknown_names_are_refused_with_a_guess(library, name, message):
    with pytest.raises(InputError, match=message):
        libraries.library_entry(library, name)


def test_a_refused_name_is_told_at_its_field(conveyor_data):
    conveyor_data["material"] = {"listed": "hart coal", "flow": "2000 t/h"}
    with pytest.raises(InputError, match=r'^material\.listed: "hart coal" is not in .* did you mean "hard coal"\?'):
        from_data(conveyor_data)


def test_the_spec_goes_before_the_entry_and_the_report_tells_them_apart(conveyor_data):
    conveyor_data["material"] = {"listed": "Hard Coal", "flow": "2000 t/h", "density": "900 kg/m^3"}
    conveyor_data["belt"] |= {"listed": "ST1250", "carcass": {"mass": "12 kg/m^2"}}
    conveyor_data["idlers"]["carry"]["roll"] = {"listed": "159x465", "rotating_mass": "5.2 kg"}
    line = from_data(conveyor_data)
    assert (line.material.name, text(line.material.density)) == ("hard coal", "900 kg/m^3")
    assert si(line.belt.carcass.thickness) == pytest.approx(4.5e-3, rel=1e-14)
    given_by = {field: origin for field, *_, origin in input_rows(line)}
    from_library = {
        "material.name", "material.surcharge_angle", "belt.carcass.kind", "belt.carcass.strength",
        "belt.carcass.thickness", "idlers.carry.roll.diameter", "idlers.carry.roll.length",
    }  # fmt: skip
    assert {field for field, origin in given_by.items() if origin == "library"} == from_library
    assert given_by["material.density"] == given_by["belt.carcass.mass"] == "spec"
    told = " ".join(roll_assumptions(line))
    assert 'material: "hard coal" of the library' in told
    assert 'idlers.carry.roll: "159x465" of the library' in told
    assert "9.1 kg is the whole roll" in told


def test_values_of_the_library_equal_the_same_values_typed(conveyor_data):
    typed = from_data(conveyor_data)
    conveyor_data["idlers"]["carry"]["roll"] = {"listed": "159x465", "rotating_mass": "5.2 kg"}
    listed = from_data(conveyor_data)
    assert listed.idlers.carry.roll.replace(listed=None) == typed.idlers.carry.roll
    again = from_data(listed.as_data())
    assert again == listed


def test_another_name_replaces_what_the_old_one_gave(compound_data):
    coal = BulkMaterial.from_data({"listed": "hard coal", "flow": "1000 t/h", "surcharge_angle": "12 deg"})
    ore = coal.replace(listed="copper ore")
    assert (ore.name, text(ore.density), text(ore.surcharge_angle)) == ("copper ore", "1800 kg/m^3", "12 deg")
    assert text(coal.replace(flow="500 t/h").density) == "850 kg/m^3"
    belt = built("belts", "ST4000", compound_data)
    other = belt.replace(listed="EP630/4")
    assert (text(other.carcass.thickness), text(other.mass), text(other.thickness)) == (
        "4.4 mm",
        "14.73 kg/m^2",
        "11.4 mm",
    )
    with pytest.raises(InputError, match=r"top_cover\.thickness: missing; expected a length"):
        belt.replace(listed="ST2500")


def test_merging_and_taking_off_are_inverse():
    entry = {"mass": "27 kg/m^2", "carcass": {"kind": "EP", "strength": "630 N/mm"}}
    given = {"width": "1 m", "carcass": {"thickness": "4 mm"}}
    assert without_entry_fields(merge_fields(entry, given), entry) == given


def test_general_knowledge_is_warned_of_until_the_spec_gives_it(conveyor_data):
    conveyor_data["material"] = {"listed": "lignite", "flow": "2000 t/h"}
    conveyor_data["route"]["sections"][0]["loaded"] = False
    told = _library_remarks(from_data(conveyor_data))
    assert any('density, surcharge_angle assumed as of "lignite": general knowledge' in line for line in told)
    conveyor_data["material"] |= {"density": "700 kg/m^3", "surcharge_angle": "18 deg"}
    assert not any('"lignite" are general knowledge' in line for line in _library_remarks(from_data(conveyor_data)))


def test_a_listed_mass_under_other_covers_is_warned_of(conveyor_data):
    conveyor_data["belt"]["listed"] = "ST4000"
    conveyor_data["belt"]["carcass"] = {}
    told = _library_remarks(from_data(conveyor_data))
    assert any("belt.mass 54 kg/m^2 is listed for a top_cover of 14 mm, the spec has 6 mm" in line for line in told)


def _library_remarks(line):
    return [said.text() for said in part_warnings(calculate(line))]
