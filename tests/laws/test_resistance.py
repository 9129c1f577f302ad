"""Resistances: additivity, limits, round trips, hand values, refusals."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from conveyor.errors import InputError, RangeError, ValidityWarning
from conveyor.laws import resistance

ROUNDING = 1e-14  # a handful of products and sums

LINE = {"belt_mass": 16.0, "inclination": 0.1, "gravity": 9.81}
WHOLE = LINE | {
    "friction_factor": 0.02,
    "length": 500.0,
    "carry_roll_mass": 12.0,
    "return_roll_mass": 4.0,
    "bulk_mass": 130.0,
}
CARRY = LINE | {"friction_factor": 0.02, "length": 500.0, "roll_mass": 12.0, "bulk_mass": 130.0}
RETURN = CARRY | {"roll_mass": 4.0, "bulk_mass": 0.0}


def test_strands_add_up_to_the_whole_conveyor():
    strands = resistance.section_main_resistance(**CARRY) + resistance.section_main_resistance(**RETURN)
    assert strands == pytest.approx(resistance.main_resistance(**WHOLE), rel=ROUNDING)


def test_splitting_a_section_changes_nothing():
    parts = [resistance.section_main_resistance(**CARRY | {"length": part}) for part in (123.0, 377.0)]
    assert sum(parts) == pytest.approx(resistance.section_main_resistance(**CARRY), rel=ROUNDING)
    rolls = {"n_rolls": 3, "spacing": 1.3}
    drags = [resistance.idler_rotation_resistance(2.0, length=part, **rolls) for part in (123.0, 377.0)]
    assert sum(drags) == pytest.approx(resistance.idler_rotation_resistance(2.0, length=500.0, **rolls), rel=ROUNDING)


def test_equivalent_friction_factor_gives_back_the_factor():
    unit = resistance.main_resistance(**WHOLE | {"friction_factor": 1.0})
    force = resistance.main_resistance(**WHOLE)
    assert resistance.equivalent_friction_factor(force, unit_main_force=unit) == pytest.approx(0.02, rel=ROUNDING)


def test_main_resistance_is_even_in_the_slope_and_rolls_do_not_feel_it():
    bare = WHOLE | {"belt_mass": 0.0, "bulk_mass": 0.0}
    for one, other in ((WHOLE, WHOLE | {"inclination": -0.1}), (bare, bare | {"inclination": 0.0})):
        expected = resistance.main_resistance(**one)
        assert resistance.main_resistance(**other) == pytest.approx(expected, rel=ROUNDING)


def test_slope_resistance_is_the_work_per_distance():
    assert resistance.slope_resistance(100.0, lift=20.0, gravity=9.81) == pytest.approx(19620.0, rel=ROUNDING)
    assert resistance.slope_resistance(100.0, lift=-20.0, gravity=9.81) == pytest.approx(-19620.0, rel=ROUNDING)


def test_length_coefficient_falls_from_node_to_node_without_overshoot():
    nodes = resistance.LENGTH_COEFFICIENTS
    for (short, high), (long, low) in pairwise(nodes):
        assert low < resistance.length_coefficient(math.sqrt(short * long)) < high
        assert resistance.length_coefficient(math.sqrt(short * long)) == pytest.approx((low + high) / 2, rel=1e-12)


@pytest.mark.parametrize("length", [2.9, 5001.0, math.nan, -1.0])
def test_length_coefficient_is_not_extrapolated(length):
    with pytest.raises(RangeError, match=r"outside the table of C \(3 to 5000 m\): itemise"):
        resistance.length_coefficient(length)


def test_short_conveyor_is_warned_about():
    with pytest.warns(ValidityWarning, match=r"length = 63 m: .* meant for more than 80 m"):
        assert resistance.secondary_resistance(1000.0, length=63.0) == pytest.approx(1000.0, rel=1e-12)


def test_acceleration_zone_balances_the_bulks_momentum_and_kinetic_energy():
    speeds = {"belt_speed": 4.0, "initial_speed": 1.0}
    length = resistance.acceleration_length(**speeds, belt_friction=0.5, gravity=9.81)
    # friction μ1 g per mass over l_b is the gain of kinetic energy per mass
    assert 0.5 * 9.81 * length == pytest.approx((4.0**2 - 1.0**2) / 2, rel=ROUNDING)
    assert resistance.acceleration_resistance(100.0, **speeds) == pytest.approx(300.0, rel=ROUNDING)
    still = {"belt_speed": 4.0, "initial_speed": 4.0}
    assert resistance.acceleration_resistance(100.0, **still) == 0
    assert resistance.acceleration_length(**still, belt_friction=0.5, gravity=9.81) == 0


def test_skirts_in_the_acceleration_zone_meet_the_skirts_beyond_it_at_equal_speed():
    skirt = {"volume_flow": 0.7, "bulk_density": 900.0, "length": 3.0, "skirt_distance": 0.8}
    skirt |= {"skirt_friction": 0.7, "gravity": 9.81}
    zone = resistance.acceleration_skirt_resistance(**skirt, belt_speed=4.0, initial_speed=4.0)
    assert zone == pytest.approx(resistance.skirt_resistance(**skirt, bulk_speed=4.0), rel=ROUNDING)
    slow = resistance.acceleration_skirt_resistance(**skirt, belt_speed=4.0, initial_speed=0.0)
    assert slow == pytest.approx(4 * zone, rel=ROUNDING)


def test_bulk_that_passes_a_later_feeding_point_lies_between_its_skirts_too():
    skirt = {
        "bulk_density": 900.0,
        "length": 3.0,
        "skirt_distance": 0.8,
        "skirt_friction": 0.7,
        "gravity": 9.81,
    }
    law = resistance.acceleration_skirt_resistance
    still = law(**skirt, volume_flow=0.3, passing=0.4, belt_speed=4.0, initial_speed=4.0)
    assert still == pytest.approx(resistance.skirt_resistance(**skirt, volume_flow=0.7, bulk_speed=4.0), rel=ROUNDING)
    # from rest the fresh bulk lies at half the speed, twice as deep: 2 * 0.3 + 0.4 beside 0.7
    slow = law(**skirt, volume_flow=0.3, passing=0.4, belt_speed=4.0, initial_speed=0.0)
    assert slow == pytest.approx(still * (1.0 / 0.7) ** 2, rel=ROUNDING)


def test_skirt_resistance_is_hydrostatic_pressure_times_friction():
    # bulk of depth d = Q/(v b1) presses both skirts with ρ g d²/2 per length
    depth = 0.7 / (4.0 * 0.8)
    both = 2 * 0.7 * 900.0 * 9.81 * depth**2 / 2 * 3.0
    law = resistance.skirt_resistance(
        volume_flow=0.7,
        bulk_density=900.0,
        length=3.0,
        bulk_speed=4.0,
        skirt_distance=0.8,
        skirt_friction=0.7,
        gravity=9.81,
    )
    assert law == pytest.approx(both, rel=ROUNDING)


def test_wrap_resistances_by_hand():
    wrap = {"belt_width": 1.2, "tension": 12000.0, "belt_thickness": 0.0125, "pulley_diameter": 0.5}
    # 9 · 1.2 · (140 + 100) · 0.025 and 12 · 1.2 · (200 + 100) · 0.025
    assert resistance.fabric_wrap_resistance(**wrap) == pytest.approx(64.8, rel=ROUNDING)
    assert resistance.steel_cord_wrap_resistance(**wrap) == pytest.approx(108.0, rel=ROUNDING)


def test_pulley_bearing_of_a_weightless_pulley_carries_both_strands():
    load = resistance.pulley_load(tight_tension=2e4, slack_tension=1e4, pulley_mass=0.0, gravity=9.81)
    assert load == pytest.approx(3e4, rel=ROUNDING)
    drag = resistance.pulley_bearing_resistance(load, shaft_diameter=0.1, pulley_diameter=0.5)
    assert drag == pytest.approx(30.0, rel=ROUNDING)


def test_a_snub_bears_the_vector_sum_of_both_strands():
    pull = {"tight_tension": 3e4, "slack_tension": 3e4, "pulley_mass": 0.0, "gravity": 9.81}
    third = resistance.pulley_load(**pull, wrap_angle=math.radians(60.0))  # an equilateral triangle of forces
    assert third == pytest.approx(3e4, rel=ROUNDING)
    square = resistance.pulley_load(**pull | {"slack_tension": 4e4}, wrap_angle=math.radians(90.0))
    assert square == pytest.approx(5e4, rel=ROUNDING)
    with pytest.raises(InputError, match=r"wrap_angle: got 0\.0"):
        resistance.pulley_load(**pull, wrap_angle=0.0)


def test_idler_without_tilt_costs_nothing():
    tilt = {
        "tilt_coefficient": 0.4,
        "roll_friction": 0.35,
        "length": 100.0,
        "belt_mass": 20.0,
        "bulk_mass": 80.0,
    }
    tilt |= {"inclination": 0.0, "gravity": 9.81}
    assert resistance.idler_tilt_resistance(**tilt, tilt_angle=0.0) == 0
    some = resistance.idler_tilt_resistance(**tilt, tilt_angle=math.radians(30))
    assert some == pytest.approx(0.4 * 0.35 * 100 * 100 * 9.81 / 2, rel=ROUNDING)
    steep = resistance.idler_tilt_resistance(**tilt | {"inclination": math.radians(60)}, tilt_angle=math.radians(30))
    assert steep == pytest.approx(some / 2, rel=ROUNDING)


def test_every_roll_of_every_set_drags():
    one = resistance.idler_rotation_resistance(2.0, n_rolls=1, spacing=3.0, length=300.0)
    assert one == pytest.approx(200.0, rel=ROUNDING)
    assert resistance.idler_rotation_resistance(2.0, n_rolls=3, spacing=1.5, length=300.0) == pytest.approx(
        6 * one, rel=ROUNDING
    )


@pytest.mark.parametrize(
    ("diameter", "limit"), [(0.089, 1.28), (0.153, 1.28), (0.159, 2.45), (0.178, 2.45), (0.194, 3.0)]
)
def test_assumed_roll_drag_is_the_acceptance_limit_and_says_so(diameter, limit):
    drag = resistance.roll_drag(None, roll_diameter=diameter)
    assert (drag.force, drag.assumed) == (limit, True)
    assert "limit" in drag.source
    assert not resistance.roll_drag(0.0, roll_diameter=diameter).assumed


def test_flexure_is_its_share_of_the_new_total():
    flexure = resistance.flexure_resistance(8000.0, share=0.11)
    assert flexure / (8000.0 + flexure) == pytest.approx(0.11, rel=ROUNDING)
    assert resistance.flexure_resistance(8000.0, share=0.0) == 0


def test_every_default_lies_in_its_range_and_names_a_source():
    defaults = [value for value in vars(resistance).values() if isinstance(value, resistance.Default)]
    assert len(defaults) >= 16
    for default in defaults:
        assert default.low <= default.value <= default.high
        assert default.source


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: resistance.main_resistance(**WHOLE | {"friction_factor": -0.1}), r"friction_factor: got -0\.1"),
        (
            lambda: resistance.main_resistance(**WHOLE | {"inclination": 20.0}),
            r"inclination: got 20\.0, allowed: .* pi/2 rad",
        ),
        (lambda: resistance.section_main_resistance(**CARRY | {"gravity": 0.0}), r"gravity: got 0\.0"),
        (lambda: resistance.section_main_resistance(**CARRY | {"bulk_mass": math.nan}), r"bulk_mass: got nan"),
        (lambda: resistance.roll_line_mass(15.0, spacing=0.0), r"spacing: got 0\.0"),
        (lambda: resistance.equivalent_friction_factor(1.0, unit_main_force=0.0), r"unit_main_force: got 0\.0"),
        (lambda: resistance.equivalent_friction_factor(math.nan, unit_main_force=1.0), r"main_force: got nan"),
        (lambda: resistance.secondary_resistance(-1.0, length=100.0), r"main_force: got -1\.0"),
        (
            lambda: resistance.slope_resistance(1.0, lift=math.inf, gravity=9.81),
            r"lift: got inf, allowed: finite",
        ),
        (
            lambda: resistance.acceleration_resistance(1.0, belt_speed=2.0, initial_speed=3.0),
            r"initial_speed: got 3\.0, allowed: >= 0 and <= belt_speed = 2\.0 m/s",
        ),
        (lambda: resistance.cleaner_resistance(-0.1, pressure=3e4, friction=0.6), r"contact_area: got -0\.1"),
        (
            lambda: resistance.fabric_wrap_resistance(
                belt_width=1.0, tension=1.0, belt_thickness=0.01, pulley_diameter=0.0
            ),
            r"pulley_diameter: got 0\.0",
        ),
        (
            lambda: resistance.pulley_load(tight_tension=-1.0, slack_tension=0.0, pulley_mass=0.0, gravity=9.8),
            r"tight_tension: got -1\.0",
        ),
        (
            lambda: resistance.pulley_load(tight_tension=math.inf, slack_tension=0.0, pulley_mass=0.0, gravity=9.8),
            r"tight_tension: got inf, allowed: >= 0 and finite",
        ),
        (
            lambda: resistance.pulley_bearing_resistance(1.0, shaft_diameter=0.0, pulley_diameter=1.0),
            r"shaft_diameter: got 0\.0",
        ),
        (lambda: resistance.roll_drag(-1.0, roll_diameter=0.1), r"given: got -1\.0"),
        (lambda: resistance.roll_drag(None, roll_diameter=0.0), r"roll_diameter: got 0\.0"),
        (
            lambda: resistance.idler_rotation_resistance(1.0, n_rolls=0, spacing=1.0, length=1.0),
            r"n_rolls: got 0, allowed: >= 1",
        ),
        (
            lambda: resistance.flexure_resistance(1.0, share=1.0),
            r"share: got 1\.0, allowed: >= 0 and < 1",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
