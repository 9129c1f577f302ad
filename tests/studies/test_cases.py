"""Load cases: the figures of `analyse` in bulk, sums of loadings, safe side of friction, governing cases, motors."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from conveyor import shelf
from conveyor.calculated_conveyor import Variant
from conveyor.errors import InputError
from conveyor.laws.energy import MOTOR_SERIES
from conveyor.line.line import Line
from conveyor.loop.loop_layout import LoopLayout
from conveyor.models import Conveyor, LoadCase, standard_cases
from conveyor.models.cases import STANDARD_LOADINGS
from conveyor.models.variants import with_case, with_temperature
from conveyor.pipeline import calculate, calculate_many
from conveyor.spec import load
from conveyor.studies import load_cases
from conveyor.studies.load_cases import CalculatedCases, analyse_cases
from conveyor.units import quantity, si
from conveyor.units.sentences import degree_signs

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
ROUNDING = 1e-11
"""Of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16."""
RTOL = 1e-6
"""Of the contacts: curves over different ranges of load differ by no more than twice it."""


def spec(name: str) -> Conveyor:
    return load(SPECS / f"{name}.yaml")


@pytest.fixture(scope="module")
def line() -> Conveyor:
    """Covers without strain sweeps and tests: contacts depend on temperature alone, bulk on the descent drives."""
    given = spec("overland")
    plain = shelf.compound("low-rolling-resistance-cover").replace(strain_dependence=None, tests=())
    top, bottom = (cover.replace(compound=plain) for cover in (given.belt.top_cover, given.belt.bottom_cover))
    return given.replace(belt=given.belt.replace(top_cover=top, bottom_cover=bottom))


@pytest.fixture(scope="module")
def downhill() -> Conveyor:
    return spec("downhill")


@pytest.fixture(scope="module")
def found(line) -> CalculatedCases:
    return analyse_cases(line, standard_cases(["0 degC", "20 degC"], ["4.5 m/s", "5 m/s"]))


def result(study, case, celsius=20.0, speed=5.0):
    (one,) = [
        r
        for r in study.results
        if r.case.name == case and abs(r.temperature - 273.15 - celsius) < 1e-9 and r.speed == speed
    ]
    return one


# figures of analyse -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["overland", "downhill", "in_plant_us", "downhill_brakes", "shuttle"])
def test_the_case_as_given_is_the_analysis(name):
    given = spec(name)
    alone = calculate(given).balance
    (one,) = analyse_cases(given, [LoadCase(name="as given")]).results
    found = one.found.balance
    assert found.forces.parts == pytest.approx(alone.forces.parts, rel=ROUNDING)
    for figure, value in (
        (found.forces.total, alone.forces.total),
        (found.power.motor, alone.power.motor),
        (found.tensions.tight, alone.tensions.tight),
        (found.tensions.slack, alone.tensions.slack),
        (found.tensions.largest, alone.tensions.largest),
        (found.tensions.smallest, alone.tensions.smallest),
        (found.friction_factor, alone.friction_factor),
        (one.energy_per_tonne_km, alone.power.energy_per_tonne_km),
    ):
        assert figure == pytest.approx(value, rel=ROUNDING)


def test_the_take_up_of_cases_travels_for_the_own_load_too():
    """Its carriage goes on from the empty belt to the loaded one, and with that one's start and stop."""
    line = spec("overland")
    own, cases = calculate(line).take_up.travel, analyse_cases(line, [LoadCase(name="e", loading="empty")]).take_up
    assert own is not None
    assert cases.travel is not None
    assert cases.travel.load > 0.0
    assert cases.travel.load + cases.travel.motion == pytest.approx(own.motion, rel=1e-6)


@pytest.mark.parametrize("loading", STANDARD_LOADINGS)
def test_every_case_is_the_analysis_of_a_conveyor_loaded_so(line, found, loading):
    bears = {"full": {-1, 0, 1}, "empty": set(), "inclines only": {1}, "declines only": {-1}}[loading]
    sections = [section.replace(loaded=np.sign(section.rise) in bears) for section in line.route.sections]
    # the first section is level: where it bears nothing, nothing lands on it
    feeding = line.route.feeding if loading == "full" else None
    loaded = line.replace(
        route=line.route.replace(sections=sections, feeding=feeding),
        belt=line.belt.replace(speed="4.5 m/s"),
        ambient=line.ambient.replace(temperature="0 degC"),
        calculation=line.calculation.replace(not_given="nothing"),
    )
    alone = calculate(loaded).balance.held(found.take_up.setting)
    one = result(found, loading, 0.0, 4.5).found.balance
    for name, value, expected in (
        ("indentation", one.forces.indentation, alone.forces.indentation),
        ("effective", one.forces.total, alone.forces.total),
        ("motor", one.power.motor, alone.power.motor),
        ("largest", one.tensions.largest, alone.tensions.largest),
        ("slack", one.tensions.slack, alone.tensions.slack),
    ):
        assert value == pytest.approx(expected, rel=2.0 * RTOL), name


