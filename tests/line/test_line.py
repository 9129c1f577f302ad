"""From spec to force: conservation, invariance, hand-checked integrals, the loop of tensions."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from conveyor.force_sums import Force, ForceSums
from conveyor.indentation import RollContact, indentation_curve, indentation_resistance
from conveyor.laboratory import read_dma
from conveyor.laws.resistance import length_coefficient
from conveyor.models import Conveyor
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.rubber import PronySeries, fit_prony, shift_series
from conveyor.shelf import built_in, compound
from conveyor.spec import from_data, load
from conveyor.units import quantity, si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-6
"""Default relative tolerance of the contact: two load curves over different ranges differ by no more than twice it."""


@pytest.fixture(scope="module")
def line() -> Conveyor:
    return load(SPECS / "overland.yaml")


@pytest.fixture(scope="module")
def result(line):
    return calculate(line)


@pytest.mark.parametrize("name", ["overland", "in_plant_us", "downhill"])
def test_the_loop_closes_and_power_is_force_times_speed(name):
    found = calculate(load(SPECS / f"{name}.yaml"))
    forces, points = found.balance.forces, found.balance.tension_points
    assert points[-1].tension - points[0].tension == pytest.approx(forces.total, rel=1e-9)
    assert math.fsum(force.total for force in found.balance.every) == pytest.approx(forces.total, rel=1e-12)
    speed = si(found.conveyor.belt.speed)
    assert found.balance.power.belt == pytest.approx(forces.total * speed, rel=1e-14)
    assert all(point.tension >= point.least_for_sag * (1.0 - 1e-12) for point in points)
    assert found.balance.tensions.slack == pytest.approx(min(points[0].tension, points[-1].tension), rel=1e-12)


@pytest.mark.parametrize("name", ["overland", "downhill"])
def test_the_sag_asks_for_tension_between_the_sets_and_not_at_pulleys(name):
    """m' g a / (8 h), with the bulk on the carry side: 12.5 m' g a where the belt sags by 1 % of the span."""
    found = calculate(load(SPECS / f"{name}.yaml"))
    conveyor, points = found.conveyor, found.balance.tension_points
    pulleys = [point for point in points if point.place.endswith(("arriving", "leaving"))]
    assert len(pulleys) >= 2
    assert {point.least_for_sag for point in pulleys} == {0.0}
    last = conveyor.route.sections[-1]
    bulk = si(conveyor.material.flow) / si(conveyor.belt.speed)
    for strand, own, more in (("carry", "carry", bulk), ("return", "return_", 0.0)):
        spacing = si(getattr(last, f"{strand}_spacing") or getattr(conveyor.idlers, own).spacing)
        belt = found.line.stretches[0].belt_mass
        asked = (belt + more) * 9.81 * spacing / (8.0 * si(getattr(conveyor.idlers, own).sag))
        (there,) = (point for point in points if point.place == f"{last.name}, {strand}, end")
        assert there.least_for_sag == pytest.approx(asked, rel=1e-9)


def test_lift_is_that_of_the_bulk_alone(line, result):
    bulk = si(line.material.flow) / si(line.belt.speed)
    expected = bulk * 9.81 * line.route.rise
    assert result.balance.forces.lift == pytest.approx(expected, rel=1e-12)


def test_downhill_feeds_back_through_the_efficiency():
    found = calculate(load(SPECS / "downhill.yaml"))
    power = found.balance.power
    assert power.belt < 0.0
    assert power.motor == pytest.approx(power.belt * si(found.conveyor.drive.efficiency), rel=1e-14)


def test_splitting_a_section_changes_nothing_but_the_tension_between_its_ends(line, result):
    """Linear within a section: off by at most a quarter of its flexure, which is as much of that over the tension."""
    sections = list(line.route.sections)
    old = sections[3]
    length, rise = si(old.length), old.rise
    halves = [
        old.replace(name=f"half {i}", length=quantity(f"{length / 2.0!r} m"), lift=quantity(f"{rise / 2.0!r} m"))
        for i in (1, 2)
    ]
    split = line.replace(route=line.route.replace(sections=[*sections[:3], *halves, *sections[4:]]))
    other = calculate(split).balance
    before, after = result.balance.forces, other.forces
    main = {"indentation", "idler_rotation", "flexure", "misalignment"}
    assert set(before.parts) == main | {"secondary", "special", "lift"}
    (flexure,) = (force.newtons for force in result.balance.along if force.key == "flexure")
    nearly = 0.25 * float(flexure[3]) ** 2 / result.balance.tensions.smallest
    for name, part in before.parts.items():
        rounding = {"flexure": nearly, "secondary": nearly}.get(name, 1e-11 * abs(part))
        assert after.parts[name] == pytest.approx(part, abs=rounding), name
    assert after.total == pytest.approx(before.total, abs=2.0 * nearly)


def test_units_change_nothing(line, result):
    metres = line.replace(
        belt=line.belt.replace(width=quantity("1.2 m"), speed=quantity("18 km/h")),
        material=line.material.replace(flow=quantity("2400000 kg/h"), density=quantity("0.85 t/m^3")),
    )
    other = calculate(metres).balance.forces.total
    assert other == pytest.approx(result.balance.forces.total, rel=1e-11)


def test_an_empty_belt_lifts_nothing(line):
    empty = calculate(line.replace(material=line.material.replace(flow=quantity("0 t/h"))))
    assert empty.balance.forces.lift == pytest.approx(0.0, abs=1e-9)
    assert empty.balance.power.energy_per_tonne_km is None
    assert empty.balance.forces.indentation > 0.0


def test_unloaded_sections_carry_no_bulk(line):
    sections = [section.replace(loaded=False) for section in line.route.sections]
    found = calculate(line.replace(route=line.route.replace(sections=sections)))
    assert all(stretch.bulk_mass == 0.0 for stretch in found.line.stretches)


def test_gauss_points_along_a_roll_suffice(line, result):
    theory = line.calculation.replace(anchor="off", strain="off")
    few, many = (
        calculate(line.replace(calculation=theory.replace(gauss_points=points))).balance.forces.indentation
        for points in (line.calculation.gauss_points, 32)
    )
    assert few == pytest.approx(many, rel=2.0 * RTOL)
    # the level of the tests has a kink where their loads end, and the working strain is known to a hundredth
    fine = calculate(line.replace(calculation=line.calculation.replace(gauss_points=32)))
    assert fine.balance.forces.indentation == pytest.approx(result.balance.forces.indentation, rel=1e-3)


def test_the_forces_along_a_stretch_add_up(result):
    kinds = {force.key: force.kind for force in result.balance.along}
    for r in result.stretches:
        main = [r.forces[key] for key in ("indentation", "idler_rotation", "flexure", "misalignment")]
        assert r.main == pytest.approx(math.fsum(main), rel=1e-15)
        assert r.total == pytest.approx(r.main + r.forces["tilt"] + r.forces["lift"], rel=1e-13)
        assert set(r.forces) == set(kinds)
    along = math.fsum(force.total for force in result.balance.along)
    assert math.fsum(r.total for r in result.stretches) == pytest.approx(along, rel=1e-13)


def test_the_forces_add_up_by_kind():
    along = {"indentation": 1000.0, "rotation": 200.0, "flexure": 130.0}
    forces = [Force(name, name, "main", np.array([force - 50.0, 50.0]), "test") for name, force in along.items()]
    tilt = Force("tilt", "tilt", "special", np.array([20.0, 30.0]), "test")
    lift = Force("lift", "lift", "lift", np.array([-500.0, 200.0]), "test")
    whole = ForceSums.of([*forces, tilt, lift, Force("wrap", "wrap", "secondary", 7.0, "test")])
    assert whole.main == pytest.approx(1330.0, rel=1e-15)
    assert whole.parts == pytest.approx(along | {"secondary": 7.0, "special": 50.0, "lift": -300.0}, rel=1e-15)
    assert whole.total == pytest.approx(1087.0, rel=1e-15)
    assert lift.by_strand() == pytest.approx({"carry": -500.0, "return": 200.0}, rel=1e-15)


def test_a_wing_integrated_by_single_solves(result):
    roll = result.contacts.rolls[1][0]
    length, contact = roll.load.length, roll.curve.contact
    nodes, weights = np.polynomial.legendre.leggauss(12)
    y = 0.5 * length * (nodes + 1.0)
    w = 2.0 * roll.load.bulk_force / length * (1.0 - y / length) + roll.load.belt_force / length
    assert 0.5 * length * weights @ w == pytest.approx(roll.load.force, rel=1e-12)
    level = result.contacts.covers["carry"].test_factor
    single = [float(level.factor(load) * indentation_resistance(contact, float(load)).resistance) for load in w]
    # a kink where the tests' loads end: 1e-4 of quadratures with 8 and 12 points
    assert roll.resistance == pytest.approx(0.5 * length * weights @ np.array(single), rel=1e-4)


def _curves(found):
    """The load curves that rolls are read from; one is equal to itself only."""
    return {roll.curve for rolls in found.contacts.rolls for roll in rolls}


def test_one_curve_for_each_distinct_contact(result):
    # two covers; the rubber forgets a roll long before the next, so that spacings share a curve
    curves = _curves(result)
    assert len(curves) == 2
    assert {curve.contact.spacing for curve in curves} == {1.2, 2.4}


def test_spacings_that_matter_keep_their_own_curves(line):
    # 4 (h/λ)³ is 1.5e-7 for 4 mm at 1.2 m, 4e-8 for 5 mm at 2.4 m
    tight = calculate(line.replace(calculation=line.calculation.replace(rtol=1e-7)))
    loose = calculate(line.replace(calculation=line.calculation.replace(rtol=1e-4)))
    for found, count in ((tight, 3), (loose, 2)):
        assert len(_curves(found)) == count
    assert loose.balance.forces.indentation == pytest.approx(tight.balance.forces.indentation, rel=1e-4)


def test_a_larger_middle_roll_saves_indentation(line, result):
    roll = line.idlers.carry.roll
    larger = line.idlers.carry.replace(middle_roll=roll.replace(diameter=quantity("219 mm")))
    other = calculate(line.replace(idlers=line.idlers.replace(carry=larger)))
    assert other.balance.forces.indentation < result.balance.forces.indentation


def test_secondary_by_length_coefficient(line):
    short = line.replace(
        route=line.route.replace(sections=line.route.sections[:3]),
        calculation=line.calculation.replace(secondary="C"),
    )
    found = calculate(short).balance
    assert found.forces.secondary == pytest.approx((length_coefficient(1020.0) - 1.0) * found.forces.main, rel=1e-12)


def test_iso_5048_example_beside_ours():
    """The classical column is the worked example's F_H, F_bA, F_f, F_gL, F_r to the printed digits."""
    spec = {
        "name": "ISO 5048 example",
        "belt": {
            "width": "1.2 m", "speed": "4.8 m/s", "mass": "16.44 kg/m", "thickness": "12.5 mm",
            "top_cover": {"thickness": "4 mm"}, "bottom_cover": {"thickness": "2 mm", "compound": "S120"},
            "carcass": {"kind": "EP", "thickness": "6.5 mm"},
        },
        "idlers": {
            "carry": {
                "rolls": 3, "spacing": "1.2 m", "trough_angle": "35 deg",
                "roll": {"diameter": "133 mm", "length": "465 mm", "rotating_mass": "5.1666666666666667 kg"},
            },
            "return": {
                "rolls": 1, "spacing": "3 m",
                "roll": {"diameter": "133 mm", "length": "1400 mm", "rotating_mass": "13.2 kg"},
            },
        },
        "material": {"name": "coal", "density": "0.85 t/m^3", "flow": "2300 t/h", "surcharge_angle": "20 deg"},
        "route": {
            "sections": [{"name": "all", "length": "143 m"}],
            "feeding": {"skirt_length": "4.8 m", "skirt_width": "0.75 m"},
            "cleaners": [{"count": 4, "width": "1.2 m", "thickness": "8 mm", "pressure": "30 kPa"}],
        },
        "drive": {"wrap_angle": "180 deg", "friction": 0.3, "efficiency": 0.9215},
        "ambient": {"temperature": "20 degC"},
        "calculation": {"friction_factor": 0.02},
    }  # fmt: skip
    found = calculate(from_data(spec)).balance
    assert found.classical.main == pytest.approx(5142.73, abs=0.005)
    forces = {single.name: single.total for single in found.singles}
    assert forces["acceleration of the bulk"] == pytest.approx(3066.67, abs=0.005)
    assert forces["skirts in the loading zone"] == pytest.approx(2390.38, abs=0.005)
    assert forces["skirts beyond the loading zone"] == pytest.approx(1221.34, abs=0.005)
    assert forces["cleaner 1 (x4)"] == pytest.approx(691.2, abs=0.05)


