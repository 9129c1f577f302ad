"""What the parts of a spec cost: every price alone by hand on 24 m, lives without interest, a year over its states."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError
from conveyor.models.prices import Prices, library_prices
from conveyor.models.study import StudyPlan
from conveyor.pipeline import calculate
from conveyor.studies.costs import conveyor_costs, conveyor_parts, missing_price_fields
from conveyor.studies.parametric_study import ParametricStudy, ResultStore, design_results, run_study
from tests.command_line import run as command

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
FREE = {name: f"0 {price.partition(' ')[2]}" for name, price in library_prices().items() if "EUR" in str(price)}
BY_HAND = [  # 24 m of 0.8 m: 24 sets of three rolls, 8 of one, 38.4 m² of belt
    ("textile", "1 EUR/m^2", 38.4),
    ("textile_strength", "1 EUR/(MN*m)", 0.4 * 38.4),
    ("steel_cord", "1 EUR/m^2", 0.0),
    ("cover", "1000 EUR/m^3", 6.0 * 38.4),
    ("special_cover", "1000 EUR/m^3", 0.0),
    ("splice", "1 EUR/m", 3 * 0.8),  # 48 m of rolls of 20 m
    ("roll", "1 EUR", 24 * 3 + 8),
    ("roll_mass", "1 EUR/kg", 24 * 3 * 2.4 + 8 * 6.5),
    ("set", "1 EUR/m", 32 * 0.8),
    ("structure", "1 EUR/m", 24.0),
    ("structure_width", "1 EUR/m^2", 24 * 0.8),
    ("drive", "1 EUR", 1.0),
    ("drive_power", "1 EUR/kW", 3.0),
    ("pulley_mass", "1 EUR/kg", 700.0),
    ("take_up", "1 EUR", 1.0),
]
PLAN = {
    "name": "n",
    "base": "shuttle.yaml",
    "axes": {"belt.speed": ["1 m/s", "1.2 m/s"]},
    "states": [
        {"hours": "2000 h", "material.flow": "250 t/h"},
        {"hours": "1000 h", "material.flow": "100 t/h"},
    ],
    "figures": ["capital_cost", "parts_cost_per_year", "cost_per_year", "total_cost_per_year"],
}


@pytest.fixture(scope="module")
def line():
    given = conveyor.load(SPECS / "shuttle.yaml")
    return given.replace(operation={"price": "0.1 EUR/kWh", "hours_per_year": "5000 h"})


@pytest.fixture(scope="module")
def result(line):
    return calculate(line)


def costed(result, **prices):
    amounts = Prices.from_data(FREE | {"roll_of_belt": "20 m"} | prices).amounts
    return conveyor_costs(conveyor_parts(result), amounts, seconds=5000 * 3600.0, energy=None)


@pytest.mark.parametrize(("name", "price", "expected"), BY_HAND)
def test_every_price_alone_is_that_of_its_part(result, name, price, expected):
    assert costed(result, **{name: price}).whole_capital == pytest.approx(expected, rel=1e-12)


def test_the_take_up_costs_by_what_it_is_set_to(result):
    costs = costed(result, take_up_force="1 EUR/kN")
    assert costs.whole_capital == pytest.approx(result.balance.equilibrium.setting / 1e3, rel=1e-12)


def test_another_rubber_than_that_of_the_top_cover_is_a_special_one(line):
    cover = line.belt.bottom_cover.replace(compound=shelf.compound("low-rolling-resistance-cover"))
    costs = costed(
        calculate(line.replace(belt=line.belt.replace(bottom_cover=cover))),
        special_cover="1000 EUR/m^3",
    )
    assert costs.whole_capital == pytest.approx(2.0 * 38.4, rel=1e-12)


def test_without_interest_a_year_is_the_capital_over_the_life(result):
    lives = {"interest": "0 %", "textile_life": 5.0, "years": 10.0, "roll_life": "20000 h", "upkeep": "0 %"}
    for price, life in (
        ({"textile": "1 EUR/m^2"}, 5.0),
        ({"drive": "1 EUR"}, 10.0),
        ({"roll": "1 EUR"}, 4.0),
    ):
        costs = costed(result, **price, **lives)
        assert costs.parts_year == pytest.approx(costs.whole_capital / life, rel=1e-12)
    upkeep = costed(result, **lives | {"upkeep": "10 %"}, drive="1 EUR").yearly["upkeep"]
    assert upkeep == pytest.approx(0.1, rel=1e-12)


def test_a_year_of_parts_and_energy_is_their_sum_and_the_states_wear_the_rolls(line, tmp_path):
    def first(line=line, **changes):
        study = ParametricStudy.of(StudyPlan.from_data(PLAN | changes), line, shelf.compound)
        with ResultStore(tmp_path / "a") as known:
            run_study(study, known)
            assert len(known) == 4  # whatever parts and energy cost
            return next(design_results(study, known)).figures

    found = first()
    assert found["total_cost_per_year"] == pytest.approx(found["parts_cost_per_year"] + found["cost_per_year"])
    lives = {"interest": "0 %", "roll_life": "30000 h", "upkeep": "0 %"}
    rolls = first(prices=FREE | lives | {"roll": "1 EUR"})  # 30000 h at 3000 h a year of the states
    assert rolls["parts_cost_per_year"] == pytest.approx(80.0 / 10.0)
    assert rolls["capital_cost"] == pytest.approx(80.0)
    dear = first(line.replace(operation={"price": "0.3 EUR/kWh", "hours_per_year": "1 h"}, notes="dear"))
    assert dear["cost_per_year"] == pytest.approx(3.0 * found["cost_per_year"])
    assert dear["parts_cost_per_year"] == pytest.approx(found["parts_cost_per_year"])


@pytest.mark.parametrize(
    ("changes", "plan", "said"),
    [
        ({}, {"prices": {"roll": "22 USD"}}, "give every price in one currency"),
        ({"operation": {"price": "0.1 USD/kWh", "hours_per_year": "1 h"}}, {}, "in USD, prices are in EUR"),
        (
            {"operation": None},
            {"states": [], "figures": ["parts_cost_per_year"]},
            "hours_per_year is not given",
        ),
        ({"drive": "installed_power"}, {}, "capital_cost: drive.installed_power is not given"),
    ],
)
def test_parts_without_a_price_are_refused_before_the_study_begins(line, changes, plan, said):
    if "drive" in changes:
        changes = {"drive": {k: v for k, v in line.drive.as_data().items() if k != changes["drive"]}}
        assert list(missing_price_fields(line.replace(**changes))) == ["drive.installed_power"]
    with pytest.raises(InputError, match=said):
        ParametricStudy.of(StudyPlan.from_data(PLAN | plan), line.replace(**changes), shelf.compound)


def test_the_command_has_a_front_of_capital_and_energy(tmp_path):
    file, spec = tmp_path / "study.json", tmp_path / "spec.yaml"
    text = (SPECS / "shuttle.yaml").read_text(encoding="utf-8")
    spec.write_text(f"{text}\noperation: {{hours_per_year: 5000 h, price: 0.1 EUR/kWh}}\n", encoding="utf-8")
    plan = PLAN | {
        "axes": {"idlers.carry.spacing": ["1 m", "1.1 m", "1.2 m"]},
        "base": "spec.yaml",
        "states": [],
    }
    best = {"best": {"capital_cost": "least", "energy_per_year": "least"}, "figures": []}
    file.write_text(json.dumps(plan | best), encoding="utf-8")
    done = command("study", file, "-o", tmp_path / "t.csv", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["front"] == [1, 2, 3]  # fewer sets are cheaper and draw more