def test_variants_side_by_side_settle_on_vertical_curves_as_alone():
    curved = spec("downhill_brakes")
    empty = with_case(curved, LoadCase(name="e", loading="empty"))
    both = calculate_many([Variant(curved), Variant(empty)])
    for given, done in zip((curved, empty), both, strict=True):
        alone = calculate(given)
        assert done.convergence.steps == alone.convergence.steps
        assert done.balance.forces.total == pytest.approx(alone.balance.forces.total, rel=2.0 * RTOL)


def test_cases_of_one_temperature_share_their_load_curves(line):
    loadings = [LoadCase(name=name, loading=name) for name in ("full", "empty", "declines only")]
    variants = [
        with_temperature(with_case(line, case), quantity(celsius))
        for case in loadings
        for celsius in ("0 degC", "20 degC")
    ]
    done = calculate_many([Variant(variant) for variant in variants], 1e-4)
    curves = {roll.curve for one in done for rolls in one.contacts.rolls for roll in rolls}
    assert len(curves) == 2 * 2  # strands, temperatures


def test_a_strand_that_is_worked_alike_shares_its_cover_also_with_what_is_known():
    given = spec("overland")  # strain sweeps soften the covers; the bulk presses on the carry strand only
    own = calculate(given)
    (empty,) = calculate_many([Variant(with_case(given, LoadCase(name="e", loading="empty")))], known=own)
    assert empty.contacts.covers["return"] is own.contacts.covers["return"]
    assert empty.contacts.covers["carry"].strain.strain < own.contacts.covers["carry"].strain.strain
    faster = given.replace(belt=given.belt.replace(speed="6 m/s"))
    (alone,) = calculate_many([Variant(faster)], known=own)
    assert alone.contacts.covers["return"].strain.frequency > own.contacts.covers["return"].strain.frequency


def test_specs_that_share_a_strand_share_its_stretches_and_drags():
    given = spec("overland")
    wider = given.replace(idlers=given.idlers.replace(carry=given.idlers.carry.replace(spacing="2 m")))
    first, second = (result.line for result in calculate_many([Variant(given), Variant(wider)]))
    assert first.strands.each[1] is second.strands.each[1]
    assert first.strands.each[0] is not second.strands.each[0]
    assert second.stretches[1].spacing == 2.0
    alone = calculate(wider)
    assert second.roll_drag_forces.tolist() == alone.line.roll_drag_forces.tolist()


def test_one_result_a_case_speed_and_temperature(found):
    keys = [(r.case.name, r.speed, r.temperature) for r in found.results]
    assert len(set(keys)) == len(keys) == 4 * 2 * 2
    assert not found.refused


# loadings ---------------------------------------------------------------------------------------------------------


def lift(study, case):
    return result(study, case).found.balance.forces.lift


def test_bulk_on_inclines_and_declines_lifts_what_bulk_everywhere_does(found):
    assert lift(found, "inclines only") > 0.0 > lift(found, "declines only")
    together = lift(found, "inclines only") + lift(found, "declines only")
    assert together == pytest.approx(lift(found, "full"), rel=1e-12)
    # the belt goes up and down: what it lifts on one strand it lowers on the other
    assert lift(found, "empty") == pytest.approx(0.0, abs=1e-12 * lift(found, "inclines only"))


def test_a_loading_point_resists_only_where_bulk_lands(found):
    fed = {
        case: sum(s.total for s in result(found, case).found.balance.singles if "skirts" in s.name or "bulk" in s.name)
        for case in STANDARD_LOADINGS
    }
    assert fed["full"] > 0.0
    assert fed["empty"] == fed["inclines only"] == fed["declines only"] == 0.0


def test_part_load_is_the_flow_times_its_share(line):
    half = with_case(line, LoadCase(name="half", loading="part load", share="50 %"))
    assert half == line.replace(material=line.material.replace(flow="1200 t/h"))
    whole = with_case(line, LoadCase(name="whole", loading="part load", share="100 %"))
    assert si(whole.material.flow) == pytest.approx(si(line.material.flow), rel=1e-15)


