"""No value beside that of the best design makes a cheaper one that is shown as valid."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor.report.tables.sizing_tables import sizing_contents, sizing_json
from conveyor.sizing import size_conveyor
from conveyor.sizing.sensitivity import vary_choices
from conveyor.sizing.sized_design import SizedDesign
from conveyor.studies.loads import every_load
from conveyor.studies.study_file import read_duty

DUTIES = Path(__file__).parents[2] / "examples" / "duties"
NARROW = {"widths": ["800 mm"], "trough_angles": ["35 deg"], "drives": ["head"], "carcasses": ["EP"]}
US = {"widths": ["36 in"], "trough_angles": ["35 deg"], "drives": ["head"], "carcasses": ["EP"]}
DOWN = {"widths": ["800 mm"], "trough_angles": ["45 deg"], "drives": ["tail"], "carcasses": ["steel cord"]}
FACTOR = {"method": "din 22101", "friction_factor": 0.022}
CEMA = {"method": "cema classic", "cema": {"flexure_factor": 0.028, "idler_friction": "2.3 lbf"}}
CASES = {
    "in-plant": ("in_plant", NARROW, {}),
    "in-plant, even distances": ("in_plant", NARROW | {"graduated": False}, {}),
    "in-plant, US": ("in_plant_us", US, {}),
    "downhill": ("downhill", DOWN, {}),
    "in-plant, DIN 22101": ("in_plant", NARROW, {"calculation": FACTOR}),
    "in-plant, US, CEMA": ("in_plant_us", US, {"calculation": CEMA}),
}


@pytest.fixture(scope="module", params=CASES)
def sized(request):
    stem, rules, changes = CASES[request.param]
    given = read_duty(DUTIES / f"{stem}.yaml")
    asked = rules | ({"fastest": "4 m/s"} if stem == "downhill" else {})
    return size_conveyor(given.replace(rules=asked, **changes), best=1)


def test_no_value_shown_as_valid_costs_less_than_rank_1(sized):
    best = sized.best
    near = {
        (sweep.name, value): design
        for sweep in vary_choices(sized.task, best, sized.neighbours)
        for value, design in zip(sweep.values, sweep.designs, strict=True)
        if isinstance(design, SizedDesign)
    }
    assert len(near) > 5
    cheaper = {key: one.year for key, one in near.items() if one.year < best.year * (1.0 - 1e-9)}
    assert not cheaper


def test_values_said_to_hold_in_every_load_do_when_their_spec_is_calculated_again(sized):
    """The nearest rivals of rank 1, as `conveyor power` judges their spec."""
    sweeps = vary_choices(sized.task, sized.best, sized.neighbours)
    held = {
        design.choice: design
        for sweep in sweeps
        for design, every in zip(sweep.designs, sweep.every_load, strict=True)
        if every and isinstance(design, SizedDesign)
    }
    rivals = sorted(held.values(), key=lambda one: one.year)[:3]
    assert rivals
    for one in rivals:
        assert not [check.subject.text() for check in every_load(one.conveyor).governing if check.failed]
    told = sizing_json(sizing_contents(sized, "SI"), sized)["around"]
    assert {row.get("calculated_for", "") for row in told} <= {"every load", "full belt", ""}
    assert min(row["cost_per_year"] for row in told if row.get("cost_per_year")) >= sized.best.year * (1.0 - 1e-9)
