"""Checks of each part and between parts: every message, its field, and that its advice works."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest

from conveyor.errors import InputError, SpecError
from conveyor.models import Conveyor
from conveyor.units import quantity, si

ROLL = {"diameter": "133 mm", "length": "465 mm", "rotating_mass": "5 kg"}
REFUSED = [
    ("belt.thickness", "14 mm", "belt.thickness", r"6 mm \+ 4 mm \+ 5 mm = 15 mm; correct belt.thickness"),
    ("belt.thickness", "17 mm", "belt.thickness", "got 17 mm, but top cover"),
    ("belt.mass", "10 kg/m", "belt.mass", r"got 10 kg/m, but the rubber of the covers alone weighs 13.56 kg/m"),
    ("belt.mass", "0 kg/m", "belt.mass", "got 0 kg/m, allowed: > 0"),
    ("belt.carcass.mass", None, "belt.mass", "missing: give belt.mass or belt.carcass.mass"),
    ("belt.carcass.kind", "rope", "belt.carcass.kind", "'steel cord', 'EP'"),
    ("belt.carcass.strength", "600 PIW", "belt.carcass.strength",
     "got 600 PIW: PIW says what a belt is rated to work at, .* give rating: 600 PIW"),
    ("belt.carcass", {"kind": "EP", "thickness": "5 mm", "strength": "100 N/mm", "rating": "600 PIW"},
     "belt.carcass.rating", r"got 600 PIW, but the belt breaks at 100 N/mm"),
    ("belt.carcass", {"kind": "EP", "thickness": "5 mm", "rating": "600 PIW", "splice_strength": "40 %"},
     "belt.carcass.splice_strength", "without the strength it is a share of"),
    ("idlers.carry.rotating_mass", "15.6 kg", "idlers.carry.roll.rotating_mass",
     "got 5.2 kg of a roll, but the whole set has 15.6 kg"),
    ("idlers.carry.roll", {"diameter": "159 mm", "length": "465 mm"}, "idlers.carry.roll.rotating_mass",
     "missing: give it, or the rotating_mass of the whole set"),
    ("idlers.carry.reduced_mass", "16 kg", "idlers.carry.reduced_mass", "got 16 kg, more than all that turns"),
    ("idlers.carry.reduced_mass", "0 kg/m", "idlers.carry.reduced_mass", "got 0 kg/m, allowed: > 0"),
    ("idlers.carry", {"rolls": 1, "spacing": "1 m", "drag": "3 N",
                      "roll": {"diameter": "159 mm", "length": "1400 mm", "rotating_mass": "5 kg", "drag": "1 N"}},
     "idlers.carry.roll.drag", "given beside drag 3 N of the whole set"),
    ("idlers.carry.rolls", 1, "idlers.carry.trough_angle", "got 35 deg with rolls: 1, but one roll lies flat"),
    ("idlers.return.middle_roll", ROLL, "idlers.return.middle_roll", "only 3 or 5 rolls have a middle one"),
    ("idlers.carry.middle_roll", ROLL | {"length": "400 mm"}, "idlers.carry.middle_roll.length",
     "got 400 mm, but roll.length is 465 mm"),
    ("idlers.carry.load_shares", [0.5, 0.5], "idlers.carry.load_shares", "got 2 shares for rolls: 3"),
    ("idlers.carry.load_shares", ["20 %", "50 %", 0.2], "idlers.carry.load_shares", "got a sum of 0.9"),
    ("idlers.carry.belt_shares", [0.5, 0.5, 0.5], "idlers.carry.belt_shares", "got a sum of 1.5"),
    ("idlers.carry.load_shares", [-0.2, 1, 0.2], "idlers.carry.load_shares.0", "got -0.2, allowed: >= 0"),
    ("idlers.carry.rolls", 5, "idlers.carry.load_shares", "missing: VDI 2341 has no rule for the shares of 5 rolls"),
    ("idlers.carry.spacing", "150 mm", "idlers.carry.spacing",
     "got 150 mm, but the rolls are 159 mm thick: rolls of neighbouring sets overlap"),
    ("idlers.carry.roll.length", "390 mm", "idlers.carry.roll.length",
     r"3 roll\(s\) side by side are 1170 mm wide, the belt \(belt.width\) 1200 mm"),
    ("idlers.carry.roll.length", "1.3 m", "idlers.carry.roll.length", "inner rolls alone are as wide"),
    ("idlers.return.roll.length", "1.1 m", "idlers.return.roll.length", r"1 roll\(s\) side by side are 1.1 m wide"),
    ("route.sections.1.lift", "300 m", "route.sections.1.lift", "the section is only 300 m long"),
    ("route.sections.1.lift", "-301 m", "route.sections.1.lift", "the section is only 300 m long"),
    ("route.sections.1.slope", "2 deg", "route.sections.1.slope", "slope 2 deg and lift 10 m; give one of the two"),
    ("route.sections.1.name", "one", "route.sections.1.name", r'"one", already the name of sections\[0\]'),
    ("route.sections.1.carry_spacing", "159 mm", "route.sections.1.carry_spacing",
     "rolls of neighbouring sets overlap"),
    ("route.sections.1.return_spacing", "6 in", "route.sections.1.return_spacing",
     "got 6 in, but the rolls are 159 mm"),
    ("route.sections", [], "route.sections", "got 0 entries, at least 1 needed"),
    ("route.feeding.skirt_width", "1.3 m", "route.feeding.skirt_width", r"got 1.3 m, wider than the belt"),
    ("route.feeding.speed", "1000 fpm", "route.feeding.speed",
     r"got 1000 fpm, faster than the belt \(belt.speed 5 m/s\)"),
    ("route.cleaners.0.width", "1.3 m", "route.cleaners.0.width", "wider than the belt"),
    ("route.pulleys",
     [{"name": "p", "position": "head", "diameter": "0.5 m", "shaft_diameter": "500 mm", "mass": "1 t"}],
     "route.pulleys.0.shaft_diameter", "got 500 mm, but the pulley's diameter is 0.5 m"),
    ("material.flow", "4800 t/h", "material.flow",
     r"\(belt.speed\) and 850 kg/m\^3 \(material.density\) needs a cross-section of 0.3137 m\^2"),
    ("ambient.temperature", "60 degC", "ambient.temperature",
     'got 60 degC, but belt.bottom_cover.compound is "test rubber": temperature 60.00 degC is outside the shift table'),
    ("ambient.belt_temperature", "0 degF", "ambient.belt_temperature", "got 0 degF, but belt.bottom_cover.compound"),
    ("drive.position", "middle", "drive.position", "allowed: 'head', 'tail', 'carry' or 'return'"),
    ("drive.position", "carry", "drive.section", 'missing: position "carry" stands behind a section'),
    ("drive.section", "one", "drive.section", 'got "one" with position "head"; remove section'),
    ("drive.share", "50 %", "drive.share", "got a sum of 0.5, the shares of all drives"),
    ("drive.further_drives", [{"name": "tail", "position": "tail", "wrap_angle": "180 deg", "friction": 0.3}],
     "drive.further_drives.0.installed_power", "several drives share the force by installed power"),
    ("drive.further_drives", [{"name": "tail", "wrap_angle": "180 deg", "friction": 0.3, "share": 0.4}],
     "drive.share", "missing: another drive has a share"),
    ("route.sections.0.curve", "convex", "route.sections.0.curve_radius", "missing: curve is given"),
    ("route.sections.0.curve_radius", "300 m", "route.sections.0.curve", "missing: curve_radius is given"),
    ("route.sections.0.horizontal_curve", "left", "route.sections.0.horizontal_radius", "missing: horizontal_curve"),
    ("route.sections.0.horizontal_radius", "300 m", "route.sections.0.horizontal_curve", "missing: horizontal_radius"),
    ("route.sections.0.carry_banking", "3 deg", "route.sections.0.carry_banking", "got 3 deg on the straight"),
    ("route.sections.0.carry_banking", "-3 deg", "route.sections.0.carry_banking", "got -3 deg, allowed: >= 0 deg"),
    ("ambient.wind_speed", "90 m/s", "ambient.wind_speed", "got 90 m/s, allowed"),
    ("route.feeding.share", "50 %", "route.feeding.share", "of a single feeding point"),
    ("route.feeding.section", "three", "route.feeding.section", "none of the sections: one, two"),
    ("route.further_feeding", [{"skirt_length": "4 m", "skirt_width": "0.7 m", "section": "two", "share": 0.4}],
     "route.feeding.share", "missing: with several feeding points each has its share"),
    ("route.take_up", {"kind": "fixed", "mass": "2 t"}, "route.take_up.mass", 'got 2 t with kind "fixed"'),
    ("route.take_up", {"kind": "gravity", "mass": "2 t", "tension": "9 kN"}, "route.take_up.mass",
     "got 2 t and tension 9 kN; give one of the two"),
    ("route.take_up", {"kind": "winch", "position": "return"}, "route.take_up.section", "missing: position"),
    ("route.take_up", {"kind": "winch", "position": "return", "section": "three"}, "route.take_up.section",
     "none of the sections"),
    ("route.pulleys",
     [{"name": "p", "position": "tail", "section": "one", "diameter": "0.5 m", "shaft_diameter": "0.1 m",
       "mass": "1 t"}],
     "route.pulleys.0.section", 'got "one" with position "tail"'),
    ("drive.efficiency", 95, "drive.efficiency", "got 95, allowed: > 0 and <= 1"),
    ("operation", {"hours_per_year": "9000 h"}, "operation.hours_per_year", "allowed: >= 0 h and <= 8784 h"),
    ("operation", {"hours_per_year": "9 h", "price": 0.12}, "operation.price", 'such as "0.12 EUR/kWh"'),
    ("operation", {"hours_per_year": "9 h", "price": "0,12 EUR/kWh"}, "operation.price", "currency's code"),
]  # fmt: skip


def changed(data: dict[str, Any], path: str, value: object) -> dict[str, Any]:
    inner: Any = data
    *parents, last = (int(part) if part.isdigit() else part for part in path.split("."))
    for part in parents:
        inner = inner[part]
    inner[last] = value
    return data


def indexed(path: str) -> str:
    return re.sub(r"\.(\d+)", r"[\1]", path)


@pytest.mark.parametrize(("path", "value", "field", "message"), REFUSED)
def test_conflict_is_refused_at_its_field(
    conveyor_data: dict[str, Any], path: str, value: object, field: str, message: str
) -> None:
    Conveyor.model_validate(conveyor_data)
    with pytest.raises(SpecError) as caught:
        Conveyor.model_validate(changed(conveyor_data, path, value))
    found, at = dict(caught.value.problems), indexed(field)
    assert at in found
    assert re.search(message, found[at])


def _pulley(name: str, position: str, diameter: str, **fields: str) -> dict[str, str]:
    return {"name": name, "position": position, "diameter": diameter, "shaft_diameter": "0.1 m", "mass": "1 t"} | fields


def test_a_driven_pulley_has_the_diameter_of_its_drive(conveyor_data: dict[str, Any]) -> None:
    """Of two drives at one place each its own, in the order listed; snubs and pulleys elsewhere have any."""
    second = {"name": "second", "wrap_angle": "180 deg", "friction": 0.3, "share": 0.5, "pulley_diameter": "24 in"}
    conveyor_data["drive"] |= {"pulley_diameter": "1 m", "share": 0.5, "further_drives": [second]}
    conveyor_data["route"]["pulleys"] = [
        _pulley("first", "head", "1000 mm"), _pulley("other", "head", "610 mm"),
        _pulley("snub", "head", "400 mm", wrap_angle="20 deg"), _pulley("tail", "tail", "800 mm"),
    ]  # fmt: skip
    Conveyor.model_validate(conveyor_data)
    conveyor_data["route"]["pulleys"][0]["diameter"] = "800 mm"
    conveyor_data["route"]["pulleys"][1]["diameter"] = "500 mm"
    with pytest.raises(SpecError) as caught:
        Conveyor.model_validate(conveyor_data)
    assert dict(caught.value.problems) == {
        "route.pulleys[0].diameter": "got 800 mm, but the drive that turns it has 1 m (drive.pulley_diameter); "
        "correct one of the two",
        "route.pulleys[1].diameter": "got 500 mm, but the drive that turns it has 24 in "
        "(drive.further_drives[0].pulley_diameter); correct one of the two",
    }


def test_further_drives_and_feeding_are_checked_like_the_first(conveyor_data: dict[str, Any]) -> None:
    booster = {"name": "booster", "position": "carry", "section": "three", "wrap_angle": "180 deg",
               "friction": 0.3, "installed_power": "90 kW"}  # fmt: skip
    point = {"skirt_length": "4 m", "skirt_width": "1.3 m", "section": "two", "share": 0.4, "speed": "6 m/s"}
    conveyor_data["drive"] |= {"installed_power": "200 kW", "further_drives": [booster]}
    conveyor_data["route"]["feeding"]["share"] = 0.6
    conveyor_data["route"]["further_feeding"] = [point]
    with pytest.raises(SpecError) as caught:
        Conveyor.model_validate(conveyor_data)
    found = dict(caught.value.problems)
    assert 'got "three", which is none of the sections: one, two' in found["drive.further_drives[0].section"]
    assert "got 1.3 m, wider than the belt" in found["route.further_feeding[0].skirt_width"]
    assert "got 6 m/s, faster than the belt" in found["route.further_feeding[0].speed"]
    booster["section"] = "one"
    point |= {"skirt_width": "0.7 m", "speed": "2 m/s"}
    line = Conveyor.model_validate(conveyor_data)
    assert line.route.flow_shares == {"one": 0.6, "two": 1.0}


def test_cover_as_thick_as_the_roll_radius(conveyor_data: dict[str, Any]) -> None:
    for strand in ("carry", "return"):
        conveyor_data["idlers"][strand]["roll"]["diameter"] = "12 mm"
    with pytest.raises(SpecError, match=r"idlers\.carry\.roll\.diameter: .*got 12 mm, allowed: >= 20 mm"):
        Conveyor.model_validate(conveyor_data)
    for strand in ("carry", "return"):
        conveyor_data["idlers"][strand]["roll"]["diameter"] = "20 mm"
    changed(conveyor_data, "belt.top_cover.thickness", "10 mm")
    with pytest.raises(SpecError, match=r"belt\.top_cover\.thickness: .*thinner than their radius"):
        Conveyor.model_validate(conveyor_data)
    # Turned over, the thick top cover meets no roll.
    changed(conveyor_data, "route.turned_over", True)
    Conveyor.model_validate(conveyor_data)
    changed(conveyor_data, "belt.bottom_cover.thickness", "10 mm")
    with pytest.raises(SpecError, match=r"belt\.bottom_cover\.thickness: .*got 10 mm, but the rolls"):
        Conveyor.model_validate(conveyor_data)


def test_all_conflicts_are_reported_at_once(conveyor_data: dict[str, Any]) -> None:
    changed(conveyor_data, "material.flow", "5000 t/h")
    changed(conveyor_data, "ambient.temperature", "60 degC")
    changed(conveyor_data, "route.feeding.skirt_width", "2 m")
    changed(conveyor_data, "route.sections.0.carry_spacing", "0.1 m")
    changed(conveyor_data, "idlers.return.roll.length", "1 m")
    with pytest.raises(SpecError) as caught:
        Conveyor.model_validate(conveyor_data)
    assert set(dict(caught.value.problems)) == {
        "material.flow",
        "ambient.temperature",
        "route.feeding.skirt_width",
        "route.sections[0].carry_spacing",
        "idlers.return.roll.length",
    }


def test_advice_about_the_flow_works(conveyor_data: dict[str, Any]) -> None:
    changed(conveyor_data, "material.flow", "5000 t/h")
    with pytest.raises(SpecError) as caught:
        Conveyor.model_validate(conveyor_data)
    message = caught.value.problems[0][1]
    flow = re.search(r"reduce material.flow to (.*?) or less", message)
    speed = re.search(r"raise belt.speed to (.*?) or more", message)
    assert flow is not None
    assert speed is not None
    assert Conveyor.model_validate(changed(conveyor_data, "material.flow", flow[1]))
    changed(conveyor_data, "material.flow", "5000 t/h")
    assert Conveyor.model_validate(changed(conveyor_data, "belt.speed", speed[1]))


def test_flow_limit_is_the_iso_5048_section(conveyor_data: dict[str, Any]) -> None:
    # b 1.03 m, l_M 0.436 m, 45 deg, 20 deg: A = 0.0445 + 0.1357 m², printed to four digits.
    changed(conveyor_data, "idlers.carry.roll.length", "436 mm")
    changed(conveyor_data, "idlers.carry.trough_angle", "45 deg")
    most = 0.1802 * 5 * 850 * 3.6
    with pytest.raises(SpecError, match=r"the belt holds 0\.180[12] m.* 150 % of that"):
        Conveyor.model_validate(changed(conveyor_data, "material.flow", f"{most * 1.501:.3f} t/h"))
    # more than it holds is a failing check, to half as much again
    Conveyor.model_validate(changed(conveyor_data, "material.flow", f"{most * 1.499:.3f} t/h"))


def test_a_narrow_belt_is_calculated_to_its_edges(conveyor_data: dict[str, Any]) -> None:
    """Of 400 mm 310 mm bear bulk: heaped from edge to edge a flat belt holds (400/310)² = 1.66 of it."""
    changed(conveyor_data, "belt.width", "400 mm")
    for name, value in (("rolls", 1), ("trough_angle", "0 deg"), ("roll.length", "500 mm")):
        changed(conveyor_data, f"idlers.carry.{name}", value)
    for key in ("skirt_width", "cleaners"):
        conveyor_data["route"].pop(key, None)
    conveyor_data["route"].pop("feeding", None)
    most = 0.4**2 * math.tan(math.radians(20.0)) / 6.0 * 5 * 850 * 3.6
    Conveyor.model_validate(changed(conveyor_data, "material.flow", f"{most * 0.999:.3f} t/h"))
    with pytest.raises(SpecError, match=r"calculated up to 0\.0097.* heaped from edge to edge: reduce"):
        Conveyor.model_validate(changed(conveyor_data, "material.flow", f"{most * 1.001:.3f} t/h"))


def test_empty_belt_and_five_rolls_pass(conveyor_data: dict[str, Any]) -> None:
    Conveyor.model_validate(changed(conveyor_data, "material.flow", "0 t/h"))
    changed(conveyor_data, "idlers.carry.rolls", 5)
    changed(conveyor_data, "idlers.carry.inner_trough_angle", "20 deg")
    changed(conveyor_data, "idlers.carry.roll.length", "280 mm")
    changed(conveyor_data, "idlers.carry.load_shares", [0.1, 0.2, 0.4, 0.2, 0.1])
    Conveyor.model_validate(conveyor_data)


@pytest.mark.parametrize(
    ("rolls", "inner", "message"),
    [
        (5, None, "missing: the inner wings of 5 rolls have an angle of their own"),
        (4, "36 deg", r"got 36 deg, steeper than the outer rolls \(trough_angle 35 deg\)"),
        (3, "20 deg", "given with rolls: 3, but only 4 and 5 have inner wings"),
    ],
)
def test_inner_wings_have_their_angle(
    conveyor_data: dict[str, Any], rolls: int, inner: str | None, message: str
) -> None:
    changed(conveyor_data, "idlers.carry.rolls", rolls)
    if rolls > 3:
        changed(conveyor_data, "idlers.carry.share_rule", "cross-section")
    if inner is not None:
        changed(conveyor_data, "idlers.carry.inner_trough_angle", inner)
    with pytest.raises(SpecError, match=f"inner_trough_angle: .*{message}"):
        Conveyor.model_validate(conveyor_data)


def test_length_coefficient_needs_a_long_conveyor(conveyor_data: dict[str, Any]) -> None:
    changed(conveyor_data, "calculation", {"secondary": "C"})
    Conveyor.model_validate(conveyor_data)
    changed(conveyor_data, "route.sections", [{"name": "short", "length": "80 m"}])
    with pytest.raises(SpecError, match=r'calculation\.secondary: .*"C", but route.sections are 80 m long'):
        Conveyor.model_validate(conveyor_data)


def test_belt_mass_by_area_by_length_and_from_parts(conveyor_data: dict[str, Any]) -> None:
    # Top cover without compound at the default 1150 kg/m³, bottom cover at its 1100 kg/m³, carcass 12 kg/m².
    by_parts = (0.006 * 1150 + 0.004 * 1100 + 12) * 1.2
    assert Conveyor.model_validate(conveyor_data).belt.line_mass == pytest.approx(by_parts, rel=1e-14)
    by_area = Conveyor.model_validate(changed(conveyor_data, "belt.mass", "27 kg/m^2")).belt
    by_length = Conveyor.model_validate(changed(conveyor_data, "belt.mass", "32.4 kg/m")).belt
    assert by_area.line_mass == pytest.approx(32.4, rel=1e-15)
    assert by_length.line_mass == pytest.approx(32.4, rel=1e-15)


def test_slope_and_lift_of_one_section_agree(conveyor_data: dict[str, Any]) -> None:
    changed(conveyor_data, "route.sections", [{"name": "s", "length": "100 m", "slope": "30 deg"}])
    by_slope = Conveyor.model_validate(conveyor_data).route
    changed(conveyor_data, "route.sections", [{"name": "s", "length": "100 m", "lift": "50 m"}])
    by_lift = Conveyor.model_validate(conveyor_data).route
    assert by_slope.rise == pytest.approx(by_lift.rise, rel=1e-15)
    assert by_slope.length == 100.0


def test_return_rolls_run_on_the_top_cover_unless_turned_over(
    conveyor_data: dict[str, Any], compound_data: dict[str, Any]
) -> None:
    line = Conveyor.model_validate(conveyor_data)
    assert line.return_compound is line.carry_compound
    assert line.return_cover_thickness == quantity("6 mm")
    changed(conveyor_data, "belt.top_cover.compound", compound_data | {"name": "top rubber"})
    line = Conveyor.model_validate(conveyor_data)
    assert (line.carry_compound.name, line.return_compound.name) == ("test rubber", "top rubber")
    line = Conveyor.model_validate(changed(conveyor_data, "route.turned_over", True))
    assert line.return_compound.name == "test rubber"
    assert line.return_cover_thickness == quantity("4 mm")


def test_top_rubber_out_of_its_temperatures_is_named(
    conveyor_data: dict[str, Any], compound_data: dict[str, Any]
) -> None:
    del compound_data["shift"]
    changed(conveyor_data, "belt.top_cover.compound", compound_data | {"name": "top rubber"})
    changed(conveyor_data, "ambient.temperature", "10 degC")
    with pytest.raises(SpecError, match=r'got 10 degC, but belt.top_cover.compound is "top rubber".*no temp'):
        Conveyor.model_validate(conveyor_data)


def test_defaults(conveyor_data: dict[str, Any]) -> None:
    line = Conveyor.model_validate(conveyor_data)
    assert line.calculation.support == "confined"
    assert (line.calculation.rtol, line.calculation.friction_factor) == (1e-4, 0.020)
    assert si(line.calculation.gravity) == pytest.approx(9.81, rel=1e-15)
    assert si(line.idlers.carry.sag) == pytest.approx(0.01, rel=1e-15)
    assert line.idlers.carry.middle is line.idlers.carry.roll
    assert line.route.feeding is not None
    assert (line.route.feeding.belt_friction, line.route.feeding.skirt_friction) == (0.5, 0.7)
    assert si(line.route.cleaners[0].pressure) == pytest.approx(6e4, rel=1e-15)
    assert line.ambient.belt == line.ambient.temperature


def test_price_round_trip(conveyor_data: dict[str, Any]) -> None:
    changed(conveyor_data, "operation", {"hours_per_year": "5500 h", "price": "0.12 EUR/kWh"})
    line = Conveyor.model_validate(conveyor_data)
    assert line.operation is not None
    assert line.operation.price is not None
    assert (line.operation.price.amount, line.operation.price.currency) == (0.12, "EUR")
    assert line.as_data()["operation"] == {"hours_per_year": "5500 h", "price": "0.12 EUR/kWh", "duty": []}


def test_refusals_in_python_are_input_errors_by_replace(conveyor_data: dict[str, Any]) -> None:
    line = Conveyor.model_validate(conveyor_data)
    with pytest.raises(InputError, match=r"^ambient\.temperature: got 60 degC, but belt"):
        line.replace(ambient=line.ambient.replace(temperature="60 degC"))
