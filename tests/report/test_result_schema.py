"""What `--json` prints, against the schema that `conveyor schema --result` prints."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import conveyor
from conveyor.cli.application import json_text
from conveyor.cli.entry_point import app
from conveyor.report.tables import comparison_tables
from conveyor.report.tables.result_schema import SCHEMA_VERSION, result_schema

SPECS = sorted((Path(__file__).parents[2] / "examples" / "specs").glob("*.yaml"))
TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "number": (int, float),
    "null": type(None),
}
WORDS = {
    "$ref", "$schema", "$defs", "title", "description", "type", "enum", "const", "oneOf", "properties", "required",
    "items", "additionalProperties",
}  # fmt: skip
"""All of draft 2020-12 that the schema uses, and `faults` knows."""


def faults(value: Any, schema: dict[str, Any], whole: dict[str, Any], at: str = "$") -> Iterator[str]:
    """Where a value is not what a schema says; a key that the schema does not name is a fault, too."""
    assert set(schema) <= WORDS
    if "$ref" in schema:
        yield from faults(value, whole["$defs"][schema["$ref"].rpartition("/")[2]], whole, at)
    if "oneOf" in schema:
        found = [list(faults(value, one, whole, at)) for one in schema["oneOf"]]
        if sum(not one for one in found) != 1:
            yield from min(found, key=len)
    kinds = schema.get("type", list(TYPES))
    allowed = [kinds] if isinstance(kinds, str) else kinds
    fits = [kind for kind in allowed if isinstance(value, TYPES[kind])]
    if (isinstance(value, bool) and "boolean" not in fits) or (isinstance(value, float) and not math.isfinite(value)):
        fits = []
    if not fits:
        yield f"{at}: {value!r} is no {kinds}"
    if value not in schema.get("enum", [value]) or value != schema.get("const", value):
        yield f"{at}: {value!r}"
    if isinstance(value, dict) and "type" in schema:
        yield from faults_of_keys(value, schema, whole, at)
    if isinstance(value, list) and "items" in schema:
        for i, inside in enumerate(value):
            yield from faults(inside, schema["items"], whole, f"{at}[{i}]")


def faults_of_keys(value: dict[str, Any], schema: dict[str, Any], whole: dict[str, Any], at: str) -> Iterator[str]:
    """Of the keys of an object and what they hold."""
    yield from (f"{at}.{key}: missing" for key in schema.get("required", ()) if key not in value)
    for key, inside in value.items():
        described = schema.get("properties", {}).get(key, schema.get("additionalProperties"))
        if described is None:
            yield f"{at}.{key}: not described"
        else:
            yield from faults(inside, described, whole, f"{at}.{key}")


def read(data: Any) -> Any:
    """As a program reads what is printed: JSON without NaN or infinity."""
    return json.loads(json_text(data))


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_the_result_of_every_example_is_what_the_schema_says(studied, path):
    result, asked = studied(path.stem)
    told, schema = read(result.to_dict(asked)), result_schema()
    assert list(faults(told, schema, schema)) == []
    assert list(faults(told, schema["$defs"]["power"], schema)) == []
    assert told["schema_version"] == SCHEMA_VERSION


@pytest.mark.parametrize("method", ["din 22101", "cema classic"])
@pytest.mark.parametrize("stem", ["in_plant_us", "downhill_brakes"])
def test_so_is_that_of_a_classical_method(stem, method):
    line = conveyor.load(SPECS[0].parent / f"{stem}.yaml")
    cema = {"flexure_factor": 0.022, "idler_friction": "1.5 lbf"}
    result = conveyor.analyse(line.replace(calculation=line.calculation.replace(method=method, cema=cema)))
    told, schema = read(result.to_dict()), result_schema()
    assert list(faults(told, schema["$defs"]["power"], schema)) == []
    assert told["forces_N"]["total"] == pytest.approx(
        math.fsum(value for key, value in told["forces_N"].items() if key != "total"), rel=1e-12
    )


def test_a_comparison_is_what_the_schema_says(studied):
    line = studied("in_plant_us")[0].conveyor
    found = conveyor.compare_compounds(line, ["standard-cover", "s100"], temperatures=["20 degC"], rtol=1e-3)
    schema = result_schema()
    assert list(faults(read(comparison_tables.comparison_json(found)), schema, schema)) == []


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"lift_m": "12 m"}, "$.lift_m: '12 m' is no number"),
        ({"lift_m": True}, "$.lift_m: True is no number"),
        ({"lift_m": math.nan}, "$.lift_m: nan is no number"),
        ({"schema_version": SCHEMA_VERSION + 1}, f"$.schema_version: {SCHEMA_VERSION + 1}"),
        ({"more": 1}, "$.more: not described"),
        ({"checks": [{}]}, "$.checks[0].key: missing"),
        ({"sections": 3}, "$.sections: 3 is no array"),
    ],
)
def test_what_the_schema_does_not_say_is_found(studied, change, fault):
    result, _ = studied("in_plant_us")
    schema = result_schema()
    assert fault in list(faults(result.to_dict() | change, schema["$defs"]["power"], schema))
    told = result.to_dict()
    del told["forces_N"]["total"]
    assert list(faults(told, schema["$defs"]["power"], schema)) == ["$.forces_N.total: missing"]


def test_the_command_prints_it():
    found = CliRunner().invoke(app, ["schema", "--result"])
    assert found.exit_code == 0
    assert json.loads(found.stdout) == result_schema()
    refused = CliRunner().invoke(app, ["schema", "--result", "--markdown"])
    assert isinstance(refused.exception, conveyor.InputError)


def test_checks_are_numbers_with_their_units(studied):
    """Every criterion of the conveyor and of each case, each pair of key and subject governed once."""
    result, asked = studied("overland_10km")
    told = result.to_dict(asked)["checks"]
    assert sum(row["case"] is None for row in told) == len(result.checks)
    for result_of_case in asked.cases.results:
        rows = [row for row in told if row["case"] == result_of_case.label.text()]
        assert [row["key"] for row in rows] == [check.key for check in result_of_case.checks]
    governing = [(row["key"], row["subject"]) for row in told if row["governs"]]
    assert len(governing) == len(set(governing))
    assert set(governing) == {(row["key"], row["subject"]) for row in told}
    safety = next(row for row in told if row["key"] == "belt_safety")
    assert safety["calculated"] == pytest.approx(result.belt_duty.safety_steady, rel=1e-12)
    assert (safety["relation"], safety["unit"], safety["case"]) == ("at least", "-", None)
    assert safety["margin"] == pytest.approx(safety["calculated"] / safety["required"] - 1.0, rel=1e-12)
    power = next(row for row in told if row["key"] == "motor_power")
    assert power["unit"] == "kW"
    assert power["calculated"] == pytest.approx(result.to_dict(asked)["power_kW"]["design"], rel=1e-12)
    assert {row["verdict"] for row in told} <= {"pass", "fail", "not checked"}
    assert all(row["why"] is None for row in told if row["verdict"] == "pass")


def test_the_energy_of_a_duty_is_that_of_its_year(studied):
    result, asked = studied("overland_10km")
    energy = result.to_dict(asked)["energy"]
    assert asked.duty is not None
    assert energy["kWh_per_year"] == pytest.approx(asked.duty.year.net_kwh, rel=1e-12)
    assert energy["cost_per_year"] == pytest.approx(asked.duty.cost, rel=1e-12)
    assert result.to_dict()["energy"]["kWh_per_year"] is None
