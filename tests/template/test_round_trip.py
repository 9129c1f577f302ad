"""YAML -> template -> YAML loses nothing, and every field of the models is on a sheet."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import pytest
from openpyxl import load_workbook
from pydantic import BaseModel, Field

from conveyor import shelf, spec
from conveyor.errors import InputError
from conveyor.forms.form_fields import FormField, leaf_fields, model_layout
from conveyor.forms.form_reader import read_form, read_template
from conveyor.forms.sheet_plan import FormRow, plan_model, plan_reference
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.base import Model, Name, Number
from conveyor.starter.filled_cells import fill_sheets, given_data
from conveyor.starter.template_sheets import TemplateBook
from conveyor.starter.template_writer import write_template
from conveyor.units import Bounds, Force, Length, Power

SPECS = sorted((Path(__file__).parents[2] / "examples" / "specs").glob("*.yaml"))


def there_and_back(conveyor: Conveyor, folder: Path) -> Conveyor:
    path = write_template(folder / "input.xlsx", conveyor)
    read = read_template(path)
    return spec.from_data(read.data, where=read.where, base=folder)


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_example_comes_back_equal(path: Path, tmp_path: Path) -> None:
    conveyor = spec.load(path)
    back = there_and_back(conveyor, tmp_path)
    assert back.as_data() == conveyor.as_data()
    # what was left to a default is still left to it
    assert given_data(back) == given_data(conveyor)


def test_without_a_conveyor_the_template_holds_an_example(tmp_path: Path) -> None:
    read = read_template(write_template(tmp_path / "input.xlsx"))
    line = spec.from_data(read.data)
    assert line.name
    assert len(line.route.sections) == 1
    assert list(tmp_path.iterdir()) == [tmp_path / "input.xlsx"]


@pytest.fixture
def overland() -> dict[str, Any]:
    return spec.load(next(path for path in SPECS if path.stem == "overland")).as_data()


@pytest.mark.parametrize("number", ["0.30000000000000004 m", "1e-07 m", "123456.78901234567 m", "-0 m", "5e+5 m"])
def test_numbers_keep_all_their_digits(number: str, tmp_path: Path) -> None:
    # %.16g, which workbooks are written with, loses the 17th digit of 0.1 + 0.2
    class Held(Model):
        length: Length
        plain: Number

    held = Held.from_data({"length": number, "plain": float(number[:-2])})
    TemplateBook("numbers", []).draw(fill_sheets(held)).save(tmp_path / "numbers.xlsx")
    assert Held.from_data(read_form(tmp_path / "numbers.xlsx", Held).data).as_data() == held.as_data()


def test_compounds_of_the_shelf_go_by_name_and_others_are_written_out(overland: dict[str, Any], tmp_path: Path) -> None:
    changed = shelf.compound("s100").as_data() | {"description": '=1+1; "quoted"\nsecond line'}
    # the same name as a compound of the shelf that the other cover uses
    overland["belt"]["bottom_cover"]["compound"] = changed
    overland["belt"]["top_cover"]["compound"] = "s100"
    conveyor = spec.from_data(overland)
    assert there_and_back(conveyor, tmp_path).as_data() == conveyor.as_data()
    book = load_workbook(tmp_path / "input.xlsx")
    assert {"Rubber compound 1", "Rubber compound 1 terms"} <= set(book.sheetnames)
    read = read_template(tmp_path / "input.xlsx")
    assert read.data["belt"]["top_cover"]["compound"] == "S100"
    place = read.where(("belt", "bottom_cover", "compound", "shift", "table", "temperature", 3))
    assert "'Rubber compound 1'!B" in place
    assert "'Rubber compound 1 terms'!" in read.where(("belt", "bottom_cover", "compound", "prony", "terms", 2))


def test_one_written_out_compound_serves_both_covers(overland: dict[str, Any], tmp_path: Path) -> None:
    changed = shelf.compound("standard-cover").as_data() | {"name": "mine", "missing": ["a;b", " c", ""]}
    for cover in ("top_cover", "bottom_cover"):
        overland["belt"][cover]["compound"] = changed
    conveyor = spec.from_data(overland)
    assert there_and_back(conveyor, tmp_path).as_data() == conveyor.as_data()
    names = load_workbook(tmp_path / "input.xlsx").sheetnames
    # the compound, its terms, the laws of its band, its strain sweeps, its rolling-resistance tests
    assert sum(name.startswith("Rubber compound") for name in names) == 5


TEXTS = ("=1+1", "+1", "@x", "-", "'quoted'", "'", "a;b", '""x', "10 %", "1,2", "true", "#REF!", "_x0041_")


def test_texts_stay_texts(overland: dict[str, Any], tmp_path: Path) -> None:
    section = overland["route"]["sections"][1]
    overland["route"]["sections"] = [section | {"name": text} for text in TEXTS]
    overland["name"] = overland["notes"] = overland["material"]["name"] = TEXTS[0]
    conveyor = spec.from_data(overland)
    assert there_and_back(conveyor, tmp_path).as_data() == conveyor.as_data()
    book = load_workbook(tmp_path / "input.xlsx")
    formulas = [c.coordinate for s in book for row in s.iter_rows() for c in row if c.data_type == "f"]
    assert formulas == []


@pytest.mark.parametrize("text", ["bell\x07", "x" * 40_000, "one\r\ntwo"])
def test_what_a_workbook_cannot_hold_is_refused(text: str, overland: dict[str, Any], tmp_path: Path) -> None:
    overland["notes"] = text
    with pytest.raises(InputError, match="cannot hold every text of this conveyor"):
        write_template(tmp_path / "input.xlsx", spec.from_data(overland))
    assert not list(tmp_path.iterdir())


def every_leaf(schema: dict[str, Any], definitions: dict[str, Any], path: str = "") -> Iterator[str]:
    """Give the paths of all fields of a JSON schema, compounds as one field; lists as their items."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        schema = {} if name == RubberCompound.__name__ else definitions[name]
    inner = [*schema.get("anyOf", ()), *schema.get("oneOf", ()), *schema.get("allOf", ())]
    if isinstance(schema.get("items"), dict):
        inner.append(schema["items"])
    paths = {found for branch in inner for found in every_leaf(branch, definitions, path)}
    for key, field in schema.get("properties", {}).items():
        paths.update(every_leaf(field, definitions, f"{path}.{key}"))
    yield from paths - {path} or {path}


