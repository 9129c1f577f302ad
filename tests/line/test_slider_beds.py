"""Belts on plates: friction by hand, no rolls there, every method, every load state, refusals."""

import json
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.default_bands import power_range
from conveyor.errors import InputError
from conveyor.laws.resistance import BED_FRICTION, slider_bed_resistance
from conveyor.pipeline import calculate
from conveyor.units import si
from tests.command_line import run

SPEC = Path("examples/specs/slider.yaml")
G = 9.81


@pytest.fixture(scope="module")
def slider():
    return conveyor.load(SPEC)


def with_sections(spec, **of_first):
    first, *rest = spec.route.sections
    return spec.replace(route=spec.route.replace(sections=[first.replace(**of_first), *rest]))


def all_on_plates(spec):
    sections = [section.replace(bed={"surface": "steel", "friction": 0.4}) for section in spec.route.sections]
    return spec.replace(route=spec.route.replace(sections=sections))


def force(result, key):
    return {each.key: each for each in result.balance.every}[key]


def test_friction_by_hand(slider):
    """12 m of belt and 150 t/h of sand at 0.8 m/s on friction 0.325."""
    result = conveyor.analyse(slider)
    bulk = 150e3 / 3600.0 / 0.8
    found = force(result, "slider_bed")
    assert found.total == pytest.approx(
        0.325 * (slider.belt.line_mass + bulk) * si(slider.calculation.gravity) * 12.0, rel=1e-12
    )
    assert found.newtons.tolist()[1:] == [0.0, 0.0, 0.0]
    assert result.balance.forces.special >= found.total


def test_a_slope_takes_the_cosine_and_nothing_loses_by_splitting():
    whole = slider_bed_resistance(60.0, friction=0.3, length=10.0, inclination=0.2, gravity=G)
    half = slider_bed_resistance(60.0, friction=0.3, length=5.0, inclination=0.2, gravity=G)
    assert whole == pytest.approx(2.0 * half, rel=1e-12)
    assert whole**2 + (60.0 * G * 10.0 * 0.3 * np.sin(0.2)) ** 2 == pytest.approx(
        (0.3 * 60.0 * G * 10.0) ** 2, rel=1e-12
    )


def test_a_plate_has_no_rolls_and_no_sag(slider):
    result = conveyor.analyse(slider)
    on_plate = result.stretches[0]
    assert on_plate.rolls == ()
    assert all(on_plate.forces[key] == 0.0 for key in ("indentation", "idler_rotation", "flexure", "misalignment"))
    assert result.stretches[1].forces["indentation"] > 0.0
    assert all(duty.stretch.bed is None for duty in result.set_duty)
    assert result.line.stretches[0].least_tension == 0.0
    subjects = {str(check.subject) for check in result.checks if check.key == "sag"}
    assert subjects == {"minimum tension (sag), carry", "minimum tension (sag), return"}
    assert {str(check.subject) for check in conveyor.analyse(all_on_plates(slider)).checks if check.key == "sag"} == {
        "minimum tension (sag), return"
    }


def test_sections_on_sets_are_those_of_the_belt_without_a_plate(slider):
    """The plate takes nothing from the incline but its tension, which flexure alone feels."""
    bare = conveyor.analyse(with_sections(slider, bed=None))
    here = conveyor.analyse(slider)
    for key in ("indentation", "idler_rotation", "misalignment", "lift"):
        assert here.stretches[1].forces[key] == pytest.approx(bare.stretches[1].forces[key], rel=1e-4), key


def test_a_whole_strand_on_plates(slider):
    result = conveyor.analyse(all_on_plates(slider))
    carry = force(result, "indentation").by_strand()["carry"]
    assert carry == 0.0
    assert not result.contacts.rolls_on("carry")
    assert force(result, "slider_bed").total > 2.0 * force(conveyor.analyse(slider), "slider_bed").total
    assert not any("carry rolls" in line for line in map(str, result.warnings))


def test_friction_is_the_same_force_by_every_method(slider):
    by_contact = force(conveyor.analyse(slider), "slider_bed").total
    cema = {"flexure_factor": 0.02, "idler_friction": "6.7 N"}
    for method in ("din 22101", "iso 5048", "cema classic"):
        given = slider.replace(calculation=slider.calculation.replace(method=method, cema=cema))
        assert force(conveyor.analyse(given), "slider_bed").total == pytest.approx(by_contact, rel=1e-12), method


def test_classical_main_resistance_has_no_plate(slider):
    """f of DIN 22101 over the sets alone: the incline's masses and the return strand's."""
    din = conveyor.analyse(slider.replace(calculation=slider.calculation.replace(method="din 22101")))
    main = force(din, "main_by_factor").newtons
    assert main[0] == 0.0
    assert np.all(main[1:] > 0.0)


def test_cema_has_the_plate_and_no_flexure_over_it(slider):
    cema = {"flexure_factor": 0.02, "idler_friction": "6.7 N"}
    with_cema = slider.replace(calculation=slider.calculation.replace(cema=cema))
    on_plate, bare = (conveyor.analyse(one).balance.cema for one in (with_cema, with_sections(with_cema, bed=None)))
    parts, without = ({item[1]: item[2] for item in made.items} for made in (on_plate, bare))
    assert parts["slider bed"] == pytest.approx(force(conveyor.analyse(slider), "slider_bed").total, rel=1e-12)
    assert parts["flexure of the bulk"] / without["flexure of the bulk"] == pytest.approx(30.0 / 42.0, rel=1e-9)
    assert parts["flexure of the belt, return"] == pytest.approx(without["flexure of the belt, return"], rel=1e-12)