def test_part_load_leaves_unloaded_sections_unloaded(line):
    first, *others = line.route.sections
    given = line.replace(route=line.route.replace(sections=[first, *(s.replace(loaded=False) for s in others)]))
    part = with_case(given, LoadCase(name="half", loading="part load", share=0.5))
    assert [s.loaded for s in part.route.sections] == [s.loaded for s in given.route.sections]
    assert all(s.loaded for s in with_case(given, LoadCase(name="full", loading="full")).route.sections)


def test_power_falls_with_the_share_to_that_of_the_empty_belt(line):
    shares = [1.0, 0.5, 1e-6]
    cases = [LoadCase(name=f"{s}", loading="part load", share=s) for s in shares]
    study = analyse_cases(line, [*cases, LoadCase(name="empty", loading="empty")], rtol=1e-5)
    powers = [r.found.balance.power.motor for r in study.results]
    assert powers == sorted(powers, reverse=True)
    assert powers[2] == pytest.approx(powers[3], rel=1e-4)


def test_the_air_keeps_its_distance_to_the_covers(downhill):
    warmer = with_temperature(downhill, quantity("28 degC"))
    assert si(warmer.ambient.belt) == pytest.approx(301.15, abs=1e-9)
    assert si(warmer.ambient.temperature) == pytest.approx(298.15, abs=1e-6)
    assert with_temperature(downhill, downhill.ambient.belt) is downhill


def test_bearings_follow_the_temperature_of_a_case(line):
    # stiff grease when cold: a track shared between temperatures would miss it
    law = {
        "law": "bearing", "mean_diameter": "36 mm", "static_rating": "11 kN", "first_viscosity": "110 mm^2/s",
        "second_viscosity": "12 mm^2/s", "seal_moment": "0.05 N*m",
    }  # fmt: skip
    carry = line.idlers.carry
    greased = line.replace(idlers=line.idlers.replace(carry=carry.replace(roll=carry.roll.replace(drag_law=law))))
    study = analyse_cases(greased, [LoadCase(name="a", temperatures=("0 degC", "20 degC"))])
    cold, warm = study.results
    turning = [one.found.balance.forces.parts["idler_rotation"] for one in (cold, warm)]
    for one, rotation, celsius in ((cold, turning[0], 0), (warm, turning[1], 20)):
        alone = calculate(greased.replace(ambient={"temperature": f"{celsius} degC"})).balance
        alone = alone.held(study.take_up.setting).forces
        assert rotation == pytest.approx(alone.parts["idler_rotation"], rel=1e-12)
        assert one.found.balance.forces.total == pytest.approx(alone.total, rel=2.0 * RTOL)
    assert turning[0] > 1.2 * turning[1]


# friction on the safe side ----------------------------------------------------------------------------------------


def test_friction_scales_all_but_lift_and_acceleration(downhill):
    (one,) = analyse_cases(downhill, [LoadCase(name="full", loading="full")], friction_band=(0.5, 2.0)).results
    forces, singles = one.found.balance.forces, one.found.balance.singles
    certain = forces.lift + sum(s.total for s in singles if s.name.startswith("acceleration of the bulk"))
    low, high = one.forces
    for friction, force in ((0.5, low), (1.0, forces.total), (2.0, high)):
        assert force == pytest.approx(certain + friction * (forces.total - certain), rel=1e-11)


def test_downhill_the_low_friction_feeds_back_most(downhill):
    study = analyse_cases(downhill)
    full = next(r for r in study.results if r.case.name == "full")
    power, (low, high) = full.found.balance.power, full.motors
    assert low < power.motor < 0.0
    settled = full.found.balance.equilibrium
    assert high == pytest.approx(full.found.balance.layout.motor(settled.design_force), rel=ROUNDING)
    assert high > power.motor
    assert power.belt < power.motor  # the train's losses are on the way to the motor
    worst = {g.figure: g for g in study.governing}["minimum motor power"]
    assert worst.result.name == "declines only"
    assert study.friction_band == (pytest.approx(0.6), study.as_given.line.design_friction)


@pytest.mark.parametrize("band", [(0.0, 1.0), (0.5, 0.9), (1.1, 1.2), (0.5, math.inf)])
def test_a_band_that_does_not_hold_the_computed_friction_is_refused(line, band):
    with pytest.raises(InputError, match="0 < low <= 1 <= high"):
        analyse_cases(line, friction_band=band)


# governing cases and motors ---------------------------------------------------------------------------------------