# --- the bridge between SI and dimensionless


def contact(**changes) -> RollContact:
    rubber = PronySeries(8e6, [2e6, 3e6], [1e-4, 1e-3])
    given = {
        "radius": 0.0795,
        "spacing": 1.2,
        "cover_thickness": 6e-3,
        "speed": 5.0,
        "series": rubber,
    } | changes
    return RollContact(**given)


def test_a_confined_contact_does_not_feel_the_spacing():
    # images of a layer 6 mm thick 0.6 m away: exp(-2 pi 0.6/0.006) is nothing, the rest is rtol
    near, far = (indentation_resistance(contact(spacing=s), 2000.0, 1e-9).resistance for s in (0.6, 3.0))
    assert float(near) == pytest.approx(float(far), rel=2e-9)


def test_similarity():
    # twice all lengths and the speed, twice the load per width: the same friction
    one = indentation_resistance(contact(), 2000.0, 1e-9)
    double = contact(radius=0.159, spacing=2.4, cover_thickness=12e-3, speed=10.0)
    two = indentation_resistance(double, 4000.0, 1e-9)
    assert float(two.resistance) == pytest.approx(2.0 * float(one.resistance), rel=2e-9)
    assert float(two.half_width) == pytest.approx(2.0 * float(one.half_width), rel=1e-7)
    assert float(two.peak_pressure) == pytest.approx(float(one.peak_pressure), rel=1e-6)