def placed(model: type[BaseModel]) -> set[str]:
    plan = plan_model(model)
    forms = {f".{'.'.join(row.path)}" for form in plan.forms for row in form.rows if isinstance(row.part, FormField)}
    lists = {f".{'.'.join((*table.path, *c.path))}" for table in plan.tables for c in table.columns}
    return forms | lists


def test_every_field_of_the_schema_has_its_cells() -> None:
    schema = Conveyor.json_schema()
    wanted = set(every_leaf(schema, schema["$defs"]))
    # lists inside lists stand on their own sheet, under their own path
    nested = {".".join(("", *t.path)) for t in plan_model(Conveyor).tables if t.parent is not None}
    shown = placed(Conveyor)
    missing = {path for path in wanted - shown if not any(n in path for n in nested)}
    assert not missing
    assert len(wanted) > 60


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return load_workbook(write_template(tmp_path_factory.mktemp("template") / "input.xlsx"))


def form_fields() -> list[Any]:
    rows = [(form.name, row) for form in plan_model(Conveyor).forms for row in form.rows]
    return [pytest.param(name, row, id=".".join(row.path)) for name, row in rows if isinstance(row.part, FormField)]


@pytest.mark.parametrize(("name", "line"), form_fields())
def test_fields_are_drawn_with_note_range_default_and_drop_down(example: Any, name: str, line: FormRow) -> None:
    sheet, leaf = example[name], line.part
    assert isinstance(leaf, FormField)
    row = next(row for row in range(1, sheet.max_row + 1) if sheet.cell(row, 7).value == ".".join(line.path))
    label, value, unit, allowed, default, meaning = (sheet.cell(row, column) for column in range(1, 7))
    assert leaf.doc in label.comment.text
    assert (meaning.value or "") == leaf.doc
    assert leaf.allowed in (allowed.value or "")
    assert label.value.endswith(" *") == leaf.required
    if leaf.default is not None and leaf.default != []:
        assert default.value
        assert default.font.color.rgb == "00666666"
    if leaf.units:
        assert listed(example, rule(sheet, unit)) == list(leaf.units)
    choices = {"choice": list(leaf.choices), "reference": shelf.names(), "switch": ["yes", "no"]}
    if leaf.kind in choices:
        assert listed(example, rule(sheet, value)) == choices[leaf.kind]
    if leaf.kind in {"number", "count"}:
        assert rule(sheet, value).type == ("whole" if leaf.kind == "count" else "decimal")


