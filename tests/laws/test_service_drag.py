"""Drag of a roll in service: acceptance, the usual share of the moving weight, heat balance, cold."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws.resistance import (
    SERVICE_DRAG,
    bearing_roll_drag,
    oil_viscosity,
    roll_end_cooling,
    service_roll_drag,
    usual_bearing,
)

TESTED = 650.0 / 60.0  # [1/s], acceptance


def drag(load, diameter=0.159, air=293.15, speed=None):
    return service_roll_drag(
        load,
        belt_speed=math.pi * diameter * TESTED if speed is None else speed,
        roll_diameter=diameter,
        roll_length=0.465,
        air_temperature=air,
    )


@pytest.mark.parametrize("diameter", [0.089, 0.108, 0.127, 0.133, 0.152, 0.159, 0.178, 0.194, 0.219])
def test_a_roll_in_service_drags_about_what_acceptance_allows(diameter):
    # 3.0 N at 650 rpm under 250 N; 1.28 N rim drag is the least limit, of rolls to 153 mm
    assert 1.28 < drag(250.0, diameter).force < 3.0 * 1.02  # bearings step with the diameter, the limit does not


def test_the_seal_is_set_by_the_limit_of_a_159_mm_roll():
    # 2.45 N; the stress is rounded to 500 Pa, which a hundred changes by 0.3 N
    assert drag(250.0).force == pytest.approx(2.45, abs=0.15)


def test_idlers_of_a_heavy_conveyor_take_their_usual_share_of_the_moving_weight():
    # 880 m, 9400 t/h, 5.1 m/s: 0.0015 of the weight, 7 kN; rolls of 152 mm with which the limit 1.28 N gives 2.6 kN
    bulk, belt = 9400.0 / 3.6 / 5.1, 45.0
    load = (bulk + belt) * 9.81 * 1.5
    carry = 2.0 * drag(0.15 * load, 0.152, speed=5.1).force + drag(0.7 * load, 0.152, speed=5.1).force
    back = drag(belt * 9.81 * 3.0, 0.152, speed=5.1).force
    assert pytest.approx(2.6e3, abs=50.0) == (880.0 / 1.5 * 3.0 + 880.0 / 3.0) * 1.28
    whole = 880.0 / 1.5 * carry + 880.0 / 3.0 * back
    assert 0.8 < whole / 7e3 < 1.25
    assert SERVICE_DRAG.low < 7e3 / whole < SERVICE_DRAG.high


@pytest.mark.parametrize("air", [253.15, 293.15, 313.15])
def test_the_bearing_is_as_warm_as_its_friction_keeps_it(air):
    found = drag(1500.0, air=air, speed=5.0)
    # both ends: F v = 2 G (T - air); T is closed to 1e-10 K of some kelvin
    cooled = 2.0 * roll_end_cooling(0.159, roll_length=0.465) * (found.bearing_temperature - air)
    assert cooled == pytest.approx(found.force * 5.0, rel=1e-9)
    # and the friction is Palmgren's at that temperature: middle of f0 0.7 to 2, of z 0.0004 to 0.0009
    bearing = usual_bearing(0.159)
    by_hand = bearing_roll_drag(
        1500.0,
        belt_speed=5.0,
        roll_diameter=0.159,
        mean_diameter=0.0435,
        viscosity=oil_viscosity(
            found.bearing_temperature,
            first_temperature=313.15,
            first_viscosity=100e-6,
            second_temperature=373.15,
            second_viscosity=11e-6,
        ),
        static_rating=bearing.static_rating,
        f0=1.35,
        f1_factor=0.00065,
        f1_exponent=0.55,
        seal_moment=500.0 * 2.0 * math.pi * 0.031**2 * 0.02,
    )
    assert found.force == pytest.approx(by_hand.force, rel=1e-12)


def test_a_bearing_that_warms_itself_is_not_absurd_in_the_cold():
    warm, cold = drag(250.0, speed=5.0), drag(250.0, air=253.15, speed=5.0)
    assert 2.0 < cold.force / warm.force < 4.0
    at_air = bearing_roll_drag(
        250.0, belt_speed=5.0, roll_diameter=0.159, mean_diameter=0.0435, static_rating=11.6e3, f0=1.35,
        f1_factor=0.00065, f1_exponent=0.55, seal_moment=0.0604,
        viscosity=oil_viscosity(
            253.15, first_temperature=313.15, first_viscosity=100e-6, second_temperature=373.15,
            second_viscosity=11e-6,
        ),
    )  # fmt: skip
    assert cold.force < 0.6 * at_air.force


def test_drag_grows_with_load_and_speed_and_falls_in_warm_air():
    loads = [drag(load).force for load in (0.0, 250.0, 2500.0, 10e3)]
    speeds = [drag(1500.0, speed=speed).force for speed in (0.5, 2.0, 5.0, 8.0)]
    airs = [-drag(1500.0, air=air).force for air in (233.15, 263.15, 293.15, 323.15)]
    for rising in (loads, speeds, airs):
        assert rising == sorted(rising)


def test_a_long_roll_cools_like_an_endless_fin():
    # l = sqrt(50 W/(m K) 4 mm/25 W/(m² K)); the disc has D/4
    endless = 25.0 * math.pi * 0.159 * (math.sqrt(0.2 / 25.0) + 0.159 / 4.0)
    assert roll_end_cooling(0.159, roll_length=5.0) == pytest.approx(endless, rel=1e-12)
    # a short one by all its surface, tanh x = x - x³/3
    short = 25.0 * math.pi * 0.159 * (0.005 + 0.159 / 4.0)
    assert roll_end_cooling(0.159, roll_length=0.01) == pytest.approx(short, rel=2e-4)


def test_what_has_no_usual_bearing_or_grease_is_refused():
    with pytest.raises(InputError, match=r"roll_diameter: got 0\.03, allowed: > 0\.032 m; give the"):
        usual_bearing(0.03)
    with pytest.raises(InputError, match="the oil is solid there"):
        drag(250.0, air=150.0)
    with pytest.raises(InputError, match=r"belt_speed: got 0\.0"):
        drag(250.0, speed=0.0)


@pytest.mark.parametrize(
    ("roll", "name", "balls", "ball", "factor"),
    [
        (0.051, "6201", 7, 5.953, 12.4),
        (0.076, "6203", 8, 6.747, 13.1),
        (0.108, "6204", 8, 7.938, 13.1),
        (0.133, "6205", 9, 7.938, 13.8),
        (0.159, "6305", 7, 11.509, 12.4),
        (0.219, "6306", 8, 12.303, 13.1),
        (0.3, "6308", 8, 15.081, 13.0),
    ],
)
def test_static_ratings_are_those_of_the_balls_inside(roll, name, balls, ball, factor):
    """ISO 76: C0 = f0 i Z D², D in mm; balls of the usual makers (general knowledge), printed ratings are rounded."""
    bearing = usual_bearing(roll)
    assert bearing.name == name
    assert bearing.static_rating == pytest.approx(factor * balls * ball**2, rel=0.03)