def test_governing_cases_are_the_extremes_of_all(found):
    by_figure = {row.figure: row for row in found.governing}
    figures = {
        "maximum motor power": (max, lambda r: r.motors[1]),
        "minimum motor power": (min, lambda r: r.motors[0]),
        "maximum belt tension": (max, lambda r: r.found.balance.tensions.largest),
        "minimum belt tension, steady": (min, lambda r: r.found.balance.tensions.smallest),
        "required take-up tension": (max, lambda r: r.found.balance.equilibrium.needed),
        "maximum roll load": (max, lambda r: r.heaviest_roll[0]),
        "maximum indentation": (max, lambda r: r.found.balance.forces.indentation),
    }
    for figure, (extreme, value) in figures.items():
        row = by_figure[figure]
        assert row.value == pytest.approx(extreme(map(value, found.results)), rel=ROUNDING), figure
        assert value(row.result) == pytest.approx(row.value, rel=ROUNDING), figure


def test_cold_inclines_need_the_largest_motor(found):
    row = found.governing[0]
    assert (row.result.name, row.result.temperature, row.result.speed) == ("inclines only", 273.15, 5.0)


def test_the_largest_roll_load_is_that_of_the_analysis(line, found):
    stretches = calculate(line).line.stretches
    heaviest, stretch = max(
        ((load, stretch) for stretch in stretches for load in stretch.loads), key=lambda pair: pair[0].force
    )
    where = f"{stretch.section}, {stretch.strand}, {heaviest.name}"
    force, at = result(found, "full").heaviest_roll
    assert force == pytest.approx(heaviest.force, rel=ROUNDING)
    assert at == where


def test_motors_give_the_governing_power_with_their_reserve(found):
    needed = max(max(map(abs, r.motors)) for r in found.results)
    for reserve in (1.0, 1.1, 1.5):
        (motor,) = found.motors(reserve)
        assert abs(motor.needed) == pytest.approx(needed, rel=ROUNDING)
        assert motor.count * motor.rated >= reserve * needed
        assert (motor.count - 1) * MOTOR_SERIES[-1] < reserve * needed  # no fewer of the largest would do
        assert motor.case.text().startswith("inclines only, 0 °C")
        assert motor.reserve == pytest.approx(motor.count * motor.rated / needed, rel=ROUNDING)


def test_each_of_several_drives_has_its_share_of_the_motors(line):
    drive = line.drive.replace(
        share="60 %",
        further_drives=[
            {
                "name": "second",
                "wrap_angle": "180 deg",
                "friction": 0.35,
                "share": "40 %",
                "installed_power": "1 MW",
            }
        ],
    )
    study = analyse_cases(line.replace(drive=drive), [LoadCase(name="full", loading="full")])
    first, second = study.motors(1.0)
    assert (first.drive, second.drive) == ("drive", "second")
    assert second.needed / first.needed == pytest.approx(2.0 / 3.0, rel=1e-12)
    balance = study.results[0].found.balance
    whole = balance.layout.motor(balance.equilibrium.design_force)
    assert first.needed + second.needed == pytest.approx(whole, rel=1e-12)


def test_a_brake_is_sized_by_its_amount(downhill):
    study = analyse_cases(downhill, [LoadCase(name="full", loading="full")])
    (motor,) = study.motors(1.0)
    assert motor.needed == pytest.approx(study.results[0].motors[0], rel=ROUNDING)
    assert motor.needed < 0.0
    assert motor.rated >= -motor.needed / motor.count


def test_the_train_multiplies_on_both_sides_of_the_motor(line):
    data = line.as_data()
    del data["drive"]["efficiency"]
    data["drive"]["train"] = [
        {"name": "motor", "efficiency": "95 %", "side": "mains"},
        {"name": "coupling", "efficiency": "98 %"},
        {"name": "gear", "efficiency": 0.97},
    ]
    data["drive"]["regeneration_efficiency"] = "90 %"
    made = Conveyor.from_data(data)
    assert si(made.drive.efficiency) == pytest.approx(0.98 * 0.97, rel=1e-15)
    frame = LoopLayout(Line.of(made))
    assert frame.motor(1e5) == pytest.approx(1e5 * 5.0 / (0.98 * 0.97), rel=1e-14)
    assert frame.mains(1e5) == pytest.approx(1e5 * 5.0 / (0.95 * 0.98 * 0.97), rel=1e-14)
    assert frame.mains(-1e5) == pytest.approx(-1e5 * 5.0 * 0.9 * 0.95, rel=1e-14)
    assert Conveyor.from_data(made.as_data()) == made
    alone = calculate(made).balance
    assert alone.power.motor == pytest.approx(frame.motor(alone.forces.total), rel=1e-14)


