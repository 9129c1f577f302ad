"""Roll drag: Walther's printed example, Palmgren's regimes and scaling, Petroff by dissipation, the makers' line."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError, ValidityWarning
from conveyor.laws.resistance import rim_drag as drag
from conveyor.laws.resistance import roll_bearing as bearing

ROUNDING = 1e-13  # a handful of products, two powers

# A calculator after ASTM D341 prints A = 9.5259, B = 3.7449, 8.5 mm²/s at 353 K for this oil
OIL = {
    "first_temperature": 313.0,
    "first_viscosity": 32e-6,
    "second_temperature": 373.0,
    "second_viscosity": 5.4e-6,
}
ROLL = {
    "belt_speed": 5.0,
    "roll_diameter": 0.159,
    "mean_diameter": 0.051,
    "viscosity": 100e-6,
    "static_rating": 16e3,
    "f0": 2.0,
    "f1_factor": 0.0009,
    "f1_exponent": 0.55,
    "seal_moment": 0.01,
}


def test_walther_meets_the_printed_line():
    # the printed constants carry 5 digits; dA = 5e-5 moves ν by ln10 · log10(ν+0.7) · ln10 · 1e-4, below 3e-3
    for temperature in (290.0, 313.0, 340.0, 353.0, 373.0):
        printed = 10**10 ** (9.5259 - 3.7449 * math.log10(temperature)) - 0.7
        assert bearing.oil_viscosity(temperature, **OIL) * 1e6 == pytest.approx(printed, rel=3e-3)
    assert bearing.oil_viscosity(353.0, **OIL) * 1e6 == pytest.approx(8.5, abs=0.05)


def test_walther_goes_through_both_points_in_either_order():
    turned = {
        "first_temperature": 373.0,
        "first_viscosity": 5.4e-6,
        "second_temperature": 313.0,
        "second_viscosity": 32e-6,
    }
    for oil in (OIL, turned):
        assert bearing.oil_viscosity(313.0, **oil) == pytest.approx(32e-6, rel=1e-12)
        assert bearing.oil_viscosity(373.0, **oil) == pytest.approx(5.4e-6, rel=1e-12)


def test_hot_oil_is_warned_about():
    with pytest.warns(ValidityWarning, match=r"mm²/s at 450 K: ASTM D341's short form holds from 2 mm²/s"):
        assert bearing.oil_viscosity(450.0, **OIL) < 2e-6


def test_no_load_moment_by_hand_and_its_two_regimes():
    # ν n = 100 · 600 = 60000: 2e-7 · 60000^(2/3) · 50³ N mm
    fed = bearing.bearing_no_load_moment(2.0, viscosity=100e-6, rotation=10.0, mean_diameter=0.05)
    assert fed == pytest.approx(2e-7 * 60000 ** (2 / 3) * 50**3 * 1e-3, rel=ROUNDING)
    more = bearing.bearing_no_load_moment(2.0, viscosity=800e-6, rotation=10.0, mean_diameter=0.05)
    assert more == pytest.approx(4 * fed, rel=ROUNDING)
    slow = bearing.bearing_no_load_moment(2.0, viscosity=100e-6, rotation=0.1, mean_diameter=0.05)
    assert slow == pytest.approx(160e-7 * 2 * 50**3 * 1e-3, rel=ROUNDING)
    still = bearing.bearing_no_load_moment(2.0, viscosity=100e-6, rotation=0.0, mean_diameter=0.05)
    assert slow == pytest.approx(still, rel=ROUNDING)


def test_regimes_meet_within_the_known_step():
    # 160/2000^(2/3) = 1.00794
    low, high = (
        bearing.bearing_no_load_moment(1.0, viscosity=100e-6, rotation=n / 60, mean_diameter=0.05)
        for n in (19.999, 20.001)
    )
    assert low / high == pytest.approx(160 / 2000 ** (2 / 3), rel=1e-4)


def test_load_moment_is_a_coefficient_of_friction():
    f1 = bearing.bearing_load_factor(4000.0, static_rating=16e3, factor=0.0009, exponent=0.5)
    assert f1 == pytest.approx(0.00045, rel=ROUNDING)
    moment = bearing.bearing_load_moment(f1, load=4000.0, mean_diameter=0.05)
    assert moment == pytest.approx(0.09, rel=ROUNDING)
    assert bearing.bearing_load_factor(0.0, static_rating=16e3, factor=0.0009, exponent=0.55) == 0


def test_labyrinth_moment_times_speed_is_the_heat_of_the_gap():
    n, r, b, c, eta = 10.0, 0.03, 0.01, 0.001, 0.5
    moment = bearing.labyrinth_moment(eta, rotation=n, radius=r, length=b, gap=c)
    omega = 2 * math.pi * n
    heat = eta * (omega * r / c) ** 2 * (2 * math.pi * r * b * c)  # η γ̇² × volume
    assert moment * omega == pytest.approx(heat, rel=ROUNDING)


def test_roll_drag_is_the_power_of_both_ends():
    parts = drag.bearing_roll_drag(1000.0, **ROLL)
    n = drag.roll_rotation(5.0, roll_diameter=0.159)
    m0 = bearing.bearing_no_load_moment(2.0, viscosity=100e-6, rotation=n, mean_diameter=0.051)
    f1 = bearing.bearing_load_factor(500.0, static_rating=16e3, factor=0.0009, exponent=0.55)
    m1 = bearing.bearing_load_moment(f1, load=500.0, mean_diameter=0.051)
    power = 2 * (m0 + m1 + 0.01) * 2 * math.pi * n
    assert parts.force * 5.0 == pytest.approx(power, rel=ROUNDING)


def test_each_cause_is_alone_when_the_others_are_off():
    assert drag.bearing_roll_drag(0.0, **ROLL).load == 0
    bare = drag.bearing_roll_drag(1000.0, **ROLL | {"f0": 0.0, "seal_moment": 0.0})
    assert bare.force == bare.load > 0
    heavier = drag.bearing_roll_drag(2000.0, **ROLL | {"f0": 0.0, "seal_moment": 0.0})
    assert heavier.load == pytest.approx(2**1.55 * bare.load, rel=ROUNDING)


def test_cold_drags_more():
    oil = {"first_temperature": 313.15, "first_viscosity": 100e-6}
    oil |= {"second_temperature": 373.15, "second_viscosity": 11e-6}
    forces = [
        drag.bearing_roll_drag(250.0, **ROLL | {"viscosity": bearing.oil_viscosity(t, **oil)}).no_load
        for t in (253.15, 273.15, 293.15, 313.15)
    ]
    assert forces == sorted(forces, reverse=True)


def test_a_usual_roll_is_within_the_acceptance_limit():
    # bearings 6306 (30/72 mm, C0 16 kN) at 650 rpm under 250 N, labyrinth of 10 N mm: below 3.0 N
    usual = ROLL | {"belt_speed": 650 / 60 * math.pi * 0.159}
    assert 0.5 < drag.bearing_roll_drag(250.0, **usual).force < 3.0


def test_makers_line_goes_through_the_measurement():
    line = {"load_slope": 5e-4, "rotation_slope": 0.02}
    measured = drag.linear_roll_drag(1.9, load=250.0, rotation=650 / 60, **line)
    assert measured == pytest.approx(1.9, rel=ROUNDING)
    away = drag.linear_roll_drag(1.9, load=1250.0, rotation=650 / 60 + 5, **line)
    assert away == pytest.approx(1.9 + 0.5 + 0.1, rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: bearing.oil_viscosity(300.0, **OIL | {"second_viscosity": 40e-6}),
            r"second_viscosity = 4e-05 is not allowed: the hotter of the two must be the thinner",
        ),
        (
            lambda: bearing.oil_viscosity(300.0, **OIL | {"second_temperature": 313.0}),
            r"second_viscosity = .* the hotter",
        ),
        (
            lambda: bearing.oil_viscosity(300.0, **OIL | {"first_viscosity": 32.0e-8}),
            r"first_viscosity = 3\.2e-07 is not allowed: at least 2e-06 m²/s",
        ),
        (lambda: bearing.oil_viscosity(100.0, **OIL), r"temperature = 100\.0 .* the oil is solid there"),
        (lambda: bearing.oil_viscosity(-5.0, **OIL), r"temperature = -5\.0"),
        (lambda: drag.roll_rotation(1.0, roll_diameter=0.0), r"roll_diameter = 0\.0"),
        (
            lambda: bearing.bearing_no_load_moment(-1.0, viscosity=1e-4, rotation=1.0, mean_diameter=0.05),
            r"f0 = -1\.0",
        ),
        (
            lambda: bearing.bearing_load_factor(1.0, static_rating=0.0, factor=1e-3, exponent=0.5),
            r"static_rating = 0\.0",
        ),
        (lambda: bearing.bearing_load_moment(1e-3, load=-1.0, mean_diameter=0.05), r"load = -1\.0"),
        (
            lambda: bearing.labyrinth_moment(0.5, rotation=1.0, radius=0.03, length=0.01, gap=0.004),
            r"gap = 0\.004 is not allowed: above 0 and at most a tenth of radius = 0\.03 m",
        ),
        (
            lambda: drag.bearing_roll_drag(1.0, **ROLL | {"mean_diameter": 0.2}),
            r"mean_diameter = 0\.2 is not allowed: above 0 and less than D",
        ),
        (
            lambda: drag.linear_roll_drag(0.1, load=0.0, rotation=1.0, load_slope=1e-3, rotation_slope=0.0),
            r"reference_drag = 0\.1 is not allowed: its line gives -0\.15 N at 0 N and 1 1/s",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
