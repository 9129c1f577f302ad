"""Vertical curves: equilibrium at lift-off, plane sections at the limit, centroid of the trough, refusals."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws import vertical_curve as curve
from conveyor.laws import wind

ROUNDING = 1e-13


def test_heights_are_measured_from_the_belts_own_centre():
    width, middle, angle = 1.2, 0.44, math.radians(35)
    section = curve.trough_section(width, middle_roll_length=middle, trough_angle=angle)
    # mean height of the strips by the midpoint rule, exact for straight pieces
    wing = (width - middle) / 2
    n = 1000
    heights = [(wing * (i + 0.5) / n) * math.sin(angle) for i in range(n)]
    centre = 2 * wing * sum(heights) / n / width
    assert section.middle_below == pytest.approx(centre, rel=1e-12)
    assert section.edge_above + section.middle_below == pytest.approx(wing * math.sin(angle), rel=ROUNDING)


def test_flat_belts_have_no_height_and_need_no_radius():
    for flat in (
        {"middle_roll_length": 1.2, "trough_angle": 0.5},
        {"middle_roll_length": 0.4, "trough_angle": 0.0},
    ):
        section = curve.trough_section(1.2, **flat)
        assert section == curve.TroughSection(edge_above=0.0, middle_below=0.0)
    free = {"stiffness_per_width": 72e6, "allowed_per_width": 2e5}
    assert curve.overstress_radius(1e5, distance=0.0, **free) == 0


def test_v_trough_has_its_centre_half_way_up():
    section = curve.trough_section(1.0, middle_roll_length=0.0, trough_angle=0.3)
    assert section.edge_above == pytest.approx(section.middle_below, rel=ROUNDING)


def test_at_the_lift_off_radius_the_pull_of_the_curve_is_the_weight():
    radius = curve.lift_off_radius(60e3, belt_mass=20.0, inclination=0.2, gravity=9.81)
    assert 60e3 / radius == pytest.approx(20.0 * 9.81 * math.cos(0.2), rel=ROUNDING)


def test_at_the_limiting_radii_the_strip_is_at_its_limit():
    radius = curve.overstress_radius(100e3, distance=0.13, stiffness_per_width=72e6, allowed_per_width=160e3)
    assert 100e3 + 72e6 * 0.13 / radius == pytest.approx(160e3, rel=ROUNDING)
    radius = curve.buckling_radius(100e3, distance=0.07, stiffness_per_width=72e6, least_per_width=10e3)
    assert 100e3 - 72e6 * 0.07 / radius == pytest.approx(10e3, rel=ROUNDING)


def test_the_wind_lifts_what_the_tension_leaves():
    """At the speed that lifts the belt alone no radius holds it; at half of it a quarter of the weight is gone."""
    belt = {"belt_mass": 20.0, "inclination": 0.1, "gravity": 9.81}
    speed = wind.lifting_speed(**belt, width=1.2, lift=0.5, air_density=1.25)

    def uplift(of):
        return wind.wind_force(of, height=1.2, length=1.0, drag=0.5, air_density=1.25)

    calm = curve.lift_off_radius(60e3, **belt)
    assert uplift(speed) == pytest.approx(20.0 * 9.81 * math.cos(0.1), rel=1e-14)
    assert curve.lift_off_radius(60e3, **belt, uplift=uplift(0.5 * speed)) == pytest.approx(calm / 0.75, rel=1e-14)
    assert curve.lift_off_radius(60e3, **belt, uplift=uplift(1.01 * speed)) == math.inf


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: curve.trough_section(1.0, middle_roll_length=1.1, trough_angle=0.5),
            r"middle_roll_length = 1\.1 is not allowed: 0 to the width 1\.0 m",
        ),
        (
            lambda: curve.trough_section(1.0, middle_roll_length=0.4, trough_angle=35.0),
            r"trough_angle = 35\.0",
        ),
        (
            lambda: curve.lift_off_radius(-1.0, belt_mass=20.0, inclination=0.0, gravity=9.81),
            r"tension = -1\.0",
        ),
        (
            lambda: curve.overstress_radius(2e5, distance=0.1, stiffness_per_width=72e6, allowed_per_width=2e5),
            r"allowed_per_width = 200000\.0 is not allowed: more than the mean 200000 N/m",
        ),
        (
            lambda: curve.buckling_radius(1e4, distance=0.1, stiffness_per_width=72e6, least_per_width=2e4),
            r"tension_per_width = 10000\.0 is not allowed: more than the least 20000 N/m",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