# refusals ---------------------------------------------------------------------------------------------------------


def test_cases_without_an_answer_are_listed_with_their_reason(line):
    study = analyse_cases(
        line,
        [
            LoadCase(name="hot", temperatures=("190 degC", "20 degC")),
            LoadCase(name="surge", loading="part load", share="200 %"),
            LoadCase(name="slow", speeds=("1 m/s",)),
        ],
    )
    assert [(r.case.name, r.temperature) for r in study.results] == [("hot", 293.15)]
    assert [r.case for r in study.refused] == ["hot", "surge", "slow"]
    hot, surge, slow = (r.reason for r in study.refused)
    assert "190 degC" in hot
    assert "the belt holds" in surge
    assert "the belt holds" in slow
    told = [check for check in study.checks if check.key == "case_answer"]
    assert [check.why.text() for check in told] == [degree_signs(hot), surge, slow]
    assert {(check.found.text(), check.verdict) for check in told} == {("3 of 4 cases could not be calculated", "FAIL")}


def test_refusals_name_what_is_wrong(line, found):
    with pytest.raises(InputError, match='cases: "one" is given twice'):
        analyse_cases(line, [LoadCase(name="one"), LoadCase(name="one")])
    with pytest.raises(InputError, match="give at least one"):
        analyse_cases(line, [])
    with pytest.raises(InputError, match=r"reserve = 0\.9: at least 1"):
        found.motors(0.9)
    none = analyse_cases(line, [LoadCase(name="hot", temperatures=("190 degC",))])
    assert none.governing == ()
    with pytest.raises(InputError, match="no case has an answer"):
        none.motors()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cases": [{"name": "a", "loading": "part load"}]}, r"cases\[0\].share: missing"),
        (
            {"cases": [{"name": "a", "loading": "full", "share": "50 %"}]},
            'got 50 % with loading "full"; remove it',
        ),
        (
            {"cases": [{"name": "a"}, {"name": "a"}]},
            r'cases\[1\].name: got "a", already the name of cases\[0\]',
        ),
        ({"cases": [{"name": "a", "loading": "half"}]}, "inclines only"),
        ({"cases": [{"name": "a", "speeds": ["30 m/s"]}]}, "got 30 m/s, allowed: > 0 m/s and <= 20 m/s"),
        ({"cases": [{"name": "a", "temperatures": ["300 degC"]}]}, "allowed: >= -100 degC"),
    ],
)
def test_specs_with_wrong_cases_are_refused(line, change, message):
    with pytest.raises(InputError, match=message):
        line.replace(**change)


def test_a_train_that_contradicts_the_efficiency_is_refused(line):
    train = [{"name": "gear", "efficiency": "90 %"}]
    with pytest.raises(InputError, match=r"got 94 %, the parts of train from motor shaft to belt give 0\.9; leave"):
        line.drive.replace(train=train)
    assert si(line.drive.replace(train=train, efficiency=None).efficiency) == 0.9
    with pytest.raises(InputError, match="efficiency"):
        line.drive.replace(train=[], efficiency=None)


# the spec ---------------------------------------------------------------------------------------------------------


def test_cases_of_the_spec_are_read_back_and_calculated():
    given = spec("overland_10km")
    assert Conveyor.from_data(given.as_data()) == given
    study = analyse_cases(given.replace(calculation=given.calculation.replace(strain="off")), rtol=1e-3)
    assert len(study.results) == 4 * 3 + 2
    inclines = [r for r in study.results if r.case.loading == "inclines only"]
    assert len(inclines) == 3
    assert all(r.energy_per_tonne_km is None for r in inclines)
    assert [r.speed for r in study.results if r.case.name == "half"] == [3.5, 5.5]


def test_without_cases_the_standard_ones(line):
    assert [case.loading for case in analyse_cases(line, rtol=1e-4).cases] == list(STANDARD_LOADINGS)


def test_figures_over_all_loads_take_their_own_end_of_the_friction_band():
    """Forces and motor powers come as (least friction, friction to design for)."""
    load = SimpleNamespace(forces=(-2e3, 9e3), motors=(-5e3, 40e3))
    taken = {name: load_cases._FIGURES[f"{name}_friction_{end}"][3](load) for name, end in (
        ("least_drive_force", "low"), ("largest_drive_force", "high"),
        ("least_motor_power", "low"), ("largest_motor_power", "high"))}  # fmt: skip
    assert taken == {
        "least_drive_force": -2e3,
        "largest_drive_force": 9e3,
        "least_motor_power": -5e3,
        "largest_motor_power": 40e3,
    }