def test_a_us_template_says_its_ranges_in_us_units(tmp_path: Path) -> None:
    """196 in, 3930 fpm and 328,000 ft are 5 m, 20 m/s and 100 km rounded inwards by hand."""
    book = load_workbook(write_template(tmp_path / "input.xlsx", units="US"))
    forms = {
        row[6]: row
        for name in ("Belt", "Idlers", "Route")
        for row in book[name].iter_rows(min_row=5, max_col=7, values_only=True)
    }
    assert forms["belt.width"][3] == "≥ 3.94 in, ≤ 196 in"
    assert forms["belt.speed"][3] == "> 0 fpm, ≤ 3930 fpm"
    assert forms["idlers.carry.offset"][4] == "0 in"  # a default, converted
    assert [cell.value for cell in book["Sections"][5]][2] == "> 0 ft, ≤ 328000 ft"
    metric = r"(?<![a-z])(mm|m|kg|kN|N|m/s|kW|degC)(?![\w/^])"
    for row in forms.values():
        assert not re.search(rf"\d {metric}", str(row[3])), row
    line = spec.from_data(read_template(tmp_path / "input.xlsx").data)
    assert line.report.units == "US"
    assert len(line.route.sections) == 1


def test_a_us_template_offers_no_tph(tmp_path: Path) -> None:
    """Metric tonnes per hour, which a US reader takes for short tons; what a spec holds can be chosen."""

    def lists(book: Any) -> list[list[Any]]:
        rules = (rule for sheet in book.worksheets for rule in sheet.data_validations.dataValidation)
        return [listed(book, rule) for rule in rules if rule.type == "list"]

    path = tmp_path / "input.xlsx"
    flows = [one for one in lists(load_workbook(write_template(path, units="US"))) if "stph" in one]
    assert flows
    for one in flows:
        assert one[0] in {"stph", "short_ton/h"}
        assert {"stph", "short_ton/h", "t/h"} <= {*one}
        assert "tph" not in one
    line = spec.from_data(read_template(path).data)
    metric = line.replace(material=line.material.replace(flow="1000 tph"))
    book = load_workbook(write_template(path, metric))
    row = next(row for row in book["Material"].iter_rows(min_row=5, max_col=7) if row[6].value == "material.flow")
    assert (row[1].value, row[2].value) == (1000, "tph")
    assert {"tph", "stph"} <= set(listed(book, rule(book["Material"], row[2])))
    assert spec.from_data(read_template(path).data).as_data() == metric.as_data()


def test_lists_are_drawn_with_notes_and_units(example: Any) -> None:
    for table in plan_model(Conveyor).tables:
        sheet = example[table.name]
        heads = {sheet.cell(6, c).value: c for c in range(1, sheet.max_column + 1)}
        for column in table.columns:
            key = ".".join(column.path)
            assert column.leaf.doc in sheet.cell(4, heads[key]).comment.text
            if column.leaf.units:
                unit = sheet.cell(7, heads[f"{key} [unit]"])
                assert listed(example, rule(sheet, unit)) == list(column.leaf.units)
    assert example["Lists"].sheet_state == "hidden"
    assert all(example[form.name].freeze_panes == "B5" for form in plan_model(Conveyor).forms)


def rule(sheet: Any, cell: Any) -> Any:
    return next(rule for rule in sheet.data_validations.dataValidation if cell.coordinate in rule.sqref)


def listed(book: Any, rule: Any) -> list[Any]:
    sheet, _, cells = rule.formula1.replace("$", "").partition("!")
    return [row[0].value for row in book[sheet.strip("'")][cells]]


