"""docs/nomenclature.md names every column of the tables, every key of the JSON, every field of the contact."""

from __future__ import annotations

import dataclasses
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

import pandas as pd
import pytest

import conveyor
from conveyor.contact import ContactProblem, ContactSolution, CreepSpectrum
from conveyor.report.tables.comparison_tables import comparison_contents, comparison_json
from conveyor.spec import from_data
from conveyor.starter.output_reference import output_page
from tests.worked_examples import worked_example

ROOT = Path(__file__).parent.parent
SPECS = ("overland_10km", "downhill_brakes", "in_plant_us")
NO_UNIT = "-"
OF_WORDS = {"breakdown", "governing_cases", "inputs", "provenance", "remarks"}
"""Tables that docs/workbook.md explains."""
ADD = "a row of conveyor/_reference/nomenclature.md names it with its kind; then " + (
    "conveyor schema --nomenclature > docs/nomenclature.md"
)
CURRENCY = re.compile(r"[A-Z]{3}(/kWh)?|-")


@cache
def page() -> str:
    return (ROOT / "docs" / "nomenclature.md").read_text(encoding="utf-8")


@cache
def lines() -> list[tuple[list[str], list[str], str]]:
    """Names, units and meaning of every row of the tables."""
    found = []
    for line in page().splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) == 5:
            units = [unit.strip() for unit in cells[2].replace("in *Duty*,", ",").split(",")]
            found.append((re.findall(r"`([^`]+)`", cells[0]), units, cells[4]))
    return found


@cache
def rows() -> dict[str, list[str]]:
    """Names of the tables, each with the units that its rows give it."""
    found: dict[str, list[str]] = {}
    for names, units, meaning in lines():
        for name in names:
            found.setdefault(name, []).extend(units)
        if "in *Duty*" in meaning:
            found["energy"].append("MWh")
    return found


def test_a_name_with_a_unit_has_one_meaning() -> None:
    met = Counter((name, unit) for names, units, _ in lines() for name in names for unit in set(units))
    twice = {name for (name, _), count in met.items() if count > 1}
    assert twice == set(), "one row of conveyor/_reference/nomenclature.md has to go, or the column another name"


def frames(name: str) -> Iterator[pd.DataFrame | pd.Series]:
    result, asked = worked_example(name)
    for table in result.contents(asked).tables:
        if table.key not in OF_WORDS:
            yield pd.Series(dtype=float, index=table.frame().iloc[:, 0]) if table.by_row else table.frame()
    if asked.cases is not None:
        yield asked.cases.table


def comparison() -> conveyor.Comparison:
    line = worked_example("overland_10km")[0].conveyor
    return conveyor.compare_compounds(
        line, compounds=["standard-cover", "s100"], temperatures=["10 degC"], extra_costs={"s100": 2e4}
    )


def test_the_page_is_made_of_its_words() -> None:
    assert page() == output_page("nomenclature"), "conveyor schema --nomenclature > docs/nomenclature.md"


def names(frame: pd.DataFrame | pd.Series) -> Sequence[str]:
    return [str(name) for name in (frame.columns if isinstance(frame, pd.DataFrame) else frame.index)]


def missing(columns: Sequence[str]) -> set[str]:
    found = set()
    for column in columns:
        match = re.fullmatch(r"(.*?)(?:, FAILS: [^\[]*?)?(?: \[(.*)\])?", column)
        assert match is not None
        name = match[1]
        unit = match[2] or ""
        listed = rows().get(name)
        priced = CURRENCY.fullmatch(unit) and {"currency", "currency/kWh"} & set(listed or ())
        if listed is None or not (unit in listed or priced or (unit == "" and listed)):
            found.add(column)
    return found


@pytest.mark.parametrize("name", SPECS)
def test_every_column_of_an_analysis_is_named_with_its_unit(name: str) -> None:
    assert missing([column for frame in frames(name) for column in names(frame)]) == set(), ADD


def test_every_column_of_lives_is_named() -> None:
    line = worked_example("overland_10km")[0].conveyor
    bearing = {"dynamic_rating": "22 kN", "distance": "0.3 m"}
    data = line.as_data()
    for strand in ("carry", "return"):
        data["idlers"][strand]["roll"]["bearing"] = bearing
    result = conveyor.analyse(from_data(data))
    assert "roll L10 life [h]" in result.rolls
    assert missing([*names(result.rolls), *names(result.sections)]) == set(), ADD


def test_every_column_of_a_comparison_is_named_with_its_unit() -> None:
    found = comparison()
    held = comparison_contents(found, "SI")
    made = [
        found.table,
        found.ranking,
        *(held[key].frame() for key in ("coverage", "refused") if key in held),
    ]
    assert missing([column for frame in made for column in names(frame)]) == set(), ADD


def test_a_name_or_a_unit_that_is_not_there_would_be_seen() -> None:
    assert missing(["effective tension [N]"]) == set()
    assert missing(["effective tension [kN]", "effective pull [N]"]) == {
        "effective tension [kN]",
        "effective pull [N]",
    }


def keys(data: object, path: str = "") -> Iterator[str]:
    if isinstance(data, dict):
        for key, value in data.items():
            if not re.search(r"[ \[]", key):  # rows with the names of the tables
                yield path + key
                yield from keys(value, f"{path}{key}.")
    elif isinstance(data, list | tuple):
        for item in data:
            yield from keys(item, path.removesuffix(".") + "[].")


def test_every_key_of_the_json_is_named() -> None:
    told = set(re.findall(r"`([^`]+)`", page().replace("\n", " ")))
    for name in SPECS:
        result, asked = worked_example(name)
        for key in keys(result.to_dict(asked)):
            assert key in told or key.rsplit(".", 1)[-1] in rows(), f"{key}: {ADD}"
    for key in keys(comparison_json(comparison())):
        assert key in told or key.rsplit(".", 1)[-1] in rows(), f"{key}: {ADD}"


def test_every_field_of_the_contact_is_named() -> None:
    section = page().split("## The dimensionless contact")[1]
    told = {name.partition("(")[0] for name in re.findall(r"`([^`]+)`", section)}
    public = {name for name in vars(ContactSolution) if not name.startswith("_")}
    given = {field.name for kind in (ContactProblem, CreepSpectrum) for field in dataclasses.fields(kind)}
    assert (public | given) - told == set(), ADD
