"""Rolls on a vertical curve: the polygon closes, signs, meeting lift-off, strips add up, refusals."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws import vertical_curve
from conveyor.laws.loading import curve_loads

ROUNDING = 1e-13


def test_forces_over_a_quarter_circle_turn_the_tension():
    # vector sum of the sets over 90 deg is (T, T): sets at mid-angles of 200 equal turns
    radius, turns, tension = 300.0, 200, 1e5
    spacing = radius * (math.pi / 2) / turns
    force = curve_loads.curve_set_force(tension, radius=radius, spacing=spacing)
    angles = [(i + 0.5) * math.pi / 2 / turns for i in range(turns)]
    assert force * math.fsum(math.sin(a) for a in angles) == pytest.approx(tension, rel=1e-12)


def test_gentle_curve_is_t_a_over_r_with_its_sign():
    hill = curve_loads.curve_set_force(1e5, radius=500.0, spacing=1.2)
    # sin x = x (1 - x²/6), x = 1.2e-3
    assert hill == pytest.approx(1e5 * 1.2 / 500.0, rel=1.2e-3**2 / 6 * 1.01)
    assert curve_loads.curve_set_force(1e5, radius=-500.0, spacing=1.2) == -hill
    assert curve_loads.curve_set_force(1e5, radius=math.inf, spacing=1.2) == 0


def test_lift_off_radius_takes_all_weight_off_the_rolls():
    radius = vertical_curve.lift_off_radius(6e4, belt_mass=20.0, inclination=0.1, gravity=9.81)
    force = curve_loads.curve_set_force(6e4, radius=-radius, spacing=1.0)
    relief = curve_loads.curve_belt_mass(force, spacing=1.0, inclination=0.1, gravity=9.81)
    # the polygon's sine, (a/2r)²/6
    assert 20.0 + relief == pytest.approx(0.0, abs=20.0 * (0.5 / radius) ** 2 / 6 * 1.01)


def test_a_free_ring_at_its_own_speed_presses_on_nothing():
    assert curve_loads.effective_tension(100.0 * 5.0**2, line_mass=100.0, belt_speed=5.0) == 0
    assert curve_loads.effective_tension(1e5, line_mass=100.0, belt_speed=0.0) == 1e5


def test_curve_mass_presses_like_the_curve():
    mass = curve_loads.curve_belt_mass(600.0, spacing=1.2, inclination=0.2, gravity=9.81)
    assert mass * 9.81 * math.cos(0.2) * 1.2 == pytest.approx(600.0, rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: curve_loads.curve_set_force(1.0, radius=0.4, spacing=1.0),
            r"radius: got 0\.4, .*spacing/2 = 0\.5 m",
        ),
        (lambda: curve_loads.curve_set_force(1.0, radius=math.nan, spacing=1.0), r"radius: got nan"),
        (lambda: curve_loads.curve_set_force(-1.0, radius=4.0, spacing=1.0), r"tension: got -1\.0"),
        (
            lambda: curve_loads.curve_belt_mass(math.nan, spacing=1.0, inclination=0.0, gravity=9.81),
            r"set_force: got nan",
        ),
        (lambda: curve_loads.effective_tension(1.0, line_mass=-1.0, belt_speed=1.0), r"line_mass: got -1\.0"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