def test_sheet_names_do_not_change() -> None:
    names = [form.name for form in plan_model(Conveyor).forms]
    assert names[:4] == ["Conveyor", "Belt", "Idlers", "Material"]
    assert "Sections" in [table.name for table in plan_model(Conveyor).tables]
    own = plan_reference(RubberCompound, "Rubber compound 1")
    assert [form.name for form in own.forms] == ["Rubber compound 1"]


# -- shapes that the conveyor's models have not, or not yet


class Brake(Model):
    kind: Literal["disc"]
    torque: Annotated[Force, Bounds(gt="0 N")]


class Holdback(Model):
    kind: Literal["pawl"]
    teeth: int
    torque: Annotated[Power, Bounds(gt="0 W")]


Stop = Annotated[Brake | Holdback, Field(discriminator="kind")]


class Motor(Model):
    power: Power
    factors: tuple[Number, ...] = ()


class Drive(Model):
    name: Name
    motors: tuple[Motor, ...]
    stop: Stop | None = None
    length: Length | Literal["auto"] = "auto"


class Case(Model):
    name: Name
    changes: dict[str, float | str] = Field(default_factory=dict)


class Soft(Model):
    a: Number = 1.0


class Tree(Model):
    name: str
    children: tuple[Tree, ...] = ()


class Plant(Model):
    title: str
    drives: tuple[Drive, ...]
    cases: tuple[Case, ...] = ()
    soft: Soft | None = None
    tree: Tree | None = None
    pair: tuple[Length, Length] | None = None
    things: tuple[Stop, ...] = ()
    words: str | tuple[str, ...] | None = None


PLANT: dict[str, Any] = {
    "title": "=1+1",
    "drives": [
        {
            "name": "a",
            "motors": [{"power": "5 kW"}, {"power": "0.1 hp", "factors": [0.1, 0.30000000000000004]}],
            "stop": {"kind": "pawl", "teeth": 3, "torque": "3 W"},
        },
        {"name": "b", "motors": [], "stop": {"kind": "disc", "torque": "3 N"}, "length": "5 m"},
        {"name": "c", "motors": [{"power": "7 kW"}], "length": "auto"},
    ],
    "cases": [{"name": "x", "changes": {"y": 1.5, "z": "5 m"}}],
    "soft": {},
    "tree": {"name": "r", "children": [{"name": "s"}]},
    "pair": ["1 m", "20 mm"],
    "things": [{"kind": "disc", "torque": "1 N"}],
    "words": ["one"],
}


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    path = tmp_path / "plant.xlsx"
    TemplateBook("plant", []).draw(fill_sheets(Plant.from_data(PLANT))).save(path)
    return path


def test_lists_in_lists_unions_and_mappings_come_back(plant: Path) -> None:
    read = read_form(plant, Plant)
    assert Plant.from_data(read.data).as_data() == Plant.from_data(PLANT).as_data()
    assert read.where(("drives", 2, "motors", 0, "power")).endswith("Motors!C9")
    assert read.where(("drives", 0, "stop", "pawl", "teeth")).endswith("Drives!F7")


def test_an_item_of_a_list_in_a_list_names_its_parent(plant: Path) -> None:
    book = load_workbook(plant)
    book["Motors"]["B7"] = 9
    book["Motors"]["B8"] = None
    book.save(plant)
    with pytest.raises(InputError) as refused:
        read_form(plant, Plant)
    message = 'belongs to No. {} of sheet "Drives", a number that no row has'
    lines = str(refused.value).splitlines()
    assert lines == [
        f"{plant}:Motors!A7 {message.format(9)}",
        f"{plant}:Motors!A8 {message.format('nothing')}",
    ]


def test_variants_share_a_field_with_the_units_of_both() -> None:
    torque = next(leaf for leaf in leaf_fields(model_layout(Plant)) if leaf.key == "torque")
    assert {"N", "kN", "W", "kW"} <= set(torque.units)
    assert "(kind: disc)" in torque.doc
    assert "(kind: pawl)" in torque.doc


def test_self_containing_models_end_as_json() -> None:
    tree = next(part for part in model_layout(Plant).parts if part.key == "tree")
    assert [(leaf.key, leaf.kind) for leaf in leaf_fields(tree)] == [("name", "text"), ("children", "json")]
