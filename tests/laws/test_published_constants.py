"""Constants as their sources print them: DIN 22101, ISO 5048, CEMA, acceptance of rolls, one measured site."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from conveyor.laws import (
    belt_warming,
    drives,
    energy,
    idler_sets,
    power,
    preliminary_sizing,
    pulley,
    resistance,
    roll_life,
    tension,
    transfer,
    transition,
    weighing,
)
from conveyor.laws.resistance import cema, roll_bearing, service_drag
from conveyor.loop import drive_duty

# C over L [m], DIN 22101 and ISO 5048
LENGTHS = """
3 9.0   4 7.6   6 5.9   10 4.5   16 3.6   20 3.2   25 2.9   32 2.6   40 2.4   50 2.2   63 2.0   80 1.92   90 1.86
100 1.78   120 1.70   140 1.63   160 1.56   180 1.50   200 1.45   250 1.38   300 1.31   350 1.27   400 1.25   450 1.22
500 1.20   550 1.18   600 1.17   700 1.14   800 1.12   900 1.10   1000 1.09   1500 1.06   2000 1.05   2500 1.04
5000 1.03
"""

# rated powers of motors [kW], IEC 60072-1
MOTORS = """
0.37 0.55 0.75 1.1 1.5 2.2 3 4 5.5 7.5 11 15 18.5 22 30 37 45 55 75 90 110 132 160 200 250 315 355 400 450 500 560 630
710 800 900 1000
"""


def test_motors_of_the_printed_powers():
    assert pytest.approx([1e3 * float(word) for word in MOTORS.split()], rel=1e-15) == energy.MOTOR_SERIES


# rated powers of motors [hp], NFPA 70, table 430.250, up to 500 hp
HORSES = "0.5 0.75 1 1.5 2 3 5 7.5 10 15 20 25 30 40 50 60 75 100 125 150 200 250 300 350 400 450 500"


def test_nema_motors_of_the_printed_powers():
    printed = [745.69987158227 * float(word) for word in HORSES.split()]
    assert printed == pytest.approx(energy.NEMA_MOTORS[: len(printed)], rel=1e-12)


def test_large_nema_motors_go_in_whole_steps():
    """Beyond the table by 50 hp to 500, by 100 to 1000, then by 250: general knowledge of MG 1."""
    horses = np.array(energy.NEMA_MOTORS) / 745.69987158227
    large = horses[horses > 199.0]
    steps = np.where(large[1:] < 501.0, 50.0, np.where(large[1:] < 1001.0, 100.0, 250.0))
    assert np.diff(large) == pytest.approx(steps, rel=1e-9)


def test_exponents_of_rating_life():
    # ISO 281: balls 3, rollers 10/3
    assert pytest.approx((3.0, 10.0), rel=1e-15) == (roll_life.BALL_EXPONENT, 3.0 * roll_life.ROLLER_EXPONENT)


@pytest.mark.filterwarnings("ignore:length = ")
def test_length_coefficients_at_the_printed_lengths():
    printed = [float(word) for word in LENGTHS.split()]
    assert len(printed) == 2 * 35
    for length, coefficient in zip(printed[::2], printed[1::2], strict=True):
        assert resistance.length_coefficient(length) == pytest.approx(coefficient, rel=1e-12)


@pytest.mark.parametrize(
    ("default", "value", "low", "high"),
    [
        (resistance.FRICTION_FACTOR, 0.020, 0.0085, 0.030),
        (resistance.FRICTION_FACTOR_OVERLAND, 0.011, 0.0085, 0.013),
        (resistance.FRICTION_FACTOR_GOOD, 0.016, 0.016, 0.016),
        (resistance.FRICTION_FACTOR_POOR, 0.025, 0.025, 0.030),
        (resistance.FRICTION_FACTOR_DOWNHILL, 0.012, 0.012, 0.012),
        (resistance.BULK_ON_BELT_FRICTION, 0.5, 0.5, 0.5),
        (resistance.BULK_ON_SKIRT_FRICTION, 0.7, 0.7, 0.7),
        (resistance.CLEANER_FRICTION, 0.6, 0.5, 0.7),
        (resistance.CLEANER_PRESSURE, 6e4, 3e4, 1e5),
        (resistance.ROLL_ON_BELT_FRICTION, 0.35, 0.3, 0.4),
        (resistance.TILT_COEFFICIENT_30, 0.4, 0.4, 0.4),
        (resistance.TILT_COEFFICIENT_45, 0.5, 0.5, 0.5),
        (resistance.ROLL_DRAG_TO_153, 1.28, 0.0, 1.28),
        (resistance.ROLL_DRAG_TO_178, 2.45, 0.0, 2.45),
        (resistance.ROLL_DRAG_LARGER, 3.0, 0.0, 3.0),
        (resistance.FLEXURE_SHARE, 0.11, 0.0, 0.11),
        (roll_bearing.BEARING_F0, 2.0, 0.7, 2.0),
        (roll_bearing.BEARING_F1_FACTOR, 0.0009, 0.0004, 0.0009),
        (roll_bearing.BEARING_F1_EXPONENT, 0.55, 0.55, 0.55),
        (cema.IDLER_FRICTION_4_IN, 2.3, 2.3, 2.3),
        (cema.IDLER_FRICTION_5_IN, 1.8, 1.8, 1.8),
        (cema.IDLER_FRICTION_6_IN, 1.5, 1.5, 1.5),
        (cema.IDLER_FRICTION_6_IN_HEAVY, 2.8, 2.8, 2.8),
        (cema.IDLER_FRICTION_7_IN, 2.4, 2.4, 2.4),
        (cema.CLEANER_PER_INCH, 5.0, 5.0, 5.0),
        (cema.PLOUGH_PER_INCH, 5.0, 3.0, 5.0),
    ],
)
def test_a_default_and_its_range_are_the_printed_ones(default, value, low, high):
    assert (default.value, default.low, default.high) == pytest.approx((value, low, high), rel=1e-15)
    assert default.source


def test_pulleys_and_rolls_after_standstill():
    # lbf a pulley; drag after standstill over running drag
    assert pytest.approx({"tight": 200.0, "slack": 150.0, "other": 100.0}, rel=1e-15) == cema.PULLEY_FRICTION
    assert pytest.approx(1.5, rel=1e-15) == resistance.ROLL_DRAG_STANDSTILL_FACTOR


def test_figures_printed_in_other_units():
    """CEMA's feet, pounds and psi, a kilowatt-hour, the acceleration of 2000 lb an hour over 32.2 ft/s²."""
    foot, pound, psi = 0.3048, 0.45359237, 4.4482216152605 / 0.0254**2
    assert pytest.approx(20.0 * foot, rel=1e-12) == weighing.LEAST_SCALE_DISTANCE
    assert pytest.approx(40.0 * foot, rel=1e-12) == weighing.LEAST_CURVE_DISTANCE
    assert transfer.SKIRT_LEAST.value == pytest.approx(3.0 * foot, rel=1e-12)
    assert transfer.SKIRT_SECONDS.value == pytest.approx(2.0 * foot / (100.0 * foot / 60.0), rel=1e-12)
    assert pytest.approx(pound / foot**3, rel=1e-6) == preliminary_sizing.POUND_PER_CUBIC_FOOT
    assert pytest.approx(1000.0 * 3600.0, rel=1e-15) == power.JOULE_PER_KWH
    assert pytest.approx(2000.0 / (3600.0 * 60.0 * 32.2), rel=1e-4) == cema.ACCELERATION_FACTOR
    assert pytest.approx(29e6 * psi, rel=1e-12) == pulley.STEEL_MODULUS
    in_psi = {steel: tuple(each / psi for each in both) for steel, both in pulley.SHAFT_STEELS.items()}
    assert in_psi["C1018"] == pytest.approx((29e3, 32e3), rel=1e-12)
    assert in_psi["C1045"] == pytest.approx((41e3, 45e3), rel=1e-12)
    assert in_psi["C4140"] == pytest.approx((47.5e3, 60.5e3), rel=1e-12)
    assert pytest.approx({"profiled": 0.63, "sled runner": 0.77}, rel=1e-12) == pulley.KEYWAY_FACTOR


