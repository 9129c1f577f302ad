"""Constants as their sources print them: DIN 22101, ISO 5048, CEMA, acceptance of rolls, one measured site."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.laws import energy, resistance, roll_life
from conveyor.laws.resistance import cema, roll_bearing

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
