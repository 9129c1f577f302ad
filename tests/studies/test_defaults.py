"""Range of power from defaults: each scaled force by hand, correlated strands, what is given leaves it, usual parts."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

import conveyor
from conveyor.calculated_conveyor import Variant
from conveyor.default_bands import power_range
from conveyor.effects import root_of_squares
from conveyor.laws.misalignment import misalignment_friction
from conveyor.models import Conveyor
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate, calculate_many

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
ROUNDING = 1e-10  # sums of 40 forces whose lift cancels in part, and a loop closed to 1e-13


ALWAYS = ["cover", "tested_level"]
"""Left of a conveyor whose parts, rolls, alignment and flexure are all given: what its covers leave open."""


def drags(line: Conveyor, drag: str) -> Conveyor:
    sets = {s: getattr(line.idlers, s) for s in ("carry", "return_")}
    named = {
        s: idlers.replace(roll=idlers.roll.replace(drag=drag), misalignment="0.4 deg") for s, idlers in sets.items()
    }
    return line.replace(idlers=line.idlers.replace(carry=named["carry"], return_=named["return_"]))


def calculated(line: Conveyor, **changes: object) -> Conveyor:
    return line.replace(calculation=line.calculation.replace(rtol=1e-4, **changes))


@pytest.fixture(scope="module")
def line() -> Conveyor:
    return calculated(conveyor.load(SPECS / "in_plant_us.yaml"))


@pytest.fixture(scope="module")
def bare(line: Conveyor) -> Conveyor:
    """Nothing stands anywhere, so that the power is linear in every force."""
    route = line.route.replace(feeding=None, cleaners=[], pulleys=[])
    return calculated(line.replace(route=route), not_given="nothing")


def test_each_default_scales_its_force_and_nothing_else(bare):
    found = calculate(bare)
    left = power_range(found)
    parts, watts = found.balance.forces.parts, found.line.speed / found.line.efficiency
    keys = {
        "roll_drag": "idler_rotation", "flexure": "flexure", "tested_level": "indentation", "cover": "indentation",
        "misalignment": "misalignment",
    }  # fmt: skip
    assert {one.key for one in left.effects} == keys.keys()
    for one in left.effects:
        force = parts[keys[one.key]]
        for factor, power in ((one.low_factor, one.motor_low), (one.high_factor, one.motor_high)):
            assert power - left.motor == pytest.approx((factor - 1.0) * force * watts, rel=ROUNDING)
    assert (left.low, left.high) == pytest.approx(root_of_squares(left.motor, left.effects), rel=ROUNDING)
    rotation, flexure, rubber, askew = (
        parts[key] * watts for key in ("idler_rotation", "flexure", "indentation", "misalignment")
    )
    half = found.contacts.test_factor_band(
        "carry"
    )  # one compound under both strands; the carry rolls are within its loads
    assert half >= 0.15
    down, up = -rubber * math.expm1(-half), rubber * math.expm1(half)
    at_best, usual, at_worst = (misalignment_friction(math.radians(angle)) for angle in (0.38, 0.5, 0.75))
    lost = (0.5 * rotation, 0.6 * flexure, down, 0.3 * rubber, (1.0 - at_best / usual) * askew)
    assert left.motor - left.low == pytest.approx(math.hypot(*lost), rel=1e-2)
    more = (0.5 * rotation, flexure, up, 0.4 * rubber, (at_worst / usual - 1.0) * askew)
    assert left.high - left.motor == pytest.approx(math.hypot(*more), rel=1e-2)
    swings = [one.swing for one in left.effects]
    assert swings == sorted(swings, reverse=True)


def test_beyond_the_tested_temperatures_the_headline_says_so(line):
    def told(celsius: float) -> list[str]:
        cold = line.replace(ambient=line.ambient.replace(temperature=f"{celsius} degC"))
        return [said.text("SI") for said in power_range(calculate(cold)).untested]

    assert told(21.0) == []  # within what a chamber holds
    (said,) = told(-25.0)
    name = line.carry_compound.name
    assert said == (
        f'"{name}" is tested at 20 °C, not at -25 °C: the constructed spectrum extrapolates the test factor'
    )
    analysis = conveyor.analyse(line.replace(ambient=line.ambient.replace(temperature="-25 degC")))
    printed = analysis.contents(system="SI")
    assert f"Beyond the tests: {said}." in printed["defaults"].note
    rows = {row.subject: row.where for row in printed["governing_figures"].rows}
    assert rows["motor power as given, expected"].endswith("; beyond the tested temperatures of the rubber")


def test_by_a_factor_nothing_is_said_of_tests_of_the_rubber(line):
    cold = line.replace(ambient={"temperature": "-30 degC"})
    by_f = cold.replace(calculation=cold.calculation.replace(method="din 22101"))
    assert power_range(calculate(cold)).untested
    assert power_range(calculate(by_f)).untested == ()


def test_what_is_given_is_in_no_range(bare):
    known = calculated(drags(bare, "2 N"), flexure_share="10 %")
    assert [one.key for one in power_range(calculate(known)).effects] == ALWAYS
    one_strand = bare.idlers.carry.replace(roll=bare.idlers.carry.roll.replace(drag="2 N"))
    half = calculated(bare.replace(idlers=bare.idlers.replace(carry=one_strand)), flexure_share="10 %")
    found = calculate(half)
    (drag,) = (one for one in power_range(found).effects if one.key == "roll_drag")
    rotation = next(force for force in found.balance.along if force.key == "idler_rotation").by_strand()["return"]
    watts = 0.5 * rotation / 0.9 * found.line.speed / found.line.efficiency
    # the share of flexure is the spec's; its force stays as it is
    assert drag.motor_high - found.balance.power.motor == pytest.approx(0.9 * watts, rel=ROUNDING)


@pytest.mark.parametrize("name", ["in_plant_us", "downhill"])
def test_an_effect_is_that_of_a_new_calculation_but_for_the_pulleys(name):
    """Rolls that drag half as much more, calculated anew: wraps and bearings follow the tension by 2 % of the change.

    Each of a loop's handful of pulleys resists by about 0.3 % of the tension before it.
    """
    given = calculated(conveyor.load(SPECS / f"{name}.yaml"))
    left = power_range(calculate(given))
    (drag,) = (one for one in left.effects if one.key == "roll_drag")
    for factor, power in ((drag.low_factor, drag.motor_low), (drag.high_factor, drag.motor_high)):
        (again,) = calculate_many([Variant(given, roll_drag=factor)])
        change = again.balance.power.motor - left.motor
        assert power - left.motor == pytest.approx(change, rel=0.02)


def test_usual_parts_stand_in_for_missing_ones(line, bare):
    missing = calculated(bare, not_given="usual values")
    found = calculate(missing)
    singles = {force.name: force for force in found.balance.singles}
    assert all(force.assumed and force.source.endswith("usual figures") for force in singles.values())
    # 1500 short tons/h from rest to 600 fpm; skirts of a second, 0.625 of 48 in apart; two blades of 48 in x 8 mm
    flow, speed = 1500.0 * 907.18474 / 3600.0, 600.0 * 0.3048 / 60.0
    assert singles["acceleration of the bulk"].total == pytest.approx(flow * speed, rel=1e-9)
    volume, density = flow / (95.0 * 16.018463374), 95.0 * 16.018463374
    skirts = 0.7 * volume**2 * density * 9.81 * speed / (speed**2 * (0.625 * 48 * 0.0254) ** 2)
    assert singles["skirts beyond the loading zone"].total == pytest.approx(skirts, rel=1e-8)
    assert singles["cleaner 1 (x2)"].total == pytest.approx(2 * 48 * 0.0254 * 0.008 * 6e4 * 0.6, rel=1e-12)
    assert singles["seals of the skirts"].total == pytest.approx(6.0 * 4.4482216 / 0.3048 * speed, rel=1e-7)
    # EP: 108 times the carcass of 0.2 in
    assert [pulley.diameter for pulley in found.line.pulleys] == pytest.approx([108 * 0.2 * 0.0254] * 2, rel=1e-12)
    assert not found.belt_duty.pulleys  # nothing to check of pulleys nobody chose
    assert {"feeding", "skirts", "cleaners", "pulleys"} <= {one.key for one in power_range(found).effects}
    # what is given is not added to
    partly = calculated(missing.replace(route=missing.route.replace(cleaners=line.route.cleaners)))
    part = calculate(partly)
    assert sum(force.key == "cleaner" for force in part.balance.singles) == 1
    (pressure,) = (one for one in power_range(part).effects if one.key == "cleaner_pressure")  # not given there
    scraped = part.balance.forces.special * (1e5 / 6e4 - 1.0) * speed / 0.93
    assert pressure.motor_high - part.balance.power.motor > 0.0
    assert pressure.motor_high - part.balance.power.motor < 1.1 * scraped  # its wraps too, skirts not
    assert not any(force.assumed for force in calculate(line).balance.singles)


def test_the_high_ends_of_usual_parts_are_those_of_cema(bare):
    """5 lbf an inch of each cleaner; 150 lbf each at tail and take-up and 100 at the two bends beside it."""
    found = calculate(calculated(bare, not_given="usual values"))
    effects = {one.key: one for one in power_range(found).effects}
    usual = {force.key: 0.0 for force in found.balance.singles}
    for force in found.balance.singles:
        usual[force.key] += force.total
    scraped = 2 * 5.0 * 48 * 4.4482216152605
    assert effects["cleaners"].high_factor * usual["cleaner"] == pytest.approx(scraped, rel=1e-12)
    turned = effects["pulleys"].high_factor * (usual["wrap"] + usual["pulley_bearings"])
    assert turned == pytest.approx(500.0 * 4.4482216152605, rel=1e-12)


def test_low_ends_of_usual_parts_are_half_or_a_single_cleaner(bare):
    """Of two cleaners one is left; skirts and pulleys have half."""
    effects = {one.key: one for one in power_range(calculate(calculated(bare, not_given="usual values"))).effects}
    assert [effects[key].low_factor for key in ("cleaners", "pulleys", "skirts")] == pytest.approx([0.5, 0.5, 0.5])


@pytest.mark.parametrize(("given", "low", "high"), [("stiffness", 0.8, 1.25), ("forming load", 0.75, 1.1)])
def test_the_strip_of_a_pipe_has_its_band_on_both_strands(given, low, high):
    """Elastica over linear strip: 36 of 40 cases lie within, see tests/validation/test_pipe_strip.py."""
    pipe = conveyor.load(SPECS / "pipe.yaml")
    if given == "forming load":
        load = {f"idlers.{strand}.pipe.forming_load": "259 N" for strand in ("carry", "return")}
        pipe = with_fields(pipe, load | {"belt.transverse_stiffness": None})
    found = calculate(pipe)
    effects = {one.key: one for one in power_range(found).effects}
    assert (effects["pipe_rolls"].low_factor, effects["pipe_rolls"].high_factor) == (low, high)
    others = effects["cover"]  # of both strands, too
    assert effects["pipe_rolls"].swing / others.swing == pytest.approx((high - low) / (1.4 - 0.7), rel=0.02)
    assert "pipe_rolls" not in {
        one.key for one in power_range(calculate(conveyor.load(SPECS / "overland.yaml"))).effects
    }


def test_nothing_lands_on_an_empty_belt_nor_stands_where_nothing_is_asked_for(bare):
    empty = calculated(bare.replace(material=bare.material.replace(flow="0 t/h")), not_given="usual values")
    keys = {force.key for force in calculate(empty).balance.singles}
    assert keys == {"cleaner", "skirt_seals", "wrap", "pulley_bearings"}
    assert calculate(bare).balance.singles == ()


def test_reports_say_the_range_and_what_to_replace_first(line):
    found = conveyor.analyse(line)
    left = power_range(found)
    told = found.to_dict()["defaults"]
    assert told["motor_kW"] == {"low": pytest.approx(left.low / 1e3), "high": pytest.approx(left.high / 1e3)}
    assert told["replace_first"] == left.effects[0].give
    assert [one["key"] for one in told["in_use"]] == [one.key for one in left.effects]
    note = found.contents(system="SI")["defaults"].note
    low, motor, high = (f"{power / 1e3:.0f}" for power in (left.low, left.motor, left.high))
    assert note.startswith(f"Motor power: expected {motor} kW, from {low} kW to {high} kW in the 90 % band of site")
    design = f"{left.design / 1e3:.0f} kW ({left.design_friction:.3g} times the expected friction, the upper end"
    assert f"Motors, belt, grip and take-up are checked at {design}" in note
    assert f"Replace first: {left.effects[0].name} (give {left.effects[0].give})." in note
    assert re.search(r"from \d+ hp to \d+ hp", found.contents(system="US")["defaults"].note)
    cleaners = [cleaner.replace(pressure="30 kPa") for cleaner in line.route.cleaners]
    pressed = line.replace(route=line.route.replace(cleaners=cleaners))
    known = conveyor.analyse(calculated(drags(pressed, "2 N"), flexure_share="10 %"))
    assert [one["key"] for one in known.to_dict()["defaults"]["in_use"]] == ALWAYS


def test_rubber_without_tests_may_lose_two_and_a_half_times_as_much(bare):
    belt = bare.belt
    plain = belt.bottom_cover.compound.replace(tests=())
    cover = belt.bottom_cover.replace(compound=plain)
    top = belt.top_cover if belt.top_cover.compound is None else belt.top_cover.replace(compound=plain)
    found = calculate(bare.replace(belt=belt.replace(bottom_cover=cover, top_cover=top)))
    (level,) = (one for one in power_range(found).effects if one.key == "level")
    watts = found.line.speed / found.line.efficiency
    assert level.motor_low == pytest.approx(found.balance.power.motor, rel=ROUNDING)
    more = 1.5 * found.balance.forces.indentation * watts
    assert level.motor_high - level.motor_low == pytest.approx(more, rel=ROUNDING)


def test_the_loss_of_a_carcass_that_bends_reaches_up_to_the_flexure_that_is_left_out():
    """On a stiff carcass the law of load and sag has bulk and belt; under a belt that gives it has the bulk."""
    stiff = conveyor.load(SPECS / "shuttle.yaml")
    gives = calculated(stiff, support="belt")
    found, fast = calculate(gives), calculate(stiff)
    left_out = found.contacts.flexure_left_out
    law, bulk = (one.balance.forces.parts["flexure"] for one in (fast, found))
    tensions = [one.balance.tensions.smallest for one in (fast, found)]
    assert tensions[0] == pytest.approx(tensions[1], rel=1e-3)  # and so does the flexure at them
    assert left_out == pytest.approx(law - bulk, rel=5e-3)
    (bends,) = (one for one in power_range(found).effects if one.key == "bending_loss")
    assert bends.low_factor == 1.0
    assert bends.high_factor - 1.0 == pytest.approx(left_out / found.balance.forces.indentation)
    carcass = gives.belt.carcass.replace(bending_loss=0.1)
    known = calculate(gives.replace(belt=gives.belt.replace(carcass=carcass)))
    assert "bending_loss" not in {one.key for one in power_range(known).effects}