def test_slower_rubber_is_a_faster_belt():
    faster = indentation_resistance(contact(speed=50.0), 2000.0, 1e-9).resistance
    rubber = contact().series.scaled(a_T=10.0)
    slower = indentation_resistance(contact(series=rubber), 2000.0, 1e-9).resistance
    assert float(slower) == pytest.approx(float(faster), rel=2e-9)


def test_elastic_rubber_costs_nothing():
    found = indentation_resistance(contact(series=PronySeries(8e6, [], [])), 2000.0)
    assert float(found.resistance) == 0.0
    assert float(found.penetration) > 0.0


def test_the_curve_is_the_single_solves():
    curve = indentation_curve(contact(), 200.0, 8000.0)
    for w in np.geomspace(200.0, 8000.0, 7):
        single = indentation_resistance(contact(), float(w), 1e-9)
        assert float(curve.at(w).resistance) == pytest.approx(float(single.resistance), rel=RTOL)
        assert float(curve.at(w).penetration) == pytest.approx(float(single.penetration), rel=1e-5)


def test_published_friction_of_s100():
    # 0.003692 at 1.5 kN/m and 0.004932 at 4 kN/m with one term a decade fitted to the same data by another program:
    # half a unit of the last digit and the difference between the fits, 0.05 %
    data = read_dma(built_in() / "s100.dma.csv")
    fit = fit_prony(data.frequency, data.storage, data.loss, terms_per_decade=1.0)
    rubber = shift_series(fit.series, compound("s100").shift_law(), 293.15)
    for pressed, friction in ((1500.0, 0.003692), (4000.0, 0.004932)):
        found = indentation_resistance(contact(series=rubber), pressed)
        assert float(found.resistance) / pressed == pytest.approx(friction, rel=6e-4)


