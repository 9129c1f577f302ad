"""A maker's list from the empty form to a calculated conveyor, and what is refused on the way."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from openpyxl import load_workbook

import conveyor
from conveyor.errors import InputError
from conveyor.files.libraries import flatten_fields
from conveyor.forms.maker_list_reader import LIST_FORMS, add_maker_list, read_maker_list
from conveyor.line.line import Line
from conveyor.models.maker_lists import MAKER_KINDS
from conveyor.pipeline import calculate
from conveyor.report.tables.document_tables import identity_table
from conveyor.spec import dump
from conveyor.starter.maker_list_form import write_maker_list_form
from conveyor.units import si
from tests.command_line import run
from tests.template.test_hostile import edit

SPECS = Path(__file__).parents[2] / "examples" / "specs"
ITEMS: list[tuple[str, dict[str, Any]]] = [
    ("Rolls", {"name": "R-159-465", "source": "list of X, p. 12", "diameter": 159, "length": 465, "rotating_mass": 8.4,
               "drag": 1.9, "bearing.dynamic_rating": 22.5, "bearing.distance": 525}),
    ("Belts", {"name": "EP630/4 5+2", "source": "list of Y, p. 3", "carcass.kind": "EP", "carcass.strength": 630,
               "carcass.plies": 4, "carcass.thickness": 4.8, "carcass.mass": 6.1,
               "top_cover.thickness": 5, "bottom_cover.thickness": 2, "note": "from stock"}),
    ("Pulleys", {"name": "P800", "source": "list of P", "diameter": 800, "shaft_diameter": 160, "mass": 1400}),
    ("Motors", {"name": "M315", "source": "list of Z, p. 9", "installed_power": 315, "motor_speed": 1488,
                "inertia": 5.2, "efficiency": 96}),
    ("Gearboxes", {"name": "G20", "source": "list of Z, p. 19", "gear_ratio": 20.1, "efficiency": 97}),
    ("Backstops", {"name": "BS40", "source": "list of Z, p. 30", "backstop_torque": 40}),
    ("Brakes", {"name": "ED 630", "source": "list of B, p. 2", "brake_torque": 1.2, "brake_shaft": "motor"}),
]  # fmt: skip


def filled(folder: Path, items: list[tuple[str, dict[str, Any]]], name: str = "list.xlsx") -> Path:
    """The empty form with items filled in, a row each."""
    path = write_maker_list_form(folder / name)
    book = load_workbook(path)
    rows: dict[str, int] = {}
    for sheet, values in items:
        heads = {str(cell.value).split(" [")[0]: cell.column for cell in book[sheet][1]}
        rows[sheet] = rows.get(sheet, 1) + 1
        for field, value in values.items():
            book[sheet].cell(rows[sheet], heads[field]).value = value
    book.save(path)
    return path


def spec_of(folder: Path, **changes: Any) -> Path:
    """The overland spec without its carry roll and drive, which the list gives."""
    data = conveyor.load(SPECS / "overland.yaml").as_data()
    data["idlers"]["carry"]["roll"] = {"listed": "r-159-465"}
    data["drive"] = {"wrap_angle": "210 deg", "friction": 0.35, "motors": 4, "listed": ["M315", "G20", "BS40"],
                     "start_factor": 1.3} | changes  # fmt: skip
    path = folder / "spec.json"
    path.write_text(json.dumps(data, default=str), encoding="utf-8")
    return path


def test_the_form_has_every_column_with_its_unit(tmp_path):
    book = load_workbook(write_maker_list_form(tmp_path / "form.xlsx"))
    assert book.sheetnames == ["Columns", *(kind.capitalize() for kind in MAKER_KINDS)]
    for kind, form in LIST_FORMS.items():
        heads = [cell.value for cell in book[kind.capitalize()][1]]
        assert heads == ["name", "source", *(f"{p} [{u}]" if u else p for p, u in form.columns.items()), "note"]


def test_a_list_is_read_kept_and_found_by_specs(tmp_path):
    kept = add_maker_list(filled(tmp_path, ITEMS), tmp_path / "conveyor-library")
    assert kept == tmp_path / "conveyor-library" / "list.yaml"
    line = conveyor.load(spec_of(tmp_path))
    roll = line.idlers.carry.roll
    assert (si(roll.diameter), si(roll.drag), si(roll.bearing.dynamic_rating)) == pytest.approx((0.159, 1.9, 22500.0))
    drive = line.drive
    # powers and inertias of a list are those of one motor, of a drive those of all
    assert si(drive.installed_power) == pytest.approx(4 * 315e3)
    assert si(drive.inertia) == pytest.approx(4 * 5.2)
    assert si(drive.backstop_torque) == pytest.approx(40e3)
    found = calculate(line).balance.power
    assert found.motor == pytest.approx(found.belt / 0.97, rel=1e-12)
    assert found.mains == pytest.approx(found.motor / 0.96, rel=1e-12)
    (tmp_path / "deep" / "er").mkdir(parents=True)  # from a folder below the project's
    assert conveyor.load(spec_of(tmp_path / "deep" / "er")).idlers.carry.roll.diameter == roll.diameter
    said = " ".join(conveyor.analyse(line).to_dict()["assumptions"])
    assert '"R-159-465" of the library where the spec gives nothing (list of X, p. 12)' in said


@pytest.mark.parametrize("kind", ["EP", "solid woven", "PVC solid woven", "PVG solid woven"])
def test_a_belt_is_said_with_its_plies_and_solid_woven_ones_are_calculated_alike(tmp_path, kind):
    belt = ITEMS[1][1] | {"carcass.kind": kind}
    add_maker_list(filled(tmp_path, [("Belts", belt)]), tmp_path / "conveyor-library")
    spec = (SPECS / "slider.yaml").read_text(encoding="utf-8")
    carcass = spec[spec.index("  carcass:") :].split("\n")[0]
    path = tmp_path / "spec.yaml"
    path.write_text(spec.replace(carcass, "  listed: EP630/4 5+2"), encoding="utf-8")
    line = conveyor.load(path)
    said = identity_table(line, "SI")
    assert {row.label: row.value for row in said.rows}["belt"] == f"{kind}, 4 plies, breaking 630 N/mm"
    plain = "solid woven" if "woven" in kind else kind
    same = line.replace(belt=line.belt.replace(listed=None, carcass=line.belt.carcass.replace(kind=plain, plies=None)))
    assert calculate(line).balance.power == calculate(same).balance.power


def test_a_spec_that_was_read_needs_no_list(tmp_path):
    add_maker_list(filled(tmp_path, ITEMS), tmp_path / "conveyor-library")
    line = conveyor.load(spec_of(tmp_path))
    elsewhere = tmp_path.parent / f"{tmp_path.name}-elsewhere"
    elsewhere.mkdir()
    (elsewhere / "copy.yaml").write_text(dump(line), encoding="utf-8")
    assert conveyor.load(elsewhere / "copy.yaml") == line


def test_what_the_spec_gives_goes_before_the_list(tmp_path):
    add_maker_list(filled(tmp_path, ITEMS), tmp_path / "conveyor-library")
    line = conveyor.load(spec_of(tmp_path, installed_power="1600 kW", efficiency="90 %"))
    assert si(line.drive.installed_power) == pytest.approx(1600e3)
    assert si(line.drive.efficiency) == pytest.approx(0.9)


@pytest.mark.parametrize(
    ("own", "force"),
    [
        ({}, 1200.0 * 20.1 / 0.5),  # 1.2 kN m at the motor's shaft, ratio 20.1, pulley of 1 m
        ({"brake_force": "30 kN"}, 30e3),
        ({"brake_torque": "60 kN*m"}, 60e3 / 0.5),  # at the pulley: the shaft of the list is not that of the spec's
    ],
)
def test_a_brake_at_the_motors_shaft_acts_by_the_ratio(tmp_path, own, force):
    add_maker_list(filled(tmp_path, ITEMS), tmp_path / "conveyor-library")
    parts = ["M315", "G20", "BS40", "ED 630"]
    line = Line.of(conveyor.load(spec_of(tmp_path, listed=parts, pulley_diameter="1 m", **own)))
    assert line.drives[0].brake == pytest.approx(force)


def test_added_again_it_replaces_its_items(tmp_path):
    folder = tmp_path / "conveyor-library"
    add_maker_list(filled(tmp_path, ITEMS), folder)
    heavier = [("Rolls", ITEMS[0][1] | {"rotating_mass": 9.9})]
    add_maker_list(filled(tmp_path, heavier), folder)
    (item,) = read_maker_list(tmp_path / "list.xlsx").items
    assert flatten_fields(item.fields)["rotating_mass"] == "9.9 kg"
    with pytest.raises(InputError, match=r'other\.xlsx: roll "R-159-465" is in .*list\.yaml, too; rename one'):
        add_maker_list(filled(tmp_path, heavier, "other.xlsx"), folder)


def test_a_new_edition_under_another_name_is_one_line(tmp_path):
    folder = tmp_path / "conveyor-library"
    add_maker_list(filled(tmp_path, ITEMS), folder)
    with pytest.raises(InputError) as refused:
        add_maker_list(filled(tmp_path, ITEMS, "edition 2.xlsx"), folder)
    (line,) = str(refused.value).splitlines()
    assert f'{len(ITEMS)} items, roll "R-159-465" the first, are in {folder / "list.yaml"}, too' in line
    assert line.endswith("conveyor library remove list")


@pytest.mark.parametrize(
    ("sheet", "changes", "says"),
    [
        ("Rolls", {"diameter": None}, "Rolls!C2 diameter: is empty; every item has it: fill it in"),
        ("Rolls", {"diameter": "thick"}, 'Rolls!C2 diameter: expected a length such as "120 mm", got "thick mm"'),
        ("Rolls", {"diameter": -159}, "Rolls!C2 diameter: got -159 mm"),
        ("Rolls", {"diameter": "=1+1"}, "Rolls!C2 diameter: a formula without a stored value"),
        ("Rolls", {"diameter": "6 in"}, 'got "6 in" beside the unit "mm" of its cell or heading; give the'),
        (
            "Pulleys",
            {"shaft_steel": "42CrMo4"},
            'Pulleys!J2 shaft_steel: got "42CrMo4": of the steels of CEMA B105.1, whose strengths are used, C4140 is',
        ),
        ("Rolls", {"source": None}, "Rolls!B2 source: is empty; every item has it: fill it in"),
        ("Rolls", {"name": "159x465"}, 'Rolls!A2 name: got "159x465", which the package\'s own library has'),
        ("Rolls", {"bearing.distance": None}, "bearing.distance: missing"),
        ("Belts", {"carcass.kind": "wool"}, "Belts!C2 carcass.kind: got"),
        ("Belts", {"carcass.plies": 0}, "Belts!D2 carcass.plies: got 0, allowed: >= 1"),
        ("Belts", {"carcass.plies": 3.5}, "Belts!D2 carcass.plies: expected a whole number, got 3.5"),
        ("Belts", {"carcass.plies": "four"}, 'Belts!D2 carcass.plies: expected a whole number, got "four"'),
        ("Belts", {"carcass.kind": "steel cord"}, "Belts!D2 carcass.plies: got 4, but cords of steel (kind) are no"),
        ("Motors", {"efficiency": 105}, "Motors!F2 efficiency: got 105 %"),
        ("Brakes", {"brake_torque": None}, "Brakes!C2 brake_force: is empty; every item has it or brake_torque"),
        ("Brakes", {"brake_force": 10}, "Brakes!D2 brake_torque: got 1.2 kN*m beside brake_force 10 kN; give one of"),
        ("Brakes", {"brake_torque": None, "brake_force": 10}, "brake_torque: missing: brake_shaft is given"),
    ],
)
def test_a_wrong_cell_is_refused_by_its_place(tmp_path, sheet, changes, says):
    values = next(values for name, values in ITEMS if name == sheet)
    with pytest.raises(InputError) as refused:
        add_maker_list(filled(tmp_path, [(sheet, values | changes)]), tmp_path / "conveyor-library")
    assert says in str(refused.value)
    assert str(refused.value).startswith(str(tmp_path / "list.xlsx"))
    assert not (tmp_path / "conveyor-library").exists()


@pytest.mark.parametrize(
    ("heading", "says"),
    [
        ("diameter", 'has no unit; write it behind the field, such as "diameter [mm]"'),
        ("colour", 'got "colour", which no figure or check uses; columns are name, source, diameter,'),
        ("note [mm]", 'got the unit "mm" of a field that has none'),
        ("length [mm]", "is there twice; remove one column"),
    ],
)
def test_a_wrong_heading_is_refused(tmp_path, heading, says):
    path = filled(tmp_path, ITEMS[:1])
    book = load_workbook(path)
    book["Rolls"].cell(1, 3).value = heading
    book["Rolls"].delete_cols(book["Rolls"].max_column)  # the note
    book.save(path)
    with pytest.raises(InputError) as refused:
        read_maker_list(path)
    assert says in str(refused.value)


def test_units_of_the_heading_are_those_of_the_column(tmp_path):
    path = filled(tmp_path, ITEMS[:1])
    book = load_workbook(path)
    book["Rolls"].cell(1, 3).value, book["Rolls"].cell(2, 3).value = "diameter [in]", 6.25
    book.save(path)
    (item,) = read_maker_list(path).items
    assert item.fields["diameter"] == "6.25 in"


def test_of_a_formula_the_stored_value_is_read(tmp_path):
    path = filled(tmp_path, [("Rolls", ITEMS[0][1] | {"diameter": "=150+9"})])
    names = load_workbook(path).sheetnames
    part = f"xl/worksheets/sheet{names.index('Rolls') + 1}.xml"
    edit(path, part, lambda xml: re.sub(rb"<f>150\+9</f><v ?/>", b"<f>150+9</f><v>159</v>", xml))
    (item,) = read_maker_list(path).items
    assert item.fields["diameter"] == "159 mm"


def test_the_form_explains_parts_of_a_drive_by_themselves(tmp_path):
    rows = load_workbook(write_maker_list_form(tmp_path / "form.xlsx"))["Columns"].iter_rows(values_only=True)
    said = {(row[0], row[1]): row[3:5] for row in rows}
    assert said["Gearboxes", "efficiency"] == ("yes", "Of the gearbox alone, from its fast to its slow shaft.")
    assert said["Brakes", "brake_torque"][0] == "or brake_force"


def test_set_takes_a_list_as_in_yaml(tmp_path):
    add_maker_list(filled(tmp_path, ITEMS), tmp_path / "conveyor-library")
    done = run("power", spec_of(tmp_path), "--set", "drive.listed=[M 315, G20]", cwd=tmp_path)
    assert '"M 315" is not in the library of' in done.stderr
    assert 'did you mean "M315"' in done.stderr


def test_an_unknown_name_says_what_there_is(tmp_path):
    add_maker_list(filled(tmp_path, ITEMS), tmp_path / "conveyor-library")
    with pytest.raises(InputError, match=r'drive\.listed\[0\]: "M351" is not in the library of .*did you mean "M315"'):
        conveyor.load(spec_of(tmp_path, listed=["M351"]))
    with pytest.raises(InputError, match=r'drive\.listed\[1\]: got "M315", the second of motors; a drive has one'):
        conveyor.load(spec_of(tmp_path, listed=["M315", "M315"]))


def test_the_commands(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert "no items" in run("library", "list", cwd=tmp_path).stdout
    made = run("library", "template", "list.xlsx", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert "has no items" in run("library", "add", "list.xlsx", cwd=tmp_path).stderr
    filled(tmp_path, ITEMS)
    added = run("library", "add", "list.xlsx", cwd=tmp_path)
    assert (added.returncode, added.stderr) == (0, "")
    listed = json.loads(run("library", "list", "--json", cwd=tmp_path).stdout)
    assert [item["name"] for item in listed] == [values["name"] for _, values in ITEMS]
    done = run("power", spec_of(tmp_path), cwd=tmp_path)
    assert "torque of the backstop" in done.stdout, done.stderr
    personal = run("library", "add", "list.xlsx", "--personal", cwd=tmp_path)
    assert personal.returncode == 2
    assert "too; rename one" in personal.stderr
    shown = run("library", "show", "list", "m315", cwd=tmp_path).stdout
    assert "motor M315" in shown
    assert [row.split(None, 1) for row in shown.splitlines()[1:]] == [
        ["installed_power", "315 kW"], ["motor_speed", "1488 rpm"], ["inertia", "5.2 kg*m^2"], ["efficiency", "96 %"],
        ["source", "list of Z, p. 9"],
    ]  # fmt: skip
    every = json.loads(run("library", "show", "list", "--json", cwd=tmp_path).stdout)
    assert [item["name"] for item in every] == [values["name"] for _, values in ITEMS]
    assert 'no item "M351"; did you mean "M315"?' in run("library", "show", "list", "M351", cwd=tmp_path).stderr
    kept = tmp_path / "conveyor-library" / "list.yaml"
    asked = run("library", "remove", "list", cwd=tmp_path)
    assert (asked.returncode, kept.exists()) == (2, True)
    assert "say --yes" in asked.stderr
    assert "removed" in run("library", "remove", "list", "--yes", cwd=tmp_path).stdout
    assert not kept.exists()
    assert 'no list "list" is kept; there are: none' in run("library", "remove", "list", "--yes", cwd=tmp_path).stderr