def test_an_empty_belt_rubs_by_its_own_weight(slider):
    empty = slider.replace(material=slider.material.replace(flow="0 t/h"))
    found = force(conveyor.analyse(empty), "slider_bed").total
    assert found == pytest.approx(0.325 * slider.belt.line_mass * si(slider.calculation.gravity) * 12.0, rel=1e-12)


def test_speed_of_the_plate_is_checked(slider):
    fast = with_sections(slider, bed={"surface": "steel", "underside": "bare fabric", "allowed_speed": "0.5 m/s"})
    (check,) = (one for one in conveyor.analyse(fast).checks if one.key == "bed_speed")
    assert check.failed
    unknown = with_sections(slider, bed={"surface": "steel"})
    (check,) = (one for one in conveyor.analyse(unknown).checks if one.key == "bed_speed")
    assert check.verdict == "not checked"


def test_range_of_power_has_the_makers_range(slider):
    effects = {one.key: one for one in power_range(calculate(slider)).effects}
    of = BED_FRICTION["steel", "friction surface"]
    assert effects["bed_friction"].low_factor == pytest.approx(of.low / of.value, rel=1e-12)
    given = with_sections(slider, bed={"surface": "steel", "friction": 0.3})
    assert "bed_friction" not in {one.key for one in power_range(calculate(given)).effects}


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"bed": {"surface": "hardwood"}}, "friction: missing"),
        ({"bed": {"surface": "UHMW-PE", "underside": "bare fabric"}}, "friction: missing"),
        ({"carry_spacing": "1 m"}, "carry_spacing: given, but a plate"),
        ({"curve": "convex", "curve_radius": "300 m"}, "curve_radius: given with bed"),
        ({"horizontal_curve": "left", "horizontal_radius": "900 m"}, "horizontal_radius: given with bed"),
        ({"friction_factor": 0.02}, "friction_factor: given, but a plate"),
    ],
)
def test_what_a_plate_cannot_have(slider, changes, match):
    with pytest.raises((InputError, ValueError), match=match):
        with_sections(slider, **changes)


def test_scales_impact_sets_and_a_yielding_belt_are_refused(slider):
    scale = {"section": "under the silo", "distance": "8 m"}
    with pytest.raises(InputError, match="weighs on idler sets"):
        slider.replace(route=slider.route.replace(belt_scales=[scale]))
    point = {"skirt_length": "2 m", "skirt_width": "500 mm", "drop_height": "1 m", "idler_spacing": "400 mm"}
    with pytest.raises(InputError, match="idler_spacing: given, but the bulk lands over a plate"):
        slider.replace(route=slider.route.replace(feeding=point))
    with pytest.raises(InputError, match="confined"):
        slider.replace(calculation=slider.calculation.replace(support="belt"))


def test_pipes_bare_steel_cord_and_the_return_strand_have_no_plate(slider):
    pipe = conveyor.load("examples/specs/pipe.yaml")
    with pytest.raises(InputError, match=r"sections\[0\].bed: given, but rings of rolls hold the belt"):
        with_sections(pipe, bed={"surface": "steel"})
    cords = {"kind": "steel cord", "thickness": "4 mm", "mass": "8 kg/m^2", "strength": "1000 N/mm"}
    with pytest.raises(InputError, match=r'bed\.underside: got "friction surface", but cords of steel'):
        slider.replace(belt=slider.belt.replace(carcass=cords))
    covered = with_sections(slider, bed={"surface": "steel"})
    mass = slider.belt.replace(carcass=cords).line_mass + 150e3 / 3600.0 / 0.8
    found = force(conveyor.analyse(covered.replace(belt=covered.belt.replace(carcass=cords))), "slider_bed").total
    assert found == pytest.approx(0.525 * mass * si(slider.calculation.gravity) * 12.0, rel=1e-12)
    with pytest.raises((InputError, ValueError), match='unknown key "return_bed"'):
        with_sections(slider, return_bed={"surface": "steel"})


def test_a_fast_belt_rubs_no_more_but_its_plate_is_judged(slider):
    fast = slider.replace(belt=slider.belt.replace(speed="10 m/s"))
    result = conveyor.analyse(fast)
    bulk = 150e3 / 3600.0 / 10.0
    weight = (slider.belt.line_mass + bulk) * si(slider.calculation.gravity) * 12.0
    assert force(result, "slider_bed").total == pytest.approx(0.325 * weight, rel=1e-12)
    (check,) = (one for one in result.checks if one.key == "bed_speed")
    assert check.failed


@pytest.mark.parametrize("units", ["SI", "US"])
def test_report(units, tmp_path):
    done = run("power", SPEC, "--set", f"report.units={units}", "-o", tmp_path / "a.xlsx")
    assert "belt speed on the plate" in done.stdout
    assert "friction surface on steel" in done.stdout
    data = json.loads(run("power", SPEC, "--json").stdout)
    assert data["sections"][0]["slider_bed_N"] > 0.0
