"""Cold duties are held by the written spec; where the belt drives its drives, no take-up stands under the bulk."""

from __future__ import annotations

import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.models.sizing import SizingDuty
from conveyor.sizing import size_conveyor
from conveyor.studies.loads import every_load
from conveyor.units import si

FEW = {"widths": ["800 mm"], "speeds": ["2.5 m/s"], "trough_angles": ["35 deg"], "carcasses": ["steel cord"]}
CEMA = {"method": "cema classic", "cema": {"flexure_factor": 0.028, "idler_friction": "2.3 lbf"}}


def duty(**more):
    return SizingDuty.from_data({
        "name": "ore",
        "material": {"name": "ore", "density": "2.2 t/m^3", "flow": "800 t/h", "surcharge_angle": "15 deg"},
        "lump": "100 mm", "length": "900 m", "lift": "-90 m", "ambient": {"temperature": "15 degC"},
        "operation": {"hours_per_year": "5000 h", "price": "0.12 EUR/kWh", "feed_in_price": "0.05 EUR/kWh"},
        "covers": [shelf.compound("standard-cover")], "rules": FEW, **more,
    })  # fmt: skip


@pytest.mark.parametrize("drives", ["head", "tail"])
def test_no_take_up_stands_under_bulk_and_a_written_one_there_fails(drives):
    best = size_conveyor(duty(rules=FEW | {"drives": [drives]}), best=1).best
    assert best.found.balance.equilibrium.force < 0.0
    found = {check.key: check for check in every_load(best.conveyor).governing}
    assert found["take_up_place"].verdict == "pass"
    if drives == "head":
        assert best.conveyor.route.take_up.position == "head"
        route = best.conveyor.route
        there = best.conveyor.replace(route=route.replace(take_up={"kind": "gravity", "position": "drive"}))
        failed = next(check for check in every_load(there).governing if check.key == "take_up_place")
        assert failed.verdict == "FAIL"


def test_a_cold_design_holds_in_the_cold_by_its_spec_alone():
    """Rolls drag more in cold air, one weight serves both temperatures, and the spec has the case."""
    best = size_conveyor(duty(lift="30 m", coldest="-20 degC"), best=1).best
    spec = best.conveyor
    assert [case.name for case in spec.cases] == ["coldest"]
    loads = every_load(spec)
    assert not [check.subject.text() for check in loads.governing if check.failed]
    assert si(spec.route.take_up.tension) >= max(one.balance.equilibrium.needed for one in loads.designing) * (
        1.0 - 1e-9
    )
    drags = [sum(f.total for f in one.balance.along if f.key == "idler_rotation") for one in best.pair]
    assert drags[1] > 1.5 * drags[0]  # grease at -20 degC is more than twice as stiff; seals are not


def test_a_coldest_above_the_ambient_and_frost_without_kt_are_refused():
    with pytest.raises(InputError, match=r"coldest: got 40 degC, warmer than the covers"):
        duty(coldest="40 degC")
    with pytest.raises(InputError, match=r"temperature_factor: missing: at -5 degC"):
        duty(coldest="-5 degC", calculation=CEMA)
    assert duty(coldest="-5 degC", calculation=CEMA | {"cema": CEMA["cema"] | {"temperature_factor": 1.2}})


def test_the_friction_to_design_for_is_that_of_the_rules():
    best = size_conveyor(duty(lift="30 m", rules=FEW | {"design_friction": "150 %"}), best=1).best
    assert best.coldest.line.design_friction == pytest.approx(1.5)
