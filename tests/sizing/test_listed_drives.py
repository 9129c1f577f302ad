"""Pulleys and parts of drives of lists: chosen by hand-calculated demands, refused where none fits."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import conveyor
from conveyor.errors import NoSolutionError
from conveyor.report.tables.sizing_tables import listed_part_table, sizing_contents
from conveyor.sizing import size_conveyor
from conveyor.spec import dump_given, fingerprint
from conveyor.studies.loads import every_load
from conveyor.studies.study_file import read_duty
from conveyor.units import si
from tests.sizing.test_listed_parts import DUTY, LIST

SI = "rules: {drives: [head], widths: [800 mm], speeds: [2.5 m/s]}"
TRAIN = (
    "{motors: [M110], pulleys: [thin, stout], gearboxes: [G16-12, G16-25, G16-40], couplings: [C1000, C1250],"
    " backstops: [B1, B11, B18]}"
)


def size(folder: Path, listed: str, *, more: str = SI, duty: str = DUTY):
    """Sizing of a folder with the lists."""
    (folder / "conveyor-library").mkdir(exist_ok=True)
    (folder / "conveyor-library" / "parts.yaml").write_text(LIST, encoding="utf-8")
    path = folder / "duty.yaml"
    path.write_text(f"{duty}{more}\nlisted: {listed}\n", encoding="utf-8")
    return size_conveyor(read_duty(path), best=1)


@pytest.fixture(scope="module")
def sizing(tmp_path_factory):
    return size(tmp_path_factory.mktemp("listed"), TRAIN)


def test_the_belt_has_the_speed_of_motor_gearbox_and_pulley(sizing):
    """1485 rpm/16.2 × π × 0.5 m is 2.39983 m/s, 4 % below the 2.5 m/s asked for."""
    assert si(sizing.best.conveyor.belt.speed) == pytest.approx(2.39983, rel=1e-5)
    assert sizing.best.choice.speed == pytest.approx(1485.0 / 60.0 / 16.2 * math.pi * 0.5)
    assert sizing.best.choice.filling == pytest.approx(800.0 / 3.6 / 1600.0 / 2.399828 / sizing.best.choice.trough.area)


def test_torques_are_those_of_the_motor_with_the_service_factor(sizing):
    """1.5 × 110 kW/(2 π 1485/60 s): 1061 N m at the coupling, times 16.2 17.19 kN m at the gearbox."""
    listed = sizing.best.chosen.listed
    assert (listed.coupling.item.name, listed.gearbox.item.name) == ("C1250", "G16-25")
    assert listed.coupling.needed == pytest.approx(1061.03, rel=1e-5)
    assert listed.gearbox.needed == pytest.approx(17188.7, rel=1e-5)
    assert listed.gearbox.use == pytest.approx(0.68755, rel=1e-4)
    checks = {check.key: check for check in every_load(sizing.best.conveyor).governing}
    assert checks["gear_torque"].calculated == pytest.approx(17188.7, rel=1e-4)
    assert checks["coupling_torque"].required == pytest.approx(1250.0)
    assert not [check for check in checks.values() if check.failed]


def test_efficiency_is_that_of_gearbox_and_coupling(sizing):
    assert si(sizing.best.conveyor.drive.efficiency) == pytest.approx(0.96 * 0.99)


def test_the_backstop_holds_the_worst_load_with_reserve(sizing):
    """1.3 times the largest holding force of every load on half a metre of pulley."""
    loads = every_load(sizing.best.conveyor).designing
    held = max(one.motions.brake_to_hold for one in loads if one.motions.rolls_back)
    part = sizing.best.chosen.listed.backstop
    assert part.needed == pytest.approx(1.3 * held * 0.25, rel=1e-3)  # the contacts' tolerance
    assert part.item.name == "B11"
    assert sizing.best.conveyor.drive.backstop_torque.magnitude == pytest.approx(11.0)


def test_a_pulley_whose_shaft_is_too_thin_gives_way(sizing):
    names = {one.place: one.item.name for one in sizing.best.chosen.listed.pulleys}
    assert names["head"] == "stout"  # 60 mm of shaft bear neither torque nor pull
    built = {pulley.name: pulley.listed.name for pulley in sizing.best.conveyor.route.pulleys}
    assert built == names | {"bend 1": names["take-up"], "bend 2": names["take-up"]}


def test_the_written_spec_needs_no_list(tmp_path, sizing):
    path = tmp_path / "design.yaml"
    path.write_text(dump_given(sizing.best.conveyor), encoding="utf-8")
    again = conveyor.load(path)
    assert fingerprint(again) == fingerprint(sizing.best.conveyor)
    assert [item.name for item in again.drive.listed] == ["M110", "G16-25", "C1250", "B11"]


def test_the_report_has_every_item_with_its_use(sizing):
    rows = listed_part_table(sizing).rows
    assert [(part.place, part.item.one) for _, part in rows] == [
        ("head", "pulley"), ("take-up", "pulley"), ("tail", "pulley"), ("drive", "gearbox"), ("drive", "coupling"),
        ("drive", "backstop"),
    ]  # fmt: skip
    contents = sizing_contents(sizing, "US", vary=False)
    gear = next(row for row in contents["listed_parts"].plain() if row["part"] == "gearbox")
    assert gear["use"] == pytest.approx(0.68755, rel=1e-4)
    told = contents.lines("assumption")
    assert "pulley stout: the lagging is not judged, its list has no lagging_pressure" in told


@pytest.mark.parametrize(
    ("listed", "told"),
    [
        (
            "{motors: [M110], pulleys: [stout], gearboxes: [G16-12]}",
            r"its gearboxes need 17,200 N m, the largest listed of a ratio that suits .* G16-12, has 12,000 N m",
        ),
        (
            "{motors: [M110], pulleys: [stout], gearboxes: [fast]}",
            r"a ratio of about 15\.55 for 2\.5 m/s with drive pulleys of 500 mm, the nearest listed, fast, has 2\.5",
        ),
        ("{motors: [M110], couplings: [C1000]}", r"its couplings need 1,060 N m, the largest listed, C1000, has 1,000"),
        ("{backstops: [B1]}", r"its backstops need .* N m, the largest listed, B1, has 1,000 N m"),
        ("{pulleys: [narrow]}", r"with a face of 900 mm, the widest listed has a face of 850 mm"),
    ],
)
def test_where_no_item_is_enough_demand_and_largest_are_named(tmp_path, listed, told):
    with pytest.raises(NoSolutionError, match=told):
        size(tmp_path, listed)


def test_a_downhill_belt_is_held_by_a_listed_brake_that_bears_the_heat(tmp_path):
    """BR1 is too weak and BR40 bears 1 kJ, a stop of some tons at 2.5 m/s has more."""
    down = DUTY.replace("lift: 25 m", "lift: -30 m")
    best = size(tmp_path, "{brakes: [BR1, BR40, BR60]}", duty=down).best
    part = best.chosen.listed.brake
    assert part.item.name == "BR60"
    assert si(best.conveyor.drive.brake_force) == pytest.approx(60e3)
    assert part.needed < 60e3


def test_a_brake_at_the_motors_shaft_is_judged_by_its_force_at_the_belt(tmp_path):
    """1485 rpm over 2.5 m/s on a pulley of 0.5 m is a ratio of 15.551: 700 N m are 43.5 kN, 1200 N m 74.6 kN."""
    down = DUTY.replace("lift: 25 m", "lift: -30 m")
    best = size(tmp_path, "{motors: [M110], pulleys: [stout], brakes: [ED700, ED1200]}", duty=down).best
    part, ratio = best.chosen.listed.brake, 1485.0 / 60.0 * math.pi * 0.5 / 2.5
    rated = {"ED700": 700.0 * ratio / 0.25, "ED1200": 1200.0 * ratio / 0.25}
    assert part.rated == pytest.approx(rated[part.item.name])
    assert part.item.name == next(name for name, force in rated.items() if force >= part.needed)
    assert best.found.line.drives[0].brake == pytest.approx(part.rated, rel=1e-4)  # four decimals of the ratio
    assert not [check for check in every_load(best.conveyor).governing if check.failed]


def test_a_backstop_at_the_motors_shaft_is_judged_at_the_pulley(sizing, tmp_path):
    """What B11 bears at the pulley, 11 kN m, are 679 N m at the shaft of a motor of the ratio 16.2."""
    listed = TRAIN.replace("[B1, B11, B18]", "[HS600, HS690]")
    part = size(tmp_path, listed).best.chosen.listed.backstop
    assert part.needed == pytest.approx(sizing.best.chosen.listed.backstop.needed, rel=1e-6)
    rated = {"HS600": 600.0 * 16.2, "HS690": 690.0 * 16.2}
    assert part.rated == pytest.approx(rated[part.item.name])
    assert part.item.name == next(name for name, torque in rated.items() if torque >= part.needed)


def test_a_duty_in_us_units_is_refused_in_them(tmp_path):
    us = "rules: {drives: [head], series: metric, widths: [800 mm], speeds: [2.5 m/s]}\nreport: {units: US}"
    with pytest.raises(NoSolutionError, match=r"its gearboxes need 12,700 lbf ft, .* G16-12, has 8,850 lbf ft"):
        size(tmp_path, "{motors: [M110], pulleys: [stout], gearboxes: [G16-12]}", more=us)
