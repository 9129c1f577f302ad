"""Parts of drives: NEMA's starts, preferred numbers, shares of coupled motors by hand, energy of a flywheel."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError, RangeError
from conveyor.laws import drives
from conveyor.laws.motion import reduced_mass

ROUNDING = 1e-12
LB_FT2 = 0.45359237 * 0.3048**2


def starts(horsepower, poles, inertia):
    return drives.allowed_starts(horsepower * drives.HORSEPOWER, poles=poles, load_inertia=inertia * LB_FT2)


@pytest.mark.parametrize(
    ("horsepower", "poles", "inertia", "expected"),
    [
        (25, 4, 50, 2.44),
        (10, 2, 1, 6.2),
        (10, 6, 1, 14.2),
        (250, 2, 210, 1.0),
        (250, 6, 1, 4.2),
        (100, 4, 441, 1.0),
    ],
)
def test_starts_as_printed(horsepower, poles, inertia, expected):
    assert starts(horsepower, poles, inertia) == pytest.approx(expected, rel=1e-6)


def test_between_two_sizes_the_less_favourable_figures():
    assert starts(110, 4, 1) == pytest.approx(4.8)  # of 125 hp
    assert starts(110, 4, 441) == pytest.approx(1.0, rel=1e-6)  # product of 100 hp


def test_larger_motors_are_beyond_the_table():
    with pytest.raises(RangeError, match="300 hp is outside NEMA's table of starts"):
        starts(300, 4, 100)


def test_preferred_numbers_stay_and_are_reached():
    for number in (1.0, 3150.0, 0.8, 1e4):
        assert drives.next_preferred_number(number) == pytest.approx(number, rel=ROUNDING)
    assert [drives.next_preferred_number(x) for x in (1.01, 9.9, 101.0)] == pytest.approx([1.25, 10.0, 125.0])
    assert [drives.nearest_ratio(x) for x in (7.3, 9.6, 11.0, 16.5)] == pytest.approx([7.1, 10.0, 11.2, 16.0])


def test_a_flywheel_stores_what_coasting_longer_asks_for():
    given = {"retarding_force": 20e3, "belt_speed": 4.0, "radius": 0.4, "ratio": 20.0}
    inertia = drives.flywheel_inertia(30.0, moving_mass=100e3, **given)
    mass = 100e3 + reduced_mass(inertia, radius=0.4, ratio=20.0)
    assert mass * 4.0 / 20e3 == pytest.approx(30.0, rel=ROUNDING)
    assert drives.flywheel_inertia(10.0, moving_mass=100e3, **given) == 0.0


def test_backstops_share_unevenly_but_none_bears_more_than_all():
    torques = [drives.backstop_torque(1e5, radius=0.5, count=n) for n in (1, 2, 3)]
    assert torques == pytest.approx([50e3, 0.7 * 50e3, 1.4 * 50e3 / 3])


def test_alike_drives_share_alike_and_rated_ones_by_their_rating():
    alike = {"slips": [0.02] * 2, "diameters": [1.0] * 2, "strains": [0.0] * 2}
    assert drives.shared_forces(80e3, rated=[60e3, 20e3], **alike) == pytest.approx((60e3, 20e3))


def test_the_motor_of_less_slip_takes_more():
    # one speed: s F/R is the same of both
    first, second = drives.shared_forces(
        60e3, rated=[50e3] * 2, slips=[0.01, 0.02], diameters=[1.0] * 2, strains=[0.0] * 2
    )
    assert (first, second) == pytest.approx((40e3, 20e3))


def test_a_larger_pulley_takes_more_and_stretch_less():
    # both at v: F_i = R (1 - v (1 + e_i)/V_i)/s
    given = {"rated": [50e3] * 2, "slips": [0.02] * 2}
    larger = drives.shared_forces(60e3, diameters=[1.002, 1.0], strains=[0.0] * 2, **given)
    assert math.fsum(larger) == pytest.approx(60e3)
    speed = (2 - 60e3 / 2.5e6) / (1 + 1 / 1.002)  # of R/s = 2.5e6 N both
    assert larger[0] - larger[1] == pytest.approx(2.5e6 * speed * (1 - 1 / 1.002), rel=1e-9)
    stretched = drives.shared_forces(60e3, diameters=[1.0] * 2, strains=[0.0, -0.002], **given)
    assert stretched[1] > stretched[0]  # behind the first drive the belt is shorter, and slower


def test_disc_of_steel():
    assert drives.disc_temperature_rise(1e6, mass=100.0) == pytest.approx(1e6 / 46e3)


def test_refusals():
    with pytest.raises(InputError, match="count: got 0"):
        drives.backstop_torque(1.0, radius=1.0, count=0)
    with pytest.raises(InputError, match="as many as slips"):
        drives.shared_forces(1.0, rated=[1.0], slips=[], diameters=[1.0], strains=[0.0])
    with pytest.raises(InputError, match=r"slips: got 1\.0"):
        drives.shared_forces(1.0, rated=[1.0], slips=[1.0], diameters=[1.0], strains=[0.0])
