"""Specs: the examples, round trips, one line with file:line:column for every error; files that are none: robustness."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from conveyor import spec
from conveyor.errors import InputError
from conveyor.laws.loading import bulk_line_mass, cross_section, usable_width
from conveyor.models import Conveyor
from conveyor.units import si, text

EXAMPLES = Path(__file__).parent.parent / "examples" / "specs"
GOOD = """\
name: test line
belt:
  width: 1200 mm
  speed: 5 m/s
  top_cover: {thickness: 6 mm}
  bottom_cover: {thickness: 4 mm, compound: standard-cover}
  carcass: {kind: steel cord, thickness: 5 mm, mass: 12 kg/m^2}
idlers:
  carry:
    rolls: 3
    spacing: 1.5 m
    trough_angle: 35 deg
    roll: {diameter: 159 mm, length: 465 mm, rotating_mass: 5.2 kg}
  return:
    rolls: 1
    spacing: 3 m
    roll: {diameter: 159 mm, length: 1400 mm, rotating_mass: 13.2 kg}
material: {name: coal, density: 850 kg/m^3, flow: 2000 t/h, surcharge_angle: 20 deg}
route:
  sections:
    - {name: one, length: 500 m}
    - {name: two, length: 300 m, lift: 10 m}
drive: {wrap_angle: 210 deg, friction: 0.35, efficiency: 95 %}
ambient: {temperature: 20 degC}
"""


def write(folder: Path, content: str | bytes, name: str = "spec.yaml") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def refusal(path: Path) -> list[str]:
    with pytest.raises(InputError) as caught:
        spec.load(path)
    return str(caught.value).splitlines()


def test_good_spec(tmp_path: Path) -> None:
    line = spec.load(write(tmp_path, GOOD))
    assert line.carry_compound.name == "standard-cover"
    assert text(line.belt.speed) == "5 m/s"


POSITIONS = [
    ("speed: 5 m/s", "speed: 5 m", '4:10 belt.speed: got "5 m" (a length), expected a speed such as "5 m/s"'),
    ("width:", "widht:", '3:3 belt.widht: unknown key "widht"; did you mean "width"?; keys allowed: width, speed,'),
    ("rolls: 3", "rolls: 7", "10:12 idlers.carry.rolls: got 7, allowed: 1, 2, 3, 4, 5 or 6"),
    ("rolls: 3", 'rolls: "3"', '10:12 idlers.carry.rolls: got "3", allowed: 1, 2, 3, 4, 5 or 6'),
    ("length: 500 m", "length: 0 ft", "21:27 route.sections[0].length: got 0 ft, allowed: > 0 ft and <= 328084 ft"),
    ("name: coal", "name: 5", "18:18 material.name: expected text, got 5"),
    ("friction: 0.35", "friction: high", '23:40 drive.friction: expected a number, got "high"'),
    ("friction: 0.35", "friction: 3.5", "23:40 drive.friction: got 3.5, allowed: <= 1"),
    ("friction: 0.35", "friction: .nan", "23:40 drive.friction: expected a finite number, got nan"),
    ("friction: 0.35", "friction: yes", '23:40 drive.friction: expected a number, got "yes"'),
    ("friction: 0.35", "friction: true", "23:40 drive.friction: expected a number, got true"),
    ("efficiency: 95 %", "efficiency: 95", "23:58 drive.efficiency: got 95, allowed: > 0 and <= 1"),
    ("flow: 2000 t/h", "flow: 9000 t/h", "18:51 material.flow: got 9000 t/h, which at 5 m/s (belt.speed) and "
     "850 kg/m^3 (material.density) needs"),
    ("20 degC", "95 degC",
     '24:24 ambient.temperature: got 95 degC, but belt.bottom_cover.compound is "standard-cover": compound'),
    ("name: test line", "name: test line\noperation: {hours_per_year: 5 h, price: 1 EUR}",
     '2:41 operation.price: got "1 EUR", expected a price'),
    ("name: test line", "name: test line\ncalculation: {support: confned}",
     '2:24 calculation.support: got "confned", allowed: \'confined\', \'belt\', \'free\' or \'half-space\''),
    ("name: test line", "name: test line\ncalculation: {gauss_points: 3.5}",
     "2:29 calculation.gauss_points: expected a whole number, got 3.5"),
    ("mass: 12 kg/m^2", "mass: null", "2:1 belt.mass: missing: give belt.mass or belt.carcass.mass"),
    ("speed: 5 m/s", "speed: [5 m/s]", '4:3 belt.speed: expected a speed such as "5 m/s", got a list'),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "expected"), POSITIONS)
def test_every_error_has_its_line_and_column(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert old in GOOD
    path = write(tmp_path, GOOD.replace(old, new, 1))
    lines = refusal(path)
    assert any(line.startswith(f"{path}:{expected}") for line in lines), lines
    # A misspelt key is missing too.
    assert len(lines) == (2 if "unknown key" in expected else 1)


def test_all_errors_of_a_file_at_once_in_its_order(tmp_path: Path) -> None:
    bad = GOOD
    for old, new in (
        ("speed: 5 m/s", "speed: 5"),
        ("rolls: 3", "rolls: 7"),
        ("length: 500 m", "length: 500"),
        ("efficiency: 95 %", "efficiency: 2"),
        ("  width: 1200 mm", "  witdh: 1200 mm"),
    ):
        bad = bad.replace(old, new, 1)
    lines = refusal(write(tmp_path, bad))
    fields = [line.split(" ")[1] for line in lines]
    assert fields == [
        "belt.width:",
        "belt.witdh:",
        "belt.speed:",
        "idlers.carry.rolls:",
        "route.sections[0].length:",
        "drive.efficiency:",
    ]
    numbers = [int(re.search(r"\.yaml:(\d+):", line)[1]) for line in lines]  # type: ignore[index]
    assert numbers == sorted(numbers)


def test_very_many_errors_are_counted(tmp_path: Path) -> None:
    lines = refusal(write(tmp_path, GOOD + "name: again\n" * 150))
    assert len(lines) == 101
    assert lines[-1] == f"{tmp_path}/spec.yaml: and 50 more errors"


def test_errors_inside_an_inline_compound(tmp_path: Path) -> None:
    inline = (
        "{name: x, kind: measured, poisson_ratio: 0.7, reference_temperature: 20 degC, "
        "source: {origin: a, licence: b}, prony: {equilibrium: 1 MPa, terms: []}, shift: {law: wlf, c1: 1}}"
    )
    lines = refusal(write(tmp_path, GOOD.replace("standard-cover", inline)))
    assert [line.split(" ", 1)[1] for line in lines] == [
        "belt.bottom_cover.compound.poisson_ratio: got 0.7, allowed: <= 0.5",
        'belt.bottom_cover.compound.shift.c2: missing; expected a temperature difference such as "50 K"',
    ]
    lines = refusal(write(tmp_path, GOOD.replace("standard-cover", inline.replace("law: wlf", "law: wfl"))))
    assert lines[1].endswith("compound.shift: got law: \"wfl\", allowed: 'table', 'wlf', 'arrhenius'")
    lines = refusal(write(tmp_path, GOOD.replace("standard-cover", inline.replace("law: wlf, ", ""))))
    assert lines[1].endswith("compound.shift: law is missing; expected one of table, wlf, arrhenius")


def test_errors_of_a_compound_file_carry_its_own_lines(tmp_path: Path) -> None:
    write(tmp_path, "name: mine\nkind: guessed\n", "mine.yaml")
    lines = refusal(write(tmp_path, GOOD.replace("standard-cover", "mine.yaml")))
    assert lines[0].startswith(f"{tmp_path}/spec.yaml:6:45 belt.bottom_cover.compound: ")
    assert any(f"{tmp_path}/mine.yaml:2:7 kind: got \"guessed\", allowed: 'measured'" in line for line in lines)


def test_anchors_and_aliases_are_read(tmp_path: Path) -> None:
    line = spec.load(
        write(tmp_path, GOOD.replace("one, length: 500 m", "one, length: &l 500 m").replace("300 m", "*l"))
    )
    assert [text(section.length) for section in line.route.sections] == ["500 m", "500 m"]


def test_byte_order_mark_and_windows_lines_are_read(tmp_path: Path) -> None:
    plain = spec.load(write(tmp_path, GOOD))
    marked = spec.load(write(tmp_path, b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode()))
    assert marked == plain


def test_json_spec_with_positions(tmp_path: Path) -> None:
    line = spec.load(write(tmp_path, GOOD))
    data = line.as_data()
    for indent in (2, "\t", None):
        assert spec.load(write(tmp_path, json.dumps(data, indent=indent), "spec.json")) == line
    data["belt"]["width"] = "1200"
    content = json.dumps(data, indent="\t")
    row = next(i for i, text_line in enumerate(content.splitlines(), 1) if '"width"' in text_line)
    lines = refusal(write(tmp_path, content, "spec.json"))
    assert lines[0].startswith(f'{tmp_path}/spec.json:{row}:12 belt.width: got "1200" without a unit')


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('{"name": "a",}', r"spec.json:1:1[34] syntax: "),
        ('{"name": NaN, "name": 2}', "spec.json:1:15 name: given twice, first in line 1"),
        ("[1]", "spec.json:1:1 file: expected fields"),
        ("  ", "spec.json:1:1 file: empty"),
        ("[" * 100_000, "spec.json:1:1 syntax: nested deeper"),
    ],
)
def test_bad_json(tmp_path: Path, content: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        spec.load(write(tmp_path, content, "spec.json"))


@pytest.mark.parametrize("name", ["overland", "in_plant_us", "downhill"])
def test_examples_round_trip(name: str, tmp_path: Path) -> None:
    line = spec.load(EXAMPLES / f"{name}.yaml")
    again = spec.load(write(tmp_path, spec.dump(line)))
    assert again == line
    assert spec.dump(again) == spec.dump(line)
    assert spec.fingerprint(again) == spec.fingerprint(line)


@pytest.mark.parametrize("name", ["overland", "in_plant_us", "downhill"])
def test_examples_are_filled_like_real_ones(name: str) -> None:
    line = spec.load(EXAMPLES / f"{name}.yaml")
    section = cross_section(
        usable_width(si(line.belt.width)),
        middle_roll_length=si(line.idlers.carry.roll.length),
        trough_angle=si(line.idlers.carry.trough_angle),
        surcharge_angle=si(line.material.surcharge_angle),
    )
    needed = bulk_line_mass(si(line.material.flow), belt_speed=si(line.belt.speed)) / si(line.material.density)
    assert 0.4 < needed / section.area < 0.95


def test_the_overland_example_is_overland_and_the_downhill_one_goes_down() -> None:
    overland = spec.load(EXAMPLES / "overland.yaml").route
    assert len(overland.sections) == 10
    assert overland.length == pytest.approx(5200.0, rel=1e-15)
    assert spec.load(EXAMPLES / "downhill.yaml").route.rise < -150.0


def converted(data: Any, factors: dict[str, tuple[str, float]]) -> Any:
    """Rewrite every quantity of a spec in another unit."""
    if isinstance(data, dict):
        return {key: converted(value, factors) for key, value in data.items()}
    if isinstance(data, list):
        return [converted(value, factors) for value in data]
    if not isinstance(data, str):
        return data
    match = re.fullmatch(r"(-?[0-9.e+-]+) (\S+)", data)
    if match is None or match[2] not in factors:
        return data
    unit, factor = factors[match[2]]
    offset = 459.67 if unit == "degF" else 0.0
    return f"{(float(match[1]) + (273.15 if unit == 'degF' else 0.0)) * factor - offset!r} {unit}"


def quantities(model: Any) -> list[float]:
    """Collect every quantity of a model in SI, in the order of its fields."""
    if hasattr(model, "magnitude"):
        return [si(model)]
    if isinstance(model, tuple):
        return [value for item in model for value in quantities(item)]
    if hasattr(type(model), "model_fields"):
        return [value for name in type(model).model_fields for value in quantities(getattr(model, name))]
    return []


def test_us_units_give_the_same_si_values() -> None:
    pound, foot = 0.45359237, 0.3048
    us = {
        "mm": ("in", 1 / 25.4), "m": ("ft", 1 / foot), "km": ("ft", 1000 / foot), "m/s": ("fpm", 60 / foot),
        "kg": ("lb", 1 / pound), "t": ("short_ton", 1000 / pound / 2000), "kg/m^2": ("lb/ft^2", foot**2 / pound),
        "kg/m^3": ("lb/ft^3", foot**3 / pound), "t/h": ("short_ton/h", 1000 / pound / 2000),
        "N/mm": ("lbf/in", 25.4 / (pound * 9.80665)), "degC": ("degF", 1.8), "deg": ("rad", math.pi / 180),
        "kW": ("hp", 1000 / (550 * foot * pound * 9.80665)), "h": ("min", 60.0),
        "kPa": ("psi", 1000 * 0.0254**2 / (pound * 9.80665)), "MPa": ("psi", 1e6 * 0.0254**2 / (pound * 9.80665)),
    }  # fmt: skip
    metric = spec.load(EXAMPLES / "overland.yaml")
    rewritten = converted(metric.as_data(), us)
    assert rewritten["belt"]["width"].endswith(" in")
    assert rewritten["ambient"]["temperature"].endswith(" degF")
    values, others = quantities(metric), quantities(spec.from_data(rewritten))
    assert len(values) > 200
    # A handful of roundings; offsets of temperatures cost two digits.
    assert others == pytest.approx(values, rel=1e-13)


def test_fingerprint_sees_values_not_layout(tmp_path: Path) -> None:
    first = spec.fingerprint(spec.load(write(tmp_path, GOOD)))
    assert re.fullmatch("[0-9a-f]{64}", first)
    same = "# a comment\n" + GOOD.replace("speed: 5 m/s", "speed:   5.0 m/s  # fast")
    assert spec.fingerprint(spec.load(write(tmp_path, same))) == first
    for old, new in (
        ("5 m/s", "5.1 m/s"),
        ("standard-cover", "S100"),
        ("1.5 m", "1500 mm"),
        ("test line", "line"),
    ):
        assert spec.fingerprint(spec.load(write(tmp_path, GOOD.replace(old, new)))) != first


def test_from_data_names_places_of_its_source(tmp_path: Path) -> None:
    line = spec.load(write(tmp_path, GOOD))
    data = line.as_data()
    assert spec.from_data(data) == line
    data["belt"]["speed"] = "5"
    data["belt"]["colour"] = "red"
    with pytest.raises(InputError) as caught:
        spec.from_data(data, where=lambda location: f"Belt!{location[-1]}")
    lines = str(caught.value).splitlines()
    assert lines[0].startswith('Belt!speed belt.speed: got "5" without a unit')
    assert lines[1].startswith('Belt!colour belt.colour: unknown key "colour"; keys allowed: width')
    with pytest.raises(InputError, match=r'^belt\.speed: got "5"'):
        spec.from_data(data)


def test_schema_is_json_and_names_every_field() -> None:
    schema = json.loads(json.dumps(spec.schema(), allow_nan=False))
    assert schema["$schema"].endswith("2020-12/schema")
    assert set(schema["properties"]) == {info.alias or name for name, info in Conveyor.model_fields.items()}
    assert "return" in schema["$defs"]["Idlers"]["properties"]
    assert schema["$defs"]["IdlerSet"]["properties"]["sag"]["default"] == "1 %"
    compound = schema["$defs"]["Cover"]["properties"]["compound"]["anyOf"]
    assert {"type": "string"} in compound
    for model in schema["$defs"].values():
        assert model["additionalProperties"] is False


def test_schema_patterns_take_the_examples() -> None:
    schema = spec.schema()

    def models_of(node: Any) -> list[Any]:
        if "$ref" in node:
            return models_of(schema["$defs"][node["$ref"].rsplit("/", 1)[1]])
        options = [*node.get("anyOf", []), *node.get("oneOf", [])]
        return [node, *(found for option in options for found in models_of(option))]

    def check(data: Any, node: Any) -> int:
        if isinstance(data, dict):
            fitting = next(o for o in models_of(node) if set(data) <= set(o.get("properties", {})))
            return sum(check(value, fitting["properties"][key]) for key, value in data.items())
        if isinstance(data, list):
            return sum(check(value, node["items"]) for value in data) if "items" in node else 0
        if isinstance(data, str) and "pattern" in node:
            assert re.search(node["pattern"], data), (data, node)
            return 1
        return 0

    for name in ("overland", "in_plant_us", "downhill"):
        assert check(spec.load(EXAMPLES / f"{name}.yaml").as_data(), schema) > 60


def test_errors_that_a_study_finds_later_get_their_place(tmp_path: Path) -> None:
    path = write(tmp_path, GOOD)
    with pytest.raises(InputError, match=rf"^{path}:4:10 belt.speed: too fast$"), spec.locate_errors(path):
        raise InputError("belt.speed: too fast")


@pytest.mark.parametrize("message", ["result.xlsx: is a folder", "shelf: nowhere", "No field at all"])
def test_errors_of_something_else_get_no_place(tmp_path: Path, message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}$"), spec.locate_errors(write(tmp_path, GOOD)):
        raise InputError(message)
