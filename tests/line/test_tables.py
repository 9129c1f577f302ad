"""What tables and plain data show of sections, rolls and resistances is what was calculated."""

from __future__ import annotations

import json
import math

import pytest

import conveyor
from tests.line.test_resistances_laws import BELT, CEMA, with_flexure
from tests.line.test_rolls_drag import LIFE, MAKER, SPECS, carry_roll
from tests.written_tables import written_tables


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "overland.yaml")


@pytest.fixture(scope="module")
def result(line):
    return conveyor.analyse(line)


@pytest.mark.parametrize("name", ["overland", "in_plant_us", "downhill"])
def test_resistances_add_up(name):
    found = conveyor.analyse(conveyor.load(SPECS / f"{name}.yaml"))
    assert found.resistances["force [N]"].sum() == pytest.approx(found.balance.forces.total, rel=1e-12)


def test_a_law_of_flexure_is_named_as_source(line):
    found = conveyor.analyse(with_flexure(line, belt=BELT))
    table = found.resistances.set_index("resistance")
    assert table.loc["flexure of belt and bulk, carry", "source"] == "calculation.flexure, laws"
    assert found.resistances["force [N]"].sum() == pytest.approx(found.balance.forces.total, rel=1e-12)


def test_an_empty_belt_has_no_energy_per_tonne(line):
    empty = conveyor.analyse(line.replace(material=line.material.replace(flow="0 t/h")))
    assert "energy [kWh/(t km)]" not in empty.summary.index


def test_unloaded_sections_show_no_bulk(line):
    sections = [section.replace(loaded=False) for section in line.route.sections]
    found = conveyor.analyse(line.replace(route=line.route.replace(sections=sections)))
    assert (found.sections["bulk mass [kg/m]"] == 0.0).all()


def test_json_is_plain_and_finite(result):
    text = json.dumps(result.to_dict(), allow_nan=False)
    assert json.loads(text)["forces_N"]["total"] == pytest.approx(result.balance.forces.total, rel=1e-14)


def test_cema_stands_beside_only_where_its_factors_are_given(line, result, tmp_path):
    (tmp_path / "plain").mkdir()
    classical = written_tables(result, tmp_path / "plain")["classical"]
    assert list(classical.columns) == ["quantity", "this calculation", "classical, given f"]
    found = conveyor.analyse(line.replace(calculation=line.calculation.replace(cema=CEMA)))
    table = written_tables(found, tmp_path)["classical"].set_index("quantity")["CEMA classic, given Ky"]
    table = table[[name for name in table.index if name.endswith(("[N]", "[kW]"))]].astype(float)
    parts = table["main [N]"] + table["secondary [N]"] + table["special [N]"] + table["lift force [N]"]
    assert table["effective tension [N]"] == pytest.approx(parts, rel=1e-12)
    told = found.to_dict()["cema"]
    assert told["total_N"] == pytest.approx(table["effective tension [N]"], rel=1e-14)
    assert told["motor_kW"] == pytest.approx(table["motor power [kW]"], rel=1e-14)
    assert result.to_dict()["cema"] is None


def test_tables_show_drag_and_life_where_bearings_are_given(line, result):
    assert {"rim drag [N]", "rotation [rpm]"} <= set(result.rolls.columns)
    assert "roll L10 life [h]" not in result.rolls
    assert "idler set L10 life [h]" not in result.sections
    found = conveyor.analyse(carry_roll(line, bearing=LIFE, drag_law=MAKER))
    carry = found.rolls[found.rolls["strand"] == "carry"]
    assert carry["rim drag [N]"][:3].tolist() == pytest.approx(found.line.roll_drags[0], rel=1e-14)
    assert carry["rotation [rpm]"].to_numpy() == pytest.approx(60.0 * 5.0 / (math.pi * 0.159), rel=1e-12)
    assert carry["roll L10 life [h]"].notna().all()
    assert found.sections["idler set L10 life [h]"].notna().sum() == len(line.route.sections)
