"""Discharge over the head pulley by hand, by its equation of motion, in its limits; impact, cleaners."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from conveyor.errors import InputError
from conveyor.laws import discharge, transfer
from conveyor.laws.discharge import (
    bulk_on_pulley,
    discharge_angle,
    free_fall,
    slipping_discharge,
    width_on_pulley,
)

G = 9.81
# ckit.co.za, troughed, trajectories, centroid: belt, edge distance, width under the bulk [mm]
EDGES = [
    (350, "42.25", "265.5"), (400, "45", "310"), (450, "47.75", "354.5"), (500, "50", "400"), (650, "50", None),
    (1200, "50", "1100"), (2100, "50", "2000"),
]  # fmt: skip


@pytest.mark.parametrize(("belt", "edge", "width"), EDGES)
def test_width_on_the_pulley_is_that_of_the_printed_table(belt, edge, width):
    found = 1e3 * width_on_pulley(belt / 1e3)
    assert found == pytest.approx(belt - 2.0 * float(edge), rel=1e-12)
    if width is not None:
        assert found == pytest.approx(float(width), abs=1e-9)


@pytest.mark.parametrize("filled", [1e-3, 0.1, 0.5, 0.999])
def test_segment_holds_the_bulk_and_its_centre_is_that_of_its_strips(filled):
    width = 1.1
    area = filled * math.pi * width**2 / 8.0
    found = bulk_on_pulley(area, width=width)
    radius = (0.25 * width**2 + found.height**2) / (2.0 * found.height)
    # substitution x = w/2 sin u keeps the quadrature smooth to the edge of a half circle
    nodes, weights = np.polynomial.legendre.leggauss(400)
    u = 0.25 * math.pi * (nodes + 1.0)
    x, dx = 0.5 * width * np.sin(u), 0.5 * width * np.cos(u) * 0.25 * math.pi * weights
    bottom = radius - found.height
    height = (radius**2 - x**2 - bottom**2) / (np.sqrt(radius**2 - x**2) + bottom)
    assert 2.0 * float(height @ dx) == pytest.approx(area, rel=2e-7)
    assert float((0.5 * height**2) @ dx) * 2.0 / area == pytest.approx(found.centroid, rel=1e-6)


@pytest.mark.parametrize("half", ["0.005", "0.019", "0.0199", "0.0201", "0.05", "1.2"])
def test_the_segment_of_a_half_angle_is_found_on_either_side_of_the_series(half):
    """Its area to fifty digits: A = (L/2)² (φ - sin φ cos φ)/sin² φ, of height L/2 tan(φ/2)."""
    with mpmath.workdps(50):
        phi = mpmath.mpf(half)
        area = float((0.55 / mpmath.sin(phi)) ** 2 * (phi - mpmath.sin(phi) * mpmath.cos(phi)))
        height = float(0.55 * mpmath.tan(phi / 2))
    # below the series' end its next term is 0.02^6/4725, above it the difference keeps 16 - 5 digits
    assert bulk_on_pulley(area, width=1.1).height == pytest.approx(height, rel=2e-11)


def test_flat_heap_has_its_centre_at_two_fifths():
    found = bulk_on_pulley(1e-5, width=1.0)  # a parabola to the first order of its slope
    assert found.centroid == pytest.approx(0.4 * found.height, rel=1e-6)


@pytest.mark.parametrize(
    ("ratio", "slope", "angle"),
    [
        (1.01, 0.0, 0.0),
        (0.5, 0.0, 60.0),
        (0.5, 12.0, 60.0),
        (1.2, 12.0, -12.0),
        (0.99, -12.0, 12.0),
        (0.9, -12.0, 25.84193),
    ],
)
def test_bulk_leaves_at_once_or_where_weight_and_speed_balance(ratio, slope, angle):
    speed = math.sqrt(ratio * G * 0.5)
    found = discharge_angle(speed, radius=0.5, inclination=math.radians(slope), gravity=G)
    assert math.degrees(found) == pytest.approx(angle, abs=1e-5)


@pytest.mark.parametrize(
    ("friction", "inclination"),
    [((0.5, 0.5), 0.0), ((0.8, 0.4), 0.0), ((0.3, 0.2), 0.0), ((0.3, 0.2), 0.3), ((0.3, 0.2), -0.35)],
)
def test_slipping_bulk_obeys_its_equation_of_motion(friction, inclination):
    """Slip begins where friction no longer holds the bulk, or at once where a belt falls more steeply than that."""
    speed, radius = 1.2, 0.55
    still, sliding = friction
    found = slipping_discharge(
        speed, radius=radius, inclination=inclination, friction=still, sliding_friction=sliding, gravity=G
    )
    begin = found.slip_angle
    held = still * (G * math.cos(begin) - speed**2 / radius)
    if inclination < 0.0:
        assert begin == pytest.approx(-inclination, rel=1e-12)
        assert G * math.sin(begin) > held
    else:
        assert G * math.sin(begin) == pytest.approx(held, rel=1e-12)

    def motion(angle, v):
        return radius * (G * np.sin(angle) - sliding * (G * np.cos(angle) - v**2 / radius)) / v

    def leaves(angle, v):
        return v[0] ** 2 / radius - G * math.cos(angle)

    leaves.terminal = True
    run = solve_ivp(motion, (begin, math.pi / 2), [speed], events=leaves, rtol=1e-10, atol=1e-12)
    assert found.angle == pytest.approx(run.t_events[0][0], rel=1e-8)
    assert found.speed == pytest.approx(run.y_events[0][0][0], rel=1e-8)


def test_without_slip_both_methods_agree_and_with_it_bulk_leaves_earlier():
    of = {"radius": 0.5, "inclination": 0.05, "gravity": G}
    plain = discharge_angle(1.2, **of)
    rough = slipping_discharge(1.2, friction=1e4, sliding_friction=1e4, **of)
    smooth = slipping_discharge(1.2, friction=0.5, sliding_friction=0.4, **of)
    # with friction of 1e4 the last slip is of its inverse
    assert rough.angle == pytest.approx(plain, abs=2e-4)
    assert smooth.angle < plain
    assert smooth.speed > 1.2
    fast = slipping_discharge(4.0, friction=0.5, sliding_friction=0.5, **of)
    assert (fast.angle, fast.slip_angle, fast.speed) == (-0.05, -0.05, 4.0)


def test_fall_keeps_its_energy_and_its_forward_speed():
    path = free_fall(0.4, speed=2.0, radius=0.6, drop=3.0, gravity=G)
    assert float(path.up[-1]) == pytest.approx(-3.0, rel=1e-12)
    energy = 0.5 * path.speed**2 + G * path.up
    assert np.ptp(energy) < 1e-12 * energy[0] * path.time.size
    assert path.speed * np.cos(path.steepness) == pytest.approx(2.0 * math.cos(0.4), rel=1e-12)
    above, below = path.beside(0.1), path.beside(-0.05)
    assert np.hypot(above[0] - below[0], above[1] - below[1]) == pytest.approx(0.15, rel=1e-12)
    along = (above[0] - path.across) * np.cos(path.steepness) - (above[1] - path.up) * np.sin(path.steepness)
    assert np.max(np.abs(along)) < 1e-14


def test_a_lump_on_a_rising_belt_flies_clear_from_the_inverse_cosine_on():
    slope, radius = math.radians(18.0), 0.6
    for over, clear in ((1.02, True), (0.98, False)):
        speed = math.sqrt(over / math.cos(slope) * G * radius)
        path = free_fall(-slope, speed=speed, radius=radius, drop=0.0, gravity=G)
        assert (np.hypot(path.across, path.up)[1:] >= radius).all() == clear


def test_impact_of_the_stream_is_the_rule_of_the_catalogue():
    # Rulmeca: t/h times the root of the height [m] over 8, in kgf; one printed digit
    got = transfer.stream_impact(1600.0 / 3.6, drop_height=2.0, gravity=G) / G
    assert got == pytest.approx(1600.0 * math.sqrt(2.0) / 8.0, rel=0.5 / 8.0)


def test_impact_of_a_lump_gives_its_energy_to_the_spring():
    mass, drop, stiffness = 35.0, 1.4, 3e5
    force = transfer.lump_impact(mass, drop_height=drop, stiffness=stiffness, gravity=G)
    way = force / stiffness
    assert 0.5 * stiffness * way**2 == pytest.approx(mass * G * (drop + way), rel=1e-12)
    laid = transfer.lump_impact(mass, drop_height=0.0, stiffness=stiffness, gravity=G)
    assert laid == pytest.approx(2.0 * mass * G, rel=1e-12)


def test_cleaners_in_a_row_leave_the_product():
    one = transfer.carryback(0.4, efficiency=0.7, count=1)
    assert transfer.carryback(one, efficiency=0.7, count=2) == pytest.approx(
        transfer.carryback(0.4, efficiency=0.7, count=3), rel=1e-14
    )
    assert transfer.carryback(0.4, efficiency=0.7, count=0) == 0.4


@pytest.mark.parametrize(
    ("law", "named"),
    [
        (lambda: width_on_pulley(0.04), "belt_width"),
        (lambda: bulk_on_pulley(0.5, width=1.0), "area"),
        (lambda: discharge_angle(0.0, radius=0.5, inclination=0.0, gravity=G), "speed"),
        (lambda: slipping_discharge(1.0, radius=0.5, inclination=0.0, friction=0.4, sliding_friction=0.5, gravity=G),
         "sliding_friction"),
        (lambda: free_fall(1.6, speed=1.0, radius=0.5, drop=1.0, gravity=G), "angle"),
        (lambda: transfer.lump_impact(1.0, drop_height=-1.0, stiffness=1.0, gravity=G), "drop_height"),
        (lambda: transfer.carryback(1.0, efficiency=1.1, count=1), "efficiency"),
        (lambda: transfer.impact_class(-1.0), "energy"),
    ],
)  # fmt: skip
def test_arguments_out_of_range_are_named(law, named):
    with pytest.raises(InputError, match=named):
        law()


def test_beds_by_the_energy_of_the_lump():
    names = ("light", "medium", "heavy", "beyond heavy")
    for most, name, heavier in zip((200.0, 1000.0, 2000.0), names[:-1], names[1:], strict=True):
        border = most * 4.4482216152605 * 0.3048  # lbf ft in J
        assert transfer.impact_class(0.999 * border) == name
        assert transfer.impact_class(1.001 * border) == heavier
    assert discharge.TIME_STEP == 0.05
