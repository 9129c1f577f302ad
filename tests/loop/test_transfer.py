"""Loading points, cleaners and discharge of a whole conveyor: figures by hand, criteria, and a spec without them."""

from __future__ import annotations

import math

import pytest

from conveyor.assessment import Assessment
from conveyor.checks.bulk_checks import belt_cleaning, impact_load, skirtboards
from conveyor.errors import InputError
from conveyor.laws.discharge import bulk_on_pulley, width_on_pulley
from conveyor.pipeline import calculate
from conveyor.report.tables.analysis_contents import AnalysisTables
from conveyor.spec import from_data
from conveyor.starter import starter_values

TAIL = {"name": "tail", "position": "tail", "diameter": "1 m", "shaft_diameter": "0.2 m", "mass": "1 t"}
OF_TRANSFER = {"landings", "cleaners", "discharge", "trajectory", "pulley_outline"}


def _spec(**route):
    data = starter_values("in-plant")
    feeding = {**data["route"]["feeding"], **route.pop("feeding", {})}
    data["route"] = {**data["route"], "feeding": feeding, **route}
    data.pop("cases", None)
    return data


@pytest.fixture(scope="module")
def plain():
    return calculate(from_data(_spec()))


@pytest.fixture(scope="module")
def found():
    return calculate(from_data(_spec(
        feeding={"drop_height": "1.5 m", "lump_mass": "30 kg", "idler_stiffness": "400 kN/m", "idler_spacing": "0.4 m",
                 "idler_rating": "15 kN", "skirtboards": "0.5 m", "seal_drag": "88 N/m"},
        carryback="0.5 kg/m^2", carryback_allowed="0.01 kg/m^2", discharge={"drop": "2 m", "pulley_diameter": "1 m"},
    )))  # fmt: skip


def test_without_the_fields_nothing_is_asked(plain):
    assert [*impact_load(plain), *skirtboards(plain), *belt_cleaning(plain)] == []
    assert plain.trajectory is None
    assert not OF_TRANSFER & set(AnalysisTables(Assessment(plain)))


def test_seals_drag_over_the_skirtboards_and_nothing_else_changes(plain, found):
    seals = [force for force in found.balance.every if force.key == "skirt_seals"]
    assert [force.total for force in seals] == pytest.approx([0.5 * 88.0])
    before, after = plain.balance.forces, found.balance.forces
    assert after.total - before.total == pytest.approx(44.0, abs=1e-3 * after.total)
    assert after.indentation == pytest.approx(before.indentation, rel=1e-12)


def test_without_a_spring_rate_a_lump_is_not_checked_and_the_stream_alone_is():
    def of(**given):
        feeding = {"drop_height": "1.5 m", "idler_spacing": "0.4 m", "idler_rating": "15 kN"} | given
        (check,) = impact_load(calculate(from_data(_spec(feeding=feeding))))
        return check.verdict, check.required, check.asked.text()

    assert of(lump_mass="30 kg") == (
        "not checked", None, "spring rate for the lump (idler_stiffness) not given",
    )  # fmt: skip
    assert of()[:2] == ("pass", 15e3)


def test_impact_is_the_lump_on_its_spring_over_what_rests_there(found):
    (landing,) = found.loading_point_duty
    weight, stretch = 30.0 * found.line.gravity, found.line.stretches[0]
    lump = weight + math.sqrt(weight**2 + 2.0 * 400e3 * weight * 1.5)
    resting = (stretch.belt_mass + stretch.bulk_mass) * found.line.gravity * 0.4
    assert landing.load == pytest.approx(resting + lump, rel=1e-12)
    assert landing.stream == pytest.approx(found.line.flow * math.sqrt(2.0 * found.line.gravity * 1.5), rel=1e-12)
    (check,) = impact_load(found)
    assert (check.failed, check.required) == (True, 15e3)
    (boards,) = skirtboards(found)
    assert boards.failed == (landing.acceleration > 0.5)


def test_what_is_left_on_the_belt_is_checked(found):
    (cleaning, *_), (check,) = found.cleaner_duty, belt_cleaning(found)
    each = cleaning.scraper
    left = 0.5 * (1.0 - each.efficiency) ** each.count
    assert check.calculated == pytest.approx(left, rel=1e-12)
    assert cleaning.lost == pytest.approx(left * each.width * found.line.speed, rel=1e-12)
    assert check.failed == (left > 0.01)


def test_trajectory_begins_on_the_bulk_and_ends_at_the_depth(found):
    path, line = found.trajectory, found.line
    area = line.flow / line.speed / line.density
    bulk = bulk_on_pulley(area, width=width_on_pulley(line.belt.width))
    assert path.radius == pytest.approx(0.5 + line.belt.thickness + bulk.centroid, rel=1e-12)
    start = math.hypot(path.fall.across[0], path.fall.up[0])
    assert start == pytest.approx(path.radius, rel=1e-12)
    assert path.fall.up[-1] == pytest.approx(-2.0, rel=1e-12)
    shown = AnalysisTables(Assessment(found))
    assert set(shown) >= OF_TRANSFER
    assert len(shown["trajectory"].rows) >= path.fall.time.size


@pytest.mark.parametrize(("belt_speed", "wraps"), [("1.6 m/s", True), ("3 m/s", False)])
def test_the_centre_of_the_bulk_is_faster_than_the_belt_by_their_radii(belt_speed, wraps):
    """V = v r/R with r of the bulk, R of the belt's face; a slow one is carried to V²/(g r) = cos θ."""
    data = _spec(discharge={"drop": "2 m", "pulley_diameter": "1 m"})
    data["belt"] = {**data["belt"], "speed": belt_speed}
    data["material"] = {**data["material"], "flow": "300 t/h"}
    one = calculate(from_data(data))
    path, line = one.trajectory, one.line
    face = 0.5 + line.belt.thickness
    area = 300.0 / 3.6 / line.speed / line.density
    radius = face + bulk_on_pulley(area, width=width_on_pulley(line.belt.width)).centroid
    speed = line.speed * (radius / face)
    assert path.ratio == pytest.approx(speed**2 / (line.gravity * radius), rel=1e-12)
    assert path.wraps == wraps
    if wraps:
        assert path.speed == pytest.approx(speed, rel=1e-12)
        assert math.cos(path.angle) == pytest.approx(speed**2 / (line.gravity * radius), rel=1e-12)
    else:
        assert path.speed == pytest.approx(line.speed, rel=1e-12)


@pytest.mark.parametrize(
    ("route", "message"),
    [
        ({"feeding": {"lump_mass": "3 kg"}}, "route.feeding.lump_mass.*given without drop_height"),
        ({"discharge": {"drop": "2 m", "friction": 0.4, "sliding_friction": 0.5}}, "more than friction 0.4"),
        ({"discharge": {"drop": "2 m"}, "pulleys": [TAIL]},
         "no pulley of route.pulleys stands at the head"),
        ({"feeding": {"idler_stiffness": "400 kN", "drop_height": "1 m"}}, "spring rate"),
    ],
)  # fmt: skip
def test_what_does_not_fit_together_is_refused(route, message):
    with pytest.raises(InputError, match=message):
        from_data(_spec(**route))
