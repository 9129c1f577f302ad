"""Loads on rolls: conservation, shares, the load along a roll, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laws import loading

ULPS = 8 * np.finfo(float).eps  # a handful of products and sums

SET = {
    "bulk_line_mass": 133.1,
    "belt_line_mass": 16.44,
    "spacing": 1.2,
    "n_rolls": 3,
    "trough_angle": math.radians(35),
    "roll_length": 0.465,
    "belt_width": 1.2,
    "inclination": 0.1,
    "gravity": 9.81,
}
FIVE = {"n_rolls": 5, "roll_length": 0.25, "bulk_shares": (0.05, 0.2, 0.5, 0.2, 0.05)}


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"n_rolls": 1, "roll_length": 1.4},
        {"n_rolls": 2, "roll_length": 0.7},
        FIVE,
        {"bulk_line_mass": 0.0},
    ],
)
def test_forces_add_up_to_the_weight_normal_to_the_belt(change):
    scene = SET | change
    loads = loading.roll_loads(**scene)
    weight = (scene["bulk_line_mass"] + 16.44) * 9.81 * math.cos(0.1) * 1.2
    assert len(loads) == scene["n_rolls"]
    assert math.fsum(r.force for r in loads) == pytest.approx(weight, rel=ULPS, abs=0)


@pytest.mark.parametrize("n", [1, 2, 3, 8, 31])
@pytest.mark.parametrize("change", [{}, {"n_rolls": 1, "roll_length": 1.4}, {"n_rolls": 2}, FIVE])
def test_line_load_integrates_to_the_force(n, change):
    for roll in loading.roll_loads(**SET | change):
        w, weights = roll.line_loads(n)
        assert w.shape == weights.shape == (n,)
        assert float(w @ weights) == pytest.approx(roll.force, rel=4 * ULPS, abs=0)
        assert float(weights.sum()) == pytest.approx(roll.length, rel=4 * ULPS, abs=0)
        assert np.all(w > 0)


def test_wing_load_falls_linearly_to_the_belts_own_weight_at_the_edge():
    wing = loading.roll_loads(**SET)[0]
    w, weights = wing.line_loads(2)
    node = (1 - 1 / math.sqrt(3)) / 2  # Gauss point over the length, from the junction
    belt = wing.belt_force / wing.length
    peak = 2 * wing.bulk_force / wing.length
    assert w == pytest.approx([belt + peak * (1 - node), belt + peak * node], rel=4 * ULPS)
    assert wing.peak_line_load == pytest.approx(belt + peak, rel=ULPS)
    # first moment of a triangle: a third of its length
    moment = float((w - belt) @ (weights * np.array([node, 1 - node]) * wing.length))
    assert moment == pytest.approx(wing.bulk_force * wing.length / 3, rel=4 * ULPS)


def test_middle_roll_is_uniform_and_empty_belt_is_uniform_everywhere():
    middle = loading.roll_loads(**SET)[1]
    assert np.ptp(middle.line_loads(5)[0]) == 0
    assert middle.peak_line_load == pytest.approx(middle.force / 0.465, rel=ULPS)
    for roll in loading.roll_loads(**SET | {"bulk_line_mass": 0.0}):
        assert np.ptp(roll.line_loads(5)[0]) == 0


def test_shares_are_of_the_normal_load_without_a_further_cosine():
    left, middle, right = loading.roll_loads(**SET)
    pull = 9.81 * math.cos(0.1) * 1.2
    assert middle.bulk_force == pytest.approx(0.675 * 133.1 * pull, rel=ULPS)
    assert middle.belt_force == pytest.approx(0.485 / 1.2 * 16.44 * pull, rel=ULPS)
    assert (left.force, left.length) == pytest.approx((right.force, right.length), rel=ULPS)
    assert left.bulk_force == pytest.approx(0.1625 * 133.1 * pull, rel=ULPS)


def test_given_shares_replace_the_rule():
    loads = loading.roll_loads(**SET | {"bulk_shares": (0.125, 0.75, 0.125), "belt_shares": (0.3, 0.4, 0.3)})
    assert [r.bulk_force / loads[1].bulk_force for r in loads] == pytest.approx([1 / 6, 1, 1 / 6], rel=ULPS)
    assert [r.belt_force / loads[1].belt_force for r in loads] == pytest.approx([0.75, 1, 0.75], rel=ULPS)


def test_names_and_shapes_of_each_set():
    five = loading.roll_loads(**SET | FIVE)
    assert [r.shape for r in five] == ["triangular", "uniform", "uniform", "uniform", "triangular"]
    assert [r.length for r in five] == pytest.approx([0.225, 0.25, 0.25, 0.25, 0.225], rel=ULPS)
    assert [r.belt_force / five[2].belt_force for r in five] == pytest.approx([0.9, 1, 1, 1, 0.9], rel=ULPS)
    (flat,) = loading.roll_loads(**SET | {"n_rolls": 1, "roll_length": 1.4})
    assert (flat.name, flat.shape, flat.length) == ("flat", "uniform", 1.2)
    two = loading.roll_loads(**SET | {"n_rolls": 2, "roll_length": 0.7})
    assert [(r.name, r.shape, r.length) for r in two] == [
        ("left", "triangular", 0.6),
        ("right", "triangular", 0.6),
    ]


def test_loaded_length_ends_at_the_roll_end_or_the_belt_edge():
    assert loading.roll_loads(**SET)[0].length == pytest.approx((1.2 - 0.465) / 2, rel=ULPS)
    assert loading.roll_loads(**SET | {"roll_length": 0.38})[0].length == 0.38


def test_load_is_proportional_to_spacing_and_gravity():
    base = loading.roll_loads(**SET)
    far = loading.roll_loads(**SET | {"spacing": 2.4})
    moon = loading.roll_loads(**SET | {"gravity": 9.81 / 4})
    assert [r.force for r in far] == pytest.approx([2 * r.force for r in base], rel=ULPS)
    assert [r.force for r in moon] == pytest.approx([r.force / 4 for r in base], rel=ULPS)


def test_uphill_and_downhill_load_alike():
    up, down = loading.roll_loads(**SET), loading.roll_loads(**SET | {"inclination": -0.1})
    for one, other in zip(up, down, strict=True):
        assert (one.bulk_force, one.belt_force) == pytest.approx((other.bulk_force, other.belt_force), rel=ULPS)


def test_cross_section_of_two_rolls_is_a_triangle_below_and_of_a_flat_belt_nothing():
    slope = math.radians(20)
    two = loading.cross_section(1.0, middle_roll_length=0.0, trough_angle=0.5, surcharge_angle=slope)
    half = 0.5
    assert two.bottom == pytest.approx(half * math.cos(0.5) * half * math.sin(0.5), rel=ULPS)
    flat = loading.cross_section(1.0, middle_roll_length=0.4, trough_angle=0.0, surcharge_angle=slope)
    assert flat.bottom == 0
    # parabola of width b and edge slope tan β: area b² tan β/6
    assert flat.top == pytest.approx(math.tan(slope) / 6, rel=ULPS)
    assert flat.area == pytest.approx(flat.top + flat.bottom, rel=ULPS)


def test_cross_section_below_the_water_line_is_the_trapezium_of_its_corners():
    middle, b, lam = 0.436, 1.03, math.radians(45)
    wing = (b - middle) / 2
    x = np.array([-middle / 2, middle / 2, middle / 2 + wing * math.cos(lam), -middle / 2 - wing * math.cos(lam)])
    y = np.array([0, 0, wing * math.sin(lam), wing * math.sin(lam)])
    shoelace = 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))
    section = loading.cross_section(b, middle_roll_length=middle, trough_angle=lam, surcharge_angle=0.0)
    assert section.bottom == pytest.approx(shoelace, rel=ULPS)
    assert section.top == 0
    assert loading.CrossSection(top=1.0, bottom=2.0).area == 3.0


def test_whole_load_on_one_roll_and_the_edge_of_each_range_are_allowed():
    loads = loading.roll_loads(**SET | {"bulk_shares": (0.0, 1.0, 0.0), "inclination": 0.0})
    assert [r.bulk_force for r in loads] == pytest.approx([0.0, 133.1 * 9.81 * 1.2, 0.0], rel=ULPS)
    assert loading.middle_share_bulk(0.0) == pytest.approx(0.5, rel=ULPS)
    assert loading.middle_share_bulk(math.pi / 3) == pytest.approx(0.8, rel=ULPS)
    assert loading.middle_share_belt(1.0, belt_width=1.02) == 1.0


def test_a_heap_on_a_slope_wanes_to_nothing():
    """On the level all of it, of δ = θ nothing; up and down alike."""
    theta = math.radians(20.0)
    assert loading.heap_on_slope(0.0, surcharge_angle=theta) == 1.0
    assert loading.heap_on_slope(theta, surcharge_angle=theta) == 0.0
    assert loading.heap_on_slope(0.1, surcharge_angle=0.0) == 0.0
    up, down = (loading.heap_on_slope(side * 0.2, surcharge_angle=theta) for side in (1.0, -1.0))
    cos = math.cos
    by_hand = math.sqrt((cos(0.2) ** 2 - cos(theta) ** 2) / (1.0 - cos(theta) ** 2))
    assert up == down == pytest.approx(by_hand, rel=1e-12)
    flat = loading.cross_section(1.0, middle_roll_length=1.0, trough_angle=0.0, surcharge_angle=theta)
    assert flat.on_slope(0.2, surcharge_angle=theta) == pytest.approx(by_hand * flat.area, rel=1e-12)


def test_usable_width_of_standard_and_wide_belts():
    assert loading.usable_width(1.2) == pytest.approx(1.03, rel=ULPS)
    # both branches meet at 2 m
    assert loading.usable_width(2.0) == pytest.approx(2.0 - 0.25, rel=ULPS)
    assert loading.usable_width(2.4) == pytest.approx(2.15, rel=ULPS)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"n_rolls": 6}, r"n_rolls = 6 is not allowed: 1 to 5 rolls are needed"),
        ({"bulk_line_mass": -1.0}, r"bulk_line_mass = -1\.0 is not allowed: a finite number of at least 0"),
        ({"belt_line_mass": math.nan}, r"belt_line_mass = nan is not allowed"),
        ({"spacing": 0.0}, r"spacing = 0\.0 is not allowed: a finite number greater than 0"),
        ({"gravity": math.inf}, r"gravity = inf is not allowed"),
        (
            {"trough_angle": 35.0},
            r"trough_angle = 35\.0 is not allowed: an angle in rad from 0 to below pi/2",
        ),
        ({"trough_angle": 1.2}, r"trough_angle = 1\.2 is not allowed: 0 to pi/3 rad"),
        ({"inclination": -1.6}, r"inclination = -1\.6 is not allowed: an angle in rad"),
        ({"roll_length": 1.2}, r"roll_length = 1\.2 is not allowed: less than belt_width/1 is needed"),
        ({"n_rolls": 5}, r"roll_length = 0\.465 is not allowed: less than belt_width/3"),
        (
            {"n_rolls": 5, "roll_length": 0.25},
            r"bulk_shares = None is not allowed: a set of 5 rolls has no rule",
        ),
        ({"bulk_shares": (0.5, 0.5)}, r"one share for each of the 3 rolls"),
        ({"bulk_shares": (0.6, 0.6, -0.2)}, r"shares from 0 to 1 are needed"),
        ({"belt_shares": (0.3, 0.3, 0.3)}, r"belt_shares = .* the sum must be 1, it is 0\.9"),
    ],
)
def test_refusals_of_roll_loads(change, message):
    with pytest.raises(InputError, match=message):
        loading.roll_loads(**SET | change)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: loading.bulk_line_mass(-1.0, belt_speed=1.0), r"mass_flow = -1\.0 is not allowed"),
        (lambda: loading.bulk_line_mass(1.0, belt_speed=0.0), r"belt_speed = 0\.0 is not allowed"),
        (lambda: loading.usable_width(math.inf), r"belt_width = inf is not allowed"),
        (lambda: loading.usable_width(0.05), r"belt_width = 0\.05 is not allowed: more than 0\.05556 m"),
        (
            lambda: loading.cross_section(1.0, middle_roll_length=1.1, trough_angle=0.5, surcharge_angle=0.2),
            r"middle_roll_length = 1\.1 is not allowed: 0 to the width 1\.0 m",
        ),
        (
            lambda: loading.cross_section(1.0, middle_roll_length=0.4, trough_angle=0.5, surcharge_angle=-0.2),
            r"surcharge_angle = -0\.2 is not allowed",
        ),
        (
            lambda: loading.middle_share_belt(1.19, belt_width=1.2),
            r"belt_width = 1\.2 is not allowed: at least 1\.21",
        ),
        (lambda: loading.roll_loads(**SET)[0].line_loads(0), r"n = 0 is not allowed: at least 1 point"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_four_rolls_bear_the_shares_they_are_given():
    shares = (0.1, 0.4, 0.4, 0.1)
    loads = loading.roll_loads(
        bulk_line_mass=100.0,
        belt_line_mass=20.0,
        spacing=1.2,
        n_rolls=4,
        trough_angle=math.radians(35.0),
        roll_length=0.3,
        belt_width=1.1,
        inclination=0.0,
        gravity=9.81,
        bulk_shares=shares,
    )
    assert [load.name for load in loads] == ["left wing", "left inner", "right inner", "right wing"]
    assert [load.shape for load in loads] == ["triangular", "uniform", "uniform", "triangular"]
    assert [load.bulk_force for load in loads] == pytest.approx([share * 100.0 * 9.81 * 1.2 for share in shares])
    assert math.fsum(load.force for load in loads) == pytest.approx(120.0 * 9.81 * 1.2)
    # the belt by the width on each roll: outer ones reach 0.25 m to its edge
    assert [load.length for load in loads] == pytest.approx([0.25, 0.3, 0.3, 0.25])


def test_four_rolls_need_their_shares():
    with pytest.raises(InputError, match="a set of 4 rolls has no rule in VDI 2341, give the 4 shares"):
        loading.roll_loads(
            bulk_line_mass=100.0,
            belt_line_mass=20.0,
            spacing=1.2,
            n_rolls=4,
            trough_angle=0.6,
            roll_length=0.3,
            belt_width=1.1,
            inclination=0.0,
            gravity=9.81,
        )