def test_load_exponent_of_s100():
    """Measured on large samples of a low-resistance cover, another rubber: 1.28 (7 mm cover, 219 mm roll, 20 degC)."""
    rubber = compound("s100").series(293.15)
    roll = contact(radius=0.1095, cover_thickness=7e-3, series=rubber)
    w = np.array([1e3, 2e3, 4e3, 8e3])
    resistance = indentation_curve(roll, 1e3, 8e3).at(w).resistance
    exponents = np.diff(np.log(resistance)) / math.log(2.0)
    assert np.all((exponents > 1.24) & (exponents < 1.32)), exponents
    assert math.log(resistance[-1] / resistance[0]) / math.log(8.0) == pytest.approx(1.28, abs=0.02)


def test_cleaners_are_warned_of_where_none_are_given(line, result):
    def told(of):
        return [warning.text() for warning in analysis_warnings(of, ()) if "leaner" in warning.text()]

    assert told(result) == []
    (assumed,) = told(calculate(with_fields(line, {"route.cleaners": []})))
    assert "2 as wide as the belt assumed" in assumed


def test_the_excited_band_of_a_strand_reaches_over_those_of_all_its_rolls(result, monkeypatch):
    """Rolls of three diameters, one of which loses nothing: from the lowest of the lower ends to the highest of all."""
    bands = [(8.0, 400.0), (None, None), (5.0, 100.0)]
    curves = tuple(SimpleNamespace(slowest_excited=low, fastest_excited=high) for low, high in bands)
    monkeypatch.setattr(type(result.contacts), "curves_of", lambda *_: curves)
    assert result.contacts.excited_band("carry") == (5.0, 400.0)
    monkeypatch.setattr(type(result.contacts), "curves_of", lambda *_: curves[1:2])
    assert result.contacts.excited_band("carry") is None
