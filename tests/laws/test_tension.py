"""Tensions: Eytelwein at its limit, sag against the catenary, what governs, refusals."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws import tension

ROUNDING = 1e-14


def test_drive_on_the_grip_limit_has_eytelweins_ratio():
    drive = tension.drive_tensions(1e4, friction=0.35, wrap_angle=3.5)
    assert drive.governed_by == "grip"
    assert drive.tight / drive.slack == pytest.approx(math.exp(0.35 * 3.5), rel=ROUNDING)
    assert drive.tight - drive.slack == pytest.approx(1e4, rel=ROUNDING)


def test_weak_grip_needs_the_force_over_mu_alpha():
    # e^x - 1 → x: no digits may be lost
    tiny = tension.grip_tension(1.0, friction=1e-9, wrap_angle=1.0)
    assert tiny == pytest.approx(1e9, rel=1e-9)


def test_start_factor_scales_both_tensions_while_grip_governs():
    steady = tension.drive_tensions(1e4, friction=0.3, wrap_angle=math.pi)
    start = tension.drive_tensions(1e4, friction=0.3, wrap_angle=math.pi, start_factor=1.4)
    assert start.slack == pytest.approx(1.4 * steady.slack, rel=ROUNDING)
    assert start.tight == pytest.approx(1.4 * steady.tight, rel=ROUNDING)


def test_sag_governs_when_it_asks_for_more():
    drive = tension.drive_tensions(1e4, friction=0.3, wrap_angle=math.pi, slack_for_sag=3e4)
    assert (drive.tight, drive.slack) == pytest.approx((4e4, 3e4), rel=ROUNDING)
    assert drive.governed_by == "sag"


def test_belt_that_drives_the_motor_needs_the_same_grip():
    down = tension.drive_tensions(-1e4, friction=0.3, wrap_angle=math.pi)
    up = tension.drive_tensions(1e4, friction=0.3, wrap_angle=math.pi)
    assert (down.tight, down.slack) == pytest.approx((up.tight, up.slack), rel=ROUNDING)
    assert down.governed_by == up.governed_by


def test_largest_grip_is_still_a_number():
    least = tension.grip_tension(1e4, friction=2.0, wrap_angle=8 * math.pi)
    assert least == pytest.approx(1e4 * math.exp(-16 * math.pi), rel=1e-12)


def test_idle_drive_needs_no_grip():
    assert tension.grip_tension(0.0, friction=0.3, wrap_angle=math.pi) == 0


def test_sag_tension_is_the_flat_limit_of_the_catenary():
    mass, span, sag = 150.0, 1.2, 1e-3
    pull = tension.sag_tension(mass, spacing=span, relative_sag=sag, gravity=9.81)
    length = pull / (mass * 9.81)
    catenary = length * (math.cosh(span / (2 * length)) - 1) / span
    # next term of cosh: relative (4/3) (h/a)²
    assert catenary == pytest.approx(sag, rel=1.4 * sag**2)
    assert catenary != pytest.approx(sag, rel=1e-7)


def test_governing_tension_names_the_condition():
    assert tension.governing_tension({"grip": 5.0, "sag carry": 9.0, "sag return": 7.0}) == ("sag carry", 9.0)
    assert tension.governing_tension({"grip": 5.0, "sag": 5.0}) == ("grip", 5.0)


@pytest.mark.parametrize(("carcass", "diameter"), [("polyamide", 0.45), ("EP", 0.54), ("steel cord", 0.725)])
def test_pulley_diameter_of_a_five_mm_carcass(carcass, diameter):
    assert tension.least_pulley_diameter(0.005, carcass=carcass) == pytest.approx(diameter, rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: tension.grip_tension(1.0, friction=0.3, wrap_angle=180.0),
            r"wrap_angle = 180\.0 is not allowed: .* 8 pi rad",
        ),
        (
            lambda: tension.grip_tension(1.0, friction=2.1, wrap_angle=3.0),
            r"friction = 2\.1 is not allowed: .* at most 2",
        ),
        (lambda: tension.steel_cord_stiffness(math.inf), r"nominal_strength = inf"),
        (
            lambda: tension.drive_tensions(1.0, friction=0.3, wrap_angle=3.0, start_factor=math.inf),
            r"start_factor = inf",
        ),
        (
            lambda: tension.grip_tension(1.0, friction=0.0, wrap_angle=3.0),
            r"friction = 0\.0 is not allowed: above 0",
        ),
        (lambda: tension.grip_tension(math.nan, friction=0.3, wrap_angle=3.0), r"drive_force = nan"),
        (
            lambda: tension.sag_tension(10.0, spacing=1.0, relative_sag=0.0, gravity=9.81),
            r"relative_sag = 0\.0 is not allowed: a finite number greater than 0",
        ),
        (
            lambda: tension.drive_tensions(1.0, friction=0.3, wrap_angle=3.0, start_factor=0.9),
            r"start_factor = 0\.9 is not allowed: at least 1",
        ),
        (
            lambda: tension.drive_tensions(1.0, friction=0.3, wrap_angle=3.0, slack_for_sag=-1.0),
            r"sag = -1\.0 is not allowed",
        ),
        (lambda: tension.governing_tension({}), r"minima = \{\} is not allowed: at least one condition"),
        (
            lambda: tension.least_pulley_diameter(0.005, carcass="cotton"),
            r"carcass = 'cotton' is not allowed: one of polyamide, EP, steel cord",
        ),
        (lambda: tension.least_pulley_diameter(0.0, carcass="EP"), r"carcass_thickness = 0\.0"),
        (lambda: tension.steel_cord_stiffness(0.0), r"nominal_strength = 0\.0"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_one_condition_governs_alone():
    assert tension.governing_tension({"grip": 8448.0}) == ("grip", 8448.0)
