"""The form of a spec, its sliders, and the changes of a page."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.desk.design_form import form_rows, read_change
from conveyor.desk.design_sliders import choose_sliders, conveyor_kind, field_slider
from conveyor.desk.design_variant import change_conveyor, command_line, field_errors, guarded_resolver
from conveyor.errors import InputError
from conveyor.files.document import read_document
from conveyor.models import Conveyor
from conveyor.models.fields import field_value
from conveyor.starter.format_reference import format_fields
from conveyor.units import si

SPECS = sorted(Path("examples/specs").glob("*.yaml"))
OVERLAND = Path("examples/specs/overland.yaml")


def form_of(path: Path):
    return form_rows(conveyor.load(path), read_document(path).data)


@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_every_value_of_a_file_is_in_its_form_as_written(spec):
    rows = {row.path: row for row in form_of(spec)}

    def written(data, path=""):
        if isinstance(data, dict):
            for key, value in data.items():
                yield from written(value, f"{path}.{key}".removeprefix("."))
        elif isinstance(data, list) and data and isinstance(data[0], dict):
            for i, value in enumerate(data):
                yield from written(value, f"{path}[{i}]")
        else:
            yield path, data

    for path, value in written(read_document(spec).data):
        if isinstance(value, str):
            assert (rows[path].value, rows[path].given_by) == (value, "spec")


def test_the_form_has_every_field_of_the_models_once():
    rows = form_of(OVERLAND)
    paths = [row.path for row in rows]
    assert len(paths) == len(set(paths))
    expected = {pattern for pattern in format_fields(Conveyor) if "[]" not in pattern}
    assert expected - set(paths) == {"conveyor"}  # the version of the format is no choice of a designer
    assert all(row.doc or row.kind == "choice" for row in rows if not row.path.startswith("uncertainty"))


def test_parts_of_a_library_are_chosen_by_name():
    rows = {row.path: row for row in form_of(OVERLAND)}
    assert "ST2100" in rows["belt.listed"].choices
    assert "159x465" in rows["idlers.carry.roll.listed"].choices
    assert rows["belt.speed"].choices == ()


def test_a_default_is_flagged_with_its_value():
    gravity = next(row for row in form_of(OVERLAND) if row.path == "calculation.gravity")
    assert (gravity.value, gravity.given_by) == ("9.81 m/s²", "default")


@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_sliders_move_given_fields_about_their_value(spec):
    line = conveyor.load(spec)
    sliders = choose_sliders(line, form_of(spec))
    assert len(sliders) == 6
    for slider in sliders:
        value = field_value(line, slider.path)
        assert slider.low < slider.value < slider.high
        assert (
            slider.text(slider.value).split() == str(read_document(spec).place and value).split() or value is not None
        )
        changed = change_conveyor(line, {slider.path: slider.text(slider.value)}, shelf.resolver(base=spec.parent))
        assert changed == line


def test_kinds_of_conveyors():
    kinds = {spec.stem: conveyor_kind(conveyor.load(spec)) for spec in SPECS}
    assert (kinds["overland"], kinds["downhill"], kinds["in_plant_us"]) == ("overland", "downhill", "in-plant")
    assert (kinds["pipe"], kinds["feeder"], kinds["slider"]) == ("pipe", "feeder", "in-plant")


def test_a_feeder_is_moved_by_its_hopper_and_a_pipe_by_what_holds_it_open():
    feeder, pipe, curved = (
        {slider.path for slider in choose_sliders(conveyor.load(spec), form_of(spec))}
        for spec in (Path(f"examples/specs/{name}.yaml") for name in ("feeder", "pipe", "pipe_curved"))
    )
    assert {"route.feeding.hopper.gate_height", "route.feeding.hopper.outlet_length"} < feeder
    assert "belt.transverse_stiffness" in pipe
    assert "idlers.carry.pipe.forming_load" in curved


def test_a_series_gives_the_steps_of_its_slider():
    slider = field_slider("idlers.carry.roll.diameter", "159 mm")
    assert slider is not None
    assert slider.series == (102, 108, 127, 133, 152, 159, 168, 178, 194, 219)
    assert field_slider("idlers.carry.roll.diameter", "160 mm").series == ()


def test_a_slider_stays_in_the_allowed_range_of_its_field():
    assert (field_slider("drive.start_factor", "1.3").low, field_slider("drive.start_factor", "1.3").high) == (
        1.0,
        1.82,
    )
    assert field_slider("drive.efficiency", "94 %").high == 100.0


@pytest.mark.parametrize("text", ["0 m", "abc", "", None, "1e999 m", "nan m"])
def test_no_slider_without_a_number(text):
    assert field_slider("belt.speed", text) is None


def test_texts_are_read_by_the_kind_of_their_field():
    assert read_change("calculation.gauss_points", "6") == 6
    assert read_change("route.sections[3].loaded", "no") is False
    assert read_change("cases[0].temperatures", "-10 degC, 20 degC") == ["-10 degC", "20 degC"]
    assert read_change("name", "7") == "7"
    assert read_change("site", "") == "plant"
    with pytest.raises(InputError, match=r"belt\.sped: no such field"):
        read_change("belt.sped", "5 m/s")


def test_refusals_name_their_fields_all_at_once():
    line = conveyor.load(OVERLAND)
    changes = {"belt.speed": "90 m/s", "drive.friction": "x", "route.sections[1].length": "0 m", "no.field": "1"}
    with pytest.raises(InputError) as refused:
        change_conveyor(line, changes, shelf.resolver())
    assert {error.path for error in field_errors(str(refused.value))} == set(changes)


@pytest.mark.parametrize("name", ["../secret.yaml", "/etc/hosts.yaml", "~/x.yaml", "..", "sub/../../x.yaml"])
def test_compounds_outside_the_folder_are_refused_without_being_read(tmp_path, name):
    inside = tmp_path / "work"
    inside.mkdir()
    (tmp_path / "secret.yaml").write_text("password: swordfish\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"outside the folder of the spec|unknown compound") as refused:
        guarded_resolver(inside, ())(name)
    assert "swordfish" not in str(refused.value)
    assert "password" not in str(refused.value)
    assert str(tmp_path) not in str(refused.value)


def test_a_compound_of_the_home_folder_is_refused(tmp_path, monkeypatch):
    """Also one that there is: "~" is a name like any other to the path, and the user's folder to the shelf."""
    for variable in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(variable, str(tmp_path))
    (tmp_path / "own.yaml").write_text(shelf.dump(shelf.compound("s100")), encoding="utf-8")
    inside = tmp_path / "work"
    inside.mkdir()
    assert shelf.compound("~/own.yaml").kind == "measured"
    with pytest.raises(InputError, match="outside the folder"):
        guarded_resolver(inside, ())("~/own.yaml")