def test_additions_for_wear_are_the_middle_of_their_ranges():
    """DIN 22101: 0 to 1 mm for 5 or 6 points, 1 to 3, 3 to 6, 6 to 10, from 10 mm."""
    ranges = ((6, 0.0, 1.0), (8, 1.0, 3.0), (11, 3.0, 6.0), (13, 6.0, 10.0), (15, 10.0, 10.0))
    for (points, low, high), (most, addition) in zip(ranges, preliminary_sizing.WEAR_ADDITIONS, strict=True):
        assert most == points
        assert addition == pytest.approx(0.5e-3 * (low + high), rel=1e-12)


def test_preferred_numbers_round_their_roots():
    """ISO 3: R20 is 10^(k/20), rounded by at most 1.3 %."""
    exact = 10.0 ** (np.arange(20) / 20.0)
    assert sorted(drives._R20) == pytest.approx(exact, rel=0.013)


def test_starts_of_motors_fall_smoothly_with_their_power():
    """NEMA MG 10, table 2-3, has no slip of a digit: each row lies within 4 % of the power law through its neighbours.

    The figures are printed with two or three digits, 1.8 starts an hour to 3 %.
    """
    rated = np.log([row[0] for row in drives._STARTS])
    for poles in (1, 2, 3):
        for k in (0, 1):
            column = np.log([row[poles][k] for row in drives._STARTS])
            share = (rated[1:-1] - rated[:-2]) / (rated[2:] - rated[:-2])
            between = column[:-2] + share * (column[2:] - column[:-2])
            assert np.exp(column[1:-1] - between) == pytest.approx(1.0, abs=0.04)
            steps = np.diff(column)
            assert np.all(steps < 0.0 if k == 0 else steps > 0.0)


