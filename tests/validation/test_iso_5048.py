"""ISO 5048's itemised worked example and its neighbours, each figure to half a unit of its last digit.

Coal 0.85 t/m³, 2300 t/h, 4.8 m/s, 143 m level, belt 1.2 m. No rounded intermediate is needed: every figure
follows from the data in full precision. The source's g is 9.81 m/s². The sag figures 0.01 and 0.02 are
relative sags (h/a): read as metres they give 26406 N instead of the printed 22005 N. The two exact wraps of the second
pass, 153 and 141 N, are data: the source gives no pulley diameter for them.
"""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from conveyor.laws import loading, power, resistance, tension

G = 9.81


def printed(text: str) -> object:
    """Return the figure with half a unit of its last digit as the tolerance."""
    decimals = len(text.partition(".")[2])
    return pytest.approx(float(text), rel=0, abs=0.5 * 10.0**-decimals)


def _forces(wraps: float) -> SimpleNamespace:
    flow, speed, density = 2300 / 3.6, 4.8, 850.0
    bulk = loading.bulk_line_mass(flow, belt_speed=speed)
    carry = resistance.roll_line_mass(15.5, spacing=1.2)
    back = resistance.roll_line_mass(13.2, spacing=3.0)
    main = resistance.main_resistance(
        friction_factor=resistance.FRICTION_FACTOR.value,
        length=143.0,
        carry_roll_mass=carry,
        return_roll_mass=back,
        belt_mass=16.44,
        bulk_mass=bulk,
        inclination=0.0,
        gravity=G,
    )
    acceleration = resistance.acceleration_resistance(flow, belt_speed=speed, initial_speed=0.0)
    skirt = {
        "volume_flow": flow / density,
        "bulk_density": density,
        "skirt_distance": 0.75,
        "skirt_friction": resistance.BULK_ON_SKIRT_FRICTION.value,
        "gravity": G,
    }
    zone = resistance.acceleration_length(
        belt_speed=speed,
        initial_speed=0.0,
        belt_friction=resistance.BULK_ON_BELT_FRICTION.value,
        gravity=G,
    )
    zone_skirt = resistance.acceleration_skirt_resistance(**skirt, length=zone, belt_speed=speed, initial_speed=0.0)
    skirts = resistance.skirt_resistance(**skirt, length=4.8, bulk_speed=speed)
    cleaners = resistance.cleaner_resistance(
        4 * 1.2 * 0.008,
        pressure=resistance.CLEANER_PRESSURE.low,
        friction=resistance.CLEANER_FRICTION.value,
    )
    secondary = acceleration + zone_skirt + wraps
    special = skirts + cleaners
    total = main + secondary + special
    return SimpleNamespace(**{name: value for name, value in locals().items() if isinstance(value, float)})


FIRST = _forces(wraps=2 * 360.0)
SECOND = _forces(wraps=153.0 + 141.0)


def _motor(total: float) -> float:
    return power.motor_power(power.belt_power(total, belt_speed=4.8), efficiency=0.95 * 0.97) / 1e3


def _drive() -> tension.DriveSideTensions:
    return tension.drive_tensions(FIRST.total, friction=0.3, wrap_angle=math.pi)


@pytest.mark.parametrize(
    ("name", "figure"),
    [
        ("bulk", "133.10"),
        ("carry", "12.92"),
        ("back", "4.40"),
        ("main", "5142.73"),
        ("acceleration", "3066.67"),
        ("zone_skirt", "2390.38"),
        ("secondary", "6177.05"),
        ("skirts", "1221.34"),
        ("cleaners", "691.2"),
        ("special", "1912.54"),
        ("total", "13232.32"),
    ],
)
def test_first_pass(name, figure):
    assert getattr(FIRST, name) == printed(figure)


def test_first_pass_motor_power():
    assert _motor(FIRST.total) == printed("68.93")


def test_grip_tension_of_the_tight_side():
    assert _drive().tight == printed("21680.28")


def test_grip_tension_of_the_slack_side():
    assert _drive().slack == printed("8447.96")


def test_sag_tension_of_the_carry_strand():
    line_mass = 16.44 + FIRST.bulk
    assert tension.sag_tension(line_mass, spacing=1.2, relative_sag=0.01, gravity=G) == printed("22005")


def test_sag_tension_of_the_return_strand():
    assert tension.sag_tension(16.44, spacing=3.0, relative_sag=0.02, gravity=G) == printed("3024")


def test_sag_of_the_carry_strand_governs():
    drive = tension.drive_tensions(FIRST.total, friction=0.3, wrap_angle=math.pi, slack_for_sag=22005.0)
    assert drive.governed_by == "sag"


@pytest.mark.parametrize(("name", "figure"), [("secondary", "5751"), ("total", "12806")])
def test_second_pass_with_exact_wraps(name, figure):
    assert getattr(SECOND, name) == printed(figure)


def test_second_pass_motor_power():
    assert _motor(SECOND.total) == printed("66.71")


def test_empirical_level_power():
    watts = power.empirical_level_power(
        1000 / 3.6,
        belt_speed=1.68,
        width_coefficient=277.0,
        length_coefficient=52.0,
        friction_coefficient=1.0,
    )
    assert watts / 1e3 == printed("28.18")


def test_empirical_lift_power():
    assert power.empirical_lift_power(1000 / 3.6, lift=17.9) / 1e3 == printed("48.77")


def _section() -> loading.CrossSection:
    return loading.cross_section(
        loading.usable_width(1.2),
        middle_roll_length=0.436,
        trough_angle=math.radians(45),
        surcharge_angle=math.radians(20),
    )


def test_usable_width():
    assert loading.usable_width(1.2) == printed("1.03")


def test_cross_section_above_the_water_line():
    assert _section().top == printed("0.0445")


def test_cross_section_below_the_water_line():
    assert _section().bottom == printed("0.1357")


@pytest.mark.parametrize(("degrees", "figure"), [(30, "0.65"), (35, "0.675"), (45, "0.725")])
def test_middle_roll_share_of_vdi_2341(degrees, figure):
    # the figures are exact decimals: only the conversion to radians and back rounds
    share = loading.middle_share_bulk(math.radians(degrees))
    assert share == pytest.approx(float(figure), rel=1e-14)


# fmt: off
C_TABLE = (
    (3, 9.0), (4, 7.6), (6, 5.9), (10, 4.5), (16, 3.6), (20, 3.2), (25, 2.9), (32, 2.6), (40, 2.4),
    (50, 2.2), (63, 2.0), (80, 1.92), (90, 1.86), (100, 1.78), (120, 1.70), (140, 1.63), (160, 1.56),
    (180, 1.50), (200, 1.45), (250, 1.38), (300, 1.31), (350, 1.27), (400, 1.25), (450, 1.22), (500, 1.20),
    (550, 1.18), (600, 1.17), (700, 1.14), (800, 1.12), (900, 1.10), (1000, 1.09), (1500, 1.06),
    (2000, 1.05), (2500, 1.04), (5000, 1.03),
)
# fmt: on


@pytest.mark.parametrize(("length", "coefficient"), C_TABLE)
def test_length_coefficient_at_the_nodes(length, coefficient):
    assert resistance.length_coefficient(float(length)) == coefficient