def test_what_is_wrong_in_a_compound_does_not_tell_its_folder(tmp_path):
    (tmp_path / "bad.yaml").write_text("colour: black\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"^bad\.yaml:1:1 ") as refused:
        guarded_resolver(tmp_path, ())("bad.yaml")
    assert str(tmp_path) not in str(refused.value)


def test_compounds_in_the_folder_and_on_shelves_are_found(tmp_path):
    (tmp_path / "own.yaml").write_text(shelf.dump(shelf.compound("s100")), encoding="utf-8")
    resolve = guarded_resolver(tmp_path, ())
    assert resolve("own.yaml") == resolve("./own.yaml") == shelf.compound("s100")
    assert resolve("standard-cover").name == "standard-cover"
    line = conveyor.load(OVERLAND)
    changed = change_conveyor(line, {"belt.bottom_cover.compound": "own.yaml"}, resolve)
    assert changed.belt.bottom_cover.compound.name == shelf.compound("s100").name


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    inside = tmp_path / "work"
    inside.mkdir()
    (tmp_path / "x.yaml").write_text("a: 1\n", encoding="utf-8")
    try:
        (inside / "x.yaml").symlink_to(tmp_path / "x.yaml")
    except OSError:
        pytest.skip("no links here")
    with pytest.raises(InputError, match="outside the folder"):
        guarded_resolver(inside, ())("x.yaml")


def test_the_command_line_says_the_same_to_the_terminal():
    changes = {"belt.speed": "5.5 m/s", "name": "7", "cases[0].temperatures": "1 degC", "notes": "it's $5"}
    words = shlex.split(command_line("a b.yaml", changes))
    assert words[:3] == ["conveyor", "power", "a b.yaml"]
    assert words[4::2] == [
        "belt.speed=5.5 m/s", 'name="7"', f"cases[0].temperatures={json.dumps(['1 degC'])}", "notes=it's $5",
    ]  # fmt: skip
    assert words[3::2] == ["--set"] * 4


def test_an_empty_text_takes_a_value_away():
    line = conveyor.load(OVERLAND)
    without = change_conveyor(line, {"drive.installed_power": ""}, shelf.resolver())
    assert without.drive.installed_power is None
    assert si(line.drive.installed_power) == pytest.approx(1.6e6)
