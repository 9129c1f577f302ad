"""The flooded belt: bulk from edge to edge, by hand and as a spec of that flow."""

from __future__ import annotations

import json
import math

import pytest

import conveyor
from conveyor.errors import NoSolutionError
from conveyor.models.fields import with_fields
from conveyor.report.tables.study_tables import flooded_belt as flooded_table
from conveyor.studies.flooding import flooded_belt
from conveyor.units import si
from tests.command_line import ROOT, run

SPEC = ROOT / "examples" / "specs" / "transfer.yaml"
CONTACTS = 2e-3
"""Of indentation, solved to 1e-3 here and there, within a whole of which it is a part."""


@pytest.fixture(scope="module")
def own():
    return conveyor.analyse(conveyor.load(SPEC))


@pytest.fixture(scope="module")
def flooded(own):
    return flooded_belt(own)


def test_it_is_the_trough_to_the_belts_edges_and_its_heap(own, flooded):
    """ISO 5048's section with the whole belt under the bulk: b = B."""
    belt, carry = si(own.conveyor.belt.width), own.conveyor.idlers.carry
    middle, angle = si(carry.roll.length), si(carry.trough_angle)
    assert carry.rolls == 3
    wing = 0.5 * (belt - middle)
    across = middle + 2.0 * wing * math.cos(angle)
    area = (
        0.5 * (middle + across) * wing * math.sin(angle) + across**2 * math.tan(own.conveyor.material.surcharge) / 6.0
    )
    assert flooded.section == pytest.approx(area, rel=1e-12)
    line = flooded.found.line
    assert line.flow == pytest.approx(area * line.speed * line.density, rel=1e-12)
    assert flooded.line_mass == pytest.approx(own.line.stretches[0].belt_mass + area * line.density, rel=1e-12)


def test_it_is_what_a_spec_of_that_flow_comes_to(own, flooded):
    """At the take-up's setting of the design, not at one of its own."""
    setting = own.balance.equilibrium.setting
    flow = {"material.flow": f"{flooded.found.line.flow!r} kg/s"}
    asked = conveyor.analyse(with_fields(own.conveyor, flow)).balance.held(setting)
    found = flooded.found.balance
    assert found.equilibrium.setting == pytest.approx(setting, rel=1e-12)
    assert found.forces.total == pytest.approx(asked.forces.total, rel=CONTACTS)
    assert found.tensions.largest == pytest.approx(asked.tensions.largest, rel=CONTACTS)
    assert found.forces.lift == pytest.approx(asked.forces.lift, rel=1e-9)


def test_a_set_bears_belt_and_bulk_over_its_spacing(flooded):
    stretch = flooded.heaviest
    weight = stretch.line_mass * flooded.found.line.gravity * math.cos(stretch.inclination) * stretch.spacing
    assert stretch.turn is None
    assert flooded.set_load == pytest.approx(weight, rel=1e-9)


def test_a_conveyor_without_bulk_is_not_flooded(own):
    empty = conveyor.analyse(with_fields(own.conveyor, {"material.flow": "0 t/h"}))
    assert flooded_belt(empty) is None


def test_a_flooded_belt_without_an_answer_says_why(own, monkeypatch):
    """As the contacts of its heavier rolls may have none."""
    none = NoSolutionError("the roll presses through its cover")
    monkeypatch.setattr("conveyor.studies.flooding.calculate_many", lambda *_, **__: [none])
    found = flooded_belt(own)
    assert found.found is found.set_load is found.line_mass is None
    table = flooded_table(found)
    assert table.note == "No answer: the roll presses through its cover."
    assert len(table.rows) == 2


def test_every_output_has_it(tmp_path):
    done = run("power", SPEC, "--json", "-o", "a.xlsx", "--tables", ".", cwd=tmp_path)
    figures = json.loads(done.stdout)["flooded"]
    assert figures["cross-section over what the belt holds [-]"] > 1.0
    assert figures["motor power [kW]"] > json.loads(done.stdout)["power_kW"]["motor"]
    assert "load of a carry set" in (tmp_path / "flooded.csv").read_text(encoding="utf-8")
    assert "flooded belt: cross-section of the bulk" in " ".join(run("power", SPEC).stdout.split())