def test_the_film_of_a_bearing_is_fed_from_where_both_laws_of_palmgren_meet():
    """(ν n)^(2/3) at 2000 is 158.7: 160 as printed."""
    fed = roll_bearing.PALMGREN_FED * roll_bearing.PALMGREN_SWITCH ** (2.0 / 3.0)
    assert pytest.approx(fed, rel=0.01) == roll_bearing.PALMGREN_SLOW


def test_poles_are_told_apart_by_the_rated_speed():
    """Slip up to 8 % at 50 Hz, above the synchronous speed of the next poles at 60 Hz."""
    for poles, least in drive_duty._POLE_SPEEDS:
        assert 60.0 / ((poles + 2) / 2) < least < 0.92 * 50.0 / (poles / 2)


def test_heat_transfer_by_juerges():
    """5.7 + 3.8 v up to 5 m/s, 6.47 v^0.78 beyond; they differ by 8 % where they meet, as printed."""
    for speed, expected in ((2.0, 13.3), (5.0, 24.7), (10.0, 6.47 * 10.0**0.78)):
        assert belt_warming.heat_transfer(speed) == pytest.approx(expected, rel=1e-12)


def test_load_ratings_of_idlers_fall_with_trough_and_width():
    """CEMA 502: beyond the load of the class 93 % of the rating at 20 deg stand at 35 deg, 90 % at 45 deg."""
    most = {"B": 410, "C": 900, "D": 1200, "E": 1800}
    for cema_class, widths in idler_sets._RATINGS.items():
        rows = list(widths.values())
        for width, (low, middle, steep, _) in widths.items():
            if low == middle == steep:
                assert low == most[cema_class]
            elif (cema_class, width) == ("B", 36):  # 440 at 20 deg, cut to the load of the class
                assert (low, middle, steep) == (410, 410, 0.9 * 440)
            else:
                assert (middle, steep) == pytest.approx((0.93 * low, 0.9 * low), abs=1.01)
        for wide, wider in pairwise(rows):
            assert all(b <= a for a, b in zip(wide, wider, strict=True))


def test_half_troughs_have_half_the_transition():
    """All but one: 1.0 instead of 1.4 widths of steel cord below 60 % at 20 deg, as it is reproduced."""
    for angle, rows in transition.CEMA_TRANSITIONS["full trough"].items():
        half = np.array(transition.CEMA_TRANSITIONS["half trough"][angle])
        expected = 0.5 * np.array(rows)
        if angle == 20:
            expected[2, 1] = 1.0
        assert half == pytest.approx(expected, rel=1e-12)
        assert np.all(np.diff(np.array(rows), axis=0) < 0.0)


# deep-groove ball bearings: bore and outside diameter [mm] of ISO 15, static rating of makers' catalogues [kN]
BEARINGS = {
    "6201": (12, 32, 3.1), "6203": (17, 40, 4.75), "6204": (20, 47, 6.55), "6205": (25, 52, 7.8),
    "6305": (25, 62, 11.6), "6306": (30, 72, 16.0), "6308": (40, 90, 24.0),
}  # fmt: skip


def test_usual_bearings_are_those_of_the_catalogues():
    found = {
        one.name: (1e3 * one.bore, 1e3 * one.outside, 1e-3 * one.static_rating)
        for _, one in service_drag.USUAL_BEARINGS
    }
    assert found == {name: pytest.approx(row, rel=1e-12) for name, row in BEARINGS.items()}
    diameters = [most for most, _ in service_drag.USUAL_BEARINGS]
    assert diameters[:-1] == pytest.approx([0.051, 0.076, 0.108, 0.133, 0.159, 0.219], rel=1e-12)


def test_the_usual_oil_is_of_viscosity_grade_100():
    """ISO 3448: 100 mm²/s at 40 degC; viscosity index 95: 11.1 to 11.2 mm²/s at 100 degC (ISO 2909)."""
    (warm, at_40), (hot, at_100) = service_drag.USUAL_OIL
    assert (warm, hot) == pytest.approx((313.15, 373.15), rel=1e-12)
    assert at_40 == pytest.approx(100e-6, rel=1e-12)
    assert at_100 == pytest.approx(11.1e-6, rel=0.03)


def test_belts_stretch_as_their_sources_print():
    """EA over strength: about 72 for steel cord; over rated tension 400, 100 and 70 (CEMA's moduli, Newcastle)."""
    assert pytest.approx(72.0, rel=1e-12) == tension.STEEL_CORD_STIFFNESS_FACTOR
    assert pytest.approx({"EP": 5.0, "polyamide": 4.0}, rel=1e-12) == tension.TEXTILE_STIFFNESS_FACTOR
    printed = {"steel cord": 400.0, "EP": 100.0, "polyamide": 70.0}
    assert pytest.approx(printed, rel=1e-12) == tension.RATED_STIFFNESS_FACTOR
    # DIN 22101, c of the least pulley diameter over the carcass's thickness
    assert pytest.approx({"polyamide": 90.0, "EP": 108.0, "steel cord": 145.0}, rel=1e-12) == tension.PULLEY_FACTOR


def test_suggested_spacings_fall_with_width_and_density():
    """CEMA: in half feet, none wider apart on a wider belt or under a denser bulk."""
    rows = np.array([row[1:7] for row in preliminary_sizing.NORMAL_SPACINGS])
    assert np.all(np.diff(rows, axis=0) <= 0.0)
    assert np.all(np.diff(rows, axis=1) <= 0.0)
    assert 2.0 * rows == pytest.approx(np.round(2.0 * rows), abs=1e-12)
    assert rows[0, 0] == pytest.approx(5.5)
    assert rows[-1, -1] == pytest.approx(2.0)


def test_recommended_speeds_rise_with_width_and_fall_with_abrasion():
    """CEMA: up to 1000 fpm on wide belts with light bulk, never faster with a harsher one."""
    kinds = [preliminary_sizing.RECOMMENDED_SPEEDS[name] for name in ("low", "medium", "high")]
    for rows in kinds:
        assert [fastest for _, fastest in rows] == sorted(fastest for _, fastest in rows)
        assert [width for width, _ in rows] == sorted(width for width, _ in rows)
    for width in (0.4, 0.6, 0.9, 1.0, 1.4, 2.0):
        at = [next(fastest for most, fastest in rows if width <= most) for rows in kinds]
        assert at == sorted(at, reverse=True)
    assert kinds[0][-1][1] == 1000
